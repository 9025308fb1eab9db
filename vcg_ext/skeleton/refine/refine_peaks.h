// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the peaks: where the surface stands out most from the balls on the skeleton.

#ifndef VCG_MCF_REFINE_PEAKS_H
#define VCG_MCF_REFINE_PEAKS_H

#include "local_scale.h"
#include "spur_rules.h"

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

/// What counts as a feature. Heights are distances from the union of the skeleton's balls.
struct FeatureRule
{
	/// Minimum gain of the branch into a feature: 1 + (r_tip - r_joint) / length.
	double minGain;
	/// Minimum height of a feature's peak, in radii of the nearest ball.
	double minHeight;
	/// Longest step of a branch, in diagonals.
	double spacing;
	/// Factor of the spacing.
	const LocalScale& scale = sameEverywhere;
	/// Minimum length of the branch, in radii of the ball that it ends in.
	double minWay = minWayOfBranch;
	/// That length times the relative height of the peak is at least this, unless the peak is a
	/// spike: low features are long ones.
	double minProtrusion = 0.56;
	/// Minimum spikiness of a spike: that of a cone with a half angle of 60 degrees.
	double minOfSpike = 0.5;
	/// The peak rises from its surroundings by this part of the radius of the nearest ball, and by
	/// this many diagonals.
	double minProminence = 0.05, minRise = 0.005;
	/// Minimum height of the lobe of a plate, in diagonals.
	double minLobe = 0.05;
	/// Minimum height of a blunt corner, in diagonals.
	double minCorner = minBluntHeight;
};

/// A view of one component of a surface; its vertices are numbered by their place in it.
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
	/// Sum of the double area vectors of the triangles around a vertex.
	Point3d doubleAreaVector(int i) const
	{
		Point3d sum(0, 0, 0);
		mesh.forEachOutgoing(vertices[i], [&](int h) { sum += mesh.doubleAreaVector(h / 3); });
		return sum;
	}
};

/// The height of each vertex above the union of the skeleton's balls, and the nearest ball's node.
struct Heights
{
	std::vector<double> height;
	std::vector<int> node;
};

/// Nodes whose balls cover what all balls cover, up to a hundredth of a radius.
inline std::vector<int> coveringNodes(const CurveSkeleton& skeleton)
{
	constexpr double apart = 0.25; // in radii; the gaps are apart^2 / 8 radii deep
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

/// The balls that may be nearest to some point of a box: each other ball is farther than one of
/// them from all points of the box. @param near receives them. @pre there are balls to choose from.
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

/// The heights above the balls of the covering nodes.
/// @param order of the vertices, one in which neighbours are near each other.
/// @pre radius of the covering nodes is their distance from the surface.
/// @throws Cancelled. Complexity: O(V * covering nodes), with a small factor.
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
 * A local maximum of the height, with height h. The connected part of the surface around it that is
 * above a level l reaches to a distance E(l) from it; the spikiness is the maximum of (h - l) /
 * E(l), at most 1, since the height is 1-Lipschitz: near 1 for a limb, cos a for a cone with half
 * angle a, and near 0 for a rim.
 */
struct Peak
{
	int vertex;
	double extent = 0, spikiness = 0;
	/// Height of the vertex; the same in radii of the nearest ball.
	double height = 0, relativeHeight = 0;
	/// The level at which the surface around it meets that around another peak; 0 if none is known.
	double saddle = 0;
};

/// The vertices of positive height, the highest first; ties are broken by the coordinates.
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
		// A bucket sort by slices of equal thickness, each of them sorted when it is reached.
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
 * The peaks that are high enough, rise far enough and are too spiky for rims; the highest first.
 * @throws Cancelled. Complexity: about O(V).
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
	// Union-find of the parts above a falling level; parts are numbered from the highest peak down.
	const Progress begin = progress.cancelOnly();
	MergeForest forest(surface.size(), progress);
	std::vector<char> isAbove = detail::filledArray(size_t(surface.size()), char(0), begin);
	std::vector<int> partOfRoot = detail::filledArray(isAbove.size(), -1, begin);
	std::vector<Peak> parts;
	// The number of peaks that are high enough and may still become spikier.
	int open = 0;
	const auto isOpen = [&](const Peak& peak) {
		return isHigh(peak.vertex)
			&& height[peak.vertex] > std::max(peak.spikiness, minSpikiness) * peak.extent;
	};
	const auto join = [&](int a, int b, double level) {
		if (partOfRoot[a] > partOfRoot[b])
			std::swap(a, b);
		Peak& higher = parts[partOfRoot[a]];
		Peak& lower = parts[partOfRoot[b]];
		if (height[lower.vertex] - level >= minRise(lower.vertex)) {
			higher.saddle = std::max(higher.saddle, level);
			lower.saddle = level;
		}
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
				join(part, other, height[v]);
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
