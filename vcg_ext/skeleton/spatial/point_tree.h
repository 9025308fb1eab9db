// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A tree of boxes over fixed points, for searches in a ball that shrinks while they run.

#ifndef VCG_MCF_POINT_TREE_H
#define VCG_MCF_POINT_TREE_H

#include "four_boxes.h"
#include "four_slabs.h"
#include "four_values.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A 4-ary bounding volume hierarchy of points, split at medians of the longest side: each node has
 * an axis-aligned box and, since the points are mostly those of a surface, a best-fit slab.
 *
 * A nearest-neighbour query has a fixed centre; a shrinking ball moves its centre with every
 * contact it finds. search() lets the ball change during one descent, which saves the repeated
 * queries of the classical algorithm. Culling is conservative, in single precision, four children
 * per SIMD test; the ball itself confirms candidates in double precision.
 */
class PointTree
{
public:
	/// @pre the points are finite. @throws Cancelled. Complexity: O(n log n).
	explicit PointTree(const std::vector<Point3d>& points, const Progress& progress = Progress())
	{
		Box3d box;
		std::vector<Sample> samples;
		samples.reserve(points.size());
		detail::cancellableLoop(int(points.size()), progress, [&](int i) {
			samples.push_back({points[i], i});
			box.Add(points[i]);
		});
		if (!points.empty()) {
			origin = box.Center();
			scale = scaleOf(box.Diag());
		}
		slack = points.empty() ? 0 : FourBoxes::slack(box.Diag() * scale);
		size_t inner = 0, width = 1;
		while (points.size() > LeafSize * width) {
			inner += width;
			width *= 4;
		}
		nodes.resize(inner);
		leafStart.assign(width + 1, int(points.size()));
		buildAll(samples, box, progress.part(0, 0.9));
		ids.reserve(points.size());
		sorted.reserve(points.size());
		for (std::vector<float>& values : coordinate)
			values.reserve(points.size() + Lanes);
		detail::reportedLoop(int(points.size()), progress.part(0.9, 1), sorting, [&](int i) {
			ids.push_back(samples[i].id);
			sorted.push_back(samples[i].point);
			for (int axis = 0; axis < 3; ++axis)
				coordinate[axis].push_back(float((samples[i].point[axis] - origin[axis]) * scale));
		});
		for (std::vector<float>& values : coordinate)
			values.resize(points.size() + Lanes, std::numeric_limits<float>::infinity());
	}

	int size() const { return int(ids.size()); }

	/// The ids of the points, leaf by leaf: neighbours in this order are near each other.
	const std::vector<int>& order() const { return ids; }

	/// The point at a place of order().
	const Point3d& point(int slot) const { return sorted[slot]; }

	/**
	 * Visits every point of the ball, and some outside it, each once.
	 *
	 * Ball: `Point3d centre()`, `double reach()`, its radius, and
	 * `void visit(int slot, const Point3d&)`, which may shrink the ball or, unless nearestFirst is
	 * set, replace it by one with another centre: points outside either are then left out.
	 * `order()[slot]` is the point's id.
	 * @tparam nearestFirst  visits the boxes nearest to the centre first: it pays where the ball is
	 *                       much too large to begin with.
	 * Complexity: O(log n) for a ball that holds few points.
	 */
	template <bool nearestFirst = false, class Ball>
	void search(Ball& ball) const
	{
		SingleBall single = toSingle(ball.centre(), ball.reach());
		const int root = 0;
		if constexpr (nearestFirst)
			searchNearestFirst(single, ball);
		else if (!ids.empty())
			searchTogether(&root, 1, single, ball);
	}

	/// The id of the point nearest to x, the lowest of several; -1 if there are no points.
	int nearest(const Point3d& x) const
	{
		Nearest ball {*this, x, std::numeric_limits<double>::max(), -1};
		search<true>(ball);
		return ball.id;
	}

	/// The distance from x to the nearest point. @pre there are points.
	double distance(const Point3d& x) const
	{
		Nearest ball {*this, x, std::numeric_limits<double>::max(), -1};
		search<true>(ball);
		return ball.distance;
	}

private:
	static constexpr const char* sorting = "Sorting the surface";
	static constexpr size_t LeafSize = 32;
	static constexpr int Lanes = 4;

	/// The bounds of four children: each point is both in its box and in its slab.
	struct Node
	{
		FourBoxes boxes;
		FourSlabs slabs;

		/// Lower bounds of the squared distances from x to the points of each child.
		Eigen::Array4f squaredDistances(const float (&x)[3]) const
		{
			return boxes.squaredDistances(x).max(slabs.distances(x).square());
		}
	};

