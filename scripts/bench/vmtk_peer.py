#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""VMTK's network extraction on a mesh, written as .vtp: MESH SKELETON.vtp. Needs scripts/requirements-vmtk.txt.

VMTK wants an opening: the triangles around the vertex of the largest x are left out.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np
import trimesh
import vtk
from vmtk import vtkvmtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def surface_of(mesh: trimesh.Trimesh) -> vtk.vtkPolyData:
    apex = int(mesh.vertices[:, 0].argmax())
    faces = np.asarray(mesh.faces)[~(mesh.faces == apex).any(axis=1)]
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetData(numpy_to_vtk(np.asarray(mesh.vertices, float), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel().astype(np.int64), deep=True))
    surface, clean = vtk.vtkPolyData(), vtk.vtkCleanPolyData()
    surface.SetPoints(points)
    surface.SetPolys(cells)
    clean.SetInputData(surface)
    clean.Update()
    return clean.GetOutput()


def main() -> None:
    surface = surface_of(trimesh.load(sys.argv[1], process=False, force="mesh"))
    start = time.process_time()
    network = vtkvmtk.vtkvmtkPolyDataNetworkExtraction()
    network.SetInputData(surface)
    network.SetAdvancementRatio(1.05)
    network.SetRadiusArrayName("Radius")
    network.SetTopologyArrayName("Topology")
    network.SetMarksArrayName("Marks")
    network.Update()
    seconds = time.process_time() - start
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(sys.argv[2])
    writer.SetInputData(network.GetOutput())
    writer.Write()
    print(json.dumps({"seconds": {"skeleton": {"cpu": seconds}}}))


if __name__ == "__main__":
    main()
