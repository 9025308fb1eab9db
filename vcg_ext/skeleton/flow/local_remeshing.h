// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Local dynamic remeshing (Sec. 4.3): short edges are collapsed, wide angles split.

#ifndef VCG_MCF_LOCAL_REMESHING_H
#define VCG_MCF_LOCAL_REMESHING_H

#include "stage.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Sorts edges, each as its squared length and a half-edge: a bucket sort, with as many buckets of
/// equal width as there are edges. Complexity: O(n) for evenly spread lengths, else O(n log n).
inline void sortByLength(std::vector<std::pair<double, int>>& edges)
{
	double largest = std::numeric_limits<double>::min();
	for (const auto& [squaredLength, h] : edges)
		largest = std::max(largest, squaredLength);
	const auto partOf = [&](double squaredLength) {
		return size_t(squaredLength / largest * double(edges.size() - 1));
	};
	std::vector<int> start(edges.size() + 1, 0);
	for (const auto& [squaredLength, h] : edges)
		++start[partOf(squaredLength) + 1];
	std::partial_sum(start.begin(), start.end(), start.begin());
	std::vector<std::pair<double, int>> inParts(edges.size());
	for (const auto& edge : edges)
		inParts[start[partOf(edge.first)]++] = edge;
	for (size_t part = 0, first = 0; part < edges.size(); first = start[part++])
		std::sort(inParts.begin() + first, inParts.begin() + start[part]);
	edges.swap(inParts);
}

/// Whether each half-edge of a triangle is opposite to an angle whose cosine may be below `widest`:
/// at most one is, unless the triangle is a line. Conservative: the cosine may be above by
/// rounding. @pre widest <= 0
inline std::array<bool, 3> maybeWideAngles(const SurfaceMesh& mesh, int face, double widest)
{
	constexpr double rounding = 1e-9;
	const auto [i, j, k] = mesh.triangle(face);
	const Point3d &a = mesh.position[i], &b = mesh.position[j], &c = mesh.position[k];
	const double ab = SquaredDistance(a, b), bc = SquaredDistance(b, c), ca = SquaredDistance(c, a);
	const double sum = (ab + bc + ca) * (1 - rounding), minimum = 4 * widest * widest;
	// The law of cosines for squared lengths: edge = one + other - 2 cosine sqrt(one other).
	const auto isWide = [&](double edge, double one, double other) -> bool {
		const double excess = 2 * edge - sum;
		return (excess > 0) & (excess * excess >= minimum * (one * other));
	};
	return {isWide(ab, bc, ca), isWide(bc, ca, ab), isWide(ca, ab, bc)};
}

/// The edges that splitWideAngles() starts with, each by the lower of its half-edges, and which of
/// them are due for a test.
class EdgesToSplit
{
public:
	/// @throws Cancelled
	EdgesToSplit(const SurfaceMesh& mesh, double widest, const Cancellation& cancel) :
			mesh(mesh), state(mesh.halfEdgeSlots())
	{
		cancellableLoop(
			mesh.halfEdgeSlots(), cancel, [&](int h) { state[h] = h < mesh.twin(h) ? edge : 0; });
		// One spare, for the branchless writes.
		std::vector<int> wide = filledArray(state.size() + 1, 0, cancel);
		size_t count = 0;
		cancellableLoop(mesh.faceSlots(), cancel, [&](int f) {
			if (!mesh.isFace(f))
				return;
			const std::array<bool, 3> atFace = widest > 0 ? std::array<bool, 3> {true, true, true}
														  : maybeWideAngles(mesh, f, widest);
			for (int k = 0; k < 3; ++k) { // branchless: the condition is unpredictable
				wide[count] = 3 * f + k;
				count += atFace[k];
			}
		});
		std::vector<char> isWide(state.size(), 0);
		for (size_t i = 0; i < count; ++i)
			isWide[wide[i]] = due;
		for (size_t i = 0; i < count; ++i)
			state[wide[i]] |= isWide[mesh.twin(wide[i])];
	}

	size_t size() const { return state.size(); }
	/// The first due edge from h on, size() if there is none; h itself if h >= size().
	size_t nextDue(size_t h) const
	{
		if (h >= size())
			return h;
		const void* const found = std::memchr(&state[h], edge | due, size() - h);
		return found ? size_t(static_cast<const char*>(found) - state.data()) : size();
	}
	/// Makes the edges of a changed triangle due; no effect on those that were tested before.
	void touch(int face)
	{
		for (int h = 3 * face; h < 3 * face + 3; ++h)
			for (int side : {h, mesh.twin(h)})
				if (size_t(side) < state.size())
					state[side] |= due;
	}

private:
	static constexpr char edge = 1, due = 2;
	const SurfaceMesh& mesh;
	std::vector<char> state;
};

} // namespace detail

