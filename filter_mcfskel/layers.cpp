// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "layers.h"

#include "attributes.h"
#include "fields.h"

#include <skeleton/check_input.h>
#include <skeleton/errors.h>
#include <skeleton/surface_rounding.h>
#include <skeleton/ticker.h>

#include <QRegularExpression>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <typeindex>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;
using Allocator = vcg::tri::Allocator<CMeshO>;

namespace {

constexpr char poleAttribute[] = "mcfskel_pole";
constexpr char poleRadiusAttribute[] = "mcfskel_pole_radius";
constexpr char fixedAttribute[] = "mcfskel_fixed";
constexpr char heldAttribute[] = "mcfskel_held";
constexpr char radiusAttribute[] = "mcfskel_radius";
constexpr char nodeAttribute[] = "mcfskel_node";
constexpr char kindAttribute[] = "mcfskel_kind";
constexpr char stateAttribute[] = "mcfskel_state";

/// What a layer knows beyond its attributes. Immutable: copies share it.
struct LayerState
{
	/// Of the geometry that the state belongs to.
	std::uint64_t fingerprint = 0;
	/// Surface layers.
	SurfaceLayer surface;
	std::shared_ptr<const mcf::PoleSet> poles;
	/// Stages.
	StageLayer stage;
	/// Skeletons.
	std::shared_ptr<const CurveLayer> curve;
	/// What 100 % of a Length meant where a skeleton was made; 0: not known.
	double diagonal = 0;
};

using StatePointer = std::shared_ptr<const LayerState>;
using StateAttribute = MeshAttribute<StatePointer>;
using StateMark = StateAttribute::AttrType;

template <class Value>
void mix(std::uint64_t& hash, Value value)
{
	static_assert(sizeof(Value) <= sizeof(std::uint64_t));
	std::uint64_t word = 0;
	std::memcpy(&word, &value, sizeof value);
	hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
	hash ^= hash >> 29;
}

/// A number that changes with any coordinate, any corner, any edge and any deletion.
std::uint64_t fingerprint(const CMeshO& mesh)
{
	std::uint64_t hash = mesh.vert.size();
	for (const CVertexO& v : mesh.vert) {
		mix(hash, int(v.IsD()));
		for (int k = 0; k < 3; ++k)
			mix(hash, v.cP()[k]);
	}
	for (const CFaceO& f : mesh.face)
		for (int k = 0; k < 3; ++k)
			mix(hash, f.IsD() ? -1 : int(vcg::tri::Index(mesh, f.cV(k))));
	for (const CEdgeO& e : mesh.edge)
		for (int k = 0; k < 2; ++k)
			mix(hash, e.IsD() ? -1 : int(vcg::tri::Index(mesh, e.cV(k))));
	return hash;
}

/// Removes an attribute, if it is there. Unlike VCG's way to do so this needs no memory.
void removeAttribute(std::set<vcg::PointerToAttribute>& attributes, const char* name)
{
	const auto found = std::find_if(attributes.begin(), attributes.end(),
		[&](const vcg::PointerToAttribute& attribute) { return attribute._name == name; });
	if (found == attributes.end())
		return;
	delete found->_handle;
	attributes.erase(found);
}

/// VCG finds attributes by name and size alone and writes beyond the end where the size differs.
template <class T>
bool isOfType(const vcg::PointerToAttribute& attribute)
{
	return attribute._type == std::type_index(typeid(T)) && attribute._sizeof == int(sizeof(T));
}

/// The values of an attribute, for reading: VCG of 2020 hands out none from a constant mesh.
/// @pre isOfType<T>()
template <class T>
const T* valuesOf(const vcg::PointerToAttribute& attribute)
{
	return static_cast<const T*>(attribute._handle->DataBegin());
}

template <class T>
void requireType(
	const MeshModel& layer, const std::set<vcg::PointerToAttribute>& attributes, const char* name)
{
	const auto* attribute = findAttribute(attributes, name);
	if (attribute && !isOfType<T>(*attribute))
		throw mcf::InvalidInput("The layer '" + layer.label().toStdString() + "' has an attribute '"
			+ name + "' of another type, made by something else: remove it, or use another layer.");
}

/// Refuses a layer on which something else has used one of the project's names.
void requireOwnAttributes(const MeshModel& layer)
{
	requireType<Point3m>(layer, layer.cm.vert_attr, poleAttribute);
	for (const char* name : {poleRadiusAttribute, fixedAttribute, heldAttribute, radiusAttribute,
			 nodeAttribute, kindAttribute})
		requireType<Scalarm>(layer, layer.cm.vert_attr, name);
	requireType<StateMark>(layer, layer.cm.vert_attr, stateAttribute);
}

/// Handle to a per-vertex attribute, made if need be.
template <class T>
auto vertexAttribute(MeshModel& layer, const char* name)
{
	requireType<T>(layer, layer.cm.vert_attr, name);
	if (!findAttribute(layer.cm.vert_attr, name))
		addVertexAttribute<VertexAttribute<T>>(layer.cm, name);
	return Allocator::GetPerVertexAttribute<T>(layer.cm, name);
}

/// Where a layer's state is; null if it has none.
StateAttribute* findStateAttribute(const CMeshO& mesh)
{
	const auto* attribute = findAttribute(mesh.vert_attr, stateAttribute);
	return attribute && isOfType<StateMark>(*attribute)
		? static_cast<StateAttribute*>(attribute->_handle)
		: nullptr;
}

StatePointer findState(const CMeshO& mesh)
{
	const StateAttribute* attribute = findStateAttribute(mesh);
	return attribute ? attribute->content : nullptr;
}

/// The state of a layer, if its geometry is still what the state describes.
StatePointer validState(const MeshModel& layer)
{
	StatePointer state = findState(layer.cm);
	return state && state->fingerprint == fingerprint(layer.cm) ? state : nullptr;
}

/// A state for a layer as it is now.
StatePointer newState(const MeshModel& layer, LayerState state)
{
	state.fingerprint = fingerprint(layer.cm);
	return std::make_shared<const LayerState>(std::move(state));
}

/// A layer's state, made if need be.
StateAttribute& stateOf(MeshModel& layer)
{
	requireType<StateMark>(layer, layer.cm.vert_attr, stateAttribute);
	StateAttribute* attribute = findStateAttribute(layer.cm);
	return attribute ? *attribute : addVertexAttribute<StateAttribute>(layer.cm, stateAttribute);
}

void setState(MeshModel& layer, LayerState state)
{
	stateOf(layer).content = newState(layer, std::move(state));
}

vcg::Point3d toDouble(const Point3m& p)
{
	return vcg::Point3d(p[0], p[1], p[2]);
}

Point3m toHost(const vcg::Point3d& p)
{
	return Point3m(Scalarm(p[0]), Scalarm(p[1]), Scalarm(p[2]));
}

vcg::Box3d liveBounds(const CMeshO& mesh)
{
	vcg::Box3d box;
	for (const CVertexO& v : mesh.vert)
		if (!v.IsD())
			box.Add(toDouble(v.cP()));
	return box;
}

/// The slots of a layer that are vertices, in order.
std::vector<int> liveSlots(const CMeshO& mesh)
{
	std::vector<int> live;
	live.reserve(size_t(mesh.vn));
	for (size_t i = 0; i < mesh.vert.size(); ++i)
		if (!mesh.vert[i].IsD())
			live.push_back(int(i));
	return live;
}

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

void writePoints(MeshModel& layer, const char* name, const std::vector<vcg::Point3d>& values,
	const mcf::Progress& progress)
{
	writeAttribute<Point3m>(layer, name, values, progress, toHost);
}

void writeQuality(MeshModel& layer, const std::vector<double>& values,
	const mcf::Progress& progress = mcf::Progress())
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY);
	mcf::detail::reportedLoop(int(values.size()), progress, writing, [&](int i) {
		auto& quality = layer.cm.vert[size_t(i)].Q();
		quality = std::decay_t<decltype(quality)>(values[size_t(i)]);
	});
}

