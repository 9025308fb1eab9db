# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of all shapes, exact skeletons in red, expected ones in orange."""
import json
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image

from .fields import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402

COLUMNS = 6
AZIMUTH_DEG, ELEVATION_DEG = -60.0, 28.0


def read_off(path: Path) -> tuple[Array, Array]:
    """Vertices and faces of an OFF file of generate_meshes.py."""
    lines = path.read_text().splitlines()
    vertices, faces = map(int, lines[1].split()[:2])
    v = np.array([line.split() for line in lines[2:2 + vertices]], float)
    f = np.array([line.split()[1:] for line in lines[2 + vertices:2 + vertices + faces]], int)
    return v, f


def draw_contact_sheet(folder: Path, names: list[str], target: Path) -> None:
    """Draw the shapes `names` of `folder` into the PNG `target`."""
    a, e = np.radians([AZIMUTH_DEG, ELEVATION_DEG])
    view = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    screen = np.stack([right, np.cross(view, right)], axis=1)
    light = 0.6 * view - 0.3 * screen[:, 0] + 0.5 * screen[:, 1]
    rows = -(-len(names) // COLUMNS)
    figure, cells = plt.subplots(rows, COLUMNS, figsize=(2.0 * COLUMNS, 2.0 * rows),
                                 squeeze=False)
    for cell in cells.flat:
        cell.axis("off")
    for name, cell in zip(names, cells.flat):
        v, f = read_off(folder / f"{name}.off")
        record = json.loads((folder / f"{name}.json").read_text())
        corners = v[f]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        order = np.argsort(corners.mean(axis=1) @ view, kind="stable")
        order = order[normal[order] @ view > 0.0]
        shade = 0.35 + 0.6 * np.clip(normal[order] @ light, 0.0, 1.0)
        colour = np.stack([0.75 * shade, 0.85 * shade, shade], axis=1)
        cell.add_collection(PolyCollection(corners[order] @ screen, facecolors=colour,
                                           edgecolors=colour, linewidths=0.2))
        if "skeleton" in record:
            s = record["skeleton"]
            nodes, edges = np.array(s["nodes"]) @ screen, np.array(s["edges"])
            exact = np.array(s["exact"])[edges].all(axis=1)
            cell.add_collection(LineCollection(nodes[edges], linewidths=1.5, colors=[
                "red" if flag else "orange" for flag in exact]))
        flat = v @ screen
        cell.set_xlim(flat[:, 0].min(), flat[:, 0].max())
        cell.set_ylim(flat[:, 1].min(), flat[:, 1].max())
        cell.set_aspect("equal")
        cell.set_title(name, fontsize=8)
    figure.tight_layout(pad=0.3)
    figure.savefig(target, dpi=90, metadata={"Software": None})
    plt.close(figure)
    # Few colours are in it: a palette halves the file.
    Image.open(target).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(
        target, optimize=True)
