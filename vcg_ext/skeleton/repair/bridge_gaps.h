// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Limbs that are torn in two, joined by a tube over the gap.

#ifndef VCG_MCF_BRIDGE_GAPS_H
#define VCG_MCF_BRIDGE_GAPS_H

#include "fill_holes.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Which borders are taken for the two sides of one gap.
struct GapLimits
{
	/// How far apart they may be, in mean radii of the two: where the gap parts two pieces, and where it is in one piece.
	double apart = 60, inOnePiece = 3;
	/// And in diagonals of the smaller piece.
	double ofPiece = 3;
	/// Largest angle between the heading of an end and the direction to the other end, degrees.
	double aside = 60;
	/// How much wider one may be than the other.
	double wider = 3;
	/// Corners of a border.
	int edges = 1000;
};

namespace detail {

/// The border of a hole, seen as the end of a limb.
struct LimbEnd
{
	/// Against the faces, in the order of the triangles that go on there.
	std::vector<int> corner;
	/// Of the surface, by its lowest face; the diagonal of its box.
	int piece = 0;
	double pieceDiagonal = 0;
	Point3d centre = Point3d(0, 0, 0);
	/// Of the tube, or of the disc that has the area of the hole.
	double radius = 0;
	/// The way the surface was going where it is cut through, else out of the hole; unit length.
	Point3d heading = Point3d(0, 0, 0);
	/// Whether all around the surface was heading out of the hole: a limb is cut through, not the side of a body open.
	bool isCutThrough = false;
};

/// The axis of the tube that ends at a loop of half-edges: what the normals of the last faces are square to; unit length.
inline Point3d axisBehind(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& partner,
	const std::vector<int>& loop, const LimbEnd& end)
{
	constexpr double reach = 4; // radii from the middle of the border
	Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
	std::set<int> seen;
	std::vector<int> stack;
	for (int h : loop)
		if (seen.insert(h / 3).second)
			stack.push_back(h / 3);
	while (!stack.empty()) {
		const int f = stack.back();
		stack.pop_back();
		const Triangle& t = triangles[size_t(f)];
		const Point3d& p = points[size_t(t[0])];
		if ((p - end.centre).Norm() > reach * end.radius)
			continue;
		const Point3d normal = (points[size_t(t[1])] - p) ^ (points[size_t(t[2])] - p);
		if (const double norm = normal.Norm(); norm > 0) {
			const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
			square += n * n.transpose() / norm;
		}
		for (int h = 3 * f; h < 3 * f + 3; ++h)
			if (const int g = partner[size_t(h)]; g >= 0 && seen.insert(g / 3).second)
				stack.push_back(g / 3);
	}
	const Eigen::Vector3d axis =
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square).eigenvectors().col(0);
	const Point3d result(axis[0], axis[1], axis[2]);
	return result * end.heading < 0 ? -result : result;
}

inline LimbEnd limbEnd(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const std::vector<int>& loop)
{
	constexpr double likeATube = 0.7;
	LimbEnd end;
	for (auto h = loop.rbegin(); h != loop.rend(); ++h) {
		end.corner.push_back(triangles[size_t(*h) / 3][size_t(Fans::next(*h)) % 3]);
		end.centre += points[size_t(end.corner.back())];
	}
	const size_t n = end.corner.size();
	end.centre /= double(n);
	Point3d area(0, 0, 0);
	for (size_t k = 0; k < n; ++k)
		area += (points[size_t(end.corner[k])] - end.centre)
			^ (points[size_t(end.corner[(k + 1) % n])] - end.centre);
	end.radius = std::sqrt(area.Norm() / (2 * M_PI));
	// Of a tube, however it is cut, this is its axis times its perimeter; around a flat hole nothing is left.
	Point3d onwards(0, 0, 0);
	for (int h : loop) {
		const Triangle& t = triangles[size_t(h) / 3];
		const Point3d &p = points[size_t(t[size_t(h) % 3])],
					  &q = points[size_t(t[size_t(Fans::next(h)) % 3])],
					  &apex = points[size_t(t[size_t(Fans::next(Fans::next(h))) % 3])];
		const Point3d edge = q - p, normal = edge ^ (apex - p), outOfFace = edge ^ normal;
		if (const double norm = outOfFace.Norm(); norm > 0)
			onwards += outOfFace * (edge.Norm() / norm);
	}
	end.isCutThrough = onwards.Norm() > likeATube * 2 * M_PI * end.radius;
	if (end.isCutThrough)
		end.radius = onwards.Norm() / (2 * M_PI);
	end.heading = end.isCutThrough ? onwards : area;
	if (end.heading.Norm() > 0)
		end.heading /= end.heading.Norm();
	if (end.isCutThrough)
		end.heading = axisBehind(points, triangles, partner, loop, end);
	return end;
}

