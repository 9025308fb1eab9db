# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The catalogue of test shapes: each function makes one mesh with what is known of it."""
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from .fields import (Array, Field, Tube, ball, channel, cup_body, ellipsoid, holed_plate,
                     thick_rectangle, union)
from .grids import box_grid, torus_grid
from .polygonise import decimate, polygonise
from .skeletons import Skeleton, skeleton_of_tubes


@dataclass
class Shape:
    """A mesh and its truth; None where no number of tips or junctions is beyond dispute."""

    description: str
    how: str
    vertices: Array
    faces: Array
    parameters: dict[str, float]
    genus: int = 0
    components: int = 1
    tips: int | None = None
    junctions: int | None = None
    skeleton: Skeleton | None = None
    complete: bool = False
    note: str = "No skeleton of this shape is known exactly."
    mirror: bool = False
    sheet: list[list[float]] = field(default_factory=list)


TUBULAR = ("Exact nodes: the axis of a tube of circular section, radius the tube's; tips are the "
           "centres of the end balls.")
BLENDED = (" Nodes that are not exact lie where parts blend: there the skeleton is only expected "
           "near the axis, and the ball is larger than the radius given.")
LIMBS = (" Only these pieces are given: how they join inside the body is for the method to find.")


def line(a: tuple[float, ...], b: tuple[float, ...], ra: float, rb: float | None = None) -> Tube:
    """Straight tube."""
    return Tube(np.array([a, b], float), np.array([ra, ra if rb is None else rb]))


