// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Points sorted into cubic cells, for many searches with about the same reach.

#ifndef VCG_MCF_CELL_GRID_H
#define VCG_MCF_CELL_GRID_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

namespace vcg::tri::mcf::detail {

/// A grid of cubic cells, numbered row by row along x, then y, then z.
struct CellGrid
{
	static constexpr int bits = 12; ///< of a cell's place along an axis
	/// From a cell to the next along y and along z.
	static constexpr std::int64_t nextRow = std::int64_t(1) << bits, nextLayer = nextRow << bits;

	/// @param box    of all points.
	/// @param wanted size of the cells; they are larger where there would be too many.
	CellGrid(const Box3d& box, double wanted) : low(box.min)
	{
		// Rows end in cells without points: two cells past an end there are none of the next row.
		constexpr double maximum = (1 << bits) - 4;
		const double longest = std::max({box.DimX(), box.DimY(), box.DimZ()});
		size = std::max(wanted, longest / maximum);
		if (!(size > 0))
			size = 1;
	}

	/// @pre p is in the box.
	std::int64_t cellOf(const Point3d& p) const
	{
		const auto place = [&](int axis) { return 1 + std::int64_t((p[axis] - low[axis]) / size); };
		return place(0) + nextRow * place(1) + nextLayer * place(2);
	}

	double size;

private:
	Point3d low;
};

/// Points in the order of their cells.
struct PointsByCell
{
	std::vector<std::int64_t> cell;
	std::vector<int> id;

	/// @param pointAt  of an index from 0 to count - 1, within the grid's box.
	/// @throws Cancelled
	template <class PointAt>
	PointsByCell(int count, const PointAt& pointAt, const CellGrid& grid, const Progress& progress,
		const char* what)
	{
		struct Entry
		{
			std::int64_t cell;
			int id;
		};
		std::vector<Entry> sorted = filledArray(size_t(count), Entry(), progress);
		std::vector<Entry> entries;
		entries.reserve(size_t(count));
		reportedLoop(count, progress.part(0, 0.2), what, [&](int i) {
			entries.push_back({grid.cellOf(pointAt(i)), i});
		});
		constexpr std::int64_t places = CellGrid::nextRow;
		for (int axis = 0; axis < 3; ++axis) {
			const auto place = [&](const Entry& e) {
				return size_t((e.cell >> axis * CellGrid::bits) % places);
			};
			const Progress part = progress.part(0.2 + 0.2 * axis, 0.4 + 0.2 * axis);
			std::array<int, places + 1> start = {};
			reportedLoop(
				count, part.part(0, 0.5), what, [&](int i) { ++start[place(entries[i]) + 1]; });
			std::partial_sum(start.begin(), start.end(), start.begin());
			reportedLoop(count, part.part(0.5, 1), what,
				[&](int i) { sorted[start[place(entries[i])]++] = entries[i]; });
			entries.swap(sorted);
		}
		cell.reserve(size_t(count));
		id.reserve(size_t(count));
		reportedLoop(count, progress.part(0.8, 1), what, [&](int i) {
			cell.push_back(entries[i].cell);
			id.push_back(entries[i].id);
		});
	}
};

} // namespace vcg::tri::mcf::detail

#endif
