# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees whose centreline, radii and tips are known: unions of round cones.

A tree is grown from its root, branch by branch; each branch bends by chance and tapers, and none comes near
another one but where they meet. Its surface is the union of the convex hulls of neighbouring balls, exact but
for the number of sides, by the library manifold3d. The same seed gives the same tree.
"""
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

Array = np.ndarray


@dataclass
class Centreline:
    """Nodes (x, y, z, radius) and edges; each edge is a round cone."""

    nodes: list[Array] = field(default_factory=list)
    edges: list[tuple[int, int]] = field(default_factory=list)

    def add(self, point: Array, radius: float, parent: int = -1) -> int:
        """Append a node, joined to `parent` unless that is -1; returns its number."""
        self.nodes.append(np.append(point, radius))
        if parent >= 0:
            self.edges.append((parent, len(self.nodes) - 1))
        return len(self.nodes) - 1

    def arrays(self) -> tuple[Array, Array]:
        """Nodes (n, 4) and edges (m, 2)."""
        return np.array(self.nodes), np.array(self.edges, int)

    def clear_of(self, a: Array, b: Array, ra: float, rb: float, skip: set[int]) -> bool:
        """Whether a round cone is apart from all others but those at the nodes of `skip`."""
        others = [e for e in self.edges if e[0] not in skip and e[1] not in skip]
        if not others:
            return True
        nodes, ends = np.array(self.nodes), np.array(others)
        p, q = nodes[ends[:, 0]], nodes[ends[:, 1]]
        thick, apart = max(ra, rb), 1.5
        gap = segment_distances(a, b, p[:, :3], q[:, :3])
        return bool(np.all(gap > apart * (thick + np.maximum(p[:, 3], q[:, 3]))))


def segment_distances(a: Array, b: Array, p: Array, q: Array, samples: int = 17) -> Array:
    """Distances from points along one segment, the least of them, to each of many segments."""
    points = a + (b - a) * np.linspace(0.0, 1.0, samples)[:, None]
    along = q - p
    t = np.einsum("sek,ek->se", points[:, None] - p, along) / np.maximum((along**2).sum(1), 1e-300)
    nearest = p + np.clip(t, 0.0, 1.0)[..., None] * along
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=0)


def turned(direction: Array, angle: float, rng: np.random.Generator) -> Array:
    """A unit vector at an angle from another one, about it anywhere."""
    aside = np.cross(direction, rng.normal(size=3))
    aside /= np.linalg.norm(aside)
    return np.cos(angle) * direction + np.sin(angle) * aside


def grow_branch(line: Centreline, start: int, direction: Array, length: float, radius: float,
                end_radius: float, rng: np.random.Generator, bend: float = 0.15, pieces: int = 5,
                siblings: frozenset[int] = frozenset()) -> tuple[int, Array] | None:
    """A branch out of a node: its tip and its last direction; None where there is no room."""
    first_node, first_edge = len(line.nodes), len(line.edges)
    at = start
    # A branch leaves its parent's ball before it can be near anything else.
    skip = {start} | set(siblings)
    for k in range(pieces):
        direction = turned(direction, abs(rng.normal(0, bend)) if k else 0.0, rng)
        r = radius + (end_radius - radius) * (k + 1) / pieces
        before = line.nodes[at]
        after = before[:3] + direction * (length / pieces)
        if not line.clear_of(before[:3], after, before[3] if k else radius, r, skip | {at}):
            del line.nodes[first_node:], line.edges[first_edge:]
            return None
        at = line.add(after, r, at)
    return at, direction


def forked(line: Centreline, start: int, direction: Array, length: float, radius: float,
           levels: int, ratio: float, shrink: float, rng: np.random.Generator) -> None:
    """Two branches at a node, and two at each of their ends, until `levels` is 0."""
    if levels == 0:
        return
    first = len(line.nodes)
    for side in range(2):
        for attempt in range(200):
            way = turned(direction, np.radians(rng.uniform(25, 60)), rng)
            r = radius * ratio * rng.uniform(0.9, 1.1)
            if side and attempt < 150:  # away from its sister
                sister = line.nodes[first][:3] - line.nodes[start][:3]
                if way @ sister > np.cos(np.radians(50)) * np.linalg.norm(sister):
                    continue
            end = grow_branch(line, start, way, length * rng.uniform(0.8, 1.2), r, 0.9 * r, rng,
                              siblings=frozenset({first}) if side else frozenset())
            if end is not None:
                forked(line, end[0], end[1], length * shrink, 0.9 * r, levels - 1, ratio, shrink,
                       rng)
                break


def tree(seed: int, levels: int = 4, thickest: float = 1.5, ratio: float = 0.6,
         shrink: float = 0.75) -> Centreline:
    """Binary tree of 2^levels tips at its ends and one at its root; a trunk of length 30."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    root = line.add(np.zeros(3), thickest)
    end = grow_branch(line, root, np.array([0.0, 0.0, 1.0]), 30.0, thickest, 0.9 * thickest, rng)
    assert end is not None
    forked(line, end[0], end[1], 30.0 * shrink, 0.9 * thickest, levels, ratio, shrink, rng)
    return line


