# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small SVG of a skeleton inside its surface, made with numpy alone, for notebooks."""

from __future__ import annotations

import base64
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ._skeleton import Skeleton, Surface

WIDTH = 480
MARGIN = 12
#: Points by which the surface is drawn; enough to leave no gaps at this size.
SAMPLES = 200_000
SURFACE = np.array([0.62, 0.71, 0.80])
LIGHT = np.array([-0.35, 0.55, 0.76])
#: From thin to thick; dark enough for a light and bright enough for a dark page.
THIN, THICK = np.array([0.13, 0.30, 0.72]), np.array([0.91, 0.33, 0.05])


def svg(skeleton: Skeleton) -> str:
    """The picture as the text of an SVG, seen along the direction in which the shape is thinnest."""
    surface = skeleton.surface
    points = skeleton.nodes if surface is None else corners_of(surface)
    if not len(points):
        return ""
    axes = _view(points)
    flat = points @ axes.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    scale = (WIDTH - 2 * MARGIN) / max(float(high[0] - low[0]), float(high[1] - low[1]) / 1.2, 1e-300)
    size = np.maximum(np.ceil((high - low)[:2] * scale + 2 * MARGIN), 2 * MARGIN).astype(int)

    def pixels(values: np.ndarray) -> np.ndarray:
        local = (values @ axes.T - (low + high) / 2) * scale
        return np.column_stack([local[:, 0] + size[0] / 2, size[1] / 2 - local[:, 1], local[:, 2]])

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" '
             f'viewBox="0 0 {size[0]} {size[1]}" fill="none" stroke-linecap="round">']
    if surface is not None and len(surface.faces):
        image = base64.b64encode(_shaded(pixels(surface.vertices), surface.faces, size)).decode()
        parts.append(f'<image width="{size[0]}" height="{size[1]}" opacity="0.45" '
                     f'href="data:image/png;base64,{image}"/>')
    nodes = pixels(skeleton.nodes)
    if len(skeleton.faces):
        triangles = "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in nodes[face, :2]) + "Z"
                            for face in skeleton.faces)
        parts.append(f'<path d="{triangles}" fill="#3b6ea5" fill-opacity="0.35"/>')
    parts += _lines(skeleton, nodes)
    return "".join(parts) + "</svg>"


def corners_of(surface: Surface) -> np.ndarray:
    """The vertices that a face has; others may lie anywhere, and be no numbers."""
    return surface.vertices[np.unique(surface.faces)]


def _view(points: np.ndarray) -> np.ndarray:
    """Rows: right, up, towards the viewer. Up is y, or z where the view is along y."""
    centred = points - points.mean(axis=0)
    _, directions = np.linalg.eigh(centred.T @ centred)
    towards = directions[:, 0] * np.sign(directions[np.argmax(np.abs(directions[:, 0])), 0])
    up = np.eye(3)[1 if abs(towards[1]) < 0.7 else 2]
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def _lines(skeleton: Skeleton, nodes: np.ndarray) -> list[str]:
    radius = skeleton.radius
    low, high = (float(radius.min()), float(radius.max())) if len(radius) else (0.0, 0.0)
    part = (radius - low) / (high - low) if high > low else np.zeros(len(radius))
    lines = []
    for branch in skeleton.branches:
        # Pieces of one colour each: eight steps are as many as the eye tells apart here.
        steps = np.minimum((8 * (part[branch[:-1]] + part[branch[1:]]) / 2).astype(int), 7)
        ends = np.flatnonzero(np.diff(steps)) + 1
        for first, last in zip([0, *ends], [*ends, len(steps)]):
            red, green, blue = (255 * (THIN + (THICK - THIN) * steps[first] / 7)).astype(int)
            path = "L".join(f"{x:.1f} {y:.1f}" for x, y in nodes[branch[first:last + 1], :2])
            lines.append(f'<path d="M{path}" stroke="#{red:02x}{green:02x}{blue:02x}" '
                         'stroke-width="2.5"/>')
    for kind, fill in ((skeleton.leafs, "#222"), (skeleton.junctions, "#c00")):
        lines += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{fill}"/>'
                  for x, y in nodes[kind, :2]]
    return lines


def _shaded(points: np.ndarray, faces: np.ndarray, size: np.ndarray) -> bytes:
    """The surface as a PNG: sampled evenly, the nearest sample of each pixel shaded by its normal."""
    corners = points[faces]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normals = np.cross(b - a, c - a)
    doubled = np.linalg.norm(normals, axis=1)
    total = float(doubled.sum())
    image = np.zeros((size[1], size[0], 4), np.uint8)
    if total > 0:
        ends = np.cumsum(doubled) * (SAMPLES / total)
        face = np.minimum(np.searchsorted(ends, np.arange(SAMPLES) + 0.5), len(faces) - 1)
        # A sequence that covers the unit square evenly (R2), folded into the triangle.
        u, v = (np.arange(SAMPLES) * step % 1 for step in (0.7548776662466927, 0.5698402909980532))
        fold = u + v > 1
        u, v = np.where(fold, 1 - u, u)[:, None], np.where(fold, 1 - v, v)[:, None]
        samples = a[face] + u * (b - a)[face] + v * (c - a)[face]
        column, row = samples[:, :2].astype(int).T
        inside = (column >= 0) & (row >= 0) & (column < size[0]) & (row < size[1])
        order = np.flatnonzero(inside)[np.argsort(samples[inside, 2], kind="stable")]
        # Image rows run downwards, so the light's y is turned.
        light = LIGHT * [1, -1, 1] / np.linalg.norm(LIGHT)
        bright = 0.35 + 0.65 * np.abs(normals[face[order]] @ light) / np.maximum(
            doubled[face[order]], 1e-300)
        image[row[order], column[order], :3] = 255 * np.minimum(bright[:, None] * SURFACE * 1.3, 1)
        image[row[order], column[order], 3] = 255
    return _png(image)


def _png(image: np.ndarray) -> bytes:
    """An RGBA image as PNG."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    height, width = image.shape[:2]
    rows = np.zeros((height, 1 + 4 * width), np.uint8)  # each begins with its filter: none
    rows[:, 1:] = image.reshape(height, -1)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))
