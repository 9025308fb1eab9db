// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: from any triangles to the surface of a solid: solidSurface() and its parts.

#ifndef VCG_MCF_SOLID_H
#define VCG_MCF_SOLID_H

#include <skeleton/repair/make_solid.h>
#include <skeleton/repair/mend.h>
#include <skeleton/repair/overlap.h>
#include <skeleton/repair/solid_pieces.h>
#include <skeleton/repair/winding_number.h>
#include <skeleton/repair/wrap.h>

#endif
