# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes failing cases small, as long as the same filter fails in the same way."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pymeshlab

from hostile import REFUSED
from hostile.expectation import Hostile
from hostile.primitives import compact, component_of_vertices, genus, is_two_manifold


class Reduction:
    """Drops components, faces and edges of a mesh while it still fails.

    @param fails  does a mesh fail in the same way?
    """

    def __init__(self, mesh: Hostile, fails: Callable[[Hostile], bool]) -> None:
        self.mesh, self.fails = mesh, fails
        self.rng = np.random.default_rng(1)

    def run(self, seconds: float) -> Hostile:
        end = time.monotonic() + seconds
        smaller = True
        while smaller and time.monotonic() < end:
            smaller = False
            for candidate in self.candidates():
                if time.monotonic() > end:
                    break
                if self.fails(candidate):
                    self.mesh, smaller = candidate, True
                    break
        return self.mesh

    def candidates(self) -> Iterator[Hostile]:
        """Smaller meshes for which the right answer is known, the smallest first."""
        mesh = self.mesh
        if mesh.solid is not None or not len(mesh.faces):
            return
        closed = is_two_manifold(compact(mesh.vertices, mesh.faces))
        if closed:
            yield from self._fewer_components()
            yield from self._fewer_edges()
        elif mesh.expected.answer == REFUSED:
            yield from self._fewer_faces()

    def _fewer_components(self) -> Iterator[Hostile]:
        vertices, faces = compact(self.mesh.vertices, self.mesh.faces)
        count, component = component_of_vertices(len(vertices), faces)
        of_face = component[faces[:, 0]]
        for pieces in (2, 4, 8, 16, 64):
            if pieces > 2 * count:
                break
            blocks = np.array_split(np.arange(count), min(pieces, count))
            for kept in blocks + [np.setdiff1d(np.arange(count), block) for block in blocks]:
                if 0 < len(kept) < count:
                    points, triangles = compact(vertices, faces[np.isin(of_face, kept)])
                    yield Hostile(points, triangles, replace(
                        self.mesh.expected, components=len(kept), genus=genus((points, triangles))))

    def _fewer_faces(self) -> Iterator[Hostile]:
        vertices, faces = self.mesh.vertices, self.mesh.faces
        for pieces in (2, 4, 8, 16, 32, 64):
            if pieces > 2 * len(faces):
                break
            for block in np.array_split(np.arange(len(faces)), min(pieces, len(faces))):
                kept = np.delete(faces, block, axis=0)
                if len(kept) and 0 <= kept.min() and kept.max() < len(vertices):
                    made = compact(vertices, kept)
                    if not is_two_manifold(made):
                        yield Hostile(*made, self.mesh.expected)

    def _fewer_edges(self) -> Iterator[Hostile]:
        """Edges collapsed to one of their ends; nothing may meet itself that did not."""
        vertices, faces = compact(self.mesh.vertices, self.mesh.faces)
        topology = self._topology(vertices, faces)
        for part in (0.5, 0.25, 0.12, 0.06, 0.03, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0):
            made = compact(vertices, self._collapsed(faces, max(1, int(part * len(vertices)))))
            if len(made[0]) < len(vertices) and self._topology(*made) == topology and (
                    not self.mesh.expected.embedded or meets_itself(*made) <= meets_itself(vertices, faces)):
                yield Hostile(*made, self.mesh.expected)

    @staticmethod
    def _topology(vertices: np.ndarray, faces: np.ndarray) -> tuple[int, int] | None:
        if not is_two_manifold((vertices, faces)):
            return None
        return component_of_vertices(len(vertices), faces)[0], genus((vertices, faces))

    def _collapsed(self, faces: np.ndarray, count: int) -> np.ndarray:
        around: dict[int, set[int]] = {}
        for a, b, c in faces.tolist():
            around.setdefault(a, set()).update((b, c))
            around.setdefault(b, set()).update((c, a))
            around.setdefault(c, set()).update((a, b))
        target = np.arange(faces.max() + 1)
        touched: set[int] = set()
        for a in self.rng.permutation(list(around)).tolist():
            if count == 0:
                break
            for b in self.rng.permutation(sorted(around[a])).tolist():
                if (a not in touched and b not in touched and len(around[a] & around[b]) == 2
                        and len(around[a] | around[b]) > 4):
                    target[a] = b
                    touched |= around[a] | around[b]
                    count -= 1
                    break
        faces = target[faces]
        bad = (faces[:, 0] == faces[:, 1]) | (faces[:, 1] == faces[:, 2]) | (faces[:, 2] == faces[:, 0])
        return faces[~bad]


def meets_itself(vertices: np.ndarray, faces: np.ndarray) -> int:
    """How many faces cross others, as MeshLab sees it."""
    layers = pymeshlab.MeshSet()
    layers.add_mesh(pymeshlab.Mesh(vertices, faces))
    layers.apply_filter("compute_selection_by_self_intersections_per_face")
    return layers.current_mesh().selected_face_number()
