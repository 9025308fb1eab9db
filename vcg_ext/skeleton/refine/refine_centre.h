// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the geometry: centres nodes in their maximal balls, smooths branches.

#ifndef VCG_MCF_REFINE_CENTRE_H
#define VCG_MCF_REFINE_CENTRE_H

#include "local_scale.h"
#include "known_clearances.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/spatial/closest_surface.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <vector>

namespace vcg::tri::mcf::refining {

/// A node's closest point, the maximal ball that touches there, and where the node should be.
struct Contact
{
	ClosestSurface::Hit hit;
	ClosestSurface::Ball ball;
	Point3d target;
};

/// The tolerance of a maximal ball, in distances of its node from the surface: points of the
/// surface that are less deep in the ball do not hold it.
constexpr double contactTolerance = 0.02;

/// A maximal ball whose contacts are near each other is held by the surface's curvature or its
/// noise, not by the other side: it says nothing about the middle of the shape. The weight of a
/// ball rises from the first of these angles between its contacts to the second.
constexpr double minSpokeAngle = 20 * M_PI / 180, fullSpokeAngle = 50 * M_PI / 180;

/// Whether a ball's contacts are far enough apart, see minSpokeAngle.
inline bool isMedial(const ClosestSurface::Ball& ball)
{
	return ball.spokeAngle >= minSpokeAngle;
}

/// Searches the whole surface for the ball at a node. @pre node is inside, and hit its closest
/// point.
inline ClosestSurface::Ball medialBall(const ClosestSurface& surface, const Point3d& node,
	const ClosestSurface::Hit& hit, int near = -1)
{
	return surface.maximalBall(node, hit, contactTolerance * hit.distance, near);
}

/// The unit tangent of the branch at a node; zero at a junction. @pre the node has neighbours.
inline Point3d tangentAt(const CurveSkeleton& skeleton, const std::vector<int>& neighbours, int v)
{
	if (neighbours.size() > 2)
		return Point3d(0, 0, 0);
	const Point3d& back = skeleton.position[neighbours.front()];
	const Point3d& front =
		neighbours.size() == 1 ? skeleton.position[v] : skeleton.position[neighbours.back()];
	Point3d t = front - back;
	const double length = t.Norm();
	return length > 0 ? t / length : Point3d(0, 0, 0);
}

/// The unit tangent of a branch at an inner node: of the chord between the first nodes at least
/// `length` away on both sides, or the ends of the branch. Complexity: linear in the nodes between.
inline Point3d tangentOver(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, int v, double length)
{
	const auto end = [&](int to) {
		return skeleton.position[nodeAlong(skeleton, neighbours, v, to, length)];
	};
	return (end(neighbours[v][1]) - end(neighbours[v][0])).Normalize();
}

/// The gradient of the distance from the surface within the medial axis: half the sum of the unit
/// vectors from the two contacts of a ball to its centre.
inline Point3d medialSlope(const Point3d& contact, const ClosestSurface::Ball& ball)
{
	return (ball.centre * 2 - contact - ball.contact) / (2 * ball.radius);
}

/// The point moved at right angles to a direction towards a ball's centre, by at most `maximum`.
inline Point3d movedAside(const Point3d& point, const ClosestSurface::Ball& ball,
	const Point3d& direction, double maximum)
{
	Point3d aside = ball.centre - point;
	aside -= direction * (direction * aside);
	const double length = aside.Norm();
	return point + (length > maximum ? aside * (maximum / length) : aside);
}

/**
 * Moves a ball's centre within the medial axis and across the branch towards where the ball grows,
 * the middle of a cross-section that is not round. Stays where the ball would not grow.
 */
inline void ascendAside(Contact& contact, const Point3d& tangent, const ClosestSurface& surface)
{
	constexpr int maxSteps = 3;
	constexpr double pace = 0.3, flattest = 150 * M_PI / 180;
	Contact here = contact;
	for (int i = 0; i < maxSteps; ++i) {
		const ClosestSurface::Ball& ball = here.ball;
		if (!isMedial(ball) || ball.spokeAngle > flattest)
			return;
		Point3d slope = medialSlope(here.hit.point, ball);
		slope -= tangent * (tangent * slope);
		const Point3d aside = ball.centre + slope * (pace * ball.radius);
		const ClosestSurface::Hit first = surface.closestFrom(aside, here.hit.face);
		if (first.distance <= ball.radius) // and what is closest is closer still
			return;
		here.hit = surface.closest(aside, first);
		if (here.hit.distance <= ball.radius || !surface.isInside(aside, here.hit))
			return;
		contact.target = aside;
		here.ball = medialBall(surface, aside, here.hit, ball.face);
	}
}

/**
 * Finds each node's contact and measures its distance from the surface; 0 outside.
 * A node that is outside has no ball.
 * @param ascend  whether the centres go to the middle of the cross-section: see ascendAside().
 * @throws Cancelled
 */
inline std::vector<Contact> findContacts(CurveSkeleton& skeleton, const ClosestSurface& surface,
	bool ascend, const Progress& progress = Progress())
{
	std::vector<Contact> contacts(skeleton.position.size());
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	forEachBlock(int(contacts.size()), progress, "Refining the skeleton", [&](int begin, int end) {
		// Consecutive nodes are mostly neighbours on a branch, with nearly the same contacts.
		int near = -1, nearOpposite = -1;
		for (int v = begin; v < end; ++v) {
			const Point3d& x = skeleton.position[v];
			Contact& contact = contacts[v];
			contact.hit = near < 0 ? surface.closest(x) : surface.closest(x, near);
			contact.ball = {x, 0, -1, 0, x};
			contact.target = x;
			near = contact.hit.face;
			const bool inside = contact.hit.distance > 0 && surface.isInside(x, contact.hit);
			skeleton.radius[v] = inside ? contact.hit.distance : 0;
			if (!inside)
				continue;
			contact.ball = medialBall(surface, x, contact.hit, nearOpposite);
			contact.target = contact.ball.centre;
			nearOpposite = contact.ball.face;
			if (ascend && !neighbours[v].empty())
				ascendAside(contact, tangentAt(skeleton, neighbours[v], v), surface);
		}
	});
	return contacts;
}

/// Tracks the contacts of nodes that have moved a little; radius is unchanged. @throws Cancelled
inline void followContacts(std::vector<Contact>& contacts, const CurveSkeleton& skeleton,
	const ClosestSurface& surface, const Progress& progress = Progress())
{
	for (size_t v = 0; v < contacts.size(); ++v) {
		if (v % nodesPerCheck == 0)
			progress.check();
		Contact& contact = contacts[v];
		if (contact.ball.face < 0)
			continue;
		const Point3d& x = skeleton.position[v];
		const ClosestSurface::Hit hit = surface.closestFrom(x, contact.hit.face);
		if (hit.distance <= 0)
			continue;
		contact.hit = hit;
		contact.ball = surface.maximalBallFrom(x, hit, contact.ball);
		contact.target = contact.ball.centre;
	}
}

/**
 * Weight of the centring term per node. Inside the maximal ball of a junction the medial axis of
 * the body dominates, so weights rise with the protrusion of a node's ball from it: from `minimum`
 * to 1, which they reach at `whole` radii of the junction's ball, or where the node's own ball is
 * outside that ball, as in a thin twig on a thick body.
 *
 * The thinner the twig, the less the body says about its axis: facets of the body stick out of the
 * junction's ball, too, and draw the curve aside. Weights of a twig that is `thin` rise with the
 * protrusion to the power of up to 2, from as little as `minimumOfThin`.
 * @param distance  of each node from the surface.
 */
inline std::vector<double> sharesOfCentring(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, const std::vector<double>& distance)
{
	constexpr double minimum = 0.02, minimumOfThin = 2e-4, whole = 0.35;
	constexpr double thin = 0.15; // radii of the junction's ball
	std::vector<double> share(skeleton.position.size(), 1);
	for (Branch branch : skeletonBranches(skeleton))
		for (int side = 0; side < 2; ++side) {
			std::reverse(branch.nodes.begin(), branch.nodes.end());
			const int end = branch.first();
			if (neighbours[end].size() < 3 || distance[end] <= 0)
				continue;
			const auto out = [&](int v) {
				return Distance(skeleton.position[v], skeleton.position[end]) + distance[v]
					- distance[end];
			};
			const auto left = std::find_if(branch.nodes.begin(), branch.nodes.end(),
				[&](int v) { return v != end && out(v) >= 2 * distance[v]; });
			const double thickness =
				left == branch.nodes.end() ? 1 : distance[*left] / distance[end];
			const double ofThin = 1 - std::min(thickness / thin, 1.0);
			const double lowest = std::pow(minimum, 1 - ofThin) * std::pow(minimumOfThin, ofThin);
			for (int v : branch.nodes) {
				if (v == end)
					continue;
				const double full = std::min(whole * distance[end], 2 * distance[v]);
				const double part = std::clamp(out(v) / full, 0.0, 1.0);
				share[v] = std::min(share[v], std::max(std::pow(part, 1 + ofThin), lowest));
			}
		}
	return share;
}

/**
 * Moves nodes back to where they were, until no edge that was inside has left the surface: both
 * nodes of one that has. Edges are tested in ascending order, round after round, but only those
 * that may have changed.
 * @throws Cancelled
 * Complexity: O(E log E), a test of each edge, and one of each edge of a node that goes back.
 */
inline void keepEdgesInside(CurveSkeleton& skeleton, const CurveSkeleton& before,
	const ClosestSurface& surface, const Progress& progress = Progress())
{
	std::vector<std::vector<int>> edgesOf(skeleton.position.size());
	std::set<int> round, nextRound;
	for (int e = 0; e < int(skeleton.edges.size()); ++e) {
		round.insert(round.end(), e);
		for (int v : skeleton.edges[e])
			edgesOf[v].push_back(e);
	}
	std::vector<char> back(skeleton.position.size(), 0);
	size_t tested = 0;
	for (; !round.empty(); round.swap(nextRound))
		while (!round.empty()) {
			if (tested++ % nodesPerCheck == 0)
				progress.check();
			const int edge = *round.begin();
			round.erase(round.begin());
			const auto [a, b] = skeleton.edges[edge];
			if ((back[a] && back[b]) || isEdgeInside(skeleton, surface, a, b))
				continue;
			for (int v : {a, b})
				if (!back[v]) {
					back[v] = 1;
					skeleton.position[v] = before.position[v];
					skeleton.radius[v] = before.radius[v];
					for (int e : edgesOf[v])
						(e > edge ? round : nextRound).insert(e);
				}
		}
}

/**
 * The weights of the points x_{k-1}, x_k, x_{k+1} in d_k, see centre(), which is x_{k-1} - 2 x_k +
 * x_{k+1} where both lengths are equal. A length counts as at least a tenth of their mean, which
 * keeps the system well conditioned where the scale jumps.
 */
inline std::array<double, 3> secondDifference(double before, double after)
{
	constexpr double shortest = 0.1;
	const double mean = (before + after) / 2;
	if (!(mean > 0))
		return {0, 0, 0};
	const double a = mean / std::max(before, shortest * mean);
	const double b = mean / std::max(after, shortest * mean);
	return {a, -(a + b), b};
}

/**
 * One round: solves
 *     min  sum_i w_i |x_i - c_i|^2 + kappa sum_k (r_k / R)^2 |d_k|^2,
 *     d_k = (a + b) / 2 ((x_{k+1} - x_k) / b - (x_k - x_{k-1}) / a),
 * over the inner nodes k of the branches, so that curves may meet at any angle in a junction. a and
 * b are the lengths that the local scale asks for before and after node k, up to a common factor:
 * where the edges have these lengths, d_k is 0 on a straight branch, and nodes that are closer
 * together where the shape is thin stay so. c_i is the centre of the maximal ball at node i,
 * projected on the normal plane of the branch at the node, so that nodes keep their spacing. If the
 * centre lies far ahead, the tangent is that of a longer piece of the branch, see tangentOver(). w_i
 * is smaller where the contacts of the ball are near each other and in the ball of a junction, see
 * sharesOfCentring(), and large at tips: the curve must not shrink. It also falls where the centre
 * lies ahead of or behind the node by more than half the distance from the surface, as on the way
 * from a limb into a round body, where the centre says little about the way.
 *
 * No node moves by more than half its distance from the surface or a quarter of that of a neighbour
 * (without the latter, a node that touches the surface at a concave corner could not move). No edge
 * leaves the surface: the nodes of one that would are moved back.
 * @param kappa for nodes at the skeleton's own spacing whose distance r_k from the surface is R.
 * @param scale where it is smaller than 1, so are that spacing and R.
 * @pre radius holds distances from the surface, or lower bounds. @post lower bounds.
 * @throws SolverError, Cancelled
 */
inline void centre(CurveSkeleton& skeleton, const std::vector<Contact>& contacts,
	const ClosestSurface& surface, double kappa, const LocalScale& scale = sameEverywhere,
	const Progress& progress = Progress())
{
	constexpr double tipWeight = 1e3, weightWithoutBall = 1e-6;
	constexpr double referenceRadius = 0.033, thinnest = 0.03, thickest = 3;
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const int n = int(skeleton.position.size());
	std::vector<Eigen::Triplet<double>> entries;
	Eigen::MatrixX3d right(n, 3);
	std::vector<double> distance(n), local(n);
	for (int v = 0; v < n; ++v) {
		distance[v] = contacts[v].hit.distance;
		local[v] = scale.atFace(contacts[v].hit.face);
	}
	const std::vector<double> share = sharesOfCentring(skeleton, neighbours, distance);
	for (int v = 0; v < n; ++v) {
		const Point3d& x = skeleton.position[v];
		const size_t degree = neighbours[v].size();
		Point3d target = x;
		double weight = weightWithoutBall;
		if (skeleton.radius[v] > 0 && isMedial(contacts[v].ball)) {
			weight = std::clamp(
				(contacts[v].ball.spokeAngle - minSpokeAngle) / (fullSpokeAngle - minSpokeAngle),
				weightWithoutBall, 1.0);
			target = contacts[v].target;
			if (degree == 1 || degree == 2) {
				Point3d tangent = tangentAt(skeleton, neighbours[v], v);
				// The farther ahead the centre, the more an error of the tangent moves its projection.
				if (degree == 2)
					tangent =
						tangentOver(skeleton, neighbours, v, std::abs(tangent * (target - x)));
				const double along = tangent * (target - x);
				target -= tangent * along;
				if (std::abs(along) > distance[v] / 2)
					weight *= std::pow(distance[v] / (2 * along), 2);
			}
		}
		weight = degree == 1 ? tipWeight : weight * share[v];
		entries.emplace_back(v, v, weight);
		for (int k = 0; k < 3; ++k)
			right(v, k) = weight * target[k];
		if (degree != 2)
			continue;
		// Stiffness grows with the local thickness: within a large ball, small bends mean nothing.
		// Outside the balls of junctions it is bounded: the bend may be that of an end in a corner.
		const double reference = referenceRadius * local[v];
		const double relative = std::clamp(distance[v] / reference, thinnest,
			share[v] < 1 ? std::numeric_limits<double>::infinity() : thickest);
		const double stiffness = kappa * relative * relative;
		const int stencil[3] = {neighbours[v][0], v, neighbours[v][1]};
		const std::array<double, 3> second =
			secondDifference(local[stencil[0]] + local[v], local[v] + local[stencil[2]]);
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 3; ++j)
				entries.emplace_back(stencil[i], stencil[j], stiffness * second[i] * second[j]);
	}
	Eigen::SparseMatrix<double> matrix(n, n);
	matrix.setFromTriplets(entries.begin(), entries.end());
	const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
	if (factor.info() != Eigen::Success)
		throw SolverError("Refining the skeleton: the linear system could not be factorised.");
	const Eigen::MatrixX3d solution = factor.solve(right);

