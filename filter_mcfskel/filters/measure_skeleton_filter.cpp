// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/measures.h>
#include <skeleton/solid.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The surface with its own cavities, or with those of the mesh it was made from; null if none.
std::shared_ptr<const mcf::SurfaceMesh> hollowOf(
	const SurfaceLayer& surface, const mcf::Progress& progress)
{
	if (surface.hollow)
		return surface.hollow;
	int cavities = 0;
	std::optional<mcf::SurfaceMesh> own =
		mcf::withCavitiesInward(*surface.mesh, surface.turned, cavities, progress);
	return own ? std::make_shared<const mcf::SurfaceMesh>(*std::move(own)) : nullptr;
}

Results measureSkeleton(FilterRun& run)
{
	const CurveLayer curve = skeletonOn(run, run.layer());
	const SkeletonSurface surface = requireSurface(run, curve, run.progress.part(0, 0.1));
	const std::shared_ptr<const mcf::SurfaceMesh> hollow =
		hollowOf(surface.surface, run.progress.part(0.1, 0.2));
	const mcf::SkeletonMeasures m = mcf::skeletonMeasures(
		curve.skeleton, hollow ? *hollow : *surface.surface.mesh, {}, run.progress.part(0.2, 1));
	const auto& distance = m.nodeMedialDistance;
	if (hollow)
		run.log("The surface has cavities, which count as outside.");
	Results results = curveResults(curve.skeleton);
	results.merge(Results {
		{"inside_fraction", m.insideFraction},
		{"out_depth_max_pct", 100 * m.outDepthMax},
		{"medial_mean_pct", 100 * m.medialMean},
		{"medial_p95_pct", 100 * m.medialP95},
		{"medial_max_pct", 100 * m.medialMax},
		{"off_centre_mean", m.offCentreMean},
		{"cover_mean_pct", 100 * m.coverMean},
		{"cover_max_pct", 100 * m.coverMax},
		{"recon_mean_pct", 100 * m.reconMean},
		{"recon_p95_pct", 100 * m.reconP95},
		{"recon_max_pct", 100 * m.reconMax},
		{"ball_volume_fraction", m.volumeFraction},
		{"spurs", m.spurs},
	});
	setVertexQuality(run.layer(), distance);
	setVertexColours(run.layer(), distance, 0, *std::max_element(distance.begin(), distance.end()));
	return results;
}

} // namespace

FilterSpec measureSkeletonFilter()
{
	FilterSpec spec = {"compute_skeleton_measures_mcf", menuName("Measure Skeleton"),
		helpPage(
			"Measures how good the current skeleton is of its surface. <i>inside_fraction</i>: part of "
			"its length that is inside; <i>out_depth_max_pct</i>: how far outside it gets. <i>medial</i>: "
			"its distance to the medial axis, the centres of balls inside that touch the surface at two "
			"places at least 60 degrees apart; <i>off_centre_mean</i>: the mean of 1 - d / R for its "
			"distance d from the surface and the radius R of the nearest of these balls, 0 in the middle "
			"and 1 on the surface. <i>cover</i>: distance from the surface "
			"to the skeleton. <i>recon</i>: distance from the surface to the union of the skeleton's "
			"balls, what the skeleton does not describe; <i>ball_volume_fraction</i>: the part of the "
			"volume that they fill. <i>spurs</i>: branches that describe nothing. "
			"All ending in <i>pct</i> are percent of the surface's bounding box diagonal.<br><br>"
			"The vertex quality and colour of the skeleton become the distance to the medial axis, mesh "
			"units; the radius stays in <i>mcfskel_radius</i>."),
		FilterCategory::Quality, MeshModel::MM_NONE,
		{surfaceParameter("The surface to measure against, closed.")}, measureSkeleton};
	spec.changes = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
	return spec;
}

} // namespace mcfskel
