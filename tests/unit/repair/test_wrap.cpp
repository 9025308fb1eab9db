// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"
#include "threads.h"

#include <skeleton/mesh/components.h>
#include <skeleton/repair/tetrahedral_lattice.h>
#include <skeleton/repair/wrap.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

WrappedSurface wrapped(const shapes::Soup& soup, double spacing)
{
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	return wrap(tree, winding, spacing, 2000000);
}

double volumeOf(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles)
{
	double volume = 0;
	for (const Triangle& t : triangles)
		volume += points[size_t(t[0])] * (points[size_t(t[1])] ^ points[size_t(t[2])]) / 6;
	return volume;
}

/// Closed, two-manifold, with this Euler characteristic, in so many pieces.
void expectSurface(const WrappedSurface& surface, int euler, int pieces)
{
	const auto mesh = SurfaceMesh::ifClosedManifold(surface.points, surface.triangles);
	ASSERT_TRUE(mesh);
	EXPECT_EQ(checks::structureError(*mesh), "");
	EXPECT_EQ(mesh->vertexCount() - mesh->faceCount() / 2, euler);
	int components = 0;
	connectedComponents(*mesh, &components);
	EXPECT_EQ(components, pieces);
}

TEST(TetrahedralLattice, TetrahedraFillSpaceOnce)
{
	TetrahedralLattice lattice(Point3d(0, 0, 0), 1);
	const int n = 6;
	for (int x = 0; x <= 2 * n; ++x)
		for (int y = x % 2; y <= 2 * n; y += 2)
			for (int z = x % 2; z <= 2 * n; z += 2)
				lattice.add({x, y, z});
	double volume = 0;
	std::set<std::array<int, 4>> seen;
	for (int node = 0; node < lattice.size(); ++node)
		lattice.forEachTetrahedron(node, [&](const std::array<int, 4>& t) {
			const Point3d a = lattice.position(t[0]);
			const double six = (lattice.position(t[1]) - a)
				* ((lattice.position(t[2]) - a) ^ (lattice.position(t[3]) - a));
			EXPECT_NEAR(six, 0.5, 1e-12); // a^3 / 12, turned alike
			volume += six / 6;
			std::array<int, 4> sorted = t;
			std::sort(sorted.begin(), sorted.end());
			EXPECT_TRUE(seen.insert(sorted).second);
		});
	// Of the tetrahedra at the border some are missing.
	EXPECT_LT(volume, double(n * n * n));
	EXPECT_GT(volume, double((n - 1) * (n - 1) * (n - 1)));
}

TEST(TetrahedralLattice, ANeighbourKnowsItsNeighbour)
{
	TetrahedralLattice lattice(Point3d(1, 2, 3), 0.5);
	const int node = lattice.add({4, -2, 0});
	for (int d = 0; d < TetrahedralLattice::directions; ++d) {
		const int other = lattice.add(TetrahedralLattice::moved(lattice.place(node), d));
		EXPECT_EQ(lattice.neighbour(node, d), other);
		EXPECT_EQ(lattice.neighbour(other, TetrahedralLattice::opposite(d)), node);
		EXPECT_LE(Distance(lattice.position(node), lattice.position(other)), 0.5 + 1e-12);
	}
}

TEST(Wrap, OfASphereLiesOnIt)
{
	const shapes::Soup soup = shapes::sphere(4);
	const WrappedSurface surface = wrapped(soup, 0.1);
	expectSurface(surface, 2, 1);
	EXPECT_NEAR(volumeOf(surface.points, surface.triangles), volumeOf(soup.points, soup.triangles),
		0.02 * 4.19);
	const TriangleTree tree(soup.points, soup.triangles);
	double mean = 0;
	for (const Point3d& p : surface.points)
		mean += tree.closest(p).distance / double(surface.points.size());
	EXPECT_LT(mean, 1e-3 * 0.1);
}

TEST(Wrap, KeepsHandles)
{
	expectSurface(wrapped(shapes::torus(), 0.07), 0, 1);
	expectSurface(wrapped(shapes::plate(2), 0.11), -2, 1);
}

TEST(Wrap, ClosesALargeHole)
{
	shapes::Soup soup = shapes::sphere(4);
	std::vector<Triangle> left;
	for (const Triangle& t : soup.triangles)
		if (soup.points[size_t(t[0])][2] < 0.5)
			left.push_back(t);
	soup.triangles = left;
	const WrappedSurface surface = wrapped(soup, 0.08);
	expectSurface(surface, 2, 1);
	double highest = -1;
	for (const Point3d& p : surface.points)
		highest = std::max(highest, p[2]);
	EXPECT_GT(highest, 0.45); // not into the body
	EXPECT_LT(highest, 1);
}

