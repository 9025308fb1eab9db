# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of the benchmark: shapes around known curves and sheets, each in several triangulations.

A shape is NAME = FAMILY_SEED, a surface NAME_VARIANT: NAME_VARIANT.off, and NAME_VARIANT.npz with its truth in
the same coordinates, see truth.py.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import trimesh

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshgen.families import FAMILIES  # noqa: E402
from meshgen.off import write_off  # noqa: E402
from meshgen.plates import plate  # noqa: E402
from meshgen.trees import subdivided, surface_of  # noqa: E402

from benchmark_options import FAMILIES as NAMES, PARTS  # noqa: E402
from stability import rotation  # noqa: E402
from truth import Truth, write_truth  # noqa: E402

Array = np.ndarray
Surface = tuple[Array, Array]  # vertices, triangles

#: The seeds of each part. A lattice has no chance in it: its seed is its size.
SEEDS = {name: {"tune": (1, 2), "check": (7003, 7004)} for name in NAMES} | {"lattice": {"tune": (0,), "check": (1,)}}
SIDES = {"coarse": 8, "made": 12, "fine": 20}  # of a round cone
MAX_REMESHED = 40000  # vertices
LIST = "benchmark.json"


@dataclass(frozen=True)
class Entry:
    """One surface of the set. part: "tune" or "check"; tips: those that a skeleton is asked for."""

    shape: str
    family: str
    part: str
    variant: str
    vertices: int
    tips: int

    @property
    def name(self) -> str:
        return f"{self.shape}_{self.variant}"


def bases(family: str, seed: int) -> tuple[dict[str, Surface], Truth] | None:
    """A shape in three densities, and its truth; None where a surface has another topology."""
    if family == "plate":
        made = {name: plate(seed, edge) for name, edge in (("coarse", 1.2), ("made", 0.6), ("fine", 0.3))}
        p = made["fine"]
        truth = Truth(np.column_stack([p.sheet, np.full(len(p.sheet), p.half)]), np.zeros((0, 2), int),
                      p.sheet_triangles, p.holes)
        return {name: (q.vertices, q.triangles) for name, q in made.items()}, truth
    line = FAMILIES[family](seed)
    nodes, edges = line.arrays()
    truth = Truth(nodes, edges, np.zeros((0, 3), int), len(edges) - len(nodes) + 1)
    surfaces = {}
    for name, sides in SIDES.items():
        vertices, triangles, genus = surface_of(subdivided(line), sides)
        if genus != truth.cycles:
            return None
        surfaces[name] = (vertices, triangles)
    return surfaces, truth


def same_solid(surface: Surface, cycles: int) -> bool:
    """Whether a surface is one closed body of that genus."""
    mesh = trimesh.Trimesh(*surface, process=False)
    return bool(mesh.is_watertight and mesh.body_count == 1 and mesh.euler_number == 2 - 2 * cycles)


def decimated(surface: Surface) -> Surface:
    """Half of the triangles, by quadrics."""
    import fast_simplification

    points, triangles = fast_simplification.simplify(
        surface[0].astype(np.float32), surface[1].astype(np.int32), target_reduction=0.5)
    return points.astype(float), triangles.astype(int)


def remeshed(surface: Surface, truth: Truth) -> Surface | None:
    """Even edges of half of the least radius, by VCG's remesher; None where these would be too many."""
    import pymeshlab

    length = 0.5 * float(truth.radii.min())
    area = trimesh.Trimesh(*surface, process=False).area
    if area / (0.87 * length**2) > MAX_REMESHED:
        return None
    layers = pymeshlab.MeshSet(verbose=False)
    layers.add_mesh(pymeshlab.Mesh(surface[0], surface[1]))
    layers.meshing_isotropic_explicit_remeshing(targetlen=pymeshlab.PureValue(length), iterations=5)
    mesh = layers.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix().astype(int)


def noisy(surface: Surface, truth: Truth, seed: int) -> Surface:
    """Each vertex moved along its normal by chance, 3 % of the local radius (one standard deviation)."""
    points, triangles = surface
    normals = trimesh.Trimesh(points, triangles, process=False).vertex_normals
    by = 0.03 * truth.nearest(points).radius * np.random.default_rng(seed).normal(size=len(points))
    return points + by[:, None] * normals, triangles


def moved(surface: Surface, truth: Truth, seed: int) -> tuple[Surface, Truth]:
    """A mirror image, rotated, in another unit, three diagonals away, in single precision."""
    turn = rotation(seed) @ np.diag([1.0, -1.0, 1.0])
    points, triangles = surface
    away = 3 * 25.4 * truth.size * np.array([1.0, -1.0, 1.0]) / np.sqrt(3)

    def there(p: Array) -> Array:
        return 25.4 * p @ turn.T + away

    return ((there(points).astype(np.float32).astype(float), triangles[:, ::-1]),
            Truth(np.column_stack([there(truth.points), 25.4 * truth.radii]), truth.edges, truth.triangles,
                  truth.cycles))


def variants(family: str, seed: int) -> Iterator[tuple[str, Surface, Truth]]:
    """All surfaces of a shape; none where the generator gives another topology."""
    made = bases(family, seed)
    if made is None:
        return
    surfaces, truth = made
    middle = surfaces["made"]
    for name, surface in surfaces.items():
        yield name, surface, truth
    others: dict[str, Callable[[], Surface | None]] = {
        "decimated": lambda: decimated(middle),
        "remeshed": lambda: remeshed(middle, truth),
        "noisy": lambda: noisy(middle, truth, seed),
    }
    for name, make in others.items():
        surface = make()
        if surface is not None and same_solid(surface, truth.cycles):
            yield name, surface, truth
    yield "moved", *moved(middle, truth, seed)


def version() -> str:
    """Of the generator: surfaces of another one are made anew."""
    digest = hashlib.sha256()
    for file in (Path(__file__), *sorted((Path(__file__).parents[1] / "meshgen").glob("*.py"))):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def generate(folder: Path, entries: list[Entry], families: list[str]) -> list[Entry]:
    """Adds the surfaces of some families to those that a folder has; returns all."""
    folder.mkdir(parents=True, exist_ok=True)
    entries = list(entries)
    for family in families:
        for part in PARTS:
            for seed in SEEDS[family][part]:
                shape = f"{family}_{seed}"
                for variant, surface, truth in variants(family, seed):
                    tips = 0 if truth.is_sheet else len(truth.tips)
                    entry = Entry(shape, family, part, variant, len(surface[0]), tips)
                    write_off(folder / f"{entry.name}.off", *surface)
                    write_truth(folder / f"{entry.name}.npz", truth)
                    entries.append(entry)
                print(f"{shape}: {sum(e.shape == shape for e in entries)} surfaces", file=sys.stderr, flush=True)
    # Last, so that a set that is there is whole.
    (folder / LIST).write_text(
        json.dumps({"version": version(), "surfaces": [asdict(e) for e in entries]}, indent=1) + "\n")
    return entries


def read_set(folder: Path) -> list[Entry]:
    """What a folder has; nothing where another version of the generator made it."""
    file = folder / LIST
    record = json.loads(file.read_text()) if file.is_file() else {"version": ""}
    return [Entry(**e) for e in record["surfaces"]] if record["version"] == version() else []
