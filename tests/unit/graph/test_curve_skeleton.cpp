// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "curves.h"

#include <skeleton/graph/curve_skeleton.h>

#include <gtest/gtest.h>

#include <vector>

using namespace vcg::tri::mcf;
using curves::graph;
using vcg::Point3d;

namespace {

void expectCounts(const CurveSkeleton& skeleton, int components, int cycles, int branches,
	int terminals, int junctions)
{
	const SkeletonStatistics s = statistics(skeleton);
	EXPECT_EQ(s.components, components);
	EXPECT_EQ(s.cycles, cycles);
	EXPECT_EQ(s.branches, branches);
	EXPECT_EQ(s.terminals, terminals);
	EXPECT_EQ(s.junctions, junctions);
}

} // namespace

TEST(CurveSkeleton, NeighboursAreAscending)
{
	const auto neighbours = graph(4, {{0, 3}, {1, 3}, {2, 3}}).neighbours();
	EXPECT_EQ(neighbours[3], std::vector<int>({0, 1, 2}));
	EXPECT_EQ(neighbours[1], std::vector<int>({3}));
}

TEST(CurveSkeleton, CountsAPath)
{
	expectCounts(graph(4, {{0, 1}, {1, 2}, {2, 3}}), 1, 0, 1, 2, 0);
}

TEST(CurveSkeleton, CountsAFreeCycleAsOneBranch)
{
	expectCounts(graph(3, {{0, 1}, {0, 2}, {1, 2}}), 1, 1, 1, 0, 0);
}

TEST(CurveSkeleton, CountsAYAndATheta)
{
	expectCounts(graph(4, {{0, 1}, {0, 2}, {0, 3}}), 1, 0, 3, 3, 1);
	// Two junctions joined by three chains: two cycles.
	expectCounts(graph(5, {{0, 1}, {0, 2}, {0, 3}, {1, 4}, {2, 4}, {3, 4}}), 1, 2, 3, 0, 2);
}

TEST(CurveSkeleton, CountsALoopOnAStem)
{
	// A cycle of three with a tail: one branch around, one to the tip.
	expectCounts(graph(4, {{0, 1}, {0, 2}, {1, 2}, {2, 3}}), 1, 1, 2, 1, 1);
}

TEST(CurveSkeleton, CountsEachComponent)
{
	expectCounts(graph(8, {{0, 1}, {2, 3}, {3, 4}, {5, 6}, {5, 7}, {6, 7}}), 3, 1, 3, 4, 0);
	expectCounts(graph(0, {}), 0, 0, 0, 0, 0);
}

TEST(CurveSkeleton, LengthIsTheSumOfTheEdges)
{
	CurveSkeleton s = graph(3, {{0, 1}, {1, 2}});
	s.position[2] = Point3d(1, 3, 4);
	EXPECT_DOUBLE_EQ(statistics(s).length, 1 + 5);
}

TEST(CurveSkeleton, TheMajorityOfItsVerticesTellsTheComponentOfACurve)
{
	CurveSkeleton s = graph(6, {{0, 1}, {2, 3}});
	s.node = {2, 0, 1, 0, 3, 3, 4, -1};
	EXPECT_EQ(componentOfNodes(s, {0, 0, 0, 0, 1, 1, 1, 1}), std::vector<int>({0, 0, 1, 1, 1, -1}));
}
