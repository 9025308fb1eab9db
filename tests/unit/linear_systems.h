// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Systems as the flow has them, and their direct solution by Eigen.

#ifndef MCFSKEL_TESTS_LINEAR_SYSTEMS_H
#define MCFSKEL_TESTS_LINEAR_SYSTEMS_H

#include "mesh_checks.h"

#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/solver/symmetric_csr.h>
#include <skeleton/flow/cotangent_weights.h>
#include <skeleton/flow/fill_reducing_order.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <random>
#include <vector>

namespace systems {

using namespace vcg::tri::mcf;
using vcg::Point3d;
using Sparse = Eigen::SparseMatrix<double>;

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

inline Sparse sparse(const SymmetricRows& A)
{
	std::vector<Eigen::Triplet<double>> entries;
	for (int i = 0; i < A.size(); ++i) {
		entries.emplace_back(i, i, A.excess[i]);
		for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
			const double value = A.entries[k].value;
			entries.emplace_back(i, A.entries[k].index, value);
			entries.emplace_back(i, i, -value);
		}
	}
	Sparse S(A.size(), A.size());
	S.setFromTriplets(entries.begin(), entries.end());
	return S;
}

template <class Scalar>
Sparse diagonal(const std::vector<Scalar>& values)
{
	Sparse S(int(values.size()), int(values.size()));
	for (int i = 0; i < int(values.size()); ++i)
		S.insert(i, i) = values[i];
	return S;
}

/// The Laplacian of a mesh, numbered in the flow's elimination order.
inline SymmetricRows orderedLaplacian(SurfaceMesh mesh)
{
	renumberBreadthFirst(mesh);
	const Stage stage = initialStage(mesh, checks::noPoles(mesh));
	const std::vector<int> order = eliminationOrder(stage);
	std::vector<int> number(order.size());
	for (size_t i = 0; i < order.size(); ++i)
		number[order[i]] = int(i);
	const std::vector<double> weight = cotangentWeights(mesh);
	SymmetricRows L;
	L.start.push_back(0);
	for (int v : order) {
		double sum = 0;
		mesh.forEachOutgoing(v, [&](int h) {
			sum += weight[h];
			L.entries.push_back({number[mesh.target(h)], float(-weight[h])});
		});
		L.excess.push_back(0);
		L.diagonal.push_back(float(sum));
		L.endRow();
	}
	return L;
}

inline std::vector<Point3d> randomColumns(int n, unsigned seed)
{
	std::mt19937 random(seed);
	std::vector<Point3d> x(n);
	for (Point3d& p : x)
		for (int k = 0; k < 3; ++k)
			p[k] = 2.0 * random() / double(std::mt19937::max()) - 1;
	return x;
}

inline Eigen::MatrixXd matrix(const std::vector<Point3d>& x)
{
	Eigen::MatrixXd X(int(x.size()), 3);
	for (int i = 0; i < int(x.size()); ++i)
		for (int k = 0; k < 3; ++k)
			X(i, k) = x[i][k];
	return X;
}

/// S^-1 B, directly.
inline Eigen::MatrixXd solved(const Sparse& S, const Eigen::MatrixXd& B)
{
	return Eigen::SimplicialLDLT<Sparse>(S).solve(B);
}

} // namespace systems

#endif
