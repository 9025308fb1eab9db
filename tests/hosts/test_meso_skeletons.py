# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meso-skeletons as users see them: kinds of vertices, vertices that are held, sheets that are kept."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from conftest import (COLLAPSE, FULL, MESHES, RESAMPLE, ROOT, STEP, failing, fingerprint, layer, opened,
                      scalars)

COARSE = {"target_length": pymeshlab.PercentageValue(1.2)}
# Coarse enough to be quick; a third of the vertices of the defaults.
QUICK = {"target_length": pymeshlab.PercentageValue(0.9), "epsilon": pymeshlab.PercentageValue(0.3)}
CURVE, SHEET, VOLUME = 0, 1, 2


def kinds(mesh: pymeshlab.Mesh) -> np.ndarray:
    return scalars(mesh, "mcfskel_kind")


def rows_of(points: np.ndarray, among: np.ndarray) -> np.ndarray:
    """For each point whether it is among others, to single precision: the input is rounded to that."""
    distance = np.array([np.linalg.norm(among - p, axis=1).min() for p in points])
    return distance < 1e-6 * np.linalg.norm(np.ptp(points, axis=0) + np.abs(points).max())


def selected_near(layers: pymeshlab.MeshSet, centre: np.ndarray, radius: float) -> np.ndarray:
    """Selects the vertices of the current layer in a ball; returns which."""
    x, y, z = centre
    layers.compute_selection_by_condition_per_vertex(
        condselect=f"(x-({x}))^2+(y-({y}))^2+(z-({z}))^2<{radius}^2")
    return layers.current_mesh().vertex_selection_array()


class TestKinds:
    def test_a_tube_is_volume_then_curve(self):
        layers = opened("torus")
        layers.apply_filter(RESAMPLE, **COARSE)
        layers.apply_filter(STEP, steps=1)
        assert (kinds(layers.current_mesh()) == VOLUME).all()
        assert layers.apply_filter(STEP, steps=100)["converged"] == 1
        assert (kinds(layers.current_mesh()) == CURVE).mean() > 0.99

    def test_a_slab_is_a_sheet_on_its_way(self):
        layers = opened("slab")
        layers.apply_filter(FULL, keep_stages=1, **COARSE)
        shares = [(kinds(mesh) == SHEET).mean() for mesh in layers if "_meso_" in mesh.label()]
        assert max(shares) > 0.8
        assert shares[-1] < 0.2, "in the end it is a curve"

    def test_colours_tell_kinds_apart(self):
        layers = opened("slab")
        layers.apply_filter(STEP, steps=4)
        stages = [mesh for mesh in layers if "_meso_" in mesh.label()]
        kind = np.concatenate([kinds(stage) for stage in stages])
        colours = np.concatenate([stage.vertex_color_matrix() for stage in stages])
        assert {SHEET, VOLUME} <= set(kind) <= {CURVE, SHEET, VOLUME}
        for k in set(kind):
            assert np.ptp(colours[kind == k], axis=0).max() == 0
        assert len(np.unique(colours, axis=0)) == len(set(kind))


