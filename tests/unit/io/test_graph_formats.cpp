// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// GraphML and JSON as text; that graph libraries read them is tested through pymeshlab.

#include "graphs.h"

#include <skeleton/io/graphml.h>
#include <skeleton/io/json.h>

#include <gtest/gtest.h>

using namespace graphs;

namespace {

size_t countOf(const std::string& text, const std::string& part)
{
	size_t count = 0;
	for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
		++count;
	return count;
}

std::string graphml(const CurveSkeleton& s)
{
	return written([&](std::ostream& out) { writeGraphml(out, s); });
}

std::string json(const CurveSkeleton& s)
{
	return written([&](std::ostream& out) { writeJson(out, s); });
}

} // namespace

TEST(SourceVertices, InvertTheCorrespondence)
{
	const std::vector<std::vector<int>> sources = sourceVertices(ringWithTailAndY());
	EXPECT_EQ(sources[0], (std::vector<int> {1, 2}));
	EXPECT_EQ(sources[10], (std::vector<int> {0}));
	EXPECT_TRUE(sources[1].empty());
}

TEST(Graphml, HasEveryNodeEdgeAndAttribute)
{
	const std::string text = graphml(ringWithTailAndY());
	EXPECT_EQ(countOf(text, "<node id="), 11u);
	EXPECT_EQ(countOf(text, "<edge source="), 10u);
	EXPECT_EQ(countOf(text, "<data key=\"radius\">"), 11u);
	EXPECT_EQ(countOf(text, "<data key=\"length\">"), 10u);
	EXPECT_EQ(countOf(text, "<data key=\"surface_vertices\">1 2</data>"), 1u);
}

TEST(Json, HasEveryNodeEdgeAndAttribute)
{
	const std::string text = json(ringWithTailAndY());
	EXPECT_EQ(countOf(text, "\"id\": "), 11u);
	EXPECT_EQ(countOf(text, "\"source\": "), 10u);
	EXPECT_EQ(countOf(text, "\"radius\": "), 11u);
	EXPECT_EQ(countOf(text, "\"surface_vertices\": [1, 2]"), 1u);
	EXPECT_EQ(countOf(text, "\"cycles\": 1,"), 1u);
}

TEST(GraphFormats, HaveTheSignificanceWhereItIsKnown)
{
	CurveSkeleton s = ringWithTailAndY();
	for (const std::string& text : {graphml(s), json(s)})
		EXPECT_EQ(countOf(text, "significance"), 0u);
	s.significance.assign(s.position.size(), 1);
	s.significance[6] = 0.375;
	EXPECT_EQ(countOf(graphml(s), "<data key=\"significance\">"), 11u);
	EXPECT_EQ(countOf(graphml(s), "<data key=\"significance\">0.375</data>"), 1u);
	EXPECT_EQ(countOf(json(s), "\"significance\": "), 11u);
	EXPECT_EQ(countOf(json(s), "\"significance\": 0.375"), 1u);
	for (double value : {-0.1, 1.1, double(NAN)}) {
		s.significance[6] = value;
		EXPECT_THROW(graphml(s), InvalidInput);
	}
	s.significance.resize(3);
	EXPECT_THROW(json(s), InvalidInput);
}

TEST(GraphFormats, LeaveOutWhatIsNotKnown)
{
	CurveSkeleton s = ringWithTailAndY();
	s.radius.clear();
	s.node.clear();
	for (const std::string& text : {graphml(s), json(s)}) {
		EXPECT_EQ(countOf(text, "radius"), 0u);
		EXPECT_EQ(countOf(text, "surface_vertices"), 0u);
	}
}

TEST(GraphFormats, RefuseRadiiAndCoordinatesThatCannotBe)
{
	const auto refused = [](const CurveSkeleton& s) {
		EXPECT_THROW(graphml(s), InvalidInput);
		EXPECT_THROW(json(s), InvalidInput);
	};
	for (double value : {double(INFINITY), double(NAN), -1.0, 1e37}) {
		CurveSkeleton s = ringWithTailAndY();
		s.radius[4] = value;
		refused(s);
	}
	for (double value : {double(INFINITY), double(NAN), -1e37}) {
		CurveSkeleton s = ringWithTailAndY();
		s.position[4][1] = value;
		refused(s);
	}
}
