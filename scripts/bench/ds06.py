#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons by the medial geodesic function: Dey, Sun, Symposium on Geometry Processing 2006.

The medial axis is approximated by the inner facets of the Voronoi diagram of the mesh's vertices. On each
facet the function is the geodesic distance, on the surface, between the two vertices that it separates.
The curve skeleton is where its gradient is singular: facets are eroded from their free edges inward, those
of low values first, so that the topology is kept, and what is left is cut back to where the function has a
ridge, or where the medial axis is a curve itself.

From memory of the publication. What is this version's own: all inner facets are eroded, not those alone that
pass the test of Dey and Zhao, which keeps the topology of the solid; a ridge is measured on the facets around
and not edge by edge, where the noise of the sampling hides it; geodesic distances are Dijkstra's, along edges
and across pairs of triangles that are unfolded.
"""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable
from dataclasses import dataclass

import igl
import numpy as np
import trimesh
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Delaunay, cKDTree

from peer_command import Result, peer_command

ANGLE, RATIO = np.pi / 8, 8.0  # of Dey and Zhao: a facet is medial if it passes either test
TINY = 1e-300
JOGGLE = 1e-7  # of the diagonal: no five vertices lie on a sphere then
REACH = 3.0  # of a first search, beyond the straight distance
SOURCES = 64  # of a search at once
RIDGE = 1.0  # slope of the function on both sides of an edge that is kept; it is 2 at most
AROUND = 5.0  # lengths of edges: how far the facets are that tell of a ridge
SAME_SHEET = 0.8  # cosine between directions across facets of one sheet
NO_SHEET = 0.3  # part of a disc that facets cover, below which the medial axis is a curve


@dataclass
class Complex:
    """The inner Voronoi diagram.

    points: (V, 3); edges: (E, 2), of points; facets: the edges of each; sides: (F, 2), the two vertices of the
    mesh that each facet lies between.
    """

    points: np.ndarray
    edges: np.ndarray
    facets: list[np.ndarray]
    sides: np.ndarray

    @property
    def euler_characteristic(self) -> int:
        return len(self.points) - len(self.edges) + len(self.facets)


def circumcentres(points: np.ndarray, tetrahedra: np.ndarray) -> np.ndarray:
    origin = points[tetrahedra[:, 0]]
    rows = points[tetrahedra[:, 1:]] - origin[:, None]
    return origin + np.linalg.solve(2 * rows, (rows**2).sum(axis=2)[:, :, None])[:, :, 0]


def inner_voronoi(points: np.ndarray, triangles: np.ndarray) -> Complex:
    """Points inside the surface, and the edges and facets all of whose points are."""
    size = len(points)
    joggled = points + np.random.default_rng(0).uniform(-JOGGLE, JOGGLE, points.shape)
    diagram = Delaunay(joggled)
    tetrahedra = np.sort(diagram.simplices, axis=1).astype(np.int64)
    centres = circumcentres(joggled, tetrahedra)
    inside = igl.fast_winding_number(points, triangles, np.ascontiguousarray(centres)) > 0.5
    number = np.cumsum(inside) - 1

    corners = np.vstack([tetrahedra[:, [j for j in range(4) if j != k]] for k in range(4)])
    of = np.tile(np.arange(len(tetrahedra)), 4)
    key = (corners[:, 0] * size + corners[:, 1]) * size + corners[:, 2]
    order = np.argsort(key, kind="stable")
    key, of, corners = key[order], of[order], corners[order]
    first = np.flatnonzero((key[:-1] == key[1:]) & inside[of[:-1]] & inside[of[1:]])
    edges = np.column_stack([number[of[first]], number[of[first + 1]]])
    dual = corners[first]  # the triangles that the edges are dual to

    # A facet is bounded and inside if each tetrahedron at its dual edge is.
    pairs = np.array([(a, b) for a in range(4) for b in range(a + 1, 4)])
    around = (tetrahedra[:, pairs[:, 0]] * size + tetrahedra[:, pairs[:, 1]]).ravel()
    outer = np.unique(around[np.repeat(~inside, 6)])
    hull = np.sort(diagram.convex_hull.astype(np.int64), axis=1)
    outer = np.union1d(outer, np.concatenate([hull[:, a] * size + hull[:, b] for a, b in ((0, 1), (0, 2), (1, 2))]))
    side = np.concatenate([dual[:, a] * size + dual[:, b] for a, b in ((0, 1), (0, 2), (1, 2))])
    edge = np.tile(np.arange(len(dual)), 3)
    kept = ~np.isin(side, outer)
    order = np.argsort(side[kept], kind="stable")
    side, edge = side[kept][order], edge[kept][order]
    values, starts = np.unique(side, return_index=True)
    return Complex(centres[inside], edges, np.split(edge, starts[1:]) if len(values) else [],
                   np.column_stack([values // size, values % size]))


def medial_facets(points: np.ndarray, triangles: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Whether each facet is one of the medial axis: steep on the surface, or long beside its triangles."""
    mesh = trimesh.Trimesh(points, triangles, process=False)
    across = points[sides[:, 1]] - points[sides[:, 0]]
    length = np.maximum(np.linalg.norm(across, axis=1), TINY)
    size = np.zeros(len(points))
    np.maximum.at(size, mesh.edges.ravel(), np.repeat(np.linalg.norm(
        points[mesh.edges[:, 1]] - points[mesh.edges[:, 0]], axis=1), 2))
    steep = np.ones(len(sides), bool)
    for k in range(2):
        rise = np.abs(np.einsum("ij,ij->i", mesh.vertex_normals[sides[:, k]], across)) / length
        steep &= rise > np.sin(ANGLE)
    return steep | (length > RATIO * np.maximum(size[sides[:, 0]], size[sides[:, 1]]))


