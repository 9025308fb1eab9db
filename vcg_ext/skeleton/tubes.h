// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: curve skeletons as closed tubes.

#ifndef VCG_MCF_TUBES_H
#define VCG_MCF_TUBES_H

#include <skeleton/measure/skeleton_tubes.h>

#endif
