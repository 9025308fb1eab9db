// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// No stage is silent for long: measured by the work between two reports, not by a clock, which
// would measure the machine.

#include "curves.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/input/check_input.h>
#include <skeleton/core/errors.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/input/denoise.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/refine/refine.h>
#include <skeleton/resample/resample.h>
#include <skeleton/flow/flow.h>
#include <skeleton/input/soup_repair.h>
#include <skeleton/poles/voronoi_poles.h>
#include <skeleton/repair/mend.h>

#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

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
constexpr int maxVerticesBetweenReports = 8192;

} // namespace

TEST(ProgressGaps, ReadingADenseSurfaceReportsAsItGrows)
{
	const shapes::Soup soup = shapes::sphere(7);
	const SurfaceMesh mesh = soup.mesh();
	const int wanted = mesh.vertexCount() / maxVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) { checkedSurface(soup.points, soup.triangles, p); }),
		wanted / 4); // these take less than a microsecond for a vertex
	EXPECT_GE(reportsOf([&](const Progress& p) { PointTree(mesh.position, p); }), wanted / 4);
	EXPECT_GE(reportsOf([&](const Progress& p) { measureNoise(mesh, p); }), wanted);
}

/// What a surface that is not closed as given takes in addition: edges sorted, faces turned, fans told.
TEST(ProgressGaps, RepairingADenseSurfaceReportsAsItGrows)
{
	const shapes::Soup closed = shapes::sphere(7), unmerged = shapes::unmerged(closed);
	shapes::Soup turned = closed, doubled = closed, open = closed;
	for (size_t f = 0; f < turned.triangles.size(); f += 10)
		std::swap(turned.triangles[f][0], turned.triangles[f][1]);
	doubled.triangles.push_back(doubled.triangles[5]);
	open.triangles.pop_back();
	for (const shapes::Soup& soup : {unmerged, turned, doubled}) {
		const int wanted = int(soup.triangles.size()) / maxVerticesBetweenReports;
		EXPECT_GE(
			reportsOf([&](const Progress& p) { repairedSoup(soup.points, soup.triangles, p); }),
			4 * wanted); // faces, edges, sides, fans
		EXPECT_GE(
			reportsOf([&](const Progress& p) { checkedSurface(soup.points, soup.triangles, p); }),
			5 * wanted);
	}
	const int wanted = int(open.triangles.size()) / maxVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) {
		EXPECT_THROW(repairedSoup(open.points, open.triangles, p), InvalidInput);
	}),
		4 * wanted); // faces and edges, as given and merged
}

/// Its faces and their corners are gone through some thirty times.
TEST(ProgressGaps, MendingADenseSurfaceReportsAsItGrows)
{
	shapes::Soup open = shapes::sphere(7);
	open.triangles.pop_back();
	const int wanted = int(open.triangles.size()) / maxVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) {
		EXPECT_TRUE(mend(open.points, open.triangles, HoleLimits(), p).closed);
	}),
		30 * wanted);
}

TEST(ProgressGaps, RepairIsCancelledAtAnyReport)
{
	const shapes::Soup soup = shapes::unmerged(shapes::sphere(5));
	const int reports =
		reportsOf([&](const Progress& p) { repairedSoup(soup.points, soup.triangles, p); });
	for (int last = 1; last <= reports; ++last) {
		int heard = 0;
		const Progress progress([&](int, const char*) { return ++heard < last; });
		EXPECT_THROW(repairedSoup(soup.points, soup.triangles, progress), Cancelled);
		EXPECT_EQ(heard, last);
	}
}

TEST(ProgressGaps, PolesAndStepsReportAsTheSurfaceGrows)
{
	const SurfaceMesh mesh = shapes::sphere(6).mesh();
	const int wanted = mesh.vertexCount() / maxVerticesBetweenReports;
	Parameters parameters;
	parameters.epsilon = 1e-5; // nothing is coarsened
	Stage stage;
	EXPECT_GE(reportsOf([&](const Progress& p) {
		const PoleSet poles = medialPoles(mesh, parameters.poleMethod, p.part(0, 0.5));
		stage = firstStage(mesh, parameters, poles, p.part(0.5, 1));
	}),
		4 * wanted); // four stages
	EXPECT_EQ(stage.mesh.vertexCount(), mesh.vertexCount());
	EXPECT_GE(
		reportsOf([&](const Progress& p) { stage = step(stage, parameters, p); }), 16 * wanted);
}

