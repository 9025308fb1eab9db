# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each filter leaves behind: layers, attributes, numbers, and what they mean."""

import json
import multiprocessing
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest

from conftest import (COLLAPSE, FULL, MESHES, POLES, REFINE, RESAMPLE, STEP, area, arrays,
                      attributes, components, diagonal, document, edges_of, euler, failing,
                      fingerprint, labels, layer, opened, points, scalars, volume)

COARSE = {"target_length": pymeshlab.PercentageValue(1.2)}
REPAIR_NUMBERS = {"repaired", "distance_mean", "distance_max", "self_intersections",
                  "pieces_left_out"}
STAGE_NUMBERS = {"iterations", "converged", "volume_fraction", "area_fraction", "fixed_fraction",
                 "vertices", "faces"}
CURVE_NUMBERS = {"skeleton_vertices", "skeleton_edges", "components", "cycles", "branches",
                 "terminals", "junctions", "skeleton_length"}
SECONDS = {f"seconds_{stage}" for stage in
           ["resample", "poles", "contraction", "collapse", "refine"]}


def same_layer(a: pymeshlab.Mesh, b: pymeshlab.Mesh) -> bool:
    """Whether two layers agree bit for bit, attributes and quality included."""
    pairs = [(a.vertex_matrix(), b.vertex_matrix()), (a.face_matrix(), b.face_matrix()),
             (a.edge_matrix(), b.edge_matrix()), (a.vertex_scalar_array(), b.vertex_scalar_array())]
    mine, other = attributes(a), attributes(b)
    if mine.keys() != other.keys():
        return False
    return all(np.array_equal(x, y) for x, y in pairs + [(mine[k], other[k]) for k in mine])


@pytest.fixture(scope="module")
def torus_run():
    """Full Skeletonize on the torus, every second stage kept."""
    layers = opened("torus")
    before = layers.mesh(0).vertex_matrix(), layers.mesh(0).face_matrix()
    results = layers.apply_filter(FULL, keep_stages=2, **COARSE)
    return layers, results, before


def layers_of_a_run(plugin: str, mesh: str) -> list[tuple]:
    """For a process of its own: how many threads there may be is read once in each."""
    pymeshlab.load_plugin(plugin)
    layers = opened(mesh)
    layers.apply_filter(FULL, keep_stages=1, **COARSE)
    return fingerprint(layers)


@pytest.mark.parametrize("mesh", ["slab", "hand"])
def test_same_bits_on_any_number_of_threads(mesh, plugin, monkeypatch):
    runs = []
    for threads in (1, 2, 5):
        monkeypatch.setenv("OMP_NUM_THREADS", str(threads))
        with multiprocessing.get_context("spawn").Pool(1) as process:
            runs.append(process.apply(layers_of_a_run, (str(plugin), mesh)))
    assert len(runs[0]) > 10, "there are stages"
    assert runs[0] == runs[1] == runs[2]


def test_surfaces_and_stages_have_normals():
    layers = opened("capsule")
    layers.apply_filter(RESAMPLE, **COARSE)
    layers.apply_filter(STEP)
    for label in ["capsule_resampled", "capsule_meso_1"]:
        mesh = layer(layers, label)
        faces, corners = mesh.face_matrix(), mesh.vertex_matrix()[mesh.face_matrix()]
        of_faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        of_vertices = np.zeros_like(mesh.vertex_matrix())
        for k in range(3):
            np.add.at(of_vertices, faces[:, k], of_faces)
        for found, expected in [(mesh.face_normal_matrix(), of_faces),
                                (mesh.vertex_normal_matrix(), of_vertices)]:
            expected = expected / np.linalg.norm(expected, axis=1)[:, None]
            assert np.abs(found - expected).max() < 1e-3
        assert np.allclose(mesh.bounding_box().max(), mesh.vertex_matrix().max(axis=0))


