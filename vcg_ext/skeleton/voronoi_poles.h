// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Medial poles from the Voronoi diagram of the vertices (Sec. 4.5; Amenta and Bern, "Surface
/// reconstruction by Voronoi filtering", 1999). The only file that sees Qhull.

#ifndef VCG_MCF_VORONOI_POLES_H
#define VCG_MCF_VORONOI_POLES_H

#include "errors.h"
#include "inner_segments.h"
#include "point_tree.h"
#include "pole_set.h"
#include "progress.h"
#include "surface_mesh.h"
#include "unit_frame.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The vertices of a Delaunay tetrahedron.
using Tetrahedron = std::array<int, 4>;

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

/// What Qhull wrote, up to its list of options.
inline std::string firstParagraph(FILE* log)
{
	std::string text(1000, '\0');
	std::rewind(log);
	text.resize(std::fread(text.data(), 1, text.size(), log));
	return text.substr(0, text.find("\n\n"));
}

/**
 * The Delaunay tetrahedra of the points, without those that reach out to a cube put around them.
 *
 * The corners of the cube bound the cells of the outermost points, and lend cospherical points,
 * which a sphere's are, the fourth dimension that the lifted points need. Qhull moves the points a
 * little (QJ): merging the facets of many cospherical points would take a time quadratic in them.
 * @pre the points lie in the cube of half side 1 around the origin, which leaves out NaN: Qhull does
 *      not survive it.
 * @throws SolverError with Qhull's own words.
 */
inline std::vector<Tetrahedron> delaunayTetrahedra(
	const std::vector<Point3d>& points, const char* command = "qhull d QJ")
{
	constexpr double halfSide = 3;
	const int count = int(points.size());
	std::vector<coordT> coordinates;
	coordinates.reserve(3 * (points.size() + 8));
	for (const Point3d& p : points)
		coordinates.insert(coordinates.end(), {p[0], p[1], p[2]});
	for (int corner = 0; corner < 8; ++corner)
		for (int k = 0; k < 3; ++k)
			coordinates.push_back(corner >> k & 1 ? halfSide : -halfSide);
	// Qhull writes to C files only, and a library must not write to its user's terminal.
	const std::unique_ptr<FILE, int (*)(FILE*)> log(std::tmpfile(), std::fclose);
	if (!log)
		throw SolverError(
			"The Voronoi diagram needs a temporary file for Qhull's messages and got none.");
	QhullRun run;
	qhT* qh = run.get();
	std::string mutableCommand(command);
	const int status = qh_new_qhull(
		qh, 3, count + 8, coordinates.data(), False, mutableCommand.data(), nullptr, log.get());
	if (status != 0)
		throw SolverError("Qhull could not compute the Voronoi diagram (code "
			+ std::to_string(status) + "): " + firstParagraph(log.get()));
	std::vector<Tetrahedron> tetrahedra;
	facetT* facet;
	vertexT *vertex, **vertexp;
	FORALLfacets
	{
		if (facet->upperdelaunay)
			continue;
		Tetrahedron tetrahedron;
		size_t corners = 0;
		FOREACHvertex_(facet->vertices)
		{
			const int id = qh_pointid(qh, vertex->point);
			if (id < count && corners < tetrahedron.size())
				tetrahedron[corners++] = id;
		}
		if (corners == tetrahedron.size())
			tetrahedra.push_back(tetrahedron);
	}
	return tetrahedra;
}

/// The point at the same distance from all four corners; not finite for a flat tetrahedron.
inline Point3d circumcentre(const Tetrahedron& t, const std::vector<Point3d>& points)
{
	const Point3d& o = points[t[0]];
	const Point3d a = points[t[1]] - o, b = points[t[2]] - o, c = points[t[3]] - o;
	const Point3d sum =
		(b ^ c) * a.SquaredNorm() + (c ^ a) * b.SquaredNorm() + (a ^ b) * c.SquaredNorm();
	return o + sum / (2 * (a * (b ^ c)));
}

/// A ball that is gone as soon as a sample is found in it.
class EmptyBall
{
public:
	EmptyBall(const Point3d& c, double radius) : c(c), radius(radius) {}

	bool isEmpty() const { return empty; }
	const Point3d& centre() const { return c; }
	double reach() const { return empty ? radius : 0; }
	void visit(int, const Point3d& q)
	{
		empty = empty && !(SquaredDistance(c, q) < radius * radius);
	}

private:
	Point3d c;
	double radius;
	bool empty = true;
};

/**
 * Whether c is a Voronoi vertex: near enough to be inside, and the centre of an empty ball through
 * all four corners. Nearly co-circular neighbourhoods yield centres up to 1e16 diagonals away.
 */
inline bool isVoronoiVertex(const Point3d& c, const Tetrahedron& t,
	const std::vector<Point3d>& samples, const PointTree& tree, double tolerance)
{
	for (int k = 0; k < 3; ++k)
		if (!(std::abs(c[k]) <= 1))
			return false;
	const double radius = Distance(c, samples[t[0]]);
	for (int v : t)
		if (std::abs(Distance(c, samples[v]) - radius) > tolerance)
			return false;
	EmptyBall ball(c, radius - tolerance);
	tree.search(ball);
	return ball.isEmpty();
}

} // namespace detail

/**
 * The inner Voronoi pole of each vertex: the farthest Voronoi vertex of its cell on the inner side.
 *
 * A Voronoi vertex counts if its ball is empty and touches its samples, and for those samples from
 * which it can be seen through the inside of the shape; one that does not count makes way for the
 * next farthest of the cell.
 * @pre mesh is compact.
 * @return poles, #V; radius -1 where no Voronoi vertex of the cell counts.
 * @throws SolverError, Cancelled (before and after, but not while Qhull runs: it cannot be stopped).
 * Complexity: O(V log V) for samples of a surface.
 */
inline PoleSet voronoiPoles(const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	constexpr double tolerance = 1e-5; // of about the diagonal: what moving the points may cost
	const char* what = "Poles: Voronoi diagram";
	progress.report(0, what);
	PoleSet poles;
	poles.centre.assign(mesh.vertexSlots(), Point3d(0, 0, 0));
	poles.radius.assign(mesh.vertexSlots(), -1);
	const UnitFrame frame(mesh.position);
	if (!std::isfinite(frame.diagonal()))
		throw SolverError("The Voronoi diagram of points at infinity is not defined.");
	if (!(frame.diagonal() > 0))
		return poles;
	const std::vector<Point3d> samples = frame.in(mesh.position);
	const std::vector<Point3d> normals = mesh.vertexNormals();
	const PointTree tree(samples, progress.part(0, 0.05));
	const InnerSegments segments(mesh, tree, progress.part(0.05, 0.1));
	const std::vector<detail::Tetrahedron> cells = detail::delaunayTetrahedra(samples);
	for (size_t i = 0; i < cells.size(); ++i) {
		if (i % 16384 == 0)
			progress.report(0.8 + 0.2 * double(i) / double(cells.size()), what);
		const Point3d c = detail::circumcentre(cells[i], samples);
		if (!detail::isVoronoiVertex(c, cells[i], samples, tree, tolerance))
			continue;
		const Point3d centre = frame.out(c);
		for (int v : cells[i]) {
			const double radius = Distance(centre, mesh.position[v]);
			if (radius > poles.radius[v] && (centre - mesh.position[v]) * normals[v] < 0
				&& segments.staysInside(v, centre, frame.lengthOut(tolerance))) {
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
