// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/input/check_input.h>
#include <skeleton/resample/resample.h>
#include <skeleton/resample/target_length.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using checks::structureError;
using vcg::Box3d;
using vcg::Point3d;

namespace {

SurfaceMesh checked(const shapes::Soup& soup)
{
	return checkedSurface(soup.points, soup.triangles).mesh;
}

/// Resamples a shape of one component.
SurfaceMesh resampled(const shapes::Soup& soup, double length, int iterations = 5)
{
	return resample(checked(soup), {length}, iterations);
}

/// Distance from p to the surface, by trying all triangles; and the normal of the closest one.
double distanceTo(const SurfaceMesh& surface, const Point3d& p, Point3d* normal = nullptr)
{
	double minimum = std::numeric_limits<double>::max();
	for (int f = 0; f < surface.faceSlots(); ++f) {
		const Triangle t = surface.triangle(f);
		const double squared = detail::closestOnTriangle(
			surface.position[t[0]], surface.position[t[1]], surface.position[t[2]], p)
								   .squaredDistance;
		if (squared < minimum) {
			minimum = squared;
			if (normal)
				*normal = surface.doubleAreaVector(f);
		}
	}
	return std::sqrt(minimum);
}

struct Quality
{
	double meanMinAngle = 0; ///< degrees
	double minAngle = 180;   ///< degrees
	double obtuse = 0;       ///< part of the triangles
	double usualValence = 0; ///< part of the vertices with 5, 6 or 7 neighbours
	double usualLength = 0;  ///< part of the edges between 4/5 and 4/3 of the target
};

Quality quality(const SurfaceMesh& mesh, double length)
{
	Quality q;
	for (int f = 0; f < mesh.faceSlots(); ++f) {
		double minimum = 180, widest = 0;
		for (int h = 3 * f; h < 3 * f + 3; ++h) {
			const Point3d& a = mesh.position[mesh.origin(h)];
			const Point3d u = mesh.position[mesh.target(h)] - a,
						  v = mesh.position[mesh.apex(h)] - a;
			const double angle = std::atan2((u ^ v).Norm(), u * v) * 180 / M_PI;
			minimum = std::min(minimum, angle);
			widest = std::max(widest, angle);
		}
		q.meanMinAngle += minimum / mesh.faceCount();
		q.minAngle = std::min(q.minAngle, minimum);
		q.obtuse += (widest > 90) / double(mesh.faceCount());
	}
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		q.usualValence += (std::abs(mesh.valence(v) - 6) <= 1) / double(mesh.vertexCount());
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
		const double relative = std::sqrt(mesh.squaredLength(h)) / length;
		q.usualLength += (relative >= 0.8 && relative <= 4.0 / 3) / double(mesh.halfEdgeSlots());
	}
	return q;
}

int componentCount(const SurfaceMesh& mesh)
{
	int count = 0;
	connectedComponents(mesh, &count);
	return count;
}

/// A flat-ended tube about the x axis.
shapes::Soup cylinder(double radius, double length, int around)
{
	return shapes::revolved({{0, 0}, {0, radius}, {length, radius}, {length, 0}}, around);
}

/// A hemispherical bowl of outer radius 1 about the x axis, with a wall of the given thickness.
shapes::Soup shellBowl(double thickness, int around = 60)
{
	std::vector<std::pair<double, double>> profile;
	const int steps = around / 4;
	for (int i = 0; i <= steps; ++i)
		profile.emplace_back(-std::cos(M_PI / 2 * i / steps), std::sin(M_PI / 2 * i / steps));
	for (int i = steps; i >= 0; --i)
		profile.emplace_back((thickness - 1) * std::cos(M_PI / 2 * i / steps),
			(1 - thickness) * std::sin(M_PI / 2 * i / steps));
	return shapes::revolved(profile, around);
}

