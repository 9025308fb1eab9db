// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Google Benchmark for the single stages of the pipeline, on the meshes named on the command line:
//
//   benchmarks MESH... [--benchmark_filter=REGEX] [--benchmark_out=FILE]
//
// Every stage starts from what the stages before it leave with default parameters, so the figures
// of one mesh add up to about the whole job. Counters: input vertices per second.

#include "read_mesh.h"

#include <skeleton/check_input.h>
#include <skeleton/collapse_to_curve.h>
#include <skeleton/cotangent_laplacian.h>
#include <skeleton/poles.h>
#include <skeleton/refine.h>
#include <skeleton/resample.h>
#include <skeleton/skeletonize.h>
#include <skeleton/target_length.h>

#include <benchmark/benchmark.h>

#include <iostream>
#include <memory>
#include <string>

namespace mcf = vcg::tri::mcf;

namespace {

/// What the stages of one mesh start from.
struct Prepared
{
	bench::Soup soup;
	mcf::SurfaceMesh surface;   ///< the input, checked
	mcf::SurfaceMesh resampled; ///< with default parameters
	mcf::Stage initial;
	mcf::Stage halfway; ///< after half of the iterations to convergence
	mcf::Stage last;
	mcf::CurveSkeleton curve;

	explicit Prepared(const std::string& path) : soup(bench::readMesh(path))
	{
		const mcf::Parameters parameters;
		surface = mcf::checkedSurface(soup.points, soup.triangles).mesh;
		resampled = mcf::resample(
			surface, mcf::defaultTargetLength(surface), parameters.resampleIterations);
		initial = mcf::initialStage(resampled, mcf::medialPoles(resampled, parameters.poleMethod));
		last = mcf::contractToSkeleton(initial, parameters);
		curve = mcf::collapseToCurve(last);
		mcf::Parameters half = parameters;
		half.maxIterations = last.iteration / 2;
		halfway = mcf::contractToSkeleton(initial, half);
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
	const int in = data->surface.vertexCount(), out = data->resampled.vertexCount();
	const mcf::Parameters parameters;
	add(name + "check", in,
		[data] { return mcf::checkedSurface(data->soup.points, data->soup.triangles); });
	add(name + "resample", out, [data, parameters] {
		return mcf::resample(
			data->surface, mcf::defaultTargetLength(data->surface), parameters.resampleIterations);
	});
	add(name + "poles_balls", out,
		[data] { return mcf::medialPoles(data->resampled, mcf::PoleMethod::Balls); });
	add(name + "poles_voronoi", out,
		[data] { return mcf::medialPoles(data->resampled, mcf::PoleMethod::Voronoi); });
	add(name + "laplacian", out, [data] { return mcf::cotangentLaplacian(data->resampled); });
	add(name + "copy_stage", out, [data] { return mcf::Stage(data->initial); });
	add(name + "first_step", out,
		[data, parameters] { return mcf::step(data->initial, parameters); });
	add(name + "middle_step", data->halfway.mesh.vertexCount(),
		[data, parameters] { return mcf::step(data->halfway, parameters); });
	add(name + "contraction", out,
		[data, parameters] { return mcf::contractToSkeleton(data->initial, parameters); });
	add(name + "collapse", data->last.mesh.vertexCount(),
		[data] { return mcf::collapseToCurve(data->last); });
	add(name + "refine", int(data->curve.position.size()),
		[data] { return mcf::refine(data->curve, data->resampled); });
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
