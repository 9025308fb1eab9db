// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/spatial/box_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using vcg::Box3d;
using vcg::Point3d;
using namespace vcg::tri::mcf;

namespace {

std::vector<int> found(const BoxTree& tree, const Box3d& box)
{
	std::vector<int> result;
	tree.forEachIn(box, [&](int i) { result.push_back(i); });
	std::sort(result.begin(), result.end());
	return result;
}

} // namespace

TEST(BoxTree, FindsWhatComparingAllFinds)
{
	std::mt19937 random(5);
	const auto coordinate = [&] { return double(random() % 1000) / 1000; };
	const auto anyBox = [&] {
		const Point3d corner(coordinate(), coordinate(), coordinate());
		return Box3d(corner,
			corner + Point3d(coordinate(), coordinate(), coordinate()) * (0.3 * coordinate()));
	};
	std::vector<Box3d> boxes;
	for (int i = 0; i < 500; ++i)
		boxes.push_back(anyBox());
	const BoxTree tree(boxes);
	for (int k = 0; k < 100; ++k) {
		const Box3d box = anyBox();
		std::vector<int> expected;
		for (int i = 0; i < int(boxes.size()); ++i) {
			bool meets = true;
			for (int axis = 0; axis < 3; ++axis)
				meets = meets && boxes[i].min[axis] <= box.max[axis]
					&& box.min[axis] <= boxes[i].max[axis];
			if (meets)
				expected.push_back(i);
		}
		EXPECT_EQ(found(tree, box), expected);
	}
}

TEST(BoxTree, BoxesThatTouchMeet)
{
	const BoxTree tree({Box3d(Point3d(0, 0, 0), Point3d(1, 1, 1))});
	EXPECT_EQ(found(tree, Box3d(Point3d(1, 1, 1), Point3d(2, 2, 2))), std::vector<int> {0});
	EXPECT_TRUE(found(tree, Box3d(Point3d(1.1, 0, 0), Point3d(2, 1, 1))).empty());
}

TEST(BoxTree, OfNoBoxesFindsNone)
{
	EXPECT_TRUE(found(BoxTree({}), Box3d(Point3d(0, 0, 0), Point3d(1, 1, 1))).empty());
}
