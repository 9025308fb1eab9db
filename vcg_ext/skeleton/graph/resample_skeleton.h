// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Resampling a skeleton with even edges, and smoothing it. Ends, junctions and cycles stay.

#ifndef VCG_MCF_RESAMPLE_SKELETON_H
#define VCG_MCF_RESAMPLE_SKELETON_H

#include "branch_table.h"
#include "curve_skeleton.h"
#include "skeleton_branches.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/progress.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// A branch as a line of points with radii; on a cycle the last point is the first again.
struct SampledBranch
{
	std::vector<Point3d> points;
	std::vector<double> radii;
	bool isFreeCycle = false;

	int segments() const { return int(points.size()) - 1; }

	/// Length of the line up to each point.
	std::vector<double> along() const
	{
		std::vector<double> sum(points.size(), 0);
		for (size_t i = 1; i < points.size(); ++i)
			sum[i] = sum[i - 1] + Distance(points[i - 1], points[i]);
		return sum;
	}

	/// The point that is nearer to p than its neighbours, found by descent from point k.
	int nearestFrom(int k, const Point3d& p) const
	{
		const auto distance = [&](int i) { return SquaredDistance(points[i], p); };
		while (k < segments() && distance(k + 1) < distance(k))
			++k;
		while (k > 0 && distance(k - 1) < distance(k))
			--k;
		return k;
	}

	/// The points at the given lengths along the line, ascending; radii are interpolated.
	SampledBranch at(const std::vector<double>& places) const
	{
		const std::vector<double> length = along();
		SampledBranch sampled = {{}, {}, isFreeCycle};
		size_t i = 1;
		for (double s : places) {
			while (i + 1 < length.size() && length[i] < s)
				++i;
			const double edge = length[i] - length[i - 1];
			const double t = edge > 0 ? (s - length[i - 1]) / edge : 0;
			sampled.points.push_back(points[i - 1] + (points[i] - points[i - 1]) * t);
			sampled.radii.push_back(radii[i - 1] + (radii[i] - radii[i - 1]) * t);
		}
		sampled.points.front() = points.front();
		sampled.points.back() = points.back();
		return sampled;
	}

	/// The same line in `count` steps of about equal length, which cut its corners.
	SampledBranch inSteps(int count) const
	{
		constexpr int rounds = 10;
		const double whole = along().back();
		std::vector<double> places(count + 1);
		for (int k = 0; k <= count; ++k)
			places[k] = whole * k / count;
		for (int round = 0; round < rounds; ++round) {
			const std::vector<double> chords = at(places).along();
			const std::vector<double> before = places;
			int i = 1;
			for (int k = 1; k < count; ++k) {
				const double s = chords.back() * k / count;
				while (i < count && chords[i] < s)
					++i;
				const double chord = chords[i] - chords[i - 1];
				const double t = chord > 0 ? (s - chords[i - 1]) / chord : 0;
				places[k] = before[i - 1] + (before[i] - before[i - 1]) * t;
			}
		}
		return at(places);
	}

	/// The same with the fewest steps of which none is longer than `longest`, at least `minimum`.
	SampledBranch evenly(double longest, int minimum) const
	{
		constexpr double rounding = 1e-12;
		const double steps = std::ceil(along().back() / longest * (1 - rounding));
		return inSteps(std::max(minimum, int(steps)));
	}
};

/**
 * Minimises, with the ends fixed,
 *     sum_i |x_i - y_i|^2 + (l / h)^4 sum_i |x_(i-1) - 2 x_i + x_(i+1)|^2,
 * the smoothing spline of the points y_i at distances h. Waves along the line that are shorter than
 * 2 pi l are flattened, longer ones stay. No point leaves the line's bounding box.
 */
inline void smoothSpline(SampledBranch& branch, double l)
{
	const int n = branch.segments();
	const double h = branch.along().back() / n;
	if (!(h > 0))
		return;
	// Above this ratio the line is flat anyway, and the system cannot be solved.
	constexpr double maxRatio = 1e3;
	const double weight = std::pow(std::min(l / h, maxRatio), 4);
	// On a free cycle all points move; else those between the ends.
	const bool cycle = branch.isFreeCycle;
	const int unknowns = cycle ? n : n - 1;
	if (unknowns < 1)
		return;
	const auto unknown = [&](int i) { return cycle ? (i + n) % n : i == 0 || i == n ? -1 : i - 1; };
	const auto point = [&](int i) { return branch.points[cycle ? (i + n) % n : i]; };
	std::vector<Eigen::Triplet<double>> entries;
	Eigen::MatrixX3d right(unknowns, 3);
	for (int i = cycle ? 0 : 1; i < n; ++i) {
		entries.emplace_back(unknown(i), unknown(i), 1);
		right.row(unknown(i)) << point(i)[0], point(i)[1], point(i)[2];
	}
	const double stencil[3] = {1, -2, 1};
	for (int i = cycle ? 0 : 1; i < n; ++i)
		for (int j = -1; j <= 1; ++j) {
			const int row = unknown(i + j);
			if (row < 0)
				continue;
			for (int k = -1; k <= 1; ++k) {
				const double entry = weight * stencil[j + 1] * stencil[k + 1];
				const int column = unknown(i + k);
				if (column >= 0)
					entries.emplace_back(row, column, entry);
				else
					for (int axis = 0; axis < 3; ++axis)
						right(row, axis) -= entry * point(i + k)[axis];
			}
		}
	Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
	matrix.setFromTriplets(entries.begin(), entries.end());
	const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
	if (factor.info() != Eigen::Success)
		throw SolverError("The skeleton could not be smoothed: choose a smaller smoothing length.");
	const Eigen::MatrixX3d x = factor.solve(right);
	Box3d box; // of the line: a spline overshoots it where the line turns sharply
	for (const Point3d& p : branch.points)
		box.Add(p);
	for (int i = cycle ? 0 : 1; i < n; ++i)
		for (int axis = 0; axis < 3; ++axis)
			branch.points[i][axis] = std::clamp(x(unknown(i), axis), box.min[axis], box.max[axis]);
	if (cycle)
		branch.points[n] = branch.points[0];
}

} // namespace detail

