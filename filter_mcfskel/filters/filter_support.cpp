// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "filter_support.h"

#include <skeleton/pipeline.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

QString menuName(const char* name)
{
	return QString("Mean Curvature Skeleton: ") + name;
}

QString helpPage(const QString& whatItDoes)
{
	// Short: MeshLab 2020.09 shows all of it above the parameters, in a dialog that cannot scroll.
	return whatItDoes
		+ "<br>See Tagliasacchi, Alhashim, Olson, Zhang, \"Mean Curvature Skeletons\", SGP 2012, "
		  "<a href=\"https://doi.org/10.1111/j.1467-8659.2012.03178.x\">"
		  "doi 10.1111/j.1467-8659.2012.03178.x</a>.";
}

ParameterSpec targetLengthParameter()
{
	return {ParameterKind::Length, "target_length", 0, "Target edge length",
		"Length of the edges after resampling, mesh units or percent of the bounding box diagonal (of "
		"each connected component). 0 chooses it from the mesh and says so in the log. Shorter edges "
		"follow the surface more closely and take more time; recommended: 0.3 to 1.5 %."};
}

ParameterSpec resampleIterationsParameter()
{
	return {ParameterKind::Integer, "resample_iterations",
		double(mcf::Parameters().resampleIterations), "Resampling rounds",
		"Rounds of splitting, collapsing, flipping and smoothing. More make the triangles more even; "
		"recommended: 3 to 10."};
}

ParameterSpec denoiseParameter()
{
	return {ParameterKind::Boolean, "denoise", double(mcf::Parameters().denoise), "Smooth noise",
		"Measures the noise of the surface and, where there is some, smooths it before the resampling, "
		"so that it does not grow branches; the log says how much was found. Clean surfaces are left "
		"as they are."};
}

std::vector<ParameterSpec> adaptiveParameters()
{
	const mcf::Parameters defaults;
	return {
		{ParameterKind::Boolean, "adaptive", double(defaults.adaptive),
			"Follow the local thickness",
			"Where the shape is thinner than the lengths that are fractions of its diagonal can "
			"resolve, as twigs on a trunk, all of them (edges, epsilon, spacing, tips) are fractions of "
			"the local thickness instead. Without, lengths are the same everywhere, as in the paper."},
		ParameterSpec {ParameterKind::Real, "relative_length", defaults.relativeLength,
			"Edge length in local thicknesses",
			"With 'adaptive': no edge is longer than this part of the local thickness, the radius of "
			"the largest ball inside. 0.6 gives about ten vertices around a tube; recommended: 0.4 to 1."}
			.asAdvanced(),
	};
}

ParameterSpec detailParameter(double standard)
{
	return {ParameterKind::Real, "detail", standard, "Detail",
		"How small the branches may be that the skeleton has, 0 to 1: those stay whose "
		"<i>mcfskel_significance</i> is at least 1 - detail. 0 leaves the trunk, 1 all; at 0.5 limbs stay "
		"that stand out by the radius of the ball that they hang on. Less detail only leaves out "
		"branches: what stays is the same."};
}

ParameterSpec poleMethodParameter()
{
	return {ParameterKind::Choice, "pole_method", double(mcf::Parameters().poleMethod),
		"Pole method",
		"How the medial pole of each vertex is found. 'voronoi': the farthest corner of its Voronoi "
		"cell inside the shape, as in the paper. 'balls': the ball that touches the surface at the "
		"vertex and shrinks until no other vertex is deeper in it than 0.02 % of the diagonal; much "
		"faster on large meshes.",
		{"voronoi", "balls"}};
}

ParameterSpec repairParameter()
{
	return {ParameterKind::Choice, "repair", double(mcf::Parameters().repair), "Repair",
		"What is done with a mesh that does not bound a solid. 'auto': small defects are mended; where that "
		"is not enough, as with large holes, soups or parts that run into each other, the surface is "
		"wrapped by winding numbers; sound meshes stay as they are. 'mend': no more than the former. "
		"'off': such a mesh is refused, and the message says why.",
		{"auto", "mend", "off"}};
}

