// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whether points and segments are inside a closed surface that may cross itself.

#ifndef VCG_MCF_SOLID_TEST_H
#define VCG_MCF_SOLID_TEST_H

#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The solid bounded by a closed, oriented surface: all points whose winding number is not 0. Unlike the
 * side of the nearest triangle, that is defined where the surface crosses itself.
 *
 * Points are taken in coordinates of the test's own, see in(): the diagonal of the bounding box is 1, and
 * the axes are turned so that nothing in the shape is parallel to them.
 */
class SolidTest
{
public:
	/// A point of the surface that is closest to another one.
	struct Closest
	{
		Point3d point;
		double distance;
		int face;
	};

	/**
	 * @param points    of the surface, mesh units; @param triangles whose corners are indices into them.
	 * @throws Cancelled. Complexity: O(F) for even triangles.
	 */
	SolidTest(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const Progress& progress = Progress()) :
			faces(triangles)
	{
		const char* const what = "Sorting the surface";
		Box3d given;
		for (const Point3d& p : points)
			given.Add(p);
		middle = given.Center();
		unit = given.Diag() > 0 ? given.Diag() : 1;
		corner.reserve(points.size());
		detail::reportedLoop(int(points.size()), progress.part(0, 0.2), what, [&](int v) {
			corner.push_back(in(points[v]));
			box.Add(corner.back());
		});
		sortFaces(progress.part(0.2, 1), what);
		seen.assign(faces.size(), 0);
	}

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
	/// A vertex of the surface, in the coordinates of the test.
	const Point3d& vertex(int v) const { return corner[v]; }
	const std::vector<Triangle>& triangles() const { return faces; }

	/**
	 * Whether the winding number at p is not 0: the crossings of a ray along the third axis are counted
	 * by their sense. Two triangles decide in the same way on which side of their common edge the ray is.
	 * Complexity: O(n) for the n triangles in the column of cells around the ray.
	 */
	bool isInside(const Point3d& p) const
	{
		if (!box.IsIn(p))
			return false;
		int winding = 0;
		const std::array<int, 3> cell = cellOf(p);
		startSearch();
		for (int z = cell[2]; z < cells[2]; ++z)
			forEachFaceOf({cell[0], cell[1], z}, [&](int f) { winding += crossingAbove(f, p); });
		return winding != 0;
	}

	/// As above; points no farther outside than `tolerance` count, too.
	bool isInside(const Point3d& p, double tolerance) const
	{
		return isInside(p) || closest(p).distance <= tolerance;
	}

	/**
	 * Whether no part of the segment from p to q is farther outside than `tolerance`, judged at the middle
	 * of each part between two crossings of the surface, and of sixteenths.
	 */
	bool segmentIsInside(const Point3d& p, const Point3d& q, double tolerance) const
	{
		constexpr double negligible = 1e-9; // part of the segment
		constexpr int samples = 16;         // besides: along a triangle a crossing may be missed
		std::vector<double> at;
		for (int i = 0; i <= samples; ++i)
			at.push_back(double(i) / samples);
		forEachFaceNear(p, q, [&](int f) {
			const double t = crossing(f, p, q - p);
			if (t > 0 && t < 1)
				at.push_back(t);
		});
		std::sort(at.begin(), at.end());
		for (size_t i = 1; i < at.size(); ++i)
			if (at[i] - at[i - 1] > negligible
				&& !isInside(p + (q - p) * ((at[i] + at[i - 1]) / 2), tolerance))
				return false;
		return true;
	}

	/// How far the ray from a point of the surface goes until it meets another part of it, at most 1.
	/// @param direction of unit length.
	double chord(const Point3d& from, const Point3d& direction) const
	{
		constexpr double start = 1e-9;
		const double step = std::max({cellSize[0], cellSize[1], cellSize[2]});
		for (double walked = 0; walked < 1; walked += step) {
			double nearest = 2;
			const Point3d p = from + direction * walked, piece = direction * step;
			forEachFaceNear(p, p + piece, [&](int f) {
				const double part = crossing(f, p, piece);
				if (part >= 0 && walked + step * part > start)
					nearest = std::min(nearest, walked + step * part);
			});
			if (nearest <= walked + step)
				return nearest;
		}
		return 1;
	}

