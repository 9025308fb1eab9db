// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Last line of Fig. 4 with sheets: a stage becomes curves and single-walled sheets.

#ifndef VCG_MCF_KEEP_SHEETS_H
#define VCG_MCF_KEEP_SHEETS_H

#include "merge_walls.h"
#include "meso_skeleton.h"
#include "remove_fins.h"
#include "smooth_sheets.h"
#include "vertex_kind.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/graph/skeleton_radius.h>
#include <skeleton/mesh/component_meshes.h>
#include <skeleton/mesh/marked_regions.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// A skeleton with sheets, and what became of the stage's sheets.
struct SheetCollapse
{
	MesoSkeleton skeleton;
	/// Connected sheets of the stage, and those of them that had to become curves: with them the
	/// result would not have had the topology of the shape, or would not have been inside it.
	int sheets = 0, givenUp = 0;
};

/// A curve skeleton as the result of a collapse that found no sheets.
inline SheetCollapse withoutSheets(const CurveSkeleton& curve)
{
	SheetCollapse result;
	result.skeleton.position = curve.position;
	result.skeleton.radius = curve.radius;
	result.skeleton.edges = curve.edges;
	result.skeleton.node = curve.node;
	return result;
}

namespace detail {

/// Moves the nodes into which held vertices have merged to the mean of these, and marks them.
/// @param nodeOf (vertex of the stage): its node.
template <class NodeOf>
void holdNodes(MesoSkeleton& skeleton, const Stage& stage, const NodeOf& nodeOf)
{
	if (stage.heldCount() == 0)
		return;
	const size_t n = skeleton.position.size();
	std::vector<Point3d> sum(n, Point3d(0, 0, 0));
	std::vector<int> count(n, 0);
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
		if (stage.held[v]) {
			const size_t node = size_t(nodeOf(v));
			sum[node] += stage.mesh.position[v];
			++count[node];
		}
	skeleton.held.assign(n, 0);
	for (size_t node = 0; node < n; ++node)
		if (count[node] > 0) {
			skeleton.held[node] = 1;
			skeleton.position[node] = sum[node] / count[node];
		}
}

/// Collapses what is not a sheet, then joins the walls of the sheets. The caller checks the
/// topology and sets the radii. @pre the stage has one component.
inline MesoSkeleton collapseAround(
	const Stage& stage, const std::vector<char>& sheet, double epsilon, const Progress& progress)
{
	constexpr double spacing = 4; // epsilon
	const int n = stage.mesh.vertexSlots();
	SurfaceMesh mesh = stage.mesh;
	std::vector<char> anchored = stage.held;
	for (int v = 0; v < n; ++v)
		if (sheet[v]) {
			anchored[v] = 1;
			if (stage.sheet[v] && stage.fixed[v] && !stage.held[v])
				mesh.position[v] = stage.pole[v];
		}
	GluedComplex complex(mesh, anchored);
	std::vector<char> isSheet = sheet;
	contractFaces(
		complex, false, [&](int A, int B) { return isSheet[A] && isSheet[B]; },
		[&](int A, int B) { isSheet[B] |= isSheet[A]; }, progress);
	contractShortCurveEdges(complex, stage, epsilon, isSheet);

	const double diagonal = stage.diagonal.front();
	std::vector<int> label(size_t(n), -1);
	const std::vector<FaceOfComplex> faces = complex.surfaceTriangles();
	std::vector<char> hasFace(size_t(n), 0);
	for (const FaceOfComplex& f : faces)
		for (int A : f)
			hasFace[size_t(A)] = 1;
	MesoSkeleton skeleton;
	std::vector<int> nodes;
	std::vector<Point3d> points;
	for (int A = 0; A < n; ++A)
		if (hasFace[size_t(A)]) {
			nodes.push_back(A);
			points.push_back(complex.position(A));
		}
	if (!nodes.empty()) {
		const Sites sites = spreadSites(points, spacing * epsilon * diagonal);
		std::vector<int> number(sites.position.size(), -1);
		for (size_t i = 0; i < nodes.size(); ++i) {
			int& id = number[sites.ofPoint[i]];
			if (id < 0) {
				id = int(skeleton.position.size());
				skeleton.position.push_back(sites.position[sites.ofPoint[i]]);
			}
			label[nodes[i]] = id;
		}
	}
	std::vector<EdgeOfComplex> curveEdges;
	for (int A = 0; A < n; ++A) {
		if (complex.find(A) != A)
			continue;
		if (label[A] < 0) {
			label[A] = int(skeleton.position.size());
			skeleton.position.push_back(complex.position(A));
		}
		for (int B : complex.curveNeighbours(A))
			if (A < B)
				curveEdges.push_back({A, B});
	}
	holdNodes(skeleton, stage, [&](int v) { return label[complex.find(v)]; });
	SiteComplex walls = imageComplex({}, faces, label);
	// An edge of a wall is not a curve, even if joining the walls removes it.
	std::set<EdgeOfComplex> curves = imageComplex(curveEdges, {}, label).edges;
	for (const EdgeOfComplex& e : walls.edges)
		curves.erase(e);
	fillTriangles(walls, {});
	openPockets(walls, skeleton.position, 2 * spacing * epsilon * diagonal);
	std::set<EdgeOfComplex> edges = walls.edges;
	edges.insert(curves.begin(), curves.end());
	skeleton.faces.assign(walls.faces.begin(), walls.faces.end());
	for (const FaceOfComplex& f : skeleton.faces)
		for (const EdgeOfComplex& e : edgesOf(f))
			edges.erase(e);
	skeleton.edges.assign(edges.begin(), edges.end());
	for (int v : stage.node)
		skeleton.node.push_back(label[complex.find(v)]);
	return skeleton;
}

} // namespace detail

