// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/input/check_input.h>
#include <skeleton/input/denoise.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace vcg::tri::mcf;

SurfaceMesh meshOf(const shapes::Soup& soup)
{
	return checkedSurface(soup.points, soup.triangles).mesh;
}

/// Moves each vertex by a normal deviate of the given standard deviation in each coordinate.
SurfaceMesh noisy(SurfaceMesh mesh, double sigma)
{
	std::mt19937 random(7);
	for (vcg::Point3d& p : mesh.position)
		for (int k = 0; k < 3; ++k) {
			// Twelve uniform deviates: the same numbers with every standard library.
			double sum = -6;
			for (int i = 0; i < 12; ++i)
				sum += double(random()) / double(std::mt19937::max());
			p[k] += sigma * sum;
		}
	return mesh;
}

/// Root mean square distance of the vertices from the sphere of radius 1.
double roughness(const SurfaceMesh& mesh)
{
	double sum = 0;
	for (const vcg::Point3d& p : mesh.position)
		sum += std::pow(p.Norm() - 1, 2);
	return std::sqrt(sum / double(mesh.position.size()));
}

NoiseLevel levelOf(const SurfaceMesh& mesh)
{
	return NoiseMeasure(mesh).levels()[0];
}

TEST(Noise, LevelIsTheDeviationThatWasAdded)
{
	const SurfaceMesh clean = meshOf(shapes::sphere(5));
	for (double sigma : {0.003, 0.01})
		EXPECT_NEAR(levelOf(noisy(clean, sigma)).deviation, sigma, 0.1 * sigma);
}

TEST(Noise, LevelScalesWithTheMesh)
{
	const SurfaceMesh mesh = noisy(meshOf(shapes::sphere(4)), 0.01);
	const double level = levelOf(mesh).deviation;
	for (double scale : {1e-6, 1e6}) {
		SurfaceMesh other = mesh;
		for (vcg::Point3d& p : other.position)
			p = p * scale + vcg::Point3d(1, 2, 3) * scale;
		EXPECT_NEAR(levelOf(other).deviation / scale, level, 1e-6 * level);
	}
}

TEST(Noise, CleanSurfacesAreLeftAlone)
{
	for (const shapes::Soup& soup : {shapes::sphere(3), shapes::sphere(5), shapes::torus(),
			 shapes::capsule(), shapes::box(), shapes::tetrahedron(), shapes::plate(3)}) {
		const NoiseReport report = measureNoise(meshOf(soup));
		EXPECT_FALSE(report.isNoisy());
	}
}

constexpr int coarseAround = 150;

