// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../io/files.h"
#include "../io/formats.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/support.h>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

Results run(FilterRun& run)
{
	const QString file = requiredName(run.parameters.text("file"), "to write");
	const CurveLayer curve = readCurve(run.layer());
	std::vector<int> sources = curve.nodeOfLayerVertex();
	QString surfaceName = curve.surfaceName;
	const int surfaceId = run.parameters.integer("surface");
	if (surfaceId != int(run.layer().id())) {
		const MeshModel* surface = run.document.getMesh(surfaceId);
		if (surface)
			sources = readNodes(*surface);
		if (!surface || sources.empty())
			throw mcf::InvalidInput(
				"The layer given as surface has no attribute mcfskel_node: choose the surface that "
				"the skeleton was made from.");
		surfaceName = surface->label();
	}
	for (const QString& warning : writeSkeleton(file, curve.skeleton, sources, surfaceName))
		run.log("Warning: " + warning);
	run.log(QString("Wrote '%1'.").arg(file));
	return curveResults(curve.skeleton);
}

} // namespace

FilterSpec saveSkeletonFilter()
{
	QStringList patterns;
	for (const SkeletonFormat& format : skeletonFormats())
		if (format.write)
			patterns << "*." + format.extension;
	return {"save_skeleton_mcf", menuName("Save Skeleton"),
		helpPage(
			"Writes the current layer, a skeleton, to a file in the format that its name ends with: "
			".swc (trees: each cycle is cut at its thinnest edge, and the log lists the cuts), .cg, "
			".graphml, .json and .ply (with edges). GraphML and JSON keep the radius and the surface "
			"vertices of each node. All but .ply are also found under File > Export (in MeshLab "
			"2020.09 all but .json and .ply)."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::FileToSave, "file", 0, "File",
			 "Name of the file to write; it ends with .swc, .cg, .graphml, .json or .ply.",
			 patterns},
			{ParameterKind::Layer, "surface", 0, "Surface",
				"The layer whose attribute mcfskel_node tells the surface vertices of each node. The "
				"skeleton's own layer stands for what the skeleton itself remembers."}},
		run};
}

} // namespace mcfskel
