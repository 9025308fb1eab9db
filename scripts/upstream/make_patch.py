#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The plugin as a folder of MeshLab's own tree, as a patch in the form of `git diff`.

What is there for other hosts and releases goes: the adapters but one, and every `#if` on a macro of this
project whose value is known. Of the library goes what the chosen filters do not include.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLUGIN = ROOT / "filter_mcfskel"
PLACE = "meshlabplugins/filter_mcfskel"
FIRST_FILTERS = ["resample", "medial_poles", "contraction_step", "collapse_to_curve", "full_skeletonize"]
MACROS = {"MCFSKEL_HOST_API": 2021, "MCFSKEL_RENAMED_PARAMETERS": 1, "MCFSKEL_PYTHON_HOST": 0,
          "MCFSKEL_IN_MESHLAB": 1, "MCFSKEL_FILES": 1, "MCFSKEL_SHEETS": 1}
ADAPTER = {PLUGIN / f"adapters/meshlab_2021.{s}": f"filter_mcfskel.{s}" for s in ("h", "cpp")}
TRANSLATE = {PLUGIN / f"adapters/translate.{s}": f"translate.{s}" for s in ("h", "cpp")}
INCLUDE = re.compile(r'^(#include\s+)(?:"([^"]+)"|<(skeleton/[^>]+)>)', re.M)


def resolved(text: str, macros: dict[str, int]) -> str:
    """The text without the branches that the macros' values leave out. Other conditions stay."""
    lines: list[str] = []
    # Of each open #if: is it one of ours, has a branch been taken, is this branch kept.
    stack: list[tuple[bool, bool, bool]] = []
    name = re.compile("|".join(macros))

    def value(condition: str) -> bool:
        python = name.sub(lambda m: str(macros[m[0]]), condition)
        python = python.replace("&&", " and ").replace("||", " or ")
        return bool(eval(re.sub(r"!(?!=)", " not ", python), {"__builtins__": {}}))  # noqa: S307

    for line in text.splitlines():
        directive = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b\s*(.*)", line)
        if directive:
            kind, condition = directive[1], directive[2]
            if kind in ("if", "ifdef", "ifndef"):
                ours = kind == "if" and bool(name.search(condition))
                kept = value(condition) if ours else True
                stack.append((ours, kept, kept))
            elif kind == "endif":
                ours = stack.pop()[0]
            else:
                ours, taken, kept = stack[-1]
                if ours:
                    kept = not taken and (kind == "else" or value(condition))
                    stack[-1] = (True, taken or kept, kept)
            if ours:
                continue
        if all(kept for _, _, kept in stack):
            lines.append(line)
    return "\n".join(lines) + "\n"


def included(file: Path, text: str) -> list[Path]:
    found = []
    for match in INCLUDE.finditer(text):
        path = (file.parent / match[2]).resolve() if match[2] else ROOT / "vcg_ext" / match[3]
        if path.is_file():
            found.append(path)
    return found


