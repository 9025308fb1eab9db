// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file From a triangle soup to a closed two-manifold: what is repaired, what is refused, and why.

#ifndef VCG_MCF_CHECK_INPUT_H
#define VCG_MCF_CHECK_INPUT_H

#include "surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace vcg::tri::mcf {

/// The input as the pipeline needs it.
struct CheckedSurface
{
	SurfaceMesh mesh;
	/// For each input vertex the vertex of `mesh`, or -1 where no face uses it.
	std::vector<int> vertexOfInput;
	/// What was repaired on the way, one sentence each, for the log.
	std::vector<std::string> notes;
};

namespace detail {

/// "3 border edges, at (0 0 1), (0 1 1), ..." : how many, and where the first few are.
inline std::string countAndPlaces(size_t count, const char* singular, const char* plural,
	const std::vector<Point3d>& places)
{
	std::ostringstream text;
	text << count << ' ' << (count == 1 ? singular : plural);
	const size_t shown = std::min<size_t>(places.size(), 3);
	for (size_t i = 0; i < shown; ++i)
		text << (i == 0 ? ", at (" : ", (") << places[i][0] << ' ' << places[i][1] << ' '
			 << places[i][2] << ')';
	if (count > shown && shown > 0)
		text << ", ...";
	return text.str();
}

/// A half-edge of the soup, to be sorted by its edge.
struct SoupEdge
{
	int low, high, face;
	bool forward; ///< runs from low to high in its face
	bool operator<(const SoupEdge& other) const
	{
		return std::tie(low, high, face) < std::tie(other.low, other.high, other.face);
	}
};

inline std::vector<SoupEdge> sortedSoupEdges(const std::vector<Triangle>& triangles)
{
	std::vector<SoupEdge> edges;
	edges.reserve(3 * triangles.size());
	for (int f = 0; f < int(triangles.size()); ++f)
		for (int k = 0; k < 3; ++k) {
			const int a = triangles[f][k], b = triangles[f][(k + 1) % 3];
			edges.push_back({std::min(a, b), std::max(a, b), f, a < b});
		}
	std::sort(edges.begin(), edges.end());
	return edges;
}

/// How many faces meet at each edge, as the two counts that must be zero.
struct EdgeDefects
{
	size_t border = 0, nonManifold = 0;
	std::vector<Point3d> borderPlaces, nonManifoldPlaces;
	bool none() const { return border == 0 && nonManifold == 0; }
};

inline EdgeDefects edgeDefects(const std::vector<Point3d>& points, const std::vector<SoupEdge>& edges)
{
	EdgeDefects defects;
	for (size_t i = 0; i < edges.size();) {
		size_t j = i;
		while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high)
			++j;
		const Point3d middle = (points[edges[i].low] + points[edges[i].high]) / 2.0;
		if (j - i == 1) {
			if (++defects.border <= 3)
				defects.borderPlaces.push_back(middle);
		}
		else if (j - i > 2) {
			if (++defects.nonManifold <= 3)
				defects.nonManifoldPlaces.push_back(middle);
		}
		i = j;
	}
	return defects;
}

/// For each point the first one at the very same place.
inline std::vector<int> firstCoincident(const std::vector<Point3d>& points)
{
	std::vector<int> order(points.size()), first(points.size());
	std::iota(order.begin(), order.end(), 0);
	const auto key = [&](int i) { return std::make_tuple(points[i][0], points[i][1], points[i][2], i); };
	std::sort(order.begin(), order.end(), [&](int i, int j) { return key(i) < key(j); });
	for (size_t i = 0; i < order.size(); ++i)
		first[order[i]] =
			i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
	return first;
}

/// Removes faces that use a vertex twice and copies of a face (same corners, same turn).
inline size_t removeDegenerateFaces(std::vector<Triangle>& triangles)
{
	const size_t before = triangles.size();
	triangles.erase(std::remove_if(triangles.begin(), triangles.end(),
						[](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }),
		triangles.end());
	const auto turned = [](Triangle t) {
		std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
		return t;
	};
	std::vector<std::pair<Triangle, int>> keys;
	keys.reserve(triangles.size());
	for (int f = 0; f < int(triangles.size()); ++f)
		keys.emplace_back(turned(triangles[f]), f);
	std::sort(keys.begin(), keys.end());
	std::vector<char> copy(triangles.size(), 0);
	for (size_t i = 1; i < keys.size(); ++i)
		copy[keys[i].second] = keys[i].first == keys[i - 1].first;
	size_t kept = 0;
	for (size_t f = 0; f < triangles.size(); ++f)
		if (!copy[f])
			triangles[kept++] = triangles[f];
	triangles.resize(kept);
	return before - kept;
}