/**
 * Collapses edges shorter than the smaller epsilon of their ends, see Stage::epsilonAt(), shortest
 * first, wherever the link condition allows it, until none is left. The merged vertex goes to the
 * middle, or to the fixed end if one end is fixed; an edge between two fixed vertices stays.
 *
 * @param epsilon as in Parameters. @param forest gets every merge.
 * @return the vertices of short edges that cannot be collapsed: candidates for
 *         fixDegenerateVertices(), ordered by id.
 * @throws Cancelled. Complexity: O(V + c log c) for c short edges.
 */
inline std::vector<int> collapseShortEdges(
	Stage& stage, double epsilon, MergeForest& forest, const Progress& progress = Progress())
{
	SurfaceMesh& mesh = stage.mesh;
	using Entry = std::pair<double, int>; // squared length, half-edge
	const auto entry = [&](int h) {
		return Entry(mesh.squaredLength(h), std::min(h, mesh.twin(h)));
	};
	std::vector<double> squaredLimit; // by component
	for (double diagonal : stage.diagonal)
		squaredLimit.push_back(epsilon * diagonal * (epsilon * diagonal));
	const bool isLocal = !stage.epsilonLimit.empty();
	const auto squaredLimitOf = [&](int a, int b) {
		if (!isLocal)
			return squaredLimit[stage.component[a]];
		const double minimum = std::min(stage.epsilonAt(a, epsilon), stage.epsilonAt(b, epsilon));
		return minimum * minimum;
	};
	const auto mayCollapse = [&](const Entry& e) {
		const int a = mesh.origin(e.second), b = mesh.target(e.second);
		return e.first < squaredLimitOf(a, b) && !(stage.fixed[a] && stage.fixed[b]);
	};
	// The edges of a round are sorted at once; the few that collapses make short wait in a queue.
	std::vector<Entry> sorted;
	std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> fresh;
	std::vector<int> blocked;
	// A blocked edge stays blocked until the ring of one of its ends changes.
	std::vector<char> changed(mesh.vertexSlots(), 0);
	const auto collapseQueued = [&] {
		detail::sortByLength(sorted);
		size_t next = 0;
		const auto pop = [&] {
			if (next < sorted.size() && (fresh.empty() || sorted[next] < fresh.top()))
				return sorted[next++];
			const Entry top = fresh.top();
			fresh.pop();
			return top;
		};
		size_t count = 0;
		while (next < sorted.size() || !fresh.empty()) {
			if (++count % 65536 == 0)
				progress.report(0, "Collapsing short edges");
			const auto [squaredLength, h] = pop();
			if (!mesh.isHalfEdge(h) || mesh.squaredLength(h) != squaredLength)
				continue; // it has changed since, and was queued again if it is still short
			const int a = mesh.origin(h), b = mesh.target(h);
			if (stage.fixed[a] && stage.fixed[b])
				continue;
			const Point3d merged = stage.fixed[a] ? mesh.position[a]
				: stage.fixed[b]                  ? mesh.position[b]
								 : Point3d((mesh.position[a] + mesh.position[b]) / 2.0);
			const bool isFixed = stage.fixed[a] || stage.fixed[b];
			const int lower = !isLocal || stage.epsilonLimit[b] < stage.epsilonLimit[a] ? b : a;
			const bool isCollapsed = mesh.collapseIfPossible(h, [&](int e) {
				const int c = mesh.target(e);
				changed[c] = 1;
				const double newSquaredLength = SquaredDistance(merged, mesh.position[c]);
				if (newSquaredLength < squaredLimitOf(lower, c) && !(isFixed && stage.fixed[c]))
					fresh.emplace(newSquaredLength, std::min(e, mesh.twin(e)));
			});
			if (!isCollapsed) {
				blocked.push_back(h);
				continue;
			}
			mesh.position[b] = merged;
			forest.merge(a, b);
			stage.merge(a, b, mesh.position[b]);
			changed[b] = 1;
		}
		sorted.clear();
	};
	// Face by face each edge is measured twice, but memory is read in order, and few are short.
	const Progress cancel = progress.cancelOnly();
	detail::cancellableLoop(mesh.faceSlots(), cancel, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const auto [a, b, c] = mesh.triangle(f);
		const Point3d &p = mesh.position[a], &q = mesh.position[b], &r = mesh.position[c];
		const double limit = squaredLimit[stage.component[a]];
		const double squaredLengths[3] = {
			SquaredDistance(p, q), SquaredDistance(q, r), SquaredDistance(r, p)};
		if (std::min({squaredLengths[0], squaredLengths[1], squaredLengths[2]}) >= limit)
			return;
		for (int k = 0; k < 3; ++k)
			if (squaredLengths[k] < limit && mesh.isEdge(3 * f + k)) // mayCollapse() looks closer
				if (const Entry e(squaredLengths[k], 3 * f + k); mayCollapse(e))
					sorted.push_back(e);
	});
	collapseQueued();
	// A collapse elsewhere may have freed a blocked edge.
	for (;;) {
		const auto stays = std::partition(blocked.begin(), blocked.end(), [&](int h) {
			return !mesh.isHalfEdge(h) || !(changed[mesh.origin(h)] || changed[mesh.target(h)]);
		});
		for (auto h = stays; h != blocked.end(); ++h)
			if (const Entry e = entry(*h); mayCollapse(e))
				sorted.push_back(e);
		blocked.erase(stays, blocked.end());
		if (sorted.empty())
			break;
		std::fill(changed.begin(), changed.end(), 0);
		collapseQueued();
	}
	std::vector<char> isCandidate(mesh.vertexSlots(), 0);
	for (int h : blocked)
		if (mesh.isHalfEdge(h))
			isCandidate[mesh.origin(h)] = isCandidate[mesh.target(h)] = 1;
	std::vector<int> candidates;
	detail::cancellableLoop(mesh.vertexSlots(), cancel, [&](int v) {
		if (isCandidate[v] && mesh.isVertex(v))
			candidates.push_back(v);
	});
	return candidates;
}

