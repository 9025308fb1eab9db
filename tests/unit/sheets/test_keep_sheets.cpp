// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/held_vertices.h>
#include <skeleton/sheets/keep_sheets.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A stage as the flow leaves it, of a given shape: nothing has a pole.
std::vector<char> all(const Stage& stage)
{
	return std::vector<char>(size_t(stage.mesh.vertexSlots()), 1);
}

shapes::Soup fine(shapes::Soup soup, int levels)
{
	for (int i = 0; i < levels; ++i)
		soup = shapes::subdivided(soup);
	return soup;
}

shapes::Soup flattened(const shapes::Soup& soup, double height)
{
	return shapes::transformed(
		soup, [&](const Point3d& p) { return Point3d(p[0], p[1], p[2] * height); });
}

/// The most faces that an edge has.
int maxFacesOnAnEdge(const MesoSkeleton& skeleton)
{
	std::map<EdgeOfComplex, int> count;
	int maximum = 0;
	for (const FaceOfComplex& f : skeleton.faces)
		for (const EdgeOfComplex& e : edgesOf(f))
			maximum = std::max(maximum, ++count[e]);
	return maximum;
}

/// Empty if the arrays of a skeleton fit together.
std::string error(const MesoSkeleton& skeleton)
{
	const int n = int(skeleton.position.size());
	if (int(skeleton.radius.size()) != n)
		return "an array of a wrong size";
	for (double r : skeleton.radius)
		if (!(r >= 0 && std::isfinite(r)))
			return "a node without a radius";
	for (const FaceOfComplex& f : skeleton.faces)
		if (!(0 <= f[0] && f[0] < f[1] && f[1] < f[2] && f[2] < n))
			return "a face whose nodes are not in order";
	for (const EdgeOfComplex& e : skeleton.edges)
		if (!(0 <= e[0] && e[0] < e[1] && e[1] < n))
			return "an edge whose nodes are not in order";
	for (int v : skeleton.node)
		if (v < 0 || v >= n)
			return "a surface vertex without a node";
	return "";
}

TEST(KeepSheets, TwoWallsBecomeOneRectangle)
{
	const double thickness = 1e-3;
	const Stage stage = checks::plainStage(fine(shapes::box(1, 0.7, thickness), 5).mesh());
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.005);
	const MesoSkeleton& skeleton = result.skeleton;
	EXPECT_EQ(error(skeleton), "");
	EXPECT_EQ(result.sheets, 1);
	EXPECT_EQ(result.givenUp, 0);
	EXPECT_EQ(skeleton.betti(), (BettiNumbers {1, 0, 0}));
	EXPECT_TRUE(skeleton.edges.empty());
	EXPECT_EQ(maxFacesOnAnEdge(skeleton), 2);
	EXPECT_NEAR(skeleton.sheetArea(), 0.7, 0.05) << "once, not twice";
	for (const Point3d& p : skeleton.position)
		EXPECT_NEAR(p[2], thickness / 2, thickness / 2);
}

TEST(KeepSheets, HeldVerticesOfASheetStayExactlyWhereTheyAre)
{
	const double thickness = 0.02; // as thick as the sites are apart
	Stage stage = checks::plainStage(fine(shapes::box(1, 0.7, thickness), 5).mesh());
	std::vector<char> held(stage.held.size(), 0);
	std::vector<int> chosen; // in the middle of a large face, in its corner, and at its edge
	for (const Point3d& p :
		{Point3d(0.41, 0.33, 0), Point3d(1, 0.7, thickness), Point3d(0.5, 0, 0)}) {
		int nearest = 0;
		for (int v = 1; v < stage.mesh.vertexSlots(); ++v)
			if (Distance(stage.mesh.position[v], p) < Distance(stage.mesh.position[nearest], p))
				nearest = v;
		chosen.push_back(nearest);
		held[size_t(nearest)] = 1;
	}
	holdVertices(stage, held);
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.005);
	const MesoSkeleton& skeleton = result.skeleton;
	EXPECT_EQ(error(skeleton), "");
	EXPECT_EQ(result.givenUp, 0);
	EXPECT_EQ(skeleton.betti(), (BettiNumbers {1, 0, 0}));
	EXPECT_NEAR(skeleton.sheetArea(), 0.7, 0.05);
	for (int v : chosen)
		EXPECT_EQ(skeleton.position[size_t(skeleton.node[size_t(v)])], stage.mesh.position[v]);
}

