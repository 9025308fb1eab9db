// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Sorting of large arrays, by groups, which the user can cancel.

#ifndef VCG_MCF_GROUPED_SORT_H
#define VCG_MCF_GROUPED_SORT_H

#include "large_arrays.h"
#include "progress.h"
#include "ticker.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// Entries visited, or comparisons made, between two checks for cancellation: some milliseconds.
constexpr size_t sortedAtOnce = size_t(1) << 15;

/**
 * Sorts array[from, to) by operator<.
 * @throws Cancelled; the entries are unspecified then.
 */
template <class T>
void sortCancellable(std::vector<T>& array, size_t from, size_t to, const Cancellation& cancel)
{
	size_t comparisons = 0;
	const auto at = [&](size_t i) { return array.begin() + std::ptrdiff_t(i); };
	std::sort(at(from), at(to), [&](const T& a, const T& b) {
		if (++comparisons % sortedAtOnce == 0)
			cancel.check();
		return a < b;
	});
}

/// Entries in groups that are numbered from 0, each group sorted.
template <class Entry>
class SortedGroups
{
public:
	SortedGroups() = default;

	/**
	 * @param groupOf  int(i) for i in [0, count): the group of entry i, in [0, groups).
	 * @param entryOf  Entry(i): the entry itself. Groups are sorted by its operator<.
	 * @throws Cancelled
	 * Complexity: O(groups + count log(entries of the largest group)).
	 */
	template <class GroupOf, class EntryOf>
	SortedGroups(int count, size_t groups, const GroupOf& groupOf, const EntryOf& entryOf,
		const Progress& progress, const char* what)
	{
		// start[g + 1] is the next free place of group g; once g is full, g + 1 begins there.
		start = filledArray(groups + 2, 0, progress);
		reportedLoop(
			count, progress.part(0.1, 0.25), what, [&](int i) { ++start[size_t(groupOf(i)) + 2]; });
		reportedLoop(int(groups), progress.part(0.25, 0.35), what,
			[&](int g) { start[size_t(g) + 2] += start[size_t(g) + 1]; });
		entries = filledArray(size_t(count), Entry(), progress);
		reportedLoop(count, progress.part(0.45, 0.75), what,
			[&](int i) { entries[size_t(start[size_t(groupOf(i)) + 1]++)] = entryOf(i); });
		const Progress sorting = progress.part(0.75, 1);
		forEachRange(sorting, what, [&](int, size_t from, size_t to) {
			if (to - from > sortedAtOnce)
				sortCancellable(entries, from, to, sorting);
			else
				std::sort(
					entries.begin() + std::ptrdiff_t(from), entries.begin() + std::ptrdiff_t(to));
		});
	}

	/// Calls visit(group, first entry, end of its entries) for each group that has any, in order.
	/// @throws Cancelled
	template <class Visit>
	void forEach(const Progress& progress, const char* what, Visit&& visit) const
	{
		forEachRange(progress, what, [&](int g, size_t from, size_t to) {
			visit(g, entries.data() + from, entries.data() + to);
		});
	}

	/// The entries of a group, from the first to the end.
	std::pair<const Entry*, const Entry*> of(int group) const
	{
		return {entries.data() + start[size_t(group)], entries.data() + start[size_t(group) + 1]};
	}

private:
	std::vector<int> start; ///< of each group; the end of the last one; a spare
	std::vector<Entry> entries;

	/// As forEach(), with indices into `entries`. Empty groups count for the reports as well; there
	/// may be no other ones.
	template <class Visit>
	void forEachRange(const Progress& progress, const char* what, Visit&& visit) const
	{
		progress.report(0, what);
		size_t sinceReport = 0;
		for (size_t g = 0; g + 2 < start.size(); ++g) {
			const size_t from = size_t(start[g]), to = size_t(start[g + 1]);
			sinceReport += 1 + (to - from);
			if (sinceReport > sortedAtOnce) {
				progress.report(entries.empty() ? 1 : double(from) / double(entries.size()), what);
				sinceReport = 0;
			}
			if (from < to)
				visit(int(g), from, to);
		}
	}
};

} // namespace vcg::tri::mcf::detail

#endif
