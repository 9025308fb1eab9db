// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the ends of blades: a limb that ends in an edge has one tip, in its middle.

#ifndef VCG_MCF_BLADE_ENDS_H
#define VCG_MCF_BLADE_ENDS_H

#include "refine_centre.h"
#include "ball_chain.h"
#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * Length of the longest medial edge at the end of a limb, in radii of the limb; with a longer one it
 * is a plate, whose corners may have tips. A bar whose section is s times as wide as thick has one of
 * 2 (s - 1) radii, so that bars up to s = 2.3 get one tip.
 */
constexpr double longestEnd = 2.6;

/// How far behind the tips areOnOneRidge() is evaluated, as a fraction of their distance: at a sharp
/// edge itself, balls are smaller than the triangles.
constexpr double behindTips = 0.25;

/// Whether the segment from p to q is near the medial axis, and the distance from the surface nearly
/// constant along it, as along the edge of a blade. Between two limbs the distance falls, and from one
/// side of a body to the other it rises; a segment close to the surface is far from the medial axis.
inline bool areOnOneRidge(
	const ClosestSurface& surface, const Point3d& p, const Point3d& q, KnownClearances& clearances)
{
	constexpr int pieces = 8;
	constexpr double lowest = 0.5, highest = 1.5; // of the distances at the ends
	constexpr double small = 0.2;  // of the segment's length, behind the edge of a 90 degree wedge
	constexpr double aside = 0.75; // radii
	const double one = clearances.at(p), other = clearances.at(q);
	const double low = lowest * std::min(one, other);
	const double high = std::min(highest * std::max(one, other),
		std::max(highest * std::min(one, other), small * Distance(p, q)));
	if (!(low > 0) || std::max(one, other) > high)
		return false;
	for (const int i : {4, 2, 6, 1, 3, 5, 7}) {
		const Point3d x = p + (q - p) * (double(i) / pieces);
		const ClosestSurface::Hit hit = surface.closest(x);
		if (hit.distance < low || hit.distance > high || !surface.isInside(x, hit))
			return false;
		const ClosestSurface::Ball ball = medialBall(surface, x, hit);
		if (!isMedial(ball) || Distance(ball.centre, x) > aside * hit.distance)
			return false;
	}
	return true;
}

/// The balls at the nodes near a node along the curve. Many pairs of tips ask about the same nodes, so
/// that their radii are kept by number: KnownClearances looks them up by position.
class BallsAlongCurve
{
public:
	BallsAlongCurve(const CurveSkeleton& skeleton, KnownClearances& clearances) :
			skeleton(skeleton), clearances(clearances), neighbours(skeleton.neighbours()),
			radius(skeleton.position.size(), -1), seenIn(skeleton.position.size(), 0)
	{
	}

	/// Whether the surface is at least `minimum` away from a node within `farthest` of `node`.
	/// @throws Cancelled. Complexity: linear in the nodes that are as near.
	bool isAnyLarge(int node, double farthest, double minimum)
	{
		++search;
		seenIn[size_t(node)] = search;
		reached.assign(1, {node, 0});
		for (size_t i = 0; i < reached.size(); ++i) {
			const auto [v, way] = reached[i];
			if (radiusOf(v) >= minimum)
				return true;
			const Point3d& p = skeleton.position[size_t(v)];
			for (int w : neighbours[size_t(v)]) {
				if (seenIn[size_t(w)] == search)
					continue;
				const double there = way + Distance(p, skeleton.position[size_t(w)]);
				if (there > farthest)
					continue;
				seenIn[size_t(w)] = search;
				reached.emplace_back(w, there);
			}
		}
		return false;
	}

private:
	double radiusOf(int v)
	{
		double& known = radius[size_t(v)];
		if (known < 0)
			known = std::max(clearances.at(skeleton.position[size_t(v)]), 0.0);
		return known;
	}

	const CurveSkeleton& skeleton;
	KnownClearances& clearances;
	const std::vector<std::vector<int>> neighbours;
	std::vector<double> radius; ///< of each node; -1: not yet measured
	std::vector<size_t> seenIn; ///< the last search that reached a node
	size_t search = 0;
	std::vector<std::pair<int, double>> reached; ///< node, way
};

/**
 * Of two terminal branches into the same edge, as into both corners of the edge of a wedge, removes
 * the longer one: their tips are on one ridge, see areOnOneRidge(), side by side as seen from the
 * junction, no farther apart than longestEnd radii of the limb, whose largest ball near the junction
 * tells how thick it is, and the shape ends ahead of them. Near an edge the balls are too small to
 * tell tips apart by them. A tip stays if its protrusion() is more than twice that of the other, which
 * is then a stub at the root of the limb.
 * @pre the radius of junctions and tips is their distance from the surface. @throws Cancelled
 * Complexity: O(T^2) for T tips, and some distances for each pair that is near.
 */
