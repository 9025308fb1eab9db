// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Repairs a triangle soup to a closed two-manifold, or refuses it with reasons.

#ifndef VCG_MCF_SOUP_REPAIR_H
#define VCG_MCF_SOUP_REPAIR_H

#include "coincident_points.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/errors.h>
#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Triangles of a closed, coherently oriented two-manifold, and how they differ from the input.
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

constexpr const char* repairing = "Repairing the surface";

/// A half-edge of the soup, in the group of its lower end.
struct SoupEdge
{
	int high; ///< the other end
	unsigned face : 31;
	unsigned forward : 1; ///< runs from low to high in its face
	bool operator<(const SoupEdge& other) const
	{
		return high != other.high ? high < other.high : face < other.face;
	}
};

using SoupEdges = SortedGroups<SoupEdge>;

inline SoupEdges sortedSoupEdges(
	size_t vertices, const std::vector<Triangle>& triangles, const Progress& progress)
{
	const auto ends = [&](int h) {
		const Triangle& t = triangles[h / 3];
		return std::make_pair(t[h % 3], t[(h + 1) % 3]);
	};
	return SoupEdges(
		int(3 * triangles.size()), vertices,
		[&](int h) {
			const auto [a, b] = ends(h);
			return std::min(a, b);
		},
		[&](int h) {
			const auto [a, b] = ends(h);
			return SoupEdge {std::max(a, b), unsigned(h / 3), a < b};
		},
		progress, repairing);
}

/// Calls visit(low, first half-edge, end of the half-edges) for each edge, in order.
/// @throws Cancelled
template <class Visit>
void forEachSoupEdge(const SoupEdges& edges, const Progress& progress, Visit&& visit)
{
	edges.forEach(progress, repairing, [&](int low, const SoupEdge* begin, const SoupEdge* end) {
		while (begin != end) {
			const SoupEdge* next = begin + 1;
			while (next != end && next->high == begin->high)
				++next;
			visit(low, begin, next);
			begin = next;
		}
	});
}

/// Edges with one face, and with more than two: both counts must be zero. The first three places.
struct EdgeDefects
{
	size_t border = 0, nonManifold = 0;
	std::vector<Point3d> borderPlaces, nonManifoldPlaces;
	bool none() const { return border == 0 && nonManifold == 0; }
};

inline EdgeDefects edgeDefects(
	const std::vector<Point3d>& points, const SoupEdges& edges, const Progress& progress)
{
	EdgeDefects defects;
	const auto note = [&](size_t& count, std::vector<Point3d>& places, int low, int high) {
		if (++count <= 3)
			places.push_back((points[low] + points[high]) / 2.0);
	};
	forEachSoupEdge(edges, progress, [&](int low, const SoupEdge* begin, const SoupEdge* end) {
		if (end - begin == 1)
			note(defects.border, defects.borderPlaces, low, begin->high);
		else if (end - begin > 2)
			note(defects.nonManifold, defects.nonManifoldPlaces, low, begin->high);
	});
	return defects;
}

/// The faces whose corners are all finite. @throws Cancelled
inline std::vector<Triangle> finiteFaces(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Cancellation& cancel)
{
	std::vector<Triangle> finite;
	finite.reserve(triangles.size());
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		const Triangle& t = triangles[size_t(f)];
		if (std::all_of(
				t.begin(), t.end(), [&](int v) { return isFinitePlace(points[size_t(v)]); }))
			finite.push_back(t);
	});
	return finite;
}

/// Removes the faces that are marked; the others keep their order. @return how many were removed.
inline size_t removeMarked(std::vector<Triangle>& triangles, const std::vector<char>& marked)
{
	size_t kept = 0;
	for (size_t f = 0; f < triangles.size(); ++f)
		if (!marked[f])
			triangles[kept++] = triangles[f];
	const size_t removed = triangles.size() - kept;
	triangles.resize(kept);
	return removed;
}

