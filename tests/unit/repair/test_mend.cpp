// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/components.h>
#include <skeleton/repair/mend.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

MendedSurface mendedOf(const shapes::Soup& soup)
{
	return mend(soup.points, soup.triangles);
}

detail::SoupEdges edgesOf(const shapes::Soup& soup)
{
	return detail::sortedSoupEdges(soup.points.size(), soup.triangles, Progress());
}

/// Closed, in so many pieces, with this Euler characteristic, and the vertices of the input to the last bit.
void expectMended(
	const MendedSurface& surface, const shapes::Soup& soup, int pieces = 1, int euler = 2)
{
	ASSERT_TRUE(surface.closed);
	const auto mesh = SurfaceMesh::ifClosedManifold(surface.points, surface.triangles);
	ASSERT_TRUE(mesh);
	int components = 0;
	connectedComponents(*mesh, &components);
	EXPECT_EQ(components, pieces);
	EXPECT_EQ(mesh->vertexCount() - mesh->faceCount() / 2, euler);
	for (size_t v = 0; v < soup.points.size(); ++v)
		EXPECT_TRUE(surface.points[v] == soup.points[v]);
}

double enclosedVolume(const MendedSurface& surface)
{
	double volume = 0;
	for (const Triangle& t : surface.triangles)
		volume += surface.points[size_t(t[0])]
			* (surface.points[size_t(t[1])] ^ surface.points[size_t(t[2])]) / 6;
	return volume;
}

TEST(Mend, LeavesASoundSurfaceAsItIs)
{
	const shapes::Soup soup = shapes::torus();
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup, 1, 0);
	EXPECT_FALSE(surface.report.isChanged());
	EXPECT_TRUE(surface.triangles == soup.triangles);
}

TEST(Mend, FillsAHoleOfOneTriangle)
{
	const shapes::Soup soup = shapes::opened(shapes::sphere(3));
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup);
	EXPECT_EQ(surface.report.holesClosed, 1);
	EXPECT_NEAR(enclosedVolume(surface), enclosedVolume(mendedOf(shapes::sphere(3))), 1e-12);
}

TEST(Mend, FillsTheHolesOfFacesMissingAtRandom)
{
	for (unsigned seed : {1u, 2u, 3u}) {
		shapes::Soup soup = shapes::torus(1, 0.3, 60, 24);
		std::mt19937 random(seed);
		soup.triangles.erase(std::remove_if(soup.triangles.begin(), soup.triangles.end(),
								 [&](const Triangle&) { return random() % 12 == 0; }),
			soup.triangles.end());
		const MendedSurface surface = mendedOf(soup);
		expectMended(surface, soup, 1, 0);
		EXPECT_GT(surface.report.holesClosed, 50);
		EXPECT_NEAR(enclosedVolume(surface),
			enclosedVolume(mendedOf(shapes::torus(1, 0.3, 60, 24))), 0.02 * 1.7);
	}
}

/// Two sides that meet at the leading edge, at the tip, and at some vertices of the trailing edge; the other end
/// and the gaps between these vertices are open. @param rise  by how much it bends upwards, times the squared length.
constexpr int wingPieces = 8;
constexpr double wingSpan = 8, wingSection = (0.1 + 0.08) / 4 + 0.08 / 4; // without its gap
shapes::Soup openWing(const std::function<bool(int)>& meetAt, double gap, double rise)
{
	constexpr int pieces = wingPieces, across = 2;
	constexpr double span = wingSpan, chord = 1, shorter = 0.03;
	const double thickness[] = {0.1, 0.08, gap};
	shapes::Soup wing;
	int number[2][pieces + 1][across + 1];
	for (int side = 0; side < 2; ++side)
		for (int i = 0; i <= pieces; ++i)
			for (int k = 0; k <= across; ++k) {
				const bool isShared = k == across && meetAt(i);
				if (side == 1 && isShared) {
					number[1][i][k] = number[0][i][k];
					continue;
				}
				number[side][i][k] = int(wing.points.size());
				// The lower side ends a little before the upper one.
				const double back = side == 1 && k == across ? shorter : 0;
				wing.points.emplace_back(span * i / pieces, chord * k / across - back,
					(isShared ? 0 : (side ? -1 : 1) * thickness[k] / 2) + rise * i * i);
			}
	const auto quad = [&](int a, int b, int c, int d) {
		for (const Triangle& t : {Triangle {a, b, c}, Triangle {a, c, d}})
			if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
				wing.triangles.push_back(t);
	};
	const auto &up = number[0], &down = number[1];
	for (int i = 0; i < pieces; ++i) {
		for (int k = 0; k < across; ++k) {
			quad(up[i][k], up[i + 1][k], up[i + 1][k + 1], up[i][k + 1]);
			quad(down[i][k], down[i][k + 1], down[i + 1][k + 1], down[i + 1][k]);
		}
		quad(down[i][0], down[i + 1][0], up[i + 1][0], up[i][0]);
	}
	for (int k = 0; k < across; ++k)
		quad(up[pieces][k], down[pieces][k], down[pieces][k + 1], up[pieces][k + 1]);
	return wing;
}

