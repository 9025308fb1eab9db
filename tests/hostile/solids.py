# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile meshes that bound solids: spiky, thin, long, many, tiny, far away, entangled."""

from __future__ import annotations

import numpy as np

from .expectation import Hostile, either, skeleton, skeleton_if, standing_for
from .primitives import (Mesh, Rng, box, cell_surface, component_of_vertices, diagonal,
                         edges as edges_of, filled_to_manifold, genus, halved, hull, joined, log_uniform, prism, revolved,
                         rotation, sphere, tube, turned)

# The pipeline takes coordinates in single precision: a body that is thinner than this, compared with its
# length, may come out flat, and then it is refused.
SINGLE = 1e-6
THIN = "thinner than single precision resolves: it may be found to be flat"


def cloud(rng: Rng, count: int) -> np.ndarray:
    """Points of one of several kinds of cloud, about of size one."""
    kind = rng.integers(4)
    points = rng.normal(size=(count, 3))
    if kind == 1:
        points /= np.linalg.norm(points, axis=1)[:, None]
    elif kind == 2:
        points = rng.uniform(-1, 1, size=(count, 3))
    elif kind == 3:
        points *= rng.pareto(1.5, size=(count, 1)) + 0.1
        points /= abs(points).max()
    return points


def ball(rng: Rng, level: int = 2) -> Mesh:
    """A round body of random proportions, of about size one."""
    vertices, faces = sphere(level)
    return turned(rng, (vertices * np.exp(rng.uniform(-0.7, 0.7, 3)), faces))


def convex_hull(rng: Rng) -> Hostile:
    """Convex hulls of 4 to 200 points, their proportions up to 1 : 100."""
    points = cloud(rng, int(log_uniform(rng, 4, 200)))
    return skeleton(turned(rng, hull(points * [1, log_uniform(rng, 0.1, 1), log_uniform(rng, 0.01, 1)])))


def star(rng: Rng) -> Hostile:
    """Balls whose vertices are drawn in and out, each by its own factor up to 30."""
    vertices, faces = sphere(int(rng.integers(1, 4)))
    reach = np.exp(rng.uniform(-1, 1, len(vertices)) * rng.uniform(0, 1.7))
    spikes = rng.random(len(vertices)) < rng.uniform(0, 0.3)
    return skeleton((vertices * reach[:, None], faces),
                    extent=float(reach[spikes].sum() + 4 * np.sort(reach)[-40:].sum()))


def urchin(rng: Rng) -> Hostile:
    """A ball with a few spikes, up to a thousand times as long as it is wide."""
    vertices, faces = sphere(int(rng.integers(1, 4)))
    chosen = rng.choice(len(vertices), size=int(rng.integers(1, 12)), replace=False)
    reach = np.ones(len(vertices))
    reach[chosen] = [log_uniform(rng, 2, 1000) for _ in chosen]
    return skeleton((vertices * reach[:, None], faces), extent=float(reach[chosen].sum()) + 2)


def needle(rng: Rng) -> Hostile:
    """A body of 5 to 200 vertices, 1 : 10 to 1 : 1e9."""
    thickness = log_uniform(rng, 1e-9, 0.1)
    kind = rng.integers(3)
    if kind == 0:
        sides = int(rng.integers(3, 9))
        angle = 2 * np.pi * np.arange(sides) / sides
        ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)])
        mesh = hull(np.vstack([ring, [[0, 0, 1], [0, 0, -rng.uniform(0.01, 1)]]]))
    elif kind == 1:
        mesh = sphere(int(rng.integers(0, 3)))
    else:
        mesh = hull(cloud(rng, int(rng.integers(6, 100))))
    mesh = mesh[0] * [thickness, thickness, 1], mesh[1]
    return skeleton_if(thickness > SINGLE, turned(rng, mesh), THIN, embedded=thickness > SINGLE)


def plate(rng: Rng) -> Hostile:
    """A plate of 12 or more triangles, 1 : 10 to 1 : 1e9."""
    thickness = log_uniform(rng, 1e-9, 0.1)
    n = int(rng.integers(1, 20))
    planes = np.linspace(0, 1, n + 1)
    mesh = cell_surface(np.ones((n, n, 1), bool), [planes, planes, np.array([0, thickness])])
    if rng.random() < 0.5:
        mesh = turned(rng, mesh)
    return skeleton_if(thickness > 10 * SINGLE, mesh, THIN, embedded=thickness > 10 * SINGLE)


