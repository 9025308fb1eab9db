#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scores programs that make curve skeletons on surfaces whose skeletons are known.

The surfaces are generated first: shapes around curves and sheets, each in several triangulations, in two parts, one to
tune on and one to check on. Then each program makes its skeletons, unless it has made them before, and a table says
how near they come to the truth. docs/benchmark.md says what each column means and how another program is added.
"""

# Only the standard library: --help is answered before anything is installed.

from __future__ import annotations

import argparse
from pathlib import Path

PROGRAMS = ("mcfskel", "cgal", "cgal_remeshed", "vmtk", "pygel", "skeletor", "compas_cgal")
FAMILIES = ("tube", "knot", "loops", "aneurysm", "arterial", "sapling", "tree", "thin", "vessel", "neuron", "creature",
            "plate", "lattice")
PARTS = ("tune", "check")
DEFAULT_FOLDER = Path("build/benchmark")


def named(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not (name and equals and value) or "/" in name:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return name, value


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/benchmark.sh", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False)
    parser.add_argument(
        "--programs", nargs="*", choices=PROGRAMS, default=list(PROGRAMS), metavar="NAME",
        help="of the known programs, those to run (default: all): " + ", ".join(PROGRAMS))
    parser.add_argument(
        "--program", type=named, action="append", default=[], metavar="NAME='COMMAND'",
        help="another program: its command with {mesh} (OFF) and {skeleton}, the file to write without its "
             "ending, e.g. 'mine {mesh} {skeleton}.swc'; .obj, .swc, .cg, .ply and .vtp are read")
    parser.add_argument(
        "--results", type=named, action="append", default=[], metavar="NAME=FOLDER",
        help="skeletons that were made elsewhere: a file for each surface, of the surface's name")
    parser.add_argument("--families", nargs="+", choices=FAMILIES, default=list(FAMILIES), metavar="NAME",
                        help="of surfaces (default: all): " + ", ".join(FAMILIES))
    parser.add_argument("--part", choices=PARTS, help="only this part of the surfaces")
    parser.add_argument("--by", choices=("family", "variant"), help="a table for each family or variant as well")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="write the figures of each skeleton")
    parser.add_argument("--timeout", type=float, default=60, metavar="S", help="of one run (default 60)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="runs side by side (default 1)")
    parser.add_argument("--folder", type=Path, default=DEFAULT_FOLDER, metavar="FOLDER",
                        help=f"for surfaces and skeletons (default {DEFAULT_FOLDER})")
    parser.add_argument("--generate", action="store_true", help="make the surfaces, and stop")
    parser.add_argument("--bench-programs", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--vmtk-python", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    for name, command in arguments.program:
        if name in PROGRAMS or "{mesh}" not in command or "{skeleton}." not in command:
            parser.error(f"argument --program: {name} is a known program, or its command lacks {{mesh}} or "
                         "{skeleton} with an ending")
    for _, folder in arguments.results:
        if not Path(folder).is_dir():
            parser.error(f"argument --results: there is no folder {folder}")
    if arguments.csv and not arguments.csv.absolute().parent.is_dir():
        parser.error(f"argument --csv: there is no folder {arguments.csv.parent}")
    return arguments


if __name__ == "__main__":
    parse_arguments()
