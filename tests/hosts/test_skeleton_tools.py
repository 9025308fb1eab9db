# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The filters that work on a skeleton: parts, pruning, resampling, comparing, measuring, balls."""

import json
import re
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest

from conftest import (FULL, MESHES, POLES, REFINE, ROOT, area, components, diagonal, distances_from_edges, euler,
                      failing, fingerprint, layer, opened, points, scalars, volume)

PARTS = "compute_skeleton_parts_mcf"
PRUNE = "generate_pruned_skeleton_mcf"
RESAMPLE_SKELETON = "generate_resampled_skeleton_mcf"
COMPARE = "compute_skeleton_distance_mcf"
MEASURE = "compute_skeleton_measures_mcf"
MEDIAL_AXIS = "generate_medial_axis_mcf"
BALLS = "generate_medial_balls_mcf"
TUBES = "generate_skeleton_tubes_mcf"
ALL = [PARTS, PRUNE, RESAMPLE_SKELETON, COMPARE, MEASURE, BALLS, TUBES]

COARSE = {"target_length": pymeshlab.PercentageValue(1.2)}
TIP, JUNCTION, RING = 0, 1, 2


def percent(value: float) -> pymeshlab.PercentageValue:
    return pymeshlab.PercentageValue(value)


def skeletonized(name: str) -> pymeshlab.MeshSet:
    """One of the project's meshes with its skeleton as the current layer."""
    layers = opened(name)
    layers.apply_filter(FULL, **COARSE)
    return layers


@pytest.fixture
def y_tube() -> pymeshlab.MeshSet:
    return skeletonized("y_tube")


def add_curve(layers: pymeshlab.MeshSet, nodes, edges, radius, name: str) -> None:
    """A skeleton that no filter has made, as a new current layer."""
    mesh = pymeshlab.Mesh(vertex_matrix=np.asarray(nodes, float),
                          edge_matrix=np.asarray(edges, np.int32),
                          v_scalar_array=np.asarray(radius, float))
    layers.add_mesh(mesh, name)


def known_skeleton(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes, edges and radii of a shape's own skeleton."""
    record = json.loads((MESHES / f"{name}.json").read_text())["skeleton"]
    return (np.array(record["nodes"]), np.array(record["edges"]), np.array(record["radius"]))


def edge_lengths(mesh: pymeshlab.Mesh) -> np.ndarray:
    ends = mesh.vertex_matrix()[mesh.edge_matrix()]
    return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)


def degrees(mesh: pymeshlab.Mesh) -> np.ndarray:
    return np.bincount(mesh.edge_matrix().ravel(), minlength=mesh.vertex_number())


def face_pieces(faces: np.ndarray, part: np.ndarray) -> int:
    """Connected pieces, over edges, of faces with the same part."""
    owner: dict[tuple[int, int], int] = {}
    pairs = []
    for f, (a, b, c) in enumerate(faces):
        for edge in ((a, b), (b, c), (c, a)):
            other = owner.setdefault(tuple(sorted(edge)), f)
            if other != f and part[other] == part[f]:
                pairs.append((other, f))
    return components(len(faces), np.array(pairs))