def bowl(rng: Rng) -> Hostile:
    """A thin shell with one opening: wide, or so narrow that it is nearly a hollow ball."""
    thickness = log_uniform(rng, 1e-4, 0.2)
    opening = log_uniform(rng, 0.02, 2)
    rows = int(rng.integers(6, 20))
    angle = np.linspace(np.pi, opening, rows)
    radii = np.concatenate([np.sin(angle), (1 - thickness) * np.sin(angle[::-1])])
    heights = np.concatenate([np.cos(angle), (1 - thickness) * np.cos(angle[::-1])])
    sides = int(rng.integers(6, 30))
    # A facet of the outer wall must not reach the inner one.
    thick = 1 - np.cos(np.pi / sides) * np.cos((np.pi - opening) / rows / 2) < thickness / 2
    return skeleton(turned(rng, revolved(radii, heights, sides)), embedded=bool(thick))


def hair(rng: Rng) -> Hostile:
    """A tube along a helix or a wave, 1 : 10 to 1 : 1e5."""
    count = int(rng.integers(10, 200))
    t = np.linspace(0, 1, count)
    turns = rng.uniform(0.2, 4)
    phase = 2 * np.pi * turns * t
    if rng.random() < 0.5:
        path = np.column_stack([np.cos(phase), np.sin(phase), 0.6 * turns * t])
        widest = 0.1
    else:
        path = np.column_stack([2 * turns * t, 0.5 * np.sin(phase), np.zeros(count)])
        widest = 0.03
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    radius = log_uniform(rng, 1e-5, widest)
    # Rings must not cross where the path bends; where it bends more sharply than by a radian, they are turned
    # against each other, and the walls between them cross.
    step = length / count
    bend = 2 * np.pi * turns / count
    embedded = radius * bend < 0.3 * step and bend < 1
    return skeleton(turned(rng, tube(path, radius, int(rng.integers(3, 8)))), embedded=bool(embedded),
                    extent=length)


def tree(rng: Rng) -> Hostile:
    """Boxes that branch at right angles, each generation less than half as long as the last."""
    depth = int(rng.integers(1, 5))
    ratio = rng.uniform(0.25, 0.45)
    width = log_uniform(rng, 1e-4, 0.1)
    vertices = [list(p) for p in (box()[0] - 0.5) * width]
    directions = np.vstack([np.eye(3), -np.eye(3)])
    corners = np.array(vertices)
    faces: list[tuple[int, ...]] = []
    growing: list[tuple[np.ndarray, list[int], float, int]] = []

    def cap(numbers: list[int], centre: np.ndarray, direction: np.ndarray) -> list[int]:
        """The four of the numbers that lie ahead of the centre, counterclockwise seen from outside."""
        points = np.array([vertices[i] for i in numbers])
        ahead = (points - centre) @ direction
        four = [numbers[i] for i in np.argsort(-ahead)[:4]]
        side = np.eye(3)[np.argmin(abs(direction))]
        up = np.cross(direction, side)
        points = np.array([vertices[i] for i in four]) - centre
        angle = np.arctan2(points @ up, points @ side)
        return [four[i] for i in np.argsort(angle)]

    start = list(range(len(corners)))
    for direction in directions:
        four = cap(start, np.zeros(3), direction)
        if rng.random() < 0.7:
            growing.append((direction, four, 1.0, 1))
        else:
            faces.append(tuple(four))
    extent = diagonal(corners)
    while growing:
        direction, four, length, generation = growing.pop()
        extent += length
        # A limb, and a cube at its end that the next limbs leave from.
        ring = four
        scale = rng.uniform(0.7, 1) if generation < depth else rng.uniform(0.1, 1)
        for advance in (length, width * 0.8 ** generation):
            points = np.array([vertices[i] for i in ring])
            middle = points.mean(axis=0)
            moved = middle + (points - middle) * scale + direction * advance
            scale = 1.0
            fresh = list(range(len(vertices), len(vertices) + 4))
            vertices += [list(p) for p in moved]
            last = ring
            ring = fresh
            if advance == length:
                faces += [(last[k], last[(k + 1) % 4], ring[(k + 1) % 4], ring[k]) for k in range(4)]
        cube = last + ring
        centre = np.array([vertices[i] for i in cube]).mean(axis=0)
        for ahead in directions:
            if ahead @ direction < -0.5:
                continue
            side = cap(cube, centre, ahead)
            if generation < depth and rng.random() < 0.6:
                growing.append((ahead, side, length * ratio, generation + 1))
            else:
                faces.append(tuple(side))
    quads = np.array(faces)
    triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = np.array(vertices), triangles
    return skeleton(turned(rng, mesh), extent=extent)


