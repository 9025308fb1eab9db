// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief First line of Fig. 4: noise is measured and smoothed, then the surface is resampled.

#ifndef VCG_MCF_RESAMPLED_SURFACE_H
#define VCG_MCF_RESAMPLED_SURFACE_H

#include "resample.h"
#include "target_length.h"
#include "thin_samples.h"

#include <skeleton/core/notes.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/denoise.h>
#include <skeleton/mesh/marked_regions.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/shortest_edges.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/components_at_rest.h>
#include <skeleton/poles/poles.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/spatial/transferred_nodes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A resampled surface, and the noise that the surface had before.
struct ResampledSurface
{
	SurfaceMesh mesh;
	NoiseReport noise;
	/// Whether following the local thickness would take too many vertices: see fieldOfResampling().
	bool isTooThin = false;
};

/// thinPlaces() by the poles of all vertices. @param bound  see smallLengths().
/// @throws Cancelled. Complexity: as medialPoles().
inline ThinPlaces measuredThinPlaces(const MeasuredSurface& surface, const Parameters& parameters,
	const std::vector<double>& bound, const Progress& progress = Progress())
{
	const PoleSet poles = medialPoles(surface, PoleMethod::Balls, progress.part(0, 0.7));
	return thinPlaces(surface, poles, parameters.relativeLength, smallLengths(surface, bound),
		progress.part(0.7, 1));
}

/// The local thickness at each vertex of a surface, mesh units; infinite where gradedField() is not
/// below neutralLength of the diagonal, and empty if that is so everywhere.
/// @param places see measuredThinPlaces(). @throws Cancelled. Complexity: as gradedField().
inline std::vector<double> localThickness(const MeasuredSurface& surface, const ThinPlaces& places,
	const Parameters& parameters, const Progress& progress = Progress())
{
	std::vector<double> thickness = gradedField(surface, places, places.below, progress);
	for (double& length : thickness)
		length /= parameters.relativeLength;
	return thickness;
}

/// The part of the area whose thickness is finite. @throws Cancelled. Complexity: O(V).
inline double thinPart(
	const SurfaceMesh& mesh, const std::vector<double>& thickness, const Progress& cancel)
{
	const std::vector<double> area = vertexAreas(mesh, cancel);
	double thin = 0, all = 0;
	for (size_t v = 0; v < area.size(); ++v) {
		all += area[v];
		thin += std::isfinite(thickness[v]) ? area[v] : 0;
	}
	return all > 0 ? thin / all : 0;
}

/**
 * localThickness() by samples along the long edges of a coarse mesh; empty if it has hardly any,
 * nothing is thin, or most of the area is, as of a flat cone. Of a rod in long triangles, only the
 * vertices at its two ends show how thin it is, and the body that it stands on may have many more, a
 * few edges away: see isThin(). Their shortest edges are no longer than the rod is thick. Where that
 * takes too many samples, those of the thinnest parts are farther apart.
 * @param known  localThickness() by the vertices alone.
 * @return for the surface's vertices.
 * @throws Cancelled. Complexity: as medialPoles() of at most 40000 samples.
 */
inline std::vector<double> thicknessBySamples(const MeasuredSurface& surface,
	const std::vector<double>& known, const Parameters& parameters, const Progress& cancel)
{
	constexpr double maxSamples = 40000, maxThinPart = 0.6;
	const auto isMostlyThin = [&](const SurfaceMesh& mesh, const std::vector<double>& thickness) {
		return !thickness.empty() && thinPart(mesh, thickness, cancel) > maxThinPart;
	};
	if (surface.mesh().vertexCount() > maxSamples || isMostlyThin(surface.mesh(), known))
		return {};
	const std::vector<double> any(
		size_t(surface.components()), std::numeric_limits<double>::infinity());
	std::vector<double> across =
		shortestEdges(surface.mesh().position, surface.mesh().triangles(cancel), cancel);
	std::optional<SurfaceMesh> sampled;
	for (double length = shortestLength; !sampled && length < neutralLength; length *= 2) {
		for (size_t v = 0; v < across.size(); ++v)
			across[v] = std::max(across[v], length * surface.diagonal(surface.component()[v]));
		const ThinSampling sampling = thinSampling(surface, across, any, cancel);
		if (!sampling.isAnyLong)
			return {};
		sampled = withThinPartsSampled(surface, sampling, maxSamples, cancel);
	}
	if (!sampled)
		return {};
	const MeasuredSurface dense(*sampled, cancel);
	std::vector<double> thickness = localThickness(
		dense, measuredThinPlaces(dense, parameters, any, cancel), parameters, cancel);
	if (thickness.empty() || isMostlyThin(*sampled, thickness))
		return {};
	thickness.resize(across.size()); // the surface's own vertices come first
	return thickness;
}

