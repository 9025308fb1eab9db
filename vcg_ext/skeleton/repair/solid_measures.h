// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What a surface encloses, how thick that is, and how far two surfaces are from each other.

#ifndef VCG_MCF_SOLID_MEASURES_H
#define VCG_MCF_SOLID_MEASURES_H

#include "fill_holes.h"
#include "part_surface.h"
#include "solid_pieces.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/integer_winding.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The number of triangles that cross others with which they share no vertex.
/// Complexity: O(F log F) on evenly sampled surfaces.
inline int selfIntersections(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const TriangleTree& tree, const Progress& progress)
{
	constexpr int together = 16; // neighbours, which meet the same triangles
	std::vector<char> crosses(triangles.size(), 0);
	const std::vector<int> groups = tree.nodesOfAtMost(together);
	forEachBlock(
		int(groups.size()), progress, "Looking for self-intersections", [&](int begin, int end) {
			std::vector<std::pair<Box3d, int>> near;
			for (int i = begin; i < end; ++i) {
				const TriangleTree::Node& group = tree.allNodes()[size_t(groups[size_t(i)])];
				near.clear();
				tree.forEachFaceIn(group.box, [&](int f) { near.emplace_back(tree.boxOf(f), f); });
				for (int k = group.begin; k < group.end; ++k) {
					const int f = tree.order()[size_t(k)];
					const Box3d box = tree.boxOf(f);
					crosses[size_t(f)] =
						std::any_of(near.begin(), near.end(), [&](const auto& other) {
							return TriangleTree::meet(other.first, box)
								&& areCrossing(
									points, triangles[size_t(f)], triangles[size_t(other.second)]);
						});
				}
			}
		});
	return int(std::count(crosses.begin(), crosses.end(), 1));
}

/// A point of a surface, and the unit normal there.
struct SurfacePlace
{
	Point3d point, normal;
};

/// How far from a surface the winding numbers on its two sides are taken, of the diagonal.
constexpr double besideSurface = 1e-6;

/// About `count` places, spread evenly over the area: centroids of triangles, and further points of
/// large ones.
inline std::vector<SurfacePlace> placesByArea(
	const std::vector<Point3d>& points, const std::vector<Triangle>& triangles, int count)
{
	double whole = 0;
	for (const Triangle& t : triangles)
		whole += areaVector(points, t).Norm();
	std::vector<SurfacePlace> places;
	double upto = 0;
	for (const Triangle& t : triangles) {
		const Point3d n = areaVector(points, t);
		const double area = n.Norm();
		upto += area;
		// A large triangle gets several places, at different points.
		for (int k = 0; area > 0 && double(places.size()) + 0.5 < upto / whole * count; ++k) {
			const double golden = 0.6180339887498949, s0 = std::fmod(0.5 + k * golden, 1.0);
			const double t0 = std::fmod(0.5 + k * golden * golden, 1.0);
			const bool fold = s0 + t0 > 1;
			const double s = k == 0 ? 1 / 3.0 : fold ? 1 - s0 : s0;
			const double r = k == 0 ? 1 / 3.0 : fold ? 1 - t0 : t0;
			const Point3d& a = points[size_t(t[0])];
			places.push_back(
				{a + (points[size_t(t[1])] - a) * s + (points[size_t(t[2])] - a) * r, n / area});
		}
	}
	return places;
}

/// Flips each closed piece that is inside out.
inline void turnOutward(
	const std::vector<Point3d>& points, std::vector<Triangle>& triangles, const Progress& progress)
{
	const std::vector<int> partner = pairedHalfEdges(points, triangles, nullptr, progress);
	const Progress cancel = progress.cancelOnly();
	const std::vector<int> piece = pieceOfFaces(partner, cancel);
	const std::vector<char> open = openPieces(partner, piece, cancel);
	std::vector<double> volume(triangles.size(), 0);
	const Point3d origin = points[size_t(triangles[0][0])];
	cancellableLoop(int(triangles.size()), cancel, [&](int i) {
		const size_t f = size_t(i);
		const Triangle& t = triangles[f];
		volume[size_t(piece[f])] += (points[size_t(t[0])] - origin)
			* ((points[size_t(t[1])] - origin) ^ (points[size_t(t[2])] - origin)) / 6;
	});
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		if (const size_t p = size_t(piece[size_t(f)]); !open[p] && volume[p] < 0)
			std::swap(triangles[size_t(f)][1], triangles[size_t(f)][2]);
	});
}

/// Whether a surface encloses a solid, by the winding number just inside of it.
struct Enclosure
{
	double outward =
		0; ///< mean of the winding number on the surface, 1/2 if closed, below 0: inside out
	double enclosing = 0; ///< part of the area that is not like an open sheet
};

