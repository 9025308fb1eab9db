// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Medial poles by maximal balls that touch the surface from inside (Ma, Bae and Choi, "3D
/// medial axis point approximation using nearest neighbors and the normal field", The Visual
/// Computer 28, 2012).

#ifndef VCG_MCF_SHRINKING_BALLS_H
#define VCG_MCF_SHRINKING_BALLS_H

#include "pole_set.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/unit_frame.h>
#include <skeleton/spatial/inner_segments.h>
#include <skeleton/spatial/maximal_ball.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/spatial/solid_test.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * Cache of empty balls that a search has certified. A ball that nearly equals one of them needs no
 * search.
 *
 * The distance to the nearest sample is 1-Lipschitz: at a distance d from the centre of a certified
 * ball no sample is nearer than the ball's reach less d. Without the cache all samples of a sphere
 * would be visited for each of them, and those of a tube's ring again and again, since all of them
 * touch the same ball.
 */
class KnownBalls
{
public:
	/// How much deeper a sample may be in a ball that was not searched, as a part of its radius.
	static constexpr double negligible = 0.003;

	void add(const MaximalBall& ball)
	{
		balls[added % balls.size()] = {ball.centre(), ball.reach()};
		++added;
	}

	bool hold(const MaximalBall& ball) const
	{
		for (size_t i = 0; i < std::min(added, balls.size()); ++i) {
			const double room = negligible * ball.radius() - ball.reach() + balls[i].reach;
			if (room >= 0 && SquaredDistance(ball.centre(), balls[i].centre) <= room * room)
				return true;
		}
		return false;
	}

private:
	struct Known
	{
		Point3d centre;
		double reach;
	};

	std::array<Known, 16> balls;
	size_t added = 0;
};

/// A point at which a maximal ball is wanted, in the unit frame that the tree's points are in.
struct Touch
{
	Point3d point;
	Point3d normal; ///< outward, unit length; zero: no ball
	double delta;   ///< how deep a sample may lie inside the ball
	int place;      ///< in the results
	int slot;       ///< of the point itself in the tree, -1 if it is not a sample
};

/// The tolerance where none is asked for, in the unit frame: coincident samples, and the steps of
/// rounding in flat regions, do not count as contacts.
inline double minTolerance(const UnitFrame& frame)
{
	constexpr double minimum = 1e-9; // of the diagonal
	return minimum * frame.diagonal();
}

inline double ballTolerance(const UnitFrame& frame, double delta)
{
	return std::max(frame.lengthIn(delta), minTolerance(frame));
}

/**
 * Maximal balls at `touches`; fastest where consecutive ones are near each other.
 * @param count      number of results.
 * @param isPole     (place, centre, radius, depth; mesh units): whether the ball, in which samples
 *                   may lie as deep as `depth`, counts. One that does not is searched again without
 *                   tolerance.
 * @param isThinner  (place, normal, tolerance in mesh units): whether it is certain that no ball
 *                   with this tolerance counts. Asked only after a ball that did not count: such
 *                   searches take long, since walls thinner than the tolerance do not bound a ball.
 * @return poles in mesh units, each at the place of its touch.
 */
template <class IsPole, class IsThinner>
PoleSet maximalBalls(const std::vector<Touch>& touches, size_t count, const UnitFrame& frame,
	const PointTree& tree, const Progress& progress, const IsPole& isPole,
	const IsThinner& isThinner)
{
	constexpr int neighbours = 8;
	PoleSet poles;
	const char* const what = "Poles: shrinking balls";
	fillArray(poles.centre, count, Point3d(0, 0, 0), progress);
	fillArray(poles.radius, count, -1.0, progress);
	const int size = int(touches.size());
	forEachBlock(size, progress, what, [&](int begin, int end) {
		// The contacts of the last balls nearly bound the next one.
		std::array<int, 4> recent = {-1, -1, -1, -1};
		int oldest = 0;
		KnownBalls known;
		bool isDoubtful = false; // the last ball with a tolerance did not count
		for (int i = begin; i < end; ++i) {
			const Touch& touch = touches[i];
			if (!(touch.normal.SquaredNorm() > 0))
				continue;
			const auto findPole = [&](double delta) {
				MaximalBall ball(touch.point, touch.normal, delta, frame.diagonal());
				for (int slot : recent)
					if (slot >= 0)
						ball.visit(slot, tree.point(slot));
				if (touch.slot >= 0) // neighbours on the surface nearly bound it, too
					for (int j = std::max(i - neighbours, 0);
						 j <= std::min(i + neighbours, size - 1); ++j)
						ball.visit(touches[j].slot, touches[j].point);
				if (ball.contact() < 0 || !known.hold(ball)) {
					tree.search(ball);
					if (ball.contact() < 0)
						return false;
					known.add(ball);
				}
				recent[oldest] = ball.contact();
				oldest = (oldest + 1) % int(recent.size());
				// Between parallel walls a ball is too large by half of its tolerance.
				const double unitRadius = ball.radius() - delta / 2;
				poles.centre[touch.place] = frame.out(touch.point - touch.normal * unitRadius);
				const double radius = frame.lengthOut(unitRadius);
				const double depth = frame.lengthOut(delta) + KnownBalls::negligible * radius;
				if (!isPole(touch.place, poles.centre[touch.place], radius, depth))
					return false;
				poles.radius[touch.place] = radius;
				return true;
			};
			const double minimum = minTolerance(frame);
			isDoubtful = isDoubtful && touch.delta > minimum
				&& isThinner(touch.place, touch.normal, frame.lengthOut(touch.delta));
			isDoubtful = isDoubtful || !findPole(touch.delta);
			if (isDoubtful && touch.delta > minimum)
				findPole(minimum);
		}
	});
	return poles;
}

