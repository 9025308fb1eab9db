#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times this project beside its peers, in one run, on the same meshes, and prints tables.

Two jobs are timed: the contraction of the mesh as it is (poles, flow, collapse to a curve), and
the whole default job (resampling first), where the peer remeshes to the same edge length. Times
are medians: processor seconds in the rows of one thread, wall seconds in those of more and for
the peers from PyPI. Reading and writing files is not counted. --quality measures the skeletons that
came out, --studies what they depend on, --host what a host adds to the whole job.
"""

# Only the standard library: --help is answered before anything is installed.

from __future__ import annotations

import argparse
from pathlib import Path

JOBS = ("contraction", "whole", "host", "kept")
STUDIES = ("known-answers", "damage", "resolution", "noise", "invariance", "weights", "trees", "stability",
           "symmetry")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/bench.sh",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,  # scripts/bench.sh looks for some of them
    )
    parser.add_argument("meshes", nargs="*", type=Path, metavar="MESH", help="default: meshes/")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures")
    parser.add_argument("--runs", type=int, default=3, help="of each program (default 3)")
    parser.add_argument(
        "--subdivide", type=int, nargs="+", default=[0], metavar="K",
        help="cut each triangle into 4^K first, for each K",
    )
    parser.add_argument(
        "--threads", type=int, nargs="+", default=[1], metavar="N", help="a row for each number"
    )
    parser.add_argument(
        "--density", type=float, default=0.5, metavar="PCT",
        help="edge length of the whole job's resampling, %% of the diagonal (default 0.5)",
    )
    parser.add_argument(
        "--only", choices=JOBS, help="time this job alone"
    )
    parser.add_argument("--quality", action="store_true", help="measure the skeletons as well")
    parser.add_argument(
        "--no-peers", action="store_true", help="compare with CGAL only, not with PyGEL, skeletor"
    )
    parser.add_argument(
        "--host", action="store_true",
        help="run the whole job through pymeshlab as well, beside the bare library, and with its "
             "stages kept (builds the plugin)",
    )
    parser.add_argument(
        "--host-runs", type=int, default=15, metavar="N", help="of either (default 15)"
    )
    parser.add_argument("--stages", action="store_true", help="time single stages instead")
    parser.add_argument(
        "--studies", nargs="*", choices=STUDIES, metavar="NAME",
        help="instead, what the skeleton depends on: all studies, or " + ", ".join(STUDIES),
    )
    parser.add_argument(
        "--docs", action="store_true",
        help="put the tables and the plot of the growth into docs/ (with --quality: those, too)",
    )
    parser.add_argument(
        "--timeout", type=float, default=900, metavar="S", help="of one run (default 900)"
    )
    parser.add_argument(
        "--option", action="append", default=[], metavar="'--NAME VALUE'",
        help="handed to this project's program, e.g. '--pole-method voronoi'",
    )
    parser.add_argument("--programs", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--plugin", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--host-python", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    missing = [str(mesh) for mesh in arguments.meshes if not mesh.is_file()]
    if missing:
        parser.error("no such mesh: " + ", ".join(missing))
    if arguments.json and not arguments.json.absolute().parent.is_dir():
        parser.error(f"argument --json: there is no folder {arguments.json.parent}")
    return arguments


if __name__ == "__main__":
    parse_arguments()
