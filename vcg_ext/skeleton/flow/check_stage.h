// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Checks a stage for all that the next step, the collapse and the vertex kinds assume.

#ifndef VCG_MCF_CHECK_STAGE_H
#define VCG_MCF_CHECK_STAGE_H

#include "stage.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/components.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// A stage contradicts itself, or a value of it is out of its range.
class InvalidStage : public InvalidInput
{
public:
	/// What is wrong: one of the stage's vertices, faces or components, one of its surface's
	/// vertices or faces, or the stage itself.
	enum class Part { Vertex, Face, Component, SurfaceVertex, SurfaceFace, Stage };

	/// @param row    the first that is wrong, from 0; count: how many are.
	/// @param reason what is wrong with it, with a full stop; follows a colon in the text.
	InvalidStage(Part part, size_t row, size_t count, const std::string& reason) :
			InvalidInput(text(part, row, count, reason)), wrongPart(part), firstRow(row),
			countOfRows(count), why(reason)
	{
	}

	Part part() const { return wrongPart; }
	size_t row() const { return firstRow; }
	size_t count() const { return countOfRows; }
	const std::string& reason() const { return why; }

private:
	Part wrongPart;
	size_t firstRow, countOfRows;
	std::string why;

	static std::string text(Part part, size_t row, size_t count, const std::string& reason)
	{
		if (part == Part::Stage)
			return "The stage cannot be used: " + reason;
		const char* const names[] = {
			"vertex", "face", "component", "surface vertex", "surface face"};
		return "The stage cannot be used: " + std::string(names[size_t(part)]) + " "
			+ std::to_string(row) + ": " + reason
			+ (count > 1 ? " There are " + std::to_string(count) + " such." : "");
	}
};

namespace detail {

/// Checks one property after the other for all parts of a stage; throws at the first violated one.
class StageChecker
{
public:
	StageChecker(const Stage& stage, const Progress& progress) : stage(stage), progress(progress) {}

	void check()
	{
		checkSizes();
		checkWhole();
		checkComponents();
		checkVertices(progress.part(0, 0.2));
		checkMesh(progress.part(0.2, 0.6));
		checkParts(progress.part(0.6, 0.8));
		checkSurface(progress.part(0.8, 0.9));
		checkReach(progress.part(0.9, 1));
	}

private:
	using Part = InvalidStage::Part;

	const Stage& stage;
	const Progress progress;
	static constexpr const char* checking = "Checking the stage";

	size_t vertices() const { return size_t(stage.mesh.vertexSlots()); }
	size_t components() const { return stage.diagonal.size(); }

	static void require(bool holds, const char* reason)
	{
		if (!holds)
			throw InvalidStage(Part::Stage, 0, 1, reason);
	}

	/// @param isRight bool(i): whether part i is right. @throws InvalidStage, Cancelled
	template <class IsRight>
	static void requireEach(Part part, size_t count, const Progress& progress, const char* reason,
		const IsRight& isRight)
	{
		size_t wrong = 0, first = 0;
		reportedLoop(int(count), progress, checking, [&](int i) {
			if (isRight(size_t(i)))
				return;
			if (wrong++ == 0)
				first = size_t(i);
		});
		if (wrong > 0)
			throw InvalidStage(part, first, wrong, reason);
	}

	void checkSizes() const
	{
		require(vertices() > 0 && components() > 0 && stage.surface && !stage.surface->empty(),
			"it is empty.");
		require(stage.mesh.position.size() == vertices() && stage.areOf(vertices()),
			"what it knows is not of as many vertices as it has.");
		require(stage.initialArea.size() == components() && stage.area.size() == components(),
			"it has not as many areas as components.");
		require(stage.node.size() == stage.surface->size(),
			"'node' has not an entry for each vertex of the surface.");
	}

	void checkWhole() const
	{
		require(stage.iteration >= 0 && stage.iteration <= Stage::maxIteration,
			"'iteration' is not between 0 and 1000000000.");
		require(stage.epsilon > 0 && stage.epsilon <= Parameters::maxEpsilon,
			"'epsilon' is not above 0 and at most 0.1.");
		require(std::isfinite(stage.volume), "'volume' is not finite.");
	}

