// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/mesh/components.h>
#include <skeleton/repair/make_solid.h>
#include <skeleton/repair/mend.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// A soup without the faces whose middle is where it says.
shapes::Soup without(shapes::Soup soup, const std::function<bool(const Point3d&)>& where)
{
	soup.triangles.erase(std::remove_if(soup.triangles.begin(), soup.triangles.end(),
							 [&](const Triangle& t) {
								 return where((soup.points[size_t(t[0])] + soup.points[size_t(t[1])]
												  + soup.points[size_t(t[2])])
									 / 3.0);
							 }),
		soup.triangles.end());
	return soup;
}

struct Outcome
{
	int gaps = 0, pieces = 0, euler = 0;
	double volume = 0;
};

Outcome outcomeOf(const SurfaceMesh& mesh)
{
	Outcome outcome;
	connectedComponents(mesh, &outcome.pieces);
	outcome.euler = mesh.vertexCount() - mesh.faceCount() / 2;
	outcome.volume = mesh.volume();
	return outcome;
}

Outcome mended(const shapes::Soup& soup)
{
	const MendedSurface surface = mend(soup.points, soup.triangles);
	const auto mesh = SurfaceMesh::ifClosedManifold(surface.points, surface.triangles);
	EXPECT_TRUE(mesh);
	Outcome outcome = mesh ? outcomeOf(*mesh) : Outcome();
	outcome.gaps = surface.report.gapsBridged;
	return outcome;
}

void expectOneWrappedBody(const shapes::Soup& soup, double volume)
{
	const SolidSurface solid = solidSurface(soup.points, soup.triangles);
	EXPECT_EQ(solid.report.outcome, SolidReport::Wrapped);
	const Outcome made = outcomeOf(solid.surface.mesh);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
	EXPECT_NEAR(made.volume, volume, 0.03 * volume);
}

double volumeOf(const shapes::Soup& soup)
{
	return soup.mesh().volume();
}

TEST(BridgeGaps, AMissingPieceOfALimb)
{
	const shapes::Soup whole = shapes::capsule(6, 0.2, 24);
	for (double gap : {0.3, 1.0, 3.0}) {
		const Outcome made =
			mended(without(whole, [&](const Point3d& p) { return std::abs(p[0]) < gap / 2; }));
		EXPECT_EQ(made.gaps, 1);
		EXPECT_EQ(made.pieces, 1);
		EXPECT_EQ(made.euler, 2);
		EXPECT_NEAR(made.volume, volumeOf(whole), 0.05 * volumeOf(whole)) << gap;
	}
}

TEST(BridgeGaps, AFarPartOfALimbThatIsAlignedWithTheRest)
{
	// A gap of 90 radii; the outer part is turned around the near end of the gap.
	const auto torn = [](double degrees) {
		const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
		return mended(shapes::transformed(without(shapes::capsule(60, 0.2, 24),
											  [](const Point3d& p) { return std::abs(p[0]) < 9; }),
			[&](const Point3d& p) {
				return p[0] > 0
					? Point3d(9 + c * (p[0] - 9) - s * p[1], s * (p[0] - 9) + c * p[1], p[2])
					: p;
			}));
	};
	for (double degrees : {0, 30}) {
		EXPECT_EQ(torn(degrees).gaps, 1) << degrees;
		EXPECT_EQ(torn(degrees).pieces, 1) << degrees;
		EXPECT_EQ(torn(degrees).euler, 2) << degrees;
	}
	EXPECT_EQ(torn(50).gaps, 0);
	EXPECT_EQ(torn(50).pieces, 2);
}

TEST(BridgeGaps, ATwigAheadOfAMuchThickerOne)
{
	const auto openAt = [](double radius, double side, const Point3d& at) {
		return shapes::moved(without(shapes::capsule(6, radius, 24),
								 [&](const Point3d& p) { return side * p[0] > 2; }),
			at);
	};
	for (double ratio : {2, 4}) {
		const Outcome made =
			mended(shapes::joined({openAt(0.6, 1, {0, 0, 0}), openAt(0.6 / ratio, -1, {7, 0, 1})}));
		EXPECT_EQ(made.gaps, 1) << ratio;
		EXPECT_EQ(made.euler, 2) << ratio;
	}
	// Ahead of its side it is another one.
	EXPECT_EQ(
		mended(shapes::joined({openAt(0.6, 1, {0, 0, 0}), openAt(0.15, -1, {3, 0, 4})})).gaps, 0);
}