/// @param winding  gives the winding number at a point.
template <class Winding>
Enclosure enclosureOf(const std::vector<SurfacePlace>& places, const Winding& winding,
	double diagonal, const Progress& progress)
{
	constexpr double likeASheet =
		0.65; // a flat sheet has 1/2 on its inside, half a sphere 0.75 to 0.85
	std::vector<double> inside(places.size());
	forEachBlock(
		int(places.size()), progress, "Measuring the winding number", [&](int begin, int end) {
			for (int i = begin; i < end; ++i) {
				const SurfacePlace& at = places[size_t(i)];
				inside[size_t(i)] = winding(at.point - at.normal * (besideSurface * diagonal));
			}
		});
	Enclosure found;
	for (double w : inside) {
		found.outward += (std::clamp(w, -1.0, 2.0) - 0.5) / double(places.size());
		found.enclosing += (w > likeASheet) / double(places.size());
	}
	return found;
}

/// For each triangle whether its piece of surface has a border.
inline std::vector<char> isOfOpenPiece(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Progress& progress)
{
	const std::vector<int> partner = pairedHalfEdges(points, triangles, nullptr, progress);
	const Progress cancel = progress.cancelOnly();
	const std::vector<int> piece = pieceOfFaces(partner, cancel);
	std::vector<char> open = openPieces(partner, piece, cancel);
	cancellableLoop(
		int(open.size()), cancel, [&](int f) { open[size_t(f)] = open[size_t(piece[size_t(f)])]; });
	return open;
}

/// The part of a closed surface's area where the winding number is 1 on both sides: bodies share a
/// wall there.
inline double sharedWalls(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const TriangleTree& tree, const Progress& progress)
{
	constexpr int samples = 2000;
	const double step = besideSurface * tree.allNodes()[0].box.Diag();
	const std::vector<SurfacePlace> places = placesByArea(points, triangles, samples);
	const auto isShared = [&](const SurfacePlace& at, const auto& isOne) {
		return isOne(at.point + at.normal * step) && isOne(at.point - at.normal * step);
	};
	std::vector<SurfacePlace> shared;
	for (const SurfacePlace& at : places) {
		progress.report(0, "Looking for walls");
		if (isShared(at, [&](const Point3d& p) { return integerWinding(tree, p) == 1; }))
			shared.push_back(at);
	}
	if (shared.empty())
		return 0;
	// A place on an edge has one of its sides on the other face of the edge: that is no wall.
	const WindingNumber winding(tree, progress);
	const auto isOne = [&](const Point3d& p) {
		const double w = winding(p);
		return w > 0.75 && w < 1.25;
	};
	const auto isWall = [&](const SurfacePlace& at) { return isShared(at, isOne); };
	return double(std::count_if(shared.begin(), shared.end(), isWall)) / double(places.size());
}

/**
 * The depth, inwards along the normal, at which the solid ends behind a place of its surface; at most
 * `maximum`. Mesh units.
 * @param winding   the winding number just inside of the place.
 * @param isClosed  then crossings into the solid count, too: it ends where the winding number is 0,
 *                  not at walls inside.
 */
inline double thicknessAt(
	const SurfacePlace& at, const TriangleTree& tree, int winding, bool isClosed, double maximum)
{
	constexpr int pieces = 8;        // short segments meet few boxes
	constexpr double ownFace = 1e-6; // of `maximum`
	std::vector<std::pair<double, bool>> crossings;
	for (int k = 0; k < pieces; ++k) {
		const double from = maximum * k / pieces, length = maximum / pieces;
		crossings.clear();
		tree.forEachCrossing(at.point - at.normal * from, at.point - at.normal * (from + length),
			[&](int, double t, bool leaves) {
				if (const double depth = from + t * length; depth > ownFace * maximum)
					crossings.emplace_back(depth, leaves);
			});
		std::sort(crossings.begin(), crossings.end());
		for (const auto& [depth, leaves] : crossings) {
			winding += leaves ? -1 : int(isClosed);
			if (winding <= 0)
				return depth;
		}
	}
	return maximum;
}

/**
 * The thickness below which the fraction `part` of the area lies, see thicknessAt(); at most
 * `maximum`. Mesh units.
 * @param isClosed  then walls inside the solid that all pieces make together do not count as area.
 */
inline double smallThickness(const std::vector<SurfacePlace>& places, const TriangleTree& tree,
	bool isClosed, double part, double maximum, const Progress& progress)
{
	constexpr double inside = -1;
	const double step = besideSurface * tree.allNodes()[0].box.Diag();
	std::vector<double> thickness(places.size());
	forEachBlock(int(places.size()), progress, "Measuring the thickness", [&](int begin, int end) {
		for (int i = begin; i < end; ++i) {
			const SurfacePlace& at = places[size_t(i)];
			const auto windingAt = [&](double height) {
				return integerWinding(tree, at.point + at.normal * height);
			};
			thickness[size_t(i)] = isClosed && windingAt(step) > 0
				? inside
				: thicknessAt(at, tree, isClosed ? windingAt(-step) : 1, isClosed, maximum);
		}
	});
	thickness.erase(std::remove(thickness.begin(), thickness.end(), inside), thickness.end());
	if (thickness.empty())
		return maximum;
	const auto middle = thickness.begin() + long(part * double(thickness.size()));
	std::nth_element(thickness.begin(), middle, thickness.end());
	return *middle;
}

