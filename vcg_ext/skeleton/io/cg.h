// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief The curve graph of the paper's authors: a header `# D:3 NV:n NE:m`, then a line `v x y z`
 * for each node and a line `e i j` for each edge, nodes counted from 1. It keeps no radius and no
 * correspondence.
 */

#ifndef VCG_MCF_CG_H
#define VCG_MCF_CG_H

#include "skeleton_file.h"
#include "text_fields.h"

#include <limits>
#include <ostream>
#include <string>
#include <string_view>

namespace vcg::tri::mcf {

/// Writes a skeleton as .cg. @throws InvalidInput: see requireWritable().
inline void writeCg(std::ostream& out, const CurveSkeleton& skeleton)
{
	requireWritable(skeleton);
	out << "# D:3 NV:" << skeleton.position.size() << " NE:" << skeleton.edges.size() << '\n';
	for (const Point3d& p : skeleton.position)
		out << "v " << numberText(p[0]) << ' ' << numberText(p[1]) << ' ' << numberText(p[2])
			<< '\n';
	for (const auto& [a, b] : skeleton.edges)
		out << "e " << a + 1 << ' ' << b + 1 << '\n';
}

namespace detail {

/// The number after `key`, which field i must begin with.
inline int cgHeaderNumber(FieldReader& in, size_t i, std::string_view key)
{
	constexpr const char* form = "# D:3 NV:n NE:m";
	if (in.count() != 4 || in[0] != "#" || in[i].substr(0, key.size()) != key)
		throw in.error("expected '" + std::string(form) + "'.");
	const std::string_view digits = in[i].substr(key.size());
	int value = -1;
	const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
	if (status != std::errc() || end != digits.data() + digits.size() || value < 0)
		throw in.error(
			"'" + std::string(in[i]) + "' has no count after '" + std::string(key) + "'.");
	return value;
}

} // namespace detail

/**
 * Reads a .cg file. Blank lines and further comments are skipped; an edge that is given again
 * counts towards NE but is kept once, with a warning.
 * @return a skeleton without radius and correspondence.
 * @throws FormatError with the line: a bad header, a line of neither kind, a coordinate that is not
 *         finite or beyond maxCoordinate, a node that does not exist, an edge from a node to
 *         itself, or other counts than the header's.
 */
inline SkeletonFile readCg(std::istream& stream)
{
	FieldReader in(stream);
	if (!in.nextLine())
		throw FormatError::atLine(1, "the file is empty; expected '# D:3 NV:n NE:m'.");
	if (detail::cgHeaderNumber(in, 1, "D:") != 3)
		throw in.error("the graph is not in three dimensions (D:3).");
	const int nodes = detail::cgHeaderNumber(in, 2, "NV:");
	const int edges = detail::cgHeaderNumber(in, 3, "NE:");

	SkeletonFile file;
	CurveSkeleton& skeleton = file.skeleton;
	while (in.nextLine()) {
		if (in.isBlank() || in.isComment())
			continue;
		if (in[0] == "v") {
			in.expectCount(4, "v x y z");
			if (int(skeleton.position.size()) == nodes)
				throw in.error("more nodes than the header's NV:" + std::to_string(nodes) + ".");
			skeleton.position.push_back(pointAt(in, 1));
		}
		else if (in[0] == "e") {
			in.expectCount(3, "e i j");
			if (int(skeleton.edges.size()) == edges)
				throw in.error("more edges than the header's NE:" + std::to_string(edges) + ".");
			const int a = in.integer(1, 1, nodes, "node"), b = in.integer(2, 1, nodes, "node");
			if (a == b)
				throw in.error("an edge from node " + std::to_string(a) + " to itself.");
			skeleton.edges.push_back({a - 1, b - 1});
		}
		else
			throw in.error("expected 'v x y z' or 'e i j', found '" + std::string(in[0]) + "'.");
	}
	if (int(skeleton.position.size()) < nodes)
		throw FormatError::atLine(in.line() + 1,
			"the file ends after " + std::to_string(skeleton.position.size()) + " of "
				+ std::to_string(nodes) + " nodes.");
	if (int(skeleton.edges.size()) < edges)
		throw FormatError::atLine(in.line() + 1,
			"the file ends after " + std::to_string(skeleton.edges.size()) + " of "
				+ std::to_string(edges) + " edges.");
	if (const int repeated = tidyEdges(skeleton.edges))
		file.warnings.push_back(std::to_string(repeated) + " edges are given more than once.");
	return file;
}

} // namespace vcg::tri::mcf

#endif
