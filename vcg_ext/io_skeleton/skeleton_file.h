// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file What the formats of a skeleton share: checks before writing, source vertices, tidy edges.

#ifndef VCG_MCF_SKELETON_FILE_H
#define VCG_MCF_SKELETON_FILE_H

#include "../skeleton/curve_skeleton.h"
#include "format_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// A skeleton as read from a file. Its radius is empty where the format has none.
struct SkeletonFile
{
	CurveSkeleton skeleton;
	/// What was put right, a sentence each.
	std::vector<std::string> warnings;
};

/**
 * Checks that a skeleton can be written: finite positions, edges between two of its nodes, a radius
 * for each node or none at all, source nodes that exist (or -1).
 * @throws InvalidInput that names the first culprit.
 */
inline void requireWritable(const CurveSkeleton& skeleton)
{
	const int n = int(skeleton.position.size());
	for (int v = 0; v < n; ++v)
		for (int k = 0; k < 3; ++k)
			if (!std::isfinite(skeleton.position[v][k]))
				throw InvalidInput(
					"Node " + std::to_string(v) + " has a coordinate that is not finite.");
	if (!skeleton.radius.empty() && int(skeleton.radius.size()) != n)
		throw InvalidInput("The skeleton has " + std::to_string(n) + " nodes but "
			+ std::to_string(skeleton.radius.size()) + " radii.");
	for (size_t v = 0; v < skeleton.radius.size(); ++v)
		if (!std::isfinite(skeleton.radius[v]))
			throw InvalidInput("Node " + std::to_string(v) + " has a radius that is not finite.");
	for (const auto& [a, b] : skeleton.edges)
		if (a < 0 || b < 0 || a >= n || b >= n || a == b)
			throw InvalidInput("Edge " + std::to_string(a) + " " + std::to_string(b)
				+ " does not join two nodes.");
	for (int node : skeleton.node)
		if (node < -1 || node >= n)
			throw InvalidInput("A surface vertex belongs to node " + std::to_string(node)
				+ ", which does not exist.");
}

/// For each node the surface vertices that have merged into it, ascending.
inline std::vector<std::vector<int>> sourceVertices(const CurveSkeleton& skeleton)
{
	std::vector<std::vector<int>> sources(skeleton.position.size());
	for (size_t s = 0; s < skeleton.node.size(); ++s)
		if (skeleton.node[s] >= 0)
			sources[size_t(skeleton.node[s])].push_back(int(s));
	return sources;
}

/**
 * Brings edges into the order that a CurveSkeleton has, each once.
 * @return how many were repeated.
 */
inline int tidyEdges(std::vector<std::array<int, 2>>& edges)
{
	for (std::array<int, 2>& edge : edges)
		if (edge[0] > edge[1])
			std::swap(edge[0], edge[1]);
	std::sort(edges.begin(), edges.end());
	const auto end = std::unique(edges.begin(), edges.end());
	const int repeated = int(edges.end() - end);
	edges.erase(end, edges.end());
	return repeated;
}

} // namespace vcg::tri::mcf

#endif
