// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Closed bodies that a flow does not like: coarse, spiky, flat, twisted, crossing themselves.

#ifndef MCFSKEL_TESTS_HOSTILE_BODIES_H
#define MCFSKEL_TESTS_HOSTILE_BODIES_H

#include "shapes.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace shapes {

/// Numbers that are the same with every standard library.
class Dice
{
public:
	explicit Dice(unsigned seed) : engine(seed) {}

	double between(double low, double high)
	{
		return low + (high - low) * (double(engine()) / 4294967296.0);
	}
	int whole(int low, int high) { return low + int(engine() % unsigned(high - low + 1)); }
	/// Spread evenly over the orders of magnitude from 10^low to 1.
	double magnitude(double low) { return std::pow(10, between(low, 0)); }
	std::mt19937& random() { return engine; }

private:
	std::mt19937 engine;
};

/// The convex hull of points in general position. Complexity: O(n^4).
inline Soup convexHull(const std::vector<Point3d>& points)
{
	const int n = int(points.size());
	Soup soup;
	std::vector<int> number(points.size(), -1);
	const auto add = [&](int v) {
		if (number[v] < 0) {
			number[v] = int(soup.points.size());
			soup.points.push_back(points[v]);
		}
		return number[v];
	};
	for (int i = 0; i < n; ++i)
		for (int j = i + 1; j < n; ++j)
			for (int k = j + 1; k < n; ++k) {
				const Point3d normal = (points[j] - points[i]) ^ (points[k] - points[i]);
				int above = 0, below = 0;
				for (int l = 0; l < n; ++l)
					if (l != i && l != j && l != k)
						++((points[l] - points[i]) * normal > 0 ? above : below);
				if (above == 0)
					soup.triangles.push_back({add(i), add(j), add(k)});
				else if (below == 0)
					soup.triangles.push_back({add(i), add(k), add(j)});
			}
	return soup;
}

/// A tube of `rings` polygons of `sides` corners, each turned against the one before.
inline Soup twistedPrism(Dice& dice, int sides, int rings)
{
	const double height = 10 * dice.magnitude(-2), twist = dice.between(-1.5, 1.5);
	const double noise = dice.between(0, 0.1);
	Soup soup;
	for (int k = 0; k < rings; ++k) {
		const double radius = dice.magnitude(-0.7);
		for (int i = 0; i < sides; ++i) {
			const double angle = 2 * M_PI * i / sides + twist * k;
			Point3d p(radius * std::cos(angle), radius * std::sin(angle), height * k / (rings - 1));
			for (int axis = 0; axis < 3; ++axis)
				p[axis] += noise * dice.between(-1, 1);
			soup.points.push_back(p);
		}
	}
	const auto at = [&](int k, int i) { return k * sides + i % sides; };
	for (int k = 0; k + 1 < rings; ++k)
		for (int i = 0; i < sides; ++i) {
			soup.triangles.push_back({at(k, i), at(k, i + 1), at(k + 1, i)});
			soup.triangles.push_back({at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)});
		}
	for (int i = 1; i + 1 < sides; ++i) {
		soup.triangles.push_back({at(0, 0), at(0, i + 1), at(0, i)});
		soup.triangles.push_back({at(rings - 1, 0), at(rings - 1, i), at(rings - 1, i + 1)});
	}
	return soup;
}

inline const std::vector<std::string>& hostileFamilies()
{
	static const std::vector<std::string> names = {"hull", "flat hull", "star", "spikes",
		"thin box", "coarse torus", "noise", "prism", "tunnels", "plate"};
	return names;
}

/// A body of a family, another one for each seed.
inline Soup hostileBody(const std::string& family, unsigned seed)
{
	Dice dice(seed);
	const auto stretched = [&](const Soup& soup, double orders) {
		const double x = dice.magnitude(-orders), y = dice.magnitude(-orders);
		return transformed(
			soup, [&](const Point3d& p) { return Point3d(x * p[0], y * p[1], p[2]); });
	};
	const auto shaken = [&](Soup soup, double amount) {
		for (Point3d& p : soup.points)
			for (int axis = 0; axis < 3; ++axis)
				p[axis] += amount * dice.between(-1, 1);
		return soup;
	};
	if (family == "hull" || family == "flat hull") {
		std::vector<Point3d> points;
		for (int i = dice.whole(6, 30); i > 0; --i) {
			Point3d p;
			for (int axis = 0; axis < 3; ++axis)
				p[axis] = dice.between(-1, 1);
			points.push_back(p);
		}
		return stretched(convexHull(points), family == "hull" ? 0 : 3);
	}
	if (family == "star") {
		Soup soup = sphere(dice.whole(1, 2));
		for (Point3d& p : soup.points)
			p *= dice.magnitude(-1);
		return soup;
	}
	if (family == "spikes") {
		Soup soup = sphere(dice.whole(1, 2));
		for (Point3d& p : soup.points)
			p *= dice.whole(0, 5) == 0 ? dice.between(1, 8) : dice.between(0.9, 1);
		return soup;
	}
	if (family == "thin box")
		return box(dice.magnitude(-5), dice.magnitude(-3), 1);
	if (family == "coarse torus") {
		const int around = dice.whole(3, 12), across = dice.whole(3, 8);
		const Soup soup = stretched(torus(1, dice.between(0.02, 0.8), around, across), 1);
		return shaken(soup, dice.between(0, 0.1));
	}
	if (family == "noise")
		return shaken(dice.whole(0, 1) ? sphere(2) : torus(1, 0.4, 12, 8), dice.between(0.1, 0.5));
	if (family == "prism") {
		const int sides = dice.whole(3, 10), rings = dice.whole(2, 8);
		return twistedPrism(dice, sides, rings);
	}
	if (family == "tunnels") {
		Soup soup = sphere(1);
		for (Point3d& p : soup.points)
			p *= dice.between(0.6, 1);
		return withTunnels(soup, dice.whole(1, 5), dice.random());
	}
	return stretched(shaken(plate(dice.whole(1, 3), 1), dice.between(0, 0.3)), 2);
}

} // namespace shapes

#endif
