// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/contraction.h>
#include <skeleton/flow/local_remeshing.h>
#include <skeleton/poles/shrinking_balls.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Stage stageWithBalls(const shapes::Soup& soup)
{
	const SurfaceMesh mesh = soup.mesh();
	return initialStage(mesh, shrinkingBallPoles(mesh));
}

/// A stage in which edges are short and angles wide, as after a contraction.
Stage contractedStage(const shapes::Soup& soup)
{
	Stage stage = stageWithBalls(soup);
	contract(stage, Parameters());
	return stage;
}

double angleAtApex(const SurfaceMesh& mesh, int h)
{
	const Point3d& c = mesh.position[mesh.apex(h)];
	const Point3d u = mesh.position[mesh.origin(h)] - c, v = mesh.position[mesh.target(h)] - c;
	return std::atan2((u ^ v).Norm(), u * v) * 180 / M_PI;
}

int liveFixed(const Stage& stage)
{
	int count = 0;
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
		count += stage.mesh.isVertex(v) && stage.fixed[v];
	return count;
}

const shapes::Soup& bodies()
{
	static const shapes::Soup soup =
		shapes::joined({shapes::torus(), shapes::moved(shapes::capsule(2, 0.1, 12), {4, 0, 0}),
			shapes::moved(shapes::plate(2, 3), {0, 4, 0})});
	return soup;
}

} // namespace

// Collapses.

TEST(CollapseShortEdges, LeavesNoShortEdgeThatCouldBeCollapsed)
{
	for (double epsilon : {0.002, 0.02, 0.1}) {
		Stage stage = contractedStage(bodies());
		const int euler = stage.mesh.eulerCharacteristic(), before = stage.mesh.vertexCount();
		MergeForest forest(before);
		const std::vector<int> candidates = collapseShortEdges(stage, epsilon, forest);
		EXPECT_LT(stage.mesh.vertexCount(), before);
		EXPECT_EQ(checks::structureError(stage.mesh), "");
		EXPECT_EQ(stage.mesh.eulerCharacteristic(), euler);
		std::set<int> blocked;
		for (int h = 0; h < stage.mesh.halfEdgeSlots(); ++h)
			if (stage.mesh.isHalfEdge(h)) {
				const double limit =
					epsilon * stage.diagonal[stage.component[stage.mesh.origin(h)]];
				if (std::sqrt(stage.mesh.squaredLength(h)) >= limit)
					continue;
				EXPECT_FALSE(stage.mesh.isCollapsible(h));
				blocked.insert({stage.mesh.origin(h), stage.mesh.target(h)});
			}
		EXPECT_EQ(candidates, std::vector<int>(blocked.begin(), blocked.end()));
	}
}

TEST(CollapseShortEdges, UsesEachComponentsOwnDiagonal)
{
	// A body that is small in a large scene keeps the edges that it would keep alone.
	const auto verticesLeft = [](double scale) {
		Stage stage = stageWithBalls(
			shapes::joined({shapes::plate(3), shapes::scaled(shapes::torus(), scale)}));
		MergeForest forest(stage.mesh.vertexSlots());
		collapseShortEdges(stage, 0.05, forest);
		int count = 0;
		for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
			count += stage.mesh.isVertex(v) && stage.component[v] == 1;
		return count;
	};
	EXPECT_EQ(verticesLeft(std::ldexp(1.0, -10)), verticesLeft(1));
	EXPECT_GT(verticesLeft(1), 20);
}

TEST(CollapseShortEdges, CorrespondenceIsTotal)
{
	Stage stage = contractedStage(bodies());
	const std::vector<int> component = stage.component;
	MergeForest forest(stage.mesh.vertexSlots());
	collapseShortEdges(stage, 0.03, forest);
	std::set<int> standing;
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v) {
		const int w = forest.find(v);
		EXPECT_TRUE(stage.mesh.isVertex(w));
		EXPECT_EQ(component[v], component[w]);
		EXPECT_EQ(stage.mesh.isVertex(v), w == v);
		standing.insert(w);
	}
	EXPECT_EQ(int(standing.size()), stage.mesh.vertexCount());
}

TEST(CollapseShortEdges, FixedVerticesStayWhereTheyAre)
{
	Stage stage = contractedStage(bodies());
	std::mt19937 random(2);
	for (char& f : stage.fixed)
		f = random() % 4 == 0;
	const Stage before = stage;
	const int fixedBefore = liveFixed(stage);
	MergeForest forest(stage.mesh.vertexSlots());
	collapseShortEdges(stage, 0.05, forest);
	ASSERT_LT(stage.mesh.vertexCount(), before.mesh.vertexCount());
	EXPECT_EQ(liveFixed(stage), fixedBefore); // no two fixed vertices have merged
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v)
		if (before.fixed[v]) {
			EXPECT_EQ(stage.mesh.position[forest.find(v)], before.mesh.position[v]);
			EXPECT_TRUE(stage.fixed[forest.find(v)]);
		}
}

