# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a mesh that are the same shape to anyone who looks, and which branches their skeletons share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

Array = np.ndarray
NEAR = 0.03  # of the diagonal: tips no farther apart than this are one


@dataclass
class Variant:
    """A copy, how the program is run on it, and the way back from its coordinates to the mesh's own."""

    name: str
    points: Array
    triangles: Array
    options: tuple[str, ...]
    back: Callable[[Array], Array]


def rotation(seed: int) -> Array:
    """A proper rotation chosen at random."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def variants(points: Array, triangles: Array) -> Iterator[Variant]:
    """The mesh itself first. The noise is Gaussian, on each coordinate."""
    def same(p: Array) -> Array:
        return p

    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    random = np.random.default_rng(0)
    order = random.permutation(len(points))
    renumbered = np.argsort(order)[triangles][random.permutation(len(triangles))]
    turn = rotation(1)
    mirror = np.array([1.0, -1.0, 1.0])
    bumps = 0.0002 * size * random.normal(size=points.shape)
    yield Variant("as it is", points, triangles, (), same)
    yield Variant("renumbered", points[order], renumbered, (), same)
    yield Variant("rotated", points @ turn.T, triangles, (), lambda p: p @ turn)
    yield Variant("mirrored", points * mirror, triangles[:, ::-1], (), lambda p: p * mirror)
    # In other units single precision rounds elsewhere.
    yield Variant("a thousandth", points / 1000, triangles, (), lambda p: p * 1000)
    yield Variant("noise of 0.02 %", points + bumps, triangles, (), same)
    for percent in ("0.42", "0.46", "0.54", "0.58"):
        yield Variant(f"edges of {percent} %", points, triangles, ("--target-length", percent), same)
    yield Variant("Voronoi poles", points, triangles, ("--pole-method", "voronoi"), same)


def matched(tips: list[Array], near: float) -> list[list[tuple[int, int]]]:
    """For each terminal branch that some variant has, the variants with a tip near it, and which tip that is.

    `tips` holds one array for each variant. Pairs are made nearest first, and each tip is in one branch.
    """
    places: list[Array] = []
    members: list[list[tuple[int, int]]] = []
    for variant, own in enumerate(tips):
        gaps = np.linalg.norm(own[:, None] - np.array(places).reshape(1, -1, 3), axis=2)
        free = set(range(len(own)))
        taken: set[int] = set()
        for flat in np.argsort(gaps, axis=None):
            tip, branch = np.unravel_index(flat, gaps.shape)
            if gaps[tip, branch] > near:
                break
            if tip in free and branch not in taken:
                free.remove(tip)
                taken.add(branch)
                count = len(members[branch])
                places[branch] = (places[branch] * count + own[tip]) / (count + 1)
                members[branch].append((variant, int(tip)))
        for tip in sorted(free):
            places.append(own[tip])
            members.append([(variant, tip)])
    return members
