// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A tree of boxes: those of many that meet another one.

#ifndef VCG_MCF_BOX_TREE_H
#define VCG_MCF_BOX_TREE_H

#include "triangle_tree.h"

#include <vcg/space/box3.h>

#include <optional>
#include <vector>

namespace vcg::tri::mcf {

/// Boxes, searched as triangles that degenerate to their diagonals. Keeps a copy of them.
class BoxTree
{
public:
	/// @throws Cancelled. Complexity: O(n log n).
	explicit BoxTree(const std::vector<Box3d>& boxes, const Progress& progress = Progress())
	{
		for (const Box3d& box : boxes) {
			const int low = int(corners.size());
			corners.insert(corners.end(), {box.min, box.max});
			diagonals.push_back({low, low + 1, low + 1});
		}
		tree.emplace(corners, diagonals, progress);
	}

	// The tree refers to the corners.
	BoxTree(const BoxTree&) = delete;
	BoxTree& operator=(const BoxTree&) = delete;

	/// Calls visit(i) for each box that meets another one; boxes that only touch do.
	template <class Visit>
	void forEachIn(const Box3d& box, const Visit& visit) const
	{
		tree->forEachFaceIn(box, visit);
	}

private:
	std::vector<Point3d> corners;
	std::vector<Triangle> diagonals;
	std::optional<TriangleTree> tree;
};

} // namespace vcg::tri::mcf

#endif