def lattice(rng: Rng) -> Hostile:
    """Struts along a cubic grid, of genus up to 150."""
    counts = rng.integers(2, 5, 3)
    if rng.random() < 0.3:
        counts = np.array([5, 5, 4])  # genus 136
    width = log_uniform(rng, 0.02, 0.6)
    cells = np.zeros(2 * counts - 1, bool)
    x, y, z = np.indices(cells.shape)
    cells[((x % 2) + (y % 2) + (z % 2)) <= 1] = True
    planes = [np.concatenate([[i, i + width] for i in range(n)]) for n in counts]
    mesh = cell_surface(cells, planes)
    struts = sum((counts[a] - 1) * counts[(a + 1) % 3] * counts[(a + 2) % 3] for a in range(3))
    shear = np.eye(3) + rng.uniform(-0.3, 0.3, (3, 3))
    return skeleton((mesh[0] @ shear.T, mesh[1]), genus=int(struts - counts.prod() + 1),
                    extent=float(struts) * 1.3)


def sieve(rng: Rng) -> Hostile:
    """A plate with many holes."""
    counts = rng.integers(1, 11, 2)
    cells = np.ones((2 * counts[0] + 1, 2 * counts[1] + 1, 1), bool)
    cells[1::2, 1::2] = False
    bar = log_uniform(rng, 0.02, 1)
    planes = [np.concatenate([[0], np.cumsum([bar if i % 2 == 0 else 1 for i in range(2 * n + 1)])])
              for n in counts]
    mesh = cell_surface(cells, planes + [np.array([0, log_uniform(rng, 0.01, 1)])])
    bars = (counts[0] + 1) * counts[1] + counts[0] * (counts[1] + 1)
    return skeleton(turned(rng, mesh), genus=int(counts.prod()), extent=float(bars * (1 + bar)))


def crystal(rng: Rng) -> Hostile:
    """Random cells of a grid whose planes lie up to 1 : 1000 closer in some places than in others."""
    cells = filled_to_manifold(rng.random(rng.integers(2, 6, 3)) < rng.uniform(0.3, 0.8))
    if not cells.any():
        cells[0, 0, 0] = True
    spread = rng.uniform(0, 3.5)
    planes = [np.concatenate([[0], np.cumsum(np.exp(rng.uniform(-spread, spread, n)))])
              for n in cells.shape]
    mesh = cell_surface(cells, planes)
    count, _ = component_of_vertices(len(mesh[0]), mesh[1])
    return skeleton(turned(rng, mesh), components=count, genus=genus(mesh),
                    extent=float(sum(p[-1] for p in planes) * 3))


def comb(rng: Rng) -> Hostile:
    """A bar with thin teeth, close together."""
    teeth = int(rng.integers(2, 30))
    thickness, gap, length = log_uniform(rng, 1e-3, 1), log_uniform(rng, 1e-4, 1), log_uniform(rng, 0.3, 30)
    cells = np.zeros((2 * teeth - 1, 1, 2), bool)
    cells[:, :, 0] = True
    cells[::2, :, 1] = True
    planes = np.concatenate([[0], np.cumsum([thickness if i % 2 == 0 else gap
                                             for i in range(2 * teeth - 1)])])
    depth = log_uniform(rng, 1e-2, 1)
    mesh = cell_surface(cells, [planes, np.array([0, depth]), np.array([0, thickness, length])])
    return skeleton(turned(rng, mesh), extent=float(teeth * length + planes[-1]))


