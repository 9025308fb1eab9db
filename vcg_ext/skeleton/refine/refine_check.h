// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the check: whether a refined curve is what it promises to be.

#ifndef VCG_MCF_REFINE_CHECK_H
#define VCG_MCF_REFINE_CHECK_H

#include "refine_peaks.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/shape_limits.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/closest_surface.h>
#include <skeleton/spatial/empty_balls.h>
#include <skeleton/spatial/vertical_crossing.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf::refining {

/// What a refined curve may fail at, in the order of the tests: the first failure is reported.
enum class Defect {
	None,
	NotFinite, ///< or the centring could not be solved
	TooLong,   ///< or too many nodes, see CurveBounds
	Topology,  ///< the number of components or cycles has changed
	Outside,   ///< a node or an edge is outside the surface
};

/// The maximum number of nodes that the sampling gives a curve. @param length in diagonals.
inline double maxNodes(double length)
{
	constexpr double nodesOfDiagonal = 1500;
	return nodesOfDiagonal * (1 + length);
}

/**
 * How large a refined curve may be, given its unrefined one; lengths in diagonals. New branches
 * lead into features, so that a curve may grow, but not without limit: a node that strays drags two
 * edges along, on which each sampling puts nodes; ways around bends of thin walls add nodes, too.
 */
class CurveBounds
{
public:
	/// The maximum length is three times the unrefined length and, for each tip of the curve, half
	/// a diagonal: a curve with few tips that is longer runs back and forth. Two to six tips count, so that the
	/// bound is at most three times the sum of the unrefined length and the diagonal; the maximum
	/// number of nodes is twice the sum of those before and those at `spacing` along that.
	CurveBounds(const CurveSkeleton& unrefined, double spacing) :
			nodesBefore(unrefined.position.size())
	{
		constexpr double longer = 3, denser = 2;
		longest = longer * statistics(unrefined).length;
		nodes =
			size_t(denser * (double(nodesBefore) + (longest + ofTip * double(mostTips)) / spacing));
	}

	/// Whether a curve may be refined further, as far as its length goes.
	bool holdLength(const CurveSkeleton& curve) const
	{
		const SkeletonStatistics its = statistics(curve);
		const int tips = std::clamp(its.terminals, fewestTips, mostTips);
		return its.length <= longest + ofTip * tips; // false if the length is NaN
	}

	/// Whether a sampled curve may be refined further, as far as the number of its nodes goes.
	bool holdNodes(const CurveSkeleton& curve) const { return curve.position.size() <= nodes; }

	/// Whether a curve may be the result: within both bounds, with at most 4/3 maxNodes() nodes more
	/// than before.
	bool holdAtEnd(const CurveSkeleton& curve) const
	{
		constexpr double more = 4.0 / 3;
		return holdLength(curve) && holdNodes(curve)
			&& double(curve.position.size())
			<= double(nodesBefore) + more * maxNodes(statistics(curve).length);
	}

private:
	static constexpr int fewestTips = 2, mostTips = 6;
	static constexpr double ofTip = 0.5;

	double longest; ///< without what the tips add
	size_t nodes, nodesBefore;
};

/**
 * The test of whether a curve is inside: by exact closest points, which are right wherever the
 * surface does not intersect itself; what is outside by these is tested by the winding number, for
 * which a point that is enclosed twice is inside.
 */
class InsideCheck
{
public:
	InsideCheck(const ClosestSurface& closest, const SurfaceComponent& component) :
			closest(closest), component(component)
	{
	}

	/**
	 * Whether the nodes and edges of a curve are inside: where no edge leaves the surface, one node
	 * decides for its connected component. @throws Cancelled
	 * Complexity: O((N + E) log V); O(V) for each edge within a self-intersection.
	 */
	bool holds(const CurveSkeleton& curve, const Progress& progress) const
	{
		constexpr int samplesOfVertex = 8; // then a tree of the triangles is cheaper
		int left = samplesOfVertex * int(component.vertices.size());
		const auto exactly = [&](const Point3d& p) {
			const double distance = left >= 0 ? closest.distanceNearby(p, left) : 0;
			if (left >= 0)
				return distance;
			closest.prepareExact(progress);
			return closest.closestExactly(p).distance;
		};
		const auto cheaply = [&](const Point3d& p) { return closest.emptyRadius(p); };
		constexpr int halvings = 4;
		CoveredCurve covered =
			coveredCurve(curve.position, curve.edges, cheaply, halvings, progress, what);
		std::vector<double>& empty = covered.radius; // of balls that the surface does not enter
		for (size_t e = 0; e < curve.edges.size(); ++e) {
			if (covered.isCovered[e])
				continue;
			progress.report(1, what);
			const auto& [a, b] = curve.edges[e];
			const Point3d &from = curve.position[a], &to = curve.position[b];
			if (isCoveredByBalls(from, empty[a], to, empty[b], cheaply, halvings))
				continue; // an exact radius, found for another edge, is enough
			for (int end : {a, b})
				empty[end] = exactly(curve.position[end]);
			if (!isCovered(from, empty[a], to, empty[b], exactly, progress)
				&& !isEnclosed(from, to, progress))
				return false;
		}
		const std::vector<Point3d> firsts = firstNodes(curve);
		return std::all_of(firsts.begin(), firsts.end(), [&](const Point3d& p) {
			progress.report(1, what);
			return windingNumber(p, progress) > 0 || closest.exactClearance(p, progress) > 0;
		});
	}

