// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: Fig. 4 of the paper, top to bottom: from a closed surface to its skeleton.

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
#include <skeleton/graph/replaced_parts.h>
#include <skeleton/input/check_input.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_rounding.h>
#include <skeleton/poles/poles.h>
#include <skeleton/refine/refine.h>
#include <skeleton/repair/make_solid.h>
#include <skeleton/resample/resampled_surface.h>
#include <skeleton/sheets/collapse_with_sheets.h>
#include <skeleton/spatial/nearest_points.h>
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

/// The phases of a run: the lines of Fig. 4, and Check and Refine, which the paper does not have.
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

/// Callbacks invoked during skeletonize(), beside the contraction's. Unset ones cost nothing.
struct Observer : StageObserver
{
	/// One sentence on what was repaired, found, or decided.
	NoteCallback onNote;
	/// A phase has ended, or was left out.
	std::function<void(Phase)> onPhase;
	/// The contraction starts over, see skeletonize(): the stages so far are to be discarded.
	std::function<void()> onStartOver;
};

/// A surface that has been checked, and data that belong to it.
struct SurfaceInput
{
	/// As checkedSurface() makes it: closed, oriented, compact.
	std::shared_ptr<const SurfaceMesh> mesh;
	/// 1 for the vertices that are to stay where they are; empty if there are none.
	std::vector<char> held = {};
	/// The medial poles of all vertices; null: computed. Ignored if the surface is resampled.
	std::shared_ptr<const PoleSet> poles = nullptr;
	/// The surface with its cavities, see LeftOutPieces::hollow; null if there are none.
	std::shared_ptr<const SurfaceMesh> hollow = nullptr;
};

/// What skeletonize() returns.
struct Skeletonization
{
	/// The skeleton, unless `sheets` is set.
	CurveSkeleton curve;
	/// The skeleton where sheets were kept.
	std::optional<SheetCollapse> sheets;
	/// For each vertex of the input its node of the skeleton, -1 for vertices that no face uses.
	std::vector<int> node;
	/// The surface that was contracted, the resampled one or the input; the skeleton's own `node`
	/// refers to it. Single components may have a curve of the input, see skeletonize().
	std::shared_ptr<const SurfaceMesh> surface;
	/// Its medial poles.
	std::shared_ptr<const PoleSet> poles;
	/// The last stage of the contraction; see figuresOf() for iterations and convergence.
	std::shared_ptr<const Stage> stage;
	/// The noise of the input; not measured if it is not resampled.
	NoiseReport noise;
	/// The components whose curve was cut when it was brought inside.
	CutCurves cut;
	/// Fraction of the components with a refined curve that is not cut, see CutCurves; 0 without
	/// Parameters::refine.
	double refined = 0;
	/// What became of each component in the refinement.
	RefineReport refinement;
	/// What was done to the triangles so that they bound a solid.
	SolidReport solid;
	/// The fraction of the skeleton that lies in cavities, see partOutside().
	double inCavities = 0;
	/// The bridges between the skeletons of pieces, with Parameters::join.
	Bridges bridges;
	PhaseSeconds seconds;

	/// The components whose curve is cut or not refined, ascending.
	std::vector<int> doubtful() const
	{
		std::vector<int> components = cut.which;
		for (const RefineReport::Kept& kept : refinement.kept)
			components.push_back(kept.component);
		std::sort(components.begin(), components.end());
		components.erase(std::unique(components.begin(), components.end()), components.end());
		return components;
	}

	/// Sets `refined` from the refinement and the cut curves.
	void countRefined()
	{
		refined = cut.components == 0
			? refinement.fraction()
			: double(refinement.components - int(doubtful().size())) / refinement.components;
	}

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

/// skeletonize() in one attempt, on the surface resampled or not as the parameters say.
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
	const MeasuredSurface measured(surface, progress.cancelOnly());
	if (!result.poles)
		result.poles = std::make_shared<const PoleSet>(
			medialPoles(measured, parameters.poleMethod, progress.part(0.13, 0.23)));
	result.seconds.poles = clock.end(Phase::Poles);

