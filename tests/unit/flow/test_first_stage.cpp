// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/flow/first_stage.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A ball and a ring, dense and of different sizes; the flow's lengths are those of each alone.
shapes::Soup denseScene()
{
	return shapes::joined({shapes::sphere(6),
		shapes::moved(shapes::scaled(shapes::torus(1, 0.3, 240, 80), 10), {40, 0, 0})});
}

Parameters coarseFlow()
{
	Parameters parameters;
	parameters.epsilon = 0.02;
	return parameters;
}

} // namespace

TEST(FirstStage, KeepsTheTopologyAndASubsetOfTheVertices)
{
	const SurfaceMesh surface = denseScene().mesh();
	const Stage stage = firstStageOf(surface, coarseFlow());
	EXPECT_EQ(checks::stageError(stage), "");
	EXPECT_EQ(stage.mesh.eulerCharacteristic(), surface.eulerCharacteristic());
	EXPECT_LT(stage.mesh.vertexCount(), surface.vertexCount() / 4);
	std::set<Point3d> places(surface.position.begin(), surface.position.end());
	for (const Point3d& p : stage.mesh.position)
		EXPECT_EQ(places.count(p), 1u);
}

TEST(FirstStage, EachVertexOfTheSurfaceKeepsANodeNearby)
{
	const SurfaceMesh surface = denseScene().mesh();
	const Stage stage = firstStageOf(surface, coarseFlow());
	const std::vector<int> component = connectedComponents(surface);
	std::vector<int> merged(stage.mesh.vertexSlots(), 0);
	ASSERT_EQ(stage.node.size(), size_t(surface.vertexSlots()));
	for (int v = 0; v < surface.vertexSlots(); ++v) {
		const int node = stage.node[v];
		++merged[node];
		ASSERT_EQ(stage.component[node], component[v]);
		ASSERT_LT(Distance(surface.position[v], stage.mesh.position[node]),
			0.15 * stage.diagonal[component[v]]);
	}
	for (int count : merged)
		EXPECT_GT(count, 0);
}

TEST(FirstStage, PolesAreMeasuredAgainstTheWholeSurface)
{
	// Against the vertices that remain alone the balls would be larger where they bend away.
	const SurfaceMesh surface = denseScene().mesh();
	Parameters parameters;
	parameters.epsilon = 0.0045;
	const Stage stage = firstStageOf(surface, parameters);
	ASSERT_LT(stage.mesh.vertexCount(), surface.vertexCount());
	ASSERT_GT(stage.mesh.vertexCount(), surface.vertexCount() / 2);
	const PoleSet all = medialPoles(surface, PoleMethod::Balls);
	std::map<Point3d, int> vertexAt;
	for (int v = 0; v < surface.vertexSlots(); ++v)
		vertexAt[surface.position[v]] = v;
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v) {
		const double radius = stage.component[v] == 0 ? 1 : 3;
		ASSERT_NEAR(stage.poleRadius[v], radius, 0.02 * radius);
		ASSERT_NEAR(
			stage.poleRadius[v], all.radius[vertexAt.at(stage.mesh.position[v])], 0.005 * radius);
	}
}

TEST(FirstStage, TakesThePolesThatAreKnown)
{
	const SurfaceMesh surface = denseScene().mesh();
	PoleSet poles;
	for (int v = 0; v < surface.vertexSlots(); ++v) {
		poles.centre.push_back(surface.position[v] / 2.0);
		poles.radius.push_back(v % 3 == 0 ? -1 : surface.position[v].Norm() / 2);
	}
	const Stage stage = firstStage(surface, coarseFlow(), poles);
	int without = 0;
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v) {
		ASSERT_EQ(stage.pole[v], stage.mesh.position[v] / 2.0);
		without += stage.poleRadius[v] < 0;
	}
	EXPECT_GT(without, 0);
	EXPECT_LT(without, stage.mesh.vertexCount());
}

TEST(FirstStage, FractionsAreOfTheSurfaceItself)
{
	const SurfaceMesh surface = denseScene().mesh();
	const Stage stage = firstStageOf(surface, coarseFlow());
	EXPECT_DOUBLE_EQ(stage.initialVolume, surface.volume());
	EXPECT_NEAR(stage.initialArea[0] + stage.initialArea[1], surface.area(), 1e-9 * surface.area());
	EXPECT_NEAR(stage.diagonal[0], std::sqrt(12.0), 1e-6);
	EXPECT_LT(stage.volumeFraction(), 1);
	EXPECT_GT(stage.volumeFraction(), 0.9);
	EXPECT_GT(stage.areaFraction(), 0.9);
}

TEST(FirstStage, LeavesASurfaceOfEdgesAboveEpsilonAsItIs)
{
	const SurfaceMesh surface = shapes::torus().mesh();
	const Stage stage = firstStageOf(surface, Parameters());
	EXPECT_EQ(stage.mesh.vertexCount(), surface.vertexCount());
	for (int v = 0; v < surface.vertexSlots(); ++v)
		EXPECT_EQ(stage.mesh.position[stage.node[v]], surface.position[v]);
}

TEST(FirstStage, CanBeCancelledAtAnyReport)
{
	const SurfaceMesh surface = denseScene().mesh();
	const PoleSet poles = medialPoles(surface, PoleMethod::Balls);
	int reports = 0, last = 0;
	firstStage(surface, coarseFlow(), poles, Progress([&](int percent, const char*) {
		EXPECT_GE(percent, last);
		last = percent;
		return ++reports > 0;
	}));
	ASSERT_GT(reports, 10);
	for (int stopAt = 1; stopAt <= reports; stopAt += 1 + reports / 20) {
		int count = 0;
		const Progress progress([&](int, const char*) { return ++count < stopAt; });
		EXPECT_THROW(firstStage(surface, coarseFlow(), poles, progress), Cancelled);
		EXPECT_EQ(count, stopAt);
	}
}
