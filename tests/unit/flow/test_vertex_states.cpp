// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/flow/vertex_states.h>

#include <gtest/gtest.h>

#include <vector>

using namespace vcg;
using namespace vcg::tri::mcf;

namespace {

/// Four vertices on the x axis with their poles above them; the last has none.
VertexStates fourVertices()
{
	VertexStates states;
	for (int v = 0; v < 4; ++v)
		states.pole.push_back(Point3d(v, 1, 0));
	states.poleRadius = {1, 2, 3, -1};
	states.fixed = {0, 1, 0, 0};
	states.held = {0, 0, 0, 0};
	states.sheet = {1, 1, 0, 0};
	states.component = {0, 0, 1, 1};
	states.epsilonLimit = {0.1, 0.2, 0.3, 0.4};
	return states;
}

} // namespace

TEST(VertexStates, AreOfAsManyVerticesAsEachProperty)
{
	VertexStates states = fourVertices();
	EXPECT_TRUE(states.areOf(4));
	states.epsilonLimit.clear(); // none anywhere
	EXPECT_TRUE(states.areOf(4));
	states.held.pop_back();
	EXPECT_FALSE(states.areOf(4));
}

TEST(VertexStates, RenumberedVerticesKeepAllThatIsKnownOfThem)
{
	VertexStates states = fourVertices();
	states.renumber({2, -1, 0, 1}, 3);
	ASSERT_TRUE(states.areOf(3));
	const VertexStates before = fourVertices(), picked = before.picked({2, 3, 0});
	EXPECT_EQ(states.pole[2], before.pole[0]);
	EXPECT_EQ(states.poleRadius, std::vector<double>({3, -1, 1}));
	EXPECT_EQ(states.sheet, std::vector<char>({0, 0, 1}));
	EXPECT_EQ(states.component, std::vector<int>({1, 1, 0}));
	EXPECT_EQ(states.epsilonLimit, std::vector<double>({0.3, 0.4, 0.1}));
	EXPECT_EQ(states.pole, picked.pole);
	EXPECT_EQ(states.poleRadius, picked.poleRadius);
	EXPECT_EQ(states.component, picked.component);
}

TEST(VertexStates, AVertexOnAnEdgeHasAPoleOnlyWithinASheet)
{
	VertexStates states = fourVertices();
	states.addBetween(0, 1, 0.25, Point3d(0.25, 0, 0), false);
	EXPECT_NEAR(Distance(states.pole[4], Point3d(0.25, 1, 0)), 0, 1e-15);
	EXPECT_DOUBLE_EQ(states.poleRadius[4], 1.25);
	EXPECT_TRUE(states.sheet[4]);
	states.addBetween(1, 2, 0.5, Point3d(1.5, 0, 0), true);
	EXPECT_EQ(states.pole[5], Point3d(1.5, 0, 0));
	EXPECT_LT(states.poleRadius[5], 0);
	EXPECT_FALSE(states.sheet[5]);
	EXPECT_TRUE(states.held[5] && states.fixed[5]);
	EXPECT_DOUBLE_EQ(states.epsilonLimit[5], 0.25);
	EXPECT_TRUE(states.areOf(6));
}

TEST(VertexStates, OfTwoMergedTheCloserPoleStays)
{
	VertexStates states = fourVertices();
	states.sheet.assign(4, 0);
	states.merge(1, 2, Point3d(1.4, 0, 0));
	EXPECT_EQ(states.pole[2], Point3d(1, 1, 0));
	EXPECT_EQ(states.poleRadius[2], 2);
	EXPECT_TRUE(states.fixed[2]);
	EXPECT_EQ(states.epsilonLimit[2], 0.2);
	states.merge(3, 2, Point3d(3, 0, 0)); // 3 has none to give
	EXPECT_EQ(states.pole[2], Point3d(1, 1, 0));
}
