# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is tabulated of the branches of centrelines, airways, vessels and neurons."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _sections
from ._run import SkeletonError

if TYPE_CHECKING:
    from ._skeleton import Skeleton


def branch_measures(skeleton: Skeleton, sections: int) -> dict[str, np.ndarray]:
    if not isinstance(sections, (int, np.integer)) or isinstance(sections, bool) or sections < 0:
        raise SkeletonError(f"sections={sections!r} is no whole number of at least 0.")
    rows = [_measures(skeleton, branch) for branch in skeleton.branches]
    names = ("first", "last", "length", "chord", "tortuosity", "curvature", "torsion", "radius_min",
             "radius_mean", "radius_max", "significance")
    table = {name: np.array([row[name] for row in rows]) for name in names}
    table["angle_first"], table["angle_last"] = _angles(skeleton)
    table["strahler"] = _strahler(skeleton)
    cuts = [_sections.branch_sections(skeleton, branch, sections) for branch in skeleton.branches]
    for k, name in enumerate(_sections.NAMES):
        table[name] = np.array([np.mean([cut[k] for cut in found]) if found else np.nan for found in cuts])
    return table


def _measures(skeleton: Skeleton, branch: np.ndarray) -> dict[str, float]:
    points, radius = skeleton.nodes[branch], skeleton.radius[branch]
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    length, chord = lengths.sum(), np.linalg.norm(points[-1] - points[0])
    ways = steps[lengths > 0] / lengths[lengths > 0, None]
    if branch[0] == branch[-1] and skeleton.degree[branch[0]] == 2:
        ways = np.vstack([ways, ways[:2]])  # a free cycle bends and twists where it closes, too
        bends = slice(None, -1)
    else:
        bends = slice(None)
    normals = np.cross(ways[:-1], ways[1:])
    turns = np.arctan2(np.linalg.norm(normals, axis=1)[bends],
                       np.einsum("ij,ij->i", ways[:-1], ways[1:])[bends])
    return {"first": branch[0], "last": branch[-1], "length": length, "chord": chord,
            "tortuosity": length / chord - 1 if chord > 0 else np.inf,
            "curvature": turns.sum() / length if length > 0 else 0.0,
            "torsion": _twists(ways, normals).sum() / length if length > 0 else 0.0,
            "significance": skeleton.significance[branch].min() if len(skeleton.significance) else np.nan,
            "radius_min": radius.min(), "radius_max": radius.max(),
            "radius_mean": np.average((radius[1:] + radius[:-1]) / 2, weights=lengths)
                           if length > 0 else radius.mean()}


def _twists(ways: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The angles between the planes of successive turns, about the steps that they share."""
    sines = np.einsum("ij,ij->i", np.cross(normals[:-1], normals[1:]), ways[1:-1])
    return np.arctan2(sines, np.einsum("ij,ij->i", normals[:-1], normals[1:]))


def _angles(skeleton: Skeleton) -> tuple[np.ndarray, np.ndarray]:
    """For the first and the last end of each branch the smallest angle to another branch there."""
    leaving: dict[int, list[tuple[int, int, np.ndarray]]] = {}
    for number, branch in enumerate(skeleton.branches):
        for end, chain in enumerate((branch, branch[::-1])):
            leaving.setdefault(int(chain[0]), []).append((number, end, _direction(skeleton, chain)))
    angles = np.full((2, len(skeleton.branches)), np.nan)
    for node, ends in leaving.items():
        if skeleton.degree[node] < 3:
            continue
        ways = np.array([way for _, _, way in ends])
        cosines = ways @ ways.T
        np.fill_diagonal(cosines, -2)
        smallest = np.degrees(np.arccos(np.clip(cosines.max(axis=1), -1, 1)))
        for (number, end, _), angle in zip(ends, smallest):
            angles[end, number] = angle
    return angles[0], angles[1]


def _direction(skeleton: Skeleton, chain: np.ndarray) -> np.ndarray:
    """From the first node to the point where the branch leaves the ball around it, or to its end."""
    offsets = skeleton.nodes[chain] - skeleton.nodes[chain[0]]
    distances = np.linalg.norm(offsets, axis=1)
    outside = np.flatnonzero(distances > skeleton.radius[chain[0]])
    at = outside[0] if len(outside) else int(distances.argmax())
    return offsets[at] / distances[at] if distances[at] > 0 else np.zeros(3)


def _strahler(skeleton: Skeleton) -> np.ndarray:
    """The order of each branch (Strahler 1957), the components rooted at their thickest node."""
    at_node: dict[int, list[int]] = {}
    for number, branch in enumerate(skeleton.branches):
        for node in {int(branch[0]), int(branch[-1])}:
            at_node.setdefault(node, []).append(number)
    order = np.zeros(len(skeleton.branches), np.int64)
    seen: set[int] = set()
    for start in at_node:
        if start in seen:
            continue
        found, numbers, queue = {start}, set(), [start]
        while queue:
            for number in at_node[queue.pop()]:
                numbers.add(number)
                for node in map(int, skeleton.branches[number][[0, -1]]):
                    if node not in found:
                        found.add(node)
                        queue.append(node)
        seen |= found
        if len(numbers) != len(found) - 1:
            continue  # a cycle has no order: 0
        # The root is an end of a branch, so that no branch is divided: the thickest of the ends.
        root = max(sorted(found), key=lambda node: skeleton.radius[node])
        walk, way = [(root, -1)], []
        while walk:
            node, above = walk.pop()
            for number in at_node[node]:
                if number != above:
                    first, last = map(int, skeleton.branches[number][[0, -1]])
                    other = last if first == node else first
                    way.append((number, other))
                    walk.append((other, number))
        for number, end in reversed(way):
            above = sorted((order[k] for k in at_node[end] if k != number), reverse=True)
            if not above:
                order[number] = 1
            else:
                order[number] = above[0] + (len(above) > 1 and above[1] == above[0])
    return order
