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
	ThinStage ///< the same with the edges of the triangles, of which most show no face any more
};

/// Surfaces of more vertices cover what is inside, however they are drawn.
constexpr int maxOutlineVertices = 150'000;
/// Up to here the edges of a surface are drawn, above its points.
constexpr int maxEdgedVertices = 2'500;

/**
 * Sets how layers are drawn, by their ids, in all views of a document; nothing where it has no window.
 * It is done when the host has taken in the results of the filter that is running, since it gives new layers
 * looks of its own.
 */
void setLooks(MeshDocument& document, const std::vector<std::pair<int, Look>>& looks);

/// How a layer is drawn, as MeshLab's project files say it: the text of an element RenderingOption, and its
/// attributes by their names.
struct ProjectLook
{
	QString text;
	std::vector<std::pair<QString, QString>> attributes;
};

/// How a layer is drawn now; nothing where the document has no window.
std::optional<ProjectLook> projectLook(const MeshDocument& document, MeshModel& layer);

} // namespace mcfskel::host

#endif
