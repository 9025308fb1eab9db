// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/input/check_input.h>
#include <skeleton/mesh/principal_frame.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

PrincipalFrame frameOf(const SurfaceMesh& mesh)
{
	return PrincipalFrame::ofComponents(mesh, std::vector<int>(mesh.position.size(), 0), 1).front();
}

/// A body without any symmetry.
shapes::Soup unevenPebble()
{
	return shapes::transformed(shapes::sphere(3), [](const Point3d& p) {
		return Point3d(
			2 * p[0] + 0.2 * p[1] * p[1], p[1] + 0.2 * p[0] * p[2], 0.6 * p[2] + 0.1 * p[0]);
	});
}

/// Turned about two axes.
Point3d turned(const Point3d& p)
{
	const double c = std::cos(0.7), s = std::sin(0.7);
	const Point3d q(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]);
	return Point3d(q[0], c * q[1] - s * q[2], s * q[1] + c * q[2]);
}

} // namespace

TEST(PrincipalFrame, OfABoxIsItsOwn)
{
	const SurfaceMesh box = shapes::box(1, 2, 3).mesh();
	const PrincipalFrame frame = frameOf(box);
	EXPECT_NEAR(frame.size(), std::sqrt(14.0), 1e-12);
	// The longest side comes first, and the middle is the origin.
	const Point3d corner = frame.in(Point3d(1, 2, 3)) * frame.unitLength();
	EXPECT_NEAR(std::abs(corner[0]), 1.5, 1e-12);
	EXPECT_NEAR(std::abs(corner[1]), 1, 1e-12);
	EXPECT_NEAR(std::abs(corner[2]), 0.5, 1e-12);
}

TEST(PrincipalFrame, TurnsMovesAndGrowsWithTheShape)
{
	const shapes::Soup soup = unevenPebble();
	const PrincipalFrame frame = frameOf(soup.mesh());
	const std::function<Point3d(const Point3d&)> moves[] = {turned,
		[](const Point3d& p) { return p * 1e-6; }, [](const Point3d& p) { return p * 1e6; },
		[](const Point3d& p) { return p + Point3d(1e3, -2e3, 3e3); },
		[](const Point3d& p) { return turned(p) * 1e3 + Point3d(1e4, 0, 0); }};
	for (const auto& move : moves) {
		const PrincipalFrame copy =
			frameOf(shapes::shuffled(shapes::transformed(soup, move)).mesh());
		for (const Point3d& p : soup.points) {
			ASSERT_LT(Distance(copy.in(move(p)), frame.in(p)), 1e-11);
			ASSERT_EQ(copy.onGrid(move(p)), frame.onGrid(p));
			ASSERT_LT(Distance(copy.out(copy.in(move(p))), move(p)), 1e-12 * copy.size() + 1e-11);
		}
	}
}

TEST(PrincipalFrame, DoesNotDependOnTheTriangles)
{
	const shapes::Soup soup = unevenPebble();
	const PrincipalFrame frame = frameOf(soup.mesh()),
						 finer = frameOf(shapes::subdivided(soup).mesh());
	for (const Point3d& p : soup.points)
		ASSERT_LT(Distance(frame.in(p), finer.in(p)), 1e-12);
}

TEST(PrincipalFrame, KeepsTheRatios)
{
	const PrincipalFrame frame = frameOf(unevenPebble().mesh());
	const Point3d o = frame.in(Point3d(0, 0, 0));
	const Point3d x = frame.in(Point3d(1, 0, 0)) - o, y = frame.in(Point3d(0, 1, 0)) - o,
				  z = frame.in(Point3d(0, 0, 1)) - o;
	const double hand = frame.isMirrored() ? -1 : 1;
	EXPECT_NEAR((x ^ y) * z * std::pow(frame.unitLength(), 3), hand, 1e-12);
}

