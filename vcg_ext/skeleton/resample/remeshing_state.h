// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A mesh that changes its connectivity and stays tied to the surface it came from.

#ifndef VCG_MCF_REMESHING_STATE_H
#define VCG_MCF_REMESHING_STATE_H

#include "degenerate_triangles.h"
#include "feature_edges.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// How a vertex may be merged into its neighbour.
enum class Merge {
	Never,
	Free,      ///< the merged vertex may lie anywhere
	IntoTarget ///< it must lie where the neighbour is
};

/**
 * A copy of an input surface that is remeshed, and its link to that surface.
 *
 * Every vertex has a half-edge of the surface: its triangle is the one the vertex was projected on
 * last, where the next projection starts to walk; of a vertex on a crease it is the crease edge
 * itself. Connectivity must change by the functions of this class only; positions may be set.
 */
class TrackedMesh
{
public:
	/**
	 * Starts as a copy of `surface`.
	 * @param surface           may have holes in its numbering; must outlive this object.
	 * @param componentOfVertex connected component of each vertex slot.
	 * @param targetLength      edge length of each component, in the unit of `surface`.
	 * @param localLength       edge length at each vertex slot, at most that of its component;
	 *                          empty if it is the same everywhere in a component.
	 * @throws Cancelled
	 */
	TrackedMesh(const SurfaceMesh& surface, const std::vector<int>& componentOfVertex,
		const std::vector<double>& targetLength, const std::vector<double>& localLength,
		const Progress& progress) :
			mesh(surface.copied(progress)),
			surface(surface),
			surfaceCreases(
				surface,
				[&](int v) {
					return shortestCrease
						* (localLength.empty() ? targetLength[componentOfVertex[v]]
											   : localLength[v]);
				},
				progress),
			surfaceRoles(surfaceCreases.roles(surface, progress.cancelOnly())),
			creases(surfaceCreases), role(surfaceRoles),
			component(copiedArray(componentOfVertex, progress)), length(targetLength),
			surfaceLength(localLength), own(copiedArray(localLength, progress)),
			track(filledArray(size_t(surface.vertexSlots()), -1, progress))
	{
		const Progress end = progress.cancelOnly();
		reportedLoop(
			surface.vertexSlots(), end, tracking, [&](int v) { track[v] = surface.outgoing(v); });
		if (surfaceCreases.empty())
			return;
		const int last = surface.halfEdgeSlots() - 1;
		reportedLoop(surface.halfEdgeSlots(), end, tracking, [&](int i) {
			if (surfaceCreases.isCrease(last - i))
				track[surface.origin(last - i)] = last - i;
		});
	}

	SurfaceMesh mesh;

	const std::vector<int>& componentOfVertex() const { return component; }
	double lengthAt(int v) const { return own.empty() ? length[component[v]] : own[v]; }
	/// The target length of the edge of h: the smaller one of its two ends.
	double lengthOf(int h) const
	{
		return own.empty() ? length[component[mesh.origin(h)]]
						   : std::min(own[mesh.origin(h)], own[mesh.target(h)]);
	}
	CreaseRole roleOf(int v) const { return role.empty() ? CreaseRole::Smooth : role[v]; }
	bool isCrease(int h) const { return creases.isCrease(h); }

	/// How origin(h) may be merged into target(h) as far as creases are concerned.
	Merge mergeOf(int h) const
	{
		if (role.empty())
			return Merge::Free;
		const CreaseRole from = role[mesh.origin(h)], to = role[mesh.target(h)];
		if (from == CreaseRole::Smooth)
			return to == CreaseRole::Smooth ? Merge::Free : Merge::IntoTarget;
		if (from == CreaseRole::Corner)
			return Merge::Never;
		if (!isCrease(h)) {
			// Creases stay apart, unless their distance would make needles.
			const double closest = closestCreases * lengthAt(mesh.origin(h));
			return to == CreaseRole::Crease && mesh.squaredLength(h) < closest * closest
				? Merge::IntoTarget
				: Merge::Never;
		}
		// Two crease edges must not fall into one.
		for (const int side : {h, mesh.twin(h)})
			if (isCrease(mesh.next(side)) && isCrease(mesh.previous(side)))
				return Merge::Never;
		return to == CreaseRole::Corner ? Merge::IntoTarget : Merge::Free;
	}

	/// Merges origin(h) into target(h). @pre mesh.isCollapsible(h), mergeOf(h) != Never
	void collapse(int h)
	{
		if (roleOf(mesh.origin(h)) == CreaseRole::Crease && !isCrease(h))
			role[mesh.target(h)] = CreaseRole::Corner; // two creases meet there
		creases.beforeCollapse(mesh, h);
		mesh.collapse(h);
	}

