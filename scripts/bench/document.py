# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the results of the bench into docs/performance.md and docs/quality.md.

Each result has its place there between two comments, `<!-- bench: NAME -->` and `<!-- end -->`;
what stands around them is written by hand and stays.
"""

from __future__ import annotations

import re
from pathlib import Path

from programs import SKELETON
from tables import Rows


def write_docs(
    docs: Path, tables: dict[str, str], rows: dict[str, Rows], machine: dict, density: float
) -> None:
    blocks = {**tables, "machine": describe(machine, density)}
    if "contraction" in rows and sizes(rows["contraction"]) > 1:
        plot_growth(rows["contraction"], docs / "growth.png")
        blocks["growth"] = "![Seconds against vertices](growth.png)"
    fill_pages(docs, blocks)


def fill_pages(docs: Path, blocks: dict[str, str]) -> None:
    for name in ("performance.md", "quality.md"):
        page = docs / name
        page.write_text(fill(page.read_text(), blocks))


def fill(page: str, blocks: dict[str, str]) -> str:
    """Replaces what is between the marks of each block that is given; others stay."""

    def replaced(match: re.Match[str]) -> str:
        block = blocks.get(match["name"])
        return match[0] if block is None else f"{match['begin']}\n\n{block}\n\n<!-- end -->"

    marks = r"(?P<begin><!-- bench: (?P<name>[^>]*?) -->).*?<!-- end -->"
    return re.sub(marks, replaced, page, flags=re.DOTALL)


def describe(machine: dict, density: float) -> str:
    return (
        f"Measured on {machine['date'][:10]}: {machine['cpu']}, {machine['processors']} "
        f"processors, load {machine['load_before']:.1f} before the start, commit "
        f"{machine['commit'] or 'unknown'}. Resampled to edges of {density:g} % of the diagonal "
        "in the whole job."
    )


def sizes(rows: Rows) -> int:
    return len({o.median("vertices") for _, outcomes in rows for o in outcomes if o.reports})


def plot_growth(rows: Rows, path: Path) -> None:
    """Seconds of the contraction against the number of vertices, both logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    points: dict[str, list[tuple[float, float]]] = {}
    for _, outcomes in rows:
        for outcome in outcomes:
            if outcome.reports and outcome.program.threads in (0, 1):
                clock = "cpu" if outcome.program.threads else "wall"
                points.setdefault(outcome.program.label, []).append(
                    (outcome.median("vertices"), outcome.seconds(SKELETON, clock))
                )
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for label, marker in (("ours", "o"), ("cgal", "s"), ("pygel", "^"), ("skeletor", "v")):
        if label in points:
            vertices, seconds = zip(*sorted(points[label]))
            axes.loglog(vertices, seconds, marker, label=label)
    if "ours" in points:
        first, last = min(points["ours"]), max(points["ours"])
        axes.loglog(
            [first[0], last[0]], [first[1], first[1] * last[0] / first[0]],
            ":", color="grey", label="linear growth",
        )
    axes.set_xlabel("vertices")
    axes.set_ylabel("seconds, poles to curve")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
