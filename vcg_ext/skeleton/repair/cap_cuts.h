// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Flat caps for openings cut by a plane, such as the bottom of a scanned statue.

#ifndef VCG_MCF_CAP_CUTS_H
#define VCG_MCF_CAP_CUTS_H

#include "fill_holes.h"

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/spatial/triangle_tree.h>

#include <vcg/math/base.h>
#include <vcg/space/point2.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Which openings count as cut by a plane.
struct CutLimits
{
	/// Largest distance of the border from its plane, the smaller of both: in mean border edges,
	/// since whole faces are cut away; and as a fraction of the square root of the cap's area,
	/// which decides where faces are large.
	double edges = 2, flat = 0.1;
	/// Smallest ratio of a piece's area to that of its caps; below, caps would only double a sheet.
	double surface = 1.1;
	/// Largest part of a cap that may cross the surface: at the teeth of a jagged border.
	double crossing = 0.01;
	/// Caps below this part of the piece's area are holes, not cuts.
	double minimum = 0.003;
	/// Largest number of border edges; the time grows with its square.
	int maximum = 10000;
};

namespace detail {

/// Triangulates a counter-clockwise polygon in the plane by ear clipping, the ear with the shortest
/// new edge first. @param allowed  allowed(i, k): whether corners i and k may be joined by an edge.
/// @return nothing if no ear is left, as in a polygon that crosses itself.
/// @throws Cancelled. Complexity: O(n^2) for n corners.
template <class Allowed>
std::optional<std::vector<Triangle>> clippedEars(const std::vector<Point2d>& p,
	const Allowed& allowed, const Cancellation& cancel = Cancellation())
{
	constexpr double never = std::numeric_limits<double>::infinity();
	const int n = int(p.size());
	std::vector<int> before(size_t(n), 0), after(size_t(n), 0);
	for (int i = 0; i < n; ++i) {
		before[size_t(i)] = (i + n - 1) % n;
		after[size_t(i)] = (i + 1) % n;
	}
	const auto leftTurn = [&](int a, int b, int c) {
		return (p[size_t(b)] - p[size_t(a)]) ^ (p[size_t(c)] - p[size_t(a)]);
	};
	// An ear contains no other corner, not even on its sides: that would be cut off.
	int left = n;
	const auto cost = [&](int i) {
		const int a = before[size_t(i)], c = after[size_t(i)];
		if (!(leftTurn(a, i, c) > 0))
			return never;
		if (left == 3)
			return 0.0;
		if (!allowed(a, c))
			return never;
		for (int j = after[size_t(c)]; j != a; j = after[size_t(j)])
			if (leftTurn(a, i, j) >= 0 && leftTurn(i, c, j) >= 0 && leftTurn(c, a, j) >= 0
				&& p[size_t(j)] != p[size_t(a)] && p[size_t(j)] != p[size_t(i)]
				&& p[size_t(j)] != p[size_t(c)])
				return never;
		return (p[size_t(c)] - p[size_t(a)]).SquaredNorm();
	};
	std::vector<double> costs;
	for (int i = 0; i < n; ++i) {
		cancel.check();
		costs.push_back(cost(i));
	}
	std::vector<Triangle> triangles;
	while (left >= 3) {
		cancel.check();
		const int ear = int(std::min_element(costs.begin(), costs.end()) - costs.begin());
		if (costs[size_t(ear)] == never)
			return std::nullopt;
		const int a = before[size_t(ear)], c = after[size_t(ear)];
		triangles.push_back({a, ear, c});
		after[size_t(a)] = c;
		before[size_t(c)] = a;
		--left;
		costs[size_t(ear)] = never;
		costs[size_t(a)] = cost(a);
		costs[size_t(c)] = cost(c);
	}
	return triangles;
}

/// A closed polygon, each corner moved halfway to the mean of its neighbours in each round.
inline std::vector<Point2d> smoothed(std::vector<Point2d> polygon, int rounds)
{
	const size_t n = polygon.size();
	for (int round = 0; round < rounds; ++round) {
		const std::vector<Point2d> before = polygon;
		for (size_t i = 0; i < n; ++i)
			polygon[i] = (before[(i + n - 1) % n] + before[i] * 2.0 + before[(i + 1) % n]) / 4.0;
	}
	return polygon;
}

/// Whether a point is inside a polygon in the plane.
inline bool isInPolygon(const Point2d& q, const std::vector<Point2d>& polygon)
{
	bool inside = false;
	for (size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
		const Point2d &a = polygon[i], &b = polygon[k];
		if ((a[1] > q[1]) != (b[1] > q[1])
			&& q[0] < a[0] + (b[0] - a[0]) * (q[1] - a[1]) / (b[1] - a[1]))
			inside = !inside;
	}
	return inside;
}

/// A border that may be cut by a plane, and that plane, fitted to it. Mesh units.
struct PlaneCut
{
	BorderPolygon border;
	Point3d centre = Point3d(0, 0, 0), normal; ///< of the cap
	Point3d x, y;                              ///< axes of the plane
	double area = 0, tolerance = 0;

