// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/resample/progressive_coarsening.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vcg::tri::mcf;
using checks::structureError;
using vcg::Point3d;

TEST(Coarsen, LeavesASubsetOfTheVerticesAndTheTopology)
{
	for (const shapes::Soup& soup :
		{shapes::sphere(6), shapes::torus(1, 0.3, 240, 80), shapes::plate(3, 16)}) {
		const SurfaceMesh surface = soup.mesh();
		SurfaceMesh mesh = surface;
		const double length = 0.15;
		const std::vector<int> mergedInto = coarsen(mesh, [&](int) { return length; });
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.eulerCharacteristic(), surface.eulerCharacteristic());
		EXPECT_LT(mesh.vertexCount(), surface.vertexCount() / 4);
		EXPECT_EQ(mesh.position, surface.position);
		for (int v = 0; v < surface.vertexSlots(); ++v) {
			ASSERT_TRUE(mesh.isVertex(mergedInto[v]));
			ASSERT_EQ(mergedInto[v] == v, mesh.isVertex(v));
			ASSERT_LT(Distance(surface.position[v], surface.position[mergedInto[v]]), 6 * length);
		}
		int tooShort = 0;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isHalfEdge(h)) {
				const double relative = std::sqrt(mesh.squaredLength(h)) / length;
				EXPECT_LT(relative, 1.7);
				tooShort += relative < 0.5;
			}
		EXPECT_LT(tooShort, 0.01 * 2 * mesh.edgeCount());
		EXPECT_NEAR(mesh.area() / surface.area(), 1, 0.07);
	}
}

TEST(Coarsen, LeavesACoarseMeshAlone)
{
	SurfaceMesh mesh = shapes::sphere(3).mesh();
	const SurfaceMesh before = mesh;
	const std::vector<int> mergedInto = coarsen(mesh, [](int) { return 0.01; });
	EXPECT_EQ(mesh.triangles(), before.triangles());
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_EQ(mergedInto[v], v);
}

TEST(Coarsen, LengthsMayDifferFromPlaceToPlace)
{
	SurfaceMesh mesh = shapes::sphere(6).mesh();
	coarsen(mesh, [&](int v) { return mesh.position[v][2] > 0 ? 0.05 : 0.2; });
	int above = 0, below = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.isVertex(v))
			++(mesh.position[v][2] > 0 ? above : below);
	EXPECT_GT(above, 6 * below);
}

TEST(Coarsen, CanBeCancelled)
{
	SurfaceMesh mesh = shapes::sphere(6).mesh();
	int reports = 0;
	EXPECT_THROW(coarsen(
					 mesh, [](int) { return 0.2; },
					 Progress([&](int, const char*) { return ++reports < 4; })),
		Cancelled);
	EXPECT_EQ(structureError(mesh), "");
}
