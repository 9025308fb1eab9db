// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "shapes.h"

#include <skeleton/flow/cotangent_weights.h>
#include <skeleton/flow/flow_system.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using systems::cotangentLaplacian;
using systems::cotangentWeights;
using vcg::Point3d;

namespace {

Eigen::MatrixXd dense(const SymmetricRows& A)
{
	return systems::sparse(A);
}

/// L applied to the positions of a mesh, in double precision.
std::vector<Point3d> curvature(const SurfaceMesh& mesh)
{
	const std::vector<double> weight = cotangentWeights(mesh);
	std::vector<Point3d> sum(size_t(mesh.vertexSlots()), Point3d(0, 0, 0));
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		mesh.forEachOutgoing(v, [&](int h) {
			sum[v] += (mesh.position[v] - mesh.position[mesh.target(h)]) * weight[h];
		});
	return sum;
}

std::vector<Point3d> times(const SymmetricRows& A, const std::vector<Point3d>& x)
{
	FloatQuads quads;
	for (const Point3d& p : x)
		quads.emplace_back(float(p[0]), float(p[1]), float(p[2]), 0.f);
	std::vector<Point3d> y(x.size());
	A.forEachProduct(
		quads, [&](int i, const FloatQuad& sum) { y[i] = Point3d(sum[0], sum[1], sum[2]); });
	return y;
}

/// Angle at p between the directions to q and r.
double angle(const Point3d& p, const Point3d& q, const Point3d& r)
{
	return std::atan2(((q - p) ^ (r - p)).Norm(), (q - p) * (r - p));
}

} // namespace

TEST(CotangentLaplacian, WeightsAreTheMeansOfTheOppositeCotangents)
{
	const SurfaceMesh mesh = shapes::jittered(shapes::sphere(2), 0.02).mesh();
	const std::vector<double> weight = cotangentWeights(mesh);
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
		double sum = 0;
		for (int e : {h, mesh.twin(h)})
			sum += 1
				/ std::tan(angle(mesh.position[mesh.apex(e)], mesh.position[mesh.origin(e)],
					mesh.position[mesh.target(e)]));
		EXPECT_NEAR(weight[h], std::max(sum / 2, 1e-3), 1e-9);
		EXPECT_EQ(weight[h], weight[mesh.twin(h)]);
	}
}

/// The matrix that the flow solves with: so are all of this file.
TEST(CotangentLaplacian, HasTheCotangentsOfTheAnglesTimesItsFactors)
{
	for (const shapes::Soup& soup : {shapes::jittered(shapes::sphere(2), 0.02),
			 shapes::joined({shapes::torus(1, 0.3, 12, 8), shapes::box()})}) {
		const SurfaceMesh mesh = soup.mesh();
		// cot(alpha) + cot(beta) of each edge, at least 0.002, and minus their sum on the diagonal.
		Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(mesh.vertexSlots(), mesh.vertexSlots());
		for (int f = 0; f < mesh.faceSlots(); ++f) {
			const Triangle t = mesh.triangle(f);
			for (int k = 0; k < 3; ++k) {
				const int i = t[size_t((k + 1) % 3)], j = t[size_t((k + 2) % 3)];
				const double cotangent = 1
					/ std::tan(
						angle(mesh.position[t[size_t(k)]], mesh.position[i], mesh.position[j]));
				expected(i, j) -= cotangent;
				expected(j, i) -= cotangent;
			}
		}
		for (int h = 0; h < mesh.halfEdgeSlots(); ++h) {
			double& entry = expected(mesh.origin(h), mesh.target(h));
			entry = std::min(entry, -0.002);
		}
		for (int i = 0; i < expected.rows(); ++i)
			expected(i, i) = -expected.row(i).sum();

		Parameters parameters;
		for (const auto& [factor, wL] : {std::pair {0.5, 1.0}, {1.0, 1.0}, {0.5, 6.0}}) {
			parameters.cotangentFactor = factor;
			parameters.wL = wL;
			const FlowSystem system =
				flowSystem(initialStage(mesh, checks::noPoles(mesh)), parameters);
			const Eigen::MatrixXd M = dense(system.M);
			ASSERT_EQ(M.rows(), expected.rows());
			for (int i = 0; i < M.rows(); ++i)
				EXPECT_NEAR(system.M.diagonal[size_t(i)], M(i, i), 1e-5 * M(i, i));
			for (int i = 0; i < M.rows(); ++i)
				for (int j = 0; j < M.rows(); ++j)
					EXPECT_NEAR(M(i, j),
						factor * wL * expected(system.vertex[size_t(i)], system.vertex[size_t(j)]),
						1e-5 * wL);
		}
	}
}

TEST(CotangentLaplacian, ConstantsAreItsNullSpace)
{
	for (const shapes::Soup& soup :
		{shapes::octahedron(), shapes::jittered(shapes::torus(1, 0.3, 12, 8), 0.05)}) {
		const Eigen::MatrixXd L = dense(cotangentLaplacian(soup.mesh()));
		EXPECT_LT((L * Eigen::VectorXd::Ones(L.rows())).norm(), 1e-11);
		EXPECT_EQ(L, L.transpose());
		const Eigen::VectorXd eigenvalues =
			Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(L).eigenvalues();
		EXPECT_NEAR(eigenvalues[0], 0, 1e-11);
		EXPECT_GT(eigenvalues[1], 1e-3); // one component: constants are all of the null space
	}
}

