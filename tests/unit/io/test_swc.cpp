// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "graphs.h"

#include <skeleton/io/swc.h>

#include <gtest/gtest.h>

#include <set>

using namespace graphs;

namespace {

size_t lineOfSwcError(const std::string& text)
{
	return errorLine([](std::istream& in) { readSwc(in); }, text);
}

/// The edges of a skeleton under other names.
std::set<std::pair<int, int>> renamed(
	const std::vector<std::array<int, 2>>& edges, const std::vector<int>& name)
{
	std::set<std::pair<int, int>> result;
	for (const auto& [a, b] : edges)
		result.insert(std::minmax(name[size_t(a)], name[size_t(b)]));
	return result;
}

} // namespace

TEST(Swc, ReadsBackAsTheSameGraphWithoutItsCuts)
{
	const CurveSkeleton s = ringWithTailAndY();
	SwcReport report;
	std::istringstream in(written([&](std::ostream& out) { report = writeSwc(out, s); }));
	const CurveSkeleton read = readSwc(in).skeleton;

	ASSERT_EQ(read.position.size(), s.position.size());
	std::vector<int> place;
	for (size_t v = 0; v < s.position.size(); ++v) {
		place.push_back(report.idOfNode[v] - 1);
		EXPECT_EQ(read.position[size_t(place[v])], s.position[v]);
		EXPECT_EQ(read.radius[size_t(place[v])], s.radius[v]);
	}
	std::set<std::pair<int, int>> expected = renamed(s.edges, place);
	for (const auto& cut : renamed(report.cuts, place))
		EXPECT_EQ(expected.erase(cut), 1u) << "a cut is an edge";
	std::vector<int> same(read.position.size());
	std::iota(same.begin(), same.end(), 0);
	EXPECT_EQ(renamed(read.edges, same), expected);
	EXPECT_EQ(statistics(read).cycles, 0);
	EXPECT_EQ(statistics(read).components, statistics(s).components);
}

TEST(Swc, ListsItsCutsInTheFileAndInWarnings)
{
	SwcReport report;
	const std::string text =
		written([&](std::ostream& out) { report = writeSwc(out, ringWithTailAndY()); });
	ASSERT_EQ(report.cuts.size(), 1u);
	ASSERT_EQ(report.warnings.size(), 1u);
	const std::string ids =
		std::to_string(report.idOfNode[3]) + " " + std::to_string(report.idOfNode[4]);
	EXPECT_NE(text.find("# cycle cut between " + ids + "\n"), text.npos);
	EXPECT_NE(report.warnings[0].find("3 and 4"), std::string::npos);
}

TEST(Swc, IdsRunFromOneAndParentsComeFirst)
{
	std::istringstream in(written([](std::ostream& out) { writeSwc(out, ringWithTailAndY()); }));
	FieldReader lines(in);
	int expected = 1;
	while (lines.nextLine()) {
		if (lines.isComment())
			continue;
		ASSERT_EQ(lines.count(), 7u);
		EXPECT_EQ(lines.integer(0, 0, 99, "id"), expected);
		const int parent = lines.integer(6, -1, 99, "parent");
		EXPECT_TRUE(parent == -1 || (parent >= 1 && parent < expected));
		++expected;
	}
	EXPECT_EQ(expected, 12);
}

TEST(Swc, WithoutRadiusSaysSo)
{
	CurveSkeleton s = ringWithTailAndY();
	s.radius.clear();
	SwcReport report;
	std::istringstream in(written([&](std::ostream& out) { report = writeSwc(out, s); }));
	EXPECT_EQ(report.warnings.size(), 2u);
	EXPECT_EQ(readSwc(in).skeleton.radius, std::vector<double>(11, 0.0));
}

TEST(Swc, ReadsParentsThatComeLaterAndAnyIds)
{
	std::istringstream in(
		"# from elsewhere\n10 3 0 0 0 1 7\n7 1 1 0 0 2 -1\n\n 0 3 2 0 0 0.5 10\n");
	const CurveSkeleton s = readSwc(in).skeleton;
	EXPECT_EQ(s.edges, (std::vector<std::array<int, 2>> {{0, 1}, {0, 2}}));
	EXPECT_EQ(s.radius, (std::vector<double> {1, 2, 0.5}));
}

TEST(Swc, ErrorsCarryTheirLine)
{
	const std::string root = "# a file\n1 0 0 0 0 1 -1\n";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1\n"), 3u) << "a field too few";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1 1 1\n"), 3u) << "a field too many";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 inf 1 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 1e37 1 1\n"), 3u) << "too far away to work with";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 -1 1\n"), 3u) << "a radius below 0";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 nan 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1e37 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "1 0 1 0 0 1 1\n"), 3u) << "an id twice";
	EXPECT_EQ(lineOfSwcError(root + "-2 0 1 0 0 1 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2.5 0 1 0 0 1 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2 soma 1 0 0 1 1\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1 -2\n"), 3u);
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1 9\n3 0 1 0 0 1 1\n"), 3u) << "no such parent";
	EXPECT_EQ(lineOfSwcError(root + "2 0 1 0 0 1 2\n"), 3u) << "its own parent";
	EXPECT_GE(lineOfSwcError(root + "2 0 1 0 0 1 3\n3 0 1 0 0 1 2\n"), 3u) << "its own grandparent";
}