std::vector<ParameterSpec> weightParameters()
{
	const mcf::Parameters defaults;
	return {
		{ParameterKind::Real, "w_l", defaults.wL, "Smoothness weight w_L",
			"Weight of the smoothing, above 0; 1 is half the published one. A larger one "
			"contracts in fewer steps and straightens the skeleton; recommended: 0.5 to 4."},
		{ParameterKind::Real, "w_h", defaults.wH, "Velocity weight w_H",
			"Weight that holds each vertex where it was, as published, above 0. A larger one "
			"makes smaller steps, and more of them; recommended: 10 to 50."},
		{ParameterKind::Real, "w_m", defaults.wM, "Medial weight w_M",
			"Weight that draws each vertex to its medial pole, as published. A larger one "
			"centres the skeleton better and keeps more branches; 0 is the mean curvature flow alone; "
			"recommended: 0 to 80."},
	};
}

ParameterSpec epsilonParameter()
{
	return {ParameterKind::Length, "epsilon", 100 * mcf::Parameters().epsilon,
		"Shortest edge epsilon",
		"Edges shorter than this are collapsed, mesh units or percent of the bounding box diagonal of "
		"the surface (of each connected component). A larger one gives a coarser skeleton in less "
		"time; recommended: 0.1 to 0.5 %. 0 takes the default of 0.2 %."};
}

ParameterSpec splitAngleParameter()
{
	return ParameterSpec {ParameterKind::Real, "split_angle", mcf::Parameters().splitAngle,
		"Split angle",
		"An edge is split if both angles opposite to it are wider than this, degrees. Smaller ones keep "
		"more triangles during the flow; recommended: 95 to 130."}
		.asAdvanced();
}

ParameterSpec fixSelectedParameter()
{
	return {ParameterKind::Boolean, "fix_selected", 0, "Hold the selected vertices",
		"Selected vertices of the surface stay exactly where they are while the rest contracts, at "
		"this step and at all that follow. The skeleton has a node at each of them, or in the middle of "
		"those that merge in it, and is not refined. On a surface that is resampled first, the "
		"vertices nearest to the selected ones are held, and all in triangles whose three corners "
		"are selected; turn resampling off to hold the very vertices."};
}

void readResampling(const ParameterValues& values, mcf::Parameters& parameters)
{
	parameters.targetLength = values.fraction("target_length");
	parameters.resampleIterations = values.integer("resample_iterations");
	parameters.denoise = values.flag("denoise");
}

void readAdaptive(const ParameterValues& values, mcf::Parameters& parameters)
{
	parameters.adaptive = values.flag("adaptive");
	parameters.relativeLength = values.real("relative_length");
}

double readEpsilon(const ParameterValues& values)
{
	const double epsilon = values.fraction("epsilon");
	return epsilon == 0 ? mcf::Parameters().epsilon : epsilon;
}

void readFlow(const ParameterValues& values, mcf::Parameters& parameters)
{
	parameters.wL = values.real("w_l");
	parameters.wH = values.real("w_h");
	parameters.wM = values.real("w_m");
	parameters.epsilon = readEpsilon(values);
	parameters.splitAngle = values.real("split_angle");
}

mcf::PoleMethod readPoleMethod(const ParameterValues& values)
{
	return values.integer("pole_method") == 0 ? mcf::PoleMethod::Voronoi : mcf::PoleMethod::Balls;
}

mcf::Repair readRepair(const ParameterValues& values)
{
	const int choice = values.integer("repair");
	return choice == 0 ? mcf::Repair::Auto : choice == 1 ? mcf::Repair::Mend : mcf::Repair::Off;
}

Results stageResults(const mcf::Stage& stage)
{
	const mcf::StageFigures figures = mcf::figuresOf(stage);
	return {
		{"iterations", figures.iteration},
		{"converged", figures.converged ? 1 : 0},
		{"volume_fraction", figures.volumeFraction},
		{"area_fraction", figures.areaFraction},
		{"fixed_fraction", figures.fixedFraction},
		{"vertices", figures.vertices},
		{"faces", figures.faces},
	};
}

Results repairResults(const mcf::SolidReport& report)
{
	return {
		{"repaired", int(report.outcome)},
		{"distance_mean", 100 * report.distanceMean},
		{"distance_max", 100 * report.distanceMax},
		{"self_intersections", report.selfIntersections},
		{"pieces_left_out", report.leftOut.small + report.leftOut.cavities},
	};
}

Results curveResults(const mcf::CurveSkeleton& skeleton)
{
	const mcf::SkeletonStatistics s = mcf::statistics(skeleton);
	return {
		{"skeleton_vertices", int(skeleton.position.size())},
		{"skeleton_edges", int(skeleton.edges.size())},
		{"components", s.components},
		{"cycles", s.cycles},
		{"branches", s.branches},
		{"terminals", s.terminals},
		{"junctions", s.junctions},
		{"skeleton_length", s.length},
	};
}

