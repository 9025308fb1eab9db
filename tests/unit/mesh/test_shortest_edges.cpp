// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/shortest_edges.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

using namespace vcg::tri::mcf;

TEST(ShortestEdges, AreThoseOfTheTrianglesAtEachPoint)
{
	// A prism of height 5 over a hexagon of side 1, and a point without triangles.
	shapes::Soup s = shapes::prism(6, 5);
	s.points.emplace_back(0, 0, 0);
	const std::vector<double> shortest = shortestEdges(s.points, s.triangles);
	ASSERT_EQ(shortest.size(), s.points.size());
	for (size_t v = 0; v + 1 < shortest.size(); ++v)
		EXPECT_NEAR(shortest[v], 1, 1e-12);
	EXPECT_EQ(shortest.back(), std::numeric_limits<double>::infinity());
}
