// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "mesh_checks.h"
#include "shapes.h"

#include "skeleton/elimination_order.h"

#include <Eigen/SparseCholesky>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

Stage plainStage(const SurfaceMesh& mesh)
{
	return initialStage(mesh, checks::noPoles(mesh));
}

/// Entries of the full factor of a Laplacian, numbered as it is or in an ordering of Eigen's.
template <class Ordering>
long fill(const SymmetricRows& L)
{
	const systems::Sparse S =
		systems::sparse(L) + systems::diagonal(std::vector<double>(L.size(), 1));
	const Eigen::SimplicialLLT<systems::Sparse, Eigen::Lower, Ordering> factor(S);
	return long(factor.matrixL().nestedExpression().nonZeros());
}

} // namespace

TEST(EliminationOrder, HasEachFreeVertexOnce)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::box(), shapes::torus(), shapes::plate(2)}) {
		Stage stage = plainStage(soup.mesh());
		for (size_t v = 0; v < stage.fixed.size(); v += 5)
			stage.fixed[v] = 1;
		std::vector<int> order = eliminationOrder(stage), expected;
		for (int v = 0; v < stage.mesh.vertexCount(); ++v)
			if (!stage.fixed[v])
				expected.push_back(v);
		std::sort(order.begin(), order.end());
		EXPECT_EQ(order, expected);
	}
}

TEST(EliminationOrder, RanksAreAPermutation)
{
	Stage stage = plainStage(shapes::plate(3).mesh());
	rankByMinimumDegree(stage);
	std::vector<int> ranks = stage.rank;
	std::sort(ranks.begin(), ranks.end());
	for (size_t i = 0; i < ranks.size(); ++i)
		EXPECT_EQ(ranks[i], int(i));
	EXPECT_EQ(stage.rankedVertices, stage.mesh.vertexCount());
}

TEST(EliminationOrder, KeepsTheFactorSparse)
{
	const SurfaceMesh mesh = shapes::shuffled(shapes::torus(1, 0.3, 60, 20)).mesh();
	const SymmetricRows L = cotangentLaplacian(mesh);
	const long ordered = fill<Eigen::NaturalOrdering<int>>(systems::orderedLaplacian(mesh));
	EXPECT_LT(ordered, 1.1 * double(fill<Eigen::AMDOrdering<int>>(L)));
	EXPECT_LT(5 * ordered, fill<Eigen::NaturalOrdering<int>>(L));
}

TEST(EliminationOrder, IsInheritedUntilHalfOfTheVerticesAreGone)
{
	Stage stage = plainStage(shapes::torus().mesh());
	eliminationOrder(stage);
	const std::vector<int> inherited = stage.rank;
	eliminationOrder(stage);
	EXPECT_EQ(stage.rank, inherited);
	stage.rank.assign(stage.rank.size(), 0);
	stage.rankedVertices = 3 * stage.mesh.vertexCount();
	eliminationOrder(stage);
	EXPECT_EQ(stage.rank, inherited);
	EXPECT_EQ(stage.rankedVertices, stage.mesh.vertexCount());
}

TEST(EliminationOrder, BreaksTiesByNumber)
{
	Stage stage = plainStage(shapes::octahedron().mesh());
	eliminationOrder(stage);
	stage.rank = {2, -1, -1, 2, 0, -1}; // -1: made by a split; 2: merged twice
	EXPECT_EQ(eliminationOrder(stage), std::vector<int>({1, 2, 5, 4, 0, 3}));
}