class TestHeldVertices:
    def test_they_stay_from_step_to_step(self):
        layers = opened("torus")
        before = layers.mesh(0).vertex_matrix()
        chosen = selected_near(layers, before[0], 0.3)
        held = before[chosen]
        assert 5 < len(held) < 0.2 * len(before)
        layers.apply_filter(STEP, fix_selected=True)
        for _ in range(5):
            layers.apply_filter(STEP)  # the stage knows what it holds
        stage = layers.current_mesh()
        assert rows_of(held, stage.vertex_matrix()).all()
        assert scalars(stage, "mcfskel_held").sum() == len(held)
        node = scalars(layers.mesh(0), "mcfskel_node").astype(int)
        assert stage.vertex_matrix()[node[chosen]] == pytest.approx(held, rel=1e-6, abs=1e-6)
        assert layers.apply_filter(STEP)["volume_fraction"] < 0.3

    def test_single_ones_become_nodes_of_the_skeleton(self):
        layers = opened("capsule")
        before = layers.mesh(0).vertex_matrix()
        axis = np.ptp(before, axis=0).argmax()
        ends = before[[before[:, axis].argmin(), before[:, axis].argmax()]]
        condition = "||".join(f"((x-({x}))^2+(y-({y}))^2+(z-({z}))^2<1e-10)" for x, y, z in ends)
        layers.compute_selection_by_condition_per_vertex(condselect=condition)
        assert layers.mesh(0).vertex_selection_array().sum() == 2
        results = layers.apply_filter(FULL, resample=False, fix_selected=True)
        assert (results["components"], results["cycles"], results["converged"]) == (1, 0, 1)
        assert rows_of(ends, layers.current_mesh().vertex_matrix()).all()

    def test_after_resampling_the_nearest_are_held(self):
        layers = opened("capsule")
        before = layers.mesh(0).vertex_matrix()
        axis = np.ptp(before, axis=0).argmax()
        end = before[before[:, axis].argmax()]
        selected_near(layers, end, 1e-6)
        layers.apply_filter(FULL, fix_selected=True, **COARSE)
        resampled = layer(layers, "capsule_resampled").vertex_matrix()
        nearest = resampled[np.linalg.norm(resampled - end, axis=1).argmin()]
        assert rows_of(nearest[None], layers.current_mesh().vertex_matrix()).all()

    def test_a_stage_may_hold_more(self):
        layers = opened("torus")
        layers.apply_filter(STEP, steps=2)
        some = layers.current_mesh().vertex_matrix()
        chosen = selected_near(layers, some[0], 0.2)
        layers.apply_filter(STEP, steps=3, fix_selected=True)
        assert rows_of(some[chosen], layers.current_mesh().vertex_matrix()).all()
        layers.apply_filter(COLLAPSE)

    @pytest.mark.parametrize("name", [STEP, FULL])
    def test_nothing_selected_is_an_error(self, name):
        layers = opened("torus")
        before = fingerprint(layers)
        assert "is selected: select the vertices to hold" in failing(layers, name, fix_selected=True)
        assert fingerprint(layers) == before


def faces_on_edges(mesh: pymeshlab.Mesh) -> np.ndarray:
    """For each edge of the faces the number of faces that have it."""
    faces = mesh.face_matrix()
    pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(pairs, axis=0, return_counts=True)[1]


