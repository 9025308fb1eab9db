# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The committed test shapes are what their json files say, measured by means of their own."""
import functools
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

MESHES = Path(__file__).resolve().parents[2] / "meshes"
NAMES = sorted(path.stem for path in MESHES.glob("*.off"))
CHECKED_NODES = 16


@functools.lru_cache(maxsize=None)
def load(name: str) -> tuple[np.ndarray, np.ndarray, dict]:
    """Vertices, faces and record of one shape."""
    mesh = trimesh.load(MESHES / f"{name}.off", process=False)
    record = json.loads((MESHES / f"{name}.json").read_text())
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64), record


def half_edges(faces: np.ndarray) -> np.ndarray:
    """The three directed edges of every face."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def labels(count: int, edges: np.ndarray) -> np.ndarray:
    """Least index reachable from each vertex along the edges."""
    label = np.arange(count)
    while True:
        low = label.copy()
        np.minimum.at(low, edges[:, 0], label[edges[:, 1]])
        np.minimum.at(low, edges[:, 1], label[edges[:, 0]])
        low = low[low]
        if np.array_equal(low, label):
            return label
        label = low


def closest_points(p: np.ndarray, v: np.ndarray, f: np.ndarray) -> np.ndarray:
    """The point of each face that is closest to p."""
    return trimesh.triangles.closest_point(v[f], np.broadcast_to(p, (len(f), 3)))


def winding(points: np.ndarray, v: np.ndarray, f: np.ndarray) -> np.ndarray:
    """How often the surface goes round each point: the sum of solid angles over 4 pi."""
    result = []
    for p in points:
        a, b, c = (v[f] - p).transpose(1, 0, 2)
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        top = np.sum(a * np.cross(b, c), axis=1)
        bottom = (la * lb * lc + np.sum(a * b, axis=1) * lc + np.sum(b * c, axis=1) * la
                  + np.sum(c * a, axis=1) * lb)
        result.append(np.sum(np.arctan2(top, bottom)) / (2.0 * np.pi))
    return np.array(result)


def spread(count: int) -> np.ndarray:
    """At most CHECKED_NODES indices below count, first and last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, CHECKED_NODES)).astype(int))


def skeleton(name: str) -> dict:
    """The skeleton of a shape, or skip."""
    record = load(name)[2]
    if "skeleton" not in record:
        pytest.skip("no skeleton is given for this shape")
    return record["skeleton"]


def test_every_mesh_has_its_record_and_its_line_in_the_index():
    index = json.loads((MESHES / "index.json").read_text())
    assert sorted(index) == NAMES
    assert sorted(p.stem for p in MESHES.glob("*.json") if p.stem != "index") == NAMES
    for name, line in index.items():
        record = load(name)[2]
        for key in set(line) & set(record):
            assert line[key] == record[key], (name, key)


@pytest.mark.parametrize("name", NAMES)
def test_mesh_is_watertight_and_two_manifold(name: str):
    v, f, record = load(name)
    assert (len(v), len(f)) == (record["vertices"], record["faces"])
    edges = half_edges(f)
    code = np.sort(edges[:, 0] * len(v) + edges[:, 1])
    assert np.all(np.diff(code) > 0), "an edge is used twice in one direction"
    assert np.array_equal(code, np.sort(edges[:, 1] * len(v) + edges[:, 0])), "open edge"
    assert len(np.unique(f)) == len(v) == len(np.unique(v, axis=0))
    # Walking from face to face round a vertex has to visit all of its faces.
    following = dict(zip(map(tuple, np.column_stack([f.ravel(), np.roll(f, -1, 1).ravel()])),
                         np.roll(f, 1, 1).ravel()))
    valence = np.bincount(f.ravel())
    first = dict(zip(f.ravel(), np.roll(f, -1, 1).ravel()))
    for vertex, start in first.items():
        steps, here = 1, following[(vertex, start)]
        while here != start:
            steps, here = steps + 1, following[(vertex, here)]
        assert steps == valence[vertex], f"vertex {vertex} has more than one fan"


@pytest.mark.parametrize("name", NAMES)
def test_topology_is_the_one_stated(name: str):
    v, f, record = load(name)
    label = labels(len(v), half_edges(f))
    assert len(np.unique(label)) == record["components"]
    euler = len(v) - len(np.unique(np.sort(half_edges(f), axis=1), axis=0)) + len(f)
    assert euler == 2 * record["components"] - 2 * record["genus"]
    assert record["expected_cycles"] == record["genus"]
    for component in np.unique(label):
        a, b, c = v[f[label[f[:, 0]] == component]].transpose(1, 0, 2)
        assert np.sum(a * np.cross(b, c)) > 0.0, "a component is inside out"


