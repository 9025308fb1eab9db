// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the filters share that can keep sheets.

#ifndef MCFSKEL_SHEET_CHOICE_H
#define MCFSKEL_SHEET_CHOICE_H

#include "../filters.h"

#include <skeleton/pipeline.h>
#include <skeleton/support.h>

namespace mcfskel {

ParameterSpec keepSheetsParameter();
ParameterSpec sheetThresholdParameter();

/// Reads both of them.
void readSheets(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);

/// The numbers of the curves, and b0, b1, b2 and the sheets.
Results sheetResults(const vcg::tri::mcf::SheetCollapse& collapse);

} // namespace mcfskel

#endif
