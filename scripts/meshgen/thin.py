# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin shapes: bodies that are nearly sheets, each with the Betti numbers of its solid."""
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .fields import Array
from .grids import box_grid, capped, revolved


@dataclass
class ThinShape:
    vertices: Array
    faces: Array
    betti: tuple[int, int, int] = (1, 0, 0)


def plate(percent: float) -> ThinShape:
    """A square plate, its thickness in percent of its diagonal."""
    return ThinShape(*box_grid((1.0, 1.0, percent / 100 * np.sqrt(2.0)), 0.05))


def bowl(opening: float, wall: float) -> ThinShape:
    """A spherical shell of radius 1 with a hole, its half angle in degrees."""
    a = np.linspace(np.pi, np.radians(opening), 40)
    radii = np.concatenate([np.sin(a), (1 - wall) * np.sin(a[::-1])])
    heights = np.concatenate([np.cos(a), (1 - wall) * np.cos(a[::-1])])
    return ThinShape(*capped(radii, heights, 80))


def tube(inner: float, length: float) -> ThinShape:
    """The wall of a pipe of radius 1."""
    heights = np.linspace(-length / 2, length / 2, 41)
    profile = np.concatenate([np.stack([np.full(41, 1.0), heights], 1),
                              np.stack([np.full(41, inner), heights[::-1]], 1)])
    return ThinShape(*revolved(profile[:, 0], profile[:, 1], 80), (1, 1, 0))


def ring(inner: float, thickness: float) -> ThinShape:
    """A flat ring of radius 1."""
    radii = np.linspace(inner, 1.0, 12)
    profile = np.concatenate([np.stack([radii, np.full(12, -thickness / 2)], 1),
                              np.stack([radii[::-1], np.full(12, thickness / 2)], 1)])
    return ThinShape(*revolved(profile[:, 0], profile[:, 1], 80), (1, 1, 0))


def ear(root: float, tip: float, bend: float) -> ThinShape:
    """A leaf that gets thinner and narrower from its root to its tip, and is bent across."""
    v, f = box_grid((1.0, 1.0, 0.06), 0.05)
    along, across, side = v[:, 1] + 0.5, v[:, 0], v[:, 2] / 0.06
    width = 0.7 * (1 - 0.7 * along**2)
    thickness = root + (tip - root) * along
    x = across * width
    return ThinShape(np.stack([x, along, bend * x**2 + side * thickness], 1), f)


THIN: dict[str, Callable[[], ThinShape]] = {
    "plate 1 %": lambda: plate(1.0),
    "plate 0.5 %": lambda: plate(0.5),
    "plate 0.2 %": lambda: plate(0.2),
    "plate 0.1 %": lambda: plate(0.1),
    "bowl": lambda: bowl(90.0, 0.05),
    "nearly closed bowl": lambda: bowl(15.0, 0.05),
    "pipe wall": lambda: tube(0.9, 4.0),
    "ring": lambda: ring(0.5, 0.03),
    "ear": lambda: ear(0.12, 0.01, 0.6),
    "thin ear": lambda: ear(0.04, 0.004, 0.6),
}
