// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Last line of Fig. 4 with the sheets that a stage has, inside the surface.

#ifndef VCG_MCF_COLLAPSE_WITH_SHEETS_H
#define VCG_MCF_COLLAPSE_WITH_SHEETS_H

#include "keep_sheets.h"
#include "meso_skeleton.h"

#include <skeleton/collapse/curve_inside.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/progress.h>
#include <skeleton/flow/stage.h>
#include <skeleton/spatial/solid_test.h>

#include <algorithm>
#include <string>

namespace vcg::tri::mcf {

namespace detail {

/// Whether a skeleton is inside a surface: nodes, curves, and the edges and centroids of faces.
/// @throws Cancelled. Complexity: about O((F + nodes) log F).
inline bool isInside(const MesoSkeleton& skeleton, const std::vector<Point3d>& surface,
	const std::vector<Triangle>& triangles, const Progress& progress)
{
	const SolidTest solid(surface, triangles, progress);
	const auto place = [&](int v) { return solid.in(skeleton.position[size_t(v)]); };
	const std::vector<EdgeOfComplex> edges = allEdges(skeleton.edges, skeleton.faces);
	return std::all_of(skeleton.position.begin(), skeleton.position.end(), [&](const Point3d& p) {
		return solid.isInside(solid.in(p), outsideTolerance);
	}) && std::all_of(edges.begin(), edges.end(), [&](const EdgeOfComplex& edge) {
		progress.report(1, "Collapsing to curves");
		return solid.segmentIsInside(place(edge[0]), place(edge[1]), outsideTolerance);
	}) && std::all_of(skeleton.faces.begin(), skeleton.faces.end(), [&](const Triangle& t) {
		return solid.isInside((place(t[0]) + place(t[1]) + place(t[2])) / 3, outsideTolerance);
	});
}

} // namespace detail

/**
 * Turns a stage into curves and sheets: collapseKeepingSheets() of its sheetVertices(). If the
 * result is not inside the surface, all sheets become curves, see collapseInside(). That is not
 * checked where vertices are held, or the triangles of the surface are not known.
 * @param epsilon fraction of the diagonal of each component.
 * @param onNote  receives what was kept and what could not be; may be empty.
 * @throws SolverError, Cancelled. Complexity: as collapseKeepingSheets().
 */
inline SheetCollapse collapseWithSheets(const Stage& stage, double epsilon,
	const Progress& progress = Progress(), const NoteCallback& onNote = {})
{
	SheetCollapse result = collapseKeepingSheets(
		stage, sheetVertices(stage, progress.part(0, 0.3)), epsilon, progress.part(0.3, 0.9));
	if (stage.surfaceTriangles && stage.heldCount() == 0
		&& !detail::isInside(
			result.skeleton, *stage.surface, *stage.surfaceTriangles, progress.part(0.9, 0.95))) {
		const int sheets = result.sheets;
		CutCurves cut;
		result = withoutSheets(collapseInside(stage, epsilon, progress.part(0.95, 1), &cut));
		if (onNote && cut.components > 0)
			onNote(cut.text());
		result.sheets = result.givenUp = sheets;
	}
	if (!onNote)
		return result;
	const BettiNumbers b = result.skeleton.betti();
	onNote(detail::sentence(6, result.sheets - result.givenUp, " sheets of ",
		result.skeleton.faces.size(), " faces; Betti numbers b0 = ", b.b0, ", b1 = ", b.b1,
		", b2 = ", b.b2, "."));
	if (result.givenUp > 0)
		onNote(detail::sentence(6, result.givenUp, " of ", result.sheets,
			" sheets became curves: with them as sheets the result would not have had the topology of the "
			"shape, or would not have been inside it."));
	return result;
}

} // namespace vcg::tri::mcf

#endif
