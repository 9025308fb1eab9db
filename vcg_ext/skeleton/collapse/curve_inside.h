// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Brings the parts of a curve that have left the solid that it came from back inside.

#ifndef VCG_MCF_CURVE_INSIDE_H
#define VCG_MCF_CURVE_INSIDE_H

#include "collapse_to_curve.h"
#include "curve_into_solid.h"

#include <skeleton/core/disjoint_sets.h>
#include <skeleton/core/progress.h>
#include <skeleton/flow/stage.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_radius.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/empty_balls.h>
#include <skeleton/spatial/solid_test.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/**
 * Whether balls that the surface does not enter prove that a curve is inside: they cover its edges,
 * and the winding number around one node of each connected part is not 0. False as well where the
 * curve nearly touches the surface, and where too many triangles would have to be looked at.
 * @param place of each node. @param edges pairs of nodes.
 * @throws Cancelled. Complexity: O(F + V log V) and O(log V) for each node.
 */
inline bool isCertainlyInside(const std::vector<Point3d>& place,
	const std::vector<std::array<int, 2>>& edges, const std::vector<Point3d>& surface,
	const std::vector<Triangle>& triangles, const Progress& progress)
{
	constexpr int cheapHalvings = 4, halvings = 16;
	constexpr int minSamples = 10000, samplesOfTriangle = 4; // looked at; then a tree is cheaper
	EmptyBallsOfSurface balls(surface, triangles, progress);
	const auto cheaply = [&](const Point3d& p) { return balls.radius(p); };
	int left = std::max(minSamples, samplesOfTriangle * int(triangles.size()));
	const auto exactly = [&](const Point3d& p) { return balls.largestRadius(p, left); };
	CoveredCurve covered =
		coveredCurve(place, edges, cheaply, cheapHalvings, progress, "Bringing the curve inside");
	std::vector<double>& radius = covered.radius;
	MergeForest parts(int(place.size()), progress);
	for (size_t e = 0; e < edges.size(); ++e) {
		const auto& [A, B] = edges[e];
		parts.join(A, B);
		if (covered.isCovered[e])
			continue;
		progress.check();
		const Point3d &a = place[A], &b = place[B];
		if (isCoveredByBalls(a, radius[A], b, radius[B], cheaply, cheapHalvings))
			continue; // an exact radius, found for another edge, is enough
		for (int end : {A, B})
			radius[end] = exactly(place[end]);
		if (!isCoveredByBalls(a, radius[A], b, radius[B], exactly, halvings))
			return false;
	}
	for (size_t A = 0; A < place.size(); ++A) {
		if (parts.find(int(A)) != int(A))
			continue;
		progress.check();
		int winding = 0;
		for (const Triangle& t : triangles)
			winding += crossingAbove(surface, t, place[A]);
		if (winding == 0 || (radius[A] <= 0 && exactly(place[A]) <= 0))
			return false;
	}
	return true;
}

} // namespace detail

/// How many components have lost parts of their curves, see TooFarOutside::CutOff.
struct CutCurves
{
	int components = 0;
	/// Which these are, see connectedComponents().
	std::vector<int> which;

	/// One plain line; empty if there are none.
	std::string text() const
	{
		return components == 0 ? ""
							   : "The curve of " + std::to_string(components)
				+ (components == 1 ? " component" : " components")
				+ " was far outside: only what could be brought inside is left.";
	}
};

/// What broughtInside() does with a curve that it cannot bring inside at a reasonable length.
enum class TooFarOutside {
	CutOff, ///< subtrees that are attached by an edge outside are removed
	Stay,
};

/**
 * Brings a curve inside the solids that it came from: nodes go to the middle of a chord of the
 * solid, edges are bent, with new nodes. Its topology is unchanged, as are nodes that are inside,
 * to the last bit. The flow smooths over a few edges, so that the curve of a coarse surface may cut
 * corners, and may turn a surface that crosses itself inside out.
 *
 * @param surface     the vertices of all components, mesh units, and @param triangles between them.
 * @param component   of each vertex; @param ofNode of each node, follows the nodes.
 * @param tooFar      for a component whose curve the detours inside would make longer than twice
 *        its
 *                    length plus three diagonals, as where a surface runs into itself all over.
 * @param cut         receives how many such components there are; may be null.
 * @return the curve; edges in order, new nodes last. Radii are not updated.
 * @post no node or edge is outside by more than 5e-7 of the diagonal, but for components that are
 *       too far outside and stay.
 * @throws SolverError, Cancelled. Complexity: O(F log F), and at most as much for each edge
 *        outside.
 */
