// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Local classification of sheet against curve from medial balls.

#ifndef VCG_MCF_SHEETNESS_H
#define VCG_MCF_SHEETNESS_H

#include <skeleton/poles/by_component.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/mesh/marked_regions.h>
#include <skeleton/core/parallel.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/poles/pole_set.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Sums d d^T over the directions d from a centre to the samples around it.
struct ContactDirections
{
	const std::vector<double>& weight;
	const std::vector<int>& order;
	Point3d middle;
	double radius;
	Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();

	const Point3d& centre() const { return middle; }
	double reach() const { return radius; }
	void visit(int slot, const Point3d& p)
	{
		const Point3d d = p - middle;
		const double squared = d.SquaredNorm();
		if (squared > radius * radius || !(squared > 0))
			return;
		const Eigen::Vector3d e(d[0], d[1], d[2]);
		sum += (weight[size_t(order[slot])] / squared) * (e * e.transpose());
	}
};

/// sheetness() of a mesh of one component.
inline std::vector<double> sheetnessOfComponent(
	const SurfaceMesh& mesh, const PoleSet& poles, const Progress& progress)
{
	constexpr double nearly = 1.15;
	constexpr int rounds = 3;
	// Large balls touch many vertices: an eighth of them is enough.
	constexpr double large = 0.03; // of the diagonal
	constexpr int stride = 8;
	const char* const what = "Looking for sheets";
	const Progress begin = progress.cancelOnly();
	const std::vector<double> area = vertexAreas(mesh, begin);
	const PointTree tree(mesh.position, progress.part(0, 0.2));
	std::vector<Point3d> fewPoints;
	std::vector<double> fewAreas;
	for (int i = 0; i < tree.size(); i += stride) {
		fewPoints.push_back(mesh.position[tree.order()[i]]);
		fewAreas.push_back(area[tree.order()[i]]);
	}
	const Progress searching = progress.part(0.2, 0.9);
	const PointTree fewTree(fewPoints, searching.cancelOnly());
	const double limit = large * mesh.bounds(searching).Diag();

	std::vector<double> s = detail::filledArray(area.size(), -1.0, searching);
	forEachBlock(mesh.vertexSlots(), searching, what, [&](int begin, int end) {
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
		for (int v = begin; v < end; ++v) {
			if (!poles.has(v))
				continue;
			const bool few = poles.radius[v] > limit;
			const PointTree& around = few ? fewTree : tree;
			detail::ContactDirections contacts {
				few ? fewAreas : area, around.order(), poles.centre[v], nearly * poles.radius[v]};
			around.search(contacts);
			solver.computeDirect(contacts.sum, Eigen::EigenvaluesOnly);
			const Eigen::Vector3d l = solver.eigenvalues(); // ascending
			if (l[2] > 0)
				s[v] = std::clamp(1 - l[1] / l[2], 0.0, 1.0);
		}
	});
	for (int i = 0; i < rounds; ++i) {
		const Progress part = progress.part(0.9 + 0.1 * i / rounds, 0.9 + 0.1 * (i + 1) / rounds);
		const std::vector<double> before = detail::copiedArray(s, part);
		detail::reportedLoop(mesh.vertexSlots(), part, what, [&](int v) {
			double sum = before[v] < 0 ? 0 : before[v];
			int count = before[v] >= 0;
			mesh.forEachOutgoing(v, [&](int h) {
				if (const double t = before[mesh.target(h)]; t >= 0) {
					sum += t;
					++count;
				}
			});
			s[v] = count ? sum / count : -1;
		});
	}
	for (double& value : s)
		value = std::max(value, 0.0);
	return s;
}

} // namespace detail

/**
 * How sheet-like a shape is at each vertex of its surface: 0 where its cross-section is round, 1
 * between parallel walls.
 *
 * At the vertex's pole c of radius r the surface within 1.15 r touches the medial ball, or nearly:
 * two opposite spots in a sheet, a ring in a tube, all around in a ball. With l1 >= l2 >= l3 the
 * eigenvalues of the mean of d d^T over the directions d from c to that part of the surface,
 *
 *     s = 1 - l2 / l1,
 *
 * averaged three times over the neighbours. A round tube has 0.25 or less, an elliptic one with
 * axes 1 : 2 about 0.55, with 1 : 4 about 0.8; between parallel walls it is above 0.9. Each
 * component is treated by itself, as if the others were not there.
 * @param poles  one for each vertex; a vertex without one takes its neighbours' mean.
 * @return s of each vertex, in [0, 1]. @pre mesh is compact.
 * @throws Cancelled. Complexity: O(V k) for k vertices around a ball. The result does not depend on
 * the number of threads.
 */
inline std::vector<double> sheetness(
	const SurfaceMesh& mesh, const PoleSet& poles, const Progress& progress = Progress())
{
	return detail::foundByComponent(mesh, poles, progress, detail::sheetnessOfComponent);
}

} // namespace vcg::tri::mcf

#endif
