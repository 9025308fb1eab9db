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
#include <skeleton/flow/flow_system.h>

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

/// The flow's own matrix M for the published w_L = 1, of which nothing is fixed: L, in the order of elimination.
/// @pre mesh is compact.
inline FlowSystem flowLaplacian(const SurfaceMesh& mesh)
{
	return flowSystem(initialStage(mesh, checks::noPoles(mesh)), Parameters());
}

/// Ends and pads the row that the last entries belong to.
inline void endRow(SymmetricRows& rows)
{
	rows.entries.resize(size_t(filledUp(int(rows.entries.size()), SymmetricRows::Group)));
	rows.start.push_back(int(rows.entries.size()));
}

/**
 * The same in the order of the vertices: the positive semi-definite (L x)_i = sum_j w_ij (x_i - x_j), with
 * constants as its null space. @pre mesh is compact. Complexity: that of the system, O(V).
 */
inline SymmetricRows cotangentLaplacian(const SurfaceMesh& mesh)
{
	const FlowSystem system = flowLaplacian(mesh);
	const int n = system.M.size();
	std::vector<int> row(system.vertex.size());
	for (int i = 0; i < n; ++i)
		row[size_t(system.vertex[size_t(i)])] = i;
	SymmetricRows L;
	L.start.push_back(0);
	for (const int i : row) {
		for (int k = system.M.start[i]; k < system.M.start[i + 1]; ++k) {
			const SparseEntry& entry = system.M.entries[k];
			if (entry.value != 0) // what rows are filled up with
				L.entries.push_back({system.vertex[size_t(entry.index)], entry.value});
		}
		L.excess.push_back(system.M.excess[i]);
		L.diagonal.push_back(system.M.diagonal[i]);
		endRow(L);
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

/// The Laplacian of a mesh that is numbered as the flow does.
inline SymmetricRows orderedLaplacian(SurfaceMesh mesh)
{
	renumberBreadthFirst(mesh);
	return flowLaplacian(mesh).M;
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
