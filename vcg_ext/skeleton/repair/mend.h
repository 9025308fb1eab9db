// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Mends small defects of a surface locally; the rest keeps its vertices, bit for bit.

#ifndef VCG_MCF_MEND_H
#define VCG_MCF_MEND_H

#include "bridge_gaps.h"
#include "cap_cuts.h"
#include "close_seams.h"
#include "fill_holes.h"
#include "part_surface.h"
#include "specks.h"
#include "winding_number.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/coincident_points.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What mend() has done.
struct MendReport
{
	int facesDropped = 0;    ///< degenerate, not finite, copies, back to back, or cut around holes
	int verticesMerged = 0;  ///< that coincided, or nearly so along a border
	int junctionsClosed = 0; ///< vertices on the edge of another face
	int edgesParted = 0;     ///< with more than two faces
	int verticesParted = 0;  ///< at which separate fans of faces met
	int facesTurned = 0;     ///< against their neighbours
	int piecesDropped = 0;   ///< specks, walls inside, and closed pieces without volume
	int gapsBridged = 0;     ///< between the ends of torn limbs
	int holesClosed = 0;
	int holesLeft = 0; ///< too large, or not to be filled without crossing the surface
	bool oneSided = false;

	bool isChanged() const
	{
		return facesDropped || verticesMerged || junctionsClosed || edgesParted || verticesParted
			|| facesTurned || piecesDropped || gapsBridged || holesClosed;
	}
};

/// A surface mended as far as possible.
struct MendedSurface
{
	/// Those of the input, in their order, bit for bit, but 0 where not finite; then the new ones.
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
	/// For each input point the one that stands for it: itself, unless it was merged.
	std::vector<int> vertexOfInput;
	MendReport report;
	/// Whether it is a closed, coherently oriented two-manifold.
	bool closed = false;
};

namespace detail {

/// Removes pairs of faces with the same corners and opposite orientation: they enclose nothing.
/// @param edges  of the triangles. @return how many. @pre no face is there twice. @throws Cancelled
inline int removeBackToBack(
	std::vector<Triangle>& triangles, const SoupEdges& edges, const Progress& progress)
{
	std::vector<char> drop(triangles.size(), 0);
	std::vector<std::pair<int, unsigned>> faces; // at an edge: the corner opposite, and the face
	forEachSoupEdge(edges, progress, [&](int low, const SoupEdge* begin, const SoupEdge* end) {
		if (end - begin < 2)
			return;
		faces.clear();
		for (const SoupEdge* e = begin; e != end; ++e) {
			const Triangle& t = triangles[e->face];
			faces.emplace_back(t[0] + t[1] + t[2] - low - e->high, e->face);
		}
		std::sort(faces.begin(), faces.end());
		for (size_t i = 1; i < faces.size(); ++i)
			if (faces[i].first == faces[i - 1].first)
				drop[faces[i].second] = drop[faces[i - 1].second] = 1;
	});
	return int(removeMarked(triangles, drop));
}

/// The number of holes of a coherently oriented surface, see holeLoops().
inline int holesOf(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const Progress& progress)
{
	return int(holeLoops(
		points, triangles, pairedHalfEdges(points, triangles, nullptr, progress), progress)
				   .size());
}

/**
 * Removes the faces around small holes that could not be filled, such as flaps that lie back on
 * the surface, so that the larger holes may be; none if they are too much of the area.
 * @return how many.
 */
inline int cutAroundHoles(
	const std::vector<Point3d>& points, std::vector<Triangle>& triangles, const Progress& progress)
{
	constexpr size_t edges = 40;   // of a hole
	constexpr double part = 0.002; // of the area, in all
	const std::vector<int> partner =
		pairedHalfEdges(points, triangles, nullptr, progress.part(0, 0.5));
	std::vector<char> cut(triangles.size(), 0);
	const Progress cancel = progress.cancelOnly();
	for (const std::vector<int>& loop : holeLoops(points, triangles, partner, cancel))
		for (int h : loop)
			if (loop.size() <= edges)
				cut[size_t(h) / 3] = 1;
	double whole = 0, gone = 0;
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		const double area = areaVector(points, triangles[size_t(f)]).Norm();
		whole += area;
		gone += cut[size_t(f)] ? area : 0;
	});
	if (!(gone < part * whole))
		return 0;
	return int(removeMarked(triangles, cut));
}