/// The band between two ends, whose corners run against each other: always over the shorter diagonal.
inline std::vector<Triangle> bandBetween(
	const std::vector<Point3d>& points, const LimbEnd& a, const LimbEnd& b)
{
	const int n = int(a.corner.size()), m = int(b.corner.size());
	const auto ofA = [&](int i) { return a.corner[size_t(i % n)]; };
	const auto ofB = [&](int j) { return b.corner[size_t(((j % m) + m) % m)]; };
	const Point3d apart = b.centre - a.centre;
	const auto distance = [&](int i, int j) {
		return (points[size_t(ofB(j))] - points[size_t(ofA(i))]).Norm();
	};
	int start = 0;
	for (int j = 1; j < m; ++j)
		if ((points[size_t(ofB(j))] - points[size_t(ofA(0))] - apart).Norm()
			< (points[size_t(ofB(start))] - points[size_t(ofA(0))] - apart).Norm())
			start = j;
	std::vector<Triangle> band;
	for (int i = 0, j = 0; i < n || j < m;) {
		// Neither side may run a quarter of its round ahead of the other: ragged ones would be wound up.
		const double ahead = double(i) / n - double(j) / m;
		const bool stepOnA = j == m || ahead < -0.25
			|| (i < n && ahead <= 0.25 && distance(i + 1, start - j) <= distance(i, start - j - 1));
		if (stepOnA) {
			band.push_back({ofA(i), ofA(i + 1), ofB(start - j)});
			++i;
		}
		else {
			band.push_back({ofB(start - j - 1), ofB(start - j), ofA(i)});
			++j;
		}
	}
	return band;
}

/**
 * A tube from one end to the other, along the cubic that sets out as the one is heading and arrives against the heading
 * of the other; a band where they are near each other. New points are added.
 */
inline std::vector<Triangle> tubeBetween(
	std::vector<Point3d>& points, const LimbEnd& a, const LimbEnd& b)
{
	constexpr int sides = 12;
	// Beyond all of a ragged border.
	const auto beyond = [&](const LimbEnd& end) {
		double farthest = 0;
		for (int v : end.corner)
			farthest = std::max(farthest, (points[size_t(v)] - end.centre) * end.heading);
		return end.centre + end.heading * (farthest + end.radius / 2);
	};
	const Point3d from = beyond(a), to = beyond(b);
	const double gap = (to - from).Norm(), radius = (a.radius + b.radius) / 2;
	if (gap < radius || (to - from) * (b.centre - a.centre) <= 0)
		return bandBetween(points, a, b);
	const int rings = int(std::ceil(gap / radius)) + 1;
	// A hole in a side may be wider than the limb that goes out there.
	const double narrower = std::min(a.radius, b.radius);
	Point3d side, other;
	Point3d along = a.heading;
	vcg::GetUV(along, side, other);
	std::vector<Triangle> tube;
	LimbEnd last = a;
	for (int k = 0; k < rings; ++k) {
		const double t = double(k) / (rings - 1), s = 1 - t;
		// Hermite's cubic with tangents as long as the gap, and its derivative.
		LimbEnd ring;
		ring.centre = from * (s * s * (1 + 2 * t)) + to * (t * t * (1 + 2 * s))
			+ a.heading * (gap * t * s * s) + b.heading * (gap * s * t * t);
		ring.heading = (to - from) * (6 * t * s) + a.heading * (gap * s * (1 - 3 * t))
			+ b.heading * (gap * t * (3 * s - 1));
		if (ring.heading.Norm() > 0)
			ring.heading /= ring.heading.Norm();
		ring.radius = narrower;
		side -= ring.heading * (side * ring.heading);
		side.Normalize();
		other = ring.heading ^ side;
		for (int i = 0; i < sides; ++i) {
			const double angle = 2 * M_PI * i / sides;
			ring.corner.push_back(int(points.size()));
			points.push_back(
				ring.centre + (side * std::cos(angle) + other * std::sin(angle)) * ring.radius);
		}
		LimbEnd arriving = ring;
		std::reverse(arriving.corner.begin(), arriving.corner.end());
		const std::vector<Triangle> band = bandBetween(points, last, arriving);
		tube.insert(tube.end(), band.begin(), band.end());
		last = std::move(ring);
	}
	const std::vector<Triangle> band = bandBetween(points, last, b);
	tube.insert(tube.end(), band.begin(), band.end());
	return tube;
}

