#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs an .mlx script on a mesh through whatever pymeshlab this Python has; saves the last layer."""

import argparse

import numpy as np
import pymeshlab

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("plugin")
parser.add_argument("script")
parser.add_argument("mesh")
parser.add_argument("output", help=".npz with nodes, edges, radius and the radius as quality")
options = parser.parse_args()

pymeshlab.load_plugin(options.plugin)
layers = pymeshlab.MeshSet()
layers.load_new_mesh(options.mesh)
layers.load_filter_script(options.script)
layers.apply_filter_script()
curve = layers.current_mesh()
try:
    quality = curve.vertex_scalar_array()
except AttributeError:
    quality = curve.vertex_quality_array()  # its name up to 2022.2
np.savez(options.output, nodes=curve.vertex_matrix(), edges=curve.edge_matrix(), quality=quality,
         radius=curve.vertex_custom_scalar_attribute_array("mcfskel_radius"))
