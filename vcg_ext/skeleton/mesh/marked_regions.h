// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Connected parts of the marked vertices of a mesh, and how large they are.

#ifndef VCG_MCF_MARKED_REGIONS_H
#define VCG_MCF_MARKED_REGIONS_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A third of the area of the triangles at each vertex. @throws Cancelled. Complexity: O(V).
inline std::vector<double> vertexAreas(
	const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	const char* const what = "Measuring the surface";
	std::vector<double> area = detail::filledArray(size_t(mesh.vertexSlots()), 0.0, progress);
	detail::reportedLoop(mesh.faceSlots(), progress, what, [&](int f) {
		if (mesh.isFace(f))
			for (int v : mesh.triangle(f))
				area[v] += mesh.doubleAreaVector(f).Norm() / 6;
	});
	return area;
}

/**
 * The connected parts of the vertices whose mark is `value`, in the order of their lowest vertices.
 * @param marked  0 or 1 for each vertex. @throws Cancelled. Complexity: O(V).
 */
inline std::vector<std::vector<int>> markedParts(const SurfaceMesh& mesh,
	const std::vector<char>& marked, char value = 1, const Progress& progress = Progress())
{
	std::vector<std::vector<int>> parts;
	std::vector<char> seen(marked.size(), 0);
	detail::Ticker ticker(progress, "Looking for sheets", mesh.vertexSlots());
	for (int seed = 0; seed < mesh.vertexSlots(); ++seed) {
		if (seen[seed] || marked[seed] != value || !mesh.isVertex(seed))
			continue;
		std::vector<int> part(1, seed);
		seen[seed] = 1;
		for (size_t i = 0; i < part.size(); ++i) {
			ticker.tick();
			mesh.forEachOutgoing(part[i], [&](int h) {
				const int w = mesh.target(h);
				if (!seen[w] && marked[w] == value) {
					seen[w] = 1;
					part.push_back(w);
				}
			});
		}
		parts.push_back(std::move(part));
	}
	return parts;
}

/// Sum of the areas of the vertices of a part.
inline double areaOf(const std::vector<int>& part, const std::vector<double>& vertexArea)
{
	double sum = 0;
	for (int v : part)
		sum += vertexArea[v];
	return sum;
}

/**
 * Gives each connected part whose mark is `value` the other mark if its area is below `minimum`.
 * @param area       of each vertex, see vertexAreas().
 * @param component  of each vertex.
 * @param minimum    smallest area of a part, for each component.
 * @throws Cancelled
 */
inline void flipSmallParts(const SurfaceMesh& mesh, const std::vector<double>& area,
	const std::vector<int>& component, const std::vector<double>& minimum, char value,
	std::vector<char>& marked, const Progress& progress = Progress())
{
	for (const std::vector<int>& part : markedParts(mesh, marked, value, progress))
		if (areaOf(part, area) < minimum[component[part.front()]])
			for (int v : part)
				marked[v] = !value;
}

} // namespace vcg::tri::mcf

#endif
