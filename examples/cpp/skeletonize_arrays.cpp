// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The library on plain arrays: skeletonize_arrays MESH.off [voronoi] prints the skeleton as OBJ lines, each
// node with its radius.

#include <skeleton/skeletonize.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

namespace mcf = vcg::tri::mcf;

int main(int argc, char** argv)
try {
	std::ifstream file(argc > 1 ? argv[1] : "");
	std::string header;
	size_t vertices = 0, faces = 0, edges = 0;
	file >> header >> vertices >> faces >> edges;
	std::vector<vcg::Point3d> points(vertices);
	for (vcg::Point3d& p : points)
		file >> p[0] >> p[1] >> p[2];
	std::vector<mcf::Triangle> triangles(faces);
	size_t corners = 3;
	for (mcf::Triangle& t : triangles)
		if (corners == 3)
			file >> corners >> t[0] >> t[1] >> t[2];
	if (corners != 3)
		return std::fputs("the mesh has polygons: triangulate it\n", stderr), 1;
	if (!file || points.empty())
		return std::fputs("usage: skeletonize_arrays MESH.off [voronoi]\n", stderr), 2;

	mcf::Parameters parameters;
	if (argc > 2 && std::string(argv[2]) == "voronoi")
		parameters.poleMethod = mcf::PoleMethod::Voronoi;
	const mcf::Skeletonization result = mcf::skeletonize(points, triangles, parameters);
	for (size_t v = 0; v < result.curve.position.size(); ++v) {
		const vcg::Point3d& p = result.curve.position[v];
		std::printf("v %.17g %.17g %.17g # %.17g\n", p[0], p[1], p[2], result.curve.radius[v]);
	}
	for (const auto& [a, b] : result.curve.edges)
		std::printf("l %d %d\n", a + 1, b + 1);
	return 0;
}
catch (const std::exception& error) { // mcf::Error, or too little memory
	return std::fprintf(stderr, "%s\n", error.what()), 1;
}
