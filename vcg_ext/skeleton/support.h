// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: what a host needs: errors, parameters, limits, progress, notes, parallel loops.

#ifndef VCG_MCF_SUPPORT_H
#define VCG_MCF_SUPPORT_H

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#endif
