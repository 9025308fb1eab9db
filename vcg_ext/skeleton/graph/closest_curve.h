// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Closest points of a skeleton's edges, and points spread evenly along them.

#ifndef VCG_MCF_CLOSEST_CURVE_H
#define VCG_MCF_CLOSEST_CURVE_H

#include "curve_skeleton.h"

#include <skeleton/core/segment.h>
#include <skeleton/spatial/point_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vcg::tri::mcf {

/// Points on a skeleton, each with the length that it stands for.
struct CurveSamples
{
	std::vector<Point3d> position;
	/// Mesh units. 0 for the nodes, which are samples too, so that no extreme is missed.
	std::vector<double> weight;
	/// The edge that each is on, and the fraction of its length, in [0, 1]; -1 and 0 for the nodes.
	std::vector<int> edge;
	std::vector<double> part;
};

/**
 * The middles of the pieces of a skeleton's edges cut to at most `spacing`, then the nodes.
 * @pre spacing > 0. Complexity: O(length / spacing + V + E).
 */
inline CurveSamples curveSamples(const CurveSkeleton& skeleton, double spacing)
{
	CurveSamples samples;
	const auto add = [&](const Point3d& p, double weight, int edge, double part) {
		samples.position.push_back(p);
		samples.weight.push_back(weight);
		samples.edge.push_back(edge);
		samples.part.push_back(part);
	};
	for (size_t e = 0; e < skeleton.edges.size(); ++e) {
		const Point3d& a = skeleton.position[skeleton.edges[e][0]];
		const Point3d& b = skeleton.position[skeleton.edges[e][1]];
		const double length = Distance(a, b);
		const int pieces = std::max(1, int(std::ceil(length / spacing)));
		for (int i = 0; i < pieces; ++i) {
			const double part = (i + 0.5) / pieces;
			add(a + (b - a) * part, length / pieces, int(e), part);
		}
	}
	for (const Point3d& p : skeleton.position)
		add(p, 0, -1, 0);
	return samples;
}

/// Finds the closest point of a skeleton, exactly, however long the edges are.
class ClosestCurve
{
public:
	struct Hit
	{
		Point3d point;
		double distance;
		/// The edge that the point is on, -1 on an isolated node; how far along it, in [0, 1].
		int edge;
		double part;
	};

	/**
	 * @param skeleton  kept by reference.
	 * @pre the skeleton has a node.
	 * Complexity: O(V log V).
	 */
	explicit ClosestCurve(const CurveSkeleton& skeleton) :
			skeleton(skeleton), spacing(meanEdgeLength(skeleton)),
			samples(curveSamples(skeleton, spacing)), tree(samples.position)
	{
	}

	/// Complexity: O(log V) near the skeleton, more where much of it is equally far.
	Hit closest(const Point3d& query) const
	{
		Search search {*this, query, {Point3d(), std::numeric_limits<double>::max(), -1, 0}};
		tree.search(search);
		return search.best;
	}

private:
	struct Search
	{
		const ClosestCurve& curve;
		Point3d query;
		Hit best;

		const Point3d& centre() const { return query; }
		/// The closest point is within half a piece of the middle of its piece.
		double reach() const { return best.distance + curve.spacing / 2; }
		void visit(int slot, const Point3d& middle)
		{
			const int edge = curve.samples.edge[curve.tree.order()[slot]];
			const Hit hit = edge >= 0 ? curve.onEdge(edge, query)
									  : Hit {middle, Distance(middle, query), -1, 0};
			// Of equals the lowest edge, so that the order of the visits does not matter.
			const bool first = unsigned(hit.edge) < unsigned(best.edge);
			if (hit.distance < best.distance || (hit.distance == best.distance && first))
				best = hit;
		}
	};

	const CurveSkeleton& skeleton;
	double spacing;
	CurveSamples samples;
	PointTree tree;

	static double meanEdgeLength(const CurveSkeleton& skeleton)
	{
		double sum = 0;
		for (const auto& [a, b] : skeleton.edges)
			sum += Distance(skeleton.position[a], skeleton.position[b]);
		return sum > 0 ? sum / double(skeleton.edges.size()) : 1;
	}

	Hit onEdge(int edge, const Point3d& query) const
	{
		const Point3d& a = skeleton.position[skeleton.edges[edge][0]];
		const Point3d& b = skeleton.position[skeleton.edges[edge][1]];
		const auto [point, part] = closestOnSegment(a, b, query);
		return {point, Distance(point, query), edge, part};
	}
};

} // namespace vcg::tri::mcf

#endif
