// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Last line of Fig. 4: the shortest edges are collapsed until only curves are left.

#ifndef VCG_MCF_COLLAPSE_TO_CURVE_H
#define VCG_MCF_COLLAPSE_TO_CURVE_H

#include "curve_spurs.h"
#include "glued_complex.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/flow/stage.h>
#include <skeleton/flow/stage_frames.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_radius.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * Contracts edges that have faces, shortest first, until no face is left, or none but at edges that
 * are kept.
 *
 * An edge that a cycle of the shape blocks waits until nothing else can be contracted. Then edges
 * that only one flat piece has are taken away with it, longest first; where there is none, a piece
 * is cut at a pinch; where there is no pinch either, balls are emptied through a face that no other
 * piece shares. All of it ends: a cut lowers a piece's genus or parts it, the rest removes cells.
 * @param isKept      (A, B): whether an edge is to stay.
 * @param onContract  (A, B) when A has merged into B.
 * @return whether no face is left.
 */
template <class IsKept, class OnContract>
bool contractFaces(GluedComplex& complex, bool openBalls, const IsKept& isKept,
	const OnContract& onContract, const Progress& progress)
{
	using Entry = std::tuple<double, int, int>; // squared length, nodes
	std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> shortest;
	const auto push = [&](int A, int B) {
		shortest.emplace(complex.squaredLength(A, B), std::min(A, B), std::max(A, B));
	};
	for (const auto& [A, B] : complex.surfaceEdges())
		if (!isKept(A, B))
			push(A, B);
	const double allFaces = complex.faceCount();
	double done = 0; // cuts add faces: the bar waits for them to go again
	std::vector<Entry> blocked;
	size_t count = 0;
	while (complex.faceCount() > 0) {
		bool contracted = false;
		while (!shortest.empty()) {
			if (++count % 4096 == 0) {
				done = std::max(done, 1 - complex.faceCount() / allFaces);
				progress.report(done, "Collapsing to curves");
			}
			const auto [length, A, B] = shortest.top();
			shortest.pop();
			if (complex.find(A) != A || complex.find(B) != B
				|| complex.squaredLength(A, B) != length || isKept(A, B))
				continue;
			switch (complex.contract(A, B)) {
			case GluedComplex::Outcome::NoFaces: break;
			case GluedComplex::Outcome::Blocked: blocked.emplace_back(length, A, B); break;
			case GluedComplex::Outcome::Contracted:
				contracted = true;
				onContract(A, B);
				for (int C : complex.surfaceNeighbours(B))
					if (!isKept(B, C))
						push(B, C);
			}
		}
		if (contracted) {
			for (const Entry& entry : blocked)
				shortest.push(entry);
			blocked.clear();
			continue;
		}
		// Only blocked edges are left, the shortest first.
		const auto free = std::count_if(blocked.rbegin(), blocked.rend(), [&](const Entry& entry) {
			return complex.removeFreeEdge(std::get<1>(entry), std::get<2>(entry));
		});
		const auto cut = [&](const Entry& entry) {
			return complex.cut(std::get<1>(entry), std::get<2>(entry));
		};
		if (free == 0 && std::none_of(blocked.begin(), blocked.end(), cut)
			&& !(openBalls && complex.emptyBalls()))
			return false;
		for (const Entry& entry : blocked)
			shortest.push(entry);
		blocked.clear();
	}
	return true;
}

/// Contracts until no face is left.
/// @throws SolverError if that is not possible: no shape is known where this happens.
inline void contractAllFaces(GluedComplex& complex, const Progress& progress)
{
	const auto none = [](int, int) { return false; };
	if (!contractFaces(
			complex, true, none, [](int, int) {}, progress))
		throw SolverError("The stage could not be collapsed to curves.");
}

/// The smaller of the lengths at two nodes, see Stage::epsilonAt().
inline double lengthAt(const Stage& stage, int A, int B, double ofDiagonal)
{
	return std::min(stage.epsilonAt(A, ofDiagonal), stage.epsilonAt(B, ofDiagonal));
}

/// Merges nodes that are closer than `shortestEdge`, see lengthAt(); each component keeps an edge.
/// @param stays  1 for nodes that have to stay; empty if there are none.
inline void contractShortCurveEdges(GluedComplex& complex, const Stage& stage, double shortestEdge,
	const std::vector<char>& stays = {})
{
	const auto mayMerge = [&](int A) { return stays.empty() || !stays[A]; };
	const auto contractOneAt = [&](int A) {
		for (int B : complex.curveNeighbours(A)) {
			const bool lastEdge =
				complex.curveNeighbours(A).size() == 1 && complex.curveNeighbours(B).size() == 1;
			const double limit = lengthAt(stage, A, B, shortestEdge);
			if (!lastEdge && mayMerge(A) && mayMerge(B)
				&& complex.squaredLength(A, B) < limit * limit && complex.contractCurveEdge(B, A))
				return true;
		}
		return false;
	};
	for (int A = 0; A < stage.mesh.vertexSlots(); ++A) {
		while (complex.find(A) == A && contractOneAt(A)) {
		}
	}
}

