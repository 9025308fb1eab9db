// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Balls that a surface does not enter, and curves that such balls cover: a cheap proof that
/// a curve is inside.

#ifndef VCG_MCF_EMPTY_BALLS_H
#define VCG_MCF_EMPTY_BALLS_H

#include "point_tree.h"

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// No point of a triangle is farther from its nearest corner than this: of equilateral triangles
/// the centre. @param longest  its longest edge.
inline double coveringOfTriangle(double longest)
{
	return longest / std::sqrt(3.0);
}

/**
 * Lower bounds of the distance from a surface, by samples of it: min |p - s| - c(s) over the
 * samples s, where the part of the surface that is nearest to s is no farther from it than c(s).
 */
class EmptyBalls
{
public:
	/// @param covering  c of each sample.
	explicit EmptyBalls(std::vector<double> covering) : covering(std::move(covering))
	{
		for (const double c : this->covering)
			largest = std::max(largest, c);
	}

	/// The radius of a ball around p that the surface does not enter; 0 near the surface.
	/// @param samples  the ids are indices into the coverings.
	/// Complexity: O(log S) where the samples are about evenly spaced.
	double radius(const PointTree& samples, const Point3d& p) const
	{
		return std::max(
			minimum(samples, p,
				[&](int sample, double distance) { return distance - covering[size_t(sample)]; }),
			0.0);
	}

	/**
	 * The radius of the largest such ball: the distance from the surface.
	 * @param distanceAround  gives the distance of p from the triangles around a sample, those of
	 *                        which it is the nearest sample to some point.
	 * @param left            how many samples may still be looked at; the result is 0 if they do not
	 *                        suffice.
	 * Complexity: O(n) for the n samples no farther away than the surface and the largest covering.
	 */
	template <class DistanceAround>
	double largestRadius(const PointTree& samples, const Point3d& p,
		const DistanceAround& distanceAround, int& left) const
	{
		const double distance = minimum(samples, p,
			[&](int sample, double) { return --left < 0 ? -largest : distanceAround(sample); });
		return std::max(distance, 0.0);
	}

private:
	std::vector<double> covering;
	double largest = 0;

	/// The minimum of a function of samples that is at least their distance less the largest covering.
	template <class Function>
	double minimum(const PointTree& samples, const Point3d& p, const Function& function) const
	{
		struct Search
		{
			const PointTree& samples;
			const Point3d& p;
			const Function& function;
			double largest;
			double minimum = std::numeric_limits<double>::max() / 2;

			const Point3d& centre() const { return p; }
			double reach() const { return std::max(minimum + largest, 0.0); }
			void visit(int slot, const Point3d& sample)
			{
				minimum =
					std::min(minimum, function(samples.order()[size_t(slot)], Distance(sample, p)));
			}
		};
		Search search {samples, p, function, largest};
		samples.search<true>(search);
		return search.minimum;
	}
};

/// EmptyBalls of a surface whose vertices are the samples, and its exact distances.
class EmptyBallsOfSurface
{
public:
	/// @param points, triangles  are kept by reference.
	/// @param progress  also cancels largestRadius(). @throws Cancelled. Complexity: O(V log V + F).
	EmptyBallsOfSurface(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const Progress& progress) :
			points(points),
			triangles(triangles), cancel(progress.cancelOnly()), samples(points, progress),
			balls(coverings())
	{
	}

	/// @see EmptyBalls::radius()
	double radius(const Point3d& p) const { return balls.radius(samples, p); }

	/// @see EmptyBalls::largestRadius() @throws Cancelled
	double largestRadius(const Point3d& p, int& left)
	{
		if (!fans)
			fans.emplace(
				3 * int(triangles.size()), points.size(),
				[&](int i) { return triangles[size_t(i) / 3][size_t(i) % 3]; },
				[](int i) { return i / 3; }, cancel, sorting);
		const auto distanceAround = [&](int v) {
			double squared = std::numeric_limits<double>::max();
			const auto [begin, end] = fans->of(v);
			for (const int* f = begin; f != end; ++f)
				squared =
					std::min(squared, detail::squaredDistance(points, triangles[size_t(*f)], p));
			return std::sqrt(squared);
		};
		return balls.largestRadius(samples, p, distanceAround, left);
	}

private:
	const std::vector<Point3d>& points;
	const std::vector<Triangle>& triangles;
	Progress cancel;
	PointTree samples;
	EmptyBalls balls;
	std::optional<detail::SortedGroups<int>> fans; ///< triangles around each vertex, when needed

	static constexpr const char* sorting = "Sorting the surface";

	std::vector<double> coverings() const
	{
		std::vector<double> covering(points.size(), 0);
		detail::cancellableLoop(int(triangles.size()), cancel, [&](int f) {
			const Triangle& t = triangles[size_t(f)];
			double longest = 0;
			for (int i = 0; i < 3; ++i)
				longest = std::max(longest, Distance(points[t[i]], points[t[(i + 1) % 3]]));
			for (int v : t)
				covering[v] = std::max(covering[v], coveringOfTriangle(longest));
		});
		return covering;
	}
};

/**
 * Whether balls that a surface does not enter cover the segment from a to b, so that no point of
 * the surface is on it: those around its ends or, if they do not reach, those of each half.
 * @param radiusAt  gives the radius of such a ball around a point; 0 gives up.
 * @param halvings  the most.
 */
template <class RadiusAt>
bool isCoveredByBalls(const Point3d& a, double radiusA, const Point3d& b, double radiusB,
	const RadiusAt& radiusAt, int halvings)
{
	if (!(radiusA > 0) || !(radiusB > 0))
		return false;
	if (Distance(a, b) <= radiusA + radiusB)
		return true;
	if (halvings == 0)
		return false;
	const Point3d middle = (a + b) / 2;
	const double radius = radiusAt(middle);
	return isCoveredByBalls(a, radiusA, middle, radius, radiusAt, halvings - 1)
		&& isCoveredByBalls(middle, radius, b, radiusB, radiusAt, halvings - 1);
}

/// Balls around the nodes of a curve, and which of its edges they cover.
struct CoveredCurve
{
	std::vector<double> radius;  ///< of the ball around each node
	std::vector<char> isCovered; ///< of each edge: see isCoveredByBalls()
};

/// Finds them, several at once.
/// @param radiusAt, halvings  see isCoveredByBalls(); called on several threads.
/// @throws Cancelled. Complexity: O(N + E) calls of radiusAt.
template <class RadiusAt>
CoveredCurve coveredCurve(const std::vector<Point3d>& node,
	const std::vector<std::array<int, 2>>& edges, const RadiusAt& radiusAt, int halvings,
	const Progress& progress, const char* what)
{
	CoveredCurve covered = {std::vector<double>(node.size()), std::vector<char>(edges.size())};
	forEachBlock(int(node.size()), progress.part(0, 0.5), what, [&](int begin, int end) {
		for (int v = begin; v < end; ++v)
			covered.radius[v] = radiusAt(node[v]);
	});
	forEachBlock(int(edges.size()), progress.part(0.5, 1), what, [&](int begin, int end) {
		for (int e = begin; e < end; ++e) {
			const auto& [a, b] = edges[e];
			covered.isCovered[e] = isCoveredByBalls(
				node[a], covered.radius[a], node[b], covered.radius[b], radiusAt, halvings);
		}
	});
	return covered;
}

} // namespace vcg::tri::mcf

#endif
