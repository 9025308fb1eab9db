// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: curve skeletons as graphs: branches, tables, pruning, resampling, comparison.

#ifndef VCG_MCF_CURVES_H
#define VCG_MCF_CURVES_H

#include <skeleton/graph/branch_table.h>
#include <skeleton/graph/compare_skeletons.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/join_pieces.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/resample_skeleton.h>
#include <skeleton/graph/significance.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/graph/skeleton_radius.h>

#endif