def slot(rng: Rng) -> Hostile:
    """A block with a slit of 1e-6 to 1e-1 of its size; its two jaws nearly touch."""
    gap = log_uniform(rng, 1e-6, 0.1)
    cells = np.ones((3, 1, 2), bool)
    cells[1, 0, 1] = False
    planes = [np.array([0, 1, 1 + gap, 2 + gap]), np.array([0, rng.uniform(0.2, 2)]),
              np.array([0, rng.uniform(0.1, 1), 2])]
    mesh = cell_surface(cells, planes)
    for _ in range(rng.integers(0, 3)):
        mesh = halved(mesh)
    return skeleton(mesh)


def spiral(rng: Rng) -> Hostile:
    """A tube wound up in a plane; the walls of its turns come as close as a thousandth."""
    turns = rng.uniform(1, 4)
    count = int(turns * 24)
    t = np.linspace(0, 1, count)
    pitch = 1.0
    r = 0.8 + pitch * turns * t
    phase = 2 * np.pi * turns * t
    path = np.column_stack([r * np.cos(phase), r * np.sin(phase), np.zeros(count)])
    sides = int(rng.integers(4, 10))
    # Chords of the inner and outer turn stay this much apart less than the pitch.
    sag = r.max() * (1 - np.cos(np.pi / 24))
    gap = log_uniform(rng, 1e-3, 0.5)
    radius = (pitch - 2 * sag) / 2 * (1 - gap)
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    return skeleton(turned(rng, tube(path, 0.9 * radius, sides)), extent=length)


def knot(rng: Rng) -> Hostile:
    """A tube along a torus knot."""
    p, q = [(2, 3), (3, 2), (2, 5), (3, 4), (1, 6), (5, 2)][rng.integers(6)]
    count = int(rng.integers(60, 200))
    t = 2 * np.pi * np.arange(count) / count
    reach = 2 + 0.8 * np.cos(q * t)
    path = np.column_stack([reach * np.cos(p * t), reach * np.sin(p * t), 0.8 * np.sin(q * t)])
    radius = log_uniform(rng, 1e-4, 0.08)
    length = float(np.linalg.norm(np.roll(path, -1, axis=0) - path, axis=1).sum())
    return skeleton(tube(path, radius, int(rng.integers(3, 9)), closed=True), genus=1, extent=length)


def ring(rng: Rng) -> Hostile:
    """A torus, from as thin as a hair to a hole of a millionth."""
    hole = log_uniform(rng, 1e-6, 1)
    around = int(rng.integers(8, 40))
    angle = 2 * np.pi * np.arange(around) / around
    path = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(around)])
    radius = (1 - hole) if rng.random() < 0.5 else log_uniform(rng, 1e-5, 0.5)
    return skeleton(turned(rng, tube(path, radius, int(rng.integers(3, 16)), closed=True)), genus=1,
                    extent=2 * np.pi)


def band(rng: Rng) -> Hostile:
    """A thick strip that is closed after half turns: a solid with the shape of a Moebius strip."""
    around = int(rng.integers(30, 150))
    angle = 2 * np.pi * np.arange(around) / around
    path = 3 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(around)])
    turn = int(rng.choice([0, 2, -2, 4]))
    # Each wall bends inwards between rings; with this much turn it stays clear of the other one.
    flat = log_uniform(rng, 1.5 * (abs(turn) + 2) * np.pi / 2 / around, 1)
    section = np.array([(1, flat), (-1, flat), (-1, -flat), (1, -flat)])
    return skeleton(tube(path, rng.uniform(0.1, 0.8), 4, closed=True, section=section, turn=turn), genus=1,
                    extent=6 * np.pi)


def twisted_prism(rng: Rng) -> Hostile:
    """A polygon drawn upwards, each ring turned: by a little, or until the walls cross."""
    rings, sides = int(rng.integers(2, 40)), int(rng.integers(3, 9))
    twist = rng.uniform(0, np.pi) if rng.random() < 0.5 else rng.uniform(0, 0.3)
    path = np.column_stack([np.zeros(rings), np.zeros(rings), np.linspace(0, rng.uniform(0.5, 20), rings)])
    mesh = tube(path, log_uniform(rng, 0.01, 1), sides, twist=twist)
    return skeleton_if(twist <= 0.3, turned(rng, mesh), "walls that cross may enclose nothing",
                       embedded=twist <= 0.3)


