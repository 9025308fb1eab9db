// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file From a triangle soup to closed two-manifold connectivity: repaired, or refused with reasons.

#ifndef VCG_MCF_SOUP_REPAIR_H
#define VCG_MCF_SOUP_REPAIR_H

#include "errors.h"
#include "surface_mesh.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Triangles that make a closed, coherently oriented two-manifold, and how they came about.
struct RepairedSoup
{
	std::vector<Triangle> faces;
	/// For each point the one that stands for it: itself, unless coincident points were merged.
	std::vector<int> vertexOfInput;
	/// What was repaired, one sentence each.
	std::vector<std::string> notes;
};

namespace detail {

/// "3 border edges, at (0 0 1), (0 1 1), ..." : how many, and where the first few are.
inline std::string countAndPlaces(
	size_t count, const char* singular, const char* plural, const std::vector<Point3d>& places)
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

inline EdgeDefects edgeDefects(
	const std::vector<Point3d>& points, const std::vector<SoupEdge>& edges)
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
	const auto key = [&](int i) {
		return std::make_tuple(points[i][0], points[i][1], points[i][2], i);
	};
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
	triangles.erase(
		std::remove_if(triangles.begin(), triangles.end(),
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
 * @pre no edge has more than two faces.
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
	for (size_t i = 0; i + 1 < edges.size(); ++i) {
		if (edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high)
			continue;
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
			for (int k = 0; k < count[f]; ++k) {
				const Neighbour& n = neighbours[f][size_t(k)];
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

/**
 * Repairs the connectivity of a soup: coincident vertices are merged (only if there are fewer
 * defects so), degenerate and duplicate faces left out, faces turned to agree with their neighbours.
 * @throws InvalidInput if it still is no closed two-manifold.
 * Complexity: O((V + F) log F).
 */
inline RepairedSoup repairedSoup(
	const std::vector<Point3d>& points, const std::vector<Triangle>& triangles)
{
	using namespace detail;
	RepairedSoup result;
	std::vector<Triangle>& faces = result.faces = triangles;
	if (const size_t removed = removeDegenerateFaces(faces))
		result.notes.push_back(
			std::to_string(removed) + " degenerate or duplicate faces were left out.");
	std::vector<SoupEdge> edges = sortedSoupEdges(faces);
	EdgeDefects defects = edgeDefects(points, edges);
	std::vector<int>& vertexOfInput = result.vertexOfInput;
	vertexOfInput.resize(points.size());
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
		if (mergedDefects.border + mergedDefects.nonManifold
			< defects.border + defects.nonManifold) {
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
			+ (defects.border
					? ", then 'Close Holes' (" + std::to_string(defects.border) + " border edges)."
					: "."));
	const int turned = orientCoherently(faces, edges);
	if (turned < 0)
		throw InvalidInput(
			"The mesh is one-sided (like a Moebius strip or a Klein bottle): its faces cannot be "
			"oriented alike, so it encloses no volume"
			+ (defects.border ? " (and it has " + std::to_string(defects.border) + " border edges)"
							  : std::string())
			+ ". Cut it open where it is twisted, then run 'Close Holes'.");
	if (defects.border)
		throw InvalidInput("The mesh is not watertight: it has "
			+ countAndPlaces(defects.border, "border edge", "border edges", defects.borderPlaces)
			+ ". Run 'Close Holes' first.");
	if (turned > 0)
		result.notes.push_back(
			std::to_string(turned) + " faces were turned to agree with their neighbours.");
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
	return result;
}

} // namespace vcg::tri::mcf

#endif
