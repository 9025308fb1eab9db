// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "graphs.h"

#include <skeleton/io/glb.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace graphs;

namespace {

constexpr double tolerance = 0.05;

/// A stem that bends in a half circle of radius 1 and then forks into straight arms; radius 0.2.
CurveSkeleton bentStemWithFork(int arms)
{
	constexpr int n = 60;
	CurveSkeleton s;
	for (int i = 0; i <= n; ++i) {
		const double angle = M_PI * i / n;
		s.position.emplace_back(-std::cos(angle), std::sin(angle), 0);
		if (i)
			s.edges.push_back({i - 1, i});
	}
	for (int arm = 0; arm < arms; ++arm)
		for (int i = 1; i <= 20; ++i) {
			const double angle = 2 * M_PI * arm / arms;
			s.edges.push_back({i == 1 ? n : int(s.position.size()) - 1, int(s.position.size())});
			s.position.push_back(
				s.position[n] + Point3d(std::cos(angle), -1, std::sin(angle)) * (0.1 * i));
		}
	s.radius.assign(s.position.size(), 0.2);
	s.radius[0] = 0.3; // the root
	return s;
}

double weightOf(const Armature& armature, int node, int bone)
{
	for (const auto& [b, weight] : armature.weights[size_t(node)])
		if (b == bone)
			return weight;
	return 0;
}

double distanceToLine(const Point3d& p, const Point3d& a, const Point3d& b)
{
	return ((p - a) ^ (b - a)).Norm() / (b - a).Norm();
}

} // namespace

TEST(Armature, BonesFollowTheCurveWithinTheTolerance)
{
	const CurveSkeleton s = bentStemWithFork(3);
	const Armature armature = makeArmature(s, tolerance);
	int straight = 0;
	std::map<std::pair<int, int>, int> covered;
	for (const Bone& bone : armature.bones) {
		for (size_t i = 1; i < bone.nodes.size(); ++i) {
			++covered[std::minmax(bone.nodes[i - 1], bone.nodes[i])];
			EXPECT_LE(distanceToLine(s.position[size_t(bone.nodes[i])],
						  s.position[size_t(bone.head())], s.position[size_t(bone.tail())]),
				tolerance);
		}
		straight += bone.nodes.size() == 21; // an arm in one piece
		if (!bone.isRoot()) {
			const Bone& parent = armature.bones[size_t(bone.parent)];
			EXPECT_EQ(parent.tail(), bone.head());
		}
	}
	EXPECT_EQ(straight, 3);
	// A chord of a unit circle at a distance of 0.05 spans 0.635 rad: five at least, ten would be idle.
	EXPECT_GE(armature.bones.size(), 1 + 5 + 3u);
	EXPECT_LE(armature.bones.size(), 1 + 9 + 3u);
	EXPECT_EQ(covered.size(), s.edges.size());
	for (const auto& [edge, times] : covered)
		EXPECT_EQ(times, 1);
}

TEST(Armature, WeightsAddUpAndAreContinuousAlongTheCurve)
{
	for (int arms : {1, 2, 3}) {
		const CurveSkeleton s = bentStemWithFork(arms);
		const Armature armature = makeArmature(s, tolerance);
		for (size_t v = 0; v < s.position.size(); ++v) {
			double sum = 0;
			for (const auto& [bone, weight] : armature.weights[v]) {
				EXPECT_GT(weight, 0);
				sum += weight;
			}
			EXPECT_NEAR(sum, 1, 1e-12);
			EXPECT_LE(armature.weights[v].size(), 4u);
		}
		// Over the radius of 0.2 a weight passes from a half to all or nothing.
		for (const auto& [a, b] : s.edges)
			for (int bone = 0; bone < int(armature.bones.size()); ++bone)
				EXPECT_LE(std::abs(weightOf(armature, a, bone) - weightOf(armature, b, bone)),
					Distance(s.position[size_t(a)], s.position[size_t(b)]) / 0.2 + 1e-9);
	}
}

