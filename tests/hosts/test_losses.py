# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each program finds of a skeleton in each file: every cell of the table in docs/formats.md is what that
program's own reader gives."""

import json
import os
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Optional

import morphio
import networkx
import numpy as np
import pymeshlab
import pytest
import trimesh
from plyfile import PlyData

from conftest import FULL, ROOT, opened, scalars

COLUMNS = ["nodes", "edges", "cycles", "radius", "surface vertices"]
COARSE = {"target_length": pymeshlab.PercentageValue(1.5)}

Found = dict[str, bool]


class Plate:
    """The skeleton of a plate with three holes, in a document of its own."""

    def __init__(self) -> None:
        self.layers = opened("plate3")
        assert self.layers.apply_filter(FULL, **COARSE)["cycles"] == 3
        mesh = self.layers.current_mesh()
        self.nodes, self.edges = mesh.vertex_matrix(), mesh.edge_matrix()
        self.radius = scalars(mesh, "mcfskel_radius")
        self.surface = self.layers.mesh(1)

    def save(self, path: Path) -> Path:
        self.layers.apply_filter("save_skeleton_mcf", file=str(path))
        return path

    def export(self, path: Path) -> Path:
        """By the host's own export."""
        self.layers.save_current_mesh(str(path))
        return path

    def compare(self, nodes: np.ndarray, edges: np.ndarray, radius: Optional[np.ndarray] = None,
                sources: Optional[int] = None) -> Found:
        """What of the skeleton is there; nodes may be in another order, and in single precision."""
        near = np.linalg.norm(np.asarray(nodes, float)[:, None] - self.nodes[None], axis=2)
        number = near.argmin(axis=1)
        all_nodes = near.min(axis=1).max() < 1e-5 and len(set(number)) == len(self.nodes)
        pairs = {frozenset(number[e].tolist()) for e in np.asarray(edges, int).reshape(-1, 2)}
        wanted = {frozenset(e) for e in self.edges.tolist()}
        assert pairs <= wanted
        return {"nodes": all_nodes, "edges": len(pairs) >= len(wanted) - 3, "cycles": pairs == wanted,
                "radius": radius is not None and np.allclose(radius, self.radius[number], rtol=1e-5),
                "surface vertices": sources == self.surface.vertex_number()}


@pytest.fixture(scope="module")
def plate() -> Plate:
    return Plate()


def of_mesh(plate: Plate, path: Path) -> Found:
    """What MeshLab shows of a file: the radius is the quality."""
    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(str(path))
    mesh = layers.current_mesh()
    return plate.compare(mesh.vertex_matrix(), mesh.edge_matrix(),
                         mesh.vertex_scalar_array() if mesh.has_vertex_scalar() else None)


def by_networkx(plate: Plate, graph: networkx.Graph, position: Callable[[dict], list],
                count: Callable[[dict], int]) -> Found:
    nodes = [data for _, data in graph.nodes(data=True)]
    return plate.compare(np.array([position(n) for n in nodes]), np.array(list(graph.edges)),
                         np.array([n["radius"] for n in nodes]), sum(count(n) for n in nodes))


def graphml_in_networkx(plate: Plate, folder: Path) -> Found:
    graph = networkx.read_graphml(plate.export(folder / "s.graphml"), node_type=int)
    return by_networkx(plate, graph, lambda n: [n["x"], n["y"], n["z"]],
                       lambda n: len((n["surface_vertices"] or "").split()))


def json_in_networkx(plate: Plate, folder: Path) -> Found:
    graph = networkx.node_link_graph(json.loads(plate.save(folder / "s.json").read_text()), edges="edges")
    return by_networkx(plate, graph, lambda n: n["position"], lambda n: len(n["surface_vertices"]))


def swc_in_morphio(plate: Plate, folder: Path) -> Found:
    neuron = morphio.Morphology(str(plate.export(folder / "s.swc")))
    points, radius, edges = [], [], []
    for section in neuron.iter():
        first = len(points)
        points += section.points.tolist()
        radius += (section.diameters / 2).tolist()
        edges += [[k, k + 1] for k in range(first, len(points) - 1)]
    return plate.compare(np.array(points), np.array(edges), np.array(radius))


def ply_in_plyfile(plate: Plate, folder: Path) -> Found:
    ply = PlyData.read(str(plate.save(folder / "s.ply")))
    return plate.compare(np.column_stack([ply["vertex"][axis] for axis in "xyz"]),
                         np.column_stack([ply["edge"]["vertex1"], ply["edge"]["vertex2"]]),
                         ply["vertex"]["mcfskel_radius"], (ply["mcfskel_surface"]["node"] >= 0).sum())


def lines_in_trimesh(plate: Plate, path: Path) -> Found:
    loaded = trimesh.load(str(path))
    edges = [[a, b] for entity in getattr(loaded, "entities", [])
             for a, b in zip(entity.points[:-1], entity.points[1:])]
    return plate.compare(loaded.vertices, np.array(edges, int).reshape(-1, 2))


def glb_in_trimesh(plate: Plate, folder: Path) -> Found:
    scene = trimesh.load(str(plate.save(folder / "s.glb")))
    surface = scene.to_geometry()
    assert len(surface.faces) == plate.surface.face_number()
    return dict.fromkeys(COLUMNS, False)


def elsewhere(program: str, path: Path) -> dict:
    """What a program finds that runs in another Python; the test is skipped where there is none."""
    python = os.environ.get("MCFSKEL_READERS_PYTHON")
    if not python:
        pytest.skip("MCFSKEL_READERS_PYTHON names no Python with scripts/requirements-readers.txt")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    run = subprocess.run([python, str(Path(__file__).with_name("other_readers.py")), program, str(path)],
                         capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout.rpartition("ANSWER")[2])