TEST(Mend, TrianglesThatAreMissingAtTheInnerCornersOfAFrameAreHolesOfTheirOwn)
{
	// Around such a corner there are more than 360 degrees: seen from outside, the fans that are left
	// overlap.
	const shapes::Soup frame = shapes::torus(1, 0.2, 3, 4);
	const double volume = frame.mesh().volume();
	for (size_t v = 0; v < frame.points.size(); ++v) {
		std::vector<size_t> around;
		for (size_t f = 0; f < frame.triangles.size(); ++f)
			if (std::count(frame.triangles[f].begin(), frame.triangles[f].end(), int(v)))
				around.push_back(f);
		for (size_t f : around)
			for (size_t g : around) {
				std::set<int> both(frame.triangles[f].begin(), frame.triangles[f].end());
				both.insert(frame.triangles[g].begin(), frame.triangles[g].end());
				if (!(f < g) || both.size() != 5)
					continue;
				shapes::Soup open = frame;
				open.triangles.erase(open.triangles.begin() + std::ptrdiff_t(g));
				open.triangles.erase(open.triangles.begin() + std::ptrdiff_t(f));
				const MendedSurface surface = mendedOf(open);
				expectMended(surface, open, 1, 0);
				EXPECT_EQ(surface.report.holesClosed, 2) << f << " " << g;
				EXPECT_EQ(surface.report.verticesParted, 0) << f << " " << g;
				EXPECT_NEAR(enclosedVolume(surface), volume, 1e-9) << f << " " << g;
			}
	}
}

TEST(Mend, AWingsOpenEndAndTheSlitsOfItsTrailingEdgeAreHolesOfTheirOwn)
{
	const shapes::Soup wing = openWing([](int i) { return i % 2 == 0; }, 0.03, 0);
	const MendedSurface surface = mendedOf(wing);
	expectMended(surface, wing);
	EXPECT_EQ(surface.report.holesClosed, 1 + wingPieces / 2);
	EXPECT_NEAR(enclosedVolume(surface), wingSpan * wingSection, 0.1 * wingSpan * wingSection);
}

TEST(Mend, AHoleWhoseFillingThatTurnsLeastCrossesTheSurfaceGetsTheSmallest)
{
	const shapes::Soup wing = openWing([](int i) { return i == wingPieces; }, 0.01, 0.02);
	const MendedSurface surface = mendedOf(wing);
	expectMended(surface, wing);
	EXPECT_EQ(surface.report.holesClosed, 1);
	EXPECT_NEAR(enclosedVolume(surface), wingSpan * wingSection, 0.2 * wingSpan * wingSection);
}

/// So many triangles around a vertex, which have nothing else in common. @param turned  every other
/// one is turned over.
shapes::Soup wheel(int count, bool turned)
{
	shapes::Soup soup = {{{0, 0, 0}}, {}};
	for (int i = 0; i < count; ++i) {
		for (double side : {0.25, 0.75}) {
			const double angle = 2 * M_PI * (i + side) / count;
			soup.points.emplace_back(std::cos(angle), std::sin(angle), 0.1 * std::cos(7 * angle));
		}
		soup.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
		if (turned && i % 2)
			std::swap(soup.triangles.back()[1], soup.triangles.back()[2]);
	}
	return soup;
}

