# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates with holes, bent or flat, and the sheets in their middle."""
from dataclasses import dataclass

import numpy as np

Array = np.ndarray


@dataclass
class Plate:
    """A sheet, (v, 3) points and (t, 3) triangles, and the solid of half a thickness on both sides of it."""

    sheet: Array
    sheet_triangles: Array
    half: float
    holes: int
    vertices: Array
    triangles: Array


def plate(seed: int, edge: float = 0.6) -> Plate:
    """A plate of 16 by 10 with one to five round holes, 0.2 to 0.6 thick, bent to a part of a cylinder."""
    from manifold3d import CrossSection

    rng = np.random.default_rng(seed)
    outline = CrossSection.square((16.0, 10.0), True)
    places: list[Array] = []
    for _ in range(int(rng.integers(1, 6))):
        radius = rng.uniform(0.8, 1.6)
        for _ in range(100):
            at = rng.uniform((-6.0, -3.0), (6.0, 3.0))
            if all(np.linalg.norm(at - other[:2]) > radius + other[2] + 1.0 for other in places):
                places.append(np.append(at, radius))
                break
    for x, y, radius in places:
        outline -= CrossSection.circle(radius, 32).translate((x, y))
    half = float(rng.uniform(0.1, 0.3))
    turn = float(rng.uniform(0.0, 2.0))  # of the long side, radians

    def bent(points: Array) -> Array:
        """The length along x is kept at z = 0, and so is all thickness."""
        if turn < 0.2:
            return points
        arc = 16.0 / turn
        angle = points[:, 0] / arc
        reach = arc + points[:, 2]
        return np.stack([reach * np.sin(angle), points[:, 1], reach * np.cos(angle) - arc], axis=1)

    solid = outline.extrude(2 * half).translate((0, 0, -half)).refine_to_length(edge).to_mesh64()
    vertices = np.array(solid.vert_properties[:, :3])
    sheet = outline.extrude(1.0).refine_to_length(edge / 2).to_mesh64()
    points, faces = np.array(sheet.vert_properties[:, :3]), np.array(sheet.tri_verts, int)
    bottom = faces[(np.abs(points[faces][:, :, 2]) < 1e-9).all(axis=1)]
    return Plate(bent(points * (1, 1, 0)), bottom, half, len(places), bent(vertices),
                 np.array(solid.tri_verts, int))
