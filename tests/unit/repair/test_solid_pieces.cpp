// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Which pieces of a surface get a skeleton.

#include "shapes.h"

#include <skeleton/repair/make_solid.h>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

using namespace vcg::tri::mcf;

namespace {

const SolidChoices withoutCavities(Repair::Auto, 0, true);

int piecesOf(const SolidSurface& made)
{
	int components = 0;
	connectedComponents(made.surface.mesh, &components);
	return components;
}

SolidSurface solid(const shapes::Soup& soup, const SolidChoices& choices)
{
	return solidSurface(soup.points, soup.triangles, choices);
}

shapes::Soup hollowBall()
{
	return shapes::joined({shapes::sphere(), shapes::insideOut(shapes::sphere(3, 0.5))});
}

TEST(SolidPieces, ACavityIsLeftOutAndSaid)
{
	for (const shapes::Soup& soup : {hollowBall(), shapes::insideOut(hollowBall())}) {
		const SolidSurface made = solid(soup, withoutCavities);
		EXPECT_EQ(made.report.leftOut.cavities, 1);
		ASSERT_EQ(piecesOf(made), 1);
		const int outer = made.surface.mesh.vertexCount();
		for (size_t v = 0; v < soup.points.size(); ++v) {
			const int own = made.surface.vertexOfInput[v];
			ASSERT_EQ(own >= 0, int(v) < outer);
			if (own >= 0) {
				EXPECT_TRUE(made.surface.mesh.position[size_t(own)] == soup.points[v]);
			}
		}
		EXPECT_NE(made.surface.notes.back().find("cavity"), std::string::npos);
	}
}

TEST(SolidPieces, ACavityOfAMendedBodyIsLeftOut)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::opened(shapes::sphere()), shapes::insideOut(shapes::sphere(3, 0.5))});
	const SolidSurface made = solid(soup, withoutCavities);
	EXPECT_EQ(made.report.outcome, SolidReport::Mended);
	EXPECT_EQ(made.report.leftOut.cavities, 1);
	EXPECT_EQ(piecesOf(made), 1);
}

/// The part of a line from a to b that is outside the solid.
double outside(const vcg::Point3d& a, const vcg::Point3d& b, const SolidSurface& made)
{
	CurveSkeleton line;
	line.position = {a, b};
	line.edges = {{0, 1}};
	line.radius = {0, 0};
	return partOutside(line, *made.report.leftOut.hollow);
}

TEST(SolidPieces, ACavityIsOutsideTheSolid)
{
	const SolidSurface made = solid(hollowBall(), withoutCavities);
	EXPECT_EQ(outside({0.6, 0, 0}, {0.9, 0, 0}, made), 0);
	EXPECT_EQ(outside({-0.4, 0, 0}, {0.4, 0, 0}, made), 1);
	EXPECT_NEAR(outside({0, 0, 0}, {0.95, 0, 0}, made), 0.5 / 0.95, 0.01);
}

TEST(SolidPieces, NestedShellsAreTwoSolidsWithACavityEach)
{
	const shapes::Soup soup =
		shapes::joined({shapes::sphere(), shapes::insideOut(shapes::sphere(3, 0.7)),
			shapes::sphere(3, 0.5), shapes::insideOut(shapes::sphere(3, 0.25))});
	const SolidSurface made = solid(soup, withoutCavities);
	EXPECT_EQ(made.report.leftOut.cavities, 2);
	EXPECT_EQ(piecesOf(made), 2);
	EXPECT_NE(made.surface.notes.back().find("2 pieces are turned"), std::string::npos);
	EXPECT_EQ(outside({0.75, 0, 0}, {0.95, 0, 0}, made), 0);
	EXPECT_EQ(outside({0.55, 0, 0}, {0.65, 0, 0}, made), 1);
	EXPECT_EQ(outside({0.3, 0, 0}, {0.45, 0, 0}, made), 0);
	EXPECT_EQ(outside({-0.2, 0, 0}, {0.2, 0, 0}, made), 1);
}

TEST(SolidPieces, ATorusMayHaveCavitiesOfEitherGenus)
{
	const shapes::Soup ringInside =
		shapes::joined({shapes::torus(1, 0.4), shapes::insideOut(shapes::torus(1, 0.2))});
	const shapes::Soup ballsInside = shapes::joined(
		{shapes::torus(1, 0.4), shapes::insideOut(shapes::moved(shapes::sphere(3, 0.2), {1, 0, 0})),
			shapes::insideOut(shapes::moved(shapes::sphere(3, 0.2), {-1, 0, 0}))});
	for (const auto& [soup, cavities] : {std::pair(ringInside, 1), std::pair(ballsInside, 2)}) {
		const SolidSurface made = solid(soup, withoutCavities);
		EXPECT_EQ(made.report.leftOut.cavities, cavities);
		EXPECT_EQ(piecesOf(made), 1);
		EXPECT_EQ(outside({0.95, 0, 0}, {1.05, 0, 0}, made), 1);
		EXPECT_EQ(outside({0.65, 0, 0}, {0.75, 0, 0}, made), 0);
	}
}

