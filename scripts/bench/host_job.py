#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole default job through pymeshlab, timed as the bench times the bare library.

Runs in the environment of scripts/requirements.txt. Counted is the filter: reading the layer,
the job itself, and writing the new layers and attributes; not the reading of the file. MeshLab's
own copies of the stages that were kept are timed beside it.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from pathlib import Path

import pymeshlab


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("plugin", type=Path)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--target-length", type=float, default=0.5, help="%% of the diagonal")
    parser.add_argument("--keep-stages", type=int, default=0, metavar="K")
    parser.add_argument("--skeleton", type=Path, help="write the skeleton, as OBJ")
    return parser.parse_args()


def main() -> None:
    arguments = parse_arguments()
    pymeshlab.load_plugin(str(arguments.plugin.resolve()))
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(arguments.mesh))
    wall, cpu = time.perf_counter(), time.process_time()
    results = meshes.apply_filter(
        "generate_curve_skeleton_mcf",
        target_length=pymeshlab.PercentageValue(arguments.target_length),
        keep_stages=arguments.keep_stages,
    )
    seconds = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}
    if arguments.skeleton:
        curve = meshes.current_mesh()
        lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in curve.vertex_matrix()]
        lines += [f"l {a + 1} {b + 1}" for a, b in curve.edge_matrix()]
        arguments.skeleton.write_text("\n".join(lines) + "\n")
    stages = [mesh.id() for mesh in meshes if "_meso_" in mesh.label()]
    begin = time.perf_counter()
    for stage in stages:
        meshes.set_current_mesh(stage)
        meshes.apply_filter("generate_copy_of_current_mesh")
    report = {
        "program": "pymeshlab",
        "mesh": str(arguments.mesh),
        "iterations": results["iterations"],
        "seconds": {"skeleton": seconds},
        "kept": len(stages),
        "copy_seconds": (time.perf_counter() - begin) / len(stages),
        "stages": {k: v for k, v in results.items() if k.startswith("seconds_")},
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(report))


if __name__ == "__main__":
    main()