	BoundedField field; // that the flow and the refinement follow
	if (parameters.adaptive)
		field = boundedField(measured, *result.poles, parameters.relativeLength,
			boundOfEpsilon(measured, sharedAmong(parameters, measured.diagonals())), nullptr,
			progress.part(0.23, 0.24));
	Stage start = startOfFlow(measured, *result.poles, held, parameters, progress.part(0.24, 0.25),
		observer.onNote, &field);
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
		const bool areBalls = parameters.poleMethod == PoleMethod::Balls;
		Refinement refined = refineChecked(result.curve, measured, scaled, progress.part(0.9, 0.99),
			areBalls ? result.poles.get() : nullptr, areBalls ? &field : nullptr);
		result.curve = std::move(refined.skeleton);
		result.refinement = refined.report;
		result.countRefined();
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
 * How much of a shape a curve does not describe: the fraction of the length of its limbs, area over
 * radius, that is farther from the curve than three local thicknesses.
 * @param poles of all vertices of the surface. @return in [0, 1]; 1 for a curve without nodes.
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
		const double area = surface.doubleAreaVector(f).Norm();
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
 * Whether `asItIs`, the skeleton of a surface without resampling, replaces `resampled`, which could
 * not be refined: where more of its components are refined or, if as many are, where it is less
 * than half as long. Of two of similar length it does not where it describes less of the shape, as
 * of limbs whose triangles are many times as long as thick, while the other one describes nearly
 * all of it and hardly leaves it.
 * @param surface without resampling. @throws Cancelled
 */
inline bool isBetter(const SurfaceMesh& surface, const Skeletonization& asItIs,
	const Skeletonization& resampled, const Progress& progress)
{
	constexpr double muchShorter = 0.5, maxOutside = 0.01, maxLeftOut = 0.05, more = 0.01;
	const bool isMuchShorter =
		statistics(asItIs.curve).length < muchShorter * statistics(resampled.curve).length;
	if (!isMuchShorter
		&& double(resampled.refinement.nodesOutside)
			<= maxOutside * double(resampled.curve.position.size())) {
		const double leftOut = partLeftOut(surface, *asItIs.poles, resampled.curve, progress);
		if (leftOut <= maxLeftOut
			&& partLeftOut(surface, *asItIs.poles, asItIs.curve, progress) > leftOut + more)
			return false;
	}
	return asItIs.refined != resampled.refined ? asItIs.refined > resampled.refined : isMuchShorter;
}

/// The part of the progress bar for the first attempt: a second one is seldom needed.
constexpr double once = 0.97;

/// A second attempt: its stages are kept, and reach the observer only if its result is taken.
class Alternative
{
public:
	explicit Alternative(const Observer& observer) : observer(observer) {}

	/// The observer to give to the second attempt.
	Observer listener()
	{
		Observer result;
		result.every = observer.every;
		if (observer.onStage)
			result.onStage = [&](Stage stage) { stages.push_back(std::move(stage)); };
		result.onStartOver = [&] { stages.clear(); };
		return result;
	}

