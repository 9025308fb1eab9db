// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/components.h>
#include <skeleton/repair/make_solid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// The faces of a soup whose centroid is below the plane through `on`.
shapes::Soup cutSoup(shapes::Soup soup, const Point3d& normal, const Point3d& on = Point3d(0, 0, 0))
{
	std::vector<Triangle> left;
	for (const Triangle& t : soup.triangles) {
		Point3d centroid(0, 0, 0);
		for (int v : t)
			centroid += soup.points[size_t(v)] / 3.0;
		if ((centroid - on) * normal < 0)
			left.push_back(t);
	}
	soup.triangles = left;
	return soup;
}

struct Capped
{
	MendedSurface surface;
	int pieces = 0, euler = 0;
	double volume = 0;
};

Capped capped(const shapes::Soup& soup)
{
	Capped result {mend(soup.points, soup.triangles)};
	const auto mesh =
		SurfaceMesh::ifClosedManifold(result.surface.points, result.surface.triangles);
	EXPECT_EQ(bool(mesh), result.surface.closed);
	if (!mesh)
		return result;
	connectedComponents(*mesh, &result.pieces);
	result.euler = mesh->vertexCount() - mesh->faceCount() / 2;
	for (const Triangle& t : result.surface.triangles)
		result.volume += result.surface.points[size_t(t[0])]
			* (result.surface.points[size_t(t[1])] ^ result.surface.points[size_t(t[2])]) / 6;
	return result;
}

TEST(CapCuts, ClosesHalfASphere)
{
	// A jagged rim, whichever way the plane lies to the edges; and of thousands of them.
	for (const Point3d& normal : {Point3d(0, 0, 1), Point3d(0.3, -0.5, 0.7)})
		for (int levels : {3, 5}) {
			const shapes::Soup soup = cutSoup(shapes::sphere(levels), normal);
			const Capped made = capped(soup);
			EXPECT_EQ(made.pieces, 1);
			EXPECT_EQ(made.euler, 2);
			EXPECT_EQ(made.surface.report.holesClosed, 1);
			EXPECT_NEAR(made.volume, 2 * M_PI / 3, levels == 3 ? 0.15 : 0.03);
			for (size_t v = 0; v < soup.points.size(); ++v)
				EXPECT_TRUE(made.surface.points[v] == soup.points[v]);
		}
}

TEST(CapCuts, AreTheSolidThatIsMeantAtAnySize)
{
	for (double size : {1e-6, 1e6}) {
		const shapes::Soup soup = shapes::scaled(cutSoup(shapes::sphere(4), {0, 0, 1}), size);
		const SolidSurface made = solidSurface(soup.points, soup.triangles);
		EXPECT_EQ(made.report.outcome, SolidReport::Mended);
		EXPECT_EQ(made.report.distanceMax, 0);
	}
}

TEST(CapCuts, ClosesHalfARingAtBothEnds)
{
	const Capped made = capped(cutSoup(shapes::torus(1, 0.3, 120, 300), {0, 1, 0}));
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
	EXPECT_EQ(made.surface.report.holesClosed, 2);
	EXPECT_NEAR(made.volume, M_PI * M_PI * 0.09, 0.03);
}

TEST(CapCuts, CloseAFlatBodyThatIsCutAlongItsMiddle)
{
	// The caps have almost half of the area, and corners that turn inward.
	const shapes::Soup star = shapes::transformed(shapes::sphere(5), [](const Point3d& p) {
		const double grown = 1 + 0.4 * std::cos(5 * std::atan2(p[1], p[0])) * (1 - p[2] * p[2]);
		return Point3d(p[0] * grown, p[1] * grown, 0.3 * p[2]);
	});
	const Capped made = capped(cutSoup(star, {0, 0, 1}));
	EXPECT_EQ(made.euler, 2);
	EXPECT_GT(made.volume, 0);
}

TEST(CapCuts, FollowABorderThatMeetsItselfInAVertex)
{
	// A face beside the rim is gone, too.
	shapes::Soup soup = cutSoup(shapes::sphere(5), {0, 0, 1});
	std::vector<int> faces(soup.points.size(), 0);
	for (const Triangle& t : soup.triangles)
		for (int v : t)
			++faces[size_t(v)];
	size_t gone = soup.triangles.size();
	for (size_t f = 0; f < soup.triangles.size(); ++f) {
		int rim = 0, full = 0;
		for (int v : soup.triangles[f]) {
			rim += faces[size_t(v)] == 4;
			full += faces[size_t(v)] == 6;
		}
		if (rim == 1 && full == 2)
			gone = f;
	}
	ASSERT_LT(gone, soup.triangles.size());
	soup.triangles.erase(soup.triangles.begin() + long(gone));
	const Capped made = capped(soup);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
}

