// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Pruning of hand-made skeletons: what goes, what stays, and where the rest hangs.

#include "curves.h"
#include <skeleton/graph/prune.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

/// Everything off.
PruneParameters nothing()
{
	PruneParameters p;
	p.spurProminence = 0;
	p.mergeJunctions = false;
	return p;
}

/// A trunk along x from 0 to 10 of radius 1, with a twig of the given length and radius at x = 5.
CurveSkeleton trunkWithTwig(double length, double radius, int edges = 4)
{
	CurveSkeleton s = line({0, 0, 0}, {10, 0, 0}, 1, 10);
	addLine(s, 5, {5, length, 0}, radius, edges);
	return tracked(s);
}

/// A ring of radius 3 about the origin with a tail to x = 3 + length.
CurveSkeleton ringWithTail(double length, double radius)
{
	CurveSkeleton s = circle(3, 0.5, 12);
	addLine(s, 0, {3 + length, 0, 0}, radius, 2);
	return tracked(s);
}

TEST(Prune, NothingAskedForNothingDone)
{
	const CurveSkeleton s = trunkWithTwig(0.1, 0.1);
	const CurveSkeleton p = prune(s, nothing());
	EXPECT_EQ(p.position.size(), s.position.size());
	EXPECT_EQ(p.edges, s.edges);
	EXPECT_EQ(p.node, s.node);
}

TEST(Prune, SpurInsideTheTrunkGoesAndALimbStays)
{
	PruneParameters p = nothing();
	p.spurProminence = 0.1;
	// |tip - root| + r_tip - r_root: 0.7 + 0.2 - 1 < 0.1, and 1.5 + 0.2 - 1 > 0.1.
	EXPECT_EQ(statistics(prune(trunkWithTwig(0.7, 0.2), p)).terminals, 2);
	EXPECT_EQ(statistics(prune(trunkWithTwig(1.5, 0.2), p)).terminals, 3);
}

TEST(Prune, WhatIsRemovedHangsWhereItsBranchDid)
{
	PruneParameters p = nothing();
	p.shortestBranch = 2;
	const CurveSkeleton s = trunkWithTwig(1, 0.2);
	const CurveSkeleton pruned = prune(s, p);
	ASSERT_EQ(pruned.node.size(), s.node.size());
	for (size_t v = 0; v < s.position.size(); ++v) {
		const Point3d expected = v <= 10 ? s.position[v] : s.position[5];
		EXPECT_EQ(pruned.position[pruned.node[v]], expected) << v;
	}
}

TEST(Prune, ByLengthTheShortestFirst)
{
	// Three arms of 1, 2 and 3: with the first gone the others are one chain, which stays.
	CurveSkeleton s;
	const int middle = addNode(s, {0, 0, 0}, 0.1);
	addLine(s, middle, {1, 0, 0}, 0.1, 3);
	addLine(s, middle, {0, 2, 0}, 0.1, 3);
	addLine(s, middle, {0, 0, 3}, 0.1, 3);
	PruneParameters p = nothing();
	p.shortestBranch = 10;
	const SkeletonStatistics left = statistics(prune(s, p));
	EXPECT_EQ(left.branches, 1);
	EXPECT_DOUBLE_EQ(left.length, 5);
}

TEST(Prune, ByRadiusTheThinOneGoesHoweverLong)
{
	PruneParameters p = nothing();
	p.minRadius = 0.5;
	EXPECT_EQ(statistics(prune(trunkWithTwig(20, 0.4), p)).terminals, 2);
	EXPECT_EQ(statistics(prune(trunkWithTwig(20, 0.6), p)).terminals, 3);
	EXPECT_EQ(statistics(prune(trunkWithTwig(20, 0.4, 1), p)).terminals, 2) << "a single edge";
}

TEST(Prune, CyclesAreNeverTouched)
{
	PruneParameters all;
	all.spurProminence = 1;
	all.shortestBranch = all.minRadius = 1e9;
	CurveSkeleton s = ringWithTail(1, 0.1);
	// A second, tiny ring at the tail's end, and a theta: a chord through the large ring.
	const int tail = int(s.position.size()) - 1;
	const int a = addNode(s, {4.01, 0.01, 0}, 0.5), b = addNode(s, {4.01, -0.01, 0}, 0.5);
	addEdge(s, tail, a);
	addEdge(s, a, b);
	addEdge(s, b, tail);
	addEdge(s, 3, 9);
	addLine(s, 6, {-5, 0, 0}, 0.1, 2);
	const SkeletonStatistics before = statistics(s), after = statistics(prune(s, all));
	EXPECT_EQ(before.cycles, 3);
	EXPECT_EQ(after.cycles, 3);
	EXPECT_EQ(after.components, 1);
	EXPECT_EQ(before.terminals, 1);
	EXPECT_EQ(after.terminals, 0);
}