def screw(rng: Rng) -> Hostile:
    """A long thin rectangle, drawn upwards and turned many times."""
    rings = int(rng.integers(20, 150))
    path = np.column_stack([np.zeros(rings), np.zeros(rings), np.linspace(0, rng.uniform(1, 10), rings)])
    flat = log_uniform(rng, 0.02, 1)
    section = np.array([(1, flat), (-1, flat), (-1, -flat), (1, -flat)])
    # Each wall bends inwards between rings; with this much turn it stays clear of the other one.
    twist = min(0.3, flat)
    return skeleton(turned(rng, tube(path, rng.uniform(0.2, 1), 4, section=section, twist=twist)))


def star_prism(rng: Rng) -> Hostile:
    """A polygon with long and short corners, drawn up, its ends made of long thin triangles."""
    n = int(log_uniform(rng, 5, 300))
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    reach = np.exp(rng.uniform(-1, 1, n) * rng.uniform(0, 2))
    polygon = np.column_stack([np.cos(angle), np.sin(angle)]) * reach[:, None]
    return skeleton(turned(rng, prism(polygon, log_uniform(rng, 1e-3, 10))),
                    extent=float(reach.sum()))


def cusp(rng: Rng) -> Hostile:
    """A horn or spindle whose radius goes to zero faster than linearly."""
    rows = int(rng.integers(5, 40))
    t = np.linspace(0, 1, rows)
    power = rng.uniform(1, 6)
    radii = rng.uniform(0.05, 1) * (t ** power if rng.random() < 0.5 else np.sin(np.pi * t) ** power)
    radii[[0, -1]] = 0
    heights = t * rng.uniform(1, 5)
    thinnest = radii[1:-1].min() / heights[-1]
    return skeleton(turned(rng, revolved(radii, heights, int(rng.integers(3, 24)))),
                    embedded=bool(thinnest > SINGLE))


def wheel(rng: Rng) -> Hostile:
    """Two vertices that up to two thousand triangles meet at."""
    sides = int(log_uniform(rng, 20, 2000))
    height = log_uniform(rng, 0.01, 10)
    return skeleton(turned(rng, revolved(np.array([0, 1, 0.0]), np.array([-height, 0, height]), sides)))


def sliver(rng: Rng) -> Hostile:
    """A body whose edges are cut at 1e-9 to 1e-1 of their length, again and again."""
    vertices, faces = ball(rng, int(rng.integers(0, 3))) if rng.random() < 0.5 else box()
    vertices, faces = list(vertices), [tuple(t) for t in faces]
    smallest = 1.0
    for _ in range(int(rng.integers(1, 30))):
        a, b, _c = faces[rng.integers(len(faces))]
        part = log_uniform(rng, 1e-9, 0.5)
        smallest = min(smallest, part)
        middle = len(vertices)
        vertices.append(vertices[a] + part * (vertices[b] - vertices[a]))
        cut = []
        for t in faces:
            if a in t and b in t:
                cut += [tuple(middle if v == b else v for v in t), tuple(middle if v == a else v for v in t)]
            else:
                cut.append(t)
        faces = cut
    # A new vertex lies on an old edge: the surface stays where it was, some triangles have no area.
    return skeleton((np.array(vertices), np.array(faces)))


def uneven(rng: Rng) -> Hostile:
    """Triangles a thousand times as large in one place as in another."""
    vertices, faces = box((1, 1, 1))
    for _ in range(int(rng.integers(4, 10))):
        target = np.array([0, 0, 0])
        centre = vertices[faces].mean(axis=1)
        near = np.linalg.norm(centre - target, axis=1)
        chosen = near <= np.partition(near, min(6, len(near) - 1))[min(6, len(near) - 1)]
        fresh = []
        extra = []
        for f, t in enumerate(faces):
            if chosen[f]:
                middle = len(vertices) + len(extra)
                extra.append(vertices[t].mean(axis=0))
                fresh += [(t[0], t[1], middle), (t[1], t[2], middle), (t[2], t[0], middle)]
            else:
                fresh.append(tuple(t))
        vertices = np.vstack([vertices, extra])
        faces = np.array(fresh)
    return skeleton(turned(rng, (vertices * np.exp(rng.uniform(-1, 1, 3)), faces)))


