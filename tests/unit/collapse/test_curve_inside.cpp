// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/collapse/curve_inside.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A curve in a surface of one component; the surface's vertices belong to the nearest nodes.
struct Curve
{
	SurfaceMesh surface;
	CurveSkeleton skeleton;
	std::vector<int> component;

	Curve(const shapes::Soup& soup, const std::vector<Point3d>& places,
		const std::vector<std::array<int, 2>>& edges) :
			surface(soup.mesh()),
			component(places.size(), 0)
	{
		skeleton.position = places;
		skeleton.edges = edges;
		for (const Point3d& p : surface.position) {
			const auto nearer = [&](const Point3d& a, const Point3d& b) {
				return SquaredDistance(a, p) < SquaredDistance(b, p);
			};
			skeleton.node.push_back(
				int(std::min_element(places.begin(), places.end(), nearer) - places.begin()));
		}
	}

	CurveSkeleton inside()
	{
		return broughtInside(skeleton, surface.position, surface.triangles(),
			std::vector<int>(surface.position.size(), 0), 1, component);
	}
};

/// How far a curve is outside, of the diagonal, at its nodes and along its edges.
double outside(const SurfaceMesh& surface, const CurveSkeleton& skeleton)
{
	const SolidTest solid(surface.position, surface.triangles());
	double worst = 0;
	for (const auto& [a, b] : skeleton.edges)
		for (int i = 0; i <= 16; ++i) {
			const Point3d p =
				skeleton.position[a] * (1 - i / 16.0) + skeleton.position[b] * (i / 16.0);
			if (std::abs(checks::windingNumber(surface, p)) < 0.5)
				worst = std::max(worst, solid.closest(solid.in(p)).distance);
		}
	return worst;
}

/// A ring of nodes about the z axis.
std::vector<Point3d> ring(int count, double radius)
{
	std::vector<Point3d> places;
	for (int i = 0; i < count; ++i) {
		const double angle = 2 * M_PI * i / count;
		places.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.01);
	}
	return places;
}

std::vector<std::array<int, 2>> closed(int count)
{
	std::vector<std::array<int, 2>> edges;
	for (int i = 0; i + 1 < count; ++i)
		edges.push_back({i, i + 1});
	edges.push_back({0, count - 1});
	std::sort(edges.begin(), edges.end());
	return edges;
}

} // namespace

TEST(CurveInside, IsCertainWhereNoTriangleIsOnTheCurve)
{
	// A tube around (0, 0, 0) to (10, 0, 0) of radius 1, of long triangles.
	const SurfaceMesh tube = shapes::revolved({{-1, 0}, {-1, 1}, {11, 1}, {11, 0}}, 12).mesh();
	const auto isCertain = [&](const std::vector<Point3d>& places,
							   const std::vector<std::array<int, 2>>& edges) {
		return detail::isCertainlyInside(
			places, edges, tube.position, tube.triangles(), Progress());
	};
	EXPECT_TRUE(isCertain({{0, 0, 0}, {10, 0, 0}}, {{0, 1}}));
	EXPECT_TRUE(isCertain({{0, 0, 0}, {10, 0.9, 0}}, {{0, 1}})) << "near the surface";
	EXPECT_FALSE(isCertain({{0, 0, 0}, {10, 1.1, 0}}, {{0, 1}})) << "its end is outside";
	EXPECT_FALSE(isCertain({{0, 0, 0}, {5, 3, 0}, {10, 0, 0}}, {{0, 1}, {1, 2}})) << "it leaves";
	EXPECT_FALSE(isCertain({{0, 0, 3}, {10, 0, 3}}, {{0, 1}})) << "beside the tube";
	EXPECT_FALSE(isCertain({{0, 0, 0}, {10, 0, 0}, {5, 0, 3}}, {{0, 1}}))
		<< "a node alone, outside";
	EXPECT_TRUE(isCertain({{5, 0, 0}}, {})) << "a node alone, inside";
	EXPECT_TRUE(isCertain({}, {}));
}

TEST(CurveInside, WhatIsInsideStaysToTheLastBit)
{
	Curve curve(shapes::torus(1, 0.3, 60, 20), ring(40, 1), closed(40));
	EXPECT_TRUE(checks::sameBits(curve.inside(), curve.skeleton));
}

