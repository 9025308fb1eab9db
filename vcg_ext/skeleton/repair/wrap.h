// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A closed surface around oriented triangles: where their winding number is one half.

#ifndef VCG_MCF_WRAP_H
#define VCG_MCF_WRAP_H

#include "boundary_cones.h"
#include "tetrahedral_lattice.h"
#include "winding_columns.h"
#include "winding_number.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The points and triangles of a closed surface.
struct WrappedSurface
{
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
};

namespace detail {

/**
 * Extracts the surface { w = 1/2 } from the tetrahedra of a lattice, without its fins and slits.
 *
 * w is found at the nodes near the triangles, where it jumps, and then, until there are no new ones,
 * at those of all tetrahedra around edges where w - 1/2 changes its sign: so the surface is followed
 * across holes. All tetrahedra around such edges are then complete, and the surface through them is
 * closed and two-manifold. w is counted in columns, less that of the cones: see BoundaryCones.
 */
class Wrapping
{
public:
	Wrapping(const TriangleTree& tree, const WindingNumber& winding, double spacing, int maxNodes) :
			tree(tree), winding(winding), maxNodes(maxNodes),
			lattice(originOf(tree, spacing), spacing)
	{
	}

	WrappedSurface run(const Progress& progress)
	{
		addNodesNearTriangles(progress.part(0, 0.15));
		prepareWinding(progress.part(0.15, 0.2));
		evaluate(progress.part(0.2, 0.55));
		leaveOutFins(progress.part(0.55, 0.6));
		placeVertices(progress.part(0.6, 0.9));
		connect(progress.part(0.9, 1));
		return std::move(surface);
	}

private:
	static constexpr const char* wrapping = "Wrapping the surface";
	using Lattice = TetrahedralLattice;

	const TriangleTree& tree;
	const WindingNumber& winding;
	int maxNodes;
	Lattice lattice;
	BoundaryCones cones;
	std::optional<WindingColumns> columns; ///< of the triangles and the cones, if these are few
	std::optional<TriangleTree> coneTree;
	std::optional<WindingNumber> coneWinding;
	std::vector<double> value;    ///< of w, for each node
	std::vector<int> firstVertex; ///< of those on the edges forward from each node
	WrappedSurface surface;

	/// Not a corner of the bounding box: shapes tend to have vertices and edges in its planes.
	static Point3d originOf(const TriangleTree& tree, double spacing)
	{
		return tree.size() ? tree.allNodes()[0].box.min - Point3d(0.3819, 0.2361, 0.1459) * spacing
						   : Point3d(0, 0, 0);
	}

	bool isInside(int node) const { return value[size_t(node)] > 0.5; }
	bool changes(int node, int other) const { return isInside(node) != isInside(other); }

	[[noreturn]] static void refuse()
	{
		throw SolverError("The surface has too many places of detail to be wrapped.");
	}

	void limitNodes() const
	{
		if (lattice.size() > maxNodes)
			refuse();
	}

	void addNodesNearTriangles(const Progress& progress)
	{
		// The ends of an edge that crosses a triangle are no farther from it than the edge is long.
		constexpr double maxSpacings = 1e9; // places in the lattice are integers
		const double a = lattice.spacing();
		if (tree.size() && tree.allNodes()[0].box.Diag() > maxSpacings * a)
			refuse();
		// A single long triangle may have more pieces than there may be nodes.
		Ticker ticker(progress.cancelOnly(), wrapping, 1);
		std::vector<std::array<Point3d, 3>> pieces;
		reportedLoop(tree.size(), progress, wrapping, [&](int i) {
			const int f = tree.order()[size_t(i)];
			pieces.push_back({tree.corner(f, 0), tree.corner(f, 1), tree.corner(f, 2)});
			while (!pieces.empty()) {
				const std::array<Point3d, 3> t = pieces.back();
				pieces.pop_back();
				ticker.tick();
				limitNodes();
				size_t longest = 0;
				for (size_t k = 1; k < 3; ++k)
					if (SquaredDistance(t[k], t[(k + 1) % 3])
						> SquaredDistance(t[longest], t[(longest + 1) % 3]))
						longest = k;
				const Point3d &p = t[longest], &q = t[(longest + 1) % 3],
							  &apex = t[(longest + 2) % 3];
				if (SquaredDistance(p, q) > 9 * a * a) { // the box of a long one is mostly empty
					pieces.push_back({p, (p + q) / 2.0, apex});
					pieces.push_back({(p + q) / 2.0, q, apex});
				}
				else
					addNodesNear(t, a);
			}
		});
		limitNodes();
	}

