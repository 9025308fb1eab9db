// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the features: branches for small limbs of a large body that the flow lost.

#ifndef VCG_MCF_REFINE_FEATURES_H
#define VCG_MCF_REFINE_FEATURES_H

#include "holding_balls.h"
#include "refine_centre.h"
#include "known_clearances.h"
#include "refine_peaks.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/spatial/closest_surface.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/// A given vertex and those that are connected with it by edges through vertices that are taken, in
/// breadth-first order. @throws Cancelled
template <class IsTaken>
std::vector<int> verticesAround(
	const SurfaceComponent& surface, int given, const Progress& progress, const IsTaken& isTaken)
{
	std::vector<int> around(1, given);
	std::vector<char> seen(surface.size(), 0);
	seen[given] = 1;
	detail::Ticker ticker(progress, "Refining the skeleton", surface.size());
	for (size_t i = 0; i < around.size(); ++i) {
		ticker.tick();
		surface.forEachNeighbour(around[i], [&](int w) {
			if (!seen[w] && isTaken(w)) {
				seen[w] = 1;
				around.push_back(w);
			}
		});
	}
	return around;
}

/**
 * The normal, up to its sign, of the plate that a part of the surface belongs to: the eigenvector of
 * the greatest eigenvalue of int n n^T dA; nothing if that is less than one and a half times the
 * next one, as in a limb or at the end of a thick plate.
 */
inline std::optional<Point3d> normalOfPlate(
	const SurfaceComponent& surface, const std::vector<int>& vertices)
{
	constexpr double flat = 1.5;
	Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
	for (int v : vertices) {
		const Point3d area = surface.doubleAreaVector(v);
		if (const double size = area.Norm(); size > 0) {
			const Eigen::Vector3d n(area[0], area[1], area[2]);
			sum += n * n.transpose() / size;
		}
	}
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
	if (!(solver.eigenvalues()[2] >= flat * solver.eigenvalues()[1]))
		return std::nullopt;
	const Eigen::Vector3d normal = solver.eigenvectors().col(2);
	return Point3d(normal[0], normal[1], normal[2]);
}

/// The middle of the surface around a peak down to the height `lowest`: a point in its feature's
/// tip.
/// @throws Cancelled
inline Point3d middleOfTip(const SurfaceComponent& surface, const Heights& heights, int peak,
	double lowest, const Progress& progress)
{
	Box3d box;
	for (int v :
		verticesAround(surface, peak, progress, [&](int w) { return heights.height[w] >= lowest; }))
		box.Add(surface.position(v));
	return box.Center();
}

/// The node of the first ball that is met on the surface around a peak, by distance along edges.
/// @throws Cancelled. Complexity: O(V + n log n) for V vertices and the n that are nearer.
inline int nodeBelow(const CurveSkeleton& skeleton, const SurfaceComponent& surface,
	const Heights& heights, int peak, const Progress& progress)
{
	constexpr double covered = 0.1;       // in radii
	using Entry = std::pair<double, int>; // way, vertex
	std::vector<char> reached(surface.size(), 0);
	std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
	front.emplace(0, peak);
	detail::Ticker ticker(progress, "Refining the skeleton", surface.size());
	while (!front.empty()) {
		ticker.tick();
		const auto [way, v] = front.top();
		front.pop();
		if (reached[v])
			continue;
		reached[v] = 1;
		if (heights.height[v] <= covered * skeleton.radius[heights.node[v]])
			return heights.node[v];
		const Point3d& p = surface.position(v);
		surface.forEachNeighbour(v, [&, way = way](int w) {
			if (!reached[w])
				front.emplace(way + Distance(p, surface.position(w)), w);
		});
	}
	return heights.node[peak];
}

/// Minimum height of a lobe of a plate, in radii.
constexpr double lobeHeight = 5;

/// Whether a branch stays within a plate: there is room on both sides of it along most of its way.
inline bool isInPlate(
	const CurveSkeleton& skeleton, const Branch& branch, const ClosestSurface& surface)
{
	constexpr double mostlyFlat = 0.65;
	int flat = 0;
	for (size_t i = 1; i < branch.nodes.size(); ++i) {
		const Point3d& x = skeleton.position[branch.nodes[i]];
		const ClosestSurface::Hit hit = surface.closest(x);
		if (hit.distance <= 0)
			continue;
		const ClosestSurface::Ball ball = medialBall(surface, x, hit);
		const Point3d direction = x - skeleton.position[branch.nodes[i - 1]];
		flat += isMedial(ball) && widePlaces(surface, x, hit, ball.contact, direction).size() == 2;
	}
	return flat >= mostlyFlat * double(branch.nodes.size() - 1);
}

