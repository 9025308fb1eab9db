// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../io/files.h"
#include "../io/layer_files.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/support.h>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results saveStage(FilterRun& run)
{
	const QString file = requiredName(run.parameters.text("file"), "to write");
	const StageLayer found = readStage(run.layer(), sourcesOf(run));
	if (!found && run.layer().cm.fn > 0) {
		const std::string lost = lostState(run.layer()).toStdString();
		throw mcf::InvalidInput(
			(lost.empty() ? "The current layer '" + run.layer().label().toStdString()
						+ "' is neither a stage of the contraction nor a skeleton."
						  : lost)
			+ " Make a layer NAME_meso_K or NAME_skeleton current.");
	}
	Results results;
	if (found) {
		writeStageFile(file, run.layer(), found, run.progress);
		results = stageResults(*found.stage);
	}
	else {
		const CurveLayer curve = readCurve(run.layer(), sourcesOf(run));
		writeCurveFile(file, run.layer(), curve);
		results = curveResults(curve.skeleton);
	}
	run.log(QString("Wrote '%1'.").arg(file));
	return results;
}

} // namespace

FilterSpec saveStageFilter()
{
	return {"save_stage_mcf", menuName("Save Stage"),
		helpPage(
			"Writes the current layer, a stage of the contraction or a skeleton, to a PLY file with all "
			"that it knows, in full precision: MeshLab's own export keeps neither edges nor the state "
			"of the flow. 'Load Stage' reads it again, in another session as well; the steps that "
			"follow are then the same, bit for bit, as if they had followed at once."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::FileToSave, "file", 0, "File", "Name of the PLY file to write.",
			{"*.ply"}}},
		saveStage};
}

} // namespace mcfskel
