// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief From a surface to the stage that the flow starts from: edge lengths, poles, numbering.

#ifndef VCG_MCF_FIRST_STAGE_H
#define VCG_MCF_FIRST_STAGE_H

#include "halved_edges.h"
#include "stage.h"

#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/components_at_rest.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/poles/poles.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/resample/progressive_coarsening.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Edges up to this many epsilon are merged before the flow starts. The flow would collapse them in
 * its first iterations, at many times the cost; with three epsilon the tips of fingers are lost.
 */
constexpr double coarseningOfEpsilon = 2;

/**
 * The surface on which the flow starts: without edges far below epsilon, which would take time and
 * change nothing, and without edges that are too long for the flow.
 *
 * The vertices of `mesh` are a subset of the surface's, in their places, and of the middles of its
 * long edges, in breadth-first order: neighbours in the mesh are neighbours in memory.
 */
struct FlowSurface
{
	SurfaceMesh mesh;
	/// For each vertex of `mesh` the same vertex of the surface, -1 for the middle of an edge.
	std::vector<int> survivor;
	/// The surface with its long edges halved, see withHalvedEdges(), in an order that depends on
	/// the places of its vertices only; nothing if no edge is too long.
	std::optional<SurfaceMesh> finer;
	/// For each vertex of `mesh` the same vertex of `finer`; empty without `finer`.
	std::vector<int> inFiner;
	/// For each vertex of the surface the vertex of `mesh` that it has merged into.
	std::vector<int> node;
	/// Connected component of each vertex of `mesh`, in the order of connectedComponents().
	std::vector<int> component;
	/// Diagonal, see MeasuredSurface, and area of each component of the surface.
	std::vector<double> diagonal, area;
	/// 1 for the components that rest, see componentsAtRest().
	std::vector<char> rests;
	/// As Stage::epsilonLimit, for each vertex of `mesh`.
	std::vector<double> epsilonLimit;
};

/// About the number of pieces into which the flow would cut the edges that are longer than
/// epsilonOfField of the field. @throws Cancelled. Complexity: O(E).
inline double cutsByField(
	const SurfaceMesh& mesh, const SizingField& field, const Cancellation& cancel)
{
	double cuts = 0;
	detail::cancellableLoop(mesh.halfEdgeSlots(), cancel, [&](int h) {
		if (!mesh.isEdge(h))
			return;
		const double length =
			epsilonOfField * std::min(field[mesh.origin(h)], field[mesh.target(h)]);
		if (const double squared = mesh.squaredLength(h); squared > length * length)
			cuts += std::sqrt(squared) / length;
	});
	return cuts;
}

/// The bound of the sizing field below which epsilon follows it, for each component.
inline std::vector<double> boundOfEpsilon(
	const MeasuredSurface& surface, const Parameters& parameters)
{
	std::vector<double> bound;
	for (double diagonal : surface.diagonals())
		bound.push_back(parameters.epsilon / epsilonOfField * diagonal);
	return bound;
}

/**
 * Stage::epsilonLimit for each vertex of a surface: epsilonOfField of the sizing field, at most
 * Parameters::maxEpsilon. Where edges are much longer than the shape is thick, as on a needle, the
 * shape does not change from one thickness to the next: the field is raised until cutsByField() is
 * at most thirty times the number of vertices.
 * @param poles of all vertices.
 * @param known see boundedField().
 * @return empty if epsilon is small enough everywhere, or without parameters.adaptive.
 * @throws Cancelled. Complexity: as sizingField().
 */
inline std::vector<double> epsilonLimits(const MeasuredSurface& surface, const PoleSet& poles,
	const Parameters& parameters, const Progress& progress = Progress(),
	const BoundedField* known = nullptr)
{
	std::vector<double> limits;
	if (!parameters.adaptive)
		return limits;
	BoundedField bounded = boundedField(surface, poles, parameters.relativeLength,
		boundOfEpsilon(surface, parameters), known, progress);
	SizingField& field = bounded.length;
	constexpr double cutsOfVertex = 30;
	const double maximum = cutsOfVertex * surface.mesh().vertexCount();
	const auto cuts = [&](const SizingField& raised) {
		return cutsByField(surface.mesh(), raised, progress);
	};
	if (!field.empty() && cuts(field) > maximum)
		raiseToCost(
			field, *std::max_element(bounded.bound.begin(), bounded.bound.end()), maximum, cuts);
	limits.reserve(field.size());
	detail::cancellableLoop(int(field.size()), progress, [&](int v) {
		limits.push_back(
			std::clamp(epsilonOfField * field[v] / surface.diagonal(surface.component()[v]),
				Stage::minEpsilonLimit, Parameters::maxEpsilon));
	});
	return limits;
}

