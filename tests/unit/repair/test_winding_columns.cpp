// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/repair/boundary_cones.h>
#include <skeleton/repair/winding_columns.h>
#include <skeleton/repair/winding_number.h>
#include <skeleton/repair/wrap.h>

#include <gtest/gtest.h>

#include <algorithm>
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

shapes::Soup withoutUpperSide(shapes::Soup box)
{
	const auto isUpper = [&](const Triangle& t) {
		return std::all_of(
			t.begin(), t.end(), [&](int v) { return box.points[size_t(v)][2] == 2; });
	};
	box.triangles.erase(
		std::remove_if(box.triangles.begin(), box.triangles.end(), isUpper), box.triangles.end());
	return box;
}

WindingColumns columnsOf(
	const shapes::Soup& soup, const std::vector<double>& weights, const TetrahedralLattice& lattice)
{
	return {soup.triangles, weights, boundaryCones(soup.points, soup.triangles, weights), lattice};
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
	const WindingColumns columns = columnsOf(soup, {}, lattice);
	std::map<int, int> seen;
	forEachPlace(90, [&](const TetrahedralLattice::Place& at) {
		const std::optional<double> found = columns.at(lattice, at);
		ASSERT_TRUE(found);
		EXPECT_NEAR(*found, winding(lattice.position(at)), 0.05);
		EXPECT_EQ(*found, std::round(*found));
		++seen[int(*found)];
	});
	for (int each : {-1, 0, 1, 2})
		EXPECT_GT(seen[each], 20) << each;
}

TEST(WindingColumns, NodesAboveVerticesAndEdgesAreCountedOnce)
{
	// All edges and vertices of the boxes are on columns of the lattice; places are exact in binary.
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 2, 2), shapes::moved(shapes::box(1, 1, 1), Point3d(0.5, 0.5, 0.5))});
	const TetrahedralLattice lattice(Point3d(-1, -1, -1.03125), 0.5);
	const WindingColumns columns = columnsOf(soup, {}, lattice);
	const auto isIn = [](double low, double x, double high) { return x > low && x < high; };
	int inside = 0;
	forEachPlace(17, [&](const TetrahedralLattice::Place& at) {
		const std::optional<double> found = columns.at(lattice, at);
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

TEST(WindingColumns, TrianglesCountByTheirWeights)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 2, 2), shapes::moved(shapes::box(2, 2, 2), Point3d(1, 1, 1))});
	std::vector<double> weights(soup.triangles.size(), 0.25);
	for (size_t f = 0; f < weights.size() / 2; ++f)
		weights[f] = 1;
	const TetrahedralLattice lattice(Point3d(-0.53, -0.52, -0.51), 0.2);
	const WindingColumns columns = columnsOf(soup, weights, lattice);
	forEachPlace(40, [&](const TetrahedralLattice::Place& at) {
		const Point3d p = lattice.position(at);
		const auto isInBoxFrom = [&](double low) {
			return std::all_of(p.V(), p.V() + 3, [&](double x) { return x > low && x < low + 2; });
		};
		EXPECT_EQ(
			columns.at(lattice, at), std::optional<double>(isInBoxFrom(0) + 0.25 * isInBoxFrom(1)));
	});
}

TEST(WindingColumns, AColumnThatDoesNotEndOutsideIsNotTrusted)
{
	shapes::Soup soup = withoutUpperSide(shapes::box(2, 2, 2));
	const TetrahedralLattice lattice(Point3d(-0.53, -0.52, -0.51), 0.2);
	BoundaryCones none;
	none.points = soup.points;
	const WindingColumns columns(soup.triangles, {}, none, lattice);
	EXPECT_FALSE(columns.at(lattice, {10, 10, 10}));
	EXPECT_EQ(columns.at(lattice, {0, 0, 10}), std::optional<double>(0));
}

TEST(WindingColumns, LessThatOfTheConesAreTheWindingNumbersOfOpenSurfaces)
{
	shapes::Soup shell = shapes::sphere(4);
	shell.triangles.resize(shell.triangles.size() * 3 / 4);
	const shapes::Soup soup = shapes::joined({withoutUpperSide(shapes::box(2, 2, 2)),
		shapes::moved(turned(shell, 0.7), Point3d(1.1, 0.9, 1)),
		shapes::moved(turned(shapes::torus(), 0.3), Point3d(1, 1, 0.4))});
	for (const bool isWeighted : {false, true}) {
		std::vector<double> weights;
		for (size_t f = 0; isWeighted && f < soup.triangles.size(); ++f)
			weights.push_back(f % 9 == 0 ? 0.5 : 1);
		const TetrahedralLattice lattice(Point3d(-1.01, -1.02, -1.03), 0.2);
		const BoundaryCones cones = boundaryCones(soup.points, soup.triangles, weights);
		const WindingColumns columns(soup.triangles, weights, cones, lattice);
		const TriangleTree tree(soup.points, soup.triangles),
			coneTree(cones.points, cones.triangles);
		const WindingNumber winding(tree, Progress(), weights),
			ofCones(coneTree, Progress(), cones.weights);
		double mean = 0;
		int count = 0;
		forEachPlace(40, [&](const TetrahedralLattice::Place& at) {
			const Point3d p = lattice.position(at);
			const std::optional<double> found = columns.at(lattice, at);
			ASSERT_TRUE(found);
			const double error = std::abs(*found - ofCones(p) - winding(p));
			EXPECT_LT(error, 0.05);
			mean += error;
			++count;
		});
		EXPECT_LT(mean / count, 0.002);
	}
}

TEST(WindingColumns, AWrapOfClosedAndOpenPiecesIsThatByWindingNumbersAlone)
{
	// A ball with a hole, which a closed ring crosses, and the same in loose triangles.
	shapes::Soup open = shapes::sphere(4);
	open.triangles.resize(open.triangles.size() - 6);
	const shapes::Soup soup =
		shapes::joined({open, shapes::moved(turned(shapes::torus(), 0.3), Point3d(0.8, 0, 0.1))});
	shapes::Soup loose;
	for (const Triangle& t : soup.triangles) {
		const int first = int(loose.points.size());
		for (int v : t)
			loose.points.push_back(soup.points[size_t(v)]);
		loose.triangles.push_back({first, first + 1, first + 2});
	}
	const auto wrapped = [](const shapes::Soup& of) {
		const TriangleTree tree(of.points, of.triangles);
		const WindingNumber winding(tree);
		return wrap(tree, winding, 0.08, 1000000);
	};
	const WrappedSurface one = wrapped(soup), other = wrapped(loose);
	EXPECT_EQ(one.triangles, other.triangles);
	ASSERT_EQ(one.points.size(), other.points.size());
	for (size_t v = 0; v < one.points.size(); ++v)
		EXPECT_NEAR(Distance(one.points[v], other.points[v]), 0, 0.01);
}