inline CurveSkeleton broughtInside(CurveSkeleton skeleton, const std::vector<Point3d>& surface,
	const std::vector<Triangle>& triangles, const std::vector<int>& component, int components,
	std::vector<int>& ofNode, const Progress& progress = Progress(),
	TooFarOutside tooFar = TooFarOutside::CutOff, CutCurves* cut = nullptr)
{
	const Progress begin = progress.cancelOnly();
	const ComponentVertices vertices(component, components, begin);
	std::vector<std::vector<Triangle>> faces(components);
	detail::cancellableLoop(int(triangles.size()), begin, [&](int f) {
		const Triangle& t = triangles[f];
		faces[component[t[0]]].push_back(
			{vertices.place[t[0]], vertices.place[t[1]], vertices.place[t[2]]});
	});
	const std::vector<int>& node = skeleton.node;
	std::vector<std::vector<int>> nodes(components);
	std::vector<int> number(skeleton.position.size());
	for (size_t A = 0; A < number.size(); ++A) {
		number[A] = int(nodes[ofNode[A]].size());
		nodes[ofNode[A]].push_back(int(A));
	}
	std::vector<std::vector<std::array<int, 2>>> edges(components);
	for (const auto& [A, B] : skeleton.edges)
		edges[ofNode[A]].push_back({number[A], number[B]});
	std::vector<int> heir(skeleton.position.size());
	std::iota(heir.begin(), heir.end(), 0);
	CutCurves found;
	std::vector<std::array<int, 2>> all;
	const auto take = [&](int c, const std::vector<std::array<int, 2>>& ofComponent) {
		for (const auto& [i, j] : ofComponent)
			all.push_back({std::min(nodes[c][i], nodes[c][j]), std::max(nodes[c][i], nodes[c][j])});
	};
	for (int c = 0; c < components; ++c) {
		const Progress part = progress.part(double(c) / components, double(c + 1) / components);
		std::vector<Point3d> points, given;
		detail::cancellableLoop(int(vertices.ids[c].size()), begin,
			[&](int i) { points.push_back(surface[vertices.ids[c][i]]); });
		for (int A : nodes[c])
			given.push_back(skeleton.position[A]);
		if (detail::isCertainlyInside(
				given, edges[c], points, faces[c], part.part(0, 0.25).cancelOnly())) {
			take(c, edges[c]);
			continue;
		}
		const SolidTest solid(points, faces[c], part.part(0.25, 0.5));
		std::vector<Point3d> place;
		for (const Point3d& p : given)
			place.push_back(solid.in(p));
		const Progress bending = part.part(0.5, 1);
		using Curve = detail::CurveIntoSolid;
		Curve curve(solid, place, edges[c], bending);
		curve.merged.resize(place.size());
		for (size_t i = 0; i < points.size(); ++i)
			if (const int A = node[vertices.ids[c][i]]; A >= 0 && ofNode[A] == c)
				curve.merged[number[A]].push_back(int(i));
		const Curve::Outcome outcome = curve.bringInside();
		const bool isCut = outcome == Curve::Outcome::TooLong && tooFar == TooFarOutside::CutOff;
		std::vector<int> ofComponent;
		if (isCut) {
			++found.components;
			found.which.push_back(c);
			ofComponent = curve.cutOff();
		}
		std::vector<std::array<int, 2>> remaining = curve.curveEdges();
		if (outcome == Curve::Outcome::TooLong && !isCut)
			remaining = edges[c];
		else if (outcome != Curve::Outcome::AllInside) {
			for (size_t i = 0; i < curve.places().size(); ++i) {
				if (i >= nodes[c].size()) {
					nodes[c].push_back(int(skeleton.position.size()));
					heir.push_back(int(skeleton.position.size()));
					skeleton.position.push_back(Point3d(0, 0, 0));
					ofNode.push_back(c);
				}
				if (curve.changedNodes()[i])
					skeleton.position[nodes[c][i]] = solid.out(curve.places()[i]);
			}
			for (size_t i = 0; i < ofComponent.size(); ++i)
				heir[nodes[c][i]] = nodes[c][ofComponent[i]];
		}
		take(c, remaining);
	}
	std::sort(all.begin(), all.end());
	skeleton.edges = std::move(all);
	if (cut)
		*cut = found;
	if (found.components == 0)
		return skeleton;
	skeleton.radius.resize(skeleton.position.size(), 0);
	std::vector<int> ofRemaining;
	for (size_t A = 0; A < heir.size(); ++A)
		if (heir[A] == int(A))
			ofRemaining.push_back(ofNode[A]);
	ofNode = std::move(ofRemaining);
	return mergeNodes(skeleton, heir);
}

/**
 * For each component of a resampled surface the one of the surface that it was made from; empty if
 * they do not pair off. The majority decides, since a vertex may have a neighbouring body's node.
 * @param ofCurve    for each node of the curve the component of the resampled surface.
 * @param ofSurface  how many components that has.
 * @param node       for each vertex of the other surface its node.
 * @param component  of that vertex; there are `components`.
 * @throws Cancelled
 */
