#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How good is a curve skeleton? Measures it against the closed mesh that it belongs to.

Lengths are in percent of the mesh's bounding box diagonal; the skeleton is sampled at 0.1 %.

  topology        components, cycles (E - V + components), genus of the mesh, a surface that bounds a void
                  (turned inward, in a body) being no component of its own; a right skeleton has
                  one component per component of the mesh and as many cycles as the genus
  inside          fraction of the skeleton's length inside the mesh (winding number): a void is outside
  medial          mean distance of the skeleton to the medial axis, here the centres of maximal
                  inscribed balls whose two contacts are seen under at least 60 degrees
  reconstruction  mean distance of the surface to the union of the balls that are centred on the
                  skeleton and reach the surface: what part of the shape the skeleton leaves out
  turning         mean angle, in degrees, between successive steps of 0.5 % along the branches
  tips, junctions nodes with one neighbour, and with more than two
  spurs           branches to a tip whose ball sticks out of the ball at the junction by less
                  than a tenth of the junction's radius: they stand for no feature of the shape
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
import trimesh
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from curve import Curve, mean_distance, read_curve

SAMPLE_SPACING = 0.001
TURNING_SPACING = 0.005
MEDIAL_SAMPLES = 80_000
COVERAGE_SAMPLES = 20_000
SMALLEST_SPOKE_ANGLE = 60.0
SPUR_RATIO = 0.1

