# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A known skeleton, and how near to it a curve skeleton is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import igl
import numpy as np

from curve import Curve

Array = np.ndarray
SPACING = 0.001  # of the diagonal, at which curves are sampled
#: A tip is found within its radius, or this part of the diagonal if that is more.
NEAR_TIP = 0.0005
#: It is false so many radii and this part of the diagonal away from all tips.
FALSE_RADII, FALSE_TIP = 3, 0.002


class Nearest(NamedTuple):
    """For each point the distance from the truth, and the truth's radius there."""

    distance: Array
    radius: Array


@dataclass
class Truth:
    """Curves and sheets with their radii.

    nodes: (n, 4), x, y, z and radius, mesh units; edges: (m, 2), round cones between their balls; triangles:
    (k, 3), pieces of a sheet; cycles: of a right skeleton, the genus of the surface. It is either all curves or
    all sheets.
    """

    nodes: Array
    edges: Array
    triangles: Array
    cycles: int

    @property
    def points(self) -> Array:
        return self.nodes[:, :3]

    @property
    def radii(self) -> Array:
        return self.nodes[:, 3]

    @property
    def is_sheet(self) -> bool:
        return len(self.triangles) > 0

    @cached_property
    def size(self) -> float:
        """The diagonal of the bounding box of all balls."""
        r = self.radii[:, None]
        return float(np.linalg.norm((self.points + r).max(axis=0) - (self.points - r).min(axis=0)))

    @cached_property
    def curve(self) -> Curve:
        return Curve(self.points, self.edges)

    @cached_property
    def cone_radii(self) -> Array:
        """(m, 2), the radii at both ends of each edge. A branch that is much thinner than the ball it starts in
        does not widen to it, see meshgen/trees.py."""
        a, b = self.radii[self.edges].T
        return np.column_stack([np.minimum(a, b / 0.7), b])

    @cached_property
    def tips(self) -> Array:
        """Nodes where a branch ends that is longer than the radius where it begins."""
        return np.array([t for t in np.flatnonzero(self.curve.degree == 1) if self._is_asked_for(int(t))], int)

    def _is_asked_for(self, tip: int) -> bool:
        length, before, at = 0.0, -1, tip
        while self.curve.degree[at] <= 2:
            onward = [w for w in self.curve.neighbours(at) if w != before]
            if not onward:
                break
            length += float(np.linalg.norm(self.points[onward[0]] - self.points[at]))
            before, at = at, onward[0]
        return length > self.radii[at]

    def nearest(self, points: Array) -> Nearest:
        if self.is_sheet:
            squared = igl.point_mesh_squared_distance(points, self.points, self.triangles)[0]
            return Nearest(np.sqrt(squared), np.full(len(points), self.radii[0]))
        distance, edge, along = nearest_on_edges(points, self.points, self.edges)
        radii = self.cone_radii[edge]
        return Nearest(distance, radii[:, 0] * (1 - along) + radii[:, 1] * along)

    def is_inside(self, points: Array, near: Nearest) -> Array:
        """Whether each point, of which `near` is the nearest place, is in the solid: in a ball of the truth."""
        inside = near.distance <= near.radius
        if self.is_sheet:
            return inside
        # A thicker edge may hold what is nearer to a thin one.
        left = np.flatnonzero(~inside)
        a = self.points[self.edges[:, 0]]
        step = self.points[self.edges[:, 1]] - a
        squared = np.maximum((step**2).sum(axis=1), 1e-300)
        # A junction's ball is whole, however thin the branches are.
        balls = np.flatnonzero(self.curve.degree > 2)
        for some in batches(left):
            away = points[some, None] - a
            along = ((away * step).sum(axis=2) / squared).clip(0, 1)
            reach = self.cone_radii[:, 0] * (1 - along) + self.cone_radii[:, 1] * along
            inside[some] = (np.linalg.norm(away - along[..., None] * step, axis=2) <= reach).any(axis=1)
            gap = np.linalg.norm(points[some, None] - self.points[balls], axis=2)
            inside[some] |= (gap <= self.radii[balls]).any(axis=1)
        return inside


def batches(indices: Array, together: int = 256) -> list[Array]:
    return [indices[first:first + together] for first in range(0, len(indices), together)]


def nearest_on_edges(points: Array, nodes: Array, edges: Array) -> tuple[Array, Array, Array]:
    """Distance of each point to the nearest edge, which edge that is, and where on it, in [0, 1]."""
    squared, edge, there = igl.point_mesh_squared_distance(points, nodes, edges.astype(np.int64))
    a = nodes[edges[edge, 0]]
    step = nodes[edges[edge, 1]] - a
    length = np.maximum((step**2).sum(axis=1), 1e-300)
    return np.sqrt(squared), edge, (((there - a) * step).sum(axis=1) / length).clip(0, 1)


