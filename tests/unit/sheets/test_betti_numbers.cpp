// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/sheets/betti_numbers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

std::vector<FaceOfComplex> facesOf(const shapes::Soup& soup)
{
	std::vector<FaceOfComplex> faces;
	for (Triangle t : soup.triangles) {
		std::sort(t.begin(), t.end());
		faces.push_back(t);
	}
	return faces;
}

BettiNumbers betti(const shapes::Soup& soup)
{
	return bettiNumbers(int(soup.points.size()), {}, facesOf(soup));
}

TEST(BettiNumbers, OfGraphs)
{
	EXPECT_EQ(bettiNumbers(0, {}, {}), (BettiNumbers {0, 0, 0}));
	EXPECT_EQ(bettiNumbers(3, {}, {}), (BettiNumbers {3, 0, 0}));
	EXPECT_EQ(bettiNumbers(4, {{0, 1}, {1, 2}, {2, 3}}, {}), (BettiNumbers {1, 0, 0}));
	EXPECT_EQ(bettiNumbers(5, {{0, 1}, {0, 2}, {1, 2}, {3, 4}}, {}), (BettiNumbers {2, 1, 0}));
}

TEST(BettiNumbers, OfClosedSurfaces)
{
	EXPECT_EQ(betti(shapes::tetrahedron()), (BettiNumbers {1, 0, 1}));
	EXPECT_EQ(betti(shapes::sphere(2)), (BettiNumbers {1, 0, 1}));
	EXPECT_EQ(betti(shapes::torus()), (BettiNumbers {1, 2, 1}));
	EXPECT_EQ(betti(shapes::csaszarTorus()), (BettiNumbers {1, 2, 1}));
	EXPECT_EQ(betti(shapes::plate(3)), (BettiNumbers {1, 6, 1}));
	EXPECT_EQ(
		betti(shapes::joined({shapes::torus(), shapes::sphere(1)})), (BettiNumbers {2, 2, 2}));
}

TEST(BettiNumbers, OfSurfacesThatHaveNoInside)
{
	EXPECT_EQ(betti(shapes::moebiusStrip()), (BettiNumbers {1, 1, 0}));
	EXPECT_EQ(betti(shapes::kleinBottle()), (BettiNumbers {1, 2, 1})) << "over GF(2)";
}

TEST(BettiNumbers, OfSheetsThatMeetInASeam)
{
	// Three triangles on one edge; closed by two more they enclose two pockets.
	const std::vector<FaceOfComplex> book = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
	EXPECT_EQ(bettiNumbers(5, {}, book), (BettiNumbers {1, 0, 0}));
	std::vector<FaceOfComplex> closed = book;
	closed.insert(closed.end(), {{0, 2, 3}, {1, 2, 3}, {0, 3, 4}, {1, 3, 4}});
	EXPECT_EQ(bettiNumbers(5, {}, closed), (BettiNumbers {1, 0, 2}));
}

TEST(BettiNumbers, CurvesAndSheetsTogether)
{
	// A square sheet with a handle of two edges, and a whisker.
	const std::vector<FaceOfComplex> square = {{0, 1, 2}, {1, 2, 3}};
	EXPECT_EQ(bettiNumbers(6, {{0, 4}, {3, 4}, {1, 5}}, square), (BettiNumbers {1, 1, 0}));
	EXPECT_EQ(bettiNumbers(6, {{1, 2}, {0, 4}, {1, 5}}, square), (BettiNumbers {1, 0, 0}))
		<< "an edge of a face may be given, too";
}

} // namespace
