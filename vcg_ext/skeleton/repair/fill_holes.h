// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Fills small holes by triangles between border vertices that fold as little as possible.

#ifndef VCG_MCF_FILL_HOLES_H
#define VCG_MCF_FILL_HOLES_H

#include "part_surface.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/box_tree.h>
#include <skeleton/spatial/triangle_tree.h>

#include <vcg/space/intersection/triangle_triangle3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What fillHoles() has done.
struct FilledHoles
{
	int closed = 0, left = 0;
};

/// What counts as a small hole.
struct HoleLimits
{
	/// Largest area of a filling in the largest piece of surface, as a fraction of the piece's area
	/// (others may be torn off and short), unless it continues flat faces, see
	/// detail::continuesFlatly(); and of all fillings of any piece together.
	double area = 0.2, allAreas = 0.5;
	/// Largest number of border edges of a hole; the time grows with its cube.
	int edges = 200;
	/// Largest angle between the normals of adjacent triangles of the filling, and against the
	/// surface, degrees; 0: flat. Beyond, the filling would lie back on the surface.
	double turn = 160;
	/// A filling of at most this fraction of the piece's area may fold and cross the surface.
	double anyhow = 0;
};

namespace detail {

/**
 * The triangulation of a closed polygon in space whose largest angle between adjacent normals is
 * minimal; of several, the one with the smallest area. Complexity: O(n^3), and O(n^2) memory.
 * Source: Liepa, "Filling holes in meshes", SGP 2003, Sec. 3; the recursion is due to Barequet and
 * Sharir, 1995.
 */
class PolygonFilling
{
public:
	struct Weight
	{
		double turn = std::numeric_limits<
			double>::infinity(); ///< largest 1 - cos of the angle between normals
		double area = 0;

		bool operator<(const Weight& other) const
		{
			return turn != other.turn ? turn < other.turn : area < other.area;
		}
	};

	/**
	 * @param polygon   corners in order, at least three; kept by reference, as is `outside`.
	 * @param outside   unit normal of the face at each side i, i + 1.
	 * @param allowed   allowed(i, k): whether the filling may have an edge from corner i to k.
	 * @param free      turns (1 - cos) up to this count as equal: then the area decides.
	 */
	template <class Allowed>
	PolygonFilling(const std::vector<Point3d>& polygon, const std::vector<Point3d>& outside,
		const Allowed& allowed, double free = 0) :
			p(polygon),
			outside(outside), n(int(polygon.size())), best(size_t(n) * size_t(n)),
			apex(size_t(n) * size_t(n), -1)
	{
		for (int i = 0; i + 1 < n; ++i)
			best[at(i, i + 1)] = {free, 0};
		for (int span = 2; span < n; ++span)
			for (int i = 0; i + span < n; ++i) {
				const int k = i + span;
				const bool isLast = span == n - 1;
				if (!isLast && !allowed(i, k))
					continue;
				for (int m = i + 1; m < k; ++m) {
					const Weight &left = best[at(i, m)], &right = best[at(m, k)];
					const double sum = std::max(left.turn, right.turn);
					if (!(sum <= best[at(i, k)].turn)
						|| std::isinf(sum)) // or an edge is not allowed
						continue;
					const Point3d area =
						((p[size_t(m)] - p[size_t(i)]) ^ (p[size_t(k)] - p[size_t(i)])) / 2.0;
					const Point3d normal = unit(area);
					double turn = std::max({sum, turnAt(normal, i, m), turnAt(normal, m, k)});
					if (isLast)
						turn = std::max(turn, between(normal, outside[size_t(n - 1)]));
					const Weight weight = {turn, left.area + right.area + area.Norm()};
					if (weight < best[at(i, k)]) {
						best[at(i, k)] = weight;
						apex[at(i, k)] = m;
					}
				}
			}
	}

	Weight weight() const { return best[at(0, n - 1)]; }

