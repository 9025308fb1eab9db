// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the symmetry: a symmetric shape has no branch without its images.

#ifndef VCG_MCF_REFINE_SYMMETRY_H
#define VCG_MCF_REFINE_SYMMETRY_H

#include "blade_ends.h"
#include "holding_balls.h"
#include "refine_features.h"
#include "ball_chain.h"
#include "known_clearances.h"
#include "refine_peaks.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/spatial/symmetries.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

using tri::mcf::detail::mapped;

/// The tips of a skeleton, ascending.
inline std::vector<int> tipsOf(const std::vector<std::vector<int>>& neighbours)
{
	std::vector<int> tips;
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() == 1)
			tips.push_back(int(v));
	return tips;
}

/**
 * Whether the surface is symmetric as far as a curve can tell: on each branch nine tenths of the
 * nodes have images that are about as far from the surface as they are.
 * @throws Cancelled. Complexity: a closest point for each node.
 */
inline bool isSymmetricAlong(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	KnownClearances& clearances, const Eigen::Isometry3d& map, const Progress& progress)
{
	constexpr double ofRadius = 0.15, rounding = 2e-3, atMost = 0.5, most = 0.9;
	for (const Branch& branch : skeletonBranches(skeleton)) {
		size_t alike = 0;
		for (size_t i = 0; i < branch.nodes.size(); ++i) {
			if (i % nodesPerCheck == 0)
				progress.check();
			const Point3d& x = skeleton.position[branch.nodes[i]];
			const double radius = clearances.at(x);
			const double there = surface.clearance(mapped(map, x), progress);
			alike += std::abs(there - radius)
				<= std::max(ofRadius * radius, std::min(rounding, atMost * radius));
		}
		if (double(alike) < most * double(branch.nodes.size()))
			return false;
	}
	return true;
}

/// The nodes of a tip's terminal branch, from the tip; of a chain from tip to tip the first half.
inline std::vector<int> limbOf(
	const CurveSkeleton& skeleton, const std::vector<std::vector<int>>& neighbours, int tip)
{
	Branch branch = branchAlong(neighbours, tip, neighbours[size_t(tip)][0]);
	if (neighbours[size_t(branch.last())].size() > 1)
		return branch.nodes;
	const double half = branchLength(skeleton, branch) / 2;
	double along = 0;
	size_t count = 1;
	for (; count < branch.nodes.size() && along < half; ++count)
		along += Distance(skeleton.position[size_t(branch.nodes[count - 1])],
			skeleton.position[size_t(branch.nodes[count])]);
	branch.nodes.resize(count);
	return branch.nodes;
}

/// The images of a tip under the maps of a symmetric shape.
struct TipOrbit
{
	struct Image
	{
		const Eigen::Isometry3d* map; ///< of the tip to the image
		Point3d place;
		int tip; ///< at that place; -1: none
	};

	int tip;
	double near;               ///< distance within which a tip is at an image
	std::vector<Image> others; ///< different places only
	/// Whether a map that moves some of the images leaves the tip in its place, as the reflection in
	/// a plane through a corner does. On a round rim the place of other tips is arbitrary.
	bool isHeld = false;
	double reach = 0; ///< its distance from the middle of all images
	/// The place that the maps which leave the tip in its limb leave as it is: the mean of the tip's
	/// images under them.
	Point3d middle = Point3d(0, 0, 0);
	bool isBeside = false; ///< whether the tip is clearly beside that, on the rim of a plate

	size_t size() const { return others.size() + 1; }
	size_t present() const
	{
		return 1 + size_t(std::count_if(others.begin(), others.end(), [](const Image& image) {
			return image.tip >= 0;
		}));
	}
	bool isComplete() const { return present() == size(); }
	/// The fraction of the orbit that is present.
	double share() const { return double(present()) / double(size()); }
	/// Whether its share is larger than that of another orbit or, if equal, whether it reaches clearly
	/// farther, as corners do.
	bool isFuller(const TipOrbit& other) const
	{
		constexpr double clearly = 0.02; // diagonals
		return share() != other.share() ? share() > other.share() : reach > other.reach + clearly;
	}
};

