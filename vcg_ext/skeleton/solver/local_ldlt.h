// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A direct solver for many right-hand sides, each of which matters in one region only.

#ifndef VCG_MCF_LOCAL_LDLT_H
#define VCG_MCF_LOCAL_LDLT_H

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Solves A x = b by A = L D L^T, A a symmetric M-matrix whose row sums are at least 0, b at least 0.
 *
 * Where b is positive in one region, x decays away from it, and what surely is negligible is not
 * computed. Forward substitution meets only the ancestors of b's places in the elimination tree (Gilbert and Peierls
 * 1988). Backward, from the root, an unknown below which b is 0 is a combination of those that its column of
 * L names, with weights of at least 0 and a sum of at most 1: in a subtree without any of b nothing is larger than
 * the largest of what its root's column names.
 */
class LocalLdlt
{
public:
	/**
	 * Factorises row by row (Davis, "Algorithm 849: a concise sparse Cholesky factorization package", ACM Trans. Math.
	 * Softw. 31(4), 2005), in minimum degree order.
	 * @param lower the lower triangle of A with its diagonal.
	 * @throws SolverError if A is not positive definite; Cancelled
	 * Complexity: about O(n^1.5) on surface meshes.
	 */
	LocalLdlt(
		const Eigen::SparseMatrix<double>& lower, const Progress& progress, const char* what) :
			n(int(lower.rows()))
	{
		Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
		Eigen::AMDOrdering<int>()(
			Eigen::SparseMatrix<double>(lower.selfadjointView<Eigen::Lower>()), inverse);
		const auto order = inverse.inverse().eval();
		unknown.assign(inverse.indices().data(), inverse.indices().data() + n);
		place.assign(order.indices().data(), order.indices().data() + n);
		progress.report(0.1, what);
		Eigen::SparseMatrix<double> upper(
			n, n); // column k: row k of A left of the diagonal, and it
		upper.selfadjointView<Eigen::Upper>() =
			lower.selfadjointView<Eigen::Lower>().twistedBy(order);
		countColumns(upper, progress.part(0.1, 0.15), what);
		factorise(upper, progress.part(0.15, 1), what);
		x.assign(size_t(n), 0);
		isOpen.assign(size_t(n), 0);
		hasRight.assign(size_t(n), 0);
	}

	/**
	 * Calls visit(unknown, value) where x is more than `negligible`.
	 * @param right the places of b that are not 0, and their values, above 0.
	 * @throws Cancelled, after which the solver is of no use any more
	 * Complexity: O(n), and the entries of L in the columns of the region.
	 */
	template <class Visit>
	void solve(const std::vector<std::pair<int, double>>& right, double negligible,
		const Progress& progress, const char* what, Visit&& visit)
	{
		std::vector<int> above;
		for (const auto& [v, value] : right) {
			x[size_t(place[size_t(v)])] += value;
			for (int j = place[size_t(v)]; j >= 0 && !hasRight[size_t(j)]; j = parent[size_t(j)]) {
				hasRight[size_t(j)] = 1;
				above.push_back(j);
			}
		}
		std::sort(above.begin(), above.end());
		for (int j : above)
			for (size_t e = start[size_t(j)]; e < start[size_t(j) + 1]; ++e)
				x[size_t(row[e])] -= entry[e] * x[size_t(j)];
		std::vector<int> solved;
		detail::reportedLoop(n, progress, what, [&](int k) {
			const size_t j = size_t(n - 1 - k);
			const int up = parent[j];
			if (!hasRight[j] && (up < 0 || !isOpen[size_t(up)]))
				return;
			double value = x[j] / diagonal[j], largest = 0;
			for (size_t e = start[j]; e < start[j + 1]; ++e) {
				value -= entry[e] * x[size_t(row[e])];
				largest = std::max(largest, x[size_t(row[e])]);
			}
			x[j] = value;
			isOpen[j] = std::max(largest, value) > negligible;
			solved.push_back(int(j));
			if (value > negligible)
				visit(unknown[j], value);
		});
		for (int j : solved)
			x[size_t(j)] = isOpen[size_t(j)] = hasRight[size_t(j)] = 0;
	}

private:
	using Column = Eigen::SparseMatrix<double>::InnerIterator;

	int n;
	/// The unknown at each place of the elimination order, and back.
	std::vector<int> unknown, place;
	/// In the elimination tree; -1 at a root.
	std::vector<int> parent;
	/// L below its diagonal of ones, by columns, and D.
	std::vector<size_t> start;
	std::vector<int> row;
	std::vector<double> entry, diagonal;
	/// By places, all 0 between two calls of solve().
	std::vector<double> x;
	std::vector<char> isOpen, hasRight;

	/// The elimination tree, and how many entries each column of L has.
	void countColumns(
		const Eigen::SparseMatrix<double>& upper, const Progress& progress, const char* what)
	{
		parent.assign(size_t(n), -1);
		std::vector<int> seen(size_t(n), -1);
		start.assign(size_t(n) + 1, 0);
		detail::reportedLoop(n, progress, what, [&](int k) {
			seen[size_t(k)] = k;
			for (Column a(upper, k); a; ++a)
				for (int i = int(a.row()); seen[size_t(i)] != k; i = parent[size_t(i)]) {
					if (parent[size_t(i)] < 0)
						parent[size_t(i)] = k;
					++start[size_t(i) + 1];
					seen[size_t(i)] = k;
				}
		});
		for (size_t j = 0; j < size_t(n); ++j)
			start[j + 1] += start[j];
	}

	void factorise(
		const Eigen::SparseMatrix<double>& upper, const Progress& progress, const char* what)
	{
		row.resize(start.back());
		entry.resize(start.back());
		diagonal.resize(size_t(n));
		std::vector<size_t> end(start.begin(), start.end() - 1);
		std::vector<double> y(size_t(n), 0);
		std::vector<int> seen(size_t(n), -1), path, pattern;
		for (int k = 0; k < n; ++k) {
			seen[size_t(k)] = k;
			pattern.clear();
			for (Column a(upper, k); a; ++a) {
				y[size_t(a.row())] += a.value();
				path.clear();
				for (int i = int(a.row()); seen[size_t(i)] != k; i = parent[size_t(i)]) {
					path.push_back(i);
					seen[size_t(i)] = k;
				}
				// Later paths end in earlier ones, so they come first: the pattern is built from its back.
				pattern.insert(pattern.end(), path.rbegin(), path.rend());
			}
			double d = y[size_t(k)];
			y[size_t(k)] = 0;
			for (auto p = pattern.rbegin(); p != pattern.rend(); ++p) {
				const size_t i = size_t(*p);
				const double value = y[i], l = value / diagonal[i];
				y[i] = 0;
				for (size_t e = start[i]; e < end[i]; ++e)
					y[size_t(row[e])] -= entry[e] * value;
				d -= l * value;
				row[end[i]] = k;
				entry[end[i]++] = l;
			}
			if (!(d > 0))
				throw SolverError("A matrix is not positive definite.");
			diagonal[size_t(k)] = d;
			if (k % 256 == 0)
				progress.report(double(k) / n, what);
		}
	}
};

} // namespace vcg::tri::mcf

#endif
