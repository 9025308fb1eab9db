// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The linear solver of the flow: (M^2 + D) x = b for a Laplacian-like M and a diagonal D.

#ifndef VCG_MCF_BIHARMONIC_PCG_H
#define VCG_MCF_BIHARMONIC_PCG_H

#include "incomplete_ldlt.h"
#include "symmetric_csr.h"

#include <skeleton/core/progress.h>

#include <vcg/space/point3.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Drop tolerance of the preconditioner. From 4e-3 to 5.7e-3 all are as good on average, but single
/// tips of large bodies come and go with the last bits: see docs/design.md.
constexpr float dropTolerance = 5.28e-3f;

} // namespace detail

/**
 * Solves (M^2 + D) x = b by conjugate gradients from x = 0, preconditioned by (M + sqrt D)^-2.
 *
 * M^2 is never formed: its factor would have several times as many entries as that of M + sqrt D.
 * The preconditioner is close in spectrum, (M^2 + D) / (M + sqrt D)^2 lies in [1/2, 1] for
 * commuting M and D, so that a handful of iterations suffices. Vectors are in single precision,
 * sums over them in double: half the memory traffic, and one SIMD instruction for three columns.
 *
 * @param M     symmetric, positive semi-definite, n by n, in a fill-reducing order.
 * @param D     diagonal, positive, n.
 * @param b     right-hand sides, n by 3.
 * @param tolerance the residual, in the preconditioner's norm, falls to about this fraction of its
 *              value at the start; 1e-6 is what single precision allows.
 * @return x, n by 3.
 * @throws SolverError if the factorisation breaks down; Cancelled.
 */
inline std::vector<Point3d> solveBiharmonic(const SymmetricRows& M, const std::vector<float>& D,
	const std::vector<Point3d>& b, double tolerance, const Progress& progress = Progress())
{
	const int n = M.size();
	std::vector<Point3d> x(n, Point3d(0, 0, 0));
	// Single precision has no room for meshes of 1e-20 or 1e20 units: b is scaled to [-1, 1].
	double largest = 0;
	for (const Point3d& bi : b)
		for (int k = 0; k < 3; ++k)
			largest = std::max(largest, std::abs(bi[k]));
	if (largest == 0)
		return x;
	std::vector<float> rootD(n);
	for (int i = 0; i < n; ++i)
		rootD[i] = std::sqrt(D[i]);
	const IncompleteFactor factor(M, rootD, detail::dropTolerance, progress.part(0, 0.5));
	progress.report(0.5, "Contracting");

	using Sum = Eigen::Array4d; // one for each column
	FloatQuads r(n);            // the residual
	FloatQuads z(n);            // preconditioned
	FloatQuads y(n, FloatQuad::Zero()), p(n), Mp(n), Ap(n);
	for (int i = 0; i < n; ++i)
		z[i] = r[i] = FloatQuad(
			float(b[i][0] / largest), float(b[i][1] / largest), float(b[i][2] / largest), 0.f);
	/// Ap <- (M^2 + D) p. Returns p . Ap.
	const auto apply = [&] {
		M.forEachProduct(p, [&](int i, const FloatQuad& sum) { Mp[i] = sum; });
		Sum product = Sum::Zero();
		M.forEachProduct(Mp, [&](int i, const FloatQuad& sum) {
			Ap[i] = sum + p[i] * D[i];
			product += (p[i] * Ap[i]).cast<double>();
		});
		return product;
	};
	/// z <- (M + sqrt D)^-2 z, of a z that equals r. Returns r . z.
	const auto precondition = [&] {
		Sum product = Sum::Zero();
		factor.solve(z);
		factor.solve(z, [&](int i, const FloatQuad& zi) { product += (r[i] * zi).cast<double>(); });
		return product;
	};
	const auto quotient = [](const Sum& u, const Sum& v) -> FloatQuad {
		return (v != 0).select(u / v, Sum::Zero()).cast<float>();
	};

	Sum rz = precondition();
	std::swap(p, z);
	const double target = tolerance * tolerance * rz.sum();
	// r . z is expected to fall to a tenth in each iteration, as it does where the eigenvalues lie
	// within a factor of 3.7; in the first it falls further. An iteration that is expected to reach
	// the target is the last one; its residual is not computed. There are at least two: where
	// slivers have nearly all of the residual, one may reach the target and leave a vertex between
	// soft triangles far from its place.
	double fall = 0.1;
	FloatQuad alpha; // the step along p, not added to y yet
	constexpr int maxIterations = 200;
	for (int iteration = 0;; ++iteration) {
		progress.report(0.5 + 0.5 * iteration / maxIterations, "Contracting");
		alpha = quotient(rz, apply());
		if (fall * rz.sum() <= target || iteration + 1 == maxIterations)
			break;
		for (int i = 0; i < n; ++i)
			z[i] = r[i] -= alpha * Ap[i];
		const Sum rzNew = precondition();
		if (iteration > 0 && !(rzNew.sum() > target))
			break;
		if (iteration > 0)
			fall = std::max(fall, rzNew.sum() / rz.sum());
		const FloatQuad beta = quotient(rzNew, rz);
		for (int i = 0; i < n; ++i) {
			y[i] += alpha * p[i];
			p[i] = z[i] + beta * p[i];
		}
		rz = rzNew;
	}
	for (int i = 0; i < n; ++i) {
		const FloatQuad last = y[i] + alpha * p[i];
		x[i] = Point3d(last[0], last[1], last[2]) * largest;
	}
	return x;
}

} // namespace vcg::tri::mcf

#endif
