// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/measured_surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

TEST(MeasuredSurface, KnowsEachComponentByItself)
{
	const SurfaceMesh mesh = shapes::joined(
		{shapes::box(1, 2, 3), shapes::moved(shapes::box(4, 4, 2), Point3d(10, 0, 0))})
								 .mesh();
	const MeasuredSurface surface(mesh);
	ASSERT_EQ(surface.components(), 2);
	EXPECT_EQ(&surface.mesh(), &mesh);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_EQ(surface.component()[v], mesh.position[v][0] > 5);
	EXPECT_NEAR(surface.area(0), 22, 1e-12);
	EXPECT_NEAR(surface.area(1), 64, 1e-12);
	EXPECT_NEAR(surface.diagonal(0), std::sqrt(14.0), 1e-12);
	EXPECT_NEAR(surface.diagonal(1), 6, 1e-12);
	EXPECT_EQ(surface.areas(), std::vector<double>({surface.area(0), surface.area(1)}));
	EXPECT_EQ(surface.diagonals(), std::vector<double>({surface.diagonal(0), surface.diagonal(1)}));
	// The middle of a box is the origin of its frame.
	EXPECT_NEAR(surface.frame(0).in(Point3d(0.5, 1, 1.5)).Norm(), 0, 1e-12);
	EXPECT_NEAR(surface.frame(1).in(Point3d(12, 2, 1)).Norm(), 0, 1e-12);
}

TEST(MeasuredSurface, SizesTurnWithTheShapeAndAreasDoNotHangOnTheTriangles)
{
	const auto turned = [](const Point3d& p) {
		return Point3d(0.6 * p[0] - 0.8 * p[1], 0.8 * p[0] + 0.6 * p[1], p[2]);
	};
	const shapes::Soup box = shapes::box(1, 2, 3);
	const SurfaceMesh other = shapes::transformed(shapes::subdivided(box), turned).mesh();
	const MeasuredSurface surface(other);
	EXPECT_NEAR(surface.diagonal(0), std::sqrt(14.0), 1e-12);
	EXPECT_NEAR(surface.area(0), 22, 1e-12);
}

TEST(MeasuredSurface, TheFramesOfItsVerticesAreComputedOnce)
{
	const SurfaceMesh mesh = shapes::joined(
		{shapes::box(1, 2, 3), shapes::moved(shapes::box(4, 4, 2), Point3d(10, 0, 0))})
								 .mesh();
	const MeasuredSurface surface(mesh);
	const std::vector<PrincipalFrame>& frames = *surface.vertexFrames();
	ASSERT_EQ(frames.size(), 2u);
	const std::vector<PrincipalFrame> expected =
		PrincipalFrame::ofPoints(mesh.position, surface.component(), 2);
	for (size_t c = 0; c < frames.size(); ++c)
		for (const Point3d& p : mesh.position)
			EXPECT_EQ(frames[c].in(p), expected[c].in(p));
	EXPECT_EQ(surface.vertexFrames().get(), &frames);
}
