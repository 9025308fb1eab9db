#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one of the Python peers on a mesh, as a process of its own, and prints its figures as JSON.

pygel     local separators at several scales (Baerentzen and Rotenberg 2021), from PyGEL3D
skeletor  its implementation of mean curvature skeletons, without splits and medial term
compas_cgal  CGAL's mean curvature skeletons, in the package of that name
atc08     mesh contraction (Au et al. 2008), all three steps: see atc08.py
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from pathlib import Path

import numpy as np
import trimesh

from atc08 import atc08


def pygel(mesh: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    from pygel3d import graph

    surface = graph.Graph()
    for point in mesh.vertices:
        surface.add_node(point)
    for a, b in mesh.edges_unique:
        surface.connect_nodes(int(a), int(b))
    skeleton = graph.MSLS_skeleton(surface)
    skeleton.cleanup()
    edges = [(a, b) for a in skeleton.nodes() for b in skeleton.neighbors(a) if a < b]
    return np.array(skeleton.positions()), np.array(edges, int).reshape(-1, 2)


def skeletor(mesh: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    from skeletor import skeletonize

    skeleton = skeletonize.by_mean_curvature(mesh, progress=False)
    return np.array(skeleton.vertices), np.array(skeleton.edges, int).reshape(-1, 2)


def compas_cgal(mesh: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    from compas_cgal.skeletonization import mesh_skeleton

    ends = np.array(mesh_skeleton((mesh.vertices, mesh.faces)), float).reshape(-1, 3)
    points, place = np.unique(ends, axis=0, return_inverse=True)
    return points, place.reshape(-1, 2)


def mesh_contraction(mesh: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    skeleton, _, _ = atc08(np.asarray(mesh.vertices, float), np.asarray(mesh.faces, int))
    return skeleton.points, skeleton.edges


PEERS = {"pygel": pygel, "skeletor": skeletor, "compas_cgal": compas_cgal, "atc08": mesh_contraction}


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("peer", choices=PEERS)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--skeleton", type=Path, help="write the skeleton, as OBJ")
    return parser.parse_args()


def main() -> None:
    arguments = parse_arguments()
    mesh = trimesh.load(arguments.mesh, process=False, force="mesh")
    wall, cpu = time.perf_counter(), time.process_time()
    points, edges = PEERS[arguments.peer](mesh)
    seconds = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}
    if arguments.skeleton:
        lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in points]
        lines += [f"l {a + 1} {b + 1}" for a, b in edges]
        arguments.skeleton.write_text("\n".join(lines) + "\n")
    report = {
        "program": arguments.peer,
        "mesh": str(arguments.mesh),
        "vertices": len(mesh.vertices),
        "seconds": {"skeleton": seconds},
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(report))


if __name__ == "__main__":
    main()
