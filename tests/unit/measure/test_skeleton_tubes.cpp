// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/measure/skeleton_tubes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

constexpr int sides = 32;

CurveSkeleton chain(const std::vector<Point3d>& points, bool closed = false)
{
	CurveSkeleton s;
	s.position = points;
	for (int i = 1; i < int(points.size()); ++i)
		s.edges.push_back({i - 1, i});
	if (closed)
		s.edges.push_back({0, int(points.size()) - 1});
	return s;
}

SkeletonTubes tubesOf(const CurveSkeleton& s, double radius)
{
	return skeletonTubes(s, std::vector<double>(s.position.size(), radius), sides);
}

/// Euler characteristic and volume of a mesh that is a closed, oriented two-manifold, or the test fails.
struct Solid
{
	int euler = 0;
	double volume = 0;

	explicit Solid(const SkeletonTubes& tubes)
	{
		const SurfaceMesh mesh(tubes.points, tubes.triangles); // throws unless it is one
		EXPECT_EQ(mesh.vertexCount(), int(tubes.points.size())) << "each vertex is used";
		euler = mesh.vertexCount() - mesh.faceCount() / 2; // E = 3 F / 2
		volume = mesh.volume();
	}
};

} // namespace

TEST(SkeletonTubes, AStraightTubeIsACapsule)
{
	const double r = 0.3, length = 2;
	const Solid solid(
		tubesOf(chain({{0, 0, 0}, {0.5, 0.5, 0}, {std::sqrt(2.0), std::sqrt(2.0), 0}}), r));
	EXPECT_EQ(solid.euler, 2);
	const double capsule = M_PI * r * r * length + 4 * M_PI / 3 * r * r * r;
	EXPECT_NEAR(solid.volume / capsule, 1, 0.015) << "32 sides: 0.994 of a circle's area";
}

TEST(SkeletonTubes, ARingOfAKnotHasOneHandleAndNoSeam)
{
	// A trefoil: its frame comes back twisted.
	std::vector<Point3d> points;
	double length = 0;
	for (int i = 0; i < 300; ++i) {
		const double t = 2 * M_PI * i / 300;
		points.emplace_back(
			std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t));
	}
	for (size_t i = 0; i < points.size(); ++i)
		length += vcg::Distance(points[i], points[(i + 1) % points.size()]);
	const double r = 0.1;
	const SkeletonTubes tubes = tubesOf(chain(points, true), r);
	const Solid solid(tubes);
	EXPECT_EQ(solid.euler, 0);
	EXPECT_NEAR(solid.volume / (M_PI * r * r * length), 1, 0.015) << "a seam would pinch it";
	for (size_t i = 0; i < tubes.points.size(); ++i)
		EXPECT_NEAR(vcg::Distance(tubes.points[i], points[size_t(tubes.node[i])]), r, 1e-9);
}

TEST(SkeletonTubes, EachBranchAndEachLonelyNodeIsASolidOfItsOwn)
{
	CurveSkeleton s = chain({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
	s.position.emplace_back(1, 1, 0);
	s.edges.push_back({1, 3});
	s.position.emplace_back(9, 9, 9);
	const SkeletonTubes tubes = tubesOf(s, 0.2);
	EXPECT_EQ(tubes.pieces, 4);
	EXPECT_EQ(Solid(tubes).euler, 8);
	std::vector<char> seen(5, 0);
	for (int node : tubes.node)
		seen[size_t(node)] = 1;
	EXPECT_EQ(seen, std::vector<char>(5, 1));
}

TEST(SkeletonTubes, TheRadiusIsThatOfTheNode)
{
	const CurveSkeleton s = chain({{0, 0, 0}, {3, 0, 0}, {6, 0, 0}});
	const std::vector<double> radius {0.5, 1, 0.25};
	const SkeletonTubes tubes = skeletonTubes(s, radius, sides);
	for (size_t i = 0; i < tubes.points.size(); ++i) {
		const size_t node = size_t(tubes.node[i]);
		EXPECT_NEAR(vcg::Distance(tubes.points[i], s.position[node]), radius[node], 1e-12);
	}
}

TEST(SkeletonTubes, DoubleBackAndCoincidentNodesAreClosedToo)
{
	const Solid solid(tubesOf(chain({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}), 0.1));
	EXPECT_EQ(solid.euler, 2);
	EXPECT_EQ(Solid(tubesOf(chain({{1, 1, 1}, {1, 1, 1}}), 0.1)).euler, 2);
}

TEST(SkeletonTubes, TooManyPointsAreRefusedBeforeAnyIsMade)
{
	const CurveSkeleton open = chain({{0, 0, 0}, {1, 0, 0}});
	for (int tooMany : {4473, 100000, std::numeric_limits<int>::max()})
		EXPECT_THROW(skeletonTubes(open, {1, 1}, tooMany), InvalidParameter) << tooMany;
	const CurveSkeleton ring = chain({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, true);
	EXPECT_EQ(skeletonTubes(ring, {0.1, 0.1, 0.1, 0.1}, 10000).points.size(), 40000)
		<< "a ring has no ends";
	EXPECT_THROW(skeletonTubes(ring, {0.1, 0.1, 0.1, 0.1}, 2500001), InvalidParameter);
	try {
		skeletonTubes(open, {1, 1}, 100000);
	}
	catch (const InvalidParameter& error) {
		EXPECT_NE(std::string(error.what()).find("5000000002 points"), std::string::npos)
			<< error.what();
	}
}

TEST(SkeletonTubes, AreCountedBeforehand)
{
	for (int n : {3, 4, 5, 12, 33})
		for (const bool closed : {false, true}) {
			const CurveSkeleton s = chain({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, closed);
			const std::vector<int> branch =
				closed ? std::vector<int> {0, 1, 2, 3, 0} : std::vector<int> {0, 1, 2, 3};
			EXPECT_EQ(double(skeletonTubes(s, {0.1, 0.1, 0.1, 0.1}, n).points.size()),
				detail::countTubePoints({detail::tubeChain(s, branch)}, n));
		}
}

TEST(SkeletonTubes, CanBeCancelledWithinATube)
{
	int reports = 0;
	const Progress progress([&](int percent, const char*) {
		++reports;
		return percent < 50;
	});
	const CurveSkeleton s = chain({{0, 0, 0}, {1, 0, 0}});
	EXPECT_THROW(skeletonTubes(s, {1, 1}, 1000, progress), Cancelled);
	EXPECT_GT(reports, 5);
}

TEST(SkeletonTubes, WhatCannotBeIsRefused)
{
	const CurveSkeleton s = chain({{0, 0, 0}, {1, 0, 0}});
	EXPECT_THROW(skeletonTubes(s, {1, 1}, 2), InvalidParameter);
	EXPECT_THROW(skeletonTubes(s, {1}, sides), InvalidInput);
	for (double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
		EXPECT_THROW(skeletonTubes(s, {1, bad}, sides), InvalidInput);
}
