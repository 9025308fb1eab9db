// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Limbs that are torn in two, joined by a tube across the gap.

#ifndef VCG_MCF_BRIDGE_GAPS_H
#define VCG_MCF_BRIDGE_GAPS_H

#include "fill_holes.h"
#include "limb_ends.h"
#include "limb_tubes.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/box_tree.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Which two borders count as the two sides of a gap.
struct GapLimits
{
	/// Largest distance of their centres, in mean radii of the two: between two pieces of surface,
	/// and within one piece.
	double apart = 60, inOnePiece = 3;
	/// The same in diagonals of the smaller piece.
	double ofPiece = 3;
	/// Largest angle between the heading of an end and the direction to the other end, degrees.
	double aside = 60;
	/// Largest ratio of their radii; a hole in a body's side that a limb leads into may be wider.
	double wider = 3;
	/// Largest number of corners of a border.
	int edges = 1000;
};

namespace detail {

/// Whether the axis of a limb passes through a hole in the side of a body, which may be wider.
inline bool leadsInto(const LimbEnd& limb, const LimbEnd& hole)
{
	const Point3d apart = hole.centre - limb.centre;
	return !hole.isCutThrough
		&& (apart - limb.heading * (limb.heading * apart)).Norm() < hole.radius;
}

/// The direction in which an end is continued towards another one: its heading, or its normal where
/// that leads there more directly, since a hole where limbs met is the end of no single limb.
inline Point3d headingTo(const LimbEnd& other, const LimbEnd& end)
{
	return (end.out - end.heading) * (other.centre - end.centre) > 0 ? end.out : end.heading;
}

/// Cut limbs, to be searched for those within whose reach something is.
class LimbReaches
{
public:
	/// @param reachOf  reachOf(end), mesh units. @throws Cancelled
	template <class ReachOf>
	LimbReaches(
		const std::vector<LimbEnd>& ends, const ReachOf& reachOf, const Progress& progress) :
			ticker(progress.cancelOnly(), repairing, double(ends.size()))
	{
		constexpr double rounding = 1e-6;
		std::vector<Box3d> boxes;
		for (size_t i = 0; i < ends.size(); ++i) {
			const double reach = (1 + rounding) * reachOf(ends[i]);
			if (!ends[i].isCutThrough || !std::isfinite(reach))
				continue;
			const Point3d corner(reach, reach, reach);
			boxes.emplace_back(ends[i].centre - corner, ends[i].centre + corner);
			limbs.push_back(int(i));
		}
		tree.emplace(boxes, progress.cancelOnly());
	}

	/// Calls visit(number of the end) for each limb with some of a box within its reach, and for
	/// some others. @throws Cancelled
	template <class Visit>
	void forEachReaching(const Box3d& box, const Visit& visit)
	{
		tree->forEachIn(box, [&](int i) {
			ticker.tick();
			visit(limbs[size_t(i)]);
		});
	}

private:
	std::vector<int> limbs; ///< the end of each box in the tree
	std::optional<BoxTree> tree;
	Ticker ticker;
};

/// Pairs of ends that face each other, nearest first: distance over the cosine of the larger angle,
/// and their numbers, a cut limb first. @throws Cancelled
/// Complexity: O(n log n + p log p) for n ends, p of the pairs being within reach.
inline std::vector<std::tuple<double, int, int>> facingEnds(const std::vector<LimbEnd>& ends,
	const GapLimits& limits, const Progress& progress = Progress())
{
	const double straight = std::cos(limits.aside * M_PI / 180);
	double widestHole = 0;
	for (const LimbEnd& end : ends)
		if (!end.isCutThrough)
			widestHole = std::max(widestHole, end.radius);
	LimbReaches reaches(
		ends,
		[&](const LimbEnd& end) {
			const double widest = std::max(limits.wider * end.radius, widestHole);
			return std::min(std::max(limits.apart, limits.inOnePiece) * (end.radius + widest) / 2,
				limits.ofPiece * end.pieceDiagonal);
		},
		progress);
	std::vector<std::tuple<double, int, int>> facing;
	const auto look = [&](int i, int k) {
		const LimbEnd &a = ends[size_t(i)], &b = ends[size_t(k)];
		const Point3d apart = b.centre - a.centre;
		const double gap = apart.Norm(), radius = (a.radius + b.radius) / 2;
		const bool isOnePiece = a.piece == b.piece;
		if (gap > (isOnePiece ? limits.inOnePiece : limits.apart) * radius || !(gap > 0)
			|| gap > limits.ofPiece * std::min(a.pieceDiagonal, b.pieceDiagonal)
			|| a.radius > limits.wider * b.radius
			|| (b.radius > limits.wider * a.radius && !leadsInto(a, b))
			|| ((isOnePiece || a.isOfSpeck || b.isOfSpeck) && !b.isCutThrough))
			return;
		const double ofA = a.heading * apart / gap, ofB = -(headingTo(a, b) * apart) / gap;
		if (std::min(ofA, ofB) >= straight)
			facing.emplace_back(gap / std::min(ofA, ofB), i, k);
	};
	for (int k = 0; k < int(ends.size()); ++k) {
		const Point3d& centre = ends[size_t(k)].centre;
		reaches.forEachReaching(Box3d(centre, centre), [&](int i) { look(i, k); });
	}
	std::sort(facing.begin(), facing.end());
	return facing;
}

/// Joins ends by tubes; one object for each surface.
class GapBridges
{
public:
	GapBridges(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
		const std::vector<int>& partner, const std::vector<char>& isSpeck, const GapLimits& limits,
		const Progress& progress) :
			points(points),
			triangles(triangles), limits(limits), piece(pieceOfFaces(partner, progress)),
			pieces(int(piece.size()))
	{
		const Progress cancel = progress.cancelOnly();
		std::vector<Box3d> box = filledArray(piece.size(), Box3d(), cancel);
		cancellableLoop(int(piece.size()), cancel, [&](int f) {
			for (int v : triangles[size_t(f)])
				box[size_t(piece[size_t(f)])].Add(points[size_t(v)]);
		});
		for (const std::vector<int>& loop : holeLoops(points, triangles, partner, cancel)) {
			if (loop.size() < 3 || int(loop.size()) > limits.edges)
				continue;
			LimbEnd end = limbEnd(points, triangles, partner, loop);
			end.piece = piece[size_t(loop.front()) / 3];
			end.pieceDiagonal = box[size_t(end.piece)].Diag();
			end.isOfSpeck = !isSpeck.empty() && isSpeck[size_t(end.piece)];
			if (end.isOnce())
				ends.push_back(std::move(end));
		}
	}

