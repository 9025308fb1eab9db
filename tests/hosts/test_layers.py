# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""State and layers: branching off, deleting, renaming, several meshes, frames, selections, leftovers."""

import threading
from collections.abc import Callable

import numpy as np
import pymeshlab
import pytest

from conftest import (COLLAPSE, FULL, POLES, RESAMPLE, STEP, arrays, attributes, diagonal, document,
                      failing, fingerprint, labels, layer, opened, scalars)

COARSE = {"target_length": pymeshlab.PercentageValue(1.5)}
REFINE = "generate_refined_skeleton_mcf"


def same_curve(a: pymeshlab.Mesh, b: pymeshlab.Mesh) -> bool:
    return (np.array_equal(a.vertex_matrix(), b.vertex_matrix())
            and np.array_equal(a.edge_matrix(), b.edge_matrix())
            and np.array_equal(a.vertex_scalar_array(), b.vertex_scalar_array()))


def make_current(layers: pymeshlab.MeshSet, label: str) -> None:
    layers.set_current_mesh(layer(layers, label).id())


def delete(layers: pymeshlab.MeshSet, label: str) -> None:
    make_current(layers, label)
    layers.delete_current_mesh()


class TestBranches:
    def test_other_weights_from_an_older_stage(self):
        layers, alone = opened("torus"), opened("torus")
        layers.apply_filter(STEP, steps=4)
        make_current(layers, "torus_meso_2")
        before = layers.current_mesh().vertex_matrix()
        layers.apply_filter(STEP, w_l=3.0)
        branch = layers.current_mesh()
        assert layers.mesh_number() == 6
        alone.apply_filter(STEP, steps=2)
        alone.apply_filter(STEP, w_l=3.0)
        assert np.array_equal(branch.vertex_matrix(), alone.current_mesh().vertex_matrix())
        assert np.array_equal(layer(layers, "torus_meso_2").vertex_matrix(), before)
        assert not np.array_equal(branch.vertex_matrix(),
                                  layer(layers, "torus_meso_3").vertex_matrix())

    def test_the_surface_belongs_to_the_stage_made_last(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=6)
        make_current(layers, "torus_meso_2")
        layers.apply_filter(STEP)
        stage, surface = layers.current_mesh(), layers.mesh(0)
        node = scalars(surface, "mcfskel_node").astype(int)
        assert node.max() < stage.vertex_number()
        distance = np.linalg.norm(surface.vertex_matrix() - stage.vertex_matrix()[node], axis=1)
        count = np.bincount(node, minlength=stage.vertex_number())
        mean = np.bincount(node, distance, stage.vertex_number()) / np.maximum(count, 1)
        assert mean[count > 0] == pytest.approx(scalars(stage, "mcfskel_radius")[count > 0], rel=1e-5)

    def test_the_branch_not_taken_collapses_as_ever(self):
        layers, alone = opened("torus"), opened("torus")
        layers.apply_filter(STEP, steps=3)
        make_current(layers, "torus_meso_1")
        layers.apply_filter(STEP, steps=2, w_h=40.0)
        make_current(layers, "torus_meso_3")
        layers.apply_filter(COLLAPSE)
        alone.apply_filter(STEP, steps=3)
        alone.apply_filter(COLLAPSE)
        assert same_curve(layers.current_mesh(), alone.current_mesh())


class TestDeletedLayers:
    def test_only_the_last_stage_is_left(self):
        layers, whole = opened("capsule"), opened("capsule")
        for one in (layers, whole):
            one.apply_filter(STEP, steps=3)
        for label in ["capsule.off", "capsule_meso_1", "capsule_meso_2"]:
            delete(layers, label)
        for one in (layers, whole):
            make_current(one, "capsule_meso_3")
            one.apply_filter(STEP, steps=2)
            one.apply_filter(COLLAPSE)
        assert same_curve(layers.current_mesh(), whole.current_mesh())
        assert labels(layers) == ["capsule_meso_3", "capsule_meso_4", "capsule_meso_5",
                                  "capsule_skeleton"]

    def test_another_mesh_in_place_of_the_surface_is_left_alone(self):
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        delete(layers, "capsule.off")
        vertices, faces = arrays("torus")
        layers.add_mesh(pymeshlab.Mesh(vertices, faces), "stranger")
        make_current(layers, "capsule_meso_2")
        layers.apply_filter(COLLAPSE)
        assert attributes(layer(layers, "stranger")) == {}

    def test_a_failure_after_deletions_changes_nothing(self):
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        delete(layers, "capsule_meso_1")
        make_current(layers, "capsule_meso_2")
        before = fingerprint(layers)
        assert "w_l" in failing(layers, STEP, w_l=-1.0)
        assert fingerprint(layers) == before