TEST(CollapseShortEdges, AnEdgeGoesToItsMiddle)
{
	// One short edge on an otherwise coarse body.
	shapes::Soup soup = shapes::sphere(1);
	SurfaceMesh mesh = soup.mesh();
	const int a = mesh.origin(0), b = mesh.target(0);
	const Point3d middle = (soup.points[a] + soup.points[b]) / 2.0;
	soup.points[a] = middle + (soup.points[a] - middle) * 1e-4;
	soup.points[b] = middle + (soup.points[b] - middle) * 1e-4;
	Stage stage = stageWithBalls(soup);
	MergeForest forest(stage.mesh.vertexSlots());
	EXPECT_TRUE(collapseShortEdges(stage, 0.002, forest).empty());
	EXPECT_EQ(stage.mesh.vertexCount(), int(soup.points.size()) - 1);
	EXPECT_EQ(forest.find(a), forest.find(b));
	EXPECT_LT(vcg::Distance(stage.mesh.position[forest.find(a)], middle), 1e-12);
}

TEST(CollapseShortEdges, TheClosestPoleIsKept)
{
	Stage stage = contractedStage(bodies());
	const Stage before = stage;
	MergeForest forest(stage.mesh.vertexSlots());
	collapseShortEdges(stage, 0.03, forest);
	for (int v = 0; v < stage.mesh.vertexSlots(); ++v) {
		if (!stage.mesh.isVertex(v))
			continue;
		// The pole is one of those of the vertices that merged here.
		bool found = false;
		for (int u = 0; u < before.mesh.vertexSlots() && !found; ++u)
			found = forest.find(u) == v && before.pole[u] == stage.pole[v]
				&& before.poleRadius[u] == stage.poleRadius[v];
		EXPECT_TRUE(found);
	}
	// Of two, the closest to the merged vertex; a pole is better than none.
	shapes::Soup soup = shapes::sphere(1);
	const SurfaceMesh mesh = soup.mesh();
	const int a = mesh.origin(0), b = mesh.target(0);
	soup.points[b] = soup.points[a] + (soup.points[b] - soup.points[a]) * 1e-4;
	for (const bool closerAtA : {true, false})
		for (const bool missingAtOther : {true, false}) {
			Stage one = stageWithBalls(soup);
			const int closer = closerAtA ? a : b, other = closerAtA ? b : a;
			one.pole[closer] = soup.points[a] * 0.5;
			one.pole[other] = missingAtOther ? soup.points[a] : Point3d(soup.points[a] * 0.1);
			one.poleRadius[closer] = 0.5;
			one.poleRadius[other] = missingAtOther ? -1 : 0.9;
			MergeForest merges(one.mesh.vertexSlots());
			collapseShortEdges(one, 0.002, merges);
			const int survivor = merges.find(a);
			EXPECT_EQ(survivor, merges.find(b));
			EXPECT_EQ(one.pole[survivor], soup.points[a] * 0.5);
			EXPECT_EQ(one.poleRadius[survivor], 0.5);
		}
}

TEST(CollapseShortEdges, NeverCollapsesTheSmallestMeshes)
{
	for (const shapes::Soup& soup :
		{shapes::tetrahedron(), shapes::scaled(shapes::tetrahedron(), 1e-6)}) {
		Stage stage = stageWithBalls(soup);
		for (Point3d& p : stage.mesh.position)
			p = p * 1e-6; // all edges are short
		MergeForest forest(4);
		EXPECT_EQ(collapseShortEdges(stage, 0.002, forest), std::vector<int>({0, 1, 2, 3}));
		EXPECT_EQ(stage.mesh.vertexCount(), 4);
	}
	Stage octahedron = stageWithBalls(shapes::octahedron());
	for (Point3d& p : octahedron.mesh.position)
		p = p * 1e-6;
	MergeForest forest(6);
	EXPECT_EQ(collapseShortEdges(octahedron, 0.002, forest).size(), 4u);
	EXPECT_EQ(octahedron.mesh.vertexCount(), 4);
}

TEST(CollapseShortEdges, CoincidentVerticesAllMerge)
{
	Stage stage = stageWithBalls(shapes::sphere(3));
	for (Point3d& p : stage.mesh.position)
		p = Point3d(1, 2, 3);
	MergeForest forest(stage.mesh.vertexSlots());
	collapseShortEdges(stage, 0.002, forest);
	EXPECT_EQ(stage.mesh.vertexCount(), 4);
	EXPECT_EQ(checks::structureError(stage.mesh), "");
}

// Splits.

