// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Closest points of a triangle mesh, and the maximal balls that touch it from inside.

#ifndef VCG_MCF_CLOSEST_SURFACE_H
#define VCG_MCF_CLOSEST_SURFACE_H

#include "empty_balls.h"
#include "maximal_ball.h"
#include "point_tree.h"
#include "solid_test.h"
#include "triangle_tree.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Closest points for queries near the medial axis of a surface, where nearly everything around is
 * equally close: a tree of triangles has to look at most of them (50 to 90 us a query on round
 * shapes of 90000 triangles). Here a tree of samples finds the place, and a walk on the surface
 * makes the answer exact there: four to eight times faster. What is missed is a place whose
 * distance differs from the one found by less than the samples' spacing squared over the distance.
 *
 * Lengths are those of the surface; it should be near the origin.
 */
class ClosestSurface
{
public:
	struct Hit
	{
		Point3d point;
		double distance;
		int face;
	};

	/// A ball that touches the surface at two points.
	struct Ball
	{
		Point3d centre;
		double radius;
		/// The face that it touches apart from the given point, and the angle between both contacts
		/// seen from the centre, radians; -1 and 0 if nothing bounds the ball, which then is the
		/// one around the query.
		int face;
		double spokeAngle;
		Point3d contact;
	};

	/**
	 * @param surface   kept by reference.
	 * @param vertices  of the components to look at, whole ones.
	 * @param spacing   triangles with longer edges get samples inside.
	 * @throws Cancelled. Complexity: O(S log S) for S samples.
	 */
	ClosestSurface(const SurfaceMesh& surface, const std::vector<int>& vertices, double spacing,
		const Progress& progress = Progress()) :
			surface(surface),
			vertices(vertices),
			tree(samples(vertices, spacing, progress.part(0, 0.3)), progress.part(0.3, 1)),
			empty(coverings(spacing, progress))
	{
		detail::cancellableLoop(
			int(vertices.size()), progress, [&](int i) { box.Add(surface.position[vertices[i]]); });
	}

	/**
	 * The closest point of the surface.
	 * @param near  a face that may be close, to start from.
	 * Complexity: O(log S), more where many points are as close.
	 */
	Hit closest(const Point3d& query, int near) const
	{
		return closest(query, closestFrom(query, near));
	}
	/// The same, starting from a result of closestFrom().
	Hit closest(const Point3d& query, const Hit& first) const
	{
		if (alwaysExact)
			return exactFrom(query, first);
		Nearest nearest {query, -1, first.distance};
		tree.search(nearest);
		if (nearest.slot < 0)
			return first;
		const Hit second = closestFrom(query, faceOfSample[tree.order()[nearest.slot]]);
		return second.distance < first.distance ? second : first;
	}
	Hit closest(const Point3d& query) const
	{
		return alwaysExact ? closestExactly(query) : closestNearSample(query);
	}

	/// The exact closest point, however thin the shape is: by a tree of the triangles, which the
	/// first such query builds. Slower than closest().
	Hit closestExactly(const Point3d& query) const
	{
		return exactFrom(query, closestNearSample(query));
	}

	/// Builds what the first exact query would. @throws Cancelled. Complexity: O(F log F).
	void prepareExact(const Progress& progress) const
	{
		std::call_once(trianglesOnce, [&] {
			std::vector<Triangle> corners;
			corners.reserve(faces.size());
			for (int face : faces)
				corners.push_back(surface.triangle(face));
			triangles.corners = std::move(corners);
			triangles.tree.emplace(surface.position, triangles.corners, progress);
		});
	}

	/// Makes closest() exact, as closestExactly(), for all callers. @throws Cancelled
	void makeExact(const Progress& progress = Progress())
	{
		prepareExact(progress);
		alwaysExact = true;
	}
	bool isExact() const { return alwaysExact; }

	/**
	 * Given points that are inside, finds out whether the surface crosses itself around one of them:
	 * where a limb reaches into a body, the inside of the body lies in front of the limb's surface,
	 * here by 0.5 % of the diagonal, since walls of thin plates may cross each other by less. From
	 * then on, winding numbers decide there. @throws Cancelled. Complexity: a closest() for each;
	 * O(F log F) if one is in front of the surface.
	 */
	void considerCrossings(
		const std::vector<Point3d>& inside, const Progress& progress = Progress())
	{
		const double clearly = 0.005 * box.Diag();
		detail::cancellableLoop(int(inside.size()), progress, [&](int i) {
			const Point3d& p = inside[size_t(i)];
			if (!crossesItself && clearance(p, progress) < -clearly)
				crossesItself = exactClearance(p, progress) < -clearly
					&& solid(progress).isInside(solid(progress).in(p));
		});
	}