	/// Hands the stages over.
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

/// The second attempt, without resampling, is made on surfaces of at most this many vertices.
constexpr int maxVerticesAsItIs = 100000;

/// One component of a surface as a mesh of its own.
struct SingleComponent
{
	/// For each vertex of `mesh` its id in the surface.
	std::vector<int> ids;
	std::shared_ptr<const SurfaceMesh> mesh;
};

/// @throws Cancelled
inline SingleComponent singleComponent(
	const SurfaceMesh& surface, const ComponentVertices& vertices, int c, const Progress& progress)
{
	SingleComponent own = {vertices.ids[size_t(c)], nullptr};
	ComponentSurface alone(surface, own.ids, vertices.place, progress);
	own.mesh =
		std::make_shared<const SurfaceMesh>(std::move(alone.position), alone.triangles, progress);
	return own;
}

/// What isBetter() needs of one component: its curve, and how many of its nodes are outside.
/// @param ofCurve for each node of the curve its component.
inline Skeletonization partOfComponent(
	const Skeletonization& result, const std::vector<int>& ofCurve, int c)
{
	Skeletonization part;
	std::vector<char> isGone;
	for (int of : ofCurve)
		isGone.push_back(of != c);
	part.curve = withReplacedParts(result.curve, isGone, {}).curve;
	for (const RefineReport::Kept& kept : result.refinement.kept)
		if (kept.component == c)
			part.refinement.nodesOutside = kept.nodesOutside;
	return part;
}

/**
 * Of a surface of several components, contracts again, without resampling, those whose curve could
 * not be refined, and takes the curves that are better, see isBetter(). The stages, the poles and
 * the surface stay those of the resampling.
 * @param asItIs    the parameters, without resampling.
 * @param doubtful  components of the resampled surface, see Skeletonization::doubtful().
 * @param component of each vertex of the resampled surface; there are `components`.
 * @return whether the components of both surfaces pair off; if not, nothing is changed.
 * @throws Cancelled
 */
inline bool replaceThinCurves(Skeletonization& result, const SurfaceInput& input,
	const Parameters& asItIs, const std::vector<int>& doubtful, const std::vector<int>& component,
	int components, const Progress& progress, const Observer& observer,
	const RefineParameters& refinement)
{
	const Progress begin = progress.cancelOnly();
	int ofInput = 0;
	const std::vector<int> componentOfInput = connectedComponents(*input.mesh, &ofInput, begin);
	const std::vector<int> ofCurve = componentOfNodes(result.curve, component);
	const std::vector<int> partner =
		resampledFrom(ofCurve, components, result.node, componentOfInput, ofInput, begin);
	if (partner.empty())
		return false;
	const ComponentVertices vertices(component, components, begin);
	const ComponentVertices verticesOfInput(componentOfInput, ofInput, begin);
	struct Replacement
	{
		int component;
		std::vector<int> ids; ///< of its vertices in the input
		Skeletonization other;
	};
	std::vector<Replacement> taken;
	for (size_t i = 0; i < doubtful.size(); ++i) {
		const int c = doubtful[i];
		if (partner[size_t(c)] < 0)
			continue;
		SingleComponent own =
			singleComponent(*input.mesh, verticesOfInput, partner[size_t(c)], begin);
		if (own.mesh->vertexCount() > maxVerticesAsItIs)
			continue;
		try {
			const Progress part = progress.part(
				double(i) / double(doubtful.size()), double(i + 1) / double(doubtful.size()));
			Skeletonization other =
				skeletonizeOnce({own.mesh}, asItIs, part, Observer(), refinement);
			result.seconds += other.seconds;
			if (isBetter(*own.mesh, other, partOfComponent(result, ofCurve, c), begin))
				taken.push_back({c, std::move(own.ids), std::move(other)});
		}
		catch (const SolverError&) {
			// Then there is nothing to choose from.
		}
	}
	if (taken.empty())
		return true;
	std::vector<char> isReplaced(size_t(components), 0), isGone;
	std::vector<const CurveSkeleton*> curves;
	for (const Replacement& one : taken) {
		isReplaced[size_t(one.component)] = 1;
		curves.push_back(&one.other.curve);
	}
	for (int c : ofCurve)
		isGone.push_back(c >= 0 && isReplaced[size_t(c)]);
	ReplacedParts replaced = withReplacedParts(result.curve, isGone, curves);
	result.curve = std::move(replaced.curve);
	const SurfaceMesh& surface = *result.surface;
	for (size_t i = 0; i < taken.size(); ++i) {
		const Skeletonization& other = taken[i].other;
		const int c = taken[i].component, first = replaced.first[i];
		const std::vector<int>& ids = vertices.ids[size_t(c)];
		std::vector<Point3d> places;
		for (int v : ids)
			places.push_back(surface.position[v]);
		const std::vector<int> nearest =
			nearestPoints(other.surface->position, places, meanEdgeLength(*other.surface), begin);
		for (size_t v = 0; v < ids.size(); ++v)
			result.curve.node[size_t(ids[v])] = first + other.node[size_t(nearest[v])];
		std::vector<int>& cut = result.cut.which;
		cut.erase(std::remove(cut.begin(), cut.end(), c), cut.end());
		if (other.cut.components > 0)
			cut.push_back(c);
		if (other.refinement.refined > 0)
			result.refinement = result.refinement.withRefined(c);
	}
	result.cut.components = int(result.cut.which.size());
	result.countRefined();
	result.node = transferredNodes(surface, result.curve.node, *input.mesh, begin);
	for (size_t i = 0; i < taken.size(); ++i)
		for (size_t v = 0; v < taken[i].ids.size(); ++v)
			result.node[size_t(taken[i].ids[v])] = replaced.first[i] + taken[i].other.node[v];
	if (observer.onNote)
		observer.onNote(std::to_string(taken.size()) + " of " + std::to_string(components)
			+ (taken.size() == 1
					? " components is too thin for its resampled surface: its skeleton is that of the "
					  "surface as it is."
					: " components are too thin for their resampled surfaces: their skeletons are those "
					  "of the surface as it is."));
	return true;
}

/// skeletonize() with the second attempt for what is too thin for its resampled surface.
inline Skeletonization skeletonizeThin(const SurfaceInput& input, const Parameters& given,
	const Progress& progress, const Observer& observer, const RefineParameters& refinement)
{
	Skeletonization result =
		skeletonizeOnce(input, given, progress.part(0, once), observer, refinement);
	const bool isStopped =
		!result.stage->isDone() && given.maxIterations < Parameters().maxIterations;
	const bool isDoubtful = given.resample && given.refine && !result.sheets && input.held.empty()
		&& result.refined < 1 && !isStopped;
	if (!isDoubtful)
		return result;
	Parameters asItIs = given;
	asItIs.resample = asItIs.keepSheets = false;
	int components = 0;
	const std::vector<int> component =
		connectedComponents(*result.surface, &components, progress.cancelOnly());
	const std::vector<int> doubtful = result.doubtful();
	if (int(doubtful.size()) < components
		&& replaceThinCurves(result, input, asItIs, doubtful, component, components,
			progress.part(once, 1), observer, refinement))
		return result;
	if (input.mesh->vertexCount() > maxVerticesAsItIs)
		return result;
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
 * A skeleton with sheets, or without where they would leave a thicket of curves: where no sheet
 * could be kept, or where the curves beside the sheets are longer than 1.25 times those of the
 * shape contracted without sheets, since sheets are to replace curves. Complexity: as
 * skeletonize(), twice where the curves are long.
 */
inline Skeletonization skeletonizeWithSheets(const SurfaceInput& input, const Parameters& given,
	const Progress& progress, const Observer& observer, const RefineParameters& refinement)
{
	constexpr double doubtful = 3;   // diagonals of the components
	constexpr double thicket = 1.25; // times the length without sheets
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
 * Where a shape is thinner than the edges of its resampling, the resampled surface loses parts or
 * crosses itself, and its curve cannot be refined, since that would leave the surface. Then the
 * input is contracted as well, without resampling, and the better curve is taken, see
 * detail::isBetter(), with a note. If some components could be refined, only the others are
 * contracted again. Sheets that would leave far longer curves beside them are dropped, see
 * detail::skeletonizeWithSheets().
 *
 * @param parameters all of them are read; the default epsilon is larger for more than 50
 *                   components, see sharedAmong(). A shape that is too thin to resample adaptively,
 *                   see fieldOfResampling(), is not contracted and refined adaptively either.
 * @param refinement of refine(), where parameters.refine is set; `relativeLength` and `detail` are
 *                   those of `parameters`, and `adaptive` holds only if it is set in both.
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
			note(detail::sentence(3, 100 * result.inCavities,
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
 * Computes the skeleton of any triangle mesh: checks it as checkedSurface() does, in single
 * precision where that is enough, see SurfaceRounding, and repairs it as parameters.repair says,
 * see solidSurface(); then as above.
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
	SolidSurface solid =
		solidSurface(roundedCoordinates(points, triangles, progress.part(0, 0.002)), triangles,
			{parameters.repair, parameters.minComponent, true}, progress.part(0.002, 0.02));
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
