// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/poles/poles.h>
#include <skeleton/poles/sizing_field.h>
#include <skeleton/resample/resample.h>
#include <skeleton/resample/resampled_surface.h>
#include <skeleton/resample/target_length.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

constexpr double relative = 0.6, thinRadius = 0.012;

/// A thick tube that narrows to a tube a fortieth as wide, about the x axis, with round ends.
shapes::Soup bottle(double wide = 0.5, double narrow = thinRadius, int sides = 24)
{
	std::vector<std::pair<double, double>> profile = {{-2, 0}};
	const auto add = [&](double x, double r) { profile.emplace_back(x, r); };
	for (int i = 1; i <= 8; ++i)
		add(-1.5 - wide * std::cos(i * M_PI / 16), wide * std::sin(i * M_PI / 16));
	for (double x = -1.3; x < 0; x += 0.1)
		add(x, wide);
	for (int i = 1; i <= 8; ++i) // a quarter of a ball, down to the neck
		add(wide * std::sin(i * M_PI / 18), wide * std::cos(i * M_PI / 18));
	for (double x = 0.55; x < 2; x += 0.02)
		add(x, narrow);
	for (int i = 0; i < 8; ++i)
		add(2 + narrow * std::sin(i * M_PI / 16), narrow * std::cos(i * M_PI / 16));
	add(2 + narrow, 0);
	return shapes::revolved(profile, sides);
}

SizingField fieldOf(const SurfaceMesh& mesh, double bound)
{
	const MeasuredSurface surface(mesh);
	return sizingField(surface, medialPoles(mesh, PoleMethod::Balls), relative,
		std::vector<double>(size_t(surface.components()), bound));
}

} // namespace

TEST(SizingField, IsTheGivenPartOfTheRadiusOfATube)
{
	const SurfaceMesh mesh = bottle().mesh();
	const SizingField field = fieldOf(mesh, 0.1);
	ASSERT_EQ(int(field.size()), mesh.vertexSlots());
	int seen = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.position[v][0] > 0.7 && mesh.position[v][0] < 1.9) {
			EXPECT_NEAR(field[v], relative * thinRadius, 0.15 * relative * thinRadius);
			++seen;
		}
	EXPECT_GT(seen, 1000);
}

TEST(SizingField, IsInfiniteWhereTheShapeIsThick)
{
	const SurfaceMesh mesh = bottle().mesh();
	const SizingField field = fieldOf(mesh, 0.1);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.position[v][0] < -0.3)
			EXPECT_TRUE(std::isinf(field[v]));
}

TEST(SizingField, GrowsByAtMostThreeTenthsOfTheWay)
{
	const SurfaceMesh mesh = bottle().mesh();
	constexpr double bound = 0.1;
	const SizingField field = fieldOf(mesh, bound);
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
		const double length = std::sqrt(mesh.squaredLength(h));
		const double here = field[mesh.origin(h)];
		EXPECT_LE(std::min(field[mesh.target(h)], bound), here + 0.3 * length * (1 + 1e-12));
	}
}

TEST(SizingField, SharpEdgesAreNotThin)
{
	// The balls next to the edges and corners of a box shrink to nothing, but the box is thick.
	shapes::Soup box = shapes::box(1, 1, 2);
	for (int i = 0; i < 7; ++i)
		box = shapes::subdivided(box);
	EXPECT_TRUE(fieldOf(box.mesh(), 0.1).empty());
}

TEST(SizingField, IsThatOfAComponentAlone)
{
	const shapes::Soup strip = shapes::transformed(
		shapes::cells(80, 8, 1, [](int, int, int) { return true; }),
		[](const vcg::Point3d& p) { return vcg::Point3d(0.05 * p[0], 0.05 * p[1], 0.02 * p[2]); });
	const SurfaceMesh alone = strip.mesh();
	const SizingField field = fieldOf(alone, 0.1);
	ASSERT_FALSE(field.empty());
	// The other one lies on it, back to back.
	const shapes::Soup other = shapes::moved(strip, {0, 0, 0.02});
	for (const bool isFirst : {true, false}) {
		const SurfaceMesh both =
			(isFirst ? shapes::joined({strip, other}) : shapes::joined({other, strip})).mesh();
		const SizingField beside = fieldOf(both, 0.1);
		ASSERT_EQ(int(beside.size()), both.vertexSlots());
		const size_t first = isFirst ? 0 : field.size();
		for (size_t v = 0; v < field.size(); ++v)
			EXPECT_NEAR(beside[first + v], field[v], 1e-9);
	}
}

