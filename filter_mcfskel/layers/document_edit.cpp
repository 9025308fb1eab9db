// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../host/scene.h"
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
		if (MeshModel* layer = document.getMesh(attribute.layer))
			removeAttribute(layer->cm.vert_attr, attribute.name);
	for (int id : added)
		if (document.getMesh(id))
			host::removeLayer(document, id);
	if (previousLayer >= 0 && document.getMesh(previousLayer))
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

MeshModel& DocumentEdit::addCurve(const QString& label, const CurveLayer& curve, double diagonal)
{
	MeshModel& layer = addLayer(curve.surface, label);
	fillCurve(layer, curve, diagonal);
	return layer;
}

#if MCFSKEL_SHEETS
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
#endif

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
		newAttributes.push_back({int(layer.id()), attribute});
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
	written.emplace_back(layer);
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
				// No pole: the vertex itself, in the box for readers that ignore the radius.
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
	written.emplace_back(layer);
	changes.push_back([attribute, values = std::move(values)]() mutable {
		for (size_t slot = 0; slot < values.size(); ++slot)
			attribute[slot] = values[slot];
	});
}

void DocumentEdit::writeNodes(const SurfaceLink& surface, const std::vector<int>& node)
{
	if (MeshModel* layer = layerOf(document, surface))
		writeNodes(*layer, *surface.vertexOfSlot, node);
}

void DocumentEdit::commit()
{
	for (const LayerAsRead& layer : written)
		layer.in(document);
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
		// The results are there, only not presented.
	}
}

namespace {

bool isStage(const MeshModel& layer)
{
	const StatePointer state = findState(layer.cm);
	return state && state->stage;
}

host::Look lookOfStage(const MeshModel& layer)
{
	constexpr double mostlyFlat = 0.3; // of the surface's area
	return findState(layer.cm)->stage.stage->areaFraction() < mostlyFlat ? host::Look::ThinStage
																		 : host::Look::Stage;
}

bool isCurve(const MeshModel& layer)
{
	return layer.cm.fn == 0 && layer.cm.en > 0;
}

} // namespace

const MeshModel* DocumentEdit::surfaceToOutline() const
{
	const MeshModel& shown = *document.getMesh(added.back());
	std::vector<const MeshModel*> madeFrom;
	for (const MeshModel* layer : host::layersOf(document))
		if (std::find(sources.begin(), sources.end(), int(layer->id())) != sources.end())
			madeFrom.push_back(layer);
	const bool fromCurve = std::any_of(
		madeFrom.begin(), madeFrom.end(), [](const MeshModel* l) { return isCurve(*l); });
	if (shown.cm.fn > 0 && !fromCurve)
		return nullptr;
	const MeshModel* best = nullptr;
	const auto offer = [&](const MeshModel* layer, bool mayBeHidden) {
		const bool fits = layer != &shown && layer->cm.fn > 0 && !isStage(*layer)
			&& layer->cm.vn <= host::maxOutlineVertices && (mayBeHidden || layer->isVisible());
		if (fits && !(best && best->cm.vn <= host::maxEdgedVertices))
			best = layer;
	};
	if (fromCurve)
		for (const MeshModel* layer : host::layersOf(document)) {
			if (baseName(*layer) == baseName(shown))
				offer(layer, false);
		}
	else {
		for (const MeshModel* layer : madeFrom)
			offer(layer, true);
		for (int id : added)
			offer(document.getMesh(id), true);
	}
	return best;
}

void DocumentEdit::present()
{
	for (int id : added) {
		MeshModel& layer = *document.getMesh(id);
		if (layer.cm.fn > 0)
			continue;
		// Curves and points have no normals; shaded, they would be almost black.
		layer.clearDataMask(MeshModel::MM_VERTNORMAL);
		const std::vector<double> values = vertexQuality(layer);
		if (!values.empty())
			setVertexColours(layer, values, 0, *std::max_element(values.begin(), values.end()));
	}
	const MeshModel& shown = *document.getMesh(added.back());
	const MeshModel* const outline = surfaceToOutline();
	std::vector<std::pair<int, host::Look>> looks;
	for (const MeshModel* layer : host::layersOf(document)) {
		const int id = int(layer->id());
		const bool isNew = std::find(added.begin(), added.end(), id) != added.end();
		const bool isSource = std::find(sources.begin(), sources.end(), id) != sources.end();
		if (isNew && isStage(*layer))
			looks.emplace_back(id, lookOfStage(*layer));
		else if (isNew && layer->cm.fn == 0 && layer->cm.en > 0)
			looks.emplace_back(id, host::Look::Curve);
		if (layer == outline)
			looks.emplace_back(id, host::Look::Outline);
		// What was made from the same surface before would hide the new layer.
		const bool isKin = baseName(*layer) == baseName(shown) && hasMadeName(*layer);
		if (layer != &shown && layer != outline && (isNew || isSource || isKin))
			document.setVisible(id, false);
	}
	if (outline)
		document.setVisible(int(outline->id()), true);
	host::setLooks(document, looks);
}

} // namespace mcfskel
