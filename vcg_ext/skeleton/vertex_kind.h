// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file What a meso-skeleton is at each vertex: curve, sheet, or still volume (Sec. 4.5, Fig. 7).

#ifndef VCG_MCF_VERTEX_KIND_H
#define VCG_MCF_VERTEX_KIND_H

#include "parallel_blocks.h"
#include "point_tree.h"
#include "stage.h"
#include "surface_tracking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// The numbers are those of the attribute mcfskel_kind.
enum class VertexKind : char {
	Curve = 0, ///< the surface around has closed onto a line
	Sheet = 1, ///< two walls lie on each other, and extend in two directions
	Volume = 2 ///< not contracted yet
};

namespace detail {

/// Points spread over the triangles of a stage, each with the area that it stands for.
struct FaceSamples
{
	std::vector<Point3d> point;
	std::vector<double> area;
	std::vector<int> face;

	/// Halves a triangle at its longest edge until none is longer than `spacing`, or `halvings` times.
	void add(int f, const Point3d& a, const Point3d& b, const Point3d& c, double whole,
		double spacing, int halvings = 16)
	{
		const double ab = SquaredDistance(a, b), bc = SquaredDistance(b, c),
					 ca = SquaredDistance(c, a);
		if (bc > ab && bc >= ca)
			return add(f, b, c, a, whole, spacing, halvings);
		if (ca > ab)
			return add(f, c, a, b, whole, spacing, halvings);
		if (ab <= spacing * spacing || halvings == 0) {
			point.push_back((a + b + c) / 3.0);
			area.push_back(whole);
			face.push_back(f);
			return;
		}
		const Point3d middle = (a + b) / 2.0;
		add(f, b, c, middle, whole / 2, spacing, halvings - 1);
		add(f, c, a, middle, whole / 2, spacing, halvings - 1);
	}
};

/// Looks for a face that is closer than a limit and turned the other way.
struct OppositeWall
{
	const SurfaceMesh& mesh;
	/// The face of each sample and its unit normal, in the order of the tree.
	const std::vector<int>& face;
	const std::vector<Point3d>& faceNormal;
	Point3d middle, normal;
	double limit, spacing;
	int found = -1; ///< place in the order of the tree

	const Point3d& centre() const { return middle; }
	/// No point of a piece is farther from the mean of its corners than 2/3 of its longest edge.
	double reach() const { return found >= 0 ? 0 : limit + spacing * 2 / 3; }
	void visit(int slot, const Point3d& p)
	{
		constexpr double opposite = -0.2; // cosine: no neighbour round an edge of a box
		const Point3d& n = faceNormal[size_t(slot)];
		// Most are turned alike, or lie in a plane that is too far.
		if (found >= 0 || n * normal > opposite || std::abs((p - middle) * n) > limit)
			return;
		const Triangle t = mesh.triangle(face[size_t(slot)]);
		const std::vector<Point3d>& corner = mesh.position;
		if (closestOnTriangle(corner[t[0]], corner[t[1]], corner[t[2]], middle).squaredDistance
			<= limit * limit)
			found = slot;
	}
};

/// Sums the area of the samples within a ball, until it is enough.
struct AreaBall
{
	const std::vector<double>& areas; ///< in the order of the tree
	Point3d middle;
	double radius, enough;
	double area = 0;

	bool isEnough() const { return area >= enough; }
	const Point3d& centre() const { return middle; }
	double reach() const { return isEnough() ? 0 : radius; }
	void visit(int slot, const Point3d& p)
	{
		if (SquaredDistance(p, middle) < radius * radius)
			area += areas[size_t(slot)];
	}
};

/// The kind that most of a vertex and its neighbours have; its own if there is no such kind.
inline std::vector<VertexKind> majority(
	const SurfaceMesh& mesh, const std::vector<VertexKind>& kind)
{
	// A vertex whose triangles are each of one kind keeps it.
	std::vector<char> mixed(kind.size(), 0);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const Triangle t = mesh.triangle(f);
		if (kind[t[0]] != kind[t[1]] || kind[t[1]] != kind[t[2]])
			mixed[t[0]] = mixed[t[1]] = mixed[t[2]] = 1;
	}
	std::vector<VertexKind> result = kind;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		if (!mixed[v])
			continue;
		std::array<int, 3> votes = {0, 0, 0};
		int all = 1;
		++votes[size_t(kind[v])];
		mesh.forEachOutgoing(v, [&](int h) {
			++votes[size_t(kind[mesh.target(h)])];
			++all;
		});
		for (size_t k = 0; k < votes.size(); ++k)
			if (2 * votes[k] > all)
				result[v] = VertexKind(k);
	}
	return result;
}

} // namespace detail

