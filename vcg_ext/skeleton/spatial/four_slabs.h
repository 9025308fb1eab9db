// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Four slabs in single precision: tight bounds of oblique pieces of a surface.

#ifndef VCG_MCF_FOUR_SLABS_H
#define VCG_MCF_FOUR_SLABS_H

#include <vcg/space/point3.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>

namespace vcg::tri::mcf {

/**
 * Four slabs, each the space between two parallel planes, relative to the origin of their tree.
 *
 * A piece of a surface of size s and radius of curvature R lies in a slab of thickness s^2 / (8 R),
 * but an axis-parallel box around an oblique piece is nearly as thick as it is wide. A ball that
 * touches the surface from inside reaches into many such boxes, but into few slabs.
 */
class FourSlabs
{
public:
	/// All four are unbounded.
	FourSlabs()
	{
		for (int k = 0; k < 4; ++k) {
			for (int axis = 0; axis < 3; ++axis)
				normal[axis][k] = 0;
			middle[k] = 0;
			half[k] = std::numeric_limits<float>::infinity();
		}
	}

	/**
	 * The slab of `count` points across the direction in which they spread least.
	 * @param pointAt  of an index from 0 to count - 1.
	 * @param slack    added on either side of the points, see FourBoxes::slack().
	 * @pre count > 0. Complexity: O(count).
	 */
	template <class PointAt>
	void set(int k, int count, const PointAt& pointAt, const Point3d& origin, double slack)
	{
		// Sums from the first point: from the origin, they would cancel where the piece is small.
		const Point3d first = pointAt(0);
		double x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
		for (int i = 1; i < count; ++i) {
			const Point3d d = pointAt(i) - first;
			x += d[0];
			y += d[1];
			z += d[2];
			xx += d[0] * d[0];
			xy += d[0] * d[1];
			xz += d[0] * d[2];
			yy += d[1] * d[1];
			yz += d[1] * d[2];
			zz += d[2] * d[2];
		}
		const Eigen::Vector3d sum(x, y, z);
		Eigen::Matrix3d spread;
		spread << xx, xy, xz, xy, yy, yz, xz, yz, zz;
		spread -= sum * sum.transpose() / count;
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
		solver.computeDirect(spread);
		const Eigen::Vector3f across = solver.eigenvectors().col(0).cast<float>();
		if (!across.allFinite())
			return; // overflow: the slab stays unbounded
		double low = std::numeric_limits<double>::infinity(), high = -low;
		for (int i = 0; i < count; ++i) {
			const Point3d p = pointAt(i) - origin;
			const double at = p[0] * across[0] + p[1] * across[1] + p[2] * across[2];
			low = std::min(low, at);
			high = std::max(high, at);
		}
		for (int axis = 0; axis < 3; ++axis)
			normal[axis][k] = across[axis];
		middle[k] = float((low + high) / 2);
		half[k] = float((high - low) / 2 + slack);
	}

	/// Distances from x to the slabs; 0 inside.
	Eigen::Array4f distances(const float (&x)[3]) const
	{
		using Four = Eigen::Array4f;
		Four height = -Eigen::Map<const Four>(middle);
		for (int axis = 0; axis < 3; ++axis)
			height += Eigen::Map<const Four>(normal[axis]) * x[axis];
		return (height.abs() - Eigen::Map<const Four>(half)).max(0.f);
	}

private:
	float normal[3][4], middle[4], half[4];
};

} // namespace vcg::tri::mcf

#endif
