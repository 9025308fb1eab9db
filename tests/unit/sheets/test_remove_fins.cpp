// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/sheets/remove_fins.h>
#include <skeleton/sheets/smooth_sheets.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// Where the sheets of these tests are thick.
constexpr double thickness = 1.5;

int addSheetNode(MesoSkeleton& skeleton, const Point3d& p)
{
	skeleton.position.push_back(p);
	skeleton.radius.push_back(thickness);
	skeleton.node.push_back(int(skeleton.node.size()));
	return skeleton.node.back();
}

void addFace(MesoSkeleton& skeleton, FaceOfComplex f)
{
	std::sort(f.begin(), f.end());
	skeleton.faces.push_back(f);
}

/// n by n unit squares in the plane z = 0, cut in two; node (x, y) is number x + (n + 1) y. One surface
/// vertex has merged into each node.
MesoSkeleton sheet(int n)
{
	MesoSkeleton skeleton;
	for (int y = 0; y <= n; ++y)
		for (int x = 0; x <= n; ++x)
			addSheetNode(skeleton, Point3d(x, y, 0));
	const auto at = [&](int x, int y) { return x + (n + 1) * y; };
	for (int y = 0; y < n; ++y)
		for (int x = 0; x < n; ++x) {
			addFace(skeleton, {at(x, y), at(x + 1, y), at(x + 1, y + 1)});
			addFace(skeleton, {at(x, y), at(x, y + 1), at(x + 1, y + 1)});
		}
	return skeleton;
}

size_t seams(const MesoSkeleton& skeleton)
{
	const detail::SheetFaces sheets(skeleton);
	return size_t(std::count_if(sheets.around.begin(), sheets.around.end(),
		[](const auto& entry) { return entry.second.size() > 2; }));
}

/// A wall of a given height that stands on the sheet's line y = 2, from x = 1 to x = 3.
MesoSkeleton sheetWithWall(double height)
{
	MesoSkeleton skeleton = sheet(4);
	const int foot = 2 * 5 + 1;
	std::vector<int> top;
	for (int x = 1; x <= 3; ++x)
		top.push_back(addSheetNode(skeleton, Point3d(x, 2, height)));
	for (int x = 0; x < 2; ++x) {
		addFace(skeleton, {foot + x, foot + x + 1, top[size_t(x)]});
		addFace(skeleton, {foot + x + 1, top[size_t(x)], top[size_t(x) + 1]});
	}
	return skeleton;
}

} // namespace

TEST(RemoveFins, AFaceThatStandsOnASheetGoes)
{
	const MesoSkeleton plain = sheet(4);
	MesoSkeleton skeleton = plain;
	const int tip = addSheetNode(skeleton, Point3d(1.2, 2, 1));
	addFace(skeleton, {11, 12, tip});
	ASSERT_EQ(seams(skeleton), 1u);
	removeFins(skeleton);
	EXPECT_EQ(skeleton.faces, plain.faces);
	EXPECT_EQ(skeleton.position, plain.position);
	EXPECT_EQ(skeleton.node.back(), 11) << "what merged into the tip goes to the nearer foot";
}

TEST(RemoveFins, AWallGoesIfItIsLowerThanTheThickness)
{
	MesoSkeleton low = sheetWithWall(0.9 * thickness), high = sheetWithWall(1.1 * thickness);
	const size_t faces = high.faces.size();
	removeFins(low);
	removeFins(high);
	EXPECT_EQ(seams(low), 0u);
	EXPECT_EQ(low.faces, sheet(4).faces);
	EXPECT_EQ(seams(high), 2u) << "sheets that meet";
	EXPECT_EQ(high.faces.size(), faces);
}

TEST(RemoveFins, WhatHoldsVerticesStaysInItsPlace)
{
	MesoSkeleton skeleton = sheet(4);
	const int fin = addSheetNode(skeleton, Point3d(1.2, 2, 1)),
			  whisker = addSheetNode(skeleton, {3, 3, 1});
	const int inside = 2 + 5, atWhisker = 3 + 5 * 3;
	addFace(skeleton, {11, 12, fin});
	skeleton.edges.push_back({atWhisker, whisker});
	MesoSkeleton held = skeleton;
	held.held.assign(held.position.size(), 0);
	for (int v : {inside, fin, whisker})
		held.held[size_t(v)] = 1;
	held.position[size_t(inside)][2] = skeleton.position[size_t(inside)][2] = 0.3;
	const MesoSkeleton given = held;
	for (MesoSkeleton* one : {&held, &skeleton}) {
		removeFins(*one);
		removeWhiskers(*one);
		smoothSheets(*one, 3);
	}
	EXPECT_EQ(skeleton.position.size(), 25u);
	EXPECT_LT(skeleton.position[size_t(inside)][2], 0.3);
	EXPECT_EQ(held.faces, given.faces);
	EXPECT_EQ(held.edges, given.edges);
	for (int v : {inside, fin, whisker})
		EXPECT_EQ(held.position[size_t(v)], given.position[size_t(v)]);
}

TEST(RemoveFins, AFinOnAFinGoesToo)
{
	MesoSkeleton skeleton = sheetWithWall(0.5);
	const int tip = addSheetNode(skeleton, Point3d(1.5, 1.5, 0.5)), inside = 4 * 4 * 2;
	const FaceOfComplex wall = skeleton.faces[size_t(inside) + 1];
	addFace(skeleton, {wall[0], wall[1], tip}); // on an edge between two faces of the wall
	ASSERT_EQ(seams(skeleton), 3u);
	removeFins(skeleton);
	EXPECT_EQ(seams(skeleton), 0u);
	EXPECT_EQ(skeleton.betti(), (BettiNumbers {1, 0, 0}));
	EXPECT_EQ(skeleton.position.size(), 25u);
}

