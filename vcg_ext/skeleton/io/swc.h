// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief SWC, the format of neuron morphologies: a line `id type x y z radius parent` for each
 * node, parent -1 at a root. It is made of trees, so a cycle has to be cut.
 */

#ifndef VCG_MCF_SWC_H
#define VCG_MCF_SWC_H

#include "skeleton_file.h"
#include "text_fields.h"

#include <skeleton/graph/spanning_forest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// What a skeleton lost when it was made into trees, and its ids in the file.
struct SwcReport
{
	/// The edges that were left out, as nodes of the skeleton: one for each independent cycle.
	std::vector<std::array<int, 2>> cuts;
	/// The id of each node in the file, from 1.
	std::vector<int> idOfNode;
	/// The same for the user, a sentence each.
	std::vector<std::string> warnings;
};

/// Which node is the soma, the body of a neuron.
enum class SwcSoma {
	None,
	/// The thickest node, if it is at least twice as thick as the median of its tree's nodes.
	Auto,
	/// The thickest node.
	Thickest
};

/// How a skeleton is written as a neuron.
struct SwcOptions
{
	/// What every length is multiplied by; > 0.
	double scale = 1;
	/// The unit after that, such as "um", for the file's first line; empty: not known.
	std::string units;
	SwcSoma soma = SwcSoma::None;
};

namespace detail {

/// The root that is the soma; -1 for none. Readers expect at most one soma in a file.
inline int swcSoma(const CurveSkeleton& skeleton, const SpanningForest& forest, SwcSoma rule)
{
	if (rule == SwcSoma::None || skeleton.radius.empty())
		return -1;
	int soma = -1;
	for (int v : forest.order)
		if (forest.parent[size_t(v)] < 0
			&& (soma < 0 || skeleton.radius[size_t(v)] > skeleton.radius[size_t(soma)]))
			soma = v;
	if (rule == SwcSoma::Thickest || soma < 0)
		return soma;
	std::vector<double> radii;
	bool inTree = false; // trees follow one after the other
	for (int v : forest.order) {
		if (forest.parent[size_t(v)] < 0)
			inTree = v == soma;
		if (inTree)
			radii.push_back(skeleton.radius[size_t(v)]);
	}
	const auto median = radii.begin() + std::ptrdiff_t(radii.size() / 2);
	std::nth_element(radii.begin(), median, radii.end());
	return skeleton.radius[size_t(soma)] >= 2 * *median ? soma : -1;
}

} // namespace detail

/**
 * Writes a skeleton as SWC. Ids run from 1, each node after its parent; each component has one
 * root, with the parent -1. The type is 0, undefined; where there is a soma it is 1 there and 3,
 * dendrite, elsewhere.
 *
 * Each cycle is cut at its thinnest edge, see spanningForest(); the cuts are also listed in the
 * file's comments. A radius that is not known is written as 0.
 * @return the cuts, the ids and the warnings.
 * @throws InvalidInput: see requireWritable(); a scale that is not above 0, or that makes a length
 *         too large.
 */