	/// A lower bound of the distance to the surface, inside or outside, see EmptyBalls. Cheap; 0 near
	/// the surface.
	double emptyRadius(const Point3d& query) const { return empty.radius(tree, query); }

	/// The exact distance to the surface, without what prepareExact() builds: for a few queries near
	/// the surface. @param left  see EmptyBalls::largestRadius(); below 0, the result is 0.
	double distanceNearby(const Point3d& query, int& left) const
	{
		const auto distanceAround = [&](int sample) {
			double squared = std::numeric_limits<double>::max();
			const auto toFace = [&](int f) {
				squared = std::min(
					squared, detail::squaredDistance(surface.position, surface.triangle(f), query));
			};
			if (size_t(sample) < vertices.size())
				surface.forEachOutgoing(vertices[size_t(sample)], [&](int h) { toFace(h / 3); });
			else
				toFace(faceOfSample[size_t(sample)]);
			return std::sqrt(squared);
		};
		return empty.largestRadius(tree, query, distanceAround, left);
	}

	/// Indices into the constructor's `vertices`, ordered so that neighbours are near each other.
	/// @throws Cancelled
	std::vector<int> vertexOrder(const Cancellation& cancel = Cancellation()) const
	{
		std::vector<int> order;
		order.reserve(vertices.size());
		detail::cancellableLoop(tree.size(), cancel, [&](int slot) {
			if (const int sample = tree.order()[slot]; sample < int(vertices.size()))
				order.push_back(sample);
		});
		return order;
	}

	/// The closest point that a walk downhill from a face leads to: for queries that moved little.
	Hit closestFrom(const Point3d& query, int face) const
	{
		const Point3d point = trackSurface(surface, query, face);
		return {point, Distance(point, query), face};
	}

	/**
	 * Whether a query is inside, given its closest point: by the normal there, which at an edge is
	 * the sum of both faces' and at a vertex is weighted by the angles (Baerentzen and Aanaes,
	 * "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005).
	 * Where that sum nearly cancels, or a face is a sliver, the winding number decides: at the
	 * bottom of a slit, or the edge of a blade, thinner than the precision of the coordinates, and
	 * at a triangle that is folded over its neighbours, beside which the normal may be wrong. So it
	 * does in front of a surface that crosses itself, see considerCrossings().
	 * @param progress cancels what the first such query builds, in O(F log F).
	 */
	bool isInside(const Point3d& query, const Hit& hit, const Progress& progress = Progress()) const
	{
		const int h = 3 * hit.face;
		const detail::TrianglePoint on = detail::closestOnTriangle(
			surface.position[surface.origin(h)], surface.position[surface.origin(h + 1)],
			surface.position[surface.origin(h + 2)], query);
		constexpr double minNormal =
			0.2; // of the sum of the lengths; an edge of 23 degrees has 0.2
		Point3d normal(0, 0, 0);
		double weights = 0;
		bool isClear = true;
		const auto add = [&](int face, double weight) {
			normal += unitNormal(face) * weight;
			weights += weight;
			isClear = isClear && !surface.isSliver(face, box.Diag());
		};
		if (on.part >= 3) {
			add(h / 3, 1);
			if (on.part != detail::TrianglePoint::interior)
				add(surface.twin(h + on.part - 3) / 3, 1);
		}
		else {
			surface.forEachOutgoing(surface.origin(h + on.part), [&](int out) {
				const Point3d& v = surface.position[surface.origin(out)];
				const Point3d a = surface.position[surface.target(out)] - v;
				const Point3d b = surface.position[surface.apex(out)] - v;
				add(out / 3, std::atan2((a ^ b).Norm(), a * b));
			});
		}
		const bool isBehind = (query - on.point) * normal < 0;
		if (!isClear || normal.Norm() < minNormal * weights || (crossesItself && !isBehind))
			return solid(progress).isInside(solid(progress).in(query));
		return isBehind;
	}

