// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file An incomplete L D L^T of an M-matrix in single precision: the flow's preconditioner.

#ifndef VCG_MCF_INCOMPLETE_FACTOR_H
#define VCG_MCF_INCOMPLETE_FACTOR_H

#include "cotangent_laplacian.h"
#include "errors.h"
#include "progress.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// Three right-hand sides and a spare, side by side in one SIMD register.
using FloatQuad = Eigen::Array4f;
using FloatQuads = std::vector<FloatQuad, Eigen::aligned_allocator<FloatQuad>>;

/**
 * S ~ L D L^T with unit lower triangular L, rows eliminated in the order of their numbers.
 *
 * Up-looking (Davis 2005): row k of L is the sparse solution of L y = S(0:k, k), found along the
 * elimination tree. Entries that contribute less than `dropTolerance` of their row's diagonal,
 * y_i^2 / d_i < dropTolerance^2 s_kk, are dropped as they appear. On the flow's matrices that leaves
 * a quarter of the full factor; S is a diagonally dominant M-matrix, so that pivots stay positive,
 * but for rounding where the shift is tiny: they are kept above 1e-7 of the diagonal.
 *
 * @throws SolverError if a diagonal entry is not positive, or something is not a number.
 * Complexity: linear in the visited part of the full factor, about O(n log n) on surface meshes in
 * a minimum degree order.
 */
class IncompleteFactor
{
public:
	/**
	 * @param M     symmetric, by rows.
	 * @param shift added to M's diagonal, #rows, > 0.
	 * @throws Cancelled, and what the class says.
	 */
	IncompleteFactor(const SymmetricRows& M, const std::vector<double>& shift, float dropTolerance,
		const Progress& progress = Progress())
	{
		const int n = M.size();
		inverseDiagonal.resize(n);
		std::vector<float> y(n, 0.f);
		std::vector<int> parent(n, -1), visited(n, -1), path(n), pattern(n);
		std::vector<int> firstChunk(n, -1), lastChunk(n, -1), lengths(n, 0);
		std::vector<Chunk> chunks;
		chunks.reserve(2 * size_t(n));
		constexpr int reportEvery = 1 << 13; // the last rows of a large system cost the most
		for (int k = 0; k < n; ++k) {
			if (k % reportEvery == 0)
				progress.report(double(k) / n, "Contracting");
			visited[k] = k;
			int top = n;
			for (int e = M.start[k]; e < M.start[k + 1]; ++e) {
				int i = M.column[e];
				if (i > k)
					continue;
				y[i] += float(M.value[e]);
				int length = 0;
				for (; visited[i] != k; i = parent[i]) {
					if (parent[i] < 0)
						parent[i] = k;
					path[length++] = i;
					visited[i] = k;
				}
				while (length > 0)
					pattern[--top] = path[--length];
			}
			const float own = float(M.diagonal[k] + shift[k]);
			const float threshold = dropTolerance * dropTolerance * own;
			float pivot = own;
			for (; top < n; ++top) {
				const int i = pattern[top];
				const float yi = y[i];
				y[i] = 0;
				const float contribution = yi * yi * inverseDiagonal[i];
				if (contribution < threshold)
					continue;
				for (int c = firstChunk[i], left = lengths[i]; left > 0; c = chunks[c].next) {
					const Chunk& chunk = chunks[c];
					const int count = std::min(left, Chunk::capacity);
					for (int e = 0; e < count; ++e)
						y[chunk.row[e]] -= chunk.value[e] * yi;
					left -= count;
				}
				pivot -= contribution;
				const int slot = lengths[i] % Chunk::capacity;
				if (slot == 0) {
					const int fresh = int(chunks.size());
					chunks.emplace_back();
					(lengths[i] == 0 ? firstChunk[i] : chunks[lastChunk[i]].next) = fresh;
					lastChunk[i] = fresh;
				}
				chunks[lastChunk[i]].row[slot] = k;
				chunks[lastChunk[i]].value[slot] = yi * inverseDiagonal[i];
				++lengths[i];
			}
			if (!(own > 0) || std::isnan(pivot))
				throw SolverError(
					"The contraction's linear system could not be factorised: the mesh "
					"has degenerate triangles. Resample it first.");
			inverseDiagonal[k] = 1 / std::max(pivot, 1e-7f * own);
		}
		flatten(chunks, firstChunk, lengths);
	}

	/// x <- (L D L^T)^-1 x.
	void solve(FloatQuads& x) const
	{
		const int n = int(inverseDiagonal.size());
		for (int i = 0; i < n; ++i) {
			const FloatQuad xi = x[i];
			for (int e = start[i]; e < start[i + 1]; ++e)
				x[row[e]] -= value[e] * xi;
		}
		for (int i = n - 1; i >= 0; --i) {
			FloatQuad xi = x[i] * inverseDiagonal[i];
			for (int e = start[i]; e < start[i + 1]; ++e)
				xi -= value[e] * x[row[e]];
			x[i] = xi;
		}
	}

private:
	/// Columns grow while others do: they are kept in linked pieces, then laid side by side.
	struct Chunk
	{
		static constexpr int capacity = 8;
		int row[capacity];
		float value[capacity];
		int next;
	};

	std::vector<float> inverseDiagonal;
	std::vector<int> start, row;
	std::vector<float> value;

	void flatten(const std::vector<Chunk>& chunks, const std::vector<int>& firstChunk,
		const std::vector<int>& lengths)
	{
		const int n = int(lengths.size());
		start.resize(n + 1);
		start[0] = 0;
		for (int i = 0; i < n; ++i)
			start[i + 1] = start[i] + lengths[i];
		row.resize(start[n]);
		value.resize(start[n]);
		for (int i = 0; i < n; ++i) {
			int to = start[i];
			for (int c = firstChunk[i], left = lengths[i]; left > 0; c = chunks[c].next) {
				const int count = std::min(left, Chunk::capacity);
				std::copy(chunks[c].row, chunks[c].row + count, row.begin() + to);
				std::copy(chunks[c].value, chunks[c].value + count, value.begin() + to);
				to += count;
				left -= count;
			}
		}
	}
};

} // namespace vcg::tri::mcf

#endif
