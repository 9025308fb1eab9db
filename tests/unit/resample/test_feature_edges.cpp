// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/resample/feature_edges.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

int creaseCount(const SurfaceMesh& mesh, const CreaseEdges& creases)
{
	int count = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (mesh.isHalfEdge(h)) {
			count += creases.isCrease(h);
			EXPECT_EQ(creases.isCrease(h), creases.isCrease(mesh.twin(h)));
		}
	return count / 2;
}

/// Whether an edge of the mesh runs along an edge of the unit cube.
bool isOnCubeEdge(const SurfaceMesh& mesh, int h)
{
	const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
	int shared = 0;
	for (int k = 0; k < 3; ++k)
		shared += a[k] == b[k] && (a[k] == 0 || a[k] == 1);
	return shared >= 2;
}

} // namespace

TEST(CreaseEdges, OfABoxAreItsTwelveEdges)
{
	const SurfaceMesh box = shapes::subdivided(shapes::subdivided(shapes::box())).mesh();
	const CreaseEdges creases(box, [](int) { return 0.5; });
	EXPECT_EQ(creaseCount(box, creases), 12 * 4);
	const std::vector<CreaseRole> role = creases.roles(box);
	EXPECT_EQ(std::count(role.begin(), role.end(), CreaseRole::Corner), 8);
	EXPECT_EQ(std::count(role.begin(), role.end(), CreaseRole::Crease), 12 * 3);
}

TEST(CreaseEdges, OfSmoothShapesAreNone)
{
	for (const shapes::Soup& soup : {shapes::sphere(2), shapes::torus(), shapes::capsule()}) {
		const SurfaceMesh mesh = soup.mesh();
		const CreaseEdges creases(mesh, [](int) { return 0.0; });
		EXPECT_TRUE(creases.empty());
		EXPECT_TRUE(creases.roles(mesh).empty());
	}
}

TEST(CreaseEdges, ThatAreShortDoNotCount)
{
	const SurfaceMesh box = shapes::subdivided(shapes::box()).mesh();
	EXPECT_EQ(creaseCount(box, CreaseEdges(box, [](int) { return 0.99; })), 24);
	EXPECT_TRUE(CreaseEdges(box, [](int) { return 1.01; }).empty());
}

TEST(CreaseEdges, OfNoiseAreFew)
{
	const SurfaceMesh noisy = shapes::jittered(shapes::sphere(5), 0.03).mesh();
	const CreaseEdges sharp(noisy, [](int) { return 0.0; });
	const CreaseEdges creases(noisy, [](int) { return 0.4; });
	EXPECT_GT(creaseCount(noisy, sharp), noisy.edgeCount() / 20);
	EXPECT_LT(creaseCount(noisy, creases), creaseCount(noisy, sharp) / 10);
}

TEST(CreaseEdges, LiveThroughSplitsFlipsCollapsesAndRenumbering)
{
	SurfaceMesh mesh = shapes::subdivided(shapes::box()).mesh();
	CreaseEdges creases(mesh, [](int) { return 0.5; });
	std::mt19937 random(3);
	for (int i = 0; i < 600; ++i) {
		const int h = int(random() % unsigned(mesh.halfEdgeSlots()));
		if (!mesh.isHalfEdge(h))
			continue;
		switch (random() % 3) {
		case 0:
			mesh.split(h, (mesh.position[mesh.origin(h)] + mesh.position[mesh.target(h)]) / 2.0);
			creases.afterSplit(mesh, h);
			break;
		case 1:
			if (!creases.isCrease(h) && mesh.isFlippable(h)) {
				creases.beforeFlip(mesh, h);
				mesh.flip(h);
			}
			break;
		default:
			// Only what leaves the edges of the cube where they are.
			const std::vector<CreaseRole> role = creases.roles(mesh);
			if (role[mesh.origin(h)] == CreaseRole::Smooth && mesh.isCollapsible(h)) {
				creases.beforeCollapse(mesh, h);
				mesh.collapse(h);
			}
		}
	}
	std::vector<int> newVertex(mesh.vertexSlots(), -1), newFace(mesh.faceSlots(), -1);
	int vertices = mesh.vertexCount(), faces = mesh.faceCount();
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.isVertex(v))
			newVertex[v] = --vertices;
	for (int f = 0; f < mesh.faceSlots(); ++f)
		if (mesh.isFace(f))
			newFace[f] = --faces;
	creases.beforeRenumber(mesh, newFace);
	mesh = mesh.renumbered(newVertex, newFace);
	// Flips within a side may run along an edge of the cube, too, but no crease is anywhere else,
	// and together the creases still are the whole edges.
	double length = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		if (creases.isCrease(h)) {
			EXPECT_TRUE(isOnCubeEdge(mesh, h));
			length += std::sqrt(mesh.squaredLength(h)) / 2;
		}
	EXPECT_NEAR(length, 12, 1e-9);
}

TEST(TrackCrease, FollowsTheCreaseAndStopsAtCorners)
{
	const SurfaceMesh box = shapes::subdivided(shapes::subdivided(shapes::box())).mesh();
	const CreaseEdges creases(box, [](int) { return 0.5; });
	const std::vector<CreaseRole> role = creases.roles(box);
	int start = -1;
	for (int h = 0; h < box.halfEdgeSlots(); ++h)
		if (box.position[box.origin(h)] == Point3d(0, 0, 0)
			&& box.position[box.target(h)] == Point3d(0.25, 0, 0))
			start = h;
	ASSERT_GE(start, 0);
	int h = start;
	EXPECT_LT(
		Distance(trackCrease(box, creases, role, {0.9, 0.1, -0.2}, h), Point3d(0.9, 0, 0)), 1e-15);
	EXPECT_GT(std::max(box.position[box.origin(h)][0], box.position[box.target(h)][0]), 0.9);
	EXPECT_EQ(trackCrease(box, creases, role, {2, 2, 2}, h), Point3d(1, 0, 0));
	EXPECT_EQ(trackCrease(box, creases, role, {-1, -1, 5}, h), Point3d(0, 0, 0));
}
