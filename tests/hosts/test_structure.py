# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The order of the library's folders, what programs may include of it, and the workflows."""

import re
import subprocess
from pathlib import Path

import pytest
import yaml

from conftest import ROOT

LIBRARY = ROOT / "vcg_ext" / "skeleton"
# Bottom to top, as drawn in the library's README.md: a folder may include what stands before it.
ORDER = ["core", "mesh", "spatial", "graph", "input", "repair", "poles", "resample", "solver", "flow", "collapse",
         "sheets", "refine", "measure", "io"]
INCLUDE = re.compile(r'^#include [<"](?:skeleton/)?([\w/.]+\.h)[>"]', re.M)


def sources(folder: Path) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp"))


def test_every_folder_has_its_place_and_its_sentence() -> None:
    folders = {p.name for p in LIBRARY.iterdir() if p.is_dir()}
    assert folders == set(ORDER)
    text = (LIBRARY / "README.md").read_text()
    assert re.findall(r"^\| `(\w+)` \|", text, re.M) == ORDER


@pytest.mark.parametrize("folder", ORDER)
def test_a_folder_includes_only_what_is_below_it(folder: str) -> None:
    below = ORDER[:ORDER.index(folder)]
    for header in sources(LIBRARY / folder):
        for name in INCLUDE.findall(header.read_text()):
            own = LIBRARY / folder / name
            if own.is_file():
                continue
            place = Path(name).parts
            if not (LIBRARY / name).is_file():
                continue  # of another library
            assert len(place) == 2 and place[0] in below, f"{header.relative_to(LIBRARY)} includes {name}"


@pytest.mark.parametrize("program", ["filter_mcfskel", "examples/cpp"])
def test_programs_include_public_headers_only(program: str) -> None:
    seen = 0
    for source in sources(ROOT / program):
        for name in re.findall(r"#include [<\"]skeleton/([\w/.]+)[>\"]", source.read_text()):
            assert "/" not in name, f"{source.relative_to(ROOT)} includes {name}"
            assert (LIBRARY / name).is_file()
            seen += 1
    assert seen > 0


def test_no_two_files_share_a_name_between_plugin_and_library() -> None:
    of_library = {p.stem for p in sources(LIBRARY)}
    of_plugin = {p.stem for p in sources(ROOT / "filter_mcfskel")}
    assert not of_library & of_plugin


def test_each_filter_is_where_contributing_says() -> None:
    plugin = ROOT / "filter_mcfskel"
    listed, catalogue = (plugin / "filters" / "all_filters.h").read_text(), (plugin / "filters.cpp").read_text()
    built, names = (plugin / "CMakeLists.txt").read_text(), (ROOT / "tests" / "filter_names.py").read_text()
    pages = "".join(p.read_text() for p in (ROOT / "docs").glob("*.md"))
    files = sorted((plugin / "filters").glob("*_filter.cpp"))
    assert len(files) >= 18
    for file in files:
        text = file.read_text()
        functions = [f for f in re.findall(r"^FilterSpec (\w+)\(\)", text, re.M)]
        assert len(functions) == 1, file.name
        assert f"FilterSpec {functions[0]}();" in listed and f"{functions[0]}()," in catalogue, functions[0]
        assert f"filters/{file.name}" in built
        python_name = re.search(r'"(\w+_mcf)"', text)
        assert python_name and python_name[1] in names and f"`{python_name[1]}`" in pages, file.name


def test_each_header_has_a_unit_test_of_its_name_or_a_reason() -> None:
    unit = ROOT / "tests" / "unit"
    named = {p.stem.removeprefix("test_") for p in unit.rglob("test_*.cpp")}
    without = {str(p.relative_to(LIBRARY)) for p in LIBRARY.rglob("*.h") if p.stem not in named}
    rows = re.findall(r"^\| `([\w/]+\.h)` \| (.+?) \| (.+?) \|$", (unit / "README.md").read_text(), re.M)
    assert {header for header, _, _ in rows} == without
    for header, tests, _ in rows:
        for test in re.findall(r"`([\w/]+\.cpp)`", tests):
            assert (unit / test).is_file(), f"{header}: {test}"


def test_every_unit_test_is_built() -> None:
    listed = re.findall(r"\bunit/[\w/]+\.cpp", (ROOT / "tests" / "CMakeLists.txt").read_text())
    there = [str(p.relative_to(ROOT / "tests")) for p in (ROOT / "tests" / "unit").rglob("test_*.cpp")]
    assert sorted(listed) == sorted(there)


def calls(arguments: str) -> set[str]:
    """The types with which a function of these arguments can be called; the last may have defaults."""
    types = [re.sub(r"\s*\w+$", "", re.sub(r"\s+", " ", argument.partition("=")[0]).strip())
             for argument in arguments.split(",")]
    needed = sum("=" not in argument for argument in arguments.split(",")) if arguments else 0
    return {",".join(types[:count]) for count in range(needed, len(types) + 1)}


def test_no_two_unit_tests_have_the_same_function() -> None:
    # They are compiled many in one, and which ones changes with each test that is added.
    function = re.compile(r"^(?!TEST)[\w:<>,*& ]+?[*& ](\w+)\(([^;{}]*)\)(?: const)?\n\{", re.M)
    of_call: dict[tuple[str, str], set[str]] = {}
    for test in (ROOT / "tests" / "unit").rglob("test_*.cpp"):
        for name, arguments in function.findall(test.read_text()):
            for types in calls(arguments):
                of_call.setdefault((name, types), set()).add(test.name)
    assert len(of_call) > 200
    del of_call["coarse", ""]  # one is a template: another function
    assert not {call: tests for call, tests in of_call.items() if len(tests) > 1}


@pytest.mark.parametrize("workflow", sorted((ROOT / ".github" / "workflows").glob("*.yml")), ids=lambda p: p.name)
def test_workflows_can_be_read_and_call_scripts_that_are_there(workflow: Path) -> None:
    jobs = yaml.safe_load(workflow.read_text())["jobs"]
    names = set(jobs)
    commands = []
    for job in jobs.values():
        needs = job.get("needs", [])
        assert set([needs] if isinstance(needs, str) else needs) <= names
        for step in job["steps"]:
            assert ("run" in step) != ("uses" in step), step
            commands.append(str(step.get("run", "")))
    for command in commands:
        checked = subprocess.run(["bash", "-n", "-c", re.sub(r"\$\{\{.*?\}\}", "x", command)], capture_output=True)
        assert checked.returncode == 0, command
        for script in re.findall(r"(?:scripts|\.ci)/[\w./-]+", command):
            assert (ROOT / script).is_file(), script
    assert any("scripts/wheel.sh" in command for command in commands)
