// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refine: the improvement of the curve after the paper's pipeline.

#ifndef VCG_MCF_REFINE_H
#define VCG_MCF_REFINE_H

#include "known_clearances.h"
#include "local_scale.h"
#include "refine_check.h"
#include "refine_component.h"
#include "refine_parameters.h"
#include "refine_report.h"

#include <skeleton/collapse/curve_inside.h>
#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/significance.h>
#include <skeleton/graph/skeleton_radius.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/principal_frame.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/poles/poles.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/spatial/solid_test.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What refineChecked() returns.
struct Refinement
{
	CurveSkeleton skeleton;
	RefineReport report;
};

namespace refining {

/// Descends along the graph from a node to one whose neighbours are no nearer to the point.
inline int nearestAlong(const CurveSkeleton& skeleton,
	const std::vector<std::vector<int>>& neighbours, int node, const Point3d& point)
{
	double minimum = SquaredDistance(skeleton.position[node], point);
	for (int from = -1;;) {
		int nearest = node;
		for (int w : neighbours[node]) {
			if (w == from)
				continue; // it was farther
			const double squared = SquaredDistance(skeleton.position[w], point);
			if (squared < minimum) {
				minimum = squared;
				nearest = w;
			}
		}
		if (nearest == node)
			return node;
		from = node;
		node = nearest;
	}
}

/**
 * The scale of each vertex, see LocalScale.
 * @param poles of all vertices; null: they are computed.
 * @param known see boundedField().
 * @return empty where it is 1 everywhere. @throws Cancelled
 */
inline std::vector<double> scaleOfVertices(const MeasuredSurface& surface,
	const RefineParameters& parameters, const PoleSet* poles, const BoundedField* known,
	const Progress& progress)
{
	constexpr double neutralSpacing = 0.005; // of the diagonal, where the field is neutralLength
	std::vector<double> scale;
	if (!parameters.adaptive)
		return scale;
	PoleSet found;
	if (!poles) {
		found = medialPoles(surface, PoleMethod::Balls, progress);
		poles = &found;
	}
	const double neutral = neutralLength * parameters.spacing / neutralSpacing;
	std::vector<double> bound;
	for (double diagonal : surface.diagonals())
		bound.push_back(neutral * diagonal);
	const BoundedField field =
		boundedField(surface, *poles, parameters.relativeLength, std::move(bound), known, progress);
	scale.reserve(field.length.size());
	for (size_t v = 0; v < field.length.size(); ++v)
		scale.push_back(
			std::min(1.0, field.length[v] / field.bound[size_t(surface.component()[v])]));
	return scale;
}

/// The branches of a component's skeleton, see nestedBranches(), from its distances to the surface.
/// @throws Cancelled. Complexity: O(N log V).
inline NestedBranches nestedIn(
	const ClosestSurface& surface, CurveSkeleton skeleton, const Progress& progress)
{
	tri::mcf::detail::reportedLoop(
		int(skeleton.position.size()), progress, "Refining the skeleton", [&](int v) {
			skeleton.radius[v] = std::max(surface.clearance(skeleton.position[v]), 0.0);
		});
	return nestedBranches(skeleton, progress);
}

/**
 * Brings the parts of a refined curve that have left the surface back, see detail::CurveIntoSolid:
 * a few edges that cut a bend of a twig are no reason to give up all that is refined elsewhere. Not
 * if more than a tenth of the edges or more than a thousand are outside.
 * @return a curve that is outside by no more than the rounding; nothing if that is not possible.
 * @throws Cancelled
 */
inline std::optional<CurveSkeleton> broughtBack(
	const CurveSkeleton& curve, const SurfaceComponent& component, const Progress& progress)
{
	const ComponentSurface own(component.mesh, component.vertices, component.place, progress);
	const SolidTest solid(own.position, own.triangles, progress);
	std::vector<Point3d> place;
	for (const Point3d& p : curve.position)
		place.push_back(solid.in(p));
	std::vector<std::array<int, 2>> edges;
	for (const auto& [a, b] : curve.edges)
		edges.push_back({a, b});
	constexpr double maxOutside = 0.1; // of the edges: more is no slip, but another curve
	constexpr double maxEdges = 1000;  // which take ten seconds
	size_t asked = 0;
	const auto checkNowAndThen = [&] {
		if (asked++ % nodesPerCheck == 0)
			progress.check();
	};
	const auto isOutside = [&](const std::array<int, 2>& edge) {
		checkNowAndThen();
		return !solid.segmentIsInside(place[edge[0]], place[edge[1]], detail::outsideTolerance);
	};
	if (double(std::count_if(edges.begin(), edges.end(), isOutside))
		> std::min(maxOutside * double(edges.size()), maxEdges))
		return std::nullopt;
	CurveSkeleton inside = curve;
	// Exactly if possible: ways along the surface itself are inside only up to rounding.
	for (const double tolerance : {0.0, detail::outsideTolerance}) {
		detail::CurveIntoSolid into(solid, place, edges, progress, tolerance);
		try {
			if (into.bringInside() == detail::CurveIntoSolid::Outcome::TooLong)
				continue;
		}
		catch (const SolverError&) {
			continue;
		}
		const std::vector<Point3d>& places = into.places();
		const auto isInside = [&](const std::array<int, 2>& edge) {
			checkNowAndThen();
			return solid.segmentIsInside(places[edge[0]], places[edge[1]], tolerance);
		};
		const std::vector<std::array<int, 2>>& bent = into.curveEdges();
		if (!std::all_of(bent.begin(), bent.end(), isInside))
			continue;
		inside.radius.resize(places.size(), 0);
		inside.position.resize(places.size());
		for (size_t v = 0; v < places.size(); ++v)
			if (v >= curve.position.size() || into.changedNodes()[v])
				inside.position[v] = solid.out(places[v]);
		inside.edges.clear();
		for (const auto& [a, b] : bent)
			inside.edges.push_back({std::min(a, b), std::max(a, b)});
		std::sort(inside.edges.begin(), inside.edges.end());
		return inside;
	}
	return std::nullopt;
}

/**
 * Refines the skeleton of one component and checks the result. Where lengths follow the local
 * thickness, what has left the surface is brought back, see broughtBack(). What still fails is
 * tried again with lengths that are the same everywhere. If the curve then leaves the surface or
 * grows too long, the last attempt uses exact closest points: where the shape is thinner than the
 * samples of its surface are apart, the fast ones take the wrong wall. Not if the curve has more
 * than 10000 nodes: that would take minutes.
 * @param refined  the unrefined curve; receives the refined one if that has no defect.
 * @param surface  of the component; uses exact closest points from the last attempt on.
 * @throws Cancelled
 */
inline Defect refineChecked(CurveSkeleton& refined, ClosestSurface& surface,
	const SurfaceComponent& component, const LocalScale& scale, const RefineParameters& parameters,
	const Progress& progress)
{
	constexpr size_t maxNodesOfExact = 10000;
	constexpr double usual = 0.8,
					 second = 0.9; // of the time: few shapes need more than one attempt
	const CurveSkeleton unrefined = refined;
	surface.considerCrossings(unrefined.position, progress.cancelOnly());
	const InsideCheck inside(surface, component);
	size_t nodes = 0;
	const auto attempt = [&](LocalScale own, double from, double to) {
		const double spacing = parameters.spacing * own.minimum(component.vertices);
		try {
			CurveSkeleton curve = refineComponent(
				unrefined, surface, component, own, parameters, progress.part(from, to));
			nodes = curve.position.size();
			const Progress end = progress.cancelOnly();
			Defect defect = defectOf(curve, unrefined, spacing, inside, end);
			if (defect == Defect::Outside && !own.isUniform())
				if (auto back = broughtBack(curve, component, end);
					back && defectOfShape(*back, unrefined, spacing) == Defect::None) {
					curve = std::move(*back);
					defect = Defect::None;
				}
			if (defect == Defect::None) {
				if (auto symmetric = madeSymmetric(curve, surface, component, own, parameters, end);
					symmetric
					&& defectOf(*symmetric, unrefined, spacing, inside, end) == Defect::None)
					curve = std::move(*symmetric);
				refined = std::move(curve);
			}
			return defect;
		}
		catch (const SolverError&) {
			return Defect::NotFinite;
		}
	};
	Defect defect = attempt(scale, 0, usual);
	if (defect != Defect::None && !scale.isUniform())
		defect = attempt(sameEverywhere, usual, second);
	if ((defect == Defect::Outside || defect == Defect::TooLong) && nodes <= maxNodesOfExact) {
		surface.makeExact(progress.cancelOnly());
		defect = attempt(sameEverywhere, second, 1);
	}
	return defect;
}

} // namespace refining

