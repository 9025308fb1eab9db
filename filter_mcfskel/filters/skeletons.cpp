// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "skeletons.h"

#include "../layers/fields.h"

#include <skeleton/curves.h>
#include <skeleton/solid.h>
#include <skeleton/state.h>
#include <skeleton/support.h>
#include <skeleton/surface.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

constexpr char reading[] = "Reading the layer";

/// The layer of the surface that a skeleton remembers, if it is still there and unchanged.
MeshModel* rememberedLayer(const FilterRun& run, const CurveLayer& curve)
{
	return layerOf(run.document, curve.surface);
}

/// The attribute mcfskel_node, if all of it fits a skeleton of that many nodes; else empty.
std::vector<int> nodesFromAttribute(
	const FilterRun& run, const SkeletonSurface& surface, size_t nodes)
{
	const MeshModel& layer = surface.layer.in(run.document);
	const std::vector<int> shown = readNodes(layer);
	std::vector<int> result(size_t(surface.surface.mesh->vertexSlots()), -1);
	size_t next = 0;
	bool any = false;
	for (size_t slot = 0; slot < layer.cm.vert.size(); ++slot) {
		if (layer.cm.vert[slot].IsD() || next >= shown.size())
			continue;
		const int node = shown[next++];
		const int v = (*surface.surface.vertexOfSlot)[slot];
		if (node >= int(nodes))
			return {};
		any = any || node >= 0;
		if (v >= 0)
			result[size_t(v)] = node;
	}
	return any ? result : std::vector<int>();
}

/// A layer's vertices that are to get nodes.
struct NodeBearers
{
	LayerAsRead layer;
	std::vector<vcg::Point3d> position;
	/// For each vertex slot of the layer its number in `position`, or -1.
	std::vector<int> ofSlot;
};

/// Those of a layer with mcfskel_node that have a node: pieces without a skeleton have none.
NodeBearers nodeBearers(const MeshModel& layer, const mcf::Progress& progress)
{
	NodeBearers result {LayerAsRead(layer), {}, {}};
	const std::vector<int> shown = readNodes(layer);
	std::vector<vcg::Point3d> places;
	std::vector<char> bears;
	size_t next = 0;
	for (const CVertexO& v : layer.cm.vert) {
		places.emplace_back(v.cP()[0], v.cP()[1], v.cP()[2]);
		bears.push_back(!v.IsD() && next < shown.size() && shown[next++] >= 0);
	}
	try {
		const SurfaceLayer surface = readSurface(layer, progress);
		for (size_t slot = 0; slot < places.size(); ++slot) {
			const int v = (*surface.vertexOfSlot)[slot];
			bears[slot] = bears[slot] && v >= 0;
			if (bears[slot])
				places[slot] = surface.mesh->position[size_t(v)];
		}
	}
	catch (const mcf::InvalidInput&) {
		// No surface by itself, such as a mesh with holes that was repaired.
	}
	for (size_t slot = 0; slot < places.size(); ++slot) {
		const bool is = bears[slot] && mcf::isUsablePlace(places[slot]);
		result.ofSlot.push_back(is ? int(result.position.size()) : -1);
		if (is)
			result.position.push_back(places[slot]);
	}
	return result;
}

/// Whether places are those of another sampling of a surface: most of them lie on it, and they
/// reach as far as it does. Repairs and resampling move less, and other shapes are farther away.
bool areOf(const mcf::SurfaceMesh& surface, const std::vector<vcg::Point3d>& places,
	const mcf::Progress& progress)
{
	constexpr double away = 0.01, boxesApart = 0.05; // of the diagonal
	constexpr double most = 0.8;
	constexpr size_t samples = 1000;
	vcg::Box3d box;
	for (const vcg::Point3d& p : places)
		box.Add(p);
	const vcg::Box3d whole = surface.bounds(progress);
	const double diagonal = whole.Diag();
	if (box.IsNull() || vcg::Distance(box.min, whole.min) > boxesApart * diagonal
		|| vcg::Distance(box.max, whole.max) > boxesApart * diagonal)
		return false;
	const std::vector<mcf::Triangle> faces = surface.triangles(progress);
	const mcf::TriangleTree tree(surface.position, faces, progress);
	const size_t step = std::max<size_t>(1, places.size() / samples);
	size_t seen = 0, on = 0;
	for (size_t i = 0; i < places.size(); i += step) {
		++seen;
		on += tree.closest(places[i], away * diagonal).face >= 0;
	}
	return double(on) > most * double(seen);
}

