// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "read_off.h"
#include "shapes.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/core/segment.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using checks::skeletonError;
using vcg::Point3d;

namespace {

/// Stage 0 of a surface without poles.
/// The stage after `iterations` steps of the plain flow.
Stage stageAfter(const shapes::Soup& soup, int iterations)
{
	Parameters parameters;
	parameters.maxIterations = iterations;
	return contractToSkeleton(checks::plainStage(soup.mesh()), parameters);
}

void expectTopology(const Stage& stage, const CurveSkeleton& skeleton, int components, int genus)
{
	EXPECT_EQ(skeletonError(skeleton), "");
	EXPECT_EQ(skeleton.node.size(), stage.surface->size());
	const SkeletonStatistics s = statistics(skeleton);
	EXPECT_EQ(s.components, components);
	EXPECT_EQ(s.cycles, genus);
}

/// Nodes that no surface vertex has merged into.
int nodesWithoutSurface(const CurveSkeleton& skeleton)
{
	const std::set<int> used(skeleton.node.begin(), skeleton.node.end());
	return int(skeleton.position.size()) - int(used.size());
}

} // namespace

TEST(CollapseToCurve, EveryStageHasTheTopologyOfTheSolid)
{
	const struct
	{
		const char* name;
		shapes::Soup soup;
		int components, genus;
	} cases[] = {{"tetrahedron", shapes::tetrahedron(), 1, 0},
		{"octahedron", shapes::octahedron(), 1, 0}, {"box", shapes::box(1, 2, 3), 1, 0},
		{"sphere", shapes::sphere(2), 1, 0}, {"capsule", shapes::capsule(), 1, 0},
		{"thin tube", shapes::capsule(2, 0.1, 3), 1, 0}, {"torus", shapes::torus(), 1, 1},
		{"torus of 9 vertices", shapes::torus(1, 0.3, 3, 3), 1, 1},
		{"torus of 7 vertices", shapes::csaszarTorus(), 1, 1},
		{"plate of 1", shapes::plate(1, 1), 1, 1}, {"plate of 2", shapes::plate(2, 2), 1, 2},
		{"plate of 3", shapes::plate(3, 3), 1, 3},
		{"three bodies",
			shapes::joined({shapes::torus(), shapes::moved(shapes::sphere(2), {5, 0, 0}),
				shapes::moved(shapes::plate(2), {0, 0, 5})}),
			3, 3}};
	for (const auto& [name, soup, components, genus] : cases)
		for (int iterations : {0, 1, 2, 4, 100}) {
			SCOPED_TRACE(testing::Message() << name << ", stage " << iterations);
			const Stage stage = stageAfter(soup, iterations);
			const CurveSkeleton skeleton = collapseToCurve(stage);
			expectTopology(stage, skeleton, components, genus);
		}
}

TEST(CollapseToCurve, HolesOfThreeEdgesAreKept)
{
	for (unsigned seed = 0; seed < 30; ++seed) {
		std::mt19937 random(seed);
		const int genus = 1 + int(random() % 6);
		SurfaceMesh mesh = shapes::withTunnels(shapes::sphere(2), genus, random).mesh();
		shapes::changeAtRandom(mesh, int(random() % 2000), random);
		mesh.compact();
		ASSERT_EQ(checks::genus(mesh), genus);
		SCOPED_TRACE(testing::Message() << "seed " << seed);
		const Stage stage = checks::plainStage(mesh);
		expectTopology(stage, collapseToCurve(stage), 1, genus);
	}
}

TEST(CollapseToCurve, HoldsForAnyPositions)
{
	// Lengths decide the order only: positions at random try many orders, flat ones many ties.
	for (unsigned seed = 0; seed < 60; ++seed) {
		std::mt19937 random(seed);
		const int genus = int(random() % 5);
		SurfaceMesh mesh = shapes::withTunnels(shapes::sphere(2), genus, random).mesh();
		shapes::changeAtRandom(mesh, int(random() % 500), random);
		mesh.compact();
		for (Point3d& p : mesh.position)
			for (int k = 0; k < 3; ++k)
				p[k] = seed % 2 ? double(random() % 1000) : double(random() % 3);
		SCOPED_TRACE(testing::Message() << "seed " << seed);
		const Stage stage = checks::plainStage(mesh);
		const CurveSkeleton skeleton = collapseToCurve(stage);
		const SkeletonStatistics s = statistics(skeleton);
		EXPECT_EQ(s.components, 1);
		EXPECT_EQ(s.cycles, genus);
		EXPECT_EQ(skeletonError(skeleton, true), ""); // on a grid of 27 points, nodes may coincide
	}
}

