// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Fig. 4 of the paper, top to bottom: from a closed surface to its skeleton.

#ifndef VCG_MCF_SKELETONIZE_H
#define VCG_MCF_SKELETONIZE_H

#include <skeleton/collapse/curve_inside.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/flow/flow.h>
#include <skeleton/flow/held_vertices.h>
#include <skeleton/flow/start_of_flow.h>
#include <skeleton/graph/closest_curve.h>
#include <skeleton/graph/join_pieces.h>
#include <skeleton/input/check_input.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_rounding.h>
#include <skeleton/poles/poles.h>
#include <skeleton/refine/refine.h>
#include <skeleton/repair/make_solid.h>
#include <skeleton/resample/resampled_surface.h>
#include <skeleton/sheets/collapse_with_sheets.h>
#include <skeleton/spatial/transferred_nodes.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The lines of Fig. 4, ours at both ends included.
enum class Phase { Check, Resample, Poles, Contraction, Collapse, Refine };

/// Wall-clock time of each phase, seconds; 0 for those that were left out.
struct PhaseSeconds
{
	double check = 0, resample = 0, poles = 0, contraction = 0, collapse = 0, refine = 0;

	PhaseSeconds& operator+=(const PhaseSeconds& other)
	{
		check += other.check;
		resample += other.resample;
		poles += other.poles;
		contraction += other.contraction;
		collapse += other.collapse;
		refine += other.refine;
		return *this;
	}
};

/// Callbacks invoked during skeletonize(), beside those of the contraction. Unset ones cost nothing.
struct Observer : StageObserver
{
	/// One sentence on what was repaired, found, or decided.
	NoteCallback onNote;
	/// A phase has ended, or was left out.
	std::function<void(Phase)> onPhase;
	/// The contraction starts over on another surface, see skeletonize(): stages so far count no more.
	std::function<void()> onStartOver;
};

/// A surface that has been checked, and what is known of it.
struct SurfaceInput
{
	/// As checkedSurface() makes it: closed, oriented, compact.
	std::shared_ptr<const SurfaceMesh> mesh;
	/// 1 for the vertices that are to stay where they are; empty if there are none.
	std::vector<char> held = {};
	/// The medial poles of all vertices; null: they are computed. Of no use if the surface is resampled.
	std::shared_ptr<const PoleSet> poles = nullptr;
	/// The surface with cavities that are not in `mesh`, or not as such, see LeftOutPieces::hollow; null if there are
	/// none.
	std::shared_ptr<const SurfaceMesh> hollow = nullptr;
};

/// What skeletonize() returns.
struct Skeletonization
{
	/// The skeleton; empty where there are sheets.
	CurveSkeleton curve;
	/// The skeleton where sheets were kept.
	std::optional<SheetCollapse> sheets;
	/// For each vertex of the input its node of the skeleton, -1 for vertices that no face uses.
	std::vector<int> node;
	/// The surface that was contracted: the resampled one, or the input; the skeleton's own `node` is of it.
	std::shared_ptr<const SurfaceMesh> surface;
	/// Its medial poles.
	std::shared_ptr<const PoleSet> poles;
	/// The last stage of the contraction, with iterations, convergence and fractions: see figuresOf().
	std::shared_ptr<const Stage> stage;
	/// The noise of the input; not measured if it is not resampled.
	NoiseReport noise;
	/// The components whose curve was cut when it was brought inside.
	CutCurves cut;
	/// Fraction of the components whose curve is refined, and whole, see CutCurves; 0 if it was not asked for.
	double refined = 0;
	/// What became of each component in the refinement.
	RefineReport refinement;
	/// What was done to the triangles to make them those of a solid.
	SolidReport solid;
	/// The part of the skeleton that lies in cavities, see partOutside().
	double inCavities = 0;
	/// Between the skeletons of pieces, where they were to be joined.
	Bridges bridges;
	PhaseSeconds seconds;

	/// For each vertex of `surface` its node of the skeleton.
	const std::vector<int>& nodeOfSurface() const
	{
		return sheets ? sheets->skeleton.node : curve.node;
	}
};