class TestParts:
    def test_every_face_has_a_part_and_parts_are_connected(self, y_tube):
        results = y_tube.apply_filter(PARTS)
        surface = layer(y_tube, "y_tube_resampled")
        part = surface.face_scalar_array()
        assert set(part) == {0, 1, 2}
        assert results["branches"] == results["parts"] == 3
        assert face_pieces(surface.face_matrix(), part) == 3

    def test_each_part_has_one_colour_of_its_own(self, y_tube):
        y_tube.apply_filter(PARTS)
        surface = layer(y_tube, "y_tube_resampled")
        part, colour = surface.face_scalar_array(), surface.face_color_matrix()
        palettes = [np.unique(colour[part == i], axis=0) for i in range(3)]
        assert [len(palette) for palette in palettes] == [1, 1, 1]
        assert len(np.unique(np.vstack(palettes), axis=0)) == 3

    def test_a_part_lies_around_its_branch(self, y_tube):
        y_tube.apply_filter(PARTS)
        surface, curve = layer(y_tube, "y_tube_resampled"), y_tube.current_mesh()
        assert curve.label() == "y_tube_skeleton"
        node = scalars(surface, "mcfskel_node").astype(int)
        part, faces = surface.face_scalar_array(), surface.face_matrix()
        tips = np.flatnonzero(degrees(curve) == 1)
        at_tips = [set(part[np.isin(node[faces], tip).all(axis=1)]) for tip in tips]
        assert all(len(found) == 1 for found in at_tips)
        assert len(set.union(*at_tips)) == 3

    def test_branch_table(self, y_tube):
        results = y_tube.apply_filter(PARTS)
        surface, curve = layer(y_tube, "y_tube_resampled"), y_tube.current_mesh()
        assert results["branch_length"].sum() == pytest.approx(edge_lengths(curve).sum())
        assert results["branch_area"].sum() == pytest.approx(
            area(surface.vertex_matrix(), surface.face_matrix()))
        radius = scalars(curve, "mcfskel_radius")
        assert results["branch_radius_min"].min() == pytest.approx(radius.min())
        assert results["branch_radius_max"].max() == pytest.approx(radius.max())
        for low, mean, high in zip(results["branch_radius_min"], results["branch_radius_mean"],
                                   results["branch_radius_max"]):
            assert low < mean < high
        significance = scalars(curve, "mcfskel_significance")
        assert significance.max() == 1 and 0.5 < significance.min() < 1
        assert sorted(results["branch_significance"]) == [significance.min(), 1, 1], "one arm and the trunk"
        ends = {frozenset(kinds) for kinds in zip(results["branch_first_kind"],
                                                  results["branch_last_kind"])}
        assert ends == {frozenset({TIP, JUNCTION})}

    def test_vertex_quality_is_the_distance_to_the_skeleton(self, y_tube):
        y_tube.apply_filter(PARTS)
        surface, curve = layer(y_tube, "y_tube_resampled"), y_tube.current_mesh()
        a, b = (curve.vertex_matrix()[curve.edge_matrix()[:, k]] for k in range(2))
        along = b - a
        for v in range(0, surface.vertex_number(), 97):
            q = surface.vertex_matrix()[v]
            t = np.clip(((q - a) * along).sum(axis=1) / (along ** 2).sum(axis=1), 0, 1)
            nearest = np.linalg.norm(a + t[:, None] * along - q, axis=1).min()
            assert surface.vertex_scalar_array()[v] == pytest.approx(nearest)

    def test_a_ring_is_one_part(self):
        layers = skeletonized("torus")
        results = layers.apply_filter(PARTS)
        assert set(layer(layers, "torus_resampled").face_scalar_array()) == {0}
        assert list(results["branch_first_kind"]) == list(results["branch_last_kind"]) == [RING]

    def test_on_the_input_mesh_too(self, y_tube):
        surface = layer(y_tube, "y_tube.off")
        results = y_tube.apply_filter(PARTS, surface=surface.id())
        part = surface.face_scalar_array()
        assert results["parts"] == 3 and set(part) == {0, 1, 2}
        assert face_pieces(surface.face_matrix(), part) == 3

    def test_with_a_skeleton_from_elsewhere(self):
        layers = opened("y_tube")
        add_curve(layers, *known_skeleton("y_tube"), "drawn")
        results = layers.apply_filter(PARTS, surface=0)
        assert results["parts"] == 3
        assert face_pieces(layers.mesh(0).face_matrix(), layers.mesh(0).face_scalar_array()) == 3


