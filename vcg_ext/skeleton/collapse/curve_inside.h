// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What of a curve has left the solid that it came from is brought back inside.

#ifndef VCG_MCF_CURVE_INSIDE_H
#define VCG_MCF_CURVE_INSIDE_H

#include "collapse_to_curve.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/flow/stage.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_radius.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/solid_test.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// How far outside a point may be, of the diagonal: what rounding in the shape's coordinates makes, see
/// PrincipalFrame::onGrid().
constexpr double outsideTolerance = 5e-7;

/// A component of a curve on its way into its solid. Lengths and places are those of the SolidTest.
class CurveIntoSolid
{
public:
	/// @param place of each node. @param edges pairs of nodes. @param tolerance how far outside a point may be.
	CurveIntoSolid(const SolidTest& solid, std::vector<Point3d> place,
		std::vector<std::array<int, 2>> edges, const Progress& progress,
		double tolerance = outsideTolerance) :
			solid(solid),
			place(std::move(place)), edges(std::move(edges)), progress(progress),
			tolerance(tolerance)
	{
	}

	/// For each node the vertices of the surface that have merged into it; empty where that is not known.
	std::vector<std::vector<int>> merged;

	const std::vector<Point3d>& places() const { return place; }
	/// 1 for nodes that have moved or are new. New ones follow those that were given.
	const std::vector<char>& changedNodes() const { return changed; }
	const std::vector<std::array<int, 2>>& curveEdges() const { return edges; }

	/**
	 * Moves nodes that are outside, then bends the edges that are. @return whether anything was outside.
	 * @throws SolverError if something still is; Cancelled.
	 */
	bool bringInside()
	{
		changed.assign(place.size(), 0);
		std::vector<char> isOutside(place.size(), 0);
		bool any = false;
		for (size_t A = 0; A < place.size(); ++A) {
			report();
			isOutside[A] = !solid.isInside(place[A], tolerance);
			any |= isOutside[A];
		}
		const auto isInside = [&](const std::array<int, 2>& edge) {
			return segmentIsInside(place[edge[0]], place[edge[1]]);
		};
		if (!any && std::all_of(edges.begin(), edges.end(), isInside))
			return false;
		std::vector<std::vector<int>> neighbours(place.size());
		for (const auto& [A, B] : edges) {
			neighbours[A].push_back(B);
			neighbours[B].push_back(A);
		}
		for (size_t A = 0; A < place.size(); ++A)
			if (isOutside[A])
				moveInside(int(A), neighbours[A]);
		double length = 0;
		for (const auto& [A, B] : edges)
			length += Distance(place[A], place[B]);
		const double maxLength = longestOfCurve * (length + 1);
		bool anyStraight = false;
		std::vector<std::array<int, 2>> bent;
		for (const auto& edge : edges) {
			if (isInside(edge)) {
				bent.push_back(edge);
				continue;
			}
			const Path way = inside(place[edge[0]], place[edge[1]]);
			length += lengthOf(way, place[edge[0]], place[edge[1]])
				- Distance(place[edge[0]], place[edge[1]]);
			if (!(length <= maxLength)) {
				length = maxLength;
				anyStraight = true;
				bent.push_back(edge);
				continue;
			}
			int last = edge[0];
			for (const Point3d& p : way) {
				const int next = int(place.size());
				place.push_back(p);
				changed.push_back(1);
				bent.push_back({last, next});
				last = next;
			}
			bent.push_back({last, edge[1]});
		}
		edges = std::move(bent);
		if (!anyStraight && !std::all_of(edges.begin(), edges.end(), isInside))
			throw SolverError("The curve could not be brought inside the shape.");
		return true;
	}

private:
	using Path = std::vector<Point3d>;

	/// Ways inside may make a curve this many times as long as itself and the diagonal together, no longer.
	static constexpr double longestOfCurve = 3;

	static double lengthOf(const Path& between, const Point3d& first, const Point3d& last)
	{
		double length = 0;
		const Point3d* from = &first;
		for (const Point3d& p : between) {
			length += Distance(*from, p);
			from = &p;
		}
		return length + Distance(*from, last);
	}

	const SolidTest& solid;
	std::vector<Point3d> place;
	std::vector<std::array<int, 2>> edges;
	const Progress& progress;
	double tolerance;
	std::vector<char> changed;
	/// The neighbours of each vertex of the surface, and its inward unit normal; made when they are needed.
	std::vector<std::vector<int>> around;
	std::vector<Point3d> inward;

