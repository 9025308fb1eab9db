# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of a method that is written in Python: a mesh in, an OBJ of lines and a report out."""

from __future__ import annotations

import argparse
import json
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

# Nodes (N, 3), edges (E, 2), seconds of each phase, and what else the report has.
Result = tuple[np.ndarray, np.ndarray, dict[str, float], dict[str, Any]]


def peer_command(name: str, description: str, method: Callable[[np.ndarray, np.ndarray], Result]) -> None:
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--skeleton", type=Path, help="write the skeleton, as OBJ")
    arguments = parser.parse_args()
    mesh = trimesh.load(arguments.mesh, process=False, force="mesh")
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    nodes, edges, seconds, more = method(np.asarray(mesh.vertices, float), np.asarray(mesh.faces, int))
    if arguments.skeleton:
        lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in nodes]
        lines += [f"l {a + 1} {b + 1}" for a, b in edges]
        arguments.skeleton.write_text("\n".join(lines) + "\n")
    print(json.dumps({
        "program": name,
        "mesh": str(arguments.mesh),
        "vertices": len(mesh.vertices),
        **more,
        "seconds": {phase: {"cpu": value, "wall": value} for phase, value in seconds.items()},
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }))
