# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All families of shapes around known centrelines, by name."""
from .trees import FAMILIES as TREES
from .tubes import FAMILIES as TUBES

FAMILIES = TUBES | TREES