QString partOfVolume(double fraction)
{
	// Contracted lobes turn inside out, and then count as negative.
	if (fraction <= 0)
		return "no volume (parts are inside out)";
	return QString("%1 % of the volume").arg(100 * fraction, 0, 'g', 3);
}

QString stageLine(const mcf::StageFigures& figures)
{
	return QString(
		"Iteration %1: %2 vertices, %3 % of the area and %4 left, %5 % of the vertices fixed%6")
		.arg(figures.iteration)
		.arg(figures.vertices)
		.arg(100 * figures.areaFraction, 0, 'g', 3)
		.arg(partOfVolume(figures.volumeFraction))
		.arg(100 * figures.fixedFraction, 0, 'g', 3)
		.arg(figures.converged ? "; converged" : "");
}

std::vector<char> selectionToHold(const FilterRun& run, const SurfaceLayer& surface)
{
	if (!run.parameters.flag("fix_selected"))
		return {};
	std::vector<char> selected =
		readSelection(run.layer(), *surface.vertexOfSlot, surface.mesh->vertexSlots());
	if (selected.empty())
		throw mcf::InvalidInput("No vertex of the current layer '"
			+ run.layer().label().toStdString()
			+ "' is selected: select the vertices to hold, or leave 'fix_selected' off.");
	return selected;
}

StateSources sourcesOf(const FilterRun& run)
{
	return {run.document, run.log};
}

void refuseStage(const FilterRun& run)
{
	if (readStage(run.layer(), sourcesOf(run)))
		throw mcf::InvalidInput("The current layer '" + run.layer().label().toStdString()
			+ "' is a stage of the contraction, not a surface: make the surface layer current.");
	if (const QString lost = lostState(run.layer()); !lost.isEmpty())
		run.log(lost + " It is taken as a surface of its own.");
}

void logNotes(const FilterRun& run, const SurfaceLayer& surface)
{
	for (const std::string& note : surface.notes)
		run.log(QString::fromStdString(note));
}

mcf::NoteCallback noteLog(const FilterRun& run)
{
	return [&run](const std::string& note) { run.log(QString::fromStdString(note)); };
}

SurfaceLayer compactSurface(std::shared_ptr<const mcf::SurfaceMesh> mesh,
	std::shared_ptr<const mcf::SurfaceMesh> hollow, mcf::Repair soundWith)
{
	auto identity = std::make_shared<std::vector<int>>(size_t(mesh->vertexSlots()));
	std::iota(identity->begin(), identity->end(), 0);
	return {std::move(mesh), identity, {}, {}, std::move(hollow), soundWith};
}

PoledSurface surfaceWithPoles(
	FilterRun& run, mcf::PoleMethod method, mcf::Repair repair, const mcf::Progress& progress)
{
	PoledSurface result;
	SolidLayer read = readSolid(run.layer(), {repair, 0, true}, progress.part(0, 0.2));
	const bool isLayer = !read.isRepaired();
	result.surface = std::move(read.surface);
	result.solid = std::move(read.report);
	logNotes(run, result.surface);
	if (isLayer)
		result.poles = readPoles(run.layer(), result.surface, progress.cancelOnly());
	if (!result.poles) {
		run.log("The surface has no medial poles yet: computing them.");
		result.poles = std::make_shared<const mcf::PoleSet>(
			mcf::medialPoles(*result.surface.mesh, method, progress.part(0.2, 1)));
		result.computed = true;
	}
	return result;
}

QString stageLabel(const QString& name, const mcf::Stage& stage)
{
	return QString("%1_meso_%2").arg(name).arg(stage.iteration);
}

void addStages(DocumentEdit& edit, const FilterRun& run, KeptStages& stages,
	const SurfaceLink& surface, const mcf::Progress& progress)
{
	const QString name = baseName(run.layer());
	const double count = double(stages.size());
	for (size_t i = 0; i < stages.size(); ++i) {
		const mcf::Progress part = progress.part(double(i) / count, double(i + 1) / count);
		const StageFields fields = stages.takeFields(i, part.part(0, 0.5));
		edit.addStage(run.layer(), stageLabel(name, *stages.stage(i)), stages.stage(i), fields,
			surface, part.part(0.5, 1));
	}
}

} // namespace mcfskel
