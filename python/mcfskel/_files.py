# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons in files."""

from __future__ import annotations

import json
import os
import shutil
import threading
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import pymeshlab

from ._run import INT_MAX, SkeletonError, SkeletonWarning, absolute, apply, filter_options, open_mesh

if TYPE_CHECKING:
    from ._skeleton import Skeleton

#: What save() writes; the filter Save Skeleton has the same.
WRITTEN = (".swc", ".cg", ".graphml", ".json", ".vtp", ".glb", ".ply")
#: Of these, what load() reads; .glb is an armature, which has no radius.
READ = (".swc", ".cg", ".graphml", ".json", ".vtp", ".ply")
#: The formats that an option of save() is for.
OPTIONS_OF = {"scale": ".swc", "units": ".swc", "soma": ".swc", "bone_tolerance": ".glb"}
COMMENT = "mcfskel skeleton 1"
PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4",
             "uint": "<u4", "float": "<f4", "double": "<f8", "int8": "i1", "uint8": "u1",
             "int16": "<i2", "uint16": "<u2", "int32": "<i4", "uint32": "<u4", "float32": "<f4",
             "float64": "<f8"}
Parts = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def suffix_of(path: Path, known: tuple[str, ...]) -> str:
    """The ending of a file's name, in small letters.

    Raises:
        SkeletonError: It is none of those that are known.
    """
    suffix = path.suffix.lower()
    if suffix not in known:
        raise SkeletonError(f"'{path}' does not end with {', '.join(known[:-1])} or {known[-1]}.")
    return suffix


def path_of(path: Any) -> Path:
    """A path from what the user gave for one.

    Raises:
        SkeletonError: It is neither text nor a path.
    """
    try:
        return Path(path)
    except TypeError:
        raise SkeletonError(f"path={path!r} is no path of a file.") from None


def save(skeleton: Skeleton, path: Path, options: dict[str, Any]) -> None:
    suffix = suffix_of(path, WRITTEN)
    for option, ending in OPTIONS_OF.items():
        if options.get(option) is not None and suffix != ending:
            raise SkeletonError(f"'{path}': {option} is for {ending} only.")
    path = Path(absolute(str(path)))
    if len(skeleton.faces) and suffix == ".ply":
        return write_sheets(skeleton, path)
    if len(skeleton.faces) and not len(skeleton.edges):
        raise SkeletonError(f"'{path}': the skeleton is all sheets, which {suffix} does not hold; .ply does.")
    layers = pymeshlab.MeshSet()
    layer = pymeshlab.Mesh(vertex_matrix=skeleton.nodes, edge_matrix=skeleton.edges.astype(np.int32))
    layer.add_vertex_custom_scalar_attribute(skeleton.radius, "mcfskel_radius")
    if len(skeleton.significance):
        layer.add_vertex_custom_scalar_attribute(skeleton.significance, "mcfskel_significance")
    if len(skeleton.bridges):
        layer.add_vertex_custom_scalar_attribute(middles(skeleton).astype(float), "mcfskel_bridge")
    layers.add_mesh(layer, "skeleton")
    if suffix == ".glb" and (skeleton.surface is None or not len(skeleton.correspondence)):
        raise SkeletonError(f"'{path}': .glb holds the surface, which a skeleton from a file does not "
                            "know.")
    known = layers.filter_parameter_values("save_skeleton_mcf")
    options = filter_options("save()", options, {name: default for name, default in known.items()
                                                 if name not in ("file", "surface")})
    options["file"] = str(path)
    if len(skeleton.correspondence):
        vertices = np.zeros((len(skeleton.correspondence), 3))
        surface = skeleton.surface if suffix == ".glb" else (vertices, np.empty((0, 3), np.int32))
        options["surface"] = add_surface(layers, *surface, skeleton.correspondence)
    try:
        apply(layers, "save_skeleton_mcf", options)
    except SkeletonError:
        if suffix != ".glb" or skeleton._contracted is None:
            raise
        # A mesh that was repaired may not be closed, which .glb needs.
        surface, correspondence = skeleton._contracted
        options["surface"] = add_surface(layers, *surface, correspondence)
        apply(layers, "save_skeleton_mcf", options)
    if len(skeleton.faces):
        _warn(f"{suffix} holds curves only: the {len(skeleton.faces)} triangles of the sheets are "
              f"not in '{path}'; .ply keeps them.")
    if suffix == ".swc" and path.is_file():  # not from a pipe
        with open(path, encoding="utf-8") as lines:
            cuts = [line[2:].strip() for line in lines if line.startswith("# cycle cut")]
        if cuts:
            _warn(f"SWC holds trees only; in '{path}': {'; '.join(cuts)}")


