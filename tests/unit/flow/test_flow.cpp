// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "read_off.h"
#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/flow/flow.h>
#include <skeleton/resample/resampled_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Stage stageOf(const shapes::Soup& soup, PoleMethod method = PoleMethod::Balls)
{
	Parameters parameters;
	parameters.poleMethod = method;
	return firstStageOf(soup.mesh(), parameters);
}

struct NamedShape
{
	std::string name;
	shapes::Soup soup;
	int components, genus;
};

std::vector<NamedShape> generatedShapes()
{
	std::mt19937 random(1);
	return {{"tetrahedron", shapes::tetrahedron(), 1, 0},
		{"octahedron", shapes::octahedron(), 1, 0}, {"box of 8", shapes::box(1, 2, 3), 1, 0},
		{"cube of 8", shapes::box(), 1, 0}, {"sphere", shapes::sphere(3), 1, 0},
		{"capsule", shapes::capsule(), 1, 0}, {"torus", shapes::torus(), 1, 1},
		{"torus of 7 vertices", shapes::csaszarTorus(), 1, 1},
		{"torus of 9 vertices", shapes::torus(1, 0.3, 3, 3), 1, 1},
		{"uneven torus", shapes::shuffled(shapes::jittered(shapes::torus(), 0.03)), 1, 1},
		{"double torus", shapes::plate(2, 4), 1, 2}, {"plate of 3", shapes::plate(3, 3), 1, 3},
		{"thin plate",
			shapes::transformed(shapes::plate(1, 6),
				[](const Point3d& p) { return Point3d(p[0], p[1], p[2] / 20); }),
			1, 1},
		{"needle", shapes::box(1, 1e-3, 1e-3), 1, 0},
		{"thinner than epsilon", shapes::torus(1, 0.0005, 500, 5), 1, 1},
		{"four holes of three edges", shapes::withTunnels(shapes::sphere(3), 4, random), 1, 4},
		{"bodies of many sizes",
			shapes::joined(
				{shapes::torus(), shapes::moved(shapes::scaled(shapes::capsule(), 0.01), {3, 0, 0}),
					shapes::moved(shapes::scaled(shapes::plate(2), 100), {0, 0, 50})}),
			3, 3},
		{"bodies through each other",
			shapes::joined({shapes::sphere(4), shapes::sphere(3, 0.6), shapes::torus(0.8, 0.1)}), 3,
			1}};
}

/// Distance of p to the segment a b.
double distanceToSegment(const Point3d& p, const Point3d& a, const Point3d& b)
{
	const double t = std::clamp((p - a) * (b - a) / vcg::SquaredDistance(a, b), 0.0, 1.0);
	return vcg::Distance(p, a + (b - a) * t);
}

/// Largest distance of a vertex of the stage to its known place.
double largestDistance(const Stage& stage, const std::function<double(const Point3d&)>& toAxis)
{
	double largest = 0;
	for (const Point3d& p : stage.mesh.position)
		largest = std::max(largest, toAxis(p));
	return largest;
}

} // namespace

TEST(Flow, EveryStageOfEveryShapeIsASoundMeshOfItsTopology)
{
	for (const auto& [name, soup, components, genus] : generatedShapes()) {
		SCOPED_TRACE(name);
		const Stage start = stageOf(soup);
		const int euler = start.mesh.eulerCharacteristic();
		ASSERT_EQ(euler, 2 * (components - genus));
		int calls = 0;
		const Stage end =
			contractToSkeleton(start, Parameters(), Progress(), {[&](const Stage& stage) {
				EXPECT_EQ(stage.iteration, ++calls);
				ASSERT_EQ(checks::stageError(stage), "");
				ASSERT_EQ(stage.mesh.eulerCharacteristic(), euler);
			}});
		EXPECT_TRUE(end.converged);
		EXPECT_EQ(end.iteration, calls);
		EXPECT_LT(end.iteration, 250); // most need 30; the torus of 7 vertices is all folds
		EXPECT_TRUE(end.volumeFraction() < 1e-3 || end.fixedFraction() > 0.5)
			<< end.volumeFraction();
		const CurveSkeleton skeleton = collapseToCurve(end);
		EXPECT_EQ(checks::skeletonError(skeleton), "");
		const SkeletonStatistics s = statistics(skeleton);
		EXPECT_EQ(s.components, components);
		EXPECT_EQ(s.cycles, genus);
	}
}

