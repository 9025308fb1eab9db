// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"
#include "threads.h"

#include <skeleton/spatial/inner_segments.h>
#include <skeleton/poles/poles.h>
#include <skeleton/spatial/solid_test.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace vcg::tri::mcf;
using vcg::Point3d;

using Inside = std::function<bool(const Point3d&)>;

/// What any pole promises: the centre of a ball through its vertex, inside, that holds no other vertex
/// deeper than delta and a small part of its radius.
void expectEmptyInnerBalls(
	const SurfaceMesh& mesh, const PoleSet& poles, double delta, const Inside& inside)
{
	const double rounding = 1e-6 * mesh.bounds().Diag();
	const PointTree tree(mesh.position);
	ASSERT_EQ(poles.radius.size(), mesh.position.size());
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		if (!poles.has(v))
			continue;
		const Point3d& c = poles.centre[v];
		ASSERT_TRUE(inside(c)) << v;
		ASSERT_NEAR(Distance(c, mesh.position[v]), poles.radius[v], rounding) << v;
		const double clearance = Distance(c, mesh.position[tree.nearest(c)]);
		ASSERT_GE(clearance, 0.997 * poles.radius[v] - delta - rounding) << v;
	}
}

/// Ellipsoid with bumps that has no symmetry, so that no two Voronoi vertices tie.
shapes::Soup pebble(int levels = 4)
{
	return shapes::transformed(shapes::sphere(levels), [](const Point3d& p) {
		const double r =
			1 + 0.1 * std::sin(3 * p[0] + 0.4) * std::cos(2 * p[1] - 0.3) + 0.07 * p[2];
		return Point3d(1.7 * r * p[0], 1.1 * r * p[1], 0.8 * r * p[2]);
	});
}

shapes::Soup finer(shapes::Soup shape, int times)
{
	for (int i = 0; i < times; ++i)
		shape = shapes::subdivided(shape);
	return shape;
}

/// Three unit cubes around another one at the origin, with three reflex edges that meet in (1, 1, 1).
bool isInCorner(int i, int j, int k)
{
	return i >= 0 && j >= 0 && k >= 0 && i < 2 && j < 2 && k < 2 && i + j + k <= 1;
}

bool isInBox(const Point3d& c, const Point3d& size)
{
	return c[0] > 0 && c[1] > 0 && c[2] > 0 && c[0] < size[0] && c[1] < size[1] && c[2] < size[2];
}

class Poles : public testing::TestWithParam<PoleMethod>
{
protected:
	PoleSet polesOf(const SurfaceMesh& mesh) const { return medialPoles(mesh, GetParam()); }
	/// @pre the mesh is one component that stands straight.
	void expectEmptyInnerBalls(
		const SurfaceMesh& mesh, const PoleSet& poles, const Inside& inside) const
	{
		const bool tolerant = GetParam() == PoleMethod::Balls;
		::expectEmptyInnerBalls(
			mesh, poles, tolerant ? poleTolerance * mesh.bounds().Diag() : 0, inside);
	}
};

INSTANTIATE_TEST_SUITE_P(Methods, Poles, testing::Values(PoleMethod::Voronoi, PoleMethod::Balls),
	[](const auto& info) { return info.param == PoleMethod::Voronoi ? "Voronoi" : "Balls"; });

TEST_P(Poles, OfATorusLieOnItsCircle)
{
	const double ring = 1, tube = 0.3;
	const SurfaceMesh mesh = shapes::torus(ring, tube, 90, 36).mesh();
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	const auto fromCircle = [&](const Point3d& c) {
		return std::hypot(std::hypot(c[0], c[1]) - ring, c[2]);
	};
	expectEmptyInnerBalls(mesh, poles, [&](const Point3d& c) { return fromCircle(c) < tube; });
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		EXPECT_LT(fromCircle(poles.centre[v]), 0.03 * tube) << v;
}

TEST_P(Poles, OfASphereAreItsCentre)
{
	const SurfaceMesh mesh = shapes::sphere(4, 2).mesh();
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		EXPECT_LT(poles.centre[v].Norm(), 0.01) << v;
		EXPECT_NEAR(poles.radius[v], 2, 0.01) << v;
	}
}

