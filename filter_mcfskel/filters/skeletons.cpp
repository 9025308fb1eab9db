// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "skeletons.h"

#include "../fields.h"

#include <skeleton/closest_surface.h>
#include <skeleton/errors.h>
#include <skeleton/nearest_points.h>
#include <skeleton/point_tree.h>
#include <skeleton/skeleton_radius.h>
#include <skeleton/stage.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The layer of the surface that a skeleton remembers, if it is still there and unchanged.
MeshModel* rememberedLayer(const FilterRun& run, const CurveLayer& curve)
{
	if (!curve.surface.vertexOfSlot)
		return nullptr;
	const SurfaceLink link =
		linkTo(run.document, curve.surface.fingerprint, *curve.surface.vertexOfSlot);
	return link.layerId < 0 ? nullptr : run.document.getMesh(link.layerId);
}

/// What mcfskel_node tells, if all of it can be about a skeleton of that many nodes; else empty.
std::vector<int> nodesFromAttribute(const SkeletonSurface& surface, size_t nodes)
{
	const std::vector<int> shown = readNodes(*surface.layer);
	std::vector<int> result(size_t(surface.surface.mesh->vertexSlots()), -1);
	size_t next = 0;
	bool any = false;
	for (size_t slot = 0; slot < surface.layer->cm.vert.size(); ++slot) {
		if (surface.layer->cm.vert[slot].IsD() || next >= shown.size())
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

} // namespace

std::vector<int> carriedOver(const mcf::SurfaceMesh& from, const std::vector<int>& node,
	const mcf::SurfaceMesh& to, const mcf::Progress& progress)
{
	std::vector<int> result =
		mcf::nearestPoints(from.position, to.position, meanEdgeLength(from), progress);
	for (int& v : result)
		v = node[size_t(v)];
	return result;
}

CurveLayer skeletonOn(const MeshModel& layer)
{
	CurveLayer curve = readCurve(layer);
	std::vector<double>& radius = curve.skeleton.radius;
	if (radius.empty())
		radius = vertexQuality(layer);
	radius.resize(curve.skeleton.position.size(), 0);
	for (double& r : radius)
		r = std::isfinite(r) ? std::max(r, 0.0) : 0;
	return curve;
}

ParameterSpec surfaceParameter(const QString& whatFor)
{
	return {ParameterKind::Layer, "surface", 0, "Surface",
		whatFor
			+ " The skeleton's own layer stands for the surface that the skeleton was made from, as "
			  "long as that is there and unchanged."};
}

std::optional<SkeletonSurface> findSurface(const FilterRun& run, const CurveLayer& curve)
{
	const int id = run.parameters.integer("surface");
	MeshModel* layer =
		id == int(run.layer().id()) ? rememberedLayer(run, curve) : run.document.getMesh(id);
	if (!layer)
		return std::nullopt;
	return SkeletonSurface {layer, readSurface(*layer)};
}

SkeletonSurface requireSurface(const FilterRun& run, const CurveLayer& curve)
{
	std::optional<SkeletonSurface> surface = findSurface(run, curve);
	if (!surface)
		throw mcf::InvalidInput("The skeleton '" + run.layer().label().toStdString()
			+ "' remembers no surface that is still there: give the layer of its surface as the "
			  "parameter surface.");
	logNotes(run, surface->surface);
	return *std::move(surface);
}

std::vector<int> nodesOnSurface(
	const FilterRun& run, const CurveLayer& curve, const SkeletonSurface& surface)
{
	const std::vector<int>& node = curve.skeleton.node;
	if (MeshModel* remembered = node.empty() ? nullptr : rememberedLayer(run, curve)) {
		const SurfaceLayer own = readSurface(*remembered);
		if (own.mesh->position.size() == node.size())
			return remembered == surface.layer
				? node
				: carriedOver(*own.mesh, node, *surface.surface.mesh);
	}
	return nodesFromAttribute(surface, curve.skeleton.position.size());
}

CurveLayer skeletonOf(const FilterRun& run, CurveLayer curve, const SkeletonSurface& surface)
{
	std::vector<int> node = nodesOnSurface(run, curve, surface);
	if (node.empty()) {
		run.log(
			"The skeleton knows nothing of this surface: each of its vertices goes to the nearest "
			"node.");
		const mcf::PointTree nodes(curve.skeleton.position);
		for (const vcg::Point3d& p : surface.surface.mesh->position)
			node.push_back(nodes.nearest(p));
	}
	curve.skeleton.node = std::move(node);
	curve.surface = linkTo(*surface.layer, surface.surface);
	curve.surfaceName = surface.layer->label();
	return curve;
}

std::vector<double> clearances(
	const std::vector<vcg::Point3d>& nodes, const mcf::SurfaceMesh& surface)
{
	constexpr double spacing = 0.01;
	const vcg::Point3d middle = surface.bounds().Center();
	const double diagonal = surface.bounds().Diag();
	mcf::SurfaceMesh unit = surface;
	for (vcg::Point3d& p : unit.position)
		p = (p - middle) / diagonal;
	std::vector<int> all(unit.position.size());
	std::iota(all.begin(), all.end(), 0);
	const mcf::ClosestSurface closest(unit, all, spacing);
	std::vector<double> result;
	for (const vcg::Point3d& p : nodes)
		result.push_back(std::max(closest.clearance((p - middle) / diagonal), 0.0) * diagonal);
	return result;
}

void addDerivedSkeleton(FilterRun& run, const CurveLayer& curve, mcf::CurveSkeleton skeleton,
	const char* suffix, bool measureRadius)
{
	MeshModel* remembered = skeleton.node.empty() ? nullptr : rememberedLayer(run, curve);
	SurfaceLayer own;
	if (remembered)
		own = readSurface(*remembered);
	const bool fits = remembered && own.mesh->position.size() == skeleton.node.size();
	if (fits && measureRadius) {
		const std::vector<double> before = skeleton.radius;
		skeleton.radius =
			mcf::meanSurfaceDistance(skeleton.position, own.mesh->position, skeleton.node);
		mcf::fillUnknownRadii(skeleton.radius, skeleton.neighbours());
		for (size_t v = 0; v < before.size(); ++v)
			if (skeleton.radius[v] < 0)
				skeleton.radius[v] = before[v];
	}
	// Surfaces of the same name have their correspondence from the one that was contracted.
	std::vector<std::pair<MeshModel*, SurfaceLayer>> others;
	if (fits)
		for (const MeshModel* layer : host::layersOf(run.document))
			if (layer != remembered && layer->cm.fn > 0 && !hasStageAttributes(*layer)
				&& !readNodes(*layer).empty() && baseName(*layer) == baseName(*remembered))
				others.emplace_back(run.document.getMesh(int(layer->id())), readSurface(*layer));

	MeshModel& source = run.layer();
	CurveLayer derived = curve;
	derived.skeleton = std::move(skeleton);
	DocumentEdit edit(run.document);
	edit.addCurve(source, baseName(source) + "_" + suffix, derived);
	if (fits) {
		edit.writeNodes(*remembered, *own.vertexOfSlot, derived.skeleton.node);
		for (auto& [layer, surface] : others)
			edit.writeNodes(*layer, *surface.vertexOfSlot,
				carriedOver(*own.mesh, derived.skeleton.node, *surface.mesh));
	}
	edit.commit();
}

} // namespace mcfskel
