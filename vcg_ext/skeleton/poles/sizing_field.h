// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How long the edges of a surface may be, place by place: a fraction of the local thickness.

#ifndef VCG_MCF_SIZING_FIELD_H
#define VCG_MCF_SIZING_FIELD_H

#include "pole_set.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/unit_frame.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A bound of the edge length at each vertex of a surface, mesh units; infinite where the local thickness
 * does not bind. Empty: it binds nowhere, and all lengths are fractions of the diagonal.
 *
 * Every length of the pipeline is the smaller of its fraction of the diagonal and its fraction of this.
 */
using SizingField = std::vector<double>;

/// Where the sizing field is this part of the diagonal, thickness and diagonal give the same lengths: edges
/// of the default resampling, epsilon, the spacing of the refined curve. Below, all of them shrink with it.
constexpr double neutralLength = 0.0045;

/// No part of the sizing field is shorter, of the component's diagonal: what is thinner is not resolved, since a
/// needle a million times as long as thick would need more vertices than any machine holds.
constexpr double shortestLength = 3e-5;

/// Epsilon is at most this part of the sizing field.
constexpr double epsilonOfField = 4.0 / 9;

namespace detail {

constexpr const char* sizing = "Measuring the local thickness";

/// How fast the sizing field may grow with the distance along edges.
constexpr double sizingSlope = 0.3;

/// The vertices up to two edges away from v, v included, ascending.
inline void twoRings(const SurfaceMesh& mesh, int v, std::vector<int>& around)
{
	around.assign(1, v);
	mesh.forEachOutgoing(v, [&](int h) {
		around.push_back(mesh.target(h));
		mesh.forEachOutgoing(mesh.target(h), [&](int g) { around.push_back(mesh.target(g)); });
	});
	std::sort(around.begin(), around.end());
	around.erase(std::unique(around.begin(), around.end()), around.end());
}

/**
 * The local thickness at each vertex where it may be small, else infinite: the median of the radii of the
 * balls up to two edges away, since single balls are too small next to slivers and bumps of the surface
 * and too large where a normal is tilted.
 * @param mayBeSmall  bool(vertex): whether the vertex's own ball is small.
 * @throws Cancelled. Complexity: O(V).
 */
template <class MayBeSmall>
std::vector<double> medianRadii(const SurfaceMesh& mesh, const PoleSet& poles,
	MayBeSmall&& mayBeSmall, const Progress& progress)
{
	std::vector<char> isNear(size_t(mesh.vertexSlots()), 0);
	reportedLoop(mesh.halfEdgeSlots(), progress.part(0, 0.3), sizing, [&](int h) {
		if (mesh.isHalfEdge(h) && mayBeSmall(mesh.origin(h)))
			isNear[mesh.origin(h)] = isNear[mesh.target(h)] = 1;
	});
	std::vector<double> median(size_t(mesh.vertexSlots()), std::numeric_limits<double>::infinity());
	std::vector<int> around;
	std::vector<double> radii;
	reportedLoop(mesh.vertexSlots(), progress.part(0.3, 1), sizing, [&](int v) {
		if (!isNear[v])
			return;
		twoRings(mesh, v, around);
		radii.clear();
		for (int w : around)
			if (poles.has(w))
				radii.push_back(poles.radius[w]);
		if (radii.empty())
			return;
		const auto middle = radii.begin() + radii.size() / 2;
		std::nth_element(radii.begin(), middle, radii.end());
		median[v] = *middle;
	});
	return median;
}

/**
 * Whether the shape is as thin at a vertex as its balls are small. The balls next to sharp edges and in
 * corners shrink as fast as the edge is near, those of a tube or a plate do not: among the vertices
 * around, up to three edges or two radii away, few may have balls larger by a tenth and a quarter of their
 * distance.
 * @param radius  see medianRadii().
 * @param around, seen  scratch; `seen` is zero for each vertex, and zero again afterwards.
 */
inline bool isThin(const SurfaceMesh& mesh, const std::vector<double>& radius, int v,
	std::vector<int>& around, std::vector<char>& seen)
{
	constexpr double reachOfRadius = 2, step = 0.1, slope = 0.25, mostLarger = 0.25;
	constexpr int always = 3, farthest = 6; // edges
	const Point3d& p = mesh.position[v];
	const double reach = reachOfRadius * radius[v];
	around.assign(1, v);
	seen[v] = 1;
	int larger = 0;
	size_t first = 0;
	for (int ring = 0; ring < farthest && first < around.size(); ++ring) {
		const size_t last = around.size();
		for (; first < last; ++first)
			mesh.forEachOutgoing(around[first], [&](int h) {
				const int w = mesh.target(h);
				if (seen[w])
					return;
				const double distance = Distance(mesh.position[w], p);
				if (distance > reach && ring >= always)
					return;
				seen[w] = 1;
				around.push_back(w);
				larger += radius[w] > radius[v] * (1 + step) + slope * distance;
			});
	}
	for (int w : around)
		seen[w] = 0;
	return larger <= mostLarger * double(around.size() - 1);
}

/**
 * Whether the surface is a diameter away from a vertex, across its ball: as in a tube or a plate, not as at a
 * sharp edge or in a corner, where the ball touches both sides at nearly a right angle, and not at a tip.
 */
class OppositeSides
{
public:
	/// @throws Cancelled. Complexity: O(V log V).
	OppositeSides(const SurfaceMesh& mesh, const PoleSet& poles, const Progress& progress) :
			mesh(mesh), poles(poles), frame(mesh.position, progress),
			tree(frame.in(mesh.position, progress), progress)
	{
	}

