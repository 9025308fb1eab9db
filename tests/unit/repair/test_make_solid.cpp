// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/repair/make_solid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

SolidSurface solid(const shapes::Soup& soup, Repair repair = Repair::Auto)
{
	return solidSurface(soup.points, soup.triangles, repair);
}

/// What is thrown; Defect::Other if nothing is.
Defect defectOf(const shapes::Soup& soup, Repair repair = Repair::Auto)
{
	try {
		solid(soup, repair);
	}
	catch (const InvalidInput& error) {
		return error.defect();
	}
	return Defect::Other;
}

double volumeIn(const SurfaceMesh& mesh)
{
	double volume = 0;
	for (const Triangle& t : mesh.triangles())
		volume += mesh.position[size_t(t[0])]
			* (mesh.position[size_t(t[1])] ^ mesh.position[size_t(t[2])]) / 6;
	return volume;
}

int piecesOf(const SurfaceMesh& mesh)
{
	int components = 0;
	connectedComponents(mesh, &components);
	return components;
}

/// The part of a sphere below a rim that goes up and down by a third of the radius.
shapes::Soup bowl(double height, int levels = 4)
{
	shapes::Soup soup = shapes::sphere(levels);
	std::vector<Triangle> left;
	for (const Triangle& t : soup.triangles)
		if (const Point3d& p = soup.points[size_t(t[0])];
			p[2] < height + std::cos(3 * std::atan2(p[1], p[0])) / 3)
			left.push_back(t);
	soup.triangles = left;
	return soup;
}

TEST(MakeSolid, LeavesASoundSurfaceToTheLastBit)
{
	for (const shapes::Soup& soup : {shapes::torus(), shapes::capsule(), shapes::plate(2),
			 shapes::insideOut(shapes::sphere()), shapes::unmerged(shapes::sphere())}) {
		const SolidSurface made = solid(soup);
		const CheckedSurface checked = checkedSurface(soup.points, soup.triangles);
		EXPECT_EQ(made.report.outcome, SolidReport::Sound);
		EXPECT_TRUE(made.surface.mesh.position == checked.mesh.position);
		EXPECT_TRUE(made.surface.mesh.triangles() == checked.mesh.triangles());
		EXPECT_EQ(made.surface.vertexOfInput, checked.vertexOfInput);
		EXPECT_EQ(made.surface.notes, checked.notes);
	}
}

TEST(MakeSolid, LeavesBodiesInsideBodies)
{
	const shapes::Soup soup = shapes::joined({shapes::sphere(), shapes::sphere(3, 0.4)});
	EXPECT_EQ(solid(soup).report.outcome, SolidReport::Sound);
	EXPECT_EQ(piecesOf(solid(soup).surface.mesh), 2);
}

TEST(MakeSolid, MendsASmallHole)
{
	const shapes::Soup soup = shapes::opened(shapes::sphere());
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Mended);
	EXPECT_EQ(made.report.mended.holesClosed, 1);
	EXPECT_EQ(checks::structureError(made.surface.mesh), "");
	ASSERT_EQ(made.surface.vertexOfInput.size(), soup.points.size());
	for (size_t v = 0; v < soup.points.size(); ++v)
		EXPECT_TRUE(
			made.surface.mesh.position[size_t(made.surface.vertexOfInput[v])] == soup.points[v]);
	EXPECT_EQ(made.report.distanceMax, 0);
	EXPECT_NE(made.report.text().find("1 hole closed"), std::string::npos);
}

TEST(MakeSolid, WrapsWhatHasALargeHole)
{
	const shapes::Soup soup = bowl(0.2);
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(checks::structureError(made.surface.mesh), "");
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
	EXPECT_LT(made.report.distanceMean, 0.05);
	// The vertices of the input know their place on the wrap.
	std::vector<char> used(soup.points.size(), 0);
	for (const Triangle& t : soup.triangles)
		for (int v : t)
			used[size_t(v)] = 1;
	for (size_t v = 0; v < soup.points.size(); ++v) {
		const int own = made.surface.vertexOfInput[v];
		ASSERT_EQ(own >= 0, bool(used[v]));
		if (own >= 0) {
			EXPECT_LT(Distance(made.surface.mesh.position[size_t(own)], soup.points[v]), 0.05);
		}
	}
}

