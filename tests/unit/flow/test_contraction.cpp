// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_systems.h"
#include "mesh_checks.h"
#include "shapes.h"
#include "threads.h"

#include <skeleton/flow/contraction.h>
#include <skeleton/poles/shrinking_balls.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Stage stageWithPoles(const shapes::Soup& soup)
{
	const SurfaceMesh mesh = soup.mesh();
	return initialStage(mesh, shrinkingBallPoles(mesh));
}

/// For each half-edge the sum of the cotangents of the two angles opposite, by the angles.
std::vector<double> cotangentSums(const SurfaceMesh& mesh)
{
	std::vector<double> sum(size_t(mesh.halfEdgeSlots()), 0);
	for (int h = 0; h < mesh.halfEdgeSlots(); ++h)
		for (int e : {h, mesh.twin(h)}) {
			const Point3d& apex = mesh.position[mesh.apex(e)];
			const Point3d u = mesh.position[mesh.origin(e)] - apex,
						  v = mesh.position[mesh.target(e)] - apex;
			sum[size_t(h)] += 1 / std::tan(std::acos(u * v / (u.Norm() * v.Norm())));
		}
	return sum;
}

/// The quadratic form of Eq. 6 at the start of a step, spelled out from the paper: the published (w_L, 20, 40) is
/// (w_L, 0.1, 0.2) for the weights cot(alpha) + cot(beta). Nothing of it is taken from the library, whose
/// `cotangentFactor` says which part of that sum its weights are, at least 0.002 of it.
struct Energy
{
	const Stage& start;
	double wL, wH, wM;
	std::vector<double> weight;
	std::vector<char> pulled; ///< whether the vertex has a medial term

	Energy(const Stage& start, const Parameters& p) :
			start(start), wL(p.wL * p.cotangentFactor), wH(p.wH / 20 * 0.1), wM(p.wM / 40 * 0.2),
			weight(cotangentSums(start.mesh)), pulled(start.pole.size())
	{
		for (double& w : weight)
			w = std::max(w, 0.002);
		const std::vector<Point3d> normal = start.mesh.vertexNormals();
		for (size_t v = 0; v < pulled.size(); ++v)
			pulled[v] = start.poleRadius[v] >= 0
				&& (start.pole[v] - start.mesh.position[v]) * normal[v] <= 0;
	}

	double operator()(const std::vector<Point3d>& x) const
	{
		double sum = 0;
		for (int v = 0; v < int(x.size()); ++v) {
			if (start.fixed[v])
				continue;
			Point3d Lx(0, 0, 0);
			start.mesh.forEachOutgoing(
				v, [&](int h) { Lx += (x[v] - x[start.mesh.target(h)]) * weight[h]; });
			sum += wL * wL * Lx.SquaredNorm();
			sum += wH * wH * vcg::SquaredDistance(x[v], start.mesh.position[v]);
			if (pulled[v])
				sum += wM * wM * vcg::SquaredDistance(x[v], start.pole[v]);
		}
		return sum;
	}

	/// The exact minimum, by Eigen.
	std::vector<Point3d> minimum() const
	{
		std::vector<int> unknown(start.fixed.size(), -1);
		int n = 0;
		for (size_t v = 0; v < unknown.size(); ++v)
			if (!start.fixed[v])
				unknown[v] = n++;
		std::vector<Eigen::Triplet<double>> entries;
		Eigen::MatrixXd known = Eigen::MatrixXd::Zero(n, 3), right(n, 3);
		std::vector<double> D(n);
		for (int v = 0; v < int(unknown.size()); ++v) {
			const int i = unknown[v];
			if (i < 0)
				continue;
			start.mesh.forEachOutgoing(v, [&](int h) {
				const int w = start.mesh.target(h);
				entries.emplace_back(i, i, wL * weight[h]);
				if (unknown[w] >= 0)
					entries.emplace_back(i, unknown[w], -wL * weight[h]);
				else
					for (int k = 0; k < 3; ++k)
						known(i, k) -= wL * weight[h] * start.mesh.position[w][k];
			});
			D[i] = wH * wH + (pulled[v] ? wM * wM : 0);
			for (int k = 0; k < 3; ++k)
				right(i, k) = wH * wH * start.mesh.position[v][k]
					+ (pulled[v] ? wM * wM * start.pole[v][k] : 0);
		}
		systems::Sparse M(n, n);
		M.setFromTriplets(entries.begin(), entries.end());
		const Eigen::MatrixXd X =
			systems::solved(systems::Sparse(M * M) + systems::diagonal(D), right - M * known);
		std::vector<Point3d> x = start.mesh.position;
		for (size_t v = 0; v < unknown.size(); ++v)
			if (unknown[v] >= 0)
				for (int k = 0; k < 3; ++k)
					x[v][k] = X(unknown[v], k);
		return x;
	}
};

