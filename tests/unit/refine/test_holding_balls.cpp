// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/refine/holding_balls.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// By definition: the node whose ball the point is deepest in, the first of several.
int deepestOf(const CurveSkeleton& skeleton, const Point3d& point)
{
	int holding = -1;
	double minimum = 1;
	for (size_t v = 0; v < skeleton.position.size(); ++v)
		if (skeleton.radius[v] > 0) {
			const double depth = Distance(skeleton.position[v], point) / skeleton.radius[v];
			if (depth < minimum) {
				minimum = depth;
				holding = int(v);
			}
		}
	return holding;
}

} // namespace

TEST(HoldingBalls, AreThoseOfAllNodesWhileTheSkeletonGrows)
{
	std::mt19937 random(3);
	std::uniform_real_distribution<double> unit(0, 1);
	CurveSkeleton skeleton;
	const auto grow = [&](int count) {
		for (int i = 0; i < count; ++i) {
			const double t = 0.02 * double(skeleton.position.size());
			skeleton.position.emplace_back(0.1 * t, 0.3 * std::cos(t), 0.3 * std::sin(t));
			skeleton.radius.push_back(i % 7 == 3 ? 0 : 0.1 * unit(random));
		}
	};
	grow(50);
	refining::HoldingBalls balls(skeleton);
	int held = 0;
	for (int round = 0; round < 30; ++round) {
		for (int i = 0; i < 200; ++i) {
			// One after the other: in which order a call's arguments are computed is for the compiler to choose.
			const double x = unit(random), y = unit(random), z = unit(random);
			const Point3d p(x, y - 0.5, z - 0.5);
			const int expected = deepestOf(skeleton, p);
			ASSERT_EQ(balls.deepest(p), expected);
			held += expected >= 0;
		}
		grow(round % 5 * 11);
		balls.addNew();
	}
	EXPECT_GT(held, 100) << "or nothing was asked";
}

TEST(HoldingBalls, OfEqualsTheFirstHoldsAndOnTheSphereNoneDoes)
{
	CurveSkeleton skeleton;
	skeleton.position = {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}};
	skeleton.radius = {1.5, 1.5, 1.5};
	const refining::HoldingBalls balls(skeleton);
	EXPECT_EQ(balls.deepest({1, 0, 0}), 0);
	EXPECT_EQ(balls.deepest({0, 0, 0}), 0);
	EXPECT_EQ(balls.deepest({3.5, 0, 0}), -1);
	EXPECT_EQ(balls.deepest({0, 9, 0}), -1);
}
