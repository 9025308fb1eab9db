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

    points: (n, 3) positions; edges: (m, 2) indices, as read, so with any duplicates and loops.
    """

    points: np.ndarray
    edges: np.ndarray
    _links: list[list[int]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self.points = np.asarray(self.points, float).reshape(-1, 3)
        self.edges = np.asarray(self.edges, int).reshape(-1, 2)
        self._links = [[] for _ in range(len(self.points))]
        for a, b in self.simple_edges:
            self._links[a].append(int(b))
            self._links[b].append(int(a))

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
        return Curve((self.points - origin) / unit, self.edges)


def mean_distance(one: Curve, other: Curve, spacing: float) -> float:
    """Mean distance between two curves by length, the larger of the two directions."""

    def directed(of: Curve, to: Curve) -> float:
        points, lengths = of.sampled(spacing)
        distances = cKDTree(np.vstack([to.sampled(spacing)[0], to.points])).query(points)[0]
        return float((distances * lengths).sum() / lengths.sum())

    return max(directed(one, other), directed(other, one))


def read_curve(path: Path) -> Curve:
    """Reads OBJ ("l" lines of any length), .cg (lines "v" and "e") or PLY (element edge)."""
    if path.suffix.lower() == ".ply":
        return _read_ply(path)
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


def _read_ply(path: Path) -> Curve:
    from plyfile import PlyData

    data = PlyData.read(str(path))
    vertex = data["vertex"]
    points = np.column_stack([vertex[axis] for axis in "xyz"])
    if "edge" not in data:
        return Curve(points, np.zeros((0, 2)))
    edge = data["edge"]
    return Curve(points, np.column_stack([edge["vertex1"], edge["vertex2"]]))
