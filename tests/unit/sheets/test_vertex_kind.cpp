// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/sheets/vertex_kind.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A stage of which nothing is fixed: its kinds must be told from its shape alone.
double share(const std::vector<VertexKind>& kinds, VertexKind kind)
{
	return double(std::count(kinds.begin(), kinds.end(), kind)) / double(kinds.size());
}

/// The part of the area that belongs to vertices of that kind: where triangles are uneven, as on
/// the narrow sides of a plate, a count of vertices says nothing.
double areaShare(const Stage& stage, VertexKind kind)
{
	const std::vector<VertexKind> kinds = vertexKinds(stage);
	double sum = 0;
	for (int f = 0; f < stage.mesh.faceSlots(); ++f)
		for (int v : stage.mesh.triangle(f))
			sum += kinds[v] == kind ? stage.mesh.doubleAreaVector(f).Norm() / 6 : 0;
	return sum / stage.mesh.area();
}

shapes::Soup fineBox(double x, double y, double z)
{
	shapes::Soup s = shapes::box(x, y, z);
	for (int i = 0; i < 4; ++i)
		s = shapes::subdivided(s);
	return s;
}

TEST(VertexKinds, ABodyIsVolume)
{
	for (const shapes::Soup& soup : {shapes::sphere(3), shapes::torus(), shapes::capsule()})
		EXPECT_EQ(share(vertexKinds(checks::plainStage(soup.mesh())), VertexKind::Volume), 1);
}

TEST(VertexKinds, AClosedTubeIsACurve)
{
	EXPECT_EQ(share(vertexKinds(checks::plainStage(shapes::torus(1, 0.001, 600, 4).mesh())),
				  VertexKind::Curve),
		1);
	EXPECT_GT(
		areaShare(checks::plainStage(fineBox(1, 1e-3, 1e-3).mesh()), VertexKind::Curve), 0.99);
}

TEST(VertexKinds, AThinPlateIsASheet)
{
	EXPECT_GT(areaShare(checks::plainStage(fineBox(1, 0.7, 1e-3).mesh()), VertexKind::Sheet), 0.99);
}

TEST(VertexKinds, APlateThatIsThickForEpsilonIsVolume)
{
	Stage stage = checks::plainStage(fineBox(1, 0.7, 0.02).mesh());
	EXPECT_GT(areaShare(stage, VertexKind::Volume), 0.95);
	stage.epsilon = 0.02;
	EXPECT_GT(areaShare(stage, VertexKind::Sheet), 0.95);
}

TEST(VertexKinds, AnEpsilonFarBelowTheEdgesTakesNeitherHoursNorAllMemory)
{
	Stage stage = checks::plainStage(shapes::sphere(2).mesh());
	for (const double epsilon : {1e-15, 1e-108}) { // the latter is beyond single precision
		stage.epsilon = epsilon;
		EXPECT_EQ(share(vertexKinds(stage), VertexKind::Volume), 1) << epsilon;
	}
}

TEST(VertexKinds, TheSameAtAnySizeAndForEachBodyAsAlone)
{
	const shapes::Soup plate = fineBox(1, 0.7, 1e-3), body = shapes::sphere(3);
	const std::vector<VertexKind> ofPlate = vertexKinds(checks::plainStage(plate.mesh())),
								  ofBody = vertexKinds(checks::plainStage(body.mesh()));
	std::vector<VertexKind> both = ofPlate;
	both.insert(both.end(), ofBody.begin(), ofBody.end());
	for (const double times : {1e-4, 1e-25, 1e25})
		EXPECT_EQ(vertexKinds(checks::plainStage(shapes::scaled(plate, times).mesh())), ofPlate)
			<< times;
	for (const double times : {1.5, 1e3, 1e6})
		EXPECT_EQ(vertexKinds(checks::plainStage(shapes::joined(
					  {plate, shapes::moved(shapes::scaled(body, times), {5 * times, 0, 0})})
													 .mesh())),
			both)
			<< times;
}

TEST(VertexKinds, AWallOfAnotherBodyIsNone)
{
	// Two boxes face each other across a gap of far less than epsilon.
	const shapes::Soup box = fineBox(1, 1, 1);
	const Stage stage =
		checks::plainStage(shapes::joined({box, shapes::moved(box, {1 + 1e-4, 0, 0})}).mesh());
	EXPECT_EQ(share(vertexKinds(stage), VertexKind::Volume), 1);
}

TEST(VertexKinds, TheSameInAnyNumbering)
{
	// Narrow enough at one end to be a curve there: its kinds differ, and some are told one by one.
	shapes::Soup wedge = fineBox(1, 0.012, 1e-3);
	for (vcg::Point3d& p : wedge.points)
		p[1] *= 0.55 + p[0];
	shapes::Soup turned = wedge;
	std::reverse(turned.points.begin(), turned.points.end());
	std::reverse(turned.triangles.begin(), turned.triangles.end());
	for (auto& t : turned.triangles)
		for (int& v : t)
			v = int(wedge.points.size()) - 1 - v;
	const std::vector<VertexKind> kinds = vertexKinds(checks::plainStage(wedge.mesh()));
	std::vector<VertexKind> ofTurned = vertexKinds(checks::plainStage(turned.mesh()));
	std::reverse(ofTurned.begin(), ofTurned.end());
	EXPECT_GT(share(kinds, VertexKind::Curve), 0.02);
	EXPECT_GT(share(kinds, VertexKind::Sheet), 0.3);
	EXPECT_EQ(ofTurned, kinds);
}

TEST(VertexKinds, WhatTheFlowHasFixedIsNoVolume)
{
	Stage stage = checks::plainStage(shapes::sphere(3).mesh());
	stage.fixed.assign(stage.fixed.size(), 1);
	EXPECT_EQ(share(vertexKinds(stage), VertexKind::Volume), 0);
	stage.held = stage.fixed;
	EXPECT_EQ(share(vertexKinds(stage), VertexKind::Volume), 1)
		<< "held by the user, not collapsed";
}

} // namespace