def with_twig(name: str, length: float, radius: float) -> tuple[pymeshlab.MeshSet, int]:
    """A shape with its own skeleton and a twig of that length, times the local radius, on top."""
    layers = opened(name)
    nodes, edges, radii = known_skeleton(name)
    degree = np.bincount(edges.ravel())
    root = int(np.flatnonzero(degree == 2)[len(nodes) // 3])
    neighbours = edges[(edges == root).any(axis=1)].sum(axis=1) - root
    axis = nodes[neighbours[1]] - nodes[neighbours[0]]
    across = np.cross(axis, [0.3, 0.5, 0.8])
    tip = nodes[root] + across / np.linalg.norm(across) * length * radii[root]
    add_curve(layers, np.vstack([nodes, tip]), np.vstack([edges, [root, len(nodes)]]),
              np.append(radii, radius), "drawn")
    return layers, root


class TestPrune:
    def test_a_spur_goes(self):
        layers, root = with_twig("bent_tube", 0.5, 0.1)
        results = layers.apply_filter(PRUNE, surface=0)
        assert results["length_removed"] == pytest.approx(0.5 * known_skeleton("bent_tube")[2][root])
        assert (results["terminals_removed"], results["junctions_removed"]) == (1, 1)
        assert (results["branches"], results["terminals"]) == (1, 2)
        nodes, edges, _ = known_skeleton("bent_tube")
        pruned = layers.current_mesh()
        assert pruned.label() == "drawn_pruned"
        assert np.array_equal(pruned.vertex_matrix(), nodes)
        assert pruned.edge_number() == len(edges)

    def test_merged_junctions_do_not_make_it_longer(self):
        """The limbs of a hand reach to where its junctions have become one, and grow by that."""
        layers = opened("hand")
        layers.apply_filter(FULL, target_length=pymeshlab.PercentageValue(1.5))
        before = edge_lengths(layers.current_mesh()).sum()
        results = layers.apply_filter(PRUNE, min_length=pymeshlab.PercentageValue(8))
        assert results["length_removed"] >= 0
        assert results["skeleton_length"] >= before - results["length_removed"] - 1e-6

    def test_a_branch_that_reaches_out_stays(self):
        layers, _ = with_twig("bent_tube", 1.5, 0.1)
        results = layers.apply_filter(PRUNE, spur_prominence=0)
        assert results["terminals_removed"] == 0

    def test_by_length(self):
        layers, root = with_twig("bent_tube", 1.5, 0.1)
        length = edge_lengths(layers.current_mesh()).min()
        kept = layers.apply_filter(PRUNE, spur_prominence=0,
                                   min_length=pymeshlab.PureValue(0.5 * length))
        assert kept["terminals"] == 3
        layers.set_current_mesh(layer(layers, "drawn").id())
        own = np.linalg.norm(np.diff(layers.current_mesh().vertex_matrix()[
            layers.current_mesh().edge_matrix()[-1]], axis=0))
        gone = layers.apply_filter(PRUNE, spur_prominence=0,
                                   min_length=pymeshlab.PureValue(1.01 * own))
        assert gone["terminals"] == 2

    def test_by_radius(self):
        layers, _ = with_twig("bent_tube", 1.5, 0.01)
        results = layers.apply_filter(PRUNE, spur_prominence=0,
                                      min_radius=pymeshlab.PureValue(0.02))
        assert results["terminals"] == 2

    def test_by_detail_it_is_what_the_full_run_gives(self):
        layers = skeletonized("hand")
        whole = layers.current_mesh().vertex_matrix()
        significance = scalars(layers.current_mesh(), "mcfskel_significance")
        few = layers.apply_filter(PRUNE, spur_prominence=0, merge_junctions=False, detail=0)
        assert few["terminals"] == 2
        pruned = layers.current_mesh()
        assert np.array_equal(pruned.vertex_matrix(), whole[significance == 1])
        assert (scalars(pruned, "mcfskel_significance") == 1).all()
        again = opened("hand")
        again.apply_filter(FULL, **COARSE, detail=0)
        assert np.array_equal(again.current_mesh().vertex_matrix(), pruned.vertex_matrix())
        for label in ["hand.off", "hand_resampled"]:
            assert np.array_equal(scalars(layer(again, label), "mcfskel_node"),
                                  scalars(layer(layers, label), "mcfskel_node"))
        assert np.array_equal(scalars(again.current_mesh(), "mcfskel_radius"),
                              scalars(pruned, "mcfskel_radius"))

    def test_cycles_stay_whatever_is_asked_for(self):
        layers = skeletonized("plate3")
        before = layers.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(1), smoothing=percent(0))
        assert before["cycles"] == 3
        results = layers.apply_filter(PRUNE, spur_prominence=1, min_length=percent(100),
                                      min_radius=percent(100))
        assert (results["cycles"], results["components"], results["terminals"]) == (3, 1, 0)

    def test_correspondence_follows(self, y_tube):
        curve = y_tube.current_mesh()
        before = {label: scalars(layer(y_tube, label), "mcfskel_node").astype(int)
                  for label in ["y_tube.off", "y_tube_resampled"]}
        old = curve.vertex_matrix()
        lengths = y_tube.apply_filter(PARTS)["branch_length"]
        results = y_tube.apply_filter(
            PRUNE, spur_prominence=0, min_length=pymeshlab.PureValue(1.001 * lengths.min()),
            merge_junctions=False)
        assert results["terminals_removed"] == 1
        pruned = y_tube.current_mesh()
        junction = old[degrees(layer(y_tube, "y_tube_skeleton")) == 3][0]
        surface = layer(y_tube, "y_tube_resampled")
        now = scalars(surface, "mcfskel_node").astype(int)
        moved = np.linalg.norm(
            pruned.vertex_matrix()[now] - old[before["y_tube_resampled"]], axis=1) > 0
        assert 0.1 < moved.mean() < 0.6
        assert (pruned.vertex_matrix()[now[moved]] == junction).all()
        on_input = scalars(layer(y_tube, "y_tube.off"), "mcfskel_node").astype(int)
        assert on_input.min() >= 0 and on_input.max() < pruned.vertex_number()
        # The radius is again the mean distance of what has merged from the edges of its node.
        distance = distances_from_edges(
            surface.vertex_matrix(), now, pruned.vertex_matrix(), pruned.edge_matrix())
        count = np.bincount(now, minlength=pruned.vertex_number())
        mean = np.bincount(now, distance, minlength=len(count))[count > 0] / count[count > 0]
        assert scalars(pruned, "mcfskel_radius")[count > 0] == pytest.approx(mean)

    def test_parts_follow_the_pruned_skeleton(self, y_tube):
        y_tube.apply_filter(PRUNE, min_length=percent(100), merge_junctions=False)
        results = y_tube.apply_filter(PARTS)
        assert results["branches"] == results["parts"] == 1


class TestResampleSkeleton:
    def test_default_is_a_thousandth_of_the_surfaces_diagonal(self, y_tube):
        size = diagonal(y_tube.mesh(0).vertex_matrix())
        values = y_tube.filter_parameter_values(RESAMPLE_SKELETON)
        assert values["longest_edge"] == pytest.approx(0.001 * size)
        results = y_tube.apply_filter(RESAMPLE_SKELETON)
        lengths = edge_lengths(y_tube.current_mesh())
        assert lengths.max() <= 0.001 * size * (1 + 1e-6)
        assert lengths.min() > 0.9 * 0.001 * size
        assert results["edge_length_max"] == pytest.approx(lengths.max())
        assert results["edge_length_min"] == pytest.approx(lengths.min())
        assert y_tube.current_mesh().label() == "y_tube_smoothed"

    def test_percent_are_of_the_surface_as_long_as_it_is_known(self, y_tube):
        surface = diagonal(y_tube.mesh(0).vertex_matrix())
        first = y_tube.current_mesh()
        own = diagonal(first.vertex_matrix())
        assert own < 0.99 * surface
        y_tube.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(0.5))
        derived = y_tube.current_mesh_id()
        for start in [first.id(), derived]:
            y_tube.set_current_mesh(start)
            y_tube.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(0.05))
            assert edge_lengths(y_tube.current_mesh()).max() == pytest.approx(0.0005 * surface, rel=0.004)
        add_curve(y_tube, first.vertex_matrix(), first.edge_matrix(),
                  scalars(first, "mcfskel_radius"), "elsewhere")
        y_tube.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(0.05))
        assert edge_lengths(y_tube.current_mesh()).max() == pytest.approx(0.0005 * own, rel=0.004)

    @pytest.mark.parametrize("name", ["y_tube", "torus", "plate3"])
    def test_ends_junctions_and_cycles_stay(self, name):
        layers = skeletonized(name)
        before = layers.current_mesh()
        special = before.vertex_matrix()[degrees(before) != 2]
        numbers = layers.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(100),
                                      smoothing=percent(0))
        layers.set_current_mesh(before.id())
        results = layers.apply_filter(RESAMPLE_SKELETON)
        after = layers.current_mesh()
        kept = after.vertex_matrix()[degrees(after) != 2]
        assert {tuple(p) for p in kept} == {tuple(p) for p in special}
        for key in ["components", "cycles", "branches", "terminals", "junctions"]:
            assert results[key] == numbers[key]

    def test_smoothing_straightens(self):
        layers = opened("bent_tube")
        nodes, edges, radius = known_skeleton("bent_tube")
        wobble = np.random.default_rng(1).normal(0, 0.01 * diagonal(nodes), nodes.shape)
        add_curve(layers, nodes + wobble, edges, radius, "wobbly")
        lengths = []
        for smoothing in [0, 1, 3]:
            layers.set_current_mesh(1)
            lengths.append(layers.apply_filter(
                RESAMPLE_SKELETON, smoothing=percent(smoothing))["skeleton_length"])
        assert lengths[0] > lengths[1] > lengths[2]

    def test_correspondence_follows(self, y_tube):
        old = y_tube.current_mesh().vertex_matrix()
        surface = layer(y_tube, "y_tube_resampled")
        before = scalars(surface, "mcfskel_node").astype(int)
        y_tube.apply_filter(RESAMPLE_SKELETON)
        now = scalars(surface, "mcfskel_node").astype(int)
        gap = np.linalg.norm(y_tube.current_mesh().vertex_matrix()[now] - old[before], axis=1)
        assert gap.max() < 0.01 * diagonal(old)


