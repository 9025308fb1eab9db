// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The sharp edges of a surface, and their maintenance under splits, flips and collapses.

#ifndef VCG_MCF_FEATURE_EDGES_H
#define VCG_MCF_FEATURE_EDGES_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/segment.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// What a vertex is to the creases of the surface, and so how freely it may move.
enum class CreaseRole : char {
	Smooth, ///< on no crease: moves over the surface
	Crease, ///< inside a crease: moves along it
	Corner  ///< where creases end, meet or turn sharply: stays
};

/**
 * A mark on each sharp edge of a SurfaceMesh.
 *
 * A crease is a chain of edges with more than 60 degrees between the normals of their two faces. It
 * counts only if it is a few target lengths long and turns by less than 45 degrees at each vertex:
 * noise makes many sharp edges but no long chains of them.
 */
class CreaseEdges
{
public:
	/// No creases at all.
	CreaseEdges() = default;

	/**
	 * Finds the creases of `surface`.
	 * @param shortest double(vertex): the length, mesh units, below which a chain through the
	 *                 vertex is no crease.
	 * @throws Cancelled
	 * Complexity: O(F + sharp edges x edges in a shortest crease).
	 */
	template <class ShortestAt>
	CreaseEdges(
		const SurfaceMesh& surface, ShortestAt&& shortest, const Progress& progress = Progress())
	{
		std::vector<int> candidates;
		progress.report(0, findingCreases);
		const std::vector<Point3d> normals = unitNormals(surface, progress.part(0, 0.5));
		detail::reportedLoop(
			surface.halfEdgeSlots(), progress.part(0.5, 0.9), findingCreases, [&](int h) {
				if (surface.isEdge(h) && isSharp(normals[h / 3], normals[surface.twin(h) / 3]))
					candidates.push_back(h);
			});
		if (candidates.empty())
			return;
		const Progress chains = progress.part(0.9, 1);
		const size_t count = size_t(surface.halfEdgeSlots());
		std::vector<char> candidate = detail::filledArray(count, char(0), chains);
		for (int h : candidates)
			candidate[h] = candidate[surface.twin(h)] = 1;
		detail::fillArray(marks, count, char(0), chains);
		bool any = false;
		detail::reportedLoop(int(candidates.size()), chains, findingCreases, [&](int i) {
			const int h = candidates[i];
			const double wanted = shortest(surface.origin(h));
			if (chainLength(surface, candidate, h, wanted) < wanted)
				return;
			marks[h] = marks[surface.twin(h)] = 1;
			any = true;
		});
		if (!any)
			marks.clear();
	}

	bool empty() const { return marks.empty(); }
	bool isCrease(int h) const { return !marks.empty() && marks[h]; }

	/// The role of each vertex slot of `surface`; empty if there are no creases.
	/// @throws Cancelled
	std::vector<CreaseRole> roles(
		const SurfaceMesh& surface, const Progress& progress = Progress()) const
	{
		std::vector<CreaseRole> role;
		if (empty())
			return role;
		role.assign(surface.vertexSlots(), CreaseRole::Smooth);
		detail::reportedLoop(surface.halfEdgeSlots(), progress, findingCreases, [&](int h) {
			if (marks[h] && surface.isHalfEdge(h))
				role[surface.origin(h)] = roleAt(surface, h);
		});
		return role;
	}

	/// The other crease edge out of origin(h) if that vertex has exactly two, else -1.
	int continuation(const SurfaceMesh& surface, int h) const
	{
		int other = -1, count = 0;
		for (int e = surface.rotated(h); e != h; e = surface.rotated(e))
			if (marks[e]) {
				other = e;
				++count;
			}
		return count == 1 ? other : -1;
	}

	/// To be called after mesh.split(h, ...).
	void afterSplit(const SurfaceMesh& mesh, int h)
	{
		if (empty())
			return;
		// The new faces are the last two: (m b c), (b m d). See SurfaceMesh::split().
		const int f = int(marks.size()), g = f + 3, t = mesh.twin(h);
		marks.resize(size_t(mesh.halfEdgeSlots()), 0);
		const int bc = mesh.next(h), db = mesh.previous(t);
		marks[f] = marks[g] = marks[h];
		marks[f + 1] = marks[bc];
		marks[g + 2] = marks[db];
		marks[bc] = marks[db] = 0;
	}

	/// To be called before mesh.flip(h). @pre h is no crease.
	void beforeFlip(const SurfaceMesh& mesh, int h)
	{
		if (empty())
			return;
		const int t = mesh.twin(h);
		const int hn = mesh.next(h), hp = mesh.previous(h), tn = mesh.next(t),
				  tp = mesh.previous(t);
		const char bc = marks[hn], ca = marks[hp], ad = marks[tn], db = marks[tp];
		marks[hn] = ca;
		marks[hp] = ad;
		marks[tn] = db;
		marks[tp] = bc;
	}