double largestMove(const std::vector<Point3d>& a, const std::vector<Point3d>& b)
{
	double largest = 0;
	for (size_t v = 0; v < a.size(); ++v)
		largest = std::max(largest, vcg::Distance(a[v], b[v]));
	return largest;
}

} // namespace

TEST(Contraction, MovesAComponentAsItWouldAlone)
{
	const std::vector<shapes::Soup> soups = {shapes::torus(1, 0.3, 90, 30), shapes::tetrahedron(),
		shapes::moved(shapes::torus(1, 0.4, 80, 40), {5, 0, 0}),
		shapes::moved(shapes::capsule(), {0, 5, 0})};
	shapes::Soup soup;
	PoleSet poles;
	std::vector<Point3d> expected;
	for (const shapes::Soup& alone : soups) {
		const SurfaceMesh mesh = alone.mesh();
		const PoleSet own = shrinkingBallPoles(mesh);
		soup = shapes::joined({soup, alone});
		poles.centre.insert(poles.centre.end(), own.centre.begin(), own.centre.end());
		poles.radius.insert(poles.radius.end(), own.radius.begin(), own.radius.end());
		Stage stage = initialStage(mesh, own);
		contract(stage, Parameters());
		expected.insert(expected.end(), stage.mesh.position.begin(), stage.mesh.position.end());
	}
	const Stage start = initialStage(soup.mesh(), poles);
	for (int threads : {1, 2, 5}) {
		const ThreadCount limit(threads);
		Stage stage = start;
		contract(stage, Parameters());
		EXPECT_EQ(stage.mesh.position, expected) << threads; // to the last bit
	}
}

TEST(Contraction, LargeSystemsAreTheSameOnAnyNumberOfThreads)
{
	const SurfaceMesh mesh = shapes::jittered(shapes::torus(1, 0.3, 220, 100), 0.002).mesh();
	Stage stage = initialStage(mesh, shrinkingBallPoles(mesh));
	for (size_t v = 0; v < stage.fixed.size(); v += 7)
		stage.fixed[v] = 1;
	const auto systemOn = [&](int threads) {
		const ThreadCount limit(threads);
		return flowSystem(stage, Parameters());
	};
	const FlowSystem one = systemOn(1);
	ASSERT_GT(one.vertex.size(), 1u << 14); // as many as several threads share
	for (int threads : {2, 5}) {
		const FlowSystem several = systemOn(threads);
		EXPECT_EQ(several.vertex, one.vertex);
		EXPECT_EQ(several.M.start, one.M.start);
		EXPECT_EQ(several.M.excess, one.M.excess);
		EXPECT_EQ(several.M.diagonal, one.M.diagonal);
		EXPECT_EQ(several.D, one.D);
		EXPECT_EQ(several.b, one.b);
		const auto isSame = [](const SparseEntry& x, const SparseEntry& y) {
			return x.index == y.index && x.value == y.value;
		};
		EXPECT_TRUE(std::equal(several.M.entries.begin(), several.M.entries.end(),
			one.M.entries.begin(), one.M.entries.end(), isSame));
	}
}

