// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/fill_reducing_order.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

/// What a full factor of a matrix has room for between the first entry of each row and its diagonal.
long envelope(const SymmetricRows& A)
{
	long sum = 0;
	for (int i = 0; i < A.size(); ++i) {
		int first = i;
		for (int k = A.start[i]; k < A.start[i + 1]; ++k)
			first = std::min(first, A.entries[k].index);
		sum += i - first;
	}
	return sum;
}

} // namespace

TEST(EliminationOrder, HasEachFreeVertexOnceTheLastOnesFirst)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::box(), shapes::torus(), shapes::plate(2)}) {
		Stage stage = checks::plainStage(soup.mesh());
		for (size_t v = 0; v < stage.fixed.size(); v += 5)
			stage.fixed[v] = 1;
		std::vector<int> expected;
		for (int v = 0; v < stage.mesh.vertexCount(); ++v)
			if (!stage.fixed[v])
				expected.insert(expected.begin(), v);
		std::vector<int> order = eliminationOrder(stage);
		ASSERT_EQ(order.size(), expected.size());
		constexpr size_t turn = 40; // within so many, two halves take turns
		for (size_t first = 0; first < order.size(); first += turn)
			std::sort(order.begin() + long(first),
				order.begin() + long(std::min(first + turn, order.size())), std::greater<int>());
		EXPECT_EQ(order, expected);
	}
}

TEST(EliminationOrder, HasTheComponentsOneAfterTheOther)
{
	const shapes::Soup torus = shapes::torus(1, 0.3, 20, 10);
	shapes::Soup both = shapes::joined({torus, shapes::moved(torus, {5, 0, 0})});
	const Stage stage = checks::plainStage(shapes::shuffled(both).mesh());
	ASSERT_EQ(stage.diagonal.size(), 2u);
	std::vector<int> component;
	for (int v : eliminationOrder(stage))
		component.push_back(stage.component[v]);
	EXPECT_EQ(component.size(), stage.fixed.size());
	EXPECT_TRUE(std::is_sorted(component.begin(), component.end()));
}

TEST(EliminationOrder, WhatFollowsInItIsSeldomNextOnTheMesh)
{
	SurfaceMesh mesh = shapes::torus(1, 0.3, 60, 20).mesh();
	renumberBreadthFirst(mesh);
	const std::vector<int> order = eliminationOrder(checks::plainStage(mesh));
	const auto neighbours = [&](size_t i, size_t j) {
		return mesh.findHalfEdge(order[i], order[j]) >= 0;
	};
	int next = 0, afterNext = 0;
	for (size_t i = 2; i < order.size(); ++i) {
		next += neighbours(i - 1, i);
		afterNext += neighbours(i - 2, i);
	}
	EXPECT_LT(10 * next, int(order.size()));
	EXPECT_GT(2 * afterNext, int(order.size())); // as in the numbering of the mesh
}

TEST(EliminationOrder, HasANarrowEnvelope)
{
	const int rings = 60, sides = 20;
	const SurfaceMesh mesh = shapes::shuffled(shapes::torus(1, 0.3, rings, sides)).mesh();
	const long ordered = envelope(systems::orderedLaplacian(mesh));
	// Two fronts run round the torus, one to each side.
	EXPECT_LT(ordered, 4 * sides * mesh.vertexCount());
	EXPECT_LT(5 * ordered, envelope(systems::cotangentLaplacian(mesh)));
}