	if (!solution.allFinite())
		throw SolverError("Refining the skeleton: the linear system has no finite solution.");

	const CurveSkeleton before = skeleton;
	for (int v = 0; v < n; ++v) {
		const Point3d x(solution(v, 0), solution(v, 1), solution(v, 2));
		const Point3d move = x - before.position[v];
		double maximum = before.radius[v] / 2;
		for (int w : neighbours[v])
			maximum = std::max(maximum, before.radius[w] / 4);
		const double norm = move.Norm(), length = std::min(norm, maximum);
		if (length > 0)
			skeleton.position[v] = before.position[v] + move * (length / norm);
		// The distance from the surface cannot fall faster than the node moves.
		skeleton.radius[v] = before.radius[v] - length;
		if (skeleton.radius[v] <= 0)
			skeleton.radius[v] = std::max(surface.clearance(skeleton.position[v]), 0.0);
	}
	keepEdgesInside(skeleton, before, surface, progress);
}

/// A point inside and its distance from the surface; negative: there is none.
struct InnerPlace
{
	Point3d position;
	double clearance = -1;
};

/**
 * The centre of the maximal ball that touches the surface from inside where it is closest to a
 * point outside. It is taken only if it is inside, its ball is empty and the way there from the
 * contact does not leave the surface: the ball may have been found behind a wall thinner than its
 * tolerance. Else the search is repeated with smaller tolerances.
 */
