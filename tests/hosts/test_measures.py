# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter Measure Skeleton against the bench's measures, which share no code with it."""

import json
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest
from scipy.spatial import cKDTree

from conftest import FULL, MESHES, ROOT, opened

sys.path.insert(0, str(ROOT / "scripts" / "bench"))

from curve import Curve  # noqa: E402
from quality import SAMPLE_SPACING, Shape, measure, uncovered  # noqa: E402

MEASURE = "compute_skeleton_measures_mcf"
# Of the bench's reference; the filter takes ten times as many.
SAMPLES = 8000


def known_skeleton(name: str) -> Curve:
    record = json.loads((MESHES / f"{name}.json").read_text())["skeleton"]
    return Curve(np.array(record["nodes"]), np.array(record["edges"]))


def half_outside(name: str) -> Curve:
    """Moved across the shape by half of its extent: some of it inside, much of it not."""
    curve = known_skeleton(name)
    spread, axes = np.linalg.eigh(np.cov((curve.points - curve.points.mean(axis=0)).T))
    return Curve(curve.points + np.sqrt(spread[-1]) * axes[:, 1], curve.edges)


def with_a_spur(name: str) -> Curve:
    """With a twig that does not leave the ball it hangs from."""
    curve = known_skeleton(name)
    root = int(np.flatnonzero(curve.degree == 2)[len(curve.points) // 3])
    reach = 0.2 * np.linalg.norm(np.ptp(curve.points, axis=0)) / len(curve.points)
    return Curve(np.vstack([curve.points, curve.points[root] + [0, reach, reach]]),
                 np.vstack([curve.edges, [root, len(curve.points)]]))


def by_the_filter(shape: str, curve: Curve) -> dict[str, float]:
    layers = opened(shape)
    layers.add_mesh(pymeshlab.Mesh(vertex_matrix=curve.points,
                                   edge_matrix=curve.edges.astype(np.int32)), "skeleton")
    return layers.apply_filter(MEASURE, surface=0)


def by_the_bench(name: str, skeleton: Curve) -> dict[str, float]:
    """The bench's figures, and with its tools those that it does not report."""
    shape = Shape.read(Path(MESHES / f"{name}.off"))
    result = measure(shape, shape.medial_axis(SAMPLES), skeleton)
    curve = skeleton.transformed(shape.origin, shape.diagonal)
    samples, _ = curve.sampled(SAMPLE_SPACING)
    surface, _ = shape.surface_samples(20_000, seed=3)
    cover = cKDTree(samples).query(surface)[0]
    within = np.random.default_rng(3).random((40_000, 3)) * np.ptp(shape.vertices, axis=0)
    within = within[shape.contains(within)]
    radii = np.where(shape.contains(samples), shape.closest(samples)[0], 0.0)
    filled = uncovered(samples, radii, within) == 0
    return result | {"cover_mean": 100 * cover.mean(), "cover_max": 100 * cover.max(),
                     "filled": filled.mean()}


@pytest.mark.parametrize("name, skeleton", [
    ("animal450", known_skeleton), ("torus_capsule", known_skeleton), ("y_tube", with_a_spur),
    ("bent_tube", half_outside),
], ids=["limbs", "cycles", "spur", "half outside"])
def test_agrees_with_the_bench(name, skeleton):
    curve = skeleton(name)
    ours, theirs = by_the_filter(name, curve), by_the_bench(name, curve)
    for key in ["components", "cycles", "junctions", "spurs"]:
        assert ours[key] == theirs[key], key
    assert ours["terminals"] == theirs["tips"]
    assert ours["inside_fraction"] == pytest.approx(theirs["inside"], abs=0.01)
    # Percent of the diagonal; a reference with fewer samples is a little farther away.
    for key, other in [("medial_mean_pct", "medial"), ("recon_mean_pct", "reconstruction"),
                       ("cover_mean_pct", "cover_mean")]:
        assert ours[key] == pytest.approx(theirs[other], rel=0.03, abs=0.02), key
    for key, other in [("recon_max_pct", "reconstruction_max"), ("cover_max_pct", "cover_max")]:
        assert ours[key] == pytest.approx(theirs[other], rel=0.05, abs=0.05), key
    assert ours["ball_volume_fraction"] == pytest.approx(theirs["filled"], abs=0.015)


def test_agrees_on_our_own_skeleton():
    layers = opened("horn")
    layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.2))
    mesh = layers.current_mesh()
    curve = Curve(mesh.vertex_matrix(), mesh.edge_matrix())
    ours, theirs = layers.apply_filter(MEASURE, surface=0), by_the_bench("horn", curve)
    assert ours["spurs"] == theirs["spurs"] and ours["cycles"] == theirs["cycles"] == theirs["genus"]
    assert ours["inside_fraction"] == pytest.approx(theirs["inside"], abs=0.01)
    assert ours["medial_mean_pct"] == pytest.approx(theirs["medial"], rel=0.05, abs=0.02)
    assert ours["recon_mean_pct"] == pytest.approx(theirs["reconstruction"], rel=0.03, abs=0.02)