/// The shape with its first triangles cut up so that three triangles of each have no area: a
/// vertex in the middle of each edge, not shared with the neighbour.
shapes::Soup withFlatTriangles(shapes::Soup s, int count)
{
	for (int f = 0; f < count; ++f) {
		const Triangle t = s.triangles[f];
		const int m = int(s.points.size());
		for (int k = 0; k < 3; ++k)
			s.points.push_back((s.points[t[k]] + s.points[t[(k + 1) % 3]]) / 2.0);
		s.triangles[f] = {m, m + 1, m + 2};
		for (int k = 0; k < 3; ++k) {
			s.triangles.push_back({t[k], m + k, m + (k + 2) % 3});
			s.triangles.push_back({t[k], t[(k + 1) % 3], m + k});
		}
	}
	return s;
}

} // namespace

TEST(Resample, KeepsTheTopologyOfEveryShape)
{
	std::mt19937 random(7);
	const struct
	{
		const char* name;
		shapes::Soup soup;
		double length;
	} cases[] = {
		{"tetrahedron", shapes::tetrahedron(), 0.05},
		{"box", shapes::box(), 0.05},
		{"sphere from 18 vertices", shapes::sphere(1), 0.1},
		{"sphere from 16386 vertices", shapes::sphere(6), 0.1},
		{"capsule", shapes::capsule(), 0.1},
		{"torus from 72 vertices", shapes::torus(1, 0.3, 12, 6), 0.08},
		{"torus from 12000 vertices", shapes::torus(1, 0.3, 200, 60), 0.08},
		{"plate with three holes", shapes::plate(3, 1), 0.2},
		{"torus thinner than an edge", shapes::torus(1, 0.02, 100, 5), 0.08},
		{"sphere with four tunnels", shapes::withTunnels(shapes::sphere(2), 4, random), 0.1},
		{"sphere, edges almost as long as it", shapes::sphere(4), 1.5},
		{"torus, edges longer than its tube", shapes::torus(1, 0.2, 90, 18), 0.7},
	};
	for (const auto& [name, soup, length] : cases) {
		SCOPED_TRACE(name);
		const SurfaceMesh surface = checked(soup);
		const SurfaceMesh mesh = resample(surface, {length}, 5);
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.vertexSlots(), mesh.vertexCount()) << "not compact";
		EXPECT_EQ(mesh.faceSlots(), mesh.faceCount()) << "not compact";
		EXPECT_EQ(mesh.eulerCharacteristic(), surface.eulerCharacteristic());
		EXPECT_EQ(componentCount(mesh), 1);
		EXPECT_GT(mesh.volume(), 0);
	}
}

TEST(Resample, MakesEvenTriangles)
{
	const struct
	{
		const char* name;
		shapes::Soup soup;
		double length;
	} cases[] = {
		{"from coarse", shapes::sphere(2), 0.05},
		{"from dense", shapes::sphere(6), 0.05},
		{"from needles around a pole", shapes::capsule(2, 0.35, 96), 0.05},
		{"from an uneven torus", shapes::torus(1, 0.3, 30, 90), 0.05},
	};
	for (const auto& [name, soup, length] : cases) {
		SCOPED_TRACE(name);
		const SurfaceMesh mesh = resampled(soup, length);
		const Quality q = quality(mesh, length);
		EXPECT_GT(q.meanMinAngle, 51.5);
		EXPECT_GT(q.minAngle, 20);
		EXPECT_LT(q.obtuse, 0.005);
		EXPECT_GT(q.usualValence, 0.999);
		EXPECT_GT(q.usualLength, 0.98);
		// V = A / (L^2 sqrt(3) / 2) for edges of length L
		const double expected = mesh.area() / (length * length * std::sqrt(3.0) / 2);
		EXPECT_NEAR(mesh.vertexCount() / expected, 1, 0.15);
	}
}

