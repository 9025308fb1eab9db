// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#if MCFSKEL_IN_MESHLAB
/// @file
/// @brief What the filters and layers use of MeshLab, under the names that they use.
#else
/// @file
/// @brief What differs between MeshLab's two plugin interfaces, under one name each, so that the
/// filters and layers are written once. MCFSKEL_HOST_API is 2020 up to release 2020.12, 2021 since;
/// MCFSKEL_RENAMED_PARAMETERS is 1 since release 2023.12.
#endif

#ifndef MCFSKEL_HOST_API_H
#define MCFSKEL_HOST_API_H

#if MCFSKEL_HOST_API == 2020
#include <common/interfaces.h>

#include <Eigen/Core>

#include <QMetaType>

/// Later releases declare it themselves.
Q_DECLARE_METATYPE(Eigen::VectorXd)
#else
#include <common/plugins/interfaces/filter_plugin.h>
#if MCFSKEL_FILES
#include <common/plugins/interfaces/io_plugin.h>
#endif

#include <common/parameters/rich_parameter_list.h>
#endif

#include <QApplication>
#include <QWidget>

#include <algorithm>
#include <utility>
#include <vector>

namespace mcfskel::host {

/// Whether MeshLab's main window shows the layers. Scripts have none.
inline bool hasWindow()
{
	const QWidgetList windows = QApplication::topLevelWidgets();
	return std::any_of(windows.begin(), windows.end(),
		[](const QWidget* window) { return window->inherits("QMainWindow"); });
}

#if MCFSKEL_RENAMED_PARAMETERS
using RichPercentage = ::RichPercentage;
using RichFileOpen = ::RichFileOpen;
using RichFileSave = ::RichFileSave;
#else
using RichPercentage = ::RichAbsPerc;
using RichFileOpen = ::RichOpenFile;
using RichFileSave = ::RichSaveFile;
#endif

#if MCFSKEL_HOST_API == 2020

using FilterBase = MeshFilterInterface;
/// The type of the document that MeshLab's parameters are made for.
using ParameterDocument = MeshDocument;

/// Makes a MeshLab parameter. This interface cannot mark one as advanced.
template <class Rich, class... Arguments>
Rich makeParameter(bool /*advanced*/, Arguments&&... arguments)
{
	return Rich(std::forward<Arguments>(arguments)...);
}

inline MeshModel* currentLayer(ParameterDocument& document)
{
	return document.mm();
}

/// The id of the layer that a parameter names; -1 if it names none.
inline int layerId(const RichParameterList& list, const QString& name)
{
	const MeshModel* const layer = list.getMesh(name);
	return layer ? layer->id() : -1;
}

inline void updateBoxAndNormals(MeshModel& layer)
{
	layer.UpdateBoxAndNormals();
}

inline std::vector<const MeshModel*> layersOf(const MeshDocument& document)
{
	return {document.meshList.begin(), document.meshList.end()};
}

inline void removeLayer(MeshDocument& document, int id)
{
	document.delMesh(document.getMesh(id));
}

inline int rasterCount(const MeshDocument& document)
{
	return document.rasterList.size();
}

#else

using FilterBase = FilterPlugin;
using ParameterDocument = const MeshDocument;

template <class Rich, class... Arguments>
Rich makeParameter(bool advanced, Arguments&&... arguments)
{
	return Rich(std::forward<Arguments>(arguments)..., advanced);
}

/// The id of the current layer, as RichMesh takes it; 0 if there is none.
inline unsigned currentLayer(ParameterDocument& document)
{
	return document.mm() ? unsigned(document.mm()->id()) : 0;
}

inline int layerId(const RichParameterList& list, const QString& name)
{
	return int(list.getMeshId(name));
}

inline void updateBoxAndNormals(MeshModel& layer)
{
	layer.updateBoxAndNormals();
}

inline std::vector<const MeshModel*> layersOf(const MeshDocument& document)
{
	std::vector<const MeshModel*> layers;
	for (const MeshModel& layer : document.meshIterator())
		layers.push_back(&layer);
	return layers;
}

inline void removeLayer(MeshDocument& document, int id)
{
	document.delMesh(unsigned(id));
}

inline int rasterCount(const MeshDocument& document)
{
	return int(document.rasterNumber());
}

#endif

} // namespace mcfskel::host

#endif