TEST(Mend, FindsTheHolesBetweenThousandsOfFansAtAVertex)
{
	constexpr int count = 20000;
	for (bool turned : {false, true}) {
		const shapes::Soup soup = wheel(count, turned);
		int asked = 0;
		const auto loops = detail::holeLoops(soup.points, soup.triangles,
			std::vector<int>(3 * soup.triangles.size(), -1), Progress([&](int, const char*) {
				++asked;
				return true;
			}));
		// Faces alike have one hole around all of them; else each has one of its own.
		EXPECT_EQ(loops.size(), size_t(turned ? count : 1));
		EXPECT_EQ(loops.front().size(), size_t(turned ? 3 : 3 * count));
		EXPECT_GT(asked, 1);
		EXPECT_LT(asked, 20); // once in some 30,000 comparisons
	}
}

TEST(Mend, AsksToCancelWhileItFindsHoles)
{
	const shapes::Soup soup = wheel(3, false);
	EXPECT_THROW(detail::holeLoops(soup.points, soup.triangles, std::vector<int>(9, -1),
					 Progress([](int, const char*) { return false; })),
		Cancelled);
}

TEST(Mend, LeavesALargeHole)
{
	shapes::Soup soup = shapes::sphere(3);
	std::vector<Triangle> half;
	for (const Triangle& t : soup.triangles)
		// A rim that goes up and down: not that of a cut by a plane.
		if (const Point3d& p = soup.points[size_t(t[0])];
			p[2] < 0.1 + std::cos(3 * std::atan2(p[1], p[0])) / 3)
			half.push_back(t);
	soup.triangles = half;
	const MendedSurface surface = mendedOf(soup);
	EXPECT_FALSE(surface.closed);
	EXPECT_EQ(surface.report.holesLeft, 1);
	EXPECT_EQ(surface.report.holesClosed, 0);
}

TEST(Mend, FillsALargeHoleThatContinuesAFlatFace)
{
	const auto filled = [](const shapes::Soup& soup, const std::set<size_t>& missing) {
		std::vector<Triangle> faces;
		for (size_t f = 0; f < soup.triangles.size(); ++f)
			if (!missing.count(f))
				faces.push_back(soup.triangles[f]);
		const std::vector<int> partner =
			detail::pairedHalfEdges(soup.points, faces, nullptr, Progress());
		return fillHoles(soup.points, faces, partner).closed;
	};
	const shapes::Soup plate = shapes::box(4, 4, 0.1);
	std::vector<size_t> top;
	for (size_t f = 0; f < plate.triangles.size(); ++f)
		if (detail::areaVector(plate.points, plate.triangles[f])[2] > 1)
			top.push_back(f);
	ASSERT_EQ(top.size(), 2u);
	// Either of the two is a third of the area that is left. Both together are a lid.
	EXPECT_EQ(filled(plate, {top[0]}), 1);
	EXPECT_EQ(filled(plate, {top[1]}), 1);
	EXPECT_EQ(filled(plate, {top[0], top[1]}), 0);
}

TEST(Mend, DoesNotFillAcrossTheShape)
{
	// A tube without its ends: each end is small, and its filling is the end. With a wall through an end,
	// the filling would cross that.
	shapes::Soup soup = shapes::capsule(4, 0.3, 24);
	std::vector<Triangle> open;
	for (const Triangle& t : soup.triangles) {
		bool end = false;
		for (int v : t)
			end |= soup.points[size_t(v)][0] > 2.01;
		if (!end)
			open.push_back(t);
	}
	soup.triangles = open;
	EXPECT_EQ(mendedOf(soup).report.holesClosed, 1);
	const shapes::Soup pin = shapes::moved(shapes::box(1, 0.05, 0.05), {1.5, -0.02, -0.02});
	const MendedSurface crossed = mendedOf(shapes::joined({soup, pin}));
	EXPECT_EQ(crossed.report.holesClosed, 0);
	EXPECT_FALSE(crossed.closed);
}

TEST(Mend, TurnsFacesToAgree)
{
	shapes::Soup soup = shapes::opened(shapes::sphere(3));
	for (size_t f = 5; f < soup.triangles.size(); f += 20)
		std::swap(soup.triangles[f][0], soup.triangles[f][1]);
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup);
	EXPECT_EQ(surface.report.facesTurned, int((soup.triangles.size() + 14) / 20));
	EXPECT_GT(enclosedVolume(surface), 4);
}

