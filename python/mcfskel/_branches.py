# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The branches of a graph."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def branches(count: int, edges: npt.NDArray[np.int64]) -> list[npt.NDArray[np.int64]]:
    """The chains of nodes between nodes of degree other than 2, each once, then the free cycles.

    A cycle ends with the node that it begins with. A node without edges is no branch. The order is that
    of the nodes at which they begin; each begins at the lower of its ends. Complexity: O(N + E).
    """
    neighbours: list[list[int]] = [[] for _ in range(count)]
    for a, b in edges.tolist():
        neighbours[a].append(b)
        neighbours[b].append(a)
    for others in neighbours:
        others.sort()
    used: set[tuple[int, int]] = set()
    found = []

    def walk(start: int, following: int) -> None:
        if (start, following) in used:
            return
        chain = [start, following]
        used.update([(start, following), (following, start)])
        while len(neighbours[chain[-1]]) == 2 and chain[-1] != start:
            a, b = neighbours[chain[-1]]
            chain.append(b if a == chain[-2] else a)
            used.update([(chain[-2], chain[-1]), (chain[-1], chain[-2])])
        found.append(np.array(chain, np.int64))

    for node in range(count):
        if len(neighbours[node]) != 2:
            for other in neighbours[node]:
                walk(node, other)
    for node in range(count):
        if len(neighbours[node]) == 2:
            walk(node, neighbours[node][0])
    return found
