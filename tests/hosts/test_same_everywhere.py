# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One mesh, one script: the same graph in every host, coordinates equal to single precision."""

import subprocess
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from conftest import FULL, MESHES, arrays, diagonal, document
from host_programs import changed, host, obj_graph, ply_vertices

NAMES = ["animal450", "torus_capsule", "plate3"]
LENGTHS = {"animal450": 0.05, "torus_capsule": 0.06, "plate3": 0.04}
Graph = tuple[np.ndarray, np.ndarray, np.ndarray]


@pytest.fixture(scope="module", params=NAMES)
def reference(request, tmp_path_factory) -> tuple[str, Path, Graph]:
    """A mesh, a script, and its nodes, edges and radius from the pymeshlab of the other tests."""
    folder = tmp_path_factory.mktemp("script")
    script = changed("full_skeletonize", folder, target_length=LENGTHS[request.param])
    layers = document()
    layers.load_new_mesh(str(MESHES / f"{request.param}.off"))
    layers.load_filter_script(str(script))
    layers.apply_filter_script()
    curve = layers.current_mesh()
    return request.param, script, (
        curve.vertex_matrix(), curve.edge_matrix(), curve.vertex_scalar_array())


def check_floats(path: Path, nodes: np.ndarray, radius: np.ndarray) -> None:
    """Each number of a PLY file is the float nearest to the double."""
    vertex = ply_vertices(path)
    held = np.column_stack([vertex[axis] for axis in "xyz"])
    assert held.dtype == np.float32
    assert np.array_equal(held, nodes.astype(np.float32))
    assert np.array_equal(vertex["quality"], radius.astype(np.float32))


@pytest.mark.parametrize("name", ["pymeshlab-2023.12", "pymeshlab-2022.2"])
def test_other_pymeshlab(name, reference, tmp_path):
    other = host(name)
    mesh, script, (nodes, edges, radius) = reference
    subprocess.run([other.folder / "bin/python", Path(__file__).parent / "run_script.py",
                    other.plugin, script, MESHES / f"{mesh}.off", tmp_path / "curve.npz"],
                   check=True, timeout=300)
    curve = np.load(tmp_path / "curve.npz")
    assert np.array_equal(curve["edges"], edges)
    assert np.array_equal(curve["nodes"], nodes)
    assert np.array_equal(curve["radius"], radius)
    assert curve["quality"] == pytest.approx(radius, rel=1e-6)


def test_meshlabserver(server, reference, tmp_path):
    mesh, script, (nodes, edges, radius) = reference
    run = server(MESHES / f"{mesh}.off", script, "-o", tmp_path / "curve.obj", "-l", "x",
                 "-o", tmp_path / "curve.ply", "-l", "x", "-m", "vq")
    assert run.returncode == 0, run.stdout
    assert np.array_equal(obj_graph(tmp_path / "curve.obj")[1], edges)
    check_floats(tmp_path / "curve.ply", nodes, radius)


def test_meshlab_2025(reference, tmp_path):
    """MeshLab 2025.07 without its window, in single precision too."""
    meshlab = host("meshlab-2025.07")
    mesh, script, (nodes, edges, radius) = reference
    program = meshlab.plugin.parents[1] / "tests/hosts/run_script"
    subprocess.run([program, meshlab.folder / "bin/plugins/libio_base.so", meshlab.plugin, script,
                    MESHES / f"{mesh}.off", tmp_path / "curve.cg", tmp_path / "curve.ply"],
                   check=True, timeout=300)
    written = obj_graph(tmp_path / "curve.cg", line="e")  # in double: what the layer carries
    assert np.array_equal(written[0], nodes) and np.array_equal(written[1], edges)
    check_floats(tmp_path / "curve.ply", nodes, radius)


class TestInputBits:
    """What makes it so: the pipeline sees a surface in single precision."""

    @pytest.mark.parametrize("name", ["capsule", "torus"])
    def test_more_digits_change_nothing(self, name):
        vertices, faces = arrays(name)
        single = vertices.astype(np.float32).astype(float)
        assert not np.array_equal(vertices, single)
        documents = [document((points, faces)) for points in (vertices, single)]
        for layers, points in zip(documents, (vertices, single)):
            layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
            assert np.array_equal(layers.mesh(0).vertex_matrix(), points)
        curves = [layers.current_mesh() for layers in documents]
        assert np.array_equal(curves[0].edge_matrix(), curves[1].edge_matrix())
        assert np.array_equal(curves[0].vertex_matrix(), curves[1].vertex_matrix())

    def test_not_where_single_precision_has_no_digits_left(self):
        vertices, faces = arrays("capsule")
        layers = document((vertices + 1e6, faces))
        layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
        resampled = layers.mesh(1).vertex_matrix() - 1e6
        # Floats around a million are 0.06 apart.
        distance = np.linalg.norm(resampled[:, 1:], axis=1)
        assert distance.max() < np.linalg.norm(vertices[:, 1:], axis=1).max() + (
            1e-3 * diagonal(vertices))
