// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Skeletons sampled anew and smoothed: edge lengths, what stays, what is flattened.

#include "curves.h"
#include <skeleton/graph/resample_skeleton.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

std::vector<double> edgeLengths(const CurveSkeleton& s)
{
	std::vector<double> lengths;
	for (const auto& [a, b] : s.edges)
		lengths.push_back(vcg::Distance(s.position[a], s.position[b]));
	return lengths;
}

double longest(const CurveSkeleton& s)
{
	const std::vector<double> lengths = edgeLengths(s);
	return *std::max_element(lengths.begin(), lengths.end());
}

double shortest(const CurveSkeleton& s)
{
	const std::vector<double> lengths = edgeLengths(s);
	return *std::min_element(lengths.begin(), lengths.end());
}

/// Two rings joined by a bar, a twig on the bar, a chord in one ring: ends, junctions, cycles.
CurveSkeleton spectacles()
{
	CurveSkeleton s = circle(3, 0.5, 12);
	const int bar = addLine(s, 0, {10, 0, 0}, 0.4, 7);
	const int ring = addLine(s, bar, {12, 2, 0}, 0.4, 2);
	addEdge(s, addLine(s, ring, {12, -2, 0}, 0.4, 3), bar);
	addLine(s, 14, {s.position[14][0], 4, 1}, 0.2, 3);
	addEdge(s, 3, 9);
	return tracked(s);
}

/// Places of all nodes of degree other than 2, sorted.
std::vector<Point3d> specialPlaces(const CurveSkeleton& s)
{
	std::vector<Point3d> places;
	const auto neighbours = s.neighbours();
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() != 2)
			places.push_back(s.position[v]);
	std::sort(places.begin(), places.end());
	return places;
}

TEST(ResampleSkeleton, NoEdgeIsLongerAndAllAreAlike)
{
	for (double h : {0.01, 0.1, 0.77}) {
		const CurveSkeleton r = resampledSkeleton(spectacles(), h);
		EXPECT_LE(longest(r), h * (1 + 1e-9));
		const double minimum = h < 0.5 ? 0.9 : 0.5; // the last one is of branches hardly longer
		EXPECT_GT(shortest(r), minimum * h);
	}
}

TEST(ResampleSkeleton, AStraightLineIsCutInEqualParts)
{
	CurveSkeleton uneven = line({0, 0, 0}, {1, 0, 0}, 1, 1);
	for (double x : {1.01, 1.02, 1.7, 3.0})
		addLine(uneven, int(uneven.position.size()) - 1, {x, 0, 0}, 1, 1);
	const CurveSkeleton r = resampledSkeleton(uneven, 0.25);
	EXPECT_EQ(r.edges.size(), 12u);
	for (double length : edgeLengths(r))
		EXPECT_NEAR(length, 0.25, 1e-12);
}

TEST(ResampleSkeleton, GraphStaysInItsPlaces)
{
	const CurveSkeleton s = spectacles();
	const SkeletonStatistics before = statistics(s);
	for (double h : {0.05, 2.0, 100.0})
		for (double smoothing : {0.0, 0.3}) {
			const CurveSkeleton r = resampledSkeleton(s, h, smoothing);
			const SkeletonStatistics after = statistics(r);
			EXPECT_EQ(after.components, before.components);
			EXPECT_EQ(after.cycles, before.cycles) << h;
			EXPECT_EQ(after.branches, before.branches);
			EXPECT_EQ(after.terminals, before.terminals);
			EXPECT_EQ(after.junctions, before.junctions);
			EXPECT_EQ(specialPlaces(r), specialPlaces(s));
			EXPECT_TRUE(std::is_sorted(r.edges.begin(), r.edges.end()));
			EXPECT_EQ(std::adjacent_find(r.edges.begin(), r.edges.end()), r.edges.end());
		}
}

TEST(ResampleSkeleton, LengthStaysWhereItIsSampledFinely)
{
	const CurveSkeleton s = spectacles();
	EXPECT_NEAR(statistics(resampledSkeleton(s, 0.002)).length, statistics(s).length,
		1e-3 * statistics(s).length);
}

TEST(ResampleSkeleton, RadiusIsInterpolated)
{
	CurveSkeleton s = line({0, 0, 0}, {4, 0, 0}, 1, 1);
	s.radius = {1, 3};
	const CurveSkeleton r = resampledSkeleton(s, 0.1);
	for (size_t v = 0; v < r.position.size(); ++v)
		EXPECT_NEAR(r.radius[v], 1 + r.position[v][0] / 2, 1e-12);
}

