# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Test shapes with known skeletons: implicit fields, their polygonisation, their checks."""
