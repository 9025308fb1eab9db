// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/pipeline.h>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results medialPoles(FilterRun& run)
{
	const SurfaceLayer surface = readSurface(run.layer(), run.progress.part(0, 0.2));
	logNotes(run, surface);
	const auto poles = std::make_shared<const mcf::PoleSet>(
		mcf::medialPoles(*surface.mesh, readPoleMethod(run.parameters), run.progress.part(0.2, 1)));
	const int without = poles->missing();
	const int found = int(poles->radius.size()) - without;

	DocumentEdit edit(run.document);
	if (run.parameters.flag("create_layer")) {
		std::vector<vcg::Point3d> points;
		for (size_t v = 0; v < poles->radius.size(); ++v)
			if (poles->has(int(v)))
				points.push_back(poles->centre[v]);
		edit.addPoints(run.layer(), baseName(run.layer()) + "_poles", points);
	}
	MeshModel& layer = run.layer();
	edit.writePoles(layer, surface, poles);
	Results results = {{"poles", found}, {"without_pole", without}};
	edit.commit();
	return results;
}

} // namespace

FilterSpec medialPolesFilter()
{
	return {"compute_medial_poles_mcf", menuName("Medial Poles"),
		helpPage(
			"Finds the medial pole of each vertex: the centre of a largest ball inside the shape that "
			"touches the surface there. The contraction is drawn to the poles, which keeps the "
			"skeleton in the middle of the shape.<br><br>"
			"Writes the vertex attributes <i>mcfskel_pole</i> and <i>mcfskel_pole_radius</i> (-1: no "
			"pole) on the layer. Second stage of the skeletonization."),
		FilterCategory::Quality, MeshModel::MM_FACENUMBER,
		{poleMethodParameter(),
			{ParameterKind::Boolean, "create_layer", 0, "Create a layer of the poles",
				"Also adds the poles as a layer of points, to look at them."}},
		medialPoles};
}

} // namespace mcfskel