/**
 * The orbits of a skeleton's tips. A tip is at an image of another one if each is the tip nearest
 * to the image of the other, and both are in the same limb. The place of a tip within its limb
 * varies: two places are in the same limb if they are nearer than the radius of the tip or 1 % of
 * the diagonal, or in view of each other and nearer than 0.3 of the length of the branch, bounded by
 * 2 and 8 % of the diagonal.
 * @pre the radius of tips is their distance from the surface. @throws Cancelled
 * Complexity: O(M T (M + log T)) for T tips and M maps.
 */
inline std::vector<TipOrbit> tipOrbits(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	KnownClearances& clearances, const std::vector<Eigen::Isometry3d>& maps)
{
	constexpr double always = 0.01, least = 0.02, most = 0.08; // diagonals
	constexpr double beside = 0.01;                            // diagonals
	constexpr double ofLength = 0.3;
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const std::vector<int> tips = tipsOf(neighbours);
	std::vector<Point3d> places;
	for (int tip : tips)
		places.push_back(skeleton.position[size_t(tip)]);
	const PointTree tree(places);
	const auto nearest = [&](const Point3d& p) { return tips[size_t(tree.nearest(p))]; };
	std::vector<TipOrbit> orbits;
	for (int tip : tips) {
		const Point3d& own = skeleton.position[size_t(tip)];
		const double radius = skeleton.radius[size_t(tip)];
		const double length =
			branchLength(skeleton, branchAlong(neighbours, tip, neighbours[size_t(tip)][0]));
		const double near = std::max(radius, std::clamp(ofLength * length, least, most));
		const auto areInOneLimb = [&](const Point3d& p, const Point3d& q) {
			const double apart = Distance(p, q);
			return apart <= std::max(radius, always)
				|| (apart <= near
					&& isSegmentInside(surface, p, clearances.at(p), q, clearances.at(q)));
		};
		TipOrbit orbit {tip, near, {}};
		std::vector<const Eigen::Isometry3d*> holding; // that leave the tip in its place
		Point3d held = own;                            // the sum of its images under these
		for (const Eigen::Isometry3d& map : maps) {
			const Point3d place = mapped(map, own);
			const auto isThere = [&](const TipOrbit::Image& known) {
				return areInOneLimb(known.place, place);
			};
			if (areInOneLimb(place, own)) {
				holding.push_back(&map);
				held += place;
				continue;
			}
			if (std::any_of(orbit.others.begin(), orbit.others.end(), isThere))
				continue;
			const int there = nearest(place);
			const Point3d& found = skeleton.position[size_t(there)];
			const bool isImage =
				areInOneLimb(found, place) && nearest(mapped(map.inverse(), found)) == tip;
			// Two images of a tip beside a mirror plane may match the same tip.
			if (isImage
				&& std::any_of(orbit.others.begin(), orbit.others.end(),
					[&](const TipOrbit::Image& known) { return known.tip == there; }))
				continue;
			orbit.others.push_back({&map, place, isImage ? there : -1});
		}
		Point3d sum = own;
		for (const TipOrbit::Image& image : orbit.others)
			sum += image.place;
		orbit.reach = Distance(own, sum / double(orbit.size()));
		orbit.middle = held / double(holding.size() + 1);
		orbit.isBeside = Distance(own, orbit.middle) > beside
			&& isInPlate(skeleton, Branch {limbOf(skeleton, neighbours, tip)}, surface);
		for (const Eigen::Isometry3d* map : holding)
			for (const TipOrbit::Image& image : orbit.others)
				orbit.isHeld |= Distance(mapped(*map, image.place), image.place) > near;
		orbits.push_back(std::move(orbit));
	}
	return orbits;
}

