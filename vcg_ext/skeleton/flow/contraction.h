// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief One implicit step of the constrained mean curvature flow (Sec. 4.2, 4.4, 4.5; Eq. 6).

#ifndef VCG_MCF_CONTRACTION_H
#define VCG_MCF_CONTRACTION_H

#include "flow_system.h"
#include "stage.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/solver/biharmonic_cholesky.h>
#include <skeleton/solver/biharmonic_pcg.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Relative tolerance of the linear solver: 1e-2 suffices for the default weights. The larger w_L
/// is beside the other weights, the smaller is the share of smooth moves in the energy, so that
/// they converge last.
inline double solverTolerance(const Parameters& parameters)
{
	const auto stiffness = [](const Parameters& p) {
		return p.cotangentFactor * p.wL / std::hypot(p.wH, p.wM);
	};
	return 1e-2 * std::min(1.0, stiffness(Parameters()) / stiffness(parameters));
}

} // namespace detail

/**
 * Moves the free vertices of a stage to the minimum of
 *
 *   |w_L L v|^2 + w_H^2 sum_i |v_i - v_i^t|^2 + w_M^2 sum_i |v_i - mu(v_i)|^2      (Eq. 6)
 *
 * Fixed vertices are known values, not unknowns with a large weight; the Laplacian rows are those
 * of the free vertices. The medial term is left out for a vertex without a pole and, with
 * parameters.dropOutwardPoles, where the pole lies outwards, (mu(v) - v) . n > 0: there the flow
 * has passed the medial axis, and the term would blow the surface up again. Vertices of sheets
 * (Stage::sheet) always have the term, with the weight sheetWeight2.
 *
 * Weights are squared, as in Eq. 5; Eq. 6 has no squares, but the published values belong to them.
 *
 * Connected components are independent linear systems, solved in parallel. The result for a
 * component is bitwise identical to solving it alone.
 * @pre stage.mesh is compact.
 * @throws SolverError if the system breaks down or a position stops being finite; Cancelled. Then
 *         the stage is unspecified and must be discarded.
 * Complexity: that of one sparse factorisation, about O(V log V) on a surface mesh.
 */
inline void contract(
	Stage& stage, const Parameters& parameters, const Progress& progress = Progress())
{
	SurfaceMesh& mesh = stage.mesh;
	const FlowSystem all = flowSystem(stage, parameters, progress.part(0, 0.2));
	const auto solve = [&](const FlowSystem& system, const Progress& part) {
		const std::vector<Point3d> move = parameters.directSolver
			? solveBiharmonicDirectly(system.M, system.D, system.b, part)
			: solveBiharmonic(
				system.M, system.D, system.b, detail::solverTolerance(parameters), part);
		for (size_t i = 0; i < move.size(); ++i) {
			const Point3d p = mesh.position[system.vertex[i]] + move[i];
			if (!isFinitePlace(p))
				throw SolverError(
					"The contraction left the range of numbers: the mesh has degenerate "
					"triangles. Resample it first.");
			mesh.position[system.vertex[i]] = p;
		}
	};
	std::vector<int> start = {0};
	const int n = int(all.vertex.size());
	for (int i = 1; i < n; ++i)
		if (stage.component[all.vertex[i]] != stage.component[all.vertex[i - 1]])
			start.push_back(i);
	start.push_back(n);
	const Progress solving = progress.part(0.2, 1);
	if (start.size() == 2)
		solve(all, solving);
	else
		forEachPart(start, solving, "Contracting",
			[&](int begin, int end, const Progress& part) { solve(all.part(begin, end), part); });
	progress.report(1, "Contracting");
}

} // namespace vcg::tri::mcf

#endif
