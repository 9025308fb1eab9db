# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From a mesh to a skeleton, and from a skeleton to files, graphs and pictures."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pymeshlab

from . import _branches, _convert, _files, _measures, _picture, _plot
from ._run import (INT_MAX, Length, SkeletonError, SkeletonWarning, apply, filter_options,
                   open_mesh)
from ._volumes import VOLUME_FILES, point_triangles, read_volume, volume_of, voxel_surface

if TYPE_CHECKING:
    import navis
    import networkx
    import pyvista
    import trimesh

FILTER = "generate_curve_skeleton_mcf"


class Surface(NamedTuple):
    """A triangle mesh.

    Attributes:
        vertices: Positions, (V, 3).
        faces: Triangles as vertex ids, (F, 3).
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int32]


def _no_faces() -> npt.NDArray[np.int64]:
    return np.empty((0, 3), np.int64)


@dataclass(frozen=True, eq=False, repr=False)
class Skeleton:
    """A curve skeleton: a graph in space, and how the surface belongs to it.

    Attributes:
        nodes: Positions, (N, 3), in the mesh's units.
        edges: Pairs of nodes, (E, 2), lower node first, ascending.
        radius: Local thickness at each node, (N,), in the mesh's units.
        correspondence: For each vertex of the mesh the node that it has merged into, (V,); -1 for a
            vertex of no face, or of a piece that gets no skeleton. Empty if it is not known, as for a skeleton from a .swc file.
        results: The numbers of the filter: iterations, converged, components, cycles, ... Those that
            begin with seconds_ are seconds; skeleton_length is in the mesh's units; those that end
            with _fraction are parts of 1.
        faces: The triangles of the sheets as nodes, (F, 3), if ``keep_sheets`` was set and there are
            any; their sides are not among ``edges``.
        surface: The mesh that the skeleton was made from, for pictures; None after ``load()``.
        significance: How much of the shape the branch of each node stands for, (N,), 0 to 1; those
            with at least 1 - d are the skeleton of the detail d. Empty if it is not known, as for a
            skeleton that is not refined or from a .swc file.
        bridges: Whether an edge is part of a bridge over a gap, (E,), if ``join`` was set and there are
            any; else empty.
    """

    nodes: npt.NDArray[np.float64]
    edges: npt.NDArray[np.int64]
    radius: npt.NDArray[np.float64]
    correspondence: npt.NDArray[np.int64]
    results: dict[str, Any] = field(default_factory=dict)
    faces: npt.NDArray[np.int64] = field(default_factory=_no_faces)
    surface: Surface | None = None
    significance: npt.NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    bridges: npt.NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, bool))
    # Of a mesh that was repaired, the solid that was contracted and its correspondence, for .glb.
    _contracted: tuple[Surface, npt.NDArray[np.int64]] | None = field(default=None, init=False)

    def __repr__(self) -> str:
        counts = [(len(self.nodes), "node"), (len(self.edges), "edge"),
                  (len(self.branches), "branch"), (len(self.faces), "face")]
        texts = [f"{count} {name}{'' if count == 1 else 'es' if name == 'branch' else 's'}"
                 for count, name in counts if count or name != "face"]
        return f"<mcfskel.Skeleton: {', '.join(texts)}, length {self.lengths().sum():.4g}>"

    def _repr_html_(self) -> str:
        """What a notebook shows: the skeleton inside its surface, and the counts."""
        text = repr(self)[1:-1].replace("mcfskel.", "")
        if len(self.radius):
            text += f", radius {self.radius.min():.3g} to {self.radius.max():.3g}"
        return f"<div>{_picture.svg(self)}<br><small>{text}</small></div>"

    @cached_property
    def degree(self) -> npt.NDArray[np.int64]:
        """The number of edges at each node, (N,)."""
        return np.bincount(self.edges.ravel(), minlength=len(self.nodes))

    @property
    def _on_sheet(self) -> npt.NDArray[np.bool_]:
        return np.bincount(self.faces.ravel(), minlength=len(self.nodes)) > 0

    @property
    def leafs(self) -> npt.NDArray[np.int64]:
        """The tips: nodes with one edge, none of them on a sheet."""
        return np.flatnonzero((self.degree == 1) & ~self._on_sheet)

    @property
    def junctions(self) -> npt.NDArray[np.int64]:
        """The nodes with three edges or more."""
        return np.flatnonzero(self.degree >= 3)

    @cached_property
    def branches(self) -> list[npt.NDArray[np.int64]]:
        """The branches as chains of nodes, from tip or junction to tip or junction.

        A cycle without junctions ends with the node that it begins with. They are in the order of the
        node with which they begin, the lower one of their ends.
        """
        return _branches.branches(len(self.nodes), self.edges)

    def surface_vertices(self) -> list[npt.NDArray[np.int64]]:
        """For each node the vertices of the mesh that have merged into it, ascending."""
        order = np.argsort(self.correspondence, kind="stable")
        bounds = np.searchsorted(self.correspondence[order], np.arange(len(self.nodes) + 1))
        return [order[a:b] for a, b in zip(bounds[:-1], bounds[1:])]

    def lengths(self) -> npt.NDArray[np.float64]:
        """The length of each edge, (E,)."""
        ends = self.nodes[self.edges]
        return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)

    def branch_measures(self, *, sections: int = 9) -> dict[str, npt.NDArray[Any]]:
        """What is tabulated of centrelines: for each of ``branches`` a value in each column.

        - first, last: nodes.
        - length, chord: mesh units. tortuosity: length / chord - 1, infinite where a branch ends where it
          begins.
        - curvature: the angle by which the branch turns over its length, radians a mesh unit; of an unrefined
          curve much of it is roughness. torsion: the angle by which the plane of its turns twists over its
          length, positive as in a right-handed screw; of a nearly straight or a rough branch it means nothing.
        - radius_min, radius_mean (over the length), radius_max. significance: NaN where it is not known.
        - angle_first, angle_last: degrees, the smallest angle to another branch at that junction, each taken
          towards the point where it leaves the junction's ball; NaN at other ends.
        - strahler: the order after Strahler (1957) with the thickest end of a branch as the root; 0 in a
          component with cycles.
        - section_area, section_perimeter, section_diameter_min, section_diameter_max: means over the sections of
          ``surface`` by planes normal to the branch: the outline around the curve, and the smallest and the
          largest distance of parallel lines that touch it. Between the balls at the branch's ends, or in its
          middle if they leave nothing; NaN where the surface is not known or no outline is closed.

        For a table: ``pandas.DataFrame(skeleton.branch_measures())``.

        Args:
            sections: Of each branch, evenly spread; 0 measures none.
        """
        return _measures.branch_measures(self, sections)

    def to_networkx(self, *, arrays: bool = False) -> networkx.Graph:
        """The skeleton as a graph, sides of sheets included; the results are the graph's attributes.

        Nodes have x, y, z, radius and, where they are known, significance and surface_vertices, ids with
        blanks between; edges have length and, where there are sheets, sheet. All of these are numbers
        and texts, so that every writer of networkx takes them.

        Args:
            arrays: For Python instead: position, a tuple, in place of x, y, z, and surface_vertices as
                a list.
        """
        return _convert.to_networkx(self, arrays)

    def to_pyvista(self) -> pyvista.PolyData:
        """A polyline for each branch and the sheets' triangles; point data radius and, if it is known,
        significance, cell data branch (-1 on a sheet)."""
        return _convert.to_pyvista(self)

    def to_trimesh(self) -> trimesh.path.Path3D:
        """A line for each branch; the radius is in the metadata. Sheets are left out."""
        return _convert.to_trimesh(self)

    def to_navis(self, *, units: str | None = None) -> navis.TreeNeuron:
        """A neuron, or a list of them if there are several components. Cycles are cut as in .swc.

        Args:
            units: Of the mesh, such as ``"nm"``; navis takes them for its own lengths.
        """
        return _convert.to_navis(self, units)

    def plot(self, *, backend: str = "matplotlib", ax: Any = None, surface: bool = True) -> Any:
        """Draws the skeleton, coloured by its radius, in its translucent surface.

        Args:
            backend: ``"matplotlib"``, ``"pyvista"`` or ``"trimesh"``.
            ax: matplotlib axes with ``projection="3d"`` to draw into; by default new ones.
            surface: Whether the mesh is drawn, where it is known.

        Returns:
            The axes, a ``pyvista.Plotter`` or a ``trimesh.Scene``; the latter two have ``show()``.

        Raises:
            SkeletonError: There is no such backend, or its package is not installed.
        """
        return _plot.plot(self, backend, ax, surface)

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes the skeleton in the format that the name ends with.

        The file is replaced as a whole, or stays as it was: after an error such as a full disk, and if
        the process is killed.

        Args:
            path: Ends with .swc, .cg, .graphml, .json, .vtp, .glb or .ply. SWC holds trees only: each
                cycle is cut at its thinnest edge, and a warning lists the cuts. Sheets are kept by
                .ply. The correspondence is not in .swc and .cg. A .glb is the surface with an armature; where
                that bounds no solid, the repaired surface.
            **options: Of the filter Save Skeleton: for .swc ``scale``, ``units`` (``"um"``) and
                ``soma`` (``"auto"``); for .glb ``bone_tolerance``, a length such as ``"1%"``.

        Raises:
            SkeletonError: The name ends otherwise, an option is wrong, or the file cannot be written.
        """
        _files.save(self, _files.path_of(path), options)


