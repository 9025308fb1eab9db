# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What hostile meshes are made of: bodies with a known topology, and ways to change them.

A mesh is a pair of arrays: vertices (V, 3) of float, faces (F, 3) of int, counterclockwise from outside.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

Mesh = tuple[np.ndarray, np.ndarray]
Rng = np.random.Generator


def log_uniform(rng: Rng, low: float, high: float) -> float:
    """A number whose logarithm is evenly spread."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def rotation(rng: Rng) -> np.ndarray:
    """A random rotation, (3, 3)."""
    matrix, triangular = np.linalg.qr(rng.normal(size=(3, 3)))
    matrix *= np.sign(np.diag(triangular))
    if np.linalg.det(matrix) < 0:
        matrix[:, 0] *= -1
    return matrix


def turned(rng: Rng, mesh: Mesh) -> Mesh:
    """The mesh in a random orientation."""
    return mesh[0] @ rotation(rng).T, mesh[1]


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one, no vertex shared."""
    vertices, faces, count = [], [], 0
    for points, triangles in meshes:
        vertices.append(points)
        faces.append(triangles + count)
        count += len(points)
    return np.vstack(vertices), np.vstack(faces)


def compact(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    """Without the vertices that no face uses."""
    used, numbers = np.unique(faces, return_inverse=True)
    return vertices[used], numbers.reshape(-1, 3)


def diagonal(vertices: np.ndarray) -> float:
    """Of the bounding box."""
    with np.errstate(all="ignore"):
        return float(np.linalg.norm(np.ptp(vertices, axis=0))) if len(vertices) else 0.0


def signed_volume(mesh: Mesh) -> float:
    a, b, c = (mesh[0][mesh[1][:, k]] - mesh[0].mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def outward(mesh: Mesh) -> Mesh:
    """Turned so that the volume is positive."""
    return (mesh[0], mesh[1][:, ::-1].copy()) if signed_volume(mesh) < 0 else mesh


def edges(faces: np.ndarray) -> np.ndarray:
    """Each edge once."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def component_of_vertices(count: int, faces: np.ndarray) -> tuple[int, np.ndarray]:
    """The number of connected components, and for each vertex its own."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)


def genus(mesh: Mesh) -> int:
    """Sum of the genus of all components of a closed orientable surface, by Euler's formula."""
    vertices, faces = compact(*mesh)
    count, _ = component_of_vertices(len(vertices), faces)
    return count - (len(vertices) - len(edges(faces)) + len(faces)) // 2


def sphere(level: int) -> Mesh:
    """An icosahedron whose faces are cut into four `level` times, on the unit sphere."""
    golden = (1 + 5 ** 0.5) / 2
    corners = []
    for a in (-1, 1):
        for b in (-golden, golden):
            corners += [(0, a, b), (a, b, 0), (b, 0, a)]
    vertices = np.array(corners, float)
    mesh = hull(vertices)
    for _ in range(level):
        mesh = halved(mesh)
    return mesh[0] / np.linalg.norm(mesh[0], axis=1)[:, None], mesh[1]


def halved(mesh: Mesh) -> Mesh:
    """Each face cut into four at the middles of its edges."""
    vertices, faces = mesh
    pairs = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    unique, number = np.unique(pairs, axis=0, return_inverse=True)
    middle = number.reshape(-1, 3) + len(vertices)
    a, b, c = faces.T
    ab, bc, ca = middle.T
    cut = [np.column_stack(t) for t in [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]]
    return np.vstack([vertices, vertices[unique].mean(axis=1)]), np.vstack(cut)


def hull(points: np.ndarray) -> Mesh:
    """The convex hull of points."""
    convex = ConvexHull(points)
    faces = convex.simplices.astype(int)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), convex.equations[:, :3]) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return compact(points, faces)


def box(size: tuple[float, float, float] = (1, 1, 1)) -> Mesh:
    """Eight vertices, twelve triangles, a corner at the origin."""
    cells = np.ones((1, 1, 1), bool)
    return cell_surface(cells, [np.array([0, length], float) for length in size])


