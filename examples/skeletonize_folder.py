#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeletonizes every mesh of a folder and its subfolders, on this machine or on a Dask cluster.

Each mesh is done in a process of its own: a mesh that is refused, or that takes its process down,
costs nobody else anything. The table RESULTS/results.csv has a line for each mesh that was tried; a
second run, after Ctrl-C or worse, goes on with the others, and with --retry tries those again that
did not go well. What was done with other options, or lacks a file in one of the formats, is done again.
"""

from __future__ import annotations

import argparse
import csv
import io
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from pathlib import Path
from typing import Any, TextIO

#: What MeshLab reads and is made of triangles.
MESHES = {".off", ".ply", ".obj", ".stl", ".glb", ".gltf", ".dae", ".3ds", ".x3d", ".wrl"}
FORMATS = ("swc", "cg", "graphml", "json", "vtp", "glb", "ply")
COLUMNS = ("mesh", "status", "seconds", "mesh_vertices", "mesh_faces", "skeleton_vertices", "branches",
           "terminals", "junctions", "components", "cycles", "skeleton_length", "radius_min",
           "radius_max", "converged", "options", "error")
#: The first argument of the process that does one mesh.
CHILD = "--child"
#: How names of files that are not UTF-8 get into the table, and out of it again.
NAMES = "surrogateescape"
Row = dict[str, Any]


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder of closed triangle meshes: "
                                                  + ", ".join(sorted(MESHES)))
    parser.add_argument("results", type=Path,
                        help="folder for the table, and the skeletons in the same subfolders")
    parser.add_argument("--formats", nargs="+", choices=FORMATS, default=["json"],
                        help="formats of the skeletons (json)")
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                        help="an option of mcfskel.skeletonize(), such as target_length=1%% or w_m=20")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1,
                        help="meshes at a time on this machine (the number of processors)")
    parser.add_argument("--timeout", type=float, default=600, metavar="SECONDS",
                        help="a mesh that takes longer is given up (600)")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="of a Dask cluster that does the work, such as tcp://host:8786; its "
                             "workers need mcfskel and the same folders")
    parser.add_argument("--retry", action="store_true", help="do the meshes that failed again")
    arguments = parser.parse_args()
    if not arguments.folder.is_dir():
        parser.error(f"there is no folder '{arguments.folder}'")
    if arguments.workers < 1:
        parser.error("--workers must be at least 1")
    if not arguments.timeout > 0:
        parser.error("--timeout must be more than 0")
    arguments.options = {}
    for option in arguments.option:
        name, _, text = option.partition("=")
        if not (name and text):
            parser.error(f"--option {option}: expected NAME=VALUE")
        arguments.options[name] = option_value(text)
    return arguments


def option_value(text: str) -> Any:
    """A number, true or false, a length such as 1%, or a word."""
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def do_mesh(mesh: str, target: str, formats: list[str], options: dict[str, Any]) -> Row:
    """Does one mesh; runs in a process of its own."""
    import mcfskel

    skeleton = mcfskel.skeletonize(mesh, **options)
    Path(target).parent.mkdir(parents=True, exist_ok=True)
    for kind in formats:
        skeleton.save(f"{target}.{kind}")
    vertices, faces = skeleton.surface
    return {"mesh_vertices": len(vertices), "mesh_faces": len(faces),
            "radius_min": float(skeleton.radius.min()), "radius_max": float(skeleton.radius.max())} | {
        name: skeleton.results[name] for name in COLUMNS if name in skeleton.results}


def child(job: str, answer: str) -> None:
    """What the process of one mesh runs: a job from a file, its row into another."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C does not wait for a filter to end
    try:
        row = {"status": "ok"} | do_mesh(*json.loads(Path(job).read_text()))
    except Exception as error:  # whatever it is, it becomes a line of the table
        row = {"status": "failed", "error": " ".join(str(error).split()) or type(error).__name__}
    Path(answer).write_text(json.dumps(row))


