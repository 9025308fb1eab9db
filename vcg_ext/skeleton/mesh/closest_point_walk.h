// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Closest points on a surface by walking, without a tree, for queries that move little.

#ifndef VCG_MCF_CLOSEST_POINT_WALK_H
#define VCG_MCF_CLOSEST_POINT_WALK_H

#include "surface_mesh.h"

#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The point of a triangle closest to a query, and the part of the triangle that it lies on.
struct TrianglePoint
{
	static constexpr int interior = 6;
	Point3d point;
	double squaredDistance;
	/// k: corner k; 3 + k: the edge from corner k to corner k + 1; 6: the interior.
	int part;
};

/**
 * The point of triangle (a, b, c) that is closest to q, by the Voronoi regions of its corners and
 * edges (Ericson, Real-Time Collision Detection, 2005, Sec. 5.1.5).
 */
inline TrianglePoint closestOnTriangle(
	const Point3d& a, const Point3d& b, const Point3d& c, const Point3d& q)
{
	const auto at = [&](const Point3d& p, int part) {
		return TrianglePoint {p, SquaredDistance(p, q), part};
	};
	const auto along = [&](const Point3d& from, const Point3d& to, double part, double whole,
						   int edge) {
		return at(whole > 0 ? from + (to - from) * (part / whole) : from, edge);
	};
	const Point3d ab = b - a, ac = c - a;
	const Point3d aq = q - a;
	const double abA = ab * aq, acA = ac * aq;
	if (abA <= 0 && acA <= 0)
		return at(a, 0);
	const Point3d bq = q - b;
	const double abB = ab * bq, acB = ac * bq;
	if (abB >= 0 && acB <= abB)
		return at(b, 1);
	const double areaC = abA * acB - abB * acA;
	if (areaC <= 0 && abA >= 0 && abB <= 0 && abA > abB)
		return along(a, b, abA, abA - abB, 3);
	const Point3d cq = q - c;
	const double abC = ab * cq, acC = ac * cq;
	if (acC >= 0 && abC <= acC)
		return at(c, 2);
	const double areaB = abC * acA - abA * acC;
	if (areaB <= 0 && acA >= 0 && acC <= 0 && acA > acC)
		return along(a, c, acA, acA - acC, 5);
	const double areaA = abB * acC - abC * acB;
	if (areaA <= 0 && acB >= abB && abC >= acC)
		return along(b, c, acB - abB, (acB - abB) + (abC - acC), 4);
	const double sum = areaA + areaB + areaC;
	return at(a + ab * (areaB / sum) + ac * (areaC / sum), TrianglePoint::interior);
}

/// The squared distance of q from a triangle of these points.
inline double squaredDistance(
	const std::vector<Point3d>& points, const Triangle& t, const Point3d& q)
{
	return closestOnTriangle(points[t[0]], points[t[1]], points[t[2]], q).squaredDistance;
}

} // namespace detail

/**
 * The point of `surface` that is closest to `query` among those that can be reached from `face`
 * with the distance falling all the way: across an edge where the closest point of a triangle lies
 * on the edge, round a vertex where it lies on the vertex.
 *
 * For a vertex that has left the surface a little this is the true closest point, at the cost of
 * about two triangles; and the walk does not end on the opposite wall of a thin part, which is near
 * in space but far along the surface.
 *
 * @param face where to start; becomes the face of the result.
 * @return the point, on that face up to rounding.
 * Complexity: O(faces walked over).
 */
inline Point3d trackSurface(const SurfaceMesh& surface, const Point3d& query, int& face)
{
	using detail::TrianglePoint;
	const auto closest = [&](int f) {
		return detail::closestOnTriangle(surface.position[surface.origin(3 * f)],
			surface.position[surface.origin(3 * f + 1)],
			surface.position[surface.origin(3 * f + 2)], query);
	};
	TrianglePoint best = closest(face);
	while (best.part != TrianglePoint::interior) {
		const int from = face;
		const auto consider = [&](int f) {
			const TrianglePoint candidate = closest(f);
			if (candidate.squaredDistance < best.squaredDistance) {
				best = candidate;
				face = f;
			}
		};
		if (best.part >= 3)
			consider(surface.twin(3 * from + best.part - 3) / 3);
		else {
			const int first = 3 * from + best.part;
			for (int h = surface.rotated(first); h != first; h = surface.rotated(h))
				consider(h / 3);
		}
		if (face == from)
			break;
	}
	return best.point;
}

} // namespace vcg::tri::mcf

#endif
