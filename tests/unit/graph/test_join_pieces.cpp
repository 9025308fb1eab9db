// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Bridges between the skeletons of separate pieces.

#include "shapes.h"

#include <skeleton/graph/join_pieces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// Balls of radius 1/2 in a row, each with its centre as its skeleton.
struct Balls
{
	SurfaceMesh surface;
	CurveSkeleton curve;

	explicit Balls(const std::vector<double>& places)
	{
		shapes::Soup all;
		for (double x : places) {
			const shapes::Soup ball = shapes::moved(shapes::sphere(2, 0.5), {x, 0, 0});
			for (size_t v = 0; v < ball.points.size(); ++v)
				curve.node.push_back(int(curve.position.size()));
			all = shapes::joined({all, ball});
			curve.position.push_back(Point3d(x, 0, 0));
			curve.radius.push_back(0.5);
		}
		surface = all.mesh();
	}
};

TEST(JoinPieces, BridgesTheNarrowestGaps)
{
	Balls balls({0, 3.5, 2});
	const Bridges made = joinPieces(balls.curve, balls.surface);
	EXPECT_EQ(made.count, 2);
	EXPECT_DOUBLE_EQ(made.longest, 1);
	const CurveSkeleton& curve = balls.curve;
	const SkeletonStatistics s = statistics(curve);
	EXPECT_EQ(s.components, 1);
	EXPECT_EQ(s.cycles, 0);
	EXPECT_DOUBLE_EQ(s.length, 3.5); // straight through, not to the farther one
	EXPECT_EQ(curve.bridge, (std::vector<char> {0, 0, 0, 1, 1}));
	EXPECT_EQ(curve.radius.size(), curve.position.size());
	EXPECT_TRUE(std::is_sorted(curve.edges.begin(), curve.edges.end()));
	for (const auto& [a, b] : curve.edges) {
		EXPECT_LT(a, b);
		EXPECT_TRUE(curve.bridge[size_t(b)]);
	}
}

TEST(WithoutBridges, GivesThePiecesBack)
{
	Balls balls({0, 3.5, 2});
	const CurveSkeleton before = balls.curve;
	joinPieces(balls.curve, balls.surface);
	// Somebody has put a bridge's middle first, and a vertex onto it.
	CurveSkeleton& curve = balls.curve;
	std::swap(curve.position[0], curve.position[3]);
	std::swap(curve.bridge[0], curve.bridge[3]);
	std::swap(curve.radius[0], curve.radius[3]);
	const auto swapped = [](int v) { return v == 0 ? 3 : v == 3 ? 0 : v; };
	for (std::array<int, 2>& edge : curve.edges)
		for (int& v : edge)
			v = swapped(v);
	for (int& v : curve.node)
		v = swapped(v);
	curve.node.front() = 0;
	const CurveSkeleton pieces = withoutBridges(curve);
	EXPECT_EQ(pieces.position.size(), 3u);
	EXPECT_TRUE(pieces.edges.empty());
	EXPECT_TRUE(pieces.bridge.empty());
	for (size_t s = 1; s < pieces.node.size(); ++s)
		EXPECT_EQ(pieces.position[size_t(pieces.node[s])], before.position[size_t(before.node[s])]);
	EXPECT_GE(pieces.node.front(), 0);
	EXPECT_EQ(withoutBridges(before).node, before.node);
}

TEST(JoinPieces, LeavesASinglePieceAsItIs)
{
	Balls ball({1});
	EXPECT_EQ(joinPieces(ball.curve, ball.surface).count, 0);
	EXPECT_EQ(ball.curve.position.size(), 1u);
	EXPECT_TRUE(ball.curve.bridge.empty());
}

} // namespace