/**
 * The vertices of a stage that are sheets: those that the flow keeps as such (see markSheets()) or,
 * if it keeps none, those of kind Sheet (see vertexKinds()). Parts of less than 0.5 % of the
 * squared diagonal, both walls counted, are left out.
 * @return 1 for such vertices, else 0. @throws Cancelled
 */
inline std::vector<char> sheetVertices(const Stage& stage, const Progress& progress = Progress())
{
	constexpr double smallestSheet = 0.005;
	std::vector<char> sheet = stage.sheet;
	if (!stage.hasSheets()) {
		const std::vector<VertexKind> kinds = vertexKinds(stage, progress.part(0, 0.8));
		for (size_t v = 0; v < kinds.size(); ++v)
			sheet[v] = kinds[v] == VertexKind::Sheet;
	}
	std::vector<double> minimum;
	for (double diagonal : stage.diagonal)
		minimum.push_back(smallestSheet * diagonal * diagonal);
	flipSmallParts(stage.mesh, vertexAreas(stage.mesh, progress.part(0.8, 0.9)), stage.component,
		minimum, 1, sheet, progress.part(0.9, 1));
	return sheet;
}

namespace detail {

/// collapseKeepingSheets() of a stage of one component.
inline SheetCollapse collapseOneKeepingSheets(
	const Stage& stage, const std::vector<char>& sheet, double epsilon, const Progress& progress)
{
	const SurfaceMesh& mesh = stage.mesh;
	const BettiNumbers solid = {1, 1 - mesh.eulerCharacteristic() / 2, 0};
	const std::vector<double> area = vertexAreas(mesh, progress.cancelOnly());
	std::vector<std::vector<int>> parts = markedParts(mesh, sheet, 1, progress.cancelOnly());
	std::stable_sort(parts.begin(), parts.end(),
		[&](const auto& a, const auto& b) { return areaOf(a, area) < areaOf(b, area); });
	SheetCollapse result;
	result.sheets = int(parts.size());

	const auto collapsed = [&](size_t first, size_t end) {
		std::vector<char> marks(sheet.size(), 0);
		for (size_t i = first; i < end; ++i)
			for (int v : parts[i])
				marks[v] = 1;
		return collapseAround(stage, marks, epsilon, progress);
	};
	const auto fits = [&](const MesoSkeleton& skeleton) { return skeleton.betti() == solid; };
	bool found = false;
	if (!parts.empty()) {
		result.skeleton = collapsed(0, parts.size());
		found = fits(result.skeleton);
	}
	if (!found && parts.size() > 1) {
		std::vector<std::vector<int>> sound;
		for (size_t i = 0; i < parts.size(); ++i)
			if (fits(collapsed(i, i + 1)))
				sound.push_back(parts[i]);
		parts = std::move(sound);
		for (size_t first = 0; first < parts.size() && !found; ++first) {
			result.skeleton = collapsed(first, parts.size());
			found = fits(result.skeleton);
			result.givenUp = result.sheets - int(parts.size() - first);
		}
	}
	if (!found) {
		result.givenUp = result.sheets;
		result.skeleton = withoutSheets(collapseToCurve(stage, epsilon, progress)).skeleton;
	}
	MesoSkeleton& skeleton = result.skeleton;
	std::vector<std::vector<int>> neighbours(skeleton.position.size());
	for (const auto& [a, b] : allEdges(skeleton.edges, skeleton.faces)) {
		neighbours[a].push_back(b);
		neighbours[b].push_back(a);
	}
	skeleton.radius =
		thicknessAlong(skeleton.position, neighbours, skeleton.node, *stage.surface, progress);
	// Where walls were joined badly a step may cut or close a loop: then it is left out.
	const BettiNumbers before = skeleton.betti();
	for (void (*tidied)(MesoSkeleton&) : {&removeFins, &openFolds, &removeWhiskers}) {
		MesoSkeleton candidate = skeleton;
		tidied(candidate);
		if (candidate.betti() == before)
			skeleton = std::move(candidate);
	}
	constexpr int smoothingRounds = 3;
	smoothSheets(skeleton, smoothingRounds);
	progress.report(1, "Collapsing to curves and sheets");
	return result;
}

/**
 * One component of a stage as a stage of its own, without volumes and surface triangles.
 * @param own         its mesh. @param ids for each vertex of that its id in the stage's mesh.
 * @param surfaceIds  its vertices on the surface.
 * @param newNumber   for each vertex of the stage its place among `ids`.
 */
inline Stage stageOfComponent(const Stage& stage, int c, const SurfaceMesh& own,
	const std::vector<int>& ids, const std::vector<int>& surfaceIds,
	const std::vector<int>& newNumber)
{
	std::vector<Point3d> surface;
	surface.reserve(surfaceIds.size());
	for (int s : surfaceIds)
		surface.push_back((*stage.surface)[size_t(s)]);
	Stage part;
	part.mesh = own;
	static_cast<VertexStates&>(part) = stage.picked(ids);
	part.component.assign(ids.size(), 0);
	part.diagonal = {stage.diagonal[size_t(c)]};
	part.initialArea = {stage.initialArea[size_t(c)]};
	part.area = {stage.area[size_t(c)]};
	part.surface = std::make_shared<const std::vector<Point3d>>(std::move(surface));
	if (stage.frames)
		part.frames =
			std::make_shared<const std::vector<PrincipalFrame>>(1, (*stage.frames)[size_t(c)]);
	for (int s : surfaceIds)
		part.node.push_back(newNumber[size_t(stage.node[size_t(s)])]);
	part.iteration = stage.iteration;
	part.epsilon = stage.epsilon;
	part.converged = stage.converged;
	return part;
}

} // namespace detail

