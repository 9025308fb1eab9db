// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the scale: how much smaller than elsewhere lengths are where the shape is thin.

#ifndef VCG_MCF_LOCAL_SCALE_H
#define VCG_MCF_LOCAL_SCALE_H

#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * The factor of every length of the refinement at a place, in (0, 1]: a thin part is refined as it would be
 * if it were enlarged until its sizing field is neutralLength.
 */
class LocalScale
{
public:
	/// The same everywhere.
	LocalScale() = default;
	/// @param surface  kept by reference.
	/// @param ofVertex for each vertex slot, in (0, 1]; empty: 1 everywhere.
	LocalScale(const SurfaceMesh& surface, std::vector<double> ofVertex) :
			surface(&surface), ofVertex(std::move(ofVertex))
	{
	}

	bool isUniform() const { return ofVertex.empty(); }

	/// At a triangle of the surface: the mean of its corners.
	double atFace(int face) const
	{
		if (isUniform())
			return 1;
		const Triangle t = surface->triangle(face);
		return (ofVertex[t[0]] + ofVertex[t[1]] + ofVertex[t[2]]) / 3;
	}

	/// Where the surface is closest to a point.
	double at(const Point3d& point, const ClosestSurface& closest) const
	{
		return isUniform() ? 1 : atFace(closest.closest(point).face);
	}

	/// The least of some vertices. @param vertices as a connected component's.
	double least(const std::vector<int>& vertices) const
	{
		double least = 1;
		if (!isUniform())
			for (int v : vertices)
				least = std::min(least, ofVertex[v]);
		return least;
	}

	/// Makes it no smaller than `least` at some vertices. @param vertices as above.
	void raise(const std::vector<int>& vertices, double least)
	{
		for (int v : vertices)
			ofVertex[v] = std::max(ofVertex[v], least);
	}

private:
	const SurfaceMesh* surface = nullptr;
	std::vector<double> ofVertex;
};

/// The scale of shapes of one scale.
inline const LocalScale sameEverywhere;

} // namespace vcg::tri::mcf::refining

#endif
