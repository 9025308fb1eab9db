// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Loops over independent blocks or parts of a range, in parallel where there is OpenMP.

#ifndef VCG_MCF_PARALLEL_H
#define VCG_MCF_PARALLEL_H

#include "progress.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace vcg::tri::mcf {

namespace detail {

/// Whether `count` threads can be started now. The system's library keeps their memory for later.
inline bool canStartThreads(int count)
{
	std::mutex all;
	std::vector<std::thread> threads;
	bool started = true;
	{
		const std::lock_guard<std::mutex> untilAllRun(all);
		try {
			threads.reserve(size_t(count));
			for (int i = 0; i < count; ++i)
				threads.emplace_back([&all] { const std::lock_guard<std::mutex> wait(all); });
		}
		catch (const std::exception&) { // std::system_error, std::bad_alloc
			started = false;
		}
	}
	for (std::thread& thread : threads)
		thread.join();
	return started;
}

/// Whether 1 MB is free: OpenMP and the loader end the process where a small allocation fails.
inline bool hasReserve()
{
	constexpr size_t reserve = 1 << 20;
	void* const volatile block = std::malloc(reserve); // volatile: else the compiler leaves it out
	std::free(block);
	return block != nullptr;
}

/**
 * The number of threads for a loop: OpenMP's, or 1 where the system refuses that many.
 *
 * GCC's OpenMP ends the process where it cannot start a thread. It keeps its threads for the next
 * loop with as many, so that only a change of their number has to be tried out.
 */
inline int threadsForLoop()
{
#ifdef _OPENMP
	const int wanted = omp_in_parallel() ? 1 : omp_get_max_threads();
	if (wanted <= 1 || !hasReserve())
		return 1;
	static thread_local int running = 1;
	if (wanted != running) {
		if (!canStartThreads(wanted - 1))
			return 1;
		running = wanted;
	}
	return wanted;
#else
	return 1;
#endif
}

/// Calls work(isCallingThread) on each of several threads. @pre work does not throw.
template <class Work>
void onThreads([[maybe_unused]] int threads, const Work& work)
{
#ifdef _OPENMP
	// A team of one would replace the larger one that is kept for the next loop.
	if (threads > 1) {
#pragma omp parallel num_threads(threads)
		work(omp_get_thread_num() == 0);
		return;
	}
#endif
	work(true);
}

} // namespace detail

/**
 * Calls body(begin, end) for consecutive blocks of [0, count), several at once.
 *
 * The blocks do not depend on the number of threads, so that a body whose result depends on its
 * block alone gives the same bits on any machine. The calling thread reports in between.
 * @param blocksPerReport  fewer where an element takes more than some 10 us.
 * @throws what body throws for one of the blocks, such as std::bad_alloc; Cancelled.
 */
template <class Body>
void forEachBlock(int count, const Progress& progress, const char* what, const Body& body,
	int blocksPerReport = 32)
{
	constexpr int blockSize = 256;
	progress.report(0, what);
	const int blocks = (count + blockSize - 1) / blockSize;
	const int threads = detail::threadsForLoop();
	std::atomic<bool> failed = false;
	std::exception_ptr error;
	for (int first = 0; first < blocks; first += blocksPerReport) {
		const int last = std::min(first + blocksPerReport, blocks);
		std::atomic<int> next = first;
		// To wake other threads for a single block costs more than the block.
		detail::onThreads(last - first > 1 ? threads : 1, [&](bool) {
			try {
				for (int block; !failed && (block = next++) < last;)
					body(block * blockSize, std::min((block + 1) * blockSize, count));
			}
			catch (...) {
				if (!failed.exchange(true))
					error = std::current_exception();
			}
		});
		if (error)
			std::rethrow_exception(error);
		progress.report(double(last) / blocks, what);
	}
}

/**
 * Calls body(begin, end, progress) for the parts [start[i], start[i + 1]) of a range, the largest
 * ones first, several at once.
 *
 * Only the calling thread reports: from its parts, and while it waits for the other threads. The
 * progress of parts on these shows nothing; it throws Cancelled once the job is cancelled or a part
 * has failed.
 * @param start the begin of each part, ascending, and the end of the last one.
 * @pre not all parts are empty.
 * @throws what body throws for one of the parts; Cancelled.
 */
