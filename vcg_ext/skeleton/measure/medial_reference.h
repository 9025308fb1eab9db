// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The medial axis of a triangle mesh as a dense set of balls, to measure skeletons against.

#ifndef VCG_MCF_MEDIAL_REFERENCE_H
#define VCG_MCF_MEDIAL_REFERENCE_H

#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/maximal_ball.h>
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

/// A maximal ball and where it touches, or nearly touches, the surface a second time.
struct TouchingBall
{
	Point3d point;
	MaximalBall ball;
	Point3d contact;

	/// One that touches nothing else yet: its spokes are opposite.
	TouchingBall(const Point3d& point, const Point3d& outward, double radius) :
			point(point), ball(point, outward, 0, radius), contact(point - outward * (2 * radius))
	{
	}

	/// The angle between the two contacts, seen from the centre, radians.
	double spokeAngle() const
	{
		const Point3d a = point - ball.centre(), b = contact - ball.centre();
		return std::atan2((a ^ b).Norm(), a * b);
	}
};

/**
 * Shrinks a ball until nothing is deeper in it than a thousandth of its radius: facets of a round
 * surface are no second contact.
 * @param deepest  (centre, reach, where): whether there is a point nearer to the centre than
 *                 `reach`; then sets `where` to the nearest.
 */
template <class Deepest>
void shrink(TouchingBall& touching, int maxSteps, const Deepest& deepest)
{
	constexpr double tolerance = 1e-3;
	MaximalBall& ball = touching.ball;
	for (int i = 0; i < maxSteps; ++i) {
		Point3d x(0, 0, 0);
		const double radius = ball.radius();
		if (!deepest(ball.centre(), radius * (1 - tolerance), x))
			return;
		ball.visit(/*slot*/ 0, x);
		if (!(ball.radius() < radius))
			return;
		touching.contact = x;
	}
}

/// Shrinks a ball against the surface itself.
inline void shrinkExactly(TouchingBall& touching, const ClosestSurface& surface, int near)
{
	shrink(touching, 30, [&](const Point3d& centre, double reach, Point3d& where) {
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

	std::vector<Point3d> centre(samples.size());
	std::vector<double> radius(samples.size());
	std::vector<char> isMedial(samples.size(), 0);
	const auto shrinkAll = [&](int begin, int end) {
		for (int i = begin; i < end; ++i) {
			detail::TouchingBall touching(samples[i].position, outward[i], largest);
			detail::shrink(touching, 12, [&](const Point3d& centre, double reach, Point3d& where) {
				detail::DeepestPoint search {centre, reach};
				tree.search(search);
				where = search.found;
				return search.any;
			});
			// A ball that is held by a near neighbour can only shrink further.
			if (touching.spokeAngle() < detail::minSpokeAngle - margin)
				continue;
			detail::shrinkExactly(touching, closest, samples[i].face);
			const detail::MaximalBall& ball = touching.ball;
			isMedial[i] = touching.spokeAngle() >= detail::minSpokeAngle
				&& ball.radius() > minRadius && closest.clearance(ball.centre()) > 0;
			centre[i] = ball.centre();
			radius[i] = ball.radius();
		}
	};
	constexpr int blocksPerReport = 8;
	forEachBlock(
		int(samples.size()), progress, "Finding the medial axis", shrinkAll, blocksPerReport);
	MedialReference reference;
	for (size_t i = 0; i < samples.size(); ++i)
		if (isMedial[i]) {
			reference.centre.push_back(centre[i]);
			reference.radius.push_back(radius[i]);
		}
	return reference;
}

} // namespace vcg::tri::mcf

#endif
