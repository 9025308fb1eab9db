// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief A skeleton as closed tubes, for printing and for programs that draw no lines.
 */

#ifndef VCG_MCF_SKELETON_TUBES_H
#define VCG_MCF_SKELETON_TUBES_H

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/mesh/surface_mesh.h>

#include <cmath>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// Tubes as one triangle mesh.
struct SkeletonTubes
{
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
	/// For each point the node of the skeleton that it lies around.
	std::vector<int> node;
	/// Number of closed tubes and balls.
	int pieces = 0;
};

namespace detail {

/// A circle of a tube: centre and two perpendicular radii, the second a quarter turn on.
struct TubeRing
{
	Point3d centre, first, second;
	int node;
};

/// A unit vector perpendicular to a unit vector.
inline Point3d anyPerpendicular(const Point3d& direction)
{
	int axis = 0;
	for (int k = 1; k < 3; ++k)
		if (std::abs(direction[k]) < std::abs(direction[axis]))
			axis = k;
	Point3d result(0, 0, 0);
	result[axis] = 1;
	result -= direction * direction[axis];
	return result.Normalize();
}

/// Adds rings, each joined to the last one; then an apex at each end, or the last to the first.
class TubeBuilder
{
public:
	/// @param ticker counts the points.
	TubeBuilder(SkeletonTubes& tubes, int sides, Ticker& ticker) :
			tubes(tubes), sides(sides), ticker(ticker)
	{
	}

	void ring(const TubeRing& ring)
	{
		for (int j = 0; j < sides; ++j) {
			const double angle = 2 * M_PI * j / sides;
			add(ring.centre + ring.first * std::cos(angle) + ring.second * std::sin(angle),
				ring.node);
		}
		if (rings++ > 0)
			join(last, int(tubes.points.size()) - sides);
		else
			first = int(tubes.points.size()) - sides;
		last = int(tubes.points.size()) - sides;
	}

	/// Joins the last ring to the first.
	void closeRing() { join(last, first); }

	/// @param rear the apex before the first ring; @param front the one after the last.
	void closeEnds(const Point3d& rear, const Point3d& front)
	{
		const int before = add(rear, tubes.node[size_t(first)]);
		const int after = add(front, tubes.node[size_t(last)]);
		for (int j = 0; j < sides; ++j) {
			const int next = (j + 1) % sides;
			tubes.triangles.push_back({before, first + next, first + j});
			tubes.triangles.push_back({after, last + j, last + next});
		}
	}

private:
	int add(const Point3d& point, int node)
	{
		tubes.points.push_back(point);
		tubes.node.push_back(node);
		ticker.tick();
		return int(tubes.points.size()) - 1;
	}

	void join(int back, int front)
	{
		for (int j = 0; j < sides; ++j) {
			const int next = (j + 1) % sides;
			tubes.triangles.push_back({back + j, back + next, front + next});
			tubes.triangles.push_back({back + j, front + next, front + j});
		}
	}

	SkeletonTubes& tubes;
	int sides;
	Ticker& ticker;
	int rings = 0, first = 0, last = 0;
};

/// The unit tangent at each point of a chain; where that turns back, the last segment's.
inline std::vector<Point3d> chainTangents(const std::vector<Point3d>& points, bool closed)
{
	const size_t n = points.size();
	std::vector<Point3d> segment, tangent(n);
	for (size_t i = 0; i < n; ++i)
		segment.push_back((points[(i + 1) % n] - points[i]).Normalize());
	for (size_t i = 0; i < n; ++i) {
		const Point3d& before = segment[i > 0 ? i - 1 : closed ? n - 1 : 0];
		const Point3d& after = segment[i + 1 < n || closed ? i : n - 2];
		const Point3d sum = before + after;
		tangent[i] = sum.Norm() > 1e-6 ? Point3d(sum / sum.Norm()) : before;
	}
	return tangent;
}

/// First radii (unit) along a chain, without twist; a closed chain's total twist is spread evenly.
inline std::vector<Point3d> chainNormals(const std::vector<Point3d>& tangent, bool closed)
{
	const auto carried = [](const Point3d& normal, const Point3d& along) {
		const Point3d flat = normal - along * (normal * along);
		return flat.Norm() > 1e-6 ? Point3d(flat / flat.Norm()) : anyPerpendicular(along);
	};
	std::vector<Point3d> normal {anyPerpendicular(tangent.front())};
	for (size_t i = 1; i < tangent.size(); ++i)
		normal.push_back(carried(normal.back(), tangent[i]));
	if (closed) {
		const Point3d back = carried(normal.back(), tangent.front());
		const double twist =
			std::atan2((back ^ normal.front()) * tangent.front(), back * normal.front());
		for (size_t i = 1; i < normal.size(); ++i) {
			const double angle = twist * double(i) / double(normal.size());
			normal[i] = normal[i] * std::cos(angle) + (tangent[i] ^ normal[i]) * std::sin(angle);
		}
	}
	return normal;
}

/// What a tube is made around: the nodes of a branch without those that coincide with the one
/// before, or a single node.
struct TubeChain
{
	std::vector<int> nodes;
	std::vector<Point3d> points;
	bool isClosed = false;
};

inline TubeChain tubeChain(const CurveSkeleton& skeleton, const std::vector<int>& branch)
{
	TubeChain chain;
	chain.isClosed = branch.size() > 3 && branch.front() == branch.back();
	const size_t count = branch.size() - (chain.isClosed ? 1 : 0);
	for (size_t i = 0; i < count; ++i) {
		const Point3d& p = skeleton.position[size_t(branch[i])];
		if (!chain.points.empty() && !((p - chain.points.back()).Norm() > 0))
			continue; // no direction from here to there
		chain.nodes.push_back(branch[i]);
		chain.points.push_back(p);
	}
	while (chain.isClosed && chain.points.size() > 1
		&& !((chain.points.back() - chain.points.front()).Norm() > 0)) {
		chain.points.pop_back();
		chain.nodes.pop_back();
	}
	chain.isClosed = chain.isClosed && chain.points.size() >= 3;
	return chain;
}

/// Rings from the middle of a tube's round end to its pole, which is not counted.
inline int ringsOfQuarter(int sides)
{
	return sides / 4 + (sides % 4 > 0);
}

/// How many points the tubes have; in doubles, since there may be more than an int holds.
inline double countTubePoints(const std::vector<TubeChain>& chains, int sides)
{
	double count = 0;
	for (const TubeChain& chain : chains) {
		const int ends = chain.isClosed ? 0 : 2;
		count += (double(chain.nodes.size()) + ends * (ringsOfQuarter(sides) - 1.0)) * sides + ends;
	}
	return count;
}

} // namespace detail

