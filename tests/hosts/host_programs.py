# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The other programs that load the plugin; scripts/test.sh sets them up and says where they are.
Scripts for them, and what they leave."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "gui"))
from display import display  # noqa: E402

PREFIX = "Mean Curvature Skeleton: "
SCRIPTS = {path.stem: path for path in (ROOT / "examples").glob("*.mlx")}
Server = Callable[..., subprocess.CompletedProcess]


@dataclass(frozen=True)
class Host:
    """A program that loads the plugin."""

    name: str
    #: The programs are in its bin/.
    folder: Path
    #: The plugin built for it.
    plugin: Path


def host(name: str) -> Host:
    """A host by its name in scripts/build.sh; skips the test where it was not set up."""
    variable = name.upper().replace("-", "_").replace(".", "_")
    folder, plugin = (os.environ.get(f"MCFSKEL_{what}_{variable}") for what in ("HOST", "PLUGIN"))
    if not folder or not plugin:
        pytest.skip(f"host {name} is not set up")
    return Host(name, Path(folder), Path(plugin))


@contextmanager
def meshlabserver(home: Path) -> Iterator[Server]:
    """A function that runs meshlabserver on a mesh and a script; its log is the output."""
    program = host("meshlab-2020.09")
    with display() as name:
        environment = os.environ | {"DISPLAY": name, "LIBGL_ALWAYS_SOFTWARE": "1"}

        def run(mesh: Path, script: Path, *outputs: object) -> subprocess.CompletedProcess:
            return subprocess.run(
                [program.folder / "bin/meshlabserver", "-i", mesh, "-s", script, *map(str, outputs)],
                env=environment | {"HOME": str(home)}, cwd=home, timeout=300,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        yield run


def changed(script: str, folder: Path, repeat: dict[str, int] | None = None, **values: object) -> Path:
    """A script of examples/ with other values, and with filters repeated or (0) left out."""
    tree = ElementTree.parse(SCRIPTS[script])
    for element in list(tree.getroot()):
        for parameter in element:
            if parameter.get("name") in values:
                parameter.set("value", str(values[parameter.get("name")]))
        count = (repeat or {}).get(element.get("name", "").removeprefix(PREFIX), 1)
        place = list(tree.getroot()).index(element)
        tree.getroot().remove(element)
        for _ in range(count):
            tree.getroot().insert(place, element)
    path = folder / f"{script}_{len(list(folder.glob('*.mlx')))}.mlx"
    tree.write(path)
    return path


def obj_graph(path: Path, line: str = "l") -> tuple[np.ndarray, np.ndarray]:
    """Nodes and edges of an OBJ file; of a .cg file, where edges are lines that begin with e."""
    rows = [row.split() for row in path.read_text().splitlines()]
    nodes = np.array([row[1:4] for row in rows if row[:1] == ["v"]], float)
    edges = np.array([row[1:3] for row in rows if row[:1] == [line]], int) - 1
    return nodes, edges


def ply_vertices(path: Path) -> np.ndarray:
    """The vertices of a PLY file, a column for each property."""
    from plyfile import PlyData
    return PlyData.read(str(path))["vertex"].data
