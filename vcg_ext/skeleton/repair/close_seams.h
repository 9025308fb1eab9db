// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Closes seams: borders side by side, with vertices that nearly match or on one side only.

#ifndef VCG_MCF_CLOSE_SEAMS_H
#define VCG_MCF_CLOSE_SEAMS_H

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/shortest_edges.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What closeSeams() has done.
struct ClosedSeams
{
	/// For each point the one that stands for it: itself, unless it was merged.
	std::vector<int> vertexOf;
	int merged = 0;    ///< vertices that nearly coincided with others
	int junctions = 0; ///< vertices that lay on an edge of the other side: T-junctions
};

namespace detail {

/// An edge of one face only, in the direction in which it runs there.
struct BorderEdge
{
	int from, to, face;
};

inline std::vector<BorderEdge> borderEdges(const SoupEdges& edges, const Progress& progress)
{
	std::vector<BorderEdge> border;
	forEachSoupEdge(edges, progress, [&](int low, const SoupEdge* begin, const SoupEdge* end) {
		if (end - begin != 1)
			return;
		const bool forward = begin->forward;
		border.push_back(
			{forward ? low : begin->high, forward ? begin->high : low, int(begin->face)});
	});
	return border;
}

} // namespace detail

/**
 * Merges border vertices that nearly coincide, and splits border edges on which a border vertex
 * lies: both within a hundredth of the shortest edges there. What is not on a border stays.
 * @param points    mesh units. @param triangles are changed. @param edges  theirs, kept up to date.
 * @throws Cancelled. Complexity: O(F + B log B) for B border edges whose boxes hardly overlap.
 */
inline ClosedSeams closeSeams(const std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	detail::SoupEdges& edges, const Progress& progress = Progress())
{
	constexpr double nearness = 0.01; // of an edge
	constexpr int maxRounds = 3;      // each splits at most one edge of a face
	ClosedSeams done;
	MergeForest vertices(int(points.size()));
	for (int round = 0; round < maxRounds; ++round) {
		const Progress part = progress.part(double(round) / maxRounds, (round + 1.0) / maxRounds);
		const std::vector<detail::BorderEdge> border =
			detail::borderEdges(edges, part.part(0, 0.5));
		if (border.empty())
			break;
		// Both ends: the faces may not be oriented coherently yet.
		std::vector<Triangle> segments;
		std::vector<int> ends;
		for (const detail::BorderEdge& e : border) {
			segments.push_back({e.from, e.to, e.to});
			ends.insert(ends.end(), {e.from, e.to});
		}
		std::sort(ends.begin(), ends.end());
		ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
		const TriangleTree tree(points, segments, part.part(0.5, 0.7));
		const auto length = [&](int e) {
			return Distance(
				points[size_t(segments[size_t(e)][0])], points[size_t(segments[size_t(e)][1])]);
		};
		// A hundredth of a sliver's long edge may reach other vertices: the shortest edge counts.
		const std::vector<double> shortest = shortestEdges(points, triangles, part);
		std::vector<std::vector<std::pair<double, int>>> onEdge(border.size());
		int merged = 0, junctions = 0;
		detail::Ticker visits(part.cancelOnly(), detail::repairing, double(border.size()));
		detail::reportedLoop(int(ends.size()), part.part(0.7, 1), detail::repairing, [&](int i) {
			const int v = ends[size_t(i)];
			const Point3d& p = points[size_t(v)];
			const double reach = nearness * shortest[size_t(v)];
			Box3d box;
			box.Add(p);
			box.Offset(reach);
			int lowest = v, edge = -1;
			double nearest = reach, at = 0;
			tree.forEachFaceIn(box, [&](int e) {
				visits.tick();
				const auto [a, b, unused] = segments[size_t(e)];
				(void)unused;
				if (a == v || b == v)
					return;
				const double whole = length(e), maximum = std::min(reach, nearness * whole);
				for (int w : {a, b})
					if (Distance(points[size_t(w)], p)
						<= std::min(maximum, nearness * shortest[size_t(w)]))
						lowest = std::min(lowest, w);
				const Point3d along = points[size_t(b)] - points[size_t(a)];
				const double t = whole > 0 ? (p - points[size_t(a)]) * along / (whole * whole) : 0;
				const double away = Distance(p, points[size_t(a)] + along * t);
				const Triangle& face = triangles[size_t(border[size_t(e)].face)];
				const int apex = face[0] + face[1] + face[2] - a - b;
				if (v != apex && t > nearness && t < 1 - nearness && away <= maximum
					&& away < nearest) {
					nearest = away;
					edge = e;
					at = t;
				}
			});
			if (lowest != v)
				merged += vertices.join(lowest, v);
			else if (edge >= 0)
				onEdge[size_t(edge)].emplace_back(at, v);
		});
		std::vector<char> cut(triangles.size(), 0);
		for (size_t e = 0; e < border.size(); ++e) {
			auto& inserted = onEdge[e];
			const size_t f = size_t(border[e].face);
			if (inserted.empty() || cut[f])
				continue;
			cut[f] = 1;
			std::sort(inserted.begin(), inserted.end());
			const Triangle t = triangles[f];
			const int apex = t[0] != border[e].from && t[0] != border[e].to ? t[0]
				: t[1] != border[e].from && t[1] != border[e].to            ? t[1]
																			: t[2];
			int from = border[e].from;
			inserted.emplace_back(1, border[e].to);
			for (size_t i = 0; i < inserted.size(); ++i) {
				const Triangle piece = {from, inserted[i].second, apex};
				if (i == 0)
					triangles[f] = piece;
				else
					triangles.push_back(piece);
				from = inserted[i].second;
			}
			junctions += int(inserted.size()) - 1;
		}
		done.merged += merged;
		done.junctions += junctions;
		if (merged)
			for (Triangle& t : triangles)
				for (int& v : t)
					v = vertices.find(v);
		if (merged || junctions) {
			detail::removeDegenerateFaces(points.size(), triangles, part.cancelOnly());
			edges = detail::sortedSoupEdges(points.size(), triangles, part.cancelOnly());
		}
		if (!junctions)
			break;
	}
	for (int v = 0; v < vertices.size(); ++v)
		done.vertexOf.push_back(vertices.find(v));
	return done;
}

} // namespace vcg::tri::mcf

#endif
