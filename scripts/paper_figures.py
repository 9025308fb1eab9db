# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of pictures: surfaces, stages, points and curves, all of a row seen the same way."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection, PolyCollection
from PIL import Image

from picture import View, choose_view, draw_surface
from whole_file import write_whole

PIXELS = 300
TITLE = 26  # pixels above each panel
PALE = np.array([0.62, 0.71, 0.80])
RED = np.array([0.83, 0.29, 0.22])
GREEN = "#3d8f4a"
LIGHT = np.array([0.3, 0.5, 0.81])

Mesh = tuple[np.ndarray, np.ndarray]  # vertices, triangles


@dataclass
class Panel:
    """One picture: a translucent surface, opaque meshes with their colours, points, curves as
    (nodes, edges); `lines` draws the edges of the opaque ones."""

    title: str
    surface: Mesh | None = None
    opaque: list[tuple[Mesh, np.ndarray]] = field(default_factory=list)
    points: np.ndarray | None = None
    curves: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    lines: bool = False


def draw_opaque(axes: plt.Axes, view: View, mesh: Mesh, colour: np.ndarray, lines: bool) -> None:
    points, triangles = mesh
    if not len(triangles):
        return
    at = view.project(points)
    triangles = triangles[np.argsort(at[triangles, 2].mean(axis=1), kind="stable")]
    turned = points @ view.axes.T
    a, b, c = (turned[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    rgb = np.clip(colour * (0.4 + 0.6 * np.abs(normal @ LIGHT))[:, None], 0, 1)
    axes.add_collection(PolyCollection(at[triangles][:, :, :2], facecolors=rgb,
                                       edgecolors="#1b2430" if lines else rgb, linewidths=0.25))


def draw_panel(axes: plt.Axes, view: View, panel: Panel) -> None:
    width, height = view.size
    if panel.surface is not None:
        axes.imshow(draw_surface(*panel.surface, view), extent=(0, width, height, 0))
    for mesh, colour in panel.opaque:
        draw_opaque(axes, view, mesh, colour, panel.lines)
    if panel.points is not None and len(panel.points):
        at = view.project(panel.points)
        axes.scatter(at[:, 0], at[:, 1], s=1.6, c=GREEN, linewidths=0, alpha=0.8, zorder=2)
    for nodes, edges in panel.curves:
        at = view.project(nodes)[:, :2]
        axes.add_collection(LineCollection(at[edges], colors="#1b2430", linewidths=2.8, zorder=3,
                                           capstyle="round"))
        axes.add_collection(LineCollection(at[edges], colors=[RED], linewidths=1.6, zorder=3,
                                           capstyle="round"))
        ends = at[np.bincount(edges.ravel(), minlength=len(at)) != 2]
        axes.scatter(*ends.T, s=8, c="white", edgecolors="#1b2430", linewidths=0.7, zorder=4)
    axes.text(width / 2, -TITLE / 2, panel.title, fontsize=8, ha="center", va="center")
    axes.set_xlim(0, width)
    axes.set_ylim(height, -TITLE)
    axes.set_aspect("equal")
    axes.set_axis_off()


def draw_rows(path: Path, rows: list[tuple[np.ndarray, list[Panel], dict]], up: str = "auto") -> None:
    """Writes a picture. Each row: the vertices that it shows, its panels, and `turn` and `tilt` of the view."""
    views = [choose_view(vertices, angles.get("up", up), angles.get("turn", 25), angles.get("tilt", 12), PIXELS)
             for vertices, _, angles in rows]
    widths = [view.size[0] * len(panels) for view, (_, panels, _) in zip(views, rows)]
    heights = [view.size[1] + TITLE for view in views]
    total = (max(widths), sum(heights))
    figure = plt.figure(figsize=(total[0] / 100, total[1] / 100))
    top = total[1]
    for view, height, width, (_, panels, _) in zip(views, heights, widths, rows):
        top -= height
        left = (total[0] - width) / 2
        for panel in panels:
            axes = figure.add_axes((left / total[0], top / total[1], view.size[0] / total[0],
                                    height / total[1]))
            draw_panel(axes, view, panel)
            left += view.size[0]
    pixels = io.BytesIO()
    figure.savefig(pixels, dpi=100)
    plt.close(figure)
    small = io.BytesIO()
    Image.open(pixels).convert("RGB").quantize(192).save(small, format="PNG", optimize=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, small.getvalue())
