// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the folds: branches that double back, hairpins, and tips beside another branch.

#ifndef VCG_MCF_FOLDS_H
#define VCG_MCF_FOLDS_H

#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/segment.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// A way there and back within a branch: indices of its nodes, the first and the last that stay, and
/// the one where it turns.
struct Hairpin
{
	int begin, turn, end;
};

/// Points along a branch, a fifth of their balls' radii apart.
struct BranchSamples
{
	std::vector<Point3d> point;
	std::vector<double> radius, way;
	std::vector<int> node; ///< index in the branch of the last node up to there

	BranchSamples(const CurveSkeleton& skeleton, const Branch& branch)
	{
		constexpr double step = 0.2;     // radii
		constexpr double maxPieces = 16; // of an edge
		double length = 0;
		for (size_t i = 0; i < branch.nodes.size(); ++i) {
			const size_t v = size_t(branch.nodes[i]);
			add(skeleton.position[v], skeleton.radius[v], length, int(i));
			if (i + 1 == branch.nodes.size())
				break;
			const size_t w = size_t(branch.nodes[i + 1]);
			const double edge = Distance(skeleton.position[v], skeleton.position[w]);
			const double small = std::min(skeleton.radius[v], skeleton.radius[w]);
			const int pieces =
				small > 0 ? int(std::clamp(std::ceil(edge / (step * small)), 1.0, maxPieces)) : 1;
			for (int k = 1; k < pieces; ++k) {
				const double t = double(k) / pieces;
				add(skeleton.position[v] + (skeleton.position[w] - skeleton.position[v]) * t, small,
					length + t * edge, int(i));
			}
			length += edge;
		}
	}

	int size() const { return int(point.size()); }

private:
	void add(const Point3d& p, double r, double along, int v)
	{
		point.push_back(p);
		radius.push_back(r);
		way.push_back(along);
		node.push_back(v);
	}
};

/**
 * The hairpins of a branch: from the turn on, both strands stay within half a radius of each other,
 * of the smaller of their balls, and both are longer than the radius of the balls where they end.
 * Their points are matched step by step, as by the discrete Frechet distance. A loop around a hole is
 * none: its strands part.
 * Complexity: O(V), and O(H^2) for H nodes of a hairpin, if nodes are a fraction of a radius apart.
 */
inline std::vector<Hairpin> hairpins(const CurveSkeleton& skeleton, const Branch& branch)
{
	constexpr double apart = 0.5, deepest = 1; // radii
	const BranchSamples samples(skeleton, branch);
	struct Strands
	{
		int begin, end;
		double depth; ///< length of the shorter one, over the larger radius at their ends
	};
	const auto matchedFrom = [&](int turn) {
		Strands strands = {turn, turn, 0};
		for (;;) {
			constexpr int steps[][2] = {{1, 1}, {1, 0}, {0, 1}};
			Strands next = strands;
			double nearest = std::numeric_limits<double>::infinity();
			for (const auto& [back, ahead] : steps) {
				const int a = strands.begin - back, b = strands.end + ahead;
				if (a < 0 || b >= samples.size())
					continue;
				const double distance = Distance(samples.point[a], samples.point[b]);
				if (distance <= apart * std::min(samples.radius[a], samples.radius[b])
					&& distance < nearest) {
					nearest = distance;
					next = {a, b, 0};
				}
			}
			if (next.begin == strands.begin && next.end == strands.end)
				break;
			strands = next;
		}
		const double radius = std::max(samples.radius[strands.begin], samples.radius[strands.end]);
		const double shorter = std::min(samples.way[turn] - samples.way[strands.begin],
			samples.way[strands.end] - samples.way[turn]);
		strands.depth = radius > 0 ? shorter / radius : 0;
		return strands;
	};
	std::vector<Hairpin> found;
	int free = 0; // what is before is in hairpins that have been found
	for (int i = 0; i < samples.size(); ++i) {
		Strands best = matchedFrom(i);
		if (!(best.depth > deepest) || best.begin < free)
			continue;
		int turn = i;
		for (int j = i + 1; j < best.end; ++j)
			if (const Strands other = matchedFrom(j);
				other.depth > best.depth && other.begin >= free) {
				best = other;
				turn = j;
			}
		const bool isWithinEdge = samples.node[best.end] == samples.node[best.end - 1];
		const int end = samples.node[best.end] + (isWithinEdge ? 1 : 0);
		found.push_back({samples.node[best.begin], samples.node[turn], end});
		i = best.end;
		while (free < samples.size() && samples.node[free] < end)
			++free;
	}
	return found;
}

/**
 * Removes hairpins(), again until there are none: their nodes go to the first and the last one. Where
 * the last one is a tip, the branch ends at the turn instead. Limbs into which such a way led have to
 * get branches afterwards. Cycles keep three edges.
 * @pre radius holds the distances from the surface, or lower bounds. @throws Cancelled
 */
inline CurveSkeleton withoutHairpins(
	CurveSkeleton skeleton, const ClosestSurface& surface, const Progress& progress = Progress())
{
	for (;;) {
		std::vector<int> target(skeleton.position.size());
		std::iota(target.begin(), target.end(), 0);
		bool isAny = false;
		const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
		const std::vector<Branch> branches = skeletonBranches(skeleton);
		const FewestEdges fewest(branches);
		for (const Branch& branch : branches) {
			progress.check();
			const auto mergeInto = [&](int begin, int end, int node) {
				for (int i = begin; i < end; ++i)
					target[size_t(branch.nodes[size_t(i)])] = branch.nodes[size_t(node)];
				isAny = isAny || begin < end;
			};
			const auto isTip = [&](int node) {
				return neighbours[size_t(branch.nodes[size_t(node)])].size() == 1;
			};
			int edges = int(branch.nodes.size()) - 1;
			for (const auto& [begin, turn, end] : hairpins(skeleton, branch)) {
				if (isTip(end))
					mergeInto(turn + 1, end + 1, turn);
				else if (isTip(begin))
					mergeInto(begin, turn, turn);
				else if (end > begin + 1 && edges - (end - begin - 1) >= fewest.of(branch)
					&& isEdgeInside(skeleton, surface, branch.nodes[size_t(begin)],
						branch.nodes[size_t(end)])) {
					edges -= end - begin - 1;
					mergeInto(begin + 1, turn + 1, begin);
					mergeInto(turn + 1, end, end);
				}
			}
		}
		if (!isAny)
			return skeleton;
		skeleton = mergeNodes(skeleton, target);
	}
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
