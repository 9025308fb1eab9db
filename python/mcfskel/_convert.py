# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletons as other packages hold them. Each of these is imported when it is asked for, not before."""

from __future__ import annotations

import importlib
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._run import SkeletonError

if TYPE_CHECKING:
    from ._skeleton import Skeleton


def needed(package: str, purpose: str) -> Any:
    """Imports a package that this one does not depend on.

    Raises:
        SkeletonError: It is not installed.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.partition(".")[0]  # pip's, not the module's
        raise SkeletonError(f"{purpose} needs the package {name}: pip install {name} ({error}).") from None


def sheet_edges(skeleton: Skeleton) -> np.ndarray:
    """The edges of the sheets' triangles that are no edges of the curve, (n, 2), ascending."""
    pairs = np.sort(skeleton.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    pairs = np.unique(pairs, axis=0)
    count = max(len(skeleton.nodes), 1)
    return pairs[~np.isin(pairs @ [count, 1], skeleton.edges @ [count, 1])]


def to_networkx(skeleton: Skeleton, arrays: bool) -> Any:
    networkx = needed("networkx", "to_networkx()")
    graph = networkx.Graph(**{name: value for name, value in skeleton.results.items()
                              if isinstance(value, (bool, int, float, str))})
    sources = skeleton.surface_vertices() if len(skeleton.correspondence) else None
    radius, significance = skeleton.radius.tolist(), skeleton.significance.tolist()
    for node, (x, y, z) in enumerate(skeleton.nodes.tolist()):
        graph.add_node(node, radius=radius[node])
        values = graph.nodes[node]
        if significance:
            values["significance"] = significance[node]
        if arrays:
            values["position"] = (x, y, z)
        else:
            values.update(x=x, y=y, z=z)
        if sources is not None:
            vertices = sources[node].tolist()
            values["surface_vertices"] = vertices if arrays else " ".join(map(str, vertices))
    for pairs, of_sheet in ((skeleton.edges, False), (sheet_edges(skeleton), True)):
        ends = skeleton.nodes[pairs]
        lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        for (a, b), length in zip(pairs.tolist(), lengths.tolist()):
            graph.add_edge(a, b, length=length)
            if len(skeleton.faces):
                graph.edges[a, b]["sheet"] = of_sheet
    return graph


def to_pyvista(skeleton: Skeleton) -> Any:
    pyvista = needed("pyvista", "to_pyvista()")
    branches = skeleton.branches
    mesh = pyvista.PolyData()
    mesh.points = np.array(skeleton.nodes)
    if branches:
        mesh.lines = np.concatenate([[len(branch), *branch] for branch in branches])
    if len(skeleton.faces):
        mesh.faces = np.column_stack([np.full(len(skeleton.faces), 3), skeleton.faces]).ravel()
    mesh.point_data["radius"] = skeleton.radius
    if len(skeleton.significance):
        mesh.point_data["significance"] = skeleton.significance
    mesh.cell_data["branch"] = np.concatenate(
        [np.arange(len(branches)), np.full(len(skeleton.faces), -1)]).astype(np.int64)
    return mesh


def to_trimesh(skeleton: Skeleton) -> Any:
    needed("trimesh", "to_trimesh()")
    path = needed("trimesh.path", "to_trimesh()")
    entities = needed("trimesh.path.entities", "to_trimesh()")
    return path.Path3D(entities=[entities.Line(branch) for branch in skeleton.branches],
                       vertices=skeleton.nodes.copy(), metadata={"radius": skeleton.radius.copy()},
                       process=False)


def to_navis(skeleton: Skeleton, units: str | None) -> Any:
    navis = needed("navis", "to_navis()")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "skeleton.swc")
        skeleton.save(path)
        neuron = navis.read_swc(path)
    if units is not None:
        neuron.units = units
    return neuron