TEST(Wrap, LeavesOutTheFinsAlongTheBordersOfASheet)
{
	// Seven of the twelve triangles of a box: walls stand out that enclose less and less.
	shapes::Soup soup;
	soup.points = {{-3, -0.5, -0.5}, {-3, -0.5, 0.5}, {-3, 0.5, -0.5}, {-3, 0.5, 0.5},
		{3, -0.5, -0.5}, {3, -0.5, 0.5}, {3, 0.5, -0.5}, {3, 0.5, 0.5}};
	soup.triangles = {{1, 0, 4}, {2, 4, 0}, {1, 3, 0}, {3, 1, 5}, {3, 2, 0}, {3, 7, 2}, {7, 6, 2}};
	const WrappedSurface surface = wrapped(soup, 0.03);
	const SurfaceMesh mesh(surface.points, surface.triangles);
	int pieces = 0;
	connectedComponents(mesh, &pieces);
	// Horns may be cut off, but none is torn.
	EXPECT_LE(pieces, 3);
	EXPECT_EQ(mesh.vertexCount() - mesh.faceCount() / 2, 2 * pieces);
	EXPECT_GT(volumeOf(surface.points, surface.triangles), 2.5);
}

TEST(Wrap, UnitesBodiesThatRunIntoEachOther)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 1, 1), shapes::moved(shapes::box(2, 1, 1), {1.03, 0.21, 0.17})});
	const WrappedSurface surface = wrapped(soup, 0.09);
	expectSurface(surface, 2, 1);
	// Edges, of 26 in all, are cut by about the spacing.
	EXPECT_NEAR(
		volumeOf(surface.points, surface.triangles), 4 - 0.97 * 0.79 * 0.83, 26 * 0.09 * 0.09 / 2);
}

TEST(Wrap, OfASoupWithWallsInside)
{
	// Two boxes that share a wall, every triangle for itself.
	const shapes::Soup soup =
		shapes::unmerged(shapes::joined({shapes::box(), shapes::moved(shapes::box(), {1, 0, 0})}));
	const WrappedSurface surface = wrapped(soup, 0.08);
	expectSurface(surface, 2, 1);
	EXPECT_NEAR(volumeOf(surface.points, surface.triangles), 2, 16 * 0.08 * 0.08 / 2);
}

TEST(Wrap, ClosesASlitThatIsNarrowerThanItsLattice)
{
	constexpr double slit = 0.03, spacing = 0.08;
	shapes::Soup soup =
		shapes::joined({shapes::box(), shapes::moved(shapes::box(), {1 + slit, 0, 0})});
	for (Point3d& p : soup.points) { // askew in the lattice
		p = {p[0] - 0.2 * p[1], p[1] + 0.2 * p[0], p[2]};
		p = {p[0], p[1] - 0.3 * p[2], p[2] + 0.3 * p[1]};
	}
	expectSurface(wrapped(soup, spacing), 2, 1);
}

TEST(Wrap, OfNothingIsNothing)
{
	const shapes::Soup sheet = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
	EXPECT_TRUE(wrapped(sheet, 0.05).triangles.empty());
}

TEST(Wrap, IsTheSameOnAnyNumberOfThreads)
{
	shapes::Soup soup = shapes::torus();
	soup.triangles.erase(soup.triangles.begin() + 100, soup.triangles.begin() + 180);
	const auto on = [&](int threads) {
		const ThreadCount limit(threads);
		return wrapped(soup, 0.08);
	};
	const WrappedSurface one = on(1), three = on(3);
	EXPECT_TRUE(one.points == three.points);
	EXPECT_TRUE(one.triangles == three.triangles);
}

TEST(Wrap, SaysWhereItIsTooMuch)
{
	const shapes::Soup soup = shapes::sphere(3);
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	EXPECT_THROW(wrap(tree, winding, 0.01, 1000), SolverError);
}

/// A sphere with a triangle without area that reaches far.
shapes::Soup sphereWithASliver(double length)
{
	shapes::Soup soup = shapes::sphere(2);
	const int first = int(soup.points.size());
	soup.points.insert(soup.points.end(),
		{Point3d(1, 0, 0), Point3d(length / 2, length / 7, 0), Point3d(length, 2 * length / 7, 0)});
	soup.triangles.push_back({first, first + 1, first + 2});
	return soup;
}

TEST(Wrap, OfALongSliverEndsAtTheLimit)
{
	// Hundreds of millions of nodes are near the first one, and the second one is too long for any.
	for (const double length : {1e6, 1e12}) {
		const shapes::Soup soup = sphereWithASliver(length);
		const TriangleTree tree(soup.points, soup.triangles);
		const WindingNumber winding(tree);
		EXPECT_THROW(wrap(tree, winding, 0.1, 20000), SolverError) << length;
	}
}

TEST(Wrap, IsCancelledWithinALongSliver)
{
	const shapes::Soup soup = sphereWithASliver(1e5);
	const TriangleTree tree(soup.points, soup.triangles);
	const WindingNumber winding(tree);
	int asked = 0;
	const Progress progress([&](int, const char*) { return ++asked < 4; });
	EXPECT_THROW(wrap(tree, winding, 0.1, 1 << 30, progress), Cancelled);
}

} // namespace