/// Removes faces that use a vertex twice and copies of a face (same corners, same orientation).
/// @return how many were removed.
inline size_t removeDegenerateFaces(
	size_t vertices, std::vector<Triangle>& triangles, const Progress& progress)
{
	const size_t before = triangles.size();
	const auto keepIf = [&](const Progress& part, const auto& isKept) {
		size_t kept = 0;
		reportedLoop(int(triangles.size()), part, repairing, [&](int f) {
			if (isKept(f))
				triangles[kept++] = triangles[f];
		});
		triangles.resize(kept);
	};
	keepIf(progress.part(0, 0.1), [&](int f) {
		const Triangle& t = triangles[f];
		return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
	});
	// A face in the group of its lowest corner, known by the other two.
	struct Corners
	{
		int second, third, face;
		bool operator<(const Corners& other) const
		{
			return std::tie(second, third, face) < std::tie(other.second, other.third, other.face);
		}
	};
	const auto lowest = [&](int f) {
		const Triangle& t = triangles[f];
		return int(std::min_element(t.begin(), t.end()) - t.begin());
	};
	const SortedGroups<Corners> groups(
		int(triangles.size()), vertices, [&](int f) { return triangles[f][lowest(f)]; },
		[&](int f) {
			const Triangle& t = triangles[f];
			const int k = lowest(f);
			return Corners {t[(k + 1) % 3], t[(k + 2) % 3], f};
		},
		progress.part(0.1, 0.8), repairing);
	std::vector<char> copy = filledArray(triangles.size(), char(0), progress);
	bool copies = false;
	groups.forEach(
		progress.part(0.8, 0.9), repairing, [&](int, const Corners* begin, const Corners* end) {
			for (const Corners* i = begin + 1; i < end; ++i)
				if (i->second == i[-1].second && i->third == i[-1].third) {
					copy[i->face] = 1;
					copies = true;
				}
		});
	if (copies)
		keepIf(progress.part(0.9, 1), [&](int f) { return !copy[f]; });
	return before - triangles.size();
}

/**
 * Turns faces so that neighbours agree, each connected component (over edges) by itself.
 * @return the number of faces turned, or -1 if the surface is one-sided.
 * @pre no edge has more than two faces.
 */
inline int orientCoherently(
	std::vector<Triangle>& triangles, const SoupEdges& edges, const Progress& progress)
{
	// Sets of faces, each known by its lowest one, and whether a face is turned against its parent.
	const size_t count = triangles.size();
	std::vector<int> parent = numberedArray(count, progress);
	std::vector<char> against = filledArray(count, char(0), progress);
	const auto find = [&](int f) {
		bool turned = false;
		while (parent[f] != f) {
			against[f] ^= against[parent[f]];
			parent[f] = parent[parent[f]];
			turned ^= bool(against[f]);
			f = parent[f];
		}
		return std::make_pair(f, turned);
	};
	bool twoSided = true;
	forEachSoupEdge(
		edges, progress.part(0.1, 0.7), [&](int, const SoupEdge* begin, const SoupEdge* end) {
			if (!twoSided || end - begin != 2)
				return;
			const bool disagree = begin[0].forward == begin[1].forward;
			const auto [a, aTurned] = find(int(begin[0].face));
			const auto [b, bTurned] = find(int(begin[1].face));
			const bool turn = (aTurned ^ bTurned) != disagree;
			if (a == b)
				twoSided = !turn;
			else {
				parent[std::max(a, b)] = std::min(a, b);
				against[std::max(a, b)] = turn;
			}
		});
	if (!twoSided)
		return -1;
	// The majority of a component keeps its orientation.
	std::vector<int> majority = filledArray(count, 0, progress);
	reportedLoop(int(count), progress.part(0.7, 0.85), repairing, [&](int f) {
		const auto [first, turned] = find(f);
		majority[first] += turned ? 1 : -1;
	});
	int turnedFaces = 0;
	reportedLoop(int(count), progress.part(0.85, 1), repairing, [&](int f) {
		const auto [first, turned] = find(f);
		if (turned != (majority[first] > 0)) {
			std::swap(triangles[f][1], triangles[f][2]);
			++turnedFaces;
		}
	});
	return turnedFaces;
}

/// Vertices at which two or more fans of faces meet. @pre every edge has exactly two faces.
inline std::vector<int> nonManifoldVertices(size_t vertices, const std::vector<Triangle>& triangles,
	const SoupEdges& edges, const Progress& progress)
{
	// Corners around a vertex are joined over shared edges: one class for each fan.
	MergeForest joined(3 * int(triangles.size()), progress);
	const auto corner = [&](unsigned f, int v) {
		return 3 * int(f) + (triangles[f][0] == v ? 0 : triangles[f][1] == v ? 1 : 2);
	};
	forEachSoupEdge(
		edges, progress.part(0.1, 0.7), [&](int low, const SoupEdge* begin, const SoupEdge*) {
			for (int v : {low, begin->high})
				joined.merge(
					joined.find(corner(begin[0].face, v)), joined.find(corner(begin[1].face, v)));
		});
	std::vector<char> fans = filledArray(vertices, char(0), progress);
	reportedLoop(joined.size(), progress.part(0.7, 0.9), repairing, [&](int c) {
		char& here = fans[triangles[c / 3][c % 3]];
		if (joined.find(c) == c && here < 2)
			++here;
	});
	std::vector<int> found;
	reportedLoop(int(vertices), progress.part(0.9, 1), repairing, [&](int v) {
		if (fans[v] > 1)
			found.push_back(v);
	});
	return found;
}

} // namespace detail

