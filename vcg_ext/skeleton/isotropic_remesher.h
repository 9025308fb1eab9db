// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The passes of isotropic remeshing: split, collapse, flip, smooth and project.

#ifndef VCG_MCF_ISOTROPIC_REMESHER_H
#define VCG_MCF_ISOTROPIC_REMESHER_H

#include "breadth_first_order.h"
#include "crease_edges.h"
#include "progress.h"
#include "staged_coarsening.h"
#include "surface_mesh.h"
#include "surface_tracking.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * A surface on its way to an even mesh of a given edge length, and what ties it to the input.
 *
 * Every vertex knows a half-edge of the input: its triangle is the one the vertex was projected on
 * last, where the next projection starts to walk; on a crease it is the crease edge itself.
 */
class IsotropicRemesher
{
public:
	/**
	 * @param surface           the input; must outlive this object.
	 * @param componentOfVertex connected component of each vertex slot of `surface`.
	 * @param targetLength      of each component, mesh units, > 0.
	 */
	IsotropicRemesher(const SurfaceMesh& surface, const std::vector<int>& componentOfVertex,
		const std::vector<double>& targetLength) :
			surface(surface),
			surfaceCreases(surface,
				[&](int v) { return shortestCrease * targetLength[componentOfVertex[v]]; }),
			surfaceRoles(surfaceCreases.roles(surface)), mesh(surface), creases(surfaceCreases),
			role(surfaceRoles), component(componentOfVertex), length(targetLength),
			track(surface.vertexSlots())
	{
		for (int v = 0; v < surface.vertexSlots(); ++v)
			track[v] = surface.outgoing(v);
		if (!surfaceCreases.empty())
			for (int h = surface.halfEdgeSlots() - 1; h >= 0; --h)
				if (surfaceCreases.isCrease(h))
					track[surface.origin(h)] = h;
	}

	/// Merges edges that are much shorter than the target, with vertices of the input only.
	void coarsen(const Progress& progress)
	{
		coarsenInStages(
			mesh, [&](int v) { return coarseFraction * lengthAt(v); },
			[&](int h) { return mergeOf(h) == Merge::Free || mergeOf(h) == Merge::IntoTarget; },
			[&](int h) { collapse(h); }, progress, "Coarsening the surface");
	}

