# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of the state of stages and skeletons when somebody edits, copies, renames, saves or loads their
layers: what can be kept is kept, and the log says what was taken over and what is lost."""

import ctypes
import resource
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from conftest import (COLLAPSE, FULL, MESHES, STEP, arrays, attributes, diagonal, document,
                      failing, labels, layer, points, scalars)
from filter_names import SAVE_PROJECT

COARSE = {"target_length": pymeshlab.PercentageValue(1.5)}


def edit(layers: pymeshlab.MeshSet, name: str, expression: str) -> None:
    """Sets an attribute of the current layer, as a person does with MeshLab's own filter."""
    layers.compute_new_custom_scalar_attribute_per_vertex(name=name, expr=expression)


def staged(steps: int = 3, name: str = "capsule") -> pymeshlab.MeshSet:
    """A document with a mesh and the stages of its contraction, the last one current; its log is printed."""
    layers = pymeshlab.MeshSet(verbose=True)
    layers.load_new_mesh(str(MESHES / f"{name}.off"))
    layers.apply_filter(STEP, steps=steps)
    return layers


@pytest.fixture
def log(capfd: pytest.CaptureFixture[str]) -> Callable[[], str]:
    """What was logged since the last call."""
    def read() -> str:
        ctypes.CDLL(None).fflush(None)  # pymeshlab prints into C's buffer, which capfd does not know
        return "".join(capfd.readouterr())
    return read


def smooth(layers: pymeshlab.MeshSet) -> None:
    layers.apply_coord_laplacian_smoothing(stepsmoothnum=1, boundary=False)


class TestEditedAttributes:
    def test_fixed_marks_count(self, log):
        layers = staged()
        before = layers.current_mesh().vertex_matrix()
        middle = float(np.median(before[:, 0]))
        chosen = before[:, 0] > middle
        edit(layers, "mcfskel_fixed", f"x > {middle!r} ? 1 : 0")
        assert scalars(layers.current_mesh(), "mcfskel_fixed").astype(bool).tolist() == chosen.tolist()
        log()
        layers.apply_filter(STEP)
        assert "fixed marks" in log()
        after = {tuple(p) for p in layers.current_mesh().vertex_matrix()}
        assert layers.current_mesh().label() == "capsule_meso_4"
        stayed = np.array([tuple(p) in after for p in before])
        # Collapses may take some of them away, but none moves, while the others all do.
        assert stayed[chosen].mean() > 0.6
        assert stayed[~chosen].mean() < 0.1

    def test_held_marks_count(self, log):
        layers = staged()
        before = layers.current_mesh().vertex_matrix()
        edit(layers, "mcfskel_held", f"x > {float(np.sort(before[:, 0])[-6])!r} ? 1 : 0")
        log()
        layers.apply_filter(STEP, steps=3)
        assert "5 held marks" in log()
        stage = layers.current_mesh()
        held = stage.vertex_matrix()[scalars(stage, "mcfskel_held") == 1]
        assert {tuple(p) for p in held} == {tuple(p) for p in before[np.argsort(before[:, 0])[-5:]]}

    def test_poles_draw_the_stage_elsewhere(self, log):
        layers, plain = staged(), staged()
        stage = layers.current_mesh()
        shift = 0.1 * diagonal(layers.mesh(0).vertex_matrix())
        pole = points(stage, "mcfskel_pole")
        layers.compute_new_custom_point_attribute_per_vertex(
            name="mcfskel_pole", x_expr="mcfskel_pole_x", y_expr="mcfskel_pole_y",
            z_expr=f"mcfskel_pole_z + {float(shift)!r}")
        assert points(stage, "mcfskel_pole") == pytest.approx(pole + [0, 0, shift], abs=1e-5)
        log()
        for one in (layers, plain):
            one.apply_filter(STEP, w_m=80.0)
        assert "poles" in log()
        up = (layers.current_mesh().vertex_matrix().mean(axis=0)
              - plain.current_mesh().vertex_matrix().mean(axis=0))
        assert up[2] > 0.2 * shift and abs(up[:2]).max() < 0.2 * up[2]

    def test_a_pole_is_taken_away_by_its_radius(self, log):
        layers = staged()
        edit(layers, "mcfskel_pole_radius", "-1")
        log()
        layers.apply_filter(STEP, w_l=3.0)
        assert "radii of poles" in log()
        mean_curvature_alone = staged()
        mean_curvature_alone.apply_filter(STEP, w_l=3.0)
        assert not np.array_equal(layers.current_mesh().vertex_matrix(),
                                  mean_curvature_alone.current_mesh().vertex_matrix())
        assert (scalars(layers.current_mesh(), "mcfskel_pole_radius") == -1).all()

    def test_nothing_edited_is_nothing_said(self, log):
        layers, plain = staged(), staged()
        edit(layers, "mcfskel_pole_radius", "mcfskel_pole_radius")
        log()
        layers.apply_filter(STEP)
        assert "Taken over" not in log()
        plain.apply_filter(STEP)
        assert np.array_equal(layers.current_mesh().vertex_matrix(), plain.current_mesh().vertex_matrix())

    @pytest.mark.parametrize("name", ["mcfskel_fixed", "mcfskel_held"])
    def test_marks_that_are_no_numbers_are_refused(self, name):
        layers = staged()
        count = layers.mesh_number()
        edit(layers, name, "sqrt(0 - 1)")
        assert np.isnan(scalars(layers.current_mesh(), name)).all()
        assert name in failing(layers, STEP)
        assert layers.mesh_number() == count

    def test_a_radius_of_a_skeleton(self, log):
        layers = pymeshlab.MeshSet(verbose=True)
        layers.load_new_mesh(str(MESHES / "capsule.off"))
        layers.apply_filter(FULL, **COARSE)
        thickness = float(diagonal(layers.mesh(0).vertex_matrix()) / 50)
        edit(layers, "mcfskel_radius", repr(thickness))
        log()
        layers.apply_filter("generate_skeleton_tubes_mcf", local_radius=True)
        assert "radii" in log()
        lowest, highest = (f(layers.current_mesh().vertex_matrix(), axis=0) for f in (np.min, np.max))
        curve = layer(layers, "capsule_skeleton").vertex_matrix()
        wider = np.sort((highest - lowest) - np.ptp(curve, axis=0))
        assert wider[0] > 1.2 * thickness and wider[-1] < 2.5 * thickness


