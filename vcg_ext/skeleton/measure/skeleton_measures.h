// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How well a skeleton describes its surface: inside, centred, complete.

#ifndef VCG_MCF_SKELETON_MEASURES_H
#define VCG_MCF_SKELETON_MEASURES_H

#include "medial_reference.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/closest_curve.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/graph/skeleton_branches.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/mesh/surface_samples.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// How finely skeletonMeasures() samples.
struct MeasureSampling
{
	/// Longest piece of the skeleton, fraction of the surface's diagonal; as in Table 1.
	double spacing = 0.001;
	/// Points of the surface whose balls make up the medial axis; points of the surface, and inside
	/// it, at which the reconstruction is measured.
	int medialPoints = 80000, surfacePoints = 20000, innerPoints = 20000;
};

/// Measures of a skeleton against its surface. Lengths are fractions of the surface's bounding box
/// diagonal.
struct SkeletonMeasures
{
	/// Fraction of the skeleton's length that is inside; the maximum distance outside.
	double insideFraction = 0, outDepthMax = 0;
	/// Distance to the medial axis: mean over the length, 95th percentile, maximum.
	double medialMean = 0, medialP95 = 0, medialMax = 0;
	/// Mean of 1 - d / R, clamped to [0, 2], d the distance to the surface, negative outside, and R
	/// the radius of the nearest medial ball: 0 centred, 1 on the surface.
	double offCentreMean = 0;
	/// Distance from the surface to the skeleton, mean and maximum.
	double coverMean = 0, coverMax = 0;
	/// Distance from the surface to the union of the balls around the skeleton that touch the
	/// surface from inside: what the skeleton does not describe.
	double reconMean = 0, reconP95 = 0, reconMax = 0;
	/// Fraction of the volume that these balls fill.
	double volumeFraction = 0;
	/// Terminal branches that describe no feature: see prominence().
	int spurs = 0;
	/// Of each node, mesh units: distance to the surface, negative outside, and to the medial axis.
	std::vector<double> nodeClearance, nodeMedialDistance;
};

