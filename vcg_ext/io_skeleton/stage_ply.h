// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file A stage of the contraction as PLY, with all that the next step needs and to the last bit:
 * written, read in another process and stepped on, it gives what it would have given at once.
 *
 * Other readers find a mesh (elements vertex and face) with attributes; what belongs to no vertex of
 * it is in further elements: mcfskel_component, mcfskel_surface, mcfskel_slot and mcfskel_stage.
 */

#ifndef VCG_MCF_STAGE_PLY_H
#define VCG_MCF_STAGE_PLY_H

#include "../skeleton/stage.h"
#include "ply_tables.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// A stage, and what lets a host find the layer of its surface again.
struct StageFile
{
	Stage stage;
	/// Of the surface layer's geometry, as the host counts it; 0: not known.
	std::uint64_t surfaceFingerprint = 0;
	/// For each vertex of that layer the vertex of the surface, or -1.
	std::vector<int> vertexOfSlot;
};

namespace detail {

inline constexpr char stageComment[] = "mcfskel stage 1";

/// The table of what there is once.
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
	add("fingerprint_low", PlyType::UInt32, double(file.surfaceFingerprint & 0xFFFFFFFF));
	add("fingerprint_high", PlyType::UInt32, double(file.surfaceFingerprint >> 32));
	return row;
}

} // namespace detail

/// Writes a stage. @pre its mesh is compact, as between steps. @throws Cancelled
/// Complexity: O(V + surface).
inline void writeStagePly(
	std::ostream& out, const StageFile& file, const Progress& progress = Progress())
{
	const char* const what = "Writing the file";
	const Stage& stage = file.stage;
	const std::vector<Triangle> triangles = stage.mesh.triangles(progress.part(0, 0.1));
	const std::vector<double> radius = stageRadius(stage, progress.part(0.1, 0.3));
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
	vertex.add("mcfskel_component", PlyType::Int32, stage.component);

	progress.report(0.3, what);
	PlyElement face {"face", triangles.size(), {}};
	addTuples(face, "vertex_indices", triangles);

	PlyElement component {"mcfskel_component", stage.diagonal.size(), {}};
	component.add("diagonal", PlyType::Double, stage.diagonal);
	component.add("initial_area", PlyType::Double, stage.initialArea);
	component.add("area", PlyType::Double, stage.area);

	progress.report(0.3, what);
	PlyElement surface {"mcfskel_surface", stage.node.size(), {}};
	addPoints(surface, "", *stage.surface);
	progress.report(0.3, what);
	surface.add("node", PlyType::Int32, stage.node);

	PlyElement slot {"mcfskel_slot", file.vertexOfSlot.size(), {}};
	slot.add("vertex", PlyType::Int32, file.vertexOfSlot);

	PlyFile ply {{detail::stageComment}, {}};
	for (PlyElement* element : {&vertex, &face, &component, &surface, &slot})
		ply.elements.push_back(std::move(*element));
	ply.elements.push_back(detail::stageRow(file));
	writeBinaryPly(out, ply, progress.part(0.3, 1));
}

