// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What a pole method returns.

#ifndef VCG_MCF_POLE_SET_H
#define VCG_MCF_POLE_SET_H

#include <vcg/space/point3.h>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/// One inner medial pole for each vertex.
struct PoleSet
{
	/// Centres, one for each vertex, mesh units; meaningless where the radius is negative.
	std::vector<Point3d> centre;
	/// Distance from the vertex to its pole, mesh units; -1 where the vertex has none.
	std::vector<double> radius;

	bool has(int v) const { return radius[v] >= 0; }

	int missing() const
	{
		return int(std::count_if(radius.begin(), radius.end(), [](double r) { return r < 0; }));
	}
};

} // namespace vcg::tri::mcf

#endif
