// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the peaks: where the surface stands out most from the balls on the skeleton.

#ifndef VCG_MCF_REFINE_PEAKS_H
#define VCG_MCF_REFINE_PEAKS_H

#include "local_scale.h"
#include "refine_graph.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::refining {

/// What is a feature. Heights are distances from the union of the skeleton's balls.
struct FeatureRule
{
	/// On the branch into a feature the balls reach further by at least this part of the way.
	double minGain;
	/// The peak of a feature is as high as this part of the radius of the ball that is nearest.
	double minHeight;
	/// Longest step of a branch, in diagonals.
	double spacing;
	/// Of the spacing.
	const LocalScale& scale = sameEverywhere;
	/// The way is at least this many radii of the ball that it ends in.
	double minWay = minWayOfBranch;
	/// The way, in such radii, times the relative height of the peak is at least this, but for spikes: low features are
	/// long ones.
	double minProtrusion = 0.56;
	/// Spikiness from which on a peak is a spike: a cone with a half angle of 60 degrees has 0.5.
	double minOfSpike = 0.5;
	/// The peak rises from its surroundings by this part of the radius of the nearest ball, and by this many diagonals.
	double minProminence = 0.05, minRise = 0.005;
	/// The lobe of a plate is at least this many diagonals high.
	double minLobe = 0.05;
	/// A blunt corner is at least this many diagonals high.
	double minCorner = minBluntHeight;
};

/// A component of a surface; its vertices are numbered by their place in it.
struct SurfaceComponent
{
	const SurfaceMesh& mesh;
	const std::vector<int>& vertices;
	/// Place of each vertex of the mesh in its own component.
	const std::vector<int>& place;

	int size() const { return int(vertices.size()); }
	const Point3d& position(int i) const { return mesh.position[vertices[i]]; }
	template <class Visitor>
	void forEachNeighbour(int i, Visitor&& visit) const
	{
		mesh.forEachOutgoing(vertices[i], [&](int h) { visit(place[mesh.target(h)]); });
	}
};

/// The height of each vertex above the union of the skeleton's balls, and the node of the nearest one.
struct Heights
{
	std::vector<double> height;
	std::vector<int> node;
};

/// Nodes whose balls cover, but for a hundredth of their radius, what all balls cover.
inline std::vector<int> coveringNodes(const CurveSkeleton& skeleton)
{
	constexpr double apart = 0.25; // in radii; leaves out apart^2 / 8 of one
	std::vector<int> covering;
	for (const Branch& branch : skeletonBranches(skeleton)) {
		double way = std::numeric_limits<double>::infinity();
		for (size_t i = 0; i < branch.nodes.size(); ++i) {
			const int v = branch.nodes[i];
			if (i > 0)
				way += Distance(skeleton.position[v], skeleton.position[branch.nodes[i - 1]]);
			if (way < apart * skeleton.radius[v] && i + 1 < branch.nodes.size())
				continue;
			covering.push_back(v);
			way = 0;
		}
	}
	std::sort(covering.begin(), covering.end());
	covering.erase(std::unique(covering.begin(), covering.end()), covering.end());
	return covering;
}

/// The balls that may be the nearest of points in a box: all others are farther than one of them from
/// any point in it. @pre there are balls to choose from.
inline void selectNearBalls(const CurveSkeleton& skeleton, const std::vector<int>& balls,
	const Box3d& box, std::vector<int>& near)
{
	const Point3d middle = box.Center();
	const double extent = box.Diag() / 2;
	double maximum = std::numeric_limits<double>::infinity();
	std::vector<double> height;
	height.reserve(balls.size());
	for (int node : balls) {
		height.push_back(Distance(middle, skeleton.position[node]) - skeleton.radius[node]);
		maximum = std::min(maximum, height.back() + extent);
	}
	near.clear();
	for (size_t i = 0; i < balls.size(); ++i)
		if (height[i] - extent <= maximum)
			near.push_back(balls[i]);
}

