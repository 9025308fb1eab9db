# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the skeleton depends on, and what it must not depend on: one table for each study.

Each study runs this project's program on a mesh, on copies of it that say the same in other words
(finer, moved, renumbered, noisy), or with other weights, and compares the skeletons.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from curve import Curve, mean_distance, read_curve
from damage import DAMAGES, damaged
from meshes import read_mesh, subdivided, write_mesh
from quality import Shape, measure
from stability import NEAR, matched, variants
from symmetry import symmetries_of, without_image
from truth import nearest_on_edges, read_truth, score

SPACING = 0.001  # of the diagonal, at which skeletons are compared
SIZES = (3_000, 400_000)  # vertices of the copies in the study of the resolution
# Iterations in Fig. 5 of the paper, by w_L, at w_H = 20 and w_M = 0.
PAPER_ITERATIONS = {1.5: 26, 3: 12, 6: 6, 12: 3, 24: 2}


@dataclass
class Run:
    """One run of the program."""

    report: dict
    curve: Curve

    def graph(self) -> str:
        r = self.report
        return f"{r['components']} / {r['cycles']} / {r['terminals']} / {r['junctions']}"


@dataclass
class Bench:
    """Where the program is and where its files go."""

    program: Path
    folder: Path

    def run(self, mesh: Path, *options: str) -> Run:
        skeleton = self.folder / "study.obj"
        done = subprocess.run(
            [str(self.program), str(mesh), "--skeleton", str(skeleton), *options],
            capture_output=True, text=True, check=True,
        )
        report = json.loads(done.stdout.strip().splitlines()[-1])
        return Run(report, read_curve(skeleton))


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|---" + "|--:" * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def diagonal(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def apart(one: Curve, other: Curve, size: float) -> str:
    """Mean distance of two skeletons, the larger way, percent of the diagonal."""
    return f"{100 * mean_distance(one, other, SPACING * size) / size:.3f}"


def resolution(bench: Bench, mesh: Path) -> str:
    """The same surface in more and more triangles."""
    size = diagonal(read_mesh(mesh)[0])
    rows, first = [], None
    for times in range(8):
        fine = subdivided(mesh, times, bench.folder / "meshes") if times else mesh
        vertices = len(read_mesh(fine)[0])
        if vertices > SIZES[1]:
            break
        if vertices < SIZES[0]:
            continue
        run = bench.run(fine)
        first = first or run
        rows.append([mesh.stem, str(vertices), run.graph(), apart(first.curve, run.curve, size)])
    return table(["mesh", "vertices", "components / cycles / tips / junctions",
                  "from the first, %"], rows)


def noise(bench: Bench, mesh: Path) -> str:
    """Gaussian noise on every coordinate of every vertex, measured against the clean shape."""
    points, triangles = read_mesh(mesh)
    size = diagonal(points)
    shape = Shape.read(mesh)
    axis = shape.medial_axis()
    rows = []
    for percent in (0, 0.1, 0.2, 0.5):
        bumps = np.random.default_rng(0).normal(size=points.shape) * percent / 100 * size
        noisy = write_mesh(bench.folder / "noisy.ply", points + bumps, triangles)
        run = bench.run(noisy)
        found = measure(shape, axis, run.curve)
        rows.append([mesh.stem, f"{percent:g}", f"{100 * run.report['noise']:.3f}", run.graph(),
                     f"{found['inside']:.4f}", f"{found['medial']:.3f}"])
    return table(["mesh", "noise, %", "measured, %", "components / cycles / tips / junctions",
                  "inside the clean shape", "medial to the clean shape, %"], rows)