namespace detail {

/// Measures the phases of a run and reports their ends.
class PhaseClock
{
public:
	explicit PhaseClock(const Observer& observer) : observer(observer) {}

	/// The seconds since the last phase ended.
	double end(Phase phase)
	{
		const Clock::time_point now = Clock::now();
		const std::chrono::duration<double> seconds = now - std::exchange(begin, now);
		if (observer.onPhase)
			observer.onPhase(phase);
		return seconds.count();
	}

private:
	using Clock = std::chrono::steady_clock;
	const Observer& observer;
	Clock::time_point begin = Clock::now();
};

/// skeletonize(), on the surface that the parameters say, whatever comes out.
inline Skeletonization skeletonizeOnce(const SurfaceInput& input, const Parameters& given,
	const Progress& progress, const Observer& observer, const RefineParameters& refinement)
{
	Parameters parameters = given;
	const auto note = [&](const std::string& text) {
		if (observer.onNote)
			observer.onNote(text);
	};
	PhaseClock clock(observer);
	Skeletonization result;

	result.surface = input.mesh;
	std::vector<char> held = input.held;
	if (parameters.resample) {
		ResampledSurface resampled =
			resampledSurface(*input.mesh, parameters, progress.part(0, 0.13), observer.onNote);
		result.surface = std::make_shared<const SurfaceMesh>(std::move(resampled.mesh));
		result.noise = std::move(resampled.noise);
		parameters.adaptive = parameters.adaptive && !resampled.isTooThin;
		if (!held.empty())
			held = selectionOnResampled(*input.mesh, held, *result.surface, progress.cancelOnly());
	}
	const SurfaceMesh& surface = *result.surface;
	result.seconds.resample = clock.end(Phase::Resample);

	if (!parameters.resample)
		result.poles = input.poles;
	if (!result.poles)
		result.poles = std::make_shared<const PoleSet>(
			medialPoles(surface, parameters.poleMethod, progress.part(0.13, 0.23)));
	result.seconds.poles = clock.end(Phase::Poles);

	Stage start = startOfFlow(
		surface, *result.poles, held, parameters, progress.part(0.23, 0.25), observer.onNote);
	result.stage = std::make_shared<const Stage>(
		contractToSkeleton(std::move(start), parameters, progress.part(0.25, 0.85), observer));
	const Stage& stage = *result.stage;
	if (!stage.converged)
		note("The contraction has not converged after " + std::to_string(stage.iteration)
			+ (stage.isSpread()
					? " iterations: the surface spreads, being inside out in large parts."
					: " iterations."));
	result.seconds.contraction = clock.end(Phase::Contraction);

	if (stage.hasSheets())
		result.sheets = collapseWithSheets(
			stage, parameters.epsilon, progress.part(0.85, 0.9), observer.onNote);
	else if (parameters.tidyCurve)
		result.curve =
			collapseInside(stage, parameters.epsilon, progress.part(0.85, 0.9), &result.cut);
	else
		result.curve = collapseToCurve(stage, parameters.epsilon, progress.part(0.85, 0.9), false);
	result.seconds.collapse = clock.end(Phase::Collapse);

	if (parameters.refine && result.sheets)
		note("The skeleton is not refined: that is for curves without sheets.");
	else if (parameters.refine && !held.empty())
		note("The skeleton is not refined: that would move it off the vertices that are held.");
	else if (parameters.refine) {
		RefineParameters scaled = refinement;
		scaled.adaptive = parameters.adaptive && refinement.adaptive;
		scaled.relativeLength = parameters.relativeLength;
		scaled.detail = parameters.detail;
		Refinement refined = refineChecked(result.curve, surface, scaled, progress.part(0.9, 0.99),
			parameters.poleMethod == PoleMethod::Balls ? result.poles.get() : nullptr);
		result.curve = std::move(refined.skeleton);
		result.refinement = refined.report;
		result.refined = result.refinement.fraction();
		if (result.cut.components > 0)
			result.refined = double(std::max(result.refinement.refined - result.cut.components, 0))
				/ result.refinement.components;
	}
	result.seconds.refine = clock.end(Phase::Refine);

	result.node = parameters.resample
		? transferredNodes(surface, result.nodeOfSurface(), *input.mesh, progress.cancelOnly())
		: result.nodeOfSurface();
	if (parameters.resample && parameters.refine && !result.sheets && held.empty())
		bringInsideInput(result.curve, surface, *input.mesh, result.node, progress.part(0.99, 1));
	return result;
}

/**
 * How much of a shape a curve does not describe: the part of its limbs, by length, that is farther from the curve
 * than three times as thick as it is there.
 * @param poles of all vertices of the surface. @return 0 to 1; 1 for a curve without nodes.
 * @throws Cancelled. Complexity: O((V + N) log N).
 */
inline double partLeftOut(const SurfaceMesh& surface, const PoleSet& poles,
	const CurveSkeleton& curve, const Progress& progress)
{
	constexpr double far = 3; // local thicknesses
	constexpr const char* what = "Comparing skeletons";
	if (curve.position.empty())
		return 1;
	const ClosestCurve closest(curve);
	std::vector<char> isLeftOut(size_t(surface.vertexSlots()), 0);
	forEachBlock(surface.vertexSlots(), progress, what, [&](int begin, int end) {
		for (int v = begin; v < end; ++v)
			isLeftOut[v] = poles.has(v)
				&& closest.closest(surface.position[v]).distance > far * poles.radius[v];
	});
	double leftOut = 0, all = 0;
	for (int f = 0; f < surface.faceSlots(); ++f) {
		const double area = surface.areaVector(f).Norm();
		for (int v : surface.triangle(f))
			if (poles.has(v) && poles.radius[v] > 0) {
				const double length = area / poles.radius[v];
				all += length;
				leftOut += isLeftOut[v] ? length : 0;
			}
	}
	return all > 0 ? leftOut / all : 0;
}

/**
 * Whether a skeleton of the surface as it is replaces one of the resampled surface that could not be refined.
 * Not where it describes less of the shape, as of limbs whose triangles are many times as long as thick, while
 * the other one describes nearly all of it and hardly leaves it.
 * @throws Cancelled
 */
inline bool isBetter(const SurfaceMesh& surface, const Skeletonization& asItIs,
	const Skeletonization& resampled, const Progress& progress)
{
	constexpr double muchShorter = 0.5, mostOutside = 0.01, mostLeftOut = 0.05, more = 0.01;
	const bool isMuchShorter =
		statistics(asItIs.curve).length < muchShorter * statistics(resampled.curve).length;
	if (!isMuchShorter
		&& double(resampled.refinement.nodesOutside)
			<= mostOutside * double(resampled.curve.position.size())) {
		const double leftOut = partLeftOut(surface, *asItIs.poles, resampled.curve, progress);
		if (leftOut <= mostLeftOut
			&& partLeftOut(surface, *asItIs.poles, asItIs.curve, progress) > leftOut + more)
			return false;
	}
	return asItIs.refined != resampled.refined ? asItIs.refined > resampled.refined : isMuchShorter;
}

/// Of the time, for the first way to the skeleton: it is seldom that another one is needed.
constexpr double once = 0.97;

/// Another way to the skeleton: its stages reach the observer only if it is taken.
class Alternative
{
public:
	explicit Alternative(const Observer& observer) : observer(observer) {}