def skeletonize(vertices: Any, faces: npt.ArrayLike | None = None, *,
                target_length: Length | None = None, epsilon: Length | None = None,
                normals: npt.ArrayLike | None = None, spacing: Any = None,
                level: float | None = None, **options: Any) -> Skeleton:
    """Computes the curve skeleton of a mesh, of voxels, or of points with normals. Ctrl-C ends it at once.

    Args:
        vertices: Positions, (V, 3); or the path of a file that MeshLab reads; or an object with
            ``vertices`` and ``faces``, such as a ``trimesh.Trimesh``; or voxels, (X, Y, Z), or the path of
            a file of them (.npy, .npz, .nrrd). ``faces`` only with positions.
        faces: Triangles as vertex ids, (F, 3), counter-clockwise seen from outside.
        target_length: Edge length of the resampling; by default chosen from the mesh.
        epsilon: Edges shorter than this are collapsed; by default 0.2 % of the diagonal. A length is
            a number of mesh units, or a text such as ``"0.2%"`` of the bounding box diagonal.
        normals: Of points without faces, outward, (V, 3). The surface of the skeleton then has three vertices for
            each point, one point's after the other's. Needs scipy.
        spacing: Of voxels, the distance of their middles, one number or one for each axis; by default the
            file's own, or 1.
        level: Of voxels, the value above which they are inside; by default 0.5.
        **options: Further parameters of the filter Full Skeletonize, by their names in pymeshlab:
            ``w_l``, ``w_h``, ``w_m``, ``resample``, ``denoise``, ``refine``, ``preset``, ``pole_method``,
            ``max_iterations``, ``keep_sheets``, ... None stands for the default.

    Returns:
        The skeleton.

    Raises:
        SkeletonError: The mesh bounds no solid and cannot be made one (see the option ``repair``), there is no such
            file, or an option does not exist or is out of its range.

    Warns:
        SkeletonWarning: The contraction has not converged within ``max_iterations``, or components could
            not be refined.
    """
    layers = document(vertices, faces, normals, spacing, level)
    surface = Surface(layers.current_mesh().vertex_matrix(), layers.current_mesh().face_matrix())
    defaults = layers.filter_parameter_values(FILTER)
    options = filter_options("skeletonize()", options | {"target_length": target_length, "epsilon": epsilon},
                             defaults)
    if not len(surface.faces):
        raise SkeletonError("There are no faces: faces is empty, or the file is one of points without normals.")
    mesh = layers.current_mesh_id()
    results = apply(layers, FILTER, options)
    if not results.get("converged", 1):
        warnings.warn(f"The contraction has not converged after {int(results['iterations'])} iterations: the "
                      "skeleton may be off the middle. Raise max_iterations, or repair self-intersections first.",
                      SkeletonWarning, stacklevel=2)
    if results["refined"] < 1 and _is_to_be_refined(defaults | options):
        warnings.warn(f"{1 - results['refined']:.0%} of the components are not refined: their curves are those of "
                      "the flow, which may be off the middle, and partly outside where the surface crosses itself "
                      "or is very thin.", SkeletonWarning, stacklevel=2)
    skeleton = _from_layer(layers.current_mesh(), layers.mesh(mesh), results, surface)
    if results.get("repaired"):
        contracted = contracted_layer(layers, mesh)
        object.__setattr__(skeleton, "_contracted", (
            Surface(contracted.vertex_matrix(), contracted.face_matrix()), _nodes_of(contracted)))
    return skeleton


