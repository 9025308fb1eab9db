// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/solver/local_ldlt.h>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

/// The Laplacian of a grid plus `pull` at each vertex: values reach some 1 / sqrt(pull) vertices far.
Eigen::SparseMatrix<double> grid(int width, int height, double pull)
{
	std::vector<Eigen::Triplet<double>> entries;
	const auto join = [&](int a, int b) {
		entries.push_back({std::max(a, b), std::min(a, b), -1});
		entries.push_back({a, a, 1});
		entries.push_back({b, b, 1});
	};
	for (int y = 0; y < height; ++y)
		for (int x = 0; x < width; ++x) {
			const int v = y * width + x;
			entries.push_back({v, v, pull});
			if (x + 1 < width)
				join(v, v + 1);
			if (y + 1 < height)
				join(v, v + width);
		}
	Eigen::SparseMatrix<double> lower(width * height, width * height);
	lower.setFromTriplets(entries.begin(), entries.end());
	return lower;
}

Eigen::VectorXd solved(
	LocalLdlt& solver, int n, const std::vector<std::pair<int, double>>& right, double negligible)
{
	Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
	solver.solve(right, negligible, Progress(), "", [&](int v, double value) {
		EXPECT_EQ(x[v], 0) << "visited twice";
		x[v] = value;
	});
	return x;
}

} // namespace

TEST(LocalLdlt, SolvesWhatADenseSolverSolves)
{
	const Eigen::SparseMatrix<double> lower = grid(20, 15, 0.1);
	const int n = int(lower.rows());
	LocalLdlt solver(lower, Progress(), "");
	const Eigen::MatrixXd dense = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
	// The second one finds nothing left of the first.
	for (const std::vector<std::pair<int, double>>& right :
		{std::vector<std::pair<int, double>> {{17, 2.0}, {200, 0.5}}, {{299, 1.0}}}) {
		Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
		for (const auto& [v, value] : right)
			b[v] = value;
		const Eigen::VectorXd expected = dense.ldlt().solve(b);
		EXPECT_LT((solved(solver, n, right, 0) - expected).cwiseAbs().maxCoeff(), 1e-12);
	}
}

TEST(LocalLdlt, LeavesOutWhatIsNegligibleAndNothingElse)
{
	const Eigen::SparseMatrix<double> lower = grid(150, 4, 1);
	const int n = int(lower.rows());
	LocalLdlt solver(lower, Progress(), "");
	const std::vector<std::pair<int, double>> right {{3, 1.0}, {7, 1.0}};
	const Eigen::VectorXd all = solved(solver, n, right, 0);
	const Eigen::VectorXd large = solved(solver, n, right, 1e-4);
	int left = 0;
	for (int v = 0; v < n; ++v) {
		EXPECT_EQ(large[v], all[v] > 1e-4 ? all[v] : 0) << v;
		left += large[v] > 0;
	}
	EXPECT_GT(left, 20);
	EXPECT_LT(left, n / 4);
}

TEST(LocalLdlt, PartsThatAreNotConnected)
{
	Eigen::SparseMatrix<double> lower(3, 3);
	for (int v = 0; v < 3; ++v)
		lower.insert(v, v) = v + 1;
	LocalLdlt solver(lower, Progress(), "");
	EXPECT_EQ(solved(solver, 3, {{1, 4.0}}, 0), Eigen::Vector3d(0, 2, 0));
	EXPECT_EQ(solved(solver, 3, {}, 0), Eigen::Vector3d(0, 0, 0));
}

TEST(LocalLdlt, NotPositiveDefinite)
{
	EXPECT_THROW(LocalLdlt(grid(5, 5, -3), Progress(), ""), SolverError);
}

TEST(LocalLdlt, CanBeCancelledAtEveryReport)
{
	const Eigen::SparseMatrix<double> lower = grid(60, 60, 0.1);
	int reports = 0, allowed = 1 << 30;
	const Progress progress([&](int, const char*) { return ++reports <= allowed; });
	const auto run = [&] {
		reports = 0;
		LocalLdlt solver(lower, progress.part(0, 0.5), "");
		solver.solve({{0, 1.0}}, 0, progress.part(0.5, 1), "", [](int, double) {});
	};
	run();
	const int count = reports;
	EXPECT_GT(count, 10);
	for (allowed = 0; allowed < count; ++allowed)
		EXPECT_THROW(run(), Cancelled);
}
