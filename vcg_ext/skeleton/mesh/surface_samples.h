// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Points spread evenly over a surface and in a box, the same in every run.

#ifndef VCG_MCF_SURFACE_SAMPLES_H
#define VCG_MCF_SURFACE_SAMPLES_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * The i-th point of a low-discrepancy sequence in the unit cube, every stretch of which covers the
 * cube evenly: multiples of the powers of 1 / g modulo 1, where g^(N + 1) = g + 1.
 */
template <size_t N>
std::array<double, N> evenPoint(size_t i)
{
	double g = 1.5;
	for (int k = 0; k < 60; ++k)
		g = std::pow(1 + g, 1.0 / (N + 1));
	std::array<double, N> point;
	double step = 1;
	for (double& x : point) {
		step /= g;
		const double y = 0.5 + step * double(i + 1);
		x = y - std::floor(y);
	}
	return point;
}

} // namespace detail

/// A point of a surface and the face that it is on.
struct SurfaceSample
{
	Point3d position;
	int face;
};

/**
 * `count` points of a surface: each run of consecutive faces gets its share by area, within one.
 * @pre surface is compact and has an area. @throws Cancelled. Complexity: O(F + count).
 */
inline std::vector<SurfaceSample> surfaceSamples(
	const SurfaceMesh& surface, int count, const Progress& progress = Progress())
{
	const double total = surface.area(progress.part(0, 0.5));
	std::vector<SurfaceSample> samples;
	samples.reserve(count);
	int face = -1;
	double upToHere = 0;
	detail::Ticker ticker(
		progress.part(0.5, 1), "Sampling the surface", surface.faceSlots() + count);
	for (int i = 0; i < count; ++i) {
		ticker.tick();
		const double at = (i + 0.5) / count * total;
		while (upToHere <= at && face + 1 < surface.faceSlots()) {
			ticker.tick();
			upToHere += surface.doubleAreaVector(++face).Norm() / 2;
		}
		const auto [x, y] = detail::evenPoint<2>(size_t(i));
		const double u = std::sqrt(x);
		const Triangle t = surface.triangle(face);
		samples.push_back({surface.position[t[0]] * (1 - u) + surface.position[t[1]] * (u * (1 - y))
				+ surface.position[t[2]] * (u * y),
			face});
	}
	return samples;
}

} // namespace vcg::tri::mcf

#endif