/**
 * Merges edges shorter than two epsilon, see coarsen(), and halves those of coarse components that
 * are too long, see coarseComponents().
 * @param given    the surface; compact, closed.
 * @param epsilon  as in Parameters, of the diagonal of each component.
 * @param poles    of all vertices of the surface.
 * @param epsilonLimit upper bound of epsilon at each vertex, see epsilonLimits(); may be empty.
 * @throws Cancelled. Complexity: O(V + F), and O(s log s) for s halved edges.
 */
inline FlowSurface surfaceForFlow(const MeasuredSurface& given, double epsilon,
	const PoleSet& poles, const Progress& progress = Progress(),
	const std::vector<double>& epsilonLimit = {})
{
	FlowSurface result;
	// Orders are those of the surface in its frames, so that mirror images are treated alike.
	const std::vector<PrincipalFrame>& frames = given.allFrames();
	std::optional<SurfaceMesh> turnedOver;
	{
		const Progress begin = progress.cancelOnly();
		result.rests = componentsAtRest(given, begin);
		for (const PrincipalFrame& frame : frames)
			if (frame.isMirrored() && !turnedOver) {
				turnedOver = given.mesh().copied(begin);
				turnOverMirrored(*turnedOver, given.component(), frames, begin);
			}
	}
	const SurfaceMesh& surface = turnedOver ? *turnedOver : given.mesh();
	Numbering number = breadthFirstOrder(surface, {}, progress.part(0, 0.1));
	SurfaceMesh& mesh = result.mesh;
	mesh = surface.renumbered(number.vertex, number.face, {}, progress.part(0.1, 0.2));
	const auto isAny = [](const std::vector<char>& coarse) {
		return std::find(coarse.begin(), coarse.end(), 1) != coarse.end();
	};
	const auto moving = [&](std::vector<char> components) {
		for (size_t c = 0; c < components.size(); ++c)
			components[c] &= !result.rests[c];
		return components;
	};
	bool mayBeCoarse = false;
	{
		const MeasuredSurface measured(
			mesh, number.component, number.components, progress.part(0.2, 0.3));
		result.diagonal = measured.diagonals();
		result.area = measured.areas();
		mayBeCoarse = isAny(moving(coarseComponents(measured, epsilon, {}, progress.cancelOnly())));
	}
	if (mayBeCoarse) {
		const Progress part = progress.cancelOnly();
		const MeasuredSurface measured(surface, part);
		const std::vector<char> coarse =
			moving(coarseComponents(measured, epsilon, poles.radius, part));
		if (isAny(coarse)) {
			const SurfaceMesh halved =
				withHalvedEdges(measured, longestEdgesForFlow(measured, coarse, epsilon), part);
			const std::vector<int> component = connectedComponents(halved, nullptr, part);
			const auto placeOf = [&](int v) {
				return measured.frame(component[v]).onGrid(halved.position[v]);
			};
			number = breadthFirstOrder(halved,
				minHalfEdges(halved, component, measured.components(), placeOf, part), part);
			mesh = halved.renumbered(number.vertex, number.face, number.firstCorner, part);
			result.finer = mesh.copied(part);
		}
	}
	std::vector<double> length;
	for (double diagonal : result.diagonal)
		length.push_back(coarseningOfEpsilon * epsilon * diagonal);
	std::vector<double>& limit = result.epsilonLimit;
	if (!epsilonLimit.empty()) {
		// The middles of halved edges follow the surface's vertices and have no limit.
		limit = detail::copiedArray(epsilonLimit, progress);
		limit.resize(number.vertex.size(), Parameters::maxEpsilon);
		limit = renumbered(limit, number.vertex, mesh.vertexSlots());
	}
	const auto lengthAt = [&](int v) {
		const int c = number.component[v];
		return limit.empty()
			? length[c]
			: coarseningOfEpsilon * std::min(epsilon, limit[v]) * result.diagonal[c];
	};
	std::vector<int> mergedInto = coarsen(mesh, lengthAt, progress.part(0.3, 0.9));
	const std::vector<int> place = mesh.compact(progress.part(0.9, 0.93));
	if (result.finer)
		turnOverMirrored(*result.finer, number.component, frames, progress);
	result.component = renumbered(number.component, place, mesh.vertexSlots());
	turnOverMirrored(mesh, result.component, frames, progress);
	if (!limit.empty())
		limit = renumbered(limit, place, mesh.vertexSlots());
	result.survivor.assign(mesh.vertexSlots(), -1);
	result.inFiner.resize(result.finer ? mesh.vertexSlots() : 0);
	const char* const what = "Ordering the surface";
	const Progress end = progress.part(0.93, 1);
	detail::fillArray(result.node, size_t(surface.vertexSlots()), -1, end);
	detail::reportedLoop(surface.vertexSlots(), end, what, [&](int v) {
		const int ordered = number.vertex[v];
		result.node[v] = place[mergedInto[ordered]];
		if (place[ordered] >= 0)
			result.survivor[place[ordered]] = v;
	});
	if (result.finer)
		for (size_t v = 0; v < place.size(); ++v)
			if (place[v] >= 0)
				result.inFiner[place[v]] = int(v);
	return result;
}

