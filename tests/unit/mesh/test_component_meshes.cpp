// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"
#include "threads.h"

#include <skeleton/input/check_input.h>
#include <skeleton/mesh/component_meshes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// @return the components that were visited, in turn.
template <class Visitor>
std::vector<int> visited(const SurfaceMesh& mesh, const Progress& progress, const Visitor& visit)
{
	int components = 0;
	const std::vector<int> component = connectedComponents(mesh, &components);
	std::vector<int> order;
	forEachComponent(mesh, component, components, progress,
		[&](int c, const SurfaceMesh& own, const std::vector<int>& ids, const Progress& part) {
			order.push_back(c);
			visit(c, own, ids, part);
		});
	return order;
}

} // namespace

TEST(ForEachComponent, HandsOverTheBodiesThatWereJoined)
{
	const std::vector<shapes::Soup> bodies = {
		shapes::torus(), shapes::moved(shapes::sphere(2), {9, 0, 0}), shapes::tetrahedron()};
	const SurfaceMesh mesh = shapes::joined({bodies[0], bodies[1], bodies[2]}).mesh();
	int first = 0;
	const std::vector<int> order = visited(mesh, Progress(),
		[&](int c, const SurfaceMesh& own, const std::vector<int>& ids, const Progress&) {
			EXPECT_EQ(own.position, bodies[size_t(c)].points);
			EXPECT_EQ(own.triangles(), bodies[size_t(c)].triangles);
			for (int id : ids)
				EXPECT_EQ(id, first++);
		});
	EXPECT_EQ(order, (std::vector<int> {0, 1, 2}));
}

TEST(ForEachComponent, TellsTheirVerticesApartInAnyNumbering)
{
	const SurfaceMesh mesh = shapes::shuffled(
		shapes::joined({shapes::torus(), shapes::moved(shapes::sphere(2), {9, 0, 0})}), 7)
								 .mesh();
	std::vector<int> all;
	const std::vector<int> order = visited(mesh, Progress(),
		[&](int, const SurfaceMesh& own, const std::vector<int>& ids, const Progress&) {
			EXPECT_EQ(own.eulerCharacteristic(), own.position[0][0] > 5 ? 2 : 0);
			for (size_t i = 0; i < ids.size(); ++i) {
				EXPECT_EQ(own.position[i], mesh.position[ids[i]]);
				EXPECT_EQ(own.position[i][0] > 5, own.position[0][0] > 5);
			}
			all.insert(all.end(), ids.begin(), ids.end());
		});
	EXPECT_EQ(order.size(), 2u);
	EXPECT_EQ(all.size(), size_t(mesh.vertexSlots()));
}

TEST(ForEachComponent, VisitsLargeOnesFirstAndEachOnceOnAnyThreads)
{
	shapes::Soup soup = shapes::tetrahedron();
	for (int i = 1; i <= 40; ++i)
		soup = shapes::joined({soup, shapes::moved(shapes::sphere(3), {3. * i, 0, 0})});
	soup = shapes::joined({soup, shapes::moved(shapes::sphere(6), {0, 3, 0})});
	const SurfaceMesh mesh = soup.mesh();
	for (int threads : {1, 3}) {
		const ThreadCount used(threads);
		std::atomic<int> count = 0;
		int components = 0;
		const std::vector<int> component = connectedComponents(mesh, &components);
		ASSERT_EQ(components, 42);
		std::vector<int> turn(42, -1);
		forEachComponent(mesh, component, components, Progress(),
			[&](int c, const SurfaceMesh& own, const std::vector<int>& ids, const Progress&) {
				turn[size_t(c)] = count++;
				EXPECT_EQ(own.position.size(), ids.size());
				EXPECT_EQ(own.position[0], mesh.position[ids[0]]);
			});
		EXPECT_EQ(count, 42);
		EXPECT_EQ(turn[41], 0);
		EXPECT_EQ(std::count(turn.begin(), turn.end(), -1), 0);
	}
}

TEST(ForEachComponent, ReportsForwardByTheVerticesThatAreDone)
{
	std::vector<int> percents;
	const SurfaceMesh mesh = shapes::joined({shapes::tetrahedron(), shapes::octahedron()}).mesh();
	visited(mesh, Progress([&](int percent, const char*) {
		EXPECT_TRUE(percents.empty() || percents.back() <= percent);
		percents.push_back(percent);
		return true;
	}),
		[](int, const SurfaceMesh&, const std::vector<int>&, const Progress& part) {
			part.report(0, "visiting");
			part.report(1, "visiting"); // of the larger one, 6 of 10 vertices
		});
	EXPECT_EQ(percents.back(), 100);
	EXPECT_NE(std::find(percents.begin(), percents.end(), 60), percents.end());
}