def ways_apart(count: int, largest_cosine: float, rng: np.random.Generator) -> list[Array]:
    """Unit vectors, no two of which have a larger cosine."""
    ways: list[Array] = []
    while len(ways) < count:
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        if all(way @ other < largest_cosine for other in ways):
            ways.append(way)
    return ways


def neuron(seed: int, dendrites: int = 6, levels: int = 2, soma: float = 5.0,
           radius: float = 0.25, ratio: float = 0.6) -> Centreline:
    """A ball with thin forking dendrites."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    centre = line.add(np.zeros(3), soma)
    for way in ways_apart(dendrites, 0.6, rng):
        # The first piece is a round cone of the dendrite's own radius that starts in the soma.
        root = line.add(way * (soma - 2 * radius), radius)
        line.edges.append((centre, root))
        end = grow_branch(line, root, way, 25.0, radius, 0.9 * radius, rng,
                          siblings=frozenset({centre}))
        if end is not None:
            forked(line, end[0], end[1], 18.0, 0.9 * radius, levels, ratio, 0.75, rng)
    return line


def hedgehog(seed: int, body: float = 5.0) -> Centreline:
    """A ball with 8 to 24 straight spines: radii at the root 0.4 to 3 % of its own, half of that at the tip."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    centre = line.add(np.zeros(3), body)
    for way in ways_apart(int(rng.integers(8, 25)), np.cos(0.35), rng):
        radius = body * 10 ** rng.uniform(np.log10(0.004), np.log10(0.03))
        root = line.add(way * (body - 2 * radius), radius)
        line.edges.append((centre, root))
        line.add(way * body * rng.uniform(2, 3.5), radius / 2, root)
    return line


def arterial(seed: int, levels: int = 4) -> Centreline:
    """A vessel tree with a stenosis in its trunk: for 4 of its length a quarter as wide."""
    rng = np.random.default_rng(seed)
    line = Centreline()
    at = line.add(np.zeros(3), 1.5)
    for z, r in ((10, 1.45), (13, 0.4), (17, 0.4), (20, 1.4), (30, 1.35)):
        at = line.add(np.array([0.0, 0.0, float(z)]), r, at)
    forked(line, at, np.array([0.0, 0.0, 1.0]), 22.0, 1.35, levels, 0.65, 0.75, rng)
    return line


def lattice(cells: int = 2, radius: float = 0.05, edge: float = 4.0) -> Centreline:
    """Rods along the edges of a cubic grid: cells^3 cubes."""
    line = Centreline()
    number = {}
    side = range(cells + 1)
    for place in ((x, y, z) for x in side for y in side for z in side):
        number[place] = line.add(edge * np.array(place, float), radius)
        for axis in range(3):
            before = tuple(c - (k == axis) for k, c in enumerate(place))
            if before in number:
                line.edges.append((number[before], number[place]))
    return line