	/// A ball about the tree's origin, scaled, in single precision, enlarged for rounding.
	struct SingleBall
	{
		float centre[3];
		float squaredReach;
	};

	struct Nearest
	{
		const PointTree& tree;
		Point3d x;
		double distance;
		int id;

		const Point3d& centre() const { return x; }
		double reach() const { return distance; }
		void visit(int slot, const Point3d& p)
		{
			const double d = Distance(p, x);
			const int candidate = tree.ids[slot];
			if (d < distance || (d == distance && candidate < id)) {
				distance = d;
				id = candidate;
			}
		}
	};

	std::vector<int> ids;
	std::vector<Point3d> sorted;
	/// Of the sorted points, from the origin, scaled; padded by infinities.
	std::array<std::vector<float>, 3> coordinate;
	/// The inner nodes of a complete tree, the children of i from 4 i + 1 on. The leaves follow.
	std::vector<Node> nodes;
	std::vector<int> leafStart; ///< in `sorted`, and where the last one ends
	Point3d origin = Point3d(0, 0, 0);
	/// A power of two, which changes no digit: squares of any size fit into single precision.
	double scale = 1;
	double slack;

	static double scaleOf(double diagonal)
	{
		constexpr int farthest = 300; // far beyond the exponents of single precision
		return diagonal > 0 && std::isfinite(diagonal)
			? std::exp2(-std::clamp(std::ilogb(diagonal), -farthest, farthest))
			: 1;
	}

	SingleBall toSingle(const Point3d& centre, double reach) const
	{
		// Seen from farther away, all points are equally far; squares of this are finite.
		constexpr double farthest = 1e18;
		constexpr double largest = std::numeric_limits<float>::max();
		const Point3d c = (centre - origin) * scale;
		const auto near = [&](double x) { return float(std::clamp(x, -farthest, farthest)); };
		const double enlarged =
			reach * (1 + 8 * std::numeric_limits<float>::epsilon()) * scale + slack;
		return {
			{near(c[0]), near(c[1]), near(c[2])}, float(std::min(enlarged * enlarged, largest))};
	}

	bool isLeaf(int node) const { return node >= int(nodes.size()); }

	/// Searches some nodes of a level. The nodes descend together: one by one, each would wait for
	/// the boxes of the one before.
	template <class Ball>
	void searchTogether(const int* some, int count, SingleBall& single, Ball& ball) const
	{
		if (isLeaf(some[0])) {
			for (int i = 0; i < count; ++i)
				if (visitLeaf(some[i], single, ball))
					single = toSingle(ball.centre(), ball.reach());
			return;
		}
		constexpr int together = 8;
		std::array<int, 4 * together> inside;
		int found = 0;
		for (int i = 0; i < count; ++i) {
			const Eigen::Array4f distances = nodes[some[i]].squaredDistances(single.centre);
			found += writeWithin(distances, single.squaredReach, 4 * some[i] + 1, &inside[found]);
		}
		for (int first = 0; first < found; first += together)
			searchTogether(&inside[first], std::min(found - first, together), single, ball);
	}

	template <class Ball>
	void searchNearestFirst(SingleBall& single, Ball& ball) const
	{
		struct Place
		{
			int node;
			float squaredDistance; ///< of its bounds from the centre, when it was found
		};
		std::array<Place, 64> stack; // three a level and one to spare; 4^21 leaves fill it
		int top = 0;
		if (!ids.empty())
			stack[top++] = {0, 0};
		while (top > 0) {
			const Place place = stack[--top];
			if (place.squaredDistance > single.squaredReach)
				continue; // the ball has shrunk
			if (isLeaf(place.node)) {
				if (visitLeaf(place.node, single, ball))
					single = toSingle(ball.centre(), ball.reach());
				continue;
			}
			const Eigen::Array4f squaredDistance =
				nodes[place.node].squaredDistances(single.centre);
			const int first = top;
			for (int k = 0; k < 4; ++k) {
				stack[top] = {4 * place.node + 1 + k, squaredDistance[k]};
				top += squaredDistance[k] <= single.squaredReach;
			}
			std::sort(
				stack.begin() + first, stack.begin() + top, [](const Place& a, const Place& b) {
					return a.squaredDistance > b.squaredDistance;
				});
		}
	}