/// The layers of the surfaces that the skeletons of a document remember.
std::vector<int> rememberedLayers(const FilterRun& run)
{
	std::vector<int> ids;
	for (const MeshModel* layer : host::layersOf(run.document))
		if (const MeshModel* surface = layerOf(run.document, surfaceOfCurve(*layer)))
			ids.push_back(int(surface->id()));
	return ids;
}

} // namespace

CurveLayer skeletonOn(const FilterRun& run, const MeshModel& layer)
{
	CurveLayer curve = readCurve(layer, sourcesOf(run));
	std::vector<double>& radius = curve.skeleton.radius;
	if (radius.empty())
		radius = vertexQuality(layer);
	radius.resize(curve.skeleton.position.size(), 0);
	for (double& r : radius)
		r = std::isfinite(r) ? std::max(r, 0.0) : 0;
	return curve;
}

void requireOneFrame(const MeshModel& one, const MeshModel& other)
{
	if (one.cm.Tr != other.cm.Tr)
		throw mcf::InvalidInput("The layers '" + one.label().toStdString() + "' and '"
			+ other.label().toStdString()
			+ "' have different transformations, so that their coordinates do not go together: "
			  "apply those of both with 'Matrix: Freeze Current Matrix' first.");
}

ParameterSpec surfaceParameter(const QString& whatFor)
{
	return {ParameterKind::Layer, "surface", 0, "Surface",
		whatFor
			+ " The skeleton's own layer stands for the surface that the skeleton was made from, as "
			  "long as that is there and unchanged."};
}

std::optional<SkeletonSurface> findSurface(
	const FilterRun& run, const CurveLayer& curve, const mcf::Progress& progress)
{
	progress.report(0, reading);
	const int id = run.parameters.integer("surface");
	const MeshModel* const remembered = rememberedLayer(run, curve);
	const MeshModel* const layer = id == run.current->id() ? remembered : run.document.getMesh(id);
	if (!layer)
		return std::nullopt;
	if (layer != remembered)
		requireOneFrame(run.layer(), *layer);
	return SkeletonSurface {LayerAsRead(*layer), readSurface(*layer, progress)};
}

SkeletonSurface requireSurface(
	const FilterRun& run, const CurveLayer& curve, const mcf::Progress& progress)
{
	std::optional<SkeletonSurface> surface = findSurface(run, curve, progress);
	if (!surface)
		throw mcf::InvalidInput("The skeleton '" + run.layer().label().toStdString()
			+ "' remembers no surface that is still there: give the layer of its surface as the "
			  "parameter surface.");
	logNotes(run, surface->surface);
	return *std::move(surface);
}

std::vector<int> nodesOnSurface(const FilterRun& run, const CurveLayer& curve,
	const SkeletonSurface& surface, const mcf::Progress& progress)
{
	progress.report(0, reading);
	const std::vector<int>& node = curve.skeleton.node;
	if (const MeshModel* remembered = node.empty() ? nullptr : rememberedLayer(run, curve)) {
		const bool isSurface = int(remembered->id()) == surface.layer.id();
		const SurfaceLayer own = readSurface(*remembered, progress.part(0, 0.5));
		if (own.mesh->position.size() == node.size())
			return isSurface ? node
							 : mcf::transferredNodes(
								 *own.mesh, node, *surface.surface.mesh, progress.part(0.5, 1));
	}
	return nodesFromAttribute(run, surface, curve.skeleton.position.size());
}

CurveLayer skeletonOf(const FilterRun& run, CurveLayer curve, const SkeletonSurface& surface,
	const mcf::Progress& progress)
{
	std::vector<int> node = nodesOnSurface(run, curve, surface, progress.part(0, 0.5));
	if (node.empty()) {
		run.log(
			"The skeleton knows nothing of this surface: each of its vertices goes to the nearest "
			"node.");
		const mcf::PointTree nodes(curve.skeleton.position);
		const std::vector<vcg::Point3d>& points = surface.surface.mesh->position;
		mcf::detail::reportedLoop(int(points.size()), progress.part(0.5, 1), reading,
			[&](int v) { node.push_back(nodes.nearest(points[size_t(v)])); });
	}
	curve.skeleton.node = std::move(node);
	progress.report(1, reading);
	const MeshModel& layer = surface.layer.in(run.document);
	curve.surface = linkTo(layer, surface.surface);
	curve.surfaceName = layer.label();
	return curve;
}

