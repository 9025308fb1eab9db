// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The loop of Fig. 4: one step of the contraction, and all steps until it has converged.

#ifndef VCG_MCF_FLOW_H
#define VCG_MCF_FLOW_H

#include "contraction.h"
#include "degeneracy.h"
#include "local_remeshing.h"
#include "sheet_marks.h"
#include "stage.h"
#include "stage_frames.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/mesh/components_at_rest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Every so many iterations a stage is renumbered breadth first, so that neighbours are near each
/// other in memory and in the elimination order. surfaceForFlow() numbers stage 0 in the same way.
constexpr int renumberEvery = 4;

/// The change of a component's area in a step, as a part of its initial area, below which the step
/// counts as settled. A few triangles with edges of about epsilon may oscillate forever; their area
/// grows with the square of epsilon.
inline double settledArea(double epsilon)
{
	constexpr double usual = 1e-4, largest = 1e-3;
	const double edges = epsilon / Parameters().epsilon;
	return std::clamp(usual * edges * edges, usual, largest);
}

/// The work of step(), on a stage that has entered its frames.
inline void stepInFrames(
	Stage& stage, const StageFrames& frames, const Parameters& parameters, const Progress& progress)
{
	SurfaceMesh& mesh = stage.mesh;
	const int before = mesh.vertexSlots();
	const Progress cancel = progress.cancelOnly();
	contract(stage, parameters, progress.part(0, 0.8));
	cancellableLoop(before, cancel, [&](int v) {
		if (!stage.fixed[v])
			mesh.position[v] = PrincipalFrame::rounded(mesh.position[v]);
	});
	MergeForest forest(mesh.vertexSlots());
	const std::vector<int> candidates =
		collapseShortEdges(stage, parameters.epsilon, forest, progress.part(0.8, 0.9));
	splitWideAngles(stage, parameters, forest, progress.part(0.9, 1));
	fixDegenerateVertices(stage, candidates, parameters.epsilon, progress);
	fixArrivedSheets(stage, parameters.epsilon);

	// Merged and new vertices are between grid points; so are the poles of new ones.
	const auto toGrid = [&](int v) {
		if (!stage.held[v])
			mesh.position[v] = PrincipalFrame::rounded(mesh.position[v]);
	};
	std::vector<int> mergedInto;
	mergedInto.reserve(size_t(before));
	cancellableLoop(before, cancel, [&](int v) {
		mergedInto.push_back(forest.find(v));
		if (mergedInto[v] != v)
			toGrid(mergedInto[v]);
	});
	for (int v = before; v < mesh.vertexSlots(); ++v) {
		toGrid(v);
		stage.pole[v] = PrincipalFrame::rounded(stage.pole[v]);
	}
	const std::vector<int> newVertex = (stage.iteration + 1) % renumberEvery == 0
		? renumberBreadthFirst(mesh, cancel)
		: mesh.compact(cancel);
	cancellableLoop(int(stage.node.size()), cancel,
		[&](int s) { stage.node[s] = newVertex[mergedInto[stage.node[s]]]; });
	stage.renumber(newVertex, mesh.vertexSlots(), cancel);

	const Extent extent = frames.extent(stage, cancel);
	const double settled = settledArea(parameters.epsilon);
	stage.converged = true;
	for (size_t c = 0; c < extent.area.size(); ++c)
		stage.converged &=
			std::abs(extent.area[c] - stage.area[c]) < settled * stage.initialArea[c];
	stage.area = extent.area;
	stage.volume = extent.volume;
	stage.converged &= (stage.volumeFraction() < 0.05 && stage.areaFraction() < 0.5)
		|| stage.fixedFraction() > 0.5 || stage.heldCount() > 0;
	stage.iteration = std::min(stage.iteration + 1, Stage::maxIteration);
	stage.epsilon = parameters.epsilon;
}

} // namespace detail

/**
 * One iteration of the loop of Fig. 4: weights and contraction, then connectivity, then degeneracy.
 *
 * Convergence: in every component the area changed by less than 1e-4 of that of its surface (up to
 * 1e-3 where epsilon is above the default), and one of these holds:
 *  - Less than 5 % of the volume (in the end it is some 1e-5) and half of the area are left: where
 *    the walls of a box have passed each other, the volume is gone, and the area may stand still
 *    for a step.
 *  - More than half of the vertices are fixed: a body thinner than epsilon keeps its volume, a
 *    sheet its area.
 *  - Vertices are held: they may hold any volume open.
 * Without these conditions a flow that a large w_H makes slow would count as converged. A converged
 * stage is returned unchanged.
 *
 * The flow works in the shape's own coordinates, see StageFrames.
 * @return the next stage.
 * @throws SolverError, InvalidParameter, Cancelled.
 */
