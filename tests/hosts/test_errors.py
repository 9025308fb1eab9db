# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What filters do with input they cannot use, or only just: a clear word, and nothing lost."""

from typing import Any

import numpy as np
import pymeshlab
import pytest

from conftest import (COLLAPSE, FULL, POLES, RESAMPLE, STEP, arrays, diagonal, document, failing,
                      fingerprint, labels, layer, opened)
from hostile.primitives import moebius_strip

COARSE = {"target_length": pymeshlab.PercentageValue(1.5)}
SURFACE_FILTERS = [RESAMPLE, POLES, STEP, FULL]
# With the surface as it is.
UNREPAIRED = [(RESAMPLE, {"repair": "off"}), (POLES, {}), (STEP, {"repair": "off"}),
              (FULL, {"repair": "off"})]
Mesh = tuple[np.ndarray, np.ndarray]


def refused(layers: pymeshlab.MeshSet, name: str, **parameters: Any) -> str:
    """The text with which a filter refuses to run; checks that the document is as before."""
    before = fingerprint(layers)
    text = failing(layers, name, **parameters)
    assert fingerprint(layers) == before
    return text


def tetrahedron(offset: tuple[float, float, float] = (0, 0, 0)) -> Mesh:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float) + offset
    return vertices, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def capsule() -> Mesh:
    return arrays("capsule")


def sharing_an_edge() -> Mesh:
    first, faces = tetrahedron()
    second = np.array([[0, -1, 0], [0, 0, -1]], float)
    numbers = np.array([0, 1, 4, 5])
    return np.vstack([first, second]), np.vstack([faces, numbers[faces]])


def sharing_a_vertex() -> Mesh:
    first, faces = tetrahedron()
    numbers = np.array([0, 4, 5, 6])
    return np.vstack([first, -first[1:]]), np.vstack([faces, numbers[faces[:, ::-1]]])


def open_capsule() -> Mesh:
    vertices, faces = capsule()
    return vertices, faces[1:]


def not_a_number() -> Mesh:
    vertices, faces = capsule()
    vertices = vertices.copy()
    vertices[5, 1] = np.nan
    return vertices, faces


def of_size_zero() -> Mesh:
    vertices, faces = tetrahedron()
    return vertices * 0, faces


def flat() -> Mesh:
    vertices, faces = capsule()
    return vertices * [1, 1, 0], faces


class TestRefusals:
    """Meshes that bound no solid: what is wrong, how many, and the cure."""

    @pytest.mark.parametrize("name, options", UNREPAIRED)
    @pytest.mark.parametrize("mesh, words", [
        (open_capsule, ["watertight", "3 border edges", "Close Holes"]),
        (lambda: moebius_strip(40), ["border edges"]),
        (sharing_an_edge, ["two-manifold", "1 edge", "Repair non Manifold Edges"]),
        (sharing_a_vertex, ["two-manifold", "1 vertex", "Repair non Manifold Vertices"]),
        (not_a_number, ["1 ", "finite", "NaN"]),
        (of_size_zero, ["no volume"]),
        (flat, ["no volume", "is flat"]),
    ])
    def test_bad_surface(self, name, options, mesh, words):
        text = refused(document(mesh()), name, **options)
        for word in words:
            assert word in text, text

    @pytest.mark.parametrize("name, options", UNREPAIRED)
    def test_one_triangle(self, name, options):
        text = refused(document((np.eye(3), [[0, 1, 2]])), name, **options)
        assert ("3 border edges" if name == POLES else "The mesh is flat") in text

    @pytest.mark.parametrize("name", [RESAMPLE, STEP, FULL])
    @pytest.mark.parametrize("mesh, words", [
        (lambda: (np.eye(3), [[0, 1, 2]]), ["open sheet"]),
        (of_size_zero, ["no volume"]),
        (flat, ["no volume", "is flat"]),
    ])
    def test_what_cannot_be_repaired(self, name, mesh, words):
        text = refused(document(mesh()), name)
        for word in words:
            assert word in text, text

    @pytest.mark.parametrize("name", SURFACE_FILTERS + [COLLAPSE])
    def test_empty_layer(self, name):
        layers = opened("box8")
        layers.set_selection_all()
        layers.meshing_remove_selected_vertices_and_faces()
        assert layers.current_mesh().vertex_number() == 0
        assert "faces" in refused(layers, name).lower()

    @pytest.mark.parametrize("name", SURFACE_FILTERS + [COLLAPSE])
    def test_point_cloud(self, name):
        layers = pymeshlab.MeshSet()
        layers.add_mesh(pymeshlab.Mesh(np.random.default_rng(1).random((50, 3))), "cloud")
        assert "faces" in refused(layers, name).lower()

    @pytest.mark.parametrize("name", SURFACE_FILTERS + [COLLAPSE])
    def test_empty_document(self, name):
        layers = pymeshlab.MeshSet()
        failing(layers, name)
        assert layers.mesh_number() == 0


