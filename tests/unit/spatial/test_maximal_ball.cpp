// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/spatial/maximal_ball.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace vcg;
using vcg::tri::mcf::detail::MaximalBall;

namespace {

/// Points of the unit sphere, and of the plane z = -0.5.
std::vector<Point3d> samples()
{
	std::mt19937 random(4);
	std::uniform_real_distribution<double> u(-1, 1);
	std::vector<Point3d> points;
	while (points.size() < 3000) {
		Point3d p(u(random), u(random), u(random));
		if (p.Norm() > 0.1)
			points.push_back(p.Normalize());
		points.push_back(Point3d(u(random), u(random), -0.5));
	}
	return points;
}

} // namespace

TEST(MaximalBall, IsTheLargestWithoutASampleInside)
{
	const Point3d top(0, 0, 1), up(0, 0, 1);
	const std::vector<Point3d> points = samples();
	MaximalBall ball(top, up, 0, 10);
	for (size_t i = 0; i < points.size(); ++i)
		ball.visit(int(i), points[i]);
	// Between the pole of the sphere and the plane.
	EXPECT_NEAR(ball.radius(), 0.75, 0.01);
	ASSERT_GE(ball.contact(), 0);
	EXPECT_NEAR(Distance(ball.centre(), points[size_t(ball.contact())]), ball.radius(), 1e-12);
	for (const Point3d& p : points)
		EXPECT_GE(Distance(ball.centre(), p), ball.radius() * (1 - 1e-9));
}

TEST(MaximalBall, TheOrderOfTheVisitsDoesNotMatter)
{
	std::vector<Point3d> points = samples();
	double radius = 0;
	for (unsigned seed = 0; seed < 5; ++seed) {
		std::shuffle(points.begin(), points.end(), std::mt19937(seed));
		MaximalBall ball(Point3d(0, 0, 1), Point3d(0, 0, 1), 0.01, 10);
		for (size_t i = 0; i < points.size(); ++i)
			ball.visit(int(i), points[i]);
		if (seed == 0)
			radius = ball.radius();
		EXPECT_EQ(ball.radius(), radius); // to the last bit
	}
}

TEST(MaximalBall, ASampleMayBeAsDeepAsTheTolerance)
{
	const Point3d p(0, 0, 0), n(0, 0, 1);
	MaximalBall exact(p, n, 0, 10), tolerant(p, n, 0.1, 10);
	for (MaximalBall* ball : {&exact, &tolerant}) {
		ball->visit(0, Point3d(0, 0, -2));
		ball->visit(1, Point3d(0.05, 0, -0.05)); // a bump
	}
	EXPECT_EQ(exact.contact(), 1);
	EXPECT_EQ(tolerant.contact(), 0);
	EXPECT_NEAR(tolerant.radius(), 1.05, 1e-12) << "the far sample is 0.1 deep";
}
