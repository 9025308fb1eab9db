// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/flow.h>
#include <skeleton/flow/stage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

} // namespace

TEST(Stage, ZeroIsTheSurface)
{
	const shapes::Soup soup =
		shapes::joined({shapes::box(1, 2, 3), shapes::moved(shapes::torus(), {5, 0, 0})});
	const Stage stage = checks::plainStage(soup.mesh());
	EXPECT_EQ(checks::stageError(stage), "");
	EXPECT_EQ(stage.mesh.position, soup.points);
	EXPECT_EQ(*stage.surface, soup.points);
	EXPECT_EQ(stage.iteration, 0);
	EXPECT_FALSE(stage.converged);
	EXPECT_EQ(stage.areaFraction(), 1);
	EXPECT_EQ(stage.volumeFraction(), 1);
	EXPECT_EQ(stage.fixedFraction(), 0);
	std::vector<int> itself(soup.points.size());
	std::iota(itself.begin(), itself.end(), 0);
	EXPECT_EQ(stage.node, itself);
}

TEST(Stage, MeasuresEachComponentByItself)
{
	const Stage stage = checks::plainStage(
		shapes::joined({shapes::box(1, 2, 3), shapes::moved(shapes::box(2, 2, 2), {9, 9, 9})})
			.mesh());
	ASSERT_EQ(stage.diagonal.size(), 2u);
	EXPECT_DOUBLE_EQ(stage.diagonal[0], std::sqrt(14.0));
	EXPECT_DOUBLE_EQ(stage.diagonal[1], std::sqrt(12.0));
	EXPECT_DOUBLE_EQ(stage.initialArea[0], 22);
	EXPECT_DOUBLE_EQ(stage.initialArea[1], 24);
	EXPECT_DOUBLE_EQ(stage.initialVolume, 14);
}

TEST(Stage, FractionsAreOfTheWhole)
{
	Stage stage = checks::plainStage(shapes::box().mesh());
	stage.area = {1.5};
	stage.volume = 0.25;
	stage.fixed = {1, 1, 0, 0, 0, 0, 0, 0};
	EXPECT_DOUBLE_EQ(stage.areaFraction(), 0.25);
	EXPECT_DOUBLE_EQ(stage.volumeFraction(), 0.25);
	EXPECT_DOUBLE_EQ(stage.fixedFraction(), 0.25);
	stage.volume = -0.001; // limbs that have contracted turn inside out
	EXPECT_EQ(stage.volumeFraction(), 0);
	EXPECT_EQ(figuresOf(stage).volumeFraction, 0);
}

TEST(Stage, RadiusIsTheMeanDistanceToTheMergedSurface)
{
	const std::vector<Point3d> position = {{0, 0, 0}, {10, 0, 0}, {5, 5, 5}};
	const std::vector<Point3d> surface = {{1, 0, 0}, {0, 3, 0}, {10, 0, 4}, {99, 99, 99}};
	EXPECT_EQ(
		meanSurfaceDistance(position, surface, {0, 0, 1, -1}), std::vector<double>({2, 4, -1}));
}

TEST(Stage, AVertexMadeByASplitHasItsNeighboursRadius)
{
	Stage stage = checks::plainStage(shapes::octahedron().mesh());
	// Three vertices have no surface vertex; the others stand for points at distance 2.
	stage.surface = std::make_shared<const std::vector<Point3d>>(
		std::vector<Point3d> {stage.mesh.position[0] + Point3d(2, 0, 0),
			stage.mesh.position[1] + Point3d(0, 2, 0), stage.mesh.position[2] + Point3d(0, 0, 2)});
	stage.node = {0, 1, 2};
	for (double r : stageRadius(stage))
		EXPECT_DOUBLE_EQ(r, 2);
}

TEST(Stage, RadiiSpreadFromRingToRing)
{
	// The surface has merged into a vertex at one end. Other radii are means of equal ones, and of
	// 20000 rings each is found from the one before.
	std::vector<std::pair<double, double>> profile = {{0, 0}};
	for (int i = 1; i <= 20000; ++i)
		profile.emplace_back(i, 1);
	profile.emplace_back(20001, 0);
	Stage stage = checks::plainStage(shapes::revolved(profile, 3).mesh());
	std::fill(stage.node.begin(), stage.node.end(), 0);
	int asked = 0;
	const std::vector<double> radius =
		stageRadius(stage, Progress([&](int, const char*) { return ++asked > 0; }));
	for (double r : radius)
		ASSERT_DOUBLE_EQ(r, radius[0]);
	// Looking at all the unknown vertices in each round, it would ask 20000 times.
	EXPECT_LT(asked, 100);
	asked = 0;
	EXPECT_THROW(
		stageRadius(stage, Progress([&](int, const char*) { return ++asked < 3; })), Cancelled);
}

TEST(Stage, EachRoundTakesTheMeanOfAllThatWereKnownBefore)
{
	Stage stage = checks::plainStage(shapes::torus(1, 0.3, 40, 12).mesh());
	std::mt19937 random(1);
	for (int& node : stage.node)
		node = int(random() % 5) * 90;
	const std::vector<double> found = stageRadius(stage);
	std::vector<double> expected =
		meanSurfaceDistance(stage.mesh.position, *stage.surface, stage.node);
	for (bool isAnyLeft = true; isAnyLeft;) {
		isAnyLeft = false;
		const std::vector<double> before = expected;
		for (int v = 0; v < stage.mesh.vertexSlots(); ++v) {
			double sum = 0;
			int count = 0;
			stage.mesh.forEachOutgoing(v, [&](int h) {
				const double r = before[stage.mesh.target(h)];
				sum += r >= 0 ? r : 0;
				count += r >= 0;
			});
			if (before[v] < 0 && count > 0)
				expected[v] = sum / count;
			isAnyLeft |= expected[v] < 0;
		}
	}
	EXPECT_EQ(found, expected);
}

TEST(Stage, RadiiOfASphereAtItsCentre)
{
	Stage stage = contractToSkeleton(checks::plainStage(shapes::sphere(3).mesh()), Parameters());
	for (double r : stageRadius(stage))
		EXPECT_NEAR(r, 1, 0.05);
}