TEST(SizingField, PlacesBelowASmallerBoundAreThoseFoundWithIt)
{
	const SurfaceMesh mesh = bottle().mesh();
	const MeasuredSurface surface(mesh);
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const auto placesBelow = [&](double bound) {
		return thinPlaces(surface, poles, relative, smallLengths(surface, {bound}));
	};
	const ThinPlaces all = placesBelow(std::numeric_limits<double>::infinity());
	ASSERT_FALSE(all.seeds.empty());
	const double inTube = relative * thinRadius;
	for (double bound : {2 * inTube, 0.5 * inTube}) {
		const ThinPlaces few =
			thinPlacesBelow(all, smallLengths(surface, {bound}), surface.component(), relative);
		EXPECT_EQ(few.below, placesBelow(bound).below);
		EXPECT_EQ(few.seeds, placesBelow(bound).seeds);
		EXPECT_EQ(few.seeds.empty(), bound < inTube);
	}
}

TEST(SizingField, AShapeOfOneScaleHasNone)
{
	const SurfaceMesh torus = shapes::torus(1, 0.3, 90, 30).mesh();
	EXPECT_TRUE(fieldOf(torus, 0.02).empty());
}

TEST(SizingField, RingsDoNotSpreadThroughTheHubsOfFans)
{
	// A thin disc whose caps are fans: the hubs are next to all vertices of their rims.
	constexpr int around = 20000;
	constexpr double height = 0.01;
	const SurfaceMesh mesh =
		shapes::revolved({{0, 0}, {0, 1}, {height, 1}, {height, 0}}, around).mesh();
	PoleSet poles;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const vcg::Point3d& p = mesh.position[v];
		poles.centre.emplace_back(height / 2, p[1], p[2]);
		poles.radius.push_back(height / 2);
	}
	const detail::NeighbourLists neighbours(mesh, Progress());
	detail::RingScratch rings(mesh.vertexSlots()), scratch(mesh.vertexSlots());
	size_t total = 0, hubs = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		detail::twoRings(neighbours, v, rings);
		total += rings.around.size();
		EXPECT_TRUE(detail::isThin(mesh, neighbours, poles.radius, height, v, scratch));
		total += scratch.around.size();
		hubs += neighbours.valence(v) == around;
	}
	EXPECT_EQ(hubs, 2u);
	EXPECT_LT(total, 80u * around);
	for (double radius : detail::medianRadii(
			 neighbours, poles, std::vector<char>(poles.radius.size(), 1), Progress()))
		ASSERT_EQ(radius, height / 2);
}

TEST(SizingField, WhereNoBallAroundIsLargerTheRingsNeedNotBeWalked)
{
	const SurfaceMesh mesh = bottle().mesh();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	const detail::NeighbourLists neighbours(mesh, Progress());
	const std::vector<double> radius = detail::medianRadii(
		neighbours, poles, std::vector<char>(poles.radius.size(), 1), Progress());
	const std::vector<double> largest = detail::largestAround(neighbours, radius, Progress());
	detail::RingScratch walked(mesh.vertexSlots()), bounded(mesh.vertexSlots());
	int thin = 0, notWalked = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		EXPECT_GE(largest[v], radius[v]);
		const double unbounded = std::numeric_limits<double>::infinity();
		const bool isThin = detail::isThin(mesh, neighbours, radius, unbounded, v, walked);
		EXPECT_EQ(detail::isThin(mesh, neighbours, radius, largest[v], v, bounded), isThin) << v;
		for (int w : walked.around)
			EXPECT_LE(radius[w], largest[v]) << v;
		thin += isThin;
		notWalked += bounded.around.empty() || bounded.around.front() != v;
	}
	EXPECT_GT(thin, mesh.vertexCount() / 2);
	EXPECT_GT(notWalked, mesh.vertexCount() / 4);
}

