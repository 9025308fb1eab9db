// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fill_layers.h"

#include <skeleton/support.h>

namespace mcfskel {

void fillSurface(MeshModel& layer, const mcf::SurfaceMesh& mesh, const mcf::Progress& progress)
{
	const std::vector<vcg::Point3d> normals = mesh.vertexNormals(progress.part(0, 0.2));
	auto vertex = Allocator::AddVertices(layer.cm, normals.size());
	mcf::detail::reportedLoop(int(normals.size()), progress.part(0.2, 0.5), writing, [&](int v) {
		vertex->P() = toHost(mesh.position[size_t(v)]);
		vertex->N() = toHost(normals[size_t(v)]);
		layer.cm.bbox.Add(vertex->cP());
		++vertex;
	});
	auto face = Allocator::AddFaces(layer.cm, size_t(mesh.faceCount()));
	mcf::detail::reportedLoop(mesh.faceSlots(), progress.part(0.5, 1), writing, [&](int f) {
		if (!mesh.isFace(f))
			return;
		for (int k = 0; k < 3; ++k)
			face->V(k) = &layer.cm.vert[size_t(mesh.triangle(f)[size_t(k)])];
		const vcg::Point3d normal = mesh.doubleAreaVector(f);
		const double length = normal.Norm();
		face->N() = toHost(length > 0 ? normal / length : normal);
		++face;
	});
	progress.report(1, writing);
}

void fillCurve(MeshModel& layer, const std::vector<vcg::Point3d>& nodes,
	const std::vector<std::array<int, 2>>& edges, const std::vector<double>& radius)
{
	addVertices(layer, nodes);
	auto edge = Allocator::AddEdges(layer.cm, edges.size());
	for (const std::array<int, 2>& ends : edges) {
		for (int k = 0; k < 2; ++k)
			edge->V(k) = &layer.cm.vert[size_t(ends[size_t(k)])];
		++edge;
	}
	if (!radius.empty()) {
		writeScalars(layer, radiusAttribute, radius);
		writeQuality(layer, radius);
	}
	host::updateBoxAndNormals(layer);
}

void writeKinds(
	MeshModel& layer, const std::vector<mcf::VertexKind>& kinds, const mcf::Progress& progress)
{
	const auto colourOf = [](mcf::VertexKind kind) {
		switch (kind) {
		case mcf::VertexKind::Curve: return vcg::Color4b(213, 94, 0, 255);
		case mcf::VertexKind::Sheet: return vcg::Color4b(86, 180, 233, 255);
		default: return vcg::Color4b(190, 190, 190, 255);
		}
	};
	writeScalars(layer, kindAttribute, kinds, progress.part(0, 0.5));
	layer.updateDataMask(MeshModel::MM_VERTCOLOR);
	mcf::detail::reportedLoop(int(kinds.size()), progress.part(0.5, 1), writing,
		[&](int i) { layer.cm.vert[size_t(i)].C() = colourOf(kinds[size_t(i)]); });
}

void fillStage(MeshModel& layer, std::shared_ptr<const mcf::Stage> stage, const StageFields& fields,
	const SurfaceLink& surface, const mcf::Progress& progress)
{
	fillSurface(layer, stage->mesh, progress.part(0, 0.4));
	writePoints(layer, poleAttribute, stage->pole, progress.part(0.4, 0.5));
	writeScalars(layer, poleRadiusAttribute, stage->poleRadius, progress.part(0.5, 0.6));
	writeScalars(layer, fixedAttribute, stage->fixed, progress.part(0.6, 0.7));
	if (stage->heldCount() > 0)
		writeScalars(layer, heldAttribute, stage->held, progress.part(0.6, 0.7));
	writeScalars(layer, radiusAttribute, fields.radius, progress.part(0.7, 0.8));
	writeQuality(layer, fields.radius, progress.part(0.8, 0.9));
	writeKinds(layer, fields.kind, progress.part(0.9, 1));
	LayerState state;
	state.stage = {std::move(stage), surface};
	setState(layer, std::move(state));
}

void fillCurve(MeshModel& layer, const CurveLayer& curve, double diagonal)
{
	fillCurve(layer, curve.skeleton.position, curve.skeleton.edges, curve.skeleton.radius);
	if (!curve.skeleton.significance.empty())
		writeScalars(layer, significanceAttribute, curve.skeleton.significance);
	if (curve.skeleton.bridge.size() == curve.skeleton.position.size())
		writeScalars(layer, bridgeAttribute, curve.skeleton.bridge);
	LayerState state;
	state.curve = std::make_shared<const CurveLayer>(curve);
	state.diagonal = diagonal;
	setState(layer, std::move(state));
}

void fillCurve(MeshModel& layer, const CurveLayer& curve)
{
	fillCurve(layer, curve, 0);
}

} // namespace mcfskel
