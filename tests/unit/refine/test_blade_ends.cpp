// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Limbs that end in an edge: one tip, in the middle of it.

#include "curve_in_shape.h"

#include <skeleton/refine/blade_ends.h>
#include <skeleton/skeletonize.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using curves::CurveMaker;
using vcg::Point3d;

namespace {

/// The curve with the radii that the rules for its ends ask for.
CurveSkeleton measured(CurveInShape& scene)
{
	refining::measureNodes(scene.curve, scene.clearances);
	return scene.curve;
}

std::vector<Point3d> tipsWithoutForks(CurveInShape& scene)
{
	return curves::tips(
		refining::withoutForkedEnds(measured(scene), scene.closest, scene.clearances));
}

CurveSkeleton straightened(CurveInShape& scene)
{
	return refining::withStraightEnds(measured(scene), scene.closest, scene.clearances);
}

/// Adds a way from point to point, with a node every hundredth.
CurveMaker along(const std::vector<Point3d>& points, CurveMaker maker = CurveMaker())
{
	for (size_t i = 1; i < points.size(); ++i)
		maker.line(points[i - 1], points[i],
			std::max(1, int(std::ceil(100 * Distance(points[i - 1], points[i])))));
	return maker;
}

/// A bar along the x axis from 0 to 1, `width` wide along y and 0.16 thick.
shapes::Soup bar(double width)
{
	return shapes::moved(
		shapes::refined(shapes::box(1, width, 0.16), 5), Point3d(0, -width / 2, -0.08));
}

/// The extrusion of a polygon that is star-shaped about the origin.
shapes::Soup extruded(const std::vector<Point3d>& outline, double height)
{
	shapes::Soup s = shapes::prism(int(outline.size()), height);
	for (size_t i = 0; i < outline.size(); ++i)
		for (const size_t v : {i, outline.size() + 1 + i})
			for (int axis = 0; axis < 2; ++axis)
				s.points[v][axis] = outline[i][axis];
	return s;
}

/// A flat star whose points are at a distance of 1 from the axis, 38 degrees sharp.
shapes::Soup star(int points, double height)
{
	constexpr double inner = 0.4;
	std::vector<Point3d> outline;
	for (int i = 0; i < 2 * points; ++i) {
		const double angle = M_PI * i / points + 0.2, far = i % 2 == 0 ? 1 : inner;
		outline.emplace_back(far * std::cos(angle), far * std::sin(angle), 0);
	}
	return shapes::refined(extruded(outline, height), 4);
}

} // namespace

TEST(BladeEnds, ATipInACornerOfABarGoesToTheMiddleOfItsEnd)
{
	CurveInShape scene(bar(0.32), along({{0.08, 0, 0}, {0.7, 0, 0}, {0.92, 0.08, 0}}));
	const CurveSkeleton straight = straightened(scene);
	const std::vector<Point3d> tips = curves::tips(straight);
	ASSERT_EQ(tips.size(), 2u);
	EXPECT_LT(Distance(tips[0], Point3d(0.08, 0, 0)), 0.01) << "the other end stays";
	EXPECT_LT(Distance(tips[1], Point3d(0.92, 0, 0)), 0.01);
	const auto graph = statistics(straight);
	EXPECT_EQ(graph.components, 1);
	EXPECT_EQ(graph.cycles, 0);
}

TEST(BladeEnds, ATipInACornerOfAPlateStays)
{
	CurveInShape scene(bar(0.6), along({{0.3, 0, 0}, {0.7, 0, 0}, {0.92, 0.22, 0}}));
	EXPECT_EQ(curves::tips(straightened(scene)), scene.tips());
}

TEST(BladeEnds, TheTipOfARoundLimbStays)
{
	CurveInShape scene(shapes::scaled(shapes::capsule(2, 0.35, 24), 0.37),
		along({{0, 0, -0.3}, {0.02, 0, 0.3}, {0.06, 0.02, 0.42}}));
	EXPECT_EQ(curves::tips(straightened(scene)), scene.tips());
}

