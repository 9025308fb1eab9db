#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generate the test shapes of meshes/: NAME.off, NAME.json with what is known of it, index.json.

Every mesh is checked (watertight, two-manifold, oriented, no crossing or degenerate face, the
genus that is meant, exact skeleton nodes inside at their radius) as it will be read back; the
first failure ends the script with status 1. Needs scripts/requirements-meshes.txt; with these
versions each run writes the same bytes.
"""
import argparse
import json
import sys
from pathlib import Path

import numpy as np

from meshgen.shapes import SHAPES, Shape
from meshgen.verify import BadMesh, check_mesh, distance_to_mesh, require

DECIMALS = 6


def off_text(v: np.ndarray, f: np.ndarray) -> str:
    """The mesh as OFF."""
    lines = ["OFF", f"{len(v)} {len(f)} 0"]
    lines += [" ".join(f"{x + 0.0:.{DECIMALS}f}" for x in p) for p in v]
    lines += [f"3 {a} {b} {c}" for a, b, c in f]
    return "\n".join(lines) + "\n"


def mean_edge(v: np.ndarray, f: np.ndarray) -> float:
    """Mean edge length."""
    return float(np.mean([np.linalg.norm(v[f[:, k]] - v[f[:, k - 1]], axis=1).mean()
                          for k in range(3)]))


def check_skeleton(shape: Shape, v: np.ndarray, f: np.ndarray) -> float:
    """Largest difference of an exact node's distance to the surface from its radius.

    The faces are chords of the smooth surface: at most edge^2 / (2 radius) is lost by them.
    """
    skeleton = shape.skeleton
    if skeleton is None or not skeleton.exact.any():
        return 0.0
    radii = skeleton.radii[skeleton.exact]
    error = distance_to_mesh(skeleton.nodes[skeleton.exact], v, f) - radii
    allowed = mean_edge(v, f) ** 2 / (2.0 * radii)
    if shape.how.startswith("marching"):
        require(bool(np.all(np.abs(error) <= allowed)),
                f"a node is {np.abs(error).max():.4f} from its radius")
    else:
        require(bool(np.all(np.abs(error) < 1e-6)), "a node is off its radius")
    return float(np.abs(error).max())


def number(value: float) -> float:
    """A float of the files' precision, without negative zero."""
    return round(float(value), DECIMALS) + 0.0


def describe(name: str, shape: Shape, v: np.ndarray, f: np.ndarray, error: float) -> dict:
    """The contents of NAME.json."""
    record = {
        "name": name,
        "file": f"{name}.off",
        "description": shape.description,
        "made_by": shape.how,
        "parameters": shape.parameters,
        "vertices": len(v),
        "faces": len(f),
        "diagonal": number(np.linalg.norm(np.ptp(v, axis=0))),
        "mean_edge": number(mean_edge(v, f)),
        "components": shape.components,
        "genus": shape.genus,
        "mirror_symmetric_y": shape.mirror,
        "expected_tips": shape.tips,
        "expected_junctions": shape.junctions,
        "expected_cycles": shape.genus,
        "note": shape.note,
    }
    if shape.sheet:
        record["sheet"] = {"corners": shape.sheet, "radius": shape.parameters["radius"]}
    if shape.skeleton is not None:
        s = shape.skeleton
        record["skeleton"] = {
            "complete": shape.complete,
            "exact_nodes": int(s.exact.sum()),
            "radius_error_max": number(error),
            "nodes": [[number(x) for x in p] for p in s.nodes],
            "radius": [number(r) for r in s.radii],
            "exact": [int(e) for e in s.exact],
            "edges": s.edges.tolist(),
        }
    return record


def json_text(record: dict) -> str:
    """JSON, one key a line, lists on one line."""
    def block(value: object, indent: str) -> str:
        if isinstance(value, dict):
            inner = indent + "  "
            body = ",\n".join(f"{inner}{json.dumps(k)}: {block(x, inner)}"
                              for k, x in value.items())
            return "{\n" + body + f"\n{indent}}}"
        return json.dumps(value)

    return block(record, "") + "\n"


def generate(name: str, folder: Path) -> dict:
    """Make, check and write one shape; returns its record."""
    shape = SHAPES[name]()
    v = np.round(shape.vertices, DECIMALS)
    check_mesh(v, shape.faces, shape.genus, shape.components)
    record = describe(name, shape, v, shape.faces, check_skeleton(shape, v, shape.faces))
    (folder / f"{name}.off").write_text(off_text(v, shape.faces))
    (folder / f"{name}.json").write_text(json_text(record))
    return record


def write_index(folder: Path) -> None:
    """index.json: one line for each shape that is in the folder."""
    keys = ("vertices", "faces", "components", "genus", "expected_tips", "expected_junctions",
            "diagonal", "mirror_symmetric_y")
    index = {}
    for name in SHAPES:
        file = folder / f"{name}.json"
        if file.exists():
            record = json.loads(file.read_text())
            s = record.get("skeleton", {"exact_nodes": 0, "nodes": [], "complete": False})
            exact = "no" if not s["exact_nodes"] else (
                "all" if s["complete"] and s["exact_nodes"] == len(s["nodes"]) else "part")
            index[name] = {**{k: record[k] for k in keys}, "exact_skeleton": exact}
    body = ",\n".join(f"  {json.dumps(k)}: {json.dumps(x)}" for k, x in index.items())
    (folder / "index.json").write_text("{\n" + body + "\n}\n")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*SHAPES, []],
                        help="shapes to make (default: all): " + ", ".join(SHAPES))
    parser.add_argument("--output", type=Path, metavar="FOLDER",
                        default=Path(__file__).resolve().parent.parent / "meshes",
                        help="where to write (default: the project's meshes/)")
    parser.add_argument("--picture", type=Path, metavar="PNG",
                        help="draw all shapes of the folder into this file (needs matplotlib)")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in options.names or SHAPES:
        try:
            record = generate(name, options.output)
        except BadMesh as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
        print(f"{name:14} {record['vertices']:6} vertices, genus {record['genus']}, "
              f"{record['components']} component(s)")
    write_index(options.output)
    if options.picture:
        from meshgen.picture import draw_contact_sheet
        there = [name for name in SHAPES if (options.output / f"{name}.off").exists()]
        draw_contact_sheet(options.output, there, options.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
