// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Cuts handles that are so small that they are defects.

#ifndef VCG_MCF_CUT_HANDLES_H
#define VCG_MCF_CUT_HANDLES_H

#include "fill_holes.h"
#include "part_surface.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// How small a handle must be to be cut: all of it lies within these distances of one vertex.
struct HandleLimits
{
	/// Along the surface, in edges; 0: no handle is cut.
	int edges = 8;
	/// In space, as a fraction of the diagonal of the piece of surface.
	double distance = 0.02;
};

namespace detail {

/// Cuts handles of a closed surface; one object for each surface.
class HandleCutter
{
public:
	HandleCutter(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
		const HandleLimits& limits) :
			points(points),
			triangles(triangles), limits(limits)
	{
	}

	int run(const Progress& progress)
	{
		partner = pairedHalfEdges(points, triangles, nullptr, progress.part(0, 0.1));
		measurePieces();
		if (std::all_of(genus.begin(), genus.end(), [](int g) { return g <= 0; }))
			return 0;
		cornersAt.resize(points.size());
		for (int h = 0; h < int(partner.size()); ++h)
			cornersAt[size_t(origin(h))].push_back(h);
		placeOf.assign(points.size(), -1);
		faceAt.assign(triangles.size(), -1);
		std::vector<char> done(points.size(), 0);
		int cut = 0;
		for (int v = 0; v < int(points.size()); ++v) { // cuts add points
			if (v % 256 == 0)
				progress.report(0.1 + 0.9 * v / double(points.size()), "Looking for small handles");
			while (!done[size_t(v)] && !cornersAt[size_t(v)].empty()
				&& genus[size_t(pieceOf(v))] > 0) {
				const Patch patch = patchAround(v, limits.edges);
				if (genusOf(patch) > 0 && cutAt(v)) {
					--genus[size_t(pieceOf(v))];
					++cut;
					done.resize(points.size(), 0);
					continue;
				}
				// What lies around these within half the limits is all in this patch.
				for (size_t i = 0; i < patch.vertices.size() && 2 * patch.steps[i] <= limits.edges;
					 ++i)
					if (const int w = patch.vertices[i];
						2 * Distance(points[size_t(w)], points[size_t(v)]) <= reach(v))
						done[size_t(w)] = 1;
				done[size_t(v)] = 1;
			}
		}
		return cut;
	}

private:
	/// The surroundings of a vertex: vertices in breadth-first order, their distances in edges, and
	/// the faces between them.
	struct Patch
	{
		std::vector<int> vertices, steps, faces;
	};

	std::vector<Point3d>& points;
	std::vector<Triangle>& triangles;
	const HandleLimits limits;
	std::vector<int> partner;
	std::vector<std::vector<int>> cornersAt; ///< half-edges from each vertex
	std::vector<int> pieceOfPoint, genus;
	std::vector<double> diagonal;
	std::vector<int> placeOf, faceAt; ///< number in the current patch, -1: not in it
	// Scratch of isCertainlyPlanar().
	std::vector<char> reached;
	std::vector<int> front;

	static int next(int h) { return SurfaceMesh::next(h); }
	int origin(int h) const { return triangles[size_t(h) / 3][size_t(h) % 3]; }
	int pieceOf(int v) const { return pieceOfPoint[size_t(v)]; }
	double reach(int v) const { return limits.distance * diagonal[size_t(pieceOf(v))]; }
	double length(int h) const
	{
		return Distance(points[size_t(origin(h))], points[size_t(origin(next(h)))]);
	}

	void measurePieces()
	{
		const std::vector<int> first = pieceOfFaces(partner);
		pieceOfPoint.assign(points.size(), 0);
		std::map<int, int> number;
		std::vector<Box3d> box;
		std::vector<int> euler;
		std::vector<char> seen(points.size(), 0);
		for (size_t f = 0; f < triangles.size(); ++f) {
			const int p = number.emplace(first[f], int(number.size())).first->second;
			if (p == int(box.size())) {
				box.emplace_back();
				euler.push_back(0);
			}
			--euler[size_t(p)]; // twice V - E + F is 2 V - F: two faces have three edges
			for (int v : triangles[f]) {
				box[size_t(p)].Add(points[size_t(v)]);
				pieceOfPoint[size_t(v)] = p;
				if (!std::exchange(seen[size_t(v)], char(1)))
					euler[size_t(p)] += 2;
			}
		}
		for (size_t p = 0; p < box.size(); ++p) {
			genus.push_back(1 - euler[p] / 4);
			diagonal.push_back(box[p].Diag());
		}
	}

