// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What the paper says of its flow, against closed forms.

#include "mesh_checks.h"
#include "shapes.h"

#include <skeleton/flow/contraction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

/// One step of the plain flow (w_M = 0), in the published unit and solved directly.
std::vector<Point3d> afterOneStep(Stage stage, double wL, double wH)
{
	Parameters parameters;
	parameters.apply(Preset::Paper);
	parameters.wL = wL;
	parameters.wH = wH;
	contract(stage, parameters);
	return stage.mesh.position;
}

/// A torus whose tube of radius 1 is nearly straight, on a regular grid.
struct Tube
{
	static constexpr double major = 30;
	static constexpr int around = 300, across = 20;
	shapes::Soup soup = shapes::torus(major, 1, around, across);

	/// Vertex of the ring i and of the place j on it; j = 0 is on the outer equator.
	static int at(int i, int j) { return (i % around) * across + j % across; }

	static double radius(const std::vector<Point3d>& place)
	{
		double sum = 0;
		for (const Point3d& p : place)
			sum += std::hypot(std::hypot(p[0], p[1]) - major, p[2]);
		return sum / double(place.size());
	}
};

} // namespace

TEST(Theory, OneStepShrinksATubeAsTheClosedFormSays)
{
	// On a regular grid with sides a across and b along, L x = 2 (b / a) (2 - 2 cos(2 pi / n)) x for the vector x
	// from the axis of a tube with n vertices across. The least of w_L^2 |L v|^2 + w_H^2 |v - v_0|^2 follows.
	const Tube tube;
	const double step = 2 * M_PI / Tube::across;
	const double a = 2 * std::sin(step / 2), b = 2 * M_PI * Tube::major / Tube::around;
	const double eigenvalue = 2 * (b / a) * (2 - 2 * std::cos(step));
	for (const auto& [wL, wH] : {std::pair {1.0, 20.0}, {1.0, 60.0}, {0.5, 20.0}}) {
		const double expected = 1 / (1 + std::pow(wL * eigenvalue / (wH / 200), 2));
		const double found =
			Tube::radius(afterOneStep(checks::plainStage(tube.soup.mesh()), wL, wH));
		EXPECT_NEAR(found, expected, 0.03 * expected) << "w_L " << wL << ", w_H " << wH;
	}
}

TEST(Theory, OneStepShrinksTheDirectionOfLargerCurvatureMore)
{
	// Eq. 3: what moves along the normal by s loses the parts s k_1 and s k_2 of its lengths.
	const Tube tube;
	const std::vector<Point3d>& before = tube.soup.points;
	const std::vector<Point3d> after = afterOneStep(checks::plainStage(tube.soup.mesh()), 1, 200);
	const auto shrinks = [&](int i, int j) {
		return 1 - vcg::Distance(after[i], after[j]) / vcg::Distance(before[i], before[j]);
	};
	double across = 0, along = 0;
	for (int i = 0; i < Tube::around; ++i) {
		across += (shrinks(Tube::at(i, 0), Tube::at(i, 1))
					  + shrinks(Tube::at(i, 0), Tube::at(i, Tube::across - 1)))
			/ 2;
		along += shrinks(Tube::at(i, 0), Tube::at(i + 1, 0));
	}
	EXPECT_GT(along, 0);
	const double k1 = 1, k2 = 1 / (Tube::major + 1); // on the outer equator
	EXPECT_NEAR(across / along, k1 / k2, 0.1 * k1 / k2);
}

TEST(Theory, OneStepMakesAnEllipsoidSlenderer)
{
	// In the middle of a spheroid of axes 3, 1, 1 the curvatures are 1 around it and 1 / 9 along it.
	std::vector<std::pair<double, double>> profile = {{-3, 0}};
	constexpr double spacing = 0.085;
	for (double angle = 0; angle < M_PI;
		 angle += spacing / std::hypot(3 * std::sin(angle), std::cos(angle)))
		if (angle > 0)
			profile.emplace_back(-3 * std::cos(angle), std::sin(angle));
	profile.emplace_back(3, 0);
	const shapes::Soup soup = shapes::revolved(profile, 24);
	const std::vector<Point3d> after = afterOneStep(checks::plainStage(soup.mesh()), 1, 200);
	double width = 0, count = 0, height = 0, square = 0; // height: along the axis
	for (size_t v = 0; v < after.size(); ++v) {
		const Point3d& p = soup.points[v];
		if (std::abs(p[0]) > 0.5)
			continue;
		width += std::hypot(after[v][1], after[v][2]) / std::hypot(p[1], p[2]);
		count += 1;
		height += after[v][0] * p[0];
		square += p[0] * p[0];
	}
	const double around = 1 - width / count, along = 1 - height / square;
	EXPECT_GT(around, 0);
	EXPECT_GT(around, 3 * std::abs(along));
}

TEST(Theory, BetweenHeldEndsATubeBecomesAStraightEvenlyParametrisedCurve)
{
	// Sec. 4.1: where only smoothness counts, L v = 0, as in Tutte's embedding. The tube is bowed at the start.
	constexpr int rings = 60, around = 8;
	constexpr double radius = 0.5, spacing = 0.35;
	std::vector<std::pair<double, double>> profile = {{-spacing, 0}};
	for (int i = 0; i < rings; ++i)
		profile.emplace_back(i * spacing, radius);
	profile.emplace_back(rings * spacing, 0);
	shapes::Soup soup = shapes::revolved(profile, around);
	const double length = (rings - 1) * spacing;
	for (Point3d& p : soup.points)
		p[1] += std::sin(M_PI * p[0] / length);
	Stage stage = checks::plainStage(soup.mesh());
	for (int v = 0; v < int(stage.fixed.size()); ++v) {
		const bool inTheMiddle = v >= around && v < (rings - 1) * around;
		stage.fixed[v] = !inTheMiddle; // the first and the last ring, and their centres
	}
	const std::vector<Point3d> after = afterOneStep(stage, 100, 0.05);
	std::vector<Point3d> centre(rings, Point3d(0, 0, 0));
	for (int i = 0; i < rings; ++i)
		for (int j = 0; j < around; ++j)
			centre[i] += after[i * around + j] / around;
	constexpr int first = 10, last = rings - 13; // farther from the ends than they can hold it open
	const Point3d axis = (centre[last] - centre[first]).Normalize();
	const auto off = [&](const Point3d& p) { return ((p - centre[first]) ^ axis).Norm(); };
	for (int i = first; i <= last; ++i) {
		for (int j = 0; j < around; ++j)
			EXPECT_LT(off(after[i * around + j]), 0.02 * radius)
				<< "ring " << i; // it was 1 away, and open
		// Two rings on, since every other one is turned by half a step.
		EXPECT_NEAR(vcg::Distance(centre[i], centre[i + 2]), 2 * spacing, 0.1 * spacing)
			<< "ring " << i;
	}
}
