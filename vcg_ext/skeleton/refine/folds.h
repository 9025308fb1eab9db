// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the folds: branches that double back, and tips that lie on another branch.

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

/// Whether a branch lies on the one that leaves its first node towards `next`: all its nodes are
/// nearer to that than a quarter of their radius. Complexity: linear in the branch, and in as much
/// of the other.
inline bool liesOn(const CurveSkeleton& skeleton, const std::vector<std::vector<int>>& neighbours,
	const Branch& branch, int next)
{
	constexpr double near = 0.25;
	std::array<int, 2> edge = {branch.first(), next};
	for (size_t i = 1; i < branch.nodes.size(); ++i) {
		const Point3d& p = skeleton.position[branch.nodes[i]];
		const auto distance = [&](const std::array<int, 2>& to) {
			return Distance(
				p, closestOnSegment(skeleton.position[to[0]], skeleton.position[to[1]], p).point);
		};
		double nearest = distance(edge);
		while (neighbours[edge[1]].size() == 2) {
			const std::vector<int>& ahead = neighbours[edge[1]];
			const std::array<int, 2> following = {edge[1], ahead[ahead[0] == edge[0]]};
			const double further = distance(following);
			if (further > nearest || following[1] == branch.first())
				break;
			edge = following;
			nearest = further;
		}
		if (nearest > near * skeleton.radius[branch.nodes[i]])
			return false;
	}
	return true;
}

/**
 * Removes terminal branches that lie on another branch of their junction, which are left where a
 * branch doubled back at the junction. What had merged into them goes to the junction.
 * @pre radius holds the distances from the surface, or lower bounds. @throws Cancelled
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
		const auto isDoubled = [&](int next) {
			return next != branch.nodes[1] && target[next] == next
				&& liesOn(skeleton, neighbours, branch, next);
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