	/// How many nodes are outside, by their closest points. @throws Cancelled
	/// Complexity: O(N log V).
	int countOutside(const CurveSkeleton& curve, const Progress& progress) const
	{
		int outside = 0;
		for (size_t v = 0; v < curve.position.size(); ++v) {
			if (v % nodesPerCheck == 0)
				progress.report(double(v) / double(curve.position.size()), what);
			outside += !(closest.exactClearance(curve.position[v], progress) > 0);
		}
		return outside;
	}

private:
	static constexpr const char* what = "Checking the skeleton";

	const ClosestSurface& closest;
	SurfaceComponent component; ///< refers to what the caller keeps

	/// Whether empty balls cover the segment; false as well if it comes nearer to the surface than
	/// its length / 2^16, or if the closest points would take longer than isEnclosed().
	template <class DistanceAt>
	bool isCovered(const Point3d& a, double radiusA, const Point3d& b, double radiusB,
		const DistanceAt& distanceAt, const Progress& progress) const
	{
		constexpr int minimum = 64, verticesOfQuery = 8, halvings = 16;
		int queries = minimum + int(component.vertices.size()) / verticesOfQuery;
		const auto counted = [&](const Point3d& p) {
			if (--queries < 0)
				return 0.0;
			if (queries % int(nodesPerCheck) == 0)
				progress.report(0, what);
			return distanceAt(p);
		};
		return isCoveredByBalls(a, radiusA, b, radiusB, counted, halvings);
	}

	/// The first node of each connected component of the curve.
	static std::vector<Point3d> firstNodes(const CurveSkeleton& curve)
	{
		const std::vector<std::vector<int>> neighbours = curve.neighbours();
		std::vector<char> seen(neighbours.size(), 0);
		std::vector<Point3d> firsts;
		for (int v = 0; v < int(neighbours.size()); ++v) {
			if (seen[v])
				continue;
			firsts.push_back(curve.position[v]);
			seen[v] = 1;
			for (std::vector<int> stack(1, v); !stack.empty();) {
				const int at = stack.back();
				stack.pop_back();
				for (int w : neighbours[at])
					if (!seen[w]) {
						seen[w] = 1;
						stack.push_back(w);
					}
			}
		}
		return firsts;
	}

	template <class Visitor>
	void forEachTriangle(const Cancellation& cancel, Visitor&& visit) const
	{
		detail::cancellableLoop(int(component.vertices.size()), cancel, [&](int i) {
			component.mesh.forEachOwnFace(
				component.vertices[size_t(i)], [&](int f) { visit(component.mesh.triangle(f)); });
		});
	}

	/// How many times the surface goes around a point.
	int windingNumber(const Point3d& p, const Cancellation& cancel) const
	{
		int winding = 0;
		forEachTriangle(cancel, [&](const Triangle& t) {
			winding += detail::crossingAbove(component.mesh.position, t, p);
		});
		return winding;
	}

	/// Whether the winding number in the middle of each part of a segment between two crossings of
	/// the surface is positive.
	bool isEnclosed(const Point3d& a, const Point3d& b, const Progress& progress) const
	{
		constexpr double shortest =
			1e-6; // parts of the segment; shorter ones are where triangles meet
		const Point3d segment = b - a;
		std::vector<double> ends = {0, 1};
		forEachTriangle(progress, [&](const Triangle& t) {
			const Point3d& u = component.mesh.position[t[0]];
			const Point3d e1 = component.mesh.position[t[1]] - u;
			const Point3d e2 = component.mesh.position[t[2]] - u, across = segment ^ e2;
			const double determinant = e1 * across;
			if (determinant == 0)
				return;
			const Point3d from = a - u, aside = from ^ e1;
			const double x = from * across / determinant, y = segment * aside / determinant;
			const double along = e2 * aside / determinant;
			if (x >= 0 && y >= 0 && x + y <= 1 && along > 0 && along < 1)
				ends.push_back(along);
		});
		std::sort(ends.begin(), ends.end());
		for (size_t i = 1; i < ends.size(); ++i) {
			progress.report(0, what);
			if (ends[i] - ends[i - 1] > shortest
				&& windingNumber(a + segment * ((ends[i - 1] + ends[i]) / 2), progress) <= 0)
				return false;
		}
		return true;
	}
};

inline bool isFinite(const CurveSkeleton& curve)
{
	return std::all_of(curve.position.begin(), curve.position.end(), isFinitePlace);
}

/// The defect of a curve refined from another one, but for Outside; both in units of the diagonal.
inline Defect defectOfShape(
	const CurveSkeleton& refined, const CurveSkeleton& unrefined, double spacing)
{
	if (!isFinite(refined))
		return Defect::NotFinite;
	if (!CurveBounds(unrefined, spacing).holdAtEnd(refined))
		return Defect::TooLong;
	const SkeletonStatistics before = statistics(unrefined), after = statistics(refined);
	if (before.components != after.components || before.cycles != after.cycles)
		return Defect::Topology;
	return Defect::None;
}

/// The defect of a curve refined from another one, both in units of the diagonal. @throws Cancelled
inline Defect defectOf(const CurveSkeleton& refined, const CurveSkeleton& unrefined, double spacing,
	const InsideCheck& inside, const Progress& progress = Progress())
{
	const Defect defect = defectOfShape(refined, unrefined, spacing);
	if (defect != Defect::None)
		return defect;
	return inside.holds(refined, progress) ? Defect::None : Defect::Outside;
}

} // namespace vcg::tri::mcf::refining

#endif
