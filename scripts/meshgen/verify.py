# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every generated mesh has to pass before it is written."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .fields import Array

MIN_ANGLE_DEG = 1.0


class BadMesh(RuntimeError):
    """A generated mesh that is not what it should be."""


def require(condition: bool, message: str) -> None:
    """Raise BadMesh with `message` unless the condition holds."""
    if not condition:
        raise BadMesh(message)


def component_labels(v: Array, f: Array) -> tuple[int, Array]:
    """Number of connected components, and the component of each vertex."""
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]]])
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(len(v), len(v)))
    return connected_components(graph, directed=False)


def check_manifold(v: Array, f: Array) -> None:
    """Watertight, oriented, one fan of faces round each vertex, no vertex unused or doubled."""
    half = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    code = half[:, 0] * len(v) + half[:, 1]
    require(len(np.unique(code)) == len(code), "an edge has two faces in the same direction")
    back = half[:, 1] * len(v) + half[:, 0]
    require(np.array_equal(np.sort(code), np.sort(back)), "the mesh has a border")
    require(len(np.unique(f)) == len(v), "a vertex is in no face")
    require(len(np.unique(v, axis=0)) == len(v), "two vertices coincide")
    # Corner of face at vertex p joins its two other vertices: the link; one cycle for each vertex.
    corners = np.concatenate([f, f[:, [1, 2, 0]], f[:, [2, 0, 1]]])
    origin, first, second = corners.T
    nodes, index = np.unique(np.concatenate([origin * len(v) + first, origin * len(v) + second]),
                             return_inverse=True)
    a, b = index[:len(origin)], index[len(origin):]
    links = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(nodes),) * 2)
    require(connected_components(links, directed=False)[0] == len(v),
            "a vertex has more than one fan of faces")


def angles(v: Array, f: Array) -> Array:
    """Angles (m, 3) of the faces in degrees."""
    result = []
    for k in range(3):
        a = v[f[:, (k + 1) % 3]] - v[f[:, k]]
        b = v[f[:, (k + 2) % 3]] - v[f[:, k]]
        cross = np.linalg.norm(np.cross(a, b), axis=1)
        result.append(np.degrees(np.arctan2(cross, np.sum(a * b, axis=1))))
    return np.stack(result, axis=1)


def segments_hit(p: Array, q: Array, a: Array, b: Array, c: Array) -> Array:
    """Which segments p to q cross the triangles a b c (row by row)."""
    direction, e1, e2 = q - p, b - a, c - a
    h = np.cross(direction, e2)
    det = np.sum(e1 * h, axis=1)
    safe = np.where(np.abs(det) < 1e-18, np.inf, det)
    s = p - a
    u = np.sum(s * h, axis=1) / safe
    cross = np.cross(s, e1)
    w = np.sum(direction * cross, axis=1) / safe
    t = np.sum(e2 * cross, axis=1) / safe
    return (np.isfinite(safe) & (u >= 0.0) & (w >= 0.0) & (u + w <= 1.0)
            & (t >= 0.0) & (t <= 1.0))


def count_self_intersections(v: Array, f: Array) -> int:
    """Pairs of faces that cross, or that share an edge and fold onto each other."""
    corners = v[f]
    centre = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centre[:, None], axis=2).max()
    pairs = cKDTree(centre).query_pairs(2.0 * reach, output_type="ndarray")
    low, high = corners.min(axis=1), corners.max(axis=1)
    touch = np.all((low[pairs[:, 0]] <= high[pairs[:, 1]])
                   & (low[pairs[:, 1]] <= high[pairs[:, 0]]), axis=1)
    pairs = pairs[touch]
    same = f[pairs[:, 0]][:, :, None] == f[pairs[:, 1]][:, None, :]
    shared = same.sum(axis=(1, 2))
    bad = np.zeros(len(pairs), bool)
    for one, other, mine in ((0, 1, same.any(axis=2)), (1, 0, same.any(axis=1))):
        tri = corners[pairs[:, other]]
        for k in range(3):
            p, q = corners[pairs[:, one], k], corners[pairs[:, one], (k + 1) % 3]
            free = ~mine[:, k] & ~mine[:, (k + 1) % 3] & (shared < 2)
            bad[free] |= segments_hit(p[free], q[free], *tri[free].transpose(1, 0, 2))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    fold = np.sum(normal[pairs[:, 0]] * normal[pairs[:, 1]], axis=1) < -0.95
    return int(np.count_nonzero(bad | (fold & (shared == 2))))


def check_mesh(v: Array, f: Array, genus: int, components: int) -> None:
    """All properties that the project's input check asks for, and the topology that is meant."""
    check_manifold(v, f)
    count, label = component_labels(v, f)
    require(count == components, f"{count} components, {components} were meant")
    euler = len(v) - len(f) // 2
    require(euler == 2 * components - 2 * genus,
            f"Euler characteristic {euler}, {2 * components - 2 * genus} was meant")
    a, b, c = v[f[:, 0]], v[f[:, 1]], v[f[:, 2]]
    volumes = np.bincount(label[f[:, 0]], np.sum(a * np.cross(b, c), axis=1) / 6.0)
    require(bool(np.all(volumes > 0.0)), "a component is inside out")
    least = float(angles(v, f).min())
    require(least > MIN_ANGLE_DEG, f"a face has an angle of {least:.2f} degrees")
    crossing = count_self_intersections(v, f)
    require(crossing == 0, f"{crossing} pairs of faces intersect")


def distance_to_mesh(points: Array, v: Array, f: Array) -> Array:
    """Distance from each point to the nearest face (all faces tried, in chunks)."""
    a, ab, ac = v[f[:, 0]], v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]
    d00, d01, d11 = (np.sum(x * y, axis=1) for x, y in ((ab, ab), (ab, ac), (ac, ac)))
    inverse = 1.0 / (d00 * d11 - d01**2)
    result = np.empty(len(points))
    for i, p in enumerate(points):
        ap = p - a
        d20, d21 = np.sum(ap * ab, axis=1), np.sum(ap * ac, axis=1)
        s, t = (d11 * d20 - d01 * d21) * inverse, (d00 * d21 - d01 * d20) * inverse
        plane = np.linalg.norm(ap - s[:, None] * ab - t[:, None] * ac, axis=1)
        inner = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
        best = plane[inner].min(initial=np.inf)
        for origin, along, squared, dot in ((a, ab, d00, d20), (a, ac, d11, d21),
                                            (a + ab, ac - ab, d00 + d11 - 2.0 * d01,
                                             d21 - d20 + d00 - d01)):
            w = np.clip(dot / squared, 0.0, 1.0)
            best = min(best, np.linalg.norm(p - origin - w[:, None] * along, axis=1).min())
        result[i] = best
    return result
