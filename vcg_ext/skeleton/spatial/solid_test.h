// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whether points and segments are inside a closed surface that may cross itself.

#ifndef VCG_MCF_SOLID_TEST_H
#define VCG_MCF_SOLID_TEST_H

#include "integer_winding.h"
#include "triangle_tree.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The solid bounded by a closed, oriented surface: all points whose winding number is not 0. Unlike
 * the side of the nearest triangle, that is defined where the surface crosses itself.
 *
 * Points and lengths are in the test's own coordinates, see in(): the diagonal of the bounding box
 * is 1, and the axes are turned, so that edges and faces along the mesh's axes are oblique.
 */
class SolidTest
{
public:
	using Closest = TriangleTree::Closest;

	/**
	 * @param points    of the surface, mesh units.
	 * @param triangles corners as indices into `points`, the same at common edges.
	 * @throws Cancelled. Complexity: O(F log F).
	 */
	SolidTest(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const Progress& progress = Progress()) :
			faces(triangles)
	{
		Box3d given;
		for (const Point3d& p : points)
			given.Add(p);
		middle = given.Center();
		unit = given.Diag() > 0 ? given.Diag() : 1;
		corner.reserve(points.size());
		detail::reportedLoop(int(points.size()), progress.part(0, 0.2), "Sorting the surface",
			[&](int v) { corner.push_back(in(points[v])); });
		tree.emplace(corner, faces, progress.part(0.2, 1));
	}
	SolidTest(const SolidTest&) = delete;
	SolidTest& operator=(const SolidTest&) = delete;

	/// A point given in mesh units, in the coordinates of the test; and back.
	Point3d in(const Point3d& p) const
	{
		const Point3d q = (p - middle) / unit;
		return Point3d(axis(0) * q, axis(1) * q, axis(2) * q);
	}
	Point3d out(const Point3d& p) const
	{
		return middle + (axis(0) * p[0] + axis(1) * p[1] + axis(2) * p[2]) * unit;
	}
	/// The vertices of the surface, in the coordinates of the test.
	const std::vector<Point3d>& vertices() const { return corner; }
	const std::vector<Triangle>& triangles() const { return faces; }

	/// Whether the winding number at p is not 0. Complexity: that of integerWinding().
	bool isInside(const Point3d& p) const { return integerWinding(*tree, p) != 0; }

	/// As above; points no farther outside than `tolerance` count, too.
	bool isInside(const Point3d& p, double tolerance) const
	{
		return isInside(p) || closest(p).distance <= tolerance;
	}

	/**
	 * Whether no part of the segment from p to q is farther outside than `tolerance`. It is cut
	 * into sixteenths and at its crossings of the surface; each piece is tested at its middle.
	 */
	bool segmentIsInside(const Point3d& p, const Point3d& q, double tolerance) const
	{
		constexpr double negligible = 1e-9; // part of the segment
		constexpr int samples = 16;         // in a triangle's plane a crossing may be missed
		constexpr double isShort = 0.01;    // triangles above it are looked for once
		std::vector<double> at;
		for (int i = 0; i <= samples; ++i)
			at.push_back(double(i) / samples);
		tree->forEachCrossing(p, q, [&](int, double t, bool) {
			if (t > 0 && t < 1)
				at.push_back(t);
		});
		std::sort(at.begin(), at.end());
		std::optional<TrianglesAbove> above;
		if (Distance(p, q) <= isShort)
			above.emplace(*tree, p, q);
		for (size_t i = 1; i < at.size(); ++i) {
			if (at[i] - at[i - 1] <= negligible)
				continue;
			const Point3d middle = p + (q - p) * ((at[i] + at[i - 1]) / 2);
			const int winding = above ? above->winding(middle) : integerWinding(*tree, middle);
			if (winding == 0 && closest(middle).distance > tolerance)
				return false;
		}
		return true;
	}

	/// Where a ray meets the surface.
	struct Crossing
	{
		double distance;
		int face; ///< -1: nowhere
	};

	/// Where the ray from a point of the surface meets another part of it, at most a diagonal away.
	/// @param direction of unit length.
	Crossing chord(const Point3d& from, const Point3d& direction) const
	{
		constexpr double start = 1e-9;
		Crossing nearest = {1, -1};
		tree->forEachCrossing(from, from + direction, [&](int face, double t, bool) {
			if (t > start && t < nearest.distance)
				nearest = {t, face};
		});
		return nearest;
	}

	/// The point of the surface closest to p. Complexity: about O(log F).
	Closest closest(const Point3d& p) const { return tree->closest(p); }

private:
	std::vector<Triangle> faces;
	std::vector<Point3d> corner;
	Point3d middle;
	double unit = 1;
	std::optional<TriangleTree> tree; ///< of `corner` and `faces`

	/// Axes turned about (1, 2, 3) by 1 rad: oblique to shapes aligned with the mesh's axes.
	static const Point3d& axis(int k)
	{
		static const std::array<Point3d, 3> axes = [] {
			const Point3d along = Point3d(1, 2, 3) / std::sqrt(14.0);
			std::array<Point3d, 3> turned;
			for (int i = 0; i < 3; ++i) {
				Point3d e(0, 0, 0);
				e[i] = 1;
				turned[i] = e * std::cos(1.0) + (along ^ e) * std::sin(1.0)
					+ along * ((along * e) * (1 - std::cos(1.0)));
			}
			return turned;
		}();
		return axes[k];
	}
};

} // namespace vcg::tri::mcf

#endif
