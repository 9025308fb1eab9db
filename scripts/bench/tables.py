# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the bench, as Markdown, so that they can stand in the docs as they are."""

from __future__ import annotations

import functools
import math
from pathlib import Path

import numpy as np

from curve import read_curve
from programs import RESAMPLING, SKELETON, WHOLE, Outcome
from quality import Shape, measure

Rows = list[tuple[Path, list[Outcome]]]


def markdown(head: list[str], body: list[list[str]]) -> str:
    widths = [max(len(row[i]) for row in [head, *body]) for i in range(len(head))]

    def line(cells: list[str]) -> str:
        first, *rest = (
            cell.ljust(width) if i == 0 else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(cells, widths))
        )
        return "| " + " | ".join([first, *rest]) + " |"

    rule = "|" + "|".join(
        "-" * (w + 2) if i == 0 else "-" * (w + 1) + ":" for i, w in enumerate(widths)
    ) + "|"
    return "\n".join([line(head), rule, *map(line, body)])


def number(value: float | None, digits: int = 3) -> str:
    """So many significant digits, without an exponent."""
    if value is None or not math.isfinite(value):
        return "-"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{min(decimals, 4)}f}"


def count(value: float | None) -> str:
    return "-" if value is None else f"{value:.0f}"


def named(outcomes: list[Outcome], label: str) -> Outcome | None:
    return next((o for o in outcomes if o.program.label == label), None)


def clock_of(outcome: Outcome) -> str:
    """Processor time of one thread does not see what else the machine does; of more than one, it
    would hide what the threads gain."""
    return "cpu" if outcome.program.threads == 1 else "wall"


def cell(outcome: Outcome | None, phases: tuple[str, ...], clock: str) -> str:
    if outcome is None:
        return "-"
    return outcome.error or number(outcome.seconds(phases, clock))


def ratio(theirs: Outcome | None, ours: Outcome, phases: tuple[str, ...], clock: str) -> str:
    if theirs is None or not theirs.reports or not ours.reports:
        return "-"
    return f"{theirs.seconds(phases, clock) / ours.seconds(phases, clock):.1f}"


def contraction_table(rows: Rows) -> str:
    head = ["mesh", "vertices", "threads", "ours s", "CGAL s", "ratio",
            "iterations", "CGAL", "ours MB", "CGAL MB"]
    peers = [name for name in ("pygel", "skeletor") if any(named(o, name) for _, o in rows)]
    body = []
    for mesh, outcomes in rows:
        cgal = named(outcomes, "cgal")
        for ours in (o for o in outcomes if o.program.label == "ours"):
            clock = clock_of(ours)
            body.append([
                mesh.stem, count(ours.median("vertices")), str(ours.program.threads),
                cell(ours, SKELETON, clock), cell(cgal, SKELETON, clock),
                ratio(cgal, ours, SKELETON, clock),
                count(ours.median("iterations")), count(cgal.median("iterations")),
                count(ours.median("peak_mb")), count(cgal.median("peak_mb")),
                *(cell(named(outcomes, name), SKELETON, "wall") for name in peers),
            ])
    return markdown(head + [f"{name} s" for name in peers], body)


def whole_table(rows: Rows) -> str:
    head = ["mesh", "vertices", "CGAL", "threads",
            "resample s", "CGAL", "skeleton s", "CGAL", "all s", "CGAL", "ratio",
            "ours MB", "CGAL MB"]
    body = []
    for mesh, outcomes in rows:
        cgal = named(outcomes, "cgal")
        for ours in (o for o in outcomes if o.program.label == "ours"):
            clock = clock_of(ours)
            body.append([
                mesh.stem, count(ours.median("vertices")), count(cgal.median("vertices")),
                str(ours.program.threads),
                cell(ours, RESAMPLING, clock), cell(cgal, RESAMPLING, clock),
                cell(ours, SKELETON, clock), cell(cgal, SKELETON, clock),
                cell(ours, WHOLE, clock), cell(cgal, WHOLE, clock),
                ratio(cgal, ours, WHOLE, clock),
                count(ours.median("peak_mb")), count(cgal.median("peak_mb")),
            ])
    return markdown(head, body)


def host_table(rows: Rows) -> str:
    """What the same job costs through pymeshlab: copies, layers and attributes.

    The share is taken pair by pair, of a run of the library and the host's run beside it: what slows
    the machine down for seconds slows both. The quartiles tell how far pairs differ.
    """
    head = ["mesh", "library s", "pymeshlab s", "host's share %", "quartiles", "of the fastest %",
            "same skeleton"]
    body = []
    for mesh, outcomes in rows:
        ours, host = named(outcomes, "ours"), named(outcomes, "pymeshlab")
        if ours.error or host.error:
            body.append([mesh.stem, ours.error or "-", host.error or "-", *["-"] * 4])
            continue
        bare, hosted = ours.each(WHOLE, "cpu"), host.each(WHOLE, "cpu")
        shares = [100 * (h - b) / h for b, h in zip(bare, hosted)]
        low, high = np.percentile(shares, [25, 75])
        same = ours.skeleton.read_text() == host.skeleton.read_text()
        body.append([
            mesh.stem, number(np.median(bare)), number(np.median(hosted)),
            f"{np.median(shares):.1f}", f"{low:.1f} to {high:.1f}",
            f"{100 * (min(hosted) - min(bare)) / min(hosted):.1f}", "yes" if same else "no",
        ])
    return markdown(head, body)