	/// The triangles, as indices of corners. @pre the turn of weight() is finite.
	std::vector<Triangle> triangles() const
	{
		std::vector<Triangle> result;
		std::vector<std::array<int, 2>> open = {{0, n - 1}};
		while (!open.empty()) {
			const auto [i, k] = open.back();
			open.pop_back();
			if (k - i < 2)
				continue;
			const int m = apex[at(i, k)];
			result.push_back({i, m, k});
			open.push_back({i, m});
			open.push_back({m, k});
		}
		return result;
	}

private:
	const std::vector<Point3d>& p;
	const std::vector<Point3d>& outside;
	int n;
	std::vector<Weight> best;
	std::vector<int> apex;

	size_t at(int i, int k) const { return size_t(i) * size_t(n) + size_t(k); }

	static Point3d unit(const Point3d& v)
	{
		const double length = v.Norm();
		return length > 0 ? v / length : Point3d(0, 0, 0);
	}
	/// 1 - cos of the angle of two normals. A triangle without area counts as at a right angle.
	static double between(const Point3d& a, const Point3d& b) { return 1 - a * b; }

	/// The turn of a triangle against the triangle or face beyond its edge from i to k.
	double turnAt(const Point3d& normal, int i, int k) const
	{
		if (k == i + 1)
			return between(normal, outside[size_t(i)]);
		const Point3d& m = p[size_t(apex[at(i, k)])];
		return between(normal, unit((m - p[size_t(i)]) ^ (p[size_t(k)] - p[size_t(i)])));
	}
};

/// For each of the angles `from`, the number of the angle `to` that is next counter-clockwise, a
/// whole turn ahead if it is the same; the lowest of several. @param ticker  counts comparisons.
/// Complexity: O(n log n).
inline std::vector<size_t> nextAngles(
	const std::vector<double>& from, const std::vector<double>& to, Ticker& ticker)
{
	std::vector<std::pair<double, size_t>> sorted;
	for (double angle : to)
		sorted.emplace_back(angle, sorted.size());
	std::sort(sorted.begin(), sorted.end());
	sorted.erase(std::unique(sorted.begin(), sorted.end(),
					 [](const auto& a, const auto& b) { return a.first == b.first; }),
		sorted.end());
	std::vector<size_t> next;
	for (double angle : from) {
		std::pair<double, size_t> nearest(std::numeric_limits<double>::infinity(), 0);
		// Rounding may make angles that differ equally far.
		const auto look = [&](auto at, auto end) {
			for (; at != end; ++at) {
				ticker.tick();
				double turn = at->first - angle;
				if (turn <= 0)
					turn += 2 * M_PI;
				if (turn > nearest.first)
					return;
				nearest = std::min(nearest, {turn, at->second});
			}
		};
		const auto beyond = std::upper_bound(
			sorted.begin(), sorted.end(), std::pair(angle, std::numeric_limits<size_t>::max()));
		look(beyond, sorted.end());
		look(sorted.begin(), beyond);
		next.push_back(nearest.second);
	}
	return next;
}

/// The fan of faces between two border half-edges of a vertex.
struct BorderFan
{
	int out, into;  ///< border half-edges from and to the vertex
	Point3d normal; ///< of its faces, the sum weighted by area
};

/// The fan that begins at a border half-edge. Complexity: O(n log n) for n faces.
inline BorderFan borderFan(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& partner, int out)
{
	const auto origin = [&](int h) { return triangles[size_t(h) / 3][size_t(h) % 3]; };
	const int vertex = origin(out);
	std::vector<int> corners(1, out);
	int leave = SurfaceMesh::previous(out); // the other half-edge of the face at the vertex
	for (int g = partner[size_t(leave)]; g >= 0; g = partner[size_t(leave)]) {
		const int corner = origin(g) == vertex ? g : SurfaceMesh::next(g);
		leave = corner == g ? SurfaceMesh::previous(corner) : corner;
		corners.push_back(corner);
	}
	BorderFan fan = {out, leave, Point3d(0, 0, 0)};
	std::sort(corners.begin(), corners.end()); // the sum depends on the order
	for (int c : corners) {
		const Triangle& t = triangles[size_t(c) / 3];
		const Point3d& a = points[size_t(t[0])];
		fan.normal += (points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a);
	}
	return fan;
}

/**
 * The loops of half-edges around the holes of a coherently oriented surface, as they run in the
 * faces. Where several fans of faces meet at a vertex, a loop continues at the next fan across the
 * gap, so that the gap can be filled and the vertex is not split. Where the fans face different
 * ways, or overlap when seen from outside, a loop stays with its fan, and is split where it returns
 * to the vertex: the open end of a wing and the slit along its trailing edge are separate holes, and
 * so are two triangles missing at a vertex with more than 360 degrees around it. Where faces at a
 * crowded edge still disagree, a border may end at a vertex: it is no hole.
 * @throws Cancelled. Complexity: O(F + B log B) for B faces at border vertices.
 */
inline std::vector<std::vector<int>> holeLoops(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& partner,
	const Progress& progress = Progress())
{
	const Progress cancel = progress.cancelOnly();
	Ticker ticker(cancel, repairing, double(partner.size()));
	const auto origin = [&](int h) { return triangles[size_t(h) / 3][size_t(h) % 3]; };
	std::map<int, std::vector<BorderFan>> fansAt;
	cancellableLoop(int(partner.size()), cancel, [&](int h) {
		if (partner[size_t(h)] >= 0)
			return;
		ticker.tick();
		fansAt[origin(h)].push_back(borderFan(points, triangles, partner, h));
	});
	std::map<int, int> following; // of the half-edge into a vertex
	std::set<int> splitting;      // vertices whose fans face different ways or overlap
	for (const auto& [v, around] : fansAt) {
		Point3d normal(0, 0, 0);
		for (const BorderFan& fan : around)
			normal += fan.normal;
		bool alike = true;
		for (const BorderFan& fan : around)
			alike &= fan.normal * normal > 0;
		// Seen from outside, each fan extends counter-clockwise from its border `out` to `into`.
		Point3d x, y;
		vcg::GetUV(normal, x, y);
		const Point3d& centre = points[size_t(v)];
		const auto angle = [&](int to) {
			const Point3d d = points[size_t(to)] - centre;
			return std::atan2(d * y, d * x);
		};
		std::vector<double> from, to;
		for (const BorderFan& fan : around) {
			ticker.tick();
			from.push_back(angle(origin(fan.into)));
			to.push_back(angle(origin(SurfaceMesh::next(fan.out))));
		}
		const std::vector<size_t> next = nextAngles(from, to, ticker);
		const bool isRound =
			alike && std::set<size_t>(next.begin(), next.end()).size() == around.size();
		if (!isRound)
			splitting.insert(v);
		for (size_t i = 0; i < around.size(); ++i)
			following[around[i].into] = around[isRound ? next[i] : i].out;
	}
	std::vector<std::vector<int>> loops;
	std::vector<char> done(partner.size(), 0);
	cancellableLoop(int(partner.size()), cancel, [&](int h) {
		if (partner[size_t(h)] >= 0 || done[size_t(h)])
			return;
		std::vector<int> loop;
		std::map<int, size_t> placeOf; // in the loop, of the half-edge from a splitting vertex
		for (int at = h; !done[size_t(at)];) {
			ticker.tick();
			done[size_t(at)] = 1;
			loop.push_back(at);
			if (splitting.count(origin(at)))
				placeOf[origin(at)] = loop.size() - 1;
			if (const auto first = placeOf.find(origin(SurfaceMesh::next(at)));
				first != placeOf.end()) {
				const auto begin = loop.begin() + std::ptrdiff_t(first->second);
				for (auto inner = begin; inner != loop.end(); ++inner)
					placeOf.erase(origin(*inner));
				loops.emplace_back(begin, loop.end());
				loop.erase(begin, loop.end());
			}
			const auto next = following.find(at);
			if (next == following.end()) {
				loop.clear();
				break;
			}
			at = next->second;
		}
		if (!loop.empty())
			loops.push_back(std::move(loop));
	});
	return loops;
}

/// The area vector of a triangle: its normal, with the area as length.
inline Point3d areaVector(const std::vector<Point3d>& points, const Triangle& t)
{
	const Point3d& a = points[size_t(t[0])];
	return ((points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a)) / 2.0;
}

/// The area vector of a closed polygon in space. @param polygon  its vertices in order.
/// @param centre  any point near them.
inline Point3d areaVector(
	const std::vector<Point3d>& points, const std::vector<int>& polygon, const Point3d& centre)
{
	Point3d sum(0, 0, 0);
	for (size_t k = 0; k < polygon.size(); ++k)
		sum += (points[size_t(polygon[k])] - centre)
			^ (points[size_t(polygon[(k + 1) % polygon.size()])] - centre);
	return sum / 2.0;
}

/// For the lowest face of each piece, see pieceOfFaces(), the area of the piece; for the others 0.
/// @throws Cancelled
inline std::vector<double> areaOfPieces(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& piece,
	const Cancellation& cancel)
{
	std::vector<double> area(piece.size(), 0);
	cancellableLoop(int(piece.size()), cancel, [&](int f) {
		area[size_t(piece[size_t(f)])] += areaVector(points, triangles[size_t(f)]).Norm();
	});
	return area;
}

/// The border of a hole in the direction of its filling: against that of the faces, so that the
/// normals of both are on the same side.
struct BorderPolygon
{
	std::vector<int> corners; ///< vertices
	std::vector<Point3d> points;
	std::vector<Point3d> outside; ///< unit normal of the face at each side i, i + 1
	std::set<int> pieces;         ///< of surface around the hole, see pieceOfFaces()