	void report() const { progress.report(0, "Bringing the curve inside"); }

	bool segmentIsInside(const Point3d& p, const Point3d& q) const
	{
		report();
		return solid.segmentIsInside(p, q, tolerance);
	}

	/// A chord of the solid: from a point of the surface to half of the way to the other side.
	struct HalfChord
	{
		Point3d from, along;
		Point3d at(double part) const { return from + along * part; }
	};

	HalfChord halfChord(const Point3d& from, const Point3d& direction) const
	{
		const HalfChord half = {from, direction * (solid.chord(from, direction) / 2)};
		return solid.isInside(half.at(1)) ? half : HalfChord {from, Point3d(0, 0, 0)};
	}

	/// The chord that goes on inside where the way from a point outside to the surface ends.
	HalfChord chordBehind(const Point3d& outside) const
	{
		const SolidTest::Closest on = solid.closest(outside);
		return on.distance > 0 ? halfChord(on.point, (on.point - outside) / on.distance)
							   : HalfChord {on.point, Point3d(0, 0, 0)};
	}

	void findNeighbours()
	{
		if (!around.empty())
			return;
		size_t count = 0;
		for (const Triangle& t : solid.triangles())
			for (int v : t)
				count = std::max(count, size_t(v) + 1);
		around.resize(count);
		inward.assign(count, Point3d(0, 0, 0));
		for (const Triangle& t : solid.triangles()) {
			const Point3d &a = solid.vertex(t[0]), &b = solid.vertex(t[1]), &c = solid.vertex(t[2]);
			const Point3d n = (b - a) ^ (c - a);
			for (int k = 0; k < 3; ++k) {
				around[t[k]].push_back(t[(k + 1) % 3]); // the other half-edge adds the other way
				inward[t[k]] -= n;
			}
		}
		for (Point3d& n : inward)
			if (const double length = n.Norm(); length > 0)
				n /= length;
	}

	HalfChord chordAt(int v)
	{
		findNeighbours();
		return inward[v].SquaredNorm() > 0 ? halfChord(solid.vertex(v), inward[v])
										   : HalfChord {solid.vertex(v), Point3d(0, 0, 0)};
	}

	/**
	 * A node goes to the middle of a chord: from the nearest point of the surface where that is next to it,
	 * else from one of the vertices that have merged into it, the one whose chord's middle is nearest.
	 */
	void moveInside(int A, const std::vector<int>& neighbours)
	{
		constexpr double nextTo = 0.004; // two of the default epsilon
		constexpr size_t mostTried = 32;
		HalfChord best = chordBehind(place[A]);
		if (Distance(best.from, place[A]) > nextTo && !merged.empty() && !merged[A].empty()) {
			const size_t step = (merged[A].size() + mostTried - 1) / mostTried;
			double nearest = std::numeric_limits<double>::infinity();
			for (size_t i = 0; i < merged[A].size(); i += step) {
				const HalfChord candidate = chordAt(merged[A][i]);
				const double distance = SquaredDistance(candidate.at(1), place[A]);
				if (distance < nearest && candidate.along.SquaredNorm() > 0) {
					nearest = distance;
					best = candidate;
				}
			}
		}
		double part = 1;
		const auto isTaken = [&](int B) { return isSame(place[B], best.at(part)); };
		for (int i = 0; i < 20 && std::any_of(neighbours.begin(), neighbours.end(), isTaken); ++i)
			part *= 0.9;
		place[A] = best.at(part);
		changed[A] = 1;
	}

	/// The nodes between two others whose edge is outside somewhere.
	Path inside(const Point3d& p, const Point3d& q)
	{
		constexpr int deepest = 5;
		Path between;
		if (!bisected(p, q, deepest, between))
			between = alongSurface(p, q);
		simplify(p, q, between);
		return between;
	}

	/// Halves the segment until its parts are inside, with points that are outside moved to the middle of the
	/// chord behind. @return whether that is the case within so many levels.
	bool bisected(const Point3d& p, const Point3d& q, int levels, Path& between) const
	{
		if (segmentIsInside(p, q))
			return true;
		if (levels == 0)
			return false;
		Point3d middle = (p + q) / 2;
		if (!solid.isInside(middle))
			middle = chordBehind(middle).at(1);
		if (middle == p || middle == q || !bisected(p, middle, levels - 1, between))
			return false;
		between.push_back(middle);
		return bisected(middle, q, levels - 1, between);
	}

