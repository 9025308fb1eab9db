// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The centring of nodes: what unequal edges, concave corners and thin twigs must not do to it.

#include "curves.h"
#include "shapes.h"

#include <skeleton/refine/refine.h>
#include <skeleton/spatial/closest_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using curves::CurveMaker;
using vcg::Point3d;

TEST(RefineCentre, TheSecondDifferenceOfAStraightBranchIsZeroWhateverTheLengthsOfItsEdges)
{
	EXPECT_EQ(refining::secondDifference(0.3, 0.3), (std::array<double, 3> {1, -2, 1}));
	for (const auto& [before, after] : {std::pair(1.0, 3.0), std::pair(2.0, 0.25)}) {
		const std::array<double, 3> d = refining::secondDifference(before, after);
		EXPECT_NEAR(d[0] + d[1] + d[2], 0, 1e-15);
		EXPECT_NEAR(d[2] * after - d[0] * before, 0, 1e-15) << "of x = -before, 0, after";
		// Half the second derivative times the square of the mean length, as for equal edges.
		const double mean = (before + after) / 2;
		EXPECT_NEAR(d[0] * before * before + d[2] * after * after, 2 * mean * mean, 1e-14);
	}
	for (const auto& [before, after] : {std::pair(0.0, 1.0), std::pair(1.0, 0.0)})
		for (double weight : refining::secondDifference(before, after))
			EXPECT_LE(std::abs(weight), 11) << "one length is 0";
	EXPECT_EQ(refining::secondDifference(0, 0), (std::array<double, 3> {0, 0, 0}));
}

TEST(RefineCentre, ANodeThatTouchesAConcaveCornerLeavesIt)
{
	// Two square tubes of width 1 that meet at a right angle; their concave corner is at (1, 1).
	const SurfaceMesh elbow = shapes::subdivided(shapes::cells(10, 10, 1, [](int i, int j, int) {
		return i == 0 || j == 0;
	})).mesh();
	const double touching = 1 - 1e-6;
	const CurveSkeleton rough =
		CurveMaker()
			.chain({{9.5, 0.5, 0.5}, {5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {touching, touching, 0.5},
				{0.5, 1.5, 0.5}, {0.5, 5, 0.5}, {0.5, 9.5, 0.5}})
			.in(elbow);
	const CurveSkeleton curve = refine(rough, elbow);
	ASSERT_GT(curve.position.size(), 20u);
	std::vector<int> all(elbow.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	const ClosestSurface surface(elbow, all, 0.1);
	double nearest = 1;
	for (const Point3d& p : curve.position)
		nearest = std::min(nearest, surface.clearance(p));
	EXPECT_GT(nearest, 0.4) << "the middle of the tubes has 0.5, that of the bend more";
}

TEST(RefineCentre, AThinTwigIsNotDrawnAsideByTheFacetsOfItsBody)
{
	// Three limbs on a ball of radius 1. Beneath their roots, the balls of nodes at a depth of 0.1
	// stick out of it by 0.04.
	const auto shareBelow = [](double limb) {
		CurveSkeleton s;
		s.position = {{0, 0, 0}};
		std::vector<double> distance = {1};
		for (const Point3d& d : {Point3d(1, 0, 0), Point3d(0, 1, 0), Point3d(0, 0, 1)})
			for (const double x : {0.94, 1.5, 2.0}) {
				const int v = int(s.position.size());
				s.position.push_back(d * x);
				distance.push_back(x < 1 ? 0.1 : limb);
				s.edges.push_back({x < 1 ? 0 : v - 1, v});
			}
		const std::vector<double> share = refining::sharesOfCentring(s, s.neighbours(), distance);
		EXPECT_EQ(share.back(), 1);
		return share[1];
	};
	const double ofThick = shareBelow(0.15), ofTwig = shareBelow(0.01);
	EXPECT_NEAR(ofThick, 0.04 / 0.2, 1e-12) << "of the 0.2 by which its ball would be outside";
	EXPECT_LT(ofTwig, 0.3 * ofThick);
	EXPECT_GT(shareBelow(0.05), ofTwig);
}

TEST(RefineCentre, ATwigEntersARoundBodyAlongItsAxis)
{
	constexpr double twig = 0.01; // radii of the ball
	std::vector<std::pair<double, double>> half;
	for (int i = 1; std::cos(i * M_PI / 128) > twig; ++i)
		half.emplace_back(std::sin(i * M_PI / 128), std::cos(i * M_PI / 128));
	for (double x = 1 + twig; x < 3; x += 2 * twig)
		half.emplace_back(x, twig);
	half.emplace_back(3, 0);
	std::vector<std::pair<double, double>> profile;
	for (auto p = half.rbegin(); p != half.rend(); ++p)
		profile.emplace_back(-p->first, p->second);
	profile.emplace_back(0, 1);
	profile.insert(profile.end(), half.begin(), half.end());
	const SurfaceMesh mesh = shapes::revolved(profile, 20).mesh();
	// In the ball the way is long, and its nodes are much farther apart than those of the twigs.
	const CurveSkeleton rough = CurveMaker()
									.line({2.95, 0, 0}, {0.99, 0, 0}, 200)
									.line({0.99, 0, 0}, {0.1, 0.08, 0}, 60)
									.line({0.1, 0.08, 0}, {-0.99, 0, 0}, 60)
									.line({-0.99, 0, 0}, {-2.95, 0, 0}, 200)
									.in(mesh);
	const CurveSkeleton curve = refine(rough, mesh);
	int entering = 0;
	for (const Point3d& p : curve.position)
		if (std::abs(p[0]) > 0.95 && std::abs(p[0]) < 1.2) {
			++entering;
			EXPECT_LT(std::hypot(p[1], p[2]), twig / 2) << "at " << p[0];
		}
	EXPECT_GE(entering, 10);
}
