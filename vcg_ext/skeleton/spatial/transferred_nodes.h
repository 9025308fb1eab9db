// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The correspondence of one surface, carried over to another one of the same shape.

#ifndef VCG_MCF_TRANSFERRED_NODES_H
#define VCG_MCF_TRANSFERRED_NODES_H

#include "nearest_points.h"

#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>

#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// Mean edge length, mesh units; 0 for a mesh without edges. Complexity: O(E).
inline double meanEdgeLength(const SurfaceMesh& mesh)
{
	double sum = 0;
	int count = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isEdge(h)) {
			sum += std::sqrt(mesh.squaredLength(h));
			++count;
		}
	return count ? sum / count : 0;
}

/**
 * For each of some places the node that the nearest vertex of a surface has.
 * @param node of each vertex of `from`.
 * @param to   finite.
 * @pre `from` is compact and not empty.
 * @throws Cancelled. Complexity: as nearestPoints().
 */
inline std::vector<int> transferredNodes(const SurfaceMesh& from, const std::vector<int>& node,
	const std::vector<Point3d>& to, const Progress& progress = Progress())
{
	std::vector<int> result = nearestPoints(from.position, to, meanEdgeLength(from), progress);
	for (int& v : result)
		v = node[size_t(v)];
	return result;
}

/// The same for the vertices of another surface, which is compact as well.
inline std::vector<int> transferredNodes(const SurfaceMesh& from, const std::vector<int>& node,
	const SurfaceMesh& to, const Progress& progress = Progress())
{
	return transferredNodes(from, node, to.position, progress);
}

} // namespace vcg::tri::mcf

#endif
