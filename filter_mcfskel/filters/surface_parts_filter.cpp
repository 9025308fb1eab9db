// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../layers/fields.h"
#include "all_filters.h"
#include "skeletons.h"

#include <skeleton/curves.h>
#include <skeleton/measures.h>
#include <skeleton/support.h>

#include <Eigen/Core>

#include <algorithm>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// A column of the branch table: one number for each branch.
template <class Value>
QVariant column(size_t rows, const Value& value)
{
	Eigen::VectorXd numbers(rows);
	for (size_t i = 0; i < rows; ++i)
		numbers[Eigen::Index(i)] = double(value(i));
	return QVariant::fromValue(numbers);
}

Results surfaceParts(FilterRun& run)
{
	CurveLayer curve = skeletonOn(run, run.layer());
	const SkeletonSurface target = requireSurface(run, curve, run.progress.part(0, 0.1));
	const mcf::SurfaceMesh& mesh = *target.surface.mesh;
	mcf::CurveSkeleton& skeleton = curve.skeleton;
	skeleton.node = nodesOnSurface(run, curve, target, run.progress.part(0.1, 0.15));
	if (skeleton.node.empty()) {
		run.log(
			"The correspondence of the skeleton is not known: each vertex of the surface belongs to "
			"the nearest node.");
		skeleton.node = mcf::closestNodes(mesh.position, skeleton, run.progress.part(0.15, 0.2));
	}
	const mcf::SurfaceParts parts = mcf::surfaceParts(mesh, skeleton, run.progress.part(0.2, 0.9));
	const auto branches = mcf::branchTable(skeleton, mcf::skeletonBranches(skeleton));
	std::vector<double> area(branches.size(), 0);
	mcf::detail::reportedLoop(
		mesh.faceSlots(), run.progress.cancelOnly(), "Measuring the parts", [&](int f) {
			if (const int part = parts.ofFace[size_t(f)]; part >= 0)
				area[size_t(part)] += mesh.doubleAreaVector(f).Norm() / 2;
		});
	const std::vector<int> ofSlot = facePartsOfSlots(
		target.layer.in(run.document), target.surface, parts.ofFace, run.progress.part(0.9, 1));

	const size_t n = branches.size();
	Results results = {
		{"branches", int(n)},
		{"parts", int(std::count_if(area.begin(), area.end(), [](double a) { return a > 0; }))},
		{"branch_length", column(n, [&](size_t i) { return branches[i].length; })},
		{"branch_radius_mean", column(n, [&](size_t i) { return branches[i].meanRadius; })},
		{"branch_radius_min", column(n, [&](size_t i) { return branches[i].minRadius; })},
		{"branch_radius_max", column(n, [&](size_t i) { return branches[i].greatestRadius; })},
		{"branch_significance", column(n, [&](size_t i) { return branches[i].significance; })},
		{"branch_area", column(n, [&](size_t i) { return area[i]; })},
		{"branch_first_kind", column(n, [&](size_t i) { return int(branches[i].first); })},
		{"branch_last_kind", column(n, [&](size_t i) { return int(branches[i].last); })},
	};
	MeshModel& layer = target.layer.in(run.document);
	setFaceParts(layer, ofSlot);
	setVertexQuality(layer, target.surface, parts.distance);
	return results;
}

} // namespace

FilterSpec surfacePartsFilter()
{
	FilterSpec spec = {"compute_skeleton_parts_mcf", menuName("Parts of the Surface"),
		helpPage(
			"Cuts the surface into the parts that belong to the branches of the current skeleton: each "
			"face gets the number of its branch as quality, and a colour. Parts are connected, their "
			"borders short and smooth. The vertex quality of the surface becomes the local thickness, "
			"the distance of each vertex to its branch.<br><br>"
			"Numbers for each branch, in that order: <i>branch_length</i>, <i>branch_radius_mean</i>, "
			"<i>_min</i>, <i>_max</i>, <i>branch_significance</i> (1 where it is not known), <i>branch_area</i> "
			"of its part, and what its two ends are, "
			"<i>branch_first_kind</i> and <i>branch_last_kind</i>: 0 a tip, 1 a junction, 2 the branch "
			"itself, a ring. A short branch between two junctions may have no part."),
		FilterCategory::Quality, MeshModel::MM_NONE,
		{surfaceParameter("The surface to cut into parts, closed.")}, surfaceParts};
	spec.changes = MeshModel::MM_FACEQUALITY | MeshModel::MM_FACECOLOR | MeshModel::MM_VERTQUALITY;
	return spec;
}

} // namespace mcfskel
