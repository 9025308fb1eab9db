// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "common.h"
#include "sheets.h"
#include "skeletons.h"

#include <skeleton/collapse_to_curve.h>
#include <skeleton/errors.h>
#include <skeleton/held_vertices.h>
#include <skeleton/poles.h>
#include <skeleton/refine.h>
#include <skeleton/skeletonize.h>

#include <optional>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// What the stages of one run leave behind.
struct Pipeline
{
	SurfaceLayer input;
	/// The surface that was contracted: resampled, or the input itself.
	SurfaceLayer surface;
	std::shared_ptr<const mcf::PoleSet> poles;
	bool newPoles = false;
	/// 1 for the vertices of `surface` that are held; empty if there are none.
	std::vector<char> held;
	/// The stages to keep as layers, the last one always among them.
	KeptStages kept;
	mcf::CurveSkeleton skeleton;
	/// Instead of `skeleton` where sheets are kept.
	std::optional<mcf::SheetCollapse> sheets;
	Results seconds;

	/// For each vertex of `surface` its node of the skeleton.
	const std::vector<int>& nodes() const { return sheets ? sheets->skeleton.node : skeleton.node; }
};

void contractAll(FilterRun& run, const mcf::Parameters& parameters, const mcf::Progress& progress,
	Pipeline& pipeline)
{
	const int keepStages = run.parameters.integer("keep_stages");
	mcf::StageObserver observer;
	observer.onFigures = [&](const mcf::StageFigures& figures) { run.log(stageLine(figures)); };
	if (keepStages > 0) {
		observer.every = keepStages;
		observer.onStage = [&](mcf::Stage stage) {
			pipeline.kept.add(std::make_shared<const mcf::Stage>(std::move(stage)));
		};
	}
	mcf::Stage start = startOfFlow(run, parameters, *pipeline.surface.mesh, *pipeline.poles,
		pipeline.held, progress.part(0, 0.03));
	std::optional<KeptStages::FlowShare> share;
	if (keepStages > 0)
		share.emplace();
	mcf::Stage end =
		mcf::contractToSkeleton(std::move(start), parameters, progress.part(0.03, 1), observer);
	if (!end.converged)
		run.log(
			QString("The contraction has not converged after %1 iterations.").arg(end.iteration));
	if (pipeline.kept.empty() || pipeline.kept.last()->iteration != end.iteration)
		pipeline.kept.add(std::make_shared<const mcf::Stage>(std::move(end)));
}

void skeletonize(FilterRun& run, const mcf::Parameters& parameters, Pipeline& pipeline)
{
	const auto note = [&](const char* what, double seconds) {
		pipeline.seconds[std::string("seconds_") + what] = seconds;
	};
	pipeline.input = readSurface(run.layer(), run.progress.part(0, 0.02));
	logNotes(run, pipeline.input);
	pipeline.held = selectionToHold(run, pipeline.input);

	Stopwatch watch;
	pipeline.surface = parameters.resample
		? resampledSurface(run, *pipeline.input.mesh, parameters, run.progress.part(0.02, 0.15))
		: pipeline.input;
	if (parameters.resample && !pipeline.held.empty())
		pipeline.held = mcf::selectionOnResampled(*pipeline.input.mesh, pipeline.held,
			*pipeline.surface.mesh, run.progress.part(0.15, 0.15));
	note("resample", watch.lap());

	if (!parameters.resample)
		pipeline.poles = readPoles(run.layer(), pipeline.input, run.progress.part(0.15, 0.15));
	pipeline.newPoles = !pipeline.poles;
	if (pipeline.newPoles)
		pipeline.poles = std::make_shared<const mcf::PoleSet>(mcf::medialPoles(
			*pipeline.surface.mesh, parameters.poleMethod, run.progress.part(0.15, 0.25)));
	else
		run.log("Taking the medial poles that the layer carries.");
	note("poles", watch.lap());

	contractAll(run, parameters, run.progress.part(0.25, 0.85), pipeline);
	note("contraction", watch.lap());

	const mcf::Progress progress = run.progress.part(0.85, 0.9);
	if (pipeline.kept.last()->hasSheets())
		pipeline.sheets =
			collapseWithSheets(run, *pipeline.kept.last(), parameters.epsilon, progress);
	else
		pipeline.skeleton =
			mcf::collapseToCurve(*pipeline.kept.last(), parameters.epsilon, progress);
	note("collapse", watch.lap());
	if (parameters.refine && pipeline.sheets)
		run.log("The skeleton is not refined: that is for curves without sheets.");
	else if (parameters.refine && !pipeline.held.empty())
		run.log("The skeleton is not refined: that would move it off the vertices that are held.");
	else if (parameters.refine)
		pipeline.skeleton = mcf::refine(pipeline.skeleton, *pipeline.surface.mesh,
			mcf::RefineParameters(), run.progress.part(0.9, 0.98));
	note("refine", watch.lap());
}

