// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whether the program is built with Qhull.

#ifndef VCG_MCF_HAS_QHULL_H
#define VCG_MCF_HAS_QHULL_H

/**
 * 1 where the program is linked with the reentrant Qhull (-lqhull_r), as the CMake target mcfskel::mcfskel
 * sees to if it finds one. Not taken from whether the headers are there: that would need the library of
 * programs that never ask for a Voronoi diagram.
 */
#ifndef MCFSKEL_HAS_QHULL
#define MCFSKEL_HAS_QHULL 0
#endif

namespace vcg::tri::mcf {

constexpr bool hasQhull = MCFSKEL_HAS_QHULL;

} // namespace vcg::tri::mcf

#endif
