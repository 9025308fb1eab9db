# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the plugin once and binds its filters."""

import os
from pathlib import Path

import pymeshlab

#: The plugin's file: the one in this package, or the one that the environment variable
#: MCFSKEL_PLUGIN names.
PLUGIN = Path(os.environ.get("MCFSKEL_PLUGIN") or Path(__file__).with_name("libfilter_mcfskel.so"))


def _load() -> list[str]:
    """Loads the plugin, unless a script already has, and returns the names of its filters."""
    if "generate_curve_skeleton_mcf" not in pymeshlab.filter_list():
        if not PLUGIN.is_file():
            raise ImportError(f"There is no plugin at '{PLUGIN}': install the package with "
                              "'pip install ./python' from a checkout of the project.")
        pymeshlab.load_plugin(str(PLUGIN))
    names = sorted(name for name in pymeshlab.filter_list() if name.endswith("_mcf"))
    for name in names:
        setattr(pymeshlab.MeshSet, name, pymeshlab.bind_function(name))
    return names


#: The names of the plugin's filters, each a method of ``pymeshlab.MeshSet`` now.
FILTERS = _load()
