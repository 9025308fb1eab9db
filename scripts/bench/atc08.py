#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons by mesh contraction: Au, Tai, Chu, Cohen-Or, Lee, ACM Transactions on Graphics 27(3), 2008.

Three steps: the mesh is contracted by Laplacian smoothing whose weight doubles, its connectivity kept;
edges are collapsed until no face is left; the nodes are moved back to the middle of their regions, and
nodes are merged into junctions where that centres these. The third step is from memory of the
publication, as is the first weight of the contraction: it is published with a unit of length, for a
Laplacian that has none.
"""

from __future__ import annotations

import heapq
import time
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from peer_command import Result, peer_command

FIRST_WEIGHT = 1.0  # of the contraction: the first iterations move the vertices visibly
GROWTH = 2.0
LARGEST_CONTRACTION, LARGEST_ATTRACTION = 2048.0, 1e4
VOLUME_LEFT = 1e-6
MOST_ITERATIONS = 30
LARGEST_COTANGENT = 1e4
SHAPE_COST, SAMPLING_COST = 1.0, 0.1
MERGING = 0.9  # a junction is merged with a neighbour if that lowers its spread to less than this part


@dataclass
class Contraction:
    """points: (V, 3); volumes: left after each iteration, of the input's."""

    points: np.ndarray
    volumes: list[float]


@dataclass
class Skeleton:
    """points: (N, 3); edges: (M, 2); node: of each vertex of the mesh."""

    points: np.ndarray
    edges: np.ndarray
    node: np.ndarray


