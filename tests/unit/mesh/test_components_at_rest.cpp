// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "hostile_bodies.h"
#include "mesh_checks.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/input/check_input.h>
#include <skeleton/mesh/components_at_rest.h>
#include <skeleton/collapse/curve_inside.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/resample/resample.h>
#include <skeleton/flow/flow.h>
#include <skeleton/flow/start_of_flow.h>
#include <skeleton/poles/poles.h>
#include <skeleton/spatial/solid_test.h>
#include <skeleton/resample/target_length.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A ball stretched along x, turned so that no axis of it is one of the coordinates.
shapes::Soup needle(double width, int levels = 2)
{
	return shapes::transformed(shapes::sphere(levels), [&](const Point3d& p) {
		const double x = p[0], y = width * p[1], z = width * p[2];
		return Point3d(
			0.6 * x - 0.8 * y, 0.64 * x + 0.48 * y - 0.6 * z, 0.48 * x + 0.36 * y + 0.8 * z);
	});
}

/// A ball and specks beside it.
shapes::Soup withSpecks(int count, double radius)
{
	shapes::Soup soup = shapes::sphere(2);
	for (int i = 0; i < count; ++i)
		soup = shapes::joined({soup,
			shapes::moved(
				shapes::scaled(i % 2 ? shapes::torus(1, 0.4, 8, 6) : shapes::sphere(1), radius),
				{2, 0.1 * i, 0})});
	return soup;
}

/// The stages and the curve of a surface as it is.
CurveSkeleton skeletonOf(const SurfaceMesh& surface, Stage& end)
{
	StageObserver observer;
	observer.onFigures = [](const StageFigures& figures) {
		EXPECT_GE(figures.volumeFraction, 0);
		EXPECT_LE(figures.volumeFraction, 1);
	};
	const Parameters parameters;
	end = contractToSkeleton(firstStageOf(surface, parameters), parameters, Progress(), observer);
	return collapseInside(end, parameters.epsilon);
}

/// Empty if a curve has the topology of its surface and lies inside, nodes and edges.
std::string error(const SurfaceMesh& surface, const CurveSkeleton& curve)
{
	const std::string broken = checks::skeletonError(curve);
	if (!broken.empty())
		return broken;
	int components = 0;
	connectedComponents(surface, &components);
	if (statistics(curve).components != components)
		return "a wrong number of components";
	if (statistics(curve).cycles != checks::genus(surface))
		return "a wrong number of cycles";
	const SolidTest solid(surface.position, surface.triangles());
	const auto isOutside = [&](const Point3d& p) {
		return std::abs(checks::windingNumber(surface, p)) < 0.5
			&& solid.closest(solid.in(p)).distance > 1e-6;
	};
	if (std::any_of(curve.position.begin(), curve.position.end(), isOutside))
		return "a node outside";
	for (const auto& [a, b] : curve.edges)
		for (double t : {0.25, 0.5, 0.75})
			if (isOutside(curve.position[a] * (1 - t) + curve.position[b] * t))
				return "an edge outside";
	return "";
}

} // namespace

TEST(ComponentsAtRest, AreThoseThatAreThinOrSpecks)
{
	const auto rests = [](const shapes::Soup& soup) { return componentsAtRest(soup.mesh()); };
	EXPECT_EQ(rests(shapes::sphere(2)), std::vector<char> {0});
	EXPECT_EQ(rests(shapes::box(1, 1, 1e-5)), std::vector<char> {0});
	EXPECT_EQ(rests(shapes::box(1, 1, 1e-6)), std::vector<char> {1});
	EXPECT_EQ(rests(needle(1e-4)), std::vector<char> {0});
	EXPECT_EQ(rests(needle(1e-6)), std::vector<char> {1});
	EXPECT_EQ(rests(shapes::torus(1, 1e-7)), std::vector<char> {1}) << "thin, though wide";
	std::vector<char> allButTheFirst(21, 1);
	allButTheFirst[0] = 0;
	EXPECT_EQ(rests(withSpecks(20, 0.02)), std::vector<char>(21, 0));
	EXPECT_EQ(rests(withSpecks(20, 0.005)), allButTheFirst);
	EXPECT_EQ(rests(withSpecks(2, 0.005)), std::vector<char>(3, 0)) << "few cost little";
	for (double size : {1e-20, 1e20}) // of the whole, not of a unit
		EXPECT_EQ(rests(shapes::scaled(withSpecks(20, 0.005), size)), allButTheFirst);
}

TEST(ComponentsAtRest, NeedlesOfAnyWidthEndEarlyInALine)
{
	for (double width : {1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 3e-9, 1e-12}) {
		SCOPED_TRACE(width);
		const shapes::Soup soup = needle(width);
		const SurfaceMesh surface = checkedSurface(soup.points, soup.triangles).mesh;
		Stage end;
		const CurveSkeleton curve = skeletonOf(surface, end);
		EXPECT_TRUE(end.converged);
		EXPECT_LT(end.iteration, 60);
		EXPECT_EQ(checks::skeletonError(curve), "");
		EXPECT_EQ(statistics(curve).components, 1);
		EXPECT_EQ(statistics(curve).cycles, 0);
		EXPECT_NEAR(statistics(curve).length, 2, 0.5);
		EXPECT_LT(end.mesh.vertexCount(), 5000);
		for (const Point3d& p : curve.position) // off the axis of the needle
			EXPECT_LT((p - Point3d(0.6, 0.64, 0.48) * (p * Point3d(0.6, 0.64, 0.48))).Norm(),
				width + 1e-6);
	}
}