TEST(Contraction, MinimisesEquationSix)
{
	for (const shapes::Soup& soup : {shapes::jittered(shapes::torus(), 0.005), shapes::capsule(),
			 shapes::plate(2, 3), shapes::octahedron(), shapes::tetrahedron()}) {
		const Stage start = stageWithPoles(soup);
		const Energy energy(start, Parameters());
		Stage stage = start;
		contract(stage, Parameters());
		if (soup.points.size() > 8) {
			EXPECT_GT(std::count(energy.pulled.begin(), energy.pulled.end(), 1), 0);
		}
		const double before = energy(start.mesh.position), after = energy(stage.mesh.position);
		const double minimum = energy(energy.minimum());
		EXPECT_LT(after, before);
		EXPECT_GE(after, minimum * (1 - 1e-9));
		// The solver stops at one per cent of its residual: less in the energy.
		EXPECT_LT(after - minimum, 1e-3 * (before - minimum));
		EXPECT_LT(largestMove(stage.mesh.position, energy.minimum()),
			0.05 * largestMove(stage.mesh.position, start.mesh.position));
	}
}

TEST(Contraction, SolvedDirectlyItIsTheMinimumForAnyWeights)
{
	const Stage start = stageWithPoles(shapes::jittered(shapes::torus(), 0.005));
	for (double factor : {0.5, 1.0})
		for (const auto& [wL, wH, wM] : {std::array {1.0, 20.0, 40.0}, {6.0, 20.0, 0.0},
				 {1.0, 60.0, 40.0}, {0.5, 20.0, 160.0}}) {
			Parameters parameters;
			parameters.cotangentFactor = factor;
			parameters.wL = wL;
			parameters.wH = wH;
			parameters.wM = wM;
			parameters.directSolver = true;
			Stage stage = start;
			contract(stage, parameters);
			const std::vector<Point3d> minimum = Energy(start, parameters).minimum();
			EXPECT_LT(largestMove(stage.mesh.position, minimum),
				1e-4 * largestMove(start.mesh.position, minimum)) // single precision
				<< factor << " (" << wL << ", " << wH << ", " << wM << ")";
		}
}

TEST(Contraction, AnyOtherPositionsHaveMoreEnergy)
{
	const Stage start = stageWithPoles(shapes::capsule());
	Stage stage = start;
	contract(stage, Parameters());
	const Energy energy(start, Parameters());
	const double minimum = energy(stage.mesh.position);
	for (unsigned seed = 0; seed < 20; ++seed) {
		std::vector<Point3d> other = stage.mesh.position;
		const std::vector<Point3d> offset = systems::randomColumns(int(other.size()), seed);
		for (size_t v = 0; v < other.size(); ++v)
			other[v] += offset[v] * 0.01;
		EXPECT_GT(energy(other), minimum);
	}
	for (const Point3d& by : {Point3d(0.02, 0, 0), Point3d(0, 0.02, 0), Point3d(0, 0, -0.02)}) {
		std::vector<Point3d> moved = stage.mesh.position, grown = moved;
		for (size_t v = 0; v < moved.size(); ++v) {
			moved[v] += by;
			grown[v] *= 1 + by[0] + by[1] + by[2];
		}
		EXPECT_GT(energy(moved), minimum);
		EXPECT_GT(energy(grown), minimum);
	}
}

TEST(Contraction, FixedVerticesStayAndTheOthersKnowThem)
{
	Stage start = stageWithPoles(shapes::jittered(shapes::torus(), 0.005));
	for (size_t v = 0; v < start.fixed.size(); v += 7)
		start.fixed[v] = 1;
	Stage stage = start;
	contract(stage, Parameters());
	for (size_t v = 0; v < start.fixed.size(); ++v) {
		if (start.fixed[v]) {
			EXPECT_EQ(stage.mesh.position[v], start.mesh.position[v]);
		}
		else {
			EXPECT_NE(stage.mesh.position[v], start.mesh.position[v]);
		}
	}
	const std::vector<Point3d> minimum = Energy(start, Parameters()).minimum();
	EXPECT_LT(largestMove(stage.mesh.position, minimum),
		0.05 * largestMove(start.mesh.position, minimum));
}

TEST(Contraction, AllFixedIsAllStill)
{
	Stage stage = stageWithPoles(shapes::sphere(1));
	stage.fixed.assign(stage.fixed.size(), 1);
	const std::vector<Point3d> before = stage.mesh.position;
	contract(stage, Parameters());
	EXPECT_EQ(stage.mesh.position, before);
}

