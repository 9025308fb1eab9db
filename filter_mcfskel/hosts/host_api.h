// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file What differs between MeshLab's two plugin interfaces, under one name each, so that the
/// filters and layers are written once. MCFSKEL_HOST_API is 2020 up to release 2020.12, 2021 since.

#ifndef MCFSKEL_HOST_API_H
#define MCFSKEL_HOST_API_H

#if MCFSKEL_HOST_API == 2020
#include <common/interfaces.h>
#else
#include <common/plugins/interfaces/filter_plugin.h>
#endif

namespace mcfskel::host {

#if MCFSKEL_HOST_API == 2020

inline void updateBoxAndNormals(MeshModel& layer)
{
	layer.UpdateBoxAndNormals();
}

inline void removeLayer(MeshDocument& document, int id)
{
	document.delMesh(document.getMesh(id));
}

#else

inline void updateBoxAndNormals(MeshModel& layer)
{
	layer.updateBoxAndNormals();
}

inline void removeLayer(MeshDocument& document, int id)
{
	document.delMesh(unsigned(id));
}

#endif

} // namespace mcfskel::host

#endif
