// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The elimination order of the flow's unknowns, which keeps the factor sparse.

#ifndef VCG_MCF_FILL_REDUCING_ORDER_H
#define VCG_MCF_FILL_REDUCING_ORDER_H

#include "stage.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Elimination order of the free vertices of a stage: component by component in reverse
 * Cuthill-McKee order, interleaved in blocks of 40.
 *
 * The mesh is numbered breadth first, so reverse Cuthill-McKee is from the last vertex to the first
 * (George and Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981). A complete
 * factor would have more fill than in a minimum degree order; the incomplete one has less, is
 * closer to the matrix, and the entries of each row are near each other in memory. Vertices that
 * splits have added since the numbering come first.
 *
 * Consecutive unknowns of that order are mostly neighbours on the mesh, so each would wait for the
 * one before it in the triangular solves. Within a block unknowns i and i + 20 alternate: two
 * independent dependency chains overlap (instruction-level parallelism), and blocks this small
 * hardly add fill.
 * Complexity: O(V).
 */
inline std::vector<int> eliminationOrder(const Stage& stage)
{
	std::vector<std::vector<int>> ofComponent(stage.diagonal.size());
	size_t count = 0;
	for (int v = stage.mesh.vertexSlots() - 1; v >= 0; --v)
		if (!stage.fixed[v]) {
			ofComponent[stage.component[v]].push_back(v);
			++count;
		}
	constexpr size_t half = 20;
	std::vector<int> order;
	order.reserve(count);
	for (const std::vector<int>& lastFirst : ofComponent)
		for (size_t first = 0; first < lastFirst.size(); first += 2 * half) {
			const size_t end = std::min(first + 2 * half, lastFirst.size());
			const size_t middle = std::min(first + half, end);
			for (size_t i = first; i < middle; ++i) {
				order.push_back(lastFirst[i]);
				if (i + half < end)
					order.push_back(lastFirst[i + half]);
			}
		}
	return order;
}

} // namespace vcg::tri::mcf

#endif