class TestMovedStages:
    def test_a_smoothed_one_carries_on(self, log):
        layers = staged()
        smooth(layers)
        moved = layers.current_mesh().vertex_matrix()
        log()
        assert layers.apply_filter(STEP)["iterations"] == 4
        assert f"{len(moved)} positions" in log()
        assert layers.current_mesh().label() == "capsule_meso_4"
        assert "mcfskel_node" in attributes(layers.mesh(0)), "its surface has its correspondence still"
        layers.apply_filter(STEP, steps=100)
        assert layers.apply_filter(COLLAPSE)["components"] == 1
        node = scalars(layers.mesh(0), "mcfskel_node")
        assert node.max() == layers.current_mesh().vertex_number() - 1

    def test_is_smoothed_and_not_what_it_was(self):
        layers, plain = staged(), staged()
        smooth(layers)
        for one in (layers, plain):
            one.apply_filter(STEP)
        assert not np.array_equal(layers.current_mesh().vertex_matrix(),
                                  plain.current_mesh().vertex_matrix())

    def test_collapses_and_is_no_surface(self, log):
        layers = staged(100)
        smooth(layers)
        assert "not a surface" in failing(layers, FULL)
        layers.apply_filter(COLLAPSE)
        assert "positions" in log()

    def test_frozen_translation(self, log):
        layers = staged()
        layers.compute_matrix_from_translation(axisx=0.01, freeze=True)
        assert layers.apply_filter(STEP)["iterations"] == 4
        assert "by up to 0.01)" in log()

    def test_too_far_to_be_its_surface_s(self):
        layers = staged()
        layers.compute_matrix_from_scaling_or_normalization(axisx=1e5, freeze=True)
        assert "stage cannot be used" in failing(layers, STEP)

    def test_filters_that_change_nothing(self, log):
        layers, plain = staged(), staged()
        layers.meshing_remove_duplicate_vertices()
        layers.meshing_remove_duplicate_faces()
        layers.compute_normal_per_vertex()
        log()
        for one in (layers, plain):
            one.apply_filter(STEP)
        assert "Taken over" not in log()
        assert np.array_equal(layers.current_mesh().vertex_matrix(), plain.current_mesh().vertex_matrix())

    def test_a_remeshed_one_is_said_to_be_a_surface_of_its_own(self, log):
        layers = staged(1)
        layers.meshing_surface_subdivision_midpoint(iterations=1)
        assert "triangles" in failing(layers, COLLAPSE)
        log()
        assert layers.apply_filter(STEP)["iterations"] == 1
        assert "counted from 1" in log()


