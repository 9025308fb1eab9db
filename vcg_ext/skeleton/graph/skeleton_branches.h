// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The branches of a curve skeleton, and which of them describe no feature of the shape.

#ifndef VCG_MCF_SKELETON_BRANCHES_H
#define VCG_MCF_SKELETON_BRANCHES_H

#include "curve_skeleton.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A maximal chain of nodes between nodes of degree other than 2, or a free cycle.
struct Branch
{
	/// In order along the branch; on a cycle the last is the first again.
	std::vector<int> nodes;

	int first() const { return nodes.front(); }
	int last() const { return nodes.back(); }
	bool isClosed() const { return first() == last(); }
};

/// The branch that starts with two neighbouring nodes, up to the next node of degree other than 2
/// or back to the first. Complexity: linear in the branch.
inline Branch branchAlong(const std::vector<std::vector<int>>& neighbours, int from, int to)
{
	Branch branch {{from, to}};
	while (neighbours[to].size() == 2 && to != branch.first()) {
		const int next = neighbours[to][0] == from ? neighbours[to][1] : neighbours[to][0];
		from = to;
		to = next;
		branch.nodes.push_back(to);
	}
	return branch;
}

/**
 * The branches of a skeleton: those that start at nodes of degree other than 2, ascending, then the
 * free cycles. Every edge is in exactly one; an isolated node is in none.
 * Complexity: O(V + E).
 */
inline std::vector<Branch> skeletonBranches(const CurveSkeleton& skeleton)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const int n = int(neighbours.size());
	std::vector<Branch> branches;
	std::vector<char> walked(n, 0); // inner nodes
	const auto walk = [&](int from, int to) {
		Branch branch = branchAlong(neighbours, from, to);
		for (size_t i = 1; i + 1 < branch.nodes.size(); ++i)
			walked[branch.nodes[i]] = 1;
		return branch;
	};
	for (int v = 0; v < n; ++v) {
		if (neighbours[v].size() == 2)
			continue;
		for (int w : neighbours[v]) {
			// A single edge between two such nodes is met from both ends.
			const bool inner = neighbours[w].size() == 2;
			if (inner ? !walked[w] : v < w)
				branches.push_back(walk(v, w));
		}
	}
	for (int v = 0; v < n; ++v)
		if (neighbours[v].size() == 2 && !walked[v]) {
			walked[v] = 1;
			branches.push_back(walk(v, neighbours[v][0]));
		}
	return branches;
}

/// The fewest edges with which a branch keeps its place in a graph in which two nodes share at most
/// one edge: 3 of a closed one, 2 beside another one with the same ends, else 1.
class FewestEdges
{
public:
	explicit FewestEdges(const std::vector<Branch>& branches)
	{
		for (const Branch& branch : branches)
			++withEnds[ends(branch)];
	}

	int of(const Branch& branch) const
	{
		return branch.isClosed() ? 3 : withEnds.at(ends(branch)) > 1 ? 2 : 1;
	}

private:
	std::map<std::pair<int, int>, int> withEnds;

	static std::pair<int, int> ends(const Branch& branch)
	{
		return std::minmax(branch.first(), branch.last());
	}
};

/// The first node that is at least `length` from a node, along the branch that leaves it towards `to`;
/// the end of the branch if that is nearer. Complexity: linear in the nodes up to there.
inline int nodeAlong(const CurveSkeleton& skeleton, const std::vector<std::vector<int>>& neighbours,
	int start, int to, double length)
{
	int from = start;
	double along = Distance(skeleton.position[from], skeleton.position[to]);
	while (along < length && neighbours[to].size() == 2) {
		const int next = neighbours[to][neighbours[to][0] == from];
		if (next == start) // of a free cycle
			break;
		along += Distance(skeleton.position[to], skeleton.position[next]);
		from = to;
		to = next;
	}
	return to;
}

/// Length of a branch, mesh units.
inline double branchLength(const CurveSkeleton& skeleton, const Branch& branch)
{
	double length = 0;
	for (size_t i = 1; i < branch.nodes.size(); ++i)
		length +=
			Distance(skeleton.position[branch.nodes[i - 1]], skeleton.position[branch.nodes[i]]);
	return length;
}

/**
 * How far the ball at `end` sticks out of the ball at `root`, mesh units:
 *     |end - root| + r_end - r_root.
 * At most 0: the ball at the end lies inside the other and adds nothing to the shape.
 * @param skeleton its `radius` must be the distance from the nodes to the surface.
 */
inline double protrusion(const CurveSkeleton& skeleton, int end, int root)
{
	return Distance(skeleton.position[end], skeleton.position[root]) + skeleton.radius[end]
		- skeleton.radius[root];
}

/**
 * The protrusion() of the ball at `end` in radii of the ball at `root`.
 *
 * A terminal branch with less than a tenth (from its tip, seen from the junction that it hangs
 * from) is a spur: it describes no feature.
 */
inline double prominence(const CurveSkeleton& skeleton, int end, int root)
{
	return protrusion(skeleton, end, root) / std::max(skeleton.radius[root], 1e-300);
}

/**
 * Merges nodes: node v goes into node target[v], which must be its own target. Edges within a
 * merged node vanish, double edges become one. Positions, radii, significance and marks of bridges
 * are those of the targets; the correspondence follows.
 * Complexity: O(V + E log E + surface vertices).
 */
inline CurveSkeleton mergeNodes(const CurveSkeleton& skeleton, const std::vector<int>& target)
{
	CurveSkeleton merged;
	std::vector<int> number(target.size(), -1);
	for (size_t v = 0; v < target.size(); ++v)
		if (target[v] == int(v)) {
			number[v] = int(merged.position.size());
			merged.position.push_back(skeleton.position[v]);
			merged.radius.push_back(skeleton.radius[v]);
			if (!skeleton.significance.empty())
				merged.significance.push_back(skeleton.significance[v]);
			if (!skeleton.bridge.empty())
				merged.bridge.push_back(skeleton.bridge[v]);
		}
	for (const auto& [a, b] : skeleton.edges) {
		const int A = number[target[a]], B = number[target[b]];
		if (A != B)
			merged.edges.push_back({std::min(A, B), std::max(A, B)});
	}
	std::sort(merged.edges.begin(), merged.edges.end());
	merged.edges.erase(std::unique(merged.edges.begin(), merged.edges.end()), merged.edges.end());
	merged.node.reserve(skeleton.node.size());
	for (int v : skeleton.node)
		merged.node.push_back(v < 0 ? -1 : number[target[v]]);
	return merged;
}

} // namespace vcg::tri::mcf

#endif
