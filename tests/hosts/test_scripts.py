# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/ on a machine that lacks something, or has settings of its own: a copy of them, with programs that stand in
for those that build."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from conftest import ROOT

LIBRARIES = ["common.sh", "meshlab_sources.sh", "build.sh", "bench.sh", "python_env.sh", "hosts.sh"]


class Machine:
    """A copy of scripts/ in a folder with a space in its name, and a folder of programs before all others."""

    def __init__(self, folder: Path) -> None:
        self.root = folder / "a project"
        self.programs = folder / "programs"
        self.cache = folder / "cache"
        self.programs.mkdir()
        shutil.copytree(ROOT / "scripts", self.root / "scripts")
        sources = folder / "meshlab"
        for header in ["src/common/mlexception.h", "src/vcglib/vcg/complex/complex.h"]:
            (sources / header).parent.mkdir(parents=True)
            (sources / header).touch()
        self.environment = {name: value for name, value in os.environ.items()
                            if not name.startswith(("MCFSKEL_", "MESHLAB_"))} | {
            "PATH": f"{self.programs}:{os.environ['PATH']}", "MCFSKEL_CACHE": str(self.cache),
            "MESHLAB_SRC": str(sources)}
        self.program("dpkg-query", "echo amd64 installed")
        self.program("dpkg", "echo amd64")

    def program(self, name: str, body: str) -> None:
        """Puts a shell script in the place of a program."""
        path = self.programs / name
        path.unlink(missing_ok=True)
        path.write_text(f"#!/bin/bash\n{body}\n")
        path.chmod(0o755)

    def without(self, *names: str) -> None:
        """A machine on which some programs are not there."""
        for program in Path("/usr/bin").iterdir():
            if program.name not in names and not (self.programs / program.name).exists():
                (self.programs / program.name).symlink_to(program)
        self.environment["PATH"] = str(self.programs)

    def start(self, *command: object, folder: Path | None = None, **variables: str) -> subprocess.Popen:
        return subprocess.Popen([str(word) for word in command], cwd=folder or self.root, text=True,
                                env=self.environment | variables, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run(self, *command: object, folder: Path | None = None, **variables: str) -> subprocess.CompletedProcess:
        process = self.start(*command, folder=folder, **variables)
        output, errors = process.communicate(timeout=60)
        return subprocess.CompletedProcess(command, process.returncode, output, errors)

    def shell(self, text: str, **variables: str) -> subprocess.CompletedProcess:
        """Runs lines of a script that has sourced all of scripts/lib."""
        sourced = "".join(f". scripts/lib/{name}\n" for name in LIBRARIES)
        return self.run("bash", "-euo", "pipefail", "-c", sourced + text, **variables)


@pytest.fixture
def machine(tmp_path) -> Machine:
    return Machine(tmp_path)


class TestPackages:
    def test_without_root_and_sudo_what_is_missing_is_said(self, machine):
        machine.program("dpkg-query", "exit 1")
        machine.program("id", "echo 1000")
        machine.without("sudo")
        run = machine.shell("need_packages g++ cmake")
        assert run.returncode == 1
        assert run.stderr == (
            "error: Debian packages are missing, and it takes root or sudo to install them: g++ cmake\n")

    def test_what_is_there_for_two_architectures_is_there(self, machine):
        machine.program("dpkg-query", "printf '%s installed\\n' amd64 i386")
        run = machine.shell("need_packages zlib1g")
        assert run.returncode == 0 and not run.stderr

    def test_what_is_there_for_another_architecture_alone_is_missing(self, machine):
        machine.program("dpkg-query", "echo i386 installed")
        machine.program("id", "echo 1000")
        machine.without("sudo")
        assert "to install them: zlib1g" in machine.shell("need_packages zlib1g").stderr

    @pytest.mark.parametrize("command, packages", [
        ("format.sh", {"clang-format-14", "git"}), ("lint.sh", {"clang-tidy-14", "git"}),
        ("docs.sh", {"doxygen", "git"}), ("upstream.sh", {"clang-format", "git", "python3"})])
    def test_a_command_installs_what_it_calls(self, command, packages, machine):
        machine.program("dpkg-query", "exit 1")
        machine.program("id", "echo 0")
        machine.program("apt-get", 'echo "$*" >>"$(dirname "$0")/asked"; exit 1')
        assert machine.run(f"scripts/{command}").returncode != 0
        assert packages <= set((machine.programs / "asked").read_text().split())

    def test_a_function_that_dies_is_heard(self, machine):
        run = machine.shell("quietly die 'nothing works'\necho reached")
        assert run.returncode == 1 and run.stderr == "error: nothing works\n" and not run.stdout


class TestSettings:
    def test_search_path_of_cd(self, machine):
        run = machine.run("bash", "-c", '. scripts/lib/common.sh; echo "$ROOT"', CDPATH=".:/tmp")
        assert run.stdout == f"{machine.root}\n"

    def test_relative_folders(self, machine):
        (machine.root / "sources").symlink_to(machine.environment["MESHLAB_SRC"])
        run = machine.shell('cd /; echo "$CACHE"', MCFSKEL_CACHE="here")
        assert run.stdout == f"{machine.root}/here\n"
        run = machine.shell("meshlab_sources 2025.07", MESHLAB_SRC="sources")
        assert run.stdout == f"{machine.root}/sources\n"

    def test_modules_of_another_python(self, machine):
        run = machine.shell('echo "${PYTHONPATH-unset}"', PYTHONPATH="/elsewhere")
        assert run.stdout == "unset\n"


def test_a_host_that_cannot_be_had_is_an_error(machine):
    """Before, get_host.sh succeeded with the folder '.'."""
    for host in ["pymeshlab", "pymeshlab-2022.2"]:
        run = machine.shell(f'python_env() {{ die "no network"; }}\nfolder="$(host_folder {host})"\necho "$folder"')
        assert run.returncode == 1 and "no network" in run.stderr and not run.stdout
        run = machine.shell(f'python_env() {{ echo "/a b/${{1:-default}}/bin/python"; }}\nhost_folder {host}')
        assert run.stdout.startswith("/a b/") and not run.stdout.endswith("/bin/python\n")


def test_a_peer_that_could_not_be_had_is_tried_again(machine):
    folder = machine.root / "environment"
    (folder / "bin").mkdir(parents=True)
    (folder / "complete").touch()
    (folder / "missing").write_text("one==1\nanother==2\n")
    python = folder / "bin/python"
    for working, left in [("one", "another==2\n"), ("another", "")]:
        python.write_text(f'#!/bin/bash\n[[ "$*" == *{working}==* ]]\n')
        python.chmod(0o755)
        run = machine.shell(f"make_bench_python '{folder}'")
        assert run.returncode == 0 and (folder / "missing").read_text() == left
        assert ("could not install another==2" in run.stderr) == bool(left)
    python.unlink()
    assert machine.shell(f"make_bench_python '{folder}'").returncode == 0  # nothing is asked for any more


class TestFormat:
    def test_without_a_list_of_sources_nothing_is_well_formatted(self, machine):
        """The copy is no checkout: git names no files."""
        run = machine.run("scripts/format.sh", "--check", GIT_CEILING_DIRECTORIES=str(machine.root.parent))
        assert run.returncode == 1 and "listed by git" in run.stderr

    def test_an_error_of_the_formatter_is_one(self, machine):
        machine.program("git", "echo a.h")
        machine.program("clang-format-14", "echo 'Error reading .clang-format' >&2; exit 1")
        run = machine.run("scripts/format.sh", "--check")
        assert run.returncode == 1 and "Error reading .clang-format" in run.stderr

    def test_check_names_the_files(self, machine):
        machine.program("git", "echo a.h; echo b.h")
        machine.program("clang-format-14", "echo 'b.h:1:2: warning: not [-Wclang-format-violations]' >&2")
        run = machine.run("scripts/format.sh", "--check")
        assert run.returncode == 1 and run.stderr.splitlines()[1:] == ["b.h"]


class TestBuilding:
    # Fails where another one is at work in the same folder.
    ALONE = 'mkdir "$(dirname "$0")/busy" || { echo two at once; exit 1; }\nsleep 0.3\nrmdir "$(dirname "$0")/busy"'
    NINJA = '[[ "$*" == *" -n "* ]] || {\necho "$*" >>"$(dirname "$0")/built"\n' + ALONE + "\n}"

    def test_two_at_once_take_turns(self, machine):
        machine.program("cmake", self.ALONE)
        machine.program("ninja", self.NINJA)
        for command in ["build_host pymeshlab", "build_bench mcfskel_cli"]:
            script = "".join(f". scripts/lib/{name}\n" for name in LIBRARIES) + command
            runs = [machine.start("bash", "-euo", "pipefail", "-c", script) for _ in range(3)]
            for run in runs:
                output, errors = run.communicate(timeout=60)
                assert run.returncode == 0, errors
                assert len(output.splitlines()) == 1 and "two at once" not in errors

    def test_the_plugin_alone_unless_more_is_asked_for(self, machine):
        """CMake remembers options: after scripts/test.sh every command would build the unit tests."""
        machine.program("cmake", "true")
        machine.program("ninja", self.NINJA)
        machine.shell("build_host pymeshlab\nbuild_host pymeshlab -DMCFSKEL_TESTS=ON\nbuild_host pymeshlab-2023.12")
        built = [line.split()[-1] for line in (machine.programs / "built").read_text().splitlines()]
        assert built == ["filter_mcfskel", "all", "filter_mcfskel_2023.12"]

    def test_a_build_that_fails_is_an_error(self, machine):
        machine.program("cmake", "echo no compiler; exit 1")
        for command in ["build_host pymeshlab", "build_bench"]:
            run = machine.shell(command)
            assert run.returncode == 1 and "no compiler" in run.stderr and not run.stdout


class TestMistakesAreToldFirst:
    @pytest.mark.parametrize("command", [
        ("bench.sh", "--runs", "many"), ("bench.sh", "nothing.off"), ("bench.sh", "--json", "nowhere/figures.json"),
        ("bench.sh", "--hos"), ("benchmark.sh", "--program", "mine"), ("benchmark.sh", "--families", "cubes"),
        ("reproduce.sh", "nothing.off"), ("reproduce.sh", "--docs", "nowhere"),
        ("upstream.sh", "one", "two"), ("upstream.sh", "--nonsense")])
    def test_wrong_use(self, command, machine):
        run = machine.run(machine.root / "scripts" / command[0], *command[1:])
        assert run.returncode == 2 and "usage:" in run.stderr
        assert not (machine.root / "build").exists() and not machine.cache.exists()

    def test_a_plugin_that_is_not_there(self, machine):
        run = machine.run("scripts/wheel.sh", MCFSKEL_PLUGIN="nothing.so")
        assert run.returncode == 1 and "there is no plugin 'nothing.so'" in run.stderr

    def test_no_mesh_to_sanitize(self, machine):
        run = machine.run("scripts/sanitize.sh", "address", "--jobs", "--meshes", "nothing*")
        assert run.returncode == 1 and "no mesh has a name that matches 'nothing*'" in run.stderr


def test_sanitize_fails_where_the_filter_names_no_test(machine):
    machine.program("cmake", "true")
    machine.program("ninja", "true")
    tests = machine.root / "build/sanitize-address/tests/unit_tests"
    tests.parent.mkdir(parents=True)
    for count, status in [(0, 1), (3, 0)]:
        tests.write_text(f"#!/bin/sh\necho '[==========] Running {count} tests from {count} test suites.'\n")
        tests.chmod(0o755)
        run = machine.run("scripts/sanitize.sh", "address", "--tests", "Nothing.*")
        assert run.returncode == status, run.stdout + run.stderr


def test_whoever_stops_the_fuzzing_of_readers_stops_all_of_it(machine):
    machine.program("cmake", "true")
    machine.program("ninja", "true")
    folder = machine.root / "build/fuzz/tests/fuzz"
    folder.mkdir(parents=True)
    for name, body in [("make_seeds", "true"), ("fuzz_cg", 'echo $$ >"$(dirname "$0")/number"; exec sleep 50')]:
        (folder / name).write_text(f"#!/bin/bash\n{body}\n")
        (folder / name).chmod(0o755)
    run = machine.start("scripts/fuzz.sh", "--readers", 1, "cg")
    number = folder / "number"
    end = time.monotonic() + 30
    while not (number.exists() and number.read_text().strip()):
        assert time.monotonic() < end and run.poll() is None
        time.sleep(0.05)
    run.send_signal(signal.SIGTERM)
    run.communicate(timeout=30)
    assert run.returncode == 130
    fuzzer = Path("/proc") / number.read_text().strip()
    while fuzzer.exists() and "sleep" in (fuzzer / "comm").read_text() and "Z" not in (fuzzer / "stat").read_text():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_meshes_of_one_name_are_subdivided_each(tmp_path):
    """Before, the first one's was taken for the second one's where that was older."""
    program = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from meshes import read_mesh, subdivided
for name in sys.argv[3:]:
    path = subdivided(Path(name), 1, Path(sys.argv[2]))
    print(path.stem, len(read_mesh(path)[1]))
"""
    for name, faces in [("new", 1), ("old", 2)]:
        (tmp_path / name).mkdir()
        rows = ["3 0 1 2", "3 0 2 3"][:faces]
        (tmp_path / name / "shape.off").write_text(
            "\n".join(["OFF", f"4 {faces} 0", "0 0 0", "1 0 0", "1 1 0", "0 1 0", *rows]) + "\n")
    os.utime(tmp_path / "old/shape.off", (1, 1))
    run = subprocess.run([sys.executable, "-c", program, ROOT / "scripts/bench", tmp_path / "work",
                          tmp_path / "new/shape.off", tmp_path / "old/shape.off"], capture_output=True, text=True)
    assert run.stdout.split() == ["shape_x4", "4", "shape_x4", "8"], run.stderr


class TestHeadersOfVCG:
    def configured(self, folder: Path, *options: str) -> subprocess.CompletedProcess:
        (folder / "CMakeLists.txt").write_text(f"""cmake_minimum_required(VERSION 3.18)
project(probe LANGUAGES NONE)
list(APPEND CMAKE_MODULE_PATH "{ROOT}/cmake")
if(MESHLAB_SRC)
    include(MeshLabSource)
endif()
include(Vcg)
message(STATUS "found: ${{VCG_INCLUDE_DIR}}")
""")
        return subprocess.run(["cmake", "-S", folder, "-B", folder / "build", *options], capture_output=True, text=True)

    def test_are_those_of_the_tree_that_is_named_now(self, tmp_path):
        for name in ["one", "another"]:
            for header in ["src/common/mlexception.h", "src/vcglib/vcg/complex/complex.h"]:
                (tmp_path / name / header).parent.mkdir(parents=True)
                (tmp_path / name / header).touch()
            run = self.configured(tmp_path, f"-DMESHLAB_SRC={tmp_path / name}")
            assert f"found: {tmp_path / name}/src/vcglib\n" in run.stdout, run.stderr

    def test_are_looked_for_where_the_user_says(self, tmp_path):
        run = self.configured(tmp_path, f"-DVCG_INCLUDE_DIR={tmp_path}/nothing")
        assert run.returncode != 0 and f"No headers of VCG in '{tmp_path}/nothing'" in " ".join(run.stderr.split())