/**
 * Turns a stage into curves and sheets: collapses the shortest edges as collapseToCurve() does, but
 * none between two vertices of sheets; then joins the two walls of each sheet on common sites, 4
 * epsilon apart. A site with held vertices stays where these are, in the middle of several.
 *
 * Each component is treated as if it were alone, and its nodes have consecutive numbers.
 *
 * Joining walls may close or open loops, where they touch elsewhere or are not close enough. So the
 * Betti numbers over GF(2) of each component are compared with those of its solid, (1, genus, 0). A
 * sheet that fails alone becomes curves; while the rest fail together, so does the smallest of
 * them. The result always has the topology of the shape: at worst it is a curve skeleton.
 *
 * @param sheet    1 for vertices of sheets, else 0, e.g. from sheetVertices().
 * @param epsilon  fraction of the diagonal of each component.
 * @throws SolverError, Cancelled. Complexity: O(S V log V) for S sheets.
 * Source: ours.
 */
inline SheetCollapse collapseKeepingSheets(const Stage& stage, const std::vector<char>& sheet,
	double epsilon, const Progress& progress = Progress())
{
	const int components = int(stage.diagonal.size());
	if (components == 1)
		return detail::collapseOneKeepingSheets(stage, sheet, epsilon, progress);
	const ComponentVertices onSurface(
		componentOfSurfaceVertices(stage, progress), components, progress.cancelOnly());
	const ComponentVertices onMesh(stage.component, components, progress.cancelOnly());
	std::vector<SheetCollapse> found(static_cast<size_t>(components));
	forEachComponent(stage.mesh, stage.component, components, progress,
		[&](int c, const SurfaceMesh& own, const std::vector<int>& ids, const Progress& part) {
			std::vector<char> ofOwn;
			for (int v : ids)
				ofOwn.push_back(sheet[size_t(v)]);
			found[size_t(c)] =
				detail::collapseOneKeepingSheets(detail::stageOfComponent(stage, c, own, ids,
													 onSurface.ids[size_t(c)], onMesh.place),
					ofOwn, epsilon, part);
		});
	SheetCollapse result;
	MesoSkeleton& all = result.skeleton;
	all.node.resize(stage.node.size());
	for (int c = 0; c < components; ++c) {
		const MesoSkeleton& one = found[size_t(c)].skeleton;
		const int first = int(all.position.size());
		all.position.insert(all.position.end(), one.position.begin(), one.position.end());
		all.radius.insert(all.radius.end(), one.radius.begin(), one.radius.end());
		for (const auto& [a, b] : one.edges)
			all.edges.push_back({first + a, first + b});
		for (const auto& [a, b, d] : one.faces)
			all.faces.push_back({first + a, first + b, first + d});
		for (size_t i = 0; i < one.node.size(); ++i)
			all.node[size_t(onSurface.ids[size_t(c)][i])] = first + one.node[i];
		result.sheets += found[size_t(c)].sheets;
		result.givenUp += found[size_t(c)].givenUp;
	}
	progress.report(1, "Collapsing to curves and sheets");
	return result;
}

} // namespace vcg::tri::mcf

#endif
