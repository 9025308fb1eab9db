#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the pictures of docs/tools.md and docs/filters.md: what each filter makes of one of the shapes."""

import argparse
import io
from pathlib import Path
from typing import Callable, NamedTuple, Optional, Sequence

import matplotlib
import numpy as np
import pymeshlab

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection, PolyCollection
from PIL import Image

from picture import View, choose_view

ROOT = Path(__file__).resolve().parents[1]
PIXELS = 360
TITLE = 26  # pixels above each panel
PALE = np.array([0.62, 0.71, 0.80])
LIGHT = np.array([0.3, 0.5, 0.81])


class Curve(NamedTuple):
    """A skeleton to draw; without values in one colour."""

    mesh: pymeshlab.Mesh
    values: Optional[np.ndarray] = None


class Panel(NamedTuple):
    """One picture of a row: translucent surfaces, opaque ones with a colour a face, curves, surfaces
    whose triangles show, points with a value each."""

    title: str
    translucent: list
    opaque: list
    curves: list
    triangles: Sequence = ()
    points: Sequence = ()


def percent(value: float) -> pymeshlab.PercentageValue:
    return pymeshlab.PercentageValue(value)


def shaded(points: np.ndarray, faces: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Colours darkened by how far each face is turned away from the light."""
    corners = points[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    facing = np.abs(normal @ LIGHT)
    return colours * (0.35 + 0.65 * facing[:, None])


def draw_faces(axes: plt.Axes, view: View, points: np.ndarray, faces: np.ndarray,
               colours: np.ndarray, alpha: float, edges: str = "") -> None:
    at = view.project(points)
    order = np.argsort(at[faces, 2].mean(axis=1), kind="stable")
    turned = points @ view.axes.T
    rgb = np.clip(shaded(turned, faces, colours), 0, 1)[order]
    axes.add_collection(PolyCollection(
        at[faces[order], :2], facecolors=np.column_stack([rgb, np.full(len(rgb), alpha)]),
        edgecolors=edges or (rgb if alpha == 1 else "none"), linewidths=0.3,
        antialiaseds=alpha == 1))


def draw_panel(axes: plt.Axes, view: View, panel: Panel) -> None:
    for mesh in panel.translucent:
        faces = mesh.face_matrix()
        draw_faces(axes, view, mesh.vertex_matrix(), faces, np.tile(PALE, (len(faces), 1)), 0.06)
    for mesh, colours in panel.opaque:
        draw_faces(axes, view, mesh.vertex_matrix(), mesh.face_matrix(), colours, 1)
    for mesh in panel.triangles:
        faces = mesh.face_matrix()
        draw_faces(axes, view, mesh.vertex_matrix(), faces, np.tile(PALE * 1.4, (len(faces), 1)), 1,
                   edges="#1b2430")
    for points, values in panel.points:
        at = view.project(points)
        axes.scatter(*at[:, :2].T, s=1.2, c=values, cmap="turbo", vmin=0, linewidths=0, zorder=2)
    for curve in panel.curves:
        at = view.project(curve.mesh.vertex_matrix())[:, :2]
        edges = curve.mesh.edge_matrix()
        axes.add_collection(LineCollection(at[edges], colors="#1b2430", linewidths=3.2,
                                           capstyle="round"))
        line = LineCollection(at[edges], linewidths=1.9, capstyle="round")
        if curve.values is None:
            line.set_color("#d2402f")
        else:
            line.set_array(curve.values[edges].mean(axis=1))
            line.set_cmap("turbo")
        axes.add_collection(line)
        degree = np.bincount(edges.ravel(), minlength=len(at))
        ends = at[degree != 2]
        axes.scatter(*ends.T, s=11, c="white", edgecolors="#1b2430", linewidths=0.8, zorder=3)
    axes.text(view.size[0] / 2, -TITLE / 2, panel.title, fontsize=8, ha="center", va="center")


def draw_row(path: Path, shape: np.ndarray, panels: list[Panel], up: str) -> None:
    """Writes a picture of panels side by side, all seen the same way."""
    view = choose_view(shape, up, 25, 12, PIXELS)
    width, height = view.size
    figure, all_axes = plt.subplots(
        1, len(panels), figsize=(len(panels) * width / 100, (height + TITLE) / 100), squeeze=False)
    for axes, panel in zip(all_axes[0], panels):
        draw_panel(axes, view, panel)
        axes.set_xlim(0, width)
        axes.set_ylim(height, -TITLE)
        axes.set_aspect("equal")
        axes.set_axis_off()
    figure.subplots_adjust(0, 0, 1, 1, 0, 0)
    pixels = io.BytesIO()
    figure.savefig(pixels, dpi=100)
    plt.close(figure)
    # A palette keeps the files small.
    Image.open(pixels).convert("RGB").quantize(256).save(path, optimize=True)


class Scene:
    """A shape, the surface that was contracted, and its skeleton."""

    def __init__(self, name: str, **options) -> None:
        self.layers = pymeshlab.MeshSet()
        self.layers.load_new_mesh(str(ROOT / "meshes" / f"{name}.off"))
        self.layers.apply_filter("generate_curve_skeleton_mcf", **options)
        self.skeleton = self.layers.current_mesh()
        self.surface = next(m for m in self.layers if m.label() == f"{name}_resampled")

    def run(self, name: str, start: pymeshlab.Mesh, **options) -> pymeshlab.Mesh:
        """Runs a filter on a layer and returns the layer that is current afterwards."""
        self.layers.set_current_mesh(start.id())
        self.layers.apply_filter(name, **options)
        return self.layers.current_mesh()


def face_colours(mesh: pymeshlab.Mesh) -> np.ndarray:
    return mesh.face_color_matrix()[:, :3]


def quality_colours(mesh: pymeshlab.Mesh) -> np.ndarray:
    values = mesh.vertex_scalar_array()[mesh.face_matrix()].mean(axis=1)
    return plt.get_cmap("turbo")(values / max(values.max(), 1e-300))[:, :3]


def parts(scene: Scene) -> list[Panel]:
    scene.run("compute_skeleton_parts_mcf", scene.skeleton)
    return [Panel("parts", [], [(scene.surface, face_colours(scene.surface))], []),
            Panel("local thickness", [], [(scene.surface, quality_colours(scene.surface))], []),
            Panel("branches", [scene.surface], [], [Curve(scene.skeleton)])]


def rough_curve(scene: Scene) -> pymeshlab.Mesh:
    """The skeleton as the contraction leaves it."""
    return scene.run("generate_curve_skeleton_from_meso_mcf",
                     next(m for m in scene.layers if "_meso_" in m.label()))


def prune(scene: Scene) -> list[Panel]:
    rough = rough_curve(scene)
    few = scene.run("generate_pruned_skeleton_mcf", rough, min_length=percent(12))
    fewer = scene.run("generate_pruned_skeleton_mcf", rough, min_length=percent(30))
    return [Panel(title, [scene.surface], [], [Curve(mesh)]) for title, mesh in [
        ("skeleton", rough), ("min_length 12 %", few), ("min_length 30 %", fewer)]]


def smooth(scene: Scene) -> list[Panel]:
    rough = rough_curve(scene)
    panels = [Panel("skeleton", [scene.surface], [], [Curve(rough)])]
    for length in [1, 4]:
        mesh = scene.run("generate_resampled_skeleton_mcf", rough, smoothing=percent(length))
        panels.append(Panel(f"smoothing {length} %", [scene.surface], [], [Curve(mesh)]))
    return panels


def compare(scene: Scene) -> list[Panel]:
    plain = Scene(scene.surface.label().replace("_resampled", ""), w_m=0.0)
    other = plain.skeleton
    scene.layers.add_mesh(pymeshlab.Mesh(vertex_matrix=other.vertex_matrix(),
                                         edge_matrix=other.edge_matrix()), "plain")
    other = scene.layers.current_mesh()
    scene.run("compute_skeleton_distance_mcf", scene.skeleton, other=other.id())
    return [Panel("w_m = 40", [scene.surface], [], [Curve(scene.skeleton)]),
            Panel("w_m = 0", [scene.surface], [], [Curve(other)]),
            Panel("distance", [scene.surface], [],
                  [Curve(scene.skeleton, scene.skeleton.vertex_scalar_array())])]


def measure(scene: Scene) -> list[Panel]:
    scene.run("compute_skeleton_measures_mcf", scene.skeleton)
    return [Panel("distance to the medial axis", [scene.surface], [],
                  [Curve(scene.skeleton, scene.skeleton.vertex_scalar_array())])]


def medial_axis(scene: Scene) -> list[Panel]:
    panels = []
    for angle in [30, 120]:
        medial = scene.run("generate_medial_axis_mcf", scene.surface, min_angle=float(angle))
        panels.append(Panel(f"min_angle {angle} degrees", [scene.surface],
                            [(medial, quality_colours(medial))], []))
    return panels


def balls(scene: Scene) -> list[Panel]:
    union = scene.run("generate_medial_balls_mcf", scene.skeleton)
    return [Panel("surface and skeleton", [scene.surface], [], [Curve(scene.skeleton)]),
            Panel("union of its balls", [],
                  [(union, np.tile(PALE * 1.2, (union.face_number(), 1)))], [])]


def tubes(scene: Scene) -> list[Panel]:
    panels = []
    for title, options in [("constant radius", {"radius": percent(0.8)}), ("local radius", {"local_radius": True})]:
        mesh = scene.run("generate_skeleton_tubes_mcf", scene.skeleton, **options)
        panels.append(Panel(title, [], [(mesh, vertex_colours(mesh))], []))
    return panels


def vertex_colours(mesh: pymeshlab.Mesh) -> np.ndarray:
    return mesh.vertex_color_matrix()[mesh.face_matrix()].mean(axis=1)[:, :3]


def resample(scene: Scene) -> list[Panel]:
    coarse = scene.run("meshing_isotropic_resampling_mcf", scene.layers.mesh(0),
                       target_length=percent(3.5))
    fine = scene.run("meshing_isotropic_resampling_mcf", scene.layers.mesh(0),
                     target_length=percent(1.6))
    return [Panel(title, [], [], [], triangles=[mesh]) for title, mesh in [
        ("surface", scene.layers.mesh(0)), ("target_length 3.5 %", coarse), ("target_length 1.6 %", fine)]]


def solid(scene: Scene) -> list[Panel]:
    whole = scene.layers.mesh(0)
    points, faces = whole.vertex_matrix(), whole.face_matrix()
    random = np.random.default_rng(3)
    left = faces[random.random(len(faces)) > 0.1]
    middle = points[left].mean(axis=1)
    centre = middle[np.argmax(middle @ [0.3, 0.5, 1.0])]
    left = left[np.linalg.norm(middle - centre, axis=1) > 0.12 * np.linalg.norm(np.ptp(points, axis=0))]
    scene.layers.add_mesh(pymeshlab.Mesh(points, left), "broken")
    broken = scene.layers.current_mesh()
    made = scene.run("generate_solid_mcf", broken)
    return [Panel(title, [], [], [], triangles=[mesh]) for title, mesh in [
        ("what is there", broken), ("Make Solid", made)]]


def poles(scene: Scene) -> list[Panel]:
    mesh = scene.surface
    radius = mesh.vertex_custom_scalar_attribute_array("mcfskel_pole_radius")
    centres = mesh.vertex_custom_point_attribute_matrix("mcfskel_pole")
    return [Panel("medial poles", [mesh], [], [], points=[(centres[radius >= 0], radius[radius >= 0])])]


def stages(scene: Scene) -> list[Panel]:
    last = scene.surface
    panels = []
    for steps in [2, 3, 5, 30]:
        last = scene.run("generate_meso_skeleton_mcf", last, steps=steps)
        # The last stage is there already, so that its name gets a number behind it.
        step = last.label().rsplit("_", 1)[1].split("(")[0]
        panels.append(Panel(f"step {step}", [scene.surface],
                            [(last, vertex_colours(last))], []))
    return panels


def curve(scene: Scene) -> list[Panel]:
    last = next(m for m in scene.layers if "_meso_" in m.label())
    plain = rough_curve(scene)
    return [Panel("last stage", [scene.surface], [], [], triangles=[last]),
            Panel("collapsed", [scene.surface], [], [Curve(plain)]),
            Panel("refined", [scene.surface], [], [Curve(scene.skeleton)])]


PICTURES: dict[str, tuple[str, Callable[[Scene], list[Panel]]]] = {
    "parts": ("animal", parts),
    "prune": ("hand", prune),
    "smooth": ("animal", smooth),
    "compare": ("animal", compare),
    "measure": ("animal", measure),
    "medial_axis": ("hand", medial_axis),
    "balls": ("animal", balls),
    "tubes": ("animal", tubes),
    "filters/resample": ("animal450", resample),
    "filters/solid": ("animal450", solid),
    "filters/poles": ("animal", poles),
    "filters/stages": ("hand", stages),
    "filters/curve": ("animal", curve),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", type=Path,
                        default=ROOT / "build/pymeshlab/filter_mcfskel/libfilter_mcfskel.so")
    parser.add_argument("--folder", type=Path, default=ROOT / "docs")
    parser.add_argument("--up", choices=["auto", "x", "y", "z"], default="auto")
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(PICTURES),
                        help=f"which to draw: {', '.join(PICTURES)} (default: all)")
    options = parser.parse_args()
    pymeshlab.load_plugin(str(options.plugin.resolve()))
    for name in options.names:
        shape, make = PICTURES[name]
        scene = Scene(shape)
        panels = make(scene)
        # Those of tools.md are at home in a folder of that name.
        path = options.folder / (f"{name}.png" if "/" in name else f"tools/{name}.png")
        path.parent.mkdir(parents=True, exist_ok=True)
        draw_row(path, scene.surface.vertex_matrix(), panels, options.up)
        print(path)


if __name__ == "__main__":
    main()
