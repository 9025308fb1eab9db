// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Skin weights of a surface's vertices: the nodes' weights, diffused over the surface.

#ifndef VCG_MCF_SKIN_WEIGHTS_H
#define VCG_MCF_SKIN_WEIGHTS_H

#include "armature.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/input/coincident_points.h>
#include <skeleton/spatial/point_tree.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The triangle mesh that an armature moves.
struct SkinnedSurface
{
	std::vector<Point3d> position;
	std::vector<std::array<int, 3>> faces;
};

/// Up to four bones that a vertex follows, and their weights; unused entries are 0.
struct VertexShares
{
	std::array<int, 4> bone {};
	std::array<double, 4> weight {};
};

namespace detail {

/// The system of skinWeights(), (L + D) w = D p: an M-matrix whose rows add up to D.
struct SkinSystem
{
	Eigen::SparseMatrix<double> matrix;
	/// D: a vertex's area over the square of its reach.
	std::vector<double> pull;
};

/**
 * @param at    for each vertex the first one at the same place; only these are coupled.
 * @param reach mesh units, above 0.
 * Complexity: O(F log F).
 */
inline SkinSystem skinSystem(
	const SkinnedSurface& surface, const std::vector<int>& at, const std::vector<double>& reach)
{
	constexpr double minWeight = 1e-3, largestCotangent = 100, minPull = 1e-9;
	const int n = int(surface.position.size());
	SkinSystem system;
	system.pull.assign(size_t(n), 0);
	std::vector<Eigen::Triplet<double>> halves;
	halves.reserve(3 * surface.faces.size());
	for (const std::array<int, 3>& face : surface.faces) {
		std::array<int, 3> corner;
		std::array<Point3d, 3> p;
		for (size_t k = 0; k < 3; ++k) {
			corner[k] = at[size_t(face[k])];
			p[k] = surface.position[size_t(corner[k])];
		}
		const double doubleArea = ((p[1] - p[0]) ^ (p[2] - p[0])).Norm();
		if (!std::isfinite(doubleArea))
			continue;
		for (size_t k = 0; k < 3; ++k) {
			const size_t l = (k + 1) % 3, m = (k + 2) % 3;
			const double dot = (p[k] - p[m]) * (p[l] - p[m]);
			const double cotangent = std::abs(dot) < largestCotangent * doubleArea
				? dot / doubleArea
				: std::copysign(largestCotangent, dot);
			const int a = corner[k], b = corner[l];
			const double r = reach[size_t(a)];
			system.pull[size_t(a)] += doubleArea / 6 / (r * r);
			if (a != b)
				halves.push_back({std::max(a, b), std::min(a, b), cotangent / 2});
		}
	}
	Eigen::SparseMatrix<double> weights(n, n);
	weights.setFromTriplets(halves.begin(), halves.end());
	std::vector<double> sum(size_t(n), 0);
	for (int v = 0; v < n; ++v)
		for (Eigen::SparseMatrix<double>::InnerIterator e(weights, v); e; ++e) {
			e.valueRef() = -std::max(e.value(), minWeight);
			sum[size_t(v)] -= e.value();
			sum[size_t(e.row())] -= e.value();
		}
	Eigen::SparseMatrix<double> diagonal(n, n);
	diagonal.reserve(Eigen::VectorXi::Constant(n, 1));
	for (int v = 0; v < n; ++v) {
		double& pull = system.pull[size_t(v)];
		pull = sum[size_t(v)] > 0 ? std::max(pull, minPull * sum[size_t(v)]) : 1;
		diagonal.insert(v, v) = sum[size_t(v)] + pull;
	}
	system.matrix = weights + diagonal;
	return system;
}

/// Subtracts the fifth of five weights, largest first, from the other four, so that these stay
/// continuous where one gives way to another, and makes them add up to 1.
inline VertexShares fourOfFive(std::array<double, 5> weight, const std::array<int, 5>& bone)
{
	constexpr double negligible = 0.01; // subtracted at least: far vertices do not follow
	constexpr double minSum = 1e-3;     // five nearly alike: the first four stay
	const double fifth = std::max(weight[4], negligible);
	if (weight[0] + weight[1] + weight[2] + weight[3] > 4 * fifth + minSum)
		for (double& w : weight)
			w = std::max(w - fifth, 0.0);
	const double sum = weight[0] + weight[1] + weight[2] + weight[3];
	VertexShares shares;
	for (size_t k = 0; k < 4; ++k)
		if (weight[k] > 0) {
			shares.bone[k] = bone[k];
			shares.weight[k] = weight[k] / sum;
		}
	return shares;
}

} // namespace detail

