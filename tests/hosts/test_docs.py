# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples and promises of the README hold."""

import re
import subprocess
import sys
from pathlib import Path

import pymeshlab
import pytest

from conftest import ROOT

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