/**
 * Smooths the zigzag of about the length of an edge that the order of the collapses leaves in the
 * curves: twice, each node with two neighbours moves half the way to their middle, but by at most
 * four times `shortestEdge`: larger bends are the shape's. Held nodes, tips and junctions stay.
 */
inline void straightenZigzag(GluedComplex& complex, const Stage& stage, double shortestEdge)
{
	constexpr int rounds = 2;
	constexpr double farthest = 4;
	for (int round = 0; round < rounds; ++round) {
		std::vector<std::pair<int, Point3d>> moved;
		for (int A = 0; A < stage.mesh.vertexSlots(); ++A) {
			if (complex.find(A) != A || complex.curveNeighbours(A).size() != 2 || complex.isHeld(A))
				continue;
			const std::set<int>& ends = complex.curveNeighbours(A);
			const Point3d middle =
				(complex.position(*ends.begin()) + complex.position(*ends.rbegin())) / 2;
			Point3d move = (middle - complex.position(A)) / 2;
			const double maximum = farthest * stage.epsilonAt(A, shortestEdge);
			const double length = move.Norm();
			if (length > maximum)
				move *= maximum / length;
			moved.emplace_back(A, complex.position(A) + move);
		}
		for (const auto& [A, place] : moved)
			complex.moveTo(A, place);
	}
}

} // namespace detail

/**
 * Turns a stage into its curve skeleton: repeatedly collapses the shortest edge that has faces,
 * then, with `tidy`, straightens the zigzag that this leaves and removes the spurs. Lengths are
 * compared in the frames of the components, see StageFrames.
 *
 * The stage need not have converged; its sheets and volumes become curves too. The result has a
 * component for each component of the stage and as many cycles as its genus (see GluedComplex), no
 * double edge and no edge of zero length but for a body that is a point in floating point.
 *
 * @param shortestEdge edges shorter than this fraction of the component's diagonal, or than
 *        Stage::epsilonLimit where that is smaller, are contracted at the end, where no cycle
 *        vanishes by it.
 * @param tidy         without, the curve is what the collapses leave, as in the paper.
 * @throws SolverError, Cancelled. Complexity: O(V log V), with `tidy` and that of withoutSpurs().
 */
inline CurveSkeleton collapseToCurve(Stage stage, double shortestEdge = 1e-4,
	const Progress& progress = Progress(), bool tidy = true)
{
	StageFrames frames(stage, progress.cancelOnly());
	frames.enter(stage, progress.cancelOnly());
	GluedComplex complex(stage.mesh, stage.held);
	detail::contractAllFaces(complex, progress.part(0, 0.9));

	if (tidy)
		detail::straightenZigzag(complex, stage, shortestEdge);
	detail::contractShortCurveEdges(complex, stage, shortestEdge);

	const char* const what = "Collapsing to curves";
	CurveSkeleton skeleton;
	std::vector<int> number(complex.nodeSlots(), -1), component;
	std::vector<char> held;
	for (int A = 0; A < complex.nodeSlots(); ++A)
		if (complex.find(A) == A) {
			number[A] = int(skeleton.position.size());
			skeleton.position.push_back(frames.out(stage.component[A], complex.position(A)));
			component.push_back(stage.component[A]);
			held.push_back(complex.isHeld(A));
		}
	for (int A = 0; A < complex.nodeSlots(); ++A)
		if (number[A] >= 0)
			for (int B : complex.curveNeighbours(A))
				if (A < B)
					skeleton.edges.push_back({number[A], number[B]});
	skeleton.node.reserve(stage.node.size());
	detail::reportedLoop(int(stage.node.size()), progress.part(0.9, 0.95), what,
		[&](int s) { skeleton.node.push_back(number[complex.find(stage.node[s])]); });

	constexpr double spurProminence = 0.12; // above a tenth: balls reach to vertices only
	skeleton.radius.assign(skeleton.position.size(), 0);
	if (tidy)
		skeleton = detail::withoutSpurs(
			std::move(skeleton), stage, component, held, spurProminence, progress.part(0.95, 1));

	skeleton.radius = curveThickness(skeleton, *stage.surface, progress);
	progress.report(1, what);
	return skeleton;
}

} // namespace vcg::tri::mcf

#endif
