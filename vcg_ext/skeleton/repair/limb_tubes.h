// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Tubes between the ends of limbs, and holes in their walls where a third limb joins.

#ifndef VCG_MCF_LIMB_TUBES_H
#define VCG_MCF_LIMB_TUBES_H

#include "limb_ends.h"

#include <skeleton/mesh/surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// A tube between two ends. Mesh units.
struct LimbTube
{
	std::vector<Triangle> faces;
	/// The centres of its rings; for a band between ends that are near each other its middle.
	std::vector<Point3d> path;
	double radius = 0;
};

/// The band of triangles between two ends whose corners run in opposite directions. Each step takes
/// the shorter of the two possible new edges.
inline std::vector<Triangle> bandBetween(
	const std::vector<Point3d>& points, const LimbEnd& a, const LimbEnd& b)
{
	const int n = int(a.corner.size()), m = int(b.corner.size());
	const auto ofA = [&](int i) { return a.corner[size_t(i % n)]; };
	const auto ofB = [&](int j) { return b.corner[size_t(((j % m) + m) % m)]; };
	const Point3d apart = b.centre - a.centre;
	const auto distance = [&](int i, int j) {
		return (points[size_t(ofB(j))] - points[size_t(ofA(i))]).Norm();
	};
	int start = 0;
	for (int j = 1; j < m; ++j)
		if ((points[size_t(ofB(j))] - points[size_t(ofA(0))] - apart).Norm()
			< (points[size_t(ofB(start))] - points[size_t(ofA(0))] - apart).Norm())
			start = j;
	std::vector<Triangle> band;
	for (int i = 0, j = 0; i < n || j < m;) {
		// Neither side may be a quarter of a round ahead: bands of ragged borders would twist.
		const double ahead = double(i) / n - double(j) / m;
		const bool stepOnA = j == m || ahead < -0.25
			|| (i < n && ahead <= 0.25 && distance(i + 1, start - j) <= distance(i, start - j - 1));
		if (stepOnA) {
			band.push_back({ofA(i), ofA(i + 1), ofB(start - j)});
			++i;
		}
		else {
			band.push_back({ofB(start - j - 1), ofB(start - j), ofA(i)});
			++j;
		}
	}
	return band;
}

/**
 * A tube from one end to the other along a cubic curve that leaves in the heading of `a` and
 * arrives against that of `b`; a band where they are near each other.
 * @param points  get the new ones at their end.
 */
inline LimbTube tubeBetween(std::vector<Point3d>& points, const LimbEnd& a, const LimbEnd& b)
{
	constexpr int sides = 12;
	// A point ahead of the whole border, which may be ragged.
	const auto beyond = [&](const LimbEnd& end) {
		double farthest = 0;
		for (int v : end.corner)
			farthest = std::max(farthest, (points[size_t(v)] - end.centre) * end.heading);
		return end.centre + end.heading * (farthest + end.radius / 2);
	};
	const Point3d from = beyond(a), to = beyond(b);
	const double gap = (to - from).Norm(), radius = (a.radius + b.radius) / 2;
	if (gap < radius || (to - from) * (b.centre - a.centre) <= 0)
		return {
			bandBetween(points, a, b), {(a.centre + b.centre) / 2.0}, std::min(a.radius, b.radius)};
	const int rings = int(std::ceil(gap / radius)) + 1;
	// A hole in the side of a body may be wider than the limb there.
	const double narrower = std::min(a.radius, b.radius);
	Point3d side, other;
	Point3d along = a.heading;
	vcg::GetUV(along, side, other);
	LimbTube tube;
	tube.radius = narrower;
	LimbEnd last = a;
	for (int k = 0; k < rings; ++k) {
		const double t = double(k) / (rings - 1), s = 1 - t;
		// Hermite's cubic with tangents as long as the gap, and its derivative.
		LimbEnd ring;
		ring.centre = from * (s * s * (1 + 2 * t)) + to * (t * t * (1 + 2 * s))
			+ a.heading * (gap * t * s * s) + b.heading * (gap * s * t * t);
		ring.heading = (to - from) * (6 * t * s) + a.heading * (gap * s * (1 - 3 * t))
			+ b.heading * (gap * t * (3 * s - 1));
		if (ring.heading.Norm() > 0)
			ring.heading /= ring.heading.Norm();
		ring.radius = narrower;
		side -= ring.heading * (side * ring.heading);
		side.Normalize();
		other = ring.heading ^ side;
		for (int i = 0; i < sides; ++i) {
			const double angle = 2 * M_PI * i / sides;
			ring.corner.push_back(int(points.size()));
			points.push_back(
				ring.centre + (side * std::cos(angle) + other * std::sin(angle)) * ring.radius);
		}
		LimbEnd arriving = ring;
		std::reverse(arriving.corner.begin(), arriving.corner.end());
		const std::vector<Triangle> band = bandBetween(points, last, arriving);
		tube.faces.insert(tube.faces.end(), band.begin(), band.end());
		tube.path.push_back(ring.centre);
		last = std::move(ring);
	}
	const std::vector<Triangle> band = bandBetween(points, last, b);
	tube.faces.insert(tube.faces.end(), band.begin(), band.end());
	return tube;
}

