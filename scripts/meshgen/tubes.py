# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tubes whose centreline is a curve: wavy, knotted, in loops, with aneurysm and stenosis. See trees.py."""
from collections.abc import Callable

import numpy as np

from .trees import Centreline, forked, segment_distances

Array = np.ndarray


def tube(seed: int) -> Centreline:
    """One wavy tube whose radius rises and falls along it by up to a third."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    s = np.linspace(0.0, 1.0, 61)
    waves, phases, heights = rng.uniform(0.5, 2, 3), rng.uniform(0, 2 * np.pi, 3), rng.uniform(1, 3, 2)
    thickest, depth = rng.uniform(0.4, 1.0), rng.uniform(0.0, 1 / 3)
    y, z = (h * np.sin(2 * np.pi * f * s + at) for h, f, at in zip(heights, waves, phases))
    radii = thickest * (1 - depth / 2 * (1 + np.sin(2 * np.pi * waves[2] * s + phases[2])))
    for k, point in enumerate(np.stack([30 * s, y, z], axis=1)):
        line.add(point, float(radii[k]), k - 1)
    return line


def closed_curve(points: Array, radius: float) -> Centreline:
    """A tube around a closed polygon."""
    line = Centreline()
    for k, point in enumerate(points):
        line.add(point, radius, k - 1)
    line.edges.append((len(points) - 1, 0))
    return line


def least_gap(points: Array, near: int) -> float:
    """The least distance of pieces of a closed polygon that are more than `near` pieces apart along it."""
    ends = np.roll(points, -1, axis=0)
    count, gap = len(points), np.inf
    pieces = np.arange(count)
    for k in range(count):
        along = np.abs(pieces - k)
        far = np.minimum(along, count - along) > near
        gap = min(gap, float(segment_distances(points[k], ends[k], points[far], ends[far]).min()))
    return gap


def knot(seed: int) -> Centreline:
    """A torus knot; its radius is a fifth to nearly a half of the distance between its strands."""
    rng = np.random.default_rng(seed)
    p, q = [(2, 3), (2, 5), (3, 4), (3, 5), (2, 7)][seed % 5]
    count = 40 * (p + q)
    t = 2 * np.pi * np.arange(count) / count
    ring = 5.0 + rng.uniform(1.6, 2.2) * np.cos(q * t)
    points = np.stack([ring * np.cos(p * t), ring * np.sin(p * t), 2.0 * np.sin(q * t)], axis=1)
    return closed_curve(points, float(least_gap(points, count // (p + q)) * rng.uniform(0.2, 0.45)))


def loops(seed: int) -> Centreline:
    """A ring with up to four arcs from one place of it to another, and up to three spurs into the open."""
    rng = np.random.default_rng(seed)
    count, radius = 72, rng.uniform(0.25, 0.45)
    t = 2 * np.pi * np.arange(count) / count
    ring = np.stack([6 * np.cos(t), 6 * np.sin(t), np.zeros(count)], axis=1)
    line = closed_curve(ring, radius)
    free = list(range(0, count, 6))
    s = np.linspace(0, 1, 13)[:, None]
    for _ in range(int(rng.integers(1, 5))):
        for _ in range(50):
            a, b = (int(x) for x in rng.choice(free, 2, replace=False))
            height = rng.uniform(2.0, 8.0) * rng.choice([-1, 1])
            arc = ring[a] * (1 - s) + ring[b] * s + height * np.sin(np.pi * s) * [0, 0, 1]
            near = set(range(a - 5, a + 6)) | set(range(b - 5, b + 6))
            skip = {n % count for n in near}
            if all(line.clear_of(p, q, radius, radius, skip) for p, q in zip(arc, arc[1:])):
                break
        else:
            continue
        at = a
        for point in arc[1:-1]:
            at = line.add(point, 0.8 * radius, at)
        line.edges.append((at, b))
        free = [place for place in free if place not in (a, b)]
    for a in rng.choice(free, min(len(free), int(rng.integers(0, 4))), replace=False):
        at = int(a)
        for k in (1, 2, 3):
            at = line.add(ring[a] * (1 + k / 6), radius * (1 - 0.2 * k), at)
    return line


def aneurysm(seed: int) -> Centreline:
    """A vessel tree whose trunk has an aneurysm, 1.8 to 2.8 times as wide, and a stenosis, a third as wide."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    wide, narrow = rng.uniform(1.8, 2.8), rng.uniform(0.25, 0.4)
    at = -1
    # The last piece is long: what forks off keeps apart from all others.
    for z in (*range(33), 42.0):
        radius = 1.2 * (1 + (wide - 1) * np.exp(-((z - 12) / 3.0) ** 2)
                        - (1 - narrow) * np.exp(-((z - 28) / 2.5) ** 2))
        at = line.add(np.array([1.5 * np.sin(z / 12), 0.0, z]), float(radius), at)
    way = line.nodes[-1][:3] - line.nodes[-2][:3]
    forked(line, at, way / np.linalg.norm(way), 20.0, 1.1, 3, 0.65, 0.75, rng)
    return line


FAMILIES: dict[str, Callable[[int], Centreline]] = {
    "tube": tube,
    "knot": knot,
    "loops": loops,
    "aneurysm": aneurysm,
}
