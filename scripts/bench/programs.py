# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs that are compared: how each is called, and what its report says."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

# Phases of the reports, by what they belong to; reading files is in none of them.
RESAMPLING = ("resample",)
SKELETON = ("poles", "construct", "contraction", "conversion", "refine", "skeleton")
WHOLE = ("check", *RESAMPLING, *SKELETON)


@dataclass(frozen=True)
class Program:
    """One way to get a skeleton.

    label: its name in tables; command: called with the mesh and `--skeleton FILE` appended;
    threads: what it may use, 0 where that is not ours to say; repeats: whether it is run as
    often as asked for, or once, being a column that is nice to have.
    """

    label: str
    command: tuple[str, ...]
    options: tuple[str, ...] = ()
    threads: int = 1
    repeats: bool = True


@dataclass
class Outcome:
    """What the runs of one program on one mesh gave: its reports, or why there are none."""

    program: Program
    skeleton: Path
    reports: list[dict] = field(default_factory=list)
    error: str = ""

    def seconds(self, phases: tuple[str, ...], clock: str) -> float | None:
        """Median over the runs; clock: "cpu" for processor time, "wall" for wall time."""
        return statistics.median(self.each(phases, clock)) if self.reports else None

    def each(self, phases: tuple[str, ...], clock: str) -> list[float]:
        """Seconds of each run."""
        return [
            sum(r["seconds"][phase][clock] for phase in phases if phase in r["seconds"])
            for r in self.reports
        ]

    def median(self, key: str) -> float | None:
        values = [r[key] for r in self.reports if r.get(key) is not None]
        return statistics.median(values) if values else None

    def as_json(self) -> dict:
        return {
            "program": self.program.label,
            "threads": self.program.threads,
            "options": list(self.program.options),
            "seconds": {
                job: {clock: self.seconds(phases, clock) for clock in ("cpu", "wall")}
                for job, phases in (
                    ("resampling", RESAMPLING), ("skeleton", SKELETON), ("whole", WHOLE)
                )
            },
            "reports": self.reports,
            "error": self.error,
        }


def run_once(program: Program, mesh: Path, outcome: Outcome, timeout: float) -> None:
    """Appends a report to the outcome, or sets its error."""
    command = [*program.command, str(mesh), "--skeleton", str(outcome.skeleton), *program.options]
    environment = dict(os.environ)
    if program.threads:
        environment["OMP_NUM_THREADS"] = str(program.threads)
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=timeout, check=False
        )
    except subprocess.TimeoutExpired:
        outcome.error = f"more than {timeout:g} s"
        return
    if done.returncode:
        last = (done.stderr.strip() or f"exit status {done.returncode}").splitlines()[-1]
        outcome.error = last
        return
    # The last line: a peer's library may print lines of its own.
    outcome.reports.append(json.loads(done.stdout.strip().splitlines()[-1]))


def run_interleaved(
    programs: list[Program], mesh: Path, folder: Path, runs: int, timeout: float
) -> list[Outcome]:
    """Runs all programs in turn, so that what else the machine does hits all of them alike.

    Every second turn is in reverse: none of them always comes after the same other one.
    """
    folder.mkdir(parents=True, exist_ok=True)
    outcomes = [
        Outcome(p, folder / f"{p.label}_{p.threads}.obj".replace(" ", "_")) for p in programs
    ]
    for turn in range(runs):
        for outcome in outcomes if turn % 2 == 0 else reversed(outcomes):
            if outcome.error or (turn > 0 and not outcome.program.repeats):
                continue
            run_once(outcome.program, mesh, outcome, timeout)
    return outcomes


def python_peers() -> tuple[list[Program], list[str]]:
    """The peers from PyPI that are installed, and the names of those that are not."""
    peers, missing = [], []
    script = str(Path(__file__).with_name("peers.py"))
    for label, module in (("pygel", "pygel3d"), ("skeletor", "skeletor")):
        # In a process of its own: importing PyGEL loads a library that prints and starts threads.
        found = subprocess.run(
            [sys.executable, "-c", f"import {module}"], capture_output=True, check=False
        )
        if found.returncode == 0:
            command = (sys.executable, script, label)
            peers.append(Program(label, command, threads=0, repeats=False))
        else:
            missing.append(label)
    return peers, missing