/**
 * Stage 0: surfaceForFlow() and its poles.
 *
 * Components that rest, see componentsAtRest(), are fixed from the start.
 *
 * Diagonals and the initial areas and volume are those of the surface itself, and all its vertices
 * have a correspondence. The middles of halved edges have their poles against the vertices of the
 * finer surface.
 *
 * @param measured   compact, closed; see checkedSurface().
 * @param given      epsilon, poleMethod, adaptive and relativeLength are used; see sharedAmong().
 * @param poles      of all vertices of the surface, see medialPoles().
 * @param known      see boundedField().
 * @throws SolverError, Cancelled, InvalidParameter. Complexity: O(V), and O(s log s) for s halved
 *         edges.
 */
inline Stage firstStage(const MeasuredSurface& measured, const Parameters& given,
	const PoleSet& poles, const Progress& progress = Progress(),
	const BoundedField* known = nullptr)
{
	given.check();
	const Progress begin = progress.cancelOnly();
	const SurfaceMesh& surface = measured.mesh();
	const Parameters parameters = sharedAmong(given, measured.diagonals());
	FlowSurface start = surfaceForFlow(measured, parameters.epsilon, poles, progress,
		epsilonLimits(measured, poles, parameters, begin, known));
	Stage stage;
	stage.component = std::move(start.component);
	stage.epsilonLimit = std::move(start.epsilonLimit);
	stage.node = std::move(start.node);
	stage.diagonal = std::move(start.diagonal);
	const size_t count = start.survivor.size();
	stage.pole.resize(count);
	stage.poleRadius.resize(count);
	// The vertices that are the surface's and those added, with their indices there and in `finer`.
	std::vector<int> own, added, ownOf, addedOf;
	detail::cancellableLoop(int(count), begin, [&](int v) {
		const bool isOwn = start.survivor[v] >= 0;
		(isOwn ? own : added).push_back(v);
		(isOwn ? ownOf : addedOf).push_back(isOwn ? start.survivor[v] : start.inFiner[v]);
	});
	const auto take = [&](int v, const PoleSet& from, size_t i) {
		stage.pole[v] = from.centre[i];
		stage.poleRadius[v] = from.radius[i];
	};
	detail::cancellableLoop(
		int(own.size()), begin, [&](int i) { take(own[i], poles, size_t(ownOf[i])); });
	if (!added.empty()) {
		const PoleSet found =
			polesAt(*start.finer, addedOf, parameters.poleMethod, progress.cancelOnly());
		for (size_t i = 0; i < added.size(); ++i)
			take(added[i], found, i);
	}
	for (size_t v = 0; v < count; ++v)
		stage.fixed.push_back(start.rests[stage.component[v]]);
	stage.held.assign(count, 0);
	stage.sheet.assign(count, 0);
	stage.initialArea = std::move(start.area);
	const Progress end = progress.cancelOnly();
	stage.initialVolume = surface.volume(end);
	stage.surface =
		std::make_shared<const std::vector<Point3d>>(detail::copiedArray(surface.position, end));
	stage.surfaceTriangles = std::make_shared<const std::vector<Triangle>>(surface.triangles(end));
	stage.frames = measured.vertexFrames(end);
	stage.mesh = std::move(start.mesh);
	const Extent extent = measuredExtent(
		stage.mesh, stage.component, std::vector<double>(stage.diagonal.size(), 1), end);
	stage.area = extent.area;
	stage.volume = extent.volume;
	return stage;
}

} // namespace vcg::tri::mcf

#endif