/// The minimum of both at each vertex; empty is infinite everywhere.
inline std::vector<double> smallerOf(std::vector<double> one, const std::vector<double>& other)
{
	if (one.empty())
		return other;
	for (size_t v = 0; v < other.size(); ++v)
		one[v] = std::min(one[v], other[v]);
	return one;
}

/// Whether edges may be as short as a sizing field says at a vertex, see shortestLength. Of needles
/// that are thinner, more samples show no more.
inline bool isResolvable(const MeasuredSurface& surface, double length, int v)
{
	constexpr double rounding = 1 + 1e-9;
	return length > rounding * shortestLength * surface.diagonal(surface.component()[v]);
}

/// A mesh that follows the local thickness has at most so many vertices, or as many as an even mesh
/// needs anyway, and never more than its VertexBudget allows.
constexpr double maxVertices = 400000;

/// What following the local thickness may cost, and has to bring.
struct VertexBudget
{
	/// The most vertices of the resampled mesh.
	double vertices;
	/// Parts are resolved where edges are up to so many local thicknesses long.
	double longest;
};

/// The budget of a mesh that shows the thickness at its vertices: a coarse one does not show how
/// thin the shape is between them. With edges of 1.5 thicknesses there are four around a tube.
inline VertexBudget budgetOf(const SurfaceMesh& mesh)
{
	constexpr double ofVertex = 30, longest = 1.5;
	return {ofVertex * mesh.vertexCount(), longest};
}

/// The budget of a mesh that shows the thickness along its triangles, bounded by the input's
/// vertices, or by 3.5 times those of an even mesh if that is more: a small mesh of needles would be
/// resampled for minutes. Edges longer than one thickness hardly reduce the vertices of a tube.
/// @param sampled see withThinPartsSampled().
/// @param even    vertices of a mesh of even edges; 0 where the vertices alone show what is thin.
inline VertexBudget budgetWithSamples(
	const SurfaceMesh& mesh, const SurfaceMesh& sampled, double even)
{
	constexpr double ofVertex = 120, ofEven = 3.5, longest = 1.2;
	const double ofMesh = std::max(ofVertex * mesh.vertexCount(), ofEven * even);
	return {std::min(ofMesh, budgetOf(sampled).vertices), longest};
}

/// withThinPartsSampled() where edges can be short enough for the thickness.
/// @param thickness see localThickness(). @throws Cancelled
inline std::optional<SurfaceMesh> sampledWhereResolvable(const MeasuredSurface& surface,
	std::vector<double> thickness, const Parameters& parameters, const Progress& progress)
{
	detail::cancellableLoop(int(thickness.size()), progress, [&](int v) {
		if (!isResolvable(surface, parameters.relativeLength * thickness[v], v))
			thickness[v] = std::numeric_limits<double>::infinity();
	});
	std::vector<double> thick = surface.diagonals();
	for (double& diagonal : thick)
		diagonal *= neutralLength / parameters.relativeLength;
	return withThinPartsSampled(surface, thickness, thick, maxVertices, progress);
}

/**
 * The part of the thin regions that a raised sizing field still resolves, see isResolvable() and
 * VertexBudget::longest. Thin is where `field` is finite; regions count by their length,
 * area / field.
 * @throws Cancelled. Complexity: O(F).
 */
inline double resolvedPart(const MeasuredSurface& surface, const SizingField& field,
	const SizingField& raised, double relativeLength, double longest, const Cancellation& cancel)
{
	const SurfaceMesh& mesh = surface.mesh();
	double resolved = 0, all = 0;
	detail::cancellableLoop(mesh.faceSlots(), cancel, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const double area = mesh.doubleAreaVector(f).Norm();
		for (int v : mesh.triangle(f)) {
			if (!std::isfinite(field[v]))
				continue;
			const double length = area / field[v];
			all += length;
			if (raised[v] * relativeLength <= longest * field[v]
				&& isResolvable(surface, field[v], v))
				resolved += length;
		}
	});
	return all > 0 ? resolved / all : 1;
}

