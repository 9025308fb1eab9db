#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a job again and again, each time with less memory than it needs, and tells what came of it.

Each try is a process of its own, split off when all is prepared. In the way "refuse" the allocator of the
preloaded faults.c refuses memory from some request on; in the way "limit" the system does, beyond a limit
to the address space. Prints a list of outcomes as JSON: what the filter said, or nothing if it came to
its end; and whether the document was as before.
"""

import argparse
import ctypes
import json
import os
import random
import resource
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pymeshlab

from conftest import COLLAPSE, FULL, MESHES, POLES, REFINE, RESAMPLE, STEP, fingerprint

#: Requests that are smaller are never refused: the host's own code does not expect that.
SMALLEST = 1024
COARSE = {"target_length": pymeshlab.PercentageValue(2.5)}
SKELETON = [(FULL, COARSE)]
STAGE = [(STEP, {"steps": 2})]
Steps = list[tuple[str, dict[str, Any]]]


def jobs(folder: Path) -> dict[str, tuple[str, Steps, str, dict[str, Any]]]:
    """Of each job its mesh, the filters that come before it, its filter and the parameters."""
    stage, skeleton = str(folder / "stage.ply"), str(folder / "skeleton.cg")
    project = str(folder / "project.mlp")
    return {
        "resample": ("capsule", [], RESAMPLE, COARSE),
        "poles": ("capsule", [], POLES, {}),
        "step": ("capsule", [], STEP, {"steps": 2}),
        "next step": ("capsule", STAGE, STEP, {"steps": 2}),
        "collapse": ("capsule", STAGE, COLLAPSE, {}),
        "collapse, sheets": ("slab", STAGE, COLLAPSE, {"keep_sheets": True}),
        "refine": ("capsule", [(FULL, COARSE | {"refine": False})], REFINE, {}),
        "full": ("capsule", [], FULL, COARSE),
        "full, larger": ("animal", [], FULL, {}),
        "full, raw": ("capsule", [], FULL, {"resample": False}),
        "full, all stages": ("capsule", [], FULL, COARSE | {"keep_stages": 1}),
        "full, sheets": ("slab", [], FULL, COARSE | {"keep_sheets": True}),
        "parts": ("y_tube", SKELETON, "compute_skeleton_parts_mcf", {}),
        "prune": ("y_tube", SKELETON, "generate_pruned_skeleton_mcf", {}),
        "resample skeleton": ("y_tube", SKELETON, "generate_resampled_skeleton_mcf", {}),
        "compare": ("y_tube", SKELETON + [("generate_pruned_skeleton_mcf", {})],
                    "compute_skeleton_distance_mcf", {"other": 3}),
        "measure": ("capsule", SKELETON, "compute_skeleton_measures_mcf", {}),
        "medial axis": ("capsule", [], "generate_medial_axis_mcf", {}),
        "medial balls": ("y_tube", SKELETON, "generate_medial_balls_mcf",
                         {"voxel": pymeshlab.PercentageValue(2)}),
        "save stage": ("capsule", STAGE, "save_stage_mcf", {"file": stage}),
        "load stage": ("capsule", STAGE + [("save_stage_mcf", {"file": stage})],
                       "load_stage_mcf", {"file": stage}),
        "save project": ("capsule", STAGE, "save_project_mcf", {"file": project}),
        "save skeleton": ("capsule", SKELETON, "save_skeleton_mcf", {"file": skeleton}),
        # After a file that cannot be opened the host makes the first layer the current one.
        "load skeleton": ("capsule", SKELETON + [("save_skeleton_mcf", {"file": skeleton}),
                                                 ("set_current_mesh", {"new_curr_id": 0})],
                          "load_new_mesh", {"file_name": skeleton}),
    }


def run(layers: pymeshlab.MeshSet, name: str, parameters: dict[str, Any]) -> None:
    """A filter, or another thing that a document can do."""
    if hasattr(layers, name):
        getattr(layers, name)(**parameters)
    else:
        layers.apply_filter(name, **parameters)


def in_own_process(work: Callable[[], Any]) -> Any:
    """What a function returns in a copy of this process; None if that comes to no good end."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(writing, json.dumps(work()).encode())
            os._exit(0)
        finally:
            os._exit(1)
    os.close(writing)
    with open(reading, "rb") as answer:
        text = answer.read()
    os.waitpid(child, 0)
    return json.loads(text) if text else None


def kilobytes(name: str) -> int:
    """A line of the system's account of this process, such as VmPeak."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(name + ":"))


class Refusing:
    """Memory refused by faults.c, which counts requests."""

    library = ctypes.CDLL(None)

    def start(self, count: int) -> None:
        self.library.refuse_memory(ctypes.c_long(count), ctypes.c_size_t(SMALLEST))

    def stop(self) -> int:
        return self.library.grant_memory()


class Limited:
    """Memory limited by the system, in kilobytes beyond what the process has."""

    def start(self, count: int) -> None:
        self.before = kilobytes("VmSize")
        resource.setrlimit(resource.RLIMIT_AS, (1024 * (self.before + count), -1))

    def stop(self) -> int:
        resource.setrlimit(resource.RLIMIT_AS, (-1, -1))
        return kilobytes("VmPeak") - self.before


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("plugin")
    parser.add_argument("way", choices=["refuse", "limit"])
    parser.add_argument("job")
    parser.add_argument("--tries", type=int, default=10)
    options = parser.parse_args()
    pymeshlab.load_plugin(options.plugin)
    memory = Refusing() if options.way == "refuse" else Limited()
    with tempfile.TemporaryDirectory() as folder:
        mesh, before, name, parameters = jobs(Path(folder))[options.job]
        layers = pymeshlab.MeshSet()
        layers.load_new_mesh(str(MESHES / f"{mesh}.off"))
        for step, values in before:
            run(layers, step, values)
        state = fingerprint(layers)

        def files() -> dict[Path, bytes]:
            return {path: path.read_bytes() for path in Path(folder).rglob("*") if path.is_file()}

        def attempt(count: int) -> tuple[str, bool, int]:
            text, written = "", files()
            memory.start(count)
            try:
                run(layers, name, parameters)
            except (pymeshlab.PyMeshLabException, MemoryError) as error:
                text = str(error) or "MemoryError"
            needed = memory.stop()
            return text, fingerprint(layers) == state and files() == written, needed

        needed = in_own_process(lambda: attempt(1 << 40))[2]
        # More of them below: what a thread sets aside for itself is more than it uses.
        points = [needed * k**3 // options.tries**3 for k in range(options.tries)]
        if options.way == "refuse":  # the very last ones too, when the results become layers
            rng = random.Random(options.job)
            points = [*range(needed - options.tries // 2, needed),
                      *(rng.randrange(needed) for _ in range(options.tries // 2))]
        print(json.dumps([in_own_process(lambda: attempt(max(point, 0))) for point in points]))


if __name__ == "__main__":
    main()
