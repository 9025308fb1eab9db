// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Refinement of hand-made curves in shapes whose axes are known.

#include "curves.h"
#include "mesh_checks.h"
#include "read_off.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/refine/refine.h>
#include <skeleton/resample/resample.h>
#include <skeleton/flow/flow.h>
#include <skeleton/resample/target_length.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using curves::CurveMaker;
using curves::tips;
using vcg::Point3d;

namespace {

/// A line from (from, 0, 0) to (to, 0, 0) that is aside of the x axis and zigzags.
std::vector<Point3d> zigzag(double from, double to, double aside, double amount, int pieces = 40)
{
	std::vector<Point3d> points;
	for (int i = 0; i <= pieces; ++i)
		points.emplace_back(
			from + (to - from) * i / pieces, aside + (i % 2 ? amount : -amount), aside / 2);
	return points;
}

/// Two arms of a square tube of width 1 that meet at a right angle, the one of a given length along
/// the x axis, the other of 10 along the y axis.
struct Elbow
{
	SurfaceMesh mesh;
	std::vector<int> all;
	ClosestSurface surface;

	explicit Elbow(int length = 10) :
			mesh(shapes::subdivided(
				shapes::cells(length, 10, 1, [](int i, int j, int) { return i == 0 || j == 0; }))
					 .mesh()),
			all(numbered(mesh.vertexSlots())), surface(mesh, all, 0.1)
	{
	}

	/// A curve in it with its radii, sampled.
	CurveSkeleton sampled(CurveSkeleton& curve, double spacing) const
	{
		for (size_t v = 0; v < curve.position.size(); ++v)
			curve.radius[v] = surface.clearance(curve.position[v]);
		return refining::evenlySampled(curve, surface, spacing);
	}

private:
	static std::vector<int> numbered(int count)
	{
		std::vector<int> numbers(size_t(count), 0);
		std::iota(numbers.begin(), numbers.end(), 0);
		return numbers;
	}
};

/// Whether all nodes and three points of each edge are inside.
bool isInside(const CurveSkeleton& s, const SurfaceMesh& mesh)
{
	for (const auto& [a, b] : s.edges)
		for (double t : {0.0, 0.25, 0.5, 0.75, 1.0})
			if (checks::windingNumber(mesh, s.position[a] + (s.position[b] - s.position[a]) * t)
				< 0.5)
				return false;
	return true;
}

double meanDistance(const CurveSkeleton& s, const std::function<double(const Point3d&)>& distance)
{
	double sum = 0;
	for (const Point3d& p : s.position)
		sum += distance(p);
	return sum / double(s.position.size());
}

double distanceFromXAxis(const Point3d& p)
{
	return std::hypot(p[1], p[2]);
}

double farthest(const std::vector<Point3d>& points, int axis)
{
	double maximum = -std::numeric_limits<double>::infinity();
	for (const Point3d& p : points)
		maximum = std::max(maximum, p[axis]);
	return maximum;
}

double meanTurning(const CurveSkeleton& s)
{
	const auto neighbours = s.neighbours();
	double sum = 0;
	int count = 0;
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() == 2) {
			const Point3d a = s.position[v] - s.position[neighbours[v][0]];
			const Point3d b = s.position[neighbours[v][1]] - s.position[v];
			sum += std::atan2((a ^ b).Norm(), a * b);
			++count;
		}
	return sum / count * 180 / M_PI;
}

bool sameGraph(const CurveSkeleton& a, const CurveSkeleton& b)
{
	return a.edges == b.edges && a.node == b.node && a.position.size() == b.position.size();
}

/// A bar along x (0 to 21) of width 5 about y = z = 2.5, with an arm of that width up to y = 5 + height.
shapes::Soup barWithArm(int height)
{
	return shapes::cells(
		21, 5 + height, 5, [](int i, int j, int) { return j < 5 || (i >= 8 && i < 13); });
}

CurveSkeleton curveOfBarWithArm(const SurfaceMesh& mesh, double armTip)
{
	const Point3d centre(10.5, 2.5, 2.5);
	return CurveMaker()
		.line(Point3d(2.5, 2.5, 2.5), centre)
		.line(centre, Point3d(18.5, 2.5, 2.5))
		.line(centre, Point3d(10.5, armTip, 2.5), 8)
		.in(mesh);
}

TEST(Refine, CentresAndSmoothsACurveInATube)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const double diagonal = mesh.bounds().Diag();
	const CurveSkeleton rough = CurveMaker().chain(zigzag(-1.4, 1.4, 0.08, 0.03)).in(mesh);
	ASSERT_GT(meanDistance(rough, distanceFromXAxis), 0.02 * diagonal);
	ASSERT_GT(meanTurning(rough), 30);

	const CurveSkeleton s = refine(rough, mesh);
	EXPECT_EQ(checks::skeletonError(s), "");
	EXPECT_LE(meanDistance(s, distanceFromXAxis), 0.0015 * diagonal);
	EXPECT_LE(meanTurning(s), 1);
	EXPECT_TRUE(isInside(s, mesh));
	EXPECT_EQ(statistics(s).branches, 1);
	for (double r : s.radius)
		EXPECT_NEAR(r, 0.35, 0.09) << "the mean distance to the vertices around";
}

TEST(Refine, UnfoldsACurveThatDoublesBack)
{
	// Along the axis of a tube of radius 0.35, there, back and there again, on top of itself.
	const SurfaceMesh tube = shapes::capsule(4, 0.35, 32).mesh();
	const double end = 1.9;
	CurveMaker folded;
	folded.line({-end, 0, 0}, {0.5, 0, 0}, 24)
		.line({0.5, 0, 0}, {-0.5, 0.01, 0}, 11)
		.line({-0.5, 0.01, 0}, {end, 0, 0.01}, 24);
	const CurveSkeleton curve = folded.in(tube);
	const CurveSkeleton refined = refine(curve, tube);
	EXPECT_EQ(checks::skeletonError(refined), "");
	double length = 0, straight = 0;
	for (const auto& [a, b] : refined.edges) {
		length += Distance(refined.position[a], refined.position[b]);
		for (int v : {a, b})
			straight = std::max(straight, 2 * std::abs(refined.position[v][0]));
	}
	EXPECT_LT(length, 1.02 * straight);
	EXPECT_GT(straight, 3.5);
	EXPECT_EQ(statistics(refined).terminals, 2);
}

TEST(Refine, AnAxisStaysWhereALimbReachesIntoItsOwnBody)
{
	// A body around the x axis from 0 to 1.2, and a tail that is bent back and into the body's side.
	constexpr double body = 0.5, tail = 0.05, bend = 0.35, length = 1.7;
	std::vector<std::pair<double, double>> profile = {{0, 0}};
	for (int i = 1; i <= 12; ++i)
		profile.emplace_back(0.1 * i, body * std::min(1.0, std::min(0.3 * i, 0.4 * (13 - i))));
	for (int i = 0; i <= 85; ++i)
		profile.emplace_back(1.25 + 0.02 * i, tail);
	profile.emplace_back(1.25 + length + tail, 0);
	const auto bent = [](const Point3d& p) {
		const double angle = std::max(0.0, p[0] - 1.25) / bend;
		return angle > 0 ? Point3d(1.25 + (bend - p[1]) * std::sin(angle),
				   bend - (bend - p[1]) * std::cos(angle), p[2])
						 : p;
	};
	const SurfaceMesh mesh = shapes::transformed(shapes::revolved(profile, 32), bent).mesh();
	std::vector<Point3d> axis;
	for (int i = 0; i <= 70; ++i)
		axis.push_back(bent(Point3d(0.2 + i * (1.05 + length) / 70, 0, 0)));
	ASSERT_LT(axis.back()[1], 0.35) << "its end is in the body";
	const CurveSkeleton curve = CurveMaker().chain(axis).in(mesh);
	const Refinement refined = refineChecked(curve, mesh);
	EXPECT_EQ(refined.report.refined, 1);
	EXPECT_EQ(statistics(refined.skeleton).terminals, 2);
	double before = 0;
	for (size_t i = 1; i < axis.size(); ++i)
		before += Distance(axis[i - 1], axis[i]);
	EXPECT_NEAR(statistics(refined.skeleton).length, before, 0.1 * before);
}

TEST(Refine, RemovesATipThatLiesOnAnotherBranch)
{
	// On the axis of a tube, from its middle on, a second time: to the end, and a quarter of the way.
	const SurfaceMesh tube = shapes::capsule(4, 0.35, 32).mesh();
	for (const double to : {0.9, 1.9}) {
		CurveMaker doubled;
		doubled.line({-1.9, 0, 0}, {0.5, 0, 0}, 24).line({0.5, 0, 0}, {1.9, 0, 0.01}, 14);
		doubled.line({0.5, 0, 0}, {to, 0.01, 0}, 7);
		const CurveSkeleton refined = refine(doubled.in(tube), tube);
		EXPECT_EQ(checks::skeletonError(refined), "");
		EXPECT_EQ(statistics(refined).terminals, 2);
		EXPECT_EQ(statistics(refined).junctions, 0);
	}
}

TEST(Refine, RemovesATipWhoseBallHoldsAnotherBranch)
{
	// Beside a long branch along the x axis, another one from its start, at an angle.
	const auto tipsLeft = [](double degrees, double length, double radius) {
		const double angle = degrees * M_PI / 180;
		SurfaceMesh none;
		CurveSkeleton s =
			CurveMaker()
				.line({-3, 0, 0}, {0, 0, 0}, 10)
				.line({0, 0, 0}, {3, 0, 0}, 10)
				.line({0, 0, 0}, {length * std::cos(angle), length * std::sin(angle), 0}, 4)
				.in(none);
		s.radius.assign(s.position.size(), radius);
		return tips(refining::withoutDoubledTips(s)).size();
	};
	EXPECT_EQ(tipsLeft(15, 1, 0.3), 2u) << "0.26 apart";
	EXPECT_EQ(tipsLeft(15, 1, 0.2), 3u) << "a thin limb beside another";
	EXPECT_EQ(tipsLeft(45, 0.5, 0.6), 3u) << "a short limb of a thick body";
	EXPECT_EQ(tipsLeft(90, 0.5, 0.6), 3u);
}

