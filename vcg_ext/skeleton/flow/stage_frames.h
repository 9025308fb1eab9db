// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A stage in the shape's own frames, so that results do not depend on the mesh coordinates.

#ifndef VCG_MCF_STAGE_FRAMES_H
#define VCG_MCF_STAGE_FRAMES_H

#include "stage.h"

#include <skeleton/core/ticker.h>
#include <skeleton/mesh/principal_frame.h>

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The frames of a stage's components; takes a stage into them and back.
 *
 * The flow decides thousands of times which of two lengths is smaller, and solves its systems
 * approximately: differences in the last bit grow until a branch is there or not. In these
 * coordinates, rounded as in single precision, a copy of a shape that is turned, moved or
 * scaled gives the same bits. Positions that were rounded before return to their grid points, see
 * PrincipalFrame::onGrid().
 */
class StageFrames
{
public:
	/// Takes the stage's frames; computes and stores them there if it has none.
	/// @throws Cancelled. Complexity: O(V), V the vertices of the surface, the first time.
	explicit StageFrames(Stage& stage, const Progress& progress = Progress())
	{
		if (!stage.frames)
			stage.findFrames(*stage.surface,
				componentOfSurfaceVertices(stage, progress.part(0, 0.2)), progress.part(0.2, 1));
		frames = stage.frames;
	}

	/// Takes the positions, poles and diagonals of a stage into the frames, and turns over faces
	/// where a frame is mirrored, so that they look outwards there, too. Held vertices are not
	/// rounded. @throws Cancelled
	void enter(Stage& stage, const Cancellation& cancel = Cancellation())
	{
		diagonal = stage.diagonal;
		detail::cancellableLoop(int(stage.pole.size()), cancel, [&](int v) {
			const int c = stage.component[v];
			const PrincipalFrame& own = (*frames)[c];
			Point3d& p = stage.mesh.position[v];
			if (stage.held[v]) {
				const Point3d inside = own.in(p);
				heldPlace[{c, inside[0], inside[1], inside[2]}] = p;
				p = inside;
			}
			else
				p = own.onGrid(p);
			stage.pole[v] = own.onGrid(stage.pole[v]);
		});
		for (size_t c = 0; c < frames->size(); ++c)
			stage.diagonal[c] /= (*frames)[c].unitLength();
		turnOverMirrored(stage.mesh, stage.component, *frames, cancel);
	}

	/// The area and volume, in mesh units, of a stage that has entered. @throws Cancelled
	Extent extent(const Stage& stage, const Cancellation& cancel) const
	{
		std::vector<double> unit;
		for (const PrincipalFrame& frame : *frames)
			unit.push_back(frame.unitLength());
		return measuredExtent(stage.mesh, stage.component, unit, cancel);
	}

	/// A point of a component in mesh coordinates; where a vertex is held, exactly its place.
	Point3d out(int component, const Point3d& p) const
	{
		if (const auto found = heldPlace.find({component, p[0], p[1], p[2]});
			found != heldPlace.end())
			return found->second;
		return (*frames)[component].out(p);
	}

	/// Takes a stage that has entered back to mesh coordinates. @pre it is compact.
	/// @throws Cancelled; then the stage must be discarded.
	void leave(Stage& stage, const Cancellation& cancel = Cancellation()) const
	{
		detail::cancellableLoop(int(stage.pole.size()), cancel, [&](int v) {
			const int c = stage.component[v];
			stage.mesh.position[v] = out(c, stage.mesh.position[v]);
			stage.pole[v] = (*frames)[c].out(stage.pole[v]);
		});
		stage.diagonal = diagonal;
		turnOverMirrored(stage.mesh, stage.component, *frames, cancel);
	}

private:
	std::shared_ptr<const std::vector<PrincipalFrame>> frames;
	std::vector<double> diagonal;
	/// Places of held vertices in mesh coordinates, by component and place in its frame.
	std::map<std::tuple<int, double, double, double>, Point3d> heldPlace;
};

} // namespace vcg::tri::mcf

#endif