inline Stage step(Stage stage, const Parameters& given, const Progress& progress = Progress())
{
	given.check();
	const Parameters parameters = sharedAmong(given, stage.diagonal);
	if (stage.converged)
		return stage;
	const Progress cancel = progress.cancelOnly();
	StageFrames frames(stage, cancel);
	frames.enter(stage, cancel);
	detail::stepInFrames(stage, frames, parameters, progress);
	frames.leave(stage, cancel);
	stage.mesh.trim();
	return stage;
}

/// Whether the flow ends: it has converged, has made parameters.maxIterations, or spreads the
/// surface, see Stage::isSpread().
inline bool isOver(const Stage& stage, const Parameters& parameters)
{
	return stage.isDone() || stage.iteration >= parameters.maxIterations;
}

/// Callbacks invoked during the contraction. Unset ones cost nothing.
struct StageObserver
{
	/// Called with a copy of every `every`-th stage, as step() would make it; may be empty.
	std::function<void(Stage)> onStage;
	/// Iterations from one call of onStage to the next, >= 1.
	int every = 1;
	/// Called with the figures of each new stage; may be empty.
	std::function<void(const StageFigures&)> onFigures = {};
};

/**
 * Repeats step() until isOver(), with the same result bit for bit.
 * @throws as step().
 */
inline Stage contractToSkeleton(Stage stage, const Parameters& given,
	const Progress& progress = Progress(), const StageObserver& observer = StageObserver())
{
	given.check();
	const Parameters parameters = sharedAmong(given, stage.diagonal);
	progress.report(0, "Contracting");
	const Progress cancel = progress.cancelOnly();
	StageFrames frames(stage, cancel); // needs stage.node, which is moved next
	// The map from surface to stage is composed lazily: stage.node tracks the vertices of a
	// checkpoint stage, a new checkpoint is taken when half of them have merged, and ofSurface,
	// ofFirst and stage.node are composed on request.
	const std::vector<int> ofSurface = std::move(stage.node);
	std::vector<int> ofFirst = detail::numberedArray(size_t(stage.mesh.vertexSlots()), cancel);
	stage.node = detail::copiedArray(ofFirst, cancel);
	const auto goesOn = [&] { return !isOver(stage, parameters); };
	// The places of held vertices outside do not follow from those inside: each step enters anew.
	const bool staysInside = stage.heldCount() == 0 && goesOn();
	if (staysInside)
		frames.enter(stage, cancel);
	const auto outside = [&](Stage inside, const Progress& part) {
		if (staysInside)
			frames.leave(inside, part.cancelOnly());
		std::vector<int> node;
		node.reserve(ofSurface.size());
		detail::reportedLoop(int(ofSurface.size()), part, "Contracting",
			[&](int s) { node.push_back(inside.node[ofFirst[ofSurface[s]]]); });
		inside.node = std::move(node);
		return inside;
	};
	double done = 0;
	while (goesOn()) {
		// The number of iterations is unknown: each takes a tenth of what is left of the bar.
		const double next = done + 0.1 * (1 - done);
		const Progress part = progress.part(done, next);
		if (staysInside)
			detail::stepInFrames(stage, frames, parameters, part);
		else
			stage = step(std::move(stage), parameters, part);
		done = next;
		if (observer.onFigures)
			observer.onFigures(figuresOf(stage));
		if (observer.onStage && stage.iteration % observer.every == 0)
			observer.onStage(outside(stage, part.cancelOnly()));
		if (2 * size_t(stage.mesh.vertexSlots()) < stage.node.size()) {
			for (int& node : ofFirst)
				node = stage.node[node];
			stage.node.resize(stage.mesh.vertexSlots());
			std::iota(stage.node.begin(), stage.node.end(), 0);
		}
	}
	Stage result = outside(std::move(stage), progress.cancelOnly());
	progress.report(1, "Contracting");
	return result;
}

} // namespace vcg::tri::mcf

#endif
