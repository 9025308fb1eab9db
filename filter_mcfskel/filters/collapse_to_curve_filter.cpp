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

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results collapseToCurve(FilterRun& run)
{
	const StageLayer found = readStage(run.layer(), sourcesOf(run));
	if (!found) {
		const std::string lost = lostState(run.layer()).toStdString();
		throw mcf::InvalidInput(
			(lost.empty() ? "The current layer '" + run.layer().label().toStdString()
						+ "' is not a stage of the contraction."
						  : lost)
			+ " Make a layer NAME_meso_K current, or run 'Contraction Step' first.");
	}
	mcf::Parameters parameters;
	parameters.epsilon = readEpsilon(run.parameters);
	const double epsilon = mcf::sharedAmong(parameters, found.stage->diagonal).epsilon;
	logIfNotConverged(
		run, *found.stage, "Run 'Contraction Step' on the stage until it has converged.");
#if MCFSKEL_SHEETS
	if (run.parameters.flag("keep_sheets")) {
		const mcf::SheetCollapse collapse =
			mcf::collapseWithSheets(*found.stage, epsilon, run.progress, noteLog(run));
		DocumentEdit edit(run.document);
		edit.addMesoSkeleton(run.layer(), baseName(run.layer()) + "_skeleton", collapse.skeleton);
		edit.writeNodes(found.surface, collapse.skeleton.node);
		Results results = sheetResults(collapse);
		results["converged"] = found.stage->converged ? 1 : 0;
		edit.commit();
		return results;
	}
#endif
	mcf::CutCurves cut;
	const mcf::CurveSkeleton skeleton =
		mcf::collapseInside(*found.stage, epsilon, run.progress, &cut);
	if (cut.components > 0)
		run.log(QString::fromStdString(cut.text()));

	DocumentEdit edit(run.document);
	const MeshModel* surface = layerOf(run.document, found.surface);
	edit.addCurve(run.layer(), baseName(run.layer()) + "_skeleton",
		{skeleton, found.surface, surface ? surface->label() : QString()});
	edit.writeNodes(found.surface, skeleton.node);
	Results results = curveResults(skeleton);
	results["converged"] = found.stage->converged ? 1 : 0;
	edit.commit();
	return results;
}

} // namespace

FilterSpec collapseToCurveFilter()
{
	return
	{
		"generate_curve_skeleton_from_meso_mcf", menuName("Collapse to Curve"),
			helpPage(
				"Turns a stage of the contraction into a curve skeleton, a new layer of nodes and edges: "
				"collapses its shortest edges until no face is left, without changing its topology. A stage "
				"that has not converged gives a curve that may be off the middle: the log says so, and the "
				"result <i>converged</i> is 0. The "
				"vertex quality is the local thickness of the shape, also kept as "
				"<i>mcfskel_radius</i>.<br><br>"
#if MCFSKEL_SHEETS
				"With <i>keep_sheets</i>, what has contracted to a sheet at this stage, or was kept as one by "
				"the steps, stays a sheet of faces: early stages leave more of them, late ones curves.<br><br>"
#endif
				"The surface layer, if it is still there, gets <i>mcfskel_node</i>: for each vertex the "
				"skeleton vertex that it belongs to. Last stage of the skeletonization."),
			FilterCategory::Remeshing, MeshModel::MM_FACENUMBER,
#if MCFSKEL_SHEETS
			{epsilonParameter(), keepSheetsParameter()},
#else
			{epsilonParameter()},
#endif
			collapseToCurve
	};
}

} // namespace mcfskel
