// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief A stage of the contraction as PLY, with all that the next step needs and to the last bit:
 * a flow that is continued from the file, in another process, gives the same results.
 *
 * Other readers find a mesh (elements vertex and face) with attributes; what belongs to no vertex
 * of it is in further elements: mcfskel_component, mcfskel_surface, mcfskel_surface_face,
 * mcfskel_slot and mcfskel_stage.
 */

#ifndef VCG_MCF_STAGE_PLY_H
#define VCG_MCF_STAGE_PLY_H

#include "ply_tables.h"

#include <skeleton/flow/check_stage.h>
#include <skeleton/flow/stage.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// A stage, and what lets a host find its surface again.
struct StageFile
{
	Stage stage;
	/// Of the surface's geometry, as a host computes it; 0: not known.
	std::uint64_t surfaceFingerprint = 0;
	/// For each vertex of the host's mesh the vertex of the surface, or -1.
	std::vector<int> vertexOfSlot;
};

namespace detail {

inline constexpr char stageComment[] = "mcfskel stage 1";

/// The table of one row: what a stage has once.
inline PlyElement stageRow(const StageFile& file)
{
	const Stage& stage = file.stage;
	PlyElement row {"mcfskel_stage", 1, {}};
	const auto add = [&](const char* name, PlyType type, double value) {
		row.add(name, type, std::array<double, 1> {value});
	};
	add("iteration", PlyType::Int32, stage.iteration);
	add("converged", PlyType::UInt8, stage.converged);
	add("epsilon", PlyType::Double, stage.epsilon);
	add("initial_volume", PlyType::Double, stage.initialVolume);
	add("volume", PlyType::Double, stage.volume);
	addFingerprint(row, file.surfaceFingerprint);
	return row;
}

} // namespace detail

/**
 * A stage as tables that readStagePly() accepts.
 * @pre the stage's mesh is compact, as between steps; vertexOfSlot names vertices of the surface,
 *      or -1.
 * @throws InvalidStage, see checkStage(); Cancelled.
 * Complexity: O(V + surface).
 */
inline PlyFile stagePly(const StageFile& file, const Progress& progress = Progress())
{
	const char* const what = "Writing the file";
	const Stage& stage = file.stage;
	checkStage(stage, progress.part(0, 0.3));
	const std::vector<Triangle> triangles = stage.mesh.triangles(progress.part(0.3, 0.5));
	const std::vector<double> radius = stageRadius(stage, progress.part(0.5, 1));
	const size_t n = size_t(stage.mesh.vertexSlots());

	PlyElement vertex {"vertex", n, {}};
	addPoints(vertex, "", stage.mesh.position);
	vertex.add("quality", PlyType::Float, radius);
	vertex.add("mcfskel_radius", PlyType::Double, radius);
	addPoints(vertex, "mcfskel_pole_", stage.pole);
	vertex.add("mcfskel_pole_radius", PlyType::Double, stage.poleRadius);
	vertex.add("mcfskel_fixed", PlyType::UInt8, stage.fixed);
	vertex.add("mcfskel_held", PlyType::UInt8, stage.held);
	vertex.add("mcfskel_sheet", PlyType::UInt8, stage.sheet);
	if (!stage.epsilonLimit.empty())
		vertex.add("mcfskel_epsilon_limit", PlyType::Double, stage.epsilonLimit);
	vertex.add("mcfskel_component", PlyType::Int32, stage.component);

	progress.report(1, what);
	PlyElement face {"face", triangles.size(), {}};
	addTuples(face, "vertex_indices", triangles);

	PlyElement component {"mcfskel_component", stage.diagonal.size(), {}};
	component.add("diagonal", PlyType::Double, stage.diagonal);
	component.add("initial_area", PlyType::Double, stage.initialArea);
	component.add("area", PlyType::Double, stage.area);

	progress.report(1, what);
	PlyElement surface {"mcfskel_surface", stage.node.size(), {}};
	addPoints(surface, "", *stage.surface);
	progress.report(1, what);
	surface.add("node", PlyType::Int32, stage.node);

	PlyElement surfaceFace {
		"mcfskel_surface_face", stage.surfaceTriangles ? stage.surfaceTriangles->size() : 0, {}};
	if (stage.surfaceTriangles)
		addTuples(surfaceFace, "vertex_indices", *stage.surfaceTriangles);

	PlyElement slot {"mcfskel_slot", file.vertexOfSlot.size(), {}};
	slot.add("vertex", PlyType::Int32, file.vertexOfSlot);

	PlyFile ply {{detail::stageComment}, {}};
	for (PlyElement* element : {&vertex, &face, &component, &surface, &surfaceFace, &slot})
		if (element != &surfaceFace || element->rows > 0)
			ply.elements.push_back(std::move(*element));
	ply.elements.push_back(detail::stageRow(file));
	return ply;
}

/// Writes stagePly(). @throws InvalidStage, see checkStage(); Cancelled.
/// Complexity: O(V + surface).
inline void writeStagePly(
	std::ostream& out, const StageFile& file, const Progress& progress = Progress())
{
	writeBinaryPly(out, stagePly(file, progress.part(0, 0.3)), progress.part(0.3, 1));
}

