# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a program's own reader finds in a file, as JSON: run by test_losses.py and test_blender.py with another Python,
which has these programs (scripts/requirements-readers.txt). usage: other_readers.py PROGRAM FILE"""

import json
import sys
from typing import Any


def by_vtk(file: str) -> dict[str, Any]:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPolyDataReader() if file.endswith(".vtp") else vtk.vtkPLYReader()
    reader.SetFileName(file)
    reader.Update()
    data = reader.GetOutput()
    edges = []
    for i in range(data.GetNumberOfCells()):
        ids = [data.GetCell(i).GetPointId(k) for k in range(data.GetCell(i).GetNumberOfPoints())]
        edges += zip(ids[:-1], ids[1:])
    found = {"nodes": vtk_to_numpy(data.GetPoints().GetData()).tolist(), "edges": edges}
    radius = data.GetPointData().GetArray("MaximumInscribedSphereRadius")
    sources = data.GetFieldData().GetArray("mcfskel_node")
    if radius:
        found["radius"] = vtk_to_numpy(radius).tolist()
    if sources:
        found["sources"] = int((vtk_to_numpy(sources) >= 0).sum())
    return found


def by_navis(file: str) -> dict[str, Any]:
    import navis

    nodes = navis.read_swc(file).nodes
    row = {number: i for i, number in enumerate(nodes.node_id)}
    return {"nodes": nodes[["x", "y", "z"]].to_numpy(float).tolist(), "radius": nodes.radius.astype(float).tolist(),
            "edges": [(row[a], row[b]) for a, b in zip(nodes.node_id, nodes.parent_id) if b >= 0]}


def by_meshio(file: str) -> dict[str, Any]:
    import meshio

    mesh = meshio.read(file)
    lines = [pair for block in mesh.cells if block.type == "line" for pair in block.data.tolist()]
    return {"nodes": mesh.points.tolist(), "edges": lines}


def by_blender(file: str) -> dict[str, Any]:
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    if file.endswith(".ply"):
        bpy.ops.wm.ply_import(filepath=file, forward_axis="Y", up_axis="Z")
    elif file.endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=file, forward_axis="Y", up_axis="Z")
    else:
        bpy.ops.import_scene.gltf(filepath=file)
    # Beside the surface of a .glb there is the shape that bones are drawn with.
    mesh = max((thing.data for thing in bpy.data.objects if thing.type == "MESH"), key=lambda data: len(data.vertices))
    found = {"nodes": [list(v.co) for v in mesh.vertices], "edges": [list(e.vertices) for e in mesh.edges],
             "attributes": list(mesh.attributes.keys())}
    for name in ("mcfskel_radius", "quality"):
        if name in mesh.attributes:
            found["radius"] = [value.value for value in mesh.attributes[name].data]
            break
    return found


def pose_in_blender(file: str) -> dict[str, Any]:
    """Opens a .glb, bends its armature and tells how each vertex moves."""
    import bpy
    import mathutils

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    armature = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
    surface = max((t for t in bpy.data.objects if t.type == "MESH" and t.vertex_groups),
                  key=lambda thing: len(thing.data.vertices))

    def places() -> list[list[float]]:
        shown = surface.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return [list(surface.matrix_world @ v.co) for v in shown.data.vertices]

    rest = places()
    bones = armature.pose.bones
    root = next(bone for bone in bones if bone.parent is None)
    root.location = (0, 0, 0)
    answer = {"rest": rest, "faces": [list(p.vertices) for p in surface.data.polygons],
              "bones": [[list(armature.matrix_world @ b.head), b.parent.name if b.parent else None, b.name]
                        for b in bones],
              "weights": [sum(g.weight for g in v.groups) for v in surface.data.vertices],
              "roots": sum(bone.parent is None for bone in bones)}
    # All that hangs on the root moves with it.
    root.matrix = mathutils.Matrix.Translation((0.5, 0.25, 0.125)) @ root.matrix
    bpy.context.view_layer.update()
    answer["moved"] = places()
    root.matrix_basis = mathutils.Matrix.Identity(4)
    # A bend within a limb is turned: of those the one with the most below it.
    tip = max((b for b in bones if b.parent and len(b.parent.children) == 1 and b.children),
              key=lambda bone: len(bone.children_recursive))
    tip.rotation_mode = "XYZ"
    tip.rotation_euler = (0.6, 0, 0)
    bpy.context.view_layer.update()
    answer["bent"], answer["turned"] = places(), tip.name
    return answer


READERS = {"VTK": by_vtk, "navis": by_navis, "meshio": by_meshio, "Blender": by_blender, "pose": pose_in_blender}

if __name__ == "__main__":
    try:
        result = READERS[sys.argv[1]](sys.argv[2])
    except (Exception, SystemExit) as error:  # meshio ends the program
        result = {"error": f"{type(error).__name__}: {error}"}
    print("\nANSWER" + json.dumps(result))