def cell_surface(cells: np.ndarray, grid: list[np.ndarray] | None = None) -> Mesh:
    """The boundary of the true cells of a grid whose planes are at the given coordinates."""
    if grid is None:
        grid = [np.arange(n + 1, dtype=float) for n in cells.shape]
    padded = np.pad(cells, 1)
    shape = np.array(cells.shape) + 1
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            other = np.roll(padded, 1 if side == 0 else -1, axis=axis)
            at = np.argwhere(padded & ~other) - 1
            corner = at.copy()
            corner[:, axis] += side
            ring = []
            for du, dv in [(0, 0), (1, 0), (1, 1), (0, 1)]:
                p = corner.copy()
                p[:, u] += du
                p[:, v] += dv
                ring.append(np.ravel_multi_index(p.T, shape))
            quad = np.column_stack(ring)
            quads.append(quad if side == 1 else quad[:, ::-1])
    quad = np.vstack(quads)
    faces = np.vstack([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])
    coordinates = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 3)
    return compact(coordinates, faces)


def is_two_manifold(mesh: Mesh) -> bool:
    """Is every edge in two faces that run through it in opposite directions, every vertex in one fan?"""
    vertices, faces = mesh
    runs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    key = runs[:, 0] * len(vertices) + runs[:, 1]
    back = runs[:, 1] * len(vertices) + runs[:, 0]
    if len(np.unique(key)) != len(key) or not np.array_equal(np.sort(key), np.sort(back)):
        return False
    # Corners of one vertex are joined where their faces share an edge there: one group for each fan.
    corner = np.arange(len(faces) * 3)
    order = np.argsort(key)
    partner = order[np.searchsorted(key[order], back)]  # half-edge in the other direction
    turn = partner // len(faces)
    face = partner % len(faces)
    here = corner.reshape(3, -1).ravel()  # half-edge k * F + f starts at corner k of face f
    ahead = ((turn + 1) % 3) * len(faces) + face
    graph = coo_matrix((np.ones(len(here)), (here, ahead)), shape=(len(here), len(here)))
    fans, _ = connected_components(graph, directed=False)
    return fans == len(np.unique(faces))


def filled_to_manifold(cells: np.ndarray) -> np.ndarray:
    """Cells are added where two of them touch in an edge or a corner only."""
    cells = cells.copy()
    while not is_two_manifold(cell_surface(cells)):
        padded = np.pad(cells, 1)
        changed = False
        for corner in np.ndindex(*(np.array(padded.shape) - 1)):
            block = padded[tuple(slice(c, c + 2) for c in corner)]
            if 0 < block.sum() < 8 and not _block_is_simple(block):
                inner = [p for p in np.argwhere(~block) + corner - 1
                         if (p >= 0).all() and (p < cells.shape).all()]
                for p in inner:
                    cells[tuple(p)] = changed = True
                if inner:
                    break
        if not changed:
            break
    return cells


def _block_is_simple(block: np.ndarray) -> bool:
    """Are the true cells of a 2 x 2 x 2 block connected over faces, and the false ones too?"""
    def groups(mask: np.ndarray) -> int:
        cells = [tuple(p) for p in np.argwhere(mask)]
        seen: set[tuple[int, ...]] = set()
        count = 0
        for first in cells:
            if first in seen:
                continue
            count += 1
            stack = [first]
            while stack:
                cell = stack.pop()
                if cell in seen:
                    continue
                seen.add(cell)
                for axis in range(3):
                    near = list(cell)
                    near[axis] = 1 - near[axis]
                    if mask[tuple(near)]:
                        stack.append(tuple(near))
        return count
    return groups(block) == 1 and groups(~block) == 1