TEST(Refine, SamplesEvenlyAtTheSpacing)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const CurveSkeleton rough =
		CurveMaker()
			.chain({{-1.4, 0, 0}, {-1.3, 0, 0}, {0.2, 0, 0}, {0.25, 0, 0}, {1.4, 0, 0}})
			.in(mesh);
	for (double spacing : {0.003, 0.005, 0.02}) {
		RefineParameters parameters;
		parameters.spacing = spacing;
		const CurveSkeleton s = refine(rough, mesh, parameters);
		for (const auto& [a, b] : s.edges)
			EXPECT_NEAR(Distance(s.position[a], s.position[b]) / mesh.bounds().Diag(), spacing,
				0.1 * spacing);
	}
}

TEST(Refine, ACurveAroundACornerIsSampledAboutAsSparselyAsOthers)
{
	const Elbow elbow;
	const Point3d corner(0.5, 0.5, 0.5);
	CurveSkeleton fine = CurveMaker()
							 .line(Point3d(9.5, 0.5, 0.5), corner, 200)
							 .line(corner, Point3d(0.5, 9.5, 0.5), 200)
							 .in(elbow.mesh);
	const CurveSkeleton even = elbow.sampled(fine, 2.5);
	EXPECT_TRUE(isInside(even, elbow.mesh));
	for (const auto& [a, b] : even.edges)
		EXPECT_LE(Distance(even.position[a], even.position[b]), 1.5 * 2.5);
	EXPECT_LE(even.edges.size(), 10u) << "not the 400 that the curve had: 7, were there no corner";
}

TEST(Refine, ACurveThatGoesToAndFroInATubeIsStraightened)
{
	const Elbow elbow;
	// Three times through the same arm, by ways a little beside each other, then around the corner.
	CurveSkeleton curve = CurveMaker()
							  .line(Point3d(9.5, 0.5, 0.5), Point3d(3, 0.45, 0.5), 50)
							  .line(Point3d(3, 0.45, 0.5), Point3d(9, 0.5, 0.55), 50)
							  .line(Point3d(9, 0.5, 0.55), Point3d(0.5, 0.5, 0.5), 50)
							  .line(Point3d(0.5, 0.5, 0.5), Point3d(0.5, 9.5, 0.5), 50)
							  .in(elbow.mesh);
	const CurveSkeleton even = elbow.sampled(curve, 2.5);
	EXPECT_TRUE(isInside(even, elbow.mesh));
	EXPECT_EQ(statistics(even).terminals, 2);
	EXPECT_LE(statistics(even).length, 18.5) << "9 + 9, and a little beside the axis; 30 before";
	// What had merged into a node of a loop goes to where the loop was cut, all else to its neighbour.
	for (size_t s = 0; s < curve.node.size(); ++s) {
		const Point3d &before = curve.position[size_t(curve.node[s])],
					  &after = even.position[size_t(even.node[s])];
		if (before[0] < 3 || before[1] > 1)
			EXPECT_LE(Distance(before, after), 2.5);
		else
			EXPECT_LE(after[1], 1) << "in the same arm";
	}
}

TEST(Refine, ACurveThatComesBackFromAnEndKeepsItsReach)
{
	const Elbow elbow(40);
	CurveSkeleton curve = CurveMaker()
							  .line(Point3d(0.5, 9.5, 0.5), Point3d(0.5, 0.5, 0.5), 50)
							  .line(Point3d(0.5, 0.5, 0.5), Point3d(39.5, 0.5, 0.5), 200)
							  .line(Point3d(39.5, 0.5, 0.5), Point3d(3, 0.45, 0.5), 200)
							  .in(elbow.mesh);
	const CurveSkeleton even = elbow.sampled(curve, 2.5);
	double farthest = 0;
	for (const Point3d& p : even.position)
		farthest = std::max(farthest, p[0]);
	EXPECT_GT(farthest, 39.5 - 2 * 1.25 * 2.5);
}

TEST(Refine, ANeedlesEndsGetNoMoreNodesThanItsMiddle)
{
	// A double cone of a thousandth; the curve that is given ends where it is thick.
	std::vector<std::pair<double, double>> profile;
	for (int i = 0; i <= 200; ++i) {
		const double x = i / 100.0 - 1;
		profile.emplace_back(x, 1e-3 * (1 - std::abs(x)));
	}
	const SurfaceMesh mesh = shapes::revolved(profile, 8).mesh();
	const CurveSkeleton curve =
		CurveMaker().line(Point3d(-0.5, 0, 0), Point3d(0.5, 0, 0), 100).in(mesh);
	const Refinement refined = refineChecked(curve, mesh);
	EXPECT_EQ(refined.report.refined, 1);
	EXPECT_GT(statistics(refined.skeleton).length, 1.8) << "into both ends";
	// 1500 for each diagonal of its length and one besides; the last extension of the tips may add a few.
	EXPECT_LE(refined.skeleton.position.size(), 1.1 * 3000);
}

TEST(Refine, KeepsARing)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 120, 40).mesh();
	std::vector<Point3d> ring;
	for (int i = 0; i <= 60; ++i) {
		const double u = 2 * M_PI * (i % 60) / 60, r = 1.05 + (i % 2 ? 0.02 : -0.02);
		ring.emplace_back(r * std::cos(u), r * std::sin(u), 0.04);
	}
	const CurveSkeleton s = refine(CurveMaker().chain(ring).in(mesh), mesh);
	EXPECT_EQ(checks::skeletonError(s), "");
	const SkeletonStatistics counts = statistics(s);
	EXPECT_EQ(counts.components, 1);
	EXPECT_EQ(counts.cycles, 1);
	EXPECT_EQ(counts.terminals, 0);
	EXPECT_EQ(counts.junctions, 0);
	const auto fromCircle = [](const Point3d& p) {
		return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]);
	};
	EXPECT_LE(meanDistance(s, fromCircle), 0.0015 * mesh.bounds().Diag());
	EXPECT_NEAR(counts.length, 2 * M_PI, 0.05);
}

TEST(Refine, RemovesASpurAndHandsOnWhatHadMergedThere)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const CurveSkeleton rough = CurveMaker()
									.line({-1.4, 0, 0}, {0, 0, 0})
									.line({0, 0, 0}, {1.4, 0, 0})
									.line({0, 0, 0}, {0, 0.25, 0}, 6)
									.in(mesh);
	ASSERT_EQ(statistics(rough).terminals, 3);
	const CurveSkeleton s = refine(rough, mesh);
	EXPECT_EQ(checks::skeletonError(s), "");
	EXPECT_EQ(statistics(s).terminals, 2);
	EXPECT_EQ(statistics(s).junctions, 0);
	for (size_t i = 0; i < s.node.size(); ++i)
		if (std::abs(mesh.position[i][0]) < 1.3) {
			EXPECT_NEAR(s.position[s.node[i]][0], mesh.position[i][0], 0.02);
		}
}

TEST(Refine, OfLessDetailIsAPartOfMore)
{
	// An animal's head, legs and tail have ears, hooves and a tip of their own.
	const SurfaceMesh surface = shapes::fromFile("animal450").mesh();
	Parameters coarse;
	coarse.targetLength = 0.012;
	const MeasuredSurface measured(surface);
	const SurfaceMesh mesh =
		resample(measured, defaultTargetLength(measured, coarse), coarse.resampleIterations);
	const CurveSkeleton curve =
		collapseToCurve(contractToSkeleton(firstStageOf(mesh, coarse), coarse));
	RefineParameters parameters;
	parameters.detail = 1;
	const CurveSkeleton all = refine(curve, mesh, parameters);
	ASSERT_EQ(all.significance.size(), all.position.size());
	EXPECT_EQ(statistics(all).terminals, 8);
	std::vector<double> values(all.significance);
	std::sort(values.begin(), values.end());
	EXPECT_EQ(values.back(), 1);
	EXPECT_LT(values.front(), 0.9);
	for (double detail : {1 - values.front() - 1e-9, 0.25, 0.0}) {
		parameters.detail = detail;
		const CurveSkeleton part = refine(curve, mesh, parameters);
		EXPECT_EQ(checks::skeletonError(part), "");
		EXPECT_LT(statistics(part).terminals, 8);
		std::vector<Point3d> expected;
		for (size_t v = 0; v < all.position.size(); ++v)
			if (all.significance[v] >= 1 - detail)
				expected.push_back(all.position[v]);
		EXPECT_EQ(part.position, expected) << "the detail " << detail;
	}
	EXPECT_EQ(statistics(refine(curve, mesh, parameters)).terminals, 2) << "the trunk";
}

TEST(Refine, KeepsASpurIfToldSo)
{
	const SurfaceMesh mesh = barWithArm(2).mesh();
	RefineParameters parameters;
	EXPECT_EQ(statistics(refine(curveOfBarWithArm(mesh, 4.5), mesh, parameters)).terminals, 3)
		<< "an arm is a feature, however short";
	parameters.spurProminence = 1;
	EXPECT_EQ(statistics(refine(curveOfBarWithArm(mesh, 4.5), mesh, parameters)).terminals, 2)
		<< "unless it must add the whole of its junction's radius";
}

TEST(Refine, ExtendsTipsIntoATaperedEnd)
{
	// Radius 0.4 at x = 0, 0.02 at both ends, straight in between.
	std::vector<std::pair<double, double>> profile = {{-1.5, 0}};
	for (int i = -60; i <= 60; ++i)
		profile.emplace_back(1.5 * i / 60, 0.4 - 0.38 * std::abs(i) / 60);
	profile.emplace_back(1.5, 0);
	const SurfaceMesh mesh = shapes::revolved(profile, 40).mesh();
	const CurveSkeleton s = refine(CurveMaker().line({-0.5, 0, 0}, {0.5, 0, 0}).in(mesh), mesh);
	EXPECT_TRUE(isInside(s, mesh));
	const std::vector<Point3d> ends = tips(s);
	ASSERT_EQ(ends.size(), 2u);
	for (const Point3d& tip : ends) {
		const double radius = 0.4 - 0.38 * std::abs(tip[0]) / 1.5;
		EXPECT_LE(1.5 - std::abs(tip[0]), 1.5 * radius) << "within about a radius of the end";
	}
	EXPECT_LE(meanDistance(s, distanceFromXAxis), 0.0015 * mesh.bounds().Diag());
}

