// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/core/disjoint_sets.h>

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace vcg::tri::mcf;

TEST(MergeForest, StartsWithEachVertexForItself)
{
	MergeForest forest(5);
	for (int v = 0; v < 5; ++v)
		EXPECT_EQ(forest.find(v), v);
	EXPECT_EQ(forest.add(), 5);
	EXPECT_EQ(forest.find(5), 5);
}

TEST(MergeForest, TheTargetStandsForBoth)
{
	MergeForest forest(4);
	forest.merge(0, 1);
	forest.merge(1, 2);
	EXPECT_EQ(forest.find(0), 2);
	EXPECT_EQ(forest.find(1), 2);
	EXPECT_EQ(forest.find(2), 2);
	EXPECT_EQ(forest.find(3), 3);
}

TEST(MergeForest, TheLowerOfTwoJoinedStandsForAll)
{
	MergeForest forest(5);
	EXPECT_TRUE(forest.join(4, 2));
	EXPECT_TRUE(forest.join(3, 4));
	EXPECT_FALSE(forest.join(2, 3));
	EXPECT_TRUE(forest.join(1, 3));
	for (int v : {1, 2, 3, 4})
		EXPECT_EQ(forest.find(v), 1);
	EXPECT_EQ(forest.find(0), 0);
	EXPECT_EQ(forest.size(), 5);
}

TEST(MergeForest, AgreesWithRelabelling)
{
	// The same by brute force: every merge rewrites a list of labels.
	std::mt19937 random(3);
	MergeForest forest(300);
	std::vector<int> label(300);
	for (int v = 0; v < 300; ++v)
		label[v] = v;
	for (int i = 0; i < 1000; ++i) {
		if (random() % 4 == 0) {
			label.push_back(int(label.size()));
			ASSERT_EQ(forest.add(), label.back());
		}
		const int from = label[random() % label.size()], to = label[random() % label.size()];
		if (from == to)
			continue;
		forest.merge(from, to);
		for (int& l : label)
			if (l == from)
				l = to;
		const int v = int(random() % label.size());
		ASSERT_EQ(forest.find(v), label[v]);
	}
	for (size_t v = 0; v < label.size(); ++v)
		EXPECT_EQ(forest.find(int(v)), label[v]);
}

TEST(MergeForest, ALongChainIsNoTrap)
{
	const int n = 1000000;
	MergeForest forest(n);
	for (int v = 0; v + 1 < n; ++v)
		forest.merge(v, v + 1);
	for (int v = 0; v < n; ++v)
		ASSERT_EQ(forest.find(v), n - 1); // without shortening paths: 5e11 steps
}
