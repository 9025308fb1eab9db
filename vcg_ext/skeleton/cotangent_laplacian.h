// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The Laplacian L of Sec. 4.2: cotangent weights, bounded where triangles degenerate.

#ifndef VCG_MCF_COTANGENT_LAPLACIAN_H
#define VCG_MCF_COTANGENT_LAPLACIAN_H

#include "surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A symmetric sparse matrix by rows, the diagonal apart, as the flow's solver wants it:
 * (A x)_i = diagonal[i] x_i + sum_k value[k] x_column[k], k in [start[i], start[i + 1]).
 */
struct SymmetricRows
{
	std::vector<double> diagonal;
	std::vector<int> start, column;
	std::vector<double> value;

	int size() const { return int(diagonal.size()); }

	/// y = A x, for three columns at once.
	void multiply(const std::vector<Point3d>& x, std::vector<Point3d>& y) const
	{
		for (int i = 0; i < size(); ++i) {
			Point3d sum = x[i] * diagonal[i];
			for (int k = start[i]; k < start[i + 1]; ++k)
				sum += x[column[k]] * value[k];
			y[i] = sum;
		}
	}
};

/**
 * The cotangent weight of each half-edge's edge: w_ij = (cot(alpha_ij) + cot(beta_ij)) / 2, where
 * alpha and beta are the angles opposite the edge (Desbrun et al. 1999); #half-edges, dimensionless.
 *
 * Cotangents are bounded to [-100, 100], so that a sliver cannot stiffen the system, and weights
 * to at least 1e-3, so that L stays an M-matrix: the flow then never pushes a vertex outwards.
 * Complexity: O(F).
 */
inline std::vector<double> cotangentWeights(const SurfaceMesh& mesh)
{
	constexpr double largestCotangent = 100, leastWeight = 1e-3;
	std::vector<double> cotangent(mesh.halfEdgeSlots(), 0), weight(mesh.halfEdgeSlots(), 0);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		if (!mesh.isFace(f))
			continue;
		const Triangle t = mesh.triangle(f);
		const Point3d* p[3] = {&mesh.position[t[0]], &mesh.position[t[1]], &mesh.position[t[2]]};
		const double doubleArea = ((*p[1] - *p[0]) ^ (*p[2] - *p[0])).Norm();
		for (int k = 0; k < 3; ++k) {
			// The half-edge k runs from corner k to k + 1; the angle opposite is at corner k + 2.
			const Point3d u = *p[k] - *p[(k + 2) % 3], v = *p[(k + 1) % 3] - *p[(k + 2) % 3];
			const double dot = u * v;
			cotangent[3 * f + k] = std::abs(dot) < largestCotangent * doubleArea
				? dot / doubleArea
				: std::copysign(largestCotangent, dot);
		}
	}
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isHalfEdge(h))
			weight[h] = std::max((cotangent[h] + cotangent[mesh.twin(h)]) / 2, leastWeight);
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
			L.column.push_back(mesh.target(h));
			L.value.push_back(-weight[h]);
		});
		L.diagonal.push_back(sum);
		L.start.push_back(int(L.column.size()));
	}
	return L;
}

} // namespace vcg::tri::mcf

#endif