void addVertices(MeshModel& layer, const std::vector<vcg::Point3d>& points)
{
	auto vertex = Allocator::AddVertices(layer.cm, points.size());
	for (const vcg::Point3d& p : points)
		(vertex++)->P() = toHost(p);
}

/// Whether each pole is at its radius from its vertex, as those of an edited mesh are not.
bool fits(const mcf::PoleSet& poles, const mcf::SurfaceMesh& mesh)
{
	const double tolerance = 1e-4 * mesh.bounds().Diag();
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		if (!std::isfinite(poles.radius[v]))
			return false;
		if (!poles.has(v))
			continue;
		const double distance = vcg::Distance(poles.centre[v], mesh.position[v]);
		if (!(std::abs(distance - poles.radius[v]) <= tolerance))
			return false;
	}
	return true;
}

/// Whether the exact poles are what the host's scalars show.
bool sameInHost(const mcf::PoleSet& exact, const mcf::PoleSet& shown)
{
	for (size_t v = 0; v < exact.radius.size(); ++v) {
		if (Scalarm(exact.radius[v]) != Scalarm(shown.radius[v]))
			return false;
		if (exact.has(int(v)) && toHost(exact.centre[v]) != toHost(shown.centre[v]))
			return false;
	}
	return true;
}

} // namespace