TEST(Flow, BodiesWithinEachOtherContractAsTheyDoAlone)
{
	const std::vector<shapes::Soup> bodies = {
		shapes::sphere(4), shapes::sphere(3, 0.6), shapes::torus(0.8, 0.1)};
	const auto iterationsOf = [](const shapes::Soup& soup) {
		return contractToSkeleton(stageOf(soup), Parameters()).iteration;
	};
	int maximum = 0;
	for (const shapes::Soup& body : bodies)
		maximum = std::max(maximum, iterationsOf(body));
	// The flow ends when the area of all of them stops changing: perhaps an iteration later.
	EXPECT_LE(iterationsOf(shapes::joined({bodies[0], bodies[1], bodies[2]})), maximum + 1);
}

TEST(Flow, ConvergesOnEveryMeshOfTheFolder)
{
	const struct
	{
		const char* name;
		int components, genus;
	} cases[] = {{"capsule", 1, 0}, {"torus", 1, 1}, {"knot", 1, 1}, {"torus_capsule", 2, 1},
		{"plate3", 1, 3}, {"slab", 1, 0}, {"cuboid", 1, 0}, {"hand", 1, 0}, {"letter_p", 1, 1},
		{"animal", 1, 0}, {"box8", 1, 0}, {"torus72", 1, 1}};
	for (const auto& [name, components, genus] : cases) {
		SCOPED_TRACE(name);
		const Stage stage = contractToSkeleton(stageOf(shapes::fromFile(name)), Parameters());
		EXPECT_TRUE(stage.converged);
		EXPECT_LT(stage.volumeFraction(), 1e-3);
		EXPECT_EQ(checks::stageError(stage), "");
		const CurveSkeleton skeleton = collapseToCurve(stage);
		EXPECT_EQ(checks::skeletonError(skeleton), "");
		EXPECT_EQ(statistics(skeleton).components, components);
		EXPECT_EQ(statistics(skeleton).cycles, genus);
	}
}

// Known skeletons.

TEST(Flow, ACapsuleContractsToItsAxis)
{
	for (PoleMethod method : {PoleMethod::Balls, PoleMethod::Voronoi}) {
		const Stage stage =
			contractToSkeleton(stageOf(shapes::fromFile("capsule"), method), Parameters());
		const auto toAxis = [](const Point3d& p) {
			return distanceToSegment(p, {-1, 0, 0}, {1, 0, 0});
		};
		EXPECT_LT(largestDistance(stage, toAxis), 0.01 * stage.diagonal[0]);
		const CurveSkeleton skeleton = collapseToCurve(stage);
		const SkeletonStatistics s = statistics(skeleton);
		EXPECT_EQ(s.branches, 1);
		EXPECT_EQ(s.terminals, 2);
		EXPECT_EQ(s.junctions, 0);
		EXPECT_NEAR(s.length, 2, 0.2); // between the centres of the end balls; tips end early
		for (size_t v = 0; v < skeleton.position.size(); ++v)
			if (std::abs(skeleton.position[v][0]) < 0.8) {
				EXPECT_NEAR(skeleton.radius[v], 0.35, 0.02);
			}
	}
}

TEST(Flow, ATorusContractsToItsCircle)
{
	const Stage stage = contractToSkeleton(stageOf(shapes::fromFile("torus")), Parameters());
	const auto toCircle = [](const Point3d& p) {
		return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]);
	};
	EXPECT_LT(largestDistance(stage, toCircle), 0.01 * stage.diagonal[0]);
	const CurveSkeleton skeleton = collapseToCurve(stage);
	const SkeletonStatistics s = statistics(skeleton);
	EXPECT_EQ(s.branches, 1); // one free cycle
	EXPECT_EQ(s.terminals, 0);
	EXPECT_NEAR(s.length, 2 * M_PI, 0.1);
	for (double r : skeleton.radius)
		EXPECT_NEAR(r, 0.3, 0.02);
}

TEST(Flow, ASphereContractsToItsCentre)
{
	const Stage stage =
		contractToSkeleton(stageOf(shapes::moved(shapes::sphere(4), {1, 2, 3})), Parameters());
	const auto toCentre = [](const Point3d& p) { return vcg::Distance(p, Point3d(1, 2, 3)); };
	EXPECT_LT(largestDistance(stage, toCentre), 0.01 * stage.diagonal[0]);
}