TEST(BridgeGaps, RaggedEndsThatAreCutAtASlant)
{
	std::mt19937 random(7);
	std::uniform_real_distribution<double> rag(-0.1, 0.1);
	const shapes::Soup whole = shapes::capsule(6, 0.2, 32);
	const Outcome made = mended(without(
		whole, [&](const Point3d& p) { return std::abs(p[0] + 1.5 * p[1] + rag(random)) < 0.8; }));
	EXPECT_EQ(made.gaps, 1);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_NEAR(made.volume, volumeOf(whole), 0.1 * volumeOf(whole));
}

TEST(BridgeGaps, FollowsTheBend)
{
	// Three quarters of a ring, without 30 degrees in its middle: the tube goes on along the circle.
	const double radius = 0.08;
	const auto angle = [](const Point3d& p) { return std::atan2(p[1], p[0]); };
	const shapes::Soup bow = without(shapes::torus(1, radius, 120, 16),
		[&](const Point3d& p) { return angle(p) > 0 && angle(p) < M_PI / 2; });
	const Outcome whole = mended(bow);
	ASSERT_EQ(whole.gaps, 0);
	const Outcome made = mended(
		without(bow, [&](const Point3d& p) { return angle(p) > -2 && angle(p) < -2 + M_PI / 6; }));
	EXPECT_EQ(made.gaps, 1);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
	EXPECT_NEAR(made.volume, whole.volume, 0.03 * whole.volume);
}

TEST(BridgeGaps, ALimbTornOffABody)
{
	const shapes::Soup body = without(shapes::sphere(4, 1),
		[](const Point3d& p) { return p[0] > 0 && std::hypot(p[1], p[2]) < 0.25; });
	const shapes::Soup limb = without(shapes::moved(shapes::capsule(3, 0.2, 24), {3, 0, 0}),
		[](const Point3d& p) { return p[0] < 1.6; });
	const Outcome made = mended(shapes::joined({body, limb}));
	EXPECT_EQ(made.gaps, 1);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
}

/// A ball with a limb in front of a hole, as wide as it, that two slits cross, `arm` long from its
/// middle.
shapes::Soup limbInFrontOfSlits(double arm)
{
	const shapes::Soup body = without(shapes::sphere(5, 1), [&](const Point3d& p) {
		const double y = std::abs(p[1]), z = std::abs(p[2]);
		return p[0] > 0
			&& (std::hypot(y, z) < 0.22 || (std::min(y, z) < 0.06 && std::max(y, z) < arm));
	});
	return shapes::joined({body,
		without(shapes::moved(shapes::capsule(3, 0.2, 24), {2.5, 0, 0}),
			[](const Point3d& p) { return p[0] < 1.05; })});
}

TEST(BridgeGaps, ALimbThatSlitsRunAroundIsJoinedByTheWrapNotByATube)
{
	const shapes::Soup torn = limbInFrontOfSlits(0.7);
	const MendedSurface surface = mend(torn.points, torn.triangles);
	EXPECT_EQ(surface.report.gapsBridged, 0);
	EXPECT_FALSE(surface.closed);
	expectOneWrappedBody(torn, 4 * M_PI / 3 + M_PI * 0.2 * 0.2 * (3 + 0.2 * 2 / 3));
}

TEST(BridgeGaps, APatchWithinASlitIsJoinedByTheWrap)
{
	// Filled, the slit would leave the patch as a lens in front of the ball.
	const shapes::Soup torn = without(shapes::sphere(5, 1),
		[](const Point3d& p) { return p[0] > 0 && std::abs(std::hypot(p[1], p[2]) - 0.4) < 0.08; });
	EXPECT_FALSE(mend(torn.points, torn.triangles).closed);
	expectOneWrappedBody(torn, 4 * M_PI / 3);
}

TEST(BridgeGaps, TheTeethOfAHoleAreNoSlits)
{
	const Outcome made = mended(limbInFrontOfSlits(0.25));
	EXPECT_EQ(made.gaps, 1);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
}

/// borderShape() of n corners, corner(angle) of each.
detail::BorderShape shapeOf(int n, const std::function<Point3d(double)>& corner)
{
	std::vector<Point3d> points;
	std::vector<int> border;
	for (int i = 0; i < n; ++i) {
		points.push_back(corner(2 * M_PI * i / n));
		border.push_back(i);
	}
	return detail::borderShape(
		points, border, detail::areaVector(points, border, Point3d(0, 0, 0)));
}

