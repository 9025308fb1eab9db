// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/measures.h>
#include <skeleton/support.h>

#include <algorithm>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results medialAxis(FilterRun& run)
{
	mcf::MedialAxisParameters parameters;
	parameters.minAngle = run.parameters.real("min_angle");
	parameters.minRadius = run.parameters.fraction("min_radius") * referenceDiagonal(run.layer());
	parameters.maxStretch = run.parameters.real("max_stretch");
	parameters.check();
	const PoledSurface poled = surfaceWithPoles(
		run, mcf::Parameters().poleMethod, mcf::Repair::Off, run.progress.part(0, 0.5));
	const mcf::MedialAxis medial = mcf::medialAxis(*poled.surface.mesh, *poled.poles,
		run.parameters.flag("joined"), parameters, run.progress.part(0.5, 1));
	if (medial.position.empty())
		throw mcf::InvalidInput(
			"No pole is left: choose a smaller min_angle or min_radius, or a larger max_stretch.");

	MeshModel& source = run.layer();
	const double largest = *std::max_element(medial.radius.begin(), medial.radius.end());
	DocumentEdit edit(run.document);
	MeshModel& layer = edit.addPoints(source, baseName(source) + "_medial", medial.position);
	addFaces(layer, medial.triangles);
	setVertexQuality(layer, medial.radius);
	setVertexColours(layer, medial.radius, 0, largest);
	if (poled.computed)
		edit.writePoles(source, poled.surface, poled.poles);
	Results results = {
		{"vertices", int(medial.position.size())},
		{"faces", int(medial.triangles.size())},
		{"radius_min", *std::min_element(medial.radius.begin(), medial.radius.end())},
		{"radius_max", largest},
	};
	edit.commit();
	return results;
}

} // namespace

FilterSpec medialAxisFilter()
{
	const mcf::MedialAxisParameters defaults;
	return {"generate_medial_axis_mcf", menuName("Medial Axis"),
		helpPage(
			"Makes a layer NAME_medial of the surface's medial poles, joined by triangles as their "
			"vertices are on the surface, to lay beside a meso-skeleton: the medial axis as far as the "
			"contraction knows it. Vertex quality and colour are the radius of the pole's ball.<br><br>"
			"Uses the poles that the layer carries, and computes them if it has none. Sheets of the "
			"medial axis appear once from each side."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER,
		{{ParameterKind::Boolean, "joined", 1, "Join the poles",
			 "Joins the poles by triangles; otherwise they are a cloud of points."},
			{ParameterKind::Real, "min_angle", defaults.minAngle, "Minimum angle",
				"Poles whose ball touches the surface in a narrower angle, seen from the pole, are left "
				"out, degrees, 0 to 180. Noise makes narrow ones; recommended: 30 to 120."},
			{ParameterKind::Length, "min_radius", 0, "Minimum radius",
				"Poles with a smaller ball are left out, mesh units or percent of the diagonal."},
			ParameterSpec {ParameterKind::Real, "max_stretch", defaults.maxStretch,
				"Maximum stretch",
				"Triangles with an edge more than this many times as long as on the surface are left "
				"out, above 0: they join different sheets. Recommended: 2 to 10."}
				.asAdvanced()},
		medialAxis};
}

} // namespace mcfskel