def kept_table(rows: Rows) -> str:
    """What it costs to keep all stages, by wall clock, since a thread of its own has a share in it; and
    what MeshLab's own copy of such a stage costs."""
    head = ["mesh", "threads", "stages", "none kept s", "all kept s", "a stage ms", "quartiles",
            "a copy of it ms"]
    body = []
    for mesh, outcomes in rows:
        for none, kept in zip(outcomes[::2], outcomes[1::2]):
            if none.error or kept.error:
                body.append([mesh.stem, str(none.program.threads), none.error or kept.error, *["-"] * 5])
                continue
            without, with_stages = none.each(WHOLE, "wall"), kept.each(WHOLE, "wall")
            more = kept.median("kept") - none.median("kept")
            each = [1000 * (b - a) / more for a, b in zip(without, with_stages)]
            low, high = np.percentile(each, [25, 75])
            body.append([
                mesh.stem, str(kept.program.threads), count(more),
                number(np.median(without)), number(np.median(with_stages)),
                f"{np.median(each):.1f}", f"{low:.1f} to {high:.1f}",
                f"{1000 * kept.median('copy_seconds'):.1f}",
            ])
    return markdown(head, body)


STAGES = {
    "check": "check", "resample": "resample", "poles": "poles", "contraction": "flow",
    "conversion": "collapse", "refine": "refine",
}


def stages_table(rows: Rows) -> str:
    """Where the time of this project's program goes, in milliseconds."""
    head = ["mesh", "vertices", "threads", *(f"{label} ms" for label in STAGES.values())]
    body = []
    for mesh, outcomes in rows:
        for ours in (o for o in outcomes if o.program.label == "ours" and o.reports):
            times = [ours.seconds((stage,), clock_of(ours)) for stage in STAGES]
            body.append([
                mesh.stem, count(ours.median("vertices")), str(ours.program.threads),
                *(number(1000.0 * t, 3) if t > 5e-6 else "-" for t in times),
            ])
    return markdown(head, body)


MEASURES = ("medial", "reconstruction", "turning")


@functools.cache
def shape_and_axis(mesh: Path) -> tuple[Shape, np.ndarray]:
    """The medial axis takes the longest of all, and both jobs have the same meshes."""
    shape = Shape.read(mesh)
    return shape, shape.medial_axis()


def quality_table(rows: Rows) -> tuple[str, dict]:
    """The table, and all measures by mesh and program."""

    head = ["mesh", "program", "components", "cycles (genus)", "inside", "tips", "junctions",
            "spurs", "medial %", "reconstruction %", "turning deg"]
    body, figures = [], {}
    for mesh, outcomes in rows:
        shape, axis = shape_and_axis(mesh)
        results = figures[mesh.stem] = {}
        for outcome in outcomes:
            if outcome.error or outcome.program.label in results:
                continue
            result = measure(shape, axis, read_curve(outcome.skeleton))
            results[outcome.program.label] = result
            body.append([
                mesh.stem, outcome.program.label, str(result["components"]),
                f"{result['cycles']} ({result['genus']})", number(result["inside"], 5),
                str(result["tips"]), str(result["junctions"]), str(result["spurs"]),
                *(number(result[name]) for name in MEASURES),
            ])
    summary = quotients_table(figures)
    return markdown(head, body) + (f"\n\n{summary}" if summary else ""), figures


def quotients_table(figures: dict) -> str:
    """How this project's measures compare with CGAL's, over all meshes; less is better."""
    body = []
    for label in ("ours", "ours, unrefined"):
        cells = [label]
        for name in MEASURES:
            quotients = [
                (results[label][name] / results["cgal"][name], mesh)
                for mesh, results in figures.items()
                if label in results and "cgal" in results
                and results[label][name] and results["cgal"][name]
            ]
            if not quotients:
                break
            mean = math.exp(sum(math.log(q) for q, _ in quotients) / len(quotients))
            worst, where = max(quotients)
            cells.append(f"{mean:.2f} ({worst:.2f}, {where})")
        else:
            body.append(cells)
    if not body:
        return ""
    head = ["quotient to CGAL: geometric mean (worst)", *MEASURES]
    return markdown(head, body)