class TestDefaults:
    """The parameters that scripts rely on."""

    def test_full(self):
        values = opened("capsule").filter_parameter_values(FULL)
        expected = {"resample": True, "resample_iterations": 5, "w_l": 1.0, "w_h": 20.0, "w_m": 40.0,
                    "split_angle": 110.0, "keep_stages": 0, "max_iterations": 500, "refine": True,
                    "denoise": True, "adaptive": True, "relative_length": pytest.approx(0.6), "detail": pytest.approx(0.9)}
        assert {name: values[name] for name in expected} == expected

    def test_preset(self):
        assert opened("capsule").filter_parameter_values(FULL)["preset"] == 0

    def test_epsilon_is_a_fifth_of_a_percent_of_the_diagonal(self):
        layers = opened("capsule")
        expected = 0.002 * diagonal(layers.mesh(0).vertex_matrix())
        for name in [STEP, COLLAPSE, FULL]:
            assert layers.filter_parameter_values(name)["epsilon"] == pytest.approx(expected)

    def test_a_stage_keeps_the_lengths_of_its_surface(self):
        layers = opened("capsule")
        before = layers.filter_parameter_values(STEP)["epsilon"]
        layers.apply_filter(STEP, steps=4)
        shrunk = diagonal(layers.current_mesh().vertex_matrix())
        assert shrunk < 0.95 * diagonal(layers.mesh(0).vertex_matrix())
        assert layers.filter_parameter_values(STEP)["epsilon"] == before

    def test_steps_and_layers(self):
        layers = opened("capsule")
        assert layers.filter_parameter_values(STEP)["steps"] == 1
        assert layers.filter_parameter_values(POLES)["create_layer"] is False


def test_the_preset_of_the_paper_is_not_changed_by_what_it_does_not_have():
    curves = []
    for options in [{}, {"denoise": False, "adaptive": False, "refine": False, "pole_method": "voronoi"}]:
        layers = opened("capsule")
        results = layers.apply_filter(FULL, preset="paper", **COARSE, **options)
        assert results["refined"] == 0 and results["converged"] == 1
        curves.append(layers.current_mesh().vertex_matrix())
    assert np.array_equal(*curves)


class TestResample:
    def test_new_layer_and_numbers(self):
        layers = opened("torus")
        before = layers.mesh(0).vertex_matrix()
        results = layers.apply_filter(RESAMPLE, **COARSE)
        assert labels(layers) == ["torus.off", "torus_resampled"]
        mesh = layers.current_mesh()
        assert mesh.label() == "torus_resampled"
        assert np.array_equal(layers.mesh(0).vertex_matrix(), before)
        assert results["vertices"] == mesh.vertex_number()
        assert results["faces"] == mesh.face_number()
        ends = mesh.vertex_matrix()[edges_of(mesh.face_matrix())]
        lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        assert results["edge_length_mean"] == pytest.approx(lengths.mean())
        assert lengths.mean() == pytest.approx(0.012 * diagonal(before), rel=0.15)
        assert lengths.std() < 0.25 * lengths.mean()

    def test_topology_and_shape_stay(self):
        layers = opened("plate3")
        original = layers.current_mesh()
        layers.apply_filter(RESAMPLE)
        mesh = layers.current_mesh()
        assert euler(mesh) == euler(original) == 2 - 2 * 3
        for measure in (area, volume):
            assert measure(mesh.vertex_matrix(), mesh.face_matrix()) == pytest.approx(
                measure(original.vertex_matrix(), original.face_matrix()), rel=0.01)

    def test_the_default_length_refines_a_coarse_mesh(self):
        layers = opened("torus72")
        results = layers.apply_filter(RESAMPLE)
        assert results["vertices"] > 3000

    def test_more_even_with_more_rounds(self):
        def spread(rounds: int) -> float:
            layers = opened("animal450")
            layers.apply_filter(RESAMPLE, resample_iterations=rounds, **COARSE)
            mesh = layers.current_mesh()
            ends = mesh.vertex_matrix()[edges_of(mesh.face_matrix())]
            lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
            return lengths.std() / lengths.mean()

        assert spread(5) < spread(1)


