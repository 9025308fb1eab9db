// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The Laplacian L of Sec. 4.2: cotangent weights, bounded where triangles degenerate.

#ifndef VCG_MCF_COTANGENT_WEIGHTS_H
#define VCG_MCF_COTANGENT_WEIGHTS_H

#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vcg::tri::mcf {

/// What the flow measures of a triangle.
struct TriangleMeasures
{
	/// For each half-edge the cotangent of the opposite angle, clamped to [-100, 100], so that a
	/// sliver cannot stiffen the system.
	std::array<double, 3> cotangent;
	/// As SurfaceMesh::doubleAreaVector().
	Point3d doubleAreaVector;
};

inline TriangleMeasures measureTriangle(const SurfaceMesh& mesh, int face)
{
	constexpr double largestCotangent = 100;
	const Triangle t = mesh.triangle(face);
	const Point3d &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
	const Point3d ab = b - a, bc = c - b, ca = a - c;
	TriangleMeasures measures;
	measures.doubleAreaVector = ca ^ ab;
	const double doubleArea = measures.doubleAreaVector.Norm();
	const double dot[3] = {-(bc * ca), -(ca * ab), -(ab * bc)};
	for (int k = 0; k < 3; ++k)
		measures.cotangent[k] = std::abs(dot[k]) < largestCotangent * doubleArea
			? dot[k] / doubleArea
			: std::copysign(largestCotangent, dot[k]);
	return measures;
}

/**
 * The cotangent weight of an edge: w_ij = (cot(alpha_ij) + cot(beta_ij)) / 2, where alpha and beta
 * are the opposite angles (Desbrun et al. 1999), given their cotangents; dimensionless.
 *
 * It is at least 1e-3, so that L stays an M-matrix: the flow then never pushes a vertex outwards.
 */
inline double cotangentWeight(double cotAlpha, double cotBeta)
{
	constexpr double minWeight = 1e-3;
	return std::max((cotAlpha + cotBeta) / 2, minWeight);
}

} // namespace vcg::tri::mcf

#endif