TEST(Resample, VerticesLieOnTheInputAndNoFaceIsTurned)
{
	const struct
	{
		const char* name;
		shapes::Soup soup;
		double length;
	} cases[] = {
		{"coarse torus", shapes::torus(1, 0.3, 12, 6), 0.1},
		{"dense torus", shapes::torus(1, 0.3, 80, 24), 0.15},
		{"plate", shapes::plate(2, 1), 0.2},
		{"bumps", shapes::jittered(shapes::sphere(3), 0.03), 0.1},
		{"bowl", shellBowl(0.05), 0.1},
	};
	for (const auto& [name, soup, length] : cases) {
		SCOPED_TRACE(name);
		const SurfaceMesh surface = checked(soup);
		const SurfaceMesh mesh = resample(surface, {length}, 5);
		double farthest = 0;
		for (int v = 0; v < mesh.vertexSlots(); v += 3)
			farthest = std::max(farthest, distanceTo(surface, mesh.position[v]));
		const double rounding = 1e-6 * surface.bounds().Diag(); // as in single precision
		EXPECT_LT(farthest, rounding);
		int turned = 0;
		for (int f = 0; f < mesh.faceSlots(); f += 5) {
			const Triangle t = mesh.triangle(f);
			Point3d normal;
			distanceTo(surface,
				(mesh.position[t[0]] + mesh.position[t[1]] + mesh.position[t[2]]) / 3.0, &normal);
			const Point3d own = mesh.doubleAreaVector(f);
			// About zero where an edge is cut off.
			turned += normal * own <= -0.1 * normal.Norm() * own.Norm();
		}
		EXPECT_EQ(turned, 0);
		EXPECT_NEAR(mesh.volume() / surface.volume(), 1, 0.04);
	}
}

TEST(Resample, KeepsTheEdgesAndCornersOfABox)
{
	const double length = 0.07, rounding = 3e-6; // places are rounded as in single precision
	const SurfaceMesh box = shapes::box(1, 2, 3).mesh();
	const auto is = [&](double x, double side) { return std::abs(x - side) < rounding; };
	const SurfaceMesh mesh = resample(box, {length}, 5);
	for (const Point3d& corner : box.position) {
		int found = 0;
		for (const Point3d& p : mesh.position)
			found += Distance(p, corner) < rounding;
		EXPECT_EQ(found, 1);
	}
	// A vertex on two sides lies on an edge: the edges have a total length of 4 (1 + 2 + 3).
	int onEdges = 0;
	for (const Point3d& p : mesh.position)
		onEdges += (is(p[0], 0) || is(p[0], 1)) + (is(p[1], 0) || is(p[1], 2))
				+ (is(p[2], 0) || is(p[2], 3))
			>= 2;
	EXPECT_GT(onEdges, 24 / (length * 4 / 3));
	// No triangle cuts an edge off.
	EXPECT_NEAR(mesh.volume(), 6, 22 * rounding);
	EXPECT_NEAR(mesh.area(), 22, 22 * rounding);
}

TEST(Resample, KeepsTheRimOfACylinder)
{
	constexpr double rounding = 3e-6; // places are rounded as in single precision
	// From few and from very many vertices on the rim: the latter are needles, too.
	for (int around : {48, 600}) {
		const SurfaceMesh mesh = resampled(cylinder(1, 3, around), 0.05);
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_GT(quality(mesh, 0.05).minAngle, 12);
		int onRims = 0;
		for (const Point3d& p : mesh.position)
			onRims += std::min(std::abs(p[0]), std::abs(p[0] - 3)) < rounding
				&& std::hypot(p[1], p[2]) > std::cos(M_PI / around) - rounding;
		EXPECT_GT(onRims, 2 * 2 * M_PI / (0.05 * 4 / 3));
		EXPECT_NEAR(mesh.volume() / (3 * M_PI), 1, 0.008);
	}
}

