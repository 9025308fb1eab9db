// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Which vertices have collapsed onto the skeleton (Sec. 4.4).

#ifndef VCG_MCF_DEGENERACY_H
#define VCG_MCF_DEGENERACY_H

#include "stage.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vector>

namespace vcg::tri::mcf {

/// Scratch memory of neighbourhoodEuler().
struct NeighbourhoodScratch
{
	std::vector<int> disc;
	std::vector<char> inDisc; ///< zero for each vertex between two calls
	explicit NeighbourhoodScratch(int vertices) : inDisc(size_t(vertices), 0) {}
};

/**
 * Euler characteristic of the infinitesimal neighbourhood of v: the vertices that can be reached
 * from v along edges without leaving the ball of the given radius, and the edges and faces between
 * them. A disc has 1; anything else means that the surface has closed onto itself at v.
 * @param ticker ticks for each vertex in the neighbourhood.
 * @throws Cancelled; the scratch memory is of no more use then.
 * Complexity: linear in the neighbourhood.
 */
inline int neighbourhoodEuler(const SurfaceMesh& mesh, int v, double radius,
	NeighbourhoodScratch& scratch, detail::Ticker& ticker)
{
	const Point3d centre = mesh.position[v];
	const double limit = radius * radius;
	std::vector<int>& disc = scratch.disc;
	std::vector<char>& inDisc = scratch.inDisc;
	disc.assign(1, v);
	inDisc[v] = 1;
	for (size_t i = 0; i < disc.size(); ++i) {
		ticker.tick();
		mesh.forEachOutgoing(disc[i], [&](int h) {
			const int x = mesh.target(h);
			if (!inDisc[x] && SquaredDistance(mesh.position[x], centre) < limit) {
				inDisc[x] = 1;
				disc.push_back(x);
			}
		});
	}
	int halfEdges = 0, corners = 0;
	for (int x : disc)
		mesh.forEachOutgoing(x, [&](int h) {
			if (inDisc[mesh.target(h)]) {
				++halfEdges;
				corners += inDisc[mesh.apex(h)];
			}
		});
	for (int x : disc)
		inDisc[x] = 0;
	return int(disc.size()) - halfEdges / 2 + corners / 3;
}

/**
 * Fixes the candidates whose neighbourhood of radius Stage::epsilonAt() is not a disc.
 * @param candidates vertices with a short edge that failed the link condition: only these can be
 *        degenerate, since any other short edge has been collapsed.
 * @param epsilon as in Parameters.
 * @return the number of vertices fixed.
 * @throws Cancelled; some of them are fixed then.
 */
inline int fixDegenerateVertices(Stage& stage, const std::vector<int>& candidates, double epsilon,
	const Progress& progress = Progress())
{
	detail::Ticker ticker(
		progress.cancelOnly(), "Looking for degenerate vertices", double(candidates.size()));
	NeighbourhoodScratch scratch(stage.mesh.vertexSlots());
	int count = 0;
	for (int v : candidates)
		if (stage.mesh.isVertex(v) && !stage.fixed[v]
			&& neighbourhoodEuler(stage.mesh, v, stage.epsilonAt(v, epsilon), scratch, ticker)
				!= 1) {
			stage.fixed[v] = 1;
			++count;
		}
	return count;
}

} // namespace vcg::tri::mcf

#endif