/**
 * A tube around each branch, with round ends, and a ball around each node without edges. Each is a
 * closed two-manifold, oriented outwards; at junctions they overlap, which programs for printing
 * accept. Where a curve bends within its own radius a tube passes through itself.
 * @param radius one for each node, mesh units, above 0.
 * @param sides  of a tube's section, at least 3.
 * Complexity: O(N * sides + pieces * sides^2).
 * @throws InvalidParameter: too few sides, or so many that there would be more than 10 million
 *         points; InvalidInput: a radius that is missing or not above 0; Cancelled.
 */
inline SkeletonTubes skeletonTubes(const CurveSkeleton& skeleton, const std::vector<double>& radius,
	int sides = 12, const Progress& progress = Progress())
{
	using namespace detail;
	constexpr double maxPoints = 1e7;
	requireParameter(sides >= 3, "sides", "at least 3");
	if (radius.size() != skeleton.position.size())
		throw InvalidInput("Tubes need a radius for each node.");
	for (size_t v = 0; v < radius.size(); ++v)
		if (!(radius[v] > 0) || !std::isfinite(radius[v]))
			throw InvalidInput(
				"Tubes need a radius above 0; that of node " + std::to_string(v) + " is not.");
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	std::vector<TubeChain> chains;
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].empty())
			chains.push_back(tubeChain(skeleton, {int(v)}));
	for (const Branch& branch : skeletonBranches(skeleton))
		chains.push_back(tubeChain(skeleton, branch.nodes));
	const double count = countTubePoints(chains, sides);
	if (count > maxPoints)
		throw InvalidParameter("Tubes of " + std::to_string(sides) + " sides would have "
			+ std::to_string(std::llround(count)) + " points, more than "
			+ std::to_string(std::llround(maxPoints))
			+ ": choose fewer sides, or a skeleton with fewer nodes.");

	SkeletonTubes tubes;
	Ticker ticker(progress, "Making tubes", count);
	const int quarter = ringsOfQuarter(sides);
	// A chain with round ends; a ball for a single node.
	const auto addOpen = [&](const std::vector<int>& nodes, const std::vector<Point3d>& points,
							 const std::vector<Point3d>& tangent) {
		const std::vector<Point3d> normal = chainNormals(tangent, false);
		TubeBuilder tube(tubes, sides, ticker);
		const auto ring = [&](size_t i, double latitude) {
			const double r = radius[size_t(nodes[i])];
			const Point3d first = normal[i] * (r * std::cos(latitude));
			tube.ring({points[i] + tangent[i] * (r * std::sin(latitude)), first, tangent[i] ^ first,
				nodes[i]});
		};
		const auto pole = [&](size_t i, double sign) {
			return Point3d(points[i] + tangent[i] * (sign * radius[size_t(nodes[i])]));
		};
		for (int k = quarter - 1; k > 0; --k)
			ring(0, -M_PI / 2 * k / quarter);
		for (size_t i = 0; i < nodes.size(); ++i)
			ring(i, 0);
		for (int k = 1; k < quarter; ++k)
			ring(nodes.size() - 1, M_PI / 2 * k / quarter);
		tube.closeEnds(pole(0, -1), pole(nodes.size() - 1, 1));
	};
	const auto addClosed = [&](const std::vector<int>& nodes, const std::vector<Point3d>& points) {
		const std::vector<Point3d> tangent = chainTangents(points, true);
		const std::vector<Point3d> normal = chainNormals(tangent, true);
		TubeBuilder tube(tubes, sides, ticker);
		for (size_t i = 0; i < nodes.size(); ++i) {
			const Point3d first = normal[i] * radius[size_t(nodes[i])];
			tube.ring({points[i], first, tangent[i] ^ first, nodes[i]});
		}
		tube.closeRing();
	};

	for (const TubeChain& chain : chains) {
		if (chain.isClosed)
			addClosed(chain.nodes, chain.points);
		else
			addOpen(chain.nodes, chain.points,
				chain.points.size() > 1 ? chainTangents(chain.points, false)
										: std::vector<Point3d> {Point3d(0, 0, 1)});
		++tubes.pieces;
	}
	return tubes;
}

} // namespace vcg::tri::mcf

#endif
