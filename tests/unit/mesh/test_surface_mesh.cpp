// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace vcg::tri::mcf;
using checks::structureError;
using vcg::Point3d;

namespace {

/// A half-edge path around the tube of a torus made by shapes::torus(.., across = 3).
std::array<int, 3> tubeLoop(const SurfaceMesh& mesh)
{
	return {mesh.findHalfEdge(0, 1), mesh.findHalfEdge(1, 2), mesh.findHalfEdge(2, 0)};
}

/// Whether contracting h would identify two edges or faces that are not identified by the
/// contraction itself: the link condition, spelled out on vertex sets.
bool linkConditionHolds(const SurfaceMesh& mesh, int h)
{
	std::set<int> ofOrigin, ofTarget;
	mesh.forEachOutgoing(mesh.origin(h), [&](int e) { ofOrigin.insert(mesh.target(e)); });
	mesh.forEachOutgoing(mesh.target(h), [&](int e) { ofTarget.insert(mesh.target(e)); });
	std::set<int> common;
	std::set_intersection(ofOrigin.begin(), ofOrigin.end(), ofTarget.begin(), ofTarget.end(),
		std::inserter(common, common.end()));
	const std::set<int> apexes = {mesh.apex(h), mesh.apex(mesh.twin(h))};
	return common == apexes && !(ofOrigin.size() == 3 && ofTarget.size() == 3);
}

} // namespace

TEST(SurfaceMesh, ShapesHaveTheTopologyTheyShould)
{
	const struct
	{
		shapes::Soup soup;
		int euler;
	} cases[] = {{shapes::tetrahedron(), 2}, {shapes::octahedron(), 2}, {shapes::box(), 2},
		{shapes::sphere(2), 2}, {shapes::capsule(), 2}, {shapes::torus(), 0},
		{shapes::csaszarTorus(), 0}, {shapes::plate(1), 0}, {shapes::plate(2), -2},
		{shapes::plate(3), -4}, {shapes::joined({shapes::sphere(1), shapes::torus()}), 2}};
	for (const auto& [soup, euler] : cases) {
		const SurfaceMesh mesh = soup.mesh();
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.eulerCharacteristic(), euler);
		EXPECT_EQ(mesh.vertexCount(), int(soup.points.size()));
		EXPECT_EQ(mesh.faceCount(), int(soup.triangles.size()));
		EXPECT_EQ(mesh.triangles(), soup.triangles);
	}
}

TEST(SurfaceMesh, RefusesWhatIsNotClosedOrNotOriented)
{
	EXPECT_THROW(shapes::opened(shapes::box()).mesh(), InvalidInput);
	shapes::Soup turned = shapes::box();
	std::swap(turned.triangles[3][0], turned.triangles[3][1]);
	EXPECT_THROW(turned.mesh(), InvalidInput);
	EXPECT_EQ(shapes::Soup().mesh().vertexCount(), 0);
}

TEST(SurfaceMesh, MeasuresAreThoseOfTheSolid)
{
	const SurfaceMesh box = shapes::box(1, 2, 3).mesh();
	EXPECT_DOUBLE_EQ(box.volume(), 6);
	EXPECT_DOUBLE_EQ(box.area(), 22);
	EXPECT_DOUBLE_EQ(box.bounds().Diag(), std::sqrt(14.0));
	EXPECT_DOUBLE_EQ(shapes::insideOut(shapes::box()).mesh().volume(), -1);
	// Pappus: 2 pi^2 R r^2 and 4 pi^2 R r, met from below by an inscribed mesh.
	const SurfaceMesh torus = shapes::torus(1, 0.3, 240, 80).mesh();
	EXPECT_NEAR(torus.volume(), 2 * M_PI * M_PI * 0.09, 5e-3);
	EXPECT_NEAR(torus.area(), 4 * M_PI * M_PI * 0.3, 2e-2);
}

TEST(SurfaceMesh, VolumeKeepsItsDigitsFarFromTheOrigin)
{
	const double volume = shapes::torus().mesh().volume();
	const double far = shapes::moved(shapes::torus(), {1e6, -1e6, 1e6}).mesh().volume();
	EXPECT_NEAR(far, volume, 1e-7 * volume);
}

