// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the steps: the curve of one component is tidied, centred, grown and made symmetric.

#ifndef VCG_MCF_REFINE_COMPONENT_H
#define VCG_MCF_REFINE_COMPONENT_H

#include "blade_ends.h"
#include "branch_profile.h"
#include "even_sampling.h"
#include "folds.h"
#include "known_clearances.h"
#include "local_scale.h"
#include "refine_centre.h"
#include "refine_check.h"
#include "refine_features.h"
#include "refine_parameters.h"
#include "refine_symmetry.h"
#include "refine_tips.h"
#include "spur_rules.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

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

/// The last step: trims the ends of branches, see withoutBluntEnds(), and removes branches of which
/// only a doubled tip or the corner of a bend is left. @throws Cancelled
inline CurveSkeleton withTrimmedEnds(const CurveSkeleton& skeleton, KnownClearances& clearances,
	const RefineParameters& parameters, const Progress& cancel)
{
	CurveSkeleton shorter = withoutBluntEnds(skeleton, clearances, parameters.tipGain);
	if (!(parameters.spurProminence > 0))
		return shorter;
	measureBranchEnds(shorter, clearances);
	return withoutCornersOfBends(withoutDoubledTips(std::move(shorter), cancel), cancel);
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
	// Until they are sampled, new branches in thin plates have too many nodes for the bound.
	bool isSampled = true;
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
		isSampled = true;
		moveInside(
			skeleton, surface, cancel); // long edges of a coarse shape's curve may have left it
		progress.report(double(done) / total, what);
	};
	const auto unfold = [&] {
		skeleton = withoutFolds(std::move(skeleton), surface, cancel);
		skeleton = withoutHairpins(std::move(skeleton), surface, cancel);
		measureBranchEnds(skeleton, clearances);
		skeleton = withoutDoubledTips(std::move(skeleton), cancel);
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
		isSampled = false;
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
		[&] {
			tidy(hopeless, 0);
			skeleton = withoutHairpins(std::move(skeleton), surface, cancel);
		},
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
		if (!bounds.holdLength(skeleton) || (isSampled && !bounds.holdNodes(skeleton))
			|| (&step == steps + 1 && isHopeless()))
			return skeleton;
		step();
	}
	return withTrimmedEnds(skeleton, clearances, parameters, cancel);
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
	return withTrimmedEnds(skeleton, clearances, parameters, cancel);
}

} // namespace vcg::tri::mcf::refining

#endif