TEST(Contraction, WithoutMedialWeightThePolesDoNotMatter)
{
	Parameters plain;
	plain.wM = 0;
	Stage with = stageWithPoles(shapes::plate(1)), without = with, wrong = with;
	without.poleRadius.assign(without.poleRadius.size(), -1);
	for (Point3d& p : wrong.pole)
		p += Point3d(5, 6, 7);
	for (Stage* stage : {&with, &without, &wrong})
		contract(*stage, plain);
	EXPECT_EQ(with.mesh.position, without.mesh.position);
	EXPECT_EQ(with.mesh.position, wrong.mesh.position);
}

TEST(Contraction, APoleThatLiesOutwardsDoesNotPull)
{
	Stage inner = stageWithPoles(shapes::capsule()), outer = inner, none = inner;
	const std::vector<Point3d> normal = inner.mesh.vertexNormals();
	for (size_t v = 0; v < outer.pole.size(); ++v)
		outer.pole[v] = outer.mesh.position[v] + normal[v];
	none.poleRadius.assign(none.poleRadius.size(), -1);
	for (Stage* stage : {&inner, &outer, &none})
		contract(*stage, Parameters());
	EXPECT_EQ(outer.mesh.position, none.mesh.position);
	EXPECT_GT(largestMove(inner.mesh.position, none.mesh.position), 0.01);
}

TEST(Contraction, PolesPullTowardsTheMedialAxis)
{
	// The capsule's axis: with the medial term its vertices come closer to it.
	const auto meanDistance = [](double wM) {
		Stage stage = stageWithPoles(shapes::capsule());
		Parameters parameters;
		parameters.wM = wM;
		contract(stage, parameters);
		double sum = 0;
		for (const Point3d& p : stage.mesh.position)
			sum += std::hypot(p[1], p[2]);
		return sum / double(stage.mesh.position.size());
	};
	EXPECT_LT(meanDistance(40), meanDistance(20));
	EXPECT_LT(meanDistance(20), 0.9 * meanDistance(0));
}

TEST(Contraction, VolumeAndAreaDecrease)
{
	for (const shapes::Soup& soup : {shapes::sphere(3), shapes::torus(), shapes::capsule(),
			 shapes::plate(3), shapes::box(), shapes::octahedron(), shapes::tetrahedron()})
		for (double wM : {0.0, 40.0}) {
			Stage stage = stageWithPoles(soup);
			Parameters parameters;
			parameters.wM = wM;
			double volume = stage.mesh.volume(), area = stage.mesh.area();
			for (int i = 0; i < 3; ++i) {
				contract(stage, parameters);
				EXPECT_LT(
					stage.mesh.volume(), volume + 1e-12); // of a point, nothing is left to lose
				EXPECT_LT(stage.mesh.area(), area);
				EXPECT_GT(
					stage.mesh.volume(), -1e-3 * soup.mesh().volume()); // it does not turn over
				volume = stage.mesh.volume();
				area = stage.mesh.area();
			}
		}
}

TEST(Contraction, SmootherAndSlowerAsTheWeightsSay)
{
	const auto volumeAfter = [](double wL, double wH) {
		Stage stage = stageWithPoles(shapes::torus());
		Parameters parameters;
		parameters.wL = wL;
		parameters.wH = wH;
		parameters.wM = 0;
		contract(stage, parameters);
		return stage.mesh.volume();
	};
	EXPECT_LT(volumeAfter(2, 20), volumeAfter(1, 20));
	EXPECT_LT(volumeAfter(1, 20), volumeAfter(1, 40));
	EXPECT_NEAR(
		volumeAfter(1, 20), volumeAfter(2, 40), 1e-3 * volumeAfter(1, 20)); // the ratio counts
}

