// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The lean triangle mesh that every stage works on: a corner table of closed two-manifolds.

#ifndef VCG_MCF_SURFACE_MESH_H
#define VCG_MCF_SURFACE_MESH_H

#include "twin_pairing.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

using Triangle = std::array<int, 3>;

/**
 * A closed, oriented, two-manifold triangle mesh of any number of components.
 *
 * Half-edge h = 3 f + k runs along triangle f from its corner k to its corner k + 1; its twin runs
 * back along the neighbour. Fourteen integers a vertex, no pointers: a collapse touches one vertex
 * ring. Removed vertices and faces stay as holes in the numbering until compact().
 *
 * Orders (rings, faces, vertices) depend on indices only: the same calls give the same bits.
 */
class SurfaceMesh
{
public:
	/// Position of each vertex, mesh units; removed vertices keep theirs.
	std::vector<Point3d> position;

	SurfaceMesh() = default;

	/**
	 * Builds the connectivity of `triangles` (counter-clockwise seen from outside).
	 * @pre every edge has two triangles of opposite direction, every vertex one fan: see
	 *      checkedSurface(), which establishes this and explains what is wrong where it cannot.
	 * @throws InvalidInput if an edge has no twin; Cancelled.
	 * Complexity: O(V + F).
	 */
	SurfaceMesh(std::vector<Point3d> points, const std::vector<Triangle>& triangles,
		const Progress& progress = Progress()) :
			position(std::move(points))
	{
		setTriangles(triangles, progress.part(0, 0.1));
		if (!detail::pairTwins(origins, twins, vertexSlots(), progress.part(0.1, 0.9)))
			throw InvalidInput("The mesh is not closed, or its faces are not oriented alike.");
		chooseOutgoing(progress.part(0.9, 1));
	}

	/**
	 * The mesh of `triangles` if they are a closed, coherently oriented two-manifold, else nothing:
	 * each directed edge occurs once, and so does its reverse, and the triangles at each vertex
	 * form one fan. Vertices may be unused.
	 * @throws Cancelled. Complexity: O(V + F).
	 */
	static std::optional<SurfaceMesh> ifClosedManifold(std::vector<Point3d> points,
		const std::vector<Triangle>& triangles, const Progress& progress = Progress())
	{
		bool distinct = true;
		detail::reportedLoop(int(triangles.size()), progress.part(0, 0.02), checking, [&](int f) {
			const Triangle& t = triangles[f];
			distinct &= t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
		});
		if (!distinct)
			return std::nullopt;
		SurfaceMesh mesh;
		mesh.position = std::move(points);
		mesh.setTriangles(triangles, progress.part(0.02, 0.2));
		const Progress pairing = progress.part(0.2, 0.65);
		if (!detail::pairTwins(mesh.origins, mesh.twins, mesh.vertexSlots(), pairing)) {
			// Memory is given back in pieces, too.
			pairing.report(1, checking);
			mesh.position = std::vector<Point3d>();
			pairing.report(1, checking);
			return std::nullopt;
		}
		mesh.chooseOutgoing(progress.part(0.65, 0.75));
		// One ring of distinct neighbours at each vertex, and no half-edge outside of these rings.
		long inRings = 0;
		detail::reportedLoop(mesh.vertexSlots(), progress.part(0.75, 1), checking, [&](int v) {
			if (!distinct || !mesh.isVertex(v))
				return;
			const int stamp = mesh.nextStamp();
			mesh.forEachOutgoing(v, [&](int h) {
				distinct &= mesh.stamps[mesh.target(h)] != stamp;
				mesh.stamps[mesh.target(h)] = stamp;
				++inRings;
			});
		});
		if (!distinct || inRings != mesh.halfEdgeSlots())
			return std::nullopt;
		return mesh;
	}

	/// Whether ifClosedManifold() has a mesh for `triangles` on so many vertices. @throws Cancelled
	static bool isClosedManifold(size_t vertices, const std::vector<Triangle>& triangles,
		const Progress& progress = Progress())
	{
		return ifClosedManifold(
			detail::filledArray(vertices, Point3d(0, 0, 0), progress), triangles, progress)
			.has_value();
	}

