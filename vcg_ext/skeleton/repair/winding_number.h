// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Generalized winding numbers of any oriented triangles (Jacobson et al. 2013), by a tree
/// of dipoles (Barill et al. 2018).

#ifndef VCG_MCF_WINDING_NUMBER_H
#define VCG_MCF_WINDING_NUMBER_H

#include "harmonic_forms.h"

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

/// A complex number of any length, for its angle.
struct Direction
{
	double x, y;

	double angle() const { return std::atan2(y, x); }
};

/**
 * The angle of half of the solid angle of a triangle seen from q: positive if q is behind the
 * triangle, on the side that its normal points away from.
 * Source: van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
 */
inline Direction halfSolidAngle(
	const Point3d& p0, const Point3d& p1, const Point3d& p2, const Point3d& q)
{
	const Point3d a = p0 - q, b = p1 - q, c = p2 - q;
	const double la = a.Norm(), lb = b.Norm(), lc = c.Norm();
	const double volume = a * (b ^ c);
	const double base = la * lb * lc + (a * b) * lc + (b * c) * la + (c * a) * lb;
	if (volume == 0 && base >= 0) // in the triangle's plane, outside of it
		return {1, 0};
	return {base, volume};
}

/// A sum of angles, by a product of complex numbers: one arc tangent for all of them.
class AngleSum
{
public:
	/// Adds the angle of a direction, in [-pi, pi].
	void add(const Direction& d)
	{
		constexpr double large = 1e100;
		const double x = product.x * d.x - product.y * d.y, y = product.x * d.y + product.y * d.x;
		if (product.y >= 0 && d.y >= 0)
			turns += y < 0;
		else if (product.y < 0 && d.y < 0)
			turns -= y >= 0;
		const double size = std::abs(x) + std::abs(y);
		const double scale = size > large || size < 1 / large ? 1 / size : 1;
		product = {x * scale, y * scale};
	}

	double sum() const { return 2 * M_PI * turns + product.angle(); }

private:
	Direction product = {1, 0};
	int turns = 0;
};

} // namespace detail

/**
 * The winding number field w of oriented triangles: how often they wrap around a point. For a
 * closed surface with outward normals, w is 1 inside and 0 outside. Near holes it lies in between.
 * It is smooth off the triangles, and jumps by a triangle's weight (1 by default) across it.
 *
 *     w(q) = 1 / (4 pi) sum over the triangles of weight times solid angle, seen from q
 *
 * The triangles of a tree node that is far from q, see `farness`, are approximated by the moments of
 * their area normals about the centroid of their area, up to the second.
 * Complexity: O(F log F) to build, about O(log F) for a point.
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
		detail::AngleSum angles; // of triangles of one weight in a row
		double weightOfAngles = 1;
		const auto addAngles = [&] { sum += weightOfAngles * angles.sum() / (2 * M_PI); };
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
				sum += cubic
					* (r * m.linear
						+ inverse
							* (7.5 * inverse * detail::valueAt(m.cubic, r)
								- 3 * detail::valueAt(m.quadratic, r)))
					/ (4 * M_PI);
				continue;
			}
			const TriangleTree::Node& node = tree.allNodes()[size_t(at)];
			if (node.isLeaf()) {
				for (int i = node.begin; i < node.end; ++i) {
					const int f = tree.order()[size_t(i)];
					const detail::Direction half = detail::halfSolidAngle(
						tree.corner(f, 0), tree.corner(f, 1), tree.corner(f, 2), q);
					const double w = weight(f);
					if (std::abs(w) != weightOfAngles) {
						addAngles();
						angles = detail::AngleSum();
						weightOfAngles = std::abs(w);
					}
					angles.add({half.x, w < 0 ? -half.y : half.y});
				}
				continue;
			}
			stack[size_t(top++)] = node.right;
			stack[size_t(top++)] = at + 1;
		}
		addAngles();
		return sum;
	}

	/// Of the triangles; empty: 1 each.
	const std::vector<double>& allWeights() const { return weights; }

	/// The jump of the field across a triangle.
	double weight(int f) const { return weights.empty() ? 1 : weights[size_t(f)]; }

private:
	/// Of the triangles of a node, mesh units. With the area normals n dA at d from the centre, as
	/// forms of a vector r, made harmonic:
	struct Moments
	{
		Point3d centre = Point3d(0, 0, 0);
		double area = 0;
		double squaredReach = 0;              ///< beyond, the moments replace the triangles
		Point3d linear = Point3d(0, 0, 0);    ///< the integral of n . r
		detail::QuadraticForm quadratic = {}; ///< of (n . r) (d . r)
		detail::CubicForm cubic = {};         ///< of (n . r) (d . r)^2
	};

	static constexpr double farness = 2; ///< in distances of the farthest vertex from `centre`

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
		if (node.isLeaf())
			for (int i = node.begin; i < node.end; ++i)
				addTriangle(tree.order()[size_t(i)], m);
		else
			for (const Moments* child : children(at))
				addMoments(*child, m);
		detail::makeHarmonic(m.quadratic);
		detail::makeHarmonic(m.cubic);
		double farthest = 0;
		for (int i = node.begin; i < node.end; ++i)
			for (int k = 0; k < 3; ++k)
				farthest = std::max(
					farthest, SquaredDistance(tree.corner(tree.order()[size_t(i)], k), m.centre));
		m.squaredReach = farness * farness * farthest;
	}

	std::array<const Moments*, 2> children(size_t at) const
	{
		return {&moments[at + 1], &moments[size_t(tree.allNodes()[at].right)]};
	}

	void addTriangle(int f, Moments& m) const
	{
		const auto [middle, normal] = placed(f);
		const Point3d to = middle - m.centre;
		const detail::QuadraticForm quadratic = detail::product(normal, to);
		m.linear += normal;
		detail::addTo(m.quadratic, quadratic, 1);
		// The integral of d d^T over a triangle of unit area: (a a^T + b b^T + c c^T + 9 m m^T) / 12.
		detail::addTo(m.cubic, detail::product(quadratic, to), 9.0 / 12);
		for (int k = 0; k < 3; ++k) {
			const Point3d corner = tree.corner(f, k) - m.centre;
			detail::addTo(
				m.cubic, detail::product(detail::product(normal, corner), corner), 1.0 / 12);
		}
	}

	/// What is harmonic stays so: multiples of |r|^2 that are left out here have no harmonic part.
	static void addMoments(const Moments& child, Moments& m)
	{
		const Point3d to = child.centre - m.centre;
		const detail::QuadraticForm moved = detail::product(child.linear, to);
		m.linear += child.linear;
		detail::addTo(m.quadratic, child.quadratic, 1);
		detail::addTo(m.quadratic, moved, 1);
		detail::addTo(m.cubic, child.cubic, 1);
		detail::addTo(m.cubic, detail::product(child.quadratic, to), 2);
		detail::addTo(m.cubic, detail::product(moved, to), 1);
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