	void addNodesNear(const std::array<Point3d, 3>& t, double reach)
	{
		Box3d box;
		for (const Point3d& p : t)
			box.Add(p);
		box.Offset(reach);
		const double half = lattice.spacing() / 2;
		const Point3d low = (box.min - lattice.position(Lattice::Place {0, 0, 0})) / half;
		const Point3d high = (box.max - lattice.position(Lattice::Place {0, 0, 0})) / half;
		for (int parity = 0; parity < 2; ++parity) {
			const auto first = [&](double x) {
				const int n = int(std::ceil(x));
				return n + ((n - parity) & 1);
			};
			for (int x = first(low[0]); x <= high[0]; x += 2)
				for (int y = first(low[1]); y <= high[1]; y += 2)
					for (int z = first(low[2]); z <= high[2]; z += 2) {
						const Lattice::Place at = {x, y, z};
						if (closestOnTriangle(t[0], t[1], t[2], lattice.position(at))
								.squaredDistance
							<= reach * reach)
							lattice.add(at);
					}
		}
	}

	void prepareWinding(const Progress& progress)
	{
		const std::vector<Triangle>& triangles = tree.allTriangles();
		cones =
			boundaryCones(tree.allPoints(), triangles, winding.allWeights(), progress.part(0, 0.2));
		if (cones.triangles.size() >= triangles.size()) // loose triangles
			return;
		columns.emplace(triangles, winding.allWeights(), cones, lattice, progress.part(0.2, 0.8));
		coneTree.emplace(cones.points, cones.triangles, progress.part(0.8, 0.9));
		coneWinding.emplace(*coneTree, progress.part(0.9, 1), cones.weights);
	}

	double windingAt(int node) const
	{
		const Point3d p = lattice.position(node);
		if (columns)
			if (const std::optional<double> ofAll = columns->at(lattice, lattice.place(node)))
				return *ofAll - (*coneWinding)(p);
		return winding(p);
	}

	void evaluate(const Progress& progress)
	{
		for (int from = 0, first = lattice.size(); from < lattice.size();) {
			const int to = lattice.size();
			value.resize(size_t(to));
			// How much is left after the first round is unknown.
			const Progress part = from == 0 ? progress.part(0, 0.9) : progress.cancelOnly();
			forEachBlock(to - from, part, wrapping, [&](int begin, int end) {
				for (int i = from + begin; i < from + end; ++i)
					value[size_t(i)] = windingAt(i);
			});
			if (from == 0)
				fillSlits(progress.cancelOnly());
			reportedLoop(
				to - from, progress.part(0.9, from < first ? 1 : 0.9), wrapping, [&](int i) {
					const int node = from + i;
					for (int d = 0; d < Lattice::directions; ++d) {
						const int other = lattice.neighbour(node, d);
						if (other >= 0 && other < to && changes(node, other))
							lattice.completeAround(node, d);
					}
				});
			limitNodes();
			from = to;
		}
	}

	/// Whether a node outside is in a slit: on both sides of it along some direction, the solid is so
	/// near that a lattice plane of the densest sort need not lie between.
	bool isInSlit(int node) const
	{
		constexpr double narrow = M_SQRT1_2; // spacings: the distance of the densest lattice planes
		for (int d = 0; d < Lattice::forward; ++d) {
			const int one = lattice.neighbour(node, d),
					  other = lattice.neighbour(node, Lattice::opposite(d));
			if (one < 0 || other < 0 || !isInside(one) || !isInside(other))
				continue;
			const double length = Distance(lattice.position(node), lattice.position(one));
			if ((crossing(node, one) + crossing(node, other)) * length < narrow * lattice.spacing())
				return true;
		}
		return false;
	}