TEST(Resample, ThinWallsStayApart)
{
	// A search in space would find the wrong side: what moves half an edge along a sphere leaves it by as much
	// as half of the thinnest wall.
	constexpr double length = 0.06, rim = 0.2;
	for (double edges : {3.0, 7.0, 70.0}) { // as long as the wall is thick
		SCOPED_TRACE(edges);
		const double thickness = length / edges;
		const SurfaceMesh surface = checked(shellBowl(thickness, 240));
		double sphere = 1; // the largest within the outer wall's polygons
		for (int f = 0; f < surface.faceSlots(); ++f) {
			const Triangle t = surface.triangle(f);
			Point3d normal = surface.doubleAreaVector(f);
			if (std::all_of(t.begin(), t.end(),
					[&](int v) { return surface.position[v].Norm() > 1 - 1e-6; }))
				sphere = std::min(sphere, normal.Normalize() * surface.position[t[0]]);
		}
		ASSERT_GT(sphere, 1 - thickness);
		const SurfaceMesh mesh = resample(surface, {length}, 5);
		EXPECT_EQ(mesh.eulerCharacteristic(), 2);
		EXPECT_EQ(componentCount(mesh), 1);
		const auto isOuter = [&](int v) { return mesh.position[v].Norm() > sphere - 1e-6; };
		int mixed = 0, turned = 0;
		double outer = 0, inner = 0;
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			const Triangle t = mesh.triangle(f);
			const Point3d middle =
				(mesh.position[t[0]] + mesh.position[t[1]] + mesh.position[t[2]]) / 3.0;
			if (middle[0] > -rim)
				continue;
			const bool side = isOuter(t[0]);
			mixed += side != isOuter(t[1]) || side != isOuter(t[2]);
			turned += side != (mesh.doubleAreaVector(f) * middle > 0);
			(side ? outer : inner) += mesh.doubleAreaVector(f).Norm() / 2;
		}
		EXPECT_EQ(mixed, 0) << "faces from wall to wall";
		EXPECT_EQ(turned, 0);
		// Both walls are whole: the area of a zone of a sphere is 2 pi r times its height.
		const double r = 1 - thickness;
		EXPECT_NEAR(outer / (2 * M_PI * (1 - rim)), 1, 0.03);
		EXPECT_NEAR(inner / (2 * M_PI * r * (r - rim)), 1, 0.03);
	}
}

TEST(Resample, TrianglesWithoutAreaDoNoHarm)
{
	for (const shapes::Soup& soup : {shapes::box(), shapes::sphere(2), shapes::sphere(5)}) {
		const shapes::Soup flat = withFlatTriangles(soup, int(soup.triangles.size()));
		const SurfaceMesh mesh = resampled(flat, 0.05);
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.eulerCharacteristic(), 2);
		EXPECT_NEAR(mesh.volume() / soup.mesh().volume(), 1, 0.005);
		const Quality q = quality(mesh, 0.05);
		EXPECT_GT(q.meanMinAngle, 51);
		EXPECT_GT(q.minAngle, 10);
	}
}

TEST(Resample, EachComponentGetsItsOwnLengthAndKeepsItsPlace)
{
	const shapes::Soup soup = shapes::shuffled(shapes::joined({shapes::sphere(3),
		shapes::moved(shapes::torus(), {5, 0, 0}), shapes::moved(shapes::box(), {10, 0, 0}),
		shapes::moved(shapes::sphere(5), {15, 0, 0})}));
	const SurfaceMesh surface = checked(soup);
	int count = 0;
	const std::vector<int> component = connectedComponents(surface, &count);
	ASSERT_EQ(count, 4);
	const std::vector<double> lengths = {0.1, 0.15, 0.2, 0.25};
	const SurfaceMesh mesh = resample(surface, lengths, 5);
	EXPECT_EQ(structureError(mesh), "");
	EXPECT_EQ(mesh.eulerCharacteristic(), surface.eulerCharacteristic());
	const std::vector<int> newComponent = connectedComponents(mesh, &count);
	ASSERT_EQ(count, 4);
	for (int c = 0; c < count; ++c) {
		Box3d before, after;
		for (int v = 0; v < surface.vertexSlots(); ++v)
			if (component[v] == c)
				before.Add(surface.position[v]);
		double sum = 0;
		int edges = 0;
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
			if (newComponent[mesh.origin(h)] == c) {
				after.Add(mesh.position[mesh.origin(h)]);
				sum += std::sqrt(mesh.squaredLength(h));
				++edges;
			}
		EXPECT_LT(Distance(before.Center(), after.Center()), 0.1);
		EXPECT_NEAR(sum / edges / lengths[c], 1, 0.1);
	}
}