inline CurveSkeleton withoutForkedEnds(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	KnownClearances& clearances, const Progress& progress = Progress())
{
	constexpr double opposite = -0.7;          // cosine
	constexpr double asFar = 0.5;              // protrusions
	constexpr double ahead = 0.75, around = 2; // distances of the tips
	BallsAlongCurve balls(skeleton, clearances);
	const auto endTogether = [&](const Branch& fromJunction, int other) {
		const Point3d &p = skeleton.position[size_t(fromJunction.last())],
					  &q = skeleton.position[size_t(other)],
					  &joint = skeleton.position[size_t(fromJunction.first())];
		const double apart = Distance(p, q);
		const int tip = fromJunction.last(), junction = fromJunction.first();
		if (protrusion(skeleton, other, junction) < asFar * protrusion(skeleton, tip, junction))
			return false;
		if ((p - joint) * (q - joint) < opposite * Distance(p, joint) * Distance(q, joint))
			return false;
		const auto behind = [&](const Point3d& end) {
			const Point3d back = joint - end;
			return end + back * std::min(1.0, behindTips * apart / std::max(back.Norm(), 1e-300));
		};
		const Point3d middle = (p + q) / 2;
		const double way = Distance(middle, joint);
		return way > 0 && surface.clearance(middle + (middle - joint) * (ahead * apart / way)) <= 0
			&& areOnOneRidge(surface, behind(p), behind(q), clearances)
			&& balls.isAnyLarge(junction, around * apart, apart / longestEnd);
	};
	return withoutTerminalBranches(
		skeleton, 0,
		[&](const CurveSkeleton& s, const Branch& fromJunction, const std::set<int>& tips) {
			return std::any_of(tips.begin(), tips.end(),
					   [&](int other) {
						   return other != fromJunction.last() && endTogether(fromJunction, other);
					   })
				? -branchLength(s, fromJunction)
				: 0.0;
		},
		progress);
}

/// A section across a limb that is wider than thick.
struct Section
{
	Point3d middle, side; ///< the latter of unit length, the direction in which it is wide
	double radius, width; ///< distance of the middle from the surface
};

/**
 * The section of a limb at a point: it is as wide as the distance from the surface stays above half
 * of that at the point.
 * @param axis   of the limb, of unit length.
 * @param widest no section is wider; nothing if it would be, or if there were more than 64 radii in
 *               that: limbs are not so wide, and finding that out takes as many queries.
 */
inline std::optional<Section> sectionAt(
	const ClosestSurface& surface, Point3d x, const Point3d& axis, double widest)
{
	constexpr double minSide = 0.5, pace = 0.25; // radii
	constexpr double widestLimb = 64;            // radii
	constexpr int halvings = 3;
	ClosestSurface::Hit hit = surface.closest(x);
	ClosestSurface::Ball ball;
	const auto hasMedialBall = [&] {
		if (hit.distance <= 0 || !surface.isInside(x, hit))
			return false;
		ball = medialBall(surface, x, hit);
		return isMedial(ball);
	};
	if (!hasMedialBall())
		return std::nullopt;
	x = movedAside(x, ball, axis, hit.distance);
	hit = surface.closest(x, hit.face);
	if (!hasMedialBall())
		return std::nullopt;
	Point3d side = axis ^ (hit.point - ball.contact);
	if (!(side.Norm() > 0))
		return std::nullopt;
	side /= side.Norm();
	const double r = hit.distance;
	if (widest > widestLimb * r)
		return std::nullopt;
	const auto reach = [&](double sign) {
		const auto isWithin = [&](double s) {
			return surface.clearance(x + side * (sign * s)) >= minSide * r;
		};
		double s = 0, step = pace * r;
		while (s <= widest && isWithin(s + step))
			s += step;
		for (int i = 0; i < halvings; ++i)
			if (step /= 2; isWithin(s + step))
				s += step;
		return s;
	};
	const double right = reach(1), left = right <= widest ? reach(-1) : 0;
	if (left + right > widest)
		return std::nullopt;
	return Section {x + side * ((right - left) / 2), side, r, left + right};
}

/// A new end of a terminal branch: from one of its nodes straight to two points.
struct StraightEnd
{
	size_t root; ///< in the branch, from the tip
	Point3d middle, tip;
};

/**
 * The straight end of a branch that ends beside the middle of an edge. A section across the limb,
 * half as far from a root as the tip is, is as wide as the distance from the surface stays above
 * half of that in its middle. The end is moved into the middle of the section that is nearest to the
 * tip, wider than round ones, no wider than the root is far from the tip, and no wider than the ends
 * of limbs, see longestEnd; if the tip lies ahead of the root, beside the section's middle, and on
 * one ridge with its new place.
 * @param fromTip  the branch. @return nothing if it does not end beside the middle of an edge.
 */
