// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: quality of a skeleton, medial axis, union of balls, segmentation.

#ifndef VCG_MCF_MEASURES_H
#define VCG_MCF_MEASURES_H

#include <skeleton/measure/medial_axis.h>
#include <skeleton/measure/medial_balls.h>
#include <skeleton/measure/segmentation.h>
#include <skeleton/measure/skeleton_measures.h>

#endif
