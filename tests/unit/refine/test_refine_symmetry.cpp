// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Curves in symmetric shapes that lack a branch on one side, or have one too many there.

#include "curve_in_shape.h"

#include <skeleton/refine/refine_symmetry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using curves::CurveMaker;
using vcg::Point3d;

namespace {

/// Gives the curve the images of its branches; returns whether any was missing.
bool makeSymmetric(CurveInShape& scene)
{
	const refining::SurfaceComponent component = {scene.mesh, scene.vertices, scene.vertices};
	const auto symmetric =
		refining::withImages(scene.curve, component, scene.closest, scene.clearances, Progress());
	if (symmetric)
		scene.curve = *symmetric;
	return symmetric.has_value();
}

/// Whether each tip has one at its image, within a hundredth of the diagonal.
template <class Map>
bool areSymmetric(const std::vector<Point3d>& tips, const Map& map)
{
	return std::all_of(tips.begin(), tips.end(), [&](const Point3d& tip) {
		return std::any_of(tips.begin(), tips.end(),
			[&](const Point3d& other) { return Distance(map(tip), other) < 0.01; });
	});
}

/// 0.8 x 0.6 x 0.1, about the origin.
shapes::Soup flatBox()
{
	return shapes::moved(
		shapes::refined(shapes::box(0.8, 0.6, 0.1), 5), Point3d(-0.4, -0.3, -0.05));
}

/// A plate about the origin with corners at 0.45 from the axis.
shapes::Soup flatPlate(int sides)
{
	constexpr double thickness = 0.18;
	const shapes::Soup plate =
		shapes::moved(shapes::prism(sides, thickness), Point3d(0, 0, -thickness / 2));
	return shapes::refined(shapes::scaled(plate, 0.45), 3);
}

/// The point at a distance from the axis, at an angle in degrees.
Point3d polar(double distance, double degrees)
{
	const double angle = degrees * M_PI / 180;
	return Point3d(std::cos(angle), std::sin(angle), 0) * distance;
}

const auto alongX = [](const Point3d& p) { return Point3d(-p[0], p[1], p[2]); };
const auto alongY = [](const Point3d& p) { return Point3d(p[0], -p[1], p[2]); };

} // namespace

TEST(RefineSymmetry, AMissingCornerIsAdded)
{
	const Point3d left(-0.1, 0, 0), right(0.1, 0, 0);
	CurveInShape scene(flatBox(),
		CurveMaker()
			.line(left, right, 40)
			.line(left, {-0.35, 0.25, 0}, 60)
			.line(left, {-0.35, -0.25, 0}, 60)
			.line(right, {0.35, 0.25, 0}, 60));
	ASSERT_EQ(scene.tips().size(), 3u);
	EXPECT_TRUE(makeSymmetric(scene));
	EXPECT_EQ(scene.tips().size(), 4u);
	EXPECT_TRUE(areSymmetric(scene.tips(), alongX) && areSymmetric(scene.tips(), alongY));
	const SkeletonStatistics now = statistics(scene.curve);
	EXPECT_EQ(now.components, 1);
	EXPECT_EQ(now.cycles, 0);
	EXPECT_FALSE(makeSymmetric(scene));
}

TEST(RefineSymmetry, TipsBesideTheMiddleOfAPlateGoThere)
{
	CurveInShape scene(flatBox(), CurveMaker().line({-0.35, -0.035, 0}, {0.35, 0.03, 0}, 70));
	EXPECT_TRUE(makeSymmetric(scene));
	ASSERT_EQ(scene.tips().size(), 2u);
	for (const Point3d& tip : scene.tips()) {
		EXPECT_NEAR(std::abs(tip[0]), 0.35, 0.01);
		EXPECT_NEAR(tip[1], 0, 1e-3);
	}
	EXPECT_EQ(statistics(scene.curve).components, 1);
	EXPECT_FALSE(makeSymmetric(scene));
}

TEST(RefineSymmetry, APlaceAlongAnotherBranchIsNoImageOfATip)
{
	// The image of a leg's tip lies in the bar of a U, next to the curve.
	shapes::Soup cells =
		shapes::cells(3, 60, 1, [](int i, int j, int) { return i != 1 || j == 0; });
	const shapes::Soup u = shapes::scaled(shapes::moved(cells, {-1.5, -30, -0.5}), 1.0 / 60);
	CurveInShape scene(u,
		CurveMaker()
			.line({-1.0 / 60, 29.5 / 60, 0}, {-1.0 / 60, -29.5 / 60, 0}, 100)
			.line({-1.0 / 60, -29.5 / 60, 0}, {1.0 / 60, -29.5 / 60, 0}, 4)
			.line({1.0 / 60, -29.5 / 60, 0}, {1.0 / 60, 29.3 / 60, 0}, 100));
	ASSERT_EQ(scene.tips().size(), 2u);
	makeSymmetric(scene);
	EXPECT_EQ(scene.tips().size(), 2u);
}

