# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve skeletons as graphs in space: files, branches, even sampling, distances."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


@dataclass
class Curve:
    """A graph embedded in space.

    points: (n, 3) positions; edges: (m, 2) indices, as read, so with any duplicates and loops; radii: (n,) of
    the nodes' balls, if known.
    """

    points: np.ndarray
    edges: np.ndarray
    radii: np.ndarray | None = None
    _links: list[list[int]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self.points = np.asarray(self.points, float).reshape(-1, 3)
        self.edges = np.asarray(self.edges, int).reshape(-1, 2)
        self._links = [[] for _ in range(len(self.points))]
        for a, b in self.simple_edges:
            self._links[a].append(int(b))
            self._links[b].append(int(a))

    def neighbours(self, node: int) -> list[int]:
        return self._links[node]

    @cached_property
    def simple_edges(self) -> np.ndarray:
        """The edges without self loops, each once, the lower index first."""
        proper = self.edges[self.edges[:, 0] != self.edges[:, 1]]
        if not len(proper):
            return proper
        return np.unique(np.sort(proper, axis=1), axis=0)

    @cached_property
    def degree(self) -> np.ndarray:
        return np.array([len(links) for links in self._links], int)

    @cached_property
    def components(self) -> int:
        if not len(self.points):
            return 0
        a, b = self.simple_edges.T
        size = len(self.points)
        links = coo_matrix((np.ones(len(a)), (a, b)), shape=(size, size))
        return int(connected_components(links, directed=False)[0])

    @property
    def cycles(self) -> int:
        """Independent cycles: E - V + components."""
        return len(self.simple_edges) - len(self.points) + self.components

    @property
    def duplicate_edges(self) -> int:
        proper = int((self.edges[:, 0] != self.edges[:, 1]).sum())
        return proper - len(self.simple_edges)

    def zero_edges(self, tolerance: float) -> int:
        """Self loops, and edges no longer than the tolerance."""
        loops = int((self.edges[:, 0] == self.edges[:, 1]).sum())
        return loops + int((self.edge_lengths <= tolerance).sum())

    @cached_property
    def edge_lengths(self) -> np.ndarray:
        a, b = self.simple_edges.T
        return np.linalg.norm(self.points[b] - self.points[a], axis=1)

    @cached_property
    def branches(self) -> list[list[int]]:
        """Chains of nodes from one end or junction to the next; a lone cycle closes on itself."""
        done: set[tuple[int, int]] = set()

        def follow(start: int, onward: int) -> list[int]:
            chain = [start, onward]
            done.update([(start, onward), (onward, start)])
            while self.degree[chain[-1]] == 2 and chain[-1] != start:
                here, before = chain[-1], chain[-2]
                there = next((n for n in self._links[here] if n != before), before)
                if (here, there) in done:
                    break
                done.update([(here, there), (there, here)])
                chain.append(there)
            return chain

        chains = [
            follow(node, onward)
            for node in np.flatnonzero(self.degree != 2).tolist()
            for onward in self._links[node]
            if (node, onward) not in done
        ]
        chains += [
            follow(int(a), int(b)) for a, b in self.simple_edges if (int(a), int(b)) not in done
        ]
        return chains

    def sampled(self, spacing: float) -> tuple[np.ndarray, np.ndarray]:
        """Mid-points of pieces no longer than the spacing, and the length each stands for."""
        pieces = np.maximum(1, np.ceil(self.edge_lengths / spacing)).astype(int)
        edge = np.repeat(np.arange(len(pieces)), pieces)
        first = np.cumsum(pieces) - pieces
        along = (np.arange(len(edge)) - first[edge] + 0.5) / pieces[edge]
        a, b = self.points[self.simple_edges[edge, 0]], self.points[self.simple_edges[edge, 1]]
        return a + along[:, None] * (b - a), self.edge_lengths[edge] / pieces[edge]

    def turning_angles(self, spacing: float) -> np.ndarray:
        """Degrees turned at each inner point of the branches, resampled evenly to the spacing."""
        angles = []
        for branch in self.branches:
            corners = self.points[branch]
            arc = np.r_[0.0, np.linalg.norm(np.diff(corners, axis=0), axis=1).cumsum()]
            steps = round(arc[-1] / spacing)
            if steps < 2:
                continue
            stops = np.linspace(0.0, arc[-1], steps + 1)
            even = np.column_stack([np.interp(stops, arc, corners[:, k]) for k in range(3)])
            step = np.diff(even, axis=0)
            step /= np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-300)
            cosine = (step[1:] * step[:-1]).sum(axis=1).clip(-1.0, 1.0)
            angles.append(np.degrees(np.arccos(cosine)))
        return np.concatenate(angles) if angles else np.zeros(0)

    def transformed(self, origin: np.ndarray, unit: float) -> Curve:
        radii = None if self.radii is None else self.radii / unit
        return Curve((self.points - origin) / unit, self.edges, radii)

    def joined(self, part: float = 1e-7) -> Curve:
        """With the ends of lines made one where they are in one place, to that part of the diagonal, also with a node
        between two ends: some programs write lines one by one."""
        if not len(self.points):
            return self
        size = float(np.linalg.norm(np.ptp(self.points, axis=0))) or 1.0
        places = np.round((self.points - self.points.min(axis=0)) / (part * size))
        place = np.unique(places, axis=0, return_inverse=True)[1].ravel()
        has_end = np.zeros(place.max() + 1, bool)
        has_end[place[self.degree < 2]] = True
        alone = np.where(has_end[place], place, place.max() + 1 + np.arange(len(place)))
        _, first, node = np.unique(alone, return_index=True, return_inverse=True)
        radii = None if self.radii is None else self.radii[first]
        return Curve(self.points[first], node.ravel()[self.edges], radii)


