// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Points at exactly the same position.

#ifndef VCG_MCF_COINCIDENT_POINTS_H
#define VCG_MCF_COINCIDENT_POINTS_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/point3.h>

#include <cstdint>
#include <cstring>
#include <vector>

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

/**
 * For each point the first one at exactly the same position.
 * @pre no coordinate is NaN.
 * @throws Cancelled. Complexity: about O(V).
 */
inline std::vector<int> firstCoincident(
	const std::vector<Point3d>& points, const Progress& progress, const char* what)
{
	// Hash table with linear probing of the points met so far, at least a third of it empty.
	int bits = 4;
	while (size_t(1) << bits < points.size() + points.size() / 2)
		++bits;
	const size_t last = (size_t(1) << bits) - 1;
	std::vector<int> table = filledArray(last + 1, -1, progress);
	std::vector<int> first;
	first.reserve(points.size());
	reportedLoop(int(points.size()), progress, what, [&](int i) {
		size_t place = size_t(scattered(points[i]) >> (64 - bits));
		while (table[place] >= 0 && points[table[place]] != points[i])
			place = (place + 1) & last;
		if (table[place] < 0)
			table[place] = i;
		first.push_back(table[place]);
	});
	return first;
}

} // namespace vcg::tri::mcf::detail

#endif
