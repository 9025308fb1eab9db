// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refine: the improvement of the curve after the paper's pipeline.

#ifndef VCG_MCF_REFINE_H
#define VCG_MCF_REFINE_H

#include "blade_ends.h"
#include "local_scale.h"
#include "refine_centre.h"
#include "refine_check.h"
#include "refine_features.h"
#include "refine_graph.h"
#include "refine_symmetry.h"
#include "refine_tips.h"

#include <skeleton/collapse/curve_inside.h>
#include <skeleton/core/errors.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/flow/stage.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/significance.h>
#include <skeleton/graph/skeleton_branches.h>
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
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The parameters of refine(). Lengths are fractions of the diagonal of a connected component of the
 * surface: that of its bounding box along its principal axes, see PrincipalFrame.
 */
struct RefineParameters
{
	/// Distance of neighbouring nodes; fraction of the diagonal, in (0, 0.1].
	double spacing = 0.005;
	/// A terminal branch whose end ball sticks out of the ball at its junction by less than this
	/// part of the latter's radius is a spur and is removed; in [0, 1]. If it is above 0, so are
	/// twin tips, forked ends and stubs, see withoutTwinTips(), withoutForkedEnds(), withoutStubs()
	/// and withoutStubsInPlates().
	double spurProminence = 0.1;
	/// Two junctions are one where the smaller ball sticks out of the larger one by less than this
	/// part of its own radius; in [0, 1].
	double junctionProminence = 0.5;
	/// kappa, weight of the smoothness along the branch against that of the centring, for a spacing
	/// of 0.5 % where the shape's radius is 3.3 %; >= 0. Larger: smoother, less centred.
	double smoothing = 20;
	/// Rounds of centring with ten times that smoothness, which free curves that are caught on a
	/// wrong sheet of the medial axis, then rounds with it before and after the last extension of
	/// the tips; >= 0.
	int stiffRounds = 6, rounds = 3, lastRounds = 4;
	/// Minimum distinctness() of a terminal branch, and of what may be its end; in [0, 1], 0: any.
	/// The corners of a box have 0.42, pointed ends with an opening angle of 60 degrees 0.5.
	double tipDistinctness = 0.45;
	/// A tip is extended while the balls reach farther by at least this part of the way, and taken
	/// back where they do not; in (0, 1].
	double tipGain = 0.2;
	/// Minimum radius of an extended tip, see TipRule; fraction of the diagonal, > 0.
	double tipRadius = 0.003;
	/// A part of the surface that is higher above the balls than this part of the radius of the
	/// nearest one, and like a limb, gets a branch: see growFeatures(); >= 0.
	double featureHeight = 0.27;
	/// On the way into such a feature the balls reach farther by at least this part of the way; in
	/// (0, 1]. The corners of boxes have 0.42 to 0.56, limbs of even thickness 1.
	double featureGain = 0.56;
	/// Lengths follow the local thickness where that is small, see LocalScale.
	bool adaptive = true;
	/// @see Parameters::relativeLength
	double relativeLength = 0.6;
	/// @see Parameters::detail
	double detail = Parameters::defaultDetail;

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		// Below that, a curve would exceed CurveBounds::holdAtEnd().
		require(
			spacing >= 5e-4 && spacing <= 0.1, "spacing", "between 0.05 and 10 % of the diagonal");
		require(spurProminence >= 0 && spurProminence <= 1, "spur_prominence", "between 0 and 1");
		require(junctionProminence >= 0 && junctionProminence <= 1, "junction_prominence",
			"between 0 and 1");
		require(smoothing >= 0 && std::isfinite(smoothing), "smoothing", "at least 0");
		require(stiffRounds >= 0 && rounds >= 0 && lastRounds >= 0, "rounds", "at least 0");
		require(
			tipDistinctness >= 0 && tipDistinctness <= 1, "tip_distinctness", "between 0 and 1");
		require(tipGain > 0 && tipGain <= 1, "tip_gain", "in (0, 1]");
		require(featureHeight >= 0 && std::isfinite(featureHeight), "feature_height", "at least 0");
		require(featureGain > 0 && featureGain <= 1, "feature_gain", "in (0, 1]");
		require(relativeLength > 0 && relativeLength <= 2, "relative_length", "between 0 and 2");
		require(detail >= 0 && detail <= 1, "detail", "between 0 and 1");
		require(tipRadius > 0 && std::isfinite(tipRadius), "tip_radius", "greater than 0");
	}