def bezier(controls: list[tuple[float, ...]], ra: float, rb: float, count: int = 241) -> Tube:
    """Tube along a Bezier curve, radius linear in arc length."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    points = np.array(controls, float)[:, None, :] * np.ones((1, count, 1))
    while len(points) > 1:
        points = (1.0 - t) * points[:-1] + t * points[1:]
    arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points[0], axis=0), axis=1)))
    return Tube(points[0], ra + (rb - ra) * arc / arc[-1])


def arc(centre: tuple[float, float], radius: float, start: float, stop: float,
        count: int = 241) -> Array:
    """Points (count, 2) of a circular arc, angles in degrees."""
    a = np.radians(np.linspace(start, stop, count))
    return np.array(centre) + radius * np.stack([np.cos(a), np.sin(a)], axis=1)


def segment(a: tuple[float, float], b: tuple[float, float], count: int = 121) -> Array:
    """Points (count, 2) of a straight stroke."""
    return np.linspace(np.array(a, float), np.array(b, float), count)


def flat(points: Array, z: float = 0.0) -> Array:
    """Planar points (n, 2) at height z."""
    return np.column_stack([points, np.full(len(points), z)])


def circle(radius: float, count: int = 720) -> Array:
    """Points (count, 3) of a circle about the z axis."""
    return flat(arc((0.0, 0.0), radius, 0.0, 360.0, count + 1)[:-1])


def tube_shape(tubes: list[Tube], cell: float, *, blend: float = 0.0, rest: list[Field] = [],
               rest_box: Array | None = None, complete: bool = True, mirror: bool = False,
               **truth) -> Shape:
    """Mesh and skeleton of a smooth union of tubes and other parts."""
    low = np.min([(t.points - t.radii[:, None]).min(axis=0) for t in tubes], axis=0)
    high = np.max([(t.points + t.radii[:, None]).max(axis=0) for t in tubes], axis=0)
    if rest_box is not None:
        low, high = np.minimum(low, rest_box[0]), np.maximum(high, rest_box[1])
    parts: list[Field] = [*rest, *tubes]
    v, f = polygonise(union(parts, blend), low, high, cell, mirror)
    diagonal = float(np.linalg.norm(high - low))
    skeleton = skeleton_of_tubes(tubes, rest, blend, 0.005 * diagonal, complete)
    note = TUBULAR + (BLENDED if complete and blend > 0.0 else "") + ("" if complete else LIMBS)
    truth["parameters"] = {**truth["parameters"], "cell": cell}
    if blend > 0.0:
        truth["parameters"]["blend"] = blend
    return Shape(how="marching cubes on a union of tubes, relaxed on the surface", vertices=v,
                 faces=f, skeleton=skeleton, complete=complete, note=note, mirror=mirror, **truth)


def field_shape(function: Field, low: Array, high: Array, cell: float, **truth) -> Shape:
    """Mesh of an implicit shape whose skeleton is not, or only partly, known."""
    v, f = polygonise(function, low, high, cell)
    truth["parameters"] = {**truth["parameters"], "cell": cell}
    return Shape(how="marching cubes on an implicit shape, relaxed on the surface", vertices=v,
                 faces=f, **truth)


def capsule() -> Shape:
    return tube_shape([line((-1, 0, 0), (1, 0, 0), 0.35)], 0.05, tips=2, junctions=0,
                      description="Capsule: a straight tube with round ends.",
                      parameters={"length": 2.0, "radius": 0.35})


def bent_tube() -> Shape:
    first = arc((0.0, 1.0), 1.0, 150.0, 270.0)
    second = arc((0.0, -1.0), 1.0, 90.0, -30.0)
    path = flat(np.concatenate([first, second[1:]]))
    return tube_shape([Tube(path, 0.25)], 0.055, tips=2, junctions=0,
                      description="S of two arcs of 120 degrees, constant radius.",
                      parameters={"bend_radius": 1.0, "radius": 0.25})


def taper() -> Shape:
    return tube_shape([line((-1.5, 0, 0), (1.5, 0, 0), 0.45, 0.12)], 0.05, tips=2, junctions=0,
                      description="Straight cone-sphere: the radius falls linearly.",
                      parameters={"length": 3.0, "radius_start": 0.45, "radius_end": 0.12})


def horn() -> Shape:
    t = np.linspace(0.0, 1.0, 401)
    a = 2.0 * np.pi * 0.8 * t
    path = np.stack([0.9 * np.cos(a), 0.9 * np.sin(a), 1.5 * t], axis=1)
    return tube_shape([Tube(path, 0.42 - 0.3 * t)], 0.052, tips=2, junctions=0,
                      description="Tapered tube along a turn of a helix.",
                      parameters={"helix_radius": 0.9, "height": 1.5, "turns": 0.8,
                                  "radius_start": 0.42, "radius_end": 0.12})


def y_tube() -> Shape:
    ends = arc((0.0, 0.0), 1.5, 90.0, 330.0, 3)
    tubes = [line((0, 0, 0), (*end, 0), 0.25) for end in ends]
    shape = tube_shape(tubes, 0.055, blend=0.08, tips=3, junctions=1,
                       description="Three equal tubes that meet at 120 degrees.",
                       parameters={"length": 1.5, "radius": 0.25})
    shape.note += " By symmetry the axes are medial up to the junction at the origin."
    return shape


def tree() -> Shape:
    fork, left, right = (0.0, 0.0, 1.3), (-0.75, 0.25, 2.15), (0.7, -0.2, 2.2)
    tubes = [line((0, 0, 0), fork, 0.25), line(fork, left, 0.18), line(fork, right, 0.2),
             line(left, (-1.75, 0.1, 2.5), 0.12), line(left, (-0.6, 0.75, 3.2), 0.14),
             line(right, (1.6, 0.4, 2.7), 0.15), line(right, (0.7, -0.9, 3.1), 0.1)]
    return tube_shape(tubes, 0.047, blend=0.05, tips=5, junctions=3,
                      description="Tree of seven straight tubes of six radii, not planar.",
                      parameters={"radius_trunk": 0.25, "radius_least": 0.1})


def torus() -> Shape:
    return tube_shape([Tube(circle(1.0), 0.3, closed=True)], 0.06, genus=1, tips=0, junctions=0,
                      description="Torus.", parameters={"major": 1.0, "minor": 0.3})


def knot() -> Shape:
    t = 2.0 * np.pi * np.arange(1440) / 1440
    path = np.stack([np.sin(t) + 2.0 * np.sin(2.0 * t), np.cos(t) - 2.0 * np.cos(2.0 * t),
                     -np.sin(3.0 * t)], axis=1)
    return tube_shape([Tube(path, 0.42, closed=True)], 0.12, genus=1, tips=0, junctions=0,
                      description="Trefoil knot, tube of constant radius.",
                      parameters={"radius": 0.42})


def torus_capsule() -> Shape:
    tubes = [Tube(circle(1.0), 0.25, closed=True), line((0, 0, -0.9), (0, 0, 0.9), 0.3)]
    return tube_shape(tubes, 0.06, genus=1, components=2, tips=2, junctions=0,
                      description="A torus with a capsule through its hole: two components.",
                      parameters={"major": 1.0, "minor": 0.25, "capsule_radius": 0.3})


def plate3() -> Shape:
    size = {"half_length": 1.3, "rim": 0.75, "hole": 0.36, "thickness": 0.3}
    return field_shape(holed_plate(**size), [-2.05, -0.75, -0.15], [2.05, 0.75, 0.15], 0.055,
                       genus=3, tips=0, junctions=4, parameters=size,
                       description="Plate with round ends and three round holes in a row.",
                       note="Expected: three loops side by side, two bridges between the holes, "
                            "in the plane z = 0.")


def slab() -> Shape:
    x, y, radius = 1.0, 0.7, 0.12
    shape = field_shape(thick_rectangle(x, y, radius), [-x - radius, -y - radius, -radius],
                        [x + radius, y + radius, radius], 0.05,
                        parameters={"half_x": x, "half_y": y, "radius": radius},
                        description="Flat slab with a rounded rim: all points near a rectangle.",
                        note="The medial axis is exactly the rectangle given as sheet (its "
                             "corners in order), radius constant; as a curve it has no one "
                             "right form.")
    shape.sheet = [[x, y, 0.0], [-x, y, 0.0], [-x, -y, 0.0], [x, -y, 0.0]]
    return shape


def spine(length: float, width: float, height: float) -> Skeleton:
    """Middle line of a cuboid: where its middle sheet is farthest from its own border."""
    half = (length - width) / 2.0
    x = np.linspace(-half, half, 101)
    skeleton = Skeleton()
    skeleton.add(np.stack([x, 0.0 * x, 0.0 * x], axis=1), np.full(len(x), height / 2.0),
                 np.ones(len(x), bool))
    return skeleton


SPINE = ("The nodes are exact points of the medial axis, radius half the height: the middle of its "
         "middle sheet. That the curve runs there is expected; how it goes on towards the "
         "corners, and with how many tips, is up to the method.")


def cuboid() -> Shape:
    size = (4.0, 2.0, 1.0)
    v, f = box_grid(size, 0.1)
    return Shape(description="Cuboid 4 x 2 x 1 with sharp edges, on a regular grid.",
                 how="grid on each side", vertices=v, faces=f, skeleton=spine(*size), note=SPINE,
                 parameters={"x": 4.0, "y": 2.0, "z": 1.0, "cell": 0.1})


def box8() -> Shape:
    size = (4.0, 2.0, 1.0)
    v, f = box_grid(size, 4.0)
    return Shape(description="Cuboid 4 x 2 x 1 of eight vertices.", how="corners and diagonals",
                 vertices=v, faces=f, skeleton=spine(*size), note=SPINE,
                 parameters={"x": 4.0, "y": 2.0, "z": 1.0})


def torus72() -> Shape:
    v, f = torus_grid(1.0, 0.35, 12, 6)
    nodes = circle(1.0, 240)
    skeleton = Skeleton()
    skeleton.add(nodes, np.full(len(nodes), 0.35), np.zeros(len(nodes), bool), closed=True)
    return Shape(description="Torus of 12 x 6 vertices.", how="grid on the torus", vertices=v,
                 faces=f, genus=1, tips=0, junctions=0, skeleton=skeleton, complete=True,
                 note="The circle of the smooth torus. The mesh is so coarse that it is only "
                      "expected near; the polygon of the section centres is as right.",
                 parameters={"major": 1.0, "minor": 0.35})


def hand() -> Shape:
    fingers = [((-0.50, 0.3), (-0.86, 1.32), 0.105), ((-0.17, 0.4), (-0.29, 1.72), 0.12),
               ((0.17, 0.4), (0.22, 1.85), 0.125), ((0.50, 0.3), (0.72, 1.6), 0.12),
               ((0.40, -0.3), (1.25, 0.42), 0.14)]
    tubes = [line((*a, 0), (*b, 0), r) for a, b, r in fingers]
    tubes.append(line((0, -0.4, 0), (0, -1.5, 0), 0.3))
    palm = thick_rectangle(0.42, 0.42, 0.2)
    return tube_shape(tubes, 0.047, blend=0.05, rest=[palm], complete=False, tips=6,
                      rest_box=np.array([[-0.62, -0.62, -0.2], [0.62, 0.62, 0.2]]),
                      description="Hand: flat palm, five fingers, a wrist as the sixth tip.",
                      parameters={"palm_half": 0.42, "palm_radius": 0.2, "wrist_radius": 0.3})


def cup() -> Shape:
    radius, height, wall, handle = 0.7, 1.3, 0.16, 0.1
    path = arc((radius, height / 2.0), 0.4, -90.0, 90.0)
    tube = Tube(np.stack([path[:, 0], 0.0 * path[:, 0], path[:, 1]], axis=1), handle)

    def outer_part(x: Array) -> Array:
        # Cut inside the wall, so that nothing of the handle sticks into the cup.
        return np.maximum(tube(x), radius - np.hypot(x[:, 0], x[:, 1]))

    body, blend = cup_body(radius, height, wall), 0.05
    nodes = skeleton_of_tubes([tube], [body], blend, 0.015, complete=False)
    low = np.array([-radius - wall, -radius - wall, -wall])
    high = np.array([radius + 0.4 + handle, radius + wall, height + wall])
    return field_shape(union([body, outer_part], blend), low, high, 0.056, genus=1,
                       description="Cup with a wall, a bottom and a handle.", skeleton=nodes,
                       parameters={"radius": radius, "height": height, "wall": wall,
                                   "handle_radius": handle, "blend": blend},
                       note=TUBULAR + " Given for the handle alone. The wall and the bottom are "
                            "sheets: all points of the cylinder of the given radius, 0 <= z <= "
                            "height, and of its bottom disc at z = 0, but for the corner "
                            "between them and the root of the handle, are exactly medial.")


PROFILE = {"profile_radius": 0.26, "half_angle_deg": 80.0, "wall": 0.2}


def letter(strokes: list[Array], open_ends: list[tuple[int, int]], cell: float,
           **truth) -> Shape:
    """A letter whose section is a gutter, open above; expected curve: the middle of its bottom."""
    gutter = channel(strokes, open_ends, PROFILE["profile_radius"],
                     np.radians(PROFILE["half_angle_deg"]), PROFILE["wall"])
    points = np.concatenate(strokes)
    reach = PROFILE["profile_radius"] + PROFILE["wall"]
    skeleton = Skeleton()
    for stroke in strokes:
        nodes = flat(stroke[::4], -PROFILE["profile_radius"])
        skeleton.add(nodes, np.full(len(nodes), PROFILE["wall"] / 2.0),
                     np.zeros(len(nodes), bool))
    skeleton.weld(1e-9)
    return field_shape(gutter, [*(points.min(axis=0) - reach), -reach],
                       [*(points.max(axis=0) + reach), 0.2], cell, parameters=PROFILE,
                       skeleton=skeleton, complete=True,
                       note="Expected, not exact: the line along the bottom of the gutter, half a "
                            "wall from the surface. Where strokes are straight and apart it is "
                            "on the medial axis; the curve may lie higher, but inside the wall.",
                       **truth)


def letter_s() -> Shape:
    stroke = np.concatenate([arc((0.0, 0.75), 0.75, 15.0, 270.0),
                             arc((0.0, -0.75), 0.75, 90.0, -165.0)[1:]])
    return letter([stroke], [(0, 0), (0, -1)], 0.052, tips=2, junctions=0,
                  description="Letter S with a concave U section.")


def letter_g() -> Shape:
    bend = arc((0.0, 0.0), 1.0, 50.0, 350.0, 361)
    bar = segment(tuple(bend[-1]), (0.25, bend[-1][1]))
    return letter([bend, bar], [(0, 0), (1, -1)], 0.052, tips=2, junctions=0,
                  description="Letter G with a concave U section.")


def letter_p() -> Shape:
    stem_low, stem_high = segment((0.0, -1.5), (0.0, -0.1)), segment((0.0, -0.1), (0.0, 1.3))
    bowl = np.concatenate([segment((0.0, 1.3), (0.5, 1.3)),
                           arc((0.5, 0.6), 0.7, 90.0, -90.0)[1:],
                           segment((0.5, -0.1), (0.0, -0.1))[1:]])
    return letter([stem_low, stem_high, bowl], [(0, 0)], 0.052, genus=1, tips=1, junctions=1,
                  description="Letter P with a concave U section.")


def animal_parts() -> tuple[list[Tube], float]:
    """Limbs and body of the animal, symmetric about y = 0, and the width of the blend."""
    tubes = [line((-0.75, 0, 0), (0.75, 0, 0.05), 0.46, 0.42),
             line((0.75, 0, 0.15), (1.3, 0, 0.55), 0.3, 0.32),
             bezier([(1.45, 0, 0.5), (2.1, 0, 0.5), (1.9, 0, -0.3), (2.2, 0, -0.8)], 0.17, 0.1),
             bezier([(-1.0, 0, 0.2), (-1.5, 0, 0.4), (-1.5, 0, -0.2), (-1.9, 0, -0.1)],
                    0.13, 0.1)]
    for side in (-1.0, 1.0):
        tubes.append(line((0.62, 0.25 * side, -0.1), (0.68, 0.4 * side, -1.3), 0.19, 0.14))
        tubes.append(line((-0.62, 0.25 * side, -0.1), (-0.72, 0.4 * side, -1.3), 0.2, 0.14))
        tubes.append(line((1.25, 0.15 * side, 0.7), (1.1, 0.55 * side, 1.3), 0.13, 0.1))
    return tubes, 0.06


def animal() -> Shape:
    tubes, blend = animal_parts()
    return tube_shape(tubes, 0.052, blend=blend, complete=False, mirror=True, tips=8,
                      description="Animal: body, head, trunk, two horns, four legs, a tail.",
                      parameters={"limbs": 8})


def animal450() -> Shape:
    shape = animal()
    v, f = decimate(shape.vertices, shape.faces, 450)
    skeleton = shape.skeleton
    skeleton.exact[:] = False
    return Shape(description="The animal, decimated to 450 vertices.",
                 how="quadric edge collapses from `animal`", vertices=v, faces=f, tips=8,
                 skeleton=skeleton, parameters={"vertices": 450},
                 note="The axes of the limbs of the dense animal: expected, not exact." + LIMBS)


def head() -> Shape:
    def bump(direction: tuple[float, float, float], tip: float, ra: float, rb: float) -> Tube:
        d = np.array(direction) / np.linalg.norm(direction)
        return line(tuple(0.5 * d), tuple(tip * d), ra, rb)

    tubes = [bump((1, 0, -0.1), 1.22, 0.16, 0.13)]
    for side in (-1.0, 1.0):
        tubes.append(bump((-0.1, side, 0.55), 1.32, 0.2, 0.15))
        tubes.append(bump((0.45, 0.4 * side, 0.95), 1.32, 0.12, 0.1))
    # No ball: from its centre all points are closest, the worst case of any search tree.
    half_axes = (1.0, 0.88, 1.12)
    skull = ellipsoid(half_axes)
    return tube_shape(tubes, 0.054, blend=0.06, rest=[skull], complete=False, mirror=True, tips=5,
                      rest_box=np.array([[-a for a in half_axes], half_axes]),
                      description="Head, nearly a ball, with small bumps: two ears, two horns, "
                                  "a nose.",
                      parameters=dict(zip(("half_x", "half_y", "half_z"), half_axes)))


def twin_ears() -> Shape:
    tubes = [line((0, 0, -0.5), (0, 0, 0.35), 0.42, 0.3)]
    for side in (-1.0, 1.0):
        tubes.append(bezier([(0, 0.1 * side, 1.0), (0, 0.3 * side, 1.6), (-0.1, 0.35 * side, 1.9),
                             (-0.3, 0.85 * side, 2.1)], 0.15, 0.09))
        tubes.append(line((0, 0.2 * side, 0.2), (0.15, 0.95 * side, -0.05), 0.13, 0.11))
        tubes.append(line((0, 0.2 * side, -0.6), (0.1, 0.4 * side, -1.4), 0.18, 0.15))
    skull = ball((0, 0, 0.9), 0.42)
    return tube_shape(tubes, 0.045, blend=0.06, rest=[skull], complete=False, mirror=True, tips=6,
                      rest_box=np.array([[-0.42, -0.42, 0.48], [0.42, 0.42, 1.32]]),
                      description="Figure with two equal ears, two arms and two legs.",
                      parameters={"head_radius": 0.42})


def embrace() -> Shape:
    """Mother and child, as Fertility of Table 1: four arms' and legs' loops in one body."""
    tubes = [line((-0.6, 0, -0.6), (-0.6, 0, 0.7), 0.34, 0.3), line((-0.6, 0, 0.9), (-0.55, 0, 1.4), 0.15),
             line((-0.55, 0, 1.5), (-0.5, 0, 1.58), 0.3), line((0.75, 0, -0.3), (0.75, 0, 0.35), 0.22),
             line((0.75, 0, 0.4), (0.7, 0, 0.95), 0.11), line((0.7, 0, 1.03), (0.7, 0, 1.08), 0.22),
             bezier([(0.75, 0, 0.4), (0.1, 0, 0.75), (-0.6, 0, 0.7)], 0.1, 0.1),
             bezier([(-0.6, 0, -0.55), (0, 0, -0.75), (0.75, 0, -0.3)], 0.2, 0.16),
             line((0.2, 0, -1.9), (0.75, 0, -2.0), 0.15, 0.13)]
    for side in (-1.0, 1.0):
        tubes.append(bezier([(-0.6, 0.2 * side, 0.55), (-0.3, 0.95 * side, 0.5), (0.6, 0.85 * side, 0.2),
                             (0.75, 0.1 * side, 0.0)], 0.14, 0.11))
        tubes.append(bezier([(-0.6, 0.2 * side, -0.6), (-0.5, 0.85 * side, -0.9), (-0.2, 0.9 * side, -1.6),
                             (0.2, 0, -1.9)], 0.2, 0.15))
    return tube_shape(tubes, 0.06, blend=0.05, complete=False, mirror=True, genus=4, tips=3,
                      description="Mother and child: two heads, arms around each other, a lap, legs that meet.",
                      parameters={"loops": 4})


SHAPES: dict[str, Callable[[], Shape]] = {
    f.__name__: f for f in (
        capsule, bent_tube, taper, horn, y_tube, tree, torus, knot, torus_capsule, plate3, slab,
        cuboid, hand, cup, letter_s, letter_g, letter_p, animal, head, twin_ears, embrace, box8,
        torus72, animal450)
}
