# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel that scripts/wheel.sh builds, in a fresh environment, and the source distribution."""

import os
import shutil
import subprocess
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

from conftest import MESHES, ROOT


@pytest.fixture(scope="module")
def wheel(plugin, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheels")
    run = subprocess.run([str(ROOT / "scripts" / "wheel.sh"), str(folder)], stdout=subprocess.PIPE,
                         text=True, check=True, env=os.environ | {"MCFSKEL_PLUGIN": str(plugin)})
    return Path(run.stdout.splitlines()[-1])


def test_is_for_every_python_on_the_systems_of_pymeshlab(wheel):
    assert wheel.name.endswith("-py3-none-manylinux_2_35_x86_64.whl")
    with zipfile.ZipFile(wheel) as content:
        names = content.namelist()
        metadata = next(name for name in names if name.endswith("/METADATA"))
        text = content.read(metadata).decode()
    libraries = [name for name in names if ".so" in name]
    assert libraries == ["mcfskel/libfilter_mcfskel.so"], "Qt, MeshLab and OpenMP are pymeshlab's"
    assert "Requires-Dist: pymeshlab==2025.7.*" in text
    assert any(name.endswith("LICENSE") for name in names)


def test_gives_a_skeleton_in_a_fresh_environment(wheel, tmp_path):
    venv.create(tmp_path / "env", with_pip=True)
    python = tmp_path / "env" / "bin" / "python"
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("MCFSKEL_PLUGIN", "PYTHONPATH")}
    subprocess.run([str(python), "-m", "pip", "install", "-q", "--disable-pip-version-check",
                    "--only-binary", ":all:", str(wheel)], check=True, env=environment)
    run = subprocess.run([str(python), str(ROOT / "scripts" / "try_wheel.py"),
                          str(MESHES / "animal450.off")], cwd=tmp_path, env=environment,
                         capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert "mcfskel.Skeleton" in run.stdout
    run = subprocess.run([str(python), "-c", "import mcfskel; print(mcfskel.__version__)"], cwd=tmp_path,
                         env=environment, capture_output=True, text=True)
    assert run.stdout.strip() == wheel.name.split("-")[1]


def test_the_source_distribution_holds_what_the_plugin_is_built_from(wheel, tmp_path):
    archive, = wheel.parent.glob("mcfskel-*.tar.gz")
    with tarfile.open(archive) as content:
        content.extractall(tmp_path)
    project = next(tmp_path.iterdir()) / "project"
    for folder in ["cmake", "filter_mcfskel", "vcg_ext", "scripts/lib"]:
        theirs = {p.relative_to(project) for p in (project / folder).rglob("*") if p.is_file()}
        ours = {p.relative_to(ROOT) for p in (ROOT / folder).rglob("*")
                if p.is_file() and "__pycache__" not in p.parts}
        assert theirs == ours
    # Its build script runs, though it stands elsewhere: without MeshLab's sources it says so.
    run = subprocess.run([str(project / "scripts" / "build.sh"), "--help"], capture_output=True,
                         text=True)
    assert "usage: scripts/build.sh" in run.stdout + run.stderr
    if shutil.which("cmake"):
        run = subprocess.run(["cmake", "-S", str(project), "-B", str(tmp_path / "build"),
                              "-DMESHLAB_SRC=/nowhere"], capture_output=True, text=True)
        assert "MESHLAB_SRC" in run.stderr, "all that cmake includes before is there"
