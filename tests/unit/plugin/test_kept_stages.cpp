// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"
#include "threads.h"

#include "layers/kept_stages.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <memory>
#include <vector>

using namespace mcfskel;
using namespace vcg::tri::mcf;

namespace {

KeptStages::StagePointer sharedStage(const shapes::Soup& soup)
{
	const SurfaceMesh mesh = soup.mesh();
	return std::make_shared<const Stage>(initialStage(mesh, checks::noPoles(mesh)));
}

std::vector<KeptStages::StagePointer> someStages()
{
	return {sharedStage(shapes::sphere(5)), sharedStage(shapes::box(1, 0.7, 1e-3)),
		sharedStage(shapes::torus(1, 0.001, 600, 4)), sharedStage(shapes::capsule())};
}

TEST(KeptStages, FieldsAreThoseOfTheStageOnAnyNumberOfThreads)
{
	for (const int count : {1, 2, 5}) {
		const ThreadCount threads(count);
		KeptStages kept;
		for (const KeptStages::StagePointer& stage : someStages())
			kept.add(stage);
		ASSERT_EQ(kept.size(), 4u);
		EXPECT_EQ(kept.last(), kept.stage(3));
		for (size_t i = 0; i < kept.size(); ++i) {
			const StageFields fields = kept.takeFields(i, Progress());
			const StageFields expected = stageFields(*kept.stage(i), Progress());
			EXPECT_EQ(fields.kind, expected.kind) << count << " threads, stage " << i;
			EXPECT_EQ(fields.radius, expected.radius) << count << " threads, stage " << i;
		}
	}
}

TEST(KeptStages, GoesWithFieldsThatNobodyHasTaken)
{
	const ThreadCount threads(2);
	for (int i = 0; i < 20; ++i) {
		KeptStages kept;
		for (const KeptStages::StagePointer& stage : someStages())
			kept.add(stage);
	}
}

TEST(KeptStages, OnOneThreadTheUserCanCancel)
{
	const ThreadCount threads(1);
	KeptStages kept;
	kept.add(sharedStage(shapes::sphere(3)));
	EXPECT_THROW(kept.takeFields(0, Progress([](int, const char*) { return false; })), Cancelled);
}

TEST(KeptStages, TheFlowLeavesACoreAndTakesItBack)
{
	for (const auto& [all, left] : {std::pair {1, 1}, {2, 1}, {5, 4}}) {
		const ThreadCount threads(all);
		{
			const KeptStages::FlowShare share;
			EXPECT_EQ(omp_get_max_threads(), left);
		}
		EXPECT_EQ(omp_get_max_threads(), all);
	}
}

} // namespace