	/// The point of the surface closest to p. Complexity: O(n) for the n triangles in the cells as near.
	Closest closest(const Point3d& p) const
	{
		double outside = 0; // how far p is out of the box, squared
		for (int k = 0; k < 3; ++k) {
			const double beyond = std::max({box.min[k] - p[k], p[k] - box.max[k], 0.0});
			outside += beyond * beyond;
		}
		outside = std::sqrt(outside);
		double reach = outside + std::max({cellSize[0], cellSize[1], cellSize[2]}) / 2;
		for (;; reach *= 2) {
			Closest best = {p, std::numeric_limits<double>::infinity(), -1};
			const Point3d half(reach, reach, reach);
			forEachFaceNear(p - half, p + half, [&](int f) {
				const detail::TrianglePoint on = closestOn(f, p);
				if (on.squaredDistance < best.distance)
					best = {on.point, on.squaredDistance, f};
			});
			best.distance = std::sqrt(best.distance);
			if (best.distance <= reach || reach > outside + 2) // 2: twice the diagonal
				return best;
		}
	}

private:
	std::vector<Triangle> faces;
	std::vector<Point3d> corner;
	Point3d middle;
	double unit = 1;
	Box3d box;
	std::array<int, 3> cells = {1, 1, 1};
	Point3d cellSize;
	std::vector<int> start, faceOfCell; ///< the faces whose boxes meet a cell
	// Faces that a search has met already.
	mutable std::vector<std::uint32_t> seen;
	mutable std::uint32_t search = 0;

	/// Axes of a rotation about (1, 2, 3) by 1 rad: a shape that stands straight does not to them.
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

	std::array<int, 3> cellOf(const Point3d& p) const
	{
		std::array<int, 3> cell;
		for (int k = 0; k < 3; ++k)
			cell[k] = std::clamp(int((p[k] - box.min[k]) / cellSize[k]), 0, cells[k] - 1);
		return cell;
	}

	size_t indexOf(const std::array<int, 3>& cell) const
	{
		return (size_t(cell[0]) * cells[1] + cell[1]) * cells[2] + cell[2];
	}

	/// Calls visit(cell) for the cells that a box meets.
	template <class Visitor>
	void forEachCell(const Box3d& region, const Visitor& visit) const
	{
		const std::array<int, 3> low = cellOf(region.min), high = cellOf(region.max);
		for (int x = low[0]; x <= high[0]; ++x)
			for (int y = low[1]; y <= high[1]; ++y)
				for (int z = low[2]; z <= high[2]; ++z)
					visit({x, y, z});
	}

	Box3d boxOf(int f) const
	{
		Box3d region;
		for (int v : faces[f])
			region.Add(corner[v]);
		return region;
	}

	/// Chooses the cells so that the lists stay short even if all triangles reach through the whole shape.
	void sortFaces(const Progress& progress, const char* what)
	{
		constexpr int mostAlong = 96;
		constexpr double mostOfFace = 32; // cells of a face, on average
		int along = std::clamp(int(std::sqrt(double(faces.size())) / 2), 1, mostAlong);
		for (;; along /= 2) {
			cells = {along, along, along};
			for (int k = 0; k < 3; ++k)
				cellSize[k] = std::max((box.max[k] - box.min[k]) / along, 1e-15);
			if (along == 1)
				break;
			double entries = 0;
			detail::reportedLoop(int(faces.size()), progress.part(0, 0.3), what, [&](int f) {
				const Box3d region = boxOf(f);
				const std::array<int, 3> low = cellOf(region.min), high = cellOf(region.max);
				double count = 1;
				for (int k = 0; k < 3; ++k)
					count *= high[k] - low[k] + 1;
				entries += count;
			});
			if (entries <= mostOfFace * double(faces.size()))
				break;
		}
		start.assign(size_t(cells[0]) * cells[1] * cells[2] + 1, 0);
		detail::reportedLoop(int(faces.size()), progress.part(0.3, 0.6), what, [&](int f) {
			forEachCell(
				boxOf(f), [&](const std::array<int, 3>& cell) { ++start[indexOf(cell) + 1]; });
		});
		for (size_t i = 1; i < start.size(); ++i)
			start[i] += start[i - 1];
		faceOfCell.resize(start.back());
		std::vector<int> end(start.begin(), start.end() - 1);
		detail::reportedLoop(int(faces.size()), progress.part(0.6, 1), what, [&](int f) {
			forEachCell(boxOf(f),
				[&](const std::array<int, 3>& cell) { faceOfCell[end[indexOf(cell)]++] = f; });
		});
	}

