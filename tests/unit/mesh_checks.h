// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What must hold of every mesh, stage and skeleton, said as the first thing that does not.

#ifndef MCFSKEL_TESTS_MESH_CHECKS_H
#define MCFSKEL_TESTS_MESH_CHECKS_H

#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/flow/stage.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace checks {

using namespace vcg::tri::mcf;
using vcg::Point3d;

/// Points in a box a tenth larger than the mesh's on each side, the same in each run.
inline std::vector<Point3d> randomPoints(const SurfaceMesh& mesh, int count)
{
	std::mt19937 random(5);
	const vcg::Box3d box = mesh.bounds();
	std::vector<Point3d> points;
	for (int i = 0; i < count; ++i) {
		Point3d p;
		for (int k = 0; k < 3; ++k)
			p[k] = box.min[k]
				+ (1.2 * random() / double(std::mt19937::max()) - 0.1) * (box.max[k] - box.min[k]);
		points.push_back(p);
	}
	return points;
}

/// Empty if the corner table is a closed two-manifold without double edges, in every detail.
inline std::string structureError(const SurfaceMesh& mesh)
{
	const auto at = [](const char* what, int id) { return what + (" " + std::to_string(id)); };
	std::vector<int> outgoingCount(mesh.vertexSlots(), 0);
	std::set<std::pair<int, int>> halfEdges;
	int faces = 0, vertices = 0;
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		if (!mesh.isFace(f))
			continue;
		++faces;
		const auto [a, b, c] = mesh.triangle(f);
		if (a == b || b == c || c == a)
			return at("a corner twice in face", f);
		for (int h = 3 * f; h < 3 * f + 3; ++h) {
			const int v = mesh.origin(h), t = mesh.twin(h);
			if (v < 0 || v >= mesh.vertexSlots() || !mesh.isVertex(v))
				return at("no vertex at the origin of half-edge", h);
			++outgoingCount[v];
			if (!mesh.isHalfEdge(t) || mesh.twin(t) != h || t == h)
				return at("no mutual twin of half-edge", h);
			if (mesh.origin(t) != mesh.target(h) || mesh.target(t) != v)
				return at("the twin does not run back at half-edge", h);
			if (!halfEdges.emplace(v, mesh.target(h)).second)
				return at("a double edge at half-edge", h);
		}
	}
	if (faces != mesh.faceCount())
		return "a wrong face count";
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		if (!mesh.isVertex(v)) {
			if (outgoingCount[v])
				return at("faces at the removed vertex", v);
			continue;
		}
		++vertices;
		if (mesh.origin(mesh.outgoing(v)) != v)
			return at("a wrong outgoing half-edge at vertex", v);
		if (mesh.valence(v) != outgoingCount[v])
			return at("more than one fan at vertex", v);
	}
	if (vertices != mesh.vertexCount())
		return "a wrong vertex count";
	if (size_t(mesh.vertexSlots()) != mesh.position.size())
		return "a wrong number of positions";
	return "";
}

/// Empty if all arrays of a stage fit together, and all numbers are finite.
inline std::string stageError(const Stage& stage)
{
	const std::string structure = structureError(stage.mesh);
	if (!structure.empty())
		return structure;
	const size_t n = size_t(stage.mesh.vertexSlots());
	if (stage.mesh.vertexCount() != int(n))
		return "a mesh that is not compact";
	if (stage.pole.size() != n || stage.poleRadius.size() != n || stage.fixed.size() != n
		|| stage.held.size() != n || stage.sheet.size() != n || stage.component.size() != n
		|| !(stage.epsilonLimit.empty() || stage.epsilonLimit.size() == n))
		return "an array of a wrong size";
	for (const Point3d& p : stage.mesh.position)
		if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
			return "a position that is not finite";
	if (stage.node.size() != stage.surface->size())
		return "a surface vertex without a node";
	for (int v : stage.node)
		if (v < 0 || v >= int(n))
			return "a node that does not exist";
	int components = 0;
	if (connectedComponents(stage.mesh, &components), components != int(stage.diagonal.size()))
		return "a wrong number of components";
	for (int f = 0; f < stage.mesh.faceSlots(); ++f) {
		const Triangle t = stage.mesh.triangle(f);
		if (stage.component[t[0]] != stage.component[t[1]]
			|| stage.component[t[1]] != stage.component[t[2]])
			return "a face between components";
	}
	return "";
}