def surface_graph(points: np.ndarray, triangles: np.ndarray) -> csr_matrix:
    """Straight ways on the surface: the edges, and across pairs of triangles where the way is within them."""
    mesh = trimesh.Trimesh(points, triangles, process=False)
    edges = mesh.edges_unique
    lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    shared = mesh.face_adjacency_edges
    apexes = mesh.face_adjacency_unshared
    a, b = points[shared[:, 0]], points[shared[:, 1]]
    axis = b - a
    span = np.maximum(np.linalg.norm(axis, axis=1), TINY)
    axis = axis / span[:, None]
    along, away = [], []
    for k in range(2):
        arm = points[apexes[:, k]] - a
        along.append((arm * axis).sum(axis=1))
        away.append(np.linalg.norm(arm - along[-1][:, None] * axis, axis=1))
    crossing = (along[0] * away[1] + along[1] * away[0]) / np.maximum(away[0] + away[1], TINY)
    within = (crossing > 0) & (crossing < span) & (apexes[:, 0] != apexes[:, 1])
    ways = np.vstack([edges, apexes[within]])
    lengths = np.concatenate([lengths, np.hypot(along[0] - along[1], away[0] + away[1])[within]])
    low, high = ways.min(axis=1), ways.max(axis=1)
    _, first = np.unique(low * len(points) + high, return_index=True)
    graph = coo_matrix((lengths[first], (low[first], high[first])), (len(points),) * 2)
    return (graph + graph.T).tocsr()


