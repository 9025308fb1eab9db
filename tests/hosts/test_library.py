# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The library in somebody else's program: installed without the plugin, found by CMake, or dropped in."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab
import pytest

from conftest import FULL, MESHES, ROOT, failing, opened
from host_programs import ply_vertices

COMMAND_LINE = """
cmake_minimum_required(VERSION 3.18)
project(command_line LANGUAGES CXX)
find_package(mcfskel 0.1 REQUIRED)
add_executable(mcfskel_cli "{source}" "${{VCG_INCLUDE_DIR}}/wrap/ply/plylib.cpp")
target_link_libraries(mcfskel_cli PRIVATE mcfskel::mcfskel)
"""


def run(*command: str | Path, status: int = 0) -> str:
    """What a command writes; fails unless it ends with that status."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          timeout=1800)
    assert done.returncode == status, done.stdout[-4000:] + done.stderr[-4000:]
    return done.stdout + done.stderr


def vcglib() -> Path:
    """The folder of VCG's headers: of the build that the plugin under test comes from."""
    if path := os.environ.get("MCFSKEL_VCG"):
        return Path(path)
    cache = (ROOT / "build/pymeshlab/CMakeCache.txt").read_text()
    return Path(re.search(r"^VCG_INCLUDE_DIR:PATH=(.*)$", cache, re.MULTILINE)[1])


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """A prefix with the library, from a build that knows of no MeshLab."""
    folder = tmp_path_factory.mktemp("library")
    build, prefix = folder / "build", folder / "prefix"
    run("cmake", "-S", ROOT, "-B", build, "-DMCFSKEL_PLUGIN=OFF", f"-DVCG_INCLUDE_DIR={vcglib()}",
        "-DCMAKE_DISABLE_FIND_PACKAGE_Qt5=ON")
    run("cmake", "--build", build)
    run("cmake", "--install", build, "--prefix", prefix)
    return prefix


