#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generate trees and tubes with a known centreline: FAMILY_SEED.off and FAMILY_SEED.npz (nodes, edges).

`nodes` (n, 4) holds x, y, z and radius, `edges` (m, 2) pairs of them: round cones, of which the surface is
the union. Each mesh is checked to have the genus that its centreline has cycles. Needs
scripts/requirements-meshes.txt. `scripts/bench.sh FILES --studies trees` compares skeletons with the centrelines.
"""
import argparse
import sys
from pathlib import Path

import numpy as np

from meshgen.families import FAMILIES
from meshgen.off import write_off
from meshgen.trees import subdivided, surface_of


def generate(family: str, seed: int, folder: Path) -> str | None:
    """Write one shape; returns a line about it, None where the union has another topology."""
    line = FAMILIES[family](seed)
    vertices, faces, genus = surface_of(subdivided(line))
    nodes, edges = line.arrays()
    if genus != len(edges) - len(nodes) + 1:
        return None
    stem = folder / f"{family}_{seed}"
    write_off(Path(f"{stem}.off"), vertices, faces)
    np.savez(f"{stem}.npz", nodes=nodes, edges=edges)
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    tips = int((np.bincount(edges.ravel()) == 1).sum())
    return (f"{family}_{seed}: {len(vertices)} vertices, {tips} tips, genus {genus}, radii "
            f"{100 * nodes[:, 3].min() / size:.3f} to {100 * nodes[:, 3].max() / size:.2f} %")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("families", nargs="*", metavar="FAMILY", choices=[*FAMILIES, []],
                        help="which (default: all): " + ", ".join(FAMILIES))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], metavar="SEED")
    parser.add_argument("--output", type=Path, default=Path("."), metavar="FOLDER")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    failed = 0
    for family in options.families or FAMILIES:
        for seed in options.seeds:
            said = generate(family, seed, options.output)
            failed += said is None
            print(said or f"{family}_{seed}: the union has another genus than its centreline has cycles")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
