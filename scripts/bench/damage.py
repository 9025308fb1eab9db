# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sound meshes damaged in known ways: what was there before is the ground truth of what is made of them.

Each damage takes vertices, triangles and a random generator, and returns damaged ones. The same seed gives
the same damage.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]
Damage = Callable[[np.ndarray, np.ndarray, np.random.Generator], Mesh]


def compact(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    used = np.unique(faces)
    number = np.full(len(vertices), -1)
    number[used] = np.arange(len(used))
    return vertices[used], number[faces]


def areas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def without_faces(part: float) -> Damage:
    """A part of the faces is missing, chosen at random."""
    def damage(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
        return compact(vertices, faces[random.random(len(faces)) >= part])
    return damage


def holes(count: int, part: float) -> Damage:
    """Round holes around random vertices, together a part of the area."""
    def damage(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
        area = areas(vertices, faces)
        middle = vertices[faces].mean(axis=1)
        keep = np.ones(len(faces), bool)
        for _ in range(count):
            centre = middle[random.integers(len(faces))]
            # The piece of surface around the centre, not what is near in space on the other side.
            order = patch(faces, int(np.argmin(((middle - centre) ** 2).sum(axis=1))), middle)
            upto = np.cumsum(area[order])
            keep[order[: np.searchsorted(upto, part / count * area.sum()) + 1]] = False
        return compact(vertices, faces[keep])
    return damage


def patch(faces: np.ndarray, start: int, middle: np.ndarray) -> np.ndarray:
    """The faces in the order of their distance from one of them along the surface."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    same = (edges[1:] == edges[:-1]).all(axis=1)
    a, b = owner[:-1][same], owner[1:][same]
    length = np.linalg.norm(middle[a] - middle[b], axis=1)
    graph = csr_matrix((length, (a, b)), (len(faces),) * 2)
    distance = dijkstra(graph, directed=False, indices=start)
    return np.argsort(distance, kind="stable")[: int(np.isfinite(distance).sum())]


def flipped(part: float) -> Damage:
    """A part of the faces is turned."""
    def damage(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
        turned = random.random(len(faces)) < part
        return vertices, np.where(turned[:, None], faces[:, ::-1], faces)
    return damage


def soup(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
    """Every triangle has vertices of its own, moved by a millionth of the diagonal."""
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    points = vertices[faces].reshape(-1, 3)
    return points + random.normal(size=points.shape) * 1e-6 * size, np.arange(len(points)).reshape(-1, 3)


def junctions(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
    """A tenth of the faces is cut at the middle of an edge, their neighbours are not: T-junctions."""
    chosen = np.flatnonzero(random.random(len(faces)) < 0.1)
    a, b, c = faces[chosen].T
    middle = (vertices[a] + vertices[b]) / 2
    new = len(vertices) + np.arange(len(chosen))
    rest = np.delete(faces, chosen, axis=0)
    return (np.vstack([vertices, middle]),
            np.vstack([rest, np.column_stack([a, new, c]), np.column_stack([new, b, c])]))


def rounded(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
    """A soup whose coordinates have three digits."""
    size = np.abs(vertices).max()
    digits = 3 - int(np.ceil(np.log10(size)))
    points = np.round(vertices[faces].reshape(-1, 3), digits)
    return points, np.arange(len(points)).reshape(-1, 3)


def scanned(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
    """Only the faces that are seen from one of five directions, by a depth buffer of 256 x 256."""
    pixels, samples, slack = 256, 300_000, 0.01
    z = 1 - 2 * (np.arange(5) + 0.5) / 5
    turn = np.pi * (1 + 5**0.5) * np.arange(5)
    views = np.column_stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z])
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = areas(vertices, faces)
    normals = np.cross(b - a, c - a) / np.maximum(2 * area, 1e-300)[:, None]
    face = random.choice(len(faces), samples, p=area / area.sum())
    s, t = random.random((2, samples))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    points = a[face] + s[:, None] * (b - a)[face] + t[:, None] * (c - a)[face]
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    seen = np.zeros(len(faces), bool)
    for view in views:
        across = np.linalg.svd(view[None])[2][1:]
        place = points @ across.T
        place = ((place - place.min(axis=0)) / size * (pixels - 1)).astype(int)
        pixel = place[:, 0] * pixels + place[:, 1]
        depth = points @ view
        nearest = np.full(pixels * pixels, -np.inf)
        np.maximum.at(nearest, pixel, depth)
        visible = (depth > nearest[pixel] - slack * size) & (normals[face] @ view > 0.1)
        seen[face[visible]] = True
    return compact(vertices, faces[seen])


def below(vertices: np.ndarray, faces: np.ndarray, axis: int, height: float) -> Mesh:
    """The closed part of a mesh below a plane across an axis: cut edges closed by fans around their middles."""
    inside = vertices[:, axis] < height
    kept, points, made = [], list(vertices), {}

    def crossing(a: int, b: int) -> int:
        a, b = min(a, b), max(a, b)
        if (a, b) not in made:
            t = (height - vertices[a, axis]) / (vertices[b, axis] - vertices[a, axis])
            made[a, b] = len(points)
            points.append(vertices[a] + t * (vertices[b] - vertices[a]))
        return made[a, b]

    following = {}
    for face in faces:
        within = inside[face]
        if within.all():
            kept.append(tuple(face))
        if within.all() or not within.any():
            continue
        # The corner that is alone on its side comes first.
        first = int(np.flatnonzero(within == (within.sum() == 1))[0])
        a, b, c = np.roll(face, -first)
        p, q = crossing(a, b), crossing(c, a)
        if within.sum() == 1:
            kept.append((a, p, q))
            following[q] = p
        else:
            kept += [(p, b, c), (p, c, q)]
            following[p] = q
    while following:
        start, at = next(iter(following.items()))
        loop = [start]
        del following[start]
        while at != start:
            loop.append(at)
            at = following.pop(at)
        middle = len(points)
        points.append(np.mean([points[k] for k in loop], axis=0))
        kept += [(loop[k - 1], loop[k], middle) for k in range(len(loop))]
    return compact(np.array(points), np.array(kept))


def in_two(overlap: float) -> Damage:
    """Two closed bodies, cut across the longest axis, that share so much of the diagonal, or a wall."""
    def damage(vertices: np.ndarray, faces: np.ndarray, random: np.random.Generator) -> Mesh:
        extent = np.ptp(vertices, axis=0)
        axis = int(np.argmax(extent))
        height = vertices[:, axis].min() + extent[axis] * random.uniform(0.43, 0.57)
        more = overlap * np.linalg.norm(extent) / 2
        low, low_faces = below(vertices, faces, axis, height + more)
        mirror = np.where(np.arange(3) == axis, -1, 1)
        high, high_faces = below(vertices * mirror, faces[:, ::-1], axis, more - height)
        return (np.vstack([low, high * mirror]),
                np.vstack([low_faces, high_faces[:, ::-1] + len(low)]))
    return damage


DAMAGES: dict[str, Damage] = {
    "1 % of the faces missing": without_faces(0.01),
    "5 % of the faces missing": without_faces(0.05),
    "20 % of the faces missing": without_faces(0.2),
    "one hole, 2 % of the area": holes(1, 0.02),
    "5 holes, 5 % of the area": holes(5, 0.05),
    "20 holes, 10 % of the area": holes(20, 0.1),
    "5 % of the faces turned": flipped(0.05),
    "soup": soup,
    "T-junctions": junctions,
    "three digits": rounded,
    "seen from five directions": scanned,
    "parts run into each other": in_two(0.04),
    "two coincident walls": in_two(0),
}


def damaged(name: str, vertices: np.ndarray, faces: np.ndarray, seed: int = 0) -> Mesh:
    """The mesh with one kind of damage."""
    return DAMAGES[name](vertices, faces, np.random.default_rng([seed, list(DAMAGES).index(name)]))
