#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a curve skeleton inside its translucent surface. Needs neither a display nor OpenGL."""

import argparse
import io
from pathlib import Path
from typing import NamedTuple

import numpy as np

from whole_file import write_whole

SURFACE_COLOUR = np.array([0.62, 0.71, 0.80])
LIGHT = np.array([-0.35, 0.55, 0.76])


class View(NamedTuple):
    """An orthographic camera: rows are right, up and towards the viewer."""

    axes: np.ndarray
    centre: np.ndarray
    scale: float  # pixels for each mesh unit
    size: tuple[int, int]  # width, height

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixel x, pixel y (downwards) and depth (larger is nearer) of points, #P by 3."""
        local = (points - self.centre) @ self.axes.T * self.scale
        return np.column_stack(
            [local[:, 0] + self.size[0] / 2, self.size[1] / 2 - local[:, 1], local[:, 2]])


def rotation(axis: np.ndarray, degrees: float) -> np.ndarray:
    """The rotation about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def upward_axis(centred: np.ndarray) -> int:
    """y, as most files have it, unless left and right seem to lie along y: then z."""
    spread = np.maximum(centred.std(axis=0), 1e-300)
    skewness = np.abs(np.mean((centred / spread) ** 3, axis=0))
    return 2 if skewness[1] < 0.05 and skewness[2] > 2 * skewness[1] else 1


def choose_view(vertices: np.ndarray, up: str, turn: float, tilt: float, pixels: int) -> View:
    """Looks along the level direction in which the shape is thinnest, turned a little for depth."""
    centred = vertices - vertices.mean(axis=0)
    up_axis = "xyz".index(up) if up != "auto" else upward_axis(centred)
    upwards = np.eye(3)[up_axis]
    level = np.delete(np.eye(3), up_axis, axis=0)
    flat = centred @ level.T
    _, directions = np.linalg.eigh(flat.T @ flat)
    towards = directions[:, 0] @ level
    # A fixed side of the two, so that pictures of like shapes look alike.
    towards *= np.sign(towards[np.argmax(np.abs(towards))])
    towards = rotation(upwards, turn) @ towards
    right = np.cross(upwards, towards)
    towards = rotation(right, -tilt) @ towards
    axes = np.array([right, np.cross(towards, right), towards])

    local = vertices @ axes.T
    low, high = local.min(axis=0), local.max(axis=0)
    extent = np.maximum(high - low, 1e-300)[:2]
    scale = 0.92 * pixels / extent.max()
    # Long thin shapes get room above and below, for the legend.
    size = tuple(int(s) for s in np.maximum(np.ceil(extent * scale / 0.92) + 0.04 * pixels, pixels / 3))
    return View(axes, (low + high) / 2 @ axes, scale, size)


def vertex_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    corners = vertices[faces]
    face_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, faces[:, k], face_normals)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def fragments(pixels: np.ndarray, faces: np.ndarray):
    """Yields (face, weights, pixel index x, y) of all pixel centres covered by the faces, in chunks.

    Faces of like size are done together, so that the work is a few array operations a size.
    """
    corners = pixels[faces][:, :, :2]
    low = np.floor(corners.min(axis=1)).astype(int)
    side = (np.ceil(corners.max(axis=1)).astype(int) - low).max(axis=1) + 1
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    power = 1
    while power < 2 * side.max():
        chosen = np.flatnonzero((side <= power) & (side > power // 2) & (area != 0))
        grid = np.stack(np.meshgrid(np.arange(power), np.arange(power)), axis=-1).reshape(-1, 2)
        for part in np.array_split(chosen, len(chosen) * len(grid) // 2_000_000 + 1):
            if not len(part):
                continue
            at = low[part][:, None, :] + grid[None, :, :] + 0.5
            weights = np.empty(at.shape[:2] + (3,))
            for k, (p, q) in enumerate([(b, c), (c, a), (a, b)]):
                p, q = p[part][:, None, :], q[part][:, None, :]
                weights[..., k] = (q[..., 0] - p[..., 0]) * (at[..., 1] - p[..., 1]) \
                    - (q[..., 1] - p[..., 1]) * (at[..., 0] - p[..., 0])
            weights /= area[part][:, None, None]
            inside = (weights >= 0).all(axis=2)
            which, _ = np.nonzero(inside)
            place = at[inside].astype(int)
            yield part[which], weights[inside], place[:, 0], place[:, 1]
        power *= 2


def draw_surface(vertices: np.ndarray, faces: np.ndarray, view: View) -> np.ndarray:
    """The translucent surface on white, height by width by 3.

    Every layer of the surface dims what is behind it, more where it is seen at a grazing angle; the
    nearest layer is lit as well, which shows the shape.
    """
    width, height = view.size
    pixels = view.project(vertices)
    normals = vertex_normals(vertices, faces) @ view.axes.T
    light = LIGHT / np.linalg.norm(LIGHT)
    clear = np.zeros(height * width)  # sum of the logarithms of what each layer lets through
    nearest = np.full(height * width, -np.inf)
    front_normal = np.zeros((height * width, 3))
    for face, weights, x, y in fragments(pixels, faces):
        seen = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        face, weights, place = face[seen], weights[seen], (y * width + x)[seen]
        normal = np.einsum("fk,fkd->fd", weights, normals[faces[face]])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        grazing = 1 - np.abs(normal[:, 2])
        clear += np.bincount(place, np.log(1 - 0.07 - 0.22 * grazing ** 2), len(clear))
        depth = np.einsum("fk,fk->f", weights, pixels[faces[face], 2])
        order = np.argsort(depth, kind="stable")
        order = order[depth[order] > nearest[place[order]]]
        nearest[place[order]] = depth[order]
        front_normal[place[order]] = normal[order]

    covered = np.isfinite(nearest)
    through = np.exp(clear)[:, None]
    colour = through + (1 - through) * SURFACE_COLOUR * 0.9
    normal = front_normal * np.where(front_normal[:, 2:] < 0, -1, 1)
    diffuse = np.clip(normal @ light, 0, 1)
    half = light + [0, 0, 1]
    shine = np.clip(normal @ (half / np.linalg.norm(half)), 0, 1) ** 40
    lit = SURFACE_COLOUR * (0.45 + 0.62 * diffuse[:, None]) + 0.25 * shine[:, None]
    opacity = np.where(covered, 0.30 + 0.45 * (1 - normal[:, 2]) ** 2, 0)[:, None]
    colour = colour * (1 - opacity) + lit * opacity
    return np.clip(colour, 0, 1).reshape(height, width, 3)


def branch_numbers(count: int, edges: np.ndarray) -> np.ndarray:
    """The branch of each edge: maximal chains between nodes of degree other than 2."""
    degree = np.bincount(edges.ravel(), minlength=count)
    parent = np.arange(len(edges))

    def find(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    first: dict[int, int] = {}
    for edge, ends in enumerate(edges):
        for node in ends:
            if degree[node] == 2:
                if node in first:
                    parent[find(edge)] = find(first[node])
                else:
                    first[node] = edge
    roots = np.array([find(e) for e in range(len(edges))], dtype=int)
    return np.unique(roots, return_inverse=True)[1] if len(edges) else roots


def draw(vertices: np.ndarray, faces: np.ndarray, nodes: np.ndarray, edges: np.ndarray,
         radius: np.ndarray, path: Path, colour: str = "radius", up: str = "auto",
         turn: float = 25, tilt: float = 12, pixels: int = 1200, line_width: float = 1) -> None:
    """Writes the picture, a PNG file; see main() for the options. `line_width`: times the usual one."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection

    oversampling = 2
    view = choose_view(vertices, up, turn, tilt, pixels * oversampling)
    image = draw_surface(vertices, faces, view)
    width, height = view.size

    dpi = 100
    bar = 0.9 if colour == "radius" else 0  # inches for the colour bar
    inches = np.array([width, height]) / oversampling / dpi
    figure = plt.figure(figsize=(inches[0] + bar, inches[1]), dpi=dpi)
    axes = figure.add_axes((0, 0, inches[0] / (inches[0] + bar), 1))
    axes.imshow(image, interpolation="antialiased", extent=(0, width, height, 0))
    axes.set_axis_off()

    at = view.project(nodes)
    order = np.argsort(at[edges, 2].mean(axis=1), kind="stable")  # far edges first
    edges = edges[order]
    segments = at[edges][:, :, :2]
    # A line that is wider than the shape would hide it: at most a third of its thickest place.
    thickest = 2 * float(radius.max(initial=0)) * view.scale / oversampling * 72 / dpi
    thick = min(4.2 * line_width * pixels / 1200, max(thickest / 3, 0.8))
    rim = min(2.2, thick)
    # Each edge with its own outline, so that a near branch visibly passes over a far one.
    outline = LineCollection(segments, colors="#1b2430", linewidths=thick + rim, capstyle="round")
    line = LineCollection(segments, linewidths=thick, capstyle="round")
    if colour == "radius":
        line.set_array(radius[edges].mean(axis=1))
        line.set_cmap("plasma")
        line.set_clim(0, max(float(radius.max(initial=0)), 1e-300))
    else:
        branch = branch_numbers(len(nodes), edges)
        dark_first = np.array([*range(0, 20, 2), *range(1, 20, 2)])
        line.set_color(plt.get_cmap("tab20")(dark_first[branch % 20]))
    axes.add_collection(outline)
    axes.add_collection(line)
    degree = np.bincount(edges.ravel(), minlength=len(nodes))
    special = degree != 2
    axes.scatter(at[special, 0], at[special, 1], s=(1.7 * thick) ** 2, zorder=3, linewidths=1.2,
                 edgecolors="#1b2430", c=np.where(degree[special] == 1, "#ffffff", "#ffb454"))
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    if colour == "radius":
        place = figure.add_axes(((inches[0] + 0.12) / (inches[0] + bar), 0.2, 0.2 / (inches[0] + bar), 0.6))
        figure.colorbar(line, cax=place, label="radius (mesh units)")
    content = io.BytesIO()
    figure.savefig(content, dpi=dpi, format="png")
    plt.close(figure)
    write_whole(path, content.getvalue())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("surface", type=Path, help="PLY file of the surface")
    parser.add_argument("skeleton", type=Path, help="PLY file of the skeleton, with edges")
    parser.add_argument("picture", type=Path, help="PNG file to write")
    parser.add_argument("--colour", choices=["radius", "branch"], default="radius")
    parser.add_argument("--up", choices=["auto", "x", "y", "z"], default="auto")
    parser.add_argument("--turn", type=float, default=25, help="degrees about the up axis")
    parser.add_argument("--tilt", type=float, default=12, help="degrees from above")
    parser.add_argument("--pixels", type=int, default=1200, help="length of the longer side")
    options = parser.parse_args()

    from ply_files import read_skeleton, read_surface
    vertices, faces = read_surface(options.surface)
    nodes, edges, radius = read_skeleton(options.skeleton)
    draw(vertices, faces, nodes, edges, radius, options.picture, options.colour, options.up,
         options.turn, options.tilt, options.pixels)


if __name__ == "__main__":
    main()