/**
 * Adds the image of a terminal branch, see limbOf(): from the image of its tip to the first ball of the skeleton
 * that is met; where the image ends before, or leaves the surface, to the nearest node in view.
 * @param neighbours  of the nodes that the branch has.
 * @param balls       of all nodes; takes in the new ones.
 * @pre the radii are the distances from the surface. @post the same.
 * @return whether it was added: not where the image of the tip is outside or in one of the balls,
 *         where an edge would leave the surface, or where most of it would lie on the skeleton: then
 *         the tip's image is a place along another branch. @throws Cancelled
 */
inline bool addImage(CurveSkeleton& skeleton, const std::vector<std::vector<int>>& neighbours,
	HoldingBalls& balls, int tip, const Eigen::Isometry3d& map, const ClosestSurface& surface,
	KnownClearances& clearances)
{
	constexpr double least = 0.25; // of the limb outside the ball at its end
	BallChain image;
	int joint = -1;
	const std::vector<int> limb = limbOf(skeleton, neighbours, tip);
	for (int v : limb) {
		const Point3d p = mapped(map, skeleton.position[size_t(v)]);
		const double radius = clearances.at(p);
		joint = balls.deepest(p);
		if (joint >= 0 || radius <= 0)
			break;
		image.points.push_back(p);
		image.radii.push_back(radius);
	}
	if (image.points.empty()
		|| lengthsAlong(image.points).back() < least
				* (branchLength(skeleton, Branch {limb}) - skeleton.radius[size_t(limb.back())]))
		return false;
	if (joint < 0)
		joint = nearestInView(skeleton, surface, image.points.back(), image.radii.back(),
			std::numeric_limits<double>::infinity());
	if (joint < 0)
		return false;
	image.points.push_back(skeleton.position[size_t(joint)]);
	image.radii.push_back(skeleton.radius[size_t(joint)]);
	for (size_t i = 1; i < image.points.size(); ++i)
		if (!isSegmentInside(
				surface, image.points[i - 1], image.radii[i - 1], image.points[i], image.radii[i]))
			return false;
	int last = joint;
	for (size_t i = image.points.size() - 1; i-- > 0;) {
		const int next = int(skeleton.position.size());
		skeleton.position.push_back(image.points[i]);
		skeleton.radius.push_back(image.radii[i]);
		skeleton.edges.push_back({last, next});
		last = next;
	}
	balls.addNew();
	return true;
}

/// The orbit with the largest share; of several the one that reaches farthest. @pre there is one.
inline const TipOrbit& fullest(const std::vector<TipOrbit>& orbits)
{
	return *std::max_element(
		orbits.begin(), orbits.end(), [](const TipOrbit& one, const TipOrbit& other) {
			return std::pair(one.share(), one.reach) < std::pair(other.share(), other.reach);
		});
}

/**
 * Adds the missing images of terminal branches of which at least half are present, of those first
 * of which the most are present; where there are none, those of the fullest orbits that are held.
 * @param isClosed  whether the maps are a group; if not, the shape is nearly round.
 * @return whether any was added. @throws Cancelled
 * @pre the radii are the distances from the surface. @post the same.
 */
inline bool addImages(CurveSkeleton& skeleton, const std::vector<TipOrbit>& orbits, bool isClosed,
	const ClosestSurface& surface, KnownClearances& clearances)
{
	const TipOrbit& best = fullest(orbits);
	const bool isBestFew = isClosed && best.isHeld && 2 * best.present() < best.size();
	const auto isToBeCompleted = [&](const TipOrbit& orbit) {
		return !orbit.isComplete()
			&& (2 * orbit.present() >= orbit.size()
				|| (isBestFew && orbit.isHeld && !best.isFuller(orbit)));
	};
	size_t most = 0;
	for (const TipOrbit& orbit : orbits)
		if (isToBeCompleted(orbit))
			most = std::max(most, orbit.present());
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	HoldingBalls balls(skeleton);
	std::vector<Point3d> added;
	for (const TipOrbit& orbit : orbits) {
		if (!isToBeCompleted(orbit) || orbit.present() < most)
			continue;
		for (const TipOrbit::Image& image : orbit.others) {
			const auto isThere = [&](const Point3d& tip) {
				return Distance(tip, image.place) <= orbit.near;
			};
			if (image.tip < 0 && std::none_of(added.begin(), added.end(), isThere)
				&& addImage(
					skeleton, neighbours, balls, orbit.tip, *image.map, surface, clearances))
				added.push_back(image.place);
		}
	}
	std::sort(skeleton.edges.begin(), skeleton.edges.end());
	return !added.empty();
}

