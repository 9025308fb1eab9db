// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>

#include <algorithm>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results resampleSkeleton(FilterRun& run)
{
	const CurveLayer curve = skeletonOn(run, run.layer());
	const double diagonal = referenceDiagonal(run.layer());
	mcf::CurveSkeleton resampled =
		mcf::resampledSkeleton(curve.skeleton, run.parameters.fraction("longest_edge") * diagonal,
			run.parameters.fraction("smoothing") * diagonal, run.progress.part(0, 0.9));
	double longest = 0, shortest = resampled.edges.empty() ? 0 : diagonal;
	for (const auto& [a, b] : resampled.edges) {
		const double length =
			vcg::Distance(resampled.position[size_t(a)], resampled.position[size_t(b)]);
		longest = std::max(longest, length);
		shortest = std::min(shortest, length);
	}
	Results results = curveResults(resampled);
	results["edge_length_max"] = longest;
	results["edge_length_min"] = shortest;
	addDerivedSkeleton(
		run, curve, std::move(resampled), "smoothed", false, run.progress.part(0.9, 1));
	return results;
}

} // namespace

FilterSpec resampleSkeletonFilter()
{
	return {"generate_resampled_skeleton_mcf", menuName("Resample and Smooth Skeleton"),
		helpPage(
			"Samples each branch of the current skeleton evenly, with no edge longer than a given "
			"length, and smooths it, as a new layer NAME_smoothed. Tips and junctions stay in their "
			"places, the graph keeps its branches and cycles; the radius is interpolated.<br><br>"
			"The surface's <i>mcfskel_node</i> follows to the nearest node of the branch."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::Length, "longest_edge", 0.1, "Longest edge",
			 "No edge is longer, mesh units or percent of the diagonal, above 0. The paper measures at "
			 "0.1 %; edges that are long compared to the bends of a branch cut its corners."},
			{ParameterKind::Length, "smoothing", 0.5, "Smoothing length",
				"Waves along a branch shorter than about six times this are flattened, mesh units or "
				"percent of the diagonal. 0: no smoothing; recommended: up to 2 %, more may leave the "
				"shape where it bends."}},
		resampleSkeleton};
}

} // namespace mcfskel