TEST(BladeEnds, OfTwoBranchesIntoTheCornersOfABarOneStays)
{
	const auto tipsLeft = [](double width) {
		const double aside = width / 2 - 0.08;
		const Point3d fork(0.8, 0, 0);
		const CurveMaker curve = along({fork, {0.92, -aside, 0}},
			along({fork, {0.92, aside, 0}}, along({{0.08, 0, 0}, fork})));
		CurveInShape scene(bar(width), curve);
		return tipsWithoutForks(scene).size();
	};
	EXPECT_EQ(tipsLeft(0.32), 2u) << "twice as wide as thick";
	EXPECT_EQ(tipsLeft(0.6), 3u) << "a plate";
}

TEST(BladeEnds, TheTipsOfTwoLimbsStay)
{
	// Two fingers of 2 x 2 cells, two cells apart, on a palm: a fork.
	const shapes::Soup hand =
		shapes::cells(6, 20, 2, [](int i, int j, int) { return j < 10 || i < 2 || i >= 4; });
	const Point3d fork(0.15, 0.4, 0.05);
	const CurveMaker curve = along({fork, {0.05, 0.55, 0.05}, {0.05, 0.95, 0.05}},
		along({fork, {0.25, 0.55, 0.05}, {0.25, 0.95, 0.05}}, along({{0.15, 0.1, 0.05}, fork})));
	CurveInShape scene(shapes::scaled(hand, 0.05), curve);
	EXPECT_EQ(tipsWithoutForks(scene).size(), 3u);
}

TEST(BladeEnds, AStubAtTheRootOfASpineDoesNotEndBesideItsTip)
{
	// Along x: a ball of radius 0.2 about the origin, with a spine of radius 0.003 from it to 0.5.
	constexpr double ball = 0.2, spine = 0.003;
	std::vector<std::pair<double, double>> profile;
	for (int i = 32; i > 0; --i)
		if (const double y = ball * std::sin(i * M_PI / 32); y > spine)
			profile.emplace_back(ball * std::cos(i * M_PI / 32), y);
	for (double x = ball; x < 0.5; x += spine)
		profile.emplace_back(x, spine);
	profile.emplace_back(0.5, 0);
	profile.insert(profile.begin(), {-ball, 0});
	const Point3d root(ball + 0.005, 0, 0), stub(ball + 0.007, 0.001, 0), tip(0.49, 0, 0);
	CurveInShape scene(shapes::revolved(profile, 12),
		along({root, stub}, along({root, tip}, along({{0, 0, 0}, root}))));
	EXPECT_EQ(tipsWithoutForks(scene).back(), tip);
}

TEST(BladeEnds, OfATailAndAStubBesideItsRootTheStubGoes)
{
	// A body of 10 cells a side, and a tail of 16, four wide and two thick.
	const auto isTail = [](int j, int k) { return j >= 3 && j < 7 && k >= 4 && k < 6; };
	const shapes::Soup soup =
		shapes::cells(26, 10, 10, [&](int i, int j, int k) { return i < 10 || isTail(j, k); });
	const Point3d body(0.25, 0.25, 0.25), root(0.6, 0.25, 0.25), stub(0.65, 0.2, 0.25),
		tip(1.2, 0.25, 0.25);
	CurveInShape scene(
		shapes::scaled(soup, 0.05), along({root, stub}, along({root, tip}, along({body, root}))));
	const std::vector<Point3d> tips = tipsWithoutForks(scene);
	ASSERT_EQ(tips.size(), 2u);
	EXPECT_LT(Distance(tips[0], body), 0.01);
	EXPECT_LT(Distance(tips[1], tip), 0.01);
}

TEST(BladeEnds, EachPointOfAStarHasOneTipHalfWayUp)
{
	constexpr double height = 0.25, near = 0.1;
	for (const int points : {4, 5, 6}) {
		const shapes::Soup soup = star(points, height);
		const std::vector<Point3d> tips = curves::tips(
			skeletonize(soup.points, soup.triangles, Parameters(), Progress(), Observer()).curve);
		EXPECT_EQ(tips.size(), size_t(points));
		for (int i = 0; i < points; ++i) {
			const double angle = 2 * M_PI * i / points + 0.2;
			const Point3d middle(std::cos(angle), std::sin(angle), height / 2);
			EXPECT_TRUE(std::any_of(tips.begin(), tips.end(),
				[&](const Point3d& tip) { return Distance(tip, middle) < near; }))
				<< "point " << i << " of " << points;
		}
	}
}
