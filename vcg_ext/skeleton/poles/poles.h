// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Medial poles of a surface (Fig. 4, line 2; the map mu of Eq. 6), by either method.

#ifndef VCG_MCF_POLES_H
#define VCG_MCF_POLES_H

#include "pole_set.h"
#include "shrinking_balls.h"
#include "voronoi_poles.h"

#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/principal_frame.h>
#include <skeleton/mesh/surface_mesh.h>

#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

/**
 * How deep a vertex may lie inside another vertex's ball, fraction of its component's diagonal: a
 * tenth of the default epsilon.
 *
 * A tube that was modelled coarsely and resampled finely has flat facets. Without a tolerance, the
 * vertices of a facet bound each other's balls: their poles lie just below the surface and exert no
 * inward pull, so the curve drifts off the axis. The facets of a tube of radius R with n sides lie
 * up to (1 - cos(pi / n)) R inside it.
 */
constexpr double poleTolerance = 2e-4;

namespace detail {

/**
 * The poles of some vertices of one component, searched in its canonical frame: of several equally
 * good balls, the one that is found depends on the order of the searches, and that on the
 * coordinates. Coordinates are rounded to the frame's grid, as in a step of the flow.
 */
inline PoleSet polesOfComponent(const SurfaceMesh& mesh, const PrincipalFrame& frame,
	const std::vector<int>& vertices, PoleMethod method, const Progress& progress)
{
	SurfaceMesh own = mesh.copied(progress);
	reportedLoop(own.vertexSlots(), progress.part(0, 0.01), "Measuring the surface",
		[&](int v) { own.position[v] = frame.onGrid(own.position[v]); });
	if (frame.isMirrored())
		own.turnOver([](int) { return true; }, progress);
	const Progress ofSearch = progress.part(0.01, 1);
	PoleSet poles;
	if (method == PoleMethod::Balls)
		poles = shrinkingBallPoles(
			own, vertices, poleTolerance * frame.lengthOnGrid(frame.size()), ofSearch);
	else {
		const PoleSet all = voronoiPoles(own, ofSearch);
		for (int v : vertices) {
			poles.centre.push_back(all.centre[v]);
			poles.radius.push_back(all.radius[v]);
		}
	}
	cancellableLoop(int(vertices.size()), progress, [&](int i) {
		Point3d& centre = poles.centre[i];
		centre = frame.out(PrincipalFrame::rounded(centre));
		if (poles.has(i))
			poles.radius[i] = Distance(centre, mesh.position[vertices[i]]);
	});
	return poles;
}

} // namespace detail

/**
 * medialPoles() of some vertices, against all vertices of their component; in the order of
 * `vertices`. Shrinking balls are searched for these vertices only; the Voronoi diagram is always
 * that of all.
 * @pre the surface is compact. @throws SolverError, Cancelled.
 */
inline PoleSet polesAt(const MeasuredSurface& surface, const std::vector<int>& vertices,
	PoleMethod method, const Progress& whole = Progress())
{
	const SurfaceMesh& mesh = surface.mesh();
	const std::vector<PrincipalFrame>& frames = *surface.vertexFrames(whole.part(0, 0.02));
	const Progress progress = whole.part(0.02, 1);
	if (frames.size() == 1)
		return detail::polesOfComponent(mesh, frames.front(), vertices, method, progress);
	const Progress begin = progress.cancelOnly();
	const char* const what = "Measuring the surface";
	const int count = int(vertices.size());
	std::vector<int> wanted = detail::filledArray(size_t(mesh.vertexSlots()), -1, begin);
	detail::reportedLoop(count, begin, what, [&](int i) { wanted[vertices[i]] = i; });
	PoleSet poles;
	poles.centre = detail::filledArray(vertices.size(), Point3d(0, 0, 0), begin);
	poles.radius = detail::filledArray(vertices.size(), -1.0, begin);
	forEachComponent(mesh, surface.component(), surface.components(), progress,
		[&](int c, const SurfaceMesh& own, const std::vector<int>& ids, const Progress& part) {
			std::vector<int> ofThese;
			detail::cancellableLoop(int(ids.size()), part, [&](int i) {
				if (wanted[ids[i]] >= 0)
					ofThese.push_back(i);
			});
			if (ofThese.empty())
				return;
			const PoleSet found = detail::polesOfComponent(own, frames[c], ofThese, method, part);
			detail::cancellableLoop(int(ofThese.size()), part, [&](int k) {
				const int i = wanted[ids[ofThese[k]]];
				poles.centre[i] = found.centre[k];
				poles.radius[i] = found.radius[k];
			});
		});
	return poles;
}

/**
 * The inner medial pole of each vertex: the centre of a large ball inside the shape that touches
 * the surface at the vertex. Every pole lies inside the shape; a vertex without one has radius -1.
 * Each component is a solid of its own, as if the others were not there: they may lie within each
 * other, or cross.
 * @pre the surface is compact.
 * @throws SolverError, Cancelled.
 */
inline PoleSet medialPoles(
	const MeasuredSurface& surface, PoleMethod method, const Progress& progress = Progress())
{
	std::vector<int> all(surface.mesh().vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	return polesAt(surface, all, method, progress);
}

} // namespace vcg::tri::mcf

#endif
