// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "stored_state.h"

#include <QRegularExpression>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace mcfskel {

namespace {

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
	if (state && state->diagonal > 0 && state->curve && hasEdgesOf(layer, state->curve->skeleton))
		return state->diagonal;
	if (state && state->stage && hasTrianglesOf(layer, *state->stage.stage))
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

namespace {

/// Finds what the filters append to names.
const QRegularExpression& appendedName()
{
	static const QRegularExpression appended(
		"_(solid|resampled|meso_\\d+|skeleton|refined|poles|pruned|smoothed|medial|balls|tubes)$");
	return appended;
}

/// A name without copy number and file type.
QString plainName(QString name)
{
	static const QRegularExpression copyNumber("\\(\\d+\\)$");
	static const QRegularExpression fileType("\\.[A-Za-z0-9]{1,5}$");
	name.remove(copyNumber);
	name.remove(fileType);
	return name;
}

} // namespace

QString baseName(QString name)
{
	name = plainName(name).remove(appendedName());
	return name.isEmpty() ? QString("mesh") : name;
}

QString baseName(const MeshModel& layer)
{
	return baseName(layer.label());
}

bool hasMadeName(const MeshModel& layer)
{
	return plainName(layer.label()).contains(appendedName());
}

namespace {

/// The triangles of a layer, deleted ones left out, rounded by SurfaceRounding.
struct LayerTriangles
{
	std::vector<vcg::Point3d> points;
	std::vector<mcf::Triangle> triangles;
	std::vector<int> pointOfSlot; ///< -1: deleted
};

/// The surface that a layer's state holds, if it has one.
/// @throws InvalidInput if the layer is no surface.
std::optional<SurfaceLayer> surfaceInState(const MeshModel& layer)
{
	requireOwnAttributes(layer);
	const std::string label = "'" + layer.label().toStdString() + "'";
	const StatePointer state = findState(layer.cm);
	if (state && state->stage && hasTrianglesOf(layer, *state->stage.stage))
		throw mcf::InvalidInput("The current layer " + label
			+ " is a stage of the contraction, not a surface: make the surface layer current.");
	if (const StatePointer valid = validState(layer); valid && valid->surface.mesh)
		return valid->surface;
	if (layer.cm.fn == 0 && layer.cm.en > 0)
		throw mcf::InvalidInput("The current layer " + label
			+ " is a curve, edges without faces: make the surface layer current.");
	return std::nullopt;
}

LayerTriangles readTriangles(const MeshModel& layer, const mcf::Progress& progress)
{
	const CMeshO& mesh = layer.cm;
	const char* const what = "Reading the layer";
	LayerTriangles read;
	read.pointOfSlot.reserve(mesh.vert.size());
	read.points.reserve(size_t(mesh.vn));
	mcf::detail::reportedLoop(int(mesh.vert.size()), progress.part(0, 0.5), what, [&](int slot) {
		const CVertexO& v = mesh.vert[size_t(slot)];
		read.pointOfSlot.push_back(v.IsD() ? -1 : int(read.points.size()));
		if (!v.IsD())
			read.points.push_back(toDouble(v.cP()));
	});
	read.triangles.reserve(size_t(mesh.fn));
	mcf::detail::reportedLoop(int(mesh.face.size()), progress.part(0.5, 1), what, [&](int i) {
		const CFaceO& f = mesh.face[size_t(i)];
		if (f.IsD())
			return;
		mcf::Triangle triangle;
		for (int k = 0; k < 3; ++k) {
			const size_t slot = vcg::tri::Index(mesh, f.cV(k));
			// A host may read an index from a file that no vertex has: the input check refuses it.
			triangle[size_t(k)] = slot < read.pointOfSlot.size()
				? read.pointOfSlot[slot]
				: int(std::min<size_t>(slot, std::numeric_limits<int>::max()));
		}
		read.triangles.push_back(triangle);
	});
	const mcf::SurfaceRounding rounded(read.points, read.triangles, progress);
	mcf::detail::reportedLoop(int(read.points.size()), progress.cancelOnly(), what,
		[&](int i) { read.points[size_t(i)] = rounded(read.points[size_t(i)]); });
	return read;
}

SurfaceLayer surfaceLayer(mcf::CheckedSurface&& checked, const std::vector<int>& pointOfSlot,
	const mcf::Progress& progress)
{
	auto vertexOfSlot = std::make_shared<std::vector<int>>();
	vertexOfSlot->reserve(pointOfSlot.size());
	mcf::detail::reportedLoop(
		int(pointOfSlot.size()), progress, "Reading the layer", [&](int slot) {
			const int point = pointOfSlot[size_t(slot)];
			vertexOfSlot->push_back(point < 0 ? -1 : checked.vertexOfInput[size_t(point)]);
		});
	return {std::make_shared<const mcf::SurfaceMesh>(std::move(checked.mesh)), vertexOfSlot,
		std::move(checked.notes), std::move(checked.turned)};
}

} // namespace

SurfaceLayer readSurface(const MeshModel& layer, const mcf::Progress& progress)
{
	if (std::optional<SurfaceLayer> known = surfaceInState(layer))
		return *known;
	const LayerTriangles read = readTriangles(layer, progress.part(0, 0.2));
	return surfaceLayer(mcf::checkedSurface(read.points, read.triangles, progress.part(0.2, 1)),
		read.pointOfSlot, progress.cancelOnly());
}

namespace {

/// The triangles of a surface in a state, its pieces turned as they were given.
LayerTriangles trianglesAsGiven(const SurfaceLayer& surface, const mcf::Progress& progress)
{
	const mcf::SurfaceMesh& mesh = *surface.mesh;
	if (surface.turned.empty())
		return {mesh.position, mesh.triangles(progress), *surface.vertexOfSlot};
	const std::vector<int> piece = mcf::connectedComponents(mesh, nullptr, progress);
	const mcf::SurfaceMesh given = mcf::withPiecesTurned(mesh, piece, surface.turned, progress);
	return {mesh.position, given.triangles(progress), *surface.vertexOfSlot};
}

/// A surface that needs no repair, without the pieces that are too small. If it was never to be
/// repaired its cavities are reported.
SolidLayer soundSolid(
	const SurfaceLayer& known, const mcf::SolidChoices& choices, const mcf::Progress& progress)
{
	SolidLayer same {known, {}};
	const bool isToReport = choices.withoutCavities && choices.repair == mcf::Repair::Off
		&& known.soundWith == mcf::Repair::Off && !known.turned.empty();
	if (!(choices.minComponent > 0) && !isToReport)
		return same;
	mcf::CheckedSurface pieces {*known.mesh, *known.vertexOfSlot, known.turned, known.notes};
	same.report.leftOut = mcf::keepSolidPieces(pieces, choices.minComponent,
		isToReport ? mcf::Cavities::Reported : mcf::Cavities::Kept, progress);
	if (same.isRepaired()) {
		same.surface.mesh = std::make_shared<const mcf::SurfaceMesh>(std::move(pieces.mesh));
		same.surface.vertexOfSlot =
			std::make_shared<const std::vector<int>>(std::move(pieces.vertexOfInput));
		same.surface.turned.clear();
	}
	same.surface.notes = std::move(pieces.notes);
	if (!same.surface.hollow)
		same.surface.hollow = same.report.leftOut.hollow;
	return same;
}

} // namespace

SolidLayer readSolid(
	const MeshModel& layer, const mcf::SolidChoices& choices, const mcf::Progress& progress)
{
	std::optional<SurfaceLayer> known = surfaceInState(layer);
	// All states hold what checkedSurface() accepts; Auto does all that Mend does.
	if (known && known->soundWith <= choices.repair)
		return soundSolid(*known, choices, progress);
	const LayerTriangles read = known ? trianglesAsGiven(*known, progress.cancelOnly())
									  : readTriangles(layer, progress.part(0, 0.2));
	mcf::SolidSurface solid =
		mcf::solidSurface(read.points, read.triangles, choices, progress.part(0.2, 0.95));
	const mcf::SolidReport& report = solid.report;
	const bool isSound = report.outcome == mcf::SolidReport::Sound && report.leftOut.cavities == 0;
	if (known && isSound) {
		if (choices.withoutCavities)
			known->soundWith = choices.repair;
		return soundSolid(*known, choices, progress.part(0.95, 1));
	}
	SolidLayer made {
		surfaceLayer(std::move(solid.surface), read.pointOfSlot, progress.cancelOnly()), report};
	made.surface.hollow = report.leftOut.hollow;
	if (known && !made.surface.hollow)
		made.surface.hollow = known->hollow;
	if (choices.withoutCavities)
		made.surface.soundWith = choices.repair;
	return made;
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

namespace {

/// Whether a layer of points has the attributes, or the name, of a skeleton.
bool wasCurve(const MeshModel& layer)
{
	static const QRegularExpression curveName("_(skeleton|refined|pruned|smoothed)(?![A-Za-z])");
	return findAttribute(layer.cm.vert_attr, radiusAttribute) || layer.label().contains(curveName);
}

} // namespace

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
	const auto* significance = findAttribute(mesh.vert_attr, significanceAttribute);
	const auto* bridge = findAttribute(mesh.vert_attr, bridgeAttribute);
	if (mesh.fn > 0)
		throw mcf::InvalidInput("The layer " + label
			+ " has faces, it is no curve skeleton: make a layer of nodes and edges current.");
	if (mesh.en == 0 && mesh.vn > 1 && wasCurve(layer))
		throw mcf::InvalidInput("The layer " + label + " has " + std::to_string(mesh.vn)
			+ " nodes of a skeleton but no edges any more: MeshLab's own PLY holds none. Make the skeleton "
			  "again, or open what 'Save Skeleton', 'Save Stage' or 'Save Project' wrote.");
	const bool isNode = mesh.vn == 1 && radius;
	const auto isEdge = [&](const CEdgeO& e) { return !e.IsD() && hasVertices(mesh, e); };
	if (!isNode && std::none_of(mesh.edge.begin(), mesh.edge.end(), isEdge))
		throw mcf::InvalidInput("The layer " + label
			+ " has no edges, it is no curve skeleton: make a layer of nodes and edges current.");

	CurveLayer curve;
	std::vector<int> nodeOfSlot(mesh.vert.size(), -1);
	for (int slot : liveSlots(mesh)) {
		nodeOfSlot[size_t(slot)] = int(curve.skeleton.position.size());
		curve.skeleton.position.push_back(toDouble(mesh.vert[size_t(slot)].cP()));
		if (radius && isOfType<Scalarm>(*radius))
			curve.skeleton.radius.push_back(double(valuesOf<Scalarm>(*radius)[slot]));
		if (significance && isOfType<Scalarm>(*significance))
			curve.skeleton.significance.push_back(double(valuesOf<Scalarm>(*significance)[slot]));
		if (bridge && isOfType<Scalarm>(*bridge))
			curve.skeleton.bridge.push_back(valuesOf<Scalarm>(*bridge)[slot] > 0);
	}
	const auto isSignificance = [](double value) { return value >= 0 && value <= 1; };
	auto& shown = curve.skeleton.significance;
	if (!std::all_of(shown.begin(), shown.end(), isSignificance))
		shown.clear(); // somebody else's
	auto& edges = curve.skeleton.edges;
	for (const CEdgeO& e : mesh.edge) {
		if (!isEdge(e))
			continue;
		const auto ends = std::minmax(
			nodeOfSlot[vcg::tri::Index(mesh, e.cV(0))], nodeOfSlot[vcg::tri::Index(mesh, e.cV(1))]);
		if (ends.first == ends.second)
			throw mcf::InvalidInput("The layer " + label + " has an edge from a vertex to itself.");
		edges.push_back({ends.first, ends.second});
	}
	std::sort(edges.begin(), edges.end());
	edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
	requireUsablePlaces(layer, curve.skeleton.position);
	return curve;
}

SurfaceLink surfaceOfCurve(const MeshModel& layer)
{
	const StatePointer state = findState(layer.cm);
	return state && state->curve && hasEdgesOf(layer, state->curve->skeleton)
		? state->curve->surface
		: SurfaceLink();
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
	shown->centre = mcf::detail::filledArray(count, vcg::Point3d(0, 0, 0), progress);
	shown->radius = mcf::detail::filledArray(count, -1.0, progress);
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

} // namespace mcfskel
