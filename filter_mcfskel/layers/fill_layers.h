// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Filling new layers. Internal to layers/.

#ifndef MCFSKEL_FILL_LAYERS_H
#define MCFSKEL_FILL_LAYERS_H

#include "layer_state.h"

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

namespace mcfskel {

constexpr char writing[] = "Writing the layer";

/// Writes an attribute: one value for each vertex, made by toValue() from one of `values`.
template <class T, class Values, class ToValue>
void writeAttribute(MeshModel& layer, const char* name, const Values& values,
	const mcf::Progress& progress, const ToValue& toValue)
{
	progress.report(0, writing);
	auto attribute = vertexAttribute<T>(layer, name);
	mcf::detail::reportedLoop(int(values.size()), progress, writing,
		[&](int i) { attribute[size_t(i)] = toValue(values[size_t(i)]); });
}

template <class Values>
void writeScalars(MeshModel& layer, const char* name, const Values& values,
	const mcf::Progress& progress = mcf::Progress())
{
	writeAttribute<Scalarm>(
		layer, name, values, progress, [](auto value) { return Scalarm(value); });
}

inline void writePoints(MeshModel& layer, const char* name, const std::vector<vcg::Point3d>& values,
	const mcf::Progress& progress)
{
	writeAttribute<Point3m>(layer, name, values, progress, toHost);
}

inline void writeQuality(MeshModel& layer, const std::vector<double>& values,
	const mcf::Progress& progress = mcf::Progress())
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY);
	mcf::detail::reportedLoop(int(values.size()), progress, writing, [&](int i) {
		auto& quality = layer.cm.vert[size_t(i)].Q();
		quality = std::decay_t<decltype(quality)>(values[size_t(i)]);
	});
}

inline void addVertices(MeshModel& layer, const std::vector<vcg::Point3d>& points)
{
	auto vertex = Allocator::AddVertices(layer.cm, points.size());
	for (const vcg::Point3d& p : points)
		(vertex++)->P() = toHost(p);
}

/// Also sets the normals of faces, and of vertices weighted by area: MeshLab's, weighted by angle,
/// take longer than all the rest.
/// @throws Cancelled
void fillSurface(MeshModel& layer, const mcf::SurfaceMesh& mesh, const mcf::Progress& progress);

void fillCurve(MeshModel& layer, const std::vector<vcg::Point3d>& nodes,
	const std::vector<std::array<int, 2>>& edges, const std::vector<double>& radius);

/// Also colours vertices, safe for the colour-blind: curves vermilion, sheets blue, volume grey.
void writeKinds(MeshModel& layer, const std::vector<mcf::VertexKind>& kinds,
	const mcf::Progress& progress = mcf::Progress());

/// @throws Cancelled
void fillStage(MeshModel& layer, std::shared_ptr<const mcf::Stage> stage, const StageFields& fields,
	const SurfaceLink& surface, const mcf::Progress& progress);

void fillCurve(MeshModel& layer, const CurveLayer& curve, double diagonal);

} // namespace mcfskel

#endif
