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
 * They are kept in buckets of lengths a factor of 1.1 apart: putting one in and taking one out are
 * O(1). Splits and flips rename edges; whoever makes them pushes the edges with new names again,
 * and stale entries are passed over.
 */
template <class LimitOf>
class LongEdgeQueue
{
public:
	/// @param limitOf double(half-edge): the greatest length that is not too long, mesh units; the same
	///                for both half-edges of an edge.
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
