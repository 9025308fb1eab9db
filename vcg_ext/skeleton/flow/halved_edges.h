// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Coarse surfaces are made fine enough for the flow: their long edges are halved.

#ifndef VCG_MCF_HALVED_EDGES_H
#define VCG_MCF_HALVED_EDGES_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <vector>

namespace vcg::tri::mcf {

/// Edges up to this many epsilon are short enough for the flow.
constexpr double longOfEpsilon = 20;
/// Edges of coarse components are halved until none is longer than this many epsilon.
constexpr double fineOfEpsilon = 8;

namespace detail {

/// The epsilon of these lengths, at least the default: a smaller one does not make more vertices.
inline double epsilonOfEdges(double epsilon)
{
	return std::max(epsilon, Parameters().epsilon);
}

} // namespace detail

/**
 * Detects components sampled too coarsely for the flow, whose curve would leave the shape or shrink
 * to a point: more than 25 % of the area is in triangles with an edge longer than 20 epsilon and
 * than the local thickness, the mean radius of the inscribed medial balls at the corners. A few
 * long edges do no harm, and a round body needs no more vertices than show its form. Where no
 * radius is known, the edges alone count.
 *
 * @param radius    of the inner medial ball at each vertex, -1 where it has none; empty: the edges
 *                  alone decide, which finds all coarse components, and perhaps others.
 * @return 1 for each coarse component. @pre mesh is compact. @throws Cancelled. Complexity: O(F).
 */
inline std::vector<char> coarseComponents(const MeasuredSurface& surface, double epsilon,
	const std::vector<double>& radius = {}, const Progress& progress = Progress())
{
	constexpr double coarsePart = 0.25;
	const SurfaceMesh& mesh = surface.mesh();
	const auto thickness = [&](const Triangle& t) {
		double sum = 0;
		int known = 0;
		for (int v : t)
			if (!radius.empty() && radius[v] >= 0) {
				sum += radius[v];
				++known;
			}
		return known ? sum / known : 0;
	};
	std::vector<double> fine;
	for (int c = 0; c < surface.components(); ++c)
		fine.push_back(longOfEpsilon * detail::epsilonOfEdges(epsilon) * surface.diagonal(c));
	std::vector<double> coarseArea(fine.size(), 0);
	detail::reportedLoop(mesh.faceSlots(), progress, "Measuring the surface", [&](int f) {
		const Triangle t = mesh.triangle(f);
		const int c = surface.component()[t[0]];
		const double length2 = std::max({mesh.squaredLength(3 * f), mesh.squaredLength(3 * f + 1),
			mesh.squaredLength(3 * f + 2)});
		if (length2 > fine[c] * fine[c] && length2 > thickness(t) * thickness(t))
			coarseArea[c] += mesh.doubleAreaVector(f).Norm() / 2;
	});
	std::vector<char> coarse;
	for (int c = 0; c < surface.components(); ++c)
		coarse.push_back(coarseArea[c] > coarsePart * surface.area(c));
	return coarse;
}

/**
 * The longest edges allowed in each component: 8 epsilon where it is coarse, as on a resampled
 * surface (see defaultTargetLength()), else unbounded.
 *
 * An epsilon below the default counts as the default, so that it does not decide the number of
 * vertices. So that a scene of many coarse bodies stays workable, the lengths are raised, all by
 * the same factor, where a quarter of a million vertices would be exceeded.
 * @param coarse see coarseComponents().
 * @return a length for each component, mesh units; infinite for one that is fine enough.
 */
inline std::vector<double> longestEdgesForFlow(
	const MeasuredSurface& surface, const std::vector<char>& coarse, double epsilon)
{
	constexpr double maxVertices = 2.5e5;
	// Of area / length^2: halving leaves edges between half the length and the length.
	constexpr double verticesOfArea = 3.5;
	std::vector<double> longest(coarse.size(), std::numeric_limits<double>::infinity());
	double expected = 0;
	for (int c = 0; c < surface.components(); ++c)
		if (coarse[c]) {
			longest[c] = fineOfEpsilon * detail::epsilonOfEdges(epsilon) * surface.diagonal(c);
			expected += verticesOfArea * surface.area(c) / (longest[c] * longest[c]);
		}
	if (expected > maxVertices)
		for (double& length : longest)
			length *= std::sqrt(expected / maxVertices);
	return longest;
}

/**
 * Halves long edges, the longest first, until none is longer than the limit of its component. The
 * shape is the same. Its vertices keep their ids; the middles of edges follow.
 *
 * Halving a triangle's longest edge, again and again, leaves no angle below half of its smallest
 * one (Rosenberg and Stenger, "A lower bound on the angles of triangles constructed by bisecting
 * the longest side", Mathematics of Computation 29, 1975).
 *
 * Lengths are compared in the shape's own coordinates, see PrincipalFrame; of edges of the same
 * length the one whose middle has the larger coordinates there comes first. So the order depends
 * neither on the numbering nor on the place of the shape.
 *
 * @param longest the limit for each component, mesh units, > 0.
 * @return a compact mesh. @pre the surface is compact.
 * @throws Cancelled. Complexity: O((F + s) log (F + s)) for s new vertices.
 */
inline SurfaceMesh withHalvedEdges(const MeasuredSurface& surface,
	const std::vector<double>& longest, const Progress& progress = Progress())
{
	constexpr int reportEvery = 1 << 14;
	const char* const what = "Halving long edges";
	const Progress begin = progress.cancelOnly();
	SurfaceMesh mesh = surface.mesh().copied(begin);
	std::vector<int> component = surface.component();
	std::vector<Point3d> inside =
		detail::filledArray(mesh.position.size(), Point3d(0, 0, 0), begin);
	detail::reportedLoop(mesh.vertexSlots(), begin, what,
		[&](int v) { inside[v] = surface.frame(component[v]).onGrid(mesh.position[v]); });
	std::vector<double> limit;
	for (int c = 0; c < surface.components(); ++c)
		limit.push_back(surface.frame(c).lengthOnGrid(longest[c]));

	// Squared length, middle, half-edge and its ends, which a split may have changed since.
	using Entry = std::tuple<double, double, double, double, int, int, int>;
	std::priority_queue<Entry> queue;
	const auto push = [&](int h) {
		const int a = mesh.origin(h), b = mesh.target(h);
		const double length2 = SquaredDistance(inside[a], inside[b]);
		if (length2 <= limit[component[a]] * limit[component[a]])
			return;
		const Point3d middle = (inside[a] + inside[b]) / 2;
		queue.emplace(length2, middle[0], middle[1], middle[2], h, a, b);
	};
	detail::reportedLoop(mesh.halfEdgeSlots(), begin, what, [&](int h) {
		if (mesh.isEdge(h))
			push(h);
	});
	for (int count = 0; !queue.empty(); ++count) {
		if (count % reportEvery == 0)
			progress.report(0, what);
		const auto [length2, x, y, z, h, a, b] = queue.top();
		queue.pop();
		if (mesh.origin(h) != a || mesh.target(h) != b)
			continue;
		const int middle = mesh.split(h, (mesh.position[a] + mesh.position[b]) / 2);
		inside.push_back(Point3d(x, y, z));
		component.push_back(component[a]);
		mesh.forEachOutgoing(middle, [&](int e) {
			push(e);
			push(SurfaceMesh::next(e));
		});
	}
	mesh.compact(progress.cancelOnly());
	progress.report(1, what);
	return mesh;
}

} // namespace vcg::tri::mcf

#endif
