// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/resample/resample.h>
#include <skeleton/resample/target_length.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vcg::tri::mcf;

TEST(TargetLength, GivesAShapeAsManyVerticesAsThePapersModels)
{
	for (const shapes::Soup& soup :
		{shapes::sphere(3), shapes::torus(1, 0.1), shapes::box(1, 1, 4)}) {
		const SurfaceMesh surface = soup.mesh();
		const SurfaceMesh mesh = resample(surface, defaultTargetLength(surface), 5);
		EXPECT_GT(mesh.vertexCount(), 35000);
		EXPECT_LT(mesh.vertexCount(), 72000);
	}
}

TEST(TargetLength, ComponentsShareTheVertices)
{
	const SurfaceMesh surface =
		shapes::joined({shapes::sphere(3), shapes::moved(shapes::torus(), {5, 0, 0})}).mesh();
	const std::vector<double> length = defaultTargetLength(surface);
	ASSERT_EQ(length.size(), 2u);
	const double alone = defaultTargetLength(shapes::torus().mesh())[0];
	EXPECT_NEAR(length[1] / alone, std::sqrt(2.0), 1e-9);
}

TEST(TargetLength, StaysWithinEightEpsilonHoweverManyComponents)
{
	shapes::Soup soup;
	for (int i = 0; i < 70; ++i)
		soup = shapes::joined({soup, shapes::moved(shapes::sphere(1, 1.0 + i), {0, 0, 200.0 * i})});
	const SurfaceMesh surface = soup.mesh();
	Parameters parameters;
	const std::vector<double> length = defaultTargetLength(surface, parameters);
	ASSERT_EQ(length.size(), 70u);
	for (int i = 0; i < 70; ++i) {
		const double diagonal = 2 * std::sqrt(3.0) * (1 + i);
		EXPECT_LE(length[i], 8 * parameters.epsilon * diagonal * (1 + 1e-12));
		EXPECT_GT(length[i], 4 * parameters.epsilon * diagonal);
	}
	parameters.epsilon = 0.0005;
	EXPECT_NEAR(defaultTargetLength(surface, parameters)[0] / length[0], 0.25, 1e-9);
}

TEST(TargetLength, TheUsersFractionIsOfEachComponentsDiagonal)
{
	const SurfaceMesh surface =
		shapes::joined({shapes::box(1, 2, 2), shapes::moved(shapes::box(2, 3, 6), {9, 9, 9})})
			.mesh();
	Parameters parameters;
	parameters.targetLength = 0.01;
	const std::vector<double> length = defaultTargetLength(surface, parameters);
	ASSERT_EQ(length.size(), 2u);
	EXPECT_NEAR(length[0], 0.03, 1e-15);
	EXPECT_NEAR(length[1], 0.07, 1e-15);
}

TEST(TargetLength, GrowsWithTheShape)
{
	const double length = defaultTargetLength(shapes::torus().mesh())[0];
	EXPECT_NEAR(
		defaultTargetLength(shapes::scaled(shapes::torus(), 1e6).mesh())[0] / length, 1e6, 1);
}

TEST(TargetLength, ManySlenderBodiesTogetherGetNoMoreCutsThanOne)
{
	shapes::Soup soup;
	for (int i = 0; i < 6000; ++i) {
		const int first = int(soup.points.size());
		const shapes::Soup hair = shapes::moved(shapes::box(1, 1e-3, 1e-3), {0, 0.01 * i, 0});
		soup.points.insert(soup.points.end(), hair.points.begin(), hair.points.end());
		for (const auto& [a, b, c] : hair.triangles)
			soup.triangles.push_back({first + a, first + b, first + c});
	}
	const SurfaceMesh surface = soup.mesh();
	const MeasuredSurface measured(surface);
	const std::vector<double> cuts =
		cutsOfLongEdges(measured, defaultTargetLength(measured, Parameters()));
	EXPECT_LE(std::accumulate(cuts.begin(), cuts.end(), 0.0), 2.1e6);
	// A single one keeps its length beside a large one that takes most of the cuts.
	const shapes::Soup hair = shapes::box(1, 1e-3, 1e-3);
	const shapes::Soup needle = shapes::moved(shapes::box(1, 1e-9, 1e-9), {0, 1, 0});
	EXPECT_EQ(defaultTargetLength(shapes::joined({hair, needle}).mesh())[0],
		defaultTargetLength(shapes::joined({hair, shapes::moved(hair, {0, 1, 0})}).mesh())[0]);
}