class TestCompare:
    def test_moved_aside_by_how_much(self):
        layers = opened("capsule")
        nodes, edges, radius = known_skeleton("capsule")
        axis = nodes[-1] - nodes[0]
        aside = np.cross(axis, [0.3, 0.5, 0.8])
        aside *= 0.1 / np.linalg.norm(aside)
        add_curve(layers, nodes, edges, radius, "one")
        add_curve(layers, nodes + aside, edges, radius, "two")
        size = diagonal(layers.mesh(0).vertex_matrix())
        results = layers.apply_filter(COMPARE, other=1, surface=0)
        assert results["diagonal"] == pytest.approx(size)
        for key in ["distance_mean", "distance_max", "distance_mean_back", "distance_max_back"]:
            assert results[key] == pytest.approx(0.1 / size)
        assert layers.current_mesh().vertex_scalar_array() == pytest.approx(0.1)

    def test_a_missing_branch_shows_on_one_side_only(self, y_tube):
        lengths = y_tube.apply_filter(PARTS)["branch_length"]
        whole = y_tube.current_mesh_id()
        y_tube.apply_filter(PRUNE, spur_prominence=0, merge_junctions=False,
                            min_length=pymeshlab.PureValue(1.001 * lengths.min()))
        there = y_tube.apply_filter(COMPARE, other=whole)
        assert there["distance_max"] < 1e-9
        assert there["distance_max_back"] > 0.05
        pruned = y_tube.current_mesh_id()
        y_tube.set_current_mesh(whole)
        back = y_tube.apply_filter(COMPARE, other=pruned)
        assert back["distance_max"] == pytest.approx(there["distance_max_back"])
        assert back["distance_mean"] == pytest.approx(there["distance_mean_back"])
        curve = y_tube.current_mesh()
        shown = curve.vertex_scalar_array()
        assert shown.max() == pytest.approx(back["distance_max"] * back["diagonal"])
        assert degrees(curve)[np.argmax(shown)] == 1

    def test_the_radius_stays(self, y_tube):
        before = scalars(y_tube.current_mesh(), "mcfskel_radius").copy()
        whole = y_tube.current_mesh_id()
        y_tube.apply_filter(RESAMPLE_SKELETON, longest_edge=percent(1))
        other = y_tube.current_mesh_id()
        y_tube.set_current_mesh(whole)
        y_tube.apply_filter(COMPARE, other=other)
        assert np.array_equal(scalars(y_tube.current_mesh(), "mcfskel_radius"), before)

    def test_not_with_itself(self, y_tube):
        with pytest.raises(pymeshlab.PyMeshLabException, match="another layer"):
            y_tube.apply_filter(COMPARE)

    def test_not_with_one_that_only_its_matrix_moves(self, y_tube):
        whole = y_tube.current_mesh_id()
        y_tube.apply_filter(RESAMPLE_SKELETON)
        y_tube.compute_matrix_from_translation(axisx=1.0, freeze=False)
        text = failing(y_tube, COMPARE, other=whole)
        for words in ["'y_tube_smoothed'", "'y_tube_skeleton'", "different transformations", "Freeze"]:
            assert words in text
        y_tube.apply_matrix_freeze()
        results = y_tube.apply_filter(COMPARE, other=whole)
        assert 0.1 < results["distance_max"] * results["diagonal"] < 1.01