	/// @pre poles.has(v). Complexity: O(log V).
	bool hasOne(int v) const
	{
		constexpr double farthest = 0.7; // radii; 1 where the sides are at a right angle
		const Point3d across = poles.centre[v] * 2 - mesh.position[v];
		const int nearest = tree.nearest(frame.in(across));
		return Distance(mesh.position[nearest], across) <= farthest * poles.radius[v];
	}

private:
	const SurfaceMesh& mesh;
	const PoleSet& poles;
	UnitFrame frame;
	PointTree tree;
};

} // namespace detail

/**
 * The sizing field of a surface: relativeLength times the local thickness, but growing by at most 0.3 of
 * the distance along edges.
 *
 * The local thickness at a vertex is the radius of the maximal inner balls around; balls that only sharp
 * edges, corners and bumps of the surface hold do not count, see detail::isThin() and
 * detail::OppositeSides, unless the shape is as thin next to them. A component is left alone that is nowhere
 * thinner than its lengths would be anyway, the smaller of `bound` and neutralLength of its diagonal. The field
 * is at least shortestLength of the diagonal.
 *
 * @param poles          of all vertices.
 * @param relativeLength longest edge in local thicknesses, > 0. An even mesh has 2 pi / relativeLength
 *                       vertices around a tube.
 * @param bound          of each component, mesh units: where the field is not below, it is infinite.
 * @return for each vertex slot; empty if the field is infinite everywhere.
 * @pre the surface is compact.
 * @throws Cancelled. Complexity: O(V), and O(V log V) where it is finite anywhere.
 */
