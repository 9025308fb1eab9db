// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/pipeline.h>

#include <memory>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results resample(FilterRun& run)
{
	mcf::Parameters parameters;
	readResampling(run.parameters, parameters);
	readAdaptive(run.parameters, parameters);
	parameters.check();
	const SolidLayer solid =
		readSolid(run.layer(), {readRepair(run.parameters), 0, true}, run.progress.part(0, 0.1));
	const SurfaceLayer& surface = solid.surface;
	logNotes(run, surface);
	mcf::ResampledSurface made =
		mcf::resampledSurface(*surface.mesh, parameters, run.progress.part(0.1, 1), noteLog(run));
	const SurfaceLayer resampled =
		compactSurface(std::make_shared<const mcf::SurfaceMesh>(std::move(made.mesh)),
			surface.hollow, surface.soundWith);
	const mcf::SurfaceMesh& mesh = *resampled.mesh;

	DocumentEdit edit(run.document);
	MeshModel& layer = edit.addSurface(
		run.layer(), baseName(run.layer()) + "_resampled", mesh, run.progress.cancelOnly());
	edit.attachSurface(layer, resampled);
	Results results = {{"vertices", mesh.vertexCount()}, {"faces", mesh.faceCount()},
		{"edge_length_mean", mcf::meanEdgeLength(mesh)}};
	results.merge(repairResults(solid.report));
	edit.commit();
	return results;
}

} // namespace

FilterSpec resampleFilter()
{
	std::vector<ParameterSpec> parameters = {
		targetLengthParameter(), resampleIterationsParameter(), denoiseParameter()};
	for (const ParameterSpec& adaptive : adaptiveParameters())
		parameters.push_back(adaptive);
	parameters.push_back(repairParameter());
	return {"meshing_isotropic_resampling_mcf", menuName("Resample"),
		helpPage(
			"Covers the surface with triangles of even size, smaller where it is thin, as a new layer: the skeleton is only as "
			"good as the sampling that it is computed from. Splits long edges, collapses short ones, "
			"flips edges towards six neighbours for each vertex, evens the vertices out along the "
			"surface and puts them back onto it; the topology stays.<br><br>"
			"First stage of the skeletonization."),
		FilterCategory::Remeshing, MeshModel::MM_FACENUMBER, parameters, resample};
}

} // namespace mcfskel