	// Sizes. The ids run over [0, vertexSlots()) and [0, faceSlots()), holes included.

	int vertexSlots() const { return int(outgoings.size()); }
	int faceSlots() const { return int(origins.size() / 3); }
	int halfEdgeSlots() const { return int(origins.size()); }
	int vertexCount() const { return liveVertices; }
	int faceCount() const { return liveFaces; }
	int edgeCount() const { return liveFaces + liveFaces / 2; }
	bool isVertex(int v) const { return outgoings[v] >= 0; }
	bool isFace(int f) const { return origins[3 * f] >= 0; }
	bool isHalfEdge(int h) const { return origins[h] >= 0; }

	/// V - E + F: 2 (components - genus).
	int eulerCharacteristic() const { return vertexCount() - edgeCount() + faceCount(); }

	// Walking.

	static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
	static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
	int twin(int h) const { return twins[h]; }
	int origin(int h) const { return origins[h]; }
	int target(int h) const { return origins[next(h)]; }
	/// The vertex across from the edge, in the half-edge's own triangle.
	int apex(int h) const { return origins[previous(h)]; }
	/// A half-edge that starts at v.
	int outgoing(int v) const { return outgoings[v]; }
	/// The next half-edge out of the same vertex, clockwise.
	int rotated(int h) const { return next(twins[h]); }
	/// Of the two half-edges of an edge, the one with the lower id stands for it.
	bool isEdge(int h) const { return isHalfEdge(h) && h < twins[h]; }

	Triangle triangle(int f) const
	{
		return {origins[3 * f], origins[3 * f + 1], origins[3 * f + 2]};
	}

	/// Calls visit(h) for each half-edge out of v.
	template <class Visitor>
	void forEachOutgoing(int v, Visitor&& visit) const
	{
		const int first = outgoings[v];
		int h = first;
		do {
			visit(h);
			h = rotated(h);
		} while (h != first);
	}

	/// Calls visit(f) for each face of which v is the first corner: over the vertices of whole
	/// components, for each face once.
	template <class Visitor>
	void forEachOwnFace(int v, Visitor&& visit) const
	{
		forEachOutgoing(v, [&](int h) {
			if (h % 3 == 0)
				visit(h / 3);
		});
	}

	int valence(int v) const
	{
		int count = 0;
		forEachOutgoing(v, [&](int) { ++count; });
		return count;
	}

	/// A half-edge from a to b, or -1.
	int findHalfEdge(int a, int b) const
	{
		int found = -1;
		forEachOutgoing(a, [&](int h) {
			if (target(h) == b)
				found = h;
		});
		return found;
	}

	// Measures.

	/// Twice the area times the unit normal of triangle f.
	Point3d doubleAreaVector(int f) const
	{
		const Point3d& a = position[origins[3 * f]];
		return (position[origins[3 * f + 1]] - a) ^ (position[origins[3 * f + 2]] - a);
	}

	/// Whether triangle f is too thin for a reliable normal: its height is at most a millionth of
	/// the surface's diagonal, a few steps of PrincipalFrame::onGrid().
	bool isSliver(int f, double diagonal) const
	{
		constexpr double thinnest = 1e-6;
		double longest = 0;
		for (int h = 3 * f; h < 3 * f + 3; ++h)
			longest = std::max(longest, squaredLength(h));
		return doubleAreaVector(f).Norm() <= thinnest * diagonal * std::sqrt(longest);
	}

	double squaredLength(int h) const
	{
		return SquaredDistance(position[origin(h)], position[target(h)]);
	}

	/// @throws Cancelled
	double area(const Cancellation& cancel = Cancellation()) const
	{
		double sum = 0;
		detail::cancellableLoop(faceSlots(), cancel, [&](int f) {
			if (isFace(f))
				sum += doubleAreaVector(f).Norm();
		});
		return sum / 2;
	}

