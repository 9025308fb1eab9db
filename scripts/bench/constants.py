#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What depends on each constant of the library.

Copies the library, makes every number that a `constexpr double NAME = NUMBER` or the default of a parameter holds
one that the environment can change, and builds the command-line program once. Then it runs each shape with each
constant divided and multiplied by a factor, and counts the shapes whose skeleton has other tips, or other cycles.
Writes the table between the marks of docs/design.md, or prints it.
"""

from __future__ import annotations

import argparse
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple, Optional

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = Path("vcg_ext") / "skeleton"
#: What a skeletonization runs; the others measure, read and write.
FOLDERS = ["mesh", "spatial", "graph", "input", "poles", "resample", "solver", "flow", "collapse", "sheets", "refine"]
MARKS = ("<!-- constants: written by scripts/bench/constants.py -->", "<!-- end of constants -->")
NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?f?"
EXPRESSION = re.compile(r"(?:M_PI|[\d.]+(?:e-?\d+)?f?|[-+*/() ]|<<)+")
DECLARATION = re.compile(r"^(\t*)(static |inline )?constexpr (double|float) ([^;()]*=[^;]*);", re.M)
DEFAULT = re.compile(rf"^(\t+)(double) (\w+) = ({NUMBER});", re.M)
#: Below this a number is a guard against rounding, which nothing is to hang on.
ROUNDING = 1e-5

SUPPORT = """// Numbers that the environment changes, for scripts/bench/constants.py.
#ifndef VCG_MCF_CHANGEABLE_H
#define VCG_MCF_CHANGEABLE_H
#include <cstdio>
#include <cstdlib>
#include <string>
namespace vcg::tri::mcf {
inline double changeable(const char* name, double value)
{
	if (const char* log = std::getenv("MCFSKEL_CONSTANTS_LOG"))
		if (std::FILE* file = std::fopen(log, "a")) {
			std::fprintf(file, "%s\\n", name);
			std::fclose(file);
		}
	const char* changed = std::getenv("MCFSKEL_CONSTANT");
	const char* factor = std::getenv("MCFSKEL_FACTOR");
	return changed && factor && std::string(changed) == name ? value * std::atof(factor) : value;
}
}
#endif
"""


class Constant(NamedTuple):
    name: str     # file:name
    value: str
    meaning: str


class Shape(NamedTuple):
    tips: int
    cycles: int


def meaning_of(text: str, start: int, rest: str) -> str:
    """The comment beside a declaration, or the one above it."""
    beside = re.match(r"[^\n]*?//[/<]*\s*(.*)", rest)
    if beside:
        return beside.group(1).strip()
    lines = text[:start].rstrip("\n").split("\n")
    above: list[str] = []
    while lines and re.match(r"\s*//", lines[-1]):
        above.insert(0, re.sub(r"^\s*//[/<]*\s?", "", lines.pop()))
    return " ".join(above).strip()


def number(expression: str) -> float:
    """The value of an expression of literal numbers; 0 if it is none."""
    if not EXPRESSION.fullmatch(expression):
        return 0
    plain = re.sub(r"(?<=[\d.])f", "", expression).replace("M_PI", str(math.pi))
    return float(eval(plain, {"__builtins__": {}}))  # noqa: S307: digits and operators only


def changeable(text: str, file: str) -> tuple[str, list[Constant]]:
    """A header whose constants ask the environment, and these constants."""
    found: list[Constant] = []

    def declaration(match: re.Match[str]) -> str:
        indent, storage, kind, list_ = match.groups()
        new = []
        for part in re.split(r",\s*(?=\w+ =)", list_):
            name, value = (x.strip() for x in part.split("=", 1))
            if abs(number(value)) >= ROUNDING:
                id_ = f"{file}:{name}"
                found.append(Constant(id_, value, meaning_of(text, match.start(), text[match.end():])))
                value = f'{kind}(::vcg::tri::mcf::changeable("{id_}", {value}))'
            new.append(f"{name} = {value}")
        # In a class or a namespace there is one of it; in a function it is asked for once.
        once = "static" if indent and storage != "static " else "inline" if not indent else "inline static"
        return f"{indent}{once} const {kind} {', '.join(new)};"

    def default(match: re.Match[str]) -> str:
        indent, kind, name, value = match.groups()
        if float(value) in (0, 1, -1):
            return match.group(0)
        id_ = f"{file}:{name}"
        found.append(Constant(id_, value, meaning_of(match.string, match.start(), match.string[match.end():])))
        return f'{indent}{kind} {name} = ::vcg::tri::mcf::changeable("{id_}", {value});'

    changed = DECLARATION.sub(declaration, text)
    if "struct" in text and file in ("parameters.h", "refine_parameters.h", "refine_peaks.h", "prune.h"):
        changed = DEFAULT.sub(default, changed)
    if found:
        changed = re.sub(r"(#define VCG_MCF_\w+_H\n)", r"\1#include <skeleton/core/changeable.h>\n", changed, count=1)
    return changed, found


def build(folder: Path, vcg: Path, jobs: int) -> tuple[Path, list[Constant]]:
    """The program with changeable constants."""
    for name in ("CMakeLists.txt", "CMakePresets.json", "cmake", "vcg_ext", "tests", "README.md", "LICENSE"):
        place = ROOT / name
        (shutil.copytree if place.is_dir() else shutil.copy)(place, folder / name)
    constants: list[Constant] = []
    (folder / LIBRARY / "core" / "changeable.h").write_text(SUPPORT)
    places = [p for name in FOLDERS for p in sorted((folder / LIBRARY / name).glob("*.h"))]
    for header in [folder / LIBRARY / "core" / "parameters.h", *places]:
        text, found = changeable(header.read_text(), header.name)
        header.write_text(text)
        constants += found
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DMCFSKEL_PLUGIN=OFF", "-DMCFSKEL_BENCH=ON", "-DMCFSKEL_TESTS=OFF",
               f"-DVCG_INCLUDE_DIR={vcg}"]
    for command in (["cmake", "-S", str(folder), "-B", str(folder / "build"), "-G", "Ninja", *options],
                    ["ninja", "-C", str(folder / "build"), f"-j{jobs}", "mcfskel_cli"]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            sys.exit(done.stdout + done.stderr)
    return folder / "build" / "tests" / "bench" / "mcfskel_cli", constants


def shape_of(obj: Path) -> Shape:
    degree: Counter[int] = Counter()
    nodes = edges = 0
    parent: list[int] = []

    def find(v: int) -> int:
        while parent[v] != v:
            parent[v] = v = parent[parent[v]]
        return v

    lines = obj.read_text().splitlines()
    nodes = sum(line.startswith("v ") for line in lines)
    parent = list(range(nodes + 1))
    for line in lines:
        if line.startswith("l "):
            ids = [int(x) for x in line.split()[1:]]
            for a, b in zip(ids, ids[1:]):
                edges += 1
                degree.update((a, b))
                parent[find(a)] = find(b)
    components = sum(find(v) == v for v in range(1, nodes + 1))
    return Shape(sum(d == 1 for d in degree.values()), edges - nodes + components)


def run(program: Path, mesh: Path, more: dict[str, str], seconds: float) -> Optional[Shape]:
    """None: an error, or far more time than it takes with the constants as they are."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "skeleton.obj"
        environment = {**os.environ, "OMP_NUM_THREADS": "1", **more}
        try:
            done = subprocess.run([str(program), str(mesh), "--skeleton", str(out)], env=environment,
                                  capture_output=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return None
        return shape_of(out) if done.returncode == 0 and out.is_file() else None


def table(constants: list[Constant], changes: dict[str, tuple[list[str], list[str]]], shapes: list[str],
          factor: float) -> str:
    lines = [f"Shapes: {', '.join(shapes)}. Factor {factor:g}. `n`: the number of tips changed on n shapes; "
             "c: cycles changed on some; !: a run failed or took ten times as long.", "",
             f"| constant | value | meaning | / {factor:g} | x {factor:g} |", "|---|---|---|---|---|"]

    def shown(kinds: list[str]) -> str:
        number = sum("t" in kind for kind in kinds)
        return f"{number}" + "c" * any("c" in kind for kind in kinds) + "!" * any("!" in kind for kind in kinds)

    order = sorted(changes, key=lambda name: (-sum(len(kinds) for kinds in changes[name]), name))
    by_name = {constant.name: constant for constant in constants}
    quiet = [name for name in order if not any(changes[name])]
    for name in order:
        if name in quiet:
            continue
        constant = by_name[name]
        less, more = changes[name]
        meaning = constant.meaning.replace("|", "\\|")
        lines.append(f"| `{name}` | {constant.value} | {meaning} | {shown(less)} | {shown(more)} |")
    lines += ["", f"No tip and no cycle of any shape depends on these {len(quiet)}:", "", "| header | constants |",
              "|---|---|"]
    of_header: dict[str, list[str]] = {}
    for name in sorted(quiet):
        header, _, constant = name.partition(":")
        of_header.setdefault(header, []).append(f"`{constant}` {by_name[name].value}")
    lines += [f"| `{header}` | {', '.join(of_header[header])} |" for header in of_header]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("meshes", nargs="+", type=Path, metavar="MESH")
    parser.add_argument("--vcg", required=True, type=Path, help="folder of vcglib")
    parser.add_argument("--factor", type=float, default=1.3)
    parser.add_argument("--only", default="", help="a regular expression for the names, FILE:NAME")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--write", action="store_true", help="into docs/design.md; else it is printed")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program, constants = build(Path(folder), arguments.vcg, arguments.jobs)
        log = Path(folder) / "log"
        expected, used = {}, set()
        for mesh in arguments.meshes:
            log.write_text("")
            expected[mesh] = run(program, mesh, {"MCFSKEL_CONSTANTS_LOG": str(log)}, 600)
            if expected[mesh] is None:
                sys.exit(f"{mesh}: no skeleton")
            used |= set(log.read_text().split())
        names = [c.name for c in constants if c.name in used and re.search(arguments.only, c.name)]
        print(f"{len(constants)} constants, {len(used)} of them used on these shapes", file=sys.stderr)

        def kinds(name: str, factor: float) -> list[str]:
            found = []
            for mesh in arguments.meshes:
                now = run(program, mesh, {"MCFSKEL_CONSTANT": name, "MCFSKEL_FACTOR": repr(factor)}, 60)
                if now is None:
                    found.append("!")
                elif now != expected[mesh]:
                    found.append("t" * (now.tips != expected[mesh].tips) + "c" * (now.cycles != expected[mesh].cycles))
            return found

        with ThreadPoolExecutor(arguments.jobs) as pool:
            less = pool.map(lambda name: kinds(name, 1 / arguments.factor), names)
            more = pool.map(lambda name: kinds(name, arguments.factor), names)
            changes = dict(zip(names, zip(less, more)))
    text = table(constants, changes, [mesh.stem for mesh in arguments.meshes], arguments.factor)
    if not arguments.write:
        print(text)
        return
    page = ROOT / "docs" / "design.md"
    before, rest = page.read_text().split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    page.write_text(f"{before}{MARKS[0]}\n\n{text}\n\n{MARKS[1]}{after}")


if __name__ == "__main__":
    main()
