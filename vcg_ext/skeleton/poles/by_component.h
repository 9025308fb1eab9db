// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Values of vertices that are computed from their poles, component by component.

#ifndef VCG_MCF_BY_COMPONENT_H
#define VCG_MCF_BY_COMPONENT_H

#include "pole_set.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * The values of find(mesh, poles, progress), called for each component alone; small components are
 * visited in parallel, so it must not change shared state.
 * @return one value for each vertex.
 * @pre mesh is compact. @throws Cancelled, and what find() throws.
 */
template <class Find>
std::vector<double> foundByComponent(
	const SurfaceMesh& mesh, const PoleSet& poles, const Progress& progress, const Find& find)
{
	int components = 0;
	const std::vector<int> component =
		connectedComponents(mesh, &components, progress.part(0, 0.02));
	const Progress finding = progress.part(0.02, 1);
	if (components == 1)
		return find(mesh, poles, finding);
	std::vector<double> values = filledArray(component.size(), 0.0, finding);
	forEachComponent(mesh, component, components, finding,
		[&](int, const SurfaceMesh& own, const std::vector<int>& ids, const Progress& part) {
			PoleSet polesOfOwn;
			cancellableLoop(int(ids.size()), part, [&](int i) {
				polesOfOwn.centre.push_back(poles.centre[ids[i]]);
				polesOfOwn.radius.push_back(poles.radius[ids[i]]);
			});
			const std::vector<double> found = find(own, polesOfOwn, part);
			cancellableLoop(int(ids.size()), part, [&](int i) { values[ids[i]] = found[i]; });
		});
	return values;
}

} // namespace detail

} // namespace vcg::tri::mcf

#endif