TEST(Swc, DamagedFilesAreReadOrRefused)
{
	const std::string file = written([](std::ostream& out) { writeSwc(out, ringWithTailAndY()); });
	readDamaged(file, 3000, [](std::istream& in) {
		try {
			const CurveSkeleton s = readSwc(in).skeleton;
			EXPECT_NO_THROW(requireWritable(s));
			EXPECT_EQ(statistics(s).cycles, 0);
		}
		catch (const FormatError& error) {
			EXPECT_GT(error.line(), 0u);
		}
	});
}

namespace {

struct SwcRow
{
	int id, type, parent;
	double x, y, z, radius;
};

std::vector<SwcRow> rowsOf(const std::string& text)
{
	std::vector<SwcRow> rows;
	std::istringstream lines(text);
	for (std::string line; std::getline(lines, line);) {
		if (line.front() == '#')
			continue;
		SwcRow row;
		std::istringstream(line) >> row.id >> row.type >> row.x >> row.y >> row.z >> row.radius
			>> row.parent;
		rows.push_back(row);
	}
	return rows;
}

std::string swc(const CurveSkeleton& skeleton, const SwcOptions& options)
{
	return written([&](std::ostream& out) { writeSwc(out, skeleton, options); });
}

} // namespace

TEST(Swc, OneSomaWhereTheRadiusSaysSo)
{
	CurveSkeleton s = ringWithTailAndY();
	const auto somas = [&](SwcSoma rule) {
		std::vector<double> radii;
		for (const SwcRow& row : rowsOf(swc(s, {1, "", rule})))
			if (row.type == 1) {
				EXPECT_EQ(row.parent, -1);
				radii.push_back(row.radius);
			}
		return radii;
	};
	EXPECT_EQ(somas(SwcSoma::None), std::vector<double>());
	EXPECT_EQ(somas(SwcSoma::Thickest), std::vector<double> {0.9});
	// The median of its tree, seven nodes, is 0.3.
	EXPECT_EQ(somas(SwcSoma::Auto), std::vector<double> {0.9});
	s.radius[2] = 0.71; // more than any other, and more than twice 0.3
	EXPECT_EQ(somas(SwcSoma::Auto), std::vector<double> {0.71});
	s.radius[5] = 0.36;
	EXPECT_EQ(somas(SwcSoma::Auto), std::vector<double>());
	for (const SwcRow& row : rowsOf(swc(s, {1, "", SwcSoma::Thickest})))
		EXPECT_EQ(row.type, row.radius == 0.71 ? 1 : 3);
	for (const SwcRow& row : rowsOf(swc(s, {})))
		EXPECT_EQ(row.type, 0);
}

TEST(Swc, ScaleAndUnits)
{
	const CurveSkeleton s = ringWithTailAndY();
	const std::string text = swc(s, {1000, "nm", SwcSoma::None});
	EXPECT_EQ(
		text.substr(0, text.find('\n')), "# Curve skeleton, lengths in nm, mesh units times 1000");
	const std::vector<SwcRow> rows = rowsOf(text), plain = rowsOf(swc(s, {}));
	ASSERT_EQ(rows.size(), plain.size());
	for (size_t i = 0; i < rows.size(); ++i) {
		EXPECT_DOUBLE_EQ(rows[i].x, 1000 * plain[i].x);
		EXPECT_DOUBLE_EQ(rows[i].z, 1000 * plain[i].z);
		EXPECT_DOUBLE_EQ(rows[i].radius, 1000 * plain[i].radius);
	}
	for (double scale : {0.0, -1.0, 1e37, 1e40, std::numeric_limits<double>::quiet_NaN()})
		try {
			swc(s, {scale, "", SwcSoma::None});
			ADD_FAILURE() << scale;
		}
		catch (const InvalidInput& error) {
			EXPECT_STREQ(error.what(), "The scale must be above 0 and at most 1e+36.");
		}
}

TEST(Swc, AnIdBeyondAllIntegersIsOutOfRange)
{
	for (const char* id : {"3000000000", "-3000000000", "99999999999999999999"}) {
		std::istringstream in(std::string(id) + " 0 0 0 0 1 -1\n");
		try {
			readSwc(in);
			ADD_FAILURE() << id;
		}
		catch (const FormatError& error) {
			EXPECT_NE(std::string(error.what())
						  .find("id " + std::string(id) + " is not between 0 and 2147483647."),
				std::string::npos)
				<< error.what();
		}
	}
}
