// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Parts a surface where an edge has more than two faces or a vertex several fans of faces.

#ifndef VCG_MCF_PART_SURFACE_H
#define VCG_MCF_PART_SURFACE_H

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What partSurface() has done.
struct PartedSurface
{
	/// For each half-edge 3 f + k, from corner k of face f to the next, its twin; -1: a border.
	std::vector<int> partner;
	int edges = 0;    ///< with more than two faces
	int vertices = 0; ///< that became several
};

namespace detail {

/// The fans of faces around vertices: sets of corners 3 f + k, joined over the paired half-edges.
class Fans
{
public:
	/// @throws Cancelled
	Fans(const std::vector<Triangle>& triangles, const std::vector<int>& partner,
		const Cancellation& cancel) :
			triangles(triangles),
			fans(3 * int(triangles.size()))
	{
		cancellableLoop(int(partner.size()), cancel, [&](int h) {
			const int g = partner[size_t(h)];
			if (g < h)
				return;
			for (int v : {vertex(h), vertex(SurfaceMesh::next(h))})
				fans.merge(fans.find(vertex(h) == v ? h : SurfaceMesh::next(h)),
					fans.find(vertex(g) == v ? g : SurfaceMesh::next(g)));
		});
	}

	/// The corner that stands for the fan of a corner; not always the lowest.
	int find(int corner) const { return fans.find(corner); }

private:
	const std::vector<Triangle>& triangles;
	mutable MergeForest fans; ///< of corners

