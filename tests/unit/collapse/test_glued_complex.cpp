// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/collapse/glued_complex.h>

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;
using Outcome = GluedComplex::Outcome;

namespace {

/// Components and cycles of what is left when no face is.
std::pair<int, int> componentsAndCycles(GluedComplex& complex)
{
	CurveSkeleton graph;
	std::vector<int> number(complex.nodeSlots(), -1);
	for (int A = 0; A < complex.nodeSlots(); ++A)
		if (complex.find(A) == A) {
			number[A] = int(graph.position.size());
			graph.position.push_back(complex.position(A));
		}
	for (int A = 0; A < complex.nodeSlots(); ++A)
		if (number[A] >= 0)
			for (int B : complex.curveNeighbours(A))
				if (A < B)
					graph.edges.push_back({number[A], number[B]});
	const SkeletonStatistics s = statistics(graph);
	return {s.components, s.cycles};
}

/// Contracts edges in random order until no face is left, helping itself where all are blocked.
void contractAtRandom(GluedComplex& complex, std::mt19937& random)
{
	int stuck = 0;
	while (complex.faceCount() > 0) {
		const std::vector<std::pair<int, int>> edges = complex.surfaceEdges();
		const auto [A, B] = edges[random() % edges.size()];
		const bool forwards = random() % 2;
		if (complex.contract(forwards ? A : B, forwards ? B : A) == Outcome::Contracted) {
			stuck = 0;
			continue;
		}
		if (++stuck < 3 * int(edges.size()))
			continue;
		bool helped = false;
		for (const auto& [C, D] : edges)
			helped = helped || complex.removeFreeEdge(C, D) || complex.cut(C, D);
		ASSERT_TRUE(helped || complex.emptyBalls());
	}
}

} // namespace

TEST(GluedComplex, StartsAsTheSurface)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 8, 6).mesh();
	GluedComplex complex(mesh);
	EXPECT_EQ(complex.nodeSlots(), mesh.vertexCount());
	EXPECT_EQ(complex.faceCount(), mesh.faceCount());
	EXPECT_EQ(int(complex.surfaceEdges().size()), mesh.edgeCount());
	for (int v = 0; v < mesh.vertexCount(); ++v) {
		EXPECT_EQ(int(complex.surfaceNeighbours(v).size()), mesh.valence(v));
		EXPECT_TRUE(complex.curveNeighbours(v).empty());
		EXPECT_EQ(complex.position(v), mesh.position[v]);
	}
}

TEST(GluedComplex, ATetrahedronBecomesOneEdge)
{
	GluedComplex complex(shapes::tetrahedron().mesh());
	EXPECT_EQ(complex.contract(0, 1), Outcome::Contracted); // leaves two triangles back to back
	EXPECT_EQ(complex.faceCount(), 2);
	EXPECT_EQ(complex.find(0), 1);
	EXPECT_EQ(complex.contract(1, 2), Outcome::Contracted);
	EXPECT_EQ(complex.faceCount(), 0);
	EXPECT_EQ(complex.curveNeighbours(2), std::set<int>({3}));
	EXPECT_EQ(complex.curveNeighbours(3), std::set<int>({2}));
	EXPECT_EQ(complex.contract(2, 3), Outcome::NoFaces);
}

TEST(GluedComplex, ANodeLiesAtTheMeanOfItsVertices)
{
	const SurfaceMesh mesh = shapes::sphere(1).mesh();
	GluedComplex complex(mesh);
	std::mt19937 random(1);
	for (int i = 0; i < 12; ++i) {
		const auto edges = complex.surfaceEdges();
		const auto [A, B] = edges[random() % edges.size()];
		complex.contract(A, B);
	}
	std::vector<Point3d> sum(mesh.vertexCount(), Point3d(0, 0, 0));
	std::vector<int> count(mesh.vertexCount(), 0);
	for (int v = 0; v < mesh.vertexCount(); ++v) {
		sum[complex.find(v)] += mesh.position[v];
		++count[complex.find(v)];
	}
	for (int v = 0; v < mesh.vertexCount(); ++v)
		if (complex.find(v) == v) {
			EXPECT_LT(vcg::Distance(complex.position(v), sum[v] / double(count[v])), 1e-14);
		}
}

