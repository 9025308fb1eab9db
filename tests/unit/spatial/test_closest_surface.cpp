// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Closest points, insides and maximal balls, against brute force and shapes with known answers.

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/spatial/closest_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

std::vector<int> allVertices(const SurfaceMesh& mesh)
{
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	return all;
}

double distanceByBruteForce(const SurfaceMesh& mesh, const Point3d& x)
{
	double minimum = std::numeric_limits<double>::infinity();
	for (const Triangle& t : mesh.triangles())
		minimum = std::min(minimum,
			detail::closestOnTriangle(
				mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]], x)
				.squaredDistance);
	return std::sqrt(minimum);
}

class OnShapes : public testing::TestWithParam<shapes::Soup>
{
};

TEST_P(OnShapes, DistanceIsThatOfBruteForceButForTheSamplesSpacing)
{
	const SurfaceMesh mesh = GetParam().mesh();
	const double spacing = mesh.bounds().Diag() / 50;
	const ClosestSurface closest(mesh, allVertices(mesh), spacing);
	for (const Point3d& x : checks::randomPoints(mesh, 200)) {
		const double exact = distanceByBruteForce(mesh, x);
		const ClosestSurface::Hit hit = closest.closest(x);
		EXPECT_GE(hit.distance, exact - 1e-12);
		EXPECT_LE(hit.distance, exact + spacing * spacing / std::max(exact, spacing));
		EXPECT_NEAR(Distance(hit.point, x), hit.distance, 1e-12);
		EXPECT_LE(distanceByBruteForce(mesh, hit.point), 1e-9) << "the point is on the surface";
		EXPECT_GE(closest.closest(x, 0).distance, exact - 1e-12) << "begun at a far face";
		EXPECT_LE(
			closest.closest(x, 0).distance, exact + spacing * spacing / std::max(exact, spacing));
	}
}

TEST_P(OnShapes, ExactDistanceIsThatOfBruteForce)
{
	const SurfaceMesh mesh = GetParam().mesh();
	for (double part : {50, 5}) {
		const ClosestSurface closest(mesh, allVertices(mesh), mesh.bounds().Diag() / part);
		for (const Point3d& x : checks::randomPoints(mesh, 200)) {
			const double exact = distanceByBruteForce(mesh, x);
			EXPECT_NEAR(closest.closestExactly(x).distance, exact, 1e-12);
			EXPECT_LE(closest.emptyRadius(x), exact + 1e-12);
		}
	}
}

TEST_P(OnShapes, InsideIsThatOfTheWindingNumber)
{
	const SurfaceMesh mesh = GetParam().mesh();
	const ClosestSurface closest(mesh, allVertices(mesh), mesh.bounds().Diag() / 50);
	int inside = 0, outside = 0;
	for (const Point3d& x : checks::randomPoints(mesh, 200)) {
		if (distanceByBruteForce(mesh, x) < 1e-3)
			continue;
		const bool isInside = checks::windingNumber(mesh, x) > 0.5;
		EXPECT_EQ(closest.clearance(x) > 0, isInside);
		++(isInside ? inside : outside);
	}
	EXPECT_GT(inside, 5);
	EXPECT_GT(outside, 5);
}

TEST_P(OnShapes, MaximalBallIsEmptyAndTouchesTwice)
{
	const SurfaceMesh mesh = GetParam().mesh();
	const double spacing = mesh.bounds().Diag() / 50;
	const ClosestSurface closest(mesh, allVertices(mesh), spacing);
	for (const Point3d& x : checks::randomPoints(mesh, 200)) {
		const ClosestSurface::Hit hit = closest.closest(x);
		if (hit.distance < spacing || !closest.isInside(x, hit))
			continue;
		const ClosestSurface::Ball ball = closest.maximalBall(x, hit, 0, -1);
		ASSERT_GE(ball.face, 0) << "something bounds every inner ball";
		EXPECT_GE(ball.radius, hit.distance * (1 - 1e-9));
		EXPECT_NEAR(Distance(ball.centre, hit.point), ball.radius, 1e-9);
		EXPECT_NEAR(
			distanceByBruteForce(mesh, ball.centre), ball.radius, spacing * spacing / ball.radius);
		EXPECT_GT(ball.spokeAngle, 0);
	}
}

