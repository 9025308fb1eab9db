// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../io/files.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/skeleton_files.h>
#include <skeleton/support.h>

#include <QFileInfo>

#include <numeric>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results loadStage(FilterRun& run, const mcf::PlyFile& ply, const QString& name)
{
	mcf::StageFile file = mcf::readStagePly(ply, run.progress.part(0.3, 0.5));
	const auto stage = std::make_shared<const mcf::Stage>(std::move(file.stage));
	const SurfaceLink link =
		linkTo(run.document, file.surfaceFingerprint, std::move(file.vertexOfSlot));
	if (link.layerId < 0)
		run.log("The surface that the stage comes from is not among the layers: no layer gets its "
				"correspondence.");
	const StageFields fields = stageFields(*stage, run.progress.part(0.5, 0.75));
	DocumentEdit edit(run.document);
	edit.addStage(
		stageLabel(baseName(name), *stage), stage, fields, link, run.progress.part(0.75, 1));
	edit.writeNodes(link, stage->node);
	const Results results = stageResults(*stage);
	edit.commit();
	return results;
}

Results loadSkeleton(FilterRun& run, const mcf::PlyFile& ply, const QString& name)
{
	mcf::SkeletonFile file = mcf::readSkeletonPly(ply);
	for (const std::string& warning : file.warnings)
		run.log(QString::fromStdString(warning));
	if (file.skeleton.position.empty())
		throw FileError("The file has no nodes.");
	CurveLayer curve;
	if (!file.skeleton.node.empty()) {
		std::vector<int> same(file.skeleton.node.size());
		std::iota(same.begin(), same.end(), 0);
		curve.surface = linkTo(run.document, file.surfaceFingerprint, std::move(same));
	}
	curve.skeleton = std::move(file.skeleton);
	const Results results = curveResults(curve.skeleton);
	DocumentEdit edit(run.document);
	edit.addCurve(name, curve, file.diagonal);
	edit.commit();
	return results;
}

Results loadStageOrSkeleton(FilterRun& run)
{
	const QString name = requiredName(run.parameters.text("file"), "to read");
	try {
		InputFile file(name);
		const mcf::PlyFile ply = mcf::readBinaryPly(file.stream(), run.progress.part(0, 0.3));
		const QString label = QFileInfo(name).completeBaseName();
		return !mcf::isStagePly(ply) && ply.find("edge") ? loadSkeleton(run, ply, label)
														 : loadStage(run, ply, label);
	}
	catch (const mcf::FormatError& error) {
		throw FileError(QString("'%1' cannot be read. %2")
							.arg(QFileInfo(name).fileName(), QString::fromUtf8(error.what()))
							.toStdString());
	}
}

} // namespace

FilterSpec loadStageFilter()
{
	return {"load_stage_mcf", menuName("Load Stage"),
		helpPage(
			"Reads a file that 'Save Stage' wrote into a new layer: a stage of the contraction, on "
			"which 'Contraction Step' and 'Collapse to Curve' continue with the same results, or a "
			"skeleton. If the surface that a stage comes from is among the layers, unchanged, it gets "
			"its correspondence <i>mcfskel_node</i> again."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::FileToOpen, "file", 0, "File", "Name of the PLY file to read.",
			{"*.ply"}}},
		loadStageOrSkeleton, false};
}

} // namespace mcfskel
