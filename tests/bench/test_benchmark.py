# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's surfaces and how it runs programs; what it makes of skeletons is in test_truth.py."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "scripts" / "bench"
sys.path.insert(0, str(BENCH))
pytest.importorskip("manifold3d")

import benchmark_options  # noqa: E402
import surfaces  # noqa: E402
from contenders import another, make_skeleton  # noqa: E402
from truth import read_truth  # noqa: E402

# Writes the truth as its skeleton, and counts how often it was asked.
PROGRAM = """import sys
from pathlib import Path
import numpy as np
mesh, skeleton = sys.argv[1:3]
with open(Path(__file__).with_suffix(".calls"), "a") as calls:
    calls.write(mesh + "\\n")
data = np.load(Path(mesh).with_suffix(".npz"))
lines = ["v %.17g %.17g %.17g" % tuple(p[:3]) for p in data["nodes"]]
lines += ["l %d %d" % (a + 1, b + 1) for a, b in data["edges"]]
Path(skeleton).write_text("\\n".join(lines))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The tubes and the plates."""
    place = tmp_path_factory.mktemp("benchmark")
    surfaces.generate(place, [], ["tube", "plate"])
    return place


def test_there_are_enough_shapes_and_the_two_parts_share_none():
    assert set(surfaces.SEEDS) == set(benchmark_options.FAMILIES)
    shapes = {part: {(f, s) for f, seeds in surfaces.SEEDS.items() for s in seeds[part]} for part in surfaces.PARTS}
    assert not shapes["tune"] & shapes["check"]
    # Five kinds of surface are there for every shape: three densities, noise, and a copy elsewhere.
    assert 5 * sum(len(s) for s in shapes.values()) >= 200


def test_each_surface_is_a_closed_body_around_its_truth(folder):
    entries = surfaces.read_set(folder)
    assert {e.variant for e in entries} >= {"coarse", "made", "fine", "decimated", "noisy", "moved"}
    for entry in entries:
        mesh = trimesh.load(folder / f"{entry.name}.off", process=False)
        truth = read_truth(folder / f"{entry.name}.npz")
        assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0, entry.name
        assert mesh.body_count == 1 and mesh.euler_number == 2 - 2 * truth.cycles, entry.name
        # Its vertices are on the balls: but for facets, noise and what decimation may do.
        near = truth.nearest(np.asarray(mesh.vertices))
        off = np.abs(near.distance / near.radius - 1)
        if truth.is_sheet:
            off = off[near.distance > 0.99 * near.radius]  # the rims have no balls of their own
        assert np.median(off) < 0.1, entry.name


def test_a_set_is_the_same_each_time(folder, tmp_path):
    surfaces.generate(tmp_path, [], ["tube"])
    for file in sorted(tmp_path.glob("tube_*.off")):
        assert file.read_bytes() == (folder / file.name).read_bytes()


def test_surfaces_of_another_generator_do_not_count(folder, tmp_path):
    record = json.loads((folder / surfaces.LIST).read_text())
    (tmp_path / surfaces.LIST).write_text(json.dumps(record | {"version": "another"}))
    assert surfaces.read_set(folder) and not surfaces.read_set(tmp_path)


def test_a_perfect_program_has_a_perfect_score(folder, tmp_path):
    program = tmp_path / "perfect.py"
    program.write_text(PROGRAM)
    command = [sys.executable, str(BENCH / "benchmark.py"), "--families", "tube", "--programs", "--program",
               f"perfect={sys.executable} {program} {{mesh}} {{skeleton}}.obj", "--folder", str(folder),
               "--csv", str(tmp_path / "figures.csv")]
    for _ in range(2):
        run = subprocess.run(command, capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
    rows = [line.split("|")[1:-1] for line in run.stdout.splitlines() if "perfect" in line]
    assert len(rows) == 2  # one for each part
    for row in rows:
        name, count, failed, graph, tips, false = (cell.strip() for cell in row[:6])
        assert (name, failed, graph, tips, false) == ("perfect", "0", "100", "100.0", "0.00")
        assert row[6].strip() == "0.000 (0.000)" and row[12].strip() == "100"
    calls = program.with_suffix(".calls").read_text().splitlines()
    assert len(calls) == len(set(calls)) == len([e for e in surfaces.read_set(folder) if e.family == "tube"])
    assert len((tmp_path / "figures.csv").read_text().splitlines()) == len(calls) + 1


def test_what_a_program_does_wrong_is_said(folder, tmp_path):
    mesh = folder / "tube_1_made.off"
    for name, words, error in [
            ("nothing", "true {mesh} {skeleton}.obj", "no skeleton"),
            ("missing", "no-such-program {mesh} {skeleton}.obj", "no-such-program"),
            ("fails", "sh -c 'echo why >&2; exit 3' {mesh} {skeleton}.obj", "why"),
            ("slow", "sh -c 'sleep 30; :' {mesh} {skeleton}.obj", "more than 0.2 s")]:
        made = make_skeleton(another(name, words), mesh, tmp_path / name, 0.2)
        assert made.file is None and error in made.error


def test_a_changed_program_and_a_longer_timeout_run_again(folder, tmp_path):
    mesh, program = folder / "tube_1_made.off", tmp_path / "program.py"
    program.write_text(PROGRAM)
    contender = another("one", f"{sys.executable} {program} {{mesh}} {{skeleton}}.obj")
    calls = program.with_suffix(".calls")
    for count, text in [(1, PROGRAM), (1, PROGRAM), (2, PROGRAM + "# changed\n")]:
        program.write_text(text)
        assert make_skeleton(contender, mesh, tmp_path / "made", 60).file is not None
        assert len(calls.read_text().splitlines()) == count
    program.write_text("import time\ntime.sleep(1)\n" + PROGRAM)
    assert make_skeleton(contender, mesh, tmp_path / "made", 0.1).file is None
    assert make_skeleton(contender, mesh, tmp_path / "made", 0.1).file is None
    assert make_skeleton(contender, mesh, tmp_path / "made", 60).file is not None
    assert len(calls.read_text().splitlines()) == 3


@pytest.mark.parametrize("words", [
    ("--program", "mine"), ("--program", "mine=run {mesh}"), ("--program", "cgal=run {mesh} {skeleton}.obj"),
    ("--results", "mine=nowhere"), ("--families", "cubes"), ("--csv", "nowhere/figures.csv")])
def test_wrong_use(words):
    run = subprocess.run([sys.executable, str(BENCH / "benchmark_options.py"), *words], capture_output=True, text=True)
    assert run.returncode == 2 and "usage:" in run.stderr