	/// Distance to the surface: positive inside, negative outside. @param progress see isInside().
	double clearance(const Point3d& query, const Progress& progress = Progress()) const
	{
		return signedDistance(query, closest(query), progress);
	}
	/// The same from closestExactly().
	double exactClearance(const Point3d& query, const Progress& progress = Progress()) const
	{
		prepareExact(progress);
		return signedDistance(query, closestExactly(query), progress);
	}

	/**
	 * The largest ball that touches the surface at hit.point, with its centre on the ray from there
	 * through `inside`, and has no other point of the surface deeper in it than `tolerance`.
	 * The ball returned touches the point that holds it: the tolerance only keeps noise and facets
	 * from being that point, and does not widen the ball.
	 * @pre hit is the closest point of `inside`, which is not on the surface.
	 * @param near  a face that may hold the ball, to start from; -1: none is known.
	 */
	Ball maximalBall(const Point3d& inside, const Hit& hit, double tolerance, int near) const
	{
		const Point3d outward = (hit.point - inside) / hit.distance;
		Ball first = {inside, box.Diag(), -1, 0, hit.point};
		if (near >= 0)
			first = heldBall(hit, outward, hit.distance, near);
		detail::MaximalBall ball(
			hit.point, outward, std::max(tolerance, 1e-9 * hit.distance), first.radius);
		tree.search(ball);
		if (ball.contact() < 0)
			return boundedBall(first, inside, hit);
		const Point3d e = tree.point(ball.contact()) - hit.point;
		const double radius = e.SquaredNorm() / (-2 * (e * outward));
		const int face = faceOfSample[tree.order()[ball.contact()]];
		return boundedBall(heldBall(hit, outward, radius, face), inside, hit);
	}

	/// The ball held by the part of the surface that a walk downhill from `previous` leads to.
	Ball maximalBallFrom(const Point3d& inside, const Hit& hit, const Ball& previous) const
	{
		const Point3d outward = (hit.point - inside) / hit.distance;
		return boundedBall(heldBall(hit, outward, previous.radius, previous.face), inside, hit);
	}

private:
	/// A search region: all that is nearer than the best sample so far.
	struct Nearest
	{
		Point3d query;
		int slot;
		double distance;

		const Point3d& centre() const { return query; }
		double reach() const { return distance; }
		void visit(int candidate, const Point3d& p)
		{
			const double d = Distance(query, p);
			if (d < distance) {
				distance = d;
				slot = candidate;
			}
		}
	};

	static constexpr const char* sorting = "Sorting the surface";

	const SurfaceMesh& surface;
	std::vector<int> vertices; ///< the first samples
	std::vector<int> faceOfSample;
	std::vector<int> faces;
	PointTree tree;
	EmptyBalls empty;
	Box3d box;
	bool alwaysExact = false, crossesItself = false;
	/// What only exact queries need; made by the first.
	struct Triangles
	{
		std::vector<Triangle> corners;
		std::optional<TriangleTree> tree;
	};
	mutable Triangles triangles;
	mutable std::once_flag trianglesOnce;
	/// What only queries without a reliable normal need; made by the first.
	mutable std::optional<SolidTest> bounded;
	mutable std::once_flag boundedOnce;

	const SolidTest& solid(const Progress& progress) const
	{
		std::call_once(boundedOnce, [&] {
			std::vector<Point3d> corners;
			std::vector<Triangle> own;
			corners.reserve(3 * faces.size());
			own.reserve(faces.size());
			for (int face : faces) {
				const int first = int(corners.size());
				own.push_back({first, first + 1, first + 2});
				for (int v : surface.triangle(face))
					corners.push_back(surface.position[v]);
			}
			bounded.emplace(corners, own, progress);
		});
		return *bounded;
	}

	std::vector<Point3d> samples(
		const std::vector<int>& vertices, double spacing, const Progress& progress)
	{
		std::vector<Point3d> points;
		points.reserve(vertices.size());
		faceOfSample.reserve(vertices.size());
		const int count = int(vertices.size());
		detail::reportedLoop(count, progress.part(0, 0.3), sorting, [&](int i) {
			points.push_back(surface.position[vertices[i]]);
			faceOfSample.push_back(surface.outgoing(vertices[i]) / 3);
		});
		detail::reportedLoop(count, progress.part(0.3, 1), sorting, [&](int i) {
			surface.forEachOwnFace(vertices[i], [&](int f) {
				faces.push_back(f);
				sampleInside(f, spacing, points);
			});
		});
		return points;
	}