TEST(KeepSheets, HolesOfASheetAreLoops)
{
	const Stage stage = checks::plainStage(flattened(fine(shapes::plate(2, 4), 1), 0.002).mesh());
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.004);
	EXPECT_EQ(result.givenUp, 0);
	EXPECT_EQ(result.skeleton.betti(), (BettiNumbers {1, 2, 0}));
	EXPECT_EQ(maxFacesOnAnEdge(result.skeleton), 2);
}

TEST(KeepSheets, WhatIsNoSheetBecomesACurve)
{
	const Stage stage = checks::plainStage(fine(shapes::box(1, 0.3, 1e-3), 5).mesh());
	std::vector<char> right(stage.held.size());
	for (size_t v = 0; v < right.size(); ++v)
		right[v] = stage.mesh.position[v][0] > 0.5;
	const SheetCollapse result = collapseKeepingSheets(stage, right, 0.005);
	const MesoSkeleton& skeleton = result.skeleton;
	EXPECT_EQ(error(skeleton), "");
	EXPECT_EQ(result.givenUp, 0);
	EXPECT_EQ(skeleton.betti(), (BettiNumbers {1, 0, 0}));
	EXPECT_NEAR(skeleton.sheetArea(), 0.15, 0.03);
	for (const FaceOfComplex& f : skeleton.faces)
		for (int v : f)
			EXPECT_GT(skeleton.position[v][0], 0.45);
}

TEST(KeepSheets, WithoutSheetsItIsTheCurveSkeleton)
{
	const Stage stage = checks::plainStage(shapes::torus(1, 0.3, 24, 10).mesh());
	const SheetCollapse result =
		collapseKeepingSheets(stage, std::vector<char>(stage.held.size(), 0), 0.002);
	const CurveSkeleton curve = collapseToCurve(stage, 0.002);
	EXPECT_EQ(result.sheets, 0);
	EXPECT_EQ(result.skeleton.position, curve.position);
	EXPECT_EQ(result.skeleton.edges, curve.edges);
	EXPECT_EQ(result.skeleton.node, curve.node);
	EXPECT_EQ(result.skeleton.radius, curve.radius);
	EXPECT_TRUE(result.skeleton.faces.empty());
}

TEST(KeepSheets, WallsFarApartOfARingAreGivenUp)
{
	// Marked as a sheet though it is none: its surface has two loops, and the ring one.
	const Stage stage = checks::plainStage(shapes::torus(1, 0.3, 120, 40).mesh());
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.005);
	EXPECT_EQ(result.sheets, 1);
	EXPECT_EQ(result.givenUp, 1);
	EXPECT_EQ(error(result.skeleton), "");
	EXPECT_EQ(result.skeleton.betti(), (BettiNumbers {1, 1, 0}));
	// It is a curve, and the same as if no sheet had been asked for.
	EXPECT_TRUE(result.skeleton.faces.empty());
	EXPECT_EQ(result.skeleton.position, collapseToCurve(stage, 0.005).position);
}

TEST(KeepSheets, WallsFarApartOfABallKeepTheTopology)
{
	const Stage stage = checks::plainStage(shapes::sphere(4).mesh());
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.005);
	EXPECT_EQ(error(result.skeleton), "");
	EXPECT_EQ(result.skeleton.betti(), (BettiNumbers {1, 0, 0}));
}

TEST(KeepSheets, ABadSheetDoesNotSpoilAGoodOne)
{
	const Stage stage = checks::plainStage(
		shapes::joined({fine(shapes::box(1, 0.7, 1e-3), 4),
						   shapes::moved(shapes::torus(1, 0.3, 120, 40), {5, 0, 0})})
			.mesh());
	const SheetCollapse result = collapseKeepingSheets(stage, all(stage), 0.005);
	EXPECT_EQ(result.sheets, 2);
	EXPECT_EQ(result.givenUp, 1);
	EXPECT_EQ(result.skeleton.betti(), (BettiNumbers {2, 1, 0}));
	EXPECT_NEAR(result.skeleton.sheetArea(), 0.7, 0.1);
	for (const FaceOfComplex& f : result.skeleton.faces)
		for (int v : f)
			EXPECT_LT(result.skeleton.position[size_t(v)][0], 2) << "the ring has no sheet";
}

