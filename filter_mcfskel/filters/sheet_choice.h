// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the filters that can keep sheets share.

#ifndef MCFSKEL_SHEET_CHOICE_H
#define MCFSKEL_SHEET_CHOICE_H

#include "../filters.h"

#include <skeleton/pipeline.h>
#include <skeleton/support.h>

namespace mcfskel {

ParameterSpec keepSheetsParameter();
ParameterSpec sheetThresholdParameter();

/// Reads keep_sheets and sheet_threshold.
void readSheets(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);

/// curveResults() of the curves, the Betti numbers b0, b1 and b2, and the numbers of the sheets.
Results sheetResults(const vcg::tri::mcf::SheetCollapse& collapse);

} // namespace mcfskel

#endif
