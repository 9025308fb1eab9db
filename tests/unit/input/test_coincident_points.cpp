// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/input/coincident_points.h>

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>
#include <tuple>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

std::vector<int> firstOf(const std::vector<Point3d>& points)
{
	return detail::firstCoincident(points, Progress(), "");
}

} // namespace

TEST(CoincidentPoints, AreKnownByTheFirstOfThem)
{
	std::mt19937 random(3);
	for (double scale : {1e-300, 1e-6, 1.0, 1e6})
		for (unsigned places : {1u, 3u, 30u}) {
			std::vector<Point3d> points;
			std::map<std::tuple<double, double, double>, int> first;
			std::vector<int> expected;
			for (int i = 0; i < 20000; ++i) {
				const auto x = [&] { return scale * (double(random() % places) - 1); };
				points.emplace_back(x(), x(), x());
				const Point3d& p = points.back();
				expected.push_back(first.emplace(std::tuple(p[0], p[1], p[2]), i).first->second);
			}
			EXPECT_EQ(firstOf(points), expected) << scale << ' ' << places;
		}
}

TEST(CoincidentPoints, ZeroHasNoSign)
{
	EXPECT_EQ(firstOf({{0.0, 1, -0.0}, {-0.0, 1, 0.0}, {0, -1, 0}}), (std::vector<int> {0, 0, 2}));
}

TEST(CoincidentPoints, TheNextNumberIsAnotherPlace)
{
	const double next = 1 + std::numeric_limits<double>::epsilon();
	EXPECT_EQ(firstOf({{1, 1, 1}, {1, 1, next}, {next, 1, 1}, {1, 1, 1}}),
		(std::vector<int> {0, 1, 2, 0}));
	EXPECT_EQ(firstOf({}), std::vector<int>());
}