	/// Cuts a handle in the smallest patch around a vertex that has one. @return whether it could.
	bool cutAt(int v)
	{
		for (int edges = 2; edges <= limits.edges; ++edges)
			if (const Patch patch = patchAround(v, edges); genusOf(patch) > 0)
				if (const std::vector<int> loop = Loops(*this, patch).shortest();
					!loop.empty() && cutAlong(loop))
					return true;
		return false;
	}

	Patch patchAround(int v, int edges)
	{
		Patch patch;
		const double maximum = reach(v);
		const auto add = [&](int w, int steps) {
			placeOf[size_t(w)] = int(patch.vertices.size());
			patch.vertices.push_back(w);
			patch.steps.push_back(steps);
		};
		add(v, 0);
		for (size_t i = 0; i < patch.vertices.size(); ++i) {
			if (patch.steps[i] == edges)
				break;
			for (int h : cornersAt[size_t(patch.vertices[i])])
				if (const int w = origin(next(h)); placeOf[size_t(w)] < 0
					&& Distance(points[size_t(w)], points[size_t(v)]) <= maximum)
					add(w, patch.steps[i] + 1);
		}
		for (int w : patch.vertices)
			for (int h : cornersAt[size_t(w)])
				if (const Triangle& t = triangles[size_t(h) / 3];
					w == *std::min_element(t.begin(), t.end())
					&& std::all_of(
						t.begin(), t.end(), [&](int u) { return placeOf[size_t(u)] >= 0; }))
					patch.faces.push_back(h / 3);
		for (int w : patch.vertices)
			placeOf[size_t(w)] = -1;
		return patch;
	}

	/// The genus of a patch, summed over its components, each border closed by a disc.
	int genusOf(const Patch& patch)
	{
		const Marked marked(*this, patch);
		if (isCertainlyPlanar(patch, marked))
			return 0;
		const int n = int(patch.faces.size());
		MergeForest pieces(n), fans(3 * n);
		int edges = 0;
		for (int i = 0; i < 3 * n; ++i) {
			const int j = marked.partnerOf(i);
			edges += j < i; // also of a border
			if (j < 0)
				continue;
			pieces.join(i / 3, j / 3);
			fans.join(i, next(j));
			fans.join(next(i), j);
		}
		int components = 0, vertices = 0;
		for (int i = 0; i < n; ++i)
			components += pieces.find(i) == i;
		for (int i = 0; i < 3 * n; ++i)
			vertices += fans.find(i) == i;
		return (2 * components - (vertices - edges + n) - marked.borders(fans)) / 2;
	}

	/// The faces of a patch, numbered in its order while this object lives, and its borders.
	class Marked
	{
	public:
		Marked(HandleCutter& cutter, const Patch& patch) : cutter(cutter), patch(patch)
		{
			for (size_t i = 0; i < patch.faces.size(); ++i)
				cutter.faceAt[size_t(patch.faces[i])] = int(i);
		}
		~Marked()
		{
			for (int f : patch.faces)
				cutter.faceAt[size_t(f)] = -1;
		}

		int halfEdge(int i) const { return 3 * patch.faces[size_t(i) / 3] + i % 3; }
		/// The partner of half-edge i within the patch; -1: i is on a border of the patch.
		int partnerOf(int i) const
		{
			const int h = cutter.partner[size_t(halfEdge(i))];
			const int f = cutter.faceAt[size_t(h) / 3];
			return f < 0 ? -1 : 3 * f + h % 3;
		}
		/// The number of border loops. @param loopOf  gets, for each border half-edge, its loop.
		int borders(MergeForest& fans, std::vector<int>* loopOf = nullptr) const
		{
			std::map<int, int> from; // by the fan at the origin
			const int count = 3 * int(patch.faces.size());
			for (int i = 0; i < count; ++i)
				if (partnerOf(i) < 0)
					from[fans.find(i)] = i;
			std::vector<char> done(size_t(count), 0);
			int loops = 0;
			for (const auto& [fan, start] : from) {
				if (done[size_t(start)])
					continue;
				for (int i = start; !done[size_t(i)]; i = from.at(fans.find(next(i)))) {
					done[size_t(i)] = 1;
					if (loopOf)
						(*loopOf)[size_t(i)] = loops;
				}
				++loops;
			}
			return loops;
		}

	private:
		HandleCutter& cutter;
		const Patch& patch;
	};

