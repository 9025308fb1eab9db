// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief glTF 2.0, binary: the surface with an armature made from its skeleton, ready to be posed in Blender and
 * other programs. The skin's weights come from the correspondence.
 */

#ifndef VCG_MCF_GLB_H
#define VCG_MCF_GLB_H

#include "json.h"
#include "skeleton_file.h"

#include <skeleton/graph/spanning_forest.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The triangle mesh that an armature moves.
struct SkinnedSurface
{
	std::vector<Point3d> position;
	std::vector<std::array<int, 3>> faces;
};

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

/// Bones by which a surface is moved, each after its parent, and how much of each every node takes part in.
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
		const Point3d a = position[size_t(chain[first])];
		const Point3d ab = position[size_t(chain[last])] - a;
		double farthest = tolerance;
		size_t bend = 0;
		for (size_t i = first + 1; i < last; ++i) {
			const Point3d ap = position[size_t(chain[i])] - a;
			const double square = ab.SquaredNorm();
			const double t = square > 0 ? std::clamp((ap * ab) / square, 0.0, 1.0) : 0;
			const double distance = (ap - ab * t).Norm();
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
 * The armature of a skeleton. Each component is a tree, see spanningForest(), with a joint at its root; cycles
 * are cut. From a joint a bone runs along each of the tree's branches to the next joint: at junctions,
 * at tips and at bends, so that no node is farther than `tolerance` from its straight bone. Where
 * several bones begin each has a joint of its own there, so that each limb can be turned by itself.
 *
 * Weights are linear in arc length near joints and 1 elsewhere: at a joint half belongs to the bone that ends there,
 * half to those that begin there, in equal parts, and over the length of the local radius (at most half of the
 * bone) this passes into the bone alone. They are continuous along the skeleton, but for joints at which more
 * than four bones meet, where the smallest are dropped.
 * @param tolerance mesh units, above 0.
 * @pre  requireWritable()
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
	// What a node at a joint takes part in.
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

/**
 * Writes a surface and its armature, see makeArmature(), as binary glTF. Positions, in single precision, keep the
 * mesh's units and axes. The bones' nodes are called bone_0, bone_1, ...; tips end in nodes without weights, so
 * that programs that draw bones know how long the last ones are.
 * @param surface   as many vertices as skeleton.node; a vertex of no node takes the nearest node's weights.
 * @param tolerance see makeArmature(); 0: one percent of the surface's bounding box diagonal.
 * @throws InvalidInput: see requireWritable(); the correspondence is not known or of another surface, the
 *         surface has no faces, or there are more than 65535 joints.
 */
inline void writeGlb(std::ostream& out, const CurveSkeleton& skeleton,
	const SkinnedSurface& surface, double tolerance = 0, const std::string& name = "surface")
{
	requireWritable(skeleton);
	if (skeleton.position.empty() || skeleton.node.size() != surface.position.size()
		|| surface.faces.empty())
		throw InvalidInput(
			"An armature needs the surface that the skeleton was made from, with its "
			"faces and the node of each of its vertices.");
	Box3d box;
	for (const Point3d& p : surface.position)
		box.Add(p);
	if (!(tolerance > 0))
		tolerance = std::max(0.01 * box.Diag(), std::numeric_limits<double>::min());
	const Armature armature = makeArmature(skeleton, tolerance);
	const std::vector<Bone>& bones = armature.bones;
	if (bones.size() > 65535)
		throw InvalidInput("An armature of glTF has at most 65535 joints; this one has "
			+ std::to_string(bones.size()) + ".");

	// The binary part: each array begins at a multiple of four bytes.
	std::string bytes, views, accessors;
	int count = 0;
	const auto add = [&](const auto& values, size_t elements, const char* type, int component,
						 const std::string& more, int target) {
		const size_t size = values.size() * sizeof(values[0]);
		const auto comma = [](std::string& list) { list += list.empty() ? "" : ","; };
		comma(views);
		views += "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes.size()) + ",\"byteLength\":"
			+ std::to_string(size) + (target ? ",\"target\":" + std::to_string(target) : "") + "}";
		comma(accessors);
		accessors += "{\"bufferView\":" + std::to_string(count)
			+ ",\"componentType\":" + std::to_string(component)
			+ ",\"count\":" + std::to_string(elements) + ",\"type\":\"" + type + "\"" + more + "}";
		bytes.append(reinterpret_cast<const char*>(values.data()), size);
		bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
		return count++;
	};
	constexpr int unsignedShort = 5123, unsignedInt = 5125, singleFloat = 5126;
	constexpr int arrayBuffer = 34962, elementBuffer = 34963;

	const size_t n = surface.position.size();
	std::vector<float> positions, weights(4 * n, 0.0f);
	std::vector<std::uint16_t> joints(4 * n, 0);
	std::array<float, 3> low, high;
	low.fill(std::numeric_limits<float>::max());
	high.fill(std::numeric_limits<float>::lowest());
	for (size_t v = 0; v < n; ++v) {
		const Point3d& p = surface.position[v];
		for (int k = 0; k < 3; ++k) {
			positions.push_back(float(p[k]));
			low[size_t(k)] = std::min(low[size_t(k)], positions.back());
			high[size_t(k)] = std::max(high[size_t(k)], positions.back());
		}
		int node = skeleton.node[v];
		if (node < 0)
			for (size_t i = 0; i < skeleton.position.size(); ++i)
				if (node < 0
					|| SquaredDistance(p, skeleton.position[i])
						< SquaredDistance(p, skeleton.position[size_t(node)]))
					node = int(i);
		const auto& shares = armature.weights[size_t(node)];
		for (size_t i = 0; i < shares.size(); ++i) {
			joints[4 * v + i] = std::uint16_t(shares[i].first);
			weights[4 * v + i] = float(shares[i].second);
		}
	}
	const auto triple = [](const auto& p) {
		return "[" + numberText(p[0]) + "," + numberText(p[1]) + "," + numberText(p[2]) + "]";
	};
	const int position = add(positions, n, "VEC3", singleFloat,
		",\"min\":" + triple(low) + ",\"max\":" + triple(high), arrayBuffer);
	const int joint = add(joints, n, "VEC4", unsignedShort, "", arrayBuffer);
	const int weight = add(weights, n, "VEC4", singleFloat, "", arrayBuffer);
	std::vector<std::uint32_t> corners;
	for (const std::array<int, 3>& face : surface.faces)
		for (int corner : face)
			corners.push_back(std::uint32_t(corner));
	const int indices = add(corners, corners.size(), "SCALAR", unsignedInt, "", elementBuffer);
	std::vector<float> toJoint; // the inverse of each joint's rest pose, by columns
	for (const Bone& bone : bones) {
		const Point3d& p = skeleton.position[size_t(bone.head())];
		for (float value : {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f,
				 float(-p[0]), float(-p[1]), float(-p[2]), 1.f})
			toJoint.push_back(value);
	}
	const int restPose = add(toJoint, bones.size(), "MAT4", singleFloat, "", 0);

	// Nodes: the joints under their bones' numbers, then the ends of tips, the armature, the mesh.
	std::vector<std::vector<int>> hanging(bones.size());
	std::vector<int> roots, tips;
	for (size_t b = 0; b < bones.size(); ++b)
		(bones[b].isRoot() ? roots : hanging[size_t(bones[b].parent)]).push_back(int(b));
	int next = int(bones.size());
	for (size_t b = 0; b < bones.size(); ++b)
		if (!bones[b].isRoot() && hanging[b].empty()) {
			hanging[b].push_back(next++);
			tips.push_back(int(b));
		}
	const auto list = [](const std::vector<int>& ids) {
		std::string text;
		for (int id : ids)
			text += (text.empty() ? "" : ",") + std::to_string(id);
		return "[" + text + "]";
	};
	std::string nodes;
	std::vector<int> allJoints;
	for (size_t b = 0; b < bones.size(); ++b) {
		const Bone& bone = bones[b];
		const Point3d& head = skeleton.position[size_t(bone.head())];
		const Point3d offset = bone.isRoot()
			? head
			: head - skeleton.position[size_t(bones[size_t(bone.parent)].head())];
		nodes += "{\"name\":\"bone_" + std::to_string(b) + "\",\"translation\":" + triple(offset)
			+ (hanging[b].empty() ? "" : ",\"children\":" + list(hanging[b])) + "},\n";
		allJoints.push_back(int(b));
	}
	for (int b : tips) {
		const Bone& bone = bones[size_t(b)];
		nodes += "{\"name\":\"bone_" + std::to_string(b) + "_end\",\"translation\":"
			+ triple(Point3d(
				skeleton.position[size_t(bone.tail())] - skeleton.position[size_t(bone.head())]))
			+ "},\n";
	}
	const int armatureNode = next++, meshNode = next++;
	nodes += "{\"name\":\"armature\",\"children\":" + list(roots) + "},\n"
		+ "{\"name\":" + detail::jsonText(name) + ",\"mesh\":0,\"skin\":0}";
	std::string json = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"mcfskel\"},\"scene\":0,"
					   "\"scenes\":[{\"nodes\":"
		+ list({armatureNode, meshNode}) + "}],\n\"nodes\":[" + nodes
		+ "],\n\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":"
		+ std::to_string(position) + ",\"JOINTS_0\":" + std::to_string(joint)
		+ ",\"WEIGHTS_0\":" + std::to_string(weight) + "},\"indices\":" + std::to_string(indices)
		+ "}]}],\n\"skins\":[{\"inverseBindMatrices\":" + std::to_string(restPose)
		+ ",\"skeleton\":" + std::to_string(armatureNode) + ",\"joints\":" + list(allJoints)
		+ "}],\n\"accessors\":[" + accessors + "],\n\"bufferViews\":[" + views
		+ "],\n\"buffers\":[{\"byteLength\":" + std::to_string(bytes.size()) + "}]}";
	json.resize((json.size() + 3) / 4 * 4, ' ');
	const auto word = [&](size_t value) {
		for (int shift = 0; shift < 32; shift += 8)
			out.put(char(value >> shift & 0xff));
	};
	constexpr size_t magic = 0x46546c67, jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;
	word(magic);
	word(2);
	word(12 + 8 + json.size() + 8 + bytes.size());
	word(json.size());
	word(jsonChunk);
	out << json;
	word(bytes.size());
	word(binaryChunk);
	out << bytes;
}

} // namespace vcg::tri::mcf

#endif
