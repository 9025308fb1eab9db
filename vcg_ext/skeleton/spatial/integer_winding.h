// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The winding number of a closed surface, which is an integer, by a tree of its triangles.

#ifndef VCG_MCF_INTEGER_WINDING_H
#define VCG_MCF_INTEGER_WINDING_H

#include "triangle_tree.h"
#include "vertical_crossing.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/**
 * How many times a closed surface goes around p: the sum of the signed crossings of a ray upwards.
 * Two triangles decide alike on which side of their common edge the ray is.
 * @param tree  of triangles with each edge as often in one direction as in the other.
 * Complexity: about O(log F + n) for n triangles whose boxes the ray meets.
 */
inline int integerWinding(const TriangleTree& tree, const Point3d& p)
{
	if (tree.size() == 0)
		return 0;
	const Box3d& all = tree.allNodes()[0].box;
	if (!all.IsIn(p))
		return 0;
	int winding = 0;
	Box3d ray;
	ray.Add(p);
	ray.Add(Point3d(p[0], p[1], all.max[2]));
	tree.forEachFaceIn(ray,
		[&](int f) { winding += detail::crossingAbove(tree.allPoints(), tree.triangle(f), p); });
	return winding;
}

/// integerWinding() of points near each other.
class TrianglesAbove
{
public:
	/// @param tree  kept by reference. @param p, q  the points are on the segment between them.
	/// Complexity: that of integerWinding(), for n triangles above the box of the segment.
	TrianglesAbove(const TriangleTree& tree, const Point3d& p, const Point3d& q) : tree(tree)
	{
		if (tree.size() == 0)
			return;
		const double rounding = 1e-12 * tree.allNodes()[0].box.Diag();
		Box3d box;
		box.Add(p);
		box.Add(q);
		box.Offset(rounding);
		box.max[2] = std::max(box.max[2], tree.allNodes()[0].box.max[2]);
		tree.forEachFaceIn(box, [&](int f) { faces.push_back(f); });
	}

	/// @param at  on the segment. Complexity: O(n).
	int winding(const Point3d& at) const
	{
		int sum = 0;
		for (int f : faces)
			sum += detail::crossingAbove(tree.allPoints(), tree.triangle(f), at);
		return sum;
	}

private:
	const TriangleTree& tree;
	std::vector<int> faces;
};

} // namespace vcg::tri::mcf

#endif