TEST(BorderShape, OfACircleEveryLengthIsThatOfItsDisc)
{
	for (const double tooth : {0.0, 0.1}) {
		int i = 0;
		const detail::BorderShape circle = shapeOf(120, [&](double a) {
			const double r = 1 + tooth * (i++ % 2 ? 1 : -1);
			return Point3d(r * std::cos(a), r * std::sin(a), 0);
		});
		EXPECT_NEAR(circle.slenderness, 1, 0.02) << tooth;
		EXPECT_NEAR(circle.concavity, 1, 0.01) << tooth;
		EXPECT_NEAR(circle.warp, 1, 0.01) << tooth;
	}
}

TEST(BorderShape, OfAnEllipseTheSlendernessGrowsAndNothingElse)
{
	// The perimeter of an ellipse of 10 by 1 is 40.64.
	const detail::BorderShape ellipse =
		shapeOf(400, [](double a) { return Point3d(10 * std::cos(a), 0, std::sin(a)); });
	EXPECT_NEAR(ellipse.slenderness, 40.64 / (2 * M_PI * std::sqrt(10.0)), 0.02);
	EXPECT_NEAR(ellipse.concavity, 1, 0.01);
	EXPECT_NEAR(ellipse.warp, 1, 0.01);
}

TEST(BorderShape, OfAStarItIsConcave)
{
	const detail::BorderShape star = shapeOf(400, [](double a) {
		const double r = 1 + 0.5 * std::cos(4 * a);
		return Point3d(r * std::cos(a), r * std::sin(a), 0);
	});
	EXPECT_GT(star.concavity, 1.2);
}

TEST(BorderShape, OfAHoleInTheSideOfATubeItIsWarpedNotConcave)
{
	const detail::BorderShape saddle = shapeOf(400, [](double a) {
		const double y = 0.95 * std::cos(a), z = 0.95 * std::sin(a);
		return Point3d(std::sqrt(1 - y * y), y, z);
	});
	EXPECT_NEAR(saddle.concavity, 1, 0.01);
	EXPECT_GT(saddle.warp, 1.12);
}

TEST(BridgeGaps, ARingIsClosedOverAShortGapOnly)
{
	const auto ring = [](double gap) {
		return mended(without(shapes::torus(1, 0.2, 90, 24), [&](const Point3d& p) {
			return p[0] > 0 && std::abs(std::atan2(p[1], p[0])) < gap / 2;
		}));
	};
	EXPECT_EQ(ring(0.3).euler, 0);
	EXPECT_EQ(ring(0.3).gaps, 1);
	EXPECT_EQ(ring(1.5).euler, 2);
	EXPECT_EQ(ring(1.5).gaps, 0);
}

TEST(BridgeGaps, ASlitWhereALongTriangleIsMissingIsNoEnd)
{
	const shapes::Soup frame = shapes::torus(1, 0.05, 4, 4);
	const size_t count = frame.triangles.size();
	for (size_t i = 0; i < count; ++i)
		for (size_t k = 0; k < i; ++k) {
			shapes::Soup open = frame;
			open.triangles.erase(open.triangles.begin() + std::ptrdiff_t(i));
			open.triangles.erase(open.triangles.begin() + std::ptrdiff_t(k));
			const Outcome made = mended(open);
			EXPECT_EQ(made.gaps, 0) << i << " " << k;
			EXPECT_EQ(made.pieces, 1) << i << " " << k;
			EXPECT_EQ(made.euler, 0) << i << " " << k;
			EXPECT_NEAR(made.volume, volumeOf(frame), 0.1 * volumeOf(frame)) << i << " " << k;
		}
}

TEST(BridgeGaps, EndsThatDoNotLookAtEachOtherStayApart)
{
	const auto openAt = [](double side, const Point3d& at) {
		return shapes::moved(without(shapes::capsule(3, 0.2, 24),
								 [&](const Point3d& p) { return side * p[0] > 1.3; }),
			at);
	};
	// Both open ends up; and away from each other; and past each other.
	EXPECT_EQ(mended(shapes::joined({openAt(1, {0, 0, 0}), openAt(1, {0, 1, 0})})).gaps, 0);
	EXPECT_EQ(mended(shapes::joined({openAt(-1, {0, 0, 0}), openAt(1, {4, 0, 0})})).gaps, 0);
	EXPECT_EQ(mended(shapes::joined({openAt(1, {0, 0, 0}), openAt(-1, {4, 3, 0})})).gaps, 0);
	// The same two, face to face.
	EXPECT_EQ(mended(shapes::joined({openAt(1, {0, 0, 0}), openAt(-1, {4, 0, 0})})).gaps, 1);
}

TEST(BridgeGaps, NotThroughAWall)
{
	const shapes::Soup torn =
		without(shapes::capsule(6, 0.2, 24), [](const Point3d& p) { return std::abs(p[0]) < 1; });
	const shapes::Soup wall = shapes::moved(shapes::box(0.1, 2, 2), {-0.05, -1, -1});
	const Outcome made = mended(shapes::joined({torn, wall}));
	EXPECT_EQ(made.gaps, 0);
	EXPECT_EQ(made.pieces, 3);
}

