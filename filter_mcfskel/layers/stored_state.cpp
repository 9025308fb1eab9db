// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "stored_state.h"

#if MCFSKEL_FILES
#include "../io/files.h"

#include <skeleton/skeleton_files.h>

#include <QFile>
#include <QFileInfo>
#endif

#include <numeric>

namespace mcfskel {

#if MCFSKEL_FILES
namespace {

/// Whether a file begins as those do that hold a stage or a skeleton.
bool maybeHasState(const QString& name)
{
	if (QFileInfo(name).suffix().compare("ply", Qt::CaseInsensitive) != 0)
		return false;
	QFile file(name);
	return file.open(QIODevice::ReadOnly) && file.read(256).contains("comment mcfskel s");
}

std::shared_ptr<const std::vector<int>> counted(size_t count)
{
	std::vector<int> numbers(count);
	std::iota(numbers.begin(), numbers.end(), 0);
	return std::make_shared<const std::vector<int>>(std::move(numbers));
}

LayerState readState(const mcf::PlyFile& ply)
{
	LayerState state;
	if (mcf::isStagePly(ply)) {
		mcf::StageFile file = mcf::readStagePly(ply);
		state.stage.surface.fingerprint = file.surfaceFingerprint;
		state.stage.surface.vertexOfSlot =
			std::make_shared<const std::vector<int>>(std::move(file.vertexOfSlot));
		state.stage.stage = std::make_shared<const mcf::Stage>(std::move(file.stage));
		return state;
	}
	mcf::SkeletonFile file = mcf::readSkeletonPly(ply);
	CurveLayer curve;
	curve.surface.fingerprint = file.surfaceFingerprint;
	if (!file.skeleton.node.empty())
		curve.surface.vertexOfSlot = counted(file.skeleton.node.size());
	curve.skeleton = std::move(file.skeleton);
	state.diagonal = file.diagonal;
	state.curve = std::make_shared<const CurveLayer>(std::move(curve));
	return state;
}

} // namespace
#endif

bool hasTrianglesOf(const MeshModel& layer, const mcf::Stage& stage)
{
	const CMeshO& mesh = layer.cm;
	if (size_t(mesh.vn) != mesh.vert.size() || mesh.vn != stage.mesh.vertexSlots()
		|| mesh.fn != stage.mesh.faceCount())
		return false;
	int next = 0;
	for (const CFaceO& face : mesh.face) {
		if (face.IsD())
			continue;
		while (!stage.mesh.isFace(next))
			++next;
		const mcf::Triangle corners = stage.mesh.triangle(next++);
		for (int k = 0; k < 3; ++k)
			if (int(vcg::tri::Index(mesh, face.cV(k))) != corners[size_t(k)])
				return false;
	}
	return true;
}

bool hasEdgesOf(const MeshModel& layer, const mcf::CurveSkeleton& skeleton)
{
	const CMeshO& mesh = layer.cm;
	if (mesh.fn > 0 || size_t(mesh.vn) != mesh.vert.size()
		|| mesh.vert.size() != skeleton.position.size() || size_t(mesh.en) != skeleton.edges.size())
		return false;
	size_t next = 0;
	for (const CEdgeO& edge : mesh.edge) {
		if (edge.IsD())
			continue;
		const std::array<int, 2>& ends = skeleton.edges[next++];
		for (int k = 0; k < 2; ++k)
			if (int(vcg::tri::Index(mesh, edge.cV(k))) != ends[size_t(k)])
				return false;
	}
	return true;
}

Moved movedFrom(const MeshModel& layer, const std::vector<vcg::Point3d>& places)
{
	Moved moved;
	for (size_t v = 0; v < places.size(); ++v) {
		const Point3m& now = layer.cm.vert[v].cP();
		if (now == toHost(places[v]))
			continue;
		++moved.count;
		moved.farthest = std::max(moved.farthest, vcg::Distance(toDouble(now), places[v]));
	}
	return moved;
}

#if MCFSKEL_FILES
StatePointer storedState(const MeshModel& layer)
{
	const QString name = layer.fullName();
	if (name.isEmpty() || !maybeHasState(name))
		return nullptr;
	try {
		InputFile file(name);
		const LayerState state = readState(mcf::readBinaryPly(file.stream()));
		const bool fits = state.curve ? hasEdgesOf(layer, state.curve->skeleton)
									  : hasTrianglesOf(layer, *state.stage.stage);
		return fits ? std::make_shared<const LayerState>(state) : nullptr;
	}
	catch (const mcf::Error&) {
		return nullptr; // taken as any mesh; Load Stage says what is wrong with the file
	}
}
#endif

} // namespace mcfskel
