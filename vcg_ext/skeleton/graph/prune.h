// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Pruning: removes terminal branches and merges close junctions. Cycles stay.

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
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The targets, see mergeNodes(), that merge all nodes of a branch into one of them.
inline std::vector<int> mergingTarget(size_t nodes, const Branch& branch, int into)
{
	std::vector<int> target(nodes);
	std::iota(target.begin(), target.end(), 0);
	for (int v : branch.nodes)
		target[v] = into;
	return target;
}

/// Whether the ends of a branch have a common neighbour that is not on the branch: if the ends were
/// merged, a cycle would become a double edge.
inline bool closesTriangle(const std::vector<std::vector<int>>& neighbours, const Branch& branch)
{
	const std::vector<int>& a = neighbours[branch.first()];
	const std::vector<int>& b = neighbours[branch.last()];
	return std::any_of(a.begin(), a.end(),
		[&](int v) { return v != branch.nodes[1] && std::binary_search(b.begin(), b.end(), v); });
}

} // namespace detail

namespace detail {

/// The terminal branches of a skeleton while they are removed one by one.
class TerminalBranches
{
public:
	explicit TerminalBranches(const CurveSkeleton& skeleton) :
			neighbours(skeleton.neighbours()), target(neighbours.size())
	{
		std::iota(target.begin(), target.end(), 0);
		for (int v = 0; v < int(neighbours.size()); ++v)
			if (neighbours[v].size() == 1)
				tips.insert(v);
	}

	const std::set<int>& allTips() const { return tips; }

	/// The branch from its junction to a tip; empty if the component is a chain.
	/// Complexity: linear in the branch.
	Branch upTo(int tip) const
	{
		Branch branch = branchAlong(neighbours, tip, neighbours[tip][0]);
		if (tips.count(branch.last()))
			return {};
		std::reverse(branch.nodes.begin(), branch.nodes.end());
		return branch;
	}

	/// Removes a branch. @return the tips whose branches become longer by that, at most two.
	std::vector<int> remove(const Branch& fromJunction)
	{
		const int junction = fromJunction.first();
		for (size_t i = 1; i < fromJunction.nodes.size(); ++i)
			target[fromJunction.nodes[i]] = junction;
		tips.erase(fromJunction.last());
		std::vector<int>& others = neighbours[junction];
		others.erase(std::find(others.begin(), others.end(), fromJunction.nodes[1]));
		std::vector<int> longer;
		if (others.size() == 2)
			for (int w : others)
				if (const int end = branchAlong(neighbours, junction, w).last(); tips.count(end))
					longer.push_back(end);
		return longer;
	}

	/// For each node the one that it has merged into, itself if it is left.
	std::vector<int> targets() const
	{
		std::vector<int> into = target;
		for (int& v : into)
			while (v != target[v])
				v = target[v];
		return into;
	}

private:
	std::vector<std::vector<int>> neighbours;
	std::vector<int> target;
	std::set<int> tips;
};

} // namespace detail

/**
 * Removes the terminal branches for which measure(skeleton, branch) is below `minimum`, the
 * smallest first and one at a time, since a branch that loses its junction becomes part of a longer
 * one. The measure gets the skeleton as it was given, and the branch from its junction to its tip.
 * What had merged into a removed branch goes to the junction. A measure that takes a third argument
 * gets the tips that are left, a std::set<int>; its value must not decrease when tips are removed.
 *
 * A component that is a single chain keeps it. Cycles stay: no edge of a terminal branch is on one.
 * @throws Cancelled. Complexity: O(V + E log E + surface vertices), and for each terminal branch,
 * and again when it has become longer, its measure, its length and the logarithm of their number.
 */
template <class Measure>
CurveSkeleton withoutTerminalBranches(const CurveSkeleton& skeleton, double minimum,
	const Measure& measure, const Progress& progress = Progress())
{
	using Tips = std::set<int>;
	constexpr bool dependsOnTips =
		std::is_invocable_v<Measure, const CurveSkeleton&, const Branch&, const Tips&>;
	detail::TerminalBranches branches(skeleton);
	// Measure, then two nodes that break ties in the order of skeletonBranches(), and the tip.
	using Entry = std::tuple<double, int, int, int>;
	std::set<Entry> below;
	std::map<int, Entry> ofTip;
	const auto measureAgain = [&](int tip) {
		progress.report(0, "Pruning the skeleton");
		if (const auto old = ofTip.find(tip); old != ofTip.end()) {
			below.erase(old->second);
			ofTip.erase(old);
		}
		const Branch branch = branches.upTo(tip);
		if (branch.nodes.empty())
			return;
		double value = 0;
		if constexpr (dependsOnTips)
			value = measure(skeleton, branch, branches.allTips());
		else
			value = measure(skeleton, branch);
		if (!(value < minimum))
			return;
		const bool fromTip = branch.last() < branch.first();
		const int next = fromTip ? branch.nodes[branch.nodes.size() - 2] : branch.nodes[1];
		const Entry entry(value, std::min(branch.first(), branch.last()), next, tip);
		below.insert(entry);
		ofTip.emplace(tip, entry);
	};
	for (int tip : branches.allTips())
		measureAgain(tip);
	while (!below.empty()) {
		const Entry worst = *below.begin();
		const int tip = std::get<3>(worst);
		if constexpr (dependsOnTips) {
			measureAgain(tip); // there may be fewer tips now
			if (below.empty() || *below.begin() != worst)
				continue;
		}
		below.erase(worst);
		ofTip.erase(tip);
		for (int longer : branches.remove(branches.upTo(tip)))
			measureAgain(longer);
	}
	return mergeNodes(skeleton, branches.targets());
}