	/// The vertices of two corners, the lower one first.
	std::pair<int, int> edge(int a, int b) const
	{
		return std::minmax(corners[size_t(a)], corners[size_t(b)]);
	}
	/// Whether a filling may have an edge between two corners: vertices that `edges` do not join.
	bool mayJoin(int a, int b, const std::set<std::pair<int, int>>& edges) const
	{
		return corners[size_t(a)] != corners[size_t(b)] && !edges.count(edge(a, b));
	}
	/// The triangle of vertices for one of corners.
	Triangle triangle(const Triangle& t) const
	{
		return {corners[size_t(t[0])], corners[size_t(t[1])], corners[size_t(t[2])]};
	}
};

/// Whether most of a filling lies in the planes of faces at the border, as where one of the two
/// triangles of a plate's side is missing. @param filling  see PolygonFilling::triangles().
inline bool continuesFlatly(const BorderPolygon& border, const std::vector<Triangle>& filling)
{
	constexpr double maxTurn = 1.5e-4; // 1 - cosine, of a degree
	constexpr double most = 0.5;
	const int last = int(border.points.size()) - 1;
	double flat = 0, all = 0;
	for (const Triangle& t : filling) {
		const Point3d vector = areaVector(border.points, t);
		const double area = vector.Norm();
		const auto isFlush = [&](int a, int b) {
			const bool isSide = b == a + 1 || (a == last && b == 0);
			return isSide && area - vector * border.outside[size_t(a)] < maxTurn * area;
		};
		all += area;
		flat += isFlush(t[0], t[1]) || isFlush(t[1], t[2]) || isFlush(t[2], t[0]) ? area : 0;
	}
	return flat > most * all;
}

/// @param loop half-edges, as holeLoops() has them. @param piece of each face.
inline BorderPolygon borderPolygon(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& piece,
	const std::vector<int>& loop)
{
	BorderPolygon border;
	for (auto h = loop.rbegin(); h != loop.rend(); ++h) {
		const Triangle& face = triangles[size_t(*h) / 3];
		const int v = face[size_t(SurfaceMesh::next(*h)) % 3];
		border.corners.push_back(v);
		border.points.push_back(points[size_t(v)]);
		const Point3d normal = areaVector(points, face);
		border.outside.push_back(normal.Norm() > 0 ? normal / normal.Norm() : normal);
		border.pieces.insert(piece[size_t(*h) / 3]);
	}
	return border;
}

/// For each vertex whether it is on a border. @throws Cancelled
inline std::vector<char> borderVertices(size_t vertices, const std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const Cancellation& cancel)
{
	std::vector<char> onBorder(vertices, 0);
	cancellableLoop(int(partner.size()), cancel, [&](int h) {
		if (partner[size_t(h)] < 0)
			onBorder[size_t(triangles[size_t(h) / 3][size_t(h) % 3])] = 1;
	});
	return onBorder;
}

/// The edges whose two vertices are marked. @throws Cancelled
inline std::set<std::pair<int, int>> edgesBetween(const std::vector<Triangle>& triangles,
	const std::vector<char>& marked, const Cancellation& cancel)
{
	std::set<std::pair<int, int>> edges;
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		const Triangle& t = triangles[size_t(f)];
		for (size_t k = 0; k < 3; ++k)
			if (marked[size_t(t[k])] && marked[size_t(t[(k + 1) % 3])])
				edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
	});
	return edges;
}

