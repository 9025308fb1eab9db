// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the rules for branches that stand for no limb, and for junctions that are one.

#ifndef VCG_MCF_SPUR_RULES_H
#define VCG_MCF_SPUR_RULES_H

#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/skeleton_branches.h>

#include <vcg/space/distance3.h>
#include <vcg/space/line3.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * Removes the spurs: terminal branches whose prominence() is below `minimum`, the lowest first,
 * since a branch that loses its junction becomes part of a longer one. What had merged into a spur
 * goes to its junction. A component that is a single chain keeps it.
 * @pre the radius of junctions and tips is their distance from the surface. @throws Cancelled
 */
inline CurveSkeleton withoutSpurs(
	const CurveSkeleton& skeleton, double minimum, const Progress& progress = Progress())
{
	return withoutTerminalBranches(skeleton, minimum, terminalProminence, progress);
}

/// Minimum length of a terminal branch, in radii of the ball at its root.
constexpr double minWayOfBranch = 0.75;
/// Minimum height of a blunt end that is a feature of the shape, in diagonals.
constexpr double minBluntHeight = 0.04;

/// The axis of a branch where it has left the ball of its junction: the line through its points one
/// and three radii of that ball along the branch, or its end if that comes first; none for a branch
/// shorter than one and a half.
/// @pre the radius of junctions is their distance from the surface.
inline std::optional<vcg::Line3d> axisOf(const CurveSkeleton& skeleton, const Branch& fromJunction)
{
	constexpr double start = 1, farEnd = 3, shortestAxis = 1.5; // radii
	const double radius = skeleton.radius[fromJunction.first()];
	double along = 0;
	Point3d origin = skeleton.position[fromJunction.first()], end = origin;
	for (size_t i = 1; i < fromJunction.nodes.size() && along < farEnd * radius; ++i) {
		const Point3d &a = skeleton.position[fromJunction.nodes[i - 1]],
					  &b = skeleton.position[fromJunction.nodes[i]];
		const double length = Distance(a, b);
		const auto at = [&](double way) { return a + (b - a) * ((way - along) / length); };
		if (along < start * radius && along + length >= start * radius)
			origin = at(start * radius);
		end = along + length > farEnd * radius ? at(farEnd * radius) : b;
		along += length;
	}
	if (!(radius > 0 && along >= shortestAxis * radius))
		return std::nullopt;
	return vcg::Line3d(origin, (end - origin).Normalize());
}

/**
 * Whether a terminal branch leads into the corner of a bend: its junction joins two limbs that turn
 * by more than 60 degrees, and whose axes meet closer to its tip than the mean radius of the balls
 * at its two ends. The curve cuts the corner, and the branch is what it leaves out, not a third
 * limb. A branch that sticks out by minBluntHeight is a limb.
 * @pre the radius of junctions and tips is their distance from the surface; the diagonal is 1.
 */
inline bool isCornerOfBend(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, const Branch& fromJunction)
{
	constexpr double widestBend = 120 * M_PI / 180;
	const int junction = fromJunction.first(), tip = fromJunction.last();
	if (neighbours[junction].size() != 3 || protrusion(skeleton, tip, junction) >= minBluntHeight)
		return false;
	std::vector<vcg::Line3d> axes;
	for (int w : neighbours[junction])
		if (w != fromJunction.nodes[1])
			if (const auto axis = axisOf(skeleton, branchAlong(neighbours, junction, w)))
				axes.push_back(*axis);
	if (axes.size() != 2 || axes[0].Direction() * axes[1].Direction() <= std::cos(widestBend))
		return false;
	bool parallel = false;
	double apart = 0;
	Point3d onOne, onOther; // where they are nearest to each other
	vcg::LineLineDistance(axes[0], axes[1], parallel, apart, onOne, onOther);
	const double near = (skeleton.radius[junction] + skeleton.radius[tip]) / 2;
	return !parallel && Distance((onOne + onOther) / 2, skeleton.position[tip]) < near;
}

/**
 * Removes terminal branches into the corners of bends, see isCornerOfBend(). A branch that overshoots
 * the corner is recognized only after its end has been trimmed by withoutBluntEnds().
 * @pre as isCornerOfBend(). @throws Cancelled
 */
inline CurveSkeleton withoutCornersOfBends(
	const CurveSkeleton& skeleton, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	return withoutTerminalBranches(
		skeleton, 0,
		[&](const CurveSkeleton& s, const Branch& fromJunction) {
			return isCornerOfBend(s, neighbours, fromJunction) ? -1.0 : 0.0;
		},
		progress);
}

/**
 * Removes the stubs, the shortest first: terminal branches whose tip is nearer to their junction
 * than minWayOfBranch radii of the ball there, or which lead into a corner that the curve cuts, as
 * at a heel, see isCornerOfBend(). A branch this short sticks out only if its own ball is about as
 * large: it is a blunt end, not a limb. It stays if it sticks out by minBluntHeight, as in one half
 * of a large round body.
 * @pre the radius of junctions and tips is their distance from the surface; the diagonal is 1.
 * @throws Cancelled
 */
inline CurveSkeleton withoutStubs(
	const CurveSkeleton& skeleton, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	return withoutTerminalBranches(
		skeleton, minWayOfBranch,
		[&](const CurveSkeleton& s, const Branch& fromJunction) {
			const int junction = fromJunction.first(), tip = fromJunction.last();
			if (protrusion(s, tip, junction) >= minBluntHeight)
				return minWayOfBranch;
			return isCornerOfBend(s, neighbours, fromJunction)
				? 0
				: Distance(s.position[tip], s.position[junction])
					/ std::max(s.radius[junction], 1e-300);
		},
		progress);
}

/**
 * Of two terminal branches that end in the same place, with tips closer to each other than twice
 * the radius of their smaller ball, keeps the shorter one. What had merged into the other goes to
 * its junction. The tips of different limbs, or of a limb that forks, are farther apart than that.
 * @pre the radius of tips is their distance from the surface. @throws Cancelled
 */
inline CurveSkeleton withoutTwinTips(
	const CurveSkeleton& skeleton, const Progress& progress = Progress())
{
	return withoutTerminalBranches(
		skeleton, 0,
		[](const CurveSkeleton& s, const Branch& fromJunction, const std::set<int>& tips) {
			const int tip = fromJunction.last();
			for (int other : tips)
				if (other != tip
					&& Distance(s.position[tip], s.position[other])
						< 2 * std::min(s.radius[tip], s.radius[other]))
					return -branchLength(s, fromJunction);
			return 0.0;
		},
		progress);
}

/**
 * Merges junctions that are one, the least apart first: those whose smaller ball sticks out of the
 * larger one by less than `minimum` of its own radius, so that a limb that forks right where it
 * leaves a body keeps its fork. By how much the connecting branch is longer than straight is added.
 * The junction with the larger ball stays in its place. Branches that close a cycle of the shape
 * are kept.
 * @pre the radius of junctions and tips is their distance from the surface. @throws Cancelled
 */
inline CurveSkeleton withWholeJunctions(
	CurveSkeleton skeleton, double minimum, const Progress& progress = Progress())
{
	return withMergedJunctions(
		std::move(skeleton), minimum,
		[](const CurveSkeleton& s, int larger, int smaller, double detour) {
			return (protrusion(s, smaller, larger) + detour) / std::max(s.radius[smaller], 1e-300);
		},
		progress);
}

} // namespace vcg::tri::mcf::refining

#endif
