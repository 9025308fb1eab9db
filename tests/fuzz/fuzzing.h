// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What the fuzz targets share: bytes as a stream, what must hold, the tools on what was read.

#ifndef MCFSKEL_FUZZ_FUZZING_H
#define MCFSKEL_FUZZ_FUZZING_H

#include <skeleton/io/cg.h>
#include <skeleton/io/graphml.h>
#include <skeleton/io/json.h>
#include <skeleton/io/skeleton_ply.h>
#include <skeleton/io/swc.h>
#include <skeleton/graph/branch_table.h>
#include <skeleton/graph/compare_skeletons.h>
#include <skeleton/graph/prune.h>
#include <skeleton/graph/resample_skeleton.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>

namespace fuzzing {

using namespace vcg::tri::mcf;
using vcg::Point3d;

/// Ends the program, as a finding, unless something holds.
inline void require(bool holds, const char* what)
{
	if (holds)
		return;
	std::fprintf(stderr, "does not hold: %s\n", what);
	std::abort();
}

inline std::istringstream streamOf(const std::uint8_t* data, size_t size)
{
	return std::istringstream(std::string(reinterpret_cast<const char*>(data), size));
}

/// What `write` puts into a stream.
inline std::string written(const std::function<void(std::ostream&)>& write)
{
	std::ostringstream out;
	write(out);
	return out.str();
}

/// Whether two skeletons are the same to the last bit, but for what a format leaves out.
inline bool sameGraph(const CurveSkeleton& a, const CurveSkeleton& b)
{
	return a.position == b.position && a.edges == b.edges;
}

/// A skeleton that a reader has accepted: the tools take it, and what is written is read again.
inline void workOn(CurveSkeleton skeleton)
{
	requireWritable(skeleton);
	const size_t nodes = skeleton.position.size();
	const SkeletonStatistics before = statistics(skeleton);
	require(std::isfinite(before.length), "the length is finite");

	std::istringstream cg(written([&](std::ostream& out) { writeCg(out, skeleton); }));
	require(sameGraph(readCg(cg).skeleton, skeleton), "a .cg reads back the same");
	std::istringstream ply(written([&](std::ostream& out) { writeSkeletonPly(out, skeleton); }));
	const CurveSkeleton fromPly = readSkeletonPly(readBinaryPly(ply)).skeleton;
	require(sameGraph(fromPly, skeleton) && fromPly.radius == skeleton.radius
			&& fromPly.node == skeleton.node,
		"a PLY reads back the same");
	std::istringstream swc(written([&](std::ostream& out) { writeSwc(out, skeleton); }));
	const SkeletonStatistics tree = statistics(readSwc(swc).skeleton);
	require(tree.components == before.components && tree.cycles == 0,
		"a .swc reads back as a spanning forest");
	written([&](std::ostream& out) { writeGraphml(out, skeleton); });
	written([&](std::ostream& out) { writeJson(out, skeleton); });

	skeleton.radius.resize(nodes, 0);
	branchTable(skeleton, skeletonBranches(skeleton));
	const SkeletonStatistics pruned = statistics(prune(skeleton, PruneParameters()));
	require(pruned.components == before.components && pruned.cycles == before.cycles,
		"pruning keeps components and cycles");
	if (before.length == 0)
		return;
	try {
		const double spacing = before.length / 100;
		const CurveSkeleton even = resampledSkeleton(skeleton, spacing, spacing);
		const SkeletonStatistics resampled = statistics(even);
		require(resampled.components == before.components && resampled.cycles == before.cycles,
			"resampling keeps components and cycles");
		const SkeletonDistance distance = distanceToSkeleton(even, skeleton, spacing);
		require(std::isfinite(distance.mean), "the distance is finite");
	}
	catch (const SolverError&) {
		// Too far from the origin for its size.
	}
}

} // namespace fuzzing

#endif
