// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief In which order the flow's unknowns are eliminated, so that the factor stays sparse.

#ifndef VCG_MCF_FILL_REDUCING_ORDER_H
#define VCG_MCF_FILL_REDUCING_ORDER_H

#include "stage.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The free vertices of a stage in the order in which to eliminate them: component by component, from the last
 * to the first, but of 40 at a time the first and the second half by turns.
 *
 * Where the mesh is numbered breadth first, from the last to the first is the order of Cuthill and McKee,
 * reversed (George and Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981). A full
 * factor would be fuller than in an order of minimum degree; the incomplete one is emptier, closer to the
 * matrix, and each row's entries are near each other in memory. Vertices that splits have added since come
 * first.
 *
 * Neighbours in that order are mostly neighbours on the mesh, so that substitution waits at each unknown for
 * the one before. By turns, two chains of unknowns that hardly meet are under way at a time; in pieces this
 * small the factor is nearly as empty as without.
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
