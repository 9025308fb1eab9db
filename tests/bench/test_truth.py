# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scores of the benchmark, on curves whose distance from the truth is known; and the files that are read.

Needs the bench's own Python (scripts/bench/requirements.txt).
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

BENCH = Path(__file__).resolve().parents[2] / "scripts" / "bench"
sys.path.insert(0, str(BENCH))
pytest.importorskip("igl")

from curve import Curve, read_curve  # noqa: E402
from truth import Truth, read_truth, score, write_truth  # noqa: E402

# A trunk of radius 1 along z from 0 to 20, and at its end two branches of radius 0.5.
NODES = np.array([[0, 0, 0, 1], [0, 0, 10, 1], [0, 0, 20, 1], [8, 0, 26, 0.5], [-8, 0, 26, 0.5]], float)
EDGES = np.array([[0, 1], [1, 2], [2, 3], [2, 4]])


@pytest.fixture
def fork() -> Truth:
    return Truth(NODES, EDGES, np.zeros((0, 3), int), 0)


@pytest.fixture
def plate() -> Truth:
    """10 by 10, half a thickness of 0.2, flat."""
    corners = np.array([[0, 0, 0, 0.2], [10, 0, 0, 0.2], [10, 10, 0, 0.2], [0, 10, 0, 0.2]], float)
    return Truth(corners, np.zeros((0, 2), int), np.array([[0, 1, 2], [0, 2, 3]]), 0)


def test_the_truth_itself_has_a_perfect_score(fork):
    s = score(fork, Curve(NODES[:, :3], EDGES, NODES[:, 3]))
    assert s.graph_is_right and (s.tips, s.tips_false, s.junctions, s.true_junctions) == (3, 0, 1, 1)
    assert s.tips_found == (0, 3, 4)
    assert max(s.to_truth, s.from_truth, s.to_truth_radii, s.outside) < 1e-9
    assert s.radius_error < 1e-9


def test_a_curve_that_is_aside_is_as_far_away_as_it_is(fork):
    s = score(fork, Curve(NODES[:, :3] + [0, 0.3, 0], EDGES))
    assert s.to_truth * fork.size == pytest.approx(0.3, rel=1e-6)
    assert s.from_truth * fork.size == pytest.approx(0.3, rel=1e-6)
    # The radius is 1 on the trunk, 20 long, and falls evenly to 0.5 on both branches, ten long each.
    start = 0.5 / 0.7
    assert s.to_truth_radii == pytest.approx(0.3 * (20 + 20 * np.log(start / 0.5) / (start - 0.5)) / 40, rel=0.001)
    assert s.outside == 0 and np.isnan(s.radius_error)


def test_what_is_beyond_the_balls_is_outside(fork):
    s = score(fork, Curve(NODES[:, :3] + [0, 0.7, 0], EDGES))
    assert s.outside == pytest.approx(0.5, abs=0.05)  # the branches


def test_a_missing_branch_is_one_tip_less_and_a_hair_is_a_false_one(fork):
    lost = score(fork, Curve(NODES[:4, :3], EDGES[:3]))
    assert lost.tips_found == (0, 3) and lost.tips_false == 0
    assert lost.to_truth < 1e-9 and lost.from_truth_max * fork.size == pytest.approx(10, rel=0.01)
    hair = score(fork, Curve(np.vstack([NODES[:, :3], [5, 0, 10]]), np.vstack([EDGES, [1, 5]])))
    assert hair.tips_found == (0, 3, 4) and hair.tips_false == 1


def test_a_short_branch_is_not_asked_for():
    stub = np.vstack([NODES, [0.8, 0, 10, 0.2]])
    truth = Truth(stub, np.vstack([EDGES, [1, 5]]), np.zeros((0, 3), int), 0)
    assert truth.tips.tolist() == [0, 3, 4]
    s = score(truth, Curve(NODES[:, :3], EDGES))
    assert s.tips_found == (0, 3, 4)
    assert score(truth, Curve(stub[:, :3], truth.edges)).tips_false == 0  # nor is it false


def test_loops_and_pieces_are_counted(fork):
    closed = score(fork, Curve(NODES[:, :3], np.vstack([EDGES, [3, 4]])))
    assert closed.cycles == 1 and not closed.graph_is_right
    broken = score(fork, Curve(NODES[:, :3], EDGES[[0, 2, 3]]))
    assert broken.components == 2 and not broken.graph_is_right


def test_radii_are_compared_away_from_junctions_and_tips(fork):
    t = np.linspace(0, 20, 41)
    points = np.column_stack([0 * t, 0 * t, t])
    radii = np.full(41, 1.1)
    radii[(t < 2) | (t > 18)] = 7  # the ends
    edges = np.column_stack([np.arange(40), np.arange(1, 41)])
    assert score(fork, Curve(points, edges, radii)).radius_error == pytest.approx(0.1, rel=0.01)


