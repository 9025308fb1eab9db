// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The passes of isotropic remeshing: split, collapse, flip, smooth and project.

#ifndef VCG_MCF_ISOTROPIC_REMESHER_H
#define VCG_MCF_ISOTROPIC_REMESHER_H

#include "long_edge_queue.h"
#include "progressive_coarsening.h"
#include "remeshing_state.h"
#include "triangle_quality.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * Remeshes a surface to an even edge length, pass by pass: coarsen() first, then refine(), then any
 * others. From refine() on, each pass leaves no holes in the numbering, as the next one needs it.
 */
class IsotropicRemesher
{
public:
	/// @see TrackedMesh::TrackedMesh()
	/// @param maxVertices beyond which splitLongEdges() gives up.
	IsotropicRemesher(const SurfaceMesh& surface, const std::vector<int>& componentOfVertex,
		const std::vector<double>& targetLength, size_t maxVertices, const Progress& progress,
		const std::vector<double>& localLength = {}) :
			tracked(surface, componentOfVertex, targetLength, localLength, progress),
			mesh(tracked.mesh), maxVertices(maxVertices)
	{
	}

	IsotropicRemesher(const IsotropicRemesher&) = delete;
	IsotropicRemesher& operator=(const IsotropicRemesher&) = delete;

	/// Merges edges that are much shorter than the target; the remaining vertices stay in place.
	void coarsen(const Progress& progress)
	{
		coarsenInStages(
			mesh, [&](int v) { return coarseFraction * tracked.lengthAt(v); },
			[&](int h) { return tracked.mergeOf(h) != Merge::Never; },
			[&](int h) { tracked.collapse(h); }, progress, "Coarsening the surface");
	}

	/**
	 * Splits the long edges of the coarsened input. Each of its triangles is subdivided within
	 * itself, with Delaunay flips, without which needles would be cut into countless smaller
	 * needles. New vertices in a triangle of the input are known to lie on it.
	 */
	void refine(const Progress& progress)
	{
		tracked.startPatches(progress.part(0, 0.1));
		splitLongEdges(progress.part(0.1, 0.8));
		tracked.endPatches();
		tracked.renumber(progress.part(0.8, 1));
	}

	/// Splits every edge longer than 4/3 of the target at its middle, the longest first.
	/// @throws InvalidParameter where that would need too many vertices.
	void splitLongEdges(const Progress& progress)
	{
		const char* const what = "Splitting long edges";
		LongEdgeQueue queue(mesh, [&](int h) { return longestEdge * tracked.lengthOf(h); });
		reportedLoop(mesh.halfEdgeSlots(), progress.part(0, 0.1), what, [&](int h) {
			if (mesh.isHalfEdge(h) && queue.isTooLong(h) && mesh.isEdge(h))
				queue.push(h);
		});
		Ticker ticker(progress.part(0.1, 1), what, queue.size());
		for (int h = queue.pop(); h >= 0; h = queue.pop()) {
			ticker.tick();
			if (size_t(mesh.vertexCount()) >= maxVertices)
				throw InvalidParameter(
					"Parameter target_length is too small for so narrow a surface: "
					"it needs more than "
					+ std::to_string(maxVertices / 1000)
					+ " thousand vertices. Give a larger one, or do not resample.");
			const int m = tracked.split(h);
			// The halves, the new edges, and the two outer edges whose ids have changed, (b c) and
			// (d b): see SurfaceMesh::split().
			mesh.forEachOutgoing(m, [&](int spoke) { queue.push(spoke); });
			queue.push(mesh.halfEdgeSlots() - 6 + 1);
			queue.push(mesh.halfEdgeSlots() - 3 + 2);
			flipInsidePatches(m, queue);
		}
	}

