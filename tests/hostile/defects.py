# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile meshes that bound no solid, and must be refused."""

from __future__ import annotations

import numpy as np

from .expectation import Hostile, either, refused, standing_for
from .primitives import (Mesh, Rng, box, compact, diagonal, edges, halved, hull, joined, log_uniform,
                         moebius_strip, sphere, turned)
from .solids import ball, cloud

NOWHERE = np.zeros((0, 3), int)


def nothing(rng: Rng) -> Hostile:
    """No vertices, or vertices without faces."""
    count = int(rng.choice([0, 1, 2, 3, 100]))
    return refused((rng.normal(size=(count, 3)), NOWHERE))


def few_triangles(rng: Rng) -> Hostile:
    """One triangle, or two, on the same or on different corners."""
    vertices = rng.normal(size=(6, 3)) * log_uniform(rng, 1e-6, 1e6)
    faces = [np.array([[0, 1, 2]]), np.array([[0, 1, 2], [2, 1, 0]]), np.array([[0, 1, 2], [0, 1, 2]]),
             np.array([[0, 1, 2], [3, 4, 5]]), np.array([[0, 0, 0]]), np.array([[0, 1, 2], [2, 1, 3]])]
    return refused(compact(vertices, faces[rng.integers(len(faces))]))


def flat(rng: Rng) -> Hostile:
    """A closed surface in a plane."""
    vertices, faces = ball(rng) if rng.random() < 0.5 else box()
    vertices = vertices.copy()
    vertices[:, rng.integers(3)] = rng.integers(3)
    return refused((vertices, faces))


def flat_and_turned(rng: Rng) -> Hostile:
    """A closed surface in a slanted plane: rounding alone gives it a volume."""
    vertices, faces = ball(rng)
    vertices = vertices.copy()
    vertices[:, 2] = 0
    return refused(turned(rng, (vertices, faces)))


def collinear(rng: Rng) -> Hostile:
    """A closed surface whose vertices are on a line."""
    vertices, faces = ball(rng, int(rng.integers(0, 3)))
    direction = rng.normal(size=3) if rng.random() < 0.5 else np.eye(3)[rng.integers(3)]
    return refused((np.outer(vertices[:, 0], direction), faces))


def one_place(rng: Rng) -> Hostile:
    """A closed surface whose vertices are all in one place."""
    vertices, faces = ball(rng)
    return refused((np.tile(rng.normal(size=3), (len(vertices), 1)), faces))


def flat_beside_sound(rng: Rng) -> Hostile:
    """One component is sound, another is flat."""
    vertices, faces = ball(rng)
    return refused(joined(ball(rng), (vertices * [1, 1, 0] + 3, faces)))


def opened(rng: Rng) -> Hostile:
    """Faces are missing."""
    vertices, faces = ball(rng)
    gone = rng.choice(len(faces), size=int(log_uniform(rng, 1, len(faces) / 2)), replace=False)
    return refused((vertices, np.delete(faces, gone, axis=0)))


def t_junctions(rng: Rng) -> Hostile:
    """Edges with a vertex on them that the neighbour does not know."""
    vertices, faces = ball(rng)
    cut = rng.choice(len(faces), size=int(rng.integers(1, 20)), replace=False)
    fresh = [t for t in np.delete(faces, cut, axis=0)]
    vertices = list(vertices)
    for a, b, c in faces[cut]:
        middle = len(vertices)
        vertices.append((vertices[a] + vertices[b]) / 2)
        fresh += [(a, middle, c), (middle, b, c)]
    return refused((np.array(vertices), np.array(fresh)))


def moebius(rng: Rng) -> Hostile:
    """A strip with half a turn: one-sided, with a border."""
    return refused(moebius_strip(int(rng.integers(5, 60))))