@pytest.fixture(scope="module")
def examples(installed: Path, tmp_path_factory) -> Path:
    """The folder of the sample programs, built in a folder of their own."""
    folder = tmp_path_factory.mktemp("examples")
    shutil.copytree(ROOT / "examples/cpp", folder / "source")
    run("cmake", "-S", folder / "source", "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={installed}",
        "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    run("cmake", "--build", folder / "build")
    return folder / "build"


@pytest.fixture(scope="module")
def command_line(installed: Path, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("command_line")
    source = ROOT / "tests/bench/mcfskel_cli.cpp"
    (folder / "CMakeLists.txt").write_text(COMMAND_LINE.format(source=source))
    run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={installed}",
        "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", folder / "build")
    return folder / "build/mcfskel_cli"


Skeleton = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def by_plugin(name: str, **parameters: Any) -> Skeleton:
    """Nodes, edges, radii and faces that a user of pymeshlab gets."""
    layers = opened(name)
    layers.apply_filter(FULL, **parameters)
    mesh = layers.current_mesh()
    return (mesh.vertex_matrix(), mesh.edge_matrix(),
            mesh.vertex_custom_scalar_attribute_array("mcfskel_radius"), mesh.face_matrix())


def numbers(text: str, letter: str) -> np.ndarray:
    """The numbers of the lines of an OBJ file that begin with a letter."""
    return np.array([[float(word) for word in line.replace("#", " ").split()[1:]]
                     for line in text.splitlines() if line.startswith(letter + " ")])


def corners(text: str, letter: str) -> set[tuple[int, ...]]:
    """The edges or faces of an OBJ file, counted from 0."""
    return {tuple(sorted(map(int, row - 1))) for row in numbers(text, letter)}


def rows(matrix: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(sorted(map(int, row))) for row in matrix}


class TestSameBits:
    """Plugin, library and command line: one pipeline."""

    @pytest.mark.parametrize("name", ["animal450", "letter_p", "torus_capsule", "tree"])
    def test_arrays(self, name, examples):
        nodes, edges, radius, _ = by_plugin(name)
        text = run(examples / "skeletonize_arrays", MESHES / f"{name}.off")
        lines = numbers(text, "v")
        assert np.array_equal(lines[:, :3], nodes) and np.array_equal(lines[:, 3], radius)
        assert corners(text, "l") == rows(edges)

    @pytest.mark.parametrize("name", ["letter_p", "torus_capsule"])
    def test_float_mesh_of_vcg(self, name, examples, tmp_path):
        nodes, edges, radius, _ = by_plugin(name)
        said = run(examples / "skeletonize_mesh", MESHES / f"{name}.off", tmp_path / "curve.ply")
        assert f"{len(nodes)} nodes, {len(edges)} edges" in said and "Resampled to" in said
        vertex = ply_vertices(tmp_path / "curve.ply")
        held = np.column_stack([vertex[axis] for axis in "xyz"])
        assert np.array_equal(held, nodes.astype(np.float32))
        assert np.array_equal(vertex["quality"], radius.astype(np.float32))

    @pytest.mark.parametrize("name, options, parameters", [
        ("animal450", (), {}),
        ("capsule", ("--no-resample",), {"resample": False}),
        ("horn", ("--no-refine",), {"refine": False}),
        ("y_tube", ("--pole-method", "voronoi"), {"pole_method": "voronoi"}),
        ("taper", ("--no-denoise", "--w-m", "20"), {"denoise": False, "w_m": 20.0}),
        ("plate3", ("--target-length", "1.5"), {"target_length": pymeshlab.PercentageValue(1.5)}),
        ("slab", ("--keep-sheets",), {"keep_sheets": True}),
    ])
    def test_command_line(self, name, options, parameters, command_line, tmp_path):
        nodes, edges, _, faces = by_plugin(name, **parameters)
        out = tmp_path / "curve.obj"
        report = json.loads(run(command_line, MESHES / f"{name}.off", "--skeleton", out, *options))
        text = out.read_text()
        assert np.array_equal(numbers(text, "v"), nodes)
        assert corners(text, "l") == rows(edges) and corners(text, "f") == rows(faces)
        assert report["converged"] and report["refined"] == (name not in ("horn", "slab"))
        assert set(report["seconds"]) == {
            "check", "resample", "poles", "contraction", "conversion", "refine"}


def test_command_line_warns_of_cavities(command_line, tmp_path):
    """Without --verbose too: the skeleton is not that of the solid."""
    lines = (MESHES / "capsule.off").read_text().split("\n")
    vertices, faces = (int(word) for word in lines[1].split()[:2])
    rows = [line.split() for line in lines[2:2 + vertices + faces]]
    inner = [" ".join(str(0.4 * float(x)) for x in row) for row in rows[:vertices]]
    turned = [f"3 {int(c) + vertices} {int(b) + vertices} {int(a) + vertices}" for _, a, b, c in rows[vertices:]]
    hollow = tmp_path / "hollow.off"
    hollow.write_text("\n".join(["OFF", f"{2 * vertices} {2 * faces} 0", *lines[2:2 + vertices], *inner,
                                 *lines[2 + vertices:2 + vertices + faces], *turned]) + "\n")
    done = subprocess.run([command_line, hollow], capture_output=True, text=True, timeout=600, check=True)
    report = json.loads(done.stdout)
    assert 0.3 < report["in_cavities"] < 0.7 and report["pieces_left_out"] == 1
    assert "a cavity" in done.stderr and "% of the skeleton lies in cavities" in done.stderr
    assert subprocess.run([command_line, MESHES / "capsule.off"], capture_output=True, text=True, timeout=600,
                          check=True).stderr == ""


class TestFoundByCMake:
    def test_forces_no_warnings_on_its_users(self, examples):
        commands = json.loads((examples / "compile_commands.json").read_text())
        for entry in commands:
            words = entry["command"].split()
            assert not [word for word in words if word.startswith("-W")]
            assert "-ffp-contract=off" in words  # the same bits on every processor

    def test_says_what_is_missing(self, installed, tmp_path):
        shutil.copytree(ROOT / "examples/cpp", tmp_path / "source")
        said = run("cmake", "-S", tmp_path / "source", "-B", tmp_path / "build",
                   f"-DCMAKE_PREFIX_PATH={installed}", "-DMCFSKEL_QHULL=OFF", "-DMCFSKEL_OPENMP=OFF")
        assert "without Qhull, PoleMethod::Voronoi is not available" in said
        assert "without OpenMP" in said

    def test_needs_vcg_and_says_so(self, tmp_path):
        said = run("cmake", "-S", ROOT, "-B", tmp_path, "-DMCFSKEL_PLUGIN=OFF", status=1)
        assert "VCG_INCLUDE_DIR" in said


class TestDroppedIn:
    """No more than the folder vcg_ext, VCG and Eigen: no libraries, no threads."""

    @pytest.fixture(scope="class")
    def program(self, tmp_path_factory) -> Path:
        folder = tmp_path_factory.mktemp("dropped_in")
        shutil.copytree(ROOT / "vcg_ext", folder / "vcg_ext")
        source = shutil.copy(ROOT / "examples/cpp/skeletonize_arrays.cpp", folder)
        run("g++", "-std=c++17", "-O2", "-Wall", "-Wextra", "-Werror", "-I", folder / "vcg_ext",
            "-isystem", vcglib(), "-isystem", "/usr/include/eigen3", source, "-o", folder / "program")
        return folder / "program"

    def test_same_bits(self, program):
        nodes, edges, radius, _ = by_plugin("letter_p")
        text = run(program, MESHES / "letter_p.off")
        assert np.array_equal(numbers(text, "v"), np.column_stack([nodes, radius]))
        assert corners(text, "l") == rows(edges)

    def test_voronoi_says_that_it_needs_qhull(self, program):
        text = run(program, MESHES / "letter_p.off", "voronoi", status=1)
        assert "pole_method" in text and "Qhull" in text and "'balls'" in text

    def test_texts_speak_of_meshes(self, program, tmp_path):
        """The library knows no layers and no filters; the plugin adds which filter helps."""
        lines = (MESHES / "capsule.off").read_text().split("\n")
        vertices, faces, _ = map(int, lines[1].split())
        sheet = [lines[0], f"{vertices} 1 0", *lines[2:3 + vertices], ""]
        (tmp_path / "sheet.off").write_text("\n".join(sheet))
        text = run(program, tmp_path / "sheet.off", status=1)
        assert "open sheet" in text and "Give it a thickness" in text
        assert "layer" not in text
        flat = [lines[0], lines[1],
                *(" ".join(line.split()[:2] + ["0"]) for line in lines[2:2 + vertices]),
                *lines[2 + vertices:]]
        (tmp_path / "flat.off").write_text("\n".join(flat))
        text = run(program, tmp_path / "flat.off", status=1)
        assert "no volume" in text and "Remove Isolated" not in text
        layers = opened("capsule")
        layers.load_new_mesh(str(tmp_path / "flat.off"))
        assert "the mesh is flat" in failing(layers, FULL)


@pytest.mark.skipif(shutil.which("clang++") is None, reason="clang is not installed")
def test_clang_finds_nothing_that_only_gcc_knows():
    """ISO C++17 without extensions, but for bits in place of branches, which are meant."""
    run("clang++", "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Wgnu", "-Werror",
        "-Wno-bitwise-instead-of-logical", "-I", ROOT / "vcg_ext", "-isystem", vcglib(),
        "-isystem", "/usr/include/eigen3", ROOT / "examples" / "cpp" / "skeletonize_arrays.cpp")


def test_readme_shows_the_sample_program():
    """What the README shows is in the sample program, line by line."""
    readme = (ROOT / "README.md").read_text()
    program = (ROOT / "examples/cpp/skeletonize_mesh.cpp").read_text()
    shown = re.search(r"```cpp\n(.*?)```", readme, re.DOTALL)[1]
    lines = [line.strip() for line in shown.splitlines() if line.strip()]
    assert len(lines) >= 4
    for line in lines:
        assert line in program, line