class TestPoles:
    @pytest.mark.parametrize("method, tolerance", [("voronoi", 0.05), ("balls", 0.3)])
    def test_poles_of_a_torus_lie_on_its_circle(self, method, tolerance):
        layers = opened("torus")
        record = json.loads((MESHES / "torus.json").read_text())
        results = layers.apply_filter(POLES, pole_method=method)
        mesh = layers.current_mesh()
        radius, pole = scalars(mesh, "mcfskel_pole_radius"), points(mesh, "mcfskel_pole")
        has = radius >= 0
        assert results == {"poles": int(has.sum()), "without_pole": int((~has).sum())}
        assert has.mean() > 0.99
        assert np.linalg.norm(pole - mesh.vertex_matrix(), axis=1)[has] == pytest.approx(radius[has])
        circle = np.array(record["skeleton"]["nodes"])
        tube = np.mean(record["skeleton"]["radius"])
        distance = np.linalg.norm(pole[has][::20, None] - circle[None], axis=2).min(axis=1)
        assert np.percentile(distance, 95) < tolerance * tube
        assert distance.max() < tube
        assert np.median(radius[has]) == pytest.approx(tube, rel=0.2 * tolerance)

    def test_written_in_place_and_the_layer_stays_current(self):
        layers = opened("torus")
        layers.apply_filter(POLES)
        assert labels(layers) == ["torus.off"]

    def test_layer_of_poles(self):
        layers = opened("torus")
        results = layers.apply_filter(POLES, create_layer=True)
        assert labels(layers) == ["torus.off", "torus_poles"]
        cloud = layers.current_mesh()
        assert (cloud.label(), cloud.face_number()) == ("torus_poles", 0)
        assert cloud.vertex_number() == results["poles"]
        surface = layers.mesh(0)
        has = scalars(surface, "mcfskel_pole_radius") >= 0
        assert np.array_equal(cloud.vertex_matrix(), points(surface, "mcfskel_pole")[has])


