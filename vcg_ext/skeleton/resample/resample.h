// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Isotropic resampling of the surface: the first line of the paper's Fig. 4.

#ifndef VCG_MCF_RESAMPLE_H
#define VCG_MCF_RESAMPLE_H

#include "degenerate_triangles.h"
#include "isotropic_remesher.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/components_at_rest.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/principal_frame.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/poles/sizing_field.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The number of vertices of an even mesh of a surface: V = int dA / (L^2 sqrt(3) / 2), where the
 * edge length L is the smaller of the length of the component and the field.
 * @param lengthOfComponent mesh units, > 0.
 * @param field             see sizingField(); may be empty.
 * @throws Cancelled. Complexity: O(F) with a field.
 */
inline double expectedVertices(const MeasuredSurface& surface,
	const std::vector<double>& lengthOfComponent, const SizingField& field,
	const Cancellation& cancel = Cancellation())
{
	const double areaOfVertex = std::sqrt(3.0) / 2; // for edges of length 1
	double expected = 0;
	for (int c = 0; c < surface.components(); ++c)
		expected += surface.area(c) / (areaOfVertex * lengthOfComponent[c] * lengthOfComponent[c]);
	if (field.empty())
		return expected;
	// The vertices that the field adds.
	const SurfaceMesh& mesh = surface.mesh();
	detail::cancellableLoop(mesh.faceSlots(), cancel, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const Triangle t = mesh.triangle(f);
		const double length = lengthOfComponent[surface.component()[t[0]]];
		double added = 0; // the mean over the corners
		for (int v : t)
			if (field[v] < length)
				added += (1 / (field[v] * field[v]) - 1 / (length * length)) / 3;
		expected += mesh.doubleAreaVector(f).Norm() / 2 * added / areaOfVertex;
	});
	return expected;
}

