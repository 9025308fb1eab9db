// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whether a pole is visible from its vertex through the inside of the shape.

#ifndef VCG_MCF_INNER_SEGMENTS_H
#define VCG_MCF_INNER_SEGMENTS_H

#include "four_boxes.h"
#include "four_values.h"
#include "point_tree.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Tests segments that start at a vertex and end in the middle of a ball without vertices in it.
 *
 * A ball of radius r around c may be empty of vertices and still reach through a triangle, its
 * centre outside. Where the segment [p, c] crosses a triangle, at x, a depth t below p, the power
 * of x to the ball (positive inside: r^2 - |x - c|^2) is t (2 r - t). In the triangle's plane, the
 * power to the ball less that to the triangle's own circumcircle is linear and not positive at the
 * corners, and the latter is at most L^2 / 3 for a longest edge L. So t (2 r - t) <= L^2 / 3: only
 * a short first piece of the segment can cross.
 */
class InnerSegments
{
public:
	/**
	 * @param mesh   kept by reference.
	 * @param tree   of its vertices; gives the triangles an order in space.
	 * @pre mesh is compact.
	 * @throws Cancelled. Complexity: O(F).
	 */
	InnerSegments(
		const SurfaceMesh& mesh, const PointTree& tree, const Progress& progress = Progress()) :
			mesh(mesh)
	{
		const char* const what = "Sorting the surface";
		sortFaces(tree.order(), progress.part(0, 0.5), what);
		const Progress ofBoxes = progress.part(0.5, 1);
		const Box3d all = mesh.bounds(ofBoxes);
		origin = all.Center();
		slack = FourBoxes::slack(all.Diag());
		double longest = 0;
		const auto four = [](size_t count) { return (count + 3) / 4; };
		std::vector<Box3d> boxes = detail::filledArray(four(faces.size()), Box3d(), ofBoxes);
		levels.push_back(detail::filledArray(boxes.size(), FourBoxes(), ofBoxes));
		detail::reportedLoop(int(faces.size()), ofBoxes, what, [&](int i) {
			Box3d box;
			for (int k = 0; k < 3; ++k) {
				const Point3d& p = mesh.position[faces[i][k]];
				box.Add(p);
				longest =
					std::max(longest, SquaredDistance(p, mesh.position[faces[i][(k + 1) % 3]]));
			}
			levels.back()[i / 4].set(i % 4, box, origin);
			boxes[i / 4].Add(box);
		});
		largestPower = longest / 3;
		while (boxes.size() > 1) {
			const Progress end = progress.cancelOnly();
			std::vector<FourBoxes> level =
				detail::filledArray(four(boxes.size()), FourBoxes(), end);
			std::vector<Box3d> above = detail::filledArray(level.size(), Box3d(), end);
			detail::reportedLoop(int(boxes.size()), end, what, [&](int i) {
				level[i / 4].set(i % 4, boxes[i], origin);
				above[i / 4].Add(boxes[i]);
			});
			levels.push_back(std::move(level));
			boxes = std::move(above);
		}
	}

	/**
	 * Whether the segment from vertex v to c leaves v into the inside and crosses no triangle.
	 * @param leadsInside  whether the segment is known to start behind all triangles of v.
	 * @pre no vertex lies deeper than `depth` in the ball around c through v.
	 * Complexity: O(log F).
	 */
	bool staysInside(int v, const Point3d& c, double depth, bool leadsInside = false) const
	{
		const Point3d& p = mesh.position[v];
		const Point3d direction = c - p;
		const double r = direction.Norm();
		if (!(r > 0) || !(leadsInside || leavesInwards(v, direction)))
			return false;
		const double power = largestPower + 2 * r * depth;
		const double farthest = power < r * r ? power / (r + std::sqrt(r * r - power)) : r;
		return !crosses(v, direction * (farthest / r));
	}

	/**
	 * Whether the vector `depth`, put at vertex v, crosses the surface. Then staysInside() with its
	 * length as the depth holds for no segment in its direction that is as long: the piece that is
	 * tested is, too.
	 * Complexity: O(log F).
	 */
	bool isThinner(int v, const Point3d& depth) const { return crosses(v, depth); }

private:
	const SurfaceMesh& mesh;
	std::vector<Triangle> faces;                ///< neighbours in this order are near each other
	std::vector<std::vector<FourBoxes>> levels; ///< around single faces, 4 faces, 16 faces, ...
	Point3d origin;
	double slack;
	double largestPower; ///< of a point of a triangle to the triangle's circumcircle