TEST(SurfaceMesh, NormalsPointOutwardsAndAreUnit)
{
	const SurfaceMesh mesh = shapes::sphere(3).mesh();
	const std::vector<Point3d> normals = mesh.vertexNormals();
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		EXPECT_NEAR(normals[v].Norm(), 1, 1e-12);
		EXPECT_GT(
			normals[v] * mesh.position[v], 0.995); // the outward normal of the unit sphere is p
	}
}

TEST(SurfaceMesh, RingsVisitEachNeighbourOnceClockwise)
{
	const SurfaceMesh mesh = shapes::octahedron().mesh();
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		std::vector<int> ring;
		mesh.forEachOutgoing(v, [&](int h) {
			EXPECT_EQ(mesh.origin(h), v);
			ring.push_back(mesh.target(h));
		});
		ASSERT_EQ(ring.size(), 4u);
		EXPECT_EQ(mesh.valence(v), 4);
		EXPECT_EQ(std::set<int>(ring.begin(), ring.end()).size(), 4u);
		for (int i = 0; i < 4; ++i) {
			// Seen from outside, from one neighbour to the next is a turn against the normal.
			const Point3d turn = mesh.position[ring[i]] ^ mesh.position[ring[(i + 1) % 4]];
			EXPECT_LT(turn * mesh.position[v], 0);
			EXPECT_GE(mesh.findHalfEdge(v, ring[i]), 0);
		}
	}
	EXPECT_EQ(mesh.findHalfEdge(0, 1), -1); // opposite corners
}

TEST(SurfaceMesh, EdgesAreCountedOnce)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 8, 6).mesh();
	int edges = 0;
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		edges += mesh.isEdge(h);
	EXPECT_EQ(edges, mesh.edgeCount());
	EXPECT_EQ(edges, 3 * mesh.faceCount() / 2);
}

TEST(SurfaceMesh, SplitPutsOneVertexOfValenceFour)
{
	SurfaceMesh mesh = shapes::box().mesh();
	const double area = mesh.area(), volume = mesh.volume();
	for (int h : {0, 7, 20}) {
		const int a = mesh.origin(h), b = mesh.target(h), vertices = mesh.vertexCount();
		const Point3d middle = (mesh.position[a] + mesh.position[b]) / 2.0;
		const int m = mesh.split(h, middle);
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.vertexCount(), vertices + 1);
		EXPECT_EQ(mesh.valence(m), 4);
		EXPECT_EQ(mesh.position[m], middle);
		EXPECT_EQ(mesh.origin(h), a);
		EXPECT_EQ(mesh.target(h), m);
		EXPECT_EQ(mesh.origin(mesh.twin(h)), m);
		EXPECT_EQ(mesh.findHalfEdge(a, b), -1);
		EXPECT_NEAR(mesh.area(), area, 1e-12); // a vertex on the edge does not change the surface
		EXPECT_NEAR(mesh.volume(), volume, 1e-12);
	}
}

TEST(SurfaceMesh, FlipTwiceIsTheSameSurface)
{
	SurfaceMesh mesh = shapes::sphere(1).mesh();
	for (int h = 0; h < mesh.halfEdgeSlots(); h += 5) {
		if (!mesh.isFlippable(h))
			continue;
		const int a = mesh.origin(h), b = mesh.target(h);
		const int c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
		const int valence = mesh.valence(a);
		mesh.flip(h);
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.origin(h), d);
		EXPECT_EQ(mesh.target(h), c);
		EXPECT_EQ(mesh.findHalfEdge(a, b), -1);
		EXPECT_EQ(mesh.valence(a), valence - 1);
		ASSERT_TRUE(mesh.isFlippable(h));
		mesh.flip(h);
		EXPECT_GE(mesh.findHalfEdge(a, b), 0);
		EXPECT_EQ(mesh.valence(a), valence);
	}
	EXPECT_EQ(mesh.eulerCharacteristic(), 2);
}