TEST(CapCuts, LeavesASheet)
{
	shapes::Soup sheet;
	for (int i = 0; i <= 100; ++i)
		for (int j = 0; j <= 100; ++j)
			sheet.points.emplace_back(i, j, 0.5 * std::sin(0.3 * i) * std::sin(0.3 * j));
	for (int i = 0; i < 100; ++i)
		for (int j = 0; j < 100; ++j) {
			const int a = 101 * i + j;
			sheet.triangles.push_back({a, a + 101, a + 102});
			sheet.triangles.push_back({a, a + 102, a + 1});
		}
	EXPECT_FALSE(capped(sheet).surface.closed);
}

TEST(CapCuts, LeavesWhatIsOnBothSidesOfThePlane)
{
	// The lid of a box that a tongue reaches through.
	shapes::Soup soup = cutSoup(shapes::sphere(5), {0, 0, 1}, {0, 0, 0.5});
	soup = shapes::transformed(soup, [](const Point3d& p) {
		const double bottom = std::max(0.0, -0.9 - p[2]) / 0.1;
		return Point3d(p[0], p[1], p[2] + 3 * bottom);
	});
	EXPECT_FALSE(capped(soup).surface.closed);
}

TEST(CapCuts, LeavesTheCutOfAWall)
{
	// Two rims in one plane, one inside the other: two caps would lie upon each other.
	const shapes::Soup hollow = shapes::joined(
		{shapes::sphere(5), shapes::insideOut(shapes::scaled(shapes::sphere(5), 0.8))});
	const Capped made = capped(cutSoup(hollow, {0, 0, 1}));
	EXPECT_FALSE(made.surface.closed && made.volume > 1.5);
}

TEST(CapCuts, LooksAtTheOwnPieceAndTheBordersNearby)
{
	// So many pots that the square of their number would take most of a minute.
	constexpr int rows = 150;
	const shapes::Soup pot = cutSoup(shapes::box(), {0, 0, 1}, {0, 0, 0.9});
	shapes::Soup pots;
	for (int i = 0; i < rows * rows; ++i) {
		const int first = int(pots.points.size());
		for (const Point3d& p : pot.points)
			pots.points.push_back(p + Point3d(2 * (i % rows), 2 * (i / rows), 0));
		for (const Triangle& t : pot.triangles)
			pots.triangles.push_back({first + t[0], first + t[1], first + t[2]});
	}
	// In the opening of the first one there is the border of another piece.
	const int first = int(pots.points.size());
	for (const Point3d& p : {Point3d(0.4, 0.4, 1), Point3d(0.6, 0.4, 1), Point3d(0.5, 0.5, 0.5)})
		pots.points.push_back(p);
	pots.triangles.push_back({first, first + 1, first + 2});
	const size_t before = pots.triangles.size();
	const std::vector<int> partner =
		detail::pairedHalfEdges(pots.points, pots.triangles, nullptr, Progress());
	EXPECT_EQ(capCuts(pots.points, pots.triangles, partner), rows * rows - 1);
	EXPECT_EQ(pots.triangles.size(), before + 2 * (rows * rows - 1));
	for (size_t f = before; f < pots.triangles.size(); ++f)
		for (int v : pots.triangles[f]) {
			EXPECT_EQ(pots.points[size_t(v)][2], 1);
			EXPECT_GE(v, int(pot.points.size()));
		}
}

TEST(CapCuts, StopsWhenAsked)
{
	const shapes::Soup soup = cutSoup(shapes::sphere(5), {0, 0, 1});
	const std::vector<int> partner =
		detail::pairedHalfEdges(soup.points, soup.triangles, nullptr, Progress());
	std::vector<Triangle> triangles = soup.triangles;
	const Progress progress([](double, const char*) { return false; });
	EXPECT_THROW(capCuts(soup.points, triangles, partner, CutLimits(), progress), Cancelled);
}

} // namespace
