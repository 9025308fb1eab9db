// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "convergence.h"
#include "filter_support.h"
#if MCFSKEL_SHEETS
#include "sheet_choice.h"
#endif

#include <skeleton/skeletonize.h>
#include <skeleton/support.h>

#include <optional>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The numbers of a run, for Python and for the log.
Results resultsOf(const mcf::Skeletonization& run, [[maybe_unused]] bool keepSheets)
{
	Results results = stageResults(*run.stage);
#if MCFSKEL_SHEETS
	if (run.sheets)
		results.merge(sheetResults(*run.sheets));
	else
		results.merge(
			keepSheets ? sheetResults(withoutSheets(run.curve)) : curveResults(run.curve));
#else
	results.merge(curveResults(run.curve));
#endif
	results["refined"] = run.refined;
	results["bridges"] = run.bridges.count;
	results["seconds_resample"] = run.seconds.resample;
	results["seconds_poles"] = run.seconds.poles;
	results["seconds_contraction"] = run.seconds.contraction;
	results["seconds_collapse"] = run.seconds.collapse;
	results["seconds_refine"] = run.seconds.refine;
	return results;
}

Results fullSkeletonize(FilterRun& run)
{
	mcf::Parameters parameters;
	parameters.resample = run.parameters.flag("resample");
	parameters.refine = run.parameters.flag("refine");
	parameters.detail = run.parameters.real("detail");
#if MCFSKEL_SHEETS
	readSheets(run.parameters, parameters);
#endif
	readResampling(run.parameters, parameters);
	readAdaptive(run.parameters, parameters);
	readFlow(run.parameters, parameters);
	parameters.poleMethod = readPoleMethod(run.parameters);
	parameters.maxIterations = run.parameters.integer("max_iterations");
	parameters.repair = readRepair(run.parameters);
	parameters.minComponent = run.parameters.real("min_component");
	parameters.join = run.parameters.flag("join");
	if (run.parameters.integer("preset") == 1)
		parameters.apply(mcf::Preset::Paper);
	parameters.check();
	const int keepStages = run.parameters.integer("keep_stages");
	if (keepStages < 0)
		throw mcf::InvalidParameter("Parameter keep_stages must be at least 0.");

	refuseStage(run);
	const SolidLayer solid = readSolid(run.layer(),
		{parameters.repair, parameters.minComponent, true}, run.progress.part(0, 0.02));
	const SurfaceLayer& read = solid.surface;
	logNotes(run, read);
	mcf::SurfaceInput surfaceInput {read.mesh, selectionToHold(run, read)};
	surfaceInput.hollow = read.hollow;
	if (!parameters.resample && !solid.isRepaired())
		surfaceInput.poles = readPoles(run.layer(), read, run.progress.cancelOnly());
	if (surfaceInput.poles)
		run.log("Taking the medial poles that the layer carries.");

	std::optional<KeptStages> kept(std::in_place); // the last one is always among them
	std::optional<KeptStages::FlowShare> share;
	mcf::Observer observer;
	observer.onNote = noteLog(run);
	observer.onFigures = [&](const mcf::StageFigures& figures) { run.log(stageLine(figures)); };
	if (keepStages > 0) {
		observer.every = keepStages;
		observer.onStage = [&](mcf::Stage stage) {
			kept->add(std::make_shared<const mcf::Stage>(std::move(stage)));
		};
		observer.onStartOver = [&] { kept.emplace(); };
		observer.onPhase = [&](mcf::Phase ended) {
			if (ended == mcf::Phase::Poles)
				share.emplace();
			else
				share.reset();
		};
	}
	const mcf::Skeletonization result =
		mcf::skeletonize(surfaceInput, parameters, run.progress.part(0.02, 0.99), observer);
	if (kept->empty() || kept->last()->iteration != result.stage->iteration)
		kept->add(result.stage);

	DocumentEdit edit(run.document);
	const QString name = baseName(run.layer());
	MeshModel* made = nullptr;
	SurfaceLayer contracted = read;
	// Where the shape is too thin for its resampled surface, the input itself was contracted.
	const bool isResampled = result.surface != surfaceInput.mesh;
	const bool isInput = !isResampled && !solid.isRepaired();
	if (!isInput) {
		made = &edit.addSurface(run.layer(), name + (isResampled ? "_resampled" : "_solid"),
			*result.surface, run.progress.cancelOnly());
		contracted = compactSurface(result.surface, read.hollow, read.soundWith);
	}
	const SurfaceLink link = linkTo(made ? *made : run.layer(), contracted);
	addStages(edit, run, *kept, link, run.progress.part(0.99, 1));
	MeshModel& input = run.layer();
	MeshModel& surface = made ? *made : input;
#if MCFSKEL_SHEETS
	if (result.sheets)
		edit.addMesoSkeleton(input, name + "_skeleton", result.sheets->skeleton);
	else
#endif
		edit.addCurve(input, name + "_skeleton", {result.curve, link, surface.label()});
	if (!surfaceInput.poles)
		edit.writePoles(surface, contracted, result.poles);
	edit.writeNodes(surface, *contracted.vertexOfSlot, result.nodeOfSurface());
	if (!isInput)
		edit.writeNodes(input, *read.vertexOfSlot, result.node);
	Results results = resultsOf(result, parameters.keepSheets);
	logIfNotConverged(run, *result.stage, "Raise max_iterations.");
	results.merge(repairResults(solid.report));
	edit.commit();
	return results;
}

} // namespace