def scale(rng: Rng) -> Hostile:
    """A body of 1e-30 to 1e30."""
    mesh = ball(rng) if rng.random() < 0.5 else hull(cloud(rng, 40))
    size = log_uniform(rng, 1e-30, 1e30)
    return skeleton_if(1e-12 < size < 1e12, (mesh[0] * size, mesh[1]), embedded=True,
                       why="areas and volumes of this size leave the range of single precision")


def far(rng: Rng) -> Hostile:
    """A body of size one, 1e2 to 1e15 from the origin."""
    mesh = ball(rng) if rng.random() < 0.5 else hull(cloud(rng, 40))
    offset = rng.normal(size=3)
    away = log_uniform(rng, 1e2, 1e15)
    offset *= away / np.linalg.norm(offset)
    return skeleton_if(away < 1e7, (mesh[0] + offset, mesh[1]), embedded=away < 1e9,
                       why="few digits are left for the shape itself, in the end none")


def inside_out(rng: Rng) -> Hostile:
    """All faces turned."""
    mesh = ball(rng)
    return skeleton((mesh[0], mesh[1][:, ::-1].copy()))


def partly_turned(rng: Rng) -> Hostile:
    """Some faces turned."""
    solid = vertices, faces = ball(rng)
    mask = rng.random(len(faces)) < rng.uniform(0, 1)
    faces = faces.copy()
    faces[mask] = faces[mask][:, ::-1]
    return standing_for(skeleton((vertices, faces)), solid)


def nested(rng: Rng) -> Hostile:
    """Bodies within bodies, each a solid of its own, some of them inside out."""
    count = int(rng.integers(2, 8))
    centre = rng.normal(size=3)
    bodies = []
    for i in range(count):
        vertices, faces = sphere(int(rng.integers(0, 3)))
        size = 0.6 ** i
        bodies.append((vertices @ rotation(rng).T * size + centre,
                       faces[:, ::-1] if rng.random() < 0.5 else faces))
    return skeleton(joined(*bodies), components=count)


def crossing(rng: Rng) -> Hostile:
    """Bodies that cross each other."""
    count = int(rng.integers(2, 6))
    bodies = [ball(rng, int(rng.integers(0, 3))) for _ in range(count)]
    return skeleton(joined(*[(v + rng.normal(size=3) * 0.3, f) for v, f in bodies]), components=count)


def linked(rng: Rng) -> Hostile:
    """A chain of rings, one through the next."""
    count = int(rng.integers(2, 7))
    angle = 2 * np.pi * np.arange(16) / 16
    radius = log_uniform(rng, 1e-3, 0.2)
    rings = []
    for i in range(count):
        circle = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(16)])
        if i % 2:
            circle = circle[:, [0, 2, 1]]
        rings.append(tube(circle + [1.2 * i, 0, 0], radius, 5, closed=True))
    return skeleton(joined(*rings), components=count, genus=count, extent=count * 2 * np.pi)


def crowd(rng: Rng) -> Hostile:
    """One to a thousand small bodies, apart from each other."""
    count = int(log_uniform(rng, 1, 1000)) if rng.random() < 0.8 else 1000
    places = np.stack(np.meshgrid(*[np.arange(10.0)] * 3), axis=-1).reshape(-1, 3)
    bodies = []
    for i in rng.permutation(1000)[:count]:
        kind = rng.integers(3)
        mesh = sphere(0) if kind == 0 else box() if kind == 1 else hull(rng.normal(size=(6, 3)))
        size = diagonal(mesh[0])
        bodies.append(((mesh[0] - mesh[0].mean(axis=0)) / size * rng.uniform(0.3, 0.9) + places[i],
                       mesh[1]))
    return skeleton(joined(*bodies), components=count)


def specks(rng: Rng) -> Hostile:
    """Up to 200 specks of 1e-8 to 1e-2 beside a body of size one."""
    count = int(log_uniform(rng, 1, 200))
    size = log_uniform(rng, 1e-8, 1e-2)
    vertices, faces = ball(rng)
    bodies = [(vertices / diagonal(vertices), faces)]
    smallest = 1.0
    for _ in range(count):
        own = size * rng.uniform(0.3, 1)
        smallest = min(smallest, own)
        mesh = box() if rng.random() < 0.5 else sphere(int(rng.integers(0, 2)))
        bodies.append((mesh[0] * own + rng.uniform(-1, 1, 3), mesh[1]))
    return skeleton_if(smallest > 10 * SINGLE, joined(*bodies), components=count + 1, embedded=True,
                       why="specks below single precision come out flat")