TEST(PrincipalFrame, OfAMirroredShapeIsMirrored)
{
	const shapes::Soup soup = unevenPebble();
	const SurfaceMesh mesh = soup.mesh();
	const PrincipalFrame frame = frameOf(mesh);
	for (int k = 0; k < 3; ++k) {
		const auto mirror = [&](Point3d p) {
			p[k] = -p[k];
			return p;
		};
		SurfaceMesh image = shapes::insideOut(shapes::transformed(soup, mirror)).mesh();
		const PrincipalFrame other = frameOf(image);
		EXPECT_NE(other.isMirrored(), frame.isMirrored());
		for (const Point3d& p : soup.points)
			ASSERT_EQ(other.onGrid(mirror(p)), frame.onGrid(p));
		// In the frames both look outwards.
		SurfaceMesh inside[] = {mesh, image};
		const PrincipalFrame* own[] = {&frame, &other};
		for (int i = 0; i < 2; ++i) {
			for (Point3d& p : inside[i].position)
				p = own[i]->in(p);
			turnOverMirrored(inside[i], std::vector<int>(inside[i].position.size(), 0), {*own[i]});
			EXPECT_GT(inside[i].volume(), 0);
		}
	}
}

TEST(PrincipalFrame, PointsTheSameWayWhereItsAxesAreThoseOfTheCoordinates)
{
	// Wedges whose principal axes are x, y and z to the last bit, or of which two are not defined,
	// and their mirror images.
	const shapes::Soup boxes[] = {shapes::moved(shapes::box(8, 4, 2), {-4, -2, -1}),
		shapes::moved(shapes::box(4, 4, 1), {-2, -2, -0.5})};
	for (const shapes::Soup& box : boxes)
		for (int k = 0; k < 3; ++k) {
			double end[2];
			for (const int way : {0, 1}) {
				const double sign = way == 0 ? 1 : -1;
				const shapes::Soup wedge = shapes::transformed(box, [&](Point3d p) {
					for (int i = 0; i < 3; ++i)
						if (i != k)
							p[i] *= sign * p[k] > 0 ? 0.5 : 0.75;
					return p;
				});
				Point3d tip(0, 0, 0);
				tip[k] = sign;
				end[way] = frameOf(wedge.mesh()).in(tip)[k];
			}
			EXPECT_NEAR(end[0], end[1], 1e-12);
		}
}

TEST(PrincipalFrame, ShapesWithoutAxesTakeThoseOfTheCoordinates)
{
	for (const shapes::Soup& soup : {shapes::sphere(3), shapes::box(1, 1, 1), shapes::torus()}) {
		const PrincipalFrame frame = frameOf(soup.mesh());
		for (int k = 0; k < 3; ++k) {
			Point3d step(0, 0, 0);
			step[k] = 1;
			const Point3d moved = frame.in(step)-frame.in(Point3d(0, 0, 0));
			EXPECT_NEAR(moved[k] * frame.unitLength(), 1, 1e-12);
		}
	}
}

TEST(PrincipalFrame, EachComponentHasItsOwn)
{
	const SurfaceMesh mesh = shapes::joined(
		{unevenPebble(), shapes::transformed(unevenPebble(), [](const Point3d& p) {
			 return turned(p) * 3 + Point3d(20, 0, 0);
		 })}).mesh();
	int components = 0;
	const std::vector<int> component = connectedComponents(mesh, &components);
	ASSERT_EQ(components, 2);
	const std::vector<PrincipalFrame> frames = PrincipalFrame::ofComponents(mesh, component, 2);
	EXPECT_NEAR(frames[1].size() / frames[0].size(), 3, 1e-12);
	const size_t half = mesh.position.size() / 2;
	for (size_t v = 0; v < half; ++v)
		ASSERT_LT(
			Distance(frames[0].in(mesh.position[v]), frames[1].in(mesh.position[half + v])), 1e-12);
}

TEST(PrincipalFrame, PlacesThatWereRoundedAndMergedFindTheirGridPointAgain)
{
	const shapes::Soup soup = unevenPebble();
	const Point3d far(3e4, -3e4, 3e4);
	const PrincipalFrame near = frameOf(soup.mesh()),
						 away = frameOf(shapes::moved(soup, far).mesh());
	for (size_t i = 0; i + 1 < soup.points.size(); ++i) {
		const Point3d a = near.onGrid(soup.points[i]), b = near.onGrid(soup.points[i + 1]);
		const Point3d middle = (a + b) / 2.0;
		ASSERT_EQ(near.onGrid(near.out(a)), a);
		ASSERT_EQ(away.onGrid(away.out(a)), a);
		ASSERT_EQ(near.onGrid(near.out(middle)), away.onGrid(away.out(middle)));
	}
}