def mean_distance(one: Curve, other: Curve, spacing: float) -> float:
    """Mean distance between two curves by length, the larger of the two directions."""

    def directed(of: Curve, to: Curve) -> float:
        points, lengths = of.sampled(spacing)
        distances = cKDTree(np.vstack([to.sampled(spacing)[0], to.points])).query(points)[0]
        return float((distances * lengths).sum() / lengths.sum())

    return max(directed(one, other), directed(other, one))


def read_curve(path: Path) -> Curve:
    """Reads OBJ ("l" lines of any length), .cg (lines "v" and "e"), PLY (element edge), SWC or .vtp (lines)."""
    read = {".ply": _read_ply, ".swc": _read_swc, ".vtp": _read_vtp}.get(path.suffix.lower(), _read_lines)
    return read(path)


def _read_lines(path: Path) -> Curve:
    points: list[list[float]] = []
    edges: list[tuple[int, int]] = []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append([float(x) for x in rest[:3]])
        elif word in ("l", "e"):
            nodes = [int(x.split("/")[0]) for x in rest]
            nodes = [n - 1 if n > 0 else len(points) + n for n in nodes]
            edges += zip(nodes, nodes[1:])
    return Curve(np.array(points), np.array(edges))


def _read_swc(path: Path) -> Curve:
    """Lines `id type x y z radius parent`."""
    rows = np.loadtxt(path, comments="#", ndmin=2)
    place = {int(id_): k for k, id_ in enumerate(rows[:, 0])}
    edges = [(place[int(parent)], k) for k, parent in enumerate(rows[:, 6]) if parent >= 0]
    return Curve(rows[:, 2:5], np.array(edges), rows[:, 5])


def _read_vtp(path: Path) -> Curve:
    """The radius under any of the names that VMTK and its users give it."""
    from vtk import vtkXMLPolyDataReader
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData())
    lines = data.GetLines()
    ends = vtk_to_numpy(lines.GetOffsetsArray())
    nodes = vtk_to_numpy(lines.GetConnectivityArray())
    edges = [pair for a, b in zip(ends, ends[1:]) for pair in zip(nodes[a:b], nodes[a + 1:b])]
    names = [data.GetPointData().GetArrayName(k) for k in range(data.GetPointData().GetNumberOfArrays())]
    radii = [n for n in ("MaximumInscribedSphereRadius", "Radius", "radius") if n in names]
    return Curve(points, np.array(edges),
                 vtk_to_numpy(data.GetPointData().GetArray(radii[0])).astype(float) if radii else None)


def _read_ply(path: Path) -> Curve:
    from plyfile import PlyData

    data = PlyData.read(str(path))
    vertex = data["vertex"]
    points = np.column_stack([vertex[axis] for axis in "xyz"])
    if "edge" not in data:
        return Curve(points, np.zeros((0, 2)))
    edge = data["edge"]
    names = [p.name for p in vertex.properties]
    radii = np.asarray(vertex["mcfskel_radius"], float) if "mcfskel_radius" in names else None
    return Curve(points, np.column_stack([edge["vertex1"], edge["vertex2"]]), radii)
