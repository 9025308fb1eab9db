// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The largest ball that touches a surface at a point from inside.

#ifndef VCG_MCF_MAXIMAL_BALL_H
#define VCG_MCF_MAXIMAL_BALL_H

#include <vcg/space/point3.h>

#include <algorithm>

namespace vcg::tri::mcf {

namespace detail {

/**
 * The largest ball through p, on the inner side of its normal, with no sample deeper than delta.
 *
 * The ball of radius r has its centre at c = p - r n. A sample q, with e = p - q, lies exactly
 * delta deep where |c - q| = r - delta, that is at
 *     r(q) = (|e|^2 - delta^2) / (2 (e.n - delta)),   e.n > delta,
 * and the balls grow monotonically with r, so the answer is the minimum of r(q) over all q. A
 * search finds it whatever the order of its visits, to the last bit: the test that skips a sample
 * leaves room for rounding, and what passes is compared by r(q) itself.
 */
class MaximalBall
{
public:
	/// @param n outward, unit length. @param largest the radius if nothing bounds the ball.
	MaximalBall(const Point3d& p, const Point3d& n, double delta, double largest) :
			p(p), n(n), c(p - n * largest), delta(delta), r(largest)
	{
	}

	double radius() const { return r; }
	/// The place in the tree of the sample that holds the ball, -1 if none does.
	int contact() const { return contactSlot; }

	const Point3d& centre() const { return c; }
	double reach() const { return std::max(r - delta, 0.0); }
	void visit(int slot, const Point3d& q)
	{
		constexpr double rounding = 1e-12;
		const Point3d e = p - q;
		const double depth = e * n - delta;
		const double span = e.SquaredNorm() - delta * delta;
		// One branch for both conditions: the sign of the depth is unpredictable.
		if (!((depth > 0) & (span <= 2 * r * depth * (1 + rounding))))
			return;
		const double rq = span / (2 * depth);
		if (rq < r) {
			r = rq;
			c = p - n * r;
			contactSlot = slot;
		}
	}

private:
	Point3d p, n, c;
	double delta, r;
	int contactSlot = -1;
};

} // namespace detail

} // namespace vcg::tri::mcf

#endif
