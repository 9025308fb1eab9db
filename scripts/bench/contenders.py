# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of the benchmark: how each is called, and its skeletons, made once."""

from __future__ import annotations

import hashlib
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
SUFFIXES = (".vtp", ".ply", ".swc", ".cg", ".obj")


@dataclass(frozen=True)
class Contender:
    """A program: its words, in which {mesh} and {skeleton} are replaced."""

    name: str
    words: tuple[str, ...]

    @property
    def suffix(self) -> str:
        """The ending of its files."""
        return next(Path(word).suffix for word in self.words if "{skeleton}" in word)

    def fingerprint(self) -> str:
        """Of the command and the files in it: skeletons of another version are made anew."""
        digest = hashlib.sha256(repr(self.words).encode())
        for word in self.words:
            file = Path(shutil.which(word) or word)
            if file.is_file():
                digest.update(file.read_bytes())
        return digest.hexdigest()[:16]


def known(name: str, programs: Path, vmtk_python: str | None) -> Contender | None:
    """A program that the benchmark knows; None where it is not installed."""
    cgal = (str(programs / "cgal_peer"), "{mesh}", "--skeleton", "{skeleton}.obj")
    if name == "mcfskel":
        return Contender(name, (str(programs / "mcfskel_cli"), "{mesh}", "--skeleton", "{skeleton}.vtp"))
    if name == "cgal":
        return Contender(name, cgal)
    if name == "cgal_remeshed":
        return Contender(name, (*cgal, "--remesh", "0.5"))
    if name == "vmtk":
        if not vmtk_python:
            return None
        return Contender(name, (vmtk_python, str(HERE / "vmtk_peer.py"), "{mesh}", "{skeleton}.vtp"))
    module = {"pygel": "pygel3d"}.get(name, name)
    found = subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True, check=False)
    if found.returncode:
        return None
    return Contender(name, (sys.executable, str(HERE / "peers.py"), name, "{mesh}", "--skeleton", "{skeleton}.obj"))


def another(name: str, command: str) -> Contender:
    return Contender(name, tuple(shlex.split(command)))


@dataclass(frozen=True)
class Made:
    """A skeleton's file, or why there is none; seconds of processor time, that of starting left out where the
    program reports it."""

    file: Path | None
    seconds: float | None
    error: str


def make_skeleton(contender: Contender, mesh: Path, folder: Path, timeout: float) -> Made:
    """Runs a program, unless the folder has what it made of the same mesh. A run that took too long counts as
    made: with a longer timeout it is run again."""
    skeleton, record = folder / (mesh.stem + contender.suffix), folder / f"{mesh.stem}.json"
    key = contender.fingerprint() + hashlib.sha256(mesh.read_bytes()).hexdigest()[:16]
    if record.is_file():
        old = json.loads(record.read_text())
        if old["key"] == key and (not old["timeout"] or old["timeout"] >= timeout):
            return Made(None if old["error"] else skeleton, old["seconds"], old["error"])
    folder.mkdir(parents=True, exist_ok=True)
    skeleton.unlink(missing_ok=True)
    places = {"{mesh}": str(mesh), "{skeleton}": str(folder / mesh.stem)}
    words = list(contender.words)
    for name, place in places.items():
        words = [word.replace(name, place) for word in words]
    seconds, error = run(words, timeout)
    ran_out = error is None
    if not error and not ran_out and not skeleton.is_file():
        error = "no skeleton"
    if ran_out:
        error = f"more than {timeout:g} s"
    record.write_text(json.dumps(
        {"key": key, "error": error, "seconds": seconds, "timeout": timeout if ran_out else 0}) + "\n")
    return Made(None if error else skeleton, seconds, error or "")


def run(words: list[str], timeout: float) -> tuple[float | None, str | None]:
    """Seconds, and the error: empty if there is none, None if it took too long."""
    start = time.perf_counter()
    try:
        # A group of its own: what the program has started ends with it.
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=os.environ | {"OMP_NUM_THREADS": "1"}, start_new_session=True) as process:
            try:
                output, errors = process.communicate(timeout=timeout)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return None, None
    except OSError as error:
        return None, str(error)
    if process.returncode:
        return None, (errors.strip() or f"exit status {process.returncode}").splitlines()[-1]
    seconds = time.perf_counter() - start
    try:
        phases = json.loads(output.strip().splitlines()[-1])["seconds"]
        seconds = sum(phase["cpu"] for phase in phases.values())
    except (ValueError, IndexError, KeyError, TypeError):
        pass  # it reports nothing
    return seconds, ""


def skeleton_in(folder: Path, name: str) -> Made:
    """A skeleton that was made elsewhere."""
    for suffix in SUFFIXES:
        if (file := folder / (name + suffix)).is_file():
            return Made(file, None, "")
    return Made(None, None, "no file")
