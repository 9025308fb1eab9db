// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Measures of skeletons of which they are known: moved aside, outside, half, with a spur.

#include "curves.h"
#include "shapes.h"
#include <skeleton/measure/skeleton_measures.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

/// Coarser than by default, in a tenth of the time.
SkeletonMeasures measured(const CurveSkeleton& s, const SurfaceMesh& mesh)
{
	MeasureSampling sampling;
	sampling.spacing = 0.004;
	sampling.medialPoints = 8000;
	sampling.surfacePoints = sampling.innerPoints = 4000;
	return skeletonMeasures(s, mesh, sampling);
}

/// Radius 1, axis from -3 to 3 along x: diagonal of 8 x 2 x 2.
const double capsuleDiagonal = std::sqrt(64.0 + 4 + 4);

const SurfaceMesh& capsule()
{
	static const SurfaceMesh mesh = shapes::capsule(6, 1, 64).mesh();
	return mesh;
}

CurveSkeleton axis(const Point3d& moved = {0, 0, 0}, double end = 3)
{
	return line(Point3d(-3, 0, 0) + moved, Point3d(end, 0, 0) + moved, 1, 60);
}

TEST(SkeletonMeasures, OfACapsulesAxisArePerfect)
{
	const SkeletonMeasures m = measured(axis(), capsule());
	EXPECT_EQ(m.insideFraction, 1);
	EXPECT_EQ(m.outDepthMax, 0);
	EXPECT_LT(m.medialMean, 0.0005);
	EXPECT_LT(m.offCentreMean, 0.005);
	EXPECT_NEAR(m.coverMean, 1 / capsuleDiagonal, 0.0005);
	EXPECT_LT(m.reconMean, 0.0005);
	EXPECT_GT(m.volumeFraction, 0.99);
	EXPECT_EQ(m.spurs, 0);
	for (double d : m.nodeClearance)
		EXPECT_NEAR(d, 1, 0.005);
}

TEST(SkeletonMeasures, ACavityThatIsTurnedInwardIsOutside)
{
	const shapes::Soup hollow =
		shapes::joined({shapes::capsule(6, 1, 64), shapes::insideOut(shapes::capsule(3, 0.5, 32))});
	const SkeletonMeasures m = measured(axis(), hollow.mesh());
	// The cavity reaches from -2 to 2 along the axis, which reaches from -3 to 3.
	EXPECT_NEAR(m.insideFraction, 1.0 / 3, 0.01);
	EXPECT_NEAR(m.outDepthMax, 0.5 / capsuleDiagonal, 0.003);
}

TEST(SkeletonMeasures, MovedAsideByHalfTheRadius)
{
	const SkeletonMeasures m = measured(axis({0, 0.5, 0}), capsule());
	EXPECT_NEAR(m.medialMean, 0.5 / capsuleDiagonal, 0.001);
	EXPECT_NEAR(m.medialP95, 0.5 / capsuleDiagonal, 0.001);
	EXPECT_NEAR(m.offCentreMean, 0.5, 0.01);
	EXPECT_EQ(m.insideFraction, 1);
	for (double d : m.nodeMedialDistance)
		EXPECT_NEAR(d, 0.5, 0.01);
}

TEST(SkeletonMeasures, OutsideIsOutsideAndHowFar)
{
	const SkeletonMeasures m = measured(axis({0, 1.2, 0}), capsule());
	EXPECT_EQ(m.insideFraction, 0);
	EXPECT_NEAR(m.outDepthMax, (std::hypot(1.2, 0) - 1) / capsuleDiagonal, 0.001);
	EXPECT_EQ(m.volumeFraction, 0);
	EXPECT_GT(m.offCentreMean, 1);
}

TEST(SkeletonMeasures, HalfOutside)
{
	// From the middle of one end straight on: 3 inside the ball's end, 1 of it, then outside.
	const SkeletonMeasures m = measured(line({0, 0, 0}, {8, 0, 0}, 1, 10), capsule());
	EXPECT_NEAR(m.insideFraction, 0.5, 0.002);
	EXPECT_NEAR(m.outDepthMax, 4 / capsuleDiagonal, 0.001);
}

TEST(SkeletonMeasures, WhatIsMissingShowsInReconstruction)
{
	const SkeletonMeasures m = measured(axis({0, 0, 0}, 0), capsule());
	EXPECT_LT(m.medialMean, 0.0005);
	EXPECT_NEAR(m.reconMax, 3 / capsuleDiagonal, 0.002);
	const double half = (4.0 / 3 + 3) * M_PI, whole = (4.0 / 3 + 6) * M_PI;
	EXPECT_NEAR(m.volumeFraction, half / whole, 0.01);
	EXPECT_NEAR(m.coverMax, 4 / capsuleDiagonal, 0.002);
}

TEST(SkeletonMeasures, ASpurIsFound)
{
	CurveSkeleton s = axis();
	addLine(s, 30, {0, 0.3, 0}, 1, 3);
	EXPECT_EQ(measured(s, capsule()).spurs, 1);
}

