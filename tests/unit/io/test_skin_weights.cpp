// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../curves.h"
#include "../shapes.h"

#include <skeleton/io/skin_weights.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

using namespace curves;
using namespace vcg::tri::mcf;

namespace {

struct Rigged
{
	SkinnedSurface surface;
	CurveSkeleton skeleton;
	Armature armature;

	/// Each vertex goes with the nearest node.
	Rigged(const shapes::Soup& soup, CurveSkeleton curve, double tolerance) :
			surface {soup.points, soup.triangles}, skeleton(std::move(curve))
	{
		for (const Point3d& p : surface.position) {
			int nearest = 0;
			for (size_t i = 0; i < skeleton.position.size(); ++i)
				if (SquaredDistance(p, skeleton.position[i])
					< SquaredDistance(p, skeleton.position[size_t(nearest)]))
					nearest = int(i);
			skeleton.node.push_back(nearest);
		}
		armature = makeArmature(skeleton, tolerance);
	}

	/// The largest factor by which an edge of the surface grows when the bone turns by 45 degrees about an axis.
	double stretch(int turned, int axis, const std::vector<VertexShares>& shares) const
	{
		std::vector<char> follows(armature.bones.size(), 0);
		for (size_t b = 0; b < follows.size(); ++b) {
			const int parent = armature.bones[b].parent;
			follows[b] = int(b) == turned || (parent >= 0 && follows[size_t(parent)]);
		}
		const Point3d pivot = skeleton.position[size_t(armature.bones[size_t(turned)].head())];
		std::vector<Point3d> posed;
		for (size_t v = 0; v < surface.position.size(); ++v) {
			const Point3d& p = surface.position[v];
			Point3d q = p - pivot;
			const int i = (axis + 1) % 3, j = (axis + 2) % 3;
			const double c = std::sqrt(0.5), x = q[i], y = q[j];
			q[i] = c * (x - y);
			q[j] = c * (x + y);
			double share = 0;
			for (size_t k = 0; k < 4; ++k)
				share += follows[size_t(shares[v].bone[k])] ? shares[v].weight[k] : 0;
			posed.push_back(p + (pivot + q - p) * share);
		}
		double maximum = 0;
		for (const std::array<int, 3>& face : surface.faces)
			for (size_t k = 0; k < 3; ++k) {
				const size_t a = size_t(face[k]), b = size_t(face[(k + 1) % 3]);
				maximum = std::max(maximum,
					Distance(posed[a], posed[b])
						/ Distance(surface.position[a], surface.position[b]));
			}
		return maximum;
	}

	double largestStretch(const std::vector<VertexShares>& shares) const
	{
		double maximum = 0;
		for (size_t b = 0; b < armature.bones.size(); ++b)
			for (int axis = 0; axis < 3; ++axis)
				maximum = std::max(maximum, stretch(int(b), axis, shares));
		return maximum;
	}

	std::vector<VertexShares> weights() const { return skinWeights(surface, skeleton, armature); }

	/// What each vertex's node says, without a look at its neighbours.
	std::vector<VertexShares> weightsOfNodes() const
	{
		std::vector<VertexShares> shares(surface.position.size());
		for (size_t v = 0; v < shares.size(); ++v) {
			size_t k = 0;
			for (const auto& [bone, weight] : armature.weights[size_t(skeleton.node[v])]) {
				shares[v].bone[k] = bone;
				shares[v].weight[k++] = weight;
			}
		}
		return shares;
	}
};

/// A star with arms along both ways of two axes, or of all three: six cells wide, twelve long.
Rigged star(int axes)
{
	constexpr int length = 12, half = 3, size = 2 * (length + half), middle = size / 2;
	const auto isThick = [](int i) { return std::abs(2 * (i - middle) + 1) < 2 * half; };
	const shapes::Soup soup = shapes::cells(size, size, size, [&](int i, int j, int k) {
		const int outside = !isThick(i) + !isThick(j) + !isThick(k);
		return outside == 0 || (outside == 1 && (axes == 3 || isThick(k)));
	});
	CurveSkeleton curve;
	const Point3d centre(middle, middle, middle);
	addNode(curve, centre, half + 1);
	for (int axis = 0; axis < axes; ++axis)
		for (int side : {-1, 1}) {
			Point3d end = centre;
			end[axis] += side * (length + half - 0.5);
			addLine(curve, 0, end, half, length + half);
		}
	return Rigged(soup, curve, 0.1);
}

Rigged ring()
{
	return Rigged(shapes::torus(), circle(1, 0.3, 60), 0.02);
}

} // namespace