TEST(CurveInside, ACurveThatHasLeftARingComesBackAndStaysARing)
{
	// Beyond the outer wall, in the hole, and far away.
	for (double radius : {1.35, 0.6, 5.0}) {
		SCOPED_TRACE(radius);
		Curve curve(shapes::torus(1, 0.3, 60, 20), ring(40, radius), closed(40));
		ASSERT_GT(outside(curve.surface, curve.skeleton), 0.01);
		const CurveSkeleton inside = curve.inside();
		EXPECT_LT(outside(curve.surface, inside), 1e-6);
		EXPECT_EQ(statistics(inside).components, 1);
		EXPECT_EQ(statistics(inside).cycles, 1);
		EXPECT_NEAR(statistics(inside).length, 2 * M_PI, 0.5);
		EXPECT_EQ(curve.component.size(), inside.position.size());
		double farthest = 0; // from the axis of the ring
		for (const Point3d& p : inside.position)
			farthest = std::max(farthest, std::hypot(std::hypot(p[0], p[1]) - 1, p[2]));
		EXPECT_LT(farthest, 0.15) << "in the middle half of the tube";
	}
}

TEST(CurveInside, AnEdgeThatCutsACornerIsBent)
{
	// Three nodes of a ring: the straight edges between them cross the hole.
	Curve curve(shapes::torus(1, 0.15, 60, 12), ring(3, 1), closed(3));
	const CurveSkeleton inside = curve.inside();
	EXPECT_LT(outside(curve.surface, inside), 1e-6);
	EXPECT_EQ(statistics(inside).cycles, 1);
	EXPECT_GT(inside.position.size(), 3u);
	for (int A = 0; A < 3; ++A)
		EXPECT_EQ(inside.position[A], curve.skeleton.position[A]) << "was inside";
	for (const auto& [a, b] : inside.edges)
		EXPECT_GT(Distance(inside.position[a], inside.position[b]), 0);
}

TEST(CurveInside, AWayThatHalvingDoesNotFindGoesOverTheSurface)
{
	// From one arm of a tight U to the other: the points between are next to either.
	shapes::Soup soup = shapes::subdivided(shapes::subdivided(shapes::box(10, 0.4, 0.4)));
	soup = shapes::transformed(soup, [](const Point3d& p) {
		const double angle = M_PI * p[0] / 10;
		return Point3d((1 + p[1]) * 3 * std::cos(angle), (1 + p[1]) * std::sin(angle) * 9, p[2]);
	});
	Curve curve(soup, {{3.6, 0.1, 0.2}, {-3.6, 0.1, 0.2}}, {{0, 1}});
	const CurveSkeleton inside = curve.inside();
	EXPECT_LT(outside(curve.surface, inside), 1e-6);
	EXPECT_EQ(statistics(inside).components, 1);
	EXPECT_EQ(statistics(inside).cycles, 0);
	EXPECT_GT(statistics(inside).length, 15) << "round the bend";
}

TEST(CurveInside, RoundTheCornerOfTwoThinPlatesTheWayIsShort)
{
	// Few triangles, as long as the plates: along their edges the way would be a hundred times as long.
	shapes::Soup soup = shapes::cells(2, 1, 2, [](int x, int, int z) { return x == 0 || z == 0; });
	const auto thin = [](double x) { return x <= 1 ? 0.01 * x : 0.01 + 0.99 * (x - 1); };
	soup = shapes::transformed(
		soup, [&](const Point3d& p) { return Point3d(thin(p[0]), 2 * p[1], thin(p[2])); });
	for (double a : {0.03, 0.038, 0.05, 0.07, 0.1})
		for (double b : {0.03, 0.04, 0.06, 0.08}) {
			Curve curve(soup, {{0.005, 1, a}, {b, 1.01, 0.005}}, {{0, 1}});
			const CurveSkeleton inside = curve.inside();
			EXPECT_LT(outside(curve.surface, inside), 5e-7);
			EXPECT_LT(statistics(inside).length, a + b + 0.02) << a << " " << b;
		}
}

TEST(CurveInside, TheEndsOfAnEdgeInABentSheetTakeTheSameWall)
{
	// One is nearer to the outer wall of a bowl, the other to the inner one: the rim is far away.
	const auto bent = [](double x, double y, double z) {
		const double u = (x - 4) * M_PI / 16, v = (y - 4) * M_PI / 16;
		return Point3d(std::sin(u), std::cos(u) * std::sin(v), std::cos(u) * std::cos(v))
			* (1 - 0.002 * z);
	};
	const shapes::Soup bowl =
		shapes::transformed(shapes::cells(8, 8, 1, [](int, int, int) { return true; }),
			[&](const Point3d& p) { return bent(p[0], p[1], p[2]); });
	for (int i = 1; i < 7; ++i)
		for (int j = 1; j < 7; ++j) {
			const Point3d from = bent(i, j, 0.1), to = bent(7 - j, i, 0.9);
			if (from == to || Distance(from, to) < 0.1)
				continue;
			Curve curve(bowl, {from, to}, {{0, 1}});
			const CurveSkeleton inside = curve.inside();
			EXPECT_LT(outside(curve.surface, inside), 5e-7);
			EXPECT_LT(statistics(inside).length, 1.5 * Distance(from, to)) << i << " " << j;
		}
}

