// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Triangles without area: found, and removed without moving the surface.

#ifndef VCG_MCF_THIN_TRIANGLES_H
#define VCG_MCF_THIN_TRIANGLES_H

#include "surface_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// A triangle is thin if its least height is below this part of both its longest edge and the
/// length that matters there.
constexpr double thinness = 1e-3;

/// Whether triangle f is thin where edges of `length` matter; `longest` becomes its longest
/// half-edge and `shortest` its shortest one.
inline bool isThin(const SurfaceMesh& mesh, int f, double length, int& shortest, int& longest)
{
	std::array<double, 3> squared;
	for (int k = 0; k < 3; ++k)
		squared[k] = mesh.squaredLength(3 * f + k);
	shortest = int(std::min_element(squared.begin(), squared.end()) - squared.begin());
	longest = int(std::max_element(squared.begin(), squared.end()) - squared.begin());
	// height = 2 area / longest edge
	const double limit =
		thinness * thinness * squared[longest] * std::min(squared[longest], length * length);
	shortest += 3 * f;
	longest += 3 * f;
	return mesh.areaVector(f).SquaredNorm() <= limit;
}

} // namespace detail

/**
 * Removes triangles whose height is below 1/1000 of their longest edge and of lengthAt(vertex):
 * needles by merging the ends of their shortest edge, caps by flipping their longest edge. They
 * have no normal to speak of and stop every walk over the surface. The surface moves by no more
 * than their heights and shortest edges, the topology stays.
 *
 * @param mesh     changes in place; its numbering keeps holes.
 * @param lengthAt double(vertex): the length that matters there, mesh units.
 * @return how many thin triangles are left, where the topology or a fold allows no more.
 * Complexity: O(F) if there are few of them.
 */
template <class LengthAt>
int removeThinTriangles(SurfaceMesh& mesh, LengthAt&& lengthAt)
{
	constexpr int rounds = 20;
	int left = 0;
	for (int round = 0; round < rounds; ++round) {
		left = 0;
		bool changed = false;
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			int shortest, longest;
			if (!mesh.isFace(f)
				|| !detail::isThin(mesh, f, lengthAt(mesh.origin(3 * f)), shortest, longest))
				continue;
			++left;
			const double length =
				std::min(std::sqrt(mesh.squaredLength(longest)), lengthAt(mesh.origin(longest)));
			if (std::sqrt(mesh.squaredLength(shortest)) <= 2 * detail::thinness * length) {
				if (!mesh.isCollapsible(shortest))
					continue;
				mesh.collapse(shortest);
			}
			else {
				// Each flip shortens an edge: this ends.
				const double other = SquaredDistance(mesh.position[mesh.apex(longest)],
					mesh.position[mesh.apex(mesh.twin(longest))]);
				if (other >= mesh.squaredLength(longest) || !mesh.isFlippable(longest))
					continue;
				mesh.flip(longest);
			}
			changed = true;
		}
		if (!changed)
			break;
	}
	return left;
}

} // namespace vcg::tri::mcf

#endif
