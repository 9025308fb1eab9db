// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the layer of a stage shows beyond what the stage itself holds.

#ifndef MCFSKEL_STAGE_FIELDS_H
#define MCFSKEL_STAGE_FIELDS_H

#include <skeleton/state.h>

#include <vector>

namespace mcfskel {

/// One value for each vertex of a stage.
struct StageFields
{
	/// Local thickness, mesh units.
	std::vector<double> radius;
	std::vector<vcg::tri::mcf::VertexKind> kind;
};

/// Computes the fields of a stage. @throws Cancelled
inline StageFields stageFields(
	const vcg::tri::mcf::Stage& stage, const vcg::tri::mcf::Progress& progress)
{
	StageFields fields;
	fields.radius = stageRadius(stage, progress.part(0, 0.2));
	fields.kind = vertexKinds(stage, progress.part(0.2, 1));
	return fields;
}

} // namespace mcfskel

#endif
