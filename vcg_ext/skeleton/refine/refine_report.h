// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the report: what became of each component.

#ifndef VCG_MCF_REFINE_REPORT_H
#define VCG_MCF_REFINE_REPORT_H

#include "refine_check.h"

#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// What became of each component of a skeleton in its refinement.
struct RefineReport
{
	/// Components of the surface that have a curve, and those of them that have a refined one.
	int components = 0, refined = 0;
	/// Those that keep the given curve, by what was wrong with the refined one: it left the
	/// surface, grew too long, had other numbers of cycles or parts, or could not be computed.
	int outside = 0, tooLong = 0, otherTopology = 0, notFinite = 0;
	/// Nodes outside the surface in the curves that were kept, and how many curves have such nodes.
	int nodesOutside = 0, curvesOutside = 0;
	/// A component that keeps the given curve.
	struct Kept
	{
		int component; ///< of the surface, see connectedComponents()
		refining::Defect defect;
		int nodesOutside;
	};
	std::vector<Kept> kept;

	/// Counts a component.
	void add(int component, refining::Defect defect, int outside)
	{
		using refining::Defect;
		++components;
		switch (defect) {
		case Defect::None: ++refined; return;
		case Defect::NotFinite: ++notFinite; break;
		case Defect::TooLong: ++tooLong; break;
		case Defect::Topology: ++otherTopology; break;
		case Defect::Outside: ++this->outside; break;
		}
		nodesOutside += outside;
		curvesOutside += outside > 0;
		kept.push_back({component, defect, outside});
	}

	/// The report with one more component counted as refined.
	RefineReport withRefined(int component) const
	{
		RefineReport result;
		for (const Kept& one : kept)
			if (one.component != component)
				result.add(one.component, one.defect, one.nodesOutside);
		result.components = components;
		result.refined = components - int(result.kept.size());
		return result;
	}

	/// Fraction of the components that are refined; 1 for a skeleton without components.
	double fraction() const { return components > 0 ? double(refined) / components : 1; }

	/// One plain line on what was not refined, and why; empty if everything was.
	std::string text() const
	{
		if (refined == components)
			return "";
		std::string why;
		const auto count = [&](int number, const char* reason) {
			if (number > 0)
				why += (why.empty() ? "" : ", ") + std::to_string(number) + " " + reason;
		};
		count(outside, "would have left the surface");
		count(tooLong, "would have become too long");
		count(otherTopology, "would have changed in components or cycles");
		count(notFinite, "could not be computed");
		std::string line = std::to_string(components - refined) + " of "
			+ std::to_string(components)
			+ " components are not refined and keep their curves: " + why + ".";
		if (nodesOutside > 0)
			line += " Of the curves that are kept, " + std::to_string(curvesOutside)
				+ " are partly outside the surface, with " + std::to_string(nodesOutside)
				+ " nodes: parts of the shape may be too thin for the edges of its triangles.";
		return line;
	}
};

} // namespace vcg::tri::mcf

#endif