TEST(CotangentLaplacian, HasOneZeroEigenvalueForEachComponent)
{
	const SurfaceMesh mesh =
		shapes::joined({shapes::octahedron(), shapes::box(), shapes::tetrahedron()}).mesh();
	const Eigen::VectorXd eigenvalues =
		Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(cotangentLaplacian(mesh)))
			.eigenvalues();
	EXPECT_NEAR(eigenvalues[2], 0, 1e-11);
	EXPECT_GT(eigenvalues[3], 1e-2);
}

TEST(CotangentLaplacian, VanishesOnLinearFunctionsInsideAFlatPatch)
{
	// A plate sheared so that its top has even triangles, then made uneven in its plane: the
	// coordinates are linear functions of the place.
	shapes::Soup soup = shapes::transformed(shapes::plate(1, 4),
		[](const Point3d& p) { return Point3d(p[0] - p[1] / 2, p[1] * std::sqrt(0.75), p[2]); });
	const SurfaceMesh flat = soup.mesh();
	std::vector<char> inside(soup.points.size(), 1);
	for (int v = 0; v < flat.vertexSlots(); ++v)
		flat.forEachOutgoing(v,
			[&](int h) { inside[v] &= flat.position[flat.target(h)][2] == flat.position[v][2]; });
	std::mt19937 random(1);
	int count = 0;
	for (size_t v = 0; v < soup.points.size(); ++v)
		if (inside[v]) {
			for (int k = 0; k < 2; ++k)
				soup.points[v][k] += 0.03 * double(random() % 100) / 100;
			++count;
		}
	ASSERT_GT(count, 50);
	const SurfaceMesh mesh = soup.mesh();
	const std::vector<Point3d> Lx = curvature(mesh);
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (inside[v]) {
			EXPECT_LT(Lx[v].Norm(), 1e-12);
		}
}

TEST(CotangentLaplacian, OfThePositionsPointsOutwardsOnASphere)
{
	// (L x)_i = sum w_ij (x_i - x_j) is the mean curvature normal: outwards for a convex body seen from outside.
	const SurfaceMesh mesh = shapes::sphere(3).mesh();
	const std::vector<Point3d> Lx = curvature(mesh);
	double sum = 0;
	for (int v = 0; v < mesh.vertexSlots(); ++v) {
		EXPECT_GT(Lx[v] * mesh.position[v], 0);
		sum += Lx[v] * mesh.position[v];
	}
	// x . L x is twice the Dirichlet energy of the positions, which is the area.
	EXPECT_NEAR(sum, 2 * mesh.area(), 1e-9);
}

TEST(CotangentLaplacian, DoesNotDependOnScaleAndPlace)
{
	const shapes::Soup soup = shapes::jittered(shapes::torus(), 0.01);
	const std::vector<double> weight = cotangentWeights(soup.mesh());
	for (double scale : {1e-8, 1e-6, 1e6, 1e8}) {
		const std::vector<double> other = cotangentWeights(shapes::scaled(soup, scale).mesh());
		for (size_t h = 0; h < weight.size(); ++h)
			EXPECT_NEAR(other[h], weight[h], 1e-9 * (1 + std::abs(weight[h])));
	}
	const std::vector<double> moved =
		cotangentWeights(shapes::moved(soup, {1000, 2000, -3000}).mesh());
	for (size_t h = 0; h < weight.size(); ++h)
		EXPECT_NEAR(moved[h], weight[h], 1e-6 * (1 + std::abs(weight[h])));
}

TEST(CotangentLaplacian, WeightsStayPositiveAndBoundedWhateverTheTriangles)
{
	std::mt19937 random(3);
	for (int kind = 0; kind < 4; ++kind) {
		shapes::Soup soup = shapes::sphere(2);
		for (Point3d& p : soup.points)
			switch (kind) {
			case 0: p = Point3d(0, 0, 0); break;                 // no extent at all
			case 1: p = Point3d(p[0], 0, 0); break;              // all angles 0 or 180 degrees
			case 2: p = Point3d(p[0], p[1] * 1e-9, p[2]); break; // a flat pancake
			default: p = Point3d(double(random() % 3), double(random() % 3), double(random() % 3));
			}
		const SurfaceMesh mesh = soup.mesh();
		for (double w : cotangentWeights(mesh)) {
			EXPECT_GE(w, 1e-3);
			EXPECT_LE(w, 100);
		}
		const Eigen::MatrixXd L = dense(cotangentLaplacian(mesh));
		const double largest = L.diagonal().maxCoeff();
		EXPECT_LT((L * Eigen::VectorXd::Ones(L.rows())).cwiseAbs().maxCoeff(), 1e-12 * largest);
		EXPECT_GT(
			Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(L).eigenvalues()[0], -1e-12 * largest);
	}
}

TEST(SymmetricRows, MultipliesThreeColumnsAtOnce)
{
	const SymmetricRows L = cotangentLaplacian(shapes::jittered(shapes::sphere(1), 0.1).mesh());
	const Eigen::MatrixXd D = dense(L);
	std::mt19937 random(9);
	std::vector<Point3d> x(L.size());
	Eigen::MatrixXd X(L.size(), 3);
	for (int i = 0; i < L.size(); ++i)
		for (int k = 0; k < 3; ++k)
			X(i, k) = x[i][k] = double(random() % 1000) / 1000;
	const std::vector<Point3d> y = times(L, x);
	const Eigen::MatrixXd Y = D * X;
	for (int i = 0; i < L.size(); ++i)
		for (int k = 0; k < 3; ++k)
			EXPECT_NEAR(y[i][k], Y(i, k), 1e-5);
}