double referenceDiagonal(const MeshModel& layer)
{
	vcg::Box3d box;
	const StatePointer state = findState(layer.cm);
	if (state && state->diagonal > 0 && validState(layer))
		return state->diagonal;
	if (state && state->stage)
		for (const vcg::Point3d& p : *state->stage.stage->surface)
			box.Add(p);
	else if (box = liveBounds(layer.cm); !box.IsNull()) {
		const mcf::SurfaceRounding rounded(box);
		box.min = rounded(box.min);
		box.max = rounded(box.max);
	}
	const double diagonal = box.IsNull() ? 0 : box.Diag();
	return std::isfinite(diagonal) ? diagonal : 0;
}

QString baseName(QString name)
{
	static const QRegularExpression copyNumber("\\(\\d+\\)$");
	static const QRegularExpression fileType("\\.[A-Za-z0-9]{1,5}$");
	static const QRegularExpression appended(
		"_(resampled|meso_\\d+|skeleton|refined|poles|pruned|smoothed|medial|balls)$");
	name.remove(copyNumber);
	name.remove(fileType);
	name.remove(appended);
	return name.isEmpty() ? QString("mesh") : name;
}

QString baseName(const MeshModel& layer)
{
	return baseName(layer.label());
}

SurfaceLayer readSurface(const MeshModel& layer, const mcf::Progress& progress)
{
	requireOwnAttributes(layer);
	const std::string label = "'" + layer.label().toStdString() + "'";
	if (const StatePointer state = validState(layer)) {
		if (state->stage)
			throw mcf::InvalidInput("The current layer " + label
				+ " is a stage of the contraction, not a surface: make the surface layer current.");
		if (state->surface.mesh)
			return state->surface;
	}
	const CMeshO& mesh = layer.cm;
	if (mesh.fn == 0 && mesh.en > 0)
		throw mcf::InvalidInput("The current layer " + label
			+ " is a curve, edges without faces: make the surface layer current.");

	const char* const what = "Reading the layer";
	const int slotCount = int(mesh.vert.size());
	std::vector<int> pointOfSlot;
	pointOfSlot.reserve(mesh.vert.size());
	std::vector<vcg::Point3d> points;
	points.reserve(size_t(mesh.vn));
	vcg::Box3d box;
	mcf::detail::reportedLoop(slotCount, progress.part(0, 0.1), what, [&](int slot) {
		const CVertexO& v = mesh.vert[size_t(slot)];
		pointOfSlot.push_back(v.IsD() ? -1 : int(points.size()));
		if (v.IsD())
			return;
		points.push_back(toDouble(v.cP()));
		box.Add(points.back());
	});
	const mcf::SurfaceRounding rounded(box);
	mcf::detail::reportedLoop(int(points.size()), progress.part(0.1, 0.1), what,
		[&](int i) { points[size_t(i)] = rounded(points[size_t(i)]); });
	std::vector<mcf::Triangle> triangles;
	triangles.reserve(size_t(mesh.fn));
	mcf::detail::reportedLoop(int(mesh.face.size()), progress.part(0.1, 0.2), what, [&](int i) {
		const CFaceO& f = mesh.face[size_t(i)];
		if (f.IsD())
			return;
		mcf::Triangle triangle;
		for (int k = 0; k < 3; ++k)
			triangle[size_t(k)] = pointOfSlot[vcg::tri::Index(mesh, f.cV(k))];
		triangles.push_back(triangle);
	});
	mcf::CheckedSurface checked = mcf::checkedSurface(points, triangles, progress.part(0.2, 1));
	auto vertexOfSlot = std::make_shared<std::vector<int>>();
	vertexOfSlot->reserve(pointOfSlot.size());
	mcf::detail::reportedLoop(slotCount, progress.part(1, 1), what, [&](int slot) {
		const int point = pointOfSlot[size_t(slot)];
		vertexOfSlot->push_back(point < 0 ? -1 : checked.vertexOfInput[size_t(point)]);
	});
	return {std::make_shared<const mcf::SurfaceMesh>(std::move(checked.mesh)), vertexOfSlot,
		std::move(checked.notes)};
}

