// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../io/files.h"
#include "../io/formats.h"
#include "all_filters.h"
#include "filter_support.h"
#include "skeletons.h"

#include <skeleton/support.h>

#include <iterator>
#include <string>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// The first stands for no unit at all.
const char* const unitNames[] = {"mesh units", "nm", "um", "mm"};

/// The number of a choice. @throws InvalidParameter, as scripts may give any number
int choiceOf(const FilterRun& run, const char* name, int count)
{
	const int choice = run.parameters.integer(name);
	if (choice < 0 || choice >= count)
		throw mcf::InvalidParameter("Parameter " + std::string(name) + " must be between 0 and "
			+ std::to_string(count - 1) + ".");
	return choice;
}

/// Gives the skeleton the correspondence of the chosen surface, or of the one that it remembers.
/// @return the surface's fingerprint; 0 if it is not known.
std::uint64_t takeSources(const FilterRun& run, CurveLayer& curve)
{
	const int surfaceId = run.parameters.integer("surface");
	if (surfaceId == int(run.layer().id())) {
		curve.skeleton.node = curve.nodeOfLayerVertex();
		return curve.surface.fingerprint;
	}
	const MeshModel* surface = run.document.getMesh(surfaceId);
	if (surface)
		curve.skeleton.node = readNodes(*surface);
	if (!surface || curve.skeleton.node.empty())
		throw mcf::InvalidInput(
			"The layer given as surface has no attribute mcfskel_node: choose the surface that "
			"the skeleton was made from.");
	curve.surfaceName = surface->label();
	return 0;
}

Results saveSkeleton(FilterRun& run)
{
	const QString file = requiredName(run.parameters.text("file"), "to write");
	CurveLayer curve = readCurve(run.layer(), sourcesOf(run));
	SkeletonContext context;
	if (needsSurface(file)) {
		const SkeletonSurface surface = requireSurface(run, curve, run.progress.part(0, 0.05));
		curve = skeletonOf(run, std::move(curve), surface, run.progress.part(0.05, 0.2));
		context.surface.position = surface.surface.mesh->position;
		context.surface.faces = surface.surface.mesh->triangles(run.progress.cancelOnly());
		context.progress = run.progress.part(0.2, 1);
	}
	else
		context.surfaceFingerprint = takeSources(run, curve);
	context.diagonal = referenceDiagonal(run.layer());
	if (!curve.skeleton.node.empty())
		context.surfaceName = curve.surfaceName.toStdString();
	context.swc.scale = run.parameters.real("scale");
	if (const int units = choiceOf(run, "units", int(std::size(unitNames))); units > 0)
		context.swc.units = unitNames[units];
	context.swc.soma = mcf::SwcSoma(choiceOf(run, "soma", 3));
	context.boneTolerance =
		run.parameters.fraction("bone_tolerance") * referenceDiagonal(run.layer());
	for (const QString& warning : writeSkeleton(file, curve.skeleton, context))
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
			".swc (neurons: trees, so each cycle is cut at its thinnest edge, and the log lists the "
			"cuts), .cg, .graphml, .json, .vtp (VTK, ParaView, 3D Slicer, VMTK), .ply (with edges) and "
			".glb (the surface with an armature and skin weights, to be posed in Blender and "
			"elsewhere). GraphML, JSON and .vtp keep the radius and the surface vertices of each node. "
			".swc, .cg, .graphml and .vtp are also found under File > Export; the .json and .ply that are "
			"found there are MeshLab's own, which lose the edges."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::FileToSave, "file", 0, "File",
			 "Name of the file to write; it ends with .swc, .cg, .graphml, .json, .vtp, .glb or .ply.",
			 patterns},
			{ParameterKind::Layer, "surface", 0, "Surface",
				"The layer whose attribute mcfskel_node tells the surface vertices of each node, and that "
				".glb moves. The skeleton's own layer stands for what the skeleton itself remembers."},
			{ParameterKind::Real, "scale", 1, "Scale (.swc)",
				"Every length in the file is multiplied with this."},
			{ParameterKind::Choice, "units", 0, "Units (.swc)",
				"The unit of the lengths after scaling, for the file's first line.",
				QStringList(std::begin(unitNames), std::end(unitNames))},
			{ParameterKind::Choice, "soma", 0, "Soma (.swc)",
				"Whether the thickest node is written as a soma (type 1) and the others as dendrites "
				"(type 3): never (all are of type 0, undefined), where it is at least twice as thick as the "
				"median node of its tree, or always.",
				{"none", "auto", "thickest"}},
			{ParameterKind::Length, "bone_tolerance", 1, "Tolerance of bones (.glb)",
				"A bone is straight; where the curve is farther from it than this it is divided."}},
		saveSkeleton};
}

} // namespace mcfskel
