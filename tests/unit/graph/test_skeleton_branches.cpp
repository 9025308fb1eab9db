// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Branches of hand-made graphs, the measure of spurs, and merging nodes.

#include "curves.h"

#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/graph/skeleton_radius.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using curves::graph;
using vcg::Point3d;

namespace {

std::set<std::vector<int>> asSet(const std::vector<Branch>& branches)
{
	std::set<std::vector<int>> result;
	for (const Branch& b : branches)
		result.insert(b.nodes);
	return result;
}

TEST(SkeletonBranches, ChainIsOneBranch)
{
	const std::vector<Branch> b = skeletonBranches(graph(4, {{0, 2}, {1, 2}, {1, 3}}));
	ASSERT_EQ(b.size(), 1u);
	EXPECT_EQ(b[0].nodes, (std::vector<int> {0, 2, 1, 3}));
	EXPECT_FALSE(b[0].isClosed());
}

TEST(SkeletonBranches, SingleEdgeIsOneBranch)
{
	EXPECT_EQ(asSet(skeletonBranches(graph(2, {{0, 1}}))), (std::set<std::vector<int>> {{0, 1}}));
}

TEST(SkeletonBranches, IsolatedNodeIsInNone)
{
	EXPECT_TRUE(skeletonBranches(graph(1, {})).empty());
}

TEST(SkeletonBranches, FreeCycleIsOneClosedBranch)
{
	const std::vector<Branch> b = skeletonBranches(graph(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}));
	ASSERT_EQ(b.size(), 1u);
	EXPECT_TRUE(b[0].isClosed());
	EXPECT_EQ(b[0].nodes.size(), 5u);
}

TEST(SkeletonBranches, JunctionWithTwoTipsAndALoop)
{
	// 0 and 1 are tips, 2 the junction, 3 4 5 a loop through it.
	const CurveSkeleton s = graph(6, {{0, 2}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {2, 5}});
	EXPECT_EQ(
		asSet(skeletonBranches(s)), (std::set<std::vector<int>> {{0, 2}, {1, 2}, {2, 3, 4, 5, 2}}));
}

TEST(SkeletonBranches, JunctionsJoinedByAnEdgeMeetOnce)
{
	const CurveSkeleton s = graph(6, {{0, 2}, {1, 2}, {2, 3}, {3, 4}, {3, 5}});
	EXPECT_EQ(asSet(skeletonBranches(s)),
		(std::set<std::vector<int>> {{0, 2}, {1, 2}, {2, 3}, {3, 4}, {3, 5}}));
}

TEST(SkeletonBranches, EveryEdgeIsInExactlyOneBranchAndInnerNodesHaveDegreeTwo)
{
	std::mt19937 random(7);
	for (int round = 0; round < 50; ++round) {
		const int n = 30;
		std::set<std::array<int, 2>> edges;
		for (int i = 0; i < 33; ++i) {
			const int a = int(random() % n), b = int(random() % n);
			if (a != b)
				edges.insert({std::min(a, b), std::max(a, b)});
		}
		CurveSkeleton s = graph(n, {});
		s.edges.assign(edges.begin(), edges.end());
		const auto neighbours = s.neighbours();
		std::map<std::array<int, 2>, int> seen;
		for (const Branch& b : skeletonBranches(s)) {
			for (size_t i = 1; i < b.nodes.size(); ++i) {
				const int x = b.nodes[i - 1], y = b.nodes[i];
				++seen[{std::min(x, y), std::max(x, y)}];
				if (i + 1 < b.nodes.size()) {
					EXPECT_EQ(neighbours[y].size(), 2u);
				}
			}
			if (!b.isClosed()) {
				EXPECT_NE(neighbours[b.first()].size(), 2u);
				EXPECT_NE(neighbours[b.last()].size(), 2u);
			}
		}
		EXPECT_EQ(seen.size(), edges.size());
		for (const auto& [edge, count] : seen)
			EXPECT_EQ(count, 1) << edge[0] << ' ' << edge[1];
	}
}

