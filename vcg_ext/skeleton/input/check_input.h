// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The input check: whether a mesh bounds a solid; what is repaired, what refused, and why.

#ifndef VCG_MCF_CHECK_INPUT_H
#define VCG_MCF_CHECK_INPUT_H

#include "soup_repair.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/surface_rounding.h>
#include <skeleton/mesh/volume_and_area.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The input as the pipeline needs it.
struct CheckedSurface
{
	SurfaceMesh mesh;
	/// For each input vertex the vertex of `mesh`, or -1 where no face uses it.
	std::vector<int> vertexOfInput;
	/// For each connected component, whether it was given inside out; empty if all or none were.
	std::vector<char> turned = {};
	/// What was repaired on the way, one sentence each, for the log.
	std::vector<std::string> notes;
};

namespace detail {

/// Whether every coordinate is exact in single precision.
inline bool isSinglePrecision(const std::vector<Point3d>& points)
{
	return std::all_of(points.begin(), points.end(), [](const Point3d& p) {
		return toSingle(p[0]) == p[0] && toSingle(p[1]) == p[1] && toSingle(p[2]) == p[2];
	});
}

/**
 * First-order bound of the volume error of each component due to rounded coordinates: the gradient
 * of the volume at a vertex is a third of the area vector of its one-ring. A flat body in a slanted
 * plane has no volume beyond it; in a coordinate plane, such as z = 0, the bound itself is near 0.
 * Complexity: O(F).
 */
inline std::vector<double> volumeErrorBound(
	const SurfaceMesh& mesh, const std::vector<int>& component, int components)
{
	const double half = isSinglePrecision(mesh.position)
		? 0.5 * std::numeric_limits<float>::epsilon()
		: 0.5 * std::numeric_limits<double>::epsilon();
	std::vector<Point3d> areaVector(size_t(mesh.vertexSlots()), Point3d(0, 0, 0));
	for (int f = 0; f < mesh.faceSlots(); ++f)
		if (mesh.isFace(f))
			for (int v : mesh.triangle(f))
				areaVector[size_t(v)] += mesh.doubleAreaVector(f) / 2;
	std::vector<double> bound(size_t(components), 0);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.isVertex(v))
			for (int k = 0; k < 3; ++k)
				bound[size_t(component[size_t(v)])] +=
					half / 3 * std::abs(mesh.position[size_t(v)][k] * areaVector[size_t(v)][k]);
	return bound;
}

} // namespace detail

/**
 * Checks that `points` and `triangles` bound a solid, and hands them over as a SurfaceMesh.
 *
 * Repaired, with a note: unreferenced vertices, coincident vertices (merged only if that leaves
 * fewer border and non-manifold edges), faces that use a vertex twice, copies of a face, faces
 * turned against their neighbours, components that are inside out. Refused: everything else that is
 * not a closed two-manifold, and components without a volume beyond rounding: flat, or on a line.
 *
 * @param points    one for each input vertex, mesh units.
 * @param triangles corners as indices into `points`.
 * @throws InvalidInput saying what is wrong, how many, where, and what cures it; Cancelled.
 * Complexity: about O(V + F): see repairedSoup().
 */