class TestMeasure:
    def test_known_skeleton_is_inside_and_centred(self):
        layers = opened("bent_tube")
        nodes, edges, radius = known_skeleton("bent_tube")
        add_curve(layers, nodes, edges, radius, "drawn")
        results = layers.apply_filter(MEASURE, surface=0)
        assert results["inside_fraction"] == 1
        assert results["out_depth_max_pct"] == 0
        assert results["medial_mean_pct"] < 0.2
        assert results["off_centre_mean"] < 0.03
        assert results["ball_volume_fraction"] > 0.97
        assert results["spurs"] == 0

    def test_moved_aside(self):
        layers = opened("bent_tube")
        nodes, edges, radius = known_skeleton("bent_tube")
        # Across the plane of the bend, so that all of it moves sideways.
        _, axes = np.linalg.eigh(np.cov((nodes - nodes.mean(axis=0)).T))
        shift = 0.5 * radius.mean()
        add_curve(layers, nodes + shift * axes[:, 0], edges, radius, "drawn")
        results = layers.apply_filter(MEASURE, surface=0)
        size = diagonal(layers.mesh(0).vertex_matrix())
        assert results["medial_mean_pct"] == pytest.approx(100 * shift / size, rel=0.05)
        assert results["off_centre_mean"] == pytest.approx(0.5, abs=0.05)
        assert layers.current_mesh().vertex_scalar_array() == pytest.approx(shift, rel=0.2)

    def test_of_our_own_skeleton(self, y_tube):
        results = y_tube.apply_filter(MEASURE)
        assert results["inside_fraction"] == 1
        assert results["medial_mean_pct"] < 1
        assert results["terminals"] == 3

    def test_a_surface_that_only_its_matrix_moves(self, y_tube):
        curve, surface = y_tube.current_mesh_id(), layer(y_tube, "y_tube_resampled").id()
        before = y_tube.apply_filter(MEASURE)
        for moved in (0, surface):
            y_tube.set_current_mesh(moved)
            y_tube.compute_matrix_from_translation(axisx=7.0, freeze=False)
        y_tube.set_current_mesh(curve)
        text = failing(y_tube, MEASURE, surface=0)
        assert "'y_tube.off'" in text and "different transformations" in text
        # The one that the skeleton was made from is in the place that it had then.
        assert y_tube.apply_filter(MEASURE) == before
        assert y_tube.apply_filter(MEASURE, surface=surface) == before

    def test_needs_a_surface(self):
        layers = pymeshlab.MeshSet()
        add_curve(layers, *known_skeleton("bent_tube"), "drawn")
        with pytest.raises(pymeshlab.PyMeshLabException, match="surface"):
            layers.apply_filter(MEASURE)