	/// @return the number of gaps bridged.
	int run(const Progress& progress)
	{
		const char* const what = "Bridging gaps";
		progress.report(0.2, what);
		const std::vector<std::tuple<double, int, int>> facing =
			facingEnds(ends, limits, progress.cancelOnly());
		if (facing.empty())
			return 0;
		given = triangles;
		tree.emplace(points, given, progress.part(0.2, 0.6));
		std::vector<char> isCorner(points.size(), 0);
		for (const LimbEnd& end : ends)
			for (int v : end.corner)
				isCorner[size_t(v)] = 1;
		edges = edgesBetween(triangles, isCorner, progress);
		for (const auto& [apart, i, k] : facing) {
			progress.report(0.6, what);
			const LimbEnd &a = ends[size_t(i)], &b = ends[size_t(k)];
			// A second tube between two pieces would close a ring.
			if (isFree(a) && isFree(b)
				&& (pieces.find(a.piece) != pieces.find(b.piece)
					|| (b.centre - a.centre).Norm()
						<= limits.inOnePiece * (a.radius + b.radius) / 2))
				join(a, b);
		}
		joinToTubes(progress);
		for (const LimbTube& tube : tubes)
			triangles.insert(triangles.end(), tube.faces.begin(), tube.faces.end());
		return int(tubes.size());
	}

private:
	std::vector<Point3d>& points;
	std::vector<Triangle>& triangles;
	const GapLimits& limits;
	std::vector<int> piece; ///< of each face
	MergeForest pieces;
	std::vector<LimbEnd> ends;
	std::vector<Triangle> given;
	std::optional<TriangleTree> tree;
	std::set<std::pair<int, int>> edges; ///< between corners
	std::set<int> corners;               ///< of the ends that are taken
	std::vector<LimbTube> tubes;
	std::vector<int> pieceOfTube;

	bool isFree(const LimbEnd& end) const
	{
		return std::none_of(
			end.corner.begin(), end.corner.end(), [&](int v) { return corners.count(v) > 0; });
	}

	/// Whether a face crosses given ones, except near the ends, where ragged borders may do so.
	bool crossesElsewhere(const Triangle& t, const LimbEnd& a, const LimbEnd& b) const
	{
		constexpr double near = 3; // radii
		return crossesOthers(*tree, given, points, t, [&](int f) {
			const Point3d& p = points[size_t(given[size_t(f)][0])];
			return (p - a.centre).Norm() > near * a.radius
				&& (p - b.centre).Norm() > near * b.radius;
		});
	}

	/// Adds a tube from a to b, unless it would run into given faces. @return whether it did.
	bool join(const LimbEnd& a, LimbEnd b)
	{
		b.heading = headingTo(a, b);
		const std::set<int> ofA(a.corner.begin(), a.corner.end());
		if (std::any_of(b.corner.begin(), b.corner.end(), [&](int v) { return ofA.count(v) > 0; }))
			return false;
		const size_t before = points.size();
		LimbTube tube = tubeBetween(points, a, b);
		const auto isEdge = [&](int v, int w) {
			return ofA.count(v) != ofA.count(w) && edges.count(std::minmax(v, w)) > 0;
		};
		if (std::any_of(tube.faces.begin(), tube.faces.end(), [&](const Triangle& t) {
				return isEdge(t[0], t[1]) || isEdge(t[1], t[2]) || isEdge(t[2], t[0])
					|| crossesElsewhere(t, a, b);
			})) {
			points.resize(before);
			return false;
		}
		tubes.push_back(std::move(tube));
		pieceOfTube.push_back(a.piece);
		pieces.join(a.piece, b.piece);
		corners.insert(a.corner.begin(), a.corner.end());
		corners.insert(b.corner.begin(), b.corner.end());
		return true;
	}