	/// Of the other run.
	Observer listener()
	{
		Observer result;
		result.every = observer.every;
		if (observer.onStage)
			result.onStage = [&](Stage stage) { stages.push_back(std::move(stage)); };
		return result;
	}

	void take()
	{
		if (observer.onStartOver)
			observer.onStartOver();
		for (Stage& stage : stages)
			observer.onStage(std::move(stage));
	}

private:
	const Observer& observer;
	std::vector<Stage> stages;
};

/// skeletonize(), on the surface as the parameters say or, where it is too thin for that, as it is.
inline Skeletonization skeletonizeThin(const SurfaceInput& input, const Parameters& given,
	const Progress& progress, const Observer& observer, const RefineParameters& refinement)
{
	constexpr int maxVerticesAsItIs = 100000;
	Skeletonization result =
		skeletonizeOnce(input, given, progress.part(0, once), observer, refinement);
	const bool isStopped =
		!result.stage->isDone() && given.maxIterations < Parameters().maxIterations;
	const bool isDoubtful = given.resample && given.refine && !result.sheets && input.held.empty()
		&& result.refined < 1 && !isStopped && input.mesh->vertexCount() <= maxVerticesAsItIs;
	if (!isDoubtful)
		return result;
	Parameters asItIs = given;
	asItIs.resample = asItIs.keepSheets = false;
	Alternative alternative(observer);
	try {
		Skeletonization other = skeletonizeOnce(
			input, asItIs, progress.part(once, 1), alternative.listener(), refinement);
		const bool isTaken = isBetter(*input.mesh, other, result, progress.cancelOnly());
		other.noise = result.noise;
		result.seconds += other.seconds;
		if (isTaken) {
			other.seconds = result.seconds;
			result = std::move(other);
			if (observer.onNote)
				observer.onNote(
					"The shape is too thin for its resampled surface: the skeleton is that of the surface as it is.");
			alternative.take();
		}
	}
	catch (const SolverError&) {
		// Then there is nothing to choose from.
	}
	return result;
}

/**
 * A skeleton with sheets, or without them where they would leave a thicket of curves: where no sheet could be kept, and
 * where the curves are more than twice as long as those of the shape contracted without sheets.
 * Complexity: as skeletonize(), twice where that is in doubt.
 */
inline Skeletonization skeletonizeWithSheets(const SurfaceInput& input, const Parameters& given,
	const Progress& progress, const Observer& observer, const RefineParameters& refinement)
{
	constexpr double doubtful = 3; // diagonals of the components
	constexpr double thicket = 2;  // times the length without sheets
	Skeletonization result =
		skeletonizeThin(input, given, progress.part(0, once), observer, refinement);
	if (!result.sheets || !input.held.empty())
		return result;
	const SheetCollapse& found = *result.sheets;
	const double length = found.skeleton.curveLength();
	double diagonals = 0;
	for (double diagonal : result.stage->diagonal)
		diagonals += diagonal;
	const bool isNone = found.givenUp > 0 && found.skeleton.faces.empty();
	if (!isNone && length <= doubtful * diagonals)
		return result;
	Parameters curvesOnly = given;
	curvesOnly.keepSheets = false;
	Alternative alternative(observer);
	Skeletonization other = skeletonizeThin(
		input, curvesOnly, progress.part(once, 1), alternative.listener(), refinement);
	other.sheets = withoutSheets(other.curve);
	const double ofOther = other.sheets->skeleton.curveLength();
	result.seconds += other.seconds;
	if (!isNone && length <= thicket * ofOther)
		return result;
	other.seconds = result.seconds;
	other.sheets->sheets = other.sheets->givenUp = found.sheets;
	if (observer.onNote)
		observer.onNote(isNone
				? "No sheet could be kept: the shape is contracted without sheets."
				: sentence(2, "With sheets the curves would be ", length / ofOther,
					" times as long as without: the shape is contracted without sheets."));
	alternative.take();
	return other;
}

} // namespace detail