TEST(Mend, PartsBodiesThatTouchAtAnEdge)
{
	const shapes::Soup soup = shapes::tetrahedraSharingEdge();
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup, 2, 4);
	EXPECT_EQ(surface.report.edgesParted, 1);
	EXPECT_NEAR(enclosedVolume(surface), 2.0 / 6, 1e-12);
}

TEST(Mend, PartsBodiesThatTouchAtAVertex)
{
	const shapes::Soup soup = shapes::tetrahedraSharingVertex();
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup, 2, 4);
	EXPECT_EQ(surface.report.verticesParted, 1);
}

TEST(Mend, DropsAFin)
{
	shapes::Soup soup = shapes::sphere(3);
	const Triangle t = soup.triangles[10];
	const int tip = int(soup.points.size());
	soup.points.push_back(soup.points[size_t(t[0])] * 1.1);
	soup.triangles.push_back({t[1], t[0], tip});
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup);
	EXPECT_EQ(surface.report.piecesDropped, 1);
	EXPECT_NEAR(enclosedVolume(surface), enclosedVolume(mendedOf(shapes::sphere(3))), 1e-12);
}

/// An opened ball, and so many small ones beside it.
shapes::Soup withBalls(int count, double radius)
{
	shapes::Soup soup = shapes::opened(shapes::sphere(3));
	const shapes::Soup ball = shapes::scaled(shapes::sphere(1), radius);
	for (int i = 0; i < count; ++i)
		soup = shapes::joined({soup, shapes::moved(ball, {2, 0.04 * (i % 30), 0.04 * (i / 30)})});
	return soup;
}

TEST(Mend, DropsWhatFloatsAboutAScan)
{
	const shapes::Soup body = shapes::opened(shapes::sphere());
	shapes::Soup sheet = {
		{{0, 0, 2}, {0.3, 0, 2}, {0.3, 0.3, 2.1}, {0, 0.3, 2}}, {{0, 1, 2}, {0, 2, 3}}};
	const shapes::Soup clump = shapes::moved(shapes::scaled(shapes::box(), 0.04), {0, 0, 1.5});
	const MendedSurface surface = mendedOf(shapes::joined({body, sheet, clump}));
	expectMended(surface, body);
	EXPECT_EQ(surface.report.piecesDropped, 2);
	// A twig that was torn off is no clump: it is long.
	const shapes::Soup twig = shapes::moved(shapes::box(0.5, 0.02, 0.02), {0, 0, 1.5});
	expectMended(mendedOf(shapes::joined({body, twig})), body, 2, 4);
}

TEST(Mend, DropsAStrayTriangleHoweverLargeUnlessTheSurfaceIsMadeOfThem)
{
	const shapes::Soup body = shapes::sphere();
	const shapes::Soup stray = {{{2, 0, 0}, {2, 1.4, 0}, {2, 0, 1.4}}, {{0, 1, 2}}};
	const MendedSurface surface = mendedOf(shapes::joined({body, stray}));
	expectMended(surface, body);
	EXPECT_EQ(surface.report.piecesDropped, 1);
	// Twelve triangles of a box, apart from each other.
	shapes::Soup apart = shapes::unmerged(shapes::box());
	for (const Triangle& t : apart.triangles) {
		const Point3d centre =
			(apart.points[size_t(t[0])] + apart.points[size_t(t[1])] + apart.points[size_t(t[2])])
			/ 3.0;
		for (int v : t)
			apart.points[size_t(v)] += (centre - apart.points[size_t(v)]) * 0.2;
	}
	EXPECT_EQ(mendedOf(apart).report.piecesDropped, 0);
}

TEST(Mend, DropsClosedSpecksBesideABodyUnlessTheyAreTheSurface)
{
	const MendedSurface few = mendedOf(withBalls(6, 0.009));
	expectMended(few, {}, 1, 2);
	EXPECT_EQ(few.report.piecesDropped, 6);
	expectMended(mendedOf(withBalls(6, 0.06)), {}, 7, 14);
	const MendedSurface many = mendedOf(withBalls(800, 0.009));
	expectMended(many, {}, 801, 2 * 801);
	EXPECT_EQ(many.report.piecesDropped, 0);
}