class TestWrongLayer:
    @pytest.fixture
    def layers(self):
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        layers.apply_filter(COLLAPSE)
        return layers

    @pytest.mark.parametrize("name", [RESAMPLE, POLES, FULL])
    def test_a_stage_where_a_surface_is_meant(self, layers, name):
        layers.set_current_mesh(layer(layers, "capsule_meso_2").id())
        text = refused(layers, name)
        assert "stage of the contraction" in text and "surface layer" in text

    @pytest.mark.parametrize("name", SURFACE_FILTERS + [COLLAPSE])
    def test_a_skeleton_where_faces_are_meant(self, layers, name):
        layers.set_current_mesh(layer(layers, "capsule_skeleton").id())
        assert "faces" in refused(layers, name).lower()

    def test_a_surface_where_a_stage_is_meant(self, layers):
        layers.set_current_mesh(0)
        text = refused(layers, COLLAPSE)
        assert "not a stage" in text and "Contraction Step" in text

    def test_a_remeshed_stage_is_no_stage(self, layers):
        layers.set_current_mesh(layer(layers, "capsule_meso_2").id())
        layers.meshing_surface_subdivision_midpoint(iterations=1)
        text = refused(layers, COLLAPSE)
        assert "triangles" in text and "were changed" in text


class TestParameters:
    @pytest.mark.parametrize("name, parameters, word", [
        (STEP, {"w_l": 0.0}, "w_l"),
        (STEP, {"w_h": -1.0}, "w_h"),
        (STEP, {"w_m": -1.0}, "w_m"),
        (STEP, {"w_m": float("nan")}, "w_m"),
        (STEP, {"epsilon": pymeshlab.PureValue(-0.1)}, "epsilon"),
        (STEP, {"split_angle": 20.0}, "split_angle"),
        (STEP, {"split_angle": 180.0}, "split_angle"),
        (STEP, {"steps": 0}, "steps"),
        (FULL, {"max_iterations": -1}, "max_iterations"),
        (FULL, {"keep_stages": -1}, "keep_stages"),
        (RESAMPLE, {"resample_iterations": -1}, "resample_iterations"),
        (RESAMPLE, {"target_length": pymeshlab.PercentageValue(60)}, "target_length"),
        (RESAMPLE, {"target_length": pymeshlab.PercentageValue(1e-4)}, "target_length"),
    ])
    def test_out_of_range(self, name, parameters, word):
        assert word in refused(opened("capsule"), name, **parameters)


class TestForeignAttributes:
    @pytest.mark.parametrize("name", ["mcfskel_pole_radius", "mcfskel_node"])
    def test_point_where_a_scalar_is_meant(self, name):
        layers = opened("capsule")
        mesh = layers.current_mesh()
        mesh.add_vertex_custom_point_attribute(mesh.vertex_matrix(), name)
        assert name in refused(layers, FULL, resample=False)

    def test_scalar_where_a_point_is_meant(self):
        layers = opened("capsule")
        mesh = layers.current_mesh()
        mesh.add_vertex_custom_scalar_attribute(np.zeros(mesh.vertex_number()), "mcfskel_pole")
        assert "mcfskel_pole" in refused(layers, POLES)


