// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/core/grouped_sort.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;
using detail::SortedGroups;

namespace {

using Pairs = std::vector<std::pair<int, int>>; ///< group and entry

/// Groups and entries at random; `share` of them in group 3.
Pairs randomPairs(int count, int groups, double share)
{
	std::mt19937 random(1);
	Pairs pairs;
	for (int i = 0; i < count; ++i)
		pairs.emplace_back(random() < share * double(random.max()) ? 3 : int(random() % groups),
			int(random() % 1000));
	return pairs;
}

/// All groups' entries, one after the other; checks that none is visited empty.
Pairs grouped(const Pairs& pairs, int groups, const Progress& progress = Progress())
{
	const SortedGroups<int> sorted(
		int(pairs.size()), size_t(groups), [&](int i) { return pairs[i].first; },
		[&](int i) { return pairs[i].second; }, progress, "");
	Pairs result;
	sorted.forEach(progress, "", [&](int group, const int* begin, const int* end) {
		EXPECT_LT(begin, end);
		for (; begin < end; ++begin)
			result.emplace_back(group, *begin);
	});
	return result;
}

} // namespace

TEST(SortedGroups, AreWhatASortByGroupAndEntryMakes)
{
	for (double share : {0.0, 0.6, 1.0})
		for (int groups : {4, 50, 300000})
			for (int count : {0, 1, 100, 200000}) {
				Pairs pairs = randomPairs(count, groups, share);
				const Pairs found = grouped(pairs, groups);
				std::sort(pairs.begin(), pairs.end());
				EXPECT_EQ(found, pairs) << share << ' ' << groups << ' ' << count;
			}
}

TEST(SortedGroups, OfNoEntriesReportPercentsAsOthersDo)
{
	for (int count : {0, 1}) {
		int reports = 0;
		const Progress progress([&](int percent, const char*) {
			++reports;
			EXPECT_GE(percent, 0);
			EXPECT_LE(percent, 100);
			return true;
		});
		EXPECT_EQ(grouped(randomPairs(count, 4, 1), 300000, progress).size(), size_t(count));
		EXPECT_GE(reports, 2 * 300000 / int(detail::sortedAtOnce));
	}
}

TEST(SortedGroups, OneLargeGroupAsksWhetherToCancelAsItGrows)
{
	constexpr int count = 1'000'000;
	const Pairs pairs = randomPairs(count, 4, 1);
	int asked = 0;
	grouped(pairs, 4, Progress([&](int, const char*) {
		++asked;
		return true;
	}));
	// Counted, put in place, and sorted by some 20 comparisons an entry.
	EXPECT_GE(asked, 12 * count / int(detail::sortedAtOnce));
}

TEST(SortedGroups, APartOfAnArrayIsSortedAndTheRestLeft)
{
	std::mt19937 random(2);
	std::vector<int> array(300000);
	for (int& x : array)
		x = int(random() % 100000);
	for (size_t from : {size_t(0), size_t(7), size_t(100000)})
		for (size_t to : {from, from + 1, from + detail::sortedAtOnce, array.size() - 5}) {
			std::vector<int> sorted = array, expected = array;
			detail::sortCancellable(sorted, from, to, Progress());
			std::sort(expected.begin() + long(from), expected.begin() + long(to));
			EXPECT_EQ(sorted, expected) << from << ' ' << to;
		}
}

TEST(SortedGroups, ASortCanBeCancelled)
{
	std::mt19937 random(3);
	std::vector<int> array(1'000'000);
	for (int& x : array)
		x = int(random());
	int asked = 0;
	const Progress progress([&](int, const char*) { return ++asked < 5; });
	EXPECT_THROW(detail::sortCancellable(array, 0, array.size(), progress), Cancelled);
	EXPECT_EQ(asked, 5);
	EXPECT_EQ(array.size(), 1'000'000u);
}
