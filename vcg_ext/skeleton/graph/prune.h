// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Pruning: terminal branches that are too many, junctions that are one. Cycles stay.

#ifndef VCG_MCF_PRUNE_H
#define VCG_MCF_PRUNE_H

#include "curve_skeleton.h"
#include "significance.h"
#include "skeleton_branches.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// All nodes of a branch go into one of them, all others stay.
inline std::vector<int> mergingTarget(size_t nodes, const Branch& branch, int into)
{
	std::vector<int> target(nodes);
	std::iota(target.begin(), target.end(), 0);
	for (int v : branch.nodes)
		target[v] = into;
	return target;
}

/// Whether the ends of a branch have a neighbour in common that is not on the branch: with the ends
/// merged, a cycle would become a double edge.
inline bool closesTriangle(const std::vector<std::vector<int>>& neighbours, const Branch& branch)
{
	const std::vector<int>& a = neighbours[branch.first()];
	const std::vector<int>& b = neighbours[branch.last()];
	return std::any_of(a.begin(), a.end(),
		[&](int v) { return v != branch.nodes[1] && std::binary_search(b.begin(), b.end(), v); });
}

} // namespace detail

/**
 * Removes the terminal branches for which measure(skeleton, branch) is below `least`, the least
 * first and one at a time, since a branch that loses its junction becomes part of a longer one. The
 * branch is handed over from its junction to its tip. What had merged into it goes to the junction.
 *
 * A component that is a single chain keeps it. No cycle is touched: every edge of a terminal branch
 * is a bridge.
 * @throws Cancelled. Complexity: O(removed branches * (V + E log E + surface vertices)).
 */
template <class Measure>
CurveSkeleton withoutTerminalBranches(CurveSkeleton skeleton, double least, const Measure& measure,
	const Progress& progress = Progress())
{
	for (;;) {
		progress.report(0, "Pruning the skeleton");
		const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
		const auto degree = [&](int v) { return neighbours[v].size(); };
		double worst = least;
		Branch doomed;
		for (Branch& branch : skeletonBranches(skeleton)) {
			if ((degree(branch.first()) == 1) == (degree(branch.last()) == 1))
				continue;
			if (degree(branch.first()) == 1)
				std::reverse(branch.nodes.begin(), branch.nodes.end());
			const double value = measure(skeleton, branch);
			if (value < worst) {
				worst = value;
				doomed = std::move(branch);
			}
		}
		if (doomed.nodes.empty())
			return skeleton;
		skeleton = mergeNodes(
			skeleton, detail::mergingTarget(skeleton.position.size(), doomed, doomed.first()));
	}
}

/**
 * Merges junctions whose connecting branch has measure(skeleton, larger, smaller, detour) below
 * `least`, the least first: `larger` is the junction with the larger radius, which stays in its
 * place, and `detour` what the branch is longer than the straight line between both. Branches that
 * close a cycle are kept.
 * @throws Cancelled. Complexity: as withoutTerminalBranches().
 */
template <class Measure>
CurveSkeleton withMergedJunctions(CurveSkeleton skeleton, double least, const Measure& measure,
	const Progress& progress = Progress())
{
	for (;;) {
		progress.report(0, "Merging junctions");
		const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
		const std::vector<Branch> branches = skeletonBranches(skeleton);
		std::map<std::pair<int, int>, int> parallel;
		for (const Branch& branch : branches)
			++parallel[std::minmax(branch.first(), branch.last())];
		double worst = least;
		const Branch* inner = nullptr;
		int into = -1;
		for (const Branch& branch : branches) {
			const int a = branch.first(), b = branch.last();
			if (branch.isClosed() || neighbours[a].size() < 3 || neighbours[b].size() < 3
				|| parallel[std::minmax(a, b)] > 1 || detail::closesTriangle(neighbours, branch))
				continue;
			const bool first = skeleton.radius[a] >= skeleton.radius[b];
			const double detour = branchLength(skeleton, branch)
				- Distance(skeleton.position[a], skeleton.position[b]);
			const double value = measure(skeleton, first ? a : b, first ? b : a, detour);
			if (value < worst) {
				worst = value;
				inner = &branch;
				into = first ? a : b;
			}
		}
		if (!inner)
			return skeleton;
		skeleton =
			mergeNodes(skeleton, detail::mergingTarget(skeleton.position.size(), *inner, into));
	}
}