/**
 * The sizing field to resample a surface with. Where its mesh would be too large, see maxVertices,
 * edges may be up to a local thickness long; where that is not enough, the thinnest parts are
 * resolved less: see coarsenToCost(). No field where most of what is thin would not be resolved
 * then, as with plates, which no number of vertices serves, or with the thinnest needles, nor where
 * an even mesh alone exceeds the budget.
 * @param length of each component, see defaultTargetLength().
 * @param budget see budgetOf() and budgetWithSamples().
 * @param known  the thin places for a bound that is nowhere smaller; nothing: they are found.
 * @param onNote receives what is resolved less; may be empty.
 * @throws Cancelled. Complexity: as medialPoles().
 */
inline std::optional<SizingField> fieldOfResampling(const MeasuredSurface& surface,
	const std::vector<double>& length, const Parameters& parameters,
	std::optional<ThinPlaces> known, const VertexBudget& budget,
	const Progress& progress = Progress(), const NoteCallback& onNote = {})
{
	const double anyway = expectedVertices(surface, length, SizingField(), progress);
	if (anyway > budget.vertices)
		return std::nullopt;
	const ThinPlaces places = known
		? thinPlacesBelow(*std::move(known), smallLengths(surface, length), surface.component(),
			parameters.relativeLength)
		: measuredThinPlaces(surface, parameters, length, progress.part(0, 0.95));
	SizingField field = gradedField(surface, places, length, progress.part(0.95, 1));
	if (field.empty())
		return field;
	double expected = expectedVertices(surface, length, field, progress);
	const double maximum = std::min(std::max(maxVertices, 1.01 * anyway), budget.vertices);
	constexpr double minResolved = 0.5, longest = 1; // of what is thin; local thicknesses
	const SizingField wanted = field;
	const auto isResolved = [&] {
		return resolvedPart(
				   surface, wanted, field, parameters.relativeLength, budget.longest, progress)
			>= minResolved;
	};
	constexpr const char* everywhere =
		": lengths are the same everywhere, and such parts may be left out or simplified.";
	const auto tell = [&](const std::string& text) {
		if (onNote)
			onNote(text);
	};
	if (!isResolved()) {
		tell(detail::sentence(3, "Parts of the shape are thinner than a radius of ",
				 100 * shortestLength / parameters.relativeLength, " % of the diagonal")
			+ everywhere);
		return std::nullopt;
	}
	if (expected > maximum) {
		const std::string tooMany =
			detail::sentence(3, "Parts of the shape are thin. To resolve them would take ",
				expected / 1e6, " million vertices, more than the ", maximum / 1e6,
				budget.vertices < maxVertices ? " million that a mesh so coarse gets"
											  : " million that a mesh gets");
		const double minimum =
			coarsenToCost(field, std::max(1.0, longest / parameters.relativeLength),
				*std::max_element(length.begin(), length.end()), maximum,
				[&](const SizingField& raised) {
					return expectedVertices(surface, length, raised, progress);
				});
		if (!isResolved()) {
			tell(tooMany + everywhere);
			return std::nullopt;
		}
		if (minimum == 0)
			tell(tooMany + ": edges are longer there than relative_length says.");
		else {
			const double thinnest = minimum / longest;
			const std::vector<double> diagonals = surface.diagonals();
			const double diagonal = *std::max_element(diagonals.begin(), diagonals.end());
			tell(detail::sentence(3, tooMany, ": what is thinner than a radius of ", thinnest,
				" mesh units (", 100 * thinnest / diagonal,
				" % of the diagonal) is resolved less, and may be left out or simplified."));
		}
		expected = expectedVertices(surface, length, field, progress);
	}
	tell(detail::sentence(3, "Parts of the shape are thin: edges are down to ",
		*std::min_element(field.begin(), field.end()), " mesh units long there, about ",
		std::llround(expected), " vertices in all."));
	return field;
}

/// Notes which noise was found, and what is done about it.
inline void tellNoise(const NoiseReport& noise, bool isSmoothed, const NoteCallback& onNote)
{
	const auto tell = [&](int rounds, const char* what, double level, const char* of) {
		if (onNote && rounds > 0)
			onNote(std::string(what) + " noise of " + detail::number(100 * level, 2) + " % of " + of
				+ ": "
				+ (isSmoothed ? "smoothing it in " + std::to_string(rounds) + " rounds."
							  : "it may show in the skeleton; 'denoise' would smooth it."));
	};
	tell(noise.maxRounds(), "The surface has", noise.level, "its diagonal");
	tell(noise.maxRoundsWhereThin(), "The thin parts of the surface have", noise.ofThickness,
		"the local thickness");
}

