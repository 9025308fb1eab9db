// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "convergence.h"
#include "filter_support.h"
#if MCFSKEL_SHEETS
#include "sheet_choice.h"
#endif

#include <skeleton/pipeline.h>
#include <skeleton/support.h>

#include <optional>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// Where the contraction carries on from, and what has to be written on a surface that starts one.
struct Start
{
	std::shared_ptr<const mcf::Stage> stage;
	PoledSurface surface;
	SurfaceLink link; ///< none yet if the surface is repaired

	bool isRepaired() const { return surface.solid.isChanged(); }
};

Start startOf(FilterRun& run, const mcf::Parameters& parameters)
{
	Start start;
	if (const StageLayer found = readStage(run.layer(), sourcesOf(run))) {
		start.stage = found.stage;
		if (run.parameters.flag("fix_selected")) {
			mcf::Stage held = *found.stage;
			if (const std::vector<char> selected = readSelection(run.layer()); !selected.empty())
				mcf::holdVertices(held, selected);
			if (held.heldCount() == 0)
				throw mcf::InvalidInput(
					"This stage holds no vertex, and none of it is selected: "
					"select the vertices to hold, or leave 'fix_selected' off.");
			start.stage = std::make_shared<const mcf::Stage>(std::move(held));
		}
		start.link = found.surface;
#if MCFSKEL_SHEETS
		if (parameters.keepSheets && !found.stage->hasSheets())
			run.log(
				"This stage keeps no sheets: they are told from the surface, when the first step "
				"is made with 'keep_sheets'.");
#endif
		return start;
	}
	// A former stage that is not closed has lost faces in an edit: it must not be repaired.
	const QString lost = lostState(run.layer());
	const bool wasStage = !lost.isEmpty();
	const mcf::Repair repair = wasStage ? mcf::Repair::Off : readRepair(run.parameters);
	if (wasStage)
		run.log(
			lost + " It is taken as a surface of its own, and its iterations are counted from 1.");
	start.surface =
		surfaceWithPoles(run, parameters.poleMethod, repair, run.progress.part(0, 0.08));
	start.stage = std::make_shared<const mcf::Stage>(mcf::startOfFlow(*start.surface.surface.mesh,
		*start.surface.poles, selectionToHold(run, start.surface.surface), parameters,
		run.progress.part(0.08, 0.1), noteLog(run)));
	if (!start.isRepaired())
		start.link = linkTo(run.layer(), start.surface.surface);
	return start;
}

Results contractionStep(FilterRun& run)
{
	mcf::Parameters parameters;
	readFlow(run.parameters, parameters);
	readAdaptive(run.parameters, parameters);
#if MCFSKEL_SHEETS
	readSheets(run.parameters, parameters);
#endif
	const int steps = run.parameters.integer("steps");
	if (steps < 1)
		throw mcf::InvalidParameter("Parameter steps must be at least 1.");
	parameters.check();
	const Start start = startOf(run, parameters);

	KeptStages stages;
	std::optional<KeptStages::FlowShare> share;
	if (steps > 1)
		share.emplace();
	const mcf::Progress progress = run.progress.part(0.1, 0.95);
	std::shared_ptr<const mcf::Stage> last = start.stage;
	for (int i = 0; i < steps && !last->isDone(); ++i) {
		last = std::make_shared<const mcf::Stage>(
			mcf::step(*last, parameters, progress.part(double(i) / steps, double(i + 1) / steps)));
		run.log(stageLine(mcf::figuresOf(*last)));
		stages.add(last);
	}
	share.reset();
	if (int(stages.size()) < steps)
		run.log(QString("%1: %2 of %3 steps were made.")
					.arg(last->converged ? "The contraction has converged" : surfaceSpreads)
					.arg(stages.size())
					.arg(steps));

	DocumentEdit edit(run.document);
	SurfaceLink link = start.link;
	MeshModel* made = nullptr;
	SurfaceLayer contracted = start.surface.surface;
	if (start.isRepaired()) {
		made = &edit.addSurface(run.layer(), baseName(run.layer()) + "_solid", *contracted.mesh,
			run.progress.cancelOnly());
		edit.writeNodes(run.layer(), *contracted.vertexOfSlot, last->node);
		contracted = compactSurface(contracted.mesh, contracted.hollow, contracted.soundWith);
		link = linkTo(*made, contracted);
	}
	addStages(edit, run, stages, link, run.progress.part(0.95, 1));
	if (start.surface.computed)
		edit.writePoles(made ? *made : run.layer(), contracted, start.surface.poles);
	if (made)
		edit.writeNodes(*made, *contracted.vertexOfSlot, last->node);
	else
		edit.writeNodes(link, last->node);
	Results results = stageResults(*last);
	results.merge(repairResults(start.surface.solid));
	edit.commit();
	return results;
}

} // namespace

FilterSpec contractionStepFilter()
{
	std::vector<ParameterSpec> parameters = weightParameters();
	parameters.push_back(epsilonParameter());
	parameters.push_back(splitAngleParameter());
	for (const ParameterSpec& adaptive : adaptiveParameters())
		parameters.push_back(adaptive);
	parameters.push_back({ParameterKind::Integer, "steps", 1, "Steps",
		"Iterations to make, at least 1; each leaves a layer of its own, NAME_meso_K."});
	parameters.push_back(repairParameter());
	parameters.push_back(fixSelectedParameter());
#if MCFSKEL_SHEETS
	parameters.push_back(keepSheetsParameter());
	parameters.push_back(sheetThresholdParameter());
#endif
	return {"generate_meso_skeleton_mcf", menuName("Contraction Step"),
		helpPage(
			"Contracts the surface by one or more steps of mean curvature flow that is drawn to the "
			"medial poles, and remeshes it locally: a surface becomes a meso-skeleton, part volume, "
			"part sheet, part curve, and in the end a curve. Each step is a new layer; the vertex "
			"quality is the local thickness.<br><br>"
			"Starts from a surface, or carries on from the layer of an earlier step: step by step it "
			"is the same as Full Skeletonize. Lengths refer to the surface that the steps came from. "
			"Third stage of the skeletonization."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER, parameters, contractionStep};
}

} // namespace mcfskel