TEST(SkeletonBranches, LengthIsThatOfThePolyline)
{
	CurveSkeleton s = graph(3, {{0, 1}, {1, 2}});
	s.position[2] = Point3d(1, 2, 0);
	EXPECT_DOUBLE_EQ(branchLength(s, skeletonBranches(s)[0]), 3);
}

TEST(Prominence, IsWhatTheEndBallAddsInRadiiOfTheRoot)
{
	CurveSkeleton s = graph(2, {{0, 1}});
	s.radius = {2, 1.5}; // root, end; one apart
	EXPECT_DOUBLE_EQ(prominence(s, 1, 0), 0.25);
	s.radius = {2, 1}; // touches from inside
	EXPECT_DOUBLE_EQ(prominence(s, 1, 0), 0);
	s.radius = {2, 0.5}; // well inside
	EXPECT_LT(prominence(s, 1, 0), 0);
}

TEST(MergeNodes, TakesEdgesAndCorrespondenceAlong)
{
	// A cross with centre 2; the arm 3 4 goes into the centre.
	CurveSkeleton s = graph(6, {{0, 2}, {1, 2}, {2, 3}, {3, 4}, {2, 5}});
	s.node = {0, 1, 2, 3, 4, 5, 4, -1};
	const CurveSkeleton m = mergeNodes(s, {0, 1, 2, 2, 2, 5});
	EXPECT_EQ(m.position.size(), 4u);
	EXPECT_EQ(m.position[3], s.position[5]);
	EXPECT_EQ(m.edges, (std::vector<std::array<int, 2>> {{0, 2}, {1, 2}, {2, 3}}));
	EXPECT_EQ(m.node, (std::vector<int> {0, 1, 2, 2, 2, 3, 2, -1}));
}

TEST(MergeNodes, LeavesNoLoopsAndNoDoubleEdges)
{
	const CurveSkeleton square = graph(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}});
	const CurveSkeleton m = mergeNodes(square, {0, 1, 2, 1});
	EXPECT_EQ(m.edges, (std::vector<std::array<int, 2>> {{0, 1}, {1, 2}}));
}

TEST(FillUnknownRadii, SpreadsFromTheKnownOnes)
{
	const CurveSkeleton s = graph(6, {{0, 1}, {1, 2}, {2, 3}, {4, 5}});
	std::vector<double> radius = {1, -1, -1, 4, -1, -1};
	fillUnknownRadii(radius, s.neighbours());
	EXPECT_DOUBLE_EQ(radius[0], 1);
	EXPECT_DOUBLE_EQ(radius[1], 1);
	EXPECT_DOUBLE_EQ(radius[2], 4);
	EXPECT_DOUBLE_EQ(radius[3], 4);
	EXPECT_LT(radius[4], 0) << "nothing is known there";
}

TEST(CurveThickness, OfATubeIsItsRadiusHoweverFarApartTheNodesAre)
{
	// Nodes at 0, 4, 8, 12 on the axis of a tube of radius 1.
	CurveSkeleton s = graph(4, {{0, 1}, {1, 2}, {2, 3}});
	std::vector<Point3d> surface;
	for (Point3d& p : s.position)
		p *= 4;
	for (int i = 0; i <= 120; ++i)
		for (int k = 0; k < 6; ++k) {
			const double x = i / 10.0, angle = k * M_PI / 3;
			surface.emplace_back(x, std::cos(angle), std::sin(angle));
			s.node.push_back(int(std::lround(x / 4)));
		}
	for (const double radius : curveThickness(s, surface))
		EXPECT_NEAR(radius, 1, 1e-12);
}

TEST(CurveThickness, IsTheMeanOfTheNeighboursWhereNothingHasMerged)
{
	CurveSkeleton s = graph(3, {{0, 1}, {1, 2}});
	s.node = {0, 2, -1};
	const std::vector<double> radius =
		curveThickness(s, {Point3d(0, 2, 0), Point3d(2, 0, 4), Point3d(9, 9, 9)});
	EXPECT_EQ(radius, (std::vector<double> {2, 3, 4}));
}

} // namespace