def invariance(bench: Bench, mesh: Path) -> str:
    """The same mesh elsewhere, in other units, turned, and in another order."""
    points, triangles = read_mesh(mesh)
    size = diagonal(points)
    angle = 0.7
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    far = 1e4 * size * np.array([1.0, -1.0, 1.0]) / np.sqrt(3)
    order = np.random.default_rng(0).permutation(len(points))
    place = np.argsort(order)
    shuffled = np.random.default_rng(1).permutation(len(triangles))
    Back = Callable[[np.ndarray], np.ndarray]
    copies: list[tuple[str, np.ndarray, np.ndarray, Back]] = [
        ("as it is", points, triangles, lambda p: p),
        ("again", points, triangles, lambda p: p),
        ("scaled by 1e-6", points * 1e-6, triangles, lambda p: p * 1e6),
        ("scaled by 1e6", points * 1e6, triangles, lambda p: p * 1e-6),
        ("moved by 1e4 diagonals", points + far, triangles, lambda p: p - far),
        ("rotated", points @ turn.T, triangles, lambda p: p @ turn),
        ("vertices and faces renumbered", points[order], place[triangles][shuffled], lambda p: p),
    ]
    rows, first = [], None
    for name, moved, faces, back in copies:
        run = bench.run(write_mesh(bench.folder / "moved.ply", moved, faces))
        curve = Curve(back(run.curve.points), run.curve.edges)
        first = first or curve
        rows.append([mesh.stem, name, run.graph(), apart(first, curve, size)])
    return table(["mesh", "copy", "components / cycles / tips / junctions", "from the first, %"], rows)


def weights(bench: Bench, mesh: Path) -> str:
    """One weight or length at a time, the others as the first column says; unrefined."""
    shape = Shape.read(mesh)
    axis = shape.medial_axis()
    sweeps = [
        ("w_L, w_H 20, w_M 0", "--w-l", tuple(PAPER_ITERATIONS), ("--w-m", "0")),
        ("w_L", "--w-l", (0.5, 1, 2, 4), ()),
        ("w_H", "--w-h", (10, 20, 40), ()),
        ("w_M", "--w-m", (0, 10, 20, 40, 80), ()),
        ("epsilon, %", "--epsilon", (0.1, 0.2, 0.4), ()),
    ]
    rows = []
    for name, option, values, others in sweeps:
        for value in values:
            run = bench.run(mesh, "--no-refine", option, f"{value:g}", *others)
            found = measure(shape, axis, run.curve)
            paper = PAPER_ITERATIONS[value] if others else None
            rows.append([
                mesh.stem, name, f"{value:g}",
                f"{run.report['iterations']}" + (f" (paper: {paper})" if paper else ""),
                str(run.report["skeleton_vertices"]), run.graph(),
                f"{found['medial']:.2f}", f"{found['turning']:.1f}",
            ])
    return table(["mesh", "what", "value", "iterations", "nodes",
                  "components / cycles / tips / junctions", "medial, %", "turning, degrees"], rows)


def known(bench: Bench, mesh: Path) -> str:
    """Distance to the skeleton that the shape was made from, where that is known exactly."""
    file = mesh.with_suffix(".json")
    record = json.loads(file.read_text()) if file.is_file() else {}
    exact = record.get("skeleton")
    head = ["mesh", "refined", "components / cycles / tips / junctions", "mean, %", "greatest, %"]
    if not exact or not exact["complete"]:
        return table(head, [])
    nodes, edges = np.array(exact["nodes"]), np.array(exact["edges"])
    certain = np.array(exact["exact"], bool)
    rows = []
    for refined, options in (("yes", ()), ("no", ("--no-refine",))):
        run = bench.run(mesh, *options)
        gaps, edge, _ = nearest_on_edges(run.curve.sampled(SPACING * record["diagonal"])[0], nodes, edges)
        gaps = 100 * gaps[certain[edges[edge]].all(axis=1)] / record["diagonal"]
        rows.append([mesh.stem, refined, run.graph(), *(
            [f"{gaps.mean():.3f}", f"{gaps.max():.3f}"] if len(gaps) else ["-", "-"])])
    return table(head, rows)


def trees(bench: Bench, mesh: Path) -> str:
    """Tips, junctions and places against the centreline of a shape of scripts/generate_trees.py: see truth.Score."""
    file = mesh.with_suffix(".npz")
    head = ["mesh", "found", "missing", "false", "junctions", "cycles", "to truth, %", "from truth, %",
            "to truth, radii", "us a vertex"]
    if not file.is_file():
        return table(head, [])
    truth, run = read_truth(file), bench.run(mesh)
    found = score(truth, run.curve)
    vertices = run.report["input_vertices"] + run.report["vertices"]
    seconds = sum(phase["wall"] if isinstance(phase, dict) else phase
                  for phase in run.report["seconds"].values())
    return table(head, [[
        mesh.stem, str(len(found.tips_found)), str(len(truth.tips) - len(found.tips_found)), str(found.tips_false),
        f"{found.junctions} of {found.true_junctions}", f"{found.cycles} of {found.true_cycles}",
        f"{100 * found.to_truth:.4f}", f"{100 * found.from_truth:.4f}",
        f"{found.to_truth_radii:.3f}", f"{1e6 * seconds / vertices:.1f}"]])