class TestMedialAxis:
    def test_circle_of_a_torus(self):
        layers = opened("torus")
        results = layers.apply_filter(MEDIAL_AXIS)
        medial = layers.current_mesh()
        assert medial.label() == "torus_medial"
        assert (medial.vertex_number(), medial.face_number()) == (
            results["vertices"], results["faces"])
        nodes, _, radius = known_skeleton("torus")
        gap = np.linalg.norm(medial.vertex_matrix()[::20, None] - nodes[None], axis=2).min(axis=1)
        assert gap.max() < 0.15 * radius.mean()
        assert medial.vertex_scalar_array() == pytest.approx(radius.mean(), rel=0.1)

    def test_cloud(self):
        layers = opened("cuboid")
        results = layers.apply_filter(MEDIAL_AXIS, joined=False, min_angle=0)
        surface = layers.mesh(0)
        has = scalars(surface, "mcfskel_pole_radius") >= 0
        assert results["faces"] == layers.current_mesh().face_number() == 0
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              points(surface, "mcfskel_pole")[has])

    def test_filters_take_away(self):
        counts = []
        for options in [{}, {"min_angle": 120}, {"min_angle": 120, "min_radius": percent(5)}]:
            layers = opened("animal450")
            counts.append(layers.apply_filter(MEDIAL_AXIS, joined=False, **options)["vertices"])
        assert counts[0] > counts[1] > counts[2] > 0

    def test_lies_beside_the_stages(self):
        layers = opened("torus")
        layers.compute_matrix_from_translation(axisx=3.0, freeze=False)
        layers.apply_filter(POLES)
        layers.apply_filter(MEDIAL_AXIS)
        assert layers.current_mesh().transform_matrix()[0, 3] == 3.0

    def test_nothing_left_is_an_error(self):
        layers = opened("torus")
        before = fingerprint(layers)
        with pytest.raises(pymeshlab.PyMeshLabException, match="min_radius"):
            layers.apply_filter(MEDIAL_AXIS, min_radius=percent(90))
        assert fingerprint(layers) == before


class TestBalls:
    def test_a_tube_is_the_union_of_its_balls(self):
        layers = opened("bent_tube")
        add_curve(layers, *known_skeleton("bent_tube"), "drawn")
        results = layers.apply_filter(BALLS, surface=0)
        union, surface = layers.current_mesh(), layers.mesh(0)
        assert union.label() == "drawn_balls"
        assert euler(union) == 2
        inside = volume(surface.vertex_matrix(), surface.face_matrix())
        assert volume(union.vertex_matrix(), union.face_matrix()) == pytest.approx(inside, rel=0.04)
        assert results["volume_fraction"] == pytest.approx(results["volume"] / inside)

    def test_topology_of_a_ring(self):
        layers = skeletonized("torus")
        layers.apply_filter(BALLS)
        assert euler(layers.current_mesh()) == 0

    def test_without_a_surface_the_radius_counts(self):
        layers = pymeshlab.MeshSet()
        add_curve(layers, [[0, 0, 0], [1, 0, 0]], [[0, 1]], [0.5, 0.5], "bar")
        layers.apply_filter(BALLS, voxel=percent(4))
        union = layers.current_mesh()
        exact = np.pi * 0.25 + 4 / 3 * np.pi * 0.125
        assert volume(union.vertex_matrix(), union.face_matrix()) == pytest.approx(exact, rel=0.02)