	/**
	 * Whether the genus of a patch is 0 by a bound: of c components with b borders it is
	 * (2 c - chi - b) / 2, and b >= c if each of them has one. Points where several fans of faces
	 * meet are counted once in chi, which only raises the bound.
	 */
	bool isCertainlyPlanar(const Patch& patch, const Marked& marked)
	{
		const int n = int(patch.faces.size());
		int edges = 0, vertices = 0, components = 0;
		for (int i = 0; i < 3 * n; ++i) {
			edges += marked.partnerOf(i) < i;
			int& place = placeOf[size_t(origin(marked.halfEdge(i)))];
			vertices += place < 0;
			place = 0;
		}
		for (int i = 0; i < 3 * n; ++i)
			placeOf[size_t(origin(marked.halfEdge(i)))] = -1;
		reached.assign(size_t(n), 0);
		for (int first = 0; first < n; ++first) {
			if (reached[size_t(first)])
				continue;
			++components;
			bool hasBorder = false;
			reached[size_t(first)] = 1;
			front.assign(1, first);
			while (!front.empty()) {
				const int f = front.back();
				front.pop_back();
				for (int i = 3 * f; i < 3 * f + 3; ++i) {
					const int j = marked.partnerOf(i);
					hasBorder = hasBorder || j < 0;
					if (j >= 0 && !reached[size_t(j) / 3]) {
						reached[size_t(j) / 3] = 1;
						front.push_back(j / 3);
					}
				}
			}
			if (!hasBorder)
				return false;
		}
		return components - (vertices - edges + n) < 2;
	}

	/// The loops of a patch that do not separate it. Its vertices are fans of its faces: where
	/// several fans meet at one point, each is a vertex.
	class Loops
	{
	public:
		Loops(HandleCutter& cutter, const Patch& patch) :
				cutter(cutter), marked(cutter, patch), faces(int(patch.faces.size())),
				loopOf(3 * patch.faces.size(), -1), around(3 * patch.faces.size())
		{
			MergeForest fans(3 * faces);
			for (int i = 0; i < 3 * faces; ++i)
				if (const int j = marked.partnerOf(i); j >= 0) {
					fans.join(i, next(j));
					fans.join(next(i), j);
				}
			borders = marked.borders(fans, &loopOf);
			for (int i = 0; i < 3 * faces; ++i) {
				fanOf.push_back(fans.find(i));
				lengths.push_back(cutter.length(marked.halfEdge(i)));
			}
			for (int i = 0; i < 3 * faces; ++i)
				if (marked.partnerOf(i) < i) {
					around[size_t(start(i))].push_back(i);
					around[size_t(end(i))].push_back(i);
				}
		}

		/// The shortest one, as half-edges of the surface in order; empty if there is none.
		std::vector<int> shortest()
		{
			// Each non-separating loop meets a basis loop through any one vertex of its component:
			// the shortest passes through a vertex of one of these.
			std::vector<char> seen(size_t(3 * faces), 0), isSource(size_t(3 * faces), 0);
			double minimum = infinity;
			for (int i = 0; i < 3 * faces; ++i)
				if (const int fan = start(i); !seen[size_t(fan)]) {
					const std::vector<int> ends = growFrom(fan, infinity);
					if (!ends.empty())
						minimum = std::min(minimum, sizeOver(ends.back()));
					for (int e : ends)
						for (int way : wayOver(e))
							isSource[size_t(start(way < 0 ? ~way : way))] =
								isSource[size_t(end(way < 0 ? ~way : way))] = 1;
					for (int k = 0; k < 3 * faces; ++k)
						seen[size_t(k)] |= distance[size_t(k)] < infinity;
				}
			std::vector<int> best;
			for (int i = 0; i < 3 * faces; ++i)
				if (isSource[size_t(i)]) {
					const std::vector<int> ends = growFrom(i, minimum);
					if (ends.empty())
						continue;
					const double size = sizeOver(ends.back());
					if (best.empty() ? size <= minimum : size < minimum) {
						minimum = size;
						best = wayOver(ends.back());
					}
				}
			for (int& way : best)
				way =
					way < 0 ? cutter.partner[size_t(marked.halfEdge(~way))] : marked.halfEdge(way);
			return best;
		}

	private:
		static constexpr double infinity = std::numeric_limits<double>::infinity();
		HandleCutter& cutter;
		const Marked marked;
		const int faces;
		int borders = 0;
		std::vector<int> loopOf;              ///< of each border half-edge; else -1
		std::vector<std::vector<int>> around; ///< edges from and to each fan
		std::vector<int> fanOf;               ///< of the origin of each half-edge
		std::vector<double> lengths;
		std::vector<double> distance; ///< of each fan from the source
		std::vector<int> from;        ///< the edge of the tree to each fan; -1: none