TEST(Mend, UnitesBoxesWithACommonWall)
{
	const shapes::Soup soup =
		shapes::joined({shapes::box(), shapes::moved(shapes::box(), {1, 0, 0})});
	shapes::Soup merged = soup; // the wall's vertices are the same ones
	for (Triangle& t : merged.triangles)
		for (int& v : t)
			for (int w = 0; w < v; ++w)
				if (merged.points[size_t(w)] == merged.points[size_t(v)])
					v = w;
	const MendedSurface surface = mendedOf(merged);
	ASSERT_TRUE(surface.closed);
	EXPECT_NEAR(enclosedVolume(surface), 2, 1e-12);
}

TEST(Mend, DropsAWallAcrossTheInside)
{
	shapes::Soup soup = shapes::sphere(3);
	const int middle = int(soup.points.size());
	std::vector<Triangle> wall;
	for (const Triangle& t : soup.triangles)
		for (size_t k = 0; k < 3; ++k) {
			const int a = t[k], b = t[(k + 1) % 3];
			if (a < b && soup.points[size_t(a)][2] == 0 && soup.points[size_t(b)][2] == 0)
				wall.push_back({a, b, middle});
		}
	ASSERT_GT(wall.size(), 8u);
	const MendedSurface without = mendedOf(soup);
	soup.points.emplace_back(0, 0, 0);
	soup.triangles.insert(soup.triangles.end(), wall.begin(), wall.end());
	const MendedSurface surface = mendedOf(soup);
	ASSERT_TRUE(surface.closed);
	EXPECT_EQ(surface.report.holesLeft, 0);
	EXPECT_EQ(surface.report.piecesDropped, 1);
	EXPECT_NEAR(enclosedVolume(surface), enclosedVolume(without), 1e-12);
}

TEST(Mend, FillsATinyHoleHoweverItsFillingTurns)
{
	shapes::Soup soup = shapes::sphere(4);
	const Triangle t = soup.triangles[5];
	soup.triangles.erase(soup.triangles.begin() + 5);
	// Folded over the opposite edge: the only filling lies back on the face beyond.
	Point3d& tip = soup.points[size_t(t[0])];
	tip = soup.points[size_t(t[1])] + soup.points[size_t(t[2])] - tip;
	const auto fill = [&](const HoleLimits& limits) {
		std::vector<Point3d> points = soup.points;
		std::vector<Triangle> faces = soup.triangles;
		std::vector<int> partedFrom;
		const PartedSurface parted = partSurface(points, faces, partedFrom, true);
		return fillHoles(points, faces, parted.partner, limits);
	};
	EXPECT_EQ(fill(HoleLimits()).left, 1);
	HoleLimits anyhow;
	anyhow.anyhow = 0.01;
	EXPECT_EQ(fill(anyhow).left, 0);
	anyhow.anyhow = 1e-6;
	EXPECT_EQ(fill(anyhow).left, 1);
}

TEST(Mend, ASpeckIsOneWhicheverFaceComesFirst)
{
	// Half a sphere, open, with a ball far away, whose first face may be the first of all.
	shapes::Soup half = shapes::sphere(4);
	half.triangles.erase(std::remove_if(half.triangles.begin(), half.triangles.end(),
							 [&](const Triangle& t) {
								 return (half.points[size_t(t[0])] + half.points[size_t(t[1])]
											+ half.points[size_t(t[2])])[2]
									 < 0;
							 }),
		half.triangles.end());
	// Of its diagonal the balls have 0.8, 3 and 4.6 %, of its volume about 1e-6, 4e-5 and 2e-4.
	for (const auto& [radius, isSpeck] :
		{std::pair(0.007, true), std::pair(0.026, true), std::pair(0.04, false)})
		for (const Point3d& place : {Point3d(0, 0, 50), Point3d(0, 0, -50), Point3d(50, 20, 0)}) {
			const shapes::Soup ball = shapes::moved(shapes::sphere(2, radius), place);
			for (const shapes::Soup& soup :
				{shapes::joined({half, ball}), shapes::joined({ball, half})}) {
				const std::vector<int> partner =
					detail::pairedHalfEdges(soup.points, soup.triangles, nullptr, Progress());
				EXPECT_EQ(detail::specksOf(soup.points, soup.triangles, partner).count, isSpeck)
					<< radius << " at " << place[0] << ' ' << place[2];
			}
		}
}