/// For each face the lowest one of its piece of surface. @throws Cancelled
inline std::vector<int> pieceOfFaces(
	const std::vector<int>& partner, const Cancellation& cancel = Cancellation())
{
	MergeForest pieces(int(partner.size() / 3));
	cancellableLoop(int(partner.size()), cancel, [&](int h) {
		if (partner[size_t(h)] > h)
			pieces.join(h / 3, partner[size_t(h)] / 3);
	});
	std::vector<int> lowest;
	lowest.reserve(partner.size() / 3);
	cancellableLoop(pieces.size(), cancel, [&](int f) { lowest.push_back(pieces.find(f)); });
	return lowest;
}

/// For the lowest face of each piece, see pieceOfFaces(), whether the piece has a border.
/// @throws Cancelled
inline std::vector<char> openPieces(
	const std::vector<int>& partner, const std::vector<int>& piece, const Cancellation& cancel)
{
	std::vector<char> open(piece.size(), 0);
	cancellableLoop(int(partner.size()), cancel, [&](int h) {
		if (partner[size_t(h)] < 0)
			open[size_t(piece[size_t(h) / 3])] = 1;
	});
	return open;
}

/// Whether two triangles cross that share no vertex.
inline bool areCrossing(
	const std::vector<Point3d>& points, const Triangle& t, const Triangle& other)
{
	for (int v : other)
		if (std::find(t.begin(), t.end(), v) != t.end())
			return false;
	const auto at = [&](const Triangle& of, size_t k) { return points[size_t(of[k])]; };
	return vcg::NoDivTriTriIsect<double>(
		at(t, 0), at(t, 1), at(t, 2), at(other, 0), at(other, 1), at(other, 2));
}