		int start(int i) const { return fanOf[size_t(i)]; }
		int end(int i) const { return fanOf[size_t(next(i))]; }
		double sizeOver(int e) const
		{
			return distance[size_t(start(e))] + lengths[size_t(e)] + distance[size_t(end(e))];
		}

		/**
		 * Grows the tree of shortest paths from a fan, up to half of `longest`. @return the edges that
		 * close it to a basis of the non-separating loops, those of longer loops left out, that of the
		 * shortest one last.
		 * Source: Erickson and Whittlesey, "Greedy optimal homotopy and homology generators", SODA
		 * 2005: the edges neither in that tree nor crossed by the tree of faces and borders that
		 * prefers edges with long loops.
		 */
		std::vector<int> growFrom(int source, double longest)
		{
			distance.assign(3 * size_t(faces), infinity);
			from.assign(3 * size_t(faces), -1);
			using Entry = std::pair<double, int>;
			std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
			distance[size_t(source)] = 0;
			queue.emplace(0, source);
			while (!queue.empty()) {
				const auto [far, at] = queue.top();
				queue.pop();
				if (far > distance[size_t(at)])
					continue;
				for (int e : around[size_t(at)]) {
					const int other = start(e) == at ? end(e) : start(e);
					const double there = far + lengths[size_t(e)];
					if (there <= longest / 2 && there < distance[size_t(other)]) {
						distance[size_t(other)] = there;
						from[size_t(other)] = e;
						queue.emplace(there, other);
					}
				}
			}
			MergeForest dual(faces + borders);
			const auto join = [&](int i) {
				const int j = marked.partnerOf(i);
				return dual.join(i / 3, j >= 0 ? j / 3 : faces + loopOf[size_t(i)]);
			};
			std::vector<Entry> loops; // of the edges that are not in the tree, longest first
			for (int i = 0; i < 3 * faces; ++i) {
				if (marked.partnerOf(i) >= i || from[size_t(start(i))] == i
					|| from[size_t(end(i))] == i)
					continue;
				if (const double size = sizeOver(i); size <= longest && size < infinity)
					loops.emplace_back(-size, i);
				else
					join(i);
			}
			std::sort(loops.begin(), loops.end());
			std::vector<int> left;
			for (const auto& [minus, i] : loops)
				if (!join(i))
					left.push_back(i);
			return left;
		}

		/// The loop from the source to the start of an edge, over it, and back, as half-edges of
		/// the patch: i, or ~i for the way against i.
		std::vector<int> wayOver(int edge) const
		{
			std::vector<int> way;
			for (int at = start(edge); from[size_t(at)] >= 0;) {
				const int e = from[size_t(at)];
				way.push_back(end(e) == at ? e : ~e);
				at = end(e) == at ? start(e) : end(e);
			}
			std::reverse(way.begin(), way.end());
			way.push_back(edge);
			for (int at = end(edge); from[size_t(at)] >= 0;) {
				const int e = from[size_t(at)];
				way.push_back(end(e) == at ? ~e : e);
				at = end(e) == at ? start(e) : end(e);
			}
			return way;
		}
	};