	detail::TrianglePoint closestOn(int f, const Point3d& p) const
	{
		const Triangle& t = faces[f];
		return detail::closestOnTriangle(corner[t[0]], corner[t[1]], corner[t[2]], p);
	}

	void startSearch() const
	{
		if (++search == 0) {
			std::fill(seen.begin(), seen.end(), 0);
			search = 1;
		}
	}

	/// Calls visit(face) for the faces of a cell that the search has not met yet.
	template <class Visitor>
	void forEachFaceOf(const std::array<int, 3>& cell, const Visitor& visit) const
	{
		const size_t index = indexOf(cell);
		for (int i = start[index]; i < start[index + 1]; ++i) {
			const int f = faceOfCell[i];
			if (seen[f] != search) {
				seen[f] = search;
				visit(f);
			}
		}
	}

	template <class Visitor>
	void forEachFaceNear(const Point3d& p, const Point3d& q, const Visitor& visit) const
	{
		Box3d region;
		region.Add(p);
		region.Add(q);
		startSearch();
		forEachCell(region, [&](const std::array<int, 3>& cell) { forEachFaceOf(cell, visit); });
	}

	/**
	 * Whether p is on the left of v w seen along the third axis; for w v the answer is the opposite, to the
	 * bit. On the line, p counts as moved by an infinitesimal step along the first axis and one along the
	 * second that is infinitesimal beside it, so that the answers fit together at a vertex, too.
	 */
	bool isLeft(int v, int w, const Point3d& p) const
	{
		const Point3d &a = corner[std::min(v, w)], &b = corner[std::max(v, w)];
		const double x = b[0] - a[0], y = b[1] - a[1];
		double side = x * (p[1] - a[1]) - y * (p[0] - a[0]);
		if (side == 0)
			side = y != 0 ? -y : x;
		return (side > 0) == (v < w);
	}

	/// +1 or -1 where the ray from p along the third axis leaves or enters the solid through f, else 0.
	int crossingAbove(int f, const Point3d& p) const
	{
		const Triangle& t = faces[f];
		const bool left = isLeft(t[0], t[1], p);
		if (isLeft(t[1], t[2], p) != left || isLeft(t[2], t[0], p) != left)
			return 0;
		const Point3d& a = corner[t[0]];
		const Point3d n = (corner[t[1]] - a) ^ (corner[t[2]] - a);
		if (n[2] == 0)
			return 0;
		const double height = ((a - p) * n) / n[2];
		return height > 0 ? (left ? 1 : -1) : 0;
	}

	/// Where p + t step meets face f, as t; -1 where it does not.
	double crossing(int f, const Point3d& p, const Point3d& step) const
	{
		constexpr double rounding = 1e-9; // a segment through an edge must hit one of its triangles
		const Triangle& t = faces[f];
		const Point3d& a = corner[t[0]];
		const Point3d e1 = corner[t[1]] - a, e2 = corner[t[2]] - a;
		const Point3d across = step ^ e2;
		const double determinant = e1 * across;
		if (determinant == 0)
			return -1;
		const Point3d from = p - a;
		const double u = (from * across) / determinant;
		const Point3d aside = from ^ e1;
		const double w = (step * aside) / determinant;
		if (!(u >= -rounding && w >= -rounding && u + w <= 1 + rounding))
			return -1;
		const double at = (e2 * aside) / determinant;
		return at >= 0 && at <= 1 ? at : -1;
	}
};

} // namespace vcg::tri::mcf

#endif