def tube(path: np.ndarray, radii: np.ndarray | float, sides: int, closed: bool = False,
         section: np.ndarray | None = None, turn: int = 0, twist: float = 0.0) -> Mesh:
    """A polygon swept along a polyline without needless twist.

    path     points, (N, 3); a closed one does not repeat the first point.
    section  corners of the polygon in units of the radius, (sides, 2); default: regular.
    turn     closed only: by how many corners the last ring is shifted against the first.
    twist    radians by which each ring is turned against the one before.
    """
    path = np.asarray(path, float)
    radii = np.broadcast_to(np.asarray(radii, float), len(path))
    if section is None:
        angle = 2 * np.pi * np.arange(sides) / sides
        section = np.column_stack([np.cos(angle), np.sin(angle)])
    ahead = np.roll(path, -1, axis=0) - path
    if not closed:
        ahead[-1] = ahead[-2]
    behind = np.roll(ahead, 1, axis=0)
    if not closed:
        behind[0] = ahead[0]
    tangent = ahead / np.linalg.norm(ahead, axis=1)[:, None] + (
        behind / np.linalg.norm(behind, axis=1)[:, None])
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    normal = np.cross(tangent[0], np.eye(3)[np.argmin(abs(tangent[0]))])
    normals = []
    for t in tangent:
        normal = normal - t * (normal @ t)
        normal = normal / np.linalg.norm(normal)
        normals.append(normal)
    angle = twist * np.arange(len(path))
    if closed:
        # The frame comes back turned: spread the difference, and the shift by `turn` corners.
        last = normals[-1] - tangent[0] * (normals[-1] @ tangent[0])
        gap = np.arctan2(np.dot(np.cross(last, normals[0]), tangent[0]), last @ normals[0])
        angle = angle + (gap + 2 * np.pi * turn / sides) * np.arange(len(path)) / len(path)
    u = np.array(normals)
    v = np.cross(tangent, u)
    u, v = (np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v,
            np.cos(angle)[:, None] * v - np.sin(angle)[:, None] * u)
    rings = (path[:, None] + radii[:, None, None] * (
        section[None, :, :1] * u[:, None] + section[None, :, 1:] * v[:, None]))
    vertices = rings.reshape(-1, 3)
    faces = []
    count = len(path)
    k = np.arange(sides)
    for i in range(count if closed else count - 1):
        a = i * sides + k
        b = i * sides + (k + 1) % sides
        shift = turn if closed and i == count - 1 else 0
        j = (i + 1) % count
        c = j * sides + (k + shift) % sides
        d = j * sides + (k + 1 + shift) % sides
        faces += [np.column_stack([a, b, c]), np.column_stack([b, d, c])]
    if not closed:
        vertices = np.vstack([vertices, path[:1], path[-1:]])
        first, last = len(vertices) - 2, len(vertices) - 1
        faces.append(np.column_stack([np.full(sides, first), (k + 1) % sides, k]))
        end = (count - 1) * sides
        faces.append(np.column_stack([np.full(sides, last), end + k, end + (k + 1) % sides]))
    return vertices, np.vstack(faces)


def moebius_strip(around: int) -> Mesh:
    """A strip of so many quadrangles with half a turn: one-sided, with a border."""
    angle = 2 * np.pi * np.arange(around) / around
    rims = []
    for side in (-0.3, 0.3):
        reach = 1 + side * np.cos(angle / 2)
        rims.append(np.column_stack([reach * np.cos(angle), reach * np.sin(angle),
                                     side * np.sin(angle / 2)]))
    faces = []
    for i in range(around):
        c, d = (i + 1, around + i + 1) if i + 1 < around else (around, 0)
        faces += [[i, c, around + i], [around + i, c, d]]
    return np.vstack(rims), np.array(faces)


def revolved(radii: np.ndarray, heights: np.ndarray, sides: int) -> Mesh:
    """A profile turned about the z axis; its first and last radius are taken as 0."""
    angle = 2 * np.pi * np.arange(sides) / sides
    inner = len(radii) - 2
    rings = np.stack([np.outer(radii[1:-1], np.cos(angle)), np.outer(radii[1:-1], np.sin(angle)),
                      np.repeat(heights[1:-1, None], sides, axis=1)], axis=2).reshape(-1, 3)
    vertices = np.vstack([rings, [[0, 0, heights[0]], [0, 0, heights[-1]]]])
    k = np.arange(sides)
    faces = []
    for i in range(inner - 1):
        a, b = i * sides + k, i * sides + (k + 1) % sides
        faces += [np.column_stack([a, b, a + sides]), np.column_stack([b, b + sides, a + sides])]
    bottom, top = len(vertices) - 2, len(vertices) - 1
    faces.append(np.column_stack([np.full(sides, bottom), (k + 1) % sides, k]))
    end = (inner - 1) * sides
    faces.append(np.column_stack([np.full(sides, top), end + k, end + (k + 1) % sides]))
    return vertices, np.vstack(faces)


def prism(polygon: np.ndarray, height: float) -> Mesh:
    """A polygon that is star-shaped around the origin, (N, 2), counterclockwise, drawn upwards."""
    n = len(polygon)
    low = np.column_stack([polygon, np.zeros(n)])
    high = np.column_stack([polygon, np.full(n, height)])
    vertices = np.vstack([low, high, [[0, 0, 0], [0, 0, height]]])
    k = np.arange(n)
    j = (k + 1) % n
    faces = [np.column_stack([k, j, k + n]), np.column_stack([j, j + n, k + n]),
             np.column_stack([np.full(n, 2 * n), j, k]),
             np.column_stack([np.full(n, 2 * n + 1), k + n, j + n])]
    return vertices, np.vstack(faces)
