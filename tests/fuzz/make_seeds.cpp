// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Writes the files that the fuzz targets start from, in a folder for each target.

#include "../unit/graphs.h"
#include "../unit/shapes.h"

#include <skeleton/io/cg.h>
#include <skeleton/io/skeleton_ply.h>
#include <skeleton/io/stage_ply.h>
#include <skeleton/io/swc.h>
#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/flow/held_vertices.h>
#include <skeleton/flow/flow.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

std::filesystem::path root;

/// Writes the next file of a target.
template <class Write>
void add(const std::string& target, const Write& write)
{
	const std::filesystem::path folder = root / target;
	std::filesystem::create_directories(folder);
	static int count = 0;
	std::ofstream out(folder / ("seed_" + std::to_string(count++)), std::ios::binary);
	write(out);
	if (!out.flush())
		throw std::runtime_error("could not write to " + folder.string());
}

void addSkeleton(const CurveSkeleton& skeleton)
{
	add("swc", [&](std::ostream& out) { writeSwc(out, skeleton); });
	add("cg", [&](std::ostream& out) { writeCg(out, skeleton); });
	add("skeleton_ply", [&](std::ostream& out) { writeSkeletonPly(out, skeleton); });
}

void addStage(const Stage& stage)
{
	// The way back to the layer: as if its first vertex had been deleted.
	std::vector<int> vertexOfSlot(1, -1);
	for (size_t s = 0; s < stage.node.size(); ++s)
		vertexOfSlot.push_back(int(s));
	for (const char* target : {"stage_ply", "stage_flow"})
		add(target, [&](std::ostream& out) {
			writeStagePly(out, {stage, 0x123456789, vertexOfSlot});
		});
}

void addSkeletons()
{
	CurveSkeleton node;
	node.position = {{1, 2, 3}};
	node.radius = {0.5};
	addSkeleton(node);
	CurveSkeleton cycle;
	for (int i = 0; i < 12; ++i) {
		cycle.position.emplace_back(std::cos(i * M_PI / 6), std::sin(i * M_PI / 6), 0.01 * i);
		cycle.edges.push_back({i, (i + 1) % 12});
	}
	tidyEdges(cycle.edges);
	addSkeleton(cycle); // without radius
	addSkeleton(graphs::ringWithTailAndY());
}

void addStages()
{
	const std::vector<shapes::Soup> surfaces = {shapes::tetrahedron(), shapes::octahedron(),
		shapes::box(4, 1, 0.3), shapes::torus(1, 0.3, 12, 6),
		shapes::joined({shapes::tetrahedron(),
			shapes::moved(shapes::scaled(shapes::octahedron(), 0.3), {5, 0, 0})}),
		shapes::scaled(shapes::torus(1, 0.2, 9, 5), 1e-20)};
	Parameters parameters;
	parameters.epsilon = 0.02;
	for (const shapes::Soup& surface : surfaces) {
		const SurfaceMesh mesh = surface.mesh();
		Stage stage = initialStage(mesh, medialPoles(mesh, PoleMethod::Balls));
		addStage(stage);
		Stage held = stage;
		std::vector<char> some(held.held.size(), 0);
		for (size_t v = 0; v < some.size(); v += 3)
			some[v] = 1;
		holdVertices(held, some);
		addStage(step(held, parameters));
		for (size_t v = 0; v < stage.sheet.size(); v += 2)
			held.sheet[v] = stage.poleRadius[v] >= 0;
		addStage(step(held, parameters));
		for (int i = 1; i <= 40; ++i) {
			stage = step(std::move(stage), parameters);
			if (i == 2 || i == 8 || i == 40)
				addStage(stage);
		}
		addSkeleton(collapseToCurve(stage));
	}
}

} // namespace

int main(int argc, char** argv)
{
	if (argc != 2) {
		std::fprintf(stderr, "usage: make_seeds FOLDER\n");
		return 2;
	}
	try {
		root = argv[1];
		addSkeletons();
		addStages();
	}
	catch (const std::exception& error) {
		std::fprintf(stderr, "%s\n", error.what());
		return 1;
	}
	return 0;
}
