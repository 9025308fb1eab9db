// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Points at exactly the same position.

#ifndef VCG_MCF_COINCIDENT_POINTS_H
#define VCG_MCF_COINCIDENT_POINTS_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/point_hash.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

namespace vcg::tri::mcf::detail {

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