	/// To be called before mesh.collapse(h): an edge merged from two is a crease if either was.
	void beforeCollapse(const SurfaceMesh& mesh, int h)
	{
		if (empty())
			return;
		for (int side : {h, mesh.twin(h)}) {
			const int x = mesh.twin(mesh.next(side)), y = mesh.twin(mesh.previous(side));
			marks[x] = marks[y] = char(marks[x] | marks[y]);
		}
	}

	/// To be called before mesh becomes mesh.renumbered(..., newFace).
	void beforeRenumber(const SurfaceMesh& mesh, const std::vector<int>& newFace)
	{
		if (empty())
			return;
		std::vector<char> renumbered(3 * size_t(mesh.faceCount()));
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (newFace[h / 3] >= 0)
				renumbered[3 * newFace[h / 3] + h % 3] = marks[h];
		marks = std::move(renumbered);
	}

	/// To be called before mesh.compact().
	void beforeCompact(const SurfaceMesh& mesh)
	{
		if (empty())
			return;
		size_t alive = 0;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isHalfEdge(h))
				marks[alive++] = marks[h];
		marks.resize(alive);
	}

private:
	/// One for each half-edge slot, the same for twins; empty if there are no creases.
	std::vector<char> marks;

	static constexpr double sharpCosine = 0.5;         // 60 degrees between the normals
	static constexpr double straightCosine = 0.707106; // 45 degrees between edges of a chain

	static constexpr const char* findingCreases = "Finding the creases";

	static std::vector<Point3d> unitNormals(const SurfaceMesh& surface, const Progress& progress)
	{
		std::vector<Point3d> normals =
			detail::filledArray(size_t(surface.faceSlots()), Point3d(0, 0, 0), progress);
		detail::reportedLoop(surface.faceSlots(), progress, findingCreases, [&](int f) {
			if (!surface.isFace(f))
				return;
			const Point3d n = surface.doubleAreaVector(f);
			const double length = n.Norm();
			if (length > 0)
				normals[f] = n / length;
		});
		return normals;
	}

	/// Degenerate faces have a zero normal and are ignored.
	static bool isSharp(const Point3d& n, const Point3d& m)
	{
		return n * m < sharpCosine && n.SquaredNorm() > 0.5 && m.SquaredNorm() > 0.5;
	}

	static Point3d direction(const SurfaceMesh& surface, int h)
	{
		Point3d d = surface.position[surface.target(h)] - surface.position[surface.origin(h)];
		const double length = d.Norm();
		return length > 0 ? Point3d(d / length) : Point3d(0, 0, 0);
	}

	/// Length of the straightest chain of candidates through h; the walk stops once it is `enough`.
	static double chainLength(
		const SurfaceMesh& surface, const std::vector<char>& candidate, int h, double enough)
	{
		double length = std::sqrt(surface.squaredLength(h));
		for (const int start : {h, surface.twin(h)}) {
			int e = start;
			while (length < enough) {
				const Point3d ahead = direction(surface, e);
				int best = -1;
				double bestCosine = straightCosine;
				surface.forEachOutgoing(surface.target(e), [&](int next) {
					if (!candidate[next] || next == surface.twin(e))
						return;
					const double cosine = ahead * direction(surface, next);
					if (cosine > bestCosine) {
						bestCosine = cosine;
						best = next;
					}
				});
				if (best < 0)
					break;
				if (best == start)
					return enough; // a closed loop
				e = best;
				length += std::sqrt(surface.squaredLength(e));
			}
		}
		return length;
	}

	/// The role of origin(h). @pre h is a crease.
	CreaseRole roleAt(const SurfaceMesh& surface, int h) const
	{
		const int other = continuation(surface, h);
		if (other < 0)
			return CreaseRole::Corner;
		const double cosine = direction(surface, h) * direction(surface, other);
		return cosine > -sharpCosine ? CreaseRole::Corner : CreaseRole::Crease;
	}
};

/**
 * The point of a crease that is closest to `query`, found by walking along the crease from its
 * half-edge `h` while the distance falls; corners are not passed.
 * @param h becomes the half-edge of the crease that the point is on.
 */
inline Point3d trackCrease(const SurfaceMesh& surface, const CreaseEdges& creases,
	const std::vector<CreaseRole>& role, const Point3d& query, int& h)
{
	const auto closest = [&](int e) {
		return closestOnSegment(
			surface.position[surface.origin(e)], surface.position[surface.target(e)], query);
	};
	auto [point, t] = closest(h);
	while (t == 0 || t == 1) {
		const int out = t == 0 ? h : surface.twin(h); // starts at the end that was met
		if (role[surface.origin(out)] != CreaseRole::Crease)
			break;
		const int onward = creases.continuation(surface, out);
		const SegmentPoint candidate = closest(onward);
		if (!(SquaredDistance(candidate.point, query) < SquaredDistance(point, query)))
			break;
		h = onward;
		t = candidate.t;
		point = candidate.point;
	}
	return point;
}

} // namespace vcg::tri::mcf

#endif
