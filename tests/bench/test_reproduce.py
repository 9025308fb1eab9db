# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/reproduce.sh stands on: results that are kept, sizes, distances, pictures."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "scripts" / "bench")]
pytest.importorskip("igl")

import reproduce  # noqa: E402
from curve import Curve  # noqa: E402
from paper_figures import Panel, draw_rows  # noqa: E402


def test_what_is_kept_is_not_made_again(tmp_path: Path):
    source = tmp_path / "program"
    source.write_text("one")
    made = []

    def make(path: Path) -> dict:
        made.append(path)
        return {"answer": 42}

    for _ in range(2):
        work = reproduce.Work(source, tmp_path / "kept", 2)
        assert work.kept("job", ("a",), source, make)["answer"] == 42
    assert len(made) == 1
    work.kept("job", ("b",), source, make)
    source.write_text("two")
    work.kept("job", ("a",), source, make)
    assert len(made) == 3


def test_what_is_judged_is_judged_again_when_a_judge_changes(tmp_path: Path):
    files = (tmp_path / "one.py", tmp_path / "two.py")
    made = []
    for text in ("", "", "changed"):
        for file in files:
            file.write_text("")
        files[1].write_text(text)
        reproduce.Work(files[0], tmp_path / "kept", 1).kept("job", (), files, lambda path: made.append(path) or {})
    assert len(made) == 2
    assert {file.name for file in reproduce.JUDGES} >= {"reproduce.py", "quality.py", "curve.py"}


def test_lengths_are_of_each_component(tmp_path: Path):
    one = trimesh.creation.icosphere(3)
    other = one.copy()
    other.apply_translation([10, 0, 0])
    one.export(tmp_path / "one.ply")
    trimesh.util.concatenate([one, other]).export(tmp_path / "two.ply")
    lone = float(reproduce.percent_for(tmp_path / "one.ply", 1000))
    assert float(reproduce.percent_for(tmp_path / "two.ply", 2000)) == pytest.approx(lone, rel=0.01)


def test_a_curve_on_the_axis_is_at_no_distance(tmp_path: Path):
    trimesh.creation.capsule(height=4.0, radius=0.5, count=[24, 24]).export(tmp_path / "capsule.ply")
    reference = reproduce.Reference(tmp_path / "capsule.ply", 3000)
    low, high = reference.shape.origin, reference.shape.origin + [1.0, 1.0, 5.0]
    ends = np.array([[(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, z] for z in (low[2] + 0.5, high[2] - 0.5)])
    found = reference.distances(Curve(ends, np.array([[0, 1]])))
    aside = reference.distances(Curve(ends + [0.2, 0, 0], np.array([[0, 1]])))
    assert found["there"] < 0.002
    assert aside["there"] == pytest.approx(0.2 / reference.shape.diagonal, rel=0.1)
    assert found["inside"] == pytest.approx(1.0)


def test_rows_of_pictures(tmp_path: Path):
    ball = trimesh.creation.icosphere(2)
    mesh = (np.asarray(ball.vertices), np.asarray(ball.faces))
    curve = (np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1], [0, 2], [0, 3]]))
    draw_rows(tmp_path / "rows.png", [
        (mesh[0], [Panel("a", mesh, curves=[curve]), Panel("b", opaque=[reproduce.coloured(mesh, np.ones(3))])], {}),
        (mesh[0], [Panel("c", mesh, points=mesh[0])], {"tilt": 80})])
    from PIL import Image
    picture = np.asarray(Image.open(tmp_path / "rows.png").convert("RGB"), int)
    assert picture.shape[0] > 2 * 300 and picture.shape[1] > 2 * 300
    red = picture[..., 0] > picture[..., 1] + 40
    assert red[: picture.shape[0] // 2].any() and not red[picture.shape[0] // 2:].any()


@pytest.mark.parametrize("name", list(reproduce.THIN))
def test_thin_shapes_bound_the_solids_that_they_say(name: str):
    shape = reproduce.THIN[name]()
    mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0
    b0, b1, b2 = shape.betti
    assert mesh.euler_number == 2 * (b0 - b1 + b2)
    assert len(trimesh.graph.connected_components(mesh.face_adjacency)) == 1


@pytest.mark.parametrize("percent", [1.0, 0.1])
def test_a_plate_is_as_thick_as_it_says(percent: float):
    shape = reproduce.THIN[f"plate {1 if percent == 1 else percent} %"]()
    assert np.ptp(shape.vertices[:, 2]) == pytest.approx(percent / 100 * np.sqrt(2))
