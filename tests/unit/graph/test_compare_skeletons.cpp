// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Closest points of curves, and distances between skeletons with known answers.

#include "curves.h"
#include <skeleton/graph/compare_skeletons.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

double distanceByTryingAll(const CurveSkeleton& s, const Point3d& q)
{
	double best = std::numeric_limits<double>::max();
	for (const Point3d& p : s.position)
		best = std::min(best, vcg::Distance(p, q));
	for (const auto& [i, j] : s.edges) {
		const Point3d a = s.position[i], d = s.position[j] - a;
		const double t = (q - a) * d / d.SquaredNorm();
		if (t > 0 && t < 1)
			best = std::min(best, vcg::Distance(a + d * t, q));
	}
	return best;
}

/// Edges from very long to very short, and an isolated node.
CurveSkeleton uneven()
{
	CurveSkeleton s = circle(3, 1, 7);
	addLine(s, 0, {100, 1, 2}, 1, 1);
	addLine(s, 3, {-3, -0.2, 0.1}, 1, 300);
	addNode(s, {0, 0, 9}, 1);
	return s;
}

TEST(ClosestCurve, IsTheClosestOfAllEdges)
{
	const CurveSkeleton s = uneven();
	const ClosestCurve curve(s);
	std::mt19937 random(3);
	std::uniform_real_distribution<double> number(-12, 12);
	for (int i = 0; i < 2000; ++i) {
		const Point3d q(number(random), number(random), number(random));
		const ClosestCurve::Hit hit = curve.closest(q);
		EXPECT_NEAR(hit.distance, distanceByTryingAll(s, q), 1e-12);
		EXPECT_DOUBLE_EQ(hit.distance, vcg::Distance(hit.point, q));
		if (hit.edge >= 0) {
			const Point3d a = s.position[s.edges[hit.edge][0]];
			const Point3d b = s.position[s.edges[hit.edge][1]];
			EXPECT_LT(vcg::Distance(hit.point, a + (b - a) * hit.part), 1e-12);
		}
		else
			EXPECT_EQ(hit.point, Point3d(0, 0, 9));
	}
}

TEST(ClosestCurve, SingleNode)
{
	CurveSkeleton s;
	addNode(s, {1, 2, 3}, 1);
	EXPECT_DOUBLE_EQ(ClosestCurve(s).closest({1, 2, 5}).distance, 2);
}

TEST(CurveSamples, StandForTheWholeLength)
{
	const CurveSkeleton s = uneven();
	const CurveSamples samples = curveSamples(s, 0.07);
	double sum = 0;
	for (double w : samples.weight) {
		EXPECT_LE(w, 0.07 * (1 + 1e-12));
		sum += w;
	}
	EXPECT_NEAR(sum, statistics(s).length, 1e-9);
}

TEST(CompareSkeletons, WithItselfIsZero)
{
	const SkeletonDistance d = distanceToSkeleton(uneven(), uneven(), 0.01);
	EXPECT_LT(d.mean, 1e-12);
	EXPECT_LT(d.greatest, 1e-12);
}

TEST(CompareSkeletons, MovedAsideByHowMuch)
{
	const CurveSkeleton a = line({0, 0, 0}, {10, 0, 0}, 1, 3),
						b = line({0, 1, 0}, {10, 1, 0}, 1, 7);
	const SkeletonDistance d = distanceToSkeleton(a, b, 0.01);
	EXPECT_NEAR(d.mean, 1, 1e-12);
	EXPECT_NEAR(d.greatest, 1, 1e-12);
	for (double x : d.ofNode)
		EXPECT_NEAR(x, 1, 1e-12);
	EXPECT_EQ(d.ofNode.size(), a.position.size());
}

TEST(CompareSkeletons, IsAsymmetric)
{
	// Half of a line against the whole of it: from 5 to 10 the distances rise from 0 to 5.
	const CurveSkeleton whole = line({0, 0, 0}, {10, 0, 0}, 1, 3);
	const CurveSkeleton half = line({0, 0, 0}, {5, 0, 0}, 1, 4);
	EXPECT_NEAR(distanceToSkeleton(half, whole, 0.01).greatest, 0, 1e-12);
	const SkeletonDistance d = distanceToSkeleton(whole, half, 0.01);
	EXPECT_NEAR(d.mean, 1.25, 0.001);
	EXPECT_NEAR(d.greatest, 5, 1e-12);
}

TEST(CompareSkeletons, DoesNotDependOnTheNodes)
{
	// The mean is over the length: many nodes in one place count for nothing.
	CurveSkeleton crowded = line({0, 0, 0}, {0.01, 0, 0}, 1, 500);
	addLine(crowded, 500, {10, 0, 0}, 1, 1);
	const CurveSkeleton sparse = line({0, 0, 0}, {10, 0, 0}, 1, 1);
	const CurveSkeleton other = line({0, 0, 0}, {10, 4, 0}, 1, 9);
	const SkeletonDistance a = distanceToSkeleton(crowded, other, 0.01);
	const SkeletonDistance b = distanceToSkeleton(sparse, other, 0.01);
	EXPECT_NEAR(a.mean, b.mean, 1e-3);
	EXPECT_NEAR(a.greatest, b.greatest, 1e-9);
	const SkeletonDistance back = distanceToSkeleton(other, crowded, 0.01);
	EXPECT_NEAR(back.mean, distanceToSkeleton(other, sparse, 0.01).mean, 1e-9);
}

TEST(CompareSkeletons, ConcentricCircles)
{
	const SkeletonDistance d = distanceToSkeleton(circle(3, 1, 2000), circle(2, 1, 2000), 0.01);
	EXPECT_NEAR(d.mean, 1, 1e-4);
	EXPECT_NEAR(d.greatest, 1, 1e-4);
}

TEST(CompareSkeletons, ScaleDoesNotMatter)
{
	const CurveSkeleton a = uneven(), b = circle(3, 1, 100);
	const SkeletonDistance expected = distanceToSkeleton(a, b, 0.01);
	for (double scale : {1e-6, 1e6}) {
		CurveSkeleton c = a, d = b;
		for (Point3d& p : c.position)
			p *= scale;
		for (Point3d& p : d.position)
			p *= scale;
		EXPECT_NEAR(distanceToSkeleton(c, d, 0.01 * scale).mean / scale, expected.mean, 1e-6);
	}
}

TEST(CompareSkeletons, PointsWithoutEdges)
{
	CurveSkeleton a, b;
	addNode(a, {0, 0, 0}, 1);
	addNode(a, {4, 0, 0}, 1);
	addNode(b, {1, 0, 0}, 1);
	const SkeletonDistance d = distanceToSkeleton(a, b, 0.01);
	EXPECT_DOUBLE_EQ(d.mean, 2);
	EXPECT_DOUBLE_EQ(d.greatest, 3);
}

TEST(CompareSkeletons, RefusesWhatItCannotCompare)
{
	const CurveSkeleton s = circle(3, 1, 10);
	EXPECT_THROW(distanceToSkeleton(s, CurveSkeleton(), 0.1), InvalidInput);
	EXPECT_THROW(distanceToSkeleton(CurveSkeleton(), s, 0.1), InvalidInput);
	EXPECT_THROW(distanceToSkeleton(s, s, 0), InvalidParameter);
	EXPECT_THROW(distanceToSkeleton(s, s, 1e-12), InvalidParameter);
}

} // namespace