TEST(Refine, ATipDoesNotRunAlongTheWallOfAPlate)
{
	constexpr double thickness = 0.04, width = 1;
	const SurfaceMesh plate = shapes::box(width, width, thickness).mesh();
	const ClosestSurface surface(
		plate, detail::numberedArray(plate.position.size(), Progress()), 0.01);
	for (const double aside : {0.1, 0.25, 0.5}) {
		const Point3d start(0.5 + aside, 0.6, thickness / 2), end(0.5, 0.96, thickness / 2);
		CurveSkeleton curve = curves::line(start, end, thickness / 2, 40);
		refining::extendTips(curve, surface, {0.005, 0.2, 0.003});
		for (const Point3d& p : curve.position)
			EXPECT_GE(p[0], end[0] - 2 * thickness) << "aside " << aside;
	}
}

TEST(Refine, EndsInTheCentreOfARoundEnd)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const CurveSkeleton s = refine(CurveMaker().line({-0.7, 0, 0}, {0.7, 0, 0}).in(mesh), mesh);
	for (const Point3d& tip : tips(s))
		EXPECT_NEAR(std::abs(tip[0]), 1.5, 0.05);
}

TEST(Refine, EndsInTheCentreOfTheRoundEndsOfAHair)
{
	// So long that its nodes must be farther apart than half a radius: its tips are not to be shorter for that.
	const double radius = 1.5e-4, ring = 4 * radius;
	std::vector<std::pair<double, double>> profile = {{-0.5 - radius, 0}};
	for (const double turned : {0.4, 0.8, 1.2})
		profile.emplace_back(-0.5 - radius * std::cos(turned), radius * std::sin(turned));
	for (int i = 0; i <= int(1 / ring); ++i)
		profile.emplace_back(-0.5 + ring * i, radius);
	const double end = profile.back().first;
	for (const double turned : {1.2, 0.8, 0.4})
		profile.emplace_back(end + radius * std::cos(turned), radius * std::sin(turned));
	profile.emplace_back(end + radius, 0);
	const SurfaceMesh mesh = shapes::revolved(profile, 10).mesh();
	const CurveSkeleton s = refine(
		CurveMaker().line({-0.5 + 2 * radius, 0, 0}, {end - 2 * radius, 0, 0}).in(mesh), mesh);
	ASSERT_LT(s.position.size() * radius / 2, 0.9) << "as many nodes as the thickness asks for";
	const std::vector<Point3d> ends = tips(s);
	ASSERT_EQ(ends.size(), 2u);
	for (const Point3d& tip : ends)
		EXPECT_LE(std::min(std::abs(tip[0] + 0.5), std::abs(tip[0] - end)), radius / 2);
}

TEST(Refine, ALimbOfLongTrianglesIsFollowedToItsEnd)
{
	// Six-sided, with triangles of 50 radii, so that no vertex tells how thin it is; the flow has left its ends.
	const double radius = 0.002;
	std::vector<std::pair<double, double>> profile = {{-0.5 - radius, 0}};
	for (int i = 0; i <= 10; ++i)
		profile.emplace_back(-0.5 + 0.1 * i, radius);
	profile.emplace_back(0.5 + radius, 0);
	const SurfaceMesh mesh = shapes::revolved(profile, 6).mesh();
	const CurveSkeleton s = refine(
		CurveMaker().line({-0.5 + 15 * radius, 0, 0}, {0.5 - 15 * radius, 0, 0}).in(mesh), mesh);
	EXPECT_TRUE(isInside(s, mesh));
	const std::vector<Point3d> ends = tips(s);
	ASSERT_EQ(ends.size(), 2u);
	for (const Point3d& tip : ends)
		EXPECT_NEAR(std::abs(tip[0]), 0.5, radius);
}

TEST(Refine, TakesAnEndBackThatWentPastTheCentreOfARoundEnd)
{
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const CurveSkeleton s = refine(CurveMaker().line({-1.65, 0, 0}, {1.65, 0, 0}).in(mesh), mesh);
	for (const Point3d& tip : tips(s))
		EXPECT_NEAR(std::abs(tip[0]), 1.5, 0.05);
}

TEST(Refine, LeavesNoBranchInTheCornersOfABox)
{
	// The curve edges of a bar's medial axis: from its axis to all eight corners.
	const SurfaceMesh mesh = shapes::cells(30, 10, 10, [](int, int, int) { return true; }).mesh();
	CurveMaker maker;
	const Point3d ends[] = {{5, 5, 5}, {25, 5, 5}};
	maker.line(ends[0], ends[1]);
	for (int i = 0; i < 8; ++i) {
		const Point3d corner(i & 1 ? 30 : 0, i & 2 ? 10 : 0, i & 4 ? 10 : 0);
		maker.line(ends[i & 1], ends[i & 1] * 0.1 + corner * 0.9, 8);
	}
	const CurveSkeleton s = refine(maker.in(mesh), mesh);
	EXPECT_TRUE(isInside(s, mesh));
	const std::vector<Point3d> found = tips(s);
	ASSERT_EQ(found.size(), 2u);
	EXPECT_EQ(statistics(s).junctions, 0);
	for (const Point3d& tip : found)
		EXPECT_LE(std::min(Distance(tip, ends[0]), Distance(tip, ends[1])), 1)
			<< "an end is the centre of the last ball of full size";
}

TEST(Refine, CutsAnEndOffThatTurnsIntoACorner)
{
	const SurfaceMesh mesh = shapes::cells(30, 10, 10, [](int, int, int) { return true; }).mesh();
	const CurveSkeleton s = refine(
		CurveMaker().line({5, 5, 5}, {25, 5, 5}).line({25, 5, 5}, {29, 9, 9}, 8).in(mesh), mesh);
	EXPECT_NEAR(farthest(tips(s), 0), 25, 1);
	EXPECT_LE(farthest(tips(s), 1), 6);
}

TEST(Refine, KeepsAShortPointedFeatureOfALargeBody)
{
	// A cone of 40 degrees on a ball of radius 1, its tip at 1.6.
	std::vector<std::pair<double, double>> profile;
	const double slope = std::tan(20 * M_PI / 180), apex = 1.6;
	for (int i = 0; i <= 200; ++i) {
		const double x = -1 + (apex + 1) * i / 200;
		const double ball = std::sqrt(std::max(0.0, 1 - x * x));
		profile.emplace_back(x, i == 0 || i == 200 ? 0 : std::max(ball, (apex - x) * slope));
	}
	const SurfaceMesh mesh = shapes::revolved(profile, 48).mesh();
	const CurveSkeleton s = refine(
		CurveMaker().line({0, 0, 0}, {1.3, 0, 0}).line({0, 0, 0}, {-0.1, 0, 0}, 2).in(mesh), mesh);
	EXPECT_GE(farthest(tips(s), 0), 1.5) << "within about a radius of the end";
}

TEST(Refine, ALowKnobIsDistinctThoughTheWayThereLeadsThroughItsBody)
{
	// On a ball of radius 1, which ends in x = end.
	using Radius = std::function<double(double)>;
	const auto distinctnessOfEnd = [](const Radius& onBall, double end, double tip) {
		std::vector<std::pair<double, double>> profile;
		for (int i = 0; i <= 400; ++i) {
			const double x = -1 + (end + 1) * i / 400;
			const double ball = std::sqrt(std::max(0.0, 1 - x * x));
			profile.emplace_back(x, i % 400 == 0 ? 0 : std::max(ball, onBall(x)));
		}
		const SurfaceMesh mesh = shapes::revolved(profile, 64).mesh();
		std::vector<int> all(mesh.vertexSlots());
		std::iota(all.begin(), all.end(), 0);
		const ClosestSurface surface(mesh, all, 1, Progress());
		refining::KnownClearances clearances(surface);
		const CurveSkeleton s = CurveMaker().line({0, 0, 0}, {tip, 0, 0}, 50).in(mesh);
		std::vector<int> nodes(s.position.size());
		std::iota(nodes.begin(), nodes.end(), 0);
		return refining::distinctness(s, clearances, Branch {nodes});
	};
	constexpr double knob = 0.17, tip = 1.13;
	const auto withKnob = [](double x) {
		return x < 0 ? 0
					 : std::sqrt(std::max(0.0, knob * knob - std::pow(std::max(0.0, x - tip), 2)));
	};
	EXPECT_GE(distinctnessOfEnd(withKnob, tip + knob, tip), 0.7)
		<< "less than its radius sticks out";
	const double apex = 1.6, sine = 1 / apex;
	const auto withCone = [&](double x) {
		return x < sine ? 0 : (apex - x) * sine / std::sqrt(1 - sine * sine);
	};
	EXPECT_NEAR(distinctnessOfEnd(withCone, apex, 1.5), 1 - sine, 0.03);
}

TEST(Refine, AStubThatIsAsThickAsItsJunctionIsNoBranch)
{
	// Of a tube with radius `size`, in diagonals; lengths are in radii.
	const auto tipsLeft = [](double length, double radius, double size = 0.02) {
		CurveSkeleton s;
		const int junction = curves::addNode(s, {0, 0, 0}, size);
		for (double x : {-6.0, 6.0})
			curves::addEdge(s, junction, curves::addNode(s, {x * size, 0, 0}, size));
		curves::addEdge(s, junction, curves::addNode(s, {0, length * size, 0}, radius * size));
		return tips(refining::withoutStubs(curves::tracked(s))).size();
	};
	EXPECT_EQ(tipsLeft(0.4, 1), 2u) << "as a heel has it";
	EXPECT_EQ(tipsLeft(0.7, 0.6), 2u);
	EXPECT_EQ(tipsLeft(1.2, 0.3), 3u) << "a limb sticks out by its length";
	EXPECT_EQ(tipsLeft(0.5, 0.9, 0.2), 3u) << "half of a large round body";
}

