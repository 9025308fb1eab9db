// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/degeneracy.h>

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

std::vector<int> allVertices(const Stage& stage)
{
	std::vector<int> all(stage.fixed.size());
	std::iota(all.begin(), all.end(), 0);
	return all;
}

int neighbourhoodEuler(const SurfaceMesh& mesh, int v, double radius)
{
	NeighbourhoodScratch scratch(mesh.vertexSlots());
	vcg::tri::mcf::detail::Ticker ticker(Progress(), "", 1);
	return vcg::tri::mcf::neighbourhoodEuler(mesh, v, radius, scratch, ticker);
}

int fixedCount(const Stage& stage)
{
	return int(std::count(stage.fixed.begin(), stage.fixed.end(), 1));
}

} // namespace

TEST(NeighbourhoodEuler, OfADiscIsOne)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	// Too small to hold a neighbour: a point; then discs of a ring and more, below the tube's width.
	for (double radius : {1e-6, 0.12, 0.2, 0.3})
		for (int v = 0; v < mesh.vertexCount(); v += 17)
			EXPECT_EQ(neighbourhoodEuler(mesh, v, radius), 1);
}

TEST(NeighbourhoodEuler, OfATubeIsZero)
{
	// Wider than the tube: a ring around it, with two borders.
	const SurfaceMesh mesh = shapes::torus(1, 0.05, 120, 8).mesh();
	for (int v = 0; v < mesh.vertexCount(); v += 13)
		EXPECT_EQ(neighbourhoodEuler(mesh, v, 0.3), 0);
}

TEST(NeighbourhoodEuler, OfAWholeBodyIsThatOfTheBody)
{
	for (const auto& [soup, euler] :
		{std::make_pair(shapes::tetrahedron(), 2), std::make_pair(shapes::sphere(2), 2),
			std::make_pair(shapes::torus(), 0), std::make_pair(shapes::plate(3), -4)})
		EXPECT_EQ(neighbourhoodEuler(soup.mesh(), 0, 1e3), euler);
}

TEST(NeighbourhoodEuler, StaysInItsOwnSheet)
{
	// Two sides of a thin plate are close in space and far along the surface.
	const SurfaceMesh mesh = shapes::transformed(shapes::plate(0, 6), [](const Point3d& p) {
		return Point3d(p[0], p[1], p[2] * 1e-3);
	}).mesh();
	int middle = -1;
	for (int v = 0; v < mesh.vertexCount(); ++v)
		if (vcg::Distance(mesh.position[v], Point3d(0.5, 1.5, 0)) < 1e-9)
			middle = v;
	ASSERT_GE(middle, 0);
	EXPECT_EQ(neighbourhoodEuler(mesh, middle, 0.4), 1);
}

TEST(FixDegenerateVertices, TakesTimeInProportionToTheNeighbourhoodsAndCanBeCancelled)
{
	// Each of the 3000 vertices sees all of the others.
	Stage stage = checks::plainStage(shapes::torus(1, 0.3, 60, 50).mesh());
	const double everything = 2;
	int asked = 0;
	EXPECT_EQ(fixDegenerateVertices(stage, allVertices(stage), everything,
				  Progress([&](int, const char*) { return ++asked > 0; })),
		3000);
	// Ticks, one in 32768 of which asks.
	EXPECT_NEAR(asked, 3000 * 3000 / 32768, 2);
	stage.fixed.assign(stage.fixed.size(), 0);
	asked = 0;
	EXPECT_THROW(fixDegenerateVertices(stage, allVertices(stage), everything,
					 Progress([&](int, const char*) { return ++asked < 3; })),
		Cancelled);
}

TEST(FixDegenerateVertices, FixesAThinTubeAndNotAThickOne)
{
	Stage thin = checks::plainStage(shapes::torus(1, 0.0005, 500, 5).mesh());
	EXPECT_EQ(
		fixDegenerateVertices(thin, allVertices(thin), 1e-4), 0); // each vertex sees itself only
	EXPECT_EQ(fixDegenerateVertices(thin, allVertices(thin), 0.002), thin.mesh.vertexCount());
	EXPECT_EQ(fixedCount(thin), thin.mesh.vertexCount());
	Stage thick = checks::plainStage(shapes::torus().mesh());
	EXPECT_EQ(fixDegenerateVertices(thick, allVertices(thick), 0.006), 0);
	EXPECT_EQ(fixedCount(thick), 0);
}

TEST(FixDegenerateVertices, FixesABodyOfTheSizeOfAPoint)
{
	for (const shapes::Soup& soup : {shapes::tetrahedron(), shapes::octahedron(), shapes::box()}) {
		Stage stage = checks::plainStage(soup.mesh());
		for (Point3d& p : stage.mesh.position)
			p *= 1e-4;
		EXPECT_EQ(
			fixDegenerateVertices(stage, allVertices(stage), 0.002), stage.mesh.vertexCount());
	}
}

TEST(FixDegenerateVertices, LooksAtCandidatesOnlyAndCountsNewOnes)
{
	Stage stage = checks::plainStage(shapes::torus(1, 0.0005, 500, 5).mesh());
	stage.fixed[3] = 1;
	EXPECT_EQ(fixDegenerateVertices(stage, {1, 3, 5}, 0.006), 2);
	EXPECT_TRUE(stage.fixed[1] && stage.fixed[3] && stage.fixed[5]);
	EXPECT_EQ(fixedCount(stage), 3);
}

TEST(FixDegenerateVertices, MeasuresByTheComponentsOwnDiagonal)
{
	// The same thin ring, small beside a large body, is as degenerate as alone.
	Stage stage = checks::plainStage(
		shapes::joined({shapes::scaled(shapes::sphere(2), 1000), shapes::torus(1, 0.0005, 500, 5)})
			.mesh());
	EXPECT_EQ(fixDegenerateVertices(stage, allVertices(stage), 0.006), 2500);
}