TEST(Flow, SurfaceVerticesGoToTheirPartOfTheSkeleton)
{
	const Stage stage = contractToSkeleton(stageOf(shapes::fromFile("capsule")), Parameters());
	for (size_t s = 0; s < stage.node.size(); ++s) {
		const double x = std::clamp((*stage.surface)[s][0], -1.0, 1.0);
		EXPECT_NEAR(stage.mesh.position[stage.node[s]][0], x, 0.15);
	}
}

// One run, many steps.

TEST(Flow, StepsAreTheRunBitForBit)
{
	for (const shapes::Soup& soup : {shapes::fromFile("hand"), shapes::plate(3, 3),
			 shapes::joined({shapes::torus(), shapes::moved(shapes::capsule(), {4, 0, 0})})}) {
		const Parameters parameters;
		std::vector<Stage> kept;
		const Stage run = contractToSkeleton(stageOf(soup), parameters, Progress(),
			{[&](Stage stage) { kept.push_back(std::move(stage)); }});
		Stage single = stageOf(soup);
		for (const Stage& stage : kept) {
			const Stage before = single;
			single = step(before, parameters);
			ASSERT_TRUE(checks::sameBits(single, stage)) << "iteration " << stage.iteration;
		}
		EXPECT_TRUE(checks::sameBits(single, run));
		// A run that carries on from a stage in the middle ends the same.
		EXPECT_TRUE(checks::sameBits(contractToSkeleton(kept[kept.size() / 2], parameters), run));
	}
}

TEST(Flow, TheCorrespondenceOfADenseSurfaceIsThatOfItsSteps)
{
	const shapes::Soup soup = shapes::torus(1, 0.3, 240, 80);
	Parameters parameters;
	parameters.epsilon = 0.02;
	parameters.maxIterations = 5;
	const Stage start = firstStageOf(soup.mesh(), parameters);
	ASSERT_GT(start.node.size(), 4 * size_t(start.mesh.vertexCount()));
	const Stage unwatched = contractToSkeleton(start, parameters);
	const Stage watched = contractToSkeleton(start, parameters, Progress(),
		{[&](const Stage& stage) { EXPECT_EQ(stage.node.size(), start.node.size()); }});
	EXPECT_TRUE(checks::sameBits(unwatched, watched));
}

TEST(Flow, ThoseWhoWatchSeeEachStageAsItIs)
{
	for (const Stage& start : {stageOf(shapes::fromFile("hand")),
			 firstStageOf(shapes::torus(1, 0.3, 240, 80).mesh(), Parameters())}) {
		std::vector<Stage> every, third;
		std::vector<StageFigures> figures;
		contractToSkeleton(start, Parameters(), Progress(),
			{[&](Stage stage) { every.push_back(std::move(stage)); }});
		const Stage end = contractToSkeleton(start, Parameters(), Progress(),
			{[&](Stage stage) { third.push_back(std::move(stage)); }, 3,
				[&](const StageFigures& f) { figures.push_back(f); }});
		ASSERT_EQ(int(every.size()), end.iteration);
		ASSERT_EQ(figures.size(), every.size());
		ASSERT_EQ(third.size(), every.size() / 3);
		for (size_t i = 0; i < third.size(); ++i)
			EXPECT_TRUE(checks::sameBits(third[i], every[3 * i + 2]));
		for (size_t i = 0; i < every.size(); ++i) {
			const StageFigures& seen = figures[i];
			EXPECT_EQ(seen.iteration, int(i) + 1);
			EXPECT_EQ(seen.converged, every[i].converged);
			EXPECT_EQ(seen.vertices, every[i].mesh.vertexCount());
			EXPECT_EQ(seen.faces, every[i].mesh.faceCount());
			EXPECT_EQ(seen.areaFraction, every[i].areaFraction());
			EXPECT_EQ(seen.volumeFraction, every[i].volumeFraction());
			EXPECT_EQ(seen.fixedFraction, every[i].fixedFraction());
		}
		EXPECT_TRUE(checks::sameBits(every.back(), end));
	}
}

TEST(Flow, TwoRunsAreBitEqual)
{
	const shapes::Soup soup = shapes::fromFile("animal");
	EXPECT_TRUE(checks::sameBits(contractToSkeleton(stageOf(soup), Parameters()),
		contractToSkeleton(stageOf(soup), Parameters())));
}

