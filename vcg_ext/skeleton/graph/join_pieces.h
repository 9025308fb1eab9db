// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Bridges between the skeletons of the pieces of a surface.

#ifndef VCG_MCF_JOIN_PIECES_H
#define VCG_MCF_JOIN_PIECES_H

#include "curve_skeleton.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/point_tree.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// What joinPieces() has made.
struct Bridges
{
	int count = 0;
	double longest = 0; ///< gap that is bridged, between vertices of two pieces, mesh units
};

/**
 * Joins the skeletons of all components of a surface by bridges over the narrowest gaps between
 * them: a minimum spanning tree of the components. A bridge is two edges between the nodes of the
 * vertices on both sides of the gap, and a new node in its middle, for which `bridge` is 1: every
 * edge with such a node is part of a bridge. `bridge` stays empty if the surface has a single
 * component; components without nodes are left out.
 *
 * @param curve   with its correspondence to the vertices of `surface`.
 * @throws Cancelled. Complexity: O(C^2 + V log V) for C components, at most O(C V log V) where all
 *         boxes are near each other.
 */
inline Bridges joinPieces(
	CurveSkeleton& curve, const SurfaceMesh& surface, const Progress& progress = Progress())
{
	const char* const what = "Joining the pieces";
	Bridges made;
	int count = 0;
	const std::vector<int> component = connectedComponents(surface, &count, progress.part(0, 0.1));
	if (count < 2)
		return made;
	struct Gap
	{
		double distance = std::numeric_limits<double>::infinity();
		int own = -1, other = -1; ///< vertices
	};
	std::vector<std::vector<int>> vertices(static_cast<size_t>(count));
	std::vector<Box3d> box(static_cast<size_t>(count));
	for (int v = 0; v < surface.vertexSlots(); ++v)
		if (surface.isVertex(v) && curve.node[size_t(v)] >= 0) {
			vertices[size_t(component[size_t(v)])].push_back(v);
			box[size_t(component[size_t(v)])].Add(surface.position[size_t(v)]);
		}
	const auto fromBox = [](const Box3d& to, const Point3d& p) {
		double sum = 0;
		for (int k = 0; k < 3; ++k) {
			const double beyond = std::max({to.min[k] - p[k], p[k] - to.max[k], 0.0});
			sum += beyond * beyond;
		}
		return std::sqrt(sum);
	};
	const auto betweenBoxes = [](const Box3d& a, const Box3d& b) {
		double sum = 0;
		for (int k = 0; k < 3; ++k) {
			const double beyond = std::max({a.min[k] - b.max[k], b.min[k] - a.max[k], 0.0});
			sum += beyond * beyond;
		}
		return std::sqrt(sum);
	};

	// Prim's algorithm: next comes the piece that is nearest to those already joined.
	std::vector<Gap> gap(static_cast<size_t>(count));
	std::vector<char> isJoined(size_t(count), 0);
	curve.bridge.assign(curve.position.size(), 0);
	for (int newest = 0, joined = 1; joined < count; ++joined) {
		progress.report(0.1 + 0.9 * joined / count, what);
		isJoined[size_t(newest)] = 1;
		std::vector<Point3d> points;
		for (int v : vertices[size_t(newest)])
			points.push_back(surface.position[size_t(v)]);
		const Progress cancel = progress.cancelOnly();
		const PointTree tree(points, cancel);
		detail::Ticker ticker(cancel, what, double(vertices.size()));
		int nearest = -1;
		for (int piece = 0; piece < count; ++piece) {
			if (isJoined[size_t(piece)])
				continue;
			Gap& best = gap[size_t(piece)];
			if (!points.empty()
				&& betweenBoxes(box[size_t(newest)], box[size_t(piece)]) < best.distance)
				for (int v : vertices[size_t(piece)]) {
					ticker.tick();
					const Point3d& p = surface.position[size_t(v)];
					if (fromBox(box[size_t(newest)], p) >= best.distance)
						continue;
					const int at = tree.nearest(p);
					const double distance = Distance(p, points[size_t(at)]);
					if (distance < best.distance)
						best = {distance, v, vertices[size_t(newest)][size_t(at)]};
				}
			if (nearest < 0 || best.distance < gap[size_t(nearest)].distance)
				nearest = piece;
		}
		newest = nearest;
		const Gap& bridged = gap[size_t(nearest)];
		if (bridged.own < 0)
			continue; // a piece without a skeleton
		const int a = curve.node[size_t(bridged.own)], b = curve.node[size_t(bridged.other)];
		const int middle = int(curve.position.size());
		curve.position.push_back((curve.position[size_t(a)] + curve.position[size_t(b)]) / 2.0);
		curve.radius.push_back((curve.radius[size_t(a)] + curve.radius[size_t(b)]) / 2);
		curve.bridge.push_back(1);
		if (!curve.significance.empty()) // a bridge is of no use without both its ends
			curve.significance.push_back(
				std::min(curve.significance[size_t(a)], curve.significance[size_t(b)]));
		curve.edges.push_back({a, middle});
		curve.edges.push_back({b, middle});
		++made.count;
		made.longest = std::max(made.longest, bridged.distance);
	}
	std::sort(curve.edges.begin(), curve.edges.end());
	return made;
}

/**
 * The skeleton without its bridges, as joinPieces() got it. Surface vertices of the middle of a
 * bridge go to the end with the lower number. Complexity: O(V + E + surface vertices).
 */
inline CurveSkeleton withoutBridges(const CurveSkeleton& skeleton)
{
	if (skeleton.bridge.empty())
		return skeleton;
	CurveSkeleton pieces;
	std::vector<int> number(skeleton.position.size(), -1);
	for (size_t v = 0; v < number.size(); ++v) {
		if (skeleton.bridge[v])
			continue;
		number[v] = int(pieces.position.size());
		pieces.position.push_back(skeleton.position[v]);
		pieces.radius.push_back(skeleton.radius[v]);
		if (!skeleton.significance.empty())
			pieces.significance.push_back(skeleton.significance[v]);
	}
	std::vector<int> target = number;
	for (const auto& [a, b] : skeleton.edges) {
		if (number[size_t(a)] >= 0 && number[size_t(b)] >= 0)
			pieces.edges.push_back({number[size_t(a)], number[size_t(b)]});
		else if (target[size_t(b)] < 0)
			target[size_t(b)] = number[size_t(a)];
		else if (target[size_t(a)] < 0)
			target[size_t(a)] = number[size_t(b)];
	}
	for (int v : skeleton.node)
		pieces.node.push_back(v < 0 ? -1 : target[size_t(v)]);
	return pieces;
}

} // namespace vcg::tri::mcf

#endif