/**
 * By how much a terminal branch that stays within a plate is shorter than the minimum height of so
 * many lobes: below 0; else 0. A plate that stands on a thicker body, as an ear does, is a limb.
 * @pre the radius of junctions and tips is their distance from the surface.
 */
inline double lackOfLobe(const CurveSkeleton& skeleton, const Branch& fromJunction, double lobes,
	const ClosestSurface& surface)
{
	constexpr double asThin = 0.5;
	const double radius = skeleton.radius[fromJunction.first()];
	const double excess = branchLength(skeleton, fromJunction) - lobes * lobeHeight * radius;
	if (excess >= 0 || skeleton.radius[fromJunction.last()] < asThin * radius)
		return 0;
	return isInPlate(skeleton, fromJunction, surface) ? excess : 0;
}

/**
 * Removes terminal branches that stay within a plate and are shorter than twice the minimum height
 * of a lobe, or than that height if there is no other tip; the shortest first. Where the flow
 * leaves such stubs is chance, and next to one growFeatures() would take the rim for several lobes.
 * A branch that is half of the curve is no stub, however thick its plate is.
 * @pre the radius of junctions and tips is their distance from the surface. @throws Cancelled
 */
inline CurveSkeleton withoutStubsInPlates(const CurveSkeleton& skeleton,
	const ClosestSurface& surface, const Progress& progress = Progress())
{
	const double half = statistics(skeleton).length / 2;
	return withoutTerminalBranches(
		skeleton, 0,
		[&](const CurveSkeleton& s, const Branch& fromJunction, const std::set<int>& tips) {
			return branchLength(s, fromJunction) < half
				? lackOfLobe(s, fromJunction, tips.size() > 1 ? 2 : 1, surface)
				: 0.0;
		},
		progress);
}

/// A branch to be added: points from the tip of a feature into one of the skeleton's balls.
struct FeatureBranch
{
	std::vector<Point3d> points;
	std::vector<double> radii;
	/// The node of that ball; -1 if the branch leaves the surface or ends in no ball.
	int joint = -1;
	/// The fractions of the points where the shape is wide to both sides, to one side, and to a
	/// side that the skeleton's balls leave out, see widePlaces().
	double flat = 0, rim = 0, bare = 0;

	double way() const
	{
		double sum = 0;
		for (size_t i = 1; i < points.size(); ++i)
			sum += Distance(points[i - 1], points[i]);
		return sum;
	}
};

/**
 * The branch from within a feature's tip to the skeleton: along the gradient of the distance from
 * the surface, which in a limb leads to its body, and where that vanishes towards a node; recentred
 * in each step.
 * @param towards  a node next to the feature.
 */
inline FeatureBranch traceBranch(const CurveSkeleton& skeleton, const HoldingBalls& balls,
	const ClosestSurface& surface, const Point3d& start, int towards, double spacing,
	const LocalScale& scale)
{
	constexpr int maxSteps = 400;
	// Weights of the directions to the node and of the last step; that of the gradient is 1.
	constexpr double pull = 0.3, keeping = 0.5;
	FeatureBranch branch;
	int flat = 0, rim = 0, bare = 0;
	Point3d x = start, direction(0, 0, 0);
	for (int i = 0; i < maxSteps; ++i) {
		ClosestSurface::Hit hit = surface.closest(x);
		if (hit.distance <= 0 || !surface.isInside(x, hit))
			return branch;
		const ClosestSurface::Ball ball = medialBall(surface, x, hit);
		Point3d slope(0, 0, 0);
		if (isMedial(ball)) {
			slope = medialSlope(hit.point, ball);
			const bool isFirst = i == 0;
			x = movedAside(x, ball, direction,
				isFirst ? std::numeric_limits<double>::infinity()
						: spacing / 2 * scale.atFace(hit.face));
			hit = surface.closest(x, hit.face);
			if (hit.distance <= 0 || !surface.isInside(x, hit))
				return branch;
			const std::vector<Point3d> wide = widePlaces(surface, x, hit, ball.contact, direction);
			flat += wide.size() == 2;
			rim += wide.size() == 1;
			bare += std::any_of(
				wide.begin(), wide.end(), [&](const Point3d& p) { return balls.deepest(p) < 0; });
		}
		if (i > 0
			&& !isSegmentInside(
				surface, branch.points.back(), branch.radii.back(), x, hit.distance))
			return branch;
		branch.points.push_back(x);
		branch.radii.push_back(hit.distance);
		branch.joint = balls.deepest(x);
		if (branch.joint >= 0) {
			branch.flat = double(flat) / double(branch.points.size());
			branch.rim = double(rim) / double(branch.points.size());
			branch.bare = double(bare) / double(branch.points.size());
			return branch;
		}
		const Point3d there = skeleton.position[towards] - x;
		direction = slope + there * (pull / std::max(there.Norm(), 1e-12)) + direction * keeping;
		direction /= std::max(direction.Norm(), 1e-12);
		x += direction * std::min(spacing * scale.atFace(hit.face), hit.distance / 2);
	}
	return branch;
}