	/// @return whether any point was visited.
	template <class Ball>
	bool visitLeaf(int leaf, const SingleBall& single, Ball& ball) const
	{
		const int begin = leafStart[leaf - nodes.size()], end = leafStart[leaf - nodes.size() + 1];
		using Four = Eigen::Array4f;
		std::array<int, LeafSize + Lanes> inside; // from the last to the first
		int found = 0;
		for (int first = begin + (end - begin - 1) / Lanes * Lanes; first >= begin;
			 first -= Lanes) {
			Four sum = Four::Zero();
			for (int axis = 0; axis < 3; ++axis)
				sum += (Eigen::Map<const Four>(&coordinate[axis][first]) - single.centre[axis])
						   .square();
			found += writeWithin(sum, single.squaredReach, first, &inside[found]);
		}
		// The last group may hold points of the next leaf, which has its own turn.
		int beyond = 0;
		while (beyond < found && inside[beyond] >= end)
			++beyond;
		for (int i = found - 1; i >= beyond; --i)
			ball.visit(inside[i], sorted[inside[i]]);
		return found > beyond;
	}

	/// A point beside its id while the tree is built: fetched by the id, points would be far apart.
	struct Sample
	{
		Point3d point;
		int id;
	};

	static Box3d bounds(const std::vector<Sample>& samples, int begin, int end)
	{
		// Without the branches of Box3d::Add().
		Point3d low = samples[begin].point, high = low;
		for (int i = begin + 1; i < end; ++i)
			for (int axis = 0; axis < 3; ++axis) {
				low[axis] = std::min(low[axis], samples[i].point[axis]);
				high[axis] = std::max(high[axis], samples[i].point[axis]);
			}
		return Box3d(low, high);
	}

	/// Sorts samples into two halves. @param box of them. @return where the second one begins.
	static int split(std::vector<Sample>& samples, const Box3d& box, int begin, int end)
	{
		const int axis = box.MaxDim(), middle = begin + (end - begin) / 2;
		std::nth_element(samples.begin() + begin, samples.begin() + middle, samples.begin() + end,
			[axis](const Sample& a, const Sample& b) {
				const double x = a.point[axis], y = b.point[axis];
				return x != y ? x < y : a.id < b.id;
			});
		return middle;
	}

	/// Sets the bounds of a node's child. @return its box.
	Box3d setChild(const std::vector<Sample>& samples, int node, int child, int begin, int end)
	{
		const Box3d box = bounds(samples, begin, end);
		nodes[node].boxes.set(child, Box3d(box.min * scale, box.max * scale), origin * scale);
		nodes[node].slabs.set(
			child, end - begin, [&](int i) { return samples[begin + i].point * scale; },
			origin * scale, slack);
		return box;
	}

	/// build() of the whole tree: its halves are sorted, then its quarters built, several at once.
	void buildAll(std::vector<Sample>& samples, const Box3d& box, const Progress& progress)
	{
		constexpr int minForTeam = 1 << 12;
		const int root = 0, count = int(samples.size());
		if (count < minForTeam) {
			build(samples, box, root, 0, count, progress);
			return;
		}
		const Quarters cuts = quarteredRange(
			count, progress.part(0, 0.3), sorting, [&](int begin, int end, const Progress&) {
				return split(
					samples, end - begin == count ? box : bounds(samples, begin, end), begin, end);
			});
		forEachQuarter(cuts, progress.part(0.3, 1), sorting,
			[&](int child, int begin, int end, const Progress& part) {
				build(samples, setChild(samples, root, child, begin, end), 4 * root + 1 + child,
					begin, end, part);
			});
	}

	/// @param box of the samples from `begin` to `end`.
	void build(std::vector<Sample>& samples, const Box3d& box, int node, int begin, int end,
		const Progress& progress)
	{
		constexpr int reportFrom = 1 << 13;
		if (isLeaf(node)) {
			leafStart[node - nodes.size()] = begin;
			return;
		}
		const bool isLarge = end - begin >= reportFrom;
		const auto ask = [&] {
			if (isLarge)
				progress.check();
		};
		Quarters cuts = {begin, 0, 0, 0, end};
		ask();
		cuts[2] = split(samples, box, begin, end);
		ask();
		cuts[1] = split(samples, bounds(samples, begin, cuts[2]), begin, cuts[2]);
		ask();
		cuts[3] = split(samples, bounds(samples, cuts[2], end), cuts[2], end);
		for (int k = 0; k < 4; ++k) {
			if (isLarge)
				progress.report(k / 4.0, sorting);
			build(samples, setChild(samples, node, k, cuts[k], cuts[k + 1]), 4 * node + 1 + k,
				cuts[k], cuts[k + 1], isLarge ? progress.part(k / 4.0, (k + 1) / 4.0) : progress);
		}
	}
};

} // namespace vcg::tri::mcf

#endif