TEST_P(Poles, OfABoxLieWhereTwoWallsAreEquallyNear)
{
	// A regular grid: each vertex has many co-circular neighbours, and most lie in flat faces.
	const Point3d size(3, 2, 1);
	const SurfaceMesh mesh = finer(shapes::box(size[0], size[1], size[2]), 4).mesh();
	const double longestEdge = std::hypot(size[0], size[1]) / 16;
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	expectEmptyInnerBalls(mesh, poles, [&](const Point3d& c) { return isInBox(c, size); });
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& c = poles.centre[v];
		std::vector<double> walls;
		for (int k = 0; k < 3; ++k)
			walls.insert(walls.end(), {c[k], size[k] - c[k]});
		std::sort(walls.begin(), walls.end());
		EXPECT_LT(walls[1] - walls[0], longestEdge) << v;
		EXPECT_LT(poles.radius[v], 0.5 + longestEdge) << v;
	}
	// Over the middle of the largest faces only the opposite wall holds the ball.
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& p = mesh.position[v];
		if (p[0] > 0.7 && p[0] < 2.3 && p[1] > 0.7 && p[1] < 1.3) {
			EXPECT_NEAR(poles.centre[v][2], 0.5, 0.02) << v;
		}
	}
}

TEST_P(Poles, OfAThinPlateLieOnItsMiddleSheet)
{
	const SurfaceMesh mesh = finer(shapes::box(1, 1, 0.02), 6).mesh();
	const PoleSet poles = polesOf(mesh);
	expectEmptyInnerBalls(mesh, poles, [](const Point3d& c) { return isInBox(c, {1, 1, 0.02}); });
	int inTheMiddle = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& p = mesh.position[v];
		if (p[0] > 0.1 && p[0] < 0.9 && p[1] > 0.1 && p[1] < 0.9) {
			ASSERT_TRUE(poles.has(v));
			EXPECT_NEAR(poles.centre[v][2], 0.01, 0.002) << v;
			++inTheMiddle;
		}
	}
	EXPECT_GT(inTheMiddle, 1000);
}

TEST_P(Poles, StayInsideAtConcaveEdges)
{
	const SurfaceMesh mesh = finer(shapes::cells(2, 2, 2, isInCorner), 3).mesh();
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	expectEmptyInnerBalls(mesh, poles, [&](const Point3d& c) {
		return isInCorner(int(std::floor(c[0])), int(std::floor(c[1])), int(std::floor(c[2])));
	});
}

TEST_P(Poles, OfACapsuleLieOnItsSegment)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.5, 48).mesh();
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& c = poles.centre[v];
		const Point3d onSegment(std::clamp(c[0], -1.5, 1.5), 0, 0);
		EXPECT_LT(Distance(c, onSegment), 0.02) << v;
	}
}

TEST(ShrinkingBalls, AreNotHeldByTheFacetsOfATube)
{
	const double radius = 0.5;
	const SurfaceMesh mesh = finer(shapes::capsule(3, radius, 96), 1).mesh();
	const auto meanFromAxis = [&](const PoleSet& poles) {
		double sum = 0;
		int count = 0;
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			if (std::abs(mesh.position[v][0]) < 1.4) {
				sum += std::hypot(poles.centre[v][1], poles.centre[v][2]);
				++count;
			}
		return sum / count;
	};
	ASSERT_GT(meanFromAxis(shrinkingBallPoles(mesh)), 0.2 * radius)
		<< "exact balls of vertices within facets end at the neighbouring facets";
	EXPECT_LT(meanFromAxis(medialPoles(mesh, PoleMethod::Balls)), 0.03 * radius);
}

TEST(ShrinkingBalls, DoNotPierceWallsThinnerThanTheirTolerance)
{
	const Point3d size(1, 1, 0.5 * poleTolerance);
	const SurfaceMesh mesh = finer(shapes::box(size[0], size[1], size[2]), 5).mesh();
	const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d& p = mesh.position[v];
		if (p[0] > 0 && p[0] < 1 && p[1] > 0 && p[1] < 1) {
			ASSERT_TRUE(poles.has(v)) << v;
			EXPECT_NEAR(poles.centre[v][2] / size[2], 0.5, 0.01) << v;
		}
	}
}

TEST_P(Poles, OfTheCoarsestMeshesAreInsideOrMissing)
{
	const auto inTetrahedron = [](const Point3d& c) {
		return c[0] + c[1] + c[2] > -1 && c[0] - c[1] - c[2] > -1 && -c[0] + c[1] - c[2] > -1
			&& -c[0] - c[1] + c[2] > -1;
	};
	const SurfaceMesh tetrahedron = shapes::tetrahedron().mesh();
	expectEmptyInnerBalls(tetrahedron, polesOf(tetrahedron), inTetrahedron);
	const SurfaceMesh box = shapes::box(4, 2, 0.1).mesh();
	expectEmptyInnerBalls(box, polesOf(box), [](const Point3d& c) {
		return isInBox(c, {4, 2, 0.1});
	});
}

