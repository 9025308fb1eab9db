// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Parts of a surface by the branches of its skeleton, and the table of the branches.

#include "curves.h"
#include "shapes.h"
#include <skeleton/graph/branch_table.h>
#include <skeleton/measure/segmentation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using namespace curves;

namespace {

/// A plate cross in the plane z = 0: four arms of width and height 1 that reach 3 from the middle.
shapes::Soup cross(int fine)
{
	const int n = 6 * fine, low = 5 * fine / 2, high = 7 * fine / 2;
	const auto within = [&](int i) { return i >= low && i < high; };
	return shapes::moved(
		shapes::cells(
			n, n, fine, [&](int i, int j, int) { return within(i) || within(j); }, 1.0 / fine),
		{-3, -3, -0.5});
}

CurveSkeleton crossSkeleton()
{
	CurveSkeleton s;
	const int middle = addNode(s, {0, 0, 0}, 0.5);
	addLine(s, middle, {2.5, 0, 0}, 0.5, 25);
	addLine(s, middle, {0, 2.5, 0}, 0.5, 25);
	addLine(s, middle, {-2.5, 0, 0}, 0.5, 25);
	addLine(s, middle, {0, -2.5, 0}, 0.5, 25);
	return s;
}

CurveSkeleton withClosestNodes(CurveSkeleton s, const SurfaceMesh& mesh)
{
	s.node = closestNodes(mesh.position, s);
	return s;
}

Point3d middleOf(const SurfaceMesh& mesh, int f)
{
	const Triangle t = mesh.triangle(f);
	return (mesh.position[t[0]] + mesh.position[t[1]] + mesh.position[t[2]]) / 3;
}

/// Connected pieces of faces with the same id, over edges.
int pieces(const SurfaceMesh& mesh, const std::vector<int>& ofFace)
{
	std::vector<char> seen(ofFace.size(), 0);
	int count = 0;
	for (int seed = 0; seed < int(ofFace.size()); ++seed) {
		if (seen[seed])
			continue;
		++count;
		std::vector<int> stack(1, seed);
		seen[seed] = 1;
		while (!stack.empty()) {
			const int f = stack.back();
			stack.pop_back();
			for (int k = 0; k < 3; ++k) {
				const int g = mesh.twin(3 * f + k) / 3;
				if (!seen[g] && ofFace[g] == ofFace[f]) {
					seen[g] = 1;
					stack.push_back(g);
				}
			}
		}
	}
	return count;
}

double borderLength(const SurfaceMesh& mesh, const std::vector<int>& ofFace)
{
	double length = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isEdge(h) && ofFace[h / 3] != ofFace[mesh.twin(h) / 3])
			length += std::sqrt(mesh.squaredLength(h));
	return length;
}

/// Faces that two neighbours of one other part have in between.
int teeth(const SurfaceMesh& mesh, const std::vector<int>& ofFace)
{
	int count = 0;
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		std::map<int, int> others;
		for (int k = 0; k < 3; ++k)
			if (const int other = ofFace[mesh.twin(3 * f + k) / 3]; other != ofFace[f])
				++others[other];
		for (const auto& entry : others)
			count += entry.second >= 2;
	}
	return count;
}

std::vector<double> areas(const SurfaceMesh& mesh, const std::vector<int>& ofFace, int parts)
{
	std::vector<double> area(parts, 0);
	for (int f = 0; f < mesh.faceSlots(); ++f)
		area[ofFace[f]] += mesh.doubleAreaVector(f).Norm() / 2;
	return area;
}

TEST(SurfaceParts, FourArmsOfACross)
{
	const SurfaceMesh mesh = cross(8).mesh();
	const CurveSkeleton s = withClosestNodes(crossSkeleton(), mesh);
	const std::vector<Branch> branches = skeletonBranches(s);
	const SurfaceParts parts = surfaceParts(mesh, s);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const Point3d m = middleOf(mesh, f);
		if (std::max(std::abs(m[0]), std::abs(m[1])) < 0.7)
			continue; // about the borders
		ASSERT_GE(parts.ofFace[f], 0);
		const Point3d tip = s.position[branches[parts.ofFace[f]].last()];
		EXPECT_GT(tip * m / 2.5, 0.7) << "an arm belongs to the branch that runs through it";
	}
	EXPECT_EQ(pieces(mesh, parts.ofFace), 4);
	EXPECT_EQ(teeth(mesh, parts.ofFace), 0);
	// The shortest cuts are two diagonals on each side of the plate and four edges of height 1.
	EXPECT_LT(borderLength(mesh, parts.ofFace), 1.35 * (4 * std::sqrt(2.0) + 4));
	for (double area : areas(mesh, parts.ofFace, 4))
		EXPECT_NEAR(area, mesh.area() / 4, 0.03 * mesh.area());
}

