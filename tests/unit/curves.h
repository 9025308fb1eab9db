// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Skeletons made in code for the tests.

#ifndef MCFSKEL_TESTS_CURVES_H
#define MCFSKEL_TESTS_CURVES_H

#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace curves {

using vcg::Point3d;
using vcg::tri::mcf::CurveSkeleton;
using vcg::tri::mcf::SurfaceMesh;

inline int addNode(CurveSkeleton& s, const Point3d& at, double radius)
{
	s.position.push_back(at);
	s.radius.push_back(radius);
	return int(s.position.size()) - 1;
}

inline void addEdge(CurveSkeleton& s, int a, int b)
{
	s.edges.push_back({std::min(a, b), std::max(a, b)});
	std::sort(s.edges.begin(), s.edges.end());
}

/// A graph whose node i stands at (i, 0, 0), with radius 1.
inline CurveSkeleton graph(int nodes, std::vector<std::array<int, 2>> edges)
{
	CurveSkeleton s;
	for (int i = 0; i < nodes; ++i)
		addNode(s, Point3d(i, 0, 0), 1);
	std::sort(edges.begin(), edges.end());
	s.edges = std::move(edges);
	return s;
}

/// From node `from` straight on to `to` in `count` edges; returns the last node.
inline int addLine(CurveSkeleton& s, int from, const Point3d& to, double radius, int count)
{
	const Point3d start = s.position[from];
	for (int i = 1; i <= count; ++i) {
		const int next = addNode(s, start + (to - start) * (double(i) / count), radius);
		addEdge(s, i == 1 ? from : next - 1, next);
	}
	return int(s.position.size()) - 1;
}

/// A straight chain of `count` edges.
inline CurveSkeleton line(const Point3d& a, const Point3d& b, double radius, int count)
{
	CurveSkeleton s;
	addLine(s, addNode(s, a, radius), b, radius, count);
	return s;
}

/// A regular polygon about the z axis.
inline CurveSkeleton circle(double across, double radius, int count)
{
	CurveSkeleton s;
	for (int i = 0; i < count; ++i) {
		const double u = 2 * M_PI * i / count;
		addNode(s, Point3d(across * std::cos(u), across * std::sin(u), 0), radius);
	}
	for (int i = 0; i < count; ++i)
		addEdge(s, i, (i + 1) % count);
	return s;
}

/// Each node its own source, so that the correspondence tells where every node has gone.
inline CurveSkeleton tracked(CurveSkeleton s)
{
	s.node.clear();
	for (size_t v = 0; v < s.position.size(); ++v)
		s.node.push_back(int(v));
	return s;
}

/// The places of the tips.
inline std::vector<Point3d> tips(const CurveSkeleton& s)
{
	std::vector<Point3d> places;
	const std::vector<std::vector<int>> neighbours = s.neighbours();
	for (size_t v = 0; v < neighbours.size(); ++v)
		if (neighbours[v].size() == 1)
			places.push_back(s.position[v]);
	return places;
}

/// Chains of points; points of different chains that coincide are one node.
class CurveMaker
{
public:
	CurveMaker& chain(const std::vector<Point3d>& points)
	{
		int last = -1;
		for (const Point3d& p : points) {
			int v = 0;
			while (v < int(curve.position.size()) && Distance(curve.position[v], p) > 1e-9)
				++v;
			if (v == int(curve.position.size()))
				curve.position.push_back(p);
			if (last >= 0)
				curve.edges.push_back({std::min(last, v), std::max(last, v)});
			last = v;
		}
		return *this;
	}
	/// Straight from a to b in `pieces`.
	CurveMaker& line(const Point3d& a, const Point3d& b, int pieces = 20)
	{
		std::vector<Point3d> points;
		for (int i = 0; i <= pieces; ++i)
			points.push_back(a + (b - a) * (double(i) / pieces));
		return chain(points);
	}
	/// Every surface vertex has merged into the nearest node.
	CurveSkeleton in(const SurfaceMesh& surface)
	{
		std::sort(curve.edges.begin(), curve.edges.end());
		curve.radius.assign(curve.position.size(), 0);
		curve.node.clear();
		for (const Point3d& p : surface.position) {
			int nearest = 0;
			for (size_t v = 1; v < curve.position.size(); ++v)
				if (SquaredDistance(p, curve.position[v])
					< SquaredDistance(p, curve.position[nearest]))
					nearest = int(v);
			curve.node.push_back(nearest);
		}
		return curve;
	}

private:
	CurveSkeleton curve;
};

} // namespace curves

#endif
