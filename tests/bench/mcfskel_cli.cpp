// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The bare library as a command: mesh in, skeleton and one line of figures out, to the last bit what the
// plugin makes of that mesh. The bench times it beside CGAL, without any host in between.

#include "read_mesh.h"
#include "report.h"

#include <skeleton/input/check_input.h>
#include <skeleton/core/parameters.h>
#include <skeleton/io/vtp.h>
#include <skeleton/refine/refine.h>
#include <skeleton/resample/resampled_surface.h>
#include <skeleton/skeletonize.h>
#include <skeleton/solid.h>
#include <skeleton/mesh/surface_rounding.h>

#include <chrono>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace mcf = vcg::tri::mcf;

namespace {

const char* const usage =
	"usage: mcfskel_cli MESH [options]\n"
	"  --preset NAME             default or paper: the paper's algorithm and nothing else\n"
	"  --skeleton FILE           write the skeleton, as OBJ, or with its radii as .vtp\n"
	"  --significance FILE       write that of each node of a refined skeleton, a line each\n"
	"  --surface FILE            write the surface that was contracted\n"
	"  --stage FILE              write the last stage of the contraction\n"
	"  --no-resample             contract the mesh as it is\n"
	"  --target-length PCT       edge length of the resampling, in % of the diagonal\n"
	"  --resample-iterations N   rounds of the resampling\n"
	"  --no-denoise              resample without smoothing the noise first\n"
	"  --no-adaptive             the same lengths everywhere, however thin the shape is\n"
	"  --relative-length K       longest edge in local thicknesses\n"
	"  --resample-only           stop after the resampling\n"
	"  --repair CHOICE           auto, mend or off: what is done with what does not bound a solid\n"
	"  --min-component PART      pieces of a smaller part of the largest one's volume get no skeleton\n"
	"  --join                    join the skeletons of all pieces by bridges\n"
	"  --solid-only              stop after the repair\n"
	"  --pole-method METHOD      voronoi or balls\n"
	"  --w-l W  --w-h W  --w-m W weights of Eq. 6\n"
	"  --epsilon PCT             edges shorter than this are collapsed, in % of the diagonal\n"
	"  --split-angle DEGREES     edges opposite wider angles are split\n"
	"  --max-iterations N        stop the flow after this many\n"
	"  --keep-sheets             flat parts become sheets: faces of the skeleton\n"
	"  --sheet-threshold S       how flat they have to be, 0 to 1\n"
	"  --cotangent-factor F      what the sums of the cotangents are multiplied with\n"
	"  --no-coarsen              start the flow on all vertices\n"
	"  --keep-outward-poles      be drawn to poles that lie outwards, too\n"
	"  --direct-solver           solve by a Cholesky factorisation\n"
	"  --no-tidy                 leave the curve as the last collapse made it\n"
	"  --no-refine               leave the curve as the flow made it\n"
	"  --spacing PCT             distance of the refined nodes, in % of the diagonal\n"
	"  --smoothing K             smoothness of the refined branches\n"
	"  --detail D                how small branches may be, 0 (the trunk) to 1\n"
	"  --spur-prominence R       tips that stick out less are removed\n"
	"  --junction-prominence R   junctions that stick out less are merged\n"
	"  --tip-distinctness R      branches into corners that gain less are removed\n"
	"  --progress-gaps           report the longest silence between two progress reports\n"
	"  --verbose                 a line for each iteration, and the notes of the input check\n";

struct Options
{
	std::string mesh, skeleton, significance, surface, stage;
	bool resampleOnly = false, solidOnly = false;
	bool verbose = false;
	bool progressGaps = false;
	mcf::Parameters parameters;
	mcf::RefineParameters refinement;
};

mcf::PoleMethod poleMethod(const std::string& name)
{
	if (name == "voronoi")
		return mcf::PoleMethod::Voronoi;
	if (name == "balls")
		return mcf::PoleMethod::Balls;
	throw std::invalid_argument("unknown pole method " + name);
}

mcf::Repair repair(const std::string& name)
{
	if (name == "auto")
		return mcf::Repair::Auto;
	if (name == "mend")
		return mcf::Repair::Mend;
	if (name == "off")
		return mcf::Repair::Off;
	throw std::invalid_argument("unknown repair " + name);
}

mcf::Preset preset(const std::string& name)
{
	if (name == "default")
		return mcf::Preset::Default;
	if (name == "paper")
		return mcf::Preset::Paper;
	throw std::invalid_argument("unknown preset " + name);
}

bool isVtp(const std::string& file)
{
	const std::string ending = ".vtp";
	return file.size() > ending.size()
		&& file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
}

Options parse(int argc, char** argv)
{
	Options options;
	mcf::Parameters& p = options.parameters;
	mcf::RefineParameters& r = options.refinement;
	const std::map<std::string, std::function<void()>> flags = {
		{"--no-resample", [&] { p.resample = false; }},
		{"--progress-gaps", [&] { options.progressGaps = true; }},
		{"--resample-only", [&] { options.resampleOnly = true; }},
		{"--solid-only", [&] { options.solidOnly = true; }},
		{"--no-denoise", [&] { p.denoise = false; }},
		{"--no-adaptive", [&] { p.adaptive = false; }},
		{"--no-coarsen", [&] { p.coarsen = false; }},
		{"--keep-outward-poles", [&] { p.dropOutwardPoles = false; }},
		{"--direct-solver", [&] { p.directSolver = true; }},
		{"--no-tidy", [&] { p.tidyCurve = false; }},
		{"--no-refine", [&] { p.refine = false; }},
		{"--keep-sheets", [&] { p.keepSheets = true; }},
		{"--join", [&] { p.join = true; }},
		{"--verbose", [&] { options.verbose = true; }},
	};
	using Text = const std::string&;
	const std::map<std::string, std::function<void(Text)>> values = {
		{"--preset", [&](Text t) { p.apply(preset(t)); }},
		{"--skeleton", [&](Text t) { options.skeleton = t; }},
		{"--significance", [&](Text t) { options.significance = t; }},
		{"--surface", [&](Text t) { options.surface = t; }},
		{"--stage", [&](Text t) { options.stage = t; }},
		{"--target-length", [&](Text t) { p.targetLength = std::stod(t) / 100; }},
		{"--resample-iterations", [&](Text t) { p.resampleIterations = std::stoi(t); }},
		{"--relative-length", [&](Text t) { p.relativeLength = std::stod(t); }},
		{"--min-component", [&](Text t) { p.minComponent = std::stod(t); }},
		{"--repair", [&](Text t) { p.repair = repair(t); }},
		{"--pole-method", [&](Text t) { p.poleMethod = poleMethod(t); }},
		{"--w-l", [&](Text t) { p.wL = std::stod(t); }},
		{"--w-h", [&](Text t) { p.wH = std::stod(t); }},
		{"--w-m", [&](Text t) { p.wM = std::stod(t); }},
		{"--cotangent-factor", [&](Text t) { p.cotangentFactor = std::stod(t); }},
		{"--epsilon", [&](Text t) { p.epsilon = std::stod(t) / 100; }},
		{"--split-angle", [&](Text t) { p.splitAngle = std::stod(t); }},
		{"--sheet-threshold", [&](Text t) { p.sheetThreshold = std::stod(t); }},
		{"--max-iterations", [&](Text t) { p.maxIterations = std::stoi(t); }},
		{"--spacing", [&](Text t) { r.spacing = std::stod(t) / 100; }},
		{"--detail", [&](Text t) { p.detail = std::stod(t); }},
		{"--smoothing", [&](Text t) { r.smoothing = std::stod(t); }},
		{"--spur-prominence", [&](Text t) { r.spurProminence = std::stod(t); }},
		{"--tip-distinctness", [&](Text t) { r.tipDistinctness = std::stod(t); }},
		{"--junction-prominence", [&](Text t) { r.junctionProminence = std::stod(t); }},
	};
	for (int i = 1; i < argc; ++i) {
		const std::string word = argv[i];
		if (const auto flag = flags.find(word); flag != flags.end())
			flag->second();
		else if (const auto value = values.find(word); value != values.end()) {
			if (++i >= argc)
				throw std::invalid_argument(word + " needs a value");
			value->second(argv[i]);
		}
		else if (options.mesh.empty() && word.rfind("--", 0) != 0)
			options.mesh = word;
		else
			throw std::invalid_argument("unknown argument " + word);
	}
	if (options.mesh.empty())
		throw std::invalid_argument("no mesh given");
	if (options.parameters.keepSheets && isVtp(options.skeleton))
		throw std::invalid_argument(".vtp has no sheets");
	return options;
}

bench::Curve toCurve(const mcf::CurveSkeleton& skeleton)
{
	bench::Curve curve;
	for (const vcg::Point3d& p : skeleton.position)
		curve.points.push_back({p[0], p[1], p[2]});
	for (const auto& edge : skeleton.edges)
		curve.edges.emplace_back(size_t(edge[0]), size_t(edge[1]));
	return curve;
}

void describe(const mcf::StageFigures& stage)
{
	std::cerr << "iteration " << stage.iteration << ": " << stage.vertices << " vertices, area "
			  << stage.areaFraction << ", volume " << stage.volumeFraction << ", fixed "
			  << stage.fixedFraction << '\n';
}

/// Listens to progress reports for the longest silence between two of them: what a click on Cancel may
/// have to wait for.
class Listener
{
public:
	mcf::Progress progress()
	{
		return mcf::Progress([this](int, const char* what) {
			hear(what);
			return true;
		});
	}