/// Whether a triangle crosses others of `triangles` with which it shares no vertex. @param counts
/// counts(face): whether that face is considered.
template <class Counts>
bool crossesOthers(const TriangleTree& tree, const std::vector<Triangle>& triangles,
	const std::vector<Point3d>& points, const Triangle& t, const Counts& counts)
{
	Box3d box;
	for (int v : t)
		box.Add(points[size_t(v)]);
	bool crosses = false;
	tree.forEachFaceIn(box, [&](int f) {
		crosses = crosses || (counts(f) && areCrossing(points, t, triangles[size_t(f)]));
	});
	return crosses;
}

inline bool crossesOthers(const TriangleTree& tree, const std::vector<Triangle>& triangles,
	const std::vector<Point3d>& points, const Triangle& t)
{
	return crossesOthers(tree, triangles, points, t, [](int) { return true; });
}

/// The triangles whose boxes meet that of a hole with at most `edges` edges: its filling, which is
/// within the hole's box, can cross no others. @throws Cancelled.
/// Complexity: O(F log n) for n holes apart.
inline std::vector<Triangle> facesNearHoles(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<std::vector<int>>& loops, int edges,
	const Progress& progress)
{
	std::vector<Box3d> boxes;
	for (const std::vector<int>& loop : loops) {
		if (int(loop.size()) > edges)
			continue;
		boxes.emplace_back();
		for (int h : loop)
			boxes.back().Add(points[size_t(triangles[size_t(h) / 3][size_t(h) % 3])]);
	}
	std::vector<Triangle> near;
	if (boxes.empty())
		return near;
	const BoxTree holes(boxes, progress.cancelOnly());
	reportedLoop(int(triangles.size()), progress, "Filling holes", [&](int f) {
		Box3d box;
		for (int v : triangles[size_t(f)])
			box.Add(points[size_t(v)]);
		bool isNear = false;
		holes.forEachIn(box, [&](int) { isNear = true; });
		if (isNear)
			near.push_back(triangles[size_t(f)]);
	});
	return near;
}

} // namespace detail