	/// @pre mesh.isFlippable(h), !isCrease(h)
	void flip(int h)
	{
		creases.beforeFlip(mesh, h);
		mesh.flip(h);
	}

	/**
	 * Splits the edge of h at its middle. The new vertex is not moved onto the surface: if it were,
	 * the halves of an edge might be longer than the whole, and splitting would not end.
	 * @return the new vertex.
	 */
	int split(int h)
	{
		const int a = mesh.origin(h), b = mesh.target(h);
		const int m = mesh.split(h, (mesh.position[a] + mesh.position[b]) / 2.0);
		creases.afterSplit(mesh, h);
		if (!patch.empty())
			for (const int side : {h, mesh.twin(h)})
				patch.push_back(patch[side / 3]);
		component.push_back(component[a]);
		if (!own.empty())
			own.push_back((own[a] + own[b]) / 2);
		if (!role.empty())
			role.push_back(isCrease(h) ? CreaseRole::Crease : CreaseRole::Smooth);
		track.push_back(
			roleOf(m) == CreaseRole::Crease ? creaseOfMiddle(a, b, m) : 3 * faceOfMiddle(a, b, m));
		return m;
	}

	/// Moves v to the point of the surface closest to `point`, or of its crease if it is on one.
	void moveOntoSurface(int v, const Point3d& point)
	{
		if (roleOf(v) == CreaseRole::Crease) {
			mesh.position[v] = trackCrease(surface, surfaceCreases, surfaceRoles, point, track[v]);
			measureLength(v);
			return;
		}
		int face = track[v] / 3;
		mesh.position[v] = trackSurface(surface, point, face);
		track[v] = 3 * face;
		measureLength(v);
	}

	/// Makes each triangle a patch; splits then divide patches into parts.
	/// @throws Cancelled
	void startPatches(const Progress& progress)
	{
		fillArray(patch, size_t(mesh.faceSlots()), -1, progress);
		fillArray(isInputPatch, size_t(mesh.faceSlots()), char(0), progress);
		reportedLoop(mesh.faceSlots(), progress, tracking, [&](int f) {
			patch[f] = f;
			isInputPatch[f] = mesh.isFace(f) && mesh.triangle(f) == surface.triangle(f);
		});
	}

	void endPatches()
	{
		std::vector<int>().swap(patch);
		std::vector<char>().swap(isInputPatch);
	}

	/// Whether the two triangles at h are parts of one patch, so that a flip keeps the shape.
	bool isInsidePatch(int h) const
	{
		return !patch.empty() && patch[h / 3] == patch[mesh.twin(h) / 3];
	}

	/// Closes the holes in the numbering and brings neighbours together, for speed.
	/// @throws Cancelled
	void renumber(const Progress& progress)
	{
		std::vector<int> seeds(length.size(), -1);
		const int last = mesh.vertexSlots() - 1;
		reportedLoop(mesh.vertexSlots(), progress.part(0, 0.1), tracking, [&](int i) {
			if (mesh.isVertex(last - i))
				seeds[component[last - i]] = mesh.outgoing(last - i);
		});
		Numbering number = breadthFirstOrder(mesh, seeds, progress.part(0.1, 0.4));
		component = std::move(number.component);
		track = renumbered(track, number.vertex, mesh.vertexCount());
		if (!own.empty())
			own = renumbered(own, number.vertex, mesh.vertexCount());
		if (!role.empty())
			role = renumbered(role, number.vertex, mesh.vertexCount());
		creases.beforeRenumber(mesh, number.face);
		mesh = mesh.renumbered(number.vertex, number.face, {}, progress.part(0.4, 1));
	}

	/// Closes the holes in the numbering in place, order kept.
	void compact()
	{
		creases.beforeCompact(mesh);
		const std::vector<int> newVertex = mesh.compact();
		keepAlive(component, newVertex);
		keepAlive(track, newVertex);
		if (!own.empty())
			keepAlive(own, newVertex);
		keepAlive(role, newVertex);
	}