TEST(CurveInside, ToAPlaceOnTheSurfaceTheWayIsInside)
{
	// A frame of thin bars, turned so that places on its surface are on it but for rounding.
	constexpr double thickness = 0.01, length = 5;
	const auto plane = [](double t) {
		return std::floor(t / 2) * length + std::fmod(t, 2) * thickness;
	};
	const shapes::Soup soup = shapes::transformed(
		shapes::cells(5, 5, 5,
			[](int i, int j, int k) { return (i % 2 == 0) + (j % 2 == 0) + (k % 2 == 0) > 1; }),
		[&](const Point3d& p) {
			const double x = plane(p[0]), y = plane(p[1]), z = plane(p[2]);
			return Point3d(2 * x - y + 2 * z, 2 * x + 2 * y - z, 2 * z + 2 * y - x) / 3.0;
		});
	std::mt19937 random(1);
	std::uniform_real_distribution<double> part(0, 1);
	const auto place = [&](double deepest) {
		const Triangle& t = soup.triangles[random() % soup.triangles.size()];
		const Point3d &p = soup.points[t[0]], u = soup.points[t[1]] - p, v = soup.points[t[2]] - p;
		double a = part(random), b = part(random);
		if (a + b > 1) {
			a = 1 - a;
			b = 1 - b;
		}
		const Point3d normal = (u ^ v) / (u ^ v).Norm();
		return p + u * a + v * b - normal * (deepest > 0 ? deepest * part(random) : 0);
	};
	for (int tried = 0; tried < 300;) {
		const Point3d from = place(0.4 * thickness), to = place(0);
		if (Distance(from, to) > 1)
			continue;
		++tried;
		Curve curve(soup, {from, to}, {{0, 1}});
		EXPECT_LE(outside(curve.surface, curve.inside()), 5e-7) << tried;
	}
}

TEST(CurveInside, ANodeFarOutsideGoesToTheNearestPlaceOfTheTrianglesThatMergedIntoIt)
{
	// A long bar of two triangles a side: its vertices are far from the middle.
	Curve curve(shapes::box(10, 0.02, 0.02), {{4, 0.01, 0.01}, {5, 0.3, 0.01}, {6, 0.01, 0.01}},
		{{0, 1}, {1, 2}});
	curve.skeleton.node.assign(curve.surface.position.size(), 1);
	const CurveSkeleton inside = curve.inside();
	EXPECT_LT(outside(curve.surface, inside), 5e-7);
	EXPECT_NEAR(inside.position[1][0], 5, 0.01);
	EXPECT_NEAR(statistics(inside).length, 2, 0.05);
}

TEST(CurveInside, ANodeBesideTheRimOfAPlateStaysAtTheRim)
{
	// From there, the middle of the chord is that of the plate.
	const shapes::Soup disc = shapes::revolved({{-0.05, 0}, {-0.05, 1}, {0.05, 1}, {0.05, 0}}, 64);
	for (const double far : {1.005, 1.03}) {
		Curve curve(disc, {{0, 0.9, -0.2}, {0.01, far, 0}, {0, 0.9, 0.2}}, {{0, 1}, {1, 2}});
		const CurveSkeleton inside = curve.inside();
		EXPECT_LT(outside(curve.surface, inside), 5e-7);
		EXPECT_LT(Distance(inside.position[1], curve.skeleton.position[1]), 0.11) << far;
		EXPECT_LT(statistics(inside).length, 1.1 * statistics(curve.skeleton).length) << far;
	}
}

TEST(CurveInside, BetweenThePlacesThatAreLookedAtNothingIsFartherOutsideThanPromised)
{
	// Edges that leave a box by a little more or less than the tolerance, at their middle or at an end.
	const shapes::Soup box = shapes::box(1, 1, 1);
	for (double beyond : {1.0, 1.5, 2.0, 3.0, 5.0, 8.0})
		for (double depth : {-1.0, 0.0, 1.0}) {
			const double unit = std::sqrt(3.0) * 1e-7;
			const std::vector<Point3d> places = {
				{0.2, 0.5, 1 + depth * unit}, {0.53, 0.5, 1 + beyond * unit}, {0.8, 0.5, 0.5}};
			Curve curve(box, places, {{0, 1}, {1, 2}});
			EXPECT_LE(outside(curve.surface, curve.inside()), 5e-7) << beyond << " " << depth;
		}
}

