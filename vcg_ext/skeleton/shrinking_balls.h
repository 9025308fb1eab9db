// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Medial poles by maximal balls that touch the surface from inside (Ma, Bae and Choi, "3D medial
/// axis point approximation using nearest neighbors and the normal field", The Visual Computer 28, 2012).

#ifndef VCG_MCF_SHRINKING_BALLS_H
#define VCG_MCF_SHRINKING_BALLS_H

#include "point_tree.h"
#include "pole_set.h"
#include "progress.h"
#include "surface_mesh.h"

#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * The largest ball through p, on the inner side of its normal, with no sample deeper inside than delta.
 *
 * The ball of radius r has its centre at c = p - r n. A sample q, with e = p - q, lies exactly
 * delta deep where |c - q| = r - delta, that is at
 *     r(q) = (|e|^2 - delta^2) / (2 (e.n - delta)),   e.n > delta,
 * and the balls grow monotonically with r, so the answer is the least r(q) over all q. It does
 * not depend on the order of the visits, to the last bit: the tests that skip a sample leave room
 * for rounding, and what they let through is compared by r(q) itself.
 */
class MaximalBall
{
public:
	MaximalBall(const Point3d& p, const Point3d& n, double delta, double largest) :
			p(p), n(n), delta(delta)
	{
		shrinkTo(largest);
	}

	double radius() const { return r; }
	Point3d centre() const { return c; }
	int contact() const { return contactSlot; }

	double reach(const PointTree::Box& box) const
	{
		const double d2 = box.squaredDistance(c);
		return d2 <= limit ? d2 : -1;
	}

	void visit(int slot, const Point3d& q)
	{
		const Point3d e = p - q;
		const double depth = e * n - delta;
		const double span = e.SquaredNorm() - delta * delta;
		if (!(depth > 0) || span > 2 * r * depth * (1 + Rounding))
			return;
		const double rq = span / (2 * depth);
		if (rq < r) {
			shrinkTo(rq);
			contactSlot = slot;
		}
	}

private:
	static constexpr double Rounding = 1e-12;

	Point3d p, n, c;
	double delta, r, limit;
	int contactSlot = -1;

	void shrinkTo(double radius)
	{
		r = radius;
		c = p - n * r;
		const double inner = std::max(r - delta, 0.0);
		limit = inner * inner * (1 + Rounding) + Rounding * r * r;
	}
};

} // namespace detail

/**
 * Maximal inner balls of oriented points against a set of samples of the same surface.
 *
 * @param points   where the balls touch, #P, mesh units; normals their outward unit normals, #P.
 * @param against  the samples that bound the balls, #Q; `points` need not be among them.
 * @param delta    how deep a sample may lie inside a ball, mesh units, >= 0: the tolerance to noise.
 * @return poles, #P; radius -1 for a zero normal and for a ball that nothing bounds.
 * @throws Cancelled
 * Complexity: O((P + Q) log Q) for samples of a surface. Same bits on any number of threads.
 */
inline PoleSet shrinkingBalls(const std::vector<Point3d>& points, const std::vector<Point3d>& normals,
	const std::vector<Point3d>& against, double delta, const Progress& progress)
{
	const char* what = "Poles: shrinking balls";
	progress.report(0, what);
	const int count = int(points.size());
	PoleSet poles;
	poles.centre.assign(count, Point3d(0, 0, 0));
	poles.radius.assign(count, -1);
	Box3d box;
	for (const Point3d& q : against)
		box.Add(q);
	if (count == 0 || against.empty())
		return poles;
	// Relative to the middle of the samples the squares keep their digits, however far away the mesh is.
	const Point3d origin = box.Center();
	std::vector<Point3d> samples(against);
	for (Point3d& q : samples)
		q -= origin;
	const PointTree tree(samples);
	const double largest = box.Diag();
	// Coincident samples, and steps of rounding in flat regions, are no contacts.
	const double tolerance = std::max(delta, 1e-9 * largest);
	const std::vector<int> order = points.size() == against.size() ? tree.order() : PointTree(points).order();

	constexpr int BlockSize = 64, BlocksPerReport = 128;
	const int blocks = (count + BlockSize - 1) / BlockSize;
	for (int first = 0; first < blocks; first += BlocksPerReport) {
		const int last = std::min(first + BlocksPerReport, blocks);
#pragma omp parallel for schedule(dynamic)
		for (int block = first; block < last; ++block) {
			// What held the balls of the last points will nearly hold the next one.
			std::array<int, 4> recent = {-1, -1, -1, -1};
			int oldest = 0;
			for (int i = block * BlockSize; i < std::min((block + 1) * BlockSize, count); ++i) {
				const int v = order[i];
				const Point3d& n = normals[v];
				if (!(n.SquaredNorm() > 0))
					continue;
				detail::MaximalBall ball(points[v] - origin, n, tolerance, largest);
				for (int slot : recent)
					if (slot >= 0)
						ball.visit(slot, tree.point(slot));
				tree.search(ball);
				if (ball.contact() < 0)
					continue;
				poles.centre[v] = ball.centre() + origin;
				poles.radius[v] = ball.radius();
				recent[oldest] = ball.contact();
				oldest = (oldest + 1) % 4;
			}
		}
		progress.report(double(last) / blocks, what);
	}
	return poles;
}

/**
 * The inner medial pole of each vertex by shrinking balls against all vertices.
 * @pre mesh is compact.
 * @return poles, #V; radius -1 where the normal is not defined or nothing bounds the ball.
 * @throws Cancelled
 * Complexity: O(V log V).
 */
inline PoleSet shrinkingBallPoles(const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	return shrinkingBalls(mesh.position, mesh.vertexNormals(), mesh.position, 0, progress);
}

} // namespace vcg::tri::mcf

#endif
