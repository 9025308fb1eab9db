// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement: which of the skeleton's balls a point is in.

#ifndef VCG_MCF_HOLDING_BALLS_H
#define VCG_MCF_HOLDING_BALLS_H

#include <skeleton/graph/curve_skeleton.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * The balls around the nodes of a skeleton to which nodes may be added. Nodes with consecutive ids
 * are mostly near each other: a point outside the bounding box of a block of them is in none of
 * their balls.
 */
class HoldingBalls
{
public:
	/// @param skeleton kept by reference. Complexity: O(N).
	explicit HoldingBalls(const CurveSkeleton& skeleton) : skeleton(skeleton) { addNew(); }

	/// Takes in the nodes that the skeleton has got since. @pre the others have not changed.
	void addNew()
	{
		const size_t count = skeleton.position.size();
		boxes.resize((count + blockSize - 1) / blockSize);
		for (; known < count; ++known) {
			const Point3d& p = skeleton.position[known];
			const double reach = skeleton.radius[known] * (1 + rounding) + rounding;
			if (skeleton.radius[known] > 0)
				boxes[known / blockSize].Add(
					Box3d(p - Point3d(reach, reach, reach), p + Point3d(reach, reach, reach)));
		}
	}

	/// The node whose ball holds a point nearest to its centre, in radii, the lowest of several; -1
	/// outside all balls. Complexity: O(N), with a small factor.
	int deepest(const Point3d& point) const
	{
		int holding = -1;
		double minimum = 1;
		for (size_t block = 0; block < boxes.size(); ++block) {
			if (!boxes[block].IsIn(point))
				continue;
			const size_t end = std::min(known, (block + 1) * blockSize);
			for (size_t v = block * blockSize; v < end; ++v)
				if (const double r = skeleton.radius[v]; r > 0)
					if (const double depth = Distance(skeleton.position[v], point) / r;
						depth < minimum) {
						minimum = depth;
						holding = int(v);
					}
		}
		return holding;
	}

private:
	static constexpr size_t blockSize = 32;
	static constexpr double rounding = 1e-12; // of coordinates in a shape of size 1

	const CurveSkeleton& skeleton;
	std::vector<Box3d> boxes;
	size_t known = 0;
};

} // namespace vcg::tri::mcf::refining

#endif