TEST_P(Poles, DoNotDependOnSizeOrPlace)
{
	const shapes::Soup shape = pebble();
	const PoleSet reference = polesOf(shape.mesh());
	EXPECT_EQ(reference.missing(), 0);
	for (const double factor : {1e-6, 0.3, 1e6}) {
		const Point3d by = Point3d(-3, 1, 2) * (100 * factor);
		const PoleSet poles = polesOf(shapes::moved(shapes::scaled(shape, factor), by).mesh());
		for (size_t v = 0; v < reference.radius.size(); ++v) {
			EXPECT_NEAR(poles.radius[v] / factor, reference.radius[v], 1e-6) << factor << ' ' << v;
			EXPECT_LT(Distance((poles.centre[v] - by) / factor, reference.centre[v]), 1e-5)
				<< factor << ' ' << v;
		}
	}
}

TEST_P(Poles, AreTheSameBitsEachTime)
{
	const SurfaceMesh mesh = pebble().mesh();
	const PoleSet once = polesOf(mesh), again = polesOf(mesh);
	EXPECT_EQ(once.radius, again.radius);
	EXPECT_EQ(once.centre, again.centre);
}

TEST_P(Poles, FollowTheirVerticesWhenRenumbered)
{
	const shapes::Soup shape = pebble(3);
	const shapes::Soup other = shapes::shuffled(shape, 5);
	const PoleSet poles = polesOf(shape.mesh()), others = polesOf(other.mesh());
	const PointTree places(other.points);
	for (size_t v = 0; v < shape.points.size(); ++v) {
		const int same = places.nearest(shape.points[v]);
		EXPECT_LT(Distance(poles.centre[v], others.centre[same]), 0.01 * poles.radius[v]) << v;
	}
}

TEST_P(Poles, TreatComponentsAlike)
{
	const shapes::Soup small = shapes::moved(shapes::sphere(3, 0.1), {3, 0, 0});
	const SurfaceMesh mesh = shapes::joined({shapes::sphere(3), small}).mesh();
	const PoleSet poles = polesOf(mesh);
	EXPECT_EQ(poles.missing(), 0);
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const bool isSmall = mesh.position[v][0] > 2;
		const Point3d centre = isSmall ? Point3d(3, 0, 0) : Point3d(0, 0, 0);
		EXPECT_LT(Distance(poles.centre[v], centre), isSmall ? 0.003 : 0.03) << v;
	}
}

TEST_P(Poles, OfAComponentAreThoseThatItHasAlone)
{
	// A body within another one, and a ring through both of their walls.
	const std::vector<shapes::Soup> bodies = {shapes::jittered(shapes::sphere(4), 1e-3),
		shapes::sphere(3, 0.6), shapes::torus(0.8, 0.1, 60, 12)};
	const PoleSet together = polesOf(shapes::joined({bodies[0], bodies[1], bodies[2]}).mesh());
	auto radius = together.radius.begin();
	auto centre = together.centre.begin();
	for (const shapes::Soup& body : bodies) {
		const PoleSet alone = polesOf(body.mesh());
		EXPECT_TRUE(std::equal(alone.radius.begin(), alone.radius.end(), radius));
		EXPECT_TRUE(std::equal(alone.centre.begin(), alone.centre.end(), centre));
		radius += long(body.points.size());
		centre += long(body.points.size());
	}
}

TEST_P(Poles, OfManyBodiesAreTheSameBitsOnAnyThreads)
{
	shapes::Soup soup = pebble(3);
	for (int i = 1; i < 30; ++i)
		soup = shapes::joined({soup, shapes::moved(pebble(3), {3. * i, 0, 0})});
	const SurfaceMesh mesh = soup.mesh();
	ASSERT_GT(mesh.vertexSlots(), 1 << 12); // as many as several threads share
	std::vector<PoleSet> poles;
	for (int threads : {1, 2, 5}) {
		const ThreadCount used(threads);
		poles.push_back(polesOf(mesh));
		EXPECT_EQ(poles.back().radius, poles.front().radius);
		EXPECT_EQ(poles.back().centre, poles.front().centre);
	}
	EXPECT_EQ(poles.front().missing(), 0);
}

TEST_P(Poles, StopWhenAskedTo)
{
	const shapes::Soup body = shapes::sphere(4);
	for (const SurfaceMesh& mesh :
		{body.mesh(), shapes::joined({body, shapes::scaled(body, 0.5)}).mesh()}) {
		int calls = 0, last = 0;
		medialPoles(mesh, GetParam(), Progress([&](int percent, const char*) {
			EXPECT_GE(percent, last);
			last = percent;
			++calls;
			return true;
		}));
		EXPECT_EQ(last, 100);
		for (int allowed = 0; allowed < calls; ++allowed) {
			int left = allowed;
			const Progress progress([&](int, const char*) { return left-- > 0; });
			EXPECT_THROW(medialPoles(mesh, GetParam(), progress), Cancelled);
		}
	}
}

