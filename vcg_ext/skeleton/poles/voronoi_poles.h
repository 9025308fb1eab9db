// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Medial poles from the Voronoi diagram of the vertices (Sec. 4.5; Amenta and Bern,
/// "Surface reconstruction by Voronoi filtering", 1999). The only file that includes Qhull.

#ifndef VCG_MCF_VORONOI_POLES_H
#define VCG_MCF_VORONOI_POLES_H

#include "pole_set.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/has_qhull.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/unit_frame.h>
#include <skeleton/spatial/inner_segments.h>
#include <skeleton/spatial/point_tree.h>

#if MCFSKEL_HAS_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

#if MCFSKEL_HAS_QHULL

namespace detail {

/// The vertices of a Delaunay tetrahedron.
using Tetrahedron = std::array<int, 4>;

/// What Qhull wrote, up to its list of options.
inline std::string firstParagraph(FILE* log)
{
	std::string text(1000, '\0');
	std::rewind(log);
	text.resize(std::fread(text.data(), 1, text.size(), log));
	return text.substr(0, text.find("\n\n"));
}

/**
 * Builds a Delaunay triangulation by Qhull, in pieces between which the user can cancel.
 *
 * qh_new_qhull() returns only when all is done. What it does for joggled input is done here by the
 * same calls in the same order, so the result has the same bits. Qhull leaves a piece by longjmp()
 * where it fails or wants to joggle the input again: each piece has its own setjmp(), and no object
 * with a destructor lives in between.
 */
class QhullRun
{
public:
	/// @param coordinates three for each point.
	QhullRun(std::vector<coordT> coordinates, const char* command) :
			coordinates(std::move(coordinates)), command(command), log(std::tmpfile(), std::fclose)
	{
		// Qhull writes to C files only, and a library must not write to its user's terminal.
		if (!log)
			throw SolverError(
				"The Voronoi diagram needs a temporary file for Qhull's messages and got none.");
		qh_zero(&state, nullptr);
	}
	QhullRun(const QhullRun&) = delete;
	QhullRun& operator=(const QhullRun&) = delete;
	/// Frees Qhull's memory, also when an exception passes.
	~QhullRun()
	{
		state.NOerrexit = True; // nothing to jump back to
		// What facets own is freed with the memory blocks that hold it, except for large outside
		// sets: the facets before facet_next have none, and to visit each would take long.
		if (started)
			state.facet_list = state.facet_next;
		qh_freeqhull(&state, !qh_ALL);
		int memory, blocks;
		qh_memfreeshort(&state, &memory, &blocks);
	}

	/// @throws SolverError with Qhull's message; Cancelled.
	void build(const Progress& progress, const char* what)
	{
		qhT* qh = &state;
		progress.report(0, what);
		char justStart[] = "qhull";
		qh_new_qhull(qh, 0, 0, nullptr, False, justStart, nullptr, log.get());
		attempt([this, qh] {
			qh_initflags(qh, command.data());
			qh->PROJECTdelaunay = True;
			qh_init_B(qh, coordinates.data(), int(coordinates.size() / 3), 3, False);
		});
		const auto report = [&](double done) {
			maxDone = std::max(maxDone, done);
			progress.report(maxDone, what);
		};
		while (!joggleAndStart() || !addPoints(report) || !isConvex(report))
			report(0);
	}

	qhT* get() { return &state; }

private:
	static constexpr double partOfPoints = 0.9; ///< of the work

	qhT state;
	std::vector<coordT> coordinates;
	std::string command;
	std::unique_ptr<FILE, int (*)(FILE*)> log;
	bool started = false; ///< there is a simplex that points are added to
	double maxDone = 0;   ///< of the work, in any try

	/// @return false if Qhull wants the input to be joggled again.
	template <class Job>
	bool attempt(const Job& job)
	{
		if (const int code = setjmp(state.errexit); code != 0)
			throw SolverError("Qhull could not compute the Voronoi diagram (code "
				+ std::to_string(code) + "): " + firstParagraph(log.get()));
		if (setjmp(state.restartexit) != 0)
			return false;
		state.NOerrexit = False;
		job();
		state.NOerrexit = True;
		return true;
	}

	/// Joggles the points, by more after many attempts, and builds the first simplex.
	bool joggleAndStart()
	{
		started = false;
		started = attempt([qh = &state] {
			if (qh->build_cnt > qh_JOGGLEmaxretry) {
				qh_fprintf(qh, qh->ferr, 6229, "%d attempts with joggled input.\n", qh->build_cnt);
				qh_errexit(qh, qh_ERRinput, nullptr, nullptr);
			}
			vertexT *vertex, **vertexp;
			FOREACHvertex_(qh->del_vertices) vertex->partitioned = True;
			qh->last_errcode = qh_ERRnone;
			qh->ALLOWrestart = True;
			qh_freebuild(qh, True);
			++qh->build_cnt;
			qh_joggleinput(qh);
			qh_initbuild(qh);
			qh->facet_next = qh->facet_list;
		});
		return started;
	}

