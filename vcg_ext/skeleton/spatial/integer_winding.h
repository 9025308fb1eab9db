// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The winding number of a closed surface, which is an integer, by a tree of its triangles.

#ifndef VCG_MCF_INTEGER_WINDING_H
#define VCG_MCF_INTEGER_WINDING_H

#include "triangle_tree.h"
#include "vertical_crossing.h"

#include <vcg/space/box3.h>

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

} // namespace vcg::tri::mcf

#endif