namespace detail {

/// Distance to the medial axis, and the radius of the ball there.
struct MedialPlace
{
	double distance, radius;
};

/**
 * The place of the medial axis that is nearest to a point: among the balls of the reference, and
 * the ball that touches the surface at the point's closest point, so that the density of the
 * reference does not matter for points between the medial axis and the surface. Of a shape that is
 * too thin for any ball of the reference, the latter alone or, outside, the surface itself.
 */
inline MedialPlace nearestMedial(const Point3d& x, const ClosestSurface::Hit& hit, bool inside,
	const MedialReference& reference, const PointTree& centres, const ClosestSurface& surface)
{
	constexpr double onSurface = 1e-7; // diagonals
	constexpr double tolerance = 1e-3; // distances from the surface
	const bool hasBall = inside && hit.distance > onSurface;
	const int nearest = centres.nearest(x);
	if (nearest < 0) {
		if (!hasBall)
			return {hit.distance, 0};
		const double radius = surface.maximalBall(x, hit, tolerance * hit.distance, -1).radius;
		return {std::abs(radius - hit.distance), radius};
	}
	MedialPlace place = {Distance(x, reference.centre[nearest]), reference.radius[nearest]};
	if (hasBall) {
		TouchingBall touching(hit.point, (hit.point - x) / hit.distance, 0.5);
		shrinkExactly(touching, surface, hit.face);
		const double radius = touching.ball.radius(), own = std::abs(radius - hit.distance);
		if (touching.spokeAngle() >= minSpokeAngle && own < place.distance)
			place = {own, radius};
	}
	return place;
}

/// Distance from q to the union of balls, negative inside.
inline double distanceToBalls(
	const Point3d& q, const std::vector<Point3d>& centre, const std::vector<double>& radius)
{
	double best = std::numeric_limits<double>::max();
	for (size_t i = 0; i < centre.size(); ++i) {
		const double limit = best + radius[i];
		const double squared = SquaredDistance(q, centre[i]);
		if (limit > 0 && squared < limit * limit)
			best = std::sqrt(squared) - radius[i];
	}
	return best;
}

/// The smallest value that a fraction `part` of the weight does not exceed.
inline double quantile(
	const std::vector<double>& value, const std::vector<double>& weight, double part)
{
	std::vector<int> order(value.size());
	std::iota(order.begin(), order.end(), 0);
	std::sort(order.begin(), order.end(),
		[&](int i, int j) { return value[i] != value[j] ? value[i] < value[j] : i < j; });
	const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
	double sum = 0, last = 0;
	for (int i : order) {
		if (weight[i] <= 0)
			continue;
		last = value[i];
		sum += weight[i];
		if (sum >= part * total)
			break;
	}
	return last;
}

/// Terminal branches with a prominence below a tenth.
inline int countSpurs(const CurveSkeleton& skeleton, const std::vector<double>& clearance)
{
	constexpr double minimum = 0.1;
	CurveSkeleton s = skeleton;
	s.radius.resize(clearance.size());
	for (size_t v = 0; v < clearance.size(); ++v)
		s.radius[v] = std::max(clearance[v], 0.0);
	const std::vector<std::vector<int>> neighbours = s.neighbours();
	int spurs = 0;
	for (const Branch& branch : skeletonBranches(s)) {
		const bool firstIsTip = neighbours[branch.first()].size() == 1;
		if (firstIsTip == (neighbours[branch.last()].size() == 1))
			continue;
		const double out = firstIsTip ? prominence(s, branch.first(), branch.last())
									  : prominence(s, branch.last(), branch.first());
		spurs += out < minimum;
	}
	return spurs;
}

/// Points spread evenly inside a surface; fewer than `count` if it fills less than 2 % of its box.
/// @throws Cancelled
inline std::vector<Point3d> interiorPoints(
	const SurfaceMesh& surface, const ClosestSurface& closest, int count, const Progress& progress)
{
	constexpr int maxTries = 50; // for each
	const char* const what = "Measuring the volume";
	const Box3d box = surface.bounds(progress);
	std::vector<Point3d> inside;
	const int blockSize = 4096;
	std::vector<char> isInside(blockSize);
	for (int first = 0; first < maxTries * count && int(inside.size()) < count;
		 first += blockSize) {
		const auto point = [&](int i) {
			const auto u = evenPoint<3>(size_t(first) + size_t(i));
			return box.min + Point3d(u[0] * box.DimX(), u[1] * box.DimY(), u[2] * box.DimZ());
		};
		progress.report(double(inside.size()) / count, what);
		forEachBlock(blockSize, progress.cancelOnly(), what, [&](int begin, int end) {
			for (int i = begin; i < end; ++i)
				isInside[i] = closest.clearance(point(i)) > 0;
		});
		for (int i = 0; i < blockSize && int(inside.size()) < count; ++i)
			if (isInside[i])
				inside.push_back(point(i));
	}
	return inside;
}

} // namespace detail

/**
 * Measures a skeleton against its surface.
 *
 * @param skeleton  mesh units; radius and correspondence are not used.
 * @param surface   closed, compact, positive volume.
 * @param sampling  all counts > 0, the spacing >= 1e-4.
 * @throws InvalidInput if the skeleton has no edge of positive length, or is so long that it cannot
 *         be that surface's; Cancelled.
 * Complexity: O(S (log V + surfacePoints + innerPoints) + medialPoints log V) for S samples of the
 * skeleton. Same bits on any number of threads. Source: ours.
 */
