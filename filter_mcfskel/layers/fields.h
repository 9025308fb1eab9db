// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Setting quality and colour on existing layers, and adding faces to layers of points.

#ifndef MCFSKEL_FIELDS_H
#define MCFSKEL_FIELDS_H

#include "layers.h"

#include <skeleton/state.h>

#include <vector>

namespace mcfskel {

/// Joins the vertices of a new layer by triangles.
void addFaces(MeshModel& layer, const std::vector<vcg::tri::mcf::Triangle>& triangles);

/// The vertex quality of a layer, for each vertex that is not deleted; empty if it has none.
std::vector<double> vertexQuality(const MeshModel& layer);

/// Sets the vertex quality; one value for each vertex that is not deleted.
void setVertexQuality(MeshModel& layer, const std::vector<double>& values);

/// As above for a surface layer, one value for each vertex of `surface`; 0 for other vertices.
void setVertexQuality(
	MeshModel& layer, const SurfaceLayer& surface, const std::vector<double>& values);

/// Colours the vertices that are not deleted, from blue for `low` through green to red for `high`.
void setVertexColours(MeshModel& layer, const std::vector<double>& values, double low, double high);

/**
 * The part of each face slot of a layer; -1 for deleted faces and those that `surface` lacks.
 * @param surface  what the layer was read as.
 * @param ofFace   the part of each face of `surface`.
 * @throws Cancelled
 */
std::vector<int> facePartsOfSlots(const MeshModel& layer, const SurfaceLayer& surface,
	const std::vector<int>& ofFace, const vcg::tri::mcf::Progress& progress);

/// Sets the quality of each face slot to the number of its part, and its colour to that of the
/// part; faces without a part, -1, are grey.
void setFaceParts(MeshModel& layer, const std::vector<int>& ofSlot);

} // namespace mcfskel

#endif