TEST(Armature, TurningAnArmLeavesTheOthersAndMovesItsTipRigidly)
{
	const CurveSkeleton s = bentStemWithFork(3);
	const Armature armature = makeArmature(s, tolerance);
	for (int arm = 0; arm < 3; ++arm) {
		const int tip = 60 + 20 * (arm + 1);
		EXPECT_EQ(armature.weights[size_t(tip)].size(), 1u) << "a tip belongs to one bone";
		for (int other = 0; other < 3; ++other)
			EXPECT_EQ(
				weightOf(armature, 60 + 20 * (other + 1), armature.weights[size_t(tip)][0].first),
				other == arm ? 1 : 0);
	}
}

TEST(Armature, CyclesAreCutAndEachComponentHasARoot)
{
	const Armature armature = makeArmature(ringWithTailAndY(), 1e-3);
	int roots = 0;
	for (size_t b = 0; b < armature.bones.size(); ++b) {
		roots += armature.bones[b].isRoot();
		EXPECT_LT(armature.bones[b].parent, int(b));
	}
	EXPECT_EQ(roots, 2);
}

TEST(Armature, ManyArmsKeepFourWeights)
{
	const CurveSkeleton s = bentStemWithFork(9);
	for (const auto& weights : makeArmature(s, tolerance).weights) {
		double sum = 0;
		for (const auto& [bone, weight] : weights)
			sum += weight;
		EXPECT_LE(weights.size(), 4u);
		EXPECT_NEAR(sum, 1, 1e-12);
	}
}

TEST(Glb, ChunksHaveTheSizesThatTheirHeadersSay)
{
	CurveSkeleton s = bentStemWithFork(2);
	const SkinnedSurface surface {
		{Point3d(0, 0, 0), Point3d(1, 0, 0), Point3d(0, 1, 0)}, {{0, 1, 2}}};
	s.node = {0, 60, -1};
	const std::string file = written([&](std::ostream& out) { writeGlb(out, s, surface); });
	const auto word = [&](size_t at) {
		std::uint32_t value = 0;
		for (size_t i = 0; i < 4; ++i)
			value |= std::uint32_t(static_cast<unsigned char>(file[at + i])) << (8 * i);
		return size_t(value);
	};
	ASSERT_EQ(file.substr(0, 4), "glTF");
	EXPECT_EQ(word(8), file.size());
	const size_t json = word(12);
	EXPECT_EQ(json % 4, 0u);
	EXPECT_EQ(file.substr(16, 4), "JSON");
	EXPECT_EQ(word(20 + json), file.size() - 28 - json);
	EXPECT_EQ(word(20 + json) % 4, 0u);
}

TEST(Glb, AnotherSurfaceIsRefused)
{
	CurveSkeleton s = bentStemWithFork(2);
	std::ostringstream out;
	EXPECT_THROW(writeGlb(out, s, {}), InvalidInput);
	s.node = {0, 1};
	EXPECT_THROW(
		writeGlb(out, s, {{Point3d(0, 0, 0), Point3d(1, 0, 0), Point3d(0, 1, 0)}, {{0, 1, 2}}}),
		InvalidInput);
	EXPECT_EQ(out.str(), "");
}

TEST(Glb, CanBeCancelledAtEveryReportAndThenWritesNothing)
{
	CurveSkeleton s = bentStemWithFork(2);
	const SkinnedSurface surface {
		{Point3d(0, 0, 0), Point3d(1, 0, 0), Point3d(0, 1, 0)}, {{0, 1, 2}}};
	s.node = {0, 60, -1};
	int reports = 0, last = 0, allowed = 1 << 30;
	std::ostringstream out;
	const auto write = [&] {
		reports = 0;
		writeGlb(out, s, surface, 0, "surface", Progress([&](int percent, const char*) {
			last = percent;
			return ++reports <= allowed;
		}));
	};
	write();
	EXPECT_GT(last, 80);
	out.str("");
	const int count = reports;
	EXPECT_GT(count, 5);
	for (allowed = 0; allowed < count; ++allowed)
		EXPECT_THROW(write(), Cancelled);
	EXPECT_EQ(out.str(), "");
}
