# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bench's measures of quality, on shapes and curves whose answers are known.

Needs the bench's own Python (scripts/bench/requirements.txt).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "bench"))
pytest.importorskip("igl")

from curve import Curve, mean_distance, read_curve  # noqa: E402
from quality import Shape, measure  # noqa: E402

# Enough for shapes as plain as these, on which every search for the nearest point is slow, many
# points being equally near.
SAMPLES = 6000


def chain(points: np.ndarray, closed: bool = False) -> Curve:
    index = np.arange(len(points))
    edges = np.column_stack([index, np.roll(index, -1)])
    return Curve(points, edges if closed else edges[:-1])


@pytest.fixture(scope="module")
def capsule() -> tuple[Shape, np.ndarray]:
    """Radius 1 around the segment from (0, 0, -3) to (0, 0, 3)."""
    mesh = trimesh.creation.capsule(height=6.0, radius=1.0, count=[48, 48])
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    shape = Shape(mesh)
    return shape, shape.medial_axis(SAMPLES)


@pytest.fixture(scope="module")
def torus() -> tuple[Shape, np.ndarray]:
    shape = Shape(trimesh.creation.torus(3.0, 0.8, major_sections=128, minor_sections=48))
    return shape, shape.medial_axis(SAMPLES)


AXIS = np.column_stack([np.zeros(61), np.zeros(61), np.linspace(-3.0, 3.0, 61)])


def test_the_axis_of_a_capsule_is_a_perfect_skeleton(capsule):
    result = measure(*capsule, chain(AXIS))
    assert (result["components"], result["cycles"], result["genus"]) == (1, 0, 0)
    assert (result["tips"], result["junctions"], result["spurs"]) == (2, 0, 0)
    assert result["inside"] == pytest.approx(1.0)
    assert result["medial"] < 0.05
    assert result["reconstruction"] < 0.05
    assert result["turning"] < 0.01


def test_a_shifted_axis_is_off_by_the_shift(capsule):
    shape, _ = capsule
    result = measure(*capsule, chain(AXIS + [0.5, 0.0, 0.0]))
    assert result["medial"] == pytest.approx(100 * 0.5 / shape.diagonal, rel=0.03)
    assert result["inside"] == pytest.approx(1.0)


def test_an_axis_outside_is_seen_to_be_outside(capsule):
    assert measure(*capsule, chain(AXIS + [1.2, 0.0, 0.0]))["inside"] == 0.0


def test_half_an_axis_leaves_the_other_half_of_the_shape_out(capsule):
    shape, _ = capsule
    result = measure(*capsule, chain(AXIS[:31]))
    # The far pole is at z = 4; the last ball reaches up to z = 1.
    assert result["reconstruction_max"] == pytest.approx(100 * 3.0 / shape.diagonal, rel=0.03)


def test_a_zigzag_turns_by_its_angle(capsule):
    shape, _ = capsule
    step = 0.005 * shape.diagonal
    heights = np.arange(-60, 61) * step / np.sqrt(2.0)
    zigzag = np.column_stack(
        [np.where(np.arange(121) % 2, step / np.sqrt(2.0), 0.0), np.zeros(121), heights]
    )
    assert measure(*capsule, chain(zigzag))["turning"] == pytest.approx(90.0, abs=1.0)


def test_a_hair_inside_the_ball_of_its_junction_is_a_spur_and_a_limb_is_none(capsule):
    def with_branch(length: float) -> Curve:
        axis = chain(AXIS)
        points = np.vstack([axis.points, [[length, 0.0, 0.0]]])
        return Curve(points, np.vstack([axis.edges, [[30, len(AXIS)]]]))

    hair = measure(*capsule, with_branch(0.3))
    assert (hair["tips"], hair["junctions"], hair["spurs"]) == (3, 1, 1)


def test_defects_of_the_graph_are_counted(capsule):
    axis = chain(AXIS)
    edges = np.vstack([axis.edges[:30], axis.edges[31:], [[1, 0], [5, 5]]])
    result = measure(*capsule, Curve(axis.points, edges))
    assert result["components"] == 2
    assert result["duplicate_edges"] == 1
    assert result["zero_edges"] == 1


