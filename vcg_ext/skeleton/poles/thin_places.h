// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Where a shape is thin: the local thickness at its vertices, from their maximal balls.

#ifndef VCG_MCF_THIN_PLACES_H
#define VCG_MCF_THIN_PLACES_H

#include "pole_set.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/unit_frame.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// Where the sizing field is this fraction of the diagonal, both give the same lengths: edges of
/// the default resampling, epsilon, spacing of the refined curve. Below, all shrink with the field.
constexpr double neutralLength = 0.0045;

/// Lower bound of the sizing field, fraction of the component's diagonal: a needle a million times
/// as long as thick would need more vertices than any machine holds.
constexpr double shortestLength = 3e-5;

namespace detail {

constexpr const char* sizing = "Measuring the local thickness";

/// The neighbours of each vertex in one array: rings that overlap walk the same edges many times.
class NeighbourLists
{
public:
	/// @pre the mesh is compact. @throws Cancelled. Complexity: O(V).
	NeighbourLists(const SurfaceMesh& mesh, const Progress& progress)
	{
		target.reserve(size_t(mesh.halfEdgeSlots()));
		start.reserve(size_t(mesh.vertexSlots()) + 1);
		start.push_back(0);
		reportedLoop(mesh.vertexSlots(), progress, sizing, [&](int v) {
			mesh.forEachOutgoing(v, [&](int h) { target.push_back(mesh.target(h)); });
			start.push_back(int(target.size()));
		});
	}

	int valence(int v) const { return start[v + 1] - start[v]; }

