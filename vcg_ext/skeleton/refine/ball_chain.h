// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, chains of balls: a branch sampled anew, evenly or by the local thickness.

#ifndef VCG_MCF_BALL_CHAIN_H
#define VCG_MCF_BALL_CHAIN_H

#include "known_clearances.h"
#include "local_scale.h"

#include <skeleton/core/progress.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

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

/**
 * Points of a polyline at equal steps of a measure along it, both ends included.
 * @param measure  at its points, from 0, not falling.
 */
inline BallChain atEqualSteps(
	const BallChain& line, const std::vector<double>& measure, int segments)
{
	BallChain chain = {{line.points.front()}, {line.radii.front()}};
	const std::vector<double> along = lengthsAlong(line.points);
	size_t i = 1;
	for (int k = 1; k < segments; ++k) {
		const double s = measure.back() * k / segments;
		while (i + 1 < measure.size() && measure[i] < s)
			++i;
		const double whole = measure[i] - measure[i - 1], length = along[i] - along[i - 1];
		const double t = whole > 0 ? (s - measure[i - 1]) / whole : 0;
		chain.points.push_back(line.points[i - 1] + (line.points[i] - line.points[i - 1]) * t);
		// The distance from the surface cannot change faster than the place.
		chain.radii.push_back(
			std::max(line.radii[i - 1] - t * length, line.radii[i] - (1 - t) * length));
	}
	chain.points.push_back(line.points.back());
	chain.radii.push_back(line.radii.back());
	return chain;
}

/// Points of a polyline at equal steps of its length, both ends included.
inline BallChain evenPoints(const BallChain& line, int segments)
{
	return atEqualSteps(line, lengthsAlong(line.points), segments);
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
	std::vector<double> steps(line.points.size(), 0);
	for (size_t i = 1; i < steps.size(); ++i)
		steps[i] = steps[i - 1]
			+ Distance(line.points[i - 1], line.points[i]) * 2 / (spacings[i - 1] + spacings[i]);
	return atEqualSteps(line, steps, std::max(minimum, int(std::lround(steps.back()))));
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

} // namespace vcg::tri::mcf::refining

#endif