	/// Orders the faces by the lowest place of a corner in the order of the vertices.
	void sortFaces(const std::vector<int>& order, const Progress& progress, const char* what)
	{
		std::vector<int> place = detail::filledArray(order.size(), 0, progress);
		detail::cancellableLoop(int(order.size()), progress, [&](int i) { place[order[i]] = i; });
		const auto key = [&](int f) {
			const Triangle t = mesh.triangle(f);
			return std::min({place[t[0]], place[t[1]], place[t[2]]});
		};
		std::vector<int> start = detail::filledArray(order.size() + 1, 0, progress);
		detail::reportedLoop(
			mesh.faceSlots(), progress.part(0, 0.5), what, [&](int f) { ++start[key(f) + 1]; });
		const Progress placing = progress.part(0.5, 1);
		detail::cancellableLoop(
			int(order.size()), placing, [&](int i) { start[i + 1] += start[i]; });
		detail::fillArray(faces, size_t(mesh.faceSlots()), Triangle(), placing);
		detail::reportedLoop(mesh.faceSlots(), placing, what,
			[&](int f) { faces[start[key(f)]++] = mesh.triangle(f); });
	}

	/// Whether the direction leads into the cone of v: its triangles, extended without end.
	bool leavesInwards(int v, const Point3d& direction) const
	{
		bool behindAll = true;
		mesh.forEachOutgoing(v,
			[&](int h) { behindAll = behindAll && direction * mesh.doubleAreaVector(h / 3) < 0; });
		return behindAll || isInsideCone(v, direction / direction.Norm());
	}

	/**
	 * The sign of the distance to the nearest part of the cone: a triangle's normal, the sum of two
	 * at an edge, of all, weighted by angle, at the apex (Baerentzen and Aanaes, "Signed distance
	 * computation using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005).
	 */
	bool isInsideCone(int v, const Point3d& d) const
	{
		const auto unit = [](const Point3d& x) { return x.SquaredNorm() > 0 ? x / x.Norm() : x; };
		const Point3d& apex = mesh.position[v];
		double nearest = 1; // squared; of the apex, where d leads away from all triangles
		Point3d normal(0, 0, 0), apexNormal(0, 0, 0);
		mesh.forEachOutgoing(v, [&](int h) {
			const Point3d a = unit(mesh.position[mesh.target(h)] - apex);
			const Point3d b = unit(mesh.position[mesh.apex(h)] - apex);
			const Point3d n = unit(mesh.doubleAreaVector(h / 3));
			apexNormal += n * std::atan2((a ^ b).Norm(), a * b);
			const double height = d * n, ahead = d * a;
			const bool aboveTriangle = (a ^ d) * n > 0 && (d ^ b) * n > 0;
			if (aboveTriangle && height * height < nearest) {
				nearest = height * height;
				normal = n;
			}
			if (ahead > 0 && 1 - ahead * ahead < nearest) {
				nearest = 1 - ahead * ahead;
				normal = n + unit(mesh.doubleAreaVector(mesh.twin(h) / 3));
			}
		});
		return d * (nearest < 1 ? normal : apexNormal) < 0;
	}

	bool crosses(int v, const Point3d& segment) const
	{
		float from[3], to[3];
		for (int axis = 0; axis < 3; ++axis) {
			const double a = mesh.position[v][axis] - origin[axis], b = a + segment[axis];
			from[axis] = float(std::min(a, b) - slack);
			to[axis] = float(std::max(a, b) + slack);
		}
		const int root = 0;
		return anyCrossed(int(levels.size()) - 1, &root, 1, {v, segment, from, to});
	}

	struct Query
	{
		int v;
		const Point3d& segment;
		const float (&from)[3], (&to)[3]; ///< its box
	};

	/// Whether the segment crosses a triangle in some nodes of a level. The nodes descend together:
	/// one by one, each would wait for the boxes of the one before.
	bool anyCrossed(int level, const int* nodes, int count, const Query& query) const
	{
		constexpr int together = 8;
		std::array<int, 4 * together> inside;
		int found = 0;
		for (int i = 0; i < count; ++i) {
			const Eigen::Array4f gaps = levels[level][nodes[i]].gaps(query.from, query.to);
			found += writeWithin(gaps, 0, 4 * nodes[i], &inside[found]);
		}
		if (level == 0)
			return std::any_of(inside.begin(), inside.begin() + found,
				[&](int f) { return crossesFace(faces[f], query.v, query.segment); });
		for (int first = 0; first < found; first += together)
			if (anyCrossed(level - 1, &inside[first], std::min(found - first, together), query))
				return true;
		return false;
	}

	/// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
	bool crossesFace(const Triangle& t, int v, const Point3d& segment) const
	{
		constexpr double rounding = 1e-9; // a segment through an edge must hit one of its triangles
		if (int(t[0] == v) | int(t[1] == v) | int(t[2] == v)) // nearly always
			return false;
		const Point3d& a = mesh.position[t[0]];
		const Point3d e1 = mesh.position[t[1]] - a, e2 = mesh.position[t[2]] - a;
		const Point3d across = segment ^ e2;
		const double determinant = e1 * across;
		if (determinant == 0)
			return false;
		const Point3d from = mesh.position[v] - a;
		const double u = from * across / determinant;
		if (!(u >= -rounding && u <= 1 + rounding))
			return false;
		const Point3d aside = from ^ e1;
		const double w = segment * aside / determinant;
		const double along = e2 * aside / determinant;
		return w >= -rounding && u + w <= 1 + rounding && along >= -rounding
			&& along <= 1 + rounding;
	}
};

} // namespace vcg::tri::mcf

#endif
