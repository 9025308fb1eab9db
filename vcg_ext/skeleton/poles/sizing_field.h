// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The sizing field: how long edges may be, from the local thickness at each vertex.

#ifndef VCG_MCF_SIZING_FIELD_H
#define VCG_MCF_SIZING_FIELD_H

#include "pole_set.h"
#include "thin_places.h"

#include <skeleton/core/progress.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * An upper bound of the edge length at each vertex of a surface, mesh units; infinite where the
 * local thickness sets no bound. Empty: none is set, and all lengths are fractions of the diagonal.
 *
 * Every length of the pipeline is the smaller of its fractions of the diagonal and of this field.
 */
using SizingField = std::vector<double>;

/// Epsilon is at most this fraction of the sizing field.
constexpr double epsilonOfField = 4.0 / 9;

/// How fast the sizing field may grow with the distance along edges: length per length.
constexpr double sizingSlope = 0.3;

/**
 * The sizing field of a surface: the length at thin places, growing by at most 0.3 of the distance
 * along edges. It stays infinite on components that are nowhere thinner than their edges would be
 * anyway.
 * @param bound  of each component, mesh units: the field is infinite where it is not below.
 * @return for each vertex slot; empty if the field is infinite everywhere.
 * @throws Cancelled. Complexity: O(V log V) for the vertices where it is finite.
 */
inline SizingField gradedField(const MeasuredSurface& surface, const ThinPlaces& places,
	const std::vector<double>& bound, const Progress& progress = Progress())
{
	const SurfaceMesh& mesh = surface.mesh();
	const std::vector<int>& component = surface.component();
	SizingField field;
	if (places.seeds.empty())
		return field;
	field.assign(size_t(mesh.vertexSlots()), std::numeric_limits<double>::infinity());
	for (const auto& [length, v] : places.seeds)
		field[v] = length;
	// Dijkstra's algorithm from all seeds at once. A vertex gets the graded length, or that of its
	// own thickness if smaller, but no less than its predecessor's.
	using Entry = std::pair<double, int>; // length, vertex
	std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue(
		std::greater<Entry>(), places.seeds);
	size_t count = 0;
	while (!queue.empty()) {
		if (++count % 16384 == 0)
			progress.report(0.5, detail::sizing);
		const double length = queue.top().first;
		const int v = queue.top().second;
		queue.pop();
		if (length > field[v])
			continue;
		mesh.forEachOutgoing(v, [&](int h) {
			const int w = mesh.target(h);
			const double graded = length + sizingSlope * std::sqrt(mesh.squaredLength(h));
			const double there = std::max(length, std::min(graded, places.length[w]));
			if (there < field[w] && there < bound[component[w]]) {
				field[w] = there;
				queue.emplace(there, w);
			}
		});
	}
	progress.report(1, detail::sizing);
	return field;
}

/// gradedField() of thinPlaces().
/// @param poles          of all vertices.
/// @param relativeLength longest edge in local thicknesses, > 0. Around a tube an even mesh has
///                       2 pi / relativeLength vertices.
/// @throws Cancelled. Complexity: as both.
inline SizingField sizingField(const MeasuredSurface& surface, const PoleSet& poles,
	double relativeLength, const std::vector<double>& bound, const Progress& progress = Progress())
{
	const ThinPlaces places = thinPlaces(
		surface, poles, relativeLength, smallLengths(surface, bound), progress.part(0, 0.8));
	return gradedField(surface, places, bound, progress.part(0.8, 1));
}

/// A sizing field that several phases ask for, and the bound that it was computed for.
struct BoundedField
{
	std::vector<double> bound; ///< of each component, mesh units
	SizingField length;

	/// Whether it is the field for this bound, too; up to rounding.
	bool isFor(const std::vector<double>& other) const
	{
		constexpr double rounding = 1e-12;
		return std::equal(bound.begin(), bound.end(), other.begin(), other.end(),
			[](double a, double b) { return std::abs(a - b) <= rounding * b; });
	}
};

/// sizingField(), or `known` where that is the same. @param known null: none is.
inline BoundedField boundedField(const MeasuredSurface& surface, const PoleSet& poles,
	double relativeLength, std::vector<double> bound, const BoundedField* known,
	const Progress& progress = Progress())
{
	if (known && known->isFor(bound))
		return *known;
	SizingField length = sizingField(surface, poles, relativeLength, bound, progress);
	return {std::move(bound), std::move(length)};
}

/**
 * Raises a field as little as a limit on a mesh's cost, such as its number of vertices, allows: to
 * max(field, b) for the smallest b with cost(max(field, b)) <= maximum, by 40 bisections of log b.
 * @param field   finite somewhere.
 * @param high    an upper bound of b, mesh units.
 * @param cost    double(SizingField): falls where the field grows; cost(field) > maximum.
 * @return b. Complexity: up to 40 calls of cost().
 */
template <class Cost>
double raiseToCost(SizingField& field, double high, double maximum, Cost&& cost)
{
	constexpr int halvings = 40;
	double low = *std::min_element(field.begin(), field.end());
	high = std::max(low, high);
	SizingField raised = field;
	const auto raiseTo = [&](double minimum) {
		for (size_t v = 0; v < field.size(); ++v)
			raised[v] = std::max(field[v], minimum);
	};
	for (int i = 0; i < halvings && low < high; ++i) {
		const double middle = std::sqrt(low * high);
		raiseTo(middle);
		(cost(raised) > maximum ? low : high) = middle;
	}
	raiseTo(high);
	field.swap(raised);
	return high;
}

/**
 * Multiplies a field by the smallest factor, up to `factor`, for which its cost is at most
 * `maximum`. Where `factor` is not enough, raiseToCost() then raises the shortest lengths.
 * @param factor >= 1. @param field, high, maximum, cost as above.
 * @return the lower bound that raiseToCost() set; 0 if it was not needed.
 * Complexity: up to 41 calls of cost().
 */
template <class Cost>
double coarsenToCost(SizingField& field, double factor, double high, double maximum, Cost&& cost)
{
	constexpr int halvings = 20;
	const SizingField given = field;
	const auto multiply = [&](double by) {
		for (size_t v = 0; v < field.size(); ++v)
			field[v] = by * given[v];
	};
	multiply(factor);
	if (cost(field) > maximum)
		return raiseToCost(field, high, maximum, cost);
	double low = 1, enough = factor;
	for (int i = 0; i < halvings && low < enough; ++i) {
		const double middle = std::sqrt(low * enough);
		multiply(middle);
		(cost(field) > maximum ? low : enough) = middle;
	}
	multiply(enough);
	return 0;
}

} // namespace vcg::tri::mcf

#endif
