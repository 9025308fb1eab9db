// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The volume that a closed surface encloses more than once, or inside out.

#ifndef VCG_MCF_OVERLAP_H
#define VCG_MCF_OVERLAP_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Volumes by winding number, mesh units cubed.
struct WindingVolumes
{
	double once = 0;     ///< where it is at least 1
	double repeated = 0; ///< where it is at least 2
	double negative = 0; ///< where it is below 0

	/// (repeated + negative) / (once + negative), in [0, 1]; 0 if nothing is enclosed.
	double wrongPart() const
	{
		const double all = once + negative;
		return all > 0 ? (repeated + negative) / all : 0;
	}
};

/**
 * Integrates the winding number of a closed, oriented surface along rays parallel to z, one for
 * each cell of a grid over the bounding box in x and y: exactly along each ray.
 * @param across  cells along either side of the grid.
 * @throws Cancelled. Complexity: O(F + n log n) for n pairs of a face and a ray through its box.
 */
inline WindingVolumes windingVolumes(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, int across = 128, const Progress& progress = Progress())
{
	const char* const what = "Measuring the volume";
	WindingVolumes volumes;
	Box3d box;
	for (const Triangle& t : triangles)
		for (int v : t)
			box.Add(points[size_t(v)]);
	const double dx = (box.max[0] - box.min[0]) / across, dy = (box.max[1] - box.min[1]) / across;
	if (triangles.empty() || !(dx > 0) || !(dy > 0))
		return volumes;
	// Rays avoid the middle and the sides of cells, where shapes tend to have vertices and edges.
	constexpr double offset = 0.4637;
	std::vector<std::vector<std::pair<double, int>>> crossings(size_t(across) * size_t(across));
	detail::reportedLoop(int(triangles.size()), progress.part(0, 0.8), what, [&](int f) {
		const Triangle& t = triangles[size_t(f)];
		const Point3d &a = points[size_t(t[0])], &b = points[size_t(t[1])],
					  &c = points[size_t(t[2])];
		const Point3d n = (b - a) ^ (c - a);
		if (n[2] == 0)
			return;
		const auto first = [&](double minimum, double low, double step) {
			return std::max(0, int(std::ceil((minimum - low) / step - offset)));
		};
		const auto last = [&](double maximum, double low, double step) {
			return std::min(across - 1, int(std::floor((maximum - low) / step - offset)));
		};
		const int x1 = last(std::max({a[0], b[0], c[0]}), box.min[0], dx);
		const int y0 = first(std::min({a[1], b[1], c[1]}), box.min[1], dy);
		const int y1 = last(std::max({a[1], b[1], c[1]}), box.min[1], dy);
		for (int i = first(std::min({a[0], b[0], c[0]}), box.min[0], dx); i <= x1; ++i)
			for (int j = y0; j <= y1; ++j) {
				const double x = box.min[0] + (i + offset) * dx, y = box.min[1] + (j + offset) * dy;
				// The same for both triangles at an edge: no ray slips through or counts twice.
				const auto isLeft = [&](int v, int w) {
					const Point3d &p = points[size_t(std::min(v, w))],
								  &q = points[size_t(std::max(v, w))];
					const bool left = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) > 0;
					return left == (v < w);
				};
				const bool left = isLeft(t[0], t[1]);
				if (isLeft(t[1], t[2]) != left || isLeft(t[2], t[0]) != left)
					continue;
				const double z = a[2] - (n[0] * (x - a[0]) + n[1] * (y - a[1])) / n[2];
				crossings[size_t(i) * size_t(across) + size_t(j)].emplace_back(
					z, n[2] < 0 ? 1 : -1);
			}
	});
	detail::reportedLoop(int(crossings.size()), progress.part(0.8, 1), what, [&](int i) {
		auto& ray = crossings[size_t(i)];
		std::sort(ray.begin(), ray.end());
		int winding = 0;
		for (size_t k = 0; k + 1 < ray.size(); ++k) {
			winding += ray[k].second;
			const double volume = (ray[k + 1].first - ray[k].first) * dx * dy;
			if (winding >= 1)
				volumes.once += volume;
			if (winding >= 2)
				volumes.repeated += volume;
			if (winding < 0)
				volumes.negative += volume;
		}
	});
	return volumes;
}

} // namespace vcg::tri::mcf

#endif