class TestStep:
    def test_new_layer_with_its_state(self):
        layers = opened("torus")
        surface = layers.mesh(0)
        results = layers.apply_filter(STEP)
        assert set(results) == STAGE_NUMBERS | REPAIR_NUMBERS
        assert all(results[name] == 0 for name in REPAIR_NUMBERS)
        assert labels(layers) == ["torus.off", "torus_meso_1"]
        stage = layers.current_mesh()
        assert stage.label() == "torus_meso_1"
        assert set(attributes(stage)) == {
            "mcfskel_pole", "mcfskel_pole_radius", "mcfskel_fixed", "mcfskel_radius", "mcfskel_kind"}
        assert np.isin(scalars(stage, "mcfskel_fixed"), [0, 1]).all()
        assert stage.vertex_scalar_array() == pytest.approx(scalars(stage, "mcfskel_radius"))
        assert euler(stage) == euler(surface) == 0
        assert results["vertices"] == stage.vertex_number()
        assert results["faces"] == stage.face_number()
        for key, measure in [("area_fraction", area), ("volume_fraction", volume)]:
            assert results[key] == pytest.approx(
                measure(stage.vertex_matrix(), stage.face_matrix())
                / measure(surface.vertex_matrix(), surface.face_matrix()))
            assert 0 < results[key] < 0.95
        assert results["fixed_fraction"] == pytest.approx(scalars(stage, "mcfskel_fixed").mean())

    def test_radius_is_the_mean_distance_to_the_surface_that_merged(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=5)
        stage, surface = layers.current_mesh(), layers.mesh(0)
        node = scalars(surface, "mcfskel_node").astype(int)
        distance = np.linalg.norm(
            surface.vertex_matrix() - stage.vertex_matrix()[node], axis=1)
        count = np.bincount(node, minlength=stage.vertex_number())
        total = np.bincount(node, distance, minlength=stage.vertex_number())
        radius = scalars(stage, "mcfskel_radius")
        assert radius[count > 0] == pytest.approx(total[count > 0] / count[count > 0])
        assert (radius > 0).all()

    def test_several_steps_are_single_steps(self):
        at_once, singly = opened("animal450"), opened("animal450")
        results = at_once.apply_filter(STEP, steps=4)
        for _ in range(4):
            last = singly.apply_filter(STEP)
        assert results == last
        assert labels(at_once) == labels(singly) == ["animal450.off"] + [
            f"animal450_meso_{k}" for k in (1, 2, 3, 4)]
        for a, b in zip(at_once, singly):
            assert same_layer(a, b), a.label()

    def test_steps_from_an_older_stage_branch_off(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=3)
        layers.set_current_mesh(layer(layers, "torus_meso_2").id())
        layers.apply_filter(STEP)
        again = layers.current_mesh()
        assert again.label().startswith("torus_meso_3")
        assert np.array_equal(again.vertex_matrix(),
                              layer(layers, "torus_meso_3").vertex_matrix())

    def test_weights_matter(self):
        fractions = []
        for weights in [{}, {"w_l": 4}, {"w_h": 60}]:
            layers = opened("torus")
            fractions.append(layers.apply_filter(STEP, **weights)["volume_fraction"])
        assert fractions[1] < fractions[0] < fractions[2]

    def test_without_medial_weight_the_flow_still_contracts(self):
        layers = opened("torus")
        fractions = [layers.apply_filter(STEP, w_m=0)["volume_fraction"] for _ in range(4)]
        assert all(later < 0.97 * earlier for earlier, later in zip([1, *fractions], fractions))

    def test_larger_epsilon_leaves_fewer_vertices(self):
        counts = []
        for percent in [0.1, 0.4, 1]:
            layers = opened("torus")
            counts.append(layers.apply_filter(
                STEP, steps=6, epsilon=pymeshlab.PercentageValue(percent))["vertices"])
        assert counts[0] > counts[1] > counts[2]

    def test_steps_end_at_convergence(self):
        layers = opened("torus")
        layers.apply_filter(RESAMPLE, **COARSE)
        results = layers.apply_filter(STEP, steps=100)
        assert results["converged"] == 1 and results["iterations"] < 100
        assert results["volume_fraction"] < 1e-3
        before = labels(layers)
        assert layers.apply_filter(STEP) == results
        assert labels(layers) == before

    def test_poles_already_there_are_used(self):
        voronoi, balls = opened("cuboid"), opened("cuboid")
        voronoi.apply_filter(POLES, pole_method="voronoi")
        balls.apply_filter(POLES, pole_method="balls")
        assert not np.array_equal(points(voronoi.current_mesh(), "mcfskel_pole"),
                                  points(balls.current_mesh(), "mcfskel_pole"))
        shown = points(voronoi.mesh(0), "mcfskel_pole").copy()
        voronoi.apply_filter(STEP)
        balls.apply_filter(STEP)
        assert np.array_equal(points(voronoi.mesh(0), "mcfskel_pole"), shown)
        assert not np.array_equal(voronoi.current_mesh().vertex_matrix(),
                                  balls.current_mesh().vertex_matrix())

    def test_poles_of_a_mesh_that_moved_are_not_used(self):
        moved, fresh = opened("torus"), opened("torus")
        moved.apply_filter(POLES)
        for layers in (moved, fresh):
            layers.compute_matrix_from_translation(axisx=0.5, freeze=True)
            layers.apply_filter(STEP)
        assert same_layer(moved.current_mesh(), fresh.current_mesh())

    def test_a_stage_that_was_moved_goes_on(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=2)
        layers.compute_matrix_from_scaling_or_normalization(axisx=2.0, freeze=True)
        assert layers.apply_filter(STEP)["iterations"] == 3


