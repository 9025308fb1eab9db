// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A table of the branches of a skeleton: length, thickness, ends.

#ifndef VCG_MCF_BRANCH_TABLE_H
#define VCG_MCF_BRANCH_TABLE_H

#include "curve_skeleton.h"
#include "skeleton_branches.h"

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/// What a branch ends at.
enum class BranchEnd {
	Tip,      ///< a node of degree 1
	Junction, ///< a node of degree 3 or more
	Itself    ///< the branch is a free cycle
};

/// One branch, as skeletonBranches() numbers them. Lengths and radii in mesh units.
struct BranchRecord
{
	double length = 0;
	/// Mean over the length; radii are linear along an edge.
	double meanRadius = 0;
	double minRadius = 0, greatestRadius = 0;
	BranchEnd first = BranchEnd::Tip, last = BranchEnd::Tip;
	/// The minimum over its nodes, see CurveSkeleton; 1 where it is not known.
	double significance = 1;
};

/// The records of `branches`, in their order. @pre the radius is set. Complexity: O(V + E).
inline std::vector<BranchRecord> branchTable(
	const CurveSkeleton& skeleton, const std::vector<Branch>& branches)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const auto endAt = [&](int v) {
		return neighbours[v].size() == 1 ? BranchEnd::Tip
			: neighbours[v].size() == 2  ? BranchEnd::Itself
										 : BranchEnd::Junction;
	};
	std::vector<BranchRecord> table;
	for (const Branch& branch : branches) {
		BranchRecord record;
		record.first = endAt(branch.first());
		record.last = endAt(branch.last());
		record.minRadius = record.greatestRadius = skeleton.radius[branch.first()];
		if (!skeleton.significance.empty())
			for (int v : branch.nodes)
				record.significance = std::min(record.significance, skeleton.significance[v]);
		double weighted = 0, plain = 0;
		for (size_t i = 1; i < branch.nodes.size(); ++i) {
			const int a = branch.nodes[i - 1], b = branch.nodes[i];
			const double length = Distance(skeleton.position[a], skeleton.position[b]);
			const double radius = (skeleton.radius[a] + skeleton.radius[b]) / 2;
			record.length += length;
			weighted += length * radius;
			plain += radius / double(branch.nodes.size() - 1);
			record.minRadius = std::min(record.minRadius, skeleton.radius[b]);
			record.greatestRadius = std::max(record.greatestRadius, skeleton.radius[b]);
		}
		record.meanRadius = record.length > 0 ? weighted / record.length : plain;
		table.push_back(record);
	}
	return table;
}

} // namespace vcg::tri::mcf

#endif