TEST(GluedComplex, ATubeOfThreeEdgesIsCutAndStaysConnected)
{
	// Contracting an edge around the tube pinches it; a tube is no cycle, so it must be possible.
	GluedComplex complex(shapes::capsule(2, 0.3, 3).mesh());
	std::mt19937 random(2);
	contractAtRandom(complex, random);
	EXPECT_EQ(componentsAndCycles(complex), std::make_pair(1, 0));
}

TEST(GluedComplex, ACycleOfThreeEdgesIsNeverContracted)
{
	// A torus of 3 x n: once its tube is a curve, three curve edges are left, or the last contraction
	// was refused; whatever the order, the cycle is there in the end.
	for (unsigned seed = 0; seed < 50; ++seed) {
		GluedComplex complex(shapes::torus(1, 0.3, 3, 3).mesh());
		std::mt19937 random(seed);
		contractAtRandom(complex, random);
		ASSERT_EQ(componentsAndCycles(complex), std::make_pair(1, 1)) << "seed " << seed;
	}
}

TEST(GluedComplex, OnlyAFreeEdgeIsRemoved)
{
	// Two triangles back to back: every edge is free; a tetrahedron has none.
	const SurfaceMesh pillow({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}});
	GluedComplex flat(pillow);
	EXPECT_TRUE(flat.removeFreeEdge(0, 1));
	EXPECT_EQ(flat.faceCount(), 0);
	EXPECT_EQ(flat.curveNeighbours(2), std::set<int>({0, 1}));
	EXPECT_FALSE(flat.removeFreeEdge(0, 2)); // a curve edge now
	GluedComplex solid(shapes::tetrahedron().mesh());
	EXPECT_FALSE(solid.removeFreeEdge(0, 1));
}

TEST(GluedComplex, AnEmptiedBallIsTheRestOfItsSurface)
{
	GluedComplex complex(shapes::octahedron().mesh());
	EXPECT_TRUE(complex.emptyBalls());
	EXPECT_EQ(complex.faceCount(), 2 * 7); // pillows on all triangles but the opened one
	EXPECT_FALSE(complex.emptyBalls());
	// A disc of seven triangles: its free edges can be taken away until a tree is left.
	for (bool any = true; any;) {
		any = false;
		for (const auto& [A, B] : complex.surfaceEdges())
			any |= complex.removeFreeEdge(A, B);
	}
	EXPECT_EQ(complex.faceCount(), 0);
	EXPECT_EQ(componentsAndCycles(complex), std::make_pair(1, 0));
}

TEST(GluedComplex, ABodyWithAHoleIsNoBall)
{
	GluedComplex complex(shapes::csaszarTorus().mesh());
	EXPECT_FALSE(complex.emptyBalls());
	EXPECT_EQ(complex.faceCount(), 14);
}

TEST(GluedComplex, CurveEdgesAreContractedUnlessACycleVanishes)
{
	GluedComplex complex(shapes::csaszarTorus().mesh());
	std::mt19937 random(4);
	contractAtRandom(complex, random);
	ASSERT_EQ(componentsAndCycles(complex), std::make_pair(1, 1));
	for (bool any = true; any;) {
		any = false;
		for (int A = 0; A < complex.nodeSlots() && !any; ++A)
			if (complex.find(A) == A)
				for (int B : complex.curveNeighbours(A))
					if (complex.contractCurveEdge(A, B)) {
						any = true;
						break;
					}
	}
	EXPECT_EQ(componentsAndCycles(complex), std::make_pair(1, 1));
	int nodes = 0;
	for (int A = 0; A < complex.nodeSlots(); ++A)
		nodes += complex.find(A) == A;
	EXPECT_EQ(nodes, 3); // the smallest simple graph with a cycle
}

TEST(GluedComplex, AnyOrderKeepsComponentsAndGenus)
{
	for (unsigned seed = 0; seed < 120; ++seed) {
		std::mt19937 random(seed);
		shapes::Soup soup =
			shapes::withTunnels(shapes::sphere(1 + int(seed % 2)), int(random() % 4), random);
		if (seed % 3 == 0)
			soup = shapes::joined({soup, shapes::csaszarTorus(), shapes::tetrahedron()});
		SurfaceMesh mesh = soup.mesh();
		shapes::changeAtRandom(mesh, int(random() % 300), random);
		mesh.compact();
		int components = 0;
		connectedComponents(mesh, &components);
		GluedComplex complex(mesh);
		contractAtRandom(complex, random);
		ASSERT_EQ(componentsAndCycles(complex), std::make_pair(components, checks::genus(mesh)))
			<< "seed " << seed;
	}
}
