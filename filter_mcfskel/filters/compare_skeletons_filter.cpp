// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>
#include <skeleton/support.h>

#include <vcg/space/box3.h>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The diagonal that distances are divided by: the surface's, else that around both skeletons.
double sharedDiagonal(FilterRun& run, const CurveLayer& mine, const CurveLayer& other)
{
	if (const std::optional<SkeletonSurface> surface =
			findSurface(run, mine, run.progress.cancelOnly()))
		return surface->surface.mesh->bounds(run.progress.cancelOnly()).Diag();
	run.log(
		"The surface is not known: distances are divided by the diagonal of the box around both "
		"skeletons.");
	vcg::Box3d box;
	for (const CurveLayer* curve : {&mine, &other})
		for (const vcg::Point3d& p : curve->skeleton.position)
			box.Add(p);
	return box.Diag();
}

Results compareSkeletons(FilterRun& run)
{
	const CurveLayer mine = skeletonOn(run, run.layer());
	const int otherId = run.parameters.integer("other");
	MeshModel* otherLayer = run.document.getMesh(otherId);
	if (!otherLayer || otherId == int(run.layer().id()))
		throw mcf::InvalidInput(
			"A skeleton compared with itself differs nowhere: give another layer as the parameter "
			"other.");
	requireOneFrame(run.layer(), *otherLayer);
	const CurveLayer other = skeletonOn(run, *otherLayer);
	const double diagonal = sharedDiagonal(run, mine, other);
	if (!(diagonal > 0))
		throw mcf::InvalidInput("Both skeletons are one point: there is no length to compare by.");
	const double spacing = run.parameters.real("spacing") / 100 * diagonal;
	const mcf::SkeletonDistance there =
		mcf::distanceToSkeleton(mine.skeleton, other.skeleton, spacing, run.progress.part(0, 0.5));
	const mcf::SkeletonDistance back =
		mcf::distanceToSkeleton(other.skeleton, mine.skeleton, spacing, run.progress.part(0.5, 1));
	Results results = {
		{"distance_mean", there.mean / diagonal},
		{"distance_max", there.greatest / diagonal},
		{"distance_mean_back", back.mean / diagonal},
		{"distance_max_back", back.greatest / diagonal},
		{"diagonal", diagonal},
	};
	setVertexQuality(run.layer(), there.ofNode);
	setVertexColours(run.layer(), there.ofNode, 0, there.greatest);
	return results;
}

} // namespace

FilterSpec compareSkeletonsFilter()
{
	FilterSpec spec = {"compute_skeleton_distance_mcf", menuName("Compare Skeletons"),
		helpPage(
			"Measures how far the current skeleton is from another one, and the other one from it, as "
			"in Table 1 of the paper: the mean and the greatest distance of points spread evenly over "
			"the one from the other, divided by the bounding box diagonal of the surface. The two "
			"directions differ where one has a branch that the other lacks.<br><br>"
			"The vertex quality and colour of the current layer show where they differ: for each node "
			"the distance to the other skeleton, mesh units. The radius stays in "
			"<i>mcfskel_radius</i>."),
		FilterCategory::Quality, MeshModel::MM_NONE,
		{{ParameterKind::Layer, "other", 0, "Other skeleton",
			 "The layer of the skeleton to compare with."},
			{ParameterKind::Real, "spacing", 0.1, "Sampling distance",
				"The skeletons are sampled so that no piece is longer than this, percent of the "
				"diagonal, above 0; the paper takes 0.1."},
			surfaceParameter("The surface whose diagonal the distances are divided by.")},
		compareSkeletons};
	spec.changes = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
	return spec;
}

} // namespace mcfskel