	PlaneCut(const std::vector<Point3d>& points, BorderPolygon of, const CutLimits& limits) :
			border(std::move(of))
	{
		const std::vector<Point3d>& p = border.points;
		double length = 0;
		for (const Point3d& q : p)
			centre += q / double(p.size());
		for (size_t i = 0; i < p.size(); ++i)
			length += Distance(p[i], p[(i + 1) % p.size()]) / double(p.size());
		normal = areaVector(points, border.corners, centre);
		area = normal.Norm();
		if (area > 0)
			normal /= area;
		vcg::GetUV(normal, x, y);
		if (((x ^ y) * normal) < 0)
			std::swap(x, y);
		tolerance = std::min(limits.edges * length, limits.flat * std::sqrt(area));
	}

	double height(const Point3d& q) const { return (q - centre) * normal; }
	Point2d inPlane(const Point3d& q) const { return {(q - centre) * x, (q - centre) * y}; }

	bool isFlat() const
	{
		return area > 0
			&& std::all_of(border.points.begin(), border.points.end(),
				[&](const Point3d& q) { return std::abs(height(q)) <= tolerance; });
	}
};

} // namespace detail

/**
 * Closes openings cut by a plane with flat caps: those whose border lies in a plane that has all of
 * the piece of surface on one side. An opening stays open if another border lies within it, as
 * where a thick wall is cut, or if its cap would cross the surface.
 * @param triangles coherently oriented, parted by partSurface(); get the caps at their end.
 * @param partner   as PartedSurface has it.
 * @return the number of openings closed.
 * @throws Cancelled. Complexity: O(F log F), and O(f + n (n + b)) for a border of n edges in a piece
 * of f faces, with b vertices of borders in its box.
 */