INSTANTIATE_TEST_SUITE_P(ClosestSurface, OnShapes,
	testing::Values(shapes::torus(), shapes::capsule(), shapes::sphere(2), shapes::box(3, 2, 1),
		shapes::plate(2), shapes::jittered(shapes::torus(1, 0.4), 0.01)));

TEST(ClosestSurface, AroundALimbThatReachesIntoABodyIsInsideOnceAPointThereIsKnownToBe)
{
	// A ball of radius 1, and a tube of radius 0.2 along the x axis from its middle to 2.
	const SurfaceMesh mesh = shapes::joined(
		{shapes::sphere(3, 1), shapes::moved(shapes::capsule(2, 0.2, 24), Point3d(1, 0, 0))})
								 .mesh();
	ClosestSurface closest(mesh, allVertices(mesh), 0.1);
	const Point3d around(0.5, 0.3, 0), inLimb(1.5, 0.05, 0), outside(1.5, 0.5, 0);
	closest.considerCrossings({inLimb});
	EXPECT_LT(closest.clearance(around), 0) << "the tube's surface faces it";
	closest.considerCrossings({inLimb, outside});
	EXPECT_LT(closest.clearance(around), 0) << "a point that is outside of all proves nothing";
	closest.considerCrossings({inLimb, around});
	EXPECT_NEAR(closest.clearance(around), 0.1, 0.01);
	EXPECT_NEAR(closest.clearance({0.5, 0.05, 0}), 0.15, 0.01) << "in both";
	EXPECT_NEAR(closest.clearance(inLimb), 0.15, 0.01);
	EXPECT_NEAR(closest.clearance(outside), -0.3, 0.01);
}

TEST(ClosestSurface, BesideAFaceThatIsFoldedOverItsNeighboursIsInside)
{
	// A block whose top goes to B, back to C and on, through itself: the normals at C, the lowest
	// place of the fold, nearly cancel, and their sum points down.
	const std::vector<Point3d> outline = {
		{-1, 0, 0}, {0.2, 0, -0.1}, {-0.2, 0, -0.13}, {1, 0, 0}, {1, 0, -2}, {-1, 0, -2}};
	const int n = int(outline.size());
	shapes::Soup block;
	for (const double y : {-2.0, 2.0})
		for (const Point3d& p : outline)
			block.points.emplace_back(p[0], y, p[2]);
	for (int i = 0; i < n; ++i) {
		const int j = (i + 1) % n;
		block.triangles.push_back({i, i + n, j});
		block.triangles.push_back({j, i + n, j + n});
	}
	for (int i = 0; i + 2 < n; ++i) { // both caps are fans around the last corner
		block.triangles.push_back({n - 1, i, i + 1});
		block.triangles.push_back({2 * n - 1, i + 1 + n, i + n});
	}
	SurfaceMesh mesh = block.mesh();
	if (mesh.volume() < 0)
		mesh = shapes::insideOut(block).mesh();
	const ClosestSurface closest(mesh, allVertices(mesh), mesh.bounds().Diag() / 50);
	for (double x = -0.4; x < -0.2; x += 0.03)
		for (double z = -0.6; z < -0.25; z += 0.1) {
			ASSERT_GT(checks::windingNumber(mesh, {x, 0, z}), 0.5);
			EXPECT_GT(closest.clearance({x, 0, z}), 0) << x << " " << z;
		}
}