class TestMovedSkeletons:
    def test_keeps_its_surface(self, log, tmp_path):
        layers = pymeshlab.MeshSet(verbose=True)
        layers.load_new_mesh(str(MESHES / "capsule.off"))
        layers.apply_filter(FULL, **COARSE)
        layers.compute_matrix_from_translation(axisx=0.01, freeze=True)
        log()
        layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.json"))
        assert "positions" in log()
        assert '"surface_vertices": [' in (tmp_path / "s.json").read_text()


class TestCopies:
    def test_of_a_stage_carry_on(self, log):
        layers, plain = staged(), staged()
        layers.generate_copy_of_current_mesh()
        assert attributes(layers.current_mesh()) == {}, "MeshLab copies no attributes"
        log()
        for one in (layers, plain):
            assert one.apply_filter(STEP)["iterations"] == 4
        assert "is a copy of 'capsule_meso_3'" in log()
        assert np.array_equal(layers.current_mesh().vertex_matrix(), plain.current_mesh().vertex_matrix())

    def test_of_a_skeleton_know_their_surface(self, log, tmp_path):
        layers = document(arrays("capsule"))
        layers.apply_filter(FULL, **COARSE)
        radius = scalars(layers.current_mesh(), "mcfskel_radius")
        layers.generate_copy_of_current_mesh()
        layers.apply_filter("save_stage_mcf", file=str(tmp_path / "copy.ply"))
        layers.apply_filter("load_stage_mcf", file=str(tmp_path / "copy.ply"))
        assert np.array_equal(scalars(layers.current_mesh(), "mcfskel_radius"), radius)
        layers.apply_filter("generate_refined_skeleton_mcf")

    def test_without_its_original_is_said_to_be_a_surface(self, log):
        layers = staged()
        layers.generate_copy_of_current_mesh()
        layers.current_mesh().set_label("capsule_meso_3_copy")
        copy = layers.current_mesh_id()
        layers.set_current_mesh(layer(layers, "capsule_meso_3").id())
        layers.delete_current_mesh()
        layers.set_current_mesh(copy)
        log()
        layers.apply_filter(STEP)
        assert "has the name of a stage" in (said := log()) and "counted from 1" in said

    def test_a_copy_of_the_surface_is_not_taken_for_it(self):
        layers = document(arrays("capsule"), arrays("capsule"))
        layers.set_current_mesh(1)
        layers.apply_filter(STEP, steps=2)
        layers.apply_filter(COLLAPSE)
        layers.apply_filter("generate_refined_skeleton_mcf")
        assert attributes(layers.mesh(0)) == {}