	/// Signed volume; positive when the triangles are counter-clockwise seen from outside.
	/// @throws Cancelled
	double volume(const Cancellation& cancel = Cancellation()) const
	{
		// About the middle: this keeps the digits of a mesh far from the origin.
		const Point3d middle = bounds(cancel).Center();
		double sum = 0;
		detail::cancellableLoop(faceSlots(), cancel, [&](int f) {
			if (isFace(f))
				sum += (position[origins[3 * f]] - middle) * doubleAreaVector(f);
		});
		return sum / 6;
	}

	/// @throws Cancelled
	Box3d bounds(const Cancellation& cancel = Cancellation()) const
	{
		Box3d box;
		detail::cancellableLoop(vertexSlots(), cancel, [&](int v) {
			if (isVertex(v))
				box.Add(position[v]);
		});
		return box;
	}

	/// Unit normal of each vertex slot, weighted by area; zero where it is not defined.
	/// @throws Cancelled
	std::vector<Point3d> vertexNormals(const Progress& progress = Progress()) const
	{
		std::vector<Point3d> normals =
			detail::filledArray(size_t(vertexSlots()), Point3d(0, 0, 0), progress);
		detail::reportedLoop(faceSlots(), progress.part(0, 0.8), measuring, [&](int f) {
			if (!isFace(f))
				return;
			const Point3d n = doubleAreaVector(f);
			for (int k = 0; k < 3; ++k)
				normals[origins[3 * f + k]] += n;
		});
		detail::reportedLoop(vertexSlots(), progress.part(0.8, 1), measuring, [&](int v) {
			Point3d& n = normals[v];
			const double length = n.Norm();
			n = length > 0 ? Point3d(n / length) : Point3d(0, 0, 0);
		});
		return normals;
	}

	/// The live triangles in the order of their ids.
	/// @throws Cancelled
	std::vector<Triangle> triangles(const Cancellation& cancel = Cancellation()) const
	{
		std::vector<Triangle> live;
		live.reserve(liveFaces);
		detail::cancellableLoop(faceSlots(), cancel, [&](int f) {
			if (isFace(f))
				live.push_back(triangle(f));
		});
		return live;
	}

	// Changes of connectivity. Each keeps the mesh a closed two-manifold of the same genus, except
	// addPillow(), cutAlong(), removeFace() and removeVertex().

	/**
	 * A vertex that is a neighbour of both ends of h but in neither triangle at h, so that
	 * collapsing h would pinch the surface; -1 if there is none, which is the link condition
	 * lk(a) n lk(b) = lk(ab). Of several, the first in the ring of target(h). Uses scratch arrays:
	 * not for several threads at once.
	 */
	int pinchVertex(int h) const
	{
		const int a = origin(h);
		const int c = apex(h), d = apex(twins[h]);
		const int stamp = nextStamp();
		forEachOutgoing(a, [&](int e) { stamps[target(e)] = stamp; });
		int pinch = -1;
		forEachOutgoing(target(h), [&](int e) {
			const int x = target(e);
			if (pinch < 0 && stamps[x] == stamp && x != c && x != d)
				pinch = x;
		});
		return pinch;
	}

	/**
	 * Whether collapse(h) keeps the topology: there is no pinchVertex(), and the component of h is
	 * not one of the smallest closed meshes, a tetrahedron or two triangles back to back. Uses
	 * scratch arrays: not for several threads at once.
	 */
	bool isCollapsible(int h) const
	{
		const int t = twins[h];
		if (apex(h) == apex(t))
			return false;
		// The first two half-edges of either ring, clockwise, disappear with the triangles; the
		// last one leads to an apex. Both rings at once: a step waits for the one before.
		int ofOrigin = rotated(rotated(h)), ofTarget = rotated(rotated(t));
		ringOfOrigin.clear();
		ringOfTarget.clear();
		for (; ofOrigin != h && ofTarget != t;
			 ofOrigin = rotated(ofOrigin), ofTarget = rotated(ofTarget)) {
			ringOfOrigin.push_back(ofOrigin);
			ringOfTarget.push_back(ofTarget);
		}
		for (; ofOrigin != h; ofOrigin = rotated(ofOrigin))
			ringOfOrigin.push_back(ofOrigin);
		for (; ofTarget != t; ofTarget = rotated(ofTarget))
			ringOfTarget.push_back(ofTarget);
		if (ringOfOrigin.size() == 1 && ringOfTarget.size() == 1)
			return false; // a tetrahedron
		const int stamp = nextStamp();
		for (size_t i = 0; i + 1 < ringOfOrigin.size(); ++i)
			stamps[target(ringOfOrigin[i])] = stamp;
		bool isAnyShared = false;
		for (size_t i = 0; i + 1 < ringOfTarget.size(); ++i)
			isAnyShared |= stamps[target(ringOfTarget[i])] == stamp;
		return !isAnyShared;
	}

