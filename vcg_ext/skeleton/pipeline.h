// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: the steps of the pipeline one by one, by Fig. 4; skeletonize.h runs them all.

#ifndef VCG_MCF_PIPELINE_H
#define VCG_MCF_PIPELINE_H

#include <skeleton/resample/resampled_surface.h>
#include <skeleton/poles/poles.h>
#include <skeleton/flow/held_vertices.h>
#include <skeleton/flow/start_of_flow.h>
#include <skeleton/flow/check_stage.h>
#include <skeleton/flow/flow.h>
#include <skeleton/collapse/curve_inside.h>
#include <skeleton/sheets/collapse_with_sheets.h>
#include <skeleton/sheets/keep_sheets.h>
#include <skeleton/refine/refine.h>

#endif
