// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief VTK's XML PolyData, for ParaView, 3D Slicer, PyVista and VMTK: a polyline for each branch,
 * its arrays under the names of VMTK's centerlines.
 */

#ifndef VCG_MCF_VTP_H
#define VCG_MCF_VTP_H

#include "skeleton_file.h"
#include "text_fields.h"

#include <skeleton/graph/skeleton_branches.h>

#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Integers in full: VTK reads no exponents there.
template <class Number>
std::string vtpNumber(Number value)
{
	if constexpr (std::is_integral_v<Number>)
		return std::to_string(value);
	else
		return numberText(value);
}

} // namespace detail

/**
 * Writes a skeleton as .vtp, in text. Points are the nodes, in their order, shared by the branches
 * that meet there. Lines are the branches of skeletonBranches(), isolated nodes are vertex cells.
 *
 * Point data: `MaximumInscribedSphereRadius`, mesh units, `mcfskel_significance` and
 * `mcfskel_bridge`, as far as they are known. Cell data, as VMTK has them after its branch
 * extraction: `GroupIds` and `CenterlineIds` (the branch, from 0; -1 at an isolated node),
 * `TractIds` 0, `Blanking` 0 (1: not a branch). Field data: `mcfskel_node`, for each surface vertex
 * its node or -1, if the correspondence is known.
 * Complexity: O(V + E).
 * @throws InvalidInput: see requireWritable().
 */
inline void writeVtp(std::ostream& out, const CurveSkeleton& skeleton)
{
	requireWritable(skeleton);
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	std::vector<int> isolated;
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].empty())
			isolated.push_back(int(v));

	const auto array = [&](const char* type, const std::string& name, const auto& values,
						   const std::string& more = "") {
		out << "<DataArray type=\"" << type << "\" Name=\"" << name << '"' << more
			<< " format=\"ascii\">";
		for (size_t i = 0; i < values.size(); ++i)
			out << (i % 12 == 0 ? '\n' : ' ') << detail::vtpNumber(values[i]);
		out << "\n</DataArray>\n";
	};
	// VTK's cells: all of their points, and after each cell how many points there are so far.
	const auto cells = [&](const char* name, const std::vector<std::vector<int>>& chains) {
		std::vector<int> points, ends;
		for (const std::vector<int>& chain : chains) {
			points.insert(points.end(), chain.begin(), chain.end());
			ends.push_back(int(points.size()));
		}
		out << '<' << name << ">\n";
		array("Int64", "connectivity", points);
		array("Int64", "offsets", ends);
		out << "</" << name << ">\n";
	};

	out << "<?xml version=\"1.0\"?>\n"
		   "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n";
	if (!skeleton.node.empty()) {
		out << "<FieldData>\n";
		array("Int32", "mcfskel_node", skeleton.node,
			" NumberOfTuples=\"" + std::to_string(skeleton.node.size()) + "\"");
		out << "</FieldData>\n";
	}
	out << "<Piece NumberOfPoints=\"" << skeleton.position.size() << "\" NumberOfVerts=\""
		<< isolated.size() << "\" NumberOfLines=\"" << branches.size()
		<< "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
	const bool hasRadius = !skeleton.radius.empty();
	if (hasRadius || !skeleton.significance.empty() || !skeleton.bridge.empty()) {
		out << (hasRadius ? "<PointData Scalars=\"MaximumInscribedSphereRadius\">\n"
						  : "<PointData>\n");
		if (hasRadius)
			array("Float64", "MaximumInscribedSphereRadius", skeleton.radius);
		if (!skeleton.significance.empty())
			array("Float64", "mcfskel_significance", skeleton.significance);
		if (!skeleton.bridge.empty())
			array("Int32", "mcfskel_bridge", skeleton.bridge);
		out << "</PointData>\n";
	}

	std::vector<int> branch(isolated.size(), -1), blanking(isolated.size(), 1);
	std::vector<std::vector<int>> lines, points;
	for (int v : isolated)
		points.push_back({v});
	for (const Branch& b : branches) {
		branch.push_back(int(lines.size()));
		blanking.push_back(0);
		lines.push_back(b.nodes);
	}
	out << "<CellData>\n";
	array("Int32", "GroupIds", branch);
	array("Int32", "CenterlineIds", branch);
	array("Int32", "TractIds", std::vector<int>(branch.size(), 0));
	array("Int32", "Blanking", blanking);
	out << "</CellData>\n<Points>\n";
	std::vector<double> coordinates;
	for (const Point3d& p : skeleton.position)
		coordinates.insert(coordinates.end(), {p[0], p[1], p[2]});
	array("Float64", "Points", coordinates, " NumberOfComponents=\"3\"");
	out << "</Points>\n";
	cells("Verts", points);
	cells("Lines", lines);
	out << "</Piece>\n</PolyData>\n</VTKFile>\n";
}

} // namespace vcg::tri::mcf

#endif