def geodesic_distances(points: np.ndarray, triangles: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """On the surface, between the two vertices of each row; infinite between components."""
    graph = surface_graph(points, triangles)
    straight = np.linalg.norm(points[sides[:, 1]] - points[sides[:, 0]], axis=1)
    result = np.full(len(sides), np.inf)
    # A search from the vertex at which more rows meet serves all of them.
    meet = np.bincount(sides.ravel(), minlength=len(points))
    swap = meet[sides[:, 1]] > meet[sides[:, 0]]
    source, target = np.where(swap, sides[:, 1], sides[:, 0]), np.where(swap, sides[:, 0], sides[:, 1])
    waiting = np.arange(len(sides))
    for reach in (REACH, 3 * REACH, np.inf):
        if not len(waiting):
            break
        far = np.zeros(len(points))
        np.maximum.at(far, source[waiting], straight[waiting])
        sources = np.unique(source[waiting])
        sources = sources[np.argsort(far[sources], kind="stable")]  # alike ones together: one limit for all
        row_of = np.full(len(points), -1)
        rows = waiting[np.argsort(source[waiting], kind="stable")]
        starts = np.searchsorted(source[rows], np.arange(len(points) + 1))
        for lot in np.array_split(sources, -(-len(sources) // SOURCES)):
            limit = reach * far[lot].max()
            found = dijkstra(graph, directed=False, indices=lot, limit=limit)
            row_of[lot] = np.arange(len(lot))
            mine = np.concatenate([rows[starts[s]:starts[s + 1]] for s in lot])
            result[mine] = found[row_of[source[mine]], target[mine]]
        waiting = waiting[~np.isfinite(result[waiting])]
    return result


def erode(diagram: Complex, function: np.ndarray) -> tuple[np.ndarray, int]:
    """Which edges are left when facets have gone with a free edge of theirs each, the lowest first.

    Returns also how many facets have no free edge at the end: none of a solid without cavities.
    """
    facets_of: list[list[int]] = [[] for _ in diagram.edges]
    for facet, edges in enumerate(diagram.facets):
        for edge in edges.tolist():
            facets_of[edge].append(facet)
    left = [len(facets) for facets in facets_of]
    alive = np.ones(len(diagram.edges), bool)
    present = [True] * len(diagram.facets)

    def facet_of(edge: int) -> int:
        return next(f for f in facets_of[edge] if present[f])

    heap = [(function[facet_of(e)], facet_of(e), e) for e, count in enumerate(left) if count == 1]
    heapq.heapify(heap)
    while heap:
        _, facet, edge = heapq.heappop(heap)
        if not present[facet] or left[edge] != 1 or not alive[edge]:
            continue
        present[facet], alive[edge] = False, False
        for other in diagram.facets[facet].tolist():
            left[other] -= 1
            if left[other] == 1 and alive[other]:
                last = facet_of(other)
                heapq.heappush(heap, (function[last], last, other))
    return alive, sum(present)


def singular_edges(diagram: Complex, alive: np.ndarray, function: np.ndarray, medial: np.ndarray,
                   across: np.ndarray, spacing: float) -> np.ndarray:
    """Which of the edges left are of a ridge of the function, or where the medial axis is no sheet.

    across: of each facet, the direction between the vertices beside it.
    """
    corner = np.array([diagram.points[np.unique(diagram.edges[f])].mean(axis=0) for f in diagram.facets])
    area = np.empty(len(diagram.facets))
    for k, facet in enumerate(diagram.facets):
        a, b = diagram.points[diagram.edges[facet, 0]], diagram.points[diagram.edges[facet, 1]]
        area[k] = np.linalg.norm(np.cross(a - corner[k], b - corner[k]), axis=1).sum() / 2
    use = np.flatnonzero(medial & np.isfinite(function))
    mine: list[list[int]] = [[] for _ in diagram.edges]
    for k in use.tolist():
        for edge in diagram.facets[k].tolist():
            mine[edge].append(k)
    result = np.zeros(len(diagram.edges), bool)
    candidates = [edge for edge in np.flatnonzero(alive).tolist() if mine[edge]]
    if not candidates:
        return result
    middle = diagram.points[diagram.edges[candidates]].mean(axis=1)
    radius = AROUND * spacing
    near = cKDTree(corner[use]).query_ball_point(middle, radius)
    for edge, facets in zip(candidates, near):
        # The function has steps where sheets meet: only the sheet on which it is highest counts.
        own = np.array(mine[edge])
        facing = across[own[np.argmax(function[own])]]
        own = own[np.abs(across[own] @ facing) > SAME_SHEET]
        found = use[facets]
        if area[found].sum() < NO_SHEET * np.pi * radius**2:
            result[edge] = True
            continue
        found = np.union1d(found[np.abs(across[found] @ facing) > SAME_SHEET], own)
        rise = np.average(function[own], weights=area[own] + TINY) - np.average(function[found], weights=area[found] + TINY)
        # The mean distance of the points of a disc from its diameter is 4 / (3 pi) of its radius.
        result[edge] = rise > RIDGE * 4 / (3 * np.pi) * radius
    return result


def cut_back(diagram: Complex, alive: np.ndarray, kept: np.ndarray, least: float) -> np.ndarray:
    """Takes off the edges at tips, again and again, up to such as are kept; and branches that are too short."""
    links: dict[int, set[int]] = {}
    for edge in np.flatnonzero(alive).tolist():
        for end in diagram.edges[edge].tolist():
            links.setdefault(end, set()).add(edge)
    ends = diagram.edges.tolist()
    lengths = np.linalg.norm(np.diff(diagram.points[diagram.edges], axis=1)[:, 0], axis=1).tolist()
    alive = alive.copy()
    taken: set[int] = set()  # nodes whose last edge has been taken off

    def peel(reach: float, may: Callable[[int], bool]) -> dict[int, tuple[float, int, int]]:
        """Takes off what is shorter; for each node the deepest way off it: how deep, the edge, and the next node."""
        deepest: dict[int, tuple[float, int, int]] = {}
        heap = [(0.0, node) for node, at in links.items() if len(at) == 1]
        heapq.heapify(heap)
        while heap:
            _, node = heapq.heappop(heap)
            if len(links[node]) != 1:
                continue
            edge = next(iter(links[node]))
            depth = deepest.get(node, (0.0, -1, -1))[0] + lengths[edge]
            if depth > reach or not may(edge):
                continue
            alive[edge] = False
            taken.add(node)
            a, b = ends[edge]
            other = b if a == node else a
            links[node].discard(edge)
            links[other].discard(edge)
            if depth > deepest.get(other, (0.0, -1, -1))[0]:
                deepest[other] = (depth, edge, node)
            if len(links[other]) == 1:
                heapq.heappush(heap, (deepest[other][0], other))
        return deepest

    peel(np.inf, lambda edge: not kept[edge])
    first = {node for node, at in links.items() if at}
    taken.clear()
    deepest = peel(least, lambda edge: True)
    # What is left has lost the ends of its own branches as well; of a small component, all but a node.
    for node in sorted(first - taken):
        if len(links[node]) <= 1:
            while node in deepest:
                _, edge, node = deepest[node]
                alive[edge] = True
    return alive


def ds06(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Nodes and edges of the skeleton, and the seconds of its steps.

    points: (V, 3); triangles: (F, 3), a closed two-manifold with even triangles.
    """
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    origin = points.min(axis=0)
    unit = np.ascontiguousarray((points - origin) / diagonal)
    triangles = np.ascontiguousarray(triangles, np.int64)
    clock = [time.process_time()]
    diagram = inner_voronoi(unit, triangles)
    medial = medial_facets(unit, triangles, diagram.sides)
    clock.append(time.process_time())
    across = unit[diagram.sides[:, 1]] - unit[diagram.sides[:, 0]]
    length = np.linalg.norm(across, axis=1)
    function = length.copy()
    function[medial] = geodesic_distances(unit, triangles, diagram.sides[medial])
    clock.append(time.process_time())
    alive, _ = erode(diagram, function)
    spacing = float(np.linalg.norm(unit[triangles] - unit[np.roll(triangles, 1, axis=1)], axis=2).mean())
    kept = singular_edges(diagram, alive, function, medial, across / length[:, None], spacing)
    alive = cut_back(diagram, alive, kept, AROUND * spacing)
    used, edges = np.unique(diagram.edges[alive], return_inverse=True)
    clock.append(time.process_time())
    names = ("poles", "geodesic", "erosion")
    return (diagram.points[used] * diagonal + origin, edges.reshape(-1, 2),
            dict(zip(names, np.diff(clock).tolist())))


def run(points: np.ndarray, triangles: np.ndarray) -> Result:
    nodes, edges, seconds = ds06(points, triangles)
    return nodes, edges, seconds, {"nodes": len(nodes)}


if __name__ == "__main__":
    peer_command("ds06", __doc__, run)