	/**
	 * Splits the long edges of the coarsened input. Each of its triangles is subdivided within
	 * itself, with Delaunay flips, or needles would be cut into countless smaller needles; and where
	 * the triangle is one of the input it is known where its new vertices lie.
	 */
	void refine(const Progress& progress)
	{
		patch.resize(mesh.faceSlots());
		isInputPatch.resize(mesh.faceSlots());
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			patch[f] = f;
			isInputPatch[f] = mesh.isFace(f) && mesh.triangle(f) == surface.triangle(f);
		}
		splitLongEdges(progress);
		std::vector<int>().swap(patch);
		std::vector<char>().swap(isInputPatch);
		renumber();
	}

	/// Splits every edge longer than 4/3 of the target at its middle, the longest first.
	void splitLongEdges(const Progress& progress)
	{
		EdgeQueue queue(*this);
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isEdge(h))
				queue.push(h);
		Ticker ticker(progress, "Splitting long edges");
		for (int h = queue.pop(); h >= 0; h = queue.pop()) {
			ticker.tick();
			const int m = split(h);
			// The halves, the new edges, and the two outer edges whose ids have changed, b c and d b:
			// see SurfaceMesh::split().
			mesh.forEachOutgoing(m, [&](int spoke) { queue.push(spoke); });
			queue.push(mesh.halfEdgeSlots() - 6 + 1);
			queue.push(mesh.halfEdgeSlots() - 3 + 2);
			if (!patch.empty())
				flipWithinPatches(m, queue);
		}
	}

	/// Merges every edge shorter than 4/5 of the target, where the shape allows it.
	void collapseShortEdges(const Progress& progress)
	{
		Ticker ticker(progress, "Collapsing short edges");
		const int count = mesh.halfEdgeSlots();
		for (int h = 0; h < count; ++h) {
			ticker.tick();
			if (!mesh.isHalfEdge(h) || h > mesh.twin(h))
				continue;
			const double target = lengthAt(mesh.origin(h));
			const double shortest = 0.8 * target, longest = 4.0 / 3 * target;
			if (mesh.squaredLength(h) >= shortest * shortest)
				continue;
			int kept = h;
			Merge merge = mergeOf(h);
			if (merge == Merge::Never) {
				kept = mesh.twin(h);
				merge = mergeOf(kept);
			}
			if (merge == Merge::Never)
				continue;
			const int a = mesh.origin(kept), b = mesh.target(kept);
			const Point3d point =
				merge == Merge::Free ? (mesh.position[a] + mesh.position[b]) / 2.0 : mesh.position[b];
			if (!ringAllowsMove(mesh, a, point, kept, longest * longest)
				|| (merge == Merge::Free && !ringAllowsMove(mesh, b, point, kept, longest * longest))
				|| !mesh.isCollapsible(kept))
				continue;
			collapse(kept);
			mesh.position[b] = point;
		}
	}

	/// Flips edges where that brings the valences closer to six.
	void flipForValence(const Progress& progress)
	{
		std::vector<int> valence(mesh.vertexSlots(), 0);
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isHalfEdge(h))
				++valence[mesh.origin(h)];
		Ticker ticker(progress, "Flipping edges");
		const auto excess = [&](int v) { return valence[v] - 6; };
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
			ticker.tick();
			if (!mesh.isEdge(h) || creases.isCrease(h))
				continue;
			const int a = mesh.origin(h), b = mesh.target(h);
			const int c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
			// The change of the sum of squares (valence - 6)^2, halved.
			const int gain = excess(a) + excess(b) - excess(c) - excess(d) - 2;
			if (gain <= 0 || !flipKeepsShape(h))
				continue;
			flip(h);
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
		bool flipped = true;
		for (int round = 0; flipped && round < rounds; ++round) {
			flipped = false;
			Ticker ticker(progress, "Flipping edges");
			for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
				ticker.tick();
				if (mesh.isEdge(h) && !creases.isCrease(h) && opposesWideAngles(h, 1e-9)
					&& flipKeepsShape(h)) {
					flip(h);
					flipped = true;
				}
			}
		}
	}

	/**
	 * Moves every vertex within its tangent plane to the centroid of its triangles, weighted by
	 * area, then back onto the input; vertices of creases stay on them. What turned a face over is
	 * undone.
	 */
	void smoothAndProject(const Progress& progress)
	{
		const int count = mesh.vertexSlots();
		struct Sum
		{
			Point3d normal = Point3d(0, 0, 0), moment = Point3d(0, 0, 0);
			double area = 0;
		};
		std::vector<Sum> sums(count);
		std::vector<Point3d> areaVectors(mesh.faceSlots());
		Ticker ticker(progress, "Smoothing");
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			ticker.tick();
			if (!mesh.isFace(f))
				continue;
			const Triangle t = mesh.triangle(f);
			const Point3d &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
			const Point3d n = (b - a) ^ (c - a);
			areaVectors[f] = n;
			const double area = n.Norm();
			const Point3d moment = (a + b + c) * (area / 3);
			for (int v : t) {
				sums[v].normal += n;
				sums[v].moment += moment;
				sums[v].area += area;
			}
		}
		const std::vector<Point3d> old = mesh.position;
		for (int v = 0; v < count; ++v) {
			ticker.tick();
			if (!mesh.isVertex(v))
				continue;
			if (roleOf(v) == CreaseRole::Crease)
				moveAlongCrease(v, old);
			else if (roleOf(v) == CreaseRole::Smooth && sums[v].area > 0) {
				Point3d move = sums[v].moment / sums[v].area - old[v];
				const double squared = sums[v].normal.SquaredNorm();
				if (squared > 0)
					move -= sums[v].normal * (sums[v].normal * move / squared);
				int face = track[v] / 3;
				mesh.position[v] = trackSurface(surface, old[v] + move, face);
				track[v] = 3 * face;
			}
		}
		restoreTurnedFaces(areaVectors, old, ticker);
	}

	/// The mesh as it is now, without holes in its numbering, one component after the other. Leaves
	/// this object empty.
	SurfaceMesh take()
	{
		renumber();
		return std::move(mesh);
	}