/**
 * Computes the skeleton of a checked surface.
 *
 * A surface that is thinner than the edges of its resampling is cut off, or crosses itself, when it is resampled.
 * That shows in the end: its curve cannot be refined, since that would leave the surface. Then the surface is
 * contracted as it is as well, and the better curve is taken, see detail::isBetter(), which is said. Sheets that
 * would leave a thicket are given up, see detail::skeletonizeWithSheets().
 *
 * @param parameters all of them are read; the default epsilon is larger for more than 50 components, see
 *                   sharedAmong(). What is too thin for a resampled surface to follow, see
 *                   fieldOfResampling(), is not contracted and refined adaptively either.
 * @param refinement the knobs of refine(), where parameters.refine is set.
 * @throws InvalidParameter, InvalidInput, SolverError, Cancelled.
 * Complexity: O(V log V) and some 10 to 40 steps of the flow; twice that for what is too thin.
 */
inline Skeletonization skeletonize(const SurfaceInput& input, const Parameters& parameters,
	const Progress& progress = Progress(), const Observer& observer = Observer(),
	const RefineParameters& refinement = RefineParameters())
{
	parameters.check();
	refinement.check();
	int components = 0;
	const Progress begin = progress.cancelOnly();
	const std::vector<int> component = connectedComponents(*input.mesh, &components, begin);
	const Parameters given = components > 1
		? sharedAmong(
			parameters, MeasuredSurface(*input.mesh, component, components, begin).diagonals())
		: parameters;
	const auto note = [&](const std::string& text) {
		if (observer.onNote && !text.empty())
			observer.onNote(text);
	};
	if (given.epsilon != parameters.epsilon)
		note(detail::sentence(2, components, " components: epsilon is ", 100 * given.epsilon,
			" % of the diagonal of each."));
	Skeletonization result = given.keepSheets
		? detail::skeletonizeWithSheets(input, given, progress, observer, refinement)
		: detail::skeletonizeThin(input, given, progress, observer, refinement);
	note(result.cut.text());
	note(result.refinement.text());
	if (input.hollow) {
		CurveSkeleton lines = result.curve;
		if (result.sheets) {
			lines.position = result.sheets->skeleton.position;
			lines.edges = result.sheets->skeleton.edges;
		}
		result.inCavities = partOutside(lines, *input.hollow, progress.cancelOnly());
		if (result.inCavities > 0)
			note(detail::sentence(2, 100 * result.inCavities,
				" % of the skeleton lies in cavities, outside the solid."));
	}
	if (given.join && result.sheets)
		note("The pieces are not joined: that is for curves without sheets.");
	else if (given.join) {
		result.bridges = joinPieces(result.curve, *result.surface, progress.cancelOnly());
		if (result.bridges.count)
			note(detail::sentence(3, result.bridges.count,
				result.bridges.count == 1 ? " bridge joins" : " bridges join",
				" the pieces, over gaps of ", result.bridges.longest, " mesh units at most."));
	}
	return result;
}

