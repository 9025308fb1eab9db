// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Connected components of a surface.

#ifndef VCG_MCF_COMPONENTS_H
#define VCG_MCF_COMPONENTS_H

#include "surface_mesh.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#include <vector>

namespace vcg::tri::mcf {

/// For each vertex the number of its connected component, in the order of their lowest vertices; -1
/// for holes in the numbering. @throws Cancelled. Complexity: about O(V + F).
inline std::vector<int> connectedComponents(
	const SurfaceMesh& mesh, int* componentCount = nullptr, const Progress& progress = Progress())
{
	// Sets of vertices that grow face by face, each known by its lowest vertex: this reads the mesh
	// in the order of memory, which a walk over the surface does not.
	const char* const what = "Measuring the surface";
	MergeForest lowest(mesh.vertexSlots(), progress);
	detail::reportedLoop(mesh.faceSlots(), progress.part(0, 0.8), what, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const Triangle t = mesh.triangle(f);
		lowest.join(t[0], t[1]);
		lowest.join(t[1], t[2]);
	});
	const Progress counting = progress.part(0.8, 1);
	std::vector<int> component = detail::filledArray(size_t(mesh.vertexSlots()), -1, counting);
	int count = 0;
	detail::reportedLoop(mesh.vertexSlots(), counting, what, [&](int v) {
		if (!mesh.isVertex(v))
			return;
		const int first = lowest.find(v);
		component[v] = first == v ? count++ : component[first];
	});
	if (componentCount)
		*componentCount = count;
	return component;
}

} // namespace vcg::tri::mcf

#endif