/**
 * Splits edges whose two opposite angles are both wider than `splitAngle`, until none is left whose
 * parts would be at least epsilon long. The new vertex is the projection of the apex with the wider
 * angle onto the edge; it has no pole, except within a sheet, see VertexStates::addBetween().
 * Components without a free vertex rest: nothing is split there.
 *
 * The paper splits on one wide angle; taken literally this never ends, since the new edge may be
 * opposite to a wide angle in turn. With both angles above 90 degrees, alpha + beta > 180 degrees,
 * a Delaunay triangulation would not have the edge, and the process ends.
 * @param forest gets every new vertex.
 * @throws Cancelled. Complexity: O(V + s) for s splits.
 */
inline void splitWideAngles(Stage& stage, const Parameters& parameters, MergeForest& forest,
	const Progress& progress = Progress())
{
	SurfaceMesh& mesh = stage.mesh;
	const double widest = std::cos(parameters.splitAngle * M_PI / 180);
	// Cosine of the angle at the apex of h if it is wide, else 2.
	const auto wideCosine = [&](int h) {
		const Point3d& c = mesh.position[mesh.apex(h)];
		const Point3d u = mesh.position[mesh.origin(h)] - c, v = mesh.position[mesh.target(h)] - c;
		const double dot = u * v;
		if (dot >= 0 && widest <= 0)
			return 2.0;
		const double lengths = std::sqrt(u.SquaredNorm() * v.SquaredNorm());
		return lengths > 0 && dot / lengths < widest ? dot / lengths : 2.0;
	};
	// The initial edges are tested in the order of their ids, then those of new triangles.
	const Progress cancel = progress.cancelOnly();
	detail::EdgesToSplit initial(mesh, widest, cancel);
	std::vector<int> queue;
	std::vector<char> moves(stage.diagonal.size(), 0); // by component
	detail::cancellableLoop(mesh.vertexSlots(), cancel, [&](int v) {
		if (!stage.fixed[v] && mesh.isVertex(v))
			moves[stage.component[v]] = 1;
	});
	// Each split shortens the longest edge of its triangles; the cap is for the worst case only.
	const size_t maxVertices = 4 * size_t(mesh.vertexCount()) + 1000;
	size_t looked = 0;
	for (size_t next = initial.nextDue(0);
		 next < initial.size() + queue.size() && size_t(mesh.vertexCount()) < maxVertices;
		 next = initial.nextDue(next + 1)) {
		if (++looked % 65536 == 0)
			progress.report(0, "Splitting wide angles");
		const int h = next < initial.size() ? int(next) : queue[next - initial.size()];
		const double cosine = wideCosine(h);
		if (cosine > 1)
			continue;
		const double twinCosine = wideCosine(mesh.twin(h));
		if (twinCosine > 1)
			continue;
		const int a = mesh.origin(h), b = mesh.target(h);
		if (!moves[stage.component[a]])
			continue;
		const double limit = std::min(
			stage.epsilonAt(a, parameters.epsilon), stage.epsilonAt(b, parameters.epsilon));
		const Point3d along = mesh.position[b] - mesh.position[a];
		const double squaredLength = along.SquaredNorm();
		const int apex = cosine < twinCosine ? mesh.apex(h) : mesh.apex(mesh.twin(h));
		const double t = ((mesh.position[apex] - mesh.position[a]) * along) / squaredLength;
		if (std::min(t, 1 - t) * std::sqrt(squaredLength) < limit)
			continue; // a half shorter than epsilon: the next collapse would undo the split
		// A triangle of held corners keeps its place.
		const bool held = stage.held[a] && stage.held[b]
			&& (stage.held[mesh.apex(h)] || stage.held[mesh.apex(mesh.twin(h))]);
		const int m = mesh.split(h, mesh.position[a] + along * t);
		forest.add();
		stage.addBetween(a, b, t, mesh.position[m], held);
		mesh.forEachOutgoing(m, [&](int e) {
			queue.push_back(e);
			queue.push_back(SurfaceMesh::next(e));
			initial.touch(e / 3);
		});
	}
}

} // namespace vcg::tri::mcf

#endif