/**
 * The weights of a surface's vertices, smooth over the surface wherever the correspondence is not:
 * across junctions, where neighbours belong to different limbs, and where a cycle was cut.
 *
 * The weights w of a vertex are drawn to the weights p of its node and to those of its neighbours:
 * for each bone (L + D) w = D p, with the cotangent Laplacian L (L x = sum w_ij (x_i - x_j), w_ij
 * at least 1e-3) and D the vertices' areas over the squares of their distances from their nodes. A
 * jump of p is spread over about that distance. It is the bone heat of Baran and Popovic
 * ("Automatic Rigging and Animation of 3D Characters", ACM Trans. Graph. 26(3), 2007), with the
 * correspondence in place of the nearest visible bone. Vertices at the same place get the same
 * weights. Weights are at least 0 and add up to 1; the four largest stay.
 * @param skeleton its `node` is for each vertex of the surface its node; -1: the nearest one.
 * @pre the skeleton has nodes, and `armature` was made from it.
 * @throws SolverError; Cancelled
 * Complexity: one sparse factorisation, which takes longest and cannot be cancelled; a solution
 * with its factors for each bone; O(log nodes) for each vertex without a node.
 */
inline std::vector<VertexShares> skinWeights(const SkinnedSurface& surface,
	const CurveSkeleton& skeleton, const Armature& armature, const Progress& progress = Progress())
{
	const char* const what = "Skin weights";
	const size_t n = surface.position.size();
	const std::vector<int> at =
		detail::firstCoincident(surface.position, progress.part(0, 0.03), what);
	std::optional<PointTree> nodes; // where a vertex has none
	if (std::any_of(skeleton.node.begin(), skeleton.node.end(), [](int node) { return node < 0; }))
		nodes.emplace(skeleton.position, progress.cancelOnly());
	std::vector<int> node(n);
	std::vector<double> reach(n);
	double longest = 0;
	detail::reportedLoop(int(n), progress.part(0.03, 0.1), what, [&](int i) {
		const size_t v = size_t(i);
		if (at[v] != i)
			return;
		const Point3d& p = surface.position[v];
		node[v] = skeleton.node[v];
		if (node[v] < 0)
			node[v] = std::max(nodes->nearest(p), 0); // none is nearest to what is not finite
		reach[v] = Distance(p, skeleton.position[size_t(node[v])]);
		if (std::isfinite(reach[v]))
			longest = std::max(longest, reach[v]);
	});
	for (double& r : reach)
		r = std::isfinite(r) && longest > 0 ? std::max(r, 1e-6 * longest) : 1;
	const detail::SkinSystem system = detail::skinSystem(surface, at, reach);
	progress.report(0.15, what);
	const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system.matrix);
	if (factor.info() != Eigen::Success)
		throw SolverError("The weights of the armature could not be computed.");
	progress.report(0.8, what);
	std::vector<std::vector<int>> drawn(armature.bones.size()); // the vertices that a bone draws
	for (size_t v = 0; v < n; ++v)
		if (at[v] == int(v))
			for (const auto& [bone, weight] : armature.weights[size_t(node[v])])
				drawn[size_t(bone)].push_back(int(v));
	std::vector<std::array<double, 5>> largest(n, {0, 0, 0, 0, 0});
	std::vector<std::array<int, 5>> bones(n, {0, 0, 0, 0, 0});
	const double all = double(armature.bones.size());
	for (size_t b = 0; b < armature.bones.size(); ++b) {
		progress.report(0.8 + 0.2 * double(b) / all, what);
		Eigen::VectorXd right = Eigen::VectorXd::Zero(Eigen::Index(n));
		for (int v : drawn[b])
			for (const auto& [bone, weight] : armature.weights[size_t(node[size_t(v)])])
				if (bone == int(b))
					right[v] = system.pull[size_t(v)] * weight;
		const Eigen::VectorXd ofBone = factor.solve(right);
		for (size_t v = 0; v < n; ++v) {
			double weight = ofBone[Eigen::Index(v)];
			int bone = int(b);
			for (size_t k = 0; k < 5; ++k)
				if (weight > largest[v][k]) {
					std::swap(weight, largest[v][k]);
					std::swap(bone, bones[v][k]);
				}
		}
	}
	std::vector<VertexShares> shares;
	shares.reserve(n);
	for (size_t v = 0; v < n; ++v)
		shares.push_back(detail::fourOfFive(largest[size_t(at[v])], bones[size_t(at[v])]));
	return shares;
}

} // namespace vcg::tri::mcf

#endif
