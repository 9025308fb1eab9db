// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/graph/spanning_forest.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace vcg;
using namespace vcg::tri::mcf;

namespace {

/// A triangle of nodes 0, 1, 2 with a tail 3 at node 2, and an edge 4-5 apart.
CurveSkeleton graph()
{
	CurveSkeleton s;
	for (int i = 0; i < 6; ++i)
		s.position.push_back(Point3d(i, i * i, 0));
	s.radius = {3, 1, 2, 1.5, 4, 5};
	s.edges = {{0, 1}, {0, 2}, {1, 2}, {2, 3}, {4, 5}};
	return s;
}

} // namespace

TEST(SpanningForest, HasARootForEachComponentAtItsThickestNode)
{
	const SpanningForest forest = spanningForest(graph());
	std::vector<int> roots;
	for (int v = 0; v < 6; ++v)
		if (forest.parent[size_t(v)] < 0)
			roots.push_back(v);
	EXPECT_EQ(roots, std::vector<int>({0, 5}));
}

TEST(SpanningForest, CutsEachCycleAtItsThinnestEdge)
{
	// Both edges at node 1 are as thick as that; of equals the later one is cut.
	const SpanningForest forest = spanningForest(graph());
	ASSERT_EQ(forest.cuts.size(), 1u);
	EXPECT_EQ(forest.cuts[0], (std::array<int, 2> {1, 2}));
}

TEST(SpanningForest, ListsEachNodeAfterItsParent)
{
	const SpanningForest forest = spanningForest(graph());
	ASSERT_EQ(forest.order.size(), 6u);
	const auto placeOf = [&](int v) {
		return std::find(forest.order.begin(), forest.order.end(), v) - forest.order.begin();
	};
	for (int v = 0; v < 6; ++v)
		if (const int parent = forest.parent[size_t(v)]; parent >= 0) {
			EXPECT_LT(placeOf(parent), placeOf(v));
		}
}

TEST(SpanningForest, CompleteGraph)
{
	CurveSkeleton s;
	for (int i = 0; i < 20; ++i) {
		s.position.emplace_back(i, i * i, 0);
		s.radius.push_back(1 + i % 7);
		for (int j = i + 1; j < 20; ++j)
			s.edges.push_back({i, j});
	}
	EXPECT_EQ(spanningForest(s).cuts.size(), 190u - 19u);
}
