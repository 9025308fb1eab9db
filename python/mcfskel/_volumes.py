# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of what is no mesh yet: voxels, and points with normals."""

from __future__ import annotations

import gzip
import math
import os
import re
import tokenize
import zipfile
import zlib
from typing import Any, NamedTuple

import numpy as np

#: Endings of the files that read_volume() reads.
VOLUME_FILES = (".npy", ".npz", ".nrrd")


class Volume(NamedTuple):
    """Voxels and where they are: the middle of voxel (i, j, k) is at origin + (i, j, k) @ directions."""

    values: np.ndarray
    directions: np.ndarray
    origin: np.ndarray


def volume_of(values: Any, spacing: Any = None, origin: Any = None) -> Volume:
    """A volume with axes along those of space.

    Args:
        values: (X, Y, Z), truth values or numbers.
        spacing: Distance of the voxels' middles, one number or one for each axis; by default 1.
        origin: The middle of the first voxel; by default 0.

    Raises:
        ValueError: The array has not three axes, is empty or of no numbers, or a length is not positive.
    """
    values = np.asarray(values)
    if values.ndim != 3 or not values.size or values.dtype.kind not in "biuf":
        raise ValueError("a volume is an array of truth values or numbers with three axes, not one of "
                         f"{values.dtype} with the shape {values.shape}")
    try:
        step = np.broadcast_to(np.asarray(1 if spacing is None else spacing, float), 3)
        start = np.broadcast_to(np.asarray(0 if origin is None else origin, float), 3)
    except (TypeError, ValueError):
        raise ValueError("spacing and origin are one number, or one for each of the three axes") from None
    if not (np.isfinite(step).all() and (step > 0).all() and np.isfinite(start).all()):
        raise ValueError("spacing must be positive, and spacing and origin finite")
    return Volume(values, np.diag(step), start)


def voxel_surface(volume: Volume, level: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """The surface around the voxels with values above a level, one vertex in each cell of eight voxels that
    are not all alike; beyond the array all is outside.

    Of truth values and whole numbers it counts only which are above the level; of other numbers the surface
    lies where they are equal to it, straight on between two voxels. Where voxels touch at edges or corners only,
    it is no two-manifold: the repair parts it there.

    Args:
        volume: The voxels.
        level: What is above is inside.

    Returns:
        Vertices, (V, 3), and triangles, (F, 3), counter-clockwise seen from outside.

    Raises:
        ValueError: No voxel is above the level, or some values are not finite.

    Source: Gibson, "Constrained elastic surface nets", 1998, without its relaxation.
    """
    values = volume.values
    if values.dtype.kind == "f":
        if not np.isfinite(values).all():
            raise ValueError("the volume has values that are not finite")
        above = np.pad(values > level, 1)
        height = np.pad(values.astype(float) - level, 1,
                        constant_values=min(0.0, float(values.min()) - level) or -1.0)
    else:
        above = np.pad(values > level, 1)
        height = above - 0.5
    if not above.any():
        raise ValueError(f"no voxel of the volume is above the level {level:g}")
    corners = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    size = np.array(above.shape) - 1
    count = np.zeros(size, np.uint8)
    for i, j, k in corners:
        count += above[i: size[0] + i, j: size[1] + j, k: size[2] + k]
    mixed = (count > 0) & (count < 8)
    cells = np.argwhere(mixed)
    number = np.full(size, -1)
    number[mixed] = np.arange(len(cells))
    around = np.stack([height[tuple((cells + corner).T)] for corner in corners], axis=1)
    inside = np.stack([above[tuple((cells + corner).T)] for corner in corners], axis=1)
    total, crossings = np.zeros((len(cells), 3)), np.zeros(len(cells))
    for a in range(8):
        for b in range(a + 1, 8):
            if np.abs(corners[a] - corners[b]).sum() != 1:
                continue
            at = inside[:, a] != inside[:, b]
            low, high = around[at, a], around[at, b]
            part = np.clip(low / (low - high), 0.01, 0.99)  # no triangle without area
            total[at] += corners[a] + part[:, None] * (corners[b] - corners[a])
            crossings[at] += 1
    vertices = cells + total / crossings[:, None] - 1  # the padding
    vertices = volume.origin + vertices @ volume.directions

    quads = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        change = np.diff(above.astype(np.int8), axis=axis)
        for sign in (-1, 1):  # leaving the solid, entering it
            at = np.argwhere(change == sign)
            ring = [number[tuple((at - offset).T)] for offset in (u + v, v, 0 * u, u)]
            quads.append(np.stack(ring if sign < 0 else ring[::-1], axis=1))
    quad = np.concatenate(quads)
    a, b, c, d = (vertices[quad[:, i]] for i in range(4))
    first = ((a - c) ** 2).sum(axis=1) <= ((b - d) ** 2).sum(axis=1)
    quad = np.where(first[:, None], quad, np.roll(quad, -1, axis=1))
    triangles = np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])
    if np.linalg.det(volume.directions) < 0:
        triangles = triangles[:, ::-1]
    return vertices, triangles