TEST(SurfaceMesh, FlipNeverMakesADoubleEdge)
{
	SurfaceMesh tetrahedron = shapes::tetrahedron().mesh();
	for (int h = 0; h < tetrahedron.halfEdgeSlots(); ++h)
		EXPECT_FALSE(tetrahedron.isFlippable(h));
	SurfaceMesh complete = shapes::csaszarTorus().mesh(); // every two vertices are joined already
	for (int h = 0; h < complete.halfEdgeSlots(); ++h)
		EXPECT_FALSE(complete.isFlippable(h));
}

TEST(SurfaceMesh, CollapseMergesTheOriginIntoTheTarget)
{
	SurfaceMesh mesh = shapes::sphere(1).mesh();
	const int h = 0, a = mesh.origin(h), b = mesh.target(h);
	std::set<int> neighbours;
	for (int v : {a, b})
		mesh.forEachOutgoing(v, [&](int e) { neighbours.insert(mesh.target(e)); });
	neighbours.erase(a);
	neighbours.erase(b);
	ASSERT_TRUE(mesh.isCollapsible(h));
	mesh.collapse(h);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_FALSE(mesh.isVertex(a));
	EXPECT_EQ(mesh.eulerCharacteristic(), 2);
	std::set<int> left;
	mesh.forEachOutgoing(b, [&](int e) { left.insert(mesh.target(e)); });
	EXPECT_EQ(left, neighbours);
}

TEST(SurfaceMesh, CollapsibleMeansLinkCondition)
{
	std::mt19937 random(3);
	for (shapes::Soup soup : {shapes::tetrahedron(), shapes::octahedron(), shapes::box(),
			 shapes::csaszarTorus(), shapes::torus(1, 0.3, 3, 3), shapes::torus(1, 0.3, 5, 3),
			 shapes::withTunnels(shapes::sphere(2), 3, random), shapes::plate(2, 1)}) {
		SurfaceMesh mesh = soup.mesh();
		for (int round = 0; round < 5; ++round) {
			for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
				if (mesh.isHalfEdge(h)) {
					EXPECT_EQ(mesh.isCollapsible(h), linkConditionHolds(mesh, h));
				}
			shapes::changeAtRandom(mesh, 50, random);
		}
	}
}

TEST(SurfaceMesh, CollapsesWhatIsCollapsibleAndShowsTheMergedRing)
{
	std::mt19937 random(4);
	SurfaceMesh mesh = shapes::withTunnels(shapes::sphere(2), 3, random).mesh();
	int collapsed = 0, blocked = 0;
	for (int i = 0; i < 2000; ++i) {
		shapes::changeAtRandom(mesh, 1, random);
		const int h = int(random() % size_t(mesh.halfEdgeSlots()));
		if (!mesh.isHalfEdge(h))
			continue;
		const bool isCollapsible = mesh.isCollapsible(h);
		const int a = mesh.origin(h), b = mesh.target(h), vertices = mesh.vertexCount();
		std::multiset<int> visited, ring;
		ASSERT_EQ(mesh.collapseIfPossible(h, [&](int e) { visited.insert(e); }), isCollapsible);
		ASSERT_EQ(mesh.vertexCount(), vertices - isCollapsible);
		ASSERT_EQ(mesh.isVertex(a), !isCollapsible);
		ASSERT_EQ(structureError(mesh), "");
		if (isCollapsible)
			mesh.forEachOutgoing(b, [&](int e) { ring.insert(e); });
		ASSERT_EQ(visited, ring);
		++(isCollapsible ? collapsed : blocked);
	}
	EXPECT_GT(collapsed, 100);
	EXPECT_GT(blocked, 20);
	EXPECT_EQ(mesh.eulerCharacteristic(), 2 - 2 * 3);
}

TEST(SurfaceMesh, PinchVertexClosesALoopWithoutATriangle)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 8, 3).mesh(); // the tube is a prism
	const std::array<int, 3> loop = tubeLoop(mesh);
	EXPECT_EQ(mesh.pinchVertex(loop[0]), 2);
	EXPECT_FALSE(mesh.isCollapsible(loop[0]));
	EXPECT_LT(mesh.pinchVertex(mesh.findHalfEdge(0, 3)), 0); // along the tube
}

