# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""meshlabserver 2020.09, single precision, and the scripts in examples/ that are written for it."""

import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import networkx
import numpy as np
import pytest

from conftest import COLLAPSE, FULL, MESHES, POLES, RESAMPLE, STEP, components, opened
from host_programs import PREFIX, SCRIPTS, changed, obj_graph, ply_vertices

REFINE = "generate_refined_skeleton_mcf"
FILTERS = {"Resample": RESAMPLE, "Medial Poles": POLES, "Contraction Step": STEP,
           "Collapse to Curve": COLLAPSE, "Refine Skeleton": REFINE, "Full Skeletonize": FULL}


class TestScripts:
    """The examples are what the plugin has: meshlabserver stops at a script that lacks a parameter."""

    def test_there_are_scripts(self):
        assert {"full_skeletonize", "stage_by_stage"} <= SCRIPTS.keys()

    @pytest.mark.parametrize("name", SCRIPTS)
    def test_all_parameters_with_their_defaults(self, name):
        layers = opened("capsule")
        chosen = {"target_length": 0, "epsilon": 0, "steps": 500, "surface": 1}
        for element in ElementTree.parse(SCRIPTS[name]).getroot():
            written = {p.get("name"): p.get("value") for p in element}
            expected = layers.filter_parameter_values(
                FILTERS[element.get("name").removeprefix(PREFIX)])
            assert written.keys() == expected.keys(), element.get("name")
            for key, value in expected.items():
                if key in chosen:
                    assert float(written[key]) == chosen[key]
                elif isinstance(value, bool):
                    assert written[key] == str(value).lower(), key
                elif key == "pole_method":
                    choice = element.find(f"Param[@name='{key}']")
                    index = value if isinstance(value, int) else ["voronoi", "balls"].index(value)
                    assert int(written[key]) == index
                    assert choice.get(f"enum_val{index}") == ["voronoi", "balls"][index]
                else:
                    assert float(written[key]) == pytest.approx(value, rel=1e-6), key

    @pytest.mark.parametrize("name", SCRIPTS)
    def test_pymeshlab_runs_them_too(self, name, tmp_path):
        layers = opened("capsule")
        layers.load_filter_script(str(changed(name, tmp_path, target_length=0.05)))
        layers.apply_filter_script()
        curve = layers.current_mesh()
        assert curve.edge_number() == curve.vertex_number() - 1


    def test_a_missing_parameter_has_its_default(self, tmp_path):
        """A script may be older than the parameter."""
        whole = changed("full_skeletonize", tmp_path, target_length=0.05)
        tree = ElementTree.parse(whole)
        for element in tree.getroot():
            for parameter in list(element):
                if parameter.get("name") != "target_length":
                    element.remove(parameter)
        tree.write(tmp_path / "older.mlx")
        nodes = []
        for script in (whole, tmp_path / "older.mlx"):
            layers = opened("capsule")
            layers.load_filter_script(str(script))
            layers.apply_filter_script()
            nodes.append(layers.current_mesh().vertex_matrix())
        assert np.array_equal(*nodes)


@pytest.fixture(scope="module")
def full_run(server, tmp_path_factory) -> tuple[Path, str]:
    """The folder and the log of the full example on a body with three limbs."""
    folder = tmp_path_factory.mktemp("full")
    run = server(MESHES / "y_tube.off", SCRIPTS["full_skeletonize"],
                 "-o", folder / "skeleton.obj", "-l", "x",
                 "-o", folder / "skeleton.ply", "-l", "x", "-m", "vq")
    assert run.returncode == 0, run.stdout
    return folder, run.stdout


class TestFull:
    def test_skeleton_as_obj_lines(self, full_run):
        nodes, edges = obj_graph(full_run[0] / "skeleton.obj")
        assert components(len(nodes), edges) == 1 and len(edges) == len(nodes) - 1
        degree = np.bincount(edges.ravel(), minlength=len(nodes))
        assert (degree == 1).sum() == 3 and (degree == 3).sum() == 1

    def test_lies_on_the_axes_of_the_tubes(self, full_run):
        record = json.loads((MESHES / "y_tube.json").read_text())["skeleton"]
        nodes, _ = obj_graph(full_run[0] / "skeleton.obj")
        gaps = np.linalg.norm(nodes[:, None] - np.array(record["nodes"])[None], axis=2)
        assert gaps.min(axis=1).max() < 0.15 * np.min(record["radius"])

    def test_radius_as_quality(self, full_run):
        record = json.loads((MESHES / "y_tube.json").read_text())["skeleton"]
        radius = ply_vertices(full_run[0] / "skeleton.ply")["quality"]
        nodes, _ = obj_graph(full_run[0] / "skeleton.obj")
        assert len(radius) == len(nodes)
        assert np.median(radius) == pytest.approx(np.median(record["radius"]), rel=0.15)
        assert radius.min() > 0

    def test_numbers_are_in_the_log(self, full_run):
        nodes, edges = obj_graph(full_run[0] / "skeleton.obj")
        for number in [f"skeleton_vertices = {len(nodes)}", f"skeleton_edges = {len(edges)}",
                       "terminals = 3", "junctions = 1", "converged = 1"]:
            assert number in full_run[1]

    def test_stage_by_stage_is_the_same(self, server, full_run, tmp_path):
        run = server(MESHES / "y_tube.off", SCRIPTS["stage_by_stage"],
                     "-o", tmp_path / "skeleton.obj", "-l", "x",
                     "-o", tmp_path / "skeleton.ply", "-l", "x", "-m", "vq")
        assert run.returncode == 0, run.stdout
        for name in ["skeleton.obj", "skeleton.ply"]:
            assert (tmp_path / name).read_bytes() == (full_run[0] / name).read_bytes(), name