TEST(Flow, AStepLeavesTheGivenStageAsItWas)
{
	const Stage start = stageOf(shapes::torus()), copy = start;
	const Stage next = step(start, Parameters());
	EXPECT_TRUE(checks::sameBits(start, copy));
	EXPECT_EQ(next.iteration, 1);
	EXPECT_FALSE(checks::sameBits(next, start));
}

TEST(Flow, AConvergedStageStaysAsItIs)
{
	const Stage end = contractToSkeleton(stageOf(shapes::torus()), Parameters());
	ASSERT_TRUE(end.converged);
	EXPECT_TRUE(checks::sameBits(step(end, Parameters()), end));
	EXPECT_TRUE(checks::sameBits(contractToSkeleton(end, Parameters()), end));
}

TEST(Flow, StopsAtTheCapAndSaysSo)
{
	Parameters parameters;
	for (int cap : {0, 1, 3}) {
		parameters.maxIterations = cap;
		const Stage stage = contractToSkeleton(stageOf(shapes::fromFile("hand")), parameters);
		EXPECT_EQ(stage.iteration, cap);
		EXPECT_FALSE(stage.converged);
	}
}

TEST(Flow, GivesUpWhatItSpreads)
{
	// A bowl of few facets whose walls pass through each other: in between it is inside out, and so are its balls.
	std::vector<std::pair<double, double>> profile;
	const auto wall = [&](double radius, int from, int to) {
		for (int i = from; i != to; i += from < to ? 1 : -1)
			profile.emplace_back(-radius * std::cos(0.2 * i), radius * std::sin(0.2 * i));
	};
	wall(1, 0, 14);
	wall(0.995, 13, -1);
	shapes::Soup bowl = shapes::revolved(profile, 14);
	for (int i = 0; i < 3; ++i)
		bowl = shapes::subdivided(bowl);
	const Stage stage = contractToSkeleton(stageOf(bowl), Parameters());
	EXPECT_TRUE(stage.isSpread());
	EXPECT_FALSE(stage.converged);
	EXPECT_LT(stage.iteration, Parameters().maxIterations / 4);
}

TEST(Flow, ASceneOfManyFlatBodiesSettles)
{
	// Epsilon is 2.4 times the default: in a few bodies triangles with such edges oscillate forever.
	constexpr int bodies = 300, inARow = 20;
	shapes::Soup scene;
	for (int i = 0; i < bodies; ++i) {
		const shapes::Soup body =
			shapes::transformed(shapes::jittered(shapes::tetrahedron(), 0.4, unsigned(i)),
				[](const Point3d& p) { return Point3d(p[0], p[1], 0.3 * p[2]); });
		scene = shapes::joined(
			{scene, shapes::moved(body, {5.0 * (i % inARow), 5.0 * (i / inARow), 0})});
	}
	Parameters parameters;
	parameters.poleMethod = PoleMethod::Balls;
	const SurfaceMesh surface = resampledSurface(scene.mesh(), parameters).mesh;
	const Stage stage = contractToSkeleton(firstStageOf(surface, parameters), parameters);
	EXPECT_TRUE(stage.converged);
	EXPECT_LT(stage.iteration, parameters.maxIterations / 4);
	EXPECT_LT(stage.volumeFraction(), 1e-3);
}

TEST(Flow, ASlowFlowIsNotTakenForAFinishedOne)
{
	// With a large w_H a step hardly moves anything: the area settles long before the volume is gone.
	Parameters parameters;
	parameters.maxIterations = 20;
	parameters.wM = 0;
	for (double wH : {2000.0, 20000.0, 1e6}) {
		parameters.wH = wH;
		const Stage stage = contractToSkeleton(stageOf(shapes::capsule()), parameters);
		EXPECT_GT(stage.volumeFraction(), 0.5);
		EXPECT_FALSE(stage.converged) << "w_H " << wH;
	}
}

// What the parameters do.

TEST(Flow, VolumeFallsWithEachIteration)
{
	double volume = 1;
	StageObserver observer;
	observer.onFigures = [&](const StageFigures& figures) {
		EXPECT_LT(figures.volumeFraction, volume + 1e-4);
		volume = figures.volumeFraction;
	};
	contractToSkeleton(stageOf(shapes::fromFile("hand")), Parameters(), Progress(), observer);
	EXPECT_LT(volume, 1e-3);
}

