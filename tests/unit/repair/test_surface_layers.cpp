// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/surface_layers.h>
#include <skeleton/repair/winding_number.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// The part of a sphere between two heights.
shapes::Soup zone(double low, double high, double radius)
{
	shapes::Soup soup = shapes::sphere(4, radius);
	std::vector<Triangle> left;
	for (const Triangle& t : soup.triangles)
		if (const double z = soup.points[size_t(t[0])][2]; z >= low && z <= high)
			left.push_back(t);
	soup.triangles = left;
	return soup;
}

TEST(Layers, CountAsOneWhereScansOverlap)
{
	const shapes::Soup soup = shapes::joined({zone(-2, 0.5, 1), zone(-0.5, 2, 1.004)});
	const TriangleTree tree(soup.points, soup.triangles);
	const std::vector<double> weights =
		layerWeights(tree, std::vector<char>(soup.triangles.size(), 1), 0.02);
	ASSERT_EQ(weights.size(), soup.triangles.size());
	for (size_t f = 0; f < weights.size(); ++f) {
		const Triangle& t = soup.triangles[f];
		const double z =
			((soup.points[size_t(t[0])] + soup.points[size_t(t[1])] + soup.points[size_t(t[2])])
				/ 3.0)[2];
		if (std::abs(z) < 0.4) {
			EXPECT_NEAR(weights[f], 0.5, 1e-12);
		}
		if (std::abs(z) > 0.6) {
			EXPECT_EQ(weights[f], 1);
		}
	}
	const WindingNumber weighted(tree, Progress(), weights);
	for (const Point3d& p : {Point3d(0, 0, 0), Point3d(0.5, 0.2, 0.1), Point3d(0, 0, 0.7)})
		EXPECT_NEAR(weighted(p), 1, 0.05);
	EXPECT_NEAR(weighted(Point3d(0.3, 0, 1.3)), 0, 0.05);
	EXPECT_GT(WindingNumber(tree)(Point3d(0.5, 0.2, 0.1)), 1.2);
}

TEST(Layers, AreNeitherClosedPiecesNorWallsTurnedAgainstEachOther)
{
	const shapes::Soup nested = shapes::joined({shapes::sphere(3, 1), shapes::sphere(3, 1.004)});
	const TriangleTree tree(nested.points, nested.triangles);
	EXPECT_TRUE(layerWeights(tree, std::vector<char>(nested.triangles.size(), 0), 0.02).empty());
	const shapes::Soup plate = shapes::box(1, 1, 0.004);
	const TriangleTree thin(plate.points, plate.triangles);
	EXPECT_TRUE(layerWeights(thin, std::vector<char>(plate.triangles.size(), 1), 0.02).empty());
}

} // namespace