TEST(SkinWeights, AddUpToOneOverAtMostFourBones)
{
	for (const Rigged& rigged : {star(2), star(3), ring()}) {
		const std::vector<VertexShares> shares = rigged.weights();
		ASSERT_EQ(shares.size(), rigged.surface.position.size());
		for (const VertexShares& of : shares) {
			double sum = 0;
			for (size_t k = 0; k < 4; ++k) {
				EXPECT_GE(of.weight[k], 0);
				EXPECT_LT(size_t(of.bone[k]), rigged.armature.bones.size());
				for (size_t l = 0; l < k; ++l)
					EXPECT_TRUE(of.bone[k] != of.bone[l] || of.weight[k] == 0);
				sum += of.weight[k];
			}
			EXPECT_NEAR(sum, 1, 1e-12);
		}
	}
}

/// At a junction neighbouring vertices go with different limbs: by their nodes alone the surface would tear.
TEST(SkinWeights, ALimbThatIsTurnedTearsNothing)
{
	for (int axes : {2, 3}) {
		const Rigged rigged = star(axes);
		EXPECT_GT(rigged.largestStretch(rigged.weightsOfNodes()), 3);
		EXPECT_LT(rigged.largestStretch(rigged.weights()), axes == 2 ? 2 : 2.5);
	}
}

/// Where a cycle was cut, what moves away takes the other side with it, within the thickness of the ring.
TEST(SkinWeights, ACutCycleIsDrawnOutRatherThanTorn)
{
	const Rigged rigged = ring();
	EXPECT_LT(rigged.largestStretch(rigged.weights()),
		0.5 * rigged.largestStretch(rigged.weightsOfNodes()));
}

TEST(SkinWeights, TheEndOfALimbFollowsItsBoneAlone)
{
	const Rigged rigged = star(2);
	const std::vector<VertexShares> shares = rigged.weights();
	int ends = 0;
	for (size_t v = 0; v < shares.size(); ++v)
		if (rigged.surface.position[v][0] < 0.5) {
			++ends;
			EXPECT_GT(shares[v].weight[0], 0.99);
		}
	EXPECT_GT(ends, 20);
}

/// Triangles with vertices of their own, as in an STL file, stay together.
TEST(SkinWeights, VerticesAtTheSamePlaceMoveTogether)
{
	const Rigged whole = star(2);
	const Rigged apart(
		shapes::unmerged({whole.surface.position, whole.surface.faces}), whole.skeleton, 0.1);
	const std::vector<VertexShares> shares = apart.weights();
	EXPECT_LT(apart.largestStretch(shares), 2);
	std::vector<int> first(whole.surface.position.size(), -1);
	for (size_t f = 0; f < whole.surface.faces.size(); ++f)
		for (size_t k = 0; k < 3; ++k) {
			int& of = first[size_t(whole.surface.faces[f][k])];
			if (of < 0)
				of = int(3 * f + k);
			EXPECT_EQ(shares[3 * f + k].bone, shares[size_t(of)].bone);
			EXPECT_EQ(shares[3 * f + k].weight, shares[size_t(of)].weight);
		}
}

TEST(SkinWeights, AVertexWithoutANodeFollowsTheNearestOne)
{
	// Of nodes at the same distance, as in the star's plane of symmetry, the first.
	for (const Rigged& rigged : {star(2), ring()}) {
		Rigged without = rigged;
		without.skeleton.node.assign(without.skeleton.node.size(), -1);
		const std::vector<VertexShares> expected = rigged.weights(), found = without.weights();
		for (size_t v = 0; v < expected.size(); ++v) {
			EXPECT_EQ(found[v].bone, expected[v].bone);
			EXPECT_EQ(found[v].weight, expected[v].weight);
		}
	}
}

/// Neither a vertex without faces, nor one without a place, nor triangles without area keep the others from it.
TEST(SkinWeights, WhatIsNoSurfaceFollowsItsNode)
{
	Rigged rigged = star(2);
	const size_t n = rigged.surface.position.size();
	const Point3d tip = rigged.skeleton.position[15];
	for (const Point3d& p : {tip, tip, tip, Point3d(NAN, 0, 0)})
		rigged.surface.position.push_back(p);
	rigged.surface.faces.push_back({int(n), int(n) + 1, int(n) + 2});
	rigged.surface.faces.push_back({int(n), int(n) + 1, int(n) + 3});
	rigged.skeleton.node.insert(rigged.skeleton.node.end(), {15, 15, -1, -1});
	const std::vector<VertexShares> shares = rigged.weights();
	for (const VertexShares& of : shares)
		EXPECT_NEAR(of.weight[0] + of.weight[1] + of.weight[2] + of.weight[3], 1, 1e-12);
	EXPECT_EQ(shares[n].bone[0], rigged.armature.weights[15][0].first);
}
