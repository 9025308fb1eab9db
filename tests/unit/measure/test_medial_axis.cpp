// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The medial axis as a mesh, on shapes whose medial axis is known.

#include "shapes.h"
#include <skeleton/measure/medial_axis.h>
#include <skeleton/poles/poles.h>
#include <skeleton/poles/shrinking_balls.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A plate of 4 by 4 by 0.5 about the origin: its medial axis is a sheet in z = 0 with slopes to the rim.
const SurfaceMesh& plate()
{
	static const SurfaceMesh mesh =
		shapes::moved(shapes::cells(
						  64, 64, 8, [](int, int, int) { return true; }, 1.0 / 16),
			{-2, -2, -0.25})
			.mesh();
	return mesh;
}

const PoleSet& platePoles()
{
	static const PoleSet poles = shrinkingBallPoles(plate());
	return poles;
}

TEST(MedialAxis, MiddleSheetOfAPlate)
{
	MedialAxisParameters p;
	p.minAngle = 150;
	const MedialAxis medial = medialAxis(plate(), platePoles(), true, p);
	double area = 0;
	for (const Triangle& t : medial.triangles) {
		const Point3d& a = medial.position[t[0]];
		area += ((medial.position[t[1]] - a) ^ (medial.position[t[2]] - a)).Norm() / 2;
	}
	for (size_t v = 0; v < medial.position.size(); ++v) {
		EXPECT_NEAR(medial.position[v][2], 0, 0.02);
		EXPECT_NEAR(medial.radius[v], 0.25, 0.02);
	}
	// The flat part reaches to a quarter from the rim, seen from above and from below.
	EXPECT_NEAR(area, 2 * 3.5 * 3.5, 0.1 * 24.5);
}

TEST(MedialAxis, AnglesAreThoseOfTheTwoContacts)
{
	const std::vector<double> angle = poleAngles(plate(), platePoles());
	for (int v = 0; v < plate().vertexSlots(); ++v) {
		const Point3d& p = plate().position[v];
		if (std::max(std::abs(p[0]), std::abs(p[1])) < 1.5) {
			EXPECT_NEAR(angle[v], 180, 5);
		}
	}
}

TEST(MedialAxis, AnglesOfAComponentAreThoseThatItHasAlone)
{
	// A ring round the centre of a ball, where all the ball's poles are.
	const shapes::Soup ball = shapes::sphere(3), ring = shapes::torus(0.5, 0.1);
	const auto anglesOf = [](const shapes::Soup& soup) {
		return poleAngles(soup.mesh(), medialPoles(soup.mesh(), PoleMethod::Balls));
	};
	std::vector<double> alone = anglesOf(ball);
	const std::vector<double> ofRing = anglesOf(ring);
	alone.insert(alone.end(), ofRing.begin(), ofRing.end());
	EXPECT_EQ(anglesOf(shapes::joined({ball, ring})), alone);
}

/// The angles as they are defined: of all points in the ball.
std::vector<double> anglesByAllPoints(const SurfaceMesh& mesh, const PoleSet& poles)
{
	const UnitFrame frame(mesh.position);
	std::vector<double> angles;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		const Point3d centre = frame.in(poles.centre[v]);
		const Point3d spoke = frame.in(mesh.position[v]) - centre;
		const double radius = frame.lengthIn(poles.radius[v]) * 1.01;
		double widest = 0;
		for (const Point3d& p : mesh.position)
			if (const Point3d other = frame.in(p)-centre; other.SquaredNorm() <= radius * radius)
				widest = std::max(widest, std::atan2((spoke ^ other).Norm(), spoke * other));
		angles.push_back(poles.has(v) ? widest * 180 / M_PI : -1);
	}
	return angles;
}