	int vertex(int h) const { return triangles[size_t(h) / 3][size_t(h) % 3]; }
};

/**
 * Pairs the faces around an edge as brackets are matched: each with the next one across the solid
 * between them. Those that stay alone all turn the same way.
 * @param axis  of the edge, from its lower end. @param away  unit vectors into each face, square to
 * the edge. @param join  join(i, j) is called for each pair.
 * @throws Cancelled. Complexity: O(n log n).
 */
template <class Join>
void pairAcrossSolid(const SoupEdge* faces, const Point3d& axis, const std::vector<Point3d>& away,
	const Cancellation& cancel, const Join& join)
{
	struct Face
	{
		long angle;
		bool opens; ///< the solid is on its counter-clockwise side, seen against the axis
		int index;
		/// Of faces at the same angle those that close come first, so that bodies that touch part.
		bool operator<(const Face& other) const
		{
			return std::tie(angle, opens, index) < std::tie(other.angle, other.opens, other.index);
		}
	};
	constexpr double alike = 1e6; // angles are compared to 1 / alike
	const long halfTurn = std::lround(alike * M_PI);
	const int count = int(away.size());
	const Point3d& x = away[0];
	const Point3d y = axis.SquaredNorm() > 0 ? (axis ^ x) / axis.Norm() : Point3d(0, 0, 0);
	std::vector<Face> around;
	around.reserve(away.size());
	cancellableLoop(count, cancel, [&](int i) {
		const Point3d& d = away[size_t(i)];
		const long angle = std::lround(alike * std::atan2(d * y, d * x));
		around.push_back({angle == -halfTurn ? halfTurn : angle, !faces[i].forward, i});
	});
	sortCancellable(around, 0, around.size(), cancel);
	std::vector<char> taken(away.size(), 0);
	std::vector<int> open;
	for (const bool isFirstRound : {true, false})
		cancellableLoop(count, cancel, [&](int k) {
			const Face& face = around[size_t(k)];
			if (face.opens) {
				if (isFirstRound)
					open.push_back(face.index);
			}
			else if (!taken[size_t(face.index)] && !open.empty()) {
				taken[size_t(face.index)] = 1;
				join(open.back(), face.index);
				open.pop_back();
			}
		});
}

/// The partner of each half-edge; -1: none. Of more than two faces at an edge, those that continue
/// each other best are paired first; of very many, see pairAcrossSolid().
/// @param crowdedEdges  gets the number of such edges, or null. @throws Cancelled
inline std::vector<int> pairedHalfEdges(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, int* crowdedEdges, const Progress& progress)
{
	std::vector<int> partner = filledArray(3 * triangles.size(), -1, progress);
	const SoupEdges edges = sortedSoupEdges(points.size(), triangles, progress.part(0, 0.7));
	int crowded = 0;
	forEachSoupEdge(
		edges, progress.part(0.7, 1), [&](int low, const SoupEdge* begin, const SoupEdge* end) {
			const auto halfEdge = [&](const SoupEdge& e) {
				const Triangle& t = triangles[e.face];
				const int from = e.forward ? low : e.high;
				return 3 * int(e.face) + (t[0] == from ? 0 : t[1] == from ? 1 : 2);
			};
			const auto join = [&](const SoupEdge& a, const SoupEdge& b) {
				partner[size_t(halfEdge(a))] = halfEdge(b);
				partner[size_t(halfEdge(b))] = halfEdge(a);
			};
			const int count = int(end - begin);
			if (count == 2)
				join(begin[0], begin[1]);
			if (count <= 2)
				return;
			++crowded;
			const Point3d& origin = points[size_t(low)];
			const Point3d axis = points[size_t(begin->high)] - origin;
			std::vector<Point3d> away; // unit vectors into each face, square to the edge
			for (const SoupEdge* e = begin; e != end; ++e) {
				const Triangle& t = triangles[e->face];
				const int apex = t[0] + t[1] + t[2] - low - begin->high;
				Point3d d = points[size_t(apex)] - origin;
				if (axis.SquaredNorm() > 0)
					d -= axis * ((d * axis) / axis.SquaredNorm());
				away.push_back(d.Norm() > 0 ? d / d.Norm() : d);
			}
			constexpr int maxForAllPairs = 64;
			if (count > maxForAllPairs) {
				pairAcrossSolid(
					begin, axis, away, progress, [&](int i, int j) { join(begin[i], begin[j]); });
				return;
			}
			// Pairs of consistent orientation come first, then those with the flatter angle, then
			// those with the solid in the angle below 180 degrees, which parts bodies that touch.
			constexpr double alike = 1e6; // cosines are compared to 1 / alike
			std::vector<std::tuple<int, long, int, int, int>> pairs;
			for (int i = 0; i < count; ++i)
				for (int j = i + 1; j < count; ++j) {
					const int against = begin[i].forward == begin[j].forward;
					const int f = begin[i].forward ? i : j, g = i + j - f;
					const double solid = (axis ^ away[size_t(f)]) * away[size_t(g)];
					pairs.emplace_back(against,
						std::lround(alike * (away[size_t(i)] * away[size_t(j)])), solid < 0 ? 0 : 1,
						i, j);
				}
			std::sort(pairs.begin(), pairs.end());
			std::vector<char> taken(size_t(count), 0);
			for (const auto& [against, straightness, side, i, j] : pairs)
				if (!taken[size_t(i)] && !taken[size_t(j)]) {
					taken[size_t(i)] = taken[size_t(j)] = 1;
					join(begin[i], begin[j]);
				}
		});
	if (crowdedEdges)
		*crowdedEdges = crowded;
	return partner;
}

} // namespace detail

/**
 * Parts a surface where an edge has more than two faces or a vertex several fans of faces: by
 * copies of vertices, and by new ones in the middle of edges whose pairs of faces share both ends.
 * At an edge, the faces that continue each other best are paired; of very many, those with the
 * solid between them.
 * @param points    mesh units; get new ones at their end. @param triangles are changed.
 * @param partedFrom gets, for each new point, the one that it copies; -1 in the middle of an edge.
 * @param keepOpenFans  fans with borders at a vertex stay together, since the hole between them is
 *                  still to be filled.
 * @throws Cancelled. Complexity: about O(V + F), and O(n log n) for each edge with n > 2 faces.
 */