TEST(SkeletonMeasures, ASkeletonWithoutRadiiIsMeasuredAlike)
{
	CurveSkeleton s = axis();
	addLine(s, 30, {0, 0.3, 0}, 1, 3);
	const SkeletonMeasures expected = measured(s, capsule());
	s.radius.clear();
	const SkeletonMeasures m = measured(s, capsule());
	EXPECT_EQ(m.spurs, 1);
	EXPECT_EQ(m.medialMean, expected.medialMean);
	EXPECT_EQ(m.nodeClearance, expected.nodeClearance);
}

TEST(SkeletonMeasures, OfANeedleThinnerThanAnyBallOfTheReferenceAreFinite)
{
	constexpr double radius = 5e-5;
	const SurfaceMesh needle = shapes::capsule(1, radius, 12).mesh();
	const auto measuredAt = [&](double aside) {
		return measured(line({-0.45, aside, 0}, {0.45, aside, 0}, 1, 50), needle);
	};
	const SkeletonMeasures centred = measuredAt(0), outside = measuredAt(0.1);
	EXPECT_EQ(centred.insideFraction, 1);
	EXPECT_LT(centred.medialMax, radius / 2);
	EXPECT_LT(centred.offCentreMean, 0.1);
	for (double d : centred.nodeMedialDistance)
		EXPECT_LT(d, radius / 2);
	EXPECT_NEAR(outside.medialMean, 0.1, 2 * radius);
	EXPECT_NEAR(outside.medialMax, 0.1, 2 * radius);
	EXPECT_NEAR(outside.medialP95, 0.1, 2 * radius);
	EXPECT_NEAR(outside.offCentreMean, 2, 1e-9);
}

TEST(SkeletonMeasures, CircleOfATorus)
{
	const SurfaceMesh torus = shapes::torus(3, 0.8, 192, 64).mesh();
	const SkeletonMeasures m = measured(circle(3, 0.8, 200), torus);
	EXPECT_LT(m.medialMean, 0.0005);
	EXPECT_LT(m.reconMean, 0.0005);
	EXPECT_EQ(m.insideFraction, 1);
}

TEST(SkeletonMeasures, TheMiddleSheetOfABoxIsMedialAnywhere)
{
	const SurfaceMesh box = shapes::moved(shapes::cells(
											  32, 16, 8, [](int, int, int) { return true; }, 0.125),
		{-2, -1, -0.5})
								.mesh();
	const double diagonal = std::sqrt(16.0 + 4 + 1);
	const auto lineAt = [](double y, double z) { return line({-1.4, y, z}, {1.4, y, z}, 1, 56); };
	const SkeletonMeasures on = measured(lineAt(0.2, 0), box);
	EXPECT_LT(on.medialMean, 0.0005);
	EXPECT_GT(on.volumeFraction, 0.2);
	EXPECT_LT(on.volumeFraction, 0.8);
	EXPECT_NEAR(measured(lineAt(0, 0.2), box).medialMean, 0.2 / diagonal, 0.002);
}

TEST(SkeletonMeasures, ScaleAndPlaceDoNotMatter)
{
	const SkeletonMeasures expected = measured(axis({0, 0.5, 0}), capsule());
	for (double scale : {1e-6, 1e6}) {
		const auto map = [&](const Point3d& p) { return p * scale + Point3d(0, 7 * scale, 0); };
		CurveSkeleton s = axis({0, 0.5, 0});
		SurfaceMesh mesh = capsule();
		for (Point3d& p : s.position)
			p = map(p);
		for (Point3d& p : mesh.position)
			p = map(p);
		const SkeletonMeasures m = measured(s, mesh);
		EXPECT_NEAR(m.medialMean, expected.medialMean, 1e-4);
		EXPECT_NEAR(m.reconMean, expected.reconMean, 1e-4);
		EXPECT_NEAR(m.insideFraction, expected.insideFraction, 1e-4);
		EXPECT_NEAR(m.nodeClearance[30] / scale, expected.nodeClearance[30], 1e-6);
	}
}

TEST(SkeletonMeasures, RefusesWhatCannotBeMeasured)
{
	EXPECT_THROW(measured(CurveSkeleton(), capsule()), InvalidInput);
	EXPECT_THROW(measured(line({0, 0, 0}, {1e9, 0, 0}, 1, 1), capsule()), InvalidInput);
	EXPECT_THROW(
		skeletonMeasures(axis(), capsule(), {}, Progress([](int, const char*) { return false; })),
		Cancelled);
}

TEST(SurfaceSamples, AsManyAsTheAreaAsksFor)
{
	const SurfaceMesh box = shapes::box(4, 2, 1).mesh();
	int onTop = 0;
	const auto samples = surfaceSamples(box, 28000);
	for (const SurfaceSample& s : samples) {
		onTop += std::abs(s.position[2] - 1) < 1e-12;
		const Point3d n = box.doubleAreaVector(s.face);
		EXPECT_NEAR((s.position - box.position[box.triangle(s.face)[0]]) * n, 0, 1e-9);
	}
	EXPECT_EQ(samples.size(), 28000u);
	EXPECT_NEAR(onTop, 8000, 4);
}

} // namespace
