// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A hash of points by their coordinates.

#ifndef VCG_MCF_POINT_HASH_H
#define VCG_MCF_POINT_HASH_H

#include <vcg/space/point3.h>

#include <cstdint>
#include <cstring>

namespace vcg::tri::mcf::detail {

/// A 64-bit hash of a point; the same for points that compare equal.
inline std::uint64_t scattered(const Point3d& p)
{
	std::uint64_t hash = 0;
	for (int axis = 0; axis < 3; ++axis) {
		const double x = p[axis] + 0.0; // -0 becomes 0
		std::uint64_t bits;
		std::memcpy(&bits, &x, sizeof bits);
		hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
		hash ^= hash >> 32;
	}
	return hash * 0x9E3779B97F4A7C15u;
}

} // namespace vcg::tri::mcf::detail

#endif
