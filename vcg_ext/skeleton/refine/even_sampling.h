// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the nodes: branches sampled evenly, or by the local thickness, without leaving the surface.

#ifndef VCG_MCF_EVEN_SAMPLING_H
#define VCG_MCF_EVEN_SAMPLING_H

#include "ball_chain.h"
#include "local_scale.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * Samples each branch evenly, about `spacing` apart, less where the scale is smaller. Junctions and
 * tips keep their places; what had merged into a node goes to the one nearest along the branch.
 * Where a chord would leave the surface, the branch keeps its nodes, but for loops, see
 * withoutLoops(), and crowded ones, and only its long edges are cut.
 * @pre radius holds the distances from the surface, or lower bounds. @post lower bounds.
 * @throws Cancelled
 */
inline CurveSkeleton evenlySampled(const CurveSkeleton& skeleton, const ClosestSurface& surface,
	double spacing, const LocalScale& scale = sameEverywhere, const Progress& progress = Progress())
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	std::optional<bool> hasCycles; // counted when first needed
	CurveSkeleton even;
	std::vector<int> place(skeleton.position.size(), -1);
	const auto keep = [&](int v) {
		if (place[v] < 0) {
			place[v] = int(even.position.size());
			even.position.push_back(skeleton.position[v]);
			even.radius.push_back(skeleton.radius[v]);
		}
	};
	for (size_t v = 0; v < place.size(); ++v)
		if (neighbours[v].size() != 2)
			keep(int(v));
	const FewestEdges fewest(branches);
	for (const Branch& branch : branches) {
		progress.check();
		keep(branch.first()); // of a free cycle
		const int minimum = fewest.of(branch);
		BallChain line;
		for (int v : branch.nodes) {
			line.points.push_back(skeleton.position[v]);
			line.radii.push_back(skeleton.radius[v]);
		}
		const double length = branchLength(skeleton, branch);
		std::vector<double> spacings = spacingsAlong(line, surface, spacing, scale, progress);
		BallChain chain = scale.isUniform()
			? evenPoints(line, std::max(minimum, int(std::lround(length / spacing))))
			: gradedPoints(line, spacings, minimum);
		std::vector<double> from = lengthsAlong(line.points);
		if (!isInside(chain, surface, progress)) {
			measureUnknown(line, surface, progress);
			std::vector<int> keptOf(line.points.size());
			std::iota(keptOf.begin(), keptOf.end(), 0);
			if (!hasCycles)
				hasCycles = statistics(skeleton).cycles > 0;
			const BallChain straight =
				*hasCycles ? line : withoutLoops(line, spacings, keptOf, surface, progress);
			const BallChain thinned = withoutCrowdedNodes(straight, spacings, surface, progress);
			BallChain kept = withShortEdges(thinned, spacings);
			if (int(kept.points.size()) > minimum) {
				chain = std::move(kept);
				const std::vector<double> along = lengthsAlong(straight.points);
				for (size_t i = 0; i < from.size(); ++i)
					from[i] = along[size_t(keptOf[i])];
			}
		}
		const int segments = int(chain.points.size()) - 1;
		std::vector<int> ids(1, place[branch.first()]);
		for (int k = 1; k < segments; ++k) {
			ids.push_back(int(even.position.size()));
			even.position.push_back(chain.points[k]);
			even.radius.push_back(std::max(chain.radii[k], 0.0));
		}
		ids.push_back(place[branch.last()]);
		for (int k = 0; k < segments; ++k)
			even.edges.push_back({std::min(ids[k], ids[k + 1]), std::max(ids[k], ids[k + 1])});
		const std::vector<double> to = lengthsAlong(chain.points);
		int k = 0;
		for (size_t i = 1; i + 1 < branch.nodes.size(); ++i) {
			const double s = from[i] / from.back() * to.back();
			while (k < segments && to[k + 1] - s < s - to[k])
				++k;
			place[branch.nodes[i]] = ids[k];
		}
	}
	std::sort(even.edges.begin(), even.edges.end());
	even.node.reserve(skeleton.node.size());
	for (int v : skeleton.node)
		even.node.push_back(v < 0 ? -1 : place[v]);
	return even;
}

} // namespace vcg::tri::mcf::refining

#endif