/**
 * The kind of each vertex of a stage.
 *
 * Volume: a vertex that is not fixed by the flow and has no wall opposite, turned the other way, within
 * 2 epsilon; on which side does not matter, since walls may have passed each other. Of the others, on
 * which the surface has closed, sheets are told from curves by the area of the stage within a ball of
 * R = 8 epsilon, both walls counted: 2 pi R^2 in the middle of a sheet, half of that at its rim, and
 * for a curve, a tube no wider than epsilon, at most 2 R epsilon pi. A sheet has at least 0.27 of the
 * full area; a strip narrower than about 3.4 epsilon is a curve.
 * Three rounds of majority among neighbours take single vertices out.
 *
 * The area is that of samples, pieces of triangles with no edge longer than 4 epsilon. A ball around one
 * of some near vertices, smaller by the distance of the farthest, lies within the balls of all: where its
 * area is enough, they are sheets together.
 *
 * @return the kind of each vertex, #V. @pre stage.mesh is compact.
 * Complexity: O(V log V). Source: ours; the paper shows kinds, but does not say how to tell them.
 */
inline std::vector<VertexKind> vertexKinds(const Stage& stage)
{
	constexpr double thickness = 2;     // epsilon
	constexpr double reach = 8;         // epsilon
	constexpr double leastSheet = 0.27; // of 2 pi R^2
	constexpr double spacing = 4;       // epsilon
	constexpr double together = 3; // epsilon: in the middle of a sheet, R - 3.8 epsilon is enough
	constexpr int rounds = 3;
	const SurfaceMesh& mesh = stage.mesh;
	const int n = mesh.vertexSlots();
	const auto epsilonAt = [&](int v) {
		return stage.epsilon * stage.diagonal[stage.component[v]];
	};

	detail::FaceSamples samples;
	std::vector<Point3d> faceNormal(size_t(mesh.faceSlots()));
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const Triangle t = mesh.triangle(f);
		const Point3d normal = mesh.areaVector(f);
		const double length = normal.Norm();
		faceNormal[size_t(f)] = length > 0 ? Point3d(normal / length) : Point3d(0, 0, 0);
		samples.add(f, mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]], length / 2,
			spacing * epsilonAt(t[0]));
	}
	const PointTree tree(samples.point);
	// What searches look at is kept in the order in which they come across it.
	std::vector<int> face;
	std::vector<double> area;
	std::vector<Point3d> normal;
	for (int sample : tree.order()) {
		face.push_back(samples.face[size_t(sample)]);
		area.push_back(samples.area[size_t(sample)]);
		normal.push_back(faceNormal[size_t(face.back())]);
	}
	const std::vector<Point3d> vertexNormal = mesh.vertexNormals();
	/// @param recent  walls found for vertices nearby, one of which often is this one's, too.
	const auto isClosed = [&](int v, std::array<int, 4>& recent) {
		if (stage.fixed[v] && !stage.held[v])
			return true;
		detail::OppositeWall wall {mesh, face, normal, mesh.position[v], vertexNormal[v],
			thickness * epsilonAt(v), spacing * epsilonAt(v)};
		for (int slot : recent)
			wall.visit(slot, tree.point(slot));
		if (wall.found < 0) {
			tree.search(wall);
			if (wall.found >= 0) {
				std::rotate(recent.begin(), recent.end() - 1, recent.end());
				recent[0] = wall.found;
			}
		}
		return wall.found >= 0;
	};
	const auto areaWithin = [&](const Point3d& middle, double radius, double enough) {
		detail::AreaBall ball {area, middle, radius, enough};
		tree.search(ball);
		return ball.isEnough();
	};
	// Vertices in the order of the tree, where neighbours are near each other.
	std::vector<int> order;
	order.reserve(size_t(n));
	std::vector<char> seen(size_t(n), 0);
	for (int f : face)
		for (int v : mesh.triangle(f))
			if (!seen[v]) {
				seen[v] = 1;
				order.push_back(v);
			}
	std::vector<VertexKind> kind(size_t(n), VertexKind::Volume);
	forEachBlock(n, Progress(), "Telling curves from sheets", [&](int begin, int end) {
		std::vector<int> closed;
		std::array<int, 4> recent = {0, 0, 0, 0};
		for (int i = begin; i < end; ++i)
			if (isClosed(order[size_t(i)], recent))
				closed.push_back(order[size_t(i)]);
		for (size_t first = 0; first < closed.size();) {
			// The balls of vertices within d of this one all hold its ball of R - d: where that is enough,
			// they are sheets, too.
			const int v = closed[first];
			const double epsilon = epsilonAt(v), R = reach * epsilon;
			const double enough = leastSheet * 2 * M_PI * R * R;
			double d = 0;
			size_t last = first + 1;
			for (; last < closed.size() && stage.component[closed[last]] == stage.component[v];
				 ++last) {
				const double next = Distance(mesh.position[closed[last]], mesh.position[v]);
				if (next > together * epsilon)
					break;
				d = std::max(d, next);
			}
			if (last > first + 1 && areaWithin(mesh.position[v], R - d, enough))
				while (first < last)
					kind[closed[first++]] = VertexKind::Sheet;
			else
				kind[closed[first++]] =
					areaWithin(mesh.position[v], R, enough) ? VertexKind::Sheet : VertexKind::Curve;
		}
	});
	for (int i = 0; i < rounds; ++i)
		kind = detail::majority(mesh, kind);
	return kind;
}

} // namespace vcg::tri::mcf

#endif
