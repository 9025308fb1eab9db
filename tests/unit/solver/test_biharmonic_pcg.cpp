// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "shapes.h"

#include <skeleton/solver/biharmonic_pcg.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// (M^2 + D)^-1 b, directly.
Eigen::MatrixXd exact(
	const SymmetricRows& M, const std::vector<float>& D, const std::vector<Point3d>& b)
{
	const systems::Sparse S = systems::sparse(M);
	return systems::solved(systems::Sparse(S * S) + systems::diagonal(D), systems::matrix(b));
}

/// The flow's D: the velocity weight, and the medial weight on two vertices of three.
std::vector<float> flowWeights(int n)
{
	std::vector<float> D(n, 0.01f);
	for (int i = 0; i < n; ++i)
		D[i] += i % 3 ? 0.04f : 0;
	return D;
}

} // namespace

TEST(BiharmonicSolver, MeetsTheDirectSolution)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::box(), shapes::jittered(shapes::torus(), 0.01),
			shapes::plate(3), shapes::joined({shapes::sphere(3), shapes::octahedron()})}) {
		const SymmetricRows M = systems::orderedLaplacian(soup.mesh());
		const std::vector<float> D = flowWeights(M.size());
		const std::vector<Point3d> b = systems::randomColumns(M.size(), 5);
		const std::vector<Point3d> x = solveBiharmonic(M, D, b, 1e-6);
		const Eigen::MatrixXd X = exact(M, D, b);
		EXPECT_LT((systems::matrix(x) - X).norm(), 1e-4 * X.norm());
	}
}

TEST(BiharmonicSolver, ALooserToleranceIsCloserThanTheStart)
{
	const SymmetricRows M =
		systems::orderedLaplacian(shapes::jittered(shapes::torus(), 0.01).mesh());
	const std::vector<float> D = flowWeights(M.size());
	const std::vector<Point3d> b = systems::randomColumns(M.size(), 6);
	const Eigen::MatrixXd X = exact(M, D, b);
	double previous = X.norm(); // the start is 0
	for (double tolerance : {1e-1, 1e-2, 1e-4}) {
		const std::vector<Point3d> x = solveBiharmonic(M, D, b, tolerance);
		const double error = (systems::matrix(x) - X).norm();
		EXPECT_LT(error, 0.5 * previous);
		previous = error;
	}
}

TEST(BiharmonicSolver, WithoutARightHandSideThereIsNothing)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::sphere(2).mesh());
	const std::vector<Point3d> zero(M.size(), Point3d(0, 0, 0));
	EXPECT_EQ(solveBiharmonic(M, flowWeights(M.size()), zero, 1e-2), zero);
}

TEST(BiharmonicSolver, ConstantsAreHeldByTheDiagonalAlone)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::sphere(2).mesh());
	const std::vector<float> D = flowWeights(M.size());
	const Point3d constant(1, -2, 3);
	std::vector<Point3d> b(M.size());
	for (int i = 0; i < M.size(); ++i)
		b[i] = constant * D[i]; // M x = 0
	for (const Point3d& p : solveBiharmonic(M, D, b, 1e-6))
		EXPECT_LT(vcg::Distance(p, constant), 1e-4);
}

TEST(BiharmonicSolver, SolvesColumnsThatNeedNothingBesideOthersThatDo)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::torus().mesh());
	const std::vector<float> D = flowWeights(M.size());
	std::vector<Point3d> b = systems::randomColumns(M.size(), 8);
	for (Point3d& p : b)
		p[1] = 0;
	const std::vector<Point3d> x = solveBiharmonic(M, D, b, 1e-6);
	const Eigen::MatrixXd X = exact(M, D, b);
	EXPECT_LT((systems::matrix(x) - X).norm(), 1e-4 * X.norm());
	for (const Point3d& p : x)
		EXPECT_EQ(p[1], 0);
}

TEST(BiharmonicSolver, SinglePrecisionInsideIsNoLimitOnTheUnit)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::torus().mesh());
	const std::vector<float> D = flowWeights(M.size());
	const std::vector<Point3d> b = systems::randomColumns(M.size(), 7);
	const std::vector<Point3d> x = solveBiharmonic(M, D, b, 1e-3);
	for (double unit : {std::ldexp(1.0, -200), std::ldexp(1.0, 200)}) { // floats end at 2^127
		std::vector<Point3d> scaled = b;
		for (Point3d& p : scaled)
			p *= unit;
		const std::vector<Point3d> y = solveBiharmonic(M, D, scaled, 1e-3);
		for (int i = 0; i < M.size(); ++i)
			EXPECT_EQ(y[i], x[i] * unit);
	}
}

TEST(BiharmonicSolver, TakesAnEmptySystem)
{
	SymmetricRows M;
	M.start = {0};
	EXPECT_TRUE(solveBiharmonic(M, {}, {}, 1e-2).empty());
}

TEST(BiharmonicSolver, CopesWithWeightsFarApart)
{
	// w_H = 20, w_M = 0 and w_L = 24: the far end of the sweep of Fig. 5; then far beyond it.
	const SurfaceMesh mesh = shapes::torus().mesh();
	for (float wL : {1.f, 24.f, 1000.f}) {
		SymmetricRows M = systems::orderedLaplacian(mesh);
		for (float& d : M.diagonal)
			d *= wL;
		for (SparseEntry& entry : M.entries)
			entry.value *= wL;
		const std::vector<float> D(M.size(), 0.01f);
		std::vector<Point3d> b(M.size());
		for (int i = 0; i < M.size(); ++i)
			b[i] = mesh.position[i] * 0.01;
		const std::vector<Point3d> x = solveBiharmonic(M, D, b, 1e-6);
		const Eigen::MatrixXd X = exact(M, D, b);
		EXPECT_LT((systems::matrix(x) - X).norm(), 0.01 * X.norm()) << "w_L " << wL;
	}
}

TEST(BiharmonicSolver, CanBeCancelled)
{
	const SymmetricRows M = systems::orderedLaplacian(shapes::sphere(2).mesh());
	const std::vector<Point3d> b = systems::randomColumns(M.size(), 5);
	const Progress no([](int, const char*) { return false; });
	EXPECT_THROW(solveBiharmonic(M, flowWeights(M.size()), b, 1e-6, no), Cancelled);
}
