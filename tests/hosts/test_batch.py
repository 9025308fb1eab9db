# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The example that does a folder of meshes: bad ones, crashes, going on, and a Dask cluster."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from conftest import MESHES, ROOT, arrays, opened

SCRIPT = ROOT / "examples" / "skeletonize_folder.py"
COARSE = ["--option", "target_length=1.2%"]


@pytest.fixture
def environment(plugin) -> dict[str, str]:
    """The package straight from the checkout, with the plugin under test."""
    return os.environ | {"MCFSKEL_PLUGIN": str(plugin), "PYTHONPATH": str(ROOT / "python")}


@pytest.fixture
def folder(tmp_path) -> Path:
    """Three good meshes and a flat one."""
    folder = tmp_path / "meshes"
    folder.mkdir()
    for name in ["torus", "capsule", "animal450"]:
        shutil.copy(MESHES / f"{name}.off", folder)
    lines = (MESHES / "torus.off").read_text().splitlines()
    for i in range(2, 2 + int(lines[1].split()[0])):
        lines[i] = " ".join(lines[i].split()[:2] + ["0"])
    (folder / "flat.off").write_text("\n".join(lines) + "\n")
    (folder / "notes.txt").write_text("no mesh")
    return folder


def run(folder: Path, *arguments: str, env: dict[str, str], **more) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(SCRIPT), str(folder), str(folder.parent / "out"),
                           *COARSE, *arguments], env=env, capture_output=True, text=True, timeout=240,
                          **more)


def table(folder: Path) -> dict[str, dict[str, str]]:
    with open(folder.parent / "out" / "results.csv", newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert len({row["mesh"] for row in rows}) == len(rows), "a mesh is in the table once"
    return {Path(row["mesh"]).stem: row for row in rows}


def test_a_bad_mesh_costs_the_others_nothing(folder, environment):
    done = run(folder, "--workers", "2", "--formats", "json", "swc", env=environment)
    assert done.returncode == 1, "a mesh failed"
    rows = table(folder)
    assert {name: row["status"] for name, row in rows.items()} == {
        "torus": "ok", "capsule": "ok", "animal450": "ok", "flat": "failed"}
    assert "the mesh is flat" in rows["flat"]["error"]
    assert "the mesh is flat" in done.stdout and "torus.off" in done.stdout
    assert "%" not in done.stderr and "it/s" not in done.stderr, "no progress bar but on a terminal"
    for name in ["torus", "capsule", "animal450"]:
        graph = json.loads((folder.parent / "out" / f"{name}.off.json").read_text())
        assert len(graph["nodes"]) == int(rows[name]["skeleton_vertices"])
        assert (folder.parent / "out" / f"{name}.off.swc").is_file()
    assert rows["torus"]["cycles"] == "1" and rows["capsule"]["cycles"] == "0"
    heading, *printed = done.stdout.splitlines()
    cycles = heading.split().index("cycles")
    assert {line.split()[0]: line.split()[cycles] for line in printed if " ok " in line} == {
        "torus.off": "1", "capsule.off": "0", "animal450.off": "0"}
    vertices, faces = arrays("torus")
    assert [rows["torus"]["mesh_vertices"], rows["torus"]["mesh_faces"]] == [
        str(len(vertices)), str(len(faces))]
    assert (rows["torus"]["terminals"], rows["capsule"]["terminals"]) == ("0", "2")
    for name in ["torus", "capsule"]:
        assert 0 < float(rows[name]["radius_min"]) <= float(rows[name]["radius_max"])


def test_subfolders_and_names_that_meet(folder, environment):
    for name in ["a", "b"]:
        (folder / name).mkdir()
        (folder / "torus.off").replace(folder / name / "same.off") if name == "a" else (
            folder / "capsule.off").replace(folder / name / "same.off")
    for name in ["flat", "animal450"]:
        (folder / f"{name}.off").unlink()
    out = folder / "out"  # within the folder: its skeletons are no meshes
    command = [sys.executable, str(SCRIPT), str(folder), str(out), *COARSE, "--formats", "ply", "json"]
    for _ in range(2):
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=240)
        assert done.returncode == 0, done.stderr
    with open(out / "results.csv", newline="") as lines:
        rows = {row["mesh"]: row for row in csv.DictReader(lines)}
    assert len(rows) == 2
    for name, cycles in [("a", "1"), ("b", "0")]:
        assert rows[str((folder / name / "same.off").resolve())]["cycles"] == cycles
        graph = json.loads((out / name / "same.off.json").read_text())
        assert str(graph["graph"]["cycles"]) == cycles
        assert (out / name / "same.off.ply").is_file()


