// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/collapse/curve_inside.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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