TEST(Refine, TheCornerOfABendIsNoLimb)
{
	// Two limbs of radius 1 whose axes meet at the origin, the curve across their corner, and a branch into it.
	const auto tipsLeft = [](double bend, const Point3d& tip, double radius) {
		const double size = 0.02; // diagonals
		const Point3d limbs[] = {
			{1, 0, 0}, {std::cos(bend * M_PI / 180), std::sin(bend * M_PI / 180), 0}};
		CurveSkeleton s;
		const int junction = curves::addNode(s, (limbs[0] + limbs[1]) * (0.35 * size), size);
		for (const Point3d& limb : limbs) {
			const int start = curves::addNode(s, limb * size, size);
			curves::addEdge(s, junction, start);
			curves::addLine(s, start, limb * (8 * size), size, 20);
		}
		curves::addEdge(s, junction, curves::addNode(s, tip * size, radius * size));
		const size_t left = tips(refining::withoutCornersOfBends(curves::tracked(s))).size();
		EXPECT_EQ(tips(refining::withoutStubs(curves::tracked(s))).size(), left);
		return left;
	};
	EXPECT_EQ(tipsLeft(90, {-0.25, -0.25, 0}, 0.85), 2u) << "a heel";
	EXPECT_EQ(tipsLeft(90, {-0.7, -0.7, 0}, 0.2), 3u) << "a spike on it, though no farther out";
	EXPECT_EQ(tipsLeft(90, {-1.5, -1.5, 0}, 0.85), 3u) << "a third limb";
	EXPECT_EQ(tipsLeft(90, {0.35, 0.35, 1.2}, 0.85), 3u) << "a limb across the bend";
	EXPECT_EQ(tipsLeft(179, {0, -0.9, 0}, 0.85), 3u) << "limbs that go straight on have no corner";
}

TEST(Refine, ABranchThatWasOnlyAnEndPastTheCornerOfABendGoesWithIt)
{
	// Along one tube to its round end, and from before that end along another, thinner one.
	const double size = 0.02, thin = 0.7;
	const Point3d turned(-std::sqrt(0.5), std::sqrt(0.5), 0);
	CurveSkeleton s;
	const int junction = curves::addNode(s, {0, 0, 0}, size);
	curves::addLine(s, junction, Point3d(-8, 0, 0) * size, size, 20);
	const int start = curves::addNode(s, (Point3d(0.6, 0, 0) + turned) * size, thin * size);
	curves::addEdge(s, junction, start);
	curves::addLine(s, start, (Point3d(0.6, 0, 0) + turned * 8) * size, thin * size, 20);
	const auto tipsLeft = [&](double end, double radius) {
		CurveSkeleton whole = s;
		curves::addEdge(
			whole, junction, curves::addNode(whole, Point3d(end, 0, 0) * size, radius * size));
		return tips(refining::withoutCornersOfBends(curves::tracked(whole))).size();
	};
	EXPECT_EQ(tipsLeft(1.7, 0.4), 3u) << "overshoots the corner";
	EXPECT_EQ(tipsLeft(1.1, 1), 2u) << "trimmed";
}

TEST(Refine, GrowsABranchIntoALimbThatTheCurveLacks)
{
	const SurfaceMesh mesh = barWithArm(12).mesh();
	const CurveSkeleton curve = CurveMaker().line({2.5, 2.5, 2.5}, {18.5, 2.5, 2.5}).in(mesh);
	const CurveSkeleton s = refine(curve, mesh);
	EXPECT_TRUE(isInside(s, mesh));
	ASSERT_EQ(tips(s).size(), 3u);
	EXPECT_EQ(statistics(s).junctions, 1);
	EXPECT_GE(farthest(tips(s), 1), 13) << "within about a radius of the arm's end";
	const double aside = meanDistance(s, [](const Point3d& p) {
		const double bar = std::hypot(p[1] - 2.5, p[2] - 2.5);
		return std::min(bar, std::hypot(p[0] - 10.5, p[2] - 2.5));
	});
	EXPECT_LE(aside, 0.1) << "in the middle of bar and arm";
	RefineParameters without;
	without.featureHeight = 100;
	EXPECT_EQ(tips(refine(curve, mesh, without)).size(), 2u);
}

TEST(Refine, GrowsNoBranchIntoCornersOrRims)
{
	const SurfaceMesh bar = shapes::cells(30, 10, 10, [](int, int, int) { return true; }).mesh();
	EXPECT_EQ(tips(refine(CurveMaker().line({5, 5, 5}, {25, 5, 5}).in(bar), bar)).size(), 2u);
	const SurfaceMesh plate = shapes::cells(30, 20, 3, [](int, int, int) { return true; }).mesh();
	EXPECT_EQ(
		tips(refine(CurveMaker().line({6, 10, 1.5}, {24, 10, 1.5}).in(plate), plate)).size(), 2u);
}

TEST(Refine, GrowsABranchIntoABluntCornerThatIsAlone)
{
	// A long body with cones of 64 degrees on it, too blunt for limbs: a knee, or two corners.
	const double slope = std::tan(32 * M_PI / 180), apex = 1 / std::sin(32 * M_PI / 180);
	const auto body = [&](int corners) {
		std::vector<std::pair<double, double>> profile;
		const double from = corners == 2 ? -apex : -1;
		for (int i = 0; i <= 200; ++i) {
			const double x = from + (apex - from) * i / 200;
			const double towards = corners == 2 ? std::abs(x) : x;
			const double radius =
				towards > 1 / apex ? (apex - towards) * slope : std::sqrt(std::max(0.0, 1 - x * x));
			profile.emplace_back(x, i % 200 == 0 ? 0 : radius);
		}
		return shapes::transformed(shapes::revolved(profile, 64), [](const Point3d& p) {
			return Point3d(p[0], 1.6 * p[1], p[2]);
		}).mesh();
	};
	const auto refined = [](const SurfaceMesh& mesh) {
		return refine(CurveMaker().line({0, -0.9, 0}, {0, 0.9, 0}).in(mesh), mesh);
	};
	const SurfaceMesh knee = body(1);
	const CurveSkeleton s = refined(knee);
	ASSERT_EQ(tips(s).size(), 3u);
	EXPECT_GE(farthest(tips(s), 0), 1) << "outside of the body's balls";
	EXPECT_TRUE(isInside(s, knee));
	EXPECT_EQ(tips(refined(body(2))).size(), 2u);
}

TEST(Refine, TakesLowLimbsIfTheyAreLongAndFlatOnesIfTheyComeToAPoint)
{
	const RefineParameters shipped;
	const refining::FeatureRule rule = {
		shipped.featureGain, shipped.featureHeight, shipped.spacing};
	// A way of balls that grow by two fifths of it.
	const auto branch = [](double way, double flat) {
		return refining::FeatureBranch {
			{{0, 0, 0}, {way, 0, 0}}, {1, 1 + 0.4 * way}, /*joint*/ 0, flat};
	};
	const auto isLimb = [&](double way, double flat, double height, double spikiness) {
		const refining::Peak peak = {0, 1, spikiness, /*diagonals*/ 0, height};
		return refining::leadsIntoLimb(branch(way, flat), peak, rule);
	};
	EXPECT_TRUE(isLimb(3, 0, 1, 0.3));
	EXPECT_FALSE(isLimb(1, 0, 1, 0.3)) << "too short for the ball it ends in";
	EXPECT_FALSE(isLimb(3, 0, 0.38, 0.3)) << "low, and too short for that";
	EXPECT_TRUE(isLimb(20, 0, 0.6, 0.3)) << "low, but long";
	EXPECT_TRUE(isLimb(3, 0.5, 1, 0.4)) << "an ear";
	EXPECT_FALSE(isLimb(3, 0.5, 1, 0.2)) << "a rim";
	EXPECT_FALSE(isLimb(3, 0.9, 1, 0.4)) << "a plate";
	const auto isCorner = [&](double rim, double spikiness) {
		refining::FeatureBranch way = branch(3, 0);
		way.rim = rim;
		const refining::Peak peak = {0, 1, spikiness, /*diagonals*/ 0, /*height*/ 1};
		return !refining::leadsIntoLimb(way, peak, rule);
	};
	EXPECT_FALSE(isCorner(0.3, 0.4)) << "a limb next to a body";
	EXPECT_TRUE(isCorner(0.7, 0.4)) << "along the rim of a plate";
	EXPECT_FALSE(isCorner(0.7, 0.8)) << "a spike, of which the body is seen";
	EXPECT_TRUE(isCorner(0.9, 0.8)) << "along a rim for more than a radius";
	const auto isEvenSpike = [&](double bare) {
		const refining::FeatureBranch way = {
			{{0, 0, 0}, {1.8, 0, 0}}, {0.9, 1}, /*joint*/ 0, /*flat*/ 0, /*rim*/ 0.7, bare};
		const refining::Peak peak = {0, 1, /*spikiness*/ 0.7, /*diagonals*/ 0, /*height*/ 0.6};
		return refining::leadsIntoLimb(way, peak, rule);
	};
	EXPECT_TRUE(isEvenSpike(0.2)) << "what is beside it is covered, as by the head beside an eye";
	EXPECT_FALSE(isEvenSpike(0.7)) << "along the rim of a plate";
	EXPECT_TRUE(isLimb(1.5, 0, 0.3, 0.8)) << "a low spike";
	EXPECT_FALSE(isLimb(0.5, 0, 1, 0.8)) << "a spike, but too short";
	const auto isLobe = [&](double height, double spikiness, double size) {
		refining::FeatureBranch way = branch(6, 0.9);
		const refining::Peak peak = {
			0, 1, spikiness, height * way.radii.back() * size, height, /*saddle*/ 0};
		for (double& r : way.radii)
			r *= size;
		for (Point3d& p : way.points)
			p *= size;
		return refining::leadsIntoLimb(way, peak, rule);
	};
	EXPECT_TRUE(isLobe(6, 0.3, 0.01)) << "a lobe";
	EXPECT_FALSE(isLobe(3, 0.3, 0.01)) << "not high";
	EXPECT_FALSE(isLobe(6, 0.2, 0.01)) << "round";
	EXPECT_FALSE(isLobe(6, 0.3, 0.002)) << "no large part of the shape";
}

TEST(Refine, TheMiddlesOfAPlatesSidesAreNoLobes)
{
	// High above the branches into the corners, and with a spikiness of 0.7.
	for (const double thickness : {0.035, 0.07, 0.1}) {
		const SurfaceMesh plate = shapes::refined(shapes::box(1, 1, thickness), 5).mesh();
		const Point3d middle(0.5, 0.5, thickness / 2);
		CurveMaker cross;
		for (const double x : {0.05, 0.95})
			for (const double y : {0.05, 0.95})
				cross.line(middle, {x, y, thickness / 2}, 100);
		const std::vector<Point3d> found = tips(refine(cross.in(plate), plate));
		EXPECT_EQ(found.size(), 4u) << thickness;
		for (const Point3d& tip : found)
			EXPECT_GT(Distance(tip, middle), 0.55) << thickness;
	}
}

