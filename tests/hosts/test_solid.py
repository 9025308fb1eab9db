# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Solid: closed two-manifolds of what people have, and their skeletons."""

import numpy as np
import pymeshlab
import pytest

from conftest import FULL, POLES, RESAMPLE, STEP, arrays, diagonal, document, failing, fingerprint, labels, sheet
from filter_names import MEDIAL_AXIS, PRUNE, REFINE, SMOOTH, SOLID
from hostile.primitives import genus, is_two_manifold, signed_volume

Mesh = tuple[np.ndarray, np.ndarray]


def missing(part: float) -> Mesh:
    """The capsule without a part of its faces, chosen at random."""
    vertices, faces = arrays("capsule")
    return vertices, faces[np.random.default_rng(1).random(len(faces)) >= part]


def cut_off() -> Mesh:
    """Without all that is in the last third of its length."""
    vertices, faces = arrays("capsule")
    along = vertices[:, np.argmax(np.ptp(vertices, axis=0))]
    keep = (along[faces] < along.min() + 0.67 * np.ptp(along)).all(axis=1)
    return vertices, faces[keep]


def crossing() -> Mesh:
    """Two capsules that cross at a right angle."""
    vertices, faces = arrays("capsule")
    return (np.vstack([vertices, vertices[:, [1, 0, 2]]]),
            np.vstack([faces, faces[:, ::-1] + len(vertices)]))


def hollow() -> Mesh:
    """A capsule with a smaller one as a cavity."""
    vertices, faces = arrays("capsule")
    return np.vstack([vertices, vertices * 0.4]), np.vstack([faces, faces[:, ::-1] + len(vertices)])


def solid(layers: pymeshlab.MeshSet) -> Mesh:
    mesh = layers.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix().astype(np.int64)


@pytest.mark.parametrize("mesh, repaired", [
    (lambda: missing(0.03), 1), (lambda: missing(0.4), 1), (lambda: missing(0.5), 2), (cut_off, 1), (crossing, 2)])
def test_broken(mesh, repaired):
    layers = document(mesh())
    before = layers.current_mesh().vertex_matrix()
    numbers = layers.apply_filter(SOLID)
    assert numbers["repaired"] == repaired
    assert numbers["wrapped"] == (numbers["repaired"] == 2)
    assert labels(layers)[-1] == "mesh_0_solid"
    assert np.array_equal(layers.mesh(0).vertex_matrix(), before)
    assert is_two_manifold(solid(layers)) and genus(solid(layers)) == 0
    assert signed_volume(solid(layers)) > 0
    assert 0 <= numbers["distance_mean"] <= numbers["distance_max"] < 10


def test_mended_keeps_vertices():
    vertices, faces = missing(0.03)
    layers = document((vertices, faces))
    numbers = layers.apply_filter(SOLID)
    assert numbers["holes_closed"] > 10 and numbers["distance_max"] == 0
    # In single precision, in which all surfaces are read.
    assert np.array_equal(layers.current_mesh().vertex_matrix(), np.float32(vertices[np.unique(faces)]))


def test_sound_stays():
    layers = document(arrays("torus"))
    numbers = layers.apply_filter(SOLID)
    assert (numbers["repaired"], numbers["distance_max"]) == (0, 0)
    assert np.array_equal(layers.current_mesh().vertex_matrix(),
                          np.float32(layers.mesh(0).vertex_matrix()))
    assert np.array_equal(layers.current_mesh().face_matrix(), layers.mesh(0).face_matrix())


@pytest.mark.parametrize("mesh", [lambda: missing(0.03), lambda: missing(0.4), lambda: missing(0.5)])
def test_its_skeleton_is_that_of_the_shape(mesh):
    layers = document(mesh())
    layers.apply_filter(SOLID)
    results = layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
    assert (results["components"], results["cycles"], results["terminals"]) == (1, 0, 2)
    vertices, _ = arrays("capsule")
    nodes = layers.current_mesh().vertex_matrix()
    axis = np.argmax(np.ptp(vertices, axis=0))
    assert np.abs(np.delete(nodes, axis, axis=1)).max() < 0.02 * diagonal(vertices)


def test_a_sheet_is_refused():
    layers = document((np.eye(3), [[0, 1, 2]]))
    before = fingerprint(layers)
    assert "open sheet" in failing(layers, SOLID)
    assert fingerprint(layers) == before


@pytest.mark.parametrize("mesh", [lambda: (np.eye(3), np.array([[0, 1, 2]])), sheet], ids=["flat", "bent"])
def test_a_sheet_gets_the_thickness_that_is_asked_for(mesh):
    vertices, faces = mesh()
    layers = document((vertices, faces))
    results = layers.apply_filter(SOLID, sheet_thickness=pymeshlab.PercentageValue(2))
    assert results["repaired"] == 1 and results["distance_max"] == pytest.approx(1, rel=0.01)
    solid = layers.current_mesh()
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert signed_volume((solid.vertex_matrix(), solid.face_matrix())) == pytest.approx(
        0.02 * diagonal(vertices) * area, rel=0.02)
    skeleton = layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
    assert (skeleton["components"], skeleton["cycles"]) == (1, 0)


