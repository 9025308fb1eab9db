# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of voxels and of points with normals, before anything is made of them."""

import gzip
import importlib.util
import sys

import numpy as np
import pytest

from conftest import ROOT
from hostile.primitives import genus, is_two_manifold, signed_volume

SPEC = importlib.util.spec_from_file_location("mcfskel_volumes", ROOT / "python" / "mcfskel" / "_volumes.py")
volumes = importlib.util.module_from_spec(SPEC)
sys.modules[SPEC.name] = volumes
SPEC.loader.exec_module(volumes)


def torus() -> np.ndarray:
    """How deep each voxel of 30 x 30 x 20 is in a torus."""
    x, y, z = np.indices((30, 30, 20)) - np.array([14.5, 14.5, 9.5])[:, None, None, None]
    return 3.7 - np.hypot(np.hypot(x, y) - 9, z)


def test_truth_values_and_numbers_have_the_surface_of_their_solid():
    exact = 2 * np.pi**2 * 9 * 3.7**2
    for values, level, near in [(torus() > 0, 0.5, 0.05), (torus(), 0, 0.04)]:
        mesh = volumes.voxel_surface(volumes.volume_of(values, 0.5), level)
        assert is_two_manifold(mesh) and genus(mesh) == 1
        assert signed_volume(mesh) == pytest.approx(exact / 8, rel=near)
        assert mesh[0].mean(axis=0) == pytest.approx([7.25, 7.25, 4.75], abs=0.05)


def test_a_solid_that_fills_the_array_is_closed():
    for values in (np.ones((2, 3, 4), bool), np.full((2, 3, 4), 2.0)):
        vertices, faces = volumes.voxel_surface(volumes.volume_of(values))
        assert is_two_manifold((vertices, faces)) and genus((vertices, faces)) == 0
        assert signed_volume((vertices, faces)) > 6


@pytest.mark.parametrize("encoding", ["raw", "gzip"])
def test_nrrd_says_where_voxels_are(tmp_path, encoding):
    """Mirrored axes, too: the surface still faces outward."""
    path = tmp_path / "torus.nrrd"
    data = (torus() > 0).astype(">u2").tobytes(order="F")
    path.write_bytes(b"NRRD0004\n# a torus\ntype: unsigned short\ndimension: 3\nsizes: 30 30 20\nendian: big\n"
                     b"space directions: (-0.5,0,0) (0,0.5,0) (0,0,1)\nspace origin: (7.25, -7.25, -9.5)\n"
                     + f"encoding: {encoding}\n\n".encode() + (gzip.compress(data) if encoding == "gzip" else data))
    volume = volumes.read_volume(path)
    assert np.array_equal(volume.values > 0, torus() > 0)
    vertices, faces = volumes.voxel_surface(volume)
    assert signed_volume((vertices, faces)) > 0 and genus((vertices, faces)) == 1
    assert vertices.mean(axis=0) == pytest.approx([0, 0, 0], abs=0.05)
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(ValueError, match="damaged|fewer"):
        volumes.read_volume(path)


def test_a_spacing_keeps_the_directions_of_the_axes(tmp_path):
    path = tmp_path / "box.nrrd"
    path.write_bytes(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n"
                     b"space directions: (-0.5,0,0)  (0, 0, 0.5) (0,1,0)\nspace origin: (7, 8, 9)\n\n" + bytes(24))
    volume = volumes.read_volume(path, (1, 2, 3))
    assert volume.directions.tolist() == [[-1, 0, 0], [0, 0, 2], [0, 3, 0]]
    assert volume.origin.tolist() == [7, 8, 9]


def test_files_that_are_damaged_are_told(tmp_path):
    (tmp_path / "half.npz").write_bytes(b"PK\x03\x04" + bytes(50))
    np.savez(tmp_path / "none.npz", spacing=1)
    np.savez_compressed(tmp_path / "torus.npz", volume=torus())
    content = bytearray((tmp_path / "torus.npz").read_bytes())
    content[len(content) // 2] ^= 0xff
    (tmp_path / "torus.npz").write_bytes(content)
    (tmp_path / "skip.nrrd").write_bytes(b"NRRD0004\ntype: uchar\nsizes: 1 1 1\nencoding: raw\nbyte skip: 4\n\n12345")
    for name, said in [("half", "no array of numpy"), ("none", "none of its arrays is named volume: spacing"),
                       ("torus", "no array of numpy")]:
        with pytest.raises(ValueError, match=said):
            volumes.read_volume(tmp_path / f"{name}.npz")
    with pytest.raises(ValueError, match="byte skip"):
        volumes.read_volume(tmp_path / "skip.nrrd")


@pytest.mark.parametrize("wrong, said", [
    (lambda: volumes.volume_of(np.zeros((3, 3))), "three axes"),
    (lambda: volumes.volume_of(np.zeros((3, 3, 3)), 0), "positive"),
    (lambda: volumes.volume_of(np.zeros((3, 3, 3)), (1, 2)), "three axes"),
    (lambda: volumes.voxel_surface(volumes.volume_of(np.zeros((3, 3, 3)))), "above the level"),
    (lambda: volumes.voxel_surface(volumes.volume_of(np.full((3, 3, 3), np.nan))), "finite"),
    (lambda: volumes.point_triangles(np.zeros((50, 3)), np.zeros((50, 3))), "no length"),
    (lambda: volumes.point_triangles(np.zeros((5, 3)), np.ones((5, 3))), "too few"),
    (lambda: volumes.point_triangles(np.zeros((5, 3)), np.ones((6, 3))), "shape")])
def test_errors_say_what(wrong, said):
    with pytest.raises(ValueError, match=said):
        wrong()


def test_triangles_of_points_face_outward_and_cover_the_surface():
    points = np.random.default_rng(1).normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    vertices, faces = volumes.point_triangles(points, 7 * points)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    assert np.allclose((a + b + c) / 3, points)
    across = np.cross(b - a, c - a) / 2
    assert ((across * points).sum(axis=1) > 0).all()
    assert 1.5 < np.linalg.norm(across, axis=1).sum() / (4 * np.pi) < 3.5