/**
 * Merges junctions whose connecting branch has measure(skeleton, larger, smaller, detour) below
 * `minimum`, the smallest first: `larger` is the junction with the larger radius, which stays in
 * its place, and `detour` the length of the branch less the distance of the junctions. A branch
 * stays if a cycle would vanish with it.
 * @throws Cancelled. Complexity: O(merged junctions * (V + E log E + surface vertices)).
 */
template <class Measure>
CurveSkeleton withMergedJunctions(CurveSkeleton skeleton, double minimum, const Measure& measure,
	const Progress& progress = Progress())
{
	for (;;) {
		progress.report(0, "Merging junctions");
		const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
		const std::vector<Branch> branches = skeletonBranches(skeleton);
		std::map<std::pair<int, int>, int> parallel;
		for (const Branch& branch : branches)
			++parallel[std::minmax(branch.first(), branch.last())];
		double worst = minimum;
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

/// The prominence() of the tip of a terminal branch over its junction.
inline double terminalProminence(const CurveSkeleton& skeleton, const Branch& fromJunction)
{
	return prominence(skeleton, fromJunction.last(), fromJunction.first());
}

/// What prune() removes. Lengths in mesh units.
struct PruneParameters
{
	/// Terminal branches with less prominence() are spurs and go; in [0, 1], 0: none.
	double spurProminence = 0.1;
	/// Terminal branches shorter than this go; >= 0.
	double shortestBranch = 0;
	/// Terminal branches whose mean radius is less than this go; >= 0.
	double minRadius = 0;
	/// Branches of significance >= 1 - detail stay, see nestedBranches(); in [0, 1], 1: all.
	double detail = 1;
	/// Whether two junctions become one if their branch is shorter than the larger one's radius.
	bool mergeJunctions = true;

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		requireParameter(
			spurProminence >= 0 && spurProminence <= 1, "spur_prominence", "between 0 and 1");
		requireParameter(detail >= 0 && detail <= 1, "detail", "between 0 and 1");
		requireParameter(
			shortestBranch >= 0 && std::isfinite(shortestBranch), "min_length", "at least 0");
		requireParameter(minRadius >= 0 && std::isfinite(minRadius), "min_radius", "at least 0");
	}
};

/// Mean radius of a terminal branch over its length, without the edge at its junction; mesh units.
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
 * Prunes a skeleton: removes spurs by prominence(), then branches of too little significance, then
 * terminal branches that are too short, then those that are too thin; merges junctions, and removes
 * the spurs that are left. The number of cycles and of components never changes.
 *
 * @param skeleton  its radius should be the distance to the surface; the mean distance to the
 *                  surface vertices that merged into a node does as well.
 * @return the nodes of `skeleton` that are left, in their order and places, with their radii;
 *         `significance` is measured anew; removed branches go to the node that they hung on.
 * @throws InvalidParameter, Cancelled.
 * Complexity: as withoutTerminalBranches() and withMergedJunctions().
 * Source: ours.
 */
inline CurveSkeleton prune(const CurveSkeleton& skeleton, const PruneParameters& parameters,
	const Progress& progress = Progress())
{
	parameters.check();
	const auto withoutSpurs = [&](const CurveSkeleton& s, double from, double to) {
		return parameters.spurProminence > 0 ? withoutTerminalBranches(
				   s, parameters.spurProminence, terminalProminence, progress.part(from, to))
											 : s;
	};
	CurveSkeleton pruned = withoutSpurs(skeleton, 0, 0.2);
	const NestedBranches nested = nestedBranches(pruned, progress.cancelOnly());
	pruned = significantPart(std::move(pruned), nested, 1 - parameters.detail);
	pruned = withoutTerminalBranches(
		pruned, parameters.shortestBranch, branchLength, progress.part(0.2, 0.4));
	pruned = withoutTerminalBranches(
		pruned, parameters.minRadius, meanTerminalRadius, progress.part(0.4, 0.6));
	if (parameters.mergeJunctions) {
		pruned = withMergedJunctions(
			std::move(pruned), 1,
			[](const CurveSkeleton& s, int larger, int smaller, double detour) {
				const double length = Distance(s.position[larger], s.position[smaller]) + detour;
				return length / std::max(s.radius[larger], 1e-300);
			},
			progress.part(0.6, 0.8));
		pruned = withoutSpurs(pruned, 0.8, 1);
	}
	pruned.significance = nestedBranches(pruned, progress.cancelOnly()).significance;
	progress.report(1, "Pruning the skeleton");
	return pruned;
}

} // namespace vcg::tri::mcf

#endif