def damage(bench: Bench, mesh: Path) -> str:
    """The same surface damaged in known ways: repaired by default, compared with the skeleton of the sound one."""
    points, triangles = read_mesh(mesh)
    size = diagonal(points)
    sound = bench.run(mesh)
    rows = [[mesh.stem, "none", "sound", sound.graph(), "0", "-",
             f"{sound.report['seconds']['check']['cpu']:.2f}"]]
    for name in DAMAGES:
        broken = write_mesh(bench.folder / "damaged.ply", *damaged(name, points, triangles))
        try:
            run = bench.run(broken)
        except subprocess.CalledProcessError as error:
            rows.append([mesh.stem, name, error.stderr.strip().splitlines()[-1], "-", "-", "-", "-"])
            continue
        rows.append([mesh.stem, name, ("sound", "mended", "wrapped")[run.report["repaired"]], run.graph(),
                     apart(sound.curve, run.curve, size),
                     f"{run.report['distance_mean']:.3f} / {run.report['distance_max']:.3f}",
                     f"{run.report['seconds']['check']['cpu']:.2f}"])
    return table(["mesh", "damage", "made solid", "components / cycles / tips / junctions",
                  "from the sound one's, %", "solid from the input, mean / max %", "check and repair, s"],
                 rows)


def stability(bench: Bench, mesh: Path) -> str:
    """Which terminal branches the copies of a mesh agree on, see stability.variants()."""
    points, triangles = read_mesh(mesh)
    size = diagonal(points)
    values = bench.folder / "significance.txt"
    tips, significance = [], []
    for variant in variants(points, triangles):
        run = bench.run(write_mesh(bench.folder / "variant.ply", variant.points, variant.triangles),
                        "--significance", str(values), *variant.options)
        own = np.flatnonzero(run.curve.degree == 1)
        tips.append(variant.back(run.curve.points[own]))
        significance.append(np.loadtxt(values, ndmin=1)[own])
    counts = [len(own) for own in tips]
    usual = max(counts.count(n) for n in counts)
    branches = matched(tips, NEAR * size)
    others = sorted((len(members), float(np.median([significance[v][tip] for v, tip in members])))
                    for members in branches if len(members) < len(tips))
    return table(["mesh", "variants", "tips", "with the usual number", "branches", "in all variants",
                  "variants that have the others (significance)"],
                 [[mesh.stem, str(len(tips)), f"{min(counts)} to {max(counts)}", str(usual),
                   str(len(branches)), str(len(branches) - len(others)),
                   ", ".join(f"{count} ({value:.2f})" for count, value in others) or "-"]])


def symmetry(bench: Bench, mesh: Path) -> str:
    """Tips whose image under a symmetry of a shape of scripts/generate_trees.py is no tip."""
    head = ["mesh", "symmetries", "tips", "false", "without image", "components / cycles / tips / junctions"]
    file = mesh.with_suffix(".npz")
    if not file.is_file():
        return table(head, [])
    truth, run = read_truth(file), bench.run(mesh)
    maps = symmetries_of(np.load(file)["nodes"])
    found = score(truth, run.curve)
    tips = run.curve.points[run.curve.degree == 1]
    return table(head, [[
        mesh.stem, str(len(maps)), f"{len(found.tips_found)} of {len(truth.tips)}", str(found.tips_false),
        str(len(without_image(tips, maps, NEAR * diagonal(read_mesh(mesh)[0])))), run.graph()]])


STUDIES = {"known answers": known, "damage": damage, "resolution": resolution, "noise": noise,
           "invariance": invariance, "weights": weights, "trees": trees,
           "stability": stability, "symmetry": symmetry}


def study_table(name: str, program: Path, meshes: list[Path], folder: Path) -> str:
    """The table of one study over all meshes."""
    bench = Bench(program, folder)
    folder.mkdir(parents=True, exist_ok=True)
    tables = [STUDIES[name](bench, mesh).splitlines() for mesh in meshes]
    return "\n".join(tables[0][:2] + [row for lines in tables for row in lines[2:]])
