// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "mesh_checks.h"
#include "shapes.h"

#include "skeleton/elimination_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

Stage plainStage(const SurfaceMesh& mesh)
{
	return initialStage(mesh, checks::noPoles(mesh));
}

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

TEST(EliminationOrder, HasEachFreeVertexOnceTheLastOneFirst)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::box(), shapes::torus(), shapes::plate(2)}) {
		Stage stage = plainStage(soup.mesh());
		for (size_t v = 0; v < stage.fixed.size(); v += 5)
			stage.fixed[v] = 1;
		std::vector<int> expected;
		for (int v = 0; v < stage.mesh.vertexCount(); ++v)
			if (!stage.fixed[v])
				expected.insert(expected.begin(), v);
		EXPECT_EQ(eliminationOrder(stage), expected);
	}
}

TEST(EliminationOrder, HasANarrowEnvelope)
{
	const int rings = 60, sides = 20;
	const SurfaceMesh mesh = shapes::shuffled(shapes::torus(1, 0.3, rings, sides)).mesh();
	const long ordered = envelope(systems::orderedLaplacian(mesh));
	// Two fronts run round the torus, one to each side.
	EXPECT_LT(ordered, 4 * sides * mesh.vertexCount());
	EXPECT_LT(5 * ordered, envelope(cotangentLaplacian(mesh)));
}