inline SizingField sizingField(const MeasuredSurface& surface, const PoleSet& poles,
	double relativeLength, const std::vector<double>& bound, const Progress& progress = Progress())
{
	constexpr double infinity = std::numeric_limits<double>::infinity();
	const SurfaceMesh& mesh = surface.mesh();
	const std::vector<int>& component = surface.component();
	using Entry = std::pair<double, int>; // length, vertex
	std::vector<double> thin;             // of each component, the lengths that count as small
	for (int c = 0; c < surface.components(); ++c)
		thin.push_back(std::min(bound[c], neutralLength * surface.diagonal(c)));
	const std::vector<double> radius = detail::medianRadii(
		mesh, poles,
		[&](int v) {
			return poles.has(v) && relativeLength * poles.radius[v] < thin[component[v]];
		},
		progress.part(0, 0.4));
	std::vector<Entry> seeds;
	std::vector<int> around;
	std::vector<char> seen(size_t(mesh.vertexSlots()), 0);
	detail::reportedLoop(mesh.vertexSlots(), progress.part(0.4, 0.6), detail::sizing, [&](int v) {
		const double length = relativeLength * radius[v];
		if (poles.has(v) && length > 0 && length < thin[component[v]]
			&& detail::isThin(mesh, radius, v, around, seen))
			seeds.emplace_back(length, v);
	});
	SizingField field;
	if (seeds.empty())
		return field;
	for (auto& [length, v] : seeds)
		length = std::max(length, shortestLength * surface.diagonal(component[v]));
	const detail::OppositeSides opposite(mesh, poles, progress.part(0.6, 0.7));
	std::vector<double> least(bound.size(), infinity);
	const auto forget = [&](const auto& isNone) {
		seeds.erase(std::remove_if(seeds.begin(), seeds.end(), isNone), seeds.end());
	};
	forget([&](const Entry& seed) { return !opposite.hasOne(seed.second); });
	for (const auto& [length, v] : seeds)
		least[component[v]] = std::min(least[component[v]], length);
	forget([&](const Entry& seed) {
		const int c = component[seed.second];
		return least[c] >= relativeLength * thin[c];
	});
	if (seeds.empty())
		return field;
	field.assign(size_t(mesh.vertexSlots()), infinity);
	for (const auto& [length, v] : seeds)
		field[v] = length;
	// From all seeds at once, as Dijkstra's. What is next to a thin part is no thicker than its own balls.
	std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue(
		std::greater<Entry>(), std::move(seeds));
	size_t count = 0;
	while (!queue.empty()) {
		if (++count % 65536 == 0)
			progress.report(0.7, detail::sizing);
		const double length = queue.top().first;
		const int v = queue.top().second;
		queue.pop();
		if (length > field[v])
			continue;
		mesh.forEachOutgoing(v, [&](int h) {
			const int w = mesh.target(h);
			const double graded = length + detail::sizingSlope * std::sqrt(mesh.squaredLength(h));
			const double there = std::max(length, std::min(graded, relativeLength * radius[w]));
			if (there < field[w] && there < bound[component[w]]) {
				field[w] = there;
				queue.emplace(there, w);
			}
		});
	}
	progress.report(1, detail::sizing);
	return field;
}

/**
 * A field that is no smaller than it has to be for a mesh, or its edges, to cost no more than what is given:
 * max(field, b) for the smallest b with cost(max(field, b)) <= most, to 40 halvings of its logarithm.
 * @param field   finite somewhere. @param high an upper bound of b, mesh units.
 * @param cost    double(SizingField): falls where the field grows; cost(field) > most.
 * @return b. Complexity: 40 costs.
 */
template <class Cost>
double raiseToCost(SizingField& field, double high, double most, Cost&& cost)
{
	constexpr int halvings = 40;
	double low = *std::min_element(field.begin(), field.end());
	high = std::max(low, high);
	SizingField raised = field;
	const auto raiseTo = [&](double least) {
		for (size_t v = 0; v < field.size(); ++v)
			raised[v] = std::max(field[v], least);
	};
	for (int i = 0; i < halvings && low < high; ++i) {
		const double middle = std::sqrt(low * high);
		raiseTo(middle);
		(cost(raised) > most ? low : high) = middle;
	}
	raiseTo(high);
	field.swap(raised);
	return high;
}

/**
 * A field as much longer everywhere as it has to be for a mesh, or its edges, to cost no more than what is given,
 * but at most `factor` times; what then still is too much, raiseToCost() takes from the shortest lengths.
 * @param factor >= 1. @param field, high, most, cost as above.
 * @return no length is shorter: 0 where that was not needed. Complexity: 60 costs.
 */
template <class Cost>
double coarsenToCost(SizingField& field, double factor, double high, double most, Cost&& cost)
{
	constexpr int halvings = 20;
	const SizingField given = field;
	const auto multiply = [&](double by) {
		for (size_t v = 0; v < field.size(); ++v)
			field[v] = by * given[v];
	};
	multiply(factor);
	if (cost(field) > most)
		return raiseToCost(field, high, most, cost);
	double low = 1, enough = factor;
	for (int i = 0; i < halvings && low < enough; ++i) {
		const double middle = std::sqrt(low * enough);
		multiply(middle);
		(cost(field) > most ? low : enough) = middle;
	}
	multiply(enough);
	return 0;
}

} // namespace vcg::tri::mcf

#endif