/**
 * A hole in the wall of a tube, where a limb with the end `from` is to join it: about as wide as
 * the narrower of both.
 * @param ring   number of the ring at which the hole is.
 * @param faces  become those of the tube without the hole.
 * @return the hole as an end; without corners, and `faces` unchanged, if no wall faces that limb.
 */
inline LimbEnd holeInWall(const std::vector<Point3d>& points, const LimbTube& tube, size_t ring,
	const LimbEnd& from, std::vector<Triangle>& faces)
{
	constexpr double facing = 0.3; // min cosine between a wall's normal and the way to the limb
	Point3d towards = from.centre - tube.path[ring];
	const Point3d along =
		tube.path[std::min(ring + 1, tube.path.size() - 1)] - tube.path[ring > 0 ? ring - 1 : 0];
	if (const double squared = along.SquaredNorm(); squared > 0)
		towards -= along * ((towards * along) / squared);
	towards.Normalize();
	const Point3d middle = tube.path[ring] + towards * tube.radius;
	const auto centreOf = [&](const Triangle& t) {
		return (points[size_t(t[0])] + points[size_t(t[1])] + points[size_t(t[2])]) / 3.0;
	};
	// A disc of faces, grown from the face nearest to the limb.
	std::vector<std::pair<double, size_t>> byDistance;
	for (size_t f = 0; f < tube.faces.size(); ++f) {
		const Triangle& t = tube.faces[f];
		const Point3d normal = areaVector(points, t);
		if (normal * towards > facing * normal.Norm())
			byDistance.emplace_back((centreOf(t) - middle).Norm(), f);
	}
	std::sort(byDistance.begin(), byDistance.end());
	const double reach = std::min(from.radius, tube.radius);
	std::vector<char> cut(tube.faces.size(), 0);
	std::map<int, int> following; // the next vertex along the disc's border, as in its faces
	const auto isSide = [&](int v, int w) {
		const auto side = following.find(v);
		return side != following.end() && side->second == w;
	};
	for (bool grows = true; grows;) {
		grows = false;
		for (const auto& [distance, f] : byDistance) {
			if (cut[f] || (distance > reach && !following.empty()))
				continue;
			const Triangle& t = tube.faces[f];
			std::array<bool, 3> shared {};
			for (size_t k = 0; k < 3; ++k)
				shared[k] = isSide(t[(k + 1) % 3], t[k]);
			const auto count = std::count(shared.begin(), shared.end(), true);
			const size_t first =
				size_t(std::find(shared.begin(), shared.end(), true) - shared.begin());
			const bool isDisc = following.empty() || count == 2
				|| (count == 1 && !following.count(t[(first + 2) % 3]));
			if (!isDisc)
				continue;
			for (size_t k = 0; k < 3; ++k)
				if (shared[k])
					following.erase(t[(k + 1) % 3]);
			for (size_t k = 0; k < 3; ++k)
				if (!shared[k])
					following[t[k]] = t[(k + 1) % 3];
			cut[f] = 1;
			grows = true;
		}
	}
	LimbEnd hole;
	if (following.empty())
		return hole;
	const size_t count = following.size();
	for (int v = following.begin()->first; hole.corner.size() < count; v = following[v]) {
		hole.corner.push_back(v);
		hole.centre += points[size_t(v)] / double(count);
	}
	hole.radius = std::sqrt(areaVector(points, hole.corner, hole.centre).Norm() / M_PI);
	hole.heading = hole.out = towards;
	faces.clear();
	for (size_t f = 0; f < cut.size(); ++f)
		if (!cut[f])
			faces.push_back(tube.faces[f]);
	return hole;
}

} // namespace vcg::tri::mcf::detail

#endif