namespace detail {

/// The mesh of a stage; checkStage() checks that it is a manifold.
/// @throws FormatError unless each edge has a twin; Cancelled.
inline SurfaceMesh stageMesh(
	std::vector<Point3d> points, const std::vector<Triangle>& triangles, const Progress& progress)
{
	for (size_t f = 0; f < triangles.size(); ++f) {
		const auto& [a, b, c] = triangles[f];
		if (a == b || b == c || c == a)
			throw FormatError::atRow("face", f, "two corners are the same vertex.");
	}
	try {
		return SurfaceMesh(std::move(points), triangles, progress);
	}
	catch (const InvalidInput& error) {
		throw FormatError::atRow("face", 0, error.what());
	}
}

/// checkStage(), with errors in terms of the file. @throws FormatError, Cancelled
inline void checkReadStage(const Stage& stage, const Progress& progress)
{
	try {
		checkStage(stage, progress);
	}
	catch (const InvalidStage& error) {
		const char* const elements[] = {"vertex", "face", "mcfskel_component", "mcfskel_surface",
			"mcfskel_surface_face", "mcfskel_stage"};
		throw FormatError::atRow(elements[size_t(error.part())], error.row(),
			error.reason()
				+ (error.count() > 1 ? " There are " + std::to_string(error.count()) + " such rows."
									 : ""));
	}
}

inline void readComponents(const PlyTable& table, Stage& stage)
{
	stage.diagonal = table.anyReals("diagonal");
	stage.initialArea = table.anyReals("initial_area");
	stage.area = table.anyReals("area");
}

inline void readVertices(const PlyTable& table, int components, Stage& stage)
{
	stage.pole = table.anyPoints("mcfskel_pole_");
	stage.poleRadius = table.anyReals("mcfskel_pole_radius");
	const auto flags = [&](const char* name) {
		const std::vector<int> values = table.integers(name, 0, 1);
		return std::vector<char>(values.begin(), values.end());
	};
	stage.fixed = flags("mcfskel_fixed");
	// Files of earlier releases have neither.
	const std::vector<char> none(table.rows(), 0);
	stage.held = table.has("mcfskel_held") ? flags("mcfskel_held") : none;
	stage.sheet = table.has("mcfskel_sheet") ? flags("mcfskel_sheet") : none;
	if (table.has("mcfskel_epsilon_limit"))
		stage.epsilonLimit = table.anyReals("mcfskel_epsilon_limit");
	stage.component = table.integers("mcfskel_component", 0, components - 1);
}

} // namespace detail

/// Whether a file's comments say that it is a stage.
inline bool isStagePly(const PlyFile& ply)
{
	return std::find(ply.comments.begin(), ply.comments.end(), detail::stageComment)
		!= ply.comments.end();
}

/**
 * Reads a stage that writeStagePly() wrote. Further properties and elements are ignored.
 * @throws FormatError for an element or property that is missing, a value that is out of its range,
 *         and whatever checkStage() refuses; Cancelled.
 */
inline StageFile readStagePly(const PlyFile& ply, const Progress& progress = Progress())
{
	const char* const what = "Reading the file";
	constexpr int maxInt = std::numeric_limits<int>::max();
	if (!isStagePly(ply))
		throw FormatError::atLine(1,
			std::string("the header has no comment '") + detail::stageComment
				+ "': this is no stage that 'Save Stage' wrote.");
	StageFile file;
	Stage& stage = file.stage;
	const PlyTable row(ply, "mcfskel_stage"), vertex(ply, "vertex"), face(ply, "face"),
		component(ply, "mcfskel_component"), surface(ply, "mcfskel_surface"),
		slot(ply, "mcfskel_slot");
	if (row.rows() != 1)
		throw row.error(0, "expected one row.");
	stage.iteration = row.integers("iteration", 0, maxInt)[0];
	stage.converged = row.integers("converged", 0, 1)[0] == 1;
	if (row.has("epsilon"))
		stage.epsilon = row.anyReals("epsilon")[0];
	stage.initialVolume = row.anyReals("initial_volume")[0];
	stage.volume = row.anyReals("volume")[0];
	file.surfaceFingerprint = fingerprintIn(row);

	detail::readComponents(component, stage);
	progress.report(0, what);
	detail::readVertices(vertex, int(component.rows()), stage);
	progress.report(0.2, what);
	const std::vector<Triangle> triangles =
		face.tuples<3>("vertex_indices", 0, int(vertex.rows()) - 1);
	stage.mesh = detail::stageMesh(vertex.anyPoints(""), triangles, progress.part(0.2, 0.5));

	progress.report(0.5, what);
	stage.surface = std::make_shared<const std::vector<Point3d>>(surface.anyPoints(""));
	progress.report(0.6, what);
	stage.node = surface.integers("node", 0, int(vertex.rows()) - 1);
	progress.report(0.7, what);
	// Files of earlier releases have none.
	if (ply.find("mcfskel_surface_face"))
		stage.surfaceTriangles = std::make_shared<const std::vector<Triangle>>(
			PlyTable(ply, "mcfskel_surface_face")
				.tuples<3>("vertex_indices", 0, int(surface.rows()) - 1));
	file.vertexOfSlot = slot.integers("vertex", -1, int(surface.rows()) - 1);
	detail::checkReadStage(stage, progress.part(0.8, 1));
	progress.report(1, what);
	return file;
}

} // namespace vcg::tri::mcf

#endif