TEST(Refine, AThinPlateOfWhichTheFlowLeftADotHasItsCorners)
{
	// Before they are sampled, the nodes of new branches are half a ball's radius apart.
	constexpr double thickness = 0.0065;
	const SurfaceMesh plate = shapes::refined(shapes::box(1, 1, thickness), 6).mesh();
	const Point3d middle(0.5, 0.5, thickness / 2);
	const CurveSkeleton s =
		refine(CurveMaker().line(middle, middle + Point3d(0.02, 0, 0), 4).in(plate), plate);
	const std::vector<Point3d> found = tips(s);
	EXPECT_EQ(found.size(), 4u);
	for (const Point3d& tip : found)
		EXPECT_GT(Distance(tip, middle), 0.55);
	EXPECT_TRUE(isInside(s, plate));
}

TEST(Refine, GrowsABranchIntoAHighLobeOfAPlate)
{
	// A flat clover leaf with three lobes, the curve in two of them.
	constexpr double reach = 12, lobe = 8;
	const Point3d middle(22, 22, 1.5);
	std::vector<Point3d> centres;
	for (int k = 0; k < 3; ++k) {
		const double angle = 2 * M_PI * k / 3;
		centres.push_back(middle + Point3d(std::cos(angle), std::sin(angle), 0) * reach);
	}
	const auto isLeaf = [&](int i, int j, int) {
		return std::any_of(centres.begin(), centres.end(), [&](const Point3d& c) {
			return std::hypot(i + 0.5 - c[0], j + 0.5 - c[1]) <= lobe;
		}) || std::hypot(i + 0.5 - middle[0], j + 0.5 - middle[1]) <= lobe / 2;
	};
	const SurfaceMesh mesh = shapes::cells(44, 44, 3, isLeaf).mesh();
	const CurveSkeleton s =
		refine(CurveMaker().line(centres[0], middle).line(middle, centres[1]).in(mesh), mesh);
	EXPECT_TRUE(isInside(s, mesh));
	ASSERT_EQ(tips(s).size(), 3u);
	double nearest = reach;
	for (const Point3d& tip : tips(s))
		nearest = std::min(nearest, Distance(tip, centres[2]));
	EXPECT_LE(nearest, lobe);
}

TEST(Refine, GivesAHandItsFingersAndItsWristOnly)
{
	// The corners of the palm are no limbs, however the surface is triangulated.
	const SurfaceMesh hand = shapes::fromFile("hand").mesh();
	for (double length : {0.0042, 0.0048, 0.005, 0.0058}) {
		Parameters parameters;
		parameters.targetLength = length;
		const MeasuredSurface measured(hand);
		const SurfaceMesh surface = resample(
			measured, defaultTargetLength(measured, parameters), parameters.resampleIterations);
		const Stage end = contractToSkeleton(firstStageOf(surface, parameters), parameters);
		const CurveSkeleton s = refine(collapseToCurve(end), surface);
		EXPECT_EQ(tips(s).size(), 6u) << "edges of " << length;
		EXPECT_TRUE(isInside(s, hand));
	}
}

TEST(Refine, StubsInPlatesAreTakenBack)
{
	const auto tipsLeft = [](const SurfaceMesh& mesh, CurveSkeleton s) {
		std::vector<int> all(mesh.vertexSlots());
		std::iota(all.begin(), all.end(), 0);
		const ClosestSurface surface(mesh, all, 1, Progress());
		refining::KnownClearances clearances(surface);
		refining::measureBranchEnds(s, clearances);
		return tips(refining::withoutStubsInPlates(s, surface)).size();
	};
	const SurfaceMesh plate = shapes::cells(60, 40, 2, [](int, int, int) { return true; }).mesh();
	const auto inPlate = [&](double length) {
		const Point3d joint(30, 20, 1);
		return CurveMaker()
			.line({5, 20, 1}, joint)
			.line(joint, {55, 20, 1})
			.line(joint, {30, 20 + length, 1}, 8)
			.in(plate);
	};
	EXPECT_EQ(tipsLeft(plate, inPlate(3)), 2u) << "three radii";
	EXPECT_EQ(tipsLeft(plate, inPlate(12)), 3u) << "a lobe has a branch like that";

	const SurfaceMesh forked = shapes::cells(90, 60, 14, [](int i, int j, int) {
		return i >= 30 || j < 20 || j >= 40;
	}).mesh();
	const Point3d fork(36, 30, 7);
	const CurveSkeleton inForked = CurveMaker()
									   .line(fork, {84, 30, 7}, 48)
									   .line(fork, {30, 10, 7}, 20)
									   .line(fork, {30, 50, 7}, 20)
									   .in(forked);
	EXPECT_EQ(tipsLeft(forked, inForked), 3u) << "half of the curve";

	const SurfaceMesh bars = shapes::cells(60, 30, 2, [](int i, int j, int) {
		return j < 2 || (i >= 29 && i < 31);
	}).mesh();
	const CurveSkeleton inLimb = CurveMaker()
									 .line({1, 1, 1}, {30, 1, 1}, 30)
									 .line({30, 1, 1}, {59, 1, 1}, 30)
									 .line({30, 1, 1}, {30, 5, 1}, 8)
									 .in(bars);
	EXPECT_EQ(tipsLeft(bars, inLimb), 3u) << "in a limb";

	const SurfaceMesh ear = shapes::cells(60, 26, 12, [](int, int j, int k) {
		return j < 12 || (k >= 5 && k < 7);
	}).mesh();
	const Point3d joint(30, 6, 6);
	const CurveSkeleton inEar = CurveMaker()
									.line({6, 6, 6}, joint, 30)
									.line(joint, {54, 6, 6}, 30)
									.line(joint, {30, 24, 6}, 30)
									.in(ear);
	EXPECT_EQ(tipsLeft(ear, inEar), 3u) << "a plate on a thicker body";
}

TEST(Refine, ABranchGrowsAroundAGap)
{
	// A bar with two arms side by side; the nearest ball to the thin one's end is in the other.
	const SurfaceMesh mesh = shapes::cells(24, 20, 3, [](int i, int j, int) {
		return j < 4 || (i >= 3 && i < 12) || (i >= 13 && i < 16);
	}).mesh();
	const CurveSkeleton s = refine(CurveMaker()
									   .line({1.5, 2, 1.5}, {22.5, 2, 1.5})
									   .line({8.025, 2, 1.5}, {7.5, 18, 1.5})
									   .in(mesh),
		mesh);
	EXPECT_TRUE(isInside(s, mesh));
	double nearest = 20;
	for (const Point3d& tip : tips(s))
		nearest = std::min(nearest, Distance(tip, Point3d(14.5, 18.5, 1.5)));
	EXPECT_LE(nearest, 1);
}

TEST(Refine, ANodeInTheBallOfAJunctionHasLittleSay)
{
	// Three limbs of radius 0.2 on a ball of radius 1.
	CurveSkeleton s;
	s.position = {{0, 0, 0}};
	std::vector<double> distance = {1};
	for (const Point3d& d : {Point3d(1, 0, 0), Point3d(0, 1, 0), Point3d(0, 0, 1)})
		for (int i = 1; i <= 6; ++i) {
			const int v = int(s.position.size());
			s.position.push_back(d * (i * 0.25));
			distance.push_back(std::max(0.2, 1 - i * 0.25));
			s.edges.push_back({i == 1 ? 0 : v - 1, v});
		}
	const std::vector<double> share = refining::sharesOfCentring(s, s.neighbours(), distance);
	EXPECT_EQ(share[0], 1) << "the junction is the ball's own";
	for (int limb = 0; limb < 3; ++limb) {
		const double* along = &share[1 + 6 * limb];
		EXPECT_LE(along[0], 0.2);
		EXPECT_LE(along[2], 0.2) << "its ball still ends where the large one does";
		EXPECT_EQ(along[5], 1) << "outside of it";
		EXPECT_TRUE(std::is_sorted(along, along + 6));
	}
}

TEST(Refine, MakesOneJunctionOfSeveralPieces)
{
	// Four arms that meet in the middle of a plus, the curve in two junctions.
	const SurfaceMesh mesh = shapes::cells(25, 25, 5, [](int i, int j, int) {
		return (i >= 10 && i < 15) || (j >= 10 && j < 15);
	}).mesh();
	const Point3d a(12.1, 12.5, 2.5), b(12.9, 12.5, 2.5);
	const CurveSkeleton rough = CurveMaker()
									.line(a, {2.5, 12.5, 2.5})
									.line(a, {12.5, 2.5, 2.5})
									.line(a, b, 2)
									.line(b, {22.5, 12.5, 2.5})
									.line(b, {12.5, 22.5, 2.5})
									.in(mesh);
	ASSERT_EQ(statistics(rough).junctions, 2);
	const CurveSkeleton s = refine(rough, mesh);
	EXPECT_EQ(statistics(s).junctions, 1);
	EXPECT_EQ(statistics(s).terminals, 4);
	EXPECT_TRUE(isInside(s, mesh));
}

TEST(Refine, KeepsJunctionsThatAreApart)
{
	const SurfaceMesh mesh = shapes::cells(45, 15, 5, [](int i, int j, int) {
		return j < 5 || (i >= 10 && i < 15) || (i >= 30 && i < 35);
	}).mesh();
	const Point3d a(12.5, 2.5, 2.5), b(32.5, 2.5, 2.5);
	const CurveSkeleton s = refine(CurveMaker()
									   .line(a, {2.5, 2.5, 2.5})
									   .line(a, {12.5, 12.5, 2.5})
									   .line(a, b)
									   .line(b, {32.5, 12.5, 2.5})
									   .line(b, {42.5, 2.5, 2.5})
									   .in(mesh),
		mesh);
	EXPECT_EQ(statistics(s).junctions, 2);
	EXPECT_EQ(statistics(s).terminals, 4);
}

TEST(Refine, ALimbThatForksWhereItLeavesABodyKeepsItsFork)
{
	const auto junctionsLeft = [](double fork, double radius) {
		SurfaceMesh none;
		CurveSkeleton s = CurveMaker()
							  .chain({{-2, 0, 0}, {0, 0, 0}, {fork / 2, 0, 0}, {fork, 0, 0}})
							  .chain({{0, -2, 0}, {0, 0, 0}})
							  .chain({{fork, 0, 0}, {3, 1, 0}})
							  .chain({{fork, 0, 0}, {3, -1, 0}})
							  .in(none);
		for (size_t v = 0; v < s.position.size(); ++v)
			s.radius[v] = s.position[v] == Point3d(0, 0, 0) ? 1 : radius;
		return statistics(refining::withWholeJunctions(s, 0.5)).junctions;
	};
	EXPECT_EQ(junctionsLeft(1.1, 0.1), 2) << "just outside the body";
	EXPECT_EQ(junctionsLeft(0.8, 0.1), 1) << "within it";
	EXPECT_EQ(junctionsLeft(0.4, 0.9), 1) << "two halves of one junction";
	EXPECT_EQ(junctionsLeft(1.1, 0.9), 2) << "two bodies";
}

