// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Coarsening of a dense surface to a wanted edge length, with a subset of its vertices.

#ifndef VCG_MCF_PROGRESSIVE_COARSENING_H
#define VCG_MCF_PROGRESSIVE_COARSENING_H

#include "triangle_quality.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * One stage: merges origin(h) into target(h) wherever the edge is shorter than `fraction` of the
 * smaller lengthAt() of its ends and shape and topology allow it, in the order of the half-edges.
 * @param allowed  bool(h): whether origin(h) may be merged into target(h).
 * @param collapse void(h): does it.
 */
template <class Shortest, class Allowed, class Collapse>
void coarseningPass(SurfaceMesh& mesh, double fraction, Shortest&& lengthAt, Allowed&& allowed,
	Collapse&& collapse, const Progress& progress, const char* what)
{
	constexpr int reportEvery = 1 << 16;
	constexpr double longestOfStage = 4.0 / 3 / 0.8;
	const int count = mesh.halfEdgeSlots();
	for (int h = 0; h < count; ++h) {
		if (h % reportEvery == 0)
			progress.report(double(h) / count, what);
		if (!mesh.isHalfEdge(h))
			continue;
		const double shortest =
			fraction * std::min(lengthAt(mesh.origin(h)), lengthAt(mesh.target(h)));
		if (mesh.squaredLength(h) >= shortest * shortest || !allowed(h))
			continue;
		const double longest = longestOfStage * shortest;
		if (ringAllowsMove(
				mesh, mesh.origin(h), mesh.position[mesh.target(h)], h, longest * longest)
			&& mesh.isCollapsible(h))
			collapse(h);
	}
}

/**
 * All stages: a stage merges edges up to a length a third of an octave above that of the stage
 * before, so that the mesh stays even on the way; in one pass it would not.
 */
template <class LengthAt, class Allowed, class Collapse>
void coarsenInStages(SurfaceMesh& mesh, LengthAt&& lengthAt, Allowed&& allowed, Collapse&& collapse,
	const Progress& progress, const char* what)
{
	const double step = std::cbrt(2.0);
	// The first stage lies a little above the typical edge, estimated from some of the edges.
	const int stride = 3 * (1 + mesh.faceSlots() / (1 << 16)) + 1;
	double logarithms = 0;
	int edges = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); h += stride) {
		if (!mesh.isHalfEdge(h))
			continue;
		const double relative = std::sqrt(mesh.squaredLength(h)) / lengthAt(mesh.origin(h));
		logarithms += std::log(std::max(relative, 1e-6));
		++edges;
	}
	const double typical = edges ? std::exp(logarithms / edges) : 1;
	const int stages = std::clamp(int(std::ceil(-std::log(typical) / std::log(step))) + 1, 1, 30);
	for (int stage = 0; stage < stages; ++stage)
		coarseningPass(mesh, std::pow(step, stage + 1 - stages), lengthAt, allowed, collapse,
			progress.part(double(stage) / stages, double(stage + 1) / stages), what);
}

} // namespace detail

/**
 * Merges edges shorter than a length: the vertices that remain are a subset of those of the input,
 * where they were, and the topology is the same.
 *
 * An edge is merged into one of its ends if the link condition holds, no triangle turns by more
 * than 70 degrees, and no edge longer than about 1.7 lengths appears. That is why a quarter of the
 * edges that remain are still shorter, few by more than half. It is done in stages of growing
 * length, which keeps the triangles well shaped.
 *
 * @param mesh      becomes coarser in place; its numbering keeps holes, see SurfaceMesh::compact().
 * @param lengthAt  double(vertex): the length below which edges are merged, mesh units.
 * @return for each vertex slot the vertex that it was merged into, itself if it remained.
 * @throws Cancelled
 * Complexity: O(V + F), the collapses dominate.
 */
template <class LengthAt>
std::vector<int> coarsen(
	SurfaceMesh& mesh, LengthAt&& lengthAt, const Progress& progress = Progress())
{
	std::vector<int> mergedInto(mesh.vertexSlots());
	std::iota(mergedInto.begin(), mergedInto.end(), 0);
	const auto collapse = [&](int h) {
		mergedInto[mesh.origin(h)] = mesh.target(h);
		mesh.collapse(h);
	};
	detail::coarsenInStages(
		mesh, lengthAt, [](int) { return true; }, collapse, progress.part(0, 0.95), "Coarsening");
	detail::reportedLoop(int(mergedInto.size()), progress.part(0.95, 1), "Coarsening", [&](int v) {
		int survivor = v;
		while (mergedInto[survivor] != survivor)
			survivor = mergedInto[survivor];
		for (int w = v; w != survivor;) {
			const int onward = mergedInto[w];
			mergedInto[w] = survivor;
			w = onward;
		}
	});
	return mergedInto;
}

} // namespace vcg::tri::mcf

#endif