def test_full_skeletonize_repairs_by_itself():
    """Nothing is asked of the user; one line in the log says what was done."""
    vertices, faces = missing(0.03)
    layers = document((vertices, faces))
    results = layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
    assert (results["components"], results["cycles"], results["terminals"]) == (1, 0, 2)
    assert (results["repaired"], results["distance_max"]) == (1, 0)
    node = layers.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
    nodes = layers.current_mesh().vertex_matrix()
    used = np.unique(faces)
    assert (np.delete(node, used) == -1).all() and (node[used] >= 0).all()
    away = np.linalg.norm(nodes[node[used].astype(int)] - vertices[used], axis=1)
    assert away.max() < 0.3 * diagonal(vertices)


@pytest.mark.parametrize("mesh", [lambda: missing(0.03), cut_off])
@pytest.mark.parametrize("name", [PRUNE, REFINE, SMOOTH])
def test_a_skeleton_of_what_was_repaired_goes_on(mesh, name):
    """And the mesh, which is no surface by itself, keeps a node for each vertex that had one."""
    layers = document(mesh())
    layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(2.5))
    before = layers.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
    layers.apply_filter(name)
    nodes = layers.current_mesh().vertex_matrix()
    broken, contracted = layers.mesh(0), layers.mesh(1)
    assert labels(layers)[1] == "mesh_0_resampled"
    node = broken.vertex_custom_scalar_attribute_array("mcfskel_node").astype(int)
    assert ((node >= 0) == (before >= 0)).all() and node.max() < len(nodes)
    distance = np.linalg.norm(broken.vertex_matrix()[:, None] - contracted.vertex_matrix()[None], axis=2)
    expected = contracted.vertex_custom_scalar_attribute_array("mcfskel_node")[distance.argmin(axis=1)]
    assert (node == expected)[before >= 0].all(), "that of the nearest vertex of the surface"


def test_full_skeletonize_wraps_by_itself():
    vertices, faces = crossing()
    layers = document((vertices, faces))
    results = layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
    assert (results["components"], results["cycles"], results["terminals"]) == (1, 0, 4)
    assert results["repaired"] == 2
    node = layers.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
    assert (node >= 0).all()


def test_without_resampling_the_solid_is_a_layer():
    vertices, faces = missing(0.03)
    layers = document((vertices, faces))
    layers.apply_filter(FULL, resample=False)
    assert "mesh_0_solid" in labels(layers)


def test_steps_start_from_the_solid():
    vertices, faces = missing(0.03)
    layers = document((vertices, faces))
    results = layers.apply_filter(STEP, steps=2)
    assert results["repaired"] == 1
    assert labels(layers) == ["mesh_0", "mesh_0_solid", "mesh_0_meso_1", "mesh_0_meso_2"]
    results = layers.apply_filter(STEP)
    assert results["iterations"] == 3 and results["repaired"] == 0


def test_small_pieces_get_no_skeleton():
    vertices, faces = arrays("capsule")
    beside = vertices * 0.1 + [0, diagonal(vertices), 0]
    layers = document((np.vstack([vertices, beside]), np.vstack([faces, faces + len(vertices)])))
    results = layers.apply_filter(FULL, min_component=0.01, target_length=pymeshlab.PercentageValue(1.5))
    assert (results["components"], results["pieces_left_out"], results["repaired"]) == (1, 1, 0)
    node = layers.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
    assert (node[:len(vertices)] >= 0).all() and (node[len(vertices):] == -1).all()


def test_no_curve_in_a_cavity():
    layers = document(hollow())
    results = layers.apply_filter(FULL, resample=False)
    assert (results["components"], results["pieces_left_out"]) == (1, 1)
    assert "mesh_0_solid" in labels(layers)
    # The measures take it as outside.
    measured = layers.apply_filter("compute_skeleton_measures_mcf", surface=0)
    assert 0.3 < measured["inside_fraction"] < 0.7
    # So they do on the surface that was contracted, and that has no cavity.
    for resample in (False, True):
        layers = document(hollow())
        layers.apply_filter(FULL, resample=resample)
        assert 0.3 < layers.apply_filter("compute_skeleton_measures_mcf")["inside_fraction"] < 0.7


def test_a_solid_keeps_its_cavity():
    layers = document(hollow())
    layers.apply_filter(SOLID)
    assert np.array_equal(layers.current_mesh().face_matrix(), layers.mesh(0).face_matrix())
    results = layers.apply_filter(FULL, resample=False)
    assert (results["components"], results["pieces_left_out"]) == (1, 1)


def test_without_repair_a_cavity_is_a_body():
    layers = document(hollow())
    assert layers.apply_filter(FULL, repair="off", resample=False)["components"] == 2


