# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes on regular grids: boxes, tori, surfaces of revolution."""
import numpy as np

from .fields import Array


def box_grid(size: tuple[float, float, float], cell: float) -> tuple[Array, Array]:
    """Surface of a box about the origin, each side a grid of squares with alternating diagonals.

    A cell as long as the longest side gives the 8 corners alone.
    """
    count = [max(1, round(s / cell)) for s in size]
    points, faces = [], []
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for a in range(count[i]):
                for b in range(count[j]):
                    corner = np.zeros((4, 3), int)
                    corner[:, axis] = side * count[axis]
                    corner[:, i] = a + np.array([0, 1, 1, 0])
                    corner[:, j] = b + np.array([0, 0, 1, 1])
                    base = 4 * (len(points))
                    quad = [(0, 1, 2), (0, 2, 3)] if (a + b) % 2 else [(0, 1, 3), (1, 2, 3)]
                    for t in quad:
                        faces.append([base + k for k in (t if side else t[::-1])])
                    points.append(corner)
    corners = np.concatenate(points)
    unique, index = np.unique(corners, axis=0, return_inverse=True)
    v = (unique / np.array(count) - 0.5) * np.array(size)
    return v, index.ravel()[np.array(faces)]


def torus_grid(major: float, minor: float, around: int, across: int) -> tuple[Array, Array]:
    """A torus of around x across vertices on its surface, axis z."""
    u, w = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2.0 * np.pi * u / around, 2.0 * np.pi * w / across
    r = major + minor * np.cos(b)
    v = np.stack([r * np.cos(a), r * np.sin(a), minor * np.sin(b)], -1).reshape(-1, 3)

    def at(i: Array, j: Array) -> Array:
        return (i % around * across + j % across).ravel()

    p, q, s, t = at(u, w), at(u + 1, w), at(u + 1, w + 1), at(u, w + 1)
    return v, np.concatenate([np.stack([p, q, s], 1), np.stack([p, s, t], 1)])


def revolved(radii: Array, heights: Array, around: int) -> tuple[Array, Array]:
    """A closed profile off the z axis, anticlockwise in the plane of radius and height, turned about it: a ring."""
    count = len(radii)
    a = 2.0 * np.pi * np.arange(around) / around
    v = np.stack([np.outer(np.cos(a), radii), np.outer(np.sin(a), radii),
                  np.tile(heights, (around, 1))], -1).reshape(-1, 3)
    i, k = np.meshgrid(np.arange(around), np.arange(count), indexing="ij")

    def at(i: Array, k: Array) -> Array:
        return (i % around * count + k % count).ravel()

    p, q, s, t = at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)
    return v, np.concatenate([np.stack([p, q, s], 1), np.stack([p, s, t], 1)])


def capped(radii: Array, heights: Array, around: int) -> tuple[Array, Array]:
    """As revolved, of a profile whose first and last point are on the axis, and no other."""
    a = 2.0 * np.pi * np.arange(around) / around
    inner, level = radii[1:-1], heights[1:-1]
    count = len(inner)
    rings = np.stack([np.outer(np.cos(a), inner), np.outer(np.sin(a), inner),
                      np.tile(level, (around, 1))], -1).reshape(-1, 3)
    v = np.vstack([rings, [[0, 0, heights[0]], [0, 0, heights[-1]]]])
    first, last = len(rings), len(rings) + 1
    i, k = np.meshgrid(np.arange(around), np.arange(count - 1), indexing="ij")

    def at(i: Array, k: Array | int) -> Array:
        return (i % around * count + k).ravel()

    p, q, s, t = at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)
    turn = np.arange(around)
    return v, np.concatenate([
        np.stack([p, q, s], 1), np.stack([p, s, t], 1),
        np.stack([np.full(around, first), at(turn + 1, 0), at(turn, 0)], 1),
        np.stack([np.full(around, last), at(turn, count - 1), at(turn + 1, count - 1)], 1)])
