// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Short paths over a surface, from one of its points to another.

#ifndef VCG_MCF_SURFACE_WAYS_H
#define VCG_MCF_SURFACE_WAYS_H

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Paths over a surface that cross its triangles: where triangles are few and large, paths along the
 * edges would be long detours.
 *
 * Shortest paths (A*) of a graph whose nodes are the vertices and evenly spaced points of the
 * edges, and in which all nodes of a triangle are neighbours; the points then slide along their
 * edges to where the path is shortest.
 */
class SurfaceWays
{
public:
	/// A point of the surface.
	struct Place
	{
		Point3d point;
		/// The unit normal that leads inwards; zero where the triangles around have no area.
		Point3d inward;
	};

	/**
	 * @param points    of the surface; kept by reference.
	 * @param triangles corners as indices into `points`; kept by reference.
	 * @param spacing   maximum distance of the nodes along an edge, in the points' unit; > 0.
	 * @param cancellation  also of way().
	 * @throws Cancelled. Complexity: O(F log F + N) for N nodes.
	 */
	SurfaceWays(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
		double spacing, Cancellation cancellation = Cancellation()) :
			points(points),
			triangles(triangles), cancel(std::move(cancellation)),
			inward(detail::filledArray(points.size(), Point3d(0, 0, 0), cancel)),
			facesAt(points.size()), edgesOf(triangles.size())
	{
		const int faces = int(triangles.size());
		detail::cancellableLoop(faces, cancel, [&](int f) {
			const Point3d n = normal(f);
			for (int v : triangles[size_t(f)]) {
				inward[size_t(v)] -= n;
				facesAt[size_t(v)].push_back(f);
			}
		});
		std::vector<std::tuple<int, int, int, int>> sides; // ends, face, side
		detail::cancellableLoop(faces, cancel, [&](int f) {
			const Triangle& t = triangles[size_t(f)];
			for (int k = 0; k < 3; ++k) {
				const int v = t[k], w = t[(k + 1) % 3];
				sides.emplace_back(std::min(v, w), std::max(v, w), f, k);
			}
		});
		detail::sortCancellable(sides, 0, sides.size(), cancel);
		detail::cancellableLoop(int(sides.size()), cancel, [&](int i) {
			const auto& [v, w, f, k] = sides[size_t(i)];
			if (edges.empty() || edges.back().ends != std::array<int, 2> {v, w})
				addEdge(v, w, spacing);
			edges.back().faces.push_back(f);
			edgesOf[size_t(f)][size_t(k)] = int(edges.size()) - 1;
		});
	}

	/// The triangles at a vertex.
	const std::vector<int>& facesAtVertex(int v) const { return facesAt[size_t(v)]; }

	/// The point of a triangle that is closest to another point.
	Place closestIn(int f, const Point3d& point) const
	{
		const Triangle& t = triangles[size_t(f)];
		const Point3d on = detail::closestOnTriangle(
			points[size_t(t[0])], points[size_t(t[1])], points[size_t(t[2])], point)
							   .point;
		return {on, unit(-normal(f))};
	}

	/**
	 * Where a short path from one point of the surface to another crosses edges, in order.
	 * @param fromFace the triangle with `from`.
	 * @param toFace   the one with `to`.
	 * @return empty within one triangle, or where there is no path.
	 * @throws Cancelled. Complexity: O(N log N), less for ends that are near each other.
	 */
	std::vector<Place> way(int fromFace, const Point3d& from, int toFace, const Point3d& to) const
	{
		if (fromFace == toFace)
			return {};
		const std::vector<int> nodes = shortestPath(fromFace, from, toFace, to);
		std::vector<Place> places;
		places.reserve(nodes.size());
		for (int x : nodes)
			places.push_back({pointOf(x), Point3d(0, 0, 0)});
		slideAlongEdges(nodes, places, from, to);
		for (size_t i = 0; i < nodes.size(); ++i)
			places[i].inward = inwardAt(nodes[i]);
		return places;
	}

private:
	struct Edge
	{
		std::array<int, 2> ends;
		/// The edge has `pieces - 1` nodes, numbered from `firstNode` on.
		int firstNode, pieces;
		std::vector<int> faces;
	};

	const std::vector<Point3d>& points;
	const std::vector<Triangle>& triangles;
	Cancellation cancel;
	std::vector<Point3d> inward; ///< not of unit length
	std::vector<std::vector<int>> facesAt;
	std::vector<std::array<int, 3>> edgesOf;
	std::vector<Edge> edges;
	/// Of each node that is not a vertex; these are numbered after the vertices.
	std::vector<int> edgeOfNode;

	static Point3d unit(const Point3d& n)
	{
		const double length = n.Norm();
		return length > 0 ? Point3d(n / length) : n;
	}

	Point3d normal(int f) const
	{
		const Triangle& t = triangles[size_t(f)];
		const Point3d& a = points[size_t(t[0])];
		return (points[size_t(t[1])] - a) ^ (points[size_t(t[2])] - a);
	}

