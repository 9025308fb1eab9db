// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fields.h"

#include <skeleton/support.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

using Quality = decltype(CVertexO().Q() + 0);

vcg::Color4b fromHsv(double hue, double saturation, double value)
{
	const auto channel = [&](double shift) {
		const double x = std::fmod(hue * 6 + shift, 6);
		const double part = std::max(0.0, std::min({x, 4 - x, 1.0}));
		return (unsigned char)(std::lround(255 * value * (1 - saturation * part)));
	};
	return vcg::Color4b(channel(5), channel(3), channel(1), 255);
}

/// Consecutive numbers get different colours: the hue advances by the golden angle.
vcg::Color4b partColour(int part)
{
	if (part < 0)
		return vcg::Color4b(160, 160, 160, 255);
	const double turn = 0.61803398874989485 * part;
	return fromHsv(turn - std::floor(turn), part % 2 ? 0.45 : 0.65, part % 3 == 2 ? 0.75 : 0.95);
}

/// The face of a surface with these corners, in any order; -1 if there is none.
/// @param valence of each vertex of the surface.
int faceOf(
	const mcf::SurfaceMesh& surface, const std::vector<int>& valence, const mcf::Triangle& corners)
{
	if (*std::min_element(corners.begin(), corners.end()) < 0)
		return -1;
	// Around a hub, a corner of very many faces, each of these would cost a walk over all of them.
	const int fewest = *std::min_element(corners.begin(), corners.end(),
		[&](int a, int b) { return valence[size_t(a)] < valence[size_t(b)]; });
	const auto has = [&](int v) { return std::count(corners.begin(), corners.end(), v) == 1; };
	int found = -1;
	surface.forEachOutgoing(fewest, [&](int h) {
		const mcf::Triangle t = surface.triangle(h / 3);
		if (has(t[0]) && has(t[1]) && has(t[2]))
			found = h / 3;
	});
	return found;
}

/// The valence of each vertex. @throws Cancelled
std::vector<int> valences(const mcf::SurfaceMesh& surface, const mcf::Progress& progress)
{
	std::vector<int> result = mcf::detail::filledArray(size_t(surface.vertexSlots()), 0, progress);
	mcf::detail::cancellableLoop(surface.halfEdgeSlots(), progress, [&](int h) {
		if (surface.isFace(h / 3))
			++result[size_t(surface.origin(h))];
	});
	return result;
}

} // namespace

void addFaces(MeshModel& layer, const std::vector<mcf::Triangle>& triangles)
{
	auto face = vcg::tri::Allocator<CMeshO>::AddFaces(layer.cm, triangles.size());
	for (const mcf::Triangle& triangle : triangles) {
		for (int k = 0; k < 3; ++k)
			face->V(k) = &layer.cm.vert[size_t(triangle[size_t(k)])];
		++face;
	}
	host::updateBoxAndNormals(layer);
}

std::vector<double> vertexQuality(const MeshModel& layer)
{
	std::vector<double> values;
	if (layer.hasDataMask(MeshModel::MM_VERTQUALITY))
		for (const CVertexO& v : layer.cm.vert)
			if (!v.IsD())
				values.push_back(double(v.cQ()));
	return values;
}

void setVertexQuality(MeshModel& layer, const std::vector<double>& values)
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY);
	size_t next = 0;
	for (CVertexO& v : layer.cm.vert)
		if (!v.IsD())
			v.Q() = Quality(values[next++]);
}

void setVertexQuality(
	MeshModel& layer, const SurfaceLayer& surface, const std::vector<double>& values)
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY);
	for (size_t slot = 0; slot < layer.cm.vert.size(); ++slot) {
		const int v = (*surface.vertexOfSlot)[slot];
		layer.cm.vert[slot].Q() = v < 0 ? Quality(0) : Quality(values[size_t(v)]);
	}
}

void setVertexColours(MeshModel& layer, const std::vector<double>& values, double low, double high)
{
	constexpr double blue = 2.0 / 3;
	layer.updateDataMask(MeshModel::MM_VERTCOLOR);
	size_t next = 0;
	for (CVertexO& v : layer.cm.vert)
		if (!v.IsD()) {
			const double x = high > low ? (values[next++] - low) / (high - low) : 0;
			v.C() = fromHsv(blue * (1 - std::clamp(x, 0.0, 1.0)), 0.85, 0.95);
		}
}

std::vector<int> facePartsOfSlots(const MeshModel& layer, const SurfaceLayer& surface,
	const std::vector<int>& ofFace, const mcf::Progress& progress)
{
	const CMeshO& mesh = layer.cm;
	const std::vector<int> valence = valences(*surface.mesh, progress.cancelOnly());
	std::vector<int> ofSlot;
	ofSlot.reserve(mesh.face.size());
	mcf::detail::reportedLoop(int(mesh.face.size()), progress, "Writing the layer", [&](int slot) {
		const CFaceO& face = mesh.face[size_t(slot)];
		int found = -1;
		if (!face.IsD()) {
			mcf::Triangle corners;
			for (int k = 0; k < 3; ++k)
				corners[size_t(k)] = (*surface.vertexOfSlot)[vcg::tri::Index(mesh, face.cV(k))];
			found = faceOf(*surface.mesh, valence, corners);
		}
		ofSlot.push_back(found < 0 ? -1 : ofFace[size_t(found)]);
	});
	return ofSlot;
}

void setFaceParts(MeshModel& layer, const std::vector<int>& ofSlot)
{
	auto& faces = layer.cm.face;
	const bool hadQuality = faces.IsQualityEnabled(), hadColour = faces.IsColorEnabled();
	try {
		layer.updateDataMask(MeshModel::MM_FACEQUALITY | MeshModel::MM_FACECOLOR);
	}
	catch (const std::bad_alloc&) {
		// VCG now counts them as enabled, though they have no memory.
		if (!hadQuality)
			faces.DisableQuality();
		if (!hadColour)
			faces.DisableColor();
		throw;
	}
	for (size_t slot = 0; slot < ofSlot.size(); ++slot) {
		layer.cm.face[slot].Q() = decltype(layer.cm.face[slot].Q() + 0)(ofSlot[slot]);
		layer.cm.face[slot].C() = partColour(ofSlot[slot]);
	}
}

} // namespace mcfskel
