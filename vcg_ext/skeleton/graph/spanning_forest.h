// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A skeleton as rooted trees, for file formats without cycles.

#ifndef VCG_MCF_SPANNING_FOREST_H
#define VCG_MCF_SPANNING_FOREST_H

#include "curve_skeleton.h"

#include <skeleton/core/disjoint_sets.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

/// Rooted trees that span a skeleton.
struct SpanningForest
{
	/// The parent of each node; -1 at a root.
	std::vector<int> parent;
	/// The nodes in an order in which each comes after its parent, branch by branch.
	std::vector<int> order;
	/// The edges that are in no tree, one for each independent cycle, in ascending order.
	std::vector<std::array<int, 2>> cuts;
};

/**
 * Cuts each cycle of a skeleton at its thinnest edge and roots each tree at its thickest node (the
 * first node where no radius is known; of equals the one with the lowest id).
 *
 * An edge is as thick as the thinner of its ends: the trees are maximum spanning trees (Kruskal).
 * Complexity: O(E log E).
 */
inline SpanningForest spanningForest(const CurveSkeleton& skeleton)
{
	const int n = int(skeleton.position.size());
	const bool known = !skeleton.radius.empty();
	const auto thickness = [&](int node) { return known ? skeleton.radius[node] : 0.0; };

	std::vector<int> edgesByThickness(skeleton.edges.size());
	std::iota(edgesByThickness.begin(), edgesByThickness.end(), 0);
	std::stable_sort(edgesByThickness.begin(), edgesByThickness.end(), [&](int e, int f) {
		const auto& [a, b] = skeleton.edges[e];
		const auto& [c, d] = skeleton.edges[f];
		return std::min(thickness(a), thickness(b)) > std::min(thickness(c), thickness(d));
	});

	SpanningForest forest;
	MergeForest joined(n);
	std::vector<std::vector<int>> tree(n);
	for (int e : edgesByThickness) {
		const auto& [a, b] = skeleton.edges[e];
		if (!joined.join(a, b)) {
			forest.cuts.push_back(skeleton.edges[e]);
			continue;
		}
		tree[a].push_back(b);
		tree[b].push_back(a);
	}
	std::sort(forest.cuts.begin(), forest.cuts.end());

	std::vector<int> root(n, -1);
	for (int v = 0; v < n; ++v) {
		int& r = root[joined.find(v)];
		if (r < 0 || thickness(v) > thickness(r))
			r = v;
	}
	forest.parent.assign(n, -1);
	for (int v = 0; v < n; ++v) {
		if (joined.find(v) != v)
			continue;
		std::vector<int> stack(1, root[v]);
		while (!stack.empty()) {
			const int a = stack.back();
			stack.pop_back();
			forest.order.push_back(a);
			std::sort(tree[a].rbegin(), tree[a].rend()); // the lowest neighbour is walked first
			for (int b : tree[a])
				if (b != forest.parent[a]) {
					forest.parent[b] = a;
					stack.push_back(b);
				}
		}
	}
	return forest;
}

} // namespace vcg::tri::mcf

#endif
