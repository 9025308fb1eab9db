#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times this project beside its peers and prints tables; bench_options.py says what of."""

from __future__ import annotations

import argparse
import datetime
import hashlib
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

from bench_options import parse_arguments
from document import fill_pages, write_docs
from meshes import meshes_in, subdivided
from programs import Program, python_peers, run_interleaved
from studies import STUDIES, study_table
from tables import (
    Rows, contraction_table, host_table, kept_table, quality_table, stages_table, whole_table,
)

ROOT = Path(__file__).resolve().parents[2]
TIMES = {"contraction": contraction_table, "whole": whole_table, "host": host_table,
         "kept": kept_table}
THROUGH_HOST = ("host", "kept")


def machine() -> dict:
    """What the figures depend on besides the code."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [x for x in info.read_text().splitlines() if x.startswith("model name")]
        cpu = names[0].partition(":")[2].strip() if names else cpu
    commit = subprocess.run(
        ["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"],
        capture_output=True, text=True, check=False,
    ).stdout.strip()
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "cpu": cpu,
        "processors": os.cpu_count(),
        "load_before": os.getloadavg()[0],
        "commit": commit,
    }


def jobs(arguments: argparse.Namespace) -> dict[str, list[Program]]:
    """The programs to compare, for each job."""
    own = str(arguments.programs / "mcfskel_cli")
    cgal = str(arguments.programs / "cgal_peer")
    extra = tuple(word for option in arguments.option for word in option.split())
    density = str(arguments.density)
    result: dict[str, list[Program]] = {}
    if arguments.only in (None, "contraction"):
        ours = [
            Program("ours", (own,), ("--no-resample", "--no-refine", *extra), threads=n)
            for n in arguments.threads
        ]
        result["contraction"] = [*ours, Program("cgal", (cgal,))]
        if not arguments.no_peers:
            peers, missing = python_peers()
            result["contraction"] += peers
            for name in missing:
                print(f"{name}: not installed, skipped", file=sys.stderr)
    if arguments.only in (None, "whole"):
        ours = [
            Program("ours", (own,), ("--target-length", density, *extra), threads=n)
            for n in arguments.threads
        ]
        result["whole"] = [*ours, Program("cgal", (cgal,), ("--remesh", density))]
        if arguments.quality:
            options = ("--target-length", density, "--no-refine", *extra)
            result["whole"].append(Program("ours, unrefined", (own,), options, repeats=False))
    job = str(Path(__file__).with_name("host_job.py"))
    hosted = (arguments.host_python, job, str(arguments.plugin))
    if arguments.only == "host" or arguments.host:
        result["host"] = [
            Program("ours", (own,), ("--target-length", density)),
            Program("pymeshlab", hosted, ("--target-length", density)),
        ]
    if arguments.only == "kept" or arguments.host:
        options = ("--target-length", density, "--keep-stages")
        result["kept"] = [
            Program(label, hosted, (*options, keep), threads=n)
            for n in arguments.threads
            for label, keep in (("pymeshlab", "0"), ("pymeshlab, stages kept", "1"))
        ]
    return result


def run_stages(arguments: argparse.Namespace, meshes: list[Path]) -> int:
    command = [str(arguments.programs / "benchmarks"), *map(str, meshes)]
    if arguments.json:
        command += [f"--benchmark_out={arguments.json}", "--benchmark_out_format=json"]
    return subprocess.run(command, check=False).returncode


def run_studies(arguments: argparse.Namespace, meshes: list[Path], folder: Path) -> int:
    names = [name.replace("-", " ") for name in arguments.studies] or list(STUDIES)
    blocks = {}
    for name in names:
        table = study_table(name, arguments.programs / "mcfskel_cli", meshes, folder)
        blocks[f"study {name}"] = table
        print(f"\n{name}\n\n{table}", flush=True)
        if arguments.docs:
            fill_pages(ROOT / "docs", blocks)
    return 0


def folder_name(mesh: Path) -> str:
    """Of a mesh's skeletons: meshes of one name in several folders have one each."""
    return f"{mesh.stem}-{hashlib.sha256(str(mesh.resolve()).encode()).hexdigest()[:8]}"


def main() -> int:
    arguments = parse_arguments()
    work = ROOT / "build" / "bench" / "work"
    meshes = [
        subdivided(mesh, times, work / "meshes") if times else mesh
        for mesh in arguments.meshes or meshes_in(ROOT / "meshes")
        for times in arguments.subdivide
    ]
    if arguments.stages:
        return run_stages(arguments, meshes)
    if arguments.studies is not None:
        return run_studies(arguments, meshes, work / "studies")

    report: dict = {"machine": machine(), "meshes": []}
    everything: dict[str, Rows] = {}
    for job, programs in jobs(arguments).items():
        everything[job] = []
        for mesh in meshes:
            print(f"{job}: {mesh.name}", file=sys.stderr, flush=True)
            folder = work / job / folder_name(mesh)
            runs = arguments.host_runs if job in THROUGH_HOST else arguments.runs
            outcomes = run_interleaved(programs, mesh, folder, runs, arguments.timeout)
            everything[job].append((mesh, outcomes))
            report["meshes"].append(
                {"mesh": mesh.name, "job": job, "programs": [o.as_json() for o in outcomes]}
            )
    tables: dict[str, str] = {}

    def show(title: str, table: str) -> None:
        # Each table when it is there: the measures of quality take minutes.
        tables[title] = table
        print(f"\n{title}\n\n{table}", flush=True)
        if arguments.json:
            arguments.json.write_text(json.dumps(report, indent=1) + "\n")

    for job, rows in everything.items():
        show(job, TIMES[job](rows))
        if job not in THROUGH_HOST:
            show(f"stages of {job}", stages_table(rows))
    if arguments.quality:
        for job, rows in everything.items():
            if job in THROUGH_HOST:
                continue
            table, figures = quality_table(rows)
            report.setdefault("quality", {})[job] = figures
            show(f"quality of {job}", table)
    if arguments.docs:
        write_docs(ROOT / "docs", tables, everything, report["machine"], arguments.density)
    failed = [
        outcome
        for rows in everything.values()
        for _, outcomes in rows
        for outcome in outcomes
        if outcome.error and outcome.program.label.startswith(("ours", "pymeshlab"))
    ]
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
