// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Medial poles of a surface (Fig. 4, line 2; the map mu of Eq. 6), by either method.

#ifndef VCG_MCF_POLES_H
#define VCG_MCF_POLES_H

#include "parameters.h"
#include "pole_set.h"
#include "progress.h"
#include "shrinking_balls.h"
#include "surface_mesh.h"
#include "voronoi_poles.h"

#include <vector>

namespace vcg::tri::mcf {

/**
 * The inner medial pole of each vertex: the centre of a large ball inside the shape that touches
 * the surface at the vertex. Every pole lies inside the shape; a vertex without one has radius -1.
 * @pre mesh is compact.
 * @throws SolverError, Cancelled.
 */
inline PoleSet medialPoles(
	const SurfaceMesh& mesh, PoleMethod method, const Progress& progress = Progress())
{
	return method == PoleMethod::Voronoi ? voronoiPoles(mesh, progress)
										 : shrinkingBallPoles(mesh, progress);
}

/**
 * medialPoles() of some vertices: against all vertices of the mesh, in the order of `vertices`.
 * Shrinking balls are searched for these vertices only; the Voronoi diagram is always that of all.
 */
inline PoleSet polesAt(const SurfaceMesh& mesh, const std::vector<int>& vertices, PoleMethod method,
	const Progress& progress = Progress())
{
	if (method == PoleMethod::Balls)
		return shrinkingBallPoles(mesh, vertices, 0, progress);
	const PoleSet all = voronoiPoles(mesh, progress);
	PoleSet poles;
	for (int v : vertices) {
		poles.centre.push_back(all.centre[v]);
		poles.radius.push_back(all.radius[v]);
	}
	return poles;
}

} // namespace vcg::tri::mcf

#endif
