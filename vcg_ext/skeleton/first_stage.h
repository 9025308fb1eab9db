// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file From a surface to the stage that the flow starts from: coarsening, poles, numbering.

#ifndef VCG_MCF_FIRST_STAGE_H
#define VCG_MCF_FIRST_STAGE_H

#include "breadth_first_order.h"
#include "measured_surface.h"
#include "parameters.h"
#include "poles.h"
#include "progress.h"
#include "stage.h"
#include "staged_coarsening.h"
#include "ticker.h"

#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Edges up to this many epsilon are merged before the flow starts. The flow would collapse them in
 * its first iterations, at many times the cost; three epsilon lose the tips of fingers.
 */
constexpr double coarseningOfEpsilon = 2;

/**
 * The surface as the flow starts on it: without edges far below epsilon, on which time would go
 * that changes nothing.
 *
 * The vertices of `mesh` are a subset of the surface's, where they were, in breadth-first order:
 * neighbours in the mesh are neighbours in memory.
 */
struct CoarsenedSurface
{
	SurfaceMesh mesh;
	/// For each vertex of `mesh` the surface's vertex that it is.
	std::vector<int> survivor;
	/// For each vertex of the surface the vertex of `mesh` that it has merged into.
	std::vector<int> node;
	/// Connected component of each vertex of `mesh`, in the order of connectedComponents().
	std::vector<int> component;
	/// Diagonal, see MeasuredSurface, and area of each component of the surface.
	std::vector<double> diagonal, area;
};

/**
 * Merges edges shorter than two epsilon: see coarsen().
 * @param surface  compact, closed.
 * @param epsilon  as in Parameters, of the diagonal of each component.
 * @throws Cancelled. Complexity: O(V + F).
 */
inline CoarsenedSurface coarsenedForFlow(
	const SurfaceMesh& surface, double epsilon, const Progress& progress = Progress())
{
	CoarsenedSurface result;
	Numbering number = breadthFirstOrder(surface, {}, progress.part(0, 0.1));
	SurfaceMesh& mesh = result.mesh;
	mesh = surface.renumbered(number.vertex, number.face, {}, progress.part(0.1, 0.2));
	{
		const MeasuredSurface measured(mesh, progress.part(0.2, 0.3));
		result.diagonal = measured.diagonals();
		result.area = measured.areas();
	}
	std::vector<double> length;
	for (double diagonal : result.diagonal)
		length.push_back(coarseningOfEpsilon * epsilon * diagonal);
	std::vector<int> mergedInto = coarsen(
		mesh, [&](int v) { return length[number.component[v]]; }, progress.part(0.3, 0.9));
	const std::vector<int> place = mesh.compact();
	result.component = renumbered(number.component, place, mesh.vertexSlots());
	result.survivor.resize(mesh.vertexSlots());
	result.node.resize(surface.vertexSlots());
	detail::reportedLoop(
		surface.vertexSlots(), progress.part(0.9, 1), "Ordering the surface", [&](int v) {
			const int ordered = number.vertex[v];
			result.node[v] = place[mergedInto[ordered]];
			if (place[ordered] >= 0)
				result.survivor[place[ordered]] = v;
		});
	return result;
}

/**
 * Stage 0: the coarsened surface with its poles.
 *
 * Lengths, areas and volumes are measured on the surface itself, and its vertices keep their
 * correspondence. Poles are found for the vertices that remain, against all vertices of the surface.
 *
 * @param surface    compact, closed; see checkedSurface().
 * @param parameters epsilon and poleMethod are used.
 * @param poles      of all vertices of the surface where they are known already; null: they are
 *                   computed.
 * @throws SolverError, Cancelled, InvalidParameter. Complexity: O(V log V), dominated by the poles.
 */
inline Stage firstStage(const SurfaceMesh& surface, const Parameters& parameters,
	const PoleSet* poles = nullptr, const Progress& progress = Progress())
{
	parameters.check();
	const double polesFrom = poles ? 1 : 0.3;
	CoarsenedSurface coarse =
		coarsenedForFlow(surface, parameters.epsilon, progress.part(0, polesFrom));
	Stage stage;
	const size_t count = coarse.survivor.size();
	const auto take = [&](const PoleSet& from, auto&& placeOf) {
		stage.pole.resize(count);
		stage.poleRadius.resize(count);
		for (size_t v = 0; v < count; ++v) {
			stage.pole[v] = from.centre[placeOf(v)];
			stage.poleRadius[v] = from.radius[placeOf(v)];
		}
	};
	if (poles)
		take(*poles, [&](size_t v) { return coarse.survivor[v]; });
	else
		take(polesAt(surface, coarse.survivor, parameters.poleMethod, progress.part(polesFrom, 1)),
			[](size_t v) { return v; });
	stage.fixed.assign(count, 0);
	stage.held.assign(count, 0);
	stage.sheet.assign(count, 0);
	stage.component = std::move(coarse.component);
	stage.diagonal = std::move(coarse.diagonal);
	stage.initialArea = std::move(coarse.area);
	const auto report = [&] { progress.report(1, "Ordering the surface"); };
	report();
	stage.initialVolume = surface.volume();
	report();
	stage.surface = std::make_shared<const std::vector<Point3d>>(surface.position);
	stage.mesh = std::move(coarse.mesh);
	stage.node = std::move(coarse.node);
	stage.area = componentAreas(stage.mesh, stage.component, stage.diagonal.size());
	stage.volume = stage.mesh.volume();
	return stage;
}

} // namespace vcg::tri::mcf

#endif
