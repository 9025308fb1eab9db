// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How much of the shape each branch stands for, and skeletons of less detail.

#ifndef VCG_MCF_SIGNIFICANCE_H
#define VCG_MCF_SIGNIFICANCE_H

#include "curve_skeleton.h"
#include "skeleton_branches.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * How much of the shape a terminal branch stands for: 1 - R / D, where R is the radius of the ball
 * at its root, the node that it hangs on, and D the distance from there to the farthest point that
 * the balls on the branch reach. 0: all are within the ball at the root; 1/2: they stick out of it
 * by its radius; near 1: the limb is long compared to the ball at its root. It has no unit, and
 * does not depend on where within a round end the branch ends.
 *
 * @param fromRoot  the nodes of the branch, its root first.
 * @pre the radius of the nodes is their distance from the surface.
 * Source: the shape tubularity 1 - R / (burn time) of Yan, Sykes, Chambers, Letscher, Ju, "Erosion
 *         Thickness on Medial Axes of 3D Shapes", ACM Trans. Graph. 35(4), 2016, but measured along
 *         the straight line from the root.
 */
inline double branchSignificance(const CurveSkeleton& skeleton, const std::vector<int>& fromRoot)
{
	const int root = fromRoot.front();
	const double radius = skeleton.radius[root];
	double reach = radius;
	for (int v : fromRoot)
		reach = std::max(
			reach, Distance(skeleton.position[v], skeleton.position[root]) + skeleton.radius[v]);
	return reach > 0 ? 1 - radius / reach : 0;
}

/// The hierarchy of a skeleton's branches, with their significance: see nestedBranches().
struct NestedBranches
{
	/// For each node that of its branch; 1 on the trunk.
	std::vector<double> significance;
	/// For each node the node that its branch hangs on; on the trunk the node itself.
	std::vector<int> root;
};

/**
 * Takes a skeleton apart into branches that hang on each other. Terminal branches are removed, the
 * least significant first and one at a time, since a branch that loses its junction becomes part of
 * a longer one, until the trunk is left: the cycles and the ways between them, or in a tree one
 * chain from tip to tip. The significance of a branch is at least that of any that hangs on it. So
 * what is above any threshold is connected, and contains what is above a higher one.
 * @pre as for branchSignificance().
 * @throws Cancelled. Complexity: O(N log N), and O(N) for each branch that becomes longer.
 */
inline NestedBranches nestedBranches(
	const CurveSkeleton& skeleton, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const size_t count = neighbours.size();
	NestedBranches nested = {std::vector<double>(count, 1.0), std::vector<int>(count)};
	std::iota(nested.root.begin(), nested.root.end(), 0);
	std::vector<size_t> degree(count);
	for (size_t v = 0; v < count; ++v)
		degree[v] = neighbours[v].size();
	std::vector<char> gone(count, 0);
	std::vector<double> value(count, 0); // of tips
	std::vector<double> worn(count, 0);  // of roots: the maximum over the branches removed there
	std::vector<std::vector<int>> tipsOf(count);
	std::set<std::pair<double, int>> queue; // value, tip
	/// From its root to its tip; empty if the rest of the component is a chain.
	const auto branchOf = [&](int tip) {
		std::vector<int> nodes(1, tip);
		for (int before = -1, at = tip; at == tip || degree[at] == 2;) {
			const std::vector<int>& around = neighbours[at];
			const int next = *std::find_if(
				around.begin(), around.end(), [&](int w) { return w != before && !gone[w]; });
			before = std::exchange(at, next);
			nodes.push_back(at);
		}
		if (degree[nodes.back()] == 1)
			nodes.clear();
		std::reverse(nodes.begin(), nodes.end());
		return nodes;
	};
	const auto push = [&](int tip) {
		const std::vector<int> nodes = branchOf(tip);
		if (nodes.empty())
			return;
		value[tip] = branchSignificance(skeleton, nodes);
		tipsOf[nodes.front()].push_back(tip);
		queue.emplace(value[tip], tip);
	};
	for (size_t v = 0; v < count; ++v)
		if (degree[v] == 1)
			push(int(v));
	detail::Ticker ticker(progress, "Pruning the skeleton", int(queue.size()));
	while (!queue.empty()) {
		ticker.tick();
		const int tip = queue.begin()->second;
		queue.erase(queue.begin());
		const std::vector<int> nodes = branchOf(tip);
		const int root = nodes.front();
		double worth = value[tip];
		for (size_t i = 1; i < nodes.size(); ++i)
			worth = std::max(worth, worn[nodes[i]]);
		for (size_t i = 1; i < nodes.size(); ++i) {
			gone[nodes[i]] = 1;
			nested.significance[nodes[i]] = worth;
			nested.root[nodes[i]] = root;
		}
		worn[root] = std::max(worn[root], worth);
		if (--degree[root] != 2)
			continue;
		for (int other : std::exchange(tipsOf[root], {}))
			if (!gone[other]) { // it reaches to the next junction now
				queue.erase({value[other], other});
				push(other);
			}
	}
	return nested;
}

/**
 * The part of a skeleton whose significance is at least `minimum`, positions unchanged. What had
 * merged into the rest goes to the node that it hung on.
 * @param nested  the branches of this skeleton. @param minimum  at most 1.
 * @return the part with its significance. Complexity: O(N + E log E + surface vertices).
 */
inline CurveSkeleton significantPart(
	CurveSkeleton skeleton, const NestedBranches& nested, double minimum)
{
	std::vector<int> target(skeleton.position.size());
	for (size_t v = 0; v < target.size(); ++v) {
		int to = int(v);
		while (nested.significance[to] < minimum)
			to = nested.root[to];
		target[v] = to;
	}
	skeleton.significance = nested.significance;
	return mergeNodes(skeleton, target);
}

} // namespace vcg::tri::mcf

#endif
