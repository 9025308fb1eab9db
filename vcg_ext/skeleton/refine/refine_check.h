// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the check: whether a refined curve is what it promises to be.

#ifndef VCG_MCF_REFINE_CHECK_H
#define VCG_MCF_REFINE_CHECK_H

#include "refine_peaks.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/closest_surface.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf::refining {

/// What a refined curve may fail at. The first one that holds is told.
enum class Defect {
	None,
	NotFinite, ///< or the centring could not be solved
	TooLong,   ///< or too many nodes, see CurveBounds
	Topology,  ///< components or cycles came or went
	Outside,   ///< a node or an edge is outside the surface
};

/// The maximum number of nodes that the sampling gives a curve whose length is so many diagonals.
inline double maxNodes(double length)
{
	constexpr double nodesOfDiagonal = 1500;
	return nodesOfDiagonal * (1 + length);
}

/**
 * How large a refined curve may be, from its unrefined one, in diagonals. New branches lead into features,
 * so that a curve may grow, but not without limit: a node that strays drags two edges along, and each
 * sampling makes nodes of them; ways around the bends of thin walls have nodes of their own.
 */
class CurveBounds
{
public:
	/// A curve may become three times as long as itself and the shape's diagonal together, and have twice
	/// the nodes that it has and that are as far apart as `spacing` on such a length.
	CurveBounds(const CurveSkeleton& unrefined, double spacing) :
			nodesBefore(unrefined.position.size())
	{
		constexpr double longer = 3, denser = 2;
		length = longer * (statistics(unrefined).length + 1);
		nodes = size_t(denser * (double(nodesBefore) + length / spacing));
	}

	/// Whether a curve may be refined further.
	bool hold(const CurveSkeleton& curve) const
	{
		return curve.position.size() <= nodes
			&& lengthOf(curve) <= length; // not if it is no number
	}

	/// Whether a curve may be the result: with no more nodes than before and a third more than maxNodes() besides.
	bool holdAtEnd(const CurveSkeleton& curve) const
	{
		constexpr double more = 4.0 / 3;
		return hold(curve)
			&& double(curve.position.size())
			<= double(nodesBefore) + more * maxNodes(lengthOf(curve));
	}

private:
	double length;
	size_t nodes, nodesBefore;

	static double lengthOf(const CurveSkeleton& curve)
	{
		double sum = 0;
		for (const auto& [a, b] : curve.edges)
			sum += Distance(curve.position[a], curve.position[b]);
		return sum;
	}
};

/**
 * Tells inside from outside without mistakes: by the closest point, none missed, which is right wherever
 * the surface does not intersect itself; what that takes for outside is asked of the winding number, for
 * which a place that is enclosed twice is inside.
 */
class InsideCheck
{
public:
	InsideCheck(const ClosestSurface& closest, const SurfaceComponent& component) :
			closest(closest), component(component)
	{
	}

	/**
	 * Whether a curve is inside, its nodes and its edges: where no edge meets the surface, one node tells
	 * for all that hang together. @throws Cancelled
	 * Complexity: O((N + E) log V); O(V) for each edge within a self-intersection.
	 */
	bool holds(const CurveSkeleton& curve, const Progress& progress) const
	{
		std::vector<double> empty; // radii of balls that the surface does not enter
		empty.reserve(curve.position.size());
		detail::reportedLoop(int(curve.position.size()), progress, what,
			[&](int v) { empty.push_back(closest.emptyRadius(curve.position[v])); });
		const auto measured = [&](int v) {
			return empty[v] = closest.closestExactly(curve.position[v]).distance;
		};
		for (const auto& [a, b] : curve.edges) {
			const Point3d &from = curve.position[a], &to = curve.position[b];
			if (Distance(from, to) > empty[a] + empty[b]
				&& !isCovered(from, measured(a), to, measured(b))
				&& !isEnclosed(from, to, progress))
				return false;
		}
		const std::vector<Point3d> firsts = firstNodes(curve);
		return std::all_of(firsts.begin(), firsts.end(), [&](const Point3d& p) {
			return closest.exactClearance(p) > 0 || windingNumber(p) > half;
		});
	}

