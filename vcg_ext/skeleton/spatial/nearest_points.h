// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The nearest of some points for each of many queries at once.

#ifndef VCG_MCF_NEAREST_POINTS_H
#define VCG_MCF_NEAREST_POINTS_H

#include "cell_grid.h"
#include "point_tree.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/**
 * For each query the id of the point nearest to it, the lowest of several: PointTree::nearest(), in
 * a fraction of its time where the points cover a surface evenly and the queries are near it.
 *
 * Points and queries are sorted into cells about as large as the points are far from each other.
 * Both lists are gone through once, side by side: the nearest point is in the query's cell or in
 * one of the 26 around it, nine rows of three that follow each other in the list. Where it is
 * farther than a cell is wide, or many points share these cells, a PointTree is searched.
 *
 * @param points   finite, at least one.
 * @param queries  finite.
 * @param spacing  about how far the points are from each other; it does not change the result.
 * @throws Cancelled. Complexity: O(P + Q) for such points and queries, at most O((P + Q) log P).
 * Same result on any number of threads.
 */
inline std::vector<int> nearestPoints(const std::vector<Point3d>& points,
	const std::vector<Point3d>& queries, double spacing, const Progress& progress = Progress())
{
	constexpr double cellOfSpacing =
		0.85; // on even triangles no place is farther than 0.58 edges from a corner
	constexpr size_t maxCandidates = 256;
	const char* const what = "Finding the nearest points";
	Box3d box;
	for (const std::vector<Point3d>* some : {&points, &queries})
		detail::cancellableLoop(int(some->size()), progress, [&](int i) { box.Add((*some)[i]); });
	const detail::CellGrid grid(box, cellOfSpacing * spacing);
	const auto sorted = [&](const std::vector<Point3d>& some, const Progress& ofSorting) {
		return detail::PointsByCell(
			int(some.size()), [&](int i) -> const Point3d& { return some[size_t(i)]; }, grid,
			ofSorting, what);
	};
	const detail::PointsByCell sources = sorted(points, progress.part(0, 0.05));
	const detail::PointsByCell asked = sorted(queries, progress.part(0.05, 0.2));
	// Nearer than this, with room for rounding, two points are in neighbouring cells.
	const double certain = (1 - 1e-6) * grid.size;
	struct Candidate
	{
		Point3d point;
		int id;
	};

	std::vector<int> result = detail::filledArray(queries.size(), -1, progress);
	const auto blockOfCells = [&](int begin, int end) {
		std::array<std::int64_t, 9> row;
		std::array<size_t, 9> next;
		for (int i = 0; i < 9; ++i) {
			row[i] =
				(i % 3 - 1) * detail::CellGrid::nextRow + (i / 3 - 1) * detail::CellGrid::nextLayer;
			next[i] = size_t(std::lower_bound(sources.cell.begin(), sources.cell.end(),
								 asked.cell[begin] + row[i] - 1)
				- sources.cell.begin());
		}
		std::vector<Candidate> candidates;
		while (begin < end) {
			const std::int64_t cell = asked.cell[begin];
			candidates.clear();
			for (int i = 0; i < 9; ++i) {
				size_t& at = next[i];
				while (at < sources.cell.size() && sources.cell[at] < cell + row[i] - 1)
					++at;
				for (size_t s = at; s < sources.cell.size() && sources.cell[s] <= cell + row[i] + 1
					 && candidates.size() <= maxCandidates;
					 ++s)
					candidates.push_back({points[sources.id[s]], sources.id[s]});
			}
			for (; begin < end && asked.cell[begin] == cell; ++begin) {
				if (candidates.size() > maxCandidates)
					continue;
				const Point3d& query = queries[asked.id[begin]];
				double minimum = certain, squaredReach = certain * certain;
				int nearest = -1;
				for (const Candidate& c : candidates) {
					// Most are farther, by a test without a root that leaves room for rounding.
					if (SquaredDistance(c.point, query) > squaredReach)
						continue;
					const double distance = Distance(c.point, query);
					if (distance < minimum || (distance == minimum && c.id < nearest)) {
						minimum = distance;
						squaredReach = minimum * minimum * (1 + 1e-12);
						nearest = c.id;
					}
				}
				result[asked.id[begin]] = nearest;
			}
		}
	};
	forEachBlock(int(queries.size()), progress.part(0.2, 0.6), what, blockOfCells);

	std::vector<int> left;
	for (size_t q = 0; q < result.size(); ++q)
		if (result[q] < 0)
			left.push_back(int(q));
	if (!left.empty()) {
		const PointTree tree(points, progress.part(0.6, 0.7));
		forEachBlock(int(left.size()), progress.part(0.7, 1), what, [&](int begin, int end) {
			for (int i = begin; i < end; ++i)
				result[left[i]] = tree.nearest(queries[left[i]]);
		});
	}
	progress.report(1, what);
	return result;
}

} // namespace vcg::tri::mcf

#endif
