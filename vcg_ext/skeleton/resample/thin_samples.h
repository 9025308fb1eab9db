// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Thin parts in long triangles get samples along them, which show how thin they are.

#ifndef VCG_MCF_THIN_SAMPLES_H
#define VCG_MCF_THIN_SAMPLES_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/cut_edges.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace vcg::tri::mcf {

/// Edges longer than this many local thicknesses hide how thin the shape is between their ends.
constexpr double longestOfThickness = 3;

/**
 * The surface with long edges cut where it is thin: the local thickness is measured at vertices,
 * and triangles as long as a rod have none along it. Pieces are no longer than longestOfThickness,
 * or up to twice that where it takes too many vertices; between the ends of an edge the thickness
 * counts as linear.
 *
 * @param thickness   of each vertex, mesh units, infinite where the shape is not thin.
 * @param thick       of each component, mesh units: from this thickness on a vertex is not thin.
 * @param maxVertices of the result.
 * @return a compact mesh whose first vertices are the surface's; nothing if hardly any edge is that
 *         long, or if too many vertices would be needed.
 * @throws Cancelled. Complexity: as withCutEdges().
 */
inline std::optional<SurfaceMesh> withThinPartsSampled(const MeasuredSurface& surface,
	const std::vector<double>& thickness, const std::vector<double>& thick, double maxVertices,
	const Progress& progress = Progress())
{
	constexpr const char* const what = "Measuring the local thickness";
	constexpr double mostOfLongest = 2;
	constexpr double fewLong = 0.05; // dense meshes have below 0.001, trees in long triangles 0.9
	const SurfaceMesh& mesh = surface.mesh();
	std::vector<double> longest;
	longest.reserve(thickness.size());
	detail::reportedLoop(int(thickness.size()), progress.cancelOnly(), what, [&](int v) {
		longest.push_back(
			longestOfThickness * std::min(thickness[v], thick[surface.component()[v]]));
	});
	double needed = mesh.vertexCount();
	double thinLength = 0, longLength = 0; // of the edges where the shape is thin
	detail::reportedLoop(mesh.halfEdgeSlots(), progress.cancelOnly(), what, [&](int h) {
		if (!mesh.isEdge(h))
			return;
		const int a = mesh.origin(h), b = mesh.target(h);
		const double length = std::sqrt(mesh.squaredLength(h));
		const double pieces = piecesOfEdge(length, longest[a], longest[b]);
		if (std::isfinite(std::min(thickness[a], thickness[b]))) {
			thinLength += length;
			longLength += pieces > 1 ? length : 0;
		}
		needed += pieces - 1;
	});
	const double longer = std::max(1.0, needed / maxVertices);
	if (longLength <= fewLong * thinLength || longer > mostOfLongest)
		return std::nullopt;
	for (double& length : longest)
		length *= longer;
	return withCutEdges(surface, longest, progress);
}

} // namespace vcg::tri::mcf

#endif
