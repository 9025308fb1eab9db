// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The solid as pieces glued together: the structure on which collapsing to curves is safe.

#ifndef VCG_MCF_GLUED_COMPLEX_H
#define VCG_MCF_GLUED_COMPLEX_H

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A solid on its way to a curve skeleton.
 *
 * The surface starts as the boundary of one piece for each component. Where an edge cannot be
 * contracted because the surface would pinch (three edges a b c that bound no triangle), the piece
 * is cut along a b c and both lips are closed by the triangle a b c: the two copies of the triangle
 * stay glued. A piece that has shrunk to two triangles back to back (a pillow) and is contracted
 * once more leaves a curve edge. So the solid is at any time a union of pieces and curve edges that
 * share nodes; a node is a set of copies of one vertex, one or more in each piece that meets there.
 *
 * contract() merges two nodes in all pieces at once, and only if each piece keeps its topology
 * (link condition) and no loop A B C of three edges without a triangle would vanish (a real cycle
 * of the shape). Both together keep the homotopy type of the union, and so do the other steps,
 * which help where every contraction would lose a cycle: the skeleton has a component for each
 * component of the surface, and as many cycles as its genus.
 */
class GluedComplex
{
public:
	/**
	 * @param held  1 for held vertices of the surface: nodes of such vertices are where these are;
	 *              empty if there are none.
	 * @pre surface is compact.
	 */
	explicit GluedComplex(const SurfaceMesh& surface, const std::vector<char>& held = {}) :
			mesh(surface), nodes(surface.vertexSlots()), copies(surface.vertexSlots()),
			curve(surface.vertexSlots()), nodeOfCopy(surface.vertexSlots()),
			positions(surface.position), weight(surface.vertexSlots(), 1),
			heldWeight(held.begin(), held.end())
	{
		heldWeight.resize(surface.vertexSlots(), 0);
		for (int v = 0; v < surface.vertexSlots(); ++v) {
			copies[v].push_back(v);
			nodeOfCopy[v] = v;
		}
	}

	int nodeSlots() const { return int(copies.size()); }
	/// The node into which node A has merged.
	int find(int A) { return nodes.find(A); }
	/// The mean of the vertices that have merged into the node, of the held ones if there are any;
	/// or where moveTo() has put it.
	const Point3d& position(int A) const { return positions[A]; }
	/// Whether held vertices have merged into the node.
	bool isHeld(int A) const { return heldWeight[A] > 0; }
	void moveTo(int A, const Point3d& place) { positions[A] = place; }
	double squaredLength(int A, int B) const { return SquaredDistance(positions[A], positions[B]); }
	/// Nodes joined to A by curve edges.
	const std::set<int>& curveNeighbours(int A) const { return curve[A]; }
	/// Faces of all pieces: when none is left, all that is left is the curve.
	int faceCount() const { return mesh.faceCount(); }

	/// Nodes joined to A by edges that have faces, ascending.
	std::vector<int> surfaceNeighbours(int A)
	{
		std::vector<int> result;
		for (int a : copies[A])
			mesh.forEachOutgoing(a, [&](int h) { result.push_back(nodeOf(mesh.target(h))); });
		std::sort(result.begin(), result.end());
		result.erase(std::unique(result.begin(), result.end()), result.end());
		return result;
	}

