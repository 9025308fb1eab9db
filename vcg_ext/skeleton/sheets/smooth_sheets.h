// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Clean-up of a skeleton with sheets: removes whiskers, smooths sheets and rims.

#ifndef VCG_MCF_SMOOTH_SHEETS_H
#define VCG_MCF_SMOOTH_SHEETS_H

#include "meso_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Removes whiskers: chains of curve edges from a node of a sheet to a tip that are shorter than the
 * thickness at that node, unless they hold vertices. What merged into their nodes goes to that
 * node. The topology stays.
 * @pre radius is set. Complexity: O(N + E + F).
 */
inline void removeWhiskers(MesoSkeleton& skeleton)
{
	const size_t n = skeleton.position.size();
	std::vector<char> hasFace(n, 0);
	for (const FaceOfComplex& f : skeleton.faces)
		for (int v : f)
			hasFace[size_t(v)] = 1;
	std::vector<std::vector<int>> neighbours(n);
	for (const auto& [a, b] : skeleton.edges) {
		neighbours[size_t(a)].push_back(b);
		neighbours[size_t(b)].push_back(a);
	}
	std::vector<int> target(n);
	for (size_t v = 0; v < n; ++v)
		target[v] = int(v);
	for (size_t tip = 0; tip < n; ++tip) {
		if (hasFace[tip] || neighbours[tip].size() != 1)
			continue;
		std::vector<int> chain(1, int(tip));
		double length = 0;
		int v = int(tip);
		do {
			const std::vector<int>& next = neighbours[size_t(v)];
			const int w =
				chain.size() > 1 && next[0] == chain[chain.size() - 2] ? next[1] : next[0];
			length += Distance(skeleton.position[size_t(v)], skeleton.position[size_t(w)]);
			chain.push_back(w);
			v = w;
		} while (!hasFace[size_t(v)] && neighbours[size_t(v)].size() == 2);
		// Only whiskers of sheets: for the spurs of curves see refine().
		const bool isHeld =
			std::any_of(chain.begin(), chain.end() - 1, [&](int w) { return skeleton.isHeld(w); });
		if (!hasFace[size_t(v)] || length >= skeleton.radius[size_t(v)] || isHeld)
			continue;
		for (size_t i = 0; i + 1 < chain.size(); ++i) {
			target[size_t(chain[i])] = v;
			neighbours[size_t(chain[i])].clear();
		}
		std::vector<int>& ofRoot = neighbours[size_t(v)];
		ofRoot.erase(std::find(ofRoot.begin(), ofRoot.end(), chain[chain.size() - 2]));
	}
	removeMergedNodes(skeleton, target);
}

/**
 * Moves each node of a sheet half-way to the mean of its neighbours, `rounds` times. Nodes on a rim
 * or a seam (edges of one face, or of three and more) move along it where two such edges meet, and
 * stay where it ends or forks; nodes with curve edges and those that hold vertices stay too.
 * Complexity: O(F log F + rounds * F).
 */
inline void smoothSheets(MesoSkeleton& skeleton, int rounds)
{
	std::map<EdgeOfComplex, int> count;
	for (const FaceOfComplex& f : skeleton.faces)
		for (const EdgeOfComplex& e : edgesOf(f))
			++count[e];
	const size_t n = skeleton.position.size();
	std::vector<std::vector<int>> inside(n), border(n);
	for (const auto& [e, faces] : count)
		for (int k = 0; k < 2; ++k)
			(faces == 2 ? inside : border)[size_t(e[k])].push_back(e[1 - k]);
	std::vector<char> stays(n, 0);
	for (const auto& [a, b] : skeleton.edges)
		stays[size_t(a)] = stays[size_t(b)] = 1;
	for (size_t v = 0; v < n; ++v)
		stays[v] |= skeleton.isHeld(int(v));
	for (int round = 0; round < rounds; ++round) {
		const std::vector<Point3d> before = skeleton.position;
		for (size_t v = 0; v < n; ++v) {
			const std::vector<int>& around = border[v].empty() ? inside[v] : border[v];
			if (stays[v] || around.empty() || (!border[v].empty() && border[v].size() != 2))
				continue;
			Point3d mean(0, 0, 0);
			for (int w : around)
				mean += before[size_t(w)];
			skeleton.position[v] = (before[v] + mean / double(around.size())) / 2.0;
		}
	}
}

} // namespace vcg::tri::mcf

#endif
