// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The radius of skeleton nodes into which no surface vertex has merged.

#ifndef VCG_MCF_SKELETON_RADIUS_H
#define VCG_MCF_SKELETON_RADIUS_H

#include <cstddef>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Fills in unknown radii (negative) from the known ones, ring by ring: each takes the mean of its
 * neighbours. A node that is not connected to any known radius stays negative.
 * @param neighbours of each node.
 * Complexity: O(V * longest chain of unknown ones).
 */
inline void fillUnknownRadii(
	std::vector<double>& radius, const std::vector<std::vector<int>>& neighbours)
{
	for (bool changed = true; changed;) {
		changed = false;
		const std::vector<double> before = radius;
		for (size_t v = 0; v < before.size(); ++v) {
			if (before[v] >= 0)
				continue;
			double sum = 0;
			int count = 0;
			for (int w : neighbours[v])
				if (before[w] >= 0) {
					sum += before[w];
					++count;
				}
			if (count) {
				radius[v] = sum / count;
				changed = true;
			}
		}
	}
}

} // namespace vcg::tri::mcf

#endif
