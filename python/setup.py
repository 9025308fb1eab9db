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

BUILD_SCRIPT = Path(__file__).resolve().parent.parent / "scripts" / "build.sh"


def plugin() -> Path:
    """The path of the plugin for pymeshlab."""
    if named := os.environ.get("MCFSKEL_PLUGIN"):
        return Path(named)
    if not BUILD_SCRIPT.is_file():
        raise SystemExit("The plugin is built by scripts/build.sh of the project, which is not here: "
                         "install from a checkout, or set MCFSKEL_PLUGIN to a built plugin.")
    run = subprocess.run([str(BUILD_SCRIPT), "pymeshlab"], stdout=subprocess.PIPE, text=True, check=True)
    return Path(run.stdout.splitlines()[-1])


class BuildWithPlugin(build_py):
    def run(self) -> None:
        super().run()
        folder = Path(self.build_lib) / "mcfskel"
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(plugin(), folder / "libfilter_mcfskel.so")


class PlatformWheel(bdist_wheel):
    """The plugin depends on the machine, but on no version of Python."""

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", super().get_tag()[2]


class BinaryDistribution(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=BinaryDistribution,
      cmdclass={"build_py": BuildWithPlugin, "bdist_wheel": PlatformWheel})
