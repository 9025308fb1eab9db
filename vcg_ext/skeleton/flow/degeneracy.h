// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Which vertices have collapsed onto the skeleton (Sec. 4.4).

#ifndef VCG_MCF_DEGENERACY_H
#define VCG_MCF_DEGENERACY_H

#include "stage.h"

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Euler characteristic of the infinitesimal neighbourhood of v: the vertices that can be reached
 * from v along edges without leaving the ball of the given radius, and the edges and faces between
 * them. A disc has 1; anything else means that the surface has closed onto itself at v.
 * Complexity: O(k^2) for k vertices in the neighbourhood.
 */
inline int neighbourhoodEuler(const SurfaceMesh& mesh, int v, double radius)
{
	const Point3d centre = mesh.position[v];
	const double limit = radius * radius;
	std::vector<int> disc(1, v);
	const auto inDisc = [&](int x) { return std::find(disc.begin(), disc.end(), x) != disc.end(); };
	for (size_t i = 0; i < disc.size(); ++i)
		mesh.forEachOutgoing(disc[i], [&](int h) {
			const int x = mesh.target(h);
			if (SquaredDistance(mesh.position[x], centre) < limit && !inDisc(x))
				disc.push_back(x);
		});
	std::sort(disc.begin(), disc.end());
	const auto contains = [&](int x) { return std::binary_search(disc.begin(), disc.end(), x); };
	int halfEdges = 0, corners = 0;
	for (int x : disc)
		mesh.forEachOutgoing(x, [&](int h) {
			if (contains(mesh.target(h))) {
				++halfEdges;
				corners += contains(mesh.apex(h));
			}
		});
	return int(disc.size()) - halfEdges / 2 + corners / 3;
}

/**
 * Fixes the candidates whose neighbourhood of radius Stage::epsilonAt() is not a disc.
 * @param candidates vertices with a short edge that failed the link condition: only these can be
 *        degenerate, since any other short edge has been collapsed.
 * @param epsilon as in Parameters.
 * @return the number of vertices fixed.
 */
inline int fixDegenerateVertices(Stage& stage, const std::vector<int>& candidates, double epsilon)
{
	int count = 0;
	for (int v : candidates)
		if (stage.mesh.isVertex(v) && !stage.fixed[v]
			&& neighbourhoodEuler(stage.mesh, v, stage.epsilonAt(v, epsilon)) != 1) {
			stage.fixed[v] = 1;
			++count;
		}
	return count;
}

} // namespace vcg::tri::mcf

#endif
