// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "scene.h"

#if __has_include(<common/ml_shared_data_context/ml_scene_gl_shared_data_context.h>)
#include <common/ml_shared_data_context/ml_scene_gl_shared_data_context.h>
#else
#include <common/ml_shared_data_context.h>
#endif

#include <QApplication>
#include <QGLWidget>
#include <QTimer>

namespace mcfskel::host {

namespace {

using Data = MLRenderingData;

/// The object that draws the layers of a document; null if it has no window.
MLSceneGLSharedDataContext* sceneOf(const MeshDocument& document)
{
	for (QWidget* widget : QApplication::allWidgets()) {
		auto* scene = qobject_cast<MLSceneGLSharedDataContext*>(widget);
		if (scene && &scene->meshDoc() == &document)
			return scene;
	}
	return nullptr;
}

/// MeshLab's views, those of other documents included.
std::vector<QGLWidget*> views()
{
	std::vector<QGLWidget*> found;
	for (QWidget* widget : QApplication::allWidgets())
		if (widget->inherits("GLArea"))
			if (auto* view = qobject_cast<QGLWidget*>(widget))
				found.push_back(view);
	return found;
}

bool drawsAnything(const Data& data)
{
	for (auto kind = Data::PRIMITIVE_MODALITY(0); kind < Data::PR_ARITY; kind = Data::next(kind))
		if (data.isPrimitiveActive(kind))
			return true;
	return false;
}

/// How a layer is drawn now, in the first view that draws it.
Data currentLook(MLSceneGLSharedDataContext& scene, MeshModel& layer)
{
	for (QGLWidget* view : views()) {
		Data data;
		scene.getRenderInfoPerMeshView(int(layer.id()), view->context(), data);
		if (drawsAnything(data))
			return data;
	}
	Data data;
	MLPoliciesStandAloneFunctions::suggestedDefaultPerViewRenderingData(&layer, data);
	return data;
}

/// The attributes of unlit points or edges.
Data::RendAtts unlit(bool coloured)
{
	Data::RendAtts attributes;
	attributes[Data::ATT_NAMES::ATT_VERTPOSITION] = true;
	attributes[Data::ATT_NAMES::ATT_VERTCOLOR] = coloured;
	return attributes;
}

void takeCurveLook(Data& data, MLPerViewGLOptions& options, const MeshModel& layer)
{
	const bool coloured = layer.hasDataMask(MeshModel::MM_VERTCOLOR);
	const bool isPoint = layer.cm.en == 0;
	data.set(Data::PR_WIREFRAME_EDGES, unlit(coloured));
	data.set(Data::PR_WIREFRAME_EDGES, !isPoint);
	// Thick lines leave wedges open where they meet: points of the same width close them.
	data.set(Data::PR_POINTS, unlit(coloured));
	options._peredge_wire_enabled = options._peredge_fauxwire_enabled = !isPoint;
	options._perwire_wirewidth = 4;
	options._perwire_noshading = options._perpoint_noshading = true;
	options._perwire_fixed_color_enabled = options._perpoint_fixed_color_enabled = !coloured;
	options._perpoint_pointsize = isPoint ? 9 : 4;
	options._perpoint_pointsmooth_enabled = true;
	options._perpoint_pointattenuation_enabled = false;
}

void takeOutlineLook(Data& data, MLPerViewGLOptions& options, const MeshModel& layer)
{
	const vcg::Color4b light(170, 180, 200, 255);
	const bool edged = layer.cm.vn <= maxEdgedVertices;
	data.set(Data::PR_SOLID, false);
	data.set(edged ? Data::PR_WIREFRAME_TRIANGLES : Data::PR_POINTS, unlit(false));
	data.set(Data::PR_WIREFRAME_TRIANGLES, edged);
	data.set(Data::PR_POINTS, !edged);
	options._peredge_wire_enabled = edged;
	options._perwire_wirewidth = 1;
	options._perwire_noshading = options._perpoint_noshading = true;
	options._perwire_fixed_color_enabled = options._perpoint_fixed_color_enabled = true;
	options._perwire_fixed_color = options._perpoint_fixed_color = light;
	options._perpoint_pointsize = 1;
	options._perpoint_pointattenuation_enabled = false;
}

void takeLook(MLSceneGLSharedDataContext& scene, MeshModel& layer, Look look)
{
	Data data = currentLook(scene, layer);
	MLPerViewGLOptions options;
	data.get(options);
	switch (look) {
	case Look::Curve: takeCurveLook(data, options, layer); break;
	case Look::Outline: takeOutlineLook(data, options, layer); break;
	case Look::ThinStage:
		data.set(Data::PR_WIREFRAME_TRIANGLES, unlit(layer.hasDataMask(MeshModel::MM_VERTCOLOR)));
		data.set(Data::PR_WIREFRAME_TRIANGLES, true);
		options._peredge_wire_enabled = true;
		options._perwire_wirewidth = 2;
		options._perwire_noshading = true;
		options._perwire_fixed_color_enabled = !layer.hasDataMask(MeshModel::MM_VERTCOLOR);
		[[fallthrough]];
	case Look::Stage:
		options._double_side_lighting = true;
		options._single_side_lighting = false;
		break;
	}
	data.set(options);
	scene.setRenderingDataPerAllMeshViews(int(layer.id()), data);
	scene.manageBuffers(int(layer.id()));
}

} // namespace

void setLooks(MeshDocument& document, const std::vector<std::pair<int, Look>>& looks)
{
	MLSceneGLSharedDataContext* const scene = sceneOf(document);
	if (!scene)
		return;
	QTimer::singleShot(0, scene, [scene, looks] {
		try {
			for (const auto& [id, look] : looks)
				if (MeshModel* layer = scene->meshDoc().getMesh(id))
					takeLook(*scene, *layer, look);
			for (QGLWidget* view : views())
				view->update();
		}
		catch (...) {
			// The layers keep the host's looks.
		}
	});
}

std::optional<ProjectLook> projectLook(const MeshDocument& document, MeshModel& layer)
{
	MLSceneGLSharedDataContext* const scene = sceneOf(document);
	if (!scene)
		return std::nullopt;
	const Data data = currentLook(*scene, layer);
	MLPerViewGLOptions options;
	if (!data.get(options))
		return std::nullopt;
	std::string text;
	data.serialize(text);
	const auto colour = [](const vcg::Color4b& c) {
		return QString("%1 %2 %3 %4").arg(c[0]).arg(c[1]).arg(c[2]).arg(c[3]);
	};
	return ProjectLook {QString::fromStdString(text),
		{{"boxColor", colour(options._perbbox_fixed_color)},
			{"pointColor", colour(options._perpoint_fixed_color)},
			{"wireColor", colour(options._perwire_fixed_color)},
			{"solidColor", colour(options._persolid_fixed_color)},
			{"pointSize", QString::number(options._perpoint_pointsize)},
			{"wireWidth", QString::number(options._perwire_wirewidth)}}};
}

} // namespace mcfskel::host
