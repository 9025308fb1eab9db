// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>

#include <numeric>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results pruneSkeleton(FilterRun& run)
{
	const CurveLayer curve = skeletonOn(run, run.layer());
	const double diagonal = referenceDiagonal(run.layer());
	mcf::PruneParameters parameters;
	parameters.spurProminence = run.parameters.real("spur_prominence");
	parameters.detail = run.parameters.real("detail");
	parameters.shortestBranch = run.parameters.fraction("min_length") * diagonal;
	parameters.minRadius = run.parameters.fraction("min_radius") * diagonal;
	parameters.mergeJunctions = run.parameters.flag("merge_junctions");
	parameters.check();

	// Every node is its own source, so that the result tells where each has gone.
	mcf::CurveSkeleton tracked = curve.skeleton;
	tracked.node.resize(tracked.position.size());
	std::iota(tracked.node.begin(), tracked.node.end(), 0);
	if (const std::optional<SkeletonSurface> surface =
			findSurface(run, curve, run.progress.part(0, 0.2)))
		tracked.radius =
			clearances(tracked.position, *surface->surface.mesh, run.progress.part(0.2, 0.6));
	else
		run.log("The surface of the skeleton is not known: its own radius decides.");
	mcf::CurveSkeleton pruned = mcf::prune(tracked, parameters, run.progress.part(0.6, 0.9));

	const std::vector<int> target = pruned.node;
	pruned.node.clear();
	for (int v : curve.skeleton.node)
		pruned.node.push_back(v < 0 ? -1 : target[size_t(v)]);
	for (size_t v = target.size(); v-- > 0;)
		if (pruned.position[size_t(target[v])] == tracked.position[v])
			pruned.radius[size_t(target[v])] = curve.skeleton.radius[v];
	// Merged junctions move, so edges that lead to them may grow: only edges that are gone count.
	double lengthRemoved = 0;
	for (const auto& [a, b] : tracked.edges)
		if (target[size_t(a)] == target[size_t(b)])
			lengthRemoved +=
				vcg::Distance(tracked.position[size_t(a)], tracked.position[size_t(b)]);
	const mcf::SkeletonStatistics before = mcf::statistics(tracked);
	Results results = curveResults(pruned);
	const mcf::SkeletonStatistics after = mcf::statistics(pruned);
	results["terminals_removed"] = before.terminals - after.terminals;
	results["junctions_removed"] = before.junctions - after.junctions;
	results["length_removed"] = lengthRemoved;
	addDerivedSkeleton(run, curve, std::move(pruned), "pruned", true, run.progress.part(0.9, 1));
	return results;
}

} // namespace

FilterSpec pruneSkeletonFilter()
{
	const mcf::PruneParameters defaults;
	return {"generate_pruned_skeleton_mcf", menuName("Prune Skeleton"),
		helpPage(
			"Removes branches of the current skeleton that end in a tip and merges junctions that are "
			"one, as a new layer NAME_pruned: first spurs, whose end ball hardly sticks out of the ball "
			"at their junction, then branches below the detail, then those that are too "
			"short, then those that are too thin. Cycles and components stay as they are.<br><br>"
			"What had merged into a removed branch goes to its junction: <i>mcfskel_node</i> of the "
			"surface follows."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::Real, "spur_prominence", defaults.spurProminence, "Spur prominence",
			 "A terminal branch whose end ball sticks out of the ball at its junction by less than this "
			 "part of the latter's radius is a spur, 0 to 1. 0 keeps all; 0.1 removes what describes "
			 "nothing; more removes small features."},
			detailParameter(defaults.detail),
			{ParameterKind::Length, "min_length", 0, "Shortest branch",
				"Terminal branches shorter than this go, mesh units or percent of the diagonal; the "
				"shortest first. 0: none; recommended: up to 10 %."},
			{ParameterKind::Length, "min_radius", 0, "Minimum radius",
				"Terminal branches with a smaller mean radius go, mesh units or percent of the "
				"diagonal; the thinnest first. 0: none; recommended: up to 5 %."},
			{ParameterKind::Boolean, "merge_junctions", double(defaults.mergeJunctions),
				"Merge close junctions",
				"Junctions closer to each other than the radius of the larger one become one, in the "
				"place of that one, where no cycle vanishes by it."},
			surfaceParameter("The surface that the radius is measured to.")},
		pruneSkeleton};
}

} // namespace mcfskel
