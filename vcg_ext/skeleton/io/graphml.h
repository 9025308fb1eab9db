// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief GraphML, the XML of graph libraries such as networkx, igraph and Gephi.

#ifndef VCG_MCF_GRAPHML_H
#define VCG_MCF_GRAPHML_H

#include "skeleton_file.h"
#include "text_fields.h"

#include <ostream>
#include <string>

namespace vcg::tri::mcf {

namespace detail {

/// A text within an XML element.
inline std::string xmlText(const std::string& text)
{
	std::string result;
	for (char c : text)
		switch (c) {
		case '&': result += "&amp;"; break;
		case '<': result += "&lt;"; break;
		case '>': result += "&gt;"; break;
		default: result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
		}
	return result;
}

} // namespace detail

/**
 * Writes a skeleton as GraphML: nodes 0, 1, ... with the numbers x, y, z and radius (mesh units),
 * significance, bridge (1 in the middle of one, else 0) and the text surface_vertices (ids from 0,
 * blanks between); edges with their length; the graph with the name of the surface and, as
 * surface_vertices, its number of vertices. What is not known is left out.
 * @param surfaceName of the mesh to whose vertices surface_vertices refers, in UTF-8.
 * @throws InvalidInput: see requireWritable().
 */
inline void writeGraphml(
	std::ostream& out, const CurveSkeleton& skeleton, const std::string& surfaceName = "")
{
	requireWritable(skeleton);
	const bool hasRadius = !skeleton.radius.empty(), hasSources = !skeleton.node.empty();
	const bool hasSignificance = !skeleton.significance.empty();
	const bool hasBridges = !skeleton.bridge.empty();
	const auto key = [&](const char* name, const char* of, const char* type) {
		out << "  <key id=\"" << name << "\" for=\"" << of << "\" attr.name=\"" << name
			<< "\" attr.type=\"" << type << "\"/>\n";
	};
	const auto data = [&](const char* name, const std::string& value) {
		out << "<data key=\"" << name << "\">" << value << "</data>";
	};
	out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
		   "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
	for (const char* axis : {"x", "y", "z"})
		key(axis, "node", "double");
	if (hasRadius)
		key("radius", "node", "double");
	if (hasSignificance)
		key("significance", "node", "double");
	if (hasBridges)
		key("bridge", "node", "int");
	if (hasSources)
		key("surface_vertices", "node", "string");
	key("length", "edge", "double");
	if (!surfaceName.empty())
		key("surface", "graph", "string");
	if (hasSources) {
		out << "  <key id=\"surface_vertex_count\" for=\"graph\" attr.name=\"surface_vertices\" "
			   "attr.type=\"int\"/>\n";
	}
	out << "  <graph id=\"skeleton\" edgedefault=\"undirected\">\n";
	if (!surfaceName.empty()) {
		data("surface", detail::xmlText(surfaceName));
		out << '\n';
	}
	if (hasSources) {
		data("surface_vertex_count", std::to_string(skeleton.node.size()));
		out << '\n';
	}

	const std::vector<std::vector<int>> sources = sourceVertices(skeleton);
	for (size_t v = 0; v < skeleton.position.size(); ++v) {
		const Point3d& p = skeleton.position[v];
		out << "    <node id=\"" << v << "\">";
		data("x", numberText(p[0]));
		data("y", numberText(p[1]));
		data("z", numberText(p[2]));
		if (hasRadius)
			data("radius", numberText(skeleton.radius[v]));
		if (hasSignificance)
			data("significance", numberText(skeleton.significance[v]));
		if (hasBridges)
			data("bridge", std::to_string(int(skeleton.bridge[v])));
		if (hasSources) {
			std::string list;
			for (int s : sources[v])
				list += (list.empty() ? "" : " ") + std::to_string(s);
			data("surface_vertices", list);
		}
		out << "</node>\n";
	}
	for (const auto& [a, b] : skeleton.edges) {
		out << "    <edge source=\"" << a << "\" target=\"" << b << "\">";
		data("length",
			numberText(Distance(skeleton.position[size_t(a)], skeleton.position[size_t(b)])));
		out << "</edge>\n";
	}
	out << "  </graph>\n</graphml>\n";
}

} // namespace vcg::tri::mcf

#endif