class TestCollapse:
    def test_curve_of_the_last_stage(self):
        layers = opened("torus")
        layers.apply_filter(RESAMPLE, **COARSE)
        stage = layers.apply_filter(STEP, steps=100)
        results = layers.apply_filter(COLLAPSE)
        assert stage["converged"] == 1
        assert set(results) == CURVE_NUMBERS | {"converged"}
        curve = layers.current_mesh()
        assert curve.label() == "torus_skeleton"
        assert (curve.vertex_number(), curve.edge_number(), curve.face_number()) == (
            results["skeleton_vertices"], results["skeleton_edges"], 0)
        assert (results["components"], results["cycles"], results["terminals"]) == (1, 1, 0)

    @pytest.mark.parametrize("steps", [1, 4])
    def test_an_early_stage_has_the_right_topology_too(self, steps):
        layers = opened("plate3")
        layers.apply_filter(STEP, steps=steps)
        results = layers.apply_filter(COLLAPSE)
        assert (results["components"], results["cycles"]) == (1, 3)
        assert layers.current_mesh().face_number() == 0

    def test_surface_knows_its_nodes(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=6)
        layers.apply_filter(COLLAPSE)
        curve, surface = layers.current_mesh(), layers.mesh(0)
        node = scalars(surface, "mcfskel_node").astype(int)
        assert node.min() >= 0 and node.max() < curve.vertex_number()
        distance = np.linalg.norm(surface.vertex_matrix() - curve.vertex_matrix()[node], axis=1)
        assert distance.max() < 0.2 * diagonal(surface.vertex_matrix())

    def test_the_surface_may_be_gone(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=2)
        layers.set_current_mesh(0)
        layers.delete_current_mesh()
        layers.set_current_mesh(layer(layers, "torus_meso_2").id())
        assert layers.apply_filter(COLLAPSE)["cycles"] == 1


@pytest.fixture(scope="module")
def letter():
    """A letter P, refined as a step of its own: the document and the numbers."""
    layers = opened("letter_p")
    layers.apply_filter(FULL, refine=False, **COARSE)
    before = layers.current_mesh().vertex_matrix()
    results = layers.apply_filter(REFINE)
    assert np.array_equal(layer(layers, "letter_p_skeleton").vertex_matrix(), before)
    return layers, results


    def test_a_stage_that_has_not_converged_says_so(self, plugin):
        """In the result and in the log; one that has says nothing."""
        script = ("import pymeshlab, sys\n"
                  "pymeshlab.load_plugin(sys.argv[1])\n"
                  "layers = pymeshlab.MeshSet(verbose=True)\n"
                  "layers.load_new_mesh(sys.argv[2])\n"
                  f"layers.apply_filter('{STEP}', steps=int(sys.argv[3]))\n"
                  f"print('CONVERGED', layers.apply_filter('{COLLAPSE}')['converged'])\n")
        for steps, converged in [(2, 0), (100, 1)]:
            run = subprocess.run([sys.executable, "-c", script, str(plugin),
                                  str(MESHES / "torus.off"), str(steps)],
                                 capture_output=True, text=True, check=True)
            output = run.stdout + run.stderr
            assert f"CONVERGED {converged}" in output
            assert ("has not converged after 2 iterations" in output) == (not converged)