class TestNames:
    @pytest.mark.parametrize("name", ["renamed", "a b (c).ply", "_skeleton", "", "größe"])
    def test_a_renamed_stage_carries_on(self, name):
        layers, plain = opened("capsule"), opened("capsule")
        for one in (layers, plain):
            one.apply_filter(STEP, steps=2)
        layers.current_mesh().set_label(name)
        for one in (layers, plain):
            one.apply_filter(STEP)
            assert "_meso_3" in one.current_mesh().label()
            one.apply_filter(COLLAPSE)
        assert same_curve(layers.current_mesh(), plain.current_mesh())

    def test_a_renamed_surface_is_still_found(self):
        layers = opened("capsule")
        layers.apply_filter(STEP, steps=2)
        layers.mesh(0).set_label("another name")
        layers.apply_filter(COLLAPSE)
        node = scalars(layers.mesh(0), "mcfskel_node")
        assert node.max() == layers.current_mesh().vertex_number() - 1

    def test_two_layers_of_one_name(self):
        layers = document(arrays("capsule"), arrays("torus"))
        for k in range(2):
            layers.mesh(k).set_label("same")
        cycles = []
        for k in range(2):
            layers.set_current_mesh(k)
            cycles.append(layers.apply_filter(FULL, **COARSE)["cycles"])
        assert cycles == [0, 1]

    @pytest.mark.parametrize("fitted", [False, True], ids=["as it is", "in the same box"])
    def test_a_skeleton_is_refined_on_its_own_body_of_two_of_one_name(self, fitted):
        first, (vertices, faces) = arrays("y_tube"), arrays("torus")
        if fitted:
            low, size = first[0].min(axis=0), np.ptp(first[0], axis=0)
            vertices = low + (vertices - vertices.min(axis=0)) / np.ptp(vertices, axis=0) * size
        layers = document(first, (vertices, faces))
        made = []
        for k, name in enumerate(["part.obj", "part.ply"]):
            layers.mesh(k).set_label(name)
        for k in range(2):
            layers.set_current_mesh(k)
            count = layers.mesh_number()
            layers.apply_filter(FULL, refine=False, **COARSE)
            made.append([mesh.id() for mesh in layers][count:])

        def nodes() -> dict[int, list[float]]:
            return {mesh.id(): scalars(mesh, "mcfskel_node").tolist() for mesh in layers
                    if "mcfskel_node" in attributes(mesh)}

        before = nodes()
        assert before.keys() == {0, 1, made[0][0], made[1][0]}, "the inputs and the resampled surfaces"
        for k in range(2):
            layers.set_current_mesh(made[k][-1])
            layers.apply_filter(REFINE)
            after = nodes()
            assert {i for i in before if after[i] != before[i]} == {k, made[k][0]}
            assert max(after[k]) < layers.current_mesh().vertex_number()
            before = after


class TestTwoMeshes:
    def test_in_turns(self):
        layers = document(arrays("capsule"), arrays("torus"))
        stages = [0, 1]
        for _ in range(3):
            for k in range(2):
                layers.set_current_mesh(stages[k])
                layers.apply_filter(STEP)
                stages[k] = layers.current_mesh_id()
        for k, name in enumerate(["capsule", "torus"]):
            layers.set_current_mesh(stages[k])
            layers.apply_filter(COLLAPSE)
            alone = document(arrays(name))
            alone.apply_filter(STEP, steps=3)
            alone.apply_filter(COLLAPSE)
            assert same_curve(layers.current_mesh(), alone.current_mesh())

    def test_two_equal_meshes_each_get_their_own(self):
        layers = document(arrays("capsule"), arrays("capsule"))
        layers.set_current_mesh(1)
        layers.apply_filter(STEP)
        assert attributes(layers.mesh(0)) == {}
        assert "mcfskel_node" in attributes(layers.mesh(1))


def moved(layers: pymeshlab.MeshSet) -> None:
    layers.compute_matrix_from_translation(axisx=7.0, freeze=False)


def turned(layers: pymeshlab.MeshSet) -> None:
    layers.compute_matrix_from_rotation(rotaxis="Z axis", angle=30.0, freeze=False)


def stretched(layers: pymeshlab.MeshSet) -> None:
    layers.compute_matrix_from_scaling_or_normalization(
        axisx=2.0, axisy=0.5, uniformflag=False, freeze=False)


def mirrored(layers: pymeshlab.MeshSet) -> None:
    layers.compute_matrix_from_scaling_or_normalization(axisx=-1.0, uniformflag=False, freeze=False)


