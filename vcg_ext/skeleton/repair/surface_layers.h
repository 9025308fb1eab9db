// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Where a surface is there more than once: scans that overlap, walls between bodies that touch.

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
 * How much triangles count in a winding number that takes what several layers stand for as one surface: one over the
 * layers that face the same way, with none between that faces the other way, averaged over three points of each.
 * @param open   for each triangle of `tree` whether it is of a piece with borders: closed ones count as they are.
 * @param reach  layers are no farther apart, mesh units.
 * @return empty if no triangle is one of several layers.
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
					double before = 2, after = 2; // the nearest that face the other way
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
