# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cross-sections of a surface by planes normal to its skeleton."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ._skeleton import Skeleton, Surface


class Section(NamedTuple):
    """One closed outline, in the surface's units."""

    area: float
    perimeter: float
    diameter_min: float
    diameter_max: float


NAMES = tuple(f"section_{name}" for name in Section._fields)


def branch_sections(skeleton: Skeleton, branch: np.ndarray, count: int) -> list[Section]:
    """Up to ``count`` sections of a branch, evenly spread over the part between the balls at its ends.

    Where the balls leave nothing between them there is one section, in the middle. A plane in which no outline
    goes once around the curve gives none.
    """
    surface = skeleton.surface
    if surface is None or count < 1:
        return []
    points, radius = skeleton.nodes[branch], skeleton.radius[branch]
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    if along[-1] == 0:
        return []
    is_ring = branch[0] == branch[-1] and skeleton.degree[branch[0]] == 2
    begin, end = (0.0, along[-1]) if is_ring else (radius[0], along[-1] - radius[-1])
    places = begin + (end - begin) * (np.arange(count) + 0.5) / count
    if begin >= end:
        places = np.array([along[-1] / 2])
    corners = surface.vertices[surface.faces]
    sections = []
    for place in places:
        def at(s: float) -> np.ndarray:
            s = s % along[-1] if is_ring else np.clip(s, 0, along[-1])
            return np.array([np.interp(s, along, points[:, k]) for k in range(3)])

        # The direction over half a radius to either side: the nodes of a curve lie closer and less evenly.
        reach = np.interp(place, along, radius) / 2
        normal = at(place + reach) - at(place - reach)
        size = np.linalg.norm(normal)
        section = outline(surface, corners, at(place), normal / size) if size > 0 else None
        if section:
            sections.append(section)
    return sections


def outline(surface: Surface, corners: np.ndarray, point: np.ndarray, normal: np.ndarray) -> Section | None:
    """The closed outline around a point that is cut from a surface by a plane through it.

    Of several, as where the plane cuts other limbs, the one with the smallest area counts. None if none goes
    around the point.
    """
    above = (corners - point) @ normal > 0
    cut = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    if not len(cut):
        return None
    u = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    u /= np.linalg.norm(u)
    axes = np.stack([u, np.cross(normal, u)])
    # The two sides of each triangle that cross the plane, in the order that leaves what is above on the left.
    sides: dict[tuple[int, int], np.ndarray] = {}
    following: dict[tuple[int, int], tuple[int, int]] = {}
    for face in cut:
        ids, up = surface.faces[face], above[face]
        ends = []
        for k in range(3):
            a, b = int(ids[k]), int(ids[(k + 1) % 3])
            if up[k] == up[(k + 1) % 3]:
                continue
            side = (min(a, b), max(a, b))
            if side not in sides:
                p, q = surface.vertices[side[0]] - point, surface.vertices[side[1]] - point
                s, t = p @ normal, q @ normal
                sides[side] = axes @ (p + (q - p) * (s / (s - t)))
            ends.append((side, bool(up[k])))
        down = next(side for side, goes_down in ends if goes_down)
        following[down] = next(side for side, goes_down in ends if not goes_down)
    best = None
    while following:
        first, side = next(iter(following.items()))
        del following[first]
        loop = [sides[first]]
        while side != first and side in following:
            loop.append(sides[side])
            side = following.pop(side)
        if side != first:
            continue  # the surface has a border here
        section = _measured(np.array(loop))
        if section and (best is None or section.area < best.area):
            best = section
    return best


def _measured(loop: np.ndarray) -> Section | None:
    """Of an outline around the origin; None of one that does not go around it."""
    after = np.roll(loop, -1, axis=0)
    crosses = loop[:, 0] * after[:, 1] - loop[:, 1] * after[:, 0]
    turns = np.arctan2(crosses, np.einsum("ij,ij->i", loop, after)).sum() / (2 * np.pi)
    if round(abs(turns)) != 1:
        return None
    hull = _convex_hull(loop)
    steps = np.roll(hull, -1, axis=0) - hull
    normals = np.stack([-steps[:, 1], steps[:, 0]], axis=1)
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals[lengths > 0] / lengths[lengths > 0, None]
    if len(normals) < 2:
        return None
    heights = hull @ normals.T
    across = np.linalg.norm(hull[:, None] - hull[None], axis=2).max()
    return Section(abs(crosses.sum()) / 2, np.linalg.norm(after - loop, axis=1).sum(),
                   (heights.max(axis=0) - heights.min(axis=0)).min(), across)


def _convex_hull(points: np.ndarray) -> np.ndarray:
    """The corners, counter-clockwise (Andrew 1979)."""
    order = np.unique(points, axis=0)

    def half(chain: np.ndarray) -> list[np.ndarray]:
        corners: list[np.ndarray] = []
        for point in chain:
            while len(corners) > 1:
                a, b = corners[-1] - corners[-2], point - corners[-2]
                if a[0] * b[1] - a[1] * b[0] > 0:
                    break
                corners.pop()
            corners.append(point)
        return corners[:-1]

    return np.array(half(order) + half(order[::-1]))
