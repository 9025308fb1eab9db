// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the graph: spurs removed, split junctions merged, branches evenly sampled.

#ifndef VCG_MCF_REFINE_GRAPH_H
#define VCG_MCF_REFINE_GRAPH_H

#include "local_scale.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/segment.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>

#include <vcg/space/distance3.h>
#include <vcg/space/line3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/// Loops over nodes check for cancellation this often: a node may take several searches.
constexpr size_t nodesPerCheck = 256;

/// The distances of nodes from the surface, cached by position, since nodes are renumbered.
class KnownClearances
{
public:
	/// @param progress checked once for nodesPerCheck distances that were not known.
	explicit KnownClearances(const ClosestSurface& surface, const Progress& progress = Progress()) :
			surface(surface), progress(progress)
	{
	}

	/// @throws Cancelled
	double at(const Point3d& node)
	{
		if (const auto place = known.find(node); place != known.end())
			return place->second;
		if (known.size() % nodesPerCheck == 0)
			progress.check();
		return known[node] = surface.clearance(node, progress);
	}

private:
	const ClosestSurface& surface;
	const Progress progress;
	std::map<Point3d, double> known;
};

/// Sets the radius of each junction and tip to its distance from the surface; 0 outside.
inline void measureBranchEnds(CurveSkeleton& skeleton, KnownClearances& clearances)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() != 2)
			skeleton.radius[v] = std::max(clearances.at(skeleton.position[v]), 0.0);
}

/// Sets the radius of each node to its distance from the surface; 0 outside. @throws Cancelled
inline void measureNodes(CurveSkeleton& skeleton, KnownClearances& clearances)
{
	for (size_t v = 0; v < skeleton.position.size(); ++v)
		skeleton.radius[v] = std::max(clearances.at(skeleton.position[v]), 0.0);
}

/**
 * Whether the segment from a to b is inside the surface, given its ends' distances from it or lower
 * bounds of them: two balls that touch each other cover the segment between their centres; else it
 * is halved.
 */
inline bool isSegmentInside(const ClosestSurface& surface, const Point3d& a, double radiusA,
	const Point3d& b, double radiusB, int depth = 0)
{
	constexpr int deepest = 6;
	if (radiusA <= 0 || radiusB <= 0)
		return false;
	if (Distance(a, b) <= radiusA + radiusB)
		return true;
	if (depth == deepest)
		return false;
	const Point3d middle = (a + b) / 2;
	const double radius = surface.clearance(middle);
	return isSegmentInside(surface, a, radiusA, middle, radius, depth + 1)
		&& isSegmentInside(surface, middle, radius, b, radiusB, depth + 1);
}

/// The same for an edge of a skeleton whose radii may be lower bounds: measures them if needed.
inline bool isEdgeInside(CurveSkeleton& skeleton, const ClosestSurface& surface, int a, int b)
{
	const auto inside = [&] {
		return isSegmentInside(surface, skeleton.position[a], skeleton.radius[a],
			skeleton.position[b], skeleton.radius[b]);
	};
	if (inside())
		return true;
	for (int v : {a, b})
		skeleton.radius[v] = std::max(surface.clearance(skeleton.position[v]), 0.0);
	return inside();
}

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
 * by more than 60 degrees, and whose axes meet within the ball of its tip. The curve cuts the
 * corner, and the branch is what it leaves out, not a third limb.
 * @pre the radius of junctions and tips is their distance from the surface.
 */