def found_elsewhere(program: str, plate: Plate, path: Path) -> Found:
    found = elsewhere(program, path)
    if "error" in found or path.suffix == ".glb":
        return dict.fromkeys(COLUMNS, False)
    radius = found.get("radius")
    return plate.compare(np.array(found["nodes"]), np.array(found["edges"], int).reshape(-1, 2),
                         None if radius is None else np.array(radius), found.get("sources"))


def refused_by_meshio(plate: Plate, folder: Path) -> Found:
    assert "SystemExit" in elsewhere("meshio", plate.save(folder / "s.ply"))["error"]
    return dict.fromkeys(COLUMNS, False)


def glb_in_blender(plate: Plate, folder: Path) -> Found:
    found = elsewhere("Blender", plate.save(folder / "s.glb"))
    assert len(found["nodes"]) == plate.surface.vertex_number()
    return dict.fromkeys(COLUMNS, False)


READERS: dict[tuple[str, str], Callable[[Plate, Path], Found]] = {
    ("`.swc`", "morphio"): swc_in_morphio,
    ("`.swc`", "MeshLab"): lambda p, f: of_mesh(p, p.export(f / "s.swc")),
    ("`.swc`", "navis"): lambda p, f: found_elsewhere("navis", p, p.export(f / "s.swc")),
    ("`.cg`", "MeshLab"): lambda p, f: of_mesh(p, p.export(f / "s.cg")),
    ("`.graphml`", "networkx"): graphml_in_networkx,
    ("`.json`", "networkx"): json_in_networkx,
    ("`.vtp`", "VTK"): lambda p, f: found_elsewhere("VTK", p, p.export(f / "s.vtp")),
    ("`.ply`", "plyfile"): ply_in_plyfile,
    ("`.ply`", "MeshLab"): lambda p, f: of_mesh(p, p.save(f / "s.ply")),
    ("`.ply`", "trimesh"): lambda p, f: lines_in_trimesh(p, p.save(f / "s.ply")),
    ("`.ply`", "Blender"): lambda p, f: found_elsewhere("Blender", p, p.save(f / "s.ply")),
    ("`.ply`", "VTK"): lambda p, f: found_elsewhere("VTK", p, p.save(f / "s.ply")),
    ("`.ply`", "meshio"): refused_by_meshio,
    ("`.glb`", "trimesh"): glb_in_trimesh,
    ("`.glb`", "Blender"): glb_in_blender,
    ("`.ply`, MeshLab's own", "MeshLab"): lambda p, f: of_mesh(p, p.export(f / "s.ply")),
    ("`.obj`, MeshLab's own", "trimesh"): lambda p, f: lines_in_trimesh(p, p.export(f / "s.obj")),
    ("`.obj`, MeshLab's own", "Blender"): lambda p, f: found_elsewhere("Blender", p, p.export(f / "s.obj")),
    ("`.obj`, MeshLab's own", "meshio"): lambda p, f: found_elsewhere("meshio", p, p.export(f / "s.obj")),
}


def table() -> dict[tuple[str, str], list[str]]:
    section = (ROOT / "docs" / "formats.md").read_text().split("## What each program finds")[1].split("\n## ")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in re.findall(r"^\|.*\|$", section, re.MULTILINE)]
    assert rows[0] == ["file", "read by", *COLUMNS]
    return {(row[0], row[1]): row[2:] for row in rows[2:]}


def test_every_reader_is_in_the_table():
    assert set(table()) == set(READERS)


@pytest.mark.parametrize("file, program", READERS)
def test_the_table_tells_what_is_found(plate: Plate, tmp_path: Path, file: str, program: str):
    found = READERS[file, program](plate, tmp_path)
    assert table()[file, program] == ["yes" if found[column] else "no" for column in COLUMNS]


def test_an_armature_poses_in_blender(tmp_path: Path):
    """One root that moves all, weights that add up, a bone that bends its limb and leaves the rest, and no triangle
    that is torn."""
    layers = opened("animal450")
    layers.apply_filter(FULL, **COARSE)
    nodes = layers.current_mesh().vertex_matrix()
    layers.apply_filter("save_skeleton_mcf", file=str(tmp_path / "s.glb"))
    posed = elsewhere("pose", tmp_path / "s.glb")
    assert "error" not in posed, posed
    rest, moved, bent = (np.array(posed[key]) for key in ("rest", "moved", "bent"))
    assert len(rest) == layers.mesh(1).vertex_number() and posed["roots"] == 1 and len(posed["bones"]) > 10
    assert np.allclose(posed["weights"], 1, atol=1e-5)
    # Not one vertex is left behind.
    assert np.allclose(moved - rest, [0.5, 0.25, 0.125], atol=1e-4)
    way = np.linalg.norm(bent - rest, axis=1)
    assert (way > 0.01).any() and (way < 1e-5).mean() > 0.5
    # Smooth across the joint, which is within a limb: turned by 0.6 radians, no edge grows by half.
    ends = np.array([(face[k - 1], face[k]) for face in posed["faces"] for k in range(3)])
    lengths = [np.linalg.norm(place[ends[:, 0]] - place[ends[:, 1]], axis=1) for place in (rest, bent)]
    assert (lengths[1] / lengths[0]).max() < 1.5
    # Bones stand in the skeleton, whichever way up Blender holds it.
    heads = np.array([head for head, _, _ in posed["bones"]])[:, [0, 2, 1]] * [1, 1, -1]
    away = [np.linalg.norm(place[:, None] - nodes[None], axis=2).min(axis=1).max()
            for place in (heads, np.array([head for head, _, _ in posed["bones"]]))]
    assert min(away) < 1e-4
