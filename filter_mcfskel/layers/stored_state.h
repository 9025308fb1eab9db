// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The state of a layer in the file that it was loaded from. For layers/ alone.

#ifndef MCFSKEL_STORED_STATE_H
#define MCFSKEL_STORED_STATE_H

#include "layer_state.h"

namespace mcfskel {

/// Whether a layer has the triangles of a stage, wherever its vertices are.
bool hasTrianglesOf(const MeshModel& layer, const mcf::Stage& stage);

/// Whether a layer has the edges of a skeleton, wherever its nodes are.
bool hasEdgesOf(const MeshModel& layer, const mcf::CurveSkeleton& skeleton);

/// How many vertices of a layer are elsewhere, and the greatest distance.
struct Moved
{
	int count = 0;
	double farthest = 0;
};

/// @pre the layer has as many vertices as there are places, none deleted.
Moved movedFrom(const MeshModel& layer, const std::vector<vcg::Point3d>& places);

#if MCFSKEL_FILES
/**
 * The stage or skeleton in the PLY that a layer was loaded from, if the layer still has its triangles or edges;
 * null if there is none: MeshLab itself reads of such a file no more than a mesh. The surface is not looked for.
 */
StatePointer storedState(const MeshModel& layer);
#endif

} // namespace mcfskel

#endif
