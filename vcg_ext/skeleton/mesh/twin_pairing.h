// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The adjacency of triangles: each half-edge is paired with the one that runs back.

#ifndef VCG_MCF_TWIN_PAIRING_H
#define VCG_MCF_TWIN_PAIRING_H

#include <skeleton/core/grouped_sort.h>
#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// Pairs the half-edges of a surface, see pairTwins().
class TwinPairing
{
public:
	/// @see pairTwins()
	TwinPairing(const std::vector<int>& origins, std::vector<int>& twins) :
			origins(origins), twins(twins)
	{
	}

	/// @see pairTwins()
	bool run(int vertices, const Progress& progress)
	{
		const int halfEdges = int(origins.size());
		std::vector<int> start = filledArray(size_t(vertices) + 1, 0, progress);
		std::vector<int> bucket = filledArray(origins.size(), 0, progress);
		const auto lower = [&](int h) { return std::min(origins[h], target(h)); };
		reportedLoop(
			halfEdges, progress.part(0.2, 0.3), checking, [&](int h) { ++start[lower(h) + 1]; });
		reportedLoop(
			vertices, progress.part(0.3, 0.4), checking, [&](int v) { start[v + 1] += start[v]; });
		const Progress pairing = progress.part(0.4, 1);
		std::vector<int> end = copiedArray(start, pairing);
		reportedLoop(halfEdges, pairing, checking, [&](int h) {
			const int low = lower(h);
			const int last = std::min(end[low], start[low] + maxSearched);
			for (int i = start[low]; i < last; ++i) {
				const int g = bucket[i];
				if (areOpposite(g, h)) {
					join(h, g);
					bucket[i] = bucket[--end[low]]; // a fan in order stays cheap
					break;
				}
			}
			if (twins[h] < 0)
				bucket[end[low]++] = h;
		});
		const auto areAllPaired = [&] {
			return std::find(twins.begin(), twins.end(), -1) == twins.end();
		};
		if (areAllPaired())
			return true;
		cancellableLoop(vertices, pairing, [&](int low) {
			if (end[low] - start[low] > 1)
				pairSorted(bucket, start[low], end[low], pairing);
		});
		return areAllPaired();
	}

private:
	static constexpr const char* checking = "Checking the surface";
	static constexpr int maxSearched = 64; ///< half-edges of a bucket

	const std::vector<int>& origins;
	std::vector<int>& twins;

	int target(int h) const { return origins[h % 3 == 2 ? h - 2 : h + 1]; }
	bool areOpposite(int g, int h) const
	{
		return origins[g] == target(h) && target(g) == origins[h];
	}
	void join(int g, int h)
	{
		twins[g] = h;
		twins[h] = g;
	}

	/// Pairs those of the half-edges bucket[from, to) of a lower end that have a twin.
	/// @throws Cancelled
	void pairSorted(const std::vector<int>& bucket, int from, int to, const Cancellation& cancel)
	{
		std::vector<std::pair<int, int>> sorted; // other end, half-edge
		sorted.reserve(size_t(to - from));
		for (int i = from; i < to; ++i)
			sorted.emplace_back(std::max(origins[bucket[i]], target(bucket[i])), bucket[i]);
		sortCancellable(sorted, 0, sorted.size(), cancel);
		size_t waiting = 0; // the first of this edge without a twin
		for (size_t i = 0; i < sorted.size(); ++i) {
			if (sorted[waiting].first != sorted[i].first)
				waiting = i;
			while (waiting < i && twins[sorted[waiting].second] >= 0)
				++waiting;
			if (waiting < i && areOpposite(sorted[waiting].second, sorted[i].second))
				join(sorted[waiting].second, sorted[i].second);
		}
	}
};

/**
 * Pairs half-edges: h = 3 f + k runs along triangle f from its corner k to the next one. Each lower
 * end has a bucket of those that wait for their twin. Only the first ones of a bucket are searched;
 * what is left in the end is sorted.
 * @param origins   the vertex that each half-edge starts at.
 * @param twins     -1 everywhere; receives the half-edge that runs back along each one.
 * @param vertices  their number.
 * @return whether each half-edge has a twin.
 * @throws Cancelled. Complexity: O(F); O(F + n log n) where n faces meet at a vertex.
 */
inline bool pairTwins(const std::vector<int>& origins, std::vector<int>& twins, int vertices,
	const Progress& progress)
{
	return TwinPairing(origins, twins).run(vertices, progress);
}

} // namespace vcg::tri::mcf::detail

#endif