/// The prominence() of a terminal branch, seen from its junction.
inline double terminalProminence(const CurveSkeleton& skeleton, const Branch& fromJunction)
{
	return prominence(skeleton, fromJunction.last(), fromJunction.first());
}

/// What prune() removes. Lengths in mesh units.
struct PruneParameters
{
	/// Terminal branches with less prominence() are spurs; in [0, 1], 0: none is.
	double spurProminence = 0.1;
	/// Terminal branches shorter than this go; >= 0.
	double shortestBranch = 0;
	/// Terminal branches whose mean radius is less than this go; >= 0.
	double leastRadius = 0;
	/// Branches stay whose significance is at least 1 - detail, see nestedBranches(); in [0, 1], 1: all.
	double detail = 1;
	/// Whether two junctions that are closer to each other than the larger one's radius, along their
	/// branch, become one.
	bool mergeJunctions = true;

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		require(spurProminence >= 0 && spurProminence <= 1, "spur_prominence", "between 0 and 1");
		require(detail >= 0 && detail <= 1, "detail", "between 0 and 1");
		require(shortestBranch >= 0 && std::isfinite(shortestBranch), "min_length", "at least 0");
		require(leastRadius >= 0 && std::isfinite(leastRadius), "min_radius", "at least 0");
	}

private:
	static void require(bool holds, const char* name, const char* range)
	{
		if (!holds)
			throw InvalidParameter(std::string("Parameter ") + name + " must be " + range + ".");
	}
};

/// Mean radius of a terminal branch over its length, its junction left out; mesh units.
inline double meanTerminalRadius(const CurveSkeleton& skeleton, const Branch& fromJunction)
{
	double sum = 0, length = 0;
	for (size_t i = 2; i < fromJunction.nodes.size(); ++i) {
		const int a = fromJunction.nodes[i - 1], b = fromJunction.nodes[i];
		const double edge = Distance(skeleton.position[a], skeleton.position[b]);
		sum += edge * (skeleton.radius[a] + skeleton.radius[b]) / 2;
		length += edge;
	}
	return length > 0 ? sum / length : skeleton.radius[fromJunction.last()];
}

/**
 * Prunes a skeleton: first the sure spurs, by prominence(), then what is below the detail, then the terminal
 * branches that are too short, then those that are too thin, at last merges junctions and looks for spurs
 * again. The number of cycles and of components never changes.
 *
 * @param skeleton  its radius should be the distance to the surface; the mean distance to the surface
 *                  vertices that merged into a node does as well.
 * @return nodes of `skeleton` that are left, in their order, in their places, with their radii and their
 *         significance; `node` leads to where what was removed hung.
 * @throws InvalidParameter, Cancelled.
 * Complexity: O(removed branches * (V + E log E + surface vertices)).
 * Source: ours.
 */
inline CurveSkeleton prune(const CurveSkeleton& skeleton, const PruneParameters& parameters,
	const Progress& progress = Progress())
{
	parameters.check();
	const auto withoutSpurs = [&](CurveSkeleton s, double from, double to) {
		return parameters.spurProminence > 0 ? withoutTerminalBranches(std::move(s),
				   parameters.spurProminence, terminalProminence, progress.part(from, to))
											 : s;
	};
	CurveSkeleton pruned = withoutSpurs(skeleton, 0, 0.2);
	const NestedBranches nested = nestedBranches(pruned, progress.cancelOnly());
	pruned = significantPart(std::move(pruned), nested, 1 - parameters.detail);
	pruned = withoutTerminalBranches(
		std::move(pruned), parameters.shortestBranch, branchLength, progress.part(0.2, 0.4));
	pruned = withoutTerminalBranches(
		std::move(pruned), parameters.leastRadius, meanTerminalRadius, progress.part(0.4, 0.6));
	if (parameters.mergeJunctions) {
		pruned = withMergedJunctions(
			std::move(pruned), 1,
			[](const CurveSkeleton& s, int larger, int smaller, double detour) {
				const double length = Distance(s.position[larger], s.position[smaller]) + detour;
				return length / std::max(s.radius[larger], 1e-300);
			},
			progress.part(0.6, 0.8));
		pruned = withoutSpurs(std::move(pruned), 0.8, 1);
	}
	pruned.significance = nestedBranches(pruned, progress.cancelOnly()).significance;
	progress.report(1, "Pruning the skeleton");
	return pruned;
}

} // namespace vcg::tri::mcf

#endif
