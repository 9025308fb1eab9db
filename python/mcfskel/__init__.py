# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve skeletons of surfaces by mean curvature flow.

Importing this package loads the plugin into pymeshlab and makes its filters methods of
``pymeshlab.MeshSet``; :data:`FILTERS` lists them. :func:`skeletonize` goes from a mesh to a
:class:`Skeleton` in one call.
"""

from importlib.metadata import PackageNotFoundError, version

from ._plugin import FILTERS, PLUGIN
from ._run import SkeletonError, SkeletonWarning
from ._skeleton import Skeleton, Surface, check_options, load, skeletonize

__all__ = ["FILTERS", "PLUGIN", "Skeleton", "SkeletonError", "SkeletonWarning", "Surface",
           "check_options", "load", "skeletonize"]

try:
    __version__ = version("mcfskel")
except PackageNotFoundError:  # not installed: imported from the sources
    __version__ = "0+unknown"
