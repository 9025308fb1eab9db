// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Borders of holes as the ends of limbs: place, radius and direction.

#ifndef VCG_MCF_LIMB_ENDS_H
#define VCG_MCF_LIMB_ENDS_H

#include "fill_holes.h"
#include "part_surface.h"

#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace vcg::tri::mcf::detail {

/// The shape of a border, smoothed so that its teeth do not count: ratios of its length. Each is 1 for
/// a circle.
struct BorderShape
{
	double slenderness = 0; ///< to the perimeter of a disc with the area of the hole
	double concavity = 1;   ///< of its projection into the plane of the hole, to that of its hull
	double warp = 1;        ///< to the perimeter of the convex hull of that projection
};

/// The shape of a border. @param corner  its vertices. @param area  its area vector, see areaVector().
/// Complexity: O(n) for n vertices.
inline BorderShape borderShape(
	const std::vector<Point3d>& points, const std::vector<int>& corner, const Point3d& area)
{
	constexpr int rounds = 4;      // of smoothing: teeth of one or two edges vanish
	constexpr int directions = 64; // error of the hull's perimeter: 0.1 %
	const size_t n = corner.size();
	std::vector<Point3d> polygon, smoother(n);
	for (const int v : corner)
		polygon.push_back(points[size_t(v)]);
	for (int round = 0; round < rounds; ++round, polygon.swap(smoother))
		for (size_t i = 0; i < n; ++i)
			smoother[i] =
				(polygon[(i + n - 1) % n] + polygon[i] * 2.0 + polygon[(i + 1) % n]) / 4.0;
	if (!(area.Norm() > 0))
		return {std::numeric_limits<double>::infinity(), 1, 1};
	Point3d normal = area / area.Norm();
	Point3d x, y;
	vcg::GetUV(normal, x, y);
	double length = 0, flat = 0, hull = 0;
	for (size_t i = 0; i < n; ++i) {
		const Point3d side = polygon[(i + 1) % n] - polygon[i];
		length += side.Norm();
		flat += (side ^ normal).Norm();
	}
	// The perimeter of a convex figure is the integral of its width over half a turn (Cauchy).
	for (int k = 0; k < directions; ++k) {
		const double angle = M_PI * k / directions;
		const Point3d along = x * std::cos(angle) + y * std::sin(angle);
		const auto [least, most] = std::minmax_element(polygon.begin(), polygon.end(),
			[&](const Point3d& p, const Point3d& q) { return p * along < q * along; });
		hull += (*most - *least) * along * (M_PI / directions);
	}
	const double ofDisc = 2 * std::sqrt(M_PI * area.Norm());
	return {length / ofDisc, flat / hull, length / hull};
}

/// The border of a hole as the end of a limb. Mesh units.
struct LimbEnd
{
	/// Border vertices, in the direction of new faces that continue the surface there.
	std::vector<int> corner;
	/// The piece of surface, by its lowest face, and the diagonal of its box.
	int piece = 0;
	double pieceDiagonal = 0;
	/// Whether that piece is to be dropped unless it is joined to others.
	bool isOfSpeck = false;
	Point3d centre = Point3d(0, 0, 0);
	/// Of the tube where it is cut through, else of the disc with the area of the hole.
	double radius = 0;
	/// The axis of the tube, out of it, where it is cut through, else `out`; unit length.
	Point3d heading = Point3d(0, 0, 0);
	/// The normal of the hole, on the side of the faces' normals; unit length.
	Point3d out = Point3d(0, 0, 0);
	/// Whether the surface heads out of the hole all around: a limb that is cut through, not a
	/// hole in the side of a body.
	bool isCutThrough = false;
	/// Whether no limb ends there and none was torn off: a slit, or several that cross.
	bool isIrregular = false;
	/// Whether the piece of surface is a patch within this border: a filling would lie back on it.
	bool isPatch = false;
	/// Whether it is cut through, and the axis of the surface behind leads out of the hole, as that
	/// of a tube does. Behind a slit the axis is parallel to the slit.
	bool isOfTube = false;

	/// Whether the border visits no vertex twice.
	bool isOnce() const
	{
		return std::set<int>(corner.begin(), corner.end()).size() == corner.size();
	}
};

