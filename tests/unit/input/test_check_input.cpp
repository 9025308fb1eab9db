// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/input/check_input.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

CheckedSurface check(const shapes::Soup& soup)
{
	return checkedSurface(soup.points, soup.triangles);
}

/// The text of the refusal; empty if the soup was taken.
std::string refusal(const shapes::Soup& soup)
{
	try {
		check(soup);
	}
	catch (const InvalidInput& error) {
		return error.what();
	}
	return "";
}

/// Whether the text has all of the words.
testing::AssertionResult says(const std::string& text, const std::vector<std::string>& words)
{
	for (const std::string& word : words)
		if (text.find(word) == std::string::npos)
			return testing::AssertionFailure() << "no \"" << word << "\" in \"" << text << '"';
	return testing::AssertionSuccess();
}

std::string allNotes(const CheckedSurface& checked)
{
	std::string text;
	for (const std::string& note : checked.notes)
		text += note + '\n';
	return text;
}

} // namespace

TEST(CheckInput, AGoodMeshIsTakenAsItIs)
{
	for (const shapes::Soup& soup : {shapes::tetrahedron(), shapes::octahedron(), shapes::box(),
			 shapes::torus(), shapes::plate(3), shapes::capsule()}) {
		const CheckedSurface checked = check(soup);
		EXPECT_TRUE(checked.notes.empty()) << allNotes(checked);
		EXPECT_EQ(checked.mesh.position, soup.points);
		EXPECT_EQ(checked.mesh.triangles(), soup.triangles);
		for (size_t v = 0; v < soup.points.size(); ++v)
			EXPECT_EQ(checked.vertexOfInput[v], int(v));
	}
}

TEST(CheckInput, AnyScaleAndPlaceIsTaken)
{
	for (double scale : {1e-6, 1e-3, 1e3, 1e6})
		for (double shift : {0.0, 10.0, 1e4}) {
			const shapes::Soup soup = shapes::moved(
				shapes::scaled(shapes::plate(1), scale), Point3d(1, -1, 1) * (shift * scale));
			EXPECT_EQ(refusal(soup), "") << "scale " << scale << " shift " << shift;
		}
}

// What is refused, with the count, the place and the cure.

TEST(CheckInput, RefusesAnEmptyMesh)
{
	EXPECT_TRUE(says(refusal({}), {"empty", "closed triangle mesh"}));
}

TEST(CheckInput, RefusesAPointCloud)
{
	shapes::Soup cloud = shapes::sphere();
	cloud.triangles.clear();
	EXPECT_TRUE(says(refusal(cloud), {"no faces", "cloud of points"}));
}

TEST(CheckInput, RefusesOneTriangle)
{
	shapes::Soup one;
	one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	one.triangles = {{0, 1, 2}};
	EXPECT_TRUE(
		says(refusal(one), {"not watertight", "3 border edges", "(0.5 0 0)", "Fill the holes"}));
}

TEST(CheckInput, RefusesAnOpenMeshWithCountPlaceAndCure)
{
	EXPECT_TRUE(says(refusal(shapes::opened(shapes::box())),
		{"not watertight", "3 border edges", "Fill the holes"}));
	shapes::Soup many = shapes::torus();
	many.triangles.resize(many.triangles.size() / 2);
	const std::string text = refusal(many);
	EXPECT_TRUE(says(text, {"not watertight", "border edges", "...", "Fill the holes"}));
	EXPECT_LT(text.size(), 300u); // the first few places, not all
}

TEST(CheckInput, RefusesAMoebiusStripAsOneSided)
{
	// Closing its hole would not help: the text must not stop at the border.
	EXPECT_TRUE(says(refusal(shapes::moebiusStrip(24)), {"one-sided", "48 border edges"}));
}

TEST(CheckInput, RefusesAKleinBottleAsOneSided)
{
	EXPECT_TRUE(says(refusal(shapes::kleinBottle()), {"one-sided"}));
}

