# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the plugin into the package: the one that MCFSKEL_PLUGIN names, or one built here and now."""

import os
import shutil
import subprocess
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = Path(__file__).resolve().parent
#: Where the plugin's sources are: around this folder in a checkout, within it in a source distribution.
PROJECT = HERE / "project" if (HERE / "project").is_dir() else HERE.parent
#: What the plugin is built from.
SOURCES = ("CMakeLists.txt", "LICENSE", "README.md", "cmake", "filter_mcfskel", "vcg_ext",
           "scripts/build.sh", "scripts/lib")


def plugin() -> Path:
    """The path of the plugin for pymeshlab."""
    if named := os.environ.get("MCFSKEL_PLUGIN"):
        return Path(named)
    script = PROJECT / "scripts" / "build.sh"
    if not script.is_file():
        raise SystemExit("The plugin is built by scripts/build.sh of the project, which is not here: "
                         "install from a checkout, or set MCFSKEL_PLUGIN to a built plugin.")
    run = subprocess.run([str(script), "pymeshlab"], stdout=subprocess.PIPE, text=True, check=True)
    return Path(run.stdout.splitlines()[-1])


class BuildWithPlugin(build_py):
    def run(self) -> None:
        super().run()
        folder = Path(self.build_lib) / "mcfskel"
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(plugin(), folder / "libfilter_mcfskel.so")


class SourcesWithPlugin(sdist):
    """Carries the plugin's sources, so that pip can build it from the source distribution alone."""

    def make_release_tree(self, base_dir: str, files: list[str]) -> None:
        super().make_release_tree(base_dir, files)
        for name in SOURCES:
            source, target = PROJECT / name, Path(base_dir, "project", name)
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy2(source, target)


class PlatformWheel(bdist_wheel):
    """The plugin depends on the machine, but on no version of Python."""

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", super().get_tag()[2]


class BinaryDistribution(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=BinaryDistribution,
      cmdclass={"build_py": BuildWithPlugin, "bdist_wheel": PlatformWheel,
                "sdist": SourcesWithPlugin})