def klein_bottle(rng: Rng) -> Hostile:
    """A closed one-sided surface."""
    n, m = int(rng.integers(6, 30)), 2 * int(rng.integers(3, 12))
    u = 2 * np.pi * np.arange(n) / n
    v = 2 * np.pi * np.arange(m) / m
    u, v = np.meshgrid(u, v, indexing="ij")
    reach = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    vertices = np.stack([reach * np.cos(u), reach * np.sin(u),
                         np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)], axis=2)
    faces = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, i * m + (j + 1) % m
            if i + 1 < n:
                c, d = a + m, b + m
            else:
                c, d = (-j) % m, (-(j + 1)) % m
            faces += [(a, c, b), (b, c, d)]
    return refused((vertices.reshape(-1, 3), np.array(faces)))


def shared_edge(rng: Rng) -> Hostile:
    """Two bodies that have an edge in common: four faces meet there."""
    first, second = ball(rng), ball(rng, 1)
    a, b = edges(first[1])[rng.integers(len(edges(first[1])))]
    c, d = edges(second[1])[rng.integers(len(edges(second[1])))]
    vertices, faces = joined(first, (second[0] * 0.3 + first[0][a] * 1.3, second[1]))
    faces = faces.copy()
    faces[faces == c + len(first[0])] = a
    faces[faces == d + len(first[0])] = b
    return refused(compact(vertices, faces))


def shared_vertex(rng: Rng) -> Hostile:
    """Two bodies that have a vertex in common."""
    first, second = ball(rng), ball(rng, 1)
    vertices, faces = joined(first, (second[0] * 0.3 + first[0][0] * 1.3, second[1]))
    faces = faces.copy()
    faces[faces == len(first[0])] = 0
    return refused(compact(vertices, faces))


def inner_wall(rng: Rng) -> Hostile:
    """A body with a wall across its inside: three faces meet at the wall's edges."""
    n = int(rng.integers(3, 40))
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    vertices = np.vstack([ring, [[0, 0, 1], [0, 0, -1], [0, 0, 0]]])
    k = np.arange(n)
    j = (k + 1) % n
    faces = [np.column_stack([k, j, np.full(n, n)]), np.column_stack([j, k, np.full(n, n + 1)]),
             np.column_stack([k, j, np.full(n, n + 2)])]
    return refused(turned(rng, (vertices, np.vstack(faces))))


def triangle_soup(rng: Rng) -> Hostile:
    """Triangles anywhere."""
    count = int(log_uniform(rng, 2, 500))
    return refused((rng.normal(size=(3 * count, 3)), np.arange(3 * count).reshape(-1, 3)))


def tangle(rng: Rng) -> Hostile:
    """Triangles between random vertices of a small set."""
    count = int(rng.integers(5, 40))
    faces = rng.integers(count, size=(int(log_uniform(rng, 5, 500)), 3))
    made = (rng.normal(size=(count, 3)), faces)
    if len(faces) < 8:
        return either(made, "a few random faces may happen to be degenerate but for a closed body")
    return refused(made)


def _spoilt(rng: Rng, value: float) -> Mesh:
    vertices, faces = ball(rng)
    vertices = vertices.copy()
    for _ in range(int(rng.integers(1, 5))):
        vertices[rng.integers(len(vertices)), rng.integers(3)] = value
    return vertices, faces


def not_a_number(rng: Rng) -> Hostile:
    """Coordinates that are no number."""
    if rng.random() < 0.1:
        vertices, faces = ball(rng)
        return refused((np.full_like(vertices, np.nan), faces))
    return refused(_spoilt(rng, np.nan))


def infinite(rng: Rng) -> Hostile:
    """Coordinates that are infinite."""
    return refused(_spoilt(rng, rng.choice([-1, 1]) * np.inf))


def unused_not_a_number(rng: Rng) -> Hostile:
    """A sound body, and a vertex without faces that is no number."""
    vertices, faces = ball(rng)
    return either((np.vstack([vertices, [[np.nan, 0, 0]]]), faces), embedded=True,
                  why="the body is sound, but the layer's bounding box is not a number")