Results run(FilterRun& run)
{
	mcf::Parameters parameters;
	parameters.resample = run.parameters.flag("resample");
	parameters.refine = run.parameters.flag("refine");
	readSheets(run.parameters, parameters);
	readResampling(run.parameters, parameters);
	readFlow(run.parameters, parameters);
	parameters.poleMethod = readPoleMethod(run.parameters);
	parameters.maxIterations = run.parameters.integer("max_iterations");
	parameters.check();
	if (run.parameters.integer("keep_stages") < 0)
		throw mcf::InvalidParameter("Parameter keep_stages must be at least 0.");
	Pipeline pipeline;
	skeletonize(run, parameters, pipeline);

	const std::vector<int> inputNodes = parameters.resample
		? carriedOver(*pipeline.surface.mesh, pipeline.nodes(), *pipeline.input.mesh,
			run.progress.part(0.98, 0.99))
		: std::vector<int>();

	DocumentEdit edit(run.document);
	MeshModel& input = run.layer();
	const QString name = baseName(input);
	MeshModel* surface = &input;
	if (parameters.resample)
		surface = &edit.addSurface(
			input, name + "_resampled", *pipeline.surface.mesh, run.progress.part(0.99, 0.99));
	const SurfaceLink link = linkTo(*surface, pipeline.surface);
	addStages(edit, input, pipeline.kept, link, run.progress.part(0.99, 1));
	if (pipeline.sheets)
		edit.addMesoSkeleton(input, name + "_skeleton", pipeline.sheets->skeleton);
	else
		edit.addCurve(input, name + "_skeleton", {pipeline.skeleton, link, surface->label()});
	if (pipeline.newPoles)
		edit.writePoles(*surface, pipeline.surface, pipeline.poles);
	edit.writeNodes(*surface, *pipeline.surface.vertexOfSlot, pipeline.nodes());
	if (parameters.resample)
		edit.writeNodes(input, *pipeline.input.vertexOfSlot, inputNodes);
	edit.commit();

	Results results = stageResults(*pipeline.kept.last());
	if (pipeline.sheets)
		results.merge(sheetResults(*pipeline.sheets));
	else
		results.merge(parameters.keepSheets ? sheetResults(withoutSheets(pipeline.skeleton))
											: curveResults(pipeline.skeleton));
	results.insert(pipeline.seconds.begin(), pipeline.seconds.end());
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
		targetLengthParameter(),
		resampleIterationsParameter().asAdvanced(),
		denoiseParameter(),
	};
	for (const ParameterSpec& weight : weightParameters())
		parameters.push_back(weight);
	parameters.push_back(epsilonParameter());
	parameters.push_back(splitAngleParameter());
	parameters.push_back({ParameterKind::Integer, "keep_stages", 0, "Keep every k-th stage",
		"Every k-th meso-skeleton becomes a layer NAME_meso_K; 0 keeps the last one only."});
	parameters.push_back(ParameterSpec {ParameterKind::Integer, "max_iterations",
		double(defaults.maxIterations), "Most iterations",
		"The contraction stops after this many iterations even if it has not converged; it usually "
		"does after 10 to 40."}
							 .asAdvanced());
	parameters.push_back(poleMethodParameter().asAdvanced());
	parameters.push_back({ParameterKind::Boolean, "refine", double(defaults.refine),
		"Refine the skeleton",
		"Goes beyond the paper at the end: removes spurs, samples the branches evenly, centres and "
		"smooths them, extends the tips to the ends of their features, and grows branches into limbs "
		"that the curve lacks. Without, the skeleton is the paper's own. Also a filter of its own."});
	parameters.push_back(fixSelectedParameter());
	parameters.push_back(keepSheetsParameter());
	parameters.push_back(sheetThresholdParameter());
	return {"generate_curve_skeleton_mcf", menuName("Full Skeletonize"),
		helpPage(
			"Computes the curve skeleton of a closed surface: a graph of nodes and edges in the "
			"middle of the shape, with one component for each of its components and one cycle for "
			"each of its handles. Resamples the surface, finds its medial poles, contracts it until "
			"no volume is left, collapses the result to curves and refines these; each is a filter of "
			"its own, too.<br><br>"
			"New layers: the resampled surface, the last (or every k-th) stage of the contraction, and "
			"the skeleton. The skeleton's vertex quality is the local thickness; the vertex attribute "
			"<i>mcfskel_node</i> of the surfaces tells the skeleton vertex of each of their "
			"vertices."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER, parameters, run};
}

} // namespace mcfskel