TEST(MakeSolid, MendAloneRefusesWhatWouldBeWrapped)
{
	EXPECT_EQ(defectOf(bowl(0.2), Repair::Mend), Defect::BorderEdges);
	EXPECT_EQ(defectOf(shapes::kleinBottle(), Repair::Mend), Defect::OneSided);
}

TEST(MakeSolid, OffRefusesAsTheCheckDoes)
{
	EXPECT_EQ(defectOf(shapes::opened(shapes::sphere()), Repair::Off), Defect::BorderEdges);
	EXPECT_EQ(defectOf(shapes::tetrahedraSharingEdge(), Repair::Off), Defect::NonManifoldEdges);
	EXPECT_EQ(
		defectOf(shapes::tetrahedraSharingVertex(), Repair::Off), Defect::NonManifoldVertices);
}

TEST(MakeSolid, WrapsBodiesThatRunIntoEachOther)
{
	const shapes::Soup soup = shapes::joined(
		{shapes::box(2, 1, 1), shapes::moved(shapes::box(2, 1, 1), {1.03, 0.21, 0.17})});
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_GT(made.report.selfIntersections, 0);
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
	const double edge = made.report.spacing * Distance(Point3d(0, 0, 0), Point3d(3.03, 1.21, 1.17));
	EXPECT_NEAR(volumeIn(made.surface.mesh), 4 - 0.97 * 0.79 * 0.83, 26 * edge * edge / 2);
	EXPECT_EQ(piecesOf(solid(soup, Repair::Off).surface.mesh), 2);
}

TEST(MakeSolid, MakesOneOfBodiesThatShareAWall)
{
	const shapes::Soup soup =
		shapes::joined({shapes::box(2, 1, 1), shapes::moved(shapes::box(1, 1, 1), {2, 0, 0})});
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(checks::structureError(made.surface.mesh), "");
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
	EXPECT_NEAR(volumeIn(made.surface.mesh), 3, 0.03);
	EXPECT_EQ(piecesOf(solid(soup, Repair::Off).surface.mesh), 2);
}

TEST(MakeSolid, LeavesBodiesThatTouchAtAnEdge)
{
	const shapes::Soup soup =
		shapes::joined({shapes::box(1, 1, 1), shapes::moved(shapes::box(1, 1, 1), {1, 1, 0})});
	EXPECT_EQ(solid(soup).report.outcome, SolidReport::Sound);
	EXPECT_EQ(piecesOf(solid(soup).surface.mesh), 2);
}

TEST(MakeSolid, MakesOneOfScansThatOverlap)
{
	// A torus in three parts of its round, each more than a third, a little apart.
	const shapes::Soup torus = shapes::torus();
	shapes::Soup soup;
	for (int part = 0; part < 3; ++part) {
		shapes::Soup scan = shapes::moved(torus, {0.002 * part, 0.003 * part, 0.004 * (1 - part)});
		std::vector<Triangle> seen;
		for (const Triangle& t : scan.triangles) {
			const Point3d& p = torus.points[size_t(t[0])];
			const double turn = std::atan2(p[1], p[0]) / (2 * M_PI) - part / 3.0;
			if (turn - std::floor(turn) < 0.45)
				seen.push_back(t);
		}
		scan.triangles = seen;
		soup = shapes::joined({soup, scan});
	}
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(checks::structureError(made.surface.mesh), "");
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
	EXPECT_EQ(made.surface.mesh.vertexCount() - made.surface.mesh.faceCount() / 2, 0);
	EXPECT_NEAR(volumeIn(made.surface.mesh), volumeIn(torus.mesh()), 0.03);
	EXPECT_LT(made.report.distanceMax, 0.01);
}

