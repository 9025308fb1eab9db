// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Whole jobs on meshes, for scripts/sanitize.sh: the sanitizers it is built with do the checking. Besides,
// each skeleton must be finite and have as many components as the mesh.

#include "layers/kept_stages.h"
#include "shapes.h"

#include <skeleton/pipeline.h>
#include <skeleton/skeletonize.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mcf = vcg::tri::mcf;

namespace {

const char* const usage =
	"usage: sanitize_jobs [--jobs NAME,NAME...] [--many BODIES] MESH...\n"
	"  --jobs   of: default raw voronoi sheets held kept steps (all of them)\n"
	"  --many   also on so many bodies of several kinds and sizes\n"
	"  MESH     OFF or OBJ\n";

/// The triangles of a plain OFF or OBJ file; polygons are cut into fans.
shapes::Soup readMesh(const std::string& path)
{
	std::ifstream file(path);
	if (!file)
		throw std::runtime_error("cannot open " + path);
	shapes::Soup soup;
	std::vector<int> corners;
	const auto addPolygon = [&] {
		for (size_t i = 2; i < corners.size(); ++i)
			soup.triangles.push_back({corners[0], corners[i - 1], corners[i]});
	};
	double x = 0, y = 0, z = 0;
	if (path.size() > 4 && path.substr(path.size() - 4) == ".obj") {
		for (std::string line, word; std::getline(file, line);) {
			std::istringstream words(line);
			words >> word;
			if (word == "v" && words >> x >> y >> z)
				soup.points.emplace_back(x, y, z);
			else if (word == "f") {
				corners.clear();
				while (words >> word)
					corners.push_back(std::stoi(word) - 1); // of v/vt/vn the first number
				addPolygon();
			}
		}
		return soup;
	}
	std::string magic;
	size_t points = 0, faces = 0, edges = 0;
	file >> magic >> points >> faces >> edges;
	for (size_t i = 0; i < points && file >> x >> y >> z; ++i)
		soup.points.emplace_back(x, y, z);
	for (size_t f = 0, size = 0; f < faces && file >> size; ++f) {
		corners.resize(size);
		for (int& v : corners)
			file >> v;
		addPolygon();
	}
	if (!file || magic != "OFF")
		throw std::runtime_error("cannot read " + path);
	return soup;
}

/// Bodies in rows, so many and of four kinds, each smaller than the one before by a few percent.
shapes::Soup manyBodies(int count)
{
	const shapes::Soup kinds[] = {shapes::sphere(3), shapes::torus(1, 0.3, 40, 12),
		shapes::capsule(), shapes::subdivided(shapes::subdivided(shapes::box(1, 0.7, 0.4)))};
	constexpr int perRow = 10;
	shapes::Soup all;
	for (int i = 0; i < count; ++i) {
		const double size = std::pow(0.97, i % 40);
		const vcg::Point3d place(4.0 * (i % perRow), 4.0 * (i / perRow), 0);
		all = shapes::joined({all, shapes::moved(shapes::scaled(kinds[i % 4], size), place)});
	}
	return all;
}

/// What came of one job, for its line.
struct Outcome
{
	mcf::Skeletonization result;
	size_t keptStages = 0;
};

mcf::SurfaceInput inputOf(const shapes::Soup& soup)
{
	mcf::CheckedSurface checked = mcf::checkedSurface(
		mcf::roundedCoordinates(soup.points, soup.triangles), soup.triangles, {});
	return {std::make_shared<const mcf::SurfaceMesh>(std::move(checked.mesh))};
}

/// As Full Skeletonize keeps its stages: a thread of their own tells their fields while the flow goes on.
Outcome keepingStages(const mcf::SurfaceInput& input, const mcf::Parameters& parameters)
{
	mcfskel::KeptStages kept;
	std::optional<mcfskel::KeptStages::FlowShare> share;
	mcf::Observer observer;
	observer.onStage = [&](mcf::Stage stage) {
		kept.add(std::make_shared<const mcf::Stage>(std::move(stage)));
	};
	observer.onPhase = [&](mcf::Phase ended) {
		if (ended == mcf::Phase::Poles)
			share.emplace();
		else
			share.reset();
	};
	Outcome outcome {mcf::skeletonize(input, parameters, {}, observer), kept.size()};
	for (size_t i = 0; i < kept.size(); ++i)
		if (kept.takeFields(i, {}).kind.size() != size_t(kept.stage(i)->mesh.vertexSlots()))
			throw std::runtime_error("a kept stage has other vertices than fields");
	return outcome;
}

/// As the filters do it one by one.
Outcome stepByStep(const mcf::SurfaceInput& input, const mcf::Parameters& parameters)
{
	const mcf::PoleSet poles = mcf::medialPoles(*input.mesh, parameters.poleMethod, {});
	mcf::Stage stage = mcf::startOfFlow(*input.mesh, poles, {}, parameters);
	for (int i = 0; i < 3; ++i)
		stage = mcf::step(std::move(stage), parameters);
	stage = mcf::contractToSkeleton(std::move(stage), parameters);
	Outcome outcome;
	outcome.result.stage = std::make_shared<const mcf::Stage>(std::move(stage));
	outcome.result.curve =
		mcf::refine(mcf::collapseInside(*outcome.result.stage, parameters.epsilon), *input.mesh);
	return outcome;
}

Outcome run(const std::string& job, mcf::SurfaceInput input)
{
	mcf::Parameters parameters;
	parameters.resample = job == "default" || job == "held";
	if (job == "default" || job == "raw")
		return {mcf::skeletonize(input, parameters)};
	if (job == "voronoi") {
		parameters.poleMethod = mcf::PoleMethod::Voronoi;
		return {mcf::skeletonize(input, parameters)};
	}
	if (job == "sheets") {
		parameters.keepSheets = true;
		return {mcf::skeletonize(input, parameters)};
	}
	if (job == "held") {
		constexpr size_t every = 37;
		input.held.assign(size_t(input.mesh->vertexSlots()), 0);
		for (size_t v = 0; v < input.held.size(); v += every)
			input.held[v] = 1;
		return {mcf::skeletonize(input, parameters)};
	}
	if (job == "kept")
		return keepingStages(input, parameters);
	if (job == "steps")
		return stepByStep(input, parameters);
	throw std::invalid_argument("no such job: " + job);
}

/// What is wrong with a skeleton; empty: nothing.
std::string defect(const mcf::Skeletonization& result, const mcf::SurfaceMesh& mesh)
{
	const std::vector<vcg::Point3d>& nodes =
		result.sheets ? result.sheets->skeleton.position : result.curve.position;
	if (nodes.empty())
		return "no nodes";
	for (const vcg::Point3d& p : nodes)
		if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
			return "a node is not finite";
	if (result.sheets)
		return "";
	int components = 0;
	mcf::connectedComponents(mesh, &components);
	const int found = mcf::statistics(result.curve).components;
	return found == components
		? ""
		: std::to_string(found) + " components, not " + std::to_string(components);
}

/// Runs the jobs on a mesh, a line each. @return whether all went well.
bool runAll(const std::string& name, const shapes::Soup& soup, const std::vector<std::string>& jobs)
{
	const mcf::SurfaceInput input = inputOf(soup);
	bool good = true;
	for (const std::string& job : jobs) {
		const auto begin = std::chrono::steady_clock::now();
		std::cout << name << ' ' << job << ": " << std::flush;
		try {
			const Outcome outcome = run(job, input);
			const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
			const std::string wrong = defect(outcome.result, *input.mesh);
			good = good && wrong.empty();
			std::cout << outcome.result.stage->iteration << " iterations, " << outcome.keptStages
					  << " stages kept, " << seconds.count() << " s"
					  << (wrong.empty() ? "" : ": WRONG: " + wrong) << std::endl;
		}
		catch (const std::exception& error) {
			good = false;
			std::cout << "WRONG: " << error.what() << std::endl;
		}
	}
	return good;
}

} // namespace

int main(int argc, char** argv)
try {
	std::vector<std::string> jobs = {
		"default", "raw", "voronoi", "sheets", "held", "kept", "steps"};
	std::vector<std::string> meshes;
	int many = 0;
	for (int i = 1; i < argc; ++i) {
		const std::string word = argv[i];
		if (word == "--jobs" && i + 1 < argc) {
			jobs.clear();
			std::istringstream names(argv[++i]);
			for (std::string name; std::getline(names, name, ',');)
				jobs.push_back(name);
		}
		else if (word == "--many" && i + 1 < argc)
			many = std::atoi(argv[++i]);
		else if (word.rfind("--", 0) == 0)
			throw std::invalid_argument(usage);
		else
			meshes.push_back(word);
	}
	if (meshes.empty() && many == 0)
		throw std::invalid_argument(usage);
	bool good = true;
	if (many > 0)
		good = runAll("many_bodies", manyBodies(many), jobs);
	for (const std::string& path : meshes)
		good = runAll(path.substr(path.find_last_of('/') + 1), readMesh(path), jobs) && good;
	return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
catch (const std::exception& error) {
	std::cerr << error.what() << '\n';
	return 2;
}
