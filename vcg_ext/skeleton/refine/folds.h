// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the folds: branches that double back, and tips beside another branch.

#ifndef VCG_MCF_FOLDS_H
#define VCG_MCF_FOLDS_H

#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/segment.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * Removes the nodes where a branch doubles back: it turns by more than 120 degrees, and the way
 * from the node before to the one after it is inside and shorter. The contraction of a long thin
 * part leaves such folds, which centring would keep, on top of each other. What had merged into
 * such a node goes to the one before. Cycles keep three edges.
 * @pre radius holds the distances from the surface, or lower bounds. @throws Cancelled
 */
inline CurveSkeleton withoutFolds(
	CurveSkeleton skeleton, const ClosestSurface& surface, const Progress& progress = Progress())
{
	constexpr double sharpest = -0.5; // cosine of the turn
	std::vector<int> target(skeleton.position.size());
	std::iota(target.begin(), target.end(), 0);
	bool isAny = false;
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	const FewestEdges fewest(branches);
	for (const Branch& branch : branches) {
		progress.check();
		int edges = int(branch.nodes.size()) - 1;
		std::vector<int> kept;
		for (int next : branch.nodes) {
			while (kept.size() >= 2 && edges > fewest.of(branch)) {
				const int before = kept[kept.size() - 2], node = kept.back();
				const Point3d &p = skeleton.position[before], &q = skeleton.position[node],
							  &r = skeleton.position[next];
				const double turn = (q - p) * (r - q);
				if (next == before || turn > sharpest * Distance(p, q) * Distance(q, r)
					|| !isEdgeInside(skeleton, surface, before, next))
					break;
				target[node] = before;
				isAny = true;
				--edges;
				kept.pop_back();
			}
			kept.push_back(next);
		}
	}
	if (!isAny)
		return skeleton;
	for (int& t : target) // what a node went to may have gone itself
		while (target[t] != t)
			t = target[t];
	return mergeNodes(skeleton, target);
}

/// Whether a terminal branch ends beside the one that leaves its first node towards `next`: the ball
/// of its tip contains a point of that branch, at most length + radius along it and closer to the tip
/// than half the length. Limbs that part at 30 degrees or more end farther apart.
/// @param length  of the terminal branch.
/// Complexity: linear in the nodes of the other branch up to about a radius from its start, or for as
/// long as it runs beside the terminal branch.
inline bool endsBeside(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, const Branch& fromJunction, double length,
	int next)
{
	const Point3d& tip = skeleton.position[fromJunction.last()];
	const double radius = skeleton.radius[fromJunction.last()];
	const double near = std::min(radius, length / 2);
	std::array<int, 2> edge = {fromJunction.first(), next};
	for (double left = length + radius; left >= 0;) {
		const Point3d &a = skeleton.position[edge[0]], &b = skeleton.position[edge[1]];
		const double step = Distance(a, b);
		if (Distance(tip, a) > near + std::max(left, step)) // what is left does not reach the ball
			return false;
		if (Distance(tip, closestOnSegment(a, b, tip).point) < near)
			return true;
		const std::vector<int>& ahead = neighbours[edge[1]];
		if (ahead.size() != 2 || edge[1] == fromJunction.first())
			return false;
		left -= step;
		edge = {edge[1], ahead[ahead[0] == edge[0]]};
	}
	return false;
}

/**
 * Removes terminal branches that end beside another branch of their junction, see endsBeside(). They
 * remain where a branch doubled back at the junction, or grow beside a branch that is off the medial
 * axis. What had merged into them goes to the junction.
 * @pre the radius of tips is their distance from the surface, or a lower bound. @throws Cancelled
 */
inline CurveSkeleton withoutDoubledTips(
	CurveSkeleton skeleton, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	std::vector<int> target(skeleton.position.size());
	std::iota(target.begin(), target.end(), 0);
	bool isAny = false;
	for (size_t tip = 0; tip < neighbours.size(); ++tip) {
		if (neighbours[tip].size() != 1)
			continue;
		progress.check();
		Branch branch = branchAlong(neighbours, int(tip), neighbours[tip][0]);
		const int junction = branch.last();
		if (neighbours[junction].size() < 3)
			continue;
		std::reverse(branch.nodes.begin(), branch.nodes.end());
		const double length = branchLength(skeleton, branch);
		const auto isDoubled = [&](int next) {
			return next != branch.nodes[1] && target[next] == next
				&& endsBeside(skeleton, neighbours, branch, length, next);
		};
		if (std::none_of(neighbours[junction].begin(), neighbours[junction].end(), isDoubled))
			continue;
		for (int node : branch.nodes)
			target[node] = junction;
		isAny = true;
	}
	return isAny ? mergeNodes(skeleton, target) : skeleton;
}

} // namespace vcg::tri::mcf::refining

#endif
