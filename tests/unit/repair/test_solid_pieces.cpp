// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Which pieces of a surface get a skeleton.

#include "shapes.h"

#include <skeleton/repair/make_solid.h>

#include <gtest/gtest.h>

#include <string>

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
