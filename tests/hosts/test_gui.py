# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab's window, used as a person does: searching for a filter, reading its dialog, applying it,
looking at the layers and at the picture, and being told what is wrong with a mesh."""

import re
import sys
from pathlib import Path
from typing import Iterator

import numpy as np
import pytest
from matplotlib.image import imread

from conftest import FULL, MESHES, ROOT, arrays, document, gui_host, opened
from filter_names import SAVE_PROJECT
from host_programs import ply_vertices

sys.path.insert(0, str(ROOT / "scripts" / "gui"))
from window import Layer, Widget, Window  # noqa: E402

PREFIX = "Mean Curvature Skeleton: "
NAMES = ["meshlab-2025.07", "meshlab-2020.09"]


@pytest.fixture(params=NAMES, scope="module")
def host(request: pytest.FixtureRequest) -> Path:
    """A MeshLab that has the plugin; skipped by name where it could not be set up."""
    return gui_host(request.param)


@pytest.fixture
def window(host: Path, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Window]:
    """MeshLab with the mesh that the test names, which is still there when the test is over."""
    mesh = MESHES / f"{request.param}.off"
    if not mesh.is_file():
        mesh = flat_mesh(tmp_path)
    with Window(host / "bin" / "meshlab", mesh, data=host / "data") as opened:
        yield opened
        assert opened.alive, f"MeshLab ended:\n{opened.log()}"
        assert "Exception" not in opened.log()


def flat_mesh(folder: Path) -> Path:
    """A capsule without volume."""
    lines = (MESHES / "capsule.off").read_text().splitlines()
    for i in range(2, 2 + int(lines[1].split()[0])):
        lines[i] = " ".join(lines[i].split()[:2] + ["0"])
    path = folder / "flat.off"
    path.write_text("\n".join(lines) + "\n")
    return path


def apply(window: Window, name: str) -> dict[str, float]:
    """Presses Apply in an open dialog; returns the numbers that the filter logs."""
    before = len(window.log())
    window.press(re.escape(PREFIX + name), "Apply")
    window.wait(lambda: re.search(f"Applied filter:? {PREFIX}{name} in", window.log()[before:]),
                f"{name} to end")
    pairs = re.findall(r"(\w+)[ =:]+(-?[\d.]+(?:e-?\d+)?)", window.log()[before:])
    window.close(PREFIX + name)
    return {key: float(value.rstrip(".")) for key, value in pairs}


def viewport(window: Window) -> np.ndarray:
    """The picture of the layers, as it is when nothing moves any more; values from 0 to 1."""
    box = window.wait(lambda: window.view().all("layered pane"), "the view")[0].box
    picture = imread(window.still_picture(window.folder / "view.png", box))[:, :, :3]
    # Without MeshLab's own text at the bottom and frame lines.
    return picture[6:-110, 6:-6]


def seen_pixels(picture: np.ndarray) -> np.ndarray:
    """Where something shows: the background has one colour a row."""
    return np.abs(picture - picture[:, :1]).max(axis=2) > 0.08


def surface_pixels(picture: np.ndarray) -> np.ndarray:
    """Where a layer without colours shows: grey, unlike the background."""
    return (np.ptp(picture, axis=2) < 0.03) & (picture.mean(axis=2) > 0.25)


def skeleton_pixels(picture: np.ndarray) -> np.ndarray:
    """Where the colours of thickness show, but for its blues, which the background has as well."""
    brightest = picture.max(axis=2)
    saturation = np.ptp(picture, axis=2) / np.maximum(brightest, 1e-6)
    return (saturation > 0.6) & (brightest > 0.3) & (picture.argmax(axis=2) != 2)


def outline_pixels(picture: np.ndarray) -> np.ndarray:
    """Where the points or edges of a surface show around a skeleton: light, a little blue."""
    return np.abs(picture - np.array([170, 180, 200]) / 255).max(axis=2) < 0.03


def grown(mask: np.ndarray, pixels: int) -> np.ndarray:
    result = mask.copy()
    for _ in range(pixels):
        result[1:] |= result[:-1]
        result[:-1] |= result[1:]
        result[:, 1:] |= result[:, :-1]
        result[:, :-1] |= result[:, 1:]
    return result


def extent(mask: np.ndarray) -> np.ndarray:
    rows, columns = np.nonzero(mask)
    return np.array([np.ptp(rows), np.ptp(columns)])


def new_pixels(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """What shows of the layers afterwards; the trackball's lines were there before."""
    lines = seen_pixels(before) & ~grown(surface_pixels(before), 2)
    return seen_pixels(after) & ~grown(lines, 1)


