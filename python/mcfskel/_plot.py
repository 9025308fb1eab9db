# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons on the screen, by matplotlib, PyVista or trimesh's viewer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._convert import needed
from ._picture import corners_of
from ._run import SkeletonError

if TYPE_CHECKING:
    from ._skeleton import Skeleton

#: matplotlib draws each triangle by itself: beyond this many the surface is shown as points.
MOST_TRIANGLES = 20_000


def plot(skeleton: Skeleton, backend: str, ax: Any, surface: bool) -> Any:
    backends = {"matplotlib": with_matplotlib, "pyvista": with_pyvista, "trimesh": with_trimesh}
    if not isinstance(backend, str) or backend not in backends:
        raise SkeletonError(f"backend={backend!r} is none of {', '.join(backends)}.")
    if ax is not None and backend != "matplotlib":
        raise SkeletonError("ax is for backend='matplotlib' only.")
    shown = skeleton.surface if surface else None
    return with_matplotlib(skeleton, shown, ax) if ax is not None else backends[backend](skeleton, shown)


def with_matplotlib(skeleton: Skeleton, surface: Any, ax: Any = None) -> Any:
    pyplot = needed("matplotlib.pyplot", "plot()")
    art = needed("mpl_toolkits.mplot3d.art3d", "plot()")
    if ax is None:
        ax = pyplot.figure().add_subplot(projection="3d")
    if surface is not None:
        if len(surface.faces) <= MOST_TRIANGLES:
            ax.add_collection3d(art.Poly3DCollection(
                surface.vertices[surface.faces], facecolor=(0.6, 0.7, 0.8, 0.12)))
        else:
            points = corners_of(surface)
            ax.scatter(*points[::len(points) // 5000 or 1].T, s=1,
                       color=(0.6, 0.7, 0.8, 0.3))
    if len(skeleton.faces):
        ax.add_collection3d(art.Poly3DCollection(
            skeleton.nodes[skeleton.faces], facecolor=(0.2, 0.4, 0.7, 0.4)))
    if len(skeleton.edges):
        lines = art.Line3DCollection(skeleton.nodes[skeleton.edges], linewidth=2, cmap="viridis")
        lines.set_array(skeleton.radius[skeleton.edges].mean(axis=1))
        ax.add_collection3d(lines)
        ax.figure.colorbar(lines, ax=ax, shrink=0.6, label="radius")
    points = skeleton.nodes if surface is None else corners_of(surface)
    if len(points):
        low, high = points.min(axis=0), points.max(axis=0)
        margin = 0.02 * max(float((high - low).max()), 1e-300)
        ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin),
               zlim=(low[2] - margin, high[2] + margin))
        ax.set_box_aspect(high - low + 2 * margin)
    return ax


def with_pyvista(skeleton: Skeleton, surface: Any) -> Any:
    pyvista = needed("pyvista", "plot()")
    plotter = pyvista.Plotter()
    if surface is not None:
        faces = np.column_stack([np.full(len(surface.faces), 3), surface.faces]).ravel()
        plotter.add_mesh(pyvista.PolyData(surface.vertices, faces), color="lightsteelblue", opacity=0.25)
    plotter.add_mesh(skeleton.to_pyvista(), scalars="radius", line_width=4)
    return plotter


def with_trimesh(skeleton: Skeleton, surface: Any) -> Any:
    trimesh = needed("trimesh", "plot()")
    scene = trimesh.Scene()
    scene.add_geometry(skeleton.to_trimesh(), geom_name="skeleton")
    if surface is not None:
        mesh = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
        mesh.visual.face_colors = [160, 180, 205, 70]
        scene.add_geometry(mesh, geom_name="surface")
    return scene
