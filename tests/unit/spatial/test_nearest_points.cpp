// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/spatial/nearest_points.h>

#include "shapes.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

using vcg::Point3d;
using vcg::tri::mcf::nearestPoints;
using vcg::tri::mcf::PointTree;

std::vector<Point3d> vertices(const shapes::Soup& soup)
{
	return soup.mesh().position;
}

/// What the tree finds one by one.
std::vector<int> byTree(const std::vector<Point3d>& points, const std::vector<Point3d>& queries)
{
	const PointTree tree(points);
	std::vector<int> result;
	for (const Point3d& q : queries)
		result.push_back(tree.nearest(q));
	return result;
}

/// About the mean edge length of the sphere of 2562 vertices.
constexpr double spacing = 0.07;

TEST(NearestPoints, AreThoseOfTheTreeWhateverTheSpacing)
{
	const std::vector<Point3d> points = vertices(shapes::sphere(4));
	std::vector<Point3d> queries = vertices(shapes::torus(0.8, 0.25, 60, 40));
	for (const Point3d& p : vertices(shapes::moved(shapes::sphere(3), {0.01, -0.02, 0.03})))
		queries.push_back(p);
	queries.push_back({50, 0, 0});
	const std::vector<int> expected = byTree(points, queries);
	for (double factor : {0.0, 1e-9, 0.01, 0.5, 1.0, 2.0, 10.0, 1e9})
		EXPECT_EQ(nearestPoints(points, queries, factor * spacing), expected) << factor;
}

TEST(NearestPoints, AreThoseOfTheTreeAtAnyScaleAndPlace)
{
	for (double scale : {1e-6, 1.0, 1e6})
		for (double shift : {0.0, 1e5}) {
			const auto placed = [&](int level, const Point3d& by) {
				return vertices(shapes::moved(shapes::scaled(shapes::sphere(level), scale),
					(by + Point3d(1, -2, 3) * shift) * scale));
			};
			const std::vector<Point3d> points = placed(4, {0, 0, 0}),
									   queries = placed(3, {0.02, 0, -0.01});
			EXPECT_EQ(nearestPoints(points, queries, spacing * scale), byTree(points, queries));
		}
}

TEST(NearestPoints, SmallPartsThatShareACellAreNoTrap)
{
	const std::vector<Point3d> points = vertices(shapes::joined(
		{shapes::sphere(4), shapes::moved(shapes::scaled(shapes::sphere(4), 1e-5), {30, 0, 0})}));
	const std::vector<Point3d> queries = vertices(shapes::joined({shapes::sphere(3),
		shapes::moved(shapes::scaled(shapes::sphere(3), 1.01e-5), {30, 0, 0})}));
	EXPECT_EQ(nearestPoints(points, queries, spacing), byTree(points, queries));
}

TEST(NearestPoints, TheLowestOfEquallyNearOnesIsTaken)
{
	// Corners of a lattice, and the middles of its cubes: each has eight nearest points.
	std::vector<Point3d> points, queries;
	for (int x = 0; x < 8; ++x)
		for (int y = 0; y < 8; ++y)
			for (int z = 0; z < 8; ++z) {
				points.push_back(Point3d(x, y, z));
				queries.push_back(Point3d(x + 0.5, y + 0.5, z + 0.5));
			}
	std::mt19937 random(7);
	std::shuffle(points.begin(), points.end(), random);
	const std::vector<int> expected = byTree(points, queries);
	for (double distance : {0.9, 1.0, 1.2})
		EXPECT_EQ(nearestPoints(points, queries, distance), expected);
	const std::vector<Point3d> same(1000, Point3d(1, 2, 3));
	EXPECT_EQ(nearestPoints(same, same, 0), std::vector<int>(1000, 0));
}

TEST(NearestPoints, OneOfEachIsEnough)
{
	EXPECT_EQ(nearestPoints({{1, 2, 3}}, {{4, 5, 6}}, 1), std::vector<int>(1, 0));
	EXPECT_EQ(nearestPoints({{1, 2, 3}}, {}, 1), std::vector<int>());
}

TEST(NearestPoints, CanBeCancelled)
{
	const std::vector<Point3d> points = vertices(shapes::sphere(4));
	for (double distance : {spacing, 0.0}) {
		int reports = 0;
		const auto count = [&](int, const char*) { return ++reports > 0; };
		nearestPoints(points, points, distance, vcg::tri::mcf::Progress(count));
		ASSERT_GT(reports, 2);
		for (int stopAt = 1; stopAt <= reports; ++stopAt) {
			int calls = 0;
			const auto stop = [&](int, const char*) { return ++calls < stopAt; };
			EXPECT_THROW(nearestPoints(points, points, distance, vcg::tri::mcf::Progress(stop)),
				vcg::tri::mcf::Cancelled);
		}
	}
}

} // namespace
