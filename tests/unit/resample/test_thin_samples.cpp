// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/resample/resampled_surface.h>
#include <skeleton/resample/thin_samples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A rod of radius 1 and length 400 with rings of 12 vertices, three near each end, and as many in
/// between.
shapes::Soup roundRod(int between)
{
	std::vector<std::pair<double, double>> profile = {{-1, 0}, {0, 1}, {2, 1}, {4, 1}};
	for (int i = 1; i <= between; ++i)
		profile.emplace_back(4 + 392.0 * i / (between + 1), 1);
	for (double x : {396, 398, 400})
		profile.emplace_back(x, 1);
	profile.emplace_back(401, 0);
	return shapes::revolved(profile, 12);
}

std::optional<SurfaceMesh> sampledEverywhereThin(
	const SurfaceMesh& mesh, double thickness, double maxVertices = 4e5)
{
	return withThinPartsSampled(mesh, std::vector<double>(size_t(mesh.vertexSlots()), thickness),
		{3 * thickness}, maxVertices);
}

/// The longest stretch along the rod without a sample.
double longestGapAlong(const SurfaceMesh& mesh)
{
	std::vector<double> x;
	for (const Point3d& p : mesh.position)
		x.push_back(p[0]);
	std::sort(x.begin(), x.end());
	double gap = 0;
	for (size_t i = 1; i < x.size(); ++i)
		gap = std::max(gap, x[i] - x[i - 1]);
	return gap;
}

} // namespace

TEST(ThinSamples, ARodInLongTrianglesHasThemAllAlong)
{
	const SurfaceMesh rod = roundRod(0).mesh();
	const std::optional<SurfaceMesh> sampled = sampledEverywhereThin(rod, 1);
	ASSERT_TRUE(sampled);
	EXPECT_EQ(checks::structureError(*sampled), "");
	EXPECT_LE(longestGapAlong(*sampled), longestOfThickness);
	EXPECT_LT(sampled->vertexCount(), 20000);
	EXPECT_NEAR(sampled->volume(), rod.volume(), 1e-9 * rod.volume());
	EXPECT_TRUE(std::equal(rod.position.begin(), rod.position.end(), sampled->position.begin()));
}

TEST(ThinSamples, NothingIsDoneWhereEdgesAreShortOrNothingIsThin)
{
	EXPECT_FALSE(sampledEverywhereThin(roundRod(200).mesh(), 1));
	const SurfaceMesh rod = roundRod(0).mesh();
	EXPECT_FALSE(sampledEverywhereThin(rod, std::numeric_limits<double>::infinity()));
}

TEST(ThinSamples, ALimitedNumberIsSpreadThinnerThenNoneIsAdded)
{
	const SurfaceMesh rod = roundRod(0).mesh();
	const double usual = sampledEverywhereThin(rod, 1)->vertexCount();
	const std::optional<SurfaceMesh> fewer = sampledEverywhereThin(rod, 1, 0.7 * usual);
	ASSERT_TRUE(fewer);
	EXPECT_LT(fewer->vertexCount(), usual);
	EXPECT_LE(longestGapAlong(*fewer), 2 * longestOfThickness);
	EXPECT_FALSE(sampledEverywhereThin(rod, 1, 0.1 * usual));
}

TEST(ThinSamples, AReachingEdgeIsGradedFromItsThinEnd)
{
	const SurfaceMesh rod = roundRod(0).mesh();
	std::vector<double> thickness;
	for (const Point3d& p : rod.position)
		thickness.push_back(p[0] < 200 ? 0.1 : std::numeric_limits<double>::infinity());
	const std::optional<SurfaceMesh> sampled = withThinPartsSampled(rod, thickness, {10}, 4e5);
	ASSERT_TRUE(sampled);
	int near = 0, far = 0;
	for (const Point3d& p : sampled->position)
		++(p[0] < 200 ? near : far);
	EXPECT_GT(near, 2 * far);
}