	template <class Visitor>
	void forEach(int v, Visitor&& visit) const
	{
		for (int i = start[v]; i < start[v + 1]; ++i)
			visit(target[i]);
	}

private:
	std::vector<int> start, target;
};

/// Rings of a vertex do not spread through neighbours of more edges than these. They would reach
/// all around a fan of triangles, which is no neighbourhood, in the square of its size.
constexpr int maxSpread = 256;

/// Scratch memory of a walk over the rings of each vertex of a mesh in turn.
struct RingScratch
{
	std::vector<int> around;
	std::vector<int> seenFrom; ///< of each vertex: the last one whose rings held it, -1 if none did
	std::vector<double> radii;
	explicit RingScratch(int vertices) : seenFrom(size_t(vertices), -1) {}
};

/// The vertices up to two edges away from v, v first; see maxSpread.
/// @param scratch receives them as `around`; used for other vertices before.
inline void twoRings(const NeighbourLists& neighbours, int v, RingScratch& scratch)
{
	std::vector<int>& around = scratch.around;
	const auto add = [&](int w) {
		if (scratch.seenFrom[w] == v)
			return;
		scratch.seenFrom[w] = v;
		around.push_back(w);
	};
	around.clear();
	add(v);
	neighbours.forEach(v, add);
	const size_t oneRing = around.size();
	for (size_t i = 1; i < oneRing; ++i)
		if (neighbours.valence(around[i]) <= maxSpread)
			neighbours.forEach(around[i], add);
}

/// Calls visit(vertex, RingScratch&) for each vertex, several at once, each thread with scratch
/// memory of its own.
/// @throws Cancelled
template <class Visit>
void forEachVertex(int vertices, const Progress& progress, const Visit& visit)
{
	constexpr int minForTeam = 1 << 12;
	constexpr int reportEvery = 1 << 9; // a visit may take a millisecond
	if (vertices == 0)
		return;
	forEachPart(rangesForThreads(vertices, minForTeam), progress, sizing,
		[&](int begin, int end, const Progress& part) {
			RingScratch scratch(vertices);
			for (int v = begin; v < end; ++v) {
				if ((v - begin) % reportEvery == 0)
					part.report(double(v - begin) / double(end - begin), sizing);
				visit(v, scratch);
			}
		});
}

/**
 * The local thickness at each vertex where it may be small, else infinite: the median radius of the
 * balls up to two edges away, since single balls are too small next to slivers and bumps of the
 * surface, and too large where a normal is tilted.
 * @param isNear  of each vertex, whether its thickness may be small.
 * @throws Cancelled. Complexity: O(V) for bounded valence.
 */
inline std::vector<double> medianRadii(const NeighbourLists& neighbours, const PoleSet& poles,
	const std::vector<char>& isNear, const Progress& progress)
{
	std::vector<double> median(isNear.size(), std::numeric_limits<double>::infinity());
	forEachVertex(int(isNear.size()), progress, [&](int v, RingScratch& scratch) {
		if (!isNear[v])
			return;
		std::vector<double>& radii = scratch.radii;
		twoRings(neighbours, v, scratch);
		radii.clear();
		for (int w : scratch.around)
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

/// isThin() looks up to so many edges away.
constexpr int farthestRing = 6;

/// An upper bound of the radii up to farthestRing edges away from each vertex.
/// @throws Cancelled. Complexity: O(E).
inline std::vector<double> largestAround(
	const NeighbourLists& neighbours, std::vector<double> radius, const Progress& progress)
{
	std::vector<double> next(radius.size());
	for (int ring = 0; ring < farthestRing; ++ring) {
		const Progress part =
			progress.part(double(ring) / farthestRing, double(ring + 1) / farthestRing);
		forEachBlock(int(radius.size()), part, sizing, [&](int begin, int end) {
			for (int v = begin; v < end; ++v) {
				double largest = radius[v];
				neighbours.forEach(v, [&](int w) { largest = std::max(largest, radius[w]); });
				next[v] = largest;
			}
		});
		radius.swap(next);
	}
	return radius;
}

/**
 * Whether small balls at a vertex mean that the shape is thin there. Balls shrink towards sharp
 * edges and corners in proportion to the distance, but not along a tube or a plate: of the vertices
 * up to three edges away, and up to six within two radii r, at most a quarter may have balls larger
 * than 1.1 r + d / 4, d their distance. See maxSpread.
 * @param radius  see medianRadii().
 * @param largest see largestAround(): where it is not larger, as along a tube, no ring is walked.
 */
inline bool isThin(const SurfaceMesh& mesh, const NeighbourLists& neighbours,
	const std::vector<double>& radius, double largest, int v, RingScratch& scratch)
{
	constexpr double reachOfRadius = 2, step = 0.1, slope = 0.25, maxGrowth = 0.25;
	constexpr int always = 3; // edges
	std::vector<int>& around = scratch.around;
	std::vector<int>& seenFrom = scratch.seenFrom;
	const Point3d& p = mesh.position[v];
	const double reach = reachOfRadius * radius[v], larger = radius[v] * (1 + step);
	if (largest <= larger)
		return true;
	around.assign(1, v);
	seenFrom[v] = v;
	int countLarger = 0;
	size_t first = 0;
	for (int ring = 0; ring < farthestRing && first < around.size(); ++ring) {
		const size_t last = around.size();
		for (; first < last; ++first) {
			if (first > 0 && neighbours.valence(around[first]) > maxSpread)
				continue;
			neighbours.forEach(around[first], [&](int w) {
				if (seenFrom[w] == v)
					return;
				seenFrom[w] = v;
				const double squared = SquaredDistance(mesh.position[w], p);
				if (ring >= always && squared > reach * reach)
					return;
				around.push_back(w);
				countLarger +=
					radius[w] > larger && radius[w] > larger + slope * std::sqrt(squared);
			});
		}
	}
	return countLarger <= maxGrowth * double(around.size() - 1);
}

/**
 * Whether there is surface of the same component diametrically opposite a vertex on its ball: so in
 * a tube or a plate, but not at a sharp edge or in a corner, where the ball touches both sides at
 * nearly a right angle, nor at a tip.
 */
class OppositeSides
{
public:
	/// @param isWanted  of each component, whether of() will be asked for its vertices.
	/// @throws Cancelled. Complexity: O(V log V).
	OppositeSides(const SurfaceMesh& mesh, const PoleSet& poles, const std::vector<int>& component,
		const std::vector<char>& isWanted, const Progress& progress) :
			mesh(mesh),
			poles(poles), component(component), normal(mesh.vertexNormals(progress)),
			frame(mesh.position, progress),
			vertices(component, int(isWanted.size()), progress.cancelOnly()), tree(isWanted.size())
	{
		for (size_t c = 0; c < isWanted.size(); ++c) {
			if (!isWanted[c])
				continue;
			std::vector<Point3d> points;
			cancellableLoop(int(vertices.ids[c].size()), progress,
				[&](int i) { points.push_back(frame.in(mesh.position[vertices.ids[c][i]])); });
			tree[c].emplace(points, progress.cancelOnly());
		}
	}

	/// The vertex nearest to the point opposite v on its ball; -1 if it is not near.
	/// @pre poles.has(v), and its component is wanted. Complexity: O(log V).
	int of(int v) const
	{
		constexpr double farthest = 0.7; // radii; 1 where the sides are at a right angle
		const Point3d across = poles.centre[v] * 2 - mesh.position[v];
		const size_t c = size_t(component[v]);
		const int nearest = vertices.ids[c][size_t(tree[c]->nearest(frame.in(across)))];
		return Distance(mesh.position[nearest], across) <= farthest * poles.radius[v] ? nearest
																					  : -1;
	}

	/// Whether the normals of two vertices are more than a right angle apart.
	bool areBackToBack(int v, int w) const { return normal[v] * normal[w] < 0; }

private:
	const SurfaceMesh& mesh;
	const PoleSet& poles;
	const std::vector<int>& component;
	std::vector<Point3d> normal;
	UnitFrame frame;
	ComponentVertices vertices;
	std::vector<std::optional<PointTree>> tree; ///< of each component
};

/// For each component the fraction of its seeds that are back to back with the vertex across; 1
/// without seeds.
/// @param across  of each seed, see OppositeSides::of().
template <class Seeds>
std::vector<double> partBackToBack(const Seeds& seeds, const std::vector<int>& across,
	const OppositeSides& opposite, const std::vector<int>& component, int components)
{
	std::vector<double> turned(size_t(components), 0), all(size_t(components), 0);
	for (const auto& [length, v] : seeds) {
		turned[component[v]] += opposite.areBackToBack(v, across[v]);
		++all[component[v]];
	}
	for (size_t c = 0; c < all.size(); ++c)
		turned[c] = all[c] > 0 ? turned[c] / all[c] : 1;
	return turned;
}

} // namespace detail

/// The vertices where a shape is thin. Lengths are relativeLength times the local thickness, mesh
/// units: those of the sizing field before it is graded.
struct ThinPlaces
{
	/// Of each component: lengths below this count as small.
	std::vector<double> below;
	/// Of each vertex where the length may be small, else infinite; empty if there are no seeds.
	std::vector<double> length;
	using Seed = std::pair<double, int>;
	/// Length and vertex where the shape is thin; lengths are at least shortestLength times the
	/// diagonal.
	std::vector<Seed> seeds;

	/// Removes the seeds for which isNone(seed).
	template <class IsNone>
	void removeSeeds(const IsNone& isNone)
	{
		seeds.erase(std::remove_if(seeds.begin(), seeds.end(), isNone), seeds.end());
	}
};

namespace detail {

/// Removes the seeds of components that are nowhere thinner than their edges would be anyway.
inline void keepThinComponents(
	ThinPlaces& places, const std::vector<int>& component, double relativeLength)
{
	std::vector<double> minimum(places.below.size(), std::numeric_limits<double>::infinity());
	for (const auto& [length, v] : places.seeds)
		minimum[component[v]] = std::min(minimum[component[v]], length);
	places.removeSeeds([&](const ThinPlaces::Seed& seed) {
		const int c = component[seed.second];
		return minimum[c] >= relativeLength * places.below[c];
	});
}

} // namespace detail

/// The thin places that are left where only lengths below smaller bounds count as small.
/// @param below of each component, nowhere above places.below. Complexity: O(seeds).
inline ThinPlaces thinPlacesBelow(ThinPlaces places, std::vector<double> below,
	const std::vector<int>& component, double relativeLength)
{
	places.below = std::move(below);
	places.removeSeeds([&](const ThinPlaces::Seed& seed) {
		return !(seed.first < places.below[component[seed.second]]);
	});
	detail::keepThinComponents(places, component, relativeLength);
	return places;
}

/// The lengths that count as small, see ThinPlaces::below: the smaller of `bound` and neutralLength
/// times the diagonal. @param bound  of each component, mesh units.
inline std::vector<double> smallLengths(
	const MeasuredSurface& surface, const std::vector<double>& bound)
{
	std::vector<double> below;
	for (int c = 0; c < surface.components(); ++c)
		below.push_back(std::min(bound[c], neutralLength * surface.diagonal(c)));
	return below;
}

/**
 * Finds where a shape is thin.
 *
 * The local thickness at a vertex is the median radius of the maximal inner balls around it. Balls
 * that are small only because of sharp edges, corners and bumps do not count, see detail::isThin()
 * and detail::OppositeSides, unless the shape is as thin next to them; nor do those of components
 * whose balls are small from noise: across a tube or a plate the normals are opposite, across noise
 * they are random.
 *
 * @param poles of all vertices. @param below  see ThinPlaces::below.
 * @pre the surface is compact.
 * @throws Cancelled. Complexity: O(V), or O(V log V) where there are such places; both for bounded
 *         valence.
 */
inline ThinPlaces thinPlaces(const MeasuredSurface& surface, const PoleSet& poles,
	double relativeLength, std::vector<double> below, const Progress& progress = Progress())
{
	constexpr double minBackToBack = 2.0 / 3; // clean shapes have 0.88 and more, noise 0.6 and less
	const SurfaceMesh& mesh = surface.mesh();
	const std::vector<int>& component = surface.component();
	ThinPlaces places;
	places.below = std::move(below);
	const std::vector<double>& thin = places.below;
	using Seed = ThinPlaces::Seed;
	std::vector<Seed>& seeds = places.seeds;
	std::vector<char> isNear(size_t(mesh.vertexSlots()), 0);
	bool isAnyNear = false;
	detail::reportedLoop(mesh.halfEdgeSlots(), progress.part(0, 0.1), detail::sizing, [&](int h) {
		if (!mesh.isHalfEdge(h))
			return;
		const int v = mesh.origin(h);
		if (poles.has(v) && relativeLength * poles.radius[v] < thin[component[v]]) {
			isNear[v] = isNear[mesh.target(h)] = 1;
			isAnyNear = true;
		}
	});
	if (!isAnyNear)
		return places;
	const detail::NeighbourLists neighbours(mesh, progress.part(0.1, 0.3));
	std::vector<double> radius =
		detail::medianRadii(neighbours, poles, isNear, progress.part(0.3, 0.6));
	const std::vector<double> largest =
		detail::largestAround(neighbours, radius, progress.part(0.6, 0.7));
	std::vector<char> isSeed(size_t(mesh.vertexSlots()), 0);
	detail::forEachVertex(
		mesh.vertexSlots(), progress.part(0.7, 0.9), [&](int v, detail::RingScratch& scratch) {
			const double length = relativeLength * radius[v];
			isSeed[v] = poles.has(v) && length > 0 && length < thin[component[v]]
				&& detail::isThin(mesh, neighbours, radius, largest[v], v, scratch);
		});
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (isSeed[v])
			seeds.emplace_back(std::max(relativeLength * radius[v],
								   shortestLength * surface.diagonal(component[v])),
				v);
	if (seeds.empty())
		return places;
	std::vector<char> hasSeeds(size_t(surface.components()), 0);
	for (const auto& [length, v] : seeds)
		hasSeeds[size_t(component[v])] = 1;
	const Progress last = progress.part(0.9, 1);
	const detail::OppositeSides opposite(mesh, poles, component, hasSeeds, last);
	std::vector<int> across(size_t(mesh.vertexSlots()), -1); // of seeds
	forEachBlock(int(seeds.size()), last, detail::sizing, [&](int begin, int end) {
		for (int i = begin; i < end; ++i)
			across[seeds[i].second] = opposite.of(seeds[i].second);
	});
	places.removeSeeds([&](const Seed& seed) { return across[seed.second] < 0; });
	const std::vector<double> backToBack =
		detail::partBackToBack(seeds, across, opposite, component, surface.components());
	places.removeSeeds(
		[&](const Seed& seed) { return backToBack[component[seed.second]] < minBackToBack; });
	detail::keepThinComponents(places, component, relativeLength);
	if (seeds.empty())
		return places;
	for (double& r : radius)
		r *= relativeLength;
	places.length = std::move(radius);
	return places;
}

} // namespace vcg::tri::mcf

#endif
