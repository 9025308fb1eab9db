// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Last line of Fig. 4 where the stage itself says which of its parts are sheets.

#ifndef VCG_MCF_COLLAPSE_WITH_SHEETS_H
#define VCG_MCF_COLLAPSE_WITH_SHEETS_H

#include "keep_sheets.h"
#include "notes.h"
#include "progress.h"
#include "stage.h"

#include <string>

namespace vcg::tri::mcf {

/**
 * Turns a stage into curves and sheets: collapseKeepingSheets() of its sheetVertices().
 * @param epsilon fraction of the diagonal of each component.
 * @param onNote  receives what was kept and what could not be; may be empty.
 * @throws SolverError, Cancelled. Complexity: as collapseKeepingSheets().
 */
inline SheetCollapse collapseWithSheets(const Stage& stage, double epsilon,
	const Progress& progress = Progress(), const NoteCallback& onNote = {})
{
	SheetCollapse result = collapseKeepingSheets(
		stage, sheetVertices(stage, progress.part(0, 0.3)), epsilon, progress.part(0.3, 1));
	if (!onNote)
		return result;
	const BettiNumbers b = result.skeleton.betti();
	onNote(detail::sentence(6, result.sheets - result.givenUp, " sheets of ",
		result.skeleton.faces.size(), " faces; Betti numbers b0 = ", b.b0, ", b1 = ", b.b1,
		", b2 = ", b.b2, "."));
	if (result.givenUp > 0)
		onNote(detail::sentence(6, result.givenUp, " of ", result.sheets,
			" sheets became curves: with them as sheets the result would not have had the topology of the "
			"shape."));
	return result;
}

} // namespace vcg::tri::mcf

#endif
