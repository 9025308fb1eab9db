# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Implicit field to triangle mesh: marching cubes, then relaxation on the surface."""
import fast_simplification
import numpy as np
from scipy.sparse import coo_matrix, diags
from skimage.measure import marching_cubes

from .fields import Array, Field

COARSE = 4
RELAXATIONS = 20


def sample_grid(field: Field, axes: list[Array]) -> Array:
    """Field on a grid: exact near the surface, the right sign elsewhere."""
    shape = tuple(len(axis) for axis in axes)
    cell = axes[0][1] - axes[0][0]
    coarse = np.stack(np.meshgrid(*[axis[::COARSE] for axis in axes], indexing="ij"), -1)
    values = field(coarse.reshape(-1, 3)).reshape(coarse.shape[:3])
    for axis, size in enumerate(shape):
        # To the nearest coarse sample, so that the distance is at most half a coarse diagonal.
        pick = np.minimum((np.arange(size) + COARSE // 2) // COARSE, values.shape[axis] - 1)
        values = np.take(values, pick, axis=axis)
    near = np.abs(values) < (COARSE + 1) * cell * np.sqrt(3.0)
    fine = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    values[near] = field(fine[near])
    return values


def gradient(field: Field, x: Array, step: float) -> Array:
    """Central differences."""
    parts = []
    for axis in range(3):
        shift = np.zeros(3)
        shift[axis] = step
        parts.append((field(x + shift) - field(x - shift)) / (2.0 * step))
    return np.stack(parts, axis=1)


def project(field: Field, x: Array, cell: float, rounds: int) -> Array:
    """Move points along the gradient onto the zero set."""
    for _ in range(rounds):
        g = gradient(field, x, 1e-3 * cell)
        squared = np.maximum(np.sum(g**2, axis=1), 0.25)
        step = np.clip(field(x) / squared, -cell / 2.0, cell / 2.0)
        x = x - step[:, None] * g
    return x


def polygonise(field: Field, low: Array, high: Array, cell: float,
               mirror: bool = False) -> tuple[Array, Array]:
    """Triangle mesh of the zero set of `field` inside the box from low to high.

    With `mirror` the half y >= 0 is polygonised and reflected: vertices and faces are then
    exactly symmetric about y = 0 (the field must be). Returns vertices (n, 3), faces (m, 3).
    """
    low, high = np.asarray(low, float) - 3.0 * cell, np.asarray(high, float) + 3.0 * cell
    # An irrational shift keeps grid nodes off the symmetry planes of the shapes.
    low = low + cell * np.array([0.3819660, 0.3247180, 0.2360680])
    if mirror:
        low[1] = -2.0 * COARSE * cell
    axes = [low[i] + cell * np.arange(int(np.ceil((high[i] - low[i]) / cell)) + COARSE)
            for i in range(3)]
    values = sample_grid(field, axes)
    v, f, _, _ = marching_cubes(values, 0.0, spacing=(cell,) * 3, allow_degenerate=False)
    v, f = v.astype(float) + low, f[:, ::-1].astype(np.int64)
    twin = None
    if mirror:
        v, f, twin = reflect(v, f, cell)
    v = relax(field, v, f, cell, twin)
    if signed_volume(v, f) < 0.0:
        f = f[:, ::-1]
    return v, np.ascontiguousarray(f)


def reflect(v: Array, f: Array, cell: float) -> tuple[Array, Array, Array]:
    """Keep the half y >= 0, add its mirror image; returns also the twin of each vertex."""
    f = f[v[f][:, :, 1].mean(axis=1) > 0.0]
    used, f = np.unique(f, return_inverse=True)
    f, v = f.reshape(-1, 3), v[used]
    seam = np.abs(v[:, 1]) < 1e-4 * cell
    v[seam, 1] = 0.0
    free = np.flatnonzero(~seam)
    twin = np.arange(len(v))
    twin[free] = len(v) + np.arange(len(free))
    whole = np.concatenate([v, v[free] * (1.0, -1.0, 1.0)])
    faces = np.concatenate([f, twin[f][:, ::-1]])
    return whole, faces, np.concatenate([twin, free])


def relax(field: Field, v: Array, f: Array, cell: float, twin: Array | None) -> Array:
    """Even out the triangles: to the mean of the ring, and back onto the surface."""
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    ones = np.ones(len(edges))
    ring = coo_matrix((ones, (edges[:, 0], edges[:, 1])), shape=(len(v), len(v))).tocsr()
    ring = diags(1.0 / np.asarray(ring.sum(axis=1)).ravel()) @ ring
    for i in range(RELAXATIONS):
        v = project(field, 0.5 * v + 0.5 * (ring @ v), cell, 6 if i == RELAXATIONS - 1 else 1)
        if twin is not None:
            low = np.flatnonzero(twin >= np.arange(len(v)))
            v[low[twin[low] == low], 1] = 0.0
            v[twin[low]] = v[low] * (1.0, -1.0, 1.0)
    return v


def signed_volume(v: Array, f: Array) -> float:
    """Volume enclosed, positive where the faces look outwards."""
    a, b, c = v[f[:, 0]], v[f[:, 1]], v[f[:, 2]]
    return float(np.sum(a * np.cross(b, c)) / 6.0)


def decimate(v: Array, f: Array, vertices: int) -> tuple[Array, Array]:
    """Quadric edge collapse of a closed mesh of genus 0 to exactly `vertices` vertices."""
    points, faces = fast_simplification.simplify(
        v.astype(np.float32), f.astype(np.int32), target_count=2 * vertices - 4)
    return points.astype(float), faces.astype(np.int64)
