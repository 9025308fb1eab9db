// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Four boxes in single precision: a node of a tree, tested by vector instructions.

#ifndef VCG_MCF_FOUR_BOXES_H
#define VCG_MCF_FOUR_BOXES_H

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <Eigen/Core>

#include <limits>

namespace vcg::tri::mcf {

/**
 * Four axis-parallel boxes, relative to the origin of their tree.
 *
 * Coordinates are rounded, not widened: the caller enlarges its query by slack().
 */
class FourBoxes
{
public:
	/// More than rounding can move a box or a point of a tree whose box has this diagonal.
	static double slack(double diagonal)
	{
		return 8 * std::numeric_limits<float>::epsilon() * diagonal;
	}

	/// All four are empty: infinitely far from anything.
	FourBoxes()
	{
		for (int axis = 0; axis < 3; ++axis)
			for (int k = 0; k < 4; ++k) {
				low[axis][k] = std::numeric_limits<float>::infinity();
				high[axis][k] = -std::numeric_limits<float>::infinity();
			}
	}

	void set(int k, const Box3d& box, const Point3d& origin)
	{
		for (int axis = 0; axis < 3; ++axis) {
			low[axis][k] = float(box.min[axis] - origin[axis]);
			high[axis][k] = float(box.max[axis] - origin[axis]);
		}
	}

	/// Squared distances from x to the boxes; 0 inside.
	Eigen::Array4f squaredDistances(const float (&x)[3]) const
	{
		using Four = Eigen::Array4f;
		Four sum = Four::Zero();
		for (int axis = 0; axis < 3; ++axis) {
			const Four below = Eigen::Map<const Four>(low[axis]) - x[axis];
			const Four above = x[axis] - Eigen::Map<const Four>(high[axis]);
			sum += below.max(above).max(0.f).square();
		}
		return sum;
	}

	/// How far [from, to] is from each box along the axis on which it is farthest; 0 or less where
	/// they share a point.
	Eigen::Array4f gaps(const float (&from)[3], const float (&to)[3]) const
	{
		using Four = Eigen::Array4f;
		Four gap = Four::Constant(-std::numeric_limits<float>::infinity());
		for (int axis = 0; axis < 3; ++axis) {
			const Four below = Eigen::Map<const Four>(low[axis]) - to[axis];
			const Four above = from[axis] - Eigen::Map<const Four>(high[axis]);
			gap = gap.max(below.max(above));
		}
		return gap;
	}

private:
	float low[3][4], high[3][4];
};

} // namespace vcg::tri::mcf

#endif
