// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file What the filters share that can keep sheets.

#ifndef MCFSKEL_FILTERS_SHEETS_H
#define MCFSKEL_FILTERS_SHEETS_H

#include "../filters.h"

#include <skeleton/keep_sheets.h>
#include <skeleton/parameters.h>

namespace mcfskel {

ParameterSpec keepSheetsParameter();
ParameterSpec sheetThresholdParameter();

/// Reads both of them.
void readSheets(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);

/// The numbers of the curves, and b0, b1, b2 and the sheets.
Results sheetResults(const vcg::tri::mcf::SheetCollapse& collapse);

} // namespace mcfskel

#endif