def touching(rng: Rng) -> Hostile:
    """Blocks that share whole faces, but no vertices: side by side, each a solid of its own."""
    count = int(rng.integers(2, 6))
    return skeleton(joined(*[(box()[0] + [i, 0, 0], box()[1]) for i in range(count)]), components=count)


def coincident(rng: Rng) -> Hostile:
    """The same body several times in the same place."""
    count = int(rng.integers(2, 5))
    mesh = ball(rng)
    return skeleton(joined(*[mesh] * count), components=count)


def stranger(rng: Rng) -> Hostile:
    """A body with vertices that no face uses, near or far."""
    vertices, faces = ball(rng)
    extra = rng.normal(size=(int(rng.integers(1, 30)), 3)) * log_uniform(rng, 1, 10)
    far_off = rng.random() < 0.3
    if far_off:
        extra *= log_uniform(rng, 1e3, 1e20)
    mixed = np.vstack([extra, vertices])
    if far_off:
        made = either((mixed, faces + len(extra)), embedded=True,
                      why="lengths are parts of a bounding box that is far larger than the body")
    else:
        made = skeleton((mixed, faces + len(extra)))
    return made


def facet_soup(rng: Rng) -> Hostile:
    """A closed body in triangles that share no vertices, as STL has it."""
    solid = vertices, faces = ball(rng) if rng.random() < 0.7 else hull(cloud(rng, 30))
    order = rng.permutation(len(faces))
    made = skeleton((vertices[faces[order]].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)))
    made.expected.extent = diagonal(vertices)
    return standing_for(made, solid)


def copied_faces(rng: Rng) -> Hostile:
    """Faces that are there twice or more."""
    solid = vertices, faces = ball(rng)
    again = faces[rng.integers(len(faces), size=int(rng.integers(1, 40)))]
    again = np.roll(again, int(rng.integers(3)), axis=1)
    return standing_for(skeleton((vertices, np.vstack([faces, again]))), solid)


def degenerate_faces(rng: Rng) -> Hostile:
    """Faces that use a vertex twice, among sound ones."""
    solid = vertices, faces = ball(rng)
    bad = rng.integers(len(vertices), size=(int(rng.integers(1, 20)), 3))
    bad[:, 1] = bad[:, 0]
    return standing_for(skeleton((vertices, rng.permutation(np.vstack([faces, bad])))), solid)


def self_crossing_spiral(rng: Rng) -> Hostile:
    """A tube that runs into itself."""
    turns = rng.uniform(1, 5)
    count = int(turns * 24)
    t = np.linspace(0, 1, count)
    phase = 2 * np.pi * turns * t
    reach = 0.3 + rng.uniform(0, 1) * t
    path = np.column_stack([reach * np.cos(phase), reach * np.sin(phase), rng.uniform(0, 0.3) * turns * t])
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    return skeleton(tube(path, rng.uniform(0.05, 0.4), int(rng.integers(3, 10))), embedded=False,
                    extent=length)


def noise(rng: Rng) -> Hostile:
    """A ball whose vertices are moved by up to half its size, in any direction."""
    vertices, faces = sphere(int(rng.integers(1, 4)))
    vertices = vertices + rng.uniform(0.02, 1) * rng.normal(size=vertices.shape) * 0.5
    reach = np.linalg.norm(vertices, axis=1)
    beside = reach.copy()  # the farthest of the neighbours
    for a, b in edges_of(faces):
        beside[a], beside[b] = max(beside[a], reach[b]), max(beside[b], reach[a])
    return either((vertices, faces),
                  "parts that are inside out may outweigh the others, and no volume be left",
                  extent=20.0 + float(reach[reach >= beside].sum()))