	void checkComponents() const
	{
		requireEach(Part::Component, components(), progress.cancelOnly(),
			"'diagonal' is not of a size that can be worked with.",
			[&](size_t c) { return isUsableSize(stage.diagonal[c]); });
		// So fractions of areas and volumes stay finite, whatever the stage becomes.
		constexpr double minFraction = 1e-100;
		requireEach(Part::Component, components(), progress.cancelOnly(),
			"'initial_area' is not finite, or not above 0.", [&](size_t c) {
				const double square = stage.diagonal[c] * stage.diagonal[c];
				return stage.initialArea[c] > minFraction * square
					&& std::isfinite(stage.initialArea[c]);
			});
		requireEach(Part::Component, components(), progress.cancelOnly(),
			"'area' is not finite, or below 0.",
			[&](size_t c) { return stage.area[c] >= 0 && std::isfinite(stage.area[c]); });
		const double diagonal = *std::max_element(stage.diagonal.begin(), stage.diagonal.end());
		require(stage.initialVolume > minFraction * diagonal * diagonal * diagonal
				&& std::isfinite(stage.initialVolume),
			"'initial_volume' is not finite, or not above 0.");
		require(stage.areaFraction() <= 1 / minFraction
				&& std::abs(stage.volume) <= stage.initialVolume / minFraction,
			"'area' or 'volume' is too large beside that of the surface.");
	}

	void checkVertices(const Progress& part) const
	{
		constexpr int properties = 6;
		int property = 0;
		const auto each = [&](const char* reason, const auto& isRight) {
			const Progress own =
				part.part(double(property) / properties, double(property + 1) / properties);
			++property;
			requireEach(Part::Vertex, vertices(), own, reason, isRight);
		};
		each("'mcfskel_pole_radius' is not finite, or too large to work with.",
			[&](size_t v) { return std::abs(stage.poleRadius[v]) <= maxCoordinate; });
		const auto isFlag = [](char flag) { return flag == 0 || flag == 1; };
		each("'mcfskel_fixed', 'mcfskel_held' or 'mcfskel_sheet' is neither 0 nor 1.",
			[&](size_t v) {
				return isFlag(stage.fixed[v]) && isFlag(stage.held[v]) && isFlag(stage.sheet[v]);
			});
		each("held, but not fixed.", [&](size_t v) { return stage.fixed[v] || !stage.held[v]; });
		// The collapse moves the fixed vertices of sheets onto their poles.
		each("of a sheet, but without a pole.",
			[&](size_t v) { return !stage.sheet[v] || stage.poleRadius[v] >= 0; });
		each("'mcfskel_epsilon_limit' is not between 1e-6 and 0.1.", [&](size_t v) {
			return stage.epsilonLimit.empty()
				|| (stage.epsilonLimit[v] >= Stage::minEpsilonLimit
					&& stage.epsilonLimit[v] <= Parameters::maxEpsilon);
		});
		each("'mcfskel_component' does not exist.", [&](size_t v) {
			return stage.component[v] >= 0 && size_t(stage.component[v]) < components();
		});
	}

	/// Compact, closed, a disc around each vertex, no double edges.
	void checkMesh(const Progress& part) const
	{
		const SurfaceMesh& mesh = stage.mesh;
		requireEach(Part::Vertex, vertices(), part.part(0, 0.1), "no face has this vertex.",
			[&](size_t v) { return mesh.isVertex(int(v)); });
		requireEach(Part::Face, size_t(mesh.faceSlots()), part.part(0.1, 0.3),
			"the corners are in different components.", [&](size_t f) {
				if (!mesh.isFace(int(f)))
					return false;
				const Triangle t = mesh.triangle(int(f));
				return stage.component[t[0]] == stage.component[t[1]]
					&& stage.component[t[1]] == stage.component[t[2]];
			});
		std::vector<int> corners = filledArray(vertices(), 0, part);
		reportedLoop(mesh.halfEdgeSlots(), part.part(0.3, 0.5), checking,
			[&](int h) { ++corners[mesh.origin(h)]; });
		requireEach(Part::Vertex, vertices(), part.part(0.5, 0.7), "the surface is pinched here.",
			[&](size_t v) { return mesh.valence(int(v)) == corners[v]; });
		std::vector<int> seenFrom = filledArray(vertices(), -1, part);
		requireEach(Part::Vertex, vertices(), part.part(0.7, 1), "a double edge starts here.",
			[&](size_t v) {
				bool simple = true;
				mesh.forEachOutgoing(int(v), [&](int h) {
					int& seen = seenFrom[mesh.target(h)];
					simple &= seen != int(v);
					seen = int(v);
				});
				return simple;
			});
	}

