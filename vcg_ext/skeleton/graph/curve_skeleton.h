// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The result: a graph of nodes and edges in space, and what can be counted on it.

#ifndef VCG_MCF_CURVE_SKELETON_H
#define VCG_MCF_CURVE_SKELETON_H

#include <skeleton/core/disjoint_sets.h>

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace vcg::tri::mcf {

/// A curve skeleton: a simple graph (no loops, no double edges) embedded in space.
struct CurveSkeleton
{
	/// Nodes, mesh units.
	std::vector<Point3d> position;
	/// Local thickness at each node, mesh units: mean distance of its surface vertices from its edges.
	std::vector<double> radius;
	/// Pairs of nodes, lower id first, in ascending order.
	std::vector<std::array<int, 2>> edges;
	/// The correspondence: for each surface vertex the node it has merged into.
	std::vector<int> node;
	/// How much of the shape the branch of each node stands for, in [0, 1]: see nestedBranches();
	/// empty if it is not known.
	std::vector<double> significance;
	/// 1 for the nodes in the middle of bridges, see joinPieces(); empty if pieces were not joined.
	std::vector<char> bridge = {};

	/// The neighbours of each node, ascending.
	std::vector<std::vector<int>> neighbours() const
	{
		std::vector<std::vector<int>> result(position.size());
		for (const auto& [a, b] : edges) {
			result[a].push_back(b);
			result[b].push_back(a);
		}
		for (std::vector<int>& list : result)
			std::sort(list.begin(), list.end());
		return result;
	}
};

/// Counts and the length of a skeleton.
struct SkeletonStatistics
{
	int components = 0;
	/// Independent cycles, E - V + components: the genus of the surface.
	int cycles = 0;
	/// Maximal chains of edges between nodes of degree other than 2, and free cycles.
	int branches = 0;
	/// Nodes of degree 1, and of degree 3 or more.
	int terminals = 0, junctions = 0;
	/// Sum of the edge lengths, mesh units.
	double length = 0;
};

/// The statistics of a skeleton. Complexity: O(V + E).
inline SkeletonStatistics statistics(const CurveSkeleton& skeleton)
{
	SkeletonStatistics s;
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const int n = int(neighbours.size());
	int chainEnds = 0, freeCycles = 0;
	std::vector<char> seen(n, 0);
	for (int seed = 0; seed < n; ++seed) {
		if (seen[seed])
			continue;
		++s.components;
		std::vector<int> stack(1, seed);
		seen[seed] = 1;
		bool onlyDegreeTwo = true;
		while (!stack.empty()) {
			const int v = stack.back();
			stack.pop_back();
			const int degree = int(neighbours[v].size());
			s.terminals += degree == 1;
			s.junctions += degree >= 3;
			if (degree != 2) {
				chainEnds += degree;
				onlyDegreeTwo = false;
			}
			for (int w : neighbours[v])
				if (!seen[w]) {
					seen[w] = 1;
					stack.push_back(w);
				}
		}
		freeCycles += onlyDegreeTwo;
	}
	s.branches = chainEnds / 2 + freeCycles;
	s.cycles = int(skeleton.edges.size()) - n + s.components;
	for (const auto& [a, b] : skeleton.edges)
		s.length += Distance(skeleton.position[a], skeleton.position[b]);
	return s;
}

/**
 * The component of the surface that each node belongs to; -1 for parts of the graph into which
 * no vertex has merged. Where vertices of several components have merged into one connected part,
 * as of bodies whose vertices went to the nearest node of any, the majority decides.
 * @param component of each vertex of the surface. Complexity: O(E log E + surface vertices).
 */
inline std::vector<int> componentOfNodes(
	const CurveSkeleton& curve, const std::vector<int>& component)
{
	MergeForest parts(int(curve.position.size()));
	for (const auto& [a, b] : curve.edges)
		parts.join(a, b);
	std::vector<std::map<int, int>> votes(curve.position.size()); // at the parts' representatives
	for (size_t s = 0; s < curve.node.size(); ++s)
		if (curve.node[s] >= 0)
			++votes[parts.find(curve.node[s])][component[s]];
	std::vector<int> ofPart;
	for (const std::map<int, int>& count : votes) {
		const auto maximum = std::max_element(count.begin(), count.end(),
			[](const auto& a, const auto& b) { return a.second < b.second; });
		ofPart.push_back(maximum == count.end() ? -1 : maximum->first);
	}
	std::vector<int> ofNode;
	for (int v = 0; v < int(curve.position.size()); ++v)
		ofNode.push_back(ofPart[parts.find(v)]);
	return ofNode;
}

} // namespace vcg::tri::mcf

#endif