TEST(Flow, AFinerEpsilonLeavesMoreVertices)
{
	std::vector<int> left;
	for (double epsilon : {0.001, 0.002, 0.004, 0.008}) {
		Parameters parameters;
		parameters.epsilon = epsilon;
		left.push_back(
			contractToSkeleton(stageOf(shapes::fromFile("y_tube")), parameters).mesh.vertexCount());
	}
	EXPECT_TRUE(std::is_sorted(left.rbegin(), left.rend()));
	EXPECT_GT(left.front(), 2 * left.back());
}

TEST(Flow, ALargerWeightRatioTakesFewerIterationsAndSpoilsTheEmbedding)
{
	// The sweep of Fig. 5: w_H = 20, w_M = 0. Over several shapes: on a single one a few iterations in
	// which the area hardly changes may come or go at the end.
	std::vector<int> iterations;
	std::vector<double> length; // of the curves, in diagonals
	for (double wL : {1.5, 6.0, 24.0}) {
		Parameters parameters;
		parameters.wL = wL;
		parameters.wM = 0;
		iterations.push_back(0);
		length.push_back(0);
		for (const char* name : {"horn", "twin_ears", "taper"}) {
			const Stage stage = contractToSkeleton(stageOf(shapes::fromFile(name)), parameters);
			EXPECT_TRUE(stage.converged) << name;
			iterations.back() += stage.iteration;
			length.back() += statistics(collapseToCurve(stage)).length / stage.diagonal[0];
		}
	}
	EXPECT_LT(iterations[1], iterations[0]);
	EXPECT_LT(iterations[2], iterations[1]);
	EXPECT_LT(2 * iterations[2], iterations[0]); // in the paper 2 of 26
	// "A severe effect on the quality of the embedding": limbs are lost.
	EXPECT_LT(length[1], length[0]);
	EXPECT_LT(length[2], 0.8 * length[0]);
}

TEST(Flow, ATubeTakesAsManyIterationsAsTheClosedFormSays)
{
	// The sweep of Fig. 5 once more. One step divides the radius r of a tube by 1 + (w_L l / w_H)^2 (Theory,
	// OneStepShrinksATubeAsTheClosedFormSays), where l = 2 (b / a) (2 - 2 cos(2 pi / n)) for n vertices across, sides a
	// across, which shrink with r, and b along, which do not. The text's weights carry 1 / length: of (1, 20, 40) for edges
	// of 0.005 units w_H and w_M are in proportion to the edges.
	constexpr int across = 30;
	constexpr double major = 6, edges = 0.03, end = 0.1; // a hundredth of the volume
	const double a = 2 * std::sin(M_PI / across);
	const int around = int(std::round(2 * M_PI * major / a));
	const double b = 2 * M_PI * major / around;
	const SurfaceMesh mesh = shapes::torus(major, 1, around, across).mesh();
	const double volume = mesh.volume();
	for (double wL : {1.5, 3.0, 6.0, 12.0, 24.0}) {
		const double wH = 20 * edges / 0.005;
		int expected = 0;
		for (double r = 1; r > end; ++expected) {
			const double l = 2 * (b / (a * r)) * (2 - 2 * std::cos(2 * M_PI / across));
			r /= 1 + std::pow(wL * l / (0.1 * wH / 20), 2);
		}
		Parameters parameters;
		parameters.cotangentFactor = 1;
		parameters.wL = wL;
		parameters.wH = wH;
		parameters.wM = 0;
		Stage stage = initialStage(mesh, checks::noPoles(mesh));
		while (stage.mesh.volume() > end * end * volume && stage.iteration < 100)
			stage = step(std::move(stage), parameters);
		EXPECT_NEAR(stage.iteration, expected, 1) << "w_L " << wL;
	}
}

TEST(Flow, SolvedDirectlyItLeadsToTheSameSkeleton)
{
	// By default a step is solved to a hundredth. What that leaves must not add up: the curves are less than epsilon
	// apart, as an edge of theirs is long.
	for (const char* name : {"capsule", "bent_tube", "torus"}) {
		SCOPED_TRACE(name);
		const Stage start = stageOf(shapes::fromFile(name));
		Parameters exact;
		exact.directSolver = true;
		const Stage direct = contractToSkeleton(start, exact);
		const Stage usual = contractToSkeleton(start, Parameters());
		EXPECT_TRUE(direct.converged && usual.converged);
		const CurveSkeleton a = collapseToCurve(direct), b = collapseToCurve(usual);
		EXPECT_EQ(statistics(a).terminals, statistics(b).terminals);
		EXPECT_EQ(statistics(a).junctions, statistics(b).junctions);
		EXPECT_EQ(statistics(a).cycles, statistics(b).cycles);
		const double epsilon = exact.epsilon * start.diagonal[0];
		for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
			double sum = 0;
			for (const Point3d& p : from->position) {
				double nearest = std::numeric_limits<double>::max();
				for (const auto& [v, w] : to->edges)
					nearest =
						std::min(nearest, distanceToSegment(p, to->position[v], to->position[w]));
				sum += nearest;
			}
			EXPECT_LT(sum / double(from->position.size()), epsilon);
		}
	}
}