	/// @param report (fraction of the whole work).
	template <class Report>
	bool addPoints(const Report& report)
	{
		constexpr int maxBetweenReports = 256;
		qhT* qh = &state;
		bool goesOn = true;
		while (goesOn) {
			// Each of the first points repartitions nearly all others, which takes linear time.
			const int some = std::min(maxBetweenReports, 1 + qh->num_vertices / 64);
			const bool added = attempt([qh, some, &goesOn] {
				for (int i = 0; goesOn && i < some; ++i) {
					facetT* facet;
					pointT* point = qh_nextfurthest(qh, &facet);
					qh->num_outside -= point != nullptr;
					goesOn = point && qh_addpoint(qh, point, facet, qh->ONLYmax);
				}
			});
			report(partOfPoints * qh->num_vertices / qh->num_points);
			if (!added)
				return false;
		}
		return attempt([qh] {
			if (qh->NARROWhull)
				qh_outcoplanar(qh);
		});
	}

	/// Whether all facets are clearly convex, as qh_checkconvex() requires of joggled input.
	template <class Report>
	bool isConvex(const Report& report)
	{
		constexpr int reportEvery = 1 << 13;
		qhT* qh = &state;
		facetT *facet, *neighbor;
		int count = 0, neighbor_i, neighbor_n;
		FORALLfacets
		{
			if (count++ % reportEvery == 0)
				report(partOfPoints + (1 - partOfPoints) * count / qh->num_facets);
			if (facet->flipped)
				return false;
			FOREACHneighbor_i_(qh, facet)
			{
				realT distance;
				const vertexT* opposite = SETelemt_(facet->vertices, neighbor_i, vertexT);
				qh_distplane(qh, opposite->point, neighbor, &distance);
				if (distance >= -qh->DISTround)
					return false;
			}
		}
		return true;
	}
};

/**
 * The Delaunay tetrahedra of the points, without those at a corner of a cube put around them.
 *
 * The corners of the cube bound the cells of the outermost points, and make the lifted points span
 * four dimensions where the points are cospherical, as a sphere's are. Qhull joggles the points
 * (QJ): merging the facets of many cospherical points would take quadratic time.
 * @pre the points lie in the cube of half side 1 around the origin, which excludes NaN: Qhull does
 *      not survive it.
 * @param command for Qhull, with QJ.
 * @throws SolverError with Qhull's message; Cancelled.
 */
inline std::vector<Tetrahedron> delaunayTetrahedra(const std::vector<Point3d>& points,
	const Progress& progress = Progress(), const char* command = "qhull d QJ")
{
	constexpr size_t reportEvery = 1 << 15;
	const char* const what = "Poles: Voronoi diagram";
	constexpr double halfSide = 3;
	const int count = int(points.size());
	std::vector<coordT> coordinates;
	coordinates.reserve(3 * (points.size() + 8));
	for (const Point3d& p : points)
		coordinates.insert(coordinates.end(), {p[0], p[1], p[2]});
	for (int corner = 0; corner < 8; ++corner)
		for (int k = 0; k < 3; ++k)
			coordinates.push_back(corner >> k & 1 ? halfSide : -halfSide);
	QhullRun run(std::move(coordinates), command);
	run.build(progress.part(0, 0.95), what);
	qhT* qh = run.get();
	std::vector<Tetrahedron> tetrahedra;
	facetT* facet;
	vertexT *vertex, **vertexp;
	size_t seen = 0;
	FORALLfacets
	{
		if (seen++ % reportEvery == 0)
			progress.report(0.95 + 0.05 * double(seen) / qh->num_facets, what);
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

/// A ball to be tested for samples; its search ends with the first one found in it.
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
 * A Voronoi vertex counts if its ball is empty and touches its four samples, and only for those of
 * them from which it is visible through the inside of the shape. Where the farthest of a cell does
 * not count, the next farthest does.
 * @pre mesh is compact.
 * @return a pole for each vertex; radius -1 where no Voronoi vertex of the cell counts.
 * @throws SolverError, also in a program without Qhull; Cancelled.
 * Complexity: O(V log V) for samples of a surface.
 */
inline PoleSet voronoiPoles(const SurfaceMesh& mesh, const Progress& progress = Progress())
{
	constexpr size_t reportEvery = 1 << 12;
	constexpr double tolerance = 1e-5; // of about the diagonal; covers the joggling
	const char* what = "Poles: Voronoi diagram";
	progress.report(0, what);
	const Progress begin = progress.cancelOnly();
	PoleSet poles;
	const size_t count = size_t(mesh.vertexSlots());
	detail::fillArray(poles.centre, count, Point3d(0, 0, 0), begin);
	detail::fillArray(poles.radius, count, -1.0, begin);
	const UnitFrame frame(mesh.position, begin);
	if (!std::isfinite(frame.diagonal()))
		throw SolverError("The Voronoi diagram of points at infinity is not defined.");
	if (!(frame.diagonal() > 0))
		return poles;
	const std::vector<Point3d> samples = frame.in(mesh.position, begin);
	const std::vector<Point3d> normals = mesh.vertexNormals(begin);
	const PointTree tree(samples, progress.part(0, 0.05));
	const InnerSegments segments(mesh, tree, progress.part(0.05, 0.1));
	const std::vector<detail::Tetrahedron> cells =
		detail::delaunayTetrahedra(samples, progress.part(0.1, 0.8));
	for (size_t i = 0; i < cells.size(); ++i) {
		if (i % reportEvery == 0)
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

#else

inline PoleSet voronoiPoles(const SurfaceMesh&, const Progress& = Progress())
{
	throw SolverError("The Voronoi diagram needs Qhull, which this program is built without.");
}

#endif

} // namespace vcg::tri::mcf

#endif