	/// How far a triangle may reach from its own samples, for each sample the maximum around it.
	std::vector<double> coverings(double spacing, const Cancellation& cancel) const
	{
		const double betweenRows = std::sqrt(1.25) * spacing; // midway; that of samples inside
		std::vector<double> covering(faceOfSample.size(), betweenRows);
		detail::cancellableLoop(int(vertices.size()), cancel, [&](int i) {
			double squared = 0; // of the longest edge around
			surface.forEachOutgoing(vertices[i], [&](int h) {
				squared = std::max(
					{squared, surface.squaredLength(h), surface.squaredLength(surface.next(h))});
			});
			const double longest = std::sqrt(squared);
			if (longest <= spacing)
				covering[i] = coveringOfTriangle(longest);
		});
		return covering;
	}

	/// Samples in rows parallel to the longest edge, that edge included, the corners left out.
	void sampleInside(int face, double spacing, std::vector<Point3d>& points)
	{
		int base = 3 * face;
		for (int h = base + 1; h < 3 * face + 3; ++h)
			if (surface.squaredLength(h) > surface.squaredLength(base))
				base = h;
		const Point3d& a = surface.position[surface.origin(base)];
		const Point3d ab = surface.position[surface.target(base)] - a;
		const Point3d ac = surface.position[surface.apex(base)] - a;
		const double length = ab.Norm();
		if (length <= spacing)
			return;
		const int rows = std::max(1, int(std::ceil((ab ^ ac).Norm() / length / spacing)));
		for (int row = 0; row < rows; ++row) {
			const double up = double(row) / rows;
			const int pieces = std::max(1, int(std::ceil((1 - up) * length / spacing)));
			for (int i = row == 0 ? 1 : 0; i <= (row == 0 ? pieces - 1 : pieces); ++i) {
				points.push_back(a + ac * up + ab * ((1 - up) * i / pieces));
				faceOfSample.push_back(face);
			}
		}
	}

	Hit closestNearSample(const Point3d& query) const
	{
		return closestFrom(query, faceOfSample[tree.nearest(query)]);
	}

	Hit exactFrom(const Point3d& query, const Hit& first) const
	{
		prepareExact(Progress());
		const TriangleTree::Closest found = triangles.tree->closest(query, first.distance);
		return found.face < 0 ? first
							  : Hit {found.point, found.distance, faces[size_t(found.face)]};
	}

	double signedDistance(const Point3d& query, const Hit& hit, const Progress& progress) const
	{
		return isInside(query, hit, progress) ? hit.distance : -hit.distance;
	}

	/// The ball if the surface bounds it, else the one around the query: the radius with which a
	/// search began, or that of nearly a half-space, is not a distance from the surface.
	Ball boundedBall(const Ball& ball, const Point3d& inside, const Hit& hit) const
	{
		return ball.face >= 0 && ball.radius <= box.Diag()
			? ball
			: Ball {inside, hit.distance, -1, 0, hit.point};
	}

	/// Fits a ball: walks to the point closest to its centre and takes the ball through there,
	/// until the radius settles. Its face is -1 if nothing holds it.
	Ball heldBall(const Hit& hit, const Point3d& outward, double radius, int face) const
	{
		constexpr int maxSteps = 8;
		constexpr double settled = 1e-4;
		Point3d contact = hit.point;
		for (int i = 0; i < maxSteps; ++i) {
			contact = trackSurface(surface, hit.point - outward * radius, face);
			const Point3d e = contact - hit.point;
			const double depth = -(e * outward);
			if (!(depth > 0))
				return {hit.point - outward * radius, radius, -1, 0, hit.point};
			const double held = std::max(e.SquaredNorm() / (2 * depth), hit.distance);
			const bool last = std::abs(held - radius) <= settled * radius;
			radius = held;
			if (last)
				break;
		}
		const Point3d centre = hit.point - outward * radius;
		const Point3d a = hit.point - centre, b = contact - centre;
		return {centre, radius, face, std::atan2((a ^ b).Norm(), a * b), contact};
	}

	Point3d unitNormal(int face) const
	{
		const Point3d n = surface.doubleAreaVector(face);
		const double length = n.Norm();
		return length > 0 ? n / length : n;
	}
};

} // namespace vcg::tri::mcf

#endif
