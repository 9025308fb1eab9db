// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "shapes.h"

#include <skeleton/solver/incomplete_ldlt.h>

#include <gtest/gtest.h>

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

TEST(IncompleteFactor, DroppingSmallEntriesHardlyChangesTheSolution)
{
	const SymmetricRows L =
		systems::orderedLaplacian(shapes::jittered(shapes::torus(1, 0.3, 90, 30), 0.005).mesh());
	const std::vector<float> shift(L.size(), 0.1f);
	EXPECT_LT(relativeError(L, shift, 1e-3f), 0.07);
	EXPECT_LT(relativeError(L, shift, 1e-3f), relativeError(L, shift, 1e-1f));
}

TEST(IncompleteFactor, WhatIsDroppedDoesNotStiffenTheSmoothPart)
{
	// With b constant, so is x = b / shift. The factor has a quarter of its entries and gets near.
	const SymmetricRows L =
		systems::orderedLaplacian(shapes::jittered(shapes::torus(1, 0.3, 90, 30), 0.005).mesh());
	const float shift = 0.1f;
	FloatQuads x(L.size(), FloatQuad(shift, -2 * shift, 3 * shift, 0.f));
	IncompleteFactor(L, std::vector<float>(L.size(), shift), 2e-2f).solve(x);
	for (const FloatQuad& xi : x)
		for (int k = 0; k < 3; ++k)
			EXPECT_NEAR(xi[k] * (k == 1 ? -1 : 1), k + 1, 0.3 * (k + 1));
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
		M.endRow();
	}
	EXPECT_THROW(IncompleteFactor(M, {0, 0}, 0), SolverError);
	M.diagonal = {std::nanf(""), 1};
	EXPECT_THROW(IncompleteFactor(M, {0, 0}, 0), SolverError);
}
