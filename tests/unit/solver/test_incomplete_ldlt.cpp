// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "shapes.h"

#include <skeleton/solver/biharmonic_pcg.h>
#include <skeleton/solver/incomplete_ldlt.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// |(M + shift)^-1 b by the factor - the same by Eigen| / |the latter|, Frobenius norms.
double relativeError(const SymmetricRows& M, const std::vector<float>& shift, float dropTolerance)
{
	const std::vector<Point3d> b = systems::randomColumns(M.size(), 11);
	FloatQuads x(M.size());
	for (int i = 0; i < M.size(); ++i)
		x[i] = FloatQuad(float(b[i][0]), float(b[i][1]), float(b[i][2]), 0.f);
	IncompleteFactor(M, shift, dropTolerance).solve(x);
	const Eigen::MatrixXd exact =
		systems::solved(systems::sparse(M) + systems::diagonal(shift), systems::matrix(b));
	Eigen::MatrixXd X(M.size(), 3);
	for (int i = 0; i < M.size(); ++i)
		for (int k = 0; k < 3; ++k)
			X(i, k) = x[i][k];
	return (X - exact).norm() / exact.norm();
}

struct Extremes
{
	double min, max;
};

/// The extreme eigenvalues of (L D L^T)^-2 (M^2 + D) for the factor of M + sqrt D, by the tridiagonal matrix of
/// conjugate gradients (Lanczos).
Extremes preconditionedEigenvalues(
	const SymmetricRows& rows, const std::vector<float>& D, float dropTolerance)
{
	constexpr int steps = 25;
	const int n = rows.size();
	std::vector<float> rootD;
	for (float d : D)
		rootD.push_back(std::sqrt(d));
	const IncompleteFactor factor(rows, rootD, dropTolerance);
	const systems::Sparse M = systems::sparse(rows), diagonal = systems::diagonal(D);
	const auto preconditioned = [&](const Eigen::VectorXd& r) {
		FloatQuads x(size_t(n), FloatQuad::Zero());
		for (int i = 0; i < n; ++i)
			x[size_t(i)][0] = float(r[i]);
		factor.solve(x);
		factor.solve(x);
		Eigen::VectorXd z(n);
		for (int i = 0; i < n; ++i)
			z[i] = x[size_t(i)][0];
		return z;
	};
	Eigen::VectorXd r = systems::matrix(systems::randomColumns(n, 3)).col(0);
	Eigen::VectorXd z = preconditioned(r), p = z;
	Eigen::MatrixXd T = Eigen::MatrixXd::Zero(steps, steps);
	double rz = r.dot(z);
	const double start = rz;
	int k = 0;
	for (double fromLast = 0; k < steps && rz > 1e-10 * start;
		 ++k) { // single precision has no more
		const Eigen::VectorXd Ap = M * (M * p) + diagonal * p;
		const double alpha = rz / p.dot(Ap);
		r -= alpha * Ap;
		z = preconditioned(r);
		const double beta = r.dot(z) / rz;
		T(k, k) = 1 / alpha + fromLast;
		if (k + 1 < steps)
			T(k, k + 1) = T(k + 1, k) = std::sqrt(beta) / alpha;
		fromLast = beta / alpha;
		p = z + beta * p;
		rz *= beta;
	}
	const Eigen::VectorXd found =
		Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T.topLeftCorner(k, k)).eigenvalues();
	return {found[0], found[k - 1]};
}

} // namespace

TEST(IncompleteFactor, WithoutDroppingItIsTheFactor)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::box(), shapes::jittered(shapes::torus(), 0.01),
			shapes::plate(3), shapes::joined({shapes::sphere(2), shapes::octahedron()})}) {
		const SymmetricRows L = systems::orderedLaplacian(soup.mesh());
		EXPECT_LT(
			relativeError(L, std::vector<float>(L.size(), 0.1f), 0), 1e-4); // single precision
		EXPECT_LT(relativeError(L, std::vector<float>(L.size(), 10), 0), 1e-5);
	}
}