/// Whether most of a branch runs through a plate or along its rim.
inline bool isMostlyInPlate(const FeatureBranch& branch)
{
	constexpr double most = 0.6;
	return branch.flat + branch.rim >= most;
}

/// Whether a branch and its peak are high and spiky enough for the lobe of a plate.
inline bool isHighAsLobe(const FeatureBranch& branch, const Peak& peak, const FeatureRule& rule)
{
	constexpr double lobeSpikiness = 0.25;
	return branch.joint >= 0
		&& peak.height >= std::max(lobeHeight * branch.radii.back(), rule.minLobe)
		&& peak.spikiness >= lobeSpikiness;
}

/**
 * Whether a branch leads into a limb: not into the corner of a box, on the way to which the balls
 * shrink nearly as fast as they advance; not along the rim of a plate, which ends in its corner;
 * and not through a plate, in which it could lead anywhere, unless the plate comes to a point and
 * is longer than thick, as an ear is, or is itself a lobe, high above the balls and a large part of the
 * shape.
 *
 * The branch into a low spike is short: where it enters the body, its few samples can look like a
 * rim or a plate. For spikes, such samples only count if they cover more than a radius; and where
 * the balls keep their size, as they do in no corner of a solid, only beside room that the
 * skeleton's balls leave out: what these cover is the spike's body.
 */
inline bool leadsIntoLimb(const FeatureBranch& branch, const Peak& peak, const FeatureRule& rule)
{
	constexpr double maxFlatnessIfSpiky = 1.7, evenGain = 0.8, maxFlatnessIfEven = 0.1,
					 maxRim = 0.5;
	constexpr double mostlyFlat = 0.5, minWayIfFlat = 2;
	if (branch.joint < 0)
		return false;
	const double way = branch.way(), radius = branch.radii.back();
	const double gain = way > 0 ? 1 + (branch.radii.front() - radius) / way : 0;
	const double wide = gain > evenGain ? branch.bare : std::max(branch.flat, branch.rim);
	const bool isSpike = peak.spikiness >= rule.minOfSpike && wide * way <= radius;
	const double minWay =
		isSpike ? rule.minWay : std::max(rule.minWay, rule.minProtrusion / peak.relativeHeight);
	if (way < minWay * radius || gain < rule.minGain)
		return false;
	return isHighAsLobe(branch, peak, rule) || isSpike
		|| (branch.rim <= maxRim && (branch.flat <= mostlyFlat || way >= minWayIfFlat * radius)
			&& branch.flat
				<= (gain > evenGain ? maxFlatnessIfEven : maxFlatnessIfSpiky * peak.spikiness));
}

/**
 * Whether the wall of a plate bulges at a peak, as around the tip of a lobe. It does not where it is
 * straight, as in the middle of a square's side, or hollow, as at the rim of a hole: both may be
 * high above branches into the corners, or above a curve around the hole. Seen along the plate's
 * normal, the ends of the wall around the peak, down to half its height or to the next peak and
 * within a distance of that height, then lie on both sides of it and nearly on a line with it, or farther
 * out; at a lobe they lie farther in. A peak in the middle of a face is at no wall.
 * @param joint  where the branch into the peak begins.
 * @return true where the surface is not like a plate. @throws Cancelled
 */