def read_volume(path: str | os.PathLike[str], spacing: Any = None) -> Volume:
    """A volume from a file: .npy; .npz with one array, or one named volume, and perhaps spacing and origin;
    .nrrd, raw or gzip, in one file.

    Args:
        path: The file.
        spacing: Distance of the voxels' middles; by default the file's own, or 1. The directions of the
            axes stay those of the file.

    Raises:
        ValueError: The file is none of these, or is damaged. OSError: it cannot be opened.
    """
    name = os.fspath(path).lower()
    if name.endswith(".nrrd"):
        volume = _read_nrrd(path)
        if spacing is None:
            return volume
        steps = volume_of(volume.values, spacing).directions
        ways = volume.directions / np.linalg.norm(volume.directions, axis=1)[:, None]
        return volume._replace(directions=steps @ ways)
    try:
        loaded = np.load(path, allow_pickle=False)
        return volume_of(loaded, spacing) if isinstance(loaded, np.ndarray) else _of_archive(loaded, spacing)
    except (EOFError, KeyError, NotImplementedError, SyntaxError, tokenize.TokenError, zipfile.BadZipFile,
            zlib.error) as error:
        raise ValueError(f"it is no array of numpy ({error})") from None


def _of_archive(loaded: Any, spacing: Any) -> Volume:
    with loaded:
        names = [name for name in loaded.files if name not in ("spacing", "origin")]
        if "volume" not in names and len(names) != 1:
            raise ValueError("none of its arrays is named volume: " + ", ".join(loaded.files))
        return volume_of(loaded["volume" if "volume" in names else names[0]],
                         loaded["spacing"] if spacing is None and "spacing" in loaded.files else spacing,
                         loaded["origin"] if "origin" in loaded.files else None)


_NRRD_TYPES = {"signed char": "i1", "int8": "i1", "int8_t": "i1", "uchar": "u1", "unsigned char": "u1",
               "uint8": "u1", "uint8_t": "u1", "short": "i2", "short int": "i2", "signed short": "i2",
               "int16": "i2", "int16_t": "i2", "ushort": "u2", "unsigned short": "u2", "uint16": "u2",
               "uint16_t": "u2", "int": "i4", "signed int": "i4", "int32": "i4", "int32_t": "i4",
               "uint": "u4", "unsigned int": "u4", "uint32": "u4", "uint32_t": "u4", "longlong": "i8",
               "long long": "i8", "int64": "i8", "int64_t": "i8", "ulonglong": "u8", "uint64": "u8",
               "unsigned long long": "u8", "uint64_t": "u8", "float": "f4", "double": "f8"}


