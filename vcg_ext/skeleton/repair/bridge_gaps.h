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

/// How far from each other the two sides of a gap may be, how far aside, and of how different sizes.
struct GapReach
{
	/// Largest distance of their centres, in mean radii of the two, and in diagonals of the smaller
	/// piece of surface.
	double radii, ofPiece;
	/// Largest angle between the heading of an end and the direction to the other end, degrees.
	double aside;
	/// Largest ratio of their radii; a hole that a limb leads into may be wider.
	double wider;

	double minCosine() const { return std::cos(aside * M_PI / 180); }
};

/// Which two borders count as the two sides of a gap.
struct GapLimits
{
	/// Between a cut limb and any border.
	GapReach usual = {60, 3, 60, 3};
	/// Between cut limbs of two pieces that head for each other more exactly.
	GapReach aligned = {240, 10, 40, 6};
	/// Largest distance within one piece of surface, in mean radii.
	double inOnePiece = 3;
	/// Largest number of corners of a border.
	int edges = 1000;
};

/// What bridgeGaps() has done.
struct BridgedGaps
{
	int tubes = 0;
	/// Vertices of borders that lie close to each other and that no tube can join: of slits that cross,
	/// and of patches between them. A wrap joins them if they stay open.
	std::set<int> slits;
};

namespace detail {

/// Whether the axis of a limb passes through a hole: in the side of a body, or where a trunk is cut
/// through, both of which may be wider.
inline bool leadsInto(const LimbEnd& limb, const LimbEnd& hole)
{
	const Point3d apart = hole.centre - limb.centre;
	return (apart - limb.heading * (limb.heading * apart)).Norm() < hole.radius;
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

/// A cut limb and what it faces: another end, or a tube between others.
struct FacingLimb
{
	/// Distance over the cosine of the larger angle, mesh units; of a tube, 1.2 times that.
	double apart;
	int limb;
	/// The number of the tube; -1: it faces an end.
	int tube;
	/// The number of that end, or of the tube's ring closest to the limb's heading.
	int there;

	bool operator<(const FacingLimb& other) const
	{
		return std::tie(apart, limb, tube, there)
			< std::tie(other.apart, other.limb, other.tube, other.there);
	}
};

/// Pairs of ends that face each other, of two cut limbs the narrower one first. @throws Cancelled
/// Complexity: O(n log n + p log p) for n ends, p of the pairs being within reach.
inline std::set<FacingLimb> facingEnds(const std::vector<LimbEnd>& ends, const GapLimits& limits,
	const Progress& progress = Progress())
{
	const GapReach &usual = limits.usual, &aligned = limits.aligned;
	double widestHole = 0;
	for (const LimbEnd& end : ends)
		if (!end.isCutThrough)
			widestHole = std::max(widestHole, end.radius);
	LimbReaches reaches(
		ends,
		[&](const LimbEnd& end) {
			const auto reach = [&](const GapReach& of, double widest) {
				return std::min(
					of.radii * (end.radius + std::max(of.wider * end.radius, widest)) / 2,
					of.ofPiece * end.pieceDiagonal);
			};
			return std::max(reach(usual, widestHole), reach(aligned, 0));
		},
		progress);
	std::set<FacingLimb> facing;
	const auto look = [&](int i, int k) {
		const LimbEnd &a = ends[size_t(i)], &b = ends[size_t(k)];
		if (b.isCutThrough && std::tie(a.radius, i) >= std::tie(b.radius, k))
			return;
		const Point3d apart = b.centre - a.centre;
		const double gap = apart.Norm(), radius = (a.radius + b.radius) / 2;
		const bool isOnePiece = a.piece == b.piece;
		if (!(gap > 0) || ((a.isOfSpeck || b.isOfSpeck) && !b.isCutThrough))
			return;
		if (isOnePiece && !(gap <= limits.inOnePiece * radius && a.isOfTube && b.isOfTube))
			return;
		const double cosine = std::min(a.heading * apart / gap, -(headingTo(a, b) * apart) / gap);
		const auto isWithin = [&](const GapReach& reach, bool mayBeWider) {
			return gap <= reach.radii * radius
				&& gap <= reach.ofPiece * std::min(a.pieceDiagonal, b.pieceDiagonal)
				&& a.radius <= reach.wider * b.radius
				&& (b.radius <= reach.wider * a.radius || mayBeWider)
				&& cosine >= reach.minCosine();
		};
		if (isWithin(usual, leadsInto(a, b))
			|| (b.isCutThrough && !isOnePiece && isWithin(aligned, false)))
			facing.insert({gap / cosine, i, -1, k});
	};
	for (int k = 0; k < int(ends.size()); ++k) {
		const Point3d& centre = ends[size_t(k)].centre;
		reaches.forEachReaching(Box3d(centre, centre), [&](int i) { look(i, k); });
	}
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

	BridgedGaps run(const Progress& progress)
	{
		const char* const what = "Bridging gaps";
		progress.report(0.2, what);
		std::set<FacingLimb> facing = facingEnds(ends, limits, progress.cancelOnly());
		if (facing.empty())
			return {0, slits(progress.cancelOnly())};
		given = triangles;
		tree.emplace(points, given, progress.part(0.2, 0.6));
		std::vector<char> isCorner(points.size(), 0);
		for (const LimbEnd& end : ends)
			for (int v : end.corner)
				isCorner[size_t(v)] = 1;
		edges = edgesBetween(triangles, isCorner, progress);
		LimbReaches reaches(
			ends, [&](const LimbEnd& end) { return reachOf(end); }, progress);
		std::map<int, std::vector<FacingLimb>> failed; // by tube
		while (!facing.empty()) {
			progress.report(0.6, what);
			const FacingLimb nearest = *facing.begin();
			facing.erase(facing.begin());
			const size_t before = tubes.size();
			if (nearest.tube < 0)
				joinEnds(ends[size_t(nearest.limb)], ends[size_t(nearest.there)]);
			else if (joinToTube(nearest)) {
				// In the wall that is left, holes for others may be elsewhere.
				const std::vector<FacingLimb> again = std::move(failed[nearest.tube]);
				facing.insert(again.begin(), again.end());
				failed.erase(nearest.tube);
			}
			else
				failed[nearest.tube].push_back(nearest);
			for (size_t t = before; t < tubes.size(); ++t)
				lookAtTube(int(t), reaches, facing);
		}
		for (const LimbTube& tube : tubes)
			triangles.insert(triangles.end(), tube.faces.begin(), tube.faces.end());
		return {int(tubes.size()), slits(progress.cancelOnly())};
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
		const auto isCornerOf = [](const LimbEnd& end, int v) {
			return std::find(end.corner.begin(), end.corner.end(), v) != end.corner.end();
		};
		return crossesOthers(*tree, given, points, t, [&](int f) {
			const Triangle& other = given[size_t(f)];
			const Point3d& p = points[size_t(other[0])];
			return (p - a.centre).Norm() > near * a.radius
				&& (p - b.centre).Norm() > near * b.radius
				&& std::none_of(other.begin(), other.end(),
					[&](int v) { return isCornerOf(a, v) || isCornerOf(b, v); });
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

	/// BridgedGaps::slits: of irregular ends with the ends beside them of other pieces, and of patches
	/// with all borders beside them, where no tube has joined them. By winding numbers a gap is joined
	/// that is up to about as wide as the radius of its sides. @throws Cancelled
	std::set<int> slits(const Progress& progress) const
	{
		const auto isSlit = [](const LimbEnd& end) {
			return (end.isIrregular || end.isPatch) && !end.isOfSpeck;
		};
		std::set<int> open;
		if (std::none_of(ends.begin(), ends.end(), isSlit))
			return open;
		std::vector<Box3d> boxes;
		for (const LimbEnd& end : ends) {
			boxes.emplace_back();
			for (int v : end.corner)
				boxes.back().Add(points[size_t(v)]);
		}
		const auto areNear = [&](const LimbEnd& a, const LimbEnd& b) {
			const double gap = std::min(a.radius, b.radius);
			return std::any_of(a.corner.begin(), a.corner.end(), [&](int v) {
				return std::any_of(b.corner.begin(), b.corner.end(), [&](int w) {
					return SquaredDistance(points[size_t(v)], points[size_t(w)]) <= gap * gap;
				});
			});
		};
		const BoxTree boxTree(boxes, progress);
		for (const LimbEnd& end : ends) {
			if (!isSlit(end))
				continue;
			Box3d box = boxes[size_t(&end - ends.data())];
			box.Offset(end.radius);
			boxTree.forEachIn(box, [&](int i) {
				progress.check();
				const LimbEnd& other = ends[size_t(i)];
				// Beside an irregular end, as of ragged borders, holes in the sides of bodies are filled.
				if (!(end.isPatch || other.isPatch || other.isIrregular || other.isCutThrough))
					return;
				if (other.piece == end.piece || other.isOfSpeck || !isFree(other)
					|| !areNear(end, other))
					return;
				for (const LimbEnd* side : {&end, &other})
					open.insert(side->corner.begin(), side->corner.end());
			});
		}
		return open;
	}

	/// Joins two ends, unless one of them is irregular, a patch, or taken, or a second tube between two
	/// pieces would close a ring.
	void joinEnds(const LimbEnd& a, const LimbEnd& b)
	{
		const bool isNear =
			(b.centre - a.centre).Norm() <= limits.inOnePiece * (a.radius + b.radius) / 2;
		if (b.isIrregular || b.isPatch || !isFree(a) || !isFree(b)
			|| !(pieces.find(a.piece) != pieces.find(b.piece) || isNear))
			return;
		// Where borders are ragged, a tube may fit in one direction only.
		if (!join(a, b) && b.isCutThrough)
			join(b, a);
	}

	/// Joins a limb to the wall of a tube, as where a junction was lost. @return whether it did.
	bool joinToTube(const FacingLimb& facing)
	{
		const LimbEnd& end = ends[size_t(facing.limb)];
		const size_t t = size_t(facing.tube);
		if (!isFree(end) || !areApart(end, t))
			return false;
		std::vector<Triangle> around;
		LimbEnd hole = holeInWall(points, tubes[t], size_t(facing.there), end, around);
		hole.piece = pieceOfTube[t];
		if (hole.corner.empty() || !join(end, hole))
			return false;
		tubes[t].faces = std::move(around);
		return true;
	}

	bool areApart(const LimbEnd& end, size_t tube)
	{
		return pieces.find(end.piece) != pieces.find(pieceOfTube[tube]);
	}

	/// How far a limb reaches, mesh units.
	static double reachOf(const LimbEnd& end, const GapReach& reach)
	{
		return std::min(reach.radii * end.radius, reach.ofPiece * end.pieceDiagonal);
	}
	double reachOf(const LimbEnd& end) const
	{
		return std::max(reachOf(end, limits.usual), reachOf(end, limits.aligned));
	}

	/// Adds the limbs that face a tube.
	void lookAtTube(int tube, LimbReaches& reaches, std::set<FacingLimb>& facing)
	{
		Box3d box;
		for (const Point3d& p : tubes[size_t(tube)].path)
			box.Add(p);
		reaches.forEachReaching(box, [&](int i) {
			const LimbEnd& end = ends[size_t(i)];
			if (areApart(end, size_t(tube)) && isFree(end))
				if (const auto found = facingTube(i, tube))
					facing.insert(*found);
		});
	}

	std::optional<FacingLimb> facingTube(int i, int t) const
	{
		constexpr double ofTube = 1.2; // a tube must be nearer than an end by this factor
		const LimbEnd& end = ends[size_t(i)];
		const LimbTube& tube = tubes[size_t(t)];
		if (end.radius > limits.usual.wider * tube.radius)
			return std::nullopt;
		const double reach = reachOf(end);
		double best = -1, gap = 0;
		int ring = 0;
		const int rings = int(tube.path.size()), skipped = rings > 2 ? 1 : 0;
		for (int k = skipped; k + skipped < rings; ++k) {
			const Point3d apart = tube.path[size_t(k)] - end.centre;
			if (const double distance = apart.Norm();
				distance > 0 && distance <= reach && end.heading * apart > best * distance) {
				best = end.heading * apart / distance;
				gap = distance;
				ring = k;
			}
		}
		const auto isWithin = [&](const GapReach& limit) {
			return best >= limit.minCosine() && gap <= reachOf(end, limit);
		};
		if (!isWithin(limits.usual) && !isWithin(limits.aligned))
			return std::nullopt;
		return FacingLimb {ofTube * gap / best, i, t, ring};
	}
};

} // namespace detail

/**
 * Joins the two sides of gaps by tubes: two limbs that were cut through, or such a limb and a hole
 * in the side of a body that it faces. Only ends within a cone ahead are joined, see GapLimits, and
 * only where the tube crosses none of the given faces, except near its ends. Where a junction was
 * lost, a third limb is joined to the tube between two others that it faces. Nothing is joined to
 * slits and patches, see LimbEnd.
 *
 * @param points    get those of the tubes at their end.
 * @param triangles coherently oriented, parted by partSurface(); get the tubes at their end.
 * @param partner   as PartedSurface has it.
 * @param isSpeck   for each face whether its piece is to be dropped unless it is joined to others:
 *                  such a piece is joined only if both ends are cut through. Empty: none is.
 * @throws Cancelled.
 * Complexity: O(F log F + p log p) for p pairs of a limb with an end or a tube within its reach.
 */
inline BridgedGaps bridgeGaps(std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const std::vector<char>& isSpeck,
	const GapLimits& limits = GapLimits(), const Progress& progress = Progress())
{
	return detail::GapBridges(points, triangles, partner, isSpeck, limits, progress).run(progress);
}

} // namespace vcg::tri::mcf

#endif
