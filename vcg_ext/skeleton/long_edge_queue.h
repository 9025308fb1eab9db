// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file A queue of the edges that are too long, for splitting the longest first.

#ifndef VCG_MCF_LONG_EDGE_QUEUE_H
#define VCG_MCF_LONG_EDGE_QUEUE_H

#include "surface_mesh.h"

#include <cmath>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * The edges longer than a limit, the longest first.
 *
 * They are kept in buckets of lengths a factor of 1.1 apart: putting one in and taking one out are
 * O(1). Splits and flips rename edges; whoever makes them pushes the edges with new names again,
 * and stale entries are passed over.
 */
template <class LimitAt>
class LongEdgeQueue
{
public:
	/// @param limitAt double(vertex): the greatest length that is not too long, mesh units.
	LongEdgeQueue(const SurfaceMesh& mesh, LimitAt limitAt) : mesh(mesh), limitAt(limitAt) {}

	/// Adds the edge of h if it is too long.
	void push(int h)
	{
		const int bucket = bucketOf(h);
		if (bucket < 0)
			return;
		if (bucket >= int(buckets.size()))
			buckets.resize(size_t(bucket) + 1);
		buckets[size_t(bucket)].push_back(h);
	}

	int size() const
	{
		size_t count = 0;
		for (const std::vector<int>& bucket : buckets)
			count += bucket.size();
		return int(count);
	}

	/// Takes out one of the longest edges; -1 if there is none.
	int pop()
	{
		while (!buckets.empty()) {
			std::vector<int>& longest = buckets.back();
			if (longest.empty()) {
				buckets.pop_back();
				continue;
			}
			const int h = longest.back();
			longest.pop_back();
			// An id may have come to mean another edge, which was pushed by its own length.
			if (bucketOf(h) + 1 == int(buckets.size()))
				return h;
		}
		return -1;
	}

private:
	const SurfaceMesh& mesh;
	LimitAt limitAt;
	std::vector<std::vector<int>> buckets; ///< the first one starts at the limit

	int bucketOf(int h) const
	{
		const double limit = limitAt(mesh.origin(h));
		const double relative = mesh.squaredLength(h) / (limit * limit);
		return relative > 1 ? int(std::log(relative) / (2 * std::log(1.1))) : -1;
	}
};

} // namespace vcg::tri::mcf::detail

#endif
