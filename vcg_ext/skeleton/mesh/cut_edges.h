// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Long edges are cut into pieces, and triangles along them into strips: the same shape.

#ifndef VCG_MCF_CUT_EDGES_H
#define VCG_MCF_CUT_EDGES_H

#include "measured_surface.h"
#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The number of pieces into which an edge is cut whose limits at its ends are `one` and `other`,
/// and grow evenly in between: the integral of 1 / limit along it, rounded up.
inline double piecesOfEdge(double length, double one, double other)
{
	constexpr double alike = 1e-6;
	const double growth = other - one;
	const double exact =
		std::abs(growth) < alike * one ? length / one : length / growth * std::log(other / one);
	return std::max(1.0, std::ceil(exact));
}

namespace detail {

/// Cuts edges, then divides the triangles: see withCutEdges().
class EdgeCutter
{
public:
	EdgeCutter(const MeasuredSurface& surface, const std::vector<double>& longest) :
			surface(surface), mesh(surface.mesh()), longest(longest), points(mesh.position)
	{
	}

	SurfaceMesh run(const Progress& progress)
	{
		inside.reserve(points.size());
		reportedLoop(mesh.vertexSlots(), progress.part(0, 0.1), what,
			[&](int v) { inside.push_back(onGrid(points[v], v)); });
		firstOfEdge.assign(size_t(mesh.halfEdgeSlots()), -1);
		piecesOf.assign(size_t(mesh.halfEdgeSlots()), 1);
		reportedLoop(mesh.halfEdgeSlots(), progress.part(0.1, 0.3), what, [&](int h) {
			if (mesh.isEdge(h))
				cut(h);
		});
		reportedLoop(mesh.faceSlots(), progress.part(0.3, 0.7), what, [&](int f) { divide(f); });
		return SurfaceMesh(std::move(points), triangles, progress.part(0.7, 1));
	}

private:
	static constexpr const char* what = "Cutting long edges";
	/// A place on the boundary of a triangle: its vertex, and a bit for each edge that it is on.
	struct Place
	{
		int vertex;
		unsigned edges;
	};

	const MeasuredSurface& surface;
	const SurfaceMesh& mesh;
	const std::vector<double>& longest;
	std::vector<Point3d> points, inside; ///< mesh units; on the grid of the component's frame
	std::vector<int> firstOfEdge;        ///< new vertices, from the origin of this half-edge on
	std::vector<int> piecesOf;           ///< of the edge of a half-edge
	std::vector<Triangle> triangles;

	Point3d onGrid(const Point3d& p, int vertex) const
	{
		return surface.frame(surface.component()[vertex]).onGrid(p);
	}

	void cut(int h)
	{
		int a = mesh.origin(h), b = mesh.target(h);
		// From the end that the numbering does not decide.
		if (std::make_pair(longest[b], inside[b]) < std::make_pair(longest[a], inside[a])) {
			h = mesh.twin(h);
			std::swap(a, b);
		}
		const double one = longest[a], other = longest[b];
		const double pieces = piecesOfEdge(Distance(points[a], points[b]), one, other);
		piecesOf[h] = piecesOf[mesh.twin(h)] = int(pieces);
		firstOfEdge[h] = int(points.size());
		const double ratio = other / one;
		for (int k = 1; k < int(pieces); ++k) {
			const double s = k / pieces;
			// Where the integral of 1 / limit is the part s of the whole.
			const double t = ratio - 1 < 1e-6 ? s : (std::pow(ratio, s) - 1) / (ratio - 1);
			points.push_back(points[a] + (points[b] - points[a]) * t);
			inside.push_back(onGrid(points.back(), a));
		}
	}

	/// The places on the boundary of a triangle, in its direction.
	std::vector<Place> boundaryOf(int f) const
	{
		std::vector<Place> boundary;
		for (int k = 0; k < 3; ++k) {
			const int h = 3 * f + k;
			boundary.push_back({mesh.origin(h), 1U << k | 1U << (k + 2) % 3});
			const bool isForward = firstOfEdge[h] >= 0;
			const int first = isForward ? firstOfEdge[h] : firstOfEdge[mesh.twin(h)];
			const int count = piecesOf[h] - 1;
			for (int i = 0; i < count; ++i)
				boundary.push_back({first + (isForward ? i : count - 1 - i), 1U << k});
		}
		return boundary;
	}

	/**
	 * Cuts corners off, those with the shortest cuts first. No cut joins two places of one edge:
	 * what is left always has an area. Ties are decided by places, not by the numbering.
	 */
	void divide(int f)
	{
		if (!mesh.isFace(f))
			return;
		const std::vector<Place> boundary = boundaryOf(f);
		const int count = int(boundary.size());
		if (count == 3) {
			triangles.push_back(mesh.triangle(f));
			return;
		}
		std::vector<int> before(boundary.size()), after(boundary.size());
		for (int i = 0; i < count; ++i) {
			before[i] = (i + count - 1) % count;
			after[i] = (i + 1) % count;
		}
		// Squared length of the cut, its lower and its upper end; the place, its neighbours then.
		using Entry =
			std::tuple<double, std::array<double, 3>, std::array<double, 3>, int, int, int>;
		std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
		const auto push = [&](int i) {
			const Place &p = boundary[before[i]], &n = boundary[after[i]];
			if (p.edges & n.edges)
				return;
			const Point3d &q = inside[p.vertex], &r = inside[n.vertex];
			std::array<double, 3> low = {q[0], q[1], q[2]}, high = {r[0], r[1], r[2]};
			if (high < low)
				std::swap(low, high);
			queue.emplace(SquaredDistance(q, r), low, high, i, before[i], after[i]);
		};
		for (int i = 0; i < count; ++i)
			push(i);
		int left = count, last = 0;
		while (left > 3 && !queue.empty()) {
			const auto [length2, low, high, i, p, n] = queue.top();
			queue.pop();
			if (before[i] != p || after[i] != n || after[p] != i)
				continue;
			triangles.push_back({boundary[p].vertex, boundary[i].vertex, boundary[n].vertex});
			after[p] = n;
			before[n] = p;
			after[i] = before[i] = -1;
			--left;
			last = p;
			push(p);
			push(n);
		}
		triangles.push_back(
			{boundary[before[last]].vertex, boundary[last].vertex, boundary[after[last]].vertex});
	}
};

} // namespace detail

/**
 * Cuts edges into pieces no longer than the limits along them, which grow evenly from one end to
 * the other, and divides the triangles by short cuts between the places on their edges. The shape
 * is the same. Its vertices keep their ids; those on edges follow. A long narrow triangle becomes a
 * strip of twice as many triangles as its long edge has pieces; a compact one gets no vertices
 * within, so that some of its cuts stay long.
 *
 * Lengths are compared in the shape's own coordinates, see PrincipalFrame: how triangles are
 * divided depends neither on the numbering nor on the place of the shape.
 *
 * @param longest the limit at each vertex, mesh units, > 0, finite.
 * @return a compact mesh. @pre the surface is compact.
 * @throws Cancelled. Complexity: O(F + s log s) for s new vertices.
 */
inline SurfaceMesh withCutEdges(const MeasuredSurface& surface, const std::vector<double>& longest,
	const Progress& progress = Progress())
{
	return detail::EdgeCutter(surface, longest).run(progress);
}

} // namespace vcg::tri::mcf

#endif
