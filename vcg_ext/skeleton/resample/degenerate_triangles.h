// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Triangles without area: found, and removed without moving the surface.

#ifndef VCG_MCF_DEGENERATE_TRIANGLES_H
#define VCG_MCF_DEGENERATE_TRIANGLES_H

#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace vcg::tri::mcf {

namespace detail {

/// A triangle is thin if its smallest height is at most this part of both its longest edge and the
/// given length.
constexpr double thinness = 1e-3;

inline bool isThin(const Point3d& a, const Point3d& b, const Point3d& c, double length)
{
	const double longest =
		std::max({SquaredDistance(a, b), SquaredDistance(b, c), SquaredDistance(c, a)});
	// height = |(b - a) x (c - a)| / longest edge
	return ((b - a) ^ (c - a)).SquaredNorm()
		<= thinness * thinness * longest * std::min(longest, length * length);
}

/// The half-edge of triangle f that is the minimum by `less`, which compares squared lengths.
template <class Less>
int extremeEdge(const SurfaceMesh& mesh, int f, Less&& less)
{
	int best = 3 * f;
	for (int h = 3 * f + 1; h < 3 * f + 3; ++h)
		if (less(mesh.squaredLength(h), mesh.squaredLength(best)))
			best = h;
	return best;
}

/// Whether flipping h, the longest edge of a thin triangle, is an improvement: the new edge is
/// shorter, so that flips come to an end, or neither of the two new triangles is thin.
inline bool flipCuresCap(const SurfaceMesh& mesh, int h, double length)
{
	const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
	const Point3d &c = mesh.position[mesh.apex(h)], &d = mesh.position[mesh.apex(mesh.twin(h))];
	return SquaredDistance(c, d) < SquaredDistance(a, b)
		|| !(isThin(d, c, a, length) || isThin(c, d, b, length));
}

} // namespace detail

/**
 * Removes triangles whose height is below 1/1000 of their longest edge and of lengthAt(vertex):
 * needles by merging the ends of their shortest edge, caps by flipping their longest edge. They
 * have no reliable normal and stop every walk over the surface. The surface moves by no more than
 * their heights and shortest edges, the topology stays.
 *
 * @param mesh     changes in place; its numbering keeps holes.
 * @param lengthAt double(vertex): the target length there, mesh units.
 * @return how many thin triangles are left, which neither a merge nor a flip can remove.
 * @throws Cancelled
 * Complexity: O(F) if there are few of them.
 */
template <class LengthAt>
int removeThinTriangles(
	SurfaceMesh& mesh, LengthAt&& lengthAt, const Progress& progress = Progress())
{
	constexpr int rounds = 20;
	int left = 0;
	for (int round = 0; round < rounds; ++round) {
		left = 0;
		bool changed = false;
		const auto treat = [&](int f) {
			if (!mesh.isFace(f))
				return;
			const Triangle t = mesh.triangle(f);
			const double length = lengthAt(t[0]);
			if (!detail::isThin(
					mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]], length))
				return;
			++left;
			const int shortest = detail::extremeEdge(mesh, f, std::less<double>());
			const int longest = detail::extremeEdge(mesh, f, std::greater<double>());
			const double matters = std::min(std::sqrt(mesh.squaredLength(longest)), length);
			if (std::sqrt(mesh.squaredLength(shortest)) <= 2 * detail::thinness * matters) {
				if (!mesh.isCollapsible(shortest))
					return;
				mesh.collapse(shortest);
			}
			else {
				if (!detail::flipCuresCap(mesh, longest, length) || !mesh.isFlippable(longest))
					return;
				mesh.flip(longest);
			}
			changed = true;
		};
		detail::reportedLoop(mesh.faceSlots(),
			progress.part(double(round) / rounds, double(round + 1) / rounds),
			"Removing thin triangles", treat);
		if (!changed)
			break;
	}
	return left;
}

} // namespace vcg::tri::mcf

#endif