inline bool isCornerOfBend(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, const Branch& fromJunction)
{
	constexpr double widestBend = 120 * M_PI / 180;
	const int junction = fromJunction.first(), tip = fromJunction.last();
	if (neighbours[junction].size() != 3)
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
	return !parallel
		&& Distance((onOne + onOther) / 2, skeleton.position[tip]) < skeleton.radius[tip];
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

/// Length of a polyline up to each of its points.
inline std::vector<double> lengthsAlong(const std::vector<Point3d>& line)
{
	std::vector<double> along(line.size(), 0);
	for (size_t i = 1; i < line.size(); ++i)
		along[i] = along[i - 1] + Distance(line[i - 1], line[i]);
	return along;
}

/// Points with their distances from the surface, or lower bounds of them.
struct BallChain
{
	std::vector<Point3d> points;
	std::vector<double> radii;
};

/// Points of a polyline at equal steps of its length, both ends included.
inline BallChain evenPoints(const BallChain& line, int segments)
{
	const std::vector<double> along = lengthsAlong(line.points);
	BallChain even = {{line.points.front()}, {line.radii.front()}};
	size_t i = 1;
	for (int k = 1; k < segments; ++k) {
		const double s = along.back() * k / segments;
		while (i + 1 < along.size() && along[i] < s)
			++i;
		const double length = along[i] - along[i - 1];
		const double t = length > 0 ? (s - along[i - 1]) / length : 0;
		even.points.push_back(line.points[i - 1] + (line.points[i] - line.points[i - 1]) * t);
		// The distance from the surface cannot change faster than the place.
		even.radii.push_back(
			std::max(line.radii[i - 1] - t * length, line.radii[i] - (1 - t) * length));
	}
	even.points.push_back(line.points.back());
	even.radii.push_back(line.radii.back());
	return even;
}

/// The spacing of nodes at each point of a polyline: `spacing` times the scale there, but growing
/// by at most 0.3 of the length along the polyline. @throws Cancelled
inline std::vector<double> spacingsAlong(const BallChain& line, const ClosestSurface& surface,
	double spacing, const LocalScale& scale, const Progress& progress)
{
	std::vector<double> spacings(line.points.size(), spacing);
	if (scale.isUniform())
		return spacings;
	for (size_t i = 0; i < spacings.size(); ++i) {
		if (i % nodesPerCheck == 0)
			progress.check();
		spacings[i] *= scale.at(line.points[i], surface);
	}
	const auto boundBy = [&](size_t i, size_t near) {
		spacings[i] = std::min(spacings[i],
			spacings[near] + sizingSlope * Distance(line.points[i], line.points[near]));
	};
	for (size_t i = 1; i < spacings.size(); ++i)
		boundBy(i, i - 1);
	for (size_t i = spacings.size() - 1; i > 0; --i)
		boundBy(i - 1, i);
	return spacings;
}

/**
 * Points of a polyline, both ends included, at the spacings that are given at its points: at equal
 * steps of the integral of 1 / spacing.
 * @param minimum fewest segments, >= 1.
 */
inline BallChain gradedPoints(
	const BallChain& line, const std::vector<double>& spacings, int minimum)
{
	std::vector<double> along(line.points.size(), 0), steps(line.points.size(), 0);
	for (size_t i = 1; i < along.size(); ++i) {
		const double length = Distance(line.points[i - 1], line.points[i]);
		along[i] = along[i - 1] + length;
		steps[i] = steps[i - 1] + length * 2 / (spacings[i - 1] + spacings[i]);
	}
	const int segments = std::max(minimum, int(std::lround(steps.back())));
	BallChain graded = {{line.points.front()}, {line.radii.front()}};
	size_t i = 1;
	for (int k = 1; k < segments; ++k) {
		const double s = steps.back() * k / segments;
		while (i + 1 < steps.size() && steps[i] < s)
			++i;
		const double whole = steps[i] - steps[i - 1];
		const double t = whole > 0 ? (s - steps[i - 1]) / whole : 0;
		const double length = along[i] - along[i - 1];
		graded.points.push_back(line.points[i - 1] + (line.points[i] - line.points[i - 1]) * t);
		// The distance from the surface cannot change faster than the place.
		graded.radii.push_back(
			std::max(line.radii[i - 1] - t * length, line.radii[i] - (1 - t) * length));
	}
	graded.points.push_back(line.points.back());
	graded.radii.push_back(line.radii.back());
	return graded;
}

/// A polyline with its nodes kept and its edges cut into pieces of about the given spacings.
inline BallChain withShortEdges(const BallChain& line, const std::vector<double>& spacings)
{
	BallChain finer = {{line.points.front()}, {line.radii.front()}};
	for (size_t i = 1; i < line.points.size(); ++i) {
		const BallChain edge = {
			{line.points[i - 1], line.points[i]}, {line.radii[i - 1], line.radii[i]}};
		const double length = Distance(line.points[i - 1], line.points[i]);
		const double spacing = (spacings[i - 1] + spacings[i]) / 2;
		const BallChain pieces = evenPoints(edge, std::max(1, int(std::lround(length / spacing))));
		finer.points.insert(finer.points.end(), pieces.points.begin() + 1, pieces.points.end());
		finer.radii.insert(finer.radii.end(), pieces.radii.begin() + 1, pieces.radii.end());
	}
	return finer;
}

/// Measures the distances from the surface whose lower bound is 0. @throws Cancelled
inline void measureUnknown(BallChain& line, const ClosestSurface& surface, const Progress& progress)
{
	for (size_t i = 0; i < line.points.size(); ++i) {
		if (i % nodesPerCheck == 0)
			progress.check();
		if (line.radii[i] <= 0)
			line.radii[i] = std::max(surface.clearance(line.points[i]), 0.0);
	}
}

/// The search for points of a polyline in a ball, see PointTree::search().
template <class Found>
struct PointsInBall
{
	const std::vector<int>& order;
	Point3d middle;
	double radius;
	const Found& found; ///< found(point)

	const Point3d& centre() const { return middle; }
	double reach() const { return radius; }
	void visit(int slot, const Point3d& p)
	{
		if (Distance(p, middle) <= radius)
			found(order[size_t(slot)]);
	}
};

/**
 * A polyline without its loops, such as the contraction leaves in a needle. A loop ends at a point
 * that lies within the ball of its first point, or closer to that than the next point does. It is
 * removed if the segment that replaces it is inside the surface and at most half as long, and if all
 * its points are within 1.25 spacings of the rest, so that no end of the shape is lost.
 * @pre the shape has no handles: then all paths inside it between two points are homotopic.
 * @param spacings at its points; on return at the remaining ones.
 * @param keptOf   gets, for each of its points, the last remaining one up to it.
 * Complexity: O(n log n + n m) for n points of which m are in each ball, and O(n) for each loop that
 * is tried. @throws Cancelled
 */
inline BallChain withoutLoops(const BallChain& line, std::vector<double>& spacings,
	std::vector<int>& keptOf, const ClosestSurface& surface, const Progress& progress)
{
	constexpr double longer = 2, nearRest = 1.25; // the latter in spacings
	constexpr size_t mostTried = 8;
	const std::vector<double> along = lengthsAlong(line.points);
	const PointTree tree(line.points);
	const auto forEachNear = [&](size_t i, double reach, const auto& found) {
		PointsInBall<std::decay_t<decltype(found)>> ball {
			tree.order(), line.points[i], reach, found};
		tree.search(ball);
	};
	// Later points at which a loop from point i may end, the last one first.
	const auto returns = [&](size_t i) {
		const double reach = std::max(line.radii[i], along[i + 1] - along[i]);
		std::vector<int> found;
		forEachNear(i, reach, [&](int j) {
			if (size_t(j) > i + 1 && along[size_t(j)] >= along[i] + longer * reach)
				found.push_back(j);
		});
		const size_t tried = std::min(found.size(), mostTried);
		std::partial_sort(
			found.begin(), found.begin() + std::ptrdiff_t(tried), found.end(), std::greater<int>());
		found.resize(tried);
		return found;
	};
	// The first and the last of the points near a point, found when they are first asked for.
	std::vector<std::array<int, 2>> nearOf(line.points.size(), {-1, -1});
	const auto firstAndLastNear = [&](size_t k) {
		std::array<int, 2>& near = nearOf[k];
		if (near[0] < 0) {
			near = {int(k), int(k)};
			forEachNear(k, nearRest * spacings[k], [&](int other) {
				near = {std::min(near[0], other), std::max(near[1], other)};
			});
		}
		return near;
	};
	// Whether all points between i and j are near those up to i or from j on.
	const auto isNearRest = [&](size_t i, size_t j) {
		for (size_t k = i + 1; k < j; ++k) {
			if (k % nodesPerCheck == 0)
				progress.check();
			const auto [first, last] = firstAndLastNear(k);
			if (size_t(first) > i && size_t(last) < j)
				return false;
		}
		return true;
	};
	BallChain kept;
	std::vector<double> ofKept;
	for (size_t i = 0; i < line.points.size();) {
		if (kept.points.size() % nodesPerCheck == 0)
			progress.check();
		kept.points.push_back(line.points[i]);
		kept.radii.push_back(line.radii[i]);
		ofKept.push_back(spacings[i]);
		size_t next = i + 1;
		if (next < line.points.size())
			for (int j : returns(i))
				if (isSegmentInside(surface, line.points[i], line.radii[i], line.points[size_t(j)],
						line.radii[size_t(j)])
					&& isNearRest(i, size_t(j))) {
					next = size_t(j);
					break;
				}
		for (; i < next; ++i)
			keptOf[i] = int(kept.points.size()) - 1;
	}
	spacings = std::move(ofKept);
	return kept;
}

/**
 * A polyline without crowded nodes: one goes if the straight segment from the node kept
 * before it to the one after it is inside and shorter than 1.25 spacings.
 * @param spacings at its points; on return at those that are left.
 * @throws Cancelled
 */
inline BallChain withoutCrowdedNodes(const BallChain& line, std::vector<double>& spacings,
	const ClosestSurface& surface, const Progress& progress)
{
	constexpr double longest = 1.25; // spacings
	BallChain kept = {{line.points.front()}, {line.radii.front()}};
	std::vector<double> ofKept(1, spacings.front());
	for (size_t i = 1; i < line.points.size(); ++i) {
		if (i % nodesPerCheck == 0)
			progress.check();
		const bool isLast = i + 1 == line.points.size();
		if (!isLast && Distance(kept.points.back(), line.points[i + 1]) < longest * spacings[i]
			&& isSegmentInside(surface, kept.points.back(), kept.radii.back(), line.points[i + 1],
				line.radii[i + 1]))
			continue;
		kept.points.push_back(line.points[i]);
		kept.radii.push_back(line.radii[i]);
		ofKept.push_back(spacings[i]);
	}
	spacings = std::move(ofKept);
	return kept;
}

/// Whether a chain is inside; measures the radii where the bounds are not enough to tell.
/// @throws Cancelled
inline bool isInside(BallChain& chain, const ClosestSurface& surface, const Progress& progress)
{
	const auto segmentInside = [&](size_t i) {
		return isSegmentInside(
			surface, chain.points[i - 1], chain.radii[i - 1], chain.points[i], chain.radii[i]);
	};
	for (size_t i = 1; i < chain.points.size(); ++i) {
		if (i % nodesPerCheck == 0)
			progress.check();
		if (segmentInside(i))
			continue;
		for (size_t k : {i - 1, i})
			chain.radii[k] = std::max(surface.clearance(chain.points[k]), 0.0);
		if (!segmentInside(i))
			return false;
	}
	return true;
}

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

/**
 * Samples each branch evenly, about `spacing` apart, less where the scale is smaller. Junctions and
 * tips keep their places; what had merged into a node goes to the one nearest along the branch.
 * Where a chord would leave the surface, the branch keeps its nodes, but for loops, see
 * withoutLoops(), and crowded ones, and only its long edges are cut.
 * @pre radius holds the distances from the surface, or lower bounds. @post lower bounds.
 * @throws Cancelled
 */
inline CurveSkeleton evenlySampled(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	double spacing, const LocalScale& scale = sameEverywhere, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	std::optional<bool> hasCycles; // counted when first needed
	CurveSkeleton even;
	std::vector<int> place(skeleton.position.size(), -1);
	const auto keep = [&](int v) {
		if (place[v] < 0) {
			place[v] = int(even.position.size());
			even.position.push_back(skeleton.position[v]);
			even.radius.push_back(skeleton.radius[v]);
		}
	};
	for (size_t v = 0; v < place.size(); ++v)
		if (neighbours[v].size() != 2)
			keep(int(v));
	const FewestEdges fewest(branches);
	for (const Branch& branch : branches) {
		progress.check();
		keep(branch.first()); // of a free cycle
		const int minimum = fewest.of(branch);
		BallChain line;
		for (int v : branch.nodes) {
			line.points.push_back(skeleton.position[v]);
			line.radii.push_back(skeleton.radius[v]);
		}
		const double length = branchLength(skeleton, branch);
		std::vector<double> spacings = spacingsAlong(line, surface, spacing, scale, progress);
		BallChain chain = scale.isUniform()
			? evenPoints(line, std::max(minimum, int(std::lround(length / spacing))))
			: gradedPoints(line, spacings, minimum);
		std::vector<double> from = lengthsAlong(line.points);
		if (!isInside(chain, surface, progress)) {
			measureUnknown(line, surface, progress);
			std::vector<int> keptOf(line.points.size());
			std::iota(keptOf.begin(), keptOf.end(), 0);
			if (!hasCycles)
				hasCycles = statistics(skeleton).cycles > 0;
			const BallChain straight =
				*hasCycles ? line : withoutLoops(line, spacings, keptOf, surface, progress);
			const BallChain thinned = withoutCrowdedNodes(straight, spacings, surface, progress);
			BallChain kept = withShortEdges(thinned, spacings);
			if (int(kept.points.size()) > minimum) {
				chain = std::move(kept);
				const std::vector<double> along = lengthsAlong(straight.points);
				for (size_t i = 0; i < from.size(); ++i)
					from[i] = along[size_t(keptOf[i])];
			}
		}
		const int segments = int(chain.points.size()) - 1;
		std::vector<int> ids(1, place[branch.first()]);
		for (int k = 1; k < segments; ++k) {
			ids.push_back(int(even.position.size()));
			even.position.push_back(chain.points[k]);
			even.radius.push_back(std::max(chain.radii[k], 0.0));
		}
		ids.push_back(place[branch.last()]);
		for (int k = 0; k < segments; ++k)
			even.edges.push_back({std::min(ids[k], ids[k + 1]), std::max(ids[k], ids[k + 1])});
		const std::vector<double> to = lengthsAlong(chain.points);
		int k = 0;
		for (size_t i = 1; i + 1 < branch.nodes.size(); ++i) {
			const double s = from[i] / from.back() * to.back();
			while (k < segments && to[k + 1] - s < s - to[k])
				++k;
			place[branch.nodes[i]] = ids[k];
		}
	}
	std::sort(even.edges.begin(), even.edges.end());
	even.node.reserve(skeleton.node.size());
	for (int v : skeleton.node)
		even.node.push_back(v < 0 ? -1 : place[v]);
	return even;
}

} // namespace vcg::tri::mcf::refining

#endif
