// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Significance of hand-made branches, and what is left of a skeleton at each threshold.

#include "curves.h"

#include <skeleton/graph/branch_table.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/resample_skeleton.h>
#include <skeleton/graph/significance.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

CurveSkeleton partOf(const CurveSkeleton& s, double minimum)
{
	return significantPart(s, nestedBranches(s), minimum);
}

std::set<Point3d> places(const CurveSkeleton& s)
{
	return {s.position.begin(), s.position.end()};
}

/// A trunk along x of radius 1; at x = 5 an arm of length 4 and radius 0.5, which ends in two fingers of length
/// 1.5 and radius 0.25, one of which has a wart of length 0.3 and radius 0.1 in its middle.
struct Limb
{
	CurveSkeleton s = line({0, 0, 0}, {10, 0, 0}, 1, 10);
	int wrist = addLine(s, 5, {5, 4, 0}, 0.5, 4);
	int thumb = addLine(s, wrist, {5 - 1.2, 4 + 0.9, 0}, 0.25, 3);
	int finger = addLine(s, wrist, {5 + 1.2, 4 + 0.9, 0}, 0.25, 2);
	int wart = addLine(s, finger - 1, {5.6, 4.45, 0.3}, 0.1, 1);
};

TEST(Significance, OfABranchIsHowFarItLeavesTheBallAtItsRoot)
{
	CurveSkeleton s = line({0, 0, 0}, {10, 0, 0}, 1, 10);
	const int tip = addLine(s, 5, {5, 3, 0}, 0.5, 4);
	// The farthest point is 3.5 from the root, where the ball has the radius 1.
	EXPECT_DOUBLE_EQ(nestedBranches(s).significance[size_t(tip)], 1 - 1 / 3.5);
	EXPECT_EQ(nestedBranches(s).significance[5], 1) << "the root is on the trunk";
	EXPECT_EQ(nestedBranches(s).root[size_t(tip)], 5);

	CurveSkeleton inner = line({0, 0, 0}, {10, 0, 0}, 1, 10);
	const int hidden = addLine(inner, 5, {5, 0.5, 0}, 0.4, 2);
	EXPECT_EQ(nestedBranches(inner).significance[size_t(hidden)], 0)
		<< "within the ball at the root";
}

TEST(Significance, HasNoUnit)
{
	const Limb limb;
	CurveSkeleton tiny = limb.s;
	for (size_t v = 0; v < tiny.position.size(); ++v) {
		tiny.position[v] *= 0.25;
		tiny.radius[v] *= 0.25;
	}
	EXPECT_EQ(nestedBranches(tiny).significance, nestedBranches(limb.s).significance);
}

TEST(Significance, DoesNotAskWhereInARoundEndABranchEnds)
{
	// A hemisphere of radius 1 about (0, 4, 0): from its centre on the ball shrinks as the branch goes on.
	CurveSkeleton to = line({-9, 0, 0}, {9, 0, 0}, 2, 18);
	const int centre = addLine(to, 9, {0, 4, 0}, 1, 8);
	CurveSkeleton past = to;
	const int tip = addNode(past, {0, 4.8, 0}, 0.2);
	addEdge(past, centre, tip);
	EXPECT_NEAR(nestedBranches(past).significance[size_t(tip)],
		nestedBranches(to).significance[size_t(centre)], 1e-15);
}

TEST(Significance, ABranchIsWorthAtLeastWhatHangsOnIt)
{
	// A hand that is more distinct from its wrist than the arm is from a fat body.
	CurveSkeleton s = line({-20, 0, 0}, {20, 0, 0}, 4, 40);
	const int wrist = addLine(s, 20, {0, 6, 0}, 0.2, 6);
	const int thumb = addLine(s, wrist, {-1, 7, 0}, 0.2, 2);
	const int finger = addLine(s, wrist, {1, 7.5, 0}, 0.2, 2);
	const std::vector<double> significance = nestedBranches(s).significance;
	EXPECT_GT(significance[size_t(thumb)], 0.8);
	EXPECT_GE(significance[size_t(finger)], significance[size_t(thumb)]);
	EXPECT_EQ(significance[size_t(wrist)], significance[size_t(finger)]) << "one branch";
}

TEST(Significance, PartsOfLessDetailAreNested)
{
	const Limb limb;
	const NestedBranches nested = nestedBranches(limb.s);
	std::vector<double> thresholds(nested.significance);
	std::sort(thresholds.begin(), thresholds.end());
	std::set<Point3d> larger = places(limb.s);
	int last = statistics(limb.s).terminals;
	EXPECT_EQ(last, 5);
	for (double minimum : thresholds) {
		const CurveSkeleton part = partOf(limb.s, minimum);
		const std::set<Point3d> here = places(part);
		EXPECT_TRUE(std::includes(larger.begin(), larger.end(), here.begin(), here.end()));
		EXPECT_EQ(statistics(part).components, 1);
		EXPECT_LE(statistics(part).terminals, last);
		last = statistics(part).terminals;
		larger = here;
		// And from the part that is left the same follows as from the whole.
		EXPECT_EQ(part.significance, nestedBranches(part).significance);
	}
	EXPECT_EQ(last, 2) << "the trunk is one chain";
}