TEST_P(Poles, AreSilent)
{
	testing::internal::CaptureStdout();
	testing::internal::CaptureStderr();
	polesOf(shapes::sphere(2).mesh());
	EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
	EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// A pyramid upside down: the ball at its tip touches the four far corners and reaches out between.
shapes::Soup pyramid()
{
	return {{{0, 0, 0}, {2, 2, 1}, {-2, 2, 1}, {-2, -2, 1}, {2, -2, 1}},
		{{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}}};
}

TEST_P(Poles, OfBallsThatReachOutAreRefused)
{
	const SurfaceMesh mesh = pyramid().mesh();
	ASSERT_GT(mesh.volume(), 0);
	const PoleSet unchecked = shrinkingBalls(mesh.position, mesh.vertexNormals(), mesh.position);
	ASSERT_NEAR(unchecked.centre[0][2], 4.5, 1e-6);
	const PoleSet poles = polesOf(mesh);
	EXPECT_FALSE(poles.has(0));
	expectEmptyInnerBalls(mesh, poles, [](const Point3d& c) {
		return c[2] < 1 && c[2] > std::max(std::abs(c[0]), std::abs(c[1])) / 2;
	});
}

TEST(InnerSegments, EndAtTheFirstTriangleThatTheyMeet)
{
	const SurfaceMesh mesh = pyramid().mesh();
	const PointTree tree(mesh.position);
	const InnerSegments segments(mesh, tree);
	EXPECT_TRUE(segments.staysInside(0, {0, 0, 0.9}, 0));
	EXPECT_FALSE(segments.staysInside(0, {0, 0, 1.1}, 0));   // through the edge of two triangles
	EXPECT_FALSE(segments.staysInside(0, {0.1, 0, 1.1}, 0)); // through one
	EXPECT_FALSE(segments.staysInside(0, {0, 0, -0.5}, 0));
	EXPECT_FALSE(segments.staysInside(0, {1, 0, 0.4}, 0));
}

TEST(InnerSegments, StartInsideAtSaddlesToo)
{
	// At the inner corner of a notch some triangles have the inside in front of them.
	const SurfaceMesh mesh = finer(shapes::cells(2, 2, 2, isInCorner), 1).mesh();
	const PointTree tree(mesh.position);
	const InnerSegments segments(mesh, tree);
	const int corner = tree.nearest({1, 1, 1}); // of the three reflex edges
	const Point3d p = mesh.position[corner];
	for (const Point3d& to :
		{Point3d(-0.2, -0.2, -0.2), Point3d(-0.2, 0.1, -0.01), Point3d(0.01, -0.2, -0.2)})
		EXPECT_TRUE(segments.staysInside(corner, p + to, 1))
			<< to[0] << ' ' << to[1] << ' ' << to[2];
	for (const Point3d& to :
		{Point3d(0.2, 0.2, 0.2), Point3d(0.2, 0.1, -0.01), Point3d(0.2, -0.01, 0.2)})
		EXPECT_FALSE(segments.staysInside(corner, p + to, 1))
			<< to[0] << ' ' << to[1] << ' ' << to[2];
}

TEST(ShrinkingBalls, OfSomeVerticesAreThoseOfAllVertices)
{
	const SurfaceMesh mesh = pebble().mesh();
	const PoleSet all = shrinkingBallPoles(mesh);
	std::vector<int> some;
	for (int v = 3; v < mesh.vertexSlots(); v += 7)
		some.push_back(v);
	const PoleSet poles = shrinkingBallPoles(mesh, some);
	ASSERT_EQ(poles.radius.size(), some.size());
	const PointTree tree(mesh.position);
	size_t same = 0;
	for (size_t i = 0; i < some.size(); ++i) {
		const Point3d& c = poles.centre[i];
		ASSERT_GE(Distance(c, mesh.position[tree.nearest(c)]), 0.996 * poles.radius[i]) << i;
		// A ball that a near neighbour barely touches may be held by another one instead.
		same += Distance(c, all.centre[some[i]]) < 0.01 * poles.radius[i];
	}
	EXPECT_GE(double(same), 0.98 * double(some.size()));
}

TEST(ShrinkingBalls, TolerateNoiseUpToDelta)
{
	const double noise = 0.01;
	std::mt19937 random(11);
	std::uniform_real_distribution<double> outwards(1 - noise, 1 + noise);
	std::vector<Point3d> samples = shapes::sphere(4).points, normals = samples;
	for (Point3d& p : samples)
		p *= outwards(random);
	const auto meanRadius = [](const PoleSet& poles) {
		double sum = 0;
		for (double r : poles.radius)
			sum += r;
		return sum / double(poles.radius.size());
	};
	EXPECT_LT(meanRadius(shrinkingBalls(samples, normals, samples)), 0.7);
	const PoleSet tolerant = shrinkingBalls(samples, normals, samples, 2 * noise);
	for (size_t v = 0; v < samples.size(); ++v)
		EXPECT_NEAR(tolerant.radius[v], 1, 2 * noise) << v;
}

TEST(ShrinkingBalls, IgnoreSamplesThatCoincide)
{
	const std::vector<Point3d> once = shapes::sphere(3).points;
	std::vector<Point3d> twice = once;
	for (const Point3d& p : once)
		twice.push_back(p * (1 - 1e-12));
	const PoleSet poles = shrinkingBalls(once, once, twice);
	for (double r : poles.radius)
		EXPECT_NEAR(r, 1, 0.02);
}

TEST(ShrinkingBalls, NeedANormalAndSomethingToTouch)
{
	const std::vector<Point3d> samples = {{0, 0, 1}, {0, 0, -1}};
	const PoleSet poles = shrinkingBalls(
		{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 0}, {0, 0, -1}}, samples);
	EXPECT_NEAR(poles.radius[0], 1, 1e-6);
	EXPECT_LT(poles.centre[0].Norm(), 1e-6);
	EXPECT_FALSE(poles.has(1));
	EXPECT_FALSE(poles.has(2));
	EXPECT_EQ(shrinkingBalls({{0, 0, 1}}, {{0, 0, 1}}, {}).missing(), 1);
}

