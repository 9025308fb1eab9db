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

/// One number for each element of `elements` that is not deleted.
template <class Container, class ValueOf>
std::vector<double> valuesOfLive(const Container& elements, const ValueOf& valueOf)
{
	std::vector<double> values;
	values.reserve(elements.size());
	for (size_t i = 0; i < elements.size(); ++i)
		if (!elements[i].IsD())
			values.push_back(double(valueOf(i)));
	return values;
}

template <class Container>
void addColours(mcf::PlyElement& element, const Container& elements)
{
	const char* const names[] = {"red", "green", "blue", "alpha"};
	for (int k = 0; k < 4; ++k)
		element.add(names[k], mcf::PlyType::UInt8,
			valuesOfLive(elements, [&](size_t i) { return int(elements[i].cC()[k]); }));
}

/// The columns of the attributes mcfskel_*.
void addAttributes(mcf::PlyElement& vertex, const CMeshO& mesh)
{
	for (const vcg::PointerToAttribute& attribute : mesh.vert_attr) {
		if (attribute._name.rfind("mcfskel_", 0) != 0)
			continue;
		if (isOfType<Scalarm>(attribute)) {
			const Scalarm* values = valuesOf<Scalarm>(attribute);
			vertex.add(attribute._name, mcf::PlyType::Double,
				valuesOfLive(mesh.vert, [&](size_t i) { return values[i]; }));
		}
		else if (isOfType<Point3m>(attribute)) {
			const Point3m* values = valuesOf<Point3m>(attribute);
			for (int k = 0; k < 3; ++k)
				vertex.add(attribute._name + "_" + "xyz"[k], mcf::PlyType::Double,
					valuesOfLive(mesh.vert, [&](size_t i) { return values[i][k]; }));
		}
	}
}

mcf::PlyElement vertexTable(const MeshModel& layer)
{
	const auto& vertices = layer.cm.vert;
	mcf::PlyElement table {"vertex", size_t(layer.cm.vn), {}};
	for (int k = 0; k < 3; ++k)
		table.add(std::string(1, "xyz"[k]), mcf::PlyType::Double,
			valuesOfLive(vertices, [&](size_t i) { return vertices[i].cP()[k]; }));
	if (layer.hasDataMask(MeshModel::MM_VERTQUALITY))
		table.add("quality", mcf::PlyType::Double,
			valuesOfLive(vertices, [&](size_t i) { return vertices[i].cQ(); }));
	if (layer.hasDataMask(MeshModel::MM_VERTCOLOR))
		addColours(table, vertices);
	addAttributes(table, layer.cm);
	return table;
}

mcf::PlyElement faceTable(const MeshModel& layer, const std::vector<int>& numberOfSlot)
{
	const auto& faces = layer.cm.face;
	mcf::PlyElement table {"face", size_t(layer.cm.fn), {}};
	mcf::PlyColumn corners {"vertex_indices", mcf::PlyType::Int32, 3, {}};
	for (const CFaceO& face : faces)
		for (int k = 0; k < 3 && !face.IsD(); ++k)
			corners.values.push_back(numberOfSlot[vcg::tri::Index(layer.cm, face.cV(k))]);
	table.columns.push_back(std::move(corners));
	if (layer.hasDataMask(MeshModel::MM_FACEQUALITY))
		table.add("quality", mcf::PlyType::Double,
			valuesOfLive(faces, [&](size_t i) { return faces[i].cQ(); }));
	if (layer.hasDataMask(MeshModel::MM_FACECOLOR))
		addColours(table, faces);
	return table;
}

mcf::PlyElement edgeTable(const CMeshO& mesh, const std::vector<int>& numberOfSlot)
{
	mcf::PlyElement table {"edge", size_t(mesh.en), {}};
	for (int end = 0; end < 2; ++end)
		table.add(end ? "vertex2" : "vertex1", mcf::PlyType::Int32,
			valuesOfLive(mesh.edge, [&](size_t i) {
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
		addColours(ply.elements.front(), layer.cm.vert);
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
		addColours(ply.elements.front(), layer.cm.vert);
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