	/// Cuts the surface along a loop, and caps both sides. @return false, with nothing changed, if
	/// the loop visits a vertex twice or no cap is possible.
	bool cutAlong(const std::vector<int>& loop)
	{
		const int n = int(loop.size());
		if (n < 3)
			return false;
		std::vector<int> corner;
		for (int h : loop)
			corner.push_back(origin(h));
		std::vector<int> sorted = corner;
		std::sort(sorted.begin(), sorted.end());
		if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
			return false;
		std::vector<Point3d> polygon, outside;
		for (int k = 0; k < n; ++k) {
			polygon.push_back(points[size_t(corner[size_t(k)])]);
			const Triangle& t = triangles[size_t(partner[size_t(loop[size_t(k)])]) / 3];
			const Point3d& a = points[size_t(t[0])];
			const Point3d normal = (points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a);
			outside.push_back(normal.Norm() > 0 ? normal / normal.Norm() : normal);
		}
		const auto isEdge = [&](int a, int b) {
			const auto& from = cornersAt[size_t(a)];
			return std::any_of(
				from.begin(), from.end(), [&](int h) { return origin(next(h)) == b; });
		};
		const PolygonFilling filling(polygon, outside,
			[&](int a, int b) { return !isEdge(corner[size_t(a)], corner[size_t(b)]); });
		if (!std::isfinite(filling.weight().turn))
			return false;

		// The corners on the left of the loop keep its vertices; those on its right get copies.
		std::vector<int> copy;
		std::vector<std::vector<int>> right;
		for (int k = 0; k < n; ++k) {
			// Around the vertex, from the right of the edge that leaves it to that which arrives.
			const int arriving = loop[size_t((k + n - 1) % n)];
			std::vector<int> turned;
			for (int h = partner[size_t(loop[size_t(k)])];;) {
				h = next(h); // from the vertex, in the face on the right
				turned.push_back(h);
				if (h == partner[size_t(arriving)])
					break;
				h = partner[size_t(h)];
			}
			right.push_back(std::move(turned));
		}
		for (int k = 0; k < n; ++k) {
			const int v = corner[size_t(k)], w = int(points.size());
			const Point3d place = points[size_t(v)];
			points.push_back(place);
			pieceOfPoint.push_back(pieceOf(v));
			placeOf.push_back(-1);
			cornersAt.push_back(right[size_t(k)]);
			copy.push_back(w);
			auto& left = cornersAt[size_t(v)];
			left.erase(std::remove_if(left.begin(), left.end(),
						   [&](int h) {
							   return std::find(right[size_t(k)].begin(), right[size_t(k)].end(), h)
								   != right[size_t(k)].end();
						   }),
				left.end());
			for (int h : right[size_t(k)])
				triangles[size_t(h) / 3][size_t(h) % 3] = w;
		}
		drawBack(corner);
		drawBack(copy);
		// A cap runs along its side of the loop the other way round.
		std::vector<int> across;
		for (int h : loop)
			across.push_back(partner[size_t(h)]);
		addCap(filling.triangles(), copy, across, false);
		addCap(filling.triangles(), corner, loop, true);
		return true;
	}

	/// Moves a border towards its own side, so that the two caps do not touch: there is a gap where
	/// a bridge was, or a wall where a tunnel was.
	void drawBack(const std::vector<int>& border)
	{
		constexpr double part = 0.25; // of the way to the neighbours
		std::vector<Point3d> places;
		for (int v : border) {
			Point3d sum(0, 0, 0);
			int count = 0;
			for (int h : cornersAt[size_t(v)])
				if (const int w = origin(next(h));
					std::find(border.begin(), border.end(), w) == border.end()) {
					sum += points[size_t(w)];
					++count;
				}
			const Point3d& at = points[size_t(v)];
			places.push_back(count ? at + (sum / double(count) - at) * part : at);
		}
		for (size_t k = 0; k < border.size(); ++k)
			points[size_t(border[k])] = places[k];
	}

	/// Adds a cap and pairs its half-edges. @param corner  the vertices of the loop. @param sides
	/// half-edges between consecutive ones, in either direction. @param turned  flips the cap.
	void addCap(const std::vector<Triangle>& cap, const std::vector<int>& corner,
		const std::vector<int>& sides, bool turned)
	{
		std::map<std::pair<int, int>, int> open; // half-edges without a partner, by their ends
		for (int h : sides)
			open[{origin(h), origin(next(h))}] = h;
		for (Triangle t : cap) {
			if (turned)
				std::swap(t[1], t[2]);
			const int f = int(triangles.size());
			triangles.push_back({corner[size_t(t[0])], corner[size_t(t[1])], corner[size_t(t[2])]});
			faceAt.push_back(-1);
			for (int h = 3 * f; h < 3 * f + 3; ++h) {
				partner.push_back(-1);
				cornersAt[size_t(origin(h))].push_back(h);
			}
			for (int h = 3 * f; h < 3 * f + 3; ++h) {
				const auto other = open.find({origin(next(h)), origin(h)});
				if (other == open.end())
					open[{origin(h), origin(next(h))}] = h;
				else {
					partner[size_t(h)] = other->second;
					partner[size_t(other->second)] = h;
					open.erase(other);
				}
			}
		}
	}
};

} // namespace detail

/**
 * Cuts the handles of a closed surface that lie within a small part of it, see HandleLimits: they
 * have too few triangles to be meant. Each is cut along the shortest loop in that part which does
 * not separate it, and both sides are capped: a bridge is parted, or a tunnel filled, whichever is
 * narrower.
 *
 * @param points    mesh units; get new ones at their end, and those along a cut move.
 * @param triangles a closed, oriented two-manifold; are changed.
 * @return the number of handles cut.
 * @throws Cancelled. Complexity: O(V) if there are no handles; else O(V + h n^2 log n) for h of
 *         them and n vertices within the limits.
 */
inline int cutHandles(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const HandleLimits& limits = HandleLimits(), const Progress& progress = Progress())
{
	return detail::HandleCutter(points, triangles, limits).run(progress);
}

} // namespace vcg::tri::mcf

#endif
