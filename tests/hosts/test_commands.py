# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/skeletonize.sh: the files it writes, what is in them, and how it fails; --help of all commands."""

import os
import pty
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pymeshlab
import pytest
import trimesh
from plyfile import PlyData

from conftest import MESHES, ROOT, arrays, components, distances_from_edges, document, euler
from hostile.primitives import box

sys.path.insert(0, str(ROOT / "scripts"))
from ply_files import read_skeleton, read_surface  # noqa: E402

SCRIPT = ROOT / "scripts" / "skeletonize.sh"


def skeletonize(*arguments: object, folder: Path | None = None) -> subprocess.CompletedProcess:
    return subprocess.run([str(SCRIPT), *map(str, arguments)], capture_output=True, text=True,
                          cwd=folder, timeout=1800)


@pytest.fixture(scope="module")
def torus(tmp_path_factory) -> tuple[Path, subprocess.CompletedProcess]:
    """The folder and the output of one run that writes all there is."""
    folder = tmp_path_factory.mktemp("torus")
    run = skeletonize(MESHES / "torus.off", folder / "results", "--target-length", "1.2%",
                      "--keep-stages", 4, "--formats", "ply", "obj", "json", "glb", folder=folder)
    assert run.returncode == 0, run.stderr
    return folder / "results", run


class TestResults:
    def test_files(self, torus):
        folder, run = torus
        names = {path.name for path in folder.iterdir()}
        assert {"torus_skeleton.ply", "torus_skeleton.obj", "torus_skeleton.json",
                "torus_skeleton.glb", "torus_surface.ply", "torus_meso_4.ply",
                "torus.png"} <= names
        assert not [name for name in names if name.endswith(".part")]
        for name in names:
            assert name in run.stdout

    def test_summary_counts(self, torus):
        folder, run = torus
        nodes, edges, _ = read_skeleton(folder / "torus_skeleton.ply")
        assert f"{len(nodes)} nodes, 1 branches, 0 tips, 0 junctions" in run.stdout
        assert "1 components, 1 cycles" in run.stdout
        assert "converged after" in run.stdout

    def test_skeleton(self, torus):
        nodes, edges, radius = read_skeleton(torus[0] / "torus_skeleton.ply")
        assert components(len(nodes), edges) == 1
        assert len(edges) == len(nodes)  # one cycle
        assert (radius > 0).all()
        quality = PlyData.read(str(torus[0] / "torus_skeleton.ply"))["vertex"]["quality"]
        assert np.array_equal(quality, radius.astype(np.float32))

    def test_obj_is_the_same_graph(self, torus):
        nodes, edges, _ = read_skeleton(torus[0] / "torus_skeleton.ply")
        lines = [line.split() for line in (torus[0] / "torus_skeleton.obj").read_text().splitlines()]
        vertices = np.array([line[1:] for line in lines if line[0] == "v"], float)
        pairs = np.array([line[1:] for line in lines if line[0] == "l"], int) - 1
        assert np.array_equal(vertices, nodes) and np.array_equal(pairs, edges)

    def test_surface_with_its_correspondence(self, torus):
        nodes, edges, radius = read_skeleton(torus[0] / "torus_skeleton.ply")
        vertices, faces = read_surface(torus[0] / "torus_surface.ply")
        assert faces.max() == len(vertices) - 1
        vertex = PlyData.read(str(torus[0] / "torus_surface.ply"))["vertex"]
        node = np.asarray(vertex["mcfskel_node"])
        assert np.issubdtype(node.dtype, np.integer)
        distance = distances_from_edges(vertices, node, nodes, edges)
        count = np.bincount(node, minlength=len(nodes))
        mean = np.bincount(node, distance, len(nodes)) / np.maximum(count, 1)
        reached = count > 0
        assert mean[reached] == pytest.approx(radius[reached], rel=1e-5)
        pole = np.column_stack([vertex[f"mcfskel_pole_{axis}"] for axis in "xyz"])
        has = vertex["mcfskel_pole_radius"] >= 0
        assert np.linalg.norm(pole - vertices, axis=1)[has] == pytest.approx(
            vertex["mcfskel_pole_radius"][has])

    def test_stages(self, torus):
        vertices, faces = read_surface(torus[0] / "torus_meso_4.ply")
        assert len(faces) == 2 * len(vertices)  # Euler characteristic 0
        fixed = PlyData.read(str(torus[0] / "torus_meso_4.ply"))["vertex"]["mcfskel_fixed"]
        assert np.isin(fixed, [0, 1]).all()

    def test_picture_shows_the_surface_and_the_skeleton(self, torus):
        import matplotlib.image
        picture = matplotlib.image.imread(torus[0] / "torus.png")[..., :3]
        assert min(picture.shape[:2]) > 200
        saturation = picture.max(axis=2) - picture.min(axis=2)
        assert 0.1 < (picture.min(axis=2) < 0.97).mean() < 0.95  # the surface, not all of it
        assert 0.002 < (saturation > 0.4).mean() < 0.2  # the skeleton and its colour bar

    def test_no_progress_bar_in_a_file(self, torus):
        assert "%" not in torus[1].stderr
        assert "Contracting" not in torus[1].stdout