TEST(MakeSolid, LeavesWhatIsTooThinToBeWrappedAndSaysSo)
{
	// Two wires side by side, half in each other: a lattice of a wrap has edges as long as they are thick.
	const shapes::Soup wire = shapes::box(1000, 0.05, 0.05);
	const shapes::Soup soup = shapes::joined({wire, shapes::moved(wire, {500, 0.02, 0.01})});
	const SolidSurface made = solid(soup);
	EXPECT_EQ(made.report.outcome, SolidReport::Sound);
	EXPECT_GT(made.report.selfIntersections, 0);
	EXPECT_NEAR(made.report.overlap, 0.6 / 4.4, 0.02);
	ASSERT_EQ(made.surface.notes.size(), 1u);
	EXPECT_NE(made.surface.notes[0].find("thin parts"), std::string::npos);
	EXPECT_EQ(piecesOf(made.surface.mesh), 2);
}

TEST(MakeSolid, WallsInsideDoNotMakeAShapeThin)
{
	// A row of cubes, each of which ends a little way within the next one.
	shapes::Soup row;
	for (int i = 0; i < 12; ++i)
		row = shapes::joined(
			{row, shapes::moved(shapes::box(), {0.98 * i, 0.1 * (i % 2), 0.1 * (i % 3)})});
	const SolidSurface made = solid(row);
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
}

TEST(MakeSolid, WrapsThinBodiesOfWhichNothingIsLost)
{
	// The same two wires, 2.4 times as thick as the lattice's edges are long, and thinner between them.
	const double length = 100, thick = 2.4 * 2.4 * 8 * length / 150000;
	const shapes::Soup wire = shapes::box(length, thick, thick);
	const SolidSurface made =
		solid(shapes::joined({wire, shapes::moved(wire, {length / 2, 0.4 * thick, 0.2 * thick})}));
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(checks::structureError(made.surface.mesh), "");
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
	const double volume = (2 * length - length / 2 * 0.6 * 0.8) * thick * thick;
	EXPECT_NEAR(volumeIn(made.surface.mesh), volume, 0.1 * volume);
}

TEST(MakeSolid, MeasuresWhatAWrapLeavesOut)
{
	// Of two bars one has lost half; what is inside of the other is not lost.
	const shapes::Soup bar = shapes::refined(shapes::box(10, 1, 1), 5),
					   inner = shapes::refined(
						   shapes::moved(shapes::box(8, 0.1, 0.1), {1, 0.4, 0.4}), 4);
	const SurfaceMesh given = shapes::joined({bar, shapes::moved(bar, {0, 5, 0}), inner}).mesh();
	const SurfaceMesh wrapped =
		shapes::joined({bar, shapes::moved(shapes::box(5, 1, 1), {0, 5, 0})}).mesh();
	const double area = 2 * (40 + 2) + 2 * 8 * 0.2 + 0.02;
	EXPECT_NEAR(detail::partLeftOut(given, wrapped, 1e-3, Progress()), (20 + 1) / area, 0.01);
	EXPECT_NEAR(detail::partLeftOut(given, wrapped, 1, Progress()), (16 + 1) / area, 0.01);
	EXPECT_EQ(detail::partLeftOut(given, given, 1e-3, Progress()), 0);
}

TEST(MakeSolid, DoesNotTakeACavityForAnOverlap)
{
	// Two small balls that cross in a lens, beside a hollow one: sound, or with a hole to be mended.
	const double radius = 0.2, apart = 0.3;
	const double lens = M_PI * (4 * radius + apart) * std::pow(2 * radius - apart, 2) / 12;
	const double volume = 4 * M_PI / 3 * (1 - 0.125 + 2 * std::pow(radius, 3)) - lens;
	const shapes::Soup ball = shapes::sphere(4, radius);
	for (const shapes::Soup& outer : {shapes::sphere(4), shapes::opened(shapes::sphere(4))}) {
		const SolidSurface made =
			solid(shapes::joined({outer, shapes::insideOut(shapes::sphere(3, 0.5)),
				shapes::moved(ball, {0, 0, 2}), shapes::moved(ball, {0, 0, 2 + apart})}));
		EXPECT_NE(made.report.outcome, SolidReport::Wrapped);
		EXPECT_NEAR(made.report.overlap, lens / volume, 0.1 * lens / volume);
		EXPECT_GT(made.report.selfIntersections, 0);
		EXPECT_EQ(piecesOf(made.surface.mesh), 4);
		ASSERT_FALSE(made.surface.notes.empty());
		EXPECT_NE(made.surface.notes.back().find("that is little"), std::string::npos);
	}
}

