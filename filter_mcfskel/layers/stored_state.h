// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The state of a layer in the file that it was loaded from. Internal to layers/.

#ifndef MCFSKEL_STORED_STATE_H
#define MCFSKEL_STORED_STATE_H

#include "layer_state.h"

namespace mcfskel {

/// Whether a layer has the triangles of a stage, wherever its vertices are.
bool hasTrianglesOf(const MeshModel& layer, const mcf::Stage& stage);

/// Whether a layer has the edges of a skeleton, wherever its nodes are.
bool hasEdgesOf(const MeshModel& layer, const mcf::CurveSkeleton& skeleton);

/// How many vertices of a layer have moved, and the greatest distance, mesh units.
struct Moved
{
	int count = 0;
	double farthest = 0;
};

/// @pre the layer has as many vertices as there are places, none deleted.
Moved movedFrom(const MeshModel& layer, const std::vector<vcg::Point3d>& places);

#if MCFSKEL_FILES
/**
 * The stage or skeleton in the PLY file that a layer was loaded from, of which MeshLab itself reads
 * only the mesh; null if there is none, or if the layer no longer has its triangles or edges. The
 * layer of its surface is not looked for.
 */
StatePointer storedState(const MeshModel& layer);
#endif

} // namespace mcfskel

#endif