TEST(Resample, ACopyThatIsTurnedMovedScaledOrRenumberedGivesTheSameMesh)
{
	// No symmetry: of a symmetric shape the turned copy may get a mesh that is turned differently.
	const shapes::Soup soup =
		shapes::transformed(shapes::torus(1, 0.3, 24, 9), [](const Point3d& p) {
			return Point3d(
				1.5 * p[0] + 0.2 * p[1] * p[1], p[1] + 0.1 * p[0], p[2] + 0.2 * p[0] * p[1]);
		});
	const double c = std::cos(0.7), s = std::sin(0.7);
	const auto turned = [&](const Point3d& p) {
		return Point3d(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]);
	};
	const struct
	{
		const char* name;
		std::function<Point3d(const Point3d&)> move;
		double scale;
	} copies[] = {
		{"turned", turned, 1},
		{"moved", [](const Point3d& p) { return p + Point3d(100, -200, 300); }, 1},
		{"small", [](const Point3d& p) { return p * 1e-6; }, 1e-6},
		{"large", [](const Point3d& p) { return p * 1e6; }, 1e6},
		{"all", [&](const Point3d& p) { return turned(p) * 37 + Point3d(1e3, 0, 0); }, 37},
	};
	const SurfaceMesh reference = resampled(soup, 0.06);
	for (const auto& [name, move, scale] : copies) {
		SCOPED_TRACE(name);
		const SurfaceMesh mesh =
			resampled(shapes::shuffled(shapes::transformed(soup, move)), 0.06 * scale);
		ASSERT_EQ(mesh.triangles(), reference.triangles());
		for (int v = 0; v < mesh.vertexSlots(); ++v)
			ASSERT_LT(Distance(mesh.position[v], move(reference.position[v])), 1e-9 * scale);
	}
}

TEST(Resample, ScaleAndPlaceDoNotMatter)
{
	const shapes::Soup soup = shapes::torus(1, 0.3, 24, 9);
	const SurfaceMesh reference = resampled(soup, 0.06);
	// A power of two changes no digit.
	const SurfaceMesh twice = resampled(shapes::scaled(soup, 1024), 0.06 * 1024);
	EXPECT_EQ(twice.triangles(), reference.triangles());
	for (int v = 0; v < reference.vertexSlots(); ++v)
		ASSERT_EQ(twice.position[v], reference.position[v] * 1024);
	const double diagonal = reference.bounds().Diag();
	const auto alike = [&](const SurfaceMesh& mesh, double scale) {
		EXPECT_EQ(structureError(mesh), "");
		EXPECT_EQ(mesh.eulerCharacteristic(), 0);
		EXPECT_NEAR(mesh.vertexCount() / double(reference.vertexCount()), 1, 0.02);
		EXPECT_NEAR(mesh.volume() / std::pow(scale, 3) / reference.volume(), 1, 1e-3);
		EXPECT_GT(quality(mesh, 0.06 * scale).minAngle, 15);
	};
	for (double scale : {1e-6, 1e6})
		alike(resampled(shapes::scaled(soup, scale), 0.06 * scale), scale);
	alike(resampled(shapes::moved(soup, Point3d(1, -2, 3) * (1e4 * diagonal)), 0.06), 1);
}

TEST(Resample, GivesTheSameBitsTwice)
{
	for (const shapes::Soup& soup : {shapes::plate(2, 3), shapes::sphere(5)}) {
		const SurfaceMesh first = resampled(soup, 0.07), second = resampled(soup, 0.07);
		EXPECT_EQ(first.position, second.position);
		EXPECT_EQ(first.triangles(), second.triangles());
	}
}

TEST(Resample, AgainChangesLittle)
{
	const SurfaceMesh once = resampled(shapes::torus(), 0.05);
	const SurfaceMesh twice = resample(once, {0.05}, 5);
	EXPECT_NEAR(twice.vertexCount() / double(once.vertexCount()), 1, 0.05);
	EXPECT_GE(quality(twice, 0.05).meanMinAngle, quality(once, 0.05).meanMinAngle);
}