inline InnerPlace placeInside(
	const ClosestSurface& surface, const Point3d& outside, const ClosestSurface::Hit& hit)
{
	// Diagonals: how far below the surface the search starts, and the tolerance of the ball.
	constexpr double below = 1e-4, roughness = 1e-3;
	constexpr double finer = 0.25, finest = 1e-4;
	const Point3d inward = (hit.point - outside) / hit.distance;
	for (double scale = 1; scale > finest; scale *= finer) {
		const Point3d start = hit.point + inward * (below * scale);
		const ClosestSurface::Hit contact = surface.closest(start);
		if (contact.distance <= 0 || !surface.isInside(start, contact))
			continue;
		const double tolerance = roughness * scale;
		const ClosestSurface::Ball ball = surface.maximalBall(start, contact, tolerance, -1);
		const double clearance = surface.clearance(ball.centre);
		if (ball.face >= 0 && clearance > 0 && clearance >= ball.radius - tolerance
			&& isSegmentInside(surface, start, contact.distance, ball.centre, clearance))
			return {ball.centre, clearance};
	}
	return {outside, -1};
}

/**
 * Moves nodes that are outside into the maximal ball that touches the closest surface point from
 * inside; where there is none they stay, with radius 0. @throws Cancelled
 */
inline void moveInside(
	CurveSkeleton& skeleton, const ClosestSurface& surface, const Progress& progress = Progress())
{
	for (size_t v = 0; v < skeleton.position.size(); ++v) {
		if (v % nodesPerCheck == 0)
			progress.check();
		if (skeleton.radius[v] > 0)
			continue;
		const ClosestSurface::Hit hit = surface.closest(skeleton.position[v]);
		if (hit.distance <= 0)
			continue;
		if (surface.isInside(skeleton.position[v], hit, progress)) { // only its bound was too low
			skeleton.radius[v] = hit.distance;
			continue;
		}
		const InnerPlace inside = placeInside(surface, skeleton.position[v], hit);
		if (inside.clearance > 0) {
			skeleton.position[v] = inside.position;
			skeleton.radius[v] = inside.clearance;
		}
	}
}

