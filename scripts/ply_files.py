# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own PLY files. MeshLab and its Python module write neither edges nor attributes."""

import io
import json
from pathlib import Path

import numpy as np
from plyfile import PlyData, PlyElement

from whole_file import write_whole

MADE_OF = "made of "
LONGEST_COMMENT = 400  # MeshLab reads lines of up to 510 characters


def _write(path: Path, elements: list[PlyElement], *comments: str) -> None:
    content = io.BytesIO()
    PlyData(elements, byte_order="<", comments=list(comments)).write(content)
    write_whole(path, content.getvalue())


def _vertices(positions: np.ndarray, attributes: dict[str, np.ndarray]) -> PlyElement:
    """Positions in double; each attribute in its array's own type."""
    columns = {"x": positions[:, 0], "y": positions[:, 1], "z": positions[:, 2], **attributes}
    table = np.empty(len(positions), dtype=[(n, c.dtype) for n, c in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return PlyElement.describe(table, "vertex")


def write_skeleton(path: Path, nodes: np.ndarray, edges: np.ndarray, radius: np.ndarray, mesh: str) -> None:
    """Nodes with their radius, also as the quality that MeshLab shows, and edges by node index.

    MeshLab reads the radius as a float only. The name of the mesh's file is in a comment.
    """
    comment = MADE_OF + json.dumps(mesh)
    thickness = radius.astype(np.float32)
    table = np.empty(len(edges), dtype=[("vertex1", np.int32), ("vertex2", np.int32)])
    table["vertex1"], table["vertex2"] = edges[:, 0], edges[:, 1]
    _write(path, [_vertices(nodes, {"radius": thickness, "quality": thickness}),
                  PlyElement.describe(table, "edge")], *[comment] * (len(comment) <= LONGEST_COMMENT))


def mesh_of_skeleton(path: Path) -> str | None:
    """The name of the mesh's file in a file that write_skeleton() made; None if it says none, or is not there."""
    try:
        with open(path, "rb") as lines:
            for line in lines:
                if line.startswith(b"comment " + MADE_OF.encode()):
                    return json.loads(line.split(b" ", 3)[3])
                if line.startswith(b"end_header"):
                    return None
    except (OSError, ValueError):
        pass
    return None


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