TEST(RemoveFins, APatchThatClosesALoopOrHoldsACurveStays)
{
	// A roof over two squares, open at both ends: a tunnel.
	MesoSkeleton roof = sheet(4);
	const int a = addSheetNode(roof, Point3d(1, 2, 0.5)),
			  b = addSheetNode(roof, Point3d(2, 2, 0.5));
	const int front = 5 + 1, back = 3 * 5 + 1;
	for (int foot : {front, back}) {
		addFace(roof, {foot, foot + 1, a});
		addFace(roof, {foot + 1, a, b});
	}
	ASSERT_EQ(roof.betti(), (BettiNumbers {1, 1, 0}));
	MesoSkeleton before = roof;
	removeFins(roof);
	EXPECT_EQ(roof.faces, before.faces);

	MesoSkeleton withCurve = sheet(4);
	const int tip = addSheetNode(withCurve, Point3d(1, 2, 1));
	const int end = addSheetNode(withCurve, Point3d(1, 2, 9));
	addFace(withCurve, {11, 12, tip});
	withCurve.edges.push_back({tip, end});
	before = withCurve;
	removeFins(withCurve);
	EXPECT_EQ(withCurve.faces, before.faces);
	EXPECT_EQ(withCurve.edges, before.edges);
}

TEST(OpenFolds, OneFaceGoesWhereTheRimLiesOnTheSheet)
{
	// Beyond the rim, y = 0, the sheet goes on to both sides of (1, 0) - (2, 0), and overlaps there.
	MesoSkeleton skeleton = sheet(4);
	const int u = addSheetNode(skeleton, Point3d(1.2, -1, 0.1));
	const int w = addSheetNode(skeleton, Point3d(1.8, -0.9, -0.1));
	addFace(skeleton, {0, 1, u});
	addFace(skeleton, {1, 2, u});
	addFace(skeleton, {1, 2, w});
	addFace(skeleton, {2, 3, w});
	const BettiNumbers betti = skeleton.betti();
	const size_t faces = skeleton.faces.size();
	ASSERT_EQ(seams(skeleton), 1u);
	openFolds(skeleton);
	EXPECT_EQ(seams(skeleton), 0u);
	EXPECT_EQ(skeleton.faces.size() + 1, faces);
	EXPECT_FALSE(std::count(skeleton.faces.begin(), skeleton.faces.end(), FaceOfComplex {1, 2, w}))
		<< "the smaller one of the two";
	EXPECT_EQ(skeleton.betti(), betti);
}

TEST(RemoveFins, TwoThatMeetInANodeKeepTheLoopBetweenThem)
{
	// Faces on the sheet with a tip in common.
	MesoSkeleton skeleton = sheet(4);
	const int tip = addSheetNode(skeleton, Point3d(2, 2.5, 0.3));
	addFace(skeleton, {11, 12, tip});
	addFace(skeleton, {17, 18, tip});
	const BettiNumbers betti = skeleton.betti();
	removeFins(skeleton);
	EXPECT_EQ(skeleton.betti(), betti);

	// Walls of two faces, with a node of the rim in common that nothing else has.
	MesoSkeleton walls = sheet(4);
	const int shared = addSheetNode(walls, Point3d(2, 2.5, 0.4));
	const int left = addSheetNode(walls, Point3d(1.5, 2, 0.4)),
			  right = addSheetNode(walls, Point3d(1.5, 3, 0.4));
	addFace(walls, {11, 12, left});
	addFace(walls, {12, left, shared});
	addFace(walls, {16, 17, right});
	addFace(walls, {17, right, shared});
	const BettiNumbers before = walls.betti();
	removeFins(walls);
	EXPECT_EQ(walls.betti(), before);
}

TEST(OpenFolds, OfTwoThatShareAnEdgeOneIsLeft)
{
	// Faces a b c and b c d, with seams of three faces a b and c d, and rims a c and b d.
	MesoSkeleton skeleton;
	const int a = addSheetNode(skeleton, Point3d(0, 0, 0)),
			  b = addSheetNode(skeleton, Point3d(1, 0, 0));
	const int c = addSheetNode(skeleton, Point3d(0, 1, 0)),
			  d = addSheetNode(skeleton, Point3d(1, 1, 0));
	addFace(skeleton, {a, b, c});
	addFace(skeleton, {b, c, d});
	for (double z : {-1.0, 1.0}) {
		addFace(skeleton, {a, b, addSheetNode(skeleton, Point3d(0.5, -1, z))});
		addFace(skeleton, {c, d, addSheetNode(skeleton, Point3d(0.5, 2, z))});
	}
	const BettiNumbers betti = skeleton.betti();
	ASSERT_EQ(seams(skeleton), 2u);
	openFolds(skeleton);
	EXPECT_EQ(skeleton.betti(), betti);
	EXPECT_EQ(seams(skeleton), 1u);
}

TEST(OpenFolds, SheetsThatMeetAlongALineStay)
{
	MesoSkeleton skeleton = sheetWithWall(3);
	const std::vector<FaceOfComplex> faces = skeleton.faces;
	openFolds(skeleton);
	EXPECT_EQ(skeleton.faces, faces);
}
