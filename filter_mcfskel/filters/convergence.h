// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Warnings about a stage that becomes a curve before it has converged.

#ifndef MCFSKEL_FILTERS_CONVERGENCE_H
#define MCFSKEL_FILTERS_CONVERGENCE_H

#include "../filters.h"
#include "filter_support.h"

#include <skeleton/pipeline.h>

namespace mcfskel {

inline constexpr char surfaceSpreads[] =
	"The surface does not contract but spreads, being inside out in large parts";

/// Logs that a stage that becomes a curve has not converged, and what to do; nothing if it has.
inline void logIfNotConverged(
	const FilterRun& run, const vcg::tri::mcf::Stage& stage, const char* cure)
{
	if (stage.converged)
		return;
	if (stage.isSpread()) {
		run.log(QString(
			"Warning: %1: the curve may be off the middle. Apply Make Solid first: it resolves "
			"self-intersections.")
					.arg(surfaceSpreads));
		return;
	}
	run.log(QString(
		"Warning: the contraction has not converged after %1 iterations, %2 is left: the curve may be "
		"off the middle. %3")
				.arg(stage.iteration)
				.arg(partOfVolume(vcg::tri::mcf::figuresOf(stage).volumeFraction))
				.arg(cure));
}

} // namespace mcfskel

#endif
