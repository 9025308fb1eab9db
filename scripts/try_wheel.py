# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Does what a newcomer does with an installed mcfskel: a mesh in, its skeleton and its files out."""

import sys
import tempfile
from pathlib import Path

import mcfskel
import numpy as np


def main(mesh: str) -> None:
    skeleton = mcfskel.skeletonize(mesh)
    assert skeleton.results["converged"] == 1 and skeleton.results["components"] == 1
    low, high = skeleton.surface.vertices.min(axis=0), skeleton.surface.vertices.max(axis=0)
    assert ((skeleton.nodes > low) & (skeleton.nodes < high)).all(), "outside of the bounding box"
    assert len(skeleton.correspondence) == len(skeleton.surface.vertices)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "skeleton.json")
        skeleton.save(path)
        assert np.array_equal(mcfskel.load(path).correspondence, skeleton.correspondence)
    assert "<svg" in skeleton._repr_html_()
    print(f"{sys.version.split()[0]}: {skeleton}")


if __name__ == "__main__":
    main(sys.argv[1])
