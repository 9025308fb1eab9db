// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Files of our own writers with other values in their fields: a reader refuses them, or what it hands over
// is fit for all that works on it. See tests/fuzz/ for the same with bytes that are led by coverage.

#include "changed_fields.h"
#include "graphs.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/io/cg.h>
#include <skeleton/io/skeleton_ply.h>
#include <skeleton/io/stage_ply.h>
#include <skeleton/io/swc.h>
#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/resample_skeleton.h>
#include <skeleton/flow/flow.h>
#include <skeleton/sheets/vertex_kind.h>

#include <gtest/gtest.h>

#include <random>

using namespace graphs;

namespace {

struct Outcomes
{
	int refused = 0, accepted = 0;
};

/// Changes a PLY file, as often as wanted, and counts what `use` does with it: it takes the file or throws
/// a FormatError.
template <class Use>
Outcomes changeOften(const std::string& file, int times, unsigned seed, const Use& use)
{
	Outcomes outcomes;
	std::mt19937 random(seed);
	std::istringstream original(file);
	const PlyFile ply = readBinaryPly(original);
	for (int i = 0; i < times; ++i) {
		PlyFile changed = ply;
		changed_fields::changeTables(changed, random);
		std::istringstream in(written([&](std::ostream& out) { writeBinaryPly(out, changed); }));
		try {
			use(in);
			++outcomes.accepted;
		}
		catch (const FormatError&) {
			++outcomes.refused;
		}
	}
	return outcomes;
}

/// A skeleton that was read can be measured, changed and written.
void expectFitForUse(CurveSkeleton skeleton)
{
	EXPECT_NO_THROW(requireWritable(skeleton));
	const SkeletonStatistics before = statistics(skeleton);
	EXPECT_TRUE(std::isfinite(before.length));
	skeleton.radius.resize(skeleton.position.size(), 0);
	const auto expectSameTopology = [&](const CurveSkeleton& s) {
		EXPECT_EQ(statistics(s).components, before.components);
		EXPECT_EQ(statistics(s).cycles, before.cycles);
		EXPECT_NO_THROW(requireWritable(s));
	};
	expectSameTopology(prune(skeleton, PruneParameters()));
	if (before.length > 0)
		expectSameTopology(resampledSkeleton(skeleton, before.length / 50));
}

/// A stage that was read can be measured, contracted further and collapsed.
void expectFitForUse(Stage stage)
{
	EXPECT_NO_THROW(checkStage(stage));
	if (stage.epsilon >= 0.01) { // else it takes millions of pieces
		EXPECT_EQ(vertexKinds(stage).size(), stage.pole.size());
	}
	const int components = int(stage.diagonal.size());
	const int cycles = components - stage.mesh.eulerCharacteristic() / 2;
	Parameters parameters;
	parameters.epsilon = 0.02;
	try {
		for (int i = 0; i < 2; ++i)
			stage = step(std::move(stage), parameters);
		EXPECT_NO_THROW(checkStage(stage));
		const CurveSkeleton skeleton = collapseToCurve(stage, parameters.epsilon);
		EXPECT_EQ(statistics(skeleton).components, components);
		EXPECT_EQ(statistics(skeleton).cycles, cycles);
		EXPECT_NO_THROW(requireWritable(skeleton));
	}
	catch (const SolverError&) {
		// Needles and folds that no flow can solve: an error, nothing else.
	}
}

} // namespace

TEST(ChangedFiles, StagesAreRefusedOrFitForUse)
{
	Parameters parameters;
	parameters.epsilon = 0.02;
	Stage stage = firstStageOf(shapes::joined({shapes::torus(1, 0.3, 9, 5),
												  shapes::moved(shapes::octahedron(), {4, 0, 0})})
								   .mesh(),
		parameters);
	stage.epsilon = parameters.epsilon;
	Outcomes all;
	for (unsigned iteration = 0; iteration < 3; ++iteration) {
		const std::string file = written([&](std::ostream& out) {
			writeStagePly(out, {stage, 0, {0, -1, 1}});
		});
		const Outcomes outcomes = changeOften(file, 400, 11 + iteration,
			[](std::istream& in) { expectFitForUse(readStagePly(readBinaryPly(in)).stage); });
		all.accepted += outcomes.accepted;
		all.refused += outcomes.refused;
		stage = step(std::move(stage), parameters);
	}
	EXPECT_GT(all.refused, 300);
	EXPECT_GT(all.accepted, 300);
}

TEST(ChangedFiles, SkeletonsInPlyAreRefusedOrFitForUse)
{
	const std::string file =
		written([](std::ostream& out) { writeSkeletonPly(out, ringWithTailAndY()); });
	const Outcomes outcomes = changeOften(file, 3000, 5,
		[](std::istream& in) { expectFitForUse(readSkeletonPly(readBinaryPly(in)).skeleton); });
	EXPECT_GT(outcomes.refused, 500);
	EXPECT_GT(outcomes.accepted, 500);
}

TEST(ChangedFiles, SkeletonsInTextAreRefusedWithTheirLineOrFitForUse)
{
	const std::vector<std::pair<std::string, SkeletonFile (*)(std::istream&)>> formats = {
		{written([](std::ostream& out) { writeSwc(out, ringWithTailAndY()); }), readSwc},
		{written([](std::ostream& out) { writeCg(out, ringWithTailAndY()); }), readCg}};
	for (const auto& [file, read] : formats) {
		std::mt19937 random(3);
		int refused = 0, accepted = 0;
		for (int i = 0; i < 3000; ++i) {
			std::string changed = file;
			for (unsigned changes = 1 + random() % 2; changes > 0; --changes)
				changed = changed_fields::withOtherField(changed, random);
			std::istringstream in(changed);
			try {
				expectFitForUse(read(in).skeleton);
				++accepted;
			}
			catch (const FormatError& error) {
				EXPECT_GT(error.line(), 0u) << error.what();
				++refused;
			}
		}
		EXPECT_GT(refused, 500);
		EXPECT_GT(accepted, 300);
	}
}
