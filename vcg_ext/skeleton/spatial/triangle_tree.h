// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A tree of boxes over triangles: closest points, crossings of segments, faces in a box.

#ifndef VCG_MCF_TRIANGLE_TREE_H
#define VCG_MCF_TRIANGLE_TREE_H

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A balanced binary tree of bounding boxes over triangles, which need neither be closed nor
 * manifold nor oriented. The same triangles in the same order give the same answers.
 */
class TriangleTree
{
public:
	/// A node of the triangles order()[begin], ..., order()[end - 1]; its left child is the next.
	struct Node
	{
		Box3d box;
		int begin, end;
		int right; ///< -1: a leaf

		bool isLeaf() const { return right < 0; }
	};

	/// The point of the triangles that is closest to a query.
	struct Closest
	{
		Point3d point;
		double distance;
		int face; ///< -1 if no triangle is within reach
	};

	/**
	 * @param points    mesh units, finite; kept by reference, as are the triangles.
	 * @param triangles corners as indices into `points`.
	 * @throws Cancelled. Complexity: O(F log F).
	 */
	TriangleTree(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const Progress& progress = Progress()) :
			points(points),
			triangles(triangles)
	{
		std::vector<Sample> samples;
		samples.reserve(triangles.size());
		detail::reportedLoop(int(triangles.size()), progress.part(0, 0.1), sorting, [&](int f) {
			samples.push_back({(corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3.0, f});
		});
		nodes.resize(triangles.empty() ? 0 : size_t(nodesOf(int(triangles.size()))));
		if (!triangles.empty())
			buildAll(samples, progress.part(0.1, 0.9));
		ids.reserve(triangles.size());
		detail::reportedLoop(int(triangles.size()), progress.part(0.9, 1), sorting,
			[&](int i) { ids.push_back(samples[size_t(i)].id); });
	}

	const std::vector<Node>& allNodes() const { return nodes; }
	const std::vector<int>& order() const { return ids; }
	const std::vector<Point3d>& allPoints() const { return points; }
	const std::vector<Triangle>& allTriangles() const { return triangles; }
	const Point3d& corner(int f, int k) const
	{
		return points[size_t(triangles[size_t(f)][size_t(k)])];
	}
	const Triangle& triangle(int f) const { return triangles[size_t(f)]; }
	int size() const { return int(ids.size()); }

	/// The closest point; of equally close ones, the one on the triangle that is visited first.
	/// @param reach only points nearer than this are found. Complexity: about O(log F).
	Closest closest(const Point3d& p, double reach = std::numeric_limits<double>::infinity()) const
	{
		Closest best = {p, reach, -1};
		if (nodes.empty())
			return best;
		double squared = reach * reach;
		struct Place
		{
			int node;
			double squared;
		};
		std::array<Place, 128> stack;
		int top = 0;
		stack[size_t(top++)] = {0, squaredDistance(nodes[0].box, p)};
		while (top > 0) {
			const Place place = stack[size_t(--top)];
			if (place.squared > squared)
				continue;
			const Node& node = nodes[size_t(place.node)];
			if (node.isLeaf()) {
				for (int i = node.begin; i < node.end; ++i) {
					const int f = ids[size_t(i)];
					const detail::TrianglePoint on =
						detail::closestOnTriangle(corner(f, 0), corner(f, 1), corner(f, 2), p);
					if (on.squaredDistance < squared) {
						squared = on.squaredDistance;
						best.point = on.point;
						best.face = f;
					}
				}
				continue;
			}
			Place near = {place.node + 1, squaredDistance(nodes[size_t(place.node) + 1].box, p)};
			Place far = {node.right, squaredDistance(nodes[size_t(node.right)].box, p)};
			if (far.squared < near.squared)
				std::swap(near, far);
			stack[size_t(top++)] = far;
			stack[size_t(top++)] = near;
		}
		best.distance = std::sqrt(squared);
		return best;
	}

	/// Calls visit(face, t, forward) for each triangle that the segment p + t (q - p), t in [0, 1],
	/// crosses; forward: along the triangle's normal. A crossing of an edge may be reported for
	/// both of its triangles.
	/// Complexity: O(log F + crossings).
	template <class Visit>
	void forEachCrossing(const Point3d& p, const Point3d& q, const Visit& visit) const
	{
		constexpr double rounding = 1e-9; // a segment through an edge must hit one of its triangles
		const Point3d step = q - p;
		const Segment segment(p, step);
		forEachLeaf([&](const Box3d& box) { return segment.meets(box); },
			[&](int f) {
				const Point3d& a = corner(f, 0);
				const Point3d e1 = corner(f, 1) - a, e2 = corner(f, 2) - a;
				const Point3d across = step ^ e2;
				const double determinant = e1 * across;
				if (determinant == 0)
					return;
				const Point3d from = p - a;
				const double u = (from * across) / determinant;
				const Point3d aside = from ^ e1;
				const double w = (step * aside) / determinant;
				const double t = (e2 * aside) / determinant;
				if (u >= -rounding && w >= -rounding && u + w <= 1 + rounding && t >= 0 && t <= 1)
					visit(f, t, determinant < 0);
			});
	}

	/// Calls visit(face) for each triangle whose box meets a box; boxes that only touch do.
	template <class Visit>
	void forEachFaceIn(const Box3d& box, const Visit& visit) const
	{
		forEachLeaf([&](const Box3d& own) { return meet(own, box); },
			[&](int f) {
				if (meet(boxOf(f), box))
					visit(f);
			});
	}

	/// The topmost nodes that hold at most so many triangles, and leaves; together they hold all.
	/// Complexity: O(F / most).
	std::vector<int> nodesOfAtMost(int most) const
	{
		std::vector<int> found, stack;
		if (!nodes.empty())
			stack.push_back(0);
		while (!stack.empty()) {
			const int at = stack.back();
			stack.pop_back();
			const Node& node = nodes[size_t(at)];
			if (node.isLeaf() || node.end - node.begin <= most) {
				found.push_back(at);
				continue;
			}
			stack.push_back(node.right);
			stack.push_back(at + 1);
		}
		return found;
	}

	static bool meet(const Box3d& a, const Box3d& b)
	{
		for (int k = 0; k < 3; ++k)
			if (a.min[k] > b.max[k] || b.min[k] > a.max[k])
				return false;
		return true;
	}

	Box3d boxOf(int f) const
	{
		Box3d box;
		for (int k = 0; k < 3; ++k)
			box.Add(corner(f, k));
		return box;
	}

private:
	static constexpr const char* sorting = "Sorting the triangles";
	static constexpr int leafSize = 4;

	const std::vector<Point3d>& points;
	const std::vector<Triangle>& triangles;
	std::vector<int> ids;
	std::vector<Node> nodes;

	/// The segment p + t step, t in [0, 1], against boxes.
	class Segment
	{
	public:
		Segment(const Point3d& p, const Point3d& step) : p(p), step(step) {}

		/// Whether they meet, rounded in favour of meeting.
		bool meets(const Box3d& box) const
		{
			constexpr double margin = 1e-9; // as far as a crossing may be beyond its triangle
			double first = -margin, last = 1 + margin;
			for (int k = 0; k < 3; ++k) {
				const double beyond =
					margin * (box.max[k] - box.min[k]) + margin * std::abs(step[k]);
				const double low = box.min[k] - beyond - p[k], high = box.max[k] + beyond - p[k];
				if (step[k] == 0) {
					if (low > 0 || high < 0)
						return false;
					continue;
				}
				const double a = low / step[k], b = high / step[k];
				first = std::max(first, std::min(a, b));
				last = std::min(last, std::max(a, b));
			}
			return first <= last;
		}

	private:
		Point3d p, step;
	};

	/// Calls visit(face) for each triangle of the leaves that isNear(box) leads to from the root.
	template <class IsNear, class Visit>
	void forEachLeaf(const IsNear& isNear, const Visit& visit) const
	{
		if (nodes.empty())
			return;
		std::array<int, 128> stack;
		int top = 0;
		stack[size_t(top++)] = 0;
		while (top > 0) {
			const int at = stack[size_t(--top)];
			const Node& node = nodes[size_t(at)];
			if (!isNear(node.box))
				continue;
			if (node.isLeaf()) {
				for (int i = node.begin; i < node.end; ++i)
					visit(ids[size_t(i)]);
				continue;
			}
			stack[size_t(top++)] = node.right;
			stack[size_t(top++)] = at + 1;
		}
	}

	static double squaredDistance(const Box3d& box, const Point3d& p)
	{
		double sum = 0;
		for (int k = 0; k < 3; ++k) {
			const double beyond = std::max({box.min[k] - p[k], p[k] - box.max[k], 0.0});
			sum += beyond * beyond;
		}
		return sum;
	}

	/// The centroid of a triangle beside its id while the tree is built: fetched by the id, centroids
	/// would be far apart.
	struct Sample
	{
		Point3d middle;
		int id;
	};

	/// The number of nodes of a tree of so many triangles. Complexity: O(count).
	static int nodesOf(int count)
	{
		return count <= leafSize ? 1 : 1 + nodesOf(count / 2) + nodesOf(count - count / 2);
	}

	/// Sorts the samples of a node into two halves. @return where the second one begins.
	static int halve(std::vector<Sample>& samples, int begin, int end, const Cancellation& cancel)
	{
		constexpr int many = 1 << 13;
		const auto ask = [&] {
			if (end - begin >= many)
				cancel.check();
		};
		ask();
		Box3d spread;
		for (int i = begin; i < end; ++i)
			spread.Add(samples[size_t(i)].middle);
		ask();
		const int axis = spread.MaxDim();
		const int half = begin + (end - begin) / 2;
		std::nth_element(samples.begin() + begin, samples.begin() + half, samples.begin() + end,
			[axis](const Sample& a, const Sample& b) {
				const double x = a.middle[axis], y = b.middle[axis];
				return x != y ? x < y : a.id < b.id;
			});
		return half;
	}

	/// Makes an inner node, whose subtrees exist.
	void join(int at, int begin, int end, int right)
	{
		Box3d box = nodes[size_t(at) + 1].box;
		box.Add(nodes[size_t(right)].box);
		nodes[size_t(at)] = {box, begin, end, right};
	}

	/// build() of the whole tree: its halves are sorted, then its quarters built, several at once.
	void buildAll(std::vector<Sample>& samples, const Progress& progress)
	{
		constexpr int minForTeam = 1 << 12;
		const int root = 0, count = int(samples.size());
		if (count < minForTeam) {
			build(samples, root, 0, count, progress);
			return;
		}
		const Quarters cuts = quarteredRange(
			count, progress.part(0, 0.2), sorting, [&](int begin, int end, const Progress& part) {
				return halve(samples, begin, end, part);
			});
		std::array<int, 4> at; // the roots of the quarters
		at[0] = root + 2;
		at[1] = at[0] + nodesOf(cuts[1]);
		const int right = at[1] + nodesOf(cuts[2] - cuts[1]);
		at[2] = right + 1;
		at[3] = at[2] + nodesOf(cuts[3] - cuts[2]);
		forEachQuarter(cuts, progress.part(0.2, 1), sorting,
			[&](int quarter, int begin, int end, const Progress& part) {
				build(samples, at[size_t(quarter)], begin, end, part);
			});
		join(root + 1, 0, cuts[2], at[1]);
		join(right, cuts[2], count, at[3]);
		join(root, 0, count, right);
	}

	/// Builds the subtree of node `at`. @return the place after its last node.
	int build(std::vector<Sample>& samples, int at, int begin, int end, const Progress& progress)
	{
		if (end - begin <= leafSize) {
			Box3d box;
			for (int i = begin; i < end; ++i)
				box.Add(boxOf(samples[size_t(i)].id));
			nodes[size_t(at)] = {box, begin, end, -1};
			return at + 1;
		}
		const int half = halve(samples, begin, end, progress);
		const int right = build(samples, at + 1, begin, half, progress);
		const int after = build(samples, right, half, end, progress);
		join(at, begin, end, right);
		return after;
	}
};

} // namespace vcg::tri::mcf

#endif