/// Pairs of ends that look at each other, the nearest ones first: how far apart, and their numbers.
inline std::vector<std::tuple<double, int, int>> facingEnds(
	const std::vector<LimbEnd>& ends, const GapLimits& limits)
{
	const double straight = std::cos(limits.aside * M_PI / 180);
	std::vector<int> byPlace(ends.size());
	std::iota(byPlace.begin(), byPlace.end(), 0);
	std::stable_sort(byPlace.begin(), byPlace.end(),
		[&](int a, int b) { return ends[size_t(a)].centre[0] < ends[size_t(b)].centre[0]; });
	std::vector<std::tuple<double, int, int>> facing;
	const auto look = [&](int i, int k) {
		const LimbEnd &a = ends[size_t(i)], &b = ends[size_t(k)];
		const Point3d apart = b.centre - a.centre;
		const double gap = apart.Norm(), radius = (a.radius + b.radius) / 2;
		const bool isOnePiece = a.piece == b.piece;
		if (gap > (isOnePiece ? limits.inOnePiece : limits.apart) * radius || !(gap > 0)
			|| gap > limits.ofPiece * std::min(a.pieceDiagonal, b.pieceDiagonal)
			|| std::max(a.radius, b.radius) > limits.wider * std::min(a.radius, b.radius)
			|| (isOnePiece && !b.isCutThrough))
			return;
		const double ofA = a.heading * apart / gap, ofB = -(b.heading * apart) / gap;
		if (std::min(ofA, ofB) >= straight && (i < k || !b.isCutThrough))
			facing.emplace_back(gap / std::min(ofA, ofB), i, k);
	};
	for (size_t at = 0; at < byPlace.size(); ++at) {
		const LimbEnd& a = ends[size_t(byPlace[at])];
		if (!a.isCutThrough)
			continue;
		const double reach = limits.apart * a.radius * (1 + limits.wider) / 2;
		for (size_t k = at + 1;
			 k < byPlace.size() && ends[size_t(byPlace[k])].centre[0] - a.centre[0] <= reach; ++k)
			look(byPlace[at], byPlace[k]);
		for (size_t k = at; k-- > 0 && a.centre[0] - ends[size_t(byPlace[k])].centre[0] <= reach;)
			look(byPlace[at], byPlace[k]);
	}
	std::sort(facing.begin(), facing.end());
	return facing;
}

} // namespace detail

/**
 * Joins the two sides of gaps by tubes: ends of limbs that were cut through, and the hole in the side of a body
 * that such an end looks at. Only what lies straight ahead is joined, see GapLimits, and only where the tube crosses
 * nothing.
 *
 * @param points    get those of the tubes at their end.
 * @param triangles coherently oriented, parted by partSurface(); get the tubes at their end.
 * @param partner   as PartedSurface has it.
 * @return how many gaps. @throws Cancelled.
 * Complexity: O(F log F), and of the pairs of ends that are near each other.
 */
