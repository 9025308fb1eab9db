// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>
#include <skeleton/measures.h>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The volume that triangles enclose.
double volumeOf(const mcf::BallUnion& soup)
{
	double sum = 0;
	const vcg::Point3d& origin = soup.points.front();
	for (const mcf::Triangle& t : soup.triangles) {
		const vcg::Point3d a = soup.points[size_t(t[0])] - origin;
		const vcg::Point3d b = soup.points[size_t(t[1])] - origin;
		const vcg::Point3d c = soup.points[size_t(t[2])] - origin;
		sum += a * (b ^ c);
	}
	return sum / 6;
}

Results medialBalls(FilterRun& run)
{
	const CurveLayer curve = skeletonOn(run, run.layer());
	const double voxel = run.parameters.fraction("voxel") * referenceDiagonal(run.layer());
	// Balls half a voxel apart leave no ripples.
	mcf::CurveSkeleton balls = voxel > 0
		? mcf::resampledSkeleton(curve.skeleton, voxel / 2, 0, run.progress.part(0, 0.2))
		: curve.skeleton;
	const std::optional<SkeletonSurface> surface =
		findSurface(run, curve, run.progress.cancelOnly());
	if (surface)
		balls.radius =
			clearances(balls.position, *surface->surface.mesh, run.progress.part(0.2, 0.3));
	else
		run.log(
			"The surface of the skeleton is not known: the balls have the skeleton's own radius, "
			"which may reach outside.");
	const mcf::BallUnion soup =
		mcf::unionOfBalls(balls.position, balls.radius, voxel, run.progress.part(0.3, 1));

	const double volume = volumeOf(soup);
	const mcf::Progress end = run.progress.cancelOnly();
	const double whole = surface ? surface->surface.mesh->volume(end) : 0;

	MeshModel& source = run.layer();
	DocumentEdit edit(run.document);
	MeshModel& layer = edit.addPoints(source, baseName(source) + "_balls", soup.points);
	addFaces(layer, soup.triangles);
	Results results = {
		{"balls", int(balls.position.size())},
		{"vertices", int(soup.points.size())},
		{"faces", int(soup.triangles.size())},
		{"volume", volume},
	};
	if (surface)
		results["volume_fraction"] = volume / whole;
	edit.commit();
	return results;
}

} // namespace

FilterSpec medialBallsFilter()
{
	return {"generate_medial_balls_mcf", menuName("Medial Balls"),
		helpPage(
			"Makes a layer NAME_balls, the union of the balls around the current skeleton: the shape "
			"that the skeleton describes. Where it falls short of the surface, the skeleton lacks a "
			"branch, or the shape is flat there. The balls reach up to the surface; if that is not "
			"known, they have the skeleton's <i>mcfskel_radius</i>.<br><br>"
			"The union is polygonised by marching cubes."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::Length, "voxel", 0.7, "Voxel",
			 "Edge of the cubes, mesh units or percent of the diagonal, above 0. Smaller ones follow the "
			 "balls more closely and take more memory; recommended: 0.3 to 2 %."},
			surfaceParameter("The surface that the balls reach up to.")},
		medialBalls};
}

} // namespace mcfskel