inline std::optional<StraightEnd> straightEnd(const CurveSkeleton& skeleton, const Branch& fromTip,
	const ClosestSurface& surface, KnownClearances& clearances)
{
	constexpr double nearest = 2, farther = 1.25; // radii of the tip; factor
	constexpr double minStem = 0.25;              // of the root's distance
	constexpr double ahead = 0.85;                // cosine: corners are 27 degrees aside
	constexpr double round = 2, centred = 0.15;   // radii; of the width
	std::vector<Point3d> points;
	for (const int v : fromTip.nodes)
		points.push_back(skeleton.position[size_t(v)]);
	const Point3d& tip = points[0];
	const double radius = clearances.at(tip);
	if (!(radius > 0))
		return std::nullopt;
	const std::vector<double> along = lengthsAlong(points);
	const auto nodeAt = [&](double way) {
		return size_t(std::lower_bound(along.begin(), along.end() - 1, way) - along.begin());
	};
	const auto isInside = [&](const Point3d& a, const Point3d& b) {
		return isSegmentInside(surface, a, clearances.at(a), b, clearances.at(b));
	};
	double largest = radius; // of the first nodes
	size_t measured = 1;
	for (double far = nearest * radius; (1 + minStem) * far <= along.back(); far *= farther) {
		const size_t root = nodeAt(far), before = nodeAt(2 * far);
		for (; measured <= before; ++measured)
			largest = std::max(largest, clearances.at(points[measured]));
		const double widest = (longestEnd + 1) * largest;
		if (far > farther * widest) // all sections that are narrow enough have been tried
			break;
		Point3d axis = points[root] - points[before];
		if (!(axis.Norm() > 0))
			continue;
		axis /= axis.Norm();
		const Point3d onward = tip - points[root];
		if (onward * axis < ahead * onward.Norm())
			continue;
		const std::optional<Section> section =
			sectionAt(surface, points[root] + axis * (far / 2), axis, widest);
		if (!section || section->width < round * section->radius || section->width > far)
			continue;
		const Point3d halfway = section->middle;
		// The curve may lie askew in the limb; the middles of its sections do not.
		if (const std::optional<Section> first = sectionAt(surface, points[root], axis, widest)) {
			const Point3d between = halfway - first->middle;
			if (between * axis >= ahead * between.Norm())
				axis = between / between.Norm();
		}
		const Point3d moved = halfway + axis * (axis * (tip - halfway));
		const double off = Distance(tip, moved);
		if (off >= centred * section->width && off <= section->width / 2 + section->radius
			&& areOnOneRidge(surface, tip - axis * (behindTips * off),
				moved - axis * (behindTips * off), clearances)
			&& isInside(points[root], halfway) && isInside(halfway, moved))
			return StraightEnd {root, halfway, moved};
	}
	return std::nullopt;
}

/**
 * The skeleton with a new end of a terminal branch, in place of the nodes up to one of them.
 * @param fromTip  the branch. @param root  the index of that node in it. @param end  to the new tip.
 */
inline CurveSkeleton withNewEnd(const CurveSkeleton& skeleton, const Branch& fromTip, size_t root,
	const std::vector<Point3d>& end, KnownClearances& clearances)
{
	std::vector<int> target(skeleton.position.size());
	std::iota(target.begin(), target.end(), 0);
	const int node = fromTip.nodes[root];
	for (size_t i = 0; i < root; ++i)
		target[size_t(fromTip.nodes[i])] = node;
	int last = 0; // the node's number among those that are left
	for (int w = 0; w < node; ++w)
		last += target[size_t(w)] == w;
	CurveSkeleton changed = mergeNodes(skeleton, target);
	for (const Point3d& p : end) {
		const int next = int(changed.position.size());
		changed.position.push_back(p);
		changed.radius.push_back(clearances.at(p));
		changed.edges.push_back({last, next});
		last = next;
	}
	std::sort(changed.edges.begin(), changed.edges.end());
	return changed;
}

/**
 * The skeleton with the tips of limbs that end in an edge moved to the middle of that edge, see
 * straightEnd(). Within the medial axis of such a limb nothing holds the curve: the flow leaves its
 * end anywhere between the corners.
 * @throws Cancelled
 */
inline CurveSkeleton withStraightEnds(CurveSkeleton skeleton, const ClosestSurface& surface,
	KnownClearances& clearances, const Progress& progress = Progress())
{
	std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	std::vector<Point3d> tips;
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() == 1)
			tips.push_back(skeleton.position[v]);
	for (const Point3d& place : tips) {
		progress.check();
		const auto found = std::find(skeleton.position.begin(), skeleton.position.end(), place);
		const int v = int(found - skeleton.position.begin());
		const Branch branch = branchAlong(neighbours, v, neighbours[size_t(v)][0]);
		const std::optional<StraightEnd> end = straightEnd(skeleton, branch, surface, clearances);
		if (!end)
			continue;
		skeleton = withNewEnd(skeleton, branch, end->root, {end->middle, end->tip}, clearances);
		neighbours = skeleton.neighbours();
	}
	return skeleton;
}

/// withoutForkedEnds(), then withStraightEnds(): one tip for each edge, in its middle.
/// @pre the radius of junctions and tips is their distance from the surface. @throws Cancelled
inline CurveSkeleton withOneTipAtEdges(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	KnownClearances& clearances, const Progress& progress = Progress())
{
	return withStraightEnds(
		withoutForkedEnds(skeleton, surface, clearances, progress), surface, clearances, progress);
}

} // namespace vcg::tri::mcf::refining

#endif
