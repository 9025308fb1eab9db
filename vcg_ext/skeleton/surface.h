// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: closed surfaces: mesh, input check, closest points, transferred nodes.

#ifndef VCG_MCF_SURFACE_H
#define VCG_MCF_SURFACE_H

#include <skeleton/input/check_input.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/surface_rounding.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/spatial/transferred_nodes.h>

#endif