def test_a_thin_branch_does_not_widen_to_the_ball_it_starts_in():
    nodes = np.array([[0, 0, 0, 5], [20, 0, 0, 0.35]], float)
    truth = Truth(nodes, np.array([[0, 1]]), np.zeros((0, 3), int), 0)
    assert truth.nearest(np.array([[10.0, 0, 0]])).radius[0] == pytest.approx((0.5 + 0.35) / 2)


def test_of_a_sheet_only_distances_to_it_count(plate):
    s = score(plate, Curve(np.array([[1, 1, 0.1], [9, 9, 0.1]]), np.array([[0, 1]]), np.array([0.2, 0.3])))
    assert s.graph_is_right and s.tips_found == () and s.tips_false == 0
    assert s.to_truth * plate.size == pytest.approx(0.1)
    assert s.to_truth_radii == pytest.approx(0.5) and s.outside == 0
    assert np.isnan(s.from_truth) and np.isnan(s.radius_error)
    assert score(plate, Curve(np.array([[1, 1, 0.3], [9, 9, 0.3]]), np.array([[0, 1]]))).outside == pytest.approx(1)


def test_a_truth_is_kept_in_a_file(tmp_path, fork, plate):
    for name, truth in [("fork", fork), ("plate", plate)]:
        write_truth(tmp_path / f"{name}.npz", truth)
        again = read_truth(tmp_path / f"{name}.npz")
        assert (again.nodes == truth.nodes).all() and (again.edges == truth.edges).all()
        assert (again.triangles == truth.triangles).all() and again.cycles == truth.cycles


POLYDATA = """<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">
<PolyData><Piece NumberOfPoints="6" NumberOfLines="3" NumberOfVerts="0" NumberOfStrips="0" NumberOfPolys="0">
<PointData><DataArray type="Float64" Name="Radius" format="ascii">1 1 1 0.5 1 0.5</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 0 0 10 0 0 20 8 0 26 0 0 20 -8 0 26</DataArray></Points>
<Lines><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 2 3 4 5</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3 5 7</DataArray></Lines>
</Piece></PolyData></VTKFile>
"""


@pytest.mark.parametrize("name, text", [
    ("fork.obj", "v 0 0 0\nv 0 0 10\nv 0 0 20\nv 8 0 26\nv -8 0 26\nl 1 2 3 4\nl 3 5\n"),
    ("fork.cg", "# D:3 NV:5 NE:4\nv 0 0 0\nv 0 0 10\nv 0 0 20\nv 8 0 26\nv -8 0 26\ne 1 2\ne 2 3\ne 3 4\ne 3 5\n"),
    ("fork.swc", "# id type x y z radius parent\n1 0 0 0 0 1 -1\n2 0 0 0 10 1 1\n3 0 0 0 20 1 2\n"
                 "4 0 8 0 26 0.5 3\n5 0 -8 0 26 0.5 3\n"),
    ("fork.vtp", POLYDATA)])
def test_every_kind_of_file_says_the_same(tmp_path, name, text, fork):
    (tmp_path / name).write_text(text)
    if name.endswith(".vtp") and not (python := os.environ.get("MCFSKEL_READERS_PYTHON")):
        pytest.skip("MCFSKEL_READERS_PYTHON names no Python with VTK")
    if name.endswith(".vtp"):
        program = ("import sys, numpy\nsys.path.insert(0, sys.argv[1])\nfrom pathlib import Path\n"
                   "from curve import read_curve\nc = read_curve(Path(sys.argv[2]))\n"
                   "numpy.savez(sys.argv[3], points=c.points, edges=c.edges, radii=c.radii)\n")
        out = tmp_path / "read.npz"
        subprocess.run([python, "-c", program, str(BENCH), str(tmp_path / name), str(out)], check=True)
        with np.load(out) as data:
            curve = Curve(data["points"], data["edges"], data["radii"])
    else:
        curve = read_curve(tmp_path / name)
    curve = curve.joined()
    assert len(curve.points) == 5 and score(fork, curve).tips_found == (0, 3, 4)
    assert score(fork, curve).to_truth < 1e-9
    if name.endswith((".swc", ".vtp")):
        assert sorted(curve.radii) == [0.5, 0.5, 1, 1, 1]


def test_nodes_in_one_place_are_one():
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1e-9, 0], [2, 0, 0]])
    curve = Curve(points, np.array([[0, 1], [2, 3]])).joined()
    assert len(curve.points) == 3 and curve.components == 1
