# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From arrays to a skeleton, and from a skeleton to files and graphs."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pymeshlab

from . import _plugin  # noqa: F401 (loads the filters)

if TYPE_CHECKING:
    import networkx

FILTER = "generate_curve_skeleton_mcf"
Length = float | str | pymeshlab.PercentageValue | pymeshlab.PureValue


class SkeletonError(ValueError):
    """The mesh, an option or a file is not right; the text says what, how many, and what cures it."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A curve skeleton: a graph in space, and how the surface belongs to it.

    Attributes:
        nodes: Positions, (N, 3), in the mesh's units.
        edges: Pairs of nodes, (E, 2), lower node first, ascending.
        radius: Local thickness at each node, (N,), in the mesh's units.
        correspondence: For each vertex of the mesh the node that it has merged into, (V,); -1 for a
            vertex of no face. Empty for a skeleton from a file.
        results: The numbers of the filter: iterations, converged, components, cycles, ...
    """

    nodes: npt.NDArray[np.float64]
    edges: npt.NDArray[np.int64]
    radius: npt.NDArray[np.float64]
    correspondence: npt.NDArray[np.int64]
    results: dict[str, float] = field(default_factory=dict)

    def surface_vertices(self) -> list[npt.NDArray[np.int64]]:
        """For each node the vertices of the mesh that have merged into it, ascending."""
        order = np.argsort(self.correspondence, kind="stable")
        bounds = np.searchsorted(self.correspondence[order], np.arange(len(self.nodes) + 1))
        return [order[a:b] for a, b in zip(bounds[:-1], bounds[1:])]

    def lengths(self) -> npt.NDArray[np.float64]:
        """The length of each edge, (E,)."""
        ends = self.nodes[self.edges]
        return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)

    def to_networkx(self) -> networkx.Graph:
        """The skeleton as a graph: nodes with position, radius and surface_vertices, edges with length."""
        import networkx

        graph = networkx.Graph(**self.results)
        sources = self.surface_vertices()
        for node, position in enumerate(self.nodes.tolist()):
            graph.add_node(node, position=tuple(position), radius=float(self.radius[node]),
                           surface_vertices=sources[node].tolist())
        for (a, b), length in zip(self.edges.tolist(), self.lengths().tolist()):
            graph.add_edge(a, b, length=length)
        return graph

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the skeleton in the format that the name ends with.

        The file is replaced as a whole, or stays as it was: after an error such as a full disk, and if
        the process is killed.

        Args:
            path: Ends with .swc, .cg, .graphml, .json or .ply. SWC holds trees only: each cycle is
                cut at its thinnest edge, and a warning lists the cuts. Only .graphml and .json keep
                the correspondence.

        Raises:
            SkeletonError: The name ends otherwise, or the file cannot be written.
        """
        layers = pymeshlab.MeshSet()
        skeleton = pymeshlab.Mesh(vertex_matrix=self.nodes, edge_matrix=self.edges.astype(np.int32))
        skeleton.add_vertex_custom_scalar_attribute(self.radius, "mcfskel_radius")
        layers.add_mesh(skeleton, "skeleton")
        options = {"file": os.fspath(path)}
        if len(self.correspondence):
            surface = pymeshlab.Mesh(vertex_matrix=np.zeros((len(self.correspondence), 3)))
            surface.add_vertex_custom_scalar_attribute(
                self.correspondence.astype(float), "mcfskel_node")
            layers.add_mesh(surface, "surface", set_as_current=False)
            options["surface"] = 1
        _apply(layers, "save_skeleton_mcf", options)
        if Path(path).suffix.lower() == ".swc" and Path(path).is_file():  # not from a pipe
            _warn_of_cuts(Path(path))


def skeletonize(vertices: Any, faces: npt.ArrayLike | None = None, *,
                target_length: Length | None = None, epsilon: Length | None = None,
                **options: Any) -> Skeleton:
    """Computes the curve skeleton of a closed triangle mesh.

    Args:
        vertices: Positions, (V, 3); or an object with ``vertices`` and ``faces``, such as a
            ``trimesh.Trimesh``, and then no ``faces``.
        faces: Triangles as vertex ids, (F, 3), counter-clockwise seen from outside.
        target_length: Edge length of the resampling; by default chosen from the mesh.
        epsilon: Edges shorter than this are collapsed; by default 0.2 % of the diagonal. A length is
            a number of mesh units, or a text such as ``"0.2%"`` of the bounding box diagonal.
        **options: Further parameters of the filter Full Skeletonize, by their names in pymeshlab:
            ``w_l``, ``w_h``, ``w_m``, ``resample``, ``denoise``, ``refine``, ``pole_method``,
            ``max_iterations``, ...

    Returns:
        The skeleton.

    Raises:
        SkeletonError: The mesh is not a closed two-manifold, or an option is out of its range.
    """
    if faces is None:
        try:
            vertices, faces = vertices.vertices, vertices.faces
        except AttributeError:
            raise SkeletonError("skeletonize() takes vertices and faces, or a mesh that has both.") from None
    points = _array(vertices, "vertices", np.float64)
    triangles = _array(faces, "faces", np.int32)
    if triangles.size and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise SkeletonError(f"A face has a vertex that is not one of the {len(points)} vertices.")
    for name, length in [("target_length", target_length), ("epsilon", epsilon)]:
        if length is not None:
            options[name] = _length(name, length)

    layers = pymeshlab.MeshSet()
    layers.add_mesh(pymeshlab.Mesh(vertex_matrix=points, face_matrix=triangles), "mesh")
    _check_names(layers, options)
    results = _apply(layers, FILTER, options)
    return _from_layer(layers.current_mesh(), layers.mesh(0), results)


def load(path: str | os.PathLike[str]) -> Skeleton:
    """Reads a skeleton from a .swc or .cg file.

    Raises:
        SkeletonError: The file cannot be read; the text names the line.
    """
    if Path(path).suffix.lower() not in (".swc", ".cg"):
        raise SkeletonError(f"'{os.fspath(path)}' does not end with .swc or .cg.")
    layers = pymeshlab.MeshSet()
    folder = os.getcwd()
    try:
        layers.load_new_mesh(os.path.abspath(path))
    except pymeshlab.PyMeshLabException as error:
        raise SkeletonError(_reason(error)) from None
    finally:
        os.chdir(folder)  # where a failed reading in pymeshlab leaves it is the file's folder
    return _from_layer(layers.current_mesh(), None, {})


def _from_layer(layer: pymeshlab.Mesh, surface: pymeshlab.Mesh | None,
                results: dict[str, float]) -> Skeleton:
    try:
        radius = layer.vertex_custom_scalar_attribute_array("mcfskel_radius")
    except pymeshlab.PyMeshLabException:
        radius = np.zeros(layer.vertex_number())
    correspondence = np.empty(0, np.int64)
    if surface is not None:
        correspondence = surface.vertex_custom_scalar_attribute_array("mcfskel_node").astype(np.int64)
    edges = np.sort(layer.edge_matrix().astype(np.int64).reshape(-1, 2), axis=1)
    edges = edges[np.lexsort((edges[:, 1], edges[:, 0]))]
    return Skeleton(layer.vertex_matrix(), edges, radius, correspondence, results)


def _array(values: Any, name: str, kind: type) -> np.ndarray:
    try:
        array = np.ascontiguousarray(values)
        if kind is np.int32 and array.size and not np.issubdtype(array.dtype, np.integer):
            raise ValueError("ids must be integers")
        array = array.astype(kind, casting="unsafe")
    except (TypeError, ValueError) as error:
        raise SkeletonError(f"{name} is no array of numbers: {error}") from None
    if array.ndim != 2 or array.shape[1] != 3:
        raise SkeletonError(f"{name} must have the shape (n, 3), not {array.shape}.")
    return array


def _length(name: str, value: Length) -> Any:
    if isinstance(value, str):
        try:
            return pymeshlab.PercentageValue(float(value.removesuffix("%")))
        except ValueError:
            raise SkeletonError(f"{name}='{value}' is no length: write 0.01 or '0.2%'.") from None
    if isinstance(value, (int, float)):
        return pymeshlab.PureValue(float(value))
    return value


def _check_names(layers: pymeshlab.MeshSet, options: dict[str, Any]) -> None:
    """pymeshlab only prints a line about a parameter that does not exist."""
    known = layers.filter_parameter_values(FILTER)
    if unknown := sorted(set(options) - set(known)):
        raise SkeletonError(f"There is no option {', '.join(unknown)}; there are {', '.join(sorted(known))}.")


def _apply(layers: pymeshlab.MeshSet, name: str, options: dict[str, Any]) -> dict[str, float]:
    try:
        return layers.apply_filter(name, **options)
    except pymeshlab.PyMeshLabException as error:
        raise SkeletonError(_reason(error)) from None


def _reason(error: Exception) -> str:
    """The plugin's own words in pymeshlab's error, on one line."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if len(lines) > 1:
        lines = [line.removeprefix("Details: ") for line in lines[1:]]
    return " ".join(lines)


def _warn_of_cuts(path: Path) -> None:
    with open(path, encoding="utf-8") as lines:
        cuts = [line[2:].strip() for line in lines if line.startswith("# cycle cut")]
    if cuts:
        warnings.warn(f"SWC holds trees only; in '{path}': {'; '.join(cuts)}", stacklevel=3)