TEST(SolidPieces, ACavityThatStaysWithoutRepairIsSaid)
{
	const SolidSurface made = solid(hollowBall(), SolidChoices(Repair::Off, 0, true));
	EXPECT_EQ(made.report.leftOut.cavitiesKept, 1);
	EXPECT_FALSE(made.report.leftOut.any());
	ASSERT_TRUE(made.report.leftOut.hollow);
	EXPECT_NE(made.surface.notes.back().find("Without repair"), std::string::npos);
}

TEST(SolidPieces, ACavityOfWhatIsWrappedIsSaid)
{
	// Another ball runs into the shell, too deep for the surface to be left as it is.
	const shapes::Soup soup =
		shapes::joined({hollowBall(), shapes::moved(shapes::sphere(3, 0.6), {1.1, 0, 0})});
	const SolidSurface made = solid(soup, withoutCavities);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(made.report.leftOut.cavities, 1);
	EXPECT_NE(made.surface.notes.back().find("cavity"), std::string::npos);
}

TEST(SolidPieces, CavitiesAreTurnedInward)
{
	const shapes::Soup soup = hollowBall();
	const CheckedSurface checked = checkedSurface(soup.points, soup.triangles);
	int count = 0;
	const std::optional<SurfaceMesh> hollow =
		withCavitiesInward(checked.mesh, checked.turned, count);
	ASSERT_TRUE(hollow);
	EXPECT_EQ(count, 1);
	const double ball = shapes::sphere().mesh().volume();
	EXPECT_NEAR(hollow->volume(), ball * (1 - 0.125), 1e-6);
	const shapes::Soup full = shapes::joined({shapes::sphere(), shapes::sphere(3, 0.5)});
	const CheckedSurface bodies = checkedSurface(full.points, full.triangles);
	EXPECT_FALSE(withCavitiesInward(bodies.mesh, bodies.turned, count));
	EXPECT_EQ(count, 0);
}

TEST(SolidPieces, ManyAreLookedThroughOneByOneAndCanBeCancelled)
{
	// Blocks with a smaller one in each, every third of which is a cavity.
	constexpr int side = 10, blocks = side * side * side;
	shapes::Soup soup;
	const auto add = [&](const shapes::Soup& block) {
		const int first = int(soup.points.size());
		soup.points.insert(soup.points.end(), block.points.begin(), block.points.end());
		for (const Triangle& t : block.triangles)
			soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
	};
	for (int i = 0; i < blocks; ++i) {
		const vcg::Point3d at(i % side, i / side % side, i / side / side);
		add(shapes::moved(shapes::box(0.8, 0.8, 0.8), at));
		const shapes::Soup inner =
			shapes::moved(shapes::box(0.2, 0.2, 0.2), at + vcg::Point3d(0.3, 0.3, 0.3));
		add(i % 3 == 0 ? shapes::insideOut(inner) : inner);
	}
	const CheckedSurface checked = checkedSurface(soup.points, soup.triangles);
	int asked = 0, last = 1 << 30, cavities = 0;
	const Progress progress([&](int, const char*) { return ++asked < last; });
	EXPECT_TRUE(withCavitiesInward(checked.mesh, checked.turned, cavities, progress));
	EXPECT_EQ(cavities, (blocks + 2) / 3);
	EXPECT_GT(asked, 2 * blocks);
	asked = 0;
	last = blocks;
	EXPECT_THROW(withCavitiesInward(checked.mesh, checked.turned, cavities, progress), Cancelled);
}

TEST(SolidPieces, WhatIsInsideACavityIsABody)
{
	const shapes::Soup soup = shapes::joined({hollowBall(), shapes::sphere(2, 0.2)});
	EXPECT_EQ(piecesOf(solid(soup, withoutCavities)), 2);
}

TEST(SolidPieces, ABodyInsideABodyStays)
{
	const shapes::Soup soup = shapes::joined({shapes::sphere(), shapes::sphere(3, 0.5)});
	EXPECT_EQ(piecesOf(solid(soup, withoutCavities)), 2);
}

TEST(SolidPieces, AMirroredPartThatReachesOutIsNoCavity)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::sphere(), shapes::insideOut(shapes::moved(shapes::sphere(3, 0.5), {0.8, 0, 0}))});
	EXPECT_EQ(piecesOf(solid(soup, SolidChoices(Repair::Mend, 0, true))), 2);
}

TEST(SolidPieces, CavitiesStayWhereTheyAreAskedFor)
{
	EXPECT_EQ(piecesOf(solid(hollowBall(), Repair::Auto)), 2);
	EXPECT_EQ(piecesOf(solid(hollowBall(), SolidChoices(Repair::Off, 0, true))), 2);
}

TEST(SolidPieces, SmallOnesAreLeftOutBelowTheLeastVolume)
{
	// A thousandth of the volume.
	const shapes::Soup soup =
		shapes::joined({shapes::moved(shapes::sphere(3, 0.1), {3, 0, 0}), shapes::sphere()});
	EXPECT_EQ(piecesOf(solid(soup, SolidChoices(Repair::Auto, 0.0005))), 2);
	const SolidSurface made = solid(soup, SolidChoices(Repair::Auto, 0.002));
	EXPECT_EQ(piecesOf(made), 1);
	EXPECT_EQ(made.report.leftOut.small, 1);
	EXPECT_EQ(made.surface.vertexOfInput.front(), -1);
	EXPECT_NE(made.surface.notes.back().find("1 piece gets no skeleton"), std::string::npos);
}

} // namespace
