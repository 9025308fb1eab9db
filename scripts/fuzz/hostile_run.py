# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs whole jobs on hostile meshes in limited processes, and judges what comes of them.

Each mesh of tests/hostile comes with the answer that it must get. It goes through the job raw (as it is,
unrefined) with the tools on its result; every other one through the default job, the others through the
stages one by one and sheets or Resample. With --full each mesh goes through all of them, and through
poles by Voronoi cells, sheets on the resampled surface, measures and balls. Each filter has 20 seconds of
one core and 2 GB. A failing case is reduced and saved. Exit status 1 if there is one.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import select
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from hostile import FAMILIES, Hostile, drawn, make
from hostile_cases import write_case
from hostile_reduce import Reduction

HERE = Path(__file__).resolve().parent


SECONDS = 20.0
MEGABYTES = 2048
# A process that sleeps uses no time of a core: it is stuck after this many seconds by the clock without any.
WALL_SECONDS = 300.0
# A worker is replaced after so many meshes, or when it holds so much.
MESHES_PER_WORKER = 40
WORKER_MEGABYTES = 900

JOBS = ["default", "raw", "sheets", "steps", "resample", "voronoi", "sheets_default"]
# In a quick run each mesh goes through the first, and in turn through these besides.
QUICK_JOB = "raw"
QUICK_IN_TURN = [["default"], ["sheets", "steps"], ["default"], ["resample", "steps"]]
FAILURES = ["crash", "hang", "memory", "explosion", "outside", "topology", "not finite", "accepted",
            "good refused", "document changed", "bad message", "wrong"]


