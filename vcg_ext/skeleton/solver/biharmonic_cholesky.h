// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The linear system of the flow by a direct solver, as in Sec. 5 of the paper.

#ifndef VCG_MCF_BIHARMONIC_CHOLESKY_H
#define VCG_MCF_BIHARMONIC_CHOLESKY_H

#include "symmetric_csr.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>

#include <vcg/space/point3.h>

#include <Eigen/SparseCholesky>

#include <vector>

namespace vcg::tri::mcf {

/**
 * Solves (M^2 + D) x = b, as solveBiharmonic(), by a Cholesky factorisation in double precision.
 *
 * M^2 is formed and M^2 + D factorised completely: some ten times the time and memory of
 * solveBiharmonic().
 *
 * @param M symmetric, positive semi-definite, n by n.
 * @param D diagonal, positive, n.
 * @param b right-hand sides, n by 3.
 * @return x, n by 3.
 * @throws SolverError if the factorisation breaks down; Cancelled, only between its phases.
 * Complexity: about O(n log n) on surface meshes.
 */
inline std::vector<Point3d> solveBiharmonicDirectly(const SymmetricRows& M,
	const std::vector<float>& D, const std::vector<Point3d>& b,
	const Progress& progress = Progress())
{
	using Sparse = Eigen::SparseMatrix<double>;
	const int n = M.size();
	std::vector<Eigen::Triplet<double>> entries;
	entries.reserve(M.entries.size() + size_t(n));
	for (int i = 0; i < n; ++i) {
		double diagonal = M.excess[i];
		for (int k = M.start[i]; k < M.start[i + 1]; ++k) {
			const auto& [j, value] = M.entries[k];
			if (value == 0)
				continue; // padding
			diagonal -= value;
			entries.emplace_back(i, j, value);
		}
		entries.emplace_back(i, i, diagonal);
	}
	Sparse m(n, n), A(n, n);
	m.setFromTriplets(entries.begin(), entries.end());
	progress.report(0.1, "Contracting");
	A = m * m;
	for (int i = 0; i < n; ++i)
		A.coeffRef(i, i) += D[i];
	progress.report(0.2, "Contracting");
	Eigen::SimplicialLLT<Sparse> factor;
	factor.analyzePattern(A);
	progress.report(0.4, "Contracting");
	factor.factorize(A);
	if (factor.info() != Eigen::Success)
		throw SolverError("The contraction's linear system could not be factorised: the mesh has "
						  "degenerate triangles, or w_h is too small beside w_l. Resample the "
						  "mesh first, or enlarge w_h.");
	progress.report(0.9, "Contracting");
	Eigen::MatrixXd right(n, 3);
	for (int i = 0; i < n; ++i)
		for (int k = 0; k < 3; ++k)
			right(i, k) = b[i][k];
	const Eigen::MatrixXd solution = factor.solve(right);
	std::vector<Point3d> x;
	x.reserve(size_t(n));
	for (int i = 0; i < n; ++i)
		x.emplace_back(solution(i, 0), solution(i, 1), solution(i, 2));
	progress.report(1, "Contracting");
	return x;
}

} // namespace vcg::tri::mcf

#endif
