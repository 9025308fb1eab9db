// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file In which order the flow's unknowns are eliminated, so that the factor stays sparse.

#ifndef VCG_MCF_ELIMINATION_ORDER_H
#define VCG_MCF_ELIMINATION_ORDER_H

#include "stage.h"

#include <vector>

namespace vcg::tri::mcf {

/**
 * The free vertices of a stage in the order in which to eliminate them: from the last to the first.
 *
 * Where the mesh is numbered breadth first this is the order of Cuthill and McKee, reversed (George and Liu,
 * "Computer Solution of Large Sparse Positive Definite Systems", 1981). A full factor would be fuller than
 * in an order of minimum degree; the incomplete one is emptier, closer to the matrix, and each row's
 * entries are near each other in memory. Vertices that splits have added since come first.
 * Complexity: O(V).
 */
inline std::vector<int> eliminationOrder(const Stage& stage)
{
	std::vector<int> order;
	order.reserve(stage.mesh.vertexSlots());
	for (int v = stage.mesh.vertexSlots() - 1; v >= 0; --v)
		if (!stage.fixed[v])
			order.push_back(v);
	return order;
}

} // namespace vcg::tri::mcf

#endif
