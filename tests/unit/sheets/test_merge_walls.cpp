// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/sheets/merge_walls.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

BettiNumbers betti(const SiteComplex& complex, int vertices)
{
	return bettiNumbers(vertices, {complex.edges.begin(), complex.edges.end()},
		{complex.faces.begin(), complex.faces.end()});
}

SiteComplex complexOf(const std::vector<FaceOfComplex>& faces, int vertices)
{
	std::vector<int> identity(static_cast<size_t>(vertices));
	for (int v = 0; v < vertices; ++v)
		identity[size_t(v)] = v;
	return imageComplex({}, faces, identity);
}

TEST(SpreadSites, AreEvenAndEachPointHasTheNearest)
{
	std::vector<Point3d> points;
	for (int i = 0; i < 40; ++i)
		for (int j = 0; j < 30; ++j)
			for (double z : {0.0, 0.01})
				points.emplace_back(0.1 * i, 0.1 * j, z);
	const double spacing = 0.5;
	const Sites sites = spreadSites(points, spacing);
	ASSERT_EQ(sites.ofPoint.size(), points.size());
	EXPECT_LT(sites.position.size(), 120u);
	EXPECT_GT(sites.position.size(), 40u);
	for (size_t i = 0; i < points.size(); ++i) {
		const double distance = Distance(points[i], sites.position[size_t(sites.ofPoint[i])]);
		EXPECT_LT(distance, spacing);
		for (const Point3d& s : sites.position)
			EXPECT_LE(distance, Distance(points[i], s) + 1e-12);
	}
	// Both walls share their sites: these lie between them.
	for (const Point3d& s : sites.position)
		EXPECT_NEAR(s[2], 0.005, 0.004);
}

TEST(ImageComplex, FacesThatLoseAnEdgeBecomeEdges)
{
	const SiteComplex image = imageComplex({{0, 4}}, {{0, 1, 2}, {1, 2, 3}}, {0, 1, 1, 2, 2});
	EXPECT_TRUE(image.faces.empty());
	EXPECT_EQ(image.edges, (std::set<EdgeOfComplex> {{0, 1}, {1, 2}, {0, 2}}));
}

TEST(FillTriangles, ClosesLoopsOfThreeOnly)
{
	SiteComplex ring = imageComplex(
		{{0, 1}, {1, 2}, {0, 2}, {2, 3}, {3, 4}, {4, 5}, {2, 5}}, {}, {0, 1, 2, 3, 4, 5});
	EXPECT_EQ(betti(ring, 6), (BettiNumbers {1, 2, 0}));
	fillTriangles(ring, {});
	EXPECT_EQ(ring.faces, (std::set<FaceOfComplex> {{0, 1, 2}}));
	EXPECT_EQ(betti(ring, 6), (BettiNumbers {1, 1, 0})) << "a loop of four is a loop";
	SiteComplex curves = imageComplex({{0, 1}, {1, 2}, {0, 2}}, {}, {0, 1, 2});
	fillTriangles(curves, curves.edges);
	EXPECT_TRUE(curves.faces.empty()) << "a loop of curves is a loop";
}

TEST(OpenPockets, WallsThatChoseOtherDiagonalsBecomeOne)
{
	const std::vector<Point3d> corners = {{0, 0, 0}, {1.2, 0, 0}, {1.1, 1, 0}, {0, 1, 0}};
	SiteComplex complex = complexOf({{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}, 4);
	EXPECT_EQ(betti(complex, 4), (BettiNumbers {1, 0, 1}));
	openPockets(complex, corners, 2);
	EXPECT_EQ(betti(complex, 4), (BettiNumbers {1, 0, 0}));
	EXPECT_EQ(complex.faces.size(), 2u);
	EXPECT_EQ(complex.edges.size(), 5u);
}

TEST(OpenPockets, AFanOverASheetGoesAndTheSheetStays)
{
	// A fine sheet of 6 x 6 squares, and four large faces over it from its corners to a point above.
	const int n = 7, top = n * n;
	std::vector<Point3d> position;
	std::vector<FaceOfComplex> faces;
	for (int i = 0; i < n; ++i)
		for (int j = 0; j < n; ++j)
			position.emplace_back(i, j, 0);
	position.emplace_back(3, 3, 1);
	for (int i = 0; i + 1 < n; ++i)
		for (int j = 0; j + 1 < n; ++j) {
			const int a = i * n + j;
			faces.push_back({a, a + 1, a + n});
			faces.push_back({a + 1, a + n, a + n + 1});
		}
	const size_t sheet = faces.size();
	// The fan: every second vertex of the rim, so that it closes, and the triangles between.
	std::vector<int> rim;
	for (int j = 0; j + 1 < n; ++j)
		rim.push_back(j);
	for (int i = 0; i + 1 < n; ++i)
		rim.push_back(i * n + n - 1);
	for (int j = n - 1; j > 0; --j)
		rim.push_back((n - 1) * n + j);
	for (int i = n - 1; i > 0; --i)
		rim.push_back(i * n);
	for (size_t k = 0; k < rim.size(); ++k) {
		FaceOfComplex f = {rim[k], rim[(k + 1) % rim.size()], top};
		std::sort(f.begin(), f.end());
		faces.push_back(f);
	}
	SiteComplex complex = complexOf(faces, top + 1);
	ASSERT_EQ(betti(complex, top + 1), (BettiNumbers {1, 0, 1}));
	openPockets(complex, position, 2);
	EXPECT_EQ(betti(complex, top + 1), (BettiNumbers {1, 0, 0}));
	for (size_t f = 0; f < sheet; ++f)
		EXPECT_TRUE(complex.faces.count(faces[f])) << f;
}

TEST(OpenPockets, WhatHasNoPocketStays)
{
	SiteComplex book = complexOf({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, 5);
	const SiteComplex before = book;
	openPockets(book, std::vector<Point3d>(5, Point3d(0, 0, 0)), 1);
	EXPECT_EQ(book.faces, before.faces);
	EXPECT_EQ(book.edges, before.edges);
}

} // namespace
