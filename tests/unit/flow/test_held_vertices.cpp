// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/collapse/collapse_to_curve.h>
#include <skeleton/flow/held_vertices.h>
#include <skeleton/poles/poles.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Stage stageOf(const SurfaceMesh& mesh)
{
	return initialStage(mesh, medialPoles(mesh, PoleMethod::Balls));
}

/// 1 where the vertex fulfils the condition.
template <class Condition>
std::vector<char> where(const SurfaceMesh& mesh, Condition&& condition)
{
	std::vector<char> result;
	for (const Point3d& p : mesh.position)
		result.push_back(condition(p));
	return result;
}

/// Whether each held vertex of the surface still has a vertex of the stage to itself, at its place.
bool allStay(const Stage& stage, const std::vector<char>& held)
{
	std::vector<int> owners(stage.held.size(), 0);
	for (size_t s = 0; s < held.size(); ++s) {
		if (!held[s])
			continue;
		const int v = stage.node[s];
		if (++owners[v] > 1 || !stage.held[v] || !stage.fixed[v]
			|| stage.mesh.position[v] != (*stage.surface)[s])
			return false;
	}
	return true;
}

TEST(HeldVertices, StayExactlyThroughTheWholeFlow)
{
	const SurfaceMesh mesh = shapes::capsule(2, 0.35, 32).mesh();
	// The right end, a patch on the side, and single vertices here and there.
	std::vector<char> held = where(mesh,
		[](const Point3d& p) { return p[2] > 1.2 || (p[0] > 0.2 && p[2] > -0.3 && p[2] < 0); });
	for (size_t v = 0; v < held.size(); v += 97)
		held[v] = 1;
	ASSERT_GT(std::count(held.begin(), held.end(), 1), 20);
	Stage stage = stageOf(mesh);
	holdVertices(stage, held);
	const auto onStage = [&](const Stage& s) {
		EXPECT_TRUE(allStay(s, held)) << "iteration " << s.iteration;
		EXPECT_EQ(checks::stageError(s), "");
	};
	const double before = stage.volume;
	stage = contractToSkeleton(std::move(stage), Parameters(), Progress(), {onStage});
	EXPECT_TRUE(stage.converged);
	EXPECT_LT(stage.volume, 0.5 * before) << "the rest contracts";
	EXPECT_EQ(checks::genus(stage.mesh), 0);
}

TEST(HeldVertices, SingleOnesEndAsNodesAtTheirPlace)
{
	const SurfaceMesh mesh = shapes::capsule().mesh();
	const auto byHeight = [](const Point3d& p, const Point3d& q) { return p[2] < q[2]; };
	const auto [low, high] =
		std::minmax_element(mesh.position.begin(), mesh.position.end(), byHeight);
	std::vector<char> held(mesh.position.size(), 0);
	for (const auto end : {low, high})
		held[size_t(end - mesh.position.begin())] = 1;
	Stage stage = stageOf(mesh);
	holdVertices(stage, held);
	const CurveSkeleton curve =
		collapseToCurve(contractToSkeleton(std::move(stage), Parameters()), 0.002);
	for (const auto end : {low, high})
		EXPECT_EQ(curve.position[curve.node[size_t(end - mesh.position.begin())]], *end);
	const auto& p = curve.position;
	EXPECT_EQ(*std::min_element(p.begin(), p.end(), byHeight), *low) << "the curve ends there";
	EXPECT_EQ(*std::max_element(p.begin(), p.end(), byHeight), *high);
	EXPECT_EQ(statistics(curve).cycles, 0);
	EXPECT_EQ(statistics(curve).components, 1);
}

TEST(HeldVertices, AHeldPatchKeepsItsShape)
{
	// Long triangles with wide angles all over: the flow splits edges within the patch, too.
	const SurfaceMesh mesh = shapes::transformed(shapes::sphere(3), [](const Point3d& p) {
		return Point3d(8 * p[0], p[1], p[2]);
	}).mesh();
	const std::vector<char> held = where(mesh, [](const Point3d& p) { return p[0] > 2; });
	Stage stage = stageOf(mesh);
	holdVertices(stage, held);
	const auto patchArea = [](const Stage& s) {
		double area = 0;
		for (int f = 0; f < s.mesh.faceSlots(); ++f) {
			const Triangle t = s.mesh.triangle(f);
			if (s.held[t[0]] && s.held[t[1]] && s.held[t[2]])
				area += s.mesh.doubleAreaVector(f).Norm() / 2;
		}
		return area;
	};
	const double before = patchArea(stage);
	for (int i = 0; i < 6; ++i) {
		stage = step(std::move(stage), Parameters());
		EXPECT_GE(patchArea(stage), before * (1 - 1e-9));
	}
}

TEST(HeldVertices, WithoutThemNothingChanges)
{
	const SurfaceMesh mesh = shapes::torus().mesh();
	Stage plain = stageOf(mesh), none = stageOf(mesh);
	holdVertices(none, std::vector<char>(size_t(mesh.vertexSlots()), 0));
	for (int i = 0; i < 3; ++i) {
		plain = step(std::move(plain), Parameters());
		none = step(std::move(none), Parameters());
	}
	EXPECT_TRUE(checks::sameBits(plain, none));
}

TEST(HeldVertices, ASelectionOfAnotherMeshIsRefused)
{
	Stage stage = stageOf(shapes::torus().mesh());
	EXPECT_THROW(holdVertices(stage, std::vector<char>(3, 1)), InvalidInput);
}

TEST(SelectionOnResampled, SingleVerticesTakeTheNearestRegionsWhatIsInside)
{
	const SurfaceMesh coarse = shapes::sphere(2).mesh(), fine = shapes::sphere(4).mesh();
	std::vector<char> one(coarse.position.size(), 0);
	one[5] = 1;
	const std::vector<char> oneOnFine = selectionOnResampled(coarse, one, fine);
	ASSERT_EQ(std::count(oneOnFine.begin(), oneOnFine.end(), 1), 1);
	const size_t found =
		size_t(std::find(oneOnFine.begin(), oneOnFine.end(), 1) - oneOnFine.begin());
	for (const Point3d& p : fine.position)
		EXPECT_LE(
			Distance(fine.position[found], coarse.position[5]), Distance(p, coarse.position[5]));

	const std::vector<char> half = selectionOnResampled(
		coarse, where(coarse, [](const Point3d& p) { return p[2] > -1e-9; }), fine);
	for (size_t v = 0; v < half.size(); ++v)
		if (const double height = fine.position[v][2]; std::abs(height) > 1e-3)
			EXPECT_EQ(half[v] == 1, height > 0);

	const std::vector<char> none(coarse.position.size(), 0);
	EXPECT_EQ(selectionOnResampled(coarse, none, fine), std::vector<char>(fine.position.size(), 0));
}

} // namespace
