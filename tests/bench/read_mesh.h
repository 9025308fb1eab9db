// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Reads a mesh file by VCG's importers (OFF, OBJ, PLY, STL, ...) in double precision, as the plain
// points and triangles that the pipeline's input check takes.

#ifndef MCFSKEL_BENCH_READ_MESH_H
#define MCFSKEL_BENCH_READ_MESH_H

#include <skeleton/mesh/surface_mesh.h>

#include <vcg/complex/complex.h>
#include <wrap/io_trimesh/export.h>
#include <wrap/io_trimesh/import.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

class FileVertex;
class FileFace;
struct FileTypes
		: vcg::UsedTypes<vcg::Use<FileVertex>::AsVertexType, vcg::Use<FileFace>::AsFaceType>
{
};
class FileVertex : public vcg::Vertex<FileTypes, vcg::vertex::Coord3d, vcg::vertex::BitFlags>
{
};
class FileFace : public vcg::Face<FileTypes, vcg::face::VertexRef, vcg::face::BitFlags>
{
};
class FileMesh : public vcg::tri::TriMesh<std::vector<FileVertex>, std::vector<FileFace>>
{
};

struct Soup
{
	std::vector<vcg::Point3d> points;
	std::vector<vcg::tri::mcf::Triangle> triangles;
};

/// @throws std::runtime_error if the file cannot be read.
inline Soup readMesh(const std::string& path)
{
	using Importer = vcg::tri::io::Importer<FileMesh>;
	FileMesh mesh;
	int mask = 0;
	const int error = Importer::Open(mesh, path.c_str(), mask);
	if (Importer::ErrorCritical(error))
		throw std::runtime_error("cannot read " + path + ": " + Importer::ErrorMsg(error));
	Soup soup;
	soup.points.reserve(mesh.vert.size());
	for (const FileVertex& v : mesh.vert)
		soup.points.push_back(v.cP());
	soup.triangles.reserve(mesh.face.size());
	for (const FileFace& f : mesh.face) {
		vcg::tri::mcf::Triangle triangle;
		for (int k = 0; k < 3; ++k)
			triangle[k] = int(f.cV(k) - mesh.vert.data());
		soup.triangles.push_back(triangle);
	}
	return soup;
}

/// Writes a surface in the format that the extension names, positions with all their digits where
/// the format has them. @throws std::runtime_error if that fails.
inline void writeMesh(const vcg::tri::mcf::SurfaceMesh& surface, const std::string& path)
{
	using Allocator = vcg::tri::Allocator<FileMesh>;
	FileMesh mesh;
	std::vector<int> number(surface.vertexSlots(), -1);
	for (int v = 0; v < surface.vertexSlots(); ++v)
		if (surface.isVertex(v)) {
			number[v] = mesh.VN();
			Allocator::AddVertex(mesh, surface.position[v]);
		}
	for (const vcg::tri::mcf::Triangle& t : surface.triangles())
		Allocator::AddFace(mesh, size_t(number[t[0]]), size_t(number[t[1]]), size_t(number[t[2]]));
	if (vcg::tri::io::Exporter<FileMesh>::Save(mesh, path.c_str()) != 0)
		throw std::runtime_error("cannot write " + path);
}

} // namespace bench

#endif // MCFSKEL_BENCH_READ_MESH_H
