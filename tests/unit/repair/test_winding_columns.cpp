// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/winding_columns.h>
#include <skeleton/repair/winding_number.h>
#include <skeleton/repair/wrap.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// Calls visit(place) for the places of a lattice from its origin on, up to `count` steps.
template <class Visit>
void forEachPlace(int count, const Visit& visit)
{
	for (int x = 0; x < count; ++x)
		for (int y = x % 2; y < count; y += 2)
			for (int z = x % 2; z < count; z += 2)
				visit(TetrahedralLattice::Place {x, y, z});
}

shapes::Soup turned(const shapes::Soup& soup, double angle)
{
	return shapes::transformed(soup, [&](const Point3d& p) {
		return Point3d(p[0] * std::cos(angle) - p[2] * std::sin(angle), p[1],
			p[0] * std::sin(angle) + p[2] * std::cos(angle));
	});
}

} // namespace

TEST(WindingColumns, AreTheWindingNumbersOfClosedSurfacesThatCross)
{
	shapes::Soup inward = shapes::moved(shapes::box(1, 1, 1), Point3d(1.5, 1.5, 1.5));
	for (Triangle& t : inward.triangles)
		std::swap(t[1], t[2]);
	const shapes::Soup soup =
		shapes::joined({shapes::moved(turned(shapes::torus(), 0.4), Point3d(1, 1, 1)),
			shapes::moved(turned(shapes::torus(), 1.3), Point3d(1.4, 0.9, 1.1)), inward});
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	const TetrahedralLattice lattice(Point3d(-1.01, -1.02, -1.03), 0.1);
	const WindingColumns columns(tree, std::vector<char>(soup.triangles.size(), 0), lattice);
	std::map<int, int> seen;
	forEachPlace(90, [&](const TetrahedralLattice::Place& at) {
		const std::optional<int> found = columns.at(lattice, at);
		ASSERT_TRUE(found);
		EXPECT_NEAR(*found, winding(lattice.position(at)), 0.05);
		++seen[*found];
	});
	for (int each : {-1, 0, 1, 2})
		EXPECT_GT(seen[each], 20) << each;
}

TEST(WindingColumns, NodesAboveVerticesAndEdgesAreCountedOnce)
{
	// All edges and vertices of the boxes are on columns of the lattice; places are exact in binary.
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 2, 2), shapes::moved(shapes::box(1, 1, 1), Point3d(0.5, 0.5, 0.5))});
	const TriangleTree tree(soup.points, soup.triangles);
	const TetrahedralLattice lattice(Point3d(-1, -1, -1.03125), 0.5);
	const WindingColumns columns(tree, std::vector<char>(soup.triangles.size(), 0), lattice);
	const auto isIn = [](double low, double x, double high) { return x > low && x < high; };
	int inside = 0;
	forEachPlace(17, [&](const TetrahedralLattice::Place& at) {
		const std::optional<int> found = columns.at(lattice, at);
		ASSERT_TRUE(found);
		const Point3d p = lattice.position(at);
		int low = 0, high = 0; // where a side counts as outside, and as inside
		for (const auto& [from, to] : {std::array<double, 2> {0, 2}, {0.5, 1.5}}) {
			const auto within = [&](double margin) {
				for (int k = 0; k < 3; ++k)
					if (!isIn(from - margin, p[k], to + margin))
						return 0;
				return 1;
			};
			low += within(-1e-9);
			high += within(1e-9);
		}
		EXPECT_GE(*found, low);
		EXPECT_LE(*found, high);
		inside += low;
	});
	EXPECT_GT(inside, 100);
}

TEST(WindingColumns, OnlyTheMarkedTrianglesCount)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 2, 2), shapes::moved(shapes::box(2, 2, 2), Point3d(1, 1, 1))});
	const TriangleTree tree(soup.points, soup.triangles);
	std::vector<char> isOpen(soup.triangles.size(), 1);
	for (size_t f = 0; f < isOpen.size() / 2; ++f)
		isOpen[f] = 0;
	const TetrahedralLattice lattice(Point3d(-0.53, -0.52, -0.51), 0.2);
	const WindingColumns columns(tree, isOpen, lattice);
	forEachPlace(40, [&](const TetrahedralLattice::Place& at) {
		const Point3d p = lattice.position(at);
		const bool isInside = p[0] > 0 && p[0] < 2 && p[1] > 0 && p[1] < 2 && p[2] > 0 && p[2] < 2;
		EXPECT_EQ(columns.at(lattice, at), std::optional<int>(isInside));
	});
}

TEST(WindingColumns, AColumnThatDoesNotEndOutsideIsNotTrusted)
{
	shapes::Soup soup = shapes::box(2, 2, 2);
	std::vector<Triangle> kept; // without its upper side
	for (const Triangle& t : soup.triangles) {
		bool isUpper = true;
		for (int v : t)
			isUpper = isUpper && soup.points[size_t(v)][2] == 2;
		if (!isUpper)
			kept.push_back(t);
	}
	const TriangleTree tree(soup.points, kept);
	const TetrahedralLattice lattice(Point3d(-0.53, -0.52, -0.51), 0.2);
	const WindingColumns columns(tree, std::vector<char>(kept.size(), 0), lattice);
	EXPECT_FALSE(columns.at(lattice, {10, 10, 10}));
	EXPECT_EQ(columns.at(lattice, {0, 0, 10}), std::optional<int>(0));
}

TEST(WindingColumns, AWrapOfClosedAndOpenPiecesIsThatByWindingNumbersAlone)
{
	// A ball with a hole, which a closed ring crosses.
	shapes::Soup open = shapes::sphere(4);
	const size_t closedFrom = open.triangles.size() - 6;
	open.triangles.resize(closedFrom);
	const shapes::Soup soup =
		shapes::joined({open, shapes::moved(turned(shapes::torus(), 0.3), Point3d(0.8, 0, 0.1))});
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	std::vector<char> isOpen(soup.triangles.size(), 0);
	for (size_t f = 0; f < closedFrom; ++f)
		isOpen[f] = 1;
	const WrappedSurface one = wrap(tree, winding, isOpen, 0.08, 1000000);
	const WrappedSurface other = wrap(tree, winding, {}, 0.08, 1000000);
	EXPECT_EQ(one.triangles, other.triangles);
	ASSERT_EQ(one.points.size(), other.points.size());
	for (size_t v = 0; v < one.points.size(); ++v)
		EXPECT_NEAR(Distance(one.points[v], other.points[v]), 0, 0.01);
}