def contracted_layer(layers: pymeshlab.MeshSet, mesh: int) -> pymeshlab.Mesh:
    """The surface that Full Skeletonize has contracted: the resampled or the repaired one, else the mesh itself.

    Args:
        layers: The document after the filter, which had only the mesh before.
        mesh: The id of the mesh's layer.
    """
    return next((layer for layer in layers if layer.id() != mesh
                 and layer.label().endswith(("_resampled", "_solid"))), layers.mesh(mesh))


def _is_to_be_refined(values: dict[str, Any]) -> bool:
    return (values["refine"] and not values["keep_sheets"] and not values["fix_selected"]
            and values["preset"] not in ("paper", 1))


def check_options(**options: Any) -> None:
    """Checks options of ``skeletonize()`` before there is a mesh: their names, kinds, choices and ranges.

    ``spacing`` and ``level``, which are of voxels only, are not among them. How long a length in mesh units may
    be depends on the mesh, and so does whether vertices are selected.

    Raises:
        SkeletonError: One does not exist, or its value is of the wrong kind or out of its range; the text
            names it.
    """
    layers = pymeshlab.MeshSet()
    layers.create_octahedron()
    values = filter_options("skeletonize()", options, layers.filter_parameter_values(FILTER))
    for name, value in values.items():
        if isinstance(value, pymeshlab.PureValue) and not 0 <= value.value() < np.inf:
            raise SkeletonError(f"{name}={value.value():g} is no length: it must be at least 0, and finite.")
    values = {name: value for name, value in values.items()
              if name != "fix_selected" and not isinstance(value, pymeshlab.PureValue)}
    # The filter checks them before it begins; an octahedron as it is takes no time.
    apply(layers, FILTER, values | {"resample": False, "refine": False})


