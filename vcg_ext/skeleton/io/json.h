// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief JSON in the node-link form that networkx and D3 read.

#ifndef VCG_MCF_JSON_H
#define VCG_MCF_JSON_H

#include "skeleton_file.h"
#include "text_fields.h"

#include <ostream>
#include <string>

namespace vcg::tri::mcf {

namespace detail {

/// A text between quotation marks.
inline std::string jsonText(const std::string& text)
{
	std::string result = "\"";
	for (char c : text) {
		if (c == '"' || c == '\\')
			result += '\\';
		result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
	}
	return result + "\"";
}

} // namespace detail

/**
 * Writes a skeleton as JSON: `nodes` with id, position (three numbers), radius, significance,
 * bridge (1 in the middle of one, else 0) and surface_vertices (ids from 0); `edges` with source,
 * target and length; `graph` with the counts of statistics(), the name of the surface and its
 * number of vertices. Lengths are mesh units; what is not known is left out.
 * @param surfaceName of the mesh to whose vertices surface_vertices refers, in UTF-8.
 * @throws InvalidInput: see requireWritable().
 */
inline void writeJson(
	std::ostream& out, const CurveSkeleton& skeleton, const std::string& surfaceName = "")
{
	requireWritable(skeleton);
	const SkeletonStatistics s = statistics(skeleton);
	out << "{\"directed\": false, \"multigraph\": false,\n\"graph\": {";
	if (!surfaceName.empty())
		out << "\"surface\": " << detail::jsonText(surfaceName) << ", ";
	if (!skeleton.node.empty())
		out << "\"surface_vertices\": " << skeleton.node.size() << ", ";
	out << "\"components\": " << s.components << ", \"cycles\": " << s.cycles
		<< ", \"branches\": " << s.branches << ", \"terminals\": " << s.terminals
		<< ", \"junctions\": " << s.junctions << ", \"length\": " << numberText(s.length)
		<< "},\n\"nodes\": [";
	const std::vector<std::vector<int>> sources = sourceVertices(skeleton);
	for (size_t v = 0; v < skeleton.position.size(); ++v) {
		const Point3d& p = skeleton.position[v];
		out << (v ? ",\n" : "\n") << "{\"id\": " << v << ", \"position\": [" << numberText(p[0])
			<< ", " << numberText(p[1]) << ", " << numberText(p[2]) << "]";
		if (!skeleton.radius.empty())
			out << ", \"radius\": " << numberText(skeleton.radius[v]);
		if (!skeleton.significance.empty())
			out << ", \"significance\": " << numberText(skeleton.significance[v]);
		if (!skeleton.bridge.empty())
			out << ", \"bridge\": " << int(skeleton.bridge[v]);
		if (!skeleton.node.empty()) {
			out << ", \"surface_vertices\": [";
			for (size_t i = 0; i < sources[v].size(); ++i)
				out << (i ? ", " : "") << sources[v][i];
			out << "]";
		}
		out << "}";
	}
	out << "\n],\n\"edges\": [";
	for (size_t e = 0; e < skeleton.edges.size(); ++e) {
		const auto& [a, b] = skeleton.edges[e];
		out << (e ? ",\n" : "\n") << "{\"source\": " << a << ", \"target\": " << b
			<< ", \"length\": "
			<< numberText(Distance(skeleton.position[size_t(a)], skeleton.position[size_t(b)]))
			<< "}";
	}
	out << "\n]}\n";
}

} // namespace vcg::tri::mcf

#endif