inline int bridgeGaps(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const GapLimits& limits = GapLimits(),
	const Progress& progress = Progress())
{
	const std::vector<int> piece = detail::pieceOfFaces(partner);
	std::vector<Box3d> box(piece.size());
	for (size_t f = 0; f < piece.size(); ++f)
		for (int v : triangles[f])
			box[size_t(piece[f])].Add(points[size_t(v)]);
	std::vector<detail::LimbEnd> ends;
	for (const std::vector<int>& loop : detail::holeLoops(points, triangles, partner)) {
		if (loop.size() < 3 || int(loop.size()) > limits.edges)
			continue;
		detail::LimbEnd end = detail::limbEnd(points, triangles, partner, loop);
		end.piece = piece[size_t(loop.front()) / 3];
		end.pieceDiagonal = box[size_t(end.piece)].Diag();
		const bool isOnce =
			std::set<int>(end.corner.begin(), end.corner.end()).size() == end.corner.size();
		if (isOnce)
			ends.push_back(std::move(end));
	}
	progress.report(0.2, "Bridging gaps");
	const std::vector<std::tuple<double, int, int>> facing = detail::facingEnds(ends, limits);
	if (facing.empty())
		return 0;
	const std::vector<Triangle> given = triangles;
	const TriangleTree tree(points, given, progress.part(0.2, 0.6));
	std::vector<char> isCorner(points.size(), 0);
	for (const detail::LimbEnd& end : ends)
		for (int v : end.corner)
			isCorner[size_t(v)] = 1;
	const std::set<std::pair<int, int>> edges = detail::edgesBetween(triangles, isCorner);
	// A ragged border may stick into the tube that starts at it.
	const auto crossesElsewhere = [&](const Triangle& t, const detail::LimbEnd& a,
									  const detail::LimbEnd& b) {
		constexpr double near = 3; // radii
		return detail::crossesOthers(tree, given, points, t, [&](int f) {
			const Point3d& p = points[size_t(given[size_t(f)][0])];
			return (p - a.centre).Norm() > near * a.radius
				&& (p - b.centre).Norm() > near * b.radius;
		});
	};
	MergeForest pieces(int(piece.size()));
	std::set<int> corners; // of the ends that are taken
	int bridged = 0;
	for (const auto& [apart, i, k] : facing) {
		progress.report(0.6, "Bridging gaps");
		const detail::LimbEnd &a = ends[size_t(i)], &b = ends[size_t(k)];
		const auto isFree = [&](const detail::LimbEnd& end) {
			return std::none_of(
				end.corner.begin(), end.corner.end(), [&](int v) { return corners.count(v) > 0; });
		};
		if (!isFree(a) || !isFree(b))
			continue;
		// A second tube between two pieces would close a ring.
		if (pieces.find(a.piece) == pieces.find(b.piece)
			&& (b.centre - a.centre).Norm() > limits.inOnePiece * (a.radius + b.radius) / 2)
			continue;
		const std::set<int> ofA(a.corner.begin(), a.corner.end());
		if (std::any_of(b.corner.begin(), b.corner.end(), [&](int v) { return ofA.count(v) > 0; }))
			continue;
		const size_t before = points.size();
		const std::vector<Triangle> tube = detail::tubeBetween(points, a, b);
		const auto isEdge = [&](int v, int w) {
			return ofA.count(v) != ofA.count(w) && edges.count(std::minmax(v, w)) > 0;
		};
		if (std::any_of(tube.begin(), tube.end(), [&](const Triangle& t) {
				return isEdge(t[0], t[1]) || isEdge(t[1], t[2]) || isEdge(t[2], t[0])
					|| crossesElsewhere(t, a, b);
			})) {
			points.resize(before);
			continue;
		}
		triangles.insert(triangles.end(), tube.begin(), tube.end());
		pieces.join(a.piece, b.piece);
		corners.insert(a.corner.begin(), a.corner.end());
		corners.insert(b.corner.begin(), b.corner.end());
		++bridged;
	}
	return bridged;
}

} // namespace vcg::tri::mcf

#endif
