// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The radius of skeleton nodes: how far the curve is from the surface that merged into it.

#ifndef VCG_MCF_SKELETON_RADIUS_H
#define VCG_MCF_SKELETON_RADIUS_H

#include "curve_skeleton.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/segment.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Fills in unknown radii (negative) from the known ones, ring by ring: each takes the mean of its
 * neighbours. A node that is not connected to any known radius stays negative.
 * @param neighbours of each node.
 * Complexity: O(V + E).
 */
inline void fillUnknownRadii(
	std::vector<double>& radius, const std::vector<std::vector<int>>& neighbours)
{
	// The unknown nodes beside the last ring; found[i] is the radius of ring[i].
	std::vector<int> ring;
	std::vector<double> found;
	std::vector<char> isFound(radius.size(), 0);
	const auto addUnknownBeside = [&](size_t v) {
		for (int w : neighbours[v])
			if (radius[size_t(w)] < 0 && !isFound[size_t(w)]) {
				isFound[size_t(w)] = 1;
				ring.push_back(w);
			}
	};
	for (size_t v = 0; v < radius.size(); ++v)
		if (radius[v] >= 0)
			addUnknownBeside(v);
	while (!ring.empty()) {
		found.clear();
		for (int v : ring) {
			double sum = 0;
			int count = 0;
			for (int w : neighbours[size_t(v)])
				if (radius[size_t(w)] >= 0) {
					sum += radius[size_t(w)];
					++count;
				}
			found.push_back(sum / count);
		}
		for (size_t i = 0; i < ring.size(); ++i)
			radius[size_t(ring[i])] = found[i];
		const std::vector<int> last = std::move(ring);
		ring.clear();
		for (int v : last)
			addUnknownBeside(size_t(v));
	}
}

namespace detail {

/**
 * For each node the mean of distanceOf(surface vertex) over those that have merged into it; -1 where
 * there are none.
 * @param node of each surface vertex, -1: none. @throws Cancelled. Complexity: O(S + N).
 */
template <class DistanceOf>
std::vector<double> meanOfMerged(size_t nodes, const std::vector<int>& node,
	const Cancellation& cancel, const DistanceOf& distanceOf)
{
	std::vector<double> mean = filledArray(nodes, 0.0, cancel);
	std::vector<int> count = filledArray(nodes, 0, cancel);
	cancellableLoop(int(node.size()), cancel, [&](int s) {
		if (node[s] < 0)
			return;
		mean[node[s]] += distanceOf(s);
		++count[node[s]];
	});
	cancellableLoop(
		int(nodes), cancel, [&](int v) { mean[v] = count[v] ? mean[v] / count[v] : -1; });
	return mean;
}

} // namespace detail

/**
 * Local thickness: for each node of a curve or meso-skeleton the mean distance of the surface
 * vertices that have merged into it from the edges that end at it. (From the node itself it would be
 * too large where the nodes are farther apart than the curve is thick.) A node without such vertices
 * takes the mean of its neighbours, see fillUnknownRadii().
 * @param neighbours of each node. @param node  of each surface vertex, -1: none.
 * @throws Cancelled. Complexity: O(S + N + E) for S surface vertices, and bounded degrees.
 */
inline std::vector<double> thicknessAlong(const std::vector<Point3d>& position,
	const std::vector<std::vector<int>>& neighbours, const std::vector<int>& node,
	const std::vector<Point3d>& surface, const Cancellation& cancel = Cancellation())
{
	std::vector<double> thickness = detail::meanOfMerged(position.size(), node, cancel, [&](int s) {
		const size_t v = size_t(node[size_t(s)]);
		const Point3d& p = surface[size_t(s)];
		double squared = SquaredDistance(p, position[v]);
		for (int w : neighbours[v])
			squared = std::min(squared,
				SquaredDistance(p, closestOnSegment(position[v], position[size_t(w)], p).point));
		return std::sqrt(squared);
	});
	fillUnknownRadii(thickness, neighbours);
	return thickness;
}

/// thicknessAlong() of a curve whose `node` refers to the vertices of `surface`. @throws Cancelled
inline std::vector<double> curveThickness(const CurveSkeleton& skeleton,
	const std::vector<Point3d>& surface, const Cancellation& cancel = Cancellation())
{
	return thicknessAlong(skeleton.position, skeleton.neighbours(), skeleton.node, surface, cancel);
}

} // namespace vcg::tri::mcf

#endif
