// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The surface cut into the parts that belong to the branches of its skeleton.

#ifndef VCG_MCF_SEGMENTATION_H
#define VCG_MCF_SEGMENTATION_H

#include "segmentation_labels.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/segment.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/closest_curve.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// Where each place of the surface belongs.
struct SurfaceParts
{
	/// For each face slot its branch, as skeletonBranches() numbers them; -1 on a component of the
	/// surface that no branch belongs to.
	std::vector<int> ofFace;
	/// For each vertex slot the distance to the nearest of its branch and those that meet it, mesh
	/// units: the local thickness. Without a branch, the distance to the skeleton.
	std::vector<double> distance;
};

/**
 * For each vertex of a surface the nearer end of the closest edge: a correspondence for a skeleton
 * that has none. Where two parts of the shape nearly touch it may be wrong.
 * @param surface  the vertices. @pre the skeleton has a node.
 * @throws Cancelled. Complexity: O(V log N), and O(N) for each vertex that is closest to an
 *         isolated node.
 */
inline std::vector<int> closestNodes(const std::vector<Point3d>& surface,
	const CurveSkeleton& skeleton, const Progress& progress = Progress())
{
	const ClosestCurve curve(skeleton);
	std::vector<int> node(surface.size());
	forEachBlock(
		int(surface.size()), progress, "Finding the closest nodes", [&](int begin, int end) {
			for (int v = begin; v < end; ++v) {
				const ClosestCurve::Hit hit = curve.closest(surface[v]);
				if (hit.edge >= 0)
					node[v] = skeleton.edges[hit.edge][hit.part > 0.5];
				else
					node[v] =
						int(std::find(skeleton.position.begin(), skeleton.position.end(), hit.point)
							- skeleton.position.begin());
			}
		});
	return node;
}

namespace detail {

/// The branch of each node; -1 for junctions, which belong to several, and isolated nodes.
inline std::vector<int> branchOfNodes(
	const CurveSkeleton& skeleton, const std::vector<Branch>& branches)
{
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	std::vector<int> ofNode(skeleton.position.size(), -1);
	for (size_t b = 0; b < branches.size(); ++b)
		for (int v : branches[b].nodes)
			if (neighbours[v].size() <= 2)
				ofNode[v] = int(b);
	return ofNode;
}

/// For each branch its edges and those of the branches that meet it, as pairs of nodes.
inline std::vector<std::vector<std::array<int, 2>>> edgesAround(
	const CurveSkeleton& skeleton, const std::vector<Branch>& branches)
{
	std::vector<std::vector<int>> atNode(skeleton.position.size());
	for (size_t b = 0; b < branches.size(); ++b)
		for (int end : {branches[b].first(), branches[b].last()})
			atNode[end].push_back(int(b));
	std::vector<std::vector<std::array<int, 2>>> edges(branches.size());
	for (size_t b = 0; b < branches.size(); ++b) {
		std::vector<int> near(1, int(b));
		for (int end : {branches[b].first(), branches[b].last()})
			near.insert(near.end(), atNode[end].begin(), atNode[end].end());
		std::sort(near.begin(), near.end());
		near.erase(std::unique(near.begin(), near.end()), near.end());
		for (int other : near)
			for (size_t i = 1; i < branches[other].nodes.size(); ++i)
				edges[b].push_back({branches[other].nodes[i - 1], branches[other].nodes[i]});
	}
	return edges;
}

} // namespace detail

/**
 * Gives every face of a surface the branch of the skeleton that it belongs to.
 *
 * A vertex starts with the branch that it has merged into; one that merged into a junction takes
 * the nearest. Then the borders are shortened: indicator functions of the parts are diffused for a
 * moment and each vertex takes the largest, several times, which moves the borders by their
 * geodesic curvature and so makes them smooth. Every part is connected over edges; no face has two
 * neighbours of one other part.
 *
 * A branch into which less than a face of the surface has merged, as a short one between two
 * junctions, has no part.
 *
 * @param surface   compact.
 * @param skeleton  its `node` has an entry for each vertex of `surface`; -1 where it is not known.
 * @throws InvalidInput if the correspondence does not fit; Cancelled.
 * Complexity: O(V log V + V E), E the edges of a branch and of all that meet it.
 * Source: ours. Diffusing and comparing is due to Merriman, Bence and Osher, "Diffusion generated
 *         motion by mean curvature", 1992.
 */
inline SurfaceParts surfaceParts(const SurfaceMesh& surface, const CurveSkeleton& skeleton,
	const Progress& progress = Progress())
{
	const int n = surface.vertexSlots();
	if (int(skeleton.node.size()) != n)
		throw InvalidInput("The skeleton's correspondence is for a surface of "
			+ std::to_string(skeleton.node.size()) + " vertices, this one has " + std::to_string(n)
			+ ": choose the surface that it was made from.");
	for (int v : skeleton.node)
		if (v >= int(skeleton.position.size()))
			throw InvalidInput("The skeleton's correspondence names nodes that it does not have.");
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	const std::vector<int> branchOfNode = detail::branchOfNodes(skeleton, branches);
	std::vector<int> label = detail::filledArray(size_t(n), -1, progress);
	detail::cancellableLoop(n, progress, [&](int v) {
		if (skeleton.node[v] >= 0)
			label[v] = branchOfNode[skeleton.node[v]];
	});

	detail::PartLabels labels(
		surface, std::move(label), int(branches.size()), progress.part(0, 0.05));
	labels.connect(progress.part(0.05, 0.15));
	labels.smooth(progress.part(0.15, 0.5));
	labels.connect(progress.part(0.5, 0.6));
	SurfaceParts parts;
	parts.ofFace = labels.ofFaces(progress.part(0.6, 0.7));

	const auto edges = detail::edgesAround(skeleton, branches);
	parts.distance = detail::filledArray(size_t(n), 0.0, progress);
	if (skeleton.position.empty())
		return parts;
	const ClosestCurve curve(skeleton);
	const auto measure = [&](int begin, int end) {
		for (int v = begin; v < end; ++v) {
			const Point3d& p = surface.position[v];
			const int b = labels.ofVertex(v);
			double best = std::numeric_limits<double>::infinity();
			if (b >= 0)
				for (const auto& [from, to] : edges[b])
					best = std::min(best,
						SquaredDistance(p,
							closestOnSegment(skeleton.position[from], skeleton.position[to], p)
								.point));
			parts.distance[v] = b >= 0 ? std::sqrt(best) : curve.closest(p).distance;
		}
	};
	forEachBlock(n, progress.part(0.7, 1), "Measuring the thickness", measure);
	return parts;
}

} // namespace vcg::tri::mcf

#endif