inline CheckedSurface checkedSurface(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const Progress& progress = Progress())
{
	const char* const what = "Checking the surface";
	CheckedSurface result;
	if (points.empty())
		throw InvalidInput("The mesh is empty: a closed triangle mesh is needed.", Defect::Empty);
	if (triangles.empty())
		throw InvalidInput(
			"The mesh has no faces: a closed triangle mesh is needed, not a cloud of points.",
			Defect::NoFaces);
	detail::reportedLoop(int(triangles.size()), progress.part(0, 0.02), what, [&](int f) {
		for (int v : triangles[f])
			if (v < 0 || v >= int(points.size()))
				throw InvalidInput("A face refers to vertex " + std::to_string(v) + " of "
					+ std::to_string(points.size()) + ".");
	});
	std::vector<size_t> notFinite;
	detail::reportedLoop(int(points.size()), progress.part(0.02, 0.04), what, [&](int v) {
		if (!isFinitePlace(points[v]))
			notFinite.push_back(size_t(v));
	});
	if (!notFinite.empty()) {
		std::string which = std::to_string(notFinite[0]);
		for (size_t i = 1; i < std::min<size_t>(3, notFinite.size()); ++i)
			which += ", " + std::to_string(notFinite[i]);
		throw InvalidInput(std::to_string(notFinite.size())
				+ (notFinite.size() == 1 ? " vertex has" : " vertices have")
				+ " a coordinate that is not a finite number (NaN or infinite), first at vertex "
				+ which + ": delete them and fill the holes first.",
			Defect::NotFinite);
	}

	std::optional<SurfaceMesh> ready = SurfaceMesh::ifClosedManifold(
		detail::copiedArray(points, progress), triangles, progress.part(0.06, 0.3));
	RepairedSoup soup;
	std::vector<int>& vertexOfInput = soup.vertexOfInput;
	const bool asGiven = ready && ready->vertexCount() == ready->vertexSlots();
	if (ready) {
		vertexOfInput = detail::numberedArray(points.size(), progress);
		if (!asGiven)
			soup.faces = triangles;
	}
	else
		soup = repairedSoup(points, triangles, progress.part(0.3, 0.65));
	result.notes = std::move(soup.notes);
	progress.report(0.65, what);

	if (!asGiven) {
		// Number the referenced vertices in their own order.
		const Progress numbering = progress.part(0.65, 0.72);
		std::vector<int> number = detail::filledArray(points.size(), -1, numbering);
		detail::reportedLoop(int(soup.faces.size()), numbering.part(0, 0.2), what, [&](int f) {
			for (int v : soup.faces[f])
				number[v] = 0;
		});
		std::vector<Point3d> used;
		used.reserve(points.size());
		detail::reportedLoop(int(points.size()), numbering.part(0.2, 0.4), what, [&](int v) {
			if (number[v] == 0) {
				number[v] = int(used.size());
				used.push_back(points[v]);
			}
		});
		size_t unreferenced = 0;
		detail::reportedLoop(int(vertexOfInput.size()), numbering.part(0.4, 0.7), what, [&](int i) {
			int& v = vertexOfInput[i];
			v = number[v];
			unreferenced += v < 0;
		});
		if (unreferenced)
			result.notes.push_back(
				std::to_string(unreferenced) + " unreferenced vertices were left out.");
		detail::reportedLoop(int(soup.faces.size()), numbering.part(0.7, 1), what, [&](int f) {
			for (int& v : soup.faces[f])
				v = number[v];
		});
		ready = SurfaceMesh(std::move(used), soup.faces, progress.part(0.72, 0.8));
	}

	// Each component must enclose a volume, and is turned so that the volume is positive.
	SurfaceMesh& mesh = *ready;
	int components = 0;
	const std::vector<int> component =
		connectedComponents(mesh, &components, progress.part(0.8, 0.85));
	std::vector<Point3d> middle(components, Point3d(0, 0, 0));
	std::vector<double> volume(components, 0), area(components, 0);
	std::vector<Box3d> box(components);
	std::vector<int> size(components, 0);
	detail::reportedLoop(mesh.vertexSlots(), progress.part(0.85, 0.87), what, [&](int v) {
		middle[component[v]] += mesh.position[v];
		++size[component[v]];
		box[component[v]].Add(mesh.position[v]);
	});
	for (int c = 0; c < components; ++c)
		middle[c] /= double(size[c]);
	detail::reportedLoop(mesh.faceSlots(), progress.part(0.87, 0.9), what, [&](int f) {
		const int first = mesh.origin(3 * f), c = component[first];
		const Point3d n = mesh.doubleAreaVector(f);
		area[c] += n.Norm() / 2;
		volume[c] += (mesh.position[first] - middle[c]) * n / 6;
	});
	// Of a body much thinner than long both are lost in rounding, unless measured along its length.
	const auto isSlender = [&](int c) {
		constexpr double slender = 1e-3;
		return !(std::abs(volume[c]) > slender * std::pow(area[c], 1.5))
			|| !(area[c] > slender * box[c].SquaredDiag());
	};
	bool anySlender = false;
	std::vector<double> volumeError(size_t(components), 0); // of slender ones
	for (int c = 0; c < components; ++c)
		anySlender |= isSlender(c);
	if (anySlender) {
		const std::vector<detail::VolumeAndArea> measured =
			detail::measuredAlongLength(mesh, component, components, progress.cancelOnly());
		const std::vector<double> bound = detail::volumeErrorBound(mesh, component, components);
		for (int c = 0; c < components; ++c)
			if (isSlender(c)) {
				volume[c] = measured[c].volume;
				area[c] = measured[c].area;
				volumeError[c] = bound[c];
			}
	}
	int insideOut = 0;
	std::vector<Point3d> flat;
	for (int c = 0; c < components; ++c) {
		double largest = 0; // coordinate
		for (int k = 0; k < 3; ++k)
			largest = std::max({largest, std::abs(box[c].min[k]), std::abs(box[c].max[k])});
		// A sphere, the fullest body, has V = 0.094 A^1.5; rounding alone stays below 1e-12 of it.
		// For a body on a line the area is rounding, too: its volume over its area, about its
		// thickness, is of the size of the rounding of its coordinates.
		constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
		if (!(std::abs(volume[c]) > 1e-10 * std::pow(area[c], 1.5)) || !std::isnormal(area[c])
			|| !(std::abs(volume[c]) > rounding * largest * area[c])
			|| !(std::abs(volume[c]) > volumeError[c]))
			flat.push_back(middle[c]);
		insideOut += volume[c] < 0;
	}
	if (int(flat.size()) == components)
		throw InvalidInput(
			"There is no inside for a skeleton to lie in: the mesh is flat, all of it encloses no volume. Give it a "
			"thickness.",
			Defect::Flat);
	if (!flat.empty())
		throw InvalidInput("There is no inside for a skeleton to lie in: of "
				+ std::to_string(components) + " connected component" + (components == 1 ? "" : "s")
				+ ", "
				+ detail::countAndPlaces(
					flat.size(), "encloses no volume", "enclose no volume", flat)
				+ ". Scale or remove the flat part.",
			Defect::NoVolume);
	if (insideOut) {
		const Progress turning = progress.cancelOnly();
		std::vector<Triangle> faces = mesh.triangles(turning);
		detail::reportedLoop(int(faces.size()), turning, what, [&](int f) {
			if (volume[component[faces[f][0]]] < 0)
				std::swap(faces[f][1], faces[f][2]);
		});
		mesh = SurfaceMesh(std::move(mesh.position), faces, progress.part(0.9, 1));
		result.notes.push_back(insideOut == components
				? std::string("The mesh was inside out and has been turned.")
				: std::to_string(insideOut) + " of " + std::to_string(components)
					+ " connected components were inside out and have been turned.");
		if (insideOut < components)
			for (double v : volume)
				result.turned.push_back(v < 0);
	}
	progress.report(1, what);
	result.mesh = std::move(mesh);
	result.vertexOfInput = std::move(vertexOfInput);
	return result;
}

} // namespace vcg::tri::mcf

#endif