	/// Hands over the mesh without thin triangles, numbered one component after the other. Only
	/// componentOfVertex() is valid afterwards.
	/// @throws Cancelled
	SurfaceMesh take(const Progress& progress)
	{
		creases = CreaseEdges();
		removeThinTriangles(
			mesh, [&](int v) { return lengthAt(v); }, progress.part(0, 0.2));
		renumber(progress.part(0.2, 1));
		return std::move(mesh);
	}

private:
	static constexpr const char* tracking = "Following the surface";
	/// A chain of sharp edges shorter than this is no crease; target lengths.
	static constexpr double shortestCrease = 6;
	/// Creases closer to each other than this are joined; target lengths.
	static constexpr double closestCreases = 0.25;

	const SurfaceMesh& surface;
	const CreaseEdges surfaceCreases;
	const std::vector<CreaseRole> surfaceRoles;

	CreaseEdges creases;
	std::vector<CreaseRole> role;      ///< of each vertex; empty if there are no creases
	std::vector<int> component;        ///< of each vertex
	std::vector<double> length;        ///< of each component
	std::vector<double> surfaceLength; ///< target length at each vertex of `surface`; may be empty
	std::vector<double> own;        ///< target length of each vertex; empty if `length` holds alone
	std::vector<int> track;         ///< of each vertex a half-edge of `surface`
	std::vector<int> patch;         ///< of each face its patch; empty if there are none
	std::vector<char> isInputPatch; ///< of each patch whether it is a triangle of `surface`

	/// Sets the target length of v: linear within the surface triangle that it is tracked on.
	void measureLength(int v)
	{
		if (own.empty())
			return;
		const Triangle t = surface.triangle(track[v] / 3);
		const double at[3] = {surfaceLength[t[0]], surfaceLength[t[1]], surfaceLength[t[2]]};
		if (at[0] == at[1] && at[1] == at[2]) {
			own[v] = at[0];
			return;
		}
		const Point3d &a = surface.position[t[0]], &p = mesh.position[v];
		const Point3d ab = surface.position[t[1]] - a, ac = surface.position[t[2]] - a;
		const Point3d normal = ab ^ ac;
		const double squared = normal.SquaredNorm();
		const double y = squared > 0 ? ((p - a) ^ ac) * normal / squared : 1.0 / 3;
		const double z = squared > 0 ? (ab ^ (p - a)) * normal / squared : 1.0 / 3;
		const auto [minimum, maximum] = std::minmax({at[0], at[1], at[2]});
		own[v] = std::clamp(at[0] + y * (at[1] - at[0]) + z * (at[2] - at[0]), minimum, maximum);
	}

	/// Keeps the entries of the vertices that remain, in their order.
	template <class T>
	static void keepAlive(std::vector<T>& ofVertex, const std::vector<int>& newVertex)
	{
		size_t alive = 0;
		for (size_t v = 0; v < ofVertex.size(); ++v)
			if (newVertex[v] >= 0)
				ofVertex[alive++] = ofVertex[v];
		ofVertex.resize(alive);
	}

	/// The crease edge of the surface that is closest to the middle m of the crease edge (a b).
	int creaseOfMiddle(int a, int b, int m) const
	{
		// A corner's own half-edge may belong to another crease: start from the other end.
		int h = roleOf(a) == CreaseRole::Crease ? track[a]
			: roleOf(b) == CreaseRole::Crease   ? track[b]
												: creaseBetween(a, b);
		trackCrease(surface, surfaceCreases, surfaceRoles, mesh.position[m], h);
		return h;
	}

	/// A crease edge of the surface on the crease from corner a to corner b, by its direction at a.
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

	/// The face of the surface that is closest to the middle m of the edge (a b).
	int faceOfMiddle(int a, int b, int m) const
	{
		if (!patch.empty())
			for (const int side : {mesh.outgoing(m), mesh.twin(mesh.outgoing(m))})
				if (isInputPatch[patch[side / 3]])
					return patch[side / 3];
		// A walk may be stopped at a fold, or start on the wrong side of a crease: try all sides.
		const Point3d& middle = mesh.position[m];
		int best = track[a] / 3;
		double bestDistance = SquaredDistance(trackSurface(surface, middle, best), middle);
		const auto consider = [&](int face) {
			const double distance = SquaredDistance(trackSurface(surface, middle, face), middle);
			if (distance < bestDistance) {
				bestDistance = distance;
				best = face;
			}
		};
		consider(track[b] / 3);
		for (const int end : {a, b})
			if (roleOf(end) == CreaseRole::Corner)
				surface.forEachOutgoing(
					surface.origin(track[end]), [&](int h) { consider(h / 3); });
			else if (roleOf(end) == CreaseRole::Crease)
				consider(surface.twin(track[end]) / 3);
		return best;
	}
};

} // namespace vcg::tri::mcf::detail

#endif