TEST(SizingField, OneThatIsKnownIsTakenForItsBoundOnly)
{
	const SurfaceMesh mesh = bottle().mesh();
	const MeasuredSurface surface(mesh);
	const PoleSet poles = medialPoles(surface, PoleMethod::Balls);
	BoundedField known = boundedField(surface, poles, relative, {0.05}, nullptr);
	EXPECT_EQ(known.length, sizingField(surface, poles, relative, {0.05}));
	known.length.assign(known.length.size(), 0.01);
	EXPECT_EQ(
		boundedField(surface, poles, relative, {0.05 * (1 + 1e-15)}, &known).length, known.length);
	for (const double bound : {0.04, 0.06})
		EXPECT_EQ(boundedField(surface, poles, relative, {bound}, &known).length,
			sizingField(surface, poles, relative, {bound}))
			<< bound;
}

TEST(SizingField, ThinPlacesServeEveryBoundAboveWhatCountsAsSmall)
{
	const SurfaceMesh mesh = bottle().mesh();
	const MeasuredSurface surface(mesh);
	const PoleSet poles = medialPoles(surface, PoleMethod::Balls);
	const double small = neutralLength * surface.diagonal(0);
	const ThinPlaces places =
		thinPlaces(surface, poles, 0.2 * relative, smallLengths(surface, {1}));
	EXPECT_EQ(places.below, std::vector<double>(1, small));
	ASSERT_FALSE(places.seeds.empty());
	for (const auto& [length, v] : places.seeds) {
		EXPECT_LT(length, small);
		EXPECT_EQ(length, places.length[size_t(v)]);
	}
	for (const double bound : {small, 2 * small, 5 * small}) {
		const SizingField field = gradedField(surface, places, {bound});
		EXPECT_EQ(field, sizingField(surface, poles, 0.2 * relative, {bound})) << bound;
		for (const double length : field)
			EXPECT_TRUE(length < bound || std::isinf(length));
	}
	EXPECT_TRUE(gradedField(surface, ThinPlaces(), {small}).empty()) << "nothing is thin";
}

TEST(SizingField, NoiseIsNotThin)
{
	// The balls between the spikes are as small as those of a thin tube, on a ball that is nowhere thin.
	const shapes::Soup ball = shapes::sphere(6);
	for (const double noise : {0.01, 0.02, 0.05})
		EXPECT_TRUE(fieldOf(shapes::jittered(ball, noise).mesh(), 0.02).empty()) << noise;
}

TEST(SizingField, AThinTubeIsThinInNoiseThatIsLessThanItsRadius)
{
	const SurfaceMesh mesh = shapes::jittered(bottle(), 0.1 * thinRadius).mesh();
	const SizingField field = fieldOf(mesh, 0.1);
	ASSERT_FALSE(field.empty());
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.position[v][0] > 0.7 && mesh.position[v][0] < 1.9)
			EXPECT_LT(field[v], 1.2 * relative * thinRadius);
}

TEST(SizingField, ScalesWithTheShape)
{
	const SizingField one = fieldOf(bottle().mesh(), 0.1);
	const SizingField other = fieldOf(shapes::scaled(bottle(), 1e3).mesh(), 0.1 * 1e3);
	ASSERT_EQ(one.size(), other.size());
	for (size_t v = 0; v < one.size(); ++v)
		if (std::isfinite(one[v]))
			EXPECT_NEAR(other[v] / one[v], 1e3, 1e-3);
}

TEST(SizingField, AdaptiveResamplingGivesAThinTubeItsVerticesAround)
{
	const SurfaceMesh mesh = bottle().mesh();
	const MeasuredSurface surface(mesh);
	const std::vector<double> length = {0.08};
	const SizingField field = fieldOf(mesh, length[0]);
	const SurfaceMesh fine = resample(surface, length, 5, Progress(), field);
	double thin = 0, thick = 0;
	int thinEdges = 0, thickEdges = 0, around = 0;
	for (int h = 0; h < fine.halfEdgeSlots(); ++h) {
		const double x = fine.position[fine.origin(h)][0], y = fine.position[fine.target(h)][0];
		if (std::min(x, y) > 0.8 && std::max(x, y) < 1.8) {
			thin += std::sqrt(fine.squaredLength(h));
			++thinEdges;
		}
		else if (std::max(x, y) < -0.5) {
			thick += std::sqrt(fine.squaredLength(h));
			++thickEdges;
		}
		around += x < 1.3 && y >= 1.3;
	}
	ASSERT_GT(thinEdges, 0);
	ASSERT_GT(thickEdges, 0);
	EXPECT_NEAR(thin / thinEdges, relative * thinRadius, 0.25 * relative * thinRadius);
	EXPECT_NEAR(thick / thickEdges, 0.08, 0.02);
	// About twice as many edges cross a plane as there are vertices around.
	EXPECT_GE(around, 14);
	const double expected = expectedVertices(surface, length, field);
	EXPECT_NEAR(fine.vertexCount() / expected, 1, 0.4);
}

