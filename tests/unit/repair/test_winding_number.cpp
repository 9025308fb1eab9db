// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/overlap.h>
#include <skeleton/spatial/triangle_tree.h>
#include <skeleton/repair/winding_number.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// Points in and around a shape, none of them chosen by its coordinates.
std::vector<Point3d> queries(const shapes::Soup& soup, int count)
{
	vcg::Box3d box;
	for (const Point3d& p : soup.points)
		box.Add(p);
	box.Offset(0.2 * box.Diag());
	std::mt19937 random(5);
	const auto part = [&] { return random() / double(std::mt19937::max()); };
	std::vector<Point3d> points;
	for (int i = 0; i < count; ++i) {
		const double x = part(), y = part(), z = part();
		points.emplace_back(
			box.min[0] + x * box.DimX(), box.min[1] + y * box.DimY(), box.min[2] + z * box.DimZ());
	}
	return points;
}

/// As a fraction of the full sphere.
double windingOfTriangle(const Point3d& a, const Point3d& b, const Point3d& c, const Point3d& q)
{
	return detail::halfSolidAngle(a, b, c, q).angle() / (2 * M_PI);
}

double sumOfSolidAngles(const shapes::Soup& soup, const Point3d& q)
{
	double sum = 0;
	for (const Triangle& t : soup.triangles)
		sum += windingOfTriangle(
			soup.points[size_t(t[0])], soup.points[size_t(t[1])], soup.points[size_t(t[2])], q);
	return sum;
}

TEST(WindingNumber, AFaceOfATetrahedronSeenFromItsMiddleIsAQuarter)
{
	const Point3d a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1);
	const double w = windingOfTriangle(a, b, c, Point3d(0, 0, 0));
	EXPECT_NEAR(std::abs(w), 0.25, 1e-14);
	EXPECT_NEAR(windingOfTriangle(a, c, b, Point3d(0, 0, 0)), -w, 1e-14);
}

TEST(AngleSum, CountsTurns)
{
	std::mt19937 random(3);
	const auto part = [&] { return double(random()) / double(std::mt19937::max()); };
	for (int run = 0; run < 100; ++run) {
		detail::AngleSum sum;
		double expected = 0;
		for (int i = 0; i < 300; ++i) {
			// Mostly of one sign, so that there are many turns; of lengths far apart.
			const double angle = (2 * part() - (run % 2 ? 0.5 : 1.5)) * (run % 3 ? M_PI / 2 : 2);
			const double length = std::pow(10, 60 * part() - 30);
			const double y = length * std::sin(angle), x = length * std::cos(angle);
			expected += std::atan2(y, x);
			sum.add({x, y});
		}
		EXPECT_NEAR(sum.sum(), expected, 1e-10);
	}
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideOfAClosedSurface)
{
	const shapes::Soup soup = shapes::sphere(4);
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	for (const Point3d& q : queries(soup, 300))
		if (std::abs(q.Norm() - 1) > 0.01) {
			EXPECT_NEAR(winding(q), q.Norm() < 1 ? 1 : 0, 0.02);
		}
}

TEST(WindingNumber, IsNearTheSumOfSolidAnglesOnOpenSurfaces)
{
	shapes::Soup soup = shapes::torus(1, 0.3, 90, 40);
	soup.triangles.resize(soup.triangles.size() * 2 / 3);
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	double mean = 0;
	for (const Point3d& q : queries(soup, 300)) {
		const double error = std::abs(winding(q) - sumOfSolidAngles(soup, q));
		EXPECT_LT(error, 0.02);
		mean += error / 300;
	}
	EXPECT_LT(mean, 0.002);
}

TEST(WindingNumber, OfHalfASphereIsOneHalfInTheMiddle)
{
	shapes::Soup soup = shapes::sphere(4);
	std::vector<Triangle> upper;
	for (const Triangle& t : soup.triangles)
		if ((soup.points[size_t(t[0])] + soup.points[size_t(t[1])] + soup.points[size_t(t[2])])[2]
			> 0)
			upper.push_back(t);
	const TriangleTree tree(soup.points, upper);
	EXPECT_NEAR(WindingNumber(tree)(Point3d(0, 0, 0)), 0.5, 0.02);
}