class TestRefine:
    def test_new_layer_of_the_same_topology(self, letter):
        layers, results = letter
        curve = layers.current_mesh()
        assert curve.label() == "letter_p_refined"
        assert (results["components"], results["cycles"]) == (1, 1)
        assert results["refined"] == 1
        assert results["skeleton_vertices"] == curve.vertex_number()
        assert components(curve.vertex_number(), curve.edge_matrix()) == 1

    def test_full_skeletonize_says_whether_it_refined(self):
        for refine in [True, False]:
            layers = opened("letter_p")
            assert layers.apply_filter(FULL, refine=refine, **COARSE)["refined"] == int(refine)

    def test_nodes_are_evenly_spaced(self, letter):
        curve = letter[0].current_mesh()
        ends = curve.vertex_matrix()[curve.edge_matrix()]
        length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        spacing = 0.005 * diagonal(letter[0].mesh(0).vertex_matrix())
        assert np.median(length) == pytest.approx(spacing, rel=0.2)
        assert length.max() < 2 * spacing

    def test_correspondence_follows_on_both_surfaces(self, letter):
        layers, _ = letter
        curve = layers.current_mesh()
        for name in ["letter_p.off", "letter_p_resampled"]:
            surface = layer(layers, name)
            node = scalars(surface, "mcfskel_node").astype(int)
            assert node.min() >= 0 and node.max() < curve.vertex_number()
            nodes = curve.vertex_matrix()
            gap = np.linalg.norm(surface.vertex_matrix() - nodes[node], axis=1)
            least = np.array([np.linalg.norm(nodes - p, axis=1).min()
                              for p in surface.vertex_matrix()[::50]])
            assert (gap[::50] <= 1.5 * least).mean() > 0.95

    def test_of_a_skeleton_from_elsewhere_in_a_surface_that_is_named(self):
        layers = opened("capsule")
        size = diagonal(layers.mesh(0).vertex_matrix())
        x = layers.mesh(0).vertex_matrix()[:, 0]
        straight = np.linspace(x.min() / 2, x.max() / 2, 20)
        aside = np.column_stack([straight, np.full(20, 0.02 * size), np.zeros(20)])
        edges = np.column_stack([np.arange(19), np.arange(1, 20)])
        layers.add_mesh(pymeshlab.Mesh(vertex_matrix=aside, edge_matrix=edges), "drawn")
        assert "surface" in failing(layers, REFINE)
        layers.apply_filter(REFINE, surface=0)
        nodes = layers.current_mesh().vertex_matrix()
        assert np.abs(nodes[:, 1:]).max() < 0.002 * size, "centred"
        assert np.ptp(nodes[:, 0]) > np.ptp(straight), "extended to the ends"
        assert scalars(layers.mesh(0), "mcfskel_node").max() == len(nodes) - 1

    def test_of_something_else(self):
        layers = opened("capsule")
        assert "faces" in failing(layers, REFINE)


@pytest.fixture(scope="module")
def surfaces():
    """A torus, bumpy by 0.3 % of its diagonal: its resampling as it is and smoothed."""
    vertices, faces = arrays("torus")
    bumps = np.random.default_rng(1).normal(size=vertices.shape) * 0.003 * diagonal(vertices)
    result = []
    for denoise in [False, True]:
        layers = document((vertices + bumps, faces))
        layers.apply_filter(RESAMPLE, denoise=denoise, **COARSE)
        result.append(layers.current_mesh().vertex_matrix())
    return result


