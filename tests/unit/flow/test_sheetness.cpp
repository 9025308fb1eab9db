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
#include <array>
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

TEST(MarkSheets, AreTheVerticesAboveTheThreshold)
{
	const SurfaceMesh mesh = slab();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	std::vector<double>
		s; // grows along the plate, whose vertices have places that are multiples of 1/32
	for (const Point3d& p : mesh.position)
		s.push_back(p[0]);
	for (double threshold : {0.25, 0.5, 0.75}) {
		Stage stage = initialStage(mesh, poles);
		stage.poleRadius[0] = -1;
		stage.poleRadius.back() = -1;
		markSheets(stage, s, threshold);
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			EXPECT_EQ(bool(stage.sheet[v]), s[size_t(v)] > threshold && stage.poleRadius[v] >= 0);
	}
	Stage stage = initialStage(mesh, poles);
	markSheets(stage, std::vector<double>(s.size(), 1), 1);
	EXPECT_FALSE(stage.hasSheets()) << "none is above 1";
}

TEST(MarkSheets, SmallHolesAreFilledAndSmallMarksDropped)
{
	// Vertices are 1/32 and 1/40 apart, so that each has 7.8e-4 of the area of a face of 1 by 0.8. Of the squared
	// diagonal, 1.65, a hole of 0.1 % is as large as two of them, and marks of 0.5 % as ten and a half.
	const SurfaceMesh mesh = slab();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const auto block = [](const Point3d& p, double x, double y, int width, int height) {
		return p[2] > 0.05 && p[0] > x - 0.01 && p[0] < x + (width - 0.5) / 32 && p[1] > y - 0.01
			&& p[1] < y + (height - 0.5) / 40;
	};
	Stage stage = initialStage(mesh, poles);
	std::vector<double> s;
	for (const Point3d& p : mesh.position) {
		const bool hole = block(p, 0.125, 0.3, 1, 1) || block(p, 0.25, 0.3, 3, 3);
		const bool mark = block(p, 0.625, 0.3, 3, 3) || block(p, 0.8125, 0.3, 4, 4);
		s.push_back((p[0] < 0.5 && !hole) || mark ? 1 : 0);
	}
	markSheets(stage, s, 0.5);
	int inHole = 0, inLargeHole = 0, inMark = 0, inLargeMark = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& p = mesh.position[v];
		const int isSheet = stage.sheet[v];
		if (block(p, 0.125, 0.3, 1, 1))
			inHole += isSheet;
		else if (block(p, 0.25, 0.3, 3, 3))
			inLargeHole += isSheet;
		else if (block(p, 0.625, 0.3, 3, 3))
			inMark += isSheet;
		else if (block(p, 0.8125, 0.3, 4, 4))
			inLargeMark += isSheet;
		else
			EXPECT_EQ(bool(isSheet), p[0] < 0.5);
	}
	EXPECT_EQ(inHole, 1) << "filled";
	EXPECT_EQ(inLargeHole, 0);
	EXPECT_EQ(inMark, 0) << "dropped";
	EXPECT_EQ(inLargeMark, 16);
}

TEST(MarkSheets, TheUsualThresholdTakesPlatesAndNoTubes)
{
	// A plate and, apart from it, a ring: as round as can be, and as flat.
	const shapes::Soup plate = {slab().position, slab().triangles()};
	const SurfaceMesh mesh =
		shapes::joined({plate, shapes::moved(shapes::torus(1, 0.2, 120, 24), {5, 0, 0})}).mesh();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const std::vector<double> s = sheetness(mesh, poles);
	const auto marked = [&](double threshold) {
		Stage stage = initialStage(mesh, poles);
		markSheets(stage, s, threshold);
		std::array<double, 2> area = {0, 0}; // of the faces all of whose vertices are marked
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			const Triangle t = mesh.triangle(f);
			if (stage.sheet[t[0]] && stage.sheet[t[1]] && stage.sheet[t[2]])
				area[mesh.position[t[0]][0] > 2] += mesh.doubleAreaVector(f).Norm() / 2;
		}
		return area;
	};
	const double walls = 2 * 1 * 0.8, sides = 2 * (1 + 0.8) * 0.1, ring = 4 * M_PI * M_PI * 0.2;
	const auto [low, lowRing] = marked(0);
	EXPECT_NEAR(low, walls + sides, 0.02 * walls);
	EXPECT_NEAR(lowRing, ring, 0.02 * ring);
	const auto [usual, usualRing] = marked(Parameters().sheetThreshold);
	EXPECT_EQ(usualRing, 0);
	// But for half a thickness along the rim, whose balls touch its sides, and three edges of averaging.
	const double rim = 0.1 / 2 + 3.0 / 32;
	EXPECT_GT(usual, 2 * (1 - 2 * rim) * (0.8 - 2 * rim));
	EXPECT_LT(usual, low);
	const auto [none, noRing] = marked(1);
	EXPECT_EQ(none + noRing, 0);
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