TEST(CollapseToCurve, EveryNodeComesFromTheSurfaceBeforeAnySplit)
{
	for (const shapes::Soup& soup : {shapes::torus(), shapes::plate(3), shapes::capsule()})
		EXPECT_EQ(nodesWithoutSurface(collapseToCurve(checks::plainStage(soup.mesh()))), 0);
}

TEST(CollapseToCurve, ANodeWithoutSurfaceIsMadeOfSplitVerticesOnly)
{
	const Stage stage = stageAfter(shapes::capsule(2, 0.35, 32), 100);
	const std::set<int> used(stage.node.begin(), stage.node.end());
	const int splitVertices = stage.mesh.vertexCount() - int(used.size());
	EXPECT_LE(nodesWithoutSurface(collapseToCurve(stage)), splitVertices);
}

TEST(CollapseToCurve, CorrespondenceFollowsTheMesoSkeleton)
{
	// Surface vertices that have merged in the flow share a node; so do none of two bodies.
	const Stage stage = stageAfter(
		shapes::joined({shapes::capsule(), shapes::moved(shapes::capsule(), {0, 5, 0})}), 6);
	const CurveSkeleton skeleton = collapseToCurve(stage);
	std::vector<int> nodeOfVertex(stage.mesh.vertexCount(), -1);
	for (size_t s = 0; s < stage.node.size(); ++s) {
		int& node = nodeOfVertex[stage.node[s]];
		EXPECT_TRUE(node < 0 || node == skeleton.node[s]);
		node = skeleton.node[s];
		EXPECT_LT(std::abs(skeleton.position[node][1] - (*stage.surface)[s][1]), 1);
	}
}

TEST(CollapseToCurve, RadiusIsTheMeanDistanceOfTheMergedSurfaceFromTheEdges)
{
	const Stage stage = stageAfter(shapes::capsule(4, 0.35, 24), 100);
	const CurveSkeleton skeleton = collapseToCurve(stage);
	std::vector<double> sum(skeleton.position.size(), 0);
	std::vector<int> count(skeleton.position.size(), 0);
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	for (size_t s = 0; s < skeleton.node.size(); ++s) {
		const vcg::Point3d &p = (*stage.surface)[s], &node = skeleton.position[skeleton.node[s]];
		double nearest = vcg::Distance(p, node);
		for (int w : neighbours[skeleton.node[s]])
			nearest = std::min(
				nearest, vcg::Distance(p, closestOnSegment(node, skeleton.position[w], p).point));
		sum[skeleton.node[s]] += nearest;
		++count[skeleton.node[s]];
	}
	for (size_t v = 0; v < sum.size(); ++v) {
		if (count[v]) {
			EXPECT_NEAR(skeleton.radius[v], sum[v] / count[v], 1e-12);
		}
		else {
			EXPECT_GT(skeleton.radius[v], 0);
		}
	}
}

TEST(CollapseToCurve, ShortEdgesGoUnlessACycleWould)
{
	const Stage stage = stageAfter(shapes::torus(), 100);
	for (double shortest : {1e-4, 0.02, 0.1}) {
		const CurveSkeleton skeleton = collapseToCurve(stage, shortest);
		expectTopology(stage, skeleton, 1, 1);
		if (skeleton.edges.size() > 3) {
			for (const auto& [a, b] : skeleton.edges)
				EXPECT_GE(vcg::Distance(skeleton.position[a], skeleton.position[b]),
					shortest * stage.diagonal[0]);
		}
	}
	EXPECT_EQ(collapseToCurve(stage, 10).edges.size(), 3u); // the smallest cycle there is
	EXPECT_EQ(collapseToCurve(stageAfter(shapes::capsule(), 100), 10).edges.size(), 1u);
}