class TestFrames:
    """A layer's matrix moves what is seen: the filters work in the layer's own frame."""

    @pytest.mark.parametrize("change", [moved, turned, stretched, mirrored])
    def test_every_filter_keeps_the_frame(self, change: Callable[[pymeshlab.MeshSet], None]):
        layers, plain = opened("capsule"), opened("capsule")
        change(layers)
        matrix = layers.mesh(0).transform_matrix()
        assert not np.array_equal(matrix, np.eye(4))
        for one in (layers, plain):
            one.apply_filter(RESAMPLE, **COARSE)
            one.apply_filter(POLES)
            one.apply_filter(STEP, steps=100)
            one.apply_filter(COLLAPSE)
            one.apply_filter(REFINE)
        for a, b in zip(layers, plain):
            assert np.array_equal(a.transform_matrix(), matrix), a.label()
            assert np.array_equal(a.vertex_matrix(), b.vertex_matrix()), a.label()
            assert np.array_equal(a.edge_matrix(), b.edge_matrix()), a.label()

    def test_a_stage_that_is_moved_by_its_matrix_carries_on(self):
        layers, plain = opened("capsule"), opened("capsule")
        for one in (layers, plain):
            one.apply_filter(STEP, steps=2)
        moved(layers)
        matrix = layers.current_mesh().transform_matrix()
        for one in (layers, plain):
            assert one.apply_filter(STEP)["iterations"] == 3
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              plain.current_mesh().vertex_matrix())
        assert np.array_equal(layers.current_mesh().transform_matrix(), matrix)


class TestSelections:
    def test_change_nothing_and_stay(self):
        layers, plain = opened("capsule"), opened("capsule")
        layers.compute_selection_by_condition_per_vertex(condselect="x > 0")
        selected = layers.mesh(0).selected_vertex_number()
        assert 0 < selected < layers.mesh(0).vertex_number()
        for one in (layers, plain):
            one.apply_filter(FULL, **COARSE)
        assert same_curve(layers.current_mesh(), plain.current_mesh())
        assert layers.mesh(0).selected_vertex_number() == selected

    def test_a_selection_on_a_stage(self):
        layers, plain = opened("capsule"), opened("capsule")
        for one in (layers, plain):
            one.apply_filter(STEP)
        layers.set_selection_all()
        for one in (layers, plain):
            one.apply_filter(STEP)
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              plain.current_mesh().vertex_matrix())


class TestDeletedElements:
    @pytest.fixture
    def cut(self) -> pymeshlab.MeshSet:
        """A document whose mesh has lost one of its two components, the one that came first."""
        torus, capsule = arrays("torus"), arrays("capsule")
        far = torus[0] + [100.0, 0, 0]
        layers = document((np.vstack([far, capsule[0]]),
                           np.vstack([torus[1], capsule[1] + len(far)])))
        layers.compute_selection_by_condition_per_vertex(condselect="x > 50")
        layers.compute_selection_by_condition_per_face(condselect="x0 > 50")
        layers.meshing_remove_selected_vertices_and_faces()
        return layers

    def test_are_not_there(self, cut):
        plain = document(arrays("capsule"))
        for layers in (cut, plain):
            layers.apply_filter(FULL, **COARSE)
        assert same_curve(cut.current_mesh(), plain.current_mesh())

    def test_attributes_fit_what_is_left(self, cut):
        cut.apply_filter(FULL, resample=False)
        surface, curve = cut.mesh(0), cut.current_mesh()
        node = scalars(surface, "mcfskel_node").astype(int)
        assert len(node) == surface.vertex_number() and node.min() >= 0
        distance = np.linalg.norm(surface.vertex_matrix() - curve.vertex_matrix()[node], axis=1)
        assert distance.max() < 0.3 * diagonal(surface.vertex_matrix())

    def test_deleting_from_a_surface_with_state(self):
        layers = opened("torus_capsule")
        layers.apply_filter(POLES)
        layers.compute_selection_by_small_disconnected_components_per_face(nbfaceratio=0.9)
        layers.meshing_remove_selected_vertices_and_faces()
        results = layers.apply_filter(FULL, resample=False)
        assert results["components"] == 1

    def test_a_stage_that_lost_faces_is_refused(self):
        layers = opened("capsule")
        layers.apply_filter(STEP)
        layers.compute_selection_by_condition_per_face(condselect="fi < 3")
        layers.meshing_remove_selected_faces()
        for name in [STEP, COLLAPSE]:
            failing(layers, name)

    def test_a_curve_that_lost_vertices(self):
        layers = opened("capsule")
        layers.apply_filter(FULL, **COARSE)
        curve = layers.current_mesh()
        count = curve.vertex_number()
        layers.compute_selection_by_condition_per_vertex(condselect="vi < 1")
        layers.meshing_remove_selected_vertices()
        assert layers.current_mesh().vertex_number() == count - 1
        failing(layers, COLLAPSE)


