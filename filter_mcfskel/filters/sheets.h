// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file What the filters share that can keep sheets and hold vertices.

#ifndef MCFSKEL_FILTERS_SHEETS_H
#define MCFSKEL_FILTERS_SHEETS_H

#include "../filters.h"

#include <skeleton/keep_sheets.h>
#include <skeleton/parameters.h>
#include <skeleton/pole_set.h>
#include <skeleton/stage.h>

#include <vector>

namespace mcfskel {

ParameterSpec keepSheetsParameter();
ParameterSpec sheetThresholdParameter();

/// Reads both of them.
void readSheets(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);

/**
 * Stage 0 of a surface, with what it is to hold and what is to become a sheet, and a word about both
 * in the log. The edges of such surfaces are neither merged nor halved first: every vertex is there, and no
 * other.
 * @param held  1 for the vertices to hold; empty if there are none.
 */
vcg::tri::mcf::Stage startOfFlow(FilterRun& run, const vcg::tri::mcf::Parameters& parameters,
	const vcg::tri::mcf::SurfaceMesh& surface, const vcg::tri::mcf::PoleSet& poles,
	const std::vector<char>& held, const vcg::tri::mcf::Progress& progress);

/// Turns a stage into curves and sheets, and logs what could not be kept.
vcg::tri::mcf::SheetCollapse collapseWithSheets(FilterRun& run, const vcg::tri::mcf::Stage& stage,
	double epsilon, const vcg::tri::mcf::Progress& progress);

/// The numbers of the curves, and b0, b1, b2 and the sheets.
Results sheetResults(const vcg::tri::mcf::SheetCollapse& collapse);

} // namespace mcfskel

#endif