/// @param order of the vertices, one in which neighbours are near each other.
/// @pre radius of the covering nodes is their distance from the surface.
/// Complexity: O(V * covering nodes), with a small factor.
inline Heights heightsAbove(const CurveSkeleton& skeleton, const std::vector<int>& covering,
	const SurfaceComponent& surface, const std::vector<int>& order, const Progress& progress)
{
	constexpr int groupSize = 16;
	const char* const what = "Refining the skeleton";
	const size_t size = size_t(surface.size());
	Heights heights = {
		detail::filledArray(size, 0.0, progress), detail::filledArray(size, -1, progress)};
	forEachBlock(surface.size(), progress, what, [&](int begin, int end) {
		const auto boxOf = [&](int first, int last) {
			Box3d box;
			for (int i = first; i < last; ++i)
				box.Add(surface.position(order[i]));
			return box;
		};
		std::vector<int> nearBlock, nearGroup;
		selectNearBalls(skeleton, covering, boxOf(begin, end), nearBlock);
		for (int first = begin; first < end; first += groupSize) {
			const int last = std::min(first + groupSize, end);
			selectNearBalls(skeleton, nearBlock, boxOf(first, last), nearGroup);
			for (int i = first; i < last; ++i) {
				const Point3d& p = surface.position(order[i]);
				double minimum = std::numeric_limits<double>::infinity();
				int nearest = -1;
				for (int node : nearGroup)
					if (const double height =
							Distance(p, skeleton.position[node]) - skeleton.radius[node];
						height < minimum) {
						minimum = height;
						nearest = node;
					}
				heights.height[order[i]] = minimum;
				heights.node[order[i]] = nearest;
			}
		}
	});
	return heights;
}

/**
 * A vertex where the height is greatest within a part of the surface from which every way to a higher
 * one leads down. The part above a level l, which rises h - l above it, reaches to a distance E(l)
 * from the peak; the spikiness is the greatest (h - l) / E(l), at most 1, since the height changes no
 * faster than the place: near 1 for a limb, cos a for a cone with half angle a, and near 0 for a rim.
 */
struct Peak
{
	int vertex;
	double extent = 0, spikiness = 0;
	/// Of the vertex; the same in radii of the nearest ball.
	double height = 0, relativeHeight = 0;
};

/// The vertices of positive height, the highest first; of several the one with the smallest coordinates.
class VerticesByHeight
{
public:
	/// @throws Cancelled. Complexity: O(V).
	VerticesByHeight(const SurfaceComponent& surface, const std::vector<double>& height,
		const Progress& progress) :
			surface(surface)
	{
		const char* const what = "Refining the skeleton";
		const double top = *std::max_element(height.begin(), height.end());
		// In slices of equal thickness, each of them sorted when its turn comes.
		const int slices = std::max(1, surface.size());
		const auto slice = [&](int v) {
			return std::min(slices - 1, int((1 - height[v] / top) * slices));
		};
		detail::fillArray(ends, size_t(slices) + 1, 0, progress);
		detail::reportedLoop(surface.size(), progress.part(0, 0.5), what, [&](int v) {
			if (height[v] > 0)
				++ends[slice(v) + 1];
		});
		std::partial_sum(ends.begin(), ends.end(), ends.begin());
		const Progress placing = progress.part(0.5, 1);
		detail::fillArray(entries, size_t(ends.back()), {0.0, -1}, placing);
		detail::reportedLoop(surface.size(), placing, what, [&](int v) {
			if (height[v] > 0)
				entries[ends[slice(v)]++] = {height[v], v};
		});
	}

	int size() const { return int(entries.size()); }

	/// The next vertex down, -1 after the last.
	int next()
	{
		if (place == size())
			return -1;
		if (place == sorted) {
			while (ends[current] == place)
				++current;
			sorted = ends[current];
			std::sort(entries.begin() + place, entries.begin() + sorted,
				[&](const auto& a, const auto& b) {
					return a.first != b.first
						? a.first > b.first
						: surface.position(a.second) < surface.position(b.second);
				});
		}
		return entries[place++].second;
	}

private:
	const SurfaceComponent& surface;
	std::vector<std::pair<double, int>> entries;
	std::vector<int> ends; ///< of the slices
	int current = 0, place = 0, sorted = 0;
};

