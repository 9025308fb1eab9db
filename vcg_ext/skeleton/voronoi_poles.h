// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Medial poles from the Voronoi diagram of the vertices (Sec. 4.5; Amenta and Bern, "Surface
/// reconstruction by Voronoi filtering", 1999). The only file that sees Qhull.

#ifndef VCG_MCF_VORONOI_POLES_H
#define VCG_MCF_VORONOI_POLES_H

#include "errors.h"
#include "point_tree.h"
#include "pole_set.h"
#include "progress.h"
#include "surface_mesh.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// A Delaunay cell: its circumcentre, which is a Voronoi vertex, and the samples on its sphere.
struct DelaunayCell
{
	Point3d centre;
	std::vector<int> samples;
};

/// Qhull's state; frees its memory, also when an exception passes.
class QhullRun
{
public:
	QhullRun() { qh_zero(&state, nullptr); }
	QhullRun(const QhullRun&) = delete;
	QhullRun& operator=(const QhullRun&) = delete;
	~QhullRun()
	{
		state.NOerrexit = True; // nothing to jump back to
		qh_freeqhull(&state, !qh_ALL);
		int memory, blocks;
		qh_memfreeshort(&state, &memory, &blocks);
	}

	qhT* get() { return &state; }

private:
	qhT state;
};

/**
 * The Delaunay cells of the points and of the corners of a cube around them, which bound the cells
 * of the outermost points and give cospherical points (a sphere's) a fourth dimension.
 * Cells that touch a corner of the cube are left out.
 * @pre the points lie within a distance of 1 of the origin.
 * @throws SolverError with Qhull's own words.
 */
inline std::vector<DelaunayCell> delaunayCells(const std::vector<Point3d>& points, const char* command)
{
	const int count = int(points.size());
	std::vector<coordT> coordinates;
	coordinates.reserve(3 * (points.size() + 8));
	for (const Point3d& p : points)
		coordinates.insert(coordinates.end(), {p[0], p[1], p[2]});
	for (int corner = 0; corner < 8; ++corner)
		for (int k = 0; k < 3; ++k)
			coordinates.push_back(corner >> k & 1 ? 1.5 : -1.5);
	// Qhull only writes to C files; a library must not write to the terminal.
	const std::unique_ptr<FILE, int (*)(FILE*)> log(std::tmpfile(), std::fclose);
	if (!log)
		throw SolverError("The Voronoi diagram needs a temporary file for Qhull's messages and got none.");
	QhullRun run;
	qhT* qh = run.get();
	std::string mutableCommand(command);
	const int status = qh_new_qhull(
		qh, 3, count + 8, coordinates.data(), False, mutableCommand.data(), nullptr, log.get());
	if (status != 0) {
		std::string message(400, '\0');
		std::rewind(log.get());
		message.resize(std::fread(message.data(), 1, message.size(), log.get()));
		throw SolverError("Qhull could not compute the Voronoi diagram (code " + std::to_string(status) +
			"): " + message);
	}
	std::vector<DelaunayCell> cells;
	facetT* facet;
	vertexT *vertex, **vertexp;
	FORALLfacets {
		if (facet->upperdelaunay)
			continue;
		DelaunayCell cell;
		bool bounded = true;
		FOREACHvertex_(facet->vertices) {
			const int id = qh_pointid(qh, vertex->point);
			bounded = bounded && id < count;
			cell.samples.push_back(id);
		}
		if (!bounded)
			continue;
		// The facet is the hyperplane n.(x, |x|^2) + o = 0 of the lifted points: a sphere about -n / (2 n3).
		const coordT* n = facet->normal;
		cell.centre = Point3d(n[0], n[1], n[2]) * (-0.5 / n[3]);
		cells.push_back(std::move(cell));
	}
	return cells;
}

/// The nearest sample to a fixed centre.
class NearestSample
{
public:
	explicit NearestSample(const Point3d& centre) : centre(centre) {}

	double squaredDistance() const { return best; }

	double reach(const PointTree::Box& box) const
	{
		const double d2 = box.squaredDistance(centre);
		return d2 < best ? d2 : -1;
	}

	void visit(int, const Point3d& q) { best = std::min(best, SquaredDistance(centre, q)); }

private:
	Point3d centre;
	double best = std::numeric_limits<double>::infinity();
};

/**
 * Whether a cell's sphere is what it claims to be: through its samples, empty, and inside the shape.
 * Nearly co-circular neighbourhoods yield centres up to 1e16 diagonals away, and the space around the
 * shape has cells as well; in both the surface does not face away from the centre all round.
 */
inline bool isInnerCell(const DelaunayCell& cell, const std::vector<Point3d>& samples,
	const std::vector<Point3d>& normals, const PointTree& tree)
{
	constexpr double Tolerance = 1e-6; // of the diagonal
	const double radius = Distance(cell.centre, samples[cell.samples[0]]);
	if (!(radius < 1))
		return false;
	for (int q : cell.samples) {
		const Point3d spoke = samples[q] - cell.centre;
		if (std::abs(spoke.Norm() - radius) > Tolerance || spoke * normals[q] < 0)
			return false;
	}
	NearestSample nearest(cell.centre);
	tree.search(nearest);
	return std::sqrt(nearest.squaredDistance()) > radius - Tolerance;
}

} // namespace detail

/**
 * The inner Voronoi pole of each vertex: the farthest Voronoi vertex of its cell on the inner side.
 *
 * A Voronoi vertex counts if its ball is empty, touches its samples and lies inside the shape; the
 * pole is the farthest that does, so one bad vertex costs its cell no more than the next best.
 * @pre mesh is compact.
 * @return poles, #V; radius -1 where no Voronoi vertex of the cell counts.
 * @throws SolverError, Cancelled (before, after, but not while Qhull runs: it cannot be stopped).
 * Complexity: O(V log V) for samples of a surface.
 */
inline PoleSet voronoiPoles(const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	const char* what = "Poles: Voronoi diagram";
	progress.report(0, what);
	const int count = mesh.vertexSlots();
	PoleSet poles;
	poles.centre.assign(count, Point3d(0, 0, 0));
	poles.radius.assign(count, -1);
	const Box3d box = mesh.bounds();
	if (count < 4 || !(box.Diag() > 0))
		return poles;
	const Point3d origin = box.Center();
	const double scale = box.Diag();
	std::vector<Point3d> samples(mesh.position);
	for (Point3d& q : samples)
		q = (q - origin) / scale;
	const std::vector<Point3d> normals = mesh.vertexNormals();
	const PointTree tree(samples);
	const std::vector<detail::DelaunayCell> cells = detail::delaunayCells(samples, "qhull d Q12");
	progress.report(0.9, what);
	for (size_t i = 0; i < cells.size(); ++i) {
		if (i % 65536 == 0)
			progress.report(0.9 + 0.1 * double(i) / double(cells.size()), what);
		const detail::DelaunayCell& cell = cells[i];
		if (!detail::isInnerCell(cell, samples, normals, tree))
			continue;
		const Point3d centre = origin + cell.centre * scale;
		for (int v : cell.samples) {
			const double radius = Distance(centre, mesh.position[v]);
			if (normals[v].SquaredNorm() > 0 && radius > poles.radius[v]) {
				poles.centre[v] = centre;
				poles.radius[v] = radius;
			}
		}
	}
	progress.report(1, what);
	return poles;
}

} // namespace vcg::tri::mcf

#endif
