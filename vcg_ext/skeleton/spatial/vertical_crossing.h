// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Crossings of a triangle and a line along z, consistent across the edges of a surface.

#ifndef VCG_MCF_VERTICAL_CROSSING_H
#define VCG_MCF_VERTICAL_CROSSING_H

#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * Whether (x, y) is on the left of the edge from v to w, seen from above; for w v the answer is
 * exactly the opposite. On the edge, the point counts as moved by an infinitesimal step along x,
 * and by a yet infinitely smaller one along y, so that the answers are consistent at a vertex, too.
 */
inline bool isLeftOfEdge(const std::vector<Point3d>& points, int v, int w, double x, double y)
{
	const Point3d &a = points[size_t(std::min(v, w))], &b = points[size_t(std::max(v, w))];
	const double dx = b[0] - a[0], dy = b[1] - a[1];
	double side = dx * (y - a[1]) - dy * (x - a[0]);
	if (side == 0)
		side = dy != 0 ? -dy : dx;
	return (side > 0) == (v < w);
}

/// +1 or -1 where the line upwards through (x, y) leaves or enters through a triangle, else 0. Of
/// the triangles at a common edge exactly those on the line's side are crossed.
inline int verticalCrossing(
	const std::vector<Point3d>& points, const Triangle& t, double x, double y)
{
	const bool left = isLeftOfEdge(points, t[0], t[1], x, y);
	if (isLeftOfEdge(points, t[1], t[2], x, y) != left
		|| isLeftOfEdge(points, t[2], t[0], x, y) != left)
		return 0;
	return left ? 1 : -1;
}

/// +1 or -1 where the ray upwards from p leaves or enters through a triangle, else 0: the sum over a
/// closed surface is its winding number around p.
inline int crossingAbove(const std::vector<Point3d>& points, const Triangle& t, const Point3d& p)
{
	const int crossing = verticalCrossing(points, t, p[0], p[1]);
	if (crossing == 0)
		return 0;
	const Point3d& a = points[size_t(t[0])];
	const Point3d n = (points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a);
	if (n[2] == 0)
		return 0;
	const double height = ((a - p) * n) / n[2];
	return height > 0 ? crossing : 0;
}

/// The height of a triangle's plane at (x, y); nothing if the plane is vertical.
inline std::optional<double> heightOfPlane(
	const std::vector<Point3d>& points, const Triangle& t, double x, double y)
{
	const Point3d& a = points[size_t(t[0])];
	const Point3d n = (points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a);
	if (n[2] == 0)
		return std::nullopt;
	return a[2] - (n[0] * (x - a[0]) + n[1] * (y - a[1])) / n[2];
}

} // namespace vcg::tri::mcf::detail

#endif