def distances(points: np.ndarray, nodes: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """The distance of each point from a graph."""
    start, way = nodes[edges[:, 0]], nodes[edges[:, 1]] - nodes[edges[:, 0]]
    along = ((points[:, None] - start) * way).sum(axis=2) / (way**2).sum(axis=1)
    foot = start + np.clip(along, 0, 1)[..., None] * way
    return np.linalg.norm(points[:, None] - foot, axis=2).min(axis=1)


class TestKnownSkeletons:
    """Shapes of tubes whose axes are known: all of the axis is met, and nothing else is there."""

    @pytest.mark.parametrize("name", [
        "bent_tube", "horn", "knot", "torus_capsule", "tree", "y_tube"])
    def test_are_met(self, name):
        shape = json.loads((MESHES / f"{name}.json").read_text())
        axis = shape["skeleton"]
        assert axis["complete"]
        nodes, edges = np.array(axis["nodes"]), np.array(axis["edges"])
        layers = opened(name)
        layers.apply_filter(FULL, refine=False)
        for mean, refined in [(0.01, False), (0.0015, True)]:  # of the diagonal
            if refined:
                layers.apply_filter(REFINE)
            curve = layers.current_mesh()
            assert curve.label().endswith("_refined" if refined else "_skeleton")
            own, pairs = curve.vertex_matrix(), curve.edge_matrix()
            degree = np.bincount(pairs.ravel(), minlength=len(own))
            assert (degree == 1).sum() == shape["expected_tips"]
            assert len(pairs) - len(own) + shape["components"] == shape["expected_cycles"]
            away, missed = distances(own, nodes, edges), distances(nodes, own, pairs)
            for distance in (away, missed):
                assert distance.mean() < mean * shape["diagonal"]
                assert distance.max() < 0.01 * shape["diagonal"]


class TestDenoise:
    def test_brings_a_noisy_surface_nearer_to_the_clean_one(self, surfaces):
        record = json.loads((MESHES / "torus.json").read_text())["skeleton"]
        circle, tube = np.array(record["nodes"]), np.mean(record["radius"])

        def error(points: np.ndarray) -> float:
            gap = np.linalg.norm(points[:, None] - circle[None], axis=2).min(axis=1)
            return np.sqrt(np.mean((gap - tube) ** 2))
        raw, smooth = surfaces
        assert error(smooth) < 0.6 * error(raw)

    def test_leaves_a_clean_surface_alone(self):
        results = []
        for denoise in [False, True]:
            layers = opened("torus")
            layers.apply_filter(RESAMPLE, denoise=denoise, **COARSE)
            results.append(layers.current_mesh().vertex_matrix())
        assert np.array_equal(*results)


class TestFull:
    def test_layers(self, torus_run):
        layers, results, before = torus_run
        iterations = results["iterations"]
        kept = sorted({*range(2, iterations + 1, 2), iterations})
        assert labels(layers) == ["torus.off", "torus_resampled"] + [
            f"torus_meso_{k}" for k in kept] + ["torus_skeleton"]
        assert layers.current_mesh().label() == "torus_skeleton"
        assert np.array_equal(layers.mesh(0).vertex_matrix(), before[0])
        assert np.array_equal(layers.mesh(0).face_matrix(), before[1])

    def test_numbers(self, torus_run):
        layers, results, _ = torus_run
        assert set(results) == (STAGE_NUMBERS | REPAIR_NUMBERS | CURVE_NUMBERS | SECONDS
                                | {"refined", "bridges"})
        assert all(results[name] == 0 for name in REPAIR_NUMBERS)
        assert all(isinstance(value, (int, float)) for value in results.values())
        curve = layers.current_mesh()
        edges = curve.edge_matrix()
        ends = curve.vertex_matrix()[edges]
        lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        assert results["skeleton_length"] == pytest.approx(lengths.sum())
        assert lengths.min() > 0
        pairs = np.sort(edges, axis=1)
        assert len(np.unique(pairs, axis=0)) == len(pairs) and (pairs[:, 0] < pairs[:, 1]).all()
        assert results["components"] == components(curve.vertex_number(), edges) == 1
        assert results["cycles"] == len(edges) - curve.vertex_number() + 1 == 1
        assert results["converged"] == 1
        assert (results["branches"], results["terminals"], results["junctions"]) == (1, 0, 0)

    def test_skeleton_of_a_torus_is_its_circle(self, torus_run):
        layers, _, before = torus_run
        record = json.loads((MESHES / "torus.json").read_text())["skeleton"]
        curve = layers.current_mesh()
        circle = np.array(record["nodes"])
        gaps = np.linalg.norm(curve.vertex_matrix()[:, None] - circle[None], axis=2)
        tolerance = 0.01 * diagonal(before[0])
        assert gaps.min(axis=1).max() < tolerance
        assert gaps.min(axis=0).max() < 2 * tolerance
        assert scalars(curve, "mcfskel_radius") == pytest.approx(np.mean(record["radius"]), rel=0.1)

    def test_correspondence_on_both_surfaces(self, torus_run):
        layers, _, _ = torus_run
        curve = layers.current_mesh()
        tube = np.mean(json.loads((MESHES / "torus.json").read_text())["skeleton"]["radius"])
        for name in ["torus.off", "torus_resampled"]:
            surface = layer(layers, name)
            node = scalars(surface, "mcfskel_node").astype(int)
            assert node.min() >= 0 and node.max() < curve.vertex_number()
            distance = np.linalg.norm(
                surface.vertex_matrix() - curve.vertex_matrix()[node], axis=1)
            assert distance == pytest.approx(tube, rel=0.25)

    def test_quality_is_the_radius(self, torus_run):
        curve = torus_run[0].current_mesh()
        assert curve.vertex_scalar_array() == pytest.approx(scalars(curve, "mcfskel_radius"))

    def test_scripts_see_every_layer_and_no_colours(self, torus_run):
        layers = torus_run[0]
        assert all(mesh.is_visible() for mesh in layers)
        assert not layer(layers, "torus_skeleton").has_vertex_color()

    def test_is_the_filters_one_by_one(self, torus_run):
        layers, results, _ = torus_run
        singly = opened("torus")
        singly.apply_filter(RESAMPLE, **COARSE)
        singly.apply_filter(POLES)
        for _ in range(results["iterations"]):
            singly.apply_filter(STEP)
        singly.apply_filter(COLLAPSE)
        unrefined = opened("torus")
        unrefined.apply_filter(FULL, keep_stages=2, refine=False, **COARSE)
        assert labels(unrefined) == labels(layers)
        for mesh in unrefined:
            if mesh.label() != "torus.off":
                assert same_layer(mesh, layer(singly, mesh.label())), mesh.label()
        singly.apply_filter(REFINE)
        for mesh in layers:
            if mesh.label() != "torus.off":
                label = mesh.label().replace("_skeleton", "_refined")
                assert same_layer(mesh, layer(singly, label)), label

    def test_same_input_same_bits(self, torus_run):
        layers, _, _ = torus_run
        again = opened("torus")
        again.apply_filter(FULL, keep_stages=2, **COARSE)
        assert labels(again) == labels(layers)
        assert all(same_layer(a, b) for a, b in zip(layers, again))

    def test_several_components_each_get_their_skeleton(self):
        layers = opened("torus_capsule")
        results = layers.apply_filter(FULL, **COARSE)
        assert (results["components"], results["cycles"], results["terminals"]) == (2, 1, 2)

    def test_without_resampling(self):
        layers = opened("capsule")
        results = layers.apply_filter(FULL, resample=False)
        assert labels(layers) == [
            "capsule.off", f"capsule_meso_{results['iterations']}", "capsule_skeleton"]
        surface = layers.mesh(0)
        assert set(attributes(surface)) == {"mcfskel_pole", "mcfskel_pole_radius", "mcfskel_node"}

    def test_iterations_are_capped(self):
        layers = opened("capsule")
        results = layers.apply_filter(FULL, max_iterations=2, **COARSE)
        assert (results["iterations"], results["converged"]) == (2, 0)
        assert results["components"] == 1

    def test_works_in_the_frame_of_the_layer(self, torus_run):
        layers = opened("torus")
        layers.compute_matrix_from_translation(axisx=3.0, freeze=False)
        layers.apply_filter(FULL, **COARSE)
        matrix = layers.mesh(0).transform_matrix()
        assert matrix[0, 3] == 3.0
        for mesh in layers:
            assert np.array_equal(mesh.transform_matrix(), matrix), mesh.label()
        assert np.array_equal(layers.current_mesh().vertex_matrix(),
                              torus_run[0].current_mesh().vertex_matrix())

    def test_two_meshes_in_one_document_do_not_meet(self):
        layers = document(arrays("capsule"), arrays("torus"))
        layers.set_current_mesh(0)
        layers.apply_filter(STEP, steps=2)
        layers.set_current_mesh(1)
        layers.apply_filter(STEP, steps=2)
        layers.set_current_mesh(layer(layers, "mesh_0_meso_2").id())
        assert layers.apply_filter(COLLAPSE)["cycles"] == 0
        for surface, merged in [(layers.mesh(0), layers.current_mesh()),
                                (layers.mesh(1), layer(layers, "mesh_1_meso_2"))]:
            vertices = surface.vertex_matrix()
            node = scalars(surface, "mcfskel_node").astype(int)
            assert node.min() >= 0 and node.max() < merged.vertex_number()
            distance = np.linalg.norm(vertices - merged.vertex_matrix()[node], axis=1)
            assert distance.max() < 0.25 * diagonal(vertices)