/// See osculatingNormals().
struct OsculatingNormals
{
	std::vector<Point3d> normal; ///< unit length, or zero
	/// 1 where the reversed normal clearly points behind all triangles of the vertex.
	std::vector<char> leadsInside;
};

/**
 * Unit normals of the vertices, exact where a vertex and its neighbours lie on a sphere: cross
 * products over the squared lengths of both edges (Max, "Weights for computing vertex normals from
 * facet normals", Journal of Graphics Tools 4(2), 1999); zero where they are not defined.
 * A tilt by t makes the ball against a neighbour at distance h on a surface of curvature k smaller
 * by a factor of 1 + 2 t / (h k): on a fine mesh the tilt of area-weighted normals costs a fifth.
 * Computed triangle by triangle: in a walk around a vertex each step waits for the one before.
 * @pre mesh is compact. @throws Cancelled
 */
inline OsculatingNormals osculatingNormals(const SurfaceMesh& mesh, const Progress& progress)
{
	constexpr double byFar = 1e-3; // cosine; rounding and the ball's own error are far below
	const char* const what = "Measuring the surface";
	OsculatingNormals found;
	const size_t vertices = size_t(mesh.vertexSlots());
	fillArray(found.normal, vertices, Point3d(0, 0, 0), progress);
	fillArray(found.leadsInside, vertices, char(1), progress);
	reportedLoop(mesh.faceSlots(), progress.part(0, 0.4), what, [&](int f) {
		const Triangle t = mesh.triangle(f);
		const Point3d doubleAreaVector = mesh.doubleAreaVector(f);
		std::array<double, 3> squared; // length of the edge that starts at a corner
		for (int k = 0; k < 3; ++k)
			squared[k] = SquaredDistance(mesh.position[t[k]], mesh.position[t[(k + 1) % 3]]);
		for (int k = 0; k < 3; ++k) {
			const double one = squared[k], other = squared[(k + 2) % 3];
			if (one > 0 && other > 0)
				found.normal[t[k]] += doubleAreaVector / one / other;
		}
	});
	reportedLoop(mesh.vertexSlots(), progress.part(0.4, 0.5), what, [&](int v) {
		const double length = found.normal[v].Norm();
		const bool isDefined = length > 0 && std::isfinite(length);
		found.normal[v] = isDefined ? Point3d(found.normal[v] / length) : Point3d(0, 0, 0);
	});
	reportedLoop(mesh.faceSlots(), progress.part(0.5, 1), what, [&](int f) {
		const Point3d doubleAreaVector = mesh.doubleAreaVector(f);
		const double minimum = byFar * byFar * doubleAreaVector.SquaredNorm();
		for (int v : mesh.triangle(f)) {
			const double along = doubleAreaVector * found.normal[v];
			found.leadsInside[v] &= (along > 0) & (along * along > minimum);
		}
	});
	return found;
}

/**
 * 1 for the vertices of slivers, see SurfaceMesh::isSliver(), whose normals do not tell on which
 * side the inside is. Empty if there are none.
 * @throws Cancelled
 */
inline std::vector<char> cornersOfSlivers(
	const SurfaceMesh& mesh, const UnitFrame& frame, const Progress& progress)
{
	const double diagonal = frame.lengthOut(frame.diagonal());
	std::vector<char> isCorner;
	reportedLoop(mesh.faceSlots(), progress, "Measuring the surface", [&](int f) {
		if (!mesh.isSliver(f, diagonal))
			return;
		isCorner.resize(size_t(mesh.vertexSlots()), 0);
		for (int v : mesh.triangle(f))
			isCorner[size_t(v)] = 1;
	});
	return isCorner;
}

} // namespace detail

