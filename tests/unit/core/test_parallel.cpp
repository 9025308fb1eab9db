// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "threads.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/parallel.h>

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

/// Parts of 1000 to 9000 elements, of which those in the middle are the largest.
const std::vector<int> starts = {0, 1000, 6000, 15000, 22000, 24000};

void doWork()
{
	std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

} // namespace

TEST(ForEachPart, HasEachPartOnceOnAnyNumberOfThreads)
{
	for (int threads : {1, 2, 5}) {
		const ThreadCount limit(threads);
		std::mutex mutex;
		std::set<std::pair<int, int>> parts;
		forEachPart(starts, Progress(), "work", [&](int begin, int end, const Progress&) {
			const std::lock_guard<std::mutex> lock(mutex);
			EXPECT_TRUE(parts.emplace(begin, end).second);
		});
		std::set<std::pair<int, int>> expected;
		for (size_t i = 1; i < starts.size(); ++i)
			expected.emplace(starts[i - 1], starts[i]);
		EXPECT_EQ(parts, expected) << threads;
	}
}

TEST(ForEachPart, ReportsFromTheCallingThreadAloneAndForward)
{
	for (int threads : {1, 3}) {
		const ThreadCount limit(threads);
		const std::thread::id caller = std::this_thread::get_id();
		int last = 0, reports = 0;
		const Progress progress([&](int percent, const char* what) {
			EXPECT_EQ(std::this_thread::get_id(), caller);
			EXPECT_GE(percent, last);
			EXPECT_EQ(std::string(what), "work");
			last = percent;
			++reports;
			return true;
		});
		forEachPart(starts, progress, "work", [&](int, int, const Progress& part) {
			for (double fraction : {0.0, 0.5, 1.0}) {
				part.report(fraction, "work");
				doWork();
			}
		});
		EXPECT_GT(reports, 2);
		EXPECT_GT(last, 30);
	}
}

TEST(ForEachPart, IsCancelledByOneAnswerWhereverItComes)
{
	for (int threads : {1, 3})
		for (int stopAt : {1, 2, 5}) {
			const ThreadCount limit(threads);
			int reports = 0;
			const Progress progress([&](int, const char*) { return ++reports < stopAt; });
			std::atomic<int> finished = 0;
			const auto run = [&] {
				forEachPart(starts, progress, "work", [&](int, int, const Progress& part) {
					for (int i = 0; i < 100; ++i) {
						part.report(i / 100.0, "work");
						doWork();
					}
					++finished;
				});
			};
			EXPECT_THROW(run(), Cancelled);
			EXPECT_EQ(reports, stopAt); // nobody asks again
			EXPECT_EQ(finished, 0);
		}
}

TEST(ForEachPart, ThrowsWhatAPartThrows)
{
	for (int threads : {1, 3}) {
		const ThreadCount limit(threads);
		const auto run = [&](const Progress& progress) {
			forEachPart(starts, progress, "work", [&](int begin, int, const Progress& part) {
				for (int i = 0; i < 20; ++i) {
					doWork();
					part.report(i / 20.0, "work"); // the others are cancelled
				}
				if (begin == 6000)
					throw SolverError("no solution");
			});
		};
		EXPECT_THROW(run(Progress()), SolverError);
		EXPECT_THROW(run(Progress([](int, const char*) { return true; })), SolverError);
	}
}

TEST(ForEachQuarter, HasEachQuarterOnceOnAnyNumberOfThreads)
{
	for (int threads : {1, 2, 5}) {
		const ThreadCount limit(threads);
		for (int count : {4, 7, 9001}) {
			const auto divide = [](int begin, int end, const Progress&) {
				return begin + (end - begin) / 2;
			};
			const Quarters cuts = quarteredRange(count, Progress(), "", divide);
			EXPECT_EQ(cuts[0], 0);
			EXPECT_EQ(cuts[1], divide(0, cuts[2], Progress()));
			EXPECT_EQ(cuts[2], divide(0, count, Progress()));
			EXPECT_EQ(cuts[3], divide(cuts[2], count, Progress()));
			EXPECT_EQ(cuts[4], count);
			std::mutex mutex;
			std::set<int> seen;
			forEachQuarter(
				cuts, Progress(), "", [&](int quarter, int begin, int end, const Progress&) {
					const std::lock_guard<std::mutex> lock(mutex);
					EXPECT_EQ(begin, cuts[size_t(quarter)]);
					EXPECT_EQ(end, cuts[size_t(quarter) + 1]);
					EXPECT_TRUE(seen.insert(quarter).second);
				});
			EXPECT_EQ(seen.size(), 4u);
		}
	}
}

TEST(ForEachBlock, ThrowsWhatABlockThrowsAndIsUsableAgain)
{
	for (int threads : {1, 3}) {
		const ThreadCount limit(threads);
		for (int bad : {0, 256 * 5, 256 * 40})
			EXPECT_THROW(forEachBlock(256 * 50, Progress(), "work",
							 [&](int begin, int) {
								 if (begin == bad)
									 throw std::bad_alloc();
							 }),
				std::bad_alloc);
		std::atomic<int> done = 0;
		forEachBlock(1000, Progress(), "work", [&](int begin, int end) { done += end - begin; });
		EXPECT_EQ(done, 1000);
	}
}

TEST(ForEachBlock, DoesWithOneThreadWhereTheSystemRefusesMore)
{
	std::atomic<int> done = 0, byOthers = 0;
	// In a thread of its own, which has none yet that wait for work.
	std::thread([&] {
		const ThreadCount limit(100); // more than the C library keeps memory for
		const std::thread::id caller = std::this_thread::get_id();
		rlimit before;
		ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
		const rlimit none {1 << 20, before.rlim_max};
		ASSERT_EQ(setrlimit(RLIMIT_AS, &none), 0);
		forEachBlock(256 * 50, Progress(), "work", [&](int begin, int end) {
			done += end - begin;
			byOthers += std::this_thread::get_id() != caller;
		});
		ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
	}).join();
	EXPECT_EQ(done, 256 * 50);
	EXPECT_EQ(byOthers, 0);
}
