// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "shapes.h"

#include <skeleton/solver/biharmonic_cholesky.h>
#include <skeleton/solver/biharmonic_pcg.h>

#include <gtest/gtest.h>

#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

TEST(DirectSolver, LeavesNoResidual)
{
	for (const shapes::Soup& soup : {shapes::tetrahedron(), shapes::jittered(shapes::torus(), 0.01),
			 shapes::joined({shapes::sphere(3), shapes::octahedron()})}) {
		SymmetricRows M = systems::orderedLaplacian(soup.mesh());
		M.excess[0] = 0.25f; // as at a fixed neighbour
		const std::vector<float> D(size_t(M.size()), 0.01f);
		const std::vector<Point3d> b = systems::randomColumns(M.size(), 5);
		const Eigen::MatrixXd x = systems::matrix(solveBiharmonicDirectly(M, D, b));
		const systems::Sparse S = systems::sparse(M);
		const Eigen::MatrixXd residual =
			S * (S * x) + systems::diagonal(D) * x - systems::matrix(b);
		EXPECT_LT(residual.norm(), 1e-8 * systems::matrix(b).norm());
	}
}

TEST(DirectSolver, RefusesWhatIsNotPositive)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::octahedron().mesh());
	const std::vector<float> D(size_t(M.size()), -1000.f);
	EXPECT_THROW(solveBiharmonicDirectly(M, D, systems::randomColumns(M.size(), 1)), SolverError);
}