/// Drops open pieces that lie mostly inside the closed ones: walls across the solid, of which no
/// filling makes a body. @return how many.
inline int dropInnerWalls(
	const std::vector<Point3d>& points, std::vector<Triangle>& triangles, const Progress& progress)
{
	const std::vector<int> partner =
		pairedHalfEdges(points, triangles, nullptr, progress.part(0, 0.3));
	const Progress cancel = progress.cancelOnly();
	const std::vector<int> piece = pieceOfFaces(partner, cancel);
	const std::vector<char> open = openPieces(partner, piece, cancel);
	std::vector<Triangle> closed;
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		if (!open[size_t(piece[size_t(f)])])
			closed.push_back(triangles[size_t(f)]);
	});
	if (closed.empty() || closed.size() == triangles.size())
		return 0;
	const TriangleTree tree(points, closed, progress.part(0.3, 0.5));
	const WindingNumber winding(tree, progress.part(0.5, 0.6));
	std::map<int, std::pair<double, double>> areas; // of each open piece: all, and inside
	reportedLoop(int(triangles.size()), progress.part(0.6, 1), repairing, [&](int f) {
		if (!open[size_t(piece[size_t(f)])])
			return;
		const Triangle& t = triangles[size_t(f)];
		const Point3d &a = points[size_t(t[0])], &b = points[size_t(t[1])],
					  &c = points[size_t(t[2])];
		const double area = ((b - a) ^ (c - a)).Norm();
		auto& [whole, inside] = areas[piece[size_t(f)]];
		whole += area;
		// A closed piece may still be inside out.
		if (std::abs(winding((a + b + c) / 3.0)) > 0.75)
			inside += area;
	});
	int dropped = 0;
	std::vector<char> drop(triangles.size(), 0);
	for (const auto& [first, area] : areas)
		if (area.second > 0.5 * area.first) {
			drop[size_t(first)] = 1;
			++dropped;
		}
	cancellableLoop(
		int(drop.size()), cancel, [&](int f) { drop[size_t(f)] = drop[size_t(piece[size_t(f)])]; });
	removeMarked(triangles, drop);
	return dropped;
}

} // namespace detail

/**
 * Mends small defects, in this order: faces that are degenerate, not finite, or there twice;
 * vertices that coincide; seams (see closeSeams()); orientation; edges and vertices where the
 * surface is not two-manifold (see partSurface()); specks and torn limbs (see bridgeGaps()); small
 * holes (see fillHoles()); cuts by planes (see capCuts()); faces around small holes that are left;
 * open walls inside closed pieces; last, tiny holes, even if their filling folds. Where a slit runs
 * around a limb, both stay open, see BridgedGaps::slits.
 *
 * A surface without these defects is returned unchanged. What cannot be mended is left, with
 * `closed` false.
 * @param points    mesh units. @param triangles corners as indices into `points`.
 * @param limits    which holes are filled.
 * @throws Cancelled. Complexity: about O(V + F), and that of the functions above.
 */
