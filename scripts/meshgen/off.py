# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as OFF, exact to single precision."""
from pathlib import Path

import numpy as np


def write_off(path: Path, vertices: np.ndarray, faces: np.ndarray) -> None:
    """Write vertices (v, 3) and triangles (f, 3)."""
    with open(path, "w") as out:
        out.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        out.writelines("%.9g %.9g %.9g\n" % tuple(p) for p in vertices)
        out.writelines("3 %d %d %d\n" % tuple(f) for f in faces)
