// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Volume and area of each component of a surface, accurate for needles.

#ifndef VCG_MCF_VOLUME_AND_AREA_H
#define VCG_MCF_VOLUME_AND_AREA_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Signed volume, negative where the surface is inside out, and area.
struct VolumeAndArea
{
	double volume = 0, area = 0;
};

/**
 * Volume and area of each component, in coordinates along its length: from the vertex that is
 * farthest from its first one to the one farthest from that. So the width of a needle is not lost
 * in the rounding of its length. @throws Cancelled. Complexity: O(V + F).
 */
inline std::vector<VolumeAndArea> measuredAlongLength(const SurfaceMesh& mesh,
	const std::vector<int>& component, int components, const Progress& progress)
{
	const char* const what = "Measuring the surface";
	const auto farthest = [&](std::vector<int> from, const Progress& part) {
		std::vector<int> found = from;
		std::vector<double> distance(from.size(), 0);
		reportedLoop(mesh.vertexSlots(), part, what, [&](int v) {
			if (!mesh.isVertex(v))
				return;
			const int c = component[v];
			if (from[c] < 0)
				found[c] = from[c] = v;
			const double d = SquaredDistance(mesh.position[v], mesh.position[from[c]]);
			if (d > distance[c]) {
				distance[c] = d;
				found[c] = v;
			}
		});
		return found;
	};
	const std::vector<int> start =
		farthest(std::vector<int>(size_t(components), -1), progress.part(0, 0.2));
	const std::vector<int> end = farthest(start, progress.part(0.2, 0.4));
	std::vector<std::array<Point3d, 3>> axes;
	for (int c = 0; c < components; ++c) {
		Point3d along = mesh.position[end[c]] - mesh.position[start[c]];
		const double length = along.Norm();
		along = length > 0 ? along / length : Point3d(1, 0, 0);
		int minimum = 0; // coordinate
		for (int k = 1; k < 3; ++k)
			if (std::abs(along[k]) < std::abs(along[minimum]))
				minimum = k;
		Point3d e(0, 0, 0);
		e[minimum] = 1;
		const Point3d across = (along ^ e) / (along ^ e).Norm();
		axes.push_back({along, across, along ^ across});
	}
	std::vector<VolumeAndArea> measured(static_cast<size_t>(components));
	reportedLoop(mesh.faceSlots(), progress.part(0.4, 1), what, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const Triangle t = mesh.triangle(f);
		const int c = component[t[0]];
		const auto placed = [&](int v) {
			const Point3d p = mesh.position[v] - mesh.position[start[c]];
			return Point3d(axes[c][0] * p, axes[c][1] * p, axes[c][2] * p);
		};
		const Point3d p = placed(t[0]);
		const Point3d n = (placed(t[1]) - p) ^ (placed(t[2]) - p);
		measured[c].area += n.Norm() / 2;
		measured[c].volume += p * n / 6;
	});
	return measured;
}

} // namespace detail

} // namespace vcg::tri::mcf

#endif