	/**
	 * Merges origin(h) into target(h): two triangles and origin(h) disappear.
	 * @pre isCollapsible(h)
	 */
	void collapse(int h)
	{
		const int a = origin(h), b = target(h);
		forEachOutgoing(a, [&](int e) { origins[e] = b; });
		closeGap(h, a, b);
	}

	/**
	 * collapse(h) if isCollapsible(h), without walking round both ends again.
	 * @param visit (half-edge): called for each half-edge out of the merged vertex, in no
	 *              particular order; must not change the mesh.
	 * @return whether h was collapsed.
	 */
	template <class Visitor>
	bool collapseIfPossible(int h, Visitor&& visit)
	{
		if (!isCollapsible(h))
			return false;
		const int a = origin(h), b = target(h);
		for (int e : ringOfOrigin)
			origins[e] = b;
		closeGap(h, a, b);
		for (int e : ringOfOrigin)
			visit(e);
		for (int e : ringOfTarget)
			visit(e);
		return true;
	}

	/**
	 * Puts a new vertex at `point` on the edge of h and joins it to both apexes.
	 * @pre the apexes differ.
	 * @return the new vertex, m. Edge (a b) of triangles (a b c) and (b a d): h ends at m, its twin
	 *         starts there, next(h) runs from m to c, previous(twin(h)) from d to m. The last two
	 *         faces are (m b c) and (b m d), with the edges (b c) and (d b) under new ids.
	 */
	int split(int h, const Point3d& point)
	{
		const int t = twins[h];
		const int b = target(h), c = apex(h), d = apex(t);
		const int m = int(position.size());
		position.push_back(point);
		outgoings.push_back(-1);
		stamps.push_back(0);
		++liveVertices;
		// (a b c) becomes (a m c) and (m b c); (b a d) becomes (m a d) and (b m d).
		const int bc = next(h), bcTwin = twins[bc];
		const int db = previous(t), dbTwin = twins[db];
		const int f = addFace(m, b, c), g = addFace(b, m, d);
		origins[bc] = m;
		origins[t] = m;
		join(f + 1, bcTwin);
		join(f + 2, bc);
		join(f, g);
		join(g + 2, dbTwin);
		join(g + 1, db);
		outgoings[m] = f;
		outgoings[b] = g;
		outgoings[c] = f + 2;
		outgoings[d] = g + 2;
		return m;
	}

	/**
	 * Adds two triangles back to back, (a b c) and (b a c), with vertices of their own: the
	 * smallest component there is. The Euler characteristic grows by two.
	 * @return a, b, c.
	 */
	std::array<int, 3> addPillow(const std::array<Point3d, 3>& corners)
	{
		const int a = int(position.size()), b = a + 1, c = a + 2;
		position.insert(position.end(), corners.begin(), corners.end());
		stamps.insert(stamps.end(), 3, 0);
		liveVertices += 3;
		const int front = addFace(a, b, c), back = addFace(b, a, c);
		join(front, back);
		join(front + 1, back + 2);
		join(front + 2, back + 1);
		outgoings.insert(outgoings.end(), {front, front + 1, front + 2});
		return {a, b, c};
	}

	/// Whether the other diagonal of the two triangles at h is not an edge yet.
	bool isFlippable(int h) const
	{
		const int c = apex(h), d = apex(twins[h]);
		return c != d && findHalfEdge(c, d) < 0;
	}