inline int capCuts(const std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const CutLimits& limits = CutLimits(),
	const Progress& progress = Progress())
{
	using namespace detail;
	const Progress cancel = progress.cancelOnly();
	const std::vector<std::vector<int>> loops = holeLoops(points, triangles, partner, cancel);
	if (loops.empty())
		return 0;
	const std::vector<int> piece = pieceOfFaces(partner, cancel);
	const std::vector<double> area = areaOfPieces(points, triangles, piece, cancel);
	std::vector<double> capped(piece.size(), 0);
	std::vector<PlaneCut> cuts;
	for (const std::vector<int>& loop : loops) {
		const int n = int(loop.size());
		if (n < 3 || n > limits.maximum)
			continue;
		PlaneCut cut(points, borderPolygon(points, triangles, piece, loop), limits);
		if (cut.border.pieces.size() == 1
			&& cut.area >= limits.minimum * area[size_t(*cut.border.pieces.begin())]
			&& cut.isFlat())
			cuts.push_back(std::move(cut));
	}
	if (cuts.empty())
		return 0;
	const std::vector<char> onBorder = borderVertices(points.size(), triangles, partner, cancel);
	std::set<std::pair<int, int>> edges = edgesBetween(triangles, onBorder, cancel);
	const std::vector<Triangle> given = copiedArray(triangles, cancel);
	const TriangleTree tree(points, given, progress.part(0, 0.3));
	std::vector<Triangle> borderPoints; // as triangles, to be searched by boxes
	for (int v = 0; v < int(points.size()); ++v)
		if (onBorder[size_t(v)])
			borderPoints.push_back({v, v, v});
	const TriangleTree borders(points, borderPoints, cancel);
	std::vector<std::pair<int, int>> byPiece; // piece and face
	byPiece.reserve(given.size());
	cancellableLoop(
		int(given.size()), cancel, [&](int f) { byPiece.emplace_back(piece[size_t(f)], f); });
	sortCancellable(byPiece, 0, byPiece.size(), cancel);
	const Progress capping = progress.part(0.3, 1);
	int closed = 0;
	for (size_t i = 0; i < cuts.size(); ++i) {
		capping.report(double(i) / double(cuts.size()), "Capping cuts");
		const PlaneCut& cut = cuts[i];
		const int ofCut = *cut.border.pieces.begin();
		const size_t whose = size_t(ofCut);
		double lowest = 0, highest = 0;
		const auto begin = std::lower_bound(byPiece.begin(), byPiece.end(), std::pair(ofCut, 0));
		const auto end = std::lower_bound(begin, byPiece.end(), std::pair(ofCut + 1, 0));
		cancellableLoop(int(end - begin), cancel, [&](int k) {
			for (int v : given[size_t(begin[k].second)]) {
				const double height = cut.height(points[size_t(v)]);
				lowest = std::min(lowest, height);
				highest = std::max(highest, height);
			}
		});
		if (std::min(highest, -lowest) > cut.tolerance
			|| area[whose] < limits.surface * (capped[whose] + cut.area))
			continue;
		std::vector<Point2d> polygon;
		Box3d around;
		for (const Point3d& q : cut.border.points) {
			polygon.push_back(cut.inPlane(q));
			around.Add(q);
		}
		// The border itself may be as far from the plane, on its other side.
		around.Offset(3 * cut.tolerance);
		const std::set<int> own(cut.border.corners.begin(), cut.border.corners.end());
		bool fits = true;
		borders.forEachFaceIn(around, [&](int i) {
			const int v = borderPoints[size_t(i)][0];
			fits = fits
				&& (own.count(v) || std::abs(cut.height(points[size_t(v)])) > cut.tolerance
					|| !isInPolygon(cut.inPlane(points[size_t(v)]), polygon));
		});
		if (!fits)
			continue;
		// Where the surface is steep, the teeth of a jagged border overhang: projected to the plane
		// they cross each other, unless the polygon is smoothed.
		std::optional<std::vector<Triangle>> ears;
		for (int rounds : {0, 2, 8})
			if (!ears)
				ears = clippedEars(
					smoothed(polygon, rounds),
					[&](int a, int b) { return cut.border.mayJoin(a, b, edges); }, cancel);
		if (!ears)
			continue;
		std::vector<Triangle> cap;
		double crossing = 0;
		std::map<std::pair<int, int>, int> uses;
		for (const Triangle& t : *ears) {
			cancel.check();
			cap.push_back(cut.border.triangle(t));
			for (size_t k = 0; k < 3; ++k)
				fits = fits && ++uses[cut.border.edge(t[k], t[(k + 1) % 3])] <= 2;
			if (crossesOthers(tree, given, points, cap.back()))
				crossing += areaVector(points, cap.back()).Norm();
		}
		if (!fits || crossing > limits.crossing * cut.area)
			continue;
		for (const auto& [ends, count] : uses)
			edges.insert(ends);
		triangles.insert(triangles.end(), cap.begin(), cap.end());
		capped[whose] += cut.area;
		++closed;
	}
	return closed;
}

} // namespace vcg::tri::mcf

#endif
