#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the pictures of MeshLab's window in docs/gui: what a user sees of the filters."""

import argparse
import re
import sys
import tempfile
from pathlib import Path
from typing import Callable, Optional

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts" / "gui"))
from display import SIZE  # noqa: E402
from window import Window  # noqa: E402

PREFIX = "Mean Curvature Skeleton: "
COLOURS = 160  # of a palette, which keeps the files small


def apply(window: Window, name: str) -> None:
    before = len(window.log())
    window.press(re.escape(PREFIX + name), "Apply")
    window.wait(lambda: "Applied filter" in window.log()[before:], f"{name} to end")


def dialog(window: Window) -> None:
    """The dialog of Full Skeletonize."""
    window.open_filter(PREFIX + "Full Skeletonize")


def skeleton(window: Window) -> None:
    """The skeleton that Full Skeletonize has made, the layers and the log."""
    window.open_filter(PREFIX + "Full Skeletonize")
    apply(window, "Full Skeletonize")
    window.close(PREFIX + "Full Skeletonize")
    window.turn(60, -190)


def stages(window: Window) -> None:
    """Four stages of the contraction as layers, the last one shown."""
    window.open_filter(PREFIX + "Contraction Step")
    window.fill(PREFIX + "Contraction Step", "Steps", "4")
    apply(window, "Contraction Step")
    window.close(PREFIX + "Contraction Step")


def error(window: Window) -> None:
    """What MeshLab says of a filter on a layer that it cannot work on."""
    window.open_filter(PREFIX + "Collapse to Curve")
    window.press(re.escape(PREFIX), "Apply")
    window.wait(lambda: [w for w in window.view() if "Filter Failure" in w.name], "the error")


def project(window: Window) -> None:
    """A project that Save Project has written, opened again."""
    window.turn(60, -190)


def saved_project(folder: Path, host: Path, data: Optional[Path]) -> Path:
    """A project of the animal and its skeleton, and the stage between, as the window shows them."""
    file = folder / "animal.mlp"
    with Window(host / "bin" / "meshlab", ROOT / "meshes" / "animal.off", data=data) as window:
        window.open_filter(PREFIX + "Full Skeletonize")
        apply(window, "Full Skeletonize")
        window.close(PREFIX + "Full Skeletonize")
        window.open_filter(PREFIX + "Save Project")
        window.choose_file(PREFIX + "Save Project", file)
        apply(window, "Save Project")
    return file


def part_of_screen(window: Window) -> Optional[tuple[int, int, int, int]]:
    """What dialogs and boxes take, where some are open; of a project all but its title, which is the folder that it
    happens to be in; else the whole screen."""
    view = window.view()
    boxes = [w.box for w in view
             if w.name.startswith(PREFIX) and w.role == "frame" or w.name == "Filter Failure"]
    if boxes:
        left, top = (min(box[k] for box in boxes) for k in (0, 1))
        right, bottom = (max(box[k] + box[k + 2] for box in boxes) for k in (0, 1))
        return left, top, right - left, bottom - top
    if any(w.name.endswith(".mlp") for w in view):
        top = window.layers()[0].eye[1] - 8
        return 0, top, SIZE[0], SIZE[1] - top
    return None


PICTURES: dict[str, tuple[str, Callable[[Window], None]]] = {
    "dialog": ("animal", dialog),
    "skeleton": ("animal", skeleton),
    "stages": ("hand", stages),
    "error": ("hand", error),
    "project": ("animal.mlp", project),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", type=Path, required=True,
                        help="folder of MeshLab 2025.07: what scripts/get_host.sh prints")
    parser.add_argument("--data", type=Path,
                        help="$XDG_DATA_HOME with the plugin in it, if MeshLab has it from there")
    parser.add_argument("--folder", type=Path, default=ROOT / "docs/gui")
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(PICTURES),
                        help=f"which to take: {', '.join(PICTURES)} (default: all)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for name in options.names:
        mesh, act = PICTURES[name]
        path = options.folder / f"{name}.png"
        with tempfile.TemporaryDirectory() as folder:
            opened = (saved_project(Path(folder), options.host, options.data) if mesh.endswith(".mlp")
                      else ROOT / "meshes" / f"{mesh}.off")
            with Window(options.host / "bin" / "meshlab", opened, data=options.data) as window:
                act(window)
                window.still_picture(path, part_of_screen(window))
        Image.open(path).convert("RGB").quantize(COLOURS).save(path, optimize=True)
        print(path)


if __name__ == "__main__":
    main()
