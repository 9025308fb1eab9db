#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the pictures of docs/meso_skeletons.md: kinds of vertices, sheets that are kept, held vertices."""

import argparse
from pathlib import Path
from typing import Callable

import numpy as np
import pymeshlab

from tool_pictures import ROOT, Curve, Panel, draw_row

FULL = "generate_curve_skeleton_mcf"
SHEET = np.array([86, 180, 233]) / 255


# A layer lives no longer than its document, and is drawn last.
DOCUMENTS: list[pymeshlab.MeshSet] = []


def opened(shape: str) -> pymeshlab.MeshSet:
    layers = pymeshlab.MeshSet()
    DOCUMENTS.append(layers)
    layers.load_new_mesh(str(ROOT / f"meshes/{shape}.off"))
    return layers


def colours_of_faces(mesh: pymeshlab.Mesh) -> np.ndarray:
    """The mean of the corners' colours."""
    return mesh.vertex_color_matrix()[mesh.face_matrix()][:, :, :3].mean(axis=1)


def stage(layers: pymeshlab.MeshSet, k: int) -> Panel:
    mesh = next(m for m in layers if m.label().endswith(f"_meso_{k}"))
    return Panel(f"stage {k}", [], [(mesh, colours_of_faces(mesh))], [])


def curves_of(mesh: pymeshlab.Mesh) -> list[Curve]:
    """The curves of a skeleton without the vertices of its sheets."""
    edges = mesh.edge_matrix()
    if not len(edges):
        return []
    used, numbered = np.unique(edges, return_inverse=True)
    return [Curve(pymeshlab.Mesh(vertex_matrix=mesh.vertex_matrix()[used],
                                 edge_matrix=numbered.reshape(-1, 2)))]


def skeleton(title: str, layers: pymeshlab.MeshSet) -> Panel:
    """The current layer, sheets and curves, in the translucent surface."""
    mesh = layers.current_mesh()
    sheets = [(mesh, np.tile(SHEET, (mesh.face_number(), 1)))] if mesh.face_number() else []
    return Panel(title, [layers.mesh(0)], sheets, curves_of(mesh))


def kinds(shape: str) -> list[Panel]:
    layers = opened(shape)
    layers.apply_filter(FULL, keep_sheets=True, keep_stages=1)
    last = max(int(m.label().rsplit("_", 1)[1]) for m in layers if "_meso_" in m.label())
    return [stage(layers, k) for k in (1, 3, last)] + [skeleton("skeleton", layers)]


def thresholds(shape: str) -> list[Panel]:
    panels = []
    for threshold in (0.5, 0.85, 1):
        layers = opened(shape)
        layers.apply_filter(FULL, keep_sheets=True, sheet_threshold=threshold)
        panels.append(skeleton(f"threshold {threshold}", layers))
    return panels


def held(shape: str) -> list[Panel]:
    panels = []
    for fix_selected in (False, True):
        layers = opened(shape)
        points = layers.mesh(0).vertex_matrix()
        ends = points[[points[:, 1].argmin(), points[:, 1].argmax(), points[:, 0].argmin()]]
        near = 1e-6 * np.linalg.norm(np.ptp(points, axis=0))
        layers.compute_selection_by_condition_per_vertex(condselect="||".join(
            f"((x-({x}))^2+(y-({y}))^2+(z-({z}))^2<{near ** 2})" for x, y, z in ends))
        layers.apply_filter(FULL, refine=False, fix_selected=fix_selected)
        panels.append(skeleton("three vertices held" if fix_selected else "none held", layers))
    return panels


PICTURES: dict[str, tuple[str, Callable[[str], list[Panel]]]] = {
    "kinds": ("cup", kinds),
    "slab": ("slab", kinds),
    "plates": ("plate3", kinds),
    "thresholds": ("cup", thresholds),
    "held": ("hand", held),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", type=Path,
                        default=ROOT / "build/pymeshlab/filter_mcfskel/libfilter_mcfskel.so")
    parser.add_argument("--folder", type=Path, default=ROOT / "docs/meso")
    parser.add_argument("--up", choices=["auto", "x", "y", "z"], default="z")
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(PICTURES),
                        help=f"which to draw: {', '.join(PICTURES)} (default: all)")
    options = parser.parse_args()
    pymeshlab.load_plugin(str(options.plugin.resolve()))
    options.folder.mkdir(parents=True, exist_ok=True)
    for name in options.names:
        shape, make = PICTURES[name]
        surface = opened(shape)
        draw_row(options.folder / f"{name}.png", surface.mesh(0).vertex_matrix(), make(shape),
                 options.up)
        print(options.folder / f"{name}.png")


if __name__ == "__main__":
    main()
