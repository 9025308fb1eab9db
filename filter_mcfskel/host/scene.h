// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How layers are drawn in MeshLab's window.

#ifndef MCFSKEL_SCENE_H
#define MCFSKEL_SCENE_H

#include "host_api.h"

#include <QString>

#include <optional>
#include <utility>
#include <vector>

namespace mcfskel::host {

enum class Look {
	Curve,    ///< thick edges in the colours of their vertices
	Outline,  ///< the edges of a coarse surface, the points of a fine one: what is inside shows
	Stage,    ///< lit from both sides: contracted lobes may be inside out
	ThinStage ///< as Stage, with edges: most triangles are too thin to be seen as faces
};

/// Surfaces with more vertices hide what is inside even if only their points are drawn.
constexpr int maxOutlineVertices = 150'000;
/// An outline shows the edges of a surface up to this many vertices, else its points.
constexpr int maxEdgedVertices = 2'500;

/**
 * Sets how layers, given by their ids, are drawn in all views of a document; does nothing where it
 * has no window. It takes effect after the host has taken in the results of the running filter,
 * because the host then sets its own looks for new layers.
 */
void setLooks(MeshDocument& document, const std::vector<std::pair<int, Look>>& looks);

/// How a layer is drawn, as in MeshLab's project files: the text of an element RenderingOption, and
/// its attributes by name.
struct ProjectLook
{
	QString text;
	std::vector<std::pair<QString, QString>> attributes;
};

/// How a layer is drawn now; nothing where the document has no window.
std::optional<ProjectLook> projectLook(const MeshDocument& document, MeshModel& layer);

} // namespace mcfskel::host

#endif
