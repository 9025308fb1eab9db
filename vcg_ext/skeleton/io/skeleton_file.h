// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the formats of a skeleton share: what they hold, source vertices, tidy edges.

#ifndef VCG_MCF_SKELETON_FILE_H
#define VCG_MCF_SKELETON_FILE_H

#include "format_error.h"
#include "text_fields.h"

#include <skeleton/core/shape_limits.h>
#include <skeleton/graph/curve_skeleton.h>

#include <algorithm>
#include <cstdint>
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
	/// Of the surface's geometry, as a host computes it; 0: not known.
	std::uint64_t surfaceFingerprint = 0;
	/// That of the surface, mesh units; 0: not known.
	double diagonal = 0;
};

/// What is wrong with a coordinate that isUsablePlace() refuses.
inline std::string outsideOfCoordinates()
{
	return "not finite, or beyond " + numberText(maxCoordinate);
}

/// What is wrong with a radius that isUsableRadius() refuses.
inline std::string outsideOfRadii()
{
	return "not between 0 and " + numberText(maxCoordinate);
}

/// Whether a number can be the radius of a node.
inline bool isUsableRadius(double radius)
{
	return radius >= 0 && radius <= maxCoordinate;
}

/// Whether a number can be the significance of a node.
inline bool isUsableSignificance(double significance)
{
	return significance >= 0 && significance <= 1;
}

/**
 * Checks that a skeleton can be written, read again and worked with: coordinates within
 * maxCoordinate, edges between two of its nodes; radii from 0 to maxCoordinate, significances from
 * 0 to 1 and bridge marks, each for all nodes or for none; source nodes that exist (or -1). What
 * the readers return passes.
 * @throws InvalidInput that names the first value that is wrong.
 */
inline void requireWritable(const CurveSkeleton& skeleton)
{
	const int n = int(skeleton.position.size());
	for (int v = 0; v < n; ++v)
		if (!isUsablePlace(skeleton.position[v]))
			throw InvalidInput("Node " + std::to_string(v) + " has a coordinate that is "
				+ outsideOfCoordinates() + ".");
	if (!skeleton.radius.empty() && int(skeleton.radius.size()) != n)
		throw InvalidInput("The skeleton has " + std::to_string(n) + " nodes but "
			+ std::to_string(skeleton.radius.size()) + " radii.");
	for (size_t v = 0; v < skeleton.radius.size(); ++v)
		if (!isUsableRadius(skeleton.radius[v]))
			throw InvalidInput("Node " + std::to_string(v) + " has the radius "
				+ numberText(skeleton.radius[v]) + ", which is " + outsideOfRadii() + ".");
	if (!skeleton.significance.empty() && int(skeleton.significance.size()) != n)
		throw InvalidInput("The skeleton has " + std::to_string(n) + " nodes, but "
			+ std::to_string(skeleton.significance.size()) + " of them have a significance.");
	for (size_t v = 0; v < skeleton.significance.size(); ++v)
		if (!isUsableSignificance(skeleton.significance[v]))
			throw InvalidInput("Node " + std::to_string(v) + " has the significance "
				+ numberText(skeleton.significance[v]) + ", which is not between 0 and 1.");
	if (!skeleton.bridge.empty() && int(skeleton.bridge.size()) != n)
		throw InvalidInput("The skeleton has " + std::to_string(n) + " nodes, but of "
			+ std::to_string(skeleton.bridge.size())
			+ " of them it is known whether they are of a bridge.");
	for (const auto& [a, b] : skeleton.edges)
		if (a < 0 || b < 0 || a >= n || b >= n || a == b)
			throw InvalidInput("Edge " + std::to_string(a) + " " + std::to_string(b)
				+ " does not join two nodes.");
	for (int node : skeleton.node)
		if (node < -1 || node >= n)
			throw InvalidInput("A surface vertex belongs to node " + std::to_string(node)
				+ ", which does not exist.");
}

/// The point in three fields of a line. @throws FormatError unless isUsablePlace()
inline Point3d pointAt(const FieldReader& in, size_t firstField)
{
	const char* const names[] = {"coordinate x", "coordinate y", "coordinate z"};
	Point3d p;
	for (int k = 0; k < 3; ++k) {
		const size_t field = firstField + size_t(k);
		p[k] = in.real(field, names[k]);
		if (!(std::abs(p[k]) <= maxCoordinate))
			throw in.error(std::string(names[k]) + " '" + std::string(in[field]) + "' is "
				+ outsideOfCoordinates() + ".");
	}
	return p;
}

/// The radius in a field of a line. @throws FormatError unless isUsableRadius()
inline double radiusAt(const FieldReader& in, size_t field)
{
	const double radius = in.real(field, "radius");
	if (!isUsableRadius(radius))
		throw in.error("radius '" + std::string(in[field]) + "' is " + outsideOfRadii() + ".");
	return radius;
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
