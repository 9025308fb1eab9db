// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief How far apart two skeletons are (Table 1).

#ifndef VCG_MCF_COMPARE_SKELETONS_H
#define VCG_MCF_COMPARE_SKELETONS_H

#include "closest_curve.h"
#include "curve_skeleton.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>
#include <skeleton/core/progress.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// Distances from one skeleton to another, mesh units.
struct SkeletonDistance
{
	/// Mean over the length of the skeleton, over its nodes if it has no length; and the maximum.
	double mean = 0, greatest = 0;
	/// Of each node.
	std::vector<double> ofNode;
};

/**
 * The asymmetric distance from one skeleton to another: of points x spread evenly over `from`,
 *     mean and maximum of min over y in `to` of |x - y|.
 *
 * @param spacing  maximum distance of neighbouring points, mesh units, > 0; the paper takes 0.1 %
 *                 of the bounding box diagonal of the shape.
 * @throws InvalidParameter, also for more than 10 million points; InvalidInput if one of the
 *         skeletons is empty; Cancelled.
 * Complexity: O((length / spacing) log V). Same bits on any number of threads.
 * Source: paper, Table 1.
 */
inline SkeletonDistance distanceToSkeleton(const CurveSkeleton& from, const CurveSkeleton& to,
	double spacing, const Progress& progress = Progress())
{
	constexpr double maxPoints = 1e7;
	requireParameter(spacing > 0 && std::isfinite(spacing), "spacing", "greater than 0");
	if (from.position.empty() || to.position.empty())
		throw InvalidInput("One of the two skeletons has no nodes: there is nothing to compare.");
	if (statistics(from).length / spacing > maxPoints)
		throw InvalidParameter("Parameter spacing is too small: it would give more than "
			+ std::to_string(int(maxPoints)) + " points.");
	const CurveSamples samples = curveSamples(from, spacing);
	const ClosestCurve curve(to);
	std::vector<double> distance(samples.position.size());
	forEachBlock(int(distance.size()), progress, "Comparing skeletons", [&](int begin, int end) {
		for (int i = begin; i < end; ++i)
			distance[i] = curve.closest(samples.position[i]).distance;
	});

	SkeletonDistance result;
	result.ofNode.assign(distance.end() - long(from.position.size()), distance.end());
	double sum = 0, length = 0;
	for (size_t i = 0; i < distance.size(); ++i) {
		sum += samples.weight[i] * distance[i];
		length += samples.weight[i];
		result.greatest = std::max(result.greatest, distance[i]);
	}
	if (length > 0)
		result.mean = sum / length;
	else {
		for (double d : result.ofNode)
			result.mean += d / double(result.ofNode.size());
	}
	return result;
}

} // namespace vcg::tri::mcf

#endif