inline SkeletonMeasures skeletonMeasures(const CurveSkeleton& skeleton, const SurfaceMesh& surface,
	const MeasureSampling& sampling = MeasureSampling(), const Progress& progress = Progress())
{
	constexpr double sampleSpacing = 0.01; // of triangles with longer edges
	constexpr int blocksPerReport = 4;
	const char* const what = "Finding the medial axis";
	const Progress begin = progress.cancelOnly();
	const Box3d box = surface.bounds(begin);
	const double diagonal = box.Diag();
	const Point3d corner = box.min;
	CurveSkeleton curve = skeleton;
	for (Point3d& p : curve.position)
		p = (p - corner) / diagonal;
	const double length = statistics(curve).length;
	if (!(length > 0))
		throw InvalidInput(
			"The skeleton has no edge of positive length: there is nothing to measure.");
	if (length > 1e4)
		throw InvalidInput("The skeleton is " + detail::countText(length)
			+ " times as long as the surface's bounding box diagonal: they do not belong together.");
	SurfaceMesh unit = surface.copied(begin);
	detail::reportedLoop(unit.vertexSlots(), begin, what,
		[&](int v) { unit.position[v] = (unit.position[v] - corner) / diagonal; });
	const ClosestSurface closest(unit, detail::numberedArray(unit.position.size(), begin),
		sampleSpacing, progress.part(0, 0.2));
	const MedialReference reference =
		medialReference(unit, closest, sampling.medialPoints, progress.part(0.2, 0.6));
	const PointTree centres(reference.centre, progress.cancelOnly());

	const CurveSamples x = curveSamples(curve, sampling.spacing);
	const int n = int(x.position.size());
	std::vector<double> clearance(n), offCentre(n), medial(n);
	const auto measure = [&](int begin, int end) {
		for (int i = begin; i < end; ++i) {
			const ClosestSurface::Hit hit = closest.closest(x.position[i]);
			const bool inside = closest.isInside(x.position[i], hit);
			clearance[i] = inside ? hit.distance : -hit.distance;
			const detail::MedialPlace place =
				detail::nearestMedial(x.position[i], hit, inside, reference, centres, closest);
			medial[i] = place.distance;
			offCentre[i] = std::clamp(1 - clearance[i] / std::max(place.radius, 1e-9), 0.0, 2.0);
		}
	};
	forEachBlock(n, progress.part(0.6, 0.8), "Measuring the skeleton", measure, blocksPerReport);
	SkeletonMeasures m;
	double insideLength = 0, outsideLength = 0;
	for (int i = 0; i < n; ++i) {
		(clearance[i] > 0 ? insideLength : outsideLength) += x.weight[i];
		m.outDepthMax = std::max(m.outDepthMax, -clearance[i]);
		m.medialMean += medial[i] * x.weight[i] / length;
		m.offCentreMean += offCentre[i] * x.weight[i] / length;
		if (x.weight[i] > 0)
			m.medialMax = std::max(m.medialMax, medial[i]);
	}
	m.insideFraction = insideLength / (insideLength + outsideLength);
	m.medialP95 = detail::quantile(medial, x.weight, 0.95);
	m.nodeClearance.assign(clearance.end() - long(curve.position.size()), clearance.end());
	m.nodeMedialDistance.assign(medial.end() - long(curve.position.size()), medial.end());
	m.spurs = detail::countSpurs(curve, m.nodeClearance);

	std::vector<double> ball;
	for (double r : clearance)
		ball.push_back(std::max(r, 0.0));
	const std::vector<SurfaceSample> samples =
		surfaceSamples(unit, sampling.surfacePoints, progress.cancelOnly());
	const ClosestCurve closestCurve(curve);
	std::vector<double> cover(samples.size()), recon(samples.size());
	const auto measureCoverage = [&](int begin, int end) {
		for (int i = begin; i < end; ++i) {
			const Point3d& q = samples[i].position;
			cover[i] = closestCurve.closest(q).distance;
			recon[i] = std::max(detail::distanceToBalls(q, x.position, ball), 0.0);
		}
	};
	forEachBlock(int(samples.size()), progress.part(0.8, 0.9), "Measuring the coverage",
		measureCoverage, blocksPerReport);
	const std::vector<double> even(samples.size(), 1);
	for (size_t i = 0; i < samples.size(); ++i) {
		m.coverMean += cover[i] / double(samples.size());
		m.reconMean += recon[i] / double(samples.size());
	}
	m.coverMax = *std::max_element(cover.begin(), cover.end());
	m.reconMax = *std::max_element(recon.begin(), recon.end());
	m.reconP95 = detail::quantile(recon, even, 0.95);

	const std::vector<Point3d> inner =
		detail::interiorPoints(unit, closest, sampling.innerPoints, progress.part(0.9, 0.95));
	std::vector<char> filled(inner.size());
	const auto measureVolume = [&](int begin, int end) {
		for (int i = begin; i < end; ++i)
			filled[i] = detail::distanceToBalls(inner[i], x.position, ball) <= 0;
	};
	forEachBlock(int(inner.size()), progress.part(0.95, 1), "Measuring the volume", measureVolume,
		blocksPerReport);
	if (!inner.empty())
		m.volumeFraction =
			double(std::count(filled.begin(), filled.end(), 1)) / double(inner.size());
	for (size_t v = 0; v < curve.position.size(); ++v) {
		m.nodeClearance[v] *= diagonal;
		m.nodeMedialDistance[v] *= diagonal;
	}
	return m;
}

} // namespace vcg::tri::mcf

#endif
