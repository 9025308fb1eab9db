// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Joins two walls that lie on each other into one sheet: a coarser complex on common sites.

#ifndef VCG_MCF_MERGE_WALLS_H
#define VCG_MCF_MERGE_WALLS_H

#include "meso_skeleton.h"

#include <skeleton/spatial/point_tree.h>

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Sites spread evenly over given points.
struct Sites
{
	std::vector<Point3d> position;
	/// For each given point the nearest site.
	std::vector<int> ofPoint;
};

/**
 * Spreads sites over points: a greedy Poisson subset, in the order of the points, whose members are
 * at least `spacing` apart; then each moves to the mean of the points nearest to it, three times.
 * Walls that lie on each other share their sites.
 * @pre points is not empty, spacing > 0, in their units. Complexity: O(n log n).
 */
inline Sites spreadSites(const std::vector<Point3d>& points, double spacing)
{
	constexpr int rounds = 3;
	Sites sites;
	const auto cellOf = [&](const Point3d& p) {
		std::array<long, 3> cell;
		for (int axis = 0; axis < 3; ++axis)
			cell[axis] = long(std::floor((p[axis] - points.front()[axis]) / spacing));
		return cell;
	};
	std::map<std::array<long, 3>, std::vector<int>> grid;
	const auto isFree = [&](const Point3d& p, const std::array<long, 3>& cell) {
		for (long x = cell[0] - 1; x <= cell[0] + 1; ++x)
			for (long y = cell[1] - 1; y <= cell[1] + 1; ++y)
				for (long z = cell[2] - 1; z <= cell[2] + 1; ++z)
					if (const auto found = grid.find({x, y, z}); found != grid.end())
						for (int s : found->second)
							if (SquaredDistance(sites.position[s], p) < spacing * spacing)
								return false;
		return true;
	};
	for (const Point3d& p : points) {
		const std::array<long, 3> cell = cellOf(p);
		if (isFree(p, cell)) {
			grid[cell].push_back(int(sites.position.size()));
			sites.position.push_back(p);
		}
	}
	sites.ofPoint.resize(points.size());
	for (int round = 0; round <= rounds; ++round) {
		const PointTree tree(sites.position);
		std::vector<Point3d> sum(sites.position.size(), Point3d(0, 0, 0));
		std::vector<int> count(sites.position.size(), 0);
		for (size_t i = 0; i < points.size(); ++i) {
			const int s = sites.ofPoint[i] = tree.nearest(points[i]);
			sum[s] += points[i];
			++count[s];
		}
		if (round < rounds)
			for (size_t s = 0; s < count.size(); ++s)
				if (count[s])
					sites.position[s] = sum[s] / count[s];
	}
	return sites;
}

/// Faces and edges on sites.
struct SiteComplex
{
	std::set<FaceOfComplex> faces;
	/// The edges of the faces included.
	std::set<EdgeOfComplex> edges;
};

/// The image of faces and edges when each vertex goes to its label.
inline SiteComplex imageComplex(const std::vector<EdgeOfComplex>& edges,
	const std::vector<FaceOfComplex>& faces, const std::vector<int>& label)
{
	SiteComplex image;
	const auto addEdge = [&](int a, int b) {
		if (a != b)
			image.edges.insert({std::min(a, b), std::max(a, b)});
	};
	for (const auto& [a, b] : edges)
		addEdge(label[a], label[b]);
	for (const FaceOfComplex& f : faces) {
		FaceOfComplex t = {label[f[0]], label[f[1]], label[f[2]]};
		std::sort(t.begin(), t.end());
		for (const auto& [a, b] : edgesOf(t))
			addEdge(a, b);
		if (t[0] != t[1] && t[1] != t[2])
			image.faces.insert(t);
	}
	return image;
}

/**
 * Adds all faces whose three edges exist: loops of three sites are shorter than any loop of the
 * shape that the sites can resolve. Edges of `curves` do not count.
 */
inline void fillTriangles(SiteComplex& complex, const std::set<EdgeOfComplex>& curves)
{
	std::map<int, std::vector<int>> higher;
	for (const EdgeOfComplex& e : complex.edges)
		if (!curves.count(e))
			higher[e[0]].push_back(e[1]);
	for (const auto& [a, list] : higher)
		for (size_t i = 0; i < list.size(); ++i)
			for (size_t j = i + 1; j < list.size(); ++j) {
				const EdgeOfComplex third = {list[i], list[j]};
				if (complex.edges.count(third) && !curves.count(third))
					complex.faces.insert({a, list[i], list[j]});
			}
}