TEST(MakeSolid, LeavesBodiesThatAWrapWouldCut)
{
	// A dumbbell and a block that crosses one of its ends, or shares a wall with it.
	for (const double waist : {0.3, 1e-4})
		for (const double overlap : {0.2, 0.0}) {
			const double across[] = {0, 0.5 - waist / 2, 0.5 + waist / 2, 1};
			const shapes::Soup dumbbell = shapes::transformed(
				shapes::cells(
					3, 3, 3, [](int i, int j, int k) { return i != 1 || (j == 1 && k == 1); }),
				[&](const Point3d& p) {
					return Point3d(p[0], across[int(p[1])], across[int(p[2])]);
				});
			const SolidSurface made = solid(shapes::joined(
				{dumbbell, shapes::moved(shapes::box(1, 1, 1), {3 - overlap, overlap, overlap})}));
			if (waist > 0.1) {
				EXPECT_EQ(made.report.outcome, SolidReport::Wrapped) << overlap;
				EXPECT_EQ(piecesOf(made.surface.mesh), 1) << overlap;
				continue;
			}
			EXPECT_EQ(made.report.outcome, SolidReport::Sound) << overlap;
			EXPECT_EQ(piecesOf(made.surface.mesh), 2) << overlap;
			ASSERT_EQ(made.surface.notes.size(), 1u) << overlap;
			EXPECT_NE(made.surface.notes[0].find("would cut"), std::string::npos);
		}
}

TEST(MakeSolid, WrapsBodiesOfWhichASmallOneIsCut)
{
	// Two blocks that cross, and a needle through one of them that is thinner than the lattice half of the way.
	const shapes::Soup needle = shapes::transformed(
		shapes::cells(3, 1, 1, [](int, int, int) { return true; }), [](const Point3d& p) {
			const double thin = p[0] == 1 || p[0] == 2 ? 1e-4 : 0.05;
			return Point3d(p[0], 0.5 + (p[1] - 0.5) * thin, 0.5 + (p[2] - 0.5) * thin);
		});
	const SolidSurface made = solid(shapes::joined({shapes::box(2, 2, 2),
		shapes::moved(shapes::box(2, 2, 2), {1.2, 1.1, 0.9}), shapes::moved(needle, {-2, 0, 0})}));
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_EQ(piecesOf(made.surface.mesh), 2) << "with what the needle has beyond its thin half";
}

TEST(MakeSolid, TurnsAWrapThatIsInsideOut)
{
	const SolidSurface made = solid(shapes::insideOut(bowl(0.2)));
	EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
	EXPECT_NEAR(volumeIn(made.surface.mesh), volumeIn(solid(bowl(0.2)).surface.mesh), 1e-3);
}

