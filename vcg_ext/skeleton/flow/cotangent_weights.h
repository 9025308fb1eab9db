// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The Laplacian L of Sec. 4.2: cotangent weights, bounded where triangles degenerate.

#ifndef VCG_MCF_COTANGENT_WEIGHTS_H
#define VCG_MCF_COTANGENT_WEIGHTS_H

#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/solver/symmetric_csr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// What the flow needs to know about a triangle.
struct TriangleMeasures
{
	/// For each half-edge the cotangent of the angle opposite, bounded to [-100, 100], so that a sliver
	/// cannot stiffen the system.
	std::array<double, 3> cotangent;
	/// As SurfaceMesh::areaVector().
	Point3d areaVector;
};

inline TriangleMeasures measureTriangle(const SurfaceMesh& mesh, int face)
{
	constexpr double largestCotangent = 100;
	const Triangle t = mesh.triangle(face);
	const Point3d &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
	const Point3d ab = b - a, bc = c - b, ca = a - c;
	TriangleMeasures measures;
	measures.areaVector = ca ^ ab;
	const double doubleArea = measures.areaVector.Norm();
	const double dot[3] = {-(bc * ca), -(ca * ab), -(ab * bc)};
	for (int k = 0; k < 3; ++k)
		measures.cotangent[k] = std::abs(dot[k]) < largestCotangent * doubleArea
			? dot[k] / doubleArea
			: std::copysign(largestCotangent, dot[k]);
	return measures;
}

/**
 * The cotangent weight of an edge: w_ij = (cot(alpha_ij) + cot(beta_ij)) / 2, where alpha and beta are
 * the angles opposite (Desbrun et al. 1999), given their cotangents; dimensionless.
 *
 * It is at least 1e-3, so that L stays an M-matrix: the flow then never pushes a vertex outwards.
 */
inline double cotangentWeight(double cotAlpha, double cotBeta)
{
	constexpr double leastWeight = 1e-3;
	return std::max((cotAlpha + cotBeta) / 2, leastWeight);
}

/// cotangentWeight() of each half-edge's edge. Complexity: O(F).
inline std::vector<double> cotangentWeights(const SurfaceMesh& mesh)
{
	std::vector<double> cotangent(mesh.halfEdgeSlots(), 0), weight(mesh.halfEdgeSlots(), 0);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		if (!mesh.isFace(f))
			continue;
		const TriangleMeasures measures = measureTriangle(mesh, f);
		std::copy(measures.cotangent.begin(), measures.cotangent.end(), &cotangent[3 * size_t(f)]);
	}
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isHalfEdge(h))
			weight[h] = cotangentWeight(cotangent[h], cotangent[mesh.twin(h)]);
	return weight;
}

/**
 * The positive semi-definite Laplacian of the whole mesh: (L x)_i = sum_j w_ij (x_i - x_j).
 * Constants are its null space. @pre mesh is compact. Complexity: O(V).
 */
inline SymmetricRows cotangentLaplacian(const SurfaceMesh& mesh)
{
	const std::vector<double> weight = cotangentWeights(mesh);
	SymmetricRows L;
	L.start.push_back(0);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		double sum = 0;
		mesh.forEachOutgoing(v, [&](int h) {
			sum += weight[h];
			L.entries.push_back({mesh.target(h), float(-weight[h])});
		});
		L.excess.push_back(0);
		L.diagonal.push_back(float(sum));
		L.endRow();
	}
	return L;
}

} // namespace vcg::tri::mcf

#endif
