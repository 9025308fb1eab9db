// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Google Benchmark for the single stages of the pipeline, on the meshes named on the command line:
//
//   benchmarks MESH... [--benchmark_filter=REGEX] [--benchmark_out=FILE]
//
// Every stage starts from what the stages before it leave with default parameters, so the figures
// of one mesh add up to about the whole job. Counters: input vertices per second.

#include "read_mesh.h"

#include <skeleton/input/check_input.h>
#include <skeleton/flow/flow_system.h>
#include <skeleton/skeletonize.h>
#include <skeleton/mesh/surface_rounding.h>

#include <benchmark/benchmark.h>

#include <iostream>
#include <memory>
#include <string>

namespace mcf = vcg::tri::mcf;

namespace {

/// What the stages of one mesh start from: what a run with default parameters leaves.
struct Prepared
{
	bench::Soup soup;
	mcf::SurfaceMesh input; ///< checked
	mcf::Skeletonization run;
	mcf::Stage initial;
	mcf::Stage halfway;       ///< after half of the iterations to convergence
	mcf::CurveSkeleton curve; ///< before it is refined

	explicit Prepared(const std::string& path) : soup(bench::readMesh(path))
	{
		const mcf::Parameters parameters;
		input = checked();
		run = mcf::skeletonize(soup.points, soup.triangles, parameters);
		initial = mcf::startOfFlow(*run.surface, *run.poles, {}, parameters);
		curve = mcf::collapseInside(*run.stage, parameters.epsilon);
		mcf::Parameters half = parameters;
		half.maxIterations = run.stage->iteration / 2;
		halfway = mcf::contractToSkeleton(initial, half);
	}

	mcf::SurfaceMesh checked() const
	{
		return mcf::checkedSurface(
			mcf::roundedCoordinates(soup.points, soup.triangles), soup.triangles)
			.mesh;
	}
};

template <class Work>
void add(const std::string& name, int vertices, Work work)
{
	benchmark::RegisterBenchmark(name.c_str(),
		[vertices, work](benchmark::State& state) {
			for (auto _ : state)
				benchmark::DoNotOptimize(work());
			state.SetItemsProcessed(state.iterations() * vertices);
		})
		->Unit(benchmark::kMillisecond)
		->MeasureProcessCPUTime()
		->UseRealTime();
}

void addStages(const std::string& path)
{
	const auto data = std::make_shared<const Prepared>(path);
	const size_t slash = path.find_last_of('/');
	const std::string name = path.substr(slash == std::string::npos ? 0 : slash + 1) + "/";
	const int in = data->input.vertexCount(), out = data->run.surface->vertexCount();
	const mcf::Parameters parameters;
	add(name + "whole", in, [data, parameters] {
		return mcf::skeletonize(data->soup.points, data->soup.triangles, parameters);
	});
	add(name + "check", in, [data] { return data->checked(); });
	add(name + "resample", out,
		[data, parameters] { return mcf::resampledSurface(data->input, parameters); });
	add(name + "poles_balls", out,
		[data] { return mcf::medialPoles(*data->run.surface, mcf::PoleMethod::Balls); });
	add(name + "poles_voronoi", out,
		[data] { return mcf::medialPoles(*data->run.surface, mcf::PoleMethod::Voronoi); });
	add(name + "start_of_flow", out, [data, parameters] {
		return mcf::startOfFlow(*data->run.surface, *data->run.poles, {}, parameters);
	});
	add(name + "system", out,
		[data, parameters] { return mcf::flowSystem(data->initial, parameters); });
	add(name + "copy_stage", out, [data] { return mcf::Stage(data->initial); });
	add(name + "first_step", out,
		[data, parameters] { return mcf::step(data->initial, parameters); });
	add(name + "middle_step", data->halfway.mesh.vertexCount(),
		[data, parameters] { return mcf::step(data->halfway, parameters); });
	add(name + "contraction", out,
		[data, parameters] { return mcf::contractToSkeleton(data->initial, parameters); });
	add(name + "collapse", data->run.stage->mesh.vertexCount(),
		[data, parameters] { return mcf::collapseToCurve(*data->run.stage, parameters.epsilon); });
	add(name + "refine", int(data->curve.position.size()),
		[data] { return mcf::refine(data->curve, *data->run.surface); });
}

} // namespace

int main(int argc, char** argv)
{
	benchmark::Initialize(&argc, argv);
	if (argc < 2) {
		std::cerr
			<< "usage: benchmarks MESH... [--benchmark_filter=REGEX] [--benchmark_out=FILE]\n";
		return 2;
	}
	try {
		for (int i = 1; i < argc; ++i)
			addStages(argv[i]);
	}
	catch (const std::exception& error) {
		std::cerr << "benchmarks: " << error.what() << '\n';
		return 1;
	}
	benchmark::RunSpecifiedBenchmarks();
	return 0;
}