def test_a_built_plugin_is_not_built_again(plugin, tmp_path):
    """Whoever is using it meanwhile would meet half a file."""
    before = plugin.stat().st_mtime_ns
    run = skeletonize(MESHES / "capsule.off", tmp_path, "--no-picture", "--target-length", "2%")
    assert run.returncode == 0, run.stderr
    assert plugin.stat().st_mtime_ns == before


class TestFilesThatAreThere:
    QUICK = ("--no-resample", "--no-picture")

    def test_another_mesh_of_the_same_name_gets_names_of_its_own(self, tmp_path):
        """y.stl and y.ply, into one folder: neither replaces the other's skeleton."""
        vertices, faces = arrays("box8")
        for ending, size in [("obj", 1), ("ply", 2)]:
            layers = document((size * vertices, faces))
            layers.save_current_mesh(str(tmp_path / f"y.{ending}"))
            run = skeletonize(tmp_path / f"y.{ending}", tmp_path / "out", "--no-picture", "--target-length", "3%")
            assert run.returncode == 0, run.stderr
        out = tmp_path / "out"
        assert sorted(path.name for path in out.iterdir()) == [
            "y_ply_skeleton.ply", "y_ply_surface.ply", "y_skeleton.ply", "y_surface.ply"]
        assert f"{out / 'y_skeleton.ply'} is of y.obj: the files of y.ply begin with y_ply" in run.stderr
        assert "replaced" not in run.stdout
        small, large = (read_skeleton(out / f"{name}_skeleton.ply")[0] for name in ["y", "y_ply"])
        assert np.ptp(large, axis=0).max() > 1.5 * np.ptp(small, axis=0).max()

    def test_what_is_replaced_is_said(self, tmp_path):
        for verb in ["wrote", "replaced"]:
            run = skeletonize(MESHES / "capsule.off", tmp_path, *self.QUICK)
            assert run.returncode == 0, run.stderr
            for ending in ["skeleton", "surface"]:
                assert f"{verb} {tmp_path}/capsule_{ending}.ply" in run.stdout

    @pytest.mark.parametrize("name", ["größe.off", "a b.off", "字" * 80 + ".off"])
    def test_names_of_all_kinds(self, name, tmp_path):
        (tmp_path / name).write_bytes((MESHES / "capsule.off").read_bytes())
        for _ in range(2):
            run = skeletonize(tmp_path / name, tmp_path, *self.QUICK)
            assert run.returncode == 0 and not run.stderr, run.stderr
        skeleton = tmp_path / name.replace(".off", "_skeleton.ply")
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(str(skeleton))
        assert layers.current_mesh().vertex_number() == len(read_skeleton(skeleton)[0])

    @pytest.mark.parametrize("kind", ["mesh", "skeleton"])
    def test_links_to_other_names(self, kind, tmp_path):
        """The format is that of the link, as in a store of files that are named by their content."""
        link = tmp_path / {"mesh": "y.off", "skeleton": "y_skeleton.json"}[kind]
        (tmp_path / "3fa9").write_bytes((MESHES / "capsule.off").read_bytes() if kind == "mesh" else b"")
        (tmp_path / "y.off").write_bytes((MESHES / "capsule.off").read_bytes())
        link.unlink(missing_ok=True)
        link.symlink_to("3fa9")
        run = skeletonize(tmp_path / "y.off", tmp_path, *self.QUICK, "--formats", "json")
        assert run.returncode == 0, run.stderr
        assert link.is_symlink() and (tmp_path / "y_skeleton.json").read_text().startswith("{")


