// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The peer of the bench: CGAL's implementation of the same paper, run as its manual documents it,
// with its defaults. Optionally the input is first remeshed with CGAL's isotropic remeshing, so
// that the whole job, mesh in, skeleton out, can be compared at one sampling density.
//
// The skeletonization's own contract_until_convergence() is spelled out with its public steps,
// which is the only way to learn the number of iterations.

#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cmath>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "report.h"

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Skeletonization = CGAL::Mean_curvature_flow_skeletonization<Mesh>;

const char* const usage =
	"usage: cgal_peer MESH [options]\n"
	"  --remesh PCT            first remesh to this edge length, in % of the diagonal\n"
	"  --remesh-iterations N   rounds of remeshing (default 3)\n"
	"  --no-skeleton           stop after remeshing\n"
	"  --surface FILE          write the surface that was contracted\n"
	"  --skeleton FILE         write the skeleton, as OBJ\n";

struct Options
{
	std::string mesh;
	std::string surface;
	std::string skeleton;
	double remesh = 0.0;
	unsigned remeshIterations = 3;
	bool skeletonize = true;
};

Options parse(int argc, char** argv)
{
	Options options;
	for (int i = 1; i < argc; ++i) {
		const std::string word = argv[i];
		const auto value = [&]() -> std::string {
			if (i + 1 >= argc)
				throw std::invalid_argument(word + " needs a value");
			return argv[++i];
		};
		if (word == "--remesh")
			options.remesh = std::stod(value());
		else if (word == "--remesh-iterations")
			options.remeshIterations = static_cast<unsigned>(std::stoul(value()));
		else if (word == "--no-skeleton")
			options.skeletonize = false;
		else if (word == "--surface")
			options.surface = value();
		else if (word == "--skeleton")
			options.skeleton = value();
		else if (options.mesh.empty() && word.rfind("--", 0) != 0)
			options.mesh = word;
		else
			throw std::invalid_argument("unknown argument " + word);
	}
	if (options.mesh.empty())
		throw std::invalid_argument("no mesh given");
	return options;
}

double diagonal(const Mesh& mesh)
{
	const CGAL::Bbox_3 box = PMP::bbox(mesh);
	return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

struct Times
{
	bench::Seconds remesh, construct, contraction, conversion;
	std::size_t iterations = 0;
	bool converged = true;
};

/// contract_until_convergence() in terms of its public steps, counting them.
void contract(Skeletonization& flow, double originalArea, Times& times)
{
	double lastArea = 0.0;
	for (std::size_t i = 0; i < flow.max_iterations(); ++i) {
		flow.contract();
		++times.iterations;
		const double area = PMP::area(flow.meso_skeleton());
		if (std::fabs(lastArea - area) < flow.area_variation_factor() * originalArea)
			return;
		lastArea = area;
	}
	times.converged = false;
}

/// Skeletonizes one connected component, which is what CGAL asks for, and appends to @p curve.
void skeletonize(const Mesh& mesh, bench::Curve& curve, Times& times)
{
	bench::Stopwatch watch;
	Skeletonization flow(mesh);
	const double originalArea = PMP::area(flow.meso_skeleton());
	times.construct += watch.lap();
	contract(flow, originalArea, times);
	times.contraction += watch.lap();
	Skeletonization::Skeleton graph;
	flow.convert_to_skeleton(graph);
	times.conversion += watch.lap();

	const std::size_t first = curve.points.size();
	for (const auto node : CGAL::make_range(boost::vertices(graph))) {
		const auto& p = graph[node].point;
		curve.points.push_back({p.x(), p.y(), p.z()});
	}
	for (const auto edge : CGAL::make_range(boost::edges(graph)))
		curve.edges.emplace_back(
			first + boost::source(edge, graph), first + boost::target(edge, graph));
}

void run(const Options& options)
{
	Mesh mesh;
	if (!PMP::IO::read_polygon_mesh(options.mesh, mesh))
		throw std::runtime_error("cannot read " + options.mesh);
	if (!CGAL::is_triangle_mesh(mesh) || !CGAL::is_closed(mesh))
		throw std::runtime_error(options.mesh + " is no closed triangle mesh");
	const std::size_t inputVertices = mesh.number_of_vertices();

	Times times;
	bench::Stopwatch watch;
	if (options.remesh > 0.0) {
		PMP::isotropic_remeshing(mesh.faces(), 0.01 * options.remesh * diagonal(mesh), mesh,
			PMP::parameters::number_of_iterations(options.remeshIterations));
		mesh.collect_garbage();
		times.remesh = watch.lap();
	}
	if (!options.surface.empty()
		&& !CGAL::IO::write_polygon_mesh(
			options.surface, mesh, CGAL::parameters::stream_precision(17)))
		throw std::runtime_error("cannot write " + options.surface);

	bench::Curve curve;
	if (options.skeletonize) {
		std::vector<Mesh> parts;
		PMP::split_connected_components(mesh, parts);
		for (const Mesh& part : parts)
			skeletonize(part, curve, times);
		if (!options.skeleton.empty())
			bench::writeObj(curve, options.skeleton);
	}

	bench::Json seconds;
	seconds.add("resample", times.remesh)
		.add("construct", times.construct)
		.add("contraction", times.contraction)
		.add("conversion", times.conversion);
	bench::Json report;
	report.add("program", "cgal")
		.add("mesh", options.mesh)
		.add("input_vertices", inputVertices)
		.add("vertices", std::size_t(mesh.number_of_vertices()))
		.add("seconds", seconds)
		.add("iterations", times.iterations)
		.add("converged", times.converged)
		.add("skeleton_vertices", curve.points.size())
		.add("skeleton_edges", curve.edges.size())
		.add("peak_mb", bench::peakMemory());
	std::cout << report.text() << std::endl;
}

} // namespace

int main(int argc, char** argv)
{
	return bench::runProgram("cgal_peer", usage, [&] { run(parse(argc, argv)); });
}