TEST(VoronoiPoles, TellWhatQhullSaysWhenItFails)
{
	testing::internal::CaptureStderr();
	try {
		// There is no point 999.
		detail::delaunayTetrahedra(shapes::box().points, Progress(), "qhull d QJ QV999");
		ADD_FAILURE() << "no exception";
	}
	catch (const SolverError& error) {
		EXPECT_NE(std::string(error.what()).find("QH6150"), std::string::npos) << error.what();
	}
	EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Poles, AtTrianglesWithoutAreaAreInside)
{
	// Edges of a body are cut near their ends, again and again: some triangles have no normal to speak of.
	int slivers = 0, found = 0;
	for (unsigned seed = 0; seed < 60; ++seed) {
		std::mt19937 random(seed);
		std::uniform_real_distribution<double> unit(0, 1);
		shapes::Soup soup =
			shapes::transformed(shapes::sphere(int(seed % 2)), [](const Point3d& p) {
				return Point3d(1.4 * p[0] + 0.2 * p[1], 1.1 * p[1], 0.9 * p[2] - 0.3 * p[0]);
			});
		for (int cut = 0; cut < 25; ++cut) {
			const Triangle chosen = soup.triangles[random() % soup.triangles.size()];
			const int a = chosen[0], b = chosen[1], middle = int(soup.points.size());
			soup.points.push_back(soup.points[a]
				+ (soup.points[b] - soup.points[a]) * std::pow(10, -9 * unit(random) - 0.3));
			std::vector<Triangle> halves;
			for (const Triangle& t : soup.triangles)
				if (std::count(t.begin(), t.end(), a) && std::count(t.begin(), t.end(), b))
					for (int end : {a, b}) {
						Triangle half = t;
						std::replace(half.begin(), half.end(), end, middle);
						halves.push_back(half);
					}
				else
					halves.push_back(t);
			soup.triangles = halves;
		}
		const SurfaceMesh mesh = soup.mesh();
		const double size = mesh.bounds().Diag();
		for (int f = 0; f < mesh.faceSlots(); ++f)
			slivers += mesh.doubleAreaVector(f).Norm() < 1e-7 * size * size;
		const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
		const SolidTest solid(mesh.position, mesh.triangles());
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			if (poles.has(v)) {
				++found;
				const Point3d& centre = poles.centre[v];
				EXPECT_TRUE(checks::windingNumber(mesh, centre) > 0.5
					|| solid.closest(solid.in(centre)).distance < 1e-6)
					<< "more than rounding: " << seed << " " << v;
			}
	}
	EXPECT_GT(slivers, 100);
	EXPECT_GT(found, 500);
}

} // namespace