TEST(Refine, OfTwoBranchesThatEndInTheSamePlaceTheShorterStays)
{
	const auto tipsLeft = [](double apart, double radius) {
		SurfaceMesh none;
		CurveSkeleton s = CurveMaker()
							  .chain({{-2, 0, 0}, {0, 0, 0}})
							  .chain({{0, 0, 0}, {1, 1, 0}, {3, apart, 0}})
							  .chain({{0, 0, 0}, {3, 0, 0}})
							  .in(none);
		for (size_t v = 0; v < s.position.size(); ++v)
			s.radius[v] = s.position[v] == Point3d(3, apart, 0) ? radius : 0.3;
		return tips(refining::withoutTwinTips(s));
	};
	EXPECT_EQ(tipsLeft(0.5, 0.4), (std::vector<Point3d> {{-2, 0, 0}, {3, 0, 0}}));
	EXPECT_EQ(tipsLeft(0.7, 0.4).size(), 3u) << "farther apart than two small balls are wide";
	EXPECT_EQ(tipsLeft(0.5, 0.2).size(), 3u) << "a smaller limb beside a larger one";
}

TEST(Refine, KeepsEveryCycle)
{
	const SurfaceMesh mesh = shapes::plate(3, 4).mesh(); // bars of width 1
	CurveMaker maker;
	for (int i = 0; i < 3; ++i)
		maker.line({2.0 * i + 0.5, 0.5, 0.5}, {2.0 * i + 2.5, 0.5, 0.5})
			.line({2.0 * i + 0.5, 2.5, 0.5}, {2.0 * i + 2.5, 2.5, 0.5});
	for (int i = 0; i < 4; ++i)
		maker.line({2.0 * i + 0.5, 0.5, 0.5}, {2.0 * i + 0.5, 2.5, 0.5});
	const CurveSkeleton rough = maker.in(mesh);
	ASSERT_EQ(statistics(rough).cycles, 3);
	// Even where every two junctions are near enough to be merged.
	for (double junctionProminence : {0.5, 1.0}) {
		RefineParameters parameters;
		parameters.junctionProminence = junctionProminence;
		const CurveSkeleton s = refine(rough, mesh, parameters);
		EXPECT_EQ(checks::skeletonError(s), "");
		EXPECT_EQ(statistics(s).cycles, 3);
		EXPECT_EQ(statistics(s).components, 1);
		EXPECT_TRUE(isInside(s, mesh));
	}
}

TEST(Refine, KeepsTinyCycles)
{
	// Two cycles of three edges each, far smaller than the spacing.
	const SurfaceMesh mesh = shapes::capsule(3, 0.35, 48).mesh();
	const double d = 1e-3;
	const CurveSkeleton rough = CurveMaker()
									.line({-1.4, 0, 0}, {0, 0, 0})
									.chain({{0, 0, 0}, {d, d, 0}, {d, -d, 0}, {0, 0, 0}})
									.chain({{0, 0, 0}, {-d, 0, d}, {d, d, d}, {0, 0, 0}})
									.in(mesh);
	ASSERT_EQ(statistics(rough).cycles, 2);
	const Refinement refined = refineChecked(rough, mesh);
	EXPECT_EQ(refined.report.refined, 1);
	EXPECT_EQ(statistics(refined.skeleton).cycles, 2);
	EXPECT_EQ(statistics(refined.skeleton).components, 1);
}

TEST(Refine, MovesACurveThatStartsOutsideIn)
{
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 120, 40).mesh();
	std::vector<Point3d> ring; // passes outside on one side
	for (int i = 0; i <= 80; ++i) {
		const double u = 2 * M_PI * (i % 80) / 80;
		ring.emplace_back(0.8 * std::cos(u) - 0.15, 0.95 * std::sin(u), 0);
	}
	const CurveSkeleton rough = CurveMaker().chain(ring).in(mesh);
	ASSERT_FALSE(isInside(rough, mesh));
	const CurveSkeleton s = refine(rough, mesh);
	EXPECT_EQ(statistics(s).cycles, 1);
	EXPECT_TRUE(isInside(s, mesh));
}

TEST(Refine, MovesLongEdgesThatLeaveTheSurfaceIn)
{
	// The nodes of the triangle are on the axis of the ring, its edges cross the hole.
	const SurfaceMesh mesh = shapes::torus(1, 0.3, 120, 40).mesh();
	std::vector<Point3d> triangle;
	for (int i = 0; i <= 3; ++i) {
		const double u = 2 * M_PI * (i % 3) / 3;
		triangle.emplace_back(std::cos(u), std::sin(u), 0);
	}
	const CurveSkeleton rough = CurveMaker().chain(triangle).in(mesh);
	ASSERT_FALSE(isInside(rough, mesh));
	const CurveSkeleton s = refine(rough, mesh);
	EXPECT_EQ(statistics(s).cycles, 1);
	EXPECT_TRUE(isInside(s, mesh));
}

TEST(Refine, NodesGoBackWhoseEdgesWouldCutACorner)
{
	const SurfaceMesh mesh =
		shapes::cells(5, 5, 1, [](int i, int j, int) { return i == 0 || j == 0; }).mesh();
	CurveSkeleton before, moved;
	before.position = {{0.5, 4.5, 0.5}, {0.5, 0.6, 0.5}, {0.6, 0.5, 0.5}, {4.5, 0.5, 0.5}};
	before.edges = {{0, 1}, {1, 2}, {2, 3}};
	before.radius.assign(4, 0.4);
	moved = before;
	moved.position[0] = {0.6, 4.5, 0.5};
	moved.position[1] = {0.5, 1.8, 0.5}; // each inside, but not what is between them
	moved.position[2] = {1.8, 0.5, 0.5};
	const std::vector<Point3d> wanted = moved.position;
	ASSERT_TRUE(isInside(before, mesh));
	ASSERT_FALSE(isInside(moved, mesh));
	std::vector<int> vertices(mesh.position.size());
	std::iota(vertices.begin(), vertices.end(), 0);
	refining::keepEdgesInside(moved, before, ClosestSurface(mesh, vertices, 0.1));
	EXPECT_TRUE(isInside(moved, mesh));
	EXPECT_EQ(moved.position[0], wanted[0]) << "has done no harm";
	EXPECT_EQ(moved.position[1], before.position[1]);
	EXPECT_EQ(moved.position[2], before.position[2]);
	EXPECT_EQ(moved.position[3], wanted[3]);
}

TEST(Refine, NeverCutsThroughThinWalls)
{
	// A tube in the shape of a U: the straight way between its legs is outside. The tube and what its legs are apart
	// are 4 and 20 % of the diagonal, then both 0.14 %; the curve is aside of the axis, and outside along one leg.
	const struct
	{
		int gap, length;
	} cases[] = {{5, 24}, {1, 700}};
	for (const auto& shape : cases) {
		const int last = shape.gap + 1, length = shape.length;
		SCOPED_TRACE(length);
		const SurfaceMesh mesh = shapes::cells(last + 1, length, 1, [&](int i, int j, int) {
			return i == 0 || i == last || j == 0;
		}).mesh();
		const auto isInTube = [&](const Point3d& p) {
			return p[2] > 0 && p[2] < 1 && p[0] > 0 && p[0] < last + 1 && p[1] > 0 && p[1] < length
				&& (p[0] < 1 || p[0] > last || p[1] < 1);
		};
		const double left = -0.1, right = last + 0.3, end = length - 0.8;
		const int pieces = std::max(9, length / 10);
		const CurveSkeleton curve = CurveMaker()
										.line({left, end, 0.6}, {left, 0.5, 0.6}, pieces)
										.line({left, 0.5, 0.6}, {right, 0.5, 0.6}, 3)
										.line({right, 0.5, 0.6}, {right, end, 0.6}, pieces)
										.in(mesh);
		const Refinement checked = refineChecked(curve, mesh);
		EXPECT_EQ(checked.report.refined, 1) << checked.report.text();
		for (const CurveSkeleton& s : {refine(curve, mesh), checked.skeleton}) {
			EXPECT_EQ(statistics(s).components, 1);
			EXPECT_EQ(statistics(s).terminals, 2);
			EXPECT_EQ(statistics(s).cycles, 0);
			int outside = 0;
			for (const auto& [v, w] : s.edges)
				for (int i = 0; i <= 20; ++i)
					outside +=
						!isInTube(s.position[v] + (s.position[w] - s.position[v]) * (i / 20.0));
			EXPECT_EQ(outside, 0);
			// What belongs to one leg stays there.
			const double middle = (last + 1) / 2.0;
			int across = 0;
			for (size_t i = 0; i < s.node.size(); ++i)
				if (mesh.position[i][1] > 4)
					across += (s.position[size_t(s.node[i])][0] > middle)
						!= (mesh.position[i][0] > middle);
			EXPECT_EQ(across, 0);
		}
	}
}

TEST(Refine, VerticesGoToTheNearestNodeAround)
{
	const SurfaceMesh mesh = barWithArm(6).mesh();
	const CurveSkeleton s = refine(curveOfBarWithArm(mesh, 8.5), mesh);
	ASSERT_EQ(checks::skeletonError(s), "");
	const auto neighbours = s.neighbours();
	for (size_t i = 0; i < s.node.size(); ++i)
		for (int w : neighbours[s.node[i]])
			EXPECT_LE(Distance(mesh.position[i], s.position[s.node[i]]),
				Distance(mesh.position[i], s.position[w]) + 1e-4)
				<< "as near, but for the rounding of the coordinates that nodes are told in";
}