	void addEdge(int v, int w, double spacing)
	{
		const double length = Distance(points[size_t(v)], points[size_t(w)]);
		const int pieces = std::max(1, int(std::ceil(length / spacing)));
		edges.push_back({{v, w}, nodeCount(), pieces, {}});
		edgeOfNode.insert(edgeOfNode.end(), size_t(pieces - 1), int(edges.size()) - 1);
	}

	int nodeCount() const { return int(points.size() + edgeOfNode.size()); }
	bool isVertex(int x) const { return size_t(x) < points.size(); }
	const Edge& edgeAt(int x) const { return edges[size_t(edgeOfNode[size_t(x) - points.size()])]; }

	Point3d pointOf(int x) const
	{
		if (isVertex(x))
			return points[size_t(x)];
		const Edge& edge = edgeAt(x);
		const double t = double(x - edge.firstNode + 1) / edge.pieces;
		return points[size_t(edge.ends[0])] * (1 - t) + points[size_t(edge.ends[1])] * t;
	}

	Point3d inwardAt(int x) const
	{
		if (isVertex(x))
			return unit(inward[size_t(x)]);
		Point3d sum(0, 0, 0);
		for (int f : edgeAt(x).faces)
			sum -= unit(normal(f));
		return unit(sum);
	}

	template <class Visit>
	void forEachNodeOf(int f, const Visit& visit) const
	{
		for (int v : triangles[size_t(f)])
			visit(v);
		for (int e : edgesOf[size_t(f)]) {
			const Edge& edge = edges[size_t(e)];
			for (int x = edge.firstNode; x < edge.firstNode + edge.pieces - 1; ++x)
				visit(x);
		}
	}

	const std::vector<int>& facesOf(int x) const
	{
		return isVertex(x) ? facesAt[size_t(x)] : edgeAt(x).faces;
	}

	std::vector<int> shortestPath(
		int fromFace, const Point3d& from, int toFace, const Point3d& to) const
	{
		// Length so far plus the straight distance to the end, length so far, node.
		using Entry = std::tuple<double, double, int>;
		std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
		const double infinity = std::numeric_limits<double>::infinity();
		std::vector<double> distance = detail::filledArray(size_t(nodeCount()), infinity, cancel);
		std::vector<int> previous = detail::filledArray(distance.size(), -1, cancel);
		const auto reach = [&](int f, const Point3d& at, double so, int before) {
			forEachNodeOf(f, [&](int x) {
				const Point3d p = pointOf(x);
				const double further = so + Distance(at, p);
				if (further < distance[size_t(x)]) {
					distance[size_t(x)] = further;
					previous[size_t(x)] = before;
					queue.emplace(further + Distance(p, to), further, x);
				}
			});
		};
		reach(fromFace, from, 0, -1);
		std::vector<int> path;
		constexpr size_t checkEvery = 1 << 12;
		for (size_t taken = 0; !queue.empty(); ++taken) {
			if (taken % checkEvery == 0)
				cancel.check();
			const auto [all, so, x] = queue.top();
			queue.pop();
			if (so > distance[size_t(x)])
				continue;
			const std::vector<int>& faces = facesOf(x);
			if (std::find(faces.begin(), faces.end(), toFace) != faces.end()) {
				for (int y = x; y >= 0; y = previous[size_t(y)])
					path.push_back(y);
				std::reverse(path.begin(), path.end());
				return path;
			}
			for (int f : faces)
				reach(f, pointOf(x), so, x);
		}
		return path;
	}

	/// Moves each place on an edge to where the straight line between its neighbours crosses the
	/// edge, both triangles unfolded into one plane.
	void slideAlongEdges(const std::vector<int>& nodes, std::vector<Place>& places,
		const Point3d& from, const Point3d& to) const
	{
		constexpr int rounds = 8;
		for (int round = 0; round < rounds; ++round)
			for (size_t i = 0; i < nodes.size(); ++i) {
				if (isVertex(nodes[i]))
					continue;
				const std::array<int, 2>& ends = edgeAt(nodes[i]).ends;
				const Point3d& a = points[size_t(ends[0])];
				const Point3d along = points[size_t(ends[1])] - a;
				const double squared = along.SquaredNorm();
				const auto part = [&](const Point3d& p) { return (p - a) * along / squared; };
				const Point3d& before = i == 0 ? from : places[i - 1].point;
				const Point3d& after = i + 1 == nodes.size() ? to : places[i + 1].point;
				const double s = part(before), t = part(after);
				const double ofBefore = Distance(before, a + along * s);
				const double ofAfter = Distance(after, a + along * t);
				if (ofBefore + ofAfter > 0)
					places[i].point = a
						+ along
							* std::clamp(
								(s * ofAfter + t * ofBefore) / (ofBefore + ofAfter), 0.0, 1.0);
			}
	}
};

} // namespace vcg::tri::mcf

#endif