@pytest.mark.parametrize("arguments, words", [
    (["--option", "foo=1"], "There is no option foo"),
    (["--option", "w_l=thin"], "w_l='thin' is no number"),
    (["--option", "w_m=-1"], "Parameter w_m must be between 0 and 1000000."),
    (["--option", "target_length=-1%"], "target_length='-1%' is not between 0% and 100%"),
    (["--option", "repair=all"], "repair='all' is none of 'auto', 'mend', 'off'"),
    (["--option", "w_l"], "expected NAME=VALUE"),
    (["--option", "target_length=-1"], "target_length=-1 is no length"),
    (["--timeout", "-1"], "--timeout must be more than 0"),
    (["--formats", "xyz"], "'vtp'"),
])
def test_what_cannot_be_is_found_out_at_once(folder, environment, arguments, words):
    done = run(folder, *arguments, env=environment)
    assert done.returncode != 0 and words in done.stderr
    assert not (folder.parent / "out" / "results.csv").exists()


def test_a_results_folder_that_cannot_be_is_found_out_at_once(folder, environment):
    (folder.parent / "out").write_text("a file")
    done = run(folder, env=environment)
    assert done.returncode == 1 and "nothing can be written into" in done.stderr
    assert (folder.parent / "out").read_text() == "a file"


def test_a_name_that_is_not_utf8_costs_the_others_nothing(folder, environment):
    for name in ["capsule.off", "animal450.off", "flat.off"]:
        (folder / name).unlink()
    shutil.copy(folder / "torus.off", os.fsencode(folder) + b"/m\xfc.off")
    for _ in range(2):  # the second run finds both in the table
        done = run(folder, env=environment)
        assert done.returncode == 1 and "Traceback" not in done.stderr
        with open(folder.parent / "out" / "results.csv", newline="", errors="surrogateescape") as lines:
            rows = {Path(row["mesh"]).name: row for row in csv.DictReader(lines)}
        assert {name: row["status"] for name, row in rows.items()} == {"torus.off": "ok", "m\udcfc.off": "failed"}
        assert "is not UTF-8" in rows["m\udcfc.off"]["error"]


def test_skeletons_beside_their_meshes_are_no_meshes(folder, environment):
    for name in ["capsule.off", "animal450.off", "flat.off"]:
        (folder / name).unlink()
    command = [sys.executable, str(SCRIPT), str(folder), str(folder), *COARSE, "--formats", "ply", "glb"]
    for _ in range(2):
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=240)
        assert done.returncode == 0, done.stdout
    with open(folder / "results.csv", newline="") as lines:
        assert [Path(row["mesh"]).name for row in csv.DictReader(lines)] == ["torus.off"]


def test_a_table_of_somebody_else_is_left_alone(folder, environment):
    (folder.parent / "out").mkdir()
    (folder.parent / "out" / "results.csv").write_text("a,b\n1,2\n")
    done = run(folder, env=environment)
    assert done.returncode == 1 and "is not a table of this program" in done.stderr
    assert (folder.parent / "out" / "results.csv").read_text() == "a,b\n1,2\n"


def test_offers_every_format_that_the_package_writes(environment):
    text = subprocess.run([sys.executable, "-c", "import mcfskel._files; print(mcfskel._files.WRITTEN)"],
                          env=environment, capture_output=True, text=True, check=True).stdout
    sys.path.insert(0, str(SCRIPT.parent))
    import skeletonize_folder
    assert {f".{name}" for name in skeletonize_folder.FORMATS} == set(eval(text))


def test_goes_on_where_it_stopped(folder, environment):
    (folder / "torus.off").rename(folder.parent / "torus.off")
    run(folder, env=environment)
    first = table(folder)
    written = (folder.parent / "out" / "capsule.off.json").stat().st_mtime_ns
    (folder.parent / "torus.off").rename(folder / "torus.off")
    run(folder, env=environment)
    second = table(folder)
    assert {name: second[name] for name in first} == first, "nothing was done again"
    assert (folder.parent / "out" / "capsule.off.json").stat().st_mtime_ns == written
    assert second["torus"]["status"] == "ok"
    shutil.copy(MESHES / "torus.off", folder / "flat.off")
    assert run(folder, env=environment).returncode == 1
    assert run(folder, "--retry", env=environment).returncode == 0
    assert table(folder)["flat"]["status"] == "ok"


def test_other_formats_and_options_are_done(folder, environment):
    for name in ["flat", "animal450"]:
        (folder / f"{name}.off").unlink()
    run(folder, env=environment)
    before = table(folder)
    swc = folder.parent / "out" / "capsule.off.swc"
    assert not swc.exists()
    run(folder, "--formats", "json", "swc", env=environment)
    assert swc.is_file()
    assert table(folder)["capsule"]["skeleton_vertices"] == before["capsule"]["skeleton_vertices"]
    run(folder, "--option", "refine=false", env=environment)
    assert table(folder)["capsule"]["skeleton_vertices"] != before["capsule"]["skeleton_vertices"]