def in_own_process(mesh: str, target: str, formats: list[str], options: dict[str, Any],
                   timeout: float) -> Row:
    """Does one mesh in a new process, and lives on whatever becomes of that."""
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        job, answer = Path(folder, "job"), Path(folder, "answer")
        job.write_text(json.dumps([mesh, target, formats, options]))
        try:
            run = subprocess.run([sys.executable, __file__, CHILD, str(job), str(answer)],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=timeout)
            try:
                row = json.loads(answer.read_text())
            except (OSError, ValueError):  # there is no answer, or half of one
                row = {"status": "crashed", "error": f"the process ended with {run.returncode}"}
        except subprocess.TimeoutExpired:
            row = {"status": "failed", "error": f"given up after {timeout:g} seconds"}
    return {"mesh": mesh, "seconds": f"{time.monotonic() - start:.2f}"} | row


def run_here(jobs: list[tuple], workers: int) -> Iterator[Row]:
    """The rows of all jobs as they come; each thread waits for one process at a time."""
    pool = ThreadPoolExecutor(workers)
    try:
        for future in as_completed([pool.submit(in_own_process, *job) for job in jobs]):
            yield future.result()
    finally:
        pool.shutdown(cancel_futures=True)  # after Ctrl-C nothing new is begun


def run_on_cluster(jobs: list[tuple], address: str) -> Iterator[Row]:
    """The same on the workers of a Dask cluster; what a lost worker did not finish, another does."""
    from distributed import Client
    from distributed import as_completed as completed

    try:
        client = Client(address)
    except (OSError, ValueError) as error:
        raise SystemExit(f"error: no Dask scheduler at '{address}': {error}") from None
    with client:
        client.upload_file(__file__)
        futures = [client.submit(on_worker, job, pure=False) for job in jobs]
        names = {future.key: job[0] for future, job in zip(futures, jobs)}
        for future in completed(futures):
            error = future.exception()
            yield future.result() if error is None else {
                "mesh": names[future.key], "status": "crashed", "seconds": "",
                "error": f"{type(error).__name__}: {error}"}


def on_worker(job: tuple) -> Row:
    """Runs on a worker, in the copy of this file that it was sent."""
    import skeletonize_folder

    return skeletonize_folder.in_own_process(*job)


def rows_of(table: Path) -> list[Row]:
    if not table.is_file():
        return []
    text = table.read_text(encoding="utf-8", errors=NAMES)
    # A run that was killed may have left half a line.
    rows = csv.DictReader(io.StringIO(text[:text.rfind("\n") + 1]))
    if rows.fieldnames and not {"mesh", "status"} <= set(rows.fieldnames):
        raise SystemExit(f"error: '{table}' is not a table of this program: move it, or name another folder "
                         "for the results")
    return list(rows)


def is_done(row: Row, target: Path, arguments: argparse.Namespace) -> bool:
    """Whether a mesh need not be done again for what is asked now. target: the skeleton's path without ending."""
    if row.get("options") != options_text(arguments.options):
        return False
    if row["status"] != "ok":
        return not arguments.retry
    return all(Path(f"{target}.{kind}").is_file() for kind in arguments.formats)


def options_text(options: dict[str, Any]) -> str:
    """Options as they stand in the table."""
    return json.dumps(options, sort_keys=True)


def write_table(table: Path, rows: Iterable[Row]) -> None:
    """Replaces the table, or leaves it as it was, after any error and if the process is killed."""
    part = table.with_suffix(".part")
    try:
        with open(part, "w", newline="", encoding="utf-8", errors=NAMES) as lines:
            writer = csv.DictWriter(lines, COLUMNS, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)
            flush_to_disk(lines)
        if table.exists():
            shutil.copymode(table, part)
        os.replace(part, table)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def flush_to_disk(lines: TextIO) -> None:
    lines.flush()
    os.fsync(lines.fileno())


#: The columns that are printed, and how wide.
PRINTED = (("mesh_faces", 8), ("skeleton_vertices", 6), ("branches", 8), ("terminals", 5),
           ("cycles", 6), ("radius_max", 9))
HEADINGS = {"mesh_faces": "faces", "skeleton_vertices": "nodes", "terminals": "tips",
            "radius_max": "thickest"}