TEST(ProgressGaps, ResamplingReportsAsItsInputGrows)
{
	const SurfaceMesh mesh = shapes::sphere(7).mesh();
	const int wanted = mesh.vertexCount() / maxVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) { MeasuredSurface(mesh, p); }), wanted);
	const MeasuredSurface surface(mesh);
	const std::vector<int> twice(mesh.position.size(), 2);
	EXPECT_GE(reportsOf([&](const Progress& p) { smoothed(surface, twice, p); }), 2 * wanted);
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
	EXPECT_GE(reports, 5 * 4 * fine.vertexCount() / maxVerticesBetweenReports); // rounds, passes
}

/// Between two reports some MB may be touched that nobody has touched before: these come slowly.
TEST(ProgressGaps, LargeArraysAreMadeInPieces)
{
	constexpr size_t count = 10'000'000;
	constexpr int wanted = int(count * sizeof(int) >> 22);
	std::vector<int> filled, copied;
	EXPECT_GE(
		reportsOf([&](const Progress& p) { filled = detail::filledArray(count, 7, p); }), wanted);
	EXPECT_EQ(filled, std::vector<int>(count, 7));
	filled[count / 2] = 8;
	EXPECT_GE(
		reportsOf([&](const Progress& p) { copied = detail::copiedArray(filled, p); }), wanted);
	EXPECT_EQ(copied, filled);
	detail::fillArray(copied, 3, 9, Progress());
	EXPECT_EQ(copied, std::vector<int>(3, 9));
}

TEST(ProgressGaps, WhatADenseSurfaceIsToldAtTheEndReportsAsItGrows)
{
	const SurfaceMesh mesh = shapes::sphere(7).mesh();
	const int wanted = mesh.vertexCount() / maxVerticesBetweenReports;
	EXPECT_GE(reportsOf([&](const Progress& p) { mesh.copied(p); }), wanted / 4);
	EXPECT_GE(reportsOf([&](const Progress& p) { mesh.volume(p); }), wanted / 4);
	EXPECT_GE(reportsOf([&](const Progress& p) { SurfaceMesh(mesh).compact(p); }), wanted / 4);
	const Stage stage = firstStageOf(mesh, Parameters());
	EXPECT_GE(reportsOf([&](const Progress& p) {
		Stage first = stage;
		first.frames.reset(); // as where a stage was read, or its poles were given
		StageFrames(first, p);
	}),
		wanted / 4);
}

namespace {

/// The test of a body whose curve is inside, with what it needs.
struct Checked
{
	SurfaceMesh mesh;
	std::vector<int> all;
	ClosestSurface closest;
	refining::InsideCheck inside;

	Checked(const shapes::Soup& soup, double spacing) :
			mesh(soup.mesh()), all(detail::numberedArray(mesh.position.size(), Progress())),
			closest(mesh, all, spacing), inside(closest, {mesh, all, all})
	{
	}
};

} // namespace

TEST(ProgressGaps, TheExactTestOfACurveReportsAsItsSurfaceGrows)
{
	const CurveSkeleton curve = curves::line({-0.1, 0, 0}, {0.1, 0, 0}, 0, 4);
	const shapes::Soup soup = shapes::sphere(7);
	const int wanted = int(soup.triangles.size()) / maxVerticesBetweenReports / 4;
	const Checked kept(soup, 1), far(soup, 1);
	const auto count = [&](const Checked& checked, const Progress& p) {
		EXPECT_EQ(checked.inside.countOutside(curve, p), 0);
	};
	const int reports = reportsOf([&](const Progress& p) { count(kept, p.cancelOnly()); });
	EXPECT_GE(reports, wanted);
	EXPECT_LT(reportsOf([&](const Progress& p) { count(kept, p.cancelOnly()); }), reports / 2)
		<< "the tree is there";
	EXPECT_LT(
		reportsOf([&](const Progress& p) { EXPECT_TRUE(far.inside.holds(curve, p.cancelOnly())); }),
		reports / 2)
		<< "a curve far from the surface needs no tree";
	// Cancelled while the tree is built, the next test builds it.
	const Checked cancelled(soup, 1);
	int heard = 0;
	const Progress half([&](int, const char*) { return ++heard < reports / 2; });
	EXPECT_THROW(cancelled.inside.countOutside(curve, half), Cancelled);
	count(cancelled, Progress());
}