TEST(MakeSolid, RefusesAnOpenSheet)
{
	shapes::Soup sheet;
	for (int i = 0; i <= 20; ++i)
		for (int j = 0; j <= 20; ++j)
			sheet.points.emplace_back(i, j, 0.02 * (i - 10) * (i - 10));
	for (int i = 0; i < 20; ++i)
		for (int j = 0; j < 20; ++j) {
			const int a = 21 * i + j;
			sheet.triangles.push_back({a, a + 21, a + 22});
			sheet.triangles.push_back({a, a + 22, a + 1});
		}
	EXPECT_EQ(defectOf(sheet), Defect::OpenSheet);
	EXPECT_EQ(defectOf(shapes::insideOut(sheet)), Defect::OpenSheet);
	EXPECT_EQ(defectOf(sheet, Repair::Off), Defect::BorderEdges);
	const SolidSurface thick =
		solidSurface(sheet.points, sheet.triangles, {Repair::Auto, 0, false, 0.01});
	EXPECT_EQ(thick.report.outcome, SolidReport::Mended);
	EXPECT_NEAR(thick.report.distanceMax, 0.005, 1e-4);
	EXPECT_NE(
		thick.report.text().find("an open sheet given a thickness of 1 %"), std::string::npos);
	EXPECT_EQ(thick.surface.vertexOfInput.size(), sheet.points.size());
	EXPECT_THROW(solidSurface(sheet.points, sheet.triangles, {Repair::Auto, 0, false, -1}),
		InvalidParameter);
	EXPECT_THROW(
		solidSurface(sheet.points, sheet.triangles, {Repair::Off, 0, false, 0.01}), InvalidInput);
}

TEST(MakeSolid, RefusesASheetWithoutArea)
{
	const shapes::Soup onALine = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
	const shapes::Soup inOnePlace = shapes::scaled(shapes::box(), 0);
	for (const shapes::Soup& soup : {onALine, inOnePlace})
		EXPECT_THROW(solidSurface(soup.points, soup.triangles, {Repair::Auto, 0, false, 0.01}),
			InvalidInput);
}

TEST(MakeSolid, SaysThatADrawingIsFlat)
{
	// Turned, so that its flatness is that of rounded coordinates.
	shapes::Soup drawing;
	for (int i = 0; i <= 10; ++i)
		for (int j = 0; j <= 10; ++j)
			drawing.points.push_back(Point3d(0.6, 0.8, 0) * i + Point3d(0.48, -0.36, 0.8) * j);
	for (int i = 0; i < 10; ++i)
		for (int j = 0; j < 10; ++j)
			if (i + j != 9)
				drawing.triangles.push_back({11 * i + j, 11 * i + j + 11, 11 * i + j + 12});
	for (const shapes::Soup& soup :
		{drawing, shapes::Soup {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}})
		for (const Repair repair : {Repair::Auto, Repair::Mend, Repair::Off})
			try {
				solid(soup, repair);
				ADD_FAILURE() << "a drawing bounds no solid";
			}
			catch (const InvalidInput& error) {
				EXPECT_EQ(error.defect(), Defect::OpenSheet);
				EXPECT_NE(std::string(error.what()).find("The mesh is flat"), std::string::npos);
			}
}

TEST(MakeSolid, RefusesWhatHasNoFacesOrVolume)
{
	EXPECT_EQ(defectOf({}), Defect::Empty);
	EXPECT_EQ(defectOf({{{0, 0, 0}, {1, 0, 0}}, {}}), Defect::NoFaces);
	EXPECT_EQ(defectOf(shapes::transformed(
				  shapes::sphere(), [](const Point3d& p) { return Point3d(p[0], p[1], 0); })),
		Defect::Flat);
}

TEST(MakeSolid, KeepsWhatHasVolumeOfWhatIsPartlyFlat)
{
	const shapes::Soup flat = shapes::transformed(
		shapes::sphere(), [](const Point3d& p) { return Point3d(p[0] + 3, p[1], 0); });
	const SolidSurface made = solid(shapes::joined({shapes::sphere(), flat}));
	EXPECT_EQ(made.report.outcome, SolidReport::Mended);
	EXPECT_EQ(made.report.mended.piecesDropped, 1);
	EXPECT_EQ(piecesOf(made.surface.mesh), 1);
}

TEST(MakeSolid, MeansTheSameAtAnySize)
{
	const SolidSurface usual = solid(bowl(0.2));
	for (double size : {1e-6, 1e6}) {
		const SolidSurface made = solid(shapes::scaled(bowl(0.2), size));
		EXPECT_EQ(made.report.outcome, SolidReport::Wrapped);
		EXPECT_NEAR(
			volumeIn(made.surface.mesh) / std::pow(size, 3), volumeIn(usual.surface.mesh), 1e-3);
	}
}

} // namespace