TEST(SizingField, ResamplingWithAFieldThatBindsNowhereIsThatWithout)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	const MeasuredSurface surface(mesh);
	const SizingField field(size_t(mesh.vertexSlots()), 1.0);
	const SurfaceMesh one = resample(surface, {0.1}, 3);
	const SurfaceMesh other = resample(surface, {0.1}, 3, Progress(), field);
	ASSERT_EQ(one.vertexSlots(), other.vertexSlots());
	for (int v = 0; v < one.vertexSlots(); ++v)
		EXPECT_EQ(one.position[v], other.position[v]);
}

TEST(SizingField, ThatCostsTooMuchIsLongerEverywhereFirst)
{
	const SurfaceMesh mesh = bottle().mesh();
	const MeasuredSurface surface(mesh);
	const std::vector<double> length = {0.08};
	const SizingField given = fieldOf(mesh, length[0]);
	const auto cost = [&](const SizingField& f) { return expectedVertices(surface, length, f); };
	const double minimum = *std::min_element(given.begin(), given.end());
	constexpr double factor = 1.6;

	SizingField field = given;
	const double maximum = 0.7 * cost(given);
	EXPECT_EQ(coarsenToCost(field, factor, length[0], maximum, cost), 0);
	EXPECT_LE(cost(field), maximum);
	EXPECT_GT(cost(field), 0.99 * maximum);
	const double by = *std::min_element(field.begin(), field.end()) / minimum;
	EXPECT_GT(by, 1);
	EXPECT_LT(by, factor);
	for (size_t v = 0; v < field.size(); ++v)
		if (std::isfinite(given[v]))
			EXPECT_NEAR(field[v] / given[v], by, 1e-9);

	field = given;
	const double few = 0.45 * cost(given);
	const double raised = coarsenToCost(field, factor, length[0], few, cost);
	EXPECT_GT(raised, factor * minimum);
	EXPECT_LE(cost(field), few);
	for (size_t v = 0; v < field.size(); ++v)
		if (std::isfinite(given[v]))
			EXPECT_NEAR(field[v], std::max(factor * given[v], raised), 1e-9);
}

TEST(SizingField, AMeshBeyondTheBudgetResolvesWhatItCanAndSaysWhatItDoesNot)
{
	const std::vector<double> length = {0.08};
	std::string said;
	const auto fieldOfNeck = [&](const SurfaceMesh& mesh) {
		said.clear();
		return fieldOfResampling(MeasuredSurface(mesh), length, Parameters(), std::nullopt,
			budgetOf(mesh), Progress(), [&](const std::string& text) { said += text + "\n"; });
	};
	constexpr int sides = 5; // few vertices, and thirty edges for each
	for (const auto& [narrow, words] : {std::pair(0.003, "longer there than relative_length"),
			 std::pair(0.0015, "what is thinner than a radius of")}) {
		SCOPED_TRACE(narrow);
		const SurfaceMesh mesh = bottle(0.5, narrow, sides).mesh();
		const MeasuredSurface surface(mesh);
		const std::optional<SizingField> field = fieldOfNeck(mesh);
		EXPECT_NE(said.find(words), std::string::npos) << said;
		ASSERT_TRUE(field);
		EXPECT_LE(expectedVertices(surface, length, *field), budgetOf(mesh).vertices);
		const double shortest = *std::min_element(field->begin(), field->end());
		EXPECT_GT(shortest, relative * narrow);
		EXPECT_LT(shortest, 1.5 * narrow);
	}
	EXPECT_FALSE(fieldOfNeck(bottle(0.5, 0.0002, sides).mesh())); // as good as none
	EXPECT_NE(said.find("the same everywhere"), std::string::npos) << said;
}
