# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the plugin once and binds its filters."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

import pymeshlab

PLUGIN = Path(os.environ.get("MCFSKEL_PLUGIN") or Path(__file__).with_name("libfilter_mcfskel.so"))
"""The plugin's file: the one in this package, or the one that the environment variable MCFSKEL_PLUGIN names."""


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


FILTERS: list[str] = _load()
"""The names of the plugin's filters, each a method of ``pymeshlab.MeshSet`` now."""


def _library() -> ctypes.CDLL | None:
    """The plugin's functions; None if another file of the plugin was loaded before."""
    try:  # the one that is loaded, never another copy
        return ctypes.CDLL(str(PLUGIN), mode=getattr(os, "RTLD_NOLOAD", 0) | getattr(os, "RTLD_NOW", 0))
    except OSError:
        return None


_LIBRARY = _library()


def cancel_when(flag: ctypes.c_int | None) -> None:
    """The filters that this thread runs from now on end as soon as the flag is not 0; None: never."""
    if _LIBRARY is not None and hasattr(_LIBRARY, "mcfskel_cancel_when"):
        _LIBRARY.mcfskel_cancel_when(ctypes.byref(flag) if flag is not None else None)
