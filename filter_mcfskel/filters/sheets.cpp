// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "sheets.h"

#include "common.h"

#include <skeleton/first_stage.h>
#include <skeleton/held_vertices.h>
#include <skeleton/sheet_marks.h>
#include <skeleton/sheetness.h>

#include <algorithm>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

ParameterSpec keepSheetsParameter()
{
	return {ParameterKind::Boolean, "keep_sheets", 0, "Keep sheets",
		"Flat parts of the shape, such as plates, ears and the wall of a cup, become sheets in the "
		"middle between their two walls instead of curves. The result is one layer of edges (the "
		"curves) and faces (the sheets) with the topology of the shape; it is not refined."};
}

ParameterSpec sheetThresholdParameter()
{
	return {ParameterKind::Real, "sheet_threshold", mcf::Parameters().sheetThreshold,
		"Sheet threshold",
		"With 'keep_sheets': how flat a part must be to become a sheet, from 0 to 1. Flatness is 0 "
		"where the cross-section is round and near 1 between parallel walls. Lower ones leave more "
		"sheets, as the medial axis does, higher ones more curves; 1 leaves curves only. Sane are 0.6 "
		"to 0.9."};
}

void readSheets(const ParameterValues& values, mcf::Parameters& parameters)
{
	parameters.keepSheets = values.flag("keep_sheets");
	parameters.sheetThreshold = values.real("sheet_threshold");
}

mcf::Stage startOfFlow(FilterRun& run, const mcf::Parameters& parameters,
	const mcf::SurfaceMesh& surface, const mcf::PoleSet& poles, const std::vector<char>& held,
	const mcf::Progress& progress)
{
	if (held.empty() && !parameters.keepSheets)
		return mcf::firstStage(surface, parameters, &poles, progress);
	const mcf::Progress begin = progress.part(0, 0);
	mcf::Stage stage = mcf::initialStage({surface, begin}, poles, begin);
	if (parameters.keepSheets) {
		mcf::markSheets(stage, mcf::sheetness(surface, poles, progress.part(0, 0.4)),
			parameters.sheetThreshold, progress.part(0.4, 0.5));
		const auto marked = std::count(stage.sheet.begin(), stage.sheet.end(), 1);
		run.log(stage.hasSheets()
				? QString("Keeping sheets: %1 % of the vertices are flatter than %2.")
					  .arg(100.0 * double(marked) / double(stage.sheet.size()), 0, 'g', 3)
					  .arg(parameters.sheetThreshold)
				: QString("No part of the shape is flatter than %1: there are no sheets to keep.")
					  .arg(parameters.sheetThreshold));
	}
	if (held.empty() && !stage.hasSheets())
		return mcf::firstStage(surface, parameters, &poles, progress.part(0.5, 1));
	if (!held.empty()) {
		mcf::holdVertices(stage, held);
		run.log(QString("Holding %1 vertices where they are.").arg(stage.heldCount()));
	}
	return stage;
}

mcf::SheetCollapse collapseWithSheets(
	FilterRun& run, const mcf::Stage& stage, double epsilon, const mcf::Progress& progress)
{
	mcf::SheetCollapse result = mcf::collapseKeepingSheets(
		stage, mcf::sheetVertices(stage, progress.part(0, 0.3)), epsilon, progress.part(0.3, 1));
	const mcf::BettiNumbers b = result.skeleton.betti();
	run.log(QString("%1 sheets of %2 faces; Betti numbers b0 = %3, b1 = %4, b2 = %5.")
				.arg(result.sheets - result.givenUp)
				.arg(result.skeleton.faces.size())
				.arg(b.b0)
				.arg(b.b1)
				.arg(b.b2));
	if (result.givenUp > 0)
		run.log(
			QString("%1 of %2 sheets became curves: with them as sheets the result would not have "
					"had the topology of the shape.")
				.arg(result.givenUp)
				.arg(result.sheets));
	return result;
}

Results sheetResults(const mcf::SheetCollapse& collapse)
{
	const mcf::MesoSkeleton& skeleton = collapse.skeleton;
	mcf::CurveSkeleton curves;
	curves.position = skeleton.position;
	curves.edges = skeleton.edges;
	Results results = curveResults(curves);
	const mcf::BettiNumbers betti = skeleton.betti();
	results["components"] = results["b0"] = betti.b0;
	results["cycles"] = results["b1"] = betti.b1;
	results["b2"] = betti.b2;
	results["sheet_faces"] = int(skeleton.faces.size());
	results["sheet_area"] = skeleton.sheetArea();
	results["sheets"] = collapse.sheets - collapse.givenUp;
	results["sheets_given_up"] = collapse.givenUp;
	return results;
}

} // namespace mcfskel