/**
 * Fills the small holes, see HoleLimits, whose filling does not cross the surface; fillings within
 * HoleLimits::anyhow may.
 * @param triangles coherently oriented, parted by partSurface(); get the fillings at their end.
 * @param partner   as PartedSurface has it.
 * @param leftOpen  holes with one of these vertices are not filled.
 * @throws Cancelled. Complexity: O(F log F + n^3) for holes of n edges.
 */
inline FilledHoles fillHoles(const std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const HoleLimits& limits = HoleLimits(),
	const Progress& progress = Progress(), const std::set<int>& leftOpen = {})
{
	const char* const what = "Filling holes";
	const Progress cancel = progress.cancelOnly();
	FilledHoles done;
	const std::vector<std::vector<int>> loops =
		detail::holeLoops(points, triangles, partner, cancel);
	if (loops.empty())
		return done;
	const std::vector<int> piece = detail::pieceOfFaces(partner, cancel);
	const std::vector<double> area = detail::areaOfPieces(points, triangles, piece, cancel);
	std::vector<double> filled(piece.size(), 0);
	const double largest = *std::max_element(area.begin(), area.end());
	std::set<std::pair<int, int>> edges = detail::edgesBetween(
		triangles, detail::borderVertices(points.size(), triangles, partner, cancel), cancel);
	const std::vector<Triangle> near =
		detail::facesNearHoles(points, triangles, loops, limits.edges, progress.part(0, 0.1));
	if (near.empty()) {
		done.left = int(loops.size());
		return done;
	}
	const TriangleTree tree(points, near, progress.part(0.1, 0.3));
	const double maxTurn = 1 - std::cos(limits.turn * M_PI / 180);
	const auto isLeftOpen = [&](int h) {
		return leftOpen.count(triangles[size_t(h) / 3][size_t(h) % 3]) > 0;
	};
	const Progress filling = progress.part(0.3, 1);
	for (size_t i = 0; i < loops.size(); ++i) {
		filling.report(double(i) / double(loops.size()), what);
		const std::vector<int>& loop = loops[i];
		const int n = int(loop.size());
		++done.left;
		if (n < 3 || n > limits.edges || std::any_of(loop.begin(), loop.end(), isLeftOpen))
			continue;
		const detail::BorderPolygon border = detail::borderPolygon(points, triangles, piece, loop);
		double surface = 0, before = 0;
		for (int p : border.pieces) {
			surface += area[size_t(p)];
			before += filled[size_t(p)];
		}
		const bool isMain = surface >= largest;
		std::vector<Triangle> made;
		std::set<std::pair<int, int>> chords;
		double size = 0;
		const auto isFilled = [&](double free) {
			const detail::PolygonFilling best(
				border.points, border.outside,
				[&](int a, int b) { return border.mayJoin(a, b, edges); }, free);
			const double turn = best.weight().turn;
			size = best.weight().area;
			const bool anyhow = std::isfinite(turn) && size <= limits.anyhow * surface;
			if (!(turn <= maxTurn || anyhow) || before + size > limits.allAreas * surface)
				return false;
			const std::vector<Triangle> filling = best.triangles();
			if (isMain && size > limits.area * surface && !detail::continuesFlatly(border, filling))
				return false;
			made.clear();
			chords.clear();
			bool fits = true;
			for (const Triangle& t : filling) {
				made.push_back(border.triangle(t));
				for (const auto& [a, b] : {std::pair(t[0], t[1]), std::pair(t[1], t[2])})
					if (b - a > 1)
						fits &= chords.insert(border.edge(a, b))
									.second; // a vertex may be on the loop twice
				fits = fits && (anyhow || !detail::crossesOthers(tree, near, points, made.back()));
			}
			return fits;
		};
		// First the filling that turns least; then the smallest of those within the limit.
		if (!isFilled(0) && !isFilled(maxTurn))
			continue;
		edges.insert(chords.begin(), chords.end());
		triangles.insert(triangles.end(), made.begin(), made.end());
		for (int p : border.pieces)
			filled[size_t(p)] += size;
		++done.closed;
		--done.left;
	}
	return done;
}

} // namespace vcg::tri::mcf

#endif
