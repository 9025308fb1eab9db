// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Which vertices are to become sheets, and what the flow does with them.

#ifndef VCG_MCF_SHEET_MARKS_H
#define VCG_MCF_SHEET_MARKS_H

#include "stage.h"

#include <skeleton/core/progress.h>
#include <skeleton/mesh/marked_regions.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Marks the vertices of stage 0 that are to become sheets: those of sheetness above `threshold`.
 *
 * Holes in the marks of an area below 0.1 % of the squared diagonal are filled, then marked parts
 * below 0.5 % are dropped: that is both walls of a square sheet with sides of 5 % of the diagonal.
 * @param sheetness  of each vertex, see sheetness(). @pre no iteration has been made.
 * @throws Cancelled
 */
inline void markSheets(Stage& stage, const std::vector<double>& sheetness, double threshold,
	const Progress& progress = Progress())
{
	constexpr double smallestHole = 0.001, smallestSheet = 0.005;
	for (size_t v = 0; v < sheetness.size(); ++v)
		stage.sheet[v] = sheetness[v] > threshold && stage.poleRadius[v] >= 0;
	const std::vector<double> area = vertexAreas(stage.mesh, progress.part(0, 0.3));
	std::vector<double> hole, sheet;
	for (double diagonal : stage.diagonal) {
		hole.push_back(smallestHole * diagonal * diagonal);
		sheet.push_back(smallestSheet * diagonal * diagonal);
	}
	flipSmallParts(
		stage.mesh, area, stage.component, hole, 0, stage.sheet, progress.part(0.3, 0.7));
	flipSmallParts(stage.mesh, area, stage.component, sheet, 1, stage.sheet, progress.part(0.7, 1));
	for (size_t v = 0; v < stage.sheet.size(); ++v)
		stage.sheet[v] &= stage.poleRadius[v] >= 0;
}

/**
 * Fixes the vertices of sheets that have arrived, closer than epsilon / 2 to their pole. A weight
 * alone would never hold the rim of a sheet against the smoothing.
 * @param epsilon as in Parameters. @return the number of vertices fixed.
 */
inline int fixArrivedSheets(Stage& stage, double epsilon)
{
	int count = 0;
	for (int v = 0; v < int(stage.sheet.size()); ++v) {
		if (!stage.mesh.isVertex(v) || !stage.sheet[v] || stage.fixed[v])
			continue;
		const double limit = epsilon / 2 * stage.diagonal[stage.component[v]];
		if (SquaredDistance(stage.mesh.position[v], stage.pole[v]) < limit * limit) {
			stage.fixed[v] = 1;
			++count;
		}
	}
	return count;
}

} // namespace vcg::tri::mcf

#endif