def test_a_ring_in_a_torus_has_its_one_cycle(torus):
    angle = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    ring = np.column_stack([3.0 * np.cos(angle), 3.0 * np.sin(angle), 0.0 * angle])
    result = measure(*torus, chain(ring, closed=True))
    assert (result["cycles"], result["genus"], result["tips"]) == (1, 1, 0)
    assert result["medial"] < 0.05
    assert result["reconstruction"] < 0.1
    cut = measure(*torus, chain(ring))
    assert (cut["cycles"], cut["tips"]) == (0, 2)


def inward(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    mesh.invert()
    return mesh


def test_a_void_is_outside():
    hollow = trimesh.util.concatenate([
        trimesh.creation.capsule(height=6.0, radius=1.0, count=[48, 48]),
        inward(trimesh.creation.capsule(height=3.0, radius=0.5, count=[48, 48]))])
    hollow.apply_translation(-hollow.bounds.mean(axis=0))
    shape = Shape(hollow)
    assert (shape.components, shape.voids, shape.genus) == (1, 1, 0)
    axis = shape.medial_axis(SAMPLES)
    assert measure(shape, axis, chain(AXIS))["inside"] == pytest.approx(1 / 3, abs=0.01)
    assert measure(shape, axis, chain(AXIS + [0.75, 0, 0]))["medial"] < 3


def test_voids_of_nested_shells_and_of_a_torus():
    ball = trimesh.creation.icosphere
    nested = Shape(trimesh.util.concatenate(
        [ball(3, 1.0), inward(ball(3, 0.7)), ball(3, 0.5), inward(ball(3, 0.25))]))
    assert (nested.components, nested.voids, nested.genus) == (2, 2, 0)
    along = np.array([[0.85, 0, 0], [0.6, 0, 0], [0.4, 0, 0], [0.1, 0, 0]])
    assert nested.contains((along - nested.origin) / nested.diagonal).tolist() == [True, False, True, False]
    ring = Shape(trimesh.util.concatenate([
        trimesh.creation.torus(1.0, 0.4), inward(trimesh.creation.torus(1.0, 0.2))]))
    assert (ring.components, ring.voids, ring.genus) == (1, 1, 2)


def test_measures_do_not_depend_on_size_and_place(capsule):
    shape, _ = capsule
    mesh = trimesh.Trimesh(shape.vertices * 1e5 + [7e5, 0.0, 0.0], shape.faces, process=False)
    moved = Shape(mesh)
    curve = Curve((AXIS + [0.3, 0.0, 0.0] - shape.origin) / shape.diagonal * 1e5 + [7e5, 0, 0],
                  chain(AXIS).edges)
    expected = measure(*capsule, chain(AXIS + [0.3, 0.0, 0.0]))
    result = measure(moved, moved.medial_axis(SAMPLES), curve)
    for name in ("inside", "medial", "reconstruction", "length"):
        assert result[name] == pytest.approx(expected[name], rel=1e-3)


def test_the_distance_of_parallel_lines_is_their_gap():
    assert mean_distance(chain(AXIS), chain(AXIS + [0.25, 0, 0]), 0.01) == pytest.approx(
        0.25, rel=1e-3
    )


@pytest.mark.parametrize("name", ["curve.obj", "curve.cg", "curve.ply"])
def test_every_format_gives_the_same_graph(tmp_path, name):
    path = tmp_path / name
    if name.endswith(".ply"):
        path.write_text(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
            "property double z\nelement edge 2\nproperty int vertex1\nproperty int vertex2\n"
            "end_header\n0 0 0\n1 0 0\n1 2 0\n0 1\n1 2\n"
        )
    else:
        edges = "e 1 2\ne 2 3\n" if name.endswith(".cg") else "l 1 2 3\n"
        path.write_text("v 0 0 0\nv 1 0 0\nv 1 2 0\n" + edges)
    curve = read_curve(path)
    assert curve.edge_lengths.tolist() == [1.0, 2.0]
    assert [sorted(b) for b in curve.branches] == [[0, 1, 2]]
