#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scores programs on surfaces whose skeletons are known; benchmark_options.py says how it is called."""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmark_options import PARTS, parse_arguments
from contenders import Made, another, known, make_skeleton, skeleton_in
from curve import read_curve
from studies import table
from surfaces import Entry, generate, read_set
from truth import Score, read_truth, score


class Result(NamedTuple):
    """What a program made of one surface; no score where it failed."""

    entry: Entry
    score: Score | None
    seconds: float | None
    error: str


HEAD = ["program", "surfaces", "failed", "graph right, %", "tips found, %", "false tips, each",
        "to truth, %", "in radii", "from truth, %", "in radii", "outside, %", "radius error, %",
        "same graph, % of shapes", "same tips, %", "s"]


def result_of(entry: Entry, made: Made, folder: Path) -> Result:
    if made.file is None:
        return Result(entry, None, None, made.error)
    try:
        curve = read_curve(made.file).joined()
    except (OSError, ValueError, IndexError, KeyError) as error:
        return Result(entry, None, made.seconds, f"its file cannot be read: {error}")
    if not len(curve.simple_edges):
        return Result(entry, None, made.seconds, "no edges")
    return Result(entry, score(read_truth(folder / f"{entry.name}.npz"), curve), made.seconds, "")


def figure(values: list[float], digits: int = 3) -> str:
    """Median and 95th percentile."""
    known_values = [v for v in values if not np.isnan(v)]
    if not known_values:
        return "-"
    return f"{np.median(known_values):.{digits}f} ({np.percentile(known_values, 95):.{digits}f})"


def stability(results: list[Result]) -> tuple[float, float]:
    """The part of the shapes whose surfaces all have the same graph, and the part of the true tips that are found on
    all surfaces or on none."""
    by_shape: dict[str, list[Score | None]] = defaultdict(list)
    for result in results:
        by_shape[result.entry.shape].append(result.score)
    asked = {result.entry.shape: result.entry.tips for result in results}
    same, tips, stable = 0, 0, 0
    for shape, scores in by_shape.items():
        graphs = {s and (s.components, s.cycles, s.tips, s.junctions) for s in scores}
        same += len(graphs) == 1 and None not in graphs
        found = [set(s.tips_found) if s else set() for s in scores]
        tips += asked[shape]
        stable += asked[shape] - len(set.union(*found) - set.intersection(*found))
    return same / len(by_shape), stable / tips if tips else float("nan")


def row(name: str, results: list[Result]) -> list[str]:
    scores = [r.score for r in results if r.score]
    asked = sum(r.entry.tips for r in results)
    same, stable = stability(results)
    lost = len(results) - len(scores)
    seconds = [r.seconds for r in results if r.score and r.seconds is not None]
    return [
        name, str(len(results)), str(lost),
        f"{100 * sum(s.graph_is_right for s in scores) / len(results):.0f}",
        f"{100 * sum(len(s.tips_found) for s in scores) / asked:.1f}" if asked else "-",
        f"{np.mean([s.tips_false for s in scores]):.2f}" if scores else "-",
        figure([100 * s.to_truth for s in scores]), figure([s.to_truth_radii for s in scores]),
        figure([100 * s.from_truth for s in scores]), figure([s.from_truth_radii for s in scores]),
        figure([100 * s.outside for s in scores], 1), figure([100 * s.radius_error for s in scores], 1),
        f"{100 * same:.0f}", "-" if np.isnan(stable) else f"{100 * stable:.0f}", figure(seconds, 1),
    ]


def write_csv(file: Path, everything: dict[str, list[Result]]) -> None:
    with open(file, "w", newline="") as out:
        writer = None
        for name, results in everything.items():
            for r in results:
                values = asdict(r.score) if r.score else {}
                line = {"program": name, **asdict(r.entry), "seconds": r.seconds, "error": r.error,
                        **{k: values.get(k) for k in Score.__dataclass_fields__}}
                if writer is None:
                    writer = csv.DictWriter(out, line)
                    writer.writeheader()
                writer.writerow(line)


def main() -> int:
    arguments = parse_arguments()
    folder = arguments.folder
    entries = read_set(folder)
    missing = [f for f in arguments.families if f not in {e.family for e in entries}]
    if missing:
        entries = generate(folder, entries, missing)
    if arguments.generate:
        print(f"{len(entries)} surfaces of {len({e.shape for e in entries})} shapes")
        return 0
    entries = [e for e in entries if e.family in arguments.families and arguments.part in (None, e.part)]
    everything: dict[str, list[Result]] = {}

    def run(name: str, make: Callable[[Entry], Made]) -> None:
        print(f"{name}: {len(entries)} surfaces", file=sys.stderr, flush=True)
        with ThreadPoolExecutor(arguments.jobs) as pool:
            made = list(pool.map(make, entries))
        everything[name] = [result_of(e, m, folder) for e, m in zip(entries, made)]

    contenders = [known(name, arguments.bench_programs, arguments.vmtk_python) for name in arguments.programs]
    for name, contender in zip(arguments.programs, contenders):
        if contender is None:
            print(f"{name}: not installed, skipped", file=sys.stderr)
    contenders += [another(name, command) for name, command in arguments.program]
    for contender in filter(None, contenders):
        place = folder / "skeletons" / contender.name
        run(contender.name, lambda e, c=contender, p=place: make_skeleton(
            c, folder / f"{e.name}.off", p, arguments.timeout))
    for name, place in arguments.results:
        run(name, lambda e, p=Path(place): skeleton_in(p, e.name))
    for part in PARTS:
        show(part, {name: [r for r in results if r.entry.part == part] for name, results in everything.items()},
             arguments.by)
    if arguments.csv:
        write_csv(arguments.csv, everything)
    return 0


def show(part: str, everything: dict[str, list[Result]], by: str | None) -> None:
    """Prints the table of one part, and one for each family or variant in it."""
    groups: dict[str, dict[str, list[Result]]] = {f"part to {part} on": everything}
    if by:
        keys = sorted({getattr(r.entry, by) for results in everything.values() for r in results})
        for key in keys:
            groups[f"{part}: {key}"] = {
                name: [r for r in results if getattr(r.entry, by) == key] for name, results in everything.items()}
    for title, group in groups.items():
        rows = [row(name, results) for name, results in group.items() if results]
        if rows:
            print(f"\n{title}\n\n{table(HEAD, rows)}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
