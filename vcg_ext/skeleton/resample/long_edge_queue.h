// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A queue of the edges that are too long, for splitting the longest first.

#ifndef VCG_MCF_LONG_EDGE_QUEUE_H
#define VCG_MCF_LONG_EDGE_QUEUE_H

#include <skeleton/mesh/surface_mesh.h>

#include <cmath>
#include <vector>

namespace vcg::tri::mcf::detail {

/**
 * The edges longer than a limit, the longest first.
 *
 * They are kept in buckets of lengths (relative to the limit) a factor of 1.1 apart, so that push()
 * and pop() are O(1). Splits and flips change the ids of edges: the caller pushes these edges
 * again, and stale entries are skipped.
 */
template <class LimitOf>
class LongEdgeQueue
{
public:
	/// @param limitOf double(half-edge): the greatest length that is not too long, mesh units; the
	///                same for both half-edges of an edge.
	LongEdgeQueue(const SurfaceMesh& mesh, LimitOf limitOf) : mesh(mesh), limitOf(limitOf) {}

	bool isTooLong(int h) const
	{
		const double limit = limitOf(h);
		return mesh.squaredLength(h) > limit * limit;
	}

	/// Adds the edge of h if it is too long.
	void push(int h)
	{
		if (!isTooLong(h))
			return;
		const int bucket = bucketOf(h);
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

	/// Removes and returns an edge of the bucket of the longest ones; -1 if none is too long.
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
			// The id may denote another edge by now, which has an entry in its own bucket.
			if (isTooLong(h) && bucketOf(h) + 1 == int(buckets.size()))
				return h;
		}
		return -1;
	}

private:
	const SurfaceMesh& mesh;
	LimitOf limitOf;
	std::vector<std::vector<int>> buckets; ///< the first one starts at the limit

	/// @pre isTooLong(h)
	int bucketOf(int h) const
	{
		const double limit = limitOf(h);
		return int(std::log(mesh.squaredLength(h) / (limit * limit)) / (2 * std::log(1.1)));
	}
};

} // namespace vcg::tri::mcf::detail

#endif