TEST(BridgeGaps, AHoleInASideIsNoEnd)
{
	// Two plates of which each has a hole opposite the other's: no limb is torn there.
	const auto plate = [](double z, double inside) {
		shapes::Soup box = shapes::moved(shapes::box(4, 4, 0.5), {-2, -2, z});
		for (int i = 0; i < 5; ++i)
			box = shapes::subdivided(box);
		return without(box, [&](const Point3d& p) {
			return std::abs(p[2] - inside) < 1e-9 && std::hypot(p[0], p[1]) < 0.4;
		});
	};
	const Outcome made = mended(shapes::joined({plate(0, 0.5), plate(1, 1)}));
	EXPECT_EQ(made.gaps, 0);
	EXPECT_EQ(made.pieces, 2);
}

/// Limbs of these headings around the origin, without what is nearer to it than `gap`.
shapes::Soup limbsAround(const std::vector<double>& degrees, double gap, int sides = 24)
{
	shapes::Soup limbs;
	for (double angle : degrees) {
		const double c = std::cos(angle * M_PI / 180), s = std::sin(angle * M_PI / 180);
		const shapes::Soup limb =
			shapes::transformed(without(shapes::moved(shapes::capsule(4, 0.2, sides), {2.5, 0, 0}),
									[&](const Point3d& p) { return p[0] < gap; }),
				[&](const Point3d& p) {
					return Point3d(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]);
				});
		limbs = limbs.points.empty() ? limb : shapes::joined({limbs, limb});
	}
	return limbs;
}

TEST(BridgeGaps, LimbsAroundALostJunction)
{
	for (const std::vector<double>& degrees :
		std::vector<std::vector<double>> {{0, 120, 240}, {0, 100, 210}, {0, 150, 200}}) {
		const Outcome made = mended(limbsAround(degrees, 0.9));
		EXPECT_EQ(made.gaps, int(degrees.size()) - 1) << degrees[1];
		EXPECT_EQ(made.pieces, 1) << degrees[1];
		EXPECT_EQ(made.euler, 2) << degrees[1];
	}
}

TEST(BridgeGaps, ALimbJoinsATubeRatherThanAnotherLimb)
{
	// The limbs aside see each other, too; a tube between them would leave both apart from the rest.
	for (double gap : {0.6, 1.2}) {
		const Outcome made = mended(limbsAround({0, 125, 180, 235}, gap));
		EXPECT_EQ(made.gaps, 3) << gap;
		EXPECT_EQ(made.pieces, 1) << gap;
		EXPECT_EQ(made.euler, 2) << gap;
	}
}

TEST(BridgeGaps, ALimbThatLooksPastATubeStaysApart)
{
	const shapes::Soup torn =
		without(shapes::capsule(6, 0.2, 24), [](const Point3d& p) { return std::abs(p[0]) < 1; });
	const auto openDownwards = [](double aside) {
		return shapes::transformed(
			without(shapes::capsule(3, 0.2, 24), [](const Point3d& p) { return p[0] < -1.2; }),
			[&](const Point3d& p) { return Point3d(-p[1] + aside, p[0] + 2.5, p[2]); });
	};
	EXPECT_EQ(mended(shapes::joined({torn, openDownwards(0)})).pieces, 1);
	EXPECT_EQ(mended(shapes::joined({torn, openDownwards(4)})).pieces, 2);
}

TEST(BridgeGaps, TheEndOfALimbThatIsNoLargerThanASpeck)
{
	const shapes::Soup torn = without(
		shapes::capsule(40, 0.2, 24), [](const Point3d& p) { return p[0] > 19 && p[0] < 19.95; });
	const Outcome made = mended(torn);
	EXPECT_EQ(made.gaps, 1);
	EXPECT_EQ(made.pieces, 1);
	EXPECT_EQ(made.euler, 2);
	// Turned away from the stump it belongs to nothing.
	const Outcome apart = mended(shapes::transformed(torn, [](const Point3d& p) {
		return p[0] > 19.5 ? Point3d(40 - p[0], p[1], -p[2]) + Point3d(1, 0, 0) : p;
	}));
	EXPECT_EQ(apart.gaps, 0);
	EXPECT_EQ(apart.pieces, 1);
}