def assert_inside(inner: np.ndarray, surface: np.ndarray, least: int) -> None:
    """What shows lies within the outline of the surface, and reaches through it along its length."""
    assert inner.sum() > least
    assert (inner & ~grown(surface, 2)).sum() <= 0.01 * inner.sum()
    assert extent(inner).max() > 0.5 * extent(surface).max()


def names(layers: list[Layer]) -> list[str]:
    """Without the star of layers that are not saved."""
    return [layer.name.rstrip(" *") for layer in layers]


def visible(window: Window, layers: list[Layer]) -> list[str]:
    """The layers whose eye is open."""
    file = window.picture(window.folder / "screen.png")
    screen = imread(file)[:, :, :3]
    return [name for name, layer in zip(names(layers), layers) if has_open_eye(screen, layer)]


def has_open_eye(screen: np.ndarray, layer: Layer) -> bool:
    """The iris of the open eye is the only green in its row."""
    left, top, width, height = layer.eye
    icon = screen[top:top + height, left:left + width]
    return bool(((icon[..., 1] > icon[..., 0] + 0.15) & (icon[..., 1] > icon[..., 2] + 0.1)).sum() > 5)


@pytest.mark.parametrize("window", ["y_tube"], indirect=True)
def test_from_the_search_to_the_skeleton(window: Window) -> None:
    name = PREFIX + "Full Skeletonize"
    before = viewport(window)
    surface = surface_pixels(before)
    dialog = window.open_filter(name, "centerline")
    assert dialog.name == name
    # The dialog says what the filter does, each parameter what it means, lengths are percentages.
    shown = window.shown("frame", name)
    assert any("middle of the shape" in w.name and "Tagliasacchi" in w.name for w in shown.all("label"))
    for label, word in [("Resample first", "triangles"), ("Smoothness weight w_L", "published"),
                        ("Medial weight w_M", "centres the skeleton"), ("Keep every k-th stage", "layer")]:
        parameter = [w for w in shown if w.name == label]
        assert parameter and word in parameter[0].tooltip, label
    epsilon = [w for w in shown.all("label") if w.name.startswith("Shortest edge epsilon")]
    assert epsilon and "percent of the bounding box diagonal" in epsilon[0].tooltip
    assert float(shown.field(epsilon[0].name, "spin button")[1].content) == pytest.approx(0.2)

    numbers = apply(window, "Full Skeletonize")
    assert (numbers["components"], numbers["cycles"]) == (1, 0)
    assert (numbers["terminals"], numbers["junctions"]) == (3, 1)
    layers = window.layers()
    assert names(layers)[:2] == ["y_tube", "y_tube_resampled"]
    assert re.fullmatch(r"y_tube_meso_\d+", names(layers)[2])
    assert names(layers)[3:] == ["y_tube_skeleton"]
    assert visible(window, layers) == ["y_tube_resampled", "y_tube_skeleton"]
    picture = viewport(window)
    assert surface_pixels(picture).sum() < 0.1 * surface.sum()
    assert_inside(new_pixels(before, picture), surface, 200)
    line = skeleton_pixels(picture)
    assert line.sum() > 300, "its thickness is seen, in a line that is thicker than a pixel"
    assert_inside(outline_pixels(picture), surface, 500)
    assert (line & grown(outline_pixels(picture), 12)).sum() > 0.9 * line.sum(), "it lies in its surface"
    # One click on the eye of its surface, and it is alone.
    window.click_at(layers[1].eye)
    window.wait(lambda: visible(window, window.layers()) == ["y_tube_skeleton"], "the surface to hide")
    picture = viewport(window)
    assert outline_pixels(picture).sum() < 20 and skeleton_pixels(picture).sum() > 300


@pytest.mark.parametrize("window", ["y_tube"], indirect=True)
def test_a_project_is_seen_as_it_was_saved(window: Window, host: Path, tmp_path: Path) -> None:
    window.open_filter(PREFIX + "Full Skeletonize")
    apply(window, "Full Skeletonize")
    lines = [skeleton_pixels(viewport(window)).sum()]
    window.open_filter(PREFIX + "Save Project")
    window.choose_file(PREFIX + "Save Project", tmp_path / "y.mlp")
    apply(window, "Save Project")
    script = opened("y_tube")
    script.apply_filter(FULL)
    nodes = ply_vertices(next(tmp_path.glob("**/y_tube_skeleton.ply")))
    assert np.array_equal(np.column_stack([nodes[axis] for axis in "xyz"]),
                          script.current_mesh().vertex_matrix()), "the dialog's lengths are a script's"
    with Window(host / "bin" / "meshlab", tmp_path / "y.mlp", data=host / "data") as again:
        assert names(again.layers()) == names(window.layers())
        lines.append(skeleton_pixels(viewport(again)).sum())
    assert lines[1] > 0.8 * lines[0] > 200, "its colours are seen, and no surface hides it"