/**
 * Turns faces so that neighbours agree, each connected component (over edges) by itself.
 * @return the number of faces turned, or -1 if the surface is one-sided.
 * @pre every edge has exactly two faces.
 */
inline int orientCoherently(std::vector<Triangle>& triangles, const std::vector<SoupEdge>& edges)
{
	struct Neighbour
	{
		int face;
		bool agrees;
	};
	std::vector<std::array<Neighbour, 3>> neighbours(triangles.size());
	std::vector<char> count(triangles.size(), 0);
	for (size_t i = 0; i + 1 < edges.size(); i += 2) {
		const bool agrees = edges[i].forward != edges[i + 1].forward;
		neighbours[edges[i].face][size_t(count[edges[i].face]++)] = {edges[i + 1].face, agrees};
		neighbours[edges[i + 1].face][size_t(count[edges[i + 1].face]++)] = {edges[i].face, agrees};
	}
	std::vector<char> state(triangles.size(), 0); // 0 unseen, 1 kept, 2 turned
	std::vector<int> stack, component;
	int turned = 0;
	for (int seed = 0; seed < int(triangles.size()); ++seed) {
		if (state[seed])
			continue;
		state[seed] = 1;
		stack.assign(1, seed);
		component.clear();
		int turnedHere = 0;
		while (!stack.empty()) {
			const int f = stack.back();
			stack.pop_back();
			component.push_back(f);
			turnedHere += state[f] == 2;
			for (const Neighbour& n : neighbours[f]) {
				const char wanted = n.agrees ? state[f] : char(3 - state[f]);
				if (!state[n.face]) {
					state[n.face] = wanted;
					stack.push_back(n.face);
				}
				else if (state[n.face] != wanted)
					return -1;
			}
		}
		// The majority of a component keeps its side.
		const bool swapAll = 2 * turnedHere > int(component.size());
		for (int f : component)
			if ((state[f] == 2) != swapAll) {
				std::swap(triangles[f][1], triangles[f][2]);
				++turned;
			}
	}
	return turned;
}

/// Vertices at which two or more fans of faces meet. @pre every edge has exactly two faces.
inline std::vector<int> nonManifoldVertices(size_t vertices, const std::vector<Triangle>& triangles)
{
	// Corners around a vertex are joined over shared edges: one class for each fan.
	std::vector<int> parent(3 * triangles.size());
	std::iota(parent.begin(), parent.end(), 0);
	const auto find = [&](int c) {
		while (parent[c] != c)
			c = parent[c] = parent[parent[c]];
		return c;
	};
	const auto corner = [&](int f, int v) {
		return 3 * f + (triangles[f][0] == v ? 0 : triangles[f][1] == v ? 1 : 2);
	};
	const std::vector<SoupEdge> edges = sortedSoupEdges(triangles);
	for (size_t i = 0; i + 1 < edges.size(); i += 2)
		for (int v : {edges[i].low, edges[i].high})
			parent[find(corner(edges[i].face, v))] = find(corner(edges[i + 1].face, v));
	std::vector<int> fans(vertices, 0), found;
	for (int c = 0; c < int(parent.size()); ++c)
		if (parent[c] == c)
			++fans[triangles[c / 3][c % 3]];
	for (int v = 0; v < int(vertices); ++v)
		if (fans[v] > 1)
			found.push_back(v);
	return found;
}

} // namespace detail