/**
 * Computes the skeleton of any triangle mesh: checks it as checkedSurface() does, in single precision
 * where that is enough, see SurfaceRounding, and makes it solid as parameters.repair says, see
 * solidSurface(); then as above.
 * @param points    vertices, mesh units.
 * @param triangles corners as indices into `points`.
 * @throws as above; InvalidInput if they do not bound a solid.
 */
inline Skeletonization skeletonize(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Parameters& parameters = Parameters(),
	const Progress& progress = Progress(), const Observer& observer = Observer(),
	const RefineParameters& refinement = RefineParameters())
{
	parameters.check();
	detail::PhaseClock clock(observer);
	SolidSurface solid = solidSurface(roundedCoordinates(points, progress.part(0, 0.002)),
		triangles, {parameters.repair, parameters.minComponent, true}, progress.part(0.002, 0.02));
	CheckedSurface& checked = solid.surface;
	if (observer.onNote)
		for (const std::string& text : checked.notes)
			observer.onNote(text);
	const double seconds = clock.end(Phase::Check);

	SurfaceInput input {std::make_shared<const SurfaceMesh>(std::move(checked.mesh))};
	input.hollow = solid.report.leftOut.hollow;
	Skeletonization result =
		skeletonize(input, parameters, progress.part(0.02, 1), observer, refinement);
	result.seconds.check = seconds;
	result.solid = solid.report;
	std::vector<int> node;
	node.reserve(checked.vertexOfInput.size());
	for (int v : checked.vertexOfInput)
		node.push_back(v < 0 ? -1 : result.node[size_t(v)]);
	result.node = std::move(node);
	return result;
}

} // namespace vcg::tri::mcf

#endif