/**
 * Smooths the noise of a surface where there is any, if parameters.denoise is set, and resamples
 * it, with the edge length of defaultTargetLength() or, with parameters.adaptive, less where the
 * shape is thin, see sizingField(), also along long triangles, see thicknessBySamples() and
 * withThinPartsSampled().
 * @param mesh   closed two-manifold, compact.
 * @param given  see sharedAmong() for more than 50 components.
 * @param onNote receives what was found and done; may be empty.
 * @throws InvalidParameter, Cancelled. Complexity: as resample().
 */
inline ResampledSurface resampledSurface(const SurfaceMesh& mesh, const Parameters& given,
	const Progress& progress = Progress(), const NoteCallback& onNote = {})
{
	given.check();
	const MeasuredSurface surface(mesh, progress.part(0, 0.05));
	const Parameters parameters = sharedAmong(given, surface.diagonals());
	ResampledSurface result;
	std::optional<ThinPlaces> places;
	std::vector<double> thickness, bySamples;
	if (parameters.adaptive) {
		const std::vector<double> any(
			size_t(surface.components()), std::numeric_limits<double>::infinity());
		places = measuredThinPlaces(surface, parameters, any, progress.part(0.05, 0.18));
		thickness = localThickness(surface, *places, parameters, progress.part(0.18, 0.19));
		bySamples = thicknessBySamples(
			surface, thickness, parameters, progress.part(0.19, 0.2).cancelOnly());
		thickness = smallerOf(std::move(thickness), bySamples);
	}
	result.noise = measureNoise(surface, progress.part(0.2, 0.25), thickness);
	const bool smooth = parameters.denoise && result.noise.isNoisy();
	tellNoise(result.noise, smooth, onNote);
	const auto resampled = [&](const MeasuredSurface& calm, std::optional<ThinPlaces> own) {
		const double from = smooth ? 0.35 : 0.25;
		const std::vector<double> length = defaultTargetLength(calm, parameters, progress);
		const bool isAdaptive = parameters.adaptive && parameters.resampleIterations > 0;
		if (isAdaptive && own && !thickness.empty()) {
			if (const std::optional<SurfaceMesh> sampled =
					sampledWhereResolvable(calm, thickness, parameters, progress.cancelOnly())) {
				const MeasuredSurface dense(*sampled, progress.cancelOnly());
				std::vector<std::string> notes;
				const double even = bySamples.empty()
					? 0
					: expectedVertices(calm, length, SizingField(), progress.cancelOnly());
				const std::optional<SizingField> field = fieldOfResampling(dense, length,
					parameters, std::nullopt, budgetWithSamples(calm.mesh(), *sampled, even),
					progress.cancelOnly(), [&](const std::string& note) { notes.push_back(note); });
				if (field && !field->empty()) {
					for (const std::string& note : notes)
						if (onNote)
							onNote(note);
					return resample(dense, length, parameters.resampleIterations,
						progress.part(from + 0.15, 1), *field);
				}
			}
		}
		std::optional<SizingField> field = SizingField();
		if (isAdaptive)
			field = fieldOfResampling(calm, length, parameters, std::move(own),
				budgetOf(calm.mesh()), progress.part(from, from + 0.15), onNote);
		result.isTooThin = !field;
		return resample(calm, length, parameters.resampleIterations, progress.part(from + 0.15, 1),
			field ? *field : SizingField());
	};
	if (smooth)
		result.mesh =
			resampled({smoothed(surface, result.noise.ofVertices(surface.component(), thickness),
						   progress.part(0.25, 0.3)),
						  progress.part(0.3, 0.35)},
				std::nullopt);
	else
		result.mesh = resampled(surface, std::move(places));
	if (onNote)
		onNote(detail::sentence(6, "Resampled to ", result.mesh.vertexCount(),
			" vertices, mean edge length ", meanEdgeLength(result.mesh), " mesh units",
			parameters.targetLength == 0 ? " (chosen from the mesh)." : "."));
	return result;
}

} // namespace vcg::tri::mcf

#endif
