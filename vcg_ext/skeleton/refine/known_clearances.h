// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement: the distances of nodes from the surface, and whether edges are inside it.

#ifndef VCG_MCF_KNOWN_CLEARANCES_H
#define VCG_MCF_KNOWN_CLEARANCES_H

#include <skeleton/core/progress.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <map>
#include <vector>

namespace vcg::tri::mcf::refining {

/// Loops over nodes check for cancellation this often: a node may take several searches.
constexpr size_t nodesPerCheck = 256;

/// The distances of nodes from the surface, cached by position, since nodes are renumbered.
class KnownClearances
{
public:
	/// @param progress checked once for nodesPerCheck distances that were not known.
	explicit KnownClearances(const ClosestSurface& surface, const Progress& progress = Progress()) :
			surface(surface), progress(progress)
	{
	}

	/// @throws Cancelled
	double at(const Point3d& node)
	{
		if (const auto place = known.find(node); place != known.end())
			return place->second;
		if (known.size() % nodesPerCheck == 0)
			progress.check();
		return known[node] = surface.clearance(node, progress);
	}

private:
	const ClosestSurface& surface;
	const Progress progress;
	std::map<Point3d, double> known;
};

/// Sets the radius of each junction and tip to its distance from the surface; 0 outside.
inline void measureBranchEnds(CurveSkeleton& skeleton, KnownClearances& clearances)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() != 2)
			skeleton.radius[v] = std::max(clearances.at(skeleton.position[v]), 0.0);
}

/// Sets the radius of each node to its distance from the surface; 0 outside. @throws Cancelled
inline void measureNodes(CurveSkeleton& skeleton, KnownClearances& clearances)
{
	for (size_t v = 0; v < skeleton.position.size(); ++v)
		skeleton.radius[v] = std::max(clearances.at(skeleton.position[v]), 0.0);
}

/**
 * Whether the segment from a to b is inside the surface, given its ends' distances from it or lower
 * bounds of them: two balls that touch each other cover the segment between their centres; else it
 * is halved.
 */
inline bool isSegmentInside(const ClosestSurface& surface, const Point3d& a, double radiusA,
	const Point3d& b, double radiusB, int depth = 0)
{
	constexpr int deepest = 6;
	if (radiusA <= 0 || radiusB <= 0)
		return false;
	if (Distance(a, b) <= radiusA + radiusB)
		return true;
	if (depth == deepest)
		return false;
	const Point3d middle = (a + b) / 2;
	const double radius = surface.clearance(middle);
	return isSegmentInside(surface, a, radiusA, middle, radius, depth + 1)
		&& isSegmentInside(surface, middle, radius, b, radiusB, depth + 1);
}

/// The same for an edge of a skeleton whose radii may be lower bounds: measures them if needed.
inline bool isEdgeInside(CurveSkeleton& skeleton, const ClosestSurface& surface, int a, int b)
{
	const auto inside = [&] {
		return isSegmentInside(surface, skeleton.position[a], skeleton.radius[a],
			skeleton.position[b], skeleton.radius[b]);
	};
	if (inside())
		return true;
	for (int v : {a, b})
		skeleton.radius[v] = std::max(surface.clearance(skeleton.position[v]), 0.0);
	return inside();
}

} // namespace vcg::tri::mcf::refining

#endif