TEST(Prune, TailOfARingGoes)
{
	PruneParameters p = nothing();
	p.shortestBranch = 2;
	const SkeletonStatistics left = statistics(prune(ringWithTail(1, 0.1), p));
	EXPECT_EQ(left.cycles, 1);
	EXPECT_EQ(left.branches, 1);
	EXPECT_EQ(left.terminals, 0);
}

TEST(Prune, SingleChainsStayWhatever)
{
	PruneParameters all;
	all.shortestBranch = all.minRadius = 1e9;
	const CurveSkeleton s = line({0, 0, 0}, {1, 0, 0}, 0.1, 5);
	EXPECT_EQ(prune(s, all).edges, s.edges);
}

/// Two junctions `apart` along x with two arms each, the first of radius 1, the second of 0.8.
CurveSkeleton twoJunctions(double apart, int edges)
{
	CurveSkeleton s;
	const int a = addNode(s, {0, 0, 0}, 1);
	const int b = addLine(s, a, {apart, 0, 0}, 0.8, edges);
	for (double side : {-5.0, 5.0}) {
		addLine(s, a, {0, side, 0}, 0.5, 5);
		addLine(s, b, {apart, 0, side}, 0.5, 5);
	}
	return tracked(s);
}

TEST(Prune, JunctionsCloserThanTheirRadiusBecomeOne)
{
	PruneParameters p = nothing();
	p.mergeJunctions = true;
	for (int edges : {1, 2, 5}) {
		EXPECT_EQ(statistics(prune(twoJunctions(1.1, edges), p)).junctions, 2) << edges;
		const CurveSkeleton s = twoJunctions(0.9, edges), one = prune(s, p);
		const SkeletonStatistics left = statistics(one);
		EXPECT_EQ(left.junctions, 1) << edges;
		EXPECT_EQ(left.terminals, 4) << edges;
		// The larger ball stays where it was.
		EXPECT_EQ(one.position[one.node[0]], Point3d(0, 0, 0));
		EXPECT_EQ(one.position[one.node[edges]], Point3d(0, 0, 0));
	}
}

TEST(Prune, JunctionsOnATriangleStayApart)
{
	CurveSkeleton s = twoJunctions(0.5, 1);
	const int top = addNode(s, {0.25, 0.4, 0}, 1);
	addEdge(s, 0, top);
	addEdge(s, 1, top);
	addLine(s, top, {0.25, 5, 0}, 0.5, 5);
	PruneParameters p = nothing();
	p.mergeJunctions = true;
	EXPECT_EQ(statistics(prune(s, p)).cycles, 1);
}

TEST(Prune, TwoBranchesBetweenTwoJunctionsStayACycle)
{
	CurveSkeleton s = twoJunctions(0.5, 2);
	const int above = addNode(s, {0.25, 0.3, 0}, 1);
	addEdge(s, 0, above);
	addEdge(s, 2, above);
	PruneParameters p = nothing();
	p.mergeJunctions = true;
	const SkeletonStatistics left = statistics(prune(s, p));
	EXPECT_EQ(left.cycles, 1);
	EXPECT_EQ(left.junctions, 2);
}

TEST(Prune, EachComponentKeepsAChain)
{
	PruneParameters all;
	all.shortestBranch = all.minRadius = 1e9;
	CurveSkeleton s = trunkWithTwig(3, 0.1);
	const int first = addNode(s, {0, 0, 50}, 0.1);
	addLine(s, first, {1, 0, 50}, 0.1, 1);
	EXPECT_EQ(statistics(prune(s, all)).components, 2);
}

TEST(Prune, ScaleDoesNotMatter)
{
	for (double scale : {1e-6, 1e6}) {
		CurveSkeleton s = trunkWithTwig(0.7, 0.2);
		for (Point3d& p : s.position)
			p *= scale;
		for (double& r : s.radius)
			r *= scale;
		EXPECT_EQ(statistics(prune(s, {})).terminals, 2);
	}
}

