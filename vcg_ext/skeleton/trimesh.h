// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Conversion between VCG meshes of any type and the arrays and meshes of this library.

#ifndef VCG_MCF_TRIMESH_H
#define VCG_MCF_TRIMESH_H

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/complex/complex.h>

#include <array>
#include <string>
#include <typeindex>
#include <vector>

namespace vcg::tri::mcf {

/// The vertices and triangles of a VCG mesh, deleted elements left out.
struct TriangleSoup
{
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
	/// For each vertex slot of the mesh the index of its point, -1 for deleted vertices.
	std::vector<int> pointOfSlot;
};

/**
 * Reads the triangles of a VCG mesh, which may have deleted elements.
 * @throws InvalidInput if a face has more than three corners; Cancelled. Complexity: O(V + F).
 */
template <class MeshType>
TriangleSoup readTriangles(const MeshType& mesh, const Progress& progress = Progress())
{
	const char* const what = "Reading the surface";
	TriangleSoup soup;
	soup.points.reserve(size_t(mesh.VN()));
	soup.pointOfSlot.reserve(mesh.vert.size());
	detail::reportedLoop(int(mesh.vert.size()), progress.part(0, 0.3), what, [&](int slot) {
		const auto& v = mesh.vert[size_t(slot)];
		soup.pointOfSlot.push_back(v.IsD() ? -1 : int(soup.points.size()));
		if (!v.IsD())
			soup.points.push_back(Point3d::Construct(v.cP()));
	});
	soup.triangles.reserve(size_t(mesh.FN()));
	detail::reportedLoop(int(mesh.face.size()), progress.part(0.3, 1), what, [&](int i) {
		const auto& face = mesh.face[size_t(i)];
		if (face.IsD())
			return;
		if (face.VN() != 3)
			throw InvalidInput("A face has " + std::to_string(face.VN())
				+ " corners: a mesh of triangles is needed.");
		Triangle triangle;
		for (int k = 0; k < 3; ++k)
			triangle[size_t(k)] = soup.pointOfSlot[vcg::tri::Index(mesh, face.cV(k))];
		soup.triangles.push_back(triangle);
	});
	return soup;
}

/**
 * Checks that a mesh can have a per-vertex attribute of this name, of the mesh's scalar type.
 * @throws InvalidInput if it has one of another type: VCG would take its memory for scalars.
 */
template <class MeshType>
void requireScalarAttribute(const MeshType& mesh, const char* name)
{
	for (const auto& attribute : mesh.vert_attr)
		if (attribute._name == name
			&& attribute._type != std::type_index(typeid(typename MeshType::ScalarType)))
			throw InvalidInput(
				std::string("The mesh has a vertex attribute ") + name + " of another type.");
}

/// Writes a per-vertex attribute of the mesh's scalar type. @param valueOf of a vertex slot.
/// @pre requireScalarAttribute() passes. Complexity: O(V).
template <class MeshType, class ValueOf>
void writeScalarAttribute(MeshType& mesh, const char* name, const ValueOf& valueOf)
{
	using Scalar = typename MeshType::ScalarType;
	auto attribute =
		vcg::tri::Allocator<MeshType>::template GetPerVertexAttribute<Scalar>(mesh, name);
	for (size_t slot = 0; slot < mesh.vert.size(); ++slot)
		if (!mesh.vert[slot].IsD())
			attribute[slot] = Scalar(valueOf(slot));
}

/// Replaces the contents of a VCG mesh by points, edges and faces. Complexity: O(V + E + F).
/// @pre the mesh type has edges unless `edges` is empty, and faces unless `faces` is.
template <class MeshType>
void fillMesh(MeshType& mesh, const std::vector<Point3d>& points,
	const std::vector<std::array<int, 2>>& edges, const std::vector<Triangle>& faces)
{
	using Allocator = vcg::tri::Allocator<MeshType>;
	mesh.Clear();
	if (!points.empty())
		Allocator::AddVertices(mesh, points.size());
	for (size_t v = 0; v < points.size(); ++v)
		mesh.vert[v].P() = MeshType::CoordType::Construct(points[v]);
	if (!edges.empty())
		Allocator::AddEdges(mesh, edges.size());
	for (size_t e = 0; e < edges.size(); ++e)
		for (int k = 0; k < 2; ++k)
			mesh.edge[e].V(k) = &mesh.vert[size_t(edges[e][size_t(k)])];
	if (!faces.empty())
		Allocator::AddFaces(mesh, faces.size());
	for (size_t f = 0; f < faces.size(); ++f)
		for (int k = 0; k < 3; ++k)
			mesh.face[f].V(k) = &mesh.vert[size_t(faces[f][size_t(k)])];
}

/// Replaces the contents of a VCG mesh by a surface. @pre it is compact. Complexity: O(V + F).
template <class MeshType>
void fillMesh(MeshType& mesh, const SurfaceMesh& surface)
{
	fillMesh(mesh, surface.position, {}, surface.triangles());
}

} // namespace vcg::tri::mcf

#endif