	/// Merges every edge shorter than 4/5 of the target, where the shape allows it.
	void collapseShortEdges(const Progress& progress)
	{
		const int count = mesh.halfEdgeSlots();
		Ticker ticker(progress, "Collapsing short edges", count);
		for (int h = 0; h < count; ++h) {
			ticker.tick();
			if (!mesh.isHalfEdge(h))
				continue;
			const double target = tracked.lengthOf(h);
			const double shortest = shortestEdge * target, longest = longestEdge * target;
			if (mesh.squaredLength(h) >= shortest * shortest || !mesh.isEdge(h))
				continue;
			int merged = h;
			Merge merge = tracked.mergeOf(h);
			if (merge == Merge::Never) {
				merged = mesh.twin(h);
				merge = tracked.mergeOf(merged);
			}
			if (merge == Merge::Never)
				continue;
			const int a = mesh.origin(merged), b = mesh.target(merged);
			const Point3d point = merge == Merge::Free ? (mesh.position[a] + mesh.position[b]) / 2.0
													   : mesh.position[b];
			if (!ringAllowsMove(mesh, a, point, merged, longest * longest)
				|| (merge == Merge::Free
					&& !ringAllowsMove(mesh, b, point, merged, longest * longest))
				|| !mesh.isCollapsible(merged))
				continue;
			tracked.collapse(merged);
			mesh.position[b] = point;
		}
		tracked.compact();
	}

	/// Flips edges where that brings the valences closer to six.
	void flipForValence(const Progress& progress)
	{
		std::vector<int> valence(mesh.vertexSlots(), 0);
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			++valence[mesh.origin(h)];
		Ticker ticker(progress, "Flipping edges", mesh.halfEdgeSlots());
		const auto excess = [&](int v) { return valence[v] - 6; };
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
			ticker.tick();
			const int a = mesh.origin(h), b = mesh.target(h);
			const int c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
			// By how much the sum of (valence - 6)^2 would fall, halved.
			const int gain = excess(a) + excess(b) - excess(c) - excess(d) - 2;
			if (gain <= 0 || !mesh.isEdge(h) || tracked.isCrease(h) || !flipKeepsShape(mesh, h))
				continue;
			tracked.flip(h);
			--valence[a];
			--valence[b];
			++valence[c];
			++valence[d];
		}
	}

	/// Flips edges whose opposite angles add up to more than 180 degrees, until few are left.
	void flipForAngles(const Progress& progress)
	{
		constexpr int rounds = 3;
		std::vector<char> due(mesh.halfEdgeSlots(), 1); // edges whose triangles are new
		bool flipped = true;
		for (int round = 0; flipped && round < rounds; ++round) {
			flipped = false;
			reportedLoop(mesh.halfEdgeSlots(),
				progress.part(double(round) / rounds, double(round + 1) / rounds), "Flipping edges",
				[&](int h) {
					if (!due[h])
						return;
					due[h] = 0;
					if (!mesh.isEdge(h) || tracked.isCrease(h) || !opposesWideAngles(mesh, h, 1e-9)
						|| !flipKeepsShape(mesh, h))
						return;
					tracked.flip(h);
					flipped = true;
					for (const int side : {h, mesh.twin(h)})
						for (const int outer : {mesh.next(side), mesh.previous(side)})
							due[outer] = due[mesh.twin(outer)] = 1;
				});
		}
	}

	/**
	 * Moves every vertex within its tangent plane to the centroid of its triangles, weighted by
	 * area, then back onto the input; vertices of creases stay on them. Moves that turn a face over
	 * are undone. The projections run on all cores.
	 */
	void smoothAndProject(const Progress& progress)
	{
		Ticker ticker(progress.part(0, 0.3), "Smoothing", mesh.faceSlots());
		sums.resize(mesh.vertexSlots());
		std::fill(sums.begin(), sums.end(), Sum());
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			ticker.tick();
			const Triangle t = mesh.triangle(f);
			const Point3d &a = mesh.position[t[0]], &b = mesh.position[t[1]],
						  &c = mesh.position[t[2]];
			const Point3d n = (b - a) ^ (c - a);
			const double area = n.Norm();
			const Point3d moment = (a + b + c) * (area / 3);
			for (int v : t) {
				sums[v].normal += n;
				sums[v].moment += moment;
				sums[v].area += area;
			}
		}
		old.resize(mesh.vertexSlots());
		std::copy(mesh.position.begin(), mesh.position.end(), old.begin());
		const auto moved = [&](int v) {
			if (tracked.roleOf(v) == CreaseRole::Crease)
				return middleOnCrease(v);
			Point3d move = sums[v].moment / sums[v].area - old[v];
			const double squared = sums[v].normal.SquaredNorm();
			if (squared > 0)
				move -= sums[v].normal * (sums[v].normal * move / squared);
			return Point3d(old[v] + move);
		};
		forEachBlock(
			mesh.vertexSlots(), progress.part(0.3, 0.8), "Smoothing", [&](int begin, int end) {
				for (int v = begin; v < end; ++v)
					if (sums[v].area > 0 && tracked.roleOf(v) != CreaseRole::Corner)
						tracked.moveOntoSurface(v, moved(v));
			});
		restoreTurnedFaces(progress.part(0.8, 1));
	}

	/// @see TrackedMesh::take()
	SurfaceMesh take(const Progress& progress) { return tracked.take(progress); }
	/// @see TrackedMesh::componentOfVertex()
	const std::vector<int>& componentOfVertex() const { return tracked.componentOfVertex(); }