TEST(ResampleSkeleton, CorrespondenceGoesToTheNearestAlongTheBranch)
{
	const CurveSkeleton s = spectacles();
	for (double h : {0.05, 0.4}) {
		const CurveSkeleton r = resampledSkeleton(s, h);
		for (size_t v = 0; v < s.position.size(); ++v)
			EXPECT_LE(vcg::Distance(s.position[v], r.position[r.node[v]]), 1.2 * h) << v;
	}
}

TEST(ResampleSkeleton, NodesWithoutCorrespondenceKeepNone)
{
	CurveSkeleton s = line({0, 0, 0}, {4, 0, 0}, 1, 4);
	s.node = {-1, 2, -1};
	const CurveSkeleton r = resampledSkeleton(s, 0.5);
	EXPECT_EQ(r.node[0], -1);
	EXPECT_EQ(r.position[r.node[1]], Point3d(2, 0, 0));
}

/// A wave of the given length and height along x; 20 wave lengths.
CurveSkeleton wave(double length, double height)
{
	CurveSkeleton s;
	const int perWave = 40, count = 20 * perWave;
	for (int i = 0; i <= count; ++i) {
		const double x = length * i / perWave;
		addNode(s, {x, height * std::sin(2 * M_PI * x / length), 0}, 1);
		if (i)
			addEdge(s, i - 1, i);
	}
	return s;
}

double heightInTheMiddle(const CurveSkeleton& s)
{
	double end = 0, height = 0;
	for (const Point3d& p : s.position)
		end = std::max(end, p[0]);
	for (const Point3d& p : s.position)
		if (p[0] > end / 4 && p[0] < 3 * end / 4)
			height = std::max(height, std::abs(p[1]));
	return height;
}

TEST(ResampleSkeleton, SmoothingFlattensShortWavesByTheKnownFactor)
{
	// A wave of frequency w is left with 1 / (1 + (w l)^4) of its height.
	const double length = 1, height = 0.005;
	for (double l : {0.05, 0.159, 0.3}) {
		const double w = 2 * M_PI / length;
		const double left =
			heightInTheMiddle(resampledSkeleton(wave(length, height), 0.01, l)) / height;
		EXPECT_NEAR(left, 1 / (1 + std::pow(w * l, 4)), 0.02) << l;
	}
}

TEST(ResampleSkeleton, SmoothingDoesNotDependOnTheSampling)
{
	const double coarse = heightInTheMiddle(resampledSkeleton(wave(1, 0.005), 0.02, 0.15));
	const double fine = heightInTheMiddle(resampledSkeleton(wave(1, 0.005), 0.002, 0.15));
	EXPECT_NEAR(coarse, fine, 0.03 * fine);
}

TEST(ResampleSkeleton, NoPointLeavesTheBoxOfItsBranch)
{
	// A straight line that turns at a right angle near its end: a spline swings out of the corner.
	CurveSkeleton corner;
	for (int i = 0; i <= 40; ++i)
		corner.position.emplace_back(0.05 * std::min(i, 36), 0.05 * std::max(i - 36, 0), 0);
	for (int i = 0; i < 40; ++i)
		corner.edges.push_back({i, i + 1});
	corner.radius.assign(41, 0.1);
	corner.node = {0};
	const CurveSkeleton smooth = resampledSkeleton(corner, 0.01, 0.1);
	double nearest = 1; // to the corner
	for (const Point3d& p : smooth.position) {
		EXPECT_GE(p[0], 0);
		EXPECT_LE(p[0], 1.8);
		EXPECT_GE(p[1], 0);
		EXPECT_LE(p[1], 0.2);
		nearest = std::min(nearest, Distance(p, Point3d(1.8, 0, 0)));
	}
	EXPECT_GT(nearest, 0.01) << "it is smoothed";
}

TEST(ResampleSkeleton, SmoothingHardlyShrinksALargeCircle)
{
	const CurveSkeleton r = resampledSkeleton(circle(5, 1, 200), 0.05, 0.5);
	for (const Point3d& p : r.position)
		EXPECT_NEAR(p.Norm(), 5, 0.01);
	EXPECT_LE(longest(r), 0.05 * (1 + 1e-9));
}