/// The point 1.5 radii beside a point x of a branch, if the surface is still more than half a radius
/// away there. @param way  to that side, of any length above 0.
inline std::optional<Point3d> widePlace(
	const ClosestSurface& surface, const Point3d& x, double radius, const Point3d& way)
{
	constexpr double aside = 1.5, away = 0.5;
	const Point3d place = x + way * (aside * radius / way.Norm());
	if (surface.clearance(place) > away * radius)
		return place;
	return std::nullopt;
}

/**
 * The places beside a point x of a branch, none to two, where the shape is wide, see widePlace().
 * There are none in a limb, two in a plate, one along its rim.
 * @param contact    the second contact of the ball, see medialBall().
 * @param direction  of the branch.
 */
inline std::vector<Point3d> widePlaces(const ClosestSurface& surface, const Point3d& x,
	const ClosestSurface::Hit& hit, const Point3d& contact, const Point3d& direction)
{
	const Point3d side = (hit.point - contact) ^ direction;
	if (!(side.Norm() > 0))
		return {};
	std::vector<Point3d> places;
	for (const Point3d& way : {side, -side})
		if (const std::optional<Point3d> place = widePlace(surface, x, hit.distance, way))
			places.push_back(*place);
	return places;
}

/// Whether a branch runs along the wall of a plate: the ball touches the wall and one of the plate's
/// two faces, so that widePlaces() finds none, but opposite to one contact the shape is wide.
inline bool isAlongWall(const ClosestSurface& surface, const Point3d& x,
	const ClosestSurface::Hit& hit, const Point3d& contact, const Point3d& direction)
{
	for (const Point3d& touched : {hit.point, contact}) {
		const Point3d from = x - touched, beside = from - direction * (from * direction);
		if (beside.Norm() > 0 && widePlace(surface, x, hit.distance, beside))
			return true;
	}
	return false;
}

} // namespace vcg::tri::mcf::refining

#endif