class TestSurface:
    @pytest.mark.parametrize("name, closed", [("open", False), ("open_resampled", False), ("sound", True)])
    def test_without_resampling(self, name, closed, tmp_path):
        """The solid that a mesh was made into, whatever its name; else the mesh as it is."""
        vertices, faces = arrays("capsule")
        document((vertices, faces if closed else faces[1:])).save_current_mesh(str(tmp_path / f"{name}.off"))
        run = skeletonize(tmp_path / f"{name}.off", tmp_path, "--no-resample", "--no-picture", "--formats", "glb")
        assert run.returncode == 0, run.stderr
        layers = document(read_surface(tmp_path / f"{name}_surface.ply"))
        solid = layers.current_mesh()
        assert euler(solid) == 2 and solid.face_number() == len(faces)
        node = PlyData.read(str(tmp_path / f"{name}_surface.ply"))["vertex"]["mcfskel_node"]
        assert (np.asarray(node) >= 0).all()
        skin = trimesh.load(tmp_path / f"{name}_skeleton.glb", process=False, force="mesh")
        assert len(skin.vertices) == solid.vertex_number()

    @pytest.mark.parametrize("x", [10, -10])
    def test_is_where_a_node_of_a_scene_puts_it(self, x, tmp_path):
        """Mirrored, too: it still faces outward."""
        place = np.diag([x, 10, 10, 1.0])
        place[:3, 3] = [100, 0, 0]
        mesh = trimesh.load(MESHES / "capsule.off", process=False)
        scene = trimesh.Scene()
        scene.add_geometry(mesh, transform=place)
        scene.export(str(tmp_path / "placed.glb"))
        run = skeletonize(tmp_path / "placed.glb", tmp_path, "--no-resample", "--no-picture", "--repair", "off")
        assert run.returncode == 0, run.stderr
        vertices, _ = read_surface(tmp_path / "placed_surface.ply")
        there = np.sort(trimesh.transform_points(mesh.bounds, place), axis=0)
        assert np.allclose([vertices.min(axis=0), vertices.max(axis=0)], there, atol=1e-3)
        nodes = read_skeleton(tmp_path / "placed_skeleton.ply")[0]
        assert ((nodes > there[0]) & (nodes < there[1])).all()


class TestOptions:
    def test_without_resampling_the_surface_is_the_input(self, tmp_path):
        run = skeletonize(MESHES / "capsule.off", tmp_path, "--no-resample", "--no-picture")
        assert run.returncode == 0, run.stderr
        assert sorted(path.name for path in tmp_path.iterdir()) == [
            "capsule_skeleton.ply", "capsule_surface.ply"]
        vertices, _ = read_surface(tmp_path / "capsule_surface.ply")
        text = (MESHES / "capsule.off").read_text().split("\n")
        assert len(vertices) == int(text[1].split()[0])

    def test_help(self):
        run = skeletonize("--help")
        assert run.returncode == 0
        for option in ["--w-l", "--epsilon", "--no-resample", "--keep-stages", "--formats",
                       "--no-picture"]:
            assert option in run.stdout


@pytest.mark.parametrize("command", sorted((ROOT / "scripts").glob("*.sh")), ids=lambda path: path.name)
def test_help_is_answered_before_anything_is_prepared(command, tmp_path):
    run = subprocess.run([str(command), "--help"], capture_output=True, text=True, timeout=60,
                         env=os.environ | {"MCFSKEL_CACHE": str(tmp_path / "cache")})
    assert run.returncode == 0 and f"usage: scripts/{command.name}" in run.stdout
    assert not run.stderr and not (tmp_path / "cache").exists()


def test_help_of_the_bench_names_every_study():
    studies = (ROOT / "scripts" / "bench" / "studies.py").read_text()
    names = re.findall(r'"([a-z ]+)": \w+[,}]', studies[studies.index("STUDIES = {"):])
    run = subprocess.run([str(ROOT / "scripts" / "bench.sh"), "--help"], capture_output=True, text=True)
    assert len(names) >= 8
    text = " ".join(run.stdout.split())
    assert "all studies, or " + ", ".join(name.replace(" ", "-") for name in names) in text


def test_progress_goes_to_the_terminal_and_results_to_the_output(tmp_path):
    ours, terminal = pty.openpty()
    run = subprocess.Popen([str(SCRIPT), str(MESHES / "box8.off"), str(tmp_path / "out"), "--no-picture"],
                           stdout=subprocess.PIPE, stderr=terminal, text=True)
    os.close(terminal)
    shown = b""
    while True:
        try:
            shown += os.read(ours, 4096)
        except OSError:  # the other end was closed
            break
    output, _ = run.communicate(timeout=600)
    os.close(ours)
    assert run.returncode == 0, shown
    assert b" % " in shown
    assert "skeleton:" in output and "%" not in output


def test_ctrl_c_ends_a_run(tmp_path):
    ours, terminal = pty.openpty()
    run = subprocess.Popen([str(SCRIPT), str(MESHES / "animal.off"), str(tmp_path / "out"), "--target-length",
                            "0.25%"], stdout=terminal, stderr=terminal)
    os.close(terminal)
    shown, sent = b"", 0.0
    while True:
        try:
            shown += os.read(ours, 4096)
        except OSError:  # the other end was closed
            break
        if not sent and re.search(rb"\b[1-9]\d? % ", shown):
            run.send_signal(signal.SIGINT)
            sent = time.monotonic()
    assert run.wait(timeout=60) == 130 and time.monotonic() - sent < 5
    os.close(ours)
    assert shown.strip().endswith(b"interrupted") and b"Traceback" not in shown
    assert not (tmp_path / "out").exists()