TEST(SurfaceParts, WrongCorrespondencesHereAndThereAreMended)
{
	const SurfaceMesh mesh = cross(8).mesh();
	CurveSkeleton s = withClosestNodes(crossSkeleton(), mesh);
	const SurfaceParts expected = surfaceParts(mesh, s);
	std::mt19937 random(5);
	for (int& v : s.node) {
		const unsigned dice = random() % 20;
		if (dice < 3)
			v = int(random() % s.position.size());
		else if (dice == 3)
			v = -1;
	}
	const SurfaceParts parts = surfaceParts(mesh, s);
	EXPECT_EQ(pieces(mesh, parts.ofFace), 4);
	EXPECT_EQ(teeth(mesh, parts.ofFace), 0);
	EXPECT_LT(borderLength(mesh, parts.ofFace), 1.5 * borderLength(mesh, expected.ofFace));
	const std::vector<double> area = areas(mesh, parts.ofFace, 4);
	for (double a : area)
		EXPECT_NEAR(a, mesh.area() / 4, 0.05 * mesh.area());
}

/// A capsule along x with a skeleton of two branches that meet at x = 0, where a stub hangs.
CurveSkeleton lineWithStub()
{
	CurveSkeleton s;
	const int middle = addNode(s, {0, 0, 0}, 0.35);
	addLine(s, middle, {-1, 0, 0}, 0.35, 20);
	addLine(s, middle, {1, 0, 0}, 0.35, 20);
	addLine(s, middle, {0, 0, 0.05}, 0.3, 1);
	return s;
}

TEST(SurfaceParts, BorderAcrossATubeIsAsLongAsTheTubeIsRound)
{
	const SurfaceMesh mesh = shapes::capsule(2, 0.35, 48).mesh();
	CurveSkeleton s = lineWithStub();
	std::mt19937 random(2);
	for (const Point3d& p : mesh.position) {
		// A ragged border: on either side by chance, up to 0.15 from the middle.
		const double jitter = 0.15 * (2.0 * random() / double(std::mt19937::max()) - 1);
		s.node.push_back(p[0] + jitter < 0 ? 10 : 30);
	}
	const SurfaceParts parts = surfaceParts(mesh, s);
	EXPECT_EQ(pieces(mesh, parts.ofFace), 2);
	EXPECT_EQ(teeth(mesh, parts.ofFace), 0);
	EXPECT_LT(borderLength(mesh, parts.ofFace), 1.25 * 2 * M_PI * 0.35);
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		const double x = middleOf(mesh, f)[0];
		if (std::abs(x) > 0.15) {
			EXPECT_EQ(parts.ofFace[f], x < 0 ? 0 : 1);
		}
	}
}

TEST(SurfaceParts, DistanceIsTheLocalThickness)
{
	const SurfaceMesh mesh = shapes::capsule(2, 0.35, 48).mesh();
	const CurveSkeleton s = withClosestNodes(line({-1, 0, 0}, {1, 0, 0}, 0.35, 10), mesh);
	for (double d : surfaceParts(mesh, s).distance)
		EXPECT_NEAR(d, 0.35, 1e-9);
}

TEST(SurfaceParts, ANeighbouringLimbIsNotOnesThickness)
{
	// A thick and a thin tube close to each other: the thick one's near side is closer to the thin
	// one's axis than to its own.
	const shapes::Soup thick = shapes::capsule(4, 1, 48);
	const shapes::Soup thin = shapes::moved(shapes::capsule(4, 0.1, 24), {0, 1.2, 0});
	const SurfaceMesh mesh = shapes::joined({thick, thin}).mesh();
	CurveSkeleton s = line({-2, 0, 0}, {2, 0, 0}, 1, 10);
	addLine(s, addNode(s, {-2, 1.2, 0}, 0.1), {2, 1.2, 0}, 0.1, 10);
	const int first = int(thick.points.size());
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		s.node.push_back(v < first ? 5 : 15);
	const SurfaceParts parts = surfaceParts(mesh, s);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_NEAR(parts.distance[v], v < first ? 1 : 0.1, 1e-9);
	EXPECT_EQ(pieces(mesh, parts.ofFace), 2);
}