TEST(ResampleSkeleton, SameResultAnywhereAtAnySize)
{
	const CurveSkeleton expected = resampledSkeleton(spectacles(), 0.3, 0.2);
	for (double scale : {1e-6, 1e6}) {
		CurveSkeleton s = spectacles();
		for (Point3d& p : s.position)
			p = p * scale + Point3d(scale, -3 * scale, 0);
		const CurveSkeleton r = resampledSkeleton(s, 0.3 * scale, 0.2 * scale);
		EXPECT_EQ(r.edges, expected.edges);
		for (size_t v = 0; v < r.position.size(); ++v)
			EXPECT_LT(vcg::Distance((r.position[v] - Point3d(scale, -3 * scale, 0)) / scale,
						  expected.position[v]),
				1e-9);
	}
}

TEST(ResampleSkeleton, BranchOfLengthZeroIsKept)
{
	CurveSkeleton s;
	const int a = addNode(s, {1, 1, 1}, 1), b = addNode(s, {1, 1, 1}, 1);
	addEdge(s, a, b);
	const CurveSkeleton r = resampledSkeleton(s, 0.1, 0.1);
	EXPECT_EQ(r.position.size(), 2u);
	EXPECT_EQ(r.edges.size(), 1u);
}

TEST(ResampleSkeleton, RefusesParametersOutOfRange)
{
	const CurveSkeleton s = spectacles();
	EXPECT_THROW(resampledSkeleton(s, 0), InvalidParameter);
	EXPECT_THROW(resampledSkeleton(s, NAN), InvalidParameter);
	EXPECT_THROW(resampledSkeleton(s, 0.1, -1), InvalidParameter);
	EXPECT_THROW(resampledSkeleton(s, 1e-9), InvalidParameter);
	EXPECT_THROW(resampledSkeleton(s, 0.1, 1e-9), InvalidParameter);
}

TEST(ResampleSkeleton, AnEdgeThatIsTooShortIsAnsweredWithOneThatIsTaken)
{
	const CurveSkeleton large = spectacles();
	CurveSkeleton small = large;
	for (Point3d& p : small.position)
		p = p * 1e-7;
	for (const CurveSkeleton& s : {large, small})
		for (double longest : {1e-30, 1e-300})
			try {
				resampledSkeleton(s, longest);
				ADD_FAILURE() << longest;
			}
			catch (const InvalidParameter& error) {
				const std::string text = error.what(), before = "at least ";
				EXPECT_NE(text.find("more than 1e15 nodes"), std::string::npos) << text;
				const double enough = std::stod(text.substr(text.find(before) + before.size()));
				EXPECT_THROW(resampledSkeleton(
								 s, enough, 0, Progress([](int, const char*) { return false; })),
					Cancelled)
					<< text;
				EXPECT_THROW(resampledSkeleton(s, 0.98 * enough), InvalidParameter);
			}
}

TEST(ResampleSkeleton, ACycleFarBelowTheSmoothingLengthIsSmoothedToo)
{
	// A large V, and a cycle at its corner that is a millionth of it.
	for (double small : {1e-3, 1e-6, 1e-9, 1e-12}) {
		CurveSkeleton s;
		s.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-small, 0, 0}, {0, -small, small}};
		s.radius.assign(5, 0.1);
		s.edges = {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {3, 4}};
		const CurveSkeleton smooth = resampledSkeleton(s, 0.02, 0.02);
		EXPECT_EQ(statistics(smooth).cycles, 1) << small;
		EXPECT_EQ(statistics(smooth).components, 1) << small;
		EXPECT_NEAR(statistics(smooth).length, 2, 0.01) << small;
	}
}

TEST(ResampleSkeleton, WhatIsTooFarAwayForItsSizeDoesNotBecomeAMillionNodes)
{
	// At 2e18 coordinates are 256 apart: the zigzag is there, but nothing between its places.
	CurveSkeleton s;
	for (int i = 0; i < 12; ++i) {
		s.position.emplace_back(i, i % 2, 2e18);
		s.radius.push_back(1);
		if (i > 0)
			s.edges.push_back({i - 1, i});
	}
	const double length = statistics(s).length;
	try {
		const CurveSkeleton smooth = resampledSkeleton(s, 0.1, 0.1);
		EXPECT_LE(statistics(smooth).length, 2 * length);
		EXPECT_LE(smooth.position.size(), 2 * length / 0.1 + 2);
	}
	catch (const SolverError&) {
		// As good.
	}
	for (Point3d& p : s.position)
		p[2] = 0;
	EXPECT_NO_THROW(resampledSkeleton(s, 0.1, 0.1));
}

TEST(ResampleSkeleton, CanBeCancelled)
{
	EXPECT_THROW(
		resampledSkeleton(spectacles(), 0.1, 0, Progress([](int, const char*) { return false; })),
		Cancelled);
}

} // namespace