class TestFailures:
    def test_open_mesh(self, tmp_path):
        text = (MESHES / "box8.off").read_text().rstrip("\n").split("\n")
        counts = text[1].split()
        counts[1] = str(int(counts[1]) - 1)
        text[1] = " ".join(counts)
        (tmp_path / "open.off").write_text("\n".join(text[:-1]) + "\n")
        run = skeletonize(tmp_path / "open.off", tmp_path / "out", "--repair", "off")
        assert run.returncode == 1
        lines = run.stderr.strip().splitlines()
        assert lines[-1].startswith("error:") and "Close Holes" in lines[-1]
        assert "Traceback" not in run.stderr
        assert not (tmp_path / "out").exists()

    def test_no_such_file(self, tmp_path):
        run = skeletonize(tmp_path / "nothing.off", tmp_path / "out")
        assert run.returncode == 1
        assert "there is no file" in run.stderr.strip().splitlines()[-1]

    def test_not_a_mesh(self, tmp_path):
        (tmp_path / "text.off").write_text("this is no mesh\n")
        run = skeletonize(tmp_path / "text.off", tmp_path / "out")
        assert run.returncode == 1 and "Traceback" not in run.stderr

    @pytest.mark.parametrize("option", [("--epsilon", "much"), ("--keep-stages", "0"), ("--nonsense",),
                                        ("--epsilon", "150%"), ("--target-length", "150%"),
                                        ("--max-iterations", "99999999999")])
    def test_bad_option(self, tmp_path, option):
        run = skeletonize(MESHES / "capsule.off", tmp_path / "out", *option)
        assert run.returncode == 2 and "usage:" in run.stderr and "Traceback" not in run.stderr
        assert option[0] in run.stderr.splitlines()[-1]
        assert not (tmp_path / "out").exists()

    def test_mistakes_are_told_before_anything_is_built(self, tmp_path):
        environment = os.environ | {"MCFSKEL_CACHE": str(tmp_path / "cache")}
        for arguments, code in [((MESHES / "capsule.off", "out", "--epsilon", "150%"), 2),
                                ((tmp_path / "nothing.off", "out"), 1)]:
            run = subprocess.run([str(SCRIPT), *map(str, arguments)], capture_output=True, text=True,
                                 env=environment, timeout=60)
            assert run.returncode == code and "==" not in run.stderr
        assert not (tmp_path / "cache").exists()

    def test_parameter_out_of_range(self, tmp_path):
        run = skeletonize(MESHES / "capsule.off", tmp_path, "--w-l", "-1")
        assert run.returncode == 1
        assert "w_l" in run.stderr.strip().splitlines()[-1]

    def test_a_name_that_ends_otherwise(self, tmp_path):
        (tmp_path / "mesh").write_text((MESHES / "box8.off").read_text())
        run = skeletonize(tmp_path / "mesh", tmp_path / "out")
        assert run.returncode == 1 and ".off, .ply" in run.stderr.strip().splitlines()[-1]

    def test_a_folder_is_no_mesh(self, tmp_path):
        run = skeletonize(tmp_path, tmp_path / "out")
        assert run.returncode == 1 and "is a folder" in run.stderr.strip().splitlines()[-1]

    def test_folder_that_cannot_be_written(self, tmp_path):
        (tmp_path / "taken").write_text("")
        run = skeletonize(MESHES / "capsule.off", tmp_path / "taken", "--no-picture",
                          "--target-length", "2%")
        assert run.returncode == 1 and "Traceback" not in run.stderr
        assert f"nothing can be written into '{tmp_path / 'taken'}'" in run.stderr

    def test_folder_that_cannot_be_made(self, tmp_path):
        folder = "/proc/nothing"  # for root, too
        run = skeletonize(MESHES / "capsule.off", folder)
        assert run.returncode == 1 and f"nothing can be written into '{folder}'" in run.stderr


def test_a_curve_that_is_not_refined_is_told(tmp_path):
    """A needle thinner than its coordinates tell; the command says it without --verbose."""
    vertices, faces = box((1, 1e-8, 1e-8))
    layers = document((vertices, faces))
    layers.save_current_mesh(str(tmp_path / "needle.off"))
    run = skeletonize(tmp_path / "needle.off", tmp_path, "--no-resample", "--no-picture")
    assert run.returncode == 0, run.stderr
    assert "1 of 1 components are not refined" in run.stderr
    run = skeletonize(MESHES / "capsule.off", tmp_path, "--no-resample", "--no-picture")
    assert run.returncode == 0 and not run.stderr
