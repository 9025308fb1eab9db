// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The solid as pieces glued together: the structure on which collapsing to curves is safe.

#ifndef VCG_MCF_GLUED_COMPLEX_H
#define VCG_MCF_GLUED_COMPLEX_H

#include "merge_forest.h"
#include "surface_mesh.h"

#include <algorithm>
#include <array>
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
 * stay glued. A piece that has shrunk to two triangles back to back and is contracted once more
 * leaves a curve edge. So the solid is at any time a union of pieces and curve edges that share
 * nodes; a node is a set of copies of one vertex, one or more in each piece that meets there.
 *
 * contract() merges two nodes in all pieces at once, and only if each piece keeps its topology
 * (link condition) and no loop A B C of three edges without a triangle would vanish (a real cycle
 * of the shape). Both together keep the homotopy type of the union, by construction: the skeleton
 * has a component for each component of the surface, and as many cycles as its genus.
 */
class GluedComplex
{
public:
	/// @pre surface is compact.
	explicit GluedComplex(const SurfaceMesh& surface) :
			mesh(surface), nodes(surface.vertexSlots()), copies(surface.vertexSlots()),
			curve(surface.vertexSlots()), nodeOfCopy(surface.vertexSlots()),
			positions(surface.position), weight(surface.vertexSlots(), 1)
	{
		for (int v = 0; v < surface.vertexSlots(); ++v) {
			copies[v].push_back(v);
			nodeOfCopy[v] = v;
		}
	}

	int nodeSlots() const { return int(copies.size()); }
	/// The node into which node A has merged.
	int find(int A) { return nodes.find(A); }
	/// The mean of the vertices that have merged into the node.
	const Point3d& position(int A) const { return positions[A]; }
	double squaredLength(int A, int B) const { return SquaredDistance(positions[A], positions[B]); }
	/// Nodes joined to A by curve edges.
	const std::set<int>& curveNeighbours(int A) const { return curve[A]; }
	bool hasFaces() const { return mesh.faceCount() > 0; }

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

	/// The outcome of contract().
	enum class Outcome {
		Contracted, ///< B stands for both
		NoFaces,    ///< the pair has no edge with faces (any more)
		Blocked     ///< a cycle of the shape would vanish
	};

	/// Contracts the edge A B into B. @pre A and B stand for themselves.
	Outcome contract(int A, int B)
	{
		std::vector<int> halfEdges = halfEdgesBetween(A, B);
		if (halfEdges.empty())
			return Outcome::NoFaces;
		if (!emptyTriangle(A, B, halfEdges).empty())
			return Outcome::Blocked;
		// One at a time: a piece that is glued to itself may have the edge twice.
		while (!halfEdges.empty()) {
			const int h = halfEdges.front();
			if (!cutPinch(h)) {
				if (mesh.apex(h) == mesh.apex(mesh.twin(h)))
					flattenLastTriangle(h);
				else
					collapsePiece(h);
			}
			halfEdges = halfEdgesBetween(A, B);
		}
		mergeNodes(A, B);
		return Outcome::Contracted;
	}

	/// The third nodes of the empty triangles that block the contraction of A B.
	std::vector<int> blockingNodes(int A, int B)
	{
		return emptyTriangle(A, B, halfEdgesBetween(A, B));
	}

	/// Puts a new node in the middle of the edge A B, in all pieces and on the curve. @return it.
	int split(int A, int B)
	{
		const int M = nodes.add();
		const Point3d middle = (positions[A] + positions[B]) / 2.0;
		copies.emplace_back();
		curve.emplace_back();
		positions.push_back(middle);
		weight.push_back(0); // stands for no vertex of the surface
		for (int h : halfEdgesBetween(A, B)) {
			const int m = mesh.split(h, middle);
			nodeOfCopy.push_back(M);
			copies[M].push_back(m);
		}
		if (curve[A].erase(B)) {
			curve[B].erase(A);
			addCurveEdge(A, M);
			addCurveEdge(M, B);
		}
		return M;
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
	std::vector<double> weight;

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
		std::set_intersection(ofA.begin(), ofA.end(), ofB.begin(), ofB.end(), std::back_inserter(common));
		for (int h : halfEdges)
			for (int e : {h, mesh.twin(h)})
				filled.push_back(nodeOf(mesh.apex(e)));
		// A pinch inside one piece is filled too: the piece will be cut there.
		for (int h : halfEdges)
			for (int c : pinchVertices(h))
				filled.push_back(nodeOf(c));
		std::sort(filled.begin(), filled.end());
		std::set_difference(common.begin(), common.end(), filled.begin(), filled.end(), std::back_inserter(empty));
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

	/// Cuts the piece of h where collapsing h would pinch it. @return whether there was such a place.
	bool cutPinch(int h)
	{
		const int c = mesh.pinchVertex(h);
		if (c < 0)
			return false;
		const int a = mesh.origin(h), b = mesh.target(h);
		const std::array<int, 3> made =
			mesh.cutAlong({h, mesh.findHalfEdge(b, c), mesh.findHalfEdge(c, a)});
		const std::array<int, 3> from = {a, b, c};
		for (int k = 0; k < 3; ++k) {
			const int node = nodeOf(from[k]);
			nodeOfCopy.push_back(node);
			copies[node].push_back(made[k]);
		}
		return true;
	}

	/// Collapses h in its piece; its origin's copy disappears.
	void collapsePiece(int h)
	{
		const int a = mesh.origin(h);
		mesh.collapse(h);
		dropCopy(a);
	}

	/// The piece of h is two triangles back to back: what is left of it is the edge to their apex.
	void flattenLastTriangle(int h)
	{
		const int a = mesh.origin(h), b = mesh.target(h), c = mesh.apex(h);
		const int t = mesh.twin(h);
		addCurveEdge(nodeOf(b), nodeOf(c));
		mesh.removeFace(h / 3);
		mesh.removeFace(t / 3);
		for (int v : {a, b, c}) {
			mesh.removeVertex(v);
			dropCopy(v);
		}
	}

	void dropCopy(int copy)
	{
		std::vector<int>& list = copies[nodeOf(copy)];
		list.erase(std::find(list.begin(), list.end(), copy));
	}

	void mergeNodes(int A, int B)
	{
		const double total = weight[A] + weight[B];
		positions[B] = total > 0 ? Point3d((positions[A] * weight[A] + positions[B] * weight[B]) / total)
								 : Point3d((positions[A] + positions[B]) / 2.0);
		weight[B] = total;
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
