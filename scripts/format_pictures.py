#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the pictures of docs/formats.md and docs/python.md, from files that the plugin wrote."""

import argparse
import tempfile
from pathlib import Path

import matplotlib
import numpy as np
import pymeshlab
from plyfile import PlyData

from picture import branch_numbers, choose_view, draw_surface

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (after the choice of the backend)
from matplotlib.collections import LineCollection  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
PIXELS = 700
BLUE, RED = "#24557a", "#d0342c"


def panels(path: Path, count: int, view) -> tuple[plt.Figure, list[plt.Axes]]:
    """A row of empty panels in which pixels of the view are units."""
    width, height = view.size
    figure, axes = plt.subplots(1, count, figsize=(count * width / 200, height / 200), squeeze=False)
    for panel in axes[0]:
        panel.set_xlim(0, width)
        panel.set_ylim(height, 0)
        panel.set_aspect("equal")
        panel.set_axis_off()
    figure.subplots_adjust(0, 0, 1, 1, 0.02, 0)
    path.parent.mkdir(parents=True, exist_ok=True)
    return figure, list(axes[0])


def surface(panel: plt.Axes, view, vertices: np.ndarray, faces: np.ndarray) -> None:
    panel.imshow(draw_surface(vertices, faces, view), extent=(0, *view.size, 0))


def lines(panel: plt.Axes, view, ends: np.ndarray, colour, width: float = 2.5) -> None:
    """Segments given by their ends, #S by 2 by 3."""
    pixels = view.project(ends.reshape(-1, 3))[:, :2].reshape(-1, 2, 2)
    panel.add_collection(LineCollection(pixels, colors=colour, linewidths=width, capstyle="round"))


def opened(name: str) -> pymeshlab.MeshSet:
    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(str(ROOT / "meshes" / f"{name}.off"))
    return layers


def cuts(path: Path, scratch: Path) -> None:
    layers = opened("plate3")
    shape = layers.mesh(0)
    layers.apply_filter("generate_curve_skeleton_mcf")
    file = scratch / "plate3.swc"
    layers.save_current_mesh(str(file))
    rows = np.loadtxt(file)
    at = rows[:, 2:5]
    tree = np.array([(int(r[0]) - 1, int(r[6]) - 1) for r in rows if r[6] > 0])
    cut = np.array([[int(word) - 1 for word in line.split()[-2:]]
                    for line in file.read_text().splitlines() if line.startswith("# cycle cut")])
    view = choose_view(shape.vertex_matrix(), "auto", 25, 12, 2 * PIXELS)
    figure, (panel,) = panels(path, 1, view)
    surface(panel, view, shape.vertex_matrix(), shape.face_matrix())
    lines(panel, view, at[tree], BLUE)
    lines(panel, view, at[cut], RED, 5)
    middle = view.project(at[cut].mean(axis=1))
    panel.scatter(middle[:, 0], middle[:, 1], s=260, facecolors="none", edgecolors=RED, linewidths=1.5)
    figure.savefig(path, dpi=100)


def stage(path: Path, scratch: Path) -> None:
    layers = opened("animal")
    shape = layers.mesh(0)
    layers.apply_filter("generate_meso_skeleton_mcf", steps=2)
    file = scratch / "animal_meso_2.ply"
    layers.apply_filter("save_stage_mcf", file=str(file))
    ply = PlyData.read(str(file))
    vertices = np.column_stack([ply["vertex"][axis] for axis in "xyz"])
    faces = np.vstack(ply["face"]["vertex_indices"])
    again = pymeshlab.MeshSet()
    again.apply_filter("load_stage_mcf", file=str(file))
    while not again.apply_filter("generate_meso_skeleton_mcf", steps=10)["converged"]:
        pass
    again.apply_filter("generate_curve_skeleton_from_meso_mcf")
    curve = again.current_mesh()
    view = choose_view(shape.vertex_matrix(), "auto", 25, 12, 2 * PIXELS)
    figure, (left, right) = panels(path, 2, view)
    surface(left, view, vertices, faces)
    # Where the stage has already become a curve its triangles are too thin to be seen.
    lines(left, view, vertices[np.concatenate([faces[:, :2], faces[:, 1:]])], "#7d8fa0", 0.6)
    surface(right, view, shape.vertex_matrix(), shape.face_matrix())
    lines(right, view, curve.vertex_matrix()[curve.edge_matrix()], BLUE)
    figure.savefig(path, dpi=100)


def correspondence(path: Path, _: Path) -> None:
    layers = opened("animal")
    shape = layers.mesh(0)
    layers.apply_filter("generate_curve_skeleton_mcf")
    curve = layers.current_mesh()
    edges = curve.edge_matrix()
    branch_of_edge = branch_numbers(curve.vertex_number(), edges)
    branch = np.zeros(curve.vertex_number(), int)
    branch[edges] = branch_of_edge[:, None]
    node = shape.vertex_custom_scalar_attribute_array("mcfskel_node").astype(int)
    colours = plt.get_cmap("tab20")(np.arange(20))
    view = choose_view(shape.vertex_matrix(), "auto", 25, 12, 2 * PIXELS)
    figure, (panel,) = panels(path, 1, view)
    at = view.project(shape.vertex_matrix())
    order = np.argsort(at[:, 2], kind="stable")  # near ones over far ones
    panel.scatter(at[order, 0], at[order, 1], s=5, linewidths=0, c=colours[branch[node[order]] % 20])
    lines(panel, view, curve.vertex_matrix()[edges], "#1b2430", 3.5)
    lines(panel, view, curve.vertex_matrix()[edges], colours[branch_of_edge % 20], 2)
    figure.savefig(path, dpi=100)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", type=Path, required=True,
                        help="what scripts/build.sh pymeshlab prints")
    parser.add_argument("--folder", type=Path, default=ROOT / "docs" / "formats",
                        help="where the pictures go (docs/formats)")
    options = parser.parse_args()
    pymeshlab.load_plugin(str(options.plugin))
    with tempfile.TemporaryDirectory() as scratch:
        for draw in (cuts, stage, correspondence):
            draw(options.folder / f"{draw.__name__}.png", Path(scratch))


if __name__ == "__main__":
    main()
