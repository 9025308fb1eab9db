// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the scale: the factor by which lengths shrink where the shape is thin.

#ifndef VCG_MCF_LOCAL_SCALE_H
#define VCG_MCF_LOCAL_SCALE_H

#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/**
 * The factor of all lengths of the refinement at a place, in (0, 1]: a thin part is refined as if
 * it were enlarged until its sizing field is neutralLength. Where that would take too many nodes,
 * the factor has a lower bound, see setMin(); ofThicknessAtFace() leaves the bound out, for lengths
 * that depend on the thickness whatever the spacing of the nodes.
 */
class LocalScale
{
public:
	/// The factor is 1 everywhere.
	LocalScale() = default;
	/// @param surface  kept by reference.
	/// @param ofVertex for each vertex slot, in (0, 1]; empty: 1 everywhere.
	LocalScale(const SurfaceMesh& surface, std::vector<double> ofVertex) :
			surface(&surface), ofVertex(std::move(ofVertex))
	{
	}

	bool isUniform() const { return ofVertex.empty(); }

	/// The mean factor of a triangle's corners, without the lower bound.
	double ofThicknessAtFace(int face) const
	{
		if (isUniform())
			return 1;
		const Triangle t = surface->triangle(face);
		return (ofVertex[t[0]] + ofVertex[t[1]] + ofVertex[t[2]]) / 3;
	}

	/// The mean factor of a triangle's corners, with the lower bound.
	double atFace(int face) const { return std::max(ofThicknessAtFace(face), minScale); }

	/// The factor at the triangle that is closest to a point.
	double at(const Point3d& point, const ClosestSurface& closest) const
	{
		return isUniform() ? 1 : atFace(closest.closest(point).face);
	}

	/// The smallest factor at some vertices, such as those of a component, with the lower bound.
	double minimum(const std::vector<int>& vertices) const
	{
		double minimum = 1;
		if (!isUniform())
			for (int v : vertices)
				minimum = std::min(minimum, std::max(ofVertex[v], minScale));
		return minimum;
	}

	/// Sets the lower bound of the factor; 0: none.
	void setMin(double minimum) { minScale = minimum; }
	double minimum() const { return minScale; }

private:
	const SurfaceMesh* surface = nullptr;
	std::vector<double> ofVertex;
	double minScale = 0;
};

/// The factor of shapes that are not thin anywhere: 1.
inline const LocalScale sameEverywhere;

} // namespace vcg::tri::mcf::refining

#endif