def volume(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(abs(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6)


def double_areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1)


def ring_areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The area of the triangles at each vertex."""
    areas = np.repeat(double_areas(points, triangles) / 2, 3)
    return np.bincount(triangles.ravel(), areas, len(points))


def laplacian(points: np.ndarray, triangles: np.ndarray):
    """L_ij = cot(alpha_ij) + cot(beta_ij), L_ii = -sum_j L_ij; sparse."""
    twice = np.maximum(double_areas(points, triangles), 1e-300)
    rows, columns, values = [], [], []
    for k in range(3):
        i, j, apex = (triangles[:, (k + s) % 3] for s in range(3))
        u, v = points[i] - points[apex], points[j] - points[apex]
        cotangent = np.einsum("ij,ij->i", u, v) / twice
        cotangent = cotangent.clip(-LARGEST_COTANGENT, LARGEST_COTANGENT)
        rows += [i, j]
        columns += [j, i]
        values += [cotangent, cotangent]
    size = len(points)
    off = coo_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (size, size)
    ).tocsr()
    return off - diags(np.asarray(off.sum(axis=1)).ravel())


def contract(points: np.ndarray, triangles: np.ndarray) -> Contraction:
    """Solves [W_L L; W_H] V' = [0; W_H V] in the least squares sense, again and again.

    W_L doubles; W_H, of each vertex, grows with the square root of what its ring has lost in area.
    """
    original = ring_areas(points, triangles)
    whole = volume(points, triangles)
    weight, attraction = FIRST_WEIGHT, np.ones(len(points))
    result = Contraction(points, [])
    for _ in range(MOST_ITERATIONS):
        L = weight * laplacian(result.points, triangles)
        system = (L.T @ L + diags(attraction**2)).tocsc()
        factor = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                      options={"SymmetricMode": True})
        moved = factor.solve(attraction[:, None] ** 2 * result.points)
        left = volume(moved, triangles) / whole
        if not np.isfinite(moved).all():
            break
        result.points = moved
        result.volumes.append(left)
        if left < VOLUME_LEFT:
            break
        weight = min(GROWTH * weight, LARGEST_CONTRACTION)
        now = np.maximum(ring_areas(moved, triangles), 1e-300)
        attraction = np.minimum(np.sqrt(original / now), LARGEST_ATTRACTION)
    return result


class Surgery:
    """Collapses the half-edge of least cost, again and again, until no face is left.

    The cost is that of the shape, the squared distances to the lines of the edges that were there, and
    that of the sampling, which keeps edges from growing long.
    """

    def __init__(self, points: np.ndarray, triangles: np.ndarray) -> None:
        size = len(points)
        self.points = points
        self.neighbours: list[set[int]] = [set() for _ in range(size)]
        self.faces: list[set[tuple[int, int, int]]] = [set() for _ in range(size)]
        for triangle in triangles:
            a, b, c = sorted(int(v) for v in triangle)
            for v, (p, q) in ((a, (b, c)), (b, (a, c)), (c, (a, b))):
                self.neighbours[v].update((p, q))
                self.faces[v].add((a, b, c))
        self.parent = np.arange(size)
        self.quadric = np.zeros((size, 4, 4))
        self.version = [0] * size
        self.heap: list[tuple[float, int, int, int, int]] = []
        for v in range(size):
            others = points[list(self.neighbours[v])]
            edges = others - points[v]
            lengths = np.linalg.norm(edges, axis=1)
            for a in edges[lengths > 0] / lengths[lengths > 0, None]:
                K = np.zeros((3, 4))
                K[:, :3] = [[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]]
                K[:, 3] = -np.cross(a, points[v])
                self.quadric[v] += K.T @ K
        self.alive = np.ones(size, bool)
        for v in range(size):
            self.push_from(v)

    def push_from(self, i: int) -> None:
        """The half-edges from i."""
        ends = list(self.neighbours[i])
        if not ends:
            return
        reach = self.points[ends]
        spans = np.linalg.norm(reach - self.points[i], axis=1)
        sampling = spans * spans.sum()
        at = np.column_stack([reach, np.ones(len(ends))])
        Q = self.quadric[i] + self.quadric[ends]
        shape = np.einsum("na,nab,nb->n", at, Q, at)
        costs = SHAPE_COST * np.abs(shape) + SAMPLING_COST * sampling
        for j, cost in zip(ends, costs):
            heapq.heappush(self.heap, (float(cost), i, j, self.version[i], self.version[j]))

    def thirds(self, i: int, j: int) -> set[int]:
        """The third corners of the faces at an edge."""
        return {next(v for v in face if v not in (i, j)) for face in self.faces[i] if j in face}

    def keeps_cycles(self, i: int, j: int, thirds: set[int]) -> bool:
        """Whether no cycle of three edges vanishes that is a curve's but for the edge at hand."""
        return not any(not self.thirds(i, k) and not self.thirds(j, k)
                       for k in (self.neighbours[i] & self.neighbours[j]) - thirds)

    def run(self) -> None:
        waiting = []
        forced = False
        while True:
            if not self.heap:
                if not waiting or forced:
                    break
                self.heap, waiting, forced = waiting, [], True
                heapq.heapify(self.heap)
            entry = heapq.heappop(self.heap)
            _, i, j, vi, vj = entry
            if not (self.alive[i] and self.alive[j]) or self.version[i] != vi or self.version[j] != vj:
                continue
            thirds = self.thirds(i, j)
            if not thirds:
                continue
            if not forced and not self.keeps_cycles(i, j, thirds):
                waiting.append(entry)
                continue
            self.collapse(i, j)
            if forced or waiting:
                forced = False
                for held in waiting:
                    heapq.heappush(self.heap, held)
                waiting = []

    def collapse(self, i: int, j: int) -> None:
        """Vertex i becomes j, which stays in its place."""
        for face in self.faces[i]:
            others = [v for v in face if v != i]
            for v in others:
                self.faces[v].discard(face)
            if j not in others:
                new = tuple(sorted([j, *others]))
                for v in new:
                    self.faces[v].add(new)
        for v in self.neighbours[i]:
            self.neighbours[v].discard(i)
            if v != j:
                self.neighbours[v].add(j)
                self.neighbours[j].add(v)
        self.faces[i], self.neighbours[i] = set(), set()
        self.alive[i] = False
        self.parent[i] = j
        self.quadric[j] += self.quadric[i]
        self.version[j] += 1
        self.push_from(j)
        for v in self.neighbours[j]:
            span = np.linalg.norm(self.points[list(self.neighbours[v])] - self.points[v], axis=1).sum()
            at = np.append(self.points[j], 1)
            cost = (SHAPE_COST * abs(at @ (self.quadric[v] + self.quadric[j]) @ at)
                    + SAMPLING_COST * span * np.linalg.norm(self.points[v] - self.points[j]))
            heapq.heappush(self.heap, (float(cost), v, j, self.version[v], self.version[j]))

    def skeleton(self) -> Skeleton:
        root = self.parent.copy()
        while (root != root[root]).any():
            root = root[root]
        nodes = np.flatnonzero(self.alive)
        number = np.full(len(root), -1)
        number[nodes] = np.arange(len(nodes))
        edges = [(number[v], number[w]) for v in nodes for w in self.neighbours[v] if v < w]
        return Skeleton(self.points[nodes], np.array(edges, int).reshape(-1, 2), number[root])


class Embedding:
    """Moves the nodes of a skeleton back to the middle of the regions of the mesh that they stand for."""

    def __init__(self, points: np.ndarray, contracted: np.ndarray, triangles: np.ndarray,
                 skeleton: Skeleton) -> None:
        self.points, self.contracted, self.skeleton = points, contracted, skeleton
        sides = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        self.sides = np.unique(np.sort(sides, axis=1), axis=0)
        self.lengths = np.linalg.norm(points[self.sides[:, 0]] - points[self.sides[:, 1]], axis=1)
        self.of_vertex: list[list[int]] = [[] for _ in points]
        for s, (a, b) in enumerate(self.sides):
            self.of_vertex[a].append(s)
            self.of_vertex[b].append(s)

    def placed(self, region: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Where a node at `at` goes: back by the mean of its loops' displacements.

        A loop is a connected part of the region's boundary; its displacement is the mean over its
        vertices, each weighted by the length of the two edges beside it.
        """
        inside = set(region.tolist())
        sides = {s for v in region for s in self.of_vertex[v]}
        border = {v for s in sides for v in self.sides[s].tolist()
                  if v in inside and not inside.issuperset(self.sides[s].tolist())}
        if not border:
            return self.points[region].mean(axis=0)
        order = {v: n for n, v in enumerate(sorted(border))}
        along = [s for s in sides if all(v in order for v in self.sides[s].tolist())]
        weight = np.zeros(len(order))
        links = [(order[int(a)], order[int(b)]) for a, b in self.sides[along]]
        for (a, b), s in zip(links, along):
            weight[a] += self.lengths[s]
            weight[b] += self.lengths[s]
        weight = np.maximum(weight, 1e-12)
        rows, columns = np.array(links, int).reshape(-1, 2).T
        count, loop = connected_components(
            coo_matrix((np.ones(len(rows)), (rows, columns)), (len(order), len(order))), False)
        vertices = np.array(sorted(border))
        moved = self.contracted[vertices] - self.points[vertices]
        displacements = [np.average(moved[loop == n], axis=0, weights=weight[loop == n])
                         for n in range(count)]
        return at - np.mean(displacements, axis=0)

    def spread(self, place: np.ndarray, region: np.ndarray) -> float:
        """The standard deviation of the distances from a node to its region."""
        return float(np.linalg.norm(self.points[region] - place, axis=1).std())

    def run(self) -> Skeleton:
        given = self.skeleton
        regions = [np.flatnonzero(given.node == n) for n in range(len(given.points))]
        places = np.array([self.placed(r, p) for r, p in zip(regions, given.points)])
        links: list[set[int]] = [set() for _ in regions]
        for a, b in given.edges.tolist():
            links[a].add(b)
            links[b].add(a)
        target = np.arange(len(regions))
        for node in range(len(regions)):
            while target[node] == node and len(links[node]) > 2:
                best, best_spread = None, MERGING * self.spread(places[node], regions[node])
                for other in sorted(links[node]):
                    if links[node] & links[other]:
                        continue  # a cycle of three would vanish
                    both = np.concatenate([regions[node], regions[other]])
                    place = self.placed(both, (given.points[node] + given.points[other]) / 2)
                    if (found := self.spread(place, both)) < best_spread:
                        best, best_spread, best_place, best_region = other, found, place, both
                if best is None:
                    break
                target[best] = node
                places[node], regions[node] = best_place, best_region
                for v in links[best]:
                    links[v].discard(best)
                    if v != node:
                        links[v].add(node)
                        links[node].add(v)
                links[best] = set()
        while (target != target[target]).any():
            target = target[target]
        kept = np.flatnonzero(target == np.arange(len(target)))
        number = np.full(len(target), -1)
        number[kept] = np.arange(len(kept))
        edges = [(number[a], number[b]) for a in kept for b in links[a] if a < b]
        return Skeleton(places[kept], np.array(edges, int).reshape(-1, 2), number[target[given.node]])


def atc08(points: np.ndarray, triangles: np.ndarray) -> tuple[Skeleton, dict[str, float], list[float]]:
    """The skeleton, the seconds of its three steps, and the volumes of the contraction.

    points: (V, 3); triangles: (F, 3), a closed two-manifold.
    """
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    origin = points.min(axis=0)
    unit = (points - origin) / diagonal
    clock = [time.process_time()]
    contraction = contract(unit, triangles)
    clock.append(time.process_time())
    surgery = Surgery(contraction.points, triangles)
    surgery.run()
    clock.append(time.process_time())
    skeleton = Embedding(unit, contraction.points, triangles, surgery.skeleton()).run()
    clock.append(time.process_time())
    skeleton.points = skeleton.points * diagonal + origin
    names = ("contraction", "conversion", "refine")
    return skeleton, dict(zip(names, np.diff(clock).tolist())), contraction.volumes


def run(points: np.ndarray, triangles: np.ndarray) -> Result:
    skeleton, seconds, volumes = atc08(points, triangles)
    return skeleton.points, skeleton.edges, seconds, {
        "iterations": len(volumes), "volume_fraction": volumes[-1] if volumes else None}


if __name__ == "__main__":
    peer_command("atc08", __doc__, run)