inline MendedSurface mend(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const HoleLimits& limits = HoleLimits(),
	const Progress& progress = Progress())
{
	using namespace detail;
	MendedSurface mended;
	MendReport& report = mended.report;
	mended.points = copiedArray(points, progress);
	std::vector<Triangle>& faces = mended.triangles;
	const Progress cancel = progress.cancelOnly();
	faces = finiteFaces(points, triangles, cancel);
	cancellableLoop(int(points.size()), cancel, [&](int v) {
		if (!isFinitePlace(points[size_t(v)]))
			mended.points[size_t(v)] = Point3d(0, 0, 0); // of no face
	});
	report.facesDropped = int(triangles.size() - faces.size());
	report.facesDropped += int(removeDegenerateFaces(points.size(), faces, progress.part(0, 0.1)));

	// Coincident vertices, if there are fewer defects with these merged.
	std::vector<int>& vertexOfInput = mended.vertexOfInput;
	vertexOfInput = numberedArray(points.size(), cancel);
	const auto edgesOf = [&](const std::vector<Triangle>& some) {
		return sortedSoupEdges(mended.points.size(), some, cancel);
	};
	const auto defectsOf = [&](const SoupEdges& some) {
		const EdgeDefects defects = edgeDefects(mended.points, some, cancel);
		return defects.border + defects.nonManifold;
	};
	SoupEdges edges = edgesOf(faces);
	if (const size_t defects = defectsOf(edges)) {
		const std::vector<int> first =
			firstCoincident(mended.points, progress.part(0.1, 0.15), repairing);
		std::vector<Triangle> merged = copiedArray(faces, cancel);
		cancellableLoop(int(merged.size()), cancel, [&](int f) {
			for (int& v : merged[size_t(f)])
				v = first[size_t(v)];
		});
		if (merged != faces) {
			const size_t dropped =
				removeDegenerateFaces(points.size(), merged, progress.part(0.15, 0.2));
			SoupEdges mergedEdges = edgesOf(merged);
			if (defectsOf(mergedEdges) < defects) {
				for (size_t v = 0; v < points.size(); ++v)
					report.verticesMerged += isFinitePlace(points[v]) && first[v] != int(v);
				report.facesDropped += int(dropped);
				faces = std::move(merged);
				edges = std::move(mergedEdges);
				vertexOfInput = first;
			}
		}
	}
	if (const int dropped = removeBackToBack(faces, edges, cancel)) {
		report.facesDropped += dropped;
		edges = edgesOf(faces);
	}
	const ClosedSeams seams = closeSeams(mended.points, faces, edges, progress.part(0.2, 0.4));
	report.verticesMerged += seams.merged;
	report.junctionsClosed = seams.junctions;
	for (int& v : vertexOfInput)
		v = seams.vertexOf[size_t(v)];
	if (faces.empty())
		return mended;

	std::vector<int> partedFrom;
	// First over the edges with two faces only: the pairing at the others depends on it.
	const int turnedFirst = orientCoherently(faces, edges, cancel);
	PartedSurface parted =
		partSurface(mended.points, faces, partedFrom, true, progress.part(0.4, 0.5));
	report.edgesParted = parted.edges;
	report.verticesParted = parted.vertices;
	const bool isParted = parted.edges > 0 || parted.vertices > 0;
	const int turnedThen =
		isParted ? orientCoherently(faces, edgesOf(faces), cancel) : std::min(turnedFirst, 0);
	report.oneSided = turnedThen < 0;
	report.facesTurned = std::max(turnedFirst, 0) + std::max(turnedThen, 0);
	if (report.oneSided)
		return mended;
	std::vector<int> partner = isParted
		? pairedHalfEdges(mended.points, faces, nullptr, progress.part(0.5, 0.55))
		: std::move(parted.partner);
	// A torn-off limb may be as small as a speck: it stays until bridgeGaps() has tried to join it.
	Specks specks = specksOf(mended.points, faces, partner, cancel);
	if (specks.count > 0) {
		spareTornLimbs(mended.points, faces, partner, specks, cancel);
		report.piecesDropped = dropSpecks(faces, partner, specks, cancel);
		specks = specksOf(mended.points, faces, partner, cancel);
	}
	const BridgedGaps gaps = bridgeGaps(
		mended.points, faces, partner, specks.isOne, GapLimits(), progress.part(0.55, 0.6));
	report.gapsBridged = gaps.tubes;
	if (report.gapsBridged > 0) {
		partner = pairedHalfEdges(mended.points, faces, nullptr, cancel);
		specks = specksOf(mended.points, faces, partner, cancel);
	}
	report.piecesDropped += dropSpecks(faces, partner, specks, cancel);
	const FilledHoles holes =
		fillHoles(mended.points, faces, partner, limits, progress.part(0.6, 0.9), gaps.slits);
	report.holesClosed = holes.closed;
	report.holesLeft = holes.left;
	if (!gaps.slits.empty()) // they are for the wrap, which needs no more fillings
		return mended;
	if (report.holesLeft > 0) {
		partner = pairedHalfEdges(mended.points, faces, nullptr, cancel);
		const int capped =
			capCuts(mended.points, faces, partner, CutLimits(), progress.part(0.9, 0.95));
		report.holesClosed += capped;
		report.holesLeft -= capped;
	}
	constexpr int maxCuts = 3;
	for (int round = 0; round < maxCuts && report.holesLeft > 0; ++round) {
		std::vector<Triangle> fewer = copiedArray(faces, cancel);
		const size_t pointsBefore = mended.points.size();
		const int cut = cutAroundHoles(mended.points, fewer, cancel);
		if (!cut)
			break;
		partner = partSurface(mended.points, fewer, partedFrom, true, cancel).partner;
		const int dropped = dropSpecks(mended.points, fewer, partner, cancel);
		const FilledHoles filled = fillHoles(mended.points, fewer, partner, limits, cancel);
		if (filled.left >= report.holesLeft) {
			mended.points.resize(pointsBefore);
			break;
		}
		faces = std::move(fewer);
		report.facesDropped += cut;
		report.piecesDropped += dropped;
		report.holesClosed += filled.closed;
		report.holesLeft = filled.left;
	}
	const int walls = report.holesLeft > 0 ? dropInnerWalls(mended.points, faces, cancel) : 0;
	report.piecesDropped += walls;
	if (walls)
		report.holesLeft = holesOf(mended.points, faces, cancel);
	if (report.holesLeft > 0) {
		constexpr double tiny =
			0.002; // of the area: a fold there is better than to wrap all the rest
		HoleLimits rough = limits;
		rough.anyhow = tiny;
		partner = partSurface(mended.points, faces, partedFrom, true, cancel).partner;
		const FilledHoles filled = fillHoles(mended.points, faces, partner, rough, cancel);
		report.holesClosed += filled.closed;
		report.holesLeft = filled.left;
	}
	if (report.holesLeft == 0) {
		report.verticesParted +=
			partSurface(mended.points, faces, partedFrom, false, progress.part(0.95, 1)).vertices;
		mended.closed = SurfaceMesh::isClosedManifold(mended.points.size(), faces, cancel);
	}
	return mended;
}

} // namespace vcg::tri::mcf

#endif
