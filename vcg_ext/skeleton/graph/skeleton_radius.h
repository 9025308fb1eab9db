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
 * Complexity: O(V + E).
 */
inline void fillUnknownRadii(
	std::vector<double>& radius, const std::vector<std::vector<int>>& neighbours)
{
	// The unknown nodes beside the last ring; found[i] is the radius of ring[i].
	std::vector<int> ring;
	std::vector<double> found;
	std::vector<char> isFound(radius.size(), 0);
	const auto addUnknownBeside = [&](size_t v) {
		for (int w : neighbours[v])
			if (radius[size_t(w)] < 0 && !isFound[size_t(w)]) {
				isFound[size_t(w)] = 1;
				ring.push_back(w);
			}
	};
	for (size_t v = 0; v < radius.size(); ++v)
		if (radius[v] >= 0)
			addUnknownBeside(v);
	while (!ring.empty()) {
		found.clear();
		for (int v : ring) {
			double sum = 0;
			int count = 0;
			for (int w : neighbours[size_t(v)])
				if (radius[size_t(w)] >= 0) {
					sum += radius[size_t(w)];
					++count;
				}
			found.push_back(sum / count);
		}
		for (size_t i = 0; i < ring.size(); ++i)
			radius[size_t(ring[i])] = found[i];
		const std::vector<int> last = std::move(ring);
		ring.clear();
		for (int v : last)
			addUnknownBeside(size_t(v));
	}
}

} // namespace vcg::tri::mcf

#endif
