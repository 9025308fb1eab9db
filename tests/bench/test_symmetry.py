# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetries of known centrelines, and tips that break them."""

from __future__ import annotations

import numpy as np
import pytest
from symmetry import symmetries_of, without_image


def arms(count: int, aside: float = 0.0) -> np.ndarray:
    """Nodes (x, y, z, radius) of arms around z, each bent by `aside`."""
    angles = 2 * np.pi * np.arange(count) / count
    return np.array([[0, 0, 0, 1], *([r * np.cos(a + aside * r), r * np.sin(a + aside * r), 0.3 * r, 0.1]
                                     for a in angles for r in (1.0, 2.0))])


@pytest.mark.parametrize("count", range(2, 9))
def test_of_arms_around_an_axis(count):
    # Rotations and planes through the axis; without planes where the arms are bent to one side.
    assert len(symmetries_of(arms(count))) == 2 * count - 1
    assert len(symmetries_of(arms(count, 0.2))) == count - 1


def test_radii_count():
    nodes = arms(4)
    nodes[2, 3] = 0.2
    assert len(symmetries_of(nodes)) == 1  # the plane through that arm


def test_a_tip_too_few_and_one_too_many():
    nodes = arms(4)
    tips, maps = nodes[2::2, :3], symmetries_of(nodes)
    assert without_image(tips, maps, 0.1) == []
    assert without_image(tips[:3], maps, 0.1) == [0, 1, 2]
    assert without_image(np.vstack([tips, tips[0] + [0.05, 0, 0]]), maps, 0.1) != []
    assert without_image(tips, [], 0.1) == []