private:
	static void require(bool holds, const char* name, const char* range)
	{
		if (!holds)
			throw InvalidParameter(std::string("Parameter ") + name + " must be " + range + ".");
	}
};

namespace refining {

/**
 * The smallest lower bound of the scale with which a curve has no more than maxNodes(): a shape
 * that is thin all along, such as a needle, needs no node every half radius. 0: none is needed.
 * @throws Cancelled. Complexity: O(E log V).
 */
inline double minScale(const CurveSkeleton& curve, const ClosestSurface& closest,
	const LocalScale& scale, double spacing, const Progress& progress)
{
	constexpr int halvings = 30;
	std::vector<std::pair<double, double>> pieces; // length, scale
	double length = 0;
	for (const auto& [a, b] : curve.edges) {
		if (pieces.size() % nodesPerCheck == 0)
			progress.check();
		const Point3d &from = curve.position[a], &to = curve.position[b];
		pieces.emplace_back(Distance(from, to), scale.at((from + to) / 2, closest));
		length += pieces.back().first;
	}
	const auto nodes = [&](double minimum) {
		double sum = 0;
		for (const auto& [piece, own] : pieces)
			sum += piece / (spacing * std::max(own, minimum));
		return sum;
	};
	const double maximum = maxNodes(length);
	if (nodes(0) <= maximum)
		return 0;
	double low = 0, high = 1;
	for (int i = 0; i < halvings; ++i) {
		const double middle = (low + high) / 2;
		(nodes(middle) > maximum ? low : high) = middle;
	}
	return high;
}

/// kappa for the spacing of the nodes, see RefineParameters::smoothing.
inline double kappaOf(const RefineParameters& parameters)
{
	constexpr double referenceSpacing = 0.005;
	return parameters.smoothing * std::pow(referenceSpacing / parameters.spacing, 4);
}

/// Rounds of centring. @param kappa, ascend  see centre() and findContacts(). @throws Cancelled
inline void centreRounds(CurveSkeleton& skeleton, const ClosestSurface& surface, int rounds,
	double kappa, bool ascend, const LocalScale& scale, const Progress& progress)
{
	// Every third round searches the whole surface; the others track the contacts.
	constexpr int roundsOfSearch = 3;
	std::vector<Contact> contacts;
	for (int i = 0; i < rounds; ++i) {
		const Progress round =
			progress.part(double(i) / rounds, double(i + 1) / rounds).cancelOnly();
		if (i % roundsOfSearch == 0)
			contacts = findContacts(skeleton, surface, ascend, round);
		else
			followContacts(contacts, skeleton, surface, round);
		centre(skeleton, contacts, surface, kappa, scale, round);
		progress.report(double(i + 1) / rounds, "Refining the skeleton");
	}
}

/**
 * Refines the skeleton of one component, in coordinates where the component's diagonal is 1. Stops
 * early where the curve exceeds CurveBounds, or where nodes are outside and cannot be moved in by
 * exact closest points: the caller checks whether the curve can be the result, see defectOf().
 * @param scale  its lower bound is raised where there would be too many nodes.
 * @throws SolverError, Cancelled
 */
inline CurveSkeleton refineComponent(CurveSkeleton skeleton, const ClosestSurface& surface,
	const SurfaceComponent& component, LocalScale& scale, const RefineParameters& parameters,
	const Progress& progress)
{
	const char* what = "Refining the skeleton";
	const Progress cancel = progress.cancelOnly();
	constexpr double stiffer = 10, coarser = 1.3;
	constexpr int maxCoarser = 4;
	const double kappa = kappaOf(parameters);
	const FeatureRule features = {
		parameters.featureGain, parameters.featureHeight, parameters.spacing, scale};
	const TipRule tips = {parameters.spacing, parameters.tipGain, parameters.tipRadius, scale};
	const int total = parameters.stiffRounds + parameters.rounds + parameters.lastRounds + 2;
	int done = 0;
	const auto recentre = [&](int rounds, double weight, bool ascend) {
		centreRounds(skeleton, surface, rounds, weight, ascend, scale,
			progress.part(double(done) / total, double(done + rounds) / total));
		done += rounds;
	};
	const CurveBounds bounds(skeleton, parameters.spacing * scale.minimum(component.vertices));
	KnownClearances clearances(surface, cancel);
	const auto tidy = [&](double spurProminence, double tipDistinctness) {
		measureBranchEnds(skeleton, clearances);
		skeleton = withoutSpurs(skeleton, spurProminence, cancel);
		if (spurProminence > 0) {
			skeleton = withoutTwinTips(withoutStubs(skeleton, cancel), cancel);
			skeleton = withOneTipAtEdges(skeleton, surface, clearances, cancel);
		}
		if (tipDistinctness > 0) {
			skeleton = withoutCornerBranches(skeleton, clearances, tipDistinctness, cancel);
			skeleton = withoutCornerEnds(skeleton, clearances, tipDistinctness);
		}
		skeleton = withWholeJunctions(std::move(skeleton), parameters.junctionProminence, cancel);
		skeleton = evenlySampled(skeleton, surface, parameters.spacing, scale, cancel);
		const auto isCrowded = [&] {
			return !scale.isUniform()
				&& double(skeleton.position.size()) > maxNodes(statistics(skeleton).length);
		};
		const auto sampleFrom = [&](double minimum) {
			scale.setMin(std::max(scale.minimum(), minimum));
			skeleton = evenlySampled(skeleton, surface, parameters.spacing, scale, cancel);
		};
		// Tips may have been extended to where the shape is far thinner than along the given curve.
		if (isCrowded())
			sampleFrom(minScale(skeleton, surface, scale, parameters.spacing, cancel));
		// Where straight pieces would leave a needle, it keeps its nodes but for crowded ones.
		for (int i = 0; i < maxCoarser && isCrowded(); ++i)
			sampleFrom(coarser * scale.minimum(component.vertices));
		moveInside(
			skeleton, surface, cancel); // long edges of a coarse shape's curve may have left it
		progress.report(double(done) / total, what);
	};
	const auto unfold = [&] {
		skeleton = withoutDoubledTips(withoutFolds(std::move(skeleton), surface, cancel), cancel);
	};
	const auto extend = [&] {
		measureBranchEnds(skeleton, clearances);
		extendTips(skeleton, surface, tips, cancel);
		progress.report(double(done) / total, what);
	};
	const auto grow = [&] {
		if (parameters.spurProminence > 0) {
			measureBranchEnds(skeleton, clearances);
			skeleton = withoutStubsInPlates(skeleton, surface, cancel);
		}
		growFeatures(skeleton, component, surface, clearances, features,
			progress.part(double(done) / total, double(done + 1) / total));
		++done;
		extend();
	};
	progress.report(0, what);
	measureNodes(skeleton, clearances);
	moveInside(skeleton, surface, cancel);
	// A stub may be the start of a feature: only branches that do not stick out go before the
	// extension.
	constexpr double hopeless = 0;
	const std::function<void()> steps[] = {
		[&] { tidy(hopeless, 0); },
		[&] { recentre(parameters.stiffRounds, stiffer * kappa, false); },
		extend,
		grow,
		unfold,
		[&] { tidy(parameters.spurProminence, parameters.tipDistinctness); },
		[&] { recentre(parameters.rounds, kappa, true); },
		extend,
		unfold,
		[&] { tidy(parameters.spurProminence, parameters.tipDistinctness); },
		[&] { recentre(parameters.lastRounds, kappa, true); },
		unfold,
		[&] { tidy(parameters.spurProminence, parameters.tipDistinctness); },
	};
	// A few may be in branches that will still be removed.
	constexpr size_t fewOutside = 2, partOutside = 500;
	const auto isHopeless = [&] {
		const size_t outside = size_t(std::count_if(skeleton.radius.begin(), skeleton.radius.end(),
			[](double radius) { return !(radius > 0); }));
		return surface.isExact() && outside > fewOutside + skeleton.radius.size() / partOutside;
	};
	for (const std::function<void()>& step : steps) {
		if (!bounds.hold(skeleton) || (&step == steps + 1 && isHopeless()))
			return skeleton;
		step();
	}
	return withoutBluntEnds(skeleton, clearances, parameters.tipGain);
}

/**
 * A refined curve with the branches that it lacks if the shape is symmetric, see withImages(),
 * centred once more; nothing if it lacks none, or if the centring fails. @throws Cancelled
 */
inline std::optional<CurveSkeleton> madeSymmetric(const CurveSkeleton& curve,
	const ClosestSurface& surface, const SurfaceComponent& component, const LocalScale& scale,
	const RefineParameters& parameters, const Progress& cancel)
{
	KnownClearances clearances(surface, cancel);
	std::optional<CurveSkeleton> whole = withImages(curve, component, surface, clearances, cancel);
	if (!whole)
		return std::nullopt;
	CurveSkeleton skeleton =
		withWholeJunctions(withOneTipAtEdges(*whole, surface, clearances, cancel),
			parameters.junctionProminence, cancel);
	const auto sample = [&] {
		skeleton = evenlySampled(skeleton, surface, parameters.spacing, scale, cancel);
	};
	sample();
	try {
		centreRounds(
			skeleton, surface, parameters.lastRounds, kappaOf(parameters), true, scale, cancel);
	}
	catch (const SolverError&) {
		return std::nullopt;
	}
	sample();
	moveInside(skeleton, surface, cancel);
	return withoutBluntEnds(skeleton, clearances, parameters.tipGain);
}

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

} // namespace refining