/**
 * Removes stray branches. Where another branch has at least half of its images, and more than they:
 * those with fewer than half, if they are shorter than three radii of the ball at their junction,
 * and stubs in plates, see lackOfLobe(), with at most half. Wherever another orbit is fuller: those
 * in plates with fewer than half, however long, since it is arbitrary where on a rim the flow ends.
 * The shortest go first.
 * @param isClosed  as in addImages().
 * @return whether any was removed.
 * @pre the radii are the distances from the surface. @throws Cancelled
 */
inline bool removeStubs(CurveSkeleton& skeleton, const std::vector<TipOrbit>& orbits, bool isClosed,
	const ClosestSurface& surface, const Progress& progress)
{
	constexpr double longest = 3; // radii
	const TipOrbit& best = fullest(orbits);
	size_t most = 0;
	for (const TipOrbit& orbit : orbits)
		if (2 * orbit.present() >= orbit.size())
			most = std::max(most, orbit.present());
	enum Share : char { Most, Half, Few, Least };
	std::vector<Share> share(skeleton.position.size(), Most);
	for (const TipOrbit& orbit : orbits) {
		if (2 * orbit.present() > orbit.size())
			continue;
		const bool isHalf = 2 * orbit.present() == orbit.size();
		if (orbit.present() < most)
			share[size_t(orbit.tip)] = isHalf ? Half : Few;
		else if (isClosed && !isHalf && best.isFuller(orbit))
			share[size_t(orbit.tip)] = Least;
	}
	CurveSkeleton fewer = withoutTerminalBranches(
		skeleton, 0,
		[&](const CurveSkeleton& s, const Branch& fromJunction) {
			const Share own = share[size_t(fromJunction.last())];
			if (own == Most)
				return 0.0;
			const double length = branchLength(s, fromJunction);
			const double excess = length - longest * s.radius[size_t(fromJunction.first())];
			if (own == Few && excess < 0)
				return excess;
			if (const double lack = lackOfLobe(s, fromJunction, 2, surface); lack < 0)
				return lack;
			return isClosed && own != Half && isInPlate(s, fromJunction, surface) ? -1 / length : 0;
		},
		progress);
	if (fewer.position.size() == skeleton.position.size())
		return false;
	skeleton = std::move(fewer);
	return true;
}

/**
 * Moves the first tip that is beside the middle of its images in one limb there, see
 * TipOrbit::middle: on the rim of a plate the flow may end anywhere. Not if the middle cannot be
 * seen from the branch.
 * @return whether one was moved; nodes are renumbered then. @throws Cancelled
 */
inline bool moveTipToMiddle(CurveSkeleton& skeleton, const std::vector<TipOrbit>& orbits,
	const ClosestSurface& surface, KnownClearances& clearances)
{
	constexpr double before = 2; // ways of the tip: where the new end begins
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	for (const TipOrbit& orbit : orbits) {
		if (!orbit.isBeside)
			continue;
		const Branch fromTip {limbOf(skeleton, neighbours, orbit.tip)};
		std::vector<Point3d> points;
		for (int v : fromTip.nodes)
			points.push_back(skeleton.position[size_t(v)]);
		const std::vector<double> along = lengthsAlong(points);
		const double far = before * Distance(points[0], orbit.middle);
		const size_t root =
			size_t(std::lower_bound(along.begin(), along.end() - 1, far) - along.begin());
		if (root == 0
			|| !isSegmentInside(surface, points[root], clearances.at(points[root]), orbit.middle,
				clearances.at(orbit.middle)))
			continue;
		skeleton = withNewEnd(skeleton, fromTip, root, {orbit.middle}, clearances);
		return true;
	}
	return false;
}

