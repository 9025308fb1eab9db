// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The state of the flow between two iterations: a meso-skeleton with all its data.

#ifndef VCG_MCF_STAGE_H
#define VCG_MCF_STAGE_H

#include "vertex_states.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/graph/skeleton_radius.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/core/parameters.h>
#include <skeleton/poles/pole_set.h>
#include <skeleton/mesh/principal_frame.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace vcg::tri::mcf {

/**
 * A stage of the contraction. Stage 0 is the surface itself; each step() makes the next.
 *
 * It holds everything that the flow needs to carry on: N single steps are the full run, bit for
 * bit. The mesh is compact between steps.
 */
struct Stage : VertexStates
{
	/// The contracted mesh, mesh units.
	SurfaceMesh mesh;
	/// Lower bound of every `epsilonLimit`: about the resolution of the frames' grid.
	static constexpr double minEpsilonLimit = 1e-6;

	/// Diagonal of each component of the surface, see MeasuredSurface: its unit of length.
	std::vector<double> diagonal;
	/// Area of each component, of the surface and of this stage.
	std::vector<double> initialArea, area;
	/// Sum of the components' volumes, of the surface and of this stage.
	double initialVolume = 0, volume = 0;

	/// The surface's vertices, shared by all stages.
	std::shared_ptr<const std::vector<Point3d>> surface;
	/// Its triangles, shared likewise; null if unknown, as from a file of an earlier release.
	std::shared_ptr<const std::vector<Triangle>> surfaceTriangles;
	/// The frames of its components, shared likewise: see StageFrames. Null until first needed.
	std::shared_ptr<const std::vector<PrincipalFrame>> frames;
	/// The correspondence: the vertex of this stage that each surface vertex has merged into.
	std::vector<int> node;

	/// Iterations made so far.
	int iteration = 0;
	/// The largest `iteration`; the count stays there.
	static constexpr int maxIteration = 1'000'000'000;
	/// Parameters::epsilon of the last of them, fraction of the diagonal.
	double epsilon = Parameters().epsilon;
	/// Whether nothing is left to contract: see step().
	bool converged = false;

	/// Computes `frames`. @param points the surface's vertices. @param component of each of them.
	/// @throws Cancelled. Complexity: linear in the points.
	void findFrames(const std::vector<Point3d>& points, const std::vector<int>& component,
		const Progress& progress)
	{
		frames = std::make_shared<const std::vector<PrincipalFrame>>(
			PrincipalFrame::ofPoints(points, component, diagonal.size(), progress));
	}

	/// The length epsilon at a vertex, in the units of `diagonal`.
	/// @param ofDiagonal epsilon as in Parameters, fraction of the diagonal.
	double epsilonAt(int v, double ofDiagonal) const
	{
		return (epsilonLimit.empty() ? ofDiagonal : std::min(ofDiagonal, epsilonLimit[v]))
			* diagonal[component[v]];
	}

	/// Area over that of the surface.
	double areaFraction() const { return sum(area) / sum(initialArea); }
	/// Whether the flow spreads the surface instead of contracting it: where large parts are inside
	/// out, they are drawn to balls outside. A surface that does contract may grow in its first
	/// steps, seldom in more than 50.
	bool isSpread() const
	{
		constexpr int firstSteps = 100;
		return iteration >= firstSteps && areaFraction() > 1;
	}
	/// Whether further steps are of no use.
	bool isDone() const { return converged || isSpread(); }
	/// Volume over that of the surface, clamped to [0, 1]: parts turned inside out count negative.
	double volumeFraction() const
	{
		return initialVolume > 0 ? std::clamp(volume / initialVolume, 0.0, 1.0) : 0;
	}
	/// Fixed vertices over all vertices.
	double fixedFraction() const
	{
		return fixed.empty()
			? 1
			: double(std::count(fixed.begin(), fixed.end(), 1)) / double(fixed.size());
	}
	/// Whether the flow keeps a sheet anywhere.
	bool hasSheets() const { return std::find(sheet.begin(), sheet.end(), 1) != sheet.end(); }
	int heldCount() const { return int(std::count(held.begin(), held.end(), 1)); }

private:
	static double sum(const std::vector<double>& values)
	{
		double total = 0;
		for (double value : values)
			total += value;
		return total;
	}
};

/// Figures of a stage that are the same whether its vertices are inside its frames or outside.
struct StageFigures
{
	int iteration = 0;
	bool converged = false;
	int vertices = 0, faces = 0;
	/// Parts of the surface's.
	double areaFraction = 0, volumeFraction = 0;
	/// Part of the vertices.
	double fixedFraction = 0;
};

inline StageFigures figuresOf(const Stage& stage)
{
	return {stage.iteration, stage.converged, stage.mesh.vertexCount(), stage.mesh.faceCount(),
		stage.areaFraction(), stage.volumeFraction(), stage.fixedFraction()};
}

/// Area of each component of a mesh, and the sum of their volumes, see SurfaceMesh::volume().
struct Extent
{
	std::vector<double> area;
	double volume = 0;
};