TEST(SplitWideAngles, LeavesNoEdgeWithBothAnglesWide)
{
	for (double angle : {95.0, 110.0, 130.0, 160.0})
		for (double epsilon : {0.002, 0.02}) {
			Parameters parameters;
			parameters.splitAngle = angle;
			parameters.epsilon = epsilon;
			Stage stage = contractedStage(shapes::jittered(bodies(), 0.03));
			const int euler = stage.mesh.eulerCharacteristic(), before = stage.mesh.vertexCount();
			const double area = stage.mesh.area();
			MergeForest forest(before);
			splitWideAngles(stage, parameters, forest);
			EXPECT_EQ(checks::structureError(stage.mesh), "");
			EXPECT_EQ(stage.mesh.eulerCharacteristic(), euler);
			EXPECT_LT(stage.mesh.vertexCount(), 4 * before);   // the cap is not what ends it
			EXPECT_NEAR(stage.mesh.area(), area, 1e-9 * area); // splits do not change the surface
			for (int h = 0; h < stage.mesh.halfEdgeSlots(); ++h) {
				const int t = stage.mesh.twin(h);
				const double wide =
					std::min(angleAtApex(stage.mesh, h), angleAtApex(stage.mesh, t));
				if (wide < angle + 1e-9)
					continue;
				// Left, because the foot of the widest angle's apex is too close to an end.
				const int e = angleAtApex(stage.mesh, h) > angleAtApex(stage.mesh, t) ? h : t;
				const Point3d a = stage.mesh.position[stage.mesh.origin(e)];
				const Point3d along = stage.mesh.position[stage.mesh.target(e)] - a;
				const double foot =
					(stage.mesh.position[stage.mesh.apex(e)] - a) * along / along.Norm();
				EXPECT_LT(std::min(foot, along.Norm() - foot),
					epsilon * stage.diagonal[stage.component[stage.mesh.origin(e)]] * (1 + 1e-9));
			}
		}
}

TEST(SplitWideAngles, PutsTheNewVertexUnderTheWiderAngle)
{
	// A flat double pyramid over a long edge: both angles opposite it are wide.
	shapes::Soup soup;
	soup.points = {{-1, 0, 0}, {1, 0, 0}, {0.3, 0.2, 0.05}, {-0.2, -0.3, 0.05}, {0, 0, -1}};
	soup.triangles = {{0, 1, 2}, {1, 0, 3}, {1, 4, 2}, {2, 4, 0}, {0, 4, 3}, {3, 4, 1}};
	Stage stage = stageWithBalls(soup);
	MergeForest forest(stage.mesh.vertexSlots());
	splitWideAngles(stage, Parameters(), forest);
	ASSERT_EQ(stage.mesh.vertexCount(), 6);
	EXPECT_LT(vcg::Distance(stage.mesh.position[5], Point3d(0.3, 0, 0)), 1e-12);
	EXPECT_LT(stage.poleRadius[5], 0); // no pole
	EXPECT_FALSE(stage.fixed[5]);
	EXPECT_EQ(stage.component[5], 0);
	EXPECT_EQ(forest.find(5), 5);
	EXPECT_EQ(stage.pole.size(), 6u);
}

TEST(SplitWideAngles, LeavesEvenTrianglesAlone)
{
	for (const shapes::Soup& soup :
		{shapes::sphere(3), shapes::octahedron(), shapes::tetrahedron(), shapes::box()}) {
		Stage stage = stageWithBalls(soup);
		MergeForest forest(stage.mesh.vertexSlots());
		splitWideAngles(stage, Parameters(), forest);
		EXPECT_EQ(stage.mesh.vertexCount(), int(soup.points.size()));
	}
}

TEST(SplitWideAngles, EndsEvenForTheSmallestAngle)
{
	// At 60 degrees an even triangle has nothing to gain: only the length epsilon ends it.
	for (double angle : {60.0, 75.0, 89.0}) {
		Stage stage = contractedStage(shapes::torus());
		Parameters parameters;
		parameters.splitAngle = angle;
		parameters.epsilon = 0.01;
		MergeForest forest(stage.mesh.vertexSlots());
		const int before = stage.mesh.vertexCount();
		splitWideAngles(stage, parameters, forest);
		EXPECT_LE(stage.mesh.vertexCount(), 4 * before + 1000);
		EXPECT_EQ(checks::structureError(stage.mesh), "");
	}
}

TEST(LocalRemeshing, IsDeterministic)
{
	Stage one = contractedStage(bodies()), two = one;
	for (Stage* stage : {&one, &two}) {
		MergeForest forest(stage->mesh.vertexSlots());
		collapseShortEdges(*stage, 0.01, forest);
		splitWideAngles(*stage, Parameters(), forest);
	}
	EXPECT_EQ(one.mesh.position, two.mesh.position);
	EXPECT_EQ(one.mesh.triangles(), two.mesh.triangles());
	EXPECT_EQ(one.pole, two.pole);
}

TEST(LocalRemeshing, DoesNotDependOnScale)
{
	const auto connectivity = [](double scale) {
		Stage stage = contractedStage(bodies());
		for (Point3d& p : stage.mesh.position)
			p *= scale;
		for (double& d : stage.diagonal)
			d *= scale;
		MergeForest forest(stage.mesh.vertexSlots());
		collapseShortEdges(stage, 0.01, forest);
		splitWideAngles(stage, Parameters(), forest);
		return stage.mesh.triangles();
	};
	EXPECT_EQ(connectivity(std::ldexp(1.0, -30)), connectivity(1));
	EXPECT_EQ(connectivity(std::ldexp(1.0, 30)), connectivity(1));
}
