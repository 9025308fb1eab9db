// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file A symmetric sparse matrix in single precision and its product with three columns at once.

#ifndef VCG_MCF_SYMMETRIC_ROWS_H
#define VCG_MCF_SYMMETRIC_ROWS_H

#include <Eigen/Core>

#include <vector>

namespace vcg::tri::mcf {

/// A row of three columns and a spare, side by side in one SIMD register.
using FloatQuad = Eigen::Array4f;
using FloatQuads = std::vector<FloatQuad, Eigen::aligned_allocator<FloatQuad>>;

/// An entry of a sparse row or column: where, and what.
struct SparseEntry
{
	int index;
	float value;
};

/**
 * A symmetric sparse matrix by rows, the diagonal apart, as the flow's solver wants it:
 * (A x)_i = diagonal[i] x_i + sum_k entries[k].value x_entries[k].index, k in [start[i], start[i + 1]).
 */
struct SymmetricRows
{
	std::vector<float> diagonal;
	std::vector<int> start;
	std::vector<SparseEntry> entries;

	int size() const { return int(diagonal.size()); }

	/// Calls visit(i, (A x)_i) for each row. Complexity: O(entries).
	template <class Visitor>
	void forEachProduct(const FloatQuads& x, Visitor&& visit) const
	{
		for (int i = 0; i < size(); ++i) {
			FloatQuad sum = x[i] * diagonal[i];
			for (int k = start[i]; k < start[i + 1]; ++k)
				sum += x[entries[k].index] * entries[k].value;
			visit(i, sum);
		}
	}
};

} // namespace vcg::tri::mcf

#endif