TEST(SurfaceMesh, TheSmallestMeshesCannotBeCollapsed)
{
	const SurfaceMesh tetrahedron = shapes::tetrahedron().mesh();
	for (int h = 0; h < tetrahedron.halfEdgeSlots(); ++h)
		EXPECT_FALSE(tetrahedron.isCollapsible(h));
	// Two triangles back to back.
	const SurfaceMesh pillow({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}});
	for (int h = 0; h < pillow.halfEdgeSlots(); ++h) {
		EXPECT_FALSE(pillow.isCollapsible(h));
		EXPECT_FALSE(pillow.isFlippable(h));
	}
	const SurfaceMesh octahedron = shapes::octahedron().mesh();
	for (int h = 0; h < octahedron.halfEdgeSlots(); ++h)
		EXPECT_TRUE(octahedron.isCollapsible(h));
}

TEST(SurfaceMesh, CollapsingAllOfASphereEndsAtATetrahedron)
{
	SurfaceMesh mesh = shapes::sphere(2).mesh();
	for (bool any = true; any;) {
		any = false;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (mesh.isHalfEdge(h) && mesh.isCollapsible(h)) {
				mesh.collapse(h);
				any = true;
			}
	}
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.vertexCount(), 4); // any larger triangulated sphere has a collapsible edge
}

TEST(SurfaceMesh, CutRaisesTheEulerCharacteristicByTwo)
{
	SurfaceMesh mesh = shapes::torus(1, 0.3, 8, 3).mesh();
	const int vertices = mesh.vertexCount(), faces = mesh.faceCount();
	ASSERT_EQ(mesh.eulerCharacteristic(), 0);
	const std::array<int, 3> copies = mesh.cutAlong(tubeLoop(mesh));
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), 2); // a torus cut across its tube is a sphere
	EXPECT_EQ(mesh.vertexCount(), vertices + 3);
	EXPECT_EQ(mesh.faceCount(), faces + 2);
	for (int k = 0; k < 3; ++k)
		EXPECT_EQ(mesh.position[copies[k]], mesh.position[k]);
	// Both lips are closed by a triangle, and they are far apart now.
	EXPECT_GE(mesh.findHalfEdge(copies[0], copies[1]), 0);
	for (int k = 0; k < 3; ++k)
		for (int l = 0; l < 3; ++l)
			EXPECT_EQ(mesh.findHalfEdge(k, copies[l]), -1);
}

TEST(SurfaceMesh, CutOfASeparatingLoopMakesTwoComponents)
{
	// A prism of three quads with a tetrahedron on each end: the loop in the middle separates.
	SurfaceMesh mesh = shapes::capsule(2, 0.3, 3).mesh();
	int cut = 0;
	for (int h = 0; h < mesh.halfEdgeSlots() && !cut; ++h)
		if (mesh.pinchVertex(h) >= 0) {
			const int a = mesh.origin(h), b = mesh.target(h), c = mesh.pinchVertex(h);
			mesh.cutAlong({h, mesh.findHalfEdge(b, c), mesh.findHalfEdge(c, a)});
			++cut;
		}
	ASSERT_EQ(cut, 1);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), 4);
	int components = 0;
	connectedComponents(mesh, &components);
	EXPECT_EQ(components, 2);
	EXPECT_NEAR(mesh.volume(), shapes::capsule(2, 0.3, 3).mesh().volume(), 1e-12);
}

TEST(SurfaceMesh, ThousandsOfRandomChangesKeepStructureAndEulerCharacteristic)
{
	std::mt19937 random(12345);
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::sphere(2), shapes::torus(), shapes::csaszarTorus(),
			shapes::plate(3), shapes::withTunnels(shapes::sphere(2), 5, random),
			shapes::joined({shapes::torus(), shapes::sphere(1), shapes::box()})}) {
		SurfaceMesh mesh = soup.mesh();
		const int euler = mesh.eulerCharacteristic();
		for (int round = 0; round < 10; ++round) {
			shapes::changeAtRandom(mesh, 1000, random);
			ASSERT_EQ(structureError(mesh), "");
			ASSERT_EQ(mesh.eulerCharacteristic(), euler);
		}
		std::vector<Point3d> before;
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			if (mesh.isVertex(v))
				before.push_back(mesh.position[v]);
		mesh.compact();
		ASSERT_EQ(structureError(mesh), "");
		ASSERT_EQ(mesh.eulerCharacteristic(), euler);
		ASSERT_EQ(mesh.position, before);
	}
}

