# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The symmetries of a shape that is known by its centreline, and the tips of a skeleton that break them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

Array = np.ndarray
MOST_TURNS = 8


def candidates() -> Iterator[Array]:
    """Reflections in the plane across z, rotations about z, and reflections in planes through z."""
    yield np.diag([1.0, 1.0, -1.0])
    yield np.diag([1.0, -1.0, 1.0])
    known = {0.0}
    for turns in range(2, MOST_TURNS + 1):
        for k in range(1, turns):
            if (angle := round(k / turns, 9)) not in known:
                known.add(angle)
                c, s = np.cos(2 * np.pi * angle), np.sin(2 * np.pi * angle)
                yield np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
                yield np.array([[c, s, 0], [s, -c, 0], [0, 0, 1]])


def symmetries_of(nodes: Array) -> list[Array]:
    """The candidates that map the nodes (x, y, z, radius) of a centreline to each other."""
    near = 1e-6 * float(np.abs(nodes).max())

    def holds(turn: Array) -> bool:
        images = np.column_stack([nodes[:, :3] @ turn.T, nodes[:, 3]])
        gaps = np.abs(images[:, None] - nodes[None]).max(axis=2)
        return bool((gaps.min(axis=1) < near).all())

    return [turn for turn in candidates() if holds(turn)]


def without_image(tips: Array, maps: list[Array], near: float) -> list[int]:
    """The tips of which some image is no tip: none is nearer than `near`, or that one is another tip's image."""
    alone = []
    for i, tip in enumerate(tips):
        for turn in maps:
            gaps = np.linalg.norm(tips - turn @ tip, axis=1)
            there = int(gaps.argmin())
            back = np.linalg.norm(tips - turn.T @ tips[there], axis=1)
            if gaps[there] > near or int(back.argmin()) != i:
                alone.append(i)
                break
    return alone