TEST(Flow, DoesNotDependOnTheUnit)
{
	// Powers of two are exact: the same bits, scaled.
	const shapes::Soup soup = shapes::fromFile("y_tube");
	const Stage stage = contractToSkeleton(stageOf(soup), Parameters());
	for (double factor : {std::ldexp(1.0, -20), std::ldexp(1.0, 20)}) {
		const Stage other = contractToSkeleton(stageOf(shapes::scaled(soup, factor)), Parameters());
		EXPECT_EQ(other.mesh.triangles(), stage.mesh.triangles());
		for (int v = 0; v < std::min(other.mesh.vertexCount(), stage.mesh.vertexCount()); ++v)
			EXPECT_EQ(other.mesh.position[v], stage.mesh.position[v] * factor);
	}
}

TEST(Flow, ScaleAndPlaceLeaveTheSkeletonWhereItBelongs)
{
	// Rounding differs here, so single vertices may: the skeleton's place and shape may not.
	const shapes::Soup soup = shapes::fromFile("capsule");
	for (double scale : {1e-6, 1e6})
		for (double shift : {0.0, 100.0}) {
			const Point3d by = Point3d(1, -2, 3) * (shift * scale);
			const Stage stage = contractToSkeleton(
				stageOf(shapes::moved(shapes::scaled(soup, scale), by)), Parameters());
			EXPECT_TRUE(stage.converged);
			const auto toAxis = [&](const Point3d& p) {
				return distanceToSegment((p - by) / scale, {-1, 0, 0}, {1, 0, 0});
			};
			EXPECT_LT(largestDistance(stage, toAxis), 0.03);
			EXPECT_NEAR(statistics(collapseToCurve(stage)).length / scale, 2, 0.2);
		}
}

TEST(Flow, ComponentsAreTreatedAsTheyWouldBeAlone)
{
	const shapes::Soup alone = shapes::fromFile("capsule");
	const Stage one = contractToSkeleton(stageOf(alone), Parameters());
	const Stage both = contractToSkeleton(
		stageOf(shapes::joined({alone, shapes::moved(shapes::scaled(alone, 1024), {0, 0, 8192})})),
		Parameters());
	ASSERT_EQ(both.diagonal.size(), 2u);
	int small = 0;
	for (int v = 0; v < both.mesh.vertexCount(); ++v)
		small += both.component[v] == 0;
	// The small one goes through as many iterations as it needs alone, or as the other needs.
	EXPECT_NEAR(small, one.mesh.vertexCount(), 0.1 * one.mesh.vertexCount());
	EXPECT_NEAR(both.mesh.vertexCount() - small, small, 0.1 * small);
}

// Progress.

TEST(Flow, ProgressGoesForward)
{
	int last = 0;
	contractToSkeleton(
		stageOf(shapes::torus()), Parameters(), Progress([&](int percent, const char* what) {
			EXPECT_GE(percent, last);
			EXPECT_LE(percent, 100);
			EXPECT_STRNE(what, "");
			last = percent;
			return true;
		}));
	EXPECT_EQ(last, 100);
}

TEST(Flow, CanBeCancelledAtAnyReport)
{
	const Stage start = stageOf(shapes::torus()), copy = start;
	int reports = 0;
	step(start, Parameters(), Progress([&](int, const char*) { return ++reports > 0; }));
	ASSERT_GT(reports, 3); // inside the step, not only between steps
	for (int stopAt = 1; stopAt <= reports; ++stopAt) {
		int count = 0;
		const Progress progress([&](int, const char*) { return ++count < stopAt; });
		EXPECT_THROW(step(start, Parameters(), progress), Cancelled);
		EXPECT_EQ(count, stopAt); // nothing is done after the answer
	}
	EXPECT_TRUE(checks::sameBits(start, copy));
}
