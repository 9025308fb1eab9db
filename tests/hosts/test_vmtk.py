# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""VMTK as the judge of branch_measures() and of .vtp. Its wheels are for Python 3.12 and later, so another
interpreter runs it: the one that MCFSKEL_VMTK_PYTHON names, with the packages vmtk and trimesh."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from conftest import MESHES, ROOT

VMTK = os.environ.get("MCFSKEL_VMTK_PYTHON")
pytestmark = pytest.mark.skipif(not VMTK, reason="MCFSKEL_VMTK_PYTHON names no Python with VMTK")

JUDGE = r"""
import json, sys
import numpy as np, vtk
from vtk.util.numpy_support import vtk_to_numpy
from vmtk import vtkvmtk

def read(reader, name):
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()

lines = read(vtk.vtkXMLPolyDataReader(), sys.argv[1])
geometry = vtkvmtk.vtkvmtkCenterlineGeometry()
geometry.SetInputData(lines)
for name in ("Length", "Curvature", "Torsion", "Tortuosity", "FrenetTangent", "FrenetNormal", "FrenetBinormal"):
    getattr(geometry, f"Set{name}ArrayName")(name)
geometry.SetLineSmoothing(0)
geometry.Update()
out = geometry.GetOutput()
chains = [[out.GetCell(i).GetPointId(k) for k in range(out.GetCell(i).GetNumberOfPoints())]
          for i in range(out.GetNumberOfCells())]
answer = {name: vtk_to_numpy(out.GetCellData().GetArray(name)).tolist() for name in ("Length", "Tortuosity")}
for name in ("Curvature", "Torsion"):
    values = vtk_to_numpy(out.GetPointData().GetArray(name))
    answer[name] = [float(values[chain].mean()) for chain in chains]
if len(sys.argv) > 2:
    cut = vtkvmtk.vtkvmtkPolyDataCenterlineSections()
    cut.SetInputData(read(vtk.vtkPLYReader(), sys.argv[2]))
    cut.SetCenterlines(lines)
    for name in ("Area", "MinSize", "MaxSize", "Shape", "Closed"):
        getattr(cut, f"SetCenterlineSection{name}ArrayName")(name)
    cut.Update()
    for name in ("Area", "MinSize", "MaxSize"):
        values = vtk_to_numpy(cut.GetCenterlines().GetPointData().GetArray(name))
        # Away from junctions and tips.
        answer[name] = [float(values[chain[len(chain) // 4:3 * len(chain) // 4]].mean()) for chain in chains]
print("ANSWER" + json.dumps(answer))
"""


def judged(*files: Path) -> dict[str, list[float]]:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    run = subprocess.run([VMTK, "-c", JUDGE, *map(str, files)], capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout.rpartition("ANSWER")[2])


@pytest.fixture(scope="module")
def mcfskel(plugin):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MCFSKEL_PLUGIN", str(plugin))
        patch.syspath_prepend(str(ROOT / "python"))
        import mcfskel
        yield mcfskel


def test_a_helix(mcfskel, tmp_path):
    u = np.linspace(0, 4 * np.pi, 400)
    nodes = np.column_stack([2 * np.cos(u), 2 * np.sin(u), 0.5 * u])
    helix = mcfskel.Skeleton(nodes, np.stack([np.arange(399), np.arange(1, 400)], 1), np.full(400, 0.3),
                             np.empty(0, int))
    helix.save(tmp_path / "helix.vtp")
    ours, theirs = helix.branch_measures(), judged(tmp_path / "helix.vtp")
    for key in ("length", "tortuosity"):
        assert ours[key] == pytest.approx(theirs[key.title()], rel=1e-6)
    for key in ("curvature", "torsion"):
        assert ours[key] == pytest.approx(theirs[key.title()], rel=0.01)


def test_branches_and_their_sections(mcfskel, tmp_path):
    """Of tubes, whose sections are the same all along, as the two take their means over different parts."""
    skeleton = mcfskel.skeletonize(MESHES / "y_tube.off")
    skeleton.save(tmp_path / "y.vtp")
    layers = pymeshlab.MeshSet()
    layers.add_mesh(pymeshlab.Mesh(*skeleton.surface))
    layers.save_current_mesh(str(tmp_path / "y.ply"))
    ours, theirs = skeleton.branch_measures(), judged(tmp_path / "y.vtp", tmp_path / "y.ply")
    assert ours["length"] == pytest.approx(theirs["Length"], rel=1e-6)
    assert ours["curvature"] == pytest.approx(theirs["Curvature"], rel=0.05)
    for key, name in [("section_area", "Area"), ("section_diameter_min", "MinSize"),
                      ("section_diameter_max", "MaxSize")]:
        assert ours[key] == pytest.approx(theirs[name], rel=0.005), key
