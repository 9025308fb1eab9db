// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Small cones over the border of weighted triangles: with them the triangles are closed.

#ifndef VCG_MCF_BOUNDARY_CONES_H
#define VCG_MCF_BOUNDARY_CONES_H

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Triangles that close others. The border of weighted triangles is the sum of their edges, each with
 * its triangle's weight, where those of neighbours cancel; the cones have the same border, turned
 * around. So
 *
 *     w(triangles) = w(triangles and cones) - w(cones)
 *
 * for the winding number w. The first is constant in each region that triangles and cones enclose and
 * can be counted along a ray; for the second, only the cones have to be visited.
 */
struct BoundaryCones
{
	std::vector<Point3d> points;     ///< those of the triangles, then those that only cones have
	std::vector<Triangle> triangles; ///< of the cones
	std::vector<double> weights;     ///< of `triangles`
};

namespace detail {

/**
 * Makes BoundaryCones. The border is collapsed level by level: all of its vertices in a cell of a grid
 * move to their mean, and the cells double until no edge is left. The triangles that the edges sweep
 * are the cones. Fine borders give small cones, most of which a tree of moments approximates; cones
 * with a single apex would be long, and near every point.
 */
class ConeMaker
{
public:
	ConeMaker(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		const std::vector<double>& weights, const Progress& progress) :
			cancel(progress.cancelOnly())
	{
		cones.points = points;
		findBorder(triangles, weights, progress);
	}

	BoundaryCones run()
	{
		if (border.empty())
			return std::move(cones);
		Box3d box;
		std::vector<double> lengths;
		for (const Edge& edge : border) {
			for (int v : {edge.from, edge.to})
				box.Add(cones.points[size_t(v)]);
			lengths.push_back(
				Distance(cones.points[size_t(edge.from)], cones.points[size_t(edge.to)]));
		}
		constexpr double finest = 1e-6; // of the border's diagonal
		const auto middle = lengths.begin() + std::ptrdiff_t(lengths.size() / 2);
		std::nth_element(lengths.begin(), middle, lengths.end());
		const double smallest = std::max(2 * *middle, finest * box.Diag());
		// A border all in one place is swept at once, with any cells.
		for (double cell = smallest > 0 ? smallest : 1; !border.empty(); cell *= 2)
			sweep(box.min, cell);
		return std::move(cones);
	}

private:
	static constexpr double rounding = 1e-9; // of sums of weights

	/// With its weight, from the lower vertex to the higher.
	struct Edge
	{
		int from, to;
		double weight;
		bool operator<(const Edge& other) const
		{
			return std::tie(from, to, weight) < std::tie(other.from, other.to, other.weight);
		}
	};

	Progress cancel;
	BoundaryCones cones;
	std::vector<Edge> border;

	static Edge edgeBetween(int a, int b, double weight)
	{
		return a < b ? Edge {a, b, weight} : Edge {b, a, -weight};
	}

	/// Calls visit(edge) for each sum of the equal ones among sorted edges that is not 0.
	template <class Visit>
	static void forEachSum(const Edge* begin, const Edge* end, const Visit& visit)
	{
		while (begin != end) {
			Edge sum = *begin;
			for (++begin; begin != end && begin->from == sum.from && begin->to == sum.to; ++begin)
				sum.weight += begin->weight;
			if (sum.from != sum.to && std::abs(sum.weight) > rounding)
				visit(sum);
		}
	}

	void findBorder(const std::vector<Triangle>& triangles, const std::vector<double>& weights,
		const Progress& progress)
	{
		const auto edge = [&](int i) {
			const Triangle& t = triangles[size_t(i) / 3];
			return edgeBetween(t[size_t(i) % 3], t[size_t(i + 1) % 3],
				weights.empty() ? 1 : weights[size_t(i) / 3]);
		};
		const SortedGroups<Edge> edges(
			3 * int(triangles.size()), cones.points.size(), [&](int i) { return edge(i).from; },
			edge, progress, "Closing holes by cones");
		cancellableLoop(int(cones.points.size()), cancel, [&](int v) {
			const auto [begin, end] = edges.of(v);
			forEachSum(begin, end, [&](const Edge& sum) { border.push_back(sum); });
		});
	}

	/// Moves the vertices of the border in each cell of a grid to their mean.
	void sweep(const Point3d& origin, double size)
	{
		using Cell = std::array<long long, 3>;
		std::vector<int> vertices;
		for (const Edge& edge : border)
			for (int v : {edge.from, edge.to})
				vertices.push_back(v);
		sortCancellable(vertices, 0, vertices.size(), cancel);
		vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
		std::vector<std::pair<Cell, int>> inCell; // indices into `vertices`
		for (size_t i = 0; i < vertices.size(); ++i) {
			const Point3d at = (cones.points[size_t(vertices[i])] - origin) / size;
			inCell.push_back(
				{{std::llround(at[0]), std::llround(at[1]), std::llround(at[2])}, int(i)});
		}
		sortCancellable(inCell, 0, inCell.size(), cancel);
		std::vector<int> apex(vertices.size());
		for (size_t begin = 0; begin < inCell.size();) {
			size_t end = begin;
			Point3d sum(0, 0, 0);
			for (; end < inCell.size() && inCell[end].first == inCell[begin].first; ++end)
				sum += cones.points[size_t(vertices[size_t(inCell[end].second)])];
			int own = vertices[size_t(inCell[begin].second)];
			if (end - begin > 1) {
				own = int(cones.points.size());
				cones.points.push_back(sum / double(end - begin));
			}
			for (; begin < end; ++begin)
				apex[size_t(inCell[begin].second)] = own;
		}
		const auto apexOf = [&](int v) {
			return apex[size_t(
				std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin())];
		};
		std::vector<Edge> drawn;
		cancellableLoop(int(border.size()), cancel, [&](int i) {
			const auto [a, b, weight] = border[size_t(i)];
			const int c = apexOf(a), d = apexOf(b);
			add({b, a, c}, weight);
			add({b, c, d}, weight);
			drawn.push_back(edgeBetween(c, d, weight));
		});
		sortCancellable(drawn, 0, drawn.size(), cancel);
		border.clear();
		forEachSum(drawn.data(), drawn.data() + drawn.size(),
			[&](const Edge& sum) { border.push_back(sum); });
	}

	void add(const Triangle& t, double weight)
	{
		if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
			return;
		cones.triangles.push_back(t);
		cones.weights.push_back(weight);
	}
};

} // namespace detail

/// @param weights  of the triangles; empty: 1 each.
/// @throws Cancelled. Complexity: O(F + B log B log(d / l)) for B edges of the border, of length l in
///         the median, and its diagonal d; for bounded valence.
inline BoundaryCones boundaryCones(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<double>& weights,
	const Progress& progress = Progress())
{
	return detail::ConeMaker(points, triangles, weights, progress).run();
}

} // namespace vcg::tri::mcf

#endif