class Worker:
    """A process that runs jobs, and the watch over it."""

    def __init__(self, plugin: Path, seconds: float = SECONDS, megabytes: int = MEGABYTES) -> None:
        self.plugin, self.seconds, self.megabytes = plugin, seconds, megabytes
        self.process: subprocess.Popen[bytes] | None = None
        self.meshes = 0
        self.pending = b""

    def start(self) -> None:
        environment = dict(os.environ, OMP_NUM_THREADS="1", QT_QPA_PLATFORM="offscreen",
                           OPENBLAS_NUM_THREADS="1", MALLOC_ARENA_MAX="2", PYTHONDONTWRITEBYTECODE="1")
        self.process = subprocess.Popen(
            [sys.executable, str(HERE / "hostile_worker.py"), str(self.plugin), str(self.megabytes)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        os.set_blocking(self.process.stderr.fileno(), False)
        self.meshes, self.pending = 0, b""

    def stop(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
                stream.close()
            self.process = None

    def cpu_seconds(self) -> float:
        try:
            fields = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        except (OSError, IndexError):
            return 0.0
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def lines(self, wait: float) -> list[dict[str, Any]] | None:
        """The answers that have come; None if the process has ended."""
        ready, _, _ = select.select([self.process.stdout], [], [], wait)
        if ready:
            data = os.read(self.process.stdout.fileno(), 1 << 16)
            if not data:
                return None
            self.pending += data
        *whole, self.pending = self.pending.split(b"\n")
        return [json.loads(line) for line in whole]

    def run(self, order: dict[str, Any]) -> list[dict[str, Any]]:
        """All steps of all jobs on one mesh, those that ended the process included."""
        ends: list[dict[str, Any]] = []
        skip: list[str] = []
        jobs = list(order["jobs"])
        while jobs:
            if self.process is None:
                self.start()
            self.process.stdin.write((json.dumps(dict(order, jobs=jobs, skip=skip)) + "\n").encode())
            self.process.stdin.flush()
            self.meshes += 1
            failure, step = self._watch(ends)
            if failure is None:
                break
            self.stop()
            if step is None:  # it has not come as far as a filter
                ends.append({"end": "start", "outcome": "failed", "findings": [failure], "seconds": 0.0,
                             "error": None})
                break
            ends.append({"end": step, "outcome": "failed", "findings": [failure], "seconds": 0.0,
                         "error": None})
            skip.append(step)
            # Go on with that job only where steps may follow that do not need the one that failed.
            job = step.split("/")[0]
            jobs = jobs[jobs.index(job) + (0 if "/" in step else 1):]
            seen = {end["end"] for end in ends}
            skip = sorted(set(skip) | {s for s in seen if s.split("/")[0] == job and "/" in s
                                       and job == "raw"})
        if self.process is not None and self.meshes >= MESHES_PER_WORKER:
            self.stop()
        return ends

    def _watch(self, ends: list[dict[str, Any]]) -> tuple[tuple[str, str] | None, str | None]:
        """Collects answers until the mesh is done; else says what happened, and in which step."""
        step, running = None, False
        begin_cpu = worked = 0.0
        last = busy = time.monotonic()
        while True:
            messages = self.lines(0.25)
            if messages is None:
                self.process.wait()
                code = self.process.returncode
                said = (self.process.stderr.read() or b"").decode(errors="replace").strip()
                kind = "memory" if "bad_alloc" in said or "MemoryError" in said else "crash"
                if "Traceback" in said and kind == "crash":
                    raise RuntimeError(f"the worker's own error: {said}")
                return (kind, f"exit status {code}: {said[-400:]}"), step
            for message in messages:
                last = time.monotonic()
                if "begin" in message:
                    step, running = message["begin"], True
                    begin_cpu = worked = self.cpu_seconds()
                    busy = last
                elif "judging" in message:
                    running = False
                elif "end" in message:
                    if all(end["end"] != message["end"] for end in ends):  # or it has been run again
                        ends.append(message)
                    if any(kind == "memory" for kind, _ in message["findings"]):
                        self.meshes = MESHES_PER_WORKER
                elif "done" in message:
                    if message["memory"] > WORKER_MEGABYTES:
                        self.meshes = MESHES_PER_WORKER
                    return None, None
            try:
                self.process.stderr.read()
            except (BlockingIOError, ValueError):
                pass
            if running and (used := self.cpu_seconds()) > worked:
                worked, busy = used, time.monotonic()
            if running and (worked - begin_cpu > self.seconds or time.monotonic() - busy > WALL_SECONDS):
                return ("hang", f"more than {self.seconds:g} s"), step
            if not running and time.monotonic() - last > WALL_SECONDS:
                return ("wrong", "the judge did not come to an end"), step


def run_meshes(plugin: Path, meshes: list[tuple[str, int]], jobs: list[str] | None, full: bool,
               workers: int, budget: float | None = None,
               log: Path | None = None) -> list[dict[str, Any]]:
    """Runs the jobs on all meshes; results in the order of the meshes.

    jobs    by name; None: the quick ones, or all of them if `full`.
    budget  seconds after which no further mesh is begun.
    log     each result is added to this file, one line each, as soon as it is there.
    """
    waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
    for i in range(len(meshes)):
        waiting.put(i)
    results: list[dict[str, Any] | None] = [None] * len(meshes)
    started = time.monotonic()
    lock = threading.Lock()
    done = [0, 0]

    def work() -> None:
        worker = Worker(plugin)
        try:
            while budget is None or time.monotonic() - started < budget:
                try:
                    i = waiting.get_nowait()
                except queue.Empty:
                    return
                family, seed = meshes[i]
                steps = worker.run({"family": family, "seed": seed, "full": full, "jobs": jobs or (
                    JOBS if full else [QUICK_JOB, *QUICK_IN_TURN[(i + i // len(FAMILIES)) % 4]])})
                results[i] = {"family": family, "seed": seed, "steps": steps}
                with lock:
                    done[0] += 1
                    done[1] += bool(failures(results[i]))
                    if log is not None:
                        with log.open("a") as file:
                            file.write(json.dumps(results[i]) + "\n")
                        if done[0] % 20 == 0:
                            print(f"{done[0]} of {len(meshes)} meshes, {done[1]} with a failure, "
                                  f"{time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
        finally:
            worker.stop()

    in_threads(work, workers)
    return [result for result in results if result is not None]


def failures(result: dict[str, Any]) -> list[tuple[str, str, str]]:
    """(step, kind, what) of each failure on a mesh."""
    return [(step["end"], kind, what) for step in result["steps"] for kind, what in step["findings"]]


def outcome(result: dict[str, Any]) -> str:
    """Of a mesh without a failure: what its jobs came to."""
    return "right" if any(step["outcome"] == "right" for step in result["steps"]) else "refused"


def table(results: list[dict[str, Any]]) -> str:
    """One line a family: its meshes, and with how many of them what happened."""
    columns = ["right", "refused", *FAILURES]
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for result in results:
        kinds = {kind for _, kind, _ in failures(result)}
        for name in (result["family"], "total"):
            counts[name]["meshes"] += 1
            counts[name].update(kinds or {outcome(result)})
    always = ("right", "refused", "crash", "hang")
    shown = ["meshes"] + [name for name in columns if counts["total"][name] or name in always]
    width = max(len(name) for name in counts)
    lines = [" | ".join([" " * width, *shown]), "-|-".join(["-" * width, *("-" * len(c) for c in shown)])]
    for name in [f for f in FAMILIES if f in counts] + ["total"]:
        lines.append(" | ".join([name.ljust(width), *(str(counts[name][c] or ".").rjust(len(c))
                                                      for c in shown)]))
    return "\n".join(lines)


def save_cases(plugin: Path, bad: list[dict[str, Any]], options: argparse.Namespace) -> None:
    """Reduces and saves a case of each (family, step, kind), and prints where it is."""
    tasks: queue.SimpleQueue[tuple[str, int, str, str, str]] = queue.SimpleQueue()
    seen = set()
    for result in bad:
        for step, kind, what in failures(result):
            key = (result["family"], step, kind)
            if key not in seen and len(seen) < options.max_cases:
                seen.add(key)
                tasks.put((result["family"], result["seed"], step, kind, what))

    def work() -> None:
        worker = Worker(plugin)
        try:
            with tempfile.TemporaryDirectory() as folder:
                while True:
                    try:
                        family, seed, step, kind, what = tasks.get_nowait()
                    except queue.Empty:
                        return
                    whole = make(family, seed)

                    def fails(mesh: Hostile) -> bool:
                        write_case(Path(folder) / "case", mesh)
                        steps = worker.run({"file": f"{folder}/case", "jobs": [step.split("/")[0]],
                                            "only": step, "full": True})
                        return any((end["end"], found) == (step, kind)
                                   for end in steps for found, _ in end["findings"])

                    small = Reduction(whole, fails).run(options.reduce) if options.reduce else whole
                    name = "_".join([family, str(seed), step.replace("/", "."), kind.replace(" ", "_")])
                    write_case(options.output / name, small, family=family, seed=seed, step=step,
                               kind=kind, what=what)
                    print(f"{options.output / name}.off ({len(small.vertices)} of {len(whole.vertices)} "
                          f"vertices)\n    {step}: {kind}: {what[:200]}", flush=True)
        finally:
            worker.stop()

    in_threads(work, options.workers)


def in_threads(work: Callable[[], None], count: int) -> None:
    """Runs `work` in so many threads. @raise what one of them raises."""
    with ThreadPoolExecutor(count) as pool:
        for end in [pool.submit(work) for _ in range(count)]:
            end.result()


def parse_arguments(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/fuzz.sh", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", nargs="?", type=int, default=300, help="how many meshes (300)")
    parser.add_argument("seed", nargs="?", type=int, default=1, help="of the first ones (1)")
    parser.add_argument("--plugin", type=Path, default=os.environ.get("MCFSKEL_PLUGIN"),
                        help="the plugin for pymeshlab (default: $MCFSKEL_PLUGIN)")
    parser.add_argument("--output", type=Path, default=Path("out/fuzz"), metavar="FOLDER",
                        help="results.json, and the failing cases (out/fuzz)")
    parser.add_argument("--full", action="store_true", help="all jobs and all tools, those that take long too")
    parser.add_argument("--jobs", nargs="+", choices=JOBS, help="these jobs only")
    parser.add_argument("--mesh", nargs=2, metavar=("FAMILY", "NUMBER"),
                        help="this one only, as a table or a test names it")
    parser.add_argument("--families", nargs="+", choices=list(FAMILIES), metavar="FAMILY",
                        help="these families only")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="processes at a time")
    parser.add_argument("--seconds", type=float, help="start no new mesh after this time")
    parser.add_argument("--reduce", type=float, default=20.0, metavar="SECONDS",
                        help="time for making a failing case smaller; 0: as it is (20)")
    parser.add_argument("--max-cases", type=int, default=40,
                        help="reduce no more than so many, one of each family, step and kind first (40)")
    options = parser.parse_args(arguments)
    if not options.plugin:
        parser.error("--plugin, or the environment variable MCFSKEL_PLUGIN, is needed")
    options.plugin = Path(options.plugin).resolve()
    return options


def main() -> int:
    options = parse_arguments()
    meshes = drawn(options.count, options.seed)
    if options.families:
        meshes = [(options.families[i % len(options.families)],
                   options.seed * 1_000_003 + i // len(options.families)) for i in range(options.count)]
    if options.mesh:
        meshes = [(options.mesh[0], int(options.mesh[1]))]
    options.output.mkdir(parents=True, exist_ok=True)
    log = options.output / "progress.jsonl"
    log.unlink(missing_ok=True)
    started = time.monotonic()
    results = run_meshes(options.plugin, meshes, options.jobs, options.full, options.workers, options.seconds,
                         log)
    log.unlink(missing_ok=True)
    (options.output / "results.json").write_text(json.dumps(results, indent=0) + "\n")
    print(table(results))
    slowest = max(((step["seconds"], result["family"], result["seed"], step["end"])
                   for result in results for step in result["steps"]), default=None)
    bad = [result for result in results if failures(result)]
    print(f"{len(results)} meshes, {len(bad)} with a failure, {time.monotonic() - started:.0f} s"
          + (f"; slowest step {slowest[0]:.1f} s: {slowest[1]} {slowest[2]} {slowest[3]}" if slowest else ""))
    if bad:
        save_cases(options.plugin, bad, options)
    return 1 if bad else 0