TEST(ClosestSurface, BallInATubeHasTheTubesRadius)
{
	const SurfaceMesh mesh = shapes::capsule(2, 0.35, 128).mesh();
	const ClosestSurface closest(mesh, allVertices(mesh), 0.05);
	for (double x : {-0.8, -0.33, 0.0, 0.51, 0.9}) {
		const Point3d aside(x, 0.1, 0.07);
		const ClosestSurface::Ball ball =
			closest.maximalBall(aside, closest.closest(aside), 0.01, -1);
		// A facet's normal misses the axis by up to half the facet's width.
		EXPECT_NEAR(ball.radius, 0.35, 0.01);
		EXPECT_NEAR(std::hypot(ball.centre[1], ball.centre[2]), 0, 0.01);
	}
}

TEST(ClosestSurface, BallInAPlateReachesFromWallToWall)
{
	const SurfaceMesh mesh = shapes::box(6, 6, 1).mesh();
	const ClosestSurface closest(mesh, allVertices(mesh), 0.1);
	const Point3d low(3.1, 2.7, 0.2);
	const ClosestSurface::Ball ball = closest.maximalBall(low, closest.closest(low), 0, -1);
	EXPECT_NEAR(ball.radius, 0.5, 1e-3);
	EXPECT_NEAR(ball.centre[2], 0.5, 1e-3);
	EXPECT_NEAR(ball.spokeAngle, M_PI, 1e-2);
}

TEST(ClosestSurface, FollowingGivesWhatSearchingGives)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 120, 40).mesh();
	const ClosestSurface closest(mesh, allVertices(mesh), 0.05);
	const Point3d x(1.05, 0, 0.02), moved(1.04, 0.03, 0.01);
	const ClosestSurface::Hit hit = closest.closest(x);
	const ClosestSurface::Hit followed = closest.closestFrom(moved, hit.face);
	EXPECT_NEAR(followed.distance, closest.closest(moved).distance, 2e-3);
	const ClosestSurface::Ball before = closest.maximalBall(x, hit, 1e-3, -1);
	const ClosestSurface::Ball ball = closest.maximalBallFrom(moved, followed, before);
	EXPECT_NEAR(ball.radius, 0.3, 0.01);
}

// Walls that are nearer to each other than their vertices are precise: those of a slit and of a blade.
TEST(ClosestSurface, WallsAsNearAsRoundingTellNoSide)
{
	constexpr double gap = 1e-9, rounding = 1e-8;
	const auto block = [&](bool isSlit) {
		const shapes::Soup wide =
			shapes::cells(3, 2, 2, [&](int i, int, int k) { return k == 0 || (i == 1) != isSlit; });
		return shapes::jittered(shapes::transformed(wide,
									[&](const Point3d& p) {
										const double x = p[0] < 1.5 ? p[0] : p[0] - 1 + gap;
										return Point3d(x, p[1], p[2]);
									}),
			rounding)
			.mesh();
	};
	const SurfaceMesh slit = block(true), blade = block(false);
	const ClosestSurface around(slit, allVertices(slit), 0.05),
		beside(blade, allVertices(blade), 0.05);
	for (int i = 1; i < 20; ++i)
		for (double distance : {0.01, 0.1, 0.3})
			for (double aside : {-0.5, 0.0, 0.3}) {
				const double y = 0.1 * i;
				EXPECT_GT(around.clearance(Point3d(1 + aside * distance, y, 1 - distance)), 0)
					<< "under the bottom of the slit";
				EXPECT_LT(beside.clearance(Point3d(1 + aside * distance, y, 2 + distance)), 0)
					<< "above the edge of the blade";
			}
}

TEST(ClosestSurface, LooksOnlyAtTheGivenComponents)
{
	const SurfaceMesh mesh =
		shapes::joined({shapes::sphere(2), shapes::moved(shapes::sphere(2), Point3d(5, 0, 0))})
			.mesh();
	std::vector<int> first;
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.position[v][0] < 2)
			first.push_back(v);
	const ClosestSurface closest(mesh, first, 0.1);
	EXPECT_NEAR(closest.closest(Point3d(5, 0, 0)).distance, 4, 0.05);
	EXPECT_LT(closest.clearance(Point3d(5, 0, 0)), 0);
}

} // namespace
