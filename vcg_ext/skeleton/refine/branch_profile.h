// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the ends of branches: how far the balls along them reach, and where they stop gaining.

#ifndef VCG_MCF_BRANCH_PROFILE_H
#define VCG_MCF_BRANCH_PROFILE_H

#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/skeleton_branches.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/// The profile of a terminal branch: for each node the length along the branch from the first one,
/// and the distance from the surface.
struct BranchProfile
{
	std::vector<double> along, radius;

	BranchProfile(const CurveSkeleton& skeleton, KnownClearances& clearances, const Branch& branch)
	{
		for (size_t i = 0; i < branch.nodes.size(); ++i) {
			const Point3d& p = skeleton.position[branch.nodes[i]];
			along.push_back(
				i == 0 ? 0 : along.back() + Distance(p, skeleton.position[branch.nodes[i - 1]]));
			radius.push_back(std::max(clearances.at(p), 0.0));
		}
	}

	size_t last() const { return along.size() - 1; }

	/// The gain of reach per length from one node to another: 1 + (r_to - r_from) / length.
	double gain(size_t from, size_t to) const
	{
		const double length = along[to] - along[from];
		return length > 0 ? 1 + (radius[to] - radius[from]) / length : 0;
	}

	/// The first node at least one radius of `from` further on, or past the last node.
	size_t oneRadiusOn(size_t from) const
	{
		return size_t(
			std::lower_bound(along.begin() + from, along.end(), along[from] + radius[from])
			- along.begin());
	}

	/// The start of the last stretch, as long as the radius at its start, that gains at least
	/// `minimum`; the last node if there is none.
	size_t lastStretch(double minimum) const
	{
		size_t start = last();
		for (size_t from = 0; from < last(); ++from)
			if (const size_t to = oneRadiusOn(from); to <= last() && gain(from, to) >= minimum)
				start = from;
		return start;
	}

	/// Where a walk from `from` ends that goes on as long as its stretches gain at least `minimum`.
	size_t endOfGain(size_t from, double minimum) const
	{
		size_t end = from;
		for (size_t i = from; i <= last(); ++i)
			if (along[i] > along[end] && gain(end, i) >= minimum)
				end = i;
		return end;
	}
};

/**
 * How clearly a terminal branch leaves what it hangs from: the maximum gain of reach over any
 * stretch as long as the radius at its start, as a part of that radius. It is 1 along a limb,
 * however short, and 1 - sin(a) on the way into a corner or a pointed end with a half angle of a,
 * whatever its size. A stretch that the tip cuts short has gained less; a branch without any
 * full stretch is measured as a whole.
 * @param branch from its junction to its tip.
 */
inline double distinctness(
	const CurveSkeleton& skeleton, KnownClearances& clearances, const Branch& branch)
{
	const BranchProfile profile(skeleton, clearances, branch);
	const size_t last = profile.last();
	double maximum = -1, upToTip = -1;
	for (size_t from = 0; from < last; ++from)
		if (const size_t to = profile.oneRadiusOn(from); to <= last)
			maximum = std::max(maximum, profile.gain(from, to));
		else {
			const double length = profile.along[last] - profile.along[from];
			upToTip = std::max(upToTip, profile.gain(from, last) * length / profile.radius[from]);
		}
	return maximum < 0 ? profile.gain(0, last) : std::max(maximum, upToTip);
}

/**
 * Removes the terminal branches whose distinctness() is below `minimum`, in the order of
 * withoutSpurs(): they lead into corners and edges of the surface, which a skeleton leaves out.
 * @throws Cancelled
 */
inline CurveSkeleton withoutCornerBranches(const CurveSkeleton& skeleton,
	KnownClearances& clearances, double minimum, const Progress& progress = Progress())
{
	return withoutTerminalBranches(
		skeleton, minimum,
		[&](const CurveSkeleton& s, const Branch& branch) {
			return distinctness(s, clearances, branch);
		},
		progress);
}

/**
 * Cuts terminal branches off behind one of their nodes, to which what had merged behind it goes.
 * @param end  (profile from the far end to the tip): the index of that node in the profile.
 */
template <class End>
CurveSkeleton withEndsCut(
	const CurveSkeleton& skeleton, KnownClearances& clearances, const End& end)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	std::vector<int> target(skeleton.position.size());
	std::iota(target.begin(), target.end(), 0);
	for (Branch branch : skeletonBranches(skeleton)) {
		for (int side = 0; side < 2; ++side) {
			std::reverse(branch.nodes.begin(), branch.nodes.end());
			if (neighbours[branch.last()].size() != 1)
				continue;
			const BranchProfile profile(skeleton, clearances, branch);
			const size_t last = end(profile);
			for (size_t i = last + 1; i <= profile.last(); ++i)
				target[branch.nodes[i]] = branch.nodes[last];
		}
	}
	return mergeNodes(skeleton, target);
}

/**
 * Cuts off the ends that lead from a limb into a corner: behind the last stretch of the branch that
 * gains `minimum`, see distinctness(), the branch ends where going on gains less, unless what would
 * be cut off is shorter than half a radius.
 */
inline CurveSkeleton withoutCornerEnds(
	const CurveSkeleton& skeleton, KnownClearances& clearances, double minimum)
{
	constexpr double shortest = 0.5;
	return withEndsCut(skeleton, clearances, [&](const BranchProfile& profile) {
		const size_t end = profile.endOfGain(profile.lastStretch(minimum), minimum);
		const double rest = profile.along.back() - profile.along[end];
		return rest < shortest * profile.radius[end] ? profile.last() : end;
	});
}

/**
 * Takes tips back to where the balls last gained `minimum`: a curve that went past the centre of a
 * round or flat end, where the balls shrink as fast as it advances, ends there.
 */
inline CurveSkeleton withoutBluntEnds(
	const CurveSkeleton& skeleton, KnownClearances& clearances, double minimum)
{
	return withEndsCut(skeleton, clearances, [&](const BranchProfile& profile) {
		return profile.endOfGain(profile.lastStretch(minimum), minimum);
	});
}

} // namespace vcg::tri::mcf::refining

#endif
