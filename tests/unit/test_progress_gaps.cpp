// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// No stage is silent for long: measured by the work between two reports, not by a clock, which
// would measure the machine.

#include "shapes.h"

#include "skeleton/check_input.h"
#include "skeleton/first_stage.h"
#include "skeleton/measured_surface.h"
#include "skeleton/noise.h"
#include "skeleton/point_tree.h"
#include "skeleton/resample.h"
#include "skeleton/skeletonize.h"

#include <gtest/gtest.h>

#include <functional>

using namespace vcg::tri::mcf;

namespace {

/// Runs a job; returns how often it reported, or -1 if the bar went backwards.
int reportsOf(const std::function<void(const Progress&)>& job)
{
	int reports = 0, last = 0;
	bool forward = true;
	job(Progress([&](int percent, const char*) {
		forward = forward && percent >= last;
		last = percent;
		++reports;
		return true;
	}));
	return forward ? reports : -1;
}

/// A vertex takes no stage more than some 5 us between two reports: 40 ms.
constexpr int mostVerticesBetweenReports = 8192;

} // namespace

TEST(ProgressGaps, ReadingADenseSurfaceReportsAsItGrows)
{
	const shapes::Soup soup = shapes::sphere(7);
	const SurfaceMesh mesh = soup.mesh();
	const int wanted = mesh.vertexCount() / mostVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) { checkedSurface(soup.points, soup.triangles, p); }),
		wanted / 4); // these take less than a microsecond for a vertex
	EXPECT_GE(reportsOf([&](const Progress& p) { PointTree(mesh.position, p); }), wanted / 4);
	EXPECT_GE(reportsOf([&](const Progress& p) { measureNoise(mesh, p); }), wanted);
}

TEST(ProgressGaps, PolesAndStepsReportAsTheSurfaceGrows)
{
	const SurfaceMesh mesh = shapes::sphere(6).mesh();
	const int wanted = mesh.vertexCount() / mostVerticesBetweenReports;
	Parameters parameters;
	parameters.epsilon = 1e-5; // nothing is coarsened
	Stage stage;
	EXPECT_GE(
		reportsOf([&](const Progress& p) { stage = firstStage(mesh, parameters, nullptr, p); }),
		4 * wanted); // four stages
	EXPECT_EQ(stage.mesh.vertexCount(), mesh.vertexCount());
	EXPECT_GE(
		reportsOf([&](const Progress& p) { stage = step(stage, parameters, p); }), 2 * wanted);
}

TEST(ProgressGaps, ResamplingReportsAsItsInputGrows)
{
	const SurfaceMesh mesh = shapes::sphere(7).mesh();
	const int wanted = mesh.vertexCount() / mostVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) { MeasuredSurface(mesh, p); }), wanted);
	const MeasuredSurface surface(mesh);
	EXPECT_GE(reportsOf([&](const Progress& p) { smoothed(surface, {2}, p); }), 2 * wanted);
	SurfaceMesh coarse;
	const int reports =
		reportsOf([&](const Progress& p) { coarse = resample(surface, {0.3}, 1, p); });
	EXPECT_LT(coarse.vertexCount(), mesh.vertexCount() / 50);
	EXPECT_GE(reports, 4 * wanted); // ordering, creases, coarsening
}

TEST(ProgressGaps, ResamplingReportsAsItsResultGrows)
{
	const SurfaceMesh mesh = shapes::sphere(3).mesh();
	SurfaceMesh fine;
	const int reports = reportsOf([&](const Progress& p) { fine = resample(mesh, {0.03}, 5, p); });
	EXPECT_GE(reports, 5 * 4 * fine.vertexCount() / mostVerticesBetweenReports); // rounds, passes
}