/// For each vertex the number of its connected component, counted by lowest vertex.
inline std::vector<int> connectedComponents(const SurfaceMesh& mesh, int* componentCount = nullptr)
{
	std::vector<int> component(mesh.vertexSlots(), -1), stack;
	int count = 0;
	for (int seed = 0; seed < mesh.vertexSlots(); ++seed) {
		if (!mesh.isVertex(seed) || component[seed] >= 0)
			continue;
		component[seed] = count;
		stack.assign(1, seed);
		while (!stack.empty()) {
			const int v = stack.back();
			stack.pop_back();
			mesh.forEachOutgoing(v, [&](int h) {
				const int w = mesh.target(h);
				if (component[w] < 0) {
					component[w] = count;
					stack.push_back(w);
				}
			});
		}
		++count;
	}
	if (componentCount)
		*componentCount = count;
	return component;
}

/**
 * Checks that `points` and `triangles` bound a solid, and hands them over as a SurfaceMesh.
 *
 * Repaired, with a note: unreferenced vertices, coincident vertices (merged only if the mesh is not
 * closed without), faces that use a vertex twice, copies of a face, faces turned against their
 * neighbours, components that are inside out. Refused: everything else that is not a closed
 * two-manifold of non-zero volume.
 *
 * @param points    one for each input vertex, mesh units.
 * @param triangles corners as indices into `points`.
 * @throws InvalidInput saying what is wrong, how many, where, and which MeshLab filter cures it.
 * Complexity: O((V + F) log F).
 */