/// @param unit of the coordinates of each component, in units of the result. @throws Cancelled
inline Extent measuredExtent(const SurfaceMesh& mesh, const std::vector<int>& component,
	const std::vector<double>& unit, const Cancellation& cancel = Cancellation())
{
	std::vector<double> doubleArea(unit.size(), 0), sixVolumes(unit.size(), 0);
	const Point3d middle = mesh.bounds().Center();
	detail::cancellableLoop(mesh.faceSlots(), cancel, [&](int f) {
		if (!mesh.isFace(f))
			return;
		const int v = mesh.triangle(f)[0];
		const Point3d doubleAreaVector = mesh.doubleAreaVector(f);
		doubleArea[component[v]] += doubleAreaVector.Norm();
		sixVolumes[component[v]] += (mesh.position[v] - middle) * doubleAreaVector;
	});
	Extent extent;
	for (size_t c = 0; c < unit.size(); ++c) {
		const double squared = unit[c] * unit[c];
		extent.area.push_back(doubleArea[c] / 2 * squared);
		extent.volume += sixVolumes[c] / 6 * squared * unit[c];
	}
	return extent;
}

/// The component of each vertex of the surface that a stage came from. @throws Cancelled
inline std::vector<int> componentOfSurfaceVertices(
	const Stage& stage, const Cancellation& cancel = Cancellation())
{
	std::vector<int> component;
	component.reserve(stage.node.size());
	detail::cancellableLoop(int(stage.node.size()), cancel,
		[&](int s) { component.push_back(stage.component[stage.node[s]]); });
	return component;
}

/// Stage 0 of a surface. @pre the surface is compact; poles has an entry for each vertex.
/// @throws Cancelled
inline Stage initialStage(
	const MeasuredSurface& measured, const PoleSet& poles, const Progress& progress = Progress())
{
	const SurfaceMesh& surface = measured.mesh();
	const auto copied = [&](const auto& array) { return detail::copiedArray(array, progress); };
	Stage stage;
	stage.mesh = surface.copied(progress);
	stage.pole = copied(poles.centre);
	stage.poleRadius = copied(poles.radius);
	stage.fixed.assign(surface.vertexSlots(), 0);
	stage.held.assign(surface.vertexSlots(), 0);
	stage.sheet.assign(surface.vertexSlots(), 0);
	stage.component = copied(measured.component());
	stage.diagonal = measured.diagonals();
	stage.initialArea = stage.area = measured.areas();
	stage.initialVolume = stage.volume = surface.volume(progress);
	stage.surface = std::make_shared<const std::vector<Point3d>>(copied(surface.position));
	stage.surfaceTriangles =
		std::make_shared<const std::vector<Triangle>>(surface.triangles(progress));
	stage.frames = measured.vertexFrames(progress);
	stage.node = detail::numberedArray(stage.pole.size(), progress);
	return stage;
}

/**
 * Local thickness of a stage: for each vertex the mean distance to the surface vertices that have
 * merged into it; -1 where there are none.
 * @param position of each vertex; node: for each surface vertex its vertex, -1 if it has none.
 * @throws Cancelled
 */
inline std::vector<double> meanSurfaceDistance(const std::vector<Point3d>& position,
	const std::vector<Point3d>& surface, const std::vector<int>& node,
	const Cancellation& cancel = Cancellation())
{
	return detail::meanOfMerged(position.size(), node, cancel,
		[&](int s) { return Distance(surface[s], position[node[s]]); });
}

/// Local thickness at each vertex of a stage; where no surface vertex has merged into it, as after
/// a split, the mean of its neighbours'. @throws Cancelled. Complexity: O(V + surface).
inline std::vector<double> stageRadius(const Stage& stage, const Progress& progress = Progress())
{
	const SurfaceMesh& mesh = stage.mesh;
	std::vector<double> radius =
		meanSurfaceDistance(mesh.position, *stage.surface, stage.node, progress);
	detail::Ticker ticker(progress.cancelOnly(), "Measuring the thickness", mesh.vertexSlots());
	std::vector<int> unknown; // those that may have a neighbour whose radius is known
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (radius[v] < 0)
			unknown.push_back(v);
	std::vector<std::pair<int, double>> found;
	std::vector<char> isNext = detail::filledArray(radius.size(), char(0), progress);
	while (!unknown.empty()) {
		found.clear();
		for (int v : unknown) {
			ticker.tick();
			double sum = 0;
			int count = 0;
			mesh.forEachOutgoing(v, [&](int h) {
				const double r = radius[mesh.target(h)];
				if (r >= 0) {
					sum += r;
					++count;
				}
			});
			if (count)
				found.emplace_back(v, sum / count);
		}
		for (const auto& [v, r] : found)
			radius[v] = r;
		unknown.clear();
		for (const auto& entry : found)
			mesh.forEachOutgoing(entry.first, [&](int h) {
				const int w = mesh.target(h);
				if (radius[w] < 0 && !isNext[w]) {
					isNext[w] = 1;
					unknown.push_back(w);
				}
			});
	}
	return radius;
}

} // namespace vcg::tri::mcf

#endif
