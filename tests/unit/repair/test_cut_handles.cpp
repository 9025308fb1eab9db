// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/make_solid.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

int euler(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles)
{
	const auto mesh = SurfaceMesh::ifClosedManifold(points, triangles);
	return mesh ? mesh->vertexCount() - mesh->faceCount() / 2 : -1000;
}

double volumeIn(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles)
{
	double volume = 0;
	for (const Triangle& t : triangles)
		volume += points[size_t(t[0])] * (points[size_t(t[1])] ^ points[size_t(t[2])]) / 6;
	return volume;
}

/// The face whose middle is closest to a point.
int faceAt(const shapes::Soup& soup, const Point3d& place)
{
	int best = 0;
	const auto away = [&](int f) {
		const Triangle& t = soup.triangles[size_t(f)];
		return Distance(
			(soup.points[size_t(t[0])] + soup.points[size_t(t[1])] + soup.points[size_t(t[2])])
				/ 3.0,
			place);
	};
	for (int f = 1; f < int(soup.triangles.size()); ++f)
		if (away(f) < away(best))
			best = f;
	return best;
}

/// A fine sphere with a handle of six triangles at each of some places.
shapes::Soup withSmallHandles(const std::vector<Point3d>& places)
{
	shapes::Soup soup = shapes::sphere(7);
	for (const Point3d& place : places) {
		// A few edges of it apart.
		const Point3d other = place + Point3d(-place[1], place[0], place[2]) * 0.06;
		shapes::addTunnel(soup, faceAt(soup, place), faceAt(soup, other / other.Norm()));
	}
	return soup;
}

const std::vector<Point3d> threePlaces = {{0.6, 0.48, 0.64}, {-0.6, 0.8, 0}, {0.28, -0.96, 0}};

TEST(CutHandles, CutsWhatIsTooSmallToBeMeant)
{
	const shapes::Soup given = withSmallHandles(threePlaces);
	ASSERT_EQ(euler(given.points, given.triangles), 2 - 2 * 3);
	shapes::Soup soup = given;
	EXPECT_EQ(cutHandles(soup.points, soup.triangles), 3);
	EXPECT_EQ(euler(soup.points, soup.triangles), 2);
	EXPECT_NEAR(
		volumeIn(soup.points, soup.triangles), volumeIn(given.points, given.triangles), 1e-3);
	int moved = 0;
	for (size_t v = 0; v < given.points.size(); ++v)
		moved += soup.points[v] != given.points[v];
	EXPECT_LE(moved, 3 * 4);
}

TEST(CutHandles, TheSidesOfACutDoNotTouch)
{
	shapes::Soup soup = withSmallHandles({threePlaces[0]});
	const size_t before = soup.points.size();
	ASSERT_EQ(cutHandles(soup.points, soup.triangles), 1);
	for (size_t w = before; w < soup.points.size(); ++w)
		for (size_t v = 0; v < before; ++v)
			EXPECT_GT(Distance(soup.points[w], soup.points[v]), 1e-3);
}

TEST(CutHandles, LeavesThoseThatAreMeant)
{
	for (const shapes::Soup& given : {shapes::torus(), shapes::torus(1, 0.05, 60, 6),
			 shapes::torus(1, 0.3, 6, 3), shapes::csaszarTorus(), shapes::plate(3)}) {
		shapes::Soup soup = given;
		EXPECT_EQ(cutHandles(soup.points, soup.triangles), 0);
		EXPECT_TRUE(soup.points == given.points);
		EXPECT_TRUE(soup.triangles == given.triangles);
	}
}

TEST(CutHandles, LeavesATunnelThroughTheShape)
{
	shapes::Soup soup = shapes::sphere(6);
	shapes::addTunnel(soup, faceAt(soup, {0, 0.28, 0.96}), faceAt(soup, {0, 0.28, -0.96}));
	EXPECT_EQ(cutHandles(soup.points, soup.triangles), 0);
	EXPECT_EQ(euler(soup.points, soup.triangles), 0);
}

TEST(CutHandles, AreCutOfWhatIsMendedAndOfNothingElse)
{
	const shapes::Soup sound = withSmallHandles(threePlaces);
	const SolidSurface asItWas = solidSurface(sound.points, sound.triangles);
	EXPECT_EQ(asItWas.report.outcome, SolidReport::Sound);
	EXPECT_EQ(asItWas.report.handles, 0);
	EXPECT_EQ(asItWas.surface.mesh.vertexCount() - asItWas.surface.mesh.faceCount() / 2, 2 - 2 * 3);

	const shapes::Soup open = shapes::opened(sound);
	const SolidSurface mended = solidSurface(open.points, open.triangles);
	EXPECT_EQ(mended.report.outcome, SolidReport::Mended);
	EXPECT_EQ(mended.report.handles, 3);
	EXPECT_EQ(mended.surface.mesh.vertexCount() - mended.surface.mesh.faceCount() / 2, 2);
	EXPECT_NE(mended.report.text().find("3 small handles cut"), std::string::npos);
}

} // namespace