TEST(MedialAxis, AnglesAreTheWidestOfAllPointsInTheBall)
{
	for (const shapes::Soup& soup : {shapes::sphere(4), shapes::jittered(shapes::sphere(3), 0.05),
			 shapes::torus(), shapes::capsule(), shapes::box(1, 0.7, 0.2), shapes::plate(2, 4)}) {
		const SurfaceMesh mesh = soup.mesh();
		const PoleSet poles = medialPoles(mesh, PoleMethod::Balls);
		EXPECT_EQ(poleAngles(mesh, poles), anglesByAllPoints(mesh, poles));
	}
}

TEST(MedialAxis, OnASphereOnlyTheFarSideIsSearchedForTheWidestAngle)
{
	struct Counted : detail::WidestAngle
	{
		using WidestAngle::WidestAngle;
		int visits = 0;
		void visit(int slot, const Point3d& p)
		{
			++visits;
			WidestAngle::visit(slot, p);
		}
	};
	const SurfaceMesh mesh = shapes::sphere(5).mesh();
	const PointTree tree(mesh.position);
	for (int v = 0; v < mesh.vertexSlots(); v += 100) {
		Counted search(Point3d(0, 0, 0), 1.01, mesh.position[size_t(v)]);
		search.visit(0, mesh.position[size_t(tree.nearest(search.farthest()))]);
		tree.search(search);
		EXPECT_GT(search.widest(), 179.9 * M_PI / 180);
		EXPECT_LT(search.visits, mesh.vertexSlots() / 50);
	}
}

TEST(MedialAxis, FiltersByAngleAndRadius)
{
	for (double minimum : {0.0, 60.0, 120.0}) {
		MedialAxisParameters p;
		p.minAngle = minimum;
		p.minRadius = 0.1;
		const MedialAxis medial = medialAxis(plate(), platePoles(), false, p);
		EXPECT_TRUE(medial.triangles.empty());
		EXPECT_GT(medial.position.size(), 5000u);
		for (size_t v = 0; v < medial.position.size(); ++v) {
			EXPECT_GE(medial.angle[v], minimum);
			EXPECT_GE(medial.radius[v], 0.1);
			EXPECT_EQ(medial.position[v], platePoles().centre[medial.source[v]]);
		}
	}
	MedialAxisParameters tooThick;
	tooThick.minRadius = 0.3;
	EXPECT_TRUE(medialAxis(plate(), platePoles(), true, tooThick).position.empty());
}

TEST(MedialAxis, NoTriangleIsStretched)
{
	const SurfaceMesh mesh = shapes::jittered(shapes::torus(), 0.01).mesh();
	MedialAxisParameters p;
	p.minAngle = 0;
	p.maxStretch = 0.5;
	const MedialAxis medial = medialAxis(mesh, shrinkingBallPoles(mesh), true, p);
	for (const Triangle& t : medial.triangles)
		for (int k = 0; k < 3; ++k) {
			const int a = t[k], b = t[(k + 1) % 3];
			double longest = 0;
			for (int i = 0; i < 3; ++i)
				longest = std::max(longest,
					vcg::Distance(mesh.position[medial.source[t[i]]],
						mesh.position[medial.source[t[(i + 1) % 3]]]));
			EXPECT_LE(vcg::Distance(medial.position[a], medial.position[b]), 0.5 * longest);
		}
}

TEST(MedialAxis, EveryPointOfAJoinedLayerIsUsed)
{
	const MedialAxis medial = medialAxis(plate(), platePoles(), true);
	std::vector<char> used(medial.position.size(), 0);
	for (const Triangle& t : medial.triangles)
		for (int v : t)
			used[v] = 1;
	EXPECT_EQ(std::count(used.begin(), used.end(), 1), long(used.size()));
}

TEST(MedialAxis, RefusesParametersOutOfRange)
{
	MedialAxisParameters p;
	p.minAngle = 200;
	EXPECT_THROW(medialAxis(plate(), platePoles(), true, p), InvalidParameter);
	p = {};
	p.minRadius = -1;
	EXPECT_THROW(medialAxis(plate(), platePoles(), true, p), InvalidParameter);
	p = {};
	p.maxStretch = 0;
	EXPECT_THROW(medialAxis(plate(), platePoles(), true, p), InvalidParameter);
}

} // namespace
