# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own PLY files. MeshLab and its Python module write neither edges nor attributes."""

import io
from pathlib import Path

import numpy as np
from plyfile import PlyData, PlyElement

from whole_file import write_whole


def _write(path: Path, elements: list[PlyElement]) -> None:
    content = io.BytesIO()
    PlyData(elements, byte_order="<").write(content)
    write_whole(path, content.getvalue())


def _vertices(positions: np.ndarray, attributes: dict[str, np.ndarray]) -> PlyElement:
    """Positions in double; each attribute in its array's own type."""
    columns = {"x": positions[:, 0], "y": positions[:, 1], "z": positions[:, 2], **attributes}
    table = np.empty(len(positions), dtype=[(n, c.dtype) for n, c in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return PlyElement.describe(table, "vertex")


def write_skeleton(path: Path, nodes: np.ndarray, edges: np.ndarray, radius: np.ndarray) -> None:
    """Nodes with their radius, also as the quality that MeshLab shows, and edges by node index.

    MeshLab reads the radius as a float only.
    """
    thickness = radius.astype(np.float32)
    table = np.empty(len(edges), dtype=[("vertex1", np.int32), ("vertex2", np.int32)])
    table["vertex1"], table["vertex2"] = edges[:, 0], edges[:, 1]
    _write(path, [_vertices(nodes, {"radius": thickness, "quality": thickness}),
                  PlyElement.describe(table, "edge")])


def write_surface(path: Path, vertices: np.ndarray, faces: np.ndarray,
                  attributes: dict[str, np.ndarray]) -> None:
    """A triangle mesh with further properties of its vertices."""
    table = np.empty(len(faces), dtype=[("vertex_indices", np.int32, (3,))])
    table["vertex_indices"] = faces
    _write(path, [_vertices(vertices, attributes), PlyElement.describe(table, "face")])


def _positions(ply: PlyData) -> np.ndarray:
    return np.column_stack([ply["vertex"][axis] for axis in "xyz"]).astype(float)


def read_skeleton(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes, edges and radius of a file that write_skeleton() made."""
    ply = PlyData.read(str(path))
    edges = np.column_stack([ply["edge"]["vertex1"], ply["edge"]["vertex2"]]).astype(int)
    return _positions(ply), edges, np.asarray(ply["vertex"]["radius"], float)


def read_surface(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a PLY file."""
    ply = PlyData.read(str(path))
    return _positions(ply), np.vstack(ply["face"]["vertex_indices"]).astype(int)