TEST(Contraction, DoesNotDependOnScaleAndPlace)
{
	const Stage start = stageWithPoles(shapes::jittered(shapes::torus(), 0.005));
	Stage stage = start;
	contract(stage, Parameters());
	const auto mapped = [&](double scale, const Point3d& shift) {
		Stage other = start;
		for (size_t v = 0; v < other.pole.size(); ++v) {
			other.mesh.position[v] = other.mesh.position[v] * scale + shift;
			other.pole[v] = other.pole[v] * scale + shift;
		}
		contract(other, Parameters());
		for (Point3d& p : other.mesh.position)
			p = (p - shift) / scale;
		return largestMove(other.mesh.position, stage.mesh.position);
	};
	EXPECT_LT(mapped(std::ldexp(1.0, -20), {0, 0, 0}), 1e-9);
	EXPECT_LT(mapped(std::ldexp(1.0, 20), {0, 0, 0}), 1e-9);
	EXPECT_LT(
		mapped(1e-6, {0, 0, 0}), 1e-6); // rounded otherwise, and moves are in single precision
	EXPECT_LT(mapped(1e6, {0, 0, 0}), 1e-6);
	EXPECT_LT(mapped(1, {1000, -2000, 500}), 1e-6);
	EXPECT_LT(mapped(1e-6, {1e-3, 1e-3, 1e-3}), 1e-6);
}

TEST(Contraction, ThrowsInsteadOfLeavingTheNumbers)
{
	Stage stage = stageWithPoles(shapes::sphere(2));
	stage.mesh.position[3] = Point3d(std::nan(""), 0, 0);
	EXPECT_THROW(contract(stage, Parameters()), SolverError);
}

TEST(Contraction, APoleThatIsNoNumberDoesNotPull)
{
	Stage bad = stageWithPoles(shapes::sphere(2)), none = bad;
	bad.pole[3] = Point3d(std::nan(""), 0, 0);
	none.poleRadius[3] = -1;
	contract(bad, Parameters());
	contract(none, Parameters());
	EXPECT_EQ(bad.mesh.position, none.mesh.position);
}

TEST(Contraction, ExtremeWeightsAreSolvedToo)
{
	// Any weight that Parameters::check() takes must give a step, or a clear error.
	for (double wL : {1e-3, 1.0, 100.0})
		for (double wH : {1e-2, 20.0, 1e4})
			for (double wM : {0.0, 40.0, 1e4}) {
				Stage stage = stageWithPoles(shapes::torus());
				Parameters parameters;
				parameters.wL = wL;
				parameters.wH = wH;
				parameters.wM = wM;
				const double volume = stage.mesh.volume();
				SCOPED_TRACE(
					testing::Message() << "w_L " << wL << ", w_H " << wH << ", w_M " << wM);
				ASSERT_NO_THROW(contract(stage, parameters));
				EXPECT_LT(stage.mesh.volume(), volume);
				EXPECT_LT(stage.mesh.bounds().Diag(), 1.01 * stage.diagonal[0]);
			}
}

TEST(Contraction, AllWeightsThatAreTakenCanBeSolvedFor)
{
	const Stage start = stageWithPoles(shapes::jittered(shapes::torus(1, 0.3, 30, 12), 0.005));
	const double low = Parameters::minWeight, high = Parameters::maxWeight;
	for (double factor : {low, 0.5, high})
		for (double wL : {low, 1.0, high})
			for (double wH : {low, 20.0, high})
				for (double wM : {0.0, 40.0, high}) {
					Parameters parameters;
					parameters.cotangentFactor = factor;
					parameters.wL = wL;
					parameters.wH = wH;
					parameters.wM = wM;
					ASSERT_NO_THROW(parameters.check());
					Stage stage = start;
					EXPECT_NO_THROW(contract(stage, parameters))
						<< factor << " (" << wL << ", " << wH << ", " << wM << ")";
				}
}

TEST(Contraction, AVelocityWeightThatIsTooSmallForTheDirectSolverIsNamed)
{
	Stage stage = stageWithPoles(shapes::jittered(shapes::torus(), 0.005));
	Parameters parameters;
	parameters.directSolver = true;
	parameters.wH = Parameters::minWeight;
	parameters.wM = 0;
	try {
		contract(stage, parameters);
		ADD_FAILURE() << "the system is singular in double precision";
	}
	catch (const SolverError& error) {
		EXPECT_NE(std::string(error.what()).find("w_h"), std::string::npos) << error.what();
	}
}