inline PartedSurface partSurface(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	std::vector<int>& partedFrom, bool keepOpenFans, const Progress& progress = Progress())
{
	constexpr int maxRounds = 4;
	PartedSurface parted;
	for (int round = 0; round < maxRounds; ++round) {
		const Progress part = progress.part(double(round) / maxRounds, (round + 1.0) / maxRounds);
		int crowded = 0;
		parted.partner = detail::pairedHalfEdges(points, triangles, &crowded, part.part(0, 0.5));
		if (round == 0)
			parted.edges = crowded;
		const Progress cancel = part.cancelOnly();
		const int corners = int(parted.partner.size());
		const detail::Fans fans(triangles, parted.partner, cancel);
		std::vector<char> isOpen(parted.partner.size(), 0); // of fans, see Fans::find()
		detail::cancellableLoop(corners, cancel, [&](int h) {
			if (parted.partner[size_t(h)] < 0)
				isOpen[size_t(fans.find(h))] = isOpen[size_t(fans.find(SurfaceMesh::next(h)))] = 1;
		});
		// A vertex keeps its first fan; with keepOpenFans, if that is open, all open ones.
		const size_t before = points.size();
		std::vector<int> owner = detail::filledArray(before, -1, cancel);
		std::vector<int> vertexOfFan = detail::filledArray(parted.partner.size(), -1, cancel);
		std::vector<char> manifold(before, 1);
		detail::cancellableLoop(corners, cancel, [&](int c) {
			const int fan = fans.find(c);
			const int v = triangles[size_t(c) / 3][size_t(c) % 3];
			int& vertex = vertexOfFan[size_t(fan)];
			if (vertex >= 0)
				return;
			int& first = owner[size_t(v)];
			if (first < 0)
				first = fan;
			if (first == fan || (keepOpenFans && isOpen[size_t(first)] && isOpen[size_t(fan)]))
				vertex = v;
			else {
				vertex = int(points.size());
				points.push_back(Point3d(points[size_t(v)]));
				partedFrom.push_back(v);
				manifold[size_t(v)] = 0;
			}
		});
		detail::cancellableLoop(corners, cancel, [&](int c) {
			triangles[size_t(c) / 3][size_t(c) % 3] = vertexOfFan[size_t(fans.find(c))];
		});
		parted.vertices += int(std::count(manifold.begin(), manifold.end(), 0));
		if (!crowded)
			return parted;

		// Of pairs that still share both ends of an edge, all but one get a vertex in its middle.
		const detail::SoupEdges edges =
			detail::sortedSoupEdges(points.size(), triangles, part.part(0.5, 0.9));
		std::vector<std::array<int, 2>> toCut;
		detail::forEachSoupEdge(edges, part.part(0.9, 1),
			[&](int low, const detail::SoupEdge* begin, const detail::SoupEdge* end) {
				bool first = true;
				for (const detail::SoupEdge* e = begin; end - begin > 2 && e != end; ++e) {
					const Triangle& t = triangles[e->face];
					const int from = e->forward ? low : e->high;
					const int h = 3 * int(e->face) + (t[0] == from ? 0 : t[1] == from ? 1 : 2);
					const int g = parted.partner[size_t(h)];
					if (g > h && !std::exchange(first, false))
						toCut.push_back({h, g});
				}
			});
		if (toCut.empty())
			return parted;
		std::vector<char> cut(triangles.size(), 0);
		for (const auto& pair : toCut) {
			if (cut[size_t(pair[0]) / 3] || cut[size_t(pair[1]) / 3])
				continue; // in the next round
			const Triangle first = triangles[size_t(pair[0]) / 3];
			const int a = first[size_t(pair[0] % 3)], b = first[size_t((pair[0] + 1) % 3)];
			const int middle = int(points.size());
			points.push_back((points[size_t(a)] + points[size_t(b)]) / 2.0);
			partedFrom.push_back(-1);
			for (int h : pair) {
				const size_t f = size_t(h) / 3;
				cut[f] = 1;
				Triangle half = triangles[f];
				half[size_t(h) % 3] = middle;
				triangles[f][size_t(SurfaceMesh::next(h)) % 3] = middle;
				triangles.push_back(half);
			}
		}
	}
	return parted;
}

} // namespace vcg::tri::mcf

#endif
