// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/spatial/surface_ways.h>
#include <skeleton/spatial/triangle_tree.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

struct Way
{
	std::vector<SurfaceWays::Place> places;
	double length = 0;
};

/// The way between the points of a surface that are nearest to two others, and its length with both ends.
Way wayBetween(const shapes::Soup& soup, const Point3d& from, const Point3d& to, double spacing)
{
	const TriangleTree tree(soup.points, soup.triangles);
	const TriangleTree::Closest first = tree.closest(from), last = tree.closest(to);
	const SurfaceWays ways(soup.points, soup.triangles, spacing);
	Way way;
	way.places = ways.way(first.face, first.point, last.face, last.point);
	Point3d before = first.point;
	for (const SurfaceWays::Place& place : way.places) {
		way.length += Distance(before, place.point);
		EXPECT_LT(tree.closest(place.point).distance, 1e-12) << "on the surface";
		before = place.point;
	}
	way.length += Distance(before, last.point);
	return way;
}

} // namespace

TEST(SurfaceWays, AroundTheEdgesOfABoxTheWayIsStraightOnceItIsUnfolded)
{
	// From the top over one long edge to the side; the vertices are ten times as far.
	const shapes::Soup bar = shapes::box(20, 1, 1);
	const Way way = wayBetween(bar, {10, 0.7, 1}, {10.4, 1, 0.8}, 0.5);
	EXPECT_NEAR(way.length, std::hypot(0.4, 0.3 + 0.2), 1e-3);
	// Over two edges, to the bottom.
	const Way under = wayBetween(bar, {10, 0.7, 1}, {12, 0.9, 0}, 0.5);
	EXPECT_NEAR(under.length, std::hypot(2, 0.3 + 1 + 0.1), 0.02);
}

TEST(SurfaceWays, WithinATriangleNothingIsCrossed)
{
	EXPECT_TRUE(
		wayBetween(shapes::tetrahedron(), {0.2, 0.1, 0}, {0.1, 0.2, 0}, 0.1).places.empty());
}

TEST(SurfaceWays, OverFineTrianglesTheWayIsNearlyTheGeodesic)
{
	const Way way = wayBetween(shapes::sphere(4), {1, 0, 0}, {0.1, 1, 0.2}, 1);
	const double angle = std::acos(0.1 / std::sqrt(0.1 * 0.1 + 1 + 0.2 * 0.2));
	EXPECT_GT(way.length, 0.99 * angle);
	EXPECT_LT(way.length, 1.1 * angle) << "along edges";
	for (const SurfaceWays::Place& place : way.places)
		EXPECT_LT(place.inward * place.point, -0.99) << "to the centre";
}

TEST(SurfaceWays, ToAnotherBodyThereIsNone)
{
	const shapes::Soup pair =
		shapes::joined({shapes::box(), shapes::moved(shapes::box(), {3, 0, 0})});
	EXPECT_TRUE(wayBetween(pair, {0, 0.5, 0.4}, {4, 0.5, 0.4}, 0.1).places.empty());
}