namespace detail {

/// resample() of all components.
inline SurfaceMesh resampleAll(const MeasuredSurface& surface,
	const std::vector<double>& targetLengthOfComponent, const SizingField& field, int iterations,
	const Progress& progress)
{
	constexpr double maxVertices = 2e7, maxOfExpected = 4, fewestAllowed = 3e6;
	const std::vector<int>& component = surface.component();
	const int components = surface.components();
	std::vector<double> targetLength;
	for (int c = 0; c < components; ++c)
		targetLength.push_back(surface.frame(c).lengthOnGrid(targetLengthOfComponent[c]));
	const double expected = expectedVertices(surface, targetLengthOfComponent, field, progress);
	if (!(expected <= maxVertices))
		throw InvalidParameter("Parameter target_length is too small: the surface would need "
			+ detail::countText(expected / 1e6) + " million vertices.");
	// Needles need more vertices than their area suggests; this bounds how many they may get.
	const double limit =
		std::max(maxOfExpected * expected, fewestAllowed) + surface.mesh().vertexCount();
	// Prepares the input: neighbours near each other in memory, no triangles without a normal.
	const char* const what = "Ordering the surface";
	const auto onGrid = [&](int c, const Point3d& p) { return surface.frame(c).onGrid(p); };
	std::optional<SurfaceMesh> turnedOver;
	for (const PrincipalFrame& frame : surface.allFrames())
		if (frame.isMirrored() && !turnedOver) {
			turnedOver = surface.mesh().copied(progress);
			turnOverMirrored(*turnedOver, component, surface.allFrames(), progress);
		}
	const SurfaceMesh& outwards = turnedOver ? *turnedOver : surface.mesh();
	const std::vector<int> seeds = minHalfEdges(
		outwards, component, components,
		[&](int v) { return onGrid(component[v], outwards.position[v]); }, progress.part(0, 0.01));
	const Numbering number = breadthFirstOrder(outwards, seeds, progress.part(0.01, 0.06));
	std::vector<double> localLength; // on the grid
	if (!field.empty()) {
		std::vector<double> ofInput;
		ofInput.reserve(field.size());
		for (size_t v = 0; v < field.size(); ++v)
			ofInput.push_back(std::min(
				targetLength[component[v]], surface.frame(component[v]).lengthOnGrid(field[v])));
		localLength = renumbered(ofInput, number.vertex, surface.mesh().vertexCount());
	}
	const auto lengthAt = [&](int v) {
		return localLength.empty() ? targetLength[number.component[v]] : localLength[v];
	};
	SurfaceMesh reference = outwards.renumbered(
		number.vertex, number.face, number.firstCorner, progress.part(0.06, 0.1));
	detail::reportedLoop(reference.vertexSlots(), progress.part(0.1, 0.12), what,
		[&](int v) { reference.position[v] = onGrid(number.component[v], reference.position[v]); });
	removeThinTriangles(reference, lengthAt, progress.part(0.12, 0.13));
	detail::IsotropicRemesher remesher(reference, number.component, targetLength, size_t(limit),
		progress.part(0.13, 0.15), localLength);
	remesher.coarsen(progress.part(0.15, 0.4));
	remesher.refine(progress.part(0.4, 0.5));
	for (int i = 0; i < iterations; ++i) {
		const Progress round =
			progress.part(0.5 + 0.45 * i / iterations, 0.5 + 0.45 * (i + 1) / iterations);
		remesher.splitLongEdges(round.part(0, 0.2));
		remesher.collapseShortEdges(round.part(0.2, 0.4));
		remesher.flipForValence(round.part(0.4, 0.5));
		remesher.smoothAndProject(round.part(0.5, 1));
	}
	remesher.flipForAngles(progress.part(0.95, 0.96));
	remesher.smoothAndProject(progress.part(0.96, 0.99));
	remesher.flipForAngles(progress.part(0.99, 1));
	const Progress end = progress.cancelOnly();
	SurfaceMesh result = remesher.take(end);
	const std::vector<int>& componentOfResult = remesher.componentOfVertex();
	// Rounded to a grid of the result's own frame: in mesh units, far from the origin, finer digits
	// would be lost.
	const std::vector<PrincipalFrame> frameOfResult =
		PrincipalFrame::ofPoints(result.position, componentOfResult, size_t(components), end);
	detail::reportedLoop(result.vertexSlots(), end, what, [&](int v) {
		const int c = componentOfResult[v];
		result.position[v] = surface.frame(c).out(frameOfResult[c].snapped(result.position[v]));
	});
	turnOverMirrored(result, componentOfResult, surface.allFrames(), end);
	return result;
}

/// resample() where some components rest: the others are resampled as a separate surface.
inline SurfaceMesh resampleMoving(const MeasuredSurface& surface,
	const std::vector<double>& targetLengthOfComponent, const SizingField& field,
	const std::vector<char>& rests, int iterations, const Progress& progress)
{
	const char* const what = "Ordering the surface";
	const Progress begin = progress.cancelOnly(), end = progress.cancelOnly();
	const auto trianglesOf = [&](const SurfaceMesh& mesh, const std::vector<int>& number,
								 std::vector<Triangle>& triangles, const Progress& part) {
		reportedLoop(mesh.faceSlots(), part, what, [&](int f) {
			if (!mesh.isFace(f))
				return;
			const Triangle t = mesh.triangle(f);
			if (number[t[0]] >= 0)
				triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
		});
	};
	std::vector<double> length;
	for (size_t c = 0; c < rests.size(); ++c)
		if (!rests[c])
			length.push_back(targetLengthOfComponent[c]);
	const SurfaceMesh& mesh = surface.mesh();
	SurfaceMesh moving;
	std::vector<int> componentOfMoving;
	if (!length.empty()) {
		std::vector<int> number(size_t(mesh.vertexSlots()), -1);
		std::vector<Point3d> points;
		SizingField fieldOfMoving;
		reportedLoop(mesh.vertexSlots(), begin, what, [&](int v) {
			if (mesh.isVertex(v) && !rests[surface.component()[v]]) {
				number[v] = int(points.size());
				points.push_back(mesh.position[v]);
				if (!field.empty())
					fieldOfMoving.push_back(field[v]);
			}
		});
		std::vector<Triangle> triangles;
		trianglesOf(mesh, number, triangles, begin);
		const SurfaceMesh others(std::move(points), triangles, begin);
		moving = resampleAll(
			MeasuredSurface(others, begin), length, fieldOfMoving, iterations, progress);
		componentOfMoving = connectedComponents(moving, nullptr, end);
	}
	// Vertices are numbered component by component, so that the order of the components stays.
	const ComponentVertices ofMoving(componentOfMoving, int(length.size()), end);
	std::vector<std::vector<int>> ofResting(rests.size());
	reportedLoop(mesh.vertexSlots(), end, what, [&](int v) {
		if (mesh.isVertex(v) && rests[surface.component()[v]])
			ofResting[surface.component()[v]].push_back(v);
	});
	std::vector<Point3d> points;
	std::vector<int> newOfMoving(componentOfMoving.size(), -1);
	std::vector<int> newOfResting(size_t(mesh.vertexSlots()), -1);
	size_t next = 0; // of the components that move
	const auto add = [&](const SurfaceMesh& from, const std::vector<int>& ids,
						 std::vector<int>& newNumber) {
		for (int v : ids) {
			newNumber[v] = int(points.size());
			points.push_back(from.position[v]);
		}
	};
	for (size_t c = 0; c < rests.size(); ++c)
		if (rests[c])
			add(mesh, ofResting[c], newOfResting);
		else
			add(moving, ofMoving.ids[next++], newOfMoving);
	std::vector<Triangle> triangles;
	trianglesOf(moving, newOfMoving, triangles, end);
	trianglesOf(mesh, newOfResting, triangles, end);
	return SurfaceMesh(std::move(points), triangles, end);
}

} // namespace detail

