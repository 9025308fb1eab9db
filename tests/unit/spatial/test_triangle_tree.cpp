// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/spatial/triangle_tree.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace vcg;
using namespace vcg::tri::mcf;

TEST(TriangleTree, FindsWhatALoopOverAllTrianglesFinds)
{
	std::mt19937 random(5);
	std::uniform_real_distribution<double> u(-1.5, 1.5);
	for (const auto& [around, sides] : {std::pair {24, 10}, {120, 50}}) { // on several threads, too
		const shapes::Soup soup = shapes::jittered(shapes::torus(1, 0.3, around, sides), 0.02);
		const TriangleTree tree(soup.points, soup.triangles);
		for (int i = 0; i < 300; ++i) {
			const Point3d query(u(random), u(random), u(random));
			double nearest = std::numeric_limits<double>::infinity();
			for (const Triangle& t : soup.triangles)
				nearest = std::min(nearest,
					Distance(query,
						detail::closestOnTriangle(soup.points[size_t(t[0])],
							soup.points[size_t(t[1])], soup.points[size_t(t[2])], query)
							.point));
			const TriangleTree::Closest found =
				tree.closest(query, std::numeric_limits<double>::infinity());
			ASSERT_GE(found.face, 0);
			EXPECT_NEAR(found.distance, nearest, 1e-12);
			EXPECT_NEAR(Distance(found.point, query), found.distance, 1e-12);
			EXPECT_LT(tree.closest(query, nearest * 0.99).face, 0) << "nothing is as near as that";
		}
	}
}

TEST(TriangleTree, WithoutTrianglesThereIsNothing)
{
	const std::vector<Point3d> points;
	const std::vector<Triangle> triangles;
	EXPECT_LT(TriangleTree(points, triangles).closest(Point3d(0, 0, 0), 1e9).face, 0);
}