	/// How many nodes are outside, by their closest points. Complexity: O(N log V).
	int countOutside(const CurveSkeleton& curve, const Progress& progress) const
	{
		int outside = 0;
		detail::reportedLoop(int(curve.position.size()), progress, what,
			[&](int v) { outside += !(closest.exactClearance(curve.position[v]) > 0); });
		return outside;
	}

private:
	static constexpr const char* what = "Checking the skeleton";
	static constexpr double half = 0.5;

	const ClosestSurface& closest;
	SurfaceComponent component; ///< refers to what its maker keeps

	/// Whether empty balls cover the segment; not if it comes nearer to the surface than its length / 2^16, or
	/// if that takes more closest points than take as long as isEnclosed().
	bool isCovered(const Point3d& a, double radiusA, const Point3d& b, double radiusB) const
	{
		constexpr int minimum = 64, verticesOfQuery = 8;
		int queries = minimum + int(component.vertices.size()) / verticesOfQuery;
		return isCovered(a, radiusA, b, radiusB, 0, queries);
	}
	/// @param queries that are left.
	bool isCovered(const Point3d& a, double radiusA, const Point3d& b, double radiusB, int depth,
		int& queries) const
	{
		constexpr int deepest = 16;
		if (!(radiusA > 0) || !(radiusB > 0) || depth > deepest || --queries < 0)
			return false;
		if (Distance(a, b) <= radiusA + radiusB)
			return true;
		const Point3d middle = (a + b) / 2;
		const double radius = closest.closestExactly(middle).distance;
		return isCovered(a, radiusA, middle, radius, depth + 1, queries)
			&& isCovered(middle, radius, b, radiusB, depth + 1, queries);
	}

	/// The first node of each part of the curve.
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
	void forEachTriangle(Visitor&& visit) const
	{
		const SurfaceMesh& mesh = component.mesh;
		for (int v : component.vertices)
			mesh.forEachOutgoing(v, [&](int h) {
				if (h % 3 == 0)
					visit(mesh.position[mesh.origin(h)], mesh.position[mesh.target(h)],
						mesh.position[mesh.apex(h)]);
			});
	}

	/// How often the surface goes round a point (van Oosterom and Strackee, "The solid angle of a plane
	/// triangle", IEEE Trans. Biomed. Eng. 30(2), 1983).
	double windingNumber(const Point3d& p) const
	{
		double sum = 0;
		forEachTriangle([&](const Point3d& u, const Point3d& v, const Point3d& w) {
			const Point3d a = u - p, b = v - p, c = w - p;
			const double la = a.Norm(), lb = b.Norm(), lc = c.Norm();
			sum +=
				std::atan2(a * (b ^ c), la * lb * lc + (a * b) * lc + (b * c) * la + (c * a) * lb);
		});
		return sum / (2 * M_PI);
	}

	/// Whether a segment is inside between each two of its crossings with the surface.
	bool isEnclosed(const Point3d& a, const Point3d& b, const Progress& progress) const
	{
		constexpr double shortest =
			1e-6; // parts of the segment; shorter ones are where triangles meet
		progress.report(0, what);
		const Point3d segment = b - a;
		std::vector<double> ends = {0, 1};
		forEachTriangle([&](const Point3d& u, const Point3d& v, const Point3d& w) {
			const Point3d e1 = v - u, e2 = w - u, across = segment ^ e2;
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
		for (size_t i = 1; i < ends.size(); ++i)
			if (ends[i] - ends[i - 1] > shortest
				&& windingNumber(a + segment * ((ends[i - 1] + ends[i]) / 2)) < half)
				return false;
		return true;
	}
};

inline bool isFinite(const CurveSkeleton& curve)
{
	return std::all_of(curve.position.begin(), curve.position.end(), [](const Point3d& p) {
		return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
	});
}

/// What is wrong with a curve refined from another one, wherever it is; both in diagonals.
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

/// What is wrong with a curve refined from another one, both in diagonals. @throws Cancelled
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
