// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief An incomplete L D L^T of an M-matrix in single precision: the flow's preconditioner.

#ifndef VCG_MCF_INCOMPLETE_LDLT_H
#define VCG_MCF_INCOMPLETE_LDLT_H

#include "symmetric_csr.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/**
 * S ~ L D L^T for S = M + diag(shift), with unit lower triangular L; columns are eliminated in the
 * order of their numbers.
 *
 * Each column takes the updates of the earlier columns that have an entry in its row (left-looking;
 * Jones and Plassmann, ACM TOMS 21(1), 1995). An entry l_rk that is small beside its row's
 * diagonal, l_rk^2 d_k < dropTolerance^2 s_rr, is dropped as it appears. This is a relaxed modified
 * incomplete factorisation (MILU; Gustafsson, BIT 18, 1978): most of the dropped fill is lumped
 * onto the diagonals of its row and column, so that row sums, and hence smooth modes, are nearly
 * preserved. On the flow's matrices a seventh of the complete factor remains, and no other entry is
 * visited. S is a diagonally dominant M-matrix, so that pivots stay positive, except for rounding
 * where the shift is tiny: they are kept above 1e-7 of the diagonal.
 *
 * @throws SolverError if a diagonal entry is not positive, or a pivot is not a number.
 * Complexity: linear in the updates, about O(n log n) on surface meshes in a fill-reducing order.
 */
class IncompleteFactor
{
public:
	/**
	 * @param M     symmetric, by rows.
	 * @param shift added to M's diagonal, one for each row, > 0.
	 * @throws SolverError, see the class; Cancelled.
	 */
	IncompleteFactor(const SymmetricRows& M, const std::vector<float>& shift, float dropTolerance,
		const Progress& progress = Progress())
	{
		const int n = M.size();
		inverseDiagonal.resize(n);
		start.resize(n + 1);
		start[0] = 0;
		entries.resize(10 * size_t(n)); // the flow's matrices use 8 to 9 a row
		std::vector<Row> rows(n);
		for (int k = 0; k < n; ++k) {
			const float own = M.diagonal[k] + shift[k];
			rows[k].pivot = own;
			rows[k].minimum = dropTolerance * dropTolerance * own;
		}
		std::vector<Sum> sums(n);
		std::vector<Column> columns(n);
		std::vector<int> pattern(n);
		const auto chain = [&](int j, int nextEntry) {
			Column& column = columns[j];
			if (column.position == column.end)
				return;
			std::swap(entries[column.position], entries[nextEntry]);
			int& first = rows[entries[column.position].index].chain;
			column.nextInChain = first;
			first = j;
		};
		constexpr int reportEvery = 1 << 13; // the last columns of a large system cost the most
		for (int k = 0; k < n; ++k) {
			if (k % reportEvery == 0)
				progress.report(double(k) / n, "Contracting");
			const float own = M.diagonal[k] + shift[k], pivot = rows[k].pivot;
			if (!(own > 0) || std::isnan(pivot))
				throw SolverError(
					"The contraction's linear system could not be factorised: the mesh "
					"has degenerate triangles. Resample it first.");
			const float diagonal = std::max(pivot, 1e-7f * own), inverse = 1 / diagonal;
			int count = 0;
			const auto add = [&](int r, float value) {
				Sum& sum = sums[r];
				sum.value += value;
				pattern[count] = r; // branchless: the condition is unpredictable
				count += sum.stamp != k;
				sum.stamp = k;
			};
			for (int e = M.start[k]; e < M.start[k + 1]; ++e)
				if (M.entries[e].index > k)
					add(M.entries[e].index, M.entries[e].value);
			for (int j = rows[k].chain, next; j >= 0; j = next) {
				Column& column = columns[j];
				next = column.nextInChain;
				const int begin = column.position++, end = column.end;
				const float y = entries[begin].value * column.diagonal;
				// The lowest index and its entry, packed into one number: a branchless minimum.
				std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
				for (int e = begin + 1; e < end; ++e) {
					add(entries[e].index, -entries[e].value * y);
					lowest = std::min(lowest, std::int64_t(entries[e].index) << 32 | e);
				}
				chain(j, int(lowest & 0x7fffffff));
			}
			const int first = start[k];
			int lowest = first;
			const size_t maximum = size_t(first) + count + Group;
			if (entries.size() < maximum)
				entries.resize(std::max(entries.size() * 3 / 2, maximum));
			int end = first;
			float dropped = 0;
			for (int i = 0; i < count; ++i) {
				Sum& sum = sums[pattern[i]];
				const float value = sum.value;
				sum.value = 0;
				Row& row = rows[pattern[i]];
				if (value * value * inverse < row.minimum) {
					const float moved = Compensation * value;
					row.pivot += moved;
					dropped += moved;
					continue;
				}
				entries[end] = {pattern[i], value};
				if (pattern[i] < entries[lowest].index)
					lowest = end;
				++end;
			}
			const float compensated = std::max(diagonal + dropped, 1e-7f * own);
			inverseDiagonal[k] = 1 / compensated;
			for (int e = first; e < end; ++e) {
				const float value = entries[e].value;
				entries[e].value *= inverseDiagonal[k];
				rows[entries[e].index].pivot -= value * entries[e].value;
			}
			start[k + 1] = first + filledUp(end - first, Group);
			for (int e = end; e < start[k + 1]; ++e)
				entries[e] = {k, 0};
			columns[k] = {first, end, -1, compensated};
			chain(k, lowest);
		}
	}

	/// x <- (L D L^T)^-1 x.
	void solve(FloatQuads& x) const
	{
		solve(x, [](int, const FloatQuad&) {});
	}

	/// The same; calls visit(i, x_i) for each row as it is finished, from the last to the first.
	template <class Visitor>
	void solve(FloatQuads& x, Visitor&& visit) const
	{
		const int n = int(inverseDiagonal.size());
		for (int i = 0; i < n; ++i) {
			const FloatQuad xi = x[i];
			for (int e = start[i]; e < start[i + 1]; e += Group)
				for (int k = e; k < e + Group; ++k)
					x[entries[k].index] -= entries[k].value * xi;
		}
		for (int i = n - 1; i >= 0; --i) {
			// A column's entries are sorted by row. Those of the lowest rows, often just found, are
			// used last, so that the loop waits for them as late as it can.
			FloatQuad xi = x[i] * inverseDiagonal[i];
			for (int e = start[i + 1]; e > start[i]; e -= Group)
				for (int k = e - 1; k >= e - Group; --k)
					xi -= entries[k].value * x[entries[k].index];
			x[i] = xi;
			visit(i, xi);
		}
	}

private:
	/// A row while the earlier columns are computed.
	struct Row
	{
		float pivot;    ///< what is left of its diagonal
		float minimum;  ///< entries that take less from it are dropped
		int chain = -1; ///< the first column whose next entry is in this row
	};

	/// A row's entry in the current column, if stamped with that.
	struct Sum
	{
		float value = 0;
		int stamp = -1;
	};

	/// A finished column: its next entry, and the next column of the chain in that entry's row.
	struct Column
	{
		int position, end, nextInChain;
		float diagonal;
	};

	/// Columns are zero-padded to a multiple of this, with entries in their own row: trip counts of
	/// few different values are more predictable.
	static constexpr int Group = 4;

	/// Fraction of a dropped entry that is added to each of the two diagonals.
	static constexpr float Compensation = 0.97f;

	std::vector<float> inverseDiagonal;
	/// The entries of L below the diagonal by columns.
	std::vector<int> start;
	std::vector<SparseEntry> entries;
};

} // namespace vcg::tri::mcf

#endif