std::vector<char> readSelection(
	const MeshModel& layer, const std::vector<int>& vertexOfSlot, int vertices)
{
	std::vector<char> selected(size_t(vertices), 0);
	bool any = false;
	for (size_t slot = 0; slot < layer.cm.vert.size(); ++slot) {
		const CVertexO& v = layer.cm.vert[slot];
		if (v.IsD() || !v.IsS() || vertexOfSlot[slot] < 0)
			continue;
		selected[size_t(vertexOfSlot[slot])] = 1;
		any = true;
	}
	return any ? selected : std::vector<char>();
}

std::vector<char> readSelection(const MeshModel& layer)
{
	std::vector<int> identity(layer.cm.vert.size());
	std::iota(identity.begin(), identity.end(), 0);
	return readSelection(layer, identity, int(identity.size()));
}

StageLayer readStage(const MeshModel& layer)
{
	const StatePointer state = validState(layer);
	return state ? state->stage : StageLayer();
}

std::vector<int> CurveLayer::nodeOfLayerVertex() const
{
	std::vector<int> result;
	if (skeleton.node.empty() || !surface.vertexOfSlot)
		return result;
	for (int v : *surface.vertexOfSlot)
		result.push_back(v < 0 ? -1 : skeleton.node[size_t(v)]);
	return result;
}

CurveLayer readCurve(const MeshModel& layer)
{
	if (const StatePointer state = validState(layer); state && state->curve)
		return *state->curve;
	const std::string label = "'" + layer.label().toStdString() + "'";
	const CMeshO& mesh = layer.cm;
	const auto* radius = findAttribute(mesh.vert_attr, radiusAttribute);
	if (mesh.fn > 0)
		throw mcf::InvalidInput("The layer " + label
			+ " has faces, it is no curve skeleton: make a layer of nodes and edges current.");
	if (mesh.en == 0 && !(mesh.vn == 1 && radius))
		throw mcf::InvalidInput("The layer " + label
			+ " has no edges, it is no curve skeleton: make a layer of nodes and edges current.");

	CurveLayer curve;
	std::vector<int> nodeOfSlot(mesh.vert.size(), -1);
	for (int slot : liveSlots(mesh)) {
		nodeOfSlot[size_t(slot)] = int(curve.skeleton.position.size());
		curve.skeleton.position.push_back(toDouble(mesh.vert[size_t(slot)].cP()));
		if (radius && isOfType<Scalarm>(*radius))
			curve.skeleton.radius.push_back(double(valuesOf<Scalarm>(*radius)[slot]));
	}
	auto& edges = curve.skeleton.edges;
	for (const CEdgeO& e : mesh.edge) {
		if (e.IsD())
			continue;
		const auto ends = std::minmax(
			nodeOfSlot[vcg::tri::Index(mesh, e.cV(0))], nodeOfSlot[vcg::tri::Index(mesh, e.cV(1))]);
		if (ends.first == ends.second)
			throw mcf::InvalidInput("The layer " + label + " has an edge from a vertex to itself.");
		edges.push_back({ends.first, ends.second});
	}
	std::sort(edges.begin(), edges.end());
	edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
	return curve;
}

