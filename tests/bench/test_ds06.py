# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bench's version of Dey and Sun 2006, on shapes whose skeletons are known."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "bench"))
pytest.importorskip("scipy")
pytest.importorskip("igl")

from curve import Curve  # noqa: E402
from ds06 import ds06, geodesic_distances, inner_voronoi  # noqa: E402
from meshes import read_mesh  # noqa: E402


def torus() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.torus(1.0, 0.25, 72, 24)
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)


def curve_of(points: np.ndarray, triangles: np.ndarray) -> Curve:
    nodes, edges, _ = ds06(points, triangles)
    return Curve(nodes, edges)


def test_distances_are_along_the_surface():
    mesh = trimesh.creation.icosphere(4)
    points, triangles = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)
    sides = np.column_stack([np.zeros(50, int), np.random.default_rng(1).integers(1, len(points), 50)])
    exact = np.arccos((points[sides[:, 0]] * points[sides[:, 1]]).sum(axis=1).clip(-1, 1))
    ratio = geodesic_distances(points, triangles, sides) / exact
    assert ratio.min() > 0.99 and ratio.max() < 1.05


def test_the_voronoi_diagram_has_the_topology_of_the_solid():
    assert inner_voronoi(*torus()).euler_characteristic == 0
    points, triangles = read_mesh(ROOT / "meshes/y_tube.off")
    assert inner_voronoi(points, triangles).euler_characteristic == 1


@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_a_torus_has_its_circle(scale: float):
    points, triangles = torus()
    curve = curve_of(scale * points + 7, triangles)
    assert (curve.components, curve.cycles, curve.degree.min(), curve.degree.max()) == (1, 1, 2, 2)
    nodes = (curve.points - 7) / scale
    assert np.hypot(*nodes[:, :2].T) == pytest.approx(1.0, abs=0.01)
    assert nodes[:, 2] == pytest.approx(0.0, abs=0.01)


def test_a_capsule_has_its_axis():
    points, triangles = read_mesh(ROOT / "meshes/capsule.off")
    curve = curve_of(points, triangles)
    assert (curve.components, curve.cycles) == (1, 0)
    along = np.argmax(np.ptp(points, axis=0))
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = np.delete(np.ptp(points, axis=0), along).max() / 2
    aside = np.linalg.norm(np.delete(curve.points - middle, along, axis=1), axis=1)
    assert aside.max() < 0.05 * radius
    assert np.ptp(curve.points[:, along]) == pytest.approx(np.ptp(points[:, along]) - 2 * radius, abs=0.3 * radius)


def test_a_tube_of_three_arms_has_three():
    points, triangles = read_mesh(ROOT / "meshes/y_tube.off")
    curve = curve_of(points, triangles)
    assert (curve.components, curve.cycles) == (1, 0)
    tips = curve.points[curve.degree == 1]
    fork = curve.points[curve.degree > 2]
    assert len(fork) and np.ptp(fork, axis=0).max() < 0.1 * np.ptp(points, axis=0).max()
    arms = tips - fork.mean(axis=0)
    long = arms[np.linalg.norm(arms, axis=1) > 0.3 * np.ptp(points, axis=0).max()]
    directions = long / np.linalg.norm(long, axis=1, keepdims=True)
    assert np.linalg.matrix_rank((directions @ directions.T > 0.9).astype(float)) == 3
