// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/solid.h>

#include <optional>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results makeSolid(FilterRun& run)
{
	const mcf::SolidChoices choices(
		mcf::Repair::Auto, 0, false, run.parameters.fraction("sheet_thickness"));
	const SolidLayer made = readSolid(run.layer(), choices, run.progress.part(0, 0.9));
	logNotes(run, made.surface);
	const mcf::SolidReport& report = made.report;
	if (report.outcome == mcf::SolidReport::Sound)
		run.log("The surface bounds a solid as it is.");
	int cavities = 0;
	const std::optional<mcf::SurfaceMesh> hollow = mcf::withCavitiesInward(
		*made.surface.mesh, made.surface.turned, cavities, run.progress.part(0.9, 0.95));
	const mcf::SurfaceMesh& mesh = hollow ? *hollow : *made.surface.mesh;

	DocumentEdit edit(run.document);
	MeshModel& layer = edit.addSurface(
		run.layer(), baseName(run.layer()) + "_solid", mesh, run.progress.part(0.95, 1));
	if (!hollow)
		edit.attachSurface(layer, compactSurface(made.surface.mesh, nullptr, mcf::Repair::Auto));
	Results results = repairResults(report);
	results.merge(Results {
		{"vertices", mesh.vertexCount()},
		{"faces", mesh.faceCount()},
		{"gaps_bridged", report.mended.gapsBridged},
		{"holes_closed", report.mended.holesClosed},
		{"edges_parted", report.mended.edgesParted},
		{"vertices_parted", report.mended.verticesParted},
		{"pieces_dropped", report.mended.piecesDropped + report.piecesDropped},
		{"handles", report.handles},
		{"wrapped", report.outcome == mcf::SolidReport::Wrapped ? 1 : 0},
	});
	edit.commit();
	return results;
}

} // namespace

FilterSpec makeSolidFilter()
{
	return {"generate_solid_mcf", menuName("Make Solid"),
		helpPage(
			"Makes the closed, two-manifold surface of the solid that a mesh describes, as a new layer, "
			"with as few changes as possible. A surface that is sound stays as it is. Small defects are mended where "
			"they are: duplicate faces, coincident vertices, edges with more than two faces, faces turned "
			"against their neighbours, T-junctions, small holes; the rest keeps its vertices. Where that is "
			"not enough, as with large holes, soups of triangles or parts that run into each other, the "
			"surface is wrapped: the new one is where the winding number of the triangles is one half.<br><br>"
			"The log says what was done, and how far the result is from the input. A sheet that bounds "
			"nothing is refused, unless it is given a thickness."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER,
		{
			{ParameterKind::Length, "sheet_thickness", 0, "Thickness of sheets",
				"Thickness of an open sheet, which bounds no solid by itself; mesh units or percent of the "
				"diagonal: both sides move outwards by half of it, and walls close the borders. 0: refused; "
				"recommended for sheets: 0.5 to 2 %."},
		},
		makeSolid};
}

} // namespace mcfskel
