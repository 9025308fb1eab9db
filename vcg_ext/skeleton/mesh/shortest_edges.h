// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The shortest edge at each vertex of a set of triangles.

#ifndef VCG_MCF_SHORTEST_EDGES_H
#define VCG_MCF_SHORTEST_EDGES_H

#include "surface_mesh.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/// The length of the shortest edge at each point, infinite for a point without triangles.
/// @throws Cancelled. Complexity: O(V + F).
inline std::vector<double> shortestEdges(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Cancellation& cancel = Cancellation())
{
	std::vector<double> shortest =
		detail::filledArray(points.size(), std::numeric_limits<double>::infinity(), cancel);
	detail::cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		const Triangle& t = triangles[size_t(f)];
		for (size_t k = 0; k < 3; ++k) {
			const size_t a = size_t(t[k]), b = size_t(t[(k + 1) % 3]);
			const double length = Distance(points[a], points[b]);
			for (const size_t v : {a, b})
				shortest[v] = std::min(shortest[v], length);
		}
	});
	return shortest;
}

} // namespace vcg::tri::mcf

#endif