private:
	/// Edges outside of these parts of the target length are collapsed or split.
	static constexpr double shortestEdge = 0.8, longestEdge = 4.0 / 3;
	/// Coarsening merges edges up to this part of the target, and leaves the rest to the rounds.
	static constexpr double coarseFraction = 0.6;
	/// Sine of 10 degrees: while refining, needles are worth a flip, right angles are not.
	static constexpr double patchMargin = 0.17;

	TrackedMesh tracked;
	SurfaceMesh& mesh; ///< tracked.mesh
	size_t maxVertices;

	/// What smoothAndProject() adds up over the triangles of a vertex.
	struct Sum
	{
		Point3d normal = Point3d(0, 0, 0), moment = Point3d(0, 0, 0);
		double area = 0;
	};

	std::vector<int> suspects; ///< scratch of flipInsidePatches()
	// Scratch of smoothAndProject(), kept: new memory in each round costs more than the sums.
	std::vector<Sum> sums;
	std::vector<Point3d> old; ///< positions before the vertices moved

	/// Restores the Delaunay property around the new vertex m among the faces of each patch.
	template <class Queue>
	void flipInsidePatches(int m, Queue& queue)
	{
		mesh.forEachOutgoing(m, [&](int h) { suspects.push_back(mesh.next(h)); });
		while (!suspects.empty()) {
			const int h = suspects.back();
			suspects.pop_back();
			if (!tracked.isInsidePatch(h) || !opposesWideAngles(mesh, h, patchMargin)
				|| !flipKeepsShape(mesh, h))
				continue;
			tracked.flip(h);
			queue.push(h);
			for (const int side : {h, mesh.twin(h)})
				for (const int outer : {mesh.next(side), mesh.previous(side)}) {
					queue.push(outer);
					suspects.push_back(outer);
				}
		}
	}

	/// The middle between the neighbours of v along its crease; v itself if it has not just two.
	Point3d middleOnCrease(int v) const
	{
		Point3d sum(0, 0, 0);
		int neighbours = 0;
		mesh.forEachOutgoing(v, [&](int h) {
			if (tracked.isCrease(h)) {
				sum += old[mesh.target(h)];
				++neighbours;
			}
		});
		return neighbours == 2 ? Point3d(sum / 2.0) : old[v];
	}

	/// Puts vertices of faces that turned over back to where they were until no face is turned.
	void restoreTurnedFaces(const Progress& progress)
	{
		std::vector<int> restored; // vertices whose faces have not been looked at since
		const auto restore = [&](int f) {
			const Triangle t = mesh.triangle(f);
			const Point3d& a = old[t[0]];
			if (!turnsOver((old[t[1]] - a) ^ (old[t[2]] - a), mesh.doubleAreaVector(f)))
				return;
			for (int v : t)
				if (mesh.position[v] != old[v]) {
					mesh.position[v] = old[v];
					restored.push_back(v);
				}
		};
		reportedLoop(mesh.faceSlots(), progress, "Smoothing", restore);
		while (!restored.empty()) {
			const int v = restored.back();
			restored.pop_back();
			mesh.forEachOutgoing(v, [&](int h) { restore(h / 3); });
		}
	}
};

} // namespace vcg::tri::mcf::detail

#endif