class Tree:
    """The files of the patch, by where they are in the project."""

    def __init__(self, first: bool) -> None:
        self.macros = MACROS | ({"MCFSKEL_FILES": 0, "MCFSKEL_SHEETS": 0} if first else {})
        self.filters = sorted(p.stem.removesuffix("_filter") for p in PLUGIN.glob("filters/*_filter.cpp"))
        if first:
            self.filters = FIRST_FILTERS
        self.functions = {self.function_of(f) for f in self.filters}
        self.text: dict[Path, str] = {}
        roots = [*ADAPTER, *TRANSLATE, *(PLUGIN / f"filters/{f}_filter.cpp" for f in self.filters)]
        while roots:
            file = roots.pop()
            if file in self.text:
                continue
            text = self.without_other_filters(resolved(file.read_text(), self.macros))
            self.text[file] = text
            roots += included(file, text)
            for source in self.sources_of(file):
                roots.append(source)

    @staticmethod
    def function_of(name: str) -> str:
        return re.search(r"^FilterSpec (\w+Filter)\(\)", (PLUGIN / f"filters/{name}_filter.cpp").read_text(), re.M)[1]

    @staticmethod
    def sources_of(header: Path) -> list[Path]:
        """What implements a header of the plugin; layers.h is implemented by several files."""
        if header.suffix != ".h" or PLUGIN not in header.parents:
            return []
        if header.name == "layers.h":
            return sorted(header.parent.glob("*.cpp"))
        if header.name == "files.h":
            return [header.with_suffix(".cpp"), *sorted(header.parent.glob("write_file*.cpp"))]
        source = header.with_suffix(".cpp")
        return [source] if source.is_file() else []

    def without_other_filters(self, text: str) -> str:
        """The catalogue and its header with the filters of the patch alone."""
        kept = []
        for line in text.splitlines():
            entry = re.fullmatch(r"\s*(?:FilterSpec )?(\w+Filter)\(\)[;,]", line)
            if not entry or entry[1] in self.functions or entry[1] not in ALL_FUNCTIONS:
                kept.append(line)
        return "\n".join(kept) + "\n"

    @staticmethod
    def place(file: Path) -> Path:
        """Where a file is in the plugin's folder of MeshLab."""
        renamed = (ADAPTER | TRANSLATE).get(file)
        if renamed:
            return Path(renamed)
        return file.relative_to(PLUGIN if PLUGIN in file.parents else ROOT / "vcg_ext")

    def write(self, folder: Path) -> None:
        for file, text in self.text.items():
            place = self.place(file)

            def moved(match: re.Match[str], file: Path = file, place: Path = place) -> str:
                if not match[2]:
                    return match[0]
                other = (file.parent / match[2]).resolve()
                if other not in self.text:
                    return match[0]
                return f'{match[1]}"{os.path.relpath(self.place(other), place.parent)}"'

            target = folder / place
            target.parent.mkdir(parents=True, exist_ok=True)
            # The name that MeshLab's other plugins would give the class.
            text = INCLUDE.sub(moved, text).replace("MCFSKEL_MESHLAB_2021_H", "MCFSKEL_FILTER_MCFSKEL_H")
            target.write_text(re.sub(r"\n{3,}", "\n\n", text))
        (folder / "CMakeLists.txt").write_text(self.cmake())

    def cmake(self) -> str:
        names = sorted(str(self.place(f)) for f in self.text)

        def variable(suffix: str) -> str:
            return "".join(f"\n\t{n}" for n in names if n.endswith(suffix))

        template = (ROOT / "scripts/upstream/CMakeLists.txt.in").read_text()
        return template.replace("@SOURCES@", variable(".cpp")).replace("@HEADERS@", variable(".h"))


ALL_FUNCTIONS = {Tree.function_of(p.stem.removesuffix("_filter")) for p in PLUGIN.glob("filters/*_filter.cpp")}


def with_plugin_listed(cmake: str) -> str:
    """MeshLab's src/CMakeLists.txt with one more line, in the alphabet's place among the filters."""
    lines = cmake.splitlines(keepends=True)
    filters = [i for i, line in enumerate(lines) if re.match(r"\s*meshlabplugins/filter_\w+\s*$", line)]
    # That list begins with a few that are out of order; the rest goes by the alphabet.
    before = [i for i in filters if "filter_i" < lines[i].split("/")[-1].strip() < PLACE.split("/")[-1]]
    if not before:
        raise SystemExit("error: no list of filters in MeshLab's src/CMakeLists.txt")
    indent = re.match(r"\s*", lines[before[-1]])[0]
    lines.insert(before[-1] + 1, f"{indent}{PLACE}\n")
    return "".join(lines)


def make_patch(meshlab: Path, first: bool, clang_format: str) -> str:
    with tempfile.TemporaryDirectory() as name:
        trees = [Path(name) / side for side in "ab"]
        for tree in trees:
            (tree / "src").mkdir(parents=True)
            shutil.copy(meshlab / "src/CMakeLists.txt", tree / "src")
        new = trees[1] / "src"
        Tree(first).write(new / PLACE)
        listing = new / "CMakeLists.txt"
        listing.write_text(with_plugin_listed(listing.read_text()))
        shutil.copy(meshlab / "src/.clang-format", new)
        files = sorted(str(p) for p in (new / PLACE).rglob("*") if p.suffix in (".h", ".cpp"))
        # The order of the includes stays, as in MeshLab's own files, whatever its .clang-format says.
        subprocess.run([clang_format, "-i", "--sort-includes=0", *files], check=True, cwd=new)
        (new / ".clang-format").unlink()
        diff = subprocess.run(["git", "-c", "core.autocrlf=false", "diff", "--no-index", "--no-prefix", "--no-color",
                               "--no-ext-diff", "a", "b"], cwd=name, text=True, capture_output=True)
        if diff.returncode != 1:
            raise SystemExit(f"error: git diff: {diff.stderr}")
        # Of a new file git takes the name in "b" for both.
        return re.sub(r"^diff --git b/", "diff --git a/", diff.stdout, flags=re.M)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshlab", type=Path, required=True, help="MeshLab's source tree")
    parser.add_argument("--first", action="store_true", help="the smaller patch to begin with")
    parser.add_argument("--clang-format", default="clang-format")
    arguments = parser.parse_args()
    sys.stdout.write(make_patch(arguments.meshlab, arguments.first, arguments.clang_format))


if __name__ == "__main__":
    main()
