// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Bones along a skeleton, and the weights by which its nodes follow them.

#ifndef VCG_MCF_ARMATURE_H
#define VCG_MCF_ARMATURE_H

#include <skeleton/core/segment.h>
#include <skeleton/graph/spanning_forest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A joint, and the bone that runs from it to its end.
struct Bone
{
	/// The bone, or root joint, that this one hangs on; -1 at a root joint.
	int parent;
	/// The nodes of the skeleton along the bone, the joint's first; only one at a root joint.
	std::vector<int> nodes;
	/// Arc length from the joint to each of them, mesh units.
	std::vector<double> arc;

	bool isRoot() const { return parent < 0; }
	int head() const { return nodes.front(); }
	int tail() const { return nodes.back(); }
	double length() const { return arc.back(); }
};

/// Bones by which a surface is moved, each after its parent, and the weights of the nodes.
struct Armature
{
	std::vector<Bone> bones;
	/// For each node up to four bones and their weights, which add up to 1, largest first.
	std::vector<std::vector<std::pair<int, double>>> weights;
};

namespace detail {

/// Douglas and Peucker 1973: marks the nodes of a chain that a polyline within `tolerance` needs.
inline void markBends(const std::vector<Point3d>& position, const std::vector<int>& chain,
	double tolerance, std::vector<char>& isJoint)
{
	std::vector<std::pair<size_t, size_t>> open {{0, chain.size() - 1}};
	while (!open.empty()) {
		const auto [first, last] = open.back();
		open.pop_back();
		const Point3d& a = position[size_t(chain[first])];
		const Point3d& b = position[size_t(chain[last])];
		double farthest = tolerance;
		size_t bend = 0;
		for (size_t i = first + 1; i < last; ++i) {
			const Point3d& p = position[size_t(chain[i])];
			const double distance = Distance(p, closestOnSegment(a, b, p).point);
			if (distance > farthest) {
				farthest = distance;
				bend = i;
			}
		}
		if (bend) {
			isJoint[size_t(chain[bend])] = 1;
			open.push_back({first, bend});
			open.push_back({bend, last});
		}
	}
}

/// Keeps the four largest weights and makes them add up to 1.
inline void keepFour(std::vector<std::pair<int, double>>& weights)
{
	std::stable_sort(weights.begin(), weights.end(),
		[](const auto& a, const auto& b) { return a.second > b.second; });
	while (!weights.empty() && (weights.size() > 4 || weights.back().second <= 0))
		weights.pop_back();
	double sum = 0;
	for (const auto& [bone, weight] : weights)
		sum += weight;
	for (auto& [bone, weight] : weights)
		weight /= sum;
}

} // namespace detail

/**
 * The armature of a skeleton. Each component becomes a tree, see spanningForest(), with a joint at
 * its root; cycles are cut. From a joint a bone runs along each of the tree's branches to the next
 * joint. Joints are at junctions, at tips and at bends, so that no node is farther than `tolerance`
 * from its straight bone. Where several bones begin, each has its own joint, so that each limb can
 * be turned by itself.
 *
 * Weights are linear in arc length near joints and 1 elsewhere: at a joint half belongs to the bone
 * that ends there, half to those that begin there, in equal parts. Over the length of the local
 * radius (at most half of the bone; a quarter of it where no radius is known) this passes into the
 * bone alone. They are continuous along the skeleton, except at joints where more than four bones
 * meet: there the smallest are dropped.
 * @param tolerance mesh units, above 0.
 * @pre the skeleton passes requireWritable().
 * Complexity: O(N log N) on usual curves.
 */
inline Armature makeArmature(const CurveSkeleton& skeleton, double tolerance)
{
	const SpanningForest forest = spanningForest(skeleton);
	const size_t n = skeleton.position.size();
	std::vector<std::vector<int>> children(n);
	for (int v : forest.order)
		if (forest.parent[size_t(v)] >= 0)
			children[size_t(forest.parent[size_t(v)])].push_back(v);
	std::vector<char> isJoint(n, 0);
	for (size_t v = 0; v < n; ++v)
		isJoint[v] = forest.parent[v] < 0 || children[v].size() != 1;
	const auto chainFrom = [&](int joint, int child) {
		std::vector<int> chain {joint, child};
		while (!isJoint[size_t(chain.back())])
			chain.push_back(children[size_t(chain.back())].front());
		return chain;
	};
	const std::vector<char> ends = isJoint; // bends are marked on the way
	for (int v : forest.order)
		if (ends[size_t(v)])
			for (int child : children[size_t(v)])
				detail::markBends(skeleton.position, chainFrom(v, child), tolerance, isJoint);

	Armature armature;
	std::vector<int> boneTo(n, -1); // the bone that ends at a joint, or the root joint there
	std::vector<std::vector<int>> bonesFrom(n);
	for (int v : forest.order) {
		if (!isJoint[size_t(v)])
			continue;
		if (forest.parent[size_t(v)] < 0) {
			boneTo[size_t(v)] = int(armature.bones.size());
			armature.bones.push_back({-1, {v}, {0}});
		}
		for (int child : children[size_t(v)]) {
			Bone bone {boneTo[size_t(v)], chainFrom(v, child), {0}};
			for (size_t i = 1; i < bone.nodes.size(); ++i)
				bone.arc.push_back(bone.arc.back()
					+ Distance(skeleton.position[size_t(bone.nodes[i - 1])],
						skeleton.position[size_t(bone.nodes[i])]));
			const int id = int(armature.bones.size());
			boneTo[size_t(bone.tail())] = id;
			bonesFrom[size_t(v)].push_back(id);
			armature.bones.push_back(std::move(bone));
		}
	}

	const auto share = [](std::vector<std::pair<int, double>>& weights, int bone, double weight) {
		for (auto& [b, w] : weights)
			if (b == bone) {
				w += weight;
				return;
			}
		weights.push_back({bone, weight});
	};
	// Adds `part` of the weights of a joint.
	const auto mixture = [&](int joint, double part, std::vector<std::pair<int, double>>& weights) {
		const int before = boneTo[size_t(joint)];
		const std::vector<int>& after = bonesFrom[size_t(joint)];
		const double toBefore = after.empty()         ? 1
			: armature.bones[size_t(before)].isRoot() ? 0
													  : 0.5;
		if (toBefore > 0)
			share(weights, before, part * toBefore);
		for (int bone : after)
			share(weights, bone, part * (1 - toBefore) / double(after.size()));
	};
	armature.weights.resize(n);
	for (int b = 0; b < int(armature.bones.size()); ++b) {
		const Bone& bone = armature.bones[size_t(b)];
		const auto reach = [&](int joint) {
			const double half = bone.length() / 2;
			return skeleton.radius.empty() ? half / 2
										   : std::min(skeleton.radius[size_t(joint)], half);
		};
		for (size_t i = bone.isRoot() ? 0 : 1; i < bone.nodes.size(); ++i) {
			std::vector<std::pair<int, double>>& weights = armature.weights[size_t(bone.nodes[i])];
			const bool atHead = bone.arc[i] < bone.length() - bone.arc[i];
			const int joint = atHead ? bone.head() : bone.tail();
			const double distance = atHead ? bone.arc[i] : bone.length() - bone.arc[i];
			const double alone = i + 1 == bone.nodes.size() ? 0
				: reach(joint) > 0                          ? std::min(distance / reach(joint), 1.0)
															: 1;
			share(weights, b, alone);
			mixture(joint, 1 - alone, weights);
			detail::keepFour(weights);
		}
	}
	return armature;
}

} // namespace vcg::tri::mcf

#endif
