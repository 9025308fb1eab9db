// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/mesh/breadth_first_numbering.h>
#include <skeleton/input/check_input.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace vcg::tri::mcf;
using checks::structureError;

namespace {

/// How far apart in the numbering the ends of an edge are, on average.
double meanDistance(const SurfaceMesh& mesh)
{
	double sum = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		sum += std::abs(mesh.origin(h) - mesh.target(h));
	return sum / mesh.halfEdgeSlots();
}

} // namespace

TEST(BreadthFirstOrder, KeepsTheMeshAndBringsNeighboursTogether)
{
	const SurfaceMesh mesh = shapes::shuffled(shapes::sphere(5)).mesh();
	const Numbering number = breadthFirstOrder(mesh);
	const SurfaceMesh ordered = mesh.renumbered(number.vertex, number.face);
	EXPECT_EQ(structureError(ordered), "");
	ASSERT_EQ(ordered.vertexCount(), mesh.vertexCount());
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		ASSERT_EQ(ordered.position[number.vertex[v]], mesh.position[v]);
	for (int f = 0; f < mesh.faceSlots(); ++f)
		for (int k = 0; k < 3; ++k)
			ASSERT_EQ(
				ordered.origin(3 * number.face[f] + k), number.vertex[mesh.origin(3 * f + k)]);
	EXPECT_LT(meanDistance(ordered), meanDistance(mesh) / 10);
}

TEST(BreadthFirstOrder, ClosesHolesInTheNumbering)
{
	SurfaceMesh mesh = shapes::torus().mesh();
	std::mt19937 random(4);
	shapes::changeAtRandom(mesh, 800, random);
	ASSERT_LT(mesh.vertexCount(), mesh.vertexSlots());
	const Numbering number = breadthFirstOrder(mesh);
	const SurfaceMesh ordered = mesh.renumbered(number.vertex, number.face);
	EXPECT_EQ(structureError(ordered), "");
	EXPECT_EQ(ordered.vertexSlots(), mesh.vertexCount());
	EXPECT_EQ(ordered.faceSlots(), mesh.faceCount());
	EXPECT_EQ(ordered.eulerCharacteristic(), 0);
	EXPECT_EQ(renumbered(mesh.position, number.vertex, mesh.vertexCount()), ordered.position);
	EXPECT_EQ(renumberBreadthFirst(mesh), number.vertex);
	EXPECT_EQ(mesh.position, ordered.position);
	EXPECT_EQ(mesh.triangles(), ordered.triangles());
}

TEST(BreadthFirstOrder, FindsTheComponentsInTheirOrder)
{
	const SurfaceMesh mesh = shapes::shuffled(
		shapes::joined({shapes::sphere(2), shapes::moved(shapes::torus(), {5, 0, 0}),
			shapes::moved(shapes::box(), {9, 0, 0})}))
								 .mesh();
	int count = 0;
	const std::vector<int> component = connectedComponents(mesh, &count);
	const Numbering number = breadthFirstOrder(mesh);
	EXPECT_EQ(number.components, count);
	EXPECT_EQ(renumbered(component, number.vertex, mesh.vertexCount()), number.component);
	EXPECT_TRUE(std::is_sorted(number.component.begin(), number.component.end()));

	// Seeds decide otherwise.
	std::vector<int> seeds(count, -1);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		seeds[count - 1 - component[v]] = mesh.outgoing(v);
	const Numbering reversed = breadthFirstOrder(mesh, seeds);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		ASSERT_EQ(reversed.component[reversed.vertex[v]], count - 1 - component[v]);
}

TEST(BreadthFirstOrder, DoesNotDependOnTheNumberingThereWas)
{
	// Without symmetry, so that each place is one of a kind.
	const shapes::Soup soup = shapes::transformed(shapes::sphere(3), [](const vcg::Point3d& p) {
		return vcg::Point3d(2 * p[0] + 0.1 * p[1], p[1] + 0.1 * p[2] * p[2], 0.7 * p[2]);
	});
	const auto ordered = [](const SurfaceMesh& mesh) {
		const Numbering number = breadthFirstOrder(mesh,
			minHalfEdges(
				mesh, connectedComponents(mesh), 1, [&](int v) { return mesh.position[v]; }));
		return mesh.renumbered(number.vertex, number.face, number.firstCorner);
	};
	shapes::Soup other = shapes::shuffled(soup);
	for (size_t f = 0; f < other.triangles.size(); ++f) {
		Triangle& t = other.triangles[f];
		std::rotate(t.begin(), t.begin() + f % 3, t.end());
	}
	const SurfaceMesh mesh = ordered(soup.mesh()), copy = ordered(other.mesh());
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.position, copy.position);
	EXPECT_EQ(mesh.triangles(), copy.triangles());
}