FilterSpec fullSkeletonizeFilter()
{
	const mcf::Parameters defaults;
	std::vector<ParameterSpec> parameters = {
		{ParameterKind::Boolean, "resample", double(defaults.resample), "Resample first",
			"Covers the surface with even triangles first, as in the paper. Without, the skeleton is "
			"only as good as the triangles of the input. On a coarse surface, where edges are longer "
			"than 4 % of the diagonal and than the shape is thick, they are halved for the contraction, "
			"so that the skeleton stays inside; not with held vertices or sheets."},
		repairParameter(),
		ParameterSpec {ParameterKind::Real, "min_component", defaults.minComponent,
			"Smallest piece",
			"Pieces whose volume is a smaller part of the largest one's get no skeleton; at least 0, less "
			"than 1."}
			.asAdvanced(),
		ParameterSpec {ParameterKind::Boolean, "join", double(defaults.join), "Join the pieces",
			"Joins the skeletons of all pieces over the narrowest gaps; nodes in the middle of these "
			"bridges have 1 as <i>mcfskel_bridge</i>."}
			.asAdvanced(),
		targetLengthParameter(),
		resampleIterationsParameter().asAdvanced(),
		denoiseParameter(),
	};
	for (const ParameterSpec& adaptive : adaptiveParameters())
		parameters.push_back(adaptive);
	for (const ParameterSpec& weight : weightParameters())
		parameters.push_back(weight);
	parameters.push_back(epsilonParameter());
	parameters.push_back(splitAngleParameter());
	parameters.push_back({ParameterKind::Integer, "keep_stages", 0, "Keep every k-th stage",
		"Every k-th meso-skeleton becomes a layer NAME_meso_K; 0 keeps the last one only."});
	parameters.push_back(ParameterSpec {ParameterKind::Integer, "max_iterations",
		double(defaults.maxIterations), "Maximum iterations",
		"The contraction stops after this many iterations even if it has not converged; it usually "
		"does after 10 to 40."}
							 .asAdvanced());
	parameters.push_back(poleMethodParameter().asAdvanced());
	parameters.push_back(ParameterSpec {ParameterKind::Choice, "preset",
		double(mcf::Preset::Default), "Preset",
		"'paper': the paper's algorithm and nothing else, to compare with. 'pole_method', 'denoise', "
		"'adaptive' and 'refine' are then not used; it is slower, and curves are rougher.",
		{"default", "paper"}}.asAdvanced());
	parameters.push_back({ParameterKind::Boolean, "refine", double(defaults.refine),
		"Refine the skeleton",
		"Goes beyond the paper at the end: removes spurs, samples the branches evenly, centres and "
		"smooths them, extends the tips to the ends of their features, and grows branches into limbs "
		"that the curve lacks."});
	parameters.push_back(detailParameter(defaults.detail));
	parameters.push_back(fixSelectedParameter());
#if MCFSKEL_SHEETS
	parameters.push_back(keepSheetsParameter());
	parameters.push_back(sheetThresholdParameter());
#endif
	return {"generate_curve_skeleton_mcf", menuName("Full Skeletonize"),
		helpPage(
			"Computes the curve skeleton (centreline, centerline; elsewhere also medial axis or "
			"thinning): a graph in the middle of the shape, with a component for each of its components "
			"and a cycle for each handle. New layers: the resampled surface, the last (or every k-th) "
			"stage of the contraction, and the skeleton, whose quality is the local thickness; the attribute "
			"<i>mcfskel_node</i> of the surfaces is the skeleton vertex of each of their vertices."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER, parameters, fullSkeletonize};
}

} // namespace mcfskel