def read_truth(path: Path) -> Truth:
    with np.load(path) as data:
        nodes, edges = data["nodes"], data["edges"]
        triangles = data["triangles"] if "triangles" in data else np.zeros((0, 3), int)
        cycles = int(data["cycles"]) if "cycles" in data else len(edges) - len(nodes) + 1
    return Truth(nodes, edges, triangles, cycles)


def write_truth(path: Path, truth: Truth) -> None:
    np.savez_compressed(path, nodes=truth.nodes, edges=truth.edges, triangles=truth.triangles,
                        cycles=np.array(truth.cycles))


@dataclass(frozen=True)
class Score:
    """A skeleton against the truth. Lengths are parts of the diagonal, or of the local radius (`..._radii`); of a
    sheet there are neither tips nor junctions nor distances from the truth, and these are nan or 0."""

    components: int
    cycles: int
    true_cycles: int
    tips: int            # of the skeleton
    tips_found: tuple[int, ...]  # which of the truth's
    tips_false: int
    junctions: int       # of the skeleton
    true_junctions: int
    to_truth: float      # mean distances
    from_truth: float
    to_truth_max: float
    from_truth_max: float
    to_truth_radii: float
    from_truth_radii: float
    outside: float       # part of the length
    radius_error: float  # mean, away from junctions and tips; nan if the skeleton has no radii

    @property
    def graph_is_right(self) -> bool:
        """One component and the right number of cycles."""
        return self.components == 1 and self.cycles == self.true_cycles


def score(truth: Truth, curve: Curve) -> Score:
    """Compares a skeleton with the truth. Complexity: O(s log e) for s samples and e edges, and O(e) more for each
    sample outside of the edge next to it."""
    size = truth.size
    spots, lengths = curve.sampled(SPACING * size)
    away = truth.nearest(spots)
    share = lengths / lengths.sum()

    def mean(values: Array) -> float:
        return float((values * share).sum())

    found: tuple[int, ...] = ()
    false, back, back_radii = 0, np.array([np.nan]), np.array([np.nan])
    if not truth.is_sheet:
        ends = curve.points[curve.degree == 1]
        own = np.flatnonzero(truth.curve.degree == 1)
        gaps = np.linalg.norm(truth.points[own][:, None] - ends, axis=2)
        if len(ends) and len(own):
            reached = gaps.min(axis=1) <= np.maximum(truth.radii[own], NEAR_TIP * size)
            found = tuple(int(t) for t in np.intersect1d(own[reached], truth.tips))
        limits = np.maximum(FALSE_RADII * truth.radii[own], FALSE_TIP * size)
        false = int((gaps > limits[:, None]).all(axis=0).sum())
        there = truth.curve.sampled(SPACING * size)[0]
        back = nearest_on_edges(there, curve.points, curve.simple_edges)[0]
        back_radii = back / truth.nearest(there).radius
    return Score(
        components=curve.components, cycles=curve.cycles, true_cycles=truth.cycles,
        tips=int((curve.degree == 1).sum()),
        tips_found=found, tips_false=false,
        junctions=int((curve.degree > 2).sum()),
        true_junctions=0 if truth.is_sheet else int((truth.curve.degree > 2).sum()),
        to_truth=mean(away.distance) / size, from_truth=float(back.mean()) / size,
        to_truth_max=float(away.distance.max()) / size, from_truth_max=float(back.max()) / size,
        to_truth_radii=mean(away.distance / away.radius), from_truth_radii=float(back_radii.mean()),
        outside=mean(~truth.is_inside(spots, away)),
        radius_error=radius_error(truth, curve),
    )


def radius_error(truth: Truth, curve: Curve) -> float:
    """Mean of |r - R| / R over the nodes more than two radii away from the truth's junctions and tips; nan without
    radii, and in a sheet, whose thickness a curve does not have."""
    if curve.radii is None or truth.is_sheet:
        return float("nan")
    near = truth.nearest(curve.points)
    away = np.ones(len(curve.points), bool)
    for node in np.flatnonzero(truth.curve.degree != 2):
        gap = np.linalg.norm(curve.points - truth.points[node], axis=1)
        away &= gap > 2 * truth.radii[node]
    error = np.abs(curve.radii - near.radius) / near.radius
    return float(error[away].mean()) if away.any() else float("nan")