def test_another_body_of_that_name_still_shows(host: Path, tmp_path: Path) -> None:
    """MeshLab numbers layers of one name, as it does those that the filters make."""
    two = document(arrays("capsule"), arrays("torus"))
    for k, name in enumerate(["body", "body(1)"]):
        two.mesh(k).set_label(name)
    two.apply_filter(SAVE_PROJECT, file=str(tmp_path / "two.mlp"))
    with Window(host / "bin" / "meshlab", tmp_path / "two.mlp", data=host / "data") as window:
        window.click(next(w for w in window.view().all("table cell", r"body[ *]*$")))
        window.open_filter(PREFIX + "Full Skeletonize")
        assert apply(window, "Full Skeletonize")["cycles"] == 0
        layers = window.layers()
        assert visible(window, layers) == ["body(1)", "body_resampled", "body_skeleton"]


@pytest.mark.parametrize("window", ["capsule"], indirect=True)
def test_four_steps_and_the_curve(window: Window) -> None:
    before = viewport(window)
    surface = surface_pixels(before)
    window.open_filter(PREFIX + "Contraction Step")
    window.fill(PREFIX + "Contraction Step", "Steps", "4")
    numbers = apply(window, "Contraction Step")
    assert numbers["iterations"] == 4 and 0 < numbers["volume_fraction"] < 1
    layers = window.layers()
    assert names(layers) == ["capsule"] + [f"capsule_meso_{k}" for k in (1, 2, 3, 4)]
    assert visible(window, layers) == ["capsule_meso_4"]
    stage = new_pixels(before, viewport(window))
    assert_inside(stage, surface, 200)
    assert stage.sum() < 0.8 * surface.sum(), "it has contracted"

    window.open_filter(PREFIX + "Collapse to Curve")
    numbers = apply(window, "Collapse to Curve")
    assert (numbers["components"], numbers["cycles"]) == (1, 0)
    layers = window.layers()
    assert names(layers)[-1] == "capsule_skeleton"
    assert visible(window, layers) == ["capsule", "capsule_skeleton"]
    picture = viewport(window)
    assert_inside(new_pixels(before, picture), surface, 100)
    assert skeleton_pixels(picture).sum() > 50, "its thickness is seen"
    assert_inside(outline_pixels(picture), surface, 500)

    # Tubes take the skeleton's place, and the next stage takes theirs.
    window.open_filter(PREFIX + "Skeleton to Tubes")
    apply(window, "Skeleton to Tubes")
    assert visible(window, window.layers()) == ["capsule", "capsule_tubes"]
    window.click(next(w for w in window.view().all("table cell", "capsule_meso_4")))
    window.open_filter(PREFIX + "Contraction Step")
    apply(window, "Contraction Step")
    assert visible(window, window.layers()) == ["capsule_meso_5"]


@pytest.mark.parametrize("window", ["hand"], indirect=True)
def test_what_is_inside_out_of_a_stage_is_lit(window: Window) -> None:
    before = viewport(window)
    window.open_filter(PREFIX + "Contraction Step")
    window.fill(PREFIX + "Contraction Step", "Steps", "6")
    apply(window, "Contraction Step")
    assert "parts are inside out" in window.log()
    picture = viewport(window)
    stage = new_pixels(before, picture)
    assert stage.sum() > 2000
    assert (picture.max(axis=2)[stage] < 0.3).mean() < 0.02, "nothing is black"


def error_box(window: Window) -> list[Widget]:
    """The texts of the box that says that a filter has failed; empty if none shows."""
    return [text for role in ("alert", "dialog", "frame")
            for text in window.shown(role, "Filter Failure").all("label")]


@pytest.mark.parametrize("window", ["a flat one"], indirect=True)
def test_an_error_is_a_box_and_costs_nothing(window: Window) -> None:
    window.open_filter(PREFIX + "Full Skeletonize")
    window.press(re.escape(PREFIX), "Apply")
    text = " ".join(w.name for w in window.wait(lambda: error_box(window), "the error"))
    assert "Full Skeletonize" in text
    assert "the mesh is flat" in text
    window.press("Filter Failure", "OK")
    window.wait(lambda: not error_box(window), "the box to close")
    window.close(PREFIX + "Full Skeletonize")
    layers = window.layers()
    assert names(layers) == ["flat"] and visible(window, layers) == ["flat"]
    # And MeshLab goes on working.
    window.open_filter(PREFIX + "Collapse to Curve")
    window.press(re.escape(PREFIX), "Apply")
    window.wait(lambda: [w for w in error_box(window) if "Contraction Step" in w.name],
                "the second error")
