# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The cures that error messages name, followed to a skeleton of what they leave, with nothing repaired by itself."""

from collections.abc import Callable

import numpy as np
import pymeshlab
import pytest

from conftest import FULL, arrays, document, failing, sheet
from filter_names import SOLID
from hostile.primitives import joined, sphere

Mesh = tuple[np.ndarray, np.ndarray]
Cure = Callable[[pymeshlab.MeshSet], object]
COARSE = {"target_length": pymeshlab.PercentageValue(3)}


def two_tetrahedra(common: int) -> Mesh:
    """With one or two vertices in common."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    if common == 1:
        return np.vstack([vertices, -vertices[1:]]), np.vstack([faces, np.array([0, 4, 5, 6])[faces[:, ::-1]]])
    return (np.vstack([vertices, [[0, -1, 0], [0, 0, -1]]]),
            np.vstack([faces, np.array([0, 1, 4, 5])[faces]]))


def opened() -> Mesh:
    vertices, faces = arrays("capsule")
    return vertices, faces[1:]


def not_a_number() -> Mesh:
    vertices, faces = arrays("capsule")
    vertices = vertices.copy()
    vertices[5, 1] = np.nan
    return vertices, faces


def partly_flat() -> Mesh:
    vertices, faces = sphere(2)
    return joined((vertices, faces), (vertices * [0.3, 0.3, 0] + 3, faces))


def delete_not_finite(layers: pymeshlab.MeshSet) -> None:
    layers.compute_selection_by_condition_per_vertex(
        condselect="x!=x || y!=y || z!=z || abs(x)>1e300 || abs(y)>1e300 || abs(z)>1e300")
    layers.meshing_remove_selected_vertices()
    layers.meshing_close_holes(maxholesize=30)


BY_HAND: list[tuple[str, Callable[[], Mesh], str, Cure]] = [
    ("holes", opened, "Close Holes", lambda m: m.meshing_close_holes(maxholesize=30)),
    ("edges", lambda: two_tetrahedra(2), "Repair non Manifold Edges",
     lambda m: m.meshing_repair_non_manifold_edges(method="Split Vertices")),
    ("vertices", lambda: two_tetrahedra(1), "Repair non Manifold Vertices by splitting",
     lambda m: m.meshing_repair_non_manifold_vertices()),
    ("numbers", not_a_number, "Conditional Vertex Selection", delete_not_finite),
    ("flat", partly_flat, "Remove Isolated pieces (wrt Diameter)",
     lambda m: m.meshing_remove_connected_component_by_diameter(mincomponentdiag=pymeshlab.PureValue(1.2))),
]


@pytest.mark.parametrize("mesh, named, cure", [case[1:] for case in BY_HAND], ids=[case[0] for case in BY_HAND])
def test_by_hand(mesh, named, cure):
    layers = document(mesh())
    assert named in failing(layers, FULL, repair="off")
    cure(layers)
    assert layers.apply_filter(FULL, repair="off", **COARSE)["cycles"] == 0


@pytest.mark.parametrize("mesh", [case[1] for case in BY_HAND[:4]], ids=[case[0] for case in BY_HAND[:4]])
def test_make_solid(mesh):
    layers = document(mesh())
    assert "Make Solid" in failing(layers, FULL, repair="off")
    layers.apply_filter(SOLID)
    assert layers.apply_filter(FULL, repair="off", **COARSE)["cycles"] == 0


def test_a_sheet_is_given_a_thickness():
    layers = document(sheet())
    assert "Make Solid" in failing(layers, FULL)
    layers.apply_filter(SOLID, sheet_thickness=pymeshlab.PercentageValue(1))
    assert layers.apply_filter(FULL, repair="off", **COARSE)["components"] == 1


def test_points_are_made_a_surface():
    points, _ = sphere(3)
    layers = pymeshlab.MeshSet()
    layers.add_mesh(pymeshlab.Mesh(vertex_matrix=points, v_normals_matrix=points), "points")
    assert "Faces" in failing(layers, FULL), "the host's own words: it asks for faces before the filter runs"
    layers.generate_surface_reconstruction_screened_poisson()
    assert layers.apply_filter(FULL, repair="off", **COARSE)["components"] == 1