	/**
	 * Takes nodes in slits for inside, see isInSlit(), as between bodies that nearly touch: only some of
	 * the nodes around a narrow slit lie in it, and the surface around those would have handles.
	 * @pre the nodes are those near triangles.
	 */
	void fillSlits(const Progress& progress)
	{
		std::vector<char> isFilled(size_t(lattice.size()), 0);
		forEachBlock(lattice.size(), progress, wrapping, [&](int begin, int end) {
			for (int node = begin; node < end; ++node)
				isFilled[size_t(node)] = !isInside(node) && isInSlit(node);
		});
		for (size_t node = 0; node < isFilled.size(); ++node)
			if (isFilled[node])
				value[node] = 1;
	}

	/**
	 * Takes what is inside of fins for outside. Along the border of an open sheet { w > 1/2 } is a
	 * wedge of an angle of 2 pi (w - 1/2), w taken on the inner side; where that is sharp, there
	 * may be a fin as thin as the lattice, which would tear it to shreds. Nodes are kept near those
	 * that are inside by a clear margin, or with all of their neighbours, or beyond which the solid
	 * goes on.
	 */
	void leaveOutFins(const Progress& progress)
	{
		constexpr double clearly = 0.6; // a wedge of 36 degrees
		constexpr int reach = 2;        // edges of the lattice
		std::vector<char> isKept(size_t(lattice.size()), 0);
		std::vector<int> front, next;
		reportedLoop(lattice.size(), progress, wrapping, [&](int node) {
			if (!isInside(node))
				return;
			bool isWithin = true, isComplete = true;
			for (int d = 0; d < Lattice::directions; ++d) {
				const int other = lattice.neighbour(node, d);
				isComplete = isComplete && other >= 0;
				isWithin = isWithin && (other < 0 || isInside(other));
			}
			if (isWithin || !isComplete || value[size_t(node)] >= clearly) {
				isKept[size_t(node)] = 1;
				front.push_back(node);
			}
		});
		for (int step = 0; step < reach; ++step) {
			next.clear();
			for (int node : front)
				for (int d = 0; d < Lattice::directions; ++d)
					if (const int other = lattice.neighbour(node, d);
						other >= 0 && isInside(other) && !isKept[size_t(other)]) {
						isKept[size_t(other)] = 1;
						next.push_back(other);
					}
			front.swap(next);
		}
		// All neighbours of these nodes exist: the tetrahedra around the new changes are complete.
		for (int node = 0; node < lattice.size(); ++node)
			if (isInside(node) && !isKept[size_t(node)])
				value[size_t(node)] = 1 - value[size_t(node)];
	}

	/// Where the surface meets the edge from `node` to `other`, in [0, 1].
	double crossing(int node, int other) const
	{
		// Off the triangles w is smooth: between its jumps it is taken as linear along an edge.
		std::vector<std::pair<double, double>> jumps;
		tree.forEachCrossing(lattice.position(node), lattice.position(other),
			[&](int f, double t, bool alongNormal) {
				jumps.emplace_back(t, alongNormal ? -winding.weight(f) : winding.weight(f));
			});
		std::sort(jumps.begin(), jumps.end());
		const double start = value[size_t(node)] - 0.5, end = value[size_t(other)] - 0.5;
		double slope = end - start;
		for (const auto& jump : jumps)
			slope -= jump.second;
		jumps.emplace_back(1, 0);
		const bool inside = start > 0;
		double t = 0, at = start;
		for (const auto& [next, jump] : jumps) {
			const double before = at + slope * (next - t);
			if ((before > 0) != inside)
				return t + at / (at - before) * (next - t);
			if ((before + jump > 0) != inside)
				return next;
			t = next;
			at = before + jump;
		}
		return start / (start - end); // a crossing was missed or counted twice
	}

	void placeVertices(const Progress& progress)
	{
		constexpr double nearest = 0.03; // part of an edge: no triangle is degenerate
		firstVertex.reserve(size_t(lattice.size()) + 1);
		std::vector<std::pair<int, int>> edges;
		reportedLoop(lattice.size(), progress.part(0, 0.2), wrapping, [&](int node) {
			firstVertex.push_back(int(edges.size()));
			for (int d = 0; d < Lattice::forward; ++d)
				if (const int other = lattice.neighbour(node, d);
					other >= 0 && changes(node, other))
					edges.emplace_back(node, other);
		});
		surface.points.resize(edges.size());
		forEachBlock(int(edges.size()), progress.part(0.2, 1), wrapping, [&](int begin, int end) {
			for (int i = begin; i < end; ++i) {
				const auto [node, other] = edges[size_t(i)];
				const double t = std::clamp(crossing(node, other), nearest, 1 - nearest);
				surface.points[size_t(i)] =
					lattice.position(node) * (1 - t) + lattice.position(other) * t;
			}
		});
	}