TEST(SurfaceParts, ATorusIsOnePart)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	const CurveSkeleton s = withClosestNodes(circle(1, 0.3, 60), mesh);
	const SurfaceParts parts = surfaceParts(mesh, s);
	EXPECT_EQ(std::count(parts.ofFace.begin(), parts.ofFace.end(), 0), mesh.faceCount());
}

TEST(SurfaceParts, AComponentWithoutABranchHasNone)
{
	const shapes::Soup near = shapes::sphere(2), far = shapes::moved(shapes::sphere(2), {5, 0, 0});
	const SurfaceMesh mesh = shapes::joined({near, far}).mesh();
	CurveSkeleton s = line({-0.1, 0, 0}, {0.1, 0, 0}, 1, 2);
	addNode(s, {5, 0, 0}, 1);
	s = withClosestNodes(s, mesh);
	const SurfaceParts parts = surfaceParts(mesh, s);
	for (int f = 0; f < mesh.faceSlots(); ++f)
		EXPECT_EQ(parts.ofFace[f], middleOf(mesh, f)[0] < 2 ? 0 : -1);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.position[v][0] > 2) {
			EXPECT_NEAR(parts.distance[v], 1, 1e-9);
		}
}

TEST(SurfaceParts, ClosestNodesAreTheEndsOfTheClosestEdge)
{
	const CurveSkeleton s = line({0, 0, 0}, {4, 0, 0}, 1, 4);
	const std::vector<int> node =
		closestNodes({{-5, 1, 0}, {1.4, 2, 0}, {1.6, 2, 0}, {9, 0, 0}}, s);
	EXPECT_EQ(node, (std::vector<int> {0, 1, 2, 4}));
}

TEST(SurfaceParts, RefusesACorrespondenceThatDoesNotFit)
{
	const SurfaceMesh mesh = shapes::sphere(1).mesh();
	CurveSkeleton s = line({-0.1, 0, 0}, {0.1, 0, 0}, 1, 2);
	EXPECT_THROW(surfaceParts(mesh, s), InvalidInput);
	s.node.assign(mesh.vertexSlots(), 3);
	EXPECT_THROW(surfaceParts(mesh, s), InvalidInput);
}

TEST(BranchTable, LengthsRadiiAndEnds)
{
	CurveSkeleton s;
	const int middle = addNode(s, {0, 0, 0}, 2);
	const int a = addNode(s, {3, 0, 0}, 1), b = addNode(s, {3, 1, 0}, 0);
	addEdge(s, middle, a);
	addEdge(s, a, b);
	addLine(s, middle, {0, -4, 0}, 2, 4);
	addLine(s, middle, {0, 0, 5}, 3, 1);
	const std::vector<Branch> branches = skeletonBranches(s);
	const std::vector<BranchRecord> table = branchTable(s, branches);
	ASSERT_EQ(table.size(), 3u);
	EXPECT_DOUBLE_EQ(table[0].length, 4);
	EXPECT_DOUBLE_EQ(table[0].meanRadius, (3 * 1.5 + 1 * 0.5) / 4);
	EXPECT_DOUBLE_EQ(table[0].minRadius, 0);
	EXPECT_DOUBLE_EQ(table[0].greatestRadius, 2);
	EXPECT_EQ(table[0].first, BranchEnd::Junction);
	EXPECT_EQ(table[0].last, BranchEnd::Tip);
	EXPECT_DOUBLE_EQ(table[1].meanRadius, 2);
	EXPECT_DOUBLE_EQ(table[2].meanRadius, 2.5);
}

TEST(BranchTable, EndsOfCyclesAndOfBars)
{
	CurveSkeleton s = circle(1, 0.2, 6);
	EXPECT_EQ(branchTable(s, skeletonBranches(s))[0].first, BranchEnd::Itself);
	EXPECT_EQ(branchTable(s, skeletonBranches(s))[0].last, BranchEnd::Itself);
	addLine(s, 0, {3, 0, 0}, 0.2, 2);
	const std::vector<BranchRecord> table = branchTable(s, skeletonBranches(s));
	ASSERT_EQ(table.size(), 2u);
	EXPECT_EQ(table[0].first, BranchEnd::Junction);
	for (const BranchRecord& record : table)
		EXPECT_EQ(record.last, record.length > 3 ? BranchEnd::Junction : BranchEnd::Tip);
}

} // namespace