/// What became of each component of a skeleton in its refinement.
struct RefineReport
{
	/// Components of the surface that have a curve, and those of them that have a refined one.
	int components = 0, refined = 0;
	/// Those that keep the given curve, by what was wrong with the refined one: it left the
	/// surface, grew too long, had other numbers of cycles or parts, or could not be computed.
	int outside = 0, tooLong = 0, otherTopology = 0, notFinite = 0;
	/// Nodes outside the surface in the curves that were kept, and how many curves have such nodes.
	int nodesOutside = 0, curvesOutside = 0;
	/// A component that keeps the given curve.
	struct Kept
	{
		int component; ///< of the surface, see connectedComponents()
		refining::Defect defect;
		int nodesOutside;
	};
	std::vector<Kept> kept;

	/// Counts a component.
	void add(int component, refining::Defect defect, int outside)
	{
		using refining::Defect;
		++components;
		switch (defect) {
		case Defect::None: ++refined; return;
		case Defect::NotFinite: ++notFinite; break;
		case Defect::TooLong: ++tooLong; break;
		case Defect::Topology: ++otherTopology; break;
		case Defect::Outside: ++this->outside; break;
		}
		nodesOutside += outside;
		curvesOutside += outside > 0;
		kept.push_back({component, defect, outside});
	}

