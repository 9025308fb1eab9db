// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "graphs.h"

#include <skeleton/io/vtp.h>

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <vector>

using namespace graphs;

namespace {

/// The numbers of an array in a file.
std::vector<double> numbers(const std::string& file, const std::string& name, size_t from = 0)
{
	const size_t at = file.find("Name=\"" + name + "\"", from);
	if (at == file.npos)
		return {};
	const size_t begin = file.find('>', at) + 1;
	std::istringstream text(file.substr(begin, file.find('<', begin) - begin));
	std::vector<double> values;
	for (double value; text >> value;)
		values.push_back(value);
	return values;
}

std::string vtp(const CurveSkeleton& skeleton)
{
	return written([&](std::ostream& out) { writeVtp(out, skeleton); });
}

} // namespace

TEST(Vtp, LinesHoldEachEdgeOnce)
{
	const CurveSkeleton s = ringWithTailAndY();
	const std::string file = vtp(s);
	const size_t lines = file.find("<Lines>");
	const std::vector<double> points = numbers(file, "connectivity", lines);
	const std::vector<double> ends = numbers(file, "offsets", lines);
	std::vector<std::array<int, 2>> edges;
	size_t i = 0;
	for (double end : ends) {
		for (++i; i < size_t(end); ++i)
			edges.push_back({int(points[i - 1]), int(points[i])});
	}
	EXPECT_EQ(tidyEdges(edges), 0);
	EXPECT_EQ(edges, s.edges);
	EXPECT_EQ(int(ends.size()), statistics(s).branches);
	for (const char* name : {"GroupIds", "CenterlineIds", "TractIds", "Blanking"})
		EXPECT_EQ(numbers(file, name).size(), ends.size()) << name;
}

TEST(Vtp, NumbersAreWrittenToTheLastBit)
{
	CurveSkeleton s = ringWithTailAndY();
	s.significance = {1, 1, 1, 1, 1, 1.0 / 3, 1.0 / 3, 1, 0.7, 1, 1};
	const std::string file = vtp(s);
	EXPECT_EQ(numbers(file, "MaximumInscribedSphereRadius"), s.radius);
	EXPECT_EQ(numbers(file, "mcfskel_significance"), s.significance);
	const std::vector<double> points = numbers(file, "Points");
	ASSERT_EQ(points.size(), 3 * s.position.size());
	for (size_t i = 0; i < points.size(); ++i)
		EXPECT_EQ(points[i], s.position[i / 3][int(i % 3)]);
	EXPECT_EQ(numbers(file, "mcfskel_node"), std::vector<double>(s.node.begin(), s.node.end()));
}

TEST(Vtp, AnIsolatedNodeIsACellThatIsNoBranch)
{
	CurveSkeleton s = ringWithTailAndY();
	s.position.emplace_back(1, 2, 3);
	s.radius.push_back(1);
	const std::string file = vtp(s);
	EXPECT_EQ(numbers(file, "connectivity", file.find("<Verts>")), std::vector<double> {11});
	EXPECT_EQ(numbers(file, "GroupIds").front(), -1);
	EXPECT_EQ(numbers(file, "Blanking").front(), 1);
	EXPECT_EQ(numbers(file, "Blanking").back(), 0);
}

TEST(Vtp, WhatIsNotKnownIsLeftOutAndWhatCannotBeIsRefused)
{
	CurveSkeleton s = ringWithTailAndY();
	s.radius.clear();
	s.node.clear();
	const std::string file = vtp(s);
	EXPECT_EQ(file.find("MaximumInscribedSphereRadius"), file.npos);
	EXPECT_EQ(file.find("mcfskel_node"), file.npos);
	EXPECT_EQ(file.find("PointData"), file.npos);
	s.position[4][1] = std::numeric_limits<double>::infinity();
	EXPECT_THROW(vtp(s), InvalidInput);
}

TEST(Vtp, IntegersAreWrittenWithoutExponents)
{
	// 100000 as a double is "1e+05", at which VTK stops reading an array of integers.
	constexpr int nodes = 100001;
	CurveSkeleton s;
	for (int i = 0; i < nodes; ++i) {
		s.position.emplace_back(i, 0, 0);
		s.radius.push_back(1);
		s.node.push_back(i);
		if (i > 0)
			s.edges.push_back({i - 1, i});
	}
	const std::string file = vtp(s);
	int arrays = 0;
	for (size_t at = file.find("type=\"Int"); at != file.npos;
		 at = file.find("type=\"Int", at + 1)) {
		const size_t begin = file.find('>', at) + 1;
		EXPECT_EQ(file.substr(begin, file.find('<', begin) - begin).find('e'), file.npos)
			<< file.substr(at, 60);
		++arrays;
	}
	EXPECT_EQ(arrays, 9);
	EXPECT_EQ(numbers(file, "mcfskel_node").back(), nodes - 1);
}