@pytest.mark.parametrize("way, status", [(signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)])
def test_goes_on_after_an_interruption(folder, environment, way, status):
    (folder / "flat.off").unlink()
    shutil.copy(folder / "torus.off", folder / "torus.ply.off")  # names that differ in the middle
    opened("torus").save_current_mesh(str(folder / "torus.ply"))  # and in the end only
    out = folder.parent / "out"
    running = subprocess.Popen([sys.executable, str(SCRIPT), str(folder), str(out), *COARSE,
                                "--workers", "1"], env=environment, start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    Cluster.wait_for(lambda: (out / "results.csv").is_file() and len(
        (out / "results.csv").read_text().splitlines()) > 2)
    os.killpg(running.pid, way)  # as the terminal does for Ctrl-C
    assert running.wait(timeout=30) == status
    with open(out / "results.csv", newline="") as lines:
        first = {row["mesh"]: row for row in csv.DictReader(lines)}
    assert 1 < len(first) < 5 and {row["status"] for row in first.values()} == {"ok"}
    with open(out / "results.csv", "a", newline="") as lines:
        lines.write(f"{folder / 'torus.off'},ok,1.")  # what a kill in the middle of a line leaves
    assert run(folder, env=environment).returncode == 0
    with open(out / "results.csv", newline="") as lines:
        second = {row["mesh"]: row for row in csv.DictReader(lines)}
    assert len(second) == 5 and first.items() <= second.items(), "nothing was done again"
    for mesh, row in second.items():
        graph = json.loads((out / f"{Path(mesh).name}.json").read_text())
        assert len(graph["nodes"]) == int(row["skeleton_vertices"])


def test_a_crash_costs_one_mesh(folder, environment, tmp_path):
    # A stand-in for the package that takes the process down on one mesh and hangs on another.
    (tmp_path / "mcfskel.py").write_text(
        "import os, sys, time\n"
        "sys.path = [p for p in sys.path if p != os.path.dirname(__file__)]\n"
        "del sys.modules['mcfskel']\n"
        "import mcfskel\n"
        "skeletonize = mcfskel.skeletonize\n"
        "def stand_in(path, **options):\n"
        "    if 'capsule' in path:\n"
        "        os.abort()\n"
        "    if 'animal' in path:\n"
        "        time.sleep(300)\n"
        "    return skeletonize(path, **options)\n"
        "mcfskel.skeletonize = stand_in\n")
    env = environment | {"PYTHONPATH": f"{tmp_path}:{environment['PYTHONPATH']}"}
    done = run(folder, "--timeout", "30", "--workers", "4", env=env)
    assert done.returncode == 1
    rows = table(folder)
    assert rows["capsule"]["status"] == "crashed"
    assert f"ended with -{int(signal.SIGABRT)}" in rows["capsule"]["error"]
    assert rows["animal450"]["error"] == "given up after 30 seconds"
    assert rows["torus"]["status"] == "ok"


class Cluster:
    """A Dask scheduler and two workers on this machine."""

    def __init__(self, folder: Path, env: dict[str, str]) -> None:
        address = folder / "scheduler.json"
        self.processes = [self.start("scheduler", "--host", "127.0.0.1", "--port", "0",
                                     "--no-dashboard", "--scheduler-file", str(address), env=env)]
        self.wait_for(address.is_file)
        self.address = json.loads(address.read_text())["address"]
        for name in "ab":
            self.processes.append(self.start(
                "worker", self.address, "--no-nanny", "--no-dashboard", "--nthreads", "1", "--name", name,
                "--local-directory", str(folder), env=env))

    @staticmethod
    def start(command: str, *arguments: str, env: dict[str, str]) -> subprocess.Popen:
        return subprocess.Popen([sys.executable, "-m", "dask", command, *arguments], env=env,
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    @staticmethod
    def wait_for(condition) -> None:
        for _ in range(300):
            if condition():
                return
            time.sleep(0.1)
        raise TimeoutError

    def stop(self) -> None:
        for process in reversed(self.processes):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path, environment):
    cluster = Cluster(tmp_path, environment)
    yield cluster
    cluster.stop()


def test_on_a_cluster_that_loses_a_worker(folder, environment, cluster, tmp_path):
    for i in range(4):
        shutil.copy(MESHES / "torus.off", folder / f"torus_{i}.off")
    from distributed import Client
    with Client(cluster.address) as client:
        client.wait_for_workers(2, timeout=60)
    running = subprocess.Popen(
        [sys.executable, str(SCRIPT), str(folder), str(tmp_path / "out"), *COARSE,
         "--scheduler", cluster.address], env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL, text=True)
    csv_file = tmp_path / "out" / "results.csv"
    cluster.wait_for(lambda: csv_file.is_file() and len(csv_file.read_text().splitlines()) > 2)
    cluster.processes[1].kill()
    output, _ = running.communicate(timeout=240)
    assert running.returncode == 1, output
    rows = table(folder)
    assert len(rows) == 8
    assert {name for name, row in rows.items() if row["status"] != "ok"} == {"flat"}, output
    assert "the mesh is flat" in rows["flat"]["error"]
