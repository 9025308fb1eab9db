// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A surface and what most stages ask about it before they begin.

#ifndef VCG_MCF_MEASURED_SURFACE_H
#define VCG_MCF_MEASURED_SURFACE_H

#include "components.h"
#include "principal_frame.h"
#include "surface_mesh.h"

#include <skeleton/core/progress.h>

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A surface with its connected components and their principal axes, areas and sizes.
 *
 * On a dense surface these take as long to compute as the stages that need them: a caller of
 * several stages computes them once and passes them on.
 */
class MeasuredSurface
{
public:
	/**
	 * Implicit, so that a stage that is called alone takes a mesh.
	 * @param mesh kept by reference.
	 * @pre the positions are finite. @throws Cancelled. Complexity: about O(V + F).
	 */
	// NOLINTNEXTLINE(google-explicit-constructor)
	MeasuredSurface(const SurfaceMesh& mesh, const Progress& progress = Progress()) :
			surface(mesh), ofVertex(connectedComponents(mesh, &count, progress.part(0, 0.2))),
			frames(
				PrincipalFrame::ofComponents(mesh, ofVertex, size_t(count), progress.part(0.2, 1)))
	{
	}

	/// The same where the components are known already, numbered as by connectedComponents().
	MeasuredSurface(const SurfaceMesh& mesh, std::vector<int> component, int components,
		const Progress& progress = Progress()) :
			surface(mesh),
			count(components), ofVertex(std::move(component)),
			frames(PrincipalFrame::ofComponents(mesh, ofVertex, size_t(count), progress))
	{
	}

	const SurfaceMesh& mesh() const { return surface; }
	/// Of each vertex slot its component, see connectedComponents().
	const std::vector<int>& component() const { return ofVertex; }
	int components() const { return count; }

	/// The frames of all components.
	const std::vector<PrincipalFrame>& allFrames() const { return frames; }
	/// The frames of the vertices of all components, see PrincipalFrame::ofPoints(): those that the
	/// poles, the flow and the refinement work in. Computed by the first call, for all.
	/// @throws Cancelled
	const std::shared_ptr<const std::vector<PrincipalFrame>>& vertexFrames(
		const Progress& progress = Progress()) const
	{
		std::call_once(vertexFramesOnce, [&] {
			ofVertices = std::make_shared<const std::vector<PrincipalFrame>>(
				PrincipalFrame::ofPoints(surface.position, ofVertex, size_t(count), progress));
		});
		return ofVertices;
	}
	/// The frame of a component.
	const PrincipalFrame& frame(int c) const { return frames[c]; }
	/// The area of a component, mesh units squared.
	double area(int c) const { return frames[c].area(); }
	/// The size of a component: diagonal of its bounding box along its principal axes, mesh units.
	double diagonal(int c) const { return frames[c].size(); }

	/// area() and, below, diagonal() of all components.
	std::vector<double> areas() const
	{
		std::vector<double> all;
		for (const PrincipalFrame& frame : frames)
			all.push_back(frame.area());
		return all;
	}
	std::vector<double> diagonals() const
	{
		std::vector<double> all;
		for (const PrincipalFrame& frame : frames)
			all.push_back(frame.size());
		return all;
	}

private:
	const SurfaceMesh& surface;
	int count = 0;
	std::vector<int> ofVertex;
	std::vector<PrincipalFrame> frames;
	mutable std::once_flag vertexFramesOnce;
	mutable std::shared_ptr<const std::vector<PrincipalFrame>> ofVertices;
};

} // namespace vcg::tri::mcf

#endif