private:
	/// A chain of sharp edges shorter than this is no crease; target lengths.
	static constexpr double shortestCrease = 6;
	/// Creases closer to each other than this are joined; target lengths.
	static constexpr double closestCreases = 0.25;
	/// Coarsening merges edges up to this part of the target, and leaves the rest to the rounds.
	static constexpr double coarseFraction = 0.6;
	/// Needles are worth a flip while refining; triangles with right angles are not (10 degrees).
	static constexpr double patchMargin = 0.17;
	/// cos of the angle by which a flip may turn a face: 60 degrees.
	static constexpr double flipCosine = 0.5;

	const SurfaceMesh& surface;
	const CreaseEdges surfaceCreases;
	const std::vector<CreaseRole> surfaceRoles;

	SurfaceMesh mesh;
	CreaseEdges creases;
	std::vector<CreaseRole> role; ///< of each vertex; empty if there are no creases
	std::vector<int> component;   ///< of each vertex
	std::vector<double> length;   ///< of each component
	std::vector<int> track;       ///< of each vertex a half-edge of `surface`

	// While refining only:
	std::vector<int> patch;         ///< of each face the triangle that it is a part of
	std::vector<char> isInputPatch; ///< of each such triangle whether the input has it

	std::vector<int> suspects;      ///< scratch of flipWithinPatches()

	/// Counts elements and lets the user cancel now and then.
	class Ticker
	{
	public:
		Ticker(const Progress& progress, const char* what) : progress(progress), what(what)
		{
			progress.report(0, what);
		}
		void tick()
		{
			if (++count % reportEvery == 0)
				progress.report(0, what);
		}

	private:
		static constexpr std::uint32_t reportEvery = 1 << 15;
		const Progress& progress;
		const char* what;
		std::uint32_t count = 0;
	};

	/// The edges that are too long, in buckets of lengths a factor of 1.1 apart.
	class EdgeQueue
	{
	public:
		explicit EdgeQueue(const IsotropicRemesher& remesher) : remesher(remesher) {}

		/// Adds the edge of h if it is too long.
		void push(int h)
		{
			const int bucket = bucketOf(h);
			if (bucket < 0)
				return;
			if (bucket >= int(buckets.size()))
				buckets.resize(size_t(bucket) + 1);
			buckets[size_t(bucket)].push_back(h);
		}

		/// Takes out one of the longest edges; -1 if there is none.
		int pop()
		{
			while (!buckets.empty()) {
				std::vector<int>& longest = buckets.back();
				if (longest.empty()) {
					buckets.pop_back();
					continue;
				}
				const int h = longest.back();
				longest.pop_back();
				// An id may have come to mean another edge, which was pushed by its own length.
				if (bucketOf(h) + 1 == int(buckets.size()))
					return h;
			}
			return -1;
		}

	private:
		const IsotropicRemesher& remesher;
		std::vector<std::vector<int>> buckets; ///< the first one starts at 4/3 of the target

		int bucketOf(int h) const
		{
			const double limit = 4.0 / 3 * remesher.lengthAt(remesher.mesh.origin(h));
			const double relative = remesher.mesh.squaredLength(h) / (limit * limit);
			return relative > 1 ? int(std::log(relative) / (2 * std::log(1.1))) : -1;
		}
	};

	/// How origin(h) may be merged into target(h).
	enum class Merge {
		Never,
		Free,      ///< the merged vertex may lie anywhere
		IntoTarget ///< it must lie at target(h)
	};

	double lengthAt(int v) const { return length[component[v]]; }
	CreaseRole roleOf(int v) const { return role.empty() ? CreaseRole::Smooth : role[v]; }

	Merge mergeOf(int h) const
	{
		if (role.empty())
			return Merge::Free;
		const CreaseRole from = role[mesh.origin(h)], to = role[mesh.target(h)];
		if (from == CreaseRole::Smooth)
			return to == CreaseRole::Smooth ? Merge::Free : Merge::IntoTarget;
		if (from == CreaseRole::Corner)
			return Merge::Never;
		if (!creases.isCrease(h)) {
			// Creases stay apart, unless their distance would make needles.
			const double closest = closestCreases * lengthAt(mesh.origin(h));
			return to == CreaseRole::Crease && mesh.squaredLength(h) < closest * closest
				? Merge::IntoTarget
				: Merge::Never;
		}
		// Two crease edges must not fall into one.
		for (const int side : {h, mesh.twin(h)})
			if (creases.isCrease(mesh.next(side)) && creases.isCrease(mesh.previous(side)))
				return Merge::Never;
		return to == CreaseRole::Corner ? Merge::IntoTarget : Merge::Free;
	}

	void collapse(int h)
	{
		if (!role.empty() && role[mesh.origin(h)] == CreaseRole::Crease && !creases.isCrease(h))
			role[mesh.target(h)] = CreaseRole::Corner; // two creases meet from now on
		creases.beforeCollapse(mesh, h);
		mesh.collapse(h);
	}

	void flip(int h)
	{
		creases.beforeFlip(mesh, h);
		mesh.flip(h);
	}

	int split(int h)
	{
		const int a = mesh.origin(h), b = mesh.target(h);
		const Point3d middle = (mesh.position[a] + mesh.position[b]) / 2.0;
		const int m = mesh.split(h, middle);
		creases.afterSplit(mesh, h);
		if (!patch.empty())
			for (const int side : {h, mesh.twin(h)})
				patch.push_back(patch[side / 3]);
		component.push_back(component[a]);
		if (!role.empty())
			role.push_back(creases.isCrease(h) ? CreaseRole::Crease : CreaseRole::Smooth);
		track.push_back(trackOfMiddle(a, b, m));
		return m;
	}

	/// Restores the Delaunay property around the new vertex m among the faces of each patch.
	void flipWithinPatches(int m, EdgeQueue& queue)
	{
		mesh.forEachOutgoing(m, [&](int h) { suspects.push_back(mesh.next(h)); });
		while (!suspects.empty()) {
			const int h = suspects.back();
			suspects.pop_back();
			if (patch[h / 3] != patch[mesh.twin(h) / 3] || !opposesWideAngles(h, patchMargin)
				|| !flipKeepsShape(h))
				continue;
			flip(h);
			queue.push(h);
			for (const int side : {h, mesh.twin(h)})
				for (const int outer : {mesh.next(side), mesh.previous(side)}) {
					queue.push(outer);
					suspects.push_back(outer);
				}
		}
	}

	/// Where on the input the middle m of an edge (a b) belongs. It is moved there with the others,
	/// when vertices are smoothed: halves of an edge must be shorter than the whole.
	int trackOfMiddle(int a, int b, int m) const
	{
		if (roleOf(m) == CreaseRole::Crease) {
			// A corner's own half-edge may belong to another crease: start from the other end.
			int h = roleOf(a) == CreaseRole::Crease ? track[a] : track[b];
			if (roleOf(a) != CreaseRole::Crease && roleOf(b) != CreaseRole::Crease)
				h = creaseBetween(a, b);
			trackCrease(surface, surfaceCreases, surfaceRoles, mesh.position[m], h);
			return h;
		}
		if (!patch.empty())
			for (const int side : {mesh.outgoing(m), mesh.twin(mesh.outgoing(m))})
				if (isInputPatch[patch[side / 3]])
					return 3 * patch[side / 3];
		// A walk may be stopped at a fold, or start on the wrong side of a crease: try all sides.
		const Point3d& middle = mesh.position[m];
		int best = -1;
		double bestDistance = std::numeric_limits<double>::max();
		const auto consider = [&](int face) {
			const double distance = SquaredDistance(trackSurface(surface, middle, face), middle);
			if (distance < bestDistance) {
				bestDistance = distance;
				best = face;
			}
		};
		for (const int end : {a, b}) {
			if (roleOf(end) == CreaseRole::Corner)
				surface.forEachOutgoing(surface.origin(track[end]), [&](int h) { consider(h / 3); });
			else
				consider(track[end] / 3);
			if (roleOf(end) == CreaseRole::Crease)
				consider(surface.twin(track[end]) / 3);
		}
		return 3 * best;
	}

	/// A crease edge of the input on the crease that joins two corners, by its direction at a.
	int creaseBetween(int a, int b) const
	{
		const int corner = surface.origin(track[a]);
		const Point3d along = mesh.position[b] - mesh.position[a];
		int best = track[a];
		double bestCosine = -2;
		surface.forEachOutgoing(corner, [&](int h) {
			if (!surfaceCreases.isCrease(h))
				return;
			const Point3d d = surface.position[surface.target(h)] - surface.position[corner];
			const double cosine = d * along / (d.Norm() * along.Norm());
			if (cosine > bestCosine) {
				bestCosine = cosine;
				best = h;
			}
		});
		return best;
	}

	void moveAlongCrease(int v, const std::vector<Point3d>& old)
	{
		Point3d sum(0, 0, 0);
		int neighbours = 0;
		mesh.forEachOutgoing(v, [&](int h) {
			if (creases.isCrease(h)) {
				sum += old[mesh.target(h)];
				++neighbours;
			}
		});
		if (neighbours == 2)
			mesh.position[v] = trackCrease(surface, surfaceCreases, surfaceRoles, sum / 2.0, track[v]);
	}

	/// Whether the flip of h leaves the two triangles within 60 degrees of where they were.
	bool flipKeepsShape(int h) const
	{
		const int t = mesh.twin(h);
		const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
		const Point3d &c = mesh.position[mesh.apex(h)], &d = mesh.position[mesh.apex(t)];
		const Point3d before = ((b - a) ^ (c - a)) + ((d - a) ^ (b - a));
		const double scale = flipCosine * before.Norm();
		const Point3d left = (c - d) ^ (a - d), right = (d - c) ^ (b - c);
		return left * before > scale * left.Norm() && right * before > scale * right.Norm()
			&& mesh.isFlippable(h);
	}

	/// Whether the two angles opposite to h add up to more than 180 degrees, by more than an angle
	/// whose sine is `margin`.
	bool opposesWideAngles(int h, double margin) const
	{
		const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
		const auto cosineAndSine = [&](int apex) {
			const Point3d u = a - mesh.position[apex], v = b - mesh.position[apex];
			return std::make_pair(u * v, (u ^ v).Norm());
		};
		const auto [cosineC, sineC] = cosineAndSine(mesh.apex(h));
		const auto [cosineD, sineD] = cosineAndSine(mesh.apex(mesh.twin(h)));
		const double sine = cosineC * sineD + sineC * cosineD;
		if (sine >= 0)
			return false;
		const double cosine = cosineC * cosineD - sineC * sineD;
		return cosine > 0 || sine * sine > margin * margin * (sine * sine + cosine * cosine);
	}

	/// Puts vertices of faces that turned over back to where they were until no face is turned.
	void restoreTurnedFaces(
		const std::vector<Point3d>& areaVectors, const std::vector<Point3d>& old, Ticker& ticker)
	{
		bool restored = true;
		while (restored) {
			restored = false;
			for (int f = 0; f < mesh.faceSlots(); ++f) {
				ticker.tick();
				if (!mesh.isFace(f))
					continue;
				const Point3d n = mesh.areaVector(f);
				const double cosine = n * areaVectors[f];
				if (cosine > 0 && cosine * cosine
						> collapseCosineSquared * n.SquaredNorm() * areaVectors[f].SquaredNorm())
					continue;
				for (int v : mesh.triangle(f))
					if (mesh.position[v] != old[v]) {
						mesh.position[v] = old[v];
						restored = true;
					}
			}
		}
	}

	/// Closes the holes in the numbering and brings neighbours together, for speed.
	void renumber()
	{
		std::vector<int> seeds(length.size(), -1);
		for (int v = mesh.vertexSlots() - 1; v >= 0; --v)
			if (mesh.isVertex(v))
				seeds[component[v]] = v;
		Numbering number = breadthFirstOrder(mesh, seeds);
		component = std::move(number.component);
		track = renumbered(track, number.vertex, mesh.vertexCount());
		if (!role.empty())
			role = renumbered(role, number.vertex, mesh.vertexCount());
		creases.beforeRenumber(mesh, number.face);
		mesh = mesh.renumbered(number.vertex, number.face);
	}
};

} // namespace vcg::tri::mcf::detail

#endif
