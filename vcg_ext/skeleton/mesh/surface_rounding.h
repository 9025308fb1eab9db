// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Input coordinates in single precision, so that all callers start from the same bits.

#ifndef VCG_MCF_SURFACE_ROUNDING_H
#define VCG_MCF_SURFACE_ROUNDING_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The bounding box of the finite corners of faces; null if there are none. Vertices of no face may
/// be anywhere. @throws Cancelled
inline Box3d boundsOfFaces(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Cancellation& cancel)
{
	Box3d box;
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		for (int v : triangles[size_t(f)])
			if (v >= 0 && size_t(v) < points.size() && isFinitePlace(points[size_t(v)]))
				box.Add(points[size_t(v)]);
	});
	return box;
}

inline double toSingle(double x)
{
	// Volatile: where GCC 12 vectorises, it drops a conversion to float and back.
	volatile float single = float(x);
	return single;
}

} // namespace detail

/**
 * Rounds the coordinates of a surface to single precision, where that resolves a millionth of its
 * diagonal: where it is not far from the origin, nor larger or smaller than single precision
 * reaches. Elsewhere they stay as they are.
 *
 * The steps of the contraction amplify the smallest difference. Rounded, a mesh gives the same
 * graph whether it was stored in float or in double.
 */
class SurfaceRounding
{
public:
	/// @param box bounding box of the surface.
	explicit SurfaceRounding(const Box3d& box) : single(fitsSinglePrecision(box)) {}

	/// @throws Cancelled. Complexity: O(F).
	SurfaceRounding(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const Cancellation& cancel = Cancellation()) :
			SurfaceRounding(detail::boundsOfFaces(points, triangles, cancel))
	{
	}

	Point3d operator()(const Point3d& p) const
	{
		return single
			? Point3d(detail::toSingle(p[0]), detail::toSingle(p[1]), detail::toSingle(p[2]))
			: p;
	}

private:
	bool single;

	static bool fitsSinglePrecision(const Box3d& box)
	{
		using Float = std::numeric_limits<float>;
		double reach = 0;
		for (int k = 0; k < 3; ++k)
			reach = std::max({reach, std::abs(box.min[k]), std::abs(box.max[k])});
		const double step = std::max(reach * Float::epsilon(), double(Float::denorm_min()));
		return reach <= Float::max() && step <= 1e-6 * box.Diag();
	}
};

/// The vertices of a surface, rounded by SurfaceRounding. @throws Cancelled. Complexity: O(V + F).
inline std::vector<Point3d> roundedCoordinates(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Progress& progress = Progress())
{
	const SurfaceRounding toGrid(points, triangles, progress);
	std::vector<Point3d> result;
	result.reserve(points.size());
	detail::reportedLoop(int(points.size()), progress, "Reading the surface",
		[&](int v) { result.push_back(toGrid(points[v])); });
	return result;
}

} // namespace vcg::tri::mcf

#endif