TEST(CheckInput, RefusesTetrahedraThatShareAnEdge)
{
	EXPECT_TRUE(says(refusal(shapes::tetrahedraSharingEdge()),
		{"not two-manifold", "1 edge with more than two faces", "(0.5 0 0)",
			"Split the mesh apart"}));
}

TEST(CheckInput, RefusesTetrahedraThatShareAVertex)
{
	EXPECT_TRUE(says(refusal(shapes::tetrahedraSharingVertex()),
		{"not two-manifold", "1 vertex", "(0 0 0)", "Split the mesh apart"}));
}

TEST(CheckInput, RefusesCoordinatesThatAreNoNumbers)
{
	for (double bad : {std::numeric_limits<double>::quiet_NaN(),
			 std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
		shapes::Soup soup = shapes::sphere(1);
		soup.points[3][1] = bad;
		EXPECT_TRUE(says(refusal(soup), {"1 vertex has", "vertex 3", "not a finite number"}));
		soup.points[5][0] = bad;
		EXPECT_TRUE(says(refusal(soup), {"2 vertices have", "3, 5", "not a finite number"}));
	}
}

TEST(CheckInput, RefusesAFaceWithoutItsVertex)
{
	shapes::Soup soup = shapes::box();
	soup.triangles[4][1] = 8;
	EXPECT_TRUE(says(refusal(soup), {"vertex 8", "of 8"}));
	soup.triangles[4][1] = -1;
	EXPECT_TRUE(says(refusal(soup), {"vertex -1"}));
}

TEST(CheckInput, RefusesWhatEnclosesNoVolume)
{
	EXPECT_TRUE(says(refusal(shapes::box(1, 1, 0)), {"no volume", "the mesh is flat"}));
	EXPECT_TRUE(says(refusal(shapes::scaled(shapes::box(), 0)), {"no volume"}));
	shapes::Soup backToBack;
	backToBack.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	backToBack.triangles = {{0, 1, 2}, {0, 2, 1}};
	EXPECT_TRUE(says(refusal(backToBack), {"no volume"}));
	const shapes::Soup one =
		shapes::joined({shapes::sphere(1), shapes::moved(shapes::box(1, 1, 0), {3, 0, 0})});
	EXPECT_TRUE(says(refusal(one),
		{"of 2 connected components, 1 encloses no volume", "(3.5 0.5 0)",
			"remove the flat part"}));
}

TEST(CheckInput, RefusesABodyOnALineWithRoundingOrWithout)
{
	// Along the x axis, along none, and with noise of the last digits; also far from the origin.
	const auto line = [](const Point3d& direction, double noise, unsigned seed) {
		return shapes::jittered(shapes::transformed(shapes::sphere(2),
									[&](const Point3d& p) { return direction * p[0]; }),
			noise, seed);
	};
	EXPECT_TRUE(says(refusal(line({1, 0, 0}, 0, 1)), {"no volume"}));
	EXPECT_TRUE(says(refusal(line({0.6, 0.64, 0.48}, 0, 1)), {"no volume"}));
	for (unsigned seed = 1; seed <= 20; ++seed) {
		EXPECT_TRUE(says(refusal(line({1, 0, 0}, 2e-16, seed)), {"no volume"})) << seed;
		EXPECT_TRUE(says(refusal(line({0.6, 0.64, 0.48}, 2e-16, seed)), {"no volume"})) << seed;
		EXPECT_TRUE(says(
			refusal(shapes::moved(line({0.6, 0.64, 0.48}, 0, seed), {1e6, 0, 0})), {"no volume"}));
	}
	EXPECT_TRUE(says(refusal(shapes::joined({shapes::sphere(1),
						 shapes::moved(line({0.6, 0.64, 0.48}, 2e-16, 1), {5, 0, 0})})),
		{"of 2 connected components, 1 encloses no volume"}));
}

TEST(CheckInput, TakesANeedleAndTurnsItTheRightWay)
{
	// Wide enough for its coordinates; its volume is lost where it is not measured along the needle.
	const shapes::Soup needle = shapes::transformed(shapes::sphere(1), [](const Point3d& p) {
		const double x = p[0], y = 3e-9 * p[1], z = 3e-9 * p[2];
		return Point3d(
			0.6 * x - 0.8 * y, 0.64 * x + 0.48 * y - 0.6 * z, 0.48 * x + 0.36 * y + 0.8 * z);
	});
	EXPECT_TRUE(checkedSurface(needle.points, needle.triangles).notes.empty());
	const shapes::Soup turned = shapes::insideOut(needle);
	EXPECT_EQ(checkedSurface(turned.points, turned.triangles).notes.size(), 1u);
}

TEST(CheckInput, RefusesOnlyDegenerateFaces)
{
	shapes::Soup soup;
	soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	soup.triangles = {{0, 1, 1}, {2, 2, 2}};
	EXPECT_TRUE(says(refusal(soup), {"degenerate"}));
}

TEST(CheckInput, NamesBothDefectsIfThereAreBoth)
{
	shapes::Soup soup = shapes::joined(
		{shapes::tetrahedraSharingEdge(), shapes::moved(shapes::opened(shapes::box()), {5, 0, 0})});
	EXPECT_TRUE(says(
		refusal(soup), {"1 edge with more than two faces", "3 border edges", "fill the holes"}));
}

// What is repaired, and said.

TEST(CheckInput, LeavesOutUnreferencedVertices)
{
	shapes::Soup soup = shapes::box();
	soup.points.insert(soup.points.begin(), {9, 9, 9});
	soup.points.push_back({8, 8, 8});
	for (Triangle& t : soup.triangles)
		for (int& v : t)
			++v;
	const CheckedSurface checked = check(soup);
	EXPECT_TRUE(says(allNotes(checked), {"2 unreferenced vertices"}));
	EXPECT_EQ(checked.mesh.vertexCount(), 8);
	EXPECT_EQ(checked.vertexOfInput.front(), -1);
	EXPECT_EQ(checked.vertexOfInput.back(), -1);
	for (int v = 1; v <= 8; ++v)
		EXPECT_EQ(checked.mesh.position[checked.vertexOfInput[v]], soup.points[v]);
	EXPECT_DOUBLE_EQ(checked.mesh.volume(), 1);
}

TEST(CheckInput, MergesCoincidentVertices)
{
	const shapes::Soup whole = shapes::torus(), soup = shapes::unmerged(whole);
	const CheckedSurface checked = check(soup);
	EXPECT_TRUE(says(allNotes(checked), {"coincident vertices were merged"}));
	EXPECT_EQ(checked.mesh.vertexCount(), int(whole.points.size()));
	EXPECT_EQ(checked.mesh.eulerCharacteristic(), 0);
	ASSERT_EQ(checked.vertexOfInput.size(), soup.points.size());
	for (size_t v = 0; v < soup.points.size(); ++v)
		EXPECT_EQ(checked.mesh.position[checked.vertexOfInput[v]], soup.points[v]);
}

TEST(CheckInput, DoesNotMergeAClosedMesh)
{
	// Two boxes that touch at a corner, each closed: merging would make a pinched vertex.
	const CheckedSurface checked =
		check(shapes::joined({shapes::box(), shapes::moved(shapes::box(), {1, 1, 1})}));
	EXPECT_EQ(checked.mesh.vertexCount(), 16);
	EXPECT_TRUE(checked.notes.empty());
}

TEST(CheckInput, LeavesOutDegenerateAndDuplicateFaces)
{
	shapes::Soup soup = shapes::sphere(1);
	soup.triangles.push_back({0, 0, 1});
	soup.triangles.push_back({5, 5, 5});
	const auto [a, b, c] = soup.triangles[2];
	soup.triangles.push_back({b, c, a}); // the same face, told from another corner
	const CheckedSurface checked = check(soup);
	EXPECT_TRUE(says(allNotes(checked), {"3 degenerate or duplicate faces"}));
	EXPECT_EQ(checked.mesh.triangles(), shapes::sphere(1).triangles);
}

TEST(CheckInput, TurnsFacesAgainstTheirNeighbours)
{
	shapes::Soup soup = shapes::sphere(2);
	for (size_t f = 0; f < soup.triangles.size(); f += 3)
		std::swap(soup.triangles[f][0], soup.triangles[f][1]);
	const size_t turned = (soup.triangles.size() + 2) / 3;
	const CheckedSurface checked = check(soup);
	EXPECT_TRUE(says(allNotes(checked), {std::to_string(turned) + " faces were turned"}));
	EXPECT_DOUBLE_EQ(checked.mesh.volume(), shapes::sphere(2).mesh().volume());
}

TEST(CheckInput, TurnsAMeshThatIsInsideOut)
{
	const CheckedSurface checked = check(shapes::insideOut(shapes::torus()));
	EXPECT_TRUE(says(allNotes(checked), {"inside out"}));
	EXPECT_DOUBLE_EQ(checked.mesh.volume(), shapes::torus().mesh().volume());
	EXPECT_EQ(checks::structureError(checked.mesh), "");
}

TEST(CheckInput, TurnsEachComponentByItself)
{
	const CheckedSurface checked = check(
		shapes::joined({shapes::box(), shapes::insideOut(shapes::moved(shapes::box(), {5, 0, 0})),
			shapes::moved(shapes::box(), {0, 5, 0})}));
	EXPECT_TRUE(says(allNotes(checked), {"1 of 3 connected components"}));
	EXPECT_NEAR(checked.mesh.volume(), 3, 1e-12);
}

TEST(CheckInput, DoesSeveralRepairsAtOnce)
{
	shapes::Soup soup = shapes::unmerged(shapes::insideOut(shapes::plate(2)));
	std::swap(soup.triangles[0][0], soup.triangles[0][1]);
	soup.points.push_back({7, 7, 7});
	soup.triangles.push_back({0, 0, 0});
	const CheckedSurface checked = check(soup);
	EXPECT_EQ(checks::structureError(checked.mesh), "");
	EXPECT_EQ(checks::genus(checked.mesh), 2);
	EXPECT_NEAR(checked.mesh.volume(), shapes::plate(2).mesh().volume(), 1e-12);
	EXPECT_EQ(checked.vertexOfInput.back(), -1);
	EXPECT_TRUE(
		says(allNotes(checked), {"degenerate", "merged", "turned", "inside out", "unreferenced"}));
}

TEST(CheckInput, TakesSeventyComponents)
{
	shapes::Soup soup;
	for (int i = 0; i < 70; ++i)
		soup = shapes::joined({soup, shapes::moved(shapes::octahedron(), {3.0 * i, 0, 0})});
	const CheckedSurface checked = check(soup);
	int components = 0;
	const std::vector<int> component = connectedComponents(checked.mesh, &components);
	EXPECT_EQ(components, 70);
	for (size_t v = 0; v < component.size(); ++v)
		EXPECT_EQ(component[v], int(v / 6)); // numbered by their lowest vertex
}

TEST(CheckInput, TheOrderOfTheFacesChangesNothingButTheOrder)
{
	const shapes::Soup soup = shapes::shuffled(shapes::plate(3));
	EXPECT_EQ(refusal(soup), "");
	EXPECT_EQ(check(soup).mesh.position, soup.points);
}

TEST(CheckInput, ThousandsOfFacesAtAVertexTakeNoTime)
{
	EXPECT_EQ(refusal(shapes::revolved({{-1, 0}, {0, 1}, {1, 0}}, 100000)), "");
}
