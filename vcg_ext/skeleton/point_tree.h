// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file A kd-tree over a fixed set of points, for searches whose region shrinks while they run.

#ifndef VCG_MCF_POINT_TREE_H
#define VCG_MCF_POINT_TREE_H

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A balanced kd-tree with tight boxes, split at the median of the longest side.
 *
 * A library's nearest-neighbour query has a fixed centre; a shrinking ball moves its centre with
 * every contact it finds. search() lets the region change during one descent, which saves the
 * repeated queries of the classical algorithm (four to six a ball).
 */
class PointTree
{
public:
	struct Box
	{
		Point3d low, high;

		/// Squared distance from x to the box; 0 inside.
		double squaredDistance(const Point3d& x) const
		{
			double sum = 0;
			for (int k = 0; k < 3; ++k) {
				const double outside = std::max({low[k] - x[k], x[k] - high[k], 0.0});
				sum += outside * outside;
			}
			return sum;
		}
	};

	PointTree() = default;

	/// Complexity: O(n log n).
	explicit PointTree(const std::vector<Point3d>& points) : ids(points.size()), sorted(points)
	{
		if (points.empty())
			return;
		for (size_t i = 0; i < ids.size(); ++i)
			ids[i] = int(i);
		int depth = 0;
		while ((points.size() >> depth) > LeafSize)
			++depth;
		leafLevelStart = (1 << depth) - 1;
		boxes.resize(2 * size_t(leafLevelStart) + 1);
		build(points, 0, 0, int(points.size()));
		for (size_t i = 0; i < ids.size(); ++i)
			sorted[i] = points[ids[i]];
	}

	/// The ids of the points, leaf by leaf: neighbours in this order are near each other.
	const std::vector<int>& order() const { return ids; }

	/// The point at a place of order().
	const Point3d& point(int slot) const { return sorted[slot]; }

	/**
	 * Visits all points whose box the region reaches, nearer boxes first.
	 *
	 * Region: `double reach(const Box&)`, where negative means out of reach, and else a smaller
	 * value is visited first; `void visit(int slot, const Point3d& point)`, which may shrink the
	 * region. `order()[slot]` is the point's id.
	 * Complexity: O(log n) for a region that holds few points.
	 */
	template <class Region>
	void search(Region& region) const
	{
		if (boxes.empty())
			return;
		struct Range
		{
			int node, begin, end;
		};
		std::array<Range, 64> stack;
		int top = 0;
		stack[top++] = {0, 0, int(ids.size())};
		while (top > 0) {
			Range range = stack[--top];
			if (region.reach(boxes[range.node]) < 0)
				continue;
			while (range.node < leafLevelStart) {
				const int middle = (range.begin + range.end) / 2;
				Range left = {2 * range.node + 1, range.begin, middle};
				Range right = {2 * range.node + 2, middle, range.end};
				double leftReach = region.reach(boxes[left.node]);
				double rightReach = region.reach(boxes[right.node]);
				if (rightReach >= 0 && (leftReach < 0 || rightReach < leftReach)) {
					std::swap(left, right);
					std::swap(leftReach, rightReach);
				}
				if (rightReach >= 0)
					stack[top++] = right;
				range = left;
				if (leftReach < 0) {
					range.begin = range.end;
					break;
				}
			}
			for (int i = range.begin; i < range.end; ++i)
				region.visit(i, sorted[i]);
		}
	}

private:
	static constexpr size_t LeafSize = 8;

	std::vector<int> ids;
	std::vector<Point3d> sorted;
	std::vector<Box> boxes; ///< a complete binary tree, children of i at 2 i + 1 and 2 i + 2
	int leafLevelStart = 0;

	void build(const std::vector<Point3d>& points, int node, int begin, int end)
	{
		constexpr double inf = std::numeric_limits<double>::infinity();
		Box box = {Point3d(inf, inf, inf), Point3d(-inf, -inf, -inf)};
		for (int i = begin; i < end; ++i)
			for (int k = 0; k < 3; ++k) {
				box.low[k] = std::min(box.low[k], points[ids[i]][k]);
				box.high[k] = std::max(box.high[k], points[ids[i]][k]);
			}
		boxes[node] = box;
		if (node >= leafLevelStart)
			return;
		const Point3d side = box.high - box.low;
		const int axis = side[0] >= side[1] && side[0] >= side[2] ? 0 : (side[1] >= side[2] ? 1 : 2);
		const int middle = (begin + end) / 2;
		std::nth_element(ids.begin() + begin, ids.begin() + middle, ids.begin() + end,
			[&](int a, int b) { return std::make_pair(points[a][axis], a) < std::make_pair(points[b][axis], b); });
		build(points, 2 * node + 1, begin, middle);
		build(points, 2 * node + 2, middle, end);
	}
};

} // namespace vcg::tri::mcf

#endif