TEST(RefineSymmetry, AStubInThePlateGoesWhereTheOthersAreMore)
{
	const Point3d left(-0.1, 0, 0), right(0.1, 0, 0);
	CurveInShape scene(flatBox(),
		CurveMaker()
			.line(left, right, 40)
			.line(left, {-0.35, 0.25, 0}, 60)
			.line(left, {-0.35, -0.25, 0}, 60)
			.line(right, {0.35, 0.25, 0}, 60)
			.line(right, {0.35, -0.25, 0}, 60)
			.line(right, {0.35, 0, 0}, 50));
	EXPECT_TRUE(makeSymmetric(scene));
	EXPECT_EQ(scene.tips().size(), 4u);
	EXPECT_TRUE(areSymmetric(scene.tips(), alongX));
}

TEST(RefineSymmetry, OfACornerInEightAllAreAdded)
{
	// Two corners, and two tips that the flow has left somewhere on the rim.
	CurveInShape scene(flatPlate(8),
		CurveMaker()
			.line({0, 0, 0}, polar(0.4, 135), 60)
			.line({0, 0, 0}, polar(0.4, 315), 60)
			.line({0, 0, 0}, polar(0.37, 59), 60)
			.line({0, 0, 0}, polar(0.37, 240), 60));
	EXPECT_TRUE(makeSymmetric(scene));
	EXPECT_EQ(scene.tips().size(), 8u);
	const auto turned = [](const Point3d& p) {
		const double c = std::sqrt(0.5);
		return Point3d(c * (p[0] - p[1]), c * (p[0] + p[1]), p[2]);
	};
	EXPECT_TRUE(areSymmetric(scene.tips(), turned) && areSymmetric(scene.tips(), alongX));
	const SkeletonStatistics now = statistics(scene.curve);
	EXPECT_EQ(now.components, 1);
	EXPECT_EQ(now.cycles, 0);
}

TEST(RefineSymmetry, OnARoundRimNoTipIsAdded)
{
	for (int sides : {24, 60}) {
		CurveInShape scene(flatPlate(sides),
			CurveMaker().line({0, 0, 0}, polar(0.4, 20), 60).line({0, 0, 0}, polar(0.4, 200), 60));
		EXPECT_FALSE(makeSymmetric(scene)) << sides;
		EXPECT_EQ(scene.tips().size(), 2u) << sides;
	}
}

TEST(RefineSymmetry, ALimbThatOneSideLacks)
{
	// A body with an arm to each side, thick enough to be no plate.
	const shapes::Soup body = shapes::scaled(
		shapes::moved(
			shapes::refined(
				shapes::cells(7, 2, 2, [](int x, int y, int) { return x == 3 || y == 1; }), 3),
			Point3d(-3.5, -1, -1)),
		0.13);
	const double arm = 0.13 * 0.5;
	CurveInShape scene(
		body, CurveMaker().line({0, -0.06, 0}, {0, arm, 0}).line({0, arm, 0}, {0.38, arm, 0}, 76));
	ASSERT_EQ(scene.tips().size(), 2u);
	EXPECT_TRUE(makeSymmetric(scene));
	EXPECT_TRUE(areSymmetric(scene.tips(), alongX));
	EXPECT_EQ(scene.tips().size(), 3u);
}

TEST(RefineSymmetry, WhatIsSymmetricOrBelongsToNoSymmetricShapeStays)
{
	CurveInShape whole(flatBox(), CurveMaker().line({-0.3, 0, 0}, {0.3, 0, 0}, 120));
	EXPECT_FALSE(makeSymmetric(whole));
	// One corner is pulled out.
	const shapes::Soup pulled = shapes::transformed(flatBox(), [](const Point3d& p) {
		const double far = Distance(p, Point3d(0.4, 0.3, 0));
		return p + Point3d(1, 1, 0) * (0.1 * std::exp(-far * far / 0.01));
	});
	CurveInShape odd(pulled,
		CurveMaker().line({-0.3, 0, 0}, {0.1, 0, 0}, 80).line({0.1, 0, 0}, {0.4, 0.3, 0}, 80));
	const size_t before = odd.curve.position.size();
	EXPECT_FALSE(makeSymmetric(odd));
	EXPECT_EQ(odd.curve.position.size(), before);
}
