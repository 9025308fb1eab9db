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
 * if it were enlarged until its sizing field is neutralLength. Where nodes have to be fewer than that, it
 * does not fall below a minimum; what depends on how thick the shape is, whatever the distance of its
 * nodes, follows the thickness all the same.
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

	/// As the thickness says, however small, at a triangle of the surface: the mean of its corners.
	double ofThicknessAtFace(int face) const
	{
		if (isUniform())
			return 1;
		const Triangle t = surface->triangle(face);
		return (ofVertex[t[0]] + ofVertex[t[1]] + ofVertex[t[2]]) / 3;
	}

	/// At a triangle of the surface.
	double atFace(int face) const { return std::max(ofThicknessAtFace(face), minScale); }

	/// Where the surface is closest to a point.
	double at(const Point3d& point, const ClosestSurface& closest) const
	{
		return isUniform() ? 1 : atFace(closest.closest(point).face);
	}

	/// The minimum over some vertices. @param vertices as a connected component's.
	double minimum(const std::vector<int>& vertices) const
	{
		double minimum = 1;
		if (!isUniform())
			for (int v : vertices)
				minimum = std::min(minimum, std::max(ofVertex[v], minScale));
		return minimum;
	}

	/// The factor below which it does not fall from now on; 0: it follows the thickness wherever.
	void setMin(double minimum) { minScale = minimum; }
	double minimum() const { return minScale; }

private:
	const SurfaceMesh* surface = nullptr;
	std::vector<double> ofVertex;
	double minScale = 0;
};

/// The scale of shapes of one scale.
inline const LocalScale sameEverywhere;

} // namespace vcg::tri::mcf::refining

#endif