def load(path: str | os.PathLike[str]) -> Skeleton:
    """Reads a skeleton that ``Skeleton.save()`` or the filter Save Skeleton has written.

    Radius, significance, correspondence and bridges are those that the format keeps; .cg has none (the radius is
    then 0), .swc only the radius. SWC and curve graphs from elsewhere are read as well.

    Raises:
        SkeletonError: The file cannot be read; the text says where it is wrong.
    """
    nodes, edges, radius, correspondence, faces, significance, bridges = _files.load(_files.path_of(path))
    return Skeleton(nodes, edges, radius, correspondence, {}, faces, None, significance, bridges)


def document(vertices: Any, faces: Any = None, normals: Any = None, spacing: Any = None,
             level: float | None = None) -> pymeshlab.MeshSet:
    """A document with the mesh as its only layer; the arguments are those of skeletonize().

    Raises:
        SkeletonError: They are no mesh, or the file cannot be read.
    """
    is_path = isinstance(vertices, (str, os.PathLike))
    volume = None
    level_given, level = level is not None, _level(level)
    if is_path and os.fspath(vertices).lower().endswith(VOLUME_FILES):
        try:
            volume = read_volume(vertices, spacing)
        except FileNotFoundError:
            raise SkeletonError(f"There is no file '{os.fspath(vertices)}'.") from None
        except ValueError as error:
            raise SkeletonError(f"'{os.fspath(vertices)}' cannot be read: {error}.") from None
        except OSError as error:
            raise SkeletonError(f"'{os.fspath(vertices)}' cannot be read: {error.strerror or error}.") from None
    elif isinstance(vertices, np.ndarray) and vertices.ndim == 3:
        try:
            volume = volume_of(vertices, spacing)
        except ValueError as error:
            raise SkeletonError(f"{error}.") from None
    if volume is not None:
        if faces is not None or normals is not None:
            raise SkeletonError("Voxels have neither faces nor normals: give them alone.")
        try:
            return _layer(*voxel_surface(volume, level))
        except ValueError as error:
            raise SkeletonError(f"{error}.") from None
    for name, is_given in (("spacing", spacing is not None), ("level", level_given)):
        if is_given:
            raise SkeletonError(f"{name} is an option of voxels, and these are none.")
    if normals is not None:
        if faces is not None or is_path:
            raise SkeletonError("normals are those of points: give positions without faces.")
        return _points(_array(vertices, "vertices", np.float64), _array(normals, "normals", np.float64))
    if is_path:
        if faces is not None:
            raise SkeletonError("faces must not be given where vertices is the path of a file.")
        layers = open_mesh(os.fspath(vertices))
        mesh = layers.current_mesh()
        if mesh.face_number() == 0 and mesh.vertex_number() and mesh.vertex_normal_matrix().any():
            return _points(mesh.vertex_matrix(), mesh.vertex_normal_matrix())
        return layers
    if faces is None:
        try:
            vertices, faces = vertices.vertices, vertices.faces
        except AttributeError:
            raise SkeletonError("skeletonize() takes vertices and faces, a mesh that has both, or the "
                                f"path of a file, not {type(vertices).__name__} alone.") from None
    points = _array(vertices, "vertices", np.float64)
    triangles = _array(faces, "faces", np.int32)
    if triangles.size and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise SkeletonError("faces: a face has a vertex that is not one of the "
                            f"{len(points)} vertices.")
    return _layer(points, triangles)