inline bool bulgesAt(const SurfaceComponent& component, const Heights& heights, const Peak& peak,
	const Point3d& joint, const Progress& progress)
{
	constexpr double minOtherSide = 0.25, straight = 165 * M_PI / 180;
	constexpr double alongFace = 0.85;  // cosine: the edges of a wall have 0.7
	constexpr double besideWall = 0.25; // heights
	const auto distance = [&](int v) {
		return Distance(component.position(v), component.position(peak.vertex));
	};
	const auto isNear = [&](int v) { return distance(v) <= peak.height; };
	const std::vector<int> around = verticesAround(component, peak.vertex, progress, isNear);
	const std::optional<Point3d> normal = normalOfPlate(component, around);
	if (!normal)
		return true;
	const auto isOnFace = [&](int v) {
		const Point3d own = component.doubleAreaVector(v);
		return std::abs(own * *normal) >= alongFace * own.Norm();
	};
	int top = -1; // the vertex of the wall nearest to the peak
	for (int v : around)
		if (!isOnFace(v) && (top < 0 || distance(v) < distance(top)))
			top = v;
	if (top < 0 || distance(top) > besideWall * peak.height)
		return false;
	const double lowest = std::max(peak.height / 2, peak.saddle);
	std::vector<Point3d> wall; // from the top
	for (int v : verticesAround(component, top, progress,
			 [&](int w) { return isNear(w) && heights.height[w] >= lowest && !isOnFace(w); })) {
		const Point3d way = component.position(v) - component.position(top);
		wall.push_back(way - *normal * (way * *normal));
	}
	const auto farthestFrom = [&](const Point3d& p) {
		return *std::max_element(wall.begin(), wall.end(), [&](const Point3d& a, const Point3d& b) {
			return SquaredDistance(a, p) < SquaredDistance(b, p);
		});
	};
	const Point3d one = farthestFrom(Point3d(0, 0, 0)), other = farthestFrom(one);
	const bool isStraight = other.Norm() >= minOtherSide * one.Norm()
		&& std::atan2((one ^ other).Norm(), one * other) >= straight;
	const bool isHollow = (one + other) * (component.position(top) - joint) > 0;
	return !isStraight && !isHollow;
}

/// A candidate feature, and whether it has got its branch.
struct Feature
{
	Peak peak;
	FeatureBranch branch;
	bool grown;
};

/**
 * Whether a branch that leads into no limb leads into a blunt corner that is a feature of the
 * shape, as a knee is: high, neither in a plate nor on its rim, and alone. The corners of box-like
 * solids are as blunt, but there are several of them around one ball.
 * @param features  all candidates.
 */
inline bool leadsIntoLoneCorner(const CurveSkeleton& skeleton, const SurfaceComponent& surface,
	const Feature& corner, const std::vector<Feature>& features, const FeatureRule& rule)
{
	constexpr double minGain = 0.4, maxFlatness = 0.35, minSpikiness = 0.3, likeHeight = 0.5;
	constexpr double minWay = 0.7;
	const FeatureBranch& branch = corner.branch;
	if (branch.joint < 0 || corner.peak.height < rule.minCorner
		|| corner.peak.spikiness < minSpikiness)
		return false;
	const double radius = branch.radii.back(), way = branch.way();
	// From the surface itself, where the radius is 0: independent of where the branch starts.
	const double whole =
		way + Distance(surface.position(corner.peak.vertex), branch.points.front());
	if (way < minWay * radius || whole * (1 - minGain) < radius
		|| std::max(branch.flat, branch.rim) * way > maxFlatness * whole)
		return false;
	return std::none_of(features.begin(), features.end(), [&](const Feature& other) {
		return other.peak.vertex != corner.peak.vertex && other.branch.joint >= 0
			&& other.peak.height >= likeHeight * corner.peak.height
			&& Distance(skeleton.position[other.branch.joint], skeleton.position[branch.joint])
			< std::max(radius, other.branch.radii.back());
	});
}

/// The nearest node in view from a point that is nearer than `farthest`; -1 if there is none.
/// Complexity: O(N), and O(log N + log V) for each node up to that one, by distance.
inline int nearestInView(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	const Point3d& point, double radius, double farthest)
{
	using Node = std::pair<double, int>; // distance, node
	std::vector<Node> nodes;
	for (size_t v = 0; v < skeleton.position.size(); ++v)
		if (const double distance = Distance(skeleton.position[v], point); distance < farthest)
			nodes.emplace_back(distance, int(v));
	std::priority_queue<Node, std::vector<Node>, std::greater<Node>> byDistance(
		std::greater<Node>(), std::move(nodes));
	for (; !byDistance.empty(); byDistance.pop())
		if (const size_t v = size_t(byDistance.top().second);
			isSegmentInside(surface, point, radius, skeleton.position[v], skeleton.radius[v]))
			return int(v);
	return -1;
}

