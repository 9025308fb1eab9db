# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Known curve skeletons: the axes of tubes, and where they are exact."""
from dataclasses import dataclass, field

import numpy as np

from .fields import Array, Field, Tube

CONTACTS = 48


@dataclass
class Skeleton:
    """Nodes (n, 3), a radius and an exactness flag for each, edges (m, 2)."""

    nodes: Array = field(default_factory=lambda: np.zeros((0, 3)))
    radii: Array = field(default_factory=lambda: np.zeros(0))
    exact: Array = field(default_factory=lambda: np.zeros(0, bool))
    edges: Array = field(default_factory=lambda: np.zeros((0, 2), int))

    def add(self, nodes: Array, radii: Array, exact: Array, closed: bool = False) -> None:
        """Append one polyline."""
        base, count = len(self.nodes), len(nodes)
        steps = np.arange(count if closed else count - 1)
        new = np.stack([base + steps, base + (steps + 1) % count], axis=1)
        self.nodes = np.concatenate([self.nodes, nodes])
        self.radii = np.concatenate([self.radii, radii])
        self.exact = np.concatenate([self.exact, exact])
        self.edges = np.concatenate([self.edges, new])

    def keep(self, mask: Array) -> None:
        """Drop the nodes outside `mask`, with their edges."""
        index = np.cumsum(mask) - 1
        self.edges = index[self.edges[mask[self.edges].all(axis=1)]]
        self.nodes, self.radii, self.exact = self.nodes[mask], self.radii[mask], self.exact[mask]

    def weld(self, tolerance: float) -> None:
        """Merge nodes that coincide: the ends of the tubes that meet at a junction."""
        target = np.arange(len(self.nodes))
        for i in range(len(self.nodes)):
            gap = np.linalg.norm(self.nodes[:i] - self.nodes[i], axis=1)
            if i and gap.min() < tolerance:
                target[i] = target[int(gap.argmin())]
        first = target == np.arange(len(self.nodes))
        # A merged node is exact only where all its tubes say so, with the largest radius.
        for i in np.flatnonzero(~first):
            self.exact[target[i]] &= self.exact[i]
            self.radii[target[i]] = max(self.radii[target[i]], self.radii[i])
        index = np.cumsum(first) - 1
        self.edges = index[target[self.edges]]
        self.nodes, self.radii, self.exact = self.nodes[first], self.radii[first], self.exact[first]


def resample(tube: Tube, spacing: float) -> tuple[Array, Array]:
    """Nodes on the tube's axis, evenly spaced, ends included, and their radii."""
    points, radii = tube.points, tube.radii
    if tube.closed:
        points, radii = np.vstack([points, points[:1]]), np.append(radii, radii[0])
    arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    count = max(2, int(round(arc[-1] / spacing)) + 1)
    if len(points) > 2:
        # Nodes are a subset of the samples of a curved axis, so that they stay on it.
        pick = np.unique(np.round(np.linspace(0, len(points) - 1, count)).astype(int))
        if tube.closed:
            pick = pick[:-1]
        return points[pick], radii[pick]
    t = np.linspace(0.0, arc[-1], count)
    nodes = np.stack([np.interp(t, arc, points[:, k]) for k in range(3)], axis=1)
    return nodes, np.interp(t, arc, radii)


def untouched(nodes: Array, radii: Array, closed: bool, others: list[Field],
              blend: float) -> Array:
    """Where a tube's skeleton is exact: its circle of contact is out of all other parts' reach.

    There the ball lies in the shape and touches the surface in a full circle, so the node is a
    point of the medial axis with this radius, and the section around it is a disc.
    """
    if closed:
        tangent = np.roll(nodes, -1, axis=0) - np.roll(nodes, 1, axis=0)
        slope = (np.roll(radii, -1) - np.roll(radii, 1)) / np.linalg.norm(tangent, axis=1)
    else:
        tangent = np.gradient(nodes, axis=0)
        slope = np.gradient(radii) / np.linalg.norm(tangent, axis=1)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    seed = np.eye(3)[np.argmin(np.abs(tangent), axis=1)]
    u = np.cross(tangent, seed)
    u /= np.linalg.norm(u, axis=1)[:, None]
    w = np.cross(tangent, u)
    good = np.ones(len(nodes), bool)
    for angle in 2.0 * np.pi * np.arange(CONTACTS) / CONTACTS:
        out = np.sqrt(1.0 - slope**2)[:, None] * (np.cos(angle) * u + np.sin(angle) * w)
        contact = nodes + radii[:, None] * (out - slope[:, None] * tangent)
        for other in others:
            good &= other(contact) >= blend
    return good


def long_runs(mask: Array, nodes: Array, radii: Array) -> Array:
    """The runs of `mask` that are longer than the radius: shorter ones are no branch."""
    result = np.zeros_like(mask)
    borders = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    for start, stop in borders.reshape(-1, 2):
        length = np.linalg.norm(nodes[stop - 1] - nodes[start])
        result[start:stop] = length > radii[start:stop].mean()
    return result


def skeleton_of_tubes(tubes: list[Tube], rest: list[Field], blend: float, spacing: float,
                      complete: bool) -> Skeleton:
    """Axes of the tubes of a union of tubes and other parts.

    complete: the axes form the whole skeleton and are joined where their ends meet, exact or
    not; else only the exact pieces are kept.
    """
    skeleton = Skeleton()
    for k, tube in enumerate(tubes):
        nodes, radii = resample(tube, spacing)
        others = [t for j, t in enumerate(tubes) if j != k] + rest
        exact = untouched(nodes, radii, tube.closed, others, blend)
        if not complete:
            exact &= long_runs(exact, nodes, radii)
        skeleton.add(nodes, radii, exact, tube.closed)
    if complete:
        skeleton.weld(1e-9)
    else:
        skeleton.keep(skeleton.exact)
    return skeleton
