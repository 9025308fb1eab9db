// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: what passes from step to step: poles, stages of the flow, curves, sheets.

#ifndef VCG_MCF_STATE_H
#define VCG_MCF_STATE_H

#include <skeleton/flow/stage.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/poles/pole_set.h>
#include <skeleton/sheets/meso_skeleton.h>
#include <skeleton/sheets/vertex_kind.h>

#endif
