// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../io/files.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/skeleton_files.h>
#include <skeleton/support.h>

#include <ostream>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results run(FilterRun& run)
{
	const QString file = requiredName(run.parameters.text("file"), "to write");
	const StageLayer found = readStage(run.layer());
	if (!found && run.layer().cm.fn > 0)
		throw mcf::InvalidInput("The current layer '" + run.layer().label().toStdString()
			+ (hasStageAttributes(run.layer())
					? "' was a stage of the contraction, but its state is gone or its geometry was changed"
					: "' is neither a stage of the contraction nor a skeleton")
			+ ": make a layer NAME_meso_K or NAME_skeleton current.");
	Results results;
	if (found) {
		const mcf::StageFile stage = {
			*found.stage, found.surface.fingerprint, *found.surface.vertexOfSlot};
		writeFile(file, [&](std::ostream& out) { mcf::writeStagePly(out, stage, run.progress); });
		results = stageResults(*found.stage);
	}
	else {
		CurveLayer curve = readCurve(run.layer());
		curve.skeleton.node = curve.nodeOfLayerVertex();
		writeFile(file, [&](std::ostream& out) { mcf::writeSkeletonPly(out, curve.skeleton); });
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
		run};
}

} // namespace mcfskel