std::vector<double> clearances(const std::vector<vcg::Point3d>& nodes,
	const mcf::SurfaceMesh& surface, const mcf::Progress& progress)
{
	constexpr double spacing = 0.01;
	const char* const what = "Measuring the thickness";
	const vcg::Box3d box = surface.bounds(progress);
	const vcg::Point3d middle = box.Center();
	const double diagonal = box.Diag();
	mcf::SurfaceMesh unit = surface.copied(progress);
	mcf::detail::cancellableLoop(unit.vertexSlots(), progress, [&](int v) {
		vcg::Point3d& p = unit.position[size_t(v)];
		p = (p - middle) / diagonal;
	});
	const std::vector<int> all = mcf::detail::numberedArray(unit.position.size(), progress);
	const mcf::ClosestSurface closest(unit, all, spacing, progress.part(0, 0.8));
	std::vector<double> result(nodes.size());
	const auto measure = [&](int first, int end) {
		for (int v = first; v < end; ++v)
			result[size_t(v)] =
				std::max(closest.clearance((nodes[size_t(v)] - middle) / diagonal), 0.0) * diagonal;
	};
	mcf::forEachBlock(int(nodes.size()), progress.part(0.8, 1), what, measure);
	return result;
}

void addDerivedSkeleton(FilterRun& run, const CurveLayer& curve, mcf::CurveSkeleton skeleton,
	const char* suffix, bool measureRadius, const mcf::Progress& progress)
{
	progress.report(0, reading);
	std::optional<LayerAsRead> remembered;
	SurfaceLayer own;
	if (const MeshModel* layer = skeleton.node.empty() ? nullptr : rememberedLayer(run, curve)) {
		remembered.emplace(*layer);
		own = readSurface(*layer, progress.part(0, 0.3));
	}
	const bool fits = remembered && own.mesh->position.size() == skeleton.node.size();
	if (fits && measureRadius) {
		const std::vector<double> before = skeleton.radius;
		skeleton.radius =
			mcf::curveThickness(skeleton, own.mesh->position, progress.part(0.3, 0.5));
		for (size_t v = 0; v < before.size(); ++v)
			if (skeleton.radius[v] < 0)
				skeleton.radius[v] = before[v];
	}
	// The input and the solid got their correspondence from the surface that was contracted. Their
	// names are alike, but so may be those of another body, or of a surface of another skeleton.
	std::vector<int> kin;
	if (fits) {
		const QString name = baseName(remembered->in(run.document));
		const std::vector<int> ofSkeletons = rememberedLayers(run);
		for (const MeshModel* layer : host::layersOf(run.document)) {
			const int id = int(layer->id());
			if (id != remembered->id() && layer->cm.fn > 0 && lostState(*layer).isEmpty()
				&& !readNodes(*layer).empty() && baseName(*layer) == name
				&& std::find(ofSkeletons.begin(), ofSkeletons.end(), id) == ofSkeletons.end())
				kin.push_back(id);
		}
	}
	std::vector<std::pair<NodeBearers, std::vector<int>>> others;
	for (int id : kin)
		if (const MeshModel* layer = run.document.getMesh(id)) {
			NodeBearers other = nodeBearers(*layer, progress.part(0.5, 0.65));
			if (!areOf(*own.mesh, other.position, progress.part(0.65, 0.7)))
				continue;
			std::vector<int> node = mcf::transferredNodes(
				*own.mesh, skeleton.node, other.position, progress.part(0.7, 1));
			others.emplace_back(std::move(other), std::move(node));
		}

	MeshModel& source = run.layer();
	CurveLayer derived = curve;
	derived.skeleton = std::move(skeleton);
	DocumentEdit edit(run.document);
	edit.addCurve(source, baseName(source) + "_" + suffix, derived);
	if (fits) {
		edit.writeNodes(remembered->in(run.document), *own.vertexOfSlot, derived.skeleton.node);
		for (const auto& [other, node] : others)
			edit.writeNodes(other.layer.in(run.document), other.ofSlot, node);
	}
	edit.commit();
}

} // namespace mcfskel
