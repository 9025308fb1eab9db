#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the gallery of docs/index.md: shapes of meshes/ with their skeletons, as the defaults give them."""

import argparse
import tempfile
from pathlib import Path

import pymeshlab
from PIL import Image

from picture import draw

ROOT = Path(__file__).resolve().parents[1]
SHAPES = ["animal", "hand", "tree", "embrace", "twin_ears", "knot", "plate3", "torus_capsule", "head",
          "letter_g", "letter_p", "horn"]
FRAME = (360, 270)  # pixels of each picture
LINE_WIDTH = 2.2  # of the skeletons, times that of large pictures
COLOURS = 96  # of a palette, which keeps the files small


def skeletonized(shape: str) -> tuple:
    """Vertices and faces of a shape; nodes, edges and radius of its skeleton."""
    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(str(ROOT / "meshes" / f"{shape}.off"))
    layers.apply_filter("generate_curve_skeleton_mcf")
    surface, skeleton = layers.mesh(0), layers.current_mesh()
    return (surface.vertex_matrix(), surface.face_matrix(), skeleton.vertex_matrix(),
            skeleton.edge_matrix(), skeleton.vertex_custom_scalar_attribute_array("mcfskel_radius"))


def framed(picture: Image.Image) -> Image.Image:
    """A picture in the middle of a white frame, all of one size."""
    picture.thumbnail(FRAME, Image.Resampling.LANCZOS)
    frame = Image.new("RGB", FRAME, "white")
    frame.paste(picture, ((FRAME[0] - picture.width) // 2, (FRAME[1] - picture.height) // 2))
    return frame


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", type=Path,
                        default=ROOT / "build/pymeshlab/filter_mcfskel/libfilter_mcfskel.so")
    parser.add_argument("--folder", type=Path, default=ROOT / "docs/gallery")
    parser.add_argument("shapes", nargs="*", metavar="SHAPE", default=SHAPES,
                        help=f"which to draw: {', '.join(SHAPES)} (default: all)")
    options = parser.parse_args()
    pymeshlab.load_plugin(str(options.plugin))
    options.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for shape in options.shapes:
            drawn, path = Path(folder) / "picture.png", options.folder / f"{shape}.png"
            draw(*skeletonized(shape), drawn, colour="branch", pixels=2 * FRAME[0],
                 line_width=LINE_WIDTH)
            framed(Image.open(drawn).convert("RGB")).quantize(COLOURS).save(path, optimize=True)
            print(path)


if __name__ == "__main__":
    main()