namespace detail {

/// The number of faces of each edge.
inline std::map<EdgeOfComplex, int> faceCounts(const std::set<FaceOfComplex>& faces)
{
	std::map<EdgeOfComplex, int> count;
	for (const FaceOfComplex& f : faces)
		for (const EdgeOfComplex& e : edgesOf(f))
			++count[e];
	return count;
}

/**
 * Removes the face `opened` of a pocket, then repeatedly the longest edge that has one face left,
 * with that face (elementary collapses).
 * @param inside   edges whose faces are all in the pocket: only these are removed.
 * @param count    the number of faces of each edge; kept up to date.
 * @param left     stops when the pocket has this many faces left.
 * @param minimum  edges shorter than this stay; units of `position`.
 * Complexity: O(F log F).
 */
inline void thinPocket(SiteComplex& complex, std::set<FaceOfComplex>& pocket,
	const FaceOfComplex& opened, const std::set<EdgeOfComplex>& inside,
	std::map<EdgeOfComplex, int>& count, const std::vector<Point3d>& position, size_t left,
	double minimum)
{
	std::map<EdgeOfComplex, std::vector<FaceOfComplex>> around;
	for (const FaceOfComplex& f : pocket)
		for (const EdgeOfComplex& e : edgesOf(f))
			around[e].push_back(f);
	std::set<std::pair<double, EdgeOfComplex>> freeEdges; // minus the length: the longest first
	const auto remove = [&](const FaceOfComplex& face) {
		for (const EdgeOfComplex& e : edgesOf(face)) {
			std::vector<FaceOfComplex>& of = around[e];
			of.erase(std::find(of.begin(), of.end(), face));
			const double length = Distance(position[e[0]], position[e[1]]);
			if (--count[e] == 1 && inside.count(e) && length >= minimum)
				freeEdges.emplace(-length, e);
		}
		complex.faces.erase(face);
		pocket.erase(face);
	};
	remove(FaceOfComplex(opened));
	while (pocket.size() > left && !freeEdges.empty()) {
		const EdgeOfComplex e = freeEdges.begin()->second;
		freeEdges.erase(freeEdges.begin());
		if (count[e] != 1)
			continue;
		remove(FaceOfComplex(around[e].front()));
		complex.edges.erase(e);
	}
}

} // namespace detail

/**
 * Opens the closed pockets that are left between two walls where these have different diagonals: of
 * each, one face is removed, which opens it, and then faces at free edges until half of the faces
 * are left, a single wall. Afterwards b2 is 0, and b0 and b1 are as before.
 * @param position  of the sites.
 * @param longEdge  in units of `position`: of a pocket whose longest edge between two faces of its
 *                  own is longer, all faces at free edges at least as long as this go.
 */
inline void openPockets(SiteComplex& complex, const std::vector<Point3d>& position, double longEdge)
{
	const auto area = [&](const FaceOfComplex& f) { return faceArea(position, f); };
	for (;;) {
		const std::vector<FaceOfComplex> all(complex.faces.begin(), complex.faces.end());
		std::vector<FaceOfComplex> core;
		for (int f : detail::facesWithoutFreeEdges(all))
			core.push_back(all[size_t(f)]);
		if (core.empty())
			return;
		// Small faces first, so that a pocket is found before a larger one around it.
		std::stable_sort(core.begin(), core.end(),
			[&](const FaceOfComplex& f, const FaceOfComplex& g) { return area(f) < area(g); });
		std::vector<std::vector<int>> pockets = detail::closedSurfaces(core);
		if (pockets.empty())
			return;
		std::stable_sort(pockets.begin(), pockets.end(),
			[](const auto& a, const auto& b) { return a.size() < b.size(); });
		std::map<EdgeOfComplex, int> count = detail::faceCounts(complex.faces);
		std::set<FaceOfComplex> touched;
		for (const std::vector<int>& ids : pockets) {
			std::set<FaceOfComplex> pocket;
			for (int f : ids)
				pocket.insert(core[size_t(f)]);
			const bool fresh = std::none_of(pocket.begin(), pocket.end(),
				[&](const FaceOfComplex& f) { return touched.count(f); });
			if (!fresh)
				continue; // shares faces with one opened in this round: the next one finds it again
			touched.insert(pocket.begin(), pocket.end());
			// Edges whose faces are all in the pocket: a face at the longest one is opened.
			std::map<EdgeOfComplex, int> within;
			for (const FaceOfComplex& f : pocket)
				for (const EdgeOfComplex& e : edgesOf(f))
					++within[e];
			std::set<EdgeOfComplex> inside;
			EdgeOfComplex longest = {-1, -1};
			double length = -1;
			for (const auto& [e, n] : within)
				if (n == count[e]) {
					inside.insert(e);
					const double l = SquaredDistance(position[e[0]], position[e[1]]);
					if (n == 2 && l > length) {
						length = l;
						longest = e;
					}
				}
			const auto hasLongest = [&](const FaceOfComplex& f) {
				for (const EdgeOfComplex& e : edgesOf(f))
					if (e == longest)
						return true;
				return false;
			};
			FaceOfComplex opened = *pocket.begin();
			for (const FaceOfComplex& f : pocket)
				if (hasLongest(f) != hasLongest(opened) ? hasLongest(f) : area(f) > area(opened))
					opened = f;
			const bool isCoarse = length > longEdge * longEdge;
			detail::thinPocket(complex, pocket, FaceOfComplex(opened), inside, count, position,
				isCoarse ? 0 : pocket.size() / 2, isCoarse ? longEdge : 0);
		}
	}
}

} // namespace vcg::tri::mcf

#endif