	bool areApart(const LimbEnd& end, size_t tube)
	{
		return pieces.find(end.piece) != pieces.find(pieceOfTube[tube]);
	}

	double reachOf(const LimbEnd& end) const
	{
		return std::min(limits.apart * end.radius, limits.ofPiece * end.pieceDiagonal);
	}

	/// A limb that faces a tube: distance over the cosine of the angle, end, tube, and its ring in
	/// the direction closest to the end's heading.
	using FacingTube = std::tuple<double, int, size_t, size_t>;

	std::optional<FacingTube> facingTube(int i, size_t t) const
	{
		const LimbEnd& end = ends[size_t(i)];
		if (end.radius > limits.wider * tubes[t].radius)
			return std::nullopt;
		const double reach = reachOf(end);
		double best = -1;
		size_t ring = 0;
		const size_t rings = tubes[t].path.size(), skipped = rings > 2 ? 1 : 0;
		for (size_t k = skipped; k + skipped < rings; ++k) {
			const Point3d apart = tubes[t].path[k] - end.centre;
			if (const double gap = apart.Norm();
				gap > 0 && gap <= reach && end.heading * apart > best * gap) {
				best = end.heading * apart / gap;
				ring = k;
			}
		}
		if (!(best >= std::cos(limits.aside * M_PI / 180)))
			return std::nullopt;
		return FacingTube((tubes[t].path[ring] - end.centre).Norm() / best, i, t, ring);
	}

	/// Where a junction was lost, joins the ends that are left to tubes between others, the nearest
	/// first, the new tubes included.
	void joinToTubes(const Progress& progress)
	{
		LimbReaches reaches(
			ends, [&](const LimbEnd& end) { return reachOf(end); }, progress);
		std::set<FacingTube> facing;
		size_t seen = 0; // tubes
		const auto lookAtNewTubes = [&] {
			for (; seen < tubes.size(); ++seen) {
				Box3d box;
				for (const Point3d& p : tubes[seen].path)
					box.Add(p);
				if (box.IsNull())
					continue;
				reaches.forEachReaching(box, [&](int i) {
					if (areApart(ends[size_t(i)], seen) && isFree(ends[size_t(i)]))
						if (const auto found = facingTube(i, seen))
							facing.insert(*found);
				});
			}
		};
		std::map<size_t, std::vector<FacingTube>> failed; // by tube
		for (lookAtNewTubes(); !facing.empty(); lookAtNewTubes()) {
			progress.report(0.8, "Bridging gaps");
			const FacingTube nearest = *facing.begin();
			facing.erase(facing.begin());
			const auto& [apart, i, t, ring] = nearest;
			if (!areApart(ends[size_t(i)], t) || !isFree(ends[size_t(i)]))
				continue;
			std::vector<Triangle> around;
			LimbEnd hole = holeInWall(points, tubes[t], ring, ends[size_t(i)], around);
			hole.piece = pieceOfTube[t];
			if (hole.corner.empty() || !join(ends[size_t(i)], hole)) {
				failed[t].push_back(nearest);
				continue;
			}
			tubes[t].faces = std::move(around);
			// In the wall that is left, holes for others may be elsewhere.
			facing.insert(failed[t].begin(), failed[t].end());
			failed.erase(t);
		}
	}
};

} // namespace detail

/**
 * Joins the two sides of gaps by tubes: two limbs that were cut through, or such a limb and a hole
 * in the side of a body that it faces. Only ends within a cone ahead are joined, see GapLimits, and
 * only where the tube crosses none of the given faces, except near its ends. Where a junction was
 * lost, a third limb is joined to the tube between two others that it faces.
 *
 * @param points    get those of the tubes at their end.
 * @param triangles coherently oriented, parted by partSurface(); get the tubes at their end.
 * @param partner   as PartedSurface has it.
 * @param isSpeck   for each face whether its piece is to be dropped unless it is joined to others:
 *                  such a piece is joined only if both ends are cut through. Empty: none is.
 * @return the number of tubes. @throws Cancelled.
 * Complexity: O(F log F + p log p) for p pairs of a limb with an end or a tube within its reach.
 */
inline int bridgeGaps(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const std::vector<char>& isSpeck,
	const GapLimits& limits = GapLimits(), const Progress& progress = Progress())
{
	return detail::GapBridges(points, triangles, partner, isSpeck, limits, progress).run(progress);
}

} // namespace vcg::tri::mcf

#endif
