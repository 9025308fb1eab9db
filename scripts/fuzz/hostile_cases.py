# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases in files: a mesh as OFF, all digits, and beside it as JSON what is expected of it."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from hostile.expectation import Expectation, Hostile


def write_off(path: Path, vertices: np.ndarray, faces: np.ndarray) -> None:
    with path.open("w") as file:
        file.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        for x, y, z in np.asarray(vertices, float).tolist():
            file.write(f"{x!r} {y!r} {z!r}\n")
        for a, b, c in np.asarray(faces).tolist():
            file.write(f"3 {a} {b} {c}\n")


def read_off(path: Path) -> tuple[np.ndarray, np.ndarray]:
    lines = path.read_text().split("\n")
    count, triangles, _ = map(int, lines[1].split())
    vertices = np.array([[float(x) for x in line.split()] for line in lines[2: 2 + count]], float)
    faces = np.array([[int(x) for x in line.split()[1:]]
                      for line in lines[2 + count: 2 + count + triangles]], int)
    return vertices.reshape(-1, 3), faces.reshape(-1, 3)


def write_case(path: Path, mesh: Hostile, **more: Any) -> None:
    """Writes PATH.off and PATH.json, and PATH_solid.off if the mesh stands for another surface."""
    write_off(path.with_suffix(".off"), mesh.vertices, mesh.faces)
    if mesh.solid is not None:
        write_off(path.with_name(path.stem + "_solid.off"), *mesh.solid)
    path.with_suffix(".json").write_text(
        json.dumps({"expected": asdict(mesh.expected), **more}, indent=1) + "\n")


def read_case(path: Path) -> Hostile:
    vertices, faces = read_off(path.with_suffix(".off"))
    expected = Expectation(**json.loads(path.with_suffix(".json").read_text())["expected"])
    solid = path.with_name(path.stem + "_solid.off")
    return Hostile(vertices, faces, expected, read_off(solid) if solid.exists() else None)
