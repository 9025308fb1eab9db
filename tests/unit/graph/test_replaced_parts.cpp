// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/graph/replaced_parts.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A chain along the x axis at a height, each node with its own radius and significance.
CurveSkeleton chain(int count, double height)
{
	CurveSkeleton curve;
	for (int i = 0; i < count; ++i) {
		curve.position.emplace_back(i, height, 0);
		curve.radius.push_back(height + 0.1 * i);
		curve.significance.push_back(0.5 + 0.01 * i);
		if (i > 0)
			curve.edges.push_back({i - 1, i});
	}
	return curve;
}

} // namespace

TEST(ReplacedParts, TheNewOnesFollowWhatStays)
{
	CurveSkeleton curve = chain(3, 0);
	const CurveSkeleton other = chain(4, 1), third = chain(2, 2);
	for (const CurveSkeleton* part : {&other, &third})
		curve = withReplacedParts(curve, std::vector<char>(curve.position.size(), 0), {part}).curve;
	ASSERT_EQ(curve.position.size(), 9u);
	curve.node = {0, 3, 6, 8, 7, -1, 2};

	const CurveSkeleton fresh = chain(5, 7);
	std::vector<char> isGone(9, 0);
	for (int v = 3; v < 7; ++v)
		isGone[v] = 1;
	const ReplacedParts replaced = withReplacedParts(curve, isGone, {&fresh});
	EXPECT_EQ(replaced.number, (std::vector<int> {0, 1, 2, -1, -1, -1, -1, 3, 4}));
	EXPECT_EQ(replaced.first, std::vector<int>(1, 5));
	EXPECT_EQ(replaced.curve.node, (std::vector<int> {0, -1, -1, 4, 3, -1, 2}));
	const CurveSkeleton& made = replaced.curve;
	EXPECT_EQ(statistics(made).components, 3);
	EXPECT_EQ(statistics(made).length, 2 + 1 + 4);
	for (size_t v = 0; v < made.position.size(); ++v) {
		EXPECT_EQ(made.radius[v], made.position[v][1] + 0.1 * made.position[v][0]);
		EXPECT_EQ(made.significance[v], 0.5 + 0.01 * made.position[v][0]);
	}
	for (const auto& [a, b] : made.edges)
		EXPECT_EQ(Distance(made.position[a], made.position[b]), 1) << "within one chain";
}

TEST(ReplacedParts, WithoutSignificanceThereIsNone)
{
	CurveSkeleton curve = chain(3, 0);
	curve.significance.clear();
	const CurveSkeleton other = chain(2, 1);
	EXPECT_TRUE(withReplacedParts(curve, {0, 0, 0}, {&other}).curve.significance.empty());
	EXPECT_TRUE(withReplacedParts(curve, {1, 1, 1}, {}).curve.position.empty());
}
