// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Weights that count the layers of an open surface as one, as where scans overlap.

#ifndef VCG_MCF_SURFACE_LAYERS_H
#define VCG_MCF_SURFACE_LAYERS_H

#include "winding_number.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Weights of triangles for a winding number that counts several layers as one surface: 1 / n where
 * n layers face the same way, with none between them that faces the other way; the mean over three
 * points of each triangle.
 * @param open   for each triangle of `tree` whether its piece has a border; the others count as 1.
 * @param reach  largest distance of a layer from the triangle, mesh units.
 * @return empty if no triangle has other layers.
 * @throws Cancelled. Complexity: about O(F log F).
 */
inline std::vector<double> layerWeights(const TriangleTree& tree, const std::vector<char>& open,
	double reach, const Progress& progress = Progress())
{
	static constexpr double places[3][3] = {
		{0.6, 0.25, 0.15}, {0.15, 0.6, 0.25}, {0.25, 0.15, 0.6}};
	std::vector<double> weights(open.size(), 1);
	forEachBlock(
		tree.size(), progress, "Looking for surfaces that overlap", [&](int begin, int end) {
			std::vector<std::pair<double, bool>> crossings;
			for (int f = begin; f < end; ++f) {
				const Point3d &a = tree.corner(f, 0), &b = tree.corner(f, 1),
							  &c = tree.corner(f, 2);
				const Point3d normal = (b - a) ^ (c - a);
				if (!open[size_t(f)] || !(normal.Norm() > 0))
					continue;
				const Point3d step = normal * (reach / normal.Norm());
				double sum = 0;
				for (const auto& at : places) {
					const Point3d p = a * at[0] + b * at[1] + c * at[2];
					crossings.clear();
					tree.forEachCrossing(
						p - step, p + step, [&](int g, double t, bool alongNormal) {
							if (g != f && open[size_t(g)])
								crossings.emplace_back(2 * t - 1, alongNormal);
						});
					double before = 2, after = 2; // nearest facing the other way; in reaches
					for (const auto& [t, along] : crossings)
						if (!along)
							(t < 0 ? before : after) =
								std::min(t < 0 ? before : after, std::abs(t));
					int layers = 1;
					for (const auto& [t, along] : crossings)
						layers += along && std::abs(t) < (t < 0 ? before : after);
					sum += 1.0 / layers;
				}
				weights[size_t(f)] = sum / 3;
			}
		});
	if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 1; }))
		weights.clear();
	return weights;
}

} // namespace vcg::tri::mcf

#endif