TEST(Refine, RefinesEachComponentAsIfItWereAlone)
{
	const shapes::Soup large = shapes::capsule(3, 0.35, 48);
	const shapes::Soup small = shapes::moved(shapes::scaled(large, 0.01), Point3d(0, 2, 0));
	const auto maker = [](double scale, double y) {
		std::vector<Point3d> points = zigzag(-1.3, 1.3, 0.05, 0.02);
		for (Point3d& p : points)
			p = p * scale + Point3d(0, y, 0);
		return points;
	};
	const SurfaceMesh both = shapes::joined({large, small}).mesh();
	const CurveSkeleton s =
		refine(CurveMaker().chain(maker(1, 0)).chain(maker(0.01, 2)).in(both), both);
	const SurfaceMesh one = large.mesh();
	const CurveSkeleton alone = refine(CurveMaker().chain(maker(1, 0)).in(one), one);
	EXPECT_EQ(checks::skeletonError(s), "");
	EXPECT_EQ(statistics(s).components, 2);
	ASSERT_EQ(s.position.size(), 2 * alone.position.size());
	for (size_t v = 0; v < alone.position.size(); ++v) {
		EXPECT_EQ(s.position[v], alone.position[v]);
		const Point3d p = (s.position[alone.position.size() + v] - Point3d(0, 2, 0)) / 0.01;
		EXPECT_LE(Distance(p, alone.position[v]), 0.001 * one.bounds().Diag());
	}
}

TEST(Refine, VerticesWithANodeOfAnotherBodyGoToTheNearestOfTheirOwn)
{
	// A fat ball beside a rod: the ball's vertices that face the rod are nearer to the rod's nodes.
	const shapes::Soup rod = shapes::capsule(3, 0.1, 24);
	const shapes::Soup ball = shapes::moved(shapes::sphere(3), Point3d(0, 1.2, 0));
	CurveMaker maker =
		CurveMaker().line({-1.4, 0, 0}, {1.4, 0, 0}, 40).line({0, 1.2, 0}, {0.01, 1.2, 0}, 1);
	for (const auto& parts : {std::vector {ball, rod}, std::vector {rod, ball}}) {
		const SurfaceMesh mesh = shapes::joined({parts[0], parts[1]}).mesh();
		const CurveSkeleton given = maker.in(mesh);
		const std::vector<int> component = connectedComponents(mesh);
		const std::vector<int> ofGiven = componentOfNodes(given, component);
		int crossing = 0;
		for (size_t v = 0; v < given.node.size(); ++v)
			crossing += ofGiven[given.node[v]] != component[v];
		ASSERT_GT(crossing, 50);
		const Refinement refined = refineChecked(given, mesh);
		const CurveSkeleton& s = refined.skeleton;
		EXPECT_EQ(checks::skeletonError(s), "");
		EXPECT_EQ(refined.report.refined, 2);
		const std::vector<int> ofNode = componentOfNodes(s, component);
		for (size_t v = 0; v < s.node.size(); ++v) {
			ASSERT_GE(s.node[v], 0);
			EXPECT_EQ(ofNode[s.node[v]], component[v]);
		}
	}
}

TEST(Refine, KeepsTheEdgeOfABallsSkeleton)
{
	const SurfaceMesh mesh = shapes::sphere(3).mesh();
	const CurveSkeleton s = refine(CurveMaker().line({0, 0, 0}, {1e-3, 0, 0}, 1).in(mesh), mesh);
	EXPECT_EQ(checks::skeletonError(s), "");
	EXPECT_EQ(statistics(s).components, 1);
	EXPECT_EQ(statistics(s).cycles, 0);
	for (const Point3d& p : s.position)
		EXPECT_LE(p.Norm(), 0.1);
}

TEST(Refine, WorksOnABoxOfEightVertices)
{
	const SurfaceMesh mesh = shapes::box(4, 1, 1).mesh();
	const CurveSkeleton s =
		refine(CurveMaker().line({0.6, 0.45, 0.6}, {3.4, 0.6, 0.4}).in(mesh), mesh);
	EXPECT_EQ(checks::skeletonError(s), "");
	EXPECT_TRUE(isInside(s, mesh));
	EXPECT_LE(meanDistance(s,
				  [](const Point3d& p) {
					  return p[0] < 1 || p[0] > 3 ? 0 : std::hypot(p[1] - 0.5, p[2] - 0.5);
				  }),
		0.0015 * mesh.bounds().Diag());
}

class RefineMoved : public testing::TestWithParam<double>
{
};

TEST_P(RefineMoved, ScalesWithTheShape)
{
	const double scale = GetParam();
	const shapes::Soup soup = barWithArm(4);
	const SurfaceMesh mesh = soup.mesh(), scaled = shapes::scaled(soup, scale).mesh();
	const CurveSkeleton curve = curveOfBarWithArm(mesh, 6);
	CurveSkeleton scaledCurve = curve;
	for (Point3d& p : scaledCurve.position)
		p *= scale;
	const CurveSkeleton a = refine(curve, mesh), b = refine(scaledCurve, scaled);
	ASSERT_EQ(a.edges, b.edges);
	for (size_t v = 0; v < a.position.size(); ++v) {
		EXPECT_LE(Distance(a.position[v], b.position[v] / scale), 0.001 * mesh.bounds().Diag());
		EXPECT_NEAR(a.radius[v], b.radius[v] / scale, 0.01 * mesh.bounds().Diag());
	}
}

INSTANTIATE_TEST_SUITE_P(Refine, RefineMoved, testing::Values(1e-6, 1e-3, 7.0, 1e6));

TEST(Refine, TurnsAndMovesWithTheShape)
{
	const auto map = [](const Point3d& p) {
		return Point3d(0.36 * p[0] + 0.48 * p[1] - 0.8 * p[2], -0.8 * p[0] + 0.6 * p[1],
				   0.48 * p[0] + 0.64 * p[1] + 0.6 * p[2])
			+ Point3d(100, -200, 300);
	};
	const shapes::Soup soup = shapes::capsule(3, 0.35, 47);
	const SurfaceMesh mesh = soup.mesh(), moved = shapes::transformed(soup, map).mesh();
	const CurveSkeleton curve = CurveMaker().chain(zigzag(-1.3, 1.3, 0.05, 0.02)).in(mesh);
	CurveSkeleton movedCurve = curve;
	for (Point3d& p : movedCurve.position)
		p = map(p);
	const CurveSkeleton a = refine(curve, mesh), b = refine(movedCurve, moved);
	const double diagonal = mesh.bounds().Diag();
	// The bounding box, and with it the spacing, turns only as well as boxes do.
	for (const Point3d& p : a.position) {
		double nearest = diagonal;
		for (const Point3d& q : b.position)
			nearest = std::min(nearest, Distance(map(p), q));
		EXPECT_LE(nearest, 0.005 * diagonal);
	}
	EXPECT_EQ(statistics(a).branches, statistics(b).branches);
}

TEST(Refine, GivesTheSameBitsTwice)
{
	const SurfaceMesh mesh = barWithArm(4).mesh();
	const CurveSkeleton curve = curveOfBarWithArm(mesh, 6);
	const CurveSkeleton a = refine(curve, mesh), b = refine(curve, mesh);
	EXPECT_EQ(a.position, b.position);
	EXPECT_EQ(a.radius, b.radius);
	EXPECT_TRUE(sameGraph(a, b));
}

/// A fine box about the origin, as flat as it says, and a line in it that leaves it all the time.
void expectInsideThinBox(double across, double height)
{
	const shapes::Soup fine =
		shapes::cells(60, across > height ? 60 : 1, 1, [](int, int, int) { return true; });
	const double width = across > height ? 60 : 1;
	const SurfaceMesh mesh = shapes::transformed(fine, [&](const Point3d& p) {
		return Point3d(p[0] / 60 - 0.5, (p[1] / width - 0.5) * across, (p[2] - 0.5) * height);
	}).mesh();
	std::vector<Point3d> points;
	for (int i = 0; i <= 40; ++i)
		points.emplace_back(-0.4 + 0.02 * i, 0.1 * across, (i % 2 ? 1 : -1) * height);
	RefineParameters parameters;
	parameters.featureHeight = 1e6; // whether the corners of a plate are lobes is not asked here
	const Refinement result = refineChecked(CurveMaker().chain(points).in(mesh), mesh, parameters);
	EXPECT_EQ(result.report.refined, 1) << result.report.text();
	EXPECT_EQ(result.report.text(), "");
	for (const Point3d& p : result.skeleton.position) // edges then are, too: a box is convex
		EXPECT_TRUE(
			std::abs(p[0]) < 0.5 && std::abs(p[1]) < across / 2 && std::abs(p[2]) < height / 2)
			<< p[0] << " " << p[1] << " " << p[2];
	EXPECT_EQ(statistics(result.skeleton).components, 1);
	EXPECT_LE(statistics(result.skeleton).length, mesh.bounds().Diag());
}

TEST(Refine, BringsCurvesIntoThinPlatesAndRods)
{
	for (double height : {0.02, 0.012, 0.01, 0.001, 0.0005, 0.00007}) {
		SCOPED_TRACE(height);
		expectInsideThinBox(1, height);
		expectInsideThinBox(height, height);
	}
}

/// In a torus about the origin, a curve that crosses the hole: no curve from end to end does not.
CurveSkeleton curveAcrossHole(const SurfaceMesh& torus)
{
	return CurveMaker().line({1, 0, 0}, {-1, 0, 0}, 21).in(torus);
}

TEST(Refine, KeepsACurveThatCannotBeInsideAndSaysSo)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	const CurveSkeleton curve = curveAcrossHole(mesh);
	const Refinement result = refineChecked(curve, mesh);
	EXPECT_EQ(result.report.components, 1);
	EXPECT_EQ(result.report.refined, 0);
	EXPECT_EQ(result.report.fraction(), 0);
	EXPECT_EQ(result.report.outside, 1);
	EXPECT_EQ(result.report.curvesOutside, 1);
	int outside = 0;
	for (const Point3d& p : curve.position)
		outside += checks::windingNumber(mesh, p) < 0.5;
	EXPECT_EQ(result.report.nodesOutside, outside);
	EXPECT_NE(result.report.text().find("1 of 1 components"), std::string::npos);
	EXPECT_EQ(result.skeleton.position, curve.position);
	EXPECT_EQ(result.skeleton.radius, curve.radius);
	EXPECT_TRUE(sameGraph(result.skeleton, curve));
}