	/**
	 * Replaces the edge of h by the other diagonal; h then runs from apex(twin(h)) to apex(h).
	 * @pre isFlippable(h)
	 */
	void flip(int h)
	{
		const int t = twins[h];
		const int a = origin(h), b = target(h), c = apex(h), d = apex(t);
		const int hn = next(h), hp = previous(h), tn = next(t), tp = previous(t);
		const int bc = twins[hn], ca = twins[hp], ad = twins[tn], db = twins[tp];
		// (a b c), (b a d) become (d c a), (c d b), with h = d c and t = c d.
		origins[h] = d;
		origins[hn] = c;
		origins[hp] = a;
		origins[t] = c;
		origins[tn] = d;
		origins[tp] = b;
		join(hn, ca);
		join(hp, ad);
		join(tn, db);
		join(tp, bc);
		outgoings[a] = hp;
		outgoings[b] = tp;
		outgoings[c] = t;
		outgoings[d] = h;
	}

	/**
	 * Cuts the surface along the closed path of three half-edges (a b), (b c), (c a) that bound no
	 * triangle, and closes both lips by a triangle. The side left of the path keeps a, b, c, the
	 * other gets copies of them. The Euler characteristic grows by two.
	 * @return the copies of a, b, c.
	 */
	std::array<int, 3> cutAlong(const std::array<int, 3>& path)
	{
		const std::array<int, 3> back = {twins[path[0]], twins[path[1]], twins[path[2]]};
		std::array<int, 3> copies;
		for (int k = 0; k < 3; ++k) {
			copies[k] = int(position.size());
			position.push_back(Point3d(position[origin(path[k])]));
			outgoings.push_back(-1);
			stamps.push_back(0);
			++liveVertices;
		}
		// The fan right of the path at its k-th vertex: clockwise from the edge that leaves along
		// the path to the edge that came, both seen as half-edges out of the vertex.
		for (int k = 0; k < 3; ++k) {
			const int last = back[(k + 2) % 3];
			int h = path[k];
			while (h != last) {
				h = rotated(h);
				ringScratch.push_back(h);
			}
		}
		// Each back half-edge ends the fan of one vertex; all walks are done before ids change.
		size_t i = 0;
		for (int k = 0; k < 3; ++k) {
			const int last = back[(k + 2) % 3];
			for (;; ++i) {
				origins[ringScratch[i]] = copies[k];
				if (ringScratch[i] == last) {
					++i;
					break;
				}
			}
		}
		ringScratch.clear();
		const int a = origin(path[0]), b = origin(path[1]), c = origin(path[2]);
		const int left = addFace(b, a, c); // b a, a c, c b
		join(left, path[0]);
		join(left + 1, path[2]);
		join(left + 2, path[1]);
		const int right = addFace(copies[0], copies[1], copies[2]);
		join(right, back[0]);
		join(right + 1, back[1]);
		join(right + 2, back[2]);
		for (int k = 0; k < 3; ++k) {
			outgoings[origin(path[k])] = path[k];
			outgoings[copies[k]] = right + k;
		}
		return copies;
	}

	/// Removes face f without updating its neighbours. @pre all of its component is removed, too.
	void removeFace(int f)
	{
		for (int k = 0; k < 3; ++k)
			origins[3 * f + k] = -1;
		--liveFaces;
	}

	/// Removes vertex v. @pre all of its faces are removed.
	void removeVertex(int v)
	{
		outgoings[v] = -1;
		--liveVertices;
	}

	/// Gives back memory that splits and removals have left unused: for meshes that are kept.
	void trim()
	{
		position.shrink_to_fit();
		for (std::vector<int>* array : {&origins, &twins, &outgoings, &stamps})
			array->shrink_to_fit();
	}