class TestTubes:
    @pytest.mark.parametrize("name, pieces, number", [("y_tube", 3, 6), ("torus", 1, 0)])
    def test_each_branch_is_a_closed_tube(self, name, pieces, number):
        layers = skeletonized(name)
        assert layers.apply_filter(TUBES)["tubes"] == pieces
        tubes = layers.current_mesh()
        assert tubes.label() == f"{name}_tubes" and euler(tubes) == number
        measures = layers.get_topological_measures()
        assert measures["boundary_edges"] == measures["non_two_manifold_edges"] == 0
        assert measures["non_two_manifold_vertices"] == 0
        assert measures["connected_components_number"] == pieces
        assert volume(tubes.vertex_matrix(), tubes.face_matrix()) > 0, "oriented outwards"

    def test_constant_and_local_radius(self):
        layers = opened("bent_tube")
        nodes, edges, radius = known_skeleton("bent_tube")
        add_curve(layers, nodes, edges, radius, "drawn")
        drawn = layers.current_mesh_id()
        length = np.linalg.norm(np.subtract(*nodes[edges].transpose(1, 0, 2)), axis=1).sum()
        for options, r in [({"radius": pymeshlab.PureValue(0.2 * radius.min())}, 0.2 * radius.min()),
                           ({"local_radius": True}, radius.mean())]:
            layers.set_current_mesh(drawn)
            layers.apply_filter(TUBES, sides=48, **options)
            tubes = layers.current_mesh()
            exact = np.pi * r ** 2 * length + 4 / 3 * np.pi * r ** 3
            assert volume(tubes.vertex_matrix(), tubes.face_matrix()) == pytest.approx(exact, rel=0.03)

    def test_colour_and_quality_are_the_thickness(self):
        layers = opened("bent_tube")
        add_curve(layers, [[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1], [1, 2]], [0.1, 0.2, 0.3], "bar")
        layers.apply_filter(TUBES)
        tubes = layers.current_mesh()
        assert set(np.round(tubes.vertex_scalar_array(), 6)) == {0.1, 0.2, 0.3}
        colours = tubes.vertex_color_matrix()
        thin, thick = (colours[np.isclose(tubes.vertex_scalar_array(), r)].mean(axis=0) for r in (0.1, 0.3))
        assert thin[2] - thin[0] > 0.5 and thick[0] - thick[2] > 0.5, "from blue to red"


class TestErrors:
    @pytest.mark.parametrize("name", ALL)
    def test_a_surface_is_no_skeleton(self, name):
        layers = opened("capsule")
        before = fingerprint(layers)
        with pytest.raises(pymeshlab.PyMeshLabException, match="skeleton"):
            layers.apply_filter(name)
        assert fingerprint(layers) == before

    @pytest.mark.parametrize("name, options, said", [
        (PRUNE, {"spur_prominence": 2}, "spur_prominence"),
        (PRUNE, {"detail": -0.1}, "detail"),
        (RESAMPLE_SKELETON, {"longest_edge": percent(0)}, "longest_edge"),
        (BALLS, {"voxel": percent(0)}, "voxel"),
        (TUBES, {"radius": percent(0)}, "radius"),
        (TUBES, {"sides": 2}, "sides"),
    ])
    def test_parameters_out_of_range(self, name, options, said):
        layers = opened("bent_tube")
        add_curve(layers, *known_skeleton("bent_tube"), "drawn")
        before = fingerprint(layers)
        with pytest.raises(pymeshlab.PyMeshLabException, match=said):
            layers.apply_filter(name, **options)
        assert fingerprint(layers) == before

    def test_same_input_same_bits(self):
        def run() -> list[np.ndarray]:
            layers = opened("bent_tube")
            add_curve(layers, *known_skeleton("bent_tube"), "drawn")
            layers.apply_filter(PARTS, surface=0)
            layers.apply_filter(MEASURE, surface=0)
            found = [layers.current_mesh().vertex_scalar_array(),
                     layers.mesh(0).face_scalar_array(), layers.mesh(0).vertex_scalar_array()]
            layers.apply_filter(BALLS, surface=0, voxel=percent(2))
            return found + [layers.current_mesh().vertex_matrix()]
        assert all(np.array_equal(a, b) for a, b in zip(run(), run()))


class TestDocs:
    """The examples of docs/tools.md, one after the other in one script."""

    def test_examples_run(self, plugin):
        text = (ROOT / "docs/tools.md").read_text()
        script = "\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL))
        run = subprocess.run([sys.executable, "-c", script.replace('"PLUGIN"', repr(str(plugin)))],
                             cwd=ROOT, capture_output=True, text=True, timeout=900)
        assert run.returncode == 0, run.stderr


