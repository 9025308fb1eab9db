// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/core/segment.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vcg;
using namespace vcg::tri::mcf;

TEST(ClosestOnSegment, IsTheFootOfThePerpendicularOrAnEnd)
{
	const Point3d a(1, 0, 0), b(5, 0, 0);
	const SegmentPoint middle = closestOnSegment(a, b, Point3d(2, 7, -3));
	EXPECT_DOUBLE_EQ(middle.t, 0.25);
	EXPECT_NEAR(Distance(middle.point, Point3d(2, 0, 0)), 0, 1e-15);
	EXPECT_EQ(closestOnSegment(a, b, Point3d(-4, 1, 1)).point, a);
	EXPECT_EQ(closestOnSegment(a, b, Point3d(9, 1, 1)).point, b);
}

TEST(ClosestOnSegment, NoPointOfTheSegmentIsCloser)
{
	const Point3d a(0.3, -1, 2), b(-0.7, 0.4, 1.1);
	for (int i = 0; i < 200; ++i) {
		const Point3d query(std::sin(i), std::cos(2.3 * i), 2 * std::sin(1.7 * i));
		const double distance = Distance(query, closestOnSegment(a, b, query).point);
		for (int k = 0; k <= 100; ++k)
			EXPECT_LE(distance, Distance(query, a + (b - a) * (k / 100.0)) + 1e-12);
	}
}

TEST(ClosestOnSegment, WithoutLengthItIsAPoint)
{
	const Point3d a(1, 2, 3);
	const SegmentPoint found = closestOnSegment(a, a, Point3d(0, 0, 0));
	EXPECT_EQ(found.point, a);
	EXPECT_EQ(found.t, 0);
}
