// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief glTF 2.0, binary: the surface with an armature made from its skeleton, ready to be posed
 * in Blender and other programs.
 */

#ifndef VCG_MCF_GLB_H
#define VCG_MCF_GLB_H

#include "armature.h"
#include "json.h"
#include "skeleton_file.h"
#include "skin_weights.h"

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

/**
 * Writes a surface and its armature, see makeArmature() and skinWeights(), as binary glTF.
 * Positions, in single precision, keep the mesh's units and axes. The bones' nodes are called
 * bone_0, bone_1, ...; tips end in nodes without weights, so that programs that draw bones know how
 * long the last ones are.
 * @param surface   with as many vertices as skeleton.node has entries; a vertex without a node
 *                  takes the nearest node's weights.
 * @param tolerance see makeArmature(); 0: one percent of the surface's bounding box diagonal.
 * @throws InvalidInput: see requireWritable(); the correspondence is not known or of another
 *         surface, the surface has no faces, or there are more than 65535 joints. SolverError;
 *         Cancelled, before anything is written.
 */
inline void writeGlb(std::ostream& out, const CurveSkeleton& skeleton,
	const SkinnedSurface& surface, double tolerance = 0, const std::string& name = "surface",
	const Progress& progress = Progress())
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
	const std::vector<VertexShares> shares = skinWeights(surface, skeleton, armature, progress);
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
		for (size_t i = 0; i < 4; ++i) {
			joints[4 * v + i] = std::uint16_t(shares[v].bone[i]);
			weights[4 * v + i] = float(shares[v].weight[i]);
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