TEST(ProgressGaps, EachCrossingOfAnEdgeIsReported)
{
	constexpr int boxes = 40; // each runs into the next
	shapes::Soup row;
	for (int i = 0; i < boxes; ++i)
		row = shapes::joined({row, shapes::moved(shapes::box(1.5, 1, 1), Point3d(i, 0, 0))});
	const Checked checked(row, 1);
	const CurveSkeleton edge = curves::line({0.5, 0.4, 0.55}, {boxes, 0.4, 0.55}, 0, 1);
	EXPECT_GE(reportsOf([&](const Progress& p) {
		EXPECT_TRUE(checked.inside.holds(edge, p.cancelOnly()));
	}),
		2 * (boxes - 1));
}

TEST(ProgressGaps, TidyingAndExtendingBranchesReportEachTip)
{
	// A rod whose curve has a short branch at each node.
	constexpr int tips = 200;
	const SurfaceMesh mesh = shapes::capsule(2, 0.35).mesh();
	CurveSkeleton curve = curves::line({-0.9, 0, 0}, {0.9, 0, 0}, 0, tips);
	for (int i = 1; i < tips; ++i)
		curves::addLine(curve, i, curve.position[size_t(i)] + Point3d(0, 0.1, 0), 0, 2);
	const ClosestSurface closest(mesh, detail::numberedArray(mesh.position.size(), {}), 0.01);
	for (size_t v = 0; v < curve.position.size(); ++v)
		curve.radius[v] = closest.clearance(curve.position[v]);
	refining::KnownClearances clearances(closest);
	EXPECT_GE(reportsOf([&](const Progress& p) { refining::withoutSpurs(curve, 0.1, p); }), tips);
	EXPECT_GE(reportsOf([&](const Progress& p) { refining::withoutStubs(curve, p); }), tips);
	EXPECT_GE(reportsOf([&](const Progress& p) { refining::withoutTwinTips(curve, p); }), tips);
	EXPECT_GE(reportsOf([&](const Progress& p) {
		refining::withoutCornerBranches(curve, clearances, 0.45, p);
	}),
		tips);
	EXPECT_GE(
		reportsOf([&](const Progress& p) { refining::withoutStubsInPlates(curve, closest, p); }),
		tips);
	EXPECT_GE(reportsOf([&](const Progress& p) {
		refining::evenlySampled(curve, closest, 0.005, refining::sameEverywhere, p);
	}),
		2 * tips - 3);
	const refining::TipRule rule = {0.005, 0.2, 0.003};
	EXPECT_GE(reportsOf([&](const Progress& p) {
		CurveSkeleton extended = curve;
		refining::extendTips(extended, closest, rule, p);
	}),
		tips);
}

namespace {

/// The poles of a mesh, cancelled at the given report; how many reports there were.
int cancelledAt(const SurfaceMesh& mesh, int report)
{
	int reports = 0;
	EXPECT_THROW(voronoiPoles(mesh, Progress([&](int, const char*) { return ++reports < report; })),
		Cancelled);
	return reports;
}

} // namespace

TEST(ProgressGaps, QhullReportsAsItsPointsGrow)
{
	constexpr int maxPointsBetweenReports = 512; // each takes some 50 us: 25 ms
	const SurfaceMesh mesh = shapes::sphere(5).mesh();
	int reports = 0, last = 0, steps = 0;
	PoleSet poles;
	EXPECT_GE(reports = reportsOf([&](const Progress& p) {
		poles = voronoiPoles(mesh, Progress([&](int percent, const char* what) {
			steps += percent > last;
			last = percent;
			p.report(percent / 100.0, what);
			return true;
		}));
	}),
		mesh.vertexCount() / maxPointsBetweenReports);
	EXPECT_GE(steps, 50); // the bar moves all the way, not only at both ends
	// Cancelled wherever it is, none but the report that says so follows, and a new run is whole.
	for (int report = 1; report < reports; report += 1 + reports / 40)
		EXPECT_EQ(cancelledAt(mesh, report), report);
	const PoleSet again = voronoiPoles(mesh);
	EXPECT_EQ(again.radius, poles.radius);
	EXPECT_EQ(again.centre, poles.centre);
}
