// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The range of coordinates and lengths that the library accepts.

#ifndef VCG_MCF_SHAPE_LIMITS_H
#define VCG_MCF_SHAPE_LIMITS_H

#include <vcg/space/point3.h>

#include <cmath>

namespace vcg::tri::mcf {

/// Mesh units. Single precision, in which some hosts keep their meshes, holds these with room for
/// sums; their cubes are far from the limits of double precision.
constexpr double maxCoordinate = 1e36, minSize = 1e-36;

inline bool isFinitePlace(const Point3d& p)
{
	return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Whether a point is finite and not too far from the origin.
inline bool isUsablePlace(const Point3d& p)
{
	for (int k = 0; k < 3; ++k)
		if (!(std::abs(p[k]) <= maxCoordinate)) // negated, so that NaN fails
			return false;
	return true;
}

/// Whether a length can be the diagonal of a shape.
inline bool isUsableSize(double length)
{
	return length >= minSize && length <= 4 * maxCoordinate; // the diagonal of the range is shorter
}

} // namespace vcg::tri::mcf

#endif
