# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The plugin in pymeshlab, and helpers for what users see of it: layers, attributes, numbers."""

import hashlib
import os
import re
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab
import pytest

from host_programs import Server, meshlabserver

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from filter_names import COLLAPSE, FULL, POLES, REFINE, RESAMPLE, STEP  # noqa: E402, F401

MESHES = ROOT / "meshes"

# A shell's jobs in the background ignore Ctrl-C, and so would all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def plugin() -> Path:
    """Loads the plugin once: pymeshlab refuses to load a file twice."""
    path = Path(os.environ.get(
        "MCFSKEL_PLUGIN", ROOT / "build/pymeshlab/filter_mcfskel/libfilter_mcfskel.so"))
    pymeshlab.load_plugin(str(path))
    return path


@pytest.fixture(scope="session")
def server(tmp_path_factory) -> Iterator[Server]:
    """meshlabserver 2020.09, where it is set up."""
    with meshlabserver(tmp_path_factory.mktemp("home")) as run:
        yield run


def opened(name: str) -> pymeshlab.MeshSet:
    """A document with one of the project's meshes."""
    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(str(MESHES / f"{name}.off"))
    return layers


def arrays(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of one of the project's meshes."""
    layers = opened(name)  # a layer lives no longer than its document
    mesh = layers.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


def sheet() -> tuple[np.ndarray, np.ndarray]:
    """A bent square of 20 x 20 squares, open."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, 21), np.linspace(0, 1, 21), indexing="ij"))
    first = (21 * np.arange(20)[:, None] + np.arange(20)).ravel()
    faces = np.vstack([np.column_stack([first, first + 21, first + 22]),
                       np.column_stack([first, first + 22, first + 1])])
    return np.column_stack([x, y, 0.3 * x**2]), faces


def document(*meshes: tuple[Any, Any]) -> pymeshlab.MeshSet:
    """A document with layers made from (vertices, faces) and called mesh_0, mesh_1, ..."""
    layers = pymeshlab.MeshSet()
    for i, (vertices, faces) in enumerate(meshes):
        vertices = np.asarray(vertices, float).reshape(-1, 3)
        faces = np.asarray(faces, int).reshape(-1, 3)
        layers.add_mesh(pymeshlab.Mesh(vertices, faces), f"mesh_{i}")
    return layers


def labels(layers: pymeshlab.MeshSet) -> list[str]:
    return [mesh.label() for mesh in layers]


def layer(layers: pymeshlab.MeshSet, label: str) -> pymeshlab.Mesh:
    """The layer of that name."""
    return next(mesh for mesh in layers if mesh.label() == label)


def scalars(mesh: pymeshlab.Mesh, name: str) -> np.ndarray:
    return mesh.vertex_custom_scalar_attribute_array(name)


def points(mesh: pymeshlab.Mesh, name: str) -> np.ndarray:
    return mesh.vertex_custom_point_attribute_matrix(name)


def attributes(mesh: pymeshlab.Mesh) -> dict[str, np.ndarray]:
    """All attributes of the project's that a layer carries."""
    found = {}
    for name in ["mcfskel_pole_radius", "mcfskel_fixed", "mcfskel_held", "mcfskel_radius",
                 "mcfskel_significance", "mcfskel_node", "mcfskel_kind"]:
        try:
            found[name] = scalars(mesh, name)
        except pymeshlab.PyMeshLabException:
            pass
    try:
        found["mcfskel_pole"] = points(mesh, "mcfskel_pole")
    except pymeshlab.PyMeshLabException:
        pass
    return found


def fingerprint(layers: pymeshlab.MeshSet) -> list[tuple]:
    """All that a failed filter must leave as it was."""
    def digest(array: np.ndarray) -> str:
        return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()

    state: list[tuple] = [("current", layers.current_mesh_id())]
    for mesh in layers:
        state.append((mesh.id(), mesh.label(), mesh.is_visible(),
                      digest(mesh.vertex_matrix()), digest(mesh.face_matrix()),
                      digest(mesh.edge_matrix()), digest(mesh.transform_matrix()),
                      digest(mesh.vertex_scalar_array()),
                      sorted((name, digest(values)) for name, values in attributes(mesh).items())))
    return state


def failing(layers: pymeshlab.MeshSet, name: str, **parameters: Any) -> str:
    """The text of the error with which a filter fails."""
    with pytest.raises(pymeshlab.PyMeshLabException) as error:
        layers.apply_filter(name, **parameters)
    return str(error.value)


def edges_of(faces: np.ndarray) -> np.ndarray:
    """Each edge of a triangle mesh once."""
    pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(pairs, axis=0)


def euler(mesh: pymeshlab.Mesh) -> int:
    """V - E + F."""
    return mesh.vertex_number() - len(edges_of(mesh.face_matrix())) + mesh.face_number()


def area(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (vertices[faces[:, k]] - vertices.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def components(count: int, edges: np.ndarray) -> int:
    """Connected components of a graph."""
    parent = list(range(count))

    def find(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b in edges:
        parent[find(int(a))] = find(int(b))
    return sum(find(i) == i for i in range(count))


def diagonal(vertices: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


def distances_from_edges(places: np.ndarray, node: np.ndarray, nodes: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """The distance of each place from the nearest of the edges that end at its node."""
    distance = np.linalg.norm(places - nodes[node], axis=1)
    for edge in edges:
        for a, b in (edge, edge[::-1]):
            own = np.flatnonzero(node == a)
            away, step = places[own] - nodes[a], nodes[b] - nodes[a]
            along = (away @ step / (step @ step)).clip(0, 1)
            gap = np.linalg.norm(away - along[:, None] * step, axis=1)
            distance[own] = np.minimum(distance[own], gap)
    return distance


def gui_host(name: str) -> Path:
    """The folder of a MeshLab for the tests; the test is skipped, by name, where there is none."""
    folder = os.environ.get("MCFSKEL_HOST_" + re.sub(r"\W", "_", name).upper())
    if not folder:
        pytest.skip(f"{name} could not be set up on this machine")
    return Path(folder)