	double longestMs() const { return longest; }
	const std::string& endedBy() const { return what; }

private:
	using Clock = std::chrono::steady_clock;
	Clock::time_point last = Clock::now();
	double longest = 0;
	std::string what;

	void hear(const char* now)
	{
		const double ms = std::chrono::duration<double, std::milli>(Clock::now() - last).count();
		if (ms > longest) {
			longest = ms;
			what = now;
		}
		last = Clock::now();
	}
};

/// The skeleton with its sheets, if there are any, as faces.
bench::Curve toCurve(const mcf::Skeletonization& result)
{
	if (!result.sheets)
		return toCurve(result.curve);
	mcf::CurveSkeleton curves;
	curves.position = result.sheets->skeleton.position;
	curves.edges = result.sheets->skeleton.edges;
	bench::Curve curve = toCurve(curves);
	for (const auto& face : result.sheets->skeleton.faces)
		curve.faces.push_back({size_t(face[0]), size_t(face[1]), size_t(face[2])});
	return curve;
}

/// Where a program's time goes, by phase; the names are those of all programs of the bench.
const std::map<mcf::Phase, const char*> phaseNames = {{mcf::Phase::Check, "check"},
	{mcf::Phase::Resample, "resample"}, {mcf::Phase::Poles, "poles"},
	{mcf::Phase::Contraction, "contraction"}, {mcf::Phase::Collapse, "conversion"},
	{mcf::Phase::Refine, "refine"}};

void addSurface(const mcf::SurfaceMesh& surface, const Options& options, bench::Json& report)
{
	int components = 0;
	mcf::connectedComponents(surface, &components);
	report.add("mesh_components", components).add("vertices", surface.vertexCount());
	if (!options.surface.empty())
		bench::writeMesh(surface, options.surface);
}

void addSkeleton(const mcf::Skeletonization& result, const Options& options, bench::Json& report)
{
	const bench::Curve curve = toCurve(result);
	mcf::CurveSkeleton graph = result.curve;
	if (result.sheets) {
		graph.position = result.sheets->skeleton.position;
		graph.edges = result.sheets->skeleton.edges;
	}
	const mcf::SkeletonStatistics counts = mcf::statistics(graph);
	const mcf::Stage& stage = *result.stage;
	report.add("poles_missing", result.poles->missing())
		.add("iterations", stage.iteration)
		.add("converged", stage.converged)
		.add("area_fraction", stage.areaFraction())
		.add("volume_fraction", stage.volumeFraction())
		.add("fixed_fraction", stage.fixedFraction())
		.add("stage_vertices", stage.mesh.vertexCount())
		.add("refined", result.refined)
		.add("skeleton_vertices", curve.points.size())
		.add("skeleton_edges", curve.edges.size())
		.add("components", counts.components)
		.add("cycles", counts.cycles)
		.add("branches", counts.branches)
		.add("terminals", counts.terminals)
		.add("junctions", counts.junctions)
		.add("skeleton_length", counts.length);
	if (result.sheets) {
		const mcf::BettiNumbers b = result.sheets->skeleton.betti();
		report.add("sheet_faces", curve.faces.size())
			.add("sheets", result.sheets->sheets)
			.add("sheets_given_up", result.sheets->givenUp)
			.add("b0", b.b0)
			.add("b1", b.b1)
			.add("b2", b.b2);
	}
	if (!options.significance.empty())
		bench::writeNumbers(result.curve.significance, options.significance);
	if (!options.stage.empty())
		bench::writeMesh(stage.mesh, options.stage);
	if (isVtp(options.skeleton)) {
		std::ofstream out(options.skeleton);
		mcf::writeVtp(out, result.curve);
		if (!out.flush())
			throw std::runtime_error("cannot write " + options.skeleton);
	}
	else if (!options.skeleton.empty())
		bench::writeObj(curve, options.skeleton);
}

/// What the notes say of cavities, which a user has to know: the skeleton is not that of the solid.
void warnOfCavities(const mcf::Skeletonization& result)
{
	const mcf::LeftOutPieces& leftOut = result.solid.leftOut;
	if (!leftOut.hollow)
		return;
	for (const std::string& note : leftOut.notes())
		std::cerr << note << '\n';
	std::cerr << 100 * result.inCavities << " % of the skeleton lies in cavities.\n";
}

void run(const Options& options)
{
	const mcf::Parameters& parameters = options.parameters;
	bench::Soup soup = bench::readMesh(options.mesh);
	bench::Json seconds, report;
	report.add("program", "mcfskel").add("mesh", options.mesh);
	report.add("input_vertices", soup.points.size());

	Listener listener;
	const mcf::Progress progress = options.progressGaps ? listener.progress() : mcf::Progress();
	bench::Stopwatch watch;
	mcf::Observer observer;
	observer.onPhase = [&](mcf::Phase phase) { seconds.add(phaseNames.at(phase), watch.lap()); };
	if (options.verbose) {
		observer.onNote = [](const std::string& note) { std::cerr << note << '\n'; };
		observer.onFigures = describe;
	}
	const auto addSolid = [&](const mcf::SolidReport& solid) {
		report.add("repaired", int(solid.outcome))
			.add("distance_mean", 100 * solid.distanceMean)
			.add("distance_max", 100 * solid.distanceMax)
			.add("self_intersections", solid.selfIntersections)
			.add("pieces_left_out", solid.leftOut.small + solid.leftOut.cavities);
	};
	if (options.resampleOnly || options.solidOnly) {
		mcf::SolidSurface solid =
			mcf::solidSurface(mcf::roundedCoordinates(soup.points, soup.triangles), soup.triangles,
				{parameters.repair, parameters.minComponent, true}, progress);
		addSolid(solid.report);
		if (options.verbose)
			for (const std::string& note : solid.surface.notes)
				std::cerr << note << '\n';
		mcf::SurfaceMesh surface = std::move(solid.surface.mesh);
		observer.onPhase(mcf::Phase::Check);
		if (parameters.resample && !options.solidOnly) {
			mcf::ResampledSurface resampled =
				mcf::resampledSurface(surface, parameters, progress, observer.onNote);
			report.add("noise", resampled.noise.level);
			surface = std::move(resampled.mesh);
		}
		observer.onPhase(mcf::Phase::Resample);
		addSurface(surface, options, report);
	}
	else {
		const mcf::Skeletonization result = mcf::skeletonize(
			soup.points, soup.triangles, parameters, progress, observer, options.refinement);
		if (!options.verbose)
			warnOfCavities(result);
		if (parameters.resample)
			report.add("noise", result.noise.level);
		addSolid(result.solid);
		addSurface(*result.surface, options, report);
		addSkeleton(result, options, report);
		report.add("bridges", result.bridges.count).add("in_cavities", result.inCavities);
	}
	if (options.progressGaps)
		report.add("longest_silence_ms", listener.longestMs())
			.add("silence_ended_by", listener.endedBy());
	report.add("seconds", seconds).add("peak_mb", bench::peakMemory());
	std::cout << report.text() << std::endl;
}

} // namespace

int main(int argc, char** argv)
{
	return bench::runProgram("mcfskel_cli", usage, [&] { run(parse(argc, argv)); });
}