/// Mean and greatest distance from points to triangles.
struct Distances
{
	double mean = 0, greatest = 0;
};

/// @param from  those of `all` points that are not on the triangles. Of 40000 and more, 20000 to
/// 30000 are measured, evenly chosen.
inline Distances distances(const std::vector<Point3d>& from, size_t all,
	const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const Progress& progress)
{
	constexpr size_t maximum = 20000;
	if (from.empty())
		return {};
	const TriangleTree to(points, triangles, progress.part(0, 0.5));
	const size_t step = std::max<size_t>(1, from.size() / maximum);
	std::vector<double> distance((from.size() + step - 1) / step, 0);
	forEachBlock(int(distance.size()), progress.part(0.5, 1), "Measuring the distance",
		[&](int begin, int end) {
			for (int i = begin; i < end; ++i)
				distance[size_t(i)] = to.closest(from[size_t(i) * step]).distance;
		});
	Distances result;
	for (double d : distance) {
		result.mean += d / double(distance.size()) * double(from.size()) / double(all);
		result.greatest = std::max(result.greatest, d);
	}
	return result;
}

/**
 * Whether a wrap has cut bodies that make up more than a tenth of the surface's area. A body is cut
 * if at least two pieces of the wrap each have more than a tenth of its area closest to it.
 * @throws Cancelled. Complexity: O(F log F).
 */
inline bool isCutInWrap(const SurfaceMesh& mesh, const ClosedPieces& bodies,
	const SurfaceMesh& wrapped, const ClosedPieces& pieces, const Progress& progress)
{
	constexpr double noticeable = 0.1; // of an area
	constexpr int samples = 100;       // of each piece of the wrap
	const auto areaOf = [](const SurfaceMesh& surface, const std::vector<Triangle>& faces) {
		double area = 0;
		for (const Triangle& t : faces)
			area += areaVector(surface.position, t).Norm();
		return area;
	};
	const std::vector<Triangle> faces = mesh.triangles();
	const TriangleTree tree(mesh.position, faces, progress.part(0, 0.5));
	std::vector<double> bodyArea;
	for (const std::vector<Triangle>& body : bodies.faces)
		bodyArea.push_back(areaOf(mesh, body));
	std::vector<int> piecesOfBody(bodies.count(), 0);
	for (size_t i = 0; i < pieces.count(); ++i) {
		const std::vector<SurfacePlace> places =
			placesByArea(wrapped.position, pieces.faces[i], samples);
		const double areaOfPlace = areaOf(wrapped, pieces.faces[i]) / double(places.size());
		std::map<size_t, double> nearArea; // of the piece, by body
		for (const SurfacePlace& at : places) {
			const Triangle& t = faces[size_t(tree.closest(at.point).face)];
			nearArea[size_t(bodies.ofVertex[size_t(t[0])])] += areaOfPlace;
		}
		for (const auto& [b, area] : nearArea)
			piecesOfBody[b] += area > noticeable * bodyArea[b];
		progress.report(
			0.5 + 0.5 * double(i + 1) / double(pieces.count()), "Comparing with the wrap");
	}
	double cut = 0, all = 0;
	for (size_t b = 0; b < bodyArea.size(); ++b) {
		cut += piecesOfBody[b] > 1 ? bodyArea[b] : 0;
		all += bodyArea[b];
	}
	return cut > noticeable * all;
}

/// The part of a surface's area that is outside of a wrap and farther from it than a distance.
/// @throws Cancelled. Complexity: O(F log F).
inline double partLeftOut(
	const SurfaceMesh& mesh, const SurfaceMesh& wrapped, double distance, const Progress& progress)
{
	constexpr int samples = 4000;
	const std::vector<SurfacePlace> places =
		placesByArea(mesh.position, mesh.triangles(progress), samples);
	const std::vector<Triangle> faces = wrapped.triangles(progress);
	const TriangleTree tree(wrapped.position, faces, progress.part(0, 0.5));
	size_t leftOut = 0;
	cancellableLoop(int(places.size()), progress.cancelOnly(), [&](int i) {
		const Point3d& p = places[size_t(i)].point;
		leftOut += tree.closest(p).distance > distance && integerWinding(tree, p) == 0;
	});
	return places.empty() ? 0 : double(leftOut) / double(places.size());
}

} // namespace detail

} // namespace vcg::tri::mcf

#endif
