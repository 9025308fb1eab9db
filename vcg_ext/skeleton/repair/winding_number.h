// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Generalized winding numbers of any oriented triangles (Jacobson et al. 2013), by a tree
/// of dipoles (Barill et al. 2018).

#ifndef VCG_MCF_WINDING_NUMBER_H
#define VCG_MCF_WINDING_NUMBER_H

#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/triangle_tree.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * The solid angle of a triangle seen from q, as a fraction of the full sphere: positive if q is
 * behind the triangle, on the side that its normal points away from.
 * Source: van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
 */
inline double windingOfTriangle(
	const Point3d& p0, const Point3d& p1, const Point3d& p2, const Point3d& q)
{
	const Point3d a = p0 - q, b = p1 - q, c = p2 - q;
	const double la = a.Norm(), lb = b.Norm(), lc = c.Norm();
	const double volume = a * (b ^ c);
	const double base = la * lb * lc + (a * b) * lc + (b * c) * la + (c * a) * lb;
	if (volume == 0 && base >= 0)
		return 0;
	return std::atan2(volume, base) / (2 * M_PI);
}

} // namespace detail

/**
 * The winding number field w of oriented triangles: how often they wrap around a point. For a
 * closed surface with outward normals, w is 1 inside and 0 outside. Near holes it lies in between.
 * It is smooth off the triangles, and jumps by a triangle's weight (1 by default) across it.
 *
 *     w(q) = 1 / (4 pi) sum over the triangles of weight times solid angle, seen from q
 *
 * The triangles of a tree node that is far from q, see `farness`, are approximated by their moments
 * about the centroid of their area: the sum of the area normals, and the first moment of these.
 * Complexity: O(F) to build, about O(log F) for a point.
 * Source: Barill, Dickson, Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds",
 * 2018.
 */
class WindingNumber
{
public:
	/// @param tree kept by reference. @param weights of its triangles; empty: 1 each.
	/// @throws Cancelled
	explicit WindingNumber(const TriangleTree& tree, const Progress& progress = Progress(),
		std::vector<double> weights = {}) :
			tree(tree),
			weights(std::move(weights)), moments(tree.allNodes().size())
	{
		const char* const what = "Preparing winding numbers";
		// Children follow their parents.
		const int count = int(moments.size());
		detail::reportedLoop(count, progress, what, [&](int i) { gather(size_t(count - 1 - i)); });
	}

	/// The winding number at a point, mesh units. On a triangle: that of a side, or in between.
	double operator()(const Point3d& q) const
	{
		if (moments.empty())
			return 0;
		double sum = 0;
		std::array<int, 128> stack;
		int top = 0;
		stack[size_t(top++)] = 0;
		while (top > 0) {
			const int at = stack[size_t(--top)];
			const Moments& m = moments[size_t(at)];
			const Point3d r = m.centre - q;
			const double squared = r.SquaredNorm();
			if (squared > m.squaredReach) {
				const double inverse = 1 / squared;
				const double cubic = inverse / std::sqrt(squared);
				const double varying =
					r * Point3d(m.varying[0] * r, m.varying[1] * r, m.varying[2] * r);
				sum += cubic * (r * m.normal + m.trace - 3 * inverse * varying) / (4 * M_PI);
				continue;
			}
			const TriangleTree::Node& node = tree.allNodes()[size_t(at)];
			if (node.isLeaf()) {
				for (int i = node.begin; i < node.end; ++i) {
					const int f = tree.order()[size_t(i)];
					sum += weight(f)
						* detail::windingOfTriangle(
							tree.corner(f, 0), tree.corner(f, 1), tree.corner(f, 2), q);
				}
				continue;
			}
			stack[size_t(top++)] = node.right;
			stack[size_t(top++)] = at + 1;
		}
		return sum;
	}

	/// The jump of the field across a triangle.
	double weight(int f) const { return weights.empty() ? 1 : weights[size_t(f)]; }

private:
	/// Of the triangles of a node, mesh units.
	struct Moments
	{
		Point3d centre = Point3d(0, 0, 0);
		double area = 0;
		Point3d normal = Point3d(0, 0, 0); ///< sum of area normals
		/// Row i: sum over the triangles of (area normal)_i (centroid - centre).
		std::array<Point3d, 3> varying = {Point3d(0, 0, 0), Point3d(0, 0, 0), Point3d(0, 0, 0)};
		double trace = 0;        ///< of `varying`
		double squaredReach = 0; ///< beyond, the moments replace the triangles
	};

	static constexpr double farness = 3; ///< in distances of the farthest box corner from `centre`

	const TriangleTree& tree;
	std::vector<double> weights;
	std::vector<Moments> moments;

	void gather(size_t at)
	{
		const TriangleTree::Node& node = tree.allNodes()[at];
		Moments& m = moments[at];
		m.centre = node.box.Center();
		Point3d weighted(0, 0, 0);
		if (node.isLeaf()) {
			for (int i = node.begin; i < node.end; ++i) {
				const auto [middle, normal] = placed(tree.order()[size_t(i)]);
				const double area = normal.Norm();
				m.area += area;
				weighted += middle * area;
			}
		}
		else
			for (const Moments* child : children(at)) {
				m.area += child->area;
				weighted += child->centre * child->area;
			}
		if (m.area > 0)
			m.centre = weighted / m.area;
		const auto add = [&](const Point3d& from, const Point3d& normal) {
			m.normal += normal;
			for (int i = 0; i < 3; ++i)
				m.varying[size_t(i)] += (from - m.centre) * normal[i];
		};
		if (node.isLeaf())
			for (int i = node.begin; i < node.end; ++i) {
				const auto [middle, normal] = placed(tree.order()[size_t(i)]);
				add(middle, normal);
			}
		else
			for (const Moments* child : children(at)) {
				add(child->centre, child->normal);
				for (size_t i = 0; i < 3; ++i)
					m.varying[i] += child->varying[i];
			}
		m.trace = m.varying[0][0] + m.varying[1][1] + m.varying[2][2];
		double farthest = 0; // corner of the box
		for (int corner = 0; corner < 8; ++corner)
			farthest = std::max(farthest, SquaredDistance(node.box.P(corner), m.centre));
		m.squaredReach = farness * farness * farthest;
	}

	std::array<const Moments*, 2> children(size_t at) const
	{
		return {&moments[at + 1], &moments[size_t(tree.allNodes()[at].right)]};
	}

	struct Placed
	{
		Point3d middle, normal;
	};

	Placed placed(int f) const
	{
		const Point3d &a = tree.corner(f, 0), &b = tree.corner(f, 1), &c = tree.corner(f, 2);
		return {(a + b + c) / 3.0, ((b - a) ^ (c - a)) * (weight(f) / 2)};
	}
};

} // namespace vcg::tri::mcf

#endif
