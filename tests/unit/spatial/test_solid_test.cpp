// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "hostile_bodies.h"
#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/spatial/integer_winding.h>
#include <skeleton/spatial/solid_test.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

SolidTest solidOf(const shapes::Soup& soup)
{
	return SolidTest(soup.points, soup.triangles);
}

} // namespace

TEST(SolidTest, AgreesWithTheSolidAngleEvenWhereTheSurfaceCrossesItself)
{
	for (const std::string& family : shapes::hostileFamilies())
		for (unsigned seed : {1u, 2u, 3u}) {
			SCOPED_TRACE(family + " " + std::to_string(seed));
			const shapes::Soup soup = shapes::hostileBody(family, seed);
			const SurfaceMesh mesh = soup.mesh();
			const SolidTest solid = solidOf(soup);
			const vcg::Box3d box = mesh.bounds();
			shapes::Dice dice(seed);
			for (int i = 0; i < 300; ++i) {
				Point3d p;
				for (int k = 0; k < 3; ++k)
					p[k] = dice.between(box.min[k], box.max[k]);
				const double winding = checks::windingNumber(mesh, p);
				if (std::abs(winding - std::round(winding)) < 1e-3) { // else too near to tell so
					ASSERT_EQ(solid.isInside(solid.in(p)), std::round(winding) != 0) << i;
				}
			}
		}
}

TEST(SolidTest, RaysThroughVerticesAndEdgesAreCountedOnce)
{
	// In the turned coordinates the ray is the third axis: points straight below vertices and edges.
	const shapes::Soup soup = shapes::torus(1, 0.3, 12, 8);
	const SolidTest solid = solidOf(soup);
	const SurfaceMesh mesh = soup.mesh();
	const auto agrees = [&](Point3d p) {
		p[2] -= 0.01;
		return solid.isInside(p) == (checks::windingNumber(mesh, solid.out(p)) > 0.5);
	};
	for (int v = 0; v < int(soup.points.size()); ++v)
		EXPECT_TRUE(agrees(solid.vertices()[v])) << v;
	for (const Triangle& t : soup.triangles)
		EXPECT_TRUE(agrees((solid.vertices()[t[0]] + solid.vertices()[t[1]]) / 2));
}

TEST(SolidTest, SegmentsThatLeaveTheSolidAreSeen)
{
	const SolidTest ring = solidOf(shapes::torus(1, 0.3, 60, 20));
	const auto inside = [&](const Point3d& p, const Point3d& q) {
		return ring.segmentIsInside(ring.in(p), ring.in(q), 1e-9);
	};
	EXPECT_TRUE(inside({1, 0, 0}, {0.98, 0.2, 0}));
	EXPECT_FALSE(inside({1, 0, 0}, {-1, 0, 0})) << "through the hole";
	EXPECT_FALSE(inside({1, 0, 0}, {2, 0, 0}));
	// Two balls that overlap are one solid: the walls within it are none.
	const SolidTest pair =
		solidOf(shapes::joined({shapes::sphere(3), shapes::moved(shapes::sphere(3), {1, 0, 0})}));
	EXPECT_TRUE(
		pair.segmentIsInside(pair.in(Point3d(-0.9, 0, 0)), pair.in(Point3d(1.9, 0, 0)), 1e-9));
}

TEST(SolidTest, TheClosestPointAndTheChordOfABoxAreKnown)
{
	const SolidTest solid = solidOf(shapes::box(1, 2, 4));
	const double unit = std::sqrt(21.0);
	const SolidTest::Closest on = solid.closest(solid.in(Point3d(0.5, 1, 7)));
	EXPECT_NEAR(Distance(solid.out(on.point), Point3d(0.5, 1, 4)), 0, 1e-12);
	EXPECT_NEAR(on.distance, 3 / unit, 1e-12);
	const Point3d down = solid.in(Point3d(0, 0, -1)) - solid.in(Point3d(0, 0, 0));
	const SolidTest::Crossing across = solid.chord(on.point, down / down.Norm());
	EXPECT_NEAR(across.distance, 4 / unit, 1e-9);
	for (int v : solid.triangles()[across.face])
		EXPECT_NEAR(solid.out(solid.vertices()[v])[2], 0, 1e-12) << "the face on the other side";
	EXPECT_EQ(solid.chord(on.point, down / -down.Norm()).face, -1) << "away from the solid";
	// Where there are many cells, too.
	const SolidTest ball = solidOf(shapes::sphere(5));
	for (const Point3d& p : shapes::sphere(1).points) {
		const Point3d from = ball.closest(ball.in(p)).point;
		const Point3d inward = (ball.in(Point3d(0, 0, 0)) - from).Normalize();
		EXPECT_NEAR(ball.chord(from, inward).distance, 1 / std::sqrt(3.0), 1e-3);
	}
}

TEST(SolidTest, SizeAndPlaceDoNotMatter)
{
	for (double size : {1e-20, 1e20}) {
		const SolidTest solid =
			solidOf(shapes::moved(shapes::scaled(shapes::sphere(2), size), {9 * size, 0, 0}));
		EXPECT_TRUE(solid.isInside(solid.in(Point3d(9.5 * size, 0, 0))));
		EXPECT_FALSE(solid.isInside(solid.in(Point3d(10.5 * size, 0, 0))));
	}
}

TEST(TrianglesAbove, GiveTheWindingNumbersAlongASegment)
{
	for (const std::string& family : shapes::hostileFamilies()) {
		SCOPED_TRACE(family);
		const shapes::Soup soup = shapes::hostileBody(family, 4);
		const TriangleTree tree(soup.points, soup.triangles);
		const vcg::Box3d box = soup.mesh().bounds();
		shapes::Dice dice(4);
		const auto place = [&](double margin) {
			Point3d p;
			for (int k = 0; k < 3; ++k)
				p[k] = dice.between(box.min[k] - margin, box.max[k] + margin);
			return p;
		};
		for (int i = 0; i < 50; ++i) {
			const Point3d p = place(0.1 * box.Diag());
			const Point3d q = p + (place(0) - p) * (i % 2 ? 0.02 : 1);
			const TrianglesAbove above(tree, p, q);
			for (int k = 0; k <= 8; ++k) {
				const Point3d at = p + (q - p) * (k / 8.0);
				ASSERT_EQ(above.winding(at), integerWinding(tree, at));
			}
		}
	}
}