namespace detail {

/// @throws FormatError unless the triangles are a closed two-manifold without double edges; Cancelled.
inline SurfaceMesh checkedStageMesh(
	std::vector<Point3d> points, const std::vector<Triangle>& triangles, const Progress& progress)
{
	const int n = int(points.size());
	std::vector<int> corners(size_t(n), 0);
	for (size_t f = 0; f < triangles.size(); ++f) {
		const auto& [a, b, c] = triangles[f];
		if (a == b || b == c || c == a)
			throw FormatError::atRow("face", f, "two corners are the same vertex.");
		for (int v : triangles[f])
			++corners[size_t(v)];
	}
	for (int v = 0; v < n; ++v)
		if (!corners[size_t(v)])
			throw FormatError::atRow("vertex", size_t(v), "no face has this vertex.");
	try {
		SurfaceMesh mesh(std::move(points), triangles, progress);
		std::vector<int> seenFrom(size_t(n), -1);
		for (int v = 0; v < n; ++v) {
			if (mesh.valence(v) != corners[size_t(v)])
				throw FormatError::atRow("vertex", size_t(v), "the surface is pinched here.");
			mesh.forEachOutgoing(v, [&](int h) {
				int& seen = seenFrom[size_t(mesh.target(h))];
				if (seen == v)
					throw FormatError::atRow("vertex", size_t(v), "a double edge starts here.");
				seen = v;
			});
		}
		return mesh;
	}
	catch (const InvalidInput& error) {
		throw FormatError::atRow("face", 0, error.what());
	}
}

inline std::uint64_t fingerprintHalf(const PlyTable& row, const char* name)
{
	const double value = row.reals(name, 0)[0];
	if (value > 0xFFFFFFFFu)
		throw row.error(0, std::string("'") + name + "' has more than 32 bits.");
	return std::uint64_t(value);
}

inline void readComponents(const PlyTable& table, Stage& stage)
{
	stage.diagonal = table.reals("diagonal", 0);
	stage.initialArea = table.reals("initial_area", 0);
	stage.area = table.reals("area", 0);
	for (size_t c = 0; c < table.rows(); ++c)
		if (stage.diagonal[c] <= 0 || stage.initialArea[c] <= 0)
			throw table.error(c, "a component without extent.");
}

inline void readVertices(const PlyTable& table, int components, Stage& stage)
{
	stage.pole = table.anyPoints("mcfskel_pole_");
	stage.poleRadius = table.reals("mcfskel_pole_radius");
	for (size_t v = 0; v < table.rows(); ++v)
		for (int k = 0; k < 3; ++k)
			if (stage.poleRadius[v] >= 0 && !std::isfinite(stage.pole[v][k]))
				throw table.error(v, "the pole is not finite.");
	const std::vector<int> fixed = table.integers("mcfskel_fixed", 0, 1);
	stage.fixed.assign(fixed.begin(), fixed.end());
	stage.held.assign(fixed.size(), 0);
	if (table.has("mcfskel_held")) {
		const std::vector<int> held = table.integers("mcfskel_held", 0, 1);
		for (size_t v = 0; v < held.size(); ++v) {
			if (held[v] && !fixed[v])
				throw table.error(v, "held, but not fixed.");
			stage.held[v] = char(held[v]);
		}
	}
	stage.sheet.assign(fixed.size(), 0);
	if (table.has("mcfskel_sheet")) {
		const std::vector<int> sheet = table.integers("mcfskel_sheet", 0, 1);
		stage.sheet.assign(sheet.begin(), sheet.end());
	}
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
 * @throws FormatError: see readBinaryPly(); also for an element or property that is missing, a value
 *         out of its range, a mesh that is no closed two-manifold. Cancelled.
 */
inline StageFile readStagePly(const PlyFile& ply, const Progress& progress = Progress())
{
	const char* const what = "Reading the file";
	constexpr int most = std::numeric_limits<int>::max();
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
	stage.iteration = row.integers("iteration", 0, most)[0];
	stage.converged = row.integers("converged", 0, 1)[0] == 1;
	if (row.has("epsilon"))
		stage.epsilon = row.reals("epsilon", 0)[0];
	stage.initialVolume = row.reals("initial_volume")[0];
	stage.volume = row.reals("volume")[0];
	file.surfaceFingerprint = detail::fingerprintHalf(row, "fingerprint_low")
		| detail::fingerprintHalf(row, "fingerprint_high") << 32;

	detail::readComponents(component, stage);
	progress.report(0, what);
	detail::readVertices(vertex, int(component.rows()), stage);
	progress.report(0.2, what);
	const std::vector<Triangle> triangles =
		face.tuples<3>("vertex_indices", 0, int(vertex.rows()) - 1);
	for (size_t f = 0; f < triangles.size(); ++f)
		for (int v : triangles[f])
			if (stage.component[size_t(v)] != stage.component[size_t(triangles[f][0])])
				throw face.error(f, "the corners are in different components.");
	stage.mesh = detail::checkedStageMesh(vertex.points(""), triangles, progress.part(0.3, 0.7));

	progress.report(0.7, what);
	stage.surface = std::make_shared<const std::vector<Point3d>>(surface.points(""));
	progress.report(0.8, what);
	stage.node = surface.integers("node", -1, int(vertex.rows()) - 1);
	progress.report(0.9, what);
	file.vertexOfSlot = slot.integers("vertex", -1, int(surface.rows()) - 1);
	progress.report(1, what);
	return file;
}

} // namespace vcg::tri::mcf

#endif