TEST(SurfaceMesh, RandomCutsRaiseTheEulerCharacteristicEach)
{
	std::mt19937 random(7);
	SurfaceMesh mesh = shapes::withTunnels(shapes::sphere(2), 6, random).mesh();
	int euler = mesh.eulerCharacteristic(), cuts = 0;
	ASSERT_EQ(euler, 2 - 2 * 6);
	for (int i = 0; i < 20000 && cuts < 200; ++i) {
		shapes::changeAtRandom(mesh, 3, random);
		const int h = int(random() % size_t(mesh.halfEdgeSlots()));
		if (!mesh.isHalfEdge(h))
			continue;
		const int c = mesh.pinchVertex(h);
		if (c < 0)
			continue;
		const int a = mesh.origin(h), b = mesh.target(h);
		mesh.cutAlong({h, mesh.findHalfEdge(b, c), mesh.findHalfEdge(c, a)});
		++cuts;
		euler += 2;
		ASSERT_EQ(structureError(mesh), "");
		ASSERT_EQ(mesh.eulerCharacteristic(), euler);
	}
	EXPECT_GT(cuts, 20);
}

TEST(SurfaceMesh, CompactedIsTheMeshBuiltAnew)
{
	std::mt19937 random(5);
	SurfaceMesh mesh = shapes::plate(2).mesh();
	shapes::changeAtRandom(mesh, 3000, random);
	SurfaceMesh compacted = mesh;
	const std::vector<int> renumbered = compacted.compact();
	const SurfaceMesh anew(compacted.position, compacted.triangles());
	ASSERT_EQ(renumbered.size(), size_t(mesh.vertexSlots()));
	EXPECT_EQ(compacted.vertexSlots(), compacted.vertexCount());
	EXPECT_EQ(compacted.faceSlots(), compacted.faceCount());
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_EQ(renumbered[v] >= 0, mesh.isVertex(v));
	for (int v = 0; v < anew.vertexSlots(); ++v)
		EXPECT_EQ(anew.outgoing(v), compacted.outgoing(v));
	for (int h = 0; h < anew.halfEdgeSlots(); ++h) {
		EXPECT_EQ(anew.twin(h), compacted.twin(h));
		EXPECT_EQ(anew.origin(h), compacted.origin(h));
	}
}

TEST(SurfaceMesh, TrimmedIsTheSameMeshWithoutSpareMemory)
{
	std::mt19937 random(7);
	SurfaceMesh mesh = shapes::plate(2).mesh();
	mesh.position.reserve(4 * mesh.position.size());
	shapes::changeAtRandom(mesh, 3000, random);
	mesh.compact();
	SurfaceMesh trimmed = mesh;
	trimmed.position.reserve(4 * mesh.position.size());
	trimmed.trim();
	EXPECT_EQ(trimmed.position.capacity(), trimmed.position.size());
	EXPECT_EQ(trimmed.position, mesh.position);
	EXPECT_EQ(trimmed.triangles(), mesh.triangles());
	shapes::changeAtRandom(trimmed, 300, random);
	trimmed.compact();
	const SurfaceMesh anew(trimmed.position, trimmed.triangles());
	for (int h = 0; h < anew.halfEdgeSlots(); ++h)
		EXPECT_EQ(anew.twin(h), trimmed.twin(h)) << "it goes on as before";
}

namespace {

/// Two hubs, the first vertices, and a ring of vertices between them.
shapes::Soup twoHubs(int around)
{
	shapes::Soup fan;
	fan.points = {{0, 0, -1}, {0, 0, 1}};
	for (int i = 0; i < around; ++i) {
		const double u = 2 * M_PI * i / around;
		fan.points.emplace_back(std::cos(u), std::sin(u), 0);
		const int a = 2 + i, b = 2 + (i + 1) % around;
		fan.triangles.push_back({0, b, a});
		fan.triangles.push_back({1, a, b});
	}
	return fan;
}

} // namespace

