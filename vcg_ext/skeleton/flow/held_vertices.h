// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Vertices that the user holds: they keep their positions while the rest contracts.

#ifndef VCG_MCF_HELD_VERTICES_H
#define VCG_MCF_HELD_VERTICES_H

#include "stage.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Holds vertices of a stage, in addition to those that it holds already: v_i^{t+1} = v_i^t.
 *
 * A held vertex is a fixed one, a known value of the linear system (Sec. 4.4), from the start. A
 * collapse moves its neighbour onto it, never two held vertices onto each other; a split puts a
 * held vertex into a triangle whose corners are all held, so that a held triangle keeps its place
 * too.
 * @param held  1 where a vertex is to be held, one for each vertex.
 * @throws InvalidInput if there are not as many entries as vertices. Complexity: O(V).
 */
inline void holdVertices(Stage& stage, const std::vector<char>& held)
{
	if (held.size() != stage.held.size())
		throw InvalidInput("The selection is of a mesh of another number of vertices.");
	for (size_t v = 0; v < held.size(); ++v)
		if (held[v])
			stage.held[v] = stage.fixed[v] = 1;
}

/**
 * Carries a selection over to a resampled surface: the vertex nearest to each selected one, and all
 * vertices on triangles whose corners are all selected.
 * @param selected  1 where a vertex of `surface` is selected, one for each.
 * @return 1 for such vertices of `resampled`; at least one if any vertex is selected.
 * @pre both are compact. @throws Cancelled
 * Complexity: O((V + R) log (V + R)) for R vertices of `resampled`.
 */
inline std::vector<char> selectionOnResampled(const SurfaceMesh& surface,
	const std::vector<char>& selected, const SurfaceMesh& resampled,
	const Progress& progress = Progress())
{
	const char* const what = "Finding the selected vertices";
	std::vector<char> result(size_t(resampled.vertexSlots()), 0);
	const PointTree tree(resampled.position, progress.part(0, 0.1));
	detail::Ticker nearest(progress.part(0.1, 0.5), what, surface.vertexSlots());
	for (int v = 0; v < surface.vertexSlots(); ++v) {
		nearest.tick();
		if (selected[v])
			result[size_t(tree.nearest(surface.position[v]))] = 1;
	}
	const auto isSelected = [&](int f) {
		const Triangle t = surface.triangle(f);
		return selected[t[0]] && selected[t[1]] && selected[t[2]];
	};
	bool anyTriangle = false;
	for (int f = 0; f < surface.faceSlots() && !anyTriangle; ++f)
		anyTriangle = isSelected(f);
	if (!anyTriangle)
		return result;
	std::vector<int> all(size_t(surface.vertexSlots()));
	std::iota(all.begin(), all.end(), 0);
	constexpr double sampleSpacing = 0.01; // of the diagonal
	const double diagonal = surface.bounds(progress).Diag();
	const ClosestSurface closest(surface, all, sampleSpacing * diagonal, progress.part(0.5, 0.9));
	constexpr int reportEvery = 1 << 12;
	for (int v = 0; v < resampled.vertexSlots(); ++v) {
		if (v % reportEvery == 0)
			progress.report(0.9 + 0.1 * v / resampled.vertexSlots(), what);
		if (!result[size_t(v)])
			result[size_t(v)] = isSelected(closest.closest(resampled.position[v]).face);
	}
	return result;
}

} // namespace vcg::tri::mcf

#endif
