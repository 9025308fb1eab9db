# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Implicit shapes: functions from points (n, 3) to signed distances (n,), negative inside.

Every field is 1-Lipschitz, so that a coarse sample bounds the fine ones, and is the exact
distance near its surface unless its docstring says otherwise.
"""
from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

Array = np.ndarray
Field = Callable[[Array], Array]


def cone_sphere(x: Array, a: Array, b: Array, ra: Array, rb: Array) -> Array:
    """Distance to the union of the balls between (a, ra) and (b, rb), radius linear between.

    The minimum over t of |x - c(t)| - r(t) is convex in t, hence the clamp is exact.
    """
    length = np.linalg.norm(b - a, axis=-1)
    direction = (b - a) / length[..., None]
    slope = (ra - rb) / length
    along = np.sum((x - a) * direction, axis=-1)
    across = np.sqrt(np.maximum(np.sum((x - a) ** 2, axis=-1) - along**2, 0.0))
    t = np.clip(along - slope * across / np.sqrt(1.0 - slope**2), 0.0, length)
    return np.hypot(along - t, across) - (ra - slope * t)


class Tube:
    """Union of balls along a polyline, radius linear between its points.

    points (n, 3), radii (n,); a closed tube's last point joins its first.
    """

    def __init__(self, points: Array, radii: Array | float, closed: bool = False) -> None:
        self.points = np.asarray(points, float)
        self.radii = np.broadcast_to(np.asarray(radii, float), len(self.points)).copy()
        self.closed = closed
        count = len(self.points)
        self.start = np.arange(count if closed else count - 1)
        self.end = (self.start + 1) % count
        spacing = np.linalg.norm(self.points[self.end] - self.points[self.start], axis=1)
        slope = np.abs(self.radii[self.end] - self.radii[self.start]) / spacing
        # A taper moves the foot of a point along the axis by slope times its distance from it.
        shift = slope.max() * 2.0 * self.radii.max() / spacing.min()
        self.window = int(np.ceil(shift)) + 1
        self.tree = cKDTree(self.points)

    def __call__(self, x: Array) -> Array:
        if len(self.start) == 1:
            a, b = self.points
            ra, rb = self.radii
            return cone_sphere(x, a, b, ra, rb)
        nearest = self.tree.query(x)[1]
        best = np.full(len(x), np.inf)
        for offset in range(-self.window, self.window):
            segment = nearest + offset
            if self.closed:
                segment %= len(self.start)
            else:
                segment = np.clip(segment, 0, len(self.start) - 1)
            i, j = self.start[segment], self.end[segment]
            d = cone_sphere(x, self.points[i], self.points[j], self.radii[i], self.radii[j])
            best = np.minimum(best, d)
        return best


def ball(centre: Array, radius: float) -> Field:
    """Ball."""
    middle = np.asarray(centre, float)
    return lambda x: np.linalg.norm(x - middle, axis=1) - radius


def ellipsoid(half_axes: tuple[float, float, float]) -> Field:
    """Ellipsoid about the origin; not the exact distance, but never more than it."""
    a = np.array(half_axes)
    return lambda x: (np.linalg.norm(x / a, axis=1) - 1.0) * a.min()


def thick_rectangle(half_x: float, half_y: float, radius: float) -> Field:
    """All points within `radius` of the rectangle |x| <= half_x, |y| <= half_y, z = 0."""

    def field(x: Array) -> Array:
        outside = np.maximum(np.abs(x[:, :2]) - (half_x, half_y), 0.0)
        return np.sqrt(np.sum(outside**2, axis=1) + x[:, 2] ** 2) - radius

    return field


def holed_plate(half_length: float, rim: float, hole: float, thickness: float) -> Field:
    """Stadium round |x| <= half_length with three round holes, edges rounded by half a thickness.

    Exact but where the distances to the rim and to a hole are equal.
    """
    radius = thickness / 2.0

    def field(x: Array) -> Array:
        beyond = np.maximum(np.abs(x[:, 0]) - half_length, 0.0)
        outline = np.hypot(beyond, x[:, 1]) - rim
        for centre in (-half_length, 0.0, half_length):
            outline = np.maximum(outline, hole - np.hypot(x[:, 0] - centre, x[:, 1]))
        return np.hypot(np.maximum(outline + radius, 0.0), x[:, 2]) - radius

    return field


def cup_body(radius: float, height: float, wall: float) -> Field:
    """All points within wall / 2 of an open cylinder with a bottom at z = 0."""

    def field(x: Array) -> Array:
        r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
        bottom = np.hypot(np.maximum(r - radius, 0.0), z)
        side = np.hypot(r - radius, np.maximum(z - height, 0.0) + np.minimum(z, 0.0))
        return np.minimum(bottom, side) - wall / 2.0

    return field


def channel(strokes: list[Array], open_ends: list[tuple[int, int]], profile_radius: float,
            half_angle: float, wall: float) -> Field:
    """A gutter along planar strokes: all points within wall / 2 of a swept circular arc.

    strokes: densely sampled polylines (n, 2) of one letter. open_ends: (stroke, 0 for its first
    point or -1 for its last) of the ends that are cut square; the others run into a stroke. The
    arc of `profile_radius` and `half_angle` hangs below z = 0, symmetric about the stroke.
    Exact but where two strokes are equally near.
    """
    start = np.concatenate([s[:-1] for s in strokes])
    end = np.concatenate([s[1:] for s in strokes])
    owner = np.tile(np.arange(len(start)), 2)
    tree = cKDTree(np.concatenate([start, end]))
    tips = []
    for stroke, which in open_ends:
        tip, before = strokes[stroke][which], strokes[stroke][1 if which == 0 else -2]
        tips.append((tip, (tip - before) / np.linalg.norm(tip - before)))

    def to_stroke(q: Array) -> tuple[Array, Array]:
        distance = np.full(len(q), np.inf)
        foot = np.zeros_like(q)
        for column in tree.query(q, k=4)[1].T:
            a, b = start[owner[column]], end[owner[column]]
            t = np.sum((q - a) * (b - a), axis=1) / np.sum((b - a) ** 2, axis=1)
            here = a + np.clip(t, 0.0, 1.0)[:, None] * (b - a)
            gap = np.linalg.norm(q - here, axis=1)
            closer = gap < distance
            distance[closer], foot[closer] = gap[closer], here[closer]
        return distance, foot

    def field(x: Array) -> Array:
        across, foot = to_stroke(x[:, :2])
        excess = np.zeros(len(x))
        for tip, outwards in tips:
            here = np.linalg.norm(foot - tip, axis=1) < 1e-9
            beyond = np.maximum((x[:, :2] - tip) @ outwards, 0.0)
            excess = np.where(here, beyond, excess)
        across = np.sqrt(np.maximum(across**2 - excess**2, 0.0))
        angle = np.clip(np.arctan2(across, -x[:, 2]), 0.0, half_angle)
        gap = np.hypot(across - profile_radius * np.sin(angle),
                       x[:, 2] + profile_radius * np.cos(angle))
        return np.hypot(gap, excess) - wall / 2.0

    return field


def union(fields: list[Field], blend: float = 0.0) -> Field:
    """Union; where two distances differ by less than `blend`, the crease is filled smoothly.

    Nothing changes where all others are farther by `blend` or more.
    """

    def field(x: Array) -> Array:
        result = fields[0](x)
        for other in fields[1:]:
            d = other(x)
            near = np.minimum(result, d)
            if blend > 0.0:
                near = near - np.maximum(blend - np.abs(result - d), 0.0) ** 2 / (4.0 * blend)
            result = near
        return result

    return field
