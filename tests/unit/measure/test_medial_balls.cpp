// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Unions of balls with known volume and topology.

#include <skeleton/input/check_input.h>
#include <skeleton/measure/medial_balls.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// The result as a checked solid: throws if it is not closed.
SurfaceMesh solid(const BallUnion& soup)
{
	const CheckedSurface checked = checkedSurface(soup.points, soup.triangles);
	EXPECT_TRUE(checked.notes.empty()) << checked.notes.front();
	return checked.mesh;
}

TEST(MedialBalls, OneBallIsASphere)
{
	const SurfaceMesh ball = solid(unionOfBalls({{1, 2, 3}}, {2}, 0.1));
	EXPECT_NEAR(ball.volume(), 4.0 / 3 * M_PI * 8, 0.01 * 33.5);
	EXPECT_EQ(ball.eulerCharacteristic(), 2);
	for (const Point3d& p : ball.position)
		EXPECT_NEAR(vcg::Distance(p, Point3d(1, 2, 3)), 2, 0.01);
}

TEST(MedialBalls, ACapsuleFromItsAxis)
{
	std::vector<Point3d> centre;
	for (int i = 0; i <= 120; ++i)
		centre.emplace_back(-3 + i / 20.0, 0, 0);
	const std::vector<double> radius(centre.size(), 1);
	const SurfaceMesh capsule = solid(unionOfBalls(centre, radius, 0.1));
	EXPECT_EQ(capsule.eulerCharacteristic(), 2);
	EXPECT_NEAR(capsule.volume(), (6 + 4.0 / 3) * M_PI, 0.01 * 23);
	EXPECT_NEAR(capsule.area(), (12 + 4) * M_PI, 0.02 * 50);
}

TEST(MedialBalls, ARingHasAHole)
{
	std::vector<Point3d> centre;
	for (int i = 0; i < 200; ++i)
		centre.emplace_back(3 * std::cos(2 * M_PI * i / 200), 3 * std::sin(2 * M_PI * i / 200), 0);
	const SurfaceMesh ring = solid(unionOfBalls(centre, std::vector<double>(200, 0.8), 0.15));
	EXPECT_EQ(ring.eulerCharacteristic(), 0);
	EXPECT_NEAR(ring.volume(), 2 * M_PI * M_PI * 3 * 0.64, 0.02 * 38);
}

TEST(MedialBalls, BallsApartStayApart)
{
	const SurfaceMesh two = solid(unionOfBalls({{0, 0, 0}, {5, 0, 0}}, {1, 0.5}, 0.1));
	EXPECT_EQ(two.eulerCharacteristic(), 4);
	EXPECT_NEAR(two.volume(), 4.0 / 3 * M_PI * 1.125, 0.05);
}

TEST(MedialBalls, ABallWithinAnotherAddsNothing)
{
	const BallUnion one = unionOfBalls({{0, 0, 0}}, {1}, 0.1);
	const BallUnion two = unionOfBalls({{0, 0, 0}, {0.2, 0, 0}}, {1, 0.5}, 0.1);
	EXPECT_EQ(one.points, two.points);
}

TEST(MedialBalls, BallsWithoutRadiusDoNotCount)
{
	const BallUnion one = unionOfBalls({{0, 0, 0}}, {1}, 0.1);
	const BallUnion more = unionOfBalls({{0, 0, 0}, {9, 9, 9}, {7, 7, 7}}, {1, 0, -1}, 0.1);
	EXPECT_EQ(one.points, more.points);
}

TEST(MedialBalls, CornersOnTheSurfaceMakeNoDegenerateTriangles)
{
	// Voxels of 1 and a radius of 4: the poles of the ball are corners of cubes.
	const SurfaceMesh ball = solid(unionOfBalls({{0, 0, 0}}, {4}, 1));
	for (int f = 0; f < ball.faceSlots(); ++f)
		EXPECT_GT(ball.doubleAreaVector(f).Norm(), 0);
}

TEST(MedialBalls, ScaleDoesNotMatter)
{
	const double expected = solid(unionOfBalls({{1, 0, 0}, {2, 0, 0}}, {1, 1}, 0.1)).volume();
	for (double s : {1e-6, 1e6})
		EXPECT_NEAR(
			solid(unionOfBalls({{s, 0, 0}, {2 * s, 0, 0}}, {s, s}, 0.1 * s)).volume() / (s * s * s),
			expected, 1e-3 * expected);
}

TEST(MedialBalls, AVoxelThatIsTooSmallIsAnsweredWithOneThatIsTaken)
{
	for (double scale : {1.0, 1e-9})
		for (double length : {0.0, 100.0})
			for (const auto& [voxel, count] :
				{std::pair {1e-3, " million"}, {1e-100, "more than 1e15"}}) {
				const auto ballsOf = [&, s = scale, l = length](double side) {
					unionOfBalls({{0, 0, 0}, {l * s, 0, 0}}, {s, s}, side,
						Progress([](int, const char*) { return false; }));
				};
				try {
					ballsOf(voxel * scale);
					ADD_FAILURE() << voxel;
				}
				catch (const InvalidParameter& error) {
					const std::string text = error.what(), before = "at least ";
					EXPECT_NE(text.find(count), std::string::npos) << text;
					const double enough = std::stod(text.substr(text.find(before) + before.size()));
					EXPECT_THROW(ballsOf(enough), Cancelled) << text;
					EXPECT_THROW(ballsOf(0.95 * enough), InvalidParameter) << text;
				}
			}
}

TEST(MedialBalls, RefusesWhatItCannotBuild)
{
	EXPECT_THROW(unionOfBalls({{0, 0, 0}}, {1}, 0), InvalidParameter);
	EXPECT_THROW(unionOfBalls({{0, 0, 0}}, {1}, NAN), InvalidParameter);
	EXPECT_THROW(unionOfBalls({{0, 0, 0}}, {1}, 1e-6), InvalidParameter);
	EXPECT_THROW(unionOfBalls({{0, 0, 0}}, {0}, 0.1), InvalidInput);
	EXPECT_THROW(unionOfBalls({}, {}, 0.1), InvalidInput);
	EXPECT_THROW(
		unionOfBalls({{0, 0, 0}}, {1}, 0.1, Progress([](int, const char*) { return false; })),
		Cancelled);
}

} // namespace
