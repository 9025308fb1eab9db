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

/// The samples that the long edges of thin parts need, see thinSampling().
struct ThinSampling
{
	/// Of each vertex, mesh units: pieces of edges are no longer.
	std::vector<double> longest;
	/// Vertices of the surface with these samples.
	double vertices = 0;
	/// Whether more than a few edges of the thin parts are long. Of dense meshes below 0.001 are, of
	/// trees in long triangles 0.9, by length.
	bool isAnyLong = false;
};

/**
 * Which samples the long edges of a surface need where it is thin: the local thickness is measured
 * at vertices, and triangles as long as a rod have none along it. Pieces are no longer than
 * longestOfThickness; between the ends of an edge the thickness counts as linear.
 * @param thickness of each vertex, mesh units, infinite where the shape is not thin.
 * @param thick     of each component, mesh units: from this thickness on a vertex is not thin.
 * @throws Cancelled. Complexity: O(E).
 */
inline ThinSampling thinSampling(const MeasuredSurface& surface,
	const std::vector<double>& thickness, const std::vector<double>& thick,
	const Progress& progress = Progress())
{
	constexpr double fewLong = 0.05;
	const SurfaceMesh& mesh = surface.mesh();
	ThinSampling result;
	result.longest.reserve(thickness.size());
	detail::cancellableLoop(int(thickness.size()), progress, [&](int v) {
		result.longest.push_back(
			longestOfThickness * std::min(thickness[v], thick[surface.component()[v]]));
	});
	result.vertices = mesh.vertexCount();
	double thinLength = 0, longLength = 0; // of the edges where the shape is thin
	detail::cancellableLoop(mesh.halfEdgeSlots(), progress, [&](int h) {
		if (!mesh.isEdge(h))
			return;
		const int a = mesh.origin(h), b = mesh.target(h);
		const double length = std::sqrt(mesh.squaredLength(h));
		const double pieces = piecesOfEdge(length, result.longest[a], result.longest[b]);
		if (std::isfinite(std::min(thickness[a], thickness[b]))) {
			thinLength += length;
			longLength += pieces > 1 ? length : 0;
		}
		result.vertices += pieces - 1;
	});
	result.isAnyLong = longLength > fewLong * thinLength;
	return result;
}

/**
 * The surface with long edges cut where it is thin; pieces are up to twice as long as wanted where
 * there would be too many vertices.
 * @param maxVertices of the result.
 * @return a compact mesh whose first vertices are the surface's; nothing if hardly any edge is long,
 *         or if too many vertices would be needed.
 * @throws Cancelled. Complexity: as withCutEdges().
 */
inline std::optional<SurfaceMesh> withThinPartsSampled(const MeasuredSurface& surface,
	ThinSampling sampling, double maxVertices, const Progress& progress = Progress())
{
	constexpr double mostOfLongest = 2;
	const double longer = std::max(1.0, sampling.vertices / maxVertices);
	if (!sampling.isAnyLong || longer > mostOfLongest)
		return std::nullopt;
	for (double& length : sampling.longest)
		length *= longer;
	return withCutEdges(surface, sampling.longest, progress);
}

/// The same with thinSampling(). @throws Cancelled
inline std::optional<SurfaceMesh> withThinPartsSampled(const MeasuredSurface& surface,
	const std::vector<double>& thickness, const std::vector<double>& thick, double maxVertices,
	const Progress& progress = Progress())
{
	return withThinPartsSampled(
		surface, thinSampling(surface, thickness, thick, progress), maxVertices, progress);
}

} // namespace vcg::tri::mcf

#endif
