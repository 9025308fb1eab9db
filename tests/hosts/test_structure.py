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