/**
 * Samples each branch of a skeleton evenly, with edges up to `longestEdge`, and smooths it.
 *
 * Ends and junctions keep their places, the graph keeps its branches and cycles. What had merged
 * into a node goes to the node nearest along the branch. New nodes have the significance of their
 * branch, see BranchRecord; marks of bridges are lost.
 *
 * @param skeleton     its radii are interpolated along the edges.
 * @param longestEdge  mesh units, > 0; 0.1 % of the bounding box diagonal in the paper's Table 1.
 * @param smoothing    the length l of a smoothing spline, mesh units, >= 0; 0: no smoothing. Waves
 *                     shorter than 2 pi l are flattened, which may move the curve out of the shape.
 * @throws InvalidParameter if a parameter is out of its range or would give more than 10 million
 *         nodes; SolverError, Cancelled.
 * Complexity: O(V + length / longestEdge).
 * Source: ours; smoothing splines after Reinsch, Numerische Mathematik 10, 1967.
 */
inline CurveSkeleton resampledSkeleton(const CurveSkeleton& skeleton, double longestEdge,
	double smoothing = 0, const Progress& progress = Progress())
{
	using detail::SampledBranch;
	constexpr double maxNodes = 1e7;
	const char* what = "Resampling the skeleton";
	requireParameter(
		longestEdge > 0 && std::isfinite(longestEdge), "longest_edge", "greater than 0");
	requireParameter(smoothing >= 0 && std::isfinite(smoothing), "smoothing", "at least 0");
	const std::vector<std::vector<int>> neighbours = skeleton.neighbours();
	const std::vector<Branch> branches = skeletonBranches(skeleton);
	const std::vector<BranchRecord> table = branchTable(skeleton, branches);
	const FewestEdges fewest(branches);
	double length = 0;
	for (const Branch& branch : branches)
		length += branchLength(skeleton, branch);
	// Smoothing needs points closer to each other than the length of the waves to flatten.
	const double spacing = smoothing > 0 ? std::min(longestEdge, smoothing) : longestEdge;
	if (length / spacing > maxNodes)
		throw InvalidParameter("Edges as short as this would make "
			+ detail::countText(length / spacing)
			+ " nodes; choose a longest_edge and a smoothing of at least "
			+ detail::lowerBoundText(length / maxNodes) + " mesh units.");

	CurveSkeleton result;
	const bool knowsSignificance = !skeleton.significance.empty();
	std::vector<int> place(skeleton.position.size(), -1);
	const auto keep = [&](int v) {
		if (place[v] < 0) {
			place[v] = int(result.position.size());
			result.position.push_back(skeleton.position[v]);
			result.radius.push_back(skeleton.radius[v]);
			if (knowsSignificance)
				result.significance.push_back(skeleton.significance[v]);
		}
	};
	for (size_t v = 0; v < place.size(); ++v)
		if (neighbours[v].size() != 2)
			keep(int(v));
	for (size_t b = 0; b < branches.size(); ++b) {
		progress.report(double(b) / double(branches.size()), what);
		const Branch& branch = branches[b];
		const bool freeCycle = branch.isClosed() && neighbours[branch.first()].size() == 2;
		const int minimum = fewest.of(branch);
		SampledBranch old;
		old.isFreeCycle = freeCycle;
		for (int v : branch.nodes) {
			old.points.push_back(skeleton.position[v]);
			old.radii.push_back(skeleton.radius[v]);
		}
		SampledBranch line = old;
		if (smoothing > 0) {
			line = old.evenly(spacing, minimum);
			detail::smoothSpline(line, smoothing);
			// Only rounding makes a line longer: coordinates are as coarse as the line is long.
			if (line.along().back() > 2 * old.along().back())
				throw SolverError(
					"The skeleton could not be smoothed: it is too small for its distance from the "
					"origin. Move it there first.");
		}
		line = line.evenly(longestEdge, minimum);

		keep(branch.first()); // new only on a free cycle
		if (freeCycle)
			result.position[place[branch.first()]] = line.points.front();
		std::vector<int> ids(1, place[branch.first()]);
		for (int k = 1; k < line.segments(); ++k) {
			ids.push_back(int(result.position.size()));
			result.position.push_back(line.points[k]);
			result.radius.push_back(line.radii[k]);
			if (knowsSignificance)
				result.significance.push_back(table[b].significance);
		}
		ids.push_back(place[branch.last()]);
		for (size_t k = 1; k < ids.size(); ++k)
			result.edges.push_back({std::min(ids[k - 1], ids[k]), std::max(ids[k - 1], ids[k])});
		const std::vector<double> along = old.along();
		for (size_t i = 1; i + 1 < branch.nodes.size(); ++i) {
			const double part = along.back() > 0 ? along[i] / along.back() : 0;
			const int guess = int(std::lround(part * line.segments()));
			place[branch.nodes[i]] = ids[line.nearestFrom(guess, old.points[i])];
		}
	}
	std::sort(result.edges.begin(), result.edges.end());
	result.node.reserve(skeleton.node.size());
	for (int v : skeleton.node)
		result.node.push_back(v < 0 ? -1 : place[v]);
	progress.report(1, what);
	return result;
}

} // namespace vcg::tri::mcf

#endif
