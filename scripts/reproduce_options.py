#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes Table 1 and the figures of the paper again, on shapes at hand, and puts them into docs/paper.md.

The program runs as `paper` and as `default`, beside Au et al. 2008; distances are to the skeletons of Dey
and Sun 2006, and to the exact medial axis. Results are kept in build/reproduce: a run that was interrupted
goes on where it stopped.
"""

# Only the standard library: --help is answered before anything is installed.

from __future__ import annotations

import argparse
from pathlib import Path


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/reproduce.sh", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", type=Path, metavar="MESH",
                        help="further shapes of Table 1; `elephant` is that of Fig. 5 and 6")
    parser.add_argument("--quick", action="store_true", help="small meshes, fewer weights, in five minutes")
    parser.add_argument("--vertices", type=int, metavar="N", help="of the meshes of Table 1 (default: as many as in the paper)")
    parser.add_argument("--docs", type=Path, metavar="FOLDER",
                        help="where paper.md is, and the folder paper with the pictures (default: docs; with --quick: "
                             "the tables are printed, the pictures go to build/reproduce)")
    parser.add_argument("--program", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if missing := [str(p) for p in options.meshes if not p.is_file()]:
        parser.error("no such mesh: " + ", ".join(missing))
    if options.docs and not (options.docs / "paper.md").is_file():
        parser.error(f"argument --docs: there is no paper.md in {options.docs}, whose tables are replaced")
    return options


if __name__ == "__main__":
    parse_arguments()