# Distances to, and positions of, the surface points nearest to given points.
Nearest = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass
class Contact:
    """Balls that touch the surface at given points from inside: radius, and the other contact."""

    radius: np.ndarray
    other: np.ndarray

    def part(self, mask: np.ndarray) -> Contact:
        return Contact(self.radius[mask], self.other[mask])

    def centres(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        return points - self.radius[:, None] * normals

    def spoke_angles(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Degrees between the directions from the centre to the two contacts."""
        towards = self.other - self.centres(points, normals)
        length = np.maximum(np.linalg.norm(towards, axis=1), 1e-300)
        cosine = (towards * normals).sum(axis=1) / length
        return np.degrees(np.arccos(cosine.clip(-1.0, 1.0)))


def largest_balls(points: np.ndarray, normals: np.ndarray) -> Contact:
    """Balls as wide as the unit bounding box: none that fits the shape is larger."""
    return Contact(np.full(len(points), 0.5), points - normals)


def shrink(
    points: np.ndarray, normals: np.ndarray, start: Contact, nearest: Nearest, rounds: int
) -> Contact:
    """Replaces each ball by the one through the point nearest to its centre while that is inside.

    The ball through p with normal n and through q has the radius |p - q|^2 / (2 (p - q) . n).
    """
    radius, other = start.radius.copy(), start.other.copy()
    active = np.arange(len(points))
    for _ in range(rounds):
        p, n = points[active], normals[active]
        distance, q = nearest(p - radius[active, None] * n)
        chord = p - q
        depth = (chord * n).sum(axis=1)
        deep = depth > 1e-14
        smaller = np.where(
            deep, (chord * chord).sum(axis=1) / (2.0 * np.where(deep, depth, 1.0)), np.inf
        )
        shrinks = (distance < 0.999 * radius[active]) & (smaller < radius[active])
        active = active[shrinks]
        if not len(active):
            break
        radius[active], other[active] = smaller[shrinks], q[shrinks]
    return Contact(radius, other)


class Shape:
    """A closed mesh scaled to a unit bounding box diagonal, and questions about it."""

    def __init__(self, mesh: trimesh.Trimesh) -> None:
        mesh = mesh.copy()
        mesh.merge_vertices(merge_tex=True, merge_norm=True)
        if mesh.volume < 0:
            mesh.invert()
        self.origin = mesh.bounds[0]
        self.diagonal = float(np.linalg.norm(mesh.extents))
        self.vertices = np.ascontiguousarray((mesh.vertices - self.origin) / self.diagonal)
        self.faces = np.ascontiguousarray(mesh.faces, np.int64)
        self.normals = np.array(mesh.face_normals)
        self.vertex_normals = np.array(mesh.vertex_normals)
        self.areas = np.array(mesh.area_faces)
        parts = trimesh.graph.connected_components(mesh.face_adjacency)
        corners = mesh.triangles - self.origin
        sixfold = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
        self.voids = sum(bool(sixfold[part].sum() < 0) for part in parts)
        self.components = len(parts) - self.voids
        edges = len(mesh.edges_unique)
        referenced = len(np.unique(self.faces))
        self.genus = len(parts) - (referenced - edges + len(self.faces)) // 2
        self._tree = igl.AABB()
        self._tree.init(self.vertices, self.faces)

    @classmethod
    def read(cls, path: Path) -> Shape:
        return cls(trimesh.load(path, process=False, force="mesh"))

    def contains(self, points: np.ndarray) -> np.ndarray:
        winding = igl.fast_winding_number(
            self.vertices, self.faces, np.ascontiguousarray(points)
        )
        return winding > 0.5

    def closest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance to the surface, and the nearest point on it."""
        squared, _, nearest = self._tree.squared_distance(
            self.vertices, self.faces, np.ascontiguousarray(points)
        )
        return np.sqrt(np.maximum(squared, 0.0)), nearest

    def surface_samples(self, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Points spread evenly by area, with their outward normals."""
        random = np.random.default_rng(seed)
        upto = np.cumsum(self.areas)
        marks = (np.arange(count) + random.random(count)) * (upto[-1] / count)
        face = np.searchsorted(upto, marks).clip(0, len(upto) - 1)
        s, t = random.random((2, count))
        fold = s + t > 1.0
        s, t = np.where(fold, 1.0 - s, s), np.where(fold, 1.0 - t, t)
        a, b, c = (self.vertices[self.faces[face, k]] for k in range(3))
        return a + s[:, None] * (b - a) + t[:, None] * (c - a), self.normals[face]

    def inscribed(self, points: np.ndarray, normals: np.ndarray, start: Contact) -> Contact:
        """The largest inscribed ball that touches the surface at each point.

        points: (n, 3) on the surface; normals: outward; start: balls known to be large enough.
        Shrinking balls: while some surface point lies inside the ball, replace the ball by the one
        through that point. Every round asks for the point nearest to the exact mesh.
        """
        return shrink(points, normals, start, self.closest, rounds=40)

    def medial_axis(self, samples: int = MEDIAL_SAMPLES) -> np.ndarray:
        """Centres of inscribed balls with a wide enough spoke angle, many of them.

        A first pass against a sample of the surface finds radii that are only ever too large;
        it also drops the balls that are too narrow already, which the exact pass would drop too.
        """
        points, normals = self.surface_samples(samples, seed=11)
        # Edges and corners of the shape have no area, yet balls touch the surface there.
        if len(self.vertices) <= samples:
            points = np.vstack([points, self.vertices])
            normals = np.vstack([normals, self.vertex_normals])
        sample = cKDTree(points[:: max(1, len(points) // 20_000)])

        def nearest_sample(centres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            distance, index = sample.query(centres, eps=0.05)
            return distance, sample.data[index]

        balls = shrink(points, normals, largest_balls(points, normals), nearest_sample, rounds=12)
        wide = balls.spoke_angles(points, normals) >= SMALLEST_SPOKE_ANGLE - 15.0
        points, normals = points[wide], normals[wide]
        balls = self.inscribed(points, normals, balls.part(wide))
        wide = balls.spoke_angles(points, normals) >= SMALLEST_SPOKE_ANGLE
        centres = balls.centres(points, normals)[wide & (balls.radius > 1e-4)]
        return centres[self.contains(centres)]


def distance_to_medial_axis(shape: Shape, axis: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance of each point to the nearest known centre, or to the centre of the ball that
    touches the surface at the point's own nearest surface point, whichever is less: the latter
    takes the sampling of the axis out of the figure."""
    result = cKDTree(axis).query(points)[0]
    depth, foot = shape.closest(points)
    outward = foot - points
    length = np.linalg.norm(outward, axis=1)
    usable = np.flatnonzero(shape.contains(points) & (length > 1e-7))
    if len(usable):
        normals = outward[usable] / length[usable, None]
        balls = shape.inscribed(foot[usable], normals, largest_balls(foot[usable], normals))
        wide = balls.spoke_angles(foot[usable], normals) >= SMALLEST_SPOKE_ANGLE
        own = np.abs(balls.radius - depth[usable])
        result[usable[wide]] = np.minimum(result[usable[wide]], own[wide])
    return result


def uncovered(centres: np.ndarray, radii: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance of each point to the union of balls, 0 inside it."""
    lots = np.array_split(points, max(1, len(points) // 1000))
    gaps = [(cdist(lot, centres) - radii).min(axis=1) for lot in lots]
    return np.maximum(np.concatenate(gaps), 0.0)


def spurs(curve: Curve, radii: np.ndarray) -> int:
    count = 0
    for branch in curve.branches:
        ends = [branch[0], branch[-1]]
        tips = [n for n in ends if curve.degree[n] == 1]
        if len(tips) != 1:
            continue
        tip = tips[0]
        junction = ends[1] if ends[0] == tip else ends[0]
        reach = np.linalg.norm(curve.points[tip] - curve.points[junction]) + radii[tip]
        count += bool(reach - radii[junction] < SPUR_RATIO * radii[junction])
    return count


def measure(shape: Shape, axis: np.ndarray, skeleton: Curve) -> dict[str, float | int | None]:
    """All measures of one skeleton, given in the mesh's own units. axis: shape.medial_axis()."""
    curve = skeleton.transformed(shape.origin, shape.diagonal)
    result: dict[str, float | int | None] = {
        "components": curve.components,
        "cycles": curve.cycles,
        "mesh_components": shape.components,
        "genus": shape.genus,
        "nodes": len(curve.points),
        "tips": int((curve.degree == 1).sum()),
        "junctions": int((curve.degree > 2).sum()),
        "zero_edges": curve.zero_edges(1e-9),
        "duplicate_edges": curve.duplicate_edges,
        "length": 100.0 * float(curve.edge_lengths.sum()),
    }
    if not len(curve.simple_edges):
        return result | dict.fromkeys(
            ["inside", "medial", "reconstruction", "reconstruction_max", "turning"]
        ) | {"spurs": 0}
    samples, lengths = curve.sampled(SAMPLE_SPACING)
    weights = lengths / lengths.sum()
    within = shape.contains(samples)
    medial = distance_to_medial_axis(shape, axis, samples)
    centres = np.vstack([samples, curve.points])
    radii = np.where(shape.contains(centres), shape.closest(centres)[0], 0.0)
    surface, _ = shape.surface_samples(COVERAGE_SAMPLES, seed=12)
    gap = uncovered(centres, radii, surface)
    angles = curve.turning_angles(TURNING_SPACING)
    return result | {
        "inside": float(weights[within].sum()),
        "medial": 100.0 * float((medial * weights).sum()),
        "reconstruction": 100.0 * float(gap.mean()),
        "reconstruction_max": 100.0 * float(gap.max()),
        "turning": float(angles.mean()) if len(angles) else None,
        "spurs": spurs(curve, radii[len(samples):]),
    }


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("mesh", type=Path)
    parser.add_argument("skeleton", type=Path, nargs="+", help=".obj, .cg or .ply with edges")
    return parser.parse_args()


def main() -> None:
    arguments = parse_arguments()
    shape = Shape.read(arguments.mesh)
    axis = shape.medial_axis()
    curves = [read_curve(path) for path in arguments.skeleton]
    for path, curve in zip(arguments.skeleton, curves):
        result = measure(shape, axis, curve)
        if curve is not curves[0]:
            spacing = SAMPLE_SPACING * shape.diagonal
            result["distance_to_first"] = (
                100.0 * mean_distance(curves[0], curve, spacing) / shape.diagonal
            )
        print(json.dumps({"skeleton": str(path), **result}))


if __name__ == "__main__":
    main()