	/**
	 * Closes the holes in the numbering, order kept, and makes each vertex's outgoing half-edge its
	 * lowest one, so that the mesh equals one built from its triangles.
	 * @return for each old vertex id the new one, -1 where it was removed.
	 * @throws Cancelled; the mesh is unspecified then and must be discarded.
	 */
	std::vector<int> compact(const Progress& progress = Progress())
	{
		std::vector<int> newVertex = detail::filledArray(size_t(vertexSlots()), -1, progress);
		int v = 0;
		detail::reportedLoop(vertexSlots(), progress.part(0, 0.2), ordering, [&](int old) {
			if (!isVertex(old))
				return;
			newVertex[old] = v;
			position[v] = position[old];
			++v;
		});
		position.resize(v);
		const Progress ofFaces = progress.part(0.2, 0.4);
		std::vector<int> newFace = detail::filledArray(size_t(faceSlots()), -1, ofFaces);
		int f = 0;
		detail::reportedLoop(faceSlots(), ofFaces, ordering, [&](int old) {
			if (isFace(old))
				newFace[old] = f++;
		});
		detail::reportedLoop(faceSlots(), progress.part(0.4, 0.9), ordering, [&](int old) {
			if (newFace[old] < 0)
				return;
			for (int k = 0; k < 3; ++k) {
				const int t = twins[3 * old + k];
				origins[3 * newFace[old] + k] = newVertex[origins[3 * old + k]];
				twins[3 * newFace[old] + k] = 3 * newFace[t / 3] + t % 3;
			}
		});
		origins.resize(3 * size_t(f));
		twins.resize(3 * size_t(f));
		outgoings.assign(v, -1);
		stamps.assign(v, 0);
		stampClock = 0;
		chooseOutgoing(progress.part(0.9, 1));
		return newVertex;
	}

	/// A copy; copying can be cancelled.
	/// @throws Cancelled
	SurfaceMesh copied(const Cancellation& cancel) const
	{
		SurfaceMesh copy;
		const auto take = [&](const auto array) {
			copy.*array = detail::copiedArray(this->*array, cancel);
		};
		take(&SurfaceMesh::position);
		take(&SurfaceMesh::origins);
		take(&SurfaceMesh::twins);
		take(&SurfaceMesh::outgoings);
		take(&SurfaceMesh::stamps);
		copy.stampClock = stampClock;
		copy.liveVertices = liveVertices;
		copy.liveFaces = liveFaces;
		return copy;
	}

	/**
	 * The same mesh with other ids for its vertices and faces, without holes in the numbering.
	 * @param newVertex for each vertex slot its new id, -1 where it was removed; likewise newFace.
	 * @param firstCorner for each face slot which corner becomes its first one; empty: corner 0.
	 * @pre the new ids are those from 0 to the number of live elements, each once.
	 * @throws Cancelled
	 */
	SurfaceMesh renumbered(const std::vector<int>& newVertex, const std::vector<int>& newFace,
		const std::vector<char>& firstCorner = {}, const Progress& progress = Progress()) const
	{
		const auto newId = [&](int h) {
			const int corner = firstCorner.empty() ? h % 3 : (h % 3 + 3 - firstCorner[h / 3]) % 3;
			return 3 * newFace[h / 3] + corner;
		};
		SurfaceMesh result;
		const Progress ofVertices = progress.part(0, 0.2), ofFaces = progress.part(0.2, 0.8);
		detail::fillArray(result.position, size_t(liveVertices), Point3d(0, 0, 0), ofVertices);
		detail::reportedLoop(vertexSlots(), ofVertices, ordering, [&](int v) {
			if (newVertex[v] >= 0)
				result.position[newVertex[v]] = position[v];
		});
		result.liveFaces = liveFaces;
		for (std::vector<int>* array : {&result.origins, &result.twins})
			detail::fillArray(*array, 3 * size_t(liveFaces), -1, ofFaces);
		detail::reportedLoop(halfEdgeSlots(), ofFaces, ordering, [&](int h) {
			if (newFace[h / 3] < 0)
				return;
			const int id = newId(h);
			result.origins[id] = newVertex[origins[h]];
			result.twins[id] = newId(twins[h]);
		});
		const Progress ofLinks = progress.part(0.8, 1);
		detail::fillArray(result.outgoings, result.position.size(), -1, ofLinks);
		result.chooseOutgoing(ofLinks);
		return result;
	}

