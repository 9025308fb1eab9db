# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to come of a hostile mesh, as far as its maker knows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .primitives import Mesh, component_of_vertices

REFUSED = "refused"    # there must be an error
SKELETON = "skeleton"  # there must be a skeleton
EITHER = "either"      # both will do; a skeleton that is given must be right


@dataclass
class Expectation:
    """The answer that a mesh must get.

    answer      REFUSED, SKELETON or EITHER.
    components  connected components of the skeleton, where there is one.
    genus       independent cycles of the skeleton, where there is one.
    embedded    each component is the boundary of a solid and meets itself nowhere: the skeleton must be
                inside. Otherwise there may be no inside to speak of, and the bounding box must do.
    extent      a length that a good skeleton is not much longer than: the sum of the components'
                diagonals, or of the lengths of all features where these are many.
    why         where the answer is EITHER: why it is not clear.
    """

    answer: str
    components: int = 0
    genus: int = 0
    embedded: bool = False
    extent: float = 0.0
    why: str = ""


@dataclass
class Hostile:
    """A mesh and what is expected of it.

    solid  the sound surface that the mesh stands for, where its own faces have to be mended first.
    """

    vertices: np.ndarray
    faces: np.ndarray
    expected: Expectation
    solid: Mesh | None = None


def refused(mesh: Mesh) -> Hostile:
    return Hostile(mesh[0], mesh[1], Expectation(REFUSED))


def sum_of_diagonals(mesh: Mesh) -> float:
    """The sum of the bounding box diagonals of the connected components."""
    vertices, faces = mesh
    _, component = component_of_vertices(len(vertices), faces)
    used = np.unique(faces)
    order = used[np.argsort(component[used], kind="stable")]
    starts = np.flatnonzero(np.diff(component[order], prepend=-1))
    low = np.minimum.reduceat(vertices[order], starts)
    high = np.maximum.reduceat(vertices[order], starts)
    with np.errstate(all="ignore"):
        return float(np.linalg.norm(high - low, axis=1).sum())


def skeleton(mesh: Mesh, components: int = 1, genus: int = 0, embedded: bool = True,
             extent: float | None = None) -> Hostile:
    """A mesh that must get a skeleton. `extent`: if the sum of the diagonals says too little."""
    own = sum_of_diagonals(mesh)
    return Hostile(mesh[0], mesh[1], Expectation(
        SKELETON, components, genus, embedded, max(own, extent or 0.0)))


def either(mesh: Mesh, why: str, components: int = 1, genus: int = 0, embedded: bool = False,
           extent: float | None = None) -> Hostile:
    """A mesh that may be refused; if it is not, the skeleton must be right."""
    made = skeleton(mesh, components, genus, embedded, extent)
    made.expected.answer = EITHER
    made.expected.why = why
    return made


def skeleton_if(clear: bool, mesh: Mesh, why: str, **known: object) -> Hostile:
    """skeleton() if the right answer is clear, or else either()."""
    return skeleton(mesh, **known) if clear else either(mesh, why, **known)  # type: ignore[arg-type]


def standing_for(made: Hostile, solid: Mesh) -> Hostile:
    """The same, with the sound surface that it stands for."""
    made.solid = solid
    return made