def test_single_steps_are_the_full_run_bit_for_bit(server, tmp_path):
    """Layers hold floats; the steps carry their state on in double."""
    mesh = MESHES / "animal450.off"

    def files(name: str, curve: int, stage: int) -> list[object]:
        folder = tmp_path / name
        folder.mkdir()
        return ["-o", folder / "curve.obj", "-l", curve, "-o", folder / "curve.ply", "-l", curve, "-m", "vq",
                "-o", folder / "stage.ply", "-l", stage, "-m", "vq"]

    # Layers: the input, the resampled surface, the last stage, the curve.
    full = changed("full_skeletonize", tmp_path, target_length=0.06, refine="false")
    run = server(mesh, full, *files("full", 3, 2))
    assert run.returncode == 0, run.stdout
    steps = int(re.search(r"\biterations = (\d+)", run.stdout).group(1))
    assert steps > 3
    singly = changed("stage_by_stage", tmp_path, target_length=0.06, steps=1,
                     repeat={"Contraction Step": steps, "Refine Skeleton": 0})
    run = server(mesh, singly, *files("singly", 2 + steps, 1 + steps))
    assert run.returncode == 0, run.stdout
    for name in ["curve.obj", "curve.ply", "stage.ply"]:
        assert (tmp_path / "singly" / name).read_bytes() == (
            tmp_path / "full" / name).read_bytes(), name


class TestFailures:
    def test_flat_mesh(self, server, tmp_path):
        lines = (MESHES / "box8.off").read_text().rstrip("\n").split("\n")
        for i in range(2, 2 + int(lines[1].split()[0])):
            lines[i] = " ".join(lines[i].split()[:2] + ["0"])
        (tmp_path / "flat.off").write_text("\n".join(lines) + "\n")
        run = server(tmp_path / "flat.off", SCRIPTS["full_skeletonize"],
                     "-o", tmp_path / "skeleton.obj", "-l", "x")
        assert run.returncode not in (0, 134, 139)
        assert "the mesh is flat" in run.stdout and "Remove Isolated" not in run.stdout
        assert not (tmp_path / "skeleton.obj").exists()

    def test_parameter_out_of_range(self, server, tmp_path):
        run = server(MESHES / "capsule.off", changed("full_skeletonize", tmp_path, w_l=-1),
                     "-o", tmp_path / "skeleton.obj", "-l", "x")
        assert run.returncode not in (0, 134, 139)
        assert "w_l" in run.stdout

    def test_collapse_of_what_is_no_stage(self, server, tmp_path):
        script = changed("stage_by_stage", tmp_path, repeat={
            "Resample": 0, "Medial Poles": 0, "Contraction Step": 0, "Refine Skeleton": 0})
        run = server(MESHES / "capsule.off", script, "-o", tmp_path / "skeleton.obj", "-l", "x")
        assert run.returncode not in (0, 134, 139)
        assert "not a stage" in run.stdout


@pytest.fixture(scope="module")
def ring(server, tmp_path_factory) -> Path:
    """A torus's skeleton in all formats that the server writes."""
    folder = tmp_path_factory.mktemp("ring")
    outputs = [part for kind in ["obj", "swc", "cg", "graphml"]
               for part in ["-o", folder / f"ring.{kind}", "-l", "x"]]
    run = server(MESHES / "torus.off",
                 changed("full_skeletonize", folder, target_length=0.06), *outputs)
    assert run.returncode == 0, run.stdout
    return folder


class TestFormats:
    """The formats of skeletons in meshlabserver's own reading and writing."""

    def test_written(self, ring):
        nodes, edges = obj_graph(ring / "ring.obj")
        assert len(nodes) == len(edges)
        in_cg, edges_in_cg = obj_graph(ring / "ring.cg", line="e")
        assert in_cg == pytest.approx(nodes, abs=1e-5)
        assert {frozenset(e) for e in edges_in_cg.tolist()} == {frozenset(e) for e in edges.tolist()}
        graph = networkx.read_graphml(ring / "ring.graphml", node_type=int)
        assert len(networkx.cycle_basis(graph)) == 1
        assert sum(map(len, (d["surface_vertices"] or "" for _, d in graph.nodes(data=True)))) > 0
        rows = np.loadtxt(ring / "ring.swc")
        assert "# cycle cut" in (ring / "ring.swc").read_text()
        assert (rows[:, 6] < rows[:, 0]).all() and (rows[:, 6] == -1).sum() == 1
        assert len(rows) == len(nodes) and (rows[:, 5] > 0).all()

    @pytest.mark.parametrize("kind, lost", [("cg", 0), ("swc", 1)])
    def test_read(self, server, ring, tmp_path, kind, lost):
        script = tmp_path / "nothing.mlx"
        script.write_text("<!DOCTYPE FilterScript>\n<FilterScript/>\n")
        run = server(ring / f"ring.{kind}", script, "-o", tmp_path / "again.cg", "-l", "c")
        assert run.returncode == 0, run.stdout
        nodes, edges = obj_graph(ring / "ring.cg", line="e")
        again, kept = obj_graph(tmp_path / "again.cg", line="e")
        assert {tuple(p) for p in again} == {tuple(p) for p in nodes}
        assert len(kept) == len(edges) - lost

    def test_malformed(self, server, tmp_path):
        (tmp_path / "bad.swc").write_text("1 0 0 0 0 1 -1\n2 0 x 0 0 1 1\n")
        script = tmp_path / "nothing.mlx"
        script.write_text("<!DOCTYPE FilterScript>\n<FilterScript/>\n")
        run = server(tmp_path / "bad.swc", script, "-o", tmp_path / "again.cg", "-l", "c")
        assert "Line 2" in run.stdout
        assert not (tmp_path / "again.cg").exists()
