// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Balls that a surface does not enter, against distances by a tree of the triangles.

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/spatial/empty_balls.h>
#include <skeleton/spatial/triangle_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A fine sphere beside a box of twelve long triangles.
SurfaceMesh fineAndCoarse()
{
	return shapes::joined(
		{shapes::moved(shapes::sphere(5), Point3d(10, 0, 0)), shapes::box(2, 2, 2)})
		.mesh();
}

} // namespace

TEST(EmptyBalls, TheSurfaceDoesNotEnterThem)
{
	const SurfaceMesh mesh = fineAndCoarse();
	const std::vector<Triangle> triangles = mesh.triangles();
	const TriangleTree tree(mesh.position, triangles);
	const EmptyBallsOfSurface balls(mesh.position, triangles, Progress());
	for (const Point3d& p : checks::randomPoints(mesh, 500))
		EXPECT_LE(balls.radius(p), tree.closest(p).distance + 1e-12);
	EXPECT_GT(balls.radius({10, 0, 0}), 0.7) << "in the middle of the sphere of small triangles";
}

TEST(EmptyBalls, TheLargestReachesTheSurface)
{
	const SurfaceMesh mesh = fineAndCoarse();
	const std::vector<Triangle> triangles = mesh.triangles();
	const TriangleTree tree(mesh.position, triangles);
	EmptyBallsOfSurface balls(mesh.position, triangles, Progress());
	int left = 1000000;
	for (const Point3d& p : checks::randomPoints(mesh, 500))
		EXPECT_NEAR(balls.largestRadius(p, left), tree.closest(p).distance, 1e-12);
	EXPECT_GT(left, 0);
	left = 3;
	EXPECT_EQ(balls.largestRadius({10, 0, 0}, left), 0) << "too few samples to be sure";
	EXPECT_LT(left, 0);
}

TEST(EmptyBalls, CoverASegmentUnlessTheSurfaceIsOnIt)
{
	// The surface is the plane x = 1, the balls are half as large as can be.
	const auto radiusAt = [](const Point3d& p) { return std::abs(1 - p[0]) / 2; };
	const auto isCovered = [&](double from, double to, int halvings) {
		const Point3d a(from, 0, 0), b(to, 0.1, 0);
		return isCoveredByBalls(a, radiusAt(a), b, radiusAt(b), radiusAt, halvings);
	};
	EXPECT_TRUE(isCovered(0, 0.2, 0));
	EXPECT_FALSE(isCovered(0, 0.9, 0));
	EXPECT_TRUE(isCovered(0, 0.9, 8)) << "by the balls of its halves";
	EXPECT_FALSE(isCovered(0, 1, 16)) << "its end is on the surface";
	EXPECT_FALSE(isCovered(0.5, 1.5, 16)) << "it crosses the surface";
}
