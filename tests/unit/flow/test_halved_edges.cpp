// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "read_off.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A ring of 12 x 6 vertices: its edges are a tenth of its diagonal.
shapes::Soup coarseRing()
{
	return shapes::torus(1, 0.3, 12, 6);
}

std::vector<double> limitsOf(const SurfaceMesh& mesh, double epsilon = Parameters().epsilon)
{
	const std::vector<char> coarse =
		coarseComponents(mesh, epsilon, medialPoles(mesh, PoleMethod::Balls).radius);
	return longestEdgesForFlow(mesh, coarse, epsilon);
}

SurfaceMesh halved(const SurfaceMesh& mesh, double longest)
{
	const MeasuredSurface measured(mesh);
	return withHalvedEdges(measured, std::vector<double>(size_t(measured.components()), longest));
}

double longestEdge(const SurfaceMesh& mesh)
{
	double longest2 = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		longest2 = std::max(longest2, mesh.squaredLength(h));
	return std::sqrt(longest2);
}

double minAngle(const SurfaceMesh& mesh)
{
	double minimum = M_PI;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
		const Point3d& p = mesh.position[mesh.origin(h)];
		const Point3d a = mesh.position[mesh.target(h)] - p, b = mesh.position[mesh.apex(h)] - p;
		minimum = std::min(minimum, std::atan2((a ^ b).Norm(), a * b));
	}
	return minimum;
}

std::vector<Point3d> sortedPlaces(const SurfaceMesh& mesh)
{
	std::vector<Point3d> places = mesh.position;
	std::sort(places.begin(), places.end(), [](const Point3d& p, const Point3d& q) {
		return std::lexicographical_compare(p.V(), p.V() + 3, q.V(), q.V() + 3);
	});
	return places;
}

/// The part of a skeleton's length that is inside of a surface.
double insideFraction(const CurveSkeleton& skeleton, const SurfaceMesh& surface)
{
	constexpr int samplesOfEdge = 20;
	double inside = 0, all = 0;
	for (const auto& [a, b] : skeleton.edges) {
		const Point3d &p = skeleton.position[a], &q = skeleton.position[b];
		for (int i = 0; i < samplesOfEdge; ++i) {
			const double length = Distance(p, q) / samplesOfEdge;
			all += length;
			if (checks::windingNumber(surface, p + (q - p) * ((i + 0.5) / samplesOfEdge)) > 0.5)
				inside += length;
		}
	}
	return inside / all;
}

} // namespace

TEST(HalvedEdges, OnlyCoarseComponentsHaveALimit)
{
	const SurfaceMesh scene =
		shapes::joined({shapes::torus(1, 0.3, 120, 40), shapes::moved(coarseRing(), {5, 0, 0})})
			.mesh();
	const std::vector<double> limit = limitsOf(scene);
	ASSERT_EQ(limit.size(), 2u);
	EXPECT_TRUE(std::isinf(limit[0]));
	// Eight epsilon, and never less than those of the default.
	const double diagonal = std::sqrt(2.6 * 2.6 * 2 + 0.6 * 0.6);
	EXPECT_NEAR(limit[1], 8 * 0.002 * diagonal, 0.1 * limit[1]);
	EXPECT_EQ(limitsOf(scene, 1e-4), limit);
	EXPECT_NEAR(limitsOf(scene, 0.004)[1], 2 * limit[1], 1e-9);
	EXPECT_TRUE(std::isinf(limitsOf(scene, 0.1)[1]));
}

TEST(HalvedEdges, AFewLongEdgesAreNoReason)
{
	shapes::Soup spike = shapes::sphere(5);
	spike.points.back() = spike.points.back() * 1.5;
	const SurfaceMesh mesh = spike.mesh();
	EXPECT_GT(longestEdge(mesh), 20 * 0.002 * mesh.bounds().Diag());
	EXPECT_TRUE(std::isinf(limitsOf(mesh)[0]));
}

TEST(HalvedEdges, ARoundBodyNeedsNoMore)
{
	// All its edges are long, but shorter than it is thick.
	const SurfaceMesh ball = shapes::sphere(3).mesh();
	EXPECT_EQ(coarseComponents(ball, Parameters().epsilon), std::vector<char>(1, 1));
	EXPECT_TRUE(std::isinf(limitsOf(ball)[0]));
	EXPECT_EQ(firstStageOf(ball, Parameters()).mesh.vertexCount(), ball.vertexCount());
}