TEST(ComponentsAtRest, ResamplingLeavesThemAndTheOrderOfTheOthers)
{
	// A ring of nearly no thickness first, one in between, one at the end.
	const shapes::Soup speck = shapes::scaled(shapes::torus(1, 1e-7, 8, 6), 0.004);
	const shapes::Soup soup = shapes::joined(
		{shapes::moved(speck, {3, 0, 0}), shapes::sphere(2), shapes::moved(speck, {4, 0, 0}),
			shapes::moved(shapes::torus(), {6, 0, 0}), shapes::moved(speck, {9, 0, 0})});
	const SurfaceMesh surface = soup.mesh();
	const SurfaceMesh mesh = resample(surface, {0.001, 0.1, 0.001, 0.1, 0.001}, 5);
	EXPECT_EQ(checks::structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), surface.eulerCharacteristic());
	int components = 0;
	const std::vector<int> component = connectedComponents(mesh, &components);
	ASSERT_EQ(components, 5);
	std::vector<int> count(5, 0);
	std::vector<vcg::Box3d> box(5);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		++count[component[v]];
		box[component[v]].Add(mesh.position[v]);
	}
	const double middles[5] = {3, 0, 4, 6, 9};
	for (int c = 0; c < 5; ++c) {
		EXPECT_NEAR(box[c].Center()[0], middles[c], 0.05);
		EXPECT_EQ(count[c] == 48, c % 2 == 0);
	}
	// What moves is resampled as if the others were not there.
	const SurfaceMesh alone = resample(
		shapes::joined({shapes::sphere(2), shapes::moved(shapes::torus(), {6, 0, 0})}).mesh(),
		{0.1, 0.1}, 5);
	std::vector<Point3d> moved, expected = alone.position;
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (component[v] % 2)
			moved.push_back(mesh.position[v]);
	std::sort(moved.begin(), moved.end());
	std::sort(expected.begin(), expected.end());
	EXPECT_EQ(moved, expected);
}

TEST(ComponentsAtRest, AHundredSpecksKeepTheirTopologyAndCostNoMoreThanTheirSize)
{
	const SurfaceMesh surface = withSpecks(100, 0.002).mesh();
	const SurfaceMesh mesh = resample(surface, defaultTargetLength(surface), 5);
	const SurfaceMesh alone = shapes::sphere(2).mesh();
	const double length = defaultTargetLength(surface)[0];
	const SurfaceMesh ball = resample(alone, {length}, 5);
	EXPECT_EQ(mesh.vertexCount(), ball.vertexCount() + surface.vertexCount() - alone.vertexCount());
	Stage end, endOfBall;
	const CurveSkeleton curve = skeletonOf(mesh, end);
	EXPECT_TRUE(end.converged);
	EXPECT_EQ(statistics(curve).components, 101);
	EXPECT_EQ(statistics(curve).cycles, 50) << "every other speck is a ring";
	EXPECT_EQ(error(mesh, curve), "");
	// The ball is skeletonized as if it were alone.
	const CurveSkeleton ofBall = skeletonOf(ball, endOfBall);
	std::vector<Point3d> nodes;
	for (const Point3d& p : curve.position)
		if (p[0] < 1.5)
			nodes.push_back(p);
	EXPECT_EQ(nodes, ofBall.position);
}

TEST(ComponentsAtRest, SpecksTakeNoShareOfTheWork)
{
	const Parameters usual;
	std::vector<double> diagonal(200, 0.009);
	diagonal[7] = 1;
	EXPECT_EQ(sharedAmong(usual, diagonal).epsilon, usual.epsilon);
	diagonal.assign(200, 0.02);
	diagonal[7] = 1;
	const Parameters shared = sharedAmong(usual, diagonal);
	EXPECT_NEAR(shared.epsilon, 2 * usual.epsilon, 1e-15);
	EXPECT_EQ(sharedAmong(shared, diagonal).epsilon, shared.epsilon) << "twice";
}

TEST(ComponentsAtRest, AFlowThatHoldsVerticesSharesAndRestsLikeOthers)
{
	// Thin rings, which have limits of epsilon, and a speck.
	shapes::Soup soup = shapes::torus(1e-3, 3e-4, 8, 6);
	const size_t speck = soup.points.size();
	for (int i = 0; i < 80; ++i)
		soup =
			shapes::joined({soup, shapes::moved(shapes::torus(1, 0.008, 60, 6), {0, 0, 1.0 + i})});
	const SurfaceMesh surface = soup.mesh();
	const PoleSet poles = medialPoles(surface, PoleMethod::Balls);
	std::vector<char> held(soup.points.size(), 0);
	held.back() = 1;
	const Parameters usual;
	const Parameters shared = sharedAmong(usual, MeasuredSurface(surface).diagonals());
	ASSERT_GT(shared.epsilon, usual.epsilon);
	const Stage stage = startOfFlow(surface, poles, held, usual);
	EXPECT_FALSE(stage.epsilonLimit.empty());
	EXPECT_EQ(stage.epsilonLimit, startOfFlow(surface, poles, held, shared).epsilonLimit);
	for (size_t v = 0; v < held.size(); ++v)
		EXPECT_EQ(stage.fixed[v], v < speck || held[v]) << v;
}

TEST(ComponentsAtRest, HostileBodiesHaveCurvesInsideOfTheRightTopology)
{
	for (const std::string& family : shapes::hostileFamilies())
		for (unsigned seed = 1; seed <= 5; ++seed) {
			SCOPED_TRACE(family + " " + std::to_string(seed));
			const shapes::Soup soup = shapes::hostileBody(family, seed);
			const SurfaceMesh surface = checkedSurface(soup.points, soup.triangles).mesh;
			Stage end;
			EXPECT_EQ(error(surface, skeletonOf(surface, end)), "");
			EXPECT_TRUE(end.converged);
		}
}
