// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "layer_files.h"

#include "../layers/layer_state.h"
#include "files.h"

#include <skeleton/skeleton_files.h>

#include <array>
#include <ostream>

namespace mcfskel {

namespace {

/// One number for each of the given indices.
template <class Indices, class ValueOf>
std::vector<double> valuesAt(const Indices& indices, const ValueOf& valueOf)
{
	std::vector<double> values;
	values.reserve(indices.size());
	for (auto index : indices)
		values.push_back(double(valueOf(size_t(index))));
	return values;
}

template <class Container, class Indices>
void addColours(mcf::PlyElement& element, const Container& elements, const Indices& indices)
{
	const char* const names[] = {"red", "green", "blue", "alpha"};
	for (int k = 0; k < 4; ++k)
		element.add(names[k], mcf::PlyType::UInt8,
			valuesAt(indices, [&](size_t i) { return int(elements[i].cC()[k]); }));
}

/// The columns of the attributes mcfskel_*.
void addAttributes(mcf::PlyElement& vertex, const CMeshO& mesh, const std::vector<int>& indices)
{
	for (const vcg::PointerToAttribute& attribute : mesh.vert_attr) {
		if (attribute._name.rfind("mcfskel_", 0) != 0)
			continue;
		if (isOfType<Scalarm>(attribute)) {
			const Scalarm* values = valuesOf<Scalarm>(attribute);
			vertex.add(attribute._name, mcf::PlyType::Double,
				valuesAt(indices, [&](size_t i) { return values[i]; }));
		}
		else if (isOfType<Point3m>(attribute)) {
			const Point3m* values = valuesOf<Point3m>(attribute);
			for (int k = 0; k < 3; ++k)
				vertex.add(attribute._name + "_" + "xyz"[k], mcf::PlyType::Double,
					valuesAt(indices, [&](size_t i) { return values[i][k]; }));
		}
	}
}

mcf::PlyElement vertexTable(const MeshModel& layer)
{
	const auto& vertices = layer.cm.vert;
	const std::vector<int> live = liveSlots(layer.cm);
	mcf::PlyElement table {"vertex", live.size(), {}};
	for (int k = 0; k < 3; ++k)
		table.add(std::string(1, "xyz"[k]), mcf::PlyType::Double,
			valuesAt(live, [&](size_t i) { return vertices[i].cP()[k]; }));
	if (layer.hasDataMask(MeshModel::MM_VERTQUALITY))
		table.add("quality", mcf::PlyType::Double,
			valuesAt(live, [&](size_t i) { return vertices[i].cQ(); }));
	if (layer.hasDataMask(MeshModel::MM_VERTCOLOR))
		addColours(table, vertices, live);
	addAttributes(table, layer.cm, live);
	return table;
}

/// The indices of faces or edges that are not deleted and have all their vertices.
template <class Container>
std::vector<size_t> wholeSlots(const CMeshO& mesh, const Container& elements)
{
	std::vector<size_t> indices;
	indices.reserve(elements.size());
	for (size_t i = 0; i < elements.size(); ++i)
		if (!elements[i].IsD() && hasVertices(mesh, elements[i]))
			indices.push_back(i);
	return indices;
}

mcf::PlyElement faceTable(const MeshModel& layer, const std::vector<int>& numberOfSlot)
{
	const auto& faces = layer.cm.face;
	const std::vector<size_t> whole = wholeSlots(layer.cm, faces);
	mcf::PlyElement table {"face", whole.size(), {}};
	mcf::PlyColumn corners {"vertex_indices", mcf::PlyType::Int32, 3, {}};
	for (size_t i : whole)
		for (int k = 0; k < 3; ++k)
			corners.values.push_back(numberOfSlot[vcg::tri::Index(layer.cm, faces[i].cV(k))]);
	table.columns.push_back(std::move(corners));
	if (layer.hasDataMask(MeshModel::MM_FACEQUALITY))
		table.add("quality", mcf::PlyType::Double,
			valuesAt(whole, [&](size_t i) { return faces[i].cQ(); }));
	if (layer.hasDataMask(MeshModel::MM_FACECOLOR))
		addColours(table, faces, whole);
	return table;
}

mcf::PlyElement edgeTable(const CMeshO& mesh, const std::vector<int>& numberOfSlot)
{
	const std::vector<size_t> whole = wholeSlots(mesh, mesh.edge);
	mcf::PlyElement table {"edge", whole.size(), {}};
	for (int end = 0; end < 2; ++end)
		table.add(end ? "vertex2" : "vertex1", mcf::PlyType::Int32, valuesAt(whole, [&](size_t i) {
			return numberOfSlot[vcg::tri::Index(mesh, mesh.edge[i].cV(end))];
		}));
	return table;
}

} // namespace

void writeStageFile(const QString& file, const MeshModel& layer, const StageLayer& stage,
	const mcf::Progress& progress)
{
	mcf::PlyFile ply =
		mcf::stagePly({*stage.stage, stage.surface.fingerprint, *stage.surface.vertexOfSlot},
			progress.part(0, 0.3));
	if (layer.hasDataMask(MeshModel::MM_VERTCOLOR))
		addColours(ply.elements.front(), layer.cm.vert, liveSlots(layer.cm));
	writeFile(
		file, [&](std::ostream& out) { mcf::writeBinaryPly(out, ply, progress.part(0.3, 1)); });
}

void writeCurveFile(const QString& file, const MeshModel& layer, const CurveLayer& curve)
{
	mcf::CurveSkeleton skeleton = curve.skeleton;
	skeleton.node = curve.nodeOfLayerVertex();
	mcf::PlyFile ply =
		mcf::skeletonPly(skeleton, curve.surface.fingerprint, referenceDiagonal(layer));
	if (layer.hasDataMask(MeshModel::MM_VERTCOLOR))
		addColours(ply.elements.front(), layer.cm.vert, liveSlots(layer.cm));
	writeFile(file, [&](std::ostream& out) { mcf::writeBinaryPly(out, ply); });
}

void writeMeshFile(const QString& file, const MeshModel& layer, const mcf::Progress& progress)
{
	std::vector<int> numberOfSlot(layer.cm.vert.size(), -1);
	int count = 0;
	for (int slot : liveSlots(layer.cm))
		numberOfSlot[size_t(slot)] = count++;
	progress.report(0, "Writing the file");
	mcf::PlyFile ply {{}, {vertexTable(layer)}};
	progress.report(0.3, "Writing the file");
	ply.elements.push_back(faceTable(layer, numberOfSlot));
	if (layer.cm.en > 0)
		ply.elements.push_back(edgeTable(layer.cm, numberOfSlot));
	writeFile(
		file, [&](std::ostream& out) { mcf::writeBinaryPly(out, ply, progress.part(0.5, 1)); });
}

} // namespace mcfskel
