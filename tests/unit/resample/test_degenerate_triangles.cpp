// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/resample/degenerate_triangles.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vcg::tri::mcf;
using checks::structureError;
using vcg::Point3d;

namespace {

double minHeight(const SurfaceMesh& mesh)
{
	double minimum = 1e300;
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		if (!mesh.isFace(f))
			continue;
		double longest = 0;
		for (int h = 3 * f; h < 3 * f + 3; ++h)
			longest = std::max(longest, std::sqrt(mesh.squaredLength(h)));
		minimum = std::min(minimum, mesh.doubleAreaVector(f).Norm() / longest);
	}
	return minimum;
}

const auto one = [](int) { return 1.0; };

} // namespace

TEST(ThinTriangles, CapsAreFlippedAway)
{
	// A cap between each edge of some triangles and its halves on the other side.
	shapes::Soup soup = shapes::box();
	for (int f : {0, 5, 10}) {
		const Triangle t = soup.triangles[f];
		const int m = int(soup.points.size());
		for (int k = 0; k < 3; ++k)
			soup.points.push_back((soup.points[t[k]] + soup.points[t[(k + 1) % 3]]) / 2.0);
		soup.triangles[f] = {m, m + 1, m + 2};
		for (int k = 0; k < 3; ++k) {
			soup.triangles.push_back({t[k], m + k, m + (k + 2) % 3});
			soup.triangles.push_back({t[k], t[(k + 1) % 3], m + k});
		}
	}
	SurfaceMesh mesh = soup.mesh();
	ASSERT_EQ(minHeight(mesh), 0);
	const double volume = mesh.volume();
	EXPECT_EQ(removeThinTriangles(mesh, one), 0);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), 2);
	EXPECT_GT(minHeight(mesh), 1e-3);
	EXPECT_NEAR(mesh.volume(), volume, 1e-12);
}

TEST(ThinTriangles, NeedlesAreMerged)
{
	SurfaceMesh mesh = shapes::sphere(2).mesh();
	const double volume = mesh.volume();
	for (int h : {3, 30, 90})
		mesh.split(h, mesh.position[mesh.origin(h)] + Point3d(1e-9, 0, 0));
	ASSERT_LT(minHeight(mesh), 1e-8);
	const int before = mesh.vertexCount();
	EXPECT_EQ(removeThinTriangles(mesh, one), 0);
	EXPECT_EQ(mesh.vertexCount(), before - 3);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_NEAR(mesh.volume(), volume, 1e-7);
}

TEST(ThinTriangles, GoodMeshesAreLeftAlone)
{
	for (const shapes::Soup& soup : {shapes::torus(), shapes::scaled(shapes::torus(), 1e-6),
			 shapes::scaled(shapes::plate(1), 1e6)}) {
		SurfaceMesh mesh = soup.mesh();
		const double diagonal = mesh.bounds().Diag();
		EXPECT_EQ(removeThinTriangles(mesh, [&](int) { return 0.01 * diagonal; }), 0);
		EXPECT_EQ(mesh.triangles(), soup.triangles);
		EXPECT_EQ(mesh.position, soup.points);
	}
}
