// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A numbering of a surface in which neighbours are near each other in memory.

#ifndef VCG_MCF_BREADTH_FIRST_NUMBERING_H
#define VCG_MCF_BREADTH_FIRST_NUMBERING_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#include <utility>
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
	/// For each face slot the corner from which it was found, which does not depend on the order of
	/// its corners.
	std::vector<char> firstCorner;
};

/**
 * Numbers the vertices of one component after the other breadth first, and the faces by the first
 * of their vertices. Passes over such a mesh are up to twice as fast as over one whose numbering
 * is random or has grown by splits.
 *
 * The order depends on the seeds and the connectivity, not on the old numbering: rings begin with
 * the edge along which their vertex was reached.
 *
 * @param seeds a half-edge of each component, whose origin comes first, in the new order of the
 *              components; or empty for the order of connectedComponents(), by lowest vertex.
 * @throws Cancelled
 * Complexity: O(V + F).
 */
inline Numbering breadthFirstOrder(const SurfaceMesh& mesh, const std::vector<int>& seeds = {},
	const Progress& progress = Progress())
{
	constexpr size_t reportEvery = 1 << 15;
	const char* const what = "Ordering the surface";
	const size_t faceSlots = size_t(mesh.faceSlots());
	Numbering number;
	detail::fillArray(number.vertex, size_t(mesh.vertexSlots()), -1, progress);
	detail::fillArray(number.face, faceSlots, -1, progress);
	detail::fillArray(number.firstCorner, faceSlots, char(0), progress);
	number.component.reserve(mesh.vertexCount());
	std::vector<int> order; // of the vertices, each as the half-edge that its ring begins with
	order.reserve(mesh.vertexCount());
	const auto reach = [&](int first) {
		int& v = number.vertex[mesh.origin(first)];
		if (v < 0) {
			v = int(order.size());
			order.push_back(first);
			number.component.push_back(number.components);
		}
	};
	size_t next = 0;
	int faces = 0;
	const auto addComponent = [&](int seed) {
		if (number.vertex[mesh.origin(seed)] >= 0)
			return;
		reach(seed);
		for (; next < order.size(); ++next) {
			if (next % reportEvery == 0)
				progress.report(double(next) / mesh.vertexCount(), what);
			int h = order[next];
			do {
				reach(mesh.twin(h));
				if (number.face[h / 3] < 0) {
					number.face[h / 3] = faces++;
					number.firstCorner[h / 3] = char(h % 3);
				}
				h = mesh.rotated(h);
			} while (h != order[next]);
		}
		++number.components;
	};
	if (seeds.empty())
		for (int v = 0; v < mesh.vertexSlots(); ++v) {
			if (mesh.isVertex(v))
				addComponent(mesh.outgoing(v));
		}
	else
		for (int h : seeds)
			addComponent(h);
	return number;
}

/**
 * Numbers a mesh breadth first without holes, in place of SurfaceMesh::compact().
 * @return for each old vertex id the new one, -1 where it was removed.
 * @throws Cancelled
 * Complexity: O(V + F).
 */
inline std::vector<int> renumberBreadthFirst(
	SurfaceMesh& mesh, const Progress& progress = Progress())
{
	Numbering number = breadthFirstOrder(mesh, {}, progress.part(0, 0.5));
	mesh = mesh.renumbered(number.vertex, number.face, {}, progress.part(0.5, 1));
	return std::move(number.vertex);
}

/**
 * Seeds for breadthFirstOrder() that depend on the positions of the vertices only: of each
 * component the half-edge from the vertex with the smallest coordinates (x before y before z) to
 * its neighbour with the smallest.
 * @param component of each vertex slot, see connectedComponents().
 * @param placeOf   Point3d(vertex): the coordinates that count.
 * @throws Cancelled. Complexity: O(V).
 */
template <class PlaceOf>
std::vector<int> minHalfEdges(const SurfaceMesh& mesh, const std::vector<int>& component,
	int components, PlaceOf&& placeOf, const Progress& progress = Progress())
{
	const auto before = [](const Point3d& p, const Point3d& q) {
		return p[0] != q[0] ? p[0] < q[0] : p[1] != q[1] ? p[1] < q[1] : p[2] < q[2];
	};
	std::vector<int> minimum(components, -1);
	std::vector<Point3d> minPlace(components);
	detail::reportedLoop(mesh.vertexSlots(), progress, "Ordering the surface", [&](int v) {
		if (!mesh.isVertex(v))
			return;
		const int c = component[v];
		const Point3d place = placeOf(v);
		if (minimum[c] < 0 || before(place, minPlace[c])) {
			minimum[c] = v;
			minPlace[c] = place;
		}
	});
	for (int& seed : minimum) {
		int best = mesh.outgoing(seed);
		mesh.forEachOutgoing(seed, [&](int h) {
			if (before(placeOf(mesh.target(h)), placeOf(mesh.target(best))))
				best = h;
		});
		seed = best;
	}
	return minimum;
}

/// The entries of `ofVertex`, one for each vertex slot, in the new order of `count` vertices.
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