SCALARS = ["mcfskel_pole_radius", "mcfskel_fixed", "mcfskel_radius", "mcfskel_significance", "mcfskel_node"]


def spoil(mesh: pymeshlab.Mesh, name: str) -> None:
    """Puts an attribute of the wrong type and size under one of the project's names."""
    if name == "mcfskel_pole":
        mesh.add_vertex_custom_scalar_attribute(np.ones(mesh.vertex_number()), name)
    else:
        mesh.add_vertex_custom_point_attribute(np.ones((mesh.vertex_number(), 3)), name)


class TestForeignAttributes:
    @pytest.mark.parametrize("name", [*SCALARS, "mcfskel_pole"])
    @pytest.mark.parametrize("filter_name", [RESAMPLE, POLES, STEP, FULL])
    def test_on_a_surface(self, filter_name, name):
        layers = document(arrays("capsule"))
        spoil(layers.current_mesh(), name)
        count = layers.mesh_number()
        assert name in failing(layers, filter_name)
        assert layers.mesh_number() == count

    def test_of_the_right_type_with_nonsense_in_it(self):
        """Poles that are no poles of the mesh are not used."""
        layers, plain = document(arrays("capsule")), document(arrays("capsule"))
        mesh = layers.current_mesh()
        mesh.add_vertex_custom_point_attribute(np.full((mesh.vertex_number(), 3), np.nan),
                                               "mcfskel_pole")
        mesh.add_vertex_custom_scalar_attribute(np.full(mesh.vertex_number(), np.inf),
                                                "mcfskel_pole_radius")
        mesh.add_vertex_custom_scalar_attribute(np.full(mesh.vertex_number(), -1e30), "mcfskel_node")
        for one in (layers, plain):
            one.apply_filter(STEP)
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              plain.current_mesh().vertex_matrix())

    def test_stage_attributes_alone_make_no_stage(self):
        layers = document(arrays("capsule"))
        mesh = layers.current_mesh()
        mesh.add_vertex_custom_scalar_attribute(np.ones(mesh.vertex_number()), "mcfskel_fixed")
        assert "its state is gone" in failing(layers, COLLAPSE)


class TestMeanwhile:
    """MeshLab stays awake while a filter runs: the user may click another layer, or delete one."""

    @staticmethod
    def run(layers: pymeshlab.MeshSet, name: str, then: Callable[[], None], **parameters) -> None:
        """Applies a filter, and does something as soon as it computes."""
        ended, failed = threading.Event(), []

        def act() -> None:
            if ended.wait(0.1):
                failed.append("the filter was faster")
            else:
                then()

        thread = threading.Thread(target=act)
        thread.start()
        try:
            layers.apply_filter(name, **parameters)
        finally:
            ended.set()
            thread.join()
            assert not failed

    @pytest.fixture
    def layers(self) -> pymeshlab.MeshSet:
        """A surface, which is current and takes much longer than 0.1 s, and one with other vertices."""
        layers = document(arrays("hand"), arrays("box8"))
        layers.set_current_mesh(0)
        layers.meshing_surface_subdivision_midpoint(iterations=3, threshold=pymeshlab.PercentageValue(0))
        return layers

    @pytest.mark.parametrize("parameters", [{"target_length": pymeshlab.PercentageValue(0.9)}, {"resample": False}])
    def test_another_layer_is_made_current(self, layers, parameters):
        self.run(layers, FULL, lambda: layers.set_current_mesh(1), **parameters)
        surface, other = layers.mesh(0), layers.mesh(1)
        assert layers.current_mesh().label() == "mesh_0_skeleton"
        assert not attributes(other), "the layer that was clicked is none of the filter's"
        node = scalars(surface, "mcfskel_node")
        assert node.min() >= 0 and node.max() < layers.current_mesh().vertex_number()

    def test_the_layer_is_deleted(self, layers):
        with pytest.raises(pymeshlab.PyMeshLabException, match="was deleted or changed"):
            self.run(layers, FULL, lambda: delete(layers, "mesh_0"), resample=False)
        assert labels(layers) == ["mesh_1"] and not attributes(layers.mesh(1))

    def test_vertices_are_deleted(self, layers):
        def edit() -> None:
            layers.set_selection_all()
            layers.meshing_remove_selected_vertices()

        with pytest.raises(pymeshlab.PyMeshLabException, match="was deleted or changed"):
            self.run(layers, FULL, edit, resample=False)
        assert labels(layers) == ["mesh_0", "mesh_1"] and not attributes(layers.mesh(1))
        assert layers.mesh(0).vertex_number() == 0
