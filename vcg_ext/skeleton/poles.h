// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Medial poles of a surface (Fig. 4, line 2; the map mu of Eq. 6), by either method.

#ifndef VCG_MCF_POLES_H
#define VCG_MCF_POLES_H

#include "check_input.h"
#include "parameters.h"
#include "pole_set.h"
#include "principal_frame.h"
#include "progress.h"
#include "shrinking_balls.h"
#include "surface_mesh.h"
#include "ticker.h"
#include "voronoi_poles.h"

#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

/**
 * How deep a vertex may lie inside the ball of another one, of the diagonal of its component: a tenth of
 * the default epsilon.
 *
 * The facets of a tube that was modelled coarsely and resampled finely are flat, and so would bound the
 * balls of the vertices on them near the surface: those poles draw their vertices nowhere, and the curve
 * drifts off the axis. What the facets of a tube of radius R with n sides lie within the tube is
 * (1 - cos(pi / n)) R.
 */
constexpr double poleTolerance = 2e-4;

namespace detail {

/**
 * Poles found in the shape's own coordinates: where several balls are as good, which one is found
 * depends on the order of the searches, and that on the coordinates. They are rounded, as contract()
 * does it.
 * @param component of each vertex, and `frames` of the vertices of each component.
 * @param find makes the poles of `vertices` of a mesh, given how deep a vertex may lie in the ball of each,
 *             with a progress window of its own.
 */
template <class Find>
PoleSet polesInShapeFrame(const SurfaceMesh& mesh, const std::vector<int>& component,
	const std::vector<PrincipalFrame>& frames, const std::vector<int>& vertices,
	const Progress& progress, Find&& find)
{
	// Components may lie within each other: they have one frame for all, as fine as it needs to be.
	const bool single = frames.size() == 1;
	const PrincipalFrame frame = single
		? frames.front()
		: PrincipalFrame::ofPoints(
			mesh.position, std::vector<int>(component.size(), 0), 1, progress.part(0, 0))
			  .front();
	SurfaceMesh own = mesh.copied(progress.part(0, 0));
	reportedLoop(own.vertexSlots(), progress.part(0, 0.01), "Measuring the surface", [&](int v) {
		Point3d& p = own.position[v];
		p = single ? frame.onGrid(p) : frame.in(p);
	});
	std::vector<double> delta;
	delta.reserve(vertices.size());
	const int count = int(vertices.size());
	reportedLoop(count, progress.part(0.01, 0.01), "Measuring the surface", [&](int i) {
		const PrincipalFrame& ofComponent = frames[component[vertices[i]]];
		delta.push_back(poleTolerance * frame.lengthOnGrid(ofComponent.size()));
	});
	PoleSet poles = find(own, delta, progress.part(0.01, 1));
	reportedLoop(count, progress.part(1, 1), "Measuring the surface", [&](int i) {
		Point3d& centre = poles.centre[i];
		centre = single ? frame.out(PrincipalFrame::rounded(centre))
						: frames[component[vertices[i]]].snapped(frame.out(centre));
		if (poles.has(i))
			poles.radius[i] = Distance(centre, mesh.position[vertices[i]]);
	});
	return poles;
}

} // namespace detail

/**
 * medialPoles() of some vertices: against all vertices of the mesh, in the order of `vertices`.
 * Shrinking balls are searched for these vertices only; the Voronoi diagram is always that of all.
 * @param component of each vertex of the mesh, see connectedComponents().
 * @param frames    of the vertices of each component, see PrincipalFrame::ofPoints().
 */
inline PoleSet polesAt(const SurfaceMesh& mesh, const std::vector<int>& component,
	const std::vector<PrincipalFrame>& frames, const std::vector<int>& vertices, PoleMethod method,
	const Progress& progress = Progress())
{
	const auto find = [&](const SurfaceMesh& own, const std::vector<double>& delta,
						  const Progress& ofSearch) {
		if (method == PoleMethod::Balls)
			return shrinkingBallPoles(own, vertices, delta, ofSearch);
		const PoleSet all = voronoiPoles(own, ofSearch);
		PoleSet poles;
		for (int v : vertices) {
			poles.centre.push_back(all.centre[v]);
			poles.radius.push_back(all.radius[v]);
		}
		return poles;
	};
	return detail::polesInShapeFrame(mesh, component, frames, vertices, progress, find);
}

/// The same where components and frames are not known yet.
inline PoleSet polesAt(const SurfaceMesh& mesh, const std::vector<int>& vertices, PoleMethod method,
	const Progress& progress = Progress())
{
	int components = 0;
	const std::vector<int> component =
		connectedComponents(mesh, &components, progress.part(0, 0.02));
	const std::vector<PrincipalFrame> frames = PrincipalFrame::ofPoints(
		mesh.position, component, size_t(components), progress.part(0.02, 0.04));
	return polesAt(mesh, component, frames, vertices, method, progress.part(0.04, 1));
}

/**
 * The inner medial pole of each vertex: the centre of a large ball inside the shape that touches
 * the surface at the vertex. Every pole lies inside the shape; a vertex without one has radius -1.
 * @pre mesh is compact.
 * @throws SolverError, Cancelled.
 */
inline PoleSet medialPoles(
	const SurfaceMesh& mesh, PoleMethod method, const Progress& progress = Progress())
{
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	return polesAt(mesh, all, method, progress);
}

} // namespace vcg::tri::mcf

#endif