def add_surface(layers: pymeshlab.MeshSet, vertices: np.ndarray, faces: np.ndarray,
                correspondence: np.ndarray) -> int:
    """Adds a surface with its correspondence as a layer, which does not become the current one; returns its id."""
    surface = pymeshlab.Mesh(vertex_matrix=vertices, face_matrix=faces)
    surface.add_vertex_custom_scalar_attribute(correspondence.astype(float), "mcfskel_node")
    layers.add_mesh(surface, "surface", set_as_current=False)
    return layers.mesh_number() - 1


def middles(skeleton: Skeleton) -> np.ndarray:
    """Whether a node is the middle of a bridge, (N,): two edges, both of a bridge."""
    of_bridge = np.bincount(skeleton.edges[skeleton.bridges].ravel(), minlength=len(skeleton.nodes))
    return (of_bridge == 2) & (skeleton.degree == 2)


def _warn(text: str) -> None:
    warnings.warn(text, SkeletonWarning, stacklevel=4)  # where Skeleton.save() is called


def write_sheets(skeleton: Skeleton, path: Path) -> None:
    """The PLY of the filter Save Skeleton, and an element `face` with the triangles of the sheets.

    As the filter does it, a link stays and what it leads to is written, a file keeps its permissions, and a
    read-only one its content.
    """
    vertex = np.zeros(len(skeleton.nodes), [(axis, "<f8") for axis in "xyz"]
                      + [("quality", "<f4"), ("mcfskel_radius", "<f8")])
    for k, axis in enumerate("xyz"):
        vertex[axis] = skeleton.nodes[:, k]
    vertex["quality"] = vertex["mcfskel_radius"] = skeleton.radius
    face = np.zeros(len(skeleton.faces), [("count", "u1"), ("vertex_indices", "<i4", 3)])
    face["count"], face["vertex_indices"] = 3, skeleton.faces
    header = ["ply", "format binary_little_endian 1.0", f"comment {COMMENT}"]
    header += [f"element vertex {len(vertex)}", *(f"property double {axis}" for axis in "xyz"),
               "property float quality", "property double mcfskel_radius",
               f"element face {len(face)}", "property list uchar int vertex_indices",
               f"element edge {len(skeleton.edges)}", "property int vertex1", "property int vertex2",
               f"element mcfskel_surface {len(skeleton.correspondence)}", "property int node",
               "end_header"]
    content = b"".join(["\n".join(header).encode() + b"\n", vertex.tobytes(), face.tobytes(),
                        skeleton.edges.astype("<i4").tobytes(),
                        skeleton.correspondence.astype("<i4").tobytes()])
    try:
        _replace(Path(os.path.realpath(path)), content)
    except OSError as error:
        raise SkeletonError(f"Cannot write '{path}': {error.strerror}") from None


