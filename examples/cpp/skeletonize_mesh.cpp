// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The skeleton of a mesh of VCG: skeletonize_mesh MESH SKELETON, in any formats that VCG knows.

#include <skeleton/mean_curvature_skeleton.h>

#include <wrap/io_trimesh/export.h>
#include <wrap/io_trimesh/import.h>

#include <cstdio>
#include <exception>

using namespace vcg;

class MyVertex;
class MyEdge;
class MyFace;
struct MyTypes
		: UsedTypes<Use<MyVertex>::AsVertexType, Use<MyEdge>::AsEdgeType, Use<MyFace>::AsFaceType>
{
};
class MyVertex : public Vertex<MyTypes, vertex::Coord3f, vertex::Qualityf, vertex::BitFlags>
{
};
class MyEdge : public Edge<MyTypes, edge::VertexRef, edge::BitFlags>
{
};
class MyFace : public Face<MyTypes, face::VertexRef, face::BitFlags>
{
};
class MyMesh : public tri::TriMesh<std::vector<MyVertex>, std::vector<MyEdge>, std::vector<MyFace>>
{
};

int main(int argc, char** argv)
try {
	using Importer = tri::io::Importer<MyMesh>;
	MyMesh mesh;
	int mask = 0;
	if (argc != 3 || Importer::ErrorCritical(Importer::Open(mesh, argv[1], mask)))
		return std::fputs("usage: skeletonize_mesh MESH SKELETON\n", stderr), 2;
	tri::MeanCurvatureSkeleton<MyMesh>::Params params;
	params.on_note = [](const std::string& note) { std::puts(note.c_str()); };
	MyMesh skeleton;
	tri::MeanCurvatureSkeleton<MyMesh>::Do(mesh, skeleton, params);
	std::printf("%d nodes, %d edges\n", skeleton.VN(), skeleton.EN());
	const int parts = tri::io::Mask::IOM_EDGEINDEX | tri::io::Mask::IOM_VERTQUALITY;
	if (const int error = tri::io::Exporter<MyMesh>::Save(skeleton, argv[2], parts))
		return std::fprintf(
				   stderr, "%s: %s\n", argv[2], tri::io::Exporter<MyMesh>::ErrorMsg(error)),
			   1;
	return 0;
}
catch (const std::exception& error) { // tri::mcf::Error, or too little memory
	return std::fprintf(stderr, "%s\n", error.what()), 1;
}
