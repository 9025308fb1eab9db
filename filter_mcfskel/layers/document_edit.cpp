// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fields.h"
#include "fill_layers.h"

#include <algorithm>
#include <new>

namespace mcfskel {

DocumentEdit::DocumentEdit(MeshDocument& document) :
		document(document), previousLayer(document.mm() ? int(document.mm()->id()) : -1)
{
}

DocumentEdit::~DocumentEdit()
{
	if (committed)
		return;
	for (const NewAttribute& attribute : newAttributes)
		removeAttribute(attribute.layer->cm.vert_attr, attribute.name);
	for (int id : added)
		host::removeLayer(document, id);
	if (previousLayer >= 0)
		document.setCurrentMesh(previousLayer);
}

MeshModel& DocumentEdit::addLayer(const MeshModel& source, const QString& label)
{
	sources.push_back(source.id());
	return addLayer(Matrix44m(source.cm.Tr), label);
}

MeshModel& DocumentEdit::addLayer(const SurfaceLink& surface, const QString& label)
{
	const MeshModel* source = surface.layerId < 0 ? nullptr : document.getMesh(surface.layerId);
	sources.push_back(surface.layerId);
	return addLayer(source ? Matrix44m(source->cm.Tr) : Matrix44m::Identity(), label);
}

MeshModel& DocumentEdit::addLayer(const Matrix44m& frame, const QString& label)
{
	added.reserve(added.size() + 1); // nothing may fail between the two
	MeshModel& layer = *document.addNewMesh("", label, false);
	added.push_back(layer.id());
	layer.cm.Tr = frame;
	return layer;
}

MeshModel& DocumentEdit::addSurface(const MeshModel& source, const QString& label,
	const mcf::SurfaceMesh& mesh, const mcf::Progress& progress)
{
	MeshModel& layer = addLayer(source, label);
	fillSurface(layer, mesh, progress);
	return layer;
}

MeshModel& DocumentEdit::addPoints(
	const MeshModel& source, const QString& label, const std::vector<vcg::Point3d>& points)
{
	MeshModel& layer = addLayer(source, label);
	addVertices(layer, points);
	host::updateBoxAndNormals(layer);
	return layer;
}

MeshModel& DocumentEdit::addCurve(const MeshModel& source, const QString& label,
	const std::vector<vcg::Point3d>& nodes, const std::vector<std::array<int, 2>>& edges,
	const std::vector<double>& radius)
{
	MeshModel& layer = addLayer(source, label);
	fillCurve(layer, nodes, edges, radius);
	return layer;
}

MeshModel& DocumentEdit::addCurve(
	const MeshModel& source, const QString& label, const CurveLayer& curve)
{
	MeshModel& layer = addLayer(source, label);
	sources.push_back(curve.surface.layerId);
	fillCurve(layer, curve, referenceDiagonal(source));
	return layer;
}

MeshModel& DocumentEdit::addCurve(const QString& label, const CurveLayer& curve)
{
	MeshModel& layer = addLayer(curve.surface, label);
	fillCurve(layer, curve);
	return layer;
}

MeshModel& DocumentEdit::addMesoSkeleton(
	const MeshModel& source, const QString& label, const mcf::MesoSkeleton& skeleton)
{
	MeshModel& layer = addLayer(source, label);
	addVertices(layer, skeleton.position);
	std::vector<mcf::VertexKind> kinds(skeleton.position.size(), mcf::VertexKind::Curve);
	auto edge = Allocator::AddEdges(layer.cm, skeleton.edges.size());
	for (const mcf::EdgeOfComplex& ends : skeleton.edges) {
		for (int k = 0; k < 2; ++k)
			edge->V(k) = &layer.cm.vert[size_t(ends[size_t(k)])];
		++edge;
	}
	auto face = Allocator::AddFaces(layer.cm, skeleton.faces.size());
	for (const mcf::Triangle& corners : mcf::orientedFaces(skeleton)) {
		for (int k = 0; k < 3; ++k) {
			face->V(k) = &layer.cm.vert[size_t(corners[size_t(k)])];
			kinds[size_t(corners[size_t(k)])] = mcf::VertexKind::Sheet;
		}
		++face;
	}
	writeScalars(layer, radiusAttribute, skeleton.radius);
	writeQuality(layer, skeleton.radius);
	writeKinds(layer, kinds);
	host::updateBoxAndNormals(layer);
	return layer;
}

MeshModel& DocumentEdit::addStage(const MeshModel& source, const QString& label,
	std::shared_ptr<const mcf::Stage> stage, const StageFields& fields, const SurfaceLink& surface,
	const mcf::Progress& progress)
{
	MeshModel& layer = addLayer(source, label);
	sources.push_back(surface.layerId);
	fillStage(layer, std::move(stage), fields, surface, progress);
	return layer;
}

MeshModel& DocumentEdit::addStage(const QString& label, std::shared_ptr<const mcf::Stage> stage,
	const StageFields& fields, const SurfaceLink& surface, const mcf::Progress& progress)
{
	MeshModel& layer = addLayer(surface, label);
	fillStage(layer, std::move(stage), fields, surface, progress);
	return layer;
}

void DocumentEdit::noteNew(MeshModel& layer, const char* attribute)
{
	if (!findAttribute(layer.cm.vert_attr, attribute))
		newAttributes.push_back({&layer, attribute});
}

void DocumentEdit::changeState(
	MeshModel& layer, const SurfaceLayer& surface, std::shared_ptr<const mcf::PoleSet> poles)
{
	LayerState state;
	state.surface = surface;
	state.surface.notes.clear();
	state.poles = std::move(poles);
	noteNew(layer, stateAttribute);
	StateAttribute& attribute = stateOf(layer);
	StatePointer after = newState(layer, std::move(state));
	changes.push_back([&attribute, after = std::move(after)] { attribute.content = after; });
}

void DocumentEdit::attachSurface(MeshModel& layer, const SurfaceLayer& surface)
{
	changeState(layer, surface, nullptr);
}

void DocumentEdit::writePoles(
	MeshModel& layer, const SurfaceLayer& surface, std::shared_ptr<const mcf::PoleSet> poles)
{
	noteNew(layer, poleAttribute);
	noteNew(layer, poleRadiusAttribute);
	auto centre = vertexAttribute<Point3m>(layer, poleAttribute);
	auto radius = vertexAttribute<Scalarm>(layer, poleRadiusAttribute);
	changes.push_back(
		[&layer, centre, radius, vertexOfSlot = surface.vertexOfSlot, poles]() mutable {
			for (size_t slot = 0; slot < layer.cm.vert.size(); ++slot) {
				const int v = (*vertexOfSlot)[slot];
				const bool has = v >= 0 && poles->has(v);
				// A vertex without a pole shows itself: readers that ignore the radius stay inside the box.
				centre[slot] = has ? toHost(poles->centre[size_t(v)]) : layer.cm.vert[slot].cP();
				radius[slot] = has ? Scalarm(poles->radius[size_t(v)]) : Scalarm(-1);
			}
		});
	changeState(layer, surface, std::move(poles));
}

void DocumentEdit::writeNodes(
	MeshModel& layer, const std::vector<int>& vertexOfSlot, const std::vector<int>& node)
{
	noteNew(layer, nodeAttribute);
	auto attribute = vertexAttribute<Scalarm>(layer, nodeAttribute);
	std::vector<Scalarm> values;
	values.reserve(vertexOfSlot.size());
	for (int v : vertexOfSlot)
		values.push_back(v < 0 ? Scalarm(-1) : Scalarm(node[size_t(v)]));
	changes.push_back([attribute, values = std::move(values)]() mutable {
		for (size_t slot = 0; slot < values.size(); ++slot)
			attribute[slot] = values[slot];
	});
}

void DocumentEdit::writeNodes(const SurfaceLink& surface, const std::vector<int>& node)
{
	MeshModel* layer = document.getMesh(surface.layerId);
	if (layer && fingerprint(layer->cm) == surface.fingerprint)
		writeNodes(*layer, *surface.vertexOfSlot, node);
}

void DocumentEdit::commit()
{
	for (const std::function<void()>& change : changes)
		change();
	committed = true;
	if (added.empty())
		return;
	document.setCurrentMesh(added.back());
	try {
		if (host::hasWindow())
			present();
	}
	catch (const std::bad_alloc&) {
		// The results are there, if not as they are best seen.
	}
}

void DocumentEdit::present()
{
	for (int id : added) {
		MeshModel& layer = *document.getMesh(id);
		if (layer.cm.fn > 0)
			continue;
		// Curves and points have no normals; with the shading that comes of it they would be all but
		// black.
		layer.clearDataMask(MeshModel::MM_VERTNORMAL);
		const std::vector<double> values = vertexQuality(layer);
		if (!values.empty())
			setVertexColours(layer, values, 0, *std::max_element(values.begin(), values.end()));
	}
	sources.insert(sources.end(), added.begin(), added.end() - 1);
	for (int id : sources)
		if (id >= 0 && document.getMesh(id))
			document.setVisible(id, false);
}

} // namespace mcfskel
