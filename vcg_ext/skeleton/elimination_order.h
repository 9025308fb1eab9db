// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file In which order the flow's unknowns are eliminated, so that the factor stays sparse.

#ifndef VCG_MCF_ELIMINATION_ORDER_H
#define VCG_MCF_ELIMINATION_ORDER_H

#include "stage.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Gives the vertices of a stage new ranks by approximate minimum degree (Amestoy, Davis, Duff 1996).
 * Complexity: about O(V log V).
 */
inline void rankByMinimumDegree(Stage& stage)
{
	const SurfaceMesh& mesh = stage.mesh;
	const int n = mesh.vertexSlots();
	// The adjacency with its diagonal, without which the ordering comes out as the identity.
	Eigen::SparseMatrix<char> pattern(n, n);
	pattern.resizeNonZeros(n + mesh.halfEdgeSlots());
	std::fill(pattern.valuePtr(), pattern.valuePtr() + pattern.nonZeros(), char(1));
	int* const start = pattern.outerIndexPtr();
	int* const row = pattern.innerIndexPtr();
	std::fill(start, start + n + 1, 0);
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		++start[mesh.origin(h) + 1];
	for (int v = 0; v < n; ++v)
		start[v + 1] += start[v] + 1;
	// Each vertex enters the columns of its neighbours when it is its turn: they come out sorted.
	std::vector<int> end(start, start + n);
	for (int v = 0; v < n; ++v) {
		row[end[v]++] = v;
		mesh.forEachOutgoing(v, [&](int h) { row[end[mesh.target(h)]++] = v; });
	}
	Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
	Eigen::internal::minimum_degree_ordering(pattern, order);
	stage.rank.resize(n);
	for (int k = 0; k < n; ++k)
		stage.rank[order.indices()[k]] = k;
	stage.rankedVertices = n;
}

/**
 * The free vertices of a stage in the order in which to eliminate them.
 *
 * An order is found once and inherited: a merged vertex takes the later rank, a vertex made by a
 * split comes first. When half of the vertices are gone a new one is made.
 */
inline std::vector<int> eliminationOrder(Stage& stage)
{
	if (stage.rank.empty() || 2 * stage.mesh.vertexSlots() < stage.rankedVertices)
		rankByMinimumDegree(stage);
	// Sorted by counting, vertices of equal rank by their number. Ranks start at -1.
	std::vector<int> start(stage.rankedVertices + 2, 0);
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
		if (!stage.fixed[v])
			++start[stage.rank[v] + 2];
	std::partial_sum(start.begin(), start.end(), start.begin());
	std::vector<int> order(start.back());
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
		if (!stage.fixed[v])
			order[start[stage.rank[v] + 1]++] = v;
	return order;
}

} // namespace vcg::tri::mcf

#endif