TEST(ThinSamples, ATubeIsResampledAlikeHoweverLongItsTrianglesAre)
{
	Parameters parameters;
	parameters.targetLength = 0.005; // of the diagonal: two radii
	parameters.relativeLength = 0.7; // what a mesh of so few vertices affords
	const ResampledSurface compact = resampledSurface(roundRod(400).mesh(), parameters);
	const ResampledSurface longTriangles = resampledSurface(roundRod(0).mesh(), parameters);
	EXPECT_FALSE(longTriangles.isTooThin);
	// Without samples it would be resampled to edges of two radii: a tenth of these vertices.
	EXPECT_GT(longTriangles.mesh.vertexCount(), 0.85 * compact.mesh.vertexCount());
	EXPECT_LT(longTriangles.mesh.vertexCount(), 2.0 * compact.mesh.vertexCount());
	EXPECT_NEAR(longTriangles.mesh.volume(), compact.mesh.volume(), 0.05 * compact.mesh.volume());
}

TEST(ThinSamples, ARodInLongTrianglesIsThinHoweverManyVerticesTheBodyHasThatItStandsOn)
{
	// A ball of radius 20 in compact triangles, and a rod of radius 0.1 with vertices at its ends.
	constexpr double ball = 20, rod = 0.1, end = 70;
	constexpr int rings = 48;
	std::vector<std::pair<double, double>> profile = {{-ball, 0}};
	for (int i = 1; i < rings; ++i)
		profile.emplace_back(-ball * std::cos(i * M_PI / rings), ball * std::sin(i * M_PI / rings));
	profile.insert(profile.end(), {{ball, rod}, {end, rod}, {end, 0}});
	const SurfaceMesh mesh = shapes::revolved(profile, 16).mesh();
	std::vector<std::string> notes;
	const ResampledSurface resampled = resampledSurface(
		mesh, Parameters(), Progress(), [&](const std::string& note) { notes.push_back(note); });
	int along = 0;
	double longest = 0;
	for (int h = 0; h < resampled.mesh.halfEdgeSlots(); ++h) {
		const Point3d &a = resampled.mesh.position[resampled.mesh.origin(h)],
					  &b = resampled.mesh.position[resampled.mesh.target(h)];
		if (std::min(a[0], b[0]) < 25 || std::max(a[0], b[0]) > 65)
			continue;
		++along;
		longest = std::max(longest, Distance(a, b));
	}
	EXPECT_GT(along, 1000);
	EXPECT_LT(longest, 2 * rod);
	ASSERT_FALSE(notes.empty());
	EXPECT_NE(notes.front().find("thin"), std::string::npos) << notes.front();
}

TEST(ThinSamples, AFlatConeInLongTrianglesIsNotThin)
{
	// More than half of its area is thin: only bodies with rods are resolved by so many vertices.
	for (const double height : {0.05, 0.07}) {
		const SurfaceMesh cone = shapes::revolved({{-height, 0}, {0, 1}, {height, 0}}, 185).mesh();
		Parameters parameters;
		const int adaptive = resampledSurface(cone, parameters).mesh.vertexCount();
		parameters.adaptive = false;
		EXPECT_EQ(adaptive, resampledSurface(cone, parameters).mesh.vertexCount()) << height;
	}
}

TEST(ThinSamples, ANeedleThinnerThanTheShortestEdgesIsResampledAsIfNothingWereThin)
{
	// The rod's radius is 0.25 % of its length; a hundredth of that is below the shortest edges.
	const auto vertices = [](double factor, bool adaptive) {
		Parameters parameters;
		parameters.targetLength = 0.005;
		parameters.adaptive = adaptive;
		const shapes::Soup soup = shapes::transformed(roundRod(0),
			[&](const Point3d& p) { return Point3d(p[0], factor * p[1], factor * p[2]); });
		return resampledSurface(soup.mesh(), parameters).mesh.vertexCount();
	};
	EXPECT_GT(vertices(1, true), 2 * vertices(1, false));
	EXPECT_EQ(vertices(0.01, true), vertices(0.01, false));
}
