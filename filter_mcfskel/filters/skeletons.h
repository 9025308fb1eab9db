// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the filters that take a skeleton share: the skeleton, its surface, and the
/// correspondence between the two.

#ifndef MCFSKEL_FILTERS_SKELETONS_H
#define MCFSKEL_FILTERS_SKELETONS_H

#include "filter_support.h"

#include <skeleton/state.h>

#include <optional>
#include <vector>

namespace mcfskel {

/// The skeleton on a layer with a radius for each node: from the attribute, else from the quality,
/// else 0.
CurveLayer skeletonOn(const FilterRun& run, const MeshModel& layer);

/// For layers whose coordinates are combined. @throws InvalidInput if their matrices differ.
void requireOneFrame(const MeshModel& one, const MeshModel& other);

/// The parameter `surface`; its default, the skeleton's own layer, stands for the surface that the
/// skeleton remembers.
ParameterSpec surfaceParameter(const QString& whatFor);

/// A surface that goes with a skeleton.
struct SkeletonSurface
{
	LayerAsRead layer;
	SurfaceLayer surface;
};

/// The surface that the parameter names; none if it names none and the skeleton remembers none that
/// is still there and unchanged. @throws InvalidInput as readSurface(), and as requireOneFrame()
/// for one that the skeleton does not remember; Cancelled
std::optional<SkeletonSurface> findSurface(
	const FilterRun& run, const CurveLayer& curve, const vcg::tri::mcf::Progress& progress);

/// The same where it cannot be done without. @throws InvalidInput saying what to choose; Cancelled
SkeletonSurface requireSurface(
	const FilterRun& run, const CurveLayer& curve, const vcg::tri::mcf::Progress& progress);

/**
 * The node of each vertex of a surface: from the skeleton's correspondence, by the nearest vertex
 * if that is of another surface; else from the surface's attribute mcfskel_node; else empty.
 * @throws InvalidInput as readSurface(); Cancelled
 */
std::vector<int> nodesOnSurface(const FilterRun& run, const CurveLayer& curve,
	const SkeletonSurface& surface, const vcg::tri::mcf::Progress& progress);

/**
 * The skeleton with the correspondence of a surface, as if it had been made from it:
 * nodesOnSurface(), or if that is empty the nearest node of each vertex.
 * @throws InvalidInput as readSurface(); Cancelled
 */
CurveLayer skeletonOf(const FilterRun& run, CurveLayer curve, const SkeletonSurface& surface,
	const vcg::tri::mcf::Progress& progress);

/// The distance of each node to a surface, mesh units; 0 outside. @throws Cancelled
std::vector<double> clearances(const std::vector<vcg::Point3d>& nodes,
	const vcg::tri::mcf::SurfaceMesh& surface, const vcg::tri::mcf::Progress& progress);

/**
 * Adds a layer NAME_suffix with a skeleton made from that of the current layer, and writes its
 * correspondence on the surface that this one remembers. Other surfaces NAME with mcfskel_node that
 * lie where that one does, and that no skeleton remembers, are what it was made from: where they
 * had nodes they get those of its nearest vertices.
 * The radius is measured anew if the correspondence is known and `measureRadius` is set.
 * @param curve  the skeleton of the current layer.
 * @throws InvalidInput as readSurface(), for the surface that is remembered; Cancelled
 */
void addDerivedSkeleton(FilterRun& run, const CurveLayer& curve,
	vcg::tri::mcf::CurveSkeleton skeleton, const char* suffix, bool measureRadius,
	const vcg::tri::mcf::Progress& progress);

} // namespace mcfskel

#endif