/**
 * The peaks that are high enough, rise far enough and are no mere rims; the highest first.
 * Complexity: about O(V).
 */
inline std::vector<Peak> peaks(const CurveSkeleton& skeleton, const SurfaceComponent& surface,
	const Heights& heights, const FeatureRule& rule, const Progress& progress)
{
	constexpr double minSpikiness = 0.12;
	const std::vector<double>& height = heights.height;
	const auto minRise = [&](int peak) {
		return std::max(rule.minRise, rule.minProminence * skeleton.radius[heights.node[peak]]);
	};
	const auto isHigh = [&](int v) {
		return height[v] >= rule.minHeight * skeleton.radius[heights.node[v]]
			&& height[v] >= minRise(v);
	};
	const char* const what = "Refining the skeleton";
	VerticesByHeight falling(surface, height, progress.part(0, 0.4));
	int highLeft = 0;
	detail::reportedLoop(surface.size(), progress.part(0.4, 0.5), what,
		[&](int v) { highLeft += height[v] > 0 && isHigh(v); });
	// The parts above a level that falls, as a forest; they are numbered from the highest peak down.
	const Progress begin = progress.cancelOnly();
	MergeForest forest(surface.size(), progress);
	std::vector<char> isAbove = detail::filledArray(size_t(surface.size()), char(0), begin);
	std::vector<int> partOfRoot = detail::filledArray(isAbove.size(), -1, begin);
	std::vector<Peak> parts;
	// Peaks that are high enough and may still turn out to be spikier.
	int open = 0;
	const auto isOpen = [&](const Peak& peak) {
		return isHigh(peak.vertex)
			&& height[peak.vertex] > std::max(peak.spikiness, minSpikiness) * peak.extent;
	};
	const auto join = [&](int a, int b) {
		if (partOfRoot[a] > partOfRoot[b])
			std::swap(a, b);
		Peak& higher = parts[partOfRoot[a]];
		const Peak& lower = parts[partOfRoot[b]];
		open -= isOpen(higher) + isOpen(lower);
		higher.extent = std::max(higher.extent,
			lower.extent
				+ Distance(surface.position(higher.vertex), surface.position(lower.vertex)));
		open += isOpen(higher);
		forest.merge(b, a);
	};
	detail::Ticker ticker(progress.part(0.5, 1), what, falling.size());
	while (highLeft > 0 || open > 0) {
		ticker.tick();
		const int v = falling.next();
		if (v < 0)
			break;
		highLeft -= isHigh(v);
		int part = -1;
		surface.forEachNeighbour(v, [&](int w) {
			if (!isAbove[w])
				return;
			const int other = forest.find(w);
			if (part >= 0 && part != other)
				join(part, other);
			part = forest.find(other);
		});
		isAbove[v] = 1;
		if (part < 0) {
			partOfRoot[v] = int(parts.size());
			parts.push_back({v});
			open += isOpen(parts.back());
			continue;
		}
		forest.merge(v, part);
		Peak& grown = parts[partOfRoot[part]];
		open -= isOpen(grown);
		grown.extent =
			std::max(grown.extent, Distance(surface.position(grown.vertex), surface.position(v)));
		const double rise = height[grown.vertex] - height[v];
		if (rise >= minRise(grown.vertex))
			grown.spikiness = std::max(grown.spikiness, rise / grown.extent);
		open += isOpen(grown);
	}
	for (Peak& peak : parts) {
		peak.height = height[peak.vertex];
		peak.relativeHeight = peak.height / skeleton.radius[heights.node[peak.vertex]];
	}
	const auto isSmall = [&](const Peak& peak) {
		return peak.spikiness < minSpikiness || !isHigh(peak.vertex);
	};
	parts.erase(std::remove_if(parts.begin(), parts.end(), isSmall), parts.end());
	return parts;
}

} // namespace vcg::tri::mcf::refining

#endif