def beyond_range(rng: Rng) -> Hostile:
    """Coordinates whose products are beyond the range of doubles, or below it."""
    mesh = ball(rng) if rng.random() < 0.5 else hull(cloud(rng, 20))
    size = log_uniform(rng, 1e40, 1e307) if rng.random() < 0.5 else log_uniform(rng, 1e-310, 1e-40)
    return either((mesh[0] * size, mesh[1]), "nothing can be measured on it", extent=0.0)


def one_far_vertex(rng: Rng) -> Hostile:
    """One vertex of a sound body is 1e10 to 1e300 away."""
    vertices, faces = ball(rng)
    vertices = vertices.copy()
    vertices[rng.integers(len(vertices))] *= log_uniform(rng, 1e10, 1e300)
    return either((vertices, faces), "beside such a spike the rest is smaller than single precision")


def wrong_index(rng: Rng) -> Hostile:
    """A face that refers to a vertex that does not exist. The host refuses to make such a layer."""
    vertices, faces = ball(rng)
    faces = faces.copy()
    value = int(rng.choice([-1, len(vertices), 10 ** 6, 2 ** 31 - 1]))
    faces[rng.integers(len(faces)), rng.integers(3)] = value
    return refused((vertices, faces))


def half_copied(rng: Rng) -> Hostile:
    """A body and some of its faces once more, on vertices of their own: an open piece on a closed one."""
    vertices, faces = ball(rng)
    piece = compact(vertices, faces[: int(rng.integers(1, len(faces) - 1))])
    made = either(joined((vertices, faces), piece), embedded=True, extent=diagonal(vertices),
                  why="vertices in one place may be merged, and the second faces left out as copies")
    return standing_for(made, (vertices, faces))


def book(rng: Rng) -> Hostile:
    """Triangles around one edge, like pages."""
    pages = int(rng.integers(3, 200))
    angle = 2 * np.pi * np.arange(pages) / pages
    vertices = np.vstack([[[0, 0, 0], [0, 0, 1]],
                          np.column_stack([np.cos(angle), np.sin(angle), np.full(pages, 0.5)])])
    return refused((vertices, np.column_stack([np.zeros(pages, int), np.ones(pages, int),
                                               np.arange(pages) + 2])))


def grid_sheet(rng: Rng) -> Hostile:
    """A flat sheet of many triangles, open all around."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    mesh = vertices, np.array([[0, 1, 2], [0, 2, 3]])
    for _ in range(int(rng.integers(1, 5))):
        mesh = halved(mesh)
    height = rng.uniform(0, 0.2)
    bumpy = mesh[0] + np.array([0, 0, height]) * rng.normal(size=(len(mesh[0]), 1))
    return refused((bumpy, mesh[1]))


def glued_balls(rng: Rng) -> Hostile:
    """Two balls with one face in common, as if joined there but with the face still inside."""
    vertices, faces = sphere(1)
    a, b, c = faces[0]
    normal = vertices[[a, b, c]].sum(axis=0)
    normal /= np.linalg.norm(normal)
    level = vertices[a] @ normal
    mirrored = vertices - 2 * np.outer(vertices @ normal - level, normal)
    both, all_faces = joined((vertices, faces), (mirrored, faces[:, ::-1]))
    all_faces = all_faces.copy()
    for v in (a, b, c):
        all_faces[all_faces == v + len(vertices)] = v
    # One copy of the face stays: three faces at each of its edges.
    keep = np.ones(len(all_faces), bool)
    keep[len(faces)] = False
    return refused(compact(turned(rng, (both, all_faces))[0], all_faces[keep]))


FAMILIES = [
    nothing, few_triangles, flat, flat_and_turned, collinear, one_place, flat_beside_sound, opened,
    t_junctions, moebius, klein_bottle, shared_edge, shared_vertex, inner_wall, triangle_soup, tangle,
    not_a_number, infinite, unused_not_a_number, beyond_range, one_far_vertex, wrong_index, half_copied,
    book, grid_sheet, glued_balls]
