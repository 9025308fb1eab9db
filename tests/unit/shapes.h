// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Surfaces made in code for the tests, each with a known topology and, where it has one, axis.

#ifndef MCFSKEL_TESTS_SHAPES_H
#define MCFSKEL_TESTS_SHAPES_H

#include <skeleton/mesh/surface_mesh.h>

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace shapes {

using vcg::Point3d;
using vcg::tri::mcf::SurfaceMesh;
using vcg::tri::mcf::Triangle;

/// Points and triangles, as a host hands them over: not necessarily closed or manifold.
struct Soup
{
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;

	SurfaceMesh mesh() const { return SurfaceMesh(points, triangles); }
};

// The smallest closed meshes.

inline Soup tetrahedron()
{
	return {
		{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

inline Soup octahedron()
{
	return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
		{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// A box of eight vertices with a corner at the origin.
inline Soup box(double x = 1, double y = 1, double z = 1)
{
	Soup s;
	for (int i = 0; i < 8; ++i)
		s.points.emplace_back(i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0);
	s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7},
		{2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
	return s;
}

/// The torus of seven vertices (Moebius, Csaszar): every two of them are joined by an edge.
inline Soup csaszarTorus()
{
	Soup s;
	s.points = {{3, -3, 0}, {-3, 3, 0}, {-3, -3, 1}, {3, 3, 1}, {-1, -2, 3}, {1, 2, 3}, {0, 0, 15}};
	for (int i = 0; i < 7; ++i) {
		s.triangles.push_back({i, (i + 1) % 7, (i + 3) % 7});
		s.triangles.push_back({i, (i + 3) % 7, (i + 2) % 7});
	}
	return s;
}

// Smooth shapes.

/// Each triangle in four; `placed` moves the new points.
inline Soup subdivided(
	const Soup& coarse,
	const std::function<Point3d(const Point3d&)>& placed = [](const Point3d& p) { return p; })
{
	Soup s;
	s.points = coarse.points;
	std::map<std::pair<int, int>, int> middle;
	const auto between = [&](int a, int b) {
		const auto [entry, isNew] = middle.try_emplace(std::minmax(a, b), int(s.points.size()));
		if (isNew)
			s.points.push_back(placed((coarse.points[a] + coarse.points[b]) / 2.0));
		return entry->second;
	};
	for (const auto& [a, b, c] : coarse.triangles) {
		const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
		s.triangles.insert(
			s.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
	}
	return s;
}

/// A regular prism on the xy plane, with corners at a distance of 1 from the z axis.
inline Soup prism(int sides, double height, double turned = 0)
{
	Soup s;
	for (double z : {0.0, height}) {
		for (int i = 0; i < sides; ++i) {
			const double angle = 2 * M_PI * i / sides + turned;
			s.points.emplace_back(std::cos(angle), std::sin(angle), z);
		}
		s.points.emplace_back(0, 0, z);
	}
	const int upper = sides + 1;
	for (int i = 0; i < sides; ++i) {
		const int next = (i + 1) % sides;
		s.triangles.push_back({sides, next, i});
		s.triangles.push_back({upper + sides, upper + i, upper + next});
		s.triangles.push_back({i, next, upper + next});
		s.triangles.push_back({i, upper + next, upper + i});
	}
	return s;
}

/// Each triangle in four, so many times, in place.
inline Soup refined(Soup s, int times)
{
	for (int i = 0; i < times; ++i)
		s = subdivided(s);
	return s;
}

/// A subdivided octahedron on a sphere about the origin: 4^(levels + 1) + 2 vertices.
inline Soup sphere(int levels = 3, double radius = 1)
{
	Soup s = octahedron();
	for (Point3d& p : s.points)
		p *= radius;
	for (int i = 0; i < levels; ++i)
		s = subdivided(s, [&](const Point3d& p) { return Point3d(p * (radius / p.Norm())); });
	return s;
}

/// A torus about the z axis; its medial axis is the circle of radius `major`.
inline Soup torus(double major = 1, double minor = 0.3, int around = 60, int across = 20)
{
	Soup s;
	for (int i = 0; i < around; ++i)
		for (int j = 0; j < across; ++j) {
			const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
			const double r = major + minor * std::cos(v);
			s.points.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
		}
	const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
	for (int i = 0; i < around; ++i)
		for (int j = 0; j < across; ++j) {
			s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
			s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
		}
	return s;
}

/// A profile of (x, radius) turned about the x axis; the first and the last point are on it.
inline Soup revolved(const std::vector<std::pair<double, double>>& profile, int around)
{
	Soup s;
	const int rings = int(profile.size()) - 2;
	for (int i = 1; i <= rings; ++i)
		for (int j = 0; j < around; ++j) {
			// Every other ring is turned by half a step, so that triangles are even.
			const double v = 2 * M_PI * (j + 0.5 * (i % 2)) / around;
			s.points.emplace_back(
				profile[i].first, profile[i].second * std::cos(v), profile[i].second * std::sin(v));
		}
	const int first = int(s.points.size()), last = first + 1;
	s.points.emplace_back(profile.front().first, 0, 0);
	s.points.emplace_back(profile.back().first, 0, 0);
	const auto at = [&](int i, int j) { return i * around + (j + around) % around; };
	for (int j = 0; j < around; ++j) {
		s.triangles.push_back({first, at(0, j + 1), at(0, j)});
		s.triangles.push_back({last, at(rings - 1, j), at(rings - 1, j + 1)});
	}
	for (int i = 0; i + 1 < rings; ++i)
		for (int j = 0; j < around; ++j) {
			const bool ahead = i % 2 == 1; // whether ring i + 1 is half a step ahead of ring i
			const int a = at(i, j), b = at(i, j + 1);
			const int c = at(i + 1, ahead ? j : j - 1), d = at(i + 1, ahead ? j + 1 : j);
			if (ahead) {
				s.triangles.push_back({a, b, c});
				s.triangles.push_back({b, d, c});
			}
			else {
				s.triangles.push_back({a, d, c});
				s.triangles.push_back({a, b, d});
			}
		}
	return s;
}

/// A tube about the x axis from -length / 2 to length / 2 with half balls at its ends.
inline Soup capsule(double length = 2, double radius = 0.35, int around = 24)
{
	std::vector<std::pair<double, double>> profile;
	const double edge = 2 * M_PI * radius / around;
	const int caps = around / 4, body = std::max(1, int(length / (edge * 0.87)));
	for (int i = 0; i < caps; ++i) {
		const double t = M_PI / 2 * i / caps;
		profile.emplace_back(-length / 2 - radius * std::cos(t), radius * std::sin(t));
	}
	for (int i = 0; i <= body; ++i)
		profile.emplace_back(-length / 2 + length * i / body, radius);
	for (int i = caps - 1; i >= 0; --i) {
		const double t = M_PI / 2 * i / caps;
		profile.emplace_back(length / 2 + radius * std::cos(t), radius * std::sin(t));
	}
	return revolved(profile, around);
}

// Shapes of any genus.

/**
 * The surface of the union of unit cells (i, j, k) of a grid for which `filled` holds, times `size`.
 * @pre no two filled cells touch along an edge or at a corner only.
 */
inline Soup cells(
	int nx, int ny, int nz, const std::function<bool(int, int, int)>& filled, double size = 1)
{
	const std::array<int, 3> n = {nx, ny, nz};
	const auto isFilled = [&](const std::array<int, 3>& c) {
		for (int k = 0; k < 3; ++k)
			if (c[k] < 0 || c[k] >= n[k])
				return false;
		return filled(c[0], c[1], c[2]);
	};
	Soup s;
	std::map<std::array<int, 3>, int> ids;
	const auto corner = [&](const std::array<int, 3>& c) {
		const auto [entry, isNew] = ids.try_emplace(c, int(s.points.size()));
		if (isNew)
			s.points.emplace_back(c[0] * size, c[1] * size, c[2] * size);
		return entry->second;
	};
	for (int i = 0; i < nx; ++i)
		for (int j = 0; j < ny; ++j)
			for (int k = 0; k < nz; ++k) {
				const std::array<int, 3> cell = {i, j, k};
				if (!isFilled(cell))
					continue;
				for (int axis = 0; axis < 3; ++axis)
					for (int side = 0; side < 2; ++side) {
						std::array<int, 3> neighbour = cell;
						neighbour[axis] += side ? 1 : -1;
						if (isFilled(neighbour))
							continue;
						const int u = (axis + 1) % 3, v = (axis + 2) % 3;
						std::array<int, 3> p = cell;
						p[axis] += side;
						std::array<int, 4> quad;
						for (int q = 0; q < 4; ++q) {
							std::array<int, 3> at = p;
							at[u] += q == 1 || q == 2;
							at[v] += q >= 2;
							quad[q] = corner(at);
						}
						if (!side)
							std::swap(quad[1], quad[3]);
						s.triangles.push_back({quad[0], quad[1], quad[2]});
						s.triangles.push_back({quad[0], quad[2], quad[3]});
					}
			}
	return s;
}

/// A plate with `holes` square holes in a row, each coarse cell cut in fine^3: genus = holes.
inline Soup plate(int holes, int fine = 2)
{
	return cells((2 * holes + 1) * fine, 3 * fine, fine,
		[fine](int i, int j, int) { return (i / fine) % 2 == 0 || j / fine != 1; }, 1.0 / fine);
}

/// A tunnel of six triangles from triangle f to triangle g: the genus of their body grows by one.
inline void addTunnel(Soup& s, int f, int g)
{
	const Triangle a = s.triangles[f], b = s.triangles[g];
	const Triangle p = {b[0], b[2], b[1]};
	for (int k = 0; k < 3; ++k) {
		const int l = (k + 1) % 3;
		s.triangles.push_back({a[k], a[l], p[l]});
		s.triangles.push_back({a[k], p[l], p[k]});
	}
	s.triangles.erase(s.triangles.begin() + std::max(f, g));
	s.triangles.erase(s.triangles.begin() + std::min(f, g));
}

/// Adds tunnels between random triangles that are no neighbours, i.e. holes of three edges.
inline Soup withTunnels(Soup s, int count, std::mt19937& random)
{
	for (int made = 0; made < count;) {
		const int f = int(random() % s.triangles.size()), g = int(random() % s.triangles.size());
		std::set<int> near(s.triangles[f].begin(), s.triangles[f].end());
		for (const Triangle& t : s.triangles)
			for (int k = 0; k < 3; ++k)
				for (int corner : s.triangles[f])
					if (t[k] == corner)
						near.insert(t.begin(), t.end());
		bool apart = true;
		for (int corner : s.triangles[g])
			apart &= !near.count(corner);
		if (!apart)
			continue;
		addTunnel(s, f, g);
		++made;
	}
	return s;
}

/// Applies random splits, flips and collapses that keep the topology, `count` in all.
inline void changeAtRandom(SurfaceMesh& mesh, int count, std::mt19937& random)
{
	for (int i = 0; i < count; ++i) {
		const int h = int(random() % size_t(mesh.halfEdgeSlots()));
		if (!mesh.isHalfEdge(h))
			continue;
		switch (random() % 3) {
		case 0:
			mesh.split(h, (mesh.position[mesh.origin(h)] + mesh.position[mesh.target(h)]) / 2.0);
			break;
		case 1:
			if (mesh.isFlippable(h))
				mesh.flip(h);
			break;
		default:
			if (mesh.isCollapsible(h))
				mesh.collapse(h);
		}
	}
}

// Changes of a whole shape.

inline Soup transformed(Soup s, const std::function<Point3d(const Point3d&)>& map)
{
	for (Point3d& p : s.points)
		p = map(p);
	return s;
}

inline Soup scaled(const Soup& s, double factor)
{
	return transformed(s, [&](const Point3d& p) { return Point3d(p * factor); });
}

inline Soup moved(const Soup& s, const Point3d& by)
{
	return transformed(s, [&](const Point3d& p) { return Point3d(p + by); });
}

/// Each coordinate moved by up to `amount`, from a fixed seed.
inline Soup jittered(const Soup& s, double amount, unsigned seed = 1)
{
	std::mt19937 random(seed);
	const auto offset = [&] { return amount * (2.0 * random() / double(std::mt19937::max()) - 1); };
	return transformed(s, [&](const Point3d& p) {
		const double x = offset(), y = offset(), z = offset();
		return Point3d(p[0] + x, p[1] + y, p[2] + z);
	});
}

inline Soup insideOut(Soup s)
{
	for (Triangle& t : s.triangles)
		std::swap(t[1], t[2]);
	return s;
}

/// Several shapes as one, their vertices one after the other.
inline Soup joined(std::initializer_list<Soup> parts)
{
	Soup s;
	for (const Soup& part : parts) {
		const int shift = int(s.points.size());
		s.points.insert(s.points.end(), part.points.begin(), part.points.end());
		for (const auto& [a, b, c] : part.triangles)
			s.triangles.push_back({a + shift, b + shift, c + shift});
	}
	return s;
}

/// Every triangle with three vertices of its own, as in an STL file.
inline Soup unmerged(const Soup& s)
{
	Soup apart;
	for (const Triangle& t : s.triangles) {
		const int first = int(apart.points.size());
		for (int v : t)
			apart.points.push_back(s.points[v]);
		apart.triangles.push_back({first, first + 1, first + 2});
	}
	return apart;
}

/// The same shape with its vertices and triangles in random order.
inline Soup shuffled(const Soup& s, unsigned seed = 1)
{
	std::mt19937 random(seed);
	std::vector<int> number(s.points.size());
	for (size_t i = 0; i < number.size(); ++i)
		number[i] = int(i);
	for (size_t i = number.size(); i > 1; --i)
		std::swap(number[i - 1], number[random() % i]);
	Soup t = s;
	for (size_t i = 0; i < number.size(); ++i)
		t.points[number[i]] = s.points[i];
	for (Triangle& triangle : t.triangles)
		for (int& v : triangle)
			v = number[v];
	for (size_t i = t.triangles.size(); i > 1; --i)
		std::swap(t.triangles[i - 1], t.triangles[random() % i]);
	return t;
}

// Surfaces that bound no solid.

/// A band of `count` quads with half a twist.
inline Soup moebiusStrip(int count = 24)
{
	Soup s;
	for (int i = 0; i < count; ++i)
		for (int side = -1; side <= 1; side += 2) {
			const double u = 2 * M_PI * i / count, w = 0.3 * side;
			const double r = 1 + w * std::cos(u / 2);
			s.points.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
		}
	for (int i = 0; i < count; ++i) {
		const int a = 2 * i, b = a + 1;
		int c = (a + 2) % (2 * count), d = c + 1;
		if (i == count - 1)
			std::swap(c, d); // the twist: the upper rim goes on as the lower one
		s.triangles.push_back({a, b, c});
		s.triangles.push_back({b, d, c});
	}
	return s;
}

/// A closed one-sided surface: a tube whose end meets its start from the other side.
inline Soup kleinBottle(int around = 24, int across = 12)
{
	Soup s = torus(2, 0.5, around, across);
	const auto at = [&](int i, int j) {
		return i < around ? i * across + j % across : (2 * across - j) % across;
	};
	s.triangles.clear();
	for (int i = 0; i < around; ++i)
		for (int j = 0; j < across; ++j) {
			s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
			s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
		}
	return s;
}

inline Soup tetrahedraSharingVertex()
{
	Soup s = tetrahedron();
	s.points.insert(s.points.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
	s.triangles.insert(s.triangles.end(), {{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
	return s;
}

inline Soup tetrahedraSharingEdge()
{
	Soup s = tetrahedron();
	s.points.insert(s.points.end(), {{0, -1, 0}, {0, 0, -1}});
	s.triangles.insert(s.triangles.end(), {{0, 4, 1}, {0, 1, 5}, {1, 4, 5}, {4, 0, 5}});
	return s;
}

/// The shape without its first triangle.
inline Soup opened(Soup s)
{
	s.triangles.erase(s.triangles.begin());
	return s;
}

} // namespace shapes

#endif