	/// All live pairs of nodes whose edge has faces.
	std::vector<std::pair<int, int>> surfaceEdges()
	{
		std::vector<std::pair<int, int>> result;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isHalfEdge(h)) {
				const int A = nodeOf(mesh.origin(h)), B = nodeOf(mesh.target(h));
				if (A < B)
					result.emplace_back(A, B);
			}
		std::sort(result.begin(), result.end());
		result.erase(std::unique(result.begin(), result.end()), result.end());
		return result;
	}

	/// The triangles of all pieces as nodes in ascending order, each once, in ascending order.
	std::vector<std::array<int, 3>> surfaceTriangles()
	{
		std::vector<std::array<int, 3>> result;
		for (int f = 0; f < mesh.faceSlots(); ++f)
			if (mesh.isFace(f)) {
				const Triangle t = mesh.triangle(f);
				result.push_back({nodeOf(t[0]), nodeOf(t[1]), nodeOf(t[2])});
				std::sort(result.back().begin(), result.back().end());
			}
		std::sort(result.begin(), result.end());
		result.erase(std::unique(result.begin(), result.end()), result.end());
		return result;
	}

	/// The outcome of contract().
	enum class Outcome {
		Contracted, ///< B stands for both
		NoFaces,    ///< the pair has no edge with faces (any more)
		Blocked     ///< a cycle of the shape would vanish
	};

	/// Contracts the edge A B into B. @pre A and B stand for themselves.
	Outcome contract(int A, int B)
	{
		for (;;) {
			const std::vector<int> halfEdges = halfEdgesBetween(A, B);
			if (halfEdges.empty())
				return Outcome::NoFaces;
			if (!emptyTriangle(A, B, halfEdges).empty())
				return Outcome::Blocked;
			// Each cut settles which loops of the piece bound a disc inside: test all anew.
			if (!cut(A, B))
				break;
		}
		// One at a time: a piece that is glued to itself may have the edge twice.
		for (std::vector<int> left = halfEdgesBetween(A, B); !left.empty();
			 left = halfEdgesBetween(A, B)) {
			if (isPillow(left.front()))
				flattenPillow(left.front());
			else
				collapsePiece(left.front());
		}
		mergeNodes(A, B);
		return Outcome::Contracted;
	}

	/**
	 * Removes the edge A B and the only pillow that has it, in all its copies: the other two edges
	 * are left as curve edges (an elementary collapse).
	 * @return whether there was such an edge: false if another pillow or a solid piece has it.
	 */
	bool removeFreeEdge(int A, int B)
	{
		const std::vector<int> halfEdges = halfEdgesBetween(A, B);
		if (halfEdges.empty())
			return false;
		const int C = nodeOf(mesh.apex(halfEdges.front()));
		for (int h : halfEdges)
			if (!isPillow(h) || nodeOf(mesh.apex(h)) != C)
				return false;
		for (int h : halfEdges)
			removePillow(h);
		curve[A].erase(B);
		curve[B].erase(A);
		addCurveEdge(A, C);
		addCurveEdge(B, C);
		return true;
	}

	/// Cuts one piece that has the edge A B and would pinch there. @return whether there was one.
	bool cut(int A, int B)
	{
		const std::vector<int> halfEdges = halfEdgesBetween(A, B);
		return std::any_of(halfEdges.begin(), halfEdges.end(), [&](int h) { return cutPinch(h); });
	}

	/**
	 * Empties each ball that has a face which no other piece shares: that face is removed, and the
	 * others stay as pillows (an elementary collapse). Of several such faces the largest.
	 * Complexity: O(F log F). @return whether there was such a ball.
	 */
	bool emptyBalls()
	{
		const auto nodesOf = [&](int f) {
			const Triangle t = mesh.triangle(f);
			std::array<int, 3> triple = {nodeOf(t[0]), nodeOf(t[1]), nodeOf(t[2])};
			std::sort(triple.begin(), triple.end());
			return triple;
		};
		std::map<std::array<int, 3>, int> solidFaces; // how many solid pieces have the triangle
		std::map<std::array<int, 3>, std::vector<int>> pillows;
		for (int f = 0; f < mesh.faceSlots(); ++f)
			if (mesh.isFace(f)) {
				if (!isPillow(3 * f))
					++solidFaces[nodesOf(f)];
				else if (f < mesh.twin(3 * f) / 3)
					pillows[nodesOf(f)].push_back(3 * f);
			}
		bool any = false;
		for (const std::vector<int>& piece : solidBalls()) {
			int opened = -1;
			double largest = -1;
			for (int f : piece) {
				const auto [A, B, C] = nodesOf(f);
				const double area =
					((positions[B] - positions[A]) ^ (positions[C] - positions[A])).SquaredNorm();
				if (solidFaces[{A, B, C}] == 1 && area > largest) {
					opened = f;
					largest = area;
				}
			}
			if (opened < 0)
				continue;
			any = true;
			const std::array<int, 3> openedNodes = nodesOf(opened);
			std::vector<std::array<int, 3>> left;
			for (int f : piece) {
				left.push_back(nodesOf(f));
				--solidFaces[left.back()];
			}
			removePiece(piece);
			for (int h : pillows[openedNodes])
				removePillow(h);
			pillows.erase(openedNodes);
			for (const std::array<int, 3>& triple : left)
				if (triple != openedNodes && solidFaces[triple] == 0 && pillows[triple].empty())
					pillows[triple].push_back(addPillow(triple));
		}
		return any;
	}

	/// Contracts a curve edge without faces, if no cycle vanishes by it. @return whether it did.
	bool contractCurveEdge(int A, int B)
	{
		for (int C : curve[A])
			if (curve[B].count(C))
				return false;
		mergeNodes(A, B);
		return true;
	}