class TestKeepSheets:
    def test_a_slab_is_one_rectangle(self):
        layers = opened("slab")
        surface = layers.mesh(0).vertex_matrix()
        results = layers.apply_filter(FULL, keep_sheets=True, **QUICK)
        assert [results[b] for b in ("b0", "b1", "b2")] == [1, 0, 0]
        assert (results["sheets"], results["sheets_given_up"], results["converged"]) == (1, 0, 1)
        sheet = layers.current_mesh()
        assert sheet.label() == "slab_skeleton"
        assert (sheet.face_number(), sheet.edge_number()) == (results["sheet_faces"], 0)
        assert set(faces_on_edges(sheet)) == {1, 2}, "a single wall"
        assert (kinds(sheet) == SHEET).all()
        low, high = surface.min(axis=0), surface.max(axis=0)
        flat = (high - low).argmin()
        across = np.delete(high - low, flat)
        assert 0.5 * across.prod() < results["sheet_area"] < across.prod()
        off = np.abs(sheet.vertex_matrix()[:, flat] - (low + high)[flat] / 2)
        assert off.mean() < 5e-4 * np.linalg.norm(high - low)

    def test_a_cup_is_a_wall_with_a_bottom_and_a_handle(self):
        layers = opened("cup")
        results = layers.apply_filter(FULL, keep_sheets=True, **QUICK)
        assert [results[b] for b in ("b0", "b1", "b2")] == [1, 1, 0]
        assert results["sheets_given_up"] == 0
        cup = layers.current_mesh()
        assert cup.edge_number() == results["skeleton_edges"] > 10
        assert cup.face_number() == results["sheet_faces"] > 1000
        assert set(kinds(cup)) == {CURVE, SHEET}

    def test_plates_on_a_ring(self):
        layers = opened("plate3")
        results = layers.apply_filter(FULL, keep_sheets=True, **QUICK)
        assert [results[b] for b in ("b0", "b1", "b2")] == [1, 3, 0]
        node = scalars(layers.mesh(0), "mcfskel_node").astype(int)
        assert node.min() >= 0 and node.max() < layers.current_mesh().vertex_number()

    def test_a_shape_without_sheets_is_a_curve(self):
        plain, sheets = opened("torus"), opened("torus")
        expected = plain.apply_filter(FULL, **COARSE)
        results = sheets.apply_filter(FULL, keep_sheets=True, **COARSE)
        assert (results["sheets"], results["sheet_faces"], results["b1"]) == (0, 0, 1)
        assert all(results[key] == expected[key] for key in expected if "seconds" not in key)
        assert np.array_equal(
            plain.current_mesh().vertex_matrix(), sheets.current_mesh().vertex_matrix())

    def test_the_threshold_decides(self):
        shape = json.loads((MESHES / "cup.json").read_text())["parameters"]
        wide, high, wall = shape["radius"], shape["height"], shape["wall"]
        whole = np.pi * wide**2 + 2 * np.pi * wide * high  # of the bottom and the wall, in their middle
        areas = []
        for threshold in [0.5, 0.85, 1]:
            layers = opened("cup")
            results = layers.apply_filter(
                FULL, keep_sheets=True, sheet_threshold=threshold, **QUICK)
            assert [results[b] for b in ("b0", "b1", "b2")] == [1, 1, 0]
            areas.append(results["sheet_area"])
            cup = layers.current_mesh()
            x, y, z = cup.vertex_matrix()[np.unique(cup.face_matrix()).astype(int)].T
            aside = np.hypot(x, y) - wide
            off = np.minimum(np.hypot(np.maximum(aside, 0), z),
                             np.hypot(aside, np.maximum(z - high, 0) + np.minimum(z, 0)))
            assert len(off) == 0 or off.mean() < wall / 20
        assert whole > areas[0] > areas[1] > areas[2] == 0
        assert areas[1] > 0.85 * whole, "but for a thickness along the rim"

    def test_steps_carry_sheets_along(self):
        at_once, singly = opened("slab"), opened("slab")
        for layers in (at_once, singly):
            layers.apply_filter(RESAMPLE, **COARSE)
        at_once.apply_filter(STEP, steps=3, keep_sheets=True)
        singly.apply_filter(STEP, keep_sheets=True)
        singly.apply_filter(STEP, steps=2)
        assert np.array_equal(
            at_once.current_mesh().vertex_matrix(), singly.current_mesh().vertex_matrix())
        singly.apply_filter(STEP, steps=100)
        results = singly.apply_filter(COLLAPSE, keep_sheets=True)
        assert (results["b1"], results["sheets"]) == (0, 1)

    def test_what_is_a_sheet_at_a_stage_may_stay_one(self):
        layers = opened("slab")
        layers.apply_filter(RESAMPLE, **COARSE)
        layers.apply_filter(STEP, steps=4)
        stage = layers.current_mesh()
        assert (kinds(stage) == SHEET).mean() > 0.5
        results = layers.apply_filter(COLLAPSE, keep_sheets=True)
        assert [results[b] for b in ("b0", "b1", "b2")] == [1, 0, 0]
        assert results["sheet_area"] > 0

    def test_the_threshold_has_a_range(self):
        layers = opened("torus")
        assert "sheet_threshold" in failing(
            layers, FULL, keep_sheets=True, sheet_threshold=1.5)


def test_the_example_of_the_page_runs(plugin: Path):
    page = (ROOT / "docs" / "meso_skeletons.md").read_text()
    script = "\n".join(re.findall(r"```python\n(.*?)```", page, re.DOTALL))
    script = script.replace('"PLUGIN"', repr(str(plugin)))
    run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True,
                         timeout=600)
    assert run.returncode == 0, run.stderr