/**
 * Refines a curve skeleton within the surface that it was extracted from: removes spurs, merges
 * split junctions, samples the branches evenly, centres the nodes in the maximal balls of the
 * surface while it smooths the branches, extends the tips to the ends of their features, grows
 * branches into limbs that the curve lacks, and gives the branches of a symmetric shape their images.
 *
 * Nodes that were outside are moved in where possible. Each component's result is checked: all
 * nodes and edges are inside, the numbers of components and cycles are unchanged, and it is within
 * CurveBounds. A component that fails keeps its curve unchanged: positions, radii, correspondence
 * and all branches, whether or not that is inside; the report counts such components.
 *
 * At last the branches below the detail are removed: nothing else depends on it, so that a skeleton
 * of less detail is a part of one of more. The result depends on the shape of each component only,
 * not on its size and place. Each surface vertex goes to a nearest node, by descent along the graph
 * from what its node has become; one whose node belongs to another component goes to the nearest of
 * its own. The radius is measured anew, see curveThickness().
 *
 * @param curve       its `node` has an entry for each vertex of `surface`.
 * @param measured    closed triangle mesh of any number of components, compact.
 * @param parameters  see RefineParameters.
 * @param progress    window for reports; cancelling leaves nothing behind.
 * @param poles       of all vertices of the surface, by shrinking balls; null: they are computed.
 * @param known       see boundedField(); by the same poles and relative length.
 * @return the refined skeleton, mesh units, nodes of the first component first, and the report.
 * @throws InvalidParameter, InvalidInput if the correspondence does not fit the surface or the
 *         curve or the curve has nodes that are not finite, Cancelled.
 * Complexity: O(V log V + N log V) for V vertices and N nodes, and growFeatures().
 * Source: ours; see Tagliasacchi et al., "Mean Curvature Skeletons", SGP 2012, for the curve.
 */