class TestEditedByMeshLab:
    """What MeshLab's own filters leave of a skeleton layer."""

    @pytest.fixture
    def cut(self) -> pymeshlab.MeshSet:
        """A skeleton whose first nodes were deleted: MeshLab leaves their edges, which end nowhere."""
        layers = pymeshlab.MeshSet()
        add_curve(layers, [[x, 0, 0] for x in range(10)], [[i, i + 1] for i in range(9)], np.full(10, 0.5), "line")
        layers.compute_selection_by_condition_per_vertex(condselect="x < 2.5")
        layers.meshing_remove_selected_vertices()
        mesh = layers.current_mesh()
        assert (mesh.vertex_number(), mesh.edge_number()) == (7, 9)
        return layers

    @pytest.mark.parametrize("name, parameters, edges", [
        (PRUNE, {"spur_prominence": 0.0, "detail": 1.0}, 6),
        (RESAMPLE_SKELETON, {"longest_edge": percent(100), "smoothing": percent(0)}, 1)])
    def test_edges_of_deleted_nodes_go_with_them(self, cut, name, parameters, edges):
        results = cut.apply_filter(name, **parameters)
        assert (results["skeleton_edges"], results["components"], results["terminals"]) == (edges, 1, 2)
        assert results["skeleton_length"] == pytest.approx(6)

    def test_balls_tubes_and_comparing(self, cut):
        x = cut.mesh(0).vertex_matrix()[:, 0]
        assert (x.min(), x.max()) == (3, 9)
        assert cut.apply_filter(TUBES, radius=percent(5))["tubes"] == 1
        assert cut.current_mesh().vertex_matrix()[:, 0].min() > 2
        cut.set_current_mesh(0)
        cut.apply_filter(BALLS, voxel=percent(2))
        assert cut.current_mesh().vertex_matrix()[:, 0].min() > 2
        add_curve(cut, [[3, 0, 0], [9, 0, 0]], [[0, 1]], [0.5, 0.5], "same")
        assert cut.apply_filter(COMPARE, other=0)["distance_max_back"] == pytest.approx(0, abs=1e-6)

    def test_of_a_surface(self):
        layers = opened("capsule")
        layers.apply_filter(FULL, target_length=percent(2.5))
        count = layers.current_mesh().edge_number()
        layers.compute_selection_by_condition_per_vertex(condselect="vi < 3")
        layers.meshing_remove_selected_vertices()
        curve = layers.current_mesh_id()
        surface = layer(layers, "capsule_resampled").id()
        for name in [REFINE, PRUNE, MEASURE, PARTS]:
            layers.set_current_mesh(curve)
            results = layers.apply_filter(name, surface=surface)
            assert results.get("components", 1) == 1, name
        assert results["branches"] == 1
        layers.set_current_mesh(curve)
        assert layers.apply_filter(RESAMPLE_SKELETON)["components"] == 1
        assert layers.mesh(curve).edge_number() == count

    @pytest.mark.parametrize("ending", ["swc", "cg", "json", "vtp", "ply"])
    def test_saved(self, cut, tmp_path, ending):
        file = tmp_path / f"line.{ending}"
        assert cut.apply_filter("save_skeleton_mcf", file=str(file))["skeleton_edges"] == 6
        if ending in ("swc", "cg", "vtp"):
            cut.save_current_mesh(str(tmp_path / f"exported.{ending}"))
            assert (tmp_path / f"exported.{ending}").read_bytes() == file.read_bytes()
        if ending == "ply":
            cut.apply_filter("load_stage_mcf", file=str(file))
            assert sorted(map(sorted, cut.current_mesh().edge_matrix())) == [[i, i + 1] for i in range(6)]

    @pytest.mark.parametrize("made", [True, False])
    def test_nodes_that_are_no_places_are_refused(self, made):
        layers = opened("capsule")
        if made:
            layers.apply_filter(FULL, **COARSE)
        else:
            add_curve(layers, [[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1], [1, 2]], [1, 1, 1], "line")
        layers.compute_coord_by_function(x="vi < 2 ? sqrt(0-1) : x")
        before = fingerprint(layers)
        for name in ALL + [REFINE, "save_skeleton_mcf", "save_stage_mcf"]:
            parameters = {"file": "/nowhere/s.ply"} if name.startswith("save") else {}
            if name == COMPARE:
                parameters = {"other": 0}
            text = failing(layers, name, **parameters)
            assert "2 nodes" in text and "not finite" in text, name
        assert fingerprint(layers) == before