/// The axis of the tube that ends at a loop of half-edges, out of it, unit length: the direction
/// most nearly perpendicular to the normals of the faces near that end.
inline Point3d axisBehind(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& partner,
	const std::vector<int>& loop, const LimbEnd& end)
{
	constexpr double reach = 4; // radii from the middle of the border
	Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
	std::set<int> seen;
	std::vector<int> stack;
	for (int h : loop)
		if (seen.insert(h / 3).second)
			stack.push_back(h / 3);
	while (!stack.empty()) {
		const int f = stack.back();
		stack.pop_back();
		const Triangle& t = triangles[size_t(f)];
		if ((points[size_t(t[0])] - end.centre).Norm() > reach * end.radius)
			continue;
		const Point3d normal = areaVector(points, t);
		if (const double norm = normal.Norm(); norm > 0) {
			const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
			square += n * n.transpose() / norm;
		}
		for (int h = 3 * f; h < 3 * f + 3; ++h)
			if (const int g = partner[size_t(h)]; g >= 0 && seen.insert(g / 3).second)
				stack.push_back(g / 3);
	}
	const Eigen::Vector3d axis =
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square).eigenvectors().col(0);
	const Point3d result(axis[0], axis[1], axis[2]);
	return result * end.heading < 0 ? -result : result;
}

/// The end at a hole. @param loop  half-edges, as holeLoops() has them. The fields on the piece of
/// surface are left to the caller.
inline LimbEnd limbEnd(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const std::vector<int>& loop)
{
	// In perimeters of a disc with the hole's area. The end of a flat limb, ten times as wide as thick,
	// has 2; a slit where a long triangle is missing along an edge of the surface has more.
	constexpr double likeATube = 0.7, likeASlit = 2;
	constexpr double minAlong = 0.5; // cosine of 60 degrees, see GapReach::aside
	// An ellipse that is ten times as long as wide has a slenderness of 2.04, the ends of torn limbs 0.9
	// to 1.4, slits in bodies 2 to 7. Where no slits cross, the concavity is up to 1.02, and the warp
	// of a limb's end up to 1.1.
	constexpr double slit = 2.1, arms = 1.03, warped = 1.12;
	LimbEnd end;
	for (auto h = loop.rbegin(); h != loop.rend(); ++h) {
		end.corner.push_back(triangles[size_t(*h) / 3][size_t(SurfaceMesh::next(*h)) % 3]);
		end.centre += points[size_t(end.corner.back())];
	}
	end.centre /= double(end.corner.size());
	const Point3d area = areaVector(points, end.corner, end.centre);
	end.radius = std::sqrt(area.Norm() / M_PI);
	// The integral of the outward conormal along the border: its component along a tube's axis is
	// the perimeter, however the tube is cut; around a hole in a flat face it is 0.
	Point3d onwards(0, 0, 0), normals(0, 0, 0);
	for (int h : loop) {
		const Triangle& t = triangles[size_t(h) / 3];
		const Point3d &p = points[size_t(t[size_t(h) % 3])],
					  &q = points[size_t(t[size_t(SurfaceMesh::next(h)) % 3])],
					  &apex =
						  points[size_t(t[size_t(SurfaceMesh::next(SurfaceMesh::next(h))) % 3])];
		const Point3d edge = q - p, normal = edge ^ (apex - p), outOfFace = edge ^ normal;
		if (const double norm = outOfFace.Norm(); norm > 0) {
			onwards += outOfFace * (edge.Norm() / norm);
			normals += normal * (edge.Norm() / normal.Norm());
		}
	}
	end.out = area.Norm() > 0 ? area / area.Norm() : area;
	end.heading = end.out;
	const double perimeter = onwards.Norm(), ofDisc = 2 * M_PI * end.radius;
	const BorderShape shape = borderShape(points, end.corner, area);
	const bool isOnwards = perimeter > likeATube * ofDisc && perimeter < likeASlit * ofDisc;
	end.isIrregular =
		shape.slenderness > slit || shape.concavity > arms || (isOnwards && shape.warp > warped);
	if (end.isIrregular || !isOnwards) {
		end.isPatch = normals * end.out < 0;
		return end;
	}
	end.isCutThrough = true;
	end.radius = perimeter / (2 * M_PI);
	end.heading = onwards / perimeter;
	const Point3d axis = axisBehind(points, triangles, partner, loop, end);
	end.isOfTube = axis * end.heading > minAlong;
	end.heading = axis;
	return end;
}

/// Whether a piece of surface, given alone, has an end where a limb is cut through.
/// @throws Cancelled
inline bool isTornLimb(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const Progress& progress)
{
	const std::vector<std::vector<int>> loops = holeLoops(points, triangles, partner, progress);
	return std::any_of(loops.begin(), loops.end(), [&](const std::vector<int>& loop) {
		const LimbEnd end = limbEnd(points, triangles, partner, loop);
		return end.isCutThrough && end.isOnce();
	});
}

} // namespace vcg::tri::mcf::detail

#endif
