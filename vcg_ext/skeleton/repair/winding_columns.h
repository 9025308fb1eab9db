// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Winding numbers at the nodes of a lattice, counted column by column.

#ifndef VCG_MCF_WINDING_COLUMNS_H
#define VCG_MCF_WINDING_COLUMNS_H

#include "boundary_cones.h"
#include "tetrahedral_lattice.h"

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/vertical_crossing.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The winding number of weighted triangles, closed by cones over their border, at the nodes of a
 * lattice: the sum of the weights of the triangles that the ray from the node along z crosses, with
 * the signs of the crossings. Those of each column of nodes are found once, triangle by triangle.
 */
class WindingColumns
{
public:
	using Place = TetrahedralLattice::Place;

	/**
	 * @param triangles, weights  the weights are empty: 1 each. @param cones  over their border.
	 * @param lattice  its origin and spacing are used.
	 * @throws Cancelled. Complexity: O(F + n log n) for n crossings, about two for each squared
	 *         spacing of the area seen along z.
	 */
	WindingColumns(const std::vector<Triangle>& triangles, const std::vector<double>& weights,
		const BoundaryCones& cones, const TetrahedralLattice& lattice,
		const Progress& progress = Progress())
	{
		detail::Ticker ticker(
			progress, counting, 2.0 * double(triangles.size() + cones.triangles.size()));
		for (size_t f = 0; f < triangles.size(); ++f)
			addCrossings(
				cones.points, triangles[f], weights.empty() ? 1 : weights[f], lattice, ticker);
		for (size_t f = 0; f < cones.triangles.size(); ++f)
			addCrossings(cones.points, cones.triangles[f], cones.weights[f], lattice, ticker);
		detail::sortCancellable(crossings, 0, crossings.size(), progress);
		// From the top of each column down.
		for (size_t i = crossings.size(); i-- > 0;) {
			const bool isTop =
				i + 1 == crossings.size() || crossings[i + 1].column != crossings[i].column;
			crossings[i].winding = crossings[i].change + (isTop ? 0 : crossings[i + 1].winding);
		}
		for (size_t i = 0; i < crossings.size(); ++i)
			if (i == 0 || crossings[i - 1].column != crossings[i].column)
				columns.push_back(i);
		columns.push_back(crossings.size());
	}

	/// The winding number at a node; nothing where rounding has lost a crossing of its column, so
	/// that it does not end outside. On a triangle: that of its lower side.
	/// Complexity: O(log n).
	std::optional<double> at(const TetrahedralLattice& lattice, const Place& node) const
	{
		constexpr double rounding = 1e-9; // of sums of weights
		const Column column = {node[0], node[1]};
		const auto found = std::lower_bound(columns.begin(), columns.end() - 1, column,
			[&](size_t begin, const Column& c) { return crossings[begin].column < c; });
		if (found == columns.end() - 1 || crossings[*found].column != column)
			return 0;
		if (std::abs(crossings[*found].winding) > rounding)
			return std::nullopt;
		const auto end = crossings.begin() + std::ptrdiff_t(*(found + 1));
		const auto above = std::lower_bound(crossings.begin() + std::ptrdiff_t(*found), end,
			lattice.position(node)[2], [](const Crossing& c, double z) { return c.z < z; });
		return above == end ? 0 : above->winding;
	}

private:
	static constexpr const char* counting = "Wrapping the surface";
	using Column = std::array<int, 2>; ///< of places

	/// Where a column crosses a triangle.
	struct Crossing
	{
		Column column;
		double change;  ///< of the winding number, downwards
		double winding; ///< just below: the sum of the changes from the top on
		double z;

		bool operator<(const Crossing& other) const
		{
			return column != other.column ? column < other.column
				: z != other.z            ? z < other.z
										  : change < other.change;
		}
	};

	std::vector<Crossing> crossings; ///< by column, and from below in each
	std::vector<size_t> columns;     ///< the first crossing of each, and the end of the last

	void addCrossings(const std::vector<Point3d>& points, const Triangle& t, double weight,
		const TetrahedralLattice& lattice, detail::Ticker& ticker)
	{
		const Point3d origin = lattice.position(Place {0, 0, 0});
		const double half = lattice.spacing() / 2;
		Box3d box;
		for (int v : t)
			box.Add(points[size_t(v)]);
		// One line more on either side, for rounding: the test below is exact.
		const int firstColumn = int(std::floor((box.min[0] - origin[0]) / half));
		const int lastColumn = int(std::ceil((box.max[0] - origin[0]) / half));
		for (int i = firstColumn; i <= lastColumn; ++i) {
			const double x = lattice.position(Place {i, 0, 0})[0];
			double low = std::numeric_limits<double>::infinity(), high = -low;
			const auto reach = [&](double y) {
				low = std::min(low, y);
				high = std::max(high, y);
			};
			for (int k = 0; k < 3; ++k) {
				const Point3d &p = points[size_t(t[size_t(k)])],
							  &q = points[size_t(t[size_t(k + 1) % 3])];
				if ((p[0] < x) != (q[0] < x))
					reach(p[1] + (q[1] - p[1]) * ((x - p[0]) / (q[0] - p[0])));
				if (p[0] == x)
					reach(p[1]);
			}
			if (!(low <= high))
				continue;
			const int last = int(std::ceil((high - origin[1]) / half));
			int j = int(std::floor((low - origin[1]) / half));
			for (j -= (i - j) & 1; j <= last; j += 2) {
				ticker.tick();
				const double y = lattice.position(Place {0, j, 0})[1];
				const int change = detail::verticalCrossing(points, t, x, y);
				if (change == 0)
					continue;
				if (const auto z = detail::heightOfPlane(points, t, x, y))
					crossings.push_back(
						{{i, j}, weight * change, 0, std::clamp(*z, box.min[2], box.max[2])});
			}
		}
	}
};

} // namespace vcg::tri::mcf

#endif
