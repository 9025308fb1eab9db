// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Layers as PLY that MeshLab reads, edges included, and with what the filters know of them.

#ifndef MCFSKEL_LAYER_FILES_H
#define MCFSKEL_LAYER_FILES_H

#include "../layers/layers.h"

#include <skeleton/support.h>

#include <QString>

namespace mcfskel {

/// The layer of a stage, with all that the next step needs, and its colours.
/// @throws FileError, InvalidStage, Cancelled
void writeStageFile(const QString& file, const MeshModel& layer, const StageLayer& stage,
	const vcg::tri::mcf::Progress& progress);

/// The layer of a skeleton, with its correspondence and its colours. @throws FileError, InvalidInput
void writeCurveFile(const QString& file, const MeshModel& layer, const CurveLayer& curve);

/**
 * Any layer: vertices, faces and edges, quality and colours of vertices and faces, the attributes mcfskel_*.
 * Textures and what else a layer may have are left out.
 * @throws FileError, Cancelled
 */
void writeMeshFile(
	const QString& file, const MeshModel& layer, const vcg::tri::mcf::Progress& progress);

} // namespace mcfskel

#endif