/**
 * Maximal inner balls of oriented points against samples of the same surface.
 *
 * Without faces a ball that reaches out between two samples cannot be told from one that does not:
 * see shrinkingBallPoles() for poles that are inside for certain.
 * @param points   where the balls touch, mesh units.
 * @param normals  outward unit normals, one for each point.
 * @param against  the samples that bound the balls; `points` need not be among them.
 * @param delta    how deep a sample may lie inside a ball, mesh units, >= 0: tolerance to noise.
 * @return a pole for each point; radius -1 for a zero normal and for a ball that nothing bounds.
 * @throws Cancelled
 * Complexity: O((P + Q) log Q) for samples of a surface. Same bits on any number of threads.
 */
inline PoleSet shrinkingBalls(const std::vector<Point3d>& points,
	const std::vector<Point3d>& normals, const std::vector<Point3d>& against, double delta = 0,
	const Progress& progress = Progress())
{
	const UnitFrame frame(against);
	std::vector<detail::Touch> touches;
	touches.reserve(points.size());
	const PointTree order(points); // near each other in it: near each other in space
	const double tolerance = detail::ballTolerance(frame, delta);
	for (int i : order.order())
		touches.push_back({frame.in(points[i]), normals[i], tolerance, i, -1});
	return detail::maximalBalls(
		touches, points.size(), frame, PointTree(frame.in(against)), progress,
		[](int, const Point3d&, double, double) { return true; },
		[](int, const Point3d&, double) { return false; });
}

/**
 * The inner medial poles of some vertices of a mesh by shrinking balls against all its vertices.
 *
 * A ball whose centre is not visible from its vertex through the inside has passed through a coarse
 * triangle, or through a wall thinner than its tolerance. It is searched again without tolerance;
 * if its centre is not visible then either, there is no pole. At slivers, see
 * detail::cornersOfSlivers(), the centre must also have a winding number other than 0.
 * @param vertices  ids, each at most once.
 * @param delta     as in shrinkingBalls().
 * @pre mesh is compact.
 * @return poles in the order of `vertices`; radius -1 where there is none.
 * @throws Cancelled
 * Complexity: O((P + V) log V). Same bits on any number of threads.
 */
inline PoleSet shrinkingBallPoles(const SurfaceMesh& mesh, const std::vector<int>& vertices,
	double delta = 0, const Progress& progress = Progress())
{
	const Progress begin = progress.cancelOnly();
	const UnitFrame frame(mesh.position, begin);
	const PointTree tree(frame.in(mesh.position, begin), progress.part(0, 0.2));
	std::vector<int> place(mesh.vertexSlots(), -1);
	for (size_t i = 0; i < vertices.size(); ++i)
		place[vertices[i]] = int(i);
	const double tolerance = detail::ballTolerance(frame, delta);
	std::vector<detail::Touch> touches;
	touches.reserve(vertices.size());
	const detail::OsculatingNormals normals =
		detail::osculatingNormals(mesh, progress.part(0.2, 0.25));
	detail::cancellableLoop(tree.size(), progress, [&](int slot) {
		const int v = tree.order()[slot];
		if (place[v] < 0)
			return;
		touches.push_back({tree.point(slot), normals.normal[v], tolerance, place[v], slot});
	});
	const InnerSegments segments(mesh, tree, progress.part(0.25, 0.35));
	const std::vector<char> isUnclear =
		detail::cornersOfSlivers(mesh, frame, progress.part(0.35, 0.4));
	std::optional<SolidTest> solid;
	if (!isUnclear.empty())
		solid.emplace(mesh.position, mesh.triangles(begin), begin);
	return detail::maximalBalls(
		touches, vertices.size(), frame, tree, progress.part(0.4, 1),
		[&](int i, const Point3d& centre, double, double depth) {
			const int v = vertices[i];
			return segments.staysInside(v, centre, depth, normals.leadsInside[v])
				&& (isUnclear.empty() || !isUnclear[v] || solid->isInside(solid->in(centre)));
		},
		[&](int i, const Point3d& normal, double depth) {
			return segments.isThinner(vertices[i], normal * -depth);
		});
}

/// The poles of all vertices: shrinkingBallPoles() of each, without tolerance to noise.
inline PoleSet shrinkingBallPoles(const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	return shrinkingBallPoles(mesh, all, 0, progress);
}

} // namespace vcg::tri::mcf

#endif
