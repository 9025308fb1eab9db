// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/boundary_cones.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// The weights of the edges of triangles and cones together, those of opposite edges subtracted.
std::map<std::pair<int, int>, double> edgeSums(
	const shapes::Soup& soup, const std::vector<double>& weights, const BoundaryCones& cones)
{
	std::map<std::pair<int, int>, double> sums;
	const auto add = [&](const Triangle& t, double weight) {
		for (size_t k = 0; k < 3; ++k) {
			const int a = t[k], b = t[(k + 1) % 3];
			sums[{std::min(a, b), std::max(a, b)}] += a < b ? weight : -weight;
		}
	};
	for (size_t f = 0; f < soup.triangles.size(); ++f)
		add(soup.triangles[f], weights.empty() ? 1 : weights[f]);
	for (size_t f = 0; f < cones.triangles.size(); ++f)
		add(cones.triangles[f], cones.weights[f]);
	return sums;
}

void expectClosed(
	const shapes::Soup& soup, const std::vector<double>& weights, const BoundaryCones& cones)
{
	ASSERT_EQ(cones.triangles.size(), cones.weights.size());
	for (const auto& [edge, sum] : edgeSums(soup, weights, cones))
		EXPECT_NEAR(sum, 0, 1e-8) << edge.first << ' ' << edge.second;
}

/// The part of a sphere's faces for which `isKept` holds, of their middle.
template <class IsKept>
shapes::Soup partOfSphere(const IsKept& isKept)
{
	shapes::Soup soup = shapes::sphere(4);
	std::vector<Triangle> kept;
	for (const Triangle& t : soup.triangles)
		if (isKept(
				(soup.points[size_t(t[0])] + soup.points[size_t(t[1])] + soup.points[size_t(t[2])])
				/ 3.0))
			kept.push_back(t);
	soup.triangles = kept;
	return soup;
}

} // namespace

TEST(BoundaryCones, AClosedSurfaceHasNone)
{
	const shapes::Soup soup = shapes::torus();
	EXPECT_TRUE(boundaryCones(soup.points, soup.triangles, {}).triangles.empty());
	const std::vector<double> halves(soup.triangles.size(), 0.5);
	EXPECT_TRUE(boundaryCones(soup.points, soup.triangles, halves).triangles.empty());
}

TEST(BoundaryCones, CloseHoles)
{
	const shapes::Soup soup =
		partOfSphere([](const Point3d& p) { return p[2] > -0.3 && (p[2] < 0.7 || p[0] > 0.1); });
	const BoundaryCones cones = boundaryCones(soup.points, soup.triangles, {});
	EXPECT_FALSE(cones.triangles.empty());
	expectClosed(soup, {}, cones);
}

TEST(BoundaryCones, CloseWhatHasWeightsAndEdgesOfManyFaces)
{
	shapes::Soup soup = partOfSphere([](const Point3d& p) { return p[2] > 0; });
	soup.triangles.push_back(soup.triangles.front()); // twice
	soup.triangles.push_back({0, 1, int(soup.points.size())});
	soup.points.emplace_back(0.1, 0.2, 3); // a fin
	std::vector<double> weights;
	for (size_t f = 0; f < soup.triangles.size(); ++f)
		weights.push_back(f % 7 == 0 ? 1.0 / 3 : f % 5 == 0 ? -1 : 1);
	expectClosed(soup, weights, boundaryCones(soup.points, soup.triangles, weights));
}

TEST(BoundaryCones, CloseABorderInOnePlace)
{
	shapes::Soup soup;
	soup.points.assign(3, Point3d(0.3, 0.4, 0.5));
	soup.triangles = {{0, 1, 2}};
	expectClosed(soup, {}, boundaryCones(soup.points, soup.triangles, {}));
}

TEST(BoundaryCones, LieAroundTheBorder)
{
	// Small holes far apart: no cone leads from one to another.
	const shapes::Soup soup = partOfSphere([](const Point3d& p) { return std::abs(p[2]) < 0.97; });
	const BoundaryCones cones = boundaryCones(soup.points, soup.triangles, {});
	expectClosed(soup, {}, cones);
	for (const Triangle& t : cones.triangles)
		for (size_t k = 0; k < 3; ++k)
			EXPECT_LT(
				Distance(cones.points[size_t(t[k])], cones.points[size_t(t[(k + 1) % 3])]), 0.6);
}

TEST(BoundaryCones, AreFewerThanAFewForEachEdgeOfTheBorder)
{
	const shapes::Soup soup = partOfSphere([](const Point3d& p) { return p[0] + p[1] > 0.1; });
	size_t border = 0;
	for (const auto& [edge, sum] : edgeSums(soup, {}, BoundaryCones()))
		border += sum != 0;
	EXPECT_GT(border, 50u);
	EXPECT_LT(boundaryCones(soup.points, soup.triangles, {}).triangles.size(), 3 * border);
}

TEST(BoundaryCones, CanBeCancelled)
{
	const shapes::Soup soup = partOfSphere([](const Point3d& p) { return p[2] > 0; });
	const Progress cancel([](int, const char*) { return false; });
	EXPECT_THROW(boundaryCones(soup.points, soup.triangles, {}, cancel), Cancelled);
}
