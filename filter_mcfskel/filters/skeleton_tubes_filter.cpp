// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/support.h>
#include <skeleton/tubes.h>

#include <algorithm>
#include <vector>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results skeletonTubes(FilterRun& run)
{
	const CurveLayer curve = skeletonOn(run, run.layer());
	const double thinnest = run.parameters.fraction("radius") * referenceDiagonal(run.layer());
	if (!(thinnest > 0))
		throw mcf::InvalidParameter("Parameter radius must be above 0.");
	std::vector<double> radius(curve.skeleton.position.size(), thinnest);
	if (run.parameters.flag("local_radius"))
		for (size_t v = 0; v < radius.size(); ++v)
			radius[v] = std::max(thinnest, curve.skeleton.radius[v]);
	const char* const what = "Making tubes";
	const mcf::SkeletonTubes tubes = mcf::skeletonTubes(
		curve.skeleton, radius, run.parameters.integer("sides"), run.progress.part(0.1, 0.5));
	std::vector<double> thickness;
	for (int node : tubes.node)
		thickness.push_back(curve.skeleton.radius[size_t(node)]);
	const auto [minimum, maximum] = std::minmax_element(thickness.begin(), thickness.end());

	run.progress.report(0.5, what);
	MeshModel& source = run.layer();
	DocumentEdit edit(run.document);
	MeshModel& layer = edit.addPoints(source, baseName(source) + "_tubes", tubes.points);
	addFaces(layer, tubes.triangles);
	run.progress.report(0.8, what);
	setVertexQuality(layer, thickness);
	setVertexColours(layer, thickness, *minimum, *maximum);
	run.log(QString(
		"Colours: thickness from %1 (blue) to %2 (red), mesh units; also the vertex quality.")
				.arg(*minimum)
				.arg(*maximum));
	Results results = {
		{"tubes", tubes.pieces},
		{"vertices", int(tubes.points.size())},
		{"faces", int(tubes.triangles.size())},
	};
	edit.commit();
	return results;
}

} // namespace

FilterSpec skeletonTubesFilter()
{
	return {"generate_skeleton_tubes_mcf", menuName("Skeleton to Tubes"),
		helpPage(
			"Makes a layer NAME_tubes: a closed tube with round ends around each branch of the current "
			"skeleton, to be seen from afar, printed, or taken to programs that draw no lines. Each tube "
			"is a closed two-manifold; they overlap at junctions. The vertex colour and quality are the "
			"local thickness of the shape, whatever the radius of the tubes."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::Length, "radius", 0.4, "Radius",
			 "Of the tubes; with the local radius the minimum."},
			{ParameterKind::Boolean, "local_radius", 0, "Local radius",
				"The tubes are as thick as the shape, by <i>mcfskel_radius</i>. They fill much of it, and "
				"where the curve bends within its radius they pass through themselves."},
			ParameterSpec {ParameterKind::Integer, "sides", 12, "Sides",
				"Of a tube's section, at least 3; so many that there would be more than 10 million "
				"points are refused."}
				.asAdvanced()},
		skeletonTubes};
}

} // namespace mcfskel