def waist(rng: Rng) -> Hostile:
    """A dumbbell whose waist has no radius, or next to none."""
    rows = 2 * int(rng.integers(3, 12)) + 1
    t = np.linspace(0, np.pi, rows)
    radii = abs(np.sin(2 * t))
    middle = 0.0 if rng.random() < 0.5 else log_uniform(rng, 1e-12, 1e-2)
    radii[rows // 2] = middle
    radii[[0, -1]] = 0
    return skeleton(turned(rng, revolved(radii, 2 * np.cos(t[::-1]), int(rng.integers(3, 20)))),
                    embedded=middle > SINGLE)


def fin(rng: Rng) -> Hostile:
    """A ball with spikes or fins that have no thickness."""
    vertices, faces = sphere(int(rng.integers(0, 3)))
    vertices, faces = list(vertices), [tuple(t) for t in faces]
    for f in rng.choice(len(faces), size=int(rng.integers(1, 6)), replace=False):
        # The face becomes two, with a sheet between them: out along one edge and back.
        a, b, c = faces[f]
        tip = len(vertices)
        middle = (vertices[a] + vertices[b]) / 2
        vertices.append(middle * rng.uniform(1.5, 4))
        faces[f] = (a, b, tip)
        faces.append((b, c, tip))
        faces.append((c, a, tip))
    return skeleton((np.array(vertices), np.array(faces)), embedded=False, extent=40.0)


def bent_sheet(rng: Rng) -> Hostile:
    """A thin plate bent into a wave or rolled up."""
    n = int(rng.integers(10, 40))
    thickness = log_uniform(rng, 1e-4, 0.05)
    t = np.linspace(0, 1, n)
    if rng.random() < 0.5:
        path = np.column_stack([4 * t, 0.4 * np.sin(rng.uniform(0.5, 2) * 2 * np.pi * t), np.zeros(n)])
    else:
        phase = rng.uniform(1, 5) * t
        path = np.column_stack([np.cos(phase), np.sin(phase), np.zeros(n)])
    section = np.array([(1, thickness), (-1, thickness), (-1, -thickness), (1, -thickness)])
    # The first normal is across the plane of the path or in it: try both.
    if rng.random() < 0.5:
        section = section[:, ::-1][::-1]
    bend = np.linalg.norm(np.diff(path, 2, axis=0), axis=1).max() / np.linalg.norm(
        np.diff(path, axis=0), axis=1).min() ** 2
    width = rng.uniform(0.1, 1)
    return skeleton(turned(rng, tube(path, width, 4, section=section)), embedded=bool(bend * width < 0.3))


def wedge(rng: Rng) -> Hostile:
    """A block that ends in an edge of no thickness: angles from a millionth to a quarter turn."""
    angle = log_uniform(rng, 1e-6, 1)
    points = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (1, 0, angle), (1, 1, angle)], float)
    points[:, 1] *= log_uniform(rng, 1e-3, 10)
    mesh = hull(points)
    for _ in range(rng.integers(0, 3)):
        mesh = halved(mesh)
    return skeleton_if(angle > 10 * SINGLE, turned(rng, mesh), THIN, embedded=angle > 10 * SINGLE)


def stairs(rng: Rng) -> Hostile:
    """Blocks of 1 : 1 to 1 : 1e5 on top of each other."""
    steps = int(rng.integers(2, 8))
    size = np.cumsum(np.exp(rng.uniform(0, 11, steps)))
    cells = np.zeros((steps, steps, steps), bool)
    for i in range(steps):
        cells[: i + 1, : i + 1, steps - 1 - i] = True
    planes = np.concatenate([[0], size / size[-1]])
    heights = np.concatenate([[0], np.cumsum(np.exp(rng.uniform(-6, 0, steps)))])
    sound = min(np.diff(planes).min(), np.diff(heights).min() / heights[-1]) > 10 * SINGLE
    return skeleton(turned(rng, cell_surface(cells, [planes, planes, heights])), embedded=bool(sound))


FAMILIES = [
    convex_hull, star, urchin, needle, plate, bowl, hair, tree, lattice, sieve, crystal, comb, slot, spiral,
    knot, ring, band, twisted_prism, screw, star_prism, cusp, wheel, sliver, uneven, scale, far, inside_out,
    partly_turned, nested, crossing, linked, crowd, specks, touching, coincident, stranger, facet_soup,
    copied_faces, degenerate_faces, self_crossing_spiral, noise, waist, fin, bent_sheet, wedge, stairs]
