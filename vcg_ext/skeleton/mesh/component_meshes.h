// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The connected components of a surface as meshes of their own.

#ifndef VCG_MCF_COMPONENT_MESHES_H
#define VCG_MCF_COMPONENT_MESHES_H

#include "components.h"
#include "surface_mesh.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The vertices of each component in the order of their ids, and the place of each vertex there.
struct ComponentVertices
{
	std::vector<std::vector<int>> ids;
	std::vector<int> place;

	/// @param component of each vertex, from 0 to components - 1. @throws Cancelled
	ComponentVertices(const std::vector<int>& component, int components, const Progress& progress) :
			ids(components)
	{
		place.reserve(component.size());
		detail::reportedLoop(int(component.size()), progress, "Measuring the surface", [&](int v) {
			std::vector<int>& own = ids[component[v]];
			place.push_back(int(own.size()));
			own.push_back(v);
		});
	}
};

/// The surface of some components as arrays of their own.
struct ComponentSurface
{
	std::vector<Point3d> position;
	std::vector<Triangle> triangles; ///< corners as indices into `position`

	/// @param ids   of the vertices, whole components. @param place  of each of them in `ids`.
	/// @throws Cancelled
	ComponentSurface(const SurfaceMesh& mesh, const std::vector<int>& ids,
		const std::vector<int>& place, const Cancellation& cancel)
	{
		position.reserve(ids.size());
		detail::cancellableLoop(int(ids.size()), cancel, [&](int i) {
			position.push_back(mesh.position[ids[i]]);
			mesh.forEachOwnFace(ids[i], [&](int f) {
				const Triangle t = mesh.triangle(f);
				triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
			});
		});
	}
};

/**
 * Calls visit(c, own, ids, progress) for each connected component c of a mesh: `own` is a mesh of
 * that component alone, its vertices and triangles in the order of `mesh`; `ids` are the ids of its
 * vertices in `mesh`. Large components are visited one after the other, so that each has all cores,
 * then the others, several at once.
 * @param component  of each vertex of the mesh, from 0 to components - 1.
 * @pre mesh is compact; visits share no mutable state.
 * @throws Cancelled, and what visit() throws. Complexity: O(V + F), and the visits.
 */
template <class Visitor>
void forEachComponent(const SurfaceMesh& mesh, const std::vector<int>& component, int components,
	const Progress& progress, const Visitor& visit)
{
	constexpr size_t large = 1 << 13;
	const char* const what = "Measuring the surface";
	const Progress begin = progress.cancelOnly();
	const ComponentVertices vertices(component, components, begin);
	const std::vector<std::vector<int>>& ids = vertices.ids;
	const std::vector<int>& place = vertices.place;
	std::vector<std::vector<Triangle>> triangles(components);
	detail::reportedLoop(mesh.faceSlots(), begin, what, [&](int f) {
		const Triangle t = mesh.triangle(f);
		triangles[component[t[0]]].push_back({place[t[0]], place[t[1]], place[t[2]]});
	});
	const auto visitOne = [&](int c, const Progress& part) {
		std::vector<Point3d> position;
		position.reserve(ids[c].size());
		detail::cancellableLoop(
			int(ids[c].size()), part, [&](int i) { position.push_back(mesh.position[ids[c][i]]); });
		const SurfaceMesh own(std::move(position), triangles[c], part.cancelOnly());
		visit(c, own, ids[c], part);
	};
	const double all = mesh.vertexSlots();
	int done = 0;
	std::vector<int> small, start(1, 0); // the vertices of the small ones, as parts of a range
	for (int c = 0; c < components; ++c) {
		const int size = int(ids[c].size());
		if (ids[c].size() < large) {
			small.push_back(c);
			start.push_back(start.back() + size);
			continue;
		}
		visitOne(c, progress.part(done / all, (done + size) / all));
		done += size;
	}
	if (!small.empty())
		forEachPart(
			start, progress.part(done / all, 1), what, [&](int first, int, const Progress& part) {
				const auto at = std::lower_bound(start.begin(), start.end(), first);
				visitOne(small[size_t(at - start.begin())], part);
			});
}

} // namespace vcg::tri::mcf

#endif