TEST(CollapseToCurve, DoesNotZigzag)
{
	// All in all, a plane convex curve turns by one full turn, a zigzag by more.
	shapes::Soup soup = shapes::torus(2, 0.5, 96, 24);
	std::mt19937 random(1);
	for (Point3d& p : soup.points)
		for (int k = 0; k < 3; ++k)
			p[k] += 0.1 * (double(random() % 1000) / 500 - 1);
	const CurveSkeleton skeleton = collapseToCurve(stageAfter(soup, 100), 0.002);
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	double turn = 0;
	for (size_t v = 0; v < neighbours.size(); ++v) {
		ASSERT_EQ(neighbours[v].size(), 2u);
		const Point3d in = skeleton.position[v] - skeleton.position[neighbours[v][0]];
		const Point3d out = skeleton.position[neighbours[v][1]] - skeleton.position[v];
		turn += std::atan2((in ^ out).Norm(), in * out);
	}
	EXPECT_LT(turn, 1.05 * 2 * M_PI);
}

TEST(CollapseToCurve, RemovesSpurs)
{
	// In a capsule about the x axis, a stub whose ball lies within the one at its foot.
	const Stage stage = checks::plainStage(shapes::capsule(2, 0.35).mesh());
	CurveSkeleton skeleton;
	skeleton.position = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}};
	skeleton.edges = {{0, 1}, {1, 2}, {1, 3}};
	skeleton.radius.assign(4, 0);
	for (const Point3d& p : *stage.surface)
		skeleton.node.push_back(p[0] < -0.5 ? 0 : p[0] > 0.5 ? 2 : p[1] > 0.3 ? 3 : 1);
	const std::vector<int> component(4, 0);
	std::vector<char> held(4, 0);
	const auto pruned = [&](double minimum) {
		return detail::withoutSpurs(skeleton, stage, component, held, minimum, Progress());
	};
	const CurveSkeleton without = pruned(0.12);
	ASSERT_EQ(without.position.size(), 3u);
	EXPECT_EQ(statistics(without).terminals, 2);
	for (size_t s = 0; s < skeleton.node.size(); ++s)
		EXPECT_EQ(without.node[s], skeleton.node[s] == 3 ? 1 : skeleton.node[s])
			<< "what had merged into the stub goes to its foot";
	EXPECT_EQ(pruned(-0.5).position.size(), 4u) << "if told so, it stays";
	held[3] = 1;
	EXPECT_EQ(pruned(0.12).position.size(), 4u) << "held nodes stay";
}

TEST(CollapseToCurve, IsTheSameWhateverTheScale)
{
	const SurfaceMesh mesh = shapes::plate(2).mesh();
	const CurveSkeleton skeleton = collapseToCurve(checks::plainStage(mesh));
	for (double factor : {std::ldexp(1.0, -30), std::ldexp(1.0, 30)}) { // exact in floating point
		SurfaceMesh scaled = mesh;
		for (Point3d& p : scaled.position)
			p *= factor;
		const CurveSkeleton other = collapseToCurve(checks::plainStage(scaled));
		EXPECT_EQ(other.edges, skeleton.edges);
		EXPECT_EQ(other.node, skeleton.node);
	}
}

TEST(CollapseToCurve, TwoRunsAreBitEqual)
{
	const Stage stage = stageAfter(shapes::plate(3), 3);
	EXPECT_TRUE(checks::sameBits(collapseToCurve(stage), collapseToCurve(stage)));
}

TEST(CollapseToCurve, ProgressGoesForwardAndCancels)
{
	const Stage stage = checks::plainStage(shapes::sphere(4).mesh());
	int last = -1, calls = 0;
	collapseToCurve(stage, 1e-4, Progress([&](int percent, const char*) {
		EXPECT_GE(percent, last);
		last = percent;
		++calls;
		return true;
	}));
	EXPECT_EQ(last, 100);
	EXPECT_GT(calls, 1);
	EXPECT_THROW(
		collapseToCurve(stage, 1e-4, Progress([](int, const char*) { return false; })), Cancelled);
}

TEST(CollapseToCurve, IsLeftAsTheCollapsesMakeItWhereItIsNotTidied)
{
	const Stage stage = stageAfter(shapes::fromFile("y_tube"), 500);
	const CurveSkeleton tidy = collapseToCurve(stage, 1e-4);
	const CurveSkeleton rough = collapseToCurve(stage, 1e-4, Progress(), false);
	expectTopology(stage, rough, 1, 0);
	EXPECT_GE(statistics(rough).terminals, statistics(tidy).terminals);
	EXPECT_GT(statistics(rough).length, statistics(tidy).length); // it zigzags
	EXPECT_EQ(rough.radius.size(), rough.position.size());
}