TEST(Contraction, CanBeCancelled)
{
	Stage stage = stageWithPoles(shapes::sphere(2));
	EXPECT_THROW(
		contract(stage, Parameters(), Progress([](int, const char*) { return false; })), Cancelled);
}

namespace {

/// Eq. 6 as it is printed, without bounds on weights and with a pole for every vertex.
struct PrintedEnergy
{
	const Stage& start;
	double wL;
	std::vector<double> weight;

	PrintedEnergy(const Stage& start, double wL) :
			start(start), wL(wL), weight(cotangentSums(start.mesh))
	{
	}

	double operator()(const std::vector<Point3d>& x) const
	{
		double sum = 0;
		for (int v = 0; v < int(x.size()); ++v) {
			Point3d Lx(0, 0, 0);
			start.mesh.forEachOutgoing(
				v, [&](int h) { Lx += (x[v] - x[start.mesh.target(h)]) * weight[h]; });
			sum += wL * wL * Lx.SquaredNorm()
				+ 0.1 * 0.1 * vcg::SquaredDistance(x[v], start.mesh.position[v])
				+ 0.2 * 0.2 * vcg::SquaredDistance(x[v], start.pole[v]);
		}
		return sum;
	}
};

/// How much the energy falls at most when the vertices move on along the move that was made, in parts of it: 0
/// where the move ends at the least energy of its line, as it must at the least of all.
double overshoot(const PrintedEnergy& energy, const Stage& end)
{
	const auto at = [&](double part) {
		std::vector<Point3d> x = energy.start.mesh.position;
		for (size_t v = 0; v < x.size(); ++v)
			x[v] += (end.mesh.position[v] - energy.start.mesh.position[v]) * part;
		return energy(x);
	};
	const double before = at(0), half = at(0.5), full = at(1);
	// The parabola through the three.
	const double curvature = 2 * (before - 2 * half + full), slope = full - before - curvature;
	return -slope / (2 * curvature) - 1;
}

} // namespace

TEST(Contraction, ThePresetOfThePaperHasItsWeights)
{
	const Stage start = stageWithPoles(shapes::torus(1, 0.3, 40, 14));
	Parameters paper;
	paper.apply(Preset::Paper);
	Stage end = start;
	contract(end, paper);
	const PrintedEnergy energy(start, 1);
	EXPECT_LT(std::abs(overshoot(energy, end)), 1e-3); // weights are at least 1e-3
	const double minimum = energy(end.mesh.position);
	std::mt19937 random(3);
	for (int trial = 0; trial < 20; ++trial) {
		std::vector<Point3d> other = end.mesh.position;
		for (Point3d& p : other)
			for (int k = 0; k < 3; ++k)
				p[k] += 1e-3 * (2.0 * random() / double(std::mt19937::max()) - 1);
		EXPECT_GT(energy(other), minimum);
	}
}

TEST(Contraction, TheDefaultSmoothnessWeightIsHalfThePublishedOne)
{
	const Stage start = stageWithPoles(shapes::torus(1, 0.3, 40, 14));
	Stage end = start;
	Parameters parameters;
	parameters.directSolver = true;
	contract(end, parameters);
	EXPECT_LT(std::abs(overshoot(PrintedEnergy(start, 0.5), end)), 1e-3);
	EXPECT_GT(std::abs(overshoot(PrintedEnergy(start, 1), end)), 1e-2);
}

TEST(Contraction, APoleThatLiesOutwardsPullsWhereItIsNotDropped)
{
	Stage outwards = stageWithPoles(shapes::sphere(2));
	outwards.pole[3] = outwards.mesh.position[3] * 1.5;
	Stage dropped = outwards;
	Parameters parameters;
	contract(dropped, parameters);
	parameters.dropOutwardPoles = false;
	contract(outwards, parameters);
	EXPECT_GT(outwards.mesh.position[3].Norm(), dropped.mesh.position[3].Norm() + 0.01);
}