/**
 * The skeleton of a symmetric shape with the images of its branches. Where the flow is undecided, as
 * before the corners of a box or a blunt limb, one side may have a branch and the other none. Where
 * at least half of the images of a branch are present, the others are added, see addImages(); short
 * branches of which fewer are present, and branches in plates, are removed, see removeStubs(). None of
 * this if as many images are missing afterwards, or if some are and there are fewer tips. At last, tips
 * in plates go to the middle of their images in the same limb, see moveTipToMiddle().
 * @return its radii are the distances from the surface; nothing if nothing changes.
 * @throws Cancelled. Complexity: SymmetryFinder, and if a tip is not where symmetry wants it a closest
 *         point for each node and symmetry.
 */
inline std::optional<CurveSkeleton> withImages(CurveSkeleton skeleton,
	const SurfaceComponent& component, const ClosestSurface& surface, KnownClearances& clearances,
	const Progress& progress)
{
	constexpr int maxRounds = 8;
	if (tipsOf(skeleton.neighbours()).empty())
		return std::nullopt;
	measureBranchEnds(skeleton, clearances);
	const auto incomplete = [](const std::vector<TipOrbit>& some) {
		return std::count_if(
			some.begin(), some.end(), [](const TipOrbit& orbit) { return !orbit.isComplete(); });
	};
	const auto beside = [](const std::vector<TipOrbit>& some) {
		return std::count_if(
			some.begin(), some.end(), [](const TipOrbit& orbit) { return orbit.isBeside; });
	};
	const SymmetryFinder finder(component.mesh, component.vertices, surface, progress);
	// Fitting is expensive: it is skipped where nothing is to be done under any candidate.
	const std::vector<TipOrbit> possible =
		tipOrbits(skeleton, surface, clearances, finder.possible());
	if (incomplete(possible) + beside(possible) == 0)
		return std::nullopt;
	std::vector<Eigen::Isometry3d> symmetries = finder.found();
	std::vector<Eigen::Isometry3d> maps = generatedGroup(symmetries);
	std::vector<TipOrbit> orbits = tipOrbits(skeleton, surface, clearances, maps);
	if (incomplete(orbits) + beside(orbits) == 0)
		return std::nullopt;
	const auto isWrong = [&](const Eigen::Isometry3d& map) {
		return !isSymmetricAlong(skeleton, surface, clearances, map, progress);
	};
	symmetries.erase(
		std::remove_if(symmetries.begin(), symmetries.end(), isWrong), symmetries.end());
	maps = generatedGroup(symmetries);
	const bool isClosed = isGroup(maps);
	measureNodes(skeleton, clearances);
	orbits = tipOrbits(skeleton, surface, clearances, maps);
	const CurveSkeleton given = skeleton;
	const auto before = incomplete(orbits);
	const size_t tips = orbits.size();
	for (int round = 0; round < maxRounds && incomplete(orbits) > 0; ++round) {
		progress.check();
		if (!removeStubs(skeleton, orbits, isClosed, surface, progress)
			&& !addImages(skeleton, orbits, isClosed, surface, clearances))
			break;
		orbits = tipOrbits(skeleton, surface, clearances, maps);
	}
	const auto left = incomplete(orbits);
	const bool isBetter = left < before && (left == 0 || orbits.size() >= tips);
	if (!isBetter) {
		skeleton = given;
		orbits = tipOrbits(skeleton, surface, clearances, maps);
	}
	size_t moved = 0;
	for (; moved < tips && moveTipToMiddle(skeleton, orbits, surface, clearances); ++moved)
		orbits = tipOrbits(skeleton, surface, clearances, maps);
	return isBetter || moved > 0 ? std::optional(skeleton) : std::nullopt;
}

} // namespace vcg::tri::mcf::refining

#endif
