// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Shapes whose symmetries are known; the group of each has as many maps as it should.

#include "shapes.h"

#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/symmetries.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// With a diagonal of 1, and triangles that are small beside the shape.
SurfaceMesh made(const shapes::Soup& soup, int levels)
{
	shapes::Soup fine = shapes::refined(soup, levels);
	vcg::Box3d box;
	for (const Point3d& p : fine.points)
		box.Add(p);
	return shapes::scaled(fine, 1 / box.Diag()).mesh();
}

std::vector<Eigen::Isometry3d> groupOf(const SurfaceMesh& mesh)
{
	std::vector<int> all(mesh.position.size());
	std::iota(all.begin(), all.end(), 0);
	const ClosestSurface closest(mesh, all, 0.01);
	const std::vector<Eigen::Isometry3d> maps =
		generatedGroup(SymmetryFinder(mesh, all, closest).found());
	for (const Eigen::Isometry3d& map : maps)
		for (const Point3d& p : mesh.position) {
			const Eigen::Vector3d image = map * Eigen::Vector3d(p[0], p[1], p[2]);
			EXPECT_LT(closest.closestExactly({image[0], image[1], image[2]}).distance, 5e-3);
		}
	return maps;
}

shapes::Soup turned(const shapes::Soup& soup)
{
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
	return shapes::transformed(soup, [&](const Point3d& p) {
		const Eigen::Vector3d q = turn * Eigen::Vector3d(p[0], p[1], p[2]);
		return Point3d(q[0] + 3, q[1] - 1, q[2]);
	});
}

/// A cross with hooks, all to the same side: a quarter turn, but no mirror across its plane.
shapes::Soup pinwheel()
{
	return shapes::cells(7, 7, 1, [](int x, int y, int) {
		return x == 3 || y == 3
			? true
			: (x == 6 && y == 4) || (x == 2 && y == 6) || (x == 0 && y == 2) || (x == 4 && y == 0);
	});
}

} // namespace

TEST(Symmetries, ABoxHasThreePlanes)
{
	EXPECT_EQ(groupOf(made(shapes::box(4, 3, 1), 4)).size(), 7u);
	EXPECT_EQ(groupOf(made(turned(shapes::box(4, 3, 1)), 4)).size(), 7u);
}

TEST(Symmetries, ASquareBoxHasSixteenMapsAndACubeFortyEight)
{
	EXPECT_EQ(groupOf(made(shapes::box(2, 2, 1), 4)).size(), 15u);
	EXPECT_EQ(groupOf(made(turned(shapes::box(1, 1, 3)), 4)).size(), 15u);
	EXPECT_EQ(groupOf(made(shapes::box(), 4)).size(), 47u);
}

TEST(Symmetries, PrismsByTheirMoments)
{
	for (int sides : {3, 5, 6, 8})
		for (double height : {0.3, 5.0})
			EXPECT_EQ(groupOf(made(turned(shapes::prism(sides, height)), 3)).size(),
				size_t(4 * sides - 1))
				<< sides << " sides, height " << height;
}

TEST(Symmetries, RotationsWithoutMirrors)
{
	// A quarter turn and the plane that it lies in: eight maps.
	EXPECT_EQ(groupOf(made(pinwheel(), 2)).size(), 7u);
	EXPECT_EQ(groupOf(made(turned(pinwheel()), 2)).size(), 7u);
}

TEST(Symmetries, OneBumpEndsThem)
{
	const auto bump = [](const Point3d& p) {
		const double far = Distance(p, Point3d(4, 3, 1));
		return p + Point3d(1, 1, 1) * (0.4 * std::exp(-far * far / 0.25));
	};
	const shapes::Soup box = shapes::refined(shapes::box(4, 3, 1), 4);
	EXPECT_TRUE(groupOf(made(shapes::transformed(box, bump), 0)).empty());
}

TEST(Symmetries, NoiseOfAThousandthDoesNotEndThem)
{
	const shapes::Soup box = shapes::refined(shapes::box(4, 3, 1), 4);
	EXPECT_EQ(groupOf(made(shapes::jittered(box, 0.005), 0)).size(), 7u);
}

TEST(Symmetries, MapsThatMakeTooManyAreTakenAlone)
{
	std::vector<Eigen::Isometry3d> odd(2, Eigen::Isometry3d::Identity());
	odd[0].linear() = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()).toRotationMatrix();
	odd[1].linear() = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitY()).toRotationMatrix();
	EXPECT_EQ(generatedGroup(odd).size(), 2u);
	EXPECT_TRUE(generatedGroup({}).empty());
}
