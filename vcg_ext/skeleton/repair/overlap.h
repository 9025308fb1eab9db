// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The volume that a closed surface encloses more than once, or inside out.

#ifndef VCG_MCF_OVERLAP_H
#define VCG_MCF_OVERLAP_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/vertical_crossing.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Volumes by winding number, mesh units cubed.
struct WindingVolumes
{
	double once = 0;     ///< where it is at least 1
	double repeated = 0; ///< where it is at least 2
	double negative = 0; ///< where it is below 0

	/// (repeated + negative) / (once + negative), in [0, 1]; 0 if nothing is enclosed.
	double wrongPart() const
	{
		const double all = once + negative;
		return all > 0 ? (repeated + negative) / all : 0;
	}
};

namespace detail {

/// A face that is on the lines of a grid up to the last one.
struct FaceOnLines
{
	int face, last;
};

/**
 * Calls visit(line, faces on it) for each of `lines`, in order, that has any.
 * @param span  of a face: its first and last line; none if the last is before the first.
 * Complexity: O(lines + faces) and the faces that are visited; memory O(lines + faces).
 */
template <class Span, class Visit>
void sweepLines(
	int lines, const std::vector<FaceOnLines>& faces, const Span& span, const Visit& visit)
{
	struct Waiting
	{
		FaceOnLines face;
		int next; ///< that starts on the same line; -1: none
	};
	std::vector<int> starting(size_t(lines), -1);
	std::vector<Waiting> waiting;
	waiting.reserve(faces.size());
	for (const FaceOnLines& each : faces)
		if (const auto [first, last] = span(each.face); first <= last) {
			int& chain = starting[size_t(first)];
			waiting.push_back({{each.face, last}, chain});
			chain = int(waiting.size()) - 1;
		}
	std::vector<FaceOnLines> here;
	for (int line = 0; line < lines; ++line) {
		here.erase(std::remove_if(here.begin(), here.end(),
					   [&](const FaceOnLines& each) { return each.last < line; }),
			here.end());
		for (int w = starting[size_t(line)]; w >= 0; w = waiting[size_t(w)].next)
			here.push_back(waiting[size_t(w)].face);
		if (!here.empty())
			visit(line, here);
	}
}

} // namespace detail

/**
 * Integrates the winding number of a closed, oriented surface along rays parallel to z, one for
 * each cell of a grid over the bounding box in x and y: exactly along each ray.
 * @param across  cells along either side of the grid.
 * @throws Cancelled. Complexity: O(F + n log n) for n pairs of a face and a ray through its box;
 * memory O(F), since only the crossings of one ray are kept.
 */
inline WindingVolumes windingVolumes(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, int across = 128, const Progress& progress = Progress())
{
	const char* const what = "Measuring the volume";
	WindingVolumes volumes;
	Box3d box;
	detail::cancellableLoop(int(triangles.size()), progress, [&](int f) {
		for (int v : triangles[size_t(f)])
			box.Add(points[size_t(v)]);
	});
	const double dx = (box.max[0] - box.min[0]) / across, dy = (box.max[1] - box.min[1]) / across;
	if (triangles.empty() || !(dx > 0) || !(dy > 0))
		return volumes;
	// Rays avoid the middle and the sides of cells, where shapes tend to have vertices and edges.
	constexpr double offset = 0.4637;
	detail::Ticker ticker(progress.cancelOnly(), what, 1);
	// The first and the last ray, or line of rays, that may meet a face.
	const auto spanAlong = [&](int axis, double step) {
		return [&, axis, step](int f) {
			ticker.tick();
			const Triangle& t = triangles[size_t(f)];
			const double p = points[size_t(t[0])][axis], q = points[size_t(t[1])][axis],
						 r = points[size_t(t[2])][axis];
			const auto rays = [&](double x) { return (x - box.min[axis]) / step - offset; };
			return std::pair(std::max(0, int(std::ceil(rays(std::min({p, q, r}))))),
				std::min(across - 1, int(std::floor(rays(std::max({p, q, r}))))));
		};
	};
	const auto column = spanAlong(0, dx), row = spanAlong(1, dy);
	std::vector<detail::FaceOnLines> faces;
	for (int f = 0; f < int(triangles.size()); ++f)
		if (const auto [first, last] = column(f); first <= last)
			if (const auto [low, high] = row(f); low <= high) // of fine meshes few remain
				faces.push_back({f, last});
	std::vector<std::pair<double, int>> crossings; // of a ray: z, and the change of the winding
	const auto addCrossing = [&](int f, double x, double y) {
		const Triangle& t = triangles[size_t(f)];
		const int crossing = detail::verticalCrossing(points, t, x, y);
		if (crossing == 0)
			return;
		if (const auto z = detail::heightOfPlane(points, t, x, y))
			crossings.emplace_back(*z, -crossing);
	};
	const auto addVolumes = [&] {
		std::sort(crossings.begin(), crossings.end());
		int winding = 0;
		for (size_t k = 0; k + 1 < crossings.size(); ++k) {
			winding += crossings[k].second;
			const double volume = (crossings[k + 1].first - crossings[k].first) * dx * dy;
			if (winding >= 1)
				volumes.once += volume;
			if (winding >= 2)
				volumes.repeated += volume;
			if (winding < 0)
				volumes.negative += volume;
		}
	};
	using Faces = std::vector<detail::FaceOnLines>;
	detail::sweepLines(across, faces, column, [&](int i, const Faces& inColumn) {
		progress.report(double(i) / across, what);
		const double x = box.min[0] + (i + offset) * dx;
		detail::sweepLines(across, inColumn, row, [&](int j, const Faces& atRay) {
			const double y = box.min[1] + (j + offset) * dy;
			crossings.clear();
			for (const detail::FaceOnLines& each : atRay) {
				ticker.tick();
				addCrossing(each.face, x, y);
			}
			addVolumes();
		});
	});
	return volumes;
}

} // namespace vcg::tri::mcf

#endif