private:
	SurfaceMesh mesh;
	MergeForest nodes;
	std::vector<std::vector<int>> copies;
	std::vector<std::set<int>> curve;
	std::vector<int> nodeOfCopy;
	std::vector<Point3d> positions;
	std::vector<double> weight, heldWeight;

	int nodeOf(int copy) { return nodes.find(nodeOfCopy[copy]); }

	void addCurveEdge(int A, int B)
	{
		curve[A].insert(B);
		curve[B].insert(A);
	}

	std::vector<int> halfEdgesBetween(int A, int B)
	{
		std::vector<int> result;
		for (int a : copies[A])
			mesh.forEachOutgoing(a, [&](int h) {
				if (nodeOf(mesh.target(h)) == B)
					result.push_back(h);
			});
		return result;
	}

	/// Common neighbours C of A and B, over surface and curve edges, without a triangle A B C.
	std::vector<int> emptyTriangle(int A, int B, const std::vector<int>& halfEdges)
	{
		const auto allNeighbours = [&](int X) {
			std::vector<int> list = surfaceNeighbours(X);
			list.insert(list.end(), curve[X].begin(), curve[X].end());
			std::sort(list.begin(), list.end());
			list.erase(std::unique(list.begin(), list.end()), list.end());
			return list;
		};
		const std::vector<int> ofA = allNeighbours(A), ofB = allNeighbours(B);
		std::vector<int> common, filled, empty;
		std::set_intersection(
			ofA.begin(), ofA.end(), ofB.begin(), ofB.end(), std::back_inserter(common));
		for (int h : halfEdges)
			for (int e : {h, mesh.twin(h)})
				filled.push_back(nodeOf(mesh.apex(e)));
		// A pinch inside one piece is filled too: the piece will be cut there.
		for (int h : halfEdges)
			for (int c : pinchVertices(h))
				filled.push_back(nodeOf(c));
		std::sort(filled.begin(), filled.end());
		std::set_difference(
			common.begin(), common.end(), filled.begin(), filled.end(), std::back_inserter(empty));
		return empty;
	}

	/// All common neighbours of the ends of h in its piece.
	std::vector<int> pinchVertices(int h) const
	{
		std::vector<int> ofOrigin, result;
		mesh.forEachOutgoing(mesh.origin(h), [&](int e) { ofOrigin.push_back(mesh.target(e)); });
		mesh.forEachOutgoing(mesh.target(h), [&](int e) {
			if (std::find(ofOrigin.begin(), ofOrigin.end(), mesh.target(e)) != ofOrigin.end())
				result.push_back(mesh.target(e));
		});
		return result;
	}

	/// Cuts the piece of h where collapsing h would pinch it. @return whether it would.
	bool cutPinch(int h)
	{
		const int c = mesh.pinchVertex(h);
		if (c < 0)
			return false;
		const int a = mesh.origin(h), b = mesh.target(h);
		const std::array<int, 3> made =
			mesh.cutAlong({h, mesh.findHalfEdge(b, c), mesh.findHalfEdge(c, a)});
		const std::array<int, 3> from = {a, b, c};
		for (int k = 0; k < 3; ++k)
			addCopy(made[k], nodeOf(from[k]));
		return true;
	}

	/// Collapses h in its piece; its origin's copy disappears.
	void collapsePiece(int h)
	{
		const int a = mesh.origin(h);
		mesh.collapse(h);
		dropCopy(a);
	}

	/// Whether the piece of h is two triangles back to back.
	bool isPillow(int h) const { return mesh.apex(h) == mesh.apex(mesh.twin(h)); }

	/// Contracts the edge h of a pillow: what is left of it is the edge to its apex.
	void flattenPillow(int h)
	{
		addCurveEdge(nodeOf(mesh.target(h)), nodeOf(mesh.apex(h)));
		removePillow(h);
	}

	void removePillow(int h) { removePiece({h / 3, mesh.twin(h) / 3}); }

	/// @return a half-edge of the new pillow.
	int addPillow(const std::array<int, 3>& corners)
	{
		const std::array<int, 3> made =
			mesh.addPillow({positions[corners[0]], positions[corners[1]], positions[corners[2]]});
		for (int k = 0; k < 3; ++k)
			addCopy(made[k], corners[k]);
		return mesh.outgoing(made[0]);
	}

	/// Removes all faces of a piece, and with them its copies of the nodes.
	void removePiece(const std::vector<int>& faces)
	{
		std::vector<int> corners;
		for (int f : faces) {
			const Triangle t = mesh.triangle(f);
			corners.insert(corners.end(), t.begin(), t.end());
			mesh.removeFace(f);
		}
		std::sort(corners.begin(), corners.end());
		corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
		for (int v : corners) {
			mesh.removeVertex(v);
			dropCopy(v);
		}
	}

	/// The faces of each piece that is a ball, pillows left out.
	std::vector<std::vector<int>> solidBalls() const
	{
		std::vector<std::vector<int>> balls;
		std::vector<char> seen(mesh.faceSlots(), 0);
		for (int seed = 0; seed < mesh.faceSlots(); ++seed) {
			if (!mesh.isFace(seed) || seen[seed] || isPillow(3 * seed))
				continue;
			std::vector<int> piece(1, seed), corners;
			seen[seed] = 1;
			for (size_t i = 0; i < piece.size(); ++i)
				for (int h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
					corners.push_back(mesh.origin(h));
					const int neighbour = mesh.twin(h) / 3;
					if (!seen[neighbour]) {
						seen[neighbour] = 1;
						piece.push_back(neighbour);
					}
				}
			std::sort(corners.begin(), corners.end());
			const auto vertices = std::unique(corners.begin(), corners.end()) - corners.begin();
			if (2 * vertices
				== std::ptrdiff_t(piece.size()) + 4) // Euler: V - F / 2 = 2 for a sphere
				balls.push_back(std::move(piece));
		}
		return balls;
	}

	/// @pre copies are added in the order of their ids.
	void addCopy(int copy, int node)
	{
		nodeOfCopy.push_back(node);
		copies[node].push_back(copy);
	}

	void dropCopy(int copy)
	{
		std::vector<int>& list = copies[nodeOf(copy)];
		list.erase(std::find(list.begin(), list.end(), copy));
	}

	void mergeNodes(int A, int B)
	{
		const std::vector<double>& share = heldWeight[A] + heldWeight[B] > 0 ? heldWeight : weight;
		const double total = share[A] + share[B];
		if (share[A] > 0)
			positions[B] = share[B] > 0
				? Point3d((positions[A] * share[A] + positions[B] * share[B]) / total)
				: positions[A];
		weight[B] += weight[A];
		heldWeight[B] += heldWeight[A];
		nodes.merge(A, B);
		copies[B].insert(copies[B].end(), copies[A].begin(), copies[A].end());
		copies[A].clear();
		for (int C : std::set<int>(std::move(curve[A]))) {
			curve[C].erase(A);
			if (C != B)
				addCurveEdge(B, C);
		}
		curve[A].clear();
	}
};

} // namespace vcg::tri::mcf

#endif
