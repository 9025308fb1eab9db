// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Ways there and back within a branch; sharp ones, and tips beside branches, are in test_refine.cpp.

#include "curve_in_shape.h"
#include "mesh_checks.h"

#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/refine/folds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using curves::CurveMaker;
using vcg::Point3d;

namespace {

constexpr double tubeRadius = 0.35;

/// Adds a way from point to point, with a node every twentieth.
CurveMaker wayThrough(const std::vector<Point3d>& points, CurveMaker maker = CurveMaker())
{
	for (size_t i = 1; i < points.size(); ++i)
		maker.line(points[i - 1], points[i],
			std::max(1, int(std::ceil(20 * Distance(points[i - 1], points[i])))));
	return maker;
}

/// A curve in a tube along the x axis from -2 to 2, each node its own source.
struct InTube : CurveInShape
{
	explicit InTube(const std::vector<Point3d>& way) :
			CurveInShape(shapes::capsule(4, tubeRadius, 32), wayThrough(way))
	{
		curve = curves::tracked(curve);
		refining::measureNodes(curve, clearances);
	}
};

CurveSkeleton withoutHairpins(const CurveInShape& scene)
{
	return refining::withoutHairpins(scene.curve, scene.closest);
}

} // namespace

TEST(Hairpins, AWayThereAndBackWithWideTurnsBecomesOneWayThere)
{
	const InTube scene({{-1.9, 0, 0}, {0.5, 0, 0}, {0.6, 0.04, 0}, {0.5, 0.08, 0}, {-0.5, 0.08, 0},
		{-0.6, 0.08, 0.04}, {-0.5, 0.08, 0.08}, {1.9, 0, 0}});
	const CurveSkeleton straight = withoutHairpins(scene);
	EXPECT_EQ(checks::skeletonError(straight), "");
	EXPECT_GT(statistics(scene.curve).length, 5.8);
	EXPECT_LT(statistics(straight).length, 1.05 * 3.8);
	EXPECT_EQ(curves::tips(straight), scene.tips());
	for (int node : straight.node)
		EXPECT_GE(node, 0) << "what had merged into a node is at another one";
}

TEST(Hairpins, OfOneWithinAnotherNothingIsLeft)
{
	const InTube scene({{-1.9, 0, 0}, {1, 0, 0}, {1.05, 0.04, 0}, {1, 0.08, 0}, {-1, 0.08, 0},
		{-1.05, 0.08, 0.04}, {-1, 0.08, 0.08}, {0.7, 0.08, 0.08}, {0.75, 0.04, 0.08},
		{0.7, 0, 0.08}, {-0.6, 0, 0.08}, {-0.65, -0.04, 0.04}, {-0.6, -0.08, 0}, {1.9, 0, 0}});
	EXPECT_LT(statistics(withoutHairpins(scene)).length, 1.05 * 3.8);
}

TEST(Hairpins, ABranchThatComesBackBeforeItsTipEndsWhereItTurns)
{
	for (const bool isReversed : {false, true}) {
		std::vector<Point3d> way = {
			{-1.9, 0, 0}, {1.2, 0, 0}, {1.3, 0.05, 0}, {1.2, 0.1, 0}, {0, 0.1, 0}};
		if (isReversed)
			std::reverse(way.begin(), way.end());
		const CurveSkeleton shorter = withoutHairpins(InTube(way));
		EXPECT_NEAR(statistics(shorter).length, 3.2, 0.15) << isReversed;
		std::vector<Point3d> tips = curves::tips(shorter);
		ASSERT_EQ(tips.size(), 2u);
		std::sort(tips.begin(), tips.end(),
			[](const Point3d& a, const Point3d& b) { return a[0] < b[0]; });
		EXPECT_NEAR(tips[0][0], -1.9, 1e-9);
		EXPECT_NEAR(tips[1][0], 1.25, 0.1);
	}
}

TEST(Hairpins, StrandsMoreThanHalfARadiusApartStay)
{
	// A way to a bend and back, `apart` from each other, in a tube of radius 0.35.
	const auto length = [](double apart) {
		return statistics(withoutHairpins(InTube({{-1.9, -apart / 2, 0}, {1, -apart / 2, 0},
							  {1, apart / 2, 0}, {-0.8, apart / 2, 0}})))
			.length;
	};
	EXPECT_LT(length(0.1), 3.1);
	EXPECT_GT(length(0.3), 4.9);
}

TEST(Hairpins, ABendStaysHoweverThickTheBodyAroundIt)
{
	CurveInShape scene(shapes::sphere(3, 3), wayThrough({{2, 0.8, 0}, {0, 0, 0}, {2, -0.8, 0}}));
	refining::measureNodes(scene.curve, scene.clearances);
	EXPECT_EQ(withoutHairpins(scene).position, scene.curve.position) << "44 degrees";
}

TEST(Hairpins, AWayAroundAHoleStays)
{
	CurveInShape ring(shapes::torus(1, 0.3), CurveMaker());
	ring.curve = curves::circle(1, 0.3, 60);
	EXPECT_EQ(withoutHairpins(ring).edges, ring.curve.edges);
	// With a terminal branch: then the ring is a branch from its junction to there.
	curves::addLine(ring.curve, 0, {1.2, 0, 0}, 0.1, 4);
	EXPECT_EQ(withoutHairpins(ring).edges, ring.curve.edges);
}