/// A thin ring of seven sides, its vertices spread unevenly over the exact surface.
SurfaceMesh noisyRing()
{
	const double minor = 0.05;
	const int around = coarseAround, across = 7;
	std::mt19937 random(3);
	const auto deviate = [&] {
		return 0.7 * (double(random()) / double(std::mt19937::max()) - 0.5);
	};
	return meshOf(
		shapes::transformed(shapes::torus(1, minor, around, across), [&](const vcg::Point3d& p) {
			const double u = std::atan2(p[1], p[0]) + deviate() * 2 * M_PI / around;
			const double v =
				std::atan2(p[2], std::hypot(p[0], p[1]) - 1) + deviate() * 2 * M_PI / across;
			const double r = 1 + minor * std::cos(v);
			return vcg::Point3d(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
		}));
}

TEST(Noise, NeighboursTellNoiseFromFacets)
{
	const SurfaceMesh coarse = noisyRing();
	// Facets deviate by more than a twentieth of an edge, as noise would.
	const double edge = 2 * M_PI / coarseAround, diagonal = coarse.bounds().Diag();
	const NoiseLevel ofFacets = levelOf(coarse);
	EXPECT_GT(ofFacets.deviation, 0.05 * edge);
	EXPECT_GT(ofFacets.deviation, 3e-4 * diagonal);
	EXPECT_LT(ofFacets.whiteness, 0.4);
	EXPECT_FALSE(measureNoise(coarse).isNoisy());
	EXPECT_FALSE(measureNoise(noisy(coarse, 2e-4 * diagonal)).isNoisy());

	// On a shape of many edges across, noise of half an edge is seen as such.
	const SurfaceMesh rough = noisy(meshOf(shapes::sphere(5)), 0.5 * 0.035);
	EXPECT_GT(levelOf(rough).whiteness, 0.8);
	EXPECT_TRUE(measureNoise(rough).isNoisy());
}

TEST(Noise, MoreNoiseIsSmoothedMore)
{
	const SurfaceMesh clean = meshOf(shapes::sphere(5));
	const double diagonal = clean.bounds().Diag();
	const int few = measureNoise(noisy(clean, 1.2e-3 * diagonal)).rounds[0];
	const int many = measureNoise(noisy(clean, 5e-3 * diagonal)).rounds[0];
	EXPECT_GT(few, 0);
	EXPECT_GT(many, few);
}

TEST(Noise, OfThinPartsIsMeasuredByTheirThickness)
{
	// Of a ring, one half of which counts as thin. The diagonal does not matter to it, the thickness does.
	const double minor = 0.01;
	const SurfaceMesh clean = meshOf(shapes::torus(1, minor, 800, 10));
	std::vector<double> thickness;
	for (const vcg::Point3d& p : clean.position)
		thickness.push_back(p[0] > 0 ? minor : std::numeric_limits<double>::infinity());
	EXPECT_FALSE(measureNoise(clean, Progress(), thickness).isNoisy());
	for (const double part : {0.1, 0.3}) {
		const SurfaceMesh rough = noisy(clean, part * minor);
		const NoiseReport report = measureNoise(rough, Progress(), thickness);
		EXPECT_NEAR(report.ofThickness, part, 0.25 * part);
		EXPECT_GT(report.roundsWhereThin[0], 0);
		EXPECT_LT(report.level, 3e-4 + part * minor / clean.bounds().Diag());
		const std::vector<int> rounds =
			report.ofVertices(MeasuredSurface(rough).component(), thickness);
		for (size_t v = 0; v < rounds.size(); ++v)
			EXPECT_EQ(
				rounds[v], (thickness[v] == minor ? report.roundsWhereThin : report.rounds)[0]);
	}
}

TEST(Noise, WhatDeviatesByMoreThanTheThicknessIsShape)
{
	// A hair that bends at every ring, finely and coarsely.
	const double minor = 1e-4;
	for (const int around : {800, 12}) {
		const SurfaceMesh hair = meshOf(shapes::torus(1, minor, around, 3));
		const std::vector<double> thickness(hair.position.size(), minor);
		for (const double part : {3.0, 100.0}) {
			const NoiseReport report =
				measureNoise(noisy(hair, part * minor), Progress(), thickness);
			EXPECT_EQ(report.roundsWhereThin[0], 0) << around << " rings, " << part;
		}
	}
}

/// The noise of a rough ring that has 180 of its 200 cross-sections in the first fifth of its way
/// around, or all evenly spread, and counts as thin at these 180.
NoiseReport noiseOfRing(bool isEven)
{
	const double minor = 0.1, infinite = std::numeric_limits<double>::infinity();
	SurfaceMesh ring = meshOf(shapes::torus(1, minor, 200, 12));
	std::vector<double> thickness;
	for (vcg::Point3d& p : ring.position) {
		const double turn = std::atan2(p[1], p[0]) / (2 * M_PI) + 0.5;
		const double to = 2 * M_PI * (isEven ? turn : turn < 0.9 ? turn / 4.5 : 8 * turn - 7);
		const double away = std::hypot(p[0], p[1]);
		p = vcg::Point3d(away * std::cos(to), away * std::sin(to), p[2]);
		thickness.push_back(turn < 0.9 ? minor : infinite);
	}
	return measureNoise(noisy(ring, 0.015), Progress(), thickness);
}

TEST(Noise, IsNotMeasuredInLongTrianglesOfTheThickParts)
{
	// The mean edge of the whole surface is short: the thin parts have nearly all vertices.
	ASSERT_GT(noiseOfRing(true).rounds[0], 0);
	EXPECT_EQ(noiseOfRing(false).rounds[0], 0);
	EXPECT_GT(noiseOfRing(false).roundsWhereThin[0], 0);
}

TEST(Noise, OnlyTheNoisyComponentIsSmoothed)
{
	const SurfaceMesh clean = meshOf(shapes::sphere(5));
	const SurfaceMesh rough = noisy(clean, 0.01);
	shapes::Soup both = shapes::joined({{clean.position, clean.triangles()},
		shapes::moved({rough.position, rough.triangles()}, vcg::Point3d(5, 0, 0))});
	const SurfaceMesh mesh = meshOf(both);
	const NoiseReport report = measureNoise(mesh);
	ASSERT_EQ(report.rounds.size(), 2u);
	EXPECT_EQ(report.rounds[0], 0);
	EXPECT_GT(report.rounds[1], 0);
	const MeasuredSurface surface(mesh);
	const SurfaceMesh calm = smoothed(surface, report.ofVertices(surface.component(), {}));
	for (size_t v = 0; v < clean.position.size(); ++v)
		EXPECT_EQ(calm.position[v], mesh.position[v]);
}

TEST(Noise, TheReportIsOfWhatIsSmoothed)
{
	// Facets of a clean surface deviate more than the noise of the other one.
	const SurfaceMesh facets = noisyRing();
	const SurfaceMesh clean = meshOf(shapes::sphere(6));
	const SurfaceMesh rough = noisy(clean, 5e-4 * clean.bounds().Diag());
	const double ofFacets = measureNoise(facets).level, ofNoise = measureNoise(rough).level;
	ASSERT_GT(ofFacets, 1.2 * ofNoise) << "where nothing is smoothed, facets count";
	ASSERT_EQ(measureNoise(facets).maxRounds(), 0);
	const NoiseReport both =
		measureNoise(meshOf(shapes::joined({{facets.position, facets.triangles()},
			shapes::moved({rough.position, rough.triangles()}, vcg::Point3d(5, 0, 0))})));
	EXPECT_EQ(both.rounds[0], 0);
	EXPECT_GT(both.rounds[1], 0);
	EXPECT_NEAR(both.level, ofNoise, 1e-3 * ofNoise);
}

TEST(Noise, IsNotMeasuredNextToAHubOfManyTriangles)
{
	// A double cone, whose vertices have nearly all the others within two rings.
	const auto cones = [](int around) {
		return noisy(meshOf(shapes::revolved({{-1, 0}, {0, 1}, {1, 0}}, around)), 1e-3);
	};
	EXPECT_GT(levelOf(cones(100)).deviation, 1e-4);
	EXPECT_EQ(levelOf(cones(2000)).deviation, 0);
	EXPECT_FALSE(measureNoise(cones(2000)).isNoisy());
}

TEST(Noise, SmoothingRemovesNoiseAndKeepsTheVolume)
{
	const SurfaceMesh clean = meshOf(shapes::sphere(5));
	const SurfaceMesh rough = noisy(clean, 0.01);
	const SurfaceMesh calm = smoothed(rough, std::vector<int>(rough.position.size(), 40));
	EXPECT_LT(roughness(calm), 0.4 * roughness(rough));
	EXPECT_NEAR(calm.volume(), clean.volume(), 0.01 * clean.volume());
	EXPECT_EQ(calm.triangles(), rough.triangles());
}

TEST(Noise, SmoothingCanBeCancelled)
{
	const SurfaceMesh mesh = meshOf(shapes::sphere(2));
	const Progress stop([](int, const char*) { return false; });
	EXPECT_THROW(smoothed(mesh, std::vector<int>(mesh.position.size(), 10), stop), Cancelled);
}

} // namespace