def _read_nrrd(path: str | os.PathLike[str]) -> Volume:
    """Source: the NRRD file format, version 5, teem.sourceforge.net/nrrd/format.html."""
    with open(path, "rb") as file:
        if not file.readline().startswith(b"NRRD"):
            raise ValueError("it does not begin as a .nrrd does")
        fields: dict[str, str] = {}
        while line := file.readline().decode("ascii", "replace").strip():
            if not line.startswith("#") and ":" in line and ":=" not in line:
                key, _, value = line.partition(":")
                fields[key.strip().lower()] = value.strip()
        data = file.read()
    if "data file" in fields or "datafile" in fields:
        raise ValueError("its data are in another file: write it as one .nrrd")
    for field in ("line skip", "lineskip", "byte skip", "byteskip"):
        if fields.get(field, "0") != "0":
            raise ValueError(f"its header has {field}, which is not supported: write it without")
    try:
        sizes = [int(word) for word in fields["sizes"].split()]
        kind = np.dtype(_NRRD_TYPES[fields["type"].lower()])
    except (KeyError, ValueError):
        raise ValueError("its header has no sizes or no type that is known") from None
    encoding = fields.get("encoding", "raw").lower()
    if encoding in ("gzip", "gz"):
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError, zlib.error) as error:
            raise ValueError(f"its data are damaged ({error})") from None
    elif encoding != "raw":
        raise ValueError(f"its encoding is {encoding}: raw and gzip are read")
    kind = kind.newbyteorder(">" if fields.get("endian", "little").lower() == "big" else "<")
    if len(sizes) != 3 or min(sizes) < 1 or len(data) < math.prod(sizes) * kind.itemsize:
        raise ValueError("it has not three axes, or fewer data than its header says")
    values = np.frombuffer(data, kind, math.prod(sizes)).reshape(sizes[::-1]).T
    try:
        vectors = [[float(x) for x in word.split(",")]
                   for word in re.findall(r"\(([^)]*)\)", fields.get("space directions", ""))]
        origin = [float(x) for x in fields.get("space origin", "(0,0,0)").strip("()").split(",")]
        spacing = [float(word) for word in fields["spacings"].split()] if "spacings" in fields else None
        volume = volume_of(values, spacing, origin)
        if vectors:
            directions = np.array(vectors)
            if directions.shape != (3, 3) or not abs(np.linalg.det(directions)) > 0:
                raise ValueError
            volume = volume._replace(directions=directions)
    except ValueError:
        raise ValueError("its header has spacings, directions or an origin that are not right") from None
    return volume


def point_triangles(points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A triangle for each point: about it, across its normal, of 2.25 times the area that it stands for by the
    distance of its neighbours. So they leave no gaps; the repair counts layers that overlap as one, and their
    winding number is that of the surface that the points lie on.

    Args:
        points: Positions, (N, 3).
        normals: Outward, (N, 3), of any length.

    Returns:
        Vertices, (3 N, 3), those of a point one after the other, and triangles, (N, 3).

    Raises:
        ValueError: There are too few points, or normals that are zero or not finite.
        ImportError: There is no scipy.

    Source: Barill et al., "Fast winding numbers for soups and clouds", 2018, Sec. 4.
    """
    from scipy.spatial import cKDTree

    neighbours, wider = 8, 1.5
    points, normals = np.asarray(points, float), np.asarray(normals, float)
    if points.shape != normals.shape or points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"normals have the shape {normals.shape}, points {points.shape}: both are (N, 3)")
    length = np.linalg.norm(normals, axis=1)
    if not (np.isfinite(points).all() and np.isfinite(length).all() and (length > 0).all()):
        raise ValueError("there are points or normals that are not finite, or normals of no length")
    if len(points) < 4 * neighbours:
        raise ValueError(f"{len(points)} points are too few for a surface")
    unit = normals / length[:, None]
    distance = cKDTree(points).query(points, neighbours + 1)[0][:, -1]
    area = np.pi * distance**2 / (neighbours + 0.5)
    radius = wider * np.sqrt(area * 4 / 27**0.5)
    helper = np.eye(3)[np.abs(unit).argmin(axis=1)]
    x = np.cross(unit, helper)
    x /= np.linalg.norm(x, axis=1)[:, None]
    y = np.cross(unit, x)
    corners = [points + radius[:, None] * (np.cos(turn) * x + np.sin(turn) * y)
               for turn in 2 * np.pi * np.arange(3) / 3]
    return np.stack(corners, axis=1).reshape(-1, 3), np.arange(3 * len(points)).reshape(-1, 3)
