// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Layers as PLY files that MeshLab can read, with edges and with the filters' state.

#ifndef MCFSKEL_LAYER_FILES_H
#define MCFSKEL_LAYER_FILES_H

#include "../layers/layers.h"

#include <skeleton/support.h>

#include <QString>

namespace mcfskel {

/// Writes the layer of a stage, with all that the next step needs, and its colours.
/// @throws FileError, InvalidStage, Cancelled
void writeStageFile(const QString& file, const MeshModel& layer, const StageLayer& stage,
	const vcg::tri::mcf::Progress& progress);

/// Writes the layer of a skeleton, with correspondence and colours. @throws FileError, InvalidInput
void writeCurveFile(const QString& file, const MeshModel& layer, const CurveLayer& curve);

/**
 * Writes any layer: vertices, faces and edges, quality and colours of vertices and faces, and the
 * attributes mcfskel_*. Textures and all else are left out.
 * @throws FileError, Cancelled
 */
void writeMeshFile(
	const QString& file, const MeshModel& layer, const vcg::tri::mcf::Progress& progress);

} // namespace mcfskel

#endif