TEST(IncompleteFactor, PreconditionsAsTheSolverExpects)
{
	// Of (M + sqrt D)^-2 (M^2 + D). Without dropping and for a constant D the eigenvalues are
	// (m^2 + d) / (m + sqrt d)^2, from 1/2 to 1. Conjugate gradients divide r . z by
	// ((sqrt k + 1) / (sqrt k - 1))^2 in each iteration, where k is the quotient of the extreme ones.
	// The solver counts on a tenth.
	const double root = std::sqrt(0.1), expected = std::pow((1 + root) / (1 - root), 2); // 3.7
	for (const shapes::Soup& soup : {shapes::jittered(shapes::torus(1, 0.3, 90, 30), 0.005),
			 shapes::capsule(), shapes::sphere(4), shapes::plate(3)}) {
		const SymmetricRows L = systems::orderedLaplacian(soup.mesh());
		std::vector<float> velocity(size_t(L.size()), 0.01f), withPoles = velocity;
		for (size_t i = 0; i < withPoles.size(); ++i)
			withPoles[i] += i % 3 ? 0.04f : 0;
		const Extremes exact = preconditionedEigenvalues(L, velocity, 0);
		EXPECT_GT(exact.min, 0.5 * (1 - 1e-3));
		EXPECT_LT(exact.max, 1 + 1e-3);
		for (const std::vector<float>& D : {velocity, withPoles}) {
			const Extremes range = preconditionedEigenvalues(L, D, detail::dropTolerance);
			EXPECT_LT(range.max, expected * range.min) << L.size();
		}
	}
}

TEST(IncompleteFactor, DroppingSmallEntriesHardlyChangesTheSolution)
{
	// The eigenvalues of the exact preconditioner are within a factor of 2. For them to stay within one of 3.7 after
	// dropping, those of this factor, which is applied twice, may lie sqrt(3.7 / 2) = 1.36 apart: 1 / 1.17 to 1.17.
	constexpr double maxError = 0.17;
	const SymmetricRows L =
		systems::orderedLaplacian(shapes::jittered(shapes::torus(1, 0.3, 90, 30), 0.005).mesh());
	const std::vector<float> shift(size_t(L.size()), 0.1f);
	const double shipped = relativeError(L, shift, detail::dropTolerance);
	EXPECT_LT(shipped, maxError);
	EXPECT_LT(2 * relativeError(L, shift, detail::dropTolerance / 4), shipped);
	EXPECT_LT(shipped, relativeError(L, shift, 4 * detail::dropTolerance));
	EXPECT_GT(shipped, 100 * relativeError(L, shift, 0)) << "nothing was dropped";

	// What is dropped does not stiffen the smooth part: with b constant, so is x = b / shift.
	FloatQuads x(size_t(L.size()), FloatQuad(shift[0], -2 * shift[0], 3 * shift[0], 0.f));
	IncompleteFactor(L, shift, detail::dropTolerance).solve(x);
	for (const FloatQuad& xi : x)
		for (int k = 0; k < 3; ++k)
			EXPECT_NEAR(xi[k] * (k == 1 ? -1 : 1), k + 1, maxError * (k + 1));
}

TEST(IncompleteFactor, AnyNumberingIsRight)
{
	// Not in an order of low fill: slower, but the same solution.
	const SymmetricRows L =
		systems::cotangentLaplacian(shapes::shuffled(shapes::torus(1, 0.3, 24, 10)).mesh());
	EXPECT_LT(relativeError(L, std::vector<float>(L.size(), 0.1f), 0), 1e-4);
}

TEST(IncompleteFactor, UnevenShiftsAreRight)
{
	const SymmetricRows L = systems::orderedLaplacian(shapes::sphere(3).mesh());
	std::vector<float> shift(L.size());
	for (size_t i = 0; i < shift.size(); ++i)
		shift[i] = i % 2 ? 0.1f : std::sqrt(0.05f);
	EXPECT_LT(relativeError(L, shift, 0), 1e-4);
}

TEST(IncompleteFactor, ADiagonalMatrixIsDivided)
{
	SymmetricRows M;
	M.diagonal = {1, 2, 3};
	M.start = {0, 0, 0, 0};
	FloatQuads x(3, FloatQuad(6.f, 12.f, 24.f, 0.f));
	IncompleteFactor(M, {1, 1, 1}, 1e-3f).solve(x);
	for (int i = 0; i < 3; ++i)
		for (int k = 0; k < 3; ++k)
			EXPECT_FLOAT_EQ(x[i][k], 6.f * float(1 << k) / float(i + 2));
}

TEST(IncompleteFactor, RefusesWhatIsNotPositive)
{
	SymmetricRows M; // eigenvalues 1 and -3
	M.diagonal = {-1, -1};
	M.start = {0};
	for (int other : {1, 0}) {
		M.entries.push_back({other, 2});
		systems::endRow(M);
	}
	EXPECT_THROW(IncompleteFactor(M, {0, 0}, 0), SolverError);
	M.diagonal = {std::nanf(""), 1};
	EXPECT_THROW(IncompleteFactor(M, {0, 0}, 0), SolverError);
}