def _replace(path: Path, content: bytes) -> None:
    if path.exists() and not path.is_file():  # a pipe, or a folder, of which the error tells
        path.write_bytes(content)
        return
    part = path.with_name(f".mcfskel.{os.getpid()}.{threading.get_ident()}")
    try:
        with open(part, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            open(path, "r+b").close()  # os.replace() would replace even a read-only file
            shutil.copymode(path, part)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def load(path: Path) -> Parts:
    """Nodes, edges, radius, correspondence, faces, significance and bridges from a file."""
    suffix = suffix_of(path, READ)
    full = Path(absolute(str(path)))
    if suffix in (".swc", ".cg"):
        layer = (layers := open_mesh(str(path))).current_mesh()
        radius = np.zeros(layer.vertex_number())
        if layer.has_vertex_scalar():
            radius = layer.vertex_custom_scalar_attribute_array("mcfskel_radius")
        parts = (layer.vertex_matrix(), layer.edge_matrix(), radius, [], [], [], [])
        del layers
        return checked(path, *parts)
    readers = {".json": read_json, ".graphml": read_graphml, ".vtp": read_vtp, ".ply": read_ply}
    try:
        return checked(path, *readers[suffix](full))
    except OSError as error:
        raise SkeletonError(f"Cannot read '{path}': {error.strerror}") from None
    except SkeletonError:
        raise
    except KeyError as error:
        raise SkeletonError(f"'{path}' cannot be read: {error.args[0]!r} is missing.") from None
    except (IndexError, OverflowError):
        raise SkeletonError(f"'{path}' cannot be read: it is cut short, or a number is out of range.") from None
    except (ValueError, TypeError, AttributeError, RecursionError, ElementTree.ParseError) as error:
        raise SkeletonError(f"'{path}' cannot be read: {str(error).rstrip('.')}.") from None


def checked(path: Path, nodes: Any, edges: Any, radius: Any, correspondence: Any, faces: Any,
            significance: Any, middle: Any) -> Parts:
    """The arrays of a skeleton, each as it has to be."""
    def fail(what: str) -> None:
        raise SkeletonError(f"'{path}' cannot be read: {what}.")

    nodes = np.asarray(nodes, float).reshape(-1, 3)
    radius = np.asarray(radius, float)
    edges = np.asarray(edges, np.int64).reshape(-1, 2)
    faces = np.asarray(faces, np.int64).reshape(-1, 3)
    correspondence = np.asarray(correspondence, np.int64)
    significance = np.asarray(significance, float)
    middle = np.asarray(middle, bool)
    if not len(nodes):
        fail("it has no nodes")
    for name, values in [("radius", radius), ("significance", significance),
                         ("correspondence", correspondence), ("mark of bridges", middle)]:
        if values.ndim != 1:
            fail(f"the {name} of a node is more than one number")
    if len(radius) != len(nodes):
        fail(f"there are {len(nodes)} nodes, but {len(radius)} have a radius")
    if not np.isfinite(nodes).all():
        fail(f"node {int(np.argmin(np.isfinite(nodes).all(axis=1)))} is not finite")
    if not (np.isfinite(radius) & (radius >= 0)).all():
        fail(f"the radius of node {int(np.argmin(np.isfinite(radius) & (radius >= 0)))} cannot be")
    if len(significance) not in (0, len(nodes)) or not ((significance >= 0) & (significance <= 1)).all():
        fail(f"the significance is not a number from 0 to 1 for each of the {len(nodes)} nodes")
    if len(middle) not in (0, len(nodes)):
        fail(f"of {len(nodes)} nodes, {len(middle)} say whether they are of a bridge")
    for name, ids, lowest in [("an edge", edges, 0), ("a face", faces, 0),
                              ("a surface vertex", correspondence, -1)]:
        if ids.size and (ids.min() < lowest or ids.max() >= len(nodes)):
            fail(f"{name} has a node that does not exist")
    if (edges[:, 0] == edges[:, 1]).any():
        fail("an edge goes from a node to itself")
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    bridges = middle[edges].any(axis=1) if middle.any() else np.empty(0, bool)
    return nodes, edges, radius, correspondence, faces, significance, bridges


def correspondence_of(sources: list[list[int]], count: int | None) -> np.ndarray:
    """For each surface vertex its node, from the surface vertices of each node."""
    if count is not None and not 0 <= count <= INT_MAX:
        raise ValueError(f"there cannot be {count} surface vertices")
    if not any(sources):
        return np.full(count or 0, -1)
    vertices = np.concatenate([np.asarray(ids, np.int64) for ids in sources])
    if vertices.min() < 0 or vertices.max() >= (INT_MAX if count is None else count):
        raise ValueError("a surface vertex does not exist")
    if len(np.unique(vertices)) < len(vertices):
        raise ValueError("a surface vertex belongs to two nodes")
    result = np.full(count if count is not None else int(vertices.max()) + 1, -1)
    result[vertices] = np.repeat(np.arange(len(sources)), [len(ids) for ids in sources])
    return result


def read_json(path: Path) -> tuple:
    graph = json.loads(path.read_text(encoding="utf-8"))
    row = {node["id"]: i for i, node in enumerate(graph["nodes"])}
    links = graph["edges"] if "edges" in graph else graph["links"]
    sources = [node.get("surface_vertices", []) for node in graph["nodes"]]
    return ([node["position"] for node in graph["nodes"]],
            [(row[link["source"]], row[link["target"]]) for link in links],
            [node.get("radius", 0) for node in graph["nodes"]],
            correspondence_of(sources, graph.get("graph", {}).get("surface_vertices")), [],
            [node["significance"] for node in graph["nodes"] if "significance" in node],
            [node["bridge"] for node in graph["nodes"] if "bridge" in node])


def read_graphml(path: Path) -> tuple:
    space = "{http://graphml.graphdrawing.org/xmlns}"
    root = ElementTree.parse(path).getroot()
    graph = root.find(f"{space}graph")
    if graph is None:
        raise ValueError("there is no graph")
    names = {key.get("id"): key.get("attr.name") for key in root.iter(f"{space}key")}

    def values(element: ElementTree.Element) -> dict[str, str]:
        return {names.get(data.get("key")) or "": data.text or ""
                for data in element.findall(f"{space}data")}

    nodes = graph.findall(f"{space}node")
    of_node = [values(node) for node in nodes]
    row = {node.get("id"): i for i, node in enumerate(nodes)}
    count = values(graph).get("surface_vertices")
    sources = [[int(text) for text in node.get("surface_vertices", "").split()] for node in of_node]
    return ([[float(node[axis]) for axis in "xyz"] for node in of_node],
            [(row[edge.get("source")], row[edge.get("target")])
             for edge in graph.findall(f"{space}edge")],
            [float(node.get("radius", 0)) for node in of_node],
            correspondence_of(sources, None if count is None else int(count)), [],
            [float(node["significance"]) for node in of_node if "significance" in node],
            [int(node["bridge"]) for node in of_node if "bridge" in node])


def read_vtp(path: Path) -> tuple:
    """Of the many forms of .vtp the one that the filter Save Skeleton writes: arrays as text."""
    data = ElementTree.parse(path).getroot().find("PolyData")
    if data is None:
        raise ValueError("it is no PolyData of VTK")

    def numbers(place: str, kind: type, name: str | None = None) -> np.ndarray:
        for array in data.findall(f"{place}/DataArray"):
            if name in (None, array.get("Name")):
                if array.get("format") != "ascii":
                    raise ValueError("its arrays are not written as text (format=\"ascii\")")
                return np.array((array.text or "").split(), kind)
        return np.empty(0, kind)

    nodes = numbers("Piece/Points", float).reshape(-1, 3)
    chain = numbers("Piece/Lines", np.int64, "connectivity")
    ends = numbers("Piece/Lines", np.int64, "offsets")
    inner = np.ones(max(len(chain) - 1, 0), bool)
    inner[ends[:-1] - 1] = False  # from the last point of a line to the first of the next
    radius = numbers("Piece/PointData", float, "MaximumInscribedSphereRadius")
    return (nodes, np.column_stack([chain[:-1], chain[1:]])[inner],
            radius if len(radius) else np.zeros(len(nodes)),
            numbers("FieldData", np.int64, "mcfskel_node"), [],
            numbers("Piece/PointData", float, "mcfskel_significance"),
            numbers("Piece/PointData", np.int64, "mcfskel_bridge"))


def read_ply(path: Path) -> tuple:
    content = path.read_bytes()
    end = content.find(b"end_header\n")
    header = content[:max(end, 0)].decode("ascii", "replace").splitlines()
    if not header or header[0] != "ply" or f"comment {COMMENT}" not in header:
        raise ValueError("it is no PLY file of a skeleton")
    if "format binary_little_endian 1.0" not in header:
        raise ValueError("its PLY is not binary_little_endian")
    at = end + len(b"end_header\n")
    tables = {}
    fields: list[tuple] = []
    layout = []
    for words in (line.split() for line in header):
        if words[0] == "element":
            fields = []
            layout.append((words[1], int(words[2]), fields))
        elif words[0] == "property" and words[1] == "list":
            fields += [(f"count {words[4]}", PLY_TYPES[words[2]]), (words[4], PLY_TYPES[words[3]], 3)]
        elif words[0] == "property":
            fields.append((words[2], PLY_TYPES[words[1]]))
    for name, count, fields in layout:
        kind = np.dtype(fields)
        if count < 0 or len(content) - at < count * kind.itemsize:
            raise ValueError(f"it ends within its element '{name}'")
        tables[name] = np.frombuffer(content, kind, count, at)
        at += count * kind.itemsize
        for field in kind.names or ():
            if field.startswith("count ") and (tables[name][field] != 3).any():
                raise ValueError(f"element '{name}' has a list that is not of three")
    if at != len(content):
        raise ValueError("there is more after its last element")
    vertex, edge = tables["vertex"], tables["edge"]
    known = vertex.dtype.names or ()
    radius = vertex["mcfskel_radius"] if "mcfskel_radius" in known else np.zeros(len(vertex))
    return (np.column_stack([vertex[axis] for axis in "xyz"]),
            np.column_stack([edge["vertex1"], edge["vertex2"]]), radius,
            tables["mcfskel_surface"]["node"] if "mcfskel_surface" in tables else [],
            tables["face"]["vertex_indices"] if "face" in tables else [],
            vertex["mcfskel_significance"] if "mcfskel_significance" in known else [],
            vertex["mcfskel_bridge"] if "mcfskel_bridge" in known else [])
