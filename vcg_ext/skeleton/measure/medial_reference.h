// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The medial axis of a triangle mesh as a dense set of balls, to measure skeletons against.

#ifndef VCG_MCF_MEDIAL_REFERENCE_H
#define VCG_MCF_MEDIAL_REFERENCE_H

#include <skeleton/spatial/closest_surface.h>
#include <skeleton/core/parallel.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/surface_samples.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// Balls inside a surface that touch it in two places.
struct MedialReference
{
	std::vector<Point3d> centre;
	std::vector<double> radius;
};

namespace detail {

/// A ball that touches the surface at a point and has its centre below it.
struct TouchingBall
{
	Point3d point, outward;
	double radius;
	/// Where it touches, or nearly touches, a second time.
	Point3d contact;

	Point3d centre() const { return point - outward * radius; }

	/// The angle between the two contacts, seen from the centre, radians.
	double spokeAngle() const
	{
		const Point3d a = point - centre(), b = contact - centre();
		return std::atan2((a ^ b).Norm(), a * b);
	}

	/// A ball of the given radius that touches nothing else yet: its spokes are opposite.
	static TouchingBall alone(const Point3d& point, const Point3d& outward, double radius)
	{
		return {point, outward, radius, point - outward * (2 * radius)};
	}
};

/**
 * Shrinks a ball until nothing is deeper in it than a thousandth of its radius: facets of a round
 * surface are no second contact.
 * @param deepest  (centre, reach, where): whether there is a point nearer to the centre than
 *                 `reach`; then sets `where` to the nearest.
 */
template <class Deepest>
void shrink(TouchingBall& ball, int maxSteps, const Deepest& deepest)
{
	constexpr double tolerance = 1e-3;
	for (int i = 0; i < maxSteps; ++i) {
		Point3d x(0, 0, 0);
		if (!deepest(ball.centre(), ball.radius * (1 - tolerance), x))
			return;
		const Point3d e = ball.point - x;
		const double depth = e * ball.outward;
		const double radius = depth > 0 ? e.SquaredNorm() / (2 * depth) : ball.radius;
		if (!(radius < ball.radius))
			return;
		ball.radius = radius;
		ball.contact = x;
	}
}

/// Shrinks a ball against the surface itself.
inline void shrinkExactly(TouchingBall& ball, const ClosestSurface& surface, int near)
{
	shrink(ball, 30, [&](const Point3d& centre, double reach, Point3d& where) {
		const ClosestSurface::Hit hit = surface.closest(centre, near);
		near = hit.face;
		where = hit.point;
		return hit.distance < reach;
	});
}

/// The search for the point of a tree that is deepest in a ball, see PointTree::search().
struct DeepestPoint
{
	Point3d middle;
	double distance;
	Point3d found = Point3d(0, 0, 0);
	bool any = false;

	const Point3d& centre() const { return middle; }
	double reach() const { return distance; }
	void visit(int, const Point3d& p)
	{
		const double d = Distance(p, middle);
		if (d < distance || (any && d == distance && p < found)) {
			distance = d;
			found = p;
			any = true;
		}
	}
};

/// Radians. Contacts of a ball closer to each other than this, seen from its centre, count as one.
constexpr double minSpokeAngle = M_PI / 3;

} // namespace detail

/**
 * Maximal inner balls at points spread evenly over a surface, and at its vertices if these are not
 * more: those of a radius above 1e-4 whose two contacts are at least 60 degrees apart, seen from
 * the centre.
 *
 * @param surface  compact, with a bounding box diagonal of 1.
 * @param closest  of all of `surface`.
 * @param count    points on the surface.
 * @throws Cancelled. Complexity: O((count + V) log V). Same bits on any number of threads.
 * Source: Ma, Bae and Choi, "3D medial axis point approximation using nearest neighbors and the
 *         normal field", The Visual Computer 28, 2012.
 */
inline MedialReference medialReference(const SurfaceMesh& surface, const ClosestSurface& closest,
	int count, const Progress& progress = Progress())
{
	constexpr int firstGuess = 20000;    // points that bound the balls before the surface does
	constexpr double largest = 0.5;      // half the diagonal: no inner ball is larger
	constexpr double margin = M_PI / 12; // radians by which a first guess may be too narrow
	constexpr double minRadius = 1e-4;
	const Progress begin = progress.cancelOnly();
	std::vector<SurfaceSample> samples = surfaceSamples(surface, count, begin);
	std::vector<Point3d> outward;
	for (const SurfaceSample& sample : samples) {
		const Point3d n = surface.doubleAreaVector(sample.face);
		outward.push_back(n / std::max(n.Norm(), 1e-300));
	}
	if (surface.vertexSlots() <= count) {
		const std::vector<Point3d> normals = surface.vertexNormals(begin);
		for (int v = 0; v < surface.vertexSlots(); ++v)
			if (normals[v].SquaredNorm() > 0) {
				samples.push_back({surface.position[v], surface.outgoing(v) / 3});
				outward.push_back(normals[v]);
			}
	}
	std::vector<Point3d> few;
	for (const SurfaceSample& sample : surfaceSamples(surface, std::min(count, firstGuess), begin))
		few.push_back(sample.position);
	const PointTree tree(few, begin);

	std::vector<detail::TouchingBall> balls(samples.size());
	std::vector<char> isMedial(samples.size(), 0);
	const auto shrinkAll = [&](int begin, int end) {
		for (int i = begin; i < end; ++i) {
			auto ball = detail::TouchingBall::alone(samples[i].position, outward[i], largest);
			detail::shrink(ball, 12, [&](const Point3d& centre, double reach, Point3d& where) {
				detail::DeepestPoint search {centre, reach};
				tree.search(search);
				where = search.found;
				return search.any;
			});
			// A ball that is held by a near neighbour can only shrink further.
			if (ball.spokeAngle() < detail::minSpokeAngle - margin)
				continue;
			detail::shrinkExactly(ball, closest, samples[i].face);
			isMedial[i] = ball.spokeAngle() >= detail::minSpokeAngle && ball.radius > minRadius
				&& closest.clearance(ball.centre()) > 0;
			balls[i] = ball;
		}
	};
	constexpr int blocksPerReport = 8;
	forEachBlock(
		int(samples.size()), progress, "Finding the medial axis", shrinkAll, blocksPerReport);
	MedialReference reference;
	for (size_t i = 0; i < balls.size(); ++i)
		if (isMedial[i]) {
			reference.centre.push_back(balls[i].centre());
			reference.radius.push_back(balls[i].radius);
		}
	return reference;
}

} // namespace vcg::tri::mcf

#endif
