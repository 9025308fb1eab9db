// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Removal of the spurs that the last vertices to be fixed leave on a collapsed curve.

#ifndef VCG_MCF_CURVE_SPURS_H
#define VCG_MCF_CURVE_SPURS_H

#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/core/progress.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/flow/stage.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/core/ticker.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * Removes the terminal branches whose prominence() is below `minimum`: they stand for no feature of
 * the shape. Balls reach to the nearest vertex of their component's surface. What had merged into a
 * spur goes to its junction. Branches with held nodes stay.
 * @param component  that each node belongs to.
 * @param held       for each node, whether it is held in its place.
 * @post if there are junctions, radius of these and of tips is that of their balls; held: infinite.
 * @throws Cancelled. Complexity: O(V log V + N log V).
 */
inline CurveSkeleton withoutSpurs(CurveSkeleton skeleton, const Stage& stage,
	const std::vector<int>& component, const std::vector<char>& held, double minimum,
	const Progress& progress)
{
	constexpr double infinity = std::numeric_limits<double>::infinity();
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const bool branched = std::any_of(
		neighbours.begin(), neighbours.end(), [](const auto& n) { return n.size() > 2; });
	if (!branched)
		return skeleton;
	const ComponentVertices vertices(
		componentOfSurfaceVertices(stage, progress), int(stage.diagonal.size()), progress);
	std::vector<std::vector<size_t>> ends(vertices.ids.size()); // of each component
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (held[v])
			skeleton.radius[v] = infinity;
		else if (neighbours[v].size() != 2)
			ends[size_t(component[v])].push_back(v);
	for (size_t c = 0; c < ends.size(); ++c) {
		if (ends[c].empty())
			continue;
		progress.report(double(c) / double(ends.size()), "Collapsing to curves");
		std::vector<Point3d> points;
		for (int s : vertices.ids[c])
			points.push_back((*stage.surface)[s]);
		const PointTree tree(points, progress.cancelOnly());
		cancellableLoop(int(ends[c].size()), progress, [&](int i) {
			const size_t v = ends[c][size_t(i)];
			skeleton.radius[v] = tree.distance(skeleton.position[v]);
		});
	}
	return withoutTerminalBranches(
		skeleton, minimum,
		[](const CurveSkeleton& s, const Branch& branch) {
			const bool isHeld = std::any_of(branch.nodes.begin(), branch.nodes.end(),
				[&](int v) { return std::isinf(s.radius[v]); });
			return isHeld ? infinity : terminalProminence(s, branch);
		},
		progress.cancelOnly());
}

} // namespace vcg::tri::mcf::detail

#endif