inline Refinement refineChecked(const CurveSkeleton& curve, const MeasuredSurface& measured,
	const RefineParameters& parameters = RefineParameters(), const Progress& progress = Progress(),
	const PoleSet* poles = nullptr, const BoundedField* known = nullptr)
{
	parameters.check();
	const SurfaceMesh& surface = measured.mesh();
	if (int(curve.node.size()) != surface.vertexSlots())
		throw InvalidInput("The skeleton's correspondence is for a surface of "
			+ std::to_string(curve.node.size()) + " vertices, this one has "
			+ std::to_string(surface.vertexSlots())
			+ ": choose the surface that it was made from.");
	const char* const what = "Refining the skeleton";
	const Progress begin = progress.cancelOnly();
	detail::reportedLoop(int(curve.node.size()), begin, what, [&](int s) {
		if (curve.node[s] >= int(curve.position.size()))
			throw InvalidInput("The skeleton's correspondence names nodes that it does not have.");
	});
	if (!refining::isFinite(curve))
		throw InvalidInput("The skeleton has nodes whose coordinates are not finite.");
	const int components = measured.components();
	const std::vector<int>& component = measured.component();
	const std::vector<int> componentOfNode = componentOfNodes(curve, component);
	const ComponentVertices vertices(component, components, progress.cancelOnly());
	std::vector<std::vector<int>> nodes(components), edges(components);
	for (size_t v = 0; v < componentOfNode.size(); ++v)
		if (componentOfNode[v] >= 0)
			nodes[componentOfNode[v]].push_back(int(v));
	for (size_t e = 0; e < curve.edges.size(); ++e)
		if (const int c = componentOfNode[curve.edges[e][0]]; c >= 0)
			edges[c].push_back(int(e));
	// Each component in its own principal frame, with a diagonal of 1.
	const std::vector<PrincipalFrame>& frame = *measured.vertexFrames(progress.part(0, 0.02));
	const auto toUnit = [&](const Point3d& p, int c) {
		return frame[c].onGrid(p) / frame[c].sizeInside();
	};
	const auto fromUnit = [&](const Point3d& p, int c) {
		return frame[c].out(p * frame[c].sizeInside());
	};
	SurfaceMesh unit = surface.copied(progress);
	detail::reportedLoop(surface.vertexSlots(), progress.part(0.02, 0.03), what,
		[&](int v) { unit.position[v] = toUnit(surface.position[v], component[v]); });
	turnOverMirrored(unit, component, frame, progress);

	Refinement result;
	CurveSkeleton& refined = result.skeleton;
	RefineReport& report = result.report;
	detail::fillArray(refined.node, curve.node.size(), -1, progress);
	std::vector<int> number(curve.position.size(), -1);
	std::vector<std::pair<int, int>>
		kept; // nodes of the result that are as they were, and what they were
	constexpr double sampleSpacing = 0.01;
	refining::LocalScale scale(
		unit, refining::scaleOfVertices(measured, parameters, poles, known, progress.cancelOnly()));
	const auto isThin = [&](int c) { return scale.minimum(vertices.ids[c]) < 1; };
	for (int c = 0; c < components; ++c) {
		if (nodes[c].empty())
			continue;
		CurveSkeleton part;
		for (int v : nodes[c]) {
			number[v] = int(part.node.size());
			part.node.push_back(number[v]);
			part.position.push_back(toUnit(curve.position[v], c));
		}
		part.radius.assign(part.position.size(), 0);
		for (int e : edges[c])
			part.edges.push_back({number[curve.edges[e][0]], number[curve.edges[e][1]]});
		const Progress ofComponent =
			progress.part(0.03 + 0.97 * c / components, 0.03 + 0.97 * (c + 1) / components);
		ClosestSurface closest(unit, vertices.ids[c], sampleSpacing, ofComponent.part(0, 0.1));
		const refining::SurfaceComponent own = {unit, vertices.ids[c], vertices.place};
		scale.setMin(0);
		if (isThin(c))
			scale.setMin(refining::minScale(
				part, closest, scale, parameters.spacing, ofComponent.cancelOnly()));
		const refining::Defect defect = refining::refineChecked(part, closest, own,
			isThin(c) ? scale : refining::sameEverywhere, parameters, ofComponent.part(0.1, 0.95));
		const bool isRefined = defect == refining::Defect::None;
		report.add(c, defect,
			isRefined
				? 0
				: refining::InsideCheck(closest, own).countOutside(part, ofComponent.cancelOnly()));

		const std::vector<std::vector<int>> neighbours = part.neighbours();
		const std::vector<int>& ids = vertices.ids[c];
		std::vector<int> ofVertex(ids.size(), -1);
		std::optional<PointTree> ownNodes;
		const auto isOther = [&](int before) {
			return before >= 0 && componentOfNode[before] != c;
		};
		if (std::any_of(ids.begin(), ids.end(), [&](int s) { return isOther(curve.node[s]); }))
			ownNodes.emplace(part.position);
		forEachBlock(int(ofVertex.size()), ofComponent.part(0.95, 1), what, [&](int from, int to) {
			for (int i = from; i < to; ++i) {
				const int s = ids[i], before = curve.node[s];
				if (before < 0)
					continue;
				const int node = isOther(before) ? ownNodes->nearest(unit.position[s])
												 : part.node[number[before]];
				ofVertex[i] = isRefined
					? refining::nearestAlong(part, neighbours, node, unit.position[s])
					: node;
			}
		});
		part.node = std::move(ofVertex);
		const NestedBranches nested = refining::nestedIn(closest, part, ofComponent.cancelOnly());
		part = significantPart(std::move(part), nested, isRefined ? 1 - parameters.detail : 0);
		const int first = int(refined.position.size());
		for (size_t i = 0; i < ids.size(); ++i)
			if (part.node[i] >= 0)
				refined.node[ids[i]] = first + part.node[i];
		for (int v = 0; v < int(part.position.size()); ++v) {
			if (!isRefined)
				kept.emplace_back(first + v, nodes[c][v]);
			refined.position.push_back(
				isRefined ? fromUnit(part.position[v], c) : curve.position[nodes[c][v]]);
			refined.significance.push_back(part.significance[v]);
		}
		for (const auto& [a, b] : part.edges)
			refined.edges.push_back({first + a, first + b});
	}
	refined.radius = curveThickness(refined, surface.position, progress);
	for (const auto& [node, before] : kept)
		if (before < int(curve.radius.size()))
			refined.radius[node] = curve.radius[before];
	progress.report(1, what);
	return result;
}

/// The skeleton of refineChecked() alone.
inline CurveSkeleton refine(const CurveSkeleton& curve, const MeasuredSurface& surface,
	const RefineParameters& parameters = RefineParameters(), const Progress& progress = Progress())
{
	return refineChecked(curve, surface, parameters, progress).skeleton;
}

} // namespace vcg::tri::mcf

#endif
