// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fuzzing.h"
#include "ply_mutator.h"

#include <skeleton/io/stage_ply.h>
#include <skeleton/sheets/vertex_kind.h>

/// What Load Stage does: reads, measures, tells the kinds; then Save Stage, which gives the same again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
	using namespace fuzzing;
	std::istringstream in = streamOf(data, size);
	StageFile file;
	try {
		file = readStagePly(readBinaryPly(in));
	}
	catch (const FormatError&) {
		return 0;
	}
	checkStage(file.stage);
	const StageFigures figures = figuresOf(file.stage);
	require(std::isfinite(figures.areaFraction) && std::isfinite(figures.volumeFraction),
		"the fractions are finite");
	for (double radius : stageRadius(file.stage))
		require(radius >= 0 && std::isfinite(radius), "the thickness is a length");
	// Far below the edges' lengths it takes millions of pieces, and a second: not for all inputs.
	if (file.stage.epsilon >= 0.005 || size % 32 == 0)
		vertexKinds(file.stage);
	const std::string once = written([&](std::ostream& out) { writeStagePly(out, file); });
	std::istringstream again(once);
	const StageFile read = readStagePly(readBinaryPly(again));
	require(written([&](std::ostream& out) { writeStagePly(out, read); }) == once,
		"a stage reads back the same");
	return 0;
}
