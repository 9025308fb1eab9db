# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/install.sh: the plugin gets to where its host looks for it, and away again."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT
from host_programs import host

NAME = "libfilter_mcfskel.so"


def install(*arguments: object, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run([ROOT / "scripts/install.sh", *map(str, arguments)], capture_output=True,
                          text=True, env=os.environ | environment, timeout=1800)


def check_both_ways(place: Path, plugin: Path, *arguments: object, **environment: str) -> None:
    """Installs, finds the plugin at `place`, installs again, takes it away, finds nothing."""
    for _ in range(2):
        run = install(*arguments, **environment)
        assert run.returncode == 0, run.stderr
        assert run.stdout.splitlines()[-1] == str(place / NAME)
        assert (place / NAME).read_bytes() == plugin.read_bytes()
        assert [path.name for path in place.glob("*mcfskel*")] == [NAME]
    run = install(*arguments, "--uninstall", **environment)
    assert run.returncode == 0 and "removed" in run.stderr
    assert not list(place.glob("*mcfskel*"))
    run = install(*arguments, "--uninstall", **environment)
    assert run.returncode == 0 and "was not installed" in run.stderr


def test_meshlab_2025_has_a_folder_for_each_user(tmp_path):
    plugin = host("meshlab-2025.07").plugin
    place = tmp_path / "VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/2025.07"
    check_both_ways(place, plugin, "meshlab-2025.07", XDG_DATA_HOME=str(tmp_path))


def test_meshlab_2020_has_one_for_all(tmp_path):
    plugin = host("meshlab-2020.09").plugin
    place = tmp_path / "lib/x86_64-linux-gnu/meshlab/plugins"
    place.mkdir(parents=True)
    check_both_ways(place, plugin, "meshlab-2020.09", "--prefix", tmp_path)


def a_python(folder: Path, version: str) -> Path:
    """A Python of its own with something that looks like a pymeshlab."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    packages = next((folder / "lib").glob("python*")) / "site-packages"
    (packages / "pymeshlab/lib/plugins").mkdir(parents=True)
    (packages / "pymeshlab/__init__.py").write_text("raise ImportError('a broken plugin')\n")
    (packages / f"pymeshlab-{version}.dist-info").mkdir()
    (packages / f"pymeshlab-{version}.dist-info/METADATA").write_text(
        f"Metadata-Version: 2.1\nName: pymeshlab\nVersion: {version}\n")
    return packages / "pymeshlab/lib/plugins"


def test_the_first_wheel_of_a_release_is_that_release(tmp_path):
    for version, host_name, fits in [("2025.7", "pymeshlab", True), ("2025.7.post1", "pymeshlab", True),
                                     ("2023.12", "pymeshlab-2023.12", True), ("2025.71", "pymeshlab", False),
                                     ("2023.12", "pymeshlab", False)]:
        folder = tmp_path / f"{version}-{host_name}"
        a_python(folder, version)
        run = install(host_name, "--uninstall", "--python", folder / "bin/python")
        assert (run.returncode == 0) == fits, run.stderr
        assert ("was not installed" if fits else f"has pymeshlab {version}, which") in run.stderr


def test_pymeshlab_has_one_in_its_package(tmp_path, plugin):
    place = a_python(tmp_path, "2025.7.post1")
    check_both_ways(place, plugin, "pymeshlab", "--python", tmp_path / "bin/python")


def test_import_then_has_the_filters(tmp_path, plugin):
    """In a copy, by links, of the pymeshlab that the tests use."""
    import pymeshlab
    source = Path(pymeshlab.__file__).parent
    copy = tmp_path / "pymeshlab"
    (copy / "lib/plugins").mkdir(parents=True)
    for path in [*source.glob("*"), *source.glob("lib/*"), *source.glob("lib/plugins/*")]:
        target = copy / path.relative_to(source)
        if path.is_file() and path.suffix == ".so" and path.parent == source:
            target.write_bytes(path.read_bytes())  # finds its libraries beside itself
        elif path.is_file():
            target.symlink_to(path)
    (copy / "lib/plugins" / NAME).write_bytes(plugin.read_bytes())
    script = ("import pymeshlab; m = pymeshlab.MeshSet(); m.create_cube();"
              "m.generate_curve_skeleton_mcf(); print(m.current_mesh().edge_number())")
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True,
                         env=os.environ | {"PYTHONPATH": str(tmp_path)}, timeout=120)
    assert run.returncode == 0, run.stderr
    assert int(run.stdout.split()[-1]) >= 1


class TestRefusals:
    def test_another_pymeshlab(self, tmp_path):
        place = a_python(tmp_path, "2021.10")
        run = install("pymeshlab", "--python", tmp_path / "bin/python")
        assert run.returncode == 1
        assert "has pymeshlab 2021.10, which pymeshlab is not" in run.stderr
        assert not list(place.iterdir())

    def test_no_pymeshlab(self, tmp_path):
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path], check=True)
        run = install("pymeshlab", "--python", tmp_path / "bin/python")
        assert run.returncode == 1 and "has no pymeshlab" in run.stderr

    def test_no_meshlab(self, tmp_path):
        run = install("meshlab-2020.09", "--prefix", tmp_path)
        assert run.returncode == 1 and "no MeshLab 2020.09" in run.stderr

    @pytest.mark.parametrize("arguments", [(), ("meshlab-1999",), ("pymeshlab", "--nonsense"),
                                           ("pymeshlab", "meshlab-2025.07"), ("pymeshlab", "--python")])
    def test_usage(self, arguments):
        run = install(*arguments)
        assert run.returncode == 2 and "usage:" in run.stderr
