// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Input coordinates in single precision, so that all callers start from the same bits.

#ifndef VCG_MCF_SURFACE_ROUNDING_H
#define VCG_MCF_SURFACE_ROUNDING_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

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
	/// @param box bounding box of all vertices of the surface.
	explicit SurfaceRounding(const Box3d& box) : single(fitsSinglePrecision(box)) {}

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

/// The vertices of a surface, rounded by SurfaceRounding. @throws Cancelled. Complexity: O(V).
inline std::vector<Point3d> roundedCoordinates(
	const std::vector<Point3d>& points, const Progress& progress = Progress())
{
	const char* const what = "Reading the surface";
	Box3d box;
	detail::reportedLoop(
		int(points.size()), progress.part(0, 0.3), what, [&](int v) { box.Add(points[v]); });
	const SurfaceRounding toGrid(box);
	std::vector<Point3d> result;
	result.reserve(points.size());
	detail::reportedLoop(int(points.size()), progress.part(0.3, 1), what,
		[&](int v) { result.push_back(toGrid(points[v])); });
	return result;
}

} // namespace vcg::tri::mcf

#endif
