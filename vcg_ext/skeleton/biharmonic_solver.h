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
 * @param tolerance the residual, in the preconditioner's norm, falls below this fraction of its
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

	FloatQuads work(n);
	const auto precondition = [&](const std::vector<Point3d>& r, std::vector<Point3d>& z) {
		for (int i = 0; i < n; ++i)
			work[i] = FloatQuad(float(r[i][0]), float(r[i][1]), float(r[i][2]), 0.f);
		factor.solve(work);
		factor.solve(work);
		for (int i = 0; i < n; ++i)
			z[i] = Point3d(work[i][0], work[i][1], work[i][2]);
	};
	std::vector<Point3d> scratch(n), Ap(n), r(n), z(n), p(n);
	const auto apply = [&](const std::vector<Point3d>& in, std::vector<Point3d>& out) {
		M.multiply(in, scratch);
		M.multiply(scratch, out);
		for (int i = 0; i < n; ++i)
			out[i] += in[i] * D[i];
	};
	const auto dot = [&](const std::vector<Point3d>& u, const std::vector<Point3d>& v) {
		Point3d sum(0, 0, 0);
		for (int i = 0; i < n; ++i)
			for (int k = 0; k < 3; ++k)
				sum[k] += u[i][k] * v[i][k];
		return sum;
	};
	const auto quotient = [](const Point3d& u, const Point3d& v) {
		Point3d q;
		for (int k = 0; k < 3; ++k)
			q[k] = v[k] != 0 ? u[k] / v[k] : 0;
		return q;
	};

	apply(x, Ap);
	// Single precision has no room for meshes of 1e-20 or 1e20 units: residuals are scaled to one.
	double largest = 0;
	for (int i = 0; i < n; ++i) {
		r[i] = b[i] - Ap[i];
		for (int k = 0; k < 3; ++k)
			largest = std::max(largest, std::abs(r[i][k]));
	}
	if (largest == 0)
		return;
	for (Point3d& v : r)
		v /= largest;
	precondition(r, z);
	p = z;
	Point3d rz = dot(r, z);
	const double target = tolerance * tolerance * (rz[0] + rz[1] + rz[2]);
	constexpr int mostIterations = 200;
	for (int iteration = 0; iteration < mostIterations; ++iteration) {
		progress.report(0.5 + 0.5 * iteration / mostIterations, "Contracting");
		apply(p, Ap);
		const Point3d alpha = quotient(rz, dot(p, Ap));
		for (int i = 0; i < n; ++i)
			for (int k = 0; k < 3; ++k) {
				x[i][k] += largest * alpha[k] * p[i][k];
				r[i][k] -= alpha[k] * Ap[i][k];
			}
		precondition(r, z);
		const Point3d rzNew = dot(r, z);
		if (!(rzNew[0] + rzNew[1] + rzNew[2] > target))
			break;
		const Point3d beta = quotient(rzNew, rz);
		for (int i = 0; i < n; ++i)
			for (int k = 0; k < 3; ++k)
				p[i][k] = z[i][k] + beta[k] * p[i][k];
		rz = rzNew;
	}
}

} // namespace vcg::tri::mcf

#endif
