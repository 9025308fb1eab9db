// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "sheet_choice.h"

#include "filter_support.h"

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
		"sheets, as the medial axis does, higher ones more curves; 1 leaves curves only. Recommended: 0.6 "
		"to 0.9."};
}

void readSheets(const ParameterValues& values, mcf::Parameters& parameters)
{
	parameters.keepSheets = values.flag("keep_sheets");
	parameters.sheetThreshold = values.real("sheet_threshold");
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