TEST(HalvedEdges, ManyCoarseBodiesShareTheVertices)
{
	shapes::Soup boxes = shapes::box(1, 2, 4);
	const double alone = limitsOf(boxes.mesh())[0];
	for (int i = 0; i < 7; ++i)
		boxes = shapes::joined({boxes, shapes::moved(boxes, {20 * std::pow(2, i), 0, 0})});
	const std::vector<double> limit = limitsOf(boxes.mesh());
	ASSERT_EQ(limit.size(), 128u);
	for (double length : limit) {
		EXPECT_GT(length, 1.2 * alone);
		EXPECT_NEAR(length, limit[0], 1e-9 * alone);
	}
	EXPECT_LT(128.0 * halved(shapes::box(1, 2, 4).mesh(), limit[0]).vertexCount(), 6e5);
}

TEST(HalvedEdges, NoneIsTooLongAndTheSurfaceIsTheSame)
{
	for (const shapes::Soup& soup : {coarseRing(), shapes::box(1, 2, 4), shapes::tetrahedron(),
			 shapes::joined({shapes::box(), shapes::moved(coarseRing(), {5, 0, 0})})}) {
		const SurfaceMesh mesh = soup.mesh();
		const double limit = 0.02 * mesh.bounds().Diag();
		const SurfaceMesh finer = halved(mesh, limit);
		EXPECT_EQ(checks::structureError(finer), "");
		EXPECT_EQ(finer.eulerCharacteristic(), mesh.eulerCharacteristic());
		EXPECT_LE(longestEdge(finer), limit * (1 + 1e-6));
		EXPECT_NEAR(finer.area(), mesh.area(), 1e-9 * mesh.area());
		EXPECT_NEAR(finer.volume(), mesh.volume(), 1e-9 * mesh.volume());
		EXPECT_GE(minAngle(finer), minAngle(mesh) / 2 - 1e-6);
		ASSERT_GT(finer.vertexCount(), mesh.vertexCount());
		EXPECT_TRUE(std::equal(mesh.position.begin(), mesh.position.end(), finer.position.begin()));
	}
}

TEST(HalvedEdges, NoneTooLongNothingDone)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	EXPECT_EQ(halved(mesh, longestEdge(mesh) * 1.001).triangles(), mesh.triangles());
}

TEST(HalvedEdges, NumberingDoesNotMatter)
{
	const shapes::Soup animal = shapes::fromFile("animal450");
	const double limit = 0.02 * animal.mesh().bounds().Diag();
	const std::vector<Point3d> places = sortedPlaces(halved(animal.mesh(), limit));
	const std::vector<Point3d> again = sortedPlaces(halved(shapes::shuffled(animal).mesh(), limit));
	ASSERT_EQ(again.size(), places.size());
	for (size_t i = 0; i < places.size(); ++i)
		ASSERT_LT(Distance(places[i], again[i]), 1e-9);
}

TEST(HalvedEdges, NumberingDoesNotMatterToTheFlow)
{
	const shapes::Soup animal = shapes::fromFile("animal450");
	Stage here = firstStageOf(animal.mesh(), Parameters());
	Stage there = firstStageOf(shapes::shuffled(animal).mesh(), Parameters());
	for (int i = 0; i < 3; ++i) {
		ASSERT_EQ(here.mesh.triangles(), there.mesh.triangles());
		for (int v = 0; v < here.mesh.vertexSlots(); ++v)
			ASSERT_LT(Distance(here.mesh.position[v], there.mesh.position[v]), 1e-9);
		here = step(std::move(here), Parameters());
		there = step(std::move(there), Parameters());
	}
}

TEST(HalvedEdges, TurningAndScalingDoNotMatter)
{
	const shapes::Soup animal = shapes::fromFile("animal450");
	const double c = std::cos(0.7), s = std::sin(0.7), scale = 1e-3;
	const auto turned = [&](const Point3d& p) {
		return Point3d(c * p[0] - s * p[1], p[2], -s * p[0] - c * p[1]) * scale + Point3d(1, 2, 3);
	};
	const double limit = 0.02 * animal.mesh().bounds().Diag();
	const SurfaceMesh here = halved(animal.mesh(), limit);
	const SurfaceMesh there = halved(shapes::transformed(animal, turned).mesh(), limit * scale);
	ASSERT_EQ(here.triangles(), there.triangles());
	for (int v = 0; v < here.vertexSlots(); ++v)
		ASSERT_LT(Distance(turned(here.position[v]), there.position[v]), 1e-9);
}

