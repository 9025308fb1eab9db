// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Betti numbers of curves and sheets: components, loops and closed pockets.

#ifndef VCG_MCF_BETTI_NUMBERS_H
#define VCG_MCF_BETTI_NUMBERS_H

#include <skeleton/core/disjoint_sets.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Ranks of the homology groups of a complex over GF(2).
struct BettiNumbers
{
	int b0 = 0; ///< connected components
	int b1 = 0; ///< independent loops
	int b2 = 0; ///< closed pockets

	friend bool operator==(const BettiNumbers& a, const BettiNumbers& b)
	{
		return a.b0 == b.b0 && a.b1 == b.b1 && a.b2 == b.b2;
	}
	friend bool operator!=(const BettiNumbers& a, const BettiNumbers& b) { return !(a == b); }
};

/// Edges and faces as vertex ids in ascending order.
using EdgeOfComplex = std::array<int, 2>;
using FaceOfComplex = std::array<int, 3>;

inline std::array<EdgeOfComplex, 3> edgesOf(const FaceOfComplex& f)
{
	return {{{f[0], f[1]}, {f[0], f[2]}, {f[1], f[2]}}};
}

namespace detail {

/// All edges of a complex, those of its faces included, ascending.
inline std::vector<EdgeOfComplex> allEdges(
	const std::vector<EdgeOfComplex>& edges, const std::vector<FaceOfComplex>& faces)
{
	std::vector<EdgeOfComplex> all = edges;
	for (const FaceOfComplex& f : faces)
		for (const EdgeOfComplex& e : edgesOf(f))
			all.push_back(e);
	std::sort(all.begin(), all.end());
	all.erase(std::unique(all.begin(), all.end()), all.end());
	return all;
}

/**
 * The faces that are left after elementary collapses: while a face has an edge that no other face
 * has, both are removed. Closed pockets stay, and little else.
 * @return ids of the faces left, ascending. Complexity: O(F log F).
 */
inline std::vector<int> facesWithoutFreeEdges(const std::vector<FaceOfComplex>& faces)
{
	std::map<EdgeOfComplex, std::vector<int>> around;
	for (size_t f = 0; f < faces.size(); ++f)
		for (const EdgeOfComplex& e : edgesOf(faces[f]))
			around[e].push_back(int(f));
	std::vector<EdgeOfComplex> queue;
	for (const auto& [edge, list] : around)
		if (list.size() == 1)
			queue.push_back(edge);
	std::vector<char> gone(faces.size(), 0);
	while (!queue.empty()) {
		const std::vector<int>& list = around[queue.back()];
		queue.pop_back();
		if (list.size() != 1)
			continue;
		const int f = list.front();
		gone[size_t(f)] = 1;
		for (const EdgeOfComplex& e : edgesOf(faces[size_t(f)])) {
			std::vector<int>& of = around[e];
			of.erase(std::find(of.begin(), of.end(), f));
			if (of.size() == 1)
				queue.push_back(e);
		}
	}
	std::vector<int> left;
	for (size_t f = 0; f < faces.size(); ++f)
		if (!gone[f])
			left.push_back(int(f));
	return left;
}

/**
 * A basis of the closed surfaces that faces form, by reducing the boundary matrix over GF(2).
 * @return for each face whose boundary is a sum of boundaries of earlier faces, the faces of that
 *         closed surface, itself last. Complexity: cubic in the number of faces at most.
 */
inline std::vector<std::vector<int>> closedSurfaces(const std::vector<FaceOfComplex>& faces)
{
	using Chain = std::vector<int>; // ascending
	const auto add = [](const Chain& a, const Chain& b) {
		Chain sum;
		std::set_symmetric_difference(
			a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(sum));
		return sum;
	};
	std::map<EdgeOfComplex, int> edgeId;
	std::map<int, std::pair<Chain, Chain>> columnOfPivot; // boundary, faces summed
	std::vector<Chain> surfaces;
	for (size_t f = 0; f < faces.size(); ++f) {
		Chain boundary;
		for (const EdgeOfComplex& e : edgesOf(faces[f]))
			boundary.push_back(edgeId.try_emplace(e, int(edgeId.size())).first->second);
		std::sort(boundary.begin(), boundary.end());
		Chain summed(1, int(f));
		while (!boundary.empty()) {
			const auto found = columnOfPivot.find(boundary.back());
			if (found == columnOfPivot.end())
				break;
			boundary = add(boundary, found->second.first);
			summed = add(summed, found->second.second);
		}
		if (boundary.empty())
			surfaces.push_back(std::move(summed));
		else {
			const int pivot = boundary.back();
			columnOfPivot.emplace(pivot, std::make_pair(std::move(boundary), std::move(summed)));
		}
	}
	return surfaces;
}

} // namespace detail

/**
 * The Betti numbers of a complex of vertices, edges and triangles:
 *     b2 = F - rank d2,  b1 = E - (V - b0) - rank d2.
 *
 * Elementary collapses remove nearly all faces before the matrix is reduced.
 * @param vertices  their number; each counts, used or not.
 * @param edges     need not hold the edges of the faces; no doubles.
 * @param faces     no doubles.
 * Complexity: O((E + F) log F), and cubic in the faces of closed pockets.
 */
inline BettiNumbers bettiNumbers(
	int vertices, const std::vector<EdgeOfComplex>& edges, const std::vector<FaceOfComplex>& faces)
{
	const std::vector<EdgeOfComplex> all = detail::allEdges(edges, faces);
	MergeForest forest(vertices);
	BettiNumbers b;
	b.b0 = vertices;
	for (const auto& [v, w] : all)
		b.b0 -= forest.join(v, w);
	std::vector<FaceOfComplex> core;
	for (int f : detail::facesWithoutFreeEdges(faces))
		core.push_back(faces[size_t(f)]);
	b.b2 = int(detail::closedSurfaces(core).size());
	const int rank = int(faces.size()) - b.b2;
	b.b1 = int(all.size()) - (vertices - b.b0) - rank;
	return b;
}

} // namespace vcg::tri::mcf

#endif