TEST(Refine, AComponentThatFailsLeavesTheOthersAlone)
{
	const auto capsule = shapes::moved(shapes::capsule(), {0, 5, 0});
	const std::vector<Point3d> rough = [] {
		std::vector<Point3d> points = zigzag(-0.8, 0.8, 0.1, 0.03);
		for (Point3d& p : points)
			p += Point3d(0, 5, 0);
		return points;
	}();
	const SurfaceMesh one = capsule.mesh(), torus = shapes::torus().mesh();
	const CurveSkeleton alone = refine(CurveMaker().chain(rough).in(one), one);
	const CurveSkeleton across = curveAcrossHole(torus);

	const SurfaceMesh both = shapes::joined({capsule, shapes::torus()}).mesh();
	const Refinement result =
		refineChecked(CurveMaker().chain(rough).line({1, 0, 0}, {-1, 0, 0}, 21).in(both), both);
	EXPECT_EQ(result.report.components, 2);
	EXPECT_EQ(result.report.refined, 1);
	EXPECT_EQ(result.report.fraction(), 0.5);
	const CurveSkeleton& s = result.skeleton;
	ASSERT_EQ(s.position.size(), alone.position.size() + across.position.size());
	for (size_t v = 0; v < alone.position.size(); ++v)
		EXPECT_EQ(s.position[v], alone.position[v]);
	for (size_t v = 0; v < across.position.size(); ++v)
		EXPECT_EQ(s.position[alone.position.size() + v], across.position[v]);
	EXPECT_EQ(checks::skeletonError(s), "");
}

TEST(Refine, FindsWhatIsWrongWithACurve)
{
	using refining::Defect;
	const SurfaceMesh mesh = shapes::scaled(shapes::torus(), 1 / 3.0).mesh();
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	const ClosestSurface closest(mesh, all, 0.01);
	const refining::InsideCheck inside(closest, {mesh, all, all});
	const double spacing = RefineParameters().spacing;
	const auto arc = [](int pieces, int end) {
		std::vector<Point3d> points;
		for (int i = 0; i <= end; ++i)
			points.emplace_back(
				std::cos(2 * M_PI * i / pieces) / 3, std::sin(2 * M_PI * i / pieces) / 3, 0);
		return points;
	};
	const CurveSkeleton good = CurveMaker().chain(arc(60, 40)).in(mesh);
	const auto defect = [&](const CurveSkeleton& curve) {
		return refining::defectOf(curve, good, spacing, inside);
	};
	EXPECT_EQ(defect(good), Defect::None);

	CurveSkeleton bad = good;
	bad.position[7] = Point3d(0, 0, 0);
	EXPECT_EQ(defect(bad), Defect::Outside) << "a node in the hole";
	EXPECT_EQ(defect(CurveMaker().chain({arc(4, 1)[0], arc(4, 2)[2]}).in(mesh)), Defect::Outside)
		<< "an edge through the hole, both nodes inside";
	EXPECT_EQ(defect(CurveMaker().chain({{0, 0, 1}, {0, 0, 1.01}}).in(mesh)), Defect::Outside)
		<< "all of it outside, and no edge crosses the surface";

	bad = good;
	bad.position[7][1] = std::numeric_limits<double>::quiet_NaN();
	EXPECT_EQ(defect(bad), Defect::NotFinite);
	bad = good;
	bad.edges.pop_back();
	EXPECT_EQ(defect(bad), Defect::Topology) << "in two parts";
	std::vector<Point3d> closed = arc(60, 60);
	closed.back() = closed.front();
	EXPECT_EQ(defect(CurveMaker().chain(closed).in(mesh)), Defect::Topology) << "a cycle";
	std::vector<Point3d> pacing;
	for (int i = 0; i < 2000; ++i)
		pacing.emplace_back((i % 2 ? 0.3 : 0.36), 1e-5 * i, 0);
	EXPECT_EQ(defect(CurveMaker().chain(pacing).in(mesh)), Defect::TooLong);
}

TEST(Refine, HoweverThinTheShapeTheNodesAreBounded)
{
	constexpr double spacing = 1e-6; // as in a shape of that thickness
	const auto line = [](int nodes) {
		CurveSkeleton curve;
		for (int i = 0; i < nodes; ++i) {
			curve.position.emplace_back(double(i) / (nodes - 1), 0, 0);
			if (i > 0)
				curve.edges.push_back({i - 1, i});
		}
		return curve;
	};
	const refining::CurveBounds bounds(line(4), spacing);
	EXPECT_TRUE(bounds.holdAtEnd(line(int(refining::maxNodes(1)))));
	EXPECT_TRUE(bounds.holdNodes(line(int(2 * refining::maxNodes(1))))) << "on the way";
	EXPECT_FALSE(bounds.holdAtEnd(line(int(2 * refining::maxNodes(1)))));
}

TEST(Refine, ACurveMayGrowIntoLimbsButNotToAndFro)
{
	const auto star = [](int arms, double length) {
		CurveMaker curve;
		for (int i = 0; i < arms; ++i) {
			const double angle = 2 * M_PI * i / arms;
			curve.chain({Point3d(0, 0, 0), Point3d(std::cos(angle), std::sin(angle), 0) * length});
		}
		return curve.in(SurfaceMesh());
	};
	const auto pacing = [](int ways, double length) {
		std::vector<Point3d> points;
		for (int i = 0; i <= ways; ++i)
			points.emplace_back(i % 2 ? length : 0, 1e-6 * i, 0);
		return CurveMaker().chain(points).in(SurfaceMesh());
	};
	const refining::CurveBounds bounds(star(2, 0.25), RefineParameters().spacing);
	EXPECT_TRUE(bounds.holdLength(star(8, 0.5))) << "limbs of a round body";
	EXPECT_FALSE(bounds.holdLength(pacing(8, 0.5))) << "as long";
	EXPECT_TRUE(bounds.holdLength(pacing(4, 0.5)));
	EXPECT_FALSE(bounds.holdLength(star(20, 0.5)));
}

TEST(Refine, AFewEdgesThatHaveLeftTheSurfaceAreBroughtBack)
{
	using refining::Defect;
	const SurfaceMesh mesh = shapes::scaled(shapes::torus(), 1 / 3.0).mesh();
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	const refining::SurfaceComponent component = {mesh, all, all};
	const ClosestSurface closest(mesh, all, 0.01);
	const refining::InsideCheck inside(closest, component);
	std::vector<Point3d> arc;
	for (int i = 0; i <= 40; ++i)
		arc.emplace_back(std::cos(M_PI * i / 30) / 3, std::sin(M_PI * i / 30) / 3, 0);
	const CurveSkeleton good = CurveMaker().chain(arc).in(mesh);
	CurveSkeleton bad = good;
	bad.position[7] *= 0.5; // into the hole
	const double spacing = RefineParameters().spacing;
	ASSERT_EQ(refining::defectOf(bad, good, spacing, inside), Defect::Outside);

	const std::optional<CurveSkeleton> back = refining::broughtBack(bad, component, Progress());
	ASSERT_TRUE(back);
	EXPECT_EQ(refining::defectOf(*back, good, spacing, inside), Defect::None);
	for (size_t v = 0; v < good.position.size(); ++v)
		if (v != 7)
			EXPECT_EQ(back->position[v], good.position[v]);
	EXPECT_EQ(statistics(*back).terminals, 2);
	EXPECT_LT(statistics(*back).length, 1.5 * statistics(good).length);

	EXPECT_FALSE(refining::broughtBack(curveAcrossHole(mesh), component, Progress()))
		<< "most of it is outside";
}

TEST(Refine, PlacesEnclosedTwiceAreInside)
{
	// A rod bent round by more than a turn, which runs into itself.
	const SurfaceMesh mesh = shapes::transformed(shapes::capsule(2, 0.1, 24), [](const Point3d& p) {
		const double angle = -3.4 * p[0], radius = 0.3 + p[1];
		return Point3d(radius * std::cos(angle), radius * std::sin(angle), p[2]);
	}).mesh();
	std::vector<int> all(mesh.vertexSlots());
	std::iota(all.begin(), all.end(), 0);
	const ClosestSurface closest(mesh, all, 0.01);
	const refining::InsideCheck inside(closest, {mesh, all, all});
	std::vector<Point3d> axis;
	for (double x = -0.95; x < 0.95; x += 0.02)
		axis.emplace_back(0.3 * std::cos(3.4 * x), -0.3 * std::sin(3.4 * x), 0);
	const CurveSkeleton curve = CurveMaker().chain(axis).in(mesh);
	ASSERT_GT(checks::windingNumber(mesh, axis.front()), 1.5);
	EXPECT_EQ(refining::defectOf(curve, curve, 0.005, inside), refining::Defect::None);
}

TEST(Refine, SaysWhatIsWrong)
{
	const SurfaceMesh mesh = shapes::capsule().mesh();
	CurveSkeleton curve = CurveMaker().line({-0.8, 0, 0}, {0.8, 0, 0}).in(mesh);
	RefineParameters bad;
	bad.spacing = 0;
	EXPECT_THROW(refine(curve, mesh, bad), InvalidParameter);
	bad = RefineParameters();
	bad.smoothing = -1;
	EXPECT_THROW(refine(curve, mesh, bad), InvalidParameter);
	bad = RefineParameters();
	bad.tipGain = 0;
	EXPECT_THROW(refine(curve, mesh, bad), InvalidParameter);
	bad = RefineParameters();
	bad.featureGain = 0;
	EXPECT_THROW(refine(curve, mesh, bad), InvalidParameter);
	bad = RefineParameters();
	bad.featureHeight = -1;
	EXPECT_THROW(refine(curve, mesh, bad), InvalidParameter);
	CurveSkeleton wrong = curve;
	wrong.node.front() = int(curve.position.size());
	EXPECT_THROW(refine(wrong, mesh), InvalidInput);
	wrong.node.pop_back();
	EXPECT_THROW(refine(wrong, mesh), InvalidInput);
	wrong = curve;
	wrong.position.back()[2] = std::numeric_limits<double>::infinity();
	EXPECT_THROW(refine(wrong, mesh), InvalidInput);
}

TEST(Refine, CanBeCancelled)
{
	const SurfaceMesh mesh = shapes::capsule().mesh();
	const CurveSkeleton curve = CurveMaker().line({-0.8, 0, 0}, {0.8, 0, 0}).in(mesh);
	EXPECT_THROW(
		refine(curve, mesh, RefineParameters(), Progress([](int, const char*) { return false; })),
		Cancelled);
	int last = 0;
	refine(curve, mesh, RefineParameters(), Progress([&](int percent, const char*) {
		EXPECT_GE(percent, last);
		last = percent;
		return true;
	}));
	EXPECT_EQ(last, 100);
}

} // namespace
