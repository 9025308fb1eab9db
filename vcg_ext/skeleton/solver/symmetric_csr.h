// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A symmetric sparse matrix in single precision and its product with three columns at once.

#ifndef VCG_MCF_SYMMETRIC_CSR_H
#define VCG_MCF_SYMMETRIC_CSR_H

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/// A row of three columns and a spare, side by side in one SIMD register.
using FloatQuad = Eigen::Array4f;
using FloatQuads = std::vector<FloatQuad, Eigen::aligned_allocator<FloatQuad>>;

/// An entry of a sparse row or column: its place, and its value.
struct SparseEntry
{
	int index = 0;
	float value = 0;
};

/// The number of entries of a row or column that is padded to groups: `count`, rounded up.
constexpr int filledUp(int count, int group)
{
	return (count + group - 1) / group * group;
}

/**
 * A symmetric sparse matrix by rows, in the form that the flow's solver needs: a Laplacian and an
 * excess of the diagonal,
 *
 *   (A x)_i = excess_i x_i + sum_k value_k (x_index_k - x_i),   k in [start[i], start[i + 1]).
 *
 * In this form the image of a constant c is exactly c excess, however large the values are: the
 * rounding of a stored diagonal would hold back vertices that are to move.
 */
struct SymmetricRows
{
	std::vector<float> excess;
	/// The entries A_ii: excess_i - sum_k value_k.
	std::vector<float> diagonal;
	/// Where each row begins in `entries`, and the last one ends; multiples of Group.
	std::vector<int> start;
	std::vector<SparseEntry> entries;

	/// Rows are zero-padded to a multiple of this, with entries in column 0: trip counts of few
	/// different values are more predictable.
	static constexpr int Group = 3;

	int size() const { return int(diagonal.size()); }

	/// The rows and columns in [begin, end). @pre padding apart, these rows have no other columns.
	SymmetricRows part(int begin, int end) const
	{
		SymmetricRows rows;
		rows.excess.assign(excess.begin() + begin, excess.begin() + end);
		rows.diagonal.assign(diagonal.begin() + begin, diagonal.begin() + end);
		for (int i = begin; i <= end; ++i)
			rows.start.push_back(start[i] - start[begin]);
		for (int k = start[begin]; k < start[end]; ++k)
			rows.entries.push_back({std::max(entries[k].index - begin, 0), entries[k].value});
		return rows;
	}

	/// Calls visit(i, (A x)_i) for each row. Complexity: O(entries).
	template <class Visitor>
	void forEachProduct(const FloatQuads& x, Visitor&& visit) const
	{
		for (int i = 0; i < size(); ++i) {
			const FloatQuad own = x[i];
			FloatQuad sum = own * excess[i];
			for (int first = start[i]; first < start[i + 1]; first += Group)
				for (int k = first; k < first + Group; ++k)
					sum += (x[entries[k].index] - own) * entries[k].value;
			visit(i, sum);
		}
	}
};

} // namespace vcg::tri::mcf

#endif
