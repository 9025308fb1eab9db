# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Is a result right? By means of its own: nothing here asks the plugin.

Inside is told by the generalized winding number (libigl), component by component: each is a solid of its
own. What is outside by no more than the rounding of the input to single precision, or than the half of a
millionth of the diagonal to which docs/reliability.md promises it, counts as inside.
"""

from __future__ import annotations

import re
from typing import Any

import igl
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from hostile import Hostile
from hostile.primitives import component_of_vertices, edges as edges_of

# A skeleton may be this many times as long as the features that it stands for.
MAX_LENGTH = 4.0
# Nodes: the curve is sampled at 0.2 % of a component's diagonal or more.
MAX_NODES_PER_DIAGONAL = 2000
MAX_SAMPLES = 3000
SINGLE_EPSILON = 2.0 ** -23

# What no error for users has in it: names of C++, of its types and exceptions, empty numbers.
FOREIGN = re.compile(
    r"std::|basic_string|vector::|_M_|bad_alloc|terminate|[Uu]nknown exception|N\d+vcg|what\(\)|"
    r"assert|0x[0-9a-f]{6,}|\.h:\d+|\.cpp:\d+|typeid|length_error|out_of_range|Eigen::")
MEMORY = re.compile(r"memory|bad_alloc|too large to (?:hold|fit)", re.IGNORECASE)

Finding = tuple[str, str]  # kind, what exactly


def message_findings(text: str) -> list[Finding]:
    """What is wrong with the text of an error: nothing, if it is one clear sentence or a few."""
    if not text.strip():
        return [("bad message", "empty")]
    if FOREIGN.search(text):
        return [("bad message", f"not for users: {text}")]
    if not re.match(r"""['"\d(A-Z]""", text) or not text.rstrip().endswith((".", ")", "'")):
        return [("bad message", f"not a sentence: {text}")]
    if not 15 < len(text) < 1000:
        return [("bad message", f"{len(text)} characters: {text[:200]}")]
    return []


class Judge:
    """Judges what comes of one mesh."""

    def __init__(self, mesh: Hostile) -> None:
        self.expected = mesh.expected
        given = np.asarray(mesh.vertices, float)
        vertices, faces = mesh.solid if mesh.solid is not None else (given, mesh.faces)
        self.finite = (len(faces) > 0 and 0 <= np.min(faces) and np.max(faces) < len(vertices)
                       and bool(np.isfinite(vertices[np.unique(faces)]).all()))
        if not self.finite:
            return
        used = vertices[np.unique(faces)]
        low, high = used.min(axis=0), used.max(axis=0)
        self.centre = low / 2 + high / 2
        self.unit = float(np.max(high / 2 - low / 2)) or 1.0
        self.vertices = (vertices - self.centre) / self.unit
        self.faces = np.asarray(faces)
        used = (used - self.centre) / self.unit
        self.low, self.high = used.min(axis=0), used.max(axis=0)
        # How far the input may be moved by being rounded; see docs/filters.md.
        reach = float(abs(np.concatenate([low, high])).max()) / self.unit
        all_finite = given[np.isfinite(given).all(axis=1)]
        with np.errstate(all="ignore"):
            box = float(np.linalg.norm(np.ptp(all_finite, axis=0))) / self.unit
            outermost = float(abs(all_finite).max()) / self.unit
        single = outermost * SINGLE_EPSILON <= 1e-6 * box
        promised = 5e-7 * float(np.linalg.norm(self.high - self.low))
        self.tolerance = max(
            2 * reach * (SINGLE_EPSILON if single else 2.0 ** -52), promised) + 1e-12
        count, self.component = component_of_vertices(len(self.vertices), self.faces)
        self.solids = []
        self.diagonals = 0.0  # of the components, together
        self.relative_area = 0.0  # of the components, together, each in squares of its diagonal
        for number in np.unique(self.component[self.faces[:, 0]]):
            own = self.faces[self.component[self.faces[:, 0]] == number]
            corner = [self.vertices[own[:, k]] - self.vertices[own[0, 0]] for k in range(3)]
            if np.einsum("ij,ij->", corner[0], np.cross(corner[1], corner[2])) < 0:
                own = own[:, ::-1]
            points, numbers = np.unique(own, return_inverse=True)
            own_diagonal = float(np.linalg.norm(np.ptp(self.vertices[points], axis=0)))
            self.diagonals += own_diagonal
            if own_diagonal > 0:
                edges = [(corner[k] - corner[0]) / own_diagonal for k in (1, 2)]
                self.relative_area += float(np.linalg.norm(np.cross(*edges), axis=1).sum()) / 2
            self.solids.append((number, self.vertices[points], numbers.reshape(-1, 3)))
        # Whose vertices the attribute mcfskel_node of the input can be asked for.
        self.corresponds = mesh.solid is None

    def skeleton(self, nodes: np.ndarray, edges: np.ndarray, faces: np.ndarray | None = None,
                 node_of_vertex: np.ndarray | None = None, inside: bool = True,
                 topology: bool = True) -> list[Finding]:
        """Findings on a skeleton: a curve, or one with sheets."""
        if not self.finite:
            return [("accepted", "a mesh without faces, or not of finite points")]
        if len(nodes) == 0:
            return [("topology", "no nodes")]
        if not np.isfinite(nodes).all():
            return [("not finite", f"{(~np.isfinite(nodes)).any(axis=1).sum()} of {len(nodes)} nodes")]
        faces = np.zeros((0, 3), int) if faces is None else faces
        for array in (edges, faces):
            if len(array) and (array.min() < 0 or array.max() >= len(nodes)):
                return [("topology", "an edge or face refers to no node")]
        found: list[Finding] = []
        with np.errstate(over="ignore"):
            points = (nodes - self.centre) / self.unit
            beyond = np.maximum(self.low - points, points - self.high).max()
            length = float(np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).sum())
        if beyond > self.tolerance:
            found.append(("explosion", f"{beyond:.3g} of the size beyond the bounding box"))
        extent = self.expected.extent / self.unit
        if not length <= MAX_LENGTH * extent:
            found.append(("explosion", f"length {length:.4g}, the features' is {extent:.4g}"))
        # The features' lengths are known together only: each component's share is as its diagonal. A plate's
        # curve may be longer than the plate, see MAX_LENGTH.
        longest = max(extent, min(length, MAX_LENGTH * extent))
        bound = MAX_NODES_PER_DIAGONAL * self.expected.components * (1 + longest / (self.diagonals or 1))
        if len(nodes) > bound:
            found.append(("explosion", f"{len(nodes)} nodes"))
        all_edges = np.vstack([edges, edges_of(faces)]) if len(faces) else edges
        count, part = graph_components(len(nodes), all_edges)
        if topology:
            unique = len(np.unique(np.sort(all_edges, axis=1), axis=0)) if len(all_edges) else 0
            if not len(faces) and unique != len(edges):
                found.append(("topology", f"{len(edges) - unique} edges twice"))
            cycles = count - (len(nodes) - unique + len(faces))
            if (count, cycles) != (self.expected.components, self.expected.genus):
                found.append(("topology", f"components, cycles {count}, {cycles}; "
                              f"right {self.expected.components}, {self.expected.genus}"))
        if inside and self.expected.embedded and not found:
            found += self._outside(points, all_edges, faces, part, count, node_of_vertex)
        return found

    def _outside(self, points: np.ndarray, edges: np.ndarray, faces: np.ndarray, part: np.ndarray,
                 count: int, node_of_vertex: np.ndarray | None) -> list[Finding]:
        samples, owner = [points], [part]
        per_edge = int(np.clip(MAX_SAMPLES // max(len(edges), 1), 1, 8))
        for t in (np.arange(per_edge) + 0.5) / per_edge if len(edges) else []:
            samples.append((1 - t) * points[edges[:, 0]] + t * points[edges[:, 1]])
            owner.append(part[edges[:, 0]])
        if len(faces):
            samples.append(points[faces].mean(axis=1))
            owner.append(part[faces[:, 0]])
        at, of = np.vstack(samples), np.concatenate(owner)
        if len(at) > 3 * MAX_SAMPLES:
            chosen = np.linspace(0, len(at) - 1, 3 * MAX_SAMPLES).astype(int)
            at, of = at[chosen], of[chosen]
        # Which solid each part of the skeleton belongs to, where the input says so.
        solid_of: dict[int, int] = {}
        if (node_of_vertex is not None and self.corresponds and len(self.solids) > 1
                and len(node_of_vertex) == len(self.vertices)):
            known = (node_of_vertex >= 0) & (node_of_vertex < len(points))
            for part_number, solid in np.unique(np.column_stack(
                    [part[node_of_vertex[known].astype(int)], self.component[known]]), axis=0):
                if part_number in solid_of:
                    return [("topology", "a part of the skeleton belongs to several components")]
                solid_of[int(part_number)] = int(solid)
        deepest = np.full(len(at), np.inf)
        wanted = np.array([solid_of.get(int(k), -1) for k in range(count)])[of]
        for number, vertices, triangles in self.solids:
            mine = np.flatnonzero((wanted == number) | ((wanted < 0) & (deepest > 0)))
            if len(mine) == 0:
                continue
            winding = np.asarray(igl.winding_number(vertices, triangles, at[mine])).ravel()
            deepest[mine[winding > 0.5]] = 0
            out = mine[~(winding > 0.5)]
            if len(out):
                squared = igl.point_mesh_squared_distance(at[out], vertices, triangles)[0]
                deepest[out] = np.minimum(deepest[out], np.sqrt(np.asarray(squared).ravel()))
        outside = deepest > self.tolerance
        if not outside.any():
            return []
        nodes_out = int(outside[: len(points)].sum()) if len(at) >= len(points) else 0
        return [("outside", f"{int(outside.sum())} of {len(at)} points, {nodes_out} of them nodes, up to "
                 f"{deepest.max() / np.linalg.norm(self.high - self.low):.3g} diagonals")]

    def points(self, points: np.ndarray, what: str, margin: float = 0.0) -> list[Finding]:
        """Findings on points that have to be finite and within the bounding box and a margin."""
        if not np.isfinite(points).all():
            return [("not finite", what)]
        if len(points) == 0:
            return []
        at = (points - self.centre) / self.unit
        beyond = float(np.maximum(self.low - at, at - self.high).max())
        size = float(np.linalg.norm(self.high - self.low))
        if beyond > self.tolerance + margin * size:
            return [("explosion", f"{what} {beyond / size:.3g} diagonals beyond the bounding box")]
        return []


def graph_components(count: int, edges: np.ndarray) -> tuple[int, np.ndarray]:
    """The connected components of a graph, and for each node its own."""
    graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)


def numbers_findings(results: dict[str, Any]) -> list[Finding]:
    """Every number that a filter returns is finite."""
    bad = [name for name, value in (results or {}).items()
           if not np.isfinite(np.asarray(value, float)).all()]
    return [("not finite", "results " + ", ".join(bad))] if bad else []