/// Empty if the skeleton is a simple graph without edges of no length, and each surface vertex has
/// a node; `mayBePoint`: a component may be one edge of no length.
inline std::string skeletonError(const CurveSkeleton& skeleton, bool mayBePoint = false)
{
	const int n = int(skeleton.position.size());
	if (int(skeleton.radius.size()) != n)
		return "an array of a wrong size";
	for (const Point3d& p : skeleton.position)
		if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
			return "a position that is not finite";
	for (double r : skeleton.radius)
		if (!(r >= 0 && std::isfinite(r)))
			return "a node without a radius";
	std::set<std::array<int, 2>> edges;
	for (const auto& edge : skeleton.edges) {
		const auto [a, b] = edge;
		if (a < 0 || b <= a || b >= n)
			return "an edge whose nodes are not in order";
		if (!edges.insert(edge).second)
			return "a double edge";
		if (!mayBePoint && !(Distance(skeleton.position[a], skeleton.position[b]) > 0))
			return "an edge of no length";
	}
	if (!std::is_sorted(skeleton.edges.begin(), skeleton.edges.end()))
		return "edges that are not in order";
	for (int v : skeleton.node)
		if (v < 0 || v >= n)
			return "a surface vertex without a node";
	for (const auto& list : skeleton.neighbours())
		if (list.empty())
			return "a node without an edge";
	return "";
}

/// Whether two stages are the same, bit for bit.
inline bool sameBits(const Stage& a, const Stage& b)
{
	return a.mesh.position == b.mesh.position && a.mesh.triangles() == b.mesh.triangles()
		&& a.pole == b.pole && a.poleRadius == b.poleRadius && a.fixed == b.fixed
		&& a.held == b.held && a.sheet == b.sheet && a.component == b.component && a.node == b.node
		&& a.epsilonLimit == b.epsilonLimit && a.area == b.area && a.volume == b.volume
		&& a.iteration == b.iteration && a.converged == b.converged;
}

inline bool sameBits(const CurveSkeleton& a, const CurveSkeleton& b)
{
	return a.position == b.position && a.radius == b.radius && a.edges == b.edges
		&& a.node == b.node;
}

/// As if no vertex had a medial pole: the flow is then plain mean curvature flow.
inline PoleSet noPoles(const SurfaceMesh& mesh)
{
	PoleSet poles;
	poles.centre.assign(mesh.vertexSlots(), Point3d(0, 0, 0));
	poles.radius.assign(mesh.vertexSlots(), -1);
	return poles;
}

/// The stage before the first iteration of plain mean curvature flow.
inline Stage plainStage(const SurfaceMesh& mesh)
{
	return initialStage(mesh, noPoles(mesh));
}

/// Total genus of a closed mesh.
inline int genus(const SurfaceMesh& mesh)
{
	int components = 0;
	connectedComponents(mesh, &components);
	return components - mesh.eulerCharacteristic() / 2;
}

/// Sum of the solid angles of all triangles over 4 pi: 1 inside, 0 outside.
inline double windingNumber(const SurfaceMesh& mesh, const Point3d& x)
{
	double sum = 0;
	for (const Triangle& t : mesh.triangles()) {
		const Point3d a = mesh.position[t[0]] - x, b = mesh.position[t[1]] - x,
					  c = mesh.position[t[2]] - x;
		const double la = a.Norm(), lb = b.Norm(), lc = c.Norm();
		sum +=
			2 * std::atan2(a * (b ^ c), la * lb * lc + (a * b) * lc + (b * c) * la + (c * a) * lb);
	}
	return sum / (4 * M_PI);
}

} // namespace checks

#endif