/**
 * A mesh of the same surface with even, nearly equilateral triangles.
 *
 * Each round splits edges longer than 4/3 L, collapses those shorter than 4/5 L, flips edges so
 * that valences approach six, and moves vertices within the surface to the centroid of their
 * triangles. Delaunay flips and one more smoothing end it. Vertices lie on the triangles of the
 * input, those of creases (sharp edges over 60 degrees in long chains) on the creases. A surface
 * much denser than L is coarsened first.
 *
 * This is done in the PrincipalFrame of each component, with positions rounded as in single
 * precision, and in an order of the vertices that depends on their positions only: a copy of the
 * shape that is turned, moved, scaled or renumbered gives the same mesh.
 *
 * Components that rest, see componentsAtRest(), stay unchanged.
 *
 * Genus, orientation, and the number and order of the components are those of the input.
 *
 * @param surface                 closed, oriented two-manifold; compact if there is a field.
 * @param targetLengthOfComponent L for each component in the order of connectedComponents(), mesh
 *                                units, > 0: see defaultTargetLength().
 * @param iterations              rounds, >= 0; 0 gives the input back, without holes in its
 *                                numbering. Five is plenty.
 * @param progress                window for reports; cancelling leaves nothing behind.
 * @param field                   replaces L where it is smaller, see sizingField(); an edge takes
 *                                the smaller length of its two ends. Empty: L everywhere.
 * @return a compact mesh; most edges are between 4/5 L and 4/3 L.
 * @throws InvalidParameter if there is not one positive length for each component, if
 *         expectedVertices() exceeds 20 million, or if a surface narrower than L needs three
 *         million vertices, and four times expectedVertices(), more than the input has.
 * @throws Cancelled
 * Complexity: O(iterations (V' + F') + V + F), where V', F' are of the result.
 * Source: Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", SGP 2004, Sec. 4;
 * the projection by walking, the creases and the coarsening are ours.
 */
inline SurfaceMesh resample(const MeasuredSurface& surface,
	const std::vector<double>& targetLengthOfComponent, int iterations,
	const Progress& progress = Progress(), const SizingField& field = {})
{
	const int components = surface.components();
	if (int(targetLengthOfComponent.size()) != components)
		throw InvalidParameter("Resampling needs one target length for each of the "
			+ std::to_string(components) + " components, not "
			+ std::to_string(targetLengthOfComponent.size()) + ".");
	for (double length : targetLengthOfComponent)
		if (!(length > 0) || !std::isfinite(length))
			throw InvalidParameter("The target length of a component must be greater than 0.");
	if (iterations <= 0) {
		SurfaceMesh copy = surface.mesh().copied(progress);
		copy.compact(progress);
		return copy;
	}
	const std::vector<char> rests = componentsAtRest(surface, progress.cancelOnly());
	if (std::find(rests.begin(), rests.end(), 1) == rests.end())
		return detail::resampleAll(surface, targetLengthOfComponent, field, iterations, progress);
	return detail::resampleMoving(
		surface, targetLengthOfComponent, field, rests, iterations, progress);
}

} // namespace vcg::tri::mcf

#endif
