// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "graphs.h"

#include <skeleton/io/cg.h>

#include <gtest/gtest.h>

using namespace graphs;

namespace {

size_t lineOfError(const std::string& text)
{
	return errorLine([](std::istream& in) { readCg(in); }, text);
}

} // namespace

TEST(Cg, ReadsBackToTheLastBit)
{
	const CurveSkeleton s = ringWithTailAndY();
	std::istringstream in(written([&](std::ostream& out) { writeCg(out, s); }));
	const SkeletonFile file = readCg(in);
	EXPECT_TRUE(file.warnings.empty());
	EXPECT_EQ(file.skeleton.position, s.position);
	EXPECT_EQ(file.skeleton.edges, s.edges);
	EXPECT_TRUE(file.skeleton.radius.empty());
}

TEST(Cg, IsTheFormatOfTheAuthors)
{
	CurveSkeleton s;
	s.position = {{0, 0, 0}, {1, 0.5, 0}, {2, 0, -1e-7}};
	s.edges = {{0, 1}, {1, 2}};
	EXPECT_EQ(written([&](std::ostream& out) { writeCg(out, s); }),
		"# D:3 NV:3 NE:2\nv 0 0 0\nv 1 0.5 0\nv 2 0 -1e-07\ne 1 2\ne 2 3\n");
}

TEST(Cg, ReadsBlankLinesCommentsAndForeignLineEnds)
{
	std::istringstream in(
		"# D:3 NV:2 NE:2\r\n\r\n# a word\r\nv 0 0 0\r\nv\t1 +2.5 3\r\ne 2 1\r\ne 1 2\r\n");
	const SkeletonFile file = readCg(in);
	EXPECT_EQ(file.skeleton.position[1], Point3d(1, 2.5, 3));
	EXPECT_EQ(file.skeleton.edges, (std::vector<std::array<int, 2>> {{0, 1}}));
	EXPECT_EQ(file.warnings.size(), 1u) << "the edge is given twice";
}

TEST(Cg, AnEmptyGraphIsAGraph)
{
	std::istringstream in("# D:3 NV:0 NE:0\n");
	EXPECT_TRUE(readCg(in).skeleton.position.empty());
}

TEST(Cg, ErrorsCarryTheirLine)
{
	const std::string header = "# D:3 NV:2 NE:1\n";
	EXPECT_EQ(lineOfError(""), 1u);
	EXPECT_EQ(lineOfError("v 0 0 0\n"), 1u);
	EXPECT_EQ(lineOfError("# D:2 NV:2 NE:1\n"), 1u);
	EXPECT_EQ(lineOfError("# D:3 NV:-2 NE:1\n"), 1u);
	EXPECT_EQ(lineOfError("# D:3 NV:2 NE:99999999999\n"), 1u);
	EXPECT_EQ(lineOfError(header + "v 0 0\nv 1 0 0\ne 1 2\n"), 2u) << "a missing coordinate";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 nan\ne 1 2\n"), 3u);
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 1e228\ne 1 2\n"), 3u);
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 1e999\ne 1 2\n"), 3u);
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0x\ne 1 2\n"), 3u);
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\ne 1 3\n"), 4u) << "no node 3";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\ne 0 1\n"), 4u) << "ids begin at 1";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\ne 2 2\n"), 4u) << "a loop";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nf 1 0 0\n"), 3u) << "no such kind of line";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\nv 2 0 0\ne 1 2\n"), 4u) << "too many nodes";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\ne 1 2\ne 1 2\n"), 5u) << "too many edges";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\ne 1 2\n"), 4u) << "a node too few";
	EXPECT_EQ(lineOfError(header + "v 0 0 0\nv 1 0 0\n"), 4u) << "an edge too few";
}

TEST(Cg, RefusesToWriteWhatCannotBeRead)
{
	CurveSkeleton s = ringWithTailAndY();
	s.position[3][1] = std::nan("");
	std::ostringstream out;
	EXPECT_THROW(writeCg(out, s), InvalidInput);
	s = ringWithTailAndY();
	s.edges.push_back({3, 11});
	EXPECT_THROW(writeCg(out, s), InvalidInput);
	s = ringWithTailAndY();
	s.radius.pop_back();
	EXPECT_THROW(writeCg(out, s), InvalidInput);
	EXPECT_TRUE(out.str().empty());
}

TEST(Cg, DamagedFilesAreReadOrRefused)
{
	const std::string file = written([](std::ostream& out) { writeCg(out, ringWithTailAndY()); });
	readDamaged(file, 3000, [](std::istream& in) {
		try {
			const CurveSkeleton s = readCg(in).skeleton;
			EXPECT_NO_THROW(requireWritable(s));
		}
		catch (const FormatError& error) {
			EXPECT_GT(error.line(), 0u);
		}
	});
}