	/**
	 * A way that always is there: straight to the nearest point of the surface, over its edges, and back. It
	 * is lifted off the surface along the chords of the vertices as far as it stays inside.
	 */
	Path alongSurface(const Point3d& p, const Point3d& q)
	{
		findNeighbours();
		const SolidTest::Closest first = solid.closest(p), last = solid.closest(q);
		const std::vector<int> way =
			wayOnSurface(solid.triangles()[first.face][0], solid.triangles()[last.face][0]);
		Path path(1, first.point);
		HalfChord before = {solid.vertex(way.front()), Point3d(0, 0, 0)};
		for (int v : way) {
			const HalfChord here = chordAt(v);
			double part = 1;
			constexpr double lowest = 1e-3;
			while (part > 0 && !segmentIsInside(before.at(part), here.at(part)))
				part = part > lowest ? part / 2 : 0;
			path.push_back(before.at(part));
			path.push_back(here.at(part));
			path.push_back(here.at(1));
			before = here;
		}
		path.push_back(before.from);
		path.push_back(last.point);
		return path;
	}

	/// The shortest way over edges of the surface (Dijkstra), both ends included.
	std::vector<int> wayOnSurface(int from, int to) const
	{
		using Entry = std::pair<double, int>;
		std::vector<double> distance(around.size(), std::numeric_limits<double>::infinity());
		std::vector<int> previous(around.size(), -1);
		std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
		distance[from] = 0;
		queue.emplace(0, from);
		while (!queue.empty() && queue.top().second != to) {
			const auto [d, v] = queue.top();
			queue.pop();
			if (d > distance[v])
				continue;
			for (int w : around[v]) {
				const double further = d + Distance(solid.vertex(v), solid.vertex(w));
				if (further < distance[w]) {
					distance[w] = further;
					previous[w] = v;
					queue.emplace(further, w);
				}
			}
		}
		std::vector<int> way;
		for (int v = to; v >= 0; v = previous[v])
			way.push_back(v);
		std::reverse(way.begin(), way.end());
		return way;
	}

	/// Whether two places are one in mesh units.
	bool isSame(const Point3d& p, const Point3d& q) const
	{
		constexpr double rounding = 1e-12;
		return Distance(p, q) <= rounding || solid.out(p) == solid.out(q);
	}

	/// Leaves out points between which the way is inside without them, and such that say nothing.
	void simplify(const Point3d& p, const Point3d& q, Path& between) const
	{
		constexpr int rounds = 4;
		for (int round = 0; round < rounds; ++round) {
			Path kept;
			const size_t count = between.size();
			for (size_t i = 0; i < count; ++i) {
				const Point3d& before = kept.empty() ? p : kept.back();
				const Point3d& after = i + 1 < count ? between[i + 1] : q;
				if (isSame(before, between[i]) || isSame(between[i], after))
					continue;
				if (before == after || !segmentIsInside(before, after))
					kept.push_back(between[i]);
			}
			if (kept.size() == count)
				return;
			between = std::move(kept);
		}
	}
};

} // namespace detail

/**
 * Brings a curve inside the solids that it came from: nodes go to the middle of a chord of the solid,
 * edges are bent, with new nodes. Its topology stays, as do the nodes that are inside, to the last bit.
 * The flow smooths over a few edges, so that the curve of a coarse surface may cut corners; a surface that
 * crosses itself may be turned inside out by it.
 *
 * @param surface     the vertices of all components, mesh units, and @param triangles between them.
 * @param component   of each vertex; @param ofNode of each node, grows with the nodes.
 * @return the curve; edges in order, new nodes last. Radii are not its business.
 * @post no node is outside by more than 5e-7 of the diagonal, and no edge, unless the ways inside would make
 *       the curve longer than three times itself and the diagonal, as where a surface runs into itself all
 *       over: the last edges then stay straight.
 * @throws SolverError, Cancelled. Complexity: O(F) for a curve that is inside; at most O(F log F) for each
 *         edge that is not.
 */