@pytest.mark.parametrize("name", NAMES)
def test_no_face_is_degenerate(name: str):
    v, f, record = load(name)
    cross = np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1)
    longest = np.max([np.linalg.norm(v[f[:, k]] - v[f[:, k - 1]], axis=1) for k in range(3)],
                     axis=0)
    assert np.min(cross / longest**2) > 0.01
    assert np.isclose(np.linalg.norm(np.ptp(v, axis=0)), record["diagonal"], atol=1e-5)


@pytest.mark.parametrize("name", NAMES)
def test_mirror_symmetry_where_stated(name: str):
    v, _, record = load(name)
    mirrored = v * (1.0, -1.0, 1.0) + 0.0
    same = {tuple(p) for p in mirrored} == {tuple(p) for p in v + 0.0}
    assert same or not record["mirror_symmetric_y"]


@pytest.mark.parametrize("name", NAMES)
def test_skeleton_is_a_graph_of_the_stated_shape(name: str):
    s, record = skeleton(name), load(name)[2]
    nodes, edges = np.array(s["nodes"]), np.array(s["edges"])
    assert len(nodes) == len(s["radius"]) == len(s["exact"])
    assert sum(s["exact"]) == s["exact_nodes"]
    assert np.linalg.norm(nodes[edges[:, 0]] - nodes[edges[:, 1]], axis=1).min() > 0.0
    assert len(np.unique(np.sort(edges, axis=1), axis=0)) == len(edges)
    if s["complete"]:
        components = len(np.unique(labels(len(nodes), edges)))
        degree = np.bincount(edges.ravel(), minlength=len(nodes))
        assert components == record["components"]
        assert len(edges) - len(nodes) + components == record["expected_cycles"]
        assert np.count_nonzero(degree == 1) == record["expected_tips"]
        assert np.count_nonzero(degree >= 3) == record["expected_junctions"]


@pytest.mark.parametrize("name", NAMES)
def test_skeleton_is_inside(name: str):
    v, f, _ = load(name)
    nodes = np.array(skeleton(name)["nodes"])
    assert np.allclose(winding(nodes[spread(len(nodes))], v, f), 1.0, atol=0.02)


@pytest.mark.parametrize("name", NAMES)
def test_exact_nodes_are_centres_of_maximal_balls(name: str):
    """At distance `radius` of the surface, and touching it from opposite sides."""
    v, f, record = load(name)
    s = skeleton(name)
    exact = np.flatnonzero(s["exact"])
    if len(exact) == 0:
        pytest.skip("no node of this shape is exact")
    chord = 0.0 if name in ("cuboid", "box8") else record["mean_edge"] ** 2 / 2.0
    for i in exact[spread(len(exact))]:
        radius = s["radius"][i]
        spokes = closest_points(np.array(s["nodes"][i]), v, f) - s["nodes"][i]
        length = np.linalg.norm(spokes, axis=1)
        assert abs(length.min() - radius) <= chord / radius + 2e-6
        touching = spokes[length <= length.min() + chord / radius + 2e-6]
        touching = touching / np.linalg.norm(touching, axis=1)[:, None]
        assert np.min(touching @ touching.T) < -0.5, f"node {i} touches on one side only"


@pytest.mark.parametrize("name", [n for n in NAMES if "sheet" in load(n)[2]])
def test_sheet_is_half_way_between_the_sides(name: str):
    v, f, record = load(name)
    corners = np.array(record["sheet"]["corners"])
    radius = record["sheet"]["radius"]
    for s in np.linspace(0.0, 1.0, 5):
        for t in np.linspace(0.0, 1.0, 5):
            p = ((1 - s) * ((1 - t) * corners[0] + t * corners[1])
                 + s * ((1 - t) * corners[3] + t * corners[2]))
            spokes = closest_points(p, v, f) - p
            length = np.linalg.norm(spokes, axis=1)
            chord = record["mean_edge"] ** 2 / (2.0 * radius)
            assert abs(length.min() - radius) <= chord
            for side in (-1.0, 1.0):
                assert abs(length[spokes[:, 2] * side > 0.5 * radius].min() - radius) <= chord
