# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples and promises of the README hold; the pages in docs/ explain all there is."""

import ctypes
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pymeshlab
import pytest

from conftest import FULL, ROOT

README = (ROOT / "README.md").read_text()
EXAMPLES = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES)
def test_python_example_runs(example: str, plugin: Path):
    script = example.replace('"PLUGIN"', repr(str(plugin))) + (
        "\nassert len(edges) == len(nodes) - 1  # a tree"
        "\nassert len(radius) == len(nodes)"
        "\nassert node_of_vertex.min() >= 0 and node_of_vertex.max() < len(nodes)\n")
    run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True,
                         timeout=600)
    assert run.returncode == 0, run.stderr


def test_filters_of_the_table_exist():
    named = set(re.findall(r"^\| `(\w+)` \|", README, re.MULTILINE))
    assert len(named) >= 5
    assert named <= set(pymeshlab.filter_list())


@pytest.mark.parametrize("link", re.findall(r"\]\((?!http)([^)#]+)\)", README))
def test_links_lead_somewhere(link: str):
    assert (ROOT / link).exists()


class Parameter(NamedTuple):
    filter: str
    name: str
    default: str


def sections() -> dict[str, str]:
    """For each filter the section whose heading names it, with what its page says of all filters."""
    found: dict[str, str] = {}
    for page in sorted((ROOT / "docs").glob("*.md")):
        common, *parts = re.split(r"^## ", page.read_text(), flags=re.MULTILINE)
        for section in parts:
            heading = section.splitlines()[0]
            for name in re.findall(r"`(\w+_mcf)`", heading):
                assert name not in found, f"{name} has two sections"
                found[name] = section + common
    return found


def filters() -> list[str]:
    return [name for name in pymeshlab.filter_list() if name.endswith("_mcf")]


def parameters(capfd: pytest.CaptureFixture[str]) -> list[Parameter]:
    """Every parameter of the plugin, as pymeshlab lists it."""
    def flush() -> None:
        ctypes.CDLL(None).fflush(None)  # pymeshlab prints into C's buffer, which capfd does not know

    found = []
    for name in filters():
        flush()
        capfd.readouterr()
        pymeshlab.print_filter_parameter_list(name)
        flush()
        for line in capfd.readouterr().out.splitlines():
            if match := re.match(r"\s+(\w+) : \w+ = (.*)", line):
                found.append(Parameter(name, match[1], match[2].strip("'")))
    return found


def test_every_filter_has_its_section():
    assert len(filters()) >= 15
    assert set(sections()) == set(filters())


def test_every_filter_is_shown():
    for page in (ROOT / "docs").glob("*.md"):
        for section in re.split(r"^## ", page.read_text(), flags=re.MULTILINE)[1:]:
            heading = section.splitlines()[0]
            assert "_mcf`" not in heading or "![" in section, heading


@pytest.mark.parametrize("words", ["centerline", "centreline", "medial axis", "curve skeleton",
                                   "thinning", "skeletonize"])
def test_the_search_finds_it(words: str, capfd: pytest.CaptureFixture[str]):
    pymeshlab.search(words)
    found = re.findall(r"#(\w+)$", "\n".join(capfd.readouterr()), re.MULTILINE)
    assert FULL in found


def test_every_parameter_is_explained(capfd: pytest.CaptureFixture[str]):
    listed = parameters(capfd)
    assert len(listed) >= 40
    explained = sections()
    silent = [f"{p.filter}: {p.name}" for p in listed
              if not re.search(rf"[`(\s]{p.name}[`=]", explained[p.filter])]
    assert not silent


def test_defaults_are_what_the_tables_say(capfd: pytest.CaptureFixture[str]):
    def number(text: str) -> float | str:
        text = {"true": "1", "false": "0"}.get(text.lower(), text).rstrip("%").strip()
        return float(text) if re.fullmatch(r"-?[\d.]+", text) else text

    listed = {(p.filter, p.name): p.default for p in parameters(capfd)}
    compared = 0
    for name, section in sections().items():
        for parameter, default in re.findall(r"^\| `(\w+)` \| ([^|`]+) \|", section, re.MULTILINE):
            if (name, parameter) in listed:
                assert number(default) == number(listed[name, parameter]), f"{name}: {parameter}"
                compared += 1
    assert compared >= 15


@pytest.mark.parametrize("page", sorted((ROOT / "docs").rglob("*.md")), ids=lambda path: path.name)
def test_pages_lead_somewhere(page: Path):
    for link in re.findall(r"\]\((?!http)([^)]+)\)", page.read_text()):
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        assert target.exists(), link
        if anchor:
            headings = re.findall(r"^#+ (.*)", target.read_text(), re.MULTILINE)
            assert anchor in {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}, link


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "python" / "README.md",
                                  *sorted((ROOT / "docs").rglob("*.md"))], ids=lambda path: path.name)
def test_pip_comes_after_a_virtual_environment(page: Path):
    """Debian 12's own Python refuses what pip would install."""
    lines = re.findall(r"^(?:    |\t)?((?:pip|apt-get) install|python3 -m venv)\b.*$", page.read_text(), re.MULTILINE)
    if "pip install" in lines:
        before = lines[:lines.index("pip install")]
        assert "python3 -m venv" in before and "apt-get install" in before
    assert "$(which" not in page.read_text()


TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda path: path.name)
def test_what_a_tutorial_does_in_python_works(page: Path, plugin: Path, tmp_path: Path):
    script = "\n".join(re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL))
    if not script:
        return
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    environment = os.environ | {"PYTHONPATH": str(ROOT / "python"), "MCFSKEL_PLUGIN": str(plugin)}
    run = subprocess.run([sys.executable, "-c", script.replace('"PLUGIN"', repr(str(plugin)))], cwd=tmp_path,
                         env=environment, capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stderr


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda path: path.name)
def test_what_a_tutorial_types_exists(page: Path):
    lines = [line.split("#")[0].split() for block in re.findall(r"```\n(.*?)```", page.read_text(), re.DOTALL)
             for line in block.splitlines()]
    for command, *arguments in filter(None, lines):
        if not command.startswith(("scripts/", "examples/")):
            continue
        run = subprocess.run([ROOT / command, "--help"], capture_output=True, text=True)
        assert run.returncode == 0, command
        for option in arguments:
            assert not option.startswith("--") or option in run.stdout, f"{command} {option}"


def test_examples_of_the_page_on_filters_run(plugin: Path):
    page = (ROOT / "docs" / "filters.md").read_text()
    script = "\n".join(re.findall(r"```python\n(.*?)```", page, re.DOTALL))
    script = script.replace('"PLUGIN"', repr(str(plugin))) + (
        "\nassert numbers['components'] == 1 and numbers['cycles'] == 0\n")
    run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True,
                         timeout=600)
    assert run.returncode == 0, run.stderr