	/**
	 * Turns faces over: (a, b, c) becomes (a, c, b). Applied twice, it restores the mesh.
	 * @param isTurned bool(vertex): whether to turn the faces at it; the same for all vertices of a
	 *                 component.
	 * @throws Cancelled. Complexity: O(V + F).
	 */
	template <class IsTurned>
	void turnOver(IsTurned&& isTurned, const Cancellation& cancel = Cancellation())
	{
		const auto newId = [](int h) { return h + 2 - 2 * (h % 3); };
		detail::cancellableLoop(faceSlots(), cancel, [&](int f) {
			if (!isFace(f) || !isTurned(origins[3 * f]))
				return;
			std::swap(origins[3 * f + 1], origins[3 * f + 2]);
			std::swap(twins[3 * f], twins[3 * f + 2]);
			for (int h = 3 * f; h < 3 * f + 3; ++h)
				twins[h] = newId(twins[h]);
		});
		const int last = halfEdgeSlots() - 1;
		detail::cancellableLoop(halfEdgeSlots(), cancel, [&](int i) {
			if (const int h = last - i; isHalfEdge(h))
				outgoings[origins[h]] = h;
		});
	}

private:
	static constexpr const char* checking = "Checking the surface";
	static constexpr const char* measuring = "Measuring the surface";
	static constexpr const char* ordering = "Ordering the surface";
	static constexpr const char* linking = "Linking the surface";

	std::vector<int> origins;
	std::vector<int> twins;
	std::vector<int> outgoings;
	int liveVertices = 0;
	int liveFaces = 0;
	mutable std::vector<int> stamps;
	mutable int stampClock = 0;
	std::vector<int> ringScratch;
	/// Of the last edge in isCollapsible(): the half-edges out of its ends that a collapse leaves.
	mutable std::vector<int> ringOfOrigin, ringOfTarget;

	void join(int h, int t)
	{
		twins[h] = t;
		twins[t] = h;
	}

	/// Ends a collapse of h that merged a into b: removes its triangles, joins their neighbours.
	void closeGap(int h, int a, int b)
	{
		const int t = twins[h];
		const int c = apex(h), d = apex(t);
		const int cb = twins[next(h)], bc = twins[previous(h)];
		const int da = twins[next(t)], bd = twins[previous(t)];
		join(cb, bc);
		join(da, bd);
		removeFace(h / 3);
		removeFace(t / 3);
		outgoings[a] = -1;
		--liveVertices;
		outgoings[b] = bc;
		outgoings[c] = cb;
		outgoings[d] = da;
	}

	int addFace(int a, int b, int c)
	{
		const int h = int(origins.size());
		origins.insert(origins.end(), {a, b, c});
		twins.insert(twins.end(), {-1, -1, -1});
		++liveFaces;
		return h;
	}

	int nextStamp() const
	{
		if (stampClock == std::numeric_limits<int>::max()) {
			std::fill(stamps.begin(), stamps.end(), 0);
			stampClock = 0;
		}
		return ++stampClock;
	}

	void setTriangles(const std::vector<Triangle>& triangles, const Progress& progress)
	{
		detail::fillArray(origins, 3 * triangles.size(), -1, progress);
		detail::fillArray(twins, origins.size(), -1, progress);
		detail::fillArray(outgoings, position.size(), -1, progress);
		detail::reportedLoop(int(triangles.size()), progress.part(0.75, 1), checking, [&](int f) {
			for (int k = 0; k < 3; ++k)
				origins[3 * f + k] = triangles[f][k];
		});
		liveFaces = int(triangles.size());
	}

	/// @throws Cancelled
	void chooseOutgoing(const Progress& progress = Progress())
	{
		const int last = halfEdgeSlots() - 1;
		detail::reportedLoop(halfEdgeSlots(), progress, linking,
			[&](int i) { outgoings[origins[last - i]] = last - i; });
		liveVertices =
			int(std::count_if(outgoings.begin(), outgoings.end(), [](int h) { return h >= 0; }));
		detail::fillArray(stamps, outgoings.size(), 0, progress);
	}
};

} // namespace vcg::tri::mcf

#endif
