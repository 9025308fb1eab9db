// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the tips: branches are extended to the ends of the features they describe.

#ifndef VCG_MCF_REFINE_TIPS_H
#define VCG_MCF_REFINE_TIPS_H

#include "holding_balls.h"
#include "local_scale.h"
#include "refine_centre.h"
#include "known_clearances.h"

#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf::refining {

/// Where a tip may go.
struct TipRule
{
	/// Longest step, in diagonals.
	double spacing;
	/// Minimum gain of a step: (step + r' - r) / step, for the radii r before and r' after it.
	double minGain;
	/// Minimum radius after a step, in diagonals. Where the balls hardly shrink, half the radius of
	/// the given tip is enough: between long triangles a limb's local thickness is not known.
	double minRadius;
	/// Factor of both lengths; of the radius without its lower bound.
	const LocalScale& scale = sameEverywhere;
};

/// The unit direction in which a branch ends: from the node about one radius before the tip.
inline Point3d tipDirection(
	const CurveSkeleton& skeleton, const std::vector<std::vector<int>>& neighbours, int tip)
{
	const int from =
		nodeAlong(skeleton, neighbours, tip, neighbours[tip].front(), skeleton.radius[tip]);
	return (skeleton.position[tip] - skeleton.position[from]).Normalize();
}

/**
 * Extends each tip along its direction, in steps of at most a quarter of its radius, each recentred
 * sideways, as long as the steps gain reach, see TipRule. In a round end the ball shrinks as fast
 * as the tip advances, and the tip stays; in a tapered or pointed one it goes on to the smallest
 * radius. It never enters balls that are already there. In a limb it may go any distance, since the
 * flow stops early between long triangles, but turns by at most 30 degrees in three radii. Where
 * the shape is wide it goes no farther than three radii, and it ends where it turns to run along the
 * wall of a plate: a sheet would lead it around its rim. A tip outside stays.
 * @pre the radius of tips is their distance from the surface, that of others a lower bound of it.
 * @post the same. @throws Cancelled
 */
inline void extendTips(CurveSkeleton& skeleton, const ClosestSurface& surface, const TipRule& rule,
	const Progress& progress = Progress())
{
	constexpr double farthest = 3, farthestTurn = 30 * M_PI / 180, turnAtWall = 20 * M_PI / 180;
	constexpr double gainOfLimb = 0.5;    // a cone of 30 degrees; a corner of a box has 0.42
	constexpr double thinnestLimb = 1e-4; // diagonals; a cusp goes on to nothing
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const int count = int(neighbours.size());
	HoldingBalls balls(skeleton);
	for (int v = 0; v < count; ++v) {
		if (neighbours[v].size() != 1 || skeleton.radius[v] <= 0)
			continue;
		progress.check();
		Point3d direction = tipDirection(skeleton, neighbours, v);
		if (direction.SquaredNorm() == 0)
			continue;
		Point3d before = direction;
		double left = farthest * skeleton.radius[v], sinceThen = 0;
		int tip = v;
		double scale = rule.scale.at(skeleton.position[v], surface);
		while (left > 0) {
			if (skeleton.position.size() % nodesPerCheck == 0)
				progress.check();
			const Point3d x = skeleton.position[tip];
			const double r = skeleton.radius[tip];
			const double step = std::min(rule.spacing * scale, r / 4);
			Point3d y = x + direction * step;
			const ClosestSurface::Hit hit = surface.closest(y);
			if (hit.distance <= 0 || !surface.isInside(y, hit))
				break;
			const ClosestSurface::Ball ball = medialBall(surface, y, hit);
			const bool isInPlate =
				!isMedial(ball) || !widePlaces(surface, y, hit, ball.contact, direction).empty();
			const bool isAtWall =
				!isInPlate && isAlongWall(surface, y, hit, ball.contact, direction);
			const bool isWide = isInPlate || isAtWall;
			if (isMedial(ball))
				y = movedAside(y, ball, direction, step / 2);
			const double s = Distance(x, y);
			if (isAtWall && (y - x) * before < s * std::cos(turnAtWall))
				break;
			const double reached = std::max(surface.clearance(y), 0.0);
			const Point3d front = y + (y - x) * (reached / s);
			scale = rule.scale.atFace(hit.face);
			const double minimum = rule.minRadius * rule.scale.ofThicknessAtFace(hit.face);
			const double gain = (s + reached - r) / s;
			const bool isTooThin = reached < minimum
				&& (gain < gainOfLimb || reached < std::max(skeleton.radius[v] / 2, thinnestLimb));
			if (isTooThin || gain < rule.minGain || balls.deepest(front) >= 0
				|| !isSegmentInside(surface, x, r, y, reached))
				break;
			left -= isWide ? s : 0;
			const int next = int(skeleton.position.size());
			skeleton.position.push_back(y);
			skeleton.radius.push_back(reached);
			skeleton.edges.push_back({tip, next});
			balls.addNew();
			// The branch may bend, but slowly: each step has a weight of a quarter.
			direction = direction * 0.75 + (y - x) * (0.25 / s);
			direction /= direction.Norm();
			if (direction * before < std::cos(farthestTurn))
				break;
			sinceThen += s;
			if (!isWide && sinceThen > farthest * reached) {
				before = direction;
				sinceThen = 0;
			}
			tip = next;
		}
	}
	std::sort(skeleton.edges.begin(), skeleton.edges.end());
}

} // namespace vcg::tri::mcf::refining

#endif