TEST(KeepSheets, EachComponentHasTheSheetsThatItHasAlone)
{
	// A plate, a small one with two holes, and a ball, which is no sheet.
	const std::vector<shapes::Soup> bodies = {fine(shapes::box(1, 0.7, 0.01), 5),
		shapes::moved(
			shapes::scaled(flattened(fine(shapes::plate(2, 2), 2), 0.02), 0.01), Point3d(3, 0, 0)),
		shapes::moved(shapes::sphere(2), Point3d(0, 5, 0))};
	std::vector<SheetCollapse> alone;
	for (const shapes::Soup& body : bodies) {
		const Stage stage = checks::plainStage(body.mesh());
		alone.push_back(collapseKeepingSheets(stage, all(stage), 0.005));
	}
	ASSERT_EQ(alone[0].givenUp, 0);
	ASSERT_EQ(alone[1].givenUp, 0);
	for (const std::array<size_t, 3>& order : {std::array<size_t, 3> {0, 1, 2},
			 std::array<size_t, 3> {2, 1, 0}, std::array<size_t, 3> {1, 0, 2}}) {
		const Stage stage = checks::plainStage(
			shapes::joined({bodies[order[0]], bodies[order[1]], bodies[order[2]]}).mesh());
		const SheetCollapse together = collapseKeepingSheets(stage, all(stage), 0.005);
		EXPECT_EQ(error(together.skeleton), "");
		EXPECT_EQ(together.sheets, 3);
		EXPECT_EQ(together.givenUp, alone[2].givenUp);
		MesoSkeleton expected;
		for (size_t i : order) {
			const MesoSkeleton& one = alone[i].skeleton;
			const int first = int(expected.position.size());
			expected.position.insert(
				expected.position.end(), one.position.begin(), one.position.end());
			for (const FaceOfComplex& f : one.faces)
				expected.faces.push_back({first + f[0], first + f[1], first + f[2]});
			for (const EdgeOfComplex& e : one.edges)
				expected.edges.push_back({first + e[0], first + e[1]});
			for (int v : one.node)
				expected.node.push_back(first + v);
		}
		EXPECT_EQ(together.skeleton.faces, expected.faces);
		EXPECT_EQ(together.skeleton.edges, expected.edges);
		EXPECT_EQ(together.skeleton.node, expected.node);
		ASSERT_EQ(together.skeleton.position.size(), expected.position.size());
		for (size_t v = 0; v < expected.position.size(); ++v)
			EXPECT_EQ(together.skeleton.position[v], expected.position[v]);
	}
}

TEST(KeepSheets, TheSameBitsTwiceAndTheSameShapeAtAnySize)
{
	const shapes::Soup soup = fine(shapes::box(1, 0.7, 1e-3), 4);
	const Stage stage = checks::plainStage(soup.mesh()),
				large = checks::plainStage(shapes::scaled(soup, 1024).mesh());
	const MesoSkeleton a = collapseKeepingSheets(stage, all(stage), 0.005).skeleton,
					   b = collapseKeepingSheets(stage, all(stage), 0.005).skeleton,
					   c = collapseKeepingSheets(large, all(large), 0.005).skeleton;
	EXPECT_EQ(a.position, b.position);
	EXPECT_EQ(a.faces, b.faces);
	EXPECT_EQ(a.faces, c.faces);
	EXPECT_NEAR(c.sheetArea() / a.sheetArea(), 1024.0 * 1024, 1e-3);
}

TEST(KeepSheets, NeighbouringFacesAreTurnedAlike)
{
	const Stage stage = checks::plainStage(fine(shapes::box(1, 0.7, 1e-3), 4).mesh());
	const MesoSkeleton skeleton = collapseKeepingSheets(stage, all(stage), 0.005).skeleton;
	double up = 0, total = 0;
	for (const auto& [a, b, c] : orientedFaces(skeleton)) {
		const Point3d normal = (skeleton.position[b] - skeleton.position[a])
			^ (skeleton.position[c] - skeleton.position[a]);
		up += normal[2];
		total += normal.Norm();
	}
	EXPECT_GT(std::abs(up), 0.99 * total);
}

TEST(SheetVertices, SmallPartsAreLeftOut)
{
	Stage stage = checks::plainStage(fine(shapes::box(1, 0.7, 1e-3), 4).mesh());
	EXPECT_GT(std::count(stage.sheet.begin(), stage.sheet.end(), 0), 0);
	for (size_t v = 0; v < stage.sheet.size(); ++v) {
		const Point3d& p = stage.mesh.position[v];
		stage.sheet[v] = p[0] > 0.5 || (p[0] < 0.05 && p[1] < 0.05);
	}
	const std::vector<char> sheet = sheetVertices(stage);
	for (size_t v = 0; v < sheet.size(); ++v)
		EXPECT_EQ(sheet[v], stage.mesh.position[v][0] > 0.5);
}

} // namespace