inline CheckedSurface checkedSurface(
	const std::vector<Point3d>& points, const std::vector<Triangle>& triangles)
{
	using namespace detail;
	CheckedSurface result;
	if (points.empty())
		throw InvalidInput("The layer is empty: a closed triangle mesh is needed.");
	if (triangles.empty())
		throw InvalidInput("The layer has no faces: a closed triangle mesh is needed. Make a surface "
						   "of a point cloud first, e.g. with 'Surface Reconstruction: Screened Poisson'.");
	for (const Triangle& t : triangles)
		for (int v : t)
			if (v < 0 || v >= int(points.size()))
				throw InvalidInput("A face refers to vertex " + std::to_string(v) + " of "
					+ std::to_string(points.size()) + ".");
	const auto isFinite = [](const Point3d& p) {
		return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
	};
	size_t notFinite = 0;
	for (const Point3d& p : points)
		notFinite += !isFinite(p);
	if (notFinite)
		throw InvalidInput(std::to_string(notFinite)
			+ " vertices have a coordinate that is not a finite number (NaN or infinite): select them "
			  "with 'Conditional Vertex Selection' and delete them, then run 'Close Holes'.");

	std::vector<Triangle> faces = triangles;
	if (const size_t removed = removeDegenerateFaces(faces))
		result.notes.push_back(
			std::to_string(removed) + " degenerate or duplicate faces were left out.");
	std::vector<SoupEdge> edges = sortedSoupEdges(faces);
	EdgeDefects defects = edgeDefects(points, edges);
	std::vector<int> vertexOfInput(points.size());
	std::iota(vertexOfInput.begin(), vertexOfInput.end(), 0);
	if (!defects.none()) {
		std::vector<Triangle> merged = faces;
		const std::vector<int> first = firstCoincident(points);
		for (Triangle& t : merged)
			for (int& v : t)
				v = first[v];
		removeDegenerateFaces(merged);
		const std::vector<SoupEdge> mergedEdges = sortedSoupEdges(merged);
		const EdgeDefects mergedDefects = edgeDefects(points, mergedEdges);
		if (mergedDefects.border + mergedDefects.nonManifold < defects.border + defects.nonManifold) {
			size_t copies = 0;
			for (size_t v = 0; v < points.size(); ++v)
				copies += first[v] != int(v);
			result.notes.push_back(std::to_string(copies) + " coincident vertices were merged.");
			faces = std::move(merged);
			edges = mergedEdges;
			defects = mergedDefects;
			vertexOfInput = first;
		}
	}
	if (faces.empty())
		throw InvalidInput("All faces are degenerate: a closed triangle mesh is needed.");
	if (defects.nonManifold)
		throw InvalidInput("The mesh is not two-manifold: it has "
			+ countAndPlaces(defects.nonManifold, "edge with more than two faces",
				"edges with more than two faces", defects.nonManifoldPlaces)
			+ ". Run 'Repair non Manifold Edges' first"
			+ (defects.border ? ", then 'Close Holes' (" + std::to_string(defects.border)
						+ " border edges)." : "."));
	if (defects.border)
		throw InvalidInput("The mesh is not watertight: it has "
			+ countAndPlaces(defects.border, "border edge", "border edges", defects.borderPlaces)
			+ ". Run 'Close Holes' first.");
	const int turned = orientCoherently(faces, edges);
	if (turned < 0)
		throw InvalidInput("The mesh is one-sided (like a Klein bottle): its faces cannot be oriented "
						   "alike, so it encloses no volume. Cut it, then run 'Close Holes'.");
	if (turned > 0)
		result.notes.push_back(std::to_string(turned) + " faces were turned to agree with their neighbours.");
	const std::vector<int> pinched = nonManifoldVertices(points.size(), faces);
	if (!pinched.empty()) {
		std::vector<Point3d> places;
		for (size_t i = 0; i < std::min<size_t>(3, pinched.size()); ++i)
			places.push_back(points[pinched[i]]);
		throw InvalidInput("The mesh is not two-manifold: it has "
			+ countAndPlaces(pinched.size(), "vertex at which separate fans of faces touch",
				"vertices at which separate fans of faces touch", places)
			+ ". Run 'Repair non Manifold Vertices by splitting' first.");
	}

	// Number the referenced vertices in their own order.
	std::vector<int> number(points.size(), -1);
	for (const Triangle& t : faces)
		for (int v : t)
			number[v] = 0;
	std::vector<Point3d> used;
	for (size_t v = 0; v < points.size(); ++v)
		if (number[v] == 0) {
			number[v] = int(used.size());
			used.push_back(points[v]);
		}
	for (int& v : vertexOfInput)
		v = number[v];
	const size_t unreferenced = size_t(std::count(vertexOfInput.begin(), vertexOfInput.end(), -1));
	if (unreferenced)
		result.notes.push_back(std::to_string(unreferenced) + " unreferenced vertices were left out.");
	for (Triangle& t : faces)
		for (int& v : t)
			v = number[v];

	// Each component must enclose a volume, and is turned so that the volume is positive.
	SurfaceMesh mesh(used, faces);
	int components = 0;
	const std::vector<int> component = connectedComponents(mesh, &components);
	std::vector<Point3d> middle(components, Point3d(0, 0, 0));
	std::vector<double> volume(components, 0), area(components, 0);
	std::vector<int> size(components, 0);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		middle[component[v]] += used[v];
		++size[component[v]];
	}
	for (int c = 0; c < components; ++c)
		middle[c] /= double(size[c]);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const int c = component[faces[f][0]];
		const Point3d n = mesh.areaVector(f);
		area[c] += n.Norm() / 2;
		volume[c] += (used[faces[f][0]] - middle[c]) * n / 6;
	}
	int flat = 0, insideOut = 0;
	for (int c = 0; c < components; ++c) {
		// A sphere, the fullest body, has V = 0.094 A^1.5; rounding alone stays below 1e-12 of it.
		flat += !(std::abs(volume[c]) > 1e-10 * std::pow(area[c], 1.5)) || !std::isnormal(area[c]);
		insideOut += volume[c] < 0;
	}
	if (flat)
		throw InvalidInput((components == 1 ? std::string("The mesh encloses")
										   : std::to_string(flat) + " of " + std::to_string(components)
									   + " connected components enclose")
			+ " no volume: there is no inside for a skeleton to lie in. Scale or remove the flat part "
			  "('Remove Isolated pieces (wrt Diameter)').");
	if (insideOut) {
		for (Triangle& t : faces)
			if (volume[component[t[0]]] < 0)
				std::swap(t[1], t[2]);
		mesh = SurfaceMesh(std::move(used), faces);
		result.notes.push_back(insideOut == components
				? std::string("The mesh was inside out and has been turned.")
				: std::to_string(insideOut) + " of " + std::to_string(components)
					+ " connected components were inside out; each is taken as a solid of its own "
					  "(a cavity inside a body is not subtracted from it).");
	}
	result.mesh = std::move(mesh);
	result.vertexOfInput = std::move(vertexOfInput);
	return result;
}

} // namespace vcg::tri::mcf

#endif
