// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file A numbering of a surface in which neighbours are near each other in memory.

#ifndef VCG_MCF_BREADTH_FIRST_ORDER_H
#define VCG_MCF_BREADTH_FIRST_ORDER_H

#include "progress.h"
#include "surface_mesh.h"

#include <vector>

namespace vcg::tri::mcf {

/// New ids for the vertices and faces of a surface, one component after the other.
struct Numbering
{
	std::vector<int> vertex; ///< for each vertex slot its new id, -1 where it was removed
	std::vector<int> face;   ///< for each face slot likewise
	/// For each new vertex id its connected component, in the order in which they were found.
	std::vector<int> component;
	int components = 0;
};

/**
 * Numbers the vertices of one component after the other breadth first, and the faces by the first
 * of their vertices. Passes over such a mesh are up to twice as fast as over one whose numbering
 * is random or has grown by splits.
 *
 * @param seeds a vertex of each component, in the order that the components shall have; or empty
 *              for the order of connectedComponents(), by lowest vertex.
 * @throws Cancelled
 * Complexity: O(V + F).
 */
inline Numbering breadthFirstOrder(const SurfaceMesh& mesh, const std::vector<int>& seeds = {},
	const Progress& progress = Progress())
{
	constexpr size_t reportEvery = 1 << 15;
	Numbering number;
	number.vertex.assign(mesh.vertexSlots(), -1);
	number.face.assign(mesh.faceSlots(), -1);
	number.component.reserve(mesh.vertexCount());
	std::vector<int> order;
	order.reserve(mesh.vertexCount());
	const auto reach = [&](int v) {
		if (number.vertex[v] < 0) {
			number.vertex[v] = int(order.size());
			order.push_back(v);
			number.component.push_back(number.components);
		}
	};
	size_t next = 0;
	int faces = 0;
	const auto addComponent = [&](int seed) {
		if (!mesh.isVertex(seed) || number.vertex[seed] >= 0)
			return;
		reach(seed);
		for (; next < order.size(); ++next) {
			if (next % reportEvery == 0)
				progress.report(double(next) / mesh.vertexCount(), "Ordering the surface");
			mesh.forEachOutgoing(order[next], [&](int h) {
				reach(mesh.target(h));
				if (number.face[h / 3] < 0)
					number.face[h / 3] = faces++;
			});
		}
		++number.components;
	};
	if (seeds.empty())
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			addComponent(v);
	else
		for (int v : seeds)
			addComponent(v);
	return number;
}

/// What `ofVertex` says about each vertex slot, in a new order of `count` vertices.
template <class T>
std::vector<T> renumbered(
	const std::vector<T>& ofVertex, const std::vector<int>& newVertex, int count)
{
	std::vector<T> result(count);
	for (size_t v = 0; v < ofVertex.size(); ++v)
		if (newVertex[v] >= 0)
			result[newVertex[v]] = ofVertex[v];
	return result;
}

} // namespace vcg::tri::mcf

#endif