TEST(Prune, RefusesParametersOutOfRange)
{
	const CurveSkeleton s = trunkWithTwig(1, 0.2);
	PruneParameters p;
	p.spurProminence = 1.5;
	EXPECT_THROW(prune(s, p), InvalidParameter);
	p = {};
	p.shortestBranch = -1;
	EXPECT_THROW(prune(s, p), InvalidParameter);
	p = {};
	p.minRadius = NAN;
	EXPECT_THROW(prune(s, p), InvalidParameter);
}

/// A tree of nodes on a grid, so that many branches are as long as others.
CurveSkeleton gridTree(unsigned seed, int nodes)
{
	std::mt19937 random(seed);
	CurveSkeleton s;
	std::set<std::array<int, 2>> taken;
	std::vector<std::array<int, 2>> cell {{0, 0}};
	taken.insert(cell[0]);
	while (int(cell.size()) < nodes) {
		const int from = int(random() % cell.size());
		std::array<int, 2> next = cell[from];
		next[random() % 2] += random() % 2 ? 1 : -1;
		if (!taken.insert(next).second)
			continue;
		s.edges.push_back({from, int(cell.size())});
		cell.push_back(next);
	}
	for (const std::array<int, 2>& c : cell) {
		s.position.push_back({double(c[0]), double(c[1]), 0});
		s.radius.push_back(0.1 * double(1 + random() % 5));
	}
	std::sort(s.edges.begin(), s.edges.end());
	return tracked(s);
}

/// withoutTerminalBranches() as it is defined: all branches are measured, the least goes, and again.
template <class Measure>
CurveSkeleton oneAtATime(CurveSkeleton s, double minimum, const Measure& measure)
{
	for (;;) {
		const std::vector<std::vector<int>> neighbours = s.neighbours();
		double worst = minimum;
		Branch doomed;
		for (Branch& branch : skeletonBranches(s)) {
			if ((neighbours[branch.first()].size() == 1) == (neighbours[branch.last()].size() == 1))
				continue;
			if (neighbours[branch.first()].size() == 1)
				std::reverse(branch.nodes.begin(), branch.nodes.end());
			if (const double value = measure(s, branch); value < worst) {
				worst = value;
				doomed = branch;
			}
		}
		if (doomed.nodes.empty())
			return s;
		s = mergeNodes(s, detail::mergingTarget(s.position.size(), doomed, doomed.first()));
	}
}

TEST(Prune, TheLeastOneGoesFirstAndWhatGetsLongerIsMeasuredAgain)
{
	const auto expectSame = [](const CurveSkeleton& a, const CurveSkeleton& b) {
		EXPECT_EQ(a.position, b.position);
		EXPECT_EQ(a.radius, b.radius);
		EXPECT_EQ(a.edges, b.edges);
		EXPECT_EQ(a.node, b.node);
	};
	for (unsigned seed = 1; seed <= 40; ++seed) {
		SCOPED_TRACE(seed);
		CurveSkeleton s = gridTree(seed, 120);
		if (seed % 2) // cycles
			for (int i = 0; i < 3; ++i)
				addEdge(s, 3 + i, 77 + 9 * i);
		std::sort(s.edges.begin(), s.edges.end());
		s.edges.erase(std::unique(s.edges.begin(), s.edges.end()), s.edges.end());
		for (double minimum : {1.5, 3.5, 100.})
			expectSame(withoutTerminalBranches(s, minimum, branchLength),
				oneAtATime(s, minimum, branchLength));
		expectSame(withoutTerminalBranches(s, 0.9, terminalProminence),
			oneAtATime(s, 0.9, terminalProminence));
		// Of branches that hang on how many there are: all but three.
		const auto few = [](const CurveSkeleton& now, const Branch& b, const std::set<int>& tips) {
			return tips.size() > 3 ? branchLength(now, b) : 1000;
		};
		expectSame(withoutTerminalBranches(s, 1000, few),
			oneAtATime(s, 1000, [](const CurveSkeleton& now, const Branch& b) {
				return statistics(now).terminals > 3 ? branchLength(now, b) : 1000;
			}));
	}
}

TEST(Prune, CanBeCancelled)
{
	EXPECT_THROW(prune(trunkWithTwig(1, 0.2), {}, Progress([](int, const char*) { return false; })),
		Cancelled);
}

} // namespace