def _level(level: Any) -> float:
    """The level of voxels: 0.5 where none is given."""
    try:
        value = 0.5 if level is None else float(level)
    except (TypeError, ValueError, OverflowError):
        value = np.nan
    if isinstance(level, str) or not np.isfinite(value):
        raise SkeletonError(f"level={level!r} is no finite number.")
    return value


def _layer(points: np.ndarray, triangles: np.ndarray) -> pymeshlab.MeshSet:
    layers = pymeshlab.MeshSet()
    layers.add_mesh(pymeshlab.Mesh(vertex_matrix=points, face_matrix=triangles.astype(np.int32)), "mesh")
    return layers


def _points(points: np.ndarray, normals: np.ndarray) -> pymeshlab.MeshSet:
    """A document with a triangle for each point."""
    try:
        return _layer(*point_triangles(points, normals))
    except ValueError as error:
        raise SkeletonError(f"{error}.") from None
    except ImportError:
        raise SkeletonError("Points need scipy: pip install scipy.") from None


def _from_layer(layer: pymeshlab.Mesh, mesh: pymeshlab.Mesh, results: dict[str, Any],
                surface: Surface) -> Skeleton:
    radius = layer.vertex_custom_scalar_attribute_array("mcfskel_radius")
    correspondence = _nodes_of(mesh)
    edges = np.sort(layer.edge_matrix().astype(np.int64).reshape(-1, 2), axis=1)
    edges = edges[np.lexsort((edges[:, 1], edges[:, 0]))]
    faces = layer.face_matrix().astype(np.int64).reshape(-1, 3)
    try:
        significance = layer.vertex_custom_scalar_attribute_array("mcfskel_significance")
    except pymeshlab.PyMeshLabException:  # it is not refined
        significance = np.empty(0)
    bridges = np.empty(0, bool)
    if results.get("bridges"):
        bridge = layer.vertex_custom_scalar_attribute_array("mcfskel_bridge") > 0
        bridges = bridge[edges].any(axis=1)
    return Skeleton(layer.vertex_matrix(), edges, radius, correspondence, results, faces, surface,
                    significance, bridges)


def _nodes_of(surface: pymeshlab.Mesh) -> np.ndarray:
    """The node of each vertex of a surface."""
    return surface.vertex_custom_scalar_attribute_array("mcfskel_node").astype(np.int64)


def _array(values: Any, name: str, kind: type) -> np.ndarray:
    try:
        array = np.ascontiguousarray(values)
        if kind is np.int32 and array.size:
            if not np.issubdtype(array.dtype, np.integer):
                raise ValueError("ids must be integers")
            if int(array.max()) > INT_MAX or int(array.min()) < 0:
                raise ValueError(f"ids must be between 0 and {INT_MAX}")
        array = array.astype(kind, casting="unsafe")
    except (TypeError, ValueError) as error:
        raise SkeletonError(f"{name} is no array of numbers: {error}") from None
    if array.size == 0:
        raise SkeletonError(f"{name} is empty.")
    if array.ndim != 2 or array.shape[1] != 3:
        raise SkeletonError(f"{name} must have the shape (n, 3), not {array.shape}.")
    return array