TEST(Resample, NoRoundGivesTheInputWithoutHoles)
{
	SurfaceMesh surface = shapes::sphere(3).mesh();
	for (int h = 0; h < 300; ++h)
		if (surface.isHalfEdge(h) && surface.isCollapsible(h))
			surface.collapse(h);
	const SurfaceMesh mesh = resample(surface, {0.1}, 0);
	surface.compact();
	EXPECT_EQ(mesh.position, surface.position);
	EXPECT_EQ(mesh.triangles(), surface.triangles());
}

TEST(Resample, RefusesLengthsThatMakeNoSense)
{
	const SurfaceMesh surface = shapes::box().mesh();
	EXPECT_THROW(resample(surface, {}, 5), InvalidParameter);
	EXPECT_THROW(resample(surface, {0.1, 0.1}, 5), InvalidParameter);
	EXPECT_THROW(resample(surface, {0.0}, 5), InvalidParameter);
	EXPECT_THROW(resample(surface, {-0.1}, 5), InvalidParameter);
	EXPECT_THROW(resample(surface, {std::nan("")}, 5), InvalidParameter);
	EXPECT_THROW(resample(surface, {HUGE_VAL}, 5), InvalidParameter);
	for (const auto& [length, vertices] : {std::pair {1e-5, "need 69282 million vertices."},
			 {1e-13, "need more than 1e15 million vertices."},
			 {1e-200, "need more than 1e15 million vertices."}})
		try {
			resample(surface, {length}, 5);
			FAIL() << length;
		}
		catch (const InvalidParameter& error) {
			const std::string text = error.what();
			EXPECT_NE(text.find("target_length"), std::string::npos);
			EXPECT_NE(text.find(vertices), std::string::npos) << text;
		}
}

TEST(Resample, NarrowBodiesGetNoMoreVerticesThanTheyNeed)
{
	for (double width : {1e-3, 1e-4, 1e-5, 1e-6, 3e-9}) {
		SCOPED_TRACE(width);
		const SurfaceMesh needle = shapes::transformed(shapes::sphere(1), [&](const Point3d& p) {
			return Point3d(p[0], width * p[1], width * p[2]);
		}).mesh();
		const SurfaceMesh mesh = resample(needle, defaultTargetLength(needle), 5);
		EXPECT_EQ(mesh.eulerCharacteristic(), 2);
		EXPECT_LT(mesh.vertexCount(), 200000);
	}
}

TEST(Resample, GivesUpWhereTheVerticesWouldBeTooMany)
{
	const SurfaceMesh ball = shapes::sphere(1).mesh();
	const auto refined = [&](size_t maxVertices) {
		vcg::tri::mcf::detail::IsotropicRemesher remesher(
			ball, std::vector<int>(size_t(ball.vertexSlots()), 0), {0.01}, maxVertices, Progress());
		remesher.refine(Progress());
		return remesher.take(Progress()).vertexCount();
	};
	EXPECT_THROW(refined(1000), InvalidParameter);
	EXPECT_GT(refined(1000000), 10000);
}

TEST(Resample, ProgressNeverFallsAndReportsWithinLongLoops)
{
	const SurfaceMesh surface = shapes::sphere(7).mesh(); // 65538 vertices
	int last = 0, reports = 0;
	resample(surface, {0.02}, 3, Progress([&](int percent, const char*) {
		EXPECT_GE(percent, last);
		EXPECT_LE(percent, 100);
		last = percent;
		++reports;
		return true;
	}));
	EXPECT_GT(last, 90);
	// Three rounds of four passes over 90000 edges or so, each at least every 50000.
	EXPECT_GT(reports, 3 * 4 * 2);
}

TEST(Resample, CanBeCancelledAnywhere)
{
	const SurfaceMesh surface = shapes::sphere(5).mesh();
	int total = 0;
	resample(surface, {0.05}, 3, Progress([&](int, const char*) { return ++total > 0; }));
	for (int stop = 0; stop < total; ++stop) {
		int reports = 0;
		EXPECT_THROW(resample(surface, {0.05}, 3,
						 Progress([&](int, const char*) { return reports++ < stop; })),
			Cancelled);
		EXPECT_EQ(reports, stop + 1);
	}
}
