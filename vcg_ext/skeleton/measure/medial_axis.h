// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The medial axis as a surface (Fig. 1b and 7): the poles, joined as their vertices are.

#ifndef VCG_MCF_MEDIAL_AXIS_H
#define VCG_MCF_MEDIAL_AXIS_H

#include <skeleton/poles/by_component.h>
#include <skeleton/core/errors.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/parallel.h>
#include <skeleton/spatial/point_tree.h>
#include <skeleton/poles/pole_set.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/unit_frame.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// Which poles and triangles of poles count.
struct MedialAxisParameters
{
	/// Minimum angle between two places where a pole's ball touches the surface, seen from the
	/// pole; degrees, in [0, 180]. Poles that come from noise and facets have narrow angles.
	double minAngle = 60;
	/// Minimum radius of a pole's ball, mesh units, >= 0.
	double minRadius = 0;
	/// A triangle of poles counts if its longest edge is at most this many times the longest edge
	/// of the triangle of their vertices; > 0. Longer ones join sheets that do not belong together.
	double maxStretch = 4;

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		requireParameter(
			minAngle >= 0 && minAngle <= 180, "min_angle", "between 0 and 180 degrees");
		requireParameter(minRadius >= 0 && std::isfinite(minRadius), "min_radius", "at least 0");
		requireParameter(maxStretch > 0, "max_stretch", "greater than 0");
	}
};

/// Poles, and triangles that join them.
struct MedialAxis
{
	/// Mesh units.
	std::vector<Point3d> position;
	std::vector<double> radius;
	/// Degrees, see MedialAxisParameters::minAngle.
	std::vector<double> angle;
	/// The vertex of the surface that each is the pole of.
	std::vector<int> source;
	std::vector<Triangle> triangles;
};

namespace detail {

/**
 * The widest angle between a point and the others in a ball, seen from its middle, as the search of
 * a tree. Only points with wider angles than those found are of interest: they are in a cone from
 * the middle to the far side. Once that is narrow, it is searched by the ball through its apex and
 * its rim, which holds few points of a sphere.
 */
class WidestAngle
{
public:
	/// @param spoke from the middle to the point.
	WidestAngle(const Point3d& middle, double radius, const Point3d& spoke) :
			middle(middle), radius(radius), spoke(spoke), searched(middle), searchedRadius(radius)
	{
		const double length = spoke.Norm();
		farSide = length > 0 ? spoke * (-radius / length) : Point3d(0, 0, 0);
	}

	/// Where the widest angles are: to visit the point nearest to it first narrows the search.
	Point3d farthest() const { return middle + farSide; }

	/// Radians.
	double widest() const { return angle; }

	const Point3d& centre() const { return searched; }
	double reach() const { return searchedRadius; }
	void visit(int, const Point3d& p)
	{
		constexpr double narrow = M_PI / 3; // half the cone's angle: its ball is smaller from there
		const Point3d other = p - middle;
		if (other.SquaredNorm() > radius * radius)
			return;
		const double found = std::atan2((spoke ^ other).Norm(), spoke * other);
		if (found <= angle)
			return;
		angle = found;
		if (M_PI - angle >= narrow)
			return;
		const double part = 1 / (2 * std::cos(M_PI - angle)); // of the way to the far side
		searched = middle + farSide * part;
		searchedRadius = radius * part;
	}

private:
	Point3d middle;
	double radius;
	Point3d spoke, farSide;
	double angle = 0;
	Point3d searched;
	double searchedRadius;
};

constexpr const char* measuringAngles = "Measuring the poles' angles";

/// poleAngles() of a surface of one component.
inline std::vector<double> poleAnglesOfComponent(
	const SurfaceMesh& surface, const PoleSet& poles, const Progress& progress)
{
	constexpr double touching = 0.01; // of the radius: facets of a round surface deviate that much
	constexpr int blocksPerReport = 8;
	const UnitFrame frame(surface.position);
	const PointTree tree(frame.in(surface.position));
	std::vector<double> angle(poles.radius.size(), -1);
	const auto measure = [&](int begin, int end) {
		for (int v = begin; v < end; ++v) {
			if (!poles.has(v))
				continue;
			const Point3d centre = frame.in(poles.centre[v]);
			WidestAngle search(centre, frame.lengthIn(poles.radius[v]) * (1 + touching),
				frame.in(surface.position[v]) - centre);
			const int first = tree.nearest(search.farthest());
			search.visit(first, frame.in(surface.position[first]));
			tree.search(search);
			angle[v] = search.widest() * 180 / M_PI;
		}
	};
	forEachBlock(int(angle.size()), progress, measuringAngles, measure, blocksPerReport);
	return angle;
}

} // namespace detail

