// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Coordinates in which a shape is about as large as 1 and stands at the origin.

#ifndef VCG_MCF_UNIT_FRAME_H
#define VCG_MCF_UNIT_FRAME_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Maps a bounding box to one around the origin with a diagonal in [1, 2).
 *
 * Squares and determinants keep their digits there, however far away and however large or small the
 * shape is. The scale is a power of two, so that it costs no digit itself.
 */
class UnitFrame
{
public:
	/// @pre the points are finite. @throws Cancelled
	explicit UnitFrame(const std::vector<Point3d>& points, const Progress& progress = Progress())
	{
		Box3d box;
		detail::reportedLoop(int(points.size()), progress, "Measuring the surface",
			[&](int i) { box.Add(points[i]); });
		if (!points.empty())
			origin = box.Center();
		const double diagonal = points.empty() ? 0 : box.Diag();
		if (diagonal > 0)
			exponent = std::ilogb(diagonal);
		unitDiagonal = std::ldexp(diagonal, -exponent);
		scaleIn = lengthIn(1);
		scaleOut = lengthOut(1);
	}

	/// The diagonal of the points in this frame: in [1, 2), or 0 if they coincide.
	double diagonal() const { return unitDiagonal; }

	double lengthIn(double length) const { return std::ldexp(length, -exponent); }
	double lengthOut(double length) const { return std::ldexp(length, exponent); }
	Point3d in(const Point3d& p) const { return (p - origin) * scaleIn; }
	Point3d out(const Point3d& p) const { return p * scaleOut + origin; }

	/// @throws Cancelled
	std::vector<Point3d> in(
		const std::vector<Point3d>& points, const Progress& progress = Progress()) const
	{
		std::vector<Point3d> moved;
		moved.reserve(points.size());
		detail::reportedLoop(int(points.size()), progress, "Measuring the surface",
			[&](int i) { moved.push_back(in(points[i])); });
		return moved;
	}

private:
	Point3d origin = Point3d(0, 0, 0);
	int exponent = 0;
	double unitDiagonal;
	double scaleIn, scaleOut;
};

} // namespace vcg::tri::mcf

#endif
