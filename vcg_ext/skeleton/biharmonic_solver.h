// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The linear solver of the flow: (M^2 + D) x = b for a Laplacian-like M and a diagonal D.

#ifndef VCG_MCF_BIHARMONIC_SOLVER_H
#define VCG_MCF_BIHARMONIC_SOLVER_H

#include "cotangent_laplacian.h"
#include "errors.h"
#include "incomplete_factor.h"
#include "progress.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// sums <- sums + u v, each coordinate by itself.
inline void addProducts(Point3d& sums, const Point3d& u, const Point3d& v)
{
	for (int k = 0; k < 3; ++k)
		sums[k] += u[k] * v[k];
}

} // namespace detail

/**
 * Solves (M^2 + D) x = b by conjugate gradients, preconditioned by (M + sqrt D)^-2.
 *
 * M^2 is never formed: its factor would be several times as full as that of M + sqrt D, which is
 * as close to it in spectrum (the quotient lies in [1/2, 1] for commuting M and D), so that a
 * handful of iterations does. The factor is incomplete and in single precision; residuals are
 * double.
 *
 * @param M     symmetric, positive semi-definite, n by n, numbered in an order of low fill.
 * @param D     positive, n.
 * @param b     right-hand sides, n by 3.
 * @param x     in: the start; out: the solution, n by 3.
 * @param tolerance the residual, in the preconditioner's norm, falls to about this fraction of its
 *              value at the start.
 * @throws SolverError if the factorisation breaks down; Cancelled.
 */
inline void solveBiharmonic(const SymmetricRows& M, const std::vector<double>& D,
	const std::vector<Point3d>& b, std::vector<Point3d>& x, double tolerance,
	const Progress& progress = Progress())
{
	const int n = M.size();
	if (n == 0)
		return;
	constexpr float dropTolerance = 1e-3f;
	std::vector<double> rootD(n);
	for (int i = 0; i < n; ++i)
		rootD[i] = std::sqrt(D[i]);
	const IncompleteFactor factor(M, rootD, dropTolerance, progress.part(0, 0.5));
	progress.report(0.5, "Contracting");

	FloatQuads z(n); // the preconditioned residual
	std::vector<Point3d> Mp(n), Ap(n), r(n), p(n);
	/// Ap <- (M^2 + D) in; the product of each column with `in`.
	const auto apply = [&](const std::vector<Point3d>& in) {
		M.multiply(in, Mp);
		Point3d product(0, 0, 0);
		M.forEachProduct(Mp, [&](int i, const Point3d& sum) {
			Ap[i] = sum + in[i] * D[i];
			detail::addProducts(product, in[i], Ap[i]);
		});
		return product;
	};
	/// z <- preconditioned r, from its copy in single precision; r . z.
	const auto precondition = [&] {
		factor.solve(z);
		factor.solve(z);
		Point3d product(0, 0, 0);
		for (int i = 0; i < n; ++i)
			detail::addProducts(product, r[i], Point3d(z[i][0], z[i][1], z[i][2]));
		return product;
	};
	const auto total = [](const Point3d& u) { return u[0] + u[1] + u[2]; };
	const auto quotient = [](const Point3d& u, const Point3d& v) {
		Point3d q;
		for (int k = 0; k < 3; ++k)
			q[k] = v[k] != 0 ? u[k] / v[k] : 0;
		return q;
	};

	apply(x);
	// Single precision has no room for meshes of 1e-20 or 1e20 units: residuals are scaled to one.
	double largest = 0;
	for (int i = 0; i < n; ++i) {
		r[i] = b[i] - Ap[i];
		for (int k = 0; k < 3; ++k)
			largest = std::max(largest, std::abs(r[i][k]));
	}
	if (largest == 0)
		return;
	for (int i = 0; i < n; ++i) {
		r[i] /= largest;
		z[i] = FloatQuad(float(r[i][0]), float(r[i][1]), float(r[i][2]), 0.f);
	}
	Point3d rz = precondition();
	for (int i = 0; i < n; ++i)
		p[i] = Point3d(z[i][0], z[i][1], z[i][2]);
	const double target = tolerance * tolerance * total(rz);
	// r . z falls to a tenth in each iteration but the first, where it falls further. An iteration that
	// reaches the target so is the last one, and what is left is not measured.
	double fall = 0.1;
	constexpr int mostIterations = 200;
	for (int iteration = 0; iteration < mostIterations; ++iteration) {
		progress.report(0.5 + 0.5 * iteration / mostIterations, "Contracting");
		const Point3d alpha = quotient(rz, apply(p));
		for (int i = 0; i < n; ++i) {
			for (int k = 0; k < 3; ++k) {
				x[i][k] += largest * alpha[k] * p[i][k];
				r[i][k] -= alpha[k] * Ap[i][k];
			}
			z[i] = FloatQuad(float(r[i][0]), float(r[i][1]), float(r[i][2]), 0.f);
		}
		if (fall * total(rz) <= target)
			break;
		const Point3d rzNew = precondition();
		if (!(total(rzNew) > target))
			break;
		if (iteration > 0)
			fall = std::max(fall, total(rzNew) / total(rz));
		const Point3d beta = quotient(rzNew, rz);
		for (int i = 0; i < n; ++i)
			for (int k = 0; k < 3; ++k)
				p[i][k] = z[i][k] + beta[k] * p[i][k];
		rz = rzNew;
	}
}

} // namespace vcg::tri::mcf

#endif
