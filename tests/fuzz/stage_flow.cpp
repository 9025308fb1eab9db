// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fuzzing.h"
#include "ply_mutator.h"

#include <skeleton/io/stage_ply.h>
#include <skeleton/sheets/keep_sheets.h>
#include <skeleton/flow/flow.h>

/// Reads a stage, makes two steps, collapses it to a curve and to sheets, writes all and reads it again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
	using namespace fuzzing;
	constexpr size_t maxVertices = 300; // an input is to take milliseconds
	std::istringstream in = streamOf(data, size);
	Stage stage;
	try {
		stage = readStagePly(readBinaryPly(in)).stage;
	}
	catch (const FormatError&) {
		return 0;
	}
	if (stage.pole.size() > maxVertices || stage.node.size() > maxVertices)
		return 0;
	const int components = int(stage.diagonal.size());
	const int cycles = components - stage.mesh.eulerCharacteristic() / 2;
	Parameters parameters;
	parameters.epsilon = std::max(stage.epsilon, 0.01);
	try {
		for (int i = 0; i < 2; ++i)
			stage = step(std::move(stage), parameters);
		checkStage(stage);
		std::istringstream again(written([&](std::ostream& out) {
			writeStagePly(out, {stage, 0, {}});
		}));
		stage = readStagePly(readBinaryPly(again)).stage;

		const CurveSkeleton skeleton = collapseToCurve(stage, parameters.epsilon);
		const SkeletonStatistics curve = statistics(skeleton);
		require(curve.components == components && curve.cycles == cycles,
			"the curve has the components and cycles of the surface");
		for (double radius : skeleton.radius)
			require(radius >= 0, "the thickness is known");
		workOn(skeleton);
		const SheetCollapse sheets =
			collapseKeepingSheets(stage, sheetVertices(stage), parameters.epsilon);
		require(sheets.skeleton.betti() == BettiNumbers {components, cycles, 0},
			"curves and sheets have the topology of the surface");
	}
	catch (const SolverError&) {
	}
	return 0;
}