	/// The report with one more component counted as refined.
	RefineReport withRefined(int component) const
	{
		RefineReport result;
		for (const Kept& one : kept)
			if (one.component != component)
				result.add(one.component, one.defect, one.nodesOutside);
		result.components = components;
		result.refined = components - int(result.kept.size());
		return result;
	}

	/// Fraction of the components that are refined; 1 for a skeleton without components.
	double fraction() const { return components > 0 ? double(refined) / components : 1; }

	/// One plain line on what was not refined, and why; empty if everything was.
	std::string text() const
	{
		if (refined == components)
			return "";
		std::string why;
		const auto count = [&](int number, const char* reason) {
			if (number > 0)
				why += (why.empty() ? "" : ", ") + std::to_string(number) + " " + reason;
		};
		count(outside, "would have left the surface");
		count(tooLong, "would have become too long");
		count(otherTopology, "would have changed in components or cycles");
		count(notFinite, "could not be computed");
		std::string line = std::to_string(components - refined) + " of "
			+ std::to_string(components)
			+ " components are not refined and keep their curves: " + why + ".";
		if (nodesOutside > 0)
			line += " Of the curves that are kept, " + std::to_string(curvesOutside)
				+ " are partly outside the surface, with " + std::to_string(nodesOutside)
				+ " nodes: parts of the shape may be too thin for the edges of its triangles.";
		return line;
	}
};

/// What refineChecked() returns.
struct Refinement
{
	CurveSkeleton skeleton;
	RefineReport report;
};

namespace refining {

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
		detail::reportedLoop(int(ofVertex.size()), ofComponent.part(0.95, 1), what, [&](int i) {
			const int s = ids[i], before = curve.node[s];
			if (before < 0)
				return;
			if (componentOfNode[before] != c && !ownNodes)
				ownNodes.emplace(part.position);
			const int node = componentOfNode[before] == c ? part.node[number[before]]
														  : ownNodes->nearest(unit.position[s]);
			ofVertex[i] =
				isRefined ? refining::nearestAlong(part, neighbours, node, unit.position[s]) : node;
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