TEST(BridgeGaps, ALimbThatLeadsIntoAWideHole)
{
	const shapes::Soup body = without(shapes::sphere(4, 1),
		[](const Point3d& p) { return p[0] > 0 && std::hypot(p[1], p[2]) < 0.6; });
	const auto limbAt = [](double aside) {
		return shapes::moved(
			without(shapes::capsule(3, 0.1, 24), [](const Point3d& p) { return p[0] < -1.4; }),
			{3, aside, 0});
	};
	EXPECT_EQ(mended(shapes::joined({body, limbAt(0.3)})).gaps, 1);
	EXPECT_EQ(mended(shapes::joined({body, limbAt(1.2)})).gaps, 0);
}

TEST(BridgeGaps, ALimbLeadsIntoAWideHoleInAnyDirection)
{
	// More than 120 of its radii away.
	const shapes::Soup body = without(shapes::sphere(4, 2),
		[](const Point3d& p) { return p[0] > 0 && std::hypot(p[1], p[2]) < 0.6; });
	const shapes::Soup limb = shapes::moved(
		without(shapes::capsule(6, 0.1, 24), [](const Point3d& p) { return p[0] < -2.8; }),
		{18, 0, 0});
	const shapes::Soup torn = shapes::joined({body, limb});
	EXPECT_EQ(mended(torn).gaps, 1);
	EXPECT_EQ(mended(shapes::transformed(
						 torn, [](const Point3d& p) { return Point3d(p[1], p[2], p[0]); }))
				  .gaps,
		1);
}

TEST(BridgeGaps, OnlyLimbsWithinReachAreCompared)
{
	// Short tubes in rows along x: the next three in the row are within ten diagonals, others are
	// within 240 radii.
	constexpr int rows = 20;
	std::vector<detail::LimbEnd> ends;
	for (int i = 0; i < rows * rows * rows; ++i)
		for (double side : {-1, 1}) {
			detail::LimbEnd end;
			end.piece = i;
			end.pieceDiagonal = 1;
			end.centre =
				Point3d(3 * (i % rows) + 0.5 * side, 3 * (i / rows % rows), 3 * (i / rows / rows));
			end.radius = 0.5;
			end.heading = end.out = Point3d(side, 0, 0);
			end.isCutThrough = true;
			ends.push_back(end);
		}
	int asked = 0;
	const auto facing =
		detail::facingEnds(ends, GapLimits(), Progress([&](int, const char*) { return ++asked; }));
	int inRow = 0;
	for (const detail::FacingLimb& one : facing) {
		ASSERT_LT(one.tube, 0);
		const Point3d apart = ends[size_t(one.there)].centre - ends[size_t(one.limb)].centre;
		const bool isInRow = apart[1] == 0 && apart[2] == 0;
		inRow += isInRow;
		EXPECT_LE(apart.Norm(), 10);
		if (isInRow) {
			EXPECT_EQ(one.apart, apart.Norm());
			EXPECT_EQ(std::min(one.limb, one.there) % 2, 1);
		}
	}
	EXPECT_EQ(inRow, (rows - 1 + rows - 2 + rows - 3) * rows * rows);
	EXPECT_LT(asked, 1000); // once in some 30,000 pairs, of 3e8
}

TEST(BridgeGaps, AThousandLostJunctionsAreBridged)
{
	// So many that the cube of their number would take most of a minute.
	constexpr int rows = 32;
	const shapes::Soup one = limbsAround({0, 100, 210}, 0.9, 6);
	shapes::Soup many;
	for (int i = 0; i < rows * rows; ++i) {
		const int first = int(many.points.size());
		for (const Point3d& p : one.points)
			many.points.push_back(p + Point3d(30 * (i % rows), 30 * (i / rows), 0));
		for (const Triangle& t : one.triangles)
			many.triangles.push_back({first + t[0], first + t[1], first + t[2]});
	}
	const std::vector<int> partner =
		detail::pairedHalfEdges(many.points, many.triangles, nullptr, Progress());
	EXPECT_EQ(bridgeGaps(many.points, many.triangles, partner, {}).tubes, 2 * rows * rows);
	const std::vector<int> joined =
		detail::pairedHalfEdges(many.points, many.triangles, nullptr, Progress());
	const std::vector<int> piece = detail::pieceOfFaces(joined);
	EXPECT_EQ(std::set<int>(piece.begin(), piece.end()).size(), size_t(rows * rows));
	EXPECT_EQ(std::count(joined.begin(), joined.end(), -1), 0);
}

TEST(BridgeGaps, AsksToCancel)
{
	std::vector<detail::LimbEnd> ends(2);
	EXPECT_THROW(
		detail::facingEnds(ends, GapLimits(), Progress([](int, const char*) { return false; })),
		Cancelled);
}

} // namespace