std::vector<int> readNodes(const MeshModel& layer)
{
	std::vector<int> result;
	const auto* attribute = findAttribute(layer.cm.vert_attr, nodeAttribute);
	if (!attribute || !isOfType<Scalarm>(*attribute))
		return result;
	for (int slot : liveSlots(layer.cm)) {
		const double value = double(valuesOf<Scalarm>(*attribute)[slot]);
		// Negated, so that NaN counts as no node.
		result.push_back(!(value >= 0 && value <= 1e9) ? -1 : int(value));
	}
	return result;
}

bool hasStageAttributes(const MeshModel& layer)
{
	return findAttribute(layer.cm.vert_attr, fixedAttribute) != nullptr;
}

std::shared_ptr<const mcf::PoleSet> readPoles(
	const MeshModel& layer, const SurfaceLayer& surface, const mcf::Progress& progress)
{
	const char* const what = "Reading the layer";
	progress.report(0, what);
	const auto* centreFound = findAttribute(layer.cm.vert_attr, poleAttribute);
	const auto* radiusFound = findAttribute(layer.cm.vert_attr, poleRadiusAttribute);
	if (!centreFound || !radiusFound)
		return nullptr;
	const auto* centre = valuesOf<Point3m>(*centreFound);
	const auto* radius = valuesOf<Scalarm>(*radiusFound);

	auto shown = std::make_shared<mcf::PoleSet>();
	const size_t count = size_t(surface.mesh->vertexSlots());
	shown->centre = mcf::detail::filledArray(count, vcg::Point3d(0, 0, 0), progress, what);
	shown->radius = mcf::detail::filledArray(count, -1.0, progress, what);
	const std::vector<int>& vertexOfSlot = *surface.vertexOfSlot;
	mcf::detail::reportedLoop(int(vertexOfSlot.size()), progress, what, [&](int slot) {
		const int v = vertexOfSlot[size_t(slot)];
		if (v < 0)
			return;
		shown->centre[size_t(v)] = toDouble(centre[slot]);
		shown->radius[size_t(v)] = double(radius[slot]);
	});
	progress.report(1, what);
	const StatePointer state = validState(layer);
	if (state && state->poles && sameInHost(*state->poles, *shown))
		return state->poles;
	return fits(*shown, *surface.mesh) ? shown : nullptr;
}

SurfaceLink linkTo(const MeshModel& layer, const SurfaceLayer& surface)
{
	return {layer.id(), fingerprint(layer.cm), surface.vertexOfSlot};
}

namespace {

/// With the normals of its faces, and of its vertices, means by area: those that MeshLab makes, means by
/// angle, take longer than all the rest.
/// @throws Cancelled
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
		const vcg::Point3d normal = mesh.areaVector(f);
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

/// Curves vermilion, sheets blue, volume grey: told apart by colour-blind eyes, too.
void writeKinds(MeshModel& layer, const std::vector<mcf::VertexKind>& kinds,
	const mcf::Progress& progress = mcf::Progress())
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

/// @throws Cancelled
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

} // namespace

namespace {

void fillCurve(MeshModel& layer, const CurveLayer& curve, double diagonal)
{
	fillCurve(layer, curve.skeleton.position, curve.skeleton.edges, curve.skeleton.radius);
	LayerState state;
	state.curve = std::make_shared<const CurveLayer>(curve);
	state.diagonal = diagonal;
	setState(layer, std::move(state));
}

} // namespace

void fillCurve(MeshModel& layer, const CurveLayer& curve)
{
	fillCurve(layer, curve, 0);
}

SurfaceLink linkTo(
	const MeshDocument& document, std::uint64_t wanted, std::vector<int> vertexOfSlot)
{
	SurfaceLink link;
	link.fingerprint = wanted;
	for (const MeshModel* layer : host::layersOf(document))
		if (link.layerId < 0 && layer->cm.vert.size() == vertexOfSlot.size()
			&& fingerprint(layer->cm) == wanted)
			link.layerId = layer->id();
	link.vertexOfSlot = std::make_shared<const std::vector<int>>(std::move(vertexOfSlot));
	return link;
}

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
