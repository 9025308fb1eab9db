// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Sheets whose area is known: a thin solid around one has that area times its thickness as volume.

#include "shapes.h"

#include <skeleton/input/check_input.h>
#include <skeleton/mesh/volume_and_area.h>
#include <skeleton/repair/thicken_sheets.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// n x n squares of which those for which `filled` holds are there, of size 1 / n.
shapes::Soup sheet(int n, const std::function<bool(int, int)>& filled)
{
	shapes::Soup s;
	for (int i = 0; i <= n; ++i)
		for (int j = 0; j <= n; ++j)
			s.points.emplace_back(double(i) / n, double(j) / n, 0);
	for (int i = 0; i < n; ++i)
		for (int j = 0; j < n; ++j)
			if (filled(i, j)) {
				const int a = i * (n + 1) + j;
				s.triangles.push_back({a, a + n + 1, a + n + 2});
				s.triangles.push_back({a, a + n + 2, a + 1});
			}
	return s;
}

shapes::Soup square()
{
	return sheet(10, [](int, int) { return true; });
}

struct ThickSheet
{
	SurfaceMesh mesh;
	double volume;
	int genus;
};

/// The solid, which the check must accept.
ThickSheet thickened(const shapes::Soup& soup, double thickness)
{
	const ThickenedSheets thick = thickenedSheets(soup.points, soup.triangles, thickness);
	for (size_t v = 0; v < soup.points.size(); ++v)
		if (std::isfinite(soup.points[v][0])) {
			EXPECT_LE(Distance(soup.points[v], thick.points[size_t(thick.vertexOfInput[v])]),
				thickness / 2 * (1 + 1e-9));
		}
	ThickSheet solid {checkedSurface(thick.points, thick.triangles).mesh, 0, 0};
	for (int f = 0; f < solid.mesh.faceSlots(); ++f) {
		const Triangle t = solid.mesh.triangle(f);
		solid.volume +=
			solid.mesh.position[t[0]] * (solid.mesh.position[t[1]] ^ solid.mesh.position[t[2]]) / 6;
	}
	const int vertices = solid.mesh.vertexCount(), faces = solid.mesh.faceCount();
	solid.genus = 1 - (vertices - faces / 2) / 2;
	return solid;
}

} // namespace

TEST(ThickenSheets, ASquareBecomesAPlate)
{
	const ThickSheet plate = thickened(square(), 0.02);
	EXPECT_NEAR(plate.volume, 0.02, 1e-9);
	EXPECT_EQ(plate.genus, 0);
}

TEST(ThickenSheets, HolesStay)
{
	const ThickSheet plate =
		thickened(sheet(9, [](int i, int j) { return i % 3 != 1 || j % 3 != 1; }), 0.01);
	EXPECT_NEAR(plate.volume, 0.01 * 72 / 81, 1e-9);
	EXPECT_EQ(plate.genus, 9);
}

TEST(ThickenSheets, NeitherTheWayThatFacesAreTurnedNorCopiesMatter)
{
	shapes::Soup soup = square();
	for (size_t f = 0; f < soup.triangles.size(); f += 3)
		std::swap(soup.triangles[f][0], soup.triangles[f][1]);
	EXPECT_NEAR(thickened(soup, 0.02).volume, 0.02, 1e-9);
	shapes::Soup both = shapes::joined({square(), shapes::insideOut(square())});
	EXPECT_NEAR(thickened(both, 0.02).volume, 0.02, 1e-9);
	EXPECT_NEAR(thickened(shapes::unmerged(square()), 0.02).volume, 0.02, 1e-9);
	both.points.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
	both.triangles.push_back({0, 1, int(both.points.size()) - 1});
	EXPECT_NEAR(thickened(both, 0.02).volume, 0.02, 1e-9);
}

TEST(ThickenSheets, ABentSheetHasItsAreaTimesTheThickness)
{
	const shapes::Soup bent = shapes::transformed(sheet(40, [](int, int) { return true; }),
		[](const Point3d& p) { return Point3d(std::cos(2 * p[0]), std::sin(2 * p[0]), p[1]); });
	EXPECT_NEAR(thickened(bent, 0.02).volume, 0.02 * 2, 1e-4);
}

TEST(ThickenSheets, AMoebiusStripBecomesARing)
{
	const ThickSheet ring = thickened(shapes::moebiusStrip(), 0.01);
	EXPECT_EQ(ring.genus, 1);
	EXPECT_GT(ring.volume, 0);
}

TEST(ThickenSheets, ThreeSheetsAtOneEdge)
{
	// Two go on straight; the third stands on them, with a wall of its own.
	const shapes::Soup up =
		shapes::transformed(square(), [](const Point3d& p) { return Point3d(0.5, p[1], p[0]); });
	const shapes::Soup tee = shapes::joined({square(), up});
	EXPECT_NEAR(thickened(tee, 0.02).volume, 0.04, 1e-3);
}