/// Tetrahedra around a common edge, each half as wide as its place, every third one inside out.
shapes::Soup wedgesAroundAnEdge(int count)
{
	shapes::Soup soup;
	soup.points = {{0, 0, -1}, {0, 0, 1}};
	for (int i = 0; i < count; ++i) {
		const int a = int(soup.points.size()), b = a + 1;
		for (const double at : {i + 0.1, i + 0.6}) {
			const double turn = 2 * M_PI * at / count;
			soup.points.emplace_back(std::cos(turn), std::sin(turn), 0);
		}
		const shapes::Soup wedge = {{}, {{0, 1, b}, {0, a, 1}, {0, b, a}, {1, a, b}}};
		for (const Triangle& t : (i % 3 ? wedge : shapes::insideOut(wedge)).triangles)
			soup.triangles.push_back(t);
	}
	return soup;
}

TEST(Mend, PartsAnEdgeOfVeryManyFacesAcrossTheSolids)
{
	// All pairs of faces would take 16 GB.
	const int count = 16000;
	const shapes::Soup soup = wedgesAroundAnEdge(count);
	int crowded = 0;
	const std::vector<int> partner =
		detail::pairedHalfEdges(soup.points, soup.triangles, &crowded, Progress());
	EXPECT_EQ(crowded, 1);
	int alone = 0, apart = 0;
	for (size_t h = 0; h < partner.size(); ++h) {
		const int g = partner[h];
		alone += g < 0 || partner[size_t(g)] != int(h);
		// Where none is inside out, each wedge stays with itself.
		apart += g >= 0 && g / 12 != int(h) / 12 && (int(h) / 12) % 3 == 2;
	}
	EXPECT_EQ(alone, 0);
	EXPECT_EQ(apart, 0);
}

TEST(Mend, MakesABodyOfEachOfManyThatShareAnEdge)
{
	const int count = 60;
	shapes::Soup soup = wedgesAroundAnEdge(count);
	for (int i = 0; i < count; i += 3) // all outward
		for (int k = 0; k < 4; ++k)
			std::swap(soup.triangles[size_t(4 * i + k)][1], soup.triangles[size_t(4 * i + k)][2]);
	expectMended(mendedOf(soup), soup, count, 2 * count);
}

TEST(Mend, LeavesFacesAloneThatAllTurnTheSameWayAtAnEdge)
{
	shapes::Soup fins = wedgesAroundAnEdge(100);
	std::vector<Triangle> same;
	for (size_t f = 1; f < fins.triangles.size(); f += 4)
		if (f / 4 % 3 != 0)
			same.push_back(fins.triangles[f]);
	ASSERT_GT(same.size(), 64u);
	for (const int g : detail::pairedHalfEdges(fins.points, same, nullptr, Progress()))
		EXPECT_EQ(g, -1);
}

TEST(Mend, IsCancelledAtAnEdgeOfVeryManyFaces)
{
	const shapes::Soup soup = wedgesAroundAnEdge(100000);
	int asked = 0, last = 1 << 30;
	const Progress progress([&](int, const char*) { return ++asked < last; });
	detail::pairedHalfEdges(soup.points, soup.triangles, nullptr, progress);
	// Sorting at the edge asks, by far, more often than what comes before it.
	const int inAll = std::exchange(asked, 0);
	EXPECT_GT(inAll, 100);
	last = inAll - 10;
	EXPECT_THROW(
		detail::pairedHalfEdges(soup.points, soup.triangles, nullptr, progress), Cancelled);
}

TEST(Mend, DoesNotMergeAcrossSlivers)
{
	// A tube as thin as a hundredth of its faces' length: its vertices are near each other beside long edges.
	const shapes::Soup tube =
		shapes::revolved({{-2, 0}, {-1.99, 0.004}, {0, 0.004}, {1.99, 0.004}, {2, 0}}, 12);
	shapes::Soup soup = tube;
	for (size_t f : {size_t(40), size_t(30), size_t(20)})
		soup.triangles.erase(soup.triangles.begin() + long(f));
	const MendedSurface surface = mendedOf(soup);
	ASSERT_TRUE(surface.closed);
	EXPECT_EQ(surface.report.verticesMerged, 0);
	EXPECT_EQ(surface.report.junctionsClosed, 0);
	EXPECT_EQ(surface.triangles.size(), tube.triangles.size());
}