def creature(seed: int) -> Centreline:
    """A body with a head, ears, eyes, limbs that end in feet or fingers, and a tail, most of them by chance.

    What is in pairs is mirrored at y = 0, so that the shape is symmetric but for its triangles.
    """
    rng = np.random.default_rng(seed)
    line = Centreline()
    mirror = np.array([1.0, -1.0, 1.0])

    def chain(start: int, points: list[Array], radii: list[float], paired: bool) -> list[int]:
        """Round cones one after another from a node into the open; the last node of each copy."""
        ends = []
        for sign in ([np.ones(3), mirror] if paired else [np.ones(3)]):
            at = start
            for point, radius in zip(points, radii):
                at = line.add(point * sign, radius, at)
            ends.append(at)
        return ends

    # The body: two or three balls along x, the last one the chest.
    count, thick = int(rng.integers(2, 4)), rng.uniform(0.7, 1.3)
    spine = [line.add(np.zeros(3), thick)]
    for k in range(1, count):
        spine.append(line.add(np.array([1.6 * k, 0.0, rng.uniform(-0.2, 0.2)]),
                              thick * rng.uniform(0.75, 1.15), spine[-1]))
    hip, chest = line.nodes[spine[0]], line.nodes[spine[-1]]
    # The head, on a neck.
    skull = rng.uniform(0.5, 0.9)
    neck = chest[:3] + np.array([rng.uniform(0.6, 1.4), 0.0, rng.uniform(0.8, 2.0)])
    face = chest[:3] + (neck - chest[:3]) * (1 + 1.1 * skull / np.linalg.norm(neck - chest[:3]))
    head = chain(spine[-1], [neck, face], [0.6 * skull, skull], False)[0]
    if rng.random() < 0.7:  # snout
        chain(head, [face + np.array([skull * rng.uniform(1.4, 2.2), 0.0, -0.2 * skull])],
              [skull * rng.uniform(0.3, 0.5)], False)
    for sort, chance in (("ears", 0.8), ("eyes", 0.5), ("horns", 0.3)):
        if rng.random() > chance:
            continue
        up, wide = {"ears": (1.0, 0.7), "eyes": (0.35, 0.45), "horns": (1.0, 0.25)}[sort]
        way = np.array([0.75 if sort == "eyes" else -0.1, wide, up])
        way /= np.linalg.norm(way)
        reach = {"ears": (1.5, 2.2), "eyes": (1.05, 1.2), "horns": (1.8, 2.8)}[sort]
        thin = {"ears": 0.2, "eyes": 0.17, "horns": 0.1}[sort]
        chain(head, [face + way * skull * rng.uniform(*reach)], [thin * skull], True)
    # Legs, arms, or wings.
    for place, chance in ((spine[0], 1.0), (spine[-1], 0.9)):
        if rng.random() > chance:
            continue
        body = line.nodes[place]
        r, length = body[3] * rng.uniform(0.2, 0.4), body[3] * rng.uniform(1.2, 2.5)
        out = np.array([rng.uniform(-0.4, 0.4), rng.uniform(0.4, 1.2), -1.0])
        knee = body[:3] + out / np.linalg.norm(out) * (body[3] + length / 2)
        foot = knee + np.array([rng.uniform(-0.3, 0.3), 0.1, -1.0]) * length / 2
        ends = chain(place, [knee, foot], [r, 0.8 * r], True)
        kind = rng.integers(0, 3)
        if kind == 1:  # a foot that points forward
            toe = foot + np.array([r * rng.uniform(1.5, 3.0), 0.0, -0.1 * r])
            for end, sign in zip(ends, (np.ones(3), mirror)):
                line.add(toe * sign, 0.7 * r, end)
        if kind == 2:  # fingers
            for k in range(int(rng.integers(2, 5))):
                way = np.array([1.2 * np.cos(1.5 * k - 0.5), np.sin(1.5 * k - 0.5), -1.0])
                tip = foot + way * r * rng.uniform(1.3, 2.5)
                for end, sign in zip(ends, (np.ones(3), mirror)):
                    line.add(tip * sign, 0.3 * r, end)
    if rng.random() < 0.7:  # tail
        r = hip[3] * rng.uniform(0.1, 0.3)
        root = hip[:3] - np.array([hip[3] * 0.7, 0.0, 0.0])
        tip = root - np.array([rng.uniform(0.8, 2.5), 0.0, rng.uniform(-1.0, 1.0)])
        chain(spine[0], [root, tip], [r, 0.5 * r], False)
    return line