/**
 * For each pole the widest angle, degrees, between its vertex and any other vertex that its ball
 * touches, seen from the pole; -1 where there is no pole. Other components do not count.
 * @pre surface is compact. @throws Cancelled. Complexity: O(V log V); O(V) for a ball that touches
 * all vertices, but none on its far side.
 */
inline std::vector<double> poleAngles(
	const SurfaceMesh& surface, const PoleSet& poles, const Progress& progress = Progress())
{
	return detail::foundByComponent(surface, poles, progress, detail::poleAnglesOfComponent);
}

/**
 * Joins the poles of a surface as its triangles join their vertices, and leaves out what does not
 * count. Where the medial axis is a sheet, it appears once from each of its two sides.
 *
 * @param surface  compact.
 * @param poles    of all vertices.
 * @param joined   false: all poles that count, without triangles; else those that a triangle uses.
 * @throws InvalidParameter, Cancelled. Complexity: as poleAngles().
 * Source: paper, Sec. 4.5 and Fig. 1b, 7; the filter by angle after Amenta, Choi and Kolluri, "The
 *         power crust", 2001.
 */
inline MedialAxis medialAxis(const SurfaceMesh& surface, const PoleSet& poles, bool joined,
	const MedialAxisParameters& parameters = MedialAxisParameters(),
	const Progress& progress = Progress())
{
	parameters.check();
	const std::vector<double> angle = poleAngles(surface, poles, progress);
	const auto counts = [&](int v) {
		return poles.has(v) && angle[v] >= parameters.minAngle
			&& poles.radius[v] >= parameters.minRadius;
	};
	const Progress cancel = progress.cancelOnly();
	std::vector<Triangle> kept;
	detail::cancellableLoop(joined ? surface.faceSlots() : 0, cancel, [&](int f) {
		const Triangle t = surface.triangle(f);
		if (!counts(t[0]) || !counts(t[1]) || !counts(t[2]))
			return;
		double longest = 0, stretched = 0;
		for (int k = 0; k < 3; ++k) {
			const int a = t[k], b = t[(k + 1) % 3];
			longest = std::max(longest, Distance(surface.position[a], surface.position[b]));
			stretched = std::max(stretched, Distance(poles.centre[a], poles.centre[b]));
		}
		if (stretched <= parameters.maxStretch * longest)
			kept.push_back(t);
	});
	std::vector<char> used(poles.radius.size(), !joined);
	detail::cancellableLoop(int(kept.size()), cancel, [&](int f) {
		for (int v : kept[size_t(f)])
			used[v] = 1;
	});

	MedialAxis medial;
	std::vector<int> number = detail::filledArray(used.size(), -1, cancel);
	detail::cancellableLoop(int(used.size()), cancel, [&](int v) {
		if (!used[v] || !counts(v))
			return;
		number[v] = int(medial.position.size());
		medial.position.push_back(poles.centre[v]);
		medial.radius.push_back(poles.radius[v]);
		medial.angle.push_back(angle[v]);
		medial.source.push_back(v);
	});
	detail::cancellableLoop(int(kept.size()), cancel, [&](int f) {
		const Triangle& t = kept[size_t(f)];
		medial.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
	});
	return medial;
}

} // namespace vcg::tri::mcf

#endif