class TestProjects:
    @pytest.fixture
    def project(self, tmp_path: Path) -> tuple[pymeshlab.MeshSet, Path]:
        """A document with a mesh, stages, a skeleton and tubes, and the project that it was saved as."""
        layers = staged(2, "torus")
        layers.mesh(0).set_label("a/b: ü.off")
        layers.set_current_mesh(0)
        layers.apply_filter(FULL, resample=False)
        layers.apply_filter("generate_skeleton_tubes_mcf")
        layers.compute_matrix_from_rotation(rotaxis="Z axis", angle=30.0, freeze=False)
        layers.set_current_mesh(layer(layers, "torus_meso_2").id())
        file = tmp_path / "ring.mlp"
        assert layers.apply_filter(SAVE_PROJECT, file=str(file))["layers"] == layers.mesh_number()
        return layers, file

    def test_every_layer_comes_back(self, project):
        layers, file = project
        again = pymeshlab.MeshSet()
        again.load_project(str(file))
        assert labels(again) == labels(layers)
        for mine, other in zip(layers, again):
            for read in [lambda m: m.vertex_matrix(), lambda m: m.face_matrix(), lambda m: m.edge_matrix()]:
                assert np.array_equal(read(mine), read(other)), mine.label()
            if mine.has_vertex_scalar():
                assert other.vertex_scalar_array() == pytest.approx(mine.vertex_scalar_array(), rel=1e-6)
            if mine.has_vertex_color():
                assert np.array_equal(mine.vertex_color_matrix(), other.vertex_color_matrix())
            assert mine.transform_matrix() == pytest.approx(other.transform_matrix(), abs=1e-6)
        assert sorted(p.name for p in file.parent.iterdir()) == ["ring.mlp", "ring_layers"]

    def test_a_stage_carries_on_bit_for_bit(self, project, log):
        layers, file = project
        again = pymeshlab.MeshSet(verbose=True)
        again.load_project(str(file))
        again.set_current_mesh(layer(again, "torus_meso_2").id())
        log()
        for one in (layers, again):
            one.apply_filter(STEP, steps=2)
            assert one.current_mesh().label() == "torus_meso_4"
        assert "was read from its file again" in log()
        assert np.array_equal(layers.current_mesh().vertex_matrix(), again.current_mesh().vertex_matrix())
        for one in (layers, again):
            one.apply_filter(COLLAPSE)
        assert np.array_equal(layers.current_mesh().vertex_matrix(), again.current_mesh().vertex_matrix())
        assert np.array_equal(scalars(again.mesh(0), "mcfskel_node"), scalars(layers.mesh(0), "mcfskel_node"))

    def test_a_skeleton_knows_its_surface(self, project, tmp_path):
        layers, file = project
        again = pymeshlab.MeshSet()
        again.load_project(str(file))
        names = [label for label in labels(layers) if label.endswith("_skeleton")]
        assert len(names) == 1
        for one, path in [(layers, tmp_path / "1.json"), (again, tmp_path / "2.json")]:
            one.set_current_mesh(layer(one, names[0]).id())
            one.apply_filter("save_skeleton_mcf", file=str(path))
        assert '"surface_vertices": [' in (tmp_path / "2.json").read_text()
        again.apply_filter("generate_refined_skeleton_mcf")
        assert "mcfskel_node" in attributes(again.mesh(0)), "found by its geometry"

    def test_saved_twice_and_in_another_folder(self, project, tmp_path):
        layers, file = project
        other = tmp_path / "elsewhere"
        other.mkdir()
        layers.apply_filter(SAVE_PROJECT, file=str(other / "ring"))  # the suffix is added
        for name in ["ring_layers", "ring.mlp"]:
            assert (other / name).exists()
        layers.apply_filter(SAVE_PROJECT, file=str(file))
        again = pymeshlab.MeshSet()
        again.load_project(str(file))
        assert labels(again) == labels(layers)

    @pytest.mark.parametrize("place, own", [(".", "capsule.ply"), ("p_layers", "capsule(1).ply")])
    def test_files_that_layers_came_from_are_left_alone(self, tmp_path, place, own):
        """Beside the project, and in the folder of its layers."""
        (tmp_path / "p_layers").mkdir()
        source = tmp_path / place / "capsule.ply"
        layers = document(arrays("capsule"))
        layers.save_current_mesh(str(source))
        before = source.read_bytes()
        layers.clear()
        layers.load_new_mesh(str(source))
        for _ in range(2):  # the second time there is a file of its own, which is replaced
            layers.apply_filter(SAVE_PROJECT, file=str(tmp_path / "p.mlp"))
            assert source.read_bytes() == before
            assert {p.name for p in (tmp_path / "p_layers").iterdir()} == {own, "capsule.ply"}
        again = pymeshlab.MeshSet()
        again.load_project(str(tmp_path / "p.mlp"))
        assert labels(again) == labels(layers)

    def test_a_failed_one_leaves_the_old_one(self, tmp_path):
        layers = document(arrays("capsule"), arrays("hand"))
        file, folder = tmp_path / "p.mlp", tmp_path / "p_layers"

        def contents() -> dict[Path, bytes]:
            return {p: p.read_bytes() if p.is_file() else b"" for p in tmp_path.rglob("*")}

        layers.apply_filter(SAVE_PROJECT, file=str(file))
        before = contents()
        layers.set_current_mesh(0)
        layers.compute_coord_by_function(x="x + 1")
        first, second = (len(before[folder / f"mesh_{k}.ply"]) for k in range(2))
        assert first < second
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, ((first + second) // 2, limits[1]))
        try:
            text = failing(layers, SAVE_PROJECT, file=str(file))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert "File too large" in text and str(folder / "mesh_1.ply") in text
        assert contents() == before
        layers.apply_filter(SAVE_PROJECT, file=str(file))
        assert contents().keys() == before.keys() and contents() != before

    def test_none_is_left_where_the_project_itself_cannot_be_written(self, tmp_path):
        layers = document(arrays("capsule"))
        (tmp_path / "p.mlp").mkdir()
        assert "Is a directory" in failing(layers, SAVE_PROJECT, file=str(tmp_path / "p.mlp"))
        assert [p.name for p in tmp_path.rglob("*")] == ["p.mlp"]

    def test_odd_layers_are_saved_as_meshes(self, tmp_path, log):
        """One layer that is no valid skeleton or stage does not keep the others from being saved."""
        layers = staged()
        edit(layers, "mcfskel_fixed", "vi < 1 ? sqrt(0-1) : 0")
        for name, edges in [("loop", [[0, 0], [0, 1]]), ("nan", [[0, 1]]), ("thin", [[0, 1]])]:
            layers.add_mesh(pymeshlab.Mesh(vertex_matrix=np.array([[0.0, 0, 0], [1, 0, 0]]),
                                           edge_matrix=np.array(edges, np.int32)), name)
        edit(layers, "mcfskel_radius", "0-1")
        layers.set_current_mesh(layer(layers, "nan").id())
        layers.compute_coord_by_function(x="vi < 1 ? sqrt(0-1) : x")
        log()
        file = tmp_path / "odd.mlp"
        assert layers.apply_filter(SAVE_PROJECT, file=str(file))["layers"] == layers.mesh_number()
        said = log()
        for name in ["capsule_meso_3", "loop", "nan", "thin"]:
            assert f"'{name}' is saved as a mesh" in said
        assert "were changed" not in said and "is lost" not in said, "each is told about once"
        again = pymeshlab.MeshSet()
        again.load_project(str(file))
        assert labels(again) == labels(layers)
        for mesh, saved in zip(layers, again):
            if mesh.label() == "nan":  # MeshLab leaves out what is no number
                continue
            assert np.array_equal(mesh.vertex_matrix(), saved.vertex_matrix()), mesh.label()
            assert np.array_equal(mesh.face_matrix(), saved.face_matrix())
        again.set_current_mesh(layer(again, "capsule_meso_2").id())
        assert again.apply_filter(STEP)["iterations"] == 3, "the others are what they were"

    def test_where_nothing_can_be_written(self, tmp_path):
        layers = document(arrays("capsule"))
        assert "folder" in failing(layers, SAVE_PROJECT, file=str(tmp_path / "none" / "p.mlp"))
        assert "must name the file" in failing(layers, SAVE_PROJECT)
        assert not list(tmp_path.iterdir())


class TestMeshLabsOwnFiles:
    def test_a_stage_is_said_to_have_lost_its_state(self, tmp_path, log):
        layers = staged()
        layers.save_current_mesh(str(tmp_path / "capsule_meso_3.ply"))
        again = pymeshlab.MeshSet(verbose=True)
        again.load_new_mesh(str(tmp_path / "capsule_meso_3.ply"))
        assert "Save Stage" in failing(again, COLLAPSE)
        log()
        assert again.apply_filter(STEP)["iterations"] == 1
        assert "its state is gone" in (said := log()) and "counted from 1" in said

    def test_a_skeleton_is_said_to_have_lost_its_edges(self, tmp_path):
        layers = document(arrays("capsule"))
        layers.apply_filter(FULL, **COARSE)
        layers.save_current_mesh(str(tmp_path / "capsule_skeleton.ply"))
        again = pymeshlab.MeshSet()
        again.load_new_mesh(str(tmp_path / "capsule_skeleton.ply"))
        assert again.current_mesh().edge_number() == 0
        text = failing(again, "generate_pruned_skeleton_mcf")
        assert "no edges any more" in text and "Save Project" in text

    def test_what_save_stage_wrote_is_a_stage_when_opened(self, tmp_path, log):
        layers = staged()
        layers.apply_filter("save_stage_mcf", file=str(tmp_path / "s.ply"))
        layers.apply_filter(STEP)
        again = pymeshlab.MeshSet(verbose=True)
        again.load_new_mesh(str(tmp_path / "s.ply"))
        log()
        assert again.apply_filter(STEP)["iterations"] == 4
        assert "read from its file" in log()
        assert np.array_equal(layers.current_mesh().vertex_matrix(), again.current_mesh().vertex_matrix())

    def test_a_file_that_was_written_over_says_nothing_of_the_layer(self, tmp_path):
        layers = staged()
        file = tmp_path / "s.ply"
        layers.apply_filter("save_stage_mcf", file=str(file))
        again = pymeshlab.MeshSet()
        again.load_new_mesh(str(file))
        layers.apply_filter(STEP, steps=2)
        layers.apply_filter("save_stage_mcf", file=str(file))
        failing(again, COLLAPSE)