	/// The vertex on the edge between two nodes with a change of sign.
	int vertexBetween(int a, int b) const
	{
		const auto count = [&](int node, int direction) {
			int before = 0;
			for (int d = 0; d < direction; ++d)
				if (const int other = lattice.neighbour(node, d);
					other >= 0 && changes(node, other))
					++before;
			return firstVertex[size_t(node)] + before;
		};
		for (int d = 0; d < Lattice::forward; ++d) {
			if (lattice.neighbour(a, d) == b)
				return count(a, d);
			if (lattice.neighbour(b, d) == a)
				return count(b, d);
		}
		return -1;
	}

	void connect(const Progress& progress)
	{
		reportedLoop(lattice.size(), progress, wrapping, [&](int node) {
			lattice.forEachTetrahedron(
				node, [&](const std::array<int, 4>& corners) { cut(corners); });
		});
	}

	void addTriangle(int a, int b, int c, bool turned)
	{
		surface.triangles.push_back({a, turned ? c : b, turned ? b : c});
	}

	/// Adds the surface within a tetrahedron, its normal from inside to outside.
	void cut(const std::array<int, 4>& corners)
	{
		int mask = 0;
		for (int i = 0; i < 4; ++i)
			mask |= int(isInside(corners[size_t(i)])) << i;
		const auto vertex = [&](int i, int j) {
			return vertexBetween(corners[size_t(i)], corners[size_t(j)]);
		};
		// Even permutations of the corners.
		static constexpr int alone[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}};
		static constexpr int pairs[6][4] = {
			{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
		for (int i = 0; i < 4; ++i)
			if (mask == 1 << i || mask == (15 ^ 1 << i)) {
				const int* p = alone[i];
				addTriangle(vertex(i, p[1]), vertex(i, p[2]), vertex(i, p[3]), mask != 1 << i);
			}
		for (const auto& p : pairs)
			if (mask == (1 << p[0] | 1 << p[1])) {
				const std::array<int, 4> quad = {
					vertex(p[0], p[2]), vertex(p[0], p[3]), vertex(p[1], p[3]), vertex(p[1], p[2])};
				const auto squared = [&](size_t i, size_t j) {
					return SquaredDistance(
						surface.points[size_t(quad[i])], surface.points[size_t(quad[j])]);
				};
				const size_t first = squared(0, 2) <= squared(1, 3) ? 0 : 1;
				for (size_t i : {first, first + 2})
					addTriangle(quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4], false);
			}
	}
};

} // namespace detail

/**
 * The boundary of the solid { w > 1/2 }, w the winding number of oriented triangles: closed,
 * two-manifold, oriented outward, of any number of pieces. Its vertices lie on the triangles where
 * these bound the solid, to 3 % of a lattice edge, and across holes near { w = 1/2 }.
 *
 * Parts thinner than about the spacing may be torn or missed, and such fins along the borders of
 * open sheets are left out. Cavities are separate pieces.
 *
 * @param tree      of the triangles. @param winding  their winding number.
 * @param spacing   of the lattice, mesh units, > 0: about the edge length of the result.
 * @param maxNodes  largest number of nodes of the lattice.
 * @throws SolverError if more nodes are needed, or the triangles reach over 1e9 spacings; Cancelled.
 * Complexity: O((F + A / spacing^2) log F) for the area A of the triangles.
 * Source: ours; marching tetrahedra after Doi and Koide, 1991, on the lattice of Labelle and
 * Shewchuk, 2007.
 */
inline WrappedSurface wrap(const TriangleTree& tree, const WindingNumber& winding, double spacing,
	int maxNodes, const Progress& progress = Progress())
{
	return detail::Wrapping(tree, winding, spacing, maxNodes).run(progress);
}

} // namespace vcg::tri::mcf

#endif