def test_pieces_are_joined_by_marked_bridges():
    vertices, faces = arrays("capsule")
    beside = vertices + [0, 0.5 * diagonal(vertices), 0]
    layers = document((np.vstack([vertices, beside]), np.vstack([faces, faces + len(vertices)])))
    results = layers.apply_filter(FULL, join=True, target_length=pymeshlab.PercentageValue(1.5))
    assert (results["components"], results["cycles"], results["bridges"]) == (1, 0, 1)
    mesh = layers.current_mesh()
    bridge = mesh.vertex_custom_scalar_attribute_array("mcfskel_bridge")
    assert sorted(np.unique(bridge)) == [0, 1] and bridge.sum() == 1
    ends = np.setdiff1d(mesh.edge_matrix()[(bridge[mesh.edge_matrix()] > 0).any(axis=1)],
                        np.flatnonzero(bridge))
    assert len(ends) == 2
    between = mesh.vertex_matrix()[ends].mean(axis=0)
    assert np.allclose(mesh.vertex_matrix()[bridge > 0][0], between, atol=1e-5)
    layers.apply_filter("generate_resampled_skeleton_mcf")  # tools take it as any skeleton
    layers.set_current_mesh(mesh.id())
    # Refined, it is joined again, and pieces are refined as if they had never been.
    again = layers.apply_filter("generate_refined_skeleton_mcf")
    assert (again["components"], again["refined"]) == (1, 1)
    refined = layers.current_mesh()
    assert refined.vertex_custom_scalar_attribute_array("mcfskel_bridge").sum() == 1
    layers.apply_filter("generate_pruned_skeleton_mcf")
    assert layers.current_mesh().vertex_custom_scalar_attribute_array("mcfskel_bridge").sum() == 1


#: Filters that leave their surface, unrepaired, in the state of a layer.
LEAVE_SURFACE = [(POLES, {}), (MEDIAL_AXIS, {}), (STEP, {"repair": "off"}),
                 (FULL, {"repair": "off", "resample": False})]


@pytest.mark.parametrize("name, parameters", LEAVE_SURFACE)
@pytest.mark.parametrize("repairing", [SOLID, STEP, FULL])
def test_a_layer_with_state_is_wrapped_like_others(name, parameters, repairing):
    layers = document(crossing())
    layers.apply_filter(name, **parameters)
    layers.set_current_mesh(0)
    assert layers.apply_filter(repairing)["repaired"] == 2
    if repairing == FULL:
        node = layers.mesh(0).vertex_custom_scalar_attribute_array("mcfskel_node")
        assert (node >= 0).all() and node.max() < layers.current_mesh().vertex_number()


@pytest.mark.parametrize("name, parameters", LEAVE_SURFACE)
def test_a_cavity_of_a_layer_with_state_gets_no_curve(name, parameters):
    layers, plain = document(hollow()), document(hollow())
    layers.apply_filter(name, **parameters)
    layers.set_current_mesh(0)
    for one in (layers, plain):
        results = one.apply_filter(FULL, resample=False)
        assert (results["components"], results["pieces_left_out"]) == (1, 1)
    assert np.array_equal(layers.current_mesh().vertex_matrix(), plain.current_mesh().vertex_matrix())
    # Only the one that was asked to be left unrepaired has it as a body.
    layers.set_current_mesh(0)
    assert layers.apply_filter(FULL, repair="off", resample=False)["components"] == 2


@pytest.mark.parametrize("repair", ["auto", "mend", "off"])
def test_a_sound_layer_keeps_its_poles(repair):
    layers = document(arrays("torus"))
    layers.apply_filter(POLES, pole_method="balls")
    before = layers.mesh(0).vertex_custom_point_attribute_matrix("mcfskel_pole")
    layers.apply_filter(STEP, repair=repair)
    assert np.array_equal(layers.mesh(0).vertex_custom_point_attribute_matrix("mcfskel_pole"), before)
    assert labels(layers) == ["mesh_0", "mesh_0_meso_1"]


@pytest.mark.parametrize("name", [FULL, STEP, RESAMPLE])
def test_off_refuses(name):
    layers = document(missing(0.03))
    before = fingerprint(layers)
    assert "border edges" in failing(layers, name, repair="off")
    assert fingerprint(layers) == before


def test_mend_refuses_what_would_be_wrapped():
    layers = document(missing(0.5))
    assert "border edges" in failing(layers, FULL, repair="mend")


@pytest.mark.parametrize("repair", ["auto", "mend", "off"])
def test_a_sound_mesh_is_the_same_with_any_repair(repair):
    reference, layers = document(arrays("torus")), document(arrays("torus"))
    reference.apply_filter(FULL, repair="off", target_length=pymeshlab.PercentageValue(1.5))
    results = layers.apply_filter(FULL, repair=repair, target_length=pymeshlab.PercentageValue(1.5))
    assert results["repaired"] == 0
    assert np.array_equal(layers.current_mesh().vertex_matrix(), reference.current_mesh().vertex_matrix())
    assert np.array_equal(layers.current_mesh().edge_matrix(), reference.current_mesh().edge_matrix())