template <class Body>
void forEachPart(
	const std::vector<int>& start, const Progress& progress, const char* what, const Body& body)
{
	constexpr std::chrono::milliseconds reportEvery(1);
	[[maybe_unused]] constexpr double minForTeam = 1 << 12; // in less, the others hardly wake up
	const int count = int(start.size()) - 1;
	const auto size = [&](int part) { return start[part + 1] - start[part]; };
	std::vector<int> order(count);
	std::iota(order.begin(), order.end(), 0);
	std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return size(a) > size(b); });
	std::vector<double> before(1, 0); // sizes of the parts before each, in this order
	for (int part : order)
		before.push_back(before.back() + size(part));
	const double total = before.back();
	std::atomic<int> next = 0, done = 0;
	std::atomic<bool> stop = false;
	std::mutex waiting;
	std::condition_variable oneMore; // part is done
	std::vector<std::exception_ptr> errors(count + 1);
	const auto guarded = [&](std::exception_ptr& error, const auto& call) {
		try {
			call();
		}
		catch (...) {
			error = std::current_exception();
			stop = true;
		}
	};
	// Hidden, so that the threads that share it only read it. Made here: where memory is short,
	// work() must not throw.
	const Progress silent = Progress([&](int, const char*) { return !stop; }).cancelOnly();
	const auto work = [&](bool reports) {
		for (int i; !stop && (i = next++) < count;) {
			guarded(errors[i], [&] {
				const Progress window = progress.part(before[i] / total, before[i + 1] / total);
				body(start[order[i]], start[order[i] + 1], reports ? window : silent);
			});
			const std::lock_guard<std::mutex> lock(waiting);
			++done;
			oneMore.notify_one();
		}
		const auto isOver = [&] { return stop || done == count; };
		while (reports && !isOver()) {
			guarded(errors[count], [&] { progress.report(1, what); });
			std::unique_lock<std::mutex> lock(waiting);
			oneMore.wait_for(lock, reportEvery, isOver);
		}
	};
	detail::onThreads(total >= minForTeam ? detail::threadsForLoop() : 1, work);
	std::exception_ptr cancelled;
	for (const std::exception_ptr& error : errors)
		if (error)
			try {
				std::rethrow_exception(error);
			}
			catch (const Cancelled&) {
				cancelled = error; // perhaps since another part failed: its error comes first
			}
	if (cancelled)
		std::rethrow_exception(cancelled);
}

/// Where four parts of a range begin, and the last one ends.
using Quarters = std::array<int, 5>;

/// Divides [0, count) in half, then both halves at once.
/// @param divide int(begin, end, Progress): where the second half of [begin, end) begins.
/// @pre count >= 4. @throws what divide throws; Cancelled.
template <class Divide>
Quarters quarteredRange(int count, const Progress& progress, const char* what, const Divide& divide)
{
	progress.report(0, what);
	Quarters cuts = {0, 0, divide(0, count, progress), 0, count};
	forEachPart({0, cuts[2], count}, progress.part(0.5, 1), what,
		[&](int begin, int end, const Progress& part) {
			cuts[begin == 0 ? 1 : 3] = divide(begin, end, part);
		});
	return cuts;
}

/// Calls body(quarter, begin, end, progress) for each quarter, several at once: see forEachPart().
template <class Body>
void forEachQuarter(
	const Quarters& cuts, const Progress& progress, const char* what, const Body& body)
{
	forEachPart(std::vector<int>(cuts.begin(), cuts.end()), progress, what,
		[&](int begin, int end, const Progress& part) {
			const int quarter = int(std::find(cuts.begin(), cuts.end(), begin) - cuts.begin());
			body(quarter, begin, end, part);
		});
}

/// Parts of [0, count) for forEachPart(), one for each thread; a single one if count < minForTeam.
inline std::vector<int> rangesForThreads(int count, [[maybe_unused]] int minForTeam)
{
	int parts = 1;
#ifdef _OPENMP
	if (count >= minForTeam)
		parts = omp_get_max_threads();
#endif
	std::vector<int> start;
	for (int i = 0; i <= parts; ++i)
		start.push_back(int(std::int64_t(count) * i / parts));
	return start;
}

} // namespace vcg::tri::mcf

#endif
