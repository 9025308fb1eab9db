// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/closest_point_walk.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Point3d randomPoint(std::mt19937& random, double size)
{
	const auto number = [&] { return size * (2.0 * double(random()) / double(random.max()) - 1); };
	const double x = number(), y = number(), z = number();
	return {x, y, z};
}

} // namespace

TEST(ClosestOnTriangle, NoPointOfTheTriangleIsCloser)
{
	std::mt19937 random(1);
	for (int i = 0; i < 2000; ++i) {
		const Point3d a = randomPoint(random, 1), b = randomPoint(random, 1),
					  c = randomPoint(random, 1);
		const Point3d q = randomPoint(random, 2);
		const auto found = detail::closestOnTriangle(a, b, c, q);
		EXPECT_NEAR(found.squaredDistance, SquaredDistance(found.point, q), 1e-12);
		constexpr int steps = 12;
		for (int j = 0; j <= steps; ++j)
			for (int k = 0; j + k <= steps; ++k) {
				const Point3d p = (a * j + b * k + c * (steps - j - k)) / double(steps);
				ASSERT_GE(SquaredDistance(p, q), found.squaredDistance - 1e-12);
			}
	}
}

TEST(ClosestOnTriangle, TellsThePartThatThePointLiesOn)
{
	const Point3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
	const struct
	{
		Point3d query, closest;
		int part;
	} cases[] = {{{-1, -1, 5}, a, 0}, {{6, -1, 0}, b, 1}, {{-1, 6, 0}, c, 2},
		{{2, -3, 1}, {2, 0, 0}, 3}, {{3, 3, 1}, {2, 2, 0}, 4}, {{-2, 1, 1}, {0, 1, 0}, 5},
		{{1, 1, 7}, {1, 1, 0}, 6}};
	for (const auto& [query, closest, part] : cases) {
		const auto found = detail::closestOnTriangle(a, b, c, query);
		EXPECT_LT(Distance(found.point, closest), 1e-15);
		EXPECT_EQ(found.part, part);
	}
}

TEST(ClosestOnTriangle, TakesTrianglesWithoutArea)
{
	const Point3d a(0, 0, 0), b(2, 0, 0), q(1, 1, 0);
	const Point3d corners[][3] = {{a, a, b}, {a, b, a}, {b, a, a}, {a, Point3d(1, 0, 0), b}};
	for (const auto& t : corners)
		EXPECT_NEAR(detail::closestOnTriangle(t[0], t[1], t[2], q).squaredDistance, 1, 1e-12);
	EXPECT_NEAR(detail::closestOnTriangle(a, a, a, q).squaredDistance, 2, 1e-12);
}

TEST(TrackSurface, FindsTheClosestPointOfAConvexShapeFromAnywhere)
{
	const SurfaceMesh sphere = shapes::sphere(4).mesh();
	std::mt19937 random(2);
	for (int i = 0; i < 200; ++i) {
		Point3d query = randomPoint(random, 1);
		query *= 1.3 / query.Norm();
		int face = int(random() % unsigned(sphere.faceSlots()));
		const Point3d found = trackSurface(sphere, query, face);
		double minimum = std::numeric_limits<double>::max();
		for (int f = 0; f < sphere.faceSlots(); ++f)
			minimum = std::min(minimum,
				detail::closestOnTriangle(sphere.position[sphere.origin(3 * f)],
					sphere.position[sphere.origin(3 * f + 1)],
					sphere.position[sphere.origin(3 * f + 2)], query)
					.squaredDistance);
		EXPECT_NEAR(SquaredDistance(found, query), minimum, 1e-12);
		const Triangle t = sphere.triangle(face);
		EXPECT_LT(detail::closestOnTriangle(
					  sphere.position[t[0]], sphere.position[t[1]], sphere.position[t[2]], found)
					  .squaredDistance,
			1e-24)
			<< "the face returned does not hold the point returned";
	}
}

TEST(TrackSurface, DoesNotJumpToTheOppositeWall)
{
	// A plate of thickness 0.01; the query has fallen through it, nearer to the bottom.
	const SurfaceMesh plate =
		shapes::subdivided(shapes::subdivided(shapes::subdivided(shapes::box(1, 1, 0.01)))).mesh();
	int top = -1;
	for (int f = 0; f < plate.faceSlots(); ++f)
		if (plate.doubleAreaVector(f)[2] > 0)
			top = f;
	const Point3d found = trackSurface(plate, {0.4, 0.6, -0.02}, top);
	EXPECT_NEAR(found[2], 0.01, 1e-15);
	EXPECT_NEAR(found[0], 0.4, 1e-12);
	EXPECT_NEAR(found[1], 0.6, 1e-12);
}
