# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile meshes, each with the answer that it must get. The same seed gives the same mesh.

    from hostile import FAMILIES, make
    mesh = make("needle", 7)
    mesh.vertices, mesh.faces, mesh.expected
"""

from __future__ import annotations

import zlib
from collections.abc import Callable

import numpy as np

from . import defects, solids
from .expectation import EITHER, REFUSED, SKELETON, Expectation, Hostile

FAMILIES: dict[str, Callable[[np.random.Generator], Hostile]] = {
    family.__name__: family for family in solids.FAMILIES + defects.FAMILIES}


def make(family: str, seed: int) -> Hostile:
    """The mesh number `seed` of a family."""
    return FAMILIES[family](np.random.default_rng([zlib.crc32(family.encode()), seed]))


def drawn(count: int, seed: int) -> list[tuple[str, int]]:
    """`count` meshes as (family, seed), spread evenly over the families."""
    names = list(FAMILIES)
    return [(names[i % len(names)], seed * 1_000_003 + i // len(names)) for i in range(count)]


__all__ = ["EITHER", "FAMILIES", "REFUSED", "SKELETON", "Expectation", "Hostile", "drawn", "make"]
