// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "read_off.h"
#include "shapes.h"

#include <skeleton/core/errors.h>
#include <skeleton/mesh/cut_edges.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

SurfaceMesh cut(const SurfaceMesh& mesh, double longest)
{
	return withCutEdges(mesh, std::vector<double>(size_t(mesh.vertexSlots()), longest));
}

std::vector<Point3d> placesInOrder(const SurfaceMesh& mesh)
{
	std::vector<Point3d> places = mesh.position;
	std::sort(places.begin(), places.end());
	return places;
}

/// The middles of all edges, in order: with the places they tell how triangles were divided.
std::vector<Point3d> middlesInOrder(const SurfaceMesh& mesh)
{
	std::vector<Point3d> middles;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isEdge(h))
			middles.push_back((mesh.position[mesh.origin(h)] + mesh.position[mesh.target(h)]) / 2);
	std::sort(middles.begin(), middles.end());
	return middles;
}

} // namespace

TEST(CutEdges, TheShapeIsTheSameAndItsEdgesAreInPieces)
{
	for (const shapes::Soup& soup : {shapes::torus(1, 0.3, 12, 6), shapes::box(1, 2, 4),
			 shapes::tetrahedron(), shapes::box(0.01, 0.01, 4),
			 shapes::joined({shapes::box(), shapes::moved(shapes::octahedron(), {5, 0, 0})})}) {
		const SurfaceMesh mesh = soup.mesh();
		const double limit = 0.02 * mesh.bounds().Diag();
		const SurfaceMesh finer = cut(mesh, limit);
		EXPECT_EQ(checks::structureError(finer), "");
		EXPECT_EQ(finer.eulerCharacteristic(), mesh.eulerCharacteristic());
		EXPECT_NEAR(finer.area(), mesh.area(), 1e-9 * mesh.area());
		EXPECT_NEAR(finer.volume(), mesh.volume(), 1e-9 * mesh.volume());
		ASSERT_TRUE(std::equal(mesh.position.begin(), mesh.position.end(), finer.position.begin()));
		double pieces = 0;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isEdge(h))
				pieces += std::ceil(std::sqrt(mesh.squaredLength(h)) / limit) - 1;
		EXPECT_EQ(finer.vertexCount(), mesh.vertexCount() + int(pieces));
		for (int f = 0; f < finer.faceSlots(); ++f)
			ASSERT_GT(finer.doubleAreaVector(f).Norm(), 0) << f;
	}
}

TEST(CutEdges, ANarrowTriangleBecomesAStrip)
{
	const SurfaceMesh rod = shapes::box(0.01, 0.01, 4).mesh();
	const SurfaceMesh finer = cut(rod, 0.02);
	// Four edges and four diagonals along it, in 200 pieces; no piece is longer than the limit.
	EXPECT_NEAR(finer.vertexCount(), 8 + 8 * 199, 16);
	for (int h = 0; h < finer.halfEdgeSlots(); ++h)
		ASSERT_LT(std::sqrt(finer.squaredLength(h)), 1.5 * 0.02);
}

TEST(CutEdges, LimitsMayDifferAndGrowEvenlyInBetween)
{
	const SurfaceMesh rod = shapes::box(0.05, 0.05, 10).mesh();
	std::vector<double> longest;
	for (const Point3d& p : rod.position)
		longest.push_back(p[2] < 5 ? 0.1 : 1);
	const SurfaceMesh finer = withCutEdges(rod, longest);
	EXPECT_EQ(checks::structureError(finer), "");
	for (int h = 0; h < finer.halfEdgeSlots(); ++h) {
		const double z =
			(finer.position[finer.origin(h)][2] + finer.position[finer.target(h)][2]) / 2;
		EXPECT_LE(std::sqrt(finer.squaredLength(h)), 1.5 * (0.1 + 0.09 * z));
	}
	EXPECT_EQ(piecesOfEdge(10, 0.1, 1), std::ceil(10 / 0.9 * std::log(10)));
	EXPECT_EQ(piecesOfEdge(10, 1, 0.1), piecesOfEdge(10, 0.1, 1));
	EXPECT_EQ(piecesOfEdge(10, 2, 2), 5);
	EXPECT_EQ(piecesOfEdge(1, 2, 7), 1);
}

TEST(CutEdges, ShortEdgesStay)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	EXPECT_EQ(cut(mesh, 10).triangles(), mesh.triangles());
}

TEST(CutEdges, NumberingAndPlaceDoNotMatter)
{
	const double c = std::cos(0.7), s = std::sin(0.7), scale = 1e-3;
	const auto turned = [&](const Point3d& p) {
		return Point3d(c * p[0] - s * p[1], p[2], -s * p[0] - c * p[1]) * scale + Point3d(1, 2, 3);
	};
	for (const shapes::Soup& soup : {shapes::fromFile("animal450"), shapes::box(1, 2, 4)}) {
		const SurfaceMesh mesh = soup.mesh();
		const double limit = 0.02 * mesh.bounds().Diag();
		const SurfaceMesh here = cut(mesh, limit),
						  shuffled = cut(shapes::shuffled(soup).mesh(), limit);
		const std::vector<Point3d> places = placesInOrder(here), again = placesInOrder(shuffled);
		ASSERT_EQ(again.size(), places.size());
		const std::vector<Point3d> middles = middlesInOrder(here),
								   others = middlesInOrder(shuffled);
		for (size_t i = 0; i < middles.size(); ++i)
			ASSERT_LT(Distance(middles[i], others[i]), 1e-9);
	}
	const shapes::Soup animal = shapes::fromFile("animal450");
	const double limit = 0.02 * animal.mesh().bounds().Diag();
	EXPECT_EQ(cut(shapes::transformed(animal, turned).mesh(), limit * scale).triangles(),
		cut(animal.mesh(), limit).triangles());
}

TEST(CutEdges, CancelledAtOnce)
{
	const SurfaceMesh mesh = shapes::box().mesh();
	const Progress never([](int, const char*) { return false; });
	EXPECT_THROW(withCutEdges(mesh, std::vector<double>(8, 0.01), never), Cancelled);
}