/**
 * The branch from a peak's feature to the curve: towards the nearest ball or, where that lies
 * across a gap, towards the one below the peak; if a node in view is nearer than that branch is
 * long, towards it. The joint is -1 if it would run beside the curve even so, or if there is no
 * way.
 * @throws Cancelled
 */
inline FeatureBranch branchInto(const Peak& peak, const CurveSkeleton& skeleton,
	const HoldingBalls& balls, const SurfaceComponent& component, const Heights& heights,
	const ClosestSurface& surface, const FeatureRule& rule, const Progress& progress)
{
	// The level falls until the surface above it encloses a point with a way to the curve.
	const auto branchTowards = [&](int node) {
		FeatureBranch branch;
		for (double down = rule.minRise; branch.joint < 0 && down < peak.height; down *= 2)
			branch = traceBranch(skeleton, balls, surface,
				middleOfTip(component, heights, peak.vertex, peak.height - down, progress), node,
				rule.spacing, rule.scale);
		return branch;
	};
	const auto shortcut = [&](const FeatureBranch& branch) {
		return nearestInView(
			skeleton, surface, branch.points.front(), branch.radii.front(), branch.way());
	};
	const int nearest = heights.node[peak.vertex];
	FeatureBranch branch = branchTowards(nearest);
	if (branch.joint < 0)
		if (const int below = nodeBelow(skeleton, component, heights, peak.vertex, progress);
			below != nearest)
			branch = branchTowards(below);
	if (branch.joint < 0)
		return branch;
	if (const int seen = shortcut(branch); seen >= 0) {
		branch = branchTowards(seen);
		if (branch.joint >= 0 && shortcut(branch) >= 0)
			branch.joint = -1;
	}
	return branch;
}

/**
 * Gives each feature without a branch one: where the surface is far above the skeleton's balls and
 * comes to a point, and where the way there leads through a limb or into the lobe of a plate. Rims,
 * the walls of plates and the corners of solids, which curve skeletons leave out, are no features.
 * @pre radius holds the distances from the surface, or lower bounds. @post the same.
 * @throws Cancelled. Complexity: O(V * N + V log V), and O(V log V) for each peak.
 */
inline void growFeatures(CurveSkeleton& skeleton, const SurfaceComponent& component,
	const ClosestSurface& surface, KnownClearances& clearances, const FeatureRule& rule,
	const Progress& progress = Progress())
{
	if (skeleton.edges.empty())
		return;
	const std::vector<int> covering = coveringNodes(skeleton);
	for (int v : covering)
		skeleton.radius[v] = std::max(clearances.at(skeleton.position[v]), 0.0);
	const Heights heights = heightsAbove(
		skeleton, covering, component, surface.vertexOrder(progress), progress.part(0, 0.4));
	const auto add = [&](const FeatureBranch& branch) {
		int last = branch.joint;
		for (size_t i = branch.points.size(); i-- > 0;) {
			const int next = int(skeleton.position.size());
			skeleton.position.push_back(branch.points[i]);
			skeleton.radius.push_back(branch.radii[i]);
			skeleton.edges.push_back({last, next});
			last = next;
		}
	};
	const auto isLobeIfInPlate = [&](const Peak& peak, const FeatureBranch& branch) {
		return !isMostlyInPlate(branch)
			|| bulgesAt(component, heights, peak, branch.points.back(), progress.cancelOnly());
	};
	const int nodes = int(skeleton.position.size());
	HoldingBalls balls(skeleton);
	std::vector<Feature> features;
	for (const Peak& peak : peaks(skeleton, component, heights, rule, progress.part(0.4, 0.8))) {
		FeatureBranch branch = branchInto(
			peak, skeleton, balls, component, heights, surface, rule, progress.cancelOnly());
		const bool grown = leadsIntoLimb(branch, peak, rule) && isLobeIfInPlate(peak, branch);
		if (grown) {
			add(branch);
			balls.addNew();
		}
		features.push_back({peak, std::move(branch), grown});
	}
	// A corner whose branch would end in one that has just grown lies beside a limb.
	for (const Feature& feature : features)
		if (!feature.grown && feature.branch.joint < nodes
			&& leadsIntoLoneCorner(skeleton, component, feature, features, rule)
			&& isLobeIfInPlate(feature.peak, feature.branch))
			add(feature.branch);
	std::sort(skeleton.edges.begin(), skeleton.edges.end());
}

} // namespace vcg::tri::mcf::refining

#endif
