// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief First line of Fig. 4: noise is measured and smoothed, then the surface is resampled.

#ifndef VCG_MCF_RESAMPLED_SURFACE_H
#define VCG_MCF_RESAMPLED_SURFACE_H

#include "resample.h"
#include "target_length.h"

#include <skeleton/core/notes.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/input/denoise.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/transferred_nodes.h>

#include <utility>

namespace vcg::tri::mcf {

/// A resampled surface, and the noise that the surface had before.
struct ResampledSurface
{
	SurfaceMesh mesh;
	NoiseReport noise;
};

/**
 * Smooths the noise of a surface where there is any, if parameters.denoise is set, and resamples it,
 * with the edge length of defaultTargetLength().
 * @param mesh   closed two-manifold, compact.
 * @param onNote receives what was found and done; may be empty.
 * @throws InvalidParameter, Cancelled. Complexity: as resample().
 */
inline ResampledSurface resampledSurface(const SurfaceMesh& mesh, const Parameters& parameters,
	const Progress& progress = Progress(), const NoteCallback& onNote = {})
{
	parameters.check();
	const MeasuredSurface surface(mesh, progress.part(0, 0.05));
	ResampledSurface result;
	result.noise = measureNoise(surface, progress.part(0.05, 0.15));
	const bool isNoisy = result.noise.isNoisy();
	const bool smooth = parameters.denoise && isNoisy;
	if (onNote && isNoisy)
		onNote("The surface has noise of " + detail::number(100 * result.noise.level, 2)
			+ " % of its diagonal: "
			+ (smooth ? "smoothing it in " + std::to_string(result.noise.mostRounds()) + " rounds."
					  : "it may show in the skeleton; 'denoise' would smooth it."));
	const auto resampled = [&](const MeasuredSurface& calm) {
		return resample(calm, defaultTargetLength(calm, parameters), parameters.resampleIterations,
			progress.part(smooth ? 0.35 : 0.15, 1));
	};
	if (smooth)
		result.mesh = resampled({smoothed(surface, result.noise.rounds, progress.part(0.15, 0.3)),
			progress.part(0.3, 0.35)});
	else
		result.mesh = resampled(surface);
	if (onNote)
		onNote(detail::sentence(6, "Resampled to ", result.mesh.vertexCount(),
			" vertices, mean edge length ", meanEdgeLength(result.mesh), " mesh units",
			parameters.targetLength == 0 ? " (chosen from the mesh)." : "."));
	return result;
}

} // namespace vcg::tri::mcf

#endif