TEST(HalvedEdges, CancelledAtOnce)
{
	const SurfaceMesh mesh = coarseRing().mesh();
	const Progress never([](int, const char*) { return false; });
	EXPECT_THROW(withHalvedEdges(mesh, {0.01}, never), Cancelled);
}

TEST(HalvedEdges, TheFirstStageOfACoarseSurfaceKeepsItsVertices)
{
	for (PoleMethod method : {PoleMethod::Balls, PoleMethod::Voronoi}) {
		const SurfaceMesh mesh = coarseRing().mesh();
		Parameters parameters;
		parameters.poleMethod = method;
		const Stage stage = firstStageOf(mesh, parameters);
		EXPECT_EQ(checks::stageError(stage), "");
		EXPECT_GT(stage.mesh.vertexCount(), 2000);
		EXPECT_LT(longestEdge(stage.mesh), 0.0161 * stage.diagonal[0]);
		EXPECT_NEAR(stage.areaFraction(), 1, 1e-9);
		EXPECT_NEAR(stage.volumeFraction(), 1, 1e-9);
		ASSERT_EQ(stage.node.size(), mesh.position.size());
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			EXPECT_EQ(stage.mesh.position[stage.node[v]], mesh.position[v]);
		// Nearly all new vertices have poles, whose balls fit into a ring of this thickness.
		std::vector<char> isOwn(stage.pole.size(), 0);
		for (int v : stage.node)
			isOwn[v] = 1;
		int without = 0;
		for (size_t v = 0; v < isOwn.size(); ++v) {
			without += stage.poleRadius[v] < 0;
			if (!isOwn[v])
				ASSERT_LT(stage.poleRadius[v], 0.31);
		}
		EXPECT_LT(without, stage.mesh.vertexCount() / 20);
	}
}

TEST(HalvedEdges, KnownPolesAreTakenAndTheOthersFound)
{
	const SurfaceMesh mesh = coarseRing().mesh();
	PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const Stage found = firstStage(mesh, Parameters(), poles);
	for (int v = 0; v < mesh.vertexSlots(); v += 2)
		poles.radius[v] = -1;
	const Stage stage = firstStage(mesh, Parameters(), poles);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_EQ(stage.poleRadius[stage.node[v]], poles.radius[v]);
	EXPECT_LE(std::count(stage.poleRadius.begin(), stage.poleRadius.end(), -1),
		std::count(found.poleRadius.begin(), found.poleRadius.end(), -1) + mesh.vertexSlots() / 2);
}

TEST(HalvedEdges, CoarseShapesGetTheirGraphInside)
{
	struct Known
	{
		const char* name;
		int cycles, terminals;
	};
	for (const auto& [name, cycles, terminals] :
		{Known {"torus72", 1, 0}, Known {"box8", 0, 2}, Known {"animal450", 0, 8}}) {
		SCOPED_TRACE(name);
		const SurfaceMesh mesh = shapes::fromFile(name).mesh();
		Stage stage = firstStageOf(mesh, Parameters());
		const Stage end = contractToSkeleton(stage, Parameters());
		EXPECT_TRUE(end.converged);
		const CurveSkeleton skeleton = collapseToCurve(end);
		EXPECT_EQ(checks::skeletonError(skeleton), "");
		const SkeletonStatistics s = statistics(skeleton);
		EXPECT_EQ(s.components, 1);
		EXPECT_EQ(s.cycles, cycles);
		EXPECT_EQ(s.terminals, terminals);
		EXPECT_GT(insideFraction(skeleton, mesh), 0.999);
		// Step by step it is the same, to the last bit.
		while (!stage.converged)
			stage = step(std::move(stage), Parameters());
		EXPECT_TRUE(checks::sameBits(stage, end));
	}
}

TEST(HalvedEdges, ACoarseRingIsFoundInItsMiddle)
{
	// The ring of triangles is thinner than the round one: its axis is a polygon of radius 1.
	const CurveSkeleton skeleton = collapseToCurve(
		contractToSkeleton(firstStageOf(coarseRing().mesh(), Parameters()), Parameters()));
	for (const Point3d& p : skeleton.position) {
		EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 0.06);
		EXPECT_NEAR(p[2], 0, 0.06);
	}
	EXPECT_GT(skeleton.position.size(), 20u);
}
