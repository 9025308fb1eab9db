// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Gives open sheets a thickness.

#ifndef VCG_MCF_THICKEN_SHEETS_H
#define VCG_MCF_THICKEN_SHEETS_H

#include "close_seams.h"
#include "part_surface.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/coincident_points.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A surface around sheets.
struct ThickenedSheets
{
	/// Those of the input, then those of the surface.
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
	/// For each input point one of the two that stand for it; itself if it has no face.
	std::vector<int> vertexOfInput;
};

/**
 * The closed surface at half a thickness from both sides of a surface, with walls along its
 * borders. Both sides of each face get a copy; a fan of copies around a vertex moves along its
 * normal. So the sheet need not be orientable, and at an edge with more than two faces those that
 * continue each other best stay together.
 *
 * Where the sheet is bent more tightly than the thickness, or comes near itself, the result crosses
 * itself.
 * @param points    mesh units. @param triangles corners as indices into `points`; those that are
 *                  not finite, or there twice, do not count; coincident vertices and seams are
 *                  repaired, see closeSeams().
 * @param thickness mesh units, > 0.
 * @throws Cancelled. Complexity: O(V + F log F), and that of closeSeams().
 */
inline ThickenedSheets thickenedSheets(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, double thickness, const Progress& progress = Progress())
{
	using namespace detail;
	ThickenedSheets thick;
	thick.points = points;
	const Progress cancel = progress.cancelOnly();
	std::vector<Triangle> faces = finiteFaces(points, triangles, cancel);
	for (Point3d& p : thick.points)
		if (!isFinitePlace(p))
			p = Point3d(0, 0, 0); // of no face
	const std::vector<int> standsFor =
		firstCoincident(thick.points, progress.part(0, 0.1), repairing);
	for (Triangle& t : faces)
		for (int& v : t)
			v = standsFor[size_t(v)];
	removeDegenerateFaces(points.size(), faces, progress.part(0.1, 0.2));
	// A face that is there once for each side counts once.
	std::vector<std::pair<Triangle, size_t>> known; // corners in order, and the face
	known.reserve(faces.size());
	cancellableLoop(int(faces.size()), cancel, [&](int f) {
		known.emplace_back(faces[size_t(f)], f);
		std::sort(known.back().first.begin(), known.back().first.end());
	});
	sortCancellable(known, 0, known.size(), cancel);
	std::vector<char> isKnown(faces.size(), 0);
	for (size_t i = 1; i < known.size(); ++i)
		isKnown[known[i].second] = known[i].first == known[i - 1].first;
	removeMarked(faces, isKnown);
	SoupEdges edges = sortedSoupEdges(points.size(), faces, progress.part(0.2, 0.25));
	const ClosedSeams seams = closeSeams(thick.points, faces, edges, progress.part(0.25, 0.4));
	const std::vector<int> partner =
		pairedHalfEdges(thick.points, faces, nullptr, progress.part(0.4, 0.5));

	// Corner 3 f + k of the upper side of face f, then those of the lower sides.
	const int corners = int(partner.size());
	const auto vertex = [&](int c) { return faces[size_t(c % corners) / 3][size_t(c) % 3]; };
	const auto other = [&](int c) { return c < corners ? c + corners : c - corners; };
	MergeForest fans(2 * corners);
	cancellableLoop(corners, cancel, [&](int h) {
		const int g = partner[size_t(h)];
		if (g < h)
			return;
		const bool isSameSide = vertex(h) != vertex(g);
		for (int at : {h, SurfaceMesh::next(h)}) {
			const int there = vertex(g) == vertex(at) ? g : SurfaceMesh::next(g);
			fans.join(at, isSameSide ? there : other(there));
			fans.join(other(at), isSameSide ? other(there) : there);
		}
	});
	std::vector<Point3d> normal = filledArray(2 * partner.size(), Point3d(0, 0, 0), cancel);
	cancellableLoop(2 * corners, cancel, [&](int c) {
		const Triangle& t = faces[size_t(c % corners) / 3];
		const Point3d& a = thick.points[size_t(t[0])];
		const Point3d up = (thick.points[size_t(t[1])] - a) ^ (thick.points[size_t(t[2])] - a);
		normal[size_t(fans.find(c))] += c < corners ? up : -up;
	});
	std::vector<int> placeOf(size_t(2 * corners), -1);
	const auto place = [&](int c) {
		const int fan = fans.find(c);
		int& found = placeOf[size_t(fan)];
		if (found < 0) {
			found = int(thick.points.size());
			const Point3d& n = normal[size_t(fan)];
			const double length = n.Norm();
			const Point3d p = thick.points[size_t(vertex(c))];
			thick.points.push_back(length > 0 ? p + n * (thickness / 2 / length) : p);
		}
		return found;
	};
	std::vector<int> ofVertex(thick.points.size(), -1);
	for (int c = 0; c < corners; c += 3) {
		const Triangle up = {place(c), place(c + 1), place(c + 2)};
		thick.triangles.push_back(up);
		for (int k = 0; k < 3; ++k)
			if (ofVertex[size_t(vertex(c + k))] < 0)
				ofVertex[size_t(vertex(c + k))] = up[size_t(k)];
		const int below = other(c);
		thick.triangles.push_back({place(below), place(below + 2), place(below + 1)});
	}
	for (int h = 0; h < corners; ++h)
		if (partner[size_t(h)] < 0) {
			const int a = place(h), b = place(SurfaceMesh::next(h));
			const int c = place(other(h)), d = place(other(SurfaceMesh::next(h)));
			thick.triangles.push_back({b, a, c});
			thick.triangles.push_back({b, c, d});
		}
	for (int v = 0; v < int(points.size()); ++v) {
		const int own = ofVertex[size_t(seams.vertexOf[size_t(standsFor[size_t(v)])])];
		thick.vertexOfInput.push_back(own < 0 ? v : own);
	}
	return thick;
}

} // namespace vcg::tri::mcf

#endif