TEST(Significance, TheLeastGoesFirstAndWhatLosesItsForkIsOneBranch)
{
	const Limb limb;
	const std::vector<double> of = nestedBranches(limb.s).significance;
	EXPECT_LT(of[size_t(limb.wart)], of[size_t(limb.thumb)]);
	EXPECT_LT(of[size_t(limb.thumb)], of[size_t(limb.finger)]);
	EXPECT_EQ(of[size_t(limb.finger)], of[size_t(limb.wrist)]);
	const CurveSkeleton armAlone = partOf(limb.s, of[size_t(limb.finger)]);
	EXPECT_EQ(statistics(armAlone).terminals, 3);
	EXPECT_EQ(statistics(armAlone).junctions, 1);
}

TEST(Significance, WhatGoesHangsWhereItsBranchDid)
{
	const Limb limb;
	const CurveSkeleton s = tracked(limb.s);
	const CurveSkeleton trunk = partOf(s, 1);
	EXPECT_EQ(trunk.position[size_t(trunk.node[size_t(limb.wart)])], Point3d(5, 0, 0));
	EXPECT_EQ(trunk.position[size_t(trunk.node[size_t(limb.wrist)])], Point3d(5, 0, 0));
	EXPECT_EQ(trunk.position[size_t(trunk.node[7])], Point3d(7, 0, 0));
}

TEST(Significance, KeepsCyclesAndTheWaysBetweenThem)
{
	CurveSkeleton s = circle(3, 0.5, 12);
	const int bridge = addLine(s, 0, {9, 0, 0}, 0.5, 6);
	const int first = int(s.position.size());
	for (int i = 1; i < 8; ++i)
		addNode(s, Point3d(11 - 2 * std::cos(i * M_PI / 4), 2 * std::sin(i * M_PI / 4), 0), 0.5);
	for (int i = 1; i < 7; ++i)
		addEdge(s, first + i - 1, first + i);
	addEdge(s, bridge, first);
	addEdge(s, bridge, first + 6);
	const int tail = addLine(s, 6, {-20, 0, 0}, 0.5, 10);
	const CurveSkeleton trunk = partOf(s, 1);
	EXPECT_EQ(statistics(trunk).cycles, 2);
	EXPECT_EQ(statistics(trunk).terminals, 0);
	EXPECT_EQ(trunk.position.size(), s.position.size() - 10);
	EXPECT_LT(nestedBranches(s).significance[size_t(tail)], 1) << "however long";
}

TEST(Significance, LeavesEachComponentATrunk)
{
	CurveSkeleton s = line({0, 0, 0}, {10, 0, 0}, 1, 10);
	addNode(s, {0, 50, 0}, 2);
	const int other = addNode(s, {100, 0, 0}, 1);
	addLine(s, other, {101, 0, 0}, 1, 1);
	EXPECT_EQ(places(partOf(s, 1)), places(s));
}

TEST(Significance, IsInTheBranchTableAndSurvivesResampling)
{
	Limb limb;
	limb.s.significance = nestedBranches(limb.s).significance;
	const auto values = [](const CurveSkeleton& s) {
		std::multiset<double> result;
		for (const BranchRecord& record : branchTable(s, skeletonBranches(s)))
			result.insert(record.significance);
		return result;
	};
	const std::multiset<double> before = values(limb.s);
	EXPECT_EQ(before.size(), 7u);
	EXPECT_EQ(before.count(1), 2u) << "both halves of the trunk";
	const CurveSkeleton fine = resampledSkeleton(limb.s, 0.1);
	ASSERT_EQ(fine.significance.size(), fine.position.size());
	EXPECT_EQ(values(fine), before);
}

TEST(Prune, ByDetailIsThePartOfThatSignificance)
{
	const Limb limb;
	PruneParameters p;
	p.spurProminence = 0;
	p.mergeJunctions = false;
	for (double detail : {0.0, 0.3, 0.5, 0.9, 1.0}) {
		p.detail = detail;
		const CurveSkeleton pruned = prune(tracked(limb.s), p),
							part = partOf(tracked(limb.s), 1 - detail);
		EXPECT_EQ(pruned.position, part.position) << detail;
		EXPECT_EQ(pruned.node, part.node) << detail;
		EXPECT_EQ(pruned.significance, part.significance) << detail;
	}
	p.detail = 1.1;
	EXPECT_THROW(prune(limb.s, p), InvalidParameter);
}

} // namespace
