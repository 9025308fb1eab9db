// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>
#include <skeleton/pipeline.h>

#include <string>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results refineSkeleton(FilterRun& run)
{
	const CurveLayer found = skeletonOn(run, run.layer());
	const SkeletonSurface surface = requireSurface(run, found, run.progress.part(0, 0.1));
	CurveLayer curve = skeletonOf(run, found, surface, run.progress.part(0.1, 0.2));
	// Bridges are outside of the surface: they are made again, between what the pieces have become.
	const bool isJoined = !curve.skeleton.bridge.empty();
	curve.skeleton = mcf::withoutBridges(curve.skeleton);
	mcf::RefineParameters parameters;
	parameters.spurProminence = run.parameters.real("spur_prominence");
	parameters.smoothing = run.parameters.real("smoothing");
	parameters.detail = run.parameters.real("detail");
	parameters.adaptive = run.parameters.flag("adaptive");
	parameters.relativeLength = run.parameters.real("relative_length");
	parameters.check();
	mcf::Refinement refinement = mcf::refineChecked(
		curve.skeleton, *surface.surface.mesh, parameters, run.progress.part(0.2, 0.95));
	if (const std::string text = refinement.report.text(); !text.empty())
		run.log(QString::fromStdString(text));

	if (isJoined)
		mcf::joinPieces(refinement.skeleton, *surface.surface.mesh, run.progress.cancelOnly());
	Results results = curveResults(refinement.skeleton);
	results["refined"] = refinement.report.fraction();
	addDerivedSkeleton(
		run, curve, std::move(refinement.skeleton), "refined", false, run.progress.part(0.95, 1));
	return results;
}

} // namespace

FilterSpec refineSkeletonFilter()
{
	const mcf::RefineParameters defaults;
	const std::vector<ParameterSpec> adaptive = adaptiveParameters();
	return {"generate_refined_skeleton_mcf", menuName("Refine Skeleton"),
		helpPage(
			"Makes the current skeleton a better one of its surface, as a new layer NAME_refined: "
			"removes spurs, merges junctions that lie close together, samples the branches evenly, centres the "
			"nodes in the maximal balls of the surface and smooths the branches, extends the tips to "
			"the ends of their features, and grows branches into limbs that the curve lacks. "
			"Components and cycles stay as they are, and nothing leaves the shape: a component for which "
			"this fails keeps its curve unchanged. The log says so, and the result "
			"<i>refined</i> is the fraction of the components that are refined.<br><br>"
			"Its <i>mcfskel_significance</i> tells how much of the shape the branch of each node describes. The "
			"surface's <i>mcfskel_node</i> follows. This stage goes beyond the paper."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{surfaceParameter("The surface that the skeleton is refined in."),
			{ParameterKind::Real, "smoothing", defaults.smoothing, "Smoothness",
				"How smooth the branches become, against how well centred; at least 0; recommended: 4 to "
				"400."},
			detailParameter(defaults.detail),
			ParameterSpec {ParameterKind::Real, "spur_prominence", defaults.spurProminence,
				"Spur prominence",
				"A terminal branch whose end ball sticks out of the ball at its junction by less than "
				"this part of the latter's radius is a spur, 0 to 1, and so is one that ends where a "
				"shorter one does. Larger values remove small features, 0 removes nothing."}
				.asAdvanced(),
			adaptive[0], adaptive[1]},
		refineSkeleton};
}

} // namespace mcfskel
