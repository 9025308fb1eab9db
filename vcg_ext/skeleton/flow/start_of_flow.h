// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Stage 0 of a surface: its mesh, the vertices to hold and the sheets to keep.

#ifndef VCG_MCF_START_OF_FLOW_H
#define VCG_MCF_START_OF_FLOW_H

#include "first_stage.h"
#include "held_vertices.h"
#include "sheet_marks.h"
#include "sheetness.h"
#include "stage.h"

#include <skeleton/core/notes.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/components_at_rest.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/poles/pole_set.h>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Stage 0 of a surface.
 *
 * With parameters.coarsen, and without vertices to hold and sheets, it is firstStage(): short edges
 * are merged, too long ones halved. Otherwise the stage has exactly the vertices of the surface:
 * held vertices and the rims of sheets stay where they are. Components that rest, see
 * componentsAtRest(), are fixed from the start either way.
 *
 * @param measured compact.
 * @param poles    of all its vertices, see medialPoles().
 * @param held     1 for the vertices to hold; empty if there are none.
 * @param given    see sharedAmong() for more than 50 components.
 * @param onNote   receives what is held and kept; may be empty.
 * @param known    see boundedField().
 * @throws InvalidParameter, InvalidInput, SolverError, Cancelled.
 * Complexity: O(V), with sheets as sheetness().
 */
inline Stage startOfFlow(const MeasuredSurface& measured, const PoleSet& poles,
	const std::vector<char>& held, const Parameters& given, const Progress& progress = Progress(),
	const NoteCallback& onNote = {}, const BoundedField* known = nullptr)
{
	if (held.empty() && !given.keepSheets && given.coarsen)
		return firstStage(measured, given, poles, progress, known);
	const Progress begin = progress.cancelOnly();
	const Parameters parameters = sharedAmong(given, measured.diagonals());
	Stage stage = initialStage(measured, poles, begin);
	stage.epsilonLimit = epsilonLimits(measured, poles, parameters, begin, known);
	const std::vector<char> rests = componentsAtRest(measured, begin);
	for (size_t v = 0; v < stage.fixed.size(); ++v)
		stage.fixed[v] = rests[stage.component[v]];
	if (parameters.keepSheets) {
		markSheets(stage, sheetness(measured.mesh(), poles, progress.part(0, 0.4)),
			parameters.sheetThreshold, progress.part(0.4, 0.5));
		if (onNote) {
			const auto marked = std::count(stage.sheet.begin(), stage.sheet.end(), 1);
			const std::string threshold = detail::number(parameters.sheetThreshold, 6);
			onNote(stage.hasSheets() ? detail::sentence(3,
					   "Keeping sheets: ", 100.0 * double(marked) / double(stage.sheet.size()),
					   " % of the vertices are flatter than ", threshold, ".")
									 : "No part of the shape is flatter than " + threshold
						+ ": there are no sheets to keep.");
		}
	}
	if (held.empty() && !stage.hasSheets() && parameters.coarsen)
		return firstStage(measured, parameters, poles, progress.part(0.5, 1), known);
	if (!held.empty()) {
		holdVertices(stage, held);
		if (onNote)
			onNote("Holding " + std::to_string(stage.heldCount()) + " vertices where they are.");
	}
	return stage;
}

} // namespace vcg::tri::mcf

#endif