	/// Each component has one connected part of the mesh.
	void checkParts(const Progress& part) const
	{
		int count = 0;
		const std::vector<int> connected = connectedComponents(stage.mesh, &count, part);
		std::vector<int> partOf(components(), -1);
		requireEach(Part::Vertex, vertices(), part.cancelOnly(),
			"'mcfskel_component' is also that of vertices that are not connected with this one.",
			[&](size_t v) {
				int& own = partOf[stage.component[v]];
				if (own < 0)
					own = connected[v];
				return own == connected[v];
			});
		requireEach(Part::Component, components(), part.cancelOnly(), "no vertex is of it.",
			[&](size_t c) { return partOf[c] >= 0; });
	}

	void checkSurface(const Progress& part) const
	{
		requireEach(Part::SurfaceVertex, stage.node.size(), part.part(0, 0.5),
			"'node' does not exist.",
			[&](size_t s) { return stage.node[s] >= 0 && size_t(stage.node[s]) < vertices(); });
		requireEach(Part::SurfaceVertex, stage.node.size(), part.part(0.5, 1),
			"a coordinate is not finite, or too large to work with.",
			[&](size_t s) { return isUsablePlace((*stage.surface)[s]); });
		if (!stage.surfaceTriangles)
			return;
		const std::vector<Triangle>& triangles = *stage.surfaceTriangles;
		requireEach(Part::SurfaceFace, triangles.size(), part.cancelOnly(),
			"its corners do not exist, or are in different components.", [&](size_t f) {
				const auto exists = [&](int s) { return s >= 0 && size_t(s) < stage.node.size(); };
				const auto componentOf = [&](int s) { return stage.component[stage.node[s]]; };
				const Triangle& t = triangles[f];
				return exists(t[0]) && exists(t[1]) && exists(t[2])
					&& componentOf(t[0]) == componentOf(t[1])
					&& componentOf(t[1]) == componentOf(t[2]);
			});
	}

	/// The unit of length fits the surface, and everything is somewhere near it.
	void checkReach(const Progress& part) const
	{
		// The diagonal is that of another box around the same points: a factor of sqrt 3 at most.
		constexpr double maxRatio = 2;
		// The flow stays inside except for the worst input. This bounds how far vertices may be
		// outside, and so the cells of grids and the splits of long edges.
		constexpr double maxDistance = 100; // diagonals, from the middle of the box
		std::vector<Box3d> box(components());
		reportedLoop(int(stage.node.size()), part.part(0, 0.5), checking,
			[&](int s) { box[stage.component[stage.node[s]]].Add((*stage.surface)[s]); });
		requireEach(Part::Component, components(), part.cancelOnly(),
			"'diagonal' is not that of its vertices of the surface.", [&](size_t c) {
				const double diagonal = box[c].IsNull() ? 0 : box[c].Diag();
				return stage.diagonal[c] <= maxRatio * diagonal
					&& diagonal <= maxRatio * stage.diagonal[c];
			});
		requireEach(Part::Vertex, vertices(), part.part(0.5, 1),
			"a coordinate of it or of its pole is not finite, or farther from the surface than 100 of "
			"its diagonals.",
			[&](size_t v) {
				const int c = stage.component[v];
				const Point3d middle = box[c].Center();
				const double limit = maxDistance * stage.diagonal[c];
				return Distance(stage.mesh.position[v], middle) <= limit
					&& (stage.poleRadius[v] < 0 || Distance(stage.pole[v], middle) <= limit);
			});
	}
};

} // namespace detail

/**
 * Checks everything that the functions on stages assume without a check: step(), collapseToCurve(),
 * collapseKeepingSheets(), vertexKinds(), stageRadius().
 *
 * The mesh is compact, a closed two-manifold without double edges; each of its vertices has finite
 * coordinates, flags of 0 or 1, and a component that exists; each component is one connected part,
 * and has vertices of the surface, whose diagonal is its unit of length; each vertex of the surface
 * belongs to a vertex of the mesh; divisors are above 0; all numbers can be squared and cubed, and
 * all positions are within 100 diagonals of the surface. The poles of vertices without one are not
 * checked.
 *
 * If a stage passes, so does the result of a step on it.
 * @throws InvalidStage with the first violation and how many there are of its kind; Cancelled.
 * Complexity: about O(V + F + surface).
 */
inline void checkStage(const Stage& stage, const Progress& progress = Progress())
{
	detail::StageChecker(stage, progress).check();
}

} // namespace vcg::tri::mcf

#endif
