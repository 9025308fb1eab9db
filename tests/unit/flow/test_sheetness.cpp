// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/sheets/keep_sheets.h>
#include <skeleton/poles/poles.h>
#include <skeleton/flow/sheet_marks.h>
#include <skeleton/flow/sheetness.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

std::vector<double> sheetnessOf(const SurfaceMesh& mesh)
{
	return sheetness(mesh, medialPoles(mesh, PoleMethod::Balls));
}

double median(std::vector<double> values)
{
	std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
	return values[values.size() / 2];
}

/// A plate of evenly fine triangles, as after resampling.
SurfaceMesh slab(double thickness = 0.1)
{
	shapes::Soup s = shapes::box(1, 0.8, thickness);
	for (int i = 0; i < 5; ++i)
		s = shapes::subdivided(s);
	return s.mesh();
}

TEST(Sheetness, TellsPlatesFromTubesAndBalls)
{
	const SurfaceMesh plate = slab();
	const std::vector<double> ofPlate = sheetnessOf(plate);
	std::vector<double> middle;
	for (int v = 0; v < plate.vertexSlots(); ++v) {
		const Point3d& p = plate.position[v];
		if (std::abs(p[0] - 0.5) < 0.35 && std::abs(p[1] - 0.4) < 0.25)
			middle.push_back(ofPlate[v]);
	}
	EXPECT_GT(*std::min_element(middle.begin(), middle.end()), 0.87);
	EXPECT_LT(median(sheetnessOf(shapes::torus(1, 0.2, 120, 24).mesh())), 0.3);
	EXPECT_LT(median(sheetnessOf(shapes::sphere(4).mesh())), 0.3);
}

TEST(Sheetness, GrowsWithTheFlatnessOfTheCrossSection)
{
	double last = -1;
	for (double flatness : {1.0, 1.5, 2.0, 4.0}) {
		const SurfaceMesh mesh =
			shapes::transformed(shapes::torus(1, 0.1, 160, 48), [&](const Point3d& p) {
				return Point3d(p[0], p[1], p[2] * flatness);
			}).mesh();
		const double s = median(sheetnessOf(mesh));
		RecordProperty("s_" + std::to_string(flatness), std::to_string(s));
		EXPECT_GT(s, last) << flatness;
		EXPECT_LE(s, 1);
		last = s;
	}
	EXPECT_GT(last, 0.8);
}

TEST(Sheetness, TheSameAtAnySizeAndPlace)
{
	const shapes::Soup soup = shapes::torus(1, 0.2, 60, 16);
	const std::vector<double> a = sheetnessOf(soup.mesh()),
							  b = sheetnessOf(shapes::scaled(soup, 1024).mesh());
	for (size_t v = 0; v < a.size(); ++v)
		EXPECT_NEAR(a[v], b[v], 1e-6);
}

TEST(Sheetness, OfAComponentIsWhatItIsAlone)
{
	// A ball in a plate, which touches both of its walls and neither of its neighbours.
	const shapes::Soup ball = shapes::moved(shapes::sphere(3, 0.05), {0.5, 0.4, 0.05}),
					   plate = {slab().position, slab().triangles()};
	std::vector<double> alone = sheetnessOf(plate.mesh());
	const std::vector<double> ofBall = sheetnessOf(ball.mesh());
	alone.insert(alone.end(), ofBall.begin(), ofBall.end());
	EXPECT_EQ(sheetnessOf(shapes::joined({plate, ball}).mesh()), alone);
}

TEST(MarkSheets, TheThresholdSaysHowMuch)
{
	const SurfaceMesh mesh = slab();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const std::vector<double> s = sheetness(mesh, poles);
	size_t last = size_t(mesh.vertexSlots()) + 1;
	for (double threshold : {0.0, 0.7, 0.85, 1.0}) {
		Stage stage = initialStage(mesh, poles);
		markSheets(stage, s, threshold);
		const size_t count = size_t(std::count(stage.sheet.begin(), stage.sheet.end(), 1));
		EXPECT_LE(count, last);
		last = count;
		EXPECT_EQ(stage.hasSheets(), threshold < 1);
	}
}

TEST(MarkSheets, TheFlowStopsWithTheSheetBetweenTheWalls)
{
	const double thickness = 0.1;
	const SurfaceMesh mesh = slab(thickness);
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	Stage stage = initialStage(mesh, poles);
	markSheets(stage, sheetness(mesh, poles), Parameters().sheetThreshold);
	stage = contractToSkeleton(std::move(stage), Parameters());
	EXPECT_TRUE(stage.converged);
	EXPECT_LT(stage.iteration, 60);
	EXPECT_EQ(checks::stageError(stage), "");
	const SheetCollapse result = collapseKeepingSheets(stage, sheetVertices(stage), 0.002);
	EXPECT_EQ(result.givenUp, 0);
	EXPECT_EQ(result.skeleton.betti(), (BettiNumbers {1, 0, 0}));
	EXPECT_GT(result.skeleton.sheetArea(), 0.5 * 0.8);
	EXPECT_LT(result.skeleton.sheetArea(), 0.8);
	double sum = 0;
	for (const Point3d& p : result.skeleton.position)
		sum += std::abs(p[2] - thickness / 2);
	EXPECT_LT(sum / double(result.skeleton.position.size()), 0.001);
}

TEST(MarkSheets, WithoutThemTheFlowIsTheSame)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 40, 16).mesh();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	Stage plain = initialStage(mesh, poles), none = initialStage(mesh, poles);
	markSheets(none, sheetness(mesh, poles), 1);
	for (int i = 0; i < 3; ++i) {
		plain = step(std::move(plain), Parameters());
		none = step(std::move(none), Parameters());
	}
	EXPECT_TRUE(checks::sameBits(plain, none));
}

} // namespace
