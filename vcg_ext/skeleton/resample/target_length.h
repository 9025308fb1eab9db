// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How finely a surface is resampled when the user does not say.

#ifndef VCG_MCF_TARGET_LENGTH_H
#define VCG_MCF_TARGET_LENGTH_H

#include <skeleton/mesh/measured_surface.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * About how many cuts bring all edges of each component down to L: the vertices that resample() may
 * make for a while where triangles are narrower than L, which their area does not show.
 * @param length L of each component, mesh units, > 0. @throws Cancelled. Complexity: O(F).
 */
inline std::vector<double> cutsOfLongEdges(const MeasuredSurface& surface,
	const std::vector<double>& length, const Cancellation& cancel = Cancellation())
{
	const SurfaceMesh& mesh = surface.mesh();
	std::vector<double> cuts(length.size(), 0);
	detail::cancellableLoop(mesh.halfEdgeSlots(), cancel, [&](int h) {
		if (!mesh.isEdge(h))
			return;
		const size_t c = size_t(surface.component()[mesh.origin(h)]);
		if (const double squared = mesh.squaredLength(h); squared > length[c] * length[c])
			cuts[c] += std::sqrt(squared) / length[c];
	});
	return cuts;
}

/**
 * The edge length to resample each component with, mesh units.
 *
 * An even mesh of V vertices has 2 V nearly equilateral triangles, so that a surface of area A gets
 * V = A / (L^2 sqrt(3) / 2) vertices.
 * The default L gives a single component 45000 vertices, the size of the models of the paper
 * (Table 1); c components share them, but none gets fewer than 3000, or than 200000 / c where there
 * are many. L is at most 8 epsilon, beyond which the flow leaves the shape, and at least a
 * twentieth of epsilon: of a wire much thinner than epsilon the flow sees no more. Where edges
 * would still be cut more than two million times in all (see cutsOfLongEdges()), it is longer.
 *
 * @param surface    closed triangle mesh of any number of components.
 * @param parameters targetLength > 0 is taken instead, as a fraction of the diagonal of each
 *                   component's axis-aligned bounding box.
 * @return one length for each component, in the order of connectedComponents().
 * @throws Cancelled. Complexity: O(V + F).
 */
inline std::vector<double> defaultTargetLength(const MeasuredSurface& surface,
	const Parameters& parameters = Parameters(), const Cancellation& cancel = Cancellation())
{
	constexpr double totalVertices = 45000, fewestVertices = 3000, maxVertices = 200000;
	constexpr double maxCuts = 2e6;
	constexpr double shortestOfEpsilon = 0.05;
	const double areaOfVertex = std::sqrt(3.0) / 2; // for edges of length 1
	const int count = surface.components();
	std::vector<double> length(count);
	if (parameters.targetLength > 0) {
		std::vector<Box3d> box(count);
		detail::cancellableLoop(surface.mesh().vertexSlots(), cancel, [&](int v) {
			if (surface.mesh().isVertex(v))
				box[surface.component()[v]].Add(surface.mesh().position[v]);
		});
		for (int c = 0; c < count; ++c)
			length[c] = parameters.targetLength * box[c].Diag();
		return length;
	}
	const double parts = std::max(count, 1);
	const double vertices =
		std::max(std::min(fewestVertices, maxVertices / parts), totalVertices / parts);
	for (int c = 0; c < count; ++c) {
		const double epsilon = parameters.epsilon * surface.diagonal(c);
		length[c] = std::clamp(std::sqrt(surface.area(c) / (areaOfVertex * vertices)),
			shortestOfEpsilon * epsilon, 8 * epsilon);
	}
	const std::vector<double> cuts = cutsOfLongEdges(surface, length, cancel);
	// The components with the most cuts share what the others leave.
	std::vector<double> ascending = cuts;
	std::sort(ascending.begin(), ascending.end());
	double left = maxCuts, most = maxCuts;
	for (size_t i = 0; i < ascending.size(); ++i) {
		most = left / double(ascending.size() - i);
		if (ascending[i] > most)
			break;
		left -= ascending[i];
	}
	for (int c = 0; c < count; ++c)
		length[c] *= std::max(1.0, cuts[c] / most);
	return length;
}

} // namespace vcg::tri::mcf

#endif
