// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whether the program is built with Qhull.

#ifndef VCG_MCF_HAS_QHULL_H
#define VCG_MCF_HAS_QHULL_H

/**
 * 1 where the program is linked with the reentrant Qhull (-lqhull_r); the CMake target
 * mcfskel::mcfskel does both if it finds one. The presence of the headers does not decide: programs
 * that never ask for a Voronoi diagram would then need the library.
 */
#ifndef MCFSKEL_HAS_QHULL
#define MCFSKEL_HAS_QHULL 0
#endif

namespace vcg::tri::mcf {

/// Whether PoleMethod::Voronoi is available.
constexpr bool hasQhull = MCFSKEL_HAS_QHULL;

} // namespace vcg::tri::mcf

#endif