namespace {

/// A tight U, and a curve that goes up one arm and then ten times from arm to arm, outside.
Curve zigzagOverAGap()
{
	shapes::Soup soup = shapes::subdivided(shapes::subdivided(shapes::box(10, 0.4, 0.4)));
	soup = shapes::transformed(soup, [](const Point3d& p) {
		const double angle = M_PI * p[0] / 10;
		return Point3d((1 + p[1]) * 3 * std::cos(angle), (1 + p[1]) * std::sin(angle) * 9, p[2]);
	});
	std::vector<Point3d> places;
	std::vector<std::array<int, 2>> edges;
	for (int i = 0; i < 8; ++i) // up the arm, along the middle
		places.emplace_back(
			1.2 * 3 * std::cos(0.05 + 0.1 * i), 1.2 * 9 * std::sin(0.05 + 0.1 * i), 0.2);
	for (int i = 0; i < 20; ++i)
		places.emplace_back(
			(i % 2 ? 3.6 : -3.6) * std::cos(0.03), 1.2 * 9 * std::sin(0.03), 0.15 + 0.005 * i);
	for (int i = 0; i + 1 < int(places.size()); ++i)
		edges.push_back({i, i + 1});
	return Curve(soup, places, edges);
}

} // namespace

TEST(CurveInside, WhatWouldBeFarTooLongIsCutOffAndSaid)
{
	Curve curve = zigzagOverAGap();
	ASSERT_GT(outside(curve.surface, curve.skeleton), 0.1);
	CutCurves cut;
	const CurveSkeleton inside = broughtInside(curve.skeleton, curve.surface.position,
		curve.surface.triangles(), std::vector<int>(curve.surface.position.size(), 0), 1,
		curve.component, Progress(), TooFarOutside::CutOff, &cut);
	EXPECT_EQ(cut.components, 1);
	EXPECT_NE(cut.text().find("1 component "), std::string::npos);
	EXPECT_LT(outside(curve.surface, inside), 1e-6);
	EXPECT_EQ(statistics(inside).components, 1);
	EXPECT_EQ(statistics(inside).cycles, 0);
	// The arm's own part is the longest.
	ASSERT_GE(inside.position.size(), 8u);
	for (int i = 0; i < 8; ++i)
		EXPECT_EQ(inside.position[i], curve.skeleton.position[i]);
	EXPECT_EQ(curve.component, std::vector<int>(inside.position.size(), 0));
	for (int A : inside.node) {
		ASSERT_GE(A, 0);
		ASSERT_LT(A, int(inside.position.size()));
	}
}

TEST(CurveInside, ACurveWhoseNodesGoFarApartIsTooLongHoweverItsEdgesAreBent)
{
	// Part of a ring, then to and fro by 0.02 about its centre: the nearest places inside are on opposite sides.
	const shapes::Soup soup = shapes::torus(1, 0.1, 100, 8);
	std::vector<Point3d> places;
	for (int i = 0; i < 8; ++i)
		places.emplace_back(std::cos(0.1 * i), std::sin(0.1 * i), 0);
	for (int i = 0; i < 20; ++i)
		places.emplace_back(i % 2 ? 0.01 : -0.01, 0.0, 0.001 * i);
	std::vector<std::array<int, 2>> edges;
	for (int i = 0; i + 1 < int(places.size()); ++i)
		edges.push_back({i, i + 1});
	Curve curve(soup, places, edges);
	CutCurves cut;
	const CurveSkeleton inside = broughtInside(curve.skeleton, curve.surface.position,
		curve.surface.triangles(), std::vector<int>(curve.surface.position.size(), 0), 1,
		curve.component, Progress(), TooFarOutside::CutOff, &cut);
	EXPECT_EQ(cut.components, 1);
	EXPECT_LT(outside(curve.surface, inside), 1e-6);
	EXPECT_NEAR(statistics(inside).length, 0.7, 0.01) << "the part that was inside";
}

TEST(CurveInside, WhatWouldBeFarTooLongStaysWhereThatIsAskedFor)
{
	Curve curve = zigzagOverAGap();
	const CurveSkeleton inside = broughtInside(curve.skeleton, curve.surface.position,
		curve.surface.triangles(), std::vector<int>(curve.surface.position.size(), 0), 1,
		curve.component, Progress(), TooFarOutside::Stay);
	EXPECT_TRUE(checks::sameBits(inside, curve.skeleton));
}