def star(seed: int) -> Centreline:
    """Two to eight like arms around a ball, each bent and half of them forked; at odd seeds all bent to one side.

    Then the shape has rotations but no mirror plane through its axis, which is z.
    """
    rng = np.random.default_rng(seed)
    line = Centreline()
    arms, hub = 2 + seed % 7, rng.uniform(0.6, 1.2)
    centre = line.add(np.zeros(3), hub)
    thick = hub * min(0.3, 0.5 * np.sin(np.pi / arms))
    steps = int(rng.integers(2, 4))
    away = hub * np.cumsum(rng.uniform(0.8, 1.4, steps + 1))
    up, aside = rng.uniform(-0.5, 0.5, steps + 1), rng.uniform(0.15, 0.5) * (seed % 2)
    fork = rng.random() < 0.5
    for k in range(arms):
        at = centre
        for i in range(steps + 1):
            angle = 2 * np.pi * k / arms + aside * i / arms
            radius = thick * (1 - 0.5 * i / (steps + 1))
            place = np.array([away[i] * np.cos(angle), away[i] * np.sin(angle), up[i] * hub])
            if fork and i == steps:
                for sign in (-1.0, 1.0):
                    line.add(place + np.array([0.0, 0.0, 2.5 * sign * radius]), 0.7 * radius, at)
            else:
                at = line.add(place, radius, at)
    return line


def surface_of(line: Centreline, sides: int = 16) -> tuple[Array, Array, int]:
    """The union of the round cones: vertices, faces, genus. Needs manifold3d."""
    from manifold3d import Manifold, OpType

    nodes, edges = line.arrays()
    radius_of_root = {}
    for a, b in edges:
        # A branch much thinner than the ball it starts in does not widen to it.
        radius_of_root[int(a), int(b)] = min(nodes[a, 3], nodes[b, 3] / 0.7)
    balls = []
    for (a, b), r in radius_of_root.items():
        one = Manifold.sphere(r, sides).translate(nodes[a, :3])
        other = Manifold.sphere(nodes[b, 3], sides).translate(nodes[b, :3])
        balls.append(Manifold.batch_hull([one, other]))
    degree = np.bincount(edges.ravel(), minlength=len(nodes))
    for v in np.flatnonzero(degree > 2):
        balls.append(Manifold.sphere(nodes[v, 3], sides).translate(nodes[v, :3]))
    whole = Manifold.batch_boolean(balls, OpType.Add).simplify(0.02 * float(nodes[:, 3].min()))
    mesh = whole.to_mesh64()
    vertices, faces = np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, int)
    from_of, to_of = np.array(mesh.merge_from_vert, int), np.array(mesh.merge_to_vert, int)
    if len(from_of):
        target = np.arange(len(vertices))
        target[from_of] = to_of
        kept = np.unique(target)
        index = np.full(len(vertices), -1)
        index[kept] = np.arange(len(kept))
        vertices, faces = vertices[kept], index[target[faces]]
    return vertices, faces, whole.genus()


def subdivided(line: Centreline, longest_of_radius: float = 2.0) -> Centreline:
    """The same line with nodes at most so many local radii apart: the surface's triangles are compact."""
    nodes, edges = line.arrays()
    fine = Centreline([n.copy() for n in nodes], [])
    for a, b in edges:
        thin = nodes[b, 3] < 0.7 * nodes[a, 3]
        start = nodes[a].copy()
        if thin:
            start[3] = nodes[b, 3] / 0.7
        least = min(start[3], nodes[b, 3])
        count = max(1, int(np.ceil(np.linalg.norm(nodes[b, :3] - start[:3])
                                   / (longest_of_radius * least))))
        at = int(a)
        for k in range(1, count):
            at_node = start + (nodes[b] - start) * k / count
            fine.nodes.append(at_node)
            fine.edges.append((at, len(fine.nodes) - 1))
            at = len(fine.nodes) - 1
        fine.edges.append((at, int(b)))
    return fine


FAMILIES: dict[str, Callable[[int], Centreline]] = {
    "tree": lambda seed: tree(seed),
    "sapling": lambda seed: tree(seed, levels=2, thickest=0.8, ratio=0.4),
    "thin": lambda seed: tree(seed, thickest=0.3, ratio=0.6),
    "vessel": lambda seed: tree(seed, levels=5, thickest=1.2, ratio=0.55),
    "hair": lambda seed: tree(seed, levels=5, thickest=0.3, ratio=0.6, shrink=0.8),
    "neuron": lambda seed: neuron(seed),
    "hedgehog": lambda seed: hedgehog(seed),
    "arterial": lambda seed: arterial(seed),
    "lattice": lambda seed: lattice(2 + seed % 3),
    "creature": lambda seed: creature(seed),
    "star": lambda seed: star(seed),
}