inline CurveSkeleton broughtInside(CurveSkeleton skeleton, const std::vector<Point3d>& surface,
	const std::vector<Triangle>& triangles, const std::vector<int>& component, int components,
	std::vector<int>& ofNode, const Progress& progress = Progress())
{
	const Progress begin = progress.part(0, 0);
	const ComponentVertices vertices(component, components, begin);
	std::vector<std::vector<Triangle>> faces(components);
	for (const Triangle& t : triangles)
		faces[component[t[0]]].push_back(
			{vertices.place[t[0]], vertices.place[t[1]], vertices.place[t[2]]});
	const std::vector<int>& node = skeleton.node;
	std::vector<std::vector<int>> nodes(components);
	std::vector<int> number(skeleton.position.size());
	for (size_t A = 0; A < number.size(); ++A) {
		number[A] = int(nodes[ofNode[A]].size());
		nodes[ofNode[A]].push_back(int(A));
	}
	std::vector<std::vector<std::array<int, 2>>> edges(components);
	for (const auto& [A, B] : skeleton.edges)
		edges[ofNode[A]].push_back({number[A], number[B]});
	std::vector<std::array<int, 2>> all;
	for (int c = 0; c < components; ++c) {
		const Progress part = progress.part(double(c) / components, double(c + 1) / components);
		std::vector<Point3d> points;
		for (int s : vertices.ids[c])
			points.push_back(surface[s]);
		const SolidTest solid(points, faces[c], part.part(0, 0.5));
		std::vector<Point3d> place;
		for (int A : nodes[c])
			place.push_back(solid.in(skeleton.position[A]));
		const Progress bending = part.part(0.5, 1);
		detail::CurveIntoSolid curve(solid, place, edges[c], bending);
		curve.merged.resize(place.size());
		for (size_t i = 0; i < points.size(); ++i)
			curve.merged[number[node[vertices.ids[c][i]]]].push_back(int(i));
		if (curve.bringInside())
			for (size_t i = 0; i < curve.places().size(); ++i) {
				if (i >= nodes[c].size()) {
					nodes[c].push_back(int(skeleton.position.size()));
					skeleton.position.push_back(Point3d(0, 0, 0));
					ofNode.push_back(c);
				}
				if (curve.changedNodes()[i])
					skeleton.position[nodes[c][i]] = solid.out(curve.places()[i]);
			}
		for (const auto& [i, j] : curve.curveEdges())
			all.push_back({std::min(nodes[c][i], nodes[c][j]), std::max(nodes[c][i], nodes[c][j])});
	}
	std::sort(all.begin(), all.end());
	skeleton.edges = std::move(all);
	return skeleton;
}

/**
 * collapseToCurve(), and what of the curve is outside of the surface is brought inside, see broughtInside().
 * Not where vertices are held, which the user may want anywhere, nor where the triangles of the surface are
 * not known.
 * @throws SolverError, Cancelled.
 */
inline CurveSkeleton collapseInside(
	Stage stage, double shortestEdge = 1e-4, const Progress& progress = Progress())
{
	const bool isKnown = stage.surfaceTriangles && stage.heldCount() == 0;
	if (!isKnown)
		return collapseToCurve(std::move(stage), shortestEdge, progress);
	const auto triangles = stage.surfaceTriangles;
	const auto surface = stage.surface;
	const int components = int(stage.diagonal.size());
	const std::vector<int> component = componentOfSurfaceVertices(stage, progress.part(0, 0));
	CurveSkeleton curve = collapseToCurve(std::move(stage), shortestEdge, progress.part(0, 0.95));
	std::vector<int> ofNode(curve.position.size(), -1);
	for (size_t s = 0; s < component.size(); ++s)
		ofNode[curve.node[s]] = component[s];
	// A node of split vertices only is of the component of its neighbours.
	const std::vector<std::vector<int>> neighbours = curve.neighbours();
	std::vector<int> told;
	for (size_t A = 0; A < ofNode.size(); ++A)
		if (ofNode[A] >= 0)
			told.push_back(int(A));
	for (size_t i = 0; i < told.size(); ++i)
		for (int B : neighbours[told[i]])
			if (ofNode[B] < 0) {
				ofNode[B] = ofNode[told[i]];
				told.push_back(B);
			}
	const std::vector<Point3d> before = curve.position;
	curve = broughtInside(std::move(curve), *surface, *triangles, component, components, ofNode,
		progress.part(0.95, 1));
	if (curve.position != before) {
		curve.radius =
			meanSurfaceDistance(curve.position, *surface, curve.node, progress.part(1, 1));
		fillUnknownRadii(curve.radius, curve.neighbours());
	}
	return curve;
}

} // namespace vcg::tri::mcf

#endif