inline std::vector<int> resampledFrom(const std::vector<int>& ofCurve, int ofSurface,
	const std::vector<int>& node, const std::vector<int>& component, int components,
	const Cancellation& cancel)
{
	std::vector<std::map<int, int>> votes(static_cast<size_t>(components));
	detail::cancellableLoop(int(node.size()), cancel, [&](int v) {
		if (node[v] >= 0)
			++votes[size_t(component[v])][ofCurve[size_t(node[v])]];
	});
	std::vector<int> partner(static_cast<size_t>(ofSurface), -1);
	for (int c = 0; c < components; ++c) {
		const auto& count = votes[size_t(c)];
		const auto maximum = std::max_element(count.begin(), count.end(),
			[](const auto& a, const auto& b) { return a.second < b.second; });
		if (maximum == count.end() || maximum->first < 0 || partner[size_t(maximum->first)] >= 0)
			return {};
		partner[size_t(maximum->first)] = c;
	}
	return partner;
}

/**
 * Brings the curve of a resampled surface inside the one that was resampled, see broughtInside():
 * the edges of the resampling cut its corners. Radii are measured anew, significance is completed.
 *
 * @param surface  that the curve came from, to which its correspondence refers.
 * @param input    that was resampled.
 * @param node     for each of its vertices its node of the curve.
 * @post nothing has changed if all was inside, or if the surfaces' components do not pair off.
 * @throws SolverError, Cancelled. Complexity: O(F log F).
 */
inline void bringInsideInput(CurveSkeleton& curve, const SurfaceMesh& surface,
	const SurfaceMesh& input, const std::vector<int>& node, const Progress& progress = Progress())
{
	const Progress begin = progress.cancelOnly();
	int components = 0, ofSurface = 0;
	const std::vector<int> component = connectedComponents(input, &components, begin);
	const std::vector<int> ofCurve =
		componentOfNodes(curve, connectedComponents(surface, &ofSurface, begin));
	const std::vector<int> partner =
		resampledFrom(ofCurve, ofSurface, node, component, components, begin);
	if (partner.empty())
		return;
	std::vector<int> ofNode;
	for (int c : ofCurve) {
		if (c < 0 || partner[size_t(c)] < 0)
			return;
		ofNode.push_back(partner[size_t(c)]);
	}
	const size_t nodes = curve.position.size();
	const std::vector<Point3d> before = curve.position;
	std::vector<int> correspondence = std::exchange(curve.node, node);
	curve = broughtInside(std::move(curve), input.position, input.triangles(begin), component,
		components, ofNode, progress, TooFarOutside::Stay);
	curve.node = std::move(correspondence);
	if (curve.position == before)
		return;
	if (!curve.significance.empty()) {
		const std::vector<std::vector<int>> neighbours = curve.neighbours();
		const auto endOfWay = [&](int v, int next) {
			for (int last = v; size_t(next) >= nodes;) {
				const std::vector<int>& around = neighbours[size_t(next)];
				last = std::exchange(next, around[0] == last ? around[1] : around[0]);
			}
			return curve.significance[size_t(next)];
		};
		std::vector<double> added;
		for (size_t v = nodes; v < curve.position.size(); ++v)
			added.push_back(
				std::min(endOfWay(int(v), neighbours[v][0]), endOfWay(int(v), neighbours[v][1])));
		curve.significance.insert(curve.significance.end(), added.begin(), added.end());
	}
	curve.radius = curveThickness(curve, surface.position, progress);
}

/**
 * collapseToCurve(), then broughtInside(); the latter not if vertices are held, which the user may
 * want anywhere, nor if the triangles of the surface are not known.
 * @param cut  see broughtInside().
 * @throws SolverError, Cancelled.
 */
inline CurveSkeleton collapseInside(Stage stage, double shortestEdge = 1e-4,
	const Progress& progress = Progress(), CutCurves* cut = nullptr)
{
	const bool isKnown = stage.surfaceTriangles && stage.heldCount() == 0;
	if (!isKnown)
		return collapseToCurve(std::move(stage), shortestEdge, progress);
	const auto triangles = stage.surfaceTriangles;
	const auto surface = stage.surface;
	const int components = int(stage.diagonal.size());
	const std::vector<int> component = componentOfSurfaceVertices(stage, progress);
	CurveSkeleton curve = collapseToCurve(std::move(stage), shortestEdge, progress.part(0, 0.95));
	std::vector<int> ofNode(curve.position.size(), -1);
	for (size_t s = 0; s < component.size(); ++s)
		ofNode[curve.node[s]] = component[s];
	// A node of split vertices only belongs to the component of its neighbours.
	const std::vector<std::vector<int>> neighbours = curve.neighbours();
	std::vector<int> told;
	for (size_t A = 0; A < ofNode.size(); ++A)
		if (ofNode[A] >= 0)
			told.push_back(int(A));
	for (size_t i = 0; i < told.size(); ++i)
		for (int B : neighbours[told[i]])
			if (ofNode[B] < 0) {
				ofNode[B] = ofNode[told[i]];
				told.push_back(B);
			}
	const std::vector<Point3d> before = curve.position;
	curve = broughtInside(std::move(curve), *surface, *triangles, component, components, ofNode,
		progress.part(0.95, 1), TooFarOutside::CutOff, cut);
	if (curve.position != before)
		curve.radius = curveThickness(curve, *surface, progress);
	return curve;
}

} // namespace vcg::tri::mcf

#endif
