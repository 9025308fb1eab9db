// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file One implicit step of the constrained mean curvature flow (Sec. 4.2, 4.4, 4.5; Eq. 6).

#ifndef VCG_MCF_CONTRACTION_H
#define VCG_MCF_CONTRACTION_H

#include "biharmonic_solver.h"
#include "cotangent_laplacian.h"
#include "elimination_order.h"
#include "parameters.h"
#include "progress.h"
#include "stage.h"

#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The paper's weights belong to another normalisation of L than the dimensionless cotangents used
 * here: its (w_L, w_H, w_M) = (1, 20, 40) is (1, 0.1, 0.2) for them.
 */
constexpr double publishedWeightUnit = 1.0 / 200;

/// The medial weight, squared, of vertices that are to become sheets: strong enough to bring both walls
/// together before the smoothing has pulled the rim in.
constexpr double sheetWeight2 = 4;

/**
 * Moves the free vertices of a stage to the minimum of
 *
 *   |w_L L v|^2 + w_H^2 sum_i |v_i - v_i^t|^2 + w_M^2 sum_i |v_i - mu(v_i)|^2      (Eq. 6)
 *
 * Fixed vertices are known values, not unknowns with a large weight; the Laplacian rows are those
 * of the free vertices. The medial term is left out for a vertex without a pole and where the pole
 * lies outwards, (mu(v) - v) . n > 0: there the flow has passed the medial axis, and the term would
 * blow the surface up again. Vertices of sheets (Stage::sheet) have a weight of their own and keep it.
 *
 * Weights are squared (Eq. 5 does, Eq. 6 does not; the published values belong to the square).
 * @pre stage.mesh is compact.
 * @throws SolverError if the system breaks down or a position stops being finite; Cancelled.
 * Complexity: that of one sparse factorisation, about O(V log V) on a surface mesh.
 */
inline void contract(
	Stage& stage, const Parameters& parameters, const Progress& progress = Progress())
{
	SurfaceMesh& mesh = stage.mesh;
	const double wL = parameters.wL;
	const double wH2 = std::pow(parameters.wH * publishedWeightUnit, 2);
	const double wM2 = std::pow(parameters.wM * publishedWeightUnit, 2);

	progress.report(0, "Contracting");
	const std::vector<int> vertexOfUnknown = eliminationOrder(stage);
	const int n = int(vertexOfUnknown.size());
	std::vector<int> unknown(mesh.vertexSlots(), -1);
	for (int i = 0; i < n; ++i)
		unknown[vertexOfUnknown[i]] = i;
	progress.report(0, "Contracting");
	// Of triangles that can still move: the cotangents, and the area-weighted normals of the vertices.
	std::vector<double> cotangent(mesh.halfEdgeSlots());
	std::vector<Point3d> normal(mesh.vertexSlots(), Point3d(0, 0, 0));
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const Triangle t = mesh.triangle(f);
		if (stage.fixed[t[0]] && stage.fixed[t[1]] && stage.fixed[t[2]])
			continue;
		const TriangleMeasures measures = measureTriangle(mesh, f);
		for (int k = 0; k < 3; ++k) {
			cotangent[3 * f + k] = measures.cotangent[k];
			normal[t[k]] += measures.areaVector;
		}
	}
	progress.report(0.1, "Contracting");

	// w_L L restricted to the unknowns is M; what the fixed neighbours add is the known part g.
	// Positions are taken relative to the middle: far from the origin, no digits are lost.
	const Point3d middle = mesh.bounds().Center();
	SymmetricRows M;
	M.diagonal.resize(n);
	M.start.resize(n + 1);
	M.column.resize(mesh.halfEdgeSlots());
	M.value.resize(mesh.halfEdgeSlots());
	int entries = 0;
	std::vector<double> D(n);
	std::vector<Point3d> known(n), x(n), b(n);
	for (int i = 0; i < n; ++i) {
		const int v = vertexOfUnknown[i];
		double sum = 0;
		known[i] = Point3d(0, 0, 0);
		mesh.forEachOutgoing(v, [&](int h) {
			const double w = wL * cotangentWeight(cotangent[h], cotangent[mesh.twin(h)]);
			const int j = mesh.target(h);
			sum += w;
			if (unknown[j] >= 0) {
				M.column[entries] = unknown[j];
				M.value[entries++] = -w;
			}
			else
				known[i] -= (mesh.position[j] - middle) * w;
		});
		M.diagonal[i] = sum;
		M.start[i + 1] = entries;
		const Point3d& p = mesh.position[v];
		x[i] = p - middle;
		D[i] = wH2;
		b[i] = x[i] * wH2;
		const bool sheet = stage.sheet[v];
		if (stage.poleRadius[v] >= 0 && (sheet || (stage.pole[v] - p) * normal[v] <= 0)) {
			const double weight2 = sheet ? sheetWeight2 : wM2;
			D[i] += weight2;
			b[i] += (stage.pole[v] - middle) * weight2;
		}
	}
	// (M^2 + D) x = w_H^2 v + w_M^2 mu - M g
	std::vector<Point3d> Mg(n);
	M.multiply(known, Mg);
	for (int i = 0; i < n; ++i)
		b[i] -= Mg[i];
	constexpr double tolerance = 1e-2;
	progress.report(0.2, "Contracting");
	solveBiharmonic(M, D, b, x, tolerance, progress.part(0.2, 1));
	for (int i = 0; i < n; ++i) {
		const Point3d p = x[i] + middle;
		if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
			throw SolverError("The contraction left the range of numbers: the mesh has degenerate "
							  "triangles. Resample it first.");
		mesh.position[vertexOfUnknown[i]] = p;
	}
	progress.report(1, "Contracting");
}

} // namespace vcg::tri::mcf

#endif
