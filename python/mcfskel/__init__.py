# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve skeletons of surfaces by mean curvature flow.

Importing this package loads the plugin into pymeshlab and makes its filters methods of
``pymeshlab.MeshSet``; ``FILTERS`` lists them. ``skeletonize()`` goes from a mesh to a
``Skeleton`` in one call.
"""

from importlib.metadata import PackageNotFoundError, version

from ._plugin import FILTERS, PLUGIN
from ._run import SkeletonError, SkeletonWarning
from ._skeleton import Skeleton, Surface, check_options, load, skeletonize

#: In the order of the reference, docs/python_reference.md.
__all__ = ["skeletonize", "Skeleton", "Surface", "load", "check_options", "SkeletonError", "SkeletonWarning",
           "FILTERS", "PLUGIN"]


def _installed_version() -> str:
    try:
        return version("mcfskel")
    except PackageNotFoundError:
        return "0+unknown"


__version__: str = _installed_version()
"""The version that is installed; ``0+unknown`` where the package is imported from its sources."""
