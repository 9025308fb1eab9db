// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/mesh/unit_frame.h>

#include <gtest/gtest.h>

#include <vector>

using namespace vcg;
using namespace vcg::tri::mcf;

TEST(UnitFrame, ADiagonalIsBetweenOneAndTwoWhateverTheScale)
{
	for (double scale : {1e-12, 0.3, 1.0, 7e5, 1e15}) {
		const std::vector<Point3d> points = {Point3d(1, 2, 3) * scale, Point3d(4, -2, 3) * scale};
		const UnitFrame frame(points);
		EXPECT_GE(frame.diagonal(), 1);
		EXPECT_LT(frame.diagonal(), 2);
		EXPECT_NEAR(Distance(frame.in(points[0]), frame.in(points[1])), frame.diagonal(), 1e-12);
		EXPECT_NEAR(Distance(frame.in(points[0]), -frame.in(points[1])), 0, 1e-12) << "centred";
	}
}

TEST(UnitFrame, OutIsTheWayBackAndCostsNoDigit)
{
	const std::vector<Point3d> points = {
		Point3d(-3, -5, -1), Point3d(3, 5, 1), Point3d(0.1, 0.7, -0.3)};
	const UnitFrame frame(points);
	for (const Point3d& p : points)
		EXPECT_EQ(frame.out(frame.in(p)), p); // the middle is the origin, the scale a power of two
	EXPECT_EQ(frame.lengthOut(frame.lengthIn(0.1)), 0.1);
}

TEST(UnitFrame, PointsThatCoincideHaveNoDiagonal)
{
	const UnitFrame frame({Point3d(5, 5, 5), Point3d(5, 5, 5)});
	EXPECT_EQ(frame.diagonal(), 0);
	EXPECT_EQ(frame.out(frame.in(Point3d(5, 5, 5))), Point3d(5, 5, 5));
}