TEST(Mend, ClosesTJunctions)
{
	shapes::Soup soup = shapes::sphere(2);
	const Triangle t = soup.triangles[7];
	const int middle = int(soup.points.size());
	soup.points.push_back((soup.points[size_t(t[0])] + soup.points[size_t(t[1])]) / 2.0);
	soup.triangles[7] = {t[0], middle, t[2]};
	soup.triangles.push_back({middle, t[1], t[2]});
	const MendedSurface surface = mendedOf(soup);
	expectMended(surface, soup);
	EXPECT_EQ(surface.report.junctionsClosed, 1);
	EXPECT_EQ(surface.report.holesClosed, 0);
}

TEST(Mend, MergesVerticesThatNearlyCoincide)
{
	const shapes::Soup soup = shapes::jittered(shapes::unmerged(shapes::sphere(3)), 1e-6);
	const MendedSurface surface = mendedOf(soup);
	ASSERT_TRUE(surface.closed);
	EXPECT_EQ(surface.report.verticesMerged, int(soup.points.size()) - 258);
	EXPECT_EQ(int(soup.triangles.size()), int(surface.triangles.size()));
}

TEST(Mend, ClosesSeamsBesideFacesThatAreTurned)
{
	// Both border edges run into the vertex on the seam.
	shapes::Soup soup = shapes::sphere(2);
	const Triangle t = soup.triangles[7];
	const int middle = int(soup.points.size());
	soup.points.push_back((soup.points[size_t(t[0])] + soup.points[size_t(t[1])]) / 2.0);
	soup.triangles[7] = {t[0], middle, t[2]};
	soup.triangles.push_back({t[1], middle, t[2]});
	const MendedSurface junction = mendedOf(soup);
	expectMended(junction, soup);
	EXPECT_EQ(junction.report.junctionsClosed, 1);
	EXPECT_EQ(junction.report.holesClosed, 0);

	soup = shapes::sphere(2);
	const int copy = int(soup.points.size());
	const auto vertexOf = [&](size_t f) {
		return std::find(soup.triangles[f].begin(), soup.triangles[f].end(), 0);
	};
	std::vector<size_t> around;
	for (size_t f = 0; f < soup.triangles.size(); ++f)
		if (vertexOf(f) != soup.triangles[f].end())
			around.push_back(f);
	const auto after = [&](size_t f, int steps) {
		return soup.triangles[f][size_t(vertexOf(f) - soup.triangles[f].begin() + steps) % 3];
	};
	const size_t first = around[0];
	const size_t second = *std::find_if(
		around.begin(), around.end(), [&](size_t f) { return after(f, 1) == after(first, 2); });
	soup.triangles[first] = {copy, after(first, 2), after(first, 1)};
	soup.triangles[second] = {copy, after(second, 1), after(second, 2)};
	soup.points.push_back(soup.points[0] * (1 + 1e-6));
	const MendedSurface merged = mendedOf(soup);
	expectMended(merged, soup);
	EXPECT_EQ(merged.report.verticesMerged, 1);
	EXPECT_EQ(merged.report.holesClosed, 0);
}

TEST(Mend, ClosesATJunctionOfSeveralFansOnce)
{
	const shapes::Soup soup = {{{0, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 0, 0}, {2, 1, 0}, {1.5, 1, 0},
								   {0.5, 1, 0}, {0, 1, 0}},
		{{1, 0, 2}, {3, 4, 5}, {3, 6, 7}}};
	std::vector<Triangle> faces = soup.triangles;
	detail::SoupEdges edges = edgesOf(soup);
	const ClosedSeams seams = closeSeams(soup.points, faces, edges);
	EXPECT_EQ(seams.junctions, 1);
	EXPECT_EQ(seams.merged, 0);
	EXPECT_EQ(faces.size(), 4u);
}

TEST(Mend, ACornerOnItsOwnOppositeEdgeIsNoTJunction)
{
	const shapes::Soup soup = {
		{{0, 0, 0}, {1, 0, 0}, {0.4, 0.001, 0}, {0.7, 0, 0}, {0.6, -1, 0}, {0.8, -1, 0}},
		{{0, 1, 2}, {3, 4, 5}}};
	std::vector<Triangle> faces = soup.triangles;
	detail::SoupEdges edges = edgesOf(soup);
	EXPECT_EQ(closeSeams(soup.points, faces, edges).junctions, 1);
	const std::vector<Triangle> expected = {{0, 3, 2}, {3, 4, 5}, {3, 1, 2}};
	EXPECT_EQ(faces, expected);
	faces = {{0, 1, 2}};
	edges = detail::sortedSoupEdges(soup.points.size(), faces, Progress());
	EXPECT_EQ(closeSeams(soup.points, faces, edges).junctions, 0);
	EXPECT_EQ(faces.size(), 1u);
}