class TestHardButRight:
    """Input that needs care, and gets its skeleton."""

    # Powers of two: others would round the coordinates differently, and end in another graph.
    @pytest.mark.parametrize("scale", [2.0**-20, 2.0**20])
    def test_scale(self, scale):
        vertices, faces = capsule()
        reference, scaled = document((vertices, faces)), document((vertices * scale, faces))
        expected = reference.apply_filter(FULL, **COARSE)
        results = scaled.apply_filter(FULL, **COARSE)
        for key in ["components", "cycles", "terminals", "junctions", "converged"]:
            assert results[key] == expected[key]
        assert results["skeleton_length"] == pytest.approx(
            scale * expected["skeleton_length"], rel=1e-6)

    def test_far_from_the_origin(self):
        vertices, faces = capsule()
        layers = document((vertices + 1e6, faces))
        results = layers.apply_filter(FULL, **COARSE)
        assert (results["components"], results["terminals"], results["converged"]) == (1, 2, 1)
        nodes = layers.current_mesh().vertex_matrix()
        assert np.abs(nodes[:, 1:] - 1e6).max() < 0.01 * diagonal(vertices)

    def test_inside_out(self):
        vertices, faces = capsule()
        right, wrong = document((vertices, faces)), document((vertices, faces[:, ::-1]))
        for layers in (right, wrong):
            results = layers.apply_filter(FULL, **COARSE)
            assert (results["components"], results["terminals"]) == (1, 2)
            nodes = layers.current_mesh().vertex_matrix()
            assert np.abs(nodes[:, 1:]).max() < 0.01 * diagonal(vertices)
        assert np.array_equal(wrong.mesh(0).face_matrix(), faces[:, ::-1])

    def test_seventy_components(self):
        vertices, faces = tetrahedron()
        layers = document((
            np.vstack([vertices + [2.0 * (i % 10), 2.0 * (i // 10), 0] for i in range(70)]),
            np.vstack([faces + 4 * i for i in range(70)])))
        results = layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(8))
        assert (results["components"], results["cycles"]) == (70, 0)
        assert results["converged"] == 1

    def test_unreferenced_and_coincident_vertices(self):
        vertices, faces = capsule()
        corners = vertices[faces].reshape(-1, 3)  # every face with vertices of its own
        soup = document((np.vstack([corners, [[9, 9, 9]]]),
                         np.arange(len(corners)).reshape(-1, 3)))
        results = soup.apply_filter(FULL, target_length=pymeshlab.PureValue(0.04))
        assert (results["components"], results["terminals"]) == (1, 2)
        node = soup.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
        assert (node[:-1] >= 0).all() and node[-1] == -1

    @pytest.mark.parametrize("create, inradius, circumradius", [
        ("create_sphere", 1, 1), ("create_cube", 1 / 2, 3**0.5 / 2)])
    def test_bodies_without_a_limb(self, create, inradius, circumradius):
        layers = pymeshlab.MeshSet()
        getattr(layers, create)()
        vertices = layers.current_mesh().vertex_matrix()
        results = layers.apply_filter(FULL)
        assert (results["components"], results["cycles"], results["converged"]) == (1, 0, 1)
        assert results["skeleton_edges"] >= 1
        curve = layers.current_mesh()
        centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
        # One short curve around the centre: the largest ball within the body holds it, and half of that one.
        assert np.linalg.norm(curve.vertex_matrix() - centre, axis=1).max() < inradius / 2
        assert results["skeleton_length"] < inradius
        assert results["junctions"] == 0
        # The radius is a mean distance from the surface.
        radius = curve.vertex_scalar_array()
        assert 0.9 * inradius < np.median(radius) < 1.01 * circumradius

    def test_copies_of_faces_and_a_degenerate_one(self):
        vertices, faces = capsule()
        layers = document((vertices, np.vstack([faces, faces[:3], [[7, 7, 8]]])))
        results = layers.apply_filter(FULL, **COARSE)
        assert (results["components"], results["terminals"]) == (1, 2)
        assert labels(layers)[-1] == "mesh_0_skeleton"