inline SwcReport writeSwc(
	std::ostream& out, const CurveSkeleton& skeleton, const SwcOptions& options = {})
{
	requireWritable(skeleton);
	if (!(options.scale > 0 && options.scale <= maxCoordinate))
		throw InvalidInput(
			"The scale must be above 0 and at most " + numberText(maxCoordinate) + ".");
	for (size_t v = 0; v < skeleton.position.size(); ++v)
		if (!isUsablePlace(skeleton.position[v] * options.scale)
			|| (!skeleton.radius.empty() && !isUsableRadius(skeleton.radius[v] * options.scale)))
			throw InvalidInput("Node " + std::to_string(v) + " times the scale is beyond "
				+ numberText(maxCoordinate) + ".");
	const SpanningForest forest = spanningForest(skeleton);
	const int soma = detail::swcSoma(skeleton, forest, options.soma);
	SwcReport report;
	report.cuts = forest.cuts;
	report.idOfNode.resize(skeleton.position.size());
	for (size_t i = 0; i < forest.order.size(); ++i)
		report.idOfNode[size_t(forest.order[i])] = int(i) + 1;

	out << "# Curve skeleton, lengths in "
		<< (options.units.empty() ? "mesh units" : options.units);
	if (options.scale != 1)
		out << (options.units.empty() ? "" : ", mesh units") << " times "
			<< numberText(options.scale);
	out << '\n';
	for (const auto& [a, b] : report.cuts) {
		const std::string cut = std::to_string(report.idOfNode[size_t(a)]) + " "
			+ std::to_string(report.idOfNode[size_t(b)]);
		out << "# cycle cut between " << cut << '\n';
		report.warnings.push_back("SWC holds trees only: a cycle was cut between the nodes "
			+ std::to_string(a) + " and " + std::to_string(b) + ", in the file " + cut + ".");
	}
	if (skeleton.radius.empty())
		report.warnings.push_back("The radius is not known: it is written as 0.");
	out << "# id type x y z radius parent\n";
	for (int v : forest.order) {
		const Point3d p = skeleton.position[size_t(v)] * options.scale;
		const double radius =
			skeleton.radius.empty() ? 0 : skeleton.radius[size_t(v)] * options.scale;
		const int type = soma < 0 ? 0 : v == soma ? 1 : 3;
		const int parent = forest.parent[size_t(v)];
		out << report.idOfNode[size_t(v)] << ' ' << type << ' ' << numberText(p[0]) << ' '
			<< numberText(p[1]) << ' ' << numberText(p[2]) << ' ' << numberText(radius) << ' '
			<< (parent < 0 ? -1 : report.idOfNode[size_t(parent)]) << '\n';
	}
	return report;
}

namespace detail {

/// Throws unless following the parents of every node ends at a root. O(n).
inline void requireTrees(const std::vector<int>& parent, const std::vector<size_t>& line)
{
	std::vector<int> walk(parent.size(), -1); // the walk in which a node was first met
	for (int start = 0; start < int(parent.size()); ++start)
		for (int v = start; v >= 0; v = parent[size_t(v)]) {
			if (walk[size_t(v)] == start)
				throw FormatError::atLine(line[size_t(v)], "the node is its own ancestor.");
			if (walk[size_t(v)] >= 0)
				break;
			walk[size_t(v)] = start;
		}
}

} // namespace detail

/**
 * Reads an SWC file: nodes in the order of their lines, an edge to each parent. Types are not kept.
 * A parent may come after its children.
 * @return a skeleton with radius and without correspondence.
 * @throws FormatError with the line: not seven fields, an id below 0 or given twice, a coordinate
 *         that is not finite or beyond maxCoordinate, a radius that is not from 0 to maxCoordinate,
 *         a parent that does not exist, a node that is its own ancestor.
 */
inline SkeletonFile readSwc(std::istream& stream)
{
	constexpr int greatest = std::numeric_limits<int>::max();
	FieldReader in(stream);
	SkeletonFile file;
	CurveSkeleton& skeleton = file.skeleton;
	std::map<int, int> nodeOfId;
	std::vector<int> parentId;
	std::vector<size_t> line;
	while (in.nextLine()) {
		if (in.isBlank() || in.isComment())
			continue;
		in.expectCount(7, "id type x y z radius parent");
		const int id = in.integer(0, 0, greatest, "id");
		if (!nodeOfId.emplace(id, int(skeleton.position.size())).second)
			throw in.error("id " + std::to_string(id) + " is given twice.");
		in.integer(1, std::numeric_limits<int>::min(), greatest, "type");
		skeleton.position.push_back(pointAt(in, 2));
		skeleton.radius.push_back(radiusAt(in, 5));
		parentId.push_back(in.integer(6, -1, greatest, "parent"));
		line.push_back(in.line());
	}
	std::vector<int> parent(parentId.size(), -1);
	for (size_t v = 0; v < parent.size(); ++v) {
		if (parentId[v] < 0)
			continue;
		const auto found = nodeOfId.find(parentId[v]);
		if (found == nodeOfId.end())
			throw FormatError::atLine(
				line[v], "parent " + std::to_string(parentId[v]) + " does not exist.");
		parent[v] = found->second;
	}
	detail::requireTrees(parent, line);
	for (size_t v = 0; v < parent.size(); ++v)
		if (parent[v] >= 0)
			skeleton.edges.push_back({parent[v], int(v)});
	tidyEdges(skeleton.edges);
	return file;
}

} // namespace vcg::tri::mcf

#endif