TEST(Mend, WhereFacesDisagreeABorderThatEndsIsNoHole)
{
	// A body, then three faces at one edge that all run the same way along it.
	shapes::Soup soup = shapes::tetrahedron();
	const int a = int(soup.points.size());
	for (const Point3d& p : {Point3d(5, 0, 0), Point3d(5, 0, 1), Point3d(6, 0, 0.5),
			 Point3d(4.5, 0.9, 0.5), Point3d(4.5, -0.9, 0.5)})
		soup.points.push_back(p);
	for (int apex = 2; apex < 5; ++apex)
		soup.triangles.push_back({a, a + 1, a + apex});
	std::vector<int> partedFrom;
	const PartedSurface parted = partSurface(soup.points, soup.triangles, partedFrom, true);
	for (const std::vector<int>& loop :
		detail::holeLoops(soup.points, soup.triangles, parted.partner))
		for (int h : loop)
			EXPECT_LT(parted.partner[size_t(h)], 0) << "only borders are around holes";
}

TEST(Mend, AsksToCancelOftenWhereBordersOverlap)
{
	std::mt19937 random(1);
	shapes::Soup soup;
	for (int i = 0; i < 1000; ++i) {
		const int n = int(soup.points.size());
		for (int k = 0; k < 3; ++k)
			soup.points.emplace_back(random() * 1e-9, random() * 1e-9, random() * 1e-9);
		soup.triangles.push_back({n, n + 1, n + 2});
	}
	int asked = 0;
	detail::SoupEdges edges = edgesOf(soup);
	closeSeams(soup.points, soup.triangles, edges, Progress([&](int, const char*) {
		++asked;
		return true;
	}));
	EXPECT_GT(asked, 75); // once in some 30,000 edges; for the stages alone 60
	// A vertex with many borders is looked at once, not once for each.
	asked = 0;
	shapes::Soup fans = wheel(20000, false);
	edges = edgesOf(fans);
	closeSeams(fans.points, fans.triangles, edges, Progress([&](int, const char*) {
		++asked;
		return true;
	}));
	EXPECT_LT(asked, 100);
}

TEST(Mend, LeavesOutFacesThatAreNotFinite)
{
	shapes::Soup soup = shapes::sphere(3);
	soup.points[3][1] = std::numeric_limits<double>::quiet_NaN();
	const MendedSurface surface = mendedOf(soup);
	ASSERT_TRUE(surface.closed);
	EXPECT_EQ(surface.report.holesClosed, 1);
	for (const Triangle& t : surface.triangles)
		for (int v : t)
			EXPECT_NE(v, 3);
}

TEST(Mend, SaysThatASurfaceIsOneSided)
{
	const MendedSurface surface = mendedOf(shapes::kleinBottle());
	EXPECT_FALSE(surface.closed);
	EXPECT_TRUE(surface.report.oneSided);
}

TEST(Mend, ClosesAShortPieceThatWasTornOff)
{
	// Its rim goes up and down: not that of a cut by a plane.
	shapes::Soup piece = shapes::sphere(4, 0.5);
	piece.triangles.erase(std::remove_if(piece.triangles.begin(), piece.triangles.end(),
							  [&](const Triangle& t) {
								  const Point3d& p = piece.points[size_t(t[0])];
								  return p[2] > 0.15 + std::cos(3 * std::atan2(p[1], p[0])) / 8;
							  }),
		piece.triangles.end());
	piece = shapes::moved(piece, {3, 0, 0});
	const MendedSurface surface = mendedOf(shapes::joined({shapes::sphere(4, 1), piece}));
	EXPECT_TRUE(surface.closed);
	EXPECT_EQ(surface.report.holesClosed, 1);
	// The largest piece may be a bowl.
	EXPECT_FALSE(mendedOf(piece).closed);
}

} // namespace
