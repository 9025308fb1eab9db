// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A skeleton with sheets: curves and single-walled sheets in one complex.

#ifndef VCG_MCF_MESO_SKELETON_H
#define VCG_MCF_MESO_SKELETON_H

#include "betti_numbers.h"

#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Area of a face, in squared units of its nodes' positions.
inline double faceArea(const std::vector<Point3d>& position, const FaceOfComplex& f)
{
	const Point3d& a = position[size_t(f[0])];
	return ((position[size_t(f[1])] - a) ^ (position[size_t(f[2])] - a)).Norm() / 2;
}

/// A skeleton of curves (edges) and sheets (faces), which share nodes.
struct MesoSkeleton
{
	/// Nodes, mesh units.
	std::vector<Point3d> position;
	/// Local thickness at each node, mesh units: mean distance of its surface vertices from its edges.
	std::vector<double> radius;
	/// Curve edges: those that belong to no face. Ascending.
	std::vector<EdgeOfComplex> edges;
	/// Ascending; no face occurs twice.
	std::vector<FaceOfComplex> faces;
	/// The correspondence: for each surface vertex the node it has merged into.
	std::vector<int> node;
	/// 1 for nodes that are not to be moved or removed when sheets are tidied, since vertices that
	/// are held have merged into them, see holdVertices(); empty: there are none.
	std::vector<char> held = {};

	bool isHeld(int v) const { return !held.empty() && held[size_t(v)]; }

	BettiNumbers betti() const { return bettiNumbers(int(position.size()), edges, faces); }

	/// Sum of the lengths of the curve edges, mesh units.
	double curveLength() const
	{
		double sum = 0;
		for (const auto& [a, b] : edges)
			sum += Distance(position[a], position[b]);
		return sum;
	}

	/// Sum of the areas of the faces, mesh units squared.
	double sheetArea() const
	{
		double sum = 0;
		for (const FaceOfComplex& f : faces)
			sum += faceArea(position, f);
		return sum;
	}
};

/// Removes the nodes that have another one as their target, with their edges and faces; the
/// correspondence follows. @param target of each node, itself if it stays; a target stays.
inline void removeMergedNodes(MesoSkeleton& skeleton, const std::vector<int>& target)
{
	MesoSkeleton left;
	std::vector<int> number(target.size(), -1);
	for (size_t v = 0; v < target.size(); ++v)
		if (target[v] == int(v)) {
			number[v] = int(left.position.size());
			left.position.push_back(skeleton.position[v]);
			left.radius.push_back(skeleton.radius[v]);
			if (!skeleton.held.empty())
				left.held.push_back(skeleton.held[v]);
		}
	const auto stays = [&](int v) { return target[size_t(v)] == v; };
	for (const auto& [a, b] : skeleton.edges)
		if (stays(a) && stays(b))
			left.edges.push_back({number[size_t(a)], number[size_t(b)]});
	for (const auto& [a, b, c] : skeleton.faces)
		if (stays(a) && stays(b) && stays(c))
			left.faces.push_back({number[size_t(a)], number[size_t(b)], number[size_t(c)]});
	for (int v : skeleton.node)
		left.node.push_back(number[size_t(target[size_t(v)])]);
	skeleton = std::move(left);
}

/**
 * The faces of a skeleton, oriented consistently across edges of two faces as far as that is
 * possible; the first face of each part keeps its orientation. Complexity: O(F log F).
 */
inline std::vector<std::array<int, 3>> orientedFaces(const MesoSkeleton& skeleton)
{
	std::map<EdgeOfComplex, std::vector<int>> around;
	for (size_t f = 0; f < skeleton.faces.size(); ++f)
		for (const EdgeOfComplex& e : edgesOf(skeleton.faces[f]))
			around[e].push_back(int(f));
	// Whether a face has the directed edge from a to b.
	const auto runsAlong = [](const std::array<int, 3>& face, int a, int b) {
		for (size_t k = 0; k < 3; ++k)
			if (face[k] == a && face[(k + 1) % 3] == b)
				return true;
		return false;
	};
	std::vector<std::array<int, 3>> result = skeleton.faces;
	std::vector<char> seen(result.size(), 0);
	for (size_t seed = 0; seed < result.size(); ++seed) {
		if (seen[seed])
			continue;
		seen[seed] = 1;
		std::vector<int> part(1, int(seed));
		for (size_t i = 0; i < part.size(); ++i) {
			const int f = part[i];
			for (const EdgeOfComplex& e : edgesOf(skeleton.faces[size_t(f)])) {
				const std::vector<int>& sharing = around[e];
				if (sharing.size() != 2)
					continue;
				const int g = sharing[0] == f ? sharing[1] : sharing[0];
				if (seen[size_t(g)])
					continue;
				seen[size_t(g)] = 1;
				part.push_back(g);
				if (runsAlong(result[size_t(f)], e[0], e[1])
					== runsAlong(result[size_t(g)], e[0], e[1]))
					std::swap(result[size_t(g)][1], result[size_t(g)][2]);
			}
		}
	}
	return result;
}

} // namespace vcg::tri::mcf

#endif