TEST(TriangleTree, FindsTheClosestPointOfAll)
{
	const shapes::Soup soup = shapes::torus();
	const TriangleTree tree(soup.points, soup.triangles);
	for (const Point3d& q : queries(soup, 100)) {
		double nearest = 1e9;
		for (const Triangle& t : soup.triangles)
			nearest = std::min(nearest,
				detail::closestOnTriangle(soup.points[size_t(t[0])], soup.points[size_t(t[1])],
					soup.points[size_t(t[2])], q)
					.squaredDistance);
		const TriangleTree::Closest found = tree.closest(q);
		EXPECT_NEAR(found.distance, std::sqrt(nearest), 1e-12);
		EXPECT_NEAR(Distance(found.point, q), found.distance, 1e-12);
	}
}

TEST(TriangleTree, ALineThroughASphereEntersAndLeaves)
{
	const shapes::Soup soup = shapes::sphere(3);
	const TriangleTree tree(soup.points, soup.triangles);
	int enters = 0, leaves = 0;
	tree.forEachCrossing(
		Point3d(-2, 0.1, 0.23), Point3d(2, 0.12, 0.2), [&](int, double t, bool alongNormal) {
			(alongNormal ? leaves : enters) += 1;
			EXPECT_EQ(alongNormal, t > 0.5);
		});
	EXPECT_EQ(enters, 1);
	EXPECT_EQ(leaves, 1);
}

TEST(WindingVolumes, OfABox)
{
	const shapes::Soup soup = shapes::box(2, 3, 4);
	const WindingVolumes found = windingVolumes(soup.points, soup.triangles);
	EXPECT_NEAR(found.once, 24, 1e-9);
	EXPECT_EQ(found.wrongPart(), 0);
}

TEST(WindingVolumes, OfTwoBoxesThatRunIntoEachOther)
{
	const shapes::Soup soup =
		shapes::joined({shapes::box(2, 2, 2), shapes::moved(shapes::box(2, 2, 2), {1, 0, 0})});
	const WindingVolumes found = windingVolumes(soup.points, soup.triangles, 120);
	EXPECT_NEAR(found.once, 12, 0.2);
	EXPECT_NEAR(found.repeated, 4, 0.1);
	EXPECT_NEAR(found.wrongPart(), 1.0 / 3, 0.01);
}

TEST(WindingVolumes, OfWhatIsInsideOut)
{
	const shapes::Soup soup = shapes::insideOut(shapes::box());
	EXPECT_NEAR(windingVolumes(soup.points, soup.triangles).negative, 1, 1e-9);
}

/// Of this process, in MB.
double residentMemory()
{
	size_t all = 0, resident = 0;
	std::ifstream("/proc/self/statm") >> all >> resident;
	return double(resident) * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

TEST(WindingVolumes, KeepTheCrossingsOfOneRayOnly)
{
	// Every ray crosses all of the plates: 128 x 128 x 400 crossings are 105 MB.
	const int count = 200;
	shapes::Soup plates;
	for (int i = 0; i < count; ++i) {
		const int first = int(plates.points.size());
		const shapes::Soup plate = shapes::moved(shapes::box(1, 1, 0.4), {0, 0, double(i)});
		plates.points.insert(plates.points.end(), plate.points.begin(), plate.points.end());
		for (const Triangle& t : plate.triangles)
			plates.triangles.push_back({first + t[0], first + t[1], first + t[2]});
	}
	const double before = residentMemory();
	double most = 0;
	int asked = 0;
	const Progress progress([&](int, const char*) {
		most = std::max(most, residentMemory() - before);
		return ++asked > 0;
	});
	const WindingVolumes found = windingVolumes(plates.points, plates.triangles, 128, progress);
	EXPECT_NEAR(found.once, 0.4 * count, 1e-9 * count);
	EXPECT_EQ(found.wrongPart(), 0);
	EXPECT_LT(most, 20);
	EXPECT_GT(asked, 200) << "it can be cancelled";
}

TEST(WindingVolumes, AreTheSameForFacesInAnyOrder)
{
	shapes::Soup soup =
		shapes::joined({shapes::sphere(4), shapes::insideOut(shapes::sphere(3, 0.5)),
			shapes::moved(shapes::box(2, 0.3, 0.2), {0.5, 0.1, 0.2})});
	const WindingVolumes found = windingVolumes(soup.points, soup.triangles);
	EXPECT_GT(found.repeated, 0.01);
	std::mt19937 random(3);
	std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
	const WindingVolumes again = windingVolumes(soup.points, soup.triangles);
	EXPECT_EQ(found.once, again.once);
	EXPECT_EQ(found.repeated, again.repeated);
	EXPECT_EQ(found.negative, again.negative);
}

} // namespace