/**
 * Repairs the connectivity of a soup: coincident vertices are merged (only if that leaves fewer
 * defects), degenerate and duplicate faces left out, faces turned to agree with their neighbours.
 * @throws InvalidInput if the result is not a closed two-manifold; Cancelled.
 * Complexity: about O(V + F); O(V + F log n) where n faces meet at a vertex.
 */
inline RepairedSoup repairedSoup(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Progress& progress = Progress())
{
	using namespace detail;
	RepairedSoup result;
	std::vector<Triangle>& faces = result.faces;
	faces = copiedArray(triangles, progress);
	if (const size_t removed = removeDegenerateFaces(points.size(), faces, progress.part(0, 0.15)))
		result.notes.push_back(
			std::to_string(removed) + " degenerate or duplicate faces were left out.");
	SoupEdges edges = sortedSoupEdges(points.size(), faces, progress.part(0.15, 0.35));
	EdgeDefects defects = edgeDefects(points, edges, progress.part(0.35, 0.37));
	std::vector<int>& vertexOfInput = result.vertexOfInput;
	std::vector<int> first;
	size_t copies = 0;
	if (!defects.none()) {
		first = firstCoincident(points, progress.part(0.37, 0.45), repairing);
		reportedLoop(int(first.size()), progress.part(0.45, 0.47), repairing,
			[&](int v) { copies += first[v] != v; });
	}
	if (copies > 0) {
		std::vector<Triangle> merged = copiedArray(faces, progress);
		reportedLoop(int(merged.size()), progress.part(0.47, 0.5), repairing, [&](int f) {
			for (int& v : merged[f])
				v = first[v];
		});
		removeDegenerateFaces(points.size(), merged, progress.part(0.5, 0.59));
		SoupEdges mergedEdges = sortedSoupEdges(points.size(), merged, progress.part(0.59, 0.69));
		EdgeDefects mergedDefects = edgeDefects(points, mergedEdges, progress.part(0.69, 0.7));
		if (mergedDefects.border + mergedDefects.nonManifold
			< defects.border + defects.nonManifold) {
			result.notes.push_back(std::to_string(copies) + " coincident vertices were merged.");
			faces = std::move(merged);
			edges = std::move(mergedEdges);
			defects = std::move(mergedDefects);
			vertexOfInput = std::move(first);
		}
	}
	if (vertexOfInput.empty())
		vertexOfInput = numberedArray(points.size(), progress);
	if (faces.empty())
		throw InvalidInput("All faces are degenerate: a closed triangle mesh is needed.");
	if (defects.nonManifold)
		throw InvalidInput("The mesh is not two-manifold: it has "
				+ countAndPlaces(defects.nonManifold, "edge with more than two faces",
					"edges with more than two faces", defects.nonManifoldPlaces)
				+ ". Split the mesh apart there first"
				+ (defects.border ? ", then fill the holes (" + std::to_string(defects.border)
							+ " border edges)."
								  : "."),
			Defect::NonManifoldEdges);
	const int turned = orientCoherently(faces, edges, progress.part(0.72, 0.85));
	if (turned < 0)
		throw InvalidInput(
			"The mesh is one-sided (like a Moebius strip or a Klein bottle): its faces cannot be "
			"oriented alike, so it encloses no volume"
				+ (defects.border
						? " (and it has " + std::to_string(defects.border) + " border edges)"
						: std::string())
				+ ". Cut it open where it is twisted, then fill the holes.",
			Defect::OneSided);
	if (defects.border)
		throw InvalidInput("The mesh is not watertight: it has "
				+ countAndPlaces(
					defects.border, "border edge", "border edges", defects.borderPlaces)
				+ ". Fill the holes first.",
			Defect::BorderEdges);
	if (turned > 0)
		result.notes.push_back(
			std::to_string(turned) + " faces were turned to agree with their neighbours.");
	const std::vector<int> pinched =
		nonManifoldVertices(points.size(), faces, edges, progress.part(0.85, 1));
	if (!pinched.empty()) {
		std::vector<Point3d> places;
		for (size_t i = 0; i < std::min<size_t>(3, pinched.size()); ++i)
			places.push_back(points[pinched[i]]);
		throw InvalidInput("The mesh is not two-manifold: it has "
				+ countAndPlaces(pinched.size(), "vertex at which separate fans of faces touch",
					"vertices at which separate fans of faces touch", places)
				+ ". Split the mesh apart there first.",
			Defect::NonManifoldVertices);
	}
	return result;
}

} // namespace vcg::tri::mcf

#endif
