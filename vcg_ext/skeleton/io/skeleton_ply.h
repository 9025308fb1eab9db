// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A skeleton as PLY with edges, radius and correspondence, to the last bit.

#ifndef VCG_MCF_SKELETON_PLY_H
#define VCG_MCF_SKELETON_PLY_H

#include "ply_tables.h"
#include "skeleton_file.h"

#include <ostream>

namespace vcg::tri::mcf {

/**
 * A skeleton as tables: elements vertex (position, radius, significance, bridge, and the radius as
 * quality for MeshLab), edge (vertex1, vertex2), mcfskel_surface (for each surface vertex its node)
 * and mcfskel_skeleton (the rest).
 * @param surfaceFingerprint, diagonal as in SkeletonFile.
 * @throws InvalidInput: see requireWritable().
 */
inline PlyFile skeletonPly(
	const CurveSkeleton& skeleton, std::uint64_t surfaceFingerprint = 0, double diagonal = 0)
{
	requireWritable(skeleton);
	PlyElement vertex {"vertex", skeleton.position.size(), {}};
	addPoints(vertex, "", skeleton.position);
	if (!skeleton.radius.empty()) {
		vertex.add("quality", PlyType::Float, skeleton.radius);
		vertex.add("mcfskel_radius", PlyType::Double, skeleton.radius);
	}
	if (!skeleton.significance.empty())
		vertex.add("mcfskel_significance", PlyType::Double, skeleton.significance);
	if (!skeleton.bridge.empty())
		vertex.add("mcfskel_bridge", PlyType::UInt8, skeleton.bridge);
	PlyElement edge {"edge", skeleton.edges.size(), {}};
	for (size_t end = 0; end < 2; ++end) {
		std::vector<int> ends;
		for (const std::array<int, 2>& pair : skeleton.edges)
			ends.push_back(pair[end]);
		edge.add(end ? "vertex2" : "vertex1", PlyType::Int32, ends);
	}
	PlyElement surface {"mcfskel_surface", skeleton.node.size(), {}};
	surface.add("node", PlyType::Int32, skeleton.node);
	PlyElement row {"mcfskel_skeleton", 1, {}};
	row.add("diagonal", PlyType::Double, std::array<double, 1> {diagonal});
	addFingerprint(row, surfaceFingerprint);
	return {{"mcfskel skeleton 1"}, {vertex, edge, surface, row}};
}

/// Writes skeletonPly(). @throws InvalidInput: see requireWritable().
inline void writeSkeletonPly(std::ostream& out, const CurveSkeleton& skeleton,
	std::uint64_t surfaceFingerprint = 0, double diagonal = 0)
{
	writeBinaryPly(out, skeletonPly(skeleton, surfaceFingerprint, diagonal));
}

/**
 * Reads a skeleton that writeSkeletonPly() wrote, or any binary PLY of vertices and edges. What the
 * file does not have (radius, significance, bridge, correspondence) stays empty.
 * @throws FormatError for a coordinate that is not finite or beyond maxCoordinate, a radius that is
 *         not from 0 to maxCoordinate, a significance that is not from 0 to 1, a bridge that is not
 *         0 or 1, an edge or a surface vertex whose node does not exist, an edge from a vertex to
 *         itself, a diagonal that is not finite or below 0, a fingerprint that is not of 64 bits,
 *         an element or property that is missing.
 */
inline SkeletonFile readSkeletonPly(const PlyFile& ply)
{
	SkeletonFile file;
	CurveSkeleton& skeleton = file.skeleton;
	const PlyTable vertex(ply, "vertex"), edge(ply, "edge");
	const int last = int(vertex.rows()) - 1;
	skeleton.position = vertex.anyPoints("");
	for (size_t v = 0; v < vertex.rows(); ++v)
		if (!isUsablePlace(skeleton.position[v]))
			throw vertex.error(v, "a coordinate is " + outsideOfCoordinates() + ".");
	if (vertex.has("mcfskel_radius"))
		skeleton.radius = vertex.anyReals("mcfskel_radius");
	for (size_t v = 0; v < skeleton.radius.size(); ++v)
		if (!isUsableRadius(skeleton.radius[v]))
			throw vertex.error(v,
				"'mcfskel_radius' is " + numberText(skeleton.radius[v]) + ", " + outsideOfRadii()
					+ ".");
	if (vertex.has("mcfskel_significance"))
		skeleton.significance = vertex.anyReals("mcfskel_significance");
	for (size_t v = 0; v < skeleton.significance.size(); ++v)
		if (!isUsableSignificance(skeleton.significance[v]))
			throw vertex.error(v,
				"'mcfskel_significance' is " + numberText(skeleton.significance[v])
					+ ", not between 0 and 1.");
	if (vertex.has("mcfskel_bridge"))
		for (int isBridge : vertex.integers("mcfskel_bridge", 0, 1))
			skeleton.bridge.push_back(char(isBridge));
	const std::vector<int> first = edge.integers("vertex1", 0, last);
	const std::vector<int> second = edge.integers("vertex2", 0, last);
	for (size_t e = 0; e < first.size(); ++e) {
		if (first[e] == second[e])
			throw edge.error(e, "an edge from a vertex to itself.");
		skeleton.edges.push_back({first[e], second[e]});
	}
	if (const int repeated = tidyEdges(skeleton.edges))
		file.warnings.push_back(std::to_string(repeated) + " edges are given more than once.");
	if (ply.find("mcfskel_surface"))
		skeleton.node = PlyTable(ply, "mcfskel_surface").integers("node", -1, last);
	// Files of earlier releases have none.
	if (ply.find("mcfskel_skeleton")) {
		const PlyTable row(ply, "mcfskel_skeleton");
		if (row.rows() != 1)
			throw row.error(0, "expected one row.");
		file.diagonal = row.reals("diagonal", 0)[0];
		file.surfaceFingerprint = fingerprintIn(row);
	}
	return file;
}

} // namespace vcg::tri::mcf

#endif