def summary(rows: list[Row], folder: Path) -> str:
    """The table as text."""
    headings = " ".join(f"{HEADINGS.get(name, name):>{width}}" for name, width in PRINTED)
    lines = [f"{'mesh':32} {'status':8} {'seconds':>8} {headings}"]
    for row in sorted(rows, key=lambda row: row["mesh"]):
        numbers = " ".join(f"{number_text(row.get(name)):>{width}}" for name, width in PRINTED)
        name = os.path.relpath(row["mesh"], folder)
        line = f"{name if len(name) <= 32 else '...' + name[-29:]:32} {row['status']:8} " \
               f"{row['seconds']:>8} {numbers}"
        lines.append(line + (f"  {row['error']}" if row.get("error") else ""))
    return "\n".join(lines)


def number_text(value: Any) -> str:
    """A number, whether just counted or read from the table; - if there is none."""
    if value is None or value == "":
        return "-"
    return f"{float(value):.6g}"


def meshes_of(folder: Path, results: Path) -> list[Path]:
    """The meshes of a folder and its subfolders, but for the results if they lie in it or beside the meshes."""
    found = []
    is_shared = folder.resolve() == results
    for place, folders, files in os.walk(folder.resolve()):
        folders[:] = sorted(name for name in folders if Path(place, name).resolve() != results)
        names = {name for name in files if Path(name).suffix.lower() in MESHES}
        if is_shared:  # mesh.off.ply beside mesh.off is its skeleton
            names = {name for name in names if Path(name).stem not in names}
        found += [Path(place, name) for name in names]
    return sorted(found)


def check_options(options: dict[str, Any]) -> None:
    """Ends the program if an option does not exist, is of the wrong kind or out of its range, before any work."""
    import mcfskel

    try:
        mcfskel.check_options(**options)
    except mcfskel.SkeletonError as error:
        raise SystemExit(f"error: {error}") from None


def check_writable(results: Path) -> None:
    """Ends the program if nothing can be written, before any work."""
    try:
        results.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=results):
            pass
    except OSError as error:
        raise SystemExit(f"error: nothing can be written into '{results}': {error.strerror}") from None


def main() -> int:
    arguments = parse_arguments()
    check_writable(arguments.results)
    results = arguments.results.resolve()
    folder = arguments.folder.resolve()
    meshes = [str(mesh) for mesh in meshes_of(folder, results)]
    if not meshes:
        print(f"error: no meshes in '{arguments.folder}': files that end with "
              f"{', '.join(sorted(MESHES))}", file=sys.stderr)
        return 1
    check_options(arguments.options)
    from tqdm import tqdm

    table = (results / "results.csv").resolve()  # where a link leads to
    targets = {mesh: results / Path(mesh).relative_to(folder) for mesh in meshes}
    done = {row["mesh"]: row for row in rows_of(table)
            if row["mesh"] not in targets or is_done(row, targets[row["mesh"]], arguments)}
    jobs = [(mesh, str(targets[mesh]), arguments.formats, arguments.options, arguments.timeout)
            for mesh in meshes if mesh not in done]

    write_table(table, done.values())
    rows = (run_on_cluster(jobs, arguments.scheduler) if arguments.scheduler
            else run_here(jobs, arguments.workers))
    with open(table, "a", newline="", encoding="utf-8", errors=NAMES) as lines, closing(rows), \
            tqdm(total=len(meshes), initial=len(meshes) - len(jobs), unit="mesh",
                 disable=None) as bar:  # no bar but on a terminal
        writer = csv.DictWriter(lines, COLUMNS, extrasaction="ignore")
        for row in rows:
            row["options"] = options_text(arguments.options)
            writer.writerow(row)
            flush_to_disk(lines)  # what is done stays done if this run is interrupted
            done[row["mesh"]] = row
            bar.set_postfix_str(Path(row["mesh"]).name, refresh=False)
            bar.update()
    tried = [done[mesh] for mesh in meshes]
    sys.stdout.reconfigure(errors="backslashreplace")  # names that the terminal cannot show
    print(summary(tried, folder))
    return 0 if all(row["status"] == "ok" for row in tried) else 1


if __name__ == "__main__":
    if sys.argv[1:2] == [CHILD]:
        child(*sys.argv[2:])
        sys.exit()
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted; the same command goes on from here", file=sys.stderr)
        sys.exit(130)
    except OSError as error:  # a full disk, say
        print(f"error: {error}; the same command goes on from here", file=sys.stderr)
        sys.exit(1)