TEST(CurveInside, OfATooLongCurveTheCyclesStay)
{
	// A long oval; from its narrow part a curve leads over the gap, to and fro.
	const auto stretched = [](const Point3d& p) { return Point3d(8 * p[0], p[1], p[2]); };
	const shapes::Soup oval = shapes::transformed(shapes::torus(1, 0.02, 200, 8), stretched);
	std::vector<Point3d> places;
	for (const Point3d& p : ring(100, 1))
		places.push_back(stretched(Point3d(p[0], p[1], 0)));
	std::vector<std::array<int, 2>> edges = closed(100);
	int last = 25;
	for (int i = 0; i < 40; ++i) {
		places.emplace_back(0, i % 2 ? 1 : -1, 0.0002 * (i + 1));
		edges.push_back({last, int(places.size()) - 1});
		last = int(places.size()) - 1;
	}
	std::sort(edges.begin(), edges.end());
	Curve curve(oval, places, edges);
	const CurveSkeleton inside = curve.inside();
	EXPECT_LT(outside(curve.surface, inside), 1e-6);
	EXPECT_EQ(statistics(inside).components, 1);
	EXPECT_EQ(statistics(inside).cycles, 1);
	EXPECT_NEAR(statistics(inside).length, 32.7, 1) << "the oval's perimeter, and no more";
}

TEST(CurveInside, TheCurveOfAFatterSurfaceComesIntoTheOneThatItStandsFor)
{
	const shapes::Soup fat = shapes::torus(1, 0.3, 60, 20), thin = shapes::torus(1, 0.1, 60, 12);
	Curve curve(fat, ring(40, 1.2), closed(40));
	curve.skeleton.significance.assign(40, 0.5);
	curve.skeleton.significance[7] = 0.25;
	const SurfaceMesh input = thin.mesh();
	std::vector<int> node;
	for (const Point3d& p : input.position) {
		const double angle = std::atan2(p[1], p[0]);
		node.push_back(int(std::lround(angle / (2 * M_PI) * 40) + 40) % 40);
	}
	CurveSkeleton inside = curve.skeleton;
	bringInsideInput(inside, curve.surface, input, node);
	EXPECT_LT(outside(input, inside), 1e-6);
	EXPECT_EQ(statistics(inside).cycles, 1);
	EXPECT_EQ(statistics(inside).components, 1);
	EXPECT_EQ(inside.node, curve.skeleton.node);
	ASSERT_EQ(inside.radius.size(), inside.position.size());
	ASSERT_EQ(inside.significance.size(), inside.position.size());
	for (double s : inside.significance)
		EXPECT_TRUE(s == 0.5 || s == 0.25);

	Curve centred(fat, ring(40, 1), closed(40));
	CurveSkeleton same = centred.skeleton;
	bringInsideInput(same, centred.surface, input, node);
	EXPECT_TRUE(checks::sameBits(same, centred.skeleton));
}

TEST(CurveInside, EachComponentIsBroughtIntoItsOwn)
{
	const shapes::Soup both = shapes::joined(
		{shapes::torus(1, 0.3, 60, 20), shapes::moved(shapes::torus(1, 0.3, 60, 20), {4, 0, 0})});
	const SurfaceMesh surface = both.mesh();
	const std::vector<int> component = connectedComponents(surface);
	CurveSkeleton skeleton;
	std::vector<int> ofNode;
	for (int c = 0; c < 2; ++c)
		for (Point3d p : ring(30, c == 0 ? 1.0 : 0.2)) {
			skeleton.position.push_back(p + Point3d(4.0 * c, 0, 0));
			ofNode.push_back(c);
		}
	for (const auto& [a, b] : closed(30)) {
		skeleton.edges.push_back({a, b});
		skeleton.edges.push_back({a + 30, b + 30});
	}
	std::sort(skeleton.edges.begin(), skeleton.edges.end());
	for (int c : component)
		skeleton.node.push_back(30 * c);
	const CurveSkeleton inside =
		broughtInside(skeleton, surface.position, surface.triangles(), component, 2, ofNode);
	EXPECT_LT(outside(surface, inside), 1e-6);
	EXPECT_EQ(statistics(inside).components, 2);
	EXPECT_EQ(statistics(inside).cycles, 2);
	for (int A = 0; A < 30; ++A)
		EXPECT_EQ(inside.position[A], skeleton.position[A]);
}