TEST(SurfaceMesh, AVertexOfVeryHighValenceIsBuiltInLinearTime)
{
	// Quadratic pairing would take minutes at this size, in whatever order the faces are.
	const int around = 200000;
	shapes::Soup fan = twoHubs(around);
	std::mt19937 random(6);
	for (bool isShuffled : {false, true}) {
		if (isShuffled)
			for (size_t i = fan.triangles.size() - 1; i > 0; --i)
				std::swap(fan.triangles[i], fan.triangles[random() % (i + 1)]);
		const SurfaceMesh mesh = fan.mesh();
		EXPECT_EQ(mesh.eulerCharacteristic(), 2);
		EXPECT_EQ(mesh.valence(0), around);
		EXPECT_EQ(mesh.valence(1), around);
	}
}

TEST(SurfaceMesh, TwinsAreFoundAtVerticesOfAnyValence)
{
	for (int around : {3, 100, 127, 128, 129, 130, 1000})
		EXPECT_EQ(structureError(twoHubs(around).mesh()), "") << around;
}

TEST(SurfaceMesh, ManyCopiesOfAFaceAreRefusedInLinearTime)
{
	// Quadratic pairing would take minutes at this size.
	const std::vector<Point3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	const std::vector<Triangle> alike(300000, Triangle {0, 1, 2});
	EXPECT_THROW(SurfaceMesh(points, alike), InvalidInput);
	EXPECT_FALSE(SurfaceMesh::isClosedManifold(points.size(), alike));
	// Each with a twin, but many at an edge.
	std::vector<Triangle> twoSided = alike;
	twoSided.insert(twoSided.end(), alike.size(), Triangle {1, 0, 2});
	EXPECT_FALSE(SurfaceMesh::isClosedManifold(points.size(), twoSided));
}

TEST(SurfaceMesh, APillowIsAComponentOfItsOwn)
{
	SurfaceMesh mesh = shapes::torus().mesh();
	const std::array<Point3d, 3> corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
	const std::array<int, 3> made = mesh.addPillow(corners);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), 2);
	for (int k = 0; k < 3; ++k) {
		EXPECT_EQ(mesh.position[made[k]], corners[k]);
		EXPECT_EQ(mesh.valence(made[k]), 2);
		EXPECT_FALSE(mesh.isCollapsible(mesh.findHalfEdge(made[k], made[(k + 1) % 3])));
	}
	int components = 0;
	connectedComponents(mesh, &components);
	EXPECT_EQ(components, 2);
}

TEST(SurfaceMesh, ACopyIsTheSameMeshAndCanBeCancelled)
{
	SurfaceMesh mesh = shapes::sphere(2).mesh();
	mesh.collapse(0);
	int reports = 0;
	SurfaceMesh copy = mesh.copied(Progress([&](int, const char*) { return ++reports > 0; }));
	EXPECT_GE(reports, 4) << "one for each of its large arrays";
	EXPECT_EQ(copy.position, mesh.position);
	EXPECT_EQ(copy.triangles(), mesh.triangles());
	EXPECT_EQ(copy.vertexCount(), mesh.vertexCount());
	EXPECT_EQ(copy.faceCount(), mesh.faceCount());
	copy.compact();
	EXPECT_EQ(structureError(copy), "");
	EXPECT_THROW(mesh.copied(Progress([](int, const char*) { return false; })), Cancelled);
}

TEST(SurfaceMesh, ASliverIsLowerThanAMillionthOfTheDiagonalHoweverShortItsEdges)
{
	for (const double scale : {1e-6, 1.0, 1e6})
		for (const double length : {1e-3, 1.0})
			for (const double height : {0.5e-6, 2e-6}) {
				const shapes::Soup thin = {
					{{0, 0, 0}, {length * scale, 0, 0}, {length * scale / 2, height * scale, 0},
						{0, 0, scale}},
					{{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}};
				const SurfaceMesh mesh = thin.mesh();
				EXPECT_EQ(mesh.isSliver(0, scale), height < 1e-6);
			}
}
