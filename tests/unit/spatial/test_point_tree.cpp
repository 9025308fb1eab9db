// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/spatial/point_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace {

using vcg::Point3d;
using vcg::tri::mcf::FourSlabs;
using vcg::tri::mcf::PointTree;

std::vector<Point3d> randomPoints(int count, double size, const Point3d& middle)
{
	std::mt19937 random(7);
	std::uniform_real_distribution<double> coordinate(-size, size);
	std::vector<Point3d> points;
	for (int i = 0; i < count; ++i) {
		const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
		points.push_back(middle + Point3d(x, y, z));
	}
	return points;
}

int nearestByHand(const std::vector<Point3d>& points, const Point3d& x)
{
	int best = -1;
	for (size_t i = 0; i < points.size(); ++i)
		if (best < 0 || Distance(points[i], x) < Distance(points[best], x))
			best = int(i);
	return best;
}

struct CollectingBall
{
	Point3d c;
	double radius;
	std::set<int> found;

	const Point3d& centre() const { return c; }
	double reach() const { return radius; }
	void visit(int slot, const Point3d&) { EXPECT_TRUE(found.insert(slot).second) << "twice"; }
};

struct Placement
{
	double size;
	Point3d middle;
};

class PointTreeAnywhere : public testing::TestWithParam<Placement>
{
};

TEST_P(PointTreeAnywhere, FindsWhatASearchByHandFinds)
{
	const auto [size, middle] = GetParam();
	for (const int count : {1, 2, 31, 33, 129, 5000}) {
		const std::vector<Point3d> points = randomPoints(count, size, middle);
		const PointTree tree(points);
		for (const Point3d& x : randomPoints(50, 3 * size, middle))
			ASSERT_EQ(tree.nearest(x), nearestByHand(points, x)) << count;
	}
}

TEST_P(PointTreeAnywhere, VisitsEveryPointOfTheBallAndNotManyMore)
{
	const auto [size, middle] = GetParam();
	const std::vector<Point3d> points = randomPoints(5000, size, middle);
	const PointTree tree(points);
	for (const Point3d& x : randomPoints(50, size, middle)) {
		CollectingBall ball {x, 0.3 * size, {}};
		tree.search(ball);
		std::set<int> ids;
		for (int slot : ball.found)
			ids.insert(tree.order()[slot]);
		size_t within = 0;
		for (size_t i = 0; i < points.size(); ++i)
			if (Distance(points[i], x) <= ball.radius) {
				++within;
				ASSERT_TRUE(ids.count(int(i)));
			}
		EXPECT_LE(ids.size(), within + 2);
	}
}

TEST_P(PointTreeAnywhere, FindsPointsOfSurfacesAndLines)
{
	const auto [size, middle] = GetParam();
	const Point3d along = Point3d(1, 2, 3).Normalize(), across = Point3d(3, 0, -1).Normalize();
	std::vector<Point3d> sphere, plane, line;
	for (const Point3d& p : randomPoints(3000, 1, {0, 0, 0})) {
		sphere.push_back(middle + Point3d(p).Normalize() * size);
		plane.push_back(middle + (along * p[0] + across * p[1]) * size);
		line.push_back(middle + along * (p[0] * size));
	}
	for (const std::vector<Point3d>& points : {sphere, plane, line}) {
		const PointTree tree(points);
		for (const Point3d& x : randomPoints(50, size, middle)) {
			const int nearest = nearestByHand(points, x);
			ASSERT_EQ(tree.nearest(x), nearest);
			// As a maximal ball does it: it touches the points from the side and holds none but one.
			CollectingBall ball {x, Distance(points[size_t(nearest)], x), {}};
			tree.search(ball);
			bool found = false;
			for (int slot : ball.found)
				found |= tree.order()[slot] == nearest;
			ASSERT_TRUE(found);
		}
	}
}

INSTANTIATE_TEST_SUITE_P(Places, PointTreeAnywhere,
	testing::Values(Placement {1, {0, 0, 0}}, Placement {1e-6, {1e-6, 0, 0}},
		Placement {1e6, {0, -1e7, 0}}, Placement {1, {1e5, 0, 1e5}},
		Placement {1e-36, {0, 0, 1e-36}}, Placement {1e36, {1e36, 0, 0}}));

TEST(PointTree, FindsPointsFromAnyDistance)
{
	const std::vector<Point3d> points = randomPoints(5000, 1, {0, 0, 0});
	const PointTree tree(points);
	for (double distance : {1e3, 1e17, 1e20, 1e36, 1e100})
		for (const Point3d& x : randomPoints(5, distance, {0, 0, 0}))
			EXPECT_EQ(tree.nearest(x), nearestByHand(points, x)) << distance;
}

TEST(PointTree, HoldsEachPointOnce)
{
	const std::vector<Point3d> points = randomPoints(1234, 1, {0, 0, 0});
	const PointTree tree(points);
	std::vector<int> order = tree.order();
	for (int slot = 0; slot < tree.size(); ++slot)
		EXPECT_EQ(tree.point(slot), points[order[slot]]);
	std::sort(order.begin(), order.end());
	for (int i = 0; i < tree.size(); ++i)
		EXPECT_EQ(order[i], i);
}

TEST(PointTree, TakesTheLowestOfEquallyNearPoints)
{
	std::vector<Point3d> points(200, Point3d(1, 2, 3));
	points[0] = {5, 5, 5};
	EXPECT_EQ(PointTree(points).nearest({1, 2, 2}), 1);
	EXPECT_EQ(PointTree({{1, 0, 0}, {-1, 0, 0}}).nearest({0, 0, 0}), 0);
}

TEST(FourSlabs, AreThinAroundAPlaneAskew)
{
	const Point3d along = Point3d(1, 2, 3).Normalize(), across = Point3d(3, 0, -1).Normalize();
	std::vector<Point3d> points;
	for (const Point3d& p : randomPoints(30, 1, {0, 0, 0}))
		points.push_back(along * p[0] + across * p[1]);
	FourSlabs slabs;
	slabs.set(
		2, int(points.size()), [&](int i) { return points[size_t(i)]; }, {0, 0, 0}, 0);
	const Point3d up = along ^ across;
	for (const double height : {-0.7, 0.2}) {
		const Point3d p = along + across + up * height;
		const float x[3] = {float(p[0]), float(p[1]), float(p[2])};
		EXPECT_NEAR(slabs.distances(x)[2], std::abs(height), 1e-5);
		EXPECT_EQ(slabs.distances(x)[1], 0) << "none was set: it holds all of space";
	}
}

TEST(FourSlabs, HoldPointsThatHaveNoDirection)
{
	// One point, one point many times, and coordinates whose squares no number holds.
	const std::vector<std::vector<Point3d>> sets = {{{1, 2, 3}}, std::vector<Point3d>(5, {1, 2, 3}),
		{{1e200, 0, 0}, {0, -1e200, 0}, {0, 0, 1e200}}};
	for (const std::vector<Point3d>& points : sets) {
		FourSlabs slabs;
		slabs.set(
			0, int(points.size()), [&](int i) { return points[size_t(i)]; }, {0, 0, 0}, 1e-6);
		for (const Point3d& p : points) {
			const float x[3] = {float(p[0]), float(p[1]), float(p[2])};
			EXPECT_FALSE(slabs.distances(x)[0] > 0);
		}
	}
}

TEST(PointTree, HasNoNearestPointWithoutPoints)
{
	EXPECT_EQ(PointTree(std::vector<Point3d>()).nearest({0, 0, 0}), -1);
}

} // namespace
