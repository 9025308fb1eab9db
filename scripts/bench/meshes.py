# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Input meshes of the bench: the project's own, and finer versions of any mesh."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import trimesh
from plyfile import PlyData, PlyElement

SUFFIXES = (".off", ".obj", ".ply", ".stl")


def meshes_in(folder: Path) -> list[Path]:
    return sorted(p for p in folder.iterdir() if p.suffix.lower() in SUFFIXES)


def subdivided(mesh: Path, times: int, folder: Path) -> Path:
    """The mesh with every triangle cut into four, so many times, at its edges' mid-points.

    Written as binary PLY with positions in double precision; made once. Meshes of one name have folders of
    their own, by their content.
    """
    content = hashlib.sha256(mesh.read_bytes()).hexdigest()[:16]
    target = folder / content / f"{mesh.stem}_x{4 ** times}.ply"
    if target.exists():
        return target
    points, triangles = read_mesh(mesh)
    for _ in range(times):
        points, triangles = trimesh.remesh.subdivide(points, triangles)
    return write_mesh(target, points, triangles)


def read_mesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, (V, 3), and triangles, (F, 3), coincident vertices made one."""
    mesh = trimesh.load(path, process=False, force="mesh")
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces, int)


def write_mesh(path: Path, points: np.ndarray, triangles: np.ndarray) -> Path:
    """Writes binary PLY with positions in double precision; whole or not at all."""
    vertex = np.empty(len(points), dtype=[("x", "f8"), ("y", "f8"), ("z", "f8")])
    vertex["x"], vertex["y"], vertex["z"] = np.asarray(points).T
    face = np.empty(len(triangles), dtype=[("vertex_indices", "i4", (3,))])
    face["vertex_indices"] = triangles
    path.parent.mkdir(parents=True, exist_ok=True)
    elements = [PlyElement.describe(vertex, "vertex"), PlyElement.describe(face, "face")]
    unfinished = path.with_suffix(".part")
    PlyData(elements).write(str(unfinished))
    unfinished.rename(path)
    return path
