// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file How finely a surface is resampled when the user does not say.

#ifndef VCG_MCF_TARGET_LENGTH_H
#define VCG_MCF_TARGET_LENGTH_H

#include "measured_surface.h"
#include "parameters.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The edge length to resample each component with, mesh units.
 *
 * An even mesh of V vertices has 2 V nearly equilateral triangles, so that a surface of area A gets
 * V = A / (L^2 sqrt(3) / 2) vertices. The default L gives a single component 45000 vertices, the
 * size of the models of the paper (Table 1); c components share them, but none gets fewer than
 * 3000. It is at most 8 epsilon, beyond which the flow leaves the shape.
 *
 * @param surface    closed triangle mesh of any number of components.
 * @param parameters targetLength > 0 is taken instead, as a fraction of each component's own
 *                   bounding box diagonal.
 * @return one length for each component, in the order of connectedComponents().
 * Complexity: O(c), and O(V) for the bounding boxes.
 */
inline std::vector<double> defaultTargetLength(
	const MeasuredSurface& surface, const Parameters& parameters = Parameters())
{
	constexpr double totalVertices = 45000, fewestVertices = 3000;
	const double areaOfVertex = std::sqrt(3.0) / 2; // for edges of length 1
	const int count = surface.components();
	std::vector<double> length(count);
	if (parameters.targetLength > 0) {
		std::vector<Box3d> box(count);
		for (int v = 0; v < surface.mesh().vertexSlots(); ++v)
			if (surface.mesh().isVertex(v))
				box[surface.component()[v]].Add(surface.mesh().position[v]);
		for (int c = 0; c < count; ++c)
			length[c] = parameters.targetLength * box[c].Diag();
		return length;
	}
	const double vertices = std::max(fewestVertices, totalVertices / std::max(count, 1));
	for (int c = 0; c < count; ++c)
		length[c] = std::min(std::sqrt(surface.area(c) / (areaOfVertex * vertices)),
			8 * parameters.epsilon * surface.diagonal(c));
	return length;
}

} // namespace vcg::tri::mcf

#endif
